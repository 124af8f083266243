/// Defaults of all public definitions, and the table of all public structs.
#include <math.h>

#include "base/definitions.h"
#include "base/structs.h"

// Springs that never break, yield or count as stressed.
#define NO_LIMITS                                                                                                  \
    .break_strain = MSPRING_NEVER, .warn_strain = MSPRING_NEVER, .relax_strain = MSPRING_RELAX_STRAIN_DEFAULT,     \
    .yield_strain = MSPRING_NEVER, .hardening = MSPRING_HARDENING_DEFAULT,                                         \
    .plastic_limit = MSPRING_PLASTIC_LIMIT_DEFAULT

#define SETTINGS                                                                                                   \
    .struct_size = sizeof(mspring_settings), .solver = MSPRING_SOLVER_EXPLICIT, .guard = MSPRING_GUARD_CLAMP,      \
    .substeps = MSPRING_SUBSTEPS_AUTO, .max_substeps = 1000, .most_work = MSPRINGI_MOST_WORK,                      \
    .residual = MSPRINGI_RESIDUAL

static const mspring_allocator default_allocator = {0};
static const mspring_tasks default_tasks = {.worker_count = 1, .concurrent_count = 1};
static const mspring_particle_def default_particle_def = {.mass = 1.0f};
static const mspring_spring_def default_spring_def = {
    .a = MSPRING_NONE, .b = MSPRING_NONE, .rest_length = MSPRING_REST_LENGTH_DISTANCE, NO_LIMITS};
static const mspring_material default_material = {.mass = 1.0f, NO_LIMITS};
static const mspring_lattice_def default_lattice_def = {.material_count = 1, .spacing = 1.0, .shear_share = 1.0f};
static const mspring_rope_def default_rope_def = {
    .from = MSPRING_NONE, .to = MSPRING_NONE, .segment_count = 1, .length_ratio = 1.0f};
static const mspring_mesh_def default_mesh_def = {0};
static const mspring_disc_def default_disc_def = {.ring_count = 1, .radius = 1.0};
static const mspring_settings default_settings = {
#define SETTING(name, first, range, is_good, change) .name = first,
#include "base/settings.def"
    SETTINGS};
static const mspring_network_def default_network_def = {
    .simd_level = MSPRING_SIMD_AUTO,
    .worker_count = 1,
    .settings =
        {
#define SETTING(name, first, range, is_good, change) .name = first,
#include "base/settings.def"
            SETTINGS},
};
static const mspring_clone_def default_clone_def = {.worker_count = 1};
static const mspring_hook_def default_hook_def = {.phase = MSPRING_PHASE_BEFORE_STEP, .period = 1};
static const mspring_floor_def default_floor_def = {.spacing = 1.0};
static const mspring_contact_def default_contact_def = {
    .flags = MSPRING_CONTACT_SELF, .push_speed = -1.0f, .sweeps = 4};
static const mspring_grip_def default_grip_def = {.particle = MSPRING_NONE, .max_force = MSPRING_NEVER};
static const mspring_collider_def default_collider_def = {
    .kind = MSPRING_COLLIDER_CHAIN, .width = 1.0, .height = 1.0, .layers = 1, .masks = UINT32_MAX};
MSPRINGI_LAWS(static const mspring_area_def default_area_def = {.kind = MSPRING_AREA_ELASTIC, .fill = 1.0f};
              static const mspring_angle_def default_angle_def = {.rest_angle = MSPRING_REST_ANGLE_PRESENT};)
MSPRINGI_LAB(static const mspring_settle_def default_settle_def = {.max_iterations = 1000, .tolerance = 1e-9};
             static const mspring_tune_scene default_tune_scene = {.flags = MSPRING_TUNE_SCENE_FLOOR |
                                                                            MSPRING_TUNE_SCENE_BREAKING,
                                                                   .start_count = 16,
                                                                   .duration = 1.0,
                                                                   .kick = 0.1,
                                                                   .tolerance = 0.05,
                                                                   .max_distance = 1.0};
             static const mspring_tune_def default_tune_def = {.dt = 1.0 / 64,
                                                               .budget = 10.0,
                                                               .measure = MSPRING_TUNE_BY_TRAJECTORY,
                                                               .max_error = 0.01,
                                                               .max_cost = INFINITY,
                                                               .max_drift = 0.1};)

#define STRUCT(name, on_64_bits, on_32_bits, settings, defaults)                                                   \
    const mspringi_struct mspringi_struct_##name = {"mspring_" #name,                                              \
                                                    sizeof(void *) == 4 ? (on_32_bits) : (on_64_bits),             \
                                                    sizeof(mspring_##name), settings, defaults};                   \
    _Static_assert(sizeof(mspring_##name) >= (sizeof(void *) == 4 ? (on_32_bits) : (on_64_bits)) &&                \
                       sizeof(mspring_##name) % sizeof(uint32_t) == 0 &&                                           \
                       sizeof(mspring_##name) <= MSPRINGI_LARGEST_STRUCT,                                          \
                   "a struct only grows, by whole words");
#define INPUT_STRUCT(name, KIND, on_64_bits, on_32_bits, settings)                                                 \
    STRUCT(name, on_64_bits, on_32_bits, settings, &default_##name)
#define OUTPUT_STRUCT(name, KIND, on_64_bits, on_32_bits, settings)                                                \
    STRUCT(name, on_64_bits, on_32_bits, settings, NULL)
#include "base/structs.def"
