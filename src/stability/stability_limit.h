/// @file stability_limit.h
/// The stability limit (see pencil.h), as the guard looks at it: quickly, over plain arrays.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STABILITY_LIMIT_H
#define MSPRINGI_STABILITY_LIMIT_H

#include "store/network.h"

/// Reserve what looks work in, unless it is there: 20 bytes a slot.
mspring_result mspringi_stability_limit_reserve(mspring_network *network);

/// Have the bound learn where springs are stiffest for their masses, for a network that has just been made.
void mspringi_stability_limit_learn(mspring_network *network);

/// Whether no eigenvalue of A + 2 D (see pencil.h) for substeps of h, in the shape that the network has, can be
/// above bound. False says nothing. Each call makes the next one's bound sharper; none changes anything that a step
/// depends on.
bool mspringi_stability_limit_is_below(mspring_network *network, double h, double bound);

/// The largest eigenvalue, or less, searched for with so many iterations at most and until it is above bound. From
/// no particular displacement if moved is 0, else from the motion of a step of so many substeps, whose state of
/// before is in the backup.
double mspringi_stability_limit_search(mspring_network *network, double h, uint32_t moved, double bound,
                                       int iterations);

/// What the passes over all springs work on at substeps of h; in, out and inverse_mass are left to the caller.
mspringi_stability_limit mspringi_stability_limit_at(const mspring_network *network, double h);
/// Add up all springs' share of the bound, or of the image of a displacement.
void mspringi_stability_limit_bound(const mspring_network *network, const mspringi_stability_limit *border);
void mspringi_stability_limit_image(const mspring_network *network, const mspringi_stability_limit *border);

/// What areas add to both (stability_areas.c).
void mspringi_areas_bound(const mspring_network *network, const mspringi_stability_limit *border);
void mspringi_areas_image(const mspring_network *network, const mspringi_stability_limit *border);

/// Slots of room that looks work in: so many arrays.
#define MSPRINGI_STABILITY_LIMIT_SCRATCH 4

/// One of these arrays, [slots].
static inline float *mspringi_stability_limit_scratch(const mspring_network *network, size_t which) {
    return network->guard_scratch + (1 + which) * mspringi_slot_count(network);
}

#endif
