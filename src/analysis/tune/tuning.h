/// @file tuning.h
/// What is tried on a network, and what has come of it so far.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TUNING_H
#define MSPRINGI_TUNING_H

#include "store/network.h"

/// Moments at which a trajectory is compared.
#define MSPRINGI_TUNE_MOMENTS 4

/// Most steps of a trajectory, and least, where the host leaves its length to the library.
#define MSPRINGI_TUNE_MOST_STEPS 1024
#define MSPRINGI_TUNE_LEAST_STEPS 16

/// Room for those that are tried where the host gives none.
#define MSPRINGI_TUNE_USUAL_SETTINGS 24

/// Steps for the first look at what a setting costs.
#define MSPRINGI_TUNE_FIRST_STEPS 4

/// Least starts whose results are told, and most.
#define MSPRINGI_TUNE_LEAST_STARTS 4
#define MSPRINGI_TUNE_MOST_STARTS 64

/// What came of one run of a scene.
typedef struct mspringi_scene_run {
    double quantities[MSPRING_TUNE_QUANTITIES];
    double cost; ///< s for a step, mean
} mspringi_scene_run;

/// A setting that is tried.
typedef struct mspringi_trial {
    mspring_solver_def setting;
    mspring_tune_row row;
    float relative_h; ///< substep that relative springs had; 0 if there are none
    bool has_run;     ///< its trajectory, or its rest, in the pass that is made now
    double *times;    ///< [time_capacity] s for each step so far while the network moved, and
    uint32_t time_count;
    double *rest_times; ///< [time_capacity] behind them, from rest on
    uint32_t rest_count;
    mspringi_scene_run *runs; ///< [scene.start_count], of which row.scene_starts are made
} mspringi_trial;

typedef struct mspringi_tuning {
    mspring_network *network; ///< the host's
    mspring_network *base;    ///< a clone of it without hooks, ramps and breaking
    mspring_tune_def def;
    mspring_tune_scene scene; ///< start_count 0: there is none
    uint32_t trial_count, step_count, time_capacity;
    mspringi_trial *trials;
    double *times;  ///< of all trials
    double *places; ///< [moments][2][particles] of the fine run, relative to the base's origin; or sums of places
    mspringi_scene_run *runs; ///< [trials + 1][scene.start_count] of all trials, and of the fine runs at the end
    double size;              ///< of the network, m
    double begun;             ///< s, by the clock
    double done, units;       ///< parts of the work, for who watches
    bool is_resting;          ///< the steps that are made now begin at rest
    bool is_over;             ///< the budget is used up, or who watches has had enough
} mspringi_tuning;

/// Whether there is time left to go on; part of the present unit of work is done.
bool mspringi_tuning_goes_on(mspringi_tuning *tuning, double part);

/// How many steps trajectories are to have: as many as the slowest swing takes that is in the motion, or as the
/// budget allows. After the first costs; into step_count.
mspring_result mspringi_tune_choose_duration(mspringi_tuning *tuning);

/// Seconds that a step of a fine run takes, for springs of this relative stiffness.
mspring_result mspringi_tune_time_fine_step(mspringi_tuning *tuning, float relative_h, double *seconds);

/// Passes over all trials. What the budget does not allow is left out.
mspring_result mspringi_tune_costs(mspringi_tuning *tuning);
mspring_result mspringi_tune_trajectories(mspringi_tuning *tuning);
mspring_result mspringi_tune_rests(mspringi_tuning *tuning);
mspring_result mspringi_tune_scenes(mspringi_tuning *tuning);
/// Take the time of more steps.
mspring_result mspringi_tune_costs_again(mspringi_tuning *tuning);

/// Sort numbers, and return their median; 0 if there are none.
double mspringi_tune_median(double *values, uint32_t count);

/// Say which rows are on the Pareto front, and which is recommended. After all times are in.
void mspringi_tune_judge(const mspringi_tuning *tuning);

/// Clone a network that lends its workers, so that it must not be stepped meanwhile; fail with the host's message.
mspring_result mspringi_tune_spawn(mspringi_tuning *tuning, mspring_network *from, mspring_network **clone);
/// The same with its hooks.
mspring_result mspringi_tune_spawn_with_hooks(mspringi_tuning *tuning, mspring_network *from,
                                              mspring_network **clone);
void mspringi_tune_dismiss(mspring_network *clone);

/// Wake a clone for good, and let no other solver stand in for its own.
void mspringi_tune_expose(mspring_network *clone);
/// Let no spring break by its strain.
void mspringi_tune_make_unbreakable(mspring_network *clone);

/// Steps of dt in a time, rounded up.
uint32_t mspringi_tune_steps_in(double duration, double dt);

#endif
