/// Ramps of rest lengths.
#include "features/ramps/ramps.h"

#include <math.h>

#include "base/assert.h"
#include "store/feature.h"
#include "store/rest_lengths.h"
#include "store/spring_limits.h"
#include "store/springs.h"
#include "store/stages.h"

/// Shortest rest length that a ramp starts from, as a fraction of the spring's own: strain divides by it.
#define SHORTEST_START 1e-3

// A spring yields again, or no more.
static void follow(mspring_network *network, mspring_id spring) {
    if (network->tested.nominal)
        mspringi_limits_renew(network, mspringi_slot_of_spring(&network->topology, spring));
}

static bool grow(mspring_network *network, size_t count) {
    if (!network->ramps)
        network->ramps = mspringi_alloc(&network->memory, 1, sizeof *network->ramps);
    mspringi_ramps *ramps = network->ramps;
    if (ramps && !ramps->of_spring)
        ramps->of_spring =
            mspringi_alloc(&network->memory, network->topology.reserve.spring_end, sizeof *ramps->of_spring);
    void *list = ramps ? ramps->list : NULL;
    const bool grown =
        ramps && ramps->of_spring &&
        mspringi_grow(&network->memory, &list, &ramps->capacity, ramps->count + count, sizeof *ramps->list);
    if (grown)
        ramps->list = list;
    return grown;
}

mspring_result mspringi_ramps_reserve(mspring_network *network, size_t count) {
    mspring_result result = mspringi_rest_lengths_unshare(network);
    if (result != MSPRING_OK)
        return result;
    return grow(network, count) ? MSPRING_OK
                                : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                                                "no memory for the ramps of %zu springs", count);
}

// Put a ramp at a place of the list.
static void put(const mspringi_ramps *ramps, size_t place, const mspringi_ramp *ramp) {
    MSPRINGI_ASSERT(place < ramps->capacity && ramp->seconds > 0.0);
    ramps->list[place] = *ramp;
    ramps->of_spring[ramp->spring] = (uint32_t)place;
}

void mspringi_ramp_add(mspring_network *network, const mspringi_ramp *ramp) {
    put(network->ramps, network->ramps->count++, ramp);
    follow(network, ramp->spring);
}

void mspringi_ramp_begin(mspring_network *network, mspring_id spring, double seconds) {
    const mspringi_state *s = &network->state;
    const mspringi_spring_values values = mspringi_spring_get(network, spring);
    if (values.rest_length == MSPRINGI_WELD)
        return; // on its way it would be strained by its rest length, and then by the metre
    const double dx = (double)s->x[values.tip] - (double)s->x[values.base];
    const double dy = (double)s->y[values.tip] - (double)s->y[values.base];
    const double length = sqrt(dx * dx + dy * dy), shortest = SHORTEST_START * (double)values.rest_length;
    const mspringi_ramp ramp = {.spring = spring,
                                .from = length > shortest ? length : shortest,
                                .to = values.rest_length,
                                .seconds = seconds};
    mspringi_ramp_add(network, &ramp);
    mspringi_spring_slot_set_rest_length(network, mspringi_slot_of_spring(&network->topology, spring),
                                         (float)ramp.from);
}

// A spring's ramp, or NULL.
static mspringi_ramp *find(const mspring_network *network, mspring_id spring) {
    const mspringi_ramps *ramps = network->ramps;
    if (mspringi_ramp_count(network) == 0 || ramps->of_spring[spring] >= ramps->count)
        return NULL;
    mspringi_ramp *ramp = &ramps->list[ramps->of_spring[spring]];
    return ramp->spring == spring ? ramp : NULL;
}

bool mspringi_has_ramp(const mspring_network *network, mspring_id spring) {
    return find(network, spring) != NULL;
}

void mspringi_ramp_drop(mspring_network *network, mspring_id spring) {
    mspringi_ramps *ramps = network->ramps;
    const mspringi_ramp *ramp = find(network, spring);
    if (!ramp)
        return;
    mspringi_spring_slot_set_rest_length(network, mspringi_slot_of_spring(&network->topology, spring), ramp->to);
    put(ramps, (size_t)(ramp - ramps->list), &ramps->list[ramps->count - 1]);
    ramps->count--;
    follow(network, spring);
}

void mspringi_ramps_clear(mspring_network *network) {
    mspringi_ramps *ramps = network->ramps;
    const size_t count = mspringi_ramp_count(network);
    if (count == 0)
        return;
    for (size_t i = 0; i < count; ++i)
        mspringi_spring_slot_set_rest_length(
            network, mspringi_slot_of_spring(&network->topology, ramps->list[i].spring), ramps->list[i].to);
    ramps->count = 0;
    for (size_t i = 0; i < count; ++i)
        follow(network, ramps->list[i].spring);
}

void mspringi_ramps_apply(mspring_network *network, double dt) {
    for (size_t i = 0; i < mspringi_ramp_count(network); ++i) {
        const mspringi_ramp *ramp = &network->ramps->list[i];
        const double passed = (ramp->passed + dt) / ramp->seconds;
        const double rest_length = ramp->from + ((double)ramp->to - ramp->from) * passed;
        mspringi_spring_slot_set_rest_length(network, mspringi_slot_of_spring(&network->topology, ramp->spring),
                                             passed < 1.0 ? (float)rest_length : ramp->to);
    }
}

// Let dt seconds pass, and forget the ramps that have come to their end.
static void pass(mspring_network *network, double dt) {
    mspringi_ramps *ramps = network->ramps;
    const size_t count = ramps->count;
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        mspringi_ramp ramp = ramps->list[i];
        ramp.passed += dt;
        put(ramps, i, &ramps->list[kept]);
        put(ramps, kept, &ramp);
        kept += ramp.passed < ramp.seconds;
    }
    ramps->count = kept;
    for (size_t i = kept; i < count; ++i)
        follow(network, ramps->list[i].spring);
}

static const mspringi_array_entry arrays[] = {MSPRINGI_ARRAY_ENTRY(mspringi_ramps, list, MSPRINGI_ARRAY),
                                              MSPRINGI_ARRAY_ENTRY(mspringi_ramps, of_spring, MSPRINGI_ARRAY)};
const mspringi_feature_state mspringi_state_of_ramps = {MSPRINGI_ARRAY_TABLE(arrays), NULL};

bool mspringi_ramps_vary(const mspring_network *network) {
    return mspringi_ramp_count(network) > 0;
}

static void go_along(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_ramps_apply(network, attempt->dt);
}

static void go_back(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    mspringi_ramps_apply(network, 0.0);
}

const mspringi_stage mspringi_stage_ramps = {
    .is_used = mspringi_ramps_vary, .before_step = go_along, .after_step = pass, .undo = go_back};
