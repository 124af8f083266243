/// @file sell.h
/// The irregular springs, by particle: for whatever is no grid and no chain.
///
/// Every slot that an irregular spring pulls at is a node. Nodes come in slices of MSPRINGI_WIDTH; a slice has as
/// many slice columns as its busiest node has springs, and a slice column holds, for each of the slice's nodes, the
/// neighbour at the other end of one of its springs (or the node itself, where it has no more: a spring of length 0
/// and stiffness 0, which exerts nothing). So a node's force is a sum in registers, in the order of its slice
/// columns; each spring is computed at both its ends, which costs less than adding to two places in memory.
///
/// Ropes stand upright, sixteen side by side: the springs of a slice's nodes to those of the next one are its first
/// slice column then, and are computed once, in place and without gathering. Nodes that they join have no more than
/// two springs, whose sum is the same in either order.
///
/// The last of the own nodes may stand in bundles: equal components of up to MSPRINGI_MAX_COMPONENT slices, sixteen
/// at a time, in which a slice column leads all nodes of a slice to the same other slice. A bundle's slices are in
/// the order of a search from the first one. So each of the others has a spring to a slice above, which comes
/// before. A bundle is swept by its links, which compute each spring once; its nodes sum up their slice columns in
/// the same order as all others.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SELL_H
#define MSPRINGI_SELL_H

#include "base/memory.h"
#include "builder/builder.h"

/// Slots in a block and nodes in a slice: the lanes of the widest vector register, so that every instruction set
/// sees whole ones.
#define MSPRINGI_WIDTH 16

/// Particles of the largest tree, and of the largest other component, that may stand in a bundle.
#define MSPRINGI_MAX_COMPONENT 256
/// Ends of springs that such a component may have: a carry row holds a force for each.
#define MSPRINGI_MAX_SPRING_ENDS 2048

/// Small bundles are swept together, about so many slices, few enough to stay in the first-level cache while all
/// substeps are taken.
#define MSPRINGI_BUNDLE_SPAN 16

/// Springs between two slices of a bundle.
typedef struct mspringi_bundle_link {
    uint32_t below;              ///< slots from a node to its other end
    uint32_t slice_column, back; ///< of the slice above, and of the one below
} mspringi_bundle_link;

typedef struct mspringi_sell {
    uint32_t own_count;      ///< nodes that are slots of irregular rows, in order
    uint32_t attached_count; ///< nodes after them, that are slots of other rows; each strip's fill whole slices
    uint32_t *attached_slot; ///< [attached_count] MSPRING_NONE for those that fill up
    uint32_t slice_count;    ///< (own_count + attached_count) / MSPRINGI_WIDTH
    uint32_t *first_slice_column; ///< [slice_count + 1]
    uint32_t *neighbour;          ///< [slice columns][MSPRINGI_WIDTH] nodes
    uint32_t *entry;              ///< [2 * springs] where in neighbour the two ends of each irregular spring are
    uint8_t *is_interleaved; ///< [slice_count] whether the slice's first slice column is upright; NULL if none is
    uint8_t *is_read;      ///< [slice_count] whether a slice column that is not leads to one of its nodes, likewise
    uint32_t first_bundle; ///< first slice that is in a bundle
    uint32_t *first_link;  ///< [slices in bundles + 1]
    mspringi_bundle_link *links; ///< of those slices in order: their springs to slices below
} mspringi_sell;

/// What an irregular part is made of, and what is needed meanwhile.
typedef struct mspringi_sell_builder {
    mspringi_sell *irregular;
    const uint32_t *a, *b; ///< [count] slots that the springs join
    uint32_t count;
    uint32_t first_slot, own_count;         ///< the slots of the irregular rows
    uint32_t block_count;                   ///< of all slots
    uint32_t bundle_groups, bundle_springs; ///< the last of these, in bundles, and springs of one component of each
    uint32_t *strip_of_block;               ///< [block_count] in what strip another slot is; freed with the rest
    uint32_t *degree, *node_of_slot, *used; ///< by slot, by slot and by node
    uint32_t assigned_count;                ///< the first of these, that have an assigned strip
    bool has_parallel;                      ///< some springs lie beside another: then none stands upright
    uint8_t *upright;                       ///< [own slices] springs that could stand there
    uint32_t upright_count;                 ///< that do
} mspringi_sell_builder;

/// Make the irregular part, in this order: list the attached nodes, lay the slice columns, fill them with the
/// springs first ... end - 1.
mspring_result mspringi_sell_begin(mspringi_sell_builder *builder, mspringi_memory *memory,
                                   mspringi_message *message);
mspring_result mspringi_sell_size_slices(mspringi_sell_builder *builder, mspringi_memory *memory,
                                         mspringi_message *message);
void mspringi_sell_fill(const mspringi_sell_builder *builder, uint32_t first, uint32_t end);
/// When all are filled: link the slices of bundles.
void mspringi_sell_link_bundles(const mspringi_sell_builder *builder);
void mspringi_sell_builder_destroy(mspringi_sell_builder *builder, mspringi_memory *memory);

#endif
