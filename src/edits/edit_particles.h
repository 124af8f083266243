/// @file edit_particles.h
/// Masses, and scales of inverse masses.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_PARTICLES_H
#define MSPRINGI_EDIT_PARTICLES_H

#include "store/properties.h"

/// Save the masses for relative springs before the first edit of masses. No effect without relative springs.
mspring_result mspringi_reserve_spring_masses(mspring_network *network);
mspring_result mspringi_reserve_inverse_mass_scales(mspring_network *network);

#endif
