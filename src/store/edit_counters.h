/// @file edit_counters.h
/// Counters of what has been edited between steps.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_COUNTERS_H
#define MSPRINGI_EDIT_COUNTERS_H

#include <stdbool.h>

#include "base/assert.h"
#include <massspring/massspring.h>

/// Counters of edits, which only grow. Whoever caches something derived (a solver its history or tiles, a
/// measurement its components) stores the counters that it used, and compares them later.
/// mspringi_edits_have_link() and mspringi_edits_link() tell which springs broke or were restored since. Writing
/// through a view counts as no edit.
typedef struct mspringi_edits {
    uint64_t state;         ///< calls that set positions or velocities
    uint64_t motion;        ///< calls that set the positions of all particles at once: a new motion begins
    uint64_t masses;        ///< calls that changed inverse masses
    uint64_t values;        ///< calls that changed stiffness, damping or rest lengths
    uint64_t growth;        ///< calls that added or removed particles or springs
    uint64_t grafts;        ///< those among them in which springs were added, or anything was removed
    uint64_t links;         ///< springs that were broken or restored, added or removed, one by one
    uint64_t sleep_changes; ///< times that islands fell asleep or woke (MSPRINGI_CHANGED_NAPS)
    uint64_t layouts;       ///< times that all slots changed
    uint64_t origins;       ///< times that the local origin moved
    uint64_t flows;         ///< times that rest lengths changed within a step, or stiffness with its substep
    mspring_id
        *link_log; ///< the last of these springs: change n, counted from 0, is at n & link_mask; NULL before any
    uint32_t link_mask;
    bool broke; ///< a spring broke or was restored, here or in a loaded snapshot
} mspringi_edits;

/// True if the log still has all changes from number `seen` on; if not, any spring may have changed.
static inline bool mspringi_edits_have_link(const mspringi_edits *edits, uint64_t seen) {
    return edits->links - seen <= (uint64_t)edits->link_mask + 1;
}

/// The spring that was broken or restored in change number n.
static inline mspring_id mspringi_edits_link(const mspringi_edits *edits, uint64_t n) {
    MSPRINGI_ASSERT(edits->link_log && n < edits->links && mspringi_edits_have_link(edits, n));
    return edits->link_log[n & edits->link_mask];
}

#endif
