/// @file test_collider_errors.c
/// What is refused of colliders: bad definitions, calls for one that is not there, and calls from hooks.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "bodies.h"

#define THICKNESS 0.5
#define DT (1.0 / 64)

static mspring_collider_def shape(mspring_collider_kind kind, double x, double y) {
    mspring_collider_def def;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = kind;
    def.x = x;
    def.y = y;
    return def;
}

/// A body that falls onto three colliders.
static mspring_network *make_network(void) {
    bodies *b = bodies_begin(DT / 30);
    const bodies_lattice block = {.width = 6, .height = 3, .x = -2, .y = 4, .spacing = 1, .mass = 20, .f = 0.3};
    (void)bodies_add(b, &block);
    const mspring_network_def def = support_def(-9.8f, 30);
    mspring_network *network = bodies_network(b, &def);
    bodies_free(b);
    check_ok(bodies_touch(network, THICKNESS, 0.4f, 0.3f));
    for (uint32_t i = 0; i < 3; i++) {
        mspring_collider_def box = shape(MSPRING_COLLIDER_BOX, 4.0 * i - 4, 0);
        box.width = 3;
        check_ok(mspring_network_add_collider(network, &box, NULL));
    }
    return network;
}

static void check_refused(mspring_network *network, const mspring_collider_def *def, const char *part) {
    mspring_id id = 12345;
    check_error(mspring_network_add_collider(network, def, &id), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), part);
    assert_int_equal(id, 12345);
}

static void bad_definitions_are_refused(void **state) {
    (void)state;
    mspring_network *network = make_network();
    double points[8] = {0, 0, 1, 0, 1, 0, 0, 0};
    mspring_collider_def good[3] = {shape(MSPRING_COLLIDER_CHAIN, 0, 0), shape(MSPRING_COLLIDER_BOX, 0, 0),
                                    shape(MSPRING_COLLIDER_CIRCLE, 0, 0)};
    good[2].radius = 1;
#define REFUSED(kind, member, value, part)                                                                         \
    do {                                                                                                           \
        mspring_collider_def bad = good[kind];                                                                     \
        bad.member = (value);                                                                                      \
        check_refused(network, &bad, part);                                                                        \
    } while (0)
    for (int i = 0; i < 4; i++) {
        const double wrong[4] = {NAN, INFINITY, -INFINITY, 1.1e12};
        REFUSED(1, x, wrong[i], "position");
        REFUSED(1, y, wrong[i], "position");
        REFUSED(1, angle, wrong[i], "angle");
        REFUSED(1, width, wrong[i], "width");
        REFUSED(1, height, wrong[i], "height");
        REFUSED(1, radius, wrong[i], "radius");
        REFUSED(2, radius, wrong[i], "radius");
        REFUSED(1, friction, (float)wrong[i], "friction");
        REFUSED(1, restitution, (float)wrong[i], "restitution");
    }
    REFUSED(1, angle, 1.1e6, "angle");
    REFUSED(1, width, 0, "width");
    REFUSED(1, height, -1, "height");
    REFUSED(1, radius, -1, "radius");
    REFUSED(2, radius, 0, "radius");
    REFUSED(1, friction, -1, "friction");
    REFUSED(1, restitution, 1.1f, "restitution");
    REFUSED(1, kind, (mspring_collider_kind)3, "kind");
    REFUSED(1, kind, (mspring_collider_kind)-1, "kind");
    REFUSED(0, flags, 2, "flags");
    REFUSED(1, flags, MSPRING_COLLIDER_CLOSED, "only chains");
    REFUSED(2, point_count, 1, "only chains");
    REFUSED(1, reserved_pointer, points, "reserved");
    REFUSED(0, point_count, 0, "has 0 points");
    REFUSED(0, point_count, 1, "2 to");
    REFUSED(0, point_count, 2, "NULL");
    REFUSED(0, point_count, MSPRING_MAX_COLLIDER_POINTS + 1, "has 65537 points");
    mspring_collider_def chain = good[0];
    chain.points = points;
    chain.point_count = 4;
    check_refused(network, &chain, "points 1 and 2 are the same");
    points[4] = 2;
    chain.flags = MSPRING_COLLIDER_CLOSED;
    check_refused(network, &chain, "points 3 and 0 are the same");
    chain.point_count = 2;
    check_refused(network, &chain, "3 to");
    chain.point_count = 4;
    points[4] = 1, points[5] = 1;
    points[7] = NAN;
    check_refused(network, &chain, "point 3");
    points[7] = 1;
    points[0] = 0, points[1] = 0, points[2] = 1, points[3] = 1, points[4] = 1, points[5] = 0,
    points[6] = 0; // the sides cross
    check_ok(mspring_network_add_collider(network, &chain, NULL));
    check_error(mspring_network_add_collider(network, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    support_steps(network, 50, DT);
    mspring_network_destroy(network);
#undef REFUSED
}

static void bad_calls_are_refused(void **state) {
    (void)state;
    mspring_network *network = make_network();
    mspring_collider_def def = {.struct_size = sizeof def};
    double x, y, angular;
    for (mspring_id id = 3; id != 2; id = id == 3 ? MSPRING_NONE : 2) {
        check_error(mspring_network_move_collider(network, id, 0, 0, 0), MSPRING_ERROR_ID);
        check_contains(mspring_network_error(network), "there is no collider");
        check_error(mspring_network_place_collider(network, id, 0, 0, 0), MSPRING_ERROR_ID);
        check_error(mspring_network_remove_collider(network, id), MSPRING_ERROR_ID);
        check_error(mspring_network_get_collider(network, id, &def), MSPRING_ERROR_ID);
        check_error(mspring_network_get_collider_impulse(network, id, &x, &y, &angular), MSPRING_ERROR_ID);
    }
    const double wrong[] = {NAN, INFINITY, 2e12};
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        check_error(mspring_network_move_collider(network, 0, wrong[i], 0, 0), MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_move_collider(network, 0, 0, wrong[i], 0), MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_move_collider(network, 0, 0, 0, wrong[i]), MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_place_collider(network, 0, 0, wrong[i], 0), MSPRING_ERROR_ARGUMENT);
    }
    check_error(mspring_network_get_collider_impulse(network, 0, NULL, &y, &angular), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_collider_impulse(network, 0, &x, NULL, &angular), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_collider_impulse(network, 0, &x, &y, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_collider_impulse(NULL, 0, &x, &y, &angular), MSPRING_ERROR_ARGUMENT);
    // Without contact there are none, and what is set anew has none.
    check_ok(mspring_network_set_contact(network, NULL));
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    check_error(mspring_network_move_collider(network, 0, 0, 0, 0), MSPRING_ERROR_ID);
    check_ok(mspring_network_set_contact(network, NULL));
    const mspring_collider_def good = shape(MSPRING_COLLIDER_BOX, 0, 0);
    check_error(mspring_network_add_collider(network, &good, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "mspring_network_set_contact");
    check_error(mspring_network_move_collider(network, 0, 0, 0, 0), MSPRING_ERROR_ID);
    check_error(mspring_network_remove_collider(network, 0), MSPRING_ERROR_ID);
    check_error(mspring_network_get_collider(network, 0, &def), MSPRING_ERROR_ID);
    check_error(mspring_network_get_collider_impulse(network, 0, &x, &y, &angular), MSPRING_ERROR_ID);
    mspring_network_destroy(network);
}

static void call_from_hook(const mspring_hook_args *args, void *user) {
    mspring_network *network = user;
    const mspring_collider_def def = shape(MSPRING_COLLIDER_BOX, 0, 0);
    (void)args;
    check_error(mspring_network_move_collider(network, 0, 0, 0, 0), MSPRING_ERROR_BUSY);
    check_error(mspring_network_add_collider(network, &def, NULL), MSPRING_ERROR_BUSY);
}

static void hooks_cannot_move_colliders(void **state) {
    (void)state;
    mspring_network *network = make_network();
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, call_from_hook, network, NULL));
    support_steps(network, 3, DT);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_definitions_are_refused),
        cmocka_unit_test(bad_calls_are_refused),
        cmocka_unit_test(hooks_cannot_move_colliders),
    };
    return cmocka_run_group_tests_name("collider_errors", tests, NULL, NULL);
}
