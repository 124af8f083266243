/// @file memory.h
/// Memory through the host's allocator, counted, and overflow-checked sizes.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MEMORY_H
#define MSPRINGI_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "message.h"

/// Alignment of every block: a cache line, and the widest vector register.
#define MSPRINGI_ALIGNMENT 64

/// An allocator and what has been taken from it.
typedef struct mspringi_memory {
    mspring_allocator allocator;
    size_t used;
} mspringi_memory;

/// Copy the host's allocator, or take malloc and free for NULL.
mspring_result mspringi_memory_init(mspringi_memory *memory, const mspring_allocator *allocator,
                                    mspringi_message *message);

/// count * size bytes set to zero, or NULL if the product overflows or the allocator has none. Zero bytes give
/// a block too, so that NULL always means failure.
void *mspringi_alloc(mspringi_memory *memory, size_t count, size_t size);

/// Free a block of mspringi_alloc(); NULL is allowed.
void mspringi_free(mspringi_memory *memory, void *block);

/// Make room in a growing array of *capacity elements for needed of them, at least doubling it. False: no
/// memory, and the array is as it was.
bool mspringi_grow(mspringi_memory *memory, void **array, size_t *capacity, size_t needed, size_t size);

#endif
