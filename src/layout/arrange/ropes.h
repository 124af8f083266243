/// @file ropes.h
/// Ropes on lattices: chains with an assigned strip, as a part of the irregular part.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ROPES_H
#define MSPRINGI_ROPES_H

#include "layout/analysis.h"

typedef struct mspringi_ropes {
    const mspringi_graph *graph;
    const mspringi_grids *grids;
    const mspringi_chains *chains;
    mspringi_strip_assignment *assignment;
    uint32_t strip_count;
    uint32_t *piece; ///< [particles] piece in its strip, its length, and row in it; 0: in no piece; NULL: no ropes
    uint32_t *long_count, *short_count; ///< [strips] pieces
} mspringi_ropes;

/// Assign strips to the ropes' particles and cut ropes into pieces, before chains with an assigned strip are
/// dropped.
mspring_result mspringi_ropes_assign_strips(mspringi_ropes *ropes, const mspringi_graph *graph,
                                            const mspringi_grids *grids, const mspringi_chains *chains,
                                            mspringi_strip_assignment *assignment, mspringi_memory *memory,
                                            mspringi_message *message);
/// Interleave the pieces, after the irregular particles are listed by assigned strip.
void mspringi_ropes_interleave(const mspringi_ropes *ropes, mspringi_irregular_list *list);
void mspringi_ropes_destroy(mspringi_ropes *ropes, mspringi_memory *memory);

#endif
