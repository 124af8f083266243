/// @file grips.h
/// Grips: springs and dampers from a particle to a moving target of the host.
///
///   grips.c          definition, set by the host; target and bound of the force
///   grip_stage.c     stage; action of grips after an explicit substep
///   implicit_grips.c grips in the linear system of an implicit substep
///   snapshot_grips.c snapshot
///
/// Solvers with a linear system have grips in it, but for those of isolated
/// particles: grip_stage.c applies these, too. All use the force at the end of the substep, so a grip is stable
/// however stiff it is.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GRIPS_H
#define MSPRINGI_GRIPS_H

#include "store/network.h"

/// Grip on a particle.
typedef struct mspringi_grip {
    mspring_id id;
    mspring_id particle; ///< held particle
    float stiffness, damping, max_force;
    double x, y;                 ///< target at the end of the next step, world coordinates, m
    double from_x, from_y;       ///< target at its start, m
    double impulse_x, impulse_y; ///< in the last step, N s
    double sum_x, sum_y;         ///< impulse in the present step so far, N s

    // An implicit substep.
    double force_x, force_y; ///< as predicted, then as solved, N
    double share;    ///< share of stiffness and damping that acts, so that the predicted force is in its bound
    bool is_bounded; ///< solved with the largest force instead of stiffness and damping
} mspringi_grip;

typedef struct mspringi_grips {
    mspringi_grip list[MSPRING_MAX_GRIPS]; ///< [count] in the order of ids
    uint32_t count;
    mspring_id next_id;

    // A step.
    bool could_act; ///< a grip was active in one of its substeps
    float h;        ///< length of a substep, s
    double begin;   ///< share of the step before the present substep
    double share;   ///< share of the step in a substep
    double passed;  ///< share of an implicit substep before the present interval
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
/// Accept a step: impulses are final, and targets are reached.
void mspringi_grips_finish_step(mspring_network *network);

#endif
