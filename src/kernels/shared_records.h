/// @file shared_records.h
/// Lattice blocks of which some have equal records: for each of them the one whose record is read.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SHARED_RECORDS_H
#define MSPRINGI_SHARED_RECORDS_H

#include <stdint.h>

typedef struct mspringi_shared_records {
    uint32_t *of_block; ///< [lattice blocks] the block whose record is read for each
    uint32_t *readers;  ///< [lattice blocks] other blocks that each block's record is read for
    uint32_t *home;     ///< [lattice blocks] a block that each was like before its springs were set
    uint8_t *is_set;    ///< [lattice blocks] whether springs of it were, since it was compared with that
    uint64_t changes;   ///< springs that were set since all were looked at
    uint64_t compared;  ///< of these, those of before the last comparison
} mspringi_shared_records;

/// A block's record is about to change: have it read for no other, and be read for it.
static inline void mspringi_shared_records_unshare_block(mspringi_shared_records *shared, uint32_t block,
                                                         uint32_t blocks) {
    if (shared->of_block[block] != block) {
        shared->readers[shared->of_block[block]]--;
        shared->of_block[block] = block;
        return;
    }
    // The last of those that read it has the record for all from now on: whoever sets one spring after the other
    // comes there late. (A scan of the 3,683 blocks of our ship takes 0.4 us.)
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
