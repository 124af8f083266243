/// A substep of what touches: rows are solved, and what they throw gets rows, too. A substep in which something
/// would move further than the thickness is taken in pieces.
#include <math.h>
#include <string.h>

#include "contact/pairs.h"
#include "store/network.h"

/// A substep is cut into pieces in which nothing moves further than the thickness; into so many at most.
#define MOST_PIECES 64

/// So many times at most, in all pieces of a substep.
#define MOST_CUTS 6

/// Rows of what is thrown are added, and all rows swept again, so many times at most.
#define MOST_ROUNDS 8

static void begin(const mspring_network *network, const mspringi_active *k) {
    for (uint32_t i = 0; i < k->own; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        k->v[i].x = (double)network->state.vx[slot];
        k->v[i].y = (double)network->state.vy[slot];
        k->way_x[i] = k->way_y[i] = 0.0;
    }
}

// Mark the particles whose velocities the sweeps have changed by so much that pairs beyond the border may have come
// into reach. Returns whether there are any.
static bool mark_thrown(const mspringi_pairs *pairs, double h) {
    const mspringi_active *k = &pairs->active;
    const double least = 0.25 * MSPRINGI_BORDER_SHARE * pairs->thickness / h;
    uint8_t any = 0;
    for (uint32_t i = 0; i < k->own; ++i) {
        const double x = k->v[i].x - k->old[i].x, y = k->v[i].y - k->old[i].y;
        k->is_thrown[i] = x * x + y * y > least * least;
        any |= k->is_thrown[i];
    }
    memset(k->is_thrown + k->own, 0, k->count - k->own);
    return any;
}

// Solve a piece. False: it is too long for what the sweeps have made of it.
static bool solve(const mspring_network *network, mspringi_pairs *pairs, double h) {
    mspringi_bearing_begin(pairs, h);
    for (uint32_t round = 0;; ++round) {
        const bool holds = mspringi_rows_sweep(pairs, h, round == 0 ? pairs->def.sweeps : 1);
        const bool any_thrown = mark_thrown(pairs, h);
        if (!any_thrown && pairs->border_count == 0)
            return holds;
        if (round == MOST_ROUNDS)
            return false;
        if (!mspringi_rows_add(network, pairs, h, any_thrown))
            return holds && (!any_thrown || mspringi_rows_are_short(pairs, h));
    }
}

void mspringi_rows_count(const mspring_network *network, mspringi_pairs *pairs) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < pairs->touch_count && pairs->meetings.capacity > 0; ++i)
        if (pairs->touches[i].across > 0.0)
            mspringi_meetings_push(network, pairs, &pairs->touches[i]);
    mspringi_meetings_begin_piece(pairs);
    for (uint32_t i = 0; i < pairs->touch_count; ++i) {
        const mspringi_touch *t = &pairs->touches[i];
        if (t->collider != MSPRING_NONE)
            mspringi_colliders_push(pairs, t);
        count += t->across > 0.0;
        pairs->deepest = -t->gap > pairs->deepest ? -t->gap : pairs->deepest;
    }
    pairs->touching = count > pairs->touching ? count : pairs->touching;
}

static void keep_velocities(const mspringi_active *k) {
    memcpy(k->old, k->v, k->own * sizeof *k->v);
}

static void restore_velocities(const mspringi_active *k) {
    memcpy(k->v, k->old, k->own * sizeof *k->v);
}

// Go along for a piece of h seconds. What contact adds to the move is counted apart. The next piece bounces by what
// this one has left.
static void advance(const mspring_network *network, const mspringi_active *k, double h, bool is_last) {
    for (uint32_t i = 0; i < k->own && !is_last; ++i) {
        k->from[i].x += k->v[i].x - k->old[i].x;
        k->from[i].y += k->v[i].y - k->old[i].y;
    }
    for (uint32_t i = 0; i < k->own; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        k->way_x[i] += h * (k->v[i].x - (double)network->state.vx[slot]);
        k->way_y[i] += h * (k->v[i].y - (double)network->state.vy[slot]);
    }
    for (uint32_t i = 0; i < k->count && !is_last; ++i) {
        k->x[i] += h * k->v[i].x;
        k->y[i] += h * k->v[i].y;
    }
}

// Returns the largest speed that contact has given beside the outline's mean, m/s.
static double put_back(const mspring_network *network, const mspringi_pairs *pairs) {
    const mspringi_state *s = &network->state;
    const mspringi_active *k = &pairs->active;
    double most = 0.0;
    for (uint32_t i = 0; i < k->own; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        if (k->way_x[i] == 0.0 && k->way_y[i] == 0.0 && k->v[i].x == (double)s->vx[slot] &&
            k->v[i].y == (double)s->vy[slot])
            continue;
        const double x = k->v[i].x - pairs->mean_vx, y = k->v[i].y - pairs->mean_vy, square = x * x + y * y;
        most = square > most ? square : most;
        s->vx[slot] = (float)k->v[i].x;
        s->vy[slot] = (float)k->v[i].y;
        mspringi_move_by(s, slot, (float)k->way_x[i], (float)k->way_y[i]);
    }
    return sqrt(most);
}

// Take pieces of even length, or more of them where that is too long.
static void take_pieces(const mspring_network *network, mspringi_pairs *pairs, double h, uint32_t pieces) {
    const mspringi_active *k = &pairs->active;
    bool is_made = pieces == 1;
    for (uint32_t left = pieces, cuts = 0; left > 0;) {
        const double piece = h / left;
        if (!is_made)
            (void)mspringi_rows_make(network, pairs, piece, 0.0, MSPRINGI_DRAFTS);
        is_made = false;
        keep_velocities(k);
        if (!solve(network, pairs, piece) && cuts < MOST_CUTS && left < MOST_PIECES) {
            restore_velocities(k);
            left = 2 * left < MOST_PIECES ? 2 * left : MOST_PIECES;
            ++cuts;
            continue;
        }
        mspringi_rows_count(network, pairs);
        mspringi_bearing_end(network, pairs);
        advance(network, k, piece, left == 1);
        h -= piece;
        --left;
    }
}

// What contact has made faster than the last look allows for: the list is to be renewed. If pairs may be missing
// from it in this substep already, the step is repeated with a look for such speeds.
static void count_thrown(mspringi_pairs *pairs, double speed) {
    const double spare = MSPRINGI_DRIFT * pairs->thickness / pairs->dt;
    if (speed > MSPRINGI_FASTER * pairs->speed + spare)
        pairs->valid = 1;
    if (speed > 3.0 * pairs->speed + 0.25 * pairs->thickness / (double)pairs->h) {
        pairs->is_missed = true;
        pairs->thrown = speed > pairs->thrown ? speed : pairs->thrown;
    }
}

bool mspringi_rows_solve(const mspring_network *network, mspringi_pairs *pairs, double h) {
    pairs->share = 1.0;
    const double fastest = mspringi_rows_make(network, pairs, h, 0.0, MSPRINGI_DRAFTS);
    if (pairs->touch_count == 0)
        return false;
    mspringi_bearing_find(network, pairs);
    const double thicknesses = h * fastest / pairs->thickness;
    take_pieces(network, pairs, h, thicknesses < MOST_PIECES ? (uint32_t)thicknesses + 1 : MOST_PIECES);
    return true;
}

bool mspringi_rows_act(const mspring_network *network, mspringi_pairs *pairs) {
    begin(network, &pairs->active);
    pairs->fall_x = pairs->fall_y = 0.0;
    if (!mspringi_rows_solve(network, pairs, (double)pairs->h))
        return false;
    count_thrown(pairs, put_back(network, pairs));
    return true;
}
