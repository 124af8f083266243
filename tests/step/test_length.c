/// @file test_length.c
/// mspring_settings.substep_length: substeps of one length, whatever dt does.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "archives.h"
#include "recipe.h"
#include "snapshots.h"
#include "support.h"

enum { WIDTH = 20 };

static const double length = 1.0 / 1024;

static void set_length(mspring_network *network, mspring_solver solver, double value) {
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    def.solver = solver;
    def.substeps = 3; // ignored, if there is a length
    def.substep_length = value;
    check_ok(support_set_solver(network, &def));
}

/// A free rope or lattice, kicked at random, that nothing damps; half of what is stable.
static mspring_network *kicked(uint32_t height, mspring_solver solver) {
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {2e5, 2e5}};
    recipe made = {0};
    recipe_lattice(&made, WIDTH, height, 0, 0, 1, &stuff, &seed);
    recipe_disturb(&made, 0, 0.5, &seed);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = recipe_network(&made, &def);
    set_length(network, solver, length);
    recipe_free(&made);
    return network;
}

/// The n-th dt of a pattern, s.
static double dt_of(int pattern, uint32_t n, uint64_t *seed) {
    switch (pattern) {
    case 0:
        return support_random_between(seed, 0.9, 1) / 64;
    case 1:
        return support_random_between(seed, 0, 2) / 64;
    case 2:
        return n % 2 == 0 ? 1.0 / 60 : 1e-3;
    case 3:
        return support_random_between(seed, 0, 1.5) * length; // often none
    default:
        return n % 10 == 9 ? 1e-6 : 1.0 / 60;
    }
}
enum { PATTERNS = 5 };

static void check_same_motion(const mspring_network *a, const mspring_network *b) {
    for (mspring_id p = 0; p < mspring_network_count(a, MSPRING_PARTICLES); p++) {
        const support_point at_a = support_position(a, p), at_b = support_position(b, p);
        const support_point v_a = support_velocity(a, p), v_b = support_velocity(b, p);
        assert_true(at_a.x == at_b.x && at_a.y == at_b.y && v_a.x == v_b.x && v_a.y == v_b.y);
    }
}

/// However time is cut, the same substeps are taken: energy and bits are those of even dt.
static void uneven_steps_are_even_ones(void **state) {
    (void)state;
    for (uint32_t height = 1; height <= 4; height += 3) {
        for (int pattern = 0; pattern < PATTERNS; pattern++) {
            mspring_network *network = kicked(height, MSPRING_SOLVER_EXPLICIT);
            mspring_network *even = kicked(height, MSPRING_SOLVER_EXPLICIT);
            uint64_t seed = 7, counted = 0;
            double asked = 0, most = 0, most_even = 0;
            for (uint32_t n = 0; asked < SAMPLE(10); n++) {
                const double dt = dt_of(pattern, n, &seed);
                check_ok(mspring_network_step(network, dt));
                asked += dt;
                most = fmax(most, support_energy(network));
                const mspring_step_info info = support_step_info(network);
                check_near(info.time + info.time_left, asked, 1e-10); // sums of some 10,000 doubles
                assert_true(fabs(info.time_left) <= (0.5 + 1e-9) * length);
                counted = (uint64_t)(info.time / length + 0.5);
            }
            for (uint64_t k = 0; k < counted; k++) {
                check_ok(mspring_network_step(even, length));
                most_even = fmax(most_even, support_energy(even));
            }
            assert_int_equal(support_step_info(even).step_count, counted);
            check_same_motion(network, even);
            assert_true(most <= 1.01 * most_even); // looked at less often
            const double energy = support_energy(even);
            check_near(support_energy(network), energy, 1e-9 * energy);
            mspring_network_destroy(network);
            mspring_network_destroy(even);
        }
    }
}

/// A dt of 0.3 substeps takes one in the second and in the fifth of ten, and three in all.
static void short_dt_waits(void **state) {
    (void)state;
    mspring_network *network = kicked(4, MSPRING_SOLVER_EXPLICIT), *same = kicked(4, MSPRING_SOLVER_EXPLICIT);
    static const uint32_t expected[] = {0, 1, 1, 1, 2, 2, 2, 2, 3, 3};
    check_ok(mspring_network_apply_force(network, 0, 100, 0)); // waits for the first substep
    check_ok(mspring_network_apply_force(same, 0, 100, 0));
    for (size_t i = 0; i < COUNT_OF(expected); i++) {
        const uint64_t before = support_hash(network);
        check_ok(mspring_network_step(network, 0.3 * length));
        const mspring_step_info info = support_step_info(network);
        assert_int_equal(info.step_count, expected[i]);
        assert_int_equal(info.result, MSPRING_OK);
        assert_true(info.time == expected[i] * length);
        assert_int_equal(info.substeps, expected[i] > 0);
        assert_true(support_hash(network) != before); // time is left over
    }
    support_steps(same, 1, length);
    support_steps(same, 1, 2 * length);
    check_same_motion(network, same);
    mspring_network_destroy(network);
    mspring_network_destroy(same);
}

/// The rest of time is part of the state.
static void copies_keep_the_rest(void **state) {
    (void)state;
    mspring_network *network = kicked(4, MSPRING_SOLVER_EXPLICIT), *clone,
                    *other = kicked(4, MSPRING_SOLVER_DIRECT);
    uint64_t seed = 5;
    for (uint32_t n = 0; n < 50; n++) {
        check_ok(mspring_network_step(network, dt_of(1, n, &seed)));
    }
    assert_true(support_step_info(network).time_left != 0);
    check_ok(mspring_network_clone(network, NULL, &clone));
    set_length(other, MSPRING_SOLVER_EXPLICIT, 0); // the snapshot brings the length
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    mspring_network *read = archives_check_same(network, 1);
    const saved at = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    const uint64_t again = seed;
    mspring_network *const all[] = {network, clone, other, read};
    uint64_t hash = 0;
    for (size_t i = 0; i < COUNT_OF(all); i++) {
        seed = again;
        for (uint32_t n = 0; n < 50; n++) {
            check_ok(mspring_network_step(all[i], dt_of(1, n, &seed)));
        }
        hash = i == 0 ? support_hash(network) : hash;
        assert_true(support_hash(all[i]) == hash);
        assert_true(support_solver(all[i]).substep_length == length);
    }
    snapshots_load(network, &at);
    seed = again;
    for (uint32_t n = 0; n < 50; n++) {
        check_ok(mspring_network_step(network, dt_of(1, n, &seed)));
    }
    assert_true(support_hash(network) == hash);
    free(at.bytes);
    for (size_t i = 0; i < COUNT_OF(all); i++) {
        mspring_network_destroy(all[i]);
    }
}

/// A step that fails leaves the rest as it was.
static void failed_steps_leave_the_rest(void **state) {
    (void)state;
    mspring_network *network = kicked(1, MSPRING_SOLVER_EXPLICIT);
    support_steps(network, 1, 3.25 * length);
    check_near(support_step_info(network).time_left, 0.25 * length, 1e-15);
    const uint64_t before = support_hash(network);
    const float fast = 1e7f;
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &fast, &fast, 1));
    check_error(mspring_network_step(network, 4.4 * length), MSPRING_ERROR_UNSTABLE);
    check_near(support_step_info(network).time_left, 0.25 * length, 1e-15);
    check_error(mspring_network_step(network, 1e7 * length), MSPRING_ERROR_ARGUMENT); // 10^7 substeps
    check_contains(mspring_network_error(network), "more than 1000000 substeps");
    check_error(mspring_network_step(network, NAN), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_step(network, -length), MSPRING_ERROR_ARGUMENT);
    check_near(support_step_info(network).time_left, 0.25 * length, 1e-15);
    assert_true(support_hash(network) != before); // the velocity
    mspring_network_destroy(network);
}

/// All solvers and guards take substeps of that length, relative springs included.
static void all_solvers_keep_it(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_network *network = kicked(4, (mspring_solver)solver), *even = kicked(4, (mspring_solver)solver);
        check_ok(support_set_guard(network, MSPRING_GUARD_CLAMP));
        check_ok(support_set_guard(even, MSPRING_GUARD_CLAMP));
        uint64_t seed = 2;
        for (uint32_t n = 0; n < 40; n++) {
            check_ok(mspring_network_step(network, dt_of(3, n, &seed)));
        }
        const uint32_t count = (uint32_t)(support_step_info(network).time / length + 0.5);
        support_steps(even, count, length);
        check_same_motion(network, even);
        mspring_network_destroy(network);
        mspring_network_destroy(even);
    }
}

static void it_reads_back_and_is_checked(void **state) {
    (void)state;
    mspring_network *network = kicked(1, MSPRING_SOLVER_EXPLICIT);
    mspring_settings def = support_solver(network);
    assert_true(def.substep_length == length && def.substeps == MSPRING_SUBSTEPS_AUTO);
    check_ok(support_set_solver(network, &def));
    static const double bad[] = {-1, NAN, INFINITY, -INFINITY, 1e-45, 2e30};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        def.substep_length = bad[i];
        check_error(support_set_solver(network, &def), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "substep_length");
    }
    assert_true(support_solver(network).substep_length == length);
    def.substep_length = 0.1; // no float
    check_ok(support_set_solver(network, &def));
    assert_true(support_solver(network).substep_length == (double)0.1f);
    set_length(network, MSPRING_SOLVER_EXPLICIT, 0);
    assert_int_equal(support_solver(network).substeps, 3);
    support_steps(network, 1, 3 * length);
    assert_int_equal(support_substeps(network), 3);
    mspring_network_destroy(network);
}

/// Snapshots of networks without a length are as before: the section is not there.
static void others_have_no_section(void **state) {
    (void)state;
    mspring_network *network = kicked(1, MSPRING_SOLVER_EXPLICIT);
    size_t with, without;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &with));
    const saved at = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    set_length(network, MSPRING_SOLVER_EXPLICIT, 0);
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &without));
    assert_true(with >= without + sizeof(double));
    const saved plain = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    snapshots_load(network, &at);
    assert_true(support_solver(network).substep_length == length);
    snapshots_load(network, &plain);
    assert_true(support_solver(network).substep_length == 0);
    free(at.bytes);
    free(plain.bytes);
    mspring_network_destroy(network);
}

/// As many as a step may have, and not one more. A call that takes none has not failed.
static void a_step_has_at_most_so_many(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    set_length(network, MSPRING_SOLVER_EXPLICIT, length);
    check_ok(mspring_network_step(network, MSPRING_MAX_SUBSTEPS * length));
    assert_int_equal(support_step_info(network).substeps, MSPRING_MAX_SUBSTEPS);
    check_error(mspring_network_step(network, (MSPRING_MAX_SUBSTEPS + 1.0) * length), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "more than 1000000 substeps");
    assert_int_equal(support_step_info(network).result, MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_step(network, 0.1 * length)); // none yet
    assert_int_equal(support_step_info(network).result, MSPRING_OK);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uneven_steps_are_even_ones), cmocka_unit_test(short_dt_waits),
        cmocka_unit_test(copies_keep_the_rest),       cmocka_unit_test(failed_steps_leave_the_rest),
        cmocka_unit_test(all_solvers_keep_it),        cmocka_unit_test(it_reads_back_and_is_checked),
        cmocka_unit_test(others_have_no_section),
        cmocka_unit_test(a_step_has_at_most_so_many),
    };
    return cmocka_run_group_tests_name("length", tests, NULL, NULL);
}
