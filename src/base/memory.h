/// @file memory.h
/// Memory from the host's allocator: counted, with sizes checked for overflow.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MEMORY_H
#define MSPRINGI_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/message.h"

/// Alignment of every block larger than half of it: a cache line, and the widest vector register.
#define MSPRINGI_ALIGNMENT 64

/// An allocator and its live blocks, in the order of allocation. May be copied if only one of the copies is used
/// afterwards.
typedef struct mspringi_memory {
    mspring_allocator allocator;
    size_t used;
    struct mspringi_block *first, *last;
    struct mspringi_memory *bin; ///< of the same allocator, or NULL: receives freed blocks, to be freed later
} mspringi_memory;

/// Copy the host's allocator; NULL selects malloc and free.
mspring_result mspringi_memory_init(mspringi_memory *memory, const mspring_allocator *allocator,
                                    mspringi_message *message);

/// Allocate count * size bytes, set to zero. Return NULL if the product overflows or memory is out. Zero bytes give
/// a block, too, so NULL always means failure.
void *mspringi_alloc(mspringi_memory *memory, size_t count, size_t size);

/// Allocate without setting bytes, for large memory that is set in pieces.
void *mspringi_alloc_unset(mspringi_memory *memory, size_t count, size_t size);

/// Copy a block of any memory; NULL if memory is out. NULL is allowed.
void *mspringi_memory_duplicate(mspringi_memory *memory, const void *contents);

/// Free a block of mspringi_alloc(); NULL is allowed.
void mspringi_free(mspringi_memory *memory, void *block);

/// Free all blocks.
void mspringi_free_all(mspringi_memory *memory);

/// Move all blocks to another memory with the same allocator.
void mspringi_memory_hand_over(mspringi_memory *from, mspringi_memory *to);

/// Copy all blocks, with their contents and in their order, to a memory without blocks. @return false if memory is
/// out; then `to` owns the blocks copied so far
bool mspringi_memory_copy(const mspringi_memory *from, mspringi_memory *to);

/// Pointer into the copy of a block, from the pointer into the original; NULL for NULL. `to` is a
/// mspringi_memory_copy() of `from`.
void *mspringi_memory_relocate(const mspringi_memory *from, const mspringi_memory *to, const void *pointer);

/// Grow an array of *capacity elements to at least `needed`, at least doubling it. Return false if memory is out;
/// the array is then unchanged.
bool mspringi_grow(mspringi_memory *memory, void **array, size_t *capacity, size_t needed, size_t size);

#endif
