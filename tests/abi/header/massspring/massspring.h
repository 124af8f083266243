/// @file massspring.h
/// libmassspring simulates two-dimensional networks of masses, springs and dampers.
///
/// A network is a set of particles with mass, joined by springs with stiffness and damping. You describe it to a
/// builder, create a network from the builder, step it by dt, and read it through views and measurements.
///
///     builder --create--> network (topology + state) --step--> views, measurements, events, snapshots
///
/// **The 15 functions you need**
///
///     mspring_builder_create           begin a description
///     mspring_builder_add_particle     add a mass
///     mspring_builder_add_spring       join two masses
///     mspring_builder_add_lattice      add a grid of cells, as an image gives it
///     mspring_builder_destroy          free the description
///     mspring_network_def_init         fill a network's definition with defaults
///     mspring_network_create           make a network
///     mspring_network_step             evolve it by dt
///     mspring_network_get_positions    read where particles are
///     mspring_network_apply_force      push a particle during the next step
///     mspring_network_break_springs    break springs
///     mspring_network_set_floor        give it ground and walls
///     mspring_network_read_events      learn what broke
///     mspring_network_error            learn what was wrong with a call
///     mspring_network_destroy          free the network
///
/// **All functions by topic.** Names lack mspring_ here; network_x stands for mspring_network_x.
///
///     library     version, version_string, features, result_string
///     builder     builder_create, _destroy, _error, _particle_count, _spring_count, _add_particle(s), _add_spring(s),
///                 _add_lattice, _get_particles, _get_springs; archives: _read, _get_network_def
///     defaults    particle_def_init, spring_def_init, material_init, lattice_def_init, solver_def_init,
///                 network_def_init, settings_init, floor_def_init, allocator_init, tasks_init
///     network     network_create, _destroy, _error, _particle_count, _spring_count
///     settings    network_set_settings, _get_settings, _set_solver, _get_solver
///     step        network_step, _get_step_info, _step_flags; sleep: _is_asleep, _wake
///     forces      network_apply_force, _apply_forces(_at), _apply_impulses(_at), _apply_torque
///     floor       network_set_floor, _get_floor, _get_floor_impulses
///     state       network_view, _get_positions(_float)(_at), _get_velocities(_at), _set_positions(_float)(_at),
///                 _set_velocities(_at), _state_hash
///     properties  network_set(_at), _get(_at), _get_ends, _get_spring_flags, _max_strain
///     edits       network_break_springs, _restore_springs, _detach_particles, _add_particles, _add_springs,
///                 _remove_particles, _remove_springs, _recycle, _has_particle, _has_spring
///     events      network_reserve_events, _read_events; components: _update_components, _get_component_numbers,
///                 _get_components
///     measure     network_energy, _momentum, _bounds, _get_body
///     snapshots   network_snapshot_size, _save, _load
///     archives    network_write, builder_read, _get_network_def
///
/// massspring_contact.h: contact, colliders, grips; massspring_laws.h: yielding, areas, angles; massspring_batch.h:
/// groups; massspring_gradient.h: derivatives of runs; massspring_tools.h: the rest, as ropes, meshes, clones, hooks,
/// queries, stability, equilibrium, tuning.
///
/// **Words.** A slot is an index into the arrays of a view; an id is another number. A hook is a function of yours that
/// steps call. A component is all particles that unbroken springs connect, or a lone one. The plan is how a network
/// lies in memory.
///
/// **Units** are SI: metres, kilograms, seconds, newtons, N/m, N s/m. The y axis points up.
///
/// **Physics.** The explicit solver is leapfrog in substeps of length h. For a spring between the particles a and b:
///
///     d = p_b - p_a;  L = |d|;  u = d / L
///     f = (L - rest_length) * stiffness + ((v_b - v_a) . u) * damping
///     F_a += f u;  F_b -= f u
///     v(t+h/2) = v exp(-b k) + (F / m + gravity) (1 - exp(-b k)) / b;   p(t+h) = p + v(t+h/2) h
///
/// with b = global_damping; where that is 0, gravity and forces act for k. Velocities given at creation are of now;
/// those that you read or set later are half a substep old. So k = (h_previous + h) / 2, with the last explicit substep
/// before, 0 at creation. For springs k is at most what is stable in any shape, if an edit has made that less; where
/// springs are relative, k = h if h changes; with groups k = h. A spring of length 0 has no direction and exerts no
/// force. A pinned particle feels no force: it keeps the velocity that the host gives it, at first zero, and moves by
/// it. With damping, a speed below 1e-30 m/s becomes 0.
///
/// **Precision.** Positions and velocities are single precision, relative to a local origin in double precision. The
/// library moves the origin with the network. A network 10 km from the world's origin behaves as it does there. Each
/// position has a second, smaller word, so no substep rounds away what it adds. Views show the first word only.
///
/// **Many small bodies.** Put them in one network: it sweeps them side by side, several times faster than a network for
/// each. They share one local origin, solver and dt and, unless they are groups (massspring_batch.h), rejected steps.
///
/// **Same bits.** The same calls give the same state, bit for bit. SIMD level, number of workers, compiler and
/// optimisation level make no difference. This holds within one minor version (0.2.x). Compare by
/// mspring_network_state_hash().
///
/// **Errors.** If a function can fail, it returns a mspring_result. A failed call changes nothing and leaves
/// out-parameters alone. It sets the error message of its object, which names the fault and the place: see
/// mspring_network_error(). No function prints, exits or aborts. The library cannot detect one mistake: a handle that
/// was destroyed. "@errors" lists the results other than MSPRING_OK, without the prefix MSPRING_ERROR_. ARGUMENT is
/// always a NULL that is not allowed, or a value outside its range, such as NaN.
///
/// **Threads.** The library has no global state. "any": no rule. "shared": several threads may make such calls on one
/// object at once. "exclusive": no other call on that object may overlap. Calls on different objects may always
/// overlap. With workers (mspring_network_def), the library divides a step among threads itself. After fork() the
/// child may use its copies: its first step starts the workers again.
///
/// **Memory.** "@allocates" says when a function allocates. A step never does.
///
/// **ABI.** Handles are opaque, and no struct is passed by value. Ids, counts, capacities and strides are uint32_t,
/// sizes in bytes size_t, enums signed integers of 32 bits. All public structs but mspring_event begin with
/// struct_size. If you fill a struct, call its init function first, which sets the defaults. If the library fills it,
/// set struct_size. Reserved fields must be 0. Structs may grow at the end. Older programs keep working: a field that
/// yours lacks has its default, and reports end where your struct does. So do newer ones, if they leave what this
/// version does not know at 0; reports have 0 there. Ignore flags, results and kinds of event that you do not know: a
/// result below 0 is an error.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_H
#define MASSSPRING_MASSSPRING_H

#include <stddef.h>
#include <stdint.h>

#include "export.h"
#include "version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------------- library */

/// Return the version of the library that runs, in the form of MSPRING_VERSION.
/// @threads any   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_version(void);

/// Return that version as text, such as "0.2.0". Static storage.
/// @threads any   @allocates never
MSPRING_API const char *MSPRING_CALL mspring_version_string(void);

/// Features that a build of the library may have.
enum {
    MSPRING_FEATURE_THREADS = 1u << 0,  ///< networks may have several workers; otherwise they have one
    MSPRING_FEATURE_HOSTED = 1u << 1,   ///< there is a default allocator; the variable MSPRING_SIMD is read
    MSPRING_FEATURE_SHARED = 1u << 2,   ///< this is the shared library
    MSPRING_FEATURE_IMPLICIT = 1u << 3, ///< there are MSPRING_SOLVER_IMPLICIT and MSPRING_GUARD_IMPLICIT
    MSPRING_FEATURE_DIRECT = 1u << 4,   ///< there is MSPRING_SOLVER_DIRECT
    MSPRING_FEATURE_FLOOR = 1u << 5,    ///< there are floors
    MSPRING_FEATURE_CONTACT = 1u << 6,  ///< there are contact, colliders and grips
    MSPRING_FEATURE_LAWS = 1u << 7,     ///< there are yielding and one-way springs, areas and angles
    MSPRING_FEATURE_BATCH = 1u << 8,    ///< there are the functions of massspring_batch.h
    MSPRING_FEATURE_LAB = 1u << 9       ///< there are settling, tuning, jobs, strain limits and plans
};

/// Return the features of the library that runs: bits of MSPRING_FEATURE_.
/// @threads any   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_features(void);

/// Result of a call: MSPRING_OK or one of the negative errors below.
typedef enum mspring_result {
    MSPRING_OK = 0,
    MSPRING_ERROR_ARGUMENT = -1,          ///< NULL, NaN, infinite, or outside the range that the function states
    MSPRING_ERROR_ID = -2,                ///< no such particle, spring, component, hook, collider or grip
    MSPRING_ERROR_MEMORY = -3,            ///< the allocator returned NULL
    MSPRING_ERROR_LIMIT = -4,             ///< more particles, springs, cells, pairs, points or grips than fit
    MSPRING_ERROR_STRUCT = -5,            ///< struct_size is impossible, or what this version does not know is not 0
    MSPRING_ERROR_DUPLICATE = -6,         ///< two springs join the same two particles, see massspring_laws.h
    MSPRING_ERROR_UNSTABLE = -7,          ///< the step was unstable and has been rolled back
    MSPRING_ERROR_BUSY = -8,              ///< called inside a hook; a second job; or a job that is not ready
    MSPRING_ERROR_THREAD = -9,            ///< the system gave no thread or no lock
    MSPRING_ERROR_EQUILIBRIUM = -10,      ///< the forces have no equilibrium, or none was found
    MSPRING_ERROR_SNAPSHOT = -11,         ///< no snapshot of this network, or a damaged one
    MSPRING_ERROR_OUTDATED = -12,         ///< the network has changed since the job began
    MSPRING_RESULT_INT = MSPRING_ENUM_INT ///< no value
} mspring_result;

/// Return a short English name of a result, such as "out of memory". Never NULL; static storage.
/// @threads any   @allocates never
MSPRING_API const char *MSPRING_CALL mspring_result_string(mspring_result result);

/// Id of a particle or a spring: 0, 1, 2 ... in the order in which they were added. It never changes. After
/// mspring_network_recycle(), added ones may get ids of removed ones. Hooks, colliders and grips have ids of their own,
/// which a network never gives twice.
typedef uint32_t mspring_id;

/// No particle, no spring.
#define MSPRING_NONE 0xffffffffu
/// Most particles and most springs in one network.
#define MSPRING_MAX_PARTICLES 0x4000000u
#define MSPRING_MAX_SPRINGS 0x10000000u

/// Largest size (m) of a world coordinate that you give, and of a coordinate relative to the local origin.
#define MSPRING_MAX_COORDINATE 1e12
/// Largest speed in x or y that you can give to a particle, m/s.
#define MSPRING_MAX_SPEED 1e15

/* ----------------------------------------------------------------------------------------- allocator and workers */

/// Allocator of an object. Fill with mspring_allocator_init() first, then set alloc and free. The struct is copied.
/// The library calls alloc and free only inside calls that say that they allocate, and inside destroy functions.
typedef struct mspring_allocator {
    uint32_t struct_size;
    uint32_t reserved; ///< 0
    /// Returns at least size bytes, aligned to alignment (a power of two, at most 64), or NULL.
    void *(MSPRING_CALL *alloc)(size_t size, size_t alignment, void *user);
    void(MSPRING_CALL *free)(void *memory, size_t size, void *user); ///< gets the size that alloc was asked for
    void *user;                                                      ///< passed to both; default NULL
} mspring_allocator;

/// Most workers of one network.
#define MSPRING_MAX_WORKERS 256u

/// A piece of work of the library. The host calls it as fn(argument, index, worker).
typedef void(MSPRING_CALL *mspring_task_fn)(void *argument, uint32_t index, uint32_t worker);

/// Threads of the host, lent to a network. Fill with mspring_tasks_init() first. The struct is copied.
///
/// run calls fn(argument, index, worker) once for each index below count, on any threads, and returns when all these
/// calls have returned. Like any thread pool, it makes writes visible between the caller and fn. It keeps two
/// promises:
///
///   - worker is below worker_count. Two calls that run at the same time have different workers.
///   - If count is at most concurrent_count, all calls run at the same time, and the library may let them wait for
///     each other. If count is larger, they may run in any order, even one after the other.
///
/// If the host cannot promise the second, set concurrent_count to 1. No call waits for another one then. An explicit
/// step calls run twice for every few substeps; implicit and direct steps use one thread. The library calls run only
/// inside calls with exclusive access, never from two threads at once and never from inside fn.
typedef struct mspring_tasks {
    uint32_t struct_size;
    uint32_t worker_count;     ///< 1 to MSPRING_MAX_WORKERS; 1, the default: run is not called
    uint32_t concurrent_count; ///< 1 to worker_count; default 1
    uint32_t reserved;         ///< 0
    void(MSPRING_CALL *run)(uint32_t count, mspring_task_fn fn, void *argument, void *user); ///< must be set
    void *user; ///< passed to run; default NULL
} mspring_tasks;

/* ----------------------------------------------------------------------------------------- particles and springs */

/// Flags of particles.
enum {
    MSPRING_PARTICLE_PINNED = 1u << 0 ///< feels no force
};

/// Flags of springs. The last three can only be read.
enum {
    /// stiffness and damping are fractions of what an explicit substep of length h allows:
    ///     k = stiffness * mu / h^2,   c = damping * mu / h,   mu = m_a m_b / (m_a + m_b)
    /// Such a network is as stiff as its step allows. A lattice of equal springs and masses is stable below 1.
    MSPRING_SPRING_RELATIVE = 1u << 0,
    /// damping is a ratio of critical damping, 0 to 1000. With 1 the spring's ends come to rest without swinging.
    ///     c = 2 damping sqrt(stiffness * mu)
    /// In definitions only: the library computes c once, at most 1e30, and forgets the ratio. A pinned particle
    /// counts with its mass. If the spring is relative, c is a fraction and follows the substep.
    MSPRING_SPRING_DAMPING_RATIO = 1u << 1,
    MSPRING_SPRING_BROKEN = 1u << 8,   ///< broken
    MSPRING_SPRING_STRESSED = 1u << 9, ///< over its stress strain (MSPRING_STRESS_STRAIN)
    MSPRING_SPRING_REMOVED = 1u << 10  ///< removed: in ranges only, together with MSPRING_SPRING_BROKEN
};

/// One particle. Fill with mspring_particle_def_init() first.
typedef struct mspring_particle_def {
    uint32_t struct_size;
    uint32_t flags;    ///< MSPRING_PARTICLE_PINNED or 0; default 0
    double x, y;       ///< world position, m, at most MSPRING_MAX_COORDINATE in size; default 0
    float vx, vy;      ///< velocity of now, m/s, within MSPRING_MAX_SPEED; default 0
    float mass;        ///< kg, 1e-30 to 1e30; default 1
    uint32_t reserved; ///< 0
} mspring_particle_def;

/// Break or stress strain for "never": the largest float. INFINITY means the same, and reads back as this. Use it in
/// programs compiled with -ffinite-math-only.
#define MSPRING_NEVER 3.40282346638528859812e+38f

/// Relax strain for "relax_fraction (mspring_settings) of the stress strain".
#define MSPRING_RELAX_STRAIN_DEFAULT (-1.0f)

/// rest_length for "the distance at which the two particles are added".
#define MSPRING_REST_LENGTH_DISTANCE (-1.0f)

/// One spring. Fill with mspring_spring_def_init() first.
typedef struct mspring_spring_def {
    uint32_t struct_size;
    uint32_t flags;      ///< MSPRING_SPRING_RELATIVE, MSPRING_SPRING_DAMPING_RATIO; default 0
    mspring_id a, b;     ///< the particles that it joins, not the same; default MSPRING_NONE: set both
    float stiffness;     ///< N/m, or a fraction if relative, 0 to 1e30; default 0
    float damping;       ///< N s/m or a fraction, 0 to 1e30, or a ratio, 0 to 1000; default 0
    float rest_length;   ///< m, 0 (a weld) to 4e12; default MSPRING_REST_LENGTH_DISTANCE
    float break_strain;  ///< as MSPRING_BREAK_STRAIN; default MSPRING_NEVER
    float stress_strain; ///< as MSPRING_STRESS_STRAIN; default MSPRING_NEVER
    float relax_strain;  ///< as MSPRING_RELAX_STRAIN; default MSPRING_RELAX_STRAIN_DEFAULT
    float yield_strain, hardening, plastic_limit; ///< as the properties in massspring_laws.h; default: it never yields
} mspring_spring_def;

/// Material of a lattice's cells. Fill with mspring_material_init() or mspring_material_preset() first.
typedef struct mspring_material {
    uint32_t struct_size;
    uint32_t particle_flags; ///< MSPRING_PARTICLE_PINNED or 0; default 0
    uint32_t spring_flags;   ///< as flags of mspring_spring_def; the same in all materials of a lattice; default 0
    float mass;              ///< kg per cell, 1e-30 to 1e30; default 1
    float stiffness;         ///< this and all that follows: as in mspring_spring_def, with the same defaults
    float damping, break_strain, stress_strain, relax_strain, yield_strain, hardening, plastic_limit;
} mspring_material;

/// Cell of a lattice with nothing in it.
#define MSPRING_CELL_EMPTY 0xffffu

/// A grid of cells, as an image gives it. Fill with mspring_lattice_def_init() first.
///
/// Each cell that is not empty becomes a particle. Springs at rest join it with its 8 neighbours. Their stiffness and
/// damping are the means of the two materials. Their break strain is the lower one. Stress and relax strain are those
/// of the material with the lower stress strain. Structural springs follow rows and columns, shear springs diagonals.
/// Bend springs, as for cloth, join cells two apart, if the cell between is not empty. They make a step several times
/// dearer, and lower the stable stiffness. The shares scale stiffness and damping, but not a damping ratio.
typedef struct mspring_lattice_def {
    uint32_t struct_size;
    uint32_t width, height;            ///< cells, each at least 1, product at most MSPRING_MAX_PARTICLES; set both
    uint32_t material_count;           ///< at most 65535; default 0
    double x, y;                       ///< world position of the bottom left cell's centre; default 0
    double spacing;                    ///< m between neighbouring columns and rows, 1e-9 to 1e9; default 1
    const uint16_t *cells;             ///< [height][width], top row first: index into materials or MSPRING_CELL_EMPTY
    const mspring_material *materials; ///< [material_count]
    float shear_share; ///< stiffness of shear springs over that of structural ones, 0 to 1000; 0: none; default 1
    float bend_share;  ///< the same for bend springs; default 0: none
} mspring_lattice_def;

/* ------------------------------------------------------------------------------------------------------ settings */

/// How a network is evolved. The guide examples/guides/solvers.md compares the solvers.
typedef enum mspring_solver {
    /// Leapfrog in equal substeps. Second order for springs, gravity and global damping; first for spring dampers.
    /// Conserves momentum; cost is proportional to the substeps.
    /// Stable while omega_max * h < 2: on a full lattice of equal springs and masses, stiffness < mass / (2 h^2).
    MSPRING_SOLVER_EXPLICIT = 0,
    /// One linear system in each substep, solved by conjugate gradients until the residual is small. Stable for
    /// any dt and stiffness; the cost hardly depends on them. Vibration that a substep cannot follow is damped.
    MSPRING_SOLVER_IMPLICIT = 1,
    /// The same system, solved by a factorisation: exact but for rounding. Cheap for networks that are thin, such as
    /// bars and ropes. The library rejects networks whose factor needs over 2^27 numbers.
    MSPRING_SOLVER_DIRECT = 2,
    MSPRING_SOLVER_INT = MSPRING_ENUM_INT ///< no value
} mspring_solver;

/// Integrator of the implicit and the direct solver. All are stable for any substep. If a substep would gain energy,
/// the solver repeats it by implicit Euler, in parts if need be.
typedef enum mspring_integrator {
    MSPRING_INTEGRATOR_GA0 = 0,   ///< generalised-alpha with rho_inf = 0 (Chung and Hulbert 1993): second order
    MSPRING_INTEGRATOR_BDF2 = 1,  ///< backward differences of second order
    MSPRING_INTEGRATOR_EULER = 2, ///< implicit Euler: first order; takes most energy out of oscillations
    MSPRING_INTEGRATOR_INT = MSPRING_ENUM_INT ///< no value
} mspring_integrator;

/// Most substeps in one step.
#define MSPRING_MAX_SUBSTEPS 1000000u

/// substeps for "as few as are stable in any shape that the network can reach", chosen before each step (see
/// mspring_network_stable_dt()). For the implicit and the direct solver 1. mspring_step_info reports the number. If
/// all springs are relative, it is 1: set a number to have them firmer. For 600 steps after dt has changed, it is the
/// number whose substeps are closest in length to the last ones, within 0.4 to 0.8 of what is stable: up to 2.5 times as
/// many. Stable is meant of small motion. In violent motion, in which the ends of a spring pass by a quarter of its length
/// in a substep, it takes more, up to most_work times as many; a step that needs even more has MSPRING_STEP_FEWER. (Not
/// with relative springs, which would become firmer.)
#define MSPRING_SUBSTEPS_AUTO 0xffffffffu

/// substeps for the same number, but substeps keep their length while dt varies: a step takes the nearest whole number
/// of them, at least one, and the rest is left to the next (mspring_step_info.time_left). What nothing damps then keeps
/// its energy as with even dt. The price: the state is up to half a substep off the time that was asked for, and more
/// where a dt is shorter than that; draw x + v * time_left. Hooks, ramps and sleep go by the time that a step takes;
/// pins that move by their velocity, too. The length is chosen anew from dt if it is not stable any more; after 30 steps
/// of one dt, or in which it takes over twice the substeps that dt needs; if it takes over 16 times as many; or if the
/// state is ahead by over one and a half and dt is shorter still. (Steps of one substep stay ahead then, and a dt below a
/// 16th of what is stable leaves the length: bursts of these still add energy.)
#define MSPRING_SUBSTEPS_EVEN 0xfffffffeu

/// Solver and its settings. Fill with mspring_solver_def_init() first. A solver ignores what it does not use.
///
/// Work is counted, never timed: an explicit substep is 1, a clamped one 3, an implicit or direct one 1 for each 8
/// products with its matrix and for each pass of its active set. A calm step has the substeps that were set or, with
/// MSPRING_SUBSTEPS_AUTO and _EVEN, those that stability asks for, and repeats nothing. For MSPRING_GUARD_RETRY it has at
/// least the substeps that are stable in any shape, up to max_substeps. Four things come on top of most_work:
///  - A step that the guard rejects may end with one by the fallback, with the substeps of calm motion:
///    MSPRING_GUARD_CLAMP, _IMPLICIT, _CLAMP_BOUNDS.
///  - A step that counted on what did not hold, as on no floor within reach, is repeated: once at most for each of floor,
///    contact, grips, hooks, one-way springs and yielding. That is not counted, as it may depend on the workers.
///  - With groups of particles, a step is repeated at most twice for each group that ends out of bounds or with NaN. No
///    group is held because many others go wrong.
///  - The implicit and the direct solver take 32 times as many calm steps, as substeps in which bodies touch have 16 times
///    the iterations, and impacts some intervals, halves and passes. A calm one has 8 iterations, or a quarter of the most
///    if that is more; with residual 0 all. Where that ends, the rest is done once, by implicit Euler: the energy budget
///    holds, and bodies near each other move on as rigid ones, with friction but no bounce. The step has
///    MSPRING_STEP_FEWER; MSPRING_GUARD_GROWTH and _RETRY reject it. The solution that comes to the end may be one of
///    two on top.
typedef struct mspring_solver_def {
    uint32_t struct_size;
    mspring_solver solver; ///< default MSPRING_SOLVER_EXPLICIT
    uint32_t substeps;     ///< of one step, 1 to MSPRING_MAX_SUBSTEPS, MSPRING_SUBSTEPS_AUTO, the default, or _EVEN
    uint32_t max_substeps; ///< most that MSPRING_SUBSTEPS_AUTO or MSPRING_GUARD_RETRY may choose, 1 to
                           ///< MSPRING_MAX_SUBSTEPS; default 1000. If a step needs more, the guard decides.
    mspring_integrator integrator; ///< of the implicit and the direct solver; default MSPRING_INTEGRATOR_GA0
    uint32_t iterations;    ///< most iterations of conjugate gradients in a substep, at most 10000; 1: springs hardly
                            ///< act; default 0: 30, or 8 if residual is 0
    uint32_t tile_size;     ///< of the implicit solver's tiles, in rows and columns of a lattice: 8, 16, 32, 64, 128 or
                            ///< 256; 0, the default: chosen by the plan
    uint32_t coarse_period; ///< substeps between factorisations of the tiles' matrix, at most 10000; more are cheaper
                            ///< if the network turns little in them; 0, the default: 1
    uint32_t most_work; ///< work in a step, in calm steps, up to which MSPRING_SUBSTEPS_AUTO and _EVEN take more
                        ///< substeps for violent motion, MSPRING_GUARD_RETRY repeats, and the implicit and the direct
                        ///< solver take parts again; at most MSPRING_MAX_SUBSTEPS; default 4; 0: no bound but
                        ///< max_substeps. See above
    float residual; ///< 0 to 1; default 0.01: the implicit solver stops iterating when r . z, a square of the forces
                    ///< out of balance, has fallen to this share of its value after the first iteration. 0: exactly
                    ///< `iterations`; 1: springs hardly act. With a floor it is squared, or the iterations double;
                    ///< bodies that touch have a tolerance of their own
    /// Length of all substeps, s, rounded to a float; 1.2e-38 to 1e30, or 0, the default: not set. It replaces
    /// `substeps`, which then reads back as MSPRING_SUBSTEPS_AUTO. A step takes the nearest whole number of substeps,
    /// and leaves the rest of dt to the next: mspring_step_info.time_left, at most half a substep. So motion without
    /// damping keeps its energy, and the length of a tick stays the same, however dt varies. If dt is too short for a
    /// substep, the call only adds it to time_left, and does not count as a step; forces and signals wait for the next
    /// one. If dt needs more than MSPRING_MAX_SUBSTEPS, the step returns MSPRING_ERROR_ARGUMENT. Networks with groups
    /// reject a length. The guard may repeat a step with other substeps. MSPRING_SUBSTEPS_EVEN chooses a length by
    /// itself, and changes it if necessary.
    double substep_length;
} mspring_solver_def;

/// Instruction sets. All give the same bits. Levels of one kind of CPU stand in order: scalar < SSE2 < AVX2 < AVX-512
/// on x86; scalar < NEON on 64-bit ARM; scalar < WASM in a browser. Between kinds there is no order.
typedef enum mspring_simd {
    MSPRING_SIMD_AUTO = 0, ///< the best that CPU and operating system offer; a narrower one for small networks
    MSPRING_SIMD_SCALAR = 1,
    MSPRING_SIMD_SSE2 = 2,
    MSPRING_SIMD_AVX2 = 3,
    MSPRING_SIMD_AVX512 = 4,
    MSPRING_SIMD_NEON = 5,
    MSPRING_SIMD_WASM = 6,              ///< SIMD128 of WebAssembly, in modules that were built with it
    MSPRING_SIMD_INT = MSPRING_ENUM_INT ///< no value
} mspring_simd;

/// Flags of networks.
enum {
    MSPRING_NETWORK_RESERVE_DAMPING = 1u << 0,  ///< springs may get damping later, though none has any now
    MSPRING_NETWORK_RESERVE_RELATIVE = 1u << 1, ///< relative springs may be added later, though there is none now
    /// Velocities have two words: gravity is right to 1e-6 at any number of substeps, with every solver. In explicit
    /// steps lengths of springs have two words, too: the energy of what nothing damps then stays, and stiff springs far
    /// from the local origin do not tremble. An explicit step takes 1.7 to 2.2 times as long; each particle takes 17
    /// bytes more. In implicit and direct steps second words of positions always count. Strains for breaking and stress
    /// use the first words.
    MSPRING_NETWORK_PRECISE = 1u << 2,
    /// Keep the positions of particles at creation, or when they were added, for the angle of mspring_body. Takes 16
    /// bytes a particle, also in whole snapshots and archives.
    MSPRING_NETWORK_POSES = 1u << 3
};

/// What a step does to keep motion bounded. A step always rejects coordinates and speeds that are not finite or out
/// of bounds. With the implicit and the direct solver, most guards keep an energy budget instead. Energy then grows
/// by no more than the work of gravity, forces and moving pins. The guide examples/guides/solvers.md has the details.
typedef enum mspring_guard {
    /// Reject a step whose substeps exceed the stability limit (mspring_network_stable_dt()), or make motion grow.
    /// Steps within the limit are never rejected, not even where uneven dt or violent motion adds energy step by step.
    /// With the implicit and the direct solver, reject a step that runs out of most_work, as heaps and tangles may.
    MSPRING_GUARD_GROWTH = 0,
    /// Repeat a step that would be rejected, with twice as many substeps, up to max_substeps and as long as
    /// mspring_solver_def.most_work lasts: where that ends it, the step fails, and the next one begins with the number
    /// that would have followed. Later steps keep the number until mspring_network_set_solver(). Hooks are called again.
    /// Relative springs gain nothing by it. An implicit or direct step that runs out of most_work fails, too.
    MSPRING_GUARD_RETRY = 1,
    MSPRING_GUARD_BOUNDS = 2, ///< check the bounds only
    /// Repeat a step that would be rejected, by one substep of implicit Euler. The 15 steps after it use that, too. It
    /// is slower and softer, but stable at nearly any stiffness. Hooks are called again. The network reserves memory.
    MSPRING_GUARD_IMPLICIT = 3,
    /// Repeat a step that would be rejected, with clamped strain rates; unless the solver is implicit, also the 15
    /// steps after it. Springs that are too stiff for the substep, or in violent motion, act with a part of their force;
    /// others act as ever. Unphysical: stiff springs turn soft, and motion along them is damped. Small motion never grows.
    /// A substep takes as long as 3 explicit ones (10 where springs are irregular). Hooks are called again. Uses one
    /// thread and no memory. The default.
    MSPRING_GUARD_CLAMP = 4,
    /// Check nothing, and put back particles that end out of bounds. Speeds become at most max_speed, local
    /// coordinates at most MSPRING_MAX_COORDINATE. A particle with NaN or infinity goes back to its place before the
    /// step, or to the local origin, and stands still. No step fails. An explosion is bounded, but not physical. A step
    /// in which numbers overflow is repeated as with MSPRING_GUARD_CLAMP, so that it has the same bits everywhere.
    MSPRING_GUARD_CLAMP_BOUNDS = 5,
    MSPRING_GUARD_INT = MSPRING_ENUM_INT ///< no value
} mspring_guard;

/// Settings that may change at any time: see mspring_network_set_settings(). mspring_settings_init() fills in the
/// defaults. To start from a network's own settings, use mspring_network_get_settings().
typedef struct mspring_settings {
    uint32_t struct_size;
    mspring_guard guard;  ///< what a step does to keep motion bounded; default MSPRING_GUARD_CLAMP
    float gravity_x;      ///< m/s^2, finite; default 0
    float gravity_y;      ///< m/s^2, finite; default -9.8
    float global_damping; ///< 1/s, 0 to 1e6: velocities decay by exp(-global_damping t), at any dt; default 0
    float max_speed;      ///< m/s, > 0 and at most 1e15: a step rejects faster particles, in x or y; default 1e6
    float sleep_speed;    ///< m/s, 0 to 1e15: a component sleeps if none of its particles has been faster, in x or y,
                          ///< for sleep_time. Default 0: never. See mspring_network_is_asleep()
    float sleep_time;     ///< s of simulated time, 0 to 1e6; default 0.5
    float relax_fraction; ///< 0 to 1: a stressed spring relaxes below this fraction of its stress strain; 0: it stays
                          ///< stressed; default 0.8
} mspring_settings;

/// A network at the start. Fill with mspring_network_def_init() first.
///
/// It has the fields of mspring_settings and of mspring_solver_def, with the same meanings and defaults. Of most_work,
/// residual and substep_length the network has the defaults; mspring_network_set_solver() sets them.
typedef struct mspring_network_def {
    uint32_t struct_size;
    mspring_simd simd_level; ///< highest level to use; default MSPRING_SIMD_AUTO. A level that this machine lacks is no
                             ///< limit. MSPRING_SIMD_SCALAR means the lowest level of this build. The environment
                             ///< variable MSPRING_SIMD (scalar, sse2, avx2, avx512, neon, wasm) can lower it further.
    mspring_guard guard;     ///< from here to relax_fraction: as in mspring_settings
    float gravity_x, gravity_y, global_damping, max_speed, sleep_speed, sleep_time, relax_fraction;
    mspring_solver solver; ///< from here to coarse_period: as in mspring_solver_def
    uint32_t substeps, max_substeps;
    mspring_integrator integrator;
    uint32_t iterations, tile_size, coarse_period;
    uint32_t flags;                     ///< bits of MSPRING_NETWORK_; default 0
    const mspring_allocator *allocator; ///< default NULL: malloc and free
    const mspring_tasks *tasks;         ///< threads of the host; default NULL: threads of the library
    uint32_t worker_count;    ///< threads that step the network, the caller's included, 1 to MSPRING_MAX_WORKERS;
                              ///< default 1. They take no signals, and sleep between steps. Ignored if tasks is set.
    uint32_t spare_particles; ///< particles that may be added later, with the builder's at most
                              ///< MSPRING_MAX_PARTICLES; default 0. The network reserves memory for them.
    uint32_t spare_springs;   ///< the same for springs, at most MSPRING_MAX_SPRINGS; default 0
    uint32_t reserved;        ///< 0
} mspring_network_def;

/// Most half-planes of a floor, and most heights.
#define MSPRING_MAX_PLANES 8u
#define MSPRING_MAX_HEIGHTS 0x4000000u

/// A floor: half-planes, such as walls, and a field of heights, such as a sea floor. Fill with
/// mspring_floor_def_init() first.
typedef struct mspring_floor_def {
    uint32_t struct_size;
    uint32_t plane_count;        ///< half-planes, at most MSPRING_MAX_PLANES; default 0
    double heights_x, heights_y; ///< x of the first height, y of height 0, m, world coordinates; default 0
    double spacing;              ///< m from one height to the next, 1e-9 to 1e9; default 1
    const double *planes;  ///< [plane_count][4]: x, y of a point on the border (m, world coordinates), x, y of a normal
                           ///< of any length. It points to the side where particles may be.
    const float *heights;  ///< [height_count], m above heights_y, joined by straight lines, level beyond both ends
    uint32_t height_count; ///< 2 to MSPRING_MAX_HEIGHTS, or 0, the default: no heights
    float friction;        ///< of sliding (Coulomb): force along the surface over that across it, 0 to 1e6; default 0
    float restitution;     ///< speed across the surface after contact over that before, 0 to 1; default 0
    uint32_t reserved;     ///< 0
    /// Friction and restitution of each plane, and of each straight part of the heights from left to right. The first
    /// and the last part go on beyond the ends. NULL, the default: the fields friction and restitution everywhere.
    const float *plane_frictions, *plane_restitutions;   ///< [plane_count]
    const float *height_frictions, *height_restitutions; ///< [height_count - 1]
    float silt_depth; ///< m of silt above the heights, straight up, 0 to 1e12: a soft layer that brakes; default 0
    float silt_rate;  ///< 1/s, 0 to 1e6: dv/dt = -silt_rate v at the heights, less above, 0 at its top; default 0
} mspring_floor_def;

/// Fill a definition with its defaults. Pass the size that your header gives it: sizeof *def.
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_particle_def_init(mspring_particle_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_spring_def_init(mspring_spring_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_material_init(mspring_material *material, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_lattice_def_init(mspring_lattice_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_solver_def_init(mspring_solver_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_network_def_init(mspring_network_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_floor_def_init(mspring_floor_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_settings_init(mspring_settings *settings, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_allocator_init(mspring_allocator *allocator, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_tasks_init(mspring_tasks *tasks, size_t size);

/* ------------------------------------------------------------------------------------------------------- builder */

/// Collects particles and springs. It can make any number of networks, and is not needed after that.
typedef struct mspring_builder mspring_builder;

/// Make an empty builder.
/// @param allocator  copied; NULL for malloc and free
/// @threads any   @allocates yes   @errors ARGUMENT, STRUCT, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_create(
    const mspring_allocator *allocator, mspring_builder **builder);

/// Free a builder. NULL is allowed.
/// @threads exclusive   @allocates never
MSPRING_API void MSPRING_CALL mspring_builder_destroy(mspring_builder *builder);

/// Return the error message of the last call; "" if that call succeeded.
/// It names the culprit and is valid until the next call. Print mspring_result_string() first. NULL gives "".
/// @threads shared   @allocates never
MSPRING_API const char *MSPRING_CALL mspring_builder_error(const mspring_builder *builder);

/// Return the number of particles or springs added so far. NULL gives 0.
/// @threads shared   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_builder_particle_count(const mspring_builder *builder);
MSPRING_API uint32_t MSPRING_CALL mspring_builder_spring_count(const mspring_builder *builder);

/// Add one particle.
/// @param id  receives its id; may be NULL
/// @threads exclusive   @allocates yes   @errors ARGUMENT, STRUCT, LIMIT, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_particle(
    mspring_builder *builder, const mspring_particle_def *def, mspring_id *id);

/// Add many particles: all of them or, on error, none.
/// @param defs      [count], all with the same struct_size; the error message names the index
/// @param first_id  receives the id of the first; the others follow; may be NULL
/// @threads exclusive   @allocates yes   @errors as mspring_builder_add_particle()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_particles(
    mspring_builder *builder, const mspring_particle_def *defs, uint32_t count, mspring_id *first_id);

/// Add one spring between two particles.
/// mspring_network_create() rejects a second spring between the same two, unless it only pulls or only pushes.
/// @param id  receives its id; may be NULL
/// @threads exclusive   @allocates yes   @errors ID for a particle that does not exist; ARGUMENT also for a spring
///          from a particle to itself, or for MSPRING_REST_LENGTH_DISTANCE at distance 0; STRUCT, LIMIT, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_spring(
    mspring_builder *builder, const mspring_spring_def *def, mspring_id *id);

/// Add many springs: all of them or, on error, none. As mspring_builder_add_particles().
/// @threads exclusive   @allocates yes   @errors as mspring_builder_add_spring()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_springs(
    mspring_builder *builder, const mspring_spring_def *defs, uint32_t count, mspring_id *first_id);

/// Add a lattice: all of it or, on error, nothing.
/// Particle ids follow the cells, row by row from the top, left to right. Spring ids follow the particles: each
/// brings those to its right, lower left, lower and lower right neighbour. Bend springs, right and down, come last.
/// @param cell_ids  [height][width], receives each cell's particle id or MSPRING_NONE; may be NULL
/// @threads exclusive   @allocates yes   @errors ARGUMENT (the message names cell or material), STRUCT, LIMIT,
///          MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_lattice(
    mspring_builder *builder, const mspring_lattice_def *def, mspring_id *cell_ids);

/// Read particles of a builder back, as definitions that would add them again.
/// @param ids    [count]; NULL: the particles first ... first + count - 1
/// @param first  not used if ids is given
/// @param defs   [count], struct_size set in each, the same for all
/// @threads exclusive   @allocates never   @since 0.2   @errors ID, ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_get_particles(
    mspring_builder *builder, const mspring_id *ids, mspring_id first, uint32_t count, mspring_particle_def *defs);

/// Read springs back: with the rest length in metres, and damping in N s/m or as a fraction, never as a ratio.
/// @param ids, first, defs  as in mspring_builder_get_particles()
/// @threads exclusive   @allocates never   @since 0.2   @errors ID, ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_get_springs(
    mspring_builder *builder, const mspring_id *ids, mspring_id first, uint32_t count, mspring_spring_def *defs);

/// Read an archive that mspring_network_write() has written, by this or an earlier version, into an empty builder.
/// mspring_network_create() then makes a network that continues where the written one was, with the same ids. Until
/// then the builder has the particles and springs that the written network was created with, including removed ones,
/// in their present state. Later additions come with the network. Do not add to this
/// builder: mspring_network_create() then returns MSPRING_ERROR_ARGUMENT.
///
/// Archives may come from anywhere. This call checks the form of all chunks, and all values of particles and springs;
/// mspring_network_create() checks the rest, and may return MSPRING_ERROR_SNAPSHOT, too. Messages name the chunk. Both
/// use memory in proportion to size.
/// @param archive  [size] bytes, of any alignment; copied
/// @param skipped  receives the number of chunks left out, because only later versions or other parts of the library
///                 know them; may be NULL
/// @threads exclusive   @allocates yes; size and 100 bytes for each particle and spring   @since 0.2
/// @errors SNAPSHOT (the message says what is wrong), ARGUMENT also for a builder that is not empty, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_read(
    mspring_builder *builder, const void *archive, size_t size, uint32_t *skipped);

/* ------------------------------------------------------------------------------------------------------- network */

/// A network: its topology and its state.
typedef struct mspring_network mspring_network;

/// Make a network of what the builder holds.
/// Finds lattices and chains in it, whatever the order in which they were added, and lays the state out for them. On
/// failure the builder has the error message.
///
/// If the builder has read an archive, the network continues where the archived one was. Then def may change the
/// settings, the solver, workers and the allocator. Flags and spare room must be the archive's.
/// @param def  NULL for the defaults, or for the archive's definition (mspring_builder_get_network_def())
/// @threads exclusive for builder   @allocates yes   @errors ARGUMENT also for a builder without particles;
///          DUPLICATE if two springs join the same two particles; THREAD if a worker cannot start; SNAPSHOT for an
///          archive with impossible values; STRUCT, LIMIT, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_create(
    mspring_builder *builder, const mspring_network_def *def, mspring_network **network);

/// Fill a network's definition from the builder's archive: settings, solver, flags and spare room. Without an archive,
/// fill in the defaults. Set struct_size first.
/// @threads exclusive for builder   @allocates never   @since 0.2   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_get_network_def(
    mspring_builder *builder, mspring_network_def *def);

/// Free a network. NULL is allowed. Not allowed inside a hook.
/// @threads exclusive   @allocates never
MSPRING_API void MSPRING_CALL mspring_network_destroy(mspring_network *network);

/// Return the error message of a call that failed: the last exclusive one, or the first shared one after it.
/// As mspring_builder_error(). An exclusive call clears it first, so "" follows if that succeeds. A shared call that
/// fails sets it, unless one has done so since the last exclusive call. So it stays as it is until the next of these.
/// @threads shared   @allocates never
MSPRING_API const char *MSPRING_CALL mspring_network_error(const mspring_network *network);

/// Return the number of particles or springs, removed ones included. All ids are below it. NULL gives 0.
/// @threads shared   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_network_particle_count(const mspring_network *network);
MSPRING_API uint32_t MSPRING_CALL mspring_network_spring_count(const mspring_network *network);

/// Choose the solver and its settings. The state goes on from where it is.
/// If they are set already, nothing changes.
/// @threads exclusive   @allocates for an implicit or direct solver, unless only substeps, iterations, residual or
///          coarse_period change   @errors ARGUMENT also for a solver that this build lacks; LIMIT if the solver's
///          matrix is too large (the message says how large); STRUCT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_solver(
    mspring_network *network, const mspring_solver_def *def);

/// Read the solver and its settings. Set struct_size first.
/// If you set them again, nothing changes. With MSPRING_GUARD_RETRY, substeps is the number of the next step. Numbers
/// that were set to 0 may come back as the ones in use.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_solver(
    const mspring_network *network, mspring_solver_def *def);

/// Read the settings that the next step uses. Set struct_size first.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_settings(
    const mspring_network *network, mspring_settings *settings);

/// Set all settings or, on error, none. To change one, get them, change it and set them:
///
///     mspring_settings settings = {.struct_size = sizeof settings};
///     mspring_result result = mspring_network_get_settings(network, &settings);
///     settings.gravity_y = -1.6f;
///     if (!result) result = mspring_network_set_settings(network, &settings);
///
/// A value that is set already changes nothing. A new gravity, sleep_speed, sleep_time or relax_fraction wakes all.
/// @threads exclusive   @allocates what a guard or sleep needs, the first time   @errors ARGUMENT (the message
///          names the field and its value), STRUCT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_settings(
    mspring_network *network, const mspring_settings *settings);

/* ---------------------------------------------------------------------------------------------------------- step */

/// Evolve the network by dt.
/// If a coordinate or speed would end out of bounds, or motion grow by instability (mspring_guard), the step is
/// rolled back. The state is then that before the step, bit for bit, and forces given for it are still there. The
/// message and mspring_step_info name a particle or a spring. Use a shorter dt, more substeps or lower stiffness.
///
/// Pass equal dt. The explicit solver keeps another energy at each length of substep. A dt that differs from step to
/// step, as a frame's time does, therefore adds energy where nothing damps; no guard sees it. If dt must vary, damp
/// (springs, or global_damping), or use MSPRING_SUBSTEPS_EVEN, or set substeps that keep h = dt / substeps below 0.7 of
/// any_shape (mspring_network_stable_dt()): then it grows more slowly. Motion so violent that neighbours pass over a third
/// of a spring's length in a substep adds energy, too: MSPRING_SUBSTEPS_AUTO takes more substeps for it, a number of
/// your own should.
///
/// The first kick of an explicit step lasts for half of the substep before, too. So a dt that falls to a hundredth may
/// set bodies at rest on a floor moving at gravity times that half (4 cm/s from 1/30 to 1e-6 s with four substeps
/// before).
/// @param dt  s, > 0; as a float, dt / substeps must be finite and at least 1.2e-38
/// @threads exclusive   @allocates only where contact needs more room (mspring_contact_def.max_capacity)
/// @errors ARGUMENT, UNSTABLE, BUSY; THREAD in a child of fork(); MEMORY for that room; LIMIT if contact finds more
///         pairs than max_capacity, or compares too many (mspring_network_set_contact())
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_step(mspring_network *network, double dt);

/// Flags of mspring_step_info: how a step was made.
enum {
    MSPRING_STEP_FALLBACK = 1u << 0, ///< by one substep of the implicit solver (MSPRING_GUARD_IMPLICIT)
    MSPRING_STEP_CLAMPED = 1u << 1,  ///< with clamped strain rates (MSPRING_GUARD_CLAMP, _CLAMP_BOUNDS)
    MSPRING_STEP_PUT_BACK = 1u << 2, ///< particles were put back into the bounds (MSPRING_GUARD_CLAMP_BOUNDS)
    MSPRING_STEP_RETRIED = 1u << 3,  ///< with more substeps than were set (MSPRING_GUARD_RETRY)
    MSPRING_STEP_ASLEEP = 1u << 4,   ///< all of the network slept: nothing was computed
    MSPRING_STEP_FEWER = 1u << 5, ///< with fewer substeps, or parts of these, than its violent motion needs
                                  ///< (mspring_solver_def.most_work)
    MSPRING_STEP_GREW = 1u << 6   ///< contact allocated room for more pairs (mspring_contact_def.max_capacity)
};

/// Report of the last step, and of all steps so far. Set struct_size first.
typedef struct mspring_step_info {
    uint32_t struct_size;
    mspring_result result;   ///< of the last step; MSPRING_OK before the first
    mspring_id particle;     ///< cause of a rejection, or of what the guard did; or MSPRING_NONE
    mspring_id spring;       ///< the same for a spring
    uint32_t flags;          ///< of the last step: MSPRING_STEP_FALLBACK and so on
    uint32_t substeps;       ///< of the last step that succeeded, with pieces of cut ones; 0 before
    uint64_t step_count;     ///< steps that have succeeded
    uint64_t fallback_count; ///< of these with MSPRING_STEP_FALLBACK or MSPRING_STEP_CLAMPED
    double time;             ///< simulated time of these, s: that of the state
    double largest_speed;    ///< length of the fastest particle's velocity now, m/s
    double time_left;        ///< with MSPRING_SUBSTEPS_EVEN or substep_length: dt that steps were given and have not
                             ///< taken yet, s; < 0: they are ahead
    double work;             ///< of the last step, even if it failed, in calm steps (mspring_solver_def.most_work): 1 if
                             ///< nothing was repeated or raised; 0 if nothing was computed
} mspring_step_info;

/// Read the report of the last step. Takes a pass over the velocities; mspring_network_step_flags() does not.
/// Snapshots and clones have step_count, fallback_count, time and substeps. After loading a snapshot, the rest is
/// that of a new network. Inside a hook it is that of the step before.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_step_info(
    const mspring_network *network, mspring_step_info *info);

/// Return the flags of the last step, as mspring_step_info has them, at once. 0 before the first; NULL gives 0.
/// @threads shared   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_network_step_flags(const mspring_network *network);

/// Return 1 if all of the network sleeps, else 0. NULL gives 0.
/// Each component sleeps by itself; the guide calls it an island. It falls asleep after a step if it has been slower
/// than mspring_settings.sleep_speed for sleep_time. Its velocities become 0. Steps do not move it, and cost only
/// what is awake. It wakes if an edit, a force or a setting changes it, or what it rests on. The rules:
/// examples/guides/sleep.md.
/// @threads shared   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_network_is_asleep(const mspring_network *network);

/// Wake all of a network. It sleeps again after it has been slow for sleep_time.
/// @threads exclusive   @allocates never   @errors ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_wake(mspring_network *network);

/* -------------------------------------------------------------------------------------------------------- forces */

/// Add a force (N) to one particle, during the whole next step.
/// @threads exclusive   @allocates at the first force given to a network   @errors ID; ARGUMENT also if the sum of
///          its forces is not finite; MEMORY; BUSY (in a hook use its force arrays)
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_force(
    mspring_network *network, mspring_id particle, float x, float y);

/// Add forces (N) to many particles: to all or, on error, to none.
/// They are the particles first ... first + count - 1, or those listed. Forces on an id that repeats add up.
/// @param x, y    those of element i are x[i * stride] and y[i * stride]
/// @param stride  elements from one to the next: 1 for two arrays, 2 with y = x + 1 for one of vectors, 0 for the same
///                on all
/// @threads exclusive   @allocates at the first force given to a network   @errors as mspring_network_apply_force()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_forces(
    mspring_network *network, mspring_id first, uint32_t count, const float *x, const float *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_forces_at(mspring_network *network,
    const mspring_id *particles, uint32_t count, const float *x, const float *y, uint32_t stride);

/// Change velocities by impulses (N s) at once: all or, on error, none.
/// The change is impulse / mass * MSPRING_INVERSE_MASS_SCALE. Pinned particles ignore impulses.
/// @param x, y, stride  as of mspring_network_apply_forces()
/// @threads exclusive   @allocates never   @errors ID; ARGUMENT also if a velocity would exceed MSPRING_MAX_SPEED;
///          BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_impulses(
    mspring_network *network, mspring_id first, uint32_t count, const float *x, const float *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_impulses_at(mspring_network *network,
    const mspring_id *particles, uint32_t count, const float *x, const float *y, uint32_t stride);

/// Add a torque (N m) to a body during the next step. It acts as forces around the centre of mass, whose sum is 0.
/// The force on a particle is proportional to its mass and to its distance from the centre, so it turns a rigid body
/// without bending it. Pinned particles get no force, and do not count for the centre. For a motor, apply the opposite
/// torque to another body.
/// @param ids     [count] the particles; a repeated id counts each time; NULL: first ... first + count - 1, without
///                removed ones
/// @param first   not used if ids is given
/// @param torque  N m, counterclockwise
/// @threads exclusive   @allocates at the first force given to a network   @since 0.2   @errors ID; ARGUMENT also if
///          no particle is free or all free ones are in one place, or if a sum of forces is not finite; MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_torque(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, float torque);

/* --------------------------------------------------------------------------------------------------------- floor */

/// Set the floor, instead of the one that the network has.
/// It acts on every particle that is not pinned, in every substep. A particle that was above it is not below it
/// afterwards, at any speed, but for a millionth of its distance from the local origin. One that was below is put
/// onto it. Contact takes energy and gives none; the guide examples/guides/floor.md names the exceptions, and what
/// bounces how. Snapshots, state hashes and mspring_network_settle() do not contain the floor.
/// @param def  copied with all that it points to; NULL: no floor
/// @threads exclusive   @allocates yes   @errors ARGUMENT, STRUCT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_floor(
    mspring_network *network, const mspring_floor_def *def);

/// Read the floor. Set struct_size first.
/// If you set it again, nothing changes. Without a floor both counts are 0. Its arrays are the network's copies, valid
/// until the floor is set again or the network is destroyed.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_floor(
    const mspring_network *network, mspring_floor_def *def);

/// Read the impulses (N s) that the floor gave to particles in the last step.
/// Divided by dt they are mean forces, but not in an explicit step after one of another dt: its first impulses last for
/// half of the substep before and half of their own. Without a floor they are 0.
/// @param x, y, stride  as of mspring_network_get_positions()
/// @threads shared   @allocates never   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_floor_impulses(
    const mspring_network *network, mspring_id first, uint32_t count, float *x, float *y, uint32_t stride);

/* --------------------------------------------------------------------------------------------------------- state */

/// The state as it lies in memory, to read: arrays by slot. Set struct_size first.
/// Pointers stay valid, and their contents follow the steps, until layout_generation changes. A step may move the
/// origin, and origin_x and origin_y are copies: fill the view again after steps.
typedef struct mspring_view {
    uint32_t struct_size;
    uint32_t slot_count;     ///< length of the arrays by slot; some slots hold no particle
    uint32_t particle_count; ///< length of slot_of_particle
    uint32_t reserved;       ///< 0
    /// Changes if particles or springs are added or removed, also by a snapshot, or a job changes the layout.
    uint64_t layout_generation;
    uint64_t origin_generation;       ///< changes if the origin moves
    double origin_x, origin_y;        ///< world position = origin + (x, y), m
    const float *x, *y;               ///< [slot_count], m, relative to the origin
    const float *vx, *vy;             ///< [slot_count], m/s
    const float *inverse_mass;        ///< [slot_count], 1/kg; 0 if pinned or no particle
    const uint32_t *particle_of_slot; ///< [slot_count], particle id or MSPRING_NONE
    const uint32_t *slot_of_particle; ///< [particle_count]
    const void *reserved_pointer;     ///< NULL
} mspring_view;

/// Fill a view to read. It makes no later step dearer.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_view(
    const mspring_network *network, mspring_view *view);

/// Read world positions (m) of particles. The forms with _float round them.
/// They are the particles first ... first + count - 1, or those listed. In a range a removed one has the local origin.
/// @param x, y    receive those of element i in x[i * stride] and y[i * stride]
/// @param stride  elements from one to the next, at least 1: 1 for two arrays, 2 with y = x + 1 for one of points
/// @threads shared   @allocates never   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_positions(
    const mspring_network *network, mspring_id first, uint32_t count, double *x, double *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_positions_float(
    const mspring_network *network, mspring_id first, uint32_t count, float *x, float *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_positions_at(
    const mspring_network *network, const mspring_id *particles, uint32_t count, double *x, double *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_positions_float_at(
    const mspring_network *network, const mspring_id *particles, uint32_t count, float *x, float *y, uint32_t stride);

/// Read velocities (m/s), as mspring_network_get_positions(). They are single precision. Explicit steps leave those of
/// half a substep ago.
/// @threads shared   @allocates never   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_velocities(
    const mspring_network *network, mspring_id first, uint32_t count, float *vx, float *vy, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_velocities_at(
    const mspring_network *network, const mspring_id *particles, uint32_t count, float *vx, float *vy, uint32_t stride);

/// Set world positions (m) of particles: all or, on error, none.
/// They are the particles first ... first + count - 1, or those listed. Of an id that repeats, the last value counts.
/// If you set all particles by a range, the local origin moves to them.
/// @param x, y    those of element i are x[i * stride] and y[i * stride], at most MSPRING_MAX_COORDINATE in size, also
///                relative to the local origin
/// @param stride  as of mspring_network_get_positions(), or 0: the same for all
/// @threads exclusive   @allocates never   @errors ID, ARGUMENT (the message names the particle), BUSY (in a hook use
///          its arrays)
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_positions(
    mspring_network *network, mspring_id first, uint32_t count, const double *x, const double *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_positions_float(
    mspring_network *network, mspring_id first, uint32_t count, const float *x, const float *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_positions_at(mspring_network *network,
    const mspring_id *particles, uint32_t count, const double *x, const double *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_positions_float_at(
    mspring_network *network, const mspring_id *particles, uint32_t count, const float *x, const float *y,
    uint32_t stride);

/// Set velocities (m/s, within MSPRING_MAX_SPEED), as mspring_network_set_positions(). After explicit steps they are
/// taken as those of half a substep ago.
/// A pinned particle moves by its velocity.
/// @threads exclusive   @allocates never   @errors ID, ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_velocities(
    mspring_network *network, mspring_id first, uint32_t count, const float *vx, const float *vy, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_velocities_at(mspring_network *network,
    const mspring_id *particles, uint32_t count, const float *vx, const float *vy, uint32_t stride);

/// Hash the state: positions, velocities, their lag and local origin, in id order.
/// Equal states have equal hashes on every machine. The hash is not cryptographic.
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_state_hash(
    const mspring_network *network, uint64_t *hash);

/* ---------------------------------------------------------------------------------------------------- properties */

/// A property: one float of each particle, or of each spring. "Allocates" is about the first call that changes a
/// value.
typedef enum mspring_property {
    /// Of a particle, kg, 1e-30 to 1e30, for cargo or flooding. A pinned particle keeps its mass. Relative springs
    /// use the old masses until mspring_network_renew_relative_springs(). Allocates if the network has relative
    /// springs.
    MSPRING_MASS = 0,
    /// Of a particle: scale of its response to forces, 0 or 1e-6 to 1. 1 is normal, 0 is pinned. It scales neither
    /// gravity nor the mass in energy and momentum. Allocates at the first scale that is neither 0 nor 1.
    MSPRING_INVERSE_MASS_SCALE = 1,
    /// Nominal stiffness of a spring, N/m, 0 to 1e30; of a relative spring its fraction. A broken spring gets it when
    /// it is restored. Allocates for a relative spring.
    MSPRING_STIFFNESS = 2,
    /// Nominal damping of a spring, N s/m, 0 to 1e30; of a relative spring its fraction. Values above 0 need a spring
    /// that was made with damping, or MSPRING_NETWORK_RESERVE_DAMPING. Allocates as MSPRING_STIFFNESS.
    MSPRING_DAMPING = 3,
    /// Rest length of a spring as given, m, 0 to 4e12, for muscles and winches; 0 is a weld: its ends rest in the same
    /// place. What the spring has yielded comes on top: MSPRING_ACTIVE_REST_LENGTH. Writing it ends a ramp. Allocates
    /// for a spring of a lattice.
    MSPRING_REST_LENGTH = 4,
    /// Break strain of a spring, > 0; default MSPRING_NEVER. If the size of a spring's strain exceeds it at the end
    /// of a step, the spring breaks. If substeps are too long to follow a blow, the strains are wrong. Allocates.
    MSPRING_BREAK_STRAIN = 5,
    /// Stress strain of a spring, > 0; default MSPRING_NEVER. If the size of a spring's strain exceeds it at the end
    /// of a step, the spring is stressed until it relaxes. Allocates.
    MSPRING_STRESS_STRAIN = 6,
    /// Relax strain of a spring, >= 0. A stressed spring relaxes at the end of a step, if the size of its strain is
    /// below its relax strain and its stress strain. 0: it stays stressed. MSPRING_RELAX_STRAIN_DEFAULT, the default:
    /// relax_fraction of the stress strain. Allocates.
    MSPRING_RELAX_STRAIN = 7,
    MSPRING_STRAIN = 8, ///< (length - rest_length) / rest_length; of a weld length / 1 m; 0 if broken; read only
    MSPRING_LENGTH = 9, ///< of a spring, m; read only
    MSPRING_FORCE = 10, ///< along a spring, N, damper included; > 0 pulls its ends together; read only
    /// Stiffness in force of a spring, N/m; of a relative spring that of the last step; 0 if it is broken. Read only.
    MSPRING_ACTIVE_STIFFNESS = 11,
    MSPRING_ACTIVE_DAMPING = 12, ///< the same for damping, N s/m; read only
    MSPRING_YIELD_STRAIN = 13,   ///< this and the next three, of springs: see massspring_laws.h
    MSPRING_HARDENING = 14,
    MSPRING_PLASTIC_LIMIT = 15,
    MSPRING_PLASTIC_STRAIN = 16,
    MSPRING_ACTIVE_REST_LENGTH = 17,        ///< in force, m: with its ramp and plastic strain; read only
    MSPRING_PROPERTY_INT = MSPRING_ENUM_INT ///< no value
} mspring_property;

/// Set a property of many particles or springs: all values or, on error, none.
/// They are those with the ids first ... first + count - 1, or those listed. In a range removed ids are left out; in
/// a list they are an error. Of an id that repeats, the last value counts. A value that is set already costs a
/// comparison: it wakes nothing, and is no edit to snapshots.
/// The second call for a range of 64 springs or more copies the values of this property, 4 bytes a spring. To send the
/// same values again then takes a comparison of two arrays, unless another edit of springs came between. Without memory
/// for the copy, calls only take longer.
/// @param values  that of element i is values[i * stride]
/// @param stride  floats from one value to the next: 1 for an array, more for a field of structs, 0: one value for all
/// @threads exclusive   @allocates as the property says   @errors ID; ARGUMENT also for a property that is unknown
///          or read only (the message names property, id and value); MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set(mspring_network *network,
    mspring_property property, mspring_id first, uint32_t count, const float *values, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_at(mspring_network *network,
    mspring_property property, const mspring_id *ids, uint32_t count, const float *values, uint32_t stride);

/// Read a property of many particles or springs, as mspring_network_set().
/// @param values  receives that of element i in values[i * stride]; 0 for a removed id
/// @param stride  floats from one value to the next, at least 1; what lies between is left alone
/// @threads shared   @allocates never   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get(const mspring_network *network,
    mspring_property property, mspring_id first, uint32_t count, float *values, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_at(const mspring_network *network,
    mspring_property property, const mspring_id *ids, uint32_t count, float *values, uint32_t stride);

/// Numbers that name the ends of springs.
typedef enum mspring_numbering {
    MSPRING_ENDS_IDS = 0,                    ///< ids of particles
    MSPRING_ENDS_SLOTS = 1,                  ///< slots of a view: they change with its layout_generation
    MSPRING_NUMBERING_INT = MSPRING_ENUM_INT ///< no value
} mspring_numbering;

/// Read the ends of the springs first ... first + count - 1, as for an index buffer.
/// Ends come as they were given: of a lattice's springs the lower id first, of a rope's the end nearer to its start.
/// A removed spring has MSPRING_NONE at both.
/// @param a, b    receive those of spring first + i in a[i * stride] and b[i * stride]
/// @param stride  elements from one to the next, at least 1; for pairs 2, with b = a + 1
/// @threads shared   @allocates never   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_ends(const mspring_network *network,
    mspring_id first, uint32_t count, mspring_numbering numbering, uint32_t *a, uint32_t *b, uint32_t stride);

/// Read the flags of the springs first ... first + count - 1.
/// @param flags   receives those of spring first + i in flags[i * stride]
/// @param stride  elements from one to the next, at least 1
/// @threads shared   @allocates never   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_spring_flags(
    const mspring_network *network, mspring_id first, uint32_t count, uint32_t *flags, uint32_t stride);

/// Read the largest absolute value of a strain, and the spring that has it.
/// Of several springs it is the lowest id. Without springs: 0 and MSPRING_NONE. Either pointer may be NULL.
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_max_strain(
    const mspring_network *network, float *strain, mspring_id *spring);

/* --------------------------------------------------------------------------------------------------------- edits */

/// Break springs: they exert nothing until they are restored.
/// Ids, rest lengths and nominal values stay. A broken spring stays broken.
/// @param springs  [count]
/// @threads exclusive   @allocates at the first break in a network   @errors ID (the message names the index),
///          ARGUMENT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_break_springs(
    mspring_network *network, const mspring_id *springs, uint32_t count);

/// Restore broken springs to their nominal stiffness and damping.
/// With a ramp, the rest length goes evenly from the present length to its own, so that the spring does not kick its
/// ends. A weld (rest length 0) has no ramp.
/// @param springs       [count]
/// @param ramp_seconds  simulated time, 0 to 1e6; 0: no ramp
/// @threads exclusive   @allocates for ramps and rest lengths; if a compacted network must be expanded
///          (mspring_network_compact())   @errors as mspring_network_break_springs()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_restore_springs(
    mspring_network *network, const mspring_id *springs, uint32_t count, double ramp_seconds);

/// Break all springs of particles, which become loose.
/// @param particles  [count]
/// @threads exclusive   @allocates at the first break and first detachment   @errors as
///          mspring_network_break_springs()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_detach_particles(
    mspring_network *network, const mspring_id *particles, uint32_t count);

/// Return 1 if there is such a particle or spring, else 0. Removed ones give 0. NULL gives 0.
/// @threads shared   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_network_has_particle(const mspring_network *network, mspring_id particle);
MSPRING_API uint32_t MSPRING_CALL mspring_network_has_spring(const mspring_network *network, mspring_id spring);

/// Add particles, as many as spare_particles has room for: all or, on error, none.
/// They get the lowest free ids. A view stays valid, but for its particle_count. After explicit steps their velocities,
/// too, count as half a substep old.
/// @param defs  [count], positions also within MSPRING_MAX_COORDINATE of the local origin
/// @param ids   [count], receives their ids
/// @threads exclusive   @allocates never   @errors LIMIT if there is no room (the message says how much there is);
///          ARGUMENT or STRUCT (the message names the definition); BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_particles(
    mspring_network *network, const mspring_particle_def *defs, uint32_t count, mspring_id *ids);

/// Add springs, as many as spare_springs has room for: all or, on error, none.
/// MSPRING_REST_LENGTH_DISTANCE is the present distance. The layout does not know added springs: as long as there are
/// any, explicit substeps are slower, until mspring_network_compact() takes them in.
/// @param defs  [count]; relative or damped springs need some in the network, or MSPRING_NETWORK_RESERVE_RELATIVE or
///              MSPRING_NETWORK_RESERVE_DAMPING
/// @param ids   [count], receives their ids: the lowest free ones
/// @threads exclusive   @allocates at the first break, stress or relax strain in a network   @errors as
///          mspring_network_add_particles(); ID for a particle that does not exist; DUPLICATE if the two are joined
///          already, broken or not; ARGUMENT also with the direct solver: set another one first; MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_springs(
    mspring_network *network, const mspring_spring_def *defs, uint32_t count, mspring_id *ids);

/// Remove particles with all their springs, for good.
/// In lists their ids are MSPRING_ERROR_ID from then on. In ranges they are left out, and read as 0 (a position as
/// the local origin, a component as MSPRING_NONE). Springs that were not broken give MSPRING_EVENT_BROKEN.
/// @param particles  [count]
/// @threads exclusive   @allocates at the first break, detachment and removal   @errors as
///          mspring_network_break_springs()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_particles(
    mspring_network *network, const mspring_id *particles, uint32_t count);

/// Remove springs, for good.
/// @param springs  [count]
/// @threads exclusive   @allocates at the first break, detachment and removal   @errors as
///          mspring_network_break_springs()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_springs(
    mspring_network *network, const mspring_id *springs, uint32_t count);

/// Allow that added particles and springs get ids of added ones that were removed.
/// Until then these ids, and their room, count as used. Ids that the network was created with are never used again.
/// @threads exclusive   @allocates never   @errors ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_recycle(mspring_network *network);

/* ----------------------------------------------------------------------------------------- events and components */

/// Kind of an event.
typedef enum mspring_event_kind {
    MSPRING_EVENT_BROKEN = 0,   ///< spring id broke, by its strain after a step or by an edit. By an edit strain is 0,
                                ///< and other is the particle that was detached or removed, if any
    MSPRING_EVENT_STRESSED = 1, ///< the strain of spring id exceeded its stress strain
    MSPRING_EVENT_RELAXED = 2,  ///< and fell below its relax strain
    MSPRING_EVENT_RESTORED = 3, ///< spring id was restored
    MSPRING_EVENT_DETACHED = 4, ///< particle id was detached; after the events of its springs
    MSPRING_EVENT_SPLIT = 5,    ///< the component whose lowest particle is other split off from that of id
    MSPRING_EVENT_JOINED = 6,   ///< the component whose lowest particle was id is now part of that of other
    MSPRING_EVENT_YIELDED = 7,  ///< spring id yielded in a step; strain is its plastic strain
    MSPRING_EVENT_KIND_INT = MSPRING_ENUM_INT ///< no value
} mspring_event_kind;

/// An event of a step or of an edit. This struct is frozen at 16 bytes.
typedef struct mspring_event {
    mspring_event_kind kind;
    mspring_id id;    ///< of a spring or a particle, by kind
    mspring_id other; ///< by kind; or MSPRING_NONE
    float strain;     ///< of the spring when it happened, signed; or 0
} mspring_event;

/// Reserve room for events, which are recorded from then on.
/// Events that were not read yet are dropped.
/// @param capacity  events that may wait to be read, at most MSPRING_MAX_SPRINGS; 0: record none
/// @threads exclusive   @allocates yes   @errors ARGUMENT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_reserve_events(
    mspring_network *network, uint32_t capacity);

/// Read and remove the oldest events, in the order in which they happened.
/// Within a step the order depends on the network alone: it is the same on every machine.
/// @param events    [capacity]; may be NULL if capacity is 0
/// @param count     receives how many were read
/// @param lost      receives how many were lost to a full queue since it was reserved; may be NULL
/// @threads exclusive   @allocates never   @errors ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_read_events(
    mspring_network *network, mspring_event *events, uint32_t capacity, uint32_t *count, uint64_t *lost);

/// Update the components: particles connected by springs that are not broken.
/// A component is named by its lowest particle, and numbered from 0 in that order. Changes since the last update give
/// MSPRING_EVENT_SPLIT and MSPRING_EVENT_JOINED. Without changes the call costs next to nothing.
/// @param count    receives the number of components; may be NULL
/// @param changed  receives 1 if a particle's component has another number than the last time, else 0; may be NULL
/// @threads exclusive   @allocates the first time   @errors ARGUMENT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_update_components(
    mspring_network *network, uint32_t *count, uint32_t *changed);

/// Read the component numbers of the particles first ... first + count - 1, as of the last update.
/// @param numbers  receives that of particle first + i in numbers[i * stride]
/// @param stride   elements from one to the next, at least 1
/// @threads shared   @allocates never   @errors ID; ARGUMENT also if there was no update yet
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_component_numbers(
    const mspring_network *network, mspring_id first, uint32_t count, uint32_t *numbers, uint32_t stride);

/// Report of a component. Set struct_size first.
typedef struct mspring_component {
    uint32_t struct_size;
    mspring_id head; ///< its lowest particle
    uint32_t particle_count;
    uint32_t reserved; ///< 0
    double mass;       ///< kg
    double x, y;       ///< centre of mass, m, world coordinates
    double px, py;     ///< momentum, kg m/s, of its particles that are not pinned
} mspring_component;

/// Read reports of the components first ... first + count - 1 of the last update.
/// Mass and motion are those of now. Takes a pass over all particles.
/// @param components  [count], struct_size set in each
/// @threads shared   @allocates never   @errors ID; STRUCT; ARGUMENT also if there was no update yet
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_components(
    const mspring_network *network, uint32_t first, uint32_t count, mspring_component *components);

/* -------------------------------------------------------------------------------------------------- measurements */

/// Compute the energies, J, in double precision. Any of them may be NULL.
///   kinetic    sum of m v^2 / 2 over particles that are not pinned, with velocities of now if only springs, gravity
///              and global damping act; else with those that you read
///   elastic    sum of stiffness (L - rest_length)^2 / 2 over springs; relative springs with the stiffness of the last
///              step, before the first 0; with what hardening, areas and angles store (massspring_laws.h)
///   potential  - sum of m (gravity . p) over particles that are not pinned, p in world coordinates
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_energy(
    const mspring_network *network, double *kinetic, double *elastic, double *potential);

/// Compute momentum (kg m/s) and angular momentum (kg m^2/s) about the world's origin.
/// Of particles that are not pinned. Any of them may be NULL.
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_momentum(
    const mspring_network *network, double *px, double *py, double *angular);

/// Compute the smallest box around all particles, world coordinates (m). Without particles: the local origin.
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_bounds(
    const mspring_network *network, double *min_x, double *min_y, double *max_x, double *max_y);

/// Set of particles as one body. Pinned particles count unless a field says otherwise. Set struct_size first.
typedef struct mspring_body {
    uint32_t struct_size;
    uint32_t particle_count;
    mspring_id head;   ///< lowest id of its particles, or MSPRING_NONE
    uint32_t reserved; ///< 0
    double mass;       ///< kg
    double x, y;       ///< centre of mass, m, world coordinates
    double vx, vy;     ///< its velocity, m/s
    double inertia;    ///< moment of inertia about it, kg m^2
    double angle;      ///< rad, -pi to pi, counterclockwise: rotation since creation that fits best, by least squares
                       ///< of distances weighted with mass; 0 without MSPRING_NETWORK_POSES
    double spin;       ///< rad/s, counterclockwise: angular momentum about the centre / inertia; 0 if inertia is 0
    double px, py;     ///< momentum, kg m/s, of particles that are not pinned
    double angular;    ///< angular momentum of these about the world's origin, kg m^2/s
    double min_x, min_y, max_x, max_y; ///< smallest box around the particles, m, world coordinates
} mspring_body;

/// Measure particles as one body: position and angle of a sprite, box for a camera, momentum.
/// Sums are in double precision and relative to the centre of mass, so a body far from the world's origin loses no
/// digits. Velocities are those that mspring_network_get_velocities() reads: after explicit steps, half a substep old.
/// Without particles all sums are 0, and the position is that of the local origin. The angle is a fit without
/// reflection or scale (Kabsch 1976).
/// @param ids    [count] the particles; a repeated id counts each time; NULL: first ... first + count - 1, without
///               removed ones
/// @param first  not used if ids is given
/// @threads shared   @allocates never   @since 0.2   @errors ID, ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_body(
    const mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, mspring_body *body);

/* ----------------------------------------------------------------------------------------------------- snapshots */

/// Contents of a snapshot.
typedef enum mspring_snapshot_contents {
    /// All that the following steps depend on: positions, velocities, origin, settings, masses, forces for the next
    /// step, springs with their flags and ramps.
    MSPRING_SNAPSHOT_ALL = 0,
    /// The same without stiffness, damping, rest lengths and thresholds of springs: smaller and faster, for rollback.
    /// It can be loaded if these are as they were: no edit of them, and nothing added or removed. To break, restore
    /// or detach is no such edit.
    MSPRING_SNAPSHOT_FRAME = 1,
    MSPRING_SNAPSHOT_CONTENTS_INT = MSPRING_ENUM_INT ///< no value
} mspring_snapshot_contents;

/// Compute the size (bytes) of a snapshot that is saved now.
/// Ask before each save: it depends on forces, ramps and edits.
/// @threads shared   @allocates never   @errors ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_snapshot_size(
    const mspring_network *network, mspring_snapshot_contents contents, size_t *size);

/// Save a snapshot, for rollback, replay and network play; for files use mspring_network_write().
/// It is the same on every machine, at any SIMD level, for any number of workers. It fits networks made of the same
/// particles and springs, with the same solver, integrator, flags and layout (mspring_network_compact()), by the same
/// minor version. Hooks, the floor and unread events are not in it.
/// @param snapshot  [capacity] bytes, of any alignment; capacity is at least mspring_network_snapshot_size()
/// @param size      receives the bytes written; may be NULL
/// @threads shared   @allocates never   @errors ARGUMENT also for too little room; BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_save(
    const mspring_network *network, mspring_snapshot_contents contents, void *snapshot, size_t capacity, size_t *size);

/// Load a snapshot: the following steps repeat those after it was saved, bit for bit.
/// Unread events are dropped. Snapshots may come from anywhere: one that is damaged, cut off, of another network or
/// with impossible values is rejected.
/// @threads exclusive   @allocates what the network did not need so far   @errors SNAPSHOT (the message says what
///          is wrong), ARGUMENT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_load(
    mspring_network *network, const void *snapshot, size_t size);

/* ------------------------------------------------------------------------------------------------------ archives */

/// Receives the next bytes of an archive, [size] of them. Return MSPRING_OK to continue, else an error.
typedef mspring_result(MSPRING_CALL *mspring_write_fn)(const void *bytes, size_t size, void *user);

/// Write an archive: a file that this and all later versions read (mspring_builder_read()), on every machine.
/// It has ids, state, removed and broken springs, laws, ramps, sleep, settings, solver, and forces for the next step.
/// It also has floor, contact, colliders, grips, areas, angles, groups with their marks, and actuators. It lacks hooks,
/// components, unread events and reports on the last step. Its bytes depend neither on the machine nor on SIMD level
/// or workers.
///
/// The next steps of a network that was read repeat those of the written one bit for bit, if both have the same layout.
/// Later versions and networks edited after their compaction may have another: see the guide "Archives".
/// @param write  called with one piece after another; no call of the network's is allowed in it
/// @param user   passed to write
/// @threads exclusive for the allocator, otherwise shared   @allocates up to twice its largest chunk, about 16 bytes for
///          each particle and spring, and frees it   @since 0.2   @errors ARGUMENT, MEMORY, BUSY, what write returned
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_write(
    const mspring_network *network, mspring_write_fn write, void *user);

#ifdef __cplusplus
}
#endif

#endif
