/// @file sleep.h
/// Islands that lie still are left alone until something happens to them.
///
///   sleep.c      when islands fall asleep, and what wakes them
///   islands.c    which they are, and what of the rows is swept while some sleep
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SLEEP_H
#define MSPRINGI_SLEEP_H

#include "store/network.h"
#include "store/solver.h"

/// What is to be swept of a strip.
typedef enum mspringi_share {
    MSPRINGI_AWAKE,  ///< all of it, and nothing above it is left out
    MSPRINGI_PARTLY, ///< the blocks that are marked as swept
    MSPRINGI_ASLEEP  ///< none
} mspringi_share;

/// Allocate what a network that may sleep needs, unless it is there.
mspring_result mspringi_sleep_reserve(mspring_network *network);
/// Forget what lies by slot, which was freed or is another's.
void mspringi_sleep_forget(mspringi_sleep *sleep);
/// Have what sleeps in another network of the same particles and springs sleep in this one, which has the same
/// state.
void mspringi_sleep_move(mspring_network *to, const mspring_network *from);

/* ------------------------------------------------------------------------------------------------- what sleeps */

/// All that there is, so that nothing is swept.
static inline bool mspringi_sleep_is_whole(const mspring_network *network) {
    return network->sleep.sleeping > 0 && network->sleep.sleeping == network->sleep.count;
}

/// Whether a slot's island sleeps.
static inline bool mspringi_slot_is_asleep(const mspring_network *network, size_t slot) {
    const mspringi_sleep *sleep = &network->sleep;
    MSPRINGI_ASSERT(sleep->sleeping == 0 || sleep->is_mapped);
    return sleep->sleeping > 0 && sleep->sleepers[slot / MSPRINGI_WIDTH] >> slot % MSPRINGI_WIDTH & 1;
}

static inline mspringi_share mspringi_sleep_state_of_strip(const mspring_network *network,
                                                           const mspringi_strip *strip) {
    const mspringi_sleep *sleep = &network->sleep;
    return sleep->sleeping > 0 ? (mspringi_share)sleep->share[strip - network->topology.strips] : MSPRINGI_AWAKE;
}

/// Whether any of the blocks first to end - 1 is swept.
bool mspringi_is_any_swept(const mspring_network *network, size_t first, size_t end);

/// The next run of blocks that are swept, from slot *at of a span on, which goes behind it. part[1] is there to be
/// read behind part[0]. Returns false if there is none.
bool mspringi_next_swept(const mspring_network *network, const mspringi_span *span, uint32_t *at,
                         mspringi_span part[2]);

/// The next of count blocks, of which the first has number base, that are swept: *first to *end - 1, counted from
/// base. Returns false if there is none. What sleeps was looked at when it fell asleep.
bool mspringi_next_awake(const mspring_network *network, uint32_t base, uint32_t count, uint32_t *first,
                         uint32_t *end);

/* ---------------------------------------------------------------------------------------------------- waking */

/// Nothing sleeps any more.
void mspringi_wake(mspring_network *network);
/// Nothing sleeps any more, and islands are to be looked for anew.
void mspringi_sleep_anew(mspring_network *network);
/// Something happens to the island of a slot, or to those of a spring's ends. Nothing for networks that never
/// sleep.
void mspringi_wake_slot(mspring_network *network, uint32_t slot);
void mspringi_wake_spring(mspring_network *network, mspring_id spring);

/// Whether a slot that is asleep has been changed since: its position, velocity or mass.
bool mspringi_sleeper_is_disturbed(const mspring_network *network, size_t slot);
/// Whether any has been.
bool mspringi_sleep_is_disturbed(const mspring_network *network);

/* ------------------------------------------------------------------------------------------------------- a step */

/// Before a step: wake what has been disturbed, or what the step would change springs of.
void mspringi_sleep_begin(mspring_network *network, const mspringi_attempt *attempt);
/// Likewise: wake an island that something comes to, and go by that once all have been woken; naps is edits.naps of
/// before the first.
void mspringi_sleep_rouse(mspring_network *network, uint32_t island);
void mspringi_sleep_roused(mspring_network *network, uint64_t naps);
/// Whether all are asleep, with no force to compare.
bool mspringi_sleep_is_idle(const mspring_network *network);
/// Keep what sleeps from moving in substeps, where hooks have given it a velocity: hold it before them, and put it
/// back after them.
void mspringi_sleep_hold(const mspring_network *network);
void mspringi_sleep_put_back(const mspring_network *network);

/// After a step that failed: what slept before it sleeps.
void mspringi_sleep_undo(mspring_network *network);

/// Have these islands, those that are marked, sleep as they are now, under these forces (x NULL: none).
void mspringi_sleep_fall(mspring_network *network, mspringi_field force);

/* -------------------------------------------------------------------------------------------------- islands.c */

/// Find the islands, if links have changed them. What was still, or asleep, goes on to be.
void mspringi_islands_find(mspring_network *network);
/// Find out what is to be swept, when islands have fallen asleep or woken.
void mspringi_islands_map(mspring_network *network);
/// Only take over the masses of what is awake.
void mspringi_islands_weigh(mspring_network *network);

#endif
