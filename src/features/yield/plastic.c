/// What springs yield at, and the bounds that follow from it.
#include "features/yield/plastic.h"

#include <math.h>

#include "features/breaking/breaking.h"
#include "features/breaking/strain.h"
#include "store/changed.h"
#include "store/id_pool.h"
#include "store/properties.h"
#include "store/record_sharing.h"
#include "store/rest_lengths.h"
#include "store/springs.h"
#include "store/store.h"

/* ----------------------------------------------------------------------------------------------------- memory */

// Springs do not yield, nor do those that are not there.
static bool reserve_layout(mspring_network *network) {
    mspringi_plastic *p = &network->plastic;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_PLASTIC)) {
        (void)mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                            "no memory for the yield strains of %u springs",
                            (unsigned)network->topology.spring_count);
        return false;
    }
    const size_t spring_slots = mspringi_spring_slot_words(&network->topology) * MSPRINGI_WIDTH;
    for (size_t spring_slot = 0; spring_slot < spring_slots; ++spring_slot) {
        p->yield_strain[spring_slot] = p->high[spring_slot] = p->flow_high[spring_slot] = INFINITY;
        p->low[spring_slot] = p->flow_low[spring_slot] = -1.0f;
        p->hardening[spring_slot] = MSPRING_HARDENING_DEFAULT;
        p->plastic_limit[spring_slot] = MSPRING_PLASTIC_LIMIT_DEFAULT;
        p->nominal[spring_slot] = p->gain[spring_slot] = 1.0f;
    }
    mspringi_shared_records_clear(&p->shared_records, network->topology.lattice_blocks);
    p->shared_records.changes = network->topology.lattice_springs;
    return true;
}

mspring_result mspringi_plastic_match_layout(mspring_network *to, const mspring_network *from) {
    const bool is_there = !from->plastic.nominal || to->plastic.nominal;
    return is_there || reserve_layout(to) ? MSPRING_OK : MSPRING_ERROR_MEMORY;
}

// A step must not allocate, so rest lengths are apart from now on. Breaking looks at the total strain, for which it
// needs a place for what follows from both.
mspring_result mspringi_plastic_reserve(mspring_network *network) {
    if (network->plastic.nominal)
        return MSPRING_OK;
    mspring_result result = mspringi_rest_lengths_unshare(network);
    if (result == MSPRING_OK)
        result = mspringi_incidence_reserve(network);
    if (result == MSPRING_OK && network->strain.break_strain)
        result = mspringi_strain_reserve_stress(network);
    if (result == MSPRING_OK && !reserve_layout(network))
        result = MSPRING_ERROR_MEMORY;
    if (result != MSPRING_OK)
        return result;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
        network->plastic.nominal[spring_slot] = mspringi_spring_slot_own_length(network, spring_slot);
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACES, 0);
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- bounds */

mspringi_yield_values mspringi_yield_values_of(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_plastic *p = &network->plastic;
    return (mspringi_yield_values){.nominal = p->nominal[spring_slot],
                                   .yield_strain = p->yield_strain[spring_slot],
                                   .hardening = p->hardening[spring_slot],
                                   .plastic_limit = p->plastic_limit[spring_slot],
                                   .gain = p->gain[spring_slot]};
}

// One on a ramp does not flow: that sets its rest length.
void mspringi_plastic_renew(mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_plastic *p = &network->plastic;
    const float rest = mspringi_spring_slot_own_length(network, spring_slot);
    p->gain[spring_slot] = 1.0f / (1.0f + p->hardening[spring_slot]);
    mspringi_yield_values values = mspringi_yield_values_of(network, spring_slot);
    if (rest == MSPRINGI_WELD || mspringi_spring_slot_ramp(network, spring_slot))
        values.yield_strain = INFINITY;
    const mspringi_yield_bounds bounds = mspringi_yield_bounds_of(values, rest);
    mspringi_shared_records_unshare_yielding(network, spring_slot);
    p->low[spring_slot] = bounds.low;
    p->high[spring_slot] = bounds.high;
    p->flow_low[spring_slot] = bounds.flow_low;
    p->flow_high[spring_slot] = bounds.flow_high;
    if (network->strain.break_strain)
        mspringi_strain_renew_least(network, spring_slot);
}

/* ----------------------------------------------------------------------------------------------------- values */

// A spring of rest length 0 has no strain that could stay.
static float bent(float nominal, float strain) {
    return nominal == MSPRINGI_WELD ? nominal : (float)((double)nominal * (1.0 + (double)strain));
}

void mspringi_plastic_store(mspring_network *network, mspringi_spring_slot spring_slot, mspring_property property,
                            float value) {
    mspringi_plastic *p = &network->plastic;
    MSPRINGI_ASSERT(p->nominal);
    if (property == MSPRING_YIELD_STRAIN)
        p->yield_strain[spring_slot] = value;
    else if (property == MSPRING_HARDENING)
        p->hardening[spring_slot] = value;
    else if (property == MSPRING_PLASTIC_LIMIT)
        p->plastic_limit[spring_slot] = value;
    else
        mspringi_spring_slot_set_rest_length(network, spring_slot, bent(p->nominal[spring_slot], value));
    p->yields = true;
    p->is_bent |= property == MSPRING_PLASTIC_STRAIN && value != 0.0f;
    mspringi_plastic_renew(network, spring_slot);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
}

void mspringi_spring_slot_give_length(mspring_network *network, mspringi_spring_slot spring_slot, float length) {
    if (!network->plastic.nominal) {
        mspringi_spring_slot_set_rest_length(network, spring_slot, length);
        return;
    }
    const float own = mspringi_spring_slot_own_length(network, spring_slot),
                had = network->plastic.nominal[spring_slot];
    const bool is_straight = own == had || had == MSPRINGI_WELD || length == MSPRINGI_WELD;
    network->plastic.nominal[spring_slot] = length;
    mspringi_spring_slot_set_rest_length(
        network, spring_slot, is_straight ? length : (float)((double)length * ((double)own / (double)had)));
    mspringi_plastic_renew(network, spring_slot);
}

void mspringi_plastic_forget(mspring_network *network, mspring_id spring) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    mspringi_plastic *p = &network->plastic;
    if (!p->nominal)
        return;
    p->nominal[spring_slot] = mspringi_spring_slot_own_length(network, spring_slot);
    p->yield_strain[spring_slot] = INFINITY;
    p->hardening[spring_slot] = MSPRING_HARDENING_DEFAULT;
    p->plastic_limit[spring_slot] = MSPRING_PLASTIC_LIMIT_DEFAULT;
    mspringi_plastic_renew(network, spring_slot);
}

/* ------------------------------------------------------------------------------------------------ definitions */

mspring_result mspringi_plastic_reserve_limits(mspring_network *network, mspringi_limits limits) {
    return mspringi_has_plasticity(limits) ? mspringi_plastic_reserve(network) : MSPRING_OK;
}

void mspringi_plastic_put_limits(mspring_network *network, mspring_id spring, mspringi_limits limits) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    mspringi_plastic *p = &network->plastic;
    if (!mspringi_has_plasticity(limits))
        return;
    p->yield_strain[spring_slot] = mspringi_broken_value(limits.yield_strain);
    p->hardening[spring_slot] = limits.hardening;
    p->plastic_limit[spring_slot] = limits.plastic_limit;
    p->yields = true;
    if (limits.nominal_length > 0.0f) {
        p->is_bent |= p->nominal[spring_slot] != limits.nominal_length;
        p->nominal[spring_slot] = limits.nominal_length;
    }
    mspringi_plastic_renew(network, spring_slot);
    mspringi_fingerprint_floats(network, mspringi_read_value(limits.yield_strain), limits.hardening);
    mspringi_fingerprint_floats(network, limits.plastic_limit, p->nominal[spring_slot]);
}
