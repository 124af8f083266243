/// @file plastic.h
/// Springs that yield: what they yield at, and what they keep of it.
///
/// Return mapping with linear kinematic (Prager) hardening. With r the rest length in force, r0 the nominal one:
///
///     e = (L - r) / r0,  p = r / r0 - 1,  t = e - H p,  over = |t| - y
///     over > 0:  dp = over / (1 + H);  r += sign(t) r0 dp, with p in -P to P
///     energy      k (L - r)^2 / 2 + k H (r - r0)^2 / 2
///     dissipated  k r0^2 (|t| + |t'|) dp / 2, with t' of the length at which particles last felt the spring
///
/// So the rest length in force is all of the state. What lies by place here follows from it, or is a parameter.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PLASTIC_H
#define MSPRINGI_PLASTIC_H

#include "builder/builder.h"
#include "store/network.h"

/// Allocate what yielding needs, if it is not there yet; nominal is there when all of it is.
mspring_result mspringi_plastic_reserve(mspring_network *network);
/// The part of it that lies by place, in another network.
mspring_result mspringi_plastic_match_layout(mspring_network *to, const mspring_network *from);

/// Set MSPRING_YIELD_STRAIN, MSPRING_HARDENING, MSPRING_PLASTIC_LIMIT or MSPRING_PLASTIC_STRAIN of a spring, of the
/// last after its ramp has been ended; after mspringi_plastic_reserve().
void mspringi_plastic_store(mspring_network *network, mspringi_spring_slot spring_slot, mspring_property property,
                            float value);

/// Set the rest length that the host gives. In force is that times 1 + the plastic strain, which stays.
void mspringi_spring_slot_give_length(mspring_network *network, mspringi_spring_slot spring_slot, float length);

/// What a spring yields at.
mspringi_yield_values mspringi_yield_values_of(const mspring_network *network, mspringi_spring_slot spring_slot);

/// Compute the bounds between which a spring is cold, and the strain that anything happens at.
void mspringi_plastic_renew(mspring_network *network, mspringi_spring_slot spring_slot);

/// Give a spring of which nothing is known what its definition has; let another not yield.
mspring_result mspringi_plastic_reserve_limits(mspring_network *network, mspringi_limits limits);
void mspringi_plastic_put_limits(mspring_network *network, mspring_id spring, mspringi_limits limits);
void mspringi_plastic_forget(mspring_network *network, mspring_id spring);

#endif
