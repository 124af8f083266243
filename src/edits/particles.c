/// Editing particles between steps: masses, and what scales their inverses.
#include "edits/particles.h"

#include <string.h>

#include "base/cpu.h"
#include "store/changed.h"
#include "store/selection.h"
#include "store/springs.h"

static float scale_of(const mspring_network *network, mspring_id particle) {
    if (network->inverse_mass_scale)
        return network->inverse_mass_scale[particle];
    return network->inverse_mass[network->topology.slot_of_particle[particle]] > 0.0f ? 1.0f : 0.0f;
}

/* ------------------------------------------------------------------------------------------------------ masses */

static mspring_result check_masses(mspring_network *network, const mspringi_selection *at, const float *mass) {
    bool all = true;
    for (uint32_t i = 0; i < at->count; ++i)
        all = all & mspringi_is_mass(mass[i]);
    if (all)
        return MSPRING_OK;
    uint32_t i = 0;
    while (i < at->count &&
           (mspringi_is_mass(mass[i]) || !mspringi_particle_exists(network, mspringi_selected(at, i))))
        ++i;
    if (i == at->count)
        return MSPRING_OK;
    return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                         "particle %u: mass is %g kg, it must be 1e-30 to 1e30", (unsigned)mspringi_selected(at, i),
                         (double)mass[i]);
}

mspring_result mspringi_reserve_spring_masses(mspring_network *network) {
    if (!network->fractions.values || network->spring_mass)
        return MSPRING_OK;
    const size_t count = network->topology.reserve.particle_end;
    network->spring_mass = mspringi_alloc(&network->memory, count, sizeof *network->spring_mass);
    if (!network->spring_mass)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for second masses of %zu particles", count);
    memcpy(network->spring_mass, network->mass, count * sizeof *network->mass);
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE void store_masses(mspring_network *network, const mspringi_selection *at,
                                           const float *mass) {
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        if (!mspringi_particle_exists(network, particle))
            continue;
        float *inverse_mass = &network->inverse_mass[network->topology.slot_of_particle[particle]];
        network->mass[particle] = mass[i];
        if (network->inverse_mass_scale)
            *inverse_mass = network->inverse_mass_scale[particle] / mass[i];
        else if (*inverse_mass > 0.0f)
            *inverse_mass = 1.0f / mass[i];
    }
}

static mspring_result set_masses(mspring_network *network, const mspringi_selection *at, const float *mass) {
    mspring_result result = check_masses(network, at, mass);
    if (result == MSPRING_OK)
        result = mspringi_reserve_spring_masses(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    store_masses(network, at, mass);
    mspringi_fp_leave(before);
    network->is_reweighed = network->spring_mass != NULL;
    mspringi_changed(network, MSPRINGI_CHANGED_MASSES, 0);
    return MSPRING_OK;
}

mspring_result mspring_network_set_masses(mspring_network *network, mspring_id first, uint32_t count,
                                          const float *mass) {
    mspringi_selection at;
    mspring_result result = mspringi_select_range(network, MSPRINGI_PARTICLES, first, count, mass, mass, &at);
    return result == MSPRING_OK ? set_masses(network, &at, mass) : result;
}

mspring_result mspring_network_set_masses_at(mspring_network *network, const mspring_id *particles, uint32_t count,
                                             const float *mass) {
    mspringi_selection at;
    mspring_result result = mspringi_select_list(network, MSPRINGI_PARTICLES, particles, count, mass, mass, &at);
    return result == MSPRING_OK ? set_masses(network, &at, mass) : result;
}

mspring_result mspring_network_renew_relative_springs(mspring_network *network) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK || !network->spring_mass)
        return result;
    memcpy(network->spring_mass, network->mass, network->topology.reserve.particle_end * sizeof *network->mass);
    const mspringi_fp_state before = mspringi_fp_enter();
    mspringi_renew_relative(network);
    mspringi_fp_leave(before);
    mspringi_changed(network, MSPRINGI_CHANGED_SPRING_MASSES, 0);
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------ scales */

static mspring_result check_scales(mspring_network *network, const mspringi_selection *at, const float *scale,
                                   bool *fractional) {
    *fractional = false;
    for (uint32_t i = 0; i < at->count; ++i) {
        if (!mspringi_is_inverse_mass_scale(scale[i]))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "particle %u: scale of inverse mass is %g, it must be 0 or 1e-6 to 1",
                                 (unsigned)mspringi_selected(at, i), (double)scale[i]);
        *fractional = *fractional || (scale[i] > 0.0f && scale[i] < 1.0f);
    }
    return MSPRING_OK;
}

mspring_result mspringi_reserve_inverse_mass_scales(mspring_network *network) {
    if (network->inverse_mass_scale)
        return MSPRING_OK;
    const uint32_t count = network->topology.reserve.particle_end;
    float *scales = mspringi_alloc(&network->memory, count, sizeof *scales);
    if (!scales)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for scales of inverse mass of %u particles", (unsigned)count);
    for (mspring_id p = 0; p < count; ++p)
        scales[p] = scale_of(network, p);
    network->inverse_mass_scale = scales;
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE void store_scales(mspring_network *network, const mspringi_selection *at,
                                           const float *scale) {
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        if (!mspringi_particle_exists(network, particle))
            continue;
        if (network->inverse_mass_scale)
            network->inverse_mass_scale[particle] = scale[i];
        network->inverse_mass[network->topology.slot_of_particle[particle]] = scale[i] / network->mass[particle];
        network->is_scaled = network->is_scaled || (scale[i] > 0.0f && scale[i] < 1.0f);
    }
}

static mspring_result set_scales(mspring_network *network, const mspringi_selection *at, const float *scale) {
    bool fractional;
    mspring_result result = check_scales(network, at, scale, &fractional);
    if (result == MSPRING_OK && fractional)
        result = mspringi_reserve_inverse_mass_scales(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    store_scales(network, at, scale);
    mspringi_fp_leave(before);
    mspringi_changed(network, MSPRINGI_CHANGED_MASSES, 0);
    return MSPRING_OK;
}

mspring_result mspring_network_set_inverse_mass_scales(mspring_network *network, mspring_id first, uint32_t count,
                                                       const float *scale) {
    mspringi_selection at;
    mspring_result result = mspringi_select_range(network, MSPRINGI_PARTICLES, first, count, scale, scale, &at);
    return result == MSPRING_OK ? set_scales(network, &at, scale) : result;
}

mspring_result mspring_network_set_inverse_mass_scales_at(mspring_network *network, const mspring_id *particles,
                                                          uint32_t count, const float *scale) {
    mspringi_selection at;
    mspring_result result = mspringi_select_list(network, MSPRINGI_PARTICLES, particles, count, scale, scale, &at);
    return result == MSPRING_OK ? set_scales(network, &at, scale) : result;
}

mspring_result mspring_network_get_inverse_mass_scales(const mspring_network *network, mspring_id first,
                                                       uint32_t count, float *scale) {
    if (!network || (count > 0 && !scale))
        return MSPRING_ERROR_ARGUMENT;
    const uint32_t total = network->topology.particle_count;
    if (first > total || count > total - first)
        return MSPRING_ERROR_ID;
    for (uint32_t i = 0; i < count; ++i)
        scale[i] = scale_of(network, first + i);
    return MSPRING_OK;
}
