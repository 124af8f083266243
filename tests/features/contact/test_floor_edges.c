/// @file test_floor_edges.c
/// The floor where it is hard to see: deep in a narrow corner, under what sleeps, and far below what has not begun
/// to fall.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "recipe.h"
#include "support.h"

static void lay_floor(mspring_network *network, const double plane[4], const float *heights, uint32_t height_count,
                      float restitution) {
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = plane;
    def.plane_count = plane ? 1 : 0;
    def.heights = heights;
    def.height_count = height_count;
    def.heights_x = -1;
    def.spacing = 2;
    def.restitution = restitution;
    def.friction = 1;
    check_ok(mspring_network_set_floor(network, &def));
}

/// Between a wall and a steep slope, deep below where they meet: putting it onto one and the other in turn would
/// take hundreds of turns, so it is lifted to where both end.
static void what_begins_deep_in_a_corner_is_lifted(void **state) {
    (void)state;
    const double wall[4] = {0, 0, 1, 0};
    const float slope[2] = {-20, 20};
    const double starts[][2] = {{0.5, -5}, {-3, -5}, {0.1, -0.5}};
    for (size_t i = 0; i < COUNT_OF(starts); i++) {
        mspring_builder *builder = support_builder();
        const mspring_id one = support_particle(builder, starts[i][0], starts[i][1], 1);
        const mspring_network_def def = support_def(-9.8f, 4);
        mspring_network *network = support_network(builder, &def);
        lay_floor(network, wall, slope, 2, 0);
        support_steps(network, 1, 1.0 / 64);
        const support_point at = support_position(network, one), goes = support_velocity(network, one);
        check_near(at.x, 0, 1e-6);
        check_near(at.y, 0, 1e-4); // it may have slid by some of a step's fall since
        check_near(hypot(goes.x, goes.y), 0, 9.8 / 64);
        mspring_network_destroy(network);
    }
}

/// A pressed spring throws a particle at the floor, which is out of reach of all that moves when the step begins.
static void what_a_spring_throws_meets_the_floor(void **state) {
    (void)state;
    const double level[4] = {0, 0, 0, 1};
    mspring_builder *builder = support_builder();
    const mspring_id low = support_particle(builder, 0, 0.3, 1), high = support_particle(builder, 0, 1.3, 1);
    mspring_spring_def spring = mspring_spring_def_default();
    spring.a = low, spring.b = high, spring.stiffness = 1e4f, spring.rest_length = 1.9f;
    check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    const mspring_network_def def = support_def(0, 64);
    mspring_network *network = support_network(builder, &def);
    lay_floor(network, level, NULL, 0, 0);
    support_steps(network, 1, 1.0 / 120); // without a floor it would be 0.3 m below it
    assert_true(support_position(network, low).y > -1e-4 && support_position(network, high).y > 1.5);
    mspring_network_destroy(network);
}

/// All is slow at first, so that only gravity tells how far anything may get in a step of many substeps.
static void what_begins_to_fall_meets_the_floor_on_its_way(void **state) {
    (void)state;
    const double level[4] = {0, 0, 0, 1}, height = 0.5, dt = 0.5, g = 9.8;
    mspring_builder *builder = support_builder();
    const mspring_id loose = support_particle(builder, 0, height, 1);
    const mspring_id a = support_particle(builder, 5, height, 1), b = support_particle(builder, 6, height, 1);
    support_spring(builder, a, b, 100, 0);
    const mspring_network_def def = support_def((float)-g, 512);
    mspring_network *network = support_network(builder, &def);
    lay_floor(network, level, NULL, 0, 1);
    const float slow[3] = {0.05f, 0.05f, 0.05f}, none[3] = {0, 0, 0};
    check_ok(mspring_network_set_velocities(network, NULL, 0, 3, slow, none, 1));
    support_steps(network, 1, dt);
    // Down in sqrt(2 height / g), and up again as fast as it came. A substep is 1 ms, in which it goes 3 mm.
    const double left = dt - sqrt(2 * height / g), speed = sqrt(2 * g * height);
    const mspring_id all[] = {loose, a, b};
    for (size_t i = 0; i < COUNT_OF(all); i++) {
        check_near(support_position(network, all[i]).y, speed * left - g / 2 * left * left, 0.01);
        check_near(support_velocity(network, all[i]).y, speed - g * left, 0.02);
    }
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------- what sleeps */

enum { STRANDS = 24, LONG = 4 };

static void push_down(const mspring_hook_args *args, void *user) {
    const mspring_id *particle = user;
    for (uint32_t slot = 0; slot < args->slot_count; slot++) {
        if (args->particle_of_slot[slot] == *particle) {
            args->vy[slot] = -5;
        }
    }
}

/// Strands on a slope, of which some are kicked: the floor does nothing to those that sleep, even if a hook says
/// that they go down. It wakes them, and after that the floor has them.
static void the_floor_leaves_alone_what_sleeps(void **state) {
    (void)state;
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {500, 500}, .damping = {5, 5}};
    const float slope[2] = {0.3f, -0.3f};
    recipe made = {0};
    for (uint32_t i = 0; i < STRANDS; i++) {
        const mspring_id from = recipe_particle(&made, 1.0 * i / STRANDS - 0.5, 0.4, 1, 0);
        const mspring_id to = recipe_particle(&made, 1.0 * i / STRANDS - 0.48, 0.41, 1, 0);
        recipe_rope(&made, from, to, LONG - 1, &stuff, &seed);
    }
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.sleep_speed = 0.02f;
    def.settings.sleep_time = 0.2f;
    def.settings.global_damping = 10;
    mspring_network *network = recipe_network(&made, &def);
    lay_floor(network, NULL, slope, 2, 0);
    for (int i = 0; i < 3000 && !support_is_asleep(network); i++) {
        support_steps(network, 1, 1.0 / 64);
    }
    assert_int_equal(support_is_asleep(network), 1);
    const float kick = 0.5f;
    for (mspring_id p = 0; p < made.particle_count; p += 3 * LONG) {
        check_ok(mspring_network_set_velocities(network, NULL, p, 1, &kick, &kick, 1));
    }
    double x[STRANDS * LONG], y[STRANDS * LONG];
    uint8_t sleeps[STRANDS * LONG];
    uint32_t count = 0;
    check_ok(mspring_network_get_positions(network, NULL, 0, STRANDS * LONG, x, y, 1));
    support_steps(network, 5, 1.0 / 64);
    check_ok(support_get_sleepers(network, 0, STRANDS * LONG, sleeps, 1));
    for (mspring_id p = 0; p < STRANDS * LONG; p++) {
        if (sleeps[p]) {
            check_near(support_position(network, p).x, x[p], 0);
            check_near(support_position(network, p).y, y[p], 0);
            count++;
        }
    }
    assert_int_equal(count, STRANDS * LONG * 2 / 3);
    mspring_id pushed = LONG;
    uint32_t hook;
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, push_down, &pushed, &hook));
    support_steps(network, 1, 1.0 / 64);
    check_near(support_position(network, pushed).x, x[pushed], 0);
    check_near(support_position(network, pushed).y, y[pushed], 0);
    check_near(support_velocity(network, pushed).y, -5, 0);
    check_ok(support_get_sleepers(network, pushed, 1, sleeps, 1));
    assert_int_equal(sleeps[0], 0);
    check_ok(mspring_network_remove_hook(network, hook));
    support_steps(network, 1, 1.0 / 64);
    assert_true(support_velocity(network, pushed).y > -0.5);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A force for one step throws a loose particle, and one of a pair, at a floor they would not come near without.
/// They bounce in the middle of the step, as in closed forms: with explicit substeps of dt / n the speed at the
/// floor is off by no more than one substep's gain, and so is, twice, the height at the end.
static void what_is_thrown_bounces_on_its_way(void **state) {
    (void)state;
    const double level[4] = {0, 0, 0, 1}, height = 1, dt = 1.0 / 64, push = 30000, substeps = 400;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, height, 1);
    const mspring_id a = support_particle(builder, 5, height, 1), b = support_particle(builder, 6, height, 1);
    support_spring(builder, a, b, 100, 0);
    const mspring_network_def def = support_def(0, (uint32_t)substeps);
    mspring_network *network = support_network(builder, &def);
    lay_floor(network, level, NULL, 0, 1);
    for (mspring_id id = 0; id < 3; id++)
        check_ok(mspring_network_apply_force(network, id, 0, (float)-push));
    support_steps(network, 1, dt);
    // Down to the floor, and up against the force for the rest of the step.
    const double meets = sqrt(2 * height / push), speed = push * meets, left = dt - meets;
    const double goes = speed - push * left, gain = push * dt / substeps;
    const double y = speed * left - push * left * left / 2;
    for (mspring_id id = 0; id < 3; id++) {
        check_near(support_velocity(network, id).y, goes, 2 * gain);
        check_near(support_position(network, id).y, y, 2 * gain * dt);
        assert_true(support_position(network, id).y > 0.1);
    }
    mspring_network_destroy(network);
}

/// Each particle of a rope lies on the floor, and the linear system holds all of them. With room for a quarter and
/// 64, particles around the last one held differed from the due speed by up to 3.6 %; with all of them, ends do
/// by 1.1 %: their springs take turns with friction.
static void a_long_rope_slides_evenly(void **state) {
    (void)state;
    const double level[4] = {0, 0, 0, 1}, dt = 1.0 / 64;
    const uint32_t count = 400, steps = 8;
    for (int direct = 0; direct < 2; direct++) {
        mspring_builder *builder = support_builder();
        for (uint32_t i = 0; i < count; i++) {
            (void)support_particle(builder, i, 0, 1);
            if (i > 0)
                support_spring(builder, i - 1, i, 1e5f, 10);
        }
        mspring_network_def def = support_def(-9.8f, 2);
        def.settings.solver = direct ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT;
        mspring_network *network = support_network(builder, &def);
        mspring_floor_def floor;
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
        floor.planes = level;
        floor.plane_count = 1;
        floor.friction = 0.5f;
        check_ok(mspring_network_set_floor(network, &floor));
        const float vx = 1, vy = 0;
        check_ok(mspring_network_set_velocities(network, NULL, 0, count, &vx, &vy, 0));
        support_steps(network, steps, dt);
        const double due = 1 - 0.5 * 9.8 * steps * dt;
        for (mspring_id id = 0; id < count; id++)
            check_near(support_velocity(network, id).x, due, 0.015 * due);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_begins_deep_in_a_corner_is_lifted),
        cmocka_unit_test(what_a_spring_throws_meets_the_floor),
        cmocka_unit_test(what_begins_to_fall_meets_the_floor_on_its_way),
        cmocka_unit_test(what_is_thrown_bounces_on_its_way),
        cmocka_unit_test(the_floor_leaves_alone_what_sleeps),
        cmocka_unit_test(a_long_rope_slides_evenly),
    };
    return cmocka_run_group_tests_name("floor_edges", tests, NULL, NULL);
}
