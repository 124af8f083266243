/// @file thread_pool.c
/// A parallel-for: one lock, one condition to wake up by, one to come home by.
///
/// SPDX-License-Identifier: MIT
#if !defined(_WIN32) && !defined(_POSIX_C_SOURCE)
#define _POSIX_C_SOURCE 200809L
#endif
#include "common/thread_pool.h"

#include <stdbool.h>
#include <stdlib.h>

#ifdef _WIN32
#include <windows.h>
typedef HANDLE thread_handle;
typedef CRITICAL_SECTION thread_lock;
typedef CONDITION_VARIABLE thread_signal;
#define LOCK(pool) EnterCriticalSection(&(pool)->lock)
#define UNLOCK(pool) LeaveCriticalSection(&(pool)->lock)
#define WAIT(pool, signal) SleepConditionVariableCS(&(pool)->signal, &(pool)->lock, INFINITE)
#define WAKE_ALL(pool, signal) WakeAllConditionVariable(&(pool)->signal)
#else
#include <pthread.h>
typedef pthread_t thread_handle;
typedef pthread_mutex_t thread_lock;
typedef pthread_cond_t thread_signal;
#define LOCK(pool) pthread_mutex_lock(&(pool)->lock)
#define UNLOCK(pool) pthread_mutex_unlock(&(pool)->lock)
#define WAIT(pool, signal) pthread_cond_wait(&(pool)->signal, &(pool)->lock)
#define WAKE_ALL(pool, signal) pthread_cond_broadcast(&(pool)->signal)
#endif

enum { MOST_THREADS = 64 };

typedef struct pool_thread {
    thread_pool *pool;
    uint32_t number;
    thread_handle handle;
} pool_thread;

struct thread_pool {
    thread_lock lock;
    thread_signal work, done;
    // The loop that is being run.
    mspring_task_fn fn;
    void *argument;
    uint32_t count, next, finished;
    uint64_t runs;
    bool ends;
    uint32_t thread_count; ///< with the caller's, which is number 0
    pool_thread threads[MOST_THREADS];
};

// Take one index after the other as long as there are any. The lock is held before and after, not during calls.
static void take_part(thread_pool *pool, uint32_t worker) {
    while (pool->next < pool->count) {
        const uint32_t index = pool->next++;
        UNLOCK(pool);
        pool->fn(pool->argument, index, worker);
        LOCK(pool);
        if (++pool->finished == pool->count)
            WAKE_ALL(pool, done);
    }
}

static void live(const pool_thread *thread) {
    thread_pool *pool = thread->pool;
    LOCK(pool);
    while (!pool->ends) {
        take_part(pool, thread->number);
        if (!pool->ends)
            WAIT(pool, work);
    }
    UNLOCK(pool);
}

#ifdef _WIN32
static DWORD WINAPI start_of_thread(void *argument) {
    live(argument);
    return 0;
}

static bool start_thread(pool_thread *thread) {
    thread->handle = CreateThread(NULL, 0, start_of_thread, thread, 0, NULL);
    return thread->handle != NULL;
}

static void join_thread(pool_thread *thread) {
    WaitForSingleObject(thread->handle, INFINITE);
    CloseHandle(thread->handle);
}

static void make_signals(thread_pool *pool) {
    InitializeCriticalSection(&pool->lock);
    InitializeConditionVariable(&pool->work);
    InitializeConditionVariable(&pool->done);
}

static void free_signals(thread_pool *pool) {
    DeleteCriticalSection(&pool->lock);
}
#else
static void *start_of_thread(void *argument) {
    live(argument);
    return NULL;
}

static bool start_thread(pool_thread *thread) {
    return pthread_create(&thread->handle, NULL, start_of_thread, thread) == 0;
}

static void join_thread(pool_thread *thread) {
    pthread_join(thread->handle, NULL);
}

static void make_signals(thread_pool *pool) {
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->work, NULL);
    pthread_cond_init(&pool->done, NULL);
}

static void free_signals(thread_pool *pool) {
    pthread_mutex_destroy(&pool->lock);
    pthread_cond_destroy(&pool->work);
    pthread_cond_destroy(&pool->done);
}
#endif

thread_pool *thread_pool_create(uint32_t threads) {
    thread_pool *pool = calloc(1, sizeof *pool);
    if (!pool)
        return NULL;
    make_signals(pool);
    pool->thread_count = 1;
    while (pool->thread_count < threads && pool->thread_count < MOST_THREADS) {
        pool_thread *thread = &pool->threads[pool->thread_count];
        *thread = (pool_thread){.pool = pool, .number = pool->thread_count};
        if (!start_thread(thread)) {
            thread_pool_destroy(pool);
            return NULL;
        }
        pool->thread_count++;
    }
    return pool;
}

void thread_pool_destroy(thread_pool *pool) {
    if (!pool)
        return;
    LOCK(pool);
    pool->ends = true;
    WAKE_ALL(pool, work);
    UNLOCK(pool);
    for (uint32_t i = 1; i < pool->thread_count; i++)
        join_thread(&pool->threads[i]);
    free_signals(pool);
    free(pool);
}

static void run(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    thread_pool *pool = user;
    LOCK(pool);
    pool->fn = fn;
    pool->argument = argument;
    pool->count = count;
    pool->next = pool->finished = 0;
    pool->runs++;
    WAKE_ALL(pool, work);
    take_part(pool, 0);
    while (pool->finished < pool->count)
        WAIT(pool, done);
    UNLOCK(pool);
}

mspring_tasks thread_pool_tasks(thread_pool *pool) {
    // Every thread that is free takes the next index at once, so as many as there are threads run at the same time.
    mspring_tasks tasks = mspring_tasks_default();
    tasks.worker_count = tasks.concurrent_count = pool->thread_count;
    tasks.run = run;
    tasks.user = pool;
    return tasks;
}

uint64_t thread_pool_runs(const thread_pool *pool) {
    return pool->runs;
}
