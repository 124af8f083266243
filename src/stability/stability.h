/// @file stability.h
/// How long an explicit substep may be.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STABILITY_H
#define MSPRINGI_STABILITY_H

#include "store/network.h"

/// Nominal stiffness (N/m) and damping (N s/m) of a spring; of a relative one, stiffness times h^2 and damping
/// times h (both in kg).
typedef struct mspringi_strength {
    double stiffness, damping;
    double relative_stiffness, relative_damping;
} mspringi_strength;
/// Those that only pull or only push count with so much of their stiffness. Where they begin to act, motion is not
/// linear, and gains energy in substeps of a third, a quarter or a fifth of a period (chains at 0.9 of the limit
/// of a linear motion were strained 75 times as much as in short substeps). At half of that limit a period has
/// six.
#define MSPRINGI_ONE_WAY_SHARE 4.0
mspringi_strength mspringi_strength_of(const mspring_network *network, mspring_id spring,
                                       mspringi_spring_slot spring_slot);

/// What areas add to the sums of springs' stiffness and damping by slot (stability_areas.c), in the shape that they
/// were added in, and the largest quotient of these sums that one of them takes part in.
void mspringi_areas_sum(const mspring_network *network, float *sums, float *dampings);
double mspringi_areas_largest(const mspring_network *network, const float *sums);

/// The longest substep that is stable in whatever shape the network gets into, and the spring that sets it
/// (MSPRING_NONE: none does). Broken springs count as whole, as they may be restored. Kept
/// until springs or masses are edited. Works where the guard looks; without such room in the backup of the state,
/// so between steps only.
double mspringi_stable_in_any_shape(mspring_network *network, mspring_id *spring);

/// A substep for MSPRING_SUBSTEPS_AUTO where relative springs leave the others no room in the bound above: as if
/// they took at most half of it. Other substeps would be no more stable, as relative springs follow them: whether
/// this one is stable in the present shape, the guard sees. Infinite if all springs are relative.
double mspringi_stable_with_relative(mspring_network *network);

/// The spring to name where substeps of h are too long: of those that share an end with the one that sets the
/// longest substep, which says only where, the one that is stiffest or most damped for its masses. MSPRING_NONE if
/// nothing sets it. Looks at all springs, in the same room.
mspring_id mspringi_tightest_spring(mspring_network *network, double h);

/// The smallest number of substeps of dt for which each is at most limit. Above most: most + 1.
uint32_t mspringi_substeps_within(double dt, double limit, uint32_t most);

#endif
