/// @file ropes.h
/// Strands with a home, as the web has them.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ROPES_H
#define MSPRINGI_ROPES_H

#include "layout/analysis.h"

typedef struct mspringi_ropes {
    const mspringi_graph *graph;
    const mspringi_grids *grids;
    const mspringi_strands *strands;
    mspringi_homes *homes;
    uint32_t strip_count;
    uint32_t *piece; ///< [particles] number of its piece in its home, length and row there; 0 if it is in none; all
                     ///< NULL if there is none
    uint32_t *long_count, *short_count; ///< [strips] pieces
} mspringi_ropes;

/// Before strands with a home are dropped: cut those into pieces, and change their homes.
mspring_result mspringi_ropes_settle(mspringi_ropes *ropes, const mspringi_graph *graph,
                                     const mspringi_grids *grids, const mspringi_strands *strands,
                                     mspringi_homes *homes, mspringi_memory *memory, mspringi_message *message);
/// When the web's particles are listed by home: put the pieces side by side.
void mspringi_ropes_stand(const mspringi_ropes *ropes, mspringi_web_list *list);
void mspringi_ropes_destroy(mspringi_ropes *ropes, mspringi_memory *memory);

#endif
