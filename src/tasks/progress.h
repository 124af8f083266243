/// @file progress.h
/// A counter by which one thread tells others how far it is.
///
/// Who waits spins for some microseconds, since the other is usually about to arrive, and then sleeps: where
/// threads share a core, spinning is what keeps the other from arriving. So a counter spins for less time when
/// spinning was in vain, and for more when it was not.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PROGRESS_H
#define MSPRINGI_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "tasks/thread.h"

/// Counters of different threads lie in different cache lines.
#define MSPRINGI_CACHE_LINE 64

#if defined(MSPRINGI_THREADS)

#include <stdatomic.h>

typedef struct mspringi_progress {
    _Alignas(MSPRINGI_CACHE_LINE) atomic_uint value;
    atomic_uint sleepers; ///< threads that wait, or are about to, on the condition
    atomic_uint spins;    ///< looks before going to sleep
    uint32_t sleeps;      ///< so far; the mutex guards it
    mspringi_mutex mutex;
    mspringi_condition condition;
} mspringi_progress;

#else

typedef struct mspringi_progress {
    uint32_t value;
} mspringi_progress;

#endif

/// Make a counter at 0. False if the system refuses.
bool mspringi_progress_init(mspringi_progress *progress);
void mspringi_progress_destroy(mspringi_progress *progress);

/// Set a counter while nobody waits on it.
void mspringi_progress_reset(mspringi_progress *progress, uint32_t value);

/// How many waits have ended up asleep so far. Nobody may be waiting.
uint32_t mspringi_progress_sleeps(const mspringi_progress *progress);

/// Say how far this thread is. What it has written before is seen by those who waited for it. Only one thread
/// advances a counter; values grow, and go on from 0 after the largest.
void mspringi_progress_advance(mspringi_progress *progress, uint32_t value);

/// Wait until the counter is at target or further (by less than 2^31).
/// @return where it is: whoever remembers that need not ask again before
uint32_t mspringi_progress_wait(mspringi_progress *progress, uint32_t target);

#endif
