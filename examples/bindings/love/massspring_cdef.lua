-- Of the headers of libmassspring 0.3.0, by examples/bindings/generate: do not edit.
-- SPDX-License-Identifier: MIT
require("ffi").cdef [[
uint32_t mspring_version(void);
const char *mspring_version_string(void);
typedef enum mspring_feature_flags { MSPRING_FEATURE_THREADS = 1 << 0, MSPRING_FEATURE_HOSTED = 1 << 1, MSPRING_FEATURE_SHARED = 1 << 2, MSPRING_FEATURE_IMPLICIT = 1 << 3, MSPRING_FEATURE_DIRECT = 1 << 4, MSPRING_FEATURE_FLOOR = 1 << 5, MSPRING_FEATURE_CONTACT = 1 << 6, MSPRING_FEATURE_LAWS = 1 << 7, MSPRING_FEATURE_BATCH = 1 << 8, MSPRING_FEATURE_LAB = 1 << 9
} mspring_feature_flags;
uint32_t mspring_features(void);
typedef enum mspring_result { MSPRING_OK = 0, MSPRING_ERROR_ARGUMENT = -1, MSPRING_ERROR_ID = -2, MSPRING_ERROR_MEMORY = -3, MSPRING_ERROR_LIMIT = -4, MSPRING_ERROR_STRUCT = -5, MSPRING_ERROR_DUPLICATE = -6, MSPRING_ERROR_UNSTABLE = -7, MSPRING_ERROR_BUSY = -8, MSPRING_ERROR_THREAD = -9, MSPRING_ERROR_EQUILIBRIUM = -10, MSPRING_ERROR_SNAPSHOT = -11, MSPRING_ERROR_OUTDATED = -12, MSPRING_ERROR_REFUSED = -13, MSPRING_RESULT_INT = -2147483648
} mspring_result;
const char *mspring_result_string(mspring_result result);
typedef enum mspring_struct { MSPRING_STRUCT_ALLOCATOR = 0, MSPRING_STRUCT_TASKS = 1, MSPRING_STRUCT_PARTICLE_DEF = 2, MSPRING_STRUCT_SPRING_DEF = 3, MSPRING_STRUCT_MATERIAL = 4, MSPRING_STRUCT_LATTICE_DEF = 5, MSPRING_STRUCT_ROPE_DEF = 6, MSPRING_STRUCT_MESH_DEF = 7, MSPRING_STRUCT_DISC_DEF = 8, MSPRING_STRUCT_SETTINGS = 9, MSPRING_STRUCT_NETWORK_DEF = 10, MSPRING_STRUCT_CLONE_DEF = 11, MSPRING_STRUCT_NETWORK_INFO = 12, MSPRING_STRUCT_STEP_INFO = 13, MSPRING_STRUCT_VIEW = 14, MSPRING_STRUCT_ENERGY = 15, MSPRING_STRUCT_BODY = 16, MSPRING_STRUCT_HOOK_ARGS = 17, MSPRING_STRUCT_HOOK_DEF = 18, MSPRING_STRUCT_FLOOR_DEF = 19, MSPRING_STRUCT_CONTACT_DEF = 20, MSPRING_STRUCT_CONTACT_INFO = 21, MSPRING_STRUCT_CONTACT_EVENT = 22, MSPRING_STRUCT_COLLIDER_DEF = 23, MSPRING_STRUCT_GRIP_DEF = 24, MSPRING_STRUCT_AREA_DEF = 25, MSPRING_STRUCT_ANGLE_DEF = 26, MSPRING_STRUCT_SETTLE_DEF = 1000, MSPRING_STRUCT_SETTLE_RESULT = 1001, MSPRING_STRUCT_TUNE_SCENE = 1002, MSPRING_STRUCT_TUNE_DEF = 1003, MSPRING_STRUCT_TUNE_ROW = 1004, MSPRING_STRUCT_INT = -2147483648
} mspring_struct;
mspring_result mspring_init(mspring_struct kind, void *made, size_t size);
typedef enum mspring_simd { MSPRING_SIMD_AUTO = 0, MSPRING_SIMD_SCALAR = 1, MSPRING_SIMD_SSE2 = 2, MSPRING_SIMD_AVX2 = 3, MSPRING_SIMD_AVX512 = 4, MSPRING_SIMD_NEON = 5, MSPRING_SIMD_WASM = 6, MSPRING_SIMD_INT = -2147483648
} mspring_simd;
uint32_t mspring_simd_available(mspring_simd level);
const char *mspring_simd_name(mspring_simd level);
typedef uint32_t mspring_id;
typedef enum mspring_kind { MSPRING_PARTICLES = 0, MSPRING_SPRINGS = 1, MSPRING_ELEMENTS = 2, MSPRING_GROUPS = 3, MSPRING_ACTUATORS = 4, MSPRING_KIND_INT = -2147483648
} mspring_kind;
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
void(*release)(void *user);
} mspring_tasks;
typedef enum mspring_particle_flags { MSPRING_PARTICLE_PINNED = 1 << 0, MSPRING_PARTICLE_ASLEEP = 1 << 8, MSPRING_PARTICLE_REMOVED = 1 << 10
} mspring_particle_flags;
typedef enum mspring_spring_flags { MSPRING_SPRING_RELATIVE = 1 << 0, MSPRING_SPRING_DAMPING_RATIO = 1 << 1, MSPRING_SPRING_PULL_ONLY = 1 << 2, MSPRING_SPRING_PUSH_ONLY = 1 << 3, MSPRING_SPRING_METRES = 1 << 4, MSPRING_SPRING_BROKEN = 1 << 8, MSPRING_SPRING_STRESSED = 1 << 9, MSPRING_SPRING_REMOVED = 1 << 10
} mspring_spring_flags;
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
float warn_strain;
float relax_strain;
float yield_strain;
float hardening, plastic_limit;
} mspring_spring_def;
typedef struct mspring_material {
uint32_t struct_size;
uint32_t particle_flags;
uint32_t spring_flags;
float mass;
float stiffness;
float damping, break_strain, warn_strain, relax_strain, yield_strain, hardening, plastic_limit;
} mspring_material;
typedef enum mspring_preset { MSPRING_PRESET_STEEL = 0, MSPRING_PRESET_WOOD = 1, MSPRING_PRESET_RUBBER = 2, MSPRING_PRESET_JELLY = 3, MSPRING_PRESET_INT = -2147483648
} mspring_preset;
mspring_result mspring_material_preset(
mspring_material *material, mspring_preset preset, double spacing, double substep);
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
typedef struct mspring_rope_def {
uint32_t struct_size;
uint32_t segment_count;
mspring_id from, to;
const mspring_material *material;
float length_ratio;
uint32_t reserved;
} mspring_rope_def;
typedef struct mspring_mesh_def {
uint32_t struct_size;
uint32_t vertex_count;
uint32_t triangle_count;
float area_density;
const double *x, *y;
const uint32_t *triangles;
const mspring_material *material;
float young_modulus;
uint32_t reserved;
} mspring_mesh_def;
typedef struct mspring_disc_def {
uint32_t struct_size;
uint32_t ring_count;
double x, y;
double radius;
const mspring_material *material;
const void *reserved_pointer;
float area_density;
float young_modulus;
uint32_t centre_flags;
uint32_t reserved;
} mspring_disc_def;
typedef enum mspring_solver { MSPRING_SOLVER_EXPLICIT = 0, MSPRING_SOLVER_IMPLICIT = 1, MSPRING_SOLVER_DIRECT = 2, MSPRING_SOLVER_INT = -2147483648
} mspring_solver;
typedef enum mspring_integrator { MSPRING_INTEGRATOR_ALPHA = 0, MSPRING_INTEGRATOR_BDF2 = 1, MSPRING_INTEGRATOR_EULER = 2, MSPRING_INTEGRATOR_INT = -2147483648
} mspring_integrator;
typedef enum mspring_guard { MSPRING_GUARD_GROWTH = 0, MSPRING_GUARD_RETRY = 1, MSPRING_GUARD_BOUNDS = 2, MSPRING_GUARD_IMPLICIT = 3, MSPRING_GUARD_CLAMP = 4, MSPRING_GUARD_CLAMP_BOUNDS = 5, MSPRING_GUARD_INT = -2147483648
} mspring_guard;
typedef struct mspring_settings {
uint32_t struct_size;
mspring_solver solver;
mspring_integrator integrator;
mspring_guard guard;
uint32_t substeps;
uint32_t max_substeps;
double substep_length;
float gravity_x;
float gravity_y;
float global_damping;
float max_speed;
float sleep_speed;
float sleep_time;
float relax_fraction;
float residual;
uint32_t iterations;
uint32_t tile_size;
uint32_t coarse_period;
uint32_t most_work;
} mspring_settings;
typedef enum mspring_network_flags { MSPRING_NETWORK_RESERVE_DAMPING = 1 << 0, MSPRING_NETWORK_RESERVE_RELATIVE = 1 << 1, MSPRING_NETWORK_PRECISE = 1 << 2, MSPRING_NETWORK_POSES = 1 << 3
} mspring_network_flags;
typedef struct mspring_network_def {
uint32_t struct_size;
uint32_t flags;
mspring_simd simd_level;
uint32_t worker_count;
uint32_t spare_particles;
uint32_t spare_springs;
const mspring_allocator *allocator;
const mspring_tasks *tasks;
const void *reserved_pointers[2];
uint32_t reserved[4];
mspring_settings settings;
} mspring_network_def;
typedef struct mspring_builder mspring_builder;
typedef struct mspring_network mspring_network;
mspring_result mspring_builder_create(
const mspring_allocator *allocator, mspring_builder **builder);
void mspring_builder_destroy(mspring_builder *builder);
const char *mspring_builder_error(const mspring_builder *builder);
void mspring_builder_forget_error(mspring_builder *builder);
uint32_t mspring_builder_count(const mspring_builder *builder, mspring_kind kind);
mspring_result mspring_builder_add_particles(
mspring_builder *builder, const mspring_particle_def *defs, uint32_t count, mspring_id *first_id);
mspring_result mspring_builder_add_springs(
mspring_builder *builder, const mspring_spring_def *defs, uint32_t count, mspring_id *first_id);
mspring_result mspring_builder_add_lattice(
mspring_builder *builder, const mspring_lattice_def *def, mspring_id *cell_ids);
mspring_result mspring_builder_add_rope(
mspring_builder *builder, const mspring_rope_def *def, mspring_id *particles, mspring_id *first_spring);
mspring_result mspring_builder_add_mesh(
mspring_builder *builder, const mspring_mesh_def *def, mspring_id *first_particle, mspring_id *first_spring);
mspring_result mspring_builder_add_disc(
mspring_builder *builder, const mspring_disc_def *def, mspring_id *first_particle, mspring_id *first_spring);
mspring_result mspring_builder_add_copies(mspring_builder *builder,
const mspring_builder *from, uint32_t count, const double *x, const double *y, uint32_t stride,
mspring_id *first_particle, mspring_id *first_spring);
mspring_result mspring_builder_add_network(mspring_builder *builder,
const mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, mspring_id *particle_ids,
mspring_id *spring_ids);
mspring_result mspring_builder_get_particles(mspring_builder *builder,
const mspring_id *ids, mspring_id first, uint32_t count, mspring_particle_def *defs);
mspring_result mspring_builder_get_springs(mspring_builder *builder,
const mspring_id *ids, mspring_id first, uint32_t count, mspring_spring_def *defs);
mspring_result mspring_builder_read(
mspring_builder *builder, const void *archive, size_t size, uint32_t *skipped);
mspring_result mspring_builder_get_network_def(
mspring_builder *builder, mspring_network_def *def);
mspring_result mspring_network_create(
mspring_builder *builder, const mspring_network_def *def, mspring_network **network);
void mspring_network_destroy(mspring_network *network);
const char *mspring_network_error(const mspring_network *network);
uint32_t mspring_network_count(const mspring_network *network, mspring_kind kind);
typedef struct mspring_clone_def {
uint32_t struct_size;
uint32_t copy_hooks;
const mspring_allocator *allocator;
const mspring_tasks *tasks;
uint32_t worker_count;
uint32_t reserved;
} mspring_clone_def;
mspring_result mspring_network_clone(
const mspring_network *network, const mspring_clone_def *def, mspring_network **clone);
typedef struct mspring_network_info {
uint32_t struct_size;
mspring_simd simd_level;
uint32_t worker_count;
uint32_t busy_workers;
uint32_t lattice_springs;
uint32_t chain_springs;
uint32_t irregular_springs;
uint32_t particle_room;
uint32_t spring_room;
uint32_t reserved;
uint64_t memory_used;
} mspring_network_info;
mspring_result mspring_network_get_info(
const mspring_network *network, mspring_network_info *info);
mspring_result mspring_network_get_settings(
const mspring_network *network, mspring_settings *settings);
mspring_result mspring_network_set_settings(
mspring_network *network, const mspring_settings *settings);
mspring_result mspring_network_step(mspring_network *network, double dt);
typedef enum mspring_step_flags { MSPRING_STEP_FALLBACK = 1 << 0, MSPRING_STEP_CLAMPED = 1 << 1, MSPRING_STEP_PUT_BACK = 1 << 2, MSPRING_STEP_RETRIED = 1 << 3, MSPRING_STEP_ASLEEP = 1 << 4, MSPRING_STEP_FEWER = 1 << 5, MSPRING_STEP_GREW = 1 << 6
} mspring_step_flags;
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
double time_left;
double work;
uint32_t is_asleep;
uint32_t reserved;
} mspring_step_info;
mspring_result mspring_network_get_step_info(
const mspring_network *network, mspring_step_info *info);
mspring_result mspring_network_wake(mspring_network *network);
mspring_result mspring_network_apply_force(
mspring_network *network, mspring_id particle, float x, float y);
typedef enum mspring_push { MSPRING_PUSH_STEP = 0, MSPRING_PUSH_SUBSTEP = 1, MSPRING_PUSH_IMPULSE = 2, MSPRING_PUSH_INT = -2147483648
} mspring_push;
mspring_result mspring_network_apply_forces(mspring_network *network,
mspring_push push, const mspring_id *ids, mspring_id first, uint32_t count, const float *x, const float *y,
uint32_t stride);
mspring_result mspring_network_apply_torque(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, float torque);
mspring_result mspring_network_get_positions(const mspring_network *network,
const mspring_id *ids, mspring_id first, uint32_t count, double *x, double *y, uint32_t stride);
mspring_result mspring_network_set_positions(mspring_network *network,
const mspring_id *ids, mspring_id first, uint32_t count, const double *x, const double *y, uint32_t stride);
mspring_result mspring_network_get_velocities(const mspring_network *network,
const mspring_id *ids, mspring_id first, uint32_t count, float *vx, float *vy, uint32_t stride);
mspring_result mspring_network_set_velocities(mspring_network *network,
const mspring_id *ids, mspring_id first, uint32_t count, const float *vx, const float *vy, uint32_t stride);
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
mspring_result mspring_network_get_view(const mspring_network *network, mspring_view *view);
mspring_result mspring_network_get_state_hash(const mspring_network *network, uint64_t *hash);
typedef enum mspring_property { MSPRING_MASS = 0x000, MSPRING_INVERSE_MASS_SCALE = 0x001, MSPRING_X = 0x002, MSPRING_Y = 0x003, MSPRING_VX = 0x004, MSPRING_VY = 0x005, MSPRING_FRICTION = 0x006, MSPRING_RESTITUTION = 0x007, MSPRING_FLOOR_IMPULSE_X = 0x008, MSPRING_FLOOR_IMPULSE_Y = 0x009, MSPRING_TOUCH = 0x00a, MSPRING_RELATIVE_X = 0x00b, MSPRING_RELATIVE_Y = 0x00c, MSPRING_RELATIVE_VX = 0x00d, MSPRING_RELATIVE_VY = 0x00e, MSPRING_PARTICLE_FLAGS = 0x080, MSPRING_LAYERS = 0x081, MSPRING_MASKS = 0x082, MSPRING_COMPONENT = 0x083, MSPRING_SLOT = 0x084, MSPRING_STIFFNESS = 0x100, MSPRING_DAMPING = 0x101, MSPRING_REST_LENGTH = 0x102, MSPRING_BREAK_STRAIN = 0x103, MSPRING_WARN_STRAIN = 0x104, MSPRING_RELAX_STRAIN = 0x105, MSPRING_YIELD_STRAIN = 0x106, MSPRING_HARDENING = 0x107, MSPRING_PLASTIC_LIMIT = 0x108, MSPRING_PLASTIC_STRAIN = 0x109, MSPRING_LENGTH = 0x110, MSPRING_DIRECTION_X = 0x111, MSPRING_DIRECTION_Y = 0x112, MSPRING_STRAIN = 0x113, MSPRING_TENSION = 0x114, MSPRING_ACTIVE_STIFFNESS = 0x115, MSPRING_ACTIVE_DAMPING = 0x116, MSPRING_ACTIVE_REST_LENGTH = 0x117, MSPRING_SPRING_FLAGS = 0x180, MSPRING_END_A = 0x181, MSPRING_END_B = 0x182, MSPRING_SLOT_A = 0x183, MSPRING_SLOT_B = 0x184, MSPRING_ELEMENT_STIFFNESS = 0x200, MSPRING_ELEMENT_DAMPING = 0x201, MSPRING_PRESSURE = 0x202, MSPRING_FILL = 0x203, MSPRING_REST_AREA = 0x204, MSPRING_REST_ANGLE = 0x205, MSPRING_AREA = 0x210, MSPRING_ACTIVE_PRESSURE = 0x211, MSPRING_ANGLE = 0x212, MSPRING_TORQUE = 0x213, MSPRING_ELEMENT_ENERGY = 0x214, MSPRING_ELEMENT_FLAGS = 0x280, MSPRING_GROUP_X = 0x300, MSPRING_GROUP_Y = 0x301, MSPRING_GROUP_VX = 0x302, MSPRING_GROUP_VY = 0x303, MSPRING_GROUP_MIN_X = 0x304, MSPRING_GROUP_MIN_Y = 0x305, MSPRING_GROUP_MAX_X = 0x306, MSPRING_GROUP_MAX_Y = 0x307, MSPRING_GROUP_FLAGS = 0x380, MSPRING_SIGNAL = 0x400, MSPRING_ACTUATOR_SPRING = 0x480, MSPRING_PROPERTY_INT = -2147483648
} mspring_property;
mspring_result mspring_network_get(const mspring_network *network, mspring_property property,
const mspring_id *ids, mspring_id first, uint32_t count, float *values, uint32_t stride);
mspring_result mspring_network_set(mspring_network *network,
mspring_property property, const mspring_id *ids, mspring_id first, uint32_t count, const float *values,
uint32_t stride);
mspring_result mspring_network_get_integers(const mspring_network *network,
mspring_property property, const mspring_id *ids, mspring_id first, uint32_t count, uint32_t *values,
uint32_t stride);
mspring_result mspring_network_set_integers(mspring_network *network,
mspring_property property, const mspring_id *ids, mspring_id first, uint32_t count, const uint32_t *values,
uint32_t stride);
typedef struct mspring_column {
mspring_property property;
uint32_t stride;
void *values;
} mspring_column;
mspring_result mspring_network_get_columns(const mspring_network *network,
const mspring_id *ids, mspring_id first, uint32_t count, const mspring_column *columns, uint32_t column_count);
mspring_result mspring_network_break_springs(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);
mspring_result mspring_network_restore_springs(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count, double ramp_seconds);
mspring_result mspring_network_detach_particles(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);
mspring_result mspring_network_add_particles(
mspring_network *network, const mspring_particle_def *defs, uint32_t count, mspring_id *ids);
mspring_result mspring_network_add_springs(
mspring_network *network, const mspring_spring_def *defs, uint32_t count, mspring_id *ids);
mspring_result mspring_network_remove_particles(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);
mspring_result mspring_network_remove_springs(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);
mspring_result mspring_network_reuse_ids(mspring_network *network);
mspring_result mspring_network_compact(mspring_network *network);
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
mspring_result mspring_network_get_body(const mspring_network *network, const mspring_id *ids,
mspring_id first, uint32_t count, mspring_body *body);
mspring_result mspring_network_get_components(
const mspring_network *network, uint32_t first, uint32_t count, mspring_body *bodies);
typedef struct mspring_energy {
uint32_t struct_size;
uint32_t bent_springs;
double kinetic;
double elastic;
double potential;
double dissipated;
uint64_t yield_count;
double largest_speed;
mspring_id fastest;
mspring_id strained;
double largest_strain;
} mspring_energy;
mspring_result mspring_network_get_energy(
const mspring_network *network, mspring_energy *energy);
mspring_result mspring_network_get_stable_dt(
mspring_network *network, double *now, double *any_shape);
mspring_result mspring_network_suggest_substeps(
mspring_network *network, double dt, double safety, uint32_t *substeps);
typedef enum mspring_find_flags { MSPRING_FIND_WHOLE = 1 << 0, MSPRING_FIND_BROKEN = 1 << 1
} mspring_find_flags;
mspring_result mspring_network_nearest_particle(
const mspring_network *network, double x, double y, double within, mspring_id *particle, double *distance);
mspring_result mspring_network_nearest_spring(const mspring_network *network, double x,
double y, double within, uint32_t flags, mspring_id *spring, double *fraction, double *distance);
mspring_result mspring_network_particles_in_circle(const mspring_network *network, double x,
double y, double radius, mspring_id *particles, uint32_t capacity, uint32_t *count);
mspring_result mspring_network_particles_in_box(const mspring_network *network, double min_x,
double min_y, double max_x, double max_y, mspring_id *particles, uint32_t capacity, uint32_t *count);
mspring_result mspring_network_springs_in_circle(const mspring_network *network, double x,
double y, double radius, uint32_t flags, mspring_id *springs, uint32_t capacity, uint32_t *count);
mspring_result mspring_network_springs_across(const mspring_network *network, double from_x,
double from_y, double to_x, double to_y, uint32_t flags, mspring_id *springs, double *fractions, uint32_t capacity,
uint32_t *count);
typedef enum mspring_phase { MSPRING_PHASE_BEFORE_STEP = 0, MSPRING_PHASE_BEFORE_SUBSTEP = 1, MSPRING_PHASE_AFTER_SUBSTEP = 2, MSPRING_PHASE_INT = -2147483648
} mspring_phase;
typedef struct mspring_hook_args {
uint32_t struct_size;
mspring_phase phase;
uint32_t substep, substep_count;
uint32_t run_count;
uint32_t worker;
uint32_t first_slot, slot_count;
double dt;
double origin_x, origin_y;
float *x, *y, *vx, *vy;
float *force_x, *force_y;
const float *inverse_mass;
const uint32_t *particle_of_slot, *slot_of_particle;
const mspring_network *network;
void *storage;
mspring_result *result;
} mspring_hook_args;
typedef void(*mspring_hook_fn)(const mspring_hook_args *args, void *user);
typedef enum mspring_hook_flags { MSPRING_HOOK_CONCURRENT = 1 << 0, MSPRING_HOOK_BELOW = 1 << 1
} mspring_hook_flags;
typedef struct mspring_hook_def {
uint32_t struct_size;
mspring_phase phase;
mspring_hook_fn fn;
void *user;
void(*release)(void *user);
void *(*retain)(void *user);
uint32_t period;
uint32_t flags;
uint32_t range_slots;
uint32_t reserved;
void *storage;
size_t storage_stride;
double below_y;
} mspring_hook_def;
mspring_result mspring_network_add_hook(
mspring_network *network, const mspring_hook_def *def, mspring_id *hook);
mspring_result mspring_network_remove_hook(
mspring_network *network, mspring_id hook);
typedef enum mspring_snapshot_contents { MSPRING_SNAPSHOT_ALL = 0, MSPRING_SNAPSHOT_FRAME = 1, MSPRING_SNAPSHOT_CONTENTS_INT = -2147483648
} mspring_snapshot_contents;
mspring_result mspring_network_get_snapshot_size(
const mspring_network *network, mspring_snapshot_contents contents, size_t *size);
mspring_result mspring_network_save(
const mspring_network *network, mspring_snapshot_contents contents, void *snapshot, size_t capacity, size_t *size);
mspring_result mspring_network_load(
mspring_network *network, const void *snapshot, size_t size);
typedef mspring_result(*mspring_write_fn)(const void *bytes, size_t size, void *user);
mspring_result mspring_network_write(
const mspring_network *network, mspring_write_fn write, void *user);
typedef enum mspring_group_flags { MSPRING_GROUP_HELD = 1 << 0
} mspring_group_flags;
mspring_result mspring_network_set_groups(
mspring_network *network, const mspring_id *firsts, uint32_t count);
mspring_result mspring_network_mark_groups(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);
typedef enum mspring_reset { MSPRING_RESET_START = 0, MSPRING_RESET_MARK = 1, MSPRING_RESET_INT = -2147483648
} mspring_reset;
mspring_result mspring_network_reset_groups(
mspring_network *network, mspring_reset to, const mspring_id *ids, mspring_id first, uint32_t count);
typedef struct mspring_observation {
mspring_property property;
uint32_t index;
} mspring_observation;
mspring_result mspring_network_observe_groups(const mspring_network *network,
const mspring_id *ids, mspring_id first, uint32_t count, const mspring_observation *columns, uint32_t column_count,
double *rows, uint32_t stride);
mspring_result mspring_network_set_actuators(
mspring_network *network, const mspring_id *springs, uint32_t count, uint32_t changes);
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
const float *silt_depths;
const void *reserved_pointer;
} mspring_floor_def;
mspring_result mspring_network_set_floor(
mspring_network *network, const mspring_floor_def *def);
mspring_result mspring_network_get_floor(
const mspring_network *network, mspring_floor_def *def);
typedef enum mspring_contact_flags { MSPRING_CONTACT_SELF = 1 << 0
} mspring_contact_flags;
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
uint32_t event_capacity;
uint32_t reserved;
} mspring_contact_def;
mspring_result mspring_network_set_contact(
mspring_network *network, const mspring_contact_def *def);
mspring_result mspring_network_get_contact(
const mspring_network *network, mspring_contact_def *def);
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
mspring_result mspring_network_read_contact_events(
mspring_network *network, mspring_contact_event *events, uint32_t capacity, uint32_t *count, uint64_t *lost);
typedef enum mspring_collider_kind { MSPRING_COLLIDER_CHAIN = 0, MSPRING_COLLIDER_BOX = 1, MSPRING_COLLIDER_CIRCLE = 2, MSPRING_COLLIDER_INT = -2147483648
} mspring_collider_kind;
typedef enum mspring_collider_flags { MSPRING_COLLIDER_CLOSED = 1 << 0
} mspring_collider_flags;
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
uint32_t layers, masks;
} mspring_collider_def;
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
mspring_result mspring_builder_add_strain_limits(mspring_builder *builder,
const mspring_id *ids, mspring_id first, uint32_t count, float strain, float stiffening, mspring_id *first_limit);
typedef enum mspring_settle_flags { MSPRING_SETTLE_LEAVE_FLOATING = 1 << 0
} mspring_settle_flags;
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
mspring_result mspring_network_settle(
mspring_network *network, const mspring_settle_def *def, mspring_settle_result *result);
typedef enum mspring_tune_measure { MSPRING_TUNE_BY_TRAJECTORY = 0, MSPRING_TUNE_BY_REST = 1, MSPRING_TUNE_BY_BENDING = 2, MSPRING_TUNE_BY_SCENE = 3, MSPRING_TUNE_MEASURE_INT = -2147483648
} mspring_tune_measure;
typedef enum mspring_tune_flags { MSPRING_TUNE_NOTHING_ELSE = 1 << 0
} mspring_tune_flags;
typedef uint32_t(*mspring_progress_fn)(double done, void *user);
typedef double(*mspring_clock_fn)(void *user);
typedef enum mspring_tune_scene_flags { MSPRING_TUNE_SCENE_FLOOR = 1 << 0, MSPRING_TUNE_SCENE_BREAKING = 1 << 1, MSPRING_TUNE_SCENE_HOOKS = 1 << 2
} mspring_tune_scene_flags;
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
const mspring_settings *settings;
mspring_clock_fn clock;
mspring_progress_fn progress;
void *user;
const mspring_tune_scene *scene;
void *reserved_pointer;
} mspring_tune_def;
typedef enum mspring_tune_row_flags { MSPRING_TUNE_HAS_COST = 1 << 0, MSPRING_TUNE_HAS_TRAJECTORY = 1 << 1, MSPRING_TUNE_HAS_REST = 1 << 2, MSPRING_TUNE_REJECTED = 1 << 3, MSPRING_TUNE_PARETO = 1 << 4, MSPRING_TUNE_RECOMMENDED = 1 << 5, MSPRING_TUNE_HAS_SCENE = 1 << 6, MSPRING_TUNE_CHAOTIC = 1 << 7
} mspring_tune_row_flags;
typedef enum mspring_tune_quantity { MSPRING_TUNE_BROKEN = 0, MSPRING_TUNE_ENERGY = 1, MSPRING_TUNE_EXTENT = 2
} mspring_tune_quantity;
typedef struct mspring_tune_row {
uint32_t struct_size;
uint32_t flags;
uint32_t setting;
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
double trajectory_spread;
mspring_settings settings;
} mspring_tune_row;
mspring_result mspring_tune_settings(
mspring_network *network, double dt, mspring_settings *settings, uint32_t capacity, uint32_t *count);
mspring_result mspring_network_tune(
mspring_network *network, const mspring_tune_def *def, mspring_tune_row *rows, uint32_t capacity, uint32_t *count);
mspring_result mspring_network_describe(
const mspring_network *network, char *text, size_t capacity, size_t *size);
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
typedef enum mspring_element_flags { MSPRING_ELEMENT_AREA = 1 << 0, MSPRING_ELEMENT_ANGLE = 1 << 1, MSPRING_ELEMENT_OPEN = 1 << 2, MSPRING_ELEMENT_REMOVED = 1 << 10
} mspring_element_flags;
typedef enum mspring_area_kind { MSPRING_AREA_ELASTIC = 0, MSPRING_AREA_GAS = 1, MSPRING_AREA_INT = -2147483648
} mspring_area_kind;
typedef struct mspring_area_def {
uint32_t struct_size;
mspring_area_kind kind;
float stiffness;
float pressure;
float fill;
float rest_area;
} mspring_area_def;
mspring_result mspring_network_add_area(mspring_network *network,
const mspring_area_def *def, const mspring_id *particles, uint32_t count, mspring_id *element);
mspring_result mspring_network_add_cell_areas(
mspring_network *network, const mspring_area_def *def, mspring_id *first_element, uint32_t *count);
typedef struct mspring_angle_def {
uint32_t struct_size;
float stiffness;
float damping;
float rest_angle;
} mspring_angle_def;
mspring_result mspring_network_add_angles(mspring_network *network,
const mspring_angle_def *def, const mspring_id *particles, uint32_t count, uint32_t stride,
mspring_id *first_element);
mspring_result mspring_network_remove_elements(
mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);
mspring_result mspring_network_get_element_particles(const mspring_network *network,
mspring_id element, mspring_id *particles, uint32_t capacity, uint32_t *count);
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
]]
return {
  VERSION_MAJOR = 0,
  VERSION_MINOR = 3,
  VERSION_PATCH = 0,
  VERSION = 3000,
  NONE = 4294967295,
  ALL = 4294967295,
  MAX_PARTICLES = 67108864,
  MAX_SPRINGS = 268435456,
  MAX_COORDINATE = 1000000000000.0,
  MAX_SPEED = 1000000000000000.0,
  MAX_WORKERS = 256,
  NEVER = 3.4028234663852886e+38,
  RELAX_STRAIN_DEFAULT = -1.0,
  REST_LENGTH_DISTANCE = -1.0,
  HARDENING_DEFAULT = 0.1,
  PLASTIC_LIMIT_DEFAULT = 0.5,
  CELL_EMPTY = 65535,
  MAX_SUBSTEPS = 1000000,
  SUBSTEPS_AUTO = 4294967295,
  SUBSTEPS_EVEN = 4294967294,
  MAX_PLANES = 8,
  MAX_HEIGHTS = 67108864,
  MAX_COLLIDER_POINTS = 65536,
  MAX_GRIPS = 16,
  TUNE_QUANTITIES = 3,
  MAX_AREA_PARTICLES = 4096,
  REST_ANGLE_PRESENT = 3.4028234663852886e+38,
  MAX_GRADIENT_STEPS = 16777216,
}
