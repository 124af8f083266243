/// @file fail_nth.h
/// A life that calls every function that allocates, call by call.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_FAIL_NTH_H
#define TEST_FAIL_NTH_H

#include "allocator.h"
#include "recipe.h"

typedef struct life {
    watched_allocator watched;
    mspring_allocator allocator;
    mspring_builder *builder;
    mspring_network *network, *clone;
    recipe made;
    unsigned char *snapshot;
    size_t snapshot_size;
    mspring_id added;  ///< particle that was added to the network
    uint32_t failures; ///< calls that failed and were made again
    size_t *ends;      ///< [life_call_count] how many allocations there were after each, of a life without failure
    size_t fail_at;
} life;

typedef struct life_call {
    const char *name;
    mspring_result (*call)(life *l);
} life_call;

extern const life_call life_calls[]; ///< in their order
extern const size_t life_call_count;

#endif
