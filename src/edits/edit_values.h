/// @file edit_values.h
/// Edits of properties that are one float for each particle or spring. Called by mspring_network_set().
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_VALUES_H
#define MSPRINGI_EDIT_VALUES_H

#include "store/properties.h"

/// Valid values of a property: one for each element of a selection, or with stride 0 one for all.
typedef struct mspringi_values {
    mspring_property property;
    const float *first;
    size_t stride; ///< stride in floats
} mspringi_values;

static inline float mspringi_value_of(const mspringi_values *values, uint32_t i) {
    const float value = values->first[i * values->stride];
    return values->property == MSPRING_REST_LENGTH ? mspringi_stored_length(value) : mspringi_broken_value(value);
}

/// Set the values of particles (edit_particles.c) or springs (edit_springs.c). Unchanged ones are skipped.
mspring_result mspringi_set_particle_values(mspring_network *network, const mspringi_selection *at,
                                            const mspringi_values *values);
mspring_result mspringi_set_spring_values(mspring_network *network, const mspringi_selection *at,
                                          const mspringi_values *values);

#endif
