/// @file strain.h
/// The strain pass: once after each step, every spring against its thresholds.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDITS_STRAIN_H
#define MSPRINGI_EDITS_STRAIN_H

#include "builder/builder.h"
#include "store/network.h"

/// Allocate what thresholds and the pass need, if it is not there yet; break_strain is there when all of it is.
mspring_result mspringi_strain_reserve(mspring_network *network);
/// The part of it that lies by place.
mspring_result mspringi_strain_reserve_layout(mspring_network *network);
mspring_result mspringi_strain_reserve_stress(mspring_network *network);
mspring_result mspringi_strain_reserve_relax(mspring_network *network);
/// What these thresholds need: MSPRING_BREAK_STRAIN, MSPRING_STRESS_STRAIN or MSPRING_RELAX_STRAIN.
mspring_result mspringi_strain_reserve_for(mspring_network *network, mspring_property property);
/// What lies by place in another network.
mspring_result mspringi_strain_match_layout(mspring_network *to, const mspring_network *from);

/// Set one of these of a spring; after that.
void mspringi_strain_store(mspring_network *network, mspringi_spring_slot spring_slot, mspring_property property,
                           float value);

/// Allocate what it takes to give a spring the strains at which something happens to it, as its definition has
/// them; give them to one of which nothing is known yet.
mspring_result mspringi_strain_reserve_limits(mspring_network *network, mspringi_limits limits);
void mspringi_strain_put_limits(mspring_network *network, mspring_id spring, mspringi_limits limits);

/// Find the least strain that anything happens at, after what it follows from has changed.
void mspringi_strain_renew_least(mspring_network *network, mspringi_spring_slot spring_slot);

/// Let nothing happen to a spring by its strain.
void mspringi_strain_forget(mspring_network *network, mspring_id spring);

#endif
