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

mspring_result mspring_network_break_springs(mspring_network *network, const mspring_id *ids, mspring_id first,
                                             uint32_t count) {
    mspringi_selection at;
    mspring_result result = mspringi_select(network, MSPRING_SPRINGS, ids, first, count, &at);
    if (result == MSPRING_OK && at.count > 0)
        result = mspringi_breaking_reserve(network);
    for (uint32_t i = 0; result == MSPRING_OK && i < at.count; ++i) {
        const mspring_id spring = mspringi_selected(&at, i);
        if (mspringi_spring_exists(network, spring) && mspringi_spring_break(network, spring))
            push_event(network, MSPRING_EVENT_BROKEN, spring, MSPRING_NONE);
    }
    return result;
}

static MSPRINGI_NOINLINE void restore_all(mspring_network *network, const mspringi_selection *at,
                                          double ramp_seconds) {
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id spring = mspringi_selected(at, i);
        if (!mspringi_spring_exists(network, spring) || !mspringi_spring_restore(network, spring))
            continue;
        if (ramp_seconds > 0.0)
            mspringi_ramp_begin(network, spring, ramp_seconds);
        push_event(network, MSPRING_EVENT_RESTORED, spring, MSPRING_NONE);
    }
}

mspring_result mspring_network_restore_springs(mspring_network *network, const mspring_id *ids, mspring_id first,
                                               uint32_t count, double ramp_seconds) {
    mspringi_selection at;
    mspring_result result = mspringi_select(network, MSPRING_SPRINGS, ids, first, count, &at);
    if (result == MSPRING_OK && !(ramp_seconds >= 0.0 && ramp_seconds <= MSPRINGI_LONGEST_RAMP))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the ramp is %g s long, it must be 0 to 1e6", ramp_seconds);
    if (result == MSPRING_OK && ramp_seconds > 0.0)
        result = mspringi_ramps_reserve(network, at.count);
    for (uint32_t i = 0; result == MSPRING_OK && i < at.count; ++i)
        if (mspringi_spring_exists(network, mspringi_selected(&at, i)) &&
            mspringi_spring_is_inactive(network, mspringi_selected(&at, i)))
            result = mspringi_expand(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    restore_all(network, &at, ramp_seconds);
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

static void detach(mspring_network *network, mspring_id particle) {
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, particle);
    for (mspring_id s; (s = mspringi_incident_springs_next(network, &around)) != MSPRING_NONE;)
        if (mspringi_spring_break(network, s))
            push_event(network, MSPRING_EVENT_BROKEN, s, particle);
    push_event(network, MSPRING_EVENT_DETACHED, particle, MSPRING_NONE);
}

mspring_result mspring_network_detach_particles(mspring_network *network, const mspring_id *ids, mspring_id first,
                                                uint32_t count) {
    mspringi_selection at;
    mspring_result result = mspringi_select(network, MSPRING_PARTICLES, ids, first, count, &at);
    if (result == MSPRING_OK && at.count > 0)
        result = mspringi_breaking_reserve(network);
    if (result == MSPRING_OK && at.count > 0)
        result = mspringi_incidence_reserve(network);
    for (uint32_t i = 0; result == MSPRING_OK && i < at.count; ++i)
        if (mspringi_particle_exists(network, mspringi_selected(&at, i)))
            detach(network, mspringi_selected(&at, i));
    return result;
}
