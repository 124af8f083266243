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
    assert_int_equal(mspring_particle_def_init(&particle, sizeof particle), MSPRING_OK);
    assert_int_equal(mspring_builder_add_particle(builder, &particle, NULL), MSPRING_OK);
    mspring_network_def def;
    assert_int_equal(mspring_network_def_init(&def, sizeof def), MSPRING_OK);
    def.worker_count = 2;
    assert_int_equal(mspring_network_create(builder, &def, &network), MSPRING_OK);
    assert_int_equal(mspring_network_worker_count(network), features & MSPRING_FEATURE_THREADS ? 2 : 1);
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
}

static void every_result_has_its_own_name(void **state) {
    (void)state;
    for (mspring_result a = MSPRING_ERROR_SNAPSHOT; a <= MSPRING_OK; a++) {
        assert_non_null(mspring_result_string(a));
        assert_true(strlen(mspring_result_string(a)) > 0);
        for (mspring_result b = MSPRING_ERROR_SNAPSHOT; b < a; b++) {
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
    const mspring_simd best = mspring_simd_supported();
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
    check_ok(mspring_particle_def_init(&def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.flags, 0);
    assert_true(def.x == 0 && def.y == 0 && def.vx == 0 && def.vy == 0 && def.mass == 1);
}

static void spring_defaults(void **state) {
    (void)state;
    mspring_spring_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_spring_def_init(&def, sizeof def));
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
    check_ok(mspring_material_init(&material, sizeof material));
    assert_int_equal(material.struct_size, sizeof material);
    assert_int_equal(material.particle_flags, 0);
    assert_int_equal(material.spring_flags, 0);
    assert_true(material.mass == 1 && material.stiffness == 0 && material.damping == 0);
}

static void lattice_defaults(void **state) {
    (void)state;
    mspring_lattice_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_lattice_def_init(&def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.material_count, 0);
    assert_true(def.x == 0 && def.y == 0 && def.spacing == 1);
    assert_null(def.cells);
    assert_null(def.materials);
}

static void rope_defaults(void **state) {
    (void)state;
    mspring_rope_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_rope_def_init(&def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.spring_flags, 0);
    assert_int_equal(def.from, MSPRING_NONE);
    assert_int_equal(def.to, MSPRING_NONE);
    assert_int_equal(def.segment_count, 1);
    assert_true(def.mass == 1 && def.stiffness == 0 && def.damping == 0 && def.slack == 1);
}

static void solver_defaults(void **state) {
    (void)state;
    mspring_solver_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_solver_def_init(&def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.solver, MSPRING_SOLVER_EXPLICIT);
    assert_int_equal(def.substeps, MSPRING_SUBSTEPS_AUTO);
    assert_int_equal(def.max_substeps, 1000);
}

static void network_defaults(void **state) {
    (void)state;
    mspring_network_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_network_def_init(&def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.simd_level, MSPRING_SIMD_AUTO);
    assert_int_equal(def.solver, MSPRING_SOLVER_EXPLICIT);
    assert_int_equal(def.substeps, MSPRING_SUBSTEPS_AUTO);
    assert_int_equal(def.max_substeps, 1000);
    assert_true(def.gravity_x == 0 && def.gravity_y == -9.8f && def.global_damping == 0 && def.max_speed == 1e6f);
    assert_int_equal(def.guard, MSPRING_GUARD_CLAMP);
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
    check_ok(mspring_settings_init(&settings, sizeof settings));
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
    check_ok(mspring_allocator_init(&allocator, sizeof allocator));
    check_ok(mspring_tasks_init(&tasks, sizeof tasks));
    assert_int_equal(allocator.struct_size, sizeof allocator);
    assert_true(!allocator.alloc && !allocator.free && !allocator.user);
    check_error(mspring_builder_create(&allocator, &builder), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(tasks.struct_size, sizeof tasks);
    assert_int_equal(tasks.worker_count, 1);
    assert_int_equal(tasks.concurrent_count, 1);
    assert_int_equal(tasks.reserved, 0);
    assert_true(!tasks.run && !tasks.user);
}

/* ------------------------------------------------------------------------------------------------- sizes */

#define INIT(name, type)                                                                                           \
    static mspring_result init_##name(void *def, size_t size) {                                                    \
        return mspring_##name##_init((type *)def, size);                                                           \
    }
INIT(particle_def, mspring_particle_def)
INIT(spring_def, mspring_spring_def)
INIT(material, mspring_material)
INIT(lattice_def, mspring_lattice_def)
INIT(rope_def, mspring_rope_def)
INIT(solver_def, mspring_solver_def)
INIT(network_def, mspring_network_def)

static void hook_defaults(void **state) {
    (void)state;
    mspring_hook_def def;
    memset(&def, 0xff, sizeof def);
    check_ok(mspring_hook_def_init(&def, sizeof def));
    assert_int_equal(def.struct_size, sizeof def);
    assert_int_equal(def.phase, MSPRING_PHASE_BEFORE_STEP);
    assert_true(def.fn == NULL);
    assert_null(def.user);
    assert_int_equal(def.period, 1);
    assert_int_equal(def.flags, 0);
    assert_int_equal(def.range_slots, 0);
    assert_null(def.storage);
    assert_int_equal(def.storage_stride, 0);
}
INIT(hook_def, mspring_hook_def)

static void init_refuses_null_and_other_sizes(void **state) {
    (void)state;
    const struct {
        mspring_result (*init)(void *, size_t);
        size_t size;
    } inits[] = {
        {init_particle_def, sizeof(mspring_particle_def)}, {init_spring_def, sizeof(mspring_spring_def)},
        {init_material, sizeof(mspring_material)},         {init_lattice_def, sizeof(mspring_lattice_def)},
        {init_rope_def, sizeof(mspring_rope_def)},         {init_solver_def, sizeof(mspring_solver_def)},
        {init_network_def, sizeof(mspring_network_def)},   {init_hook_def, sizeof(mspring_hook_def)},
    };
    for (size_t i = 0; i < COUNT_OF(inits); i++) {
        const size_t bad[] = {0, 4, inits[i].size - 1, inits[i].size + 1, 4096, SIZE_MAX};
        _Alignas(16) unsigned char memory[256], before[256];
        memset(memory, 0x5a, sizeof memory);
        memcpy(before, memory, sizeof memory);
        check_error(inits[i].init(NULL, inits[i].size), MSPRING_ERROR_ARGUMENT);
        for (size_t j = 0; j < COUNT_OF(bad); j++) {
            check_error(inits[i].init(memory, bad[j]), MSPRING_ERROR_STRUCT);
            assert_memory_equal(memory, before, sizeof memory);
        }
        check_ok(inits[i].init(memory, inits[i].size));
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
        cmocka_unit_test(init_refuses_null_and_other_sizes),
    };
    return cmocka_run_group_tests_name("header", tests, NULL, NULL);
}
