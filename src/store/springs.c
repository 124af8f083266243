/// Where springs lie and what they are like.
#include "store/springs.h"

#include "store/alike.h"
#include "store/changed.h"
#include "store/one_way.h"
#include "store/rests.h"
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

static spring_record lattice_record(const mspring_network *network, mspringi_place place) {
    const uint32_t parts = network->parts - 1;
    float *first = network->lattice_springs + (size_t)(place / MSPRINGI_WIDTH) * MSPRINGI_WIDTH * parts +
                   place % MSPRINGI_WIDTH;
    return (spring_record){mspringi_rests_at(&network->rests, place), first,
                           network->parts > MSPRINGI_DAMPING ? first + MSPRINGI_WIDTH : NULL};
}

static spring_records find_records(const mspring_network *network, mspringi_place place) {
    const mspringi_topology *t = &network->topology;
    const uint32_t parts = network->parts;
    if (place < t->lattice_places)
        return (spring_records){{lattice_record(network, place), {NULL, NULL, NULL}}, 1};
    if (place < t->chain_places)
        return (spring_records){
            {record_in(network->chain_springs, place - t->lattice_places, parts), {NULL, NULL, NULL}}, 1};
    const uint32_t *entry = t->web.entry + 2 * (size_t)(place - t->chain_places);
    return (spring_records){
        {record_in(network->web_springs, entry[0], parts), record_in(network->web_springs, entry[1], parts)}, 2};
}

mspringi_spring_values mspringi_place_get(const mspring_network *network, mspringi_place place) {
    const spring_record record = find_records(network, place).ends[0];
    mspringi_spring_values values = {
        .rest_length = *record.rest_length,
        .stiffness = *record.stiffness,
        .damping = record.damping ? *record.damping : 0.0f,
    };
    mspringi_topology_ends(&network->topology, place, &values.base, &values.tip);
    return values;
}

const mspringi_ramp *mspringi_place_ramp(const mspring_network *network, mspringi_place place) {
    const mspringi_ramps *ramps = &network->ramps;
    for (size_t i = 0; i < ramps->count; ++i)
        if (mspringi_place_of(&network->topology, ramps->list[i].spring) == place)
            return &ramps->list[i];
    return NULL;
}

float mspringi_place_own_length(const mspring_network *network, mspringi_place place) {
    const mspringi_ramp *ramp = mspringi_place_ramp(network, place);
    return ramp ? ramp->to : *find_records(network, place).ends[0].rest_length;
}

// Whether a spring was given with the higher id first.
static bool is_turned(const mspring_network *network, mspring_id spring) {
    const uint32_t first_spare = network->topology.reserve.first_spring;
    if (spring < first_spare)
        return network->turned && network->turned[spring / 8] >> spring % 8 & 1;
    const mspring_id *ends = network->growth.particle_of_end + 2 * (size_t)(spring - first_spare);
    return ends[0] > ends[1];
}

mspringi_ends mspringi_spring_ends(const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_place_of(t, spring), &base, &tip);
    return (t->particle_of_slot[base] > t->particle_of_slot[tip]) == is_turned(network, spring)
               ? (mspringi_ends){base, tip}
               : (mspringi_ends){tip, base};
}

uint32_t mspringi_spring_flags(const mspring_network *network, mspring_id spring) {
    const mspringi_place place = mspringi_place_of(&network->topology, spring);
    return (mspringi_spring_is_relative(network, spring) ? MSPRING_SPRING_RELATIVE : 0u) |
           mspringi_side_flags(network, spring) |
           (mspringi_place_is_live(network, place) ? 0u : MSPRING_SPRING_BROKEN) |
           (mspringi_place_is_stressed(network, place) ? MSPRING_SPRING_STRESSED : 0u);
}

mspringi_spring_values mspringi_spring_get(const mspring_network *network, mspring_id spring) {
    return mspringi_place_get(network, mspringi_place_of(&network->topology, spring));
}

void mspringi_place_set(mspring_network *network, mspringi_place place, float stiffness, float damping) {
    const spring_records records = find_records(network, place);
    mspringi_alike_part(network, place);
    for (int i = 0; i < records.count; ++i) {
        MSPRINGI_ASSERT(records.ends[i].damping || damping == 0.0f);
        *records.ends[i].stiffness = stiffness;
        if (records.ends[i].damping)
            *records.ends[i].damping = damping;
    }
    mspringi_changed(network, MSPRINGI_CHANGED_PLACE, place);
}

void mspringi_place_set_rest_length(mspring_network *network, mspringi_place place, float rest_length) {
    const spring_records records = find_records(network, place);
    MSPRINGI_ASSERT(place >= network->topology.lattice_places ||
                    !mspringi_rests_are_shared(&network->rests, place) ||
                    *records.ends[0].rest_length == rest_length);
    mspringi_alike_part_yielding(network, place);
    for (int i = 0; i < records.count; ++i)
        *records.ends[i].rest_length = rest_length;
    network->has_welds |= rest_length == MSPRINGI_WELD;
    mspringi_changed(network, MSPRINGI_CHANGED_PLACE, place);
}

void mspringi_place_copy(const mspring_network *from, mspringi_place had_place, mspring_network *to,
                         mspringi_place place) {
    const spring_record had = find_records(from, had_place).ends[0];
    const spring_records records = find_records(to, place);
    MSPRINGI_ASSERT(to->parts == from->parts);
    MSPRINGI_ASSERT(place >= to->topology.lattice_places || !mspringi_rests_are_shared(&to->rests, place) ||
                    *records.ends[0].rest_length == *had.rest_length);
    mspringi_alike_part(to, place);
    for (int i = 0; i < records.count; ++i) {
        const spring_record *record = &records.ends[i];
        *record->rest_length = *had.rest_length;
        *record->stiffness = *had.stiffness;
        if (record->damping)
            // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): both networks have it, or neither
            *record->damping = *had.damping;
    }
}

// Stiffness and damping of a relative spring for the substep that was derived for last.
static mspringi_relative derive(const mspring_network *network, const mspringi_spring_values *values,
                                mspringi_relative fractions) {
    const mspringi_topology *t = &network->topology;
    const float *mass = mspringi_spring_masses(network);
    const double reduced_mass = mspringi_reduced_mass((double)mass[t->particle_of_slot[values->base]],
                                                      (double)mass[t->particle_of_slot[values->tip]]);
    const double rate = mspringi_relative_rate(network);
    return (mspringi_relative){mspringi_derived_stiffness(fractions.stiffness, reduced_mass, rate),
                               mspringi_derived_damping(fractions.damping, reduced_mass, rate)};
}

mspringi_relative mspringi_spring_get_nominal(const mspring_network *network, mspring_id spring,
                                              mspringi_place place) {
    if (mspringi_spring_is_relative(network, spring))
        return mspringi_fractions_of(&network->fractions, spring);
    if (!mspringi_place_is_live(network, place)) {
        MSPRINGI_ASSERT(network->kept);
        return network->kept[spring];
    }
    const mspringi_spring_values values = mspringi_place_get(network, place);
    return (mspringi_relative){values.stiffness, values.damping};
}

void mspringi_spring_set_nominal(mspring_network *network, mspring_id spring, mspringi_place place,
                                 mspringi_relative nominal) {
    const bool relative = mspringi_spring_is_relative(network, spring);
    if (relative)
        mspringi_fractions_set(&network->fractions, spring, nominal);
    if (!mspringi_place_is_live(network, place)) {
        if (!relative)
            network->kept[spring] = nominal;
        return;
    }
    const mspringi_spring_values values = mspringi_place_get(network, place);
    if (relative)
        nominal = derive(network, &values, nominal);
    mspringi_place_set(network, place, nominal.stiffness, nominal.damping);
}

// While a snapshot is loaded, springs that are not there any more are live until its section of broken ones.
void mspringi_renew_relative(mspring_network *network) {
    for (mspring_id s = 0; s < network->topology.spring_count; ++s) {
        const mspringi_place place = network->topology.place_of_spring[s];
        if (mspringi_spring_exists(network, s) && mspringi_spring_is_relative(network, s) &&
            mspringi_place_is_live(network, place))
            mspringi_spring_set_nominal(network, s, place, mspringi_fractions_of(&network->fractions, s));
    }
}

void mspringi_derive_relative(mspring_network *network, float h) {
    if (!network->fractions.values || network->relative_h == h)
        return;
    network->relative_h = h;
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
