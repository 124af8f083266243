/// Runs of settings on clones.
#include <math.h>
#include <string.h>

#include "analysis/settle/settle.h"
#include "analysis/tune/reference.h"
#include "analysis/tune/tuning.h"
#include "base/cpu.h"
#include "base/hash.h"
#include "store/springs.h"

/// Springs times fine substeps between two looks at the clock.
#define SPRINGS_IN_BATCH 1000000u

/// Substeps of the fine run, relative to the largest number of the explicit settings: both are of second order.
#define FINE_TIMES_EXPLICIT 3.0

/// Smallest scale of errors, relative to the network's size.
#define MIN_SCALE 1e-6

/// Rounding of single precision, relative to the network's size.
#define ROUNDING 0x1p-24

/* ------------------------------------------------------------------------------------------------------- clones */

static mspring_result forward_error(mspringi_tuning *tuning, const mspringi_trial *trial,
                                    const mspring_network *clone, mspring_result result) {
    if (trial)
        return mspringi_fail(&tuning->network->message, result, "setting %u: %s", (unsigned)trial->row.setting,
                             clone->message.text);
    tuning->network->message = clone->message;
    return result;
}

mspring_result mspringi_tune_clone(mspringi_tuning *tuning, mspring_network *from, bool copy_hooks,
                                   mspring_network **clone) {
    mspring_clone_def def;
    (void)mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def);
    def.copy_hooks = copy_hooks;
    const mspring_result result = mspring_network_clone(from, &def, clone);
    if (result != MSPRING_OK)
        return mspringi_fail(&tuning->network->message, result, "no memory for a clone of the network");
    (*clone)->tasks = from->tasks;
    return mspring_network_set_contact(*clone, NULL);
}

mspring_result mspringi_tune_set_solver(mspring_network *clone, const mspring_settings *solver) {
    const mspring_settings own = mspringi_settings_of(clone);
    const mspring_settings wanted = mspringi_settings_with_solver_of(&own, solver);
    return mspring_network_set_settings(clone, &wanted);
}

void mspringi_tune_destroy_clone(mspring_network *clone) {
    if (clone)
        clone->tasks = NULL;
    mspring_network_destroy(clone);
}

// Make a clone with the trial's solver; NULL if the solver cannot take this network.
static mspring_result make_clone(mspringi_tuning *tuning, mspringi_trial *trial, mspring_network *from,
                                 mspring_network **clone) {
    *clone = NULL;
    mspring_network *made = NULL;
    mspring_result result = mspringi_tune_clone(tuning, from, false, &made);
    if (result != MSPRING_OK)
        return result;
    result = mspringi_tune_set_solver(made, &trial->setting);
    if (result == MSPRING_OK) {
        *clone = made;
        return MSPRING_OK;
    }
    if (result == MSPRING_ERROR_LIMIT) {
        trial->row.flags |= MSPRING_TUNE_REJECTED;
        result = MSPRING_OK;
    } else {
        result = forward_error(tuning, trial, made, result);
    }
    mspringi_tune_destroy_clone(made);
    return result;
}

// Take one timed step of a clone. A rejected step ends the trial.
static mspring_result step(mspringi_tuning *tuning, mspringi_trial *trial, mspring_network *clone) {
    const mspring_tune_def *def = &tuning->def;
    const double before = def->clock(def->user);
    const mspring_result result = mspring_network_step(clone, def->dt);
    const double seconds = def->clock(def->user) - before;
    if (result == MSPRING_ERROR_UNSTABLE) {
        trial->row.flags |= MSPRING_TUNE_REJECTED;
        return MSPRING_OK;
    }
    if (result != MSPRING_OK)
        return forward_error(tuning, trial, clone, result);
    double *times = tuning->is_resting ? trial->rest_times : trial->times;
    uint32_t *time_count = tuning->is_resting ? &trial->rest_count : &trial->time_count;
    if (*time_count < tuning->time_capacity)
        times[(*time_count)++] = seconds > 0.0 ? seconds : 0.0;
    trial->row.flags |= MSPRING_TUNE_HAS_COST;
    return MSPRING_OK;
}

static bool is_rejected(const mspringi_trial *trial) {
    return trial->row.flags & MSPRING_TUNE_REJECTED;
}

/// Callback after a step; step counts from 1.
typedef void (*after_step_fn)(mspringi_tuning *tuning, const mspring_network *clone, uint32_t step, void *context);

// Run a trial from the state of a network. has_run: true if it was completed.
static mspring_result run(mspringi_tuning *tuning, mspringi_trial *trial, mspring_network *from, uint32_t steps,
                          after_step_fn after, void *context) {
    mspring_network *clone;
    mspring_result result = make_clone(tuning, trial, from, &clone);
    uint32_t done = 0;
    while (result == MSPRING_OK && clone && done < steps &&
           mspringi_tuning_has_time(tuning, (double)done / (double)steps)) {
        result = step(tuning, trial, clone);
        if (result != MSPRING_OK || is_rejected(trial))
            break;
        ++done;
        if (after)
            after(tuning, clone, done, context);
    }
    if (clone && done > 0) {
        trial->row.settings.substeps = clone->substeps;
        trial->relative_h = clone->fractions.values ? clone->relative_h : 0.0f;
    }
    mspringi_tune_destroy_clone(clone);
    trial->has_run = done == steps;
    tuning->done += 1.0;
    return result;
}

/* -------------------------------------------------------------------------------------------------------- costs */

mspring_result mspringi_tune_costs(mspringi_tuning *tuning) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < tuning->trial_count; ++i)
        result = run(tuning, &tuning->trials[i], tuning->base, MSPRINGI_TUNE_FIRST_STEPS, NULL, NULL);
    return result;
}

mspring_result mspringi_tune_more_costs(mspringi_tuning *tuning) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < tuning->trial_count; ++i)
        if (tuning->trials[i].row.flags & MSPRING_TUNE_HAS_COST && !is_rejected(&tuning->trials[i]))
            result = run(tuning, &tuning->trials[i], tuning->base, tuning->step_count, NULL, NULL);
    return result;
}

/* ------------------------------------------------------------------------------------------------- trajectories */

/// Reference run, and sums over a trial.
typedef struct comparison {
    mspringi_reference reference;
    double motion;          ///< m, largest RMS distance from the start over the steps of the reference run
    double internal, total; ///< J: largest kinetic plus elastic energy, and total energy at the end
    uint32_t free_count;    ///< particles that are not pinned
    double squares;         ///< m^2, sum over a trial or the second reference run
} comparison;

// Moment of comparison at this step, or MSPRINGI_TUNE_MOMENTS if none.
static uint32_t moment_of(const mspringi_tuning *tuning, uint32_t step) {
    for (uint32_t moment = 0; moment < MSPRINGI_TUNE_MOMENTS; ++moment)
        if ((uint64_t)tuning->step_count * (moment + 1) / MSPRINGI_TUNE_MOMENTS == step)
            return moment;
    return MSPRINGI_TUNE_MOMENTS;
}

static double *positions_at(const mspringi_tuning *tuning, uint32_t moment) {
    return tuning->positions + (size_t)2 * moment * tuning->base->topology.particle_count;
}

// Update the motion and the energy after each step: a body may be back at its start at all moments.
static void measure_motion(const mspringi_tuning *tuning, comparison *c) {
    const mspringi_reference *r = &c->reference;
    const mspringi_state *start = &tuning->base->state;
    double squares = 0.0;
    for (uint32_t p = 0; p < r->particle_count; ++p) {
        const uint32_t slot = tuning->base->topology.slot_of_particle[p];
        const double dx = r->x[p] - mspringi_x_of(start, slot), dy = r->y[p] - mspringi_y_of(start, slot);
        if (r->inverse_mass[p] > 0.0)
            squares += dx * dx + dy * dy;
    }
    c->motion = c->free_count > 0 ? fmax(c->motion, sqrt(squares / (double)c->free_count)) : 0.0;
    const mspringi_reference_energy energy = mspringi_reference_measure(r);
    c->internal = fmax(c->internal, energy.internal);
    c->total = energy.internal + energy.potential;
}

static void save_moment(const mspringi_tuning *tuning, const comparison *c, uint32_t moment) {
    const mspringi_reference *r = &c->reference;
    memcpy(positions_at(tuning, moment), r->x,
           2 * (size_t)r->particle_count * sizeof *r->x); // y follows x in memory
}

// Number of fine substeps in a step, at most 1e9, for comparison with trials of this stiffness of relative springs.
static double fine_substeps(const mspringi_tuning *tuning, const mspringi_reference *r, float relative_h) {
    const double stable = floor(tuning->def.dt / mspringi_reference_substep(r)) + 1.0;
    double most = 0.0;
    for (uint32_t i = 0; i < tuning->trial_count; ++i) {
        const mspringi_trial *trial = &tuning->trials[i];
        if (trial->row.settings.solver == MSPRING_SOLVER_EXPLICIT && trial->relative_h == relative_h &&
            !is_rejected(trial))
            most = fmax(most, trial->row.settings.substeps);
    }
    return fmin(fmax(stable, FINE_TIMES_EXPLICIT * most), 1e9);
}

// Add the distances of the reference's particles from those of the fine run at this moment.
static void add_distances(const mspringi_tuning *tuning, uint32_t moment, comparison *c) {
    const mspringi_reference *r = &c->reference;
    const double *x = positions_at(tuning, moment), *y = x + r->particle_count;
    for (uint32_t p = 0; p < r->particle_count; ++p)
        if (r->inverse_mass[p] > 0.0)
            c->squares += (r->x[p] - x[p]) * (r->x[p] - x[p]) + (r->y[p] - y[p]) * (r->y[p] - y[p]);
}

// Run the reference. False if the time ran out. A second run is compared with the first.
static bool make_fine_run(mspringi_tuning *tuning, comparison *c, float relative_h, bool is_second) {
    const double substeps = fine_substeps(tuning, &c->reference, relative_h), h = tuning->def.dt / substeps;
    const uint32_t batch = 1 + SPRINGS_IN_BATCH / (c->reference.spring_count + 1);
    for (uint32_t step = 1; step <= tuning->step_count; ++step) {
        for (uint32_t left = (uint32_t)substeps; left > 0;) {
            const uint32_t count = batch < left ? batch : left;
            if (!mspringi_tuning_has_time(tuning, 0.0))
                return false;
            mspringi_reference_run(&c->reference, h, count);
            left -= count;
        }
        if (step == 1)
            mspringi_reference_clear_forces(&c->reference);
        if (!is_second)
            measure_motion(tuning, c);
        const uint32_t moment = moment_of(tuning, step);
        if (moment < MSPRINGI_TUNE_MOMENTS && is_second)
            add_distances(tuning, moment, c);
        else if (moment < MSPRINGI_TUNE_MOMENTS)
            save_moment(tuning, c, moment);
    }
    return true;
}

static void compare(mspringi_tuning *tuning, const mspring_network *clone, uint32_t step, void *context) {
    comparison *c = context;
    const uint32_t moment = moment_of(tuning, step);
    if (moment == MSPRINGI_TUNE_MOMENTS)
        return;
    const double shift_x = clone->origin_x - tuning->base->origin_x,
                 shift_y = clone->origin_y - tuning->base->origin_y;
    mspringi_reference_set_motion(&c->reference, clone, shift_x, shift_y);
    mspringi_reference_kick(&c->reference, 0.5 * (double)clone->steps.lag);
    add_distances(tuning, moment, c);
}

static double at_least(const mspringi_tuning *tuning, double scale) {
    const double least = MIN_SCALE * tuning->size;
    return scale > least ? scale : least > 0.0 ? least : 1.0;
}

// Root mean square distance over the moments, m.
static double mean_distance(const comparison *c) {
    return sqrt(c->squares / (double)c->free_count / MSPRINGI_TUNE_MOMENTS);
}

static mspring_result run_trajectory(mspringi_tuning *tuning, mspringi_trial *trial, comparison *c) {
    c->squares = 0.0;
    const mspring_result result = run(tuning, trial, tuning->base, tuning->step_count, compare, c);
    if (result != MSPRING_OK || !trial->has_run || c->free_count == 0)
        return result;
    mspring_tune_row *row = &trial->row;
    const mspringi_reference_energy energy = mspringi_reference_measure(&c->reference);
    row->flags |= MSPRING_TUNE_HAS_TRAJECTORY;
    row->duration = tuning->step_count * tuning->def.dt;
    row->trajectory_error = mean_distance(c);
    row->trajectory_share = row->trajectory_error / at_least(tuning, c->motion);
    row->energy_drift = c->internal > 0.0 ? (energy.internal + energy.potential - c->total) / c->internal : 0.0;
    return MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------- groups of trials */

// True if a trial with this stiffness of relative springs has yet to run.
static bool is_pending(const mspringi_trial *trial, float relative_h) {
    return trial->row.flags & MSPRING_TUNE_HAS_COST && !is_rejected(trial) && !trial->has_run &&
           trial->relative_h == relative_h;
}

typedef mspring_result (*group_fn)(mspringi_tuning *tuning, float relative_h);

// Run the trials, grouped by the stiffness of relative springs.
static mspring_result run_groups(mspringi_tuning *tuning, group_fn fn) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; i < tuning->trial_count; ++i)
        tuning->trials[i].has_run = false;
    for (uint32_t i = 0; result == MSPRING_OK && i < tuning->trial_count; ++i) {
        const float relative_h = tuning->trials[i].relative_h;
        if (!is_pending(&tuning->trials[i], relative_h) || tuning->is_over)
            continue;
        result = fn(tuning, relative_h);
        for (uint32_t j = i; j < tuning->trial_count; ++j)
            if (tuning->trials[j].relative_h == relative_h)
                tuning->trials[j].has_run = true;
    }
    return result;
}

// Disturb each coordinate by what a float of the network's size rounds away: no setting starts more exactly.
static void disturb(const mspringi_tuning *tuning, mspringi_reference *r) {
    const double step = ROUNDING * tuning->size;
    for (uint32_t p = 0; p < r->particle_count; ++p) {
        const uint64_t bits = mspringi_mix(p);
        if (!(r->inverse_mass[p] > 0.0))
            continue;
        r->x[p] += bits & 1 ? step : -step;
        r->y[p] += bits & 2 ? step : -step;
    }
}

// Run the reference once more from a disturbed start, and report how far it comes from the first run.
static mspring_result run_second(mspringi_tuning *tuning, mspring_network *fine, comparison *c, float relative_h) {
    mspringi_reference_destroy(&c->reference, fine);
    const mspring_result result = mspringi_reference_create(&c->reference, fine);
    if (result != MSPRING_OK)
        return forward_error(tuning, NULL, fine, result);
    disturb(tuning, &c->reference);
    c->squares = 0.0;
    if (!make_fine_run(tuning, c, relative_h, true))
        return MSPRING_OK;
    const double share = mean_distance(c) / at_least(tuning, c->motion);
    for (uint32_t i = 0; i < tuning->trial_count; ++i) {
        mspringi_trial *trial = &tuning->trials[i];
        if (trial->relative_h != relative_h || !(trial->row.flags & MSPRING_TUNE_HAS_TRAJECTORY))
            continue;
        trial->row.trajectory_spread = (float)share;
        if (share > tuning->def.max_error)
            trial->row.flags |= MSPRING_TUNE_CHAOTIC;
    }
    return MSPRING_OK;
}

static mspring_result trajectories_of_group(mspringi_tuning *tuning, float relative_h) {
    mspring_network *fine = NULL;
    comparison c = {.motion = 0.0};
    mspring_result result = mspringi_tune_clone(tuning, tuning->base, 0, &fine);
    if (result != MSPRING_OK)
        return result;
    if (relative_h > 0.0f)
        mspringi_derive_relative(fine, relative_h);
    result = mspringi_reference_create(&c.reference, fine);
    if (result != MSPRING_OK) {
        result = forward_error(tuning, NULL, fine, result);
        mspringi_tune_destroy_clone(fine);
        return result;
    }
    for (uint32_t p = 0; p < c.reference.particle_count; ++p)
        c.free_count += c.reference.inverse_mass[p] > 0.0;
    if (make_fine_run(tuning, &c, relative_h, false)) {
        for (uint32_t i = 0; result == MSPRING_OK && i < tuning->trial_count; ++i)
            if (is_pending(&tuning->trials[i], relative_h))
                result = run_trajectory(tuning, &tuning->trials[i], &c);
        if (result == MSPRING_OK && c.free_count > 0)
            result = run_second(tuning, fine, &c, relative_h);
    }
    mspringi_tune_destroy_clone(fine); // frees the reference's memory, too
    return result;
}

mspring_result mspringi_tune_time_fine_step(mspringi_tuning *tuning, float relative_h, double *seconds) {
    const mspring_tune_def *def = &tuning->def;
    mspring_network *fine = NULL;
    mspringi_reference r;
    mspring_result result = mspringi_tune_clone(tuning, tuning->base, 0, &fine);
    if (result != MSPRING_OK)
        return result;
    if (relative_h > 0.0f)
        mspringi_derive_relative(fine, relative_h);
    result = mspringi_reference_create(&r, fine);
    if (result == MSPRING_OK) {
        const double substeps = fine_substeps(tuning, &r, relative_h), begun = def->clock(def->user);
        mspringi_reference_run(&r, def->dt / substeps, 1);
        *seconds = substeps * (def->clock(def->user) - begun);
    } else {
        result = forward_error(tuning, NULL, fine, result);
    }
    mspringi_tune_destroy_clone(fine); // frees the reference's memory, too
    return result;
}

mspring_result mspringi_tune_trajectories(mspringi_tuning *tuning) {
    return run_groups(tuning, trajectories_of_group);
}

/* --------------------------------------------------------------------------------------------------------- rest */

static void add_positions(mspringi_tuning *tuning, const mspring_network *clone, uint32_t step, void *context) {
    const mspring_network *settled = context;
    const mspringi_state *s = &clone->state;
    const uint32_t count = clone->topology.particle_count;
    (void)step;
    for (uint32_t p = 0; p < count; ++p) {
        const uint32_t slot = clone->topology.slot_of_particle[p];
        tuning->positions[p] += clone->origin_x - settled->origin_x + mspringi_x_of(s, slot);
        tuning->positions[count + p] += clone->origin_y - settled->origin_y + mspringi_y_of(s, slot);
    }
}

static mspring_result run_rest(mspringi_tuning *tuning, mspringi_trial *trial, mspring_network *settled,
                               double bending) {
    const uint32_t count = settled->topology.particle_count;
    memset(tuning->positions, 0, 2 * (size_t)count * sizeof *tuning->positions);
    const mspring_result result = run(tuning, trial, settled, tuning->step_count, add_positions, settled);
    if (result != MSPRING_OK || !trial->has_run)
        return result;
    double farthest = 0.0;
    for (uint32_t p = 0; p < count; ++p) {
        const uint32_t slot = settled->topology.slot_of_particle[p];
        const double dx = tuning->positions[p] / (double)tuning->step_count - mspringi_x_of(&settled->state, slot);
        const double dy =
            tuning->positions[count + p] / (double)tuning->step_count - mspringi_y_of(&settled->state, slot);
        farthest = fmax(farthest, sqrt(dx * dx + dy * dy));
    }
    trial->row.flags |= MSPRING_TUNE_HAS_REST;
    trial->row.bending = bending;
    trial->row.rest_error = farthest;
    trial->row.rest_share = farthest / at_least(tuning, bending);
    return MSPRING_OK;
}

// Remove forces that act in the first step only, and stop pinned particles.
static void stop_motion(mspring_network *network) {
    const size_t bytes = 2 * mspringi_slot_count(network) * sizeof(float);
    mspringi_forces_forget(network);
    memset(network->state.vx, 0, bytes); // vy follows vx in memory
}

static bool has_time(void *user) {
    return mspringi_tuning_has_time(user, 0.0);
}

static mspring_result rests_of_group(mspringi_tuning *tuning, float relative_h) {
    mspring_network *settled = NULL;
    mspring_settle_def def;
    mspring_settle_result rest = {.struct_size = sizeof rest};
    mspring_result result = mspringi_tune_clone(tuning, tuning->base, 0, &settled);
    if (result != MSPRING_OK)
        return result;
    (void)mspring_init(MSPRING_STRUCT_SETTLE_DEF, &def, sizeof def);
    def.relative_substep = (double)relative_h;
    stop_motion(settled);
    const mspringi_watcher watcher = {has_time, tuning};
    result = mspringi_settle_watched(settled, &def, &rest, watcher);
    const bool is_unknown = result == MSPRING_ERROR_ARGUMENT && !mspringi_can_settle(settled);
    if (result == MSPRING_ERROR_EQUILIBRIUM || result == MSPRING_ERROR_LIMIT || is_unknown) {
        result = MSPRING_OK; // no equilibrium, or areas that settling does not support
    } else if (result != MSPRING_OK) {
        result = forward_error(tuning, NULL, settled, result);
    } else {
        for (uint32_t i = 0; result == MSPRING_OK && i < tuning->trial_count; ++i)
            if (is_pending(&tuning->trials[i], relative_h))
                result = run_rest(tuning, &tuning->trials[i], settled, rest.displacement);
    }
    mspringi_tune_destroy_clone(settled);
    return result;
}

mspring_result mspringi_tune_rests(mspringi_tuning *tuning) {
    tuning->is_resting = true;
    const mspring_result result = run_groups(tuning, rests_of_group);
    tuning->is_resting = false;
    return result;
}
