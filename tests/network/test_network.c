/// @file test_network.c
/// Making a network and changing its settings: what is refused, with which message, and that nothing has changed.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "allocator.h"
#include "support.h"

static const float not_finite[] = {NAN, INFINITY, -INFINITY};

/// A triangle with a pinned corner, as a builder.
static mspring_builder *triangle(void) {
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 1);
    support_particle(builder, 1, 0, 1);
    support_particle(builder, 0, 1, 1);
    support_spring(builder, 0, 1, 100, 0);
    support_spring(builder, 1, 2, 100, 0);
    return builder;
}

static mspring_network *const untouched = (mspring_network *)(uintptr_t)16;

/// Making a network is refused, and the place for it is left alone.
#define check_no_network(builder, def, code, part)                                                                 \
    do {                                                                                                           \
        mspring_network *network = untouched;                                                                      \
        check_error(mspring_network_create((builder), (def), &network), (code));                                   \
        check_contains(support_builder_error(builder), (part));                                                    \
        assert_ptr_equal(network, untouched);                                                                      \
    } while (0)

/* ------------------------------------------------------------------------------------------------ creating */

static void defaults_make_a_network(void **state) {
    (void)state;
    mspring_network *network = support_network(triangle(), NULL);
    assert_int_equal(mspring_network_count(network, MSPRING_PARTICLES), 3);
    assert_int_equal(mspring_network_count(network, MSPRING_SPRINGS), 2);
    assert_string_equal(mspring_network_error(network), "");
    assert_true(support_memory_used(network) > 0);
    check_ok(mspring_network_step(network, 0.01));
    // The default gravity, until half a substep ago; an ulp or two of 0.1 and of 0.01.
    const double h = 0.01 / support_step_info(network).substeps;
    check_near(support_velocity(network, 2).y, -9.8 * (0.01 - h / 2), 1e-6);
    mspring_network_destroy(network);
}

/// A network tells of all memory that it has from the host, with that of its workers.
static void all_memory_is_counted(void **state) {
    (void)state;
    mspring_builder *builder = triangle();
    for (uint32_t workers = 1; workers <= 3; workers++) {
        watched_allocator watched = {0};
        const mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 2);
        mspring_network *network = NULL;
        def.allocator = &allocator;
        def.worker_count = workers;
        check_ok(mspring_network_create(builder, &def, &network));
        support_steps(network, 1, 0.01);
        assert_int_equal(support_memory_used(network), watched.live_bytes);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    mspring_builder_destroy(builder);
}

static void empty_builder_is_refused(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    check_no_network(builder, NULL, MSPRING_ERROR_ARGUMENT, "no particle");
    support_particle(builder, 0, 0, 1);
    mspring_network *network = support_network(builder, NULL);
    assert_int_equal(mspring_network_count(network, MSPRING_PARTICLES), 1);
    assert_int_equal(mspring_network_count(network, MSPRING_SPRINGS), 0);
    mspring_network_destroy(network);
}

static void duplicate_springs_are_refused_and_named(void **state) {
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        mspring_builder *builder = support_builder();
        for (int i = 0; i < 60; i++) {
            support_particle(builder, i, 0, 1);
        }
        for (mspring_id i = 0; i < 55; i++) {
            support_spring(builder, i, i + 1, 1, 0);
        }
        // Spring 55 is number 41 again.
        assert_int_equal(support_spring(builder, turned ? 42 : 41, turned ? 41 : 42, 1, 0), 55);
        support_spring(builder, 57, 58, 1, 0);
        check_no_network(builder, NULL, MSPRING_ERROR_DUPLICATE, "41");
        check_no_network(builder, NULL, MSPRING_ERROR_DUPLICATE, "55");
        assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 57);
        mspring_builder_destroy(builder);
    }
}

static void duplicates_inside_lattices_are_found(void **state) {
    (void)state;
    const uint16_t cells[4] = {0, 0, 0, 0};
    mspring_material material;
    mspring_lattice_def lattice;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
    lattice.width = lattice.height = 2;
    lattice.cells = cells;
    lattice.materials = &material;
    lattice.material_count = 1;
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
    support_spring(builder, 3, 0, 5, 0); // the diagonal, which is there as spring 2
    check_no_network(builder, NULL, MSPRING_ERROR_DUPLICATE, "2");
    check_no_network(builder, NULL, MSPRING_ERROR_DUPLICATE, "6");
    mspring_builder_destroy(builder);
}

/// A chain of calls needs one check: the first failure stays, whatever follows, and is the result of creation.
static void a_builder_keeps_its_first_failure(void **state) {
    (void)state;
    mspring_builder *builder = triangle(), *other = support_builder();
    mspring_particle_def particle = mspring_particle_def_default();
    mspring_spring_def spring = mspring_spring_def_default();
    mspring_network *network = untouched;
    const uint32_t count = mspring_builder_count(builder, MSPRING_PARTICLES);
    particle.mass = -7;
    check_error(mspring_builder_add_particles(builder, &particle, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_builder_error(builder), "-7");
    spring.a = 0, spring.b = 99;
    check_error(mspring_builder_add_springs(builder, &spring, 1, NULL), MSPRING_ERROR_ID);
    particle.mass = 1;
    check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL)); // goes on
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), count + 1);
    check_contains(mspring_builder_error(builder), "-7");
    check_error(mspring_network_create(builder, NULL, &network), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_builder_error(builder), "-7");
    assert_ptr_equal(network, untouched);

    // Another that would copy it has the failure then, and says whose it is.
    check_error(mspring_builder_add_copies(other, builder, 1, NULL, NULL, 0, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_builder_error(other), "-7");
    check_error(mspring_network_create(other, NULL, &network), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_builder_error(other), "-7");
    mspring_builder_destroy(other);
    // So has one that was to read what is no archive.
    other = support_builder();
    check_error(mspring_builder_read(other, "no archive", 10, NULL), MSPRING_ERROR_SNAPSHOT);
    check_ok(mspring_builder_add_particles(other, &particle, 1, NULL));
    check_error(mspring_network_create(other, NULL, &network), MSPRING_ERROR_SNAPSHOT);

    mspring_builder_forget_error(NULL);
    mspring_builder_forget_error(builder);
    mspring_builder_forget_error(other);
    assert_string_equal(mspring_builder_error(builder), "");
    check_ok(mspring_network_create(builder, NULL, &network));
    mspring_network_destroy(network);
    check_ok(mspring_network_create(other, NULL, &network));
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    mspring_builder_destroy(other);
}

static void bad_settings_are_refused(void **state) {
    (void)state;
    mspring_builder *builder = triangle();
    const mspring_network_def good = support_def(-9.8f, 1);
#define REFUSED(field, value, code, part)                                                                          \
    do {                                                                                                           \
        mspring_network_def def = good;                                                                            \
        def.field = (value);                                                                                       \
        check_no_network(builder, &def, (code), (part));                                                           \
    } while (0)
    for (size_t i = 0; i < COUNT_OF(not_finite); i++) {
        REFUSED(settings.gravity_x, not_finite[i], MSPRING_ERROR_ARGUMENT, "gravity");
        REFUSED(settings.gravity_y, not_finite[i], MSPRING_ERROR_ARGUMENT, "gravity");
        REFUSED(settings.global_damping, not_finite[i], MSPRING_ERROR_ARGUMENT, "damping");
        REFUSED(settings.max_speed, not_finite[i], MSPRING_ERROR_ARGUMENT, "max_speed");
    }
    REFUSED(settings.global_damping, -1, MSPRING_ERROR_ARGUMENT, "damping");
    REFUSED(settings.global_damping, 1.1e6f, MSPRING_ERROR_ARGUMENT, "damping");
    REFUSED(settings.max_speed, 0, MSPRING_ERROR_ARGUMENT, "max_speed");
    REFUSED(settings.max_speed, -1, MSPRING_ERROR_ARGUMENT, "max_speed");
    REFUSED(settings.max_speed, 1.1e15f, MSPRING_ERROR_ARGUMENT, "max_speed");
    REFUSED(settings.solver, 3, MSPRING_ERROR_ARGUMENT, "solver");
    REFUSED(settings.solver, -1, MSPRING_ERROR_ARGUMENT, "solver");
    REFUSED(settings.substeps, 0, MSPRING_ERROR_ARGUMENT, "substeps");
    REFUSED(settings.substeps, 1000001, MSPRING_ERROR_ARGUMENT, "substeps");
    REFUSED(settings.max_substeps, 0, MSPRING_ERROR_ARGUMENT, "max_substeps");
    REFUSED(settings.guard, -1, MSPRING_ERROR_ARGUMENT, "guard");
    REFUSED(settings.guard, MSPRING_GUARD_CLAMP_BOUNDS + 1, MSPRING_ERROR_ARGUMENT, "guard");
    REFUSED(settings.max_substeps, 1000001, MSPRING_ERROR_ARGUMENT, "max_substeps");
    REFUSED(simd_level, -1, MSPRING_ERROR_ARGUMENT, "simd_level");
    REFUSED(simd_level, MSPRING_SIMD_WASM + 1, MSPRING_ERROR_ARGUMENT, "simd_level");
    REFUSED(struct_size, 0, MSPRING_ERROR_STRUCT, "mspring_network_def");
    REFUSED(struct_size, sizeof good - 8, MSPRING_ERROR_STRUCT, "mspring_network_def");
    REFUSED(struct_size, sizeof good + 2, MSPRING_ERROR_STRUCT, "mspring_network_def");

    mspring_allocator allocator = {.struct_size = sizeof allocator};
    REFUSED(allocator, &allocator, MSPRING_ERROR_ARGUMENT, "alloc");
    allocator.struct_size = 4;
    REFUSED(allocator, &allocator, MSPRING_ERROR_STRUCT, "mspring_allocator");
#undef REFUSED

    mspring_network *network = untouched;
    check_error(mspring_network_create(NULL, &good, &network), MSPRING_ERROR_ARGUMENT);
    assert_ptr_equal(network, untouched);
    check_error(mspring_network_create(builder, &good, NULL), MSPRING_ERROR_ARGUMENT);

    // After all that the builder still makes a network.
    network = support_network(builder, &good);
    check_ok(mspring_network_step(network, 0.01));
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------ settings */

static void bad_solver_is_refused(void **state) {
    (void)state;
    mspring_network_def def = support_def(-9.8f, 2);
    mspring_network *network = support_network(triangle(), &def), *twin = support_network(triangle(), &def);
    mspring_settings good;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &good, sizeof good));
#define REFUSED(field, value, code, part)                                                                          \
    do {                                                                                                           \
        mspring_settings solver = good;                                                                            \
        solver.field = (value);                                                                                    \
        check_error(support_set_solver(network, &solver), (code));                                                 \
        check_contains(mspring_network_error(network), (part));                                                    \
    } while (0)
    REFUSED(substeps, 0, MSPRING_ERROR_ARGUMENT, "substeps");
    REFUSED(substeps, 1000001, MSPRING_ERROR_ARGUMENT, "substeps");
    REFUSED(max_substeps, 0, MSPRING_ERROR_ARGUMENT, "max_substeps");
    REFUSED(max_substeps, 1000001, MSPRING_ERROR_ARGUMENT, "max_substeps");
    REFUSED(solver, 3, MSPRING_ERROR_ARGUMENT, "solver");
    REFUSED(solver, -7, MSPRING_ERROR_ARGUMENT, "solver");
    REFUSED(struct_size, 0, MSPRING_ERROR_STRUCT, "mspring_settings");
    REFUSED(struct_size, sizeof good + 2, MSPRING_ERROR_STRUCT, "mspring_settings");
    good.solver = MSPRING_SOLVER_IMPLICIT;
    REFUSED(integrator, -1, MSPRING_ERROR_ARGUMENT, "integrator");
    REFUSED(integrator, MSPRING_INTEGRATOR_EULER + 1, MSPRING_ERROR_ARGUMENT, "integrator");
    REFUSED(iterations, 10001, MSPRING_ERROR_ARGUMENT, "iterations");
    REFUSED(coarse_period, 10001, MSPRING_ERROR_ARGUMENT, "coarse_period");
    REFUSED(residual, -0.01f, MSPRING_ERROR_ARGUMENT, "residual is -0.01");
    REFUSED(residual, 1.5f, MSPRING_ERROR_ARGUMENT, "residual");
    REFUSED(residual, NAN, MSPRING_ERROR_ARGUMENT, "residual");
    REFUSED(residual, INFINITY, MSPRING_ERROR_ARGUMENT, "residual");
    REFUSED(tile_size, 4, MSPRING_ERROR_ARGUMENT, "tile_size");
    REFUSED(tile_size, 12, MSPRING_ERROR_ARGUMENT, "tile_size");
    REFUSED(tile_size, 512, MSPRING_ERROR_ARGUMENT, "tile_size");
    REFUSED(substeps, 0, MSPRING_ERROR_ARGUMENT, "substeps");
    good.solver = MSPRING_SOLVER_DIRECT;
    REFUSED(integrator, MSPRING_INTEGRATOR_EULER + 1, MSPRING_ERROR_ARGUMENT, "integrator");
#undef REFUSED
    check_error(support_set_solver(network, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "NULL");
    check_error(support_set_solver(NULL, &good), MSPRING_ERROR_ARGUMENT);

    // Still two substeps.
    support_steps(network, 5, 0.02);
    support_steps(twin, 5, 0.02);
    assert_int_equal(support_hash(network), support_hash(twin));
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

static void substeps_are_shorter_steps(void **state) {
    (void)state;
    mspring_network_def def = support_def(0, 1); // the dither of gravity begins anew with each step
    mspring_network *network = support_network(triangle(), &def), *twin = support_network(triangle(), &def);
    support_kick(network, 2, 3);
    support_kick(twin, 2, 3);
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.substeps = 8;
    check_ok(support_set_solver(network, &solver));
    support_steps(network, 10, 0.125); // a power of two: dt / 8 is exact
    support_steps(twin, 80, 0.125 / 8);
    assert_int_equal(support_hash(network), support_hash(twin));
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

static void bad_gravity_and_damping_are_refused(void **state) {
    (void)state;
    mspring_network *network = support_network(triangle(), NULL), *twin = support_network(triangle(), NULL);
    for (size_t i = 0; i < COUNT_OF(not_finite); i++) {
        check_error(support_set_gravity(network, not_finite[i], 0), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "gravity");
        check_error(support_set_gravity(network, 0, not_finite[i]), MSPRING_ERROR_ARGUMENT);
        check_error(support_set_global_damping(network, not_finite[i]), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "damping");
    }
    check_error(support_set_global_damping(network, -0.5f), MSPRING_ERROR_ARGUMENT);
    check_error(support_set_global_damping(network, 1.1e6f), MSPRING_ERROR_ARGUMENT);
    support_steps(network, 5, 0.02);
    support_steps(twin, 5, 0.02);
    assert_int_equal(support_hash(network), support_hash(twin));

    check_ok(support_set_gravity(network, 3, 0));
    check_ok(support_set_global_damping(network, 1e6f));
    check_ok(mspring_network_step(network, 1)); // exp(-1e6): it creeps at gravity / 1e6
    check_near(support_velocity(network, 2).x, 3e-6, 1e-7);
    check_near(support_velocity(network, 2).y, 0, 1e-7);
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

static void null_network_has_nothing(void **state) {
    (void)state;
    assert_int_equal(mspring_network_count(NULL, MSPRING_PARTICLES), 0);
    assert_int_equal(mspring_network_count(NULL, MSPRING_SPRINGS), 0);
    assert_int_equal(support_memory_used(NULL), 0);
    assert_int_equal(support_simd_level(NULL), MSPRING_SIMD_AUTO);
    assert_string_equal(mspring_network_error(NULL), "");
    mspring_network_destroy(NULL);
}

static void plan_counts_what_is_there(void **state) {
    (void)state;
    mspring_network *network = support_network(triangle(), NULL);
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    assert_int_equal(plan.particle_count, 3);
    assert_int_equal(plan.spring_count, 2);
    assert_int_equal(plan.lattice_particles + plan.chain_particles + plan.loose_particles, 3);
    assert_int_equal(plan.lattice_springs + plan.chain_springs + plan.irregular_springs, 2);
    assert_int_equal(plan.has_damping, 0);
    assert_int_equal(plan.has_relative, 0);
    assert_int_equal(plan.simd_level, support_simd_level(network));
    assert_true(plan.slot_count >= 3);

    support_plan before = plan;
    check_error(support_get_plan(NULL, &plan), MSPRING_ERROR_ARGUMENT);
    assert_memory_equal(&plan, &before, sizeof plan);
    mspring_network_destroy(network);
}

/// First words are multiples of the last place of twice the longest rest length, 2^-22 here, from the start.
static void precise_places_begin_on_the_grid(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0.1, 0.3, 1), b = support_particle(builder, 1.1, 0.3, 1);
    support_spring(builder, a, b, 100, 0);
    mspring_network_def def = support_def(0, 1);
    def.flags = MSPRING_NETWORK_PRECISE;
    mspring_network *network = support_network(builder, &def);
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    for (mspring_id p = a; p <= b; p++) {
        const double x = ldexp((double)view.x[view.slot_of_particle[p]], 22);
        assert_true(x == floor(x));
        check_near(support_position(network, p).x, p == a ? 0.1 : 1.1, 1e-12); // both words
    }
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_make_a_network),
        cmocka_unit_test(all_memory_is_counted),
        cmocka_unit_test(empty_builder_is_refused),
        cmocka_unit_test(duplicate_springs_are_refused_and_named),
        cmocka_unit_test(duplicates_inside_lattices_are_found),
        cmocka_unit_test(a_builder_keeps_its_first_failure),
        cmocka_unit_test(bad_settings_are_refused),
        cmocka_unit_test(bad_solver_is_refused),
        cmocka_unit_test(substeps_are_shorter_steps),
        cmocka_unit_test(bad_gravity_and_damping_are_refused),
        cmocka_unit_test(null_network_has_nothing),
        cmocka_unit_test(plan_counts_what_is_there),
        cmocka_unit_test(precise_places_begin_on_the_grid),
    };
    return cmocka_run_group_tests_name("network", tests, NULL, NULL);
}
