/// @file test_guard_choice.c
/// Guards that are chosen after creation, and the one that never refuses a step.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

static const recipe_shape shapes[] = {
    {"bar", .width = 40, .height = 5, .damping = 30, .hangs = true},
    {"ship", .width = 20, .height = 12, .rope = 20},
    {"graph", .particles = 100, .springs = 300},
};

static mspring_network *make(size_t shape, mspring_solver solver, mspring_guard guard, uint32_t substeps) {
    recipe made = recipe_of_shape(&shapes[shape], 1e4, 10);
    mspring_network_def def = support_def(-9.8f, substeps);
    def.settings.solver = solver;
    def.settings.guard = guard;
    def.settings.max_speed = 1e4f;
    def.settings.max_substeps = 5;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static double border_of(mspring_network *network) {
    double now = 0;
    check_ok(mspring_network_get_stable_dt(network, &now, NULL));
    return now;
}

static void check_bounds(const mspring_network *network) {
    for (mspring_id p = 0; p < mspring_network_count(network, MSPRING_PARTICLES); p++) {
        const support_point at = support_position(network, p), speed = support_velocity(network, p);
        assert_true(isfinite(at.x) && isfinite(at.y)); // bounds are those of local coordinates
        assert_true(fabs(speed.x) <= 1e4 && fabs(speed.y) <= 1e4);
    }
}

/// With every solver, from just above the border to far beyond it, and where the library chooses substeps.
static void what_explodes_stays_in_bounds(void **state) {
    (void)state;
    const double beyond[] = {1.1, 3, 1e3, 1e9};
    const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
    const uint32_t substeps[] = {1, 8, MSPRING_SUBSTEPS_AUTO};
    uint32_t at_bounds = 0;
    for (size_t i = 0; i < COUNT_OF(shapes) * COUNT_OF(beyond) * COUNT_OF(substeps) * COUNT_OF(solvers); i++) {
        const double over = beyond[i % COUNT_OF(beyond)];
        const size_t rest = i / COUNT_OF(beyond), shape = rest / COUNT_OF(substeps) % COUNT_OF(shapes);
        const mspring_solver solver = solvers[rest / COUNT_OF(substeps) / COUNT_OF(shapes)];
        mspring_network *network =
            make(shape, solver, MSPRING_GUARD_CLAMP_BOUNDS, substeps[rest % COUNT_OF(substeps)]);
        const double dt = over * border_of(network) * 8;
        for (int step = 0; step < 60; step++) {
            check_ok(mspring_network_step(network, dt));
            check_bounds(network);
            at_bounds += fabs(support_velocity(network, 30).x) == 1e4;
        }
        mspring_network_destroy(network);
    }
    assert_true(at_bounds > 100); // else nothing exploded
}

/// What a hook writes is put back, too, whatever it is.
static void what_is_written_is_put_back(void **state) {
    (void)state;
    const float values[] = {NAN, INFINITY, 1e30f};
    const float rates[] = {0, 1e5f}; // of which the second would hide speeds by the end of the step
    for (size_t i = 0; i < 4 * COUNT_OF(values) * COUNT_OF(rates); i++) {
        mspring_network *network = make(1, MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_CLAMP_BOUNDS, 2);
        check_ok(support_set_global_damping(network, rates[i / 4 / COUNT_OF(values)]));
        support_writing writing = {.array = (int)(i % 4), .particle = 7, .value = values[i / 4 % COUNT_OF(values)]};
        (void)support_write_in_step(network, &writing);
        for (int step = 0; step < 5; step++) {
            check_ok(mspring_network_step(network, 1e-3));
            check_bounds(network);
        }
        mspring_network_destroy(network);
    }
}

/// A guard that is chosen is the one that it would have been from the start.
static void a_guard_can_be_chosen_later(void **state) {
    (void)state;
    for (mspring_guard first = MSPRING_GUARD_GROWTH; first <= MSPRING_GUARD_CLAMP_BOUNDS; first++) {
        for (mspring_guard then = MSPRING_GUARD_GROWTH; then <= MSPRING_GUARD_CLAMP_BOUNDS; then++) {
            mspring_network *network = make(0, MSPRING_SOLVER_EXPLICIT, first, 2);
            mspring_network *twin = make(0, MSPRING_SOLVER_EXPLICIT, then, 2);
            const double dt = 2 * border_of(network);
            support_steps(network, 3, 0.4 * dt);
            support_steps(twin, 3, 0.4 * dt);
            assert_int_equal(support_settings(network).guard, first);
            check_ok(support_set_guard(network, then));
            assert_int_equal(support_settings(network).guard, then);
            for (int step = 0; step < 20; step++) {
                assert_int_equal(mspring_network_step(network, 1.2 * dt), mspring_network_step(twin, 1.2 * dt));
                assert_int_equal(support_hash(network), support_hash(twin));
            }
            assert_int_equal(support_fallback_count(network), support_fallback_count(twin));
            mspring_network_destroy(network);
            mspring_network_destroy(twin);
        }
    }
}

static void it_goes_with_snapshots(void **state) {
    (void)state;
    mspring_network *network = make(1, MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_BOUNDS, 2);
    mspring_network *other = make(1, MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_BOUNDS, 2);
    check_ok(support_set_guard(network, MSPRING_GUARD_IMPLICIT));
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    assert_int_equal(support_settings(other).guard, MSPRING_GUARD_IMPLICIT);
    const double dt = 2.4 * border_of(network);
    for (int step = 0; step < 40; step++) {
        support_steps(network, 1, dt);
        support_steps(other, 1, dt);
        assert_int_equal(support_hash(other), support_hash(network));
    }
    assert_true(support_fallback_count(network) > 0);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

static void what_is_no_guard_is_refused(void **state) {
    (void)state;
    mspring_network *network = make(0, MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_RETRY, 2);
    check_error(support_set_guard(network, -1), MSPRING_ERROR_ARGUMENT);
    check_error(support_set_guard(network, MSPRING_GUARD_CLAMP_BOUNDS + 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "guard is 6, which is none");
    assert_int_equal(support_settings(network).guard, MSPRING_GUARD_RETRY);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_explodes_stays_in_bounds), cmocka_unit_test(what_is_written_is_put_back),
        cmocka_unit_test(a_guard_can_be_chosen_later),   cmocka_unit_test(it_goes_with_snapshots),
        cmocka_unit_test(what_is_no_guard_is_refused),
    };
    return cmocka_run_group_tests_name("guard_choice", tests, NULL, NULL);
}
