/// @file parallel.c
/// A thread that waits for jobs; without threads, none.
///
/// SPDX-License-Identifier: MIT
#include "lab/parallel.h"

#include <stddef.h>

#ifdef LAB_PTHREADS

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

struct lab_helper {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    lab_job job;
    void *argument;
    bool busy, ends;
};

static void *serve(void *user) {
    lab_helper *helper = user;
    pthread_mutex_lock(&helper->lock);
    for (;;) {
        while (!helper->busy && !helper->ends)
            pthread_cond_wait(&helper->changed, &helper->lock);
        if (helper->ends)
            break;
        pthread_mutex_unlock(&helper->lock);
        helper->job(helper->argument);
        pthread_mutex_lock(&helper->lock);
        helper->busy = false;
        pthread_cond_broadcast(&helper->changed);
    }
    pthread_mutex_unlock(&helper->lock);
    return NULL;
}

lab_helper *helper_start(void) {
    lab_helper *made = calloc(1, sizeof *made);
    if (!made)
        return NULL;
    pthread_mutex_init(&made->lock, NULL);
    pthread_cond_init(&made->changed, NULL);
    if (pthread_create(&made->thread, NULL, serve, made) == 0)
        return made;
    pthread_cond_destroy(&made->changed);
    pthread_mutex_destroy(&made->lock);
    free(made);
    return NULL;
}

static void set(lab_helper *helper, lab_job job, void *argument) {
    pthread_mutex_lock(&helper->lock);
    helper->job = job;
    helper->argument = argument;
    helper->busy = job != NULL;
    helper->ends = job == NULL;
    pthread_cond_broadcast(&helper->changed);
    pthread_mutex_unlock(&helper->lock);
}

void helper_stop(lab_helper *unwanted) {
    if (!unwanted)
        return;
    set(unwanted, NULL, NULL);
    pthread_join(unwanted->thread, NULL);
    pthread_cond_destroy(&unwanted->changed);
    pthread_mutex_destroy(&unwanted->lock);
    free(unwanted);
}

void helper_run_both(lab_helper *helper, lab_job job, void *first, void *second) {
    if (helper)
        set(helper, job, second);
    job(first);
    if (!helper) {
        job(second);
        return;
    }
    pthread_mutex_lock(&helper->lock);
    while (helper->busy)
        pthread_cond_wait(&helper->changed, &helper->lock);
    pthread_mutex_unlock(&helper->lock);
}

#else

lab_helper *helper_start(void) {
    return NULL;
}

void helper_stop(lab_helper *unwanted) {
    (void)unwanted;
}

void helper_run_both(lab_helper *helper, lab_job job, void *first, void *second) {
    (void)helper;
    job(first);
    job(second);
}

#endif
