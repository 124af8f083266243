/// @file thread_pool.h
/// Threads of a host, as a game has them anyway, lent to networks by mspring_tasks.
///
/// SPDX-License-Identifier: MIT
#ifndef COMMON_THREAD_POOL_H
#define COMMON_THREAD_POOL_H

#include <massspring/massspring.h>

typedef struct thread_pool thread_pool;

/// Start a pool of so many threads, the caller's being one of them. NULL if there is no memory or no thread.
thread_pool *thread_pool_create(uint32_t threads);
void thread_pool_destroy(thread_pool *pool);

/// What a network's definition wants to know of it. The pool must outlive the network.
mspring_tasks thread_pool_tasks(thread_pool *pool);

/// Calls of its parallel-for so far.
uint64_t thread_pool_runs(const thread_pool *pool);

#endif
