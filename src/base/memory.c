#include "memory.h"

#include <string.h>

#if !defined(MSPRINGI_FREESTANDING)
#include <stdlib.h>
#if defined(_WIN32)
#include <malloc.h>
#endif
#endif

/// In front of every block, so that the size that was asked for is known when it is freed.
typedef struct block_header {
    size_t size;
} block_header;

#if !defined(MSPRINGI_FREESTANDING)

static void *default_alloc(size_t size, size_t alignment, void *user) {
    (void)user;
#if defined(_WIN32)
    return _aligned_malloc(size, alignment);
#else
    return aligned_alloc(alignment, size);
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
    const mspring_allocator defaults = {.struct_size = sizeof defaults};
#else
    const mspring_allocator defaults = {
        .struct_size = sizeof defaults, .alloc = default_alloc, .free = default_free};
#endif
    if (allocator) {
        mspring_result result = mspringi_check_struct(message, "mspring_allocator", allocator->struct_size,
                                                      sizeof *allocator, sizeof *allocator);
        if (result != MSPRING_OK)
            return result;
        if (!allocator->alloc || !allocator->free)
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "mspring_allocator lacks alloc or free");
    }
    memory->allocator = allocator ? *allocator : defaults;
    memory->used = 0;
    return MSPRING_OK;
}

void *mspringi_alloc(mspringi_memory *memory, size_t count, size_t size) {
    if (size != 0 && count > (SIZE_MAX - 2 * MSPRINGI_ALIGNMENT) / size)
        return NULL;
    // The header takes one alignment unit; whole units are what aligned_alloc asks for.
    const size_t total = (count * size + 2 * MSPRINGI_ALIGNMENT - 1) / MSPRINGI_ALIGNMENT * MSPRINGI_ALIGNMENT;
    char *raw = memory->allocator.alloc(total, MSPRINGI_ALIGNMENT, memory->allocator.user);
    if (!raw)
        return NULL;
    memset(raw, 0, total);
    ((block_header *)(void *)raw)->size = total;
    memory->used += total;
    return raw + MSPRINGI_ALIGNMENT;
}

void mspringi_free(mspringi_memory *memory, void *block) {
    if (!block)
        return;
    char *raw = (char *)block - MSPRINGI_ALIGNMENT;
    const size_t total = ((block_header *)(void *)raw)->size;
    memory->used -= total;
    memory->allocator.free(raw, total, memory->allocator.user);
}

bool mspringi_grow(mspringi_memory *memory, void **array, size_t *capacity, size_t needed, size_t size) {
    if (needed <= *capacity)
        return true;
    size_t target = *capacity < SIZE_MAX / 2 ? *capacity * 2 : SIZE_MAX;
    if (target < needed)
        target = needed;
    if (target < 64)
        target = 64;
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
