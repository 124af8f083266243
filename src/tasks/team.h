/// @file team.h
/// The workers of a substep: each runs the whole of it, on its share of everything, and meets the others where it
/// needs what they have done.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TEAM_H
#define MSPRINGI_TEAM_H

#include "tasks/tasks.h"

/// One of them.
typedef struct mspringi_mate {
    uint32_t index, count;       ///< which of how many
    mspringi_progress *progress; ///< [count]; NULL for one
    uint32_t meetings;           ///< so far
} mspringi_mate;

/// Where a mate's share of so many things begins; the next one's share begins where it ends.
static inline size_t mspringi_share_of(const mspringi_mate *mate, size_t things) {
    return things * mate->index / mate->count;
}
static inline size_t mspringi_share_end(const mspringi_mate *mate, size_t things) {
    return things * (mate->index + 1) / mate->count;
}

/// Wait until all have come here.
static inline void mspringi_meet(mspringi_mate *mate) {
    if (mate->count == 1)
        return;
    mspringi_progress_advance(&mate->progress[mate->index], ++mate->meetings);
    for (uint32_t other = 0; other < mate->count; ++other)
        if (other != mate->index)
            mspringi_progress_wait(&mate->progress[other], mate->meetings);
}

#endif
