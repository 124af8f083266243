/// @file stability_limit.h
/// The stability limit (see pencil.h) as the guard checks it: fast, over plain arrays.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STABILITY_LIMIT_H
#define MSPRINGI_STABILITY_LIMIT_H

#include "store/springs.h"

/// Reserve the scratch arrays unless they exist: 20 bytes a slot.
mspring_result mspringi_stability_limit_reserve(mspring_network *network);

/// Adapt the weights of the bound to a new network.
void mspringi_stability_limit_adapt(mspring_network *network);

/// True if no eigenvalue of A + 2 D (see pencil.h) exceeds bound, for substeps of h in the present shape. False
/// proves nothing. Each call sharpens the bound of the next; no step depends on it.
bool mspringi_stability_limit_is_below(mspring_network *network, double h, double bound);

/// Lower bound of the largest eigenvalue, by a search that ends above bound or after `iterations`. It starts from
/// noise if moved is 0, else from the motion of a step of `moved` substeps. The backup has the state before that
/// step.
double mspringi_stability_limit_search(mspring_network *network, double h, uint32_t moved, double bound,
                                       int iterations);

/// Arguments of the passes over all springs at substeps of h. The caller sets in, out and inverse_mass.
mspringi_stability_limit mspringi_stability_limit_at(const mspring_network *network, double h);
/// Add the part of all springs and areas to the bound, or to the image of a displacement.
void mspringi_stability_limit_bound(const mspring_network *network, const mspringi_stability_limit *limit);
void mspringi_stability_limit_image(const mspring_network *network, const mspringi_stability_limit *limit);

/// Number of scratch arrays, by slot.
#define MSPRINGI_STABILITY_LIMIT_SCRATCH 4

/// Scratch array, [slots].
static inline float *mspringi_stability_limit_scratch(const mspring_network *network, size_t which) {
    return network->guard_scratch + (1 + which) * mspringi_slot_count(network);
}

#endif
