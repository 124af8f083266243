/// @file group_ops.h
/// Calls of settings and steps to groups, which fail one by one (features/groups/held_groups.c).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GROUP_OPS_H
#define MSPRINGI_GROUP_OPS_H

#include "store/network.h"

/// Functions of groups that settings and steps call, if there are groups.
typedef struct mspringi_group_ops {
    /// Refuse settings, or a solver, that groups cannot have.
    mspring_result (*check_settings)(mspring_network *network, const mspring_settings *settings);
    mspring_result (*check_solver)(mspring_network *network, const mspring_solver_def *def);

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
} mspringi_group_ops;

#define GROUPS(table) extern const mspringi_group_ops table;
#include "store/features.def"

/// The table that there is, or NULL: then no network has groups.
extern const mspringi_group_ops *const mspringi_held_groups;

#endif
