/// @file allocator.c
///
/// SPDX-License-Identifier: MIT
#include "allocator.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/// A vector of the widest instruction set and then some: a kernel that stores one vector too far hits it.
#define GUARD 256
#define GUARD_BYTE 0xc5
#define FRESH_BYTE 0xa7 // as floats: -4.7e-15, as ids: far out of range
#define LIVE_MARK 0x6c697665u

/// Lies right below the guard in front of the block.
typedef struct block_head {
    void *base;
    size_t size;
    uint32_t mark;
} block_head;

static block_head *head_of(unsigned char *memory) {
    return (block_head *)(void *)(memory - GUARD - ((sizeof(block_head) + 63) & ~(size_t)63));
}

static void *watched_alloc(size_t size, size_t alignment, void *user) {
    watched_allocator *watched = user;
    watched->calls++;
    if (alignment == 0 || (alignment & (alignment - 1)) != 0 || alignment > 64) {
        watched->bad_asks++;
        return NULL;
    }
    if (watched->calls == watched->fail_at) {
        return NULL;
    }

    size_t step = alignment < sizeof(void *) ? sizeof(void *) : alignment;
    size_t front = GUARD + ((sizeof(block_head) + 63) & ~(size_t)63);
    unsigned char *base = malloc(front + 2 * step + size + GUARD);
    if (base == NULL) {
        return NULL;
    }
    // An odd multiple of the alignment.
    uintptr_t address = ((uintptr_t)(base + front) + step - 1) / step * step;
    if (address / step % 2 == 0) {
        address += step;
    }
    unsigned char *memory = base + (address - (uintptr_t)base);
    memset(memory - GUARD, GUARD_BYTE, GUARD);
    memset(memory, FRESH_BYTE, size);
    memset(memory + size, GUARD_BYTE, GUARD);
    *head_of(memory) = (block_head){.base = base, .size = size, .mark = LIVE_MARK};
    watched->live++;
    watched->live_bytes += size;
    return memory;
}

static int guard_intact(const unsigned char *guard) {
    for (size_t i = 0; i < GUARD; i++) {
        if (guard[i] != GUARD_BYTE) {
            return 0;
        }
    }
    return 1;
}

static void watched_free(void *memory, size_t size, void *user) {
    watched_allocator *watched = user;
    if (memory == NULL) {
        watched->foreign++;
        return;
    }
    block_head *head = head_of(memory);
    if (head->mark != LIVE_MARK) {
        watched->foreign++;
        return;
    }
    if (head->size != size) {
        watched->wrong_size++;
    }
    unsigned char *bytes = memory;
    if (!guard_intact(bytes - GUARD) || !guard_intact(bytes + head->size)) {
        watched->damaged++;
    }
    head->mark = 0;
    watched->live--;
    watched->live_bytes -= head->size;
    free(head->base);
}

mspring_allocator watched_interface(watched_allocator *watched) {
    return (mspring_allocator){
        .struct_size = sizeof(mspring_allocator), .alloc = watched_alloc, .free = watched_free, .user = watched};
}

void support_check_watched(const watched_allocator *watched, const char *file, int line) {
    if (watched->live != 0 || watched->live_bytes != 0 || watched->damaged != 0 || watched->wrong_size != 0 ||
        watched->foreign != 0 || watched->bad_asks != 0) {
        print_error("allocator: %zu blocks (%zu bytes) not freed, %zu damaged, %zu freed with a wrong size, "
                    "%zu foreign frees, %zu bad alignments\n",
                    watched->live, watched->live_bytes, watched->damaged, watched->wrong_size, watched->foreign,
                    watched->bad_asks);
        _fail(file, line);
    }
}
