/// @file test_find.c
/// What lies where: particles near a point, in a circle or a box, and springs across a line, against a search by
/// the public getters in long double.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "recipe.h"
#include "support.h"

enum { MOST = 2000 };

static const mspring_id removed[] = {3, 40, 41, 77};

/// A network of all kinds of rows, some of whose springs are broken and particles removed, a world's width away.
static mspring_network *eventful(double away) {
    recipe made = recipe_mixed(11);
    for (uint32_t i = 0; i < made.particle_count; i++)
        made.particles[i].x += away;
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = recipe_network(&made, &def);
    support_steps(network, 5, 0.001);
    mspring_id springs[40];
    for (uint32_t i = 0; i < 40; i++)
        springs[i] = i * (made.spring_count / 40);
    check_ok(mspring_network_break_springs(network, springs, 40));
    check_ok(mspring_network_remove_particles(network, removed, COUNT_OF(removed)));
    recipe_free(&made);
    return network;
}

static uint32_t particle_count(const mspring_network *network) {
    mspring_plan plan = {.struct_size = sizeof plan};
    check_ok(mspring_network_get_plan(network, &plan));
    return plan.particle_count;
}

static bool is_there(mspring_id particle) {
    for (size_t i = 0; i < COUNT_OF(removed); i++)
        if (removed[i] == particle)
            return false;
    return true;
}

static long double distance_to(const mspring_network *network, mspring_id particle, double x, double y) {
    const support_point at = support_position(network, particle);
    return hypotl((long double)at.x - x, (long double)at.y - y);
}

static void check_nearest(const mspring_network *network, double x, double y) {
    mspring_id expected = MSPRING_NONE, found = 7;
    long double least = INFINITY;
    for (mspring_id p = 0; p < particle_count(network); p++) {
        const long double distance = is_there(p) ? distance_to(network, p, x, y) : INFINITY;
        if (distance < least) {
            least = distance;
            expected = p;
        }
    }
    double distance = -1;
    check_ok(mspring_network_nearest_particle(network, x, y, INFINITY, &found, &distance));
    assert_int_equal(found, expected);
    check_near(distance, (double)least, 1e-9 * (1 + (double)least)); // of sums about 1e5 m, once in double
    check_ok(mspring_network_nearest_particle(network, x, y, distance * 0.999, &found, &distance));
    assert_int_equal(found, MSPRING_NONE);
    assert_true(isinf(distance));
}

static void check_circle(const mspring_network *network, double x, double y, double radius) {
    static mspring_id found[MOST];
    uint32_t count = 0, some = 0;
    check_ok(mspring_network_particles_in_circle(network, x, y, radius, found, MOST, &count));
    uint32_t at = 0;
    for (mspring_id p = 0; p < particle_count(network); p++) {
        if (!is_there(p) || distance_to(network, p, x, y) > radius)
            continue;
        assert_true(at < count);
        assert_int_equal(found[at++], p);
    }
    assert_int_equal(at, count);
    // With less room the first ones, and the same count; what lies behind is left as it was.
    mspring_id few[3] = {77, 77, 77};
    check_ok(mspring_network_particles_in_circle(network, x, y, radius, few, 2, &some));
    assert_int_equal(some, count);
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(few[i], i < 2 && i < count ? found[i] : 77);
    check_ok(mspring_network_particles_in_circle(network, x, y, radius, NULL, 0, &some));
    assert_int_equal(some, count);
}

static void check_box(const mspring_network *network, const double box[4]) {
    static mspring_id found[MOST];
    uint32_t count = 0, at = 0;
    check_ok(mspring_network_particles_in_box(network, box[0], box[1], box[2], box[3], found, MOST, &count));
    for (mspring_id p = 0; p < particle_count(network); p++) {
        const support_point place = is_there(p) ? support_position(network, p) : (support_point){NAN, NAN};
        if (place.x >= box[0] && place.y >= box[1] && place.x <= box[2] && place.y <= box[3]) {
            assert_true(at < count);
            assert_int_equal(found[at++], p);
        }
    }
    assert_int_equal(at, count);
}

static void particles_are_found(void **state) {
    (void)state;
    static const double ways[] = {0, 1e5};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = eventful(ways[i]);
        double box[4];
        uint64_t seed = 5;
        check_ok(mspring_network_bounds(network, &box[0], &box[1], &box[2], &box[3]));
        for (int n = 0; n < 40; n++) {
            const double x = support_random_between(&seed, box[0] - 1, box[2] + 1);
            const double y = support_random_between(&seed, box[1] - 1, box[3] + 1);
            const double half = support_random_between(&seed, 0, 0.3 * (box[2] - box[0]));
            check_nearest(network, x, y);
            check_circle(network, x, y, half);
            check_box(network, (double[]){x - half, y - half, x + half, y + 0.5 * half});
        }
        check_box(network, (double[]){-INFINITY, -INFINITY, INFINITY, 0.5 * (box[1] + box[3])});
        mspring_network_destroy(network);
    }
}

/// Whether a spring's ends lie on both sides of a line, the line's on both sides of the spring, and where they
/// meet.
static bool meets(const double way[4], support_point c, support_point d, long double *fraction) {
    const long double wx = (long double)way[2] - way[0], wy = (long double)way[3] - way[1];
    const long double sx = (long double)d.x - c.x, sy = (long double)d.y - c.y;
    const long double across = wx * sy - wy * sx, ox = (long double)c.x - way[0], oy = (long double)c.y - way[1];
    *fraction = (ox * sy - oy * sx) / across;
    const long double along = (ox * wy - oy * wx) / across;
    return *fraction >= 0 && *fraction <= 1 && along >= 0 && along <= 1;
}

static uint32_t check_across(const mspring_network *network, const double way[4]) {
    static mspring_id found[MOST];
    static double fractions[MOST];
    mspring_plan plan = {.struct_size = sizeof plan};
    uint32_t count = 0, at = 0;
    check_ok(mspring_network_get_plan(network, &plan));
    check_ok(
        mspring_network_springs_across(network, way[0], way[1], way[2], way[3], found, fractions, MOST, &count));
    for (mspring_id i = 0; i < plan.spring_count; i++) {
        mspring_spring_info info = {.struct_size = sizeof info};
        if (mspring_network_get_spring(network, i, &info) != MSPRING_OK || (info.flags & MSPRING_SPRING_BROKEN))
            continue;
        long double fraction;
        if (meets(way, support_position(network, info.a), support_position(network, info.b), &fraction)) {
            assert_true(at < count);
            assert_int_equal(found[at], i);
            check_near(fractions[at++], (double)fraction, 1e-6); // positions 1e5 m away are known to 1e-11 m
        }
    }
    assert_int_equal(at, count);
    uint32_t again = 0;
    check_ok(mspring_network_springs_across(network, way[0], way[1], way[2], way[3], found, NULL, 1, &again));
    assert_int_equal(again, count);
    return count;
}

static void springs_are_found(void **state) {
    (void)state;
    static const double ways[] = {0, 1e5};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = eventful(ways[i]);
        double box[4];
        uint64_t seed = 8;
        uint32_t met = 0;
        check_ok(mspring_network_bounds(network, &box[0], &box[1], &box[2], &box[3]));
        for (int n = 0; n < 60; n++) {
            double way[4];
            for (int k = 0; k < 4; k++)
                way[k] = support_random_between(&seed, box[k & 1] - 1, box[2 + (k & 1)] + 1);
            met += check_across(network, way);
        }
        assert_true(met > 100);
        mspring_network_destroy(network);
    }
}

/// A spring from (0, 0) to (2, 0), and lines that touch it, run along it, or just miss.
static void touching_counts(void **state) {
    (void)state;
    static const struct {
        double way[4];
        uint32_t count;
        double fraction;
    } cases[] = {
        {{1, -1, 1, 1}, 1, 0.5},  {{1, -1, 1, 0}, 1, 1},   {{1, 0, 1, 3}, 1, 0},
        {{0, -1, 0, 1}, 1, 0.5},  {{2, 0, 2, 0}, 1, 0},    {{-1, 0, 3, 0}, 1, 0.25},
        {{3, 0, -1, 0}, 1, 0.25}, {{0.5, 0, 1, 0}, 1, 0},  {{3, 0, 4, 0}, 0, 0},
        {{-2, 0, -1, 0}, 0, 0},   {{1, 1e-9, 1, 1}, 0, 0}, {{2.000001, -1, 2.000001, 1}, 0, 0},
    };
    mspring_builder *builder = support_builder();
    support_spring(builder, support_particle(builder, 0, 0, 1), support_particle(builder, 2, 0, 1), 1, 0);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const double *way = cases[i].way;
        mspring_id found = MSPRING_NONE;
        double fraction = 0;
        uint32_t count = 7;
        check_ok(
            mspring_network_springs_across(network, way[0], way[1], way[2], way[3], &found, &fraction, 1, &count));
        assert_int_equal(count, cases[i].count);
        check_near(fraction, cases[i].fraction, 1e-12);
    }
    mspring_network_destroy(network);
}

static void nonsense_is_refused(void **state) {
    (void)state;
    mspring_network *network = eventful(0);
    mspring_id id = 4711;
    uint32_t count = 4711;
    check_error(mspring_network_nearest_particle(network, 0, 0, -1, &id, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_nearest_particle(network, 0, 0, NAN, &id, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_nearest_particle(network, 2e12, 0, 1, &id, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_particles_in_circle(network, 0, 0, -1, &id, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_particles_in_circle(network, 0, 0, 1, NULL, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_particles_in_box(network, 0, NAN, 1, 1, &id, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_particles_in_box(network, 2, 0, 1, 1, &id, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_springs_across(network, 0, 0, INFINITY, 1, &id, NULL, 1, &count),
                MSPRING_ERROR_ARGUMENT);
    assert_int_equal(id, 4711);
    assert_int_equal(count, 4711);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(particles_are_found),
        cmocka_unit_test(springs_are_found),
        cmocka_unit_test(touching_counts),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests_name("find", tests, NULL, NULL);
}
