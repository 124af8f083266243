/// @file team.h
/// The workers of a substep: each runs the whole of it, on its share of everything, and meets the others where it
/// needs what they have done.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TEAM_H
#define MSPRINGI_TEAM_H

#include "tasks/tasks.h"

/// One of them.
typedef struct mspringi_team_member {
    uint32_t index, count;       ///< which of how many
    mspringi_progress *progress; ///< [count]; NULL for one
    uint32_t barriers;           ///< so far
} mspringi_team_member;

/// Where a team member's share of so many things begins; the next one's share begins where it ends.
static inline size_t mspringi_range_begin(const mspringi_team_member *member, size_t things) {
    return things * member->index / member->count;
}
static inline size_t mspringi_range_end(const mspringi_team_member *member, size_t things) {
    return things * (member->index + 1) / member->count;
}

/// Wait until all have come here.
static inline void mspringi_team_barrier(mspringi_team_member *member) {
    if (member->count == 1)
        return;
    mspringi_progress_advance(&member->progress[member->index], ++member->barriers);
    for (uint32_t other = 0; other < member->count; ++other)
        if (other != member->index)
            mspringi_progress_wait(&member->progress[other], member->barriers);
}

#endif
