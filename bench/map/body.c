/// @file body.c
/// Shapes of bodies.
///
/// SPDX-License-Identifier: MIT
#include "map/body.h"

#include <math.h>

#include "scenes/internal.h"

enum { MOST_COLUMNS = 9, MOST_ROWS = 6 };

/// What is being drawn.
typedef struct drawing {
    map_body *body;
    const map_stuff *stuff;
    uint64_t *seed;
} drawing;

double map_between(uint64_t *seed, double low, double high) {
    return low + (high - low) * random_unit(seed);
}

double map_decades(uint64_t *seed, double low, double high) {
    return exp(map_between(seed, log(low), log(high)));
}

const char *map_shape_name(map_shape shape) {
    static const char *const names[] = {"lattice", "holes", "mesh",   "truss", "rope",
                                        "graph",   "wheel", "rigged", "two",   "loose"};
    return names[shape];
}

static uint32_t count_between(const drawing *d, uint32_t low, uint32_t high) {
    return low + random_below(d->seed, high - low + 1);
}

static mspring_id add_particle(const drawing *d, double column, double row) {
    map_body *body = d->body;
    mspring_particle_def *def = &body->particles[body->particle_count];
    mspring_init(MSPRING_STRUCT_PARTICLE_DEF, def, sizeof *def);
    def->x = d->stuff->spacing * column;
    def->y = d->stuff->spacing * row;
    def->mass = (float)map_decades(d->seed, 1, d->stuff->mass_ratio);
    return body->particle_count++;
}

static bool is_joined(const map_body *body, mspring_id a, mspring_id b) {
    for (uint32_t i = 0; i < body->spring_count; i++)
        if ((body->springs[i].a == a && body->springs[i].b == b) ||
            (body->springs[i].a == b && body->springs[i].b == a))
            return true;
    return false;
}

static void add_spring(const drawing *d, mspring_id a, mspring_id b) {
    map_body *body = d->body;
    if (a == b || a == MSPRING_NONE || b == MSPRING_NONE || is_joined(body, a, b))
        return;
    mspring_spring_def *def = &body->springs[body->spring_count++];
    const double stiffness = d->stuff->stiffness * map_decades(d->seed, 1, d->stuff->spread);
    const double first = (double)body->particles[a].mass, second = (double)body->particles[b].mass;
    mspring_init(MSPRING_STRUCT_SPRING_DEF, def, sizeof *def);
    def->a = a;
    def->b = b;
    def->stiffness = (float)stiffness;
    def->damping = (float)(d->stuff->damping_ratio * 2 * sqrt(stiffness * first * second / (first + second)));
}

/// A grid, with or without diagonals and empty cells.
static void add_grid(const drawing *d, uint32_t columns, uint32_t rows, double holes, bool diagonals) {
    static const int to[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    mspring_id ids[MOST_ROWS][MOST_COLUMNS];
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++)
            ids[row][column] = random_unit(d->seed) < holes ? MSPRING_NONE : add_particle(d, column, row);
    for (uint32_t row = 0; row < rows; row++) {
        for (uint32_t column = 0; column < columns; column++) {
            for (int i = 0; i < (diagonals ? 4 : 2); i++) {
                const uint32_t c = column + (uint32_t)to[i][0], r = row + (uint32_t)to[i][1];
                if (c < columns && r < rows)
                    add_spring(d, ids[row][column], ids[r][c]);
            }
        }
    }
}

/// A straight chain from a particle, to the right and up.
static void add_chain(const drawing *d, mspring_id from, uint32_t segments) {
    const double x = d->body->particles[from].x / d->stuff->spacing,
                 y = d->body->particles[from].y / d->stuff->spacing;
    const double angle = map_between(d->seed, 0, 1.5);
    for (uint32_t i = 1; i <= segments; i++) {
        const mspring_id next = add_particle(d, x + i * cos(angle), y + i * sin(angle));
        add_spring(d, from, next);
        from = next;
    }
}

static void add_truss(const drawing *d, double x, uint32_t panels) {
    mspring_id low = add_particle(d, x, 0), high = MSPRING_NONE;
    for (uint32_t i = 1; i <= panels; i++) {
        const mspring_id next_high = add_particle(d, x + i - 0.5, 0.9), next_low = add_particle(d, x + i, 0);
        add_spring(d, low, next_high);
        add_spring(d, low, next_low);
        add_spring(d, next_high, next_low);
        add_spring(d, high, next_high);
        low = next_low;
        high = next_high;
    }
}

static void add_graph(const drawing *d, uint32_t particles, uint32_t springs) {
    const mspring_id first = d->body->particle_count;
    const double size = sqrt(particles);
    for (uint32_t i = 0; i < particles; i++) {
        const double column = map_between(d->seed, 0, size), row = map_between(d->seed, 0, size);
        add_particle(d, column, row);
    }
    for (uint32_t i = 1; i < particles; i++) // all in one piece
        add_spring(d, first + i, first + random_below(d->seed, i));
    while (springs-- > particles) {
        const mspring_id a = first + random_below(d->seed, particles), b = first + random_below(d->seed, particles);
        add_spring(d, a, b);
    }
}

static void add_wheel(const drawing *d, uint32_t spokes) {
    const double radius = spokes / 6.28318530717958648;
    const mspring_id hub = add_particle(d, radius, radius);
    mspring_id first = MSPRING_NONE, last = MSPRING_NONE;
    for (uint32_t i = 0; i < spokes; i++) {
        const double angle = i / radius;
        const mspring_id next = add_particle(d, radius + radius * cos(angle), radius + radius * sin(angle));
        add_spring(d, hub, next);
        add_spring(d, last, next);
        first = i == 0 ? next : first;
        last = next;
    }
    add_spring(d, last, first);
}

static void add_rigged(const drawing *d) {
    const uint32_t columns = count_between(d, 2, 6);
    add_grid(d, columns, count_between(d, 2, 4), 0, true);
    const mspring_id corner = d->body->particle_count - 1, other = random_below(d->seed, columns);
    add_chain(d, corner, count_between(d, 2, 8));
    add_chain(d, other, count_between(d, 1, 6));
}

void map_draw_body(map_body *body, map_shape shape, const map_stuff *stuff, uint64_t *seed) {
    const drawing d = {body, stuff, seed};
    body->particle_count = body->spring_count = 0;
    if (shape == MAP_LATTICE || shape == MAP_HOLES || shape == MAP_MESH) {
        const uint32_t columns = count_between(&d, 2, MOST_COLUMNS);
        add_grid(&d, columns, count_between(&d, 2, MOST_ROWS), shape == MAP_HOLES ? 0.25 : 0, shape != MAP_MESH);
    } else if (shape == MAP_TRUSS) {
        add_truss(&d, 0, count_between(&d, 2, 12));
    } else if (shape == MAP_ROPE) {
        const mspring_id first = add_particle(&d, 0, 0);
        add_chain(&d, first, count_between(&d, 2, 24));
    } else if (shape == MAP_GRAPH) {
        const uint32_t particles = count_between(&d, 4, 40);
        add_graph(&d, particles, particles * count_between(&d, 2, 5) / 2);
    } else if (shape == MAP_WHEEL) {
        add_wheel(&d, count_between(&d, 4, 24));
    } else if (shape == MAP_RIGGED) {
        add_rigged(&d);
    } else if (shape == MAP_TWO) {
        const uint32_t columns = count_between(&d, 2, 5);
        add_grid(&d, columns, count_between(&d, 2, 5), 0, true);
        add_truss(&d, 7, count_between(&d, 1, 6));
    } else {
        for (uint32_t count = count_between(&d, 1, 6); count > 0; count--) {
            const double column = map_between(seed, 0, 6);
            add_particle(&d, column, map_between(seed, 0, 3));
        }
    }
    if (body->particle_count == 0) // all of the cells empty
        add_particle(&d, 0, 0);
}

void map_body_box(const map_body *body, double *left, double *bottom, double *right, double *top) {
    *left = *bottom = INFINITY;
    *right = *top = -INFINITY;
    for (uint32_t i = 0; i < body->particle_count; i++) {
        *left = fmin(*left, body->particles[i].x);
        *right = fmax(*right, body->particles[i].x);
        *bottom = fmin(*bottom, body->particles[i].y);
        *top = fmax(*top, body->particles[i].y);
    }
}

void map_move_body(map_body *body, double x, double y) {
    for (uint32_t i = 0; i < body->particle_count; i++) {
        body->particles[i].x += x;
        body->particles[i].y += y;
    }
}

mspring_result map_build_body(const map_body *body, mspring_builder *builder) {
    const mspring_result result =
        mspring_builder_add_particles(builder, body->particles, body->particle_count, NULL);
    if (result != MSPRING_OK || body->spring_count == 0)
        return result;
    return mspring_builder_add_springs(builder, body->springs, body->spring_count, NULL);
}
