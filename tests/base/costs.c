/// @file costs.c
///
/// SPDX-License-Identifier: MIT
#if !defined(_GNU_SOURCE)
#define _GNU_SOURCE // syscall()
#endif
#include "costs.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "support.h"

#if defined(__linux__)
#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

/// Size of what lies in front of a block: a multiple of the largest alignment.
#define HEAD 64

static void *counted_alloc(size_t size, size_t alignment, void *user) {
    costs *c = user;
    uint8_t *base = support_aligned_alloc((size + 2 * HEAD - 1) / HEAD * HEAD);
    (void)alignment;
    memcpy(base, &size, sizeof size);
    c->live += size;
    c->most = c->live > c->most ? c->live : c->most;
    return base + HEAD;
}

static void counted_free(void *memory, size_t size, void *user) {
    costs *c = user;
    c->live -= size;
    support_aligned_free((uint8_t *)memory - HEAD);
}

void costs_open(costs *c) {
    memset(c, 0, sizeof *c);
    check_ok(mspring_init(MSPRING_STRUCT_ALLOCATOR, &c->allocator, sizeof c->allocator));
    c->allocator.alloc = counted_alloc;
    c->allocator.free = counted_free;
    c->allocator.user = c;
}

// A counter of this thread's instructions, or -1.
static int counter(void) {
    static int file = -2;
#if defined(__linux__)
    if (file == -2) {
        struct perf_event_attr how = {.type = PERF_TYPE_HARDWARE,
                                      .size = sizeof how,
                                      .config = PERF_COUNT_HW_INSTRUCTIONS,
                                      .exclude_kernel = 1,
                                      .exclude_hv = 1};
        file = (int)syscall(SYS_perf_event_open, &how, 0, -1, -1, 0UL);
    }
#endif
    return file < 0 ? -1 : file;
}

bool costs_are_instructions(void) {
    return counter() >= 0;
}

static double now(void) {
#if defined(__linux__)
    uint64_t count;
    if (counter() >= 0 && read(counter(), &count, sizeof count) == sizeof count) {
        return (double)count;
    }
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
#else
    return (double)clock() / CLOCKS_PER_SEC;
#endif
}

void costs_begin(costs *c) {
    c->most = c->live;
    c->start = now();
}

void costs_end(costs *c) {
    c->work += now() - c->start;
    c->bytes = (double)c->most;
}
