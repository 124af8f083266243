/// What happens to points and edges that touch in a substep: impulses, one pair after the other, in the order of
/// ids.
///
/// A row is a point and the nearest place on an edge. The gap at the end of the substep, gap + h v, is not to be
/// negative; what overlaps already is pushed apart slowly, by a velocity. Sums of impulses are clamped, so a later
/// sweep may take back what an earlier one gave (Catto 2005). Friction acts along the surface at a distance from
/// the edge, so it turns the edge, too: else angular momentum would be lost.
///
/// An impulse J changes the energy by J times the mean of the speeds before the substep's forces and after contact.
/// So restitution is of the speed before the forces: with the one after them contact would make energy.
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "contact/pairs.h"
#include "store/network.h"

/// Part of an overlap that is pushed apart in a substep, if that is not faster than the host allows.
#define PUSHED_SHARE 0.2

/// Nothing bounces more slowly, m/s.
#define SLOWEST_BOUNCE 0.2

/// A substep is cut into pieces in which nothing moves further than the thickness; into so many at most.
#define MOST_PIECES 64

/// Where a collider presses, what gets deeper by this share of the thickness in a piece is swept again, so often at
/// most: all of it, and then what gets into colliders.
#define GIVEN_SHARE 1e-3
#define MOST_PRESSING_SWEEPS 256
#define MOST_COLLIDER_SWEEPS 64

/// Edges at a corner that are remembered by bits, at each end.
#define REMEMBERED 8

/* ------------------------------------------------------------------------------------------------------- nodes */

// A point of a collider is where it will be whatever touches it.
static void note_point(const mspringi_pairs *pairs, uint32_t i) {
    const mspringi_active *k = &pairs->active;
    const uint32_t point = k->particles[i] - pairs->particles;
    k->x[i] = pairs->colliders.x[point];
    k->y[i] = pairs->colliders.y[point];
    k->vx[i] = k->from_vx[i] = pairs->colliders.vx[point];
    k->vy[i] = k->from_vy[i] = pairs->colliders.vy[point];
    k->weight[i] = 0.0;
}

void mspringi_rows_note(const mspring_network *network, mspringi_pairs *pairs) {
    const mspringi_active *k = &pairs->active;
    const mspringi_state *s = &network->state;
    const float *free_mass = mspringi_free_mass(network);
    for (uint32_t i = 0; i < k->own; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        k->x[i] = mspringi_x_of(s, slot);
        k->y[i] = mspringi_y_of(s, slot);
        k->from_vx[i] = (double)s->vx[slot];
        k->from_vy[i] = (double)s->vy[slot];
        k->weight[i] = (double)free_mass[slot];
    }
    for (uint32_t i = k->own; i < k->count; ++i)
        note_point(pairs, i);
}

static void begin(const mspring_network *network, const mspringi_active *k) {
    for (uint32_t i = 0; i < k->own; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        k->vx[i] = (double)network->state.vx[slot];
        k->vy[i] = (double)network->state.vy[slot];
        k->way_x[i] = k->way_y[i] = 0.0;
    }
}

/* --------------------------------------------------------------------------------------------------------- rows */

// Whether a point never touches an edge beside the pair's: number of the edges at an end.
static bool is_apart(const mspring_network *network, mspringi_pairs *pairs, mspringi_pair *pair, uint32_t end,
                     uint32_t number, mspring_id other) {
    const uint32_t bit = 1u << (end * REMEMBERED + number);
    if (!pairs->touches_itself || mspringi_is_of_collider(pairs, pair->point) ||
        mspringi_is_of_collider(pairs, other))
        return false;
    if (number < REMEMBERED && pair->is_asked & bit)
        return pair->is_apart & bit;
    const bool apart = mspringi_outline_is_joined(network, pair->point, other);
    if (number < REMEMBERED) {
        pair->is_asked |= (uint16_t)bit;
        pair->is_apart |= (uint16_t)(apart ? bit : 0);
    }
    return apart;
}

// Whether a point that is nearest to a corner of its edge is another edge's: of one that lies nearer, or of the
// first.
static bool is_of_another(const mspring_network *network, mspringi_pairs *pairs, mspringi_pair *pair,
                          uint32_t end) {
    const mspringi_outline *o = &pairs->outline;
    const mspringi_active *k = &pairs->active;
    const mspring_id corner = end == 0 ? o->a[pair->edge] : o->b[pair->edge];
    const uint32_t at = k->number[corner], p = k->number[pair->point];
    const double dx = k->x[p] - k->x[at], dy = k->y[p] - k->y[at];
    for (uint32_t j = o->first[corner]; j < o->first[corner + 1]; ++j) {
        const uint32_t edge = o->at[j];
        if (edge == pair->edge)
            continue;
        const mspring_id other = o->a[edge] == corner ? o->b[edge] : o->a[edge];
        const uint32_t beyond = k->number[other];
        const bool is_nearer = dx * (k->x[beyond] - k->x[at]) + dy * (k->y[beyond] - k->y[at]) > 0.0;
        if ((is_nearer || edge < pair->edge) && other != pair->point &&
            !is_apart(network, pairs, pair, end, j - o->first[corner], other))
            return true;
    }
    return false;
}

// Friction on the ends of the edge, by a unit along (-ny, nx) on the point, and the couple that it needs.
static void add_friction(const mspringi_pairs *pairs, mspringi_touch *t) {
    const mspringi_active *k = &pairs->active;
    double ex = k->x[t->b] - k->x[t->a], ey = k->y[t->b] - k->y[t->a], turn = 0.0;
    const double length = sqrt(ex * ex + ey * ey), tx = -t->ny, ty = t->nx;
    if (length == 0.0 && t->collider == MSPRING_NONE)
        return;
    if (length > 0.0) {
        ex /= length, ey /= length;
        turn =
            (t->collider == MSPRING_NONE ? t->distance : t->distance - mspringi_collider_grip(pairs, t)) / length;
    }
    t->ax = -t->share_a * tx - turn * ey;
    t->ay = -t->share_a * ty + turn * ex;
    t->bx = -t->share_b * tx + turn * ey;
    t->by = -t->share_b * ty - turn * ex;
    t->slide_mass = 1.0 / (k->weight[t->p] + k->weight[t->a] * (t->ax * t->ax + t->ay * t->ay) +
                           k->weight[t->b] * (t->bx * t->bx + t->by * t->by));
}

static double speed_across(const mspringi_touch *t, const double *vx, const double *vy) {
    return t->nx * (vx[t->p] - t->share_a * vx[t->a] - t->share_b * vx[t->b]) +
           t->ny * (vy[t->p] - t->share_a * vy[t->a] - t->share_b * vy[t->b]);
}

// The speed across that a row is to have at least, when it touches.
static double wanted(const mspringi_pairs *pairs, const mspringi_touch *t, double restitution, double h) {
    double speed = -t->gap / h;
    if (t->gap <= 0.0) {
        speed *= PUSHED_SHARE;
        speed = speed < pairs->push ? speed : pairs->push;
    }
    const double before = speed_across(t, pairs->active.from_vx, pairs->active.from_vy);
    const double bounce = before < -SLOWEST_BOUNCE ? -restitution * before : speed;
    return bounce > speed ? bounce : speed;
}

static double square_of_speed(const mspringi_active *k, uint32_t p, uint32_t q) {
    const double x = k->vx[p] - k->vx[q], y = k->vy[p] - k->vy[q];
    return x * x + y * y;
}

// The collider that one of a pair is of; NULL if neither is.
static const mspringi_collider *collider_of_pair(const mspringi_pairs *pairs, const mspringi_pair *pair) {
    const mspring_id a = pairs->outline.a[pair->edge];
    return mspringi_is_of_collider(pairs, pair->point) ? mspringi_collider_of(pairs, pair->point)
           : mspringi_is_of_collider(pairs, a)         ? mspringi_collider_of(pairs, a)
                                                       : NULL;
}

// The resistance of a row of a point and its nearest place on an edge, 1/kg.
static double resistance_of(const mspringi_active *k, const mspringi_touch *t) {
    return k->weight[t->p] +
           (t->a == t->b ? k->weight[t->a]
                         : t->share_a * t->share_a * k->weight[t->a] + t->share_b * t->share_b * k->weight[t->b]);
}

// The row of a pair in a piece of h seconds, if it may touch there by its own speed; or, if that is too slow for
// it, by one that other rows may give to it.
static void make_row(const mspring_network *network, mspringi_pairs *pairs, mspringi_pair *pair, double h,
                     double given, double *fastest) {
    const mspringi_outline *o = &pairs->outline;
    const mspringi_active *k = &pairs->active;
    const uint32_t p = k->number[pair->point], a = k->number[o->a[pair->edge]], b = k->number[o->b[pair->edge]];
    const mspringi_nearest at = mspringi_nearest_on(k->x[p], k->y[p], k->x[a], k->y[a], k->x[b], k->y[b]);
    const double square = at.x * at.x + at.y * at.y, of_a = square_of_speed(k, p, a),
                 of_b = square_of_speed(k, p, b), speed = sqrt(of_a > of_b ? of_a : of_b);
    const mspringi_collider *c = pairs->colliders.count > 0 ? collider_of_pair(pairs, pair) : NULL;
    const double thickness = c ? pairs->thickness + c->radius : pairs->thickness;
    const double own = thickness + 2.0 * h * speed, reach = given > 0.0 ? thickness + 2.0 * h * given : own;
    if (!(square < reach * reach) || square == 0.0 || (given > 0.0 && square < own * own))
        return;
    if (a != b && (at.share <= 0.0 || at.share >= 1.0) &&
        is_of_another(network, pairs, pair, at.share <= 0.0 ? 0 : 1))
        return;
    mspringi_touch *t = &pairs->touches[pairs->touch_count];
    const double distance = sqrt(square);
    *t = (mspringi_touch){.p = p,
                          .a = a,
                          .b = b,
                          .nx = at.x / distance,
                          .ny = at.y / distance,
                          .share_a = 1.0 - at.share,
                          .share_b = at.share,
                          .gap = distance - thickness,
                          .distance = distance,
                          .collider = c ? (uint32_t)(c - pairs->colliders.list) : MSPRING_NONE};
    const double resistance = resistance_of(k, t);
    if (!(resistance > 0.0))
        return;
    t->mass = 1.0 / resistance;
    t->target = wanted(pairs, t, c ? c->restitution : pairs->restitution, h);
    if ((c ? c->friction : pairs->friction) > 0.0)
        add_friction(pairs, t);
    *fastest = speed > *fastest ? speed : *fastest;
    ++pairs->touch_count;
}

// What another body may throw at a collider, which does not give way.
static void make_more_rows(const mspring_network *network, mspringi_pairs *pairs, double h, double fastest) {
    double slower = 0.0;
    for (uint32_t i = 0; i < pairs->hot_count; ++i) {
        mspringi_pair *pair = &pairs->list[pairs->hot[i]];
        if (mspringi_is_of_collider(pairs, pair->point) ||
            mspringi_is_of_collider(pairs, pairs->outline.a[pair->edge]))
            make_row(network, pairs, pair, h, fastest, &slower);
    }
}

static double make_rows(const mspring_network *network, mspringi_pairs *pairs, double h) {
    double fastest = 0.0;
    pairs->touch_count = 0;
    for (uint32_t i = 0; i < pairs->hot_count; ++i)
        make_row(network, pairs, &pairs->list[pairs->hot[i]], h, 0.0, &fastest);
    if (pairs->colliders.count > 0 && fastest > 0.0)
        make_more_rows(network, pairs, h, fastest);
    return fastest;
}

/* ----------------------------------------------------------------------------------------------------- impulses */

MSPRINGI_ALWAYS_INLINE void push_apart(const mspringi_active *k, mspringi_touch *t, double h) {
    const double speed = speed_across(t, k->vx, k->vy);
    if (t->across == 0.0 && t->gap > 0.0 && t->gap + h * speed >= 0.0)
        return;
    const double sum = t->across + (t->target - speed) * t->mass, across = sum > 0.0 ? sum : 0.0;
    const double x = (across - t->across) * t->nx, y = (across - t->across) * t->ny;
    t->across = across;
    k->vx[t->p] += k->weight[t->p] * x;
    k->vy[t->p] += k->weight[t->p] * y;
    k->vx[t->a] -= t->share_a * k->weight[t->a] * x;
    k->vy[t->a] -= t->share_a * k->weight[t->a] * y;
    k->vx[t->b] -= t->share_b * k->weight[t->b] * x;
    k->vy[t->b] -= t->share_b * k->weight[t->b] * y;
}

MSPRINGI_ALWAYS_INLINE void rub(const mspringi_pairs *pairs, mspringi_touch *t) {
    const mspringi_active *k = &pairs->active;
    if (t->slide_mass == 0.0 || (t->across == 0.0 && t->along == 0.0))
        return;
    const double tx = -t->ny, ty = t->nx;
    double speed = k->vx[t->p] * tx + k->vy[t->p] * ty + k->vx[t->a] * t->ax + k->vy[t->a] * t->ay +
                   k->vx[t->b] * t->bx + k->vy[t->b] * t->by,
           friction = pairs->friction;
    if (t->collider != MSPRING_NONE) {
        speed += mspringi_collider_drag(pairs, t);
        friction = pairs->colliders.list[t->collider].friction;
    }
    const double most = friction * t->across, sum = t->along - speed * t->slide_mass;
    const double along = sum > most ? most : sum < -most ? -most : sum, by = along - t->along;
    t->along = along;
    k->vx[t->p] += k->weight[t->p] * by * tx;
    k->vy[t->p] += k->weight[t->p] * by * ty;
    k->vx[t->a] += k->weight[t->a] * by * t->ax;
    k->vy[t->a] += k->weight[t->a] * by * t->ay;
    k->vx[t->b] += k->weight[t->b] * by * t->bx;
    k->vy[t->b] += k->weight[t->b] * by * t->by;
}

// Whether a row would end deeper than it begins by more than rounding.
static bool gives_way(const mspringi_pairs *pairs, const mspringi_touch *t, double h) {
    const double speed = speed_across(t, pairs->active.vx, pairs->active.vy);
    const double end = t->gap + h * speed, begin = t->gap < 0.0 ? t->gap : 0.0;
    return end < begin - GIVEN_SHARE * pairs->thickness;
}

/// Rows of a sweep.
typedef enum swept { SWEPT_ALL, SWEPT_GIVEN, SWEPT_GIVEN_OF_COLLIDERS } swept;

// Returns whether there were any.
MSPRINGI_ALWAYS_INLINE bool sweep_rows(const mspringi_pairs *pairs, double h, swept rows) {
    bool any = false;
    for (uint32_t i = 0; i < pairs->touch_count; ++i) {
        mspringi_touch *t = &pairs->touches[i];
        if (rows != SWEPT_ALL &&
            ((rows == SWEPT_GIVEN_OF_COLLIDERS && t->collider == MSPRING_NONE) || !gives_way(pairs, t, h)))
            continue;
        push_apart(&pairs->active, t, h);
        if (rows == SWEPT_ALL)
            rub(pairs, t);
        any = true;
    }
    return any;
}

// A collider presses a light body against a heavy one as hard as it takes, which the sweeps may not have come to.
// At last nothing goes into the collider.
static void press(const mspringi_pairs *pairs, double h) {
    bool is_touched = false;
    for (uint32_t i = 0; i < pairs->touch_count && pairs->colliders.count > 0; ++i)
        is_touched |= pairs->touches[i].collider != MSPRING_NONE && pairs->touches[i].across > 0.0;
    if (!is_touched)
        return;
    for (uint32_t n = 0; n < MOST_PRESSING_SWEEPS && sweep_rows(pairs, h, SWEPT_GIVEN); ++n) {
    }
    for (uint32_t n = 0; n < MOST_COLLIDER_SWEEPS && sweep_rows(pairs, h, SWEPT_GIVEN_OF_COLLIDERS); ++n) {
    }
}

static void solve(const mspringi_pairs *pairs, double h) {
    for (uint32_t sweep = 0; sweep < pairs->def.sweeps; ++sweep)
        (void)sweep_rows(pairs, h, SWEPT_ALL);
    press(pairs, h);
}

/* --------------------------------------------------------------------------------------------- the substep */

static void count_touching(mspringi_pairs *pairs) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < pairs->touch_count; ++i) {
        const mspringi_touch *t = &pairs->touches[i];
        if (t->collider != MSPRING_NONE)
            mspringi_colliders_push(pairs, t);
        count += t->across > 0.0;
        pairs->deepest = -t->gap > pairs->deepest ? -t->gap : pairs->deepest;
    }
    pairs->touching = count > pairs->touching ? count : pairs->touching;
}

// Go along for a piece of h seconds. What contact adds to the move is counted apart.
static void advance(const mspring_network *network, const mspringi_active *k, double h, bool is_last) {
    for (uint32_t i = 0; i < k->own; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        k->way_x[i] += h * (k->vx[i] - (double)network->state.vx[slot]);
        k->way_y[i] += h * (k->vy[i] - (double)network->state.vy[slot]);
    }
    for (uint32_t i = 0; i < k->count && !is_last; ++i) {
        k->x[i] += h * k->vx[i];
        k->y[i] += h * k->vy[i];
    }
}

static void put_back(const mspring_network *network, const mspringi_active *k) {
    const mspringi_state *s = &network->state;
    for (uint32_t i = 0; i < k->own; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        if (k->way_x[i] == 0.0 && k->way_y[i] == 0.0 && k->vx[i] == (double)s->vx[slot] &&
            k->vy[i] == (double)s->vy[slot])
            continue;
        s->vx[slot] = (float)k->vx[i];
        s->vy[slot] = (float)k->vy[i];
        mspringi_move_by(s, slot, (float)k->way_x[i], (float)k->way_y[i]);
    }
}

bool mspringi_rows_act(const mspring_network *network, mspringi_pairs *pairs) {
    const double h = (double)pairs->h;
    begin(network, &pairs->active);
    const double fastest = make_rows(network, pairs, h);
    if (pairs->touch_count == 0)
        return false;
    const double thicknesses = h * fastest / pairs->thickness;
    const uint32_t pieces = thicknesses < MOST_PIECES ? (uint32_t)thicknesses + 1 : MOST_PIECES;
    for (uint32_t piece = 0; piece < pieces; ++piece) {
        if (pieces > 1)
            (void)make_rows(network, pairs, h / pieces);
        solve(pairs, h / pieces);
        count_touching(pairs);
        advance(network, &pairs->active, h / pieces, piece + 1 == pieces);
    }
    put_back(network, &pairs->active);
    return true;
}
