/// @file pool.h
/// The library's own threads: as many as there are workers, less the caller's, which is worker 0.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_POOL_H
#define MSPRINGI_POOL_H

#include "base/memory.h"

typedef struct mspringi_pool mspringi_pool;

/// Start worker_count - 1 threads.
/// @return MSPRING_OK; MSPRING_ERROR_MEMORY, MSPRING_ERROR_THREAD
mspring_result mspringi_pool_create(uint32_t worker_count, mspringi_memory *memory, mspringi_message *message,
                                    mspringi_pool **pool);

/// Start the threads again if this is a child that fork() has made since they were: the parent's are not in it.
/// Nobody may be in mspringi_pool_run() when the process forks.
/// @return MSPRING_OK; MSPRING_ERROR_THREAD, then nothing runs, and the next call tries again
mspring_result mspringi_pool_restart_after_fork(mspringi_pool *pool, mspringi_message *message);

/// End the threads; in a child that has not started them again there are none. NULL is allowed.
void mspringi_pool_destroy(mspringi_pool *pool, mspringi_memory *memory);

/// Run fn(argument, index, worker) for all index below count, index i on worker i % worker_count, and return when
/// all are done. As many as there are workers run at the same time.
void mspringi_pool_run(mspringi_pool *pool, uint32_t count, mspring_task_fn fn, void *argument);

#endif
