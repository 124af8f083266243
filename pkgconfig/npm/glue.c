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
