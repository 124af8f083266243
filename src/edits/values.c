/// Editing springs between steps: stiffness, damping, rest length.
#include "edits/values.h"

#include "base/cpu.h"
#include "step/ramps.h"
#include "store/changed.h"
#include "store/rests.h"
#include "store/selection.h"
#include "store/springs.h"

#define LARGEST_VALUE 1e30f
#define LARGEST_LENGTH 4e12f

// NaN is none of these.
bool mspringi_is_spring_value(mspringi_part part, float value) {
    return part == MSPRINGI_REST_LENGTH ? value > 0.0f && value <= LARGEST_LENGTH
                                        : value >= 0.0f && value <= LARGEST_VALUE;
}

static mspring_result check_values(mspring_network *network, mspringi_part part, const mspringi_selection *at,
                                   const float *values) {
    static const char *const names[] = {"rest length", "stiffness", "damping"};
    static const char *const ranges[] = {"> 0 and at most 4e12", "0 to 1e30", "0 to 1e30"};
    for (uint32_t i = 0; i < at->count; ++i) {
        const unsigned spring = (unsigned)mspringi_selected(at, i);
        if (!mspringi_is_spring_value(part, values[i]))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "spring %u: %s is %g, it must be %s",
                                 spring, names[part], (double)values[i], ranges[part]);
        if (part == MSPRINGI_DAMPING && values[i] > 0.0f && network->parts <= MSPRINGI_DAMPING)
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "spring %u: damping is %g, but the network was created without room for any "
                                 "(MSPRING_NETWORK_RESERVE_DAMPING)",
                                 spring, (double)values[i]);
    }
    return MSPRING_OK;
}

// Whether some relative spring gets other fractions than it has.
static bool changes_fractions(const mspring_network *network, mspringi_part part, const mspringi_selection *at,
                              const float *values) {
    for (uint32_t i = 0; network->fractions.of_spring && i < at->count; ++i) {
        const mspring_id spring = mspringi_selected(at, i);
        const mspringi_relative had = mspringi_fractions_of(&network->fractions, spring);
        if (mspringi_spring_is_relative(network, spring) &&
            values[i] != (part == MSPRINGI_STIFFNESS ? had.stiffness : had.damping))
            return true;
    }
    return false;
}

static mspring_result separate(mspring_network *network, mspringi_part part, const mspringi_selection *at,
                               const float *values) {
    if (part == MSPRINGI_REST_LENGTH)
        return mspringi_rests_separate(network);
    return changes_fractions(network, part, at, values) ? mspringi_fractions_separate(network) : MSPRING_OK;
}

static MSPRINGI_NOINLINE void store_values(mspring_network *network, mspringi_part part,
                                           const mspringi_selection *at, const float *values) {
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id spring = mspringi_selected(at, i);
        if (!mspringi_spring_exists(network, spring))
            continue;
        const mspringi_place place = mspringi_place_of(&network->topology, spring);
        mspringi_fingerprint(network, MSPRINGI_EDIT_PARTS + (uint32_t)part, spring);
        mspringi_fingerprint_floats(network, values[i], 0.0f);
        mspringi_changed(network, MSPRINGI_CHANGED_SPRING, spring);
        if (part == MSPRINGI_REST_LENGTH) {
            mspringi_ramp_drop(network, spring);
            mspringi_place_set_rest_length(network, place, values[i]);
            continue;
        }
        mspringi_relative nominal = mspringi_spring_get_nominal(network, spring, place);
        if (part == MSPRINGI_STIFFNESS)
            nominal.stiffness = values[i];
        else
            nominal.damping = values[i];
        mspringi_spring_set_nominal(network, spring, place, nominal);
    }
}

static mspring_result set_values(mspring_network *network, mspringi_part part, const mspringi_selection *at,
                                 const float *values) {
    mspring_result result = check_values(network, part, at, values);
    if (result == MSPRING_OK)
        result = separate(network, part, at, values);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    store_values(network, part, at, values);
    mspringi_fp_leave(before);
    mspringi_changed(network, MSPRINGI_CHANGED_SPRING_VALUES, 0);
    return MSPRING_OK;
}

static mspring_result set_range(mspring_network *network, mspringi_part part, mspring_id first, uint32_t count,
                                const float *values) {
    mspringi_selection at;
    mspring_result result = mspringi_select_range(network, MSPRINGI_SPRINGS, first, count, values, values, &at);
    return result == MSPRING_OK ? set_values(network, part, &at, values) : result;
}

static mspring_result set_list(mspring_network *network, mspringi_part part, const mspring_id *springs,
                               uint32_t count, const float *values) {
    mspringi_selection at;
    mspring_result result = mspringi_select_list(network, MSPRINGI_SPRINGS, springs, count, values, values, &at);
    return result == MSPRING_OK ? set_values(network, part, &at, values) : result;
}

mspring_result mspring_network_set_stiffnesses(mspring_network *network, mspring_id first, uint32_t count,
                                               const float *stiffness) {
    return set_range(network, MSPRINGI_STIFFNESS, first, count, stiffness);
}

mspring_result mspring_network_set_stiffnesses_at(mspring_network *network, const mspring_id *springs,
                                                  uint32_t count, const float *stiffness) {
    return set_list(network, MSPRINGI_STIFFNESS, springs, count, stiffness);
}

mspring_result mspring_network_set_dampings(mspring_network *network, mspring_id first, uint32_t count,
                                            const float *damping) {
    return set_range(network, MSPRINGI_DAMPING, first, count, damping);
}

mspring_result mspring_network_set_dampings_at(mspring_network *network, const mspring_id *springs, uint32_t count,
                                               const float *damping) {
    return set_list(network, MSPRINGI_DAMPING, springs, count, damping);
}

mspring_result mspring_network_set_rest_lengths(mspring_network *network, mspring_id first, uint32_t count,
                                                const float *rest_length) {
    return set_range(network, MSPRINGI_REST_LENGTH, first, count, rest_length);
}

mspring_result mspring_network_set_rest_lengths_at(mspring_network *network, const mspring_id *springs,
                                                   uint32_t count, const float *rest_length) {
    return set_list(network, MSPRINGI_REST_LENGTH, springs, count, rest_length);
}
