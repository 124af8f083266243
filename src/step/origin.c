/// The local origin. Single precision resolves a position the better the closer it is to the origin, and springs
/// feel the difference of positions, so the origin goes where the network is.
#include "step/origin.h"
#include "store/changed.h"
#include "store/stages.h"

#include <math.h>

/// Smallest distance from the origin at which a move is worth its cost, m.
#define SMALLEST_RECENTRE_DISTANCE 64.0f

/// Farthest place that an origin moves to, m: that of the farthest particle of a network that did not move.
#define FARTHEST_ORIGIN (2.0 * MSPRING_MAX_COORDINATE)

mspringi_box mspringi_box_empty(void) {
    return (mspringi_box){INFINITY, INFINITY, -INFINITY, -INFINITY};
}

void mspringi_box_include(mspringi_box *box, double x, double y) {
    box->min_x = x < box->min_x ? x : box->min_x;
    box->min_y = y < box->min_y ? y : box->min_y;
    box->max_x = x > box->max_x ? x : box->max_x;
    box->max_y = y > box->max_y ? y : box->max_y;
}

// Whole metres, so that the same network at another whole number of metres has the same local coordinates.
static double middle(double low, double high) {
    return floor(0.5 * (low + high) + 0.5);
}

void mspringi_origin_set(mspring_network *network, double x, double y) {
    if (network->origin_x == x && network->origin_y == y)
        return;
    network->origin_x = x;
    network->origin_y = y;
    mspringi_notify_change(network, MSPRINGI_CHANGED_ORIGIN, 0);
}

void mspringi_origin_choose(mspring_network *network, const mspringi_box *box) {
    mspringi_origin_set(network, middle(box->min_x, box->max_x), middle(box->min_y, box->max_y));
    network->recentre_distance = SMALLEST_RECENTRE_DISTANCE;
}

void mspringi_set_position(mspring_network *network, mspring_id particle, double x, double y) {
    const uint32_t slot = network->topology.slot_of_particle[particle];
    mspringi_set_x(&network->state, slot, x - network->origin_x);
    mspringi_set_y(&network->state, slot, y - network->origin_y);
}

// One coordinate's shift: the middle of the network, if all particles are on one side of the origin and the
// farthest is at most about three times as far as the nearest, and the origin does not go too far. Then every
// coordinate is within a factor 2 of the middle, and the difference of two floats within a factor 2 of each other
// is exact (Sterbenz 1974). Else 0.
static float exact_shift(double origin, double low, double high) {
    const double nearest = low > 0.0 ? low : -high; // < 0 if the network is on both sides of the origin
    const double half = 0.501 * (high - low) + 1.0; // with room for the rounding of the middle
    const bool is_exact = nearest >= half && fabs(origin + middle(low, high)) <= FARTHEST_ORIGIN;
    return is_exact ? (float)middle(low, high) : 0.0f;
}

void mspringi_origin_follow(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_state *state = &network->state;
    // Look at the first existing particle alone until it is far away.
    mspring_id witness = 0;
    while (witness + 1 < t->particle_count && !mspringi_particle_exists(network, witness))
        ++witness;
    const uint32_t first = t->slot_of_particle[witness];
    if (fabsf(state->x[first]) < network->recentre_distance && fabsf(state->y[first]) < network->recentre_distance)
        return;
    mspringi_box box = mspringi_box_empty();
    for (uint32_t p = 0; p < t->particle_count; ++p)
        if (mspringi_particle_exists(network, p))
            mspringi_box_include(&box, (double)state->x[t->slot_of_particle[p]],
                                 (double)state->y[t->slot_of_particle[p]]);
    const float shift_x = exact_shift(network->origin_x, box.min_x, box.max_x),
                shift_y = exact_shift(network->origin_y, box.min_y, box.max_y);
    if (shift_x == 0.0f && shift_y == 0.0f) {
        network->recentre_distance *= 2.0f; // as large as this or around the origin: look again further out
        return;
    }
    for (uint32_t p = 0; p < t->particle_count; ++p) {
        if (!mspringi_particle_exists(network, p))
            continue;
        const uint32_t slot = t->slot_of_particle[p];
        mspringi_set_x(state, slot, mspringi_x_of(state, slot) - (double)shift_x);
        mspringi_set_y(state, slot, mspringi_y_of(state, slot) - (double)shift_y);
    }
    mspringi_origin_set(network, network->origin_x + (double)shift_x, network->origin_y + (double)shift_y);
    network->recentre_distance = SMALLEST_RECENTRE_DISTANCE;
}

// Groups are to have the same bits wherever others go.
static bool is_used(const mspring_network *network) {
    return network->groups.count == 0;
}

static void follow(mspring_network *network, double dt) {
    (void)dt;
    mspringi_origin_follow(network);
}

const mspringi_stage mspringi_stage_origin = {.is_used = is_used, .after_step = follow};
