/// @file held_groups.h
/// Groups of particles that go wrong singly: they are held where they were, and the others go on.
///
/// What is no number may spread in the step in which it comes up: arithmetic with springs that are not there turns
/// it into more of its kind in neighbouring lanes. So a group that has such numbers is to blame only if it has them
/// when it steps with none of the others that had. Each of these is tried once. A group that is out of bounds by
/// numbers is to blame for sure.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_HELD_GROUPS_H
#define MSPRINGI_HELD_GROUPS_H

#include "store/network.h"

/// Functions of groups that settings and steps call, if there are groups.
typedef struct mspringi_group_ops {
    /// Refuse settings, or a solver, that groups cannot have.
    mspring_result (*check_settings)(mspring_network *network, const mspring_settings *settings);
    mspring_result (*check_solver)(mspring_network *network, const mspring_solver_def *def);

    /// Before an attempt at a step: what is held is at rest.
    void (*begin)(mspring_network *network);
    /// Find the groups that are out of bounds now.
    void (*suspect)(mspring_network *network);
    /// Hold them. False: there is none that was not held.
    bool (*hold_suspects)(mspring_network *network);
    /// The first group from one on that may be held for what others did, or the number of groups.
    uint32_t (*next_doubtful)(const mspring_network *network, uint32_t from);
    /// Hold a group where it is, or let it go on from there as it did. The state is that of before the step.
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
