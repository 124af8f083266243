/// The attempt that follows another one, and what all of them may spend.
#include "step/ladder.h"

#include <float.h>
#include <math.h>

#include "features/hooks/hooks.h"
#include "stability/guard.h"
#include "stability/stability.h"
#include "step/pace.h"
#include "store/feature.h"
#include "store/group_ops.h"

/* ------------------------------------------------------------------------------------------------- one attempt */

// Set the solver and the substeps of an attempt. Refuse substeps that are no normal floats.
static bool prepare(mspring_network *network, mspringi_attempt *attempt, mspringi_attempt_kind kind,
                    const mspringi_solver *solver, uint32_t substeps) {
    const double calm = (double)substeps * mspringi_solver_calm_work(solver);
    attempt->kind = kind;
    attempt->solver = solver;
    attempt->substeps = substeps;
    attempt->dt = network->step_time;
    attempt->h = (float)(network->step_time / (double)substeps);
    attempt->relative_h = network->relative_h;
    attempt->missed_count = 0;
    attempt->is_spent = false;
    attempt->most_work = network->most_work > 0 ? (double)network->most_work * calm : INFINITY;
    attempt->result =
        attempt->h >= FLT_MIN && attempt->h <= FLT_MAX
            ? MSPRING_OK
            : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                            "dt is %g s (substeps: %u): each substep must be a finite number of at least 1.2e-38 s",
                            attempt->dt, (unsigned)substeps);
    return attempt->result == MSPRING_OK;
}

// Set the substeps of the host's solver for this step, if they are left to the library. *calm: those of calm
// motion; max_substeps if more would be needed, which is an error.
static mspring_result choose_substeps(mspring_network *network, double dt, bool may_raise, uint32_t *calm) {
    network->step_time = dt;
    network->next_pace = network->steps.pace;
    if (network->substep_length > 0.0)
        mspringi_pace_keep_length(network, dt);
    *calm = network->substeps;
    if (network->substep_length > 0.0 || !mspringi_can_choose_substeps(network))
        return MSPRING_OK;
    const mspring_result result = mspringi_pace_choose(network, dt, may_raise, calm);
    *calm = result == MSPRING_OK ? *calm : network->max_substeps;
    return result;
}

/* -------------------------------------------------------------------------------------------------- a fallback */

// The solver for steps that the chosen one cannot take, or NULL.
static const mspringi_solver *fallback_of(const mspring_network *network) {
    if (network->settings.guard == MSPRING_GUARD_CLAMP || network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS)
        return &mspringi_clamped;
    return network->settings.guard == MSPRING_GUARD_IMPLICIT && network->solver.ops->has_stability_limit
               ? &network->fallback
               : NULL;
}

// Prepare an attempt with the fallback, which has no history. It takes the substeps of calm motion. If even these
// are more than max_substeps, it takes as many as cost that work, so that no frame is late.
static bool fall_back(mspring_network *network, mspringi_attempt *attempt, const mspringi_solver *fallback) {
    uint32_t calm, substeps;
    const bool is_chosen = choose_substeps(network, attempt->given_dt, false, &calm) == MSPRING_OK;
    substeps = is_chosen ? calm : (uint32_t)((double)calm / mspringi_solver_calm_work(fallback));
    if (!(attempt->calm_work > 0.0)) // it is the first attempt
        attempt->calm_work = (double)calm * mspringi_solver_calm_work(&network->solver);
    substeps = fallback->ops->takes_one_substep || substeps == 0 ? 1 : substeps;
    mspringi_solver_forget(fallback);
    return prepare(network, attempt, MSPRINGI_BY_FALLBACK, fallback, substeps);
}

// Begin a new motion for the chosen solver, and have the guard check the limit before its next step.
static void accept_fallback(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_guard *guard = &network->guard;
    const bool takes_one = attempt->solver->ops->takes_one_substep,
               is_single = !network->solver.ops->has_stability_limit ||
                           network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS;
    mspringi_solver_forget(&network->solver);
    if (!takes_one)
        network->substeps = attempt->substeps;
    if (attempt->is_idle)
        return;
    guard->h = 0.0f;
    guard->fallback_steps = guard->fallback_steps > 0 ? guard->fallback_steps - 1
                            : is_single               ? 0
                                                      : MSPRINGI_FALLBACK_STEPS;
    network->outcome.flags |= takes_one ? MSPRING_STEP_FALLBACK : MSPRING_STEP_CLAMPED;
}

/* ----------------------------------------------------------------------------------------------- more substeps */

// Work of a calm step for MSPRING_GUARD_RETRY: with the substeps set or, if they are more, with those that are
// stable in any shape.
static double asked_work(mspring_network *network, const mspringi_attempt *attempt) {
    mspring_id spring;
    if (!attempt->solver->ops->has_stability_limit)
        return attempt->calm_work;
    const double limit = mspringi_stable_in_any_shape(network, &spring);
    const uint32_t asked = mspringi_substeps_within(attempt->dt, limit, network->max_substeps);
    return fmax(attempt->calm_work, (double)(asked < network->max_substeps ? asked : network->max_substeps));
}

// Prepare an attempt with twice the substeps. If no work is left for them, the step fails, and if their number was
// set, the next one begins with these substeps.
static bool take_more(mspring_network *network, mspringi_attempt *attempt) {
    const uint32_t most = network->max_substeps, twice = 2 * network->substeps, more = twice < most ? twice : most;
    if (network->settings.guard != MSPRING_GUARD_RETRY || network->substeps >= most)
        return false;
    const double left = (double)network->most_work * asked_work(network, attempt) - attempt->work;
    network->substeps = more;
    if (network->most_work > 0 && (double)more * mspringi_solver_calm_work(&network->solver) > left) {
        attempt->keeps_substeps = !mspringi_can_choose_substeps(network) && network->substep_length == 0.0;
        attempt->result = mspringi_fail(
            &network->message, MSPRING_ERROR_UNSTABLE,
            "unstable: %u substeps are too few, and %u more than most_work, %u, allows in one step. %sUse a larger "
            "most_work, more substeps, a shorter dt or lower stiffness.",
            (unsigned)attempt->substeps, (unsigned)more, (unsigned)network->most_work,
            attempt->keeps_substeps ? "The next step begins with these. " : "");
        return false;
    }
    network->outcome.flags |= MSPRING_STEP_RETRIED;
    const bool is_prepared = prepare(network, attempt, MSPRINGI_WITH_MORE_SUBSTEPS, &network->solver, more);
    attempt->most_work = fmin(attempt->most_work, network->most_work > 0 ? left : INFINITY);
    return is_prepared;
}

/* ------------------------------------------------------------------------------------------------------ groups */

// Hold all groups that failed. Then release, one by one, those that may have failed because of others. Each attempt
// holds or clears at least one group, and no group is held twice, so these attempts need no other bound.
static bool try_groups(mspring_network *network, mspringi_attempt *attempt) {
    const bool is_taken = attempt->result == MSPRING_OK, is_trial = attempt->kind == MSPRINGI_WITH_DOUBTFUL;
    if (!is_taken && !is_trial)
        return attempt->result == MSPRING_ERROR_UNSTABLE && mspringi_held_groups->hold_suspects(network) &&
               prepare(network, attempt, MSPRINGI_WITHOUT_SUSPECTS, attempt->solver, attempt->substeps);
    if (!is_taken)
        mspringi_held_groups->hold(network, attempt->group);
    attempt->group = mspringi_held_groups->next_doubtful(network, attempt->group + is_trial);
    const bool is_last = attempt->group == network->groups.count;
    if (is_taken && is_last)
        return false;
    if (is_taken)
        mspringi_attempt_take_back(network, attempt);
    if (!is_last)
        mspringi_held_groups->release(network, attempt->group);
    return prepare(network, attempt, is_last ? MSPRINGI_WITHOUT_SUSPECTS : MSPRINGI_WITH_DOUBTFUL, attempt->solver,
                   attempt->substeps);
}

/* -------------------------------------------------------------------------------------------------------- room */

// Give features the room that the attempt lacked, and prepare it again. Its work does not count, and it may spend
// as much as before: nothing depends on the room that there was.
static bool grow(mspring_network *network, mspringi_attempt *attempt) {
    const double most_work = attempt->most_work;
    mspring_result result = MSPRING_ERROR_LIMIT;
#define GROWS(function) result = result == MSPRING_ERROR_LIMIT ? function(network) : result;
#include "store/features.def"
    attempt->result = result;
    if (result != MSPRING_OK)
        return false;
    network->outcome.flags |= MSPRING_STEP_GREW;
    attempt->work = attempt->work_before;
    const bool is_prepared = prepare(network, attempt, attempt->kind, attempt->solver, attempt->substeps);
    attempt->most_work = most_work;
    return is_prepared;
}

/* ------------------------------------------------------------------------------------------------ all attempts */

void mspringi_attempt_first(mspring_network *network, double dt, const mspringi_stages *stages,
                            mspringi_attempt *first) {
    const mspringi_solver *fallback = fallback_of(network);
    uint32_t calm;
    first->stages = stages;
    first->solver = &network->solver;
    first->group = 0;
    first->has_missed = first->is_idle = first->keeps_substeps = false;
    first->given_dt = dt;
    first->work = first->calm_work = 0.0;
    if (fallback && network->guard.fallback_steps > 0) {
        (void)fall_back(network, first, fallback);
        return;
    }
    first->result = choose_substeps(network, dt, true, &calm);
    first->calm_work = (double)calm * mspringi_solver_calm_work(&network->solver);
    if (first->result == MSPRING_OK)
        (void)prepare(network, first, MSPRINGI_AS_CHOSEN, &network->solver, network->substeps);
    else
        first->kind = MSPRINGI_AS_CHOSEN;
}

bool mspringi_attempt_next(mspring_network *network, mspringi_attempt *attempt) {
    if (attempt->has_missed) {
        attempt->missed_count++;
        return true;
    }
    if (mspringi_hooks_end_step(network))
        return false;
    if (attempt->result == MSPRING_ERROR_LIMIT && grow(network, attempt))
        return true;
    if (attempt->result == MSPRING_ERROR_MEMORY)
        return false;
    if (network->groups.count > 0 && network->settings.guard != MSPRING_GUARD_CLAMP_BOUNDS)
        return !attempt->is_idle && try_groups(network, attempt);
    if (attempt->result != MSPRING_ERROR_UNSTABLE || attempt->kind == MSPRINGI_BY_FALLBACK)
        return false;
    const mspringi_solver *fallback = fallback_of(network);
    return fallback ? fall_back(network, attempt, fallback) : take_more(network, attempt);
}

void mspringi_attempt_accept(mspring_network *network, const mspringi_attempt *attempt) {
    network->steps.lag = attempt->solver->ops->lags ? network->full_lag : network->steps.lag;
    if (attempt->kind == MSPRINGI_BY_FALLBACK)
        accept_fallback(network, attempt);
    if (attempt->is_spent)
        network->outcome.flags |= MSPRING_STEP_FEWER;
    if (network->groups.count > 0) {
        const uint32_t grew = network->outcome.flags & MSPRING_STEP_GREW;
        network->outcome = mspringi_outcome_none();
        network->outcome.flags = grew;
    }
}
