/// Breaking and restoring springs.
#include "breaking.h"

#include "base/cpu.h"
#include "compact/compact.h"
#include "events.h"
#include "growth.h"
#include "network/springs.h"
#include "ramps.h"
#include "selection.h"
#include "store/changed.h"

/// Longest log of broken and restored springs: more than a burst of them in one frame.
#define LONGEST_LOG 4096

static mspring_result fail_for_memory(mspring_network *network) {
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for breaking any of %u springs",
                         (unsigned)network->topology.spring_count);
}

mspring_result mspringi_breaking_reserve_log(mspring_network *network) {
    const uint32_t springs = network->topology.reserve.spring_end;
    uint32_t log_size = 1;
    if (network->edits.link_log)
        return MSPRING_OK;
    while (log_size < springs && log_size < LONGEST_LOG)
        log_size *= 2;
    network->edits.link_log = mspringi_alloc(&network->memory, log_size, sizeof *network->edits.link_log);
    if (!network->edits.link_log)
        return fail_for_memory(network);
    network->edits.link_mask = log_size - 1;
    return MSPRING_OK;
}

mspring_result mspringi_breaking_reserve(mspring_network *network) {
    const mspringi_reserve *reserve = &network->topology.reserve;
    bool any_absolute = reserve->spring_end > reserve->first_spring;
    if (network->kept || network->keeps_none)
        return mspringi_breaking_reserve_log(network);
    for (mspring_id s = 0; s < reserve->first_spring && !any_absolute; ++s)
        any_absolute = !mspringi_spring_is_relative(network, s);
    if (any_absolute)
        network->kept = mspringi_alloc(&network->memory, reserve->spring_end, sizeof *network->kept);
    network->keeps_none = !any_absolute;
    return network->kept || !any_absolute ? mspringi_breaking_reserve_log(network) : fail_for_memory(network);
}

static void toggle(mspring_network *network, mspringi_place place) {
    network->live[place / MSPRINGI_WIDTH] ^= (uint16_t)(1u << place % MSPRINGI_WIDTH);
}

void mspringi_spring_come_live(mspring_network *network, mspring_id spring) {
    toggle(network, mspringi_place_of(&network->topology, spring));
    mspringi_changed(network, MSPRINGI_CHANGED_LIVE_SPRING, spring);
}

bool mspringi_spring_break(mspring_network *network, mspring_id spring) {
    const mspringi_place place = mspringi_place_of(&network->topology, spring);
    if (!mspringi_place_is_live(network, place))
        return false;
    mspringi_ramp_drop(network, spring);
    const mspringi_spring_values values = mspringi_place_get(network, place);
    MSPRINGI_ASSERT(network->kept || network->keeps_none);
    if (!mspringi_spring_is_relative(network, spring))
        network->kept[spring] = (mspringi_relative){values.stiffness, values.damping};
    mspringi_place_set(network, place, 0.0f, 0.0f);
    toggle(network, place);
    if (network->strain.stressed)
        network->strain.stressed[place / MSPRINGI_WIDTH] &= (uint16_t) ~(1u << place % MSPRINGI_WIDTH);
    mspringi_changed(network, MSPRINGI_CHANGED_BROKEN_SPRING, spring);
    return true;
}

bool mspringi_spring_restore(mspring_network *network, mspring_id spring) {
    const mspringi_place place = mspringi_place_of(&network->topology, spring);
    if (mspringi_place_is_live(network, place))
        return false;
    const mspringi_relative nominal = mspringi_spring_get_nominal(network, spring, place);
    mspringi_spring_come_live(network, spring);
    mspringi_spring_set_nominal(network, spring, place, nominal);
    return true;
}

/* --------------------------------------------------------------------------------------------------- by lists */

static void push_event(mspring_network *network, mspring_event_kind kind, mspring_id id, mspring_id other) {
    mspringi_events_push(network, (mspring_event){.kind = kind, .id = id, .other = other});
}

mspring_result mspring_network_break_springs(mspring_network *network, const mspring_id *springs, uint32_t count) {
    mspringi_selection at;
    mspring_result result = mspringi_select_list(network, MSPRINGI_SPRINGS, springs, count, springs, springs, &at);
    if (result == MSPRING_OK && count > 0)
        result = mspringi_breaking_reserve(network);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        if (mspringi_spring_break(network, springs[i]))
            push_event(network, MSPRING_EVENT_BROKEN, springs[i], MSPRING_NONE);
    return result;
}

static MSPRINGI_NOINLINE void restore_all(mspring_network *network, const mspring_id *springs, uint32_t count,
                                          double ramp_seconds) {
    for (uint32_t i = 0; i < count; ++i) {
        if (!mspringi_spring_restore(network, springs[i]))
            continue;
        if (ramp_seconds > 0.0)
            mspringi_ramp_begin(network, springs[i], ramp_seconds);
        push_event(network, MSPRING_EVENT_RESTORED, springs[i], MSPRING_NONE);
    }
}

mspring_result mspring_network_restore_springs(mspring_network *network, const mspring_id *springs, uint32_t count,
                                               double ramp_seconds) {
    mspringi_selection at;
    mspring_result result = mspringi_select_list(network, MSPRINGI_SPRINGS, springs, count, springs, springs, &at);
    if (result == MSPRING_OK && !(ramp_seconds >= 0.0 && ramp_seconds <= MSPRINGI_LONGEST_RAMP))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the ramp is %g s long, it must be 0 to 1e6", ramp_seconds);
    if (result == MSPRING_OK && ramp_seconds > 0.0)
        result = mspringi_ramps_reserve(network, count);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        if (mspringi_spring_is_parked(network, springs[i]))
            result = mspringi_expand(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    restore_all(network, springs, count, ramp_seconds);
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

mspring_result mspring_network_detach_particles(mspring_network *network, const mspring_id *particles,
                                                uint32_t count) {
    mspringi_selection at;
    mspring_result result =
        mspringi_select_list(network, MSPRINGI_PARTICLES, particles, count, particles, particles, &at);
    if (result == MSPRING_OK && count > 0)
        result = mspringi_breaking_reserve(network);
    if (result != MSPRING_OK)
        return result;
    if (count > 0)
        result = mspringi_incidence_reserve(network);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        mspringi_around around = mspringi_around_begin(network, particles[i]);
        for (mspring_id s; (s = mspringi_around_next(network, &around)) != MSPRING_NONE;)
            if (mspringi_spring_break(network, s))
                push_event(network, MSPRING_EVENT_BROKEN, s, particles[i]);
        push_event(network, MSPRING_EVENT_DETACHED, particles[i], MSPRING_NONE);
    }
    return result;
}
