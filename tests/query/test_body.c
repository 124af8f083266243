/// @file test_body.c
/// Particles as one body: its numbers against closed forms and sums in long double, its turn, and torques.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "recipe.h"
#include "support.h"

static mspring_body body_of(const mspring_network *network, mspring_id first, uint32_t count) {
    mspring_body body = {.struct_size = sizeof body};
    check_ok(mspring_network_get_body(network, NULL, first, count, &body));
    assert_int_equal(body.struct_size, sizeof body);
    assert_int_equal(body.reserved, 0);
    return body;
}

/// A network without springs.
static mspring_network *loose(mspring_builder *builder, uint32_t flags) {
    mspring_network_def def = support_def(0, 1);
    def.flags = flags;
    def.spare_particles = 2;
    return support_network(builder, &def);
}

/* --------------------------------------------------------------------------------------------------- measuring */

/// Masses of 1 and 3 kg, 4 m apart, so their centre is 3 m from the first. They turn about it by 2 rad/s.
static void two_masses_have_their_closed_form(void **state) {
    (void)state;
    static const double ways[] = {0, 0x1p24, -0x1p36}; // a float has no metres there, the local origin has
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_builder *builder = support_builder();
        support_particle(builder, ways[i], 1, 1);
        support_particle(builder, ways[i] + 4, 1, 3);
        mspring_network *network = loose(builder, MSPRING_NETWORK_POSES);
        const float vx[] = {0.5f, 0.5f}, vy[] = {-6, 2};
        check_ok(mspring_network_set_velocities(network, NULL, 0, 2, vx, vy, 1));
        const mspring_body body = body_of(network, 0, 2);
        assert_int_equal(body.particle_count, 2);
        assert_int_equal(body.head, 0);
        assert_true(body.mass == 4 && body.inertia == 12 && body.spin == 2 && body.angle == 0);
        assert_true(body.x == ways[i] + 3 && body.y == 1);
        assert_true(body.vx == 0.5 && body.vy == 0 && body.px == 2 && body.py == 0);
        assert_true(body.angular == 24 - 2 * 1); // of spin, and of 2 kg m/s along x at a height of 1 m
        assert_true(body.min_x == ways[i] && body.max_x == ways[i] + 4 && body.min_y == 1 && body.max_y == 1);
        mspring_network_destroy(network);
    }
}

static void nothing_is_a_body_too(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 7, 8, 2);
    support_particle(builder, 9, 8, 2);
    mspring_network *network = loose(builder, MSPRING_NETWORK_POSES);
    mspring_body body = body_of(network, 1, 0);
    assert_int_equal(body.particle_count, 0);
    assert_int_equal(body.head, MSPRING_NONE);
    assert_true(body.mass == 0 && body.inertia == 0 && body.spin == 0 && body.angle == 0 && body.vx == 0);
    assert_true(body.x == body.min_x && body.x == body.max_x && body.y == body.max_y);
    body = body_of(network, 1, 1);
    assert_true(body.x == 9 && body.inertia == 0 && body.spin == 0 && body.angle == 0 && body.mass == 2);
    const mspring_id one = 1, both[] = {1, 0, 1};
    check_ok(mspring_network_remove_particles(network, &one, 0, 1));
    body = body_of(network, 0, 2); // ranges leave out what is removed
    assert_int_equal(body.particle_count, 1);
    assert_true(body.x == 7 && body.inertia == 0 && body.spin == 0 && body.mass == 2);
    assert_true(body.min_x == 7 && body.max_x == 7 && body.head == 0);
    mspring_body small = {.struct_size = 12};
    check_error(mspring_network_get_body(network, both, 0, 3, &body), MSPRING_ERROR_ID);
    check_error(mspring_network_get_body(network, NULL, 1, 3, &body), MSPRING_ERROR_ID);
    check_error(mspring_network_get_body(network, NULL, UINT32_MAX, 2, &body), MSPRING_ERROR_ID);
    check_error(mspring_network_get_body(network, NULL, 0, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_body(network, NULL, 0, 1, &small), MSPRING_ERROR_STRUCT);
    check_error(mspring_network_get_body(NULL, NULL, 0, 1, &body), MSPRING_ERROR_ARGUMENT);
    mspring_network_destroy(network);
}

typedef struct sums {
    long double mass, x, y, vx, vy, inertia, spin, px, py, angular;
} sums;

/// Straight from the definitions.
static sums sums_of(const mspring_network *network, const recipe *made, const mspring_id *ids, uint32_t count) {
    sums s = {0};
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < count; i++) {
            const support_point at = support_position(network, ids[i]), v = support_velocity(network, ids[i]);
            const long double m = (long double)made->particles[ids[i]].mass;
            if (pass == 0) {
                s.mass += m, s.x += m * at.x, s.y += m * at.y, s.vx += m * v.x, s.vy += m * v.y;
                if (made->particles[ids[i]].flags == 0) {
                    s.px += m * v.x, s.py += m * v.y,
                        s.angular += m * ((long double)at.x * v.y - (long double)at.y * v.x);
                }
            } else {
                const long double x = at.x - s.x, y = at.y - s.y;
                s.inertia += m * (x * x + y * y);
                s.spin += m * (x * (v.y - s.vy) - y * (v.x - s.vx));
            }
        }
        if (pass == 0) {
            s.x /= s.mass, s.y /= s.mass, s.vx /= s.mass, s.vy /= s.mass;
        }
    }
    return s;
}

static void any_list_has_its_sums(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        uint64_t draws = seed;
        recipe made = recipe_mixed(seed);
        const double away = seed % 2 ? 3e5 : 0;
        for (uint32_t i = 0; i < made.particle_count; i++) {
            made.particles[i].x += away;
        }
        const mspring_network_def def = support_def(-9.8f, 4);
        mspring_network *network = recipe_network(&made, &def);
        support_steps(network, 5, 0.001);
        mspring_id ids[60]; // some twice
        for (uint32_t i = 0; i < COUNT_OF(ids); i++) {
            ids[i] = (mspring_id)(support_random(&draws) % made.particle_count);
        }
        mspring_body body = {.struct_size = sizeof body};
        check_ok(mspring_network_get_body(network, ids, 0, COUNT_OF(ids), &body));
        const sums s = sums_of(network, &made, ids, COUNT_OF(ids));
        // 1e-9: velocities have second words that are not read, of 3e-8 of speeds of some m/s over 60 particles.
        const double slack = 1e-6 * (double)s.mass;
        check_near(body.mass, (double)s.mass, 1e-12 * (double)s.mass);
        check_near(body.x, (double)s.x, 1e-9);
        check_near(body.y, (double)s.y, 1e-9);
        check_near(body.vx, (double)s.vx, 1e-6);
        check_near(body.vy, (double)s.vy, 1e-6);
        check_near(body.inertia, (double)s.inertia, 1e-9 * (double)s.inertia);
        check_near(body.spin, (double)(s.spin / s.inertia), 1e-6);
        check_near(body.px, (double)s.px, slack);
        check_near(body.py, (double)s.py, slack);
        check_near(body.angular, (double)s.angular, slack * (100 + away));
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/* -------------------------------------------------------------------------------------------------------- turns */

enum { SOME = 40 };

static mspring_network *cloud(double away, uint32_t flags, uint64_t seed) {
    mspring_builder *builder = support_builder();
    for (int i = 0; i < SOME; i++) {
        support_particle(builder, away + support_random_between(&seed, -3, 3), support_random_between(&seed, -1, 1),
                         (float)support_random_between(&seed, 0.5, 2));
    }
    return loose(builder, flags);
}

/// Turn all particles about a point, and push them away.
static void turn(mspring_network *network, double angle, double away) {
    for (mspring_id p = 0; p < SOME; p++) {
        const support_point at = support_position(network, p);
        const double x = at.x - away, y = at.y;
        const double turned_x = away + 5 + x * cos(angle) - y * sin(angle),
                     turned_y = x * sin(angle) + y * cos(angle);
        check_ok(mspring_network_set_positions(network, NULL, p, 1, &turned_x, &turned_y, 1));
    }
}

static void turns_are_found(void **state) {
    (void)state;
    static const double angles[] = {1e-6, 0.3, 1.5, 3.1, -3.1, -0.7, -1e-3}, ways[] = {0, 1e6};
    for (size_t i = 0; i < COUNT_OF(angles) * COUNT_OF(ways); i++) {
        const double angle = angles[i % COUNT_OF(angles)], away = ways[i / COUNT_OF(angles)];
        mspring_network *network = cloud(away, MSPRING_NETWORK_POSES, i + 1);
        mspring_network *without = cloud(away, 0, i + 1);
        turn(network, angle, away);
        turn(without, angle, away);
        // Places have 48 bits within the cloud, and doubles at 1e6 m have 1e-10 m.
        check_near(body_of(network, 0, SOME).angle, angle, away > 0 ? 1e-9 : 1e-11);
        check_near(body_of(network, 3, 8).angle, angle, away > 0 ? 1e-9 : 1e-11); // of any part
        assert_true(body_of(without, 0, SOME).angle == 0);
        mspring_network_destroy(network);
        mspring_network_destroy(without);
    }
}

/// The best fit of what is bent is the angle of least squares.
static void a_bent_body_has_the_best_turn(void **state) {
    (void)state;
    mspring_network *network = cloud(0, MSPRING_NETWORK_POSES, 5), *posed = cloud(0, 0, 5);
    uint64_t seed = 9;
    turn(network, 0.8, 0);
    for (mspring_id p = 0; p < SOME; p++) {
        support_point at = support_position(network, p);
        at.x += support_random_between(&seed, -0.5, 0.5), at.y += support_random_between(&seed, -0.5, 0.5);
        check_ok(mspring_network_set_positions(network, NULL, p, 1, &at.x, &at.y, 1));
    }
    const mspring_body now = body_of(network, 0, SOME), before = body_of(posed, 0, SOME);
    double least[3] = {0};
    for (int k = 0; k < 3; k++) {
        const double angle = now.angle + (k - 1) * 1e-4;
        for (mspring_id p = 0; p < SOME; p++) {
            const support_point at = support_position(network, p), from = support_position(posed, p);
            float mass;
            check_ok(mspring_network_get(network, MSPRING_MASS, NULL, p, 1, &mass, 1));
            const double qx = from.x - before.x, qy = from.y - before.y;
            const double dx = at.x - now.x - (qx * cos(angle) - qy * sin(angle));
            const double dy = at.y - now.y - (qx * sin(angle) + qy * cos(angle));
            least[k] += (double)mass * (dx * dx + dy * dy);
        }
    }
    assert_true(least[1] < least[0] && least[1] < least[2]);
    check_near(now.angle, 0.8, 0.2);
    mspring_network_destroy(network);
    mspring_network_destroy(posed);
}

/// Copies of all kinds know the places, those of added particles, too.
static void places_come_along(void **state) {
    (void)state;
    mspring_network *network = cloud(0, MSPRING_NETWORK_POSES, 3), *clone,
                    *same = cloud(0, MSPRING_NETWORK_POSES, 4);
    mspring_particle_def def;
    mspring_id id, other;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
    turn(network, 0.5, 0);
    def.x = 9;
    check_ok(mspring_network_add_particles(network, &def, 1, &id));
    assert_int_equal(id, SOME);
    const double x = 9 + 2, y = 1; // no turn of its own
    check_ok(mspring_network_set_positions(network, NULL, id, 1, &x, &y, 1));
    const double angle = body_of(network, 0, SOME + 1).angle;
    assert_true(fabs(angle - 0.5) > 1e-3 && fabs(angle - 0.5) < 0.5);
    check_ok(mspring_network_clone(network, NULL, &clone));
    assert_true(body_of(clone, 0, SOME + 1).angle == angle);
    support_bring(network, same, MSPRING_SNAPSHOT_ALL);
    assert_true(body_of(same, 0, SOME + 1).angle == angle);
    check_ok(mspring_network_remove_particles(clone, &id, 0, 1));
    check_ok(mspring_network_reuse_ids(clone));
    def.x = 20;
    check_ok(mspring_network_add_particles(clone, &def, 1, &other));
    assert_int_equal(other, id);
    assert_true(body_of(clone, 0, SOME + 1).angle != angle);
    mspring_network *without = cloud(0, 0, 3); // no place for places
    size_t size;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
    void *bytes = malloc(size);
    assert_non_null(bytes);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, bytes, size, &size));
    check_error(mspring_network_load(without, bytes, size), MSPRING_ERROR_SNAPSHOT);
    free(bytes);
    mspring_network_destroy(network);
    mspring_network_destroy(clone);
    mspring_network_destroy(same);
    mspring_network_destroy(without);
}

/* ------------------------------------------------------------------------------------------------------ torques */

/// A free body gets the angular momentum torque * dt, no momentum, and turns rigidly.
static void a_torque_turns_and_does_not_push(void **state) {
    (void)state;
    static const double ways[] = {0, 1e7};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = cloud(ways[i], 0, i + 1);
        const double dt = 1.0 / 64;
        support_steps(network, 1, dt); // the first kick is half of one, as velocities become half a substep old
        const mspring_body before = body_of(network, 0, SOME);
        check_ok(mspring_network_apply_torque(network, NULL, 0, SOME, 3));
        support_steps(network, 1, dt);
        const mspring_body after = body_of(network, 0, SOME);
        // Forces are floats: 6e-8 of each.
        check_near(after.px, 0, 1e-8);
        check_near(after.py, 0, 1e-8);
        check_near(after.spin, 3 * dt / before.inertia, 1e-7 * 3 * dt / before.inertia);
        for (mspring_id p = 0; p < SOME; p++) {
            const support_point v = support_velocity(network, p), at = support_position(network, p);
            check_near(v.x, -after.spin * (at.y - after.y), 2e-5 * after.spin); // m that it has moved on
            check_near(v.y, after.spin * (at.x - after.x), 2e-5 * after.spin);  // m that it has moved on
        }
        support_steps(network, 1, dt); // for one step only
        check_near(body_of(network, 0, SOME).spin, after.spin, 1e-4 * after.spin);
        mspring_network_destroy(network);
    }
}

// push_at: the call before which a force of (3, 4) N pushes particle 0.
static void check_torques(int push_at) {
    mspring_builder *builder = support_builder();
    support_pinned(builder, 100, 100, 1000);
    for (int i = 0; i < 4; i++) {
        support_particle(builder, i, i % 2, 1 + (float)i);
    }
    mspring_network *network = loose(builder, 0);
    const mspring_id all[] = {4, 2, 0, 1, 3};
    support_steps(network, 1, 0.5);
    for (int i = 0; i < 3; i++) {
        if (i == push_at)
            check_ok(mspring_network_apply_force(network, 1, 3, 4));
        for (mspring_id p = 0; p < 5; p++) // what is refused leaves nothing behind
            check_error(mspring_network_apply_force(network, p, INFINITY, -INFINITY), MSPRING_ERROR_ARGUMENT);
        if (i < 2)
            check_ok(mspring_network_apply_torque(network, i == 0 ? all : NULL, 0, 5, 1.5f));
    }
    support_steps(network, 1, 0.5);
    mspring_body body = body_of(network, 1, 4);
    check_near(body.py, 2, 1e-6);
    check_near(body.px, 1.5, 1e-6);
    const double centre = (0 * 1 + 1 * 2 + 2 * 3 + 3 * 4) / 10.0; // of x, before the step
    const double height = (0 * 1 + 1 * 2 + 0 * 3 + 1 * 4) / 10.0;
    check_near(body.spin * body.inertia, 0.5 * (3 + 4 * (0 - centre) - 3 * (0 - height)), 1e-4);
    mspring_network_destroy(network);
}

/// Lists, with one that repeats, add to what acts. Pinned particles get nothing, and are not in the centre.
static void torques_add_up(void **state) {
    (void)state;
    for (int push_at = 0; push_at < 3; push_at++)
        check_torques(push_at);
}

static void bad_torques_change_nothing(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 1, 1, 1);
    support_particle(builder, 1, 1, 1);
    support_pinned(builder, 5, 1, 1);
    support_particle(builder, 1, 1 + 1e-30, 1);
    mspring_network *network = loose(builder, 0);
    mspring_network *same;
    const mspring_id bad[] = {0, 7};
    check_ok(mspring_network_clone(network, NULL, &same));
    check_error(mspring_network_apply_torque(network, NULL, 0, 3, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "all in one place");
    check_error(mspring_network_apply_torque(network, NULL, 0, 1, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_torque(network, NULL, 0, 0, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_torque(network, NULL, 0, 4, (float)NAN), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_torque(network, NULL, 0, 4, (float)INFINITY), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_torque(network, bad, 0, 2, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_apply_torque(network, NULL, 1, UINT32_MAX - 1, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_apply_torque(network, bad, 0, MSPRING_ALL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_torque(NULL, NULL, 0, 1, 1), MSPRING_ERROR_ARGUMENT);
    const double near = 1 + 0x1p-40;
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &near, &near, 1));
    check_ok(mspring_network_set_positions(same, NULL, 1, 1, &near, &near, 1));
    check_error(mspring_network_apply_torque(network, NULL, 0, 2, 1e30f), MSPRING_ERROR_ARGUMENT); // over 1e38 N
    check_contains(mspring_network_error(network), "particle 0");
    support_steps(network, 2, 0.01);
    support_steps(same, 2, 0.01);
    assert_true(support_hash(network) == support_hash(same));
    mspring_network_destroy(network);
    mspring_network_destroy(same);
}

/// Directions have no negative zero, whichever way a spring lies.
static void no_direction_is_a_negative_zero(void **state) {
    (void)state;
    for (int way = 0; way < 8; way++) {
        mspring_builder *builder = support_builder();
        const double x = way % 4 == 0 ? 1 : way % 4 == 1 ? -1 : 0, y = way % 4 == 2 ? 1 : way % 4 == 3 ? -1 : 0;
        (void)support_particle(builder, 0, 0, 1);
        (void)support_particle(builder, x, y, 1);
        (void)support_spring(builder, way < 4 ? 0 : 1, way < 4 ? 1 : 0, 1, 0);
        mspring_network *network = support_network(builder, NULL);
        float to[2];
        const mspring_column columns[] = {{MSPRING_DIRECTION_X, 1, &to[0]}, {MSPRING_DIRECTION_Y, 1, &to[1]}};
        check_ok(mspring_network_get_columns(network, NULL, 0, 1, columns, 2));
        assert_true(to[0] == (float)(way < 4 ? x : -x) && to[1] == (float)(way < 4 ? y : -y));
        assert_false((to[0] == 0 && signbit(to[0])) || (to[1] == 0 && signbit(to[1])));
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_direction_is_a_negative_zero),
        cmocka_unit_test(two_masses_have_their_closed_form),
        cmocka_unit_test(nothing_is_a_body_too),
        cmocka_unit_test(any_list_has_its_sums),
        cmocka_unit_test(turns_are_found),
        cmocka_unit_test(a_bent_body_has_the_best_turn),
        cmocka_unit_test(places_come_along),
        cmocka_unit_test(a_torque_turns_and_does_not_push),
        cmocka_unit_test(torques_add_up),
        cmocka_unit_test(bad_torques_change_nothing),
    };
    return cmocka_run_group_tests_name("body", tests, NULL, NULL);
}
