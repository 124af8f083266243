/// @file tasks.h
/// Work divided among threads: the host's, lent by callback, or the library's own.
///
/// There are two kinds of work:
///
///   independent bodies  any number of them, in any order, one after the other or simultaneously
///   waiting bodies      at most mspringi_tasks_concurrency() of them. Each runs on its own thread from the start,
///                       so body i may wait for body j (see mspringi_tasks_progress)
///
/// Bodies must write the same values in any order and on any worker. So bits do not depend on the number of
/// workers.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TASKS_H
#define MSPRINGI_TASKS_H

#include "base/memory.h"
#include "tasks/progress.h"

/// Threads of a network; NULL for one worker, the caller's thread.
typedef struct mspringi_tasks mspringi_tasks;

/// Use the host's threads, or start threads for worker_count workers if host is NULL. *tasks becomes NULL for one
/// worker.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_STRUCT, MSPRING_ERROR_MEMORY, MSPRING_ERROR_THREAD
mspring_result mspringi_tasks_create(uint32_t worker_count, const mspring_tasks *host, mspringi_memory *memory,
                                     mspringi_message *message, mspringi_tasks **tasks);
void mspringi_tasks_destroy(mspringi_tasks *tasks, mspringi_memory *memory);

/// Restart the library's threads in a child process: fork() leaves them in the parent. Call this before the first
/// run of each public call, while nothing has changed yet.
/// @return MSPRING_OK; MSPRING_ERROR_THREAD
mspring_result mspringi_tasks_restart_after_fork(mspringi_tasks *tasks, mspringi_message *message);

/// Number of workers: size of arrays indexed by worker. Without threads it is 1, and code for more is left out.
#if defined(MSPRINGI_THREADS)
uint32_t mspringi_tasks_workers(const mspringi_tasks *tasks);
#else
static inline uint32_t mspringi_tasks_workers(const mspringi_tasks *tasks) {
    (void)tasks;
    return 1;
}
#endif

/// Number of bodies that are sure to run simultaneously, 1 to the number of workers.
uint32_t mspringi_tasks_concurrency(const mspringi_tasks *tasks);

/// True if there are several workers and no body may wait for another.
bool mspringi_tasks_are_independent(const mspringi_tasks *tasks);

/// Number of shares into which work of either kind is divided: all workers for independent bodies, else those that
/// are sure to run simultaneously.
uint32_t mspringi_tasks_partition_size(const mspringi_tasks *tasks);

/// Run fn(argument, index, worker) for every index below count, in the floating-point environment of a step, and
/// return when all are done. Bodies see the caller's writes, then the caller sees theirs. Bodies must not call
/// this.
void mspringi_tasks_run(mspringi_tasks *tasks, uint32_t count, mspring_task_fn fn, void *argument);

/// Run fn(argument, first, end) for ranges that cover 0 ... count - 1. Each but the last is a multiple of grain.
/// There is one range if there is one worker or count is small.
typedef void (*mspringi_range_fn)(void *argument, size_t first, size_t end);
void mspringi_tasks_run_ranges(mspringi_tasks *tasks, size_t count, size_t grain, mspringi_range_fn fn,
                               void *argument);

/// True if work whose parts take more than the whole should not be divided now: in the last step that was divided,
/// one worker took all bodies, one after the other. From time to time it is false, for another trial.
bool mspringi_tasks_are_in_turn(const mspringi_tasks *tasks);

/// Judge that at the end of a step.
void mspringi_tasks_judge(mspringi_tasks *tasks);

/// Number of waits that slept, over all runs; 0 for NULL. Call between runs only.
uint32_t mspringi_tasks_sleeps(const mspringi_tasks *tasks);

/// Counters for waiting bodies, [mspringi_tasks_concurrency()], all 0 when a run begins; NULL if tasks is NULL.
mspringi_progress *mspringi_tasks_progress(mspringi_tasks *tasks);

#endif
