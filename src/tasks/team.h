/// @file team.h
/// Workers of a substep. Each runs all of it on its share of the data, with barriers before it needs the others'
/// results.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TEAM_H
#define MSPRINGI_TEAM_H

#include "tasks/tasks.h"

/// Member of a team.
typedef struct mspringi_team_member {
    uint32_t index, count;       ///< number in the team, members
    mspringi_progress *progress; ///< [count]; NULL for one member
    uint32_t barriers;           ///< barriers passed so far
} mspringi_team_member;

/// Begin and end of a member's share. Each share begins where the one before ends.
static inline size_t mspringi_range_begin(const mspringi_team_member *member, size_t things) {
    return things * member->index / member->count;
}
static inline size_t mspringi_range_end(const mspringi_team_member *member, size_t things) {
    return things * (member->index + 1) / member->count;
}

/// Wait for all members.
static inline void mspringi_team_barrier(mspringi_team_member *member) {
    if (member->count == 1)
        return;
    mspringi_progress_advance(&member->progress[member->index], ++member->barriers);
    for (uint32_t other = 0; other < member->count; ++other)
        if (other != member->index)
            mspringi_progress_wait(&member->progress[other], member->barriers);
}

#endif
