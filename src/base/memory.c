#if !defined(_WIN32) && !defined(__APPLE__) && !defined(_POSIX_C_SOURCE)
#define _POSIX_C_SOURCE 200809L // posix_memalign, hidden in strict C
#endif

#include "base/memory.h"

#include <string.h>

#include "base/assert.h"
#include "base/structs.h"

#if !defined(MSPRINGI_FREESTANDING)
#include <stdlib.h>
#if defined(_WIN32)
#include <malloc.h>
#endif
#endif

/// Header of a block, with its size for the allocator's free function.
typedef struct mspringi_block {
    struct mspringi_block *previous, *next;
    size_t size; ///< with this header: one alignment unit, or half of it if the block is a single unit
} block;

/// Half of an alignment unit: room for a header, or for contents that no vector load reads.
#define HALF (MSPRINGI_ALIGNMENT / 2)
_Static_assert(sizeof(block) <= HALF, "a header takes half of a unit");

/// Fewest elements of a growing array: a network of few particles has few rows.
#define MIN_ELEMENTS 8

#if !defined(MSPRINGI_FREESTANDING)

static void *default_alloc(size_t size, size_t alignment, void *user) {
    (void)user;
#if defined(_WIN32)
    return _aligned_malloc(size, alignment);
#else
    void *memory;
    return posix_memalign(&memory, alignment, size) == 0 ? memory : NULL;
#endif
}

static void default_free(void *memory, size_t size, void *user) {
    (void)size;
    (void)user;
#if defined(_WIN32)
    _aligned_free(memory);
#else
    free(memory);
#endif
}

#endif

mspring_result mspringi_memory_init(mspringi_memory *memory, const mspring_allocator *allocator,
                                    mspringi_message *message) {
#if defined(MSPRINGI_FREESTANDING)
    if (!allocator)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "this build has no malloc: give an allocator");
    mspring_allocator used = {0};
#else
    mspring_allocator used = {.alloc = default_alloc, .free = default_free};
#endif
    if (allocator) {
        mspring_result result = mspringi_take_allocator(message, &allocator, &used);
        if (result == MSPRING_OK)
            result = mspringi_check_reserved(message, "mspring_allocator", allocator->reserved);
        if (result != MSPRING_OK)
            return result;
        if (!allocator->alloc || !allocator->free)
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "alloc or free of mspring_allocator is NULL");
    }
    *memory = (mspringi_memory){.allocator = used};
    return MSPRING_OK;
}

static void append(mspringi_memory *memory, block *taken, size_t size) {
    *taken = (block){.previous = memory->last, .size = size};
    if (memory->last)
        memory->last->next = taken;
    else
        memory->first = taken;
    memory->last = taken;
    memory->used += size;
}

// Allocate a block of this size, header included.
static block *take(mspringi_memory *memory, size_t size) {
    block *taken = memory->allocator.alloc(size, MSPRINGI_ALIGNMENT, memory->allocator.user);
    if (taken)
        append(memory, taken, size);
    return taken;
}

static void give_back(mspringi_memory *memory, block *taken) {
    // Neither freed already nor of another memory.
    MSPRINGI_ASSERT(taken->previous ? taken->previous->next == taken : memory->first == taken);
    MSPRINGI_ASSERT(taken->next ? taken->next->previous == taken : memory->last == taken);
    if (taken->previous)
        taken->previous->next = taken->next;
    else
        memory->first = taken->next;
    if (taken->next)
        taken->next->previous = taken->previous;
    else
        memory->last = taken->previous;
    memory->used -= taken->size;
    if (memory->bin)
        append(memory->bin, taken, taken->size);
    else
        memory->allocator.free(taken, taken->size, memory->allocator.user);
}

// Size of a block's header. Small networks have a dozen arrays of a few bytes; each shares a unit with its header.
static size_t header_of(size_t size) {
    return size > MSPRINGI_ALIGNMENT ? MSPRINGI_ALIGNMENT : HALF;
}

static char *contents_of(const block *of) {
    return (char *)of + header_of(of->size);
}

static size_t room_of(const block *of) {
    return of->size - header_of(of->size);
}

static block *block_of(const void *contents) {
    const size_t header = (uintptr_t)contents % MSPRINGI_ALIGNMENT == 0 ? MSPRINGI_ALIGNMENT : HALF;
    return (block *)(void *)((char *)(uintptr_t)contents - header);
}

// Size of a block: whole units, so that each block ends where the next may begin; 0 on overflow.
static size_t size_of(size_t count, size_t size) {
    if (size != 0 && count > (SIZE_MAX - 2 * MSPRINGI_ALIGNMENT) / size)
        return 0;
    return count * size <= HALF
               ? MSPRINGI_ALIGNMENT
               : (count * size + 2 * MSPRINGI_ALIGNMENT - 1) / MSPRINGI_ALIGNMENT * MSPRINGI_ALIGNMENT;
}

void *mspringi_alloc_unset(mspringi_memory *memory, size_t count, size_t size) {
    const size_t total = size_of(count, size);
    const block *taken = total > 0 ? take(memory, total) : NULL;
    return taken ? contents_of(taken) : NULL;
}

void *mspringi_alloc(mspringi_memory *memory, size_t count, size_t size) {
    void *taken = mspringi_alloc_unset(memory, count, size);
    return taken ? memset(taken, 0, room_of(block_of(taken))) : NULL;
}

void *mspringi_memory_duplicate(mspringi_memory *memory, const void *contents) {
    if (!contents)
        return NULL;
    const block *of = block_of(contents), *taken = take(memory, of->size);
    return taken ? memcpy(contents_of(taken), contents, room_of(of)) : NULL;
}

void mspringi_free(mspringi_memory *memory, void *contents) {
    if (contents)
        give_back(memory, block_of(contents));
}

void mspringi_free_all(mspringi_memory *memory) {
    while (memory->last)
        give_back(memory, memory->last);
}

void mspringi_memory_hand_over(mspringi_memory *from, mspringi_memory *to) {
    MSPRINGI_ASSERT(from->allocator.user == to->allocator.user && from->allocator.free == to->allocator.free);
    if (!from->first)
        return;
    from->first->previous = to->last;
    if (to->last)
        to->last->next = from->first;
    else
        to->first = from->first;
    to->last = from->last;
    to->used += from->used;
    from->first = from->last = NULL;
    from->used = 0;
}

bool mspringi_memory_copy(const mspringi_memory *from, mspringi_memory *to) {
    MSPRINGI_ASSERT(!to->first);
    for (const block *of = from->first; of; of = of->next) {
        const block *copy = take(to, of->size);
        if (!copy)
            return false;
        memcpy(contents_of(copy), contents_of(of), room_of(of));
    }
    return true;
}

void *mspringi_memory_relocate(const mspringi_memory *from, const mspringi_memory *to, const void *pointer) {
    const uintptr_t place = (uintptr_t)pointer;
    const block *copy = to->first;
    for (const block *of = from->first; pointer && of; of = of->next, copy = copy->next) {
        MSPRINGI_ASSERT(copy && copy->size >= of->size);
        // The end counts, too: an empty array may begin where its block ends.
        const uintptr_t begin = (uintptr_t)contents_of(of), end = (uintptr_t)of + of->size;
        if (place >= begin && place <= end)
            return contents_of(copy) + (place - begin);
    }
    MSPRINGI_ASSERT(!pointer); // in none of from's blocks
    return NULL;
}

bool mspringi_grow(mspringi_memory *memory, void **array, size_t *capacity, size_t needed, size_t size) {
    if (needed <= *capacity)
        return true;
    size_t target = *capacity < SIZE_MAX / 2 ? *capacity * 2 : SIZE_MAX;
    if (target < needed)
        target = needed;
    if (target < MIN_ELEMENTS)
        target = MIN_ELEMENTS;
    void *grown = mspringi_alloc(memory, target, size);
    if (!grown)
        return false;
    if (*array)
        memcpy(grown, *array, *capacity * size);
    mspringi_free(memory, *array);
    *array = grown;
    *capacity = target;
    return true;
}
