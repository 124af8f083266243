/// @file thread.h
/// Threads, locks and conditions of the platform: POSIX or Windows. MSPRINGI_THREADS is undefined, and this header
/// empty, if the build found neither.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_THREAD_H
#define MSPRINGI_THREAD_H

#if defined(MSPRINGI_THREADS)

#include <stdbool.h>
#include <stdint.h>

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
typedef HANDLE mspringi_thread;
typedef SRWLOCK mspringi_mutex;
typedef CONDITION_VARIABLE mspringi_condition;
#else
#include <pthread.h>
typedef pthread_t mspringi_thread;
typedef pthread_mutex_t mspringi_mutex;
typedef pthread_cond_t mspringi_condition;
#endif

/// Start of a thread. Must outlive it.
typedef struct mspringi_thread_start {
    void (*fn)(void *argument);
    void *argument;
} mspringi_thread_start;

/// Number of this process. After fork(), the child has another one and only the caller's thread. Constant on
/// platforms without fork().
uint64_t mspringi_process(void);

/// Start a thread that blocks all signals, so that the host's threads handle them. Return false if the system has
/// no more.
bool mspringi_thread_create(mspringi_thread *thread, mspringi_thread_start *start);
void mspringi_thread_join(mspringi_thread thread);

bool mspringi_mutex_init(mspringi_mutex *mutex);
void mspringi_mutex_destroy(mspringi_mutex *mutex);
void mspringi_mutex_lock(mspringi_mutex *mutex);
void mspringi_mutex_unlock(mspringi_mutex *mutex);

bool mspringi_condition_init(mspringi_condition *condition);
void mspringi_condition_destroy(mspringi_condition *condition);
/// Release the mutex and wait. May wake up spuriously.
void mspringi_condition_wait(mspringi_condition *condition, mspringi_mutex *mutex);
void mspringi_condition_wake_all(mspringi_condition *condition);

#endif

#endif
