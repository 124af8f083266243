/// Edits of particles between steps: masses, and scales of inverse masses.
#include "edits/edit_particles.h"

#include <string.h>

#include "base/cpu.h"
#include "edits/edit_values.h"
#include "features/contact/contacts.h"
#include "store/changed.h"
#include "store/id_pool.h"
#include "store/springs.h"

/* ------------------------------------------------------------------------------------------------------ masses */

// Index of the first changed mass.
static uint32_t first_changed_mass(const mspring_network *network, const mspringi_selection *at,
                                   const mspringi_values *values) {
    uint32_t i = 0;
    while (i < at->count && (network->mass[mspringi_selected(at, i)] == mspringi_value_of(values, i) ||
                             !mspringi_particle_exists(network, mspringi_selected(at, i))))
        ++i;
    return i;
}

static MSPRINGI_NOINLINE void store_masses(mspring_network *network, const mspringi_selection *at,
                                           const mspringi_values *values, uint32_t i) {
    for (; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        const float mass = mspringi_value_of(values, i);
        if (!mspringi_particle_exists(network, particle))
            continue;
        float *inverse_mass = &network->inverse_mass[network->topology.slot_of_particle[particle]];
        network->mass[particle] = mass;
        if (network->inverse_mass_scale)
            *inverse_mass = network->inverse_mass_scale[particle] / mass;
        else if (*inverse_mass > 0.0f)
            *inverse_mass = 1.0f / mass;
    }
}

/// Particles whose inverse masses are computed together, vectorised.
enum { BATCH = 64 };

// Set the masses of a batch without removed particles.
static inline void store_batch(const mspring_network *network, mspring_id first, const float *given, size_t stride,
                               uint32_t count) {
    const uint32_t *const slots = network->topology.slot_of_particle + first;
    float *const masses = network->mass + first, *const inverse_mass = network->inverse_mass;
    float inverses[BATCH];
    for (uint32_t i = 0; i < count; ++i, given += stride)
        masses[i] = mspringi_broken_value(*given);
    if (network->inverse_mass_scale) {
        const float *const scales = network->inverse_mass_scale + first;
        for (uint32_t i = 0; i < count; ++i)
            inverses[i] = scales[i] / masses[i];
        for (uint32_t i = 0; i < count; ++i)
            inverse_mass[slots[i]] = inverses[i];
    } else {
        for (uint32_t i = 0; i < count; ++i)
            inverses[i] = 1.0f / masses[i];
        for (uint32_t i = 0; i < count; ++i)
            inverse_mass[slots[i]] = inverse_mass[slots[i]] > 0.0f ? inverses[i] : 0.0f;
    }
}

static MSPRINGI_NOINLINE void store_range(const mspring_network *network, const mspringi_selection *at,
                                          const mspringi_values *values, uint32_t i) {
    const uint32_t *const slots = network->topology.slot_of_particle + at->first;
    for (uint32_t end; i < at->count; i = end) {
        end = at->count - i < BATCH ? at->count : i + BATCH;
        const uint32_t fetched = at->count - end < BATCH ? at->count : end + BATCH;
        for (uint32_t next = end; next < fetched; ++next)
            MSPRINGI_PREFETCH(&network->inverse_mass[slots[next]]);
        store_batch(network, at->first + i, values->first + i * values->stride, values->stride, end - i);
    }
}

// Each change takes a walk around its particle, or all of them together one pass over all springs.
static bool are_few(const mspring_network *network, const mspringi_selection *at, uint32_t first) {
    enum { SPRINGS_OF_PARTICLE = 8 }; // in a lattice
    return at->count - first < network->topology.spring_count / SPRINGS_OF_PARTICLE;
}

// Have relative springs follow new masses. A list may name a hub many times: walks end where they would take longer
// than the pass.
static void renew_springs(mspring_network *network, const mspringi_selection *at, uint32_t first) {
    const uint32_t all = network->topology.spring_count;
    uint32_t next = are_few(network, at, first) ? first : at->count, visited = 0;
    const bool by_walks = next < at->count;
    while (next < at->count && visited < all)
        visited += mspringi_renew_relative_around(network, mspringi_selected(at, next++));
    if (!by_walks || next < at->count)
        mspringi_renew_relative(network);
    mspringi_notify_change(network, MSPRINGI_CHANGED_SPRING_MASSES, 0);
}

static mspring_result set_masses(mspring_network *network, const mspringi_selection *at,
                                 const mspringi_values *values) {
    const uint32_t first = first_changed_mass(network, at, values);
    if (first == at->count)
        return MSPRING_OK;
    if (network->fractions.values && are_few(network, at, first)) {
        const mspring_result result = mspringi_incidence_reserve(network);
        if (result != MSPRING_OK)
            return result;
    }
    if (at->list || network->growth.particles)
        store_masses(network, at, values, first);
    else
        store_range(network, at, values, first);
    if (network->fractions.values)
        renew_springs(network, at, first);
    mspringi_notify_change(network, MSPRINGI_CHANGED_MASSES, 0);
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------ scales */

mspring_result mspringi_reserve_inverse_mass_scales(mspring_network *network) {
    if (network->inverse_mass_scale)
        return MSPRING_OK;
    const uint32_t count = network->topology.reserve.particle_end;
    float *scales = mspringi_alloc(&network->memory, count, sizeof *scales);
    if (!scales)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for scales of inverse mass of %u particles", (unsigned)count);
    for (mspring_id p = 0; p < count; ++p)
        scales[p] = mspringi_particle_property(network, MSPRING_INVERSE_MASS_SCALE, p);
    network->inverse_mass_scale = scales;
    return MSPRING_OK;
}

static bool is_fractional(float scale) {
    return scale > 0.0f && scale < 1.0f;
}

// Index of the first changed scale, and whether any needs memory for scales.
static uint32_t first_changed_scale(const mspring_network *network, const mspringi_selection *at,
                                    const mspringi_values *values, bool *fractional) {
    uint32_t first = at->count;
    *fractional = false;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        const float scale = mspringi_value_of(values, i);
        if (!mspringi_particle_exists(network, particle) ||
            mspringi_particle_property(network, MSPRING_INVERSE_MASS_SCALE, particle) == scale)
            continue;
        first = first < i ? first : i;
        *fractional = *fractional || is_fractional(scale);
    }
    return first;
}

static MSPRINGI_NOINLINE void store_scales(mspring_network *network, const mspringi_selection *at,
                                           const mspringi_values *values, uint32_t i) {
    for (; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        const float scale = mspringi_value_of(values, i) + 0.0f; // -0 becomes 0, the scale of a pinned particle
        if (!mspringi_particle_exists(network, particle))
            continue;
        if (network->inverse_mass_scale)
            network->inverse_mass_scale[particle] = scale;
        network->inverse_mass[network->topology.slot_of_particle[particle]] = scale / network->mass[particle];
        network->is_scaled = network->is_scaled || is_fractional(scale);
    }
}

static mspring_result set_scales(mspring_network *network, const mspringi_selection *at,
                                 const mspringi_values *values) {
    bool fractional;
    const uint32_t first = first_changed_scale(network, at, values, &fractional);
    mspring_result result = fractional ? mspringi_reserve_inverse_mass_scales(network) : MSPRING_OK;
    if (result != MSPRING_OK || first == at->count)
        return result;
    store_scales(network, at, values, first);
    mspringi_notify_change(network, MSPRINGI_CHANGED_MASSES, 0);
    return MSPRING_OK;
}

mspring_result mspringi_set_particle_values(mspring_network *network, const mspringi_selection *at,
                                            const mspringi_values *values) {
    return values->property == MSPRING_MASS                 ? set_masses(network, at, values)
           : values->property == MSPRING_INVERSE_MASS_SCALE ? set_scales(network, at, values)
                                                            : mspringi_contact_set_material(network, at, values);
}
