/// @file sleep.h
/// Sleep of islands at rest, until something disturbs them.
///
///   sleep.c      falling asleep and waking
///   islands.c    islands, and blocks that are swept while some sleep
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SLEEP_H
#define MSPRINGI_SLEEP_H

#include "store/attempt.h"

/// Part of a strip that is swept.
typedef enum mspringi_strip_sleep {
    MSPRINGI_AWAKE,         ///< all blocks, and those above that take their carry
    MSPRINGI_PARTLY_ASLEEP, ///< blocks marked in `swept`
    MSPRINGI_ASLEEP         ///< none
} mspringi_strip_sleep;

/// Allocate the memory for sleep unless it exists.
mspring_result mspringi_sleep_reserve(mspring_network *network);
/// Reset all arrays by slot, which were freed or belong to another layout.
void mspringi_sleep_forget(mspringi_sleep *sleep);
/// Take over sleep from another layout of the same particles and springs, in the same state.
void mspringi_sleep_move(mspring_network *to, const mspring_network *from);

/* ----------------------------------------------------------------------------------------------------- queries */

/// True if everything sleeps, so that nothing is swept.
static inline bool mspringi_sleep_is_whole(const mspring_network *network) {
    return network->sleep.sleeping > 0 && network->sleep.sleeping == network->sleep.count;
}

/// True if a slot's island sleeps.
static inline bool mspringi_slot_is_asleep(const mspring_network *network, size_t slot) {
    const mspringi_sleep *sleep = &network->sleep;
    MSPRINGI_ASSERT(sleep->sleeping == 0 || sleep->is_mapped);
    return sleep->sleeping > 0 && sleep->sleepers[slot / MSPRINGI_WIDTH] >> slot % MSPRINGI_WIDTH & 1;
}

static inline mspringi_strip_sleep mspringi_sleep_state_of_strip(const mspring_network *network,
                                                                 const mspringi_strip *strip) {
    const mspringi_sleep *sleep = &network->sleep;
    return sleep->sleeping > 0 ? (mspringi_strip_sleep)sleep->share[strip - network->topology.strips]
                               : MSPRINGI_AWAKE;
}

/// True if any of the blocks first to end - 1 is swept.
bool mspringi_is_any_swept(const mspring_network *network, size_t first, size_t end);

/// Find the next run of swept blocks, from slot *at of a span on, and advance *at past it. part[0] is the run;
/// part[1] is a copy, for kernels that read a span ahead. False if there is none.
bool mspringi_next_swept(const mspring_network *network, const mspringi_span *span, uint32_t *at,
                         mspringi_span part[2]);

/// Find the next run of swept blocks among `count` from block `base` on: *first to *end - 1, relative to base.
/// False if there is none. Sleeping blocks need no check; they passed it when they fell asleep.
bool mspringi_next_awake(const mspring_network *network, uint32_t base, uint32_t count, uint32_t *first,
                         uint32_t *end);

/* ---------------------------------------------------------------------------------------------------- waking */

/// Wake all islands.
void mspringi_wake(mspring_network *network);
/// Wake all islands, and have them found again.
void mspringi_sleep_reset(mspring_network *network);
/// Wake the island of a slot, or those of a spring's ends. Without effect in networks that never sleep.
void mspringi_wake_slot(mspring_network *network, uint32_t slot);
void mspringi_wake_spring(mspring_network *network, mspring_id spring);

/// True if the position, velocity or mass of a sleeping slot has changed since it fell asleep.
bool mspringi_sleeper_is_disturbed(const mspring_network *network, size_t slot);
/// First sleeping slot from `slot` on that the next step wakes, as its position, velocity or mass has changed since
/// it fell asleep. The number of slots if there is none.
size_t mspringi_next_disturbed_sleeper(const mspring_network *network, size_t slot);
/// True if any sleeping slot has been disturbed.
bool mspringi_sleep_is_disturbed(const mspring_network *network);

/* --------------------------------------------------------------------------------------------------------- step */

/// Before a step: wake disturbed islands, and all if the step changes the stiffness of relative springs.
void mspringi_sleep_begin(mspring_network *network, const mspringi_attempt *attempt);
/// Before a step: wake an island on contact, and update the blocks after the last. naps: edits.sleep_changes before
/// the first.
void mspringi_sleep_wake_island(mspring_network *network, uint32_t island);
void mspringi_sleep_finish_waking(mspring_network *network, uint64_t sleep_changes);
/// True if all sleep, with no force to compare.
bool mspringi_sleep_is_idle(const mspring_network *network);
/// Save sleeping slots before substeps, and restore them after: hooks may have given them a velocity.
void mspringi_sleep_hold(const mspring_network *network);
void mspringi_sleep_put_back(const mspring_network *network);

/// After a failed step: put the islands woken by it back to sleep.
void mspringi_sleep_undo(mspring_network *network);

/// Put the marked islands to sleep in their present state, under these forces (x NULL: none).
void mspringi_sleep_fall(mspring_network *network, mspringi_field force);

/* -------------------------------------------------------------------------------------------------- islands.c */

/// Find the islands if edits have changed their links. They keep their time at rest and their sleep.
void mspringi_islands_find(mspring_network *network);
/// Update the blocks and strips to sweep, after islands fell asleep or woke.
void mspringi_islands_map(mspring_network *network);
/// Only update the active inverse masses of awake particles.
void mspringi_islands_update_masses(mspring_network *network);

#endif
