/// @file steps.h
/// Values that a network keeps from step to step: outcome, pace, and the guard's.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STEPS_H
#define MSPRINGI_STEPS_H

#include <stdbool.h>

#include <massspring/massspring.h>

/// Outcome of a step besides its result: see mspring_step_info.
typedef struct mspringi_outcome {
    mspring_id particle, spring; ///< to blame
    uint32_t flags;
    double work; ///< of all attempts, in calm steps
} mspringi_outcome;

/// Pace of MSPRING_SUBSTEPS_EVEN.
typedef struct mspringi_pace {
    double dt;      ///< from which the length of substeps was chosen, s; 0: none was
    double h;       ///< the length, s
    double left;    ///< time that steps were asked for and have not taken yet, s; < 0: they are ahead
    uint32_t steps; ///< consecutive steps in which another length would fit better
} mspringi_pace;

/// Values of auto_substeps.
enum { MSPRINGI_SUBSTEPS_GIVEN, MSPRINGI_SUBSTEPS_AUTO, MSPRINGI_SUBSTEPS_EVEN };

/// The last step, and how many there have been.
typedef struct mspringi_steps {
    mspring_result result;
    mspringi_outcome outcome;
    uint32_t substeps; ///< of the last that succeeded
    uint64_t count, fallback_count;
    double time; ///< s
    double dt;   ///< of the last that succeeded, s; 0: none did
    /// Coming steps that MSPRING_SUBSTEPS_AUTO treats as uneven, because dt changed.
    uint32_t uneven_steps;
    /// Lag: length of the last explicit substep, s. Velocities are half of it older than positions; 0: they are
    /// not. Other solvers leave it, and the age of velocities with it.
    float lag;
    mspringi_pace pace;
} mspringi_steps;

/// Steps that count as uneven after a change of dt.
#define MSPRINGI_UNEVEN_STEPS 600u

static inline mspringi_outcome mspringi_outcome_none(void) {
    return (mspringi_outcome){.particle = MSPRING_NONE, .spring = MSPRING_NONE};
}

/// Steps that the fallback takes after one that the explicit solver could not take. Trying that solver in each
/// would take longer than these steps.
#define MSPRINGI_FALLBACK_STEPS 15u

/// Values of the guard.
typedef struct mspringi_guard {
    float h, global_damping; ///< for which the limit was checked last; h is 0 at first
    bool watches;            ///< this step's substeps are longer than what is stable in any shape
    uint32_t fallback_steps; ///< steps that the fallback still takes before the explicit solver is tried again
    float peak;              ///< largest change of velocity at the last check of the limit, decaying, m/s
    bool knows_speed;        ///< speed is that of the state before this step
    bool
        knows_coordinate; ///< coordinate is, and the way in this step of one substep follows from speeds at its end
    float speed;          ///< bound on all at the end of the last step, m/s; infinite if unknown
    float coordinate;     ///< likewise for coordinates, m
    uint64_t state;       ///< edits.state then
} mspringi_guard;

/// Cached result of mspringi_stable_in_any_shape(), and the counters of edits that it holds for.
typedef struct mspringi_any_shape {
    double dt;       ///< longest stable substep, s
    double mixed_dt; ///< of mspringi_stable_with_relative(), s; 0: not known yet
    mspring_id spring;
    bool is_known;
    uint64_t masses, values, growth;
} mspringi_any_shape;

#endif
