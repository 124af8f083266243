/// @file test_find.c
/// What lies where: particles and springs near a point, in a circle or a box, and springs across a line, against a
/// search by the public getters in long double.
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
    check_ok(mspring_network_break_springs(network, springs, 0, 40));
    check_ok(mspring_network_remove_particles(network, removed, 0, COUNT_OF(removed)));
    recipe_free(&made);
    return network;
}

static uint32_t particle_count(const mspring_network *network) {
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
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
        check_ok(support_get_bounds(network, &box[0], &box[1], &box[2], &box[3]));
        for (int n = 0; n < 40; n++) {
            const double x = support_random_between(&seed, box[0] - 1, box[2] + 1);
            const double y = support_random_between(&seed, box[1] - 1, box[3] + 1);
            const double half = support_random_between(&seed, 0, 0.3 * (box[2] - box[0]));
            check_nearest(network, x, y);
            check_circle(network, x, y, half);
            check_box(network, (double[]){x - half, y - half, x + half, y + 0.5 * half});
        }
        check_box(network, (double[]){-INFINITY, -INFINITY, INFINITY, 0.5 * (box[1] + box[3])});
        if (ways[i] == 0) // with an origin, sums are rounded
            check_box(network, box); // particles lie on its edges
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
    support_plan plan;
    uint32_t count = 0, at = 0;
    check_ok(support_get_plan(network, &plan));
    check_ok(mspring_network_springs_across(network, way[0], way[1], way[2], way[3], MSPRING_FIND_WHOLE, found,
                                            fractions, MOST, &count));
    for (mspring_id i = 0; i < plan.spring_count; i++) {
        support_spring_info info;
        if (support_get_spring(network, i, &info) != MSPRING_OK || (info.flags & MSPRING_SPRING_BROKEN))
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
    check_ok(mspring_network_springs_across(network, way[0], way[1], way[2], way[3], MSPRING_FIND_WHOLE, found,
                                            NULL, 1, &again));
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
        check_ok(support_get_bounds(network, &box[0], &box[1], &box[2], &box[3]));
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

/// One of the eight ways to turn and reflect a point.
static support_point turned(double x, double y, int way) {
    const double u = way & 1 ? y : x, v = way & 1 ? x : y;
    return (support_point){way & 2 ? -u : u, way & 4 ? -v : v};
}

/// A spring from (0, 0) to (2, 0), and lines that touch it, run along it, or just miss; turned and reflected, and with
/// the spring the other way round.
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
        {{1, 1, 3, -1}, 1, 0.5},  {{1, 1, 2, 0}, 1, 1},    {{2, 0, 3, 1}, 1, 0},
        {{1, 2, 3, -1}, 0, 0},    {{0, -1, 1, -2}, 0, 0},
        {{-2, 0, -1, 0}, 0, 0},   {{1, 1e-9, 1, 1}, 0, 0}, {{2.000001, -1, 2.000001, 1}, 0, 0},
    };
    for (int way = 0; way < 16; way++) {
        const support_point end = turned(2, 0, way);
        mspring_builder *builder = support_builder();
        support_particle(builder, 0, 0, 1);
        support_particle(builder, end.x, end.y, 1);
        support_spring(builder, way & 8 ? 1 : 0, way & 8 ? 0 : 1, 1, 0);
        const mspring_network_def def = support_def(0, 1);
        mspring_network *network = support_network(builder, &def);
        for (size_t i = 0; i < COUNT_OF(cases); i++) {
            const support_point from = turned(cases[i].way[0], cases[i].way[1], way),
                                to = turned(cases[i].way[2], cases[i].way[3], way);
            mspring_id found = MSPRING_NONE;
            double fraction = 0;
            uint32_t count = 7;
            check_ok(mspring_network_springs_across(network, from.x, from.y, to.x, to.y, MSPRING_FIND_WHOLE, &found,
                                                    &fraction, 1, &count));
            assert_int_equal(count, cases[i].count);
            check_near(fraction, cases[i].fraction, 1e-12);
        }
        mspring_network_destroy(network);
    }
}

/// Distance from a point to the line between two others, and the nearest place on it.
static long double distance_to_spring(support_point a, support_point b, double x, double y, long double *on) {
    const long double dx = (long double)b.x - a.x, dy = (long double)b.y - a.y, square = dx * dx + dy * dy;
    *on = square > 0 ? ((x - a.x) * dx + (y - a.y) * dy) / square : 0;
    *on = *on < 0 ? 0 : *on > 1 ? 1 : *on;
    return hypotl(a.x + *on * dx - x, a.y + *on * dy - y);
}

static bool is_wanted(const mspring_network *network, mspring_id spring, uint32_t flags,
                      support_spring_info *info) {
    return support_get_spring(network, spring, info) == MSPRING_OK &&
           (flags & (info->flags & MSPRING_SPRING_BROKEN ? MSPRING_FIND_BROKEN : MSPRING_FIND_WHOLE));
}

/// Both queries about a point. Return how many springs the circle has.
static uint32_t check_springs_at(const mspring_network *network, double x, double y, double radius,
                                 uint32_t flags) {
    static mspring_id found[MOST];
    uint32_t count = 0, at = 0, some = 0;
    long double least = INFINITY, on, on_nearest = 0;
    mspring_id expected = MSPRING_NONE, nearest = 7, few[2] = {77, 77};
    double distance = -1, fraction = -1;
    check_ok(mspring_network_springs_in_circle(network, x, y, radius, flags, found, MOST, &count));
    for (mspring_id i = 0; i < mspring_network_count(network, MSPRING_SPRINGS); i++) {
        support_spring_info info;
        if (!is_wanted(network, i, flags, &info))
            continue;
        const long double d =
            distance_to_spring(support_position(network, info.a), support_position(network, info.b), x, y, &on);
        // Springs at one particle have the same distance, but for rounding at 1e5 m; the first of them is named.
        if (d < least - 1e-9L) {
            least = d, on_nearest = on, expected = i;
        }
        const bool is_found = at < count && found[at] == i;
        at += is_found;
        assert_true(is_found == (d <= radius) || fabsl(d - radius) < 1e-9L);
    }
    assert_int_equal(at, count);
    check_ok(mspring_network_springs_in_circle(network, x, y, radius, flags, few, 1, &some));
    assert_int_equal(some, count);
    assert_true(few[1] == 77 && few[0] == (count > 0 ? found[0] : 77));
    check_ok(mspring_network_springs_in_circle(network, x, y, radius, flags, NULL, 0, &some));
    assert_int_equal(some, count);
    check_ok(mspring_network_nearest_spring(network, x, y, INFINITY, flags, &nearest, &fraction, &distance));
    assert_int_equal(nearest, expected);
    if (expected != MSPRING_NONE) {
        check_near(distance, (double)least, 1e-9);
        check_near(fraction, (double)on_nearest, 1e-6);
        check_ok(mspring_network_nearest_spring(network, x, y, distance * 0.999, flags, &nearest, NULL, NULL));
    }
    assert_int_equal(distance > 0 ? nearest : MSPRING_NONE, MSPRING_NONE);
    return count;
}

static void springs_near_a_point_are_found(void **state) {
    (void)state;
    static const double ways[] = {0, 1e5};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = eventful(ways[i]);
        double box[4];
        uint64_t seed = 21;
        uint32_t met[4] = {0};
        check_ok(support_get_bounds(network, &box[0], &box[1], &box[2], &box[3]));
        for (int round = 0; round < 2; round++) {
            for (int n = 0; n < 30; n++) {
                const double x = support_random_between(&seed, box[0] - 1, box[2] + 1);
                const double y = support_random_between(&seed, box[1] - 1, box[3] + 1);
                const double radius = support_random_between(&seed, 0, 3);
                for (uint32_t flags = 1; flags < 4; flags++) {
                    met[flags] += check_springs_at(network, x, y, radius, flags);
                }
            }
            check_ok(mspring_network_compact(network)); // the layout has no broken springs from here on
        }
        assert_true(met[1] > 100 && met[2] > 10 && met[1] + met[2] == met[3]);
        mspring_network_destroy(network);
    }
}

/// A line finds broken springs as it found them when they were whole.
static void broken_springs_are_found_as_whole_ones(void **state) {
    (void)state;
    mspring_network *network = eventful(0);
    static mspring_id whole[MOST], broken[MOST];
    uint32_t count = 0, before = 0, again = 0;
    double box[4];
    check_ok(support_get_bounds(network, &box[0], &box[1], &box[2], &box[3]));
    const double y = support_position(network, 10).y + 0.01, far = box[2] + 1, near = box[0] - 1;
    check_ok(
        mspring_network_springs_across(network, near, y, far, y, MSPRING_FIND_BROKEN, broken, NULL, MOST, &before));
    check_ok(
        mspring_network_springs_across(network, near, y, far, y, MSPRING_FIND_WHOLE, whole, NULL, MOST, &count));
    assert_true(count > 3);
    check_ok(mspring_network_break_springs(network, whole, 0, count));
    check_ok(
        mspring_network_springs_across(network, near, y, far, y, MSPRING_FIND_BROKEN, broken, NULL, MOST, &again));
    assert_int_equal(again, before + count);
    check_ok(
        mspring_network_springs_across(network, near, y, far, y, MSPRING_FIND_WHOLE, whole, NULL, MOST, &again));
    assert_int_equal(again, 0);
    check_ok(mspring_network_restore_springs(network, broken, 0, before + count, 0)); // repair
    check_ok(mspring_network_springs_across(network, near, y, far, y, 3, whole, NULL, MOST, &again));
    assert_int_equal(again, before + count);
    assert_memory_equal(whole, broken, again * sizeof *whole);
    mspring_network_destroy(network);
}

/// All springs of a star come from one particle, those of a clique join all: each is looked at once.
static void stars_and_cliques_are_found(void **state) {
    (void)state;
    enum { RAYS = 300, CORNERS = 40 };
    for (int kind = 0; kind < 3; kind++) {
        const bool is_clique = kind == 1, is_precise = kind == 2; // whose sums are rounded
        const double hub_x = is_precise ? 1e-4 / 3 : 0, hub_y = is_precise ? -1e-4 / 7 : 0;
        mspring_builder *builder = support_builder();
        const int corners = is_clique ? CORNERS : RAYS;
        for (int i = 0; i < corners; i++) {
            const double angle = 6.283 * i / corners * (is_precise ? 0.25 : 1);
            support_particle(builder, 10 * cos(angle), 10 * sin(angle), 1);
        }
        const mspring_id hub = support_particle(builder, hub_x, hub_y, 1);
        for (int i = 0; i < corners; i++) {
            for (int k = is_clique ? i + 1 : corners; k < corners + !is_clique; k++) {
                support_spring(builder, (mspring_id)i, is_clique ? (mspring_id)k : hub, 1, 0);
            }
        }
        mspring_network_def def = support_def(0, 1);
        def.flags = is_precise ? MSPRING_NETWORK_PRECISE : 0;
        mspring_network *network = support_network(builder, &def);
        uint64_t seed = 3;
        for (int n = 0; n < 10; n++) {
            const double x = support_random_between(&seed, -11, 11), y = support_random_between(&seed, -11, 11);
            check_springs_at(network, x, y, 1, MSPRING_FIND_WHOLE);
        }
        if (!is_clique) { // all are at the hub, and a quarter of a star is on one side of it: the first is the nearest
            double fraction = -1;
            mspring_id first = 7;
            const double x = is_precise ? -0.3 : 0, y = is_precise ? -0.7 : 0;
            check_ok(mspring_network_nearest_spring(network, x, y, 1, MSPRING_FIND_WHOLE, &first, &fraction, NULL));
            assert_int_equal(first, 0);
            assert_true(fraction == 1);
            assert_int_equal(check_springs_at(network, x, y, is_precise ? 1 : 0, MSPRING_FIND_WHOLE), RAYS);
        }
        mspring_network_destroy(network);
    }
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
    check_error(
        mspring_network_springs_across(network, 0, 0, INFINITY, 1, MSPRING_FIND_WHOLE, &id, NULL, 1, &count),
        MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_springs_across(network, 0, 0, 1, 1, 0, &id, NULL, 1, &count),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_springs_across(network, 0, 0, 1, 1, 4, &id, NULL, 1, &count),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_springs_in_circle(network, 0, 0, 1, 8, &id, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_springs_in_circle(network, 0, 0, NAN, 1, &id, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_springs_in_circle(network, 0, NAN, 1, 1, &id, 1, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_springs_in_circle(network, 0, 0, 1, 1, &id, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_nearest_spring(network, 0, 0, 1, 0, &id, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_nearest_spring(network, 0, 0, -1, 1, &id, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_nearest_spring(network, -2e12, 0, 1, 1, &id, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_nearest_spring(network, 0, 0, 1, 1, NULL, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(id, 4711);
    assert_int_equal(count, 4711);
    mspring_network_destroy(network);
}

/// A box around all finds each once, however many there are.
static void a_box_around_all_finds_all(void **state) {
    (void)state;
    for (uint32_t count = 1; count <= 40; count++) {
        mspring_builder *builder = support_builder();
        mspring_id found[64];
        uint32_t number = 0;
        for (uint32_t i = 0; i < count; i++)
            support_particle(builder, 0.25 * i, 0, 1);
        mspring_network *network = support_network(builder, NULL);
        check_ok(mspring_network_particles_in_box(network, -1e6, -1e6, 1e6, 1e6, found, COUNT_OF(found), &number));
        assert_int_equal(number, count);
        for (uint32_t i = 0; i < count; i++)
            assert_int_equal(found[i], i);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(particles_are_found),
        cmocka_unit_test(springs_are_found),
        cmocka_unit_test(springs_near_a_point_are_found),
        cmocka_unit_test(broken_springs_are_found_as_whole_ones),
        cmocka_unit_test(stars_and_cliques_are_found),
        cmocka_unit_test(touching_counts),
        cmocka_unit_test(nonsense_is_refused),
        cmocka_unit_test(a_box_around_all_finds_all),
    };
    return cmocka_run_group_tests_name("find", tests, NULL, NULL);
}
