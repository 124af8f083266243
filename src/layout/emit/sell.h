/// @file sell.h
/// Irregular springs by particle, in sliced ELLPACK (Monakov 2010, Kreutzer 2014).
///
/// A slot with an irregular spring is a node. Nodes come in slices of MSPRINGI_WIDTH. A slice has as many slice
/// columns as its busiest node has springs. A slice column holds one neighbour of each node. If a node has fewer
/// springs, its remaining entries name the node itself: a spring of length 0 and stiffness 0.
///
/// The force on a node is thus a sum in registers, in the order of its slice columns. Each spring is computed at
/// both ends, which costs less than adding to two places in memory.
///
/// Ropes are interleaved, sixteen side by side: consecutive particles lie in consecutive slices. The springs to the
/// next slice form the first slice column. They are computed once and gather nothing. Their nodes have at most two
/// springs, whose sum is the same in either order.
///
/// The last nodes lie in bundles: sixteen equal components of at most MSPRINGI_MAX_COMPONENT slices. A slice column
/// joins all nodes of a slice to the same other slice. Slices are in breadth-first order from the first one, so
/// each of the others has a spring to an earlier slice. A bundle is swept by its links, which compute each spring
/// once. Its nodes sum up forces in the same order as all others.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SELL_H
#define MSPRINGI_SELL_H

#include "base/memory.h"
#include "builder/builder.h"

/// Slots in a block and nodes in a slice: lanes of the widest vector register, so that every instruction set has
/// whole ones.
#define MSPRINGI_WIDTH 16
/// Lanes of the narrowest vector register.
#define MSPRINGI_QUARTER 4

/// Particles of the largest component in a bundle.
#define MSPRINGI_MAX_COMPONENT 256
/// Spring ends of such a component. A carry row holds a force for each.
#define MSPRINGI_MAX_SPRING_ENDS 2048

/// Slices of small bundles swept together: few enough to stay in the first-level cache for all substeps.
#define MSPRINGI_BUNDLE_SPAN 16

/// Springs between two slices of a bundle, a spring in each lane.
typedef struct mspringi_bundle_link {
    uint32_t below;              ///< offset from a node to its other end, in slots
    uint32_t slice_column, back; ///< slice columns of the upper and of the lower slice
} mspringi_bundle_link;

typedef struct mspringi_sell {
    uint32_t own_count;           ///< nodes in irregular rows, in slot order
    uint32_t attached_count;      ///< nodes in other rows, behind them; those of each strip fill whole slices
    uint32_t *attached_slot;      ///< [attached_count] MSPRING_NONE for padding
    uint32_t slice_count;         ///< (own_count + attached_count) / MSPRINGI_WIDTH
    uint32_t *first_slice_column; ///< [slice_count + 1]
    uint32_t *end_column;         ///< [slices][quarters] behind the last slice column that the quarter's nodes need
    uint32_t *neighbour;          ///< [slice columns][MSPRINGI_WIDTH] nodes
    uint32_t *entry;              ///< [2 * springs] index in neighbour of each end of a spring
    uint8_t *is_interleaved;      ///< [slice_count] 1 if the first slice column is interleaved; NULL if none is
    uint8_t *is_read;             ///< [slice_count] 1 if an ordinary slice column reads one of its nodes, or NULL
    uint32_t first_bundle;        ///< first slice in bundles
    uint32_t *first_link;         ///< [slices in bundles + 1]
    mspringi_bundle_link *links;  ///< by upper slice
} mspringi_sell;

/// End of the slice columns that the nodes in these lanes of a slice need.
static inline uint32_t mspringi_sell_end_column(const mspringi_sell *sell, size_t slice, size_t lane,
                                                size_t lanes) {
    if (lanes == MSPRINGI_WIDTH)
        return sell->first_slice_column[slice + 1];
    const uint32_t *end = sell->end_column + (slice * MSPRINGI_WIDTH + lane) / MSPRINGI_QUARTER;
    uint32_t last = end[0];
    for (size_t quarter = 1; quarter < lanes / MSPRINGI_QUARTER; ++quarter)
        last = end[quarter] > last ? end[quarter] : last;
    return last;
}

/// Builder of the irregular part, with its scratch.
typedef struct mspringi_sell_builder {
    mspringi_sell *sell;
    const uint32_t *a, *b; ///< [count] slots of the springs' ends
    uint32_t count;
    uint32_t first_slot, own_count;         ///< slots of irregular rows
    uint32_t block_count;                   ///< blocks of all slots
    uint32_t bundle_slices, bundle_springs; ///< last own slices, in bundles; springs of one component of each
    uint32_t *strip_of_block;               ///< [block_count] strip of a block; freed with the builder
    uint32_t *degree, *node_of_slot, *used; ///< by slot, by slot and by node
    uint32_t assigned_count;                ///< first own nodes, with an assigned strip
    bool has_parallel;                      ///< some springs are parallel: no chain is interleaved
    uint8_t *interleaved;                   ///< [own slices] springs that can be interleaved
    uint32_t interleaved_count;             ///< springs that are
} mspringi_sell_builder;

/// Build the irregular part, in this order: list the attached nodes, size the slices, fill them with the springs
/// first ... end - 1.
mspring_result mspringi_sell_begin(mspringi_sell_builder *builder, mspringi_memory *memory,
                                   mspringi_message *message);
mspring_result mspringi_sell_size_slices(mspringi_sell_builder *builder, mspringi_memory *memory,
                                         mspringi_message *message);
void mspringi_sell_fill(const mspringi_sell_builder *builder, uint32_t first, uint32_t end);
/// Link the slices of bundles, after the last fill.
void mspringi_sell_link_bundles(const mspringi_sell_builder *builder);
void mspringi_sell_builder_destroy(mspringi_sell_builder *builder, mspringi_memory *memory);

#endif
