/// Breaking and restoring a spring.
#include "features/breaking/breaking.h"

#include "features/ramps/ramps.h"
#include "store/changed.h"
#include "store/springs.h"

static mspring_result fail_for_memory(mspring_network *network) {
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for breaking any of %u springs",
                         (unsigned)network->topology.spring_count);
}

mspring_result mspringi_breaking_reserve(mspring_network *network) {
    const mspringi_reserve *reserve = &network->topology.reserve;
    bool any_absolute = reserve->spring_end > reserve->first_spring;
    if (network->kept || network->keeps_none)
        return mspringi_changed_reserve_log(network);
    for (mspring_id s = 0; s < reserve->first_spring && !any_absolute; ++s)
        any_absolute = !mspringi_spring_is_relative(network, s);
    if (any_absolute)
        network->kept = mspringi_alloc(&network->memory, reserve->spring_end, sizeof *network->kept);
    network->keeps_none = !any_absolute;
    return network->kept || !any_absolute ? mspringi_changed_reserve_log(network) : fail_for_memory(network);
}

static void toggle(mspring_network *network, mspringi_spring_slot spring_slot) {
    network->live[spring_slot / MSPRINGI_WIDTH] ^= (uint16_t)(1u << spring_slot % MSPRINGI_WIDTH);
}

void mspringi_spring_come_live(mspring_network *network, mspring_id spring) {
    toggle(network, mspringi_slot_of_spring(&network->topology, spring));
    mspringi_notify_change(network, MSPRINGI_CHANGED_LIVE_SPRING, spring);
}

bool mspringi_spring_break(mspring_network *network, mspring_id spring) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    if (!mspringi_spring_slot_is_live(network, spring_slot))
        return false;
    mspringi_ramp_drop(network, spring);
    const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
    MSPRINGI_ASSERT(network->kept || network->keeps_none);
    if (!mspringi_spring_is_relative(network, spring))
        network->kept[spring] = (mspringi_relative){values.stiffness, values.damping};
    mspringi_spring_slot_set(network, spring_slot, 0.0f, 0.0f);
    toggle(network, spring_slot);
    if (network->strain.stressed)
        network->strain.stressed[spring_slot / MSPRINGI_WIDTH] &= (uint16_t) ~(1u << spring_slot % MSPRINGI_WIDTH);
    mspringi_notify_change(network, MSPRINGI_CHANGED_BROKEN_SPRING, spring);
    return true;
}

bool mspringi_spring_restore(mspring_network *network, mspring_id spring) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    if (mspringi_spring_slot_is_live(network, spring_slot))
        return false;
    const mspringi_relative nominal = mspringi_spring_get_nominal(network, spring, spring_slot);
    mspringi_spring_come_live(network, spring);
    mspringi_spring_set_nominal(network, spring, spring_slot, nominal);
    return true;
}
