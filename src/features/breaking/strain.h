/// @file strain.h
/// The strain pass: once after each step, every spring against its thresholds.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDITS_STRAIN_H
#define MSPRINGI_EDITS_STRAIN_H

#include "store/network.h"

/// Allocate stress strains, if they are not there yet, and the least strain that anything happens at.
mspring_result mspringi_strain_reserve_stress(mspring_network *network);

/// Find the least strain that anything happens at, after what it follows from has changed.
void mspringi_strain_renew_least(mspring_network *network, mspringi_spring_slot spring_slot);

#endif
