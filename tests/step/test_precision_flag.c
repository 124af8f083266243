/// @file test_precision_flag.c
/// MSPRING_NETWORK_PRECISE: stiff networks do not tremble far from the origin, and low words count alike at every
/// level, for any number of workers and in whatever a network becomes.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "level.h"
#include "recipe.h"
#include "snapshots.h"
#include "support.h"

static mspring_simd level;

/// The largest speed in the second second of a bar of iron, 6.76e7 N/m, that was settled at a distance from the
/// local origin and hangs by its left end.
static double trembling_of(uint32_t width, double distance, uint32_t substeps, uint32_t flags, bool compact) {
    recipe made = {0};
    uint64_t seed = 1;
    const recipe_stuff iron = {.mass = {73.4, 73.4}, .stiffness = {6.76e7, 6.76e7}};
    recipe_lattice(&made, width, 5, distance, 0, 1, &iron, &seed);
    for (mspring_id p = 0; p < made.particle_count; p += width) {
        made.particles[p].flags = MSPRING_PARTICLE_PINNED;
    }
    recipe_particle(&made, -distance - width, 0, 1, MSPRING_PARTICLE_PINNED); // the other end of the scene
    mspring_network_def def = support_def(-9.8f, substeps);
    def.simd_level = level;
    def.flags = flags;
    def.settings.global_damping = 5;
    mspring_network *network = recipe_network(&made, &def);
    if (compact) { // a layout without the last spring
        const mspring_id last = made.spring_count - 1;
        check_ok(mspring_network_break_springs(network, &last, 0, 1));
        check_ok(mspring_network_compact(network));
    }
    check_ok(mspring_network_settle(network, NULL, NULL));
    double fastest = 0;
    for (int step = 0; step < 128; step++) {
        support_steps(network, 1, 1.0 / 64);
        for (mspring_id p = 0; step >= 64 && p < 5 * width; p++) {
            const support_point v = support_velocity(network, p);
            fastest = fmax(fastest, hypot(v.x, v.y));
        }
    }
    mspring_network_destroy(network);
    recipe_free(&made);
    return fastest;
}

// A length is rounded by 2^-25 of it, so a force by 2 N and a velocity in each substep by 7e-6 m/s, on all eight
// sides. What gathers of that while 5 / s damp it is 0.0004 m/s, and the largest of some hundred thousand such
// numbers four to five times that. Without low words half a unit of the coordinate, 3e-5 m, takes the place of 3e-8
// m.
static void a_stiff_network_does_not_tremble(void **state) {
    (void)state;
    const double least = 0.004;
    assert_true(trembling_of(200, 0, 64, MSPRING_NETWORK_PRECISE, false) < least);
    assert_true(trembling_of(200, 900, 64, MSPRING_NETWORK_PRECISE, false) < least);
    assert_true(trembling_of(200, 900, 256, MSPRING_NETWORK_PRECISE, true) < least);
    assert_true(trembling_of(1800, 900, 64, MSPRING_NETWORK_PRECISE, false) < least);
    assert_true(trembling_of(200, 900, 64, 0, false) > 100 * least);
}

/// What springs there may be: lattices with holes, ropes between them and upright ones, springs across, a random
/// graph, small trees of one shape, loose particles.
static recipe springs_of_all_kinds(double damping) {
    uint64_t seed = 17;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {1000, 3000}, .damping = {0, damping}, .pinned = 0.02, .holes = 0.1};
    recipe made = {0};
    const mspring_id a = recipe_lattice(&made, 40, 24, 900, 0, 1, &stuff, &seed);
    const mspring_id b = recipe_lattice(&made, 9, 30, 960, 0, 1, &stuff, &seed);
    recipe_rope(&made, a + 3, b + 5, 30, &stuff, &seed);
    recipe_rope(&made, a + 70, b + 25, 17, &stuff, &seed);
    recipe_random_springs(&made, 40, &stuff, &seed);
    for (uint32_t i = 0; i < 40; i++) {
        mspring_id last = recipe_particle(&made, 900 + i, -50, 1, i % 3 == 0 ? MSPRING_PARTICLE_PINNED : 0);
        for (uint32_t node = 1; node < 4; node++) {
            const mspring_id next = recipe_particle(&made, 900 + i, -50 + 1.5 * node, 1, 0);
            recipe_spring(&made, last, next, 1500, damping, 0);
            last = node == 1 ? last : next; // a fork, and a strand on it
        }
        const mspring_id from = recipe_particle(&made, 900 + i, 40, 1, 0);
        recipe_rope(&made, from, recipe_particle(&made, 900 + i, 52, 1, 0), 12, &stuff, &seed);
        recipe_particle(&made, 900 + i, 60, 1, 0);
    }
    recipe_particle(&made, -1000, 0, 1, MSPRING_PARTICLE_PINNED);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    recipe_shuffle(&made, &seed, NULL);
    return made;
}

static mspring_network *precise_network(const recipe *made, mspring_simd of_level, uint32_t workers,
                                        uint32_t flags) {
    mspring_network_def def = support_def(-9.8f, 8);
    def.simd_level = of_level;
    def.worker_count = workers;
    def.flags = flags;
    def.spare_springs = 10;
    return recipe_network(made, &def);
}

static void join_some(mspring_network *network) {
    mspring_spring_def added[5];
    mspring_id ids[5];
    for (uint32_t i = 0; i < COUNT_OF(added); i++) {
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &added[i], sizeof added[i]));
        added[i].a = 100 * i;
        added[i].b = 100 * i + 57;
        added[i].stiffness = 100;
    }
    check_ok(mspring_network_add_springs(network, added, COUNT_OF(added), ids));
}

/// Ten steps, some with forces, then some with springs that were added, and after a compaction.
static uint64_t run_all_kinds(mspring_network *network) {
    uint64_t hash = 0;
    for (uint32_t step = 0; step < 10; step++) {
        if (step % 3 == 1) {
            check_ok(mspring_network_apply_force(network, step, 30, 200));
        }
        if (step == 6) {
            join_some(network);
        }
        support_steps(network, 1, 1.0 / 64);
        hash = (hash << 7 | hash >> 57) ^ support_hash(network);
    }
    return hash;
}

static void low_words_count_alike_everywhere(void **state) {
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        recipe made = springs_of_all_kinds(damped ? 5 : 0);
        mspring_network *network = precise_network(&made, MSPRING_SIMD_SCALAR, 1, MSPRING_NETWORK_PRECISE);
        const uint64_t expected = run_all_kinds(network);
        mspring_network_destroy(network);
        for (uint32_t workers = 1; workers <= 3; workers++) {
            network = precise_network(&made, level, workers, MSPRING_NETWORK_PRECISE);
            level_check(network, level);
            assert_int_equal(run_all_kinds(network), expected);
            mspring_network_destroy(network);
        }
        network = precise_network(&made, level, 1, 0);
        assert_int_not_equal(run_all_kinds(network), expected);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Clones, snapshots and compacted networks go on as the original.
static void low_words_count_for_good(void **state) {
    (void)state;
    recipe made = springs_of_all_kinds(5);
    mspring_network *network = precise_network(&made, level, 1, MSPRING_NETWORK_PRECISE);
    mspring_network *other = precise_network(&made, level, 1, MSPRING_NETWORK_PRECISE);
    mspring_network *clone = NULL;
    run_all_kinds(network);
    check_ok(mspring_network_clone(network, NULL, &clone));
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    const mspring_id broken = 3;
    mspring_network *const all[] = {network, clone, other};
    for (size_t i = 0; i < COUNT_OF(all); i++) {
        check_ok(mspring_network_break_springs(all[i], &broken, 0, 1));
        check_ok(mspring_network_compact(all[i]));
        support_steps(all[i], 5, 1.0 / 64);
    }
    for (mspring_id p = 0; p < made.particle_count; p++) {
        const support_point expected = support_position(network, p);
        for (size_t i = 1; i < COUNT_OF(all); i++) {
            assert_true(support_position(all[i], p).x == expected.x && support_position(all[i], p).y == expected.y);
        }
    }
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    mspring_network_destroy(clone);
    recipe_free(&made);
}

static void snapshots_of_the_other_kind_are_refused(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    mspring_network *precise = precise_network(&made, level, 1, MSPRING_NETWORK_PRECISE);
    mspring_network *usual = precise_network(&made, level, 1, 0);
    saved of_precise = snapshots_save(precise, MSPRING_SNAPSHOT_ALL),
          of_usual = snapshots_save(usual, MSPRING_SNAPSHOT_FRAME);
    snapshots_check_refused(usual, &of_precise, "saved with MSPRING_NETWORK_PRECISE");
    snapshots_check_refused(precise, &of_usual, "saved without MSPRING_NETWORK_PRECISE");
    uint64_t size = 0;
    snapshots_put_word(snapshots_section_of(&of_precise, "prec", &size), 2);
    assert_int_equal(size, 4);
    snapshots_check_refused(precise, &of_precise, "precision");
    free(of_precise.bytes);
    free(of_usual.bytes);
    mspring_network_destroy(precise);
    mspring_network_destroy(usual);
    recipe_free(&made);
}

// Precise networks keep first words on a grid, so the rounding of positions differs.
static void to_implicit_solvers_low_words_always_count(void **state) {
    (void)state;
    recipe made = springs_of_all_kinds(5);
    for (mspring_solver solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_network *networks[2];
        for (uint32_t i = 0; i < 2; i++) {
            mspring_network_def def = support_def(-9.8f, 2);
            def.settings.solver = solver;
            def.flags = i == 0 ? 0 : MSPRING_NETWORK_PRECISE;
            networks[i] = recipe_network(&made, &def);
            support_set_residual(networks[i], 0); // as many iterations in both
            support_steps(networks[i], 5, 1.0 / 64);
        }
        for (mspring_id p = 0; p < mspring_network_count(networks[0], MSPRING_PARTICLES); p++) {
            double x[2], y[2];
            for (uint32_t i = 0; i < 2; i++)
                assert_int_equal(mspring_network_get_positions(networks[i], &p, 0, 1, &x[i], &y[i], 1), MSPRING_OK);
            assert_true(hypot(x[1] - x[0], y[1] - y[0]) <= 1e-6); // rounding of forces: single precision
        }
        mspring_network_destroy(networks[0]);
        mspring_network_destroy(networks[1]);
    }
    recipe_free(&made);
}

static void MSPRING_CALL stop(const mspring_hook_args *args, void *user) {
    float *const arrays[] = {args->vx, args->vy};
    arrays[*(const int *)user][args->slot_of_particle[0]] = 0;
}

/// A velocity that a hook sets to 0 after a step is 0 in the next: the low word of the former one has gone.
static void what_a_hook_stops_stands_still(void **state) {
    (void)state;
    for (int axis = 0; axis < 2; axis++) {
        mspring_builder *builder = support_builder();
        (void)support_particle(builder, 0, 0, 1);
        mspring_network_def def = support_def(-9.8f, 1);
        def.flags = MSPRING_NETWORK_PRECISE;
        def.simd_level = level;
        def.settings.gravity_x = -9.8f;
        def.settings.global_damping = 0.3f;
        mspring_network *network = support_network(builder, &def);
        mspring_id hook;
        support_steps(network, 5, 1.0 / 60);
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, stop, &axis, &hook));
        support_steps(network, 1, 1.0 / 60);
        check_ok(mspring_network_remove_hook(network, hook));
        mspring_settings settings = support_settings(network);
        settings.gravity_x = settings.gravity_y = settings.global_damping = 0;
        check_ok(mspring_network_set_settings(network, &settings));
        support_steps(network, 1, 1.0 / 60);
        const support_point v = support_velocity(network, 0);
        assert_true((axis == 0 ? v.x : v.y) == 0 && (axis == 0 ? v.y : v.x) < -0.5);
        mspring_network_destroy(network);
    }
}

int main(int argc, char **argv) {
    level = level_from_arguments(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stiff_network_does_not_tremble),
        cmocka_unit_test(low_words_count_alike_everywhere),
        cmocka_unit_test(low_words_count_for_good),
        cmocka_unit_test(snapshots_of_the_other_kind_are_refused),
        cmocka_unit_test(to_implicit_solvers_low_words_always_count),
        cmocka_unit_test(what_a_hook_stops_stands_still),
    };
    return cmocka_run_group_tests_name("precision_flag", tests, NULL, NULL);
}
