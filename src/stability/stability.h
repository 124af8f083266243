/// @file stability.h
/// Longest stable substeps of the explicit solver.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STABILITY_H
#define MSPRINGI_STABILITY_H

#include "store/network.h"

/// Nominal stiffness (N/m) and damping (N s/m) of a spring; for a relative one, stiffness times h^2 and damping
/// times h (both in kg).
typedef struct mspringi_strength {
    double stiffness, damping;
    double relative_stiffness, relative_damping;
} mspringi_strength;
/// Masses of the ends of the relative spring before, and their reduced mass: most springs have the same. Begins as
/// zeros.
typedef struct mspringi_last_masses {
    double a, b, reduced;
} mspringi_last_masses;
/// Factor on the stiffness of one-way springs. Where they begin to act, motion is not linear and gains energy in
/// substeps of a third, a quarter or a fifth of a period. At half the limit a period has six substeps. Chains at
/// 0.9 of the limit of linear motion were strained 75 times as much as in short substeps.
#define MSPRINGI_ONE_WAY_SHARE 4.0
mspringi_strength mspringi_strength_of(const mspring_network *network, mspring_id spring,
                                       mspringi_spring_slot spring_slot, uint32_t base, uint32_t tip,
                                       mspringi_last_masses *last);

/// Longest substep that is stable in any shape, and the spring that sets it (MSPRING_NONE: none). Broken springs
/// count as whole, as they may be restored. Cached until springs or masses are edited. Works in the guard's scratch
/// arrays, or else in the backup of the state, so call it between steps only.
double mspringi_stable_in_any_shape(mspring_network *network, mspring_id *spring);

/// Substep for MSPRING_SUBSTEPS_AUTO where relative springs use up the bound above: as if they took at most half of
/// it. Another substep would be no more stable, as relative springs scale with it. The guard checks it in the
/// present shape. Infinite if all springs are relative.
double mspringi_stable_with_relative(mspring_network *network);

/// Largest rate at which the ends of a spring move against each other, in its rest length, 1/s. What
/// mspringi_violence_bound() gives is no less; it takes no pass over springs.
double mspringi_violence(const mspring_network *network);
double mspringi_violence_bound(const mspring_network *network);

/// Spring to name if substeps of h are too long, MSPRING_NONE if none. The spring that sets the longest substep
/// says only where; of it and its neighbours this is the stiffest or most damped for its masses. Visits all
/// springs, in the same memory.
mspring_id mspringi_tightest_spring(mspring_network *network, double h);

/// Smallest number of substeps of dt with each at most limit; most + 1 if above most.
uint32_t mspringi_substeps_within(double dt, double limit, uint32_t most);

#endif
