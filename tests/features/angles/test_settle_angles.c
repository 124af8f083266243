/// @file test_settle_angles.c
/// Static equilibrium with angle springs: cantilevers are those of Euler and Bernoulli, bent little and much, and
/// rest is where motion ends.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "support.h"

// A cantilever of length 1 and EI = 1: its first two particles are pinned, the second one at the origin.
static mspring_network *cantilever(uint32_t links, mspring_network_def def) {
    mspring_builder *builder = support_builder();
    const double d = 1.0 / links;
    mspring_angle_def angle;
    for (uint32_t i = 0; i < links + 2; i++) {
        const double x = ((double)i - 1) * d;
        (void)(i < 2 ? support_pinned(builder, x, 0, 1) : support_particle(builder, x, 0, (float)d));
        if (i > 0)
            (void)support_spring(builder, i - 1, i, 1e7f, 0);
    }
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
    for (uint32_t i = 0; i < links; i++) {
        const mspring_id three[] = {i, i + 1, i + 2};
        angle.stiffness = (float)((i == 0 ? 2 : 1) / d);
        check_ok(mspring_network_add_angles(network, &angle, three, 1, 3, NULL));
    }
    return network;
}

static mspring_settle_result settle(mspring_network *network) {
    mspring_settle_result result = {.struct_size = sizeof result};
    check_ok(mspring_network_settle(network, NULL, &result));
    assert_true(result.is_stable);
    return result;
}

// Bent little: P / (3 EI), and links add 1 / (2 n^2). The square of the sag, 1e-4 of the length, is what geometry
// takes; single precision keeps 1e-7 of positions.
static void bent_little_they_are_linear(void **state) {
    (void)state;
    for (uint32_t links = 5; links <= 80; links *= 2) {
        mspring_network *network = cantilever(links, support_def(0, 1));
        check_ok(mspring_network_apply_force(network, links + 1, 0, -0.03f));
        const mspring_settle_result result = settle(network);
        assert_true(result.iterations <= 5);
        check_near(support_position(network, links + 1).y, -0.01 * (1 + 0.5 / (links * links)), 3e-6);
        mspring_network_destroy(network);
    }
}

// Bent much: the elastica, whose tip Bisshopp and Drucker (1945) gave by elliptic integrals; the digits are
// Mattiasson's (1981). 100 links are within 1e-4 of it.
static void bent_much_they_are_the_elastica(void **state) {
    (void)state;
    static const double tips[][3] = {// P L^2 / EI, sag, and how much nearer the tip is
                                     {1, 0.30172, 0.05643},
                                     {3, 0.60325, 0.25442},
                                     {10, 0.81061, 0.55500}};
    for (size_t i = 0; i < COUNT_OF(tips); i++) {
        mspring_network *network = cantilever(100, support_def(0, 1));
        check_ok(mspring_network_apply_force(network, 101, 0, (float)-tips[i][0]));
        const mspring_settle_result result = settle(network);
        const support_point tip = support_position(network, 101);
        printf("P = %g: sag %.5f, nearer by %.5f, %u iterations\n", tips[i][0], -tip.y, 1 - tip.x,
               (unsigned)result.iterations);
        check_near(-tip.y, tips[i][1], 3e-4);
        check_near(1 - tip.x, tips[i][2], 3e-4);
        mspring_network_destroy(network);
    }
}

// Told to curl without a load each angle is its rest angle, to a ring and beyond. With weight, rest is where damped
// motion ends.
static void rest_is_where_motion_ends(void **state) {
    (void)state;
    const double ring = 6.283185307179586 / 12, little = 0.1;
    mspring_network_def def = support_def(0, 4);
    mspring_network *curled = cantilever(12, def);
    check_ok(support_set_rest_angles(curled, 0, 12, &ring, 0));
    (void)settle(curled);
    for (mspring_id angle = 0; angle < 12; angle++) {
        support_angle_info info;
        check_ok(support_get_angle_info(curled, angle, &info));
        check_near(info.angle, ring, 1e-5);
    }
    mspring_network_destroy(curled);
    def.settings.gravity_y = -2;
    def.settings.solver = MSPRING_SOLVER_DIRECT;
    def.settings.global_damping = 6;
    def.flags = MSPRING_NETWORK_PRECISE;
    mspring_network *settled = cantilever(12, def), *moved = cantilever(12, def);
    check_ok(support_set_rest_angles(settled, 0, 12, &little, 0));
    check_ok(support_set_rest_angles(moved, 0, 12, &little, 0));
    (void)settle(settled);
    support_steps(moved, 600, 1.0 / 64);
    for (mspring_id p = 2; p < 14; p++) {
        check_near(support_position(settled, p).x, support_position(moved, p).x, 1e-4);
        check_near(support_position(settled, p).y, support_position(moved, p).y, 1e-4);
    }
    mspring_network_destroy(settled);
    mspring_network_destroy(moved);
}

// An angle that no springs lie along counts: it makes a beam stiffer. One that is open does not: what was behind it
// floats.
static void others_count_as_they_are(void **state) {
    (void)state;
    static const mspring_id apart[] = {0, 2, 4}, broken = 4;
    double sags[2] = {0, 0};
    for (int has_more = 0; has_more < 2; has_more++) {
        mspring_network *network = cantilever(4, support_def(0, 1));
        mspring_angle_def angle;
        check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
        angle.stiffness = 4;
        if (has_more)
            check_ok(mspring_network_add_angles(network, &angle, apart, 1, 3, NULL));
        check_ok(mspring_network_apply_force(network, 4, 0, -0.1f));
        check_ok(mspring_network_break_springs(network, &broken, 0, 1));
        (void)settle(network);
        sags[has_more] = -support_position(network, 4).y;
        check_near(support_position(network, 5).y, 0, 0);
        mspring_network_destroy(network);
    }
    assert_true(sags[1] > 0.001 && sags[1] < 0.9 * sags[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bent_little_they_are_linear),
        cmocka_unit_test(bent_much_they_are_the_elastica),
        cmocka_unit_test(rest_is_where_motion_ends),
        cmocka_unit_test(others_count_as_they_are),
    };
    return cmocka_run_group_tests_name("settle_angles", tests, NULL, NULL);
}
