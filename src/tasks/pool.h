/// @file pool.h
/// The library's own threads: one for each worker but worker 0, the caller.
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

/// Start the threads again in a child process after fork(), which leaves the threads in the parent. No pool may be
/// running when the process forks.
/// @return MSPRING_OK; MSPRING_ERROR_THREAD, then nothing runs, and the next call tries again
mspring_result mspringi_pool_restart_after_fork(mspringi_pool *pool, mspringi_message *message);

/// End the threads. Only those of this process: a child that did not restart them has none. NULL is allowed.
void mspringi_pool_destroy(mspringi_pool *pool, mspringi_memory *memory);

/// Run fn(argument, index, worker) for each index below count, on worker index % worker_count, and return when all
/// are done. All workers run simultaneously.
void mspringi_pool_run(mspringi_pool *pool, uint32_t count, mspring_task_fn fn, void *argument);

#endif
