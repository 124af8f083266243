/// The stage in which rest lengths follow signals.
///
/// Most actuators lie in lattices, whose rest lengths lie by place: there a signal takes one store.
#include "features/actuators/actuators.h"

#include "base/assert.h"
#include "store/feature.h"
#include "store/metres.h"
#include "store/rest_lengths.h"
#include "store/spring_limits.h"
#include "store/springs.h"
#include "store/stages.h"

float mspringi_actuator_length(const mspring_network *network, uint32_t actuator) {
    return mspringi_spring_slot_given_length(
        network, mspringi_slot_of_spring(&network->topology, network->actuators->spring[actuator]));
}

void mspringi_actuator_set_length(mspring_network *network, uint32_t actuator, float length) {
    const mspringi_spring_slot spring_slot =
        mspringi_slot_of_spring(&network->topology, network->actuators->spring[actuator]);
    MSPRINGI_ASSERT(actuator < network->actuators->count && length >= 0.0f);
    if (mspringi_spring_slot_given_length(network, spring_slot) == length)
        return;
    mspringi_spring_slot_give_length(network, spring_slot, length);
    mspringi_metres_renew(network, network->actuators->spring[actuator]);
}

/* ----------------------------------------------------------------------------------------------- all at once */

// Rest lengths of lattices by place, if they may be set there.
static mspringi_spring_slot plain_end(const mspring_network *network) {
    return mspringi_actuators_are_plain(network) ? network->topology.lattice_spring_slots : 0;
}

static void keep_lengths(mspring_network *network) {
    const mspringi_actuators a = *network->actuators;
    const mspringi_spring_slot *spring_slots = network->topology.slot_of_spring, end = plain_end(network);
    const float *lengths = network->rest_lengths.lengths;
    for (uint32_t i = 0; i < a.count; ++i)
        a.from[i] = spring_slots[a.spring[i]] < end ? lengths[spring_slots[a.spring[i]]]
                                                    : mspringi_actuator_length(network, i);
    for (uint32_t i = 0; network->tested.nominal && i < a.count; ++i)
        a.bent_from[i] = mspringi_spring_slot_get(network, spring_slots[a.spring[i]]).rest_length;
}

static void set_lengths(mspring_network *network, const float *to) {
    const mspringi_actuators a = *network->actuators;
    const mspringi_spring_slot *spring_slots = network->topology.slot_of_spring, end = plain_end(network);
    float *lengths = network->rest_lengths.lengths;
    mspringi_sent_forget(&network->sent[mspringi_sent_index(MSPRING_REST_LENGTH)]);
    for (uint32_t i = 0; i < a.count; ++i) {
        if (spring_slots[a.spring[i]] < end)
            lengths[spring_slots[a.spring[i]]] = to[i];
        else
            mspringi_actuator_set_length(network, i, to[i]);
    }
}

// Set the lengths of a share of the way.
static void set_between(mspring_network *network, float share) {
    const mspringi_actuators a = *network->actuators;
    const mspringi_spring_slot *spring_slots = network->topology.slot_of_spring, end = plain_end(network);
    float *lengths = network->rest_lengths.lengths;
    mspringi_sent_forget(&network->sent[mspringi_sent_index(MSPRING_REST_LENGTH)]);
    for (uint32_t i = 0; i < a.count; ++i) {
        const float length = a.from[i] + (a.to[i] - a.from[i]) * share;
        if (spring_slots[a.spring[i]] < end)
            lengths[spring_slots[a.spring[i]]] = length;
        else
            mspringi_actuator_set_length(network, i, length);
    }
}

// Back to what the step began with, whatever has flowed in it.
static void go_back(mspring_network *network) {
    const mspringi_actuators a = *network->actuators;
    float *nominal = network->tested.nominal;
    set_lengths(network, a.from);
    for (uint32_t i = 0; nominal && i < a.count; ++i) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, a.spring[i]);
        if (mspringi_spring_slot_get(network, spring_slot).rest_length == a.bent_from[i])
            continue;
        mspringi_spring_slot_set_rest_length(network, spring_slot, a.bent_from[i]);
        mspringi_limits_renew(network, spring_slot);
    }
}

/* -------------------------------------------------------------------------------------------------- the stage */

bool mspringi_actuators_vary(const mspring_network *network) {
    return network->actuators && network->actuators->are_pending;
}

static bool are_gradual(const mspring_network *network) {
    return network->actuators->changes > 1;
}

static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return !are_gradual(network);
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    keep_lengths(network);
    if (!are_gradual(network))
        set_lengths(network, network->actuators->to);
}

// Changes that are due before this substep, the one that is due in it included.
static uint32_t changes_by(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const uint32_t changes = network->actuators->changes, n = attempt->substeps;
    return changes >= n ? substep + 1 : (uint32_t)((uint64_t)substep * changes / n) + 1;
}

static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    uint32_t count = 1;
    if (!are_gradual(network))
        return attempt->substeps - substep;
    while (substep + count < attempt->substeps &&
           changes_by(network, attempt, substep + count) == changes_by(network, attempt, substep))
        ++count;
    return count;
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    const uint32_t changes = network->actuators->changes, n = attempt->substeps;
    const uint32_t all = changes < n ? changes : n, by = changes_by(network, attempt, substep);
    if (!are_gradual(network) || (substep > 0 && by == changes_by(network, attempt, substep - 1)))
        return base;
    if (by == all)
        set_lengths(network, network->actuators->to);
    else
        set_between(network, (float)by / (float)all);
    return base;
}

static void roll_back(mspring_network *network) {
    if (are_gradual(network))
        go_back(network);
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    network->actuators->are_pending = false;
}

static void undo(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    go_back(network);
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_actuators, member, MSPRINGI_ARRAY)
static const mspringi_array_entry arrays[] = {ARRAY(spring), ARRAY(of_spring), ARRAY(nominal),
                                              ARRAY(to),     ARRAY(from),      ARRAY(bent_from)};
#undef ARRAY
const mspringi_feature_state mspringi_state_of_actuators = {MSPRINGI_ARRAY_TABLE(arrays), NULL};

const mspringi_stage mspringi_stage_actuators = {.is_used = mspringi_actuators_vary,
                                                 .before_step = before_step,
                                                 .is_quiet = is_quiet,
                                                 .free_substeps = free_substeps,
                                                 .before_substep = before_substep,
                                                 .roll_back = roll_back,
                                                 .after_step = after_step,
                                                 .undo = undo};
