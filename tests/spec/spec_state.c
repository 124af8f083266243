/// @file spec_state.c
/// Specification of the state: coordinates in two words, edits of it, and the local origin.
///
/// SPDX-License-Identifier: MIT
#include "spec.h"

#include <math.h>
#include <string.h>

/* --------------------------------------------------------------------------------------------- coordinates in two words */

// Difference of neighbouring floats at a value.
float spec_last_place_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits &= 0xff800000u;
    memcpy(&value, &bits, sizeof value);
    return (float)((double)value * 0x1p-23);
}

// Round the first word of a coordinate to the grid of a precise network.
float spec_on_grid(float grid, float coordinate) {
    const float rounding = grid * 0x1.8p23f;
    return grid > 0.0f ? (coordinate + rounding) - rounding : coordinate;
}

// A low word that is too large to be the rest of its value counts as 0.
static float low_of(float value, float low, float grid) {
    return fabsf(low) <= fabsf(value) * 0x1p-21f || fabsf(low) <= grid ? low : 0.0f;
}

// Split a coordinate into two words, the first one on a grid, if there is one.
void spec_put_coordinate(double x, float grid, float *first, float *low) {
    *first = spec_on_grid(grid, (float)x);
    *low = low_of(*first, (float)(x - (double)*first), grid);
}

// Drop low words that cannot be the rest of a value, in a network whose hook may have written to the state.
static void tidy(const spec_network *network, uint32_t p) {
    spec_motion *m = &network->motions[p];
    if (network->hook != NULL) {
        m->low_place = (spec_vector){low_of(m->place.x, m->low_place.x, network->grid),
                                     low_of(m->place.y, m->low_place.y, network->grid)};
        m->low_velocity = (spec_vector){low_of(m->velocity.x, m->low_velocity.x, 0.0f),
                                        low_of(m->velocity.y, m->low_velocity.y, 0.0f)};
    }
}

void spec_tidy(const spec_network *network) {
    for (uint32_t p = 0; p < network->particle_count; p++) {
        tidy(network, p);
    }
}

/* -------------------------------------------------------------------------------------------------------- edits */

void spec_put(const spec_network *network, uint32_t p, double x, double y) {
    spec_motion *m = &network->motions[p];
    spec_put_coordinate(x, network->grid, &m->place.x, &m->low_place.x);
    spec_put_coordinate(y, network->grid, &m->place.y, &m->low_place.y);
}

void spec_place(spec_network *network, uint32_t particle, double x, double y) {
    spec_put(network, particle, x - network->origin_x, y - network->origin_y);
}

void spec_set_velocity(spec_network *network, uint32_t particle, float vx, float vy) {
    network->motions[particle].velocity = (spec_vector){vx, vy};
    network->motions[particle].low_velocity = (spec_vector){0.0f, 0.0f};
}

void spec_hit(spec_network *network, uint32_t particle, float x, float y) {
    tidy(network, particle);
    spec_vector *v = &network->motions[particle].velocity;
    const double per_impulse = (double)network->inverse_masses[particle];
    v->x = (float)((double)v->x + (double)x * per_impulse);
    v->y = (float)((double)v->y + (double)y * per_impulse);
}

double spec_x_of(const spec_network *network, uint32_t particle) {
    const spec_motion *m = &network->motions[particle];
    return (double)m->place.x + (double)low_of(m->place.x, m->low_place.x, network->grid);
}

double spec_y_of(const spec_network *network, uint32_t particle) {
    const spec_motion *m = &network->motions[particle];
    return (double)m->place.y + (double)low_of(m->place.y, m->low_place.y, network->grid);
}

/* ------------------------------------------------------------------------------------------------------- origin */

/// Smallest distance at which the origin is looked at, m.
#define NEAREST_LOOK 64.0f

static double middle(double low, double high) {
    return floor(0.5 * (low + high) + 0.5);
}

void spec_set_origin(spec_network *network, double min_x, double min_y, double max_x, double max_y) {
    network->origin_x = middle(min_x, max_x);
    network->origin_y = middle(min_y, max_y);
    network->look_distance = NEAREST_LOOK;
}

// The middle of one coordinate, if all particles lie to one side of the origin and the shift is exact.
static double shift_of(double origin, double low, double high) {
    const double nearest = low > 0.0 ? low : -high, half = 0.501 * (high - low) + 1.0;
    return nearest >= half && fabs(origin + middle(low, high)) <= 2e12 ? (double)(float)middle(low, high) : 0.0;
}

void spec_follow(spec_network *network) {
    const spec_motion *m = network->motions;
    if (fabsf(m->place.x) < network->look_distance && fabsf(m->place.y) < network->look_distance) {
        return;
    }
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t p = 0; p < network->particle_count; p++) {
        low[0] = fmin(low[0], (double)m[p].place.x);
        low[1] = fmin(low[1], (double)m[p].place.y);
        high[0] = fmax(high[0], (double)m[p].place.x);
        high[1] = fmax(high[1], (double)m[p].place.y);
    }
    const double shift_x = shift_of(network->origin_x, low[0], high[0]);
    const double shift_y = shift_of(network->origin_y, low[1], high[1]);
    if (shift_x == 0.0 && shift_y == 0.0) {
        network->look_distance *= 2.0f;
        return;
    }
    for (uint32_t p = 0; p < network->particle_count; p++) {
        spec_put(network, p, spec_x_of(network, p) - shift_x, spec_y_of(network, p) - shift_y);
    }
    network->origin_x += shift_x;
    network->origin_y += shift_y;
    network->look_distance = NEAREST_LOOK;
}
