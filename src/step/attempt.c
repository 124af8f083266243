/// An attempt at a step: substeps with the forces that act in them, and the way back if it goes wrong.
#include "step/ladder.h"

#include <string.h>

#include "base/assert.h"
#include "base/cpu.h"
#include "stability/guard.h"
#include "stability/stability.h"
#include "store/group_ops.h"
#include "store/id_pool.h"
#include "store/sleepers.h"
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

// Take `count` substeps. A single one is divided if a stage wants it (max_parts).
static void run_solver(mspring_network *network, const mspringi_attempt *attempt, mspringi_field force,
                       uint32_t count) {
    const mspringi_solver *solver = attempt->solver;
    for (uint32_t left = MSPRINGI_SUBSTEP_PARTS, parts; left > 0; left -= parts) {
        parts = count > 1 ? left : mspringi_stages_max_parts(network, attempt, left);
        const float h = attempt->h * ((float)parts / (float)MSPRINGI_SUBSTEP_PARTS);
        network->added_substeps += parts < left;
        solver->ops->substeps(network, solver->object, h, force, count);
        network->lag = network->full_lag = h;
    }
}

// Take all substeps, in groups that stages leave free. Stages of an uncut step know its forces already, see run().
static void run_substeps(mspring_network *network, const mspringi_attempt *attempt, mspringi_field base) {
    const mspringi_stages *stages = attempt->stages;
    for (uint32_t substep = 0, count; substep < attempt->substeps; substep += count) {
        count = mspringi_stages_free_substeps(network, attempt, substep);
        network->first_substep = substep;
        mspringi_field outside;
        const mspringi_field force = mspringi_stages_before_substep(network, attempt, substep, base, &outside);
        if (substep == 0 && attempt->is_cut)
            mspringi_stages_forces_known(network, attempt, outside);
        // Stages that act after substeps, as hooks and contact, may have given sleepers a velocity.
        const bool holds = stages->follow_substeps && network->sleep.sleeping > 0;
        if (holds)
            mspringi_sleepers->hold(network);
        if (!mspringi_sleep_is_whole(network))
            run_solver(network, attempt, force, count);
        if (holds)
            mspringi_sleepers->put_back(network);
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

// Drop low words that do not belong to the velocities which a hook or a view wrote. (Contact leaves such low words,
// too: these stay.)
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

// Clean up after hooks and views, which may have written to the state.
static void tidy(const mspring_network *network) {
    if (!network->is_open)
        return;
    mspringi_clear_empty_slots(network);
    mspringi_drop_stale_lows(network);
    drop_stale_low_velocities(network);
}

// Set the lag at the start of a step. After an edit, the last substep may be longer than springs allow: then the
// lag is shorter. Relative springs follow from this step's substeps, so its h is the lag. Groups that were reset
// have velocities half a substep old.
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

// True if gravity is dithered: it would be rounded the same way in each substep. Precise networks have low words.
static bool has_dither(const mspring_network *network) {
    const mspring_settings *settings = &network->settings;
    return !network->is_precise && (settings->gravity_x != 0.0f || settings->gravity_y != 0.0f);
}

// Save the state in the backup, run all substeps, and return the extrema of the new state. Where all sleep, nothing
// is run or saved; the backup has nothing of blocks that run_step left asleep either.
static mspringi_extrema run(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_solver_ops *ops = attempt->solver->ops;
    mspringi_extrema extrema = {0.0f, 0.0f, 0.0f};
    mspringi_field base = {NULL, NULL};
    network->added_substeps = 0;
    network->first_substep = 0;
    network->forces.known = base;
    network->dithered = has_dither(network) ? attempt->substeps / 4 * 4 : 0;
    begin_lag(network, attempt);
    tidy(network);
    if (ops->begin)
        ops->begin(network);
    if (!attempt->is_cut) {
        base = mspringi_stages_forces(network, attempt);
        mspringi_stages_forces_known(network, attempt, base);
        if (mspringi_sleep_is_whole(network))
            return extrema;
        if (ops->run_step && ops->run_step(network, attempt, base, &extrema)) {
            network->lag = network->full_lag = attempt->h;
            return extrema;
        }
        mspringi_stages_roll_back_sweeps(network, attempt);
    }
    copy_state(network, &network->state, &network->backup);
    network->backup_is_start = !attempt->is_cut && network->sleep.sleeping == 0;
    if (ops->keep)
        ops->keep(attempt->solver->object);
    if (ops->allow_work)
        ops->allow_work(attempt->solver->object, attempt->most_work / attempt->dt);
    if (attempt->is_cut) // after the backup: stages that write the state may do so here
        base = mspringi_stages_forces(network, attempt);
    run_substeps(network, attempt, base);
    if (network->is_open)
        mspringi_clear_empty_slots(network);
    if (ops->end)
        ops->end(network);
    if (!ops->has_stability_limit) // those without one work on all slots, the explicit solver on rows alone
        mspringi_clear_unused_slots(network);
    return mspringi_guard_extrema_of_all(network);
}

/* ---------------------------------------------------------------------------------------------------- attempts */

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

// Return to the state before the step.
static void go_back(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_solver *solver = attempt->solver;
    copy_state(network, &network->backup, &network->state);
    if (network->sleep.sleeping > 0)
        mspringi_sleepers->restore(network);
    if (solver->ops->restore)
        solver->ops->restore(network, solver->object);
    mspringi_stages_roll_back(network, attempt);
    mspringi_clear_unused_slots(network);
    mspringi_clear_empty_slots(network);
}

// Count the work of the substeps, whether the attempt succeeds or not. Runs in which an assumption failed do not
// count: several workers have more of them, and the next attempt depends on the work left.
static void count_work(const mspring_network *network, mspringi_attempt *attempt) {
    const mspringi_solver *solver = attempt->solver;
    const uint32_t substeps = attempt->substeps + network->added_substeps;
    if (mspringi_sleep_is_whole(network))
        return;
    attempt->work += solver->ops->count_work ? solver->ops->count_work(solver->object, &attempt->is_spent)
                                             : (double)substeps * mspringi_solver_calm_work(solver);
}

// Undo the rest of an attempt, once the state is that before the step.
static void undo(mspring_network *network, const mspringi_attempt *attempt) {
    network->guard = attempt->guard;
    mspringi_stages_undo(network, attempt);
}

void mspringi_attempt_take_back(mspring_network *network, const mspringi_attempt *attempt) {
    go_back(network, attempt);
    undo(network, attempt);
}

// True if a step has nothing to do: everything sleeps and nothing acts.
static bool is_idle(const mspring_network *network, const mspringi_stages *stages) {
    return mspringi_sleep_is_idle(network) && !stages->give_forces && !stages->cut_substeps && !stages->move;
}

// Begin an attempt, up to its substeps. An idle one takes none.
static mspring_result begin(mspring_network *network, mspringi_attempt *attempt) {
    if (network->sleep.sleeping > 0)
        mspringi_sleepers->begin(network, attempt);
    attempt->is_idle = is_idle(network, attempt->stages);
    if (attempt->is_idle) {
        tidy(network);
        network->full_lag = network->steps.lag;
        return MSPRING_OK;
    }
    if (network->groups.count > 0)
        mspringi_held_groups->begin(network);
    attempt->guard = network->guard;
    mspringi_stages_before_step(network, attempt);
    const mspring_result result = mspringi_guard_begin(network, attempt);
    if (result != MSPRING_OK)
        undo(network, attempt);
    return result;
}

// Take the substeps, and undo them if they must be repeated or fail.
static mspring_result take(mspring_network *network, mspringi_attempt *attempt) {
    attempt->is_cut = mspringi_stages_must_cut_step(network, attempt);
    const mspringi_extrema extrema = run(network, attempt);
    network->seen = extrema;
    attempt->has_missed =
        mspringi_stages_must_repeat(network, attempt) && attempt->missed_count < attempt->stages->count;
    network->is_to_repeat = attempt->has_missed;
    if (attempt->has_missed) {
        go_back(network, attempt);
        return MSPRING_OK;
    }
    count_work(network, attempt);
    mspring_result result = mspringi_stages_verify(network, attempt);
    if (result == MSPRING_OK)
        result = mspringi_guard_end(network, attempt, extrema);
    if (result == MSPRING_OK)
        return MSPRING_OK;
    if (network->groups.count > 0 && result == MSPRING_ERROR_UNSTABLE)
        mspringi_held_groups->suspect(network);
    mspringi_attempt_take_back(network, attempt);
    return result;
}

void mspringi_attempt_make(mspring_network *network, mspringi_attempt *attempt) {
    if (attempt->result != MSPRING_OK)
        return;
    MSPRINGI_ASSERT(!network->running && attempt->substeps > 0 && attempt->h >= 0.0f);
    network->running = attempt->solver;
    attempt->work_before = attempt->has_missed ? attempt->work_before : attempt->work;
    if (!attempt->has_missed)
        attempt->result = begin(network, attempt);
    if (attempt->result == MSPRING_OK && !attempt->is_idle)
        attempt->result = take(network, attempt);
    network->running = NULL;
}
