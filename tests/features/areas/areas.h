/// @file areas.h
/// Scenes with areas for the tests: lattices, a soft jelly, a balloon.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_AREAS_H
#define TEST_AREAS_H

#include <math.h>

#include "support.h"

/// A lattice of so many particles, with springs of `stiffness`, shear springs included.
typedef struct sheet {
    uint32_t width, height;
    double x, y, spacing;
    float stiffness, shear_share, damping, mass;
} sheet;

static inline mspring_id at(const sheet *s, uint32_t column, uint32_t row) {
    return row * s->width + column;
}

// Particles by rows from below, whatever the library's own lattices do.
static inline void build(mspring_builder *builder, const sheet *s, bool is_clamped) {
    static const int directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    const mspring_id first = mspring_builder_count(builder, MSPRING_PARTICLES);
    for (uint32_t j = 0; j < s->height; j++)
        for (uint32_t i = 0; i < s->width; i++) {
            const double x = s->x + i * s->spacing, y = s->y + j * s->spacing;
            (void)(is_clamped && i == 0 ? support_pinned(builder, x, y, s->mass)
                                        : support_particle(builder, x, y, s->mass));
        }
    for (uint32_t j = 0; j < s->height; j++)
        for (uint32_t i = 0; i < s->width; i++)
            for (int d = 0; d < 4; d++) {
                const uint32_t u = i + (uint32_t)directions[d][0], v = j + (uint32_t)directions[d][1];
                const float share = d < 2 ? 1 : s->shear_share;
                if (u < s->width && v < s->height)
                    (void)support_spring(builder, first + at(s, i, j), first + at(s, u, v), share * s->stiffness,
                                         share * s->damping);
            }
}

static inline mspring_area_def elastic(float stiffness) {
    mspring_area_def def;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def));
    def.stiffness = stiffness;
    return def;
}

static inline mspring_area_def gas(float pressure) {
    mspring_area_def def = elastic(0);
    def.kind = MSPRING_AREA_GAS;
    def.pressure = pressure;
    return def;
}

static inline uint32_t add_cells(mspring_network *network, float stiffness) {
    const mspring_area_def def = elastic(stiffness);
    uint32_t count;
    check_ok(mspring_network_add_cell_areas(network, &def, NULL, &count));
    return count;
}

static inline support_area_info info_of(const mspring_network *network, mspring_id area) {
    support_area_info info;
    check_ok(support_get_area_info(network, area, &info));
    return info;
}

static inline mspring_network *sheet_network(const sheet *s, const mspring_network_def *def) {
    mspring_builder *builder = support_builder();
    build(builder, s, false);
    return support_network(builder, def);
}

static inline double twice_triangle(const mspring_network *network, mspring_id a, mspring_id b, mspring_id c) {
    const support_point p = support_position(network, a), q = support_position(network, b),
                        r = support_position(network, c);
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

static inline uint32_t inverted(const mspring_network *network, const sheet *s) {
    uint32_t count = 0;
    for (uint32_t j = 0; j + 1 < s->height; j++)
        for (uint32_t i = 0; i + 1 < s->width; i++) {
            const mspring_id here = at(s, i, j), across = at(s, i + 1, j + 1);
            count += twice_triangle(network, here, at(s, i + 1, j), across) <= 0;
            count += twice_triangle(network, here, across, at(s, i, j + 1)) <= 0;
        }
    return count;
}

static const sheet jelly = {.width = 10,
                            .height = 10,
                            .y = 2,
                            .spacing = 0.1,
                            .stiffness = 200,
                            .shear_share = 1,
                            .damping = 0.2f,
                            .mass = 0.1f};

enum { SKIN = 32 };

// A ring of particles around a gas, in one order around it or the other.
static inline mspring_network *balloon(float pressure, bool is_clockwise, mspring_network_def def,
                                       mspring_id *area) {
    mspring_builder *builder = support_builder();
    mspring_id ring[SKIN];
    for (uint32_t i = 0; i < SKIN; i++) {
        const double turn = 2 * 3.14159265358979 * i / SKIN;
        ring[is_clockwise ? SKIN - 1 - i : i] = support_particle(builder, cos(turn), sin(turn), 0.05f);
    }
    for (uint32_t i = 0; i < SKIN; i++)
        (void)support_spring(builder, i, (i + 1) % SKIN, 1000, 0.1f);
    mspring_network *network = support_network(builder, &def);
    const mspring_area_def inside = gas(pressure);
    check_ok(mspring_network_add_area(network, &inside, ring, SKIN, area));
    return network;
}

#endif
