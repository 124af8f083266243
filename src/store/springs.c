/// Spring slots of springs, and their values.
#include "store/springs.h"

#include <string.h>

#include "features/ramps/ramps.h"
#include "store/changed.h"
#include "store/id_pool.h"
#include "store/metres.h"
#include "store/record_sharing.h"
#include "store/rest_lengths.h"
#include "store/spring_limits.h"
#include "store/stages.h"

// Where a spring's values are: in one record, or in one at each of its ends.
typedef struct spring_record {
    float *rest_length, *stiffness;
    float *damping; ///< NULL if the network has none
} spring_record;

typedef struct spring_records {
    spring_record ends[2];
    int count;
} spring_records;

// Those of an index into records of all parts.
static spring_record record_in(float *records, size_t index, uint32_t parts) {
    float *first = records + index / MSPRINGI_WIDTH * MSPRINGI_WIDTH * parts + index % MSPRINGI_WIDTH;
    return (spring_record){first + MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH,
                           first + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH,
                           parts > MSPRINGI_DAMPING ? first + MSPRINGI_DAMPING * MSPRINGI_WIDTH : NULL};
}

static spring_record lattice_record(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const uint32_t parts = network->parts - 1;
    float *first = network->lattice_springs + (size_t)(spring_slot / MSPRINGI_WIDTH) * MSPRINGI_WIDTH * parts +
                   spring_slot % MSPRINGI_WIDTH;
    return (spring_record){mspringi_rest_lengths_at(&network->rest_lengths, spring_slot), first,
                           network->parts > MSPRINGI_DAMPING ? first + MSPRINGI_WIDTH : NULL};
}

static spring_records find_records(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_topology *t = &network->topology;
    const uint32_t parts = network->parts;
    if (spring_slot < t->lattice_spring_slots)
        return (spring_records){{lattice_record(network, spring_slot), {NULL, NULL, NULL}}, 1};
    if (spring_slot < t->row_spring_slots)
        return (spring_records){
            {record_in(network->chain_springs, spring_slot - t->lattice_spring_slots, parts), {NULL, NULL, NULL}},
            1};
    const uint32_t *entry = t->irregular.entry + 2 * (size_t)(spring_slot - t->row_spring_slots);
    return (spring_records){{record_in(network->irregular_springs, entry[0], parts),
                             record_in(network->irregular_springs, entry[1], parts)},
                            2};
}

mspringi_spring_values mspringi_spring_slot_get(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const spring_record record = find_records(network, spring_slot).ends[0];
    mspringi_spring_values values = {
        .rest_length = *record.rest_length,
        .stiffness = *record.stiffness,
        .damping = record.damping ? *record.damping : 0.0f,
    };
    mspringi_topology_ends(&network->topology, spring_slot, &values.base, &values.tip);
    return values;
}

const mspringi_ramp *mspringi_spring_slot_ramp(const mspring_network *network, mspringi_spring_slot spring_slot) {
    for (size_t i = 0; i < mspringi_ramp_count(network); ++i)
        if (mspringi_slot_of_spring(&network->topology, network->ramps->list[i].spring) == spring_slot)
            return &network->ramps->list[i];
    return NULL;
}

float mspringi_spring_slot_own_length(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_ramp *ramp = mspringi_spring_slot_ramp(network, spring_slot);
    return ramp ? ramp->to : *find_records(network, spring_slot).ends[0].rest_length;
}

float mspringi_spring_slot_given_length(const mspring_network *network, mspringi_spring_slot spring_slot) {
    return network->tested.nominal ? network->tested.nominal[spring_slot]
                                   : mspringi_spring_slot_own_length(network, spring_slot);
}

mspringi_ends mspringi_spring_ends(const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, spring), &base, &tip);
    return mspringi_spring_is_from_tip(network, spring, base, tip) ? (mspringi_ends){tip, base}
                                                                   : (mspringi_ends){base, tip};
}

uint32_t mspringi_side_flags(const mspring_network *network, mspring_id spring) {
    const int side = mspringi_side_of(network, spring);
    return side > 0 ? MSPRING_SPRING_PULL_ONLY : side < 0 ? MSPRING_SPRING_PUSH_ONLY : 0u;
}

uint32_t mspringi_spring_flags(const mspring_network *network, mspring_id spring) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    return (mspringi_spring_is_relative(network, spring) ? MSPRING_SPRING_RELATIVE : 0u) |
           mspringi_side_flags(network, spring) |
           (mspringi_metres_of(network, spring) ? MSPRING_SPRING_METRES : 0u) |
           (mspringi_spring_slot_is_live(network, spring_slot) ? 0u : MSPRING_SPRING_BROKEN) |
           (mspringi_spring_slot_is_stressed(network, spring_slot) ? MSPRING_SPRING_STRESSED : 0u);
}

mspringi_spring_values mspringi_spring_get(const mspring_network *network, mspring_id spring) {
    return mspringi_spring_slot_get(network, mspringi_slot_of_spring(&network->topology, spring));
}

void mspringi_springs_get(const mspring_network *network, const mspringi_selection *at, uint32_t first,
                          uint32_t count, mspringi_spring_values *values) {
    const mspringi_topology *t = &network->topology;
    for (uint32_t i = 0; i < count; ++i) {
        const mspringi_spring_slot spring_slot = t->slot_of_spring[mspringi_selected(at, first + i)];
        if (spring_slot >= t->lattice_spring_slots) {
            values[i] = mspringi_spring_slot_get(network, spring_slot);
            continue;
        }
        const spring_record record = lattice_record(network, spring_slot);
        values[i].rest_length = *record.rest_length;
        values[i].stiffness = *record.stiffness;
        values[i].damping = record.damping ? *record.damping : 0.0f;
        mspringi_lattice_ends(t, spring_slot, &values[i].base, &values[i].tip);
    }
}

void mspringi_spring_slot_set(mspring_network *network, mspringi_spring_slot spring_slot, float stiffness,
                              float damping) {
    const spring_records records = find_records(network, spring_slot);
    mspringi_shared_records_unshare(network, spring_slot);
    for (int i = 0; i < records.count; ++i) {
        MSPRINGI_ASSERT(records.ends[i].damping || damping == 0.0f);
        *records.ends[i].stiffness = stiffness;
        if (records.ends[i].damping)
            *records.ends[i].damping = damping;
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
}

void mspringi_note_rest_length(mspring_network *network, float rest_length) {
    if (rest_length == MSPRINGI_WELD)
        network->has_welds = true;
    else if (rest_length < network->shortest_set)
        network->shortest_set = rest_length;
}

void mspringi_spring_slot_set_rest_length(mspring_network *network, mspringi_spring_slot spring_slot,
                                          float rest_length) {
    const spring_records records = find_records(network, spring_slot);
    MSPRINGI_ASSERT(spring_slot >= network->topology.lattice_spring_slots ||
                    !mspringi_rest_lengths_are_shared(&network->rest_lengths, spring_slot) ||
                    *records.ends[0].rest_length == rest_length);
    mspringi_shared_records_unshare_yielding(network, spring_slot);
    mspringi_sent_forget(&network->sent[mspringi_sent_index(MSPRING_REST_LENGTH)]);
    for (int i = 0; i < records.count; ++i)
        *records.ends[i].rest_length = rest_length;
    mspringi_note_rest_length(network, rest_length);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
}

void mspringi_spring_slot_give_length(mspring_network *network, mspringi_spring_slot spring_slot, float length) {
    if (!network->tested.nominal) {
        mspringi_spring_slot_set_rest_length(network, spring_slot, length);
        return;
    }
    const float own = mspringi_spring_slot_own_length(network, spring_slot),
                had = network->tested.nominal[spring_slot];
    const bool is_straight = own == had || had == MSPRINGI_WELD || length == MSPRINGI_WELD;
    network->tested.nominal[spring_slot] = length;
    mspringi_spring_slot_set_rest_length(
        network, spring_slot, is_straight ? length : (float)((double)length * ((double)own / (double)had)));
    mspringi_limits_renew(network, spring_slot);
}

void mspringi_spring_slot_fill(mspring_network *network, mspringi_spring_slot spring_slot, float rest_length,
                               mspringi_relative nominal) {
    const spring_records records = find_records(network, spring_slot);
    MSPRINGI_ASSERT(spring_slot >= network->topology.lattice_spring_slots ||
                    !mspringi_rest_lengths_are_shared(&network->rest_lengths, spring_slot) ||
                    *records.ends[0].rest_length == rest_length);
    for (int i = 0; i < records.count; ++i) {
        const spring_record *record = &records.ends[i];
        MSPRINGI_ASSERT(record->damping || nominal.damping == 0.0f);
        *record->rest_length = rest_length;
        *record->stiffness = nominal.stiffness;
        if (record->damping)
            *record->damping = nominal.damping;
    }
    mspringi_note_rest_length(network, rest_length);
}

void mspringi_spring_slot_copy(const mspring_network *from, mspringi_spring_slot had_place, mspring_network *to,
                               mspringi_spring_slot spring_slot) {
    const spring_record had = find_records(from, had_place).ends[0];
    MSPRINGI_ASSERT(to->parts == from->parts);
    mspringi_shared_records_unshare(to, spring_slot);
    mspringi_spring_slot_fill(to, spring_slot, *had.rest_length,
                              (mspringi_relative){*had.stiffness, had.damping ? *had.damping : 0.0f});
}

// Stiffness and damping of a relative spring for the substep that was derived for last.
static mspringi_relative derive(const mspring_network *network, const mspringi_spring_values *values,
                                mspringi_relative fractions) {
    const mspringi_topology *t = &network->topology;
    const float *mass = network->mass;
    const double reduced_mass = mspringi_reduced_mass((double)mass[t->particle_of_slot[values->base]],
                                                      (double)mass[t->particle_of_slot[values->tip]]);
    const double rate = mspringi_relative_rate(network);
    return (mspringi_relative){mspringi_derived_stiffness(fractions.stiffness, reduced_mass, rate),
                               mspringi_derived_damping(fractions.damping, reduced_mass, rate)};
}

mspringi_relative mspringi_spring_get_nominal(const mspring_network *network, mspring_id spring,
                                              mspringi_spring_slot spring_slot) {
    if (mspringi_spring_is_relative(network, spring))
        return mspringi_fractions_of(&network->fractions, spring);
    if (!mspringi_spring_slot_is_live(network, spring_slot)) {
        MSPRINGI_ASSERT(network->kept);
        return network->kept[spring];
    }
    const spring_record record = find_records(network, spring_slot).ends[0];
    return (mspringi_relative){*record.stiffness, record.damping ? *record.damping : 0.0f};
}

void mspringi_spring_set_nominal(mspring_network *network, mspring_id spring, mspringi_spring_slot spring_slot,
                                 mspringi_relative nominal) {
    const bool relative = mspringi_spring_is_relative(network, spring);
    if (relative)
        mspringi_fractions_set(&network->fractions, spring, nominal);
    if (!mspringi_spring_slot_is_live(network, spring_slot)) {
        if (!relative)
            network->kept[spring] = nominal;
        return;
    }
    const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
    if (relative)
        nominal = derive(network, &values, nominal);
    mspringi_spring_slot_set(network, spring_slot, nominal.stiffness, nominal.damping);
}

/// Arguments for deriving the springs of lattices.
typedef struct deriving {
    const float *mass;
    double rate;
    float mass_a, mass_b; ///< masses of the spring before: most springs have the same
    double reduced_mass;
} deriving;

// As mspringi_spring_set_nominal(), of a live relative spring in a lattice.
static inline void derive_in_lattice(mspring_network *network, deriving *with, mspringi_spring_slot spring_slot,
                                     mspringi_relative fractions) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_lattice_ends(t, spring_slot, &base, &tip);
    const float a = with->mass[t->particle_of_slot[base]], b = with->mass[t->particle_of_slot[tip]];
    if (a != with->mass_a || b != with->mass_b) {
        with->mass_a = a;
        with->mass_b = b;
        with->reduced_mass = mspringi_reduced_mass((double)a, (double)b);
    }
    const spring_record record = lattice_record(network, spring_slot);
    mspringi_shared_records_unshare(network, spring_slot);
    *record.stiffness = mspringi_derived_stiffness(fractions.stiffness, with->reduced_mass, with->rate);
    if (record.damping)
        *record.damping = mspringi_derived_damping(fractions.damping, with->reduced_mass, with->rate);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
}

// While a snapshot is loaded, springs that are not there any more are live until its section of broken ones.
void mspringi_renew_relative(mspring_network *network) {
    deriving with = {.mass = network->mass, .rate = mspringi_relative_rate(network)};
    for (mspring_id s = 0; s < network->topology.spring_count; ++s) {
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[s];
        const mspringi_relative fractions = mspringi_fractions_of(&network->fractions, s);
        if (!(fractions.stiffness >= 0.0f) || !mspringi_spring_exists(network, s) ||
            !mspringi_spring_slot_is_live(network, spring_slot))
            continue;
        if (spring_slot < network->topology.lattice_spring_slots)
            derive_in_lattice(network, &with, spring_slot, fractions);
        else
            mspringi_spring_set_nominal(network, s, spring_slot, fractions);
    }
}

uint32_t mspringi_renew_relative_around(mspring_network *network, mspring_id particle) {
    uint32_t count = 0;
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, particle);
    for (mspring_id s; (s = mspringi_incident_springs_next(network, &around)) != MSPRING_NONE; ++count) {
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[s];
        if (mspringi_spring_is_relative(network, s) && mspringi_spring_slot_is_live(network, spring_slot))
            mspringi_spring_set_nominal(network, s, spring_slot, mspringi_fractions_of(&network->fractions, s));
    }
    return count;
}

void mspringi_derive_relative(mspring_network *network, float h) {
    if (!network->fractions.values || network->relative_h == h)
        return;
    network->relative_h = h;
    network->edits.flows++;
    mspringi_renew_relative(network);
}

static bool is_used(const mspring_network *network) {
    return network->fractions.values != NULL;
}

static void derive_anew(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_derive_relative(network, attempt->h);
}

static void undo(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_derive_relative(network, attempt->relative_h);
}

const mspringi_stage mspringi_stage_relative = {.is_used = is_used, .before_step = derive_anew, .undo = undo};
