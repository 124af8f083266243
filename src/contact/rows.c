/// Which points and edges touch in a substep, each with a row for its impulse. Their order follows from ids and
/// from which pairs there are.
///
/// A row is a point and the nearest place on an edge. The gap at the end of the substep, gap + h v, is not to be
/// negative; what overlaps already is pushed apart slowly, by a velocity. A pair has a row if it may touch by the
/// velocities that it has, or by those that the sweeps give it: what a third body throws at another is looked at
/// again.
///
/// An impulse J changes the energy by J times the mean of the speeds before the substep's forces and after contact.
/// So restitution is of the speed before the forces: with the one after them contact would make energy.
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "contact/pairs.h"
#include "store/network.h"

/// Part of an overlap that is pushed apart in a substep, if that is not faster than the host allows. (Pieces of an
/// implicit one push as fast. When each pushed by this part, what was taken in 32 pieces was pushed 32 times as
/// fast: a stiff body in a pinch had 1.9 times its energy in a step.)
#define PUSHED_SHARE 0.2

/// Nothing bounces more slowly, m/s.
#define SLOWEST_BOUNCE 0.2

/// Further than this many thicknesses nothing may move in a piece as the sweeps have left it.
#define FURTHEST 1.25

/// Half of how much nearer an implicit substep may bring two bodies than their speeds do, as a share of the
/// thickness.
#define THROWN_SHARE 0.1

/// Candidates are sieved so many at a time, and at rest within this share of the thickness beyond the border.
#define SIEVED 256u
#define SIEVED_SHARE 0.05

/// Edges at a corner that are remembered by bits, at each end.
#define REMEMBERED 8

/* ------------------------------------------------------------------------------------------------------- nodes */

// A point of a collider is where it will be whatever touches it.
static void note_point(const mspringi_pairs *pairs, uint32_t i) {
    const mspringi_active *k = &pairs->active;
    const uint32_t point = k->particles[i] - pairs->particles;
    k->x[i] = pairs->colliders.x[point];
    k->y[i] = pairs->colliders.y[point];
    k->v[i].x = k->from[i].x = pairs->colliders.vx[point];
    k->v[i].y = k->from[i].y = pairs->colliders.vy[point];
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
        k->from[i].x = (double)s->vx[slot];
        k->from[i].y = (double)s->vy[slot];
        k->weight[i] = (double)free_mass[slot];
    }
    for (uint32_t i = k->own; i < k->count; ++i)
        note_point(pairs, i);
}

void mspringi_rows_begin(const mspring_network *network, mspringi_pairs *pairs) {
    const mspringi_active *k = &pairs->active;
    mspringi_rows_note(network, pairs);
    for (uint32_t i = 0; i < k->own; ++i)
        k->way_x[i] = k->way_y[i] = k->gain_x[i] = k->gain_y[i] = 0.0;
    pairs->passed = 0.0;
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
    const double ex = k->x[t->b] - k->x[t->a], ey = k->y[t->b] - k->y[t->a], square = ex * ex + ey * ey;
    if (square == 0.0 && t->collider == MSPRING_NONE)
        return;
    if (square > 0.0) {
        const double arm =
            t->collider == MSPRING_NONE ? t->distance : t->distance - mspringi_collider_grip(pairs, t);
        const double turn = arm / square;
        t->turn_x = turn * ex;
        t->turn_y = turn * ey;
    }
    const double weight_a = k->weight[t->a], weight_b = k->weight[t->b];
    const double ax = t->share_a * t->ny - t->turn_y, ay = t->share_a * t->nx - t->turn_x;
    const double bx = t->share_b * t->ny + t->turn_y, by = t->share_b * t->nx + t->turn_x;
    t->turned = (weight_a * t->share_a - weight_b * t->share_b) * (t->turn_y * t->nx - t->turn_x * t->ny);
    t->slide_mass = 1.0 / (k->weight[t->p] + weight_a * (ax * ax + ay * ay) + weight_b * (bx * bx + by * by));
    if (t->collider != MSPRING_NONE)
        t->drag = mspringi_collider_drag(pairs, t);
}

// What gravity does to the speed across in an implicit substep: free flight ends slower than it bounces, or it
// would end higher than it began.
static double fall_across(const mspringi_pairs *pairs, const mspringi_touch *t) {
    const double *weight = pairs->active.weight;
    const double share = (weight[t->p] > 0.0 ? 1.0 : 0.0) - (weight[t->a] > 0.0 ? t->share_a : 0.0) -
                         (weight[t->b] > 0.0 ? t->share_b : 0.0);
    return share * (t->nx * pairs->fall_x + t->ny * pairs->fall_y);
}

// Say which speed across a row is to have at least, when it touches.
static void aim(const mspringi_pairs *pairs, mspringi_touch *t, double restitution, double h) {
    t->target = -t->gap / h;
    t->least = t->target;
    t->bounces = false;
    if (t->gap <= 0.0) {
        t->least = DBL_MAX;
        t->target *= PUSHED_SHARE * pairs->share;
        t->target = t->target < pairs->push ? t->target : pairs->push;
    }
    const double before = mspringi_speed_across(t, pairs->active.from);
    if (!(before < -SLOWEST_BOUNCE))
        return;
    const double back = -restitution * before, fall = fall_across(pairs, t);
    const double bounce = fall < 0.0 ? (back + fall > 0.0 ? back + fall : 0.0) : back;
    t->bounces = bounce > t->target && bounce > 0.0;
    t->target = bounce > t->target ? bounce : t->target;
}

static double square_of_speed(const mspringi_active *k, uint32_t p, uint32_t q) {
    const double x = k->v[p].x - k->v[q].x, y = k->v[p].y - k->v[q].y;
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
static double resistance_of(const mspringi_active *k, const mspringi_candidate *c, double share) {
    const double of_a = 1.0 - share;
    return k->weight[c->p] + of_a * of_a * k->weight[c->a] + share * share * k->weight[c->b];
}

// The larger one of those towards the ends of an edge.
static double square_to_ends(const mspringi_active *k, uint32_t p, uint32_t a, uint32_t b) {
    const double of_a = square_of_speed(k, p, a), of_b = square_of_speed(k, p, b);
    return of_a > of_b ? of_a : of_b;
}

static mspringi_rough rough_of(const mspringi_pairs *pairs, const mspringi_pair *pair,
                               const mspringi_collider *collider) {
    if (pairs->rough)
        return mspringi_rough_between(pairs, pair, collider);
    return collider ? (mspringi_rough){collider->def.friction, collider->def.restitution}
                    : (mspringi_rough){pairs->def.friction, pairs->def.restitution};
}

// The row of a draft in a piece of h seconds.
static void make_row(const mspringi_pairs *pairs, const mspringi_draft *draft, mspringi_touch *t, double h) {
    const mspringi_candidate *c = &pairs->hot[draft->candidate];
    const mspringi_pair *pair = &pairs->list[c->pair];
    const mspringi_collider *collider = pairs->colliders.count > 0 ? collider_of_pair(pairs, pair) : NULL;
    const mspringi_rough rough = rough_of(pairs, pair, collider);
    t->p = c->p;
    t->a = c->a;
    t->b = c->b;
    t->candidate = draft->candidate;
    t->collider = collider ? (uint32_t)(collider - pairs->colliders.list) : MSPRING_NONE;
    t->distance = sqrt(draft->at.x * draft->at.x + draft->at.y * draft->at.y);
    t->gap = t->distance - (collider ? pairs->thickness + collider->radius : pairs->thickness);
    const double per_distance = 1.0 / t->distance;
    t->nx = draft->at.x * per_distance;
    t->ny = draft->at.y * per_distance;
    t->share_a = 1.0 - draft->at.share;
    t->share_b = draft->at.share;
    t->mass = 1.0 / draft->resistance;
    t->friction = rough.friction;
    t->turn_x = t->turn_y = t->turned = t->slide_mass = t->drag = t->across = t->along = 0.0;
    aim(pairs, t, (double)rough.restitution, h);
    if (rough.friction > 0.0f)
        add_friction(pairs, t);
}

/// Colours of rows; the last one is also that of all that have none of their own.
#define COLOURS 32u

// Rows of one colour share no particle that they could move, so none waits for the one before it. Each has the
// first colour that its particles are not in yet. *end: behind those of each colour.
static void colour_drafts(mspringi_pairs *pairs, uint32_t *end) {
    const double *weight = pairs->active.weight;
    uint32_t *used = pairs->colours, most = 0;
    for (uint32_t i = 0; i < pairs->draft_count; ++i) {
        const mspringi_candidate *c = &pairs->hot[pairs->drafts[i].candidate];
        used[c->p] = used[c->a] = used[c->b] = 0;
    }
    for (uint32_t i = 0; i < pairs->draft_count; ++i) {
        const mspringi_candidate *c = &pairs->hot[pairs->drafts[i].candidate];
        uint32_t number = 0;
        for (uint32_t all = used[c->p] | used[c->a] | used[c->b]; all & 1u && number + 1 < COLOURS; all >>= 1)
            ++number;
        used[c->p] |= weight[c->p] > 0.0 ? 1u << number : 0;
        used[c->a] |= weight[c->a] > 0.0 ? 1u << number : 0;
        used[c->b] |= weight[c->b] > 0.0 ? 1u << number : 0;
        pairs->drafts[i].colour = number;
        ++end[number];
        most = number > most ? number : most;
    }
    for (uint32_t number = 1; number <= most; ++number)
        end[number] += end[number - 1];
}

// Make the rows of all drafts, in the order of their colours, and of ids within each.
static void add_drafts(mspringi_pairs *pairs, double h) {
    uint32_t end[COLOURS] = {0};
    if (pairs->draft_count == 1) {
        make_row(pairs, pairs->drafts, &pairs->touches[pairs->touch_count++], h);
        pairs->draft_count = 0;
        return;
    }
    colour_drafts(pairs, end);
    for (uint32_t i = pairs->draft_count; i-- > 0;) {
        const mspringi_draft *draft = &pairs->drafts[i];
        make_row(pairs, draft, &pairs->touches[pairs->touch_count + --end[draft->colour]], h);
    }
    pairs->touch_count += pairs->draft_count;
    pairs->draft_count = 0;
}

// Whether a point follows the last draft's along an outline. Only such rows are put into another order. (Impulses
// reach fewer rows in a sweep by colours: heaps of fragments crept for a minute instead of 20 s.)
static bool follows(const mspringi_pairs *pairs, mspring_id point) {
    const mspringi_outline *o = &pairs->outline;
    const mspring_id last = pairs->list[pairs->hot[pairs->drafts[pairs->draft_count - 1].candidate].pair].point;
    bool is_next = point == last;
    for (uint32_t j = o->first[last]; j < o->first[last + 1] && !is_next; ++j)
        is_next = o->a[o->at[j]] == point || o->b[o->at[j]] == point;
    return is_next;
}

// Draft the row of a pair in a piece of h seconds, if it may touch there, by its own speed or by one that it may be
// given. *fastest: of all that have rows.
static void draft_row(const mspring_network *network, mspringi_pairs *pairs, uint32_t candidate, double h,
                      double given, double *fastest) {
    const mspringi_active *k = &pairs->active;
    const mspringi_candidate *c = &pairs->hot[candidate];
    const mspringi_nearest at =
        mspringi_nearest_on(k->x[c->p], k->y[c->p], k->x[c->a], k->y[c->a], k->x[c->b], k->y[c->b]);
    const double square = at.x * at.x + at.y * at.y, to_ends = square_to_ends(k, c->p, c->a, c->b);
    mspringi_pair *pair = &pairs->list[c->pair];
    const mspringi_collider *collider = pairs->colliders.count > 0 ? collider_of_pair(pairs, pair) : NULL;
    const double thickness = collider ? pairs->thickness + collider->radius : pairs->thickness;
    const double still = thickness + MSPRINGI_BORDER_SHARE * pairs->thickness;
    const double square_way = 4.0 * h * h * (to_ends > given * given ? to_ends : given * given);
    if (square > 2.0 * (still * still + square_way)) // further than the border: most are, and need no root
        return;
    const double speed = sqrt(to_ends), way = 2.0 * h * (speed > given ? speed : given);
    const double reach = thickness + way, border = still + way;
    if (!(square < border * border) || square == 0.0)
        return;
    if (!(square < reach * reach)) {
        pairs->border[pairs->border_count++] = candidate;
        return;
    }
    if (c->a != c->b && (at.share <= 0.0 || at.share >= 1.0) &&
        is_of_another(network, pairs, pair, at.share <= 0.0 ? 0 : 1))
        return;
    if (pairs->touch_count + pairs->draft_count == pairs->row_capacity) {
        pairs->is_crowded = true;
        return;
    }
    const double resistance = resistance_of(k, c, at.share);
    if (!(resistance > 0.0))
        return;
    if (pairs->draft_count == pairs->most_drafts || (pairs->draft_count > 0 && !follows(pairs, pair->point)))
        add_drafts(pairs, h);
    pairs->drafts[pairs->draft_count++] =
        (mspringi_draft){.at = at, .resistance = resistance, .candidate = candidate};
    *fastest = speed > *fastest ? speed : *fastest;
}

// Whether two particles without springs are too far from each other for a row. No root: a way is at most half the
// sum of any length and its own square through that length.
MSPRINGI_ALWAYS_INLINE bool are_far(const mspringi_active *k, const mspringi_candidate *c, double still,
                                    double per_square) {
    const double dx = k->x[c->p] - k->x[c->a], dy = k->y[c->p] - k->y[c->a];
    const double most = still + per_square * square_of_speed(k, c->p, c->a);
    return (c->a == c->b) & (c->p < k->own) & (c->a < k->own) & (dx * dx + dy * dy > most * most);
}

static uint32_t end_of_sieve(const mspringi_pairs *pairs, uint32_t first) {
    return pairs->hot_count - first < SIEVED ? pairs->hot_count : first + SIEVED;
}

// The candidates from one on that may have rows, branch-free: most have none.
static uint32_t sieve(const mspringi_pairs *pairs, uint32_t first, double h, double given, uint32_t *kept) {
    const double length = 2.0 * SIEVED_SHARE * pairs->thickness, per_square = 2.0 * h * h / length;
    const double still = (1.0 + MSPRINGI_BORDER_SHARE + SIEVED_SHARE) * pairs->thickness + 2.0 * h * given;
    uint32_t count = 0;
    for (uint32_t i = first, end = end_of_sieve(pairs, first); i < end; ++i) {
        kept[count] = i;
        count += !are_far(&pairs->active, &pairs->hot[i], still, per_square);
    }
    return count;
}

static bool is_thrown(const mspringi_pairs *pairs, uint32_t p, uint32_t a, uint32_t b) {
    const uint8_t *thrown = pairs->active.is_thrown;
    return thrown[p] | thrown[a] | thrown[b];
}

// The candidates from one on that are thrown and have not been looked at.
static uint32_t sieve_thrown(const mspringi_pairs *pairs, uint32_t first, uint32_t *kept) {
    uint32_t count = 0;
    for (uint32_t i = first, end = end_of_sieve(pairs, first); i < end; ++i) {
        const mspringi_candidate *c = &pairs->hot[i];
        kept[count] = i;
        count += is_thrown(pairs, c->p, c->a, c->b) & !pairs->is_seen[i];
    }
    return count;
}

// Draft the rows of candidates that may have some; of those that are thrown alone, which have none yet.
static void draft_rows(const mspring_network *network, mspringi_pairs *pairs, double h, double given,
                       bool are_thrown, double *fastest) {
    for (uint32_t first = 0; first < pairs->hot_count; first += SIEVED) {
        uint32_t kept[SIEVED];
        const uint32_t count = are_thrown ? sieve_thrown(pairs, first, kept) : sieve(pairs, first, h, given, kept);
        for (uint32_t i = 0; i < count; ++i)
            draft_row(network, pairs, kept[i], h, given, fastest);
    }
}

double mspringi_rows_make(const mspring_network *network, mspringi_pairs *pairs, double h, double given,
                          uint32_t drafts) {
    double fastest = 0.0;
    pairs->most_drafts = drafts;
    pairs->touch_count = pairs->draft_count = pairs->border_count = 0;
    draft_rows(network, pairs, h, given, false, &fastest);
    add_drafts(pairs, h);
    return fastest;
}

double mspringi_rows_prepare(const mspring_network *network, mspringi_pairs *pairs, double h) {
    const mspringi_active *k = &pairs->active;
    pairs->share = h / (double)pairs->h;
    pairs->fall_x = h * (double)network->settings.gravity_x;
    pairs->fall_y = h * (double)network->settings.gravity_y;
    memcpy(k->v, k->from, k->own * sizeof *k->v);
    const double fastest = mspringi_rows_make(network, pairs, h, 0.0, 1);
    (void)mspringi_rows_make(network, pairs, h, fastest + THROWN_SHARE * pairs->thickness / h, 1);
    return fastest;
}

/* -------------------------------------------------------------------------------------------- what is thrown */

bool mspringi_rows_add(const mspring_network *network, mspringi_pairs *pairs, double h, bool any_thrown) {
    const uint32_t before = pairs->touch_count, border_count = pairs->border_count;
    double fastest = 0.0;
    memset(pairs->is_seen, 0, pairs->hot_count);
    for (uint32_t i = 0; i < before; ++i)
        pairs->is_seen[pairs->touches[i].candidate] = 1;
    pairs->border_count = 0;
    for (uint32_t i = 0; i < border_count; ++i) {
        pairs->is_seen[pairs->border[i]] = 1;
        draft_row(network, pairs, pairs->border[i], h, 0.0, &fastest);
    }
    if (any_thrown)
        draft_rows(network, pairs, h, 0.0, true, &fastest);
    add_drafts(pairs, h);
    for (uint32_t i = before; i < pairs->touch_count; ++i) {
        const mspringi_touch *t = &pairs->touches[i];
        if (t->gap + h * mspringi_speed_across(t, pairs->active.v) < 0.0)
            return true;
    }
    return false;
}

bool mspringi_rows_are_short(const mspringi_pairs *pairs, double h) {
    const double most = FURTHEST * pairs->thickness / h;
    for (uint32_t i = 0; i < pairs->touch_count; ++i) {
        const mspringi_touch *t = &pairs->touches[i];
        if (is_thrown(pairs, t->p, t->a, t->b) && square_to_ends(&pairs->active, t->p, t->a, t->b) > most * most)
            return false;
    }
    return true;
}
