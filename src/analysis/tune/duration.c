/// Automatic duration of trajectories: the period of the slowest oscillation in the motion.
///
/// In an oscillation of angular frequency w, displacements u from their mean and velocities v have mean squares
/// |v|^2 = w^2 |u|^2 (Rayleigh's quotient of the motion itself). While a body still moves in one direction, the
/// estimated period exceeds the time so far. So a clone runs until the period of its own estimate has passed. It
/// uses the implicit solver: that takes any stiffness, and its damping spares slow oscillations.
#include <math.h>
#include <string.h>

#include "analysis/tune/tuning.h"

/// Fractions of the budget: to find the period, and for all later passes over its steps.
#define PART_FOR_PERIOD 0.1
#define PART_FOR_STEPS 0.5

#define TWO_PI 6.283185307179586

/// Sums over the steps of a run, weighted by mass.
typedef struct geometric {
    double *x, *y;          ///< [particles] sums of displacements, m
    double squares, speeds; ///< sums of squared displacements and velocities
    uint32_t steps;
} geometric;

static void add_step(const mspringi_tuning *tuning, const mspring_network *clone, geometric *s) {
    const mspringi_state *now = &clone->state, *start = &tuning->base->state;
    const double shift_x = clone->origin_x - tuning->base->origin_x,
                 shift_y = clone->origin_y - tuning->base->origin_y;
    for (uint32_t p = 0; p < clone->topology.particle_count; ++p) {
        const uint32_t slot = clone->topology.slot_of_particle[p];
        const double inverse_mass = (double)clone->inverse_mass[slot];
        if (!(inverse_mass > 0.0))
            continue;
        const double dx = shift_x + (double)now->x[slot] - (double)start->x[slot];
        const double dy = shift_y + (double)now->y[slot] - (double)start->y[slot];
        const double vx = (double)now->vx[slot], vy = (double)now->vy[slot];
        s->x[p] += dx;
        s->y[p] += dy;
        s->squares += (dx * dx + dy * dy) / inverse_mass;
        s->speeds += (vx * vx + vy * vy) / inverse_mass;
    }
    s->steps++;
}

// Period estimated from the motion so far, s; 0 if nothing moves.
static double period_of(const mspring_network *clone, const geometric *s) {
    const double steps = (double)s->steps;
    double means = 0.0;
    for (uint32_t p = 0; p < clone->topology.particle_count; ++p) {
        const double inverse_mass = (double)clone->inverse_mass[clone->topology.slot_of_particle[p]];
        if (inverse_mass > 0.0)
            means += (s->x[p] * s->x[p] + s->y[p] * s->y[p]) / inverse_mass;
    }
    const double around_mean = fmax(s->squares - means / steps, 0.0);
    return s->speeds > 0.0 ? TWO_PI * sqrt(around_mean / s->speeds) : 0.0;
}

// Number of steps that all later passes have time for.
static mspring_result count_affordable(mspringi_tuning *tuning, double *steps) {
    const mspring_tune_def *def = &tuning->def;
    const double passes = def->flags & MSPRING_TUNE_NOTHING_ELSE ? 2.0 : 3.0;
    const double begun = def->clock(def->user);
    double seconds = 0.0;
    for (uint32_t i = 0; i < tuning->trial_count; ++i) {
        const mspringi_trial *trial = &tuning->trials[i];
        bool is_first = true;
        if (trial->time_count == 0 || trial->row.flags & MSPRING_TUNE_REJECTED)
            continue;
        for (uint32_t t = 0; t < trial->time_count; ++t)
            seconds += passes * trial->times[t] / (double)trial->time_count;
        for (uint32_t j = 0; j < i; ++j)
            is_first = is_first && tuning->trials[j].relative_h != trial->relative_h;
        if (!is_first || !mspringi_tuning_has_time(tuning, 0.0))
            continue;
        double fine = 0.0;
        const mspring_result result = mspringi_tune_time_fine_step(tuning, trial->relative_h, &fine);
        if (result != MSPRING_OK)
            return result;
        seconds += 2.0 * fine; // the fine run is made twice
    }
    const double left = PART_FOR_STEPS * def->budget - (begun - tuning->begun);
    *steps = seconds > 0.0 ? fmax(left, 0.0) / seconds : MSPRINGI_TUNE_MAX_STEPS;
    return MSPRING_OK;
}

// Run a clone for the period of its slowest oscillation, or `most` steps.
static uint32_t run_one_period(mspringi_tuning *tuning, mspring_network *clone, double most) {
    const mspring_tune_def *def = &tuning->def;
    const size_t particles = clone->topology.particle_count;
    const double begun = def->clock(def->user);
    geometric s = {.x = tuning->positions, .y = tuning->positions + particles};
    memset(tuning->positions, 0, 2 * particles * sizeof *tuning->positions);
    while ((double)s.steps < most && mspringi_tuning_has_time(tuning, 0.0) &&
           mspring_network_step(clone, def->dt) == MSPRING_OK) {
        add_step(tuning, clone, &s);
        const bool has_passed = period_of(clone, &s) <= s.steps * def->dt;
        if ((s.steps >= MSPRINGI_TUNE_MIN_STEPS && has_passed) ||
            def->clock(def->user) - begun > PART_FOR_PERIOD * def->budget)
            break;
    }
    return s.steps;
}

mspring_result mspringi_tune_choose_duration(mspringi_tuning *tuning) {
    double affordable = 0.0;
    mspring_network *clone = NULL;
    mspring_settings solver;
    tuning->step_count = MSPRINGI_TUNE_MOMENTS;
    if (!mspringi_tuning_has_time(tuning, 0.0))
        return MSPRING_OK;
    mspring_result result = count_affordable(tuning, &affordable);
    if (result == MSPRING_OK)
        result = mspringi_tune_clone(tuning, tuning->base, false, &clone);
    if (result != MSPRING_OK)
        return result;
    (void)mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver);
    solver.solver = MSPRING_SOLVER_IMPLICIT;
    tuning->step_count = MSPRINGI_TUNE_MIN_STEPS;
    const bool has_implicit = mspringi_solver_ops_of(MSPRING_SOLVER_IMPLICIT) != NULL;
    result = has_implicit ? mspringi_tune_set_solver(clone, &solver) : MSPRING_ERROR_LIMIT;
    if (result == MSPRING_OK) {
        const double most = fmin(affordable, MSPRINGI_TUNE_MAX_STEPS);
        const uint32_t steps = run_one_period(tuning, clone, most);
        tuning->step_count =
            steps > MSPRINGI_TUNE_MIN_STEPS || most < MSPRINGI_TUNE_MIN_STEPS ? steps : MSPRINGI_TUNE_MIN_STEPS;
    } else if (result == MSPRING_ERROR_LIMIT) {
        result = MSPRING_OK; // not available for this network
    } else {
        tuning->network->message = clone->message;
    }
    if (tuning->step_count < MSPRINGI_TUNE_MOMENTS)
        tuning->step_count = MSPRINGI_TUNE_MOMENTS;
    mspringi_tune_destroy_clone(clone);
    return result;
}
