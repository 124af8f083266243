/// Breaking and restoring springs.
#include "breaking.h"

#include "base/cpu.h"
#include "network/springs.h"

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

static void toggle(mspring_network *network, mspring_id spring) {
    const mspringi_place place = network->topology.place_of_spring[spring];
    network->live[place / MSPRINGI_WIDTH] ^= (uint16_t)(1u << place % MSPRINGI_WIDTH);
    network->edits.link_log[network->edits.links++ & network->edits.link_mask] = spring;
}

bool mspringi_spring_break(mspring_network *network, mspring_id spring) {
    if (!mspringi_spring_is_live(network, spring))
        return false;
    mspringi_spring_values values = mspringi_spring_get(network, spring);
    if (!mspringi_spring_is_relative(network, spring))
        network->kept[spring] = (mspringi_relative){values.stiffness, values.damping};
    values.stiffness = values.damping = 0.0f;
    mspringi_spring_set(network, spring, &values);
    toggle(network, spring);
    return true;
}

bool mspringi_spring_restore(mspring_network *network, mspring_id spring) {
    if (mspringi_spring_is_live(network, spring))
        return false;
    const mspringi_relative nominal = mspringi_spring_get_nominal(network, spring);
    toggle(network, spring);
    mspringi_spring_set_nominal(network, spring, nominal);
    return true;
}

static mspring_result check_list(mspring_network *network, const mspring_id *springs, uint32_t count) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (count > 0 && !springs)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "a list of %u springs is NULL",
                             (unsigned)count);
    for (uint32_t i = 0; i < count; ++i)
        if (springs[i] >= network->topology.spring_count)
            return mspringi_fail(&network->message, MSPRING_ERROR_ID,
                                 "index %u of the list: there is no spring %u, only %u", (unsigned)i,
                                 (unsigned)springs[i], (unsigned)network->topology.spring_count);
    return MSPRING_OK;
}

mspring_result mspring_network_break_springs(mspring_network *network, const mspring_id *springs, uint32_t count) {
    mspring_result result = check_list(network, springs, count);
    if (result == MSPRING_OK && count > 0)
        result = mspringi_breaking_reserve(network);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        (void)mspringi_spring_break(network, springs[i]);
    return result;
}

static MSPRINGI_NOINLINE void restore_all(mspring_network *network, const mspring_id *springs, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i)
        (void)mspringi_spring_restore(network, springs[i]);
}

mspring_result mspring_network_restore_springs(mspring_network *network, const mspring_id *springs,
                                               uint32_t count) {
    mspring_result result = check_list(network, springs, count);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    restore_all(network, springs, count);
    mspringi_fp_leave(before);
    return MSPRING_OK;
}
