/// @file hosts.h
/// Thread pools as hosts have them: good ones, slow ones, and ones that do everything on one thread.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_HOSTS_H
#define TEST_HOSTS_H

#include <stdint.h>

#include <massspring/massspring.h>

typedef struct host {
    const char *name;
    mspring_tasks tasks;
    uint32_t runs; ///< calls of tasks.run
} host;

enum { HOST_COUNT = 6 };

/// The hosts, with worker_count workers each: in order, in reverse and from both ends on the caller's thread; in
/// chunks on two threads; each body on a new thread; each body on a new thread that flushes denormal
/// numbers to zero (where that can be had). The last two run all bodies at the same time.
void hosts_fill(host hosts[HOST_COUNT], uint32_t worker_count);

#endif
