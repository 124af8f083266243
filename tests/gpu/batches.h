/// @file batches.h
/// Random batches for the tests of massspring_gpu: a network of equal bodies, each a group.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_GPU_BATCHES_H
#define TEST_GPU_BATCHES_H

#include <massspring/massspring_gpu.h>

#include "support.h"

typedef enum batch_shape {
    BATCH_LATTICE, ///< full, or with holes
    BATCH_CHAIN,
    BATCH_WEB,   ///< springs between any two
    BATCH_MIXED, ///< part lattice; where there are 64 bodies, most of these are all irregular
    BATCH_SHAPES
} batch_shape;

#define BATCH_ACTUATORS 12

typedef struct batch {
    uint64_t seed; ///< of what is drawn next
    batch_shape shape;
    uint32_t body_count, particle_count, spring_count; ///< the latter of a body
    uint32_t actuator_count, changes;
    mspring_id actuators[BATCH_ACTUATORS]; ///< of the first body
    double dt;                             ///< that suits the bodies, s
    mspring_network *network;
} batch;

/// Exit with 77 if there is no device that suits.
void batch_need_device(void);

/// Draw a batch of some shape. has_floor: with half-planes. is_plain: of at most 40 particles, and nothing is held.
batch batch_draw(uint64_t seed, batch_shape shape, bool has_floor, bool is_plain);

/// Make so many equal bodies, in the same place and at rest, above half-planes.
batch batch_of_copies(uint64_t seed, batch_shape shape, uint32_t count);
void batch_destroy(batch *b);

/// Make the same on a device, times this many bodies. NULL: bodies are laid out in several
/// ways, or slots don't tell how.
mspring_gpu *batch_on_device(const batch *b, uint32_t times);

/// Check that a device has the bits of the network: hash, flags, observations, positions, velocities.
void batch_check_equal(const batch *b, mspring_gpu *gpu);

#endif
