/// @file strain.h
/// The strain pass: once after each step, every spring against its thresholds.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDITS_STRAIN_H
#define MSPRINGI_EDITS_STRAIN_H

#include "store/network.h"

/// Allocate what thresholds and the pass need, if it is not there yet; break_strain is there when all of it is.
mspring_result mspringi_strain_reserve(mspring_network *network);
/// The part of it that lies by place.
mspring_result mspringi_strain_reserve_layout(mspring_network *network);
mspring_result mspringi_strain_reserve_stress(mspring_network *network);

/// Set what a spring breaks or is stressed at; after these.
void mspringi_strain_store(mspring_network *network, mspringi_place place, bool stress, float value);

/// Let nothing happen to a spring by its strain.
void mspringi_strain_forget(mspring_network *network, mspring_id spring);

#endif
