/// One step: substeps with the forces that act in them, and the way back if it goes wrong.
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "contact/floor.h"
#include "edits/growth.h"
#include "edits/ramps.h"
#include "edits/strain.h"
#include "hooks.h"
#include "network.h"
#include "origin.h"
#include "sleep/sleep.h"
#include "solver.h"
#include "springs.h"
#include "stability/guard.h"
#include "stability/stability.h"

typedef struct copying {
    const float *from;
    float *to;
} copying;

static void copy_range(void *argument, size_t first, size_t end) {
    const copying *all = argument;
    memcpy(all->to + first, all->from + first, (end - first) * sizeof *all->to);
}

static void copy_state(const mspring_network *network, const mspringi_state *from, const mspringi_state *to) {
    copying all = {from->x, to->x};
    mspringi_tasks_run_ranges(network->tasks, MSPRINGI_STATE_ARRAYS * mspringi_slot_count(network), MSPRINGI_WIDTH,
                              copy_range, &all);
}

static void copy_field(const mspring_network *network, mspringi_field from, mspringi_field to) {
    memcpy(to.x, from.x, 2 * mspringi_slot_count(network) * sizeof *to.x);
}

static void clear_field(const mspring_network *network, mspringi_field field) {
    memset(field.x, 0, 2 * mspringi_slot_count(network) * sizeof *field.x);
}

/* ----------------------------------------------------------------------------------------------- force fields */

// The field that each substep starts from: what the host holds, with what the hooks before the step add. No field
// at all if there is nothing in it.
static mspringi_field prepare_base(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_forces *forces = &network->forces;
    const mspringi_field none = {NULL, NULL};
    if (!mspringi_hooks_any(network, MSPRING_PHASE_BEFORE_STEP))
        return forces->held_any ? forces->held : none;
    if (forces->held_any)
        copy_field(network, forces->held, forces->base);
    else
        clear_field(network, forces->base);
    mspringi_hooks_before_step(network, attempt, forces->base);
    return forces->base;
}

/* -------------------------------------------------------------------------------------------------- substeps */

static void run_substeps(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_solver *solver = attempt->solver;
    const bool hooks_before = mspringi_hooks_any(network, MSPRING_PHASE_BEFORE_SUBSTEP);
    const bool hooks_after = mspringi_hooks_any(network, MSPRING_PHASE_AFTER_SUBSTEP);
    const mspringi_field base = prepare_base(network, attempt);
    const mspringi_field field = hooks_before ? network->forces.driven : base;
    network->sleep.in_force = field;

    for (uint32_t substep = 0, count; substep < attempt->substeps; substep += count) {
        count = mspringi_hooks_free_substeps(network, attempt, substep);
        if (hooks_before)
            mspringi_hooks_before_substep(network, attempt, substep, base);
        if (substep == 0)
            mspringi_sleep_feel(network, field);
        if (substep == 0 && !mspringi_sleep_is_whole(network))
            mspringi_floor_begin(network);
        if (hooks_after)
            mspringi_sleep_hold(network);
        if (!mspringi_sleep_is_whole(network))
            solver->ops->substeps(network, solver->object, attempt->h, field, count);
        if (hooks_after)
            mspringi_sleep_put_back(network);
        if (hooks_after)
            mspringi_hooks_after_substep(network, attempt, substep + count - 1);
    }
}

void mspringi_drop_stale_lows(const mspring_network *network) {
    const mspringi_state *s = &network->state;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        s->low_x[slot] = mspringi_low_of(s->x[slot], s->low_x[slot]);
        s->low_y[slot] = mspringi_low_of(s->y[slot], s->low_y[slot]);
    }
}

// Keep the state in the backup, run all substeps, and look at what they have led to.
static mspringi_sight run(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_solver_ops *ops = attempt->solver->ops;
    mspringi_sight sight = {0.0f, 0.0f, 0.0f};
    if (network->is_open) {
        mspringi_clear_empty_slots(network);
        mspringi_drop_stale_lows(network);
    }
    if (ops->begin)
        ops->begin(network);
    if (network->hook_count == 0) {
        const mspringi_field base = network->sleep.in_force = prepare_base(network, attempt);
        mspringi_sleep_feel(network, base);
        if (mspringi_sleep_is_whole(network) || (ops->whole && ops->whole(network, attempt, base, &sight)))
            return sight;
    }
    copy_state(network, &network->state, &network->backup);
    if (ops->keep)
        ops->keep(attempt->solver->object);
    run_substeps(network, attempt);
    if (network->is_open)
        mspringi_clear_empty_slots(network);
    if (ops->end)
        ops->end(network);
    return mspringi_guard_look(network, 0, mspringi_slot_count(network));
}

/* ------------------------------------------------------------------------------------------------- the step */

void mspringi_clear_empty_slots(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    float *const arrays[MSPRINGI_STATE_ARRAYS] = {s->x, s->y, s->vx, s->vy, s->low_x, s->low_y};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; ++i)
        for (uint32_t run = 0; run < t->empty_run_count; ++run)
            memset(arrays[i] + t->empty_runs[run].first_slot, 0, t->empty_runs[run].slot_count * sizeof *arrays[i]);
    if (network->growth.particles)
        mspringi_growth_clear_slots(network);
}

// Choose the substeps of a step where that is left to the library.
static mspring_result choose_substeps(mspring_network *network, double dt) {
    mspring_id spring;
    const double limit = mspringi_stable_in_any_shape(network, &spring);
    uint32_t substeps = mspringi_substeps_within(dt, limit, network->max_substeps);
    if (network->guard_policy == MSPRING_GUARD_CLAMP_BOUNDS && substeps > network->max_substeps)
        substeps = network->max_substeps;
    if (substeps > network->max_substeps) {
        const mspring_id tightest = mspringi_tightest_spring(network, dt / (double)network->max_substeps);
        return mspringi_fail(
            &network->message, MSPRING_ERROR_UNSTABLE,
            "a step of %g s needs substeps of at most %g s, as spring %u is that stiff or damped for "
            "its masses: more than max_substeps, which is %u",
            dt, limit, (unsigned)tightest, (unsigned)network->max_substeps);
    }
    network->substeps = substeps;
    return MSPRING_OK;
}

// To the state of before the step.
static void go_back(mspring_network *network, const mspringi_solver *solver) {
    copy_state(network, &network->backup, &network->state);
    mspringi_sleep_restore(network);
    if (solver->ops->restore)
        solver->ops->restore(network, solver->object);
    if (!mspringi_sleep_is_whole(network))
        mspringi_floor_take_back(network->floor);
    mspringi_clear_empty_slots(network);
}

/// Global damping times dt from which on a speed that is no speed any more (MSPRING_MAX_SPEED) could be one again
/// by the end of the step: exp(-20) is 2e-9, and at 1e24 m/s nothing overflows yet.
#define STRONG_DAMPING 20.0

// Refuse speeds that somebody outside has written to the state, which the end of the step would not show any more.
// In the step they overflow where rates of strain are computed, for springs that are not there too, of which wide
// vectors have more: not all levels would take it.
static mspring_result check_given_speeds(mspring_network *network, double dt) {
    if (!network->is_open || !((double)network->global_damping * dt > STRONG_DAMPING))
        return MSPRING_OK;
    if (network->guard_policy == MSPRING_GUARD_CLAMP_BOUNDS) {
        mspringi_guard_put_back(network, NULL);
        return MSPRING_OK;
    }
    const mspringi_state *s = &network->state;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (mspringi_particle_exists(network, p) &&
            !(fabsf(s->vx[slot]) <= (float)MSPRING_MAX_SPEED && fabsf(s->vy[slot]) <= (float)MSPRING_MAX_SPEED))
            return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                                 "particle %u has been given a velocity of (%g, %g) m/s: at most 1e15 is allowed",
                                 (unsigned)p, (double)s->vx[slot], (double)s->vy[slot]);
    }
    return MSPRING_OK;
}

// Make an attempt whose substeps are numbers, or leave everything as it is.
static mspring_result carry_out(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_sleep_begin(network, attempt);
    if (mspringi_sleep_is_idle(network))
        return MSPRING_OK;
    const float relative_h = network->relative_h;
    const mspringi_guard guard = network->guard;
    mspringi_derive_relative(network, attempt->h);
    mspringi_ramps_apply(network, attempt->dt);
    mspring_result result = mspringi_guard_begin(network, attempt);
    if (result == MSPRING_OK) {
        result = mspringi_guard_end(network, attempt, run(network, attempt));
        if (result != MSPRING_OK)
            go_back(network, attempt->solver);
    }
    if (result != MSPRING_OK) {
        network->guard = guard;
        network->sleep.in_force = (mspringi_field){NULL, NULL};
        mspringi_derive_relative(network, relative_h);
        mspringi_ramps_apply(network, 0.0);
    }
    return result;
}

// Have a solver take the step in so many substeps, or leave everything as it is.
static mspring_result attempt(mspring_network *network, const mspringi_solver *solver, uint32_t substeps,
                              double dt) {
    const mspringi_attempt made = {dt, (float)(dt / (double)substeps), substeps, solver};
    if (!(made.h >= FLT_MIN && made.h <= FLT_MAX))
        return mspringi_fail(
            &network->message, MSPRING_ERROR_ARGUMENT,
            "dt is %g s (substeps: %u): each substep must be a finite number of at least 1.2e-38 s", dt,
            (unsigned)substeps);
    network->running = solver;
    const mspring_result result = carry_out(network, &made);
    network->running = NULL;
    return result;
}

/// Steps that follow one which the explicit solver could not take, and which it is not asked to: to find that it
/// still cannot takes longer than they do.
#define LENT_STEPS 15

// The solver for steps that the chosen one cannot take, or NULL.
static const mspringi_solver *fallback_of(const mspring_network *network) {
    if (network->guard_policy == MSPRING_GUARD_CLAMP)
        return &mspringi_clamped;
    return network->guard_policy == MSPRING_GUARD_IMPLICIT && network->solver.ops->has_border ? &network->fallback
                                                                                              : NULL;
}

// Have the fallback take the step, or leave everything as it is. Neither it nor the chosen solver, for which a new
// motion begins after it, has a history then.
static mspring_result attempt_otherwise(mspring_network *network, const mspringi_solver *fallback, double dt) {
    const uint32_t own = network->auto_substeps ? network->max_substeps : network->substeps;
    const bool takes_one = fallback->ops->takes_one;
    mspringi_solver_forget(fallback);
    const mspring_result result = attempt(network, fallback, takes_one ? 1 : own, dt);
    if (result != MSPRING_OK)
        return result;
    mspringi_solver_forget(&network->solver);
    if (!takes_one)
        network->substeps = own;
    return result;
}

// Take the step that the solver cannot take, or will not be asked to.
static mspring_result fall_back(mspring_network *network, const mspringi_solver *fallback, double dt) {
    const uint32_t lent = network->guard.lent, next = network->solver.ops->has_border ? LENT_STEPS : 0;
    const mspring_result result = attempt_otherwise(network, fallback, dt);
    const bool took_it = result == MSPRING_OK && !mspringi_sleep_is_idle(network);
    if (took_it)
        network->guard.h = 0.0f; // before the solver is asked again, it is looked whether it can be
    network->guard.lent = !took_it ? lent : lent > 0 ? lent - 1 : next;
    network->fallback_count += took_it;
    return result;
}

static mspring_result attempt_as_chosen(mspring_network *network, double dt) {
    const mspring_result result = network->auto_substeps ? choose_substeps(network, dt) : MSPRING_OK;
    return result == MSPRING_OK ? attempt(network, &network->solver, network->substeps, dt) : result;
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
    network->sleep.has_kept = false;
    const mspringi_solver *fallback = fallback_of(network);
    const bool lent = fallback && network->guard.lent > 0;
    mspring_result result = lent ? fall_back(network, fallback, dt) : attempt_as_chosen(network, dt);
    if (result == MSPRING_ERROR_UNSTABLE && fallback && !lent)
        result = fall_back(network, fallback, dt);
    while (result == MSPRING_ERROR_UNSTABLE && network->guard_policy == MSPRING_GUARD_RETRY &&
           network->substeps < network->max_substeps) {
        const uint32_t twice = 2 * network->substeps;
        network->substeps = twice < network->max_substeps ? twice : network->max_substeps;
        result = attempt(network, &network->solver, network->substeps, dt);
    }
    if (result != MSPRING_OK) {
        network->substeps = substeps;
        network->any_shape = any_shape;
        mspringi_sleep_undo(network);
        return result;
    }
    if (mspringi_sleep_is_idle(network))
        return MSPRING_OK;
    mspringi_sleep_notice(network);
    mspringi_ramps_pass(network, dt);
    mspringi_strain_pass(network);
    mspringi_origin_follow(network);
    mspringi_sleep_end(network, dt);
    if (network->forces.held_any)
        clear_field(network, network->forces.held);
    network->forces.held_any = false;
    return MSPRING_OK;
}

mspring_result mspring_network_step(mspring_network *network, double dt) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK)
        result = mspringi_tasks_follow(network->tasks, &network->message);
    if (result != MSPRING_OK)
        return result;
    const size_t used = network->memory.used;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = step(network, dt);
    mspringi_fp_leave(before);
    MSPRINGI_ASSERT(network->memory.used == used); // a step allocates nothing
    return result;
}
