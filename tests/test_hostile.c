/// @file test_hostile.c
/// Every public function with everything that is wrong: NULL, numbers that are none or out of range, particles and
/// springs that do not exist, absurd counts, structs of impossible sizes, calls from inside a hook. Each is refused
/// or, where that is documented, accepted; a refusal says why, changes nothing and touches no out-parameter.
///
/// The functions are those of the header: one that is missing in the table fails the test.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

enum { OUTS = 6, OUT_BYTES = 512, STRUCT_BYTES = 512, SNAPSHOT_BYTES = 8192 };

/// What a function is called with: good at first, then spoilt in one place.
typedef struct arguments {
    mspring_network *network;
    mspring_builder *builder;
    mspring_id id, first;
    uint32_t count;
    size_t size;
    int32_t kind;
    float x, y;
    double dt, safety, ramp;
    const float *f, *g;
    const double *d, *e;
    const mspring_id *ids;
    const void *snapshot;
    void *given; ///< a struct
    void *out[OUTS];

    float f_values[2], g_values[2];
    double d_values[2], e_values[2];
    mspring_id id_values[2];
    _Alignas(16) unsigned char given_bytes[STRUCT_BYTES];
    _Alignas(16) unsigned char out_bytes[OUTS][OUT_BYTES];
    _Alignas(16) unsigned char snapshot_bytes[SNAPSHOT_BYTES];
    size_t snapshot_size;
} arguments;

/* --------------------------------------------------------------------------------------------- the functions */

static size_t sink; // what functions without a result return

static mspring_result note_size(size_t value) {
    sink += value;
    return MSPRING_OK;
}

static mspring_result note_text(const char *text) {
    assert_non_null(text);
    return note_size(strlen(text));
}

static mspring_result create_builder(arguments *a) {
    const mspring_result result = mspring_builder_create(a->given, a->out[0]);
    if (result == MSPRING_OK) {
        mspring_builder_destroy(*(mspring_builder **)a->out[0]);
    }
    return result;
}

static mspring_result create_network(arguments *a) {
    const mspring_result result = mspring_network_create(a->builder, a->given, a->out[0]);
    if (result == MSPRING_OK) {
        mspring_network_destroy(*(mspring_network **)a->out[0]);
    }
    return result;
}

static mspring_result clone_network(arguments *a) {
    const mspring_result result = mspring_network_clone(a->network, a->given, a->out[0]);
    if (result == MSPRING_OK) {
        mspring_network_destroy(*(mspring_network **)a->out[0]);
    }
    return result;
}

static mspring_result destroy_nothing(void) {
    mspring_builder_destroy(NULL);
    mspring_network_destroy(NULL);
    return MSPRING_OK;
}

static void *host_alloc(size_t size, size_t alignment, void *user) {
    (void)alignment, (void)user;
    return malloc(size);
}

static void host_free(void *memory, size_t size, void *user) {
    (void)size, (void)user;
    free(memory);
}

static void no_hook(const mspring_hook_args *args, void *user) {
    (void)args, (void)user;
}

/// Ways to make what is given.
#define NOTHING ((void)0)
#define FILL(type) ((void)mspring_##type##_init((mspring_##type *)(void *)a->given_bytes, sizeof(mspring_##type)))
/// Out-parameter i is a struct.
#define OUT_STRUCT(i, type) (*(uint32_t *)(void *)a->out_bytes[i] = (uint32_t)sizeof(mspring_##type))

static void make_allocator(arguments *a) {
    const mspring_allocator made = {.struct_size = sizeof made, .alloc = host_alloc, .free = host_free};
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_spring(arguments *a) {
    mspring_spring_def made;
    check_ok(mspring_spring_def_init(&made, sizeof made));
    made.a = 0, made.b = 7;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_rope(arguments *a) {
    mspring_rope_def made;
    check_ok(mspring_rope_def_init(&made, sizeof made));
    made.from = 0, made.to = 7, made.segment_count = 2;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_lattice(arguments *a) {
    static const uint16_t cells[4] = {0, 0, 0, 0};
    static mspring_material material;
    mspring_lattice_def made;
    check_ok(mspring_material_init(&material, sizeof material));
    check_ok(mspring_lattice_def_init(&made, sizeof made));
    made.width = made.height = 2, made.cells = cells, made.materials = &material, made.material_count = 1;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_hook(arguments *a) {
    mspring_hook_def made;
    check_ok(mspring_hook_def_init(&made, sizeof made));
    made.fn = no_hook;
    memcpy(a->given_bytes, &made, sizeof made);
}

/// One setting to be tried in a few short steps.
static void make_tune(arguments *a) {
    static mspring_solver_def setting;
    mspring_tune_def made;
    check_ok(mspring_solver_def_init(&setting, sizeof setting));
    check_ok(mspring_tune_def_init(&made, sizeof made));
    made.settings = &setting, made.setting_count = 1, made.dt = 0.001, made.duration = 0.004;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_tune_row(arguments *a) {
    const mspring_tune_row made = {.struct_size = sizeof made, .substeps = 1};
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_floor(arguments *a) {
    static const double plane[4] = {0, -1, 0, 1};
    mspring_floor_def made;
    check_ok(mspring_floor_def_init(&made, sizeof made));
    made.planes = plane, made.plane_count = 1;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void add_hook(arguments *a) {
    check_ok(support_add_hook(a->network, MSPRING_PHASE_BEFORE_STEP, no_hook, NULL, &a->id));
}

/// Name, kinds of arguments, what makes the struct given, the call.
///
/// Kinds: capitals have to be refused when they are spoilt, small letters may be accepted.
///   N  network, of a call that is refused inside a hook, and leaves a message     n  network of another call
///   v  network or builder that may be NULL        B  builder
///   I  id        R  first and count       A  ids        C  count of structs (size)
///   X  x, Y  y   T  dt   L  safety   J  ramp            K  enumerator
///   F f  G g     arrays of floats, where only small letters allow infinity    D E  arrays of doubles
///   S  struct, NULL refused    s  struct, NULL accepted; impossible sizes are refused for both
///   W  any other word of the struct may be anything (for those without pointers)
///   P  first out-parameter, a struct with its size     0-5  out-parameter needed    o  all of them may be NULL
///   Z  size    V  bytes of a snapshot
#define FUNCTIONS(X)                                                                                               \
    X(mspring_version, "", NOTHING, note_size(mspring_version()))                                                  \
    X(mspring_version_string, "", NOTHING, note_text(mspring_version_string()))                                    \
    X(mspring_features, "", NOTHING, note_size(mspring_features()))                                                \
    X(mspring_result_string, "k", NOTHING, note_text(mspring_result_string(a->kind)))                              \
    X(mspring_particle_def_init, "Z0", a->size = sizeof(mspring_particle_def),                                     \
      mspring_particle_def_init(a->out[0], a->size))                                                               \
    X(mspring_spring_def_init, "Z0", a->size = sizeof(mspring_spring_def),                                         \
      mspring_spring_def_init(a->out[0], a->size))                                                                 \
    X(mspring_material_init, "Z0", a->size = sizeof(mspring_material), mspring_material_init(a->out[0], a->size))  \
    X(mspring_lattice_def_init, "Z0", a->size = sizeof(mspring_lattice_def),                                       \
      mspring_lattice_def_init(a->out[0], a->size))                                                                \
    X(mspring_rope_def_init, "Z0", a->size = sizeof(mspring_rope_def), mspring_rope_def_init(a->out[0], a->size))  \
    X(mspring_solver_def_init, "Z0", a->size = sizeof(mspring_solver_def),                                         \
      mspring_solver_def_init(a->out[0], a->size))                                                                 \
    X(mspring_network_def_init, "Z0", a->size = sizeof(mspring_network_def),                                       \
      mspring_network_def_init(a->out[0], a->size))                                                                \
    X(mspring_settle_def_init, "Z0", a->size = sizeof(mspring_settle_def),                                         \
      mspring_settle_def_init(a->out[0], a->size))                                                                 \
    X(mspring_hook_def_init, "Z0", a->size = sizeof(mspring_hook_def), mspring_hook_def_init(a->out[0], a->size))  \
    X(mspring_clone_def_init, "Z0", a->size = sizeof(mspring_clone_def),                                           \
      mspring_clone_def_init(a->out[0], a->size))                                                                  \
    X(mspring_builder_create, "s0", make_allocator(a), create_builder(a))                                          \
    X(mspring_builder_destroy, "", NOTHING, destroy_nothing())                                                     \
    X(mspring_builder_error, "v", NOTHING, note_text(mspring_builder_error(a->builder)))                           \
    X(mspring_builder_particle_count, "v", NOTHING, note_size(mspring_builder_particle_count(a->builder)))         \
    X(mspring_builder_spring_count, "v", NOTHING, note_size(mspring_builder_spring_count(a->builder)))             \
    X(mspring_builder_add_particle, "BSWo", FILL(particle_def),                                                    \
      mspring_builder_add_particle(a->builder, a->given, a->out[0]))                                               \
    X(mspring_builder_add_particles, "BSWCo", FILL(particle_def),                                                  \
      mspring_builder_add_particles(a->builder, a->given, a->size, a->out[0]))                                     \
    X(mspring_builder_add_spring, "BSWo", make_spring(a),                                                          \
      mspring_builder_add_spring(a->builder, a->given, a->out[0]))                                                 \
    X(mspring_builder_add_springs, "BSWCo", make_spring(a),                                                        \
      mspring_builder_add_springs(a->builder, a->given, a->size, a->out[0]))                                       \
    X(mspring_builder_add_lattice, "BSo", make_lattice(a),                                                         \
      mspring_builder_add_lattice(a->builder, a->given, a->out[0]))                                                \
    X(mspring_builder_add_rope, "BSo", make_rope(a),                                                               \
      mspring_builder_add_rope(a->builder, a->given, a->out[0], a->out[1]))                                        \
    X(mspring_network_create, "Bs0", FILL(network_def), create_network(a))                                         \
    X(mspring_network_destroy, "", NOTHING, destroy_nothing())                                                     \
    X(mspring_network_clone, "ns0", FILL(clone_def), clone_network(a))                                             \
    X(mspring_network_error, "v", NOTHING, note_text(mspring_network_error(a->network)))                           \
    X(mspring_network_particle_count, "v", NOTHING, note_size(mspring_network_particle_count(a->network)))         \
    X(mspring_network_spring_count, "v", NOTHING, note_size(mspring_network_spring_count(a->network)))             \
    X(mspring_network_substeps, "v", NOTHING, note_size(mspring_network_substeps(a->network)))                     \
    X(mspring_network_fallback_count, "v", NOTHING, note_size((size_t)mspring_network_fallback_count(a->network))) \
    X(mspring_network_simd_level, "v", NOTHING, note_size((size_t)mspring_network_simd_level(a->network)))         \
    X(mspring_network_worker_count, "v", NOTHING, note_size(mspring_network_worker_count(a->network)))             \
    X(mspring_network_memory_used, "v", NOTHING, note_size(mspring_network_memory_used(a->network)))               \
    X(mspring_simd_supported, "", NOTHING, note_size((size_t)mspring_simd_supported()))                            \
    X(mspring_simd_available, "k", NOTHING, note_size(mspring_simd_available(a->kind)))                            \
    X(mspring_simd_name, "k", NOTHING, note_text(mspring_simd_name(a->kind)))                                      \
    X(mspring_network_set_solver, "NSW", FILL(solver_def), mspring_network_set_solver(a->network, a->given))       \
    X(mspring_network_set_gravity, "NXY", NOTHING, mspring_network_set_gravity(a->network, a->x, a->y))            \
    X(mspring_network_set_global_damping, "NX", NOTHING, mspring_network_set_global_damping(a->network, a->x))     \
    X(mspring_network_step, "NT", NOTHING, mspring_network_step(a->network, a->dt))                                \
    X(mspring_network_stable_dt, "No", NOTHING, mspring_network_stable_dt(a->network, a->out[0], a->out[1]))       \
    X(mspring_network_suggest_substeps, "NTL0", NOTHING,                                                           \
      mspring_network_suggest_substeps(a->network, a->dt, a->safety, a->out[0]))                                   \
    X(mspring_network_settle, "NsWo", (FILL(settle_def), OUT_STRUCT(0, settle_result)),                            \
      mspring_network_settle(a->network, a->given, a->out[0]))                                                     \
    X(mspring_tune_def_init, "Z0", a->size = sizeof(mspring_tune_def), mspring_tune_def_init(a->out[0], a->size))  \
    X(mspring_tune_settings, "NT0", NOTHING, mspring_tune_settings(a->network, a->dt, NULL, 0, a->out[0]))         \
    X(mspring_network_tune, "NsP1", (make_tune(a), OUT_STRUCT(0, tune_row)),                                       \
      mspring_network_tune(a->network, a->given, a->out[0], 1, a->out[1]))                                         \
    X(mspring_tune_row_solver, "S0", make_tune_row(a), mspring_tune_row_solver(a->given, a->out[0]))               \
    X(mspring_network_apply_force, "NIXY", NOTHING, mspring_network_apply_force(a->network, a->id, a->x, a->y))    \
    X(mspring_network_apply_forces, "NRFG", NOTHING,                                                               \
      mspring_network_apply_forces(a->network, a->first, a->count, a->f, a->g))                                    \
    X(mspring_network_add_hook, "NSo", make_hook(a), mspring_network_add_hook(a->network, a->given, a->out[0]))    \
    X(mspring_network_remove_hook, "NI", add_hook(a), mspring_network_remove_hook(a->network, a->id))              \
    X(mspring_network_view, "nP", OUT_STRUCT(0, view), mspring_network_view(a->network, a->out[0]))                \
    X(mspring_network_get_positions, "nR01", NOTHING,                                                              \
      mspring_network_get_positions(a->network, a->first, a->count, a->out[0], a->out[1]))                         \
    X(mspring_network_get_positions_float, "nR01", NOTHING,                                                        \
      mspring_network_get_positions_float(a->network, a->first, a->count, a->out[0], a->out[1]))                   \
    X(mspring_network_get_velocities, "nR01", NOTHING,                                                             \
      mspring_network_get_velocities(a->network, a->first, a->count, a->out[0], a->out[1]))                        \
    X(mspring_network_set_positions, "NRDE", NOTHING,                                                              \
      mspring_network_set_positions(a->network, a->first, a->count, a->d, a->e))                                   \
    X(mspring_network_set_positions_float, "NRFG", NOTHING,                                                        \
      mspring_network_set_positions_float(a->network, a->first, a->count, a->f, a->g))                             \
    X(mspring_network_set_velocities, "NRFG", NOTHING,                                                             \
      mspring_network_set_velocities(a->network, a->first, a->count, a->f, a->g))                                  \
    X(mspring_network_get_masses, "nR0", NOTHING,                                                                  \
      mspring_network_get_masses(a->network, a->first, a->count, a->out[0]))                                       \
    X(mspring_network_set_positions_at, "NADE", NOTHING,                                                           \
      mspring_network_set_positions_at(a->network, a->ids, a->count, a->d, a->e))                                  \
    X(mspring_network_set_velocities_at, "NAFG", NOTHING,                                                          \
      mspring_network_set_velocities_at(a->network, a->ids, a->count, a->f, a->g))                                 \
    X(mspring_network_set_masses, "NRF", NOTHING,                                                                  \
      mspring_network_set_masses(a->network, a->first, a->count, a->f))                                            \
    X(mspring_network_set_masses_at, "NAF", NOTHING,                                                               \
      mspring_network_set_masses_at(a->network, a->ids, a->count, a->f))                                           \
    X(mspring_network_renew_relative_springs, "N", NOTHING, mspring_network_renew_relative_springs(a->network))    \
    X(mspring_network_set_inverse_mass_scales, "NRF", NOTHING,                                                     \
      mspring_network_set_inverse_mass_scales(a->network, a->first, a->count, a->f))                               \
    X(mspring_network_set_inverse_mass_scales_at, "NAF", NOTHING,                                                  \
      mspring_network_set_inverse_mass_scales_at(a->network, a->ids, a->count, a->f))                              \
    X(mspring_network_get_inverse_mass_scales, "nR0", NOTHING,                                                     \
      mspring_network_get_inverse_mass_scales(a->network, a->first, a->count, a->out[0]))                          \
    X(mspring_network_set_stiffnesses, "NRF", NOTHING,                                                             \
      mspring_network_set_stiffnesses(a->network, a->first, a->count, a->f))                                       \
    X(mspring_network_set_stiffnesses_at, "NAF", NOTHING,                                                          \
      mspring_network_set_stiffnesses_at(a->network, a->ids, a->count, a->f))                                      \
    X(mspring_network_set_dampings, "NRF", NOTHING,                                                                \
      mspring_network_set_dampings(a->network, a->first, a->count, a->f))                                          \
    X(mspring_network_set_dampings_at, "NAF", NOTHING,                                                             \
      mspring_network_set_dampings_at(a->network, a->ids, a->count, a->f))                                         \
    X(mspring_network_set_rest_lengths, "NRF", NOTHING,                                                            \
      mspring_network_set_rest_lengths(a->network, a->first, a->count, a->f))                                      \
    X(mspring_network_set_rest_lengths_at, "NAF", NOTHING,                                                         \
      mspring_network_set_rest_lengths_at(a->network, a->ids, a->count, a->f))                                     \
    X(mspring_network_break_springs, "NA", NOTHING, mspring_network_break_springs(a->network, a->ids, a->count))   \
    X(mspring_network_restore_springs, "NAJ", NOTHING,                                                             \
      mspring_network_restore_springs(a->network, a->ids, a->count, a->ramp))                                      \
    X(mspring_network_detach_particles, "NA", NOTHING,                                                             \
      mspring_network_detach_particles(a->network, a->ids, a->count))                                              \
    X(mspring_network_has_particle, "v", NOTHING, note_size(mspring_network_has_particle(a->network, a->id)))      \
    X(mspring_network_has_spring, "v", NOTHING, note_size(mspring_network_has_spring(a->network, a->id)))          \
    X(mspring_network_add_particles, "NSW0", FILL(particle_def),                                                   \
      mspring_network_add_particles(a->network, a->given, 1, a->out[0]))                                           \
    X(mspring_network_add_springs, "NSW0", make_spring(a),                                                         \
      mspring_network_add_springs(a->network, a->given, 1, a->out[0]))                                             \
    X(mspring_network_remove_particles, "NA", NOTHING,                                                             \
      mspring_network_remove_particles(a->network, a->ids, a->count))                                              \
    X(mspring_network_remove_springs, "NA", NOTHING, mspring_network_remove_springs(a->network, a->ids, a->count)) \
    X(mspring_network_recycle, "N", NOTHING, mspring_network_recycle(a->network))                                  \
    X(mspring_network_set_break_strains, "NRf", NOTHING,                                                           \
      mspring_network_set_break_strains(a->network, a->first, a->count, a->f))                                     \
    X(mspring_network_set_break_strains_at, "NAf", NOTHING,                                                        \
      mspring_network_set_break_strains_at(a->network, a->ids, a->count, a->f))                                    \
    X(mspring_network_set_stress_strains, "NRf", NOTHING,                                                          \
      mspring_network_set_stress_strains(a->network, a->first, a->count, a->f))                                    \
    X(mspring_network_set_stress_strains_at, "NAf", NOTHING,                                                       \
      mspring_network_set_stress_strains_at(a->network, a->ids, a->count, a->f))                                   \
    X(mspring_network_set_relax_fraction, "NX", NOTHING, mspring_network_set_relax_fraction(a->network, a->x))     \
    X(mspring_network_reserve_events, "N", NOTHING, mspring_network_reserve_events(a->network, 100))               \
    X(mspring_network_read_events, "N01", NOTHING,                                                                 \
      mspring_network_read_events(a->network, a->out[0], 8, a->out[1], a->out[2]))                                 \
    X(mspring_network_update_components, "No", NOTHING,                                                            \
      mspring_network_update_components(a->network, a->out[0], a->out[1]))                                         \
    X(mspring_network_get_component_numbers, "nR0", NOTHING,                                                       \
      mspring_network_get_component_numbers(a->network, a->first, a->count, a->out[0]))                            \
    X(mspring_network_get_components, "nRP", (a->count = 1, a->first = 0, OUT_STRUCT(0, component)),               \
      mspring_network_get_components(a->network, a->first, a->count, a->out[0]))                                   \
    X(mspring_network_energy, "no", NOTHING, mspring_network_energy(a->network, a->out[0], a->out[1], a->out[2]))  \
    X(mspring_network_momentum, "no", NOTHING,                                                                     \
      mspring_network_momentum(a->network, a->out[0], a->out[1], a->out[2]))                                       \
    X(mspring_network_bounds, "n0123", NOTHING,                                                                    \
      mspring_network_bounds(a->network, a->out[0], a->out[1], a->out[2], a->out[3]))                              \
    X(mspring_network_get_spring, "nIP", OUT_STRUCT(0, spring_info),                                               \
      mspring_network_get_spring(a->network, a->id, a->out[0]))                                                    \
    X(mspring_network_get_strains, "nR0", NOTHING,                                                                 \
      mspring_network_get_strains(a->network, a->first, a->count, a->out[0]))                                      \
    X(mspring_network_get_extents, "No", NOTHING,                                                                  \
      mspring_network_get_extents(a->network, a->out[0], NULL, NULL, a->out[1]))                                   \
    X(mspring_network_max_strain, "no", NOTHING, mspring_network_max_strain(a->network, a->out[0], a->out[1]))     \
    X(mspring_network_state_hash, "n0", NOTHING, mspring_network_state_hash(a->network, a->out[0]))                \
    X(mspring_network_snapshot_size, "nK0", a->kind = MSPRING_SNAPSHOT_ALL,                                        \
      mspring_network_snapshot_size(a->network, a->kind, a->out[0]))                                               \
    X(mspring_network_save, "nKZ0",                                                                                \
      (a->kind = MSPRING_SNAPSHOT_FRAME, a->size = SNAPSHOT_BYTES, a->out[0] = a->snapshot_bytes),                 \
      mspring_network_save(a->network, a->kind, a->out[0], a->size, a->out[1]))                                    \
    X(mspring_network_load, "NZV", a->size = a->snapshot_size,                                                     \
      mspring_network_load(a->network, a->snapshot, a->size))                                                      \
    X(mspring_floor_def_init, "Z0", a->size = sizeof(mspring_floor_def),                                           \
      mspring_floor_def_init(a->out[0], a->size))                                                                  \
    X(mspring_network_set_floor, "Ns", make_floor(a), mspring_network_set_floor(a->network, a->given))             \
    X(mspring_network_get_floor_impulses, "nR01", NOTHING,                                                         \
      mspring_network_get_floor_impulses(a->network, a->first, a->count, a->out[0], a->out[1]))                    \
    X(mspring_network_get_sleepers, "nR0", NOTHING,                                                                \
      mspring_network_get_sleepers(a->network, a->first, a->count, a->out[0]))                                     \
    X(mspring_network_is_asleep, "v", NOTHING, note_size(mspring_network_is_asleep(a->network)))                   \
    X(mspring_network_wake, "N", NOTHING, mspring_network_wake(a->network))                                        \
    X(mspring_network_compact, "No", NOTHING, mspring_network_compact(a->network, 0, a->out[0]))                   \
    X(mspring_network_expand, "N", NOTHING, mspring_network_expand(a->network))                                    \
    X(mspring_network_plan, "nP", OUT_STRUCT(0, plan), mspring_network_plan(a->network, a->out[0]))

typedef struct function {
    const char *name, *kinds;
    void (*prepare)(arguments *a);
    mspring_result (*call)(arguments *a);
} function;

#define DEFINE(name, kinds, prepare, call)                                                                         \
    static void prepare_##name(arguments *a) {                                                                     \
        (void)a;                                                                                                   \
        prepare;                                                                                                   \
    }                                                                                                              \
    static mspring_result call_##name(arguments *a) {                                                              \
        (void)a;                                                                                                   \
        return call;                                                                                               \
    }
FUNCTIONS(DEFINE)

#define ENTRY(name, kinds, prepare, call) {#name, kinds, prepare_##name, call_##name},
static const function functions[] = {FUNCTIONS(ENTRY)};

/* --------------------------------------------------------------------------------------------------- spoiling */

#define SPOILT_WORDS 4
static const uint32_t spoilt_words[SPOILT_WORDS] = {0x7fc00000u, 0x7f800000u, 0x80000000u, UINT32_MAX};

static void spoil_float(float *value, int n) {
    const float numbers[] = {NAN, INFINITY, -INFINITY};
    *value = numbers[n];
}

static void spoil_double(double *value, int n) {
    const double numbers[] = {NAN, INFINITY, -INFINITY, 0, -1};
    *value = numbers[n];
}

static void set_word(unsigned char *bytes, size_t word, uint32_t value) {
    memcpy(bytes + 4 * word, &value, sizeof value);
}

static uint32_t struct_size_of(const unsigned char *bytes) {
    uint32_t size;
    memcpy(&size, bytes, sizeof size);
    return size;
}

static bool spoil_struct(void **place, unsigned char *bytes, int n) {
    const uint32_t sizes[] = {0, 1, 3, 1u << 20, UINT32_MAX};
    if (n == 0)
        *place = NULL;
    else if (n <= (int)COUNT_OF(sizes))
        set_word(bytes, 0, sizes[n - 1]);
    return n <= (int)COUNT_OF(sizes);
}

static bool spoil_words(arguments *a, int n) {
    const size_t word = 1 + (size_t)n / SPOILT_WORDS;
    if (4 * word >= struct_size_of(a->given_bytes))
        return false;
    set_word(a->given_bytes, word, spoilt_words[n % SPOILT_WORDS]);
    return true;
}

// NULL, or the last of the two values; -1 as well where that is refused like the others.
static bool spoil_floats(const float **array, float *values, int n) {
    if (n == 0)
        *array = NULL;
    else if (n <= 3)
        spoil_float(&values[1], n - 1);
    return n <= 3;
}

static bool spoil_doubles(const double **array, double *values, int n) {
    if (n == 0)
        *array = NULL;
    else if (n <= 3)
        spoil_double(&values[1], n - 1);
    return n <= 3;
}

static bool spoil_range(arguments *a, int n) {
    const uint32_t ranges[][2] = {{UINT32_MAX, 1}, {1000, 1},       {0, UINT32_MAX},
                                  {0, 1000},       {1, UINT32_MAX}, {2, UINT32_MAX - 1}};
    if (n >= (int)COUNT_OF(ranges))
        return false;
    a->first = ranges[n][0];
    a->count = ranges[n][1];
    return true;
}

static bool spoil_ids(arguments *a, int n) {
    if (n == 0)
        a->ids = NULL;
    else if (n <= 2)
        a->id_values[n - 1] = n == 1 ? 1000 : UINT32_MAX;
    return n <= 2;
}

static bool spoil_size(size_t *size, int n, bool large) {
    const size_t sizes[2][3] = {{0, 1, 3}, {SIZE_MAX, SIZE_MAX / 64, (size_t)MSPRING_MAX_SPRINGS + 1}};
    if (n < 3)
        *size = sizes[large][n];
    return n < 3;
}

/// Spoil an argument in its n-th way. Returns false if there are not so many.
static bool spoil(arguments *a, char kind, int n) {
    const uint32_t ids[] = {1000, 1u << 31, UINT32_MAX};
    const int32_t kinds[] = {-1, 99, INT32_MIN, INT32_MAX};
    switch (kind) {
    case 'N':
    case 'n':
        a->network = NULL;
        return n < 1;
    case 'v':
        a->network = NULL;
        a->builder = NULL;
        return n < 1;
    case 'B':
        a->builder = NULL;
        return n < 1;
    case 'I':
        a->id = ids[n < 3 ? n : 0];
        return n < 3;
    case 'R':
        return spoil_range(a, n);
    case 'A':
        return spoil_ids(a, n);
    case 'C':
        return spoil_size(&a->size, n, true);
    case 'Z':
        return spoil_size(&a->size, n, false);
    case 'V':
        if (n == 0)
            a->snapshot = NULL;
        else if (n <= 200) // every byte counts, or is zero and not looked at
            a->snapshot_bytes[n * 7 % a->snapshot_size] ^= 1;
        return n <= 200;
    case 'X':
    case 'Y':
        spoil_float(kind == 'X' ? &a->x : &a->y, n < 3 ? n : 0);
        return n < 3;
    case 'T':
    case 'L':
        spoil_double(kind == 'T' ? &a->dt : &a->safety, n < 5 ? n : 0);
        return n < 5;
    case 'J':
        spoil_double(&a->ramp, n < 3 ? n : 4); // 0 is none
        return n < 4;
    case 'K':
    case 'k':
        a->kind = kinds[n < 4 ? n : 0];
        return n < 4;
    case 'F':
    case 'f':
        return spoil_floats(&a->f, a->f_values, n);
    case 'G':
        return spoil_floats(&a->g, a->g_values, n);
    case 'D':
        return spoil_doubles(&a->d, a->d_values, n);
    case 'E':
        return spoil_doubles(&a->e, a->e_values, n);
    case 'S':
    case 's':
        return spoil_struct(&a->given, a->given_bytes, n);
    case 'W':
        return spoil_words(a, n);
    case 'P':
        return spoil_struct(&a->out[0], a->out_bytes[0], n);
    case 'o':
        memset(a->out, 0, sizeof a->out);
        return n < 1;
    default:
        assert_true(kind >= '0' && kind < '0' + OUTS);
        a->out[kind - '0'] = NULL;
        return n < 1;
    }
}

/// Whether this way has to be refused.
static bool has_to_be_refused(char kind, int n) {
    switch (kind) {
    case 'v':
    case 'k':
    case 'W':
    case 'o':
        return false;
    case 's':
        return n > 0;
    case 'f':
        return n != 2; // infinite: never
    default:
        return true;
    }
}

/* ------------------------------------------------------------------------------------------------- the matrix */

static recipe small_recipe(void) {
    uint64_t seed = 6;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {100, 200}, .damping = {0, 1}};
    recipe made = {0};
    recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    recipe_particle(&made, 9, 2, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 0, made.particle_count - 1, 4, &stuff, &seed);
    recipe_disturb(&made, 0.01, 0.1, &seed);
    return made;
}

static void begin(arguments *a) {
    recipe made = small_recipe();
    mspring_network_def def = support_def(-9.8f, 2);
    def.spare_particles = def.spare_springs = 2;
    memset(a, 0, sizeof *a);
    a->builder = recipe_builder(&made, NULL);
    a->network = recipe_network(&made, &def);
    recipe_free(&made);
    support_steps(a->network, 1, 0.001);
    check_ok(mspring_network_update_components(a->network, NULL, NULL));
    check_ok(mspring_network_reserve_events(a->network, 10));
    check_ok(mspring_network_save(a->network, MSPRING_SNAPSHOT_ALL, a->snapshot_bytes, SNAPSHOT_BYTES,
                                  &a->snapshot_size));
    a->id = 3, a->first = 1, a->count = 2, a->size = 1;
    a->x = 0.5f, a->y = 0.75f, a->dt = 0.001, a->safety = 0.9, a->ramp = 0.5;
    a->f = a->f_values, a->g = a->g_values, a->d = a->d_values, a->e = a->e_values, a->ids = a->id_values;
    for (int i = 0; i < 2; i++) {
        a->f_values[i] = a->g_values[i] = 0.5f + 0.25f * (float)i;
        a->d_values[i] = a->e_values[i] = 0.5 + 0.25 * i;
        a->id_values[i] = 2 + (mspring_id)i;
    }
    a->snapshot = a->snapshot_bytes;
    a->given = a->given_bytes;
    memset(a->out_bytes, 0xa5, sizeof a->out_bytes);
    for (int i = 0; i < OUTS; i++)
        a->out[i] = a->out_bytes[i];
}

/// What may not change.
typedef struct before {
    mspring_network *network;
    mspring_builder *builder;
    uint64_t hash;
    uint32_t particles, springs;
    size_t memory;
    unsigned char out_bytes[OUTS][OUT_BYTES];
} before;

static before look(const arguments *a) {
    before b = {.network = a->network,
                .builder = a->builder,
                .hash = support_hash(a->network),
                .particles = mspring_builder_particle_count(a->builder),
                .springs = mspring_builder_spring_count(a->builder)};
    return b;
}

static void check_unchanged(const before *b, const arguments *a) {
    assert_int_equal(support_hash(b->network), b->hash);
    assert_int_equal(mspring_builder_particle_count(b->builder), b->particles);
    assert_int_equal(mspring_builder_spring_count(b->builder), b->springs);
    assert_memory_equal(a->out_bytes, b->out_bytes, sizeof b->out_bytes);
}

static void check_finite(const mspring_network *network) {
    for (mspring_id id = 0; id < mspring_network_particle_count(network); id++) {
        const support_point p = support_position(network, id), v = support_velocity(network, id);
        assert_true(isfinite(p.x) && isfinite(p.y) && isfinite(v.x) && isfinite(v.y));
    }
}

static void end(const before *b) {
    check_finite(b->network);
    // Whatever happened, it goes on.
    const mspring_result result = mspring_network_step(b->network, 0.001);
    assert_true(result == MSPRING_OK || result == MSPRING_ERROR_UNSTABLE);
    check_finite(b->network);
    mspring_network_destroy(b->network);
    mspring_builder_destroy(b->builder);
}

/// Whether the call leaves its message in the object that it was called on.
static const char *message_of(const arguments *a, const char *kinds) {
    if (strchr(kinds, 'N') && a->network)
        return mspring_network_error(a->network);
    return strchr(kinds, 'B') && a->builder ? mspring_builder_error(a->builder) : "no place for one";
}

static uint32_t spoilt_calls, refused_calls;

/// Call with one argument spoilt. Returns false if there are not so many ways.
static bool try_spoilt(const function *f, char kind, int n) {
    static arguments a;
    begin(&a);
    f->prepare(&a);
    before b = look(&a);
    const bool there = spoil(&a, kind, n);
    memcpy(b.out_bytes, a.out_bytes, sizeof b.out_bytes);
    if (there) {
        const mspring_result result = f->call(&a);
        spoilt_calls++;
        refused_calls += result != MSPRING_OK;
        if (result == MSPRING_OK && has_to_be_refused(kind, n)) {
            print_error("%s, %c spoilt in way %d: accepted\n", f->name, kind, n);
            fail();
        }
        if (result != MSPRING_OK) {
            if (strlen(message_of(&a, f->kinds)) == 0)
                print_error("%s, %c spoilt in way %d: refused without a message\n", f->name, kind, n);
            assert_true(strlen(message_of(&a, f->kinds)) > 0);
            assert_true(strlen(message_of(&a, f->kinds)) < 512);
            check_unchanged(&b, &a);
        }
    }
    end(&b);
    return there;
}

static void good_calls_succeed(void **state) {
    (void)state;
    static arguments a;
    for (size_t i = 0; i < COUNT_OF(functions); i++) {
        begin(&a);
        functions[i].prepare(&a);
        const before b = look(&a);
        const mspring_result result = functions[i].call(&a);
        if (result != MSPRING_OK)
            print_error("%s: %s%s\n", functions[i].name, mspring_network_error(a.network),
                        mspring_builder_error(a.builder));
        check_ok(result);
        end(&b);
    }
}

static void spoilt_calls_are_refused(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(functions); i++)
        for (const char *kind = functions[i].kinds; *kind; kind++)
            for (int n = 0; try_spoilt(&functions[i], *kind, n); n++) {
            }
    print_message("%u calls of %u functions, %u of them refused\n", spoilt_calls, (unsigned)COUNT_OF(functions),
                  refused_calls);
    assert_true(refused_calls > 800);
}

/* ---------------------------------------------------------------------------------------------- inside a hook */

typedef struct inside {
    const function *f;
    arguments *a;
    mspring_result result;
} inside;

static void call_inside(const mspring_hook_args *args, void *user) {
    (void)args;
    inside *in = user;
    const before b = look(in->a);
    in->result = in->f->call(in->a);
    assert_int_equal(support_hash(b.network), b.hash);
}

static void hooks_cannot_change_the_network(void **state) {
    (void)state;
    static arguments a;
    for (size_t i = 0; i < COUNT_OF(functions); i++) {
        const function *f = &functions[i];
        if (!strchr(f->kinds, 'N') && !strchr(f->kinds, 'n'))
            continue;
        begin(&a);
        f->prepare(&a);
        const before b = look(&a);
        inside in = {f, &a, MSPRING_OK};
        check_ok(support_add_hook(a.network, MSPRING_PHASE_AFTER_SUBSTEP, call_inside, &in, NULL));
        check_ok(mspring_network_step(a.network, 0.001));
        if (strchr(f->kinds, 'N') && in.result != MSPRING_ERROR_BUSY)
            print_error("%s: %s\n", f->name, mspring_result_string(in.result));
        assert_true(in.result == MSPRING_ERROR_BUSY || (!strchr(f->kinds, 'N') && in.result == MSPRING_OK));
        in.f = &functions[0];
        end(&b);
    }
}

/* ------------------------------------------------------------------------------------------------ completeness */

static bool is_in_table(const char *name, size_t length) {
    for (size_t i = 0; i < COUNT_OF(functions); i++)
        if (strlen(functions[i].name) == length && memcmp(functions[i].name, name, length) == 0)
            return true;
    return false;
}

static char *read_header(void) {
    enum { MOST = 1 << 20 };
    FILE *stream = fopen(HOSTILE_HEADER, "rb");
    if (!stream)
        return NULL;
    char *text = test_malloc(MOST);
    text[fread(text, 1, MOST - 1, stream)] = 0;
    fclose(stream);
    return text;
}

static void every_function_is_in_the_table(void **state) {
    (void)state;
    static const char mark[] = "MSPRING_API ", prefix[] = "mspring_";
    char *text = read_header();
    if (!text) { // built on another machine
        print_message("no header at %s\n", HOSTILE_HEADER);
        skip();
    }
    uint32_t found = 0;
    for (char *at = text; (at = strstr(at, mark)) != NULL; at += sizeof mark - 1) {
        const char *end_of_it = strchr(at, ';'), *open = strchr(at, '(');
        const char *line = at;
        while (line > text && line[-1] != '\n')
            line--;
        if (*line == '#')
            continue;
        assert_true(open && end_of_it && open < end_of_it);
        const char *name = open;
        while (name[-1] == '_' || (name[-1] >= 'a' && name[-1] <= 'z') || (name[-1] >= '0' && name[-1] <= '9'))
            name--;
        assert_memory_equal(name, prefix, sizeof prefix - 1);
        if (!is_in_table(name, (size_t)(open - name))) {
            print_error("%.*s is not in the table\n", (int)(open - name), name);
            fail();
        }
        found++;
    }
    assert_int_equal(found, COUNT_OF(functions));
    test_free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_function_is_in_the_table),
        cmocka_unit_test(good_calls_succeed),
        cmocka_unit_test(spoilt_calls_are_refused),
        cmocka_unit_test(hooks_cannot_change_the_network),
    };
    return cmocka_run_group_tests_name("hostile", tests, NULL, NULL);
}
