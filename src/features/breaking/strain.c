/// Thresholds of strain, and the pass that compares them.
#include "features/breaking/strain.h"

#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "features/breaking/breaking.h"
#include "store/changed.h"
#include "store/events.h"
#include "store/id_pool.h"
#include "store/properties.h"
#include "store/sleepers.h"
#include "store/spring_limits.h"
#include "store/springs.h"
#include "store/stages.h"
#include "store/store.h"

/// Room for rounding in the least strain of a spring that has flowed.
#define ROUNDING (1.0f - 1e-5f)

/* ---------------------------------------------------------------------------------------------------- the pass */

static float stretch_of(const mspring_network *network, const mspringi_spring_values *values) {
    const mspringi_state *s = &network->state;
    const float dx = s->x[values->tip] - s->x[values->base], dy = s->y[values->tip] - s->y[values->base];
    return fabsf(sqrtf(dx * dx + dy * dy) - values->rest_length);
}

// Until a spring is to be stressed, the least strain that anything happens at is the one that it breaks at.
static const float *least_of(const mspringi_strain *strain) {
    return strain->least ? strain->least : strain->break_strain;
}

static bool has_bit(const uint16_t *words, mspringi_spring_slot spring_slot) {
    return words[spring_slot / MSPRINGI_WIDTH] >> spring_slot % MSPRINGI_WIDTH & 1;
}

// The springs of the irregular part, as the kernels do those of rows.
static uint32_t irregular_strain(const mspring_network *network, mspringi_strain_hit *hits) {
    const mspringi_topology *t = &network->topology;
    const mspringi_strain *strain = &network->strain;
    uint32_t count = 0;
    for (uint32_t first = 0; first < t->irregular_count; first += MSPRINGI_WIDTH) {
        const uint32_t word = (t->row_spring_slots + first) / MSPRINGI_WIDTH;
        uint32_t bits = strain->stressed[word];
        for (uint32_t i = first; i < first + MSPRINGI_WIDTH && i < t->irregular_count; ++i) {
            const mspringi_spring_slot spring_slot = t->row_spring_slots + i;
            if (mspringi_slot_is_asleep(network, t->irregular_a[i]))
                continue;
            const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
            if (has_bit(network->live, spring_slot) &&
                stretch_of(network, &values) >
                    least_of(strain)[spring_slot] * mspringi_strain_length(values.rest_length))
                bits |= 1u << (i - first);
        }
        if (bits)
            hits[count++] = (mspringi_strain_hit){word, bits};
    }
    return count;
}

// The stretch below which a stressed spring relaxes.
static float relaxes_at(const mspring_network *network, mspringi_spring_slot spring_slot, float whole,
                        float stress_at) {
    const mspringi_strain *strain = &network->strain;
    const float own = strain->relax_strain ? strain->relax_strain[spring_slot] : MSPRING_RELAX_STRAIN_DEFAULT;
    return own >= 0.0f ? fminf(own * whole, stress_at) : stress_at * network->settings.relax_fraction;
}

// The rest length before any flow, of a spring that has flowed: it breaks by the strain that it has in all.
static float nominal_of(const mspring_network *network, mspringi_spring_slot spring_slot, float rest_length) {
    const float *nominal = network->tested.nominal;
    return !nominal || nominal[spring_slot] == rest_length || mspringi_spring_slot_ramp(network, spring_slot)
               ? rest_length
               : nominal[spring_slot];
}

// How much a spring's length differs from that.
static float total_stretch(const mspring_network *network, const mspringi_spring_values *values, float stretch,
                           float nominal) {
    mspringi_spring_values whole = *values;
    whole.rest_length = nominal;
    return nominal == values->rest_length ? stretch : stretch_of(network, &whole);
}

static bool is_slack(const mspring_network *network, mspringi_spring_slot spring_slot) {
    if (!network->side)
        return false;
    const mspring_id id = mspringi_spring_at(network, spring_slot);
    return mspringi_is_slack(mspringi_side_of(network, id), (double)mspringi_spring_strain(network, id));
}

// Break, stress or relax the spring in this place, if it is time for that.
static void look_at(mspring_network *network, mspringi_spring_slot spring_slot) {
    mspringi_strain *strain = &network->strain;
    const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
    const float whole = mspringi_strain_length(values.rest_length);
    float stretch = stretch_of(network, &values);
    const float stress_at = strain->warn_strain ? strain->warn_strain[spring_slot] * whole : INFINITY;
    const bool is_stressed = has_bit(strain->stressed, spring_slot);
    const float nominal = nominal_of(network, spring_slot, values.rest_length);
    const bool slack = is_slack(network, spring_slot); // what it does not feel neither breaks nor stresses it
    stretch = slack ? 0.0f : stretch;
    const float total = slack ? 0.0f : total_stretch(network, &values, stretch, nominal);
    mspring_event event = {.other = MSPRING_NONE};
    if (total > strain->break_strain[spring_slot] * mspringi_strain_length(nominal))
        event.kind = MSPRING_EVENT_BROKEN;
    else if (!is_stressed && stretch > stress_at)
        event.kind = MSPRING_EVENT_STRESSED;
    else if (is_stressed && relaxes_at(network, spring_slot, whole, stress_at) > stretch)
        event.kind = MSPRING_EVENT_RELAXED;
    else
        return;
    event.id = mspringi_spring_at(network, spring_slot);
    event.strain = mspringi_spring_strain(network, event.id);
    if (event.kind == MSPRING_EVENT_BROKEN)
        (void)mspringi_spring_break(network, event.id);
    else
        strain->stressed[spring_slot / MSPRINGI_WIDTH] ^= (uint16_t)(1u << spring_slot % MSPRINGI_WIDTH);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
    mspringi_events_push(network, event);
}

/// Springs that are looked at together.
enum { BATCH = 32 };

/// Springs of a particle that are read ahead: those of a lattice. A hub has any number.
enum { MOST_PREFETCHED = 8 };

// Look at some springs. What their ids are found by is read for all of them at first, as a step leaves none of it
// in the near caches: one read waits for another, but those of different springs do not.
static void look_at_batch(mspring_network *network, const mspringi_spring_slot *spring_slots, uint32_t count) {
    const mspringi_topology *t = &network->topology;
    const uint32_t *first = network->incidence.first, *springs = network->incidence.springs;
    uint32_t particles[BATCH];
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t base, tip;
        mspringi_topology_ends(t, spring_slots[i], &base, &tip);
        particles[i] = t->particle_of_slot[base];
    }
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t at = first[particles[i]], left = MOST_PREFETCHED; at < first[particles[i] + 1] && left > 0;
             --left)
            MSPRINGI_PREFETCH(&t->slot_of_spring[springs[at++]]);
    for (uint32_t i = 0; i < count; ++i)
        look_at(network, spring_slots[i]);
}

static void look_at_hits(mspring_network *network, const mspringi_strain_hit *hits, uint32_t count) {
    mspringi_spring_slot spring_slots[BATCH];
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
            if (hits[i].bits >> lane & 1)
                spring_slots[found++] = hits[i].word * MSPRINGI_WIDTH + lane;
        if (found + MSPRINGI_WIDTH > BATCH || i + 1 == count) {
            look_at_batch(network, spring_slots, found);
            found = 0;
        }
    }
}

// Whether strain is all that counts, of all springs, as the kernels have it.
static bool is_plain(const mspring_network *network) {
    return !network->tested.nominal && !network->side && !network->has_welds;
}

// Break, stress and relax springs by the strain that they have now.
static void compare(mspring_network *network, double dt) {
    const mspringi_topology *t = &network->topology;
    const mspringi_strain *strain = &network->strain;
    (void)dt;
    const mspringi_strain_sweep sweep = {
        .x = network->state.x,
        .y = network->state.y,
        .rest_lengths = network->rest_lengths.lengths,
        .rests_of_block = network->rest_lengths.of_block,
        .chain_springs = network->chain_springs,
        .parts = network->parts,
        .up_of_block = t->up_of_block,
        .lattice_first = t->lattice_first,
        .chain_first = t->chain_first,
        .chain_word = t->lattice_spring_slots / MSPRINGI_WIDTH,
        .least = least_of(strain),
        .live = network->live,
        .stressed = strain->stressed,
        .break_strain = strain->break_strain,
        .stress = is_plain(network) ? strain->warn_strain : NULL,
        .relax = strain->relax_strain,
        .relax_fraction = network->settings.relax_fraction,
    };
    mspringi_strain_hit *hits = strain->hits;
    uint32_t count = 0;
    for (uint32_t first = 0, end; mspringi_next_awake(network, t->lattice_first, t->lattice_blocks, &first, &end);
         first = end)
        count += network->kernels->lattice_strain(&sweep, first, end, hits + count);
    for (uint32_t first = 0, end; mspringi_next_awake(network, t->chain_first, t->chain_blocks, &first, &end);
         first = end)
        count += network->kernels->chain_strain(&sweep, first, end, hits + count);
    count += irregular_strain(network, hits + count);
    look_at_hits(network, hits, count);
}

/* -------------------------------------------------------------------------------------------------- thresholds */

static void fill(const mspring_network *network, float *thresholds, float value) {
    const size_t count = mspringi_spring_slot_words(&network->topology) * MSPRINGI_WIDTH;
    for (size_t spring_slot = 0; spring_slot < count; ++spring_slot)
        thresholds[spring_slot] = value;
}

static mspring_result reserve_layout(mspring_network *network) {
    const mspringi_strain *strain = &network->strain;
    if (strain->break_strain)
        return MSPRING_OK;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_STRAIN))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to watch the strain of %u springs",
                             (unsigned)network->topology.spring_count);
    fill(network, strain->break_strain, INFINITY);
    return MSPRING_OK;
}

mspring_result mspringi_strain_reserve_stress(mspring_network *network) {
    const mspringi_strain *strain = &network->strain;
    if (strain->warn_strain)
        return MSPRING_OK;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_STRESS))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for the stress strains of %u springs",
                             (unsigned)network->topology.spring_count);
    fill(network, strain->warn_strain, INFINITY);
    memcpy(strain->least, strain->break_strain,
           mspringi_spring_slot_words(&network->topology) * MSPRINGI_WIDTH * sizeof *strain->least);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACES, 0);
    return MSPRING_OK;
}

static mspring_result reserve(mspring_network *network) {
    const mspringi_strain *strain = &network->strain;
    if (strain->break_strain && (strain->least || !network->tested.nominal))
        return MSPRING_OK;
    mspring_result result = mspringi_breaking_reserve(network);
    if (result == MSPRING_OK)
        result = mspringi_incidence_reserve(network);
    if (result == MSPRING_OK)
        result = reserve_layout(network);
    if (result == MSPRING_OK && network->tested.nominal)
        result = mspringi_strain_reserve_stress(network);
    if (result == MSPRING_OK)
        mspringi_notify_change(network, MSPRINGI_CHANGED_PLACES, 0);
    return result;
}

static mspring_result reserve_relax(mspring_network *network) {
    const mspringi_strain *strain = &network->strain;
    if (strain->relax_strain)
        return MSPRING_OK;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_RELAX))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for the relax strains of %u springs",
                             (unsigned)network->topology.spring_count);
    fill(network, strain->relax_strain, MSPRING_RELAX_STRAIN_DEFAULT);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACES, 0);
    return MSPRING_OK;
}

static mspring_result reserve_for(mspring_network *network, mspring_property property) {
    if (property == MSPRING_RELAX_STRAIN)
        return reserve_relax(network);
    mspring_result result = reserve(network);
    return result == MSPRING_OK && property == MSPRING_WARN_STRAIN ? mspringi_strain_reserve_stress(network)
                                                                   : result;
}

static mspring_result match_layout(mspring_network *to, const mspring_network *from) {
    mspring_result result = from->strain.break_strain ? reserve_layout(to) : MSPRING_OK;
    if (result == MSPRING_OK && from->strain.warn_strain)
        result = mspringi_strain_reserve_stress(to);
    return result == MSPRING_OK && from->strain.relax_strain ? reserve_relax(to) : result;
}

// Of a spring that has flowed, what is left of its break strain: the pass compares with the rest length in force.
static float least_to_break(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const float break_strain = network->strain.break_strain[spring_slot], *nominal = network->tested.nominal;
    const float own = nominal ? mspringi_spring_slot_own_length(network, spring_slot) : 0.0f;
    if (!nominal || own == nominal[spring_slot] || break_strain == INFINITY)
        return break_strain;
    return fmaxf(0.0f, (break_strain * nominal[spring_slot] - fabsf(own - nominal[spring_slot])) / own * ROUNDING);
}

void mspringi_strain_renew_least(mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_strain *strain = &network->strain;
    if (strain->least)
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): one is there if the other is
        strain->least[spring_slot] = fminf(least_to_break(network, spring_slot), strain->warn_strain[spring_slot]);
}

static void store_limit(mspring_network *network, mspringi_spring_slot spring_slot, mspring_property property,
                        float value) {
    mspringi_strain *strain = &network->strain;
    if (property == MSPRING_RELAX_STRAIN) {
        MSPRINGI_ASSERT(strain->relax_strain);
        strain->relax_strain[spring_slot] = value;
        strain->relaxes = strain->relaxes || value != MSPRING_RELAX_STRAIN_DEFAULT;
    } else {
        const bool stress = property == MSPRING_WARN_STRAIN;
        MSPRINGI_ASSERT(strain->break_strain && (strain->warn_strain || !stress));
        if (stress)
            strain->warn_strain[spring_slot] = value;
        else
            strain->break_strain[spring_slot] = value;
        strain->stresses = strain->stresses || (stress && value < INFINITY);
        strain->breaks = strain->breaks || (!stress && value < INFINITY);
        mspringi_strain_renew_least(network, spring_slot);
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
}

static void forget(mspring_network *network, mspring_id spring) {
    const mspringi_strain *strain = &network->strain;
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    if (strain->stressed)
        strain->stressed[spring_slot / MSPRINGI_WIDTH] &= (uint16_t) ~(1u << spring_slot % MSPRINGI_WIDTH);
    if (strain->break_strain)
        store_limit(network, spring_slot, MSPRING_BREAK_STRAIN, INFINITY);
    if (strain->warn_strain)
        store_limit(network, spring_slot, MSPRING_WARN_STRAIN, INFINITY);
    if (strain->relax_strain)
        store_limit(network, spring_slot, MSPRING_RELAX_STRAIN, MSPRING_RELAX_STRAIN_DEFAULT);
}

static void put(mspring_network *network, mspring_id spring, mspringi_limits limits) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    if (!mspringi_has_limits(limits))
        return;
    if (limits.break_strain < MSPRING_NEVER)
        store_limit(network, spring_slot, MSPRING_BREAK_STRAIN, limits.break_strain);
    if (limits.warn_strain < MSPRING_NEVER)
        store_limit(network, spring_slot, MSPRING_WARN_STRAIN, limits.warn_strain);
    if (limits.relax_strain != MSPRING_RELAX_STRAIN_DEFAULT)
        store_limit(network, spring_slot, MSPRING_RELAX_STRAIN, mspringi_broken_value(limits.relax_strain));
    mspringi_fingerprint_floats(network, mspringi_read_value(limits.break_strain),
                                mspringi_read_value(limits.warn_strain));
    mspringi_fingerprint_floats(network, limits.relax_strain, 0.0f);
}

const mspringi_limit_ops mspringi_limits_of_breaking = {
    .first = MSPRING_BREAK_STRAIN,
    .last = MSPRING_RELAX_STRAIN,
    .reserve = reserve_for,
    .match_layout = match_layout,
    .store = store_limit,
    .put = put,
    .forget = forget,
    .renew = mspringi_strain_renew_least,
};

static bool is_used(const mspring_network *network) {
    return network->strain.break_strain != NULL;
}

const mspringi_stage mspringi_stage_strain = {.is_used = is_used, .after_step = compare};
