/// @file silt_kernel.h
/// Braking of a block's particles by silt in a substep, before the floor acts on them. It acts on w, the velocity
/// in step with the positions before the move (see bounce_kernel.h). So it dissipates energy whatever the forces
/// are.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SILT_KERNEL_H
#define MSPRINGI_SILT_KERNEL_H

#include "kernels/floor_kernel.h"

// Find the fraction of each active particle's velocity that silt takes where its depth varies.
static void find_uneven_fractions(const mspringi_floor_args *g, size_t slot, double *restrict fractions) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot;
    const float *restrict heights = g->heights, *restrict depths = g->silt_depths;
    const double left = g->left, spacing = g->spacing, bottom = g->bottom, rate_h = g->silt_rate * g->h;
    const uint32_t count = g->height_count;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double place = ((double)x[i] - left) / spacing;
        const double ground = bottom + mspringi_height_at(heights, count, place);
        const double depth = mspringi_height_at(depths, count, place);
        const double fraction = mspringi_uneven_silt_damping_at((double)y[i] - ground, depth, rate_h);
        fractions[i] = fractions[i] > 0.0 ? fraction : 0.0;
    }
}

// Find the fraction of each velocity that silt takes.
static void find_fractions(const mspringi_floor_args *g, size_t slot, double *restrict fractions) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot, *restrict heights = g->heights;
    const double left = g->left, spacing = g->spacing, bottom = g->bottom;
    const double depth = g->silt_depth, rate_h = g->silt_rate * g->h;
    const uint32_t count = g->height_count;
    find_active(g, slot, MSPRINGI_WIDTH, fractions);
    if (g->silt_depths) {
        find_uneven_fractions(g, slot, fractions);
        return;
    }
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double ground = bottom + mspringi_height_at(heights, count, ((double)x[i] - left) / spacing);
        const double fraction = mspringi_silt_damping_at((double)y[i] - ground, depth, rate_h);
        fractions[i] = fractions[i] > 0.0 ? fraction : 0.0;
    }
}

/// One coordinate, by slot.
typedef struct brake_arrays {
    const float *from;
    float *before, *velocity, *position, *low, *impulse;
} brake_arrays;

// Find the changes of velocity. from may alias velocity.
static void find_changes(const mspringi_floor_args *g, const double *restrict fractions, const brake_arrays *b,
                         float *restrict change) {
    const float *v = b->velocity, *from = b->from;
    const mspringi_damping damping = g->damping;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double velocity = (double)v[i],
                     w = velocity - 0.5 * mspringi_pushed(damping, (double)from[i], velocity);
        const float braked = (float)(velocity - fractions[i] * w) - v[i];
        change[i] = fractions[i] > 0.0 ? braked : 0.0f;
    }
}

// Apply the changes. Positions follow by Kahan's sum, as in sweeps.
static void brake_along(const mspringi_floor_args *g, size_t slot, const double *restrict fractions,
                        const brake_arrays *b) {
    const float *restrict inverse_mass = g->inverse_mass + slot;
    float *restrict v = b->velocity, *restrict at = b->position, *restrict low = b->low,
                    *restrict given = b->impulse;
    float change[MSPRINGI_WIDTH];
    const float grid = g->grid;
    const double h = g->h, per_kept = g->damping.keep > 0.0 ? 1.0 / g->damping.keep : 0.0;
    find_changes(g, fractions, b, change);
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float mass = 1.0f / inverse_mass[i], impulse = given[i] + mass * change[i];
        const float way = (float)(h * (double)change[i]) + low[i], to = mspringi_round_to_grid(grid, at[i] + way),
                    rest = way - (to - at[i]);
        const bool is_braked = change[i] != 0.0f;
        given[i] = is_braked ? impulse : given[i];
        low[i] = is_braked ? rest : low[i];
        at[i] = is_braked ? to : at[i];
        v[i] = is_braked ? v[i] + change[i] : v[i];
    }
    if (!b->before)
        return;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float from = (float)((double)b->before[i] + per_kept * (double)change[i]);
        b->before[i] = change[i] != 0.0f ? from : b->before[i];
    }
}

static void brake(const mspringi_floor_args *g, size_t slot) {
    double fractions[MSPRINGI_WIDTH];
    find_fractions(g, slot, fractions);
    if (!is_any(fractions, MSPRINGI_WIDTH))
        return;
    float *const before_x = g->before_vx ? g->before_vx + slot : NULL;
    float *const before_y = g->before_vy ? g->before_vy + slot : NULL;
    const brake_arrays along = {g->from_vx + slot, before_x,        g->vx + slot,
                                g->x + slot,       g->low_x + slot, g->impulse_x + slot};
    const brake_arrays up = {g->from_vy + slot, before_y,        g->vy + slot,
                             g->y + slot,       g->low_y + slot, g->impulse_y + slot};
    brake_along(g, slot, fractions, &along);
    brake_along(g, slot, fractions, &up);
}

#endif
