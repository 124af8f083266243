/// @file edit_particles.h
/// Masses, and what scales their inverses.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_PARTICLES_H
#define MSPRINGI_EDIT_PARTICLES_H

#include "store/properties.h"

/// Have relative springs go on with the masses that are there before the first edit; nothing if there are none.
mspring_result mspringi_reserve_spring_masses(mspring_network *network);
mspring_result mspringi_reserve_inverse_mass_scales(mspring_network *network);

#endif
