/// @file test_touch.c
/// Impulses of bodies and colliders on each particle in a step: as much as holds up what lies on them.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "bodies.h"

#include <massspring/massspring.h>

#define THICKNESS 0.2
#define DT (1.0 / 64)
#define GRAVITY 9.8f

/// Two blocks on each other, on a box.
typedef struct stack {
    bodies *b;
    mspring_network *network;
    uint32_t upper; ///< first particle of the upper one
} stack;

static stack make_stack(mspring_solver solver) {
    stack s = {.b = bodies_begin(DT / 40)};
    s.b->damping = 0.3;
    (void)bodies_add(s.b,
                     &(bodies_lattice){.width = 6, .height = 3, .y = THICKNESS, .spacing = 1, .mass = 2, .f = 0.5});
    s.upper = bodies_add(
        s.b, &(bodies_lattice){
                 .width = 4, .height = 2, .x = 1.3, .y = 2 + 2 * THICKNESS, .spacing = 1, .mass = 2, .f = 0.5});
    mspring_network_def def = support_def(0, solver == MSPRING_SOLVER_EXPLICIT ? 40 : 4);
    def.settings.solver = solver;
    def.settings.gravity_y = -GRAVITY;
    s.network = bodies_network(s.b, &def);
    check_ok(bodies_touch(s.network, THICKNESS, 0.5f, 0));
    mspring_collider_def box = mspring_collider_def_default();
    box.kind = MSPRING_COLLIDER_BOX, box.width = 40, box.y = -0.5;
    check_ok(mspring_network_add_collider(s.network, &box, NULL));
    return s;
}

static void free_stack(stack *s) {
    mspring_network_destroy(s->network);
    bodies_free(s->b);
}

static double touch_of(const mspring_network *network, mspring_id first, uint32_t count) {
    double sum = 0;
    for (mspring_id p = first; p < first + count; p++) {
        float touch = -1;
        check_ok(mspring_network_get(network, MSPRING_TOUCH, NULL, p, 1, &touch, 1));
        assert_true(touch >= -1e-6f);
        sum += (double)touch;
    }
    return sum;
}

/// Two particles that touch fall onto the floor itself, though contact keeps one from being pressed into it.
static void what_touches_falls_onto_the_floor(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / 40);
    for (int i = 0; i < 2; i++)
        (void)bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .y = (0.5 + i) * THICKNESS, .mass = 1});
    const mspring_network_def def = support_def(-GRAVITY, 40);
    mspring_network *network = bodies_network(b, &def);
    const double plane[] = {0, 0, 0, 1};
    mspring_floor_def floor = mspring_floor_def_default();
    floor.planes = plane, floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    support_steps(network, 64, DT);
    check_near(support_position(network, 0).y, 0, 1e-3 * THICKNESS);
    check_near(support_position(network, 1).y, THICKNESS, 0.05 * THICKNESS);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// What lies on a spring is carried by its ends: three quarters of it by the end that is nearer.
static void ends_of_a_spring_share_what_lies_on_it(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / 40);
    (void)bodies_add(b, &(bodies_lattice){.width = 2, .height = 1, .spacing = 1, .f = 0.1});
    (void)bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .x = -0.25, .y = THICKNESS, .mass = 3});
    const mspring_network_def def = support_def(-GRAVITY, 40);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 1, 0));
    support_steps(network, 64, DT);
    double sum = 0, right = 0;
    for (int step = 0; step < 32; step++) {
        support_steps(network, 1, DT);
        sum += touch_of(network, 0, 2);
        right += touch_of(network, 1, 1);
    }
    check_near(sum, 32 * 3 * (double)GRAVITY * DT, 0.02 * sum);
    check_near(right, 0.25 * sum, 0.01 * sum);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// At rest each body is given what it carries and its own weight from below, and from above what lies on it. Over
/// half a second, as single steps differ.
static void touch_carries_weights(void **state) {
    (void)state;
    const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
    for (int i = 0; i < 3; i++) {
        stack s = make_stack(solvers[i]);
        enum { STEPS = 32 };
        const uint32_t upper = s.b->count - s.upper, lower = s.upper;
        double on_upper = 0, on_lower = 0;
        support_steps(s.network, 400, DT);
        for (int step = 0; step < STEPS; step++) {
            support_steps(s.network, 1, DT);
            on_upper += touch_of(s.network, s.upper, upper);
            on_lower += touch_of(s.network, 0, lower);
        }
        const double second = STEPS * DT, weight = 2 * (double)GRAVITY * second;
        check_near(on_upper, weight * upper, 0.03 * weight * upper);
        check_near(on_lower, weight * (lower + 2 * upper), 0.03 * weight * (lower + 2 * upper));
        free_stack(&s);
    }
}

/// A step that fails leaves what the last one gave; one in which nothing touches leaves zeros.
static void touch_is_of_the_last_step(void **state) {
    (void)state;
    stack s = make_stack(MSPRING_SOLVER_EXPLICIT);
    assert_true(touch_of(s.network, 0, s.b->count) == 0);
    support_steps(s.network, 200, DT);
    const double last = touch_of(s.network, 0, s.b->count);
    assert_true(last > 0);
    const float fast = 2e6f; // beyond max_speed
    float vx, vy;
    check_ok(mspring_network_get_velocities(s.network, NULL, 0, 1, &vx, &vy, 1));
    mspring_settings settings = support_settings(s.network);
    settings.guard = MSPRING_GUARD_BOUNDS;
    check_ok(mspring_network_set_settings(s.network, &settings));
    check_ok(mspring_network_set_velocities(s.network, NULL, 0, 1, &fast, &fast, 0));
    check_error(mspring_network_step(s.network, DT), MSPRING_ERROR_UNSTABLE);
    assert_true(touch_of(s.network, 0, s.b->count) == last);
    check_ok(mspring_network_set_velocities(s.network, NULL, 0, 1, &vx, &vy, 0));
    for (uint32_t p = 0; p < s.b->count; p++) { // all fly up, the lower ones more slowly
        const float up = p < s.upper ? 20 : 60, none = 0;
        check_ok(mspring_network_set_velocities(s.network, NULL, p, 1, &none, &up, 0));
    }
    support_steps(s.network, 4, DT);
    assert_true(touch_of(s.network, 0, s.b->count) == 0);
    check_ok(mspring_network_set_contact(s.network, NULL));
    assert_true(touch_of(s.network, 0, s.b->count) == 0);
    free_stack(&s);
}

/// Sleepers keep what held them when they fell asleep.
static void touch_stays_in_sleep(void **state) {
    (void)state;
    stack s = make_stack(MSPRING_SOLVER_EXPLICIT);
    mspring_settings settings = support_settings(s.network);
    settings.sleep_speed = 0.05f;
    check_ok(mspring_network_set_settings(s.network, &settings));
    support_fall_asleep(s.network, DT);
    const double asleep = touch_of(s.network, 0, s.b->count);
    const double weight = 2 * (double)GRAVITY * DT;
    check_near(asleep, weight * (s.upper + 3 * (s.b->count - s.upper)), 0.3 * asleep); // of one step
    support_steps(s.network, 100, DT);
    assert_true(touch_of(s.network, 0, s.b->count) == asleep);
    free_stack(&s);
}

static double floor_of(const mspring_network *network, uint32_t count) {
    double sum = 0;
    for (mspring_id p = 0; p < count; p++) {
        float y = 0;
        check_ok(mspring_network_get(network, MSPRING_FLOOR_IMPULSE_Y, NULL, p, 1, &y, 1));
        sum += (double)y;
    }
    return sum;
}

/// A body that is put back has not been touched, by the floor neither, nor is one in a snapshot: what it was given
/// then is not in it.
static void touch_begins_anew(void **state) {
    (void)state;
    stack s = make_stack(MSPRING_SOLVER_EXPLICIT);
    mspring_floor_def floor = mspring_floor_def_default();
    floor.heights = (const float[]){0.21f, 0.21f, -1, -1}; // above the box to the left
    floor.height_count = 4;
    check_ok(mspring_network_set_floor(s.network, &floor));
    mspring_settings settings = support_settings(s.network);
    settings.guard = MSPRING_GUARD_BOUNDS;
    check_ok(mspring_network_set_settings(s.network, &settings));
    const mspring_id count = s.b->count, firsts[] = {0, s.upper, count};
    check_ok(mspring_network_set_groups(s.network, firsts, 2));
    size_t size;
    check_ok(mspring_network_get_snapshot_size(s.network, MSPRING_SNAPSHOT_FRAME, &size));
    void *snapshot = malloc(size);
    assert_non_null(snapshot);
    check_ok(mspring_network_save(s.network, MSPRING_SNAPSHOT_FRAME, snapshot, size, NULL));
    for (int twice = 0; twice < 2; twice++) {
        support_steps(s.network, 200, DT);
        assert_true(touch_of(s.network, 0, count) > 0 && floor_of(s.network, count) > 0);
        if (twice)
            check_ok(mspring_network_load(s.network, snapshot, size));
        else
            check_ok(mspring_network_reset_groups(s.network, MSPRING_RESET_START, &(mspring_id){0}, 0, 1));
        assert_true(touch_of(s.network, 0, s.upper) == 0 && floor_of(s.network, s.upper) == 0);
        assert_true((touch_of(s.network, s.upper, count - s.upper) > 0) == !twice);
    }
    free(snapshot);
    free_stack(&s);
}

/// A collider is in no group: all of them come to lie on it, and within each one particle on the other.
static void a_collider_holds_every_group(void **state) {
    (void)state;
    enum { COUNT = 6 };
    const mspring_id firsts[4] = {0, 2, 4, COUNT};
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < COUNT; i++)
        support_particle(builder, i / 2, 1 + i % 2, 1);
    mspring_network_def def = support_def(-9.8f, 8);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    mspring_collider_def box;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.1;
    check_ok(mspring_network_set_contact(network, &contact));
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &box, sizeof box));
    box.kind = MSPRING_COLLIDER_BOX, box.x = 5, box.y = -0.5, box.width = 40, box.height = 1;
    check_ok(mspring_network_add_collider(network, &box, NULL));
    check_ok(mspring_network_set_groups(network, firsts, 3));
    support_steps(network, 64, 1.0 / 64);
    for (mspring_id p = 0; p < COUNT; p++)
        check_near(support_position(network, p).y, p % 2 ? 0.2 : 0.1, 0.02);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_touches_falls_onto_the_floor),
        cmocka_unit_test(ends_of_a_spring_share_what_lies_on_it),
        cmocka_unit_test(touch_carries_weights),
        cmocka_unit_test(touch_is_of_the_last_step),
        cmocka_unit_test(touch_stays_in_sleep),
        cmocka_unit_test(touch_begins_anew),
        cmocka_unit_test(a_collider_holds_every_group),
    };
    return cmocka_run_group_tests_name("touch", tests, NULL, NULL);
}
