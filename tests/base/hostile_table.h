/// @file hostile_table.h
/// The calls of test_hostile: part of hostile.c, which has the functions named here.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_HOSTILE_TABLE_H
#define TEST_HOSTILE_TABLE_H

/// Defaults of a struct.
#define INIT(X, KIND, type)                                                                                     \
    X(mspring_init__##type, "Z0", a->size = sizeof(mspring_##type),                                             \
      mspring_init(MSPRING_STRUCT_##KIND, a->out[0], a->size))

/// Setting and reading a property, whose values are refused where floats is F: name is what follows in the table's.
#define PROPERTY(X, name, property, floats)                                                                     \
    X(mspring_network_set__range##name, "NKR" floats, a->kind = property,                                       \
      mspring_network_set(a->network, a->kind, NULL, a->first, a->count, a->f, 1))                              \
    X(mspring_network_set__list##name, "NKa" floats, a->kind = property,                                        \
      mspring_network_set(a->network, a->kind, a->ids, 0, a->count, a->f, 1))                                   \
    MEASURED(X, name, property)
#define MEASURED(X, name, property)                                                                             \
    X(mspring_network_get__range##name, "nKR0", a->kind = property,                                             \
      mspring_network_get(a->network, a->kind, NULL, a->first, a->count, a->out[0], 1))                         \
    X(mspring_network_get__list##name, "nKa0", a->kind = property,                                              \
      mspring_network_get(a->network, a->kind, a->ids, 0, a->count, a->out[0], 1))

/// Name, kinds of arguments, what makes the struct given, the call. A function that is called in several ways has a
/// word behind "__" for each.
#define FUNCTIONS(X)                                                                                            \
    X(mspring_init, "k", NOTHING, (note_size((size_t)mspring_init((mspring_struct)a->kind, a->out[0], 0)), MSPRING_OK))\
    INIT(X, PARTICLE_DEF, particle_def)                                                                         \
    INIT(X, SPRING_DEF, spring_def)                                                                             \
    INIT(X, MATERIAL, material)                                                                                 \
    INIT(X, LATTICE_DEF, lattice_def)                                                                           \
    INIT(X, ROPE_DEF, rope_def)                                                                                 \
    INIT(X, MESH_DEF, mesh_def)                                                                                 \
    INIT(X, DISC_DEF, disc_def)                                                                                 \
    INIT(X, SETTINGS, settings)                                                                                 \
    INIT(X, NETWORK_DEF, network_def)                                                                           \
    INIT(X, ALLOCATOR, allocator)                                                                               \
    INIT(X, TASKS, tasks)                                                                                       \
    INIT(X, CLONE_DEF, clone_def)                                                                               \
    INIT(X, HOOK_DEF, hook_def)                                                                                 \
    INIT(X, FLOOR_DEF, floor_def)                                                                               \
    INIT(X, CONTACT_DEF, contact_def)                                                                           \
    INIT(X, GRIP_DEF, grip_def)                                                                                 \
    INIT(X, COLLIDER_DEF, collider_def)                                                                         \
    INIT(X, AREA_DEF, area_def)                                                                                 \
    INIT(X, ANGLE_DEF, angle_def)                                                                               \
    INIT(X, SETTLE_DEF, settle_def)                                                                             \
    INIT(X, TUNE_DEF, tune_def)                                                                                 \
    INIT(X, TUNE_SCENE, tune_scene)                                                                             \
    INIT(X, NETWORK_INFO, network_info)                                                                         \
    INIT(X, BODY, body)                                                                                         \
    X(mspring_version, "", NOTHING, note_size(mspring_version()))                                               \
    X(mspring_version_string, "", NOTHING, note_text(mspring_version_string()))                                 \
    X(mspring_features, "", NOTHING, note_size(mspring_features()))                                             \
    X(mspring_result_string, "k", NOTHING, note_text(mspring_result_string(a->kind)))                           \
    X(mspring_builder_create, "s0", make_allocator(a), create_builder(a))                                       \
    X(mspring_builder_destroy, "", NOTHING, destroy_nothing())                                                  \
    X(mspring_builder_error, "v", NOTHING, note_text(support_builder_error(a->builder)))                        \
    X(mspring_builder_forget_error, "v", NOTHING, (mspring_builder_forget_error(a->builder), MSPRING_OK))       \
    X(mspring_builder_count__particles, "v", NOTHING, note_size(mspring_builder_count(a->builder,               \
      MSPRING_PARTICLES)))                                                                                      \
    X(mspring_builder_count__springs, "v", NOTHING, note_size(mspring_builder_count(a->builder,                 \
      MSPRING_SPRINGS)))                                                                                        \
    X(mspring_builder_add_particles__one, "BSWo", FILL(PARTICLE_DEF, particle_def),                             \
      mspring_builder_add_particles(a->builder, a->given, 1, a->out[0]))                                        \
    X(mspring_builder_add_particles, "BSWCo", FILL(PARTICLE_DEF, particle_def),                                 \
      mspring_builder_add_particles(a->builder, a->given, (uint32_t)a->size, a->out[0]))                        \
    X(mspring_builder_add_springs__one, "BSWo", make_spring(a), mspring_builder_add_springs(a->builder,         \
      a->given, 1, a->out[0]))                                                                                  \
    X(mspring_builder_add_springs, "BSWCo", make_spring(a), mspring_builder_add_springs(a->builder, a->given,   \
      (uint32_t)a->size, a->out[0]))                                                                            \
    X(mspring_builder_add_lattice, "BSo", make_lattice(a), mspring_builder_add_lattice(a->builder, a->given,    \
      a->out[0]))                                                                                               \
    X(mspring_builder_add_rope, "BSo", make_rope(a), mspring_builder_add_rope(a->builder, a->given, a->out[0],  \
      a->out[1]))                                                                                               \
    X(mspring_builder_add_mesh, "BSo", make_mesh(a), mspring_builder_add_mesh(a->builder, a->given, a->out[0],  \
      a->out[1]))                                                                                               \
    X(mspring_builder_add_disc, "BSo", make_disc(a), mspring_builder_add_disc(a->builder, a->given, a->out[0],  \
      a->out[1]))                                                                                               \
    X(mspring_material_preset, "PKLT", (OUT_STRUCT(0, material), a->kind = MSPRING_PRESET_WOOD),                \
      mspring_material_preset(a->out[0], a->kind, a->safety, a->dt))                                            \
    X(mspring_builder_get_particles, "BIP", OUT_STRUCT(0, particle_def),                                        \
      mspring_builder_get_particles(a->builder, NULL, a->id, 1, a->out[0]))                                     \
    X(mspring_builder_get_springs, "BIP", OUT_STRUCT(0, spring_def), mspring_builder_get_springs(a->builder,    \
      NULL, a->id, 1, a->out[0]))                                                                               \
    X(mspring_builder_get_particles__range, "BRP", (a->count = 1, OUT_STRUCT(0, particle_def)),                 \
      mspring_builder_get_particles(a->builder, NULL, a->first, a->count, a->out[0]))                           \
    X(mspring_builder_get_springs__list, "BaP", OUT_STRUCT(0, spring_def),                                      \
      mspring_builder_get_springs(a->builder, a->ids, 0, a->count, a->out[0]))                                  \
    X(mspring_builder_read, "B", NOTHING, read_archive(a))                                                      \
    X(mspring_builder_get_network_def, "BP", OUT_STRUCT(0, network_def),                                        \
      mspring_builder_get_network_def(a->builder, a->out[0]))                                                   \
    X(mspring_network_write, "n", NOTHING, mspring_network_write(a->network, count_bytes, &sink))               \
    X(mspring_builder_add_network, "Bno", NOTHING, mspring_builder_add_network(a->builder, a->network, NULL,    \
      0, MSPRING_ALL, a->out[0], a->out[1]))                                                                    \
    X(mspring_builder_add_network__list, "Bnao", NOTHING, mspring_builder_add_network(a->builder, a->network,   \
      a->ids, 0, a->count, a->out[0], a->out[1]))                                                               \
    X(mspring_network_create, "Bs0", FILL(NETWORK_DEF, network_def), create_network(a))                         \
    X(mspring_network_destroy, "", NOTHING, destroy_nothing())                                                  \
    X(mspring_network_clone, "ns0", FILL(CLONE_DEF, clone_def), clone_network(a))                               \
    X(mspring_network_error, "v", NOTHING, note_text(mspring_network_error(a->network)))                        \
    X(mspring_network_count__particles, "v", NOTHING, note_size(mspring_network_count(a->network,               \
      MSPRING_PARTICLES)))                                                                                      \
    X(mspring_network_count__springs, "v", NOTHING, note_size(mspring_network_count(a->network,                 \
      MSPRING_SPRINGS)))                                                                                        \
    X(mspring_network_get_step_info, "nP", OUT_STRUCT(0, step_info), mspring_network_get_step_info(a->network,  \
      a->out[0]))                                                                                               \
    X(mspring_network_get_info, "nP", OUT_STRUCT(0, network_info), mspring_network_get_info(a->network,         \
      a->out[0]))                                                                                               \
    X(mspring_network_describe, "n0", NOTHING, mspring_network_describe(a->network, a->out[0], OUT_BYTES,       \
      a->out[1]))                                                                                               \
    X(mspring_network_get_settings, "nP", OUT_STRUCT(0, settings), mspring_network_get_settings(a->network,     \
      a->out[0]))                                                                                               \
    X(mspring_network_get_floor, "nP", OUT_STRUCT(0, floor_def), mspring_network_get_floor(a->network,          \
      a->out[0]))                                                                                               \
    X(mspring_simd_available, "k", NOTHING, note_size(mspring_simd_available(a->kind)))                         \
    X(mspring_simd_name, "k", NOTHING, note_text(mspring_simd_name(a->kind)))                                   \
    X(mspring_network_set_settings, "NSW", make_settings(a), mspring_network_set_settings(a->network,           \
      a->given))                                                                                                \
    X(mspring_network_step, "NT", NOTHING, mspring_network_step(a->network, a->dt))                             \
    X(mspring_network_get_stable_dt, "No", NOTHING, mspring_network_get_stable_dt(a->network, a->out[0],        \
      a->out[1]))                                                                                               \
    X(mspring_network_suggest_substeps, "NTL0", NOTHING, mspring_network_suggest_substeps(a->network, a->dt,    \
      a->safety, a->out[0]))                                                                                    \
    X(mspring_network_settle, "NsWo", (FILL(SETTLE_DEF, settle_def), OUT_STRUCT(0, settle_result)),             \
      mspring_network_settle(a->network, a->given, a->out[0]))                                                  \
    X(mspring_tune_settings, "NT0", NOTHING, mspring_tune_settings(a->network, a->dt, NULL, 0, a->out[0]))      \
    X(mspring_network_tune, "NsP1", (make_tune(a), OUT_STRUCT(0, tune_row)), mspring_network_tune(a->network,   \
      a->given, a->out[0], 1, a->out[1]))                                                                       \
    X(mspring_network_apply_force, "NIXY", NOTHING, mspring_network_apply_force(a->network, a->id, a->x,        \
      a->y))                                                                                                    \
    X(mspring_network_apply_forces, "NRFG", NOTHING, mspring_network_apply_forces(a->network,                   \
      MSPRING_PUSH_STEP, NULL, a->first, a->count, a->f, a->g, 1))                                              \
    X(mspring_network_apply_forces__list, "NaFG", NOTHING, mspring_network_apply_forces(a->network,             \
      MSPRING_PUSH_STEP, a->ids, 0, a->count, a->f, a->g, 1))                                                   \
    X(mspring_network_apply_forces__substep, "NRFG", NOTHING, mspring_network_apply_forces(a->network,          \
      MSPRING_PUSH_SUBSTEP, NULL, a->first, a->count, a->f, a->g, 1))                                           \
    X(mspring_network_apply_forces__substep_list, "NaFG", NOTHING, mspring_network_apply_forces(a->network,     \
      MSPRING_PUSH_SUBSTEP, a->ids, 0, a->count, a->f, a->g, 1))                                                \
    X(mspring_network_apply_forces__impulses, "NRFG", NOTHING, mspring_network_apply_forces(a->network,         \
      MSPRING_PUSH_IMPULSE, NULL, a->first, a->count, a->f, a->g, 1))                                           \
    X(mspring_network_apply_forces__impulses_list, "NaFG", NOTHING, mspring_network_apply_forces(a->network,    \
      MSPRING_PUSH_IMPULSE, a->ids, 0, a->count, a->f, a->g, 1))                                                \
    X(mspring_network_apply_forces__kind, "NKr", a->kind = MSPRING_PUSH_STEP,                                   \
      mspring_network_apply_forces(a->network, a->kind, NULL, a->first, a->count, &(const float){1}, &(const    \
      float){2}, 0))                                                                                            \
    X(mspring_network_apply_torque, "NrX", NOTHING, mspring_network_apply_torque(a->network, NULL, a->first,    \
      a->count, a->x))                                                                                          \
    X(mspring_network_apply_torque__list, "NaX", NOTHING, mspring_network_apply_torque(a->network, a->ids, 0,   \
      a->count, a->x))                                                                                          \
    X(mspring_network_add_hook, "NSo", make_hook(a), mspring_network_add_hook(a->network, a->given,             \
      a->out[0]))                                                                                               \
    X(mspring_network_remove_hook, "NI", add_hook(a), mspring_network_remove_hook(a->network, a->id))           \
    X(mspring_network_get_view, "nP", OUT_STRUCT(0, view), mspring_network_get_view(a->network, a->out[0]))     \
    X(mspring_network_get_positions, "nR01", NOTHING, mspring_network_get_positions(a->network, NULL,           \
      a->first, a->count, a->out[0], a->out[1], 1))                                                             \
    X(mspring_network_get_columns, "nR01", NOTHING, mspring_network_get_columns(a->network, NULL, a->first,     \
      a->count, (const mspring_column[]){{MSPRING_X, 1, a->out[0]}, {MSPRING_Y, 1, a->out[1]}}, 2))             \
    X(mspring_network_get_columns__one, "nKR0", a->kind = MSPRING_TENSION,                                      \
      mspring_network_get_columns(a->network, NULL, a->first, a->count, (const                                  \
      mspring_column[]){{(mspring_property)a->kind, 1, a->out[0]}}, 1))                                         \
    X(mspring_network_get_velocities, "nR01", NOTHING, mspring_network_get_velocities(a->network, NULL,         \
      a->first, a->count, a->out[0], a->out[1], 1))                                                             \
    X(mspring_network_get_positions__list, "na01", NOTHING, mspring_network_get_positions(a->network, a->ids,   \
      0, a->count, a->out[0], a->out[1], 1))                                                                    \
    X(mspring_network_get_columns__list, "na01", NOTHING, mspring_network_get_columns(a->network, a->ids, 0,    \
      a->count, (const mspring_column[]){{MSPRING_X, 1, a->out[0]}, {MSPRING_Y, 1, a->out[1]}}, 2))             \
    X(mspring_network_get_integers__particle_flags, "nKR0", a->kind = MSPRING_PARTICLE_FLAGS,                   \
      mspring_network_get_integers(a->network, a->kind, NULL, a->first, a->count, a->out[0], 1))                \
    X(mspring_network_get_integers__spring_flags, "nKR0", a->kind = MSPRING_SPRING_FLAGS,                       \
      mspring_network_get_integers(a->network, a->kind, NULL, a->first, a->count, a->out[0], 1))                \
    X(mspring_network_set_integers, "NKr", (make_contact(a), a->kind = MSPRING_LAYERS),                         \
      mspring_network_set_integers(a->network, a->kind, NULL, a->first, a->count, &(const uint32_t){3}, 0))     \
    X(mspring_network_set_integers__list, "NKa", (make_contact(a), a->kind = MSPRING_MASKS),                    \
      mspring_network_set_integers(a->network, a->kind, a->ids, 0, a->count, a->id_values, 1))                  \
    X(mspring_network_set__same, "NKr", a->kind = MSPRING_STIFFNESS, mspring_network_set(a->network, a->kind,   \
      NULL, a->first, a->count, &(const float){3}, 0))                                                          \
    X(mspring_network_set__friction, "NKRF", (make_contact(a), a->kind = MSPRING_FRICTION),                     \
      mspring_network_set(a->network, a->kind, NULL, a->first, a->count, a->f, 1))                              \
    X(mspring_network_get_integers__list, "nKa0", a->kind = MSPRING_SPRING_FLAGS,                               \
      mspring_network_get_integers(a->network, a->kind, a->ids, 0, a->count, a->out[0], 1))                     \
    X(mspring_network_set__area_stiffness, "NRF", make_area(a), mspring_network_set(a->network,                 \
      MSPRING_ELEMENT_STIFFNESS, NULL, a->first, a->count, a->f, 1))                                            \
    X(mspring_network_get__area_stiffness, "nR0", make_area(a), mspring_network_get(a->network,                 \
      MSPRING_ELEMENT_STIFFNESS, NULL, a->first, a->count, a->out[0], 1))                                       \
    X(mspring_network_set__area_rest, "NRF", make_area(a), mspring_network_set(a->network, MSPRING_REST_AREA,   \
      NULL, a->first, a->count, a->f, 1))                                                                       \
    X(mspring_network_get__area_rest, "nR0", make_area(a), mspring_network_get(a->network, MSPRING_REST_AREA,   \
      NULL, a->first, a->count, a->out[0], 1))                                                                  \
    X(mspring_network_set__angle_stiffness, "NRF", make_angle(a), mspring_network_set(a->network,               \
      MSPRING_ELEMENT_STIFFNESS, NULL, a->first, a->count, a->f, 1))                                            \
    X(mspring_network_get__angle_stiffness, "nR0", make_angle(a), mspring_network_get(a->network,               \
      MSPRING_ELEMENT_STIFFNESS, NULL, a->first, a->count, a->out[0], 1))                                       \
    X(mspring_network_set__rest_angle, "NRF", make_angle(a), mspring_network_set(a->network,                    \
      MSPRING_REST_ANGLE, NULL, a->first, a->count, a->f, 1))                                                   \
    X(mspring_network_get__rest_angle, "nR0", make_angle(a), mspring_network_get(a->network,                    \
      MSPRING_REST_ANGLE, NULL, a->first, a->count, a->out[0], 1))                                              \
    X(mspring_network_get_velocities__list, "na01", NOTHING, mspring_network_get_velocities(a->network,         \
      a->ids, 0, a->count, a->out[0], a->out[1], 1))                                                            \
    X(mspring_network_set_positions, "NRDE", NOTHING, mspring_network_set_positions(a->network, NULL,           \
      a->first, a->count, a->d, a->e, 1))                                                                       \
    X(mspring_network_set_velocities, "NRFG", NOTHING, mspring_network_set_velocities(a->network, NULL,         \
      a->first, a->count, a->f, a->g, 1))                                                                       \
    X(mspring_network_set_positions__list, "NaDE", NOTHING, mspring_network_set_positions(a->network, a->ids,   \
      0, a->count, a->d, a->e, 1))                                                                              \
    X(mspring_network_set_velocities__list, "NaFG", NOTHING, mspring_network_set_velocities(a->network,         \
      a->ids, 0, a->count, a->f, a->g, 1))                                                                      \
    PROPERTY(X, _mass, MSPRING_MASS, "F")                                                                       \
    PROPERTY(X, _inverse_mass_scale, MSPRING_INVERSE_MASS_SCALE, "F")                                           \
    PROPERTY(X, _stiffness, MSPRING_STIFFNESS, "F")                                                             \
    PROPERTY(X, _damping, MSPRING_DAMPING, "F")                                                                 \
    PROPERTY(X, _rest_length, MSPRING_REST_LENGTH, "F")                                                         \
    PROPERTY(X, _break_strain, MSPRING_BREAK_STRAIN, "f")                                                       \
    PROPERTY(X, _stress_strain, MSPRING_WARN_STRAIN, "f")                                                       \
    PROPERTY(X, _relax_strain, MSPRING_RELAX_STRAIN, "f")                                                       \
    MEASURED(X, _strain, MSPRING_STRAIN)                                                                        \
    MEASURED(X, _length, MSPRING_LENGTH)                                                                        \
    MEASURED(X, _force, MSPRING_TENSION)                                                                        \
    MEASURED(X, _active_stiffness, MSPRING_ACTIVE_STIFFNESS)                                                    \
    MEASURED(X, _active_damping, MSPRING_ACTIVE_DAMPING)                                                        \
    MEASURED(X, _active_rest_length, MSPRING_ACTIVE_REST_LENGTH)                                                \
    X(mspring_network_break_springs, "Na", NOTHING, mspring_network_break_springs(a->network, a->ids, 0,        \
      a->count))                                                                                                \
    X(mspring_network_break_springs__range, "Nr", NOTHING, mspring_network_break_springs(a->network, NULL,      \
      a->first, a->count))                                                                                      \
    X(mspring_network_restore_springs, "NaJ", NOTHING, mspring_network_restore_springs(a->network, a->ids, 0,   \
      a->count, a->ramp))                                                                                       \
    X(mspring_network_restore_springs__range, "Nr", NOTHING, mspring_network_restore_springs(a->network, NULL,  \
      a->first, a->count, 0))                                                                                   \
    X(mspring_network_detach_particles, "Na", NOTHING, mspring_network_detach_particles(a->network, a->ids, 0,  \
      a->count))                                                                                                \
    X(mspring_network_detach_particles__range, "Nr", NOTHING, mspring_network_detach_particles(a->network,      \
      NULL, a->first, a->count))                                                                                \
    X(mspring_network_add_particles, "NSW0", FILL(PARTICLE_DEF, particle_def),                                  \
      mspring_network_add_particles(a->network, a->given, 1, a->out[0]))                                        \
    X(mspring_network_add_springs, "NSW0", make_spring(a), mspring_network_add_springs(a->network, a->given,    \
      1, a->out[0]))                                                                                            \
    X(mspring_network_remove_particles, "Na", NOTHING, mspring_network_remove_particles(a->network, a->ids, 0,  \
      a->count))                                                                                                \
    X(mspring_network_remove_particles__range, "Nr", NOTHING, mspring_network_remove_particles(a->network,      \
      NULL, a->first, a->count))                                                                                \
    X(mspring_network_remove_springs, "Na", NOTHING, mspring_network_remove_springs(a->network, a->ids, 0,      \
      a->count))                                                                                                \
    X(mspring_network_remove_springs__range, "Nr", NOTHING, mspring_network_remove_springs(a->network, NULL,    \
      a->first, a->count))                                                                                      \
    X(mspring_network_reuse_ids, "N", NOTHING, mspring_network_reuse_ids(a->network))                           \
    X(mspring_network_reserve_events, "N", NOTHING, mspring_network_reserve_events(a->network, 100))            \
    X(mspring_network_read_events, "N01", NOTHING, mspring_network_read_events(a->network, a->out[0], 8,        \
      a->out[1], a->out[2]))                                                                                    \
    X(mspring_network_update_components, "No", NOTHING, mspring_network_update_components(a->network,           \
      a->out[0], a->out[1]))                                                                                    \
    X(mspring_network_get_integers__components, "nR0", NOTHING, mspring_network_get_integers(a->network,        \
      MSPRING_COMPONENT, NULL, a->first, a->count, a->out[0], 1))                                               \
    X(mspring_network_get_components, "nRP", make_components(a), mspring_network_get_components(a->network,     \
      a->first, a->count, a->out[0]))                                                                           \
    X(mspring_network_add_area, "NSWIo", fill_area(a), add_area(a))                                             \
    X(mspring_network_add_cell_areas, "NSWo", fill_area(a), mspring_network_add_cell_areas(a->network,          \
      a->given, a->out[0], a->out[1]))                                                                          \
    X(mspring_network_remove_elements, "NI", make_area(a), mspring_network_remove_elements(a->network, NULL,    \
      a->id, 1))                                                                                                \
    X(mspring_network_remove_elements__list, "Na", (make_angle(a), a->id_values[0] = a->first, a->id_values[1]  \
      = a->first + 1), mspring_network_remove_elements(a->network, a->ids, 0, a->count))                        \
    X(mspring_network_get_element_particles, "nI01", make_area(a),                                              \
      mspring_network_get_element_particles(a->network, a->id, a->out[0], 8, a->out[1]))                        \
    X(mspring_network_add_angles, "NSWIo", fill_angle(a), add_angle(a))                                         \
    X(mspring_network_remove_elements__angles, "NI", make_angle(a),                                             \
      mspring_network_remove_elements(a->network, NULL, a->id, 1))                                              \
    X(mspring_network_get_energy, "nP", OUT_STRUCT(0, energy), mspring_network_get_energy(a->network,           \
      a->out[0]))                                                                                               \
    X(mspring_network_get_body, "nrP", OUT_STRUCT(0, body), mspring_network_get_body(a->network, NULL,          \
      a->first, a->count, a->out[0]))                                                                           \
    X(mspring_network_get_body__list, "naP", OUT_STRUCT(0, body), mspring_network_get_body(a->network, a->ids,  \
      0, a->count, a->out[0]))                                                                                  \
    X(mspring_network_nearest_particle, "nXY0", NOTHING, mspring_network_nearest_particle(a->network, a->x,     \
      a->y, 10, a->out[0], a->out[1]))                                                                          \
    X(mspring_network_particles_in_circle, "nXY01", NOTHING, mspring_network_particles_in_circle(a->network,    \
      a->x, a->y, 10, a->out[0], 8, a->out[1]))                                                                 \
    X(mspring_network_particles_in_box, "n01", NOTHING, mspring_network_particles_in_box(a->network, -1, -1,    \
      1, 1, a->out[0], 8, a->out[1]))                                                                           \
    X(mspring_network_nearest_spring, "nXY0", NOTHING, mspring_network_nearest_spring(a->network, a->x, a->y,   \
      10, 3, a->out[0], a->out[1], a->out[2]))                                                                  \
    X(mspring_network_springs_in_circle, "nXY01", NOTHING, mspring_network_springs_in_circle(a->network, a->x,  \
      a->y, 10, 3, a->out[0], 8, a->out[1]))                                                                    \
    X(mspring_network_springs_across, "nXY01", NOTHING, mspring_network_springs_across(a->network, -1, -1,      \
      a->x, a->y, 1, a->out[0], NULL, 8, a->out[1]))                                                            \
    X(mspring_network_get_columns__ends, "nR01", NOTHING, mspring_network_get_columns(a->network, NULL,         \
      a->first, a->count, (const mspring_column[]){{MSPRING_END_A, 1, a->out[0]}, {MSPRING_END_B, 1,            \
      a->out[1]}}, 2))                                                                                          \
    X(mspring_network_get_state_hash, "n0", NOTHING, mspring_network_get_state_hash(a->network, a->out[0]))     \
    X(mspring_network_get_snapshot_size, "nK0", a->kind = MSPRING_SNAPSHOT_ALL,                                 \
      mspring_network_get_snapshot_size(a->network, a->kind, a->out[0]))                                        \
    X(mspring_network_save, "nKZ0", (a->kind = MSPRING_SNAPSHOT_FRAME, a->size = SNAPSHOT_BYTES, a->out[0] =    \
      a->snapshot_bytes), mspring_network_save(a->network, a->kind, a->out[0], a->size, a->out[1]))             \
    X(mspring_network_load, "NZV", a->size = a->snapshot_size, mspring_network_load(a->network, a->snapshot,    \
      a->size))                                                                                                 \
    X(mspring_network_set_floor, "Ns", make_floor(a), mspring_network_set_floor(a->network, a->given))          \
    X(mspring_network_get_columns__floor_impulses, "nR01", NOTHING, mspring_network_get_columns(a->network,     \
      NULL, a->first, a->count, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, a->out[0]},               \
      {MSPRING_FLOOR_IMPULSE_Y, 1, a->out[1]}}, 2))                                                             \
    X(mspring_network_set_contact, "Ns", FILL(CONTACT_DEF, contact_def), set_contact(a))                        \
    X(mspring_network_get_contact, "nP", OUT_STRUCT(0, contact_def), mspring_network_get_contact(a->network,    \
      a->out[0]))                                                                                               \
    X(mspring_network_get_contact_info, "nP", OUT_STRUCT(0, contact_info),                                      \
      mspring_network_get_contact_info(a->network, a->out[0]))                                                  \
    X(mspring_builder_add_strain_limits, "BrXYo", NOTHING, mspring_builder_add_strain_limits(a->builder, NULL,  \
      a->first, a->count, a->x, a->y, a->out[0]))                                                               \
    X(mspring_builder_add_copies, "BDE", NOTHING, add_copies(a))                                                \
    X(mspring_network_set_groups, "NA", make_groups(a), mspring_network_set_groups(a->network, a->ids, 1))      \
    X(mspring_network_count__groups, "v", NOTHING, note_size(mspring_network_count(a->network,                  \
      MSPRING_GROUPS)))                                                                                         \
    X(mspring_network_get_integers__groups, "nR0", make_groups(a), mspring_network_get_integers(a->network,     \
      MSPRING_GROUP_FLAGS, NULL, a->first, a->count, a->out[0], 1))                                             \
    X(mspring_network_mark_groups, "NI", make_groups(a), mspring_network_mark_groups(a->network, &a->id, 0,     \
      1))                                                                                                       \
    X(mspring_network_mark_groups__range, "Nr", make_groups(a), mspring_network_mark_groups(a->network, NULL,   \
      a->first, a->count))                                                                                      \
    X(mspring_network_reset_groups, "NIK", (make_groups(a), a->kind = MSPRING_RESET_MARK),                      \
      mspring_network_reset_groups(a->network, (mspring_reset)a->kind, &a->id, 0, 1))                           \
    X(mspring_network_reset_groups__range, "Nr", make_groups(a), mspring_network_reset_groups(a->network,       \
      MSPRING_RESET_START, NULL, a->first, a->count))                                                           \
    X(mspring_network_observe_groups, "nR0", make_groups(a), mspring_network_observe_groups(a->network, NULL,   \
      a->first, a->count, (const mspring_observation[]){{MSPRING_X, 0}, {MSPRING_VY, 1}}, 2, a->out[0], 2))     \
    X(mspring_network_set_actuators, "NA", NOTHING, mspring_network_set_actuators(a->network, a->ids, 2, 1))    \
    X(mspring_network_count__actuators, "v", NOTHING, note_size(mspring_network_count(a->network,               \
      MSPRING_ACTUATORS)))                                                                                      \
    X(mspring_network_count, "v", NOTHING, note_size(mspring_network_count(a->network, (mspring_kind)99)))      \
    X(mspring_network_set__signals, "NRF", (make_actuators(a), a->first = 0), mspring_network_set(a->network,   \
      MSPRING_SIGNAL, NULL, a->first, a->count, a->f, 1))                                                       \
    X(mspring_network_add_grip, "NSWo", make_grip(a), mspring_network_add_grip(a->network, a->given,            \
      a->out[0]))                                                                                               \
    X(mspring_network_remove_grip, "NI", make_grip(a), mspring_network_remove_grip(a->network, a->id))          \
    X(mspring_network_set_grip, "NISW", make_grip(a), mspring_network_set_grip(a->network, a->id, a->given))    \
    X(mspring_network_move_grip, "NIXY", make_grip(a), mspring_network_move_grip(a->network, a->id, a->x,       \
      a->y))                                                                                                    \
    X(mspring_network_get_grip, "nIP", (make_grip(a), OUT_STRUCT(0, grip_def)),                                 \
      mspring_network_get_grip(a->network, a->id, a->out[0]))                                                   \
    X(mspring_network_get_grip_impulse, "nI01", make_grip(a), mspring_network_get_grip_impulse(a->network,      \
      a->id, a->out[0], a->out[1]))                                                                             \
    X(mspring_network_read_contact_events, "N", NOTHING, with_collider(a, read_contact_events))                 \
    X(mspring_network_add_collider, "N", NOTHING, with_collider(a, add_collider))                               \
    X(mspring_network_remove_collider, "N", NOTHING, with_collider(a, remove_collider))                         \
    X(mspring_network_move_collider, "N", NOTHING, with_collider(a, move_collider))                             \
    X(mspring_network_place_collider, "N", NOTHING, with_collider(a, place_collider))                           \
    X(mspring_network_get_collider, "n", NOTHING, with_collider(a, get_collider))                               \
    X(mspring_network_get_collider_impulse, "n", NOTHING, with_collider(a, get_collider_impulse))               \
    X(mspring_network_wake, "N", NOTHING, mspring_network_wake(a->network))                                     \
    X(mspring_network_compact, "N", NOTHING, mspring_network_compact(a->network))                               \
    X(mspring_job_begin, "NK0", a->kind = MSPRING_LAYOUT_WHOLE, begin_job(a))                                   \
    X(mspring_job_run, "v", NOTHING, run_job(a))                                                                \
    X(mspring_job_finish, "N", NOTHING, finish_job(a))                                                          \
    X(mspring_job_error, "", NOTHING, note_text(mspring_job_error(NULL)))                                       \
    X(mspring_job_destroy, "", NOTHING, (mspring_job_destroy(NULL), MSPRING_OK))                                \
    X(mspring_gradient_create, "", NOTHING, no_gradient(mspring_gradient_create(NULL, 1, NULL, 0, NULL)))       \
    X(mspring_gradient_step, "", NOTHING, no_gradient(mspring_gradient_step(NULL, 1, NULL, NULL)))              \
    X(mspring_gradient_add_seeds, "", NOTHING, no_gradient(mspring_gradient_add_seeds(NULL, NULL, 0, 0, NULL,   \
      NULL)))                                                                                                   \
    X(mspring_gradient_reverse, "", NOTHING, no_gradient(mspring_gradient_reverse(NULL, 0)))                    \
    X(mspring_gradient_get, "", NOTHING, no_gradient(mspring_gradient_get(NULL, MSPRING_GRADIENT_X, NULL, 0,    \
      0, NULL, 1)))                                                                                             \
    X(mspring_gradient_get_signals, "", NOTHING, no_gradient(mspring_gradient_get_signals(NULL, 0, NULL)))      \
    X(mspring_gradient_get_forces, "", NOTHING, no_gradient(mspring_gradient_get_forces(NULL, 0, NULL)))        \
    X(mspring_gradient_error, "", NOTHING, note_text(mspring_gradient_error(NULL)))                             \
    X(mspring_gradient_destroy, "", NOTHING, (mspring_gradient_destroy(NULL), MSPRING_OK))

#endif
