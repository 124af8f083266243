/// @file glue.c
/// What JavaScript needs beside the library's own functions: memory, and many steps in one call.
///
/// SPDX-License-Identifier: MIT
#include "environment.h"

#include <massspring/massspring.h>

/// Return a block of memory, or NULL.
void *massspring_take(size_t size);
void *massspring_take(size_t size) {
    return environment_allocator.alloc(size, 64, NULL);
}

/// Free a block of that size.
void massspring_leave(void *memory, size_t size);
void massspring_leave(void *memory, size_t size) {
    environment_allocator.free(memory, size, NULL);
}

/// Make a builder, and a network, with that memory.
mspring_result massspring_builder(mspring_builder **builder);
mspring_result massspring_builder(mspring_builder **builder) {
    return mspring_builder_create(&environment_allocator, builder);
}

mspring_result massspring_network(mspring_builder *builder, mspring_network_def *def, mspring_network **network);
mspring_result massspring_network(mspring_builder *builder, mspring_network_def *def, mspring_network **network) {
    def->allocator = &environment_allocator;
    return mspring_network_create(builder, def, network);
}

/// Take steps until one fails.
/// @param done  receives how many were taken
mspring_result massspring_steps(mspring_network *network, double dt, uint32_t count, uint32_t *done);
mspring_result massspring_steps(mspring_network *network, double dt, uint32_t count, uint32_t *done) {
    mspring_result result = MSPRING_OK;
    for (*done = 0; *done < count; ++*done) {
        result = mspring_network_step(network, dt);
        if (result != MSPRING_OK)
            break;
    }
    return result;
}

typedef struct bytes {
    unsigned char *to; ///< NULL: only count them
    size_t size;
} bytes;

static mspring_result append(const void *piece, size_t size, void *user) {
    bytes *all = user;
    for (size_t i = 0; all->to && i < size; ++i)
        all->to[all->size + i] = ((const unsigned char *)piece)[i];
    all->size += size;
    return MSPRING_OK;
}

/// Write an archive to memory.
/// @param to    NULL: only count the bytes
/// @param size  receives their number
mspring_result massspring_archive(const mspring_network *network, unsigned char *to, size_t *size);
mspring_result massspring_archive(const mspring_network *network, unsigned char *to, size_t *size) {
    bytes all = {to, 0};
    const mspring_result result = mspring_network_write(network, append, &all);
    *size = all.size;
    return result;
}
