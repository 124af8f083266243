/// @file graft.h
/// Springs that were added after the topology was made, for the explicit solver.
///
/// Whatever they join, they are taken one substep at a time: first their forces are computed, all at once, from
/// where their ends are before the substep; then each strip is swept as if they were not there, and pulled at. So
/// an added spring needs no place in a plan, and costs the rest of the network the passes of several substeps;
/// compacting the network takes it into the plan.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GRAFT_H
#define MSPRINGI_GRAFT_H

#include <stdbool.h>

#include "layout/topology.h"

struct mspring_network;
struct mspringi_sweep;

/// The live added springs as a web whose nodes are their ends, by rising slot, one rung to a group.
typedef struct mspringi_graft {
    mspringi_web web;
    mspring_id *springs;      ///< [capacity] of each node
    float *records;           ///< [capacity / MSPRINGI_WIDTH][parts][MSPRINGI_WIDTH]
    float *gathered;          ///< [capacity][4] where the nodes are before the substep
    float *pulls;             ///< forces on the nodes, all x and then all y
    uint64_t *keys, *scratch; ///< [capacity] to sort the nodes by
    uint32_t *node_of_end;    ///< [capacity]
    uint32_t capacity;        ///< nodes, whole groups; 0: springs cannot be added
    uint32_t count;           ///< nodes that there are
    uint64_t growth, links;   ///< edits that it has seen
} mspringi_graft;

/// Allocate what added springs will need.
mspring_result mspringi_graft_reserve(struct mspring_network *network);

/// Have the graft be that of the springs there are now, with the values that they have now.
void mspringi_graft_follow(struct mspring_network *network);
/// Have the next mspringi_graft_follow() begin anew, as slots have changed.
void mspringi_graft_forget(mspringi_graft *graft);

/// Compute the forces of all added springs, for a substep that is about to be taken.
void mspringi_graft_begin(const struct mspring_network *network, const struct mspringi_sweep *sweep);

/// Do to the slots first_slot ... end_slot - 1, which have been swept in this substep, what these forces do.
void mspringi_graft_pull(const struct mspring_network *network, const struct mspringi_sweep *sweep,
                         uint32_t first_slot, uint32_t end_slot);

/// The first block, of those first_block ... end_block - 1, whose slots are pulled at (or, if not pulled, are not);
/// end_block if there is none.
uint32_t mspringi_graft_find_block(const mspringi_graft *graft, uint32_t first_block, uint32_t end_block,
                                   bool pulled);

#endif
