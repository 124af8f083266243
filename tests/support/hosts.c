/// @file hosts.c
///
/// SPDX-License-Identifier: MIT
#include "hosts.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

static void run_in_order(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    host *self = user;
    self->runs++;
    for (uint32_t i = 0; i < count; i++) {
        fn(argument, i, i % self->tasks.worker_count);
    }
}

static void run_in_reverse(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    host *self = user;
    self->runs++;
    for (uint32_t i = count; i-- > 0;) {
        fn(argument, i, self->tasks.worker_count - 1 - i % self->tasks.worker_count);
    }
}

static void run_from_both_ends(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    host *self = user;
    self->runs++;
    for (uint32_t i = 0; i < count; i++) {
        fn(argument, i % 2 == 0 ? i / 2 : count - 1 - i / 2, i % self->tasks.worker_count);
    }
}

typedef struct chunk {
    mspring_task_fn fn;
    void *argument;
    uint32_t first, end, worker;
    int flush;
} chunk;

static void *run_chunk(void *argument) {
    const chunk *part = argument;
#if defined(__SSE2__)
    if (part->flush) {
        _mm_setcsr(_mm_getcsr() | 0x8040); // flush results and operands
    }
#endif
    for (uint32_t i = part->first; i < part->end; i++) {
        part->fn(part->argument, i, part->worker);
    }
    return NULL;
}

/// All chunks but the first on new threads.
static void run_chunks(chunk *parts, uint32_t count) {
    pthread_t *threads = calloc(count, sizeof *threads);
    for (uint32_t i = 1; i < count; i++) {
        if (threads == NULL || pthread_create(&threads[i], NULL, run_chunk, &parts[i]) != 0) {
            abort();
        }
    }
    run_chunk(&parts[0]);
    for (uint32_t i = 1; i < count; i++) {
        pthread_join(threads[i], NULL);
    }
    free(threads);
}

static void run_in_chunks(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    host *self = user;
    self->runs++;
    const uint32_t middle = (count + 1) / 2;
    chunk parts[] = {{fn, argument, middle, count, 1, 0}, {fn, argument, 0, middle, 0, 0}};
    run_chunks(parts, 2);
}

static void run_at_once(uint32_t count, mspring_task_fn fn, void *argument, host *self, int flush) {
    self->runs++;
    const uint32_t workers = self->tasks.worker_count < count ? self->tasks.worker_count : count;
    chunk *parts = calloc(workers, sizeof *parts);
    if (parts == NULL) {
        abort();
    }
    for (uint32_t w = 0; w < workers; w++) {
        parts[w] = (chunk){fn, argument, count * w / workers, count * (w + 1) / workers, w, flush && w > 0};
    }
    run_chunks(parts, workers);
    free(parts);
}

static void run_on_threads(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    run_at_once(count, fn, argument, user, 0);
}

static void run_on_flushing_threads(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    run_at_once(count, fn, argument, user, 1);
}

void hosts_fill(host hosts[HOST_COUNT], uint32_t worker_count) {
    const struct {
        const char *name;
        void (*run)(uint32_t, mspring_task_fn, void *, void *);
        int at_once;
    } kinds[HOST_COUNT] = {{"in order", run_in_order, 0},
                           {"in reverse", run_in_reverse, 0},
                           {"from both ends", run_from_both_ends, 0},
                           {"in chunks", run_in_chunks, 0},
                           {"on threads", run_on_threads, 1},
                           {"on flushing threads", run_on_flushing_threads, 1}};
    for (int i = 0; i < HOST_COUNT; i++) {
        hosts[i] = (host){.name = kinds[i].name,
                          .tasks = {.struct_size = sizeof hosts[i].tasks,
                                    .worker_count = worker_count,
                                    .concurrent_count = kinds[i].at_once ? worker_count : 1,
                                    .run = kinds[i].run,
                                    .user = &hosts[i]}};
    }
}
