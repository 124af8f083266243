/// Snapshot of sleeping islands, and of the time at rest of the others.
///
/// Edits leave islands no lasting number. The section therefore has a bit for each sleeping particle, and the time
/// at rest by the lowest slot of each awake island. Edits of springs have woken the islands that they change;
/// loading finds the others again.
///
/// An island disturbed since the last step, and its pile, would wake in the next step. They are saved as awake, and
/// a loaded network saves the same bytes.
#include <math.h>
#include <string.h>

#include "features/sleep/sleep.h"
#include "store/changed.h"
#include "store/sections.h"

typedef struct sleep_head {
    float speed, time;
    uint32_t still_count; ///< awake islands with a time at rest
    uint32_t has_bits;    ///< 1 if islands may sleep
    uint32_t has_force;
} sleep_head;

static void hand_head(mspringi_io *io, sleep_head *head) {
    mspringi_hand(io, &head->speed, 2, sizeof(float)); // and the next one
    mspringi_hand(io, &head->still_count, 3, sizeof(uint32_t));
}

// Slot and time at rest of its island.
static void hand_still(mspringi_io *io, uint32_t *slot, double *still) {
    MSPRINGI_HAND(io, *slot);
    MSPRINGI_HAND(io, *still);
}

static size_t words_of_particles(const mspring_network *network) {
    return ((size_t)network->topology.reserve.particle_end + 31) / 32;
}

static size_t force_floats(const mspring_network *network, const sleep_head *head) {
    return head->has_force ? 2 * mspringi_slot_count(network) : 0;
}

static bool is_listed(const mspringi_sleep *sleep, uint32_t island) {
    return sleep->still[island] > 0.0;
}

static sleep_head make_head(const mspring_network *network) {
    const mspringi_sleep *sleep = &network->sleep;
    sleep_head head = {.speed = network->settings.sleep_speed,
                       .time = network->settings.sleep_time,
                       .has_bits = network->settings.sleep_speed > 0.0f,
                       .has_force = network->settings.sleep_speed > 0.0f && sleep->has_force};
    for (uint32_t i = 0; i < sleep->count; ++i)
        head.still_count += is_listed(sleep, i);
    return head;
}

// Particle with the bit of a slot's island.
static mspring_id island_particle(const mspring_network *network, uint32_t slot) {
    return network->topology.particle_of_slot[network->sleep.lowest[network->sleep.island[slot]]];
}

static bool is_bit_set(const uint8_t *bits, mspring_id particle) {
    return bits[particle / 8] >> particle % 8 & 1;
}

// Clear the bits of all islands in the pile of a slot.
static void clear_pile(const mspring_network *network, uint8_t *bits, uint32_t slot) {
    const mspringi_sleep *sleep = &network->sleep;
    const uint32_t first = sleep->lowest[sleep->island[slot]];
    uint32_t at = first;
    if (sleep->still[sleep->island[slot]] >= 0.0 || !is_bit_set(bits, island_particle(network, slot)))
        return;
    do {
        const mspring_id particle = network->topology.particle_of_slot[at];
        bits[particle / 8] &= (uint8_t) ~(1u << particle % 8);
        at = sleep->beside[at];
    } while (at != first);
}

// Set the bits of sleeping islands, but not of those that the next step wakes.
static void set_island_bits(const mspring_network *network, uint8_t *bits) {
    const size_t slots = mspringi_slot_count(network);
    memset(bits, 0xff, words_of_particles(network) * sizeof(uint32_t));
    for (size_t slot = mspringi_next_disturbed_sleeper(network, 0); slot < slots;
         slot = mspringi_next_disturbed_sleeper(network, slot + 1))
        clear_pile(network, bits, (uint32_t)slot);
}

// True if a particle stays asleep in the next step.
static bool sleeps_on(const mspring_network *network, const uint8_t *bits, mspring_id particle) {
    const mspringi_sleep *sleep = &network->sleep;
    const uint32_t slot = network->topology.slot_of_particle[particle];
    return sleep->sleeping > 0 && mspringi_particle_exists(network, particle) &&
           sleep->still[sleep->island[slot]] < 0.0 && is_bit_set(bits, island_particle(network, slot));
}

static void put_forces(const mspring_network *network, const uint8_t *bits, mspringi_writer *to) {
    const size_t slots = mspringi_slot_count(network);
    for (size_t i = 0; i < 2 * slots; ++i) {
        const uint32_t slot = (uint32_t)(i < slots ? i : i - slots);
        const mspring_id particle = network->topology.particle_of_slot[slot];
        const float *values = i < slots ? network->sleep.force.x : network->sleep.force.y;
        const bool is_asleep = bits && particle != MSPRING_NONE && is_bit_set(bits, particle);
        mspringi_put(to, is_asleep ? &values[slot] : &(float){0.0f}, 1, sizeof *values);
    }
}

// The bits of islands are those of their lowest particles, so the place of the bits in the snapshot has room for
// them.
static void sleep_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_sleep *sleep = &network->sleep;
    mspringi_io io = mspringi_io_to(to);
    sleep_head head = make_head(network);
    hand_head(&io, &head);
    for (uint32_t i = 0; i < sleep->count; ++i)
        if (is_listed(sleep, i))
            hand_still(&io, &sleep->lowest[i], &sleep->still[i]);
    const uint32_t particles = network->topology.reserve.particle_end;
    uint8_t *const bits = to->sum ? to->at : NULL; // NULL: only count
    if (head.has_bits && bits)
        set_island_bits(network, bits);
    for (mspring_id first = 0; head.has_bits && first < particles; first += 32) {
        uint32_t word = 0;
        for (mspring_id p = first; bits && p < first + 32 && p < particles; ++p)
            word |= (uint32_t)sleeps_on(network, bits, p) << (p - first);
        mspringi_put(to, &word, 1, sizeof word);
    }
    if (head.has_force)
        put_forces(network, bits, to);
}

static mspring_result check_still(mspring_network *network, mspringi_io *io, uint32_t count) {
    const size_t slots = mspringi_slot_count(network);
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t slot;
        double still;
        hand_still(io, &slot, &still);
        if (slot >= slots || !(still > 0.0 && still <= 1e300))
            return mspringi_section_fail(network, &mspringi_section_sleep, "slot %u has been still for %g s",
                                         (unsigned)slot, still);
    }
    return MSPRING_OK;
}

// Check the bits of sleeping particles. Those behind the last particle are 0.
static mspring_result check_bits(mspring_network *network, mspringi_io *io) {
    const uint32_t particles = network->topology.reserve.particle_end;
    uint32_t word = 0;
    for (size_t i = 0; i < words_of_particles(network); ++i)
        MSPRINGI_HAND(io, word);
    return particles % 32 == 0 || word >> particles % 32 == 0
               ? MSPRING_OK
               : mspringi_section_fail(network, &mspringi_section_sleep, "particles sleep that are not there");
}

static mspring_result sleep_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_sleep;
    mspringi_io io = mspringi_io_from(from, size);
    sleep_head head;
    hand_head(&io, &head);
    if (!(head.speed >= 0.0f && head.speed <= 1e15f && head.time >= 0.0f && head.time <= 1e6f) ||
        head.has_bits != (head.speed > 0.0f) || head.has_force > head.has_bits ||
        head.still_count > (head.speed > 0.0f ? network->topology.reserve.particle_end : 0))
        return mspringi_section_fail(network, section, "%u islands below %g m/s for less than %g s",
                                     (unsigned)head.still_count, (double)head.speed, (double)head.time);
    mspring_result result = check_still(network, &io, head.still_count);
    if (result == MSPRING_OK && head.has_bits)
        result = check_bits(network, &io);
    for (size_t i = 0; result == MSPRING_OK && i < force_floats(network, &head); ++i) {
        float force;
        MSPRINGI_HAND(&io, force);
        if (!isfinite(force))
            result = mspringi_section_fail(network, section, "a force is %g N", (double)force);
    }
    if (result == MSPRING_OK)
        result = mspringi_section_end(network, section, &io);
    return result == MSPRING_OK && head.speed > 0.0f ? mspringi_sleep_reserve(network) : result;
}

// Mark the islands whose particles are all asleep.
static void mark_asleep(const mspring_network *network, mspringi_io *io) {
    const mspringi_sleep *sleep = &network->sleep;
    const uint32_t particles = network->topology.reserve.particle_end;
    memset(sleep->mark, 1, sleep->count * sizeof *sleep->mark);
    for (mspring_id first = 0; first < particles; first += 32) {
        uint32_t bits;
        MSPRINGI_HAND(io, bits);
        for (mspring_id p = first; p < first + 32 && p < particles; ++p)
            if (!(bits >> (p - first) & 1) && mspringi_particle_exists(network, p))
                sleep->mark[sleep->island[network->topology.slot_of_particle[p]]] = 0;
    }
}

// Load after all sections that could disturb sleep.
static void sleep_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_sleep *sleep = &network->sleep;
    mspringi_io io = mspringi_io_from(from, size);
    sleep_head head;
    hand_head(&io, &head);
    network->settings.sleep_speed = head.speed;
    network->settings.sleep_time = head.time;
    sleep->count = sleep->sleeping = 0;
    sleep->has_force = false;
    mspringi_notify_change(network, MSPRINGI_CHANGED_NAPS, 0);
    if (!(head.speed > 0.0f))
        return;
    mspringi_islands_find(network);
    for (uint32_t i = 0; i < head.still_count; ++i) {
        uint32_t slot;
        double still;
        hand_still(&io, &slot, &still);
        if (sleep->island[slot] != MSPRING_NONE)
            sleep->still[sleep->island[slot]] = still;
    }
    mark_asleep(network, &io);
    mspringi_sleep_fall(network, (mspringi_field){NULL, NULL});
    mspringi_hand(&io, sleep->force.x, force_floats(network, &head), sizeof *sleep->force.x);
    sleep->has_force = head.has_force;
}

const mspringi_section mspringi_section_sleep = {"slee",     "sleep",     false,      NULL,
                                                 sleep_save, sleep_check, sleep_load, NULL};

static uint32_t sleep_runs(const mspring_network *network, mspringi_io io, mspringi_run *runs) {
    sleep_head head = {0};
    const size_t size = io.left;
    hand_head(&io, &head);
    runs[0] = (mspringi_run){MSPRINGI_BYTES, size - io.left};
    runs[1] = (mspringi_run){MSPRINGI_SLOTS, head.still_count};
    runs[2] = (mspringi_run){MSPRINGI_BYTES, head.has_bits ? words_of_particles(network) * sizeof(uint32_t) : 0};
    runs[3] = (mspringi_run){MSPRINGI_FLOATS, head.has_force ? 2 : 0};
    return 4;
}

const mspringi_by_id mspringi_by_id_sleep = {&mspringi_section_sleep, sleep_runs, NULL, NULL};
