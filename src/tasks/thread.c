#if !defined(_WIN32) && !defined(__APPLE__)
#define _POSIX_C_SOURCE 200809L // signals, which strict C11 hides
#endif

#include "tasks/thread.h"

#if defined(MSPRINGI_THREADS)

#if defined(_WIN32)

#include <process.h>

static unsigned __stdcall thread_main(void *argument) {
    const mspringi_thread_start *start = argument;
    start->fn(start->argument);
    return 0;
}

uint64_t mspringi_process(void) {
    return 0;
}

bool mspringi_thread_create(mspringi_thread *thread, mspringi_thread_start *start) {
    *thread = (HANDLE)_beginthreadex(NULL, 0, thread_main, start, 0, NULL);
    return *thread != NULL;
}

void mspringi_thread_join(mspringi_thread thread) {
    WaitForSingleObject(thread, INFINITE);
    CloseHandle(thread);
}

bool mspringi_mutex_init(mspringi_mutex *mutex) {
    InitializeSRWLock(mutex);
    return true;
}

void mspringi_mutex_destroy(mspringi_mutex *mutex) {
    (void)mutex;
}

void mspringi_mutex_lock(mspringi_mutex *mutex) {
    AcquireSRWLockExclusive(mutex);
}

void mspringi_mutex_unlock(mspringi_mutex *mutex) {
    ReleaseSRWLockExclusive(mutex);
}

bool mspringi_condition_init(mspringi_condition *condition) {
    InitializeConditionVariable(condition);
    return true;
}

void mspringi_condition_destroy(mspringi_condition *condition) {
    (void)condition;
}

void mspringi_condition_wait(mspringi_condition *condition, mspringi_mutex *mutex) {
    SleepConditionVariableSRW(condition, mutex, INFINITE, 0);
}

void mspringi_condition_wake_all(mspringi_condition *condition) {
    WakeAllConditionVariable(condition);
}

#else

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

uint64_t mspringi_process(void) {
    return (uint64_t)getpid();
}

static void *thread_main(void *argument) {
    const mspringi_thread_start *start = argument;
    start->fn(start->argument);
    return NULL;
}

bool mspringi_thread_create(mspringi_thread *thread, mspringi_thread_start *start) {
    // A thread inherits the signal mask of its creator.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int error = pthread_create(thread, NULL, thread_main, start);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return error == 0;
}

void mspringi_thread_join(mspringi_thread thread) {
    pthread_join(thread, NULL);
}

bool mspringi_mutex_init(mspringi_mutex *mutex) {
    return pthread_mutex_init(mutex, NULL) == 0;
}

void mspringi_mutex_destroy(mspringi_mutex *mutex) {
    pthread_mutex_destroy(mutex);
}

void mspringi_mutex_lock(mspringi_mutex *mutex) {
    pthread_mutex_lock(mutex);
}

void mspringi_mutex_unlock(mspringi_mutex *mutex) {
    pthread_mutex_unlock(mutex);
}

bool mspringi_condition_init(mspringi_condition *condition) {
    return pthread_cond_init(condition, NULL) == 0;
}

void mspringi_condition_destroy(mspringi_condition *condition) {
    pthread_cond_destroy(condition);
}

void mspringi_condition_wait(mspringi_condition *condition, mspringi_mutex *mutex) {
    pthread_cond_wait(condition, mutex);
}

void mspringi_condition_wake_all(mspringi_condition *condition) {
    pthread_cond_broadcast(condition);
}

#endif

#else

// Strict C allows no empty file.
typedef int mspringi_no_threads;

#endif
