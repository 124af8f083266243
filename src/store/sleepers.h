/// @file sleepers.h
/// Who sleeps, as solvers and stages read it, and what they call of sleep (features/sleep/).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SLEEPERS_H
#define MSPRINGI_SLEEPERS_H

#include "store/attempt.h"

/// Part of a strip that is swept.
typedef enum mspringi_strip_sleep {
    MSPRINGI_AWAKE,         ///< all blocks, and those above that take their carry
    MSPRINGI_PARTLY_ASLEEP, ///< blocks marked in `swept`
    MSPRINGI_ASLEEP         ///< none
} mspringi_strip_sleep;

/// Allocate the memory for sleep unless it exists.
mspring_result mspringi_sleep_reserve(mspring_network *network);

/// True if everything sleeps, so that nothing is swept.
static inline bool mspringi_sleep_is_whole(const mspring_network *network) {
    return network->sleep.sleeping > 0 && network->sleep.sleeping == network->sleep.count;
}

/// True if all sleep, with no force to compare.
static inline bool mspringi_sleep_is_idle(const mspring_network *network) {
    return mspringi_sleep_is_whole(network) && !network->sleep.has_force && !network->forces.held_any;
}

/// True if a slot's island sleeps.
static inline bool mspringi_slot_is_asleep(const mspring_network *network, size_t slot) {
    const mspringi_sleep *sleep = &network->sleep;
    MSPRINGI_ASSERT(sleep->sleeping == 0 || sleep->is_mapped);
    return sleep->sleeping > 0 && sleep->sleepers[slot / MSPRINGI_WIDTH] >> slot % MSPRINGI_WIDTH & 1;
}

/// The same after edits, too: what was set or written since sleeps until the next step.
static inline bool mspringi_slot_fell_asleep(const mspring_network *network, size_t slot) {
    const mspringi_sleep *sleep = &network->sleep;
    return sleep->sleeping > 0 && sleep->still[sleep->island[slot]] < 0.0;
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

/// Functions of sleep that others call, if anything sleeps or may.
typedef struct mspringi_sleep_ops {
    /// Before an attempt at a step: wake disturbed islands, and all if it changes the stiffness of relative
    /// springs.
    void (*begin)(mspring_network *network, const mspringi_attempt *attempt);
    /// Save sleeping slots before substeps, and restore them after: hooks may have given them a velocity.
    void (*hold)(const mspring_network *network);
    void (*put_back)(const mspring_network *network);
    /// After substeps were undone, before stages are: the backup may lack sleeping slots.
    void (*restore)(mspring_network *network);
    /// After a failed step that woke islands: put these back to sleep.
    void (*undo)(mspring_network *network);

    /// Before the substeps of a step: wake an island with its pile. After the last, find what is to be swept.
    void (*wake)(mspring_network *network, uint32_t island);
    void (*finish_waking)(mspring_network *network);

    /// Find the islands if edits have changed their links. They keep their time at rest and their sleep.
    void (*find_islands)(mspring_network *network);
    /// Take over islands from another layout of the same particles and springs, in the same state.
    void (*move)(mspring_network *to, const mspring_network *from);

    /// Calls of the host: wake everything; whether all sleeps, undisturbed since the last step.
    void (*wake_all)(mspring_network *network);
    bool (*is_idle)(const mspring_network *network);
} mspringi_sleep_ops;

#define SLEEP(table) extern const mspringi_sleep_ops table;
#include "store/features.def"

/// The table that there is, or NULL: then nothing sleeps.
extern const mspringi_sleep_ops *const mspringi_sleepers;

#endif
