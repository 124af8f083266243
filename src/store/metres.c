/// Limits of springs in metres.
#include "store/metres.h"

#include "store/changed.h"
#include "store/properties.h"
#include "store/spring_limits.h"
#include "store/springs.h"
#include "store/store.h"

mspring_result mspringi_metres_reserve(mspring_network *network, uint32_t flags) {
    if (!(flags & MSPRING_SPRING_METRES) || network->metres ||
        mspringi_store_reserve(network, MSPRINGI_STORE_METRES))
        return MSPRING_OK;
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for limits in metres of %u springs",
                         (unsigned)network->topology.spring_count);
}

mspringi_limits mspringi_metres_put(mspring_network *network, mspring_id spring, mspringi_limits limits) {
    const float length =
        limits.nominal_length > 0.0f
            ? limits.nominal_length
            : mspringi_spring_slot_given_length(network, mspringi_slot_of_spring(&network->topology, spring));
    float *const all[MSPRINGI_METRES] = {&limits.break_strain, &limits.warn_strain, &limits.relax_strain,
                                         &limits.yield_strain};
    float *metres = network->metres + (size_t)MSPRINGI_METRES * spring;
    for (int i = 0; i < MSPRINGI_METRES; ++i) {
        metres[i] = mspringi_broken_value(*all[i]);
        *all[i] = mspringi_strain_of_metres(*all[i], length);
        mspringi_fingerprint_floats(network, metres[i], 0.0f);
    }
    return limits;
}

float mspringi_metres_set(mspring_network *network, mspring_property property, mspring_id spring, float value) {
    float *metres = mspringi_metres_at(network, property, spring);
    if (!metres)
        return value;
    *metres = value;
    return mspringi_broken_value(mspringi_strain_of_metres(
        value, mspringi_spring_slot_given_length(network, mspringi_slot_of_spring(&network->topology, spring))));
}

void mspringi_metres_renew(mspring_network *network, mspring_id spring) {
    const float *metres = mspringi_metres_of(network, spring);
    if (!metres)
        return;
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    const float length = mspringi_spring_slot_given_length(network, spring_slot);
    for (int i = 0; i < MSPRINGI_METRES; ++i) {
        const mspring_property property = (mspring_property)(MSPRING_BREAK_STRAIN + i);
        const float *strains = mspringi_limits_of(network, property);
        const float strain = mspringi_broken_value(mspringi_strain_of_metres(metres[i], length));
        if (strains && strains[spring_slot] != strain)
            mspringi_limit_store(network, spring_slot, property, strain);
    }
}
