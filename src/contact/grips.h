/// @file grips.h
/// Particles that the host holds.
///
///   grips.c      the definition, given by the host; the law
///   grip_stage.c    the stage; what a grip does after a substep of symplectic Euler
///
/// The solvers with a linear system have grips in it, see solvers/implicit/implicit_grips.c. All have the force of
/// the end of the substep, so it is stable however stiff the grip is.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GRIPS_H
#define MSPRINGI_GRIPS_H

#include "store/network.h"

/// What a grip pulls at: a place that moves, local coordinates.
typedef struct mspringi_grip_target {
    double x, y, vx, vy;
} mspringi_grip_target;

/// Where the target is once so much of the step has passed.
mspringi_grip_target mspringi_grip_target_at(const mspring_network *network, const mspringi_grip *grip,
                                             double share);

/// Bound a force by what the grip can. Returns whether it was more.
bool mspringi_grip_bound(const mspringi_grip *grip, double *force_x, double *force_y);

/// Whether a grip holds a particle that can be moved now. If so, *slot is where it is.
bool mspringi_grip_is_active(const mspring_network *network, const mspringi_grip *grip, uint32_t *slot);

/// Make room for all grips that there may be, unless it is there.
mspring_result mspringi_grips_reserve(mspring_network *network);
/// There is no grip, and none has been.
void mspringi_grips_clear(mspringi_grips *grips);
/// Remove the grips of a particle that is removed.
void mspringi_grips_forget(mspring_network *network, mspring_id particle);
/// The next step begins where the targets are.
void mspringi_grips_finish_step(mspring_network *network);

#endif
