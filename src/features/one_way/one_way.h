/// @file one_way.h
/// Springs that only pull, as ropes and cables, or only push, as props.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ONE_WAY_H
#define MSPRINGI_ONE_WAY_H

#include "builder/builder.h"
#include "store/network.h"

/// Note which springs are. After network->topology is known; springs that are added later are none.
mspring_result mspringi_one_way_create(mspring_network *network, const mspring_builder *builder);

/// 1: the spring only pulls; -1: it only pushes; 0: it does both.
static inline int mspringi_side_of(const mspring_network *network, mspring_id spring) {
    const int8_t *side = network->one_way.side;
    return side && spring < network->topology.reserve.first_spring ? side[spring] : 0;
}

/// Whether a spring whose length is that much above its rest length exerts no force.
static inline bool mspringi_is_slack(int side, double stretch) {
    return (double)side * stretch < 0.0;
}

/// The flags that a definition has for such a spring.
uint32_t mspringi_side_flags(const mspring_network *network, mspring_id spring);

#endif
