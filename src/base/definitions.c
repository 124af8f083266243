/// Defaults of all public definitions.
#include <math.h>

#include <massspring/massspring_contact.h>
#include <massspring/massspring_laws.h>
#include <massspring/massspring_tools.h>

#include "base/definitions.h"
#include "base/message.h"

// Springs that never break, yield or count as stressed.
#define NO_LIMITS                                                                                                  \
    .break_strain = MSPRING_NEVER, .stress_strain = MSPRING_NEVER, .relax_strain = MSPRING_RELAX_STRAIN_DEFAULT,   \
    .yield_strain = MSPRING_NEVER, .hardening = MSPRING_HARDENING_DEFAULT,                                         \
    .plastic_limit = MSPRING_PLASTIC_LIMIT_DEFAULT

mspring_result mspring_allocator_init(mspring_allocator *allocator, size_t size) {
    const mspring_allocator defaults = {.struct_size = sizeof defaults};
    return mspringi_init_struct(allocator, size, &defaults, sizeof defaults);
}

mspring_result mspring_tasks_init(mspring_tasks *tasks, size_t size) {
    const mspring_tasks defaults = {.struct_size = sizeof defaults, .worker_count = 1, .concurrent_count = 1};
    return mspringi_init_struct(tasks, size, &defaults, sizeof defaults);
}

mspring_result mspring_particle_def_init(mspring_particle_def *def, size_t size) {
    const mspring_particle_def defaults = {.struct_size = sizeof defaults, .mass = 1.0f};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_spring_def_init(mspring_spring_def *def, size_t size) {
    const mspring_spring_def defaults = {.struct_size = sizeof defaults,
                                         .a = MSPRING_NONE,
                                         .b = MSPRING_NONE,
                                         .rest_length = MSPRING_REST_LENGTH_DISTANCE,
                                         NO_LIMITS};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_material_init(mspring_material *material, size_t size) {
    const mspring_material defaults = {.struct_size = sizeof defaults, .mass = 1.0f, NO_LIMITS};
    return mspringi_init_struct(material, size, &defaults, sizeof defaults);
}

mspring_result mspring_lattice_def_init(mspring_lattice_def *def, size_t size) {
    const mspring_lattice_def defaults = {.struct_size = sizeof defaults, .spacing = 1.0, .shear_share = 1.0f};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_rope_def_init(mspring_rope_def *def, size_t size) {
    const mspring_rope_def defaults = {.struct_size = sizeof defaults,
                                       .from = MSPRING_NONE,
                                       .to = MSPRING_NONE,
                                       .segment_count = 1,
                                       .mass = 1.0f,
                                       .slack = 1.0f,
                                       NO_LIMITS};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_mesh_def_init(mspring_mesh_def *def, size_t size) {
    const mspring_mesh_def defaults = {.struct_size = sizeof defaults, .area_density = 1.0f, NO_LIMITS};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_disc_def_init(mspring_disc_def *def, size_t size) {
    const mspring_disc_def defaults = {
        .struct_size = sizeof defaults, .ring_count = 1, .radius = 1.0, .area_density = 1.0f, NO_LIMITS};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_hook_def_init(mspring_hook_def *def, size_t size) {
    const mspring_hook_def defaults = {
        .struct_size = sizeof defaults, .phase = MSPRING_PHASE_BEFORE_STEP, .period = 1};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_floor_def_init(mspring_floor_def *def, size_t size) {
    const mspring_floor_def defaults = {.struct_size = sizeof defaults, .spacing = 1.0};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_contact_def_init(mspring_contact_def *def, size_t size) {
    const mspring_contact_def defaults = {
        .struct_size = sizeof defaults, .flags = MSPRING_CONTACT_SELF, .push_speed = 3.0f, .sweeps = 4};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_area_def_init(mspring_area_def *def, size_t size) {
    const mspring_area_def defaults = {.struct_size = sizeof defaults, .kind = MSPRING_AREA_ELASTIC, .fill = 1.0f};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_angle_def_init(mspring_angle_def *def, size_t size) {
    const mspring_angle_def defaults = {.struct_size = sizeof defaults};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_grip_def_init(mspring_grip_def *def, size_t size) {
    const mspring_grip_def defaults = {
        .struct_size = sizeof defaults, .particle = MSPRING_NONE, .max_force = MSPRING_NEVER};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_collider_def_init(mspring_collider_def *def, size_t size) {
    const mspring_collider_def defaults = {.struct_size = sizeof defaults,
                                           .kind = MSPRING_COLLIDER_CHAIN,
                                           .width = 1.0,
                                           .height = 1.0,
                                           .groups = 1,
                                           .masks = UINT32_MAX};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_solver_def_init(mspring_solver_def *def, size_t size) {
    mspring_network_def network;
    (void)mspring_network_def_init(&network, sizeof network);
    const mspring_solver_def defaults = mspringi_solver_of(&network);
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_network_def_init(mspring_network_def *def, size_t size) {
    const mspring_network_def defaults = {.struct_size = sizeof defaults,
                                          .simd_level = MSPRING_SIMD_AUTO,
                                          .gravity_y = -9.8f,
                                          .max_speed = 1e6f,
                                          .solver = MSPRING_SOLVER_EXPLICIT,
                                          .substeps = MSPRING_SUBSTEPS_AUTO,
                                          .worker_count = 1,
                                          .max_substeps = 1000,
                                          .guard = MSPRING_GUARD_CLAMP,
                                          .sleep_time = 0.5f,
                                          .relax_fraction = 0.8f};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_settings_init(mspring_settings *settings, size_t size) {
    mspring_network_def def;
    (void)mspring_network_def_init(&def, sizeof def);
    const mspring_settings defaults = mspringi_settings_of(&def);
    return mspringi_init_struct(settings, size, &defaults, sizeof defaults);
}

mspring_result mspring_clone_def_init(mspring_clone_def *def, size_t size) {
    const mspring_clone_def defaults = {.struct_size = sizeof defaults, .worker_count = 1};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_settle_def_init(mspring_settle_def *def, size_t size) {
    const mspring_settle_def defaults = {.struct_size = sizeof defaults, .max_iterations = 1000, .tolerance = 1e-9};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}

mspring_result mspring_tune_scene_init(mspring_tune_scene *scene, size_t size) {
    const mspring_tune_scene defaults = {.struct_size = sizeof defaults,
                                         .flags = MSPRING_TUNE_SCENE_FLOOR | MSPRING_TUNE_SCENE_BREAKING,
                                         .start_count = 16,
                                         .duration = 1.0,
                                         .kick = 0.1,
                                         .tolerance = 0.05,
                                         .max_distance = 1.0};
    return mspringi_init_struct(scene, size, &defaults, sizeof defaults);
}

mspring_result mspring_tune_def_init(mspring_tune_def *def, size_t size) {
    const mspring_tune_def defaults = {.struct_size = sizeof defaults,
                                       .dt = 1.0 / 64,
                                       .budget = 10.0,
                                       .measure = MSPRING_TUNE_BY_TRAJECTORY,
                                       .max_error = 0.01,
                                       .max_cost = INFINITY,
                                       .max_drift = 0.1};
    return mspringi_init_struct(def, size, &defaults, sizeof defaults);
}
