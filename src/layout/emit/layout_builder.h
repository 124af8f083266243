/// @file layout_builder.h
/// Layout builder: blocks of grids, then slots and spring slots, then rows, in a list of short functions.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LAYOUT_BUILDER_H
#define MSPRINGI_LAYOUT_BUILDER_H

#include "base/passes.h"
#include "layout/arrange/ropes.h"

/// Sort key of a grid's block: row, then column block.
typedef uint64_t mspringi_block_key;

static inline mspringi_block_key mspringi_make_key(uint32_t row, uint32_t column_block) {
    return (uint64_t)row << 32 | column_block;
}

static inline uint32_t mspringi_row_of_key(mspringi_block_key key) {
    return (uint32_t)(key >> 32);
}

static inline uint32_t mspringi_column_block_of_key(mspringi_block_key key) {
    return (uint32_t)key;
}

/// Intermediate results of a layout.
struct mspringi_layout_builder {
    mspringi_topology made, *topology; ///< topology points to made
    mspringi_memory *memory;
    mspringi_message *message;
    const mspring_builder *builder;
    uint32_t workers, lanes;
    uint8_t *kinds;
    mspringi_graph graph;
    mspringi_bundles bundles;
    mspringi_equal_components equal_components;
    mspringi_chains chains;
    mspringi_grids grids;
    mspringi_grid_filter grid_filter;
    mspringi_strip_assignment assignment;
    mspringi_ropes ropes;
    mspringi_irregular_list irregular;
    mspringi_tiers tiers;
    mspringi_block_key *blocks; ///< blocks of all grids, grid after grid in grid_order, each sorted
    size_t block_count, block_capacity;
    uint32_t grid, grid_members; ///< index in grid_order of the present grid, and its members listed so far
    size_t grid_begin;           ///< first block of the present grid
    uint32_t row_begin;          ///< first row of the present grid
    /// [rows + 1] first block of each row, grid after grid in grid_order; until they are sorted, the last column
    /// block listed.
    uint32_t *begin_of_row;
    uint32_t *end_block;    ///< [grids] in blocks
    uint32_t bundle_row;    ///< row of the bundles, if there are any
    uint32_t placed_blocks; ///< blocks of the irregular part that already have a row
    size_t row_capacity, span_capacity;
    bool is_checked; ///< no two springs are parallel
    bool has_bundles;
    mspringi_cursor cursor;
    uint32_t loose;            ///< next free slot of a loose particle
    uint32_t irregular_slot;   ///< slot of the last irregular particle so far, from the first one
    uint32_t assigned_blocks;  ///< blocks of irregular particles with an assigned strip
    uint32_t unbundled_blocks; ///< blocks of irregular particles outside bundles
    /// [blocks] A bit for each quarter of lattice spans that must be swept: those with a particle, with a spring's
    /// record, or with the force of a north-east spring from their left. The others at the ends of spans are
    /// trimmed.
    uint8_t *busy;
    mspringi_sell_builder sell;
};

/// Report that memory is out; return the error.
mspring_result mspringi_layout_builder_fail(mspringi_layout_builder *a);

/// Mark the quarter of a slot.
static inline void mspringi_mark_busy(uint8_t *busy, uint32_t slot) {
    busy[slot / MSPRINGI_WIDTH] |= (uint8_t)(1u << slot % MSPRINGI_WIDTH / MSPRINGI_QUARTER);
}

/* Blocks, in this order; a range is of members of grids, in the order of grids. */
mspring_result mspringi_layout_builder_begin_blocks(mspringi_layout_builder *a);
mspring_result mspringi_layout_builder_number_blocks(mspringi_layout_builder *a, uint32_t first, uint32_t end);
mspring_result mspringi_layout_builder_number_other_blocks(mspringi_layout_builder *a);

/// Slot of irregular particle i, from the slot of the one before. A new assigned strip, tier or bundle starts a
/// block, and so do the particles without an assigned strip.
uint32_t mspringi_layout_builder_irregular_slot(const mspringi_layout_builder *a, uint32_t i,
                                                uint32_t previous_slot);
/// True if a particle lies in the loose row. An absent one has slot 0, always empty, or a spare slot.
bool mspringi_layout_builder_is_loose(const mspringi_layout_builder *a, uint32_t particle);
/// Number of a grid's block among all lattice blocks; MSPRING_NONE if it is not stored.
uint32_t mspringi_layout_builder_find_block(const mspringi_layout_builder *a, uint32_t grid, uint32_t row,
                                            uint32_t column_block);

/* Slots and spring slots, in this order; a range is of particles, then of springs. */
mspring_result mspringi_layout_builder_reserve_maps(mspringi_layout_builder *a);
void mspringi_layout_builder_assign_slots(mspringi_layout_builder *a, uint32_t first, uint32_t end);
void mspringi_layout_builder_assign_other_slots(mspringi_layout_builder *a);
mspring_result mspringi_layout_builder_begin_spring_slots(mspringi_layout_builder *a);
void mspringi_layout_builder_assign_spring_slots(mspringi_layout_builder *a, uint32_t first, uint32_t end);
mspring_result mspringi_layout_builder_save_ends(mspringi_layout_builder *a);

/* Rows and strips, in this order. */
mspring_result mspringi_layout_builder_begin_rows(mspringi_layout_builder *a);
mspring_result mspringi_layout_builder_append_lattice_rows(mspringi_layout_builder *a);
mspring_result mspringi_layout_builder_append_other_rows(mspringi_layout_builder *a);
void mspringi_layout_builder_trim_spans(mspringi_layout_builder *a);
mspring_result mspringi_layout_builder_list_trimmed_spans(mspringi_layout_builder *a);
mspring_result mspringi_layout_builder_make_strips(mspringi_layout_builder *a);

/// List the strip of each block in a new array of [block_count]; NULL if memory is out.
uint32_t *mspringi_layout_builder_list_strips_of_blocks(const mspringi_layout_builder *a);

#endif
