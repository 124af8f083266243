/// What springs yield at, and the bounds that follow from it.
#include "step/plastic.h"

#include <math.h>

#include "step/breaking.h"
#include "step/strain.h"
#include "store/alike.h"
#include "store/changed.h"
#include "store/growth.h"
#include "store/properties.h"
#include "store/rests.h"
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
    const size_t places = mspringi_place_words(&network->topology) * MSPRINGI_WIDTH;
    for (size_t place = 0; place < places; ++place) {
        p->yield_strain[place] = p->high[place] = p->flow_high[place] = INFINITY;
        p->low[place] = p->flow_low[place] = -1.0f;
        p->hardening[place] = MSPRING_HARDENING_DEFAULT;
        p->plastic_limit[place] = MSPRING_PLASTIC_LIMIT_DEFAULT;
        p->nominal[place] = p->gain[place] = 1.0f;
    }
    mspringi_alike_begin(&p->alike, network->topology.lattice_blocks);
    p->alike.changes = network->topology.lattice_springs;
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
    mspring_result result = mspringi_rests_separate(network);
    if (result == MSPRING_OK)
        result = mspringi_incidence_reserve(network);
    if (result == MSPRING_OK && network->strain.break_strain)
        result = mspringi_strain_reserve_stress(network);
    if (result == MSPRING_OK && !reserve_layout(network))
        result = MSPRING_ERROR_MEMORY;
    if (result != MSPRING_OK)
        return result;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring) {
        const mspringi_place place = mspringi_place_of(&network->topology, spring);
        network->plastic.nominal[place] = mspringi_place_own_length(network, place);
    }
    mspringi_changed(network, MSPRINGI_CHANGED_PLACES, 0);
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- bounds */

mspringi_yield_values mspringi_yield_values_of(const mspring_network *network, mspringi_place place) {
    const mspringi_plastic *p = &network->plastic;
    return (mspringi_yield_values){.nominal = p->nominal[place],
                                   .yield_strain = p->yield_strain[place],
                                   .hardening = p->hardening[place],
                                   .plastic_limit = p->plastic_limit[place],
                                   .gain = p->gain[place]};
}

// One on a ramp does not flow: that sets its rest length.
void mspringi_plastic_renew(mspring_network *network, mspringi_place place) {
    const mspringi_plastic *p = &network->plastic;
    const float rest = mspringi_place_own_length(network, place);
    p->gain[place] = 1.0f / (1.0f + p->hardening[place]);
    mspringi_yield_values values = mspringi_yield_values_of(network, place);
    if (rest == MSPRINGI_WELD || mspringi_place_ramp(network, place))
        values.yield_strain = INFINITY;
    const mspringi_yield_bounds bounds = mspringi_yield_bounds_of(values, rest);
    mspringi_alike_part_yielding(network, place);
    p->low[place] = bounds.low;
    p->high[place] = bounds.high;
    p->flow_low[place] = bounds.flow_low;
    p->flow_high[place] = bounds.flow_high;
    if (network->strain.break_strain)
        mspringi_strain_renew_least(network, place);
}

/* ----------------------------------------------------------------------------------------------------- values */

// A spring of rest length 0 has no strain that could stay.
static float bent(float nominal, float strain) {
    return nominal == MSPRINGI_WELD ? nominal : (float)((double)nominal * (1.0 + (double)strain));
}

void mspringi_plastic_store(mspring_network *network, mspringi_place place, mspring_property property,
                            float value) {
    mspringi_plastic *p = &network->plastic;
    MSPRINGI_ASSERT(p->nominal);
    if (property == MSPRING_YIELD_STRAIN)
        p->yield_strain[place] = value;
    else if (property == MSPRING_HARDENING)
        p->hardening[place] = value;
    else if (property == MSPRING_PLASTIC_LIMIT)
        p->plastic_limit[place] = value;
    else
        mspringi_place_set_rest_length(network, place, bent(p->nominal[place], value));
    p->yields = true;
    p->is_bent |= property == MSPRING_PLASTIC_STRAIN && value != 0.0f;
    mspringi_plastic_renew(network, place);
    mspringi_changed(network, MSPRINGI_CHANGED_PLACE, place);
}

void mspringi_plastic_follow(mspring_network *network, mspringi_place place, float had) {
    float *nominal = &network->plastic.nominal[place];
    const float rest = mspringi_place_get(network, place).rest_length;
    const bool is_whole = *nominal == had || rest == MSPRINGI_WELD || had == MSPRINGI_WELD;
    *nominal = is_whole ? rest : (float)((double)rest * ((double)*nominal / (double)had));
    mspringi_plastic_renew(network, place);
}

void mspringi_plastic_forget(mspring_network *network, mspring_id spring) {
    const mspringi_place place = mspringi_place_of(&network->topology, spring);
    mspringi_plastic *p = &network->plastic;
    if (!p->nominal)
        return;
    p->nominal[place] = mspringi_place_own_length(network, place);
    p->yield_strain[place] = INFINITY;
    p->hardening[place] = MSPRING_HARDENING_DEFAULT;
    p->plastic_limit[place] = MSPRING_PLASTIC_LIMIT_DEFAULT;
    mspringi_plastic_renew(network, place);
}

/* ------------------------------------------------------------------------------------------------ definitions */

mspring_result mspringi_plastic_reserve_limits(mspring_network *network, mspringi_limits limits) {
    return mspringi_has_plasticity(limits) ? mspringi_plastic_reserve(network) : MSPRING_OK;
}

void mspringi_plastic_put_limits(mspring_network *network, mspring_id spring, mspringi_limits limits) {
    const mspringi_place place = mspringi_place_of(&network->topology, spring);
    mspringi_plastic *p = &network->plastic;
    if (!mspringi_has_plasticity(limits))
        return;
    p->yield_strain[place] = mspringi_kept_value(limits.yield_strain);
    p->hardening[place] = limits.hardening;
    p->plastic_limit[place] = limits.plastic_limit;
    p->yields = true;
    if (limits.nominal_length > 0.0f) {
        p->is_bent |= p->nominal[place] != limits.nominal_length;
        p->nominal[place] = limits.nominal_length;
    }
    mspringi_plastic_renew(network, place);
    mspringi_fingerprint_floats(network, mspringi_read_value(limits.yield_strain), limits.hardening);
    mspringi_fingerprint_floats(network, limits.plastic_limit, p->nominal[place]);
}
