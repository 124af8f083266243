/// @file grips.h
/// Grips: springs and dampers from a particle to a moving target of the host.
///
///   grips.c      the definition, given by the host; the law
///   grip_stage.c    the stage; what a grip does after a leapfrog substep
///
/// The solvers with a linear system have grips in it, see solvers/implicit/implicit_grips.c. All have the force of
/// the end of the substep, so it is stable however stiff the grip is.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GRIPS_H
#define MSPRINGI_GRIPS_H

#include "store/network.h"

/// A particle that the host holds.
typedef struct mspringi_grip {
    mspring_id id;       ///< of the grip
    mspring_id particle; ///< that it holds
    float stiffness, damping, max_force;
    double x, y;                 ///< where the target is at the end of the next step, world coordinates
    double from_x, from_y;       ///< and at its start
    double impulse_x, impulse_y; ///< that it gave in the last step, N s
    double sum_x, sum_y;         ///< the same of the step that is being made
    double force_x, force_y;     ///< in an implicit substep, N
    double share;                ///< of stiffness and damping that acts in it
    bool is_bounded;             ///< none does, but the force that is the largest
} mspringi_grip;

typedef struct mspringi_grips {
    mspringi_grip list[MSPRING_MAX_GRIPS]; ///< [count] in the order of ids
    uint32_t count;
    mspring_id next_id;

    // A step.
    bool could_act; ///< they could act in it
    float h;
    double begin, share; ///< of the step that has passed before its substep, and that the substep is
    double passed;       ///< of the substep, where an implicit one is taken in pieces
} mspringi_grips;

/// Target of a grip, local coordinates.
typedef struct mspringi_grip_target {
    double x, y, vx, vy;
} mspringi_grip_target;

static inline uint32_t mspringi_grip_count(const mspring_network *network) {
    return network->grips ? network->grips->count : 0;
}

/// Find the target after a share of the step.
mspringi_grip_target mspringi_grip_target_at(const mspring_network *network, const mspringi_grip *grip,
                                             double share);

/// Clamp a force to the limit of the grip. Return true if it was larger.
bool mspringi_grip_bound(const mspringi_grip *grip, double *force_x, double *force_y);

/// True if the grip holds a movable particle. Then *slot is its slot.
bool mspringi_grip_is_active(const mspring_network *network, const mspringi_grip *grip, uint32_t *slot);

/// Reserve all grips once.
mspring_result mspringi_grips_reserve(mspring_network *network);
/// Reset to a network that never had a grip.
void mspringi_grips_clear(mspring_network *network);
/// Remove the grips of a particle that is removed.
void mspringi_grips_forget(mspring_network *network, mspring_id particle);
/// Move the grips to their targets at the end of a step.
void mspringi_grips_finish_step(mspring_network *network);

#endif
