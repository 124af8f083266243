/// @file added_springs.h
/// Springs that were added after the topology was made, for the explicit solver.
///
/// A network that has some takes one substep at a time: compute the forces of all added springs from the positions
/// before the substep, sweep each strip without them, then apply the forces to its particles. So an added spring
/// needs no place in the layout, but costs the whole network the passes of several substeps. Compaction takes it
/// into the layout.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ADDED_SPRINGS_H
#define MSPRINGI_ADDED_SPRINGS_H

#include <stdbool.h>

#include "layout/topology.h"

struct mspring_network;
struct mspringi_sweep;

/// The graft: the live added springs as an irregular part. Its nodes are their ends, by rising slot; each slice has
/// one slice column.
typedef struct mspringi_added_springs {
    mspringi_sell irregular;
    mspring_id *springs;      ///< [capacity] spring of each node
    float *records;           ///< [capacity / MSPRINGI_WIDTH][parts][MSPRINGI_WIDTH]
    float *gathered;          ///< [halves][capacity][4] motion of the nodes before the substep (store/precise.h)
    float *pulls;             ///< forces on the nodes, N, all x and then all y
    uint64_t *keys, *scratch; ///< [capacity] to sort the nodes by slot
    uint32_t *node_of_end;    ///< [capacity] node of each end; end e is that of the spare spring number e / 2
    uint32_t capacity;        ///< nodes, whole slices; 0: springs cannot be added
    uint32_t count;           ///< nodes that there are
    uint64_t growth, links;   ///< counters of edits at the last update
} mspringi_added_springs;

/// Allocate what added springs will need.
mspring_result mspringi_added_springs_reserve(struct mspring_network *network);

/// Bring the graft up to date with the added springs and their values.
void mspringi_added_springs_update(struct mspring_network *network);
/// Make the next update begin anew, because slots have changed.
void mspringi_added_springs_reset(mspringi_added_springs *graft);

/// Compute the forces of all added springs, for a substep that is about to be taken.
void mspringi_added_springs_begin(const struct mspring_network *network, const struct mspringi_sweep *sweep);

/// Apply these forces to the slots first_slot to end_slot - 1, which this substep has swept.
void mspringi_added_springs_pull(const struct mspring_network *network, const struct mspringi_sweep *sweep,
                                 uint32_t first_slot, uint32_t end_slot);

/// Find the first of the blocks first_block to end_block - 1 with a node, or, if not pulled, without one. Return
/// end_block if there is none.
uint32_t mspringi_added_springs_find_block(const mspringi_added_springs *graft, uint32_t first_block,
                                           uint32_t end_block, bool pulled);

#endif
