/// @file core.h
/// Builders and networks: to make, step, read, change and store them. Include massspring.h, which explains the words.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_CORE_H
#define MASSSPRING_CORE_H

#include <stddef.h>
#include <stdint.h>

#include "export.h"
#include "version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------------- library */

/// Return the version of the library that runs, in the form of MSPRING_VERSION.
/// Threads: any. Allocates: never.
MSPRING_API uint32_t MSPRING_CALL mspring_version(void);

/// Return that version as text, such as "0.3.0". Static storage.
/// Threads: any. Allocates: never.
MSPRING_API const char *MSPRING_CALL mspring_version_string(void);

/// Features that a build of the library may have.
typedef enum mspring_feature_flags {
    MSPRING_FEATURE_THREADS = 1 << 0,  ///< networks may have several workers; otherwise they have one
    MSPRING_FEATURE_HOSTED = 1 << 1,   ///< there is a default allocator; the variable MSPRING_SIMD is read
    MSPRING_FEATURE_SHARED = 1 << 2,   ///< this is the shared library
    MSPRING_FEATURE_IMPLICIT = 1 << 3, ///< there are MSPRING_SOLVER_IMPLICIT and MSPRING_GUARD_IMPLICIT
    MSPRING_FEATURE_DIRECT = 1 << 4,   ///< there is MSPRING_SOLVER_DIRECT
    MSPRING_FEATURE_FLOOR = 1 << 5,    ///< there are floors
    MSPRING_FEATURE_CONTACT = 1 << 6,  ///< there are contact, colliders and grips
    MSPRING_FEATURE_LAWS = 1 << 7,     ///< there are yielding and one-way springs, areas and angles
    MSPRING_FEATURE_BATCH = 1 << 8,    ///< there are groups and actuators (batch.h), and mspring_builder_add_copies()
    MSPRING_FEATURE_LAB = 1 << 9       ///< there are settling, tuning, jobs, strain limits and descriptions (lab.h)
} mspring_feature_flags;

/// Return the features of the library that runs: bits of MSPRING_FEATURE_.
/// Threads: any. Allocates: never.
MSPRING_API uint32_t MSPRING_CALL mspring_features(void);

/// Result of a call: MSPRING_OK or one of the negative errors below.
typedef enum mspring_result {
    MSPRING_OK = 0,
    MSPRING_ERROR_ARGUMENT = -1,          ///< NULL, NaN, infinite, or outside the range that the function states
    MSPRING_ERROR_ID = -2,                ///< no such particle, spring, element, group, hook, collider or grip
    MSPRING_ERROR_MEMORY = -3,            ///< the allocator returned NULL
    MSPRING_ERROR_LIMIT = -4,             ///< more particles, springs, cells, pairs, points or grips than fit
    MSPRING_ERROR_STRUCT = -5,            ///< struct_size is impossible, or what this version does not know is not 0
    MSPRING_ERROR_DUPLICATE = -6,         ///< two springs that pull and push join the same two particles
    MSPRING_ERROR_UNSTABLE = -7,          ///< the step was unstable and has been rolled back
    MSPRING_ERROR_BUSY = -8,              ///< called inside a hook; a second job; or a job that is not ready
    MSPRING_ERROR_THREAD = -9,            ///< the system gave no thread or no lock
    MSPRING_ERROR_EQUILIBRIUM = -10,      ///< the forces have no equilibrium, or none was found
    MSPRING_ERROR_SNAPSHOT = -11,         ///< no snapshot of this network, no archive, or a damaged one
    MSPRING_ERROR_OUTDATED = -12,         ///< the network has changed since the job began
    MSPRING_ERROR_REFUSED = -13,          ///< a function of the host refused: a hook, a writer, a prepare function
    MSPRING_RESULT_INT = MSPRING_ENUM_INT ///< no value
} mspring_result;

/// Return a short English name of a result, such as "out of memory". Never NULL; static storage.
/// Threads: any. Allocates: never.
MSPRING_API const char *MSPRING_CALL mspring_result_string(mspring_result result);

/// Structs that begin with struct_size.
typedef enum mspring_struct {
    MSPRING_STRUCT_ALLOCATOR = 0,
    MSPRING_STRUCT_TASKS = 1,
    MSPRING_STRUCT_PARTICLE_DEF = 2,
    MSPRING_STRUCT_SPRING_DEF = 3,
    MSPRING_STRUCT_MATERIAL = 4,
    MSPRING_STRUCT_LATTICE_DEF = 5,
    MSPRING_STRUCT_ROPE_DEF = 6,
    MSPRING_STRUCT_MESH_DEF = 7,
    MSPRING_STRUCT_DISC_DEF = 8,
    MSPRING_STRUCT_SETTINGS = 9,
    MSPRING_STRUCT_NETWORK_DEF = 10,
    MSPRING_STRUCT_CLONE_DEF = 11,
    MSPRING_STRUCT_NETWORK_INFO = 12,
    MSPRING_STRUCT_STEP_INFO = 13,
    MSPRING_STRUCT_VIEW = 14,
    MSPRING_STRUCT_ENERGY = 15,
    MSPRING_STRUCT_BODY = 16,
    MSPRING_STRUCT_HOOK_ARGS = 17, ///< only to learn its size in this version
    MSPRING_STRUCT_HOOK_DEF = 18,
    MSPRING_STRUCT_FLOOR_DEF = 19,
    MSPRING_STRUCT_CONTACT_DEF = 20,
    MSPRING_STRUCT_CONTACT_INFO = 21,
    MSPRING_STRUCT_CONTACT_EVENT = 22,
    MSPRING_STRUCT_COLLIDER_DEF = 23,
    MSPRING_STRUCT_GRIP_DEF = 24,
    MSPRING_STRUCT_AREA_DEF = 25,
    MSPRING_STRUCT_ANGLE_DEF = 26,
    MSPRING_STRUCT_SETTLE_DEF = 1000, ///< from here on those of lab.h
    MSPRING_STRUCT_SETTLE_RESULT = 1001,
    MSPRING_STRUCT_TUNE_SCENE = 1002,
    MSPRING_STRUCT_TUNE_DEF = 1003,
    MSPRING_STRUCT_TUNE_ROW = 1004,
    MSPRING_STRUCT_INT = MSPRING_ENUM_INT ///< no value
} mspring_struct;

/// Fill a struct with its defaults, struct_size included.
/// In C and C++ mspring_x_default() is shorter. Bindings learn here whether their layout is right: a size that this
/// version cannot have is refused. A size between the first and the present one is that of an older program.
/// @param size  sizeof the struct, as your header gives it
/// Threads: any. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_init(mspring_struct kind, void *made, size_t size);

/// Instruction sets. All give the same bits. Levels of one kind of CPU stand in order: scalar < SSE2 < AVX2 < AVX-512
/// on x86; scalar < NEON on 64-bit ARM; scalar < WASM in a browser. Between kinds there is no order.
typedef enum mspring_simd {
    MSPRING_SIMD_AUTO = 0, ///< the best that CPU and operating system offer; a narrower one if rows are short
    MSPRING_SIMD_SCALAR = 1,
    MSPRING_SIMD_SSE2 = 2,
    MSPRING_SIMD_AVX2 = 3,
    MSPRING_SIMD_AVX512 = 4,
    MSPRING_SIMD_NEON = 5,
    MSPRING_SIMD_WASM = 6,              ///< SIMD128 of WebAssembly, in modules that were built with it
    MSPRING_SIMD_INT = MSPRING_ENUM_INT ///< no value
} mspring_simd;

/// Return 1 if a network can run at this level here, else 0. MSPRING_SIMD_AUTO gives 1.
/// On x86-64, 64-bit ARM and WebAssembly, builds have MSPRING_SIMD_SCALAR only if they are made with it.
/// Threads: any. Allocates: never.
MSPRING_API uint32_t MSPRING_CALL mspring_simd_available(mspring_simd level);

/// Return the name of a level: "scalar", "sse2", "avx2", "avx512", "neon", "wasm", "auto" or "unknown".
/// Threads: any. Allocates: never.
MSPRING_API const char *MSPRING_CALL mspring_simd_name(mspring_simd level);

/// Id of a particle, spring or element: 0, 1, 2 ... in the order in which they were added. It never changes. After
/// mspring_network_reuse_ids(), added ones may get ids of removed ones. Hooks, colliders and grips have ids of their
/// own, which a network never gives twice.
typedef uint32_t mspring_id;

/// No particle, no spring.
#define MSPRING_NONE 0xffffffffu
/// As a count: all from first on.
#define MSPRING_ALL 0xffffffffu

/// Most particles and most springs in one network.
#define MSPRING_MAX_PARTICLES 0x4000000u
#define MSPRING_MAX_SPRINGS 0x10000000u
/// Largest size (m) of a world coordinate that you give, and of a coordinate relative to the local origin.
#define MSPRING_MAX_COORDINATE 1e12
/// Largest speed in x or y that you can give to a particle, m/s.
#define MSPRING_MAX_SPEED 1e15

/// Kinds of things in a network.
typedef enum mspring_kind {
    MSPRING_PARTICLES = 0,
    MSPRING_SPRINGS = 1,
    MSPRING_ELEMENTS = 2,  ///< areas and angle springs (laws.h)
    MSPRING_GROUPS = 3,    ///< bodies of a batch (batch.h)
    MSPRING_ACTUATORS = 4, ///< springs that follow signals (batch.h)
    MSPRING_KIND_INT = MSPRING_ENUM_INT ///< no value
} mspring_kind;

/* ----------------------------------------------------------------------------------------- allocator and workers */

/// Allocator of an object. Set alloc and free; the struct is copied.
/// The library calls alloc and free only inside calls that say that they allocate, and inside destroy functions.
typedef struct mspring_allocator {
    uint32_t struct_size;
    uint32_t reserved; ///< 0
    /// Returns at least size bytes, aligned to alignment (a power of two, at most 64), or NULL.
    void *(MSPRING_CALL *alloc)(size_t size, size_t alignment, void *user);
    void(MSPRING_CALL *free)(void *memory, size_t size, void *user); ///< gets the size that alloc was asked for
    void *user;                                                      ///< passed to both; default NULL
} mspring_allocator;
MSPRING_DEFAULT(mspring_allocator, MSPRING_STRUCT_ALLOCATOR);

/// Most workers of one network.
#define MSPRING_MAX_WORKERS 256u

/// A piece of work of the library. The host calls it as fn(argument, index, worker).
typedef void(MSPRING_CALL *mspring_task_fn)(void *argument, uint32_t index, uint32_t worker);

/// Threads of the host, lent to a network; the struct is copied.
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
/// step calls run twice for every few substeps, but seldom while one worker takes all of these calls; implicit and
/// direct steps use one thread, but for contact. The library calls run only inside calls with exclusive access, never
/// from two threads at once and never from inside fn.
typedef struct mspring_tasks {
    uint32_t struct_size;
    uint32_t worker_count;     ///< 1 to MSPRING_MAX_WORKERS; 1, the default: run is not called
    uint32_t concurrent_count; ///< 1 to worker_count; default 1
    uint32_t reserved;         ///< 0
    void(MSPRING_CALL *run)(uint32_t count, mspring_task_fn fn, void *argument, void *user); ///< must be set
    void *user;                                ///< passed to run and release; default NULL
    void(MSPRING_CALL *release)(void *user);   ///< called once, as the network is destroyed; default NULL
} mspring_tasks;
MSPRING_DEFAULT(mspring_tasks, MSPRING_STRUCT_TASKS);

/* ----------------------------------------------------------------------------------------- particles and springs */

/// Flags of particles. Those from 1 << 8 on can only be read.
typedef enum mspring_particle_flags {
    MSPRING_PARTICLE_PINNED = 1 << 0, ///< feels no force
    MSPRING_PARTICLE_ASLEEP = 1 << 8, ///< sleeps; if it was set or written since, until the next step
    MSPRING_PARTICLE_REMOVED = 1 << 10 ///< removed: in ranges only
} mspring_particle_flags;

/// Flags of springs. Those from 1 << 8 on can only be read.
typedef enum mspring_spring_flags {
    /// stiffness and damping are fractions of what an explicit substep of length h allows:
    ///     k = stiffness * mu / h^2,   c = damping * mu / h,   mu = m_a m_b / (m_a + m_b)
    /// Such a network is as stiff as its step allows. A lattice of equal springs and masses is stable below 1. New
    /// masses count at once.
    MSPRING_SPRING_RELATIVE = 1 << 0,
    /// damping is a ratio of critical damping, 0 to 1000. With 1 the spring's ends come to rest without swinging.
    ///     c = 2 damping sqrt(stiffness * mu)
    /// In definitions only: the library computes c once, at most 1e30, and forgets the ratio. A pinned particle
    /// counts with its mass. If the spring is relative, c is a fraction and follows the substep.
    MSPRING_SPRING_DAMPING_RATIO = 1 << 1,
    MSPRING_SPRING_PULL_ONLY = 1 << 2, ///< no force where it is shorter than its rest length: rope, cable, string
    MSPRING_SPRING_PUSH_ONLY = 1 << 3, ///< no force where it is longer: prop, stop; not both
    /// Break, warn, relax and yield strain are elongations in metres, as those of a weld always are. They read back as
    /// given. They act as strains of MSPRING_REST_LENGTH, and follow it: a new rest length leaves the metres as they
    /// are.
    MSPRING_SPRING_METRES = 1 << 4,
    MSPRING_SPRING_BROKEN = 1 << 8,   ///< broken
    MSPRING_SPRING_STRESSED = 1 << 9, ///< over its warn strain (MSPRING_WARN_STRAIN)
    MSPRING_SPRING_REMOVED = 1 << 10  ///< removed: in ranges only, together with MSPRING_SPRING_BROKEN
} mspring_spring_flags;

/// One particle.
typedef struct mspring_particle_def {
    uint32_t struct_size;
    uint32_t flags;    ///< MSPRING_PARTICLE_PINNED or 0; default 0
    double x, y;       ///< world position, m, at most MSPRING_MAX_COORDINATE in size; default 0
    float vx, vy;      ///< velocity of now, m/s, within MSPRING_MAX_SPEED; default 0
    float mass;        ///< kg, 1e-30 to 1e30; default 1
    uint32_t reserved; ///< 0
} mspring_particle_def;
MSPRING_DEFAULT(mspring_particle_def, MSPRING_STRUCT_PARTICLE_DEF);

/// A strain for "never": the largest float. INFINITY means the same, and reads back as this. Use it in programs
/// compiled with -ffinite-math-only.
#define MSPRING_NEVER 3.40282346638528859812e+38f
/// Relax strain for "relax_fraction (mspring_settings) of the warn strain".
#define MSPRING_RELAX_STRAIN_DEFAULT (-1.0f)
/// rest_length for "the distance at which the two particles are added".
#define MSPRING_REST_LENGTH_DISTANCE (-1.0f)
/// Hardening and plastic limit of springs for which none was given.
#define MSPRING_HARDENING_DEFAULT 0.1f
#define MSPRING_PLASTIC_LIMIT_DEFAULT 0.5f

/// One spring. The values that have a property of the same name are explained there.
typedef struct mspring_spring_def {
    uint32_t struct_size;
    uint32_t flags;     ///< bits of mspring_spring_flags below 1 << 8; default 0
    mspring_id a, b;    ///< the particles that it joins, not the same; default MSPRING_NONE: set both
    float stiffness;    ///< N/m, or a fraction if relative, 0 to 1e30; default 0
    float damping;      ///< N s/m or a fraction, 0 to 1e30, or a ratio, 0 to 1000; default 0
    float rest_length;  ///< m, 0 (a weld) to 4e12; default MSPRING_REST_LENGTH_DISTANCE
    float break_strain; ///< default MSPRING_NEVER
    float warn_strain;  ///< default MSPRING_NEVER
    float relax_strain; ///< default MSPRING_RELAX_STRAIN_DEFAULT
    float yield_strain; ///< default MSPRING_NEVER
    float hardening, plastic_limit; ///< defaults MSPRING_HARDENING_DEFAULT, MSPRING_PLASTIC_LIMIT_DEFAULT
} mspring_spring_def;
MSPRING_DEFAULT(mspring_spring_def, MSPRING_STRUCT_SPRING_DEF);

/// Material of lattices, ropes, meshes and discs: values of their particles and their springs.
typedef struct mspring_material {
    uint32_t struct_size;
    uint32_t particle_flags; ///< MSPRING_PARTICLE_PINNED or 0; default 0
    uint32_t spring_flags;   ///< as flags of mspring_spring_def; the same in all materials of a lattice; default 0
    float mass;              ///< kg of each particle, 1e-30 to 1e30; default 1
    float stiffness;         ///< of each spring. This and all that follows: as in mspring_spring_def
    float damping, break_strain, warn_strain, relax_strain, yield_strain, hardening, plastic_limit;
} mspring_material;
MSPRING_DEFAULT(mspring_material, MSPRING_STRUCT_MATERIAL);

/// Materials that mspring_material_preset() knows.
typedef enum mspring_preset {
    MSPRING_PRESET_STEEL = 0,             ///< heavy, as firm as substeps allow, hardly damped
    MSPRING_PRESET_WOOD = 1,              ///< light and firm
    MSPRING_PRESET_RUBBER = 2,            ///< bends and stretches far
    MSPRING_PRESET_JELLY = 3,             ///< sags under its own weight and wobbles
    MSPRING_PRESET_INT = MSPRING_ENUM_INT ///< no value
} mspring_preset;

/// Set all values of a material to those of steel, wood, rubber or jelly.
/// Springs are relative, so a lattice of it is stable at any dt, in any shape. Mass is that of a plate of 1 m
/// thickness. Stiffness is the real one, if substeps are short enough for it. Otherwise a bar bends more than the
/// real one: use shorter substeps or a larger spacing.
/// @param spacing  m, 1e-9 to 1e9, as in mspring_lattice_def
/// @param substep  s, 1e-12 to 1e6: dt / substeps
/// Threads: any. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_material_preset(
    mspring_material *material, mspring_preset preset, double spacing, double substep);

/// Cell of a lattice with nothing in it.
#define MSPRING_CELL_EMPTY 0xffffu

/// A grid of cells, as an image gives it.
///
/// Each cell that is not empty becomes a particle. Springs at rest join it with its 8 neighbours. Their stiffness and
/// damping are the means of the two materials. Their break strain is the lower one. Warn and relax strain are those
/// of the material with the lower warn strain. Structural springs follow rows and columns, shear springs diagonals.
/// Bend springs, as for cloth, join cells two apart, if the cell between is not empty. With them a step takes several
/// times as long, and the stable stiffness is lower. The shares scale stiffness and damping, but not a damping ratio:
/// those of each material, times the larger share, are at most 1e30.
typedef struct mspring_lattice_def {
    uint32_t struct_size;
    uint32_t width, height;            ///< cells, each at least 1, product at most MSPRING_MAX_PARTICLES; set both
    uint32_t material_count;           ///< at most 65535; default 1
    double x, y;                       ///< world position of the bottom left cell's centre; default 0
    double spacing;                    ///< m between neighbouring columns and rows, 1e-9 to 1e9; default 1
    const uint16_t *cells;             ///< [height][width], top row first: index into materials or MSPRING_CELL_EMPTY;
                                       ///< NULL, the default: all are of the first material
    const mspring_material *materials; ///< [material_count]; set it
    float shear_share; ///< stiffness of shear springs over that of structural ones, 0 to 1000; 0: none; default 1
    float bend_share;  ///< the same for bend springs; default 0: none
} mspring_lattice_def;
MSPRING_DEFAULT(mspring_lattice_def, MSPRING_STRUCT_LATTICE_DEF);

/// A chain of equal springs along the straight line between two particles.
typedef struct mspring_rope_def {
    uint32_t struct_size;
    uint32_t segment_count;           ///< springs, at least 1; default 1. There is one inner particle fewer.
    mspring_id from, to;              ///< its ends; default MSPRING_NONE: set both
    const mspring_material *material; ///< of inner particles and springs; set it
    float length_ratio;               ///< rest length of the whole rope / distance of its ends, 0.001 to 1000; default
                                      ///< 1; above 1 it is slack, below under tension
    uint32_t reserved;                ///< 0
} mspring_rope_def;
MSPRING_DEFAULT(mspring_rope_def, MSPRING_STRUCT_ROPE_DEF);

/// A mesh of triangles.
///
/// Each vertex becomes a particle. Each edge becomes one spring at rest. All springs are equally stiff, or
/// young_modulus gives each edge the stiffness (Van Gelder 1998)
///     k = young_modulus * (sum of the areas of its triangles) / length^2
/// A mesh of equilateral triangles then has that modulus, and Poisson's ratio 1/3. Other meshes come near it.
typedef struct mspring_mesh_def {
    uint32_t struct_size;
    uint32_t vertex_count;     ///< at most MSPRING_MAX_PARTICLES; 0: the mesh adds nothing
    uint32_t triangle_count;   ///< at most MSPRING_MAX_SPRINGS
    float area_density;        ///< kg/m^2, 1e-30 to 1e30: a vertex has a third of each triangle at it; default 0: it
                               ///< has the material's mass
    const double *x, *y;       ///< [vertex_count] world positions, m
    const uint32_t *triangles; ///< [triangle_count][3] indices of vertices, clockwise or not
    const mspring_material *material; ///< set it
    float young_modulus;       ///< N/m: Young's modulus times thickness, 0 to 1e30; above 0 the material's stiffness
                               ///< must be 0, and springs not relative; default 0: the material's stiffness
    uint32_t reserved;         ///< 0
} mspring_mesh_def;
MSPRING_DEFAULT(mspring_mesh_def, MSPRING_STRUCT_MESH_DEF);

/// A disc: a mesh of rings around a centre.
///
/// Ring i has 6 i particles. Springs are 1 to 1.45 times as long as the distance of two rings.
typedef struct mspring_disc_def {
    uint32_t struct_size;
    uint32_t ring_count;   ///< 1 to 4729; default 1; n rings are 1 + 3 n (n + 1) particles, n (9 n + 3) springs
    double x, y;           ///< world position of the centre, m; default 0
    double radius;         ///< m, 1e-9 to 1e12; default 1
    const mspring_material *material; ///< set it
    const void *reserved_pointer;     ///< NULL
    float area_density;    ///< this and the next: as in mspring_mesh_def
    float young_modulus;
    uint32_t centre_flags; ///< of the particle in the centre: MSPRING_PARTICLE_PINNED or 0; default 0
    uint32_t reserved;     ///< 0
} mspring_disc_def;
MSPRING_DEFAULT(mspring_disc_def, MSPRING_STRUCT_DISC_DEF);

/* ------------------------------------------------------------------------------------------------------ settings */

/// How a network is evolved. The guide solvers.md compares the solvers.
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
    MSPRING_INTEGRATOR_ALPHA = 0, ///< generalised-alpha with rho_inf = 0 (Chung and Hulbert 1993): second order
    MSPRING_INTEGRATOR_BDF2 = 1,  ///< backward differences of second order
    MSPRING_INTEGRATOR_EULER = 2, ///< implicit Euler: first order; takes most energy out of oscillations
    MSPRING_INTEGRATOR_INT = MSPRING_ENUM_INT ///< no value
} mspring_integrator;

/// Ways in which a step keeps motion bounded. A step always rejects coordinates and speeds that are not finite or out
/// of bounds. With the implicit and the direct solver, most guards keep an energy budget instead. Energy then grows
/// by no more than the work of gravity, forces and moving pins. The guide guards.md has the details.
typedef enum mspring_guard {
    /// Reject a step whose substeps exceed the stability limit (mspring_network_get_stable_dt()), or make motion grow.
    /// Steps within the limit are never rejected, not even where uneven dt or violent motion adds energy step by step.
    /// With the implicit and the direct solver, reject a step that runs out of most_work, as heaps and tangles may.
    MSPRING_GUARD_GROWTH = 0,
    /// Repeat a step that would be rejected, with twice as many substeps, up to max_substeps and as long as
    /// mspring_settings.most_work lasts: where that ends it, the step fails. If `substeps` is a number, the next step
    /// begins with the one that would have followed, and later ones keep it until substeps is set again. Hooks are
    /// called again. Relative springs gain nothing by it. An implicit or direct step without work left fails, too.
    MSPRING_GUARD_RETRY = 1,
    MSPRING_GUARD_BOUNDS = 2, ///< check the bounds only
    /// Repeat a step that would be rejected, by one substep of implicit Euler. The 15 steps after it use that, too. It
    /// is slower and softer, but stable at nearly any stiffness. Hooks are called again. The network reserves memory.
    MSPRING_GUARD_IMPLICIT = 3,
    /// Repeat a step that would be rejected, with clamped strain rates; unless the solver is implicit, also the 15
    /// steps after it. Springs that are too stiff for the substep, or in violent motion, act with a part of their
    /// force; others act as ever. Unphysical: stiff springs turn soft, and motion along them is damped. Small motion
    /// never grows. A substep takes as long as 3 explicit ones (10 where springs are irregular). Hooks are called
    /// again. Uses one thread and no memory. The default.
    MSPRING_GUARD_CLAMP = 4,
    /// Check nothing, and put back particles that end out of bounds. Speeds become at most max_speed, local
    /// coordinates at most MSPRING_MAX_COORDINATE. A particle with NaN or infinity goes back to its place before the
    /// step, or to the local origin, and stands still. No step fails. An explosion is bounded, but not physical. A step
    /// in which numbers overflow is repeated as with MSPRING_GUARD_CLAMP, so that it has the same bits everywhere.
    MSPRING_GUARD_CLAMP_BOUNDS = 5,
    MSPRING_GUARD_INT = MSPRING_ENUM_INT ///< no value
} mspring_guard;

/// Most substeps in one step.
#define MSPRING_MAX_SUBSTEPS 1000000u
/// substeps for "as few as are stable in any shape that the network can reach", chosen before each step (see
/// mspring_network_get_stable_dt()). For the implicit and the direct solver 1. mspring_step_info reports the number. If
/// all springs are relative, it is 1: set a number to have them firmer. For 600 steps after dt has changed, it is the
/// number whose substeps are closest in length to the last ones, within 0.4 to 0.8 of what is stable: up to 2.5 times
/// as many. Stable is meant of small motion. In violent motion, in which the ends of a spring pass by a quarter of its
/// length in a substep, it takes more, up to most_work times as many; a step that needs even more has
/// MSPRING_STEP_FEWER. (Not with relative springs, which would become firmer.)
#define MSPRING_SUBSTEPS_AUTO 0xffffffffu

/// substeps for the same number, but substeps keep their length while dt varies: a step takes the nearest whole number
/// of them, at least one, and the rest is left to the next (mspring_step_info.time_left). What nothing damps then keeps
/// its energy as with even dt. The price: the state is up to half a substep off the time that was asked for, and more
/// where a dt is shorter than that; draw x + v * time_left. Hooks, ramps and sleep go by the time that a step takes;
/// pins that move by their velocity, too. The length is chosen anew from dt if it is not stable any more; after 30
/// steps of one dt, or in which it takes over twice the substeps that dt needs; if it takes over 16 times as many; or
/// if the state is ahead by over one and a half and dt is shorter still. (Steps of one substep stay ahead then, and a
/// dt below a 16th of what is stable leaves the length: bursts of these still add energy.)
#define MSPRING_SUBSTEPS_EVEN 0xfffffffeu

/// Settings, which may change at any time. A solver ignores what it does not use.
///
/// Work is counted, never timed: an explicit substep is 1, a clamped one 3, an implicit or direct one 1 for each 8
/// products with its matrix and for each pass of its active set. A calm step has the substeps that were set or, with
/// MSPRING_SUBSTEPS_AUTO and _EVEN, those that stability asks for, and repeats nothing. For MSPRING_GUARD_RETRY it has
/// at least the substeps that are stable in any shape, up to max_substeps. Four things come on top of most_work:
///  - A step that the guard rejects may end with one by the fallback, with the substeps of calm motion:
///    MSPRING_GUARD_CLAMP, _IMPLICIT, _CLAMP_BOUNDS.
///  - A step that counted on what did not hold, as on no floor within reach, is repeated: once at most for each of
///    floor, contact, grips, hooks, one-way springs and yielding. That is not counted, as it may depend on the workers.
///  - With groups of particles, a step is repeated at most twice for each group that ends out of bounds or with NaN. No
///    group is held because many others go wrong.
///  - The implicit solver takes 32 times as many calm steps, the direct one 53 times, as substeps in which bodies touch
///    have 16 times the iterations, and impacts some intervals, halves and passes. A calm one has 8 iterations, or a
///    quarter of the most if that is more; with residual 0 all. Where that ends, the rest is done once, by implicit
///    Euler: the energy budget holds, and bodies near each other move on as rigid ones, with friction but no bounce.
///    The step has MSPRING_STEP_FEWER; MSPRING_GUARD_GROWTH and _RETRY reject it. The solution that comes to the end
///    may be one of two on top.
typedef struct mspring_settings {
    uint32_t struct_size;
    mspring_solver solver;         ///< default MSPRING_SOLVER_EXPLICIT
    mspring_integrator integrator; ///< of the implicit and the direct solver; default MSPRING_INTEGRATOR_ALPHA
    mspring_guard guard;           ///< what a step does to keep motion bounded; default MSPRING_GUARD_CLAMP
    uint32_t substeps;     ///< of one step, 1 to MSPRING_MAX_SUBSTEPS, MSPRING_SUBSTEPS_AUTO, the default, or _EVEN
    uint32_t max_substeps; ///< most that MSPRING_SUBSTEPS_AUTO or MSPRING_GUARD_RETRY may choose, 1 to
                           ///< MSPRING_MAX_SUBSTEPS; default 1000. If a step needs more, the guard decides.
    /// Length of all substeps, s, rounded to a float; 1.2e-38 to 1e30, or 0, the default: not set. It replaces
    /// `substeps`, which then reads back as MSPRING_SUBSTEPS_AUTO. A step takes the nearest whole number of substeps,
    /// and leaves the rest of dt to the next: mspring_step_info.time_left, at most half a substep. So motion without
    /// damping keeps its energy, and the length of a tick stays the same, however dt varies. If dt is too short for a
    /// substep, the call only adds it to time_left, and does not count as a step; forces and signals wait for the next
    /// one. If dt needs more than MSPRING_MAX_SUBSTEPS, the step returns MSPRING_ERROR_ARGUMENT. Networks with groups
    /// reject a length. The guard may repeat a step with other substeps. MSPRING_SUBSTEPS_EVEN chooses a length by
    /// itself, and changes it if necessary.
    double substep_length;
    float gravity_x;      ///< m/s^2, finite; default 0
    float gravity_y;      ///< m/s^2, finite; default -9.8
    float global_damping; ///< 1/s, 0 to 1e6: velocities decay by exp(-global_damping t), at any dt; default 0
    float max_speed;      ///< m/s, > 0 and at most 1e15: a step rejects faster particles, in x or y; default 1e6
    float sleep_speed;    ///< m/s, 0 to 1e15: a component sleeps if none of its particles has been faster, in x or y,
                          ///< for sleep_time. Its velocities become 0. Steps do not move it, and cost only what is
                          ///< awake. It wakes if an edit, a force or a setting changes it, or what it rests on. Default
                          ///< 0: never. The guide sleep.md has the rules.
    float sleep_time;     ///< s of simulated time, 0 to 1e6; default 0.5
    float relax_fraction; ///< 0 to 1: a stressed spring relaxes below this fraction of its warn strain; 0: it stays
                          ///< stressed; default 0.8
    float residual; ///< 0 to 1; default 0.01: the implicit solver stops iterating when r . z, a square of the forces
                    ///< out of balance, has fallen to this share of its value after the first iteration. 0: exactly
                    ///< `iterations`; 1: springs hardly act. With a floor it is squared, or the iterations double;
                    ///< bodies that touch have a tolerance of their own
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
} mspring_settings;
MSPRING_DEFAULT(mspring_settings, MSPRING_STRUCT_SETTINGS);

/// Flags of networks.
typedef enum mspring_network_flags {
    MSPRING_NETWORK_RESERVE_DAMPING = 1 << 0,  ///< springs may get damping later, though none has any now
    MSPRING_NETWORK_RESERVE_RELATIVE = 1 << 1, ///< relative springs may be added later, though there is none now
    /// Velocities have two words: gravity is right to 1e-6 at any number of substeps, with every solver. In explicit
    /// steps lengths of springs have two words, too: the energy of what nothing damps then stays, and stiff springs far
    /// from the local origin do not tremble. An explicit step takes 1.7 to 2.2 times as long; each particle takes 17
    /// bytes more. In implicit and direct steps second words of positions always count. Strains for breaking and stress
    /// use the first words.
    MSPRING_NETWORK_PRECISE = 1 << 2,
    /// Keep the positions of particles at creation, or when they were added, for the angle of mspring_body. Takes 16
    /// bytes a particle, also in whole snapshots and archives.
    MSPRING_NETWORK_POSES = 1 << 3
} mspring_network_flags;

/// A network at the start. settings stands last, because it may grow.
typedef struct mspring_network_def {
    uint32_t struct_size;
    uint32_t flags;           ///< bits of mspring_network_flags; default 0
    mspring_simd simd_level;  ///< highest level to use; default MSPRING_SIMD_AUTO. A level that this machine lacks is
                              ///< no limit. MSPRING_SIMD_SCALAR means the lowest level of this build. The environment
                              ///< variable MSPRING_SIMD (scalar, sse2, avx2, avx512, neon, wasm) can lower it further.
    uint32_t worker_count;    ///< threads that step the network, the caller's included, 1 to MSPRING_MAX_WORKERS;
                              ///< default 1. They take no signals, and sleep between steps. Ignored if tasks is set.
    uint32_t spare_particles; ///< particles that may be added later, with the builder's at most
                              ///< MSPRING_MAX_PARTICLES; default 0. The network reserves memory for them.
    uint32_t spare_springs;   ///< the same for springs, at most MSPRING_MAX_SPRINGS; default 0
    const mspring_allocator *allocator; ///< default NULL: malloc and free
    const mspring_tasks *tasks;         ///< threads of the host; default NULL: threads of the library
    const void *reserved_pointers[2];   ///< NULL
    uint32_t reserved[4];               ///< 0
    mspring_settings settings;
} mspring_network_def;
MSPRING_DEFAULT(mspring_network_def, MSPRING_STRUCT_NETWORK_DEF);

/* ------------------------------------------------------------------------------------------------------- builder */

/// Collects particles and springs. It can make any number of networks, and is not needed after that.
typedef struct mspring_builder mspring_builder;
/// A network: its topology and its state.
typedef struct mspring_network mspring_network;

/// Make an empty builder.
/// @param allocator  copied; NULL for malloc and free
/// Threads: any. Allocates: yes. Errors: ARGUMENT, STRUCT, MEMORY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_create(
    const mspring_allocator *allocator, mspring_builder **builder);

/// Free a builder. NULL is allowed.
/// Threads: exclusive. Allocates: never.
MSPRING_API void MSPRING_CALL mspring_builder_destroy(mspring_builder *builder);

/// Return the error message of the first call that failed to add or to read something; it stays until it is forgotten.
/// Without such a failure: that of the last call, "" if that succeeded. It names the culprit and is valid until the next
/// call. Print mspring_result_string() first. NULL gives "".
/// Threads: shared. Allocates: never.
MSPRING_API const char *MSPRING_CALL mspring_builder_error(const mspring_builder *builder);

/// Forget the first failure, to go on after it: for bindings that raise it at once.
/// Threads: exclusive. Allocates: never.
MSPRING_API void MSPRING_CALL mspring_builder_forget_error(mspring_builder *builder);

/// Return the number of particles, springs or elements added so far. NULL gives 0.
/// Threads: shared. Allocates: never.
MSPRING_API uint32_t MSPRING_CALL mspring_builder_count(const mspring_builder *builder, mspring_kind kind);

/// Add particles: all of them or, on error, none.
/// @param defs      [count], all with the same struct_size; the error message names the index
/// @param first_id  receives the id of the first; the others follow; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT, STRUCT, LIMIT, MEMORY.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_particles(
    mspring_builder *builder, const mspring_particle_def *defs, uint32_t count, mspring_id *first_id);

/// Add springs: all of them or, on error, none.
/// mspring_network_create() rejects a second spring between the same two particles, unless one only pulls or pushes.
/// @param defs      [count], as of mspring_builder_add_particles()
/// @param first_id  receives the id of the first; the others follow; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ID for a particle that does not exist; ARGUMENT also for a spring from a
/// particle to itself, or for MSPRING_REST_LENGTH_DISTANCE at distance 0; STRUCT, LIMIT, MEMORY.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_springs(
    mspring_builder *builder, const mspring_spring_def *defs, uint32_t count, mspring_id *first_id);

/// Add a lattice: all of it or, on error, nothing.
/// Particle ids follow the cells, row by row from the top, left to right. Spring ids follow the particles: each
/// brings those to its right, lower left, lower and lower right neighbour. Bend springs, right and down, come last.
/// @param cell_ids  [height][width], receives each cell's particle id or MSPRING_NONE; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT (the message names cell or material), STRUCT, LIMIT, MEMORY.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_lattice(
    mspring_builder *builder, const mspring_lattice_def *def, mspring_id *cell_ids);

/// Add a rope: all of it or, on error, nothing.
/// Ids of particles and of springs follow the rope from its first end to its second.
/// @param particles     [segment_count + 1] receives the ids along the rope, both ends included; may be NULL
/// @param first_spring  receives the id of the first spring; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: as mspring_builder_add_springs().
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_rope(
    mspring_builder *builder, const mspring_rope_def *def, mspring_id *particles, mspring_id *first_spring);

/// Add a mesh of triangles: all of it or, on error, nothing.
/// Particle ids follow the vertices. Spring ids follow the triangles: each brings its edges 0-1, 1-2 and 2-0, unless
/// an earlier triangle has brought them.
/// @param first_particle  receives the id of vertex 0; may be NULL
/// @param first_spring    receives the id of the first spring; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT also for a triangle without area, a vertex that does not exist
/// or is in no triangle; STRUCT, LIMIT, MEMORY.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_mesh(
    mspring_builder *builder, const mspring_mesh_def *def, mspring_id *first_particle, mspring_id *first_spring);

/// Add a disc: all of it or, on error, nothing.
/// Particle ids go from the centre outwards, each ring counter-clockwise from the right. The rim comes last.
/// @param first_particle  receives the id of the centre; may be NULL
/// @param first_spring    receives the id of the first spring; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: as mspring_builder_add_mesh().
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_disc(
    mspring_builder *builder, const mspring_disc_def *def, mspring_id *first_particle, mspring_id *first_spring);

/// Add copies of all particles, springs and elements of another builder: all or, on error, none.
/// Call it once for each kind of body of a batch. Copy i has the particles first_particle + i * p ..., with p the
/// number of particles of from, and its springs likewise.
/// @param from            another builder
/// @param count           copies, at least 1
/// @param x               [count] offset of copy i in x[i * stride], m; NULL with y: none
/// @param y               the same in y
/// @param first_particle  receives the first id; may be NULL
/// @param first_spring    receives the first id; may be NULL
/// Threads: exclusive for builder, shared for from. Allocates: yes. Errors: the first failure of from; ARGUMENT also
/// for a copy that is not within MSPRING_MAX_COORDINATE (the message names it), or if from has no particle; LIMIT,
/// MEMORY.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_copies(mspring_builder *builder,
    const mspring_builder *from, uint32_t count, const double *x, const double *y, uint32_t stride,
    mspring_id *first_particle, mspring_id *first_spring);

/// Add what a network holds now to a builder: to store it, to merge networks or to split one.
/// Adds the particles with position, velocity, mass and pin. Adds the springs between them that are not broken, with
/// their present rest length, stiffness, damping, strains, plastic strain and one-way flags. Adds the areas and angles
/// of which all particles are added, unless they are open. A network that is made from the builder has them, numbered
/// anew from 0. Settings, solver, floor, contact, colliders, groups, actuators, grips, hooks, forces and events are not
/// added. An inverse mass scale becomes 1, or a pin if it is 0. Ids keep their order.
///
/// A network that is created from the builder starts where the other is, but for the rounding of positions: its local
/// origin may differ. If the other has not moved since it was created from the same parts, both have the same bits.
/// After explicit steps velocities are half a substep old, and so are all of the builder's then: those of particles
/// that you add yourself afterwards, too. If it had particles with others before, all count as of now.
/// @param ids           [count] the particles, in any order; NULL: first ... first + count - 1
/// @param first         place in ids where they begin, or the first id
/// @param count         MSPRING_ALL is allowed
/// @param particle_ids  [particle count of the network] receives the builder's id of each, MSPRING_NONE if it was not
///                      added; may be NULL
/// @param spring_ids    [spring count of the network] receives the same for springs; may be NULL
/// Threads: exclusive for builder, shared for network. Allocates: yes. Errors: ID; ARGUMENT also for a particle out of
/// bounds (the builder's message names it); LIMIT, MEMORY.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_network(mspring_builder *builder,
    const mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, mspring_id *particle_ids,
    mspring_id *spring_ids);

/// Read particles of a builder back, as definitions that would add them again.
/// @param ids    [count]; NULL: the particles first ... first + count - 1
/// @param first  the first place in ids, or the first id
/// @param defs   [count], struct_size set in the first, the same for all
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_get_particles(mspring_builder *builder,
    const mspring_id *ids, mspring_id first, uint32_t count, mspring_particle_def *defs);

/// Read springs back: with the rest length in metres, and damping in N s/m or as a fraction, never as a ratio.
/// @param ids  as in mspring_builder_get_particles()
/// @param first  as ids
/// @param defs  as ids
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_get_springs(mspring_builder *builder,
    const mspring_id *ids, mspring_id first, uint32_t count, mspring_spring_def *defs);

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
/// Threads: exclusive. Allocates: yes; size and 100 bytes for each particle and spring. Errors: SNAPSHOT (the message
/// says what is wrong), ARGUMENT also for a builder that is not empty, MEMORY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_read(
    mspring_builder *builder, const void *archive, size_t size, uint32_t *skipped);

/// Fill a network's definition from the builder's archive: settings, flags and spare room. Without an archive,
/// fill in the defaults.
/// Threads: exclusive for builder. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_builder_get_network_def(
    mspring_builder *builder, mspring_network_def *def);

/* ------------------------------------------------------------------------------------------------------- network */

/// Make a network of what the builder holds.
/// Finds lattices and chains in it, whatever the order in which they were added, and lays the state out for them. On
/// failure the builder has the error message. If an earlier call on the builder failed, this returns that failure.
///
/// If the builder has read an archive, the network continues where the archived one was. Then def may change the
/// settings, workers and the allocator. Flags and spare room must be the archive's.
/// @param def  NULL for the defaults, or for the archive's definition (mspring_builder_get_network_def())
/// Threads: exclusive for builder. Allocates: yes. Errors: the builder's first failure; ARGUMENT also for a builder
/// without particles; DUPLICATE if two springs join the same two particles; THREAD if a worker cannot start; SNAPSHOT
/// for an archive with impossible values; STRUCT, LIMIT, MEMORY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_create(
    mspring_builder *builder, const mspring_network_def *def, mspring_network **network);

/// Free a network. NULL is allowed. Not allowed inside a hook.
/// Threads: exclusive. Allocates: never.
MSPRING_API void MSPRING_CALL mspring_network_destroy(mspring_network *network);

/// Return the error message of a call that failed: the last exclusive one, or the first shared one after it.
/// As mspring_builder_error(). An exclusive call clears it first, so "" follows if that succeeds. A shared call that
/// fails sets it, unless one has done so since the last exclusive call. So it stays as it is until the next of these.
/// Threads: shared. Allocates: never.
MSPRING_API const char *MSPRING_CALL mspring_network_error(const mspring_network *network);

/// Return how many particles, springs and so on there are, removed ones included. All ids are below it. NULL gives 0.
/// Threads: shared. Allocates: never.
MSPRING_API uint32_t MSPRING_CALL mspring_network_count(const mspring_network *network, mspring_kind kind);

/// Differences of a clone from its original.
typedef struct mspring_clone_def {
    uint32_t struct_size;
    uint32_t copy_hooks;                ///< 1: the clone has the original's hooks, see mspring_hook_def; default 0
    const mspring_allocator *allocator; ///< default NULL: as the original's, with the same user
    const mspring_tasks *tasks;         ///< as in mspring_network_def; default NULL
    uint32_t worker_count;              ///< as in mspring_network_def; default 1, whatever the original has
    uint32_t reserved;                  ///< 0
} mspring_clone_def;
MSPRING_DEFAULT(mspring_clone_def, MSPRING_STRUCT_CLONE_DEF);

/// Make an independent copy of a network.
/// The same calls on both give the same bits: the copy has settings, edits, solver history and events. It has workers
/// of its own, and no job that is under way. To keep and restore a state often, mspring_network_save() is cheaper.
/// @param def    NULL for the defaults
/// @param clone  receives the copy; free it by mspring_network_destroy()
/// Threads: shared. Allocates: yes, with the clone's allocator. Errors: ARGUMENT also for more workers than the
/// original has, if hooks have storage; STRUCT, MEMORY, BUSY; THREAD if a worker cannot start.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_clone(
    const mspring_network *network, const mspring_clone_def *def, mspring_network **clone);

/// How a network is laid out and run. mspring_network_describe() (lab.h) tells more.
typedef struct mspring_network_info {
    uint32_t struct_size;
    mspring_simd simd_level;    ///< the instruction set that runs
    uint32_t worker_count;      ///< 1 in a build without threads
    uint32_t busy_workers;      ///< workers that share explicit steps: 1 if the network is too small
    uint32_t lattice_springs;   ///< springs that need no index: of grids with 8 neighbours
    uint32_t chain_springs;     ///< the same of ropes
    uint32_t irregular_springs; ///< all others; they cost several times as much
    uint32_t particle_room;     ///< particles that may be added now
    uint32_t spring_room;       ///< springs that may be added now
    uint32_t reserved;          ///< 0
    uint64_t memory_used;       ///< bytes that the network has allocated
} mspring_network_info;
MSPRING_DEFAULT(mspring_network_info, MSPRING_STRUCT_NETWORK_INFO);

/// Read how a network is laid out and run.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_info(
    const mspring_network *network, mspring_network_info *info);

/// Read the settings that the next step uses.
/// If you set them again, nothing changes. With MSPRING_GUARD_RETRY, substeps is the number of the next step. Numbers
/// that were set to 0 may come back as the ones in use.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_settings(
    const mspring_network *network, mspring_settings *settings);

/// Set all settings or, on error, none. The state goes on from where it is. To change one, get them, change it, set
/// them:
///
///     mspring_settings settings = mspring_settings_default();
///     mspring_result result = mspring_network_get_settings(network, &settings);
///     settings.gravity_y = -1.6f;
///     if (!result) result = mspring_network_set_settings(network, &settings);
///
/// A value that is set already changes nothing. A new gravity, sleep_speed, sleep_time or relax_fraction wakes all.
/// Threads: exclusive. Allocates: for a solver, a guard or sleep that was not in use. Errors: ARGUMENT
/// (the message names the field and its value), also for a solver that this build lacks; LIMIT if the solver's matrix
/// is too large (the message says how large); STRUCT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_settings(
    mspring_network *network, const mspring_settings *settings);

/* ---------------------------------------------------------------------------------------------------------- step */

/// Evolve the network by dt.
/// If a coordinate or speed would end out of bounds, motion would grow by instability (mspring_guard), or a hook
/// refuses, the step is rolled back. The state is then that before the step, bit for bit, and forces given for it are
/// still there. The message and mspring_step_info name a particle or a spring. Use a shorter dt, more substeps or lower
/// stiffness.
///
/// Pass equal dt. The explicit solver keeps another energy at each length of substep. A dt that differs from step to
/// step, as a frame's time does, therefore adds energy where nothing damps; no guard sees it. If dt must vary, damp
/// (springs, or global_damping), or use MSPRING_SUBSTEPS_EVEN, or set substeps that keep h = dt / substeps below 0.7 of
/// any_shape (mspring_network_get_stable_dt()): then it grows more slowly. Motion so violent that neighbours pass over
/// a third of a spring's length in a substep adds energy, too: MSPRING_SUBSTEPS_AUTO takes more substeps for it, a
/// number of your own should.
///
/// The first kick of an explicit step lasts for half of the substep before, too. So a dt that falls to a hundredth may
/// set bodies at rest on a floor moving at gravity times that half (4 cm/s from 1/30 to 1e-6 s with four substeps
/// before).
/// @param dt  s, > 0; as a float, dt / substeps must be finite and at least 1.2e-38
/// Threads: exclusive. Allocates: only where contact needs more room (mspring_contact_def.max_capacity). Errors:
/// ARGUMENT, UNSTABLE, BUSY; THREAD in a child of fork(); MEMORY for that room; what a hook refused with; LIMIT if
/// contact finds more pairs than max_capacity, or compares too many (mspring_network_set_contact()).
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_step(mspring_network *network, double dt);

/// Flags of mspring_step_info: how a step was made.
typedef enum mspring_step_flags {
    MSPRING_STEP_FALLBACK = 1 << 0, ///< by one substep of the implicit solver (MSPRING_GUARD_IMPLICIT)
    MSPRING_STEP_CLAMPED = 1 << 1,  ///< with clamped strain rates (MSPRING_GUARD_CLAMP, _CLAMP_BOUNDS)
    MSPRING_STEP_PUT_BACK = 1 << 2, ///< particles were put back into the bounds (MSPRING_GUARD_CLAMP_BOUNDS)
    MSPRING_STEP_RETRIED = 1 << 3,  ///< with more substeps than were set (MSPRING_GUARD_RETRY)
    MSPRING_STEP_ASLEEP = 1 << 4,   ///< all of the network slept: nothing was computed
    MSPRING_STEP_FEWER = 1 << 5, ///< with fewer substeps, or parts of these, than its violent motion needs
                                  ///< (mspring_settings.most_work)
    MSPRING_STEP_GREW = 1 << 6   ///< contact allocated room for more pairs (mspring_contact_def.max_capacity)
} mspring_step_flags;

/// Report of the last step, and of all steps so far.
typedef struct mspring_step_info {
    uint32_t struct_size;
    mspring_result result;   ///< of the last step; MSPRING_OK before the first
    mspring_id particle;     ///< cause of a rejection, or of what the guard did; or MSPRING_NONE
    mspring_id spring;       ///< the same for a spring
    uint32_t flags;          ///< of the last step: bits of mspring_step_flags
    uint32_t substeps;       ///< of the last step that succeeded, with pieces of cut ones; 0 before
    uint64_t step_count;     ///< steps that have succeeded
    uint64_t fallback_count; ///< of these with MSPRING_STEP_FALLBACK or MSPRING_STEP_CLAMPED
    double time;             ///< simulated time of these, s: that of the state
    double time_left;        ///< with MSPRING_SUBSTEPS_EVEN or substep_length: dt that steps were given and have not
                             ///< taken yet, s; < 0: they are ahead
    double work;             ///< of the last step, even if it failed, in calm steps (mspring_settings.most_work): 1 if
                             ///< nothing was repeated or raised; 0 if nothing was computed
    uint32_t is_asleep;      ///< 1: all of the network sleeps now
    uint32_t reserved;       ///< 0
} mspring_step_info;
MSPRING_DEFAULT(mspring_step_info, MSPRING_STRUCT_STEP_INFO);

/// Read the report of the last step. Costs next to nothing: call it after each step.
/// Snapshots and clones have step_count, fallback_count, time, time_left and substeps. After loading a snapshot, the
/// rest is that of a new network. Inside a hook it is that of the step before.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_step_info(
    const mspring_network *network, mspring_step_info *info);

/// Wake all of a network. It sleeps again after it has been slow for sleep_time.
/// Threads: exclusive. Allocates: never. Errors: ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_wake(mspring_network *network);

/* -------------------------------------------------------------------------------------------------------- forces */

/// Add a force (N) to one particle, during the whole next step.
/// Threads: exclusive. Allocates: at the first force given to a network. Errors: ID; ARGUMENT also if the sum of its
/// forces is not finite; MEMORY; BUSY (in a hook use its force arrays).
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_force(
    mspring_network *network, mspring_id particle, float x, float y);

/// How long a force acts.
typedef enum mspring_push {
    MSPRING_PUSH_STEP = 0,    ///< a force, N, during the whole next step
    MSPRING_PUSH_SUBSTEP = 1, ///< a force, N, during the first substep of the next step: a blow that ends at once
    MSPRING_PUSH_IMPULSE = 2, ///< an impulse, N s: velocities change at once, by impulse / mass *
                              ///< MSPRING_INVERSE_MASS_SCALE; pinned particles ignore it
    MSPRING_PUSH_INT = MSPRING_ENUM_INT ///< no value
} mspring_push;

/// Add forces or impulses to many particles: to all or, on error, to none. On an id that repeats they add up.
/// @param x       that of element i in x[i * stride]
/// @param y       the same in y
/// @param stride  0: the same on all
/// Threads: exclusive. Allocates: at the first force of each kind given to a network. Errors: ID; ARGUMENT also if a sum
/// of forces is not finite or a velocity would exceed MSPRING_MAX_SPEED; MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_forces(mspring_network *network,
    mspring_push push, const mspring_id *ids, mspring_id first, uint32_t count, const float *x, const float *y,
    uint32_t stride);

/// Add a torque (N m) to a body during the next step. It acts as forces around the centre of mass, whose sum is 0.
/// The force on a particle is proportional to its mass and to its distance from the centre, so it turns a rigid body
/// without bending it. Pinned particles get no force, and do not count for the centre. For a motor, apply the opposite
/// torque to another body.
/// @param ids     [count] the particles; a repeated id counts each time; NULL: first ... first + count - 1, without
///                removed ones
/// @param first   place in ids where they begin, or the first id
/// @param torque  N m, counterclockwise
/// Threads: exclusive. Allocates: at the first force given to a network. Errors: ID; ARGUMENT also if no particle is
/// free or all free ones are in one place, or if a sum of forces is not finite; MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_apply_torque(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, float torque);

/* --------------------------------------------------------------------------------------------------------- state */

/// Read world positions (m) of particles.
/// @param x  receives that of element i in x[i * stride]
/// @param y  the same for y
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_positions(const mspring_network *network,
    const mspring_id *ids, mspring_id first, uint32_t count, double *x, double *y, uint32_t stride);

/// Set world positions (m) of particles: all or, on error, none. Of an id that repeats, the last value counts.
/// If you set all particles by a range, the local origin moves to them.
/// @param x  at most MSPRING_MAX_COORDINATE in size, also relative to the local origin
/// @param y  the same
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT (the message names the particle), BUSY (in a hook use its
/// arrays).
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_positions(mspring_network *network,
    const mspring_id *ids, mspring_id first, uint32_t count, const double *x, const double *y, uint32_t stride);

/// Read velocities (m/s), as mspring_network_get_positions(). They are single precision. Explicit steps leave those of
/// half a substep ago.
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_velocities(const mspring_network *network,
    const mspring_id *ids, mspring_id first, uint32_t count, float *vx, float *vy, uint32_t stride);

/// Set velocities (m/s, within MSPRING_MAX_SPEED), as mspring_network_set_positions(). A pinned particle moves by it.
/// After explicit steps they are taken as those of half a substep ago.
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_velocities(mspring_network *network,
    const mspring_id *ids, mspring_id first, uint32_t count, const float *vx, const float *vy, uint32_t stride);

/// The state as it lies in memory, to read: arrays by slot.
/// Pointers stay valid, and their contents follow the steps, until layout_generation changes. A step may move the
/// origin, and origin_x and origin_y are copies: get the view again after steps. To write, use a hook's arrays.
typedef struct mspring_view {
    uint32_t struct_size;
    uint32_t slot_count;     ///< length of the arrays by slot; some slots hold no particle
    uint32_t particle_count; ///< length of slot_of_particle
    uint32_t reserved;       ///< 0
    /// Changes if particles or springs are added or removed, also by a snapshot, or the layout changes.
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
MSPRING_DEFAULT(mspring_view, MSPRING_STRUCT_VIEW);

/// Get a view of the state. It slows no later step.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_view(const mspring_network *network, mspring_view *view);

/// Hash the state: positions, velocities, their lag and local origin, in id order.
/// Equal states have equal hashes on every machine. The hash is not cryptographic.
/// Threads: shared. Allocates: never. Errors: ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_state_hash(const mspring_network *network, uint64_t *hash);

/* ---------------------------------------------------------------------------------------------------- properties */

/// A property: one number of each thing of one kind. Bits 8 and up of its value are the kind (mspring_kind). Bit 7 is
/// set if it is an integer (uint32_t), clear if it is a float. "[read]": it can only be read. "[allocates]": the first
/// call that changes a value allocates.
typedef enum mspring_property {
    /// Particles. kg, 1e-30 to 1e30, for cargo or flooding. A pinned particle keeps its mass. Relative springs follow:
    /// new masses of many particles take a pass over all of them. [allocates] where springs are relative
    MSPRING_MASS = 0x000,
    /// Scale of the response to forces, 0 or 1e-6 to 1. 1 is normal, 0 is pinned. It scales neither gravity nor the
    /// mass in energy and momentum. [allocates]
    MSPRING_INVERSE_MASS_SCALE = 0x001,
    MSPRING_X = 0x002,                ///< world position, m, rounded to float: to draw [read]
    MSPRING_Y = 0x003,                ///< [read]
    MSPRING_VX = 0x004,               ///< m/s [read]
    MSPRING_VY = 0x005,               ///< [read]
    /// Against bodies, 0 to 1e6; -1, the default: the contact's. Where two touch, it is the square root of the product
    /// of both. Against a collider or the floor its value stands for -1, and is the other one of the two. Needs
    /// contact; a new value wakes all. Snapshots leave it as it is, and clones have it. [allocates]
    MSPRING_FRICTION = 0x006,
    MSPRING_RESTITUTION = 0x007,      ///< the same, 0 to 1; of two that touch the larger one counts [allocates]
    /// N s that the floor gave in the last step; 0 without a floor. Over dt it is the mean force, but not in an
    /// explicit step after one of another dt: its first impulses last for half of the substep before and half of their
    /// own. Sleepers keep theirs; after a load or a reset it is 0. [read]
    MSPRING_FLOOR_IMPULSE_X = 0x008,
    MSPRING_FLOOR_IMPULSE_Y = 0x009,  ///< [read]
    /// N s that bodies and colliders gave across their surfaces in the last step: the sum of sizes. The ends of a spring
    /// that was touched have their shares. 0 without contact, and after a load or a reset; sleepers keep theirs. Steps
    /// of the explicit solver leave out what pushed an overlap apart. [read]
    MSPRING_TOUCH = 0x00a,
    MSPRING_RELATIVE_X = 0x00b,       ///< m from the centre of mass of its group (batch.h), or world's origin [read]
    MSPRING_RELATIVE_Y = 0x00c,       ///< [read]
    MSPRING_RELATIVE_VX = 0x00d,      ///< m/s against the velocity of its group's centre of mass [read]
    MSPRING_RELATIVE_VY = 0x00e,      ///< [read]
    MSPRING_PARTICLE_FLAGS = 0x080,   ///< bits of mspring_particle_flags [read]
    MSPRING_LAYERS = 0x081,           ///< bits: the layers that it is on, for contact; default 1. Needs contact
    /// Bits: the layers that it touches; default all. Two particles may touch if each is on a layer that the other
    /// touches. A spring may touch what both its ends may. Needs contact
    MSPRING_MASKS = 0x082,
    MSPRING_COMPONENT = 0x083,        ///< number of its component, as of the last update; MSPRING_NONE before [read]
    MSPRING_SLOT = 0x084,             ///< slot in a view; changes with its layout_generation [read]

    /// Springs. Nominal stiffness, N/m, 0 to 1e30; of a relative one its fraction. A broken one gets it when restored.
    /// [allocates] if one is relative
    MSPRING_STIFFNESS = 0x100,
    /// Nominal damping, N s/m, 0 to 1e30, or a fraction. Values above 0 need a spring that was made with damping, or
    /// MSPRING_NETWORK_RESERVE_DAMPING. [allocates] if one is relative
    MSPRING_DAMPING = 0x101,
    /// Rest length as you gave it, m, 0 to 4e12, for muscles and winches; 0 is a weld: its ends rest in the same place.
    /// What the spring has yielded comes on top: MSPRING_ACTIVE_REST_LENGTH. Writing it ends a ramp, even with the
    /// value that it has. [allocates]
    MSPRING_REST_LENGTH = 0x102,
    /// > 0. If the size of a spring's strain exceeds it at the end of a step, the spring breaks. A yielding spring
    /// breaks by its strain against MSPRING_REST_LENGTH. If substeps are too long to follow a blow, strains are wrong.
    /// [allocates]
    MSPRING_BREAK_STRAIN = 0x103,
    /// > 0. If the size of a spring's strain exceeds it at the end of a step, the spring is stressed until it relaxes.
    /// [allocates]
    MSPRING_WARN_STRAIN = 0x104,
    /// >= 0, or MSPRING_RELAX_STRAIN_DEFAULT. A stressed spring relaxes at the end of a step, if the size of its strain
    /// is below its relax strain and its warn strain. 0: it stays stressed. [allocates]
    MSPRING_RELAX_STRAIN = 0x105,
    MSPRING_YIELD_STRAIN = 0x106,   ///< > 0: beyond it the rest length changes for good; see laws.h [allocates]
    MSPRING_HARDENING = 0x107,      ///< 0 to 10; see laws.h [allocates]
    MSPRING_PLASTIC_LIMIT = 0x108,  ///< 0 to 0.9: of the plastic strain; see laws.h [allocates]
    MSPRING_PLASTIC_STRAIN = 0x109, ///< -0.9 to 0.9: active / given rest length - 1; 0 straightens it [allocates]
    MSPRING_LENGTH = 0x110,         ///< m [read]
    MSPRING_DIRECTION_X = 0x111,    ///< unit vector from end a to end b, (0, 0) for length 0 [read]
    MSPRING_DIRECTION_Y = 0x112,    ///< [read]
    MSPRING_STRAIN = 0x113,         ///< length / active rest length - 1; of a weld length / 1 m; 0 if broken [read]
    MSPRING_TENSION = 0x114,        ///< force along it, N, damper included; > 0 pulls its ends together [read]
    MSPRING_ACTIVE_STIFFNESS = 0x115,   ///< in force, N/m; of a relative one that of the last step; 0 if broken [read]
    MSPRING_ACTIVE_DAMPING = 0x116,     ///< the same, N s/m [read]
    MSPRING_ACTIVE_REST_LENGTH = 0x117, ///< in force, m: with ramp, signal and plastic strain [read]
    MSPRING_SPRING_FLAGS = 0x180,       ///< bits of mspring_spring_flags [read]
    MSPRING_END_A = 0x181,              ///< particle, as it was given; of a lattice's springs the lower id [read]
    MSPRING_END_B = 0x182,              ///< the other; MSPRING_NONE if it was removed [read]
    MSPRING_SLOT_A = 0x183,             ///< the same as slots of a view: for an index buffer [read]
    MSPRING_SLOT_B = 0x184,             ///< [read]

    MSPRING_ELEMENT_STIFFNESS = 0x200, ///< elements (laws.h): N/m of an area, N m/rad of an angle, 0 to 1e30
    MSPRING_ELEMENT_DAMPING = 0x201,   ///< of an angle, N m s/rad, 0 to 1e30
    MSPRING_PRESSURE = 0x202,          ///< of an area, N/m, at most 1e30 in size; of a gas >= 0
    MSPRING_FILL = 0x203,              ///< of an area, 0.01 to 100
    MSPRING_REST_AREA = 0x204,         ///< m^2, as in mspring_area_def
    MSPRING_REST_ANGLE = 0x205,        ///< rad, at most 1e6 in size: for muscles and servos; no edit to frames
    MSPRING_AREA = 0x210,              ///< of an area now, m^2; below 0 if it is inside out [read]
    MSPRING_ACTIVE_PRESSURE = 0x211,   ///< of an area now, N/m [read]
    MSPRING_ANGLE = 0x212,             ///< now, rad, -pi to pi [read]
    MSPRING_TORQUE = 0x213,            ///< N m, without damping; above 0 it turns the second arm to the left [read]
    MSPRING_ELEMENT_ENERGY = 0x214,    ///< J [read]
    MSPRING_ELEMENT_FLAGS = 0x280,     ///< bits of mspring_element_flags (laws.h) [read]

    MSPRING_GROUP_X = 0x300,     ///< groups (batch.h): centre of mass, m, world coordinates [read]
    MSPRING_GROUP_Y = 0x301,     ///< [read]
    MSPRING_GROUP_VX = 0x302,    ///< its velocity, m/s [read]
    MSPRING_GROUP_VY = 0x303,    ///< [read]
    MSPRING_GROUP_MIN_X = 0x304, ///< smallest box around the particles, m, world coordinates [read]
    MSPRING_GROUP_MIN_Y = 0x305, ///< [read]
    MSPRING_GROUP_MAX_X = 0x306, ///< [read]
    MSPRING_GROUP_MAX_Y = 0x307, ///< [read]
    MSPRING_GROUP_FLAGS = 0x380, ///< bits of mspring_group_flags (batch.h) [read]

    MSPRING_SIGNAL = 0x400,          ///< actuators (batch.h): rest length over that at first, 0.01 to 100
    MSPRING_ACTUATOR_SPRING = 0x480, ///< its spring [read]

    MSPRING_PROPERTY_INT = MSPRING_ENUM_INT ///< no value
} mspring_property;

/// Read a property.
/// @param values  receives that of element i in values[i * stride]; what lies between is left alone
/// Threads: shared. Allocates: never. Errors: ID; ARGUMENT also for a property of integers.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get(const mspring_network *network, mspring_property property,
    const mspring_id *ids, mspring_id first, uint32_t count, float *values, uint32_t stride);

/// Set a property: all values or, on error, none. Of an id that repeats, the last value counts.
/// A value that is set already costs a comparison: it wakes nothing, and is no edit to snapshots. The second call for a
/// range of 64 springs or more copies the values of this property, 4 bytes a spring. To send the same values again then
/// takes a comparison of two arrays, unless another edit of springs came between. Without memory for the copy, calls
/// only take longer.
/// @param values  that of element i in values[i * stride]
/// Threads: exclusive. Allocates: as the property says. Errors: ID; ARGUMENT also for a property that is unknown, read
/// only or of integers (the message names property, id and value); MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set(mspring_network *network,
    mspring_property property, const mspring_id *ids, mspring_id first, uint32_t count, const float *values,
    uint32_t stride);

/// Read a property of integers, as mspring_network_get().
/// Threads: shared. Allocates: never. Errors: ID; ARGUMENT also for a property of floats.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_integers(const mspring_network *network,
    mspring_property property, const mspring_id *ids, mspring_id first, uint32_t count, uint32_t *values,
    uint32_t stride);

/// Set a property of integers, as mspring_network_set().
/// Threads: exclusive. Allocates: as the property says. Errors: as mspring_network_set().
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_integers(mspring_network *network,
    mspring_property property, const mspring_id *ids, mspring_id first, uint32_t count, const uint32_t *values,
    uint32_t stride);

/// Where mspring_network_get_columns() writes a property. This struct never changes.
typedef struct mspring_column {
    mspring_property property;
    uint32_t stride; ///< values from one element to the next, at least 1
    void *values;    ///< float or uint32_t, as the property says; that of element i in values[i * stride]
} mspring_column;

/// Read several properties of the same things in one pass: for inspectors, index buffers, pictures and strains.
/// Lengths, directions and strains together cost one square root a spring. Two columns with stride 2, the second one
/// value further, fill an array of vectors.
/// @param columns  [column_count], all of one kind
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT (the message names the column).
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_columns(const mspring_network *network,
    const mspring_id *ids, mspring_id first, uint32_t count, const mspring_column *columns, uint32_t column_count);

/* --------------------------------------------------------------------------------------------------------- edits */

/// Break springs: they exert nothing until they are restored.
/// Ids, rest lengths and nominal values stay. A broken spring stays broken.
/// Threads: exclusive. Allocates: at the first break in a network. Errors: ID (the message names the index), ARGUMENT,
/// MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_break_springs(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);

/// Restore broken springs to their nominal stiffness and damping.
/// With a ramp, the rest length goes evenly from the present length to its own, so that the spring does not kick its
/// ends. A weld (rest length 0) has no ramp.
/// @param ramp_seconds  simulated time, 0 to 1e6; 0: no ramp
/// Threads: exclusive. Allocates: for ramps and rest lengths; if a compacted network must be expanded
/// (mspring_network_compact()). Errors: as mspring_network_break_springs().
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_restore_springs(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, double ramp_seconds);

/// Break all springs of particles, which become loose.
/// Threads: exclusive. Allocates: at the first break and first detachment. Errors: as mspring_network_break_springs().
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_detach_particles(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);

/// Add particles, as many as spare_particles has room for: all or, on error, none.
/// They get the lowest free ids. A view stays valid, but for its particle_count. After explicit steps their velocities,
/// too, count as half a substep old.
/// @param defs  [count], positions also within MSPRING_MAX_COORDINATE of the local origin
/// @param ids   [count], receives their ids
/// Threads: exclusive. Allocates: never. Errors: LIMIT if there is no room (the message says how much there is);
/// ARGUMENT or STRUCT (the message names the definition); BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_particles(
    mspring_network *network, const mspring_particle_def *defs, uint32_t count, mspring_id *ids);

/// Add springs, as many as spare_springs has room for: all or, on error, none.
/// MSPRING_REST_LENGTH_DISTANCE is the present distance. The layout does not know added springs: as long as there are
/// any, explicit substeps are slower, until mspring_network_compact() takes them in.
/// @param defs  [count]; relative or damped springs need some in the network, or MSPRING_NETWORK_RESERVE_RELATIVE or
///              MSPRING_NETWORK_RESERVE_DAMPING
/// @param ids   [count], receives their ids: the lowest free ones
/// Threads: exclusive. Allocates: at the first break, warn or relax strain in a network. Errors: as
/// mspring_network_add_particles(); ID for a particle that does not exist; DUPLICATE if the two are joined already,
/// broken or not; ARGUMENT also with the direct solver: set another one first; MEMORY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_springs(
    mspring_network *network, const mspring_spring_def *defs, uint32_t count, mspring_id *ids);

/// Remove particles with all their springs, for good. Springs that were not broken give MSPRING_EVENT_BROKEN.
/// Threads: exclusive. Allocates: at the first break, detachment and removal. Errors: as
/// mspring_network_break_springs().
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_particles(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);

/// Remove springs, for good.
/// Threads: exclusive. Allocates: at the first break, detachment and removal. Errors: as
/// mspring_network_break_springs().
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_springs(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);

/// Allow that added particles and springs get ids of added ones that were removed.
/// Until then these ids, and their room, count as used. Ids that the network was created with are never used again.
/// Threads: exclusive. Allocates: never. Errors: ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_reuse_ids(mspring_network *network);

/// Leave broken springs out of the plan, and take added ones in.
/// A step then costs only the springs that are left. Compaction is worth its time if a quarter of the springs has
/// broken, or if added springs are to stay. Ids and values stay. Slots change: fill views again. Forces are summed in
/// another order from then on, so the next steps differ by rounding. They are the same on every machine. Earlier
/// snapshots no longer fit. To spread the work over frames, or to another thread, use a job. The guide
/// examples/guides/edits.md has the details.
/// Threads: exclusive. Allocates: yes, and frees most. Errors: ARGUMENT, MEMORY, LIMIT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_compact(mspring_network *network);

/* ----------------------------------------------------------------------------------------- events and components */

/// Kind of an event.
typedef enum mspring_event_kind {
    MSPRING_EVENT_BROKEN = 0,   ///< spring id broke, by its strain after a step or by an edit. By an edit strain is 0,
                                ///< and other is the particle that was detached or removed, if any
    MSPRING_EVENT_STRESSED = 1, ///< the strain of spring id exceeded its warn strain
    MSPRING_EVENT_RELAXED = 2,  ///< and fell below its relax strain
    MSPRING_EVENT_RESTORED = 3, ///< spring id was restored
    MSPRING_EVENT_DETACHED = 4, ///< particle id was detached; after the events of its springs
    MSPRING_EVENT_SPLIT = 5,    ///< the component whose lowest particle is other split off from that of id
    MSPRING_EVENT_JOINED = 6,   ///< the component whose lowest particle was id is now part of that of other
    MSPRING_EVENT_YIELDED = 7,  ///< spring id yielded in a step; strain is its plastic strain
    MSPRING_EVENT_KIND_INT = MSPRING_ENUM_INT ///< no value
} mspring_event_kind;

/// An event of a step or of an edit. This struct never changes.
typedef struct mspring_event {
    mspring_event_kind kind;
    mspring_id id;    ///< of a spring or a particle, by kind
    mspring_id other; ///< by kind; or MSPRING_NONE
    float strain;     ///< of the spring when it happened, signed; or 0
} mspring_event;

/// Reserve room for events, which are recorded from then on.
/// Events that were not read yet are dropped.
/// @param capacity  events that may wait to be read, at most MSPRING_MAX_SPRINGS; 0: record none
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_reserve_events(
    mspring_network *network, uint32_t capacity);

/// Read and remove the oldest events, in the order in which they happened.
/// Within a step the order depends on the network alone: it is the same on every machine.
/// @param events  [capacity]; may be NULL if capacity is 0
/// @param count   receives how many were read
/// @param lost    receives how many were lost to a full queue since it was reserved; may be NULL
/// Threads: exclusive. Allocates: never. Errors: ARGUMENT, BUSY.
MSPRING_API mspring_result MSPRING_CALL mspring_network_read_events(
    mspring_network *network, mspring_event *events, uint32_t capacity, uint32_t *count, uint64_t *lost);

/// Update the components: particles connected by springs that are not broken.
/// A component is named by its lowest particle, and numbered from 0 in that order. Changes since the last update give
/// MSPRING_EVENT_SPLIT and MSPRING_EVENT_JOINED. Without changes the call costs next to nothing.
/// @param count    receives the number of components; may be NULL
/// @param changed  receives 1 if a particle's component has another number than the last time, else 0; may be NULL
/// Threads: exclusive. Allocates: the first time. Errors: ARGUMENT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_update_components(
    mspring_network *network, uint32_t *count, uint32_t *changed);

/* -------------------------------------------------------------------------------------------------- measurements */

/// Set of particles as one body. Pinned particles count unless a field says otherwise.
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
MSPRING_DEFAULT(mspring_body, MSPRING_STRUCT_BODY);

/// Measure particles as one body: position and angle of a sprite, box for a camera, momentum.
/// Sums are in double precision and relative to the centre of mass, so a body far from the world's origin loses no
/// digits. Velocities are those that mspring_network_get_velocities() reads: after explicit steps, half a substep old.
/// Without particles all sums are 0, and the position is that of the local origin. The angle is a fit without
/// reflection or scale (Kabsch 1976).
/// @param ids    [count] the particles; a repeated id counts each time; NULL: first ... first + count - 1, without
///               removed ones
/// @param first  the first place in ids, or the first id
/// @param count  MSPRING_ALL is allowed
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_body(const mspring_network *network, const mspring_id *ids,
    mspring_id first, uint32_t count, mspring_body *body);

/// Measure the components first ... first + count - 1 of the last update, as they are now.
/// @param bodies  [count], struct_size set in the first, the same for all
/// Threads: shared. Allocates: never. Errors: ID; STRUCT; ARGUMENT also if there was no update yet.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_components(
    const mspring_network *network, uint32_t first, uint32_t count, mspring_body *bodies);

/// Energies and extremes of a network.
typedef struct mspring_energy {
    uint32_t struct_size;
    uint32_t bent_springs; ///< springs whose plastic strain is not 0 now
    double kinetic;        ///< J: sum of m v^2 / 2 over particles that are not pinned, with velocities of now if only
                           ///< springs, gravity and global damping act; else with those that you read
    double elastic;        ///< J: of springs and elements, with what hardening stores; of relative springs with the
                           ///< stiffness of the last step
    double potential;      ///< J: - sum of m (gravity . p) over particles that are not pinned, p in world coordinates
    double dissipated;     ///< J that yielding has turned into heat; no step lowers it. What a substep stretches beyond
                           ///< the yield strain takes no work, and makes none
    uint64_t yield_count;  ///< springs that yielded in a step, summed over all steps
    double largest_speed;  ///< m/s
    mspring_id fastest;    ///< the particle that has it; of several the lowest; or MSPRING_NONE
    mspring_id strained;   ///< the spring with the strain of the largest size; or MSPRING_NONE
    double largest_strain; ///< its strain, signed
} mspring_energy;
MSPRING_DEFAULT(mspring_energy, MSPRING_STRUCT_ENERGY);

/// Compute the energies and extremes, in double precision. Takes as long as about a hundred explicit substeps: for
/// the largest strain alone, get MSPRING_STRAIN.
/// Snapshots and clones have dissipated and yield_count.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_energy(
    const mspring_network *network, mspring_energy *energy);

/// Compute the longest stable explicit substep (s) of this network.
/// If a substep is longer, the fastest oscillation reverses and grows in each substep.
///
/// Let lambda be the largest eigenvalue (Lanczos 1950) of
///     h^2 M^-1 K + 2 h M^-1 C.
/// Here h is a substep, M the masses, K the stiffness of a shape, C the dampers. Pinned particles are left out. Small
/// motion about the shape is stable exactly if lambda <= 2 x / tanh(x / 2) with x = global_damping h, or 4 if that is
/// 0. For one mode of angular frequency omega and damping ratio zeta this is omega h <= 2 (sqrt(1 + zeta^2) - zeta).
///
/// In K a compressed spring has stiffness along its direction only. mspring_guard uses the tangent stiffness, which
/// has a negative part across it, too. So in a compressed shape now is shorter than the guard's limit, and safe.
/// Relative springs follow h. If all springs are relative, every h is stable (limit infinite) or none (0).
/// @param now        receives the limit in the present shape, to about 0.3 %, rather too short than too long. If
///                   you stretch a network, it stiffens across and this limit gets shorter. May be NULL.
/// @param any_shape  receives the limit in any shape that the network can reach, tangled ones included: at most
///                   now. For a full lattice at rest it is 0.71 of now, with dampers alone 0.49. It depends only
///                   on springs (broken ones count as whole), masses and pins. Areas and angle springs count in
///                   the shape that they were added in; with them it may be longer than now. May be NULL. Where dt
///                   differs from step to step and little damps, keep h below 0.7 of it (mspring_network_step()).
/// Threads: exclusive. Allocates: yes, and frees it, if now is asked for. Errors: ARGUMENT for a network NULL, MEMORY,
/// BUSY.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_stable_dt(
    mspring_network *network, double *now, double *any_shape);

/// Compute the smallest number of substeps that is stable.
/// In a step of dt each substep is then shorter than safety times the stable one of the present shape.
/// @param dt      seconds, finite, > 0
/// @param safety  > 0, at most 1. If the network keeps its shape, use 0.95. If it will be stretched or crushed,
///                use less. On a lattice without dampers 0.7 is enough for any shape. Equal dt and motion of less
///                than a third of a spring's length in a substep are assumed (mspring_network_step()).
/// @param substeps  receives the number
/// Threads: exclusive. Allocates: yes, and frees it. Errors: ARGUMENT; UNSTABLE if MSPRING_MAX_SUBSTEPS are too few;
/// MEMORY, BUSY.
MSPRING_API mspring_result MSPRING_CALL mspring_network_suggest_substeps(
    mspring_network *network, double dt, double safety, uint32_t *substeps);

/* ---------------------------------------------------------------------------------------------------------- find */

/// Which springs to find.
typedef enum mspring_find_flags {
    MSPRING_FIND_WHOLE = 1 << 0, ///< those that are not broken
    MSPRING_FIND_BROKEN = 1 << 1 ///< broken ones, as for repair
} mspring_find_flags;

/// Find the particle nearest to a point, as a mouse picks it. Takes a pass over all particles.
/// @param x  world position, m, at most MSPRING_MAX_COORDINATE in size
/// @param y  as x
/// @param within    largest distance, m, >= 0; INFINITY for any
/// @param particle  receives its id, the lowest of several, or MSPRING_NONE
/// @param distance  receives its distance, m, or INFINITY; may be NULL
/// Threads: shared. Allocates: never. Errors: ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_nearest_particle(
    const mspring_network *network, double x, double y, double within, mspring_id *particle, double *distance);

/// Find the spring nearest to a point.
/// The distance is to the nearest position on a spring, ends included. Takes a pass over all springs.
/// @param x  world position, m, at most MSPRING_MAX_COORDINATE in size
/// @param y  as x
/// @param within    largest distance, m, >= 0; INFINITY for any
/// @param flags     bits of mspring_find_flags, at least one
/// @param spring    receives its id, the lowest of several at one distance, or MSPRING_NONE
/// @param fraction  receives the nearest position on it, from 0 at end a to 1 at end b; 0 without one; may be NULL
/// @param distance  receives its distance, m, or INFINITY; may be NULL
/// Threads: shared. Allocates: never. Errors: ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_nearest_spring(const mspring_network *network, double x,
    double y, double within, uint32_t flags, mspring_id *spring, double *fraction, double *distance);

/// Find the particles in a circle, its edge included. Takes a pass over all particles.
/// @param x  world position and radius, m; radius >= 0
/// @param y  as x
/// @param radius  as x
/// @param particles     [capacity] receives as many ids as fit, in order; may be NULL if capacity is 0
/// @param count         receives how many there are, which may be more than fit
/// Threads: shared. Allocates: never. Errors: ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_particles_in_circle(const mspring_network *network, double x,
    double y, double radius, mspring_id *particles, uint32_t capacity, uint32_t *count);

/// Find the particles in a box, its edges included, as mspring_network_particles_in_circle().
/// @param min_x  world coordinates, m; no min above its max; may be infinite
/// @param min_y  as min_x
/// @param max_x  as min_x
/// @param max_y  as min_x
/// Threads: shared. Allocates: never. Errors: ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_particles_in_box(const mspring_network *network, double min_x,
    double min_y, double max_x, double max_y, mspring_id *particles, uint32_t capacity, uint32_t *count);

/// Find the springs that come within a radius of a point: to burn, cut or repair them.
/// A spring that the circle only touches counts. Takes a pass over all springs.
/// @param x  world position of the centre and radius, m; radius >= 0
/// @param y  as x
/// @param radius  as x
/// @param flags         bits of mspring_find_flags, at least one
/// @param springs       [capacity] receives as many ids as fit, in order; may be NULL if capacity is 0
/// @param count         receives how many there are, which may be more than fit
/// Threads: shared. Allocates: never. Errors: ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_springs_in_circle(const mspring_network *network, double x,
    double y, double radius, uint32_t flags, mspring_id *springs, uint32_t capacity, uint32_t *count);

/// Find the springs that a straight line meets, to cut them or to cast a ray.
/// Takes a pass over all springs. A spring that the line only touches counts.
/// @param from_x  the line's ends, world positions, m
/// @param from_y  as from_x
/// @param to_x  as from_x
/// @param to_y  as from_x
/// @param flags      bits of mspring_find_flags, at least one
/// @param springs    [capacity] receives as many ids as fit, in order; may be NULL if capacity is 0
/// @param fractions  [capacity] receives where each is met, from 0 at the line's start to 1 at its end; may be NULL
/// @param count      receives how many there are, which may be more than fit
/// Threads: shared. Allocates: never. Errors: ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_springs_across(const mspring_network *network, double from_x,
    double from_y, double to_x, double to_y, uint32_t flags, mspring_id *springs, double *fractions, uint32_t capacity,
    uint32_t *count);

/* --------------------------------------------------------------------------------------------------------- hooks */

/// When a hook is called. A hook with period n divides the substeps of each step into runs of n. The last run may be
/// shorter. The hook is called once for each run.
typedef enum mspring_phase {
    MSPRING_PHASE_BEFORE_STEP = 0,       ///< once; may change x, y, vx, vy; its forces act during the whole step
    MSPRING_PHASE_BEFORE_SUBSTEP = 1,    ///< adds forces for this run of substeps; must not change x, y, vx, vy
    MSPRING_PHASE_AFTER_SUBSTEP = 2,     ///< may change x, y, vx, vy, as for collisions; has no force arrays
    MSPRING_PHASE_INT = MSPRING_ENUM_INT ///< no value
} mspring_phase;

/// Arguments of a hook: arrays by slot. It handles first_slot ... first_slot + slot_count - 1. Slots without particle
/// have MSPRING_NONE in particle_of_slot. A hook may write there: values within the bounds of a step have no effect.
typedef struct mspring_hook_args {
    uint32_t struct_size;
    mspring_phase phase;
    uint32_t substep, substep_count; ///< first substep of the run, below substep_count; after a substep the last one
    uint32_t run_count;              ///< substeps in the run, 1 ... period; before the step 1
    uint32_t worker;                 ///< who calls, below worker_count; no two calls at a time have the same
    uint32_t first_slot, slot_count; ///< whole blocks, without the spare slots behind those in use
    double dt;                       ///< time of the run, or of the whole step, s
    double origin_x, origin_y;       ///< world position = origin + (x, y)
    float *x, *y, *vx, *vy;          ///< m, relative to the origin; m/s
    float *force_x, *force_y;        ///< N: add to them; NULL after a substep
    const float *inverse_mass;       ///< 1/kg; 0 if pinned or no particle
    const uint32_t *particle_of_slot, *slot_of_particle; ///< as in mspring_view
    const mspring_network *network;                      ///< for shared calls
    void *storage;                                       ///< of this worker, see mspring_hook_def; or NULL
    /// MSPRING_OK. If a hook sets it to an error, such as MSPRING_ERROR_REFUSED, the step is rolled back and returns
    /// it; no guard repeats it. Hooks may still be called before that.
    mspring_result *result;
} mspring_hook_args;

/// A hook. On the network it may make shared calls only. If a step is rolled back and repeated, as by a guard, hooks
/// are called again. A hook must return: no exception, no longjmp(). To refuse, it sets *args->result.
typedef void(MSPRING_CALL *mspring_hook_fn)(const mspring_hook_args *args, void *user);

/// Flags of hooks.
typedef enum mspring_hook_flags {
    /// The hook is called for ranges of slots, in any order, perhaps at the same time on different workers. It must
    /// read and write only the slots of its range, and data that no call writes. Then the state does not depend on
    /// the ranges.
    MSPRING_HOOK_CONCURRENT = 1 << 0,
    /// When the hook is due, it is called only for whole blocks that have a slot below below_y. There is one call for
    /// each run of such blocks. If no particle can get there in a step, the step skips the hook at no cost. The test
    /// assumes four times the speed before the step, or twice the speed after it. The hook misses only particles that
    /// springs throw there and back within one step. Beside hooks of substeps, particles without springs take each
    /// substep by itself.
    MSPRING_HOOK_BELOW = 1 << 1
} mspring_hook_flags;

/// A hook's definition.
typedef struct mspring_hook_def {
    uint32_t struct_size;
    mspring_phase phase;  ///< default MSPRING_PHASE_BEFORE_STEP
    mspring_hook_fn fn;   ///< must be set
    void *user;           ///< passed to fn, retain and release; default NULL
    /// Called once when the network needs user no more: the hook is removed, or the network destroyed. Default NULL.
    void(MSPRING_CALL *release)(void *user);
    /// Called when a clone takes the hook; returns the clone's user. If release is set and this is NULL, clones leave
    /// the hook out. Default NULL.
    void *(MSPRING_CALL *retain)(void *user);
    uint32_t period;      ///< substeps in a run, at least 1; must be 1 for MSPRING_PHASE_BEFORE_STEP; default 1. Its
                          ///< forces act unchanged in the whole run. Longer periods make a step faster.
    uint32_t flags;       ///< bits of mspring_hook_flags; default 0: one call for all slots, on the thread that steps
    uint32_t range_slots; ///< slots in a range of a concurrent hook, rounded up to whole blocks; default 0: one range
                          ///< for each worker
    uint32_t reserved;    ///< 0
    void *storage; ///< [worker_count of mspring_network_info][storage_stride] bytes of the host, such as a sum for each
                   ///< worker; default NULL
    size_t storage_stride; ///< bytes from one worker's to the next's, best a multiple of 64; default 0
    double below_y;        ///< height for MSPRING_HOOK_BELOW, m, world coordinates, at most 1e12 in size; default 0
} mspring_hook_def;
MSPRING_DEFAULT(mspring_hook_def, MSPRING_STRUCT_HOOK_DEF);

/// Add a hook to all steps from now on. It runs after the earlier hooks of its phase.
/// @param def   copied
/// @param hook  receives its id; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT, STRUCT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_hook(
    mspring_network *network, const mspring_hook_def *def, mspring_id *hook);

/// Remove a hook.
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_hook(
    mspring_network *network, mspring_id hook);

/* --------------------------------------------------------------------------------------------------------- store */

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

/// Compute the size (bytes) of a snapshot that is saved now. Ask before each save: it depends on forces, ramps and
/// edits.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, BUSY.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_snapshot_size(
    const mspring_network *network, mspring_snapshot_contents contents, size_t *size);

/// Save a snapshot, for rollback, replay and network play; for files use mspring_network_write().
/// It is the same on every machine, at any SIMD level, for any number of workers. It fits networks made of the same
/// particles and springs, with the same solver, integrator, flags and layout (mspring_network_compact()), by the same
/// minor version. Hooks, the floor and unread events are not in it.
/// @param snapshot  [capacity] bytes, of any alignment; capacity is at least mspring_network_get_snapshot_size()
/// @param size      receives the bytes written; may be NULL
/// Threads: shared. Allocates: never. Errors: ARGUMENT also for too little room; BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_save(
    const mspring_network *network, mspring_snapshot_contents contents, void *snapshot, size_t capacity, size_t *size);

/// Load a snapshot: the following steps repeat those after it was saved, bit for bit.
/// Unread events are dropped. Snapshots may come from anywhere: one that is damaged, cut off, of another network or
/// with impossible values is rejected.
/// Threads: exclusive. Allocates: what the network did not need so far. Errors: SNAPSHOT (the message says what is
/// wrong), ARGUMENT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_load(
    mspring_network *network, const void *snapshot, size_t size);

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
/// Threads: exclusive for the allocator, otherwise shared. Allocates: up to twice its largest chunk, about 16 bytes for
/// each particle and spring, and frees it. Errors: ARGUMENT, MEMORY, BUSY, what write returned.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_write(
    const mspring_network *network, mspring_write_fn write, void *user);

#ifdef __cplusplus
}
#endif

#endif
