/// @file test_step.c
/// Steps that are refused or taken back, and forces that the host gives for one step.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "recipe.h"
#include "support.h"

/// Free particles of 2 kg in a row, no gravity, no springs.
static mspring_network *particles(uint32_t count, uint32_t substeps, float max_speed) {
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < count; i++) {
        support_particle(builder, i, 0, 2);
    }
    mspring_network_def def = support_def(0, substeps);
    def.settings.max_speed = max_speed;
    return support_network(builder, &def);
}

static void bad_dt_is_refused(void **state) {
    (void)state;
    mspring_network *network = particles(3, 4, 1e6f);
    const float vx[] = {1, 2, 3}, vy[] = {0, 0, 0};
    check_ok(mspring_network_set_velocities(network, NULL, 0, 3, vx, vy, 1));
    const uint64_t hash = support_hash(network);
    // The last ones: a substep that is a denormal number, that is nothing, and that is infinite as a float.
    const double bad[] = {0.0, -0.0, -0.01, NAN, INFINITY, -INFINITY, (double)FLT_MIN, 1e-40, 1e-300, 1e40, 1e300};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        check_error(mspring_network_step(network, bad[i]), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "dt");
        assert_int_equal(support_hash(network), hash);
    }
    check_error(mspring_network_step(NULL, 0.01), MSPRING_ERROR_ARGUMENT);
    // The shortest that is none of these.
    check_ok(mspring_network_step(network, 4.0 * (double)FLT_MIN));
    check_ok(mspring_network_step(network, 0.5));
    check_near(support_position(network, 2).x, 2 + 3 * 0.5, 1e-6); // a few ulp
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------- forces */

static void a_force_acts_during_one_step(void **state) {
    (void)state;
    for (uint32_t substeps = 1; substeps <= 8; substeps *= 8) {
        mspring_network *network = particles(40, substeps, 1e6f);
        check_ok(mspring_network_apply_force(network, 17, 8, -16));
        check_ok(mspring_network_step(network, 0.25));
        // F / m dt until half a substep ago, every operation exact in binary.
        const double first = 1 - 0.5 / substeps;
        assert_true(support_velocity(network, 17).x == first && support_velocity(network, 17).y == -2 * first);
        check_ok(mspring_network_step(network, 0.25));
        assert_true(support_velocity(network, 17).x == first && support_velocity(network, 17).y == -2 * first);
        // In later steps velocities are half a substep old at the beginning too.
        check_ok(mspring_network_apply_force(network, 17, 8, -16));
        check_ok(mspring_network_step(network, 0.25));
        assert_true(support_velocity(network, 17).x == first + 1);
        assert_true(support_velocity(network, 17).y == -2 * (first + 1));
        for (mspring_id id = 0; id < 40; id++) {
            if (id != 17) {
                assert_true(support_velocity(network, id).x == 0 && support_velocity(network, id).y == 0);
            }
        }
        mspring_network_destroy(network);
    }
}

static void forces_add_up(void **state) {
    (void)state;
    mspring_network *network = particles(20, 2, 1e6f);
    float x[10], y[10];
    for (int i = 0; i < 10; i++) {
        x[i] = 8.0f * (float)i;
        y[i] = 16;
    }
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 5, 10, x, y, 1));
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 10, 10, x, y, 1));
    check_ok(mspring_network_apply_force(network, 10, 80, 0));
    check_ok(mspring_network_step(network, 0.25));
    for (mspring_id id = 0; id < 20; id++) {
        double fx =
            (id >= 5 && id < 15 ? 8.0 * (id - 5) : 0) + (id >= 10 ? 8.0 * (id - 10) : 0) + (id == 10 ? 80 : 0);
        double fy = (id >= 5 && id < 15 ? 16 : 0) + (id >= 10 ? 16 : 0);
        // F / m for 3/16 s: until half a substep ago.
        assert_true(support_velocity(network, id).x == fx * 3 / 32);
        assert_true(support_velocity(network, id).y == fy * 3 / 32);
    }
    mspring_network_destroy(network);
}

/// Forces side by side and apart, of which none may be NaN, and after whose end nothing is read.
static void strides_end_with_their_array(void **state) {
    (void)state;
    enum { COUNT = 9 };
    for (uint32_t stride = 2; stride <= 3; stride++) {
        mspring_network *network = particles(COUNT, 1, 1e6f);
        float *pairs = malloc((stride * (COUNT - 1) + 2) * sizeof *pairs); // no more, for sanitizers to watch
        assert_non_null(pairs);
        for (uint32_t i = 0; i < stride * (COUNT - 1) + 2; i++)
            pairs[i] = (float)i;
        check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, COUNT, pairs, pairs + 1, stride));
        for (uint32_t i = 0; i < COUNT; i++)
            for (uint32_t axis = 0; axis < 2; axis++) {
                const float was = pairs[stride * i + axis];
                pairs[stride * i + axis] = NAN;
                check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, COUNT, pairs, pairs + 1,
                                                         stride),
                            MSPRING_ERROR_ARGUMENT);
                pairs[stride * i + axis] = was;
            }
        check_ok(mspring_network_step(network, 0.5));
        for (mspring_id id = 0; id < COUNT; id++) { // 2 kg, a quarter of a second
            assert_true(support_velocity(network, id).x == (double)pairs[stride * id] / 8);
            assert_true(support_velocity(network, id).y == (double)pairs[stride * id + 1] / 8);
        }
        free(pairs);
        mspring_network_destroy(network);
    }
}

static void forces_on_springs_and_leftovers_add_to_the_springs(void **state) {
    (void)state;
    // Two equal networks of lattice, rope and leftover springs. A force equal to gravity on each particle of one,
    // gravity on the other.
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {2, 2}, .stiffness = {100, 200}, .damping = {0, 1}, .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 18, 5, 0, 0, 1, &stuff, &seed);
    recipe_rope(&made, 3, 60, 9, &stuff, &seed);
    recipe_random_springs(&made, 12, &stuff, &seed);
    recipe_disturb(&made, 0.05, 1, &seed);
    mspring_network_def with = support_def(-8, 2), without = support_def(0, 2);
    mspring_network *heavy = recipe_network(&made, &with), *pulled = recipe_network(&made, &without);
    for (int step = 0; step < 20; step++) {
        for (mspring_id id = 0; id < made.particle_count; id++) {
            check_ok(mspring_network_apply_force(pulled, id, 0, -16));
        }
        check_ok(mspring_network_step(pulled, 1.0 / 64));
        check_ok(mspring_network_step(heavy, 1.0 / 64));
    }
    for (mspring_id id = 0; id < made.particle_count; id++) {
        support_point a = support_position(heavy, id), b = support_position(pulled, id);
        // Both add the same numbers in another order: 40 roundings of a velocity of up to 8 m/s (2.4e-7 each), for
        // up to 0.3 s, and of a position of up to 16 m (5e-7 each).
        check_near(a.x, b.x, 4e-5);
        check_near(a.y, b.y, 4e-5);
    }
    mspring_network_destroy(heavy);
    mspring_network_destroy(pulled);
    recipe_free(&made);
}

static void pinned_particles_feel_no_force(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 2);
    support_particle(builder, 1, 0, 2);
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_apply_force(network, 0, 100, 100));
    check_ok(mspring_network_step(network, 0.25));
    assert_true(support_position(network, 0).x == 0 && support_velocity(network, 0).x == 0);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------- steps taken back */

static void a_step_out_of_bounds_is_taken_back(void **state) {
    (void)state;
    mspring_network *network = particles(50, 4, 10);
    float vx[50], vy[50];
    for (int i = 0; i < 50; i++) {
        vx[i] = 1;
        vy[i] = 0.25f * (float)(i % 8);
    }
    check_ok(mspring_network_set_velocities(network, NULL, 0, 50, vx, vy, 1));
    check_ok(mspring_network_step(network, 0.125));
    const uint64_t hash = support_hash(network);
    const support_point before = support_position(network, 37);

    check_ok(mspring_network_apply_force(network, 37, 0, 64)); // 64 / 2 * 0.5 = 16 m/s on top
    for (int again = 0; again < 3; again++) {
        check_error(mspring_network_step(network, 0.5), MSPRING_ERROR_UNSTABLE);
        check_contains(mspring_network_error(network), "particle 37");
        assert_int_equal(support_hash(network), hash);
    }
    // The force is still there for the step that succeeds: 64 / 2 * 0.125 = 4 m/s, ...
    check_ok(mspring_network_step(network, 0.125));
    assert_true(support_velocity(network, 37).y == 1.25 + 4);
    assert_true(support_position(network, 37).x == before.x + 0.125);
    // ... and gone after it.
    check_ok(mspring_network_step(network, 0.125));
    assert_true(support_velocity(network, 37).y == 1.25 + 4);
    mspring_network_destroy(network);
}

static void an_explosion_is_taken_back(void **state) {
    (void)state;
    // A hundred times too stiff for its step: it grows tenfold in each. In single substeps the speed limit stops it
    // before anything is infinite; at the end of a step of many substeps everything is NaN, ropes and leftover
    // springs too.
    for (uint32_t substeps = 1; substeps <= 400; substeps *= 400) {
        uint64_t seed = 21;
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e6, 1e6}, .holes = 0.2};
        recipe made = {0};
        recipe_lattice(&made, 40, 9, 0, 0, 1, &stuff, &seed);
        recipe_rope(&made, 3, 90, 20, &stuff, &seed);
        recipe_random_springs(&made, 20, &stuff, &seed);
        recipe_disturb(&made, 1e-4, 0, &seed);
        mspring_network_def def = support_def(0, substeps);
        mspring_network *network = recipe_network(&made, &def);
        uint32_t good_steps = 0;
        mspring_result result = mspring_network_step(network, 0.01 * substeps);
        while (result == MSPRING_OK && good_steps < 100) {
            good_steps++;
            result = mspring_network_step(network, 0.01 * substeps);
        }
        check_error(result, MSPRING_ERROR_UNSTABLE);

        // It is where one is that took the good steps only, ...
        mspring_network *twin = recipe_network(&made, &def);
        support_steps(twin, good_steps, 0.01 * substeps);
        assert_int_equal(support_hash(network), support_hash(twin));
        // ... and goes on as that one does, in steps that are short enough: nothing of the failed step is left in
        // any corner.
        mspring_settings solver;
        check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
        check_ok(support_set_solver(network, &solver));
        check_ok(support_set_solver(twin, &solver));
        support_steps(network, 10, 1e-6);
        support_steps(twin, 10, 1e-6);
        assert_int_equal(support_hash(network), support_hash(twin));
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
        recipe_free(&made);
    }
}

static void what_a_hook_writes_is_checked(void **state) {
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY, 1.1e12f};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        for (int array = 0; array < 4; array++) {
            mspring_network *network = particles(40, 1, 1e6f);
            support_writing writing = {.array = array, .particle = 33, .value = bad[i]};
            (void)support_write_in_step(network, &writing);
            check_error(mspring_network_step(network, 0.01), MSPRING_ERROR_UNSTABLE);
            check_contains(mspring_network_error(network), "33");
            check_ok(mspring_network_step(network, 0.01));
            mspring_network_destroy(network);
        }
    }
}

static void the_speed_limit_is_one(void **state) {
    (void)state;
    mspring_network *network = particles(1, 1, 10);
    const float limit = 10, zero = 0, above = nextafterf(10, 11);
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &limit, &zero, 1));
    check_ok(mspring_network_step(network, 0.1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &zero, &above, 1));
    check_error(mspring_network_step(network, 0.1), MSPRING_ERROR_UNSTABLE);
    mspring_network_destroy(network);
}

/// How fast particles are is reckoned from step to step, and looked at only if that is too much. That must not let a
/// speed through that has come near the limit for long. (Each step adds 1/16 m/s, without rounding.)
static void a_long_fall_ends_at_the_speed_limit(void **state) {
    (void)state;
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {9000, 9000}};
    recipe made = {0};
    recipe_lattice(&made, 5, 5, 0, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(-8, 1);
    def.settings.max_speed = 30.5f / 16 * (1 - 1e-6f);
    mspring_network *network = recipe_network(&made, &def);
    double border = 0;
    check_ok(mspring_network_get_stable_dt(network, &border, NULL));
    assert_true(border > 1.0 / 128 && border < 1.1 / 128); // in some shapes it is shorter
    mspring_result result = MSPRING_OK;
    for (int step = 0; step < 33 && result == MSPRING_OK; step++) {
        assert_true(-support_velocity(network, 12).y <= (double)def.settings.max_speed);
        result = mspring_network_step(network, 1.0 / 128);
    }
    check_error(result, MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "at most");
    check_near(support_velocity(network, 12).y, -29.5 / 16, 1e-6); // half of a substep ago
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------- what a failed step leaves */

static void forces_whose_sum_is_not_finite_are_refused(void **state) {
    (void)state;
    mspring_network *network = particles(3, 1, 1e15f);
    const float x[] = {1, 3e38f, 1}, y[] = {0, 0, 0};
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, 3, x, y, 1));
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, 3, x, y, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "particle 1");
    // None of the second forces acts, and what acts can be taken back.
    const float back[] = {0, -3e38f, 0};
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, 3, back, y, 1));
    check_ok(mspring_network_step(network, 1));
    // 1 N, 2 kg, until half of the one substep of 1 s ago.
    assert_true(support_velocity(network, 0).x == 0.25 && support_velocity(network, 1).x == 0);
    mspring_network_destroy(network);
}

static void a_failed_step_leaves_relative_springs(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_spring_def spring;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.flags = MSPRING_SPRING_RELATIVE;
    spring.a = support_particle(builder, 0, 0, 1);
    spring.b = support_particle(builder, 1, 0, 1);
    spring.stiffness = 0.5f;
    spring.damping = 0.01f;
    spring.rest_length = 0.9f;
    check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);

    // At first a relative spring has no stiffness, and a step that fails does not give it any.
    double elastic = -1;
    check_error(mspring_network_step(network, 1e-12), MSPRING_ERROR_UNSTABLE);
    check_ok(support_get_energy(network, NULL, &elastic, NULL));
    assert_true(elastic == 0);
    check_ok(mspring_network_step(network, 1e-3));
    check_ok(support_get_energy(network, NULL, &elastic, NULL));
    assert_true(elastic > 0);
    double after = -1;
    check_error(mspring_network_step(network, 1e-12), MSPRING_ERROR_UNSTABLE);
    check_ok(support_get_energy(network, NULL, &after, NULL));
    assert_true(after == elastic);
    mspring_network_destroy(network);
}

static void the_error_names_who_flew_first(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0, 5, 1), b = support_particle(builder, 1, 5, 1);
    const mspring_id c = support_particle(builder, 0, 0, 1), d = support_particle(builder, 1.5, 0, 1);
    support_spring(builder, a, b, 1, 0);
    support_spring(builder, c, d, 1e6f, 0);
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    const float x[] = {0, 0, 0, 0.5f}, zero[] = {0, 0, 0, 0};
    check_ok(mspring_network_set_velocities(network, NULL, 0, 4, x, zero, 1));
    mspring_result result = MSPRING_OK;
    for (int step = 0; step < 100 && result == MSPRING_OK; step++) {
        result = mspring_network_step(network, 0.1);
    }
    check_error(result, MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "particle 2");
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_dt_is_refused),
        cmocka_unit_test(a_force_acts_during_one_step),
        cmocka_unit_test(forces_add_up),
        cmocka_unit_test(strides_end_with_their_array),
        cmocka_unit_test(forces_on_springs_and_leftovers_add_to_the_springs),
        cmocka_unit_test(pinned_particles_feel_no_force),
        cmocka_unit_test(a_step_out_of_bounds_is_taken_back),
        cmocka_unit_test(an_explosion_is_taken_back),
        cmocka_unit_test(what_a_hook_writes_is_checked),
        cmocka_unit_test(the_speed_limit_is_one),
        cmocka_unit_test(a_long_fall_ends_at_the_speed_limit),
        cmocka_unit_test(forces_whose_sum_is_not_finite_are_refused),
        cmocka_unit_test(a_failed_step_leaves_relative_springs),
        cmocka_unit_test(the_error_names_who_flew_first),
    };
    return cmocka_run_group_tests_name("step", tests, NULL, NULL);
}
