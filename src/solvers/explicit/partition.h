/// @file partition.h
/// How workers divide strips of rows, or tiers of an irregular part, among each other.
///
/// Each worker has a share: strips that follow each other. It takes several substeps in a pass over its share, by
/// itself but for what it needs of its neighbours' shares at the borders, see halo.h. In a pass borders move up by
/// the skew with each substep; before the next they go back.
///
/// Bodies that may not wait for each other take a pass in two runs (split tiling: Grosser 2013). In the first one
/// each share shrinks by the skew with each substep, at both of its sides. In the second one each body takes what
/// has been left around a border, which grows. What is left at the lower and at the upper end is one body's, so
/// that all runs have as many bodies as there are shares.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PARTITION_H
#define MSPRINGI_PARTITION_H

#include "store/network.h"

/// Most substeps in one pass: each that is under way needs a carry row of its own.
#define MSPRINGI_DEEPEST_PASS 16u

/// Passes that borders are found for; further ones have those of the first again, and so on.
#define MSPRINGI_PLANNED_PASSES 16u

typedef struct mspringi_partition {
    uint32_t strips, skew; ///< strips or tiers; by how many substeps follow each other
    uint32_t count;        ///< substeps
    uint32_t group;        ///< substeps in a pass; the last one may have fewer
    uint32_t workers;      ///< shares: share 0 is the lowest one
    bool are_independent;  ///< and wait for nobody
    uint32_t *borders;     ///< [passes][workers] first strips of the shares in a pass's first substep; of
                           ///< independent shares [workers + 1], of all passes, and what is behind the last
} mspringi_partition;

/// Divide count substeps of strips of the wavefront or, if irregular part is not NULL, of the tiers of its row, in
/// passes of at most depth.
mspringi_partition mspringi_partition_make(const mspring_network *network, const mspringi_strip *irregular,
                                           uint32_t count, uint32_t depth);

/// The same without borders: how many workers share the strips, and how many substeps a pass has. Writes nothing.
mspringi_partition mspringi_partition_count(const mspring_network *network, const mspringi_strip *irregular,
                                            uint32_t count, uint32_t depth);

/// Strips that a share needs at any time, for its worker to have what it reads around a border for itself.
static inline uint32_t mspringi_partition_min_strips(uint32_t skew) {
    return 2 * skew + 1;
}

/// The strips of a share in a substep of a pass: the first, and the one behind the last.
static inline uint32_t mspringi_partition_first_strip(const mspringi_partition *partition, uint32_t share,
                                                      uint32_t pass, uint32_t substep) {
    const uint32_t row = pass % MSPRINGI_PLANNED_PASSES * partition->workers;
    return share == 0 ? 0 : partition->borders[row + share] + substep * partition->skew;
}
static inline uint32_t mspringi_partition_end_strip(const mspringi_partition *partition, uint32_t share,
                                                    uint32_t pass, uint32_t substep) {
    return share + 1 == partition->workers ? partition->strips
                                           : mspringi_partition_first_strip(partition, share + 1, pass, substep);
}

/// Substeps of a pass.
static inline uint32_t mspringi_partition_substeps(const mspringi_partition *partition, uint32_t pass) {
    const uint32_t left = partition->count - pass * partition->group;
    return left < partition->group ? left : partition->group;
}

#endif
