/// @file group_ops.h
/// Calls of settings and steps to groups, which fail one by one (features/groups/held_groups.c).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GROUP_OPS_H
#define MSPRINGI_GROUP_OPS_H

#include "store/network.h"

/// Centre of mass of a group, in world coordinates, m, its velocity, m/s, and the box around its particles, which
/// are first ... end - 1.
typedef struct mspringi_group_frame {
    mspring_id first, end;
    double x, y, vx, vy;
    double min_x, min_y, max_x, max_y;
} mspringi_group_frame;

/// Functions of groups that settings and steps call, if there are groups.
typedef struct mspringi_group_ops {
    /// Refuse settings that groups cannot have.
    mspring_result (*check_settings)(mspring_network *network, const mspring_settings *settings);

    /// Before an attempt at a step: set the held groups at rest.
    void (*begin)(mspring_network *network);
    /// Find the groups that are out of bounds now.
    void (*suspect)(mspring_network *network);
    /// Hold them. False: there is none that was not held.
    bool (*hold_suspects)(mspring_network *network);
    /// Find the first group, from `from` on, that may be held because of others; the number of groups if there is
    /// none.
    uint32_t (*next_doubtful)(const mspring_network *network, uint32_t from);
    /// Hold a group where it is, or release it with its former velocity. The state is that before the step.
    void (*hold)(mspring_network *network, uint32_t group);
    void (*release)(mspring_network *network, uint32_t group);
    /// The step is over: keep what was held newly, or release it all.
    void (*end)(mspring_network *network, bool is_taken);
    /// Find the frame of the group that a particle is in.
    void (*find_frame)(const mspring_network *network, mspring_id particle, mspringi_group_frame *frame);
} mspringi_group_ops;

#define GROUPS(table) extern const mspringi_group_ops table;
#include "store/features.def"

/// The table that there is, or NULL: then no network has groups.
extern const mspringi_group_ops *const mspringi_held_groups;

/// Have `frame` be that of a particle; without a group the world's origin, at rest. It is computed only if the
/// particle is in another group than the last one: let its end be 0 at first.
static inline void mspringi_group_frame_of(const mspring_network *network, mspring_id particle,
                                           mspringi_group_frame *frame) {
    if (frame->end > 0 && particle >= frame->first && particle < frame->end)
        return;
    if (network->groups.count > 0)
        mspringi_held_groups->find_frame(network, particle, frame);
    else
        *frame = (mspringi_group_frame){.end = MSPRING_NONE};
}

/// MSPRING_RELATIVE_X to _VY of a particle in a frame.
static inline double mspringi_relative_value(const mspring_network *network, mspring_property property,
                                             mspring_id particle, const mspringi_group_frame *frame) {
    const mspringi_state *s = &network->state;
    const uint32_t slot = network->topology.slot_of_particle[particle];
    return property == MSPRING_RELATIVE_X    ? network->origin_x - frame->x + mspringi_x_of(s, slot)
           : property == MSPRING_RELATIVE_Y  ? network->origin_y - frame->y + mspringi_y_of(s, slot)
           : property == MSPRING_RELATIVE_VX ? mspringi_vx_of(s, slot) - frame->vx
                                             : mspringi_vy_of(s, slot) - frame->vy;
}

#endif
