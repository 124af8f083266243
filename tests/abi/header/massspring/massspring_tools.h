/// @file massspring_tools.h
/// Tools around networks: how long a substep may be, static equilibrium, what speed costs in accuracy, how a network
/// lies in memory, and compaction off the frame.
///
/// They are part of the library, but not frozen yet: a later version may change them. A program that only builds,
/// steps, edits and reads networks needs massspring.h alone.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_TOOLS_H
#define MASSSPRING_MASSSPRING_TOOLS_H

#include "massspring.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------- stability */

/// How long (s) an explicit substep of this network may be. Above the limit the fastest oscillation turns round and
/// grows in each substep.
///
/// For small motion about a shape, a substep h is stable just if the largest eigenvalue of
///     h^2 M^-1 K + 2 h M^-1 C
/// is at most 2 (1 + exp(global_damping h)), with M the masses, K the stiffness of the shape, C the dampers, and
/// without pinned particles. (One mode of angular frequency omega and damping ratio zeta: omega h <= 2 (sqrt(1 +
/// zeta^2) - zeta).) In K a spring that is shorter than its rest length has stiffness along its direction only. The
/// tangent stiffness would add what is below 0 across it, which stretches the limit: in a shape that is pressed
/// together now can be as short as 0.33 of that limit, and is safe. (mspring_guard goes by the tangent stiffness.)
/// The eigenvalue is found by iteration (Lanczos 1950). Relative springs follow h; a network of relative springs
/// alone is stable at every h (infinite) or at none (0).
/// @param now        for the shape of now, with K as said, to about 0.3 % and rather below than above; stretching a
///                   network stiffens it across and lowers this. May be NULL.
/// @param any_shape  for any shape that the network can get into, tangles included: at most now; of a full lattice
///                   at rest 0.71 of it, or 0.49 with dampers alone. It depends on springs (broken ones count as
///                   whole), masses and pins only. May be NULL.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for a network NULL, MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates yes, and frees it, if now is asked for   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_network_stable_dt(mspring_network *network, double *now,
                                                                       double *any_shape);

/// The smallest number of substeps for a step of dt that keeps each below safety times the stable one of now.
/// @param dt      seconds, finite, > 0
/// @param safety  > 0, at most 1. A network that keeps its shape does with 0.95; one that will be stretched or
///                crushed needs less, and 0.7 is enough for anything on a lattice without dampers.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT; MSPRING_ERROR_UNSTABLE if MSPRING_MAX_SUBSTEPS are too few;
///         MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates yes, and frees it   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_network_suggest_substeps(mspring_network *network, double dt,
                                                                              double safety, uint32_t *substeps);

/* ---------------------------------------------------------------------------------------- static equilibrium */

/// Flags of mspring_settle_def.
enum {
    MSPRING_SETTLE_LEAVE_FLOATING = 1u << 0 ///< leave parts that have no equilibrium alone, instead of failing
};

/// How an equilibrium is sought. Fill with mspring_settle_def_init() first.
typedef struct mspring_settle_def {
    uint32_t struct_size;
    uint32_t flags;          ///< MSPRING_SETTLE_LEAVE_FLOATING or 0; default 0
    uint32_t max_iterations; ///< 1 to 1000000; default 1000
    uint32_t reserved;       ///< 0
    double tolerance; ///< force (N) that may be left on a particle, as a part of the largest that any spring or
                      ///< anything outside exerts; 1e-15 to 1; default 1e-9. Where rounding does not allow that,
                      ///< what it allows.
    double relative_substep; ///< substep (s) that the stiffness of relative springs follows; default 0: the one of
                             ///< the last step, before which they have none
} mspring_settle_def;

/// What was found. Set struct_size first.
typedef struct mspring_settle_result {
    uint32_t struct_size;
    uint32_t iterations;  ///< steps of Newton's method
    double residual;      ///< N, largest force in x or y left on a particle, before positions are rounded to float;
                          ///< that leaves about stiffness times the last place of a coordinate
    double largest_force; ///< N, largest force that a spring or, in x or y, anything outside exerts
    double displacement;  ///< m, farthest that a particle was moved
    uint32_t is_stable;   ///< 1: every small push would be answered by a force back, or by none
    uint32_t left_alone;  ///< particles of floating parts that were left where they are
} mspring_settle_result;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @since 0.1
MSPRING_API mspring_result mspring_settle_def_init(mspring_settle_def *def, size_t size);

/// Move the particles to where they rest: static equilibrium under gravity, springs and the forces given for the
/// next step. Pinned particles stay where they are, hooks are not called, dampers do not matter.
///
/// The energy is minimised in double precision by Newton's method with a sparse direct solver (cholesky), from
/// where the particles are now. Every iteration goes downhill, also from starts that are crushed, folded or all in
/// one place. There may be several equilibria, tangled ones among them; the one found depends on the start. One
/// that is not stable, such as a pendulum upside down, is left by a small push. Memory and time grow with the size
/// as those of a factorisation do: for n particles of a lattice about n log n numbers and n^1.5 operations an
/// iteration. A bar of 80 x 5 takes four of them. Ropes that fall slack and thin masts that bend far take many, as
/// no step may turn their springs by much: the sample ship's rigging comes down by 45 m in 178 iterations. So do bars
/// so soft that they hang down from their clamp. These have many equilibria that differ in which cells near the clamp
/// are folded. The energy of the one found may be above the lowest by a tenth of what the fall sets free. If that
/// matters, step with global damping until the network is nearly at rest, and settle then: inertia carries it past
/// them.
///
/// Then velocities are zero (those of pinned particles stay), and forces given for the next step are still there.
/// Parts without pinned particle have an equilibrium only if the forces on them cancel, as without gravity; others
/// are an error, unless MSPRING_SETTLE_LEAVE_FLOATING leaves them as they are.
/// @param def     NULL for the defaults
/// @param result  may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_EQUILIBRIUM if there is none, it is out of bounds, or max_iterations do not
///         lead to it (the message names a particle, and the force on it); MSPRING_ERROR_LIMIT if the factor would
///         have over 2^31 numbers; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_STRUCT, MSPRING_ERROR_MEMORY,
///         MSPRING_ERROR_BUSY. On error nothing has moved.
/// @threads exclusive access to network   @allocates yes, and frees it   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_network_settle(mspring_network *network,
                                                                    const mspring_settle_def *def,
                                                                    mspring_settle_result *result);

/* ------------------------------------------------------------------------------------------ tuning: the trade */

/// Which error settings are compared by.
typedef int32_t mspring_tune_measure;
enum {
    MSPRING_TUNE_BY_TRAJECTORY = 0, ///< mspring_tune_row.trajectory_share
    MSPRING_TUNE_BY_REST = 1,       ///< mspring_tune_row.rest_share
    MSPRING_TUNE_BY_BENDING = 2, ///< mspring_tune_row.bending, m: for networks with relative springs, which are as
                                 ///< firm as their substeps allow
    MSPRING_TUNE_BY_SCENE = 3    ///< mspring_tune_row.scene_distance: for networks that break; needs a scene
};

/// Flags of mspring_tune_def.
enum {
    MSPRING_TUNE_NOTHING_ELSE = 1u << 0 ///< measure the costs and what measure asks for, and no other error
};

/// Told how far a long run has come, 0 to 1, between steps. Returns 1 to go on, 0 to stop: what has been measured
/// so far is the result then.
typedef uint32_t (*mspring_progress_fn)(double done, void *user);

/// Seconds since some moment, never going back.
typedef double (*mspring_clock_fn)(void *user);

/// Flags of mspring_tune_scene.
enum {
    MSPRING_TUNE_SCENE_FLOOR = 1u << 0,    ///< the network's floor is there
    MSPRING_TUNE_SCENE_BREAKING = 1u << 1, ///< springs break at their break strains
    MSPRING_TUNE_SCENE_HOOKS = 1u << 2     ///< the network's hooks are called, with their user pointers and storage
};

/// Called for each run of a scene before its first step. It may do to the run what the host does to the network:
/// add hooks, give forces or velocities, break springs, reset what its hooks keep. It must not step or destroy the
/// run, and leave the network that is tuned alone.
/// @param run    a clone of the network, destroyed after the run
/// @param start  0 ... start_count - 1. The same start of all settings and of the fine run should be the same.
/// @param user   mspring_tune_def.user
/// @return MSPRING_OK; mspring_network_tune() fails with anything else
typedef mspring_result (*mspring_tune_prepare_fn)(mspring_network *run, uint32_t start, void *user);

/// A scene that settings are tried in: what the network does beside swinging. Fill with mspring_tune_scene_init()
/// first.
typedef struct mspring_tune_scene {
    uint32_t struct_size;
    uint32_t flags;       ///< default MSPRING_TUNE_SCENE_FLOOR | MSPRING_TUNE_SCENE_BREAKING
    uint32_t start_count; ///< runs of each setting, which start a little different; 4 to 64; default 16
    uint32_t reserved;    ///< 0
    double duration;      ///< simulated time of a run, s; > 0, up to 100000 steps, rounded up to whole ones; default 1
    double kick; ///< m/s, > 0: in all starts but the first the velocities of particles that are not pinned differ
                 ///< by up to this in x and y, each by another amount; default 0.1. If it is so small that all
                 ///< runs break in the same way, the spread tells nothing.
    double tolerance;    ///< share of a mean that makes no difference; >= 0; default 0.05
    double max_distance; ///< with MSPRING_TUNE_BY_SCENE, in place of mspring_tune_def.max_error; > 0; default 1
    mspring_tune_prepare_fn prepare; ///< default NULL
} mspring_tune_scene;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @since 0.1
MSPRING_API mspring_result mspring_tune_scene_init(mspring_tune_scene *scene, size_t size);

/// What is to be tried, and what is wanted. Fill with mspring_tune_def_init() first.
typedef struct mspring_tune_def {
    uint32_t struct_size;
    uint32_t setting_count;             ///< at most 1000
    const mspring_solver_def *settings; ///< [setting_count]; default NULL: those of mspring_tune_settings()
    double dt;                          ///< length of a step, s, as in mspring_network_step(); default 1/64
    double duration; ///< simulated time that trajectories are compared for, s, up to 100000 steps; rounded up to
                     ///< whole steps, at least four. Default 0: one period of the slowest swing in the motion, at
                     ///< least 16 and at most 1024 steps, fewer if the budget is small: mspring_tune_row.duration
    double budget;   ///< s that the call may take, by the clock; default 10. It is looked at between steps, and
                     ///< between iterations of the search for an equilibrium.
    mspring_tune_measure measure; ///< default MSPRING_TUNE_BY_TRAJECTORY
    uint32_t flags;               ///< MSPRING_TUNE_NOTHING_ELSE or 0; default 0
    double max_error;       ///< a row with more is not recommended; > 0; default 0.01. INFINITY: none is too much
    double max_cost;        ///< likewise, s for a step; > 0; default INFINITY
    mspring_clock_fn clock; ///< default NULL: the system's. A build without one (MASSSPRING_FREESTANDING) needs it.
    mspring_progress_fn progress; ///< default NULL
    void *user;                   ///< handed to both, and to the scene's prepare
    double max_drift; ///< a row whose energy_drift is measured and larger is not recommended; >= 0; default 0.1
    const mspring_tune_scene *scene; ///< default NULL: none
} mspring_tune_def;

/// Flags of mspring_tune_row.
enum {
    MSPRING_TUNE_HAS_COST = 1u << 0,
    MSPRING_TUNE_HAS_TRAJECTORY = 1u << 1, ///< trajectory_error, trajectory_share and energy_drift are measured
    MSPRING_TUNE_HAS_REST = 1u << 2,       ///< bending, rest_error and rest_share are measured
    MSPRING_TUNE_REFUSED = 1u << 3, ///< a step was refused as unstable, or the solver cannot have this network
    MSPRING_TUNE_PARETO = 1u << 4,  ///< no other row has both less cost and less error
    MSPRING_TUNE_RECOMMENDED = 1u << 5,
    MSPRING_TUNE_HAS_SCENE = 1u << 6 ///< the numbers of the scene are measured, from at least four starts
};

/// What is counted at the end of each run of a scene.
enum {
    MSPRING_TUNE_BROKEN = 0, ///< springs that broke in the run, less those that were restored
    MSPRING_TUNE_ENERGY = 1, ///< kinetic and elastic energy, J
    MSPRING_TUNE_EXTENT = 2  ///< larger side of the box around all particles, m
};
#define MSPRING_TUNE_QUANTITIES 3

/// A setting, and what came of it. Numbers that are not measured are 0. Set struct_size first.
typedef struct mspring_tune_row {
    uint32_t struct_size;
    uint32_t flags;
    uint32_t setting;      ///< its index in the list of settings
    mspring_solver solver; ///< this and what follows: as in mspring_solver_def, by mspring_tune_row_solver()
    mspring_integrator integrator;
    uint32_t substeps; ///< that a step took
    uint32_t iterations, tile_size, coarse_period;
    uint32_t step_count;          ///< steps whose time was taken
    double min_cost, median_cost; ///< s for a step
    double trajectory_error; ///< m, root of the mean square over the particles that are not pinned and over four
                             ///< moments, from where a fine run has them
    double trajectory_share; ///< the same as a share of the largest root mean square distance from the start that
                             ///< they have after any step of the fine run
    double energy_drift;     ///< energy at the end beyond that of the fine run, as a share of the largest sum of
                             ///< kinetic and elastic energy that the fine run had at those moments
    double bending;          ///< m, farthest that a particle is from here when the network is at rest
    double rest_error;       ///< m, farthest that the mean position of a particle, over the steps from rest on, is
                             ///< from its place at rest
    double rest_share;       ///< the same as a share of bending
    double duration;         ///< s, simulated time that the trajectory was compared for
    double moving_cost;      ///< s for a step, median of those from the state given on, and
    double resting_cost;     ///< of those from rest on: implicit and direct solver may take less there
    uint32_t scene_starts;   ///< starts that were compared
    uint32_t fine_substeps;  ///< explicit substeps that a step of the fine run took
    double scene_cost;       ///< s for a step: median over the starts of the mean over the steps
    double scene_distance;   ///< difference of scene_mean and fine_mean, in spreads; of the quantity with the largest
    double scene_mean[MSPRING_TUNE_QUANTITIES];   ///< over the starts, of MSPRING_TUNE_BROKEN and so on
    double scene_spread[MSPRING_TUNE_QUANTITIES]; ///< standard deviations
    double fine_mean[MSPRING_TUNE_QUANTITIES];    ///< the same of the fine runs from the same starts
    double fine_spread[MSPRING_TUNE_QUANTITIES];
} mspring_tune_row;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @since 0.1
MSPRING_API mspring_result mspring_tune_def_init(mspring_tune_def *def, size_t size);

/// The settings that are tried where none are given: explicit with some numbers of substeps from the least that is
/// stable on (none above 1000), implicit with BDF2 and 4, 8 and 15 iterations in one, two and four substeps, and with
/// GA0 and 8 iterations in the same. Up to 20000 particles also direct with both in one and two substeps.
/// @param dt        seconds, finite, > 0
/// @param settings  [capacity]; may be NULL with capacity 0, to ask how many there are
/// @param count     receives how many there are, also if that is more than capacity
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, also for too little capacity unless that is 0; MSPRING_ERROR_MEMORY,
///         MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates yes, and frees it   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_tune_settings(mspring_network *network, double dt,
                                                                   mspring_solver_def *settings, uint32_t capacity,
                                                                   uint32_t *count);

/// Measure what speed costs in accuracy: run settings of the solver on clones of this network, on this machine,
/// from the state it has now, and say what a step takes and how good it is.
///
///   cost        of every step taken with a setting, by the clock, with the workers that the network has
///   trajectory  against a run in double precision with fine substeps (symplectic, of second order). Shares are
///               of at least a millionth of the network's size.
///   rest        where the network comes to rest (mspring_network_settle()), and how it stays there when the
///               setting goes on from it. Not for networks without an equilibrium.
///   scene       what a def's scene switches on, from starts that differ a little: see below
///
/// Have the network in a state as it is to be simulated: just made and falling, or moving. Outside of a scene hooks
/// are not called, there is no floor, ramps stand still and nothing breaks by strain. The network does not sleep, no
/// solver stands in for another (MSPRING_GUARD_IMPLICIT), and nothing is clamped. Forces given for the next step act
/// in the first one.
/// Relative springs follow the substep: each row is compared with a fine run, and an equilibrium, that have the
/// stiffness of its own substeps, and bending says how firm that is.
///
/// Once springs break, no two runs keep together: the smallest difference leads elsewhere. So a scene compares what
/// many runs have in common. It runs each setting from start_count starts, and an explicit fine run from the same. A
/// fine substep is at most a third of the one that is stable in any shape, and half of any explicit setting's.
/// Three quantities are taken at the end of each run. A row's distance is the difference of its mean from the fine
/// runs', in units. A unit is the standard deviation of the fine runs. It is at least the tolerance's share of their
/// mean, and one spring. The largest distance of the three counts. By chance alone two samples of 16 starts differ by
/// 0.35 (standard deviation), of 64 by 0.18.
/// If the budget is small there are fewer starts, with at most one more for rows that come first. If the fine run is
/// rejected, no row has the scene's numbers. A network with relative springs cannot have a scene: they would follow
/// the fine run's substeps.
///
/// Recommended is, if max_error is finite, the row of the least median cost among those within all bounds; else,
/// of those within max_cost and max_drift, the one of the least error; of equal ones the first. There may be none.
/// MSPRING_TUNE_BY_SCENE judges by scene_cost in place of the median cost, and by max_distance.
/// When the budget is used up, what is not measured is not flagged as measured: first the costs of all are taken, then
/// what measure asks for, then the rest. For the same duration and number of starts all but the costs is the same
/// whenever it is measured, and on any machine.
/// @param def       NULL for the defaults
/// @param rows      [capacity], struct_size set in each; one for each setting, in their order
/// @param capacity  at least as many as there are settings
/// @param count     receives how many there are
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT (the message says what, or names the setting), MSPRING_ERROR_STRUCT,
///         MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY; what the scene's prepare returns. On error nothing is written,
///         and the network is as it was.
/// @threads exclusive access to network; prepare is called on the calling thread   @allocates yes, and frees it
/// @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_network_tune(mspring_network *network,
                                                                  const mspring_tune_def *def,
                                                                  mspring_tune_row *rows, uint32_t capacity,
                                                                  uint32_t *count);

/// The setting of a row, to be given to mspring_network_set_solver(): with as many substeps as its steps took.
/// @param solver  struct_size need not be set
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL, MSPRING_ERROR_STRUCT.
/// @threads any   @allocates never   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_tune_row_solver(const mspring_tune_row *row,
                                                                     mspring_solver_def *solver);

/* ------------------------------------------------------------------------------------------- plan and memory */

/// How the network was laid out. A particle belongs to one of four kinds of row: a lattice row (8 neighbours on a
/// grid, which may lie at any angle, be oblong or slanted, and bend), a chain (single strands), the web (any other
/// graph, and ropes that hang on a lattice) or a loose row (no springs). A spring between neighbours in lattice and
/// chain rows is swept with them, without any index; the others, leftover springs, are the web's, and cost more.
///
/// Lattices of at most 64 by 64 particles share rows, side by side, whose blocks one alone would leave half empty.
///
/// Lattice rows are swept in strips of some rows, several substeps in one pass, so that a network larger than the
/// cache is read once for all of them. What hangs on a lattice is swept with its strips, unless it joins strips
/// more than 16 apart, or has more strand particles than the lattice has particles: then that lattice takes one
/// substep at a time. A web of 60,000 particles and more that hangs on no lattice is swept in layers to the same
/// end, with the ropes that hang on it.
typedef struct mspring_plan {
    uint32_t struct_size;
    uint32_t particle_count, spring_count;
    uint32_t lattice_count; ///< grids found
    uint32_t lattice_particles, lattice_springs;
    uint32_t lattice_rows;   ///< rows of the grids
    uint32_t lattice_blocks; ///< blocks of block_width columns in those rows
    uint32_t chain_count;    ///< strands found
    uint32_t chain_particles, chain_springs;
    uint32_t web_particles;    ///< particles of the web: those with springs, but none in a lattice or chain row
    uint32_t loose_particles;  ///< particles without a spring
    uint32_t leftover_springs; ///< springs of the web; they take least memory where particles that are near each
                               ///< other have about as many springs
    uint32_t pass_rows;        ///< lattice rows that are swept for several substeps in one pass
    uint32_t pass_lag;         ///< strips by which each substep of a pass stays behind the one before: 1, or what
                               ///< the ropes need that hang on those rows
    uint32_t pass_substeps;    ///< most substeps in one pass, by cache size, row length and lag
    uint32_t slot_count;       ///< slots of the state, empty ones among them
    uint32_t block_width;      ///< slots in a block
    uint32_t has_damping;    ///< 1: some spring has damping, or room for it was reserved. 0: steps neither read nor
                             ///< compute any.
    uint32_t has_relative;   ///< 1: some spring is relative, and a change of substep costs a pass over all
    mspring_simd simd_level; ///< what runs
    mspring_solver solver;
    mspring_integrator integrator; ///< of the implicit or direct solver; this and what follows are 0 for others
    uint32_t iterations;           ///< this and the next four: of the implicit solver
    uint32_t tile_size;            ///< rows and columns of the cells of wide lattices
    uint32_t tile_count;           ///< tiles, each of three unknowns in the coarse matrix
    uint32_t coarse_values;        ///< numbers in that matrix's factor
    uint32_t coarse_period;
    uint64_t factor_values; ///< of the direct solver: numbers in its factor, which is there in both precisions,
    double factor_products; ///< and products that computing it takes
    uint32_t web_layers; ///< layers in which the web without a lattice is swept for several substeps in one pass,
                         ///< whatever the solver; 0 if it takes one substep at a time
} mspring_plan;

/// Get the plan. Set struct_size first.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT or MSPRING_ERROR_STRUCT.
/// @threads shared   @allocates never   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_network_plan(const mspring_network *network,
                                                                  mspring_plan *plan);

/// Bytes that the network has taken from its allocator. NULL gives 0.
/// @threads shared   @allocates never   @since 0.1
MSPRING_API size_t mspring_network_memory_used(const mspring_network *network);

/* ------------------------------------------------------------------------------------------- compaction jobs */

/// Another plan for a network, which is made while the network goes on: compaction, or the way back, off the frame.
///
///   mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job);     // in a frame: copies what the plan follows from
///   mspring_job_run(job, 0, NULL);                                // on any thread, or some calls a frame
///   if (mspring_job_finish(network, job) == MSPRING_OK) ...       // in a later frame: the network moves
///   mspring_job_destroy(job);
///
/// Between begin and finish the network may be stepped, edited, saved, loaded and cloned. Nothing is to be seen of
/// the job until it is finished; snapshots and clones know nothing of it. Springs that are set or broken meanwhile
/// are followed: the finish copies them again. Where all are set, as by loading a snapshot or by the first step with
/// another substep if all are relative, it takes about as long as the copying of all.
///
/// The plan follows from the springs that are live at begin. So the bits of the network depend on the steps at which
/// the job is begun and finished, and on nothing else: not on who runs it, nor when, nor in how many calls.
///
/// A network has one job at a time. A job owns all that it reads: networks and jobs may be destroyed in any order.
/// It uses the network's allocator, which must allow calls from two threads at once if another thread runs the job.
typedef struct mspring_job mspring_job;

/// What a job makes.
typedef int32_t mspring_layout;
enum {
    MSPRING_LAYOUT_COMPACT = 0, ///< as mspring_network_compact()
    MSPRING_LAYOUT_WHOLE = 1    ///< as mspring_network_expand(), so that springs can be restored without a long frame
};

/// Begin a job: copy what springs are and where they lie. About as long as cloning.
/// @return MSPRING_OK; MSPRING_ERROR_BUSY inside a hook, or if the network has a job that is neither finished nor
///         destroyed; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_MEMORY.
/// @threads exclusive access to network   @allocates yes   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_job_begin(mspring_network *network, mspring_layout layout,
                                                               mspring_job **job);

/// Go on with a job. It is a list of plain functions. For a network of 200,000 springs the longest take one to two
/// milliseconds, seven where 10,000 springs were added all over it (bench/RESULTS.md); but the last makes the
/// implicit or direct solver, if the network has one, in one go.
/// @param at_most  how many functions to call; 0 for all
/// @param left     receives about how much is left, from call to call the same or less; 0: it can be finished. May be
///                 NULL.
/// @return MSPRING_OK; MSPRING_ERROR_MEMORY or MSPRING_ERROR_LIMIT, after which the job can only be destroyed;
///         MSPRING_ERROR_ARGUMENT for NULL, or for a job that has failed or is finished.
/// @threads exclusive access to job; no access to any network   @allocates yes   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_job_run(mspring_job *job, uint32_t at_most, uint32_t *left);

/// Move the network to the plan that a job has made. Slots change, views end. Afterwards the job can only be
/// destroyed, whatever is returned, unless that is MSPRING_ERROR_BUSY or MSPRING_ERROR_ARGUMENT.
/// @return MSPRING_OK, also if there was nothing to do; MSPRING_ERROR_OUTDATED if since begin particles or springs
///         were added or removed, a spring was restored that the plan leaves out, or the plan has changed
///         otherwise: begin another job; MSPRING_ERROR_BUSY inside a hook, or if the job has not been run to its
///         end; MSPRING_ERROR_MEMORY; MSPRING_ERROR_LIMIT; MSPRING_ERROR_ARGUMENT for NULL, for a job that
///         is finished, or for one of another network. If a run failed, its error is returned again. On error the
///         network is as it was.
/// @threads exclusive access to network and job   @allocates some   @since 0.1
MSPRING_NODISCARD MSPRING_API mspring_result mspring_job_finish(mspring_network *network, mspring_job *job);

/// What went wrong in the first mspring_job_run() that failed: text of the job's, "" if none did or for NULL.
/// @threads shared with other reads of the job   @allocates never   @since 0.1
MSPRING_API const char *mspring_job_error(const mspring_job *job);

/// Free a job, finished or not. NULL is allowed.
/// @threads exclusive access to job and, unless it is finished, to its network   @allocates never   @since 0.1
MSPRING_API void mspring_job_destroy(mspring_job *job);

#ifdef __cplusplus
}
#endif

#endif
