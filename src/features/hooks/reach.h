/// @file reach.h
/// Hooks with MSPRING_HOOK_BELOW: which blocks they are called for, and in which steps for none.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_REACH_H
#define MSPRINGI_REACH_H

#include "features/hooks/hooks.h"

static inline bool mspringi_has_reach(const mspring_hook_def *def) {
    return (def->flags & MSPRING_HOOK_BELOW) != 0;
}

/// Slots that follow each other, in whole blocks.
typedef struct mspringi_slot_run {
    uint32_t first, end;
} mspringi_slot_run;

/// The next blocks of which a slot lies below the height of a hook, from slot at on. Returns false if there are
/// none in front of end.
bool mspringi_next_below(const mspring_network *network, const mspring_hook_def *def, uint32_t at, uint32_t end,
                         mspringi_slot_run *run);

/// Whether, by its place and speed, nothing can come below the height of a hook in a step of so many seconds. It is
/// found out once for an attempt.
bool mspringi_hook_is_away(const mspring_network *network, mspringi_hook *hook, double seconds);

/// After the substeps: whether something may have, by what they have led to.
bool mspringi_hook_must_repeat(const mspring_network *network, const mspringi_hook *hook,
                               const mspringi_attempt *attempt);

#endif
