/// @file one_way.h
/// Springs that only pull, as ropes and cables, or only push, as props.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ONE_WAY_H
#define MSPRINGI_ONE_WAY_H

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

/// Springs that only pull or only push; which these are is network->side.
typedef struct mspringi_one_way {
    mspringi_one_way_spring *list; ///< [count] those of the step that are live
    uint32_t count, listed;
    bool must_repeat; ///< one did not act in a substep in which it should have
    bool is_repeated; ///< for that reason, the step is taken once more
} mspringi_one_way;

/// True if some springs only pull or only push.
bool mspringi_one_way_is_used(const mspring_network *network);

#endif
