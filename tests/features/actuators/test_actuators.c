/// @file test_actuators.c
/// Actuators: a signal is a rest length that was set, whatever the layout; steps that fail take it back; copies of
/// a builder are what was added one by one.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "support.h"

#define DT (1.0 / 64)
enum { SPRINGS = 60 };

// A lattice of 5 x 5, a chain, and a web on them.
static mspring_network *network_of(uint32_t substeps, mspring_solver solver) {
    mspring_builder *b = support_builder();
    for (uint32_t i = 0; i < 25; i++)
        (void)support_particle(b, i % 5, i / 5, 1);
    for (uint32_t i = 0; i < 25; i++) {
        if (i % 5 < 4)
            (void)support_spring(b, i, i + 1, 1000, 2);
        if (i < 20)
            (void)support_spring(b, i, i + 5, 1000, 2);
        if (i % 5 < 4 && i < 20)
            (void)support_spring(b, i, i + 6, 1000, 2);
    }
    for (uint32_t i = 0; i < 20; i++) {
        (void)support_particle(b, 10 + i, 3, 1);
        if (i > 0)
            (void)support_spring(b, 24 + i, 25 + i, 1000, 2);
    }
    (void)support_spring(b, 4, 25, 1000, 2);
    (void)support_spring(b, 30, 40, 300, 2);
    mspring_network_def def = support_def(-9.8f, substeps);
    def.settings.solver = solver;
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    return support_network(b, &def);
}

static float signal_of(uint32_t i, int step) {
    return 1.0f + 0.2f * (float)sin(0.3 * step + i);
}

static void is_a_rest_length(mspring_solver solver, bool has_yield) {
    mspring_network *driven = network_of(20, solver), *set = network_of(20, solver);
    const uint32_t count = mspring_network_count(driven, MSPRING_SPRINGS);
    const float never_yet = 100;
    float nominal[128], signals[128], lengths[128];
    mspring_id springs[128];
    assert_true(count <= 128);
    for (uint32_t i = 0; i < count; i++)
        springs[i] = count - 1 - i;
    if (has_yield) {
        check_ok(mspring_network_set(driven, MSPRING_YIELD_STRAIN, NULL, 0, count, &never_yet, 0));
        check_ok(mspring_network_set(set, MSPRING_YIELD_STRAIN, NULL, 0, count, &never_yet, 0));
    }
    check_ok(mspring_network_get(set, MSPRING_REST_LENGTH, springs, 0, count, nominal, 1));
    check_ok(mspring_network_set_actuators(driven, springs, count, 1));
    for (int step = 0; step < 40; step++) {
        for (uint32_t i = 0; i < count; i++) {
            signals[i] = signal_of(i, step);
            lengths[i] = nominal[i] * signals[i];
        }
        check_ok(mspring_network_set(set, MSPRING_REST_LENGTH, springs, 0, count, lengths, 1));
        check_ok(mspring_network_set(driven, MSPRING_SIGNAL, NULL, 0, count / 2, signals, 1));
        check_ok(mspring_network_set(driven, MSPRING_SIGNAL, NULL, count / 2, count - count / 2, signals + count / 2, 1));
        check_ok(mspring_network_step(set, DT));
        check_ok(mspring_network_step(driven, DT));
        check_ok(mspring_network_get(driven, MSPRING_REST_LENGTH, springs, 0, count, signals, 1));
        for (uint32_t i = 0; i < count; i++)
            check_near((double)signals[i], (double)lengths[i], 0);
    }
    // Implicit solvers carry energies and guesses over steps, which an edit ends and a signal does not.
    if (solver == MSPRING_SOLVER_EXPLICIT)
        assert_true(support_hash(driven) == support_hash(set));
    check_near(support_position(driven, 0).x, support_position(set, 0).x, 1e-3);
    mspring_network_destroy(driven);
    mspring_network_destroy(set);
}

static void a_signal_is_a_rest_length(void **state) {
    (void)state;
    is_a_rest_length(MSPRING_SOLVER_EXPLICIT, false);
    is_a_rest_length(MSPRING_SOLVER_EXPLICIT, true);
    is_a_rest_length(MSPRING_SOLVER_IMPLICIT, false);
    is_a_rest_length(MSPRING_SOLVER_DIRECT, false);
}

// In parts: each as if the host had taken as many steps, and set lengths on the way.
static void changes_are_even(void **state) {
    mspring_network *driven = network_of(20, MSPRING_SOLVER_EXPLICIT),
                    *set = network_of(5, MSPRING_SOLVER_EXPLICIT);
    const mspring_id springs[] = {3, 70};
    float from[2], lengths[2];
    (void)state;
    check_ok(support_set_gravity(driven, 0, 0)); // its dither begins anew with each step
    check_ok(support_set_gravity(set, 0, 0));
    check_ok(mspring_network_set_actuators(driven, springs, 2, 4));
    check_ok(mspring_network_get(set, MSPRING_REST_LENGTH, springs, 0, 2, from, 1));
    check_ok(mspring_network_set(driven, MSPRING_SIGNAL, NULL, 0, 2, &(float){1.5f}, 0));
    check_ok(mspring_network_step(driven, DT));
    for (int part = 1; part <= 4; part++) {
        for (int i = 0; i < 2; i++)
            lengths[i] = part == 4 ? from[i] * 1.5f : from[i] + (from[i] * 1.5f - from[i]) * (0.25f * (float)part);
        check_ok(mspring_network_set(set, MSPRING_REST_LENGTH, springs, 0, 2, lengths, 1));
        check_ok(mspring_network_step(set, DT / 4));
    }
    assert_true(support_hash(driven) == support_hash(set));
    mspring_network_destroy(driven);
    mspring_network_destroy(set);
}

static void failed_steps_take_them_back(void **state) {
    (void)state;
    for (uint32_t changes = 1; changes <= 7; changes += 3) {
        mspring_network *network = network_of(20, MSPRING_SOLVER_EXPLICIT),
                        *again = network_of(20, MSPRING_SOLVER_EXPLICIT);
        mspring_network *both[] = {network, again};
        const mspring_id springs[] = {3, 70, 60};
        const float fast = 9e14f, rest = 0;
        float before = 0, after = 0;
        for (int i = 0; i < 2; i++) {
            check_ok(mspring_network_set_actuators(both[i], springs, 3, changes));
            check_ok(mspring_network_set(both[i], MSPRING_SIGNAL, NULL, 0, 3, &(float){1.2f}, 0));
            check_ok(mspring_network_step(both[i], DT));
            check_ok(mspring_network_set(both[i], MSPRING_SIGNAL, NULL, 1, 2, &(float){0.8f}, 0));
        }
        check_ok(mspring_network_get(network, MSPRING_REST_LENGTH, NULL, 70, 1, &before, 1));
        check_ok(mspring_network_set_velocities(network, NULL, 7, 1, &fast, &fast, 1));
        check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
        check_ok(mspring_network_get(network, MSPRING_REST_LENGTH, NULL, 70, 1, &after, 1));
        check_near((double)after, (double)before, 0);
        for (int i = 0; i < 2; i++) {
            check_ok(mspring_network_set_velocities(both[i], NULL, 7, 1, &rest, &rest, 1));
            support_steps(both[i], 3, DT); // the signals that were set count
        }
        assert_true(support_hash(network) == support_hash(again));
        mspring_network_destroy(network);
        mspring_network_destroy(again);
    }
}

// Signals that are set already wake nothing; others do, and one beside which the rest length was changed.
static void signals_of_now_wake_nothing(void **state) {
    (void)state;
    mspring_network *network = network_of(20, MSPRING_SOLVER_EXPLICIT);
    const mspring_id springs[] = {3, 70};
    mspring_settings settings = support_settings(network);
    settings.sleep_speed = 0.01f;
    settings.gravity_y = 0;
    settings.global_damping = 5;
    settings.guard = MSPRING_GUARD_GROWTH;
    check_ok(mspring_network_set_settings(network, &settings));
    check_ok(mspring_network_set_actuators(network, springs, 2, 2));
    const float one = 1, more = 1.1f, length = 1.05f;
    float signals[2] = {0, 0};
    support_fall_asleep(network, DT);
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, MSPRING_ALL, &one, 0));
    assert_true(support_is_asleep(network));
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 1, 1, &more, 0));
    assert_false(support_is_asleep(network));
    support_fall_asleep(network, DT);
    check_ok(mspring_network_get(network, MSPRING_SIGNAL, NULL, 0, 2, signals, 1));
    check_near((double)signals[1], (double)more, 1e-6);
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 1, 1, &more, 0));
    assert_true(support_is_asleep(network));
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, springs, 1, 1, &length, 1));
    support_fall_asleep(network, DT);
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 1, 1, &more, 0));
    assert_false(support_is_asleep(network));
    support_steps(network, 1, DT);
    check_ok(mspring_network_get(network, MSPRING_REST_LENGTH, springs, 1, 1, signals, 1));
    check_near((double)signals[0], 1.1, 1e-6);
    mspring_network_destroy(network);
}

static void refusals(void **state) {
    mspring_network *network = network_of(4, MSPRING_SOLVER_EXPLICIT);
    const mspring_id twice[] = {3, 4, 3}, none[] = {3, 4000}, good[] = {3, 4};
    const float signals[] = {1, NAN, 0.001f};
    float length = 0;
    (void)state;
    check_error(mspring_network_set_actuators(network, twice, 3, 1), MSPRING_ERROR_DUPLICATE);
    check_error(mspring_network_set_actuators(network, none, 2, 1), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "actuator 1");
    check_error(mspring_network_set_actuators(network, good, 2, 0), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_actuators(network, good, 2, 257), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 1, signals, 1), MSPRING_ERROR_ID);
    check_ok(mspring_network_set_actuators(network, good, 2, 1));
    assert_int_equal(mspring_network_count(network, MSPRING_ACTUATORS), 2);
    check_error(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 2, signals, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "actuator 1");
    check_error(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 2, signals + 1, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_SIGNAL, NULL, 1, 2, signals, 1), MSPRING_ERROR_ID);
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 5, 1, &length, 1)); // a weld
    check_error(mspring_network_set_actuators(network, &(mspring_id){5}, 1, 1), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_set_actuators(network, NULL, 0, 1));
    assert_int_equal(mspring_network_count(network, MSPRING_ACTUATORS), 0);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------------- copies */

static mspring_builder *body(double x, double y) {
    mspring_builder *b = support_builder();
    mspring_spring_def def;
    (void)support_particle(b, x, y, 1);
    (void)support_particle(b, x + 1, y, 2);
    (void)support_pinned(b, x, y + 1, 3);
    (void)support_spring(b, 0, 1, 100, 1);
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = 1, def.b = 2, def.stiffness = 50, def.break_strain = 0.5f;
    check_ok(mspring_builder_add_springs(b, &def, 1, NULL));
    return b;
}

static void copies_are_what_was_added(void **state) {
    const double x[] = {0, 99, 10, 99, 20}, y[] = {0, 99, 0.5, 99, 1};
    mspring_builder *one = body(1, 2), *all = support_builder(), *by_hand = support_builder();
    mspring_id particle = 7, spring = 7;
    mspring_network_def def = support_def(-9.8f, 4);
    (void)state;
    (void)support_particle(all, -5, 0, 1);
    (void)support_particle(by_hand, -5, 0, 1);
    check_ok(mspring_builder_add_copies(all, one, 3, x, y, 2, &particle, &spring));
    assert_int_equal(particle, 1);
    assert_int_equal(spring, 0);
    for (int i = 0; i < 3; i++) {
        mspring_builder *each = body(1 + x[2 * i], 2 + y[2 * i]);
        check_ok(mspring_builder_add_copies(by_hand, each, 1, NULL, NULL, 0, NULL, NULL));
        mspring_builder_destroy(each);
    }
    mspring_builder_destroy(one);
    mspring_network *a = support_network(all, &def), *b = support_network(by_hand, &def);
    float limit = 0;
    check_ok(mspring_network_get(a, MSPRING_BREAK_STRAIN, NULL, 5, 1, &limit, 1));
    check_near((double)limit, 0.5, 0);
    check_near(support_position(a, 7).x, 21, 0);
    support_steps(a, 50, DT);
    support_steps(b, 50, DT);
    assert_true(support_hash(a) == support_hash(b));
    mspring_network_destroy(a);
    mspring_network_destroy(b);
}

static void copies_are_refused(void **state) {
    const double far[] = {0, 1e12}, none[] = {0, NAN};
    mspring_builder *one = body(1, 2), *all = support_builder();
    (void)state;
    check_error(mspring_builder_add_copies(all, one, 2, far, far, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(all), "copy 1");
    check_error(mspring_builder_add_copies(all, one, 2, none, none, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(all), "copy 1");
    check_error(mspring_builder_add_copies(all, one, 0, none, none, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(all), "0 copies");
    check_error(mspring_builder_add_copies(all, one, 1, far, NULL, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(all), "NULL");
    check_error(mspring_builder_add_copies(one, one, 1, NULL, NULL, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    (void)support_builder_error(one);
    check_error(mspring_builder_add_copies(one, all, 1, NULL, NULL, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    (void)support_builder_error(one);
    check_error(mspring_builder_add_copies(all, one, UINT32_MAX, NULL, NULL, 1, NULL, NULL), MSPRING_ERROR_LIMIT);
    check_contains(support_builder_error(all), "4294967295");
    assert_int_equal(mspring_builder_count(all, MSPRING_PARTICLES), 0);
    mspring_builder_destroy(one);
    mspring_builder_destroy(all);
}

// A body whose description has failed gives no copies, and the builder of these tells why, until told to forget.
static void failures_come_along(void **state) {
    (void)state;
    mspring_builder *one = body(1, 2), *all = support_builder();
    mspring_network *network = NULL;
    mspring_particle_def heavy = mspring_particle_def_default();
    heavy.mass = 1e31f;
    check_error(mspring_builder_add_particles(one, &heavy, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_builder_add_copies(all, one, 2, NULL, NULL, 0, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    mspring_builder_forget_error(one);
    check_ok(mspring_builder_add_copies(all, one, 2, NULL, NULL, 0, NULL, NULL));
    check_contains(mspring_builder_error(all), "mass");
    check_error(mspring_network_create(all, NULL, &network), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_builder_error(all), "mass");
    mspring_builder_forget_error(all);
    check_ok(mspring_network_create(all, NULL, &network));
    assert_int_equal(mspring_network_count(network, MSPRING_PARTICLES), 6);
    mspring_network_destroy(network);
    mspring_builder_destroy(one);
    mspring_builder_destroy(all);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_signal_is_a_rest_length),   cmocka_unit_test(changes_are_even),
        cmocka_unit_test(failed_steps_take_them_back), cmocka_unit_test(refusals),
        cmocka_unit_test(signals_of_now_wake_nothing),
        cmocka_unit_test(copies_are_what_was_added),   cmocka_unit_test(copies_are_refused),
        cmocka_unit_test(failures_come_along),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
