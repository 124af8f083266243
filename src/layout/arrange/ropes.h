/// @file ropes.h
/// Chains with an assigned strip, as the irregular part has them.
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
    uint32_t *piece; ///< [particles] number of its piece in its assigned strip, length and row there; 0 if it is in
                     ///< none; all NULL if there is none
    uint32_t *long_count, *short_count; ///< [strips] pieces
} mspringi_ropes;

/// Before chains with an assigned strip are dropped: cut those into pieces, and change their assigned strips.
mspring_result mspringi_ropes_settle(mspringi_ropes *ropes, const mspringi_graph *graph,
                                     const mspringi_grids *grids, const mspringi_chains *chains,
                                     mspringi_strip_assignment *assignment, mspringi_memory *memory,
                                     mspringi_message *message);
/// When the irregular part's particles are listed by assigned strip: put the pieces side by side.
void mspringi_ropes_stand(const mspringi_ropes *ropes, mspringi_irregular_list *list);
void mspringi_ropes_destroy(mspringi_ropes *ropes, mspringi_memory *memory);

#endif
