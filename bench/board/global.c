/// @file global.c
/// Projective dynamics: springs choose their directions one by one, then one linear system, factored at the start.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "board/methods.h"

/// Particles from left to right, so that the matrix is a band, and its factor.
typedef struct band {
    uint32_t *row_of;      ///< [particle_count] row of a particle
    uint32_t *particle_of; ///< [particle_count]
    uint32_t width;        ///< entries left of the diagonal
    double *factor;        ///< [row][width + 1], the last is the diagonal's reciprocal
    double *x, *y;         ///< [row] right hand sides and solutions
} band;

static const model *sorted; // qsort() hands on no context

static int compare_places(const void *one, const void *other) {
    const uint32_t i = *(const uint32_t *)one, j = *(const uint32_t *)other;
    if (sorted->x[i] != sorted->x[j])
        return sorted->x[i] < sorted->x[j] ? -1 : 1;
    return (sorted->y[i] > sorted->y[j]) - (sorted->y[i] < sorted->y[j]);
}

static void band_end(motion *r) {
    band *b = r->own;
    if (b) {
        free(b->row_of);
        free(b->particle_of);
        free(b->factor);
        free(b->x);
        free(b->y);
    }
    free(b);
}

static double *entry(const band *b, uint32_t row, uint32_t column) {
    return &b->factor[(size_t)row * (b->width + 1) + column + b->width - row];
}

static void fill(const motion *r, band *b, double h) {
    const model *m = r->m;
    for (uint32_t i = 0; i < m->particle_count; i++)
        *entry(b, b->row_of[i], b->row_of[i]) = m->inverse_mass[i] > 0 ? 1 / (m->inverse_mass[i] * h * h) : 1;
    for (uint32_t s = 0; s < m->spring_count; s++) {
        const uint32_t ends[2] = {m->a[s], m->b[s]};
        for (int e = 0; e < 2; e++)
            if (m->inverse_mass[ends[e]] > 0)
                *entry(b, b->row_of[ends[e]], b->row_of[ends[e]]) += m->stiffness[s];
        if (m->inverse_mass[ends[0]] > 0 && m->inverse_mass[ends[1]] > 0) {
            const uint32_t i = b->row_of[ends[0]], j = b->row_of[ends[1]];
            *entry(b, i > j ? i : j, i > j ? j : i) -= m->stiffness[s];
        }
    }
}

static void factor(const band *b, uint32_t rows) {
    for (uint32_t row = 0; row < rows; row++) {
        const uint32_t first = row > b->width ? row - b->width : 0;
        double own = *entry(b, row, row);
        for (uint32_t column = first; column < row; column++) {
            const uint32_t from = column > b->width && column - b->width > first ? column - b->width : first;
            double sum = *entry(b, row, column);
            for (uint32_t k = from; k < column; k++)
                sum -= *entry(b, row, k) * *entry(b, column, k);
            *entry(b, row, column) = (sum * *entry(b, column, column));
            own -= *entry(b, row, column) * *entry(b, row, column);
        }
        *entry(b, row, row) = (1 / sqrt(own));
    }
}

static void solve(const band *b, uint32_t rows) {
    for (uint32_t row = 0; row < rows; row++) {
        const uint32_t first = row > b->width ? row - b->width : 0;
        const double *line = entry(b, row, first);
        double x = b->x[row], y = b->y[row];
        for (uint32_t k = first; k < row; k++) {
            x -= line[k - first] * b->x[k];
            y -= line[k - first] * b->y[k];
        }
        b->x[row] = x * line[row - first];
        b->y[row] = y * line[row - first];
    }
    for (uint32_t row = rows; row-- > 0;) {
        const uint32_t first = row > b->width ? row - b->width : 0;
        const double *line = entry(b, row, first);
        const double x = b->x[row] *= line[row - first], y = b->y[row] *= line[row - first];
        for (uint32_t k = first; k < row; k++) {
            b->x[k] -= line[k - first] * x;
            b->y[k] -= line[k - first] * y;
        }
    }
}

static bool projective_begin(motion *r, double dt) {
    const model *m = r->m;
    const uint32_t n = m->particle_count;
    band *b = calloc(1, sizeof *b);
    r->own = b;
    if (!b)
        return false;
    b->row_of = malloc(n * sizeof *b->row_of);
    b->particle_of = malloc(n * sizeof *b->particle_of);
    b->x = malloc(n * sizeof *b->x);
    b->y = malloc(n * sizeof *b->y);
    if (!b->row_of || !b->particle_of || !b->x || !b->y)
        return false;
    for (uint32_t i = 0; i < n; i++)
        b->particle_of[i] = i;
    sorted = m;
    qsort(b->particle_of, n, sizeof *b->particle_of, compare_places);
    for (uint32_t i = 0; i < n; i++)
        b->row_of[b->particle_of[i]] = i;
    for (uint32_t s = 0; s < m->spring_count; s++) {
        const uint32_t i = b->row_of[m->a[s]], j = b->row_of[m->b[s]], apart = i > j ? i - j : j - i;
        b->width = apart > b->width ? apart : b->width;
    }
    b->factor = calloc((size_t)n * (b->width + 1), sizeof *b->factor);
    if (!b->factor)
        return false;
    fill(r, b, dt);
    factor(b, n);
    return true;
}

// Where the springs, each at its length and in its direction, would have the particles.
static void gather(motion *r, const band *b, double h) {
    const model *m = r->m;
    for (uint32_t i = 0; i < m->particle_count; i++) {
        const bool is_free = m->inverse_mass[i] > 0;
        const double weight = is_free ? 1 / (m->inverse_mass[i] * h * h) : 1;
        b->x[b->row_of[i]] = weight * (is_free ? r->goal_x[i] : r->x[i]);
        b->y[b->row_of[i]] = weight * (is_free ? r->goal_y[i] : r->y[i]);
    }
    for (uint32_t s = 0; s < m->spring_count; s++) {
        const uint32_t ends[2] = {m->a[s], m->b[s]};
        const double dx = r->x[ends[1]] - r->x[ends[0]], dy = r->y[ends[1]] - r->y[ends[0]];
        const double k = m->stiffness[s], pull = k * m->rest[s] / sqrt(dx * dx + dy * dy);
        for (int e = 0; e < 2; e++) {
            const uint32_t row = b->row_of[ends[e]], other = ends[1 - e];
            const double sign = e == 0 ? -pull : pull;
            if (!(m->inverse_mass[ends[e]] > 0))
                continue;
            const bool is_held = !(m->inverse_mass[other] > 0);
            b->x[row] += sign * dx + (is_held ? k * r->x[other] : 0);
            b->y[row] += sign * dy + (is_held ? k * r->y[other] : 0);
        }
    }
}

static void projective_frame(motion *r, double dt) {
    const model *m = r->m;
    const band *b = r->own;
    const double h = dt, decay = exp(-r->damping * dt), g = m->gravity;
    for (uint32_t i = 0; i < m->particle_count; i++) {
        r->old_x[i] = r->x[i];
        r->old_y[i] = r->y[i];
        if (!(m->inverse_mass[i] > 0))
            continue;
        r->goal_x[i] = r->x[i] + r->vx[i] * decay * h;
        r->goal_y[i] = r->y[i] + (r->vy[i] * decay - g * h) * h;
        r->x[i] = r->goal_x[i];
        r->y[i] = r->goal_y[i];
    }
    for (uint32_t iteration = 0; iteration < r->effort; iteration++) {
        gather(r, b, h);
        solve(b, m->particle_count);
        for (uint32_t i = 0; i < m->particle_count; i++) {
            r->x[i] = b->x[b->row_of[i]];
            r->y[i] = b->y[b->row_of[i]];
        }
    }
    for (uint32_t i = 0; i < m->particle_count; i++) {
        r->vx[i] = (r->x[i] - r->old_x[i]) / h;
        r->vy[i] = (r->y[i] - r->old_y[i]) / h;
    }
}

// The matrix is another one now.
static bool projective_cut(motion *r, const uint32_t *springs, uint32_t count, double dt) {
    band *b = r->own;
    const uint32_t n = r->m->particle_count;
    (void)springs;
    (void)count;
    memset(b->factor, 0, (size_t)n * (b->width + 1) * sizeof *b->factor);
    fill(r, b, dt);
    factor(b, n);
    return true;
}

const method board_projective = {.name = "projective dynamics",
                                 .effort = "iterations",
                                 .begin = projective_begin,
                                 .frame = projective_frame,
                                 .cut = projective_cut,
                                 .end = band_end,
                                 .efforts = {2, 8, 32, 128, 512},
                                 .colour = 0x2e9e5b};
