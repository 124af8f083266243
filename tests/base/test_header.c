/// @file test_header.c
/// Versions, result strings, and the init functions: the documented defaults, and no size but the right one.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <string.h>

#include "support.h"

static void version_is_that_of_the_header(void **state) {
    (void)state;
    char text[64];
    snprintf(text, sizeof text, "%d.%d.%d", MSPRING_VERSION_MAJOR, MSPRING_VERSION_MINOR, MSPRING_VERSION_PATCH);
    assert_int_equal(mspring_version(), MSPRING_VERSION);
    assert_string_equal(mspring_version_string(), text);
}

// The tests link the static library of a hosted build.
static void features_are_those_of_the_build(void **state) {
    (void)state;
    const uint32_t features = mspring_features();
    assert_true(features & MSPRING_FEATURE_HOSTED);
    assert_false(features & MSPRING_FEATURE_SHARED);
    const uint32_t solvers_and_parts = MSPRING_FEATURE_IMPLICIT | MSPRING_FEATURE_DIRECT | MSPRING_FEATURE_FLOOR |
                                       MSPRING_FEATURE_CONTACT | MSPRING_FEATURE_LAWS | MSPRING_FEATURE_BATCH |
                                       MSPRING_FEATURE_LAB;
    assert_int_equal(features & ~(uint32_t)(MSPRING_FEATURE_HOSTED | MSPRING_FEATURE_THREADS), solvers_and_parts);

    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    assert_int_equal(mspring_builder_create(NULL, &builder), MSPRING_OK);
    mspring_particle_def particle;
    assert_int_equal(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle), MSPRING_OK);
    assert_int_equal(mspring_builder_add_particles(builder, &particle, 1, NULL), MSPRING_OK);
    mspring_network_def def;
    assert_int_equal(mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def), MSPRING_OK);
    def.worker_count = 2;
    assert_int_equal(mspring_network_create(builder, &def, &network), MSPRING_OK);
    assert_int_equal(support_worker_count(network), features & MSPRING_FEATURE_THREADS ? 2 : 1);
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
}

static void every_result_has_its_own_name(void **state) {
    (void)state;
    for (mspring_result a = MSPRING_ERROR_REFUSED; a <= MSPRING_OK; a++) {
        assert_non_null(mspring_result_string(a));
        assert_true(strlen(mspring_result_string(a)) > 0);
        for (mspring_result b = MSPRING_ERROR_REFUSED; b < a; b++) {
            assert_string_not_equal(mspring_result_string(a), mspring_result_string(b));
        }
    }
    assert_non_null(mspring_result_string(1));
    assert_non_null(mspring_result_string(INT32_MIN));
    assert_string_not_equal(mspring_result_string(1), mspring_result_string(MSPRING_OK));
}

static void simd_levels_have_the_names_of_the_variable(void **state) {
    (void)state;
    assert_string_equal(mspring_simd_name(MSPRING_SIMD_AUTO), "auto");
    assert_string_equal(mspring_simd_name(MSPRING_SIMD_SCALAR), "scalar");
    assert_string_equal(mspring_simd_name(MSPRING_SIMD_SSE2), "sse2");
    assert_string_equal(mspring_simd_name(MSPRING_SIMD_AVX2), "avx2");
    assert_string_equal(mspring_simd_name(MSPRING_SIMD_AVX512), "avx512");
    assert_string_equal(mspring_simd_name(-1), "unknown");
    assert_string_equal(mspring_simd_name(MSPRING_SIMD_NEON), "neon");
    assert_string_equal(mspring_simd_name(MSPRING_SIMD_WASM), "wasm");
    assert_string_equal(mspring_simd_name(MSPRING_SIMD_WASM + 1), "unknown");
}

static void simd_levels_are_those_of_one_kind_of_cpu(void **state) {
    (void)state;
    const mspring_simd best = support_best_level();
    assert_in_range(best, MSPRING_SIMD_SCALAR, MSPRING_SIMD_WASM);
    assert_int_equal(mspring_simd_available(MSPRING_SIMD_AUTO), 1);
    if (best == MSPRING_SIMD_SCALAR) {
        assert_int_equal(mspring_simd_available(MSPRING_SIMD_SCALAR), 1);
    }
    assert_int_equal(mspring_simd_available(best), 1);
    assert_int_equal(mspring_simd_available(-1), 0);
    assert_int_equal(mspring_simd_available(MSPRING_SIMD_WASM + 1), 0);
    assert_int_equal(mspring_simd_available(MSPRING_SIMD_NEON), best == MSPRING_SIMD_NEON);
    assert_int_equal(mspring_simd_available(MSPRING_SIMD_WASM), best == MSPRING_SIMD_WASM);
    // Each x86 level brings those below it.
    for (mspring_simd level = MSPRING_SIMD_SSE2; level <= MSPRING_SIMD_AVX512; level++) {
        assert_int_equal(mspring_simd_available(level), level <= best && best < MSPRING_SIMD_NEON);
    }
}

/* ---------------------------------------------------------------------------------------------- defaults */

static void particle_defaults(void **state) {
    (void)state;
    mspring_particle_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.flags, 0);
    assert_true(def.x == 0 && def.y == 0 && def.vx == 0 && def.vy == 0 && def.mass == 1);
}

static void spring_defaults(void **state) {
    (void)state;
    mspring_spring_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.flags, 0);
    assert_int_equal(def.a, MSPRING_NONE);
    assert_int_equal(def.b, MSPRING_NONE);
    assert_true(def.stiffness == 0 && def.damping == 0 && def.rest_length == MSPRING_REST_LENGTH_DISTANCE);
}

static void material_defaults(void **state) {
    (void)state;
    mspring_material material;
    memset(&material, 0xff, sizeof material);
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    assert_int_equal(material.struct_size, sizeof material);
    assert_int_equal(material.particle_flags, 0);
    assert_int_equal(material.spring_flags, 0);
    assert_true(material.mass == 1 && material.stiffness == 0 && material.damping == 0);
}

static void lattice_defaults(void **state) {
    (void)state;
    mspring_lattice_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.material_count, 1);
    assert_true(def.x == 0 && def.y == 0 && def.spacing == 1);
    assert_null(def.cells);
    assert_null(def.materials);
}

static void rope_defaults(void **state) {
    (void)state;
    mspring_rope_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_null(def.material);
    assert_int_equal(def.from, MSPRING_NONE);
    assert_int_equal(def.to, MSPRING_NONE);
    assert_int_equal(def.segment_count, 1);
    assert_true(def.length_ratio == 1);
}

static void solver_defaults(void **state) {
    (void)state;
    mspring_settings def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.solver, MSPRING_SOLVER_EXPLICIT);
    assert_int_equal(def.substeps, MSPRING_SUBSTEPS_AUTO);
    assert_int_equal(def.max_substeps, 1000);
}

static void network_defaults(void **state) {
    (void)state;
    mspring_network_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.settings.struct_size, sizeof def.settings);
    assert_int_equal(def.simd_level, MSPRING_SIMD_AUTO);
    assert_int_equal(def.settings.solver, MSPRING_SOLVER_EXPLICIT);
    assert_int_equal(def.settings.substeps, MSPRING_SUBSTEPS_AUTO);
    assert_int_equal(def.settings.max_substeps, 1000);
    assert_true(def.settings.gravity_x == 0 && def.settings.gravity_y == -9.8f &&
                def.settings.global_damping == 0 && def.settings.max_speed == 1e6f);
    assert_int_equal(def.settings.guard, MSPRING_GUARD_CLAMP);
    assert_null(def.allocator);
    assert_null(def.tasks);
    assert_int_equal(def.worker_count, 1);
}

static void settings_defaults_are_those_of_a_new_network(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network *network = support_network(builder, NULL);
    mspring_settings settings;
    memset(&settings, 0xff, sizeof settings);
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &settings, sizeof settings));
    const mspring_settings new_ones = support_settings(network);
    assert_memory_equal(&settings, &new_ones, sizeof settings);
    mspring_network_destroy(network);
}

static void allocator_and_tasks_lack_what_the_host_must_set(void **state) {
    (void)state;
    mspring_allocator allocator;
    mspring_tasks tasks;
    mspring_builder *builder = NULL;
    memset(&allocator, 0xff, sizeof allocator);
    memset(&tasks, 0xff, sizeof tasks);
    check_ok(mspring_init(MSPRING_STRUCT_ALLOCATOR, &allocator, sizeof allocator));
    check_ok(mspring_init(MSPRING_STRUCT_TASKS, &tasks, sizeof tasks));
    assert_int_equal(allocator.struct_size, sizeof allocator);
    assert_true(!allocator.alloc && !allocator.free && !allocator.user);
    check_error(mspring_builder_create(&allocator, &builder), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(tasks.struct_size, sizeof tasks);
    assert_int_equal(tasks.worker_count, 1);
    assert_int_equal(tasks.concurrent_count, 1);
    assert_int_equal(tasks.reserved, 0);
    assert_true(!tasks.run && !tasks.user && !tasks.release);
}

/* ------------------------------------------------------------------------------------------------- sizes */

static void hook_defaults(void **state) {
    (void)state;
    mspring_hook_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.phase, MSPRING_PHASE_BEFORE_STEP);
    assert_true(def.fn == NULL);
    assert_null(def.user);
    assert_true(!def.retain && !def.release);
    assert_int_equal(def.period, 1);
    assert_int_equal(def.flags, 0);
    assert_int_equal(def.range_slots, 0);
    assert_null(def.storage);
    assert_int_equal(def.storage_stride, 0);
}

/// The inline form of the header is mspring_init(), for each struct that a host fills or has filled.
static void inline_defaults_are_those_of_init(void **state) {
    (void)state;
#define SAME(type, KIND)                                                                                           \
    do {                                                                                                           \
        const mspring_##type made = mspring_##type##_default();                                                    \
        mspring_##type filled;                                                                                     \
        memset(&filled, 0xff, sizeof filled);                                                                      \
        check_ok(mspring_init(MSPRING_STRUCT_##KIND, &filled, sizeof filled));                                     \
        assert_int_equal(made.struct_size, sizeof made);                                                           \
        assert_memory_equal(&made, &filled, sizeof made);                                                          \
    } while (0)
    SAME(allocator, ALLOCATOR);
    SAME(tasks, TASKS);
    SAME(particle_def, PARTICLE_DEF);
    SAME(spring_def, SPRING_DEF);
    SAME(material, MATERIAL);
    SAME(lattice_def, LATTICE_DEF);
    SAME(rope_def, ROPE_DEF);
    SAME(mesh_def, MESH_DEF);
    SAME(disc_def, DISC_DEF);
    SAME(settings, SETTINGS);
    SAME(network_def, NETWORK_DEF);
    SAME(clone_def, CLONE_DEF);
    SAME(network_info, NETWORK_INFO);
    SAME(step_info, STEP_INFO);
    SAME(view, VIEW);
    SAME(energy, ENERGY);
    SAME(body, BODY);
    SAME(hook_def, HOOK_DEF);
    SAME(floor_def, FLOOR_DEF);
    SAME(contact_def, CONTACT_DEF);
    SAME(contact_info, CONTACT_INFO);
    SAME(contact_event, CONTACT_EVENT);
    SAME(collider_def, COLLIDER_DEF);
    SAME(grip_def, GRIP_DEF);
    SAME(area_def, AREA_DEF);
    SAME(angle_def, ANGLE_DEF);
    SAME(settle_def, SETTLE_DEF);
    SAME(settle_result, SETTLE_RESULT);
    SAME(tune_scene, TUNE_SCENE);
    SAME(tune_def, TUNE_DEF);
    SAME(tune_row, TUNE_ROW);
#undef SAME
}

/// Kinds and bit 7 of a property's value, which bindings rely on instead of a list.
static void properties_tell_their_kind_and_type(void **state) {
    (void)state;
    const struct {
        mspring_property property;
        mspring_kind kind;
        bool is_integer;
    } some[] = {
        {MSPRING_MASS, MSPRING_PARTICLES, false},    {MSPRING_SLOT, MSPRING_PARTICLES, true},
        {MSPRING_STIFFNESS, MSPRING_SPRINGS, false}, {MSPRING_END_B, MSPRING_SPRINGS, true},
        {MSPRING_PRESSURE, MSPRING_ELEMENTS, false}, {MSPRING_ELEMENT_FLAGS, MSPRING_ELEMENTS, true},
        {MSPRING_GROUP_X, MSPRING_GROUPS, false},    {MSPRING_GROUP_FLAGS, MSPRING_GROUPS, true},
        {MSPRING_SIGNAL, MSPRING_ACTUATORS, false},  {MSPRING_ACTUATOR_SPRING, MSPRING_ACTUATORS, true},
    };
    for (size_t i = 0; i < COUNT_OF(some); i++) {
        assert_int_equal((uint32_t)some[i].property >> 8, some[i].kind);
        assert_int_equal(((uint32_t)some[i].property & 0x80) != 0, some[i].is_integer);
    }
}

static void init_refuses_null_and_other_sizes(void **state) {
    (void)state;
    const struct {
        mspring_struct kind;
        size_t size;
    } inits[] = {
        {MSPRING_STRUCT_PARTICLE_DEF, sizeof(mspring_particle_def)},
        {MSPRING_STRUCT_SPRING_DEF, sizeof(mspring_spring_def)},
        {MSPRING_STRUCT_MATERIAL, sizeof(mspring_material)},
        {MSPRING_STRUCT_LATTICE_DEF, sizeof(mspring_lattice_def)},
        {MSPRING_STRUCT_ROPE_DEF, sizeof(mspring_rope_def)},
        {MSPRING_STRUCT_SETTINGS, sizeof(mspring_settings)},
        {MSPRING_STRUCT_NETWORK_DEF, sizeof(mspring_network_def)},
        {MSPRING_STRUCT_HOOK_DEF, sizeof(mspring_hook_def)},
    };
    for (size_t i = 0; i < COUNT_OF(inits); i++) {
        const size_t bad[] = {0, 4, inits[i].size - 1, inits[i].size + 1, 4096, SIZE_MAX};
        _Alignas(16) unsigned char memory[512], before[512];
        memset(memory, 0x5a, sizeof memory);
        memcpy(before, memory, sizeof memory);
        check_error(mspring_init(inits[i].kind, NULL, inits[i].size), MSPRING_ERROR_ARGUMENT);
        for (size_t j = 0; j < COUNT_OF(bad); j++) {
            check_error(mspring_init(inits[i].kind, memory, bad[j]), MSPRING_ERROR_STRUCT);
            assert_memory_equal(memory, before, sizeof memory);
        }
        check_error(mspring_init((mspring_struct)27, memory, inits[i].size), MSPRING_ERROR_ARGUMENT);
        check_error(mspring_init((mspring_struct)-1, memory, inits[i].size), MSPRING_ERROR_ARGUMENT);
        assert_memory_equal(memory, before, sizeof memory);
        check_ok(mspring_init(inits[i].kind, memory, inits[i].size));
        assert_memory_equal(memory + inits[i].size, before, sizeof memory - inits[i].size);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(version_is_that_of_the_header),
        cmocka_unit_test(features_are_those_of_the_build),
        cmocka_unit_test(every_result_has_its_own_name),
        cmocka_unit_test(simd_levels_have_the_names_of_the_variable),
        cmocka_unit_test(simd_levels_are_those_of_one_kind_of_cpu),
        cmocka_unit_test(particle_defaults),
        cmocka_unit_test(spring_defaults),
        cmocka_unit_test(material_defaults),
        cmocka_unit_test(lattice_defaults),
        cmocka_unit_test(rope_defaults),
        cmocka_unit_test(solver_defaults),
        cmocka_unit_test(network_defaults),
        cmocka_unit_test(hook_defaults),
        cmocka_unit_test(settings_defaults_are_those_of_a_new_network),
        cmocka_unit_test(allocator_and_tasks_lack_what_the_host_must_set),
        cmocka_unit_test(inline_defaults_are_those_of_init),
        cmocka_unit_test(properties_tell_their_kind_and_type),
        cmocka_unit_test(init_refuses_null_and_other_sizes),
    };
    return cmocka_run_group_tests_name("header", tests, NULL, NULL);
}
