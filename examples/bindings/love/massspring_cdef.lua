-- Of the headers of libmassspring 0.2.0, by examples/bindings/generate: do not edit.
-- SPDX-License-Identifier: MIT
require("ffi").cdef [[
uint32_t mspring_version(void);
const char *mspring_version_string(void);
enum { MSPRING_FEATURE_THREADS = 1u << 0, MSPRING_FEATURE_HOSTED = 1u << 1, MSPRING_FEATURE_SHARED = 1u << 2, MSPRING_FEATURE_IMPLICIT = 1u << 3, MSPRING_FEATURE_DIRECT = 1u << 4, MSPRING_FEATURE_FLOOR = 1u << 5, MSPRING_FEATURE_CONTACT = 1u << 6, MSPRING_FEATURE_LAWS = 1u << 7, MSPRING_FEATURE_BATCH = 1u << 8, MSPRING_FEATURE_LAB = 1u << 9
};
uint32_t mspring_features(void);
typedef enum mspring_result { MSPRING_OK = 0, MSPRING_ERROR_ARGUMENT = -1, MSPRING_ERROR_ID = -2, MSPRING_ERROR_MEMORY = -3, MSPRING_ERROR_LIMIT = -4, MSPRING_ERROR_STRUCT = -5, MSPRING_ERROR_DUPLICATE = -6, MSPRING_ERROR_UNSTABLE = -7, MSPRING_ERROR_BUSY = -8, MSPRING_ERROR_THREAD = -9, MSPRING_ERROR_EQUILIBRIUM = -10, MSPRING_ERROR_SNAPSHOT = -11, MSPRING_ERROR_OUTDATED = -12, MSPRING_RESULT_INT = -2147483648
} mspring_result;
const char *mspring_result_string(mspring_result result);
typedef uint32_t mspring_id;
typedef struct mspring_allocator {
uint32_t struct_size;
uint32_t reserved;
void *(*alloc)(size_t size, size_t alignment, void *user);
void(*free)(void *memory, size_t size, void *user);
void *user;
} mspring_allocator;
typedef void(*mspring_task_fn)(void *argument, uint32_t index, uint32_t worker);
typedef struct mspring_tasks {
uint32_t struct_size;
uint32_t worker_count;
uint32_t concurrent_count;
uint32_t reserved;
void(*run)(uint32_t count, mspring_task_fn fn, void *argument, void *user);
void *user;
} mspring_tasks;
enum { MSPRING_PARTICLE_PINNED = 1u << 0
};
enum { MSPRING_SPRING_RELATIVE = 1u << 0, MSPRING_SPRING_DAMPING_RATIO = 1u << 1, MSPRING_SPRING_BROKEN = 1u << 8, MSPRING_SPRING_STRESSED = 1u << 9, MSPRING_SPRING_REMOVED = 1u << 10
};
typedef struct mspring_particle_def {
uint32_t struct_size;
uint32_t flags;
double x, y;
float vx, vy;
float mass;
uint32_t reserved;
} mspring_particle_def;
typedef struct mspring_spring_def {
uint32_t struct_size;
uint32_t flags;
mspring_id a, b;
float stiffness;
float damping;
float rest_length;
float break_strain;
float stress_strain;
float relax_strain;
float yield_strain, hardening, plastic_limit;
} mspring_spring_def;
typedef struct mspring_material {
uint32_t struct_size;
uint32_t particle_flags;
uint32_t spring_flags;
float mass;
float stiffness;
float damping, break_strain, stress_strain, relax_strain, yield_strain, hardening, plastic_limit;
} mspring_material;
typedef struct mspring_lattice_def {
uint32_t struct_size;
uint32_t width, height;
uint32_t material_count;
double x, y;
double spacing;
const uint16_t *cells;
const mspring_material *materials;
float shear_share;
float bend_share;
} mspring_lattice_def;
typedef enum mspring_solver { MSPRING_SOLVER_EXPLICIT = 0, MSPRING_SOLVER_IMPLICIT = 1, MSPRING_SOLVER_DIRECT = 2, MSPRING_SOLVER_INT = -2147483648
} mspring_solver;
typedef enum mspring_integrator { MSPRING_INTEGRATOR_GA0 = 0, MSPRING_INTEGRATOR_BDF2 = 1, MSPRING_INTEGRATOR_EULER = 2, MSPRING_INTEGRATOR_INT = -2147483648
} mspring_integrator;
typedef struct mspring_solver_def {
uint32_t struct_size;
mspring_solver solver;
uint32_t substeps;
uint32_t max_substeps;
mspring_integrator integrator;
uint32_t iterations;
uint32_t tile_size;
uint32_t coarse_period;
uint32_t most_work;
float residual;
double substep_length;
} mspring_solver_def;
typedef enum mspring_simd { MSPRING_SIMD_AUTO = 0, MSPRING_SIMD_SCALAR = 1, MSPRING_SIMD_SSE2 = 2, MSPRING_SIMD_AVX2 = 3, MSPRING_SIMD_AVX512 = 4, MSPRING_SIMD_NEON = 5, MSPRING_SIMD_WASM = 6, MSPRING_SIMD_INT = -2147483648
} mspring_simd;
enum { MSPRING_NETWORK_RESERVE_DAMPING = 1u << 0, MSPRING_NETWORK_RESERVE_RELATIVE = 1u << 1, MSPRING_NETWORK_PRECISE = 1u << 2, MSPRING_NETWORK_POSES = 1u << 3
};
typedef enum mspring_guard { MSPRING_GUARD_GROWTH = 0, MSPRING_GUARD_RETRY = 1, MSPRING_GUARD_BOUNDS = 2, MSPRING_GUARD_IMPLICIT = 3, MSPRING_GUARD_CLAMP = 4, MSPRING_GUARD_CLAMP_BOUNDS = 5, MSPRING_GUARD_INT = -2147483648
} mspring_guard;
typedef struct mspring_settings {
uint32_t struct_size;
mspring_guard guard;
float gravity_x;
float gravity_y;
float global_damping;
float max_speed;
float sleep_speed;
float sleep_time;
float relax_fraction;
} mspring_settings;
typedef struct mspring_network_def {
uint32_t struct_size;
mspring_simd simd_level;
mspring_guard guard;
float gravity_x, gravity_y, global_damping, max_speed, sleep_speed, sleep_time, relax_fraction;
mspring_solver solver;
uint32_t substeps, max_substeps;
mspring_integrator integrator;
uint32_t iterations, tile_size, coarse_period;
uint32_t flags;
const mspring_allocator *allocator;
const mspring_tasks *tasks;
uint32_t worker_count;
uint32_t spare_particles;
uint32_t spare_springs;
uint32_t reserved;
} mspring_network_def;
typedef struct mspring_floor_def {
uint32_t struct_size;
uint32_t plane_count;
double heights_x, heights_y;
double spacing;
const double *planes;
const float *heights;
uint32_t height_count;
float friction;
float restitution;
uint32_t reserved;
const float *plane_frictions, *plane_restitutions;
const float *height_frictions, *height_restitutions;
float silt_depth;
float silt_rate;
} mspring_floor_def;
mspring_result mspring_particle_def_init(mspring_particle_def *def, size_t size);
mspring_result mspring_spring_def_init(mspring_spring_def *def, size_t size);
mspring_result mspring_material_init(mspring_material *material, size_t size);
mspring_result mspring_lattice_def_init(mspring_lattice_def *def, size_t size);
mspring_result mspring_solver_def_init(mspring_solver_def *def, size_t size);
mspring_result mspring_network_def_init(mspring_network_def *def, size_t size);
mspring_result mspring_floor_def_init(mspring_floor_def *def, size_t size);
mspring_result mspring_settings_init(mspring_settings *settings, size_t size);
mspring_result mspring_allocator_init(mspring_allocator *allocator, size_t size);
mspring_result mspring_tasks_init(mspring_tasks *tasks, size_t size);
typedef struct mspring_builder mspring_builder;
mspring_result mspring_builder_create(
const mspring_allocator *allocator, mspring_builder **builder);
void mspring_builder_destroy(mspring_builder *builder);
const char *mspring_builder_error(const mspring_builder *builder);
uint32_t mspring_builder_particle_count(const mspring_builder *builder);
uint32_t mspring_builder_spring_count(const mspring_builder *builder);
mspring_result mspring_builder_add_particle(
mspring_builder *builder, const mspring_particle_def *def, mspring_id *id);
mspring_result mspring_builder_add_particles(
mspring_builder *builder, const mspring_particle_def *defs, uint32_t count, mspring_id *first_id);
mspring_result mspring_builder_add_spring(
mspring_builder *builder, const mspring_spring_def *def, mspring_id *id);
mspring_result mspring_builder_add_springs(
mspring_builder *builder, const mspring_spring_def *defs, uint32_t count, mspring_id *first_id);
mspring_result mspring_builder_add_lattice(
mspring_builder *builder, const mspring_lattice_def *def, mspring_id *cell_ids);
mspring_result mspring_builder_get_particles(
mspring_builder *builder, const mspring_id *ids, mspring_id first, uint32_t count, mspring_particle_def *defs);
mspring_result mspring_builder_get_springs(
mspring_builder *builder, const mspring_id *ids, mspring_id first, uint32_t count, mspring_spring_def *defs);
mspring_result mspring_builder_read(
mspring_builder *builder, const void *archive, size_t size, uint32_t *skipped);
typedef struct mspring_network mspring_network;
mspring_result mspring_network_create(
mspring_builder *builder, const mspring_network_def *def, mspring_network **network);
mspring_result mspring_builder_get_network_def(
mspring_builder *builder, mspring_network_def *def);
void mspring_network_destroy(mspring_network *network);
const char *mspring_network_error(const mspring_network *network);
uint32_t mspring_network_particle_count(const mspring_network *network);
uint32_t mspring_network_spring_count(const mspring_network *network);
mspring_result mspring_network_set_solver(
mspring_network *network, const mspring_solver_def *def);
mspring_result mspring_network_get_solver(
const mspring_network *network, mspring_solver_def *def);
mspring_result mspring_network_get_settings(
const mspring_network *network, mspring_settings *settings);
mspring_result mspring_network_set_settings(
mspring_network *network, const mspring_settings *settings);
mspring_result mspring_network_step(mspring_network *network, double dt);
enum { MSPRING_STEP_FALLBACK = 1u << 0, MSPRING_STEP_CLAMPED = 1u << 1, MSPRING_STEP_PUT_BACK = 1u << 2, MSPRING_STEP_RETRIED = 1u << 3, MSPRING_STEP_ASLEEP = 1u << 4, MSPRING_STEP_FEWER = 1u << 5, MSPRING_STEP_GREW = 1u << 6
};
typedef struct mspring_step_info {
uint32_t struct_size;
mspring_result result;
mspring_id particle;
mspring_id spring;
uint32_t flags;
uint32_t substeps;
uint64_t step_count;
uint64_t fallback_count;
double time;
double largest_speed;
double time_left;
double work;
} mspring_step_info;
mspring_result mspring_network_get_step_info(
const mspring_network *network, mspring_step_info *info);
uint32_t mspring_network_step_flags(const mspring_network *network);
uint32_t mspring_network_is_asleep(const mspring_network *network);
mspring_result mspring_network_wake(mspring_network *network);
mspring_result mspring_network_apply_force(
mspring_network *network, mspring_id particle, float x, float y);
mspring_result mspring_network_apply_forces(
mspring_network *network, mspring_id first, uint32_t count, const float *x, const float *y, uint32_t stride);
mspring_result mspring_network_apply_forces_at(mspring_network *network,
const mspring_id *particles, uint32_t count, const float *x, const float *y, uint32_t stride);
mspring_result mspring_network_apply_impulses(
mspring_network *network, mspring_id first, uint32_t count, const float *x, const float *y, uint32_t stride);
mspring_result mspring_network_apply_impulses_at(mspring_network *network,
const mspring_id *particles, uint32_t count, const float *x, const float *y, uint32_t stride);
mspring_result mspring_network_apply_torque(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, float torque);
mspring_result mspring_network_set_floor(
mspring_network *network, const mspring_floor_def *def);
mspring_result mspring_network_get_floor(
const mspring_network *network, mspring_floor_def *def);
mspring_result mspring_network_get_floor_impulses(
const mspring_network *network, mspring_id first, uint32_t count, float *x, float *y, uint32_t stride);
typedef struct mspring_view {
uint32_t struct_size;
uint32_t slot_count;
uint32_t particle_count;
uint32_t reserved;
uint64_t layout_generation;
uint64_t origin_generation;
double origin_x, origin_y;
const float *x, *y;
const float *vx, *vy;
const float *inverse_mass;
const uint32_t *particle_of_slot;
const uint32_t *slot_of_particle;
const void *reserved_pointer;
} mspring_view;
mspring_result mspring_network_view(
const mspring_network *network, mspring_view *view);
mspring_result mspring_network_get_positions(
const mspring_network *network, mspring_id first, uint32_t count, double *x, double *y, uint32_t stride);
mspring_result mspring_network_get_positions_float(
const mspring_network *network, mspring_id first, uint32_t count, float *x, float *y, uint32_t stride);
mspring_result mspring_network_get_positions_at(
const mspring_network *network, const mspring_id *particles, uint32_t count, double *x, double *y, uint32_t stride);
mspring_result mspring_network_get_positions_float_at(
const mspring_network *network, const mspring_id *particles, uint32_t count, float *x, float *y, uint32_t stride);
mspring_result mspring_network_get_velocities(
const mspring_network *network, mspring_id first, uint32_t count, float *vx, float *vy, uint32_t stride);
mspring_result mspring_network_get_velocities_at(
const mspring_network *network, const mspring_id *particles, uint32_t count, float *vx, float *vy, uint32_t stride);
mspring_result mspring_network_set_positions(
mspring_network *network, mspring_id first, uint32_t count, const double *x, const double *y, uint32_t stride);
mspring_result mspring_network_set_positions_float(
mspring_network *network, mspring_id first, uint32_t count, const float *x, const float *y, uint32_t stride);
mspring_result mspring_network_set_positions_at(mspring_network *network,
const mspring_id *particles, uint32_t count, const double *x, const double *y, uint32_t stride);
mspring_result mspring_network_set_positions_float_at(
mspring_network *network, const mspring_id *particles, uint32_t count, const float *x, const float *y,
uint32_t stride);
mspring_result mspring_network_set_velocities(
mspring_network *network, mspring_id first, uint32_t count, const float *vx, const float *vy, uint32_t stride);
mspring_result mspring_network_set_velocities_at(mspring_network *network,
const mspring_id *particles, uint32_t count, const float *vx, const float *vy, uint32_t stride);
mspring_result mspring_network_state_hash(
const mspring_network *network, uint64_t *hash);
typedef enum mspring_property { MSPRING_MASS = 0, MSPRING_INVERSE_MASS_SCALE = 1, MSPRING_STIFFNESS = 2, MSPRING_DAMPING = 3, MSPRING_REST_LENGTH = 4, MSPRING_BREAK_STRAIN = 5, MSPRING_STRESS_STRAIN = 6, MSPRING_RELAX_STRAIN = 7, MSPRING_STRAIN = 8, MSPRING_LENGTH = 9, MSPRING_FORCE = 10, MSPRING_ACTIVE_STIFFNESS = 11, MSPRING_ACTIVE_DAMPING = 12, MSPRING_YIELD_STRAIN = 13, MSPRING_HARDENING = 14, MSPRING_PLASTIC_LIMIT = 15, MSPRING_PLASTIC_STRAIN = 16, MSPRING_ACTIVE_REST_LENGTH = 17, MSPRING_PROPERTY_INT = -2147483648
} mspring_property;
mspring_result mspring_network_set(mspring_network *network,
mspring_property property, mspring_id first, uint32_t count, const float *values, uint32_t stride);
mspring_result mspring_network_set_at(mspring_network *network,
mspring_property property, const mspring_id *ids, uint32_t count, const float *values, uint32_t stride);
mspring_result mspring_network_get(const mspring_network *network,
mspring_property property, mspring_id first, uint32_t count, float *values, uint32_t stride);
mspring_result mspring_network_get_at(const mspring_network *network,
mspring_property property, const mspring_id *ids, uint32_t count, float *values, uint32_t stride);
typedef enum mspring_numbering { MSPRING_ENDS_IDS = 0, MSPRING_ENDS_SLOTS = 1, MSPRING_NUMBERING_INT = -2147483648
} mspring_numbering;
mspring_result mspring_network_get_ends(const mspring_network *network,
mspring_id first, uint32_t count, mspring_numbering numbering, uint32_t *a, uint32_t *b, uint32_t stride);
mspring_result mspring_network_get_spring_flags(
const mspring_network *network, mspring_id first, uint32_t count, uint32_t *flags, uint32_t stride);
mspring_result mspring_network_max_strain(
const mspring_network *network, float *strain, mspring_id *spring);
mspring_result mspring_network_break_springs(
mspring_network *network, const mspring_id *springs, uint32_t count);
mspring_result mspring_network_restore_springs(
mspring_network *network, const mspring_id *springs, uint32_t count, double ramp_seconds);
mspring_result mspring_network_detach_particles(
mspring_network *network, const mspring_id *particles, uint32_t count);
uint32_t mspring_network_has_particle(const mspring_network *network, mspring_id particle);
uint32_t mspring_network_has_spring(const mspring_network *network, mspring_id spring);
mspring_result mspring_network_add_particles(
mspring_network *network, const mspring_particle_def *defs, uint32_t count, mspring_id *ids);
mspring_result mspring_network_add_springs(
mspring_network *network, const mspring_spring_def *defs, uint32_t count, mspring_id *ids);
mspring_result mspring_network_remove_particles(
mspring_network *network, const mspring_id *particles, uint32_t count);
mspring_result mspring_network_remove_springs(
mspring_network *network, const mspring_id *springs, uint32_t count);
mspring_result mspring_network_recycle(mspring_network *network);
typedef enum mspring_event_kind { MSPRING_EVENT_BROKEN = 0, MSPRING_EVENT_STRESSED = 1, MSPRING_EVENT_RELAXED = 2, MSPRING_EVENT_RESTORED = 3, MSPRING_EVENT_DETACHED = 4, MSPRING_EVENT_SPLIT = 5, MSPRING_EVENT_JOINED = 6, MSPRING_EVENT_YIELDED = 7, MSPRING_EVENT_KIND_INT = -2147483648
} mspring_event_kind;
typedef struct mspring_event {
mspring_event_kind kind;
mspring_id id;
mspring_id other;
float strain;
} mspring_event;
mspring_result mspring_network_reserve_events(
mspring_network *network, uint32_t capacity);
mspring_result mspring_network_read_events(
mspring_network *network, mspring_event *events, uint32_t capacity, uint32_t *count, uint64_t *lost);
mspring_result mspring_network_update_components(
mspring_network *network, uint32_t *count, uint32_t *changed);
mspring_result mspring_network_get_component_numbers(
const mspring_network *network, mspring_id first, uint32_t count, uint32_t *numbers, uint32_t stride);
typedef struct mspring_component {
uint32_t struct_size;
mspring_id head;
uint32_t particle_count;
uint32_t reserved;
double mass;
double x, y;
double px, py;
} mspring_component;
mspring_result mspring_network_get_components(
const mspring_network *network, uint32_t first, uint32_t count, mspring_component *components);
mspring_result mspring_network_energy(
const mspring_network *network, double *kinetic, double *elastic, double *potential);
mspring_result mspring_network_momentum(
const mspring_network *network, double *px, double *py, double *angular);
mspring_result mspring_network_bounds(
const mspring_network *network, double *min_x, double *min_y, double *max_x, double *max_y);
typedef struct mspring_body {
uint32_t struct_size;
uint32_t particle_count;
mspring_id head;
uint32_t reserved;
double mass;
double x, y;
double vx, vy;
double inertia;
double angle;
double spin;
double px, py;
double angular;
double min_x, min_y, max_x, max_y;
} mspring_body;
mspring_result mspring_network_get_body(
const mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, mspring_body *body);
typedef enum mspring_snapshot_contents { MSPRING_SNAPSHOT_ALL = 0, MSPRING_SNAPSHOT_FRAME = 1, MSPRING_SNAPSHOT_CONTENTS_INT = -2147483648
} mspring_snapshot_contents;
mspring_result mspring_network_snapshot_size(
const mspring_network *network, mspring_snapshot_contents contents, size_t *size);
mspring_result mspring_network_save(
const mspring_network *network, mspring_snapshot_contents contents, void *snapshot, size_t capacity, size_t *size);
mspring_result mspring_network_load(
mspring_network *network, const void *snapshot, size_t size);
typedef mspring_result(*mspring_write_fn)(const void *bytes, size_t size, void *user);
mspring_result mspring_network_write(
const mspring_network *network, mspring_write_fn write, void *user);
mspring_result mspring_builder_add_copies(mspring_builder *builder,
const mspring_builder *from, uint32_t count, const double *x, const double *y, uint32_t stride,
mspring_id *first_particle, mspring_id *first_spring);
mspring_result mspring_network_set_groups(
mspring_network *network, const mspring_id *firsts, uint32_t count);
uint32_t mspring_network_group_count(const mspring_network *network);
enum { MSPRING_GROUP_HELD = 1u << 0
};
mspring_result mspring_network_get_group_flags(
const mspring_network *network, uint32_t first, uint32_t count, uint32_t *flags, uint32_t stride);
mspring_result mspring_network_mark_groups(
mspring_network *network, const uint32_t *groups, uint32_t count);
typedef enum mspring_reset { MSPRING_RESET_START = 0, MSPRING_RESET_MARK = 1, MSPRING_RESET_INT = -2147483648
} mspring_reset;
mspring_result mspring_network_reset_groups(
mspring_network *network, const uint32_t *groups, uint32_t count, mspring_reset to);
enum { MSPRING_OBSERVE_X = 0, MSPRING_OBSERVE_Y = 1, MSPRING_OBSERVE_VX = 2, MSPRING_OBSERVE_VY = 3, MSPRING_OBSERVE_MIN_X = 4, MSPRING_OBSERVE_MIN_Y = 5, MSPRING_OBSERVE_MAX_X = 6, MSPRING_OBSERVE_MAX_Y = 7, MSPRING_OBSERVE_HELD = 8, MSPRING_OBSERVE_PARTICLES = 9
};
mspring_result mspring_network_observe_groups(
const mspring_network *network, uint32_t first, uint32_t count, const uint32_t *particles,
uint32_t particle_count, double *rows, uint32_t stride);
mspring_result mspring_network_set_actuators(
mspring_network *network, const mspring_id *springs, uint32_t count, uint32_t changes);
uint32_t mspring_network_actuator_count(const mspring_network *network);
mspring_result mspring_network_set_signals(
mspring_network *network, uint32_t first, uint32_t count, const float *signals, uint32_t stride);
enum { MSPRING_CONTACT_SELF = 1u << 0
};
typedef struct mspring_contact_def {
uint32_t struct_size;
uint32_t flags;
double thickness;
float friction;
float restitution;
float push_speed;
uint32_t sweeps;
uint32_t capacity;
uint32_t max_capacity;
} mspring_contact_def;
mspring_result mspring_contact_def_init(mspring_contact_def *def, size_t size);
mspring_result mspring_network_set_contact(
mspring_network *network, const mspring_contact_def *def);
mspring_result mspring_network_get_contact(
const mspring_network *network, mspring_contact_def *def);
mspring_result mspring_network_set_contact_groups(
mspring_network *network, mspring_id first, uint32_t count, uint32_t groups, uint32_t masks);
mspring_result mspring_network_set_contact_surface(
mspring_network *network, mspring_id first, uint32_t count, float friction, float restitution);
typedef struct mspring_contact_info {
uint32_t struct_size;
uint32_t edges;
uint32_t points;
uint32_t pairs;
uint32_t touching;
uint32_t reserved;
double deepest;
} mspring_contact_info;
mspring_result mspring_network_get_contact_info(
const mspring_network *network, mspring_contact_info *info);
typedef enum mspring_contact_event_kind { MSPRING_CONTACT_BEGAN = 0, MSPRING_CONTACT_ENDED = 1, MSPRING_CONTACT_EVENT_INT = -2147483648
} mspring_contact_event_kind;
typedef struct mspring_contact_event {
uint32_t struct_size;
mspring_contact_event_kind kind;
mspring_id point;
mspring_id a, b;
mspring_id collider;
double x, y;
double normal_x, normal_y;
double impulse;
double friction;
} mspring_contact_event;
mspring_result mspring_network_reserve_contact_events(
mspring_network *network, uint32_t capacity);
mspring_result mspring_network_read_contact_events(
mspring_network *network, mspring_contact_event *events, uint32_t capacity, uint32_t *count, uint64_t *lost);
typedef enum mspring_collider_kind { MSPRING_COLLIDER_CHAIN = 0, MSPRING_COLLIDER_BOX = 1, MSPRING_COLLIDER_CIRCLE = 2, MSPRING_COLLIDER_INT = -2147483648
} mspring_collider_kind;
enum { MSPRING_COLLIDER_CLOSED = 1u << 0
};
typedef struct mspring_collider_def {
uint32_t struct_size;
mspring_collider_kind kind;
double x, y;
double angle;
double width, height;
double radius;
const double *points;
void *reserved_pointer;
uint32_t point_count;
uint32_t flags;
float friction;
float restitution;
uint32_t groups, masks;
} mspring_collider_def;
mspring_result mspring_collider_def_init(mspring_collider_def *def, size_t size);
mspring_result mspring_network_add_collider(
mspring_network *network, const mspring_collider_def *def, mspring_id *collider);
mspring_result mspring_network_remove_collider(
mspring_network *network, mspring_id collider);
mspring_result mspring_network_move_collider(
mspring_network *network, mspring_id collider, double x, double y, double angle);
mspring_result mspring_network_place_collider(
mspring_network *network, mspring_id collider, double x, double y, double angle);
mspring_result mspring_network_get_collider(
const mspring_network *network, mspring_id collider, mspring_collider_def *def);
mspring_result mspring_network_get_collider_impulse(
const mspring_network *network, mspring_id collider, double *x, double *y, double *angular);
typedef struct mspring_grip_def {
uint32_t struct_size;
mspring_id particle;
double x, y;
float stiffness;
float damping;
float max_force;
uint32_t reserved;
} mspring_grip_def;
mspring_result mspring_grip_def_init(mspring_grip_def *def, size_t size);
mspring_result mspring_network_add_grip(
mspring_network *network, const mspring_grip_def *def, mspring_id *grip);
mspring_result mspring_network_remove_grip(
mspring_network *network, mspring_id grip);
mspring_result mspring_network_set_grip(
mspring_network *network, mspring_id grip, const mspring_grip_def *def);
mspring_result mspring_network_move_grip(
mspring_network *network, mspring_id grip, double x, double y);
mspring_result mspring_network_get_grip(
const mspring_network *network, mspring_id grip, mspring_grip_def *def);
mspring_result mspring_network_get_grip_impulse(
const mspring_network *network, mspring_id grip, double *x, double *y);
typedef struct mspring_gradient mspring_gradient;
typedef enum mspring_gradient_of { MSPRING_GRADIENT_STIFFNESS = 0, MSPRING_GRADIENT_DAMPING = 1, MSPRING_GRADIENT_REST_LENGTH = 2, MSPRING_GRADIENT_X = 3, MSPRING_GRADIENT_Y = 4, MSPRING_GRADIENT_VX = 5, MSPRING_GRADIENT_VY = 6, MSPRING_GRADIENT_OF_INT = -2147483648
} mspring_gradient_of;
mspring_result mspring_gradient_create(mspring_network *network,
uint32_t step_count, const mspring_id *forced, uint32_t forced_count, mspring_gradient **gradient);
void mspring_gradient_destroy(mspring_gradient *gradient);
const char *mspring_gradient_error(const mspring_gradient *gradient);
mspring_result mspring_gradient_step(
mspring_gradient *gradient, double dt, const float *signals, const float *forces);
mspring_result mspring_gradient_add_seeds(mspring_gradient *gradient,
const mspring_id *ids, mspring_id first, uint32_t count, const double *positions, const double *velocities);
mspring_result mspring_gradient_reverse(
mspring_gradient *gradient, uint32_t step_count);
mspring_result mspring_gradient_get(const mspring_gradient *gradient,
mspring_gradient_of of, const mspring_id *ids, mspring_id first, uint32_t count, double *values, uint32_t stride);
mspring_result mspring_gradient_get_signals(
const mspring_gradient *gradient, uint32_t step, double *values);
mspring_result mspring_gradient_get_forces(
const mspring_gradient *gradient, uint32_t step, double *values);
enum { MSPRING_SPRING_PULL_ONLY = 1u << 2, MSPRING_SPRING_PUSH_ONLY = 1u << 3
};
typedef struct mspring_plasticity {
uint32_t struct_size;
uint32_t bent_springs;
uint64_t yield_count;
double dissipated;
} mspring_plasticity;
mspring_result mspring_network_get_plasticity(
const mspring_network *network, mspring_plasticity *report);
mspring_result mspring_builder_add_strain_limits(mspring_builder *builder,
mspring_id first, uint32_t count, float strain, float stiffening, mspring_id *first_limit);
typedef enum mspring_area_kind { MSPRING_AREA_ELASTIC = 0, MSPRING_AREA_GAS = 1, MSPRING_AREA_INT = -2147483648
} mspring_area_kind;
typedef struct mspring_area_def {
uint32_t struct_size;
mspring_area_kind kind;
float stiffness;
float pressure;
float fill;
uint32_t reserved;
double rest_area;
} mspring_area_def;
typedef struct mspring_area_info {
uint32_t struct_size;
uint32_t particle_count;
uint32_t is_open;
uint32_t reserved;
double area;
double pressure;
double energy;
} mspring_area_info;
mspring_result mspring_area_def_init(mspring_area_def *def, size_t size);
mspring_result mspring_network_add_area(mspring_network *network,
const mspring_area_def *def, const mspring_id *particles, uint32_t count, mspring_id *area);
mspring_result mspring_network_add_cell_areas(
mspring_network *network, const mspring_area_def *def, mspring_id *first_area, uint32_t *count);
mspring_result mspring_network_remove_area(
mspring_network *network, mspring_id area);
mspring_result mspring_network_set_area(
mspring_network *network, mspring_id area, const mspring_area_def *def);
mspring_result mspring_network_get_area(
const mspring_network *network, mspring_id area, mspring_area_def *def);
mspring_result mspring_network_get_area_info(
const mspring_network *network, mspring_id area, mspring_area_info *info);
mspring_result mspring_network_get_area_particles(
const mspring_network *network, mspring_id area, mspring_id *particles, uint32_t capacity, uint32_t *count);
mspring_result mspring_network_get_areas(const mspring_network *network,
mspring_id *ids, double *areas, double *pressures, uint32_t capacity, uint32_t *count);
enum { MSPRING_ANGLE_REST_GIVEN = 1u << 0
};
typedef struct mspring_angle_def {
uint32_t struct_size;
float stiffness;
float damping;
uint32_t flags;
double rest_angle;
} mspring_angle_def;
typedef struct mspring_angle_info {
uint32_t struct_size;
uint32_t is_open;
mspring_id a, b, c;
uint32_t reserved;
double angle;
double torque;
double energy;
} mspring_angle_info;
mspring_result mspring_angle_def_init(mspring_angle_def *def, size_t size);
mspring_result mspring_network_add_angles(mspring_network *network,
const mspring_angle_def *def, const mspring_id *particles, uint32_t count, mspring_id *first_angle);
mspring_result mspring_network_remove_angle(
mspring_network *network, mspring_id angle);
mspring_result mspring_network_set_angle(
mspring_network *network, mspring_id angle, const mspring_angle_def *def);
mspring_result mspring_network_set_rest_angles(
mspring_network *network, mspring_id first, uint32_t count, const double *rest_angles, uint32_t stride);
mspring_result mspring_network_get_angle(
const mspring_network *network, mspring_id angle, mspring_angle_def *def);
mspring_result mspring_network_get_angle_info(
const mspring_network *network, mspring_id angle, mspring_angle_info *info);
mspring_result mspring_network_get_angles(const mspring_network *network,
mspring_id *ids, double *angles, double *torques, uint32_t capacity, uint32_t *count);
typedef enum mspring_preset { MSPRING_PRESET_STEEL = 0, MSPRING_PRESET_WOOD = 1, MSPRING_PRESET_RUBBER = 2, MSPRING_PRESET_JELLY = 3, MSPRING_PRESET_INT = -2147483648
} mspring_preset;
mspring_result mspring_material_preset(
mspring_material *material, size_t size, mspring_preset preset, double spacing, double substep);
typedef struct mspring_rope_def {
uint32_t struct_size;
uint32_t spring_flags;
mspring_id from, to;
uint32_t segment_count;
float mass;
float stiffness;
float damping;
float slack;
float break_strain, stress_strain, relax_strain;
float yield_strain, hardening, plastic_limit;
} mspring_rope_def;
typedef struct mspring_mesh_def {
uint32_t struct_size;
uint32_t spring_flags;
uint32_t vertex_count;
uint32_t triangle_count;
const double *x, *y;
const uint32_t *triangles;
float area_density;
float stiffness;
float young_modulus;
float damping;
float break_strain, stress_strain, relax_strain;
float yield_strain, hardening, plastic_limit;
} mspring_mesh_def;
typedef struct mspring_disc_def {
uint32_t struct_size;
uint32_t spring_flags;
uint32_t centre_flags;
uint32_t ring_count;
double x, y;
double radius;
float area_density;
float stiffness, young_modulus, damping, break_strain, stress_strain, relax_strain;
float yield_strain, hardening, plastic_limit;
} mspring_disc_def;
mspring_result mspring_rope_def_init(mspring_rope_def *def, size_t size);
mspring_result mspring_mesh_def_init(mspring_mesh_def *def, size_t size);
mspring_result mspring_disc_def_init(mspring_disc_def *def, size_t size);
mspring_result mspring_builder_add_rope(mspring_builder *builder,
const mspring_rope_def *def, mspring_id *particles, uint32_t capacity, mspring_id *first_spring);
mspring_result mspring_builder_add_mesh(
mspring_builder *builder, const mspring_mesh_def *def, mspring_id *first_particle, mspring_id *first_spring);
mspring_result mspring_builder_add_disc(
mspring_builder *builder, const mspring_disc_def *def, mspring_id *first_particle, mspring_id *first_spring);
mspring_result mspring_builder_add_network(mspring_builder *builder,
const mspring_network *network, const mspring_id *particles, uint32_t count, mspring_id *particle_ids,
mspring_id *spring_ids);
enum { MSPRING_CLONE_HOOKS = 1u << 0
};
typedef struct mspring_clone_def {
uint32_t struct_size;
uint32_t flags;
const mspring_allocator *allocator;
const mspring_tasks *tasks;
uint32_t worker_count;
uint32_t reserved;
} mspring_clone_def;
mspring_result mspring_clone_def_init(mspring_clone_def *def, size_t size);
mspring_result mspring_network_clone(
const mspring_network *network, const mspring_clone_def *def, mspring_network **clone);
typedef enum mspring_phase { MSPRING_PHASE_BEFORE_STEP = 0, MSPRING_PHASE_BEFORE_SUBSTEP = 1, MSPRING_PHASE_AFTER_SUBSTEP = 2, MSPRING_PHASE_INT = -2147483648
} mspring_phase;
typedef struct mspring_hook_args {
uint32_t struct_size;
mspring_phase phase;
uint32_t substep, substep_count;
uint32_t first_slot, slot_count;
double dt;
double origin_x, origin_y;
float *x, *y, *vx, *vy;
float *force_x, *force_y;
const float *inverse_mass;
const uint32_t *particle_of_slot, *slot_of_particle;
const mspring_network *network;
uint32_t group_count;
uint32_t worker;
void *storage;
const void *reserved;
} mspring_hook_args;
typedef void(*mspring_hook_fn)(const mspring_hook_args *args, void *user);
enum { MSPRING_HOOK_CONCURRENT = 1u << 0, MSPRING_HOOK_BELOW = 1u << 1
};
typedef struct mspring_hook_def {
uint32_t struct_size;
mspring_phase phase;
mspring_hook_fn fn;
void *user;
uint32_t period;
uint32_t flags;
uint32_t range_slots;
uint32_t reserved;
void *storage;
size_t storage_stride;
double below_y;
} mspring_hook_def;
mspring_result mspring_hook_def_init(mspring_hook_def *def, size_t size);
mspring_result mspring_network_add_hook(
mspring_network *network, const mspring_hook_def *def, mspring_id *hook);
mspring_result mspring_network_remove_hook(
mspring_network *network, mspring_id hook);
mspring_result mspring_network_nearest_particle(
const mspring_network *network, double x, double y, double within, mspring_id *particle, double *distance);
mspring_result mspring_network_particles_in_circle(
const mspring_network *network, double x, double y, double radius, mspring_id *particles, uint32_t capacity,
uint32_t *count);
mspring_result mspring_network_particles_in_box(
const mspring_network *network, double min_x, double min_y, double max_x, double max_y, mspring_id *particles,
uint32_t capacity, uint32_t *count);
enum { MSPRING_FIND_WHOLE = 1u << 0, MSPRING_FIND_BROKEN = 1u << 1
};
mspring_result mspring_network_nearest_spring(const mspring_network *network,
double x, double y, double within, uint32_t flags, mspring_id *spring, double *fraction, double *distance);
mspring_result mspring_network_springs_in_circle(
const mspring_network *network, double x, double y, double radius, uint32_t flags, mspring_id *springs,
uint32_t capacity, uint32_t *count);
mspring_result mspring_network_springs_across(const mspring_network *network,
double from_x, double from_y, double to_x, double to_y, uint32_t flags, mspring_id *springs, double *fractions,
uint32_t capacity, uint32_t *count);
typedef struct mspring_mutable_view {
uint32_t struct_size;
uint32_t slot_count, particle_count, reserved;
uint64_t layout_generation, origin_generation;
double origin_x, origin_y;
float *x, *y, *vx, *vy;
const float *inverse_mass;
const uint32_t *particle_of_slot, *slot_of_particle;
const void *reserved_pointer;
} mspring_mutable_view;
mspring_result mspring_network_view_mutable(
mspring_network *network, mspring_mutable_view *view);
typedef struct mspring_spring_info {
uint32_t struct_size;
uint32_t flags;
mspring_id a, b;
float stiffness;
float damping;
float rest_length;
float length;
float strain;
float force;
float nominal_stiffness;
float nominal_damping;
} mspring_spring_info;
mspring_result mspring_network_get_spring(
const mspring_network *network, mspring_id spring, mspring_spring_info *info);
mspring_result mspring_network_get_extents(
mspring_network *network, float *length, float *direction_x, float *direction_y, float *strain);
mspring_result mspring_network_renew_relative_springs(
mspring_network *network);
mspring_result mspring_network_get_sleepers(
const mspring_network *network, mspring_id first, uint32_t count, uint8_t *asleep, uint32_t stride);
uint32_t mspring_network_worker_count(const mspring_network *network);
mspring_simd mspring_network_simd_level(const mspring_network *network);
mspring_simd mspring_simd_supported(void);
uint32_t mspring_simd_available(mspring_simd level);
const char *mspring_simd_name(mspring_simd level);
mspring_result mspring_network_stable_dt(
mspring_network *network, double *now, double *any_shape);
mspring_result mspring_network_suggest_substeps(
mspring_network *network, double dt, double safety, uint32_t *substeps);
enum { MSPRING_SETTLE_LEAVE_FLOATING = 1u << 0
};
typedef struct mspring_settle_def {
uint32_t struct_size;
uint32_t flags;
uint32_t max_iterations;
uint32_t reserved;
double tolerance;
double relative_substep;
} mspring_settle_def;
typedef struct mspring_settle_result {
uint32_t struct_size;
uint32_t iterations;
double residual;
double largest_force;
double displacement;
uint32_t is_stable;
uint32_t left_alone;
} mspring_settle_result;
mspring_result mspring_settle_def_init(mspring_settle_def *def, size_t size);
mspring_result mspring_network_settle(
mspring_network *network, const mspring_settle_def *def, mspring_settle_result *result);
typedef enum mspring_tune_measure { MSPRING_TUNE_BY_TRAJECTORY = 0, MSPRING_TUNE_BY_REST = 1, MSPRING_TUNE_BY_BENDING = 2, MSPRING_TUNE_BY_SCENE = 3, MSPRING_TUNE_MEASURE_INT = -2147483648
} mspring_tune_measure;
enum { MSPRING_TUNE_NOTHING_ELSE = 1u << 0
};
typedef uint32_t(*mspring_progress_fn)(double done, void *user);
typedef double(*mspring_clock_fn)(void *user);
enum { MSPRING_TUNE_SCENE_FLOOR = 1u << 0, MSPRING_TUNE_SCENE_BREAKING = 1u << 1, MSPRING_TUNE_SCENE_HOOKS = 1u << 2
};
typedef mspring_result(*mspring_tune_prepare_fn)(mspring_network *run, uint32_t start, void *user);
typedef struct mspring_tune_scene {
uint32_t struct_size;
uint32_t flags;
uint32_t start_count;
uint32_t reserved;
double duration;
double kick;
double tolerance;
double max_distance;
mspring_tune_prepare_fn prepare;
void *reserved_pointer;
} mspring_tune_scene;
mspring_result mspring_tune_scene_init(mspring_tune_scene *scene, size_t size);
typedef struct mspring_tune_def {
uint32_t struct_size;
uint32_t setting_count;
double dt;
double duration;
double budget;
mspring_tune_measure measure;
uint32_t flags;
double max_error;
double max_cost;
double max_drift;
const mspring_solver_def *settings;
mspring_clock_fn clock;
mspring_progress_fn progress;
void *user;
const mspring_tune_scene *scene;
void *reserved_pointer;
} mspring_tune_def;
enum { MSPRING_TUNE_HAS_COST = 1u << 0, MSPRING_TUNE_HAS_TRAJECTORY = 1u << 1, MSPRING_TUNE_HAS_REST = 1u << 2, MSPRING_TUNE_REJECTED = 1u << 3, MSPRING_TUNE_PARETO = 1u << 4, MSPRING_TUNE_RECOMMENDED = 1u << 5, MSPRING_TUNE_HAS_SCENE = 1u << 6, MSPRING_TUNE_CHAOTIC = 1u << 7
};
enum { MSPRING_TUNE_BROKEN = 0, MSPRING_TUNE_ENERGY = 1, MSPRING_TUNE_EXTENT = 2
};
typedef struct mspring_tune_row {
uint32_t struct_size;
uint32_t flags;
uint32_t setting;
mspring_solver solver;
mspring_integrator integrator;
uint32_t substeps;
uint32_t iterations, tile_size, coarse_period;
uint32_t step_count;
double min_cost, median_cost;
double trajectory_error;
double trajectory_share;
double energy_drift;
double bending;
double rest_error;
double rest_share;
double duration;
double moving_cost;
double resting_cost;
uint32_t scene_starts;
uint32_t fine_substeps;
double scene_cost;
double scene_distance;
double scene_mean[3];
double scene_spread[3];
double fine_mean[3];
double fine_spread[3];
float residual;
float trajectory_spread;
} mspring_tune_row;
mspring_result mspring_tune_def_init(mspring_tune_def *def, size_t size);
mspring_result mspring_tune_settings(
mspring_network *network, double dt, mspring_solver_def *settings, uint32_t capacity, uint32_t *count);
mspring_result mspring_network_tune(
mspring_network *network, const mspring_tune_def *def, mspring_tune_row *rows, uint32_t capacity, uint32_t *count);
mspring_result mspring_tune_row_solver(
const mspring_tune_row *row, mspring_solver_def *solver);
typedef struct mspring_plan {
uint32_t struct_size;
uint32_t particle_count, spring_count;
uint32_t lattice_count;
uint32_t lattice_particles, lattice_springs;
uint32_t lattice_rows;
uint32_t lattice_blocks;
uint32_t chain_count;
uint32_t chain_particles, chain_springs;
uint32_t irregular_particles;
uint32_t loose_particles;
uint32_t irregular_springs;
uint32_t pass_rows;
uint32_t pass_lag;
uint32_t pass_substeps;
uint32_t slot_count;
uint32_t block_width;
uint32_t has_damping;
uint32_t has_relative;
mspring_simd simd_level;
mspring_solver solver;
mspring_integrator integrator;
uint32_t iterations;
uint32_t tile_size;
uint32_t tile_count;
uint32_t coarse_values;
uint32_t coarse_period;
uint32_t irregular_layers;
uint64_t factor_values;
double factor_products;
uint32_t pass_workers;
float residual;
} mspring_plan;
mspring_result mspring_network_get_plan(
const mspring_network *network, mspring_plan *plan);
size_t mspring_network_memory_used(const mspring_network *network);
mspring_result mspring_network_compact(mspring_network *network);
mspring_result mspring_network_expand(mspring_network *network);
typedef struct mspring_job mspring_job;
typedef enum mspring_layout { MSPRING_LAYOUT_COMPACT = 0, MSPRING_LAYOUT_WHOLE = 1, MSPRING_LAYOUT_INT = -2147483648
} mspring_layout;
mspring_result mspring_job_begin(
mspring_network *network, mspring_layout layout, mspring_job **job);
mspring_result mspring_job_run(
mspring_job *job, uint32_t at_most, uint32_t *left);
mspring_result mspring_job_finish(
mspring_network *network, mspring_job *job);
const char *mspring_job_error(const mspring_job *job);
void mspring_job_destroy(mspring_job *job);
]]
return {
  VERSION_MAJOR = 0,
  VERSION_MINOR = 2,
  VERSION_PATCH = 0,
  VERSION = 2000,
  NONE = 4294967295,
  MAX_PARTICLES = 67108864,
  MAX_SPRINGS = 268435456,
  MAX_COORDINATE = 1000000000000.0,
  MAX_SPEED = 1000000000000000.0,
  MAX_WORKERS = 256,
  NEVER = 3.4028234663852886e+38,
  RELAX_STRAIN_DEFAULT = -1.0,
  REST_LENGTH_DISTANCE = -1.0,
  CELL_EMPTY = 65535,
  MAX_SUBSTEPS = 1000000,
  SUBSTEPS_AUTO = 4294967295,
  SUBSTEPS_EVEN = 4294967294,
  MAX_PLANES = 8,
  MAX_HEIGHTS = 67108864,
  MAX_COLLIDER_POINTS = 65536,
  MAX_GRIPS = 16,
  MAX_GRADIENT_STEPS = 16777216,
  HARDENING_DEFAULT = 0.1,
  PLASTIC_LIMIT_DEFAULT = 0.5,
  MAX_AREA_PARTICLES = 4096,
  TUNE_QUANTITIES = 3,
}
