/// @file steps.h
/// What a network knows from step to step: their outcome, their pace, and what the guard has seen.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STEPS_H
#define MSPRINGI_STEPS_H

#include <stdbool.h>

#include <massspring/massspring.h>

/// What came of a step beside its result: see mspring_step_info.
typedef struct mspringi_outcome {
    mspring_id particle, spring; ///< to blame
    uint32_t flags;
    double work; ///< of all attempts, in calm steps
} mspringi_outcome;

/// Pace of MSPRING_SUBSTEPS_EVEN.
typedef struct mspringi_pace {
    double dt;      ///< from which the length of substeps was chosen, s; 0: none was
    double h;       ///< the length, s
    double left;    ///< that steps were asked for and have not taken yet, s; < 0: they are ahead
    uint32_t steps; ///< in a row that ask for another length
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
    /// Steps that MSPRING_SUBSTEPS_AUTO still takes for uneven, after a change of dt.
    uint32_t uneven_steps;
    /// The last explicit substep, s: velocities are half of it older than positions; 0: they are not. Other solvers
    /// leave it: what they begin with, and end with, is as old.
    float lag;
    mspringi_pace pace;
} mspringi_steps;

/// Steps after a change of dt for which steps count as uneven.
#define MSPRINGI_UNEVEN_STEPS 600u

static inline mspringi_outcome mspringi_outcome_none(void) {
    return (mspringi_outcome){.particle = MSPRING_NONE, .spring = MSPRING_NONE};
}

/// Steps that follow one which the explicit solver could not take, and which it is not asked to: to find that it
/// still cannot takes longer than they do.
#define MSPRINGI_FALLBACK_STEPS 15u

/// What the guard knows from step to step.
typedef struct mspringi_guard {
    float h, global_damping; ///< the border was looked at for these; h is 0 at first
    bool watches;            ///< this step's substeps are longer than what is stable in any shape
    uint32_t fallback_steps; ///< steps that the fallback still takes before the explicit solver is tried again
    float peak;              ///< largest change when the border was looked at last, fading, m/s
    bool knows_speed;        ///< speed is that of the state before this step
    bool knows_coordinate;   ///< place is, and how far it gets in this step follows from speeds at its end
    float speed;             ///< none was larger at the end of the last step, m/s; infinite if that is not known
    float coordinate;        ///< so with coordinates, m
    uint64_t state;          ///< edits.state then
} mspringi_guard;

/// What mspringi_stable_in_any_shape() has found, and the edits that it has seen.
typedef struct mspringi_any_shape {
    double dt;
    double mixed_dt; ///< see mspringi_stable_with_relative(); 0: not known yet
    mspring_id spring;
    bool is_known;
    uint64_t masses, values, growth;
} mspringi_any_shape;

#endif
