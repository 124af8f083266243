/// @file compact.h
/// Leaving out of the plan what has broken, and taking it in again.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_COMPACT_H
#define MSPRINGI_COMPACT_H

#include "store/network.h"

/// Whether no step sweeps this spring until the network is expanded.
static inline bool mspringi_spring_is_inactive(const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    return mspringi_spring_slot_is_inactive(t, mspringi_slot_of_spring(t, spring));
}

/// Go back to the plan that the network was created with. On error nothing has changed.
mspring_result mspringi_expand(mspring_network *network);

#endif
