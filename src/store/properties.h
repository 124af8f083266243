/// @file properties.h
/// What particles and springs have one float of each, by mspring_property.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PROPERTIES_H
#define MSPRINGI_PROPERTIES_H

#include <math.h>

#include "builder/builder.h"
#include "store/selection.h"

#define MSPRINGI_SMALLEST_MASS 1e-30f
#define MSPRINGI_LARGEST_MASS 1e30f
#define MSPRINGI_SMALLEST_SCALE 1e-6f

/// Whether these are values that a particle may have. (Inline and without branches, for loops over all of them.)
static inline bool mspringi_is_mass(float mass) {
    return (mass >= MSPRINGI_SMALLEST_MASS) & (mass <= MSPRINGI_LARGEST_MASS);
}
static inline bool mspringi_is_inverse_mass_scale(float scale) {
    return (scale == 0.0f) | ((scale >= MSPRINGI_SMALLEST_SCALE) & (scale <= 1.0f));
}

/// True if a record may hold this stiffness, damping or rest length in force. Flow may stretch a rest length to 1.9
/// times the longest that a host may set.
static inline bool mspringi_is_spring_value(mspringi_part part, float value) {
    return part == MSPRINGI_REST_LENGTH ? (value > 0.0f) & (value <= 8e12f) : (value >= 0.0f) & (value <= 1e30f);
}

/// A threshold as networks keep it, and as the host reads it. Times a rest length, INFINITY alone is above all
/// stretches. No other property may have such values, so these two may be used for all.
static inline float mspringi_broken_value(float given) {
    return given >= MSPRING_NEVER ? INFINITY : given;
}
static inline float mspringi_read_value(float kept) {
    return kept > MSPRING_NEVER ? MSPRING_NEVER : kept;
}

typedef struct mspringi_property {
    const char *name, *unit, *range; ///< for messages; the unit with a space before it, if there is one
    mspringi_kind kind;
    bool is_writable;
} mspringi_property;

/// NULL: there is no such property.
const mspringi_property *mspringi_property_of(mspring_property property);

/// Whether a property may have so many values, stride floats apart. stride 0: it is one value.
bool mspringi_are_allowed(mspring_property property, const float *values, uint32_t count, size_t stride);

/// What a particle or spring that exists has of a property that can be written.
float mspringi_particle_property(const mspring_network *network, mspring_property property, mspring_id particle);
float mspringi_spring_property(const mspring_network *network, mspring_property property, mspring_id spring);

#endif
