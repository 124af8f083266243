/// @file loop_rectangle.c
/// The step as one writes it for a rectangle alone. Particles are in rows, so springs need no indices.
///
/// SPDX-License-Identifier: MIT
#include "loops.h"

#include <math.h>
#include <stdlib.h>

enum { ARRAYS = 7 };

typedef struct rectangle {
    uint32_t columns, rows;
    uint32_t *place;                            ///< [columns * rows] particle
    uint32_t *at;                               ///< [columns * rows] where a particle is
    float *x, *y, *vx, *vy, *fx, *fy, *inverse; ///< [columns * rows]
    float *px, *py;                             ///< [4][columns + 2] forces of a row's springs
    float stiffness, damping, rest[2];          ///< of sides, of diagonals
    float lag;                                  ///< as in naive_network
} rectangle;

static bool allocate(rectangle *r, uint32_t count) {
    float **arrays[ARRAYS] = {&r->x, &r->y, &r->vx, &r->vy, &r->fx, &r->fy, &r->inverse};
    bool good = true;
    for (int i = 0; i < ARRAYS; i++)
        good = (*arrays[i] = calloc(count + 1, sizeof(float))) != NULL && good;
    r->px = calloc(8 * (size_t)(r->columns + 2), sizeof *r->px);
    r->py = r->px + 4 * (size_t)(r->columns + 2);
    r->place = malloc(count * sizeof *r->place);
    r->at = malloc(count * sizeof *r->at);
    return good && r->px && r->place && r->at;
}

static void end(void *self) {
    rectangle *r = self;
    float *arrays[] = {r->x, r->y, r->vx, r->vy, r->fx, r->fy, r->inverse, r->px};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
    free(r->place);
    free(r->at);
}

// Whether there is a particle at each place, and as many springs as those places ask for, all alike.
static bool is_full(const naive_network *from, const bench_grid *grid) {
    const uint32_t w = grid->columns, h = grid->rows;
    if (from->particle_count != w * h || from->spring_count > 4 * w * h - 3 * (w + h) + 2)
        return false;
    for (uint32_t i = 1; i < from->spring_count; i++)
        if (fabsf(from->springs[i].stiffness / from->springs[0].stiffness - 1) > 0.01f)
            return false;
    return true;
}

static bool begin(void *self, const naive_network *from, const bench_grid *grid) {
    rectangle *r = self;
    *r = (rectangle){.columns = grid->columns, .rows = grid->rows};
    if (!is_full(from, grid) || !allocate(r, from->particle_count)) {
        end(r);
        return false;
    }
    for (uint32_t i = 0; i < from->particle_count; i++) {
        r->place[i] = grid->place[i];
        r->at[grid->place[i]] = i;
    }
    r->stiffness = from->springs[0].stiffness;
    r->damping = from->springs[0].damping;
    r->rest[0] = from->springs[0].rest_length;
    for (uint32_t i = 0; i < from->spring_count; i++)
        r->rest[0] = fminf(r->rest[0], from->springs[i].rest_length);
    r->rest[1] = 1.41421356f * r->rest[0];
    return true;
}

static void reset(void *self, const naive_network *from) {
    rectangle *r = self;
    r->lag = from->lag;
    for (uint32_t i = 0; i < from->particle_count; i++) {
        const naive_particle *p = &from->particles[r->place[i]];
        r->x[i] = p->x;
        r->y[i] = p->y;
        r->vx[i] = p->vx;
        r->vy[i] = p->vy;
        r->inverse[i] = p->inverse_mass;
    }
}

// Forces of the springs from each particle of a row to the one that lies `further` behind it.
static void pull(size_t count, const float *restrict x, const float *restrict y, const float *restrict vx,
                 const float *restrict vy, size_t further, float stiffness, float damping, float rest,
                 float *restrict px, float *restrict py) {
    for (size_t i = 0; i < count; i++) {
        const float dx = x[i + further] - x[i], dy = y[i + further] - y[i];
        const float inverse = 1 / sqrtf(dx * dx + dy * dy), length = (dx * dx + dy * dy) * inverse;
        const float rate = ((vx[i + further] - vx[i]) * dx + (vy[i + further] - vy[i]) * dy) * inverse;
        const float force = ((length - rest) * stiffness + rate * damping) * inverse;
        px[i] = force * dx;
        py[i] = force * dy;
    }
}

// Add what four rows of springs, to the right, up, up right and up left, are to the particles of a row and those
// above.
static void add(size_t count, const float *restrict right, const float *restrict up, const float *restrict up_right,
                const float *restrict up_left, float *restrict lower, float *restrict upper) {
    for (size_t i = 0; i < count; i++) {
        lower[i] += right[i] - right[i - 1] + up[i] + up_right[i] + up_left[i];
        upper[i] -= up[i] + up_right[i - 1] + up_left[i + 1];
    }
}

static void add_last(size_t count, const float *restrict right, float *restrict row) {
    for (size_t i = 0; i < count; i++)
        row[i] += right[i] - right[i - 1];
}

static void pull_row(const rectangle *r, size_t row) {
    static const int diagonal[4] = {0, 0, 1, 1};
    const size_t w = r->columns, at = row * w, wide = w + 2, further[4] = {1, w, w + 1, w - 1};
    const bool is_last = row + 1 == r->rows;
    float *px = r->px + 1, *py = r->py + 1; // four rows of springs, a place before and behind each
    for (size_t i = 0; i < (is_last ? 1 : 4); i++)
        pull(w, r->x + at, r->y + at, r->vx + at, r->vy + at, further[i], r->stiffness, r->damping,
             r->rest[diagonal[i]], px + i * wide, py + i * wide);
    px[w - 1] = py[w - 1] = px[w - 1 + 2 * wide] = py[w - 1 + 2 * wide] = px[3 * wide] = py[3 * wide] = 0;
    if (is_last) {
        add_last(w, px, r->fx + at);
        add_last(w, py, r->fy + at);
    } else {
        add(w, px, px + wide, px + 2 * wide, px + 3 * wide, r->fx + at, r->fx + at + w);
        add(w, py, py + wide, py + 2 * wide, py + 3 * wide, r->fy + at, r->fy + at + w);
    }
}

// One coordinate of all particles.
static void move(size_t count, float *restrict x, float *restrict v, float *restrict force,
                 const float *restrict inverse, float gravity, float loss, float kick, float h) {
    for (size_t i = 0; i < count; i++) {
        const float is_free = inverse[i] > 0 ? 1.0f : 0.0f;
        v[i] += (force[i] * inverse[i] + is_free * gravity) * kick - loss * v[i];
        x[i] += v[i] * h;
        force[i] = 0;
    }
}

static void step(void *self, const naive_network *from, double dt, uint32_t substeps) {
    rectangle *r = self;
    const size_t w = r->columns;
    const float h = (float)(dt / substeps), rate = from->global_damping;
    for (uint32_t substep = 0; substep < substeps; substep++) {
        for (size_t row = 0; row < r->rows; row++)
            pull_row(r, row);
        const float time = 0.5f * (r->lag + h), loss = -expm1f(-rate * time);
        const float kick = rate > 0.0f ? loss / rate : time;
        r->lag = h;
        move(w * r->rows, r->x, r->vx, r->fx, r->inverse, from->gravity_x, loss, kick, h);
        move(w * r->rows, r->y, r->vy, r->fy, r->inverse, from->gravity_y, loss, kick, h);
    }
}

static void get(const void *self, uint32_t particle, float *x, float *y) {
    const rectangle *r = self;
    *x = r->x[r->at[particle]];
    *y = r->y[r->at[particle]];
}

const bench_loop bench_rectangle = {"rectangle", sizeof(rectangle), begin, reset, step, get, end};
