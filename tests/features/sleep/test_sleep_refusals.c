/// @file test_sleep_refusals.c
/// Steps that are refused wake nothing, and what lies on a floor sleeps there until it is moved.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <stdlib.h>

#include "changes.h"
#include "recipe.h"
#include "snapshots.h"
#include "support.h"

#define DT (1.0 / 64)

static mspring_network_def def_of_sleepers(void) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.global_damping = 4;
    def.settings.sleep_speed = 0.01f;
    return def;
}

static double floor_impulse(const mspring_network *network) {
    enum { COUNT = 21 };
    float x[COUNT], y[COUNT];
    double sum = 0;
    check_ok(mspring_network_get_columns(
        network, NULL, 0, COUNT,
        (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2));
    for (int i = 0; i < COUNT; i++) {
        sum += (double)y[i];
    }
    return sum;
}

/// 7 by 3 particles that sleep on a floor at height 0.
static mspring_network *make_lying(uint32_t spring_flags) {
    uint64_t seed = 5;
    const bool relative = spring_flags & MSPRING_SPRING_RELATIVE;
    const recipe_stuff stuff = {.mass = {1, 1},
                                .stiffness = {relative ? 0.2 : 2000, relative ? 0.2 : 2000},
                                .damping = {relative ? 0.05 : 20, relative ? 0.05 : 20},
                                .spring_flags = spring_flags};
    recipe made = {0};
    recipe_lattice(&made, 7, 3, 0, 0.25, 1, &stuff, &seed);
    const mspring_network_def network_def = def_of_sleepers();
    mspring_network *network = recipe_network(&made, &network_def);
    recipe_free(&made);
    mspring_floor_def def;
    const double level[4] = {0, 0, 0, 1};
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = level;
    def.plane_count = 1;
    def.friction = 1;
    check_ok(mspring_network_set_floor(network, &def));
    support_fall_asleep(network, DT);
    return network;
}

/// By whole metres, so that it is where it was relative to the local origin.
static void it_wakes_where_it_is_put(void **state) {
    (void)state;
    mspring_network *network = make_lying(0);
    double x[21], y[21], up[21];
    check_ok(mspring_network_get_positions(network, NULL, 0, 21, x, y, 1));
    for (int i = 0; i < 21; i++) {
        up[i] = y[i] + 10;
    }
    check_ok(mspring_network_set_positions(network, NULL, 0, 21, x, up, 1));
    assert_int_equal(support_is_asleep(network), 0);
    support_fall_asleep(network, DT);
    for (mspring_id p = 0; p < 21; p++) {
        check_near(support_position(network, p).y, y[p], 0.01);
    }
    mspring_network_destroy(network);
}

static void call_nothing(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

/// The floor goes on bearing what sleeps on it, whether its steps have something to do or not.
static void the_floor_bears_what_sleeps(void **state) {
    (void)state;
    for (int hooked = 0; hooked < 2; hooked++) {
        mspring_network *network = make_lying(0);
        const double before = floor_impulse(network);
        check_near(before, 21 * 9.8 * DT, 0.05 * before);
        if (hooked) {
            check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, call_nothing, NULL, NULL));
        }
        support_steps(network, 3, DT);
        assert_int_equal(support_is_asleep(network), 1);
        check_near(floor_impulse(network), before, 0);
        mspring_network_destroy(network);
    }
}

/// Refused for the length of its substeps, which relative springs would follow, or for where a force would throw
/// it.
static void refused_steps_wake_nothing(void **state) {
    (void)state;
    mspring_network *network = make_lying(MSPRING_SPRING_RELATIVE);
    check_error(mspring_network_step(network, 1e-40), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(support_is_asleep(network), 1);
    mspring_network_destroy(network);
    network = make_lying(0);
    const double before = floor_impulse(network);
    check_ok(mspring_network_apply_force(network, 3, 0, 1e9f));
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    assert_int_equal(support_is_asleep(network), 1);
    check_near(floor_impulse(network), before, 0);
    // Taken back, it leaves nothing behind.
    check_ok(mspring_network_apply_force(network, 3, 0, -1e9f));
    const uint64_t hash = support_hash(network);
    support_steps(network, 10, DT);
    assert_int_equal(support_hash(network), hash);
    mspring_network_destroy(network);
}

/// Two weights on damped springs, each at rest on its own; the second, particle 3, has just been kicked.
static mspring_network *make_two_weights(void) {
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 2; i++) {
        const mspring_id pin = support_pinned(builder, 5 * i, 0, 1),
                         weight = support_particle(builder, 5 * i, -1, 1);
        support_spring(builder, pin, weight, 100, 5);
    }
    const mspring_network_def def = def_of_sleepers();
    mspring_network *network = support_network(builder, &def);
    support_fall_asleep(network, DT);
    support_kick(network, 3, 1);
    support_steps(network, 1, DT);
    assert_true(support_sleeps(network, 1) && !support_sleeps(network, 3));
    return network;
}

/// A step that is refused as the second weight would be thrown away.
static void try_a_step(mspring_network *network) {
    check_ok(mspring_network_apply_force(network, 3, 0, 1e30f));
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    check_ok(mspring_network_apply_force(network, 3, 0, -1e30f));
}

/// The first weight, asleep, has been moved, and put back after a step that was refused.
static mspring_network *two_weights_after_a_refusal(void) {
    mspring_network *network = make_two_weights();
    const support_point at = support_position(network, 1);
    change_shift(network, 1, MSPRING_NONE);
    try_a_step(network);
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &at.x, &at.y, 1));
    return network;
}

/// What would have woken in a step that is refused is the only sleeper then; put back, it sleeps on.
static void the_only_sleeper_sleeps_on_after_a_refusal(void **state) {
    (void)state;
    mspring_network *network = two_weights_after_a_refusal();
    const support_point at = support_position(network, 1);
    for (int step = 0; step < 10; step++) {
        const support_point before = support_position(network, 3);
        support_steps(network, 1, DT);
        assert_true(support_position(network, 3).x != before.x);
        assert_int_equal(support_sleeps(network, 1), 1);
        assert_true(support_position(network, 1).x == at.x && support_position(network, 1).y == at.y);
    }
    mspring_network_destroy(network);
}

/// What the host has woken is awake after a step that is refused, too, though it slept in one that was refused
/// before.
static void what_was_woken_stays_so_after_a_refusal(void **state) {
    (void)state;
    mspring_network *network = two_weights_after_a_refusal();
    assert_int_equal(support_sleeps(network, 1), 1);
    check_ok(mspring_network_wake(network));
    assert_int_equal(support_sleeps(network, 1), 0);
    try_a_step(network);
    assert_int_equal(support_sleeps(network, 1), 0);
    mspring_network_destroy(network);
}

enum { IN_ROW = 60, OF_BODY = 16 };

/// A row of bodies that may sleep, and two above that are pushed at each other.
static mspring_network *row_of_bodies(void) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e4, 1e4}, .damping = {10, 10}};
    mspring_network_def def = support_def(0, MSPRING_SUBSTEPS_AUTO);
    def.settings.sleep_speed = 0.01f;
    def.settings.sleep_time = 0.1f;
    recipe made = {0};
    for (int i = 0; i < IN_ROW; i++)
        recipe_lattice(&made, 4, 4, 100 + 10 * i, 300, 1, &stuff, &seed);
    for (int i = 0; i < 2; i++)
        recipe_lattice(&made, 4, 4, 100 + 8 * i, 500, 1, &stuff, &seed);
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.capacity = contact.max_capacity = 20000;
    check_ok(mspring_network_set_contact(network, &contact));
    return network;
}

/// A step that is taken again, since contact expected less speed, looks for pairs among sleepers where these are. (After
/// a load it saw all of them at the local origin, and failed for want of room.)
static void steps_taken_again_see_sleepers_where_they_are(void **state) {
    (void)state;
    float none[2 * OF_BODY], along[2 * OF_BODY], push[OF_BODY];
    for (int i = 0; i < 2 * OF_BODY; i++) {
        none[i] = 0;
        along[i] = 0.1f;
        push[i % OF_BODY] = 4e4f;
    }
    mspring_network *networks[2] = {row_of_bodies(), row_of_bodies()};
    check_ok(mspring_network_set_velocities(networks[0], NULL, IN_ROW * OF_BODY, 2 * OF_BODY, none, along, 1));
    support_steps(networks[0], 60, DT);
    assert_int_equal(support_sleeps(networks[0], 0), 1);
    saved file = snapshots_save(networks[0], MSPRING_SNAPSHOT_ALL);
    snapshots_load(networks[1], &file);
    free(file.bytes);
    for (int step = 0; step < 3; step++) {
        for (int i = 0; i < 2; i++) {
            check_ok(
                mspring_network_apply_forces(networks[i], 0, NULL, IN_ROW * OF_BODY, OF_BODY, push, none, 1));
            check_ok(mspring_network_step(networks[i], DT));
        }
        assert_true(support_hash(networks[0]) == support_hash(networks[1]));
    }
    assert_int_equal(support_sleeps(networks[1], 0), 1);
    mspring_network_destroy(networks[0]);
    mspring_network_destroy(networks[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_wakes_where_it_is_put),
        cmocka_unit_test(the_floor_bears_what_sleeps),
        cmocka_unit_test(refused_steps_wake_nothing),
        cmocka_unit_test(the_only_sleeper_sleeps_on_after_a_refusal),
        cmocka_unit_test(what_was_woken_stays_so_after_a_refusal),
        cmocka_unit_test(steps_taken_again_see_sleepers_where_they_are),
    };
    return cmocka_run_group_tests_name("sleep_refusals", tests, NULL, NULL);
}
