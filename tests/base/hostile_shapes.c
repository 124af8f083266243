/// @file hostile_shapes.c
///
/// SPDX-License-Identifier: MIT
#include "hostile_shapes.h"

#include <math.h>

#include "support.h"

mspring_builder *shapes_builder_for(costs *c) {
    mspring_builder *builder;
    check_ok(mspring_builder_create(&c->allocator, &builder));
    return builder;
}

mspring_network *shapes_network_of(mspring_builder *builder, costs *c, uint32_t spares) {
    mspring_network_def def = support_def(0, 1);
    def.allocator = &c->allocator;
    def.spare_particles = def.spare_springs = spares;
    def.settings.solver = MSPRING_SOLVER_EXPLICIT;
    return support_network(builder, &def);
}

mspring_builder *shape_circle(costs *c, uint32_t n) {
    mspring_builder *builder = shapes_builder_for(c);
    support_particle(builder, 0, 0, 1e6f);
    for (uint32_t i = 0; i < n; i++) {
        const double turn = 6.283185307179586 * i / n;
        support_particle(builder, cos(turn), sin(turn), 1);
    }
    return builder;
}

mspring_builder *shape_star(costs *c, uint32_t n) {
    mspring_builder *builder = shape_circle(c, n);
    for (uint32_t i = 1; i <= n; i++) {
        support_spring(builder, 0, i, 1, 0);
    }
    return builder;
}

mspring_builder *shape_wheel(costs *c, uint32_t n) {
    mspring_builder *builder = shape_star(c, n);
    for (uint32_t i = 1; i <= n; i++) {
        support_spring(builder, i, i % n + 1, 1, 0);
    }
    return builder;
}

mspring_builder *shape_clique(costs *c, uint32_t n) {
    const uint32_t count = (uint32_t)sqrt(2.0 * n);
    mspring_builder *builder = shape_circle(c, count);
    for (uint32_t i = 1; i <= count; i++) {
        for (uint32_t k = 1; k < i; k++) {
            support_spring(builder, k, i, 1, 0);
        }
    }
    return builder;
}

static mspring_builder *path(costs *c, uint32_t n, bool is_in_one_place) {
    mspring_builder *builder = shapes_builder_for(c);
    for (uint32_t i = 0; i <= n; i++) {
        support_particle(builder, is_in_one_place ? 0 : i, 0, 1);
    }
    for (uint32_t i = 0; i < n; i++) { // by leaps, so that neighbours have far numbers
        const uint32_t at = (uint32_t)((uint64_t)i * 7919 % n);
        support_join(builder, at, at + 1, 1, 1, 0);
    }
    return builder;
}

mspring_builder *shape_path(costs *c, uint32_t n) {
    return path(c, n, false);
}

mspring_builder *shape_point(costs *c, uint32_t n) {
    return path(c, n, true);
}

mspring_builder *shape_loose(costs *c, uint32_t n) {
    mspring_builder *builder = shapes_builder_for(c);
    for (uint32_t i = 0; i < n; i++) {
        support_particle(builder, 0, 0, 1);
    }
    return builder;
}

mspring_builder *shape_row(costs *c, uint32_t n) {
    mspring_builder *builder = shapes_builder_for(c);
    for (uint32_t i = 0; i < n; i++) {
        support_particle(builder, ROW_SPACING * i, 0, 1);
    }
    return builder;
}

static mspring_builder *parts(costs *c, uint32_t n, bool are_lattices) {
    mspring_builder *builder = shapes_builder_for(c);
    for (uint32_t i = 0; i < n / 4; i++) {
        const mspring_id first = support_particle(builder, 3.0 * i, 0, 1);
        support_particle(builder, 3.0 * i + 1, 0, 1);
        support_particle(builder, 3.0 * i, 1, 1);
        support_particle(builder, 3.0 * i + 1, are_lattices ? 1 : 1.7, 1);
        for (uint32_t a = 0; a < 4; a++) {
            for (uint32_t b = 0; b < a; b++) {
                support_spring(builder, first + b, first + a, 1, 0);
            }
        }
    }
    return builder;
}

mspring_builder *shape_lattices(costs *c, uint32_t n) {
    return parts(c, n, true);
}

mspring_builder *shape_cliques(costs *c, uint32_t n) {
    return parts(c, n, false);
}

mspring_builder *shape_lattice(costs *c, uint32_t n) {
    mspring_builder *builder = shapes_builder_for(c);
    const uint32_t width = (uint32_t)sqrt((double)n);
    for (uint32_t i = 0; i < width * width; i++) {
        support_particle(builder, i % width, i / width, 1);
        for (uint32_t k = 0; k < 4; k++) {
            static const int32_t ways[4][2] = {{-1, 0}, {0, -1}, {-1, -1}, {1, -1}};
            const uint32_t x = i % width + (uint32_t)ways[k][0], y = i / width + (uint32_t)ways[k][1];
            if (x < width && y < width) {
                support_spring(builder, y * width + x, i, 1, 0);
            }
        }
    }
    return builder;
}
