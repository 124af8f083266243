/// @file test_factor_limit.c
/// A network whose factor would be too large for the direct solver: it is refused, says how large the factor would
/// be, and all stays and goes on as it was. The implicit solver does with few tiles there, or refuses many.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "support.h"

/// Springs at random leave no small part that holds two others apart: the last half of the particles to be
/// eliminated have springs to nearly all others then, which are over 2^29 blocks of 2 x 2.
enum { HALF = 35000, EACH = 8, WIDTH = 250 };

static mspring_network *expander(void) {
    uint64_t seed = 1;
    mspring_builder *builder = support_builder();
    mspring_particle_def *particles = calloc((size_t)2 * HALF, sizeof *particles);
    mspring_spring_def *springs = calloc((size_t)HALF * EACH, sizeof *springs);
    assert_true(particles && springs);
    for (uint32_t i = 0; i < 2 * HALF; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particles[i], sizeof particles[i]));
        particles[i].x = i % WIDTH;
        particles[i].y = i / WIDTH;
    }
    for (uint32_t i = 0; i < HALF * EACH; i++) {
        mspring_spring_def *spring = &springs[i];
        const uint32_t a = i / EACH, share = HALF / EACH;
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, spring, sizeof *spring));
        spring->a = a;
        spring->b = HALF + (a + i % EACH * share + (uint32_t)(support_random(&seed) % share)) % HALF;
        spring->stiffness = 10;
    }
    check_ok(mspring_builder_add_particles(builder, particles, (size_t)2 * HALF, NULL));
    check_ok(mspring_builder_add_springs(builder, springs, (size_t)HALF * EACH, NULL));
    free(particles);
    free(springs);
    const mspring_network_def def = support_def(-9.8f, 1);
    return support_network(builder, &def);
}

static void a_factor_too_large_is_refused(void **state) {
    (void)state;
    mspring_network *network = expander(), *twin = NULL;
    mspring_settings settings;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &settings, sizeof settings));
    settings.substeps = 3;
    check_ok(support_set_solver(network, &settings));
    support_steps(network, 2, 1.0 / 64);
    check_ok(mspring_network_clone(network, NULL, &twin));
    const uint64_t memory = support_memory_used(network);
    settings.solver = MSPRING_SOLVER_DIRECT;
    settings.substeps = 1;
    check_error(support_set_solver(network, &settings), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "70000 particles");
    check_contains(mspring_network_error(network), "280000 springs");
    check_contains(mspring_network_error(network), "would take at least 3.");
    check_contains(mspring_network_error(network), "e+09 numbers (4");
    check_contains(mspring_network_error(network), "more than 1.34e+08");
    assert_int_equal(support_memory_used(network), memory);
    assert_int_equal(support_solver(network).substeps, 3);
    assert_int_equal(support_hash(network), support_hash(twin));
    support_steps(network, 2, 1.0 / 64);
    support_steps(twin, 2, 1.0 / 64);
    assert_int_equal(support_hash(network), support_hash(twin));
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

static void tiles_of_a_random_graph_are_few(void **state) {
    (void)state;
    mspring_network *network = expander(), *twin = NULL;
    mspring_settings settings;
    support_plan plan;
    check_ok(mspring_network_clone(network, NULL, &twin));
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &settings, sizeof settings));
    settings.solver = MSPRING_SOLVER_IMPLICIT;
    // Each of 2 * HALF / 32 cells, and of as many crumbs, has springs to nearly all others.
    settings.tile_size = 8;
    check_error(support_set_solver(network, &settings), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "tiles of size 8");
    check_contains(mspring_network_error(network), "more than 1.7e+10");
    assert_int_equal(support_hash(network), support_hash(twin));
    support_steps(network, 1, 1.0 / 64);
    support_steps(twin, 1, 1.0 / 64);
    assert_int_equal(support_hash(network), support_hash(twin));
    settings.tile_size = 0;
    check_ok(support_set_solver(network, &settings));
    check_ok(support_get_plan(network, &plan));
    assert_in_range(plan.tile_size, 64, 256);
    assert_in_range(plan.tile_count, 1, 2 * HALF / 8);
    assert_true(support_memory_used(network) < (uint64_t)100 << 20);
    support_steps(network, 2, 1.0 / 64);
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

/// Where all is pinned, there is no tile, but particles may be freed later.
static void pinned_particles_leave_no_room_for_more(void **state) {
    (void)state;
    mspring_network *network = expander();
    mspring_settings settings;
    const float pinned = 0;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &settings, sizeof settings));
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, MSPRING_ALL, &pinned, 0));
    settings.solver = MSPRING_SOLVER_IMPLICIT;
    settings.tile_size = 8;
    check_error(support_set_solver(network, &settings), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "more than 1.7e+10");
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_factor_too_large_is_refused),
        cmocka_unit_test(tiles_of_a_random_graph_are_few),
        cmocka_unit_test(pinned_particles_leave_no_room_for_more),
    };
    return cmocka_run_group_tests_name("factor_limit", tests, NULL, NULL);
}
