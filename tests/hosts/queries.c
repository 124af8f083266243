/// @file queries.c
/// Queries beside a pass over plain arrays.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "game.h"

/// Places of all particles.
static double x[MOST_PARTICLES], y[MOST_PARTICLES];
static mspring_id found[MOST_SPRINGS];

static void judge_bounds(game *it, const place *p, double box[4]) {
    double expected[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    bool is_any = false;
    JUDGE(it, support_get_bounds(p->network, &box[0], &box[1], &box[2], &box[3]) == MSPRING_OK);
    for (mspring_id i = 0; i < p->plain->particles; i++) {
        if (!p->plain->has_particle[i])
            continue;
        is_any = true;
        expected[0] = fmin(expected[0], x[i]), expected[1] = fmin(expected[1], y[i]);
        expected[2] = fmax(expected[2], x[i]), expected[3] = fmax(expected[3], y[i]);
    }
    for (int i = 0; i < 4 && is_any; i++)
        JUDGE(it, fabs(box[i] - expected[i]) <= 1e-6 * (1 + fabs(expected[i])));
}

static void judge_near(game *it, const place *p, const double at[2], double radius) {
    mspring_id nearest = 0;
    double distance = 0, least = INFINITY;
    uint32_t count = 0, sure = 0, at_most = 0;
    const double margin = 1e-6 * (1 + fabs(at[0]) + fabs(at[1]));
    for (mspring_id i = 0; i < p->plain->particles; i++) {
        const double d = p->plain->has_particle[i] ? hypot(x[i] - at[0], y[i] - at[1]) : INFINITY;
        least = fmin(least, d);
        sure += d <= radius - margin;
        at_most += d <= radius + margin;
    }
    JUDGE(it,
          mspring_network_nearest_particle(p->network, at[0], at[1], radius, &nearest, &distance) == MSPRING_OK);
    if (nearest == MSPRING_NONE) {
        JUDGE(it, least > radius - margin);
    } else {
        JUDGE(it, fabs(distance - least) <= margin && p->plain->has_particle[nearest]);
        JUDGE(it, fabs(hypot(x[nearest] - at[0], y[nearest] - at[1]) - least) <= margin);
    }
    JUDGE(it, mspring_network_particles_in_circle(p->network, at[0], at[1], radius, found, MOST_SPRINGS, &count) ==
                  MSPRING_OK);
    JUDGE(it, count >= sure && count <= at_most);
    for (uint32_t i = 0; i < count; i++)
        JUDGE(it, p->plain->has_particle[found[i]] && (i == 0 || found[i] > found[i - 1]));
}

static void judge_box(game *it, const place *p, const double a[2], const double b[2]) {
    uint32_t count = 0, sure = 0, at_most = 0;
    const double m = 1e-6 * (1 + fabs(a[0]) + fabs(a[1])), low[2] = {fmin(a[0], b[0]), fmin(a[1], b[1])},
                 high[2] = {fmax(a[0], b[0]), fmax(a[1], b[1])};
    for (mspring_id i = 0; i < p->plain->particles; i++) {
        if (!p->plain->has_particle[i])
            continue;
        sure += x[i] >= low[0] + m && x[i] <= high[0] - m && y[i] >= low[1] + m && y[i] <= high[1] - m;
        at_most += x[i] >= low[0] - m && x[i] <= high[0] + m && y[i] >= low[1] - m && y[i] <= high[1] + m;
    }
    JUDGE(it, mspring_network_particles_in_box(p->network, low[0], low[1], high[0], high[1], found, MOST_SPRINGS,
                                               &count) == MSPRING_OK);
    JUDGE(it, count >= sure && count <= at_most);
}

// 1: they cross for sure; 0: perhaps; -1: surely not.
static int do_cross(const double a[2], const double b[2], const double c[2], const double d[2], double margin) {
    const double ab[2] = {b[0] - a[0], b[1] - a[1]}, cd[2] = {d[0] - c[0], d[1] - c[1]};
    const double area = ab[0] * cd[1] - ab[1] * cd[0], ac[2] = {c[0] - a[0], c[1] - a[1]};
    const double size = hypot(ab[0], ab[1]) * hypot(cd[0], cd[1]);
    if (fabs(area) <= 1e-6 * size || size < margin)
        return 0;
    const double t = (ac[0] * cd[1] - ac[1] * cd[0]) / area, u = (ac[0] * ab[1] - ac[1] * ab[0]) / area;
    const double e = margin * (1 + 1 / hypot(ab[0], ab[1]) + 1 / hypot(cd[0], cd[1])) * size / fabs(area);
    if (t < -e || t > 1 + e || u < -e || u > 1 + e)
        return -1;
    return t > e && t < 1 - e && u > e && u < 1 - e;
}

static void judge_across(game *it, const place *p, const double a[2], const double b[2]) {
    static double fractions[MOST_SPRINGS];
    uint32_t count = 0, next = 0;
    const double margin = 1e-5 * (1 + fabs(a[0]) + fabs(a[1]) + fabs(b[0]));
    JUDGE(it, mspring_network_springs_across(p->network, a[0], a[1], b[0], b[1], MSPRING_FIND_WHOLE, found,
                                             fractions, MOST_SPRINGS, &count) == MSPRING_OK);
    for (mspring_id i = 0; i < p->plain->springs; i++) {
        const bool is_found = next < count && found[next] == i;
        next += is_found;
        if (!p->plain->has_spring[i] || p->plain->is_broken[i]) {
            JUDGE(it, !is_found);
            continue;
        }
        const mspring_id *ends = p->plain->ends[i];
        const double c[2] = {x[ends[0]], y[ends[0]]}, d[2] = {x[ends[1]], y[ends[1]]};
        const int expected = do_cross(a, b, c, d, margin);
        JUDGE(it, expected == 0 || is_found == (expected > 0));
        JUDGE(it, !is_found || (fractions[next - 1] >= 0 && fractions[next - 1] <= 1));
    }
    JUDGE(it, next == count);
}

static double distance_to(const mspring_id *ends, const double at[2]) {
    const double c[2] = {x[ends[0]], y[ends[0]]}, d[2] = {x[ends[1]] - c[0], y[ends[1]] - c[1]};
    const double square = d[0] * d[0] + d[1] * d[1];
    const double t = square > 0 ? ((at[0] - c[0]) * d[0] + (at[1] - c[1]) * d[1]) / square : 0;
    const double on = fmin(fmax(t, 0), 1);
    return hypot(c[0] + on * d[0] - at[0], c[1] + on * d[1] - at[1]);
}

// Springs about a point, whole or broken.
static void judge_springs_near(game *it, const place *p, const double at[2], double radius, uint32_t flags) {
    uint32_t count = 0, next = 0;
    mspring_id nearest = 0;
    double distance = 0, least = INFINITY;
    const double margin = 1e-5 * (1 + fabs(at[0]) + fabs(at[1]));
    JUDGE(it, mspring_network_springs_in_circle(p->network, at[0], at[1], radius, flags, found, MOST_SPRINGS,
                                                &count) == MSPRING_OK);
    JUDGE(it, mspring_network_nearest_spring(p->network, at[0], at[1], radius, flags, &nearest, NULL, &distance) ==
                  MSPRING_OK);
    for (mspring_id i = 0; i < p->plain->springs; i++) {
        const bool is_found = next < count && found[next] == i;
        next += is_found;
        if (!p->plain->has_spring[i] ||
            !(flags & (p->plain->is_broken[i] ? MSPRING_FIND_BROKEN : MSPRING_FIND_WHOLE))) {
            JUDGE(it, !is_found);
            continue;
        }
        const double d = distance_to(p->plain->ends[i], at);
        least = fmin(least, d);
        JUDGE(it, is_found ? d <= radius + margin : d >= radius - margin);
    }
    JUDGE(it, next == count);
    JUDGE(it, nearest == MSPRING_NONE ? least >= radius - margin : fabs(distance - least) <= margin);
}

/* ----------------------------------------------------------------------------------------------- springs */

static double far_from_origin(const place *p, mspring_id particle) {
    mspring_view view = {.struct_size = sizeof view};
    if (mspring_network_get_view(p->network, &view) != MSPRING_OK)
        return 0;
    return fabs(x[particle] - view.origin_x) + fabs(y[particle] - view.origin_y);
}

static void judge_strains(game *it, const place *p) {
    static float strains[MOST_SPRINGS], lengths[2][MOST_SPRINGS];
    float largest = -1, expected = 0;
    mspring_id spring = 0, first = MSPRING_NONE;
    const uint32_t count = p->plain->springs;
    JUDGE(it, mspring_network_get(p->network, MSPRING_STRAIN, NULL, 0, count, strains, 1) == MSPRING_OK);
    JUDGE(it, mspring_network_get(p->network, MSPRING_LENGTH, NULL, 0, count, lengths[0], 1) == MSPRING_OK);
    JUDGE(it, support_get_max_strain(p->network, &largest, &spring) == MSPRING_OK);
    for (mspring_id i = 0; i < count; i++) {
        if (p->plain->has_spring[i] && (first == MSPRING_NONE || fabsf(strains[i]) > expected))
            expected = fabsf(strains[i]), first = i;
        if (!p->plain->has_spring[i])
            continue;
        const mspring_id *ends = p->plain->ends[i];
        const double d = hypot(x[ends[0]] - x[ends[1]], y[ends[0]] - y[ends[1]]);
        JUDGE(it, fabs(d - (double)lengths[0][i]) <= 1e-5 * d + 1e-9 * (fabs(x[ends[0]]) + fabs(y[ends[0]])));
    }
    JUDGE(it, largest == expected && (spring == first || largest == 0));
    JUDGE(it, support_get_extents(p->network, lengths[1], NULL, NULL, NULL) == MSPRING_OK);
    for (mspring_id i = 0; i < count; i++) {
        // Of first words, which are rounded to 2^-23 of a coordinate and more.
        const mspring_id *ends = p->plain->ends[i];
        const double length = (double)lengths[0][i];
        if (it->setup.is_verbose && p->plain->has_spring[i] &&
            !(fabs((double)lengths[1][i] - length) <= 1e-5 * length))
            printf("%u: %g %g, ends at %g %g and %g %g\n", i, length, (double)lengths[1][i], x[ends[0]], y[ends[0]],
                   x[ends[1]], y[ends[1]]);
        JUDGE(it, !p->plain->has_spring[i] ||
                      fabs((double)lengths[1][i] - length) <=
                          1e-5 * length + 4e-7 * (far_from_origin(p, ends[0]) + far_from_origin(p, ends[1])));
    }
}

static uint32_t root_of(uint32_t *parents, uint32_t i) {
    while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
    return i;
}

// Components by their lowest particle, in that order. Only if the host has asked for them before.
static void judge_components(game *it, const place *p) {
    static uint32_t parents[MOST_PARTICLES], numbers[MOST_PARTICLES], expected[MOST_PARTICLES];
    const plain *list = p->plain;
    uint32_t count = 0, next = 0;
    if (list->particles == 0 ||
        mspring_network_get_integers(p->network, MSPRING_COMPONENT, NULL, 0, list->particles, numbers, 1) != MSPRING_OK)
        return;
    while (next < list->particles && (!list->has_particle[next] || numbers[next] == MSPRING_NONE))
        next++;
    if (next == list->particles)
        return;
    next = 0;
    JUDGE(it, mspring_network_update_components(p->network, &count, NULL) == MSPRING_OK);
    JUDGE(it, mspring_network_get_integers(p->network, MSPRING_COMPONENT, NULL, 0, list->particles, numbers, 1) == MSPRING_OK);
    for (uint32_t i = 0; i < list->particles; i++)
        parents[i] = i;
    for (mspring_id i = 0; i < list->springs; i++)
        if (list->has_spring[i] && !list->is_broken[i]) {
            const uint32_t a = root_of(parents, list->ends[i][0]), b = root_of(parents, list->ends[i][1]);
            parents[a < b ? b : a] = a < b ? a : b;
        }
    for (mspring_id i = 0; i < list->particles; i++) {
        const uint32_t root = root_of(parents, i);
        expected[i] = !list->has_particle[i] ? MSPRING_NONE : root == i ? next++ : expected[root];
        JUDGE(it, numbers[i] == expected[i]);
    }
    JUDGE(it, count == next);
}

void judge_queries(game *it, place *p, draws *from) {
    double box[4], a[2], b[2];
    JUDGE(it, mspring_network_get_positions(p->network, NULL, 0, p->plain->particles, x, y, 1) == MSPRING_OK);
    judge_bounds(it, p, box);
    for (int i = 0; i < 2; i++) {
        const double low = box[i] - 1, high = box[i + 2] + 1;
        a[i] = draw_between(from, low, high), b[i] = draw_between(from, low, high);
    }
    if (fabs(box[0]) + fabs(box[1]) + fabs(box[2]) + fabs(box[3]) > 1e11)
        return; // particles far outside the world: sums of coordinates are too inexact
    judge_near(it, p, a, draw_between(from, 0, 4));
    for (uint32_t flags = MSPRING_FIND_WHOLE; flags <= (MSPRING_FIND_WHOLE | MSPRING_FIND_BROKEN); flags++)
        judge_springs_near(it, p, b, fabs(b[0] - a[0]), flags);
    judge_box(it, p, a, b);
    judge_across(it, p, a, b);
    judge_strains(it, p);
    judge_components(it, p);
}
