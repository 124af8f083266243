/// @file properties.h
/// Properties (mspring_property): a number for each thing of a kind.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PROPERTIES_H
#define MSPRINGI_PROPERTIES_H

#include <math.h>

#include "builder/builder.h"
#include "store/things.h"

#define MSPRINGI_SMALLEST_MASS 1e-30f
#define MSPRINGI_LARGEST_MASS 1e30f
#define MSPRINGI_SMALLEST_SCALE 1e-6f
/// Longest rest length in force, m.
#define MSPRINGI_MAX_OWN_LENGTH 8e12f

/// True if a particle may have this mass or scale. (Inline and without branches, for loops over all.)
static inline bool mspringi_is_mass(float mass) {
    return (mass >= MSPRINGI_SMALLEST_MASS) & (mass <= MSPRINGI_LARGEST_MASS);
}
static inline bool mspringi_is_inverse_mass_scale(float scale) {
    return (scale == 0.0f) | ((scale >= MSPRINGI_SMALLEST_SCALE) & (scale <= 1.0f));
}

/// True if a record may hold this stiffness, damping or rest length in force. Flow may stretch a rest length to 1.9
/// times the longest that a host may set.
static inline bool mspringi_is_spring_value(mspringi_part part, float value) {
    return part == MSPRINGI_REST_LENGTH ? (value > 0.0f) & (value <= MSPRINGI_MAX_OWN_LENGTH)
                                        : (value >= 0.0f) & (value <= 1e30f);
}

/// Value as networks store it, and as the host reads it. They store INFINITY for thresholds from MSPRING_NEVER on,
/// as times a rest length only that exceeds all stretches. Other properties have no such values.
static inline float mspringi_broken_value(float given) {
    return given >= MSPRING_NEVER ? INFINITY : given;
}
static inline float mspringi_read_value(float kept) {
    return kept > MSPRING_NEVER ? MSPRING_NEVER : kept;
}

typedef struct mspringi_property {
    mspring_property number;
    const char *name, *unit, *range; ///< for messages; the unit with a space before it, if there is one
    bool is_writable;
    float least, most, also; ///< a float that is writable lies between the first two or is the third
} mspringi_property;

/// NULL: there is no such property.
const mspringi_property *mspringi_property_of(mspring_property property);

static inline mspring_kind mspringi_kind_of(mspring_property property) {
    return (mspring_kind)((int32_t)property >> 8);
}
static inline bool mspringi_is_of_integers(mspring_property property) {
    return property & 0x80;
}

/// True if a property may have all of these values, stride floats apart. stride 0: one value for all.
bool mspringi_are_allowed(mspring_property property, const float *values, uint32_t count, size_t stride);

/// Value of a writable property of an existing particle or spring.
float mspringi_particle_property(const mspring_network *network, mspring_property property, mspring_id particle);
float mspringi_spring_property(const mspring_network *network, mspring_property property, mspring_id spring);

#endif
