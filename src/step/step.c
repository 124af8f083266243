/// One step: substeps with the forces that act in them, and the way back if it goes wrong.
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "features/hooks/hooks.h"
#include "features/sleep/sleep.h"
#include "stability/guard.h"
#include "stability/stability.h"
#include "step/finite.h"
#include "step/held_groups.h"
#include "step/pace.h"
#include "store/id_pool.h"
#include "store/network.h"
#include "store/stages.h"

typedef struct copying {
    const float *from;
    float *to;
    size_t slot_count, arrays;
} copying;

static void copy_range(void *argument, size_t first, size_t end) {
    const copying *all = argument;
    for (size_t i = 0; i < all->arrays; ++i)
        memcpy(all->to + i * all->slot_count + first, all->from + i * all->slot_count + first,
               (end - first) * sizeof *all->to);
}

static void copy_state(const mspring_network *network, const mspringi_state *from, const mspringi_state *to) {
    copying all = {from->x, to->x, mspringi_slot_count(network), mspringi_state_arrays(network)};
    mspringi_tasks_run_ranges(network->tasks, mspringi_used_slots(network), MSPRINGI_WIDTH, copy_range, &all);
}

/* -------------------------------------------------------------------------------------------------- substeps */

// Take a substep, or count of them. A single one may have to be taken in pieces.
static void run_solver(mspring_network *network, const mspringi_attempt *attempt, mspringi_field force,
                       uint32_t count) {
    const mspringi_solver *solver = attempt->solver;
    for (uint32_t left = MSPRINGI_SUBSTEP_PARTS, shares; left > 0; left -= shares) {
        shares = count > 1 ? left : mspringi_stages_max_parts(network, attempt, left);
        const float h = attempt->h * ((float)shares / (float)MSPRINGI_SUBSTEP_PARTS);
        network->added_substeps += shares < left;
        solver->ops->substeps(network, solver->object, h, force, count);
        network->lag = network->full_lag = h;
    }
}

static void run_substeps(mspring_network *network, const mspringi_attempt *attempt, mspringi_field base,
                         bool is_cut) {
    const mspringi_stages *stages = attempt->stages;
    for (uint32_t substep = 0, count; substep < attempt->substeps; substep += count) {
        count = mspringi_stages_free_substeps(network, attempt, substep);
        network->first_substep = substep;
        mspringi_field outside;
        const mspringi_field force = mspringi_stages_before_substep(network, attempt, substep, base, &outside);
        if (substep == 0 && is_cut)
            mspringi_stages_forces_known(network, attempt, outside);
        if (stages->follow_substeps)
            mspringi_sleep_hold(network);
        if (!mspringi_sleep_is_whole(network))
            run_solver(network, attempt, force, count);
        if (stages->follow_substeps)
            mspringi_sleep_put_back(network);
        mspringi_stages_after_substep(network, attempt, substep + count - 1);
    }
}

void mspringi_drop_stale_lows(const mspring_network *network) {
    const size_t slots = mspringi_used_slots(network);
    const float *restrict x = network->state.x, *restrict y = network->state.y;
    float *restrict low_x = network->state.low_x, *restrict low_y = network->state.low_y;
    for (size_t slot = 0; slot < slots; ++slot) {
        low_x[slot] = mspringi_low_of(x[slot], low_x[slot], network->state.grid);
        low_y[slot] = mspringi_low_of(y[slot], low_y[slot], network->state.grid);
    }
}

// Contact may leave a velocity with the low word of another: that is no reason to drop it, but one written by a
// host is.
static void drop_stale_low_velocities(const mspring_network *network) {
    const mspringi_state *s = &network->state;
    const size_t slots = network->is_precise ? mspringi_used_slots(network) : 0;
    for (size_t slot = 0; slot < slots; ++slot) {
        s->low_vx[slot] = mspringi_low_of(s->vx[slot], s->low_vx[slot], 0.0f);
        s->low_vy[slot] = mspringi_low_of(s->vy[slot], s->low_vy[slot], 0.0f);
    }
}

void mspringi_clear_unused_slots(const mspring_network *network) {
    const size_t slots = mspringi_slot_count(network), used = mspringi_used_slots(network);
    for (size_t i = 0; i < mspringi_state_arrays(network); ++i)
        memset(network->state.x + i * slots + used, 0, (slots - used) * sizeof *network->state.x);
}

// Put in order what somebody outside may have written to.
static void tidy(const mspring_network *network) {
    if (!network->is_open)
        return;
    if (network->has_host_view)
        mspringi_clear_unused_slots(network);
    mspringi_clear_empty_slots(network);
    mspringi_drop_stale_lows(network);
    drop_stale_low_velocities(network);
}

// Set the lag with which a step begins. After an edit, the last substep may be too long a time for springs to act,
// and relative springs are as stiff as this step's substeps allow. A reset takes groups back to velocities that
// count as half a substep old.
static void begin_lag(mspring_network *network, const mspringi_attempt *attempt) {
    const float h = attempt->h, lag = network->steps.lag;
    mspring_id spring;
    network->lag = network->full_lag = network->groups.count > 0 ? h : lag;
    if (!attempt->solver->ops->lags || network->groups.count > 0)
        return;
    if (network->fractions.values && lag > 0.0f)
        network->lag = network->full_lag = h;
    else if (lag > h)
        network->lag =
            fminf(lag, fmaxf((float)fmin(mspringi_stable_in_any_shape(network, &spring), (double)FLT_MAX), h));
}

// Keep the state in the backup, run all substeps, and look at what they have led to.
static mspringi_extrema run_once(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_solver_ops *ops = attempt->solver->ops;
    const bool is_cut = mspringi_stages_split_step(network, attempt);
    mspringi_extrema extrema = {0.0f, 0.0f, 0.0f};
    mspringi_field base = {NULL, NULL};
    network->added_substeps = 0;
    network->first_substep = 0;
    network->step_substeps = attempt->substeps;
    begin_lag(network, attempt);
    tidy(network);
    if (ops->begin)
        ops->begin(network);
    if (!is_cut) {
        base = mspringi_stages_forces(network, attempt);
        mspringi_stages_forces_known(network, attempt, base);
        if (mspringi_sleep_is_whole(network))
            return extrema;
        if (ops->run_step && ops->run_step(network, attempt, base, &extrema)) {
            network->lag = network->full_lag = attempt->h;
            return extrema;
        }
        if (network->plastic.yields) // in substeps that were undone, as they met the floor
            mspringi_stage_yielding.roll_back(network);
    }
    copy_state(network, &network->state, &network->backup);
    network->backup_is_start = !is_cut && network->sleep.sleeping == 0;
    if (ops->keep)
        ops->keep(attempt->solver->object);
    if (is_cut)
        base = mspringi_stages_forces(network, attempt);
    run_substeps(network, attempt, base, is_cut);
    if (network->is_open)
        mspringi_clear_empty_slots(network);
    if (ops->end)
        ops->end(network);
    if (!ops->has_stability_limit) // the explicit solver sweeps rows, others all slots
        mspringi_clear_unused_slots(network);
    return mspringi_guard_extrema_of_all(network);
}

/* ------------------------------------------------------------------------------------------------- the step */

void mspringi_clear_empty_slots(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_slot_count(network);
    for (size_t i = 0; i < mspringi_state_arrays(network); ++i)
        for (uint32_t run = 0; run < t->empty_run_count; ++run)
            memset(s->x + i * slots + t->empty_runs[run].first_slot, 0,
                   t->empty_runs[run].slot_count * sizeof *s->x);
    if (network->growth.particles)
        mspringi_id_pool_clear_slots(network);
}

// To the state of before the step.
static void go_back(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_solver *solver = attempt->solver;
    copy_state(network, &network->backup, &network->state);
    if (solver->ops->restore)
        solver->ops->restore(network, solver->object);
    mspringi_stages_roll_back(network, attempt);
    mspringi_clear_unused_slots(network);
    mspringi_clear_empty_slots(network);
}

/// Global damping times dt from which on a speed that is no speed any more (MSPRING_MAX_SPEED) could be one again
/// by the end of the step: exp(-20) is 2e-9, and at 1e24 m/s nothing overflows yet.
#define STRONG_DAMPING 20.0

// Refuse speeds that somebody outside has written to the state, which the end of the step would not show any more.
// In the step they overflow where rates of strain are computed, for springs that are not there too, of which wide
// vectors have more: not all levels would take it.
static mspring_result check_given_speeds(mspring_network *network, double dt) {
    if (!network->is_open || !((double)network->settings.global_damping * dt > STRONG_DAMPING))
        return MSPRING_OK;
    if (network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS) {
        mspringi_guard_clamp_state(network, NULL);
        return MSPRING_OK;
    }
    const mspringi_state *s = &network->state;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (mspringi_particle_exists(network, p) &&
            !(fabsf(s->vx[slot]) <= (float)MSPRING_MAX_SPEED && fabsf(s->vy[slot]) <= (float)MSPRING_MAX_SPEED)) {
            network->outcome.particle = p;
            return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                                 "unstable: a view or hook gave particle %u a velocity of (%g, %g) m/s. Write at "
                                 "most 1e15 m/s.",
                                 (unsigned)p, (double)s->vx[slot], (double)s->vy[slot]);
        }
    }
    return MSPRING_OK;
}

// Whether a step has nothing to do at all.
static bool is_idle(const mspring_network *network, const mspringi_stages *stages) {
    return mspringi_sleep_is_idle(network) && !stages->give_forces && !stages->cut_substeps && !stages->move;
}

// Run all substeps, and once more for each stage that counted on what did not hold.
static mspringi_extrema run(mspring_network *network, const mspringi_attempt *attempt) {
    for (size_t repeats = 0;; ++repeats) {
        const mspringi_extrema extrema = run_once(network, attempt);
        if (mspringi_hook_count(network) > 0)
            network->seen = mspringi_guard_bound(network, attempt->h, extrema);
        if (!mspringi_stages_must_repeat(network, attempt) || repeats == attempt->stages->count)
            return extrema;
        go_back(network, attempt);
    }
}

// Put back what an attempt that led to this has done. guard is that of before.
static void put_back(mspring_network *network, const mspringi_attempt *attempt, const mspringi_guard *guard) {
    go_back(network, attempt);
    network->guard = *guard;
    mspringi_stages_undo(network, attempt);
}

// Make an attempt, or leave everything as it is.
static mspring_result try_once(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_guard guard = network->guard;
    mspringi_stages_before_step(network, attempt);
    mspring_result result = mspringi_guard_begin(network, attempt);
    if (result == MSPRING_OK) {
        const mspringi_extrema extrema = run(network, attempt);
        result = mspringi_stages_verify(network, attempt);
        if (result == MSPRING_OK)
            result = mspringi_guard_end(network, attempt, extrema);
        if (result == MSPRING_OK)
            return MSPRING_OK;
        if (network->groups.count > 0)
            mspringi_groups_suspect(network);
        go_back(network, attempt);
    }
    network->guard = guard;
    mspringi_stages_undo(network, attempt);
    return result;
}

// Try with all groups held that went wrong. Then release, one by one, those that may have done so because of
// others.
static mspring_result try_without_some(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_guard guard = network->guard;
    mspring_result result = MSPRING_ERROR_UNSTABLE;
    while (result == MSPRING_ERROR_UNSTABLE && mspringi_groups_hold_suspects(network))
        result = try_once(network, attempt);
    if (result != MSPRING_OK)
        return result;
    const uint32_t count = network->groups.count;
    for (uint32_t group = 0; (group = mspringi_groups_next_doubtful(network, group)) < count; ++group) {
        if (result == MSPRING_OK)
            put_back(network, attempt, &guard);
        mspringi_groups_release(network, group);
        result = try_once(network, attempt);
        if (result != MSPRING_OK)
            mspringi_groups_hold(network, group);
    }
    return result == MSPRING_OK ? result : try_once(network, attempt);
}

// Make an attempt whose substeps are numbers, or leave everything as it is.
static mspring_result carry_out(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_sleep_begin(network, attempt);
    if (is_idle(network, attempt->stages)) {
        tidy(network);
        network->full_lag = network->steps.lag;
        return MSPRING_OK;
    }
    if (network->groups.count == 0)
        return try_once(network, attempt);
    mspringi_groups_begin(network);
    mspring_result result = try_once(network, attempt);
    if (result == MSPRING_ERROR_UNSTABLE && network->settings.guard != MSPRING_GUARD_CLAMP_BOUNDS)
        result = try_without_some(network, attempt);
    mspringi_groups_end(network, result == MSPRING_OK);
    if (result == MSPRING_OK)
        network->outcome = mspringi_outcome_none();
    return result;
}

// What all attempts at a step have in common.
typedef struct request {
    double dt;
    const mspringi_stages *stages;
} request;

// Have a solver take the step in so many substeps, or leave everything as it is.
static mspring_result attempt(mspring_network *network, const request *asked, const mspringi_solver *solver,
                              uint32_t substeps) {
    const mspringi_attempt made = {.dt = network->step_time,
                                   .h = (float)(network->step_time / (double)substeps),
                                   .substeps = substeps,
                                   .solver = solver,
                                   .stages = asked->stages,
                                   .relative_h = network->relative_h};
    if (!(made.h >= FLT_MIN && made.h <= FLT_MAX))
        return mspringi_fail(
            &network->message, MSPRING_ERROR_ARGUMENT,
            "dt is %g s (substeps: %u): each substep must be a finite number of at least 1.2e-38 s", made.dt,
            (unsigned)substeps);
    network->running = solver;
    const mspring_result result = carry_out(network, &made);
    network->running = NULL;
    if (result == MSPRING_OK)
        network->steps.lag = solver->ops->lags ? network->full_lag : network->steps.lag;
    return result;
}

/// Explicit substeps that take about as long as a clamped one. Where MSPRING_SUBSTEPS_AUTO finds that max_substeps
/// are too few, so many fewer take the step: no frame is late for it.
#define COST_OF_CLAMPED_SUBSTEP 100u

// The solver for steps that the chosen one cannot take, or NULL.
static const mspringi_solver *fallback_of(const mspring_network *network) {
    if (network->settings.guard == MSPRING_GUARD_CLAMP || network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS)
        return &mspringi_clamped;
    return network->settings.guard == MSPRING_GUARD_IMPLICIT && network->solver.ops->has_stability_limit
               ? &network->fallback
               : NULL;
}

// The substeps of a fallback that takes as many as the host has chosen, or would have been given.
static uint32_t substeps_of_fallback(mspring_network *network, double dt) {
    if (!mspringi_can_choose_substeps(network) || mspringi_pace_choose(network, dt) == MSPRING_OK)
        return network->substeps;
    const uint32_t fewer = network->max_substeps / COST_OF_CLAMPED_SUBSTEP;
    return fewer > 0 ? fewer : 1;
}

// Have the fallback take the step, or leave everything as it is. Neither it nor the chosen solver, for which a new
// motion begins after it, has a history then.
static mspring_result attempt_otherwise(mspring_network *network, const request *asked,
                                        const mspringi_solver *fallback) {
    const uint32_t own = substeps_of_fallback(network, asked->dt);
    const bool takes_one = fallback->ops->takes_one_substep;
    mspringi_solver_forget(fallback);
    const mspring_result result = attempt(network, asked, fallback, takes_one ? 1 : own);
    if (result != MSPRING_OK)
        return result;
    mspringi_solver_forget(&network->solver);
    if (!takes_one)
        network->substeps = own;
    return result;
}

// Take the step that the solver cannot take, or will not be asked to.
static mspring_result fall_back(mspring_network *network, const request *asked, const mspringi_solver *fallback) {
    const bool is_single =
        !network->solver.ops->has_stability_limit || network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS;
    const uint32_t fallback_steps = network->guard.fallback_steps, next = is_single ? 0 : MSPRINGI_FALLBACK_STEPS;
    const mspring_result result = attempt_otherwise(network, asked, fallback);
    const bool took_it = result == MSPRING_OK && !is_idle(network, asked->stages);
    if (took_it)
        network->guard.h = 0.0f; // before the solver is asked again, it is looked whether it can be
    network->guard.fallback_steps = !took_it ? fallback_steps : fallback_steps > 0 ? fallback_steps - 1 : next;
    if (took_it)
        network->outcome.flags |= fallback->ops->takes_one_substep ? MSPRING_STEP_FALLBACK : MSPRING_STEP_CLAMPED;
    return result;
}

static mspring_result attempt_as_chosen(mspring_network *network, const request *asked) {
    const mspring_result result =
        mspringi_can_choose_substeps(network) ? mspringi_pace_choose(network, asked->dt) : MSPRING_OK;
    return result == MSPRING_OK ? attempt(network, asked, &network->solver, network->substeps) : result;
}

// Try the solver, its fallback, and more substeps, as the host wants it.
static mspring_result take_step(mspring_network *network, const request *asked) {
    const mspringi_solver *fallback = fallback_of(network);
    const bool fallback_steps = fallback && network->guard.fallback_steps > 0;
    mspring_result result =
        fallback_steps ? fall_back(network, asked, fallback) : attempt_as_chosen(network, asked);
    if (result == MSPRING_ERROR_UNSTABLE && fallback && !fallback_steps)
        result = fall_back(network, asked, fallback);
    while (result == MSPRING_ERROR_UNSTABLE && network->settings.guard == MSPRING_GUARD_RETRY &&
           network->substeps < network->max_substeps) {
        const uint32_t twice = 2 * network->substeps;
        network->substeps = twice < network->max_substeps ? twice : network->max_substeps;
        result = attempt(network, asked, &network->solver, network->substeps);
        network->outcome.flags |= MSPRING_STEP_RETRIED;
    }
    return result;
}

static MSPRINGI_NOINLINE mspring_result step(mspring_network *network, double dt) {
    const double longest = (double)FLT_MAX * MSPRING_MAX_SUBSTEPS;
    if (!(dt > 0.0 && dt <= longest))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "dt is %g s, it must be > 0 and at most %g s: a substep is a float, and at most %u "
                             "make a step",
                             dt, longest, (unsigned)MSPRING_MAX_SUBSTEPS);
    const uint32_t substeps = network->substeps;
    const mspringi_any_shape any_shape = network->any_shape;
    if (check_given_speeds(network, dt) != MSPRING_OK)
        return MSPRING_ERROR_UNSTABLE;
    network->sleep.has_kept = network->was_in_hook = false;
    const mspringi_stages stages = mspringi_stages_of(network);
    network->step_time = dt;
    network->next_pace = network->steps.pace;
    const mspring_result result = take_step(network, &(request){dt, &stages});
    if (result != MSPRING_OK) {
        network->substeps = substeps;
        network->any_shape = any_shape;
        mspringi_sleep_undo(network);
        return result;
    }
    network->is_open = network->was_in_hook;
    network->has_host_view = false;
    if (is_idle(network, &stages)) {
        network->outcome.flags |= MSPRING_STEP_ASLEEP;
        network->step_time = dt;
        return MSPRING_OK;
    }
    network->steps.pace = network->next_pace;
    mspringi_stages_after_step(network, &stages, network->step_time);
    if (network->forces.held_any)
        mspringi_field_clear(network, network->forces.held);
    network->forces.held_any = false;
    return MSPRING_OK;
}

// Note what came of a step, rounding to nearest.
static MSPRINGI_NOINLINE void note(mspring_network *network, double dt, mspring_result result) {
    mspringi_steps *steps = &network->steps;
    const uint32_t flags = network->outcome.flags;
    steps->result = result;
    steps->outcome = network->outcome;
    if (result != MSPRING_OK) {
        steps->outcome.flags = 0;
        mspringi_shared_clear(network->shared); // of hooks: this one says why the step failed
        return;
    }
    steps->substeps = (flags & MSPRING_STEP_FALLBACK ? 1 : network->substeps) + network->added_substeps;
    steps->substeps = steps->substeps < MSPRING_MAX_SUBSTEPS ? steps->substeps : MSPRING_MAX_SUBSTEPS;
    mspringi_pace_note(network, dt);
    steps->count++;
    steps->fallback_count += (flags & (MSPRING_STEP_FALLBACK | MSPRING_STEP_CLAMPED)) != 0;
    steps->time += network->step_time;
    mspringi_message_clear(&network->message); // of what was tried first
}

mspring_result mspring_network_step(mspring_network *network, double dt) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    network->outcome = mspringi_outcome_none();
    network->added_substeps = 0;
    const size_t used = network->memory.used;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = mspringi_tasks_restart_after_fork(network->tasks, &network->message);
    if (result == MSPRING_OK)
        result = step(network, dt);
    note(network, dt, result);
    mspringi_fp_leave(before);
    MSPRINGI_ASSERT(network->memory.used == used); // a step allocates nothing
    MSPRINGI_ASSERT(result != MSPRING_OK || mspringi_is_finite(network));
    return result;
}
