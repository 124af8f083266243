/// @file local.c
/// Methods that solve spring by spring or particle by particle.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "board/methods.h"

static void keep(motion *r) {
    memcpy(r->old_x, r->x, r->m->particle_count * sizeof *r->x);
    memcpy(r->old_y, r->y, r->m->particle_count * sizeof *r->y);
}

// Where particles would be without springs.
static void fly(motion *r, double h) {
    const double decay = exp(-r->damping * h), g = r->m->gravity;
    for (uint32_t i = 0; i < r->m->particle_count; i++) {
        if (!(r->m->inverse_mass[i] > 0))
            continue;
        r->vx[i] *= decay;
        r->vy[i] = r->vy[i] * decay - g * h;
        r->x[i] += r->vx[i] * h;
        r->y[i] += r->vy[i] * h;
    }
}

static void derive_velocities(motion *r, double h) {
    for (uint32_t i = 0; i < r->m->particle_count; i++) {
        r->vx[i] = (r->x[i] - r->old_x[i]) / h;
        r->vy[i] = (r->y[i] - r->old_y[i]) / h;
    }
}

/* ---------------------------------------------------------------------------------------------------- naive Euler
 */

// Positions hold what the substep before left; the classic loop over springs.
static void naive_frame(motion *r, double dt) {
    const model *m = r->m;
    const double h = (dt / r->effort), decay = exp(-r->damping * h), g = m->gravity;
    for (uint32_t substep = 0; substep < r->effort; substep++) {
        memset(r->old_x, 0, m->particle_count * sizeof *r->old_x);
        memset(r->old_y, 0, m->particle_count * sizeof *r->old_y);
        for (uint32_t s = 0; s < m->spring_count; s++) {
            const uint32_t a = m->a[s], b = m->b[s];
            const double dx = r->x[b] - r->x[a], dy = r->y[b] - r->y[a], length = sqrt(dx * dx + dy * dy);
            const double force = m->stiffness[s] * (length - m->rest[s]) / length;
            r->old_x[a] += force * dx;
            r->old_y[a] += force * dy;
            r->old_x[b] -= force * dx;
            r->old_y[b] -= force * dy;
        }
        for (uint32_t i = 0; i < m->particle_count; i++) {
            const double w = m->inverse_mass[i];
            r->vx[i] = (r->vx[i] + r->old_x[i] * w * h) * decay;
            r->vy[i] = (r->vy[i] + (r->old_y[i] * w - (w > 0 ? g : 0)) * h) * decay;
            r->x[i] += r->vx[i] * h;
            r->y[i] += r->vy[i] * h;
        }
    }
}

const method board_naive = {.name = "symplectic Euler, plain loop",
                            .effort = "substeps",
                            .frame = naive_frame,
                            .efforts = {1, 2, 4},
                            .by_stability = true,
                            .colour = 0x8b8d98};

/* ------------------------------------------------------------------------------------------------ by projection */

static void project(motion *r, uint32_t s, double compliance) {
    const model *m = r->m;
    const uint32_t a = m->a[s], b = m->b[s];
    const double wa = m->inverse_mass[a], wb = m->inverse_mass[b], w = wa + wb;
    if (!(w > 0) || !(m->stiffness[s] > 0))
        return;
    const double dx = r->x[b] - r->x[a], dy = r->y[b] - r->y[a], length = sqrt(dx * dx + dy * dy);
    const double push = (length - m->rest[s]) / ((w + compliance) * length);
    r->x[a] += wa * push * dx;
    r->y[a] += wa * push * dy;
    r->x[b] -= wb * push * dx;
    r->y[b] -= wb * push * dy;
}

// Springs as constraints without compliance: as stiff as iterations make them.
static void pbd_frame(motion *r, double dt) {
    keep(r);
    fly(r, dt);
    for (uint32_t iteration = 0; iteration < r->effort; iteration++)
        for (uint32_t s = 0; s < r->m->spring_count; s++)
            project(r, s, 0);
    derive_velocities(r, dt);
}

const method board_pbd = {.name = "PBD",
                          .effort = "iterations",
                          .frame = pbd_frame,
                          .efforts = {4, 16, 64, 256, 1024},
                          .colour = 0xb0762e};

// One iteration in each of many substeps: what came of the substep before is all that is known of forces.
static void xpbd_frame(motion *r, double dt) {
    const double h = (dt / r->effort);
    for (uint32_t substep = 0; substep < r->effort; substep++) {
        keep(r);
        fly(r, h);
        for (uint32_t s = 0; s < r->m->spring_count; s++)
            project(r, s, 1 / (r->m->stiffness[s] * h * h));
        derive_velocities(r, h);
    }
}

const method board_xpbd = {.name = "XPBD, small steps",
                           .effort = "substeps",
                           .frame = xpbd_frame,
                           .efforts = {4, 16, 64, 256, 1024},
                           .colour = 0xe07b10};

/* --------------------------------------------------------------------------------------- by particle, in blocks */

typedef struct neighbours {
    uint32_t *first; ///< [particle_count + 1] into springs
    uint32_t *springs;
    double *last_x, *last_y;     ///< [particle_count] before this iteration
    double *before_x, *before_y; ///< before the last one
} neighbours;

static void vbd_end(motion *r) {
    neighbours *own = r->own;
    if (own) {
        free(own->first);
        free(own->springs);
        free(own->last_x);
    }
    free(own);
}

static bool vbd_begin(motion *r, double dt) {
    const model *m = r->m;
    neighbours *own = calloc(1, sizeof *own);
    r->own = own;
    (void)dt;
    if (!own)
        return false;
    own->first = calloc(m->particle_count + 2, sizeof *own->first);
    own->springs = malloc(2 * (size_t)m->spring_count * sizeof *own->springs);
    own->last_x = malloc(4 * (size_t)m->particle_count * sizeof *own->last_x);
    if (!own->first || !own->springs || !own->last_x)
        return false;
    own->last_y = own->last_x + m->particle_count;
    own->before_x = own->last_y + m->particle_count;
    own->before_y = own->before_x + m->particle_count;
    for (uint32_t s = 0; s < m->spring_count; s++) {
        own->first[m->a[s] + 2]++;
        own->first[m->b[s] + 2]++;
    }
    for (uint32_t i = 2; i < m->particle_count + 2; i++)
        own->first[i] += own->first[i - 1];
    for (uint32_t s = 0; s < m->spring_count; s++) {
        own->springs[own->first[m->a[s] + 1]++] = s;
        own->springs[own->first[m->b[s] + 1]++] = s;
    }
    return true;
}

// Newton's step of one particle for implicit Euler, with the others where they are.
static void descend(motion *r, const neighbours *own, uint32_t i, double mass_per_h2) {
    const model *m = r->m;
    double fx = mass_per_h2 * (r->goal_x[i] - r->x[i]), fy = mass_per_h2 * (r->goal_y[i] - r->y[i]);
    double xx = mass_per_h2, yy = mass_per_h2, xy = 0;
    for (uint32_t at = own->first[i]; at < own->first[i + 1]; at++) {
        const uint32_t s = own->springs[at], j = m->a[s] == i ? m->b[s] : m->a[s];
        const double dx = r->x[j] - r->x[i], dy = r->y[j] - r->y[i], length = sqrt(dx * dx + dy * dy);
        const double k = m->stiffness[s], pull = k * (length - m->rest[s]) / length;
        const double across = fmax(0, pull), along = (k - across) / (length * length);
        fx += pull * dx;
        fy += pull * dy;
        xx += across + along * dx * dx;
        yy += across + along * dy * dy;
        xy += along * dx * dy;
    }
    const double determinant = xx * yy - xy * xy;
    r->x[i] += (yy * fx - xy * fy) / determinant;
    r->y[i] += (xx * fy - xy * fx) / determinant;
}

static void vbd_frame(motion *r, double dt) {
    const model *m = r->m;
    const neighbours *own = r->own;
    const double h = dt, radius = 0.95f;
    keep(r);
    fly(r, h);
    memcpy(r->goal_x, r->x, m->particle_count * sizeof *r->x);
    memcpy(r->goal_y, r->y, m->particle_count * sizeof *r->y);
    double omega = 1;
    for (uint32_t iteration = 0; iteration < r->effort; iteration++) {
        omega = iteration == 0 ? 1 : iteration == 1 ? 2 / (2 - radius * radius) : 4 / (4 - radius * radius * omega);
        for (uint32_t i = 0; i < m->particle_count; i++) {
            own->last_x[i] = r->x[i];
            own->last_y[i] = r->y[i];
            if (m->inverse_mass[i] > 0)
                descend(r, own, i, 1 / (m->inverse_mass[i] * h * h));
        }
        for (uint32_t i = 0; i < m->particle_count; i++) {
            if (iteration > 0) {
                r->x[i] = omega * (r->x[i] - own->before_x[i]) + own->before_x[i];
                r->y[i] = omega * (r->y[i] - own->before_y[i]) + own->before_y[i];
            }
            own->before_x[i] = own->last_x[i];
            own->before_y[i] = own->last_y[i];
        }
    }
    derive_velocities(r, h);
}

const method board_vbd = {.name = "VBD, Chebyshev",
                          .effort = "iterations",
                          .begin = vbd_begin,
                          .frame = vbd_frame,
                          .end = vbd_end,
                          .efforts = {4, 16, 64, 256, 1024},
                          .colour = 0xc0392b};
