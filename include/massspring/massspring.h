/// @file massspring.h
/// libmassspring: simulation of two-dimensional mass-spring-damper networks.
///
/// A network is a set of particles with mass, joined by springs with stiffness and damping. You describe it to
/// a **builder**, create a **network** from the builder, **step** it by dt, and read it through **views** and
/// **measurements**.
///
///     builder --create--> network (topology + state) --step--> views, measurements
///
/// **Units** are SI: metres, kilograms, seconds, newtons, N/m, N s/m. The y axis points up.
///
/// **Physics.** One substep of length h, for a spring between particles a and b (semi-implicit, also called
/// symplectic, Euler):
///
///     d = p_b - p_a;  L = |d|;  u = d / L
///     f = (L - rest_length) * stiffness + ((v_b - v_a) . u) * damping
///     F_a += f u;  F_b -= f u
///     v(t+h) = (v + (F / m + gravity) h) * exp(-global_damping h);   p(t+h) = p + v(t+h) h
///
/// A spring of length 0 has no direction and exerts no force. A pinned particle feels no force: it keeps the
/// velocity that the host gives it (zero at first) and moves by it. Where there is damping, a speed below 1e-30 m/s
/// is 0 after a step, so that motion that dies away comes to an end.
///
/// **Precision.** The state is single precision relative to a local origin that the network holds in double
/// and moves along by itself, so a network behaves 10 km away from the world's origin as it does at it. A position
/// has a second word below that, so that no substep rounds away what it adds: more substeps are never less
/// accurate. Views show the first word; the second is at most some units in its last place, and where a first one
/// is written over it stays, unless it is too large for that. Velocities have one word. Of the h g that gravity adds
/// in a substep at v it may round away or add 3e-8 v: more substeps than make this a thousandth, h = 3e-5 v / g, make
/// what falls freely less accurate.
///
/// **Same bits.** The same calls give the same state, bit for bit, at every SIMD level, with every supported
/// compiler and optimisation level. This holds within one minor version: 0.2.0 and 0.2.1 have the same bits, 0.3.0 may
/// have others. mspring_network_state_hash() is the way to check it.
///
/// **Errors.** Every function that can fail returns a mspring_result. A failed call changes nothing but the
/// object's error message, which says what is wrong and where; out-parameters are left untouched. No function
/// prints, exits or aborts. Passing a handle that was destroyed is the one mistake that cannot be detected.
///
/// **Threads.** The library has no global state. Calls on one object must not overlap; calls on different
/// objects may. Where a function says "shared", several threads may call such functions on one object at once.
/// A network steps on the caller's thread alone, unless its definition asks for workers (worker_count, tasks): then
/// calls on it still come from one thread at a time, and it divides their work among the workers itself. The number
/// of workers changes no bit of the result. If fork() is called between calls, the child can go on with its copies:
/// the library's threads are started again by the first step there.
///
/// **Memory.** Functions say whether they allocate; a step never does.
///
/// **Structs.** What you give has an init function, which fills in defaults: call it first. What you read into only
/// needs its struct_size: set it first, to the size of the struct. Settings and solvers are both.
///
/// **ABI.** Handles are opaque, no struct is passed by value. Ids, counts, capacities and strides are uint32_t;
/// sizes in bytes are size_t. Enums are signed integers of 32 bits. Structs have no padding but what their fields
/// name.
///
/// Every public struct but mspring_event starts with struct_size. Reserved fields of what you give must be 0:
/// anything else is MSPRING_ERROR_ARGUMENT. A later version may give them a meaning.
///
/// Structs may grow at the end, and a program built against an older header goes on working. One built against a
/// newer header works, too, as long as it leaves what this version does not know at 0, as the init functions do;
/// else it gets MSPRING_ERROR_STRUCT. What such a program reads there is 0. If it calls a function that is not
/// there, the loader says so.
///
/// Later versions may also add results, kinds of events, and flags in what is read. Ignore those that you do not
/// know: a result below 0 is an error.
///
/// Nothing that was released is taken away. What has something better stays, and its description says what to use
/// instead, until the ABI is broken as a whole. That is counted by the shared library's own number, not by the
/// release.
///
/// massspring_tools.h has what tunes and inspects networks.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_H
#define MASSSPRING_MASSSPRING_H

#include <stddef.h>
#include <stdint.h>

#include "version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------ export macros */

/// Marks the functions of the library. Define MSPRING_SHARED where you use the library as a Windows DLL, or
/// MSPRING_API itself before this header where you compile the library with your program: as `static`, for instance.
#if defined(MSPRING_API)
#elif defined(_WIN32) && defined(MSPRING_BUILD_SHARED)
#define MSPRING_API __declspec(dllexport)
#elif defined(_WIN32) && defined(MSPRING_SHARED)
#define MSPRING_API __declspec(dllimport)
#elif defined(__GNUC__)
#define MSPRING_API __attribute__((visibility("default")))
#else
#define MSPRING_API
#endif

/// The calling convention of all functions and callbacks. On other systems than 32-bit Windows there is one.
#if defined(MSPRING_CALL)
#elif defined(_WIN32) && !defined(_WIN64)
#define MSPRING_CALL __cdecl
#else
#define MSPRING_CALL
#endif

/// Makes an enum a signed integer of 32 bits with every compiler, whatever its options. Its enumerator is no value:
/// give a switch a default.
#define MSPRING_ENUM_INT (-0x7fffffff - 1)

/// Marks results that must not be ignored.
#if defined(__cplusplus) && __cplusplus >= 201703L
#define MSPRING_NODISCARD [[nodiscard]]
#elif defined(__GNUC__)
#define MSPRING_NODISCARD __attribute__((warn_unused_result))
#else
#define MSPRING_NODISCARD
#endif

/* ------------------------------------------------------------------------------------------------ version */

/// Version of the library that runs, in the form of MSPRING_VERSION.
/// @threads any   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_version(void);

/// Version of the library that runs, as text, such as "0.2.0". Static storage.
/// @threads any   @allocates never   @since 0.2
MSPRING_API const char *MSPRING_CALL mspring_version_string(void);

/// What a build of the library has beside what all have.
enum {
    MSPRING_FEATURE_THREADS = 1u << 0,  ///< networks may have several workers; without, they have one
    MSPRING_FEATURE_HOSTED = 1u << 1,   ///< there is a default allocator, and the environment variable MSPRING_SIMD
                                        ///< is read
    MSPRING_FEATURE_SHARED = 1u << 2,   ///< this is the shared library
    MSPRING_FEATURE_IMPLICIT = 1u << 3, ///< there are MSPRING_SOLVER_IMPLICIT and MSPRING_GUARD_IMPLICIT
    MSPRING_FEATURE_DIRECT = 1u << 4    ///< there is MSPRING_SOLVER_DIRECT
};

/// Features of the library that runs: bits of MSPRING_FEATURE_. (When compiling, MSPRING_VERSION tells what the
/// header has: `#if MSPRING_VERSION >= 2000` is true from 0.2.0 on.)
/// @threads any   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_features(void);

/* ------------------------------------------------------------------------------------------- result codes */

/// What a call came to: MSPRING_OK or one of the negative errors below.
typedef enum mspring_result {
    MSPRING_OK = 0,
    MSPRING_ERROR_ARGUMENT = -1,     ///< NULL, NaN, infinite, or outside the range that the function states
    MSPRING_ERROR_ID = -2,           ///< no such particle or spring
    MSPRING_ERROR_MEMORY = -3,       ///< the allocator returned NULL
    MSPRING_ERROR_LIMIT = -4,        ///< more particles, springs or cells than the library can index
    MSPRING_ERROR_STRUCT = -5,       ///< struct_size is not one that any version of this struct had
    MSPRING_ERROR_DUPLICATE = -6,    ///< two springs join the same two particles
    MSPRING_ERROR_UNSTABLE = -7,     ///< the step would have left the bounded range; the state is that before it
    MSPRING_ERROR_BUSY = -8,         ///< called from inside a hook, where only shared calls are allowed; or a job
                                     ///< is under way
    MSPRING_ERROR_THREAD = -9,       ///< the system refuses a thread or a lock
    MSPRING_ERROR_EQUILIBRIUM = -10, ///< the forces have no equilibrium, or none was found
    MSPRING_ERROR_SNAPSHOT = -11,    ///< this is no snapshot of this network, or a damaged one
    MSPRING_ERROR_OUTDATED = -12,     ///< the network is another than the one that the job was begun for
    MSPRING_RESULT_INT = MSPRING_ENUM_INT ///< no value
} mspring_result;

/// Short English name of a result code, such as "out of memory". Never NULL; static storage.
/// @threads any   @allocates never   @since 0.2
MSPRING_API const char *MSPRING_CALL mspring_result_string(mspring_result result);

/* -------------------------------------------------------------------------------------------- identifiers */

/// Particles and springs are named by dense integers, 0, 1, 2 ... in the order in which they were added. They
/// never change; the ids of some that were removed may be given to others once the host allows it
/// (mspring_network_recycle()). (Slots, the places inside a view's arrays, are another numbering: see
/// mspring_view.)
typedef uint32_t mspring_id;

/// No particle, no spring.
#define MSPRING_NONE 0xffffffffu

/// Most particles and most springs in one network.
#define MSPRING_MAX_PARTICLES 0x4000000u
#define MSPRING_MAX_SPRINGS 0x10000000u

/// Largest absolute world coordinate (m) that positions may have when given, and largest coordinate relative
/// to the local origin that a step may lead to.
#define MSPRING_MAX_COORDINATE 1e12

/// The fastest that a particle can be given, in x and y, m/s.
#define MSPRING_MAX_SPEED 1e15

/* ---------------------------------------------------------------------------------------------- allocator */

/// Where an object takes its memory from. Fill with mspring_allocator_init() first, then set alloc and free, and user
/// if they need it. The struct is copied.
/// alloc returns at least size bytes aligned to alignment (a power of two, at most 64), or NULL.
/// free gets the size that was asked for. Both are called only inside calls that say that they allocate, and
/// inside the destroy functions.
typedef struct mspring_allocator {
    uint32_t struct_size; ///< sizeof(mspring_allocator)
    uint32_t reserved;    ///< 0
    void *(MSPRING_CALL *alloc)(size_t size, size_t alignment, void *user);
    void (MSPRING_CALL *free)(void *memory, size_t size, void *user);
    void *user;
} mspring_allocator;

/* ------------------------------------------------------------------------------------------------ workers */

/// Most workers of one network.
#define MSPRING_MAX_WORKERS 256u

/// A piece of work of the library, to be called as fn(argument, index, worker).
typedef void (MSPRING_CALL *mspring_task_fn)(void *argument, uint32_t index, uint32_t worker);

/// The host's threads, lent to a network. Fill with mspring_tasks_init() first. The struct is copied.
///
/// run has to call fn(argument, index, worker) once for each index below count, on any threads, the caller's
/// included, and to return when all these calls have returned. What the caller wrote before is to be visible to
/// them, and what they wrote to the caller afterwards, as any thread pool sees to. It has to keep these promises:
///
///   - worker is below worker_count, and no two calls that run at the same time have the same worker. (It numbers
///     threads, so that each can have storage of its own; which thread has which number may change from run to
///     run.)
///   - If count is at most concurrent_count, all the calls run at the same time: each starts without waiting for
///     another to return, and goes on running. The library may then have them wait for each other, so a host
///     that runs fewer at once would hang. If count is larger, the calls are independent of each other and may run
///     in any order, even one after the other.
///
/// A host that cannot promise more sets concurrent_count to 1; the library then divides only what is independent.
/// run is called only inside calls on the network that are not marked shared, never by two threads at once and
/// never from inside fn.
typedef struct mspring_tasks {
    uint32_t struct_size;      ///< sizeof(mspring_tasks)
    uint32_t worker_count;     ///< 1 to MSPRING_MAX_WORKERS; 1, the default, means that run is not called
    uint32_t concurrent_count; ///< 1 to worker_count; default 1
    uint32_t reserved;         ///< 0
    void (MSPRING_CALL *run)(uint32_t count, mspring_task_fn fn, void *argument, void *user); ///< must be set
    void *user; ///< handed to run; default NULL
} mspring_tasks;

/* -------------------------------------------------------------------------------------------- definitions */

/// Flags of particles.
enum {
    MSPRING_PARTICLE_PINNED = 1u << 0 ///< feels no force
};

/// Flags of springs.
enum {
    /// stiffness and damping are fractions of what an explicit substep bears, instead of N/m and N s/m:
    ///     k = stiffness * mu / h^2,   c = damping * mu / h,   mu = m_a m_b / (m_a + m_b)
    /// with h the substep. They follow the substep, so such a network is as stiff as its step allows. A full
    /// lattice of equal springs and masses is stable below stiffness = 1.
    MSPRING_SPRING_RELATIVE = 1u << 0,
    /// damping is a ratio of critical damping, 0 to 1000: 1 lets the spring's ends come to rest without swinging.
    ///     c = 2 damping sqrt(stiffness * mu)
    /// In definitions only. The library computes c once, from the masses at that time, and then forgets the ratio:
    /// later changes of mass or stiffness leave c as it is. A pinned particle counts with its mass. If the spring
    /// is relative, c is a fraction and follows the substep. c is at most 1e30.
    MSPRING_SPRING_DAMPING_RATIO = 1u << 1,
    /// The spring is broken. This and the next two can be read only, not set.
    MSPRING_SPRING_BROKEN = 1u << 8,
    /// The spring is stressed (MSPRING_STRESS_STRAIN).
    MSPRING_SPRING_STRESSED = 1u << 9,
    /// The spring has been removed. Ranges only: together with MSPRING_SPRING_BROKEN.
    MSPRING_SPRING_REMOVED = 1u << 10
};

/// One particle. Fill with mspring_particle_def_init() first.
typedef struct mspring_particle_def {
    uint32_t struct_size;
    uint32_t flags; ///< MSPRING_PARTICLE_PINNED or 0; default 0
    double x, y;    ///< world position, m, at most MSPRING_MAX_COORDINATE in absolute value; default 0
    float vx, vy;   ///< velocity, m/s, within MSPRING_MAX_SPEED; default 0
    float mass;     ///< kg, 1e-30 to 1e30; default 1
    uint32_t reserved; ///< 0
} mspring_particle_def;

/// rest_length for "the distance at which the two particles are added".
#define MSPRING_REST_LENGTH_DISTANCE (-1.0f)

/// Break or stress strain for "never": the largest float. INFINITY means the same, and is read as this. Use it in
/// programs that are compiled with -ffinite-math-only.
#define MSPRING_NEVER 3.40282346638528859812e+38f

/// Relax strain for "relax_fraction (mspring_settings) of the stress strain".
#define MSPRING_RELAX_STRAIN_DEFAULT (-1.0f)

/// One spring. Fill with mspring_spring_def_init() first.
typedef struct mspring_spring_def {
    uint32_t struct_size;
    uint32_t flags;    ///< MSPRING_SPRING_RELATIVE, MSPRING_SPRING_DAMPING_RATIO; default 0
    mspring_id a, b;   ///< the particles it joins, not the same; default MSPRING_NONE
    float stiffness;   ///< N/m (or a fraction, see MSPRING_SPRING_RELATIVE), 0 to 1e30; default 0
    float damping;     ///< N s/m (or a fraction, or a ratio), 0 to 1e30; default 0
    float rest_length; ///< m, > 0 and at most 4e12, or MSPRING_REST_LENGTH_DISTANCE, the default
    float break_strain;  ///< as MSPRING_BREAK_STRAIN; default MSPRING_NEVER
    float stress_strain; ///< as MSPRING_STRESS_STRAIN; default MSPRING_NEVER
    float relax_strain;  ///< as MSPRING_RELAX_STRAIN; default MSPRING_RELAX_STRAIN_DEFAULT
} mspring_spring_def;

/// What a lattice cell is made of. Fill with mspring_material_init() first.
typedef struct mspring_material {
    uint32_t struct_size;
    uint32_t particle_flags; ///< MSPRING_PARTICLE_PINNED or 0; default 0
    uint32_t spring_flags;   ///< as flags of mspring_spring_def; default 0; all materials of a lattice must agree
    float mass;              ///< kg per cell, 1e-30 to 1e30; default 1
    float stiffness;         ///< as in mspring_spring_def
    float damping;           ///< as in mspring_spring_def
    float break_strain;      ///< this and what follows: as in mspring_spring_def, with the same defaults
    float stress_strain;
    float relax_strain;
} mspring_material;

/// Materials that mspring_material_preset() knows.
typedef enum mspring_preset {
    MSPRING_PRESET_STEEL = 0, ///< heavy, as firm as substeps allow, hardly damped
    MSPRING_PRESET_WOOD = 1,  ///< light and firm
    MSPRING_PRESET_RUBBER = 2, ///< bends and stretches far
    MSPRING_PRESET_JELLY = 3,  ///< sags under its own weight and wobbles
    MSPRING_PRESET_INT = MSPRING_ENUM_INT ///< no value
} mspring_preset;

/// Cell of a lattice with nothing in it.
#define MSPRING_CELL_EMPTY 0xffffu

/// A grid of cells, as an image gives it: every cell that is not empty becomes a particle, every pair of
/// neighbours (8 to a cell) is joined by a spring at its rest length. The spring's stiffness and damping are
/// the means of its two materials'. Its break strain is the lower one of the two. It has stress and relax strain of the
/// material with the lower stress strain. Fill with mspring_lattice_def_init() first.
///
/// Cloth has three kinds of spring. Structural springs join the 4 neighbours in rows and columns. Shear springs join
/// the diagonal ones. Bend springs join cells two apart in a row or column, if the cell between is not empty. Shear
/// and bend springs have a share of the materials' stiffness and damping (a damping ratio stays as it is). Bend springs
/// are no neighbours on a grid: with them the plan has all of the lattice in the web, where a step costs several times
/// as much. They also lower the stable stiffness, see mspring_network_stable_dt().
typedef struct mspring_lattice_def {
    uint32_t struct_size;
    uint32_t width, height;            ///< cells, each at least 1, product at most MSPRING_MAX_PARTICLES
    uint32_t material_count;           ///< at most 65535
    double x, y;                       ///< world position of the bottom left cell's centre; default 0
    double spacing;                    ///< m between neighbouring columns and rows, 1e-9 to 1e9; default 1
    const uint16_t *cells;             ///< [height][width], the top row first: index into materials, or empty
    const mspring_material *materials; ///< [material_count]
    float shear_share;                 ///< of diagonal springs, 0 to 1000; 0: none are made; default 1
    float bend_share;                  ///< of springs two cells long, 0 to 1000; 0: none are made; default 0
} mspring_lattice_def;

/// A chain of equal springs between two particles that are there already. Its inner particles lie evenly on the
/// straight line between the two. Fill with mspring_rope_def_init() first.
typedef struct mspring_rope_def {
    uint32_t struct_size;
    uint32_t spring_flags;  ///< as flags of mspring_spring_def; default 0
    mspring_id from, to;    ///< its ends; default MSPRING_NONE
    uint32_t segment_count; ///< springs, at least 1; default 1. The rope has one inner particle fewer.
    float mass;             ///< kg of each inner particle; default 1
    float stiffness;        ///< of each spring, as in mspring_spring_def
    float damping;          ///< of each spring
    float slack;            ///< rest length of the whole over the distance of its ends, 0.001 to 1000; default 1
    float break_strain;     ///< this and what follows: of each spring, as in mspring_spring_def
    float stress_strain;
    float relax_strain;
} mspring_rope_def;

/// A mesh of triangles: each vertex becomes a particle, each edge one spring at rest, whichever triangles share it.
/// Fill with mspring_mesh_def_init() first.
///
/// A vertex has a third of the mass of each triangle at it. All springs are equally stiff, or young_modulus gives
/// each edge the stiffness
///     k = young_modulus * (sum of the areas of its triangles) / length^2
/// (Van Gelder 1998). A mesh of equilateral triangles then has that modulus, and Poisson's ratio 1/3. Other meshes
/// come near it.
typedef struct mspring_mesh_def {
    uint32_t struct_size;
    uint32_t spring_flags;     ///< as flags of mspring_spring_def; default 0
    uint32_t vertex_count;     ///< at most MSPRING_MAX_PARTICLES; 0: the mesh adds nothing
    uint32_t triangle_count;   ///< at most MSPRING_MAX_SPRINGS
    const double *x, *y;       ///< [vertex_count] world positions, m
    const uint32_t *triangles; ///< [triangle_count][3] indices of vertices, clockwise or not
    float area_density;        ///< kg/m^2, 1e-30 to 1e30; default 1
    float stiffness;           ///< of each spring, as in mspring_spring_def; default 0
    float young_modulus;       ///< N/m: Young's modulus times thickness, at most 1e30; default 0: stiffness counts
    float damping;             ///< of each spring, as in mspring_spring_def; default 0
    float break_strain;        ///< this and the next two: of each spring, as in mspring_spring_def
    float stress_strain;
    float relax_strain;
    uint32_t reserved; ///< 0
} mspring_mesh_def;

/// A disc: a mesh of rings around a particle in the centre. Ring i has 6 i particles. No spring is shorter than the
/// distance of two rings, or longer than 1.45 of it. If its rim may be jagged, a lattice of the cells within a circle
/// is cheaper and bears a longer substep. Fill with mspring_disc_def_init() first.
typedef struct mspring_disc_def {
    uint32_t struct_size;
    uint32_t spring_flags; ///< as flags of mspring_spring_def; default 0
    uint32_t centre_flags; ///< of the particle in the centre: MSPRING_PARTICLE_PINNED or 0; default 0
    uint32_t ring_count;   ///< 1 to 4729; default 1. There are 1 + 3 n (n + 1) particles, n (9 n + 3) springs.
    double x, y;           ///< world position of the centre, m; default 0
    double radius;         ///< m, 1e-9 to 1e12; default 1
    float area_density;    ///< this and what follows: as in mspring_mesh_def
    float stiffness;
    float young_modulus;
    float damping;
    float break_strain;
    float stress_strain;
    float relax_strain;
    uint32_t reserved; ///< 0
} mspring_disc_def;

/// How a network is evolved.
typedef enum mspring_solver {
    /// Symplectic Euler in substeps of equal length. First order, conserves momentum, cost proportional to the
    /// number of substeps. Stable while omega_max * h < 2: on a full lattice of equal springs and masses,
    /// stiffness < mass / (2 h^2). See mspring_network_stable_dt().
    MSPRING_SOLVER_EXPLICIT = 0,
    /// One linear system in each substep, whatever the stiffness: stable on lattices for any dt and any springs, at
    /// a cost that does not depend on them. Energy never comes from nowhere, and free components keep their momentum
    /// and angular momentum (see mspring_guard). Vibration that a substep cannot follow is damped.
    /// Springs and dampers are linearised at x + h v, with tiles of neighbouring particles turned on as rigid
    /// bodies
    /// (and with the stiffness across a spring clamped to 0 where it is compressed, so that the matrix is positive
    /// definite). The system is solved by a fixed number of conjugate gradient iterations with a two-level
    /// preconditioner: the blocks of the single particles, and the tiles. With eight
    /// of them a substep costs 24 to 41 explicit ones (massspring-bench --solvers). It damps what oscillates
    /// with less than about ten substeps a period. Global damping, which explicit steps apply exactly, is as
    /// accurate as its integrator.
    MSPRING_SOLVER_IMPLICIT = 1,
    /// The same system, solved by a factorisation (block Cholesky) that is computed anew in each substep: exact but
    /// for rounding, so that there is nothing to choose. Springs and dampers are linearised at x + h v itself. The
    /// cost for each particle grows with how wide the network is: a substep costs 15 to 120 explicit ones where it
    /// is thin (a bar of 5 rows of any length), 400 to 800 for 70 rows. The order of elimination is found, and all
    /// memory taken, when the solver is chosen; broken springs and pins need no new one. Where that would be over
    /// 2^27 numbers (1.6 GB: a square of about 600 x 600 particles, a graph of some 5,000 particles with springs at
    /// random), the solver is refused, before the memory is taken.
    /// The factor is in single precision as long as springs, seen over a substep, are not over some thousand times
    /// as stiff as their particles are heavy (4 to 8 k h^2 / m beyond 16384; 1e9 N/m between masses of 73 kg at
    /// 1/64 s are below), and in double precision, which costs 1.1 to 1.8 times as much, beyond that. Should even
    /// that not do (k h^2 / m of about 1e14 and more), particles are made heavier for this substep by the least
    /// that helps: 1.4e-14 of the stiffness at them, or 64 times that, and so on up to a thousandth; then the step
    /// is refused.
    MSPRING_SOLVER_DIRECT = 2,
    MSPRING_SOLVER_INT = MSPRING_ENUM_INT ///< no value
} mspring_solver;

/// How the implicit solvers go from t to t + h. All are stable for any h and damp the fastest oscillations out in
/// a few steps. The two of second order remember the substep before; the first substep after a change of the
/// solver, and after the positions of all particles were set, is one of implicit Euler.
///
/// Stiff ropes that hang slack, and are pulled taut within a substep, are what no integrator can follow. A substep
/// that would gain energy is taken again by implicit Euler, with twice the iterations, and then in halves, down to a
/// 32nd. The next 15 substeps are ones of implicit Euler, too (unless the guard is MSPRING_GUARD_BOUNDS).
typedef enum mspring_integrator {
    MSPRING_INTEGRATOR_GA0 = 0,  ///< generalised-alpha with rho_inf = 0 (Chung and Hulbert, 1993): second order
    MSPRING_INTEGRATOR_BDF2 = 1, ///< backward differences of second order
    MSPRING_INTEGRATOR_EULER = 2, ///< implicit Euler: first order, and takes most energy out of oscillations
    MSPRING_INTEGRATOR_INT = MSPRING_ENUM_INT ///< no value
} mspring_integrator;

/// Most substeps in one step.
#define MSPRING_MAX_SUBSTEPS 1000000u

/// substeps for "as few as are stable in whatever shape the network may get into" (see
/// mspring_network_stable_dt()), chosen at every step. mspring_step_info says how many they were. For the
/// implicit and the direct solver 1.
///
/// Relative springs follow the substep, so their number decides how firm they are: 1 if all springs are relative.
/// Set a number to have them firmer. If relative springs are too stiff to be stable in any shape, the others get half
/// of the room, and the guard looks at the present shape.
#define MSPRING_SUBSTEPS_AUTO 0xffffffffu

/// Solver and its settings. Fill with mspring_solver_def_init() first. What a solver does not use is not looked at.
typedef struct mspring_solver_def {
    uint32_t struct_size;
    mspring_solver solver; ///< default MSPRING_SOLVER_EXPLICIT
    uint32_t substeps;     ///< substeps in one step, 1 to MSPRING_MAX_SUBSTEPS, or MSPRING_SUBSTEPS_AUTO, the default
    uint32_t max_substeps; ///< most that MSPRING_SUBSTEPS_AUTO or MSPRING_GUARD_RETRY may choose, 1 to
                           ///< MSPRING_MAX_SUBSTEPS: a step that needs more is refused with
                           ///< MSPRING_ERROR_UNSTABLE; default 1000
    mspring_integrator integrator; ///< of the implicit and the direct solver; default MSPRING_INTEGRATOR_GA0
    uint32_t iterations;    ///< of conjugate gradients in a substep, at most 10000; 0, the default: 8. Take 2 or
                            ///< more: the first turns and moves tiles as rigid bodies only, which shorter
                            ///< substeps do not make up for. (The end of a bar of iron, 80x5, let go, is 22.98 m
                            ///< down after 2 s; with 2 iterations at 1/64 s 22.80 m; with 1 it is 14.11 m, and
                            ///< 25.25 m and 23.20 m at a 64th and a 1024th of that.)
    uint32_t tile_size;     ///< rows and columns of the cells that a lattice is cut into for its tiles: 8, 16,
                            ///< 32, 64, 128 or 256; 0, the default: by plan, the smallest whose matrix is
                            ///< cheap beside the rest. (Springs at random between 40,000 particles make two
                            ///< tiles of size 256: there they help little, and little help is needed.)
    uint32_t coarse_period; ///< substeps from one factorisation of the tiles' matrix to the next, at most 10000:
                            ///< more are cheaper, and good as long as the network does not turn far in them; 0, the
                            ///< default: 1
} mspring_solver_def;

/// Instruction sets. All give the same bits. Those of one kind of CPU stand in order, scalar below all of them:
/// scalar < SSE2 < AVX2 < AVX-512 on x86, scalar < NEON on 64-bit ARM, scalar < WASM in a browser, scalar alone
/// elsewhere. Between kinds there is no order.
typedef enum mspring_simd {
    MSPRING_SIMD_AUTO = 0, ///< the best that CPU and operating system offer
    MSPRING_SIMD_SCALAR = 1,
    MSPRING_SIMD_SSE2 = 2,
    MSPRING_SIMD_AVX2 = 3,
    MSPRING_SIMD_AVX512 = 4,
    MSPRING_SIMD_NEON = 5,
    MSPRING_SIMD_WASM = 6, ///< SIMD128 of WebAssembly, in modules that were built with it
    MSPRING_SIMD_INT = MSPRING_ENUM_INT ///< no value
} mspring_simd;

/// Flags of networks.
enum {
    MSPRING_NETWORK_RESERVE_DAMPING = 1u << 0, ///< springs may be given damping later, though none has any now
    MSPRING_NETWORK_RESERVE_RELATIVE = 1u << 1, ///< relative springs may be added later, though there is none now
    /// The second words of positions count in the lengths of springs, too. Use it for stiff springs whose forces
    /// single precision cannot tell apart: 6.76e7 N/m between masses of 73.4 kg, 900 m from the local origin,
    /// tremble at up to 3 m/s without it and 0.002 m/s with it. Explicit steps take 1.1 to 1.3 times as
    /// long (bench/RESULTS.md). The implicit and the direct solver always count these words. What springs break at
    /// and what stress is made of are strains of the first words: at 900 m right to 6e-5 in a spring of 1 m.
    MSPRING_NETWORK_PRECISE = 1u << 2
};

/// What a step does beside refusing to end with a coordinate or speed that is not finite or out of bounds.
typedef enum mspring_guard {
    /// Refuse a step whose substeps are above the border of mspring_network_stable_dt(): motion would turn round
    /// and grow in each. The border is looked at before a step whose substep is another one, and after a step that
    /// changes a velocity twice as much as one did at the last look. It is never looked at where substeps are
    /// stable in any shape. Steps below the border are never refused. A look first bounds the border, by a pass
    /// over the springs. If that does not answer it, it searches for a motion that grows, for as long as a part of
    /// the step's substeps takes. What such a search overlooks is found once it has grown to a thousandth of the
    /// shortest spring in a substep: that step is refused. Up to 0.95 of the border a step of 8 or more substeps
    /// takes at most twice its usual time, and the first one at most three times; closer to it, three and four.
    /// Watching velocities takes 2 to 3 % of a step of one substep, less than 0.5 % of one of 8
    /// (bench/STABILITY.md).
    ///
    /// The implicit and the direct solver keep an energy budget instead, of each component (all that live springs join)
    /// in each substep. Kinetic and elastic energy grow by no more than the work of gravity, forces and moving pins. A
    /// floor takes energy and gives none. A free component, with no pinned particle and no impulse from the floor,
    /// keeps momentum and angular momentum but for what gravity, forces and global damping do. Its budget is counted
    /// about its mass centre. What would be too much is taken out of the velocities beside its rigid motion. If that
    /// is more than a thousandth of its energy, the substep is taken again (see mspring_integrator). If even a 32nd of
    /// a substep is too long, the component goes only a part of its way in it. No step is refused for its energy.
    /// In each substep the springs may have a millionth more than the budget, and what rounding adds: that of lengths,
    /// 5e-17 k l^2 a spring, and on a floor 1e-12 m g times the distance from the local origin.
    MSPRING_GUARD_GROWTH = 0,
    /// The same, but take a step that would be refused again with twice as many substeps, four times as many, and
    /// so on up to max_substeps. Later steps keep the number that was needed, until mspring_network_set_solver().
    /// Hooks are called again. Relative springs follow the substep, so more of them are no help there.
    MSPRING_GUARD_RETRY = 1,
    MSPRING_GUARD_BOUNDS = 2, ///< look at nothing else
    /// As MSPRING_GUARD_GROWTH, but have the implicit solver take a step that would be refused, in one substep of
    /// implicit Euler, and the 15 after it, before the explicit one is tried again: slower (29 to 42 explicit
    /// substeps each) and softened, but at nearly any stiffness. Hooks are called again. Its memory is reserved
    /// with the network. mspring_step_info says how often that was.
    MSPRING_GUARD_IMPLICIT = 3,
    /// As MSPRING_GUARD_GROWTH, but take a step that would be refused with strain rates clamped and, unless the
    /// solver is an implicit one, the 15 after it: in as many substeps, or a hundredth of max_substeps if these are
    /// too few for MSPRING_SUBSTEPS_AUTO. In each of them springs act one after another in the order of their ids, and
    /// back again, by impulses along them. None changes the rate at which its spring is strained by more than what
    /// takes it to its rest length by the end of the substep, or its damper's by more than what brings it to rest.
    ///
    /// Unphysical: a spring is as stiff as its ends and the substep allow and not more (about mu / h^2, see
    /// MSPRING_SPRING_RELATIVE), so what is stiff turns soft, the more so the more springs stand in line; motion
    /// along springs is damped as by implicit Euler; and which spring has which id makes a difference. Small motion
    /// about any shape does not grow, however stiff, damped or unequal springs and masses are; momentum is
    /// conserved but for rounding, angular momentum only about. A step that ends out of bounds all the same is
    /// refused. Works on one thread, at 30 to 160 explicit substeps for each substep; needs no memory. Hooks are
    /// called again. mspring_step_info says how often that was.
    MSPRING_GUARD_CLAMP = 4,
    /// Look at nothing, and put back what ends out of bounds, instead of refusing the step. A speed becomes
    /// max_speed at most, a local coordinate MSPRING_MAX_COORDINATE. A particle with a number that is not finite
    /// goes back to where it was before the step, or to the local origin if it was nowhere, and stands still. So
    /// what explodes stays bounded, but is no physics any more. No step fails with MSPRING_ERROR_UNSTABLE: with
    /// MSPRING_SUBSTEPS_AUTO one that needs more than max_substeps takes max_substeps. Hooks may see what is out of
    /// bounds while the step lasts. After a step that put something back floor impulses are those of the step
    /// before, and an implicit solver begins a new history.
    MSPRING_GUARD_CLAMP_BOUNDS = 5,
    MSPRING_GUARD_INT = MSPRING_ENUM_INT ///< no value
} mspring_guard;

/// What may change at any time: see mspring_network_set_settings(). mspring_settings_init() fills in what a network
/// has by default.
typedef struct mspring_settings {
    uint32_t struct_size;
    mspring_guard guard;  ///< what a step does beside checking bounds
    float gravity_x;      ///< m/s^2, finite
    float gravity_y;      ///< m/s^2, finite
    float global_damping; ///< 1/s, 0 to 1e6: velocities decay by exp(-global_damping t), whatever the step
    float max_speed;      ///< m/s, > 0 and at most 1e15: a step that ends with a particle faster than this in
                          ///< x or y is refused with MSPRING_ERROR_UNSTABLE
    float sleep_speed;    ///< m/s, 0 to 1e15: an island sleeps once none of its particles has been faster in x or y
                          ///< at the end of a step for sleep_time, see mspring_network_is_asleep(). 0: never
    float sleep_time;     ///< s of simulated time, 0 to 1e6
    float relax_fraction; ///< 0 to 1: a stressed spring relaxes below this fraction of its stress strain. The
                          ///< lower, the longer it stays stressed; at 0 for ever. 0.8 in a new network
} mspring_settings;

/// A network at the start. Fill with mspring_network_def_init() first.
typedef struct mspring_network_def {
    uint32_t struct_size;
    mspring_simd simd_level; ///< highest level to use; default MSPRING_SIMD_AUTO. A level that this machine lacks,
                             ///< such as one of another kind of CPU, is no limit, so one program may ask for
                             ///< at most AVX2 on x86 and run on ARM, too. MSPRING_SIMD_SCALAR is the lowest level
                             ///< that this build has. The environment variable MSPRING_SIMD
                             ///< (scalar, sse2, avx2, avx512, neon, wasm) can lower it further, never raise.
    float gravity_x;         ///< as in mspring_settings; default 0
    float gravity_y;         ///< as in mspring_settings; default -9.8
    float global_damping;    ///< as in mspring_settings; default 0
    float max_speed;         ///< as in mspring_settings; default 1e6
    mspring_solver solver;   ///< default MSPRING_SOLVER_EXPLICIT; its other settings are those of
                             ///< mspring_solver_def_init()
    uint32_t substeps;       ///< as in mspring_solver_def; default MSPRING_SUBSTEPS_AUTO
    const mspring_allocator *allocator; ///< default NULL: malloc and free
    const mspring_tasks *tasks; ///< the host's threads; default NULL: threads of the library, if worker_count asks
    uint32_t worker_count;      ///< threads that step the network, the caller's being one of them, 1 to
                           ///< MSPRING_MAX_WORKERS; default 1. The others are started with the network, end with
                           ///< it, take no signals, and sleep between steps. One for each core is the most that
                           ///< helps. With tasks, whose number counts, this is not looked at.
    uint32_t flags;        ///< bits of MSPRING_NETWORK_; default 0
    uint32_t max_substeps; ///< as in mspring_solver_def; default 1000
    mspring_guard guard;   ///< as in mspring_settings; default MSPRING_GUARD_CLAMP: a step that is too long for
                           ///< the springs is made all the same, see there
    float sleep_speed;     ///< as in mspring_settings; default 0: never
    float sleep_time;      ///< as in mspring_settings; default 0.5
    uint32_t spare_particles; ///< particles that may be added (mspring_network_add_particles()), with those that
                              ///< the builder holds at most MSPRING_MAX_PARTICLES; default 0
    uint32_t spare_springs;   ///< springs that may be added, likewise; default 0. Memory for both is reserved with
                              ///< the network: about 250 bytes for each, and 9 for each spring that the builder
                              ///< holds, or 17 where some are relative.
} mspring_network_def;

/// Fill a definition with its defaults. Pass the size that your header gives it: sizeof *def.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL; MSPRING_ERROR_STRUCT for an impossible size.
/// @threads any   @allocates never   @since 0.2
MSPRING_API mspring_result MSPRING_CALL mspring_allocator_init(mspring_allocator *allocator, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_tasks_init(mspring_tasks *tasks, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_particle_def_init(mspring_particle_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_spring_def_init(mspring_spring_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_material_init(mspring_material *material, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_lattice_def_init(mspring_lattice_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_rope_def_init(mspring_rope_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_mesh_def_init(mspring_mesh_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_disc_def_init(mspring_disc_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_solver_def_init(mspring_solver_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_settings_init(mspring_settings *settings, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_network_def_init(mspring_network_def *def, size_t size);

/// Fill a material with what looks like steel, wood, rubber or jelly at this substep.
///
/// Springs are relative, so a lattice of presets is stable at any dt, in any shape. Mass is that of a plate of 1 m
/// thickness. Stiffness is that of the real material, if substeps are short enough for it. With c the speed of sound
/// along a bar, c^2 = (Young's modulus) / density, a lattice with relative stiffness s has
///     c = spacing / substep * sqrt(3 s / 4)
/// and s is at most the limit below. Then a bar bends more than the real one: use shorter substeps or a larger
/// spacing.
///
///     preset   kg/m^2   c, m/s   largest s   damping ratio
///     steel      7850     5000       0.4         0.01
///     wood        600     4000       0.2         0.03
///     rubber     1100       40       0.05        0.1
///     jelly      1000        4       0.01        0.1
///
/// A level bar that is clamped at one end bends under its own weight. With n springs in a row and m in a column, its
/// free end sinks by 1.5 gravity n^4 spacing^2 / (c^2 m (m + 1)), if that is small beside its length.
/// @param material  filled whole, struct_size, too
/// @param size      sizeof *material
/// @param spacing   m, 1e-9 to 1e9, as in mspring_lattice_def
/// @param substep   s, 1e-12 to 1e6: dt / substeps
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL, an unknown preset or a value out of range;
///         MSPRING_ERROR_STRUCT for an impossible size. On error nothing changes.
/// @threads any   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_material_preset(mspring_material *material, size_t size, mspring_preset preset, double spacing,
    double substep);

/* ------------------------------------------------------------------------------------------------ builder */

/// Collects particles and springs. It can make any number of networks and is not needed after that.
typedef struct mspring_builder mspring_builder;

/// Make an empty builder.
/// @param allocator  NULL for malloc and free; copied
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_STRUCT or MSPRING_ERROR_MEMORY.
/// @threads any   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_create(const mspring_allocator *allocator, mspring_builder **builder);

/// Free a builder. NULL is allowed.
/// @threads exclusive access to builder   @allocates never   @since 0.2
MSPRING_API void MSPRING_CALL mspring_builder_destroy(mspring_builder *builder);

/// What was wrong with the last call on this builder, naming the culprit; "" if that call succeeded. Belongs to the
/// builder, valid until the next call on it. NULL gives "". Print the result's name first: mspring_result_string().
/// @threads shared   @allocates never   @since 0.2
MSPRING_API const char *MSPRING_CALL mspring_builder_error(const mspring_builder *builder);

/// Number of particles and springs added so far. NULL gives 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_builder_particle_count(const mspring_builder *builder);
MSPRING_API uint32_t MSPRING_CALL mspring_builder_spring_count(const mspring_builder *builder);

/// Add one particle.
/// @param id  receives its id; may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_STRUCT, MSPRING_ERROR_LIMIT, MSPRING_ERROR_MEMORY.
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_particle(mspring_builder *builder, const mspring_particle_def *def, mspring_id *id);

/// Add many particles: all of them or, on error, none.
/// @param defs      [count], all with the same struct_size
/// @param first_id  receives the id of the first; the others follow; may be NULL
/// @return as mspring_builder_add_particle(); the error message names the index.
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_particles(mspring_builder *builder, const mspring_particle_def *defs, uint32_t count,
    mspring_id *first_id);

/// Add one spring between particles that were added before.
/// @param id  receives its id; may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_ID for a particle that does not exist; MSPRING_ERROR_ARGUMENT for a value
///         out of range, a spring from a particle to itself, or a rest length to be taken from the distance of
///         two particles in the same place; MSPRING_ERROR_STRUCT, MSPRING_ERROR_LIMIT, MSPRING_ERROR_MEMORY.
///         A second spring between the same two particles is found by mspring_network_create().
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_spring(mspring_builder *builder, const mspring_spring_def *def, mspring_id *id);

/// Add many springs: all of them or, on error, none. As mspring_builder_add_particles().
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_springs(mspring_builder *builder, const mspring_spring_def *defs, uint32_t count,
    mspring_id *first_id);

/// Add a lattice: all of it or, on error, nothing. Particle ids follow the cells, row by row from the top, left
/// to right, empty cells left out. Spring ids follow the particles; each brings those to its right, lower left,
/// lower and lower right neighbour, in this order, where they exist. Bend springs follow behind all others; each
/// particle brings those to its right and below.
/// @param cell_ids  [height][width], receives each cell's particle id or MSPRING_NONE; may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT (the message names cell or material), MSPRING_ERROR_STRUCT,
///         MSPRING_ERROR_LIMIT, MSPRING_ERROR_MEMORY.
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_lattice(mspring_builder *builder, const mspring_lattice_def *def, mspring_id *cell_ids);

/// Add a rope: all of it or, on error, nothing. Ids of particles and of springs follow the rope from its first
/// end to its second.
/// @param particles     [capacity] receives the ids along the rope, both ends included, as many as fit; may be NULL
///                      if capacity is 0
/// @param capacity      segment_count + 1 for all of them
/// @param first_spring  receives the id of the first spring; may be NULL
/// @return as mspring_builder_add_spring()
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_rope(mspring_builder *builder, const mspring_rope_def *def, mspring_id *particles,
    uint32_t capacity, mspring_id *first_spring);

/// Add a mesh of triangles: all of it or, on error, nothing. Particle ids follow the vertices. Spring ids follow the
/// triangles: each brings those of its edges 0-1, 1-2 and 2-0 that no triangle before it has.
/// @param first_particle  receives the id of vertex 0; may be NULL
/// @param first_spring    receives the id of the first spring; may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for a value out of range, a triangle without area or with a vertex
///         that there is not, or a vertex of no triangle (the message names it); MSPRING_ERROR_STRUCT,
///         MSPRING_ERROR_LIMIT, MSPRING_ERROR_MEMORY.
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_mesh(mspring_builder *builder, const mspring_mesh_def *def, mspring_id *first_particle,
    mspring_id *first_spring);

/// Add a disc: all of it or, on error, nothing. Particle ids go from the centre outwards, ring by ring, each ring
/// counter-clockwise from the right. So the rim is the last 6 * ring_count particles.
/// @param first_particle, first_spring  as of mspring_builder_add_mesh(); the first particle is the centre
/// @return as mspring_builder_add_mesh()
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_disc(mspring_builder *builder, const mspring_disc_def *def, mspring_id *first_particle,
    mspring_id *first_spring);

/* ---------------------------------------------------------------------------------------------- lifecycle */

/// A network: its topology and its state.
typedef struct mspring_network mspring_network;

/// Make a network of what the builder holds. Reads the builder once, finds the lattices and chains in it from
/// positions and springs (whatever the order they were added in), and lays the state out for them: see
/// mspring_plan. On failure the builder's error message says why.
/// @param def  settings; NULL for the defaults
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT if the builder has no particle or a setting is out of range;
///         MSPRING_ERROR_DUPLICATE if two springs join the same two particles; MSPRING_ERROR_THREAD if a worker
///         cannot be started; MSPRING_ERROR_STRUCT, MSPRING_ERROR_LIMIT, MSPRING_ERROR_MEMORY.
/// @threads exclusive access to builder   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_create(mspring_builder *builder, const mspring_network_def *def, mspring_network **network);

/// Add what a network holds now to a builder: to store it, to merge networks, or to split one.
///
/// Adds particles with position, velocity, mass and pin, and the springs between them that are not broken. Springs
/// have rest length, stiffness and damping of now (nominal ones, fractions if relative). A spring on a ramp keeps the
/// rest length that it has now. Break, stress and relax strains are taken over. Not added: whether a spring is
/// stressed, settings, solver, floor, hooks, forces, events.
/// An inverse mass scale becomes 1, or a pin if it is 0. Both kinds of id keep their order.
///
/// A network that is created from the builder starts where the other is, but for the rounding of positions: its local
/// origin may be another. If the other has not moved since it was created from the same particles and springs, both
/// have the same bits, and so have their steps with the same settings.
/// @param particles     [count] the particles to add, in any order; NULL for all
/// @param count         0 if particles is NULL
/// @param particle_ids  [particle count of the network] receives the builder's id of each, MSPRING_NONE if it was not
///                      added; may be NULL
/// @param spring_ids    [spring count of the network] likewise
/// @return MSPRING_OK; MSPRING_ERROR_ID for a particle that does not exist; MSPRING_ERROR_ARGUMENT for NULL or a
///         particle out of bounds (the builder's message names it); MSPRING_ERROR_LIMIT, MSPRING_ERROR_MEMORY. On
///         error nothing is added.
/// @threads exclusive access to builder, shared for network   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_builder_add_network(mspring_builder *builder, const mspring_network *network, const mspring_id *particles,
    uint32_t count, mspring_id *particle_ids, mspring_id *spring_ids);

/// Free a network. NULL is allowed. Must not be called from a hook.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_API void MSPRING_CALL mspring_network_destroy(mspring_network *network);

/// Flags of mspring_clone_def.
enum {
    /// The clone has the original's hooks, too, with their user pointers and storage, so what these point to is
    /// shared by both.
    MSPRING_CLONE_HOOKS = 1u << 0
};

/// What a clone is to have of its own. Fill with mspring_clone_def_init() first.
typedef struct mspring_clone_def {
    uint32_t struct_size;
    uint32_t flags;                     ///< MSPRING_CLONE_HOOKS or 0; default 0: no hooks
    const mspring_allocator *allocator; ///< default NULL: as the original's, with the same user
    const mspring_tasks *tasks;         ///< as in mspring_network_def; default NULL
    uint32_t worker_count;              ///< as in mspring_network_def; default 1, whatever the original has
    uint32_t reserved;                  ///< 0
} mspring_clone_def;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @since 0.2
MSPRING_API mspring_result MSPRING_CALL mspring_clone_def_init(mspring_clone_def *def, size_t size);

/// Make a network that is as this one is now, and independent of it: to try out what would happen, to go back to,
/// or to be stepped by another thread. It holds everything that the following steps depend on (solver with its
/// history, settings, edits, ramps, forces given for the next step) and what is measured of them (thresholds,
/// components, events not read yet), so the same calls on both give the same bits. Workers it has its own, hooks
/// none, unless def says otherwise; and a compaction that has begun is not in it.
///
/// Takes as long as copying mspring_network_memory_used() bytes into memory that is new, which most systems hand
/// out more slowly than it is copied. Where a state is to be kept and brought back often, mspring_network_save()
/// and mspring_network_load() need less.
/// @param def    NULL for the defaults
/// @param clone  receives the clone, to be freed by mspring_network_destroy()
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL, unknown flags, workers that are out of range, or more
///         workers than the original has where hooks have storage; MSPRING_ERROR_STRUCT; MSPRING_ERROR_MEMORY;
///         MSPRING_ERROR_THREAD if a worker cannot be started; MSPRING_ERROR_BUSY in a hook.
/// @threads shared   @allocates yes, with the clone's allocator   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_clone(const mspring_network *network, const mspring_clone_def *def, mspring_network **clone);

/// What was wrong with the last call on this network that needs exclusive access; as mspring_builder_error().
/// Functions marked shared report by their result alone, so that several threads may call them: they leave this text
/// as it is. So does a call from inside a concurrent hook.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API const char *MSPRING_CALL mspring_network_error(const mspring_network *network);

/// Number of particles and springs, those that were removed still counted: all ids are below. NULL gives 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_network_particle_count(const mspring_network *network);
MSPRING_API uint32_t MSPRING_CALL mspring_network_spring_count(const mspring_network *network);

/// Choose how the following steps are made. The state goes on from where it is. The solver that there is, with the
/// settings that it has, changes nothing and wakes nobody.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, also for a solver that this build lacks (see mspring_features());
///         MSPRING_ERROR_STRUCT, MSPRING_ERROR_MEMORY or MSPRING_ERROR_BUSY;
///         MSPRING_ERROR_LIMIT if the direct solver's factor would take over 2^27 numbers, or the implicit one's
///         tiles, of the size asked for, are so tied to each other that factoring their matrix would take over 2^34
///         multiply-adds (the message says how many there would be). On error the solver is the one of before.
/// @threads exclusive access to network   @allocates for an implicit or direct solver, unless only substeps,
///         iterations or coarse_period differ from the one of before   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_solver(mspring_network *network, const mspring_solver_def *def);

/// Read the solver and its settings, as they were set: to set them again changes nothing. Set struct_size first.
///
/// After steps with MSPRING_GUARD_RETRY, substeps is the number that the next step begins with. Numbers that were
/// left to the library as 0 may come back as the ones in use. What a solver does not use has its default.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT or MSPRING_ERROR_STRUCT.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_solver(const mspring_network *network, mspring_solver_def *def);

/// Read the settings that the next step uses. Set struct_size first.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT or MSPRING_ERROR_STRUCT.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_settings(const mspring_network *network, mspring_settings *settings);

/// Set all settings or, on error, none. To change one, get them, change it and set them:
///
///     mspring_settings settings = {.struct_size = sizeof settings};
///     (void)mspring_network_get_settings(network, &settings);
///     settings.gravity_y = -1.6f;
///     if (mspring_network_set_settings(network, &settings) != MSPRING_OK) ...
///
/// A value that is what it was changes nothing. Another gravity, sleep_speed, sleep_time or relax_fraction wakes
/// all islands. After another guard, the next step looks at the border of stability, if that guard does so at all.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT (the message names the field and its value), also for a guard whose
///         solver this build lacks; MSPRING_ERROR_STRUCT, MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network
/// @allocates what a guard or sleep needs, the first time that the network has it   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_settings(mspring_network *network, const mspring_settings *settings);

/* --------------------------------------------------------------------------------------------------- step */

/// Evolve the network by dt.
///
/// A step that would end with a coordinate or speed that is not finite or out of bounds (MSPRING_MAX_COORDINATE,
/// mspring_settings.max_speed), or in which the scheme itself makes motion grow (mspring_guard), is taken back:
/// the state is the one of before the step, bit for bit, and forces given for it are still there. The error message
/// and mspring_step_info name a particle or a spring. Use a shorter dt, more substeps or a lower stiffness.
/// @param dt  seconds, finite, > 0, and long enough that dt / substeps is a normal float
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_UNSTABLE, MSPRING_ERROR_BUSY; in a child of fork()
///         MSPRING_ERROR_THREAD if a worker cannot be started again.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_step(mspring_network *network, double dt);

/// Whether the network sleeps, all of it: 1 or 0. NULL gives 0.
///
/// In a network that may sleep (mspring_settings.sleep_speed) every island does so by itself: particles that
/// hang together by springs that are not broken (mspring_network_update_components()), or one without springs. It
/// falls asleep at the end of a step, once every particle of it has been slow for long enough, no pinned one moves
/// and none of its springs is on a ramp. Its velocities are set to 0 then, so what was left of its kinetic energy
/// is gone. While it sleeps steps do not move it, and cost what is awake: blocks of 16 slots without a particle
/// that is awake are left out, so islands that share their rows with others, as the pieces of one lattice do, save
/// most after mspring_network_compact(). If all sleep, with no hooks and no forces, a step costs next to nothing.
/// The explicit solver moves what is awake, bit by bit, as if nothing slept; the implicit one leaves sleepers out
/// of its system, which changes the last digits; the direct one holds them, but saves no time.
///
/// An island wakes before or in the step that finds something changed: a position, velocity, mass or pin of its
/// that is another one (set by a call or through a view; by a hook, which wakes it at the end of the step); a
/// stiffness, damping, rest length or threshold of its that was set, a spring of its that was broken, or one that
/// joins it to another island restored; a force from outside that differs from the one under which it fell asleep,
/// so much that it would bring its particle to sleep_speed within sleep_time. All wake when solver, floor or these
/// settings change: gravity, relax_fraction, sleep_speed, sleep_time. So they do with the length of the substep
/// where springs are relative, with mspring_network_renew_relative_springs(), when the host sets positions that
/// move the local origin, and when particles or springs are added or removed. Hooks are called as ever; the forces
/// of those before substeps are looked at in the first of a step. The implicit solver's history of an island is
/// that of one at rest; of a network that slept as a whole, none.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_network_is_asleep(const mspring_network *network);

/// Which of the particles first ... first + count - 1 sleep. Those whose positions, velocities or masses were set
/// since, or written through a view, still do until the next step.
/// @param asleep  [count], receives 1 or 0
/// @return MSPRING_OK; MSPRING_ERROR_ID if there are not so many; MSPRING_ERROR_ARGUMENT for NULL.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_sleepers(const mspring_network *network, mspring_id first, uint32_t count, uint8_t *asleep);

/// Wake all of a network. It has to be still for sleep_time again before it sleeps, and so has what is awake
/// already.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL; MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_wake(mspring_network *network);

/// How a step was made: flags of mspring_step_info.
enum {
    MSPRING_STEP_FALLBACK = 1u << 0, ///< the implicit solver took it, in one substep (MSPRING_GUARD_IMPLICIT)
    MSPRING_STEP_CLAMPED = 1u << 1,  ///< strain rates were clamped (MSPRING_GUARD_CLAMP)
    MSPRING_STEP_PUT_BACK = 1u << 2, ///< particles were put back into the bounds (MSPRING_GUARD_CLAMP_BOUNDS)
    MSPRING_STEP_RETRIED = 1u << 3,  ///< it took more substeps than were set (MSPRING_GUARD_RETRY)
    MSPRING_STEP_ASLEEP = 1u << 4    ///< all of the network slept: nothing was computed
};

/// What the last step did, and all steps so far. Set struct_size first.
typedef struct mspring_step_info {
    uint32_t struct_size;
    mspring_result result; ///< of the last step; MSPRING_OK before the first
    mspring_id particle;   ///< why the last step was rejected, or would have been without its guard: the particle,
    mspring_id spring;     ///< and the spring. MSPRING_NONE for what is not to blame
    uint32_t flags;        ///< of the last step: MSPRING_STEP_FALLBACK and so on
    uint32_t substeps;     ///< of the last step that succeeded; 0 before
    uint64_t step_count;   ///< steps that have succeeded
    uint64_t fallback_count; ///< of these with MSPRING_STEP_FALLBACK or MSPRING_STEP_CLAMPED
    double time;             ///< simulated time of these, s
    double largest_speed;    ///< of a particle now, m/s
} mspring_step_info;

/// Read what the last step did. Takes a pass over the velocities.
///
/// Snapshots and clones have step_count, fallback_count, time and substeps. After loading one, result, particle,
/// spring and flags are those of a new network. In hooks they are of the step before.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT or MSPRING_ERROR_STRUCT.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_step_info(const mspring_network *network, mspring_step_info *info);

/* --------------------------------------------------------------------------------------- forces and hooks */

/// Add a force (N) to one particle. It acts during the whole of the next step and is gone after it.
/// @return MSPRING_OK; MSPRING_ERROR_ID; MSPRING_ERROR_ARGUMENT if it is not finite or not with the forces given
///         before; MSPRING_ERROR_MEMORY; MSPRING_ERROR_BUSY (in a hook use its force arrays).
/// @threads exclusive access to network   @allocates at the first force given to a network   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_apply_force(mspring_network *network, mspring_id particle, float x, float y);

/// Add forces to the particles first ... first + count - 1: to all or, on error, to none.
/// @param x, y    N: those on particle first + i are x[i * stride] and y[i * stride]
/// @param stride  elements from one to the next: 1 for two arrays, 2 with y = x + 1 for one of vectors, 0 for the
///                same on all
/// @return as mspring_network_apply_force(); the message names the particle.
/// @threads exclusive access to network   @allocates at the first force given to a network   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_apply_forces(mspring_network *network, mspring_id first, uint32_t count, const float *x,
    const float *y, uint32_t stride);

/// Add forces to listed particles, as mspring_network_apply_forces(). The forces on an id that repeats add up.
/// @param x, y  N: those on particles[i] are x[i * stride] and y[i * stride]
/// @threads exclusive access to network   @allocates at the first force given to a network   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_apply_forces_at(mspring_network *network, const mspring_id *particles, uint32_t count,
    const float *x, const float *y, uint32_t stride);

/// Change velocities by impulses (N s) at once: by impulse times inverse mass. All change or, on error, none.
/// A pinned particle ignores its impulse. An inverse mass scale counts, as it does for forces.
/// @param x, y, stride  as of mspring_network_apply_forces()
/// @return MSPRING_OK; MSPRING_ERROR_ID; MSPRING_ERROR_ARGUMENT if an impulse is not finite or a velocity would not
///         be within MSPRING_MAX_SPEED (the message names the particle); MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_apply_impulses(mspring_network *network, mspring_id first, uint32_t count, const float *x,
    const float *y, uint32_t stride);

/// Change velocities of listed particles by impulses, as mspring_network_apply_impulses(). The impulses on an id
/// that repeats add up.
/// @param x, y  N s: those on particles[i] are x[i * stride] and y[i * stride]
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_apply_impulses_at(mspring_network *network, const mspring_id *particles, uint32_t count,
    const float *x, const float *y, uint32_t stride);

/// When a hook is called. A hook with a period n (see mspring_hook_def) has the substeps of each step taken in
/// groups of n, of which the last may be smaller, and is called once for each group: before its first substep, or
/// after its last. Every step begins a new group.
typedef enum mspring_phase {
    MSPRING_PHASE_BEFORE_STEP = 0,    ///< once; may change x, y, vx, vy; forces it adds act all through the step
    MSPRING_PHASE_BEFORE_SUBSTEP = 1, ///< adds forces for this group of substeps; must not change x, y, vx, vy
    MSPRING_PHASE_AFTER_SUBSTEP = 2,   ///< may change x, y, vx, vy: collisions; there are no force arrays
    MSPRING_PHASE_INT = MSPRING_ENUM_INT ///< no value
} mspring_phase;

/// What a hook gets: arrays by slot, of which it is to handle first_slot ... first_slot + slot_count - 1. Some
/// slots hold no particle: there particle_of_slot is MSPRING_NONE, and what a hook writes is ignored as long as it
/// is within the bounds of a step.
typedef struct mspring_hook_args {
    uint32_t struct_size;
    mspring_phase phase;
    uint32_t substep, substep_count; ///< 0 ... substep_count - 1: the first of its group or, in the phase after it,
                                     ///< the last; before the step 0
    uint32_t first_slot, slot_count; ///< whole blocks, see mspring_plan; spare slots behind those in use are left out
    double dt;                 ///< time that the call stands for: the step's or, of a group of substeps, theirs, s
    double origin_x, origin_y; ///< world position = origin + (x, y)
    float *x, *y, *vx, *vy;    ///< m, relative to the origin; m/s
    float *force_x, *force_y;  ///< N: add to them; NULL after a substep
    const float *inverse_mass; ///< 1/kg; 0 if pinned or no particle
    const uint32_t *particle_of_slot, *slot_of_particle; ///< as in mspring_view
    const mspring_network *network;                      ///< for shared calls
    uint32_t group_count; ///< substeps in the group, 1 ... period; before the step 1
    uint32_t worker;      ///< who calls: below mspring_network_worker_count(); no two calls at a time have the same
    void *storage;        ///< this worker's, see mspring_hook_def; else NULL
    const void *reserved; ///< NULL
} mspring_hook_args;

/// A hook. It must not call functions on the network but those marked shared.
typedef void (MSPRING_CALL *mspring_hook_fn)(const mspring_hook_args *args, void *user);

/// Flags of hooks.
enum {
    /// The slots are divided into ranges, and the hook is called for each of them, perhaps for several at the same
    /// time on different workers, in any order. It must read and write only its range's slots, and what is written
    /// by none. If what it does to a slot depends on nothing but that slot and what is the same for all calls, the
    /// network's state is the same, bit for bit, for any number of workers and any range.
    MSPRING_HOOK_CONCURRENT = 1u << 0
};

/// A hook's definition. Fill with mspring_hook_def_init() first.
typedef struct mspring_hook_def {
    uint32_t struct_size;
    mspring_phase phase;  ///< default MSPRING_PHASE_BEFORE_STEP
    mspring_hook_fn fn;   ///< must be set
    void *user;           ///< handed to fn; default NULL
    uint32_t period;      ///< substeps in a group, at least 1, of a hook before the step 1; default 1. Forces of a
                          ///< hook before a group act unchanged in all its substeps. Between calls of hooks several
                          ///< substeps are taken at once, so a step with a long period is faster.
    uint32_t flags;       ///< MSPRING_HOOK_CONCURRENT or 0; default 0: one call, on the thread that steps
    uint32_t range_slots; ///< with MSPRING_HOOK_CONCURRENT, slots in a range, rounded up to whole blocks; default
                          ///< 0: one range for each worker, or fewer if the network is small
    uint32_t reserved;    ///< 0
    void *storage; ///< [mspring_network_worker_count()][storage_stride] bytes of the host, for each worker its
                   ///< own, such as a sum to be added up after the step; default NULL
    size_t storage_stride; ///< bytes from one worker's to the next's, best a multiple of 64; default 0
} mspring_hook_def;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL; MSPRING_ERROR_STRUCT for an impossible size.
/// @threads any   @allocates never   @since 0.2
MSPRING_API mspring_result MSPRING_CALL mspring_hook_def_init(mspring_hook_def *def, size_t size);

/// Have a hook called in every step from now on, after the hooks of its phase that were added before it.
/// @param def   copied
/// @param hook  receives a number for mspring_network_remove_hook(); may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_STRUCT, MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_add_hook(mspring_network *network, const mspring_hook_def *def, uint32_t *hook);

/// Remove a hook. Numbers of removed hooks are not used again.
/// @return MSPRING_OK; MSPRING_ERROR_ID if there is no such hook; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_remove_hook(mspring_network *network, uint32_t hook);

/* -------------------------------------------------------------------------------------------------- floor */

/// Most half-planes of a floor, and most heights.
#define MSPRING_MAX_PLANES 8u
#define MSPRING_MAX_HEIGHTS 0x4000000u

/// What particles cannot get through: half-planes, such as the sides of a box, and a field of heights, such as a
/// sea floor. Fill with mspring_floor_def_init() first.
typedef struct mspring_floor_def {
    uint32_t struct_size;
    uint32_t plane_count; ///< half-planes, at most MSPRING_MAX_PLANES; default 0
    double heights_x;     ///< of the first height, m, world coordinates; default 0
    double heights_y;     ///< of height 0, m, world coordinates; default 0
    double spacing;       ///< m from one height to the next, 1e-9 to 1e9; default 1
    const double *planes; ///< [plane_count][4]: x and y of a point on the border (m, world coordinates), then x and
                          ///< y of a vector of any length across it, towards where particles may be
    const float *heights; ///< [height_count], m above heights_y: joined by straight lines, level beyond both ends;
                          ///< particles may be above
    uint32_t height_count; ///< 0, the default: no field of heights; else 2 to MSPRING_MAX_HEIGHTS
    float friction;        ///< of particles that slide (Coulomb): force along the surface over that across it, 0 to
                           ///< 1e6; default 0
    float restitution;     ///< speed across the surface after contact over that before, 0 to 1; default 0. A bounce
                           ///< that would be over within a substep is none.
    uint32_t reserved;     ///< 0
} mspring_floor_def;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @since 0.2
MSPRING_API mspring_result MSPRING_CALL mspring_floor_def_init(mspring_floor_def *def, size_t size);

/// Give the network a floor instead of the one it has. It acts on every particle that is not pinned, in every
/// substep: a particle that was above it at the beginning is not below it at the end, whatever its speed and
/// however long the substep, but for some last places of its coordinates (a millionth of its distance from the
/// local origin); one that was below is put onto it. Peaks of the heights that are narrower than the way of a
/// particle in a substep are met, too. What cannot come near in a step by the speeds at its beginning, gravity and
/// forces from outside is looked at once, after it: a particle that springs throw from rest onto a floor which is
/// farther away than that lands there, and does not bounce.
///
/// Contact takes energy and gives none. Explicit substeps of h keep E = T(w) + V - h^2/8 sum F^2/m instead of T + V,
/// with w = v + h/2 F/m, as a velocity is that of half a substep ago. That does not grow by contact, at any
/// restitution, as long as no particle goes further than half of the shortest spring in a substep: a network that
/// moves faster is one that the scheme itself makes energy in. It may grow at long substeps and high restitution: by
/// up to a tenth in gentle bounces at 0.8 to 1, from 0.75 of what is stable in any shape on, and on heights without
/// friction at 1, from 0.7 on. Particles with springs are thrown back by at most 1 - (4 h w / l)^2 of their speed w, with
/// l the shortest rest length at creation, so that fast ones bounce less than restitution says. Those without fly
/// along parabolas that are turned where they meet the surface, up to 8 times in a substep, with every solver: at
/// restitution 1 they keep their height. A bounce that would be shorter than a substep is none, nor is one in a corner
/// after these 8 turns. Sliding without friction, at an acceleration a, loses up to (h a)^2/2 J/kg in implicit ones.
///
/// In implicit substeps the floor is part of the linear system: a substep is solved up to four times to find which
/// particles it holds and which of them slide, with twice the iterations; one in which particles hit it is one of
/// implicit Euler, and where they would come deeper than a fifth of the shortest spring it is taken in up to 40
/// pieces. There, and in steps that are clamped, only particles without springs bounce by restitution: a structure is
/// thrown back by its springs.
///
/// The floor is a setting, as gravity is, but too large for snapshots, which leave it as it is; state hashes do not
/// count it. Static equilibria (mspring_network_settle()) do not know of it.
/// @param def  copied with all that it points to; NULL: no floor
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_STRUCT, MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY. On
///         error the floor is the one of before.
/// @threads exclusive access to network   @allocates yes; 20 to 24 bytes for a height and 74 for a particle
/// @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_floor(mspring_network *network, const mspring_floor_def *def);

/// Read the floor as it was set: to set it again changes nothing. Set struct_size first. Without a floor plane_count
/// and height_count are 0. planes and heights are the network's own copies: they are valid until the floor is set
/// again or the network is destroyed.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT or MSPRING_ERROR_STRUCT.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_floor(const mspring_network *network, mspring_floor_def *def);

/// Copy out what momentum (N s) the floor gave to the particles first ... first + count - 1 in the last step: over
/// its length, the mean force. 0 without a floor.
/// @param x, y, stride  as of mspring_network_get_positions()
/// @return MSPRING_OK; MSPRING_ERROR_ID or MSPRING_ERROR_ARGUMENT.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_floor_impulses(const mspring_network *network, mspring_id first, uint32_t count, float *x,
    float *y, uint32_t stride);

/* -------------------------------------------------------------------------------------------------- views */

/// The state as it lies in memory, to read: arrays by slot. Set struct_size first.
///
/// The pointers stay valid, and their contents follow the steps, until layout_generation changes. origin_x and
/// origin_y are as of the call: fill the view again after steps, which costs next to nothing.
typedef struct mspring_view {
    uint32_t struct_size;
    uint32_t slot_count;         ///< length of the arrays by slot; some slots hold no particle
    uint32_t particle_count;     ///< length of slot_of_particle
    uint32_t reserved;           ///< 0
    uint64_t layout_generation;  ///< another number when particles or springs were added or removed, by edits or by
                                 ///< loading a snapshot, and when the network was compacted or expanded
    uint64_t origin_generation;  ///< another number when the origin has moved
    double origin_x, origin_y;   ///< world position = origin + (x, y), m
    const float *x, *y;          ///< [slot_count], m, relative to the origin
    const float *vx, *vy;        ///< [slot_count], m/s
    const float *inverse_mass;   ///< [slot_count], 1/kg; 0 if pinned or no particle
    const uint32_t *particle_of_slot; ///< [slot_count], particle id or MSPRING_NONE
    const uint32_t *slot_of_particle; ///< [particle_count]
    const void *reserved_pointer;     ///< NULL
} mspring_view;

/// Fill a view to read. It makes no later step dearer.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT or MSPRING_ERROR_STRUCT.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_view(const mspring_network *network, mspring_view *view);

/// The same to write: positions and velocities may be changed until the next step. Set struct_size first.
typedef struct mspring_mutable_view {
    uint32_t struct_size;
    uint32_t slot_count, particle_count, reserved; ///< as in mspring_view, as what follows
    uint64_t layout_generation, origin_generation;
    double origin_x, origin_y;
    float *x, *y, *vx, *vy; ///< finite values only, velocities within MSPRING_MAX_SPEED
    const float *inverse_mass;
    const uint32_t *particle_of_slot, *slot_of_particle;
    const void *reserved_pointer;
} mspring_mutable_view;

/// Fill a view to write. The next step looks at all particles for what was written. Before you write after that
/// step, call this again. In a hook use its arrays.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_STRUCT or MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_view_mutable(mspring_network *network, mspring_mutable_view *view);

/// Copy out world positions (m) of the particles first ... first + count - 1, in id order.
/// @param x, y    receive those of particle first + i in x[i * stride] and y[i * stride]
/// @param stride  elements from one to the next, at least 1: 1 for two arrays, 2 with y = x + 1 for one of points
/// @return MSPRING_OK; MSPRING_ERROR_ID if the range leaves the network; MSPRING_ERROR_ARGUMENT for NULL or stride 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_positions(const mspring_network *network, mspring_id first, uint32_t count, double *x,
    double *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_positions_float(const mspring_network *network, mspring_id first, uint32_t count, float *x,
    float *y, uint32_t stride);

/// Copy out velocities (m/s), as mspring_network_get_positions(). They have single precision.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_velocities(const mspring_network *network, mspring_id first, uint32_t count, float *vx,
    float *vy, uint32_t stride);

/// Set world positions (m) of the particles first ... first + count - 1: all or, on error, none. Setting those
/// of all particles at once also moves the local origin to them; setting a part of them leaves it where it is.
/// @param x, y    those of particle first + i are x[i * stride] and y[i * stride], at most MSPRING_MAX_COORDINATE in
///                absolute value and so far from the origin
/// @param stride  as of mspring_network_get_positions(), or 0: the same for all
/// @return MSPRING_OK; MSPRING_ERROR_ID, MSPRING_ERROR_ARGUMENT (the message names the index),
///         MSPRING_ERROR_BUSY (in a hook use its arrays).
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_positions(mspring_network *network, mspring_id first, uint32_t count, const double *x,
    const double *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_positions_float(mspring_network *network, mspring_id first, uint32_t count, const float *x,
    const float *y, uint32_t stride);

/// Set velocities (m/s, within MSPRING_MAX_SPEED), as mspring_network_set_positions(). A pinned particle moves by
/// its velocity.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_velocities(mspring_network *network, mspring_id first, uint32_t count, const float *vx,
    const float *vy, uint32_t stride);

/* --------------------------------------------------------------------------------------------- properties */

/// A property: one float of each particle, or of each spring. mspring_network_set() writes it, mspring_network_get()
/// reads it. The allocation named is that of the first call that changes such a value.
typedef enum mspring_property {
    /// Of a particle, kg, 1e-30 to 1e30, for cargo or water that gets in. A pinned particle keeps its mass. Relative
    /// springs go on with the masses of before until mspring_network_renew_relative_springs().
    /// Allocates if the network has relative springs.
    MSPRING_MASS = 0,
    /// Of a particle, no unit, 0 or 1e-6 to 1, for pins and particles that forces shall move less. It scales the
    /// response to forces, not to gravity: 1 is normal, 0 is pinned. Energy and momentum count the mass alone.
    /// Allocates at the first scale that is neither 0 nor 1.
    MSPRING_INVERSE_MASS_SCALE = 1,
    /// Nominal stiffness of a spring, N/m, 0 to 1e30; of a relative spring its fraction. A broken spring has the new
    /// one when it is restored. Allocates for a relative spring: networks keep fractions once that many springs share.
    MSPRING_STIFFNESS = 2,
    /// Nominal damping of a spring, N s/m, 0 to 1e30; of a relative spring its fraction. Values above 0 need room:
    /// some spring was made with damping, or the network with MSPRING_NETWORK_RESERVE_DAMPING.
    /// Allocates as MSPRING_STIFFNESS.
    MSPRING_DAMPING = 3,
    /// Rest length of a spring, m, > 0 and at most 4e12, for muscles and winches. Writing it ends a ramp of the
    /// spring. Allocates for a spring of a lattice: lattices keep rest lengths once that many springs share.
    MSPRING_REST_LENGTH = 4,
    /// Break strain of a spring, no unit, > 0; MSPRING_NEVER is the default. If the spring's absolute strain is
    /// over it at the end of a step, the spring breaks. Nothing breaks in the middle of a step. Substeps too long to
    /// follow a blow change the strains. Allocates.
    MSPRING_BREAK_STRAIN = 5,
    /// Stress strain of a spring, no unit, > 0; MSPRING_NEVER is the default. If the spring's absolute strain is
    /// over it at the end of a step, the spring is stressed until it relaxes (MSPRING_EVENT_STRESSED). Allocates.
    MSPRING_STRESS_STRAIN = 6,
    /// Relax strain of a spring, no unit, >= 0. A stressed spring relaxes at the end of a step if its absolute strain
    /// is below both its relax strain and its stress strain (MSPRING_EVENT_RELAXED). 0: it stays stressed.
    /// MSPRING_RELAX_STRAIN_DEFAULT, the default: relax_fraction (mspring_settings) of its stress strain.
    /// Allocates.
    MSPRING_RELAX_STRAIN = 7,
    /// Strain of a spring, no unit: (length - rest_length) / rest_length, 0 if it is broken. Read only.
    MSPRING_STRAIN = 8,
    /// Length of a spring, m. Read only.
    MSPRING_LENGTH = 9,
    /// Force along a spring, N, with the share of its damper: > 0 pulls its ends together. Read only.
    MSPRING_FORCE = 10,
    MSPRING_PROPERTY_INT = MSPRING_ENUM_INT ///< no value
} mspring_property;

/// Set a property of the particles or springs first ... first + count - 1.
/// A call sets all values or, on error, none. Ids that were removed are left out. A value that is there already
/// costs a comparison: it wakes nothing, allocates nothing, and is no edit to snapshots.
/// @param values  that of id first + i is values[i * stride]
/// @param stride  floats from one value to the next: 1 for an array, more for a field of structs, 0 for one value
///                for all
/// @return MSPRING_OK; MSPRING_ERROR_ID; MSPRING_ERROR_ARGUMENT for NULL, a property that is unknown or read only,
///         or a value out of range (the message names property, id and value); MSPRING_ERROR_MEMORY,
///         MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates as the property says   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set(mspring_network *network, mspring_property property, mspring_id first, uint32_t count,
    const float *values, uint32_t stride);

/// Set a property of listed particles or springs, as mspring_network_set().
/// @param ids     [count]; an id may repeat: its last value counts. One that was removed is MSPRING_ERROR_ID.
/// @param values  that of ids[i] is values[i * stride]
/// @threads exclusive access to network   @allocates as the property says   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_at(mspring_network *network, mspring_property property, const mspring_id *ids, uint32_t count,
    const float *values, uint32_t stride);

/// Read a property of the particles or springs first ... first + count - 1.
/// @param values  receives that of id first + i in values[i * stride]; 0 for what was removed
/// @param stride  floats from one value to the next, at least 1; what lies between is left alone
/// @return MSPRING_OK; MSPRING_ERROR_ID; MSPRING_ERROR_ARGUMENT for NULL, an unknown property or stride 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get(const mspring_network *network, mspring_property property, mspring_id first, uint32_t count,
    float *values, uint32_t stride);

/// Read a property of listed particles or springs, as mspring_network_get().
/// @param ids     [count]; one that was removed is MSPRING_ERROR_ID
/// @param values  receives that of ids[i] in values[i * stride]
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_at(const mspring_network *network, mspring_property property, const mspring_id *ids,
    uint32_t count, float *values, uint32_t stride);

/* -------------------------------------------------------------------------------------------------- edits */

/// Everything below may be changed between steps, at a cost for each particle or spring that does not depend on the
/// size of the network. Values come for a range of ids (first ... first + count - 1) or, in the functions that end
/// in _at, for a list of ids, which may repeat: then the last value counts. A call sets all of them or, on error,
/// none.

/// Set positions (m, world coordinates) of listed particles; as mspring_network_set_positions().
/// @param x, y  those of particles[i] are x[i * stride] and y[i * stride]
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_positions_at(mspring_network *network, const mspring_id *particles, uint32_t count,
    const double *x, const double *y, uint32_t stride);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_positions_float_at(mspring_network *network, const mspring_id *particles, uint32_t count,
    const float *x, const float *y, uint32_t stride);

/// Set velocities (m/s) of listed particles; as mspring_network_set_velocities().
/// @param vx, vy  those of particles[i] are vx[i * stride] and vy[i * stride]
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_set_velocities_at(mspring_network *network, const mspring_id *particles, uint32_t count,
    const float *vx, const float *vy, uint32_t stride);

/// Derive relative springs from the masses that their particles have now. Takes a pass over all springs.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_renew_relative_springs(mspring_network *network);

/// Break springs: from now on they exert nothing, until they are restored. Their ids, rest lengths and nominal
/// stiffness and damping stay. One that is broken already stays so.
/// @param springs  [count]
/// @return MSPRING_OK; MSPRING_ERROR_ID (the message names the index), MSPRING_ERROR_ARGUMENT,
///         MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates at the first break in a network   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_break_springs(mspring_network *network, const mspring_id *springs, uint32_t count);

/// Restore broken springs to their nominal stiffness and damping. One that is whole stays so.
///
/// With a ramp, a spring's rest length goes from the length that it has now to its own in the course of
/// ramp_seconds of simulated time, evenly from step to step, so that it pulls its ends together instead of kicking
/// them.
/// @param springs       [count]
/// @param ramp_seconds  0 for no ramp, at most 1e6
/// @return as mspring_network_break_springs()
/// @threads exclusive access to network
/// @allocates at the first rest length or ramp in a network, for more ramps at once than there have been, and to
/// expand
///            a compact network of which a spring is restored that its plan leaves out; to spread that over frames,
///            finish a job for MSPRING_LAYOUT_WHOLE before
/// @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_restore_springs(mspring_network *network, const mspring_id *springs, uint32_t count,
    double ramp_seconds);

/// Break all springs of particles, which fly on as loose ones.
/// @param particles  [count]
/// @return as mspring_network_break_springs()
/// @threads exclusive access to network   @allocates at the first break and first detachment in a network
/// @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_detach_particles(mspring_network *network, const mspring_id *particles, uint32_t count);

/* --------------------------------------------------------------------------------- adding and removing */

/// Whether there is such a particle or spring: 1, or 0 if there has never been one or it has been removed. NULL: 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_network_has_particle(const mspring_network *network, mspring_id particle);
MSPRING_API uint32_t MSPRING_CALL mspring_network_has_spring(const mspring_network *network, mspring_id spring);

/// Add particles to a network that has room for them (mspring_network_def.spare_particles): all of them or, on
/// error, none. They are loose ones until springs are added to them, and take the lowest ids that are free: those
/// after the last or, after mspring_network_recycle(), of added particles that were removed.
///
/// A view that was taken before is still valid, but for its particle_count. Nothing else about the network changes.
/// @param defs  [count], positions also within MSPRING_MAX_COORDINATE of the local origin
/// @param ids   [count], receives their ids
/// @return MSPRING_OK; MSPRING_ERROR_LIMIT if there is no room (the message says for how many there is);
///         MSPRING_ERROR_ARGUMENT or MSPRING_ERROR_STRUCT (the message names the definition); MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_add_particles(mspring_network *network, const mspring_particle_def *defs, uint32_t count,
    mspring_id *ids);

/// Add springs between any particles that there are, to a network that has room for them
/// (mspring_network_def.spare_springs): all of them or, on error, none. MSPRING_REST_LENGTH_DISTANCE is the
/// distance that the two have now. They are as all others from then on, and may break, be edited and be restored.
///
/// The plan does not know them. The explicit solver computes them apart, and takes one substep at a time, on one
/// worker, as long as there are any that are not broken; the implicit solver needs some more iterations where they
/// are stiff. mspring_network_compact() takes them into the plan.
/// @param defs  [count]; relative ones and ones with damping only where the network has some, or was created with
///              MSPRING_NETWORK_RESERVE_RELATIVE or MSPRING_NETWORK_RESERVE_DAMPING
/// @param ids   [count], receives their ids: the lowest that are free
/// @return as mspring_network_add_particles(); MSPRING_ERROR_ID for a particle that does not exist;
///         MSPRING_ERROR_DUPLICATE if the two are joined by a spring already, broken or not; MSPRING_ERROR_ARGUMENT
///         with the direct solver, which has to be chosen anew after springs were added; MSPRING_ERROR_MEMORY.
/// @threads exclusive access to network   @allocates if a spring has a break, stress or relax strain of its own, at the
///          first such strain in a network   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_add_springs(mspring_network *network, const mspring_spring_def *defs, uint32_t count,
    mspring_id *ids);

/// Remove particles with all their springs, whether added or there from the beginning. In lists their ids are
/// refused from then on (MSPRING_ERROR_ID); functions on ranges leave them out, and give 0 for what they have no
/// more (the local origin for a position, MSPRING_NONE for a component). Springs that were not broken are told as
/// broken (MSPRING_EVENT_BROKEN, the particle in other).
/// @param particles  [count]
/// @return as mspring_network_break_springs()
/// @threads exclusive access to network
/// @allocates at the first break, detachment and removal in a network   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_remove_particles(mspring_network *network, const mspring_id *particles, uint32_t count);

/// Remove springs, likewise: as breaking them, but for good.
/// @param springs  [count]
/// @return as mspring_network_break_springs()
/// @threads exclusive access to network
/// @allocates at the first break, detachment and removal in a network   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_remove_springs(mspring_network *network, const mspring_id *springs, uint32_t count);

/// Allow that ids of particles and springs that were added and have been removed are given to others from now on:
/// the host has forgotten them, too. Until then they count as used, and so does the room that they took. Ids of
/// those that the network was created with are never given again.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL; MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_recycle(mspring_network *network);

/* ------------------------------------------------------------------------------------------- compaction */

/// Leave springs that are broken out of the plan, so that a wreck costs what is left of it: lattices are swept
/// where squares are left, strands as chains, small trees of one shape side by side, other springs as web, and
/// particles without spring as loose ones. Until then a broken spring costs as much as a whole one. Worth it where
/// a quarter of the springs or more has broken. Springs that were added are taken into the plan, which is worth it
/// where they are to stay.
///
/// Ids, values and thresholds of all springs stay as they are and can be read and set as before. **Slots change**:
/// a view that was taken before is not valid any more, and hooks see other slots. Positions and velocities are
/// moved bit for bit; but forces are summed in another order from then on, so the steps that follow differ in
/// rounding from those of a network that was not compacted. They are the same on every machine, at every level and
/// for any number of workers, as long as the same calls come between the same steps. Small pieces are laid out for
/// the solver that the network has then, the explicit or another: one that is compacted with the other takes no
/// snapshot of it.
///
/// Restoring a spring that was left out takes all springs in again, as mspring_network_expand() does; then the
/// network can be compacted anew.
///
/// A snapshot goes with the plan that there was when it was saved. One from before can only be loaded after
/// mspring_network_expand(), one of the compact network only before that: where slots change, rollback begins anew.
///
/// This call does all of it at once. To spread it over frames, or to do it on another thread, use a job.
/// @return MSPRING_OK, also if there is nothing to do; MSPRING_ERROR_MEMORY or MSPRING_ERROR_LIMIT, after which the
///         network is as it was; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates yes, and frees most   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_compact(mspring_network *network);

/// Take all springs into the plan again, as it was when the network was created: the way back from
/// mspring_network_compact(), with the same consequences for slots and bits. A job that is under way is outdated
/// then.
/// @return MSPRING_OK; MSPRING_ERROR_MEMORY, MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates yes, and frees most   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_expand(mspring_network *network);

/* ------------------------------------------------------------------------------------- strain and events */

/// What an event tells.
typedef enum mspring_event_kind {
    MSPRING_EVENT_BROKEN = 0, ///< spring id broke: at the end of a step, by its strain; or in an edit, with strain
                              ///< 0 and, if that was a detachment, the particle detached in other
    MSPRING_EVENT_STRESSED = 1, ///< the strain of spring id rose over its stress strain
    MSPRING_EVENT_RELAXED = 2,  ///< and fell below its relax strain
    MSPRING_EVENT_RESTORED = 3, ///< spring id was restored
    MSPRING_EVENT_DETACHED = 4, ///< particle id was detached; after the events of its springs
    MSPRING_EVENT_SPLIT =
        5, ///< a component with the lowest particle id has split off the one whose lowest is other
    MSPRING_EVENT_JOINED = 6, ///< the component whose lowest particle was id is now part of the one of other
    MSPRING_EVENT_KIND_INT = MSPRING_ENUM_INT ///< no value
} mspring_event_kind;

/// Something that happened in a step or in an edit. These 16 bytes are all that there will be.
typedef struct mspring_event {
    mspring_event_kind kind;
    mspring_id id;    ///< of a spring or a particle, as the kind has it
    mspring_id other; ///< as the kind has it; else MSPRING_NONE
    float strain;     ///< of the spring when it happened, signed; 0 where the kind has none
} mspring_event;

/// Make room for events, which are not recorded without. Those not read yet are dropped.
/// @param capacity  events that may wait to be read, at most MSPRING_MAX_SPRINGS; 0 to record none any more
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates yes   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_reserve_events(mspring_network *network, uint32_t capacity);

/// Take the oldest events out of the queue, in the order in which they happened; what happened at the end of one
/// step comes in an order that depends on the network alone, the same on every machine.
/// @param events    [capacity]
/// @param capacity  how many to take at most
/// @param count     receives how many there were
/// @param lost      receives how many found the queue full, since room was made for it; may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_read_events(mspring_network *network, mspring_event *events, uint32_t capacity, uint32_t *count,
    uint64_t *lost);

/* --------------------------------------------------------------------------------------------- components */

/// Bring the components up to date. A component is what hangs together by springs that are not broken: a ship, a
/// piece of its wreck, a loose particle. It is named by its lowest particle, which stays when other parts split
/// off, and numbered from 0 in the order of these.
///
/// Costs next to nothing if no spring was broken or restored since the last time, little if a few were that are
/// bridged beside them, and else a pass over the network. What has changed is told by MSPRING_EVENT_SPLIT and
/// MSPRING_EVENT_JOINED, of the first time nothing.
/// @param count    receives the number of components; may be NULL
/// @param changed  receives 1 if some particle's component has another number than the last time, else 0; may be
///                 NULL
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates the first time   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_update_components(mspring_network *network, uint32_t *count, uint32_t *changed);

/// Copy out the numbers of the components of the particles first ... first + count - 1, as of the last update.
/// @param component  [count]
/// @return MSPRING_OK; MSPRING_ERROR_ID; MSPRING_ERROR_ARGUMENT for NULL or if there was no update yet.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_component_numbers(const mspring_network *network, mspring_id first, uint32_t count,
    uint32_t *component);

/// What a component is and does. Set struct_size first.
typedef struct mspring_component {
    uint32_t struct_size;
    mspring_id head; ///< its lowest particle
    uint32_t particle_count;
    uint32_t reserved; ///< 0
    double mass;       ///< kg
    double x, y;       ///< centre of mass, m, world coordinates
    double px, py;     ///< momentum, kg m/s, of its particles that are not pinned
} mspring_component;

/// Look at the components number first ... first + count - 1 as of the last update, with the state as it is now.
/// Takes a pass over all particles.
/// @param components  [count], struct_size set in each
/// @return MSPRING_OK; MSPRING_ERROR_ID if there are not so many; MSPRING_ERROR_STRUCT; MSPRING_ERROR_ARGUMENT for
///         NULL or if there was no update yet.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_components(const mspring_network *network, uint32_t first, uint32_t count,
    mspring_component *components);

/* ------------------------------------------------------------------------------------------- measurements */

/// Energies in J, summed in double precision in a fixed order.
///   kinetic    sum of m v^2 / 2 over particles that are not pinned
///   elastic    sum of stiffness (L - rest_length)^2 / 2 over springs; a relative spring counts with the
///              stiffness of the last step (before the first: 0)
///   potential  - sum of m (gravity . p) over particles that are not pinned, p in world coordinates
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL. Any of the out-parameters may be NULL.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_energy(const mspring_network *network, double *kinetic, double *elastic, double *potential);

/// Momentum (kg m/s) and angular momentum about the world's origin (kg m^2/s) of the particles that are not
/// pinned. Any of the out-parameters may be NULL.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_momentum(const mspring_network *network, double *px, double *py, double *angular);

/// Smallest box around all particles, world coordinates (m).
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_bounds(const mspring_network *network, double *min_x, double *min_y, double *max_x, double *max_y);

/// The particle nearest to a point, of those within a distance: what a mouse picks.
/// @param x, y      world position, m, at most MSPRING_MAX_COORDINATE in absolute value
/// @param within    m, >= 0; INFINITY for any distance
/// @param particle  receives its id, the lowest of several, or MSPRING_NONE
/// @param distance  receives how far it is, m, or INFINITY; may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT.
/// @threads shared   @allocates never; looks at every particle   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_nearest_particle(const mspring_network *network, double x, double y, double within,
    mspring_id *particle, double *distance);

/// The particles in a circle, its edge included, in the order of their ids.
/// @param x, y, radius  world position and radius, m; radius >= 0
/// @param particles     [capacity] receives as many ids as fit; may be NULL if capacity is 0
/// @param count         receives how many there are, which may be more than fit
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT.
/// @threads shared   @allocates never; looks at every particle   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_particles_in_circle(const mspring_network *network, double x, double y, double radius,
    mspring_id *particles, uint32_t capacity, uint32_t *count);

/// The particles in a box, its edges included, in the order of their ids.
/// @param min_x, min_y, max_x, max_y  world coordinates, m; no min above its max; may be infinite
/// @param particles, capacity, count  as of mspring_network_particles_in_circle()
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT.
/// @threads shared   @allocates never; looks at every particle   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_particles_in_box(const mspring_network *network, double min_x, double min_y, double max_x,
    double max_y, mspring_id *particles, uint32_t capacity, uint32_t *count);

/// The springs that a straight line meets: to cut them, or to find what a ray hits first. Broken ones are left out;
/// touching one counts. They come in the order of their ids.
/// @param from_x, from_y, to_x, to_y  the line's ends, world positions, m
/// @param springs    [capacity] receives as many ids as fit; may be NULL if capacity is 0
/// @param fractions  [capacity] receives where each is met, from 0 at the line's start to 1 at its end; may be NULL
/// @param count      receives how many there are, which may be more than fit
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT.
/// @threads shared   @allocates never; looks at every spring   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_springs_across(const mspring_network *network, double from_x, double from_y, double to_x,
    double to_y, mspring_id *springs, double *fractions, uint32_t capacity, uint32_t *count);

/// What a spring is and does. Set struct_size first.
typedef struct mspring_spring_info {
    uint32_t struct_size;
    uint32_t flags;  ///< MSPRING_SPRING_RELATIVE, MSPRING_SPRING_BROKEN, MSPRING_SPRING_STRESSED
    mspring_id a, b; ///< its particles, in the order in which they were given
    float stiffness; ///< N/m in force; of a relative spring that of the last step, 0 before the first; 0 if broken
    float damping;   ///< N s/m, likewise
    float rest_length;       ///< m
    float length;            ///< m, now
    float strain;            ///< (length - rest_length) / rest_length; 0 if broken
    float force;             ///< N along the spring: > 0 pulls its ends together; with the damper's share
    float nominal_stiffness; ///< as in mspring_spring_def: N/m or, if relative, a fraction; broken or not
    float nominal_damping;   ///< likewise
} mspring_spring_info;

/// Look at one spring.
/// @return MSPRING_OK; MSPRING_ERROR_ID, MSPRING_ERROR_ARGUMENT or MSPRING_ERROR_STRUCT.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_spring(const mspring_network *network, mspring_id spring, mspring_spring_info *info);

/// What ends of springs are numbered by.
typedef enum mspring_numbering {
    MSPRING_ENDS_IDS = 0,  ///< ids of particles
    MSPRING_ENDS_SLOTS = 1, ///< slots, as of a view: they change with its layout_generation
    MSPRING_NUMBERING_INT = MSPRING_ENUM_INT ///< no value
} mspring_numbering;

/// Copy out the ends of the springs first ... first + count - 1, as for an index buffer to draw them.
/// They come in the order in which they were given: of a lattice's springs the lower id first, of a rope's the end that
/// comes first along it. A removed spring has MSPRING_NONE at both.
/// @param a, b    receive those of spring first + i in a[i * stride] and b[i * stride]
/// @param stride  elements from one to the next, at least 1; for pairs 2, with b = a + 1
/// @return MSPRING_OK; MSPRING_ERROR_ID; MSPRING_ERROR_ARGUMENT for NULL, an unknown numbering or stride 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_ends(const mspring_network *network, mspring_id first, uint32_t count,
    mspring_numbering numbering, uint32_t *a, uint32_t *b, uint32_t stride);

/// Copy out the flags of the springs first ... first + count - 1: MSPRING_SPRING_RELATIVE, _BROKEN, _STRESSED and
/// _REMOVED.
/// @param flags   receives those of spring first + i in flags[i * stride]
/// @param stride  elements from one to the next, at least 1
/// @return MSPRING_OK; MSPRING_ERROR_ID or MSPRING_ERROR_ARGUMENT.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_spring_flags(const mspring_network *network, mspring_id first, uint32_t count, uint32_t *flags,
    uint32_t stride);

/// Length, direction and strain of all springs at once, in id order: a pass over the network in the order in which
/// it lies in memory. Each array is filled if it is not NULL; all is 0 of springs that were removed.
/// @param length       [spring count], m
/// @param direction_x, direction_y  [spring count] the unit vector along the spring from its end a to b, as given;
///                     (0, 0) for a spring of length 0; both or none
/// @param strain       [spring count], as MSPRING_STRAIN, to the last bit or so
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates the first time   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_get_extents(mspring_network *network, float *length, float *direction_x, float *direction_y,
    float *strain);

/// The largest absolute strain and the spring that has it (the lowest id of several). A network without springs
/// has strain 0 and spring MSPRING_NONE. Either out-parameter may be NULL.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_max_strain(const mspring_network *network, float *strain, mspring_id *spring);

/// A 64-bit hash of positions, velocities and local origin, over their bits in id order: equal states have equal
/// hashes on every machine. (Not cryptographic.)
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_state_hash(const mspring_network *network, uint64_t *hash);

/* -------------------------------------------------------------------------------------------------- snapshots */

/// What a snapshot holds.
typedef enum mspring_snapshot_contents {
    /// Everything that the following steps depend on: positions, velocities, origin, settings, masses, forces given
    /// for the next step, broken and stressed springs, ramps, and what each spring is like.
    MSPRING_SNAPSHOT_ALL = 0,
    /// All but the springs' stiffness, damping, rest length, break and stress strain, which only edits change: a
    /// third of the size, and saved at nearly the speed of a copy, for rollback. It can be loaded only where these
    /// are what they were: into the same network as long as they have not been edited since, and nothing was added
    /// or removed, or into another that was made alike and edited alike, in the same order. (Breaking, restoring,
    /// with or without a ramp, and detaching are no edits of these.)
    MSPRING_SNAPSHOT_FRAME = 1,
    MSPRING_SNAPSHOT_CONTENTS_INT = MSPRING_ENUM_INT ///< no value
} mspring_snapshot_contents;

/// The size of a snapshot that is saved now, in bytes. It changes with what there is to save: forces, ramps, edits.
/// So ask before each save.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL or unknown contents; MSPRING_ERROR_BUSY in a hook.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_snapshot_size(const mspring_network *network, mspring_snapshot_contents contents, size_t *size);

/// Save a snapshot into the caller's memory. It is the same on every machine, for any SIMD level and number of
/// workers, but only of use to networks made of the same particles and springs by a library that lays them out
/// alike, and with MSPRING_NETWORK_PRECISE if this one has it (others refuse it): meant for rollback, replay and
/// network play, not for archives. Of the implicit or direct solver it holds settings and history, but it can be
/// loaded only where that solver is, with the same integrator and tiles and, of the direct one, the same added
/// springs. Hooks and unread events are not in it.
/// @param snapshot  [capacity] bytes, of any alignment
/// @param capacity  at least mspring_network_snapshot_size()
/// @param size      receives the bytes written; may be NULL
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT for NULL, unknown contents or too little room; MSPRING_ERROR_BUSY in
///         a hook.
/// @threads shared   @allocates never   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_save(const mspring_network *network, mspring_snapshot_contents contents, void *snapshot,
    size_t capacity, size_t *size);

/// Go back, or forth, to what a snapshot holds: the following steps are the same, bit for bit, as those after it
/// was saved. Events that have not been read are dropped. The snapshot may come from anywhere: one that is damaged,
/// cut off, of another network or with values that a network cannot have is refused, and changes nothing.
/// @return MSPRING_OK; MSPRING_ERROR_SNAPSHOT (the message says what is wrong), MSPRING_ERROR_ARGUMENT for NULL,
///         MSPRING_ERROR_MEMORY, MSPRING_ERROR_BUSY.
/// @threads exclusive access to network   @allocates yes, what the network did not need so far   @since 0.2
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL
mspring_network_load(mspring_network *network, const void *snapshot, size_t size);

/* --------------------------------------------------------------------------------------------- SIMD level */

/// The instruction set that the network's steps use. NULL gives MSPRING_SIMD_AUTO.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API mspring_simd MSPRING_CALL mspring_network_simd_level(const mspring_network *network);

/// The number of workers that the network has: what its definition asks for, or 1 in a build of the library without
/// threads. (How many take part in a step depends on the network's size.) NULL gives 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_network_worker_count(const mspring_network *network);

/// The best instruction set that this CPU, operating system and build of the library offer.
/// @threads any   @allocates never   @since 0.2
MSPRING_API mspring_simd MSPRING_CALL mspring_simd_supported(void);

/// Whether a network can be made to run at this level here: 1 for MSPRING_SIMD_AUTO and the levels that this CPU,
/// operating system and build of the library offer, 0 for others. On x86-64, 64-bit ARM and WebAssembly builds have
/// MSPRING_SIMD_SCALAR only if they are made with it.
/// @threads any   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_simd_available(mspring_simd level);

/// Name of a level as in MSPRING_SIMD: "scalar", "sse2", "avx2", "avx512", "neon", "wasm", "auto"; "unknown" for
/// others.
/// @threads any   @allocates never   @since 0.2
MSPRING_API const char *MSPRING_CALL mspring_simd_name(mspring_simd level);

#ifdef __cplusplus
}
#endif

#endif
