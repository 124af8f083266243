/// Impulses between what touches in a piece of a substep, one row after the other. Rows that follow each other
/// mostly share no particle, so a processor takes several at once.
///
/// Sums of impulses are clamped, so a later sweep may take back what an earlier one gave (Catto 2005). Friction
/// acts along the surface at a distance from the edge, so it turns the edge, too: else angular momentum would be
/// lost.
///
/// A heavy body presses a light one against another as hard as it takes, which a few sweeps may not come to. So
/// rows that would get deeper are swept on until none does. Where bodies lie on each other there are none.
///
/// Rows that bounce may give energy together: one throws a point at another, which it was moving away from. Then
/// all of them bounce less.
#include "base/cpu.h"
#include "contact/pairs.h"

/// An overlap of this share of the thickness is given. Beyond it, and in colliders, which do not give way, nothing
/// may get deeper faster than by a share of the thickness in a substep.
#define GIVEN_SHARE 0.05
#define GIVEN_SPEED 1e-3

/// So many sweeps at most, fewer of many rows: each row may be looked at so often in the mean; and of rows of
/// colliders alone, at last.
#define MOST_GIVEN_SWEEPS 256
#define LEAST_GIVEN_SWEEPS 16
#define MOST_LOOKS 16384
#define MOST_COLLIDER_SWEEPS 64

/// Bounces that give energy are that much lower, and the last time there are none. A smaller share of the work is
/// rounding.
#define BOUNCE_SHARE 0.5
#define MOST_BOUNCES 3
#define SEEN_SHARE 1e-9

/// A piece is too long if a row would still end deeper than this share of the thickness.
#define MOST_SHARE 0.1

/* --------------------------------------------------------------------------------------------------- one row */

// Whether a row that gives nothing has nothing to give.
MSPRINGI_ALWAYS_INLINE bool is_idle(const mspringi_touch *t, double speed) {
    return t->across == 0.0 && speed >= t->least;
}

// Give the point an impulse (x, y), and the edge the opposite one, with a couple (by x, y of what it turns by).
MSPRINGI_ALWAYS_INLINE void give(const mspringi_active *k, const mspringi_touch *t, double x, double y,
                                 double turn_x, double turn_y) {
    const double weight_p = k->weight[t->p], weight_a = k->weight[t->a], weight_b = k->weight[t->b];
    k->v[t->p].x += weight_p * x;
    k->v[t->p].y += weight_p * y;
    k->v[t->a].x -= weight_a * (t->share_a * x + turn_x);
    k->v[t->a].y -= weight_a * (t->share_a * y + turn_y);
    k->v[t->b].x -= weight_b * (t->share_b * x - turn_x);
    k->v[t->b].y -= weight_b * (t->share_b * y - turn_y);
}

// Returns the impulse that it gives.
MSPRINGI_ALWAYS_INLINE double push_by(mspringi_touch *t, double speed) {
    const double sum = t->across + (t->target - speed) * t->mass, across = sum > 0.0 ? sum : 0.0;
    const double by = across - t->across;
    t->across = across;
    return by;
}

static void push_apart(const mspringi_active *k, mspringi_touch *t) {
    const double speed = mspringi_speed_across(t, k->v);
    if (is_idle(t, speed))
        return;
    const double by = push_by(t, speed);
    give(k, t, by * t->nx, by * t->ny, 0.0, 0.0);
}

// How fast a point slides along an edge.
static double speed_along(const mspringi_touch *t, const mspringi_velocity *v) {
    const double x = v[t->p].x - t->share_a * v[t->a].x - t->share_b * v[t->b].x;
    const double y = v[t->p].y - t->share_a * v[t->a].y - t->share_b * v[t->b].y;
    return t->nx * y - t->ny * x + (t->turn_y * (v[t->b].x - v[t->a].x) - t->turn_x * (v[t->b].y - v[t->a].y)) +
           t->drag;
}

// Push apart and rub. What the push does to the speed along is known before it is done, so both are given at once.
MSPRINGI_ALWAYS_INLINE void sweep_row(const mspringi_active *k, mspringi_touch *t) {
    const mspringi_velocity p = k->v[t->p], a = k->v[t->a], b = k->v[t->b];
    const double x = p.x - t->share_a * a.x - t->share_b * b.x, y = p.y - t->share_a * a.y - t->share_b * b.y;
    const double speed = t->nx * x + t->ny * y;
    if (is_idle(t, speed))
        return;
    const double by = push_by(t, speed);
    if (t->slide_mass == 0.0) {
        give(k, t, by * t->nx, by * t->ny, 0.0, 0.0);
        return;
    }
    const double most = (double)t->friction * t->across;
    const double turning = t->turn_y * (b.x - a.x) - t->turn_x * (b.y - a.y) + t->drag;
    const double slide = t->nx * y - t->ny * x + turning + by * t->turned, sum = t->along - slide * t->slide_mass;
    const double not_less = sum > -most ? sum : -most, along = not_less < most ? not_less : most;
    const double rub = along - t->along;
    t->along = along;
    give(k, t, by * t->nx - rub * t->ny, by * t->ny + rub * t->nx, rub * t->turn_y, -rub * t->turn_x);
}

/// What rows may still do in a piece when they have been swept.
typedef struct allowance {
    double h, speed; ///< s; m/s that a row may close at where it is too deep
    double deepest;  ///< m
} allowance;

static allowance allow(const mspringi_pairs *pairs, double h, double share) {
    return (allowance){h, GIVEN_SPEED * pairs->thickness / (double)pairs->h, share * pairs->thickness};
}

// Whether a row would end too deep, and deeper than it begins.
MSPRINGI_ALWAYS_INLINE bool gives_way(const mspringi_pairs *pairs, const mspringi_touch *t, const allowance *most) {
    const double speed = mspringi_speed_across(t, pairs->active.v), end = t->gap + most->h * (speed + most->speed);
    return end < (t->gap < 0.0 ? t->gap : 0.0) && end < -most->deepest;
}

// Returns whether any row gave way.
static bool sweep_given(const mspringi_pairs *pairs, double h, bool of_colliders) {
    const allowance of_bodies = allow(pairs, h, GIVEN_SHARE), of_others = allow(pairs, h, 0.0);
    bool any = false;
    for (uint32_t i = 0; i < pairs->touch_count; ++i) {
        mspringi_touch *t = &pairs->touches[i];
        const bool is_of_collider = t->collider != MSPRING_NONE;
        if ((of_colliders && !is_of_collider) || !gives_way(pairs, t, is_of_collider ? &of_others : &of_bodies))
            continue;
        push_apart(&pairs->active, t);
        any = true;
    }
    return any;
}

// Sweep what gives way until nothing does. False: it takes too long.
static bool press(const mspringi_pairs *pairs, double h) {
    const uint32_t by_looks = LEAST_GIVEN_SWEEPS + MOST_LOOKS / (pairs->touch_count + 1);
    const uint32_t most = by_looks < MOST_GIVEN_SWEEPS ? by_looks : MOST_GIVEN_SWEEPS;
    for (uint32_t n = 0; n < most; ++n) {
        if (!sweep_given(pairs, h, false))
            return true;
        mspringi_bearing_sweep(pairs);
    }
    for (uint32_t n = 0; n < MOST_COLLIDER_SWEEPS && sweep_given(pairs, h, true); ++n)
        mspringi_bearing_sweep(pairs);
    return false;
}

static void sweep_all(const mspringi_pairs *pairs, uint32_t sweeps) {
    const mspringi_active k = pairs->active;
    for (uint32_t n = 0; n < sweeps; ++n) {
        for (uint32_t i = 0; i < pairs->touch_count; ++i)
            sweep_row(&k, &pairs->touches[i]);
        mspringi_bearing_sweep(pairs);
    }
}

// Whether rows, some of which bounce, have given energy: twice the work of their impulses is by the sum of the
// speeds before the substep's forces and now. What is pushed out of an overlap may be given some.
static bool give_energy(const mspringi_pairs *pairs) {
    const mspringi_active *k = &pairs->active;
    double work = 0.0, size = 0.0;
    bool any = false;
    for (uint32_t i = 0; i < pairs->touch_count && !any; ++i)
        any = pairs->touches[i].bounces && pairs->touches[i].across > 0.0;
    for (uint32_t i = 0; i < pairs->touch_count && any; ++i) {
        const mspringi_touch *t = &pairs->touches[i];
        if ((t->across == 0.0 && t->along == 0.0) || (t->target > 0.0 && !t->bounces))
            continue;
        work += t->across * (mspringi_speed_across(t, k->from) + mspringi_speed_across(t, k->v));
        work += t->along * (speed_along(t, k->from) + speed_along(t, k->v));
        size += t->across * t->across / t->mass;
    }
    return work > SEEN_SHARE * size;
}

static void bounce_less(const mspringi_pairs *pairs, double share) {
    for (uint32_t i = 0; i < pairs->touch_count; ++i)
        pairs->touches[i].target *= pairs->touches[i].bounces ? share : 1.0;
}

bool mspringi_rows_sweep(const mspringi_pairs *pairs, double h, uint32_t sweeps) {
    sweep_all(pairs, sweeps);
    for (uint32_t n = 1; n <= MOST_BOUNCES && give_energy(pairs); ++n) {
        bounce_less(pairs, n < MOST_BOUNCES ? BOUNCE_SHARE : 0.0);
        sweep_all(pairs, sweeps);
    }
    if (press(pairs, h))
        return true;
    const allowance most = allow(pairs, h, MOST_SHARE);
    for (uint32_t i = 0; i < pairs->touch_count; ++i)
        if (gives_way(pairs, &pairs->touches[i], &most))
            return false;
    return true;
}
