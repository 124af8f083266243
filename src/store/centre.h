/// @file centre.h
/// Centre of mass of a set of particles, and its velocity.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CENTRE_H
#define MSPRINGI_CENTRE_H

#include "store/selection.h"

typedef struct mspringi_selection_centre {
    uint32_t count;      ///< particles
    double mass;         ///< kg
    double x, y, vx, vy; ///< centre in local coordinates, m, and its velocity, m/s; 0 without particles
} mspringi_selection_centre;

/// Compute the centre of a set. Removed particles do not count, pinned ones only if `with_pinned`.
mspringi_selection_centre mspringi_selection_centre_of(const mspring_network *network, const mspringi_selection *at,
                                                       bool with_pinned);

static inline bool mspringi_is_free(const mspring_network *network, mspring_id particle) {
    return network->inverse_mass[network->topology.slot_of_particle[particle]] != 0.0f;
}

#endif
