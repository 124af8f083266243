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

#include "store/network.h"

/// Flow of the springs, besides what lies by place (store/tested_springs.h).
typedef struct mspringi_plastic {
    uint32_t hit_count;    ///< of tested.hits
    bool was_warm;         ///< some strip was in the last step; says only what is worth trying
    bool irregular_yields; ///< some spring of the irregular part may yield in this step
    bool flows;            ///< some bit of has_flowed is set, other than by rows that test
    uint64_t count;        ///< springs that flowed in a step, summed over the steps
    double dissipated;     ///< J
} mspringi_plastic;

/// Allocate what yielding needs, if it is not there yet; nominal is there when all of it is.
mspring_result mspringi_plastic_reserve(mspring_network *network);

/// What a spring yields at.
mspringi_yield_values mspringi_yield_values_of(const mspring_network *network, mspringi_spring_slot spring_slot);

/// False if a number of what has flowed is none.
bool mspringi_plastic_is_finite(const mspring_network *network);

#endif
