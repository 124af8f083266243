/// @file allocator.h
/// An allocator that watches its user: it counts, fails on demand, and finds writes outside of a block, sizes that
/// differ between alloc and free, and blocks that are never freed. Blocks are aligned to what was asked for and to
/// no more, and filled with a pattern, so that code which counts on more alignment or on zeros is found out.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_ALLOCATOR_H
#define TEST_ALLOCATOR_H

#include <stddef.h>

#include <massspring/massspring.h>

typedef struct watched_allocator {
    size_t calls;      ///< allocations asked for
    size_t fail_at;    ///< number of the call that gets NULL, counted from 1; 0: none
    size_t live;       ///< blocks not freed
    size_t live_bytes; ///< in them
    size_t damaged;    ///< blocks whose surroundings had been written to when they were freed
    size_t wrong_size; ///< frees with another size than asked for
    size_t foreign;    ///< frees of NULL or of what this allocator did not make
    size_t bad_asks;   ///< alignments that are no power of two or above 64
} watched_allocator;

/// The library's view of it. The watched_allocator must outlive the objects made with it.
mspring_allocator watched_interface(watched_allocator *watched);

/// Everything was freed, and nothing wrong was seen.
#define check_watched_clean(watched) support_check_watched((watched), __FILE__, __LINE__)

void support_check_watched(const watched_allocator *watched, const char *file, int line);

#endif
