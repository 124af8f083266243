/// @file tuning.h
/// State of a tuning run: settings and their results so far.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TUNING_H
#define MSPRINGI_TUNING_H

#include "store/network.h"

/// Number of moments at which a trajectory is compared.
#define MSPRINGI_TUNE_MOMENTS 4

/// Bounds on the number of steps of a trajectory of automatic length.
#define MSPRINGI_TUNE_MAX_STEPS 1024
#define MSPRINGI_TUNE_MIN_STEPS 16

/// Capacity for the default settings.
#define MSPRINGI_TUNE_DEFAULT_SETTINGS 24

/// Number of steps for the first measurement of a cost.
#define MSPRINGI_TUNE_FIRST_STEPS 4

/// Bounds on the number of starts for a result.
#define MSPRINGI_TUNE_MIN_STARTS 4
#define MSPRINGI_TUNE_MAX_STARTS 64

/// Result of one run of a scene.
typedef struct mspringi_scene_run {
    double quantities[MSPRING_TUNE_QUANTITIES];
    double cost; ///< mean time of a step, s
} mspringi_scene_run;

/// A setting and its results.
typedef struct mspringi_trial {
    mspring_settings setting;
    mspring_tune_row row;
    float relative_h; ///< substep of the relative springs, s; 0 if there are none
    bool has_run;     ///< its trajectory or rest is complete in the present pass
    double *times;    ///< [time_capacity] time of each step in motion, s
    uint32_t time_count;
    double *rest_times; ///< [time_capacity] behind them: time of each step from rest, s
    uint32_t rest_count;
    mspringi_scene_run *runs; ///< [scene.start_count]; row.scene_starts are complete
} mspringi_trial;

typedef struct mspringi_tuning {
    mspring_network *network; ///< the host's
    mspring_network *base;    ///< its clone without hooks, ramps and breaking
    mspring_tune_def def;
    mspring_tune_scene scene; ///< start_count 0: none
    uint32_t trial_count, step_count, time_capacity;
    mspringi_trial *trials;
    double *times;     ///< of all trials
    double *positions; ///< [moments][2][particles] positions of the reference run, relative to the base's origin;
                       ///< or sums of positions
    mspringi_scene_run *runs; ///< [trials + 1][scene.start_count] of all trials, the fine runs last
    double size;              ///< of the network, m
    double begun;             ///< start, s by the clock
    double done, units;       ///< units of work done and in total, for the progress callback
    bool is_resting;          ///< the present steps start at rest
    bool is_over;             ///< the budget is used up, or the progress callback stopped the run
} mspringi_tuning;

/// True if time is left. part: fraction of the present unit of work that is done.
bool mspringi_tuning_has_time(mspringi_tuning *tuning, double part);

/// Choose step_count: the period of the slowest oscillation, as far as the budget allows. Needs the first costs.
mspring_result mspringi_tune_choose_duration(mspringi_tuning *tuning);

/// Time of a step of the reference run, s, with this stiffness of relative springs.
mspring_result mspringi_tune_time_fine_step(mspringi_tuning *tuning, float relative_h, double *seconds);

/// Passes over all trials. They omit results that the budget does not allow.
mspring_result mspringi_tune_costs(mspringi_tuning *tuning);
mspring_result mspringi_tune_trajectories(mspringi_tuning *tuning);
mspring_result mspringi_tune_rests(mspringi_tuning *tuning);
mspring_result mspringi_tune_scenes(mspringi_tuning *tuning);
/// Time more steps.
mspring_result mspringi_tune_more_costs(mspringi_tuning *tuning);

/// Sort the values and return their median; 0 if there are none.
double mspringi_tune_median(double *values, uint32_t count);

/// Mark the rows on the Pareto front and the recommended one. Call it after all measurements.
void mspringi_tune_rank(const mspringi_tuning *tuning);

/// Clone a network, with its hooks or without. The clone shares its workers, so do not step the original
/// meanwhile. Errors go to the host's message.
mspring_result mspringi_tune_clone(mspringi_tuning *tuning, mspring_network *from, bool copy_hooks,
                                   mspring_network **clone);
void mspringi_tune_destroy_clone(mspring_network *clone);
/// Have a clone the solver of these settings; its guard, gravity and so on stay.
mspring_result mspringi_tune_set_solver(mspring_network *clone, const mspring_settings *solver);

/// Wake a clone for good, and disable all fallbacks of its solver.
void mspringi_tune_disable_fallbacks(mspring_network *clone);
/// Disable breaking and yielding.
void mspringi_tune_make_unbreakable(mspring_network *clone);

/// Number of steps of dt in a duration, rounded up.
uint32_t mspringi_tune_steps_in(double duration, double dt);

#endif
