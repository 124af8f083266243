/// @file state.h
/// The state of particles by slot.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STATE_H
#define MSPRINGI_STATE_H

#include "kernels/kernels.h"

/// State that a step changes. One allocation, so that one copy saves it. Positions are x + low_x and y + low_y: a
/// short substep moves a particle by less than a float's last place.
typedef struct mspringi_state {
    float *x, *y, *vx, *vy;
    float *low_x, *low_y;   ///< m, beyond single precision
    float *low_vx, *low_vy; ///< m/s, of precise networks; else NULL
    float grid;             ///< m, to which the first words of coordinates are rounded in precise networks; else 0
} mspringi_state;

/// Local coordinates in full.
static inline double mspringi_x_of(const mspringi_state *s, size_t slot) {
    return (double)s->x[slot] + (double)mspringi_low_of(s->x[slot], s->low_x[slot], s->grid);
}

static inline double mspringi_y_of(const mspringi_state *s, size_t slot) {
    return (double)s->y[slot] + (double)mspringi_low_of(s->y[slot], s->low_y[slot], s->grid);
}

/// Number that rounds a coordinate to the grid when it is added and subtracted; 0 without a grid.
static inline float mspringi_rounding(const mspringi_state *s) {
    return s->grid * 0x1.8p23f;
}

/// A first word on the grid, if there is one.
static inline float mspringi_on_grid(const mspringi_state *s, float coordinate) {
    const float round = mspringi_rounding(s);
    return round > 0.0f ? (coordinate + round) - round : coordinate;
}

/// Set local coordinates.
static inline void mspringi_set_x(const mspringi_state *s, size_t slot, double x) {
    s->x[slot] = mspringi_on_grid(s, (float)x);
    s->low_x[slot] = mspringi_low_of(s->x[slot], (float)(x - (double)s->x[slot]), s->grid);
}

static inline void mspringi_set_y(const mspringi_state *s, size_t slot, double y) {
    s->y[slot] = mspringi_on_grid(s, (float)y);
    s->low_y[slot] = mspringi_low_of(s->y[slot], (float)(y - (double)s->y[slot]), s->grid);
}

/// Add to local coordinates in single precision: Kahan's sum, as the kernels have it.
static inline void mspringi_move_by(const mspringi_state *s, size_t slot, float dx, float dy) {
    const float way_x = dx + s->low_x[slot], way_y = dy + s->low_y[slot];
    const float x = mspringi_on_grid(s, s->x[slot] + way_x), y = mspringi_on_grid(s, s->y[slot] + way_y);
    s->low_x[slot] = way_x - (x - s->x[slot]);
    s->low_y[slot] = way_y - (y - s->y[slot]);
    s->x[slot] = x;
    s->y[slot] = y;
}

/// Set a velocity.
static inline void mspringi_set_velocity(const mspringi_state *s, size_t slot, float vx, float vy) {
    s->vx[slot] = vx;
    s->vy[slot] = vy;
    if (s->low_vx)
        s->low_vx[slot] = s->low_vy[slot] = 0.0f;
}

/// A velocity in full.
static inline double mspringi_vx_of(const mspringi_state *s, size_t slot) {
    return (double)s->vx[slot] + (s->low_vx ? (double)mspringi_low_of(s->vx[slot], s->low_vx[slot], 0.0f) : 0.0);
}

static inline double mspringi_vy_of(const mspringi_state *s, size_t slot) {
    return (double)s->vy[slot] + (s->low_vy ? (double)mspringi_low_of(s->vy[slot], s->low_vy[slot], 0.0f) : 0.0);
}

/// Set a velocity and its low word, if it has one.
static inline void mspringi_set_velocity_in_full(const mspringi_state *s, size_t slot, double vx, double vy) {
    s->vx[slot] = (float)vx;
    s->vy[slot] = (float)vy;
    if (s->low_vx) {
        s->low_vx[slot] = (float)(vx - (double)s->vx[slot]);
        s->low_vy[slot] = (float)(vy - (double)s->vy[slot]);
    }
}

/// Add to a velocity, with a compensated sum if it has a low word.
static inline void mspringi_push_by(const mspringi_state *s, size_t slot, float dvx, float dvy) {
    const float by_x = s->low_vx ? dvx + s->low_vx[slot] : dvx, by_y = s->low_vy ? dvy + s->low_vy[slot] : dvy;
    const float vx = s->vx[slot] + by_x, vy = s->vy[slot] + by_y;
    if (s->low_vx) {
        s->low_vx[slot] = by_x - (vx - s->vx[slot]);
        s->low_vy[slot] = by_y - (vy - s->vy[slot]);
    }
    s->vx[slot] = vx;
    s->vy[slot] = vy;
}

#endif
