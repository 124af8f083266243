/// @file one_way.h
/// Springs that only pull, as ropes and cables, or only push, as props.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ONE_WAY_H
#define MSPRINGI_ONE_WAY_H

#include "builder/builder.h"
#include "store/network.h"

/// A spring that only pulls or only pushes, in a step.
typedef struct mspringi_one_way_spring {
    mspringi_spring_slot spring_slot;
    uint32_t base, tip;       ///< slots
    float rest_length;        ///< as the host reads it
    float stiffness, damping; ///< where it acts
    uint32_t due;             ///< substep in which it acts whatever is expected; MSPRING_NONE: in none
    int32_t side;             ///< 1: it pulls; -1: it pushes
    bool acts;                ///< its records have these values, not 0
} mspringi_one_way_spring;

/// Springs that only pull or only push.
typedef struct mspringi_one_way {
    int8_t *side;                  ///< [reserve.first_spring] see mspringi_side_of()
    mspringi_one_way_spring *list; ///< [count] those of the step that are live
    uint32_t count, listed;
    bool must_repeat; ///< one did not act in a substep in which it should have
    bool is_repeated; ///< for that reason, the step is taken once more
} mspringi_one_way;

/// Note which springs are. After network->topology is known; springs that are added later are none.
mspring_result mspringi_one_way_create(mspring_network *network, const mspring_builder *builder);

/// 1: the spring only pulls; -1: it only pushes; 0: it does both.
static inline int mspringi_side_of(const mspring_network *network, mspring_id spring) {
    const mspringi_one_way *one_way = network->one_way;
    return one_way && spring < network->topology.reserve.first_spring ? one_way->side[spring] : 0;
}

/// Whether a spring whose length is that much above its rest length exerts no force.
static inline bool mspringi_is_slack(int side, double stretch) {
    return (double)side * stretch < 0.0;
}

/// The flags that a definition has for such a spring.
uint32_t mspringi_side_flags(const mspring_network *network, mspring_id spring);

#endif
