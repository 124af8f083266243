/// @file test_resting.c
/// Bodies that lie on each other come to rest and sleep together, blocks slide at their friction angle, and loose
/// particles bounce as high as restitution says.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bodies.h"

#define THICKNESS 0.5
#define DT (1.0 / 64)

static void lay_ground(bodies *b, uint32_t width, double y) {
    (void)bodies_add(b, &(bodies_lattice){.width = width, .height = 1, .y = y, .spacing = 1, .f = 0.1});
}

static void report(const char *format, double a, double c, double d) {
    if (getenv("CONTACT_REPORT"))
        printf(format, a, c, d);
}

/// Bars on bars, each a little aside.
static mspring_network *stack(bodies *b, mspring_solver solver, uint32_t bars, float sleep_speed) {
    lay_ground(b, 40, -THICKNESS);
    for (uint32_t i = 0; i < bars; i++)
        (void)bodies_add(b, &(bodies_lattice){.width = 12,
                                              .height = 3,
                                              .x = (i & 1) * 0.3,
                                              .y = 1 + i * (2 + THICKNESS) + 1e-3 * i,
                                              .spacing = 1,
                                              .mass = 73.4,
                                              .f = 0.5});
    mspring_network_def def = support_def(-9.8f, solver == MSPRING_SOLVER_EXPLICIT ? 40 : 2);
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(def.settings.solver);
    def.settings.global_damping = 0.5f;
    def.settings.sleep_speed = sleep_speed;
    def.settings.sleep_time = 0.5f;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.5f, 0));
    return network;
}

static void rest_in_a_stack(mspring_solver solver) {
    bodies *b = bodies_begin(DT / 40);
    mspring_network *network = stack(b, solver, 5, 0);
    support_steps(network, solver == MSPRING_SOLVER_EXPLICIT ? ROUNDS(1000) : 300, DT);
    double fastest = 0;
    uint32_t crossings;
    for (int i = 0; i < 20; i++) {
        support_steps(network, 1, DT);
        fastest = fmax(fastest, bodies_measured(b, network).fastest);
    }
    const double deepest = bodies_deepest(b, THICKNESS, &crossings);
    report("stack: fastest %.4f m/s, deepest %.4f m, top %.3f m\n", fastest, deepest, b->y[b->count - 1]);
    assert_true(fastest < 0.03);
    assert_true(deepest < 0.01);
    assert_int_equal(crossings, 0);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void stack_comes_to_rest(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        rest_in_a_stack((mspring_solver)solver);
}

static uint32_t sleepers(const mspring_network *network, const bodies *b) {
    uint8_t *asleep = calloc(b->count, 1);
    assert_non_null(asleep);
    check_ok(support_get_sleepers(network, 0, b->count, asleep, 1));
    uint32_t count = 0;
    for (uint32_t p = 0; p < b->count; p++)
        count += asleep[p];
    free(asleep);
    return count;
}

static void sleep_in_a_stack(mspring_solver solver) {
    bodies *b = bodies_begin(DT / 40);
    mspring_network *network = stack(b, solver, 3, 0.05f);
    const uint32_t lowest = 40; // the first particle of the lowest bar
    uint32_t steps = 0;
    while (!support_is_asleep(network)) {
        support_steps(network, 1, DT);
        const uint32_t count = sleepers(network, b);
        assert_true(++steps < 4000);
        assert_true(count == 0 || count == b->count);
    }
    const support_point top = support_position(network, b->count - 1);
    support_steps(network, 100, DT);
    assert_true(support_position(network, b->count - 1).y == top.y);
    // What is thrown at the lowest bar wakes all that lies on it.
    support_kick(network, lowest, 3.0f);
    support_steps(network, 2, DT);
    assert_int_equal(sleepers(network, b), 0);
    for (steps = 0; !support_is_asleep(network) && steps < 4000; steps++)
        support_steps(network, 1, DT);
    assert_true(steps < 4000);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void stack_sleeps_and_wakes_together(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        sleep_in_a_stack((mspring_solver)solver);
}

/// A block that falls asleep on the ground, and one that comes flying.
static void comer_wakes_a_sleeper(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / 40);
    lay_ground(b, 30, -THICKNESS);
    const bodies_lattice block = {.width = 4, .height = 3, .y = 1, .spacing = 1, .mass = 10, .f = 0.5};
    bodies_lattice comer = block;
    comer.x = -10, comer.y = 1.5;
    const uint32_t first = bodies_add(b, &block), second = bodies_add(b, &comer);
    for (uint32_t p = second; p < b->count; p++)
        b->vx[p] = 4;
    mspring_network_def def = support_def(-9.8f, 40);
    def.settings.sleep_speed = 0.5f;
    def.settings.sleep_time = 0.1f;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    bool slept = false;
    uint32_t steps = 0;
    for (; steps < 300 && !(slept && support_velocity(network, first).x > 0.5); steps++) {
        support_steps(network, 1, DT);
        slept |= support_sleeps(network, first);
    }
    assert_true(slept);
    assert_true(steps < 300);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// However fast something comes, it finds no sleeper that stands like a wall.
static void sleeper_takes_momentum(void **state) {
    (void)state;
    for (int i = 0; i < 12; i++) {
        bodies *b = bodies_begin(DT / 40);
        (void)bodies_add(b, &(bodies_lattice){.width = 4, .height = 3, .spacing = 1, .mass = 10, .f = 0.3});
        const uint32_t ball = bodies_add(
            b, &(bodies_lattice){.width = 1, .height = 1, .x = -30 - 0.13 * i, .spacing = 1, .mass = 50});
        mspring_network_def def = support_def(0, 40);
        def.settings.sleep_speed = 0.5f;
        def.settings.sleep_time = 0.1f;
        mspring_network *network = bodies_network(b, &def);
        check_ok(bodies_touch(network, THICKNESS, 0, 0));
        support_fall_asleep(network, DT);
        const float vx = 100, vy = 0;
        check_ok(mspring_network_set_velocities(network, NULL, ball, 1, &vx, &vy, 1));
        support_steps(network, 40, DT);
        const bodies_measure m = bodies_measured(b, network);
        check_near(m.x, 50 * 100, 0.1);
        assert_true(b->x[0] > -1);
        mspring_network_destroy(network);
        bodies_free(b);
    }
}

/* ------------------------------------------------------------------------------------------------ friction */

/// How far a block comes in four seconds on a slope of share times what friction bears, and how fast it is then.
/// The slope lies level, and gravity is tilted.
static void slide(mspring_solver solver, double share, double *way, double *speed) {
    const double friction = 0.5, angle = atan(friction * share);
    bodies *b = bodies_begin(DT / 40);
    b->damping = 0.3;
    lay_ground(b, 60, -THICKNESS);
    const uint32_t first = bodies_add(
        b, &(bodies_lattice){.width = 8, .height = 3, .x = -15.3, .y = 1, .spacing = 1, .mass = 73.4, .f = 0.5});
    mspring_network_def def = support_def(0, solver == MSPRING_SOLVER_EXPLICIT ? 40 : 4);
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(def.settings.solver);
    mspring_network *network = bodies_network(b, &def);
    check_ok(support_set_gravity(network, (float)(9.8 * sin(angle)), (float)(-9.8 * cos(angle))));
    check_ok(bodies_touch(network, THICKNESS, (float)friction, 0));
    support_steps(network, 64, DT);
    double from = 0, to = 0, v = 0;
    const double count = b->count - first;
    (void)bodies_measured(b, network);
    for (uint32_t p = first; p < b->count; p++)
        from += b->x[p] / count;
    support_steps(network, 3 * 64, DT);
    (void)bodies_measured(b, network);
    for (uint32_t p = first; p < b->count; p++) {
        to += b->x[p] / count;
        v += (double)b->vx[p] / count;
    }
    *way = to - from;
    *speed = v;
    mspring_network_destroy(network);
    bodies_free(b);
}

static void slide_on_a_slope(mspring_solver solver) {
    double way, speed;
    for (double share = 0.95; share < 0.98; share += 0.02) {
        slide(solver, share, &way, &speed);
        report("slope %.2f: %.4f m, %.4f m/s\n", share, way, speed);
        assert_true(fabs(way) < 0.01);
    }
    slide(solver, 1.05, &way, &speed);
    const double angle = atan(0.5 * 1.05), expected = 4 * 9.8 * (sin(angle) - 0.5 * cos(angle));
    report("slope 1.05: %.4f m, %.4f m/s of %.4f\n", way, speed, expected);
    check_near(speed, expected, 0.03 * expected);
}

static void block_slides_at_its_friction_angle(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        slide_on_a_slope((mspring_solver)solver);
}

static void lay_collider(mspring_network *network, double y, float friction) {
    const double points[] = {-100, y, 100, y};
    mspring_collider_def def;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.points = points;
    def.point_count = 2;
    def.friction = friction;
    check_ok(mspring_network_add_collider(network, &def, NULL));
}

/// A light block slides to a stop while 10,000 times its weight lies far above. Its contacts carry less than a
/// thousandth of the largest push: as long as these asked for no other solution, it stuck after 0.4 of 2.7 m.
static void brake_beside_a_heavy_one(mspring_solver solver) {
    const double speed = 4, friction = 0.3;
    bodies *b = bodies_begin(DT / 40);
    bodies_lattice block = {.width = 3, .height = 2, .y = 0.5 + THICKNESS, .spacing = 1, .mass = 1, .f = 0.3};
    (void)bodies_add(b, &block);
    for (uint32_t p = 0; p < b->count; p++)
        b->vx[p] = (float)speed;
    block.y += 30, block.mass = 1e4;
    (void)bodies_add(b, &block);
    mspring_network_def def = support_def(-9.8f, 2);
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(def.settings.solver);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, (float)friction, 0));
    lay_collider(network, 0, (float)friction);
    lay_collider(network, 30, (float)friction);
    const double from = support_position(network, 0).x, expected = speed * speed / (2 * friction * 9.8);
    support_steps(network, 100, DT);
    const double way = support_position(network, 0).x - from;
    report("beside a heavy one: %.4f m of %.4f, solver %.0f\n", way, expected, (double)solver);
    check_near(way, expected, 0.02 * expected);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void light_block_slides_beside_a_heavy_one(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        brake_beside_a_heavy_one((mspring_solver)solver);
}

/* ---------------------------------------------------------------------------------------------------- work */

/// Five bars at rest on a collider, which gives way a little: 7 and 18 calm steps a step. As long as that was mended
/// in each substep, springs gained by it, and substeps were taken in 16 parts: 91 and 191.
static void rest_on_a_collider(mspring_solver solver) {
    const double thickness = 0.3;
    bodies *b = bodies_begin(DT / 40);
    for (uint32_t i = 0; i < 5; i++)
        (void)bodies_add(b, &(bodies_lattice){.width = 12,
                                              .height = 3,
                                              .x = 0.4 * (i & 1),
                                              .y = 1 + thickness + i * (2 + thickness) + 0.01 * i,
                                              .spacing = 1,
                                              .mass = 1,
                                              .f = 0.3});
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(def.settings.solver);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, thickness, 0.3f, 0));
    lay_collider(network, 0, 0.3f);
    support_steps(network, 64, DT);
    double work = 0;
    for (int step = 0; step < 32; step++) {
        support_steps(network, 1, DT);
        work += support_step_info(network).work / 32;
    }
    (void)bodies_measured(b, network);
    double lowest = thickness;
    for (uint32_t p = 0; p < b->count; p++)
        lowest = fmin(lowest, b->y[p]);
    report("on a collider: work %.1f, lowest %.4f m, solver %.0f\n", work, lowest, (double)solver);
    assert_true(work < 40);
    assert_true(lowest > 0.998 * thickness);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void stack_on_a_collider_takes_little_work(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        rest_on_a_collider((mspring_solver)solver);
}

/* -------------------------------------------------------------------------------------------------- bounce */

/// A loose particle that falls 5 m comes back with the restitution's part of its speed, within what gravity gives
/// in a substep. It never comes back higher than that rounding lets it.
static void check_bounce(mspring_solver solver, uint32_t substeps, float restitution) {
    bodies *b = bodies_begin(DT / 120);
    lay_ground(b, 5, -THICKNESS);
    const uint32_t ball =
        bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .x = 0.2, .y = 5, .spacing = 1, .mass = 3});
    mspring_network_def def = support_def(-9.8f, substeps);
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(def.settings.solver);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.5f, restitution));
    double low = 5, high = 0;
    bool is_back = false;
    for (int step = 0; step < 200; step++) {
        support_steps(network, 1, DT);
        const double y = support_position(network, ball).y, v = support_velocity(network, ball).y;
        low = fmin(low, y);
        is_back |= v > 0;
        high = is_back && step < 130 ? fmax(high, y) : high;
    }
    report("restitution %.2f: back to %.4f m, of speed %.4f\n", (double)restitution, high, sqrt(high / 5));
    assert_true(low > -1e-3);
    assert_true(high < 5 + 1e-3);
    check_near(sqrt(high / 5), (double)restitution, substeps > 1 ? 0.01 : 0.02);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void loose_particles_bounce(void **state) {
    (void)state;
    static const float restitutions[] = {0.5f, 0.8f, 1.0f};
    for (uint32_t i = 0; i < COUNT_OF(restitutions); i++) {
        check_bounce(MSPRING_SOLVER_EXPLICIT, 120, restitutions[i]);
        for (uint32_t substeps = 1; substeps <= 16; substeps *= 4) {
            check_bounce(MSPRING_SOLVER_IMPLICIT, substeps, restitutions[i]);
            check_bounce(MSPRING_SOLVER_DIRECT, substeps, restitutions[i]);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stack_comes_to_rest),
        cmocka_unit_test(stack_sleeps_and_wakes_together),
        cmocka_unit_test(comer_wakes_a_sleeper),
        cmocka_unit_test(sleeper_takes_momentum),
        cmocka_unit_test(block_slides_at_its_friction_angle),
        cmocka_unit_test(light_block_slides_beside_a_heavy_one),
        cmocka_unit_test(stack_on_a_collider_takes_little_work),
        cmocka_unit_test(loose_particles_bounce),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
