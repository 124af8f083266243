/// @file memory.h
/// Memory through the host's allocator, counted, and overflow-checked sizes.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MEMORY_H
#define MSPRINGI_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/message.h"

/// Alignment of every block of more than half of it: a cache line, and the widest vector register.
#define MSPRINGI_ALIGNMENT 64

/// An allocator and what has been taken from it: all blocks that have not been freed, in the order in which they
/// were taken. May be copied, but only one of the copies used on.
typedef struct mspringi_memory {
    mspring_allocator allocator;
    size_t used;
    struct mspringi_block *first, *last;
    struct mspringi_memory *bin; ///< of the same allocator, or NULL: what is freed goes there, to be freed later
} mspringi_memory;

/// Copy the host's allocator, or take malloc and free for NULL.
mspring_result mspringi_memory_init(mspringi_memory *memory, const mspring_allocator *allocator,
                                    mspringi_message *message);

/// count * size bytes set to zero, or NULL if the product overflows or the allocator has none. Zero bytes give
/// a block too, so that NULL always means failure.
void *mspringi_alloc(mspringi_memory *memory, size_t count, size_t size);

/// The same, but nothing is set: for much memory that is set in pieces.
void *mspringi_alloc_unset(mspringi_memory *memory, size_t count, size_t size);

/// A copy of a block of any memory, or NULL. NULL is allowed.
void *mspringi_memory_duplicate(mspringi_memory *memory, const void *contents);

/// Free a block of mspringi_alloc(); NULL is allowed.
void mspringi_free(mspringi_memory *memory, void *block);

/// Free all blocks.
void mspringi_free_all(mspringi_memory *memory);

/// Hand all blocks over to another memory with the same allocator.
void mspringi_memory_hand_over(mspringi_memory *from, mspringi_memory *to);

/// Copy all blocks of a memory, with what is in them, into one that has none yet, in the same order.
/// @return false: the allocator has no more; those copied so far are in to
bool mspringi_memory_copy(const mspringi_memory *from, mspringi_memory *to);

/// What was at pointer in one of from's blocks is here in to, which has mspringi_memory_copy() of them. NULL for
/// NULL.
void *mspringi_memory_moved(const mspringi_memory *from, const mspringi_memory *to, const void *pointer);

/// Make room in a growing array of *capacity elements for needed of them, at least doubling it. False: no
/// memory, and the array is as it was.
bool mspringi_grow(mspringi_memory *memory, void **array, size_t *capacity, size_t needed, size_t size);

#endif
