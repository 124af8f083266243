/// @file particles.h
/// Masses, and what scales their inverses.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PARTICLES_H
#define MSPRINGI_PARTICLES_H

#include "store/network.h"

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

/// Have relative springs go on with the masses that are there before the first edit; nothing if there are none.
mspring_result mspringi_reserve_spring_masses(mspring_network *network);
mspring_result mspringi_reserve_inverse_mass_scales(mspring_network *network);

#endif
