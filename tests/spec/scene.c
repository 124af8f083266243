/// @file scene.c
/// Random networks: lattices with holes, along the axes, turned, oblong and bent; chains and graphs, free and on
/// lattices; equal graphs; particles without springs.
/// A seed gives the same network with every compiler: no function of libm but sqrt, no two draws in one expression.
///
/// SPDX-License-Identifier: MIT
#include "scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

double scene_between(scene *s, double low, double high) {
    return support_random_between(&s->seed, low, high);
}

uint32_t scene_below(scene *s, uint32_t count) {
    return (uint32_t)(support_random(&s->seed) % count);
}

bool scene_chance(scene *s, double share) {
    return scene_between(s, 0, 1) < share;
}

static double power_of_ten(int power) {
    double value = 1;
    for (; power > 0; power--) {
        value *= 10;
    }
    for (; power < 0; power++) {
        value /= 10;
    }
    return value;
}

static uint32_t add_particle(scene *s, double x, double y) {
    assert_true(s->particle_count < SCENE_PARTICLES);
    s->particles[s->particle_count] = (scene_particle){.x = x, .y = y, .mass = (float)scene_between(s, 0.5, 2)};
    return s->particle_count++;
}

/// Add a particle anywhere in a box that begins where the next part does.
static void add_particle_in(scene *s, double width, double low, double high) {
    const double x = s->left + scene_between(s, 0, width), y = scene_between(s, low, high);
    add_particle(s, x, y);
}

void scene_add_spring(scene *s, uint32_t a, uint32_t b, bool is_made) {
    assert_true(s->spring_count < SCENE_SPRINGS);
    const double dx = s->particles[a].x - s->particles[b].x, dy = s->particles[a].y - s->particles[b].y;
    const double strain = s->is_calm ? 0 : scene_between(s, -0.1, 0.1);
    const double length = scene_chance(s, s->welds) ? 0 : sqrt(dx * dx + dy * dy) * (1 + strain);
    const float stiffness = s->stiffness * (float)scene_between(s, 0.3, 1);
    const float damping = scene_chance(s, 0.2) ? 0 : s->damping * (float)scene_between(s, 0, 1);
    s->springs[s->spring_count++] =
        (spec_spring){.a = a, .b = b, .stiffness = stiffness, .damping = damping, .rest_length = (float)length};
    s->springs[s->spring_count - 1].break_strain =
        scene_chance(s, s->brittle) ? (float)scene_between(s, 0.05, 0.5) : INFINITY;
    spec_spring *spring = &s->springs[s->spring_count - 1];
    spring->yield_strain = INFINITY;
    spring->hardening = MSPRING_HARDENING_DEFAULT;
    spring->plastic_limit = MSPRING_PLASTIC_LIMIT_DEFAULT;
    if (!is_made) {
        return;
    }
    if (s->ductile > 0) {
        spring->nominal = spring->rest_length;
    }
    if (scene_chance(s, s->ductile)) {
        spring->yield_strain = (float)scene_between(s, 0.02, 0.2);
        spring->hardening = scene_chance(s, 0.5) ? spring->hardening : (float)scene_between(s, 0, 0.5);
        spring->plastic_limit = scene_chance(s, 0.5) ? spring->plastic_limit : (float)scene_between(s, 0.05, 0.5);
    }
    if (!s->is_calm && scene_chance(s, s->relative)) {
        spec_spring *made = &s->springs[s->spring_count - 1];
        made->is_relative = true;
        made->stiffness_share = (float)scene_between(s, 0, 0.05);
        made->damping_share = (float)scene_between(s, 0, 0.02);
    }
    if (!s->is_calm && scene_chance(s, s->one_way)) {
        s->springs[s->spring_count - 1].side = scene_chance(s, 0.5) ? 1 : -1;
    }
}

static void add_spring(scene *s, uint32_t a, uint32_t b) {
    scene_add_spring(s, a, b, true);
}

/// Add a spring, unless there is one already.
static void join(scene *s, uint32_t a, uint32_t b) {
    for (uint32_t i = 0; i < s->spring_count; i++) {
        const spec_spring *there = &s->springs[i];
        if ((there->a == a && there->b == b) || (there->a == b && there->b == a)) {
            return;
        }
    }
    add_spring(s, a, b);
}

/// A lattice along the axes, with holes and without some of its springs. Returns its first particle.
static uint32_t add_lattice(scene *s) {
    enum { SIDE = 40 };
    const uint32_t width = 2 + scene_below(s, scene_chance(s, 0.3) ? SIDE - 2 : 14),
                   height = 2 + scene_below(s, scene_chance(s, 0.2) ? 24 : 9);
    const double spacing = scene_between(s, 0.1, 1), holes = scene_chance(s, 0.5) ? 0 : scene_between(s, 0, 0.25);
    const double missing = scene_chance(s, 0.6) ? 0 : scene_between(s, 0, 0.2),
                 bend = scene_chance(s, 0.5) ? 0 : scene_between(s, 0, 0.1);
    const bool has_diagonals = scene_chance(s, 0.8), is_turned = scene_chance(s, 0.3);
    const double half = is_turned ? scene_between(s, -1, 1) : 0; // tangent of half the angle
    const double arch = is_turned ? scene_between(s, 0, 0.01) : 0;
    const double cosine = (1 - half * half) / (1 + half * half), sine = 2 * half / (1 + half * half);
    const double oblong = is_turned ? scene_between(s, 0.6, 1.6) : 1;
    const uint32_t begin = s->particle_count;
    uint32_t ids[32][SIDE];
    memset(ids, 0xff, sizeof ids);
    for (uint32_t r = 0; r < height; r++) {
        for (uint32_t c = 0; c < width; c++) {
            if (!scene_chance(s, holes)) {
                const double x = spacing * (c + bend * scene_between(s, -1, 1));
                const double y = spacing * (oblong * (r + bend * scene_between(s, -1, 1)) + arch * c * c);
                ids[r][c] = add_particle(s, s->left + x * cosine - y * sine, x * sine + y * cosine);
            }
        }
    }
    for (uint32_t r = 0; r < height; r++) {
        for (uint32_t c = 0; c < width; c++) {
            const uint32_t next[][2] = {{r, c + 1}, {r + 1, c}, {r + 1, c + 1}, {r + 1, c - 1}};
            for (int i = 0; i < (has_diagonals ? 4 : 2); i++) {
                const bool is_inside = next[i][0] < height && next[i][1] < width; // c - 1 wraps around
                if (is_inside && ids[r][c] != SPEC_NONE && ids[next[i][0]][next[i][1]] != SPEC_NONE &&
                    !scene_chance(s, missing)) {
                    add_spring(s, ids[r][c], ids[next[i][0]][next[i][1]]);
                }
            }
        }
    }
    s->left += spacing * (width + 1);
    return begin;
}

/// A chain, free, in a ring, or from a particle on.
static uint32_t add_chain(scene *s, uint32_t from) {
    const uint32_t count = 2 + scene_below(s, 40), begin = s->particle_count;
    const double spacing = scene_between(s, 0.1, 0.5), slope = scene_between(s, -0.7, 0.7);
    for (uint32_t i = 0; i < count; i++) {
        add_particle(s, s->left + spacing * i, slope * spacing * i + 0.01 * scene_between(s, -1, 1));
        if (i > 0) {
            add_spring(s, begin + i - 1, begin + i);
        }
    }
    s->left += spacing * (count + 1);
    if (from != SPEC_NONE) {
        add_spring(s, from, begin);
    } else if (count > 2 && scene_chance(s, 0.3)) {
        add_spring(s, begin + count - 1, begin);
    }
    return begin;
}

/// Particles anywhere, in a random graph.
static uint32_t add_graph(scene *s, uint32_t count) {
    const uint32_t begin = s->particle_count, degree = 1 + scene_below(s, 5);
    const double size = 0.5 * sqrt(count);
    for (uint32_t i = 0; i < count; i++) {
        add_particle_in(s, size, 0, size);
    }
    uint8_t *is_joined = calloc((size_t)count * count, 1);
    assert_non_null(is_joined);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < degree; k++) {
            const uint32_t other = k == 0 && i > 0 ? scene_below(s, i) : scene_below(s, count);
            if (other != i && !is_joined[i * count + other]) {
                is_joined[i * count + other] = is_joined[other * count + i] = 1;
                add_spring(s, begin + i, begin + other);
            }
        }
    }
    free(is_joined);
    s->left += size + 0.5;
    return begin;
}

/// Equal small graphs, which the layout lays side by side.
static void add_equal_graphs(scene *s) {
    s->has_bundles = true;
    for (uint32_t i = 0; i < 20; i++) {
        const uint32_t begin = s->particle_count;
        for (uint32_t p = 0; p < 5; p++) {
            add_particle_in(s, 1, 0, 1);
            for (uint32_t q = 0; q < p; q++) {
                add_spring(s, begin + q, begin + p);
            }
        }
        s->left += 1.5;
    }
}

/// Put particles and springs into another order.
static void shuffle(scene *s) {
    uint32_t to[SCENE_PARTICLES];
    for (uint32_t p = 0; p < s->particle_count; p++) {
        to[p] = p;
    }
    for (uint32_t p = s->particle_count; p > 1; p--) {
        const uint32_t q = scene_below(s, p), kept = to[p - 1];
        to[p - 1] = to[q];
        to[q] = kept;
    }
    static scene_particle moved[SCENE_PARTICLES];
    for (uint32_t p = 0; p < s->particle_count; p++) {
        moved[to[p]] = s->particles[p];
    }
    memcpy(s->particles, moved, sizeof moved);
    for (uint32_t i = s->spring_count; i > 0; i--) {
        const uint32_t k = scene_below(s, i);
        const spec_spring kept = s->springs[k];
        s->springs[k] = s->springs[i - 1];
        s->springs[i - 1] = kept;
    }
    for (uint32_t i = 0; i < s->spring_count; i++) {
        s->springs[i].a = to[s->springs[i].a];
        s->springs[i].b = to[s->springs[i].b];
    }
}

/// Leave out particles without springs.
static void drop_loose(scene *s) {
    static uint32_t to[SCENE_PARTICLES];
    uint32_t count = 0;
    memset(to, 0, sizeof to);
    for (uint32_t i = 0; i < s->spring_count; i++) {
        to[s->springs[i].a] = to[s->springs[i].b] = 1;
    }
    for (uint32_t p = 0; p < s->particle_count; p++) {
        if (to[p] > 0) {
            s->particles[count] = s->particles[p];
            to[p] = count++;
        }
    }
    s->particle_count = count;
    for (uint32_t i = 0; i < s->spring_count; i++) {
        s->springs[i].a = to[s->springs[i].a];
        s->springs[i].b = to[s->springs[i].b];
    }
}

/// Particles at rest in chains and a lattice without diagonals, where no force acts, and one that moves: ahead of
/// its waves speeds fall to subnormal ones.
static void add_calm(scene *s) {
    s->is_calm = true;
    s->gravity_x = s->gravity_y = 0;
    s->welds = 0;
    for (uint32_t r = 0; r < 8; r++) {
        for (uint32_t c = 0; c < 40; c++) {
            const uint32_t at = add_particle(s, 0.5 * c, r);
            if (c > 0) {
                add_spring(s, at - 1, at);
            }
            if (r > 4) {
                add_spring(s, at - 40, at);
            }
        }
    }
    s->left = 20;
}

static void add_part(scene *s) {
    const uint32_t kind = scene_below(s, 10);
    if (kind < 5) {
        const uint32_t begin = add_lattice(s), lattice_end = s->particle_count;
        while (lattice_end > begin && scene_chance(s, 0.4)) {
            const uint32_t at = begin + scene_below(s, lattice_end - begin);
            const uint32_t hung = scene_chance(s, 0.6) ? add_chain(s, at) : add_graph(s, 3 + scene_below(s, 20));
            if (scene_chance(s, 0.5)) {
                join(s, begin + scene_below(s, lattice_end - begin), s->particle_count - 1);
            }
            join(s, at, hung + (hung + 1 < s->particle_count));
        }
    } else if (kind < 7) {
        add_chain(s, SPEC_NONE);
    } else if (kind < 9) {
        const uint32_t graph = add_graph(s, 2 + scene_below(s, 60));
        if (scene_chance(s, 0.5)) {
            add_chain(s, graph);
        }
    } else {
        add_equal_graphs(s);
    }
}

static void add_floor(scene *s) {
    s->plane_count = 1 + scene_below(s, 3);
    for (uint32_t i = 0; i < s->plane_count; i++) {
        const double slope = i == 0 ? scene_between(s, -0.3, 0.3) : scene_between(s, -3, 3);
        const double x = i == 0 ? 0.5 * s->left : i == 1 ? -0.1 : s->left, side = i == 2 ? -1 : 1;
        const double plane[4] = {x, -scene_between(s, 0, 0.3), i == 0 ? slope : side, i == 0 ? 1 : slope};
        memcpy(s->planes[i], plane, sizeof plane);
    }
    if (scene_chance(s, 0.3)) {
        s->plane_count = scene_below(s, s->plane_count);
        s->height_count = 2 + scene_below(s, 38);
        s->heights_x = scene_between(s, -0.2, 0.5) * s->left;
        s->heights_y = scene_between(s, -0.3, 0);
        s->spacing = scene_between(s, 0.2, 1.2) * s->left / s->height_count;
        s->has_frictions = scene_chance(s, 0.3);
        const double rough = scene_between(s, 0, 0.5) * s->spacing;
        for (uint32_t i = 0; i < s->height_count; i++) {
            s->heights[i] = (float)(rough * scene_between(s, -1, 0.2));
            s->frictions[i] = (float)scene_between(s, 0, 1);
            s->restitutions[i] = (float)scene_between(s, 0, 1);
        }
    }
    s->friction = scene_chance(s, 0.3) ? 0 : (float)scene_between(s, 0, 1.5);
    s->restitution = scene_chance(s, 0.3) ? 0 : (float)scene_between(s, 0, 1);
}

/// Shuffle, pin and move the particles; add loose ones or a floor.
static void scatter(scene *s) {
    const bool has_loose = scene_chance(s, 0.3);
    for (uint32_t i = 0, count = scene_below(s, 20); has_loose && i < count; i++) {
        const double x = s->left * scene_between(s, 0, 1);
        add_particle(s, x, scene_between(s, -3, 3));
    }
    if (!has_loose) {
        drop_loose(s);
    }
    if (scene_chance(s, 0.5)) {
        shuffle(s);
        s->has_bundles = false; // equal components have equal orders of springs
    }
    const double pins = scene_chance(s, 0.5) ? 0 : scene_between(s, 0, 0.2),
                 speed = scene_chance(s, 0.2) ? 0 : scene_between(s, 0, 3);
    const double far = scene_chance(s, 0.8) ? 0 : scene_between(s, -2000, 2000);
    for (uint32_t p = 0; p < s->particle_count; p++) {
        scene_particle *made = &s->particles[p];
        made->is_pinned = scene_chance(s, pins);
        made->vx = (float)(speed * scene_between(s, -1, 1)) + 0.0f; // no -0
        made->vy = (float)(speed * scene_between(s, -1, 1)) + 0.0f;
        made->x += far;
    }
    if (scene_chance(s, 0.5)) {
        add_floor(s);
        for (uint32_t i = 0; i < s->plane_count; i++) {
            s->planes[i][0] += far;
        }
        s->heights_x += far;
    }
}

void scene_make(scene *s, uint64_t seed) {
    memset(s, 0, sizeof *s);
    s->seed = seed;
    (void)support_random(&s->seed);
    s->stiffness = (float)power_of_ten(1 + (int)scene_below(s, 6));
    s->damping = scene_chance(s, 0.5) ? 0 : (float)(0.1 * sqrt((double)s->stiffness));
    s->gravity_x = scene_chance(s, 0.7) ? 0 : (float)scene_between(s, -5, 5);
    s->gravity_y = scene_chance(s, 0.2) ? 0 : -9.8f;
    s->global_damping = scene_chance(s, 0.5) ? 0 : (float)power_of_ten((int)scene_below(s, 8) - 4);
    s->global_damping *= (float)scene_between(s, 1, 10);
    s->welds = scene_chance(s, 0.8) ? 0 : 0.1;
    s->one_way = scene_chance(s, 0.85) ? 0 : 0.1;
    s->relative = s->one_way > 0 || scene_chance(s, 0.85) ? 0 : 0.5;
    s->brittle = scene_chance(s, 0.8) ? 0 : scene_between(s, 0, 0.5);
    s->grows = scene_chance(s, 0.3);
    s->ductile = s->one_way > 0 || s->relative > 0 || s->grows || scene_chance(s, 0.7) ? 0 : scene_between(s, 0.1, 1);
    s->max_substeps = scene_chance(s, 0.8) ? 1000 : 1 + scene_below(s, 20);
    s->most_work = scene_chance(s, 0.7) ? 4 : scene_below(s, 3);
    s->flags = scene_chance(s, 0.4) ? MSPRING_NETWORK_PRECISE : 0;
    if (scene_chance(s, 0.06)) {
        add_calm(s);
        s->particles[scene_below(s, s->particle_count)].vx = 1;
        return;
    }
    for (uint32_t part = 0, parts = 1 + scene_below(s, 4); part < parts; part++) {
        add_part(s);
    }
    if (s->spring_count == 0) {
        add_chain(s, SPEC_NONE);
    }
    scatter(s);
}
