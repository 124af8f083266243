/// @file massspring_tools.h
/// Functions that extend, tune and inspect networks.
///
///     build       material_preset, builder_add_rope, _add_mesh, _add_disc, _add_network; rope_def_init, mesh_def_init,
///                 disc_def_init
///     copy        network_clone; clone_def_init
///     hooks       network_add_hook, _remove_hook; hook_def_init
///     find        network_nearest_particle, _particles_in_circle, _particles_in_box, _nearest_spring,
///                 _springs_in_circle, _springs_across
///     write       network_view_mutable
///     inspect     network_get_spring, _get_extents, _get_sleepers, _renew_relative_springs, _get_plan,
///                 _memory_used, _worker_count, _simd_level; simd_supported, simd_available, simd_name
///     stability   network_stable_dt, _suggest_substeps
///     rest        network_settle; settle_def_init
///     tune        network_tune; tune_def_init, tune_scene_init, tune_settings, tune_row_solver
///     compact     network_compact, _expand; job_begin, _run, _finish, _error, _destroy
///
/// These calls are not frozen yet: a later minor version may change them. massspring.h explains the notation.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_TOOLS_H
#define MASSSPRING_MASSSPRING_TOOLS_H

#include "massspring.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------ shapes and materials */

/// Materials that mspring_material_preset() knows.
typedef enum mspring_preset {
    MSPRING_PRESET_STEEL = 0,             ///< heavy, as firm as substeps allow, hardly damped
    MSPRING_PRESET_WOOD = 1,              ///< light and firm
    MSPRING_PRESET_RUBBER = 2,            ///< bends and stretches far
    MSPRING_PRESET_JELLY = 3,             ///< sags under its own weight and wobbles
    MSPRING_PRESET_INT = MSPRING_ENUM_INT ///< no value
} mspring_preset;

/// Fill a material that looks like steel, wood, rubber or jelly.
/// Springs are relative, so a lattice of it is stable at any dt, in any shape. Mass is that of a plate of 1 m
/// thickness. Stiffness is the real one, if substeps are short enough for it. Otherwise a bar bends more than the
/// real one: use shorter substeps or a larger spacing. bench/STABILITY.md lists the presets' numbers.
/// @param material  filled whole, with struct_size
/// @param spacing   m, 1e-9 to 1e9, as in mspring_lattice_def
/// @param substep   s, 1e-12 to 1e6: dt / substeps
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_material_preset(
    mspring_material *material, size_t size, mspring_preset preset, double spacing, double substep);

/// A chain of equal springs along the straight line between two particles. Fill with mspring_rope_def_init() first.
typedef struct mspring_rope_def {
    uint32_t struct_size;
    uint32_t spring_flags;  ///< as flags of mspring_spring_def; default 0
    mspring_id from, to;    ///< its ends; default MSPRING_NONE
    uint32_t segment_count; ///< springs, at least 1; default 1. There is one inner particle fewer.
    float mass;             ///< kg of each inner particle, 1e-30 to 1e30; default 1
    float stiffness;        ///< of each spring, as in mspring_spring_def; default 0
    float damping;          ///< of each spring, as in mspring_spring_def; default 0
    float slack;            ///< rest length of the whole rope / distance of its ends, 0.001 to 1000; default 1
    float break_strain, stress_strain, relax_strain; ///< of each spring, as in mspring_spring_def
    float yield_strain, hardening, plastic_limit;    ///< likewise
} mspring_rope_def;

/// A mesh of triangles. Fill with mspring_mesh_def_init() first.
///
/// Each vertex becomes a particle with a third of the mass of each triangle at it. Each edge becomes one spring at
/// rest. All springs are equally stiff, or young_modulus gives each edge the stiffness (Van Gelder 1998)
///     k = young_modulus * (sum of the areas of its triangles) / length^2
/// A mesh of equilateral triangles then has that modulus, and Poisson's ratio 1/3. Other meshes come near it.
typedef struct mspring_mesh_def {
    uint32_t struct_size;
    uint32_t spring_flags;     ///< as flags of mspring_spring_def; default 0
    uint32_t vertex_count;     ///< at most MSPRING_MAX_PARTICLES; 0: the mesh adds nothing
    uint32_t triangle_count;   ///< at most MSPRING_MAX_SPRINGS
    const double *x, *y;       ///< [vertex_count] world positions, m
    const uint32_t *triangles; ///< [triangle_count][3] indices of vertices, clockwise or not
    float area_density;        ///< kg/m^2, 1e-30 to 1e30; default 1
    float stiffness;           ///< of each spring, as in mspring_spring_def; default 0
    float young_modulus;       ///< N/m: Young's modulus times thickness, 0 to 1e30; above 0 stiffness must be 0, and
                               ///< springs not relative; default 0: stiffness counts
    float damping;             ///< of each spring, as in mspring_spring_def; default 0
    float break_strain, stress_strain, relax_strain; ///< of each spring, as in mspring_spring_def
    float yield_strain, hardening, plastic_limit;    ///< likewise
} mspring_mesh_def;

/// A disc: a mesh of rings around a centre. Fill with mspring_disc_def_init() first.
///
/// Ring i has 6 i particles. Springs are 1 to 1.45 times as long as the distance of two rings.
typedef struct mspring_disc_def {
    uint32_t struct_size;
    uint32_t spring_flags; ///< as flags of mspring_spring_def; default 0
    uint32_t centre_flags; ///< of the particle in the centre: MSPRING_PARTICLE_PINNED or 0; default 0
    uint32_t ring_count;   ///< 1 to 4729; default 1; n rings are 1 + 3 n (n + 1) particles, n (9 n + 3) springs
    double x, y;           ///< world position of the centre, m; default 0
    double radius;         ///< m, 1e-9 to 1e12; default 1
    float area_density;    ///< this and what follows: as in mspring_mesh_def
    float stiffness, young_modulus, damping, break_strain, stress_strain, relax_strain;
    float yield_strain, hardening, plastic_limit;
} mspring_disc_def;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_rope_def_init(mspring_rope_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_mesh_def_init(mspring_mesh_def *def, size_t size);
MSPRING_API mspring_result MSPRING_CALL mspring_disc_def_init(mspring_disc_def *def, size_t size);

/// Add a rope: all of it or, on error, nothing.
/// Ids of particles and of springs follow the rope from its first end to its second.
/// @param particles     [capacity] receives the ids along the rope, both ends included, as many as fit; may be NULL if
///                      capacity is 0
/// @param capacity      segment_count + 1 for all of them
/// @param first_spring  receives the id of the first spring; may be NULL
/// @threads exclusive   @allocates yes   @errors as mspring_builder_add_spring()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_rope(mspring_builder *builder,
    const mspring_rope_def *def, mspring_id *particles, uint32_t capacity, mspring_id *first_spring);

/// Add a mesh of triangles: all of it or, on error, nothing.
/// Particle ids follow the vertices. Spring ids follow the triangles: each brings its edges 0-1, 1-2 and 2-0, unless
/// an earlier triangle has brought them.
/// @param first_particle, first_spring  receive the ids of vertex 0 and of the first spring; may be NULL
/// @threads exclusive   @allocates yes   @errors ARGUMENT also for a triangle without area, a vertex that does not
///          exist or is in no triangle; STRUCT, LIMIT, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_mesh(
    mspring_builder *builder, const mspring_mesh_def *def, mspring_id *first_particle, mspring_id *first_spring);

/// Add a disc: all of it or, on error, nothing.
/// Particle ids go from the centre outwards, each ring counter-clockwise from the right. The rim comes last.
/// @param first_particle, first_spring  receive the ids of the centre and of the first spring; may be NULL
/// @threads exclusive   @allocates yes   @errors as mspring_builder_add_mesh()
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_disc(
    mspring_builder *builder, const mspring_disc_def *def, mspring_id *first_particle, mspring_id *first_spring);

/// Add what a network holds now to a builder: to store it, to merge networks or to split one.
/// Adds particles with position, velocity, mass and pin. Adds the springs between them that are not broken, with
/// their present rest length, stiffness, damping, strains, plastic strain and one-way flags. Adds the areas and angles
/// of which all particles are added, unless they are open. A network that is made from the builder has them, numbered
/// anew from 0. Settings, solver, floor, contact, colliders, groups, actuators, grips, hooks, forces and events are not
/// added. An inverse mass scale becomes 1, or a pin if it is 0. Ids keep their order.
///
/// A network that is created from the builder starts where the other is, but for the rounding of positions: its local
/// origin may differ. If the other has not moved since it was created from the same parts, both have the same bits.
/// After explicit steps velocities are half a substep old, and so are all of the builder's then: those of particles
/// that you add yourself afterwards, too. If it had particles with others before, all count as of now.
/// @param particles     [count] the particles to add, in any order; NULL for all
/// @param count         0 if particles is NULL
/// @param particle_ids  [particle count of the network] receives the builder's id of each, MSPRING_NONE if it was not
///                      added; may be NULL
/// @param spring_ids    [spring count of the network] receives the same for springs; may be NULL
/// @threads exclusive for builder, shared for network   @allocates yes   @errors ID; ARGUMENT also for a particle
///          out of bounds (the builder's message names it); LIMIT, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_network(mspring_builder *builder,
    const mspring_network *network, const mspring_id *particles, uint32_t count, mspring_id *particle_ids,
    mspring_id *spring_ids);

/* -------------------------------------------------------------------------------------------------------- clones */

/// Flags of mspring_clone_def.
enum {
    /// The clone has the original's hooks, with their user pointers and storage. What these point to is shared.
    MSPRING_CLONE_HOOKS = 1u << 0
};

/// What a clone has of its own. Fill with mspring_clone_def_init() first.
typedef struct mspring_clone_def {
    uint32_t struct_size;
    uint32_t flags;                     ///< MSPRING_CLONE_HOOKS or 0; default 0: no hooks
    const mspring_allocator *allocator; ///< default NULL: as the original's, with the same user
    const mspring_tasks *tasks;         ///< as in mspring_network_def; default NULL
    uint32_t worker_count;              ///< as in mspring_network_def; default 1, whatever the original has
    uint32_t reserved;                  ///< 0
} mspring_clone_def;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_clone_def_init(mspring_clone_def *def, size_t size);

/// Make an independent copy of a network.
/// The same calls on both give the same bits: the copy has settings, edits, solver history and events. It has workers
/// of its own, and no job that is under way. To keep and restore a state often, mspring_network_save() is cheaper.
/// @param def    NULL for the defaults
/// @param clone  receives the copy; free it by mspring_network_destroy()
/// @threads shared   @allocates yes, with the clone's allocator   @errors ARGUMENT also for more workers than the
///          original has, if hooks have storage; STRUCT, MEMORY, BUSY; THREAD if a worker cannot start
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_clone(
    const mspring_network *network, const mspring_clone_def *def, mspring_network **clone);

/* --------------------------------------------------------------------------------------------------------- hooks */

/// When a hook is called. A hook with period n divides the substeps of each step into groups of n. The last group may
/// be smaller. The hook is called once for each group.
typedef enum mspring_phase {
    MSPRING_PHASE_BEFORE_STEP = 0,       ///< once; may change x, y, vx, vy; its forces act during the whole step
    MSPRING_PHASE_BEFORE_SUBSTEP = 1,    ///< adds forces for this group of substeps; must not change x, y, vx, vy
    MSPRING_PHASE_AFTER_SUBSTEP = 2,     ///< may change x, y, vx, vy, as for collisions; has no force arrays
    MSPRING_PHASE_INT = MSPRING_ENUM_INT ///< no value
} mspring_phase;

/// Arguments of a hook: arrays by slot. It handles first_slot ... first_slot + slot_count - 1. Slots without particle
/// have MSPRING_NONE in particle_of_slot. A hook may write there: values within the bounds of a step have no effect.
/// struct_size is that of the library: read a field of a later version only if the struct reaches that far.
typedef struct mspring_hook_args {
    uint32_t struct_size;
    mspring_phase phase;
    uint32_t substep, substep_count; ///< first substep of the group, below substep_count; after a substep the last one
    uint32_t first_slot, slot_count; ///< whole blocks, see mspring_plan, without the spare slots behind those in use
    double dt;                       ///< time of the group, or of the whole step, s
    double origin_x, origin_y;       ///< world position = origin + (x, y)
    float *x, *y, *vx, *vy;          ///< m, relative to the origin; m/s
    float *force_x, *force_y;        ///< N: add to them; NULL after a substep
    const float *inverse_mass;       ///< 1/kg; 0 if pinned or no particle
    const uint32_t *particle_of_slot, *slot_of_particle; ///< as in mspring_view
    const mspring_network *network;                      ///< for shared calls
    uint32_t group_count;                                ///< substeps in the group, 1 ... period; before the step 1
    uint32_t worker;      ///< who calls, below mspring_network_worker_count(); no two calls at a time have the same
    void *storage;        ///< of this worker, see mspring_hook_def; or NULL
    const void *reserved; ///< NULL
} mspring_hook_args;

/// A hook. On the network it may make shared calls only. If a step is rolled back and repeated, as by a guard, hooks
/// are called again. A hook must return. If one is left by longjmp() or by an exception, mspring_network_destroy() still
/// works, and exclusive calls return MSPRING_ERROR_BUSY for ever.
typedef void(MSPRING_CALL *mspring_hook_fn)(const mspring_hook_args *args, void *user);

/// Flags of hooks.
enum {
    /// The hook is called for ranges of slots, in any order, perhaps at the same time on different workers. It must
    /// read and write only the slots of its range, and data that no call writes. Then the state does not depend on
    /// the ranges.
    MSPRING_HOOK_CONCURRENT = 1u << 0,
    /// When the hook is due, it is called only for whole blocks that have a slot below below_y. There is one call for
    /// each run of such blocks. If no particle can get there in a step, the step skips the hook at no cost. The test
    /// assumes four times the speed before the step, or twice the speed after it. The hook misses only particles that
    /// springs throw there and back within one step. Beside hooks of substeps, particles without springs take each
    /// substep by itself.
    MSPRING_HOOK_BELOW = 1u << 1
};

/// A hook's definition. Fill with mspring_hook_def_init() first.
typedef struct mspring_hook_def {
    uint32_t struct_size;
    mspring_phase phase;  ///< default MSPRING_PHASE_BEFORE_STEP
    mspring_hook_fn fn;   ///< must be set
    void *user;           ///< passed to fn; default NULL
    uint32_t period;      ///< substeps in a group, at least 1; must be 1 for MSPRING_PHASE_BEFORE_STEP; default 1. Its
                          ///< forces act unchanged in the whole group. Longer periods make a step faster.
    uint32_t flags;       ///< bits of MSPRING_HOOK_; default 0: one call for all slots, on the thread that steps
    uint32_t range_slots; ///< slots in a range of a concurrent hook, rounded up to whole blocks; default 0: one range
                          ///< for each worker
    uint32_t reserved;    ///< 0
    void *storage; ///< [mspring_network_worker_count()][storage_stride] bytes of the host, such as a sum for each
                   ///< worker; default NULL
    size_t storage_stride; ///< bytes from one worker's to the next's, best a multiple of 64; default 0
    double below_y;        ///< height for MSPRING_HOOK_BELOW, m, world coordinates, at most 1e12 in size; default 0
} mspring_hook_def;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_hook_def_init(mspring_hook_def *def, size_t size);

/// Add a hook to all steps from now on. It runs after the earlier hooks of its phase.
/// @param def   copied
/// @param hook  receives its id; may be NULL
/// @threads exclusive   @allocates yes   @errors ARGUMENT, STRUCT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_hook(
    mspring_network *network, const mspring_hook_def *def, mspring_id *hook);

/// Remove a hook.
/// @threads exclusive   @allocates never   @errors ID, ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_hook(
    mspring_network *network, mspring_id hook);

/* ------------------------------------------------------------------------------------------------------- queries */

/// Find the particle nearest to a point, as a mouse picks it. Takes a pass over all particles.
/// @param x, y      world position, m, at most MSPRING_MAX_COORDINATE in size
/// @param within    largest distance, m, >= 0; INFINITY for any
/// @param particle  receives its id, the lowest of several, or MSPRING_NONE
/// @param distance  receives its distance, m, or INFINITY; may be NULL
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_nearest_particle(
    const mspring_network *network, double x, double y, double within, mspring_id *particle, double *distance);

/// Find the particles in a circle, its edge included. Takes a pass over all particles.
/// @param x, y, radius  world position and radius, m; radius >= 0
/// @param particles     [capacity] receives as many ids as fit, in order; may be NULL if capacity is 0
/// @param count         receives how many there are, which may be more than fit
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_particles_in_circle(
    const mspring_network *network, double x, double y, double radius, mspring_id *particles, uint32_t capacity,
    uint32_t *count);

/// Find the particles in a box, its edges included, as mspring_network_particles_in_circle().
/// @param min_x, min_y, max_x, max_y  world coordinates, m; no min above its max; may be infinite
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_particles_in_box(
    const mspring_network *network, double min_x, double min_y, double max_x, double max_y, mspring_id *particles,
    uint32_t capacity, uint32_t *count);

/// Kinds of springs to find. Removed springs are never found.
enum {
    MSPRING_FIND_WHOLE = 1u << 0, ///< springs that are not broken
    MSPRING_FIND_BROKEN = 1u << 1 ///< broken springs, for example to repair them
};

/// Find the spring nearest to a point.
/// The distance is to the nearest position on a spring, ends included. Takes a pass over all springs.
/// @param x, y      world position, m, at most MSPRING_MAX_COORDINATE in size
/// @param within    largest distance, m, >= 0; INFINITY for any
/// @param flags     bits of MSPRING_FIND_, at least one
/// @param spring    receives its id, the lowest of several at one distance, or MSPRING_NONE
/// @param fraction  receives the nearest position on it, from 0 at end a to 1 at end b; 0 without one; may be NULL
/// @param distance  receives its distance, m, or INFINITY; may be NULL
/// @threads shared   @allocates never   @since 0.2   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_nearest_spring(const mspring_network *network,
    double x, double y, double within, uint32_t flags, mspring_id *spring, double *fraction, double *distance);

/// Find the springs that come within a radius of a point: to burn, cut or repair them.
/// A spring that the circle only touches counts. Takes a pass over all springs.
/// @param x, y, radius  world position of the centre and radius, m; radius >= 0
/// @param flags         bits of MSPRING_FIND_, at least one
/// @param springs       [capacity] receives as many ids as fit, in order; may be NULL if capacity is 0
/// @param count         receives how many there are, which may be more than fit
/// @threads shared   @allocates never   @since 0.2   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_springs_in_circle(
    const mspring_network *network, double x, double y, double radius, uint32_t flags, mspring_id *springs,
    uint32_t capacity, uint32_t *count);

/// Find the springs that a straight line meets, to cut them or to cast a ray.
/// Takes a pass over all springs. A spring that the line only touches counts.
/// @param from_x, from_y, to_x, to_y  the line's ends, world positions, m
/// @param flags      bits of MSPRING_FIND_, at least one
/// @param springs    [capacity] receives as many ids as fit, in order; may be NULL if capacity is 0
/// @param fractions  [capacity] receives where each is met, from 0 at the line's start to 1 at its end; may be NULL
/// @param count      receives how many there are, which may be more than fit
/// @threads shared   @allocates never   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_springs_across(const mspring_network *network,
    double from_x, double from_y, double to_x, double to_y, uint32_t flags, mspring_id *springs, double *fractions,
    uint32_t capacity, uint32_t *count);

/* ------------------------------------------------------------------------------------------------ a view to write */

/// A view (mspring_view) to write: positions and velocities may be changed until the next step. Set struct_size first.
typedef struct mspring_mutable_view {
    uint32_t struct_size;
    uint32_t slot_count, particle_count, reserved; ///< all fields as in mspring_view
    uint64_t layout_generation, origin_generation;
    double origin_x, origin_y;
    float *x, *y, *vx, *vy; ///< write finite values only, and velocities within MSPRING_MAX_SPEED
    const float *inverse_mass;
    const uint32_t *particle_of_slot, *slot_of_particle;
    const void *reserved_pointer;
} mspring_mutable_view;

/// Fill a view to write. The next step checks what was written.
/// Call it again before you write after that step. In a hook use its arrays.
/// @threads exclusive   @allocates never   @errors ARGUMENT, STRUCT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_view_mutable(
    mspring_network *network, mspring_mutable_view *view);

/* ------------------------------------------------------------------------------------------ springs and sleepers */

/// Report of one spring. Set struct_size first.
typedef struct mspring_spring_info {
    uint32_t struct_size;
    uint32_t flags;          ///< MSPRING_SPRING_RELATIVE, MSPRING_SPRING_BROKEN, MSPRING_SPRING_STRESSED
    mspring_id a, b;         ///< its particles, as they were given
    float stiffness;         ///< N/m in force; of a relative spring that of the last step; 0 if broken
    float damping;           ///< N s/m, the same
    float rest_length;       ///< m
    float length;            ///< m, now
    float strain;            ///< as MSPRING_STRAIN
    float force;             ///< as MSPRING_FORCE
    float nominal_stiffness; ///< as MSPRING_STIFFNESS
    float nominal_damping;   ///< as MSPRING_DAMPING
} mspring_spring_info;

/// Read the report of one spring.
/// @threads shared   @allocates never   @errors ID, ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_spring(
    const mspring_network *network, mspring_id spring, mspring_spring_info *info);

/// Read length, direction and strain of all springs, in one pass.
/// Each array is filled if it is not NULL. Removed springs have 0.
/// @param length       [spring count], m
/// @param direction_x, direction_y  [spring count] unit vector from end a to end b; (0, 0) for length 0; both or none
/// @param strain       [spring count], as MSPRING_STRAIN; the last bit may differ
/// @threads exclusive   @allocates the first time   @errors ARGUMENT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_extents(
    mspring_network *network, float *length, float *direction_x, float *direction_y, float *strain);

/// Compute relative springs from the present masses. Takes a pass over all springs.
/// @threads exclusive   @allocates never   @errors ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_renew_relative_springs(
    mspring_network *network);

/// Read which of the particles first ... first + count - 1 sleep.
/// Particles that were set or written since still count as asleep until the next step.
/// @param asleep  receives 1 or 0 for particle first + i in asleep[i * stride]
/// @param stride  elements from one to the next, at least 1
/// @threads shared   @allocates never   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_sleepers(
    const mspring_network *network, mspring_id first, uint32_t count, uint8_t *asleep, uint32_t stride);

/* ---------------------------------------------------------------------------------- workers and instruction sets */

/// Return the number of workers: 1 in a build without threads. NULL gives 0.
/// A small network leaves some of them idle: see mspring_plan, pass_workers.
/// @threads shared   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_network_worker_count(const mspring_network *network);

/// Return the instruction set that the network's steps use. NULL gives MSPRING_SIMD_AUTO.
/// @threads shared   @allocates never
MSPRING_API mspring_simd MSPRING_CALL mspring_network_simd_level(const mspring_network *network);

/// Return the best instruction set that CPU, operating system and build offer.
/// @threads any   @allocates never
MSPRING_API mspring_simd MSPRING_CALL mspring_simd_supported(void);

/// Return 1 if a network can run at this level here, else 0. MSPRING_SIMD_AUTO gives 1.
/// On x86-64, 64-bit ARM and WebAssembly, builds have MSPRING_SIMD_SCALAR only if they are made with it.
/// @threads any   @allocates never
MSPRING_API uint32_t MSPRING_CALL mspring_simd_available(mspring_simd level);

/// Return the name of a level: "scalar", "sse2", "avx2", "avx512", "neon", "wasm", "auto" or "unknown".
/// @threads any   @allocates never
MSPRING_API const char *MSPRING_CALL mspring_simd_name(mspring_simd level);

/* ----------------------------------------------------------------------------------------------------- stability */

/// Compute the longest stable explicit substep (s) of this network.
/// If a substep is longer, the fastest oscillation reverses and grows in each substep.
///
/// Let lambda be the largest eigenvalue (Lanczos 1950) of
///     h^2 M^-1 K + 2 h M^-1 C.
/// Here h is a substep, M the masses, K the stiffness of a shape, C the dampers. Pinned particles are left out. Small
/// motion about the shape is stable exactly if lambda <= 2 x / tanh(x / 2) with x = global_damping h, or 4 if that is 0.
/// For one mode of angular frequency omega and damping ratio zeta this is omega h <= 2 (sqrt(1 + zeta^2) - zeta).
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
/// @threads exclusive   @allocates yes, and frees it, if now is asked for   @since 0.2   @errors ARGUMENT for a
///          network NULL, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_stable_dt(
    mspring_network *network, double *now, double *any_shape);

/// Compute the smallest number of substeps that is stable.
/// In a step of dt each substep is then shorter than safety times the stable one of the present shape.
/// @param dt      seconds, finite, > 0
/// @param safety  > 0, at most 1. If the network keeps its shape, use 0.95. If it will be stretched or crushed,
///                use less. On a lattice without dampers 0.7 is enough for any shape. Equal dt and motion of less
///                than a third of a spring's length in a substep are assumed (mspring_network_step()).
/// @param substeps  receives the number
/// @threads exclusive   @allocates yes, and frees it   @since 0.2   @errors ARGUMENT; UNSTABLE if
///          MSPRING_MAX_SUBSTEPS are too few; MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_suggest_substeps(
    mspring_network *network, double dt, double safety, uint32_t *substeps);

/* -------------------------------------------------------------------------------------------- static equilibrium */

/// Flags of mspring_settle_def.
enum {
    MSPRING_SETTLE_LEAVE_FLOATING = 1u << 0 ///< leave components without an equilibrium alone, instead of failing
};

/// How mspring_network_settle() searches. Fill with mspring_settle_def_init() first.
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

/// Result of mspring_network_settle(). Set struct_size first.
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

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @since 0.2   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_settle_def_init(mspring_settle_def *def, size_t size);

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
/// @threads exclusive   @allocates yes, and frees it   @since 0.2   @errors EQUILIBRIUM if there is none, it is out
///          of bounds, or max_iterations do not lead to it (the message names a particle, and the force on it);
///          LIMIT if the factor would have over 2^31 numbers; ARGUMENT, STRUCT, MEMORY, BUSY. On error nothing has
///          moved
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
enum {
    MSPRING_TUNE_NOTHING_ELSE = 1u << 0 ///< measure the costs and the error that measure names, no other
};

/// Receives the progress of a long run, 0 to 1, between steps.
/// It returns 1 to go on, 0 to stop. After a stop the result has the numbers measured so far.
typedef uint32_t(MSPRING_CALL *mspring_progress_fn)(double done, void *user);

/// Returns seconds since a fixed moment. They never decrease.
typedef double(MSPRING_CALL *mspring_clock_fn)(void *user);

/// Flags of mspring_tune_scene.
enum {
    MSPRING_TUNE_SCENE_FLOOR = 1u << 0,    ///< the network's floor acts
    MSPRING_TUNE_SCENE_BREAKING = 1u << 1, ///< springs break at their break strains
    MSPRING_TUNE_SCENE_HOOKS = 1u << 2     ///< its hooks are called, with their user pointers and storage
};

/// Prepares one run of a scene, before its first step.
/// It may change the run as the host changes the network: add hooks, give forces or velocities, break springs, reset
/// the data of hooks. It must not step or destroy the run, or touch the network that is tuned.
/// @param run    a clone of the network, destroyed after the run
/// @param start  0 ... start_count - 1. For the same start, prepare all settings and the fine run in the same way.
/// @param user   mspring_tune_def.user
/// @return MSPRING_OK; mspring_network_tune() fails with any other result
typedef mspring_result(MSPRING_CALL *mspring_tune_prepare_fn)(mspring_network *run, uint32_t start, void *user);

/// Scene in which settings are tried: floor, breaking, hooks. Fill with mspring_tune_scene_init() first.
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

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @since 0.2   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_tune_scene_init(mspring_tune_scene *scene, size_t size);

/// Settings to try. A row above a limit is not recommended. Fill with mspring_tune_def_init() first.
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
    const mspring_solver_def *settings; ///< [setting_count]; default NULL: those of mspring_tune_settings()
    mspring_clock_fn clock;             ///< default NULL: the system's; must be set without MSPRING_FEATURE_HOSTED
    mspring_progress_fn progress;       ///< default NULL
    void *user;                         ///< passed to clock, to progress and to the scene's prepare; default NULL
    const mspring_tune_scene *scene;    ///< default NULL: none
    void *reserved_pointer;             ///< NULL
} mspring_tune_def;

/// Flags of mspring_tune_row.
enum {
    MSPRING_TUNE_HAS_COST = 1u << 0,       ///< costs are measured
    MSPRING_TUNE_HAS_TRAJECTORY = 1u << 1, ///< trajectory_error, trajectory_share and energy_drift are measured
    MSPRING_TUNE_HAS_REST = 1u << 2,       ///< bending, rest_error and rest_share are measured
    MSPRING_TUNE_REJECTED = 1u << 3,       ///< a step was rejected as unstable, or the solver rejects the network
    MSPRING_TUNE_PARETO = 1u << 4,         ///< no other row has both less cost and less error
    MSPRING_TUNE_RECOMMENDED = 1u << 5,    ///< the recommended row
    MSPRING_TUNE_HAS_SCENE = 1u << 6,      ///< the numbers of the scene are measured, from at least four starts
    MSPRING_TUNE_CHAOTIC = 1u << 7         ///< trajectory_spread is above max_error: measure by scene instead
};

/// Quantities at the end of each run of a scene.
enum {
    MSPRING_TUNE_BROKEN = 0, ///< springs that broke in the run, minus those that were restored
    MSPRING_TUNE_ENERGY = 1, ///< kinetic and elastic energy, J
    MSPRING_TUNE_EXTENT = 2  ///< larger side of the box around all particles, m
};
#define MSPRING_TUNE_QUANTITIES 3

/// A setting and its results. Set struct_size first. Numbers that are not measured are 0.
typedef struct mspring_tune_row {
    uint32_t struct_size;
    uint32_t flags;        ///< bits of MSPRING_TUNE_HAS_COST and so on
    uint32_t setting;      ///< index in the list of settings
    mspring_solver solver; ///< this and the next five: as in mspring_solver_def, see mspring_tune_row_solver()
    mspring_integrator integrator;
    uint32_t substeps; ///< of a step, as it was taken
    uint32_t iterations, tile_size, coarse_period;
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
    float residual; ///< as in mspring_solver_def
    /// trajectory_share of a second fine run; 0 also if the budget ended before it. Its start differs by a rounding in
    /// single precision: each coordinate by 2^-24 times the network's size. Smaller differences between rows mean
    /// nothing.
    float trajectory_spread;
} mspring_tune_row;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @since 0.2   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_tune_def_init(mspring_tune_def *def, size_t size);

/// List the default settings of mspring_network_tune().
///
///   explicit  some numbers of substeps from the smallest stable one on, none above 1000
///   implicit  BDF2 and GA0 with residuals of 0.1, 0.03 and 0.01, each in one and two substeps
///   direct    BDF2 and GA0, each in one and two substeps; up to 20000 particles
///
/// Solvers that this build lacks are left out.
/// @param dt        seconds, finite, > 0
/// @param settings  [capacity], struct_size set in each; may be NULL with capacity 0, to ask for the count
/// @param count     receives the number of settings, even if it is larger than capacity
/// @threads exclusive   @allocates yes, and frees it   @since 0.2   @errors ARGUMENT, also for too little capacity
///          unless that is 0; STRUCT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_tune_settings(
    mspring_network *network, double dt, mspring_solver_def *settings, uint32_t capacity, uint32_t *count);

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
/// @param rows      [capacity], struct_size set in each; receives one for each setting, in their order
/// @param capacity  at least the number of settings
/// @param count     receives the number of rows
/// @threads exclusive; prepare is called on the calling thread   @allocates yes, and frees it @since 0.2   @errors
///          ARGUMENT (the message names the fault or the setting), STRUCT, MEMORY, BUSY; the result of the scene's
///          prepare. On error nothing is written, and the network is as it was
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_tune(
    mspring_network *network, const mspring_tune_def *def, mspring_tune_row *rows, uint32_t capacity, uint32_t *count);

/// Get the setting of a row, for mspring_network_set_solver().
/// Its substeps are those that the row's steps took.
/// @param solver  set its struct_size first
/// @threads any   @allocates never   @since 0.2   @errors ARGUMENT for NULL, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_tune_row_solver(
    const mspring_tune_row *row, mspring_solver_def *solver);

/* ----------------------------------------------------------------------------------------------- plan and memory */

/// The plan: how a network is laid out in memory. Set struct_size first. Each particle belongs to one kind of row:
///
///   lattice    particles of a grid with 8 neighbours; it may lie at any angle, be oblong, slanted or bent
///   chain      particles of a rope or another single strand
///   irregular  any other graph, and ropes that hang on a lattice
///   loose      particles without springs
///
/// Springs between neighbours in lattice or chain rows need no index. The others are irregular springs and cost more.
/// src/README.md explains how a network is laid out.
typedef struct mspring_plan {
    uint32_t struct_size;
    uint32_t particle_count, spring_count;
    uint32_t lattice_count; ///< grids
    uint32_t lattice_particles, lattice_springs;
    uint32_t lattice_rows;   ///< rows of the grids
    uint32_t lattice_blocks; ///< blocks of block_width columns in those rows
    uint32_t chain_count;    ///< strands
    uint32_t chain_particles, chain_springs;
    uint32_t irregular_particles; ///< particles of the irregular part: with springs, but in no lattice or chain row
    uint32_t loose_particles;     ///< particles without a spring
    uint32_t irregular_springs;   ///< springs of the irregular part
    uint32_t pass_rows;           ///< lattice rows that are swept for several substeps in one pass
    uint32_t pass_lag;            ///< strips between a substep of a pass and the next; over 1 if ropes need it
    uint32_t pass_substeps;       ///< most substeps in one pass, by cache size, row length and lag
    uint32_t slot_count;          ///< slots of the state, with empty ones
    uint32_t block_width;         ///< slots in a block
    uint32_t has_damping;         ///< 1: a spring has damping, or room for it is reserved; 0: steps have none
    uint32_t has_relative;        ///< 1: a spring is relative, and a change of substep costs a pass over all springs
    mspring_simd simd_level;      ///< the instruction set that runs
    mspring_solver solver;
    mspring_integrator integrator; ///< of the implicit or direct solver; 0 for the explicit one
    uint32_t iterations;           ///< this and the next four: of the implicit solver; 0 for others
    uint32_t tile_size;            ///< rows and columns of the cells of wide lattices
    uint32_t tile_count;           ///< tiles, each of three unknowns in the coarse matrix
    uint32_t coarse_values;        ///< numbers in the factor of that matrix
    uint32_t coarse_period;
    uint32_t irregular_layers; ///< with any solver: layers of the irregular part for passes over it; 0: none
    uint64_t factor_values;    ///< of the direct solver: numbers in its factor, which exists in both precisions
    double factor_products;    ///< products that computing that factor takes
    uint32_t pass_workers;     ///< workers that share passes over lattice rows in explicit steps; 1: no sharing
    float residual;            ///< of the implicit solver, see mspring_solver_def; 0 for others
} mspring_plan;

/// Get the plan. Set struct_size first.
/// @threads shared   @allocates never   @since 0.2   @errors ARGUMENT or STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_plan(
    const mspring_network *network, mspring_plan *plan);

/// Get the bytes that the network has allocated. NULL gives 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API size_t MSPRING_CALL mspring_network_memory_used(const mspring_network *network);

/* ---------------------------------------------------------------------------------------------------- compaction */

/// Leave broken springs out of the plan, and take added ones in.
/// A step then costs only the springs that are left. Compaction is worth its time if a quarter of the springs has
/// broken, or if added springs are to stay. Ids and values stay. Slots change: fill views again. Forces are summed in
/// another order from then on, so the next steps differ by rounding. They are the same on every machine. Earlier
/// snapshots no longer fit. To spread the work over frames, or to another thread, use a job. The guide
/// examples/guides/edits.md has the details.
/// @threads exclusive   @allocates yes, and frees most   @errors ARGUMENT, MEMORY, LIMIT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_compact(mspring_network *network);

/// Take all springs into the plan again: the way back from mspring_network_compact().
/// Slots change. A job that is under way is outdated then. mspring_network_restore_springs() does it by itself, if
/// the plan leaves a spring out.
/// @threads exclusive   @allocates yes, and frees most   @errors ARGUMENT, MEMORY, LIMIT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_expand(mspring_network *network);

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
    MSPRING_LAYOUT_WHOLE = 1,             ///< as mspring_network_expand(); restoring springs then needs no long frame
    MSPRING_LAYOUT_INT = MSPRING_ENUM_INT ///< no value
} mspring_layout;

/// Begin a job: copy springs and their layout.
/// @threads exclusive   @allocates yes   @since 0.2   @errors BUSY inside a hook, or if the network has a job that
///          is neither finished nor destroyed; ARGUMENT, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_job_begin(
    mspring_network *network, mspring_layout layout, mspring_job **job);

/// Run the next parts of a job.
/// Some parts make the solver. For a network of 200,000 springs the longest part takes one to two milliseconds.
/// @param at_most  number of parts to run; 0 for all
/// @param left     receives an estimate of the parts left, which never rises; 0: it can be finished; may be NULL
/// @threads exclusive access to job; no access to any network   @allocates yes   @since 0.2   @errors MEMORY or
///          LIMIT, after which the job can only be destroyed; ARGUMENT for NULL, or for a job that has failed or is
///          finished
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_job_run(
    mspring_job *job, uint32_t at_most, uint32_t *left);

/// Move the network to the plan of a job.
/// Slots change: fill views again. Afterwards the job can only be destroyed, unless the result is MSPRING_ERROR_BUSY
/// or MSPRING_ERROR_ARGUMENT. The job keeps the memory of the old plan until it is destroyed.
/// @threads exclusive and job   @allocates some   @since 0.2   @errors OUTDATED if since begin particles or springs
///          were added or removed, a spring was restored that the plan leaves out, or the plan has changed
///          otherwise: begin another job; BUSY inside a hook, or if the job has not been run to its end; MEMORY;
///          LIMIT; ARGUMENT for NULL, for a job that is finished, or for one of another network. If a run failed,
///          its error is returned again. On error the network is as it was
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_job_finish(
    mspring_network *network, mspring_job *job);

/// Get the error message of a job.
/// It is that of the first mspring_job_run() that failed; "" if none did, or for NULL. The job owns it.
/// @threads shared with other reads of the job   @allocates never   @since 0.2
MSPRING_API const char *MSPRING_CALL mspring_job_error(const mspring_job *job);

/// Free a job, finished or not. NULL is allowed.
/// If it is finished, this frees the old plan, which may take milliseconds: another thread may do that.
/// @threads exclusive access to job and, unless it is finished, to its network   @allocates never   @since 0.2
MSPRING_API void MSPRING_CALL mspring_job_destroy(mspring_job *job);

#ifdef __cplusplus
}
#endif

#endif
