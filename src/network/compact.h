/// @file compact.h
/// Removal of broken springs from the layout, and return to the initial layout.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_COMPACT_H
#define MSPRINGI_COMPACT_H

#include "store/network.h"

/// True if no step sweeps this spring until the network is expanded.
static inline bool mspringi_spring_is_inactive(const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    return mspringi_spring_slot_is_inactive(t, mspringi_slot_of_spring(t, spring));
}

/// Return to the initial layout. On error nothing has changed.
mspring_result mspringi_expand(mspring_network *network);

#endif
