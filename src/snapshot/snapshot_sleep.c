/// Snapshot of sleeping islands, and of the time at rest of the others.
///
/// Islands have no names that edits would leave alone: what sleeps is told by particle, and how long others have
/// been still by their lowest slots. Edits of springs have woken those that they change, so the others are found
/// again.
#include <math.h>
#include <string.h>

#include "sleep/sleep.h"
#include "store/changed.h"
#include "store/sections.h"

typedef struct sleep_head {
    float speed, time;
    uint32_t still_count; ///< awake islands with a time at rest
    uint32_t any_asleep, has_force;
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
                       .any_asleep = sleep->sleeping > 0,
                       .has_force = sleep->sleeping > 0 && sleep->has_force};
    for (uint32_t i = 0; i < sleep->count; ++i)
        head.still_count += is_listed(sleep, i);
    return head;
}

static uint32_t island_of(const mspring_network *network, mspring_id particle) {
    return network->sleep.island[network->topology.slot_of_particle[particle]];
}

static bool is_asleep(const mspring_network *network, mspring_id particle) {
    return mspringi_particle_exists(network, particle) && network->sleep.still[island_of(network, particle)] < 0.0;
}

static bool has_bit(const uint8_t *bits, mspring_id particle) {
    return bits[particle / 8] >> particle % 8 & 1;
}

// Bits of particles, of use for the lowest ones of sleeping islands alone: 0 for all of a pile if one of them has
// been disturbed, since they wake before the next step.
static void find_undisturbed(const mspring_network *network, uint8_t *bits) {
    const mspring_id *of_slot = network->topology.particle_of_slot;
    const mspringi_sleep *sleep = &network->sleep;
    memset(bits, 0xff, words_of_particles(network) * sizeof(uint32_t));
    for (mspring_id p = 0; p < network->topology.reserve.particle_end; ++p) {
        if (!is_asleep(network, p) ||
            !mspringi_sleeper_is_disturbed(network, network->topology.slot_of_particle[p]))
            continue;
        uint32_t slot = sleep->lowest[island_of(network, p)];
        for (mspring_id q; has_bit(bits, q = of_slot[slot]); slot = sleep->beside[slot])
            bits[q / 8] &= (uint8_t) ~(1u << q % 8);
    }
}

static bool sleeps_on(const mspring_network *network, const uint8_t *undisturbed, mspring_id particle) {
    if (!is_asleep(network, particle))
        return false;
    const uint32_t lowest = network->sleep.lowest[island_of(network, particle)];
    return has_bit(undisturbed, network->topology.particle_of_slot[lowest]);
}

// What is written is at first the bits that are read: those of lowest particles stay as they are.
static void save_sleepers(const mspring_network *network, mspringi_writer *to) {
    const uint32_t particles = network->topology.reserve.particle_end;
    const uint8_t *undisturbed = to->at;
    if (!to->sum) { // it counts
        mspringi_put(to, NULL, words_of_particles(network), sizeof(uint32_t));
        return;
    }
    find_undisturbed(network, to->at);
    for (mspring_id first = 0; first < particles; first += 32) {
        uint32_t bits = 0;
        for (mspring_id p = first; p < first + 32 && p < particles; ++p)
            bits |= (uint32_t)sleeps_on(network, undisturbed, p) << (p - first);
        mspringi_put(to, &bits, 1, sizeof bits);
    }
}

static void sleep_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_sleep *sleep = &network->sleep;
    mspringi_io io = mspringi_io_to(to);
    sleep_head head = make_head(network);
    hand_head(&io, &head);
    for (uint32_t i = 0; i < sleep->count; ++i)
        if (is_listed(sleep, i))
            hand_still(&io, &sleep->lowest[i], &sleep->still[i]);
    if (head.any_asleep)
        save_sleepers(network, to);
    mspringi_put(to, sleep->force.x, force_floats(network, &head), sizeof *sleep->force.x);
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

static mspring_result sleep_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_sleep;
    mspringi_io io = mspringi_io_from(from, size);
    sleep_head head;
    hand_head(&io, &head);
    if (!(head.speed >= 0.0f && head.speed <= 1e15f && head.time >= 0.0f && head.time <= 1e6f) ||
        head.any_asleep > (head.speed > 0.0f) || head.has_force > head.any_asleep ||
        head.still_count > (head.speed > 0.0f ? network->topology.reserve.particle_end : 0))
        return mspringi_section_fail(network, section, "%u islands below %g m/s for less than %g s",
                                     (unsigned)head.still_count, (double)head.speed, (double)head.time);
    mspring_result result = check_still(network, &io, head.still_count);
    for (size_t i = 0; head.any_asleep && i < words_of_particles(network); ++i)
        mspringi_hand(&io, &(uint32_t){0}, 1, sizeof(uint32_t));
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
    if (!head.any_asleep)
        return;
    mark_asleep(network, &io);
    mspringi_sleep_fall(network, (mspringi_field){NULL, NULL});
    mspringi_hand(&io, sleep->force.x, force_floats(network, &head), sizeof *sleep->force.x);
    sleep->has_force = head.has_force;
}

const mspringi_section mspringi_section_sleep = {"slee",     "sleep",     false,      NULL,
                                                 sleep_save, sleep_check, sleep_load, NULL};
