/// Breaking and restoring springs.
#include "breaking.h"

#include "base/cpu.h"
#include "compact/compact.h"
#include "events.h"
#include "network/springs.h"
#include "ramps.h"
#include "selection.h"
#include "sleep/sleep.h"

/// Longest log of broken and restored springs: more than a burst of them in one frame.
#define LONGEST_LOG 4096

mspring_result mspringi_breaking_reserve(mspring_network *network) {
    if (network->edits.link_log)
        return MSPRING_OK;
    mspringi_memory *memory = &network->memory;
    const uint32_t springs = network->topology.spring_count;
    uint32_t log_size = 1;
    while (log_size < springs && log_size < LONGEST_LOG)
        log_size *= 2;
    bool any_absolute = false;
    for (mspring_id s = 0; s < springs && !any_absolute; ++s)
        any_absolute = !mspringi_spring_is_relative(network, s);
    if (any_absolute && !network->kept)
        network->kept = mspringi_alloc(memory, springs, sizeof *network->kept);
    if (network->kept || !any_absolute)
        network->edits.link_log = mspringi_alloc(memory, log_size, sizeof *network->edits.link_log);
    if (!network->edits.link_log)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for breaking any of %u springs",
                             (unsigned)springs);
    network->edits.link_mask = log_size - 1;
    return MSPRING_OK;
}

static void toggle(mspring_network *network, mspring_id spring, mspringi_place place) {
    network->live[place / MSPRINGI_WIDTH] ^= (uint16_t)(1u << place % MSPRINGI_WIDTH);
    network->edits.link_log[network->edits.links++ & network->edits.link_mask] = spring;
    mspringi_wake_spring(network, spring);
}

bool mspringi_spring_break(mspring_network *network, mspring_id spring) {
    const mspringi_place place = mspringi_place_of(&network->topology, spring);
    if (!mspringi_place_is_live(network, place))
        return false;
    mspringi_ramp_drop(network, spring);
    const mspringi_spring_values values = mspringi_place_get(network, place);
    if (!mspringi_spring_is_relative(network, spring))
        network->kept[spring] = (mspringi_relative){values.stiffness, values.damping};
    mspringi_place_set(network, place, 0.0f, 0.0f);
    toggle(network, spring, place);
    if (network->strain.stressed)
        network->strain.stressed[place / MSPRINGI_WIDTH] &= (uint16_t) ~(1u << place % MSPRINGI_WIDTH);
    return true;
}

bool mspringi_spring_restore(mspring_network *network, mspring_id spring) {
    const mspringi_place place = mspringi_place_of(&network->topology, spring);
    if (mspringi_place_is_live(network, place))
        return false;
    const mspringi_relative nominal = mspringi_spring_get_nominal(network, spring, place);
    toggle(network, spring, place);
    mspringi_spring_set_nominal(network, spring, place, nominal);
    return true;
}

/* --------------------------------------------------------------------------------------------------- by lists */

static void push_event(mspring_network *network, mspring_event_kind kind, mspring_id id, mspring_id other) {
    mspringi_events_push(network, (mspring_event){.kind = kind, .id = id, .other = other});
}

mspring_result mspring_network_break_springs(mspring_network *network, const mspring_id *springs, uint32_t count) {
    mspringi_selection at;
    const uint32_t total = mspring_network_spring_count(network);
    mspring_result result = mspringi_select_list(network, "spring", total, springs, count, springs, springs, &at);
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
    const uint32_t total = mspring_network_spring_count(network);
    mspring_result result = mspringi_select_list(network, "spring", total, springs, count, springs, springs, &at);
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
    const uint32_t total = mspring_network_particle_count(network);
    mspring_result result =
        mspringi_select_list(network, "particle", total, particles, count, particles, particles, &at);
    if (result == MSPRING_OK && count > 0)
        result = mspringi_breaking_reserve(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_incidence *incidence = &network->incidence;
    if (count > 0 && !incidence->first)
        result =
            mspringi_incidence_create(&network->incidence, &network->topology, &network->memory, &network->message);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        for (uint32_t j = incidence->first[particles[i]]; j < incidence->first[particles[i] + 1]; ++j)
            if (mspringi_spring_break(network, incidence->springs[j]))
                push_event(network, MSPRING_EVENT_BROKEN, incidence->springs[j], particles[i]);
        push_event(network, MSPRING_EVENT_DETACHED, particles[i], MSPRING_NONE);
    }
    return result;
}
