/// @file tasks.h
/// Work that is divided among threads: those that the host lends by callback, or the library's own.
///
/// Two kinds of work can be run:
///
///   independent bodies      any number of them; they may run in any order, one after the other or at once
///   bodies that wait        at most mspringi_tasks_concurrency() of them; each runs on a thread of its own from
///   the
///                           start, so body i may wait for what body j does (see mspringi_tasks_progress)
///
/// Bodies must write the same values whatever order they run in and whichever worker they run on: that makes a
/// step's bits independent of the number of workers.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TASKS_H
#define MSPRINGI_TASKS_H

#include "base/memory.h"
#include "tasks/progress.h"

/// NULL stands for one worker: the caller's thread.
typedef struct mspringi_tasks mspringi_tasks;

/// Take the host's threads, or start threads for worker_count workers if host is NULL. *tasks becomes NULL if that
/// makes one worker.
/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT, MSPRING_ERROR_STRUCT, MSPRING_ERROR_MEMORY, MSPRING_ERROR_THREAD
mspring_result mspringi_tasks_create(uint32_t worker_count, const mspring_tasks *host, mspringi_memory *memory,
                                     mspringi_message *message, mspringi_tasks **tasks);
void mspringi_tasks_destroy(mspringi_tasks *tasks, mspringi_memory *memory);

/// See that there are threads to run on: fork() leaves those of the library in the parent. Before the first run in
/// each call of the host's, while nothing has changed yet.
/// @return MSPRING_OK; MSPRING_ERROR_THREAD
mspring_result mspringi_tasks_restart_after_fork(mspringi_tasks *tasks, mspringi_message *message);

/// Number of workers: what is indexed by worker has so many elements.
uint32_t mspringi_tasks_workers(const mspringi_tasks *tasks);

/// How many bodies of one run are sure to run at the same time, 1 to the number of workers.
uint32_t mspringi_tasks_concurrency(const mspringi_tasks *tasks);

/// Whether there are several workers, and no body may wait for another one.
bool mspringi_tasks_are_independent(const mspringi_tasks *tasks);

/// How many shares to divide work into that can be done either way: the workers of independent bodies, else those
/// that are sure to run at the same time.
uint32_t mspringi_tasks_partition_size(const mspringi_tasks *tasks);

/// Run fn(argument, index, worker) for every index below count, in the floating-point environment of a step, and
/// return when all are done: what they have written is seen by the caller, and what the caller has written before,
/// by them. Must not be called from a body.
void mspringi_tasks_run(mspringi_tasks *tasks, uint32_t count, mspring_task_fn fn, void *argument);

/// Run fn(argument, first, end) for ranges that make up 0 ... count - 1, a multiple of grain each but the last; in
/// one go if there is but one worker or count is small.
typedef void (*mspringi_range_fn)(void *argument, size_t first, size_t end);
void mspringi_tasks_run_ranges(mspringi_tasks *tasks, size_t count, size_t grain, mspringi_range_fn fn,
                               void *argument);

/// How often a body that waited has had to sleep, in all runs: between runs only. 0 for NULL.
uint32_t mspringi_tasks_sleeps(const mspringi_tasks *tasks);

/// Counters for bodies that wait for each other: [mspringi_tasks_concurrency()], all 0 when a run begins. NULL if
/// tasks is.
mspringi_progress *mspringi_tasks_progress(mspringi_tasks *tasks);

#endif
