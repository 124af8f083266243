/// Breaking and restoring springs, and detaching particles, by the host.
#include "base/cpu.h"
#include "features/breaking/breaking.h"
#include "features/ramps/ramps.h"
#include "network/compact.h"
#include "store/events.h"
#include "store/id_pool.h"
#include "store/selection.h"

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
        if (mspringi_spring_is_inactive(network, springs[i]))
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
        mspringi_incident_springs around = mspringi_incident_springs_begin(network, particles[i]);
        for (mspring_id s; (s = mspringi_incident_springs_next(network, &around)) != MSPRING_NONE;)
            if (mspringi_spring_break(network, s))
                push_event(network, MSPRING_EVENT_BROKEN, s, particles[i]);
        push_event(network, MSPRING_EVENT_DETACHED, particles[i], MSPRING_NONE);
    }
    return result;
}
