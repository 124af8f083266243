/// @file moments.h
/// Mass, first moments and momentum: of a particle, or summed up over many.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MOMENTS_H
#define MSPRINGI_MOMENTS_H

#include "store/network.h"

typedef struct mspringi_moments {
    double mass;   ///< kg
    double x, y;   ///< mass times local coordinates, kg m
    double px, py; ///< kg m/s; pinned particles have theirs, too
} mspringi_moments;

static inline mspringi_moments mspringi_moments_of(const mspring_network *network, mspring_id particle) {
    const mspringi_state *s = &network->state;
    const uint32_t slot = network->topology.slot_of_particle[particle];
    const double mass = (double)network->mass[particle];
    return (mspringi_moments){mass, mass * mspringi_x_of(s, slot), mass * mspringi_y_of(s, slot),
                              mass * mspringi_vx_of(s, slot), mass * mspringi_vy_of(s, slot)};
}

static inline void mspringi_moments_add(mspringi_moments *to, mspringi_moments other) {
    to->mass += other.mass;
    to->x += other.x;
    to->y += other.y;
    to->px += other.px;
    to->py += other.py;
}

#endif
