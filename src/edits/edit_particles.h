/// @file edit_particles.h
/// Masses, and scales of inverse masses.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_PARTICLES_H
#define MSPRINGI_EDIT_PARTICLES_H

#include "store/properties.h"

/// Make the array of scales, if it is not there.
mspring_result mspringi_reserve_inverse_mass_scales(mspring_network *network);

#endif
