/// @file record_sharing.h
/// Lattice blocks with equal records: most lattices have few materials, so most blocks have the same stiffness and
/// damping, lane by lane, as many others. Each keeps a record of its own, which calls of the host write and read.
/// The explicit solver reads one record for all equal blocks, so it stays in the cache. (That saves 12 % of the
/// time of a million springs at AVX2, 2 % of that of 146,000.)
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_RECORD_SHARING_H
#define MSPRINGI_RECORD_SHARING_H

#include "store/network.h"

/// Have each block read its own record.
void mspringi_shared_records_clear(mspringi_shared_records *shared, uint32_t blocks);

/// Before a spring is set: if it lies in a lattice, have the record of its block read for no other block.
static inline void mspringi_shared_records_unshare_in(mspring_network *network, mspringi_shared_records *shared,
                                                      mspringi_spring_slot spring_slot) {
    const uint32_t block = (uint32_t)(spring_slot / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH));
    if (spring_slot >= network->topology.lattice_spring_slots)
        return;
    if (shared->of_block[block] != block || shared->readers[block] > 0)
        mspringi_shared_records_unshare_block(shared, block, network->topology.lattice_blocks);
    shared->is_set[block] = 1;
    shared->changes++;
}

static inline void mspringi_shared_records_unshare(mspring_network *network, mspringi_spring_slot spring_slot) {
    mspringi_shared_records_unshare_in(network, &network->shared_records, spring_slot);
}

/// Before its rest length or its bounds are set, if springs yield: likewise.
static inline void mspringi_shared_records_unshare_yielding(mspring_network *network,
                                                            mspringi_spring_slot spring_slot) {
    if (network->tested.nominal)
        mspringi_shared_records_unshare_in(network, &network->tested.shared_records, spring_slot);
}

/// Find equal blocks again: among those whose springs were set since; among all if a quarter of all springs was.
void mspringi_shared_records_find(mspring_network *network);

/// Find blocks with equal rest lengths and bounds of yielding springs. Where nothing has flowed, a whole lattice
/// reads those of a few blocks.
void mspringi_shared_records_find_yielding(mspring_network *network);

#endif
