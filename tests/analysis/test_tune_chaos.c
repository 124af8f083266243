/// @file test_tune_chaos.c
/// Tuning of chaotic motion: two fine runs that start a rounding apart tell it from a bad setting.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "support.h"
#include "tunes.h"

// A double pendulum of two rods of 1 m. It starts from upright with a bend, or from near rest.
static mspring_network *pendulum(bool is_high) {
    mspring_builder *builder = support_builder();
    const mspring_network_def def = support_def(-9.8f, 8);
    const mspring_id pivot = support_pinned(builder, 0, 0, 1);
    const mspring_id elbow = support_particle(builder, is_high ? 0.1 : 0.02, is_high ? 0.995 : -0.9998, 1);
    const mspring_id end = support_particle(builder, is_high ? 1.1 : 0.04, is_high ? 0.995 : -1.9996, 1);
    support_spring(builder, pivot, elbow, 1e5f, 0);
    support_spring(builder, elbow, end, 1e5f, 0);
    return support_network(builder, &def);
}

static mspring_tune_row row_of(mspring_network *network, double duration, double max_error) {
    tunes_watch watch = {.tick = 1e-9};
    mspring_tune_def def = tunes_def(&watch);
    const mspring_settings setting = tunes_setting(MSPRING_SOLVER_EXPLICIT, 32, 1);
    def.settings = &setting;
    def.setting_count = 1;
    def.flags = MSPRING_TUNE_NOTHING_ELSE;
    def.duration = duration;
    def.max_error = max_error;
    const tunes_table table = tunes_run(network, &def);
    assert_int_equal(table.count, 1);
    assert_true(tunes_has(&table.rows[0], MSPRING_TUNE_HAS_TRAJECTORY));
    printf("%g s: error %g, two fine runs differ by %g\n", duration, table.rows[0].trajectory_share,
           (double)table.rows[0].trajectory_spread);
    mspring_network_destroy(network);
    return table.rows[0];
}

// The double pendulum's nearby trajectories separate by factors of e in some tenths of a second at this energy.
// From 2^-24 of 2 m, 16 factors of e lead to the size of the motion: 20 s are enough.
static void a_double_pendulum_is_chaotic(void **state) {
    (void)state;
    const mspring_tune_row row = row_of(pendulum(true), 20, 0.1);
    assert_true(tunes_has(&row, MSPRING_TUNE_CHAOTIC));
    assert_true(row.trajectory_spread > 0.1f && row.trajectory_spread < 4);
}

// In half a second the same pendulum is not: neighbours are as close as they began, times the growth of 0.5 s. Nor is
// it ever near rest, where it swings in two modes. A disturbance then grows in proportion to time at most, since the
// period depends on the amplitude: 2^-24 of 2 m is 6e-6 of the motion, and 20 s are 14 periods.
static void short_and_small_swings_are_not(void **state) {
    (void)state;
    const mspring_tune_row soon = row_of(pendulum(true), 0.5, 0.001);
    assert_false(tunes_has(&soon, MSPRING_TUNE_CHAOTIC));
    assert_true(soon.trajectory_spread > 0 && soon.trajectory_spread < 1e-5f);
    const mspring_tune_row small = row_of(pendulum(false), 20, 0.001);
    assert_false(tunes_has(&small, MSPRING_TUNE_CHAOTIC));
    assert_true(small.trajectory_spread > 0 && small.trajectory_spread < 1e-4f);
}

// The limit is max_error: without one, no row is chaotic, and the number says how far.
static void the_limit_is_the_error_asked_for(void **state) {
    (void)state;
    const mspring_tune_row row = row_of(pendulum(true), 20, (double)INFINITY);
    assert_false(tunes_has(&row, MSPRING_TUNE_CHAOTIC));
    assert_true(row.trajectory_spread > 0.1f);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_double_pendulum_is_chaotic),
                                       cmocka_unit_test(short_and_small_swings_are_not),
                                       cmocka_unit_test(the_limit_is_the_error_asked_for)};
    return cmocka_run_group_tests_name("tune_chaos", tests, NULL, NULL);
}
