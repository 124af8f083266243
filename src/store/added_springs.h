/// @file added_springs.h
/// Springs that were added after the topology was made, for the explicit solver.
///
/// Whatever they join, they are taken one substep at a time: first their forces are computed, all at once, from
/// where their ends are before the substep; then each strip is swept as if they were not there, and pulled at. So
/// an added spring needs no place in a plan, and costs the rest of the network the passes of several substeps;
/// compacting the network takes it into the plan.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ADDED_SPRINGS_H
#define MSPRINGI_ADDED_SPRINGS_H

#include <stdbool.h>

#include "layout/topology.h"

struct mspring_network;
struct mspringi_sweep;

/// The live added springs as an irregular part whose nodes are their ends, by rising slot, one slice column to a
/// group.
typedef struct mspringi_added_springs {
    mspringi_sell irregular;
    mspring_id *springs;      ///< [capacity] of each node
    float *records;           ///< [capacity / MSPRINGI_WIDTH][parts][MSPRINGI_WIDTH]
    float *gathered;          ///< [capacity][4] where the nodes are before the substep
    float *pulls;             ///< forces on the nodes, all x and then all y
    uint64_t *keys, *scratch; ///< [capacity] to sort the nodes by
    uint32_t *node_of_end;    ///< [capacity]
    uint32_t capacity;        ///< nodes, whole groups; 0: springs cannot be added
    uint32_t count;           ///< nodes that there are
    uint64_t growth, links;   ///< edits that it has seen
} mspringi_added_springs;

/// Allocate what added springs will need.
mspring_result mspringi_added_springs_reserve(struct mspring_network *network);

/// Have the graft be that of the springs there are now, with the values that they have now.
void mspringi_added_springs_update(struct mspring_network *network);
/// Have the next mspringi_added_springs_update() begin anew, as slots have changed.
void mspringi_added_springs_reset(mspringi_added_springs *graft);

/// Compute the forces of all added springs, for a substep that is about to be taken.
void mspringi_added_springs_begin(const struct mspring_network *network, const struct mspringi_sweep *sweep);

/// Do to the slots first_slot ... end_slot - 1, which have been swept in this substep, what these forces do.
void mspringi_added_springs_pull(const struct mspring_network *network, const struct mspringi_sweep *sweep,
                                 uint32_t first_slot, uint32_t end_slot);

/// The first block, of those first_block ... end_block - 1, whose slots are pulled at (or, if not pulled, are not);
/// end_block if there is none.
uint32_t mspringi_added_springs_find_block(const mspringi_added_springs *graft, uint32_t first_block,
                                           uint32_t end_block, bool pulled);

#endif
