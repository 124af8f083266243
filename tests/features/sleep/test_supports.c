/// @file test_supports.c
/// What sleeps on something that goes away wakes and falls, and what sleeps elsewhere sleeps on. Nothing falls asleep
/// on what moves.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "snapshots.h"
#include "support.h"

#define DT (1.0 / 64)

typedef enum way { BY_POSITIONS, BY_LIST, STIFFENED_BEFORE, BROKEN_BEFORE, AFTER_A_LOAD, WAYS } way;

/// Two piles of two pinned particles, a bar on them, and a bar on that: particles 0 and 1, 2 and 3, 4 and 5 of the
/// first.
enum { IN_PILE = 6, PILES = 2 };

static mspring_network *piles(mspring_solver solver) {
    mspring_builder *builder = support_builder();
    for (uint32_t pile = 0; pile < PILES; pile++) {
        const double x = 20 * pile;
        support_pinned(builder, x - 0.4, 0, 1);
        support_pinned(builder, x + 0.4, 0, 1);
        for (uint32_t bar = 0; bar < 2; bar++) {
            const double length = bar == 0 ? 0.6 : 0.5, y = 0.201 * (1 + bar);
            const mspring_id left = support_particle(builder, x - length, y, 1),
                             right = support_particle(builder, x + length, y, 1);
            support_spring(builder, left, right, 1e4f, 20);
        }
    }
    mspring_network_def def = support_def(-9.8f, 8);
    def.settings.solver = solver;
    def.settings.sleep_speed = 0.05f;
    def.settings.sleep_time = 0.2f;
    def.settings.global_damping = 2;
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.2;
    contact.friction = 1;
    check_ok(mspring_network_set_contact(network, &contact));
    support_fall_asleep(network, DT);
    return network;
}

static void move_away(mspring_network *network, mspring_id first, uint32_t count, way how) {
    for (mspring_id id = first; id < first + count; id++) {
        const double x = 100 + id, y = 50;
        if (how == BY_LIST) {
            check_ok(mspring_network_set_positions(network, &id, 0, 1, &x, &y, 1));
        } else {
            check_ok(mspring_network_set_positions(network, NULL, id, 1, &x, &y, 1));
        }
    }
}

static void prepare(mspring_network *network, way how) {
    const mspring_id spring = 0;
    if (how == STIFFENED_BEFORE) {
        const float stiffness = 2e4f;
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, spring, 1, &stiffness, 0));
    }
    if (how == BROKEN_BEFORE)
        check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    if (how == AFTER_A_LOAD) {
        size_t size;
        check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
        void *snapshot = malloc(size);
        assert_non_null(snapshot);
        check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, snapshot, size, NULL));
        check_ok(mspring_network_wake(network));
        check_ok(mspring_network_load(network, snapshot, size));
        free(snapshot);
    }
}

/// The support: the pins below both bars, or the lower bar.
static void run(mspring_solver solver, way how, mspring_id first, uint32_t count) {
    mspring_network *network = piles(solver);
    const double before = support_position(network, 4).y;
    uint8_t asleep[IN_PILE * PILES];
    prepare(network, how);
    move_away(network, first, count, how);
    support_steps(network, 32, DT);
    // In half a second it falls 0.8 m, or onto the pins, which are 0.2 m lower.
    if (!(support_position(network, 4).y < before - 0.15))
        fail_msg("solver %d, way %d, support %u: the upper bar sleeps on", (int)solver, (int)how, first);
    check_ok(support_get_sleepers(network, 0, IN_PILE * PILES, asleep, 1));
    for (mspring_id id = IN_PILE; id < IN_PILE * PILES; id++)
        assert_int_equal(asleep[id], 1);
    mspring_network_destroy(network);
}

static void what_rests_on_a_support_wakes_when_it_is_moved(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        for (int how = 0; how < WAYS; how++) {
            run((mspring_solver)solver, (way)how, 2, 2);
            if (how != STIFFENED_BEFORE && how != BROKEN_BEFORE)
                run((mspring_solver)solver, (way)how, 0, 2);
        }
}

/// Ways to move a support that the library sees at the next step alone, or within one.
typedef enum silent_way { BY_VIEW, BY_CALL, BY_A_HOOK, SILENT_WAYS } silent_way;

static void lift_in_a_step(const mspring_hook_args *args, void *user) {
    bool *is_due = user;
    for (uint32_t slot = args->first_slot; *is_due && slot < args->first_slot + args->slot_count; slot++)
        if (args->particle_of_slot[slot] == 2 || args->particle_of_slot[slot] == 3)
            args->x[slot] += 60;
}

/// A snapshot that is saved before the next step: a network that loads it goes on as this one does.
static void save_and_go_on(mspring_solver solver, silent_way how) {
    mspring_network *network = piles(solver), *other = piles(solver);
    bool is_due = true;
    if (how == BY_VIEW) {
        support_shift(network, 2, 60, 0);
        support_shift(network, 3, 60, 0);
    }
    if (how == BY_CALL)
        move_away(network, 2, 2, BY_POSITIONS);
    if (how == BY_A_HOOK) {
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, lift_in_a_step, &is_due, NULL));
        check_ok(mspring_network_step(network, DT));
        is_due = false;
    }
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    const double before = support_position(network, 4).y;
    for (uint32_t step = 0; step < 32; step++) {
        check_ok(mspring_network_step(network, DT));
        check_ok(mspring_network_step(other, DT));
        if (support_hash(network) != support_hash(other))
            fail_msg("solver %d, way %d: another future in step %u", (int)solver, (int)how, step);
    }
    assert_true(support_position(other, 4).y < before - 0.15); // as above
    assert_true(support_sleeps(other, IN_PILE + 4));
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

static void a_snapshot_saved_before_the_next_step_goes_on_the_same(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        for (int how = 0; how < SILENT_WAYS; how++)
            save_and_go_on((mspring_solver)solver, (silent_way)how);
}

/// A driven pin passes below a particle so close that they rest on each other. A spring elsewhere breaks meanwhile, so
/// that islands get other numbers. None of it is slow for long enough but for the time that it shares with the pin.
static void what_lies_on_a_moving_body_is_awake_as_springs_break(void **state) {
    (void)state;
    enum { LOOSE = 2, STEPS = 8, BREAKS_BEFORE = 4 };
    mspring_builder *builder = support_builder();
    (void)support_spring(builder, support_particle(builder, -20, 0, 1), support_particle(builder, -19, 0, 1), 100, 1);
    assert_int_equal(support_particle(builder, 0, 0.205, 1), LOOSE);
    const mspring_id driven = support_pinned(builder, 0, 0, 1), spring = 0;
    mspring_network_def def = support_def(0, 4);
    def.settings.sleep_speed = 0.05f;
    def.settings.sleep_time = (float)(1.5 * DT);
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.2;
    check_ok(mspring_network_set_contact(network, &contact));
    const float along = 0.06f, across = 0;
    check_ok(mspring_network_set_velocities(network, &driven, 0, 1, &along, &across, 1));
    for (uint32_t step = 0; step < STEPS; step++) {
        if (step == BREAKS_BEFORE)
            check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        check_ok(mspring_network_step(network, DT));
        assert_false(support_sleeps(network, LOOSE));
    }
    mspring_network_destroy(network);
}

/// Long planks on each other, at rest: each end has all of them near it. A network that has not taken a step yet finds
/// the same pile as the one that fell asleep, so when one plank goes, all wake in both.
static mspring_network *planks(uint32_t capacity) {
    enum { PLANKS = 400 };
    mspring_builder *builder = support_builder();
    for (uint32_t plank = 0; plank < PLANKS; plank++) {
        const mspring_id left = support_particle(builder, -10, 0.05 * plank, 1),
                         right = support_particle(builder, 10, 0.05 * plank, 1);
        (void)support_spring(builder, left, right, 100, 1);
    }
    mspring_network_def def = support_def(0, 4);
    def.settings.sleep_speed = 0.05f;
    def.settings.sleep_time = (float)(1.5 * DT);
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.05;
    contact.capacity = capacity;
    check_ok(mspring_network_set_contact(network, &contact));
    return network;
}

static void lay_planks(uint32_t capacity) {
    mspring_network *network = planks(capacity), *other = planks(capacity);
    support_fall_asleep(network, DT);
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    move_away(network, 0, 2, BY_POSITIONS);
    move_away(other, 0, 2, BY_POSITIONS);
    check_ok(mspring_network_step(network, DT));
    check_ok(mspring_network_step(other, DT));
    assert_false(support_sleeps(network, 799));
    assert_false(support_sleeps(other, 799));
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

/// With little capacity, only the steps of the first network have made room for the pairs of the pile.
static void a_network_without_a_step_finds_the_same_pile(void **state) {
    (void)state;
    lay_planks(0);
    lay_planks(64);
}

/// The step in which they fall asleep reports the pairs that it looked at.
static void a_step_that_ends_asleep_has_pairs(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_network *network = piles(solver);
        mspring_contact_info info;
        check_ok(mspring_init(MSPRING_STRUCT_CONTACT_INFO, &info, sizeof info));
        check_ok(mspring_network_get_contact_info(network, &info));
        assert_true(info.pairs > 0);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_rests_on_a_support_wakes_when_it_is_moved),
        cmocka_unit_test(a_snapshot_saved_before_the_next_step_goes_on_the_same),
        cmocka_unit_test(what_lies_on_a_moving_body_is_awake_as_springs_break),
        cmocka_unit_test(a_network_without_a_step_finds_the_same_pile),
        cmocka_unit_test(a_step_that_ends_asleep_has_pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
