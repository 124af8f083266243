/// @file kinetic.h
/// Kinetic energy.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_KINETIC_H
#define MSPRINGI_KINETIC_H

#include "store/network.h"

/// Sum of m v^2 / 2 over particles that are not pinned, J, with velocities of now. Where more acts than springs,
/// gravity and global damping, with those of the state.
double mspringi_kinetic_energy(const mspring_network *network);

#endif
