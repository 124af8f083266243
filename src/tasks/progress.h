/// @file progress.h
/// Progress counter of a thread, for others to wait on.
///
/// A wait polls for some microseconds, since the other thread is usually about to arrive, then sleeps. If both
/// threads share a core, polling only delays the other. So polls that were in vain make the next ones shorter, and
/// the others make them longer.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PROGRESS_H
#define MSPRINGI_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "tasks/thread.h"

/// Alignment: counters of different threads lie in different cache lines.
#define MSPRINGI_CACHE_LINE 64

#if defined(MSPRINGI_THREADS)

#include <stdatomic.h>

typedef struct mspringi_progress {
    _Alignas(MSPRINGI_CACHE_LINE) atomic_uint value;
    atomic_uint sleepers; ///< threads that wait on the condition, or are about to
    atomic_uint spins;    ///< polls before sleeping
    uint32_t sleeps;      ///< sleeps so far; guarded by the mutex
    mspringi_mutex mutex;
    mspringi_condition condition;
} mspringi_progress;

#else

typedef struct mspringi_progress {
    uint32_t value;
} mspringi_progress;

#endif

/// Initialise a counter to 0. Return false if the system has no lock left.
bool mspringi_progress_init(mspringi_progress *progress);
void mspringi_progress_destroy(mspringi_progress *progress);

/// Set a counter that no thread waits on.
void mspringi_progress_reset(mspringi_progress *progress, uint32_t value);

/// Number of waits that slept. No thread may be waiting.
uint32_t mspringi_progress_sleeps(const mspringi_progress *progress);

/// Publish progress. A thread that waits for it sees everything written before. Only one thread advances a counter;
/// values grow and wrap around.
void mspringi_progress_advance(mspringi_progress *progress, uint32_t value);

/// Wait until the counter reaches target, or is less than 2^31 past it. @return the counter; no further wait is
/// needed up to this value
uint32_t mspringi_progress_wait(mspringi_progress *progress, uint32_t target);

#endif
