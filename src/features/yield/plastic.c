/// What springs yield at, and the bounds that follow from it.
#include "features/yield/plastic.h"

#include <math.h>

#include "features/breaking/strain.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/id_pool.h"
#include "store/properties.h"
#include "store/record_sharing.h"
#include "store/rest_lengths.h"
#include "store/spring_limits.h"
#include "store/springs.h"
#include "store/store.h"

/* ----------------------------------------------------------------------------------------------------- memory */

static const mspringi_array_entry none[] = {{0, 0, MSPRINGI_GROUP}};
const mspringi_feature_state mspringi_state_of_plastic = {MSPRINGI_ARRAY_TABLE(none), NULL};

static mspring_result no_memory(mspring_network *network) {
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the yield strains of %u springs",
                         (unsigned)network->topology.spring_count);
}

// Springs do not yield, nor do those that are not there.
static mspring_result reserve_layout(mspring_network *network) {
    mspringi_tested *p = &network->tested;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_TESTED))
        return no_memory(network);
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
    return MSPRING_OK;
}

static mspring_result match_layout(mspring_network *to, const mspring_network *from) {
    return from->tested.nominal && !to->tested.nominal ? reserve_layout(to) : MSPRING_OK;
}

// A step must not allocate, so rest lengths are apart from now on. Breaking looks at the total strain, for which it
// needs a place for what follows from both.
mspring_result mspringi_plastic_reserve(mspring_network *network) {
    if (network->tested.nominal)
        return MSPRING_OK;
    if (!network->plastic)
        network->plastic = mspringi_alloc(&network->memory, 1, sizeof *network->plastic);
    mspring_result result = network->plastic ? mspringi_rest_lengths_unshare(network) : no_memory(network);
    if (result == MSPRING_OK)
        result = mspringi_incidence_reserve(network);
    if (result == MSPRING_OK && network->strain.break_strain)
        result = mspringi_strain_reserve_stress(network);
    if (result == MSPRING_OK)
        result = reserve_layout(network);
    if (result != MSPRING_OK)
        return result;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
        network->tested.nominal[spring_slot] = mspringi_spring_slot_own_length(network, spring_slot);
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACES, 0);
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- bounds */

mspringi_yield_values mspringi_yield_values_of(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_tested *p = &network->tested;
    return (mspringi_yield_values){.nominal = p->nominal[spring_slot],
                                   .yield_strain = p->yield_strain[spring_slot],
                                   .hardening = p->hardening[spring_slot],
                                   .plastic_limit = p->plastic_limit[spring_slot],
                                   .gain = p->gain[spring_slot]};
}

// One on a ramp does not flow: that sets its rest length.
static void renew(mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_tested *p = &network->tested;
    if (!p->nominal)
        return;
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
}

/* ----------------------------------------------------------------------------------------------------- values */

// A spring of rest length 0 has no strain that could stay.
static float bent(float nominal, float strain) {
    return nominal == MSPRINGI_WELD ? nominal : (float)((double)nominal * (1.0 + (double)strain));
}

static void store(mspring_network *network, mspringi_spring_slot spring_slot, mspring_property property,
                  float value) {
    mspringi_tested *p = &network->tested;
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
    mspringi_limits_renew(network, spring_slot);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
}

static void forget(mspring_network *network, mspring_id spring) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    mspringi_tested *p = &network->tested;
    if (!p->nominal)
        return;
    p->nominal[spring_slot] = mspringi_spring_slot_own_length(network, spring_slot);
    p->yield_strain[spring_slot] = INFINITY;
    p->hardening[spring_slot] = MSPRING_HARDENING_DEFAULT;
    p->plastic_limit[spring_slot] = MSPRING_PLASTIC_LIMIT_DEFAULT;
    mspringi_limits_renew(network, spring_slot);
}

/* ------------------------------------------------------------------------------------------------ definitions */

static void put(mspring_network *network, mspring_id spring, mspringi_limits limits) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    mspringi_tested *p = &network->tested;
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
    mspringi_limits_renew(network, spring_slot);
    mspringi_fingerprint_floats(network, mspringi_read_value(limits.yield_strain), limits.hardening);
    mspringi_fingerprint_floats(network, limits.plastic_limit, p->nominal[spring_slot]);
}

static mspring_result reserve_property(mspring_network *network, mspring_property property) {
    (void)property;
    return mspringi_plastic_reserve(network);
}

const mspringi_limit_ops mspringi_limits_of_yielding = {
    .first = MSPRING_YIELD_STRAIN,
    .last = MSPRING_PLASTIC_STRAIN,
    .reserve = reserve_property,
    .match_layout = match_layout,
    .store = store,
    .put = put,
    .forget = forget,
    .renew = renew,
};

/* ---------------------------------------------------------------------------------------------------- reports */

bool mspringi_plastic_is_finite(const mspring_network *network) {
    bool finite = !network->plastic || isfinite(network->plastic->dissipated);
    for (mspring_id s = 0; network->tested.nominal && finite && s < network->topology.spring_count; ++s)
        finite = !mspringi_spring_exists(network, s) ||
                 isfinite(network->tested.nominal[mspringi_slot_of_spring(&network->topology, s)]);
    return finite;
}

void mspringi_plastic_report(const mspring_network *network, mspring_energy *energy) {
    if (!network->plastic)
        return;
    energy->yield_count = network->plastic->count;
    energy->dissipated = network->plastic->dissipated;
}
