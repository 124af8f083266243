/// @file test_throws.c
/// Bodies that others throw at each other within one substep: rows of bodies with hardly any room between them,
/// light ones before heavy ones, and three bodies that meet. None gets through another.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bodies.h"

#define THICKNESS 0.5
#define MOST_BODIES 8

static uint32_t between(uint64_t *seed, uint32_t low, uint32_t high) {
    return low + (uint32_t)(support_random_between(seed, 0, 1) * (high - low + 1));
}

static double log_between(uint64_t *seed, double low, double high) {
    return exp(support_random_between(seed, log(low), log(high)));
}

typedef struct scene {
    bodies *b;
    uint32_t first[MOST_BODIES + 1], count; ///< bodies
    double speed, span;                     ///< of the fastest; way that it is followed for
} scene;

/* ------------------------------------------------------------------------------------------------------ scenes */

/// A plate or a bar upright, a block, or a particle. Returns how wide it is.
static double add_upright(scene *s, uint64_t *seed, double left, double mass, double f) {
    const uint32_t kind = between(seed, 0, 3);
    bodies_lattice l = {.spacing = 1, .mass = mass, .f = f, .width = 1, .height = 1};
    double wide = 0, tilt = 0;
    if (kind == 0) {
        l.height = between(seed, 2, 9);
        l.angle = support_random_between(seed, -0.01, 0.01);
        tilt = 2 * 0.01 * 4;
    }
    if (kind == 1)
        l.height = between(seed, 3, 8), l.width = 2, wide = 1;
    else if (kind == 2)
        l.height = l.width = between(seed, 2, 4), wide = l.width - 1.0;
    l.x = left + 0.5 * (wide + tilt);
    l.y = support_random_between(seed, -0.5, 0.5);
    s->first[s->count++] = bodies_add(s->b, &l);
    return wide + tilt;
}

/// The first of a row is fast, all others are at rest; the last is a wall, or another body.
static scene row_of_bodies(uint64_t trial, double fastest, double h) {
    uint64_t seed = trial;
    scene s = {.b = bodies_begin(h), .span = 6};
    const uint32_t count = between(&seed, 2, MOST_BODIES - 2);
    const double f = log_between(&seed, 0.05, 0.5);
    const bool has_wall = between(&seed, 0, 2) > 0;
    double x = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double mass = log_between(&seed, 1, 1000);
        x += add_upright(&s, &seed, x, mass, f) + THICKNESS;
        x += i == 0 ? support_random_between(&seed, 0.2, 2) : log_between(&seed, 1e-3, 0.3);
        if (i == 0)
            x += 0.4;
    }
    s.first[s.count++] = bodies_add(s.b, &(bodies_lattice){.width = 14,
                                                           .height = 1,
                                                           .angle = 1.5707963267948966,
                                                           .x = x + 0.05,
                                                           .spacing = 1,
                                                           .mass = has_wall ? 0 : log_between(&seed, 1, 1000),
                                                           .f = f});
    s.first[s.count] = s.b->count;
    s.speed = fastest * pow(10, support_random_between(&seed, -1, 0));
    for (uint32_t p = 0; p < s.first[1]; p++)
        s.b->vx[p] = (float)s.speed;
    return s;
}

/// Three to five bodies that fly at one place.
static scene cluster(uint64_t trial, double fastest, double h) {
    uint64_t seed = trial;
    scene s = {.b = bodies_begin(h), .span = 15};
    const uint32_t count = between(&seed, 3, 5);
    const double f = log_between(&seed, 0.05, 0.5);
    s.speed = fastest * pow(10, support_random_between(&seed, -1.5, 0));
    for (uint32_t i = 0; i < count; i++) {
        const double angle = 6.283 * (i + support_random_between(&seed, -0.2, 0.2)) / count,
                     away = support_random_between(&seed, 9, 12), fast = support_random_between(&seed, 0.2, 1);
        bodies_lattice l = {.x = away * cos(angle),
                            .y = away * sin(angle),
                            .angle = support_random_between(&seed, 0, 6.283),
                            .spacing = 1,
                            .mass = log_between(&seed, 1, 1000),
                            .f = f,
                            .width = between(&seed, 1, 6),
                            .height = 1};
        if (between(&seed, 0, 2) > 0)
            l.height = between(&seed, 1, 4);
        s.first[s.count++] = bodies_add(s.b, &l);
        const double aim = angle + support_random_between(&seed, -0.15, 0.15);
        for (uint32_t p = s.first[i]; p < s.b->count; p++) {
            s.b->vx[p] = (float)(-fast * s.speed * cos(aim));
            s.b->vy[p] = (float)(-fast * s.speed * sin(aim));
        }
    }
    s.first[s.count] = s.b->count;
    return s;
}

/* --------------------------------------------------------------------------------------------------- collisions */

static double side(const double *x, const double *y, uint32_t p, uint32_t q, uint32_t r) {
    return (x[q] - x[p]) * (y[r] - y[p]) - (y[q] - y[p]) * (x[r] - x[p]);
}

/// Whether a point was on the edge between a and b at some time of an even motion from (x, y) to where it is now:
/// the side is a polynomial of second degree in time.
static bool has_passed(const bodies *b, const double *x, const double *y, uint32_t p, const bodies_spring *edge) {
    const uint32_t e[3] = {edge->a, edge->b, p};
    double mx[3], my[3], sx[3], sy[3];
    for (int i = 0; i < 3; i++) {
        mx[i] = 0.5 * (x[e[i]] + b->x[e[i]]);
        my[i] = 0.5 * (y[e[i]] + b->y[e[i]]);
    }
    const double first = side(x, y, e[0], e[1], p), middle = side(mx, my, 0, 1, 2),
                 last = side(b->x, b->y, e[0], e[1], p);
    const double square = 2 * (first - 2 * middle + last), line = last - first - square,
                 root = line * line - 4 * square * first;
    if (!(root >= 0))
        return false;
    const double q = -0.5 * (line + (line < 0 ? -sqrt(root) : sqrt(root))), times[2] = {q / square, first / q};
    for (int k = 0; k < 2; k++) {
        const double t = times[k];
        if (!(t >= 0 && t <= 1))
            continue;
        for (int i = 0; i < 3; i++) {
            sx[i] = x[e[i]] + t * (b->x[e[i]] - x[e[i]]);
            sy[i] = y[e[i]] + t * (b->y[e[i]] - y[e[i]]);
        }
        const double ex = sx[1] - sx[0], ey = sy[1] - sy[0],
                     share = ((sx[2] - sx[0]) * ex + (sy[2] - sy[0]) * ey) / (ex * ex + ey * ey);
        if (share >= 0 && share <= 1)
            return true;
    }
    return false;
}

static bool has_any_passed(const bodies *b, const double *x, const double *y) {
    for (uint32_t s = 0; s < b->spring_count; s++) {
        const bodies_spring *edge = &b->springs[s];
        for (uint32_t p = 0; edge->is_edge && p < b->count; p++)
            if (b->is_outline[p] && b->body[p] != b->body[edge->a] && fabs(b->x[p] - b->x[edge->a]) < 4 &&
                fabs(b->y[p] - b->y[edge->a]) < 4 && has_passed(b, x, y, p, edge))
                return true;
    }
    return false;
}

typedef struct outcome {
    bool met, crossed;
    double deepest, gain, momentum;
} outcome;

typedef scene make_scene(uint64_t trial, double fastest, double h);

static const uint32_t SUBSTEPS[] = {20, 40, 80};

/// Steps of one substep tell whether anything has passed in between, and those of many look at contact less often.
static outcome collide(make_scene *make, uint64_t trial, double fastest, float restitution) {
    const uint32_t substeps = SUBSTEPS[trial % COUNT_OF(SUBSTEPS)];
    const double h = 1.0 / 64 / substeps;
    scene s = make(trial, fastest, h);
    const uint32_t in_a_step = trial % 2 ? substeps : 1;
    const double dt = h * in_a_step;
    const mspring_network_def def = support_def(0, in_a_step);
    mspring_network *network = bodies_network(s.b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.3f, restitution));
    outcome o = {0};
    const bodies_measure before = bodies_measured(s.b, network);
    bodies_measure now = before;
    const double seconds = s.span / s.speed;
    for (double time = 0; time < seconds; time += dt) {
        uint32_t crossings;
        mspring_contact_info info = {.struct_size = sizeof info};
        double x[BODIES_MOST_PARTICLES], y[BODIES_MOST_PARTICLES];
        memcpy(x, s.b->x, s.b->count * sizeof *x);
        memcpy(y, s.b->y, s.b->count * sizeof *y);
        support_steps(network, 1, dt);
        now = bodies_measured(s.b, network);
        o.gain = fmax(o.gain, now.energy / before.energy - 1);
        check_ok(mspring_network_get_contact_info(network, &info));
        o.met |= info.touching > 0;
        o.deepest = fmax(o.deepest, bodies_deepest(s.b, THICKNESS, &crossings));
        o.crossed |= crossings > 0 || (in_a_step == 1 && has_any_passed(s.b, x, y));
    }
    const bool is_free = s.b->mass[s.b->count - 1] > 0; // nothing is pinned
    o.momentum = is_free ? hypot(now.x - before.x, now.y - before.y) / before.momentum_scale : 0;
    mspring_network_destroy(network);
    bodies_free(s.b);
    return o;
}

/// What is said of bodies that are thrown: none gets through another, and overlaps stay below so many metres.
static void check_trials(make_scene *make, uint32_t first, uint32_t count, double fastest, float restitution,
                         double gain) {
    uint32_t met = 0, deep = 0;
    outcome most = {0};
    for (uint32_t trial = first; trial < first + count; trial++) {
        const outcome o = collide(make, trial, fastest, restitution);
        if (o.crossed)
            print_error("trial %u: crossed, deepest %g m\n", (unsigned)trial, o.deepest);
        assert_false(o.crossed);
        met += o.met;
        deep += o.deepest > 0.5 * THICKNESS;
        most.deepest = fmax(most.deepest, o.deepest);
        most.gain = fmax(most.gain, o.gain);
        most.momentum = fmax(most.momentum, o.momentum);
    }
    if (getenv("CONTACT_REPORT"))
        printf("%u trials to %g m/s, e %g: met %u, %u deeper than half the thickness, deepest %.3g, energy %.2g, "
               "momentum %.2g\n",
               (unsigned)count, fastest, (double)restitution, (unsigned)met, (unsigned)deep, most.deepest,
               most.gain, most.momentum);
    assert_true(met > count / 2);
    assert_true(deep <= 1 + count / 100);
    assert_true(most.gain <= gain);
    assert_true(most.momentum <= 1e-4);
}

/// Trials of each kind.
static uint32_t trials;

static void nothing_is_thrown_through_the_next_in_a_row(void **state) {
    (void)state;
    check_trials(row_of_bodies, 1, trials, 300, 0, 2e-3);
    check_trials(row_of_bodies, 300001, trials, 1000, 0, 1e-2);
}

/// Bounces that would give energy are lowered. Of full ones little is left, where springs are compressed deeply.
static void nothing_bounces_through_the_next_in_a_row(void **state) {
    (void)state;
    check_trials(row_of_bodies, 100001, trials, 300, 0.5f, 2e-3);
    check_trials(row_of_bodies, 200001, trials, 300, 1, 0.1);
}

static void nothing_gets_through_others_where_several_meet(void **state) {
    (void)state;
    check_trials(cluster, 1, trials, 300, 0, 2e-3);
    check_trials(cluster, 100001, trials, 300, 0.5f, 2e-3);
    check_trials(cluster, 200001, trials, 1000, 0.5f, 1e-2);
}

// A light strip lies on the floor, and a heavy block falls on it: neither gets through, nor through the floor. The
// floor and contact each press it, so they are to be solved together. Without, overlaps were as deep as the
// thickness.
static double squeezed(double ratio, double speed, bool is_loose) {
    bodies *b = bodies_begin(1.0 / 64 / 40);
    if (is_loose)
        for (uint32_t i = 0; i < 10; i++)
            (void)bodies_add(
                b, &(bodies_lattice){.width = 1, .height = 1, .x = i - 4.2, .spacing = 1, .mass = 1, .f = 0.1});
    else
        (void)bodies_add(b,
                         &(bodies_lattice){.width = 10, .height = 2, .y = 0.5, .spacing = 1, .mass = 1, .f = 0.1});
    const uint32_t block =
        bodies_add(b, &(bodies_lattice){.width = 10, .height = 4, .y = 3.7, .spacing = 1, .mass = ratio, .f = 0.1});
    for (uint32_t i = block; i < b->count; i++)
        b->vy[i] = (float)-speed;
    const mspring_network_def def = support_def(-9.8f, 40);
    mspring_network *network = bodies_network(b, &def);
    const double plane[4] = {0, 0, 0, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    floor.friction = 0.3f;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(bodies_touch(network, THICKNESS, 0.3f, 0));
    double deepest = 0;
    for (uint32_t step = 0; step < 64; step++) {
        mspring_contact_info info = {.struct_size = sizeof info};
        support_steps(network, 1, 1.0 / 64);
        check_ok(mspring_network_get_contact_info(network, &info));
        deepest = fmax(deepest, info.deepest);
        for (uint32_t i = 0; i < b->count; i++) {
            double x, y;
            check_ok(mspring_network_get_positions(network, NULL, i, 1, &x, &y, 1));
            assert_true(y > -1e-4);
        }
    }
    mspring_network_destroy(network);
    bodies_free(b);
    return deepest;
}

static void nothing_is_squeezed_on_the_floor(void **state) {
    (void)state;
    double deepest = 0;
    for (uint32_t i = 0; i < 18; i++)
        deepest = fmax(deepest, squeezed(pow(30, i % (i < 9 ? 3 : 2)), 5 * pow(5, i / 3 % 3), i >= 9));
    print_message("deepest of what is squeezed: %.4f m\n", deepest);
    assert_true(deepest < 0.5 * THICKNESS);
}

int main(int argc, char **argv) {
    trials = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : SAMPLE(100u);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_thrown_through_the_next_in_a_row),
        cmocka_unit_test(nothing_bounces_through_the_next_in_a_row),
        cmocka_unit_test(nothing_gets_through_others_where_several_meet),
        cmocka_unit_test(nothing_is_squeezed_on_the_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
