/// @file test_law_edits.c
/// Networks with material laws that the host edits: what is removed leaves nothing behind, and what a snapshot
/// brings to a network that was only just made goes on as where it was saved.
///
/// SPDX-License-Identifier: MIT
#include "areas.h"

static mspring_network_def def_of(mspring_solver solver) {
    mspring_network_def def = support_def(-9.8f, solver == MSPRING_SOLVER_EXPLICIT ? 16 : 2);
    def.settings.solver = solver;
    return def;
}

static const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};

// Once the last area and the last angle are gone, a network has the bits of one that never had any.
static void the_last_leaves_nothing(void **state) {
    (void)state;
    static const mspring_id three[] = {0, 1, 2};
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        const mspring_network_def def = def_of(solvers[i]);
        mspring_network *had = sheet_network(&jelly, &def), *never = sheet_network(&jelly, &def);
        const uint32_t count = add_cells(had, 100);
        mspring_angle_def angle;
        check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
        angle.stiffness = 0.1f;
        check_ok(mspring_network_add_angles(had, &angle, three, 1, 3, NULL));
        support_kick(had, 3, 2);
        support_steps(had, 3, 1.0 / 64);
        for (mspring_id area = 0; area < count; area++)
            check_ok(mspring_network_remove_elements(had, NULL, area, 1));
        check_ok(mspring_network_remove_elements(had, NULL, count, 1));
        support_bring(had, never, MSPRING_SNAPSHOT_ALL);
        support_steps(had, 5, 1.0 / 64);
        support_steps(never, 5, 1.0 / 64);
        assert_true(support_hash(had) == support_hash(never));
        mspring_network_destroy(had);
        mspring_network_destroy(never);
    }
}

/* --------------------------------------------------------------------------------- actuators that yield */

enum { WIDE = 40, HIGH = 8, MOST_SPRINGS = WIDE * HIGH * 5 };

static const sheet bar = {
    .width = WIDE, .height = HIGH, .spacing = 0.1, .stiffness = 2000, .shear_share = 1, .mass = 0.1f};

// A bar that yields early, with braces that are no part of its lattice. Every third spring is an actuator that
// moves in so many changes.
static mspring_network *muscle(uint32_t changes, uint32_t workers) {
    mspring_network_def def = def_of(MSPRING_SOLVER_EXPLICIT);
    def.worker_count = workers;
    mspring_builder *builder = support_builder();
    build(builder, &bar, false);
    for (mspring_id p = 0; p + 2 * WIDE + 3 < WIDE * HIGH; p += 7)
        (void)support_spring(builder, p, p + 2 * WIDE + 3, bar.stiffness, 0);
    mspring_network *network = support_network(builder, &def);
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    const float yield = 0.01f;
    mspring_id actuators[MOST_SPRINGS / 3];
    uint32_t count = 0;
    for (mspring_id s = 0; s < springs; s += 3)
        actuators[count++] = s;
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, springs, &yield, 0));
    check_ok(mspring_network_set_actuators(network, actuators, count, changes));
    for (mspring_id p = 0; p < WIDE * HIGH; p += 5)
        support_kick(network, p, p % 2 ? 4 : -4);
    return network;
}

static void pull(mspring_network *network, int step) {
    float signals[MOST_SPRINGS / 3];
    const uint32_t count = mspring_network_count(network, MSPRING_ACTUATORS);
    for (uint32_t i = 0; i < count; i++)
        signals[i] = (i + (uint32_t)step) % 2 ? 1.04f : 0.97f;
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, count, signals, 1));
}

// A step that is rejected after springs have been driven and have yielded leaves their plastic strain as it was.
static void rejected_steps_leave_dents(void **state) {
    (void)state;
    for (uint32_t changes = 1; changes <= 4; changes += 3) {
        mspring_network *network = muscle(changes, 1);
        const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
        float before[MOST_SPRINGS], after[MOST_SPRINGS];
        for (int step = 0; step < 4; step++) {
            pull(network, step);
            support_steps(network, 1, 1.0 / 64);
        }
        check_ok(support_set_guard(network, MSPRING_GUARD_BOUNDS)); // rejects when all has happened
        pull(network, 1);
        check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, 0, springs, before, 1));
        const uint64_t hash = support_hash(network);
        check_error(mspring_network_step(network, 1e6), MSPRING_ERROR_UNSTABLE);
        check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, 0, springs, after, 1));
        assert_memory_equal(before, after, springs * sizeof *before);
        assert_true(support_hash(network) == hash);
        mspring_network_destroy(network);
    }
}

// Several workers look first and take a step again with one that maps: its dents are the same.
static void driven_dents_do_not_depend_on_workers(void **state) {
    (void)state;
    mspring_network *one = muscle(4, 1), *three = muscle(4, 3);
    for (int step = 0; step < 20; step++) {
        pull(one, step);
        pull(three, step);
        support_steps(one, 1, 1.0 / 64);
        support_steps(three, 1, 1.0 / 64);
        assert_true(support_hash(one) == support_hash(three));
    }
    mspring_energy bent = {.struct_size = sizeof bent};
    check_ok(mspring_network_get_energy(one, &bent));
    assert_true(bent.yield_count > 100);
    mspring_network_destroy(one);
    mspring_network_destroy(three);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_leaves_nothing),
        cmocka_unit_test(rejected_steps_leave_dents),
        cmocka_unit_test(driven_dents_do_not_depend_on_workers),
    };
    return cmocka_run_group_tests_name("law_edits", tests, NULL, NULL);
}
