/// @file lab.h
/// Experimental: each minor version may change these calls. Define MSPRING_EXPERIMENTAL, then include massspring.h.
///
///     limits      builder_add_strain_limits
///     rest        network_settle
///     tune        network_tune; tune_settings
///     describe    network_describe
///     jobs        job_begin, _run, _finish, _error, _destroy
///
/// The shared library exports them under a name of exactly this minor version. The loader refuses a program that was
/// built for another.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_LAB_H
#define MASSSPRING_LAB_H

#ifndef MSPRING_EXPERIMENTAL
#error "These calls are experimental: define MSPRING_EXPERIMENTAL before you include massspring.h"
#endif

#include "core.h"

#ifdef __cplusplus
extern "C" {
#endif

/* -------------------------------------------------------------------------------------------------------- limits */

/// Have springs stiffen beyond a strain: cloth, rubber, ligaments.
/// Beside each of them lies another spring then, that only pulls or only pushes. With k the stiffness, r the rest
/// length, q the strain, s the stiffening:
///
///     q > 0    k (L - r) + s k (L - (1 + q) r)    where L > (1 + q) r
///     q < 0    the same                           where L < (1 + q) r
///
/// Call it twice to have both, for the same springs: MSPRING_ALL would take the first limits in. The limit is no wall:
/// for a limit of s = 9, ten times the force brings about twice the strain of q. mspring_network_get_stable_dt() counts
/// its stiffness fourfold, whether it acts or not. So explicit substeps are shorter by a factor of sqrt(1 + 4 s), or
/// sqrt(1 + 8 s) with both. The implicit and the direct solver have it in their linear system.
///
/// Limits are springs with ids of their own, without damping, and relative if those beside them are. They break at the
/// length at which those do, on their side: one that pulls stays if its spring breaks while it is pressed. They never
/// yield. What you change, break, restore or remove later, change on both.
///
/// @param strain        q, above -1, not 0
/// @param stiffening    s, above 0, at most 30
/// @param first_limit   receives the id of the first limit; the others follow; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ID if there is no such spring; ARGUMENT also for a spring that breaks
/// before its limit, or has rest length 0 (the message names it); LIMIT, MEMORY. On error none is added.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_strain_limits(mspring_builder *builder,
    const mspring_id *ids, mspring_id first, uint32_t count, float strain, float stiffening, mspring_id *first_limit);

/* -------------------------------------------------------------------------------------------- static equilibrium */

/// Flags of mspring_settle_def.
typedef enum mspring_settle_flags {
    MSPRING_SETTLE_LEAVE_FLOATING = 1 << 0 ///< leave components without an equilibrium alone, instead of failing
} mspring_settle_flags;

/// How mspring_network_settle() searches.
typedef struct mspring_settle_def {
    uint32_t struct_size;
    uint32_t flags;          ///< MSPRING_SETTLE_LEAVE_FLOATING or 0; default 0
    uint32_t max_iterations; ///< 1 to 1000000; default 1000
    uint32_t reserved;       ///< 0
    /// Largest force left on a particle, as a share of the largest force of a spring or from outside. 1e-15 to 1;
    /// default 1e-9. If rounding prevents that, the search ends at the limit of rounding.
    double tolerance;
    /// Substep (s) that sets the stiffness of relative springs. Default 0: that of the last step. Before the first
    /// step they have no stiffness then.
    double relative_substep;
} mspring_settle_def;
MSPRING_DEFAULT(mspring_settle_def, MSPRING_STRUCT_SETTLE_DEF);

/// Result of mspring_network_settle().
typedef struct mspring_settle_result {
    uint32_t struct_size;
    uint32_t iterations; ///< of Newton's method
    /// Largest force (N) left on a particle in x or y, before positions are rounded to float. Rounding adds about
    /// stiffness times the last place of a coordinate.
    double residual;
    double largest_force; ///< largest force of a spring, or from outside in x or y, N
    double displacement;  ///< largest displacement of a particle, m
    uint32_t is_stable;   ///< 1: every small push is answered by a force back, or by none
    uint32_t left_alone;  ///< particles of floating components that were not moved
} mspring_settle_result;
MSPRING_DEFAULT(mspring_settle_result, MSPRING_STRUCT_SETTLE_RESULT);

/// Move the particles to static equilibrium.
/// Gravity, springs and the forces given for the next step act. Pinned particles do not move. Hooks are not called,
/// and dampers do not matter. Afterwards velocities are zero, except those of pinned particles. The forces given for
/// the next step are still there.
///
/// The search starts from the present positions and lowers the energy in every iteration. Any start is allowed:
/// crushed, folded, or with all particles in one place. If there are several equilibria, the result depends on the
/// start. It may be tangled, and need not have the lowest energy. If an equilibrium is not stable, such as a pendulum
/// upside down, the search leaves it by a small push.
///
/// If a component has no pinned particle, the forces on it must cancel, as without gravity. Otherwise it has no
/// equilibrium: the call fails, or leaves it alone with MSPRING_SETTLE_LEAVE_FLOATING. A lattice of n particles needs
/// memory for about n log n numbers, and n^1.5 operations in an iteration.
/// @param def     NULL for the defaults
/// @param result  may be NULL
/// Threads: exclusive. Allocates: yes, and frees it. Errors: EQUILIBRIUM if there is none, it is out of bounds, or
/// max_iterations do not lead to it (the message names a particle, and the force on it); LIMIT if the factor would have
/// over 2^31 numbers; ARGUMENT, STRUCT, MEMORY, BUSY. On error nothing has moved.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_settle(
    mspring_network *network, const mspring_settle_def *def, mspring_settle_result *result);

/* --------------------------------------------------------------------------------------------- tuning: the trade */

/// Error by which settings are compared.
typedef enum mspring_tune_measure {
    MSPRING_TUNE_BY_TRAJECTORY = 0, ///< mspring_tune_row.trajectory_share
    MSPRING_TUNE_BY_REST = 1,       ///< mspring_tune_row.rest_share
    MSPRING_TUNE_BY_BENDING = 2,    ///< mspring_tune_row.bending, m: for networks with relative springs
    MSPRING_TUNE_BY_SCENE = 3,      ///< mspring_tune_row.scene_distance: for networks that break; needs a scene
    MSPRING_TUNE_MEASURE_INT = MSPRING_ENUM_INT ///< no value
} mspring_tune_measure;

/// Flags of mspring_tune_def.
typedef enum mspring_tune_flags {
    MSPRING_TUNE_NOTHING_ELSE = 1 << 0 ///< measure the costs and the error that measure names, no other
} mspring_tune_flags;

/// Receives the progress of a long run, 0 to 1, between steps.
/// It returns 1 to go on, 0 to stop. After a stop the result has the numbers measured so far.
typedef uint32_t(MSPRING_CALL *mspring_progress_fn)(double done, void *user);

/// Returns seconds since a fixed moment. They never decrease.
typedef double(MSPRING_CALL *mspring_clock_fn)(void *user);

/// Flags of mspring_tune_scene.
typedef enum mspring_tune_scene_flags {
    MSPRING_TUNE_SCENE_FLOOR = 1 << 0,    ///< the network's floor acts
    MSPRING_TUNE_SCENE_BREAKING = 1 << 1, ///< springs break at their break strains
    MSPRING_TUNE_SCENE_HOOKS = 1 << 2     ///< its hooks are called, with their user pointers and storage
} mspring_tune_scene_flags;

/// Prepares one run of a scene, before its first step.
/// It may change the run as the host changes the network: add hooks, give forces or velocities, break springs, reset
/// the data of hooks. It must not step or destroy the run, or touch the network that is tuned.
/// @param run    a clone of the network, destroyed after the run
/// @param start  0 ... start_count - 1. For the same start, prepare all settings and the fine run in the same way.
/// @param user   mspring_tune_def.user
/// @return MSPRING_OK; mspring_network_tune() fails with any other result
typedef mspring_result(MSPRING_CALL *mspring_tune_prepare_fn)(mspring_network *run, uint32_t start, void *user);

/// Scene in which settings are tried: floor, breaking, hooks.
typedef struct mspring_tune_scene {
    uint32_t struct_size;
    uint32_t flags;       ///< default MSPRING_TUNE_SCENE_FLOOR | MSPRING_TUNE_SCENE_BREAKING
    uint32_t start_count; ///< runs of each setting, from starts that differ a little; 4 to 64; default 16
    uint32_t reserved;    ///< 0
    double duration;      ///< time of a run, s; > 0, up to 100000 steps, rounded up to whole ones; default 1
    /// Largest change of velocity at the start, m/s, in x and y; > 0, finite; default 0.1. In all starts but the
    /// first, each particle that is not pinned gets its own. If all runs break alike, kick is too small.
    double kick;
    double tolerance;                ///< share of a mean that makes no difference; >= 0, finite; default 0.05
    double max_distance;             ///< instead of max_error with MSPRING_TUNE_BY_SCENE; > 0; default 1
    mspring_tune_prepare_fn prepare; ///< default NULL
    void *reserved_pointer;          ///< NULL
} mspring_tune_scene;
MSPRING_DEFAULT(mspring_tune_scene, MSPRING_STRUCT_TUNE_SCENE);

/// Settings to try. A row above a limit is not recommended.
typedef struct mspring_tune_def {
    uint32_t struct_size;
    uint32_t setting_count; ///< 1 to 1000; 0 if settings is NULL
    double dt;              ///< length of a step, s, as in mspring_network_step(); default 1/64
    /// Simulated time (s) of trajectories, up to 100000 steps, rounded up to whole steps, at least four. Default 0:
    /// one period of the slowest swing in the motion, 16 to 1024 steps, fewer if the budget is small.
    double duration;
    /// Longest time (s) of the call; > 0; default 10. It is checked between steps and iterations of settling.
    double budget;
    mspring_tune_measure measure;       ///< default MSPRING_TUNE_BY_TRAJECTORY
    uint32_t flags;                     ///< MSPRING_TUNE_NOTHING_ELSE or 0; default 0
    double max_error;                   ///< limit of a row's error; > 0; default 0.01; INFINITY: none
    double max_cost;                    ///< limit of a row's cost, s for a step; > 0; default INFINITY
    double max_drift;                   ///< limit of energy_drift, if measured; >= 0; default 0.1
    const mspring_settings *settings;   ///< [setting_count], of which solver, integrator, substeps, iterations,
                                        ///< residual, tile_size and coarse_period count; default NULL: those of
                                        ///< mspring_tune_settings()
    mspring_clock_fn clock;             ///< default NULL: the system's; must be set without MSPRING_FEATURE_HOSTED
    mspring_progress_fn progress;       ///< default NULL
    void *user;                         ///< passed to clock, to progress and to the scene's prepare; default NULL
    const mspring_tune_scene *scene;    ///< default NULL: none
    void *reserved_pointer;             ///< NULL
} mspring_tune_def;
MSPRING_DEFAULT(mspring_tune_def, MSPRING_STRUCT_TUNE_DEF);

/// Flags of mspring_tune_row.
typedef enum mspring_tune_row_flags {
    MSPRING_TUNE_HAS_COST = 1 << 0,       ///< costs are measured
    MSPRING_TUNE_HAS_TRAJECTORY = 1 << 1, ///< trajectory_error, trajectory_share and energy_drift are measured
    MSPRING_TUNE_HAS_REST = 1 << 2,       ///< bending, rest_error and rest_share are measured
    MSPRING_TUNE_REJECTED = 1 << 3,       ///< a step was rejected as unstable, or the solver rejects the network
    MSPRING_TUNE_PARETO = 1 << 4,         ///< no other row has both less cost and less error
    MSPRING_TUNE_RECOMMENDED = 1 << 5,    ///< the recommended row
    MSPRING_TUNE_HAS_SCENE = 1 << 6,      ///< the numbers of the scene are measured, from at least four starts
    MSPRING_TUNE_CHAOTIC = 1 << 7         ///< trajectory_spread is above max_error: measure by scene instead
} mspring_tune_row_flags;

/// Quantities at the end of each run of a scene.
typedef enum mspring_tune_quantity {
    MSPRING_TUNE_BROKEN = 0, ///< springs that broke in the run, minus those that were restored
    MSPRING_TUNE_ENERGY = 1, ///< kinetic and elastic energy, J
    MSPRING_TUNE_EXTENT = 2  ///< larger side of the box around all particles, m
} mspring_tune_quantity;
#define MSPRING_TUNE_QUANTITIES 3

/// A setting and its results. Numbers that are not measured are 0.
typedef struct mspring_tune_row {
    uint32_t struct_size;
    uint32_t flags;        ///< bits of mspring_tune_row_flags
    uint32_t setting;      ///< index in the list of settings
    uint32_t step_count;          ///< steps that were timed
    double min_cost, median_cost; ///< time of a step, s
    /// Root mean square distance (m) from the fine run, over four moments and all particles that are not pinned.
    double trajectory_error;
    /// The same as a share of the fine run's largest root mean square distance from its start, after any step.
    double trajectory_share;
    /// Energy at the end minus the fine run's. It is a share of the fine run's largest kinetic plus elastic energy at
    /// the four moments.
    double energy_drift;
    double bending; ///< largest displacement of a particle, from the state given to rest, m
    /// Largest distance (m) from a particle's place at rest to its mean position, over the steps from rest on.
    double rest_error;
    double rest_share;                            ///< rest_error as a share of bending
    double duration;                              ///< simulated time of the trajectory, s
    double moving_cost;                           ///< median time of a step from the state given on, s
    double resting_cost;                          ///< the same from rest on; may be less if implicit or direct
    uint32_t scene_starts;                        ///< starts that were compared
    uint32_t fine_substeps;                       ///< explicit substeps in a step of the scene's fine run
    double scene_cost;                            ///< median over the starts of the mean time of a step, s
    double scene_distance;                        ///< largest of the three, see mspring_network_tune()
    double scene_mean[MSPRING_TUNE_QUANTITIES];   ///< over the starts, by MSPRING_TUNE_BROKEN and so on
    double scene_spread[MSPRING_TUNE_QUANTITIES]; ///< standard deviations
    double fine_mean[MSPRING_TUNE_QUANTITIES];    ///< the same of the fine runs from the same starts
    double fine_spread[MSPRING_TUNE_QUANTITIES];
    /// trajectory_share of a second fine run; 0 also if the budget ended before it. Its start differs by a rounding in
    /// single precision: each coordinate by 2^-24 times the network's size. Smaller differences between rows mean
    /// nothing.
    double trajectory_spread;
    mspring_settings settings; ///< for mspring_network_set_settings(), with the substeps that the row's steps took
} mspring_tune_row;
MSPRING_DEFAULT(mspring_tune_row, MSPRING_STRUCT_TUNE_ROW);

/// List the default settings of mspring_network_tune().
///
///   explicit  some numbers of substeps from the smallest stable one on, none above 1000
///   implicit  BDF2 and generalised-alpha with residuals of 0.1, 0.03 and 0.01, each in one and two substeps
///   direct    BDF2 and generalised-alpha, each in one and two substeps; up to 20000 particles
///
/// Solvers that this build lacks are left out.
/// @param dt        seconds, finite, > 0
/// @param settings  [capacity], struct_size set in the first, the same for all; may be NULL if capacity is 0
/// @param count     receives the number of settings, even if it is larger than capacity
/// Threads: exclusive. Allocates: yes, and frees it. Errors: ARGUMENT, also for too little capacity unless that is 0;
/// STRUCT, MEMORY, BUSY.
MSPRING_API mspring_result MSPRING_CALL mspring_tune_settings(
    mspring_network *network, double dt, mspring_settings *settings, uint32_t capacity, uint32_t *count);

/// Measure cost and accuracy of settings of the solver.
/// Each setting runs on clones of this network, on this machine, from the present state. Call it in a state that you
/// will simulate: just made and falling, or moving.
///
///   cost        time of every step with a setting, by the clock, with the network's workers
///   trajectory  distance from a fine run in double precision (symplectic, of second order); a second fine run shows
///               if the motion itself is chaotic (MSPRING_TUNE_CHAOTIC)
///   rest        equilibrium (mspring_network_settle()), and motion from there on; not for networks without one
///   scene       comparison with many fine runs, with the floor, breaking and hooks of mspring_tune_def.scene
///
/// Outside of a scene hooks are not called, ramps stand still, nothing breaks by strain, and there is no floor. The
/// network does not sleep, no fallback solver takes its steps (MSPRING_GUARD_IMPLICIT), and nothing is clamped.
/// Forces given for the next step act in the first one. Shares are of at least a millionth of the network's size.
/// Relative springs follow the substep: each row is compared with a fine run and an equilibrium that have the
/// stiffness of its own substeps. Its bending reports how firm that is.
///
/// **Scene.** Each setting and an explicit fine run start from the same start_count starts. For each quantity the
/// distance is the difference of the two means, in units. A unit is the fine runs' standard deviation. It is at least
/// tolerance times their mean, and at least one broken spring. The largest distance of the three quantities counts.
/// If the budget is small, there are fewer starts; the first rows may have one more than the others. If the fine run
/// is rejected, no row has the scene's numbers. If a network has relative springs, it cannot have a scene: they would
/// follow the fine run's substeps.
///
/// **Recommended row.** If max_error is finite, it is the one of least median cost within all limits. Otherwise it is
/// the one of least error within max_cost and max_drift. Of equal rows it is the first. There may be none.
/// MSPRING_TUNE_BY_SCENE uses scene_cost instead of the median cost, and max_distance instead of max_error.
///
/// **Budget.** The call measures the costs of all settings first, then the error that measure names, then the rest.
/// If the budget runs out, rows lack the flags of the missing numbers. For the same duration and number of starts,
/// all numbers but costs are the same in every call and on any machine.
/// @param def       NULL for the defaults
/// @param rows      [capacity], struct_size set in the first, the same for all; receives one for each setting
/// @param capacity  at least the number of settings
/// @param count     receives the number of rows
/// Threads: exclusive; prepare is called on the calling thread. Allocates: yes, and frees it. Errors: ARGUMENT (the
/// message names the fault or the setting), STRUCT, MEMORY, BUSY; the result of the scene's prepare. On error nothing
/// is written, and the network is as it was.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_tune(
    mspring_network *network, const mspring_tune_def *def, mspring_tune_row *rows, uint32_t capacity, uint32_t *count);

/* ------------------------------------------------------------------------------------------------------- describe */

/// Describe how a network is laid out and solved: lines of text, each a name and a number, such as "lattice_rows 40".
/// Names and their order may change. src/README.md explains them.
/// @param text  [capacity] receives as much as fits, with a 0 at its end; may be NULL if capacity is 0
/// @param size  receives the size of the whole text, its 0 included; may be NULL
/// Threads: shared. Allocates: never. Errors: ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_describe(
    const mspring_network *network, char *text, size_t capacity, size_t *size);

/* ----------------------------------------------------------------------------------------------------------- jobs */

/// A job makes another plan while the network goes on: it compacts, or undoes that, without a long frame.
///
///   mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job);     // in a frame: copies the springs
///   mspring_job_run(job, 0, NULL);                                // on any thread, or some parts a frame
///   if (mspring_job_finish(network, job) == MSPRING_OK) ...       // in a later frame: the network moves
///   mspring_job_destroy(job);
///
/// Between begin and finish you may step, edit, save, load and clone the network. The job has no effect before
/// finish. Snapshots and clones do not contain it. If springs are set or broken meanwhile, finish copies them again.
/// The plan follows from the springs that are live at begin. So the network's bits depend only on the steps at which
/// the job is begun and finished. The thread, the time and the number of calls do not matter. A network has one job
/// at a time. A job owns all data that it reads: networks and jobs may be destroyed in any order. It uses the
/// network's allocator. If another thread runs the job, the allocator must allow calls from two threads at once.
typedef struct mspring_job mspring_job;

/// Plan that a job makes.
typedef enum mspring_layout {
    MSPRING_LAYOUT_COMPACT = 0,           ///< as mspring_network_compact()
    MSPRING_LAYOUT_WHOLE = 1,             ///< all springs, broken ones too: restoring springs then needs no long frame
    MSPRING_LAYOUT_INT = MSPRING_ENUM_INT ///< no value
} mspring_layout;

/// Begin a job: copy springs and their layout.
/// Threads: exclusive. Allocates: yes. Errors: BUSY inside a hook, or if the network has a job that is neither finished
/// nor destroyed; ARGUMENT, MEMORY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_job_begin(
    mspring_network *network, mspring_layout layout, mspring_job **job);

/// Run the next parts of a job.
/// Some parts make the solver. For a network of 200,000 springs the longest part takes two to three milliseconds.
/// @param at_most  number of parts to run; 0 for all
/// @param left     receives an estimate of the parts left, which never rises; 0: it can be finished; may be NULL
/// Threads: exclusive access to job; no access to any network. Allocates: yes. Errors: MEMORY or LIMIT, after which the
/// job can only be destroyed; ARGUMENT for NULL, or for a job that has failed or is finished.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_job_run(
    mspring_job *job, uint32_t at_most, uint32_t *left);

/// Move the network to the plan of a job.
/// Slots change: fill views again. Afterwards the job can only be destroyed, unless the result is MSPRING_ERROR_BUSY
/// or MSPRING_ERROR_ARGUMENT. The job keeps the memory of the old plan until it is destroyed.
/// Threads: exclusive and job. Allocates: some. Errors: OUTDATED if since begin particles or springs were added or
/// removed, a spring was restored that the plan leaves out, or the plan has changed otherwise: begin another job; BUSY
/// inside a hook, or if the job has not been run to its end; MEMORY; LIMIT; ARGUMENT for NULL, for a job that is
/// finished, or for one of another network. If a run failed, its error is returned again. On error the network is as it
/// was.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_job_finish(
    mspring_network *network, mspring_job *job);

/// Get the error message of a job.
/// It is that of the first mspring_job_run() that failed; "" if none did, or for NULL. The job owns it.
/// Threads: shared with other reads of the job. Allocates: never.
MSPRING_API const char *MSPRING_CALL mspring_job_error(const mspring_job *job);

/// Free a job, finished or not. NULL is allowed.
/// If it is finished, this frees the old plan, which may take milliseconds: another thread may do that.
/// Threads: exclusive access to job and, unless it is finished, to its network. Allocates: never.
MSPRING_API void MSPRING_CALL mspring_job_destroy(mspring_job *job);

#ifdef __cplusplus
}
#endif

#endif
