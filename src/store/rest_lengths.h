/// @file rest_lengths.h
/// Rest lengths of lattice springs. In most lattices all springs of one direction have the same, which is stored
/// once. (That saves 10 million springs 16 of 112 bytes of memory traffic per particle.)
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_REST_LENGTHS_H
#define MSPRINGI_REST_LENGTHS_H

#include "store/network.h"

/// Find room for the rest lengths of the builder's springs, which mspringi_spring_slot_fill() then sets.
mspring_result mspringi_rest_lengths_create(mspringi_rest_lengths *rests, const mspringi_topology *topology,
                                            const mspring_builder *builder, mspringi_memory *memory,
                                            mspringi_message *message);

/// Lay them out from single springs: note the rest length of each in the pattern of its lattice block, reserve, and
/// then set each by mspringi_rest_lengths_at().
typedef struct mspringi_rest_pattern {
    float length[MSPRINGI_DIRECTIONS]; ///< 0 without a spring so far
    bool is_mixed;                     ///< springs of some direction differ
} mspringi_rest_pattern;
void mspringi_rest_lengths_note(mspringi_rest_pattern *of_block, mspringi_spring_slot spring_slot,
                                float rest_length);
mspring_result mspringi_rest_lengths_reserve(mspringi_rest_lengths *rests, const mspringi_rest_pattern *of_block,
                                             uint32_t blocks, mspringi_memory *memory, mspringi_message *message);

/// Give every lattice spring a rest length of its own, which mspringi_rest_lengths_at() may then set. Allocates,
/// once.
mspring_result mspringi_rest_lengths_unshare(mspring_network *network);

/// True if several blocks share the rest length of a lattice spring slot.
static inline bool mspringi_rest_lengths_are_shared(const mspringi_rest_lengths *rests,
                                                    mspringi_spring_slot spring_slot) {
    return rests->of_block[spring_slot / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH)] < rests->shared_count;
}

/// The rest length of a lattice spring slot.
static inline float *mspringi_rest_lengths_at(const mspringi_rest_lengths *rests,
                                              mspringi_spring_slot spring_slot) {
    const size_t block_spring_slots = (size_t)MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a spring slot of a lattice has a block
    return rests->lengths + rests->of_block[spring_slot / block_spring_slots] * block_spring_slots +
           spring_slot % block_spring_slots;
}

#endif
