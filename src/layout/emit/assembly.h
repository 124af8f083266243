/// @file assembly.h
/// A topology that is being made: blocks of grids, then slots and places, then rows, as a list of plain functions.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ASSEMBLY_H
#define MSPRINGI_ASSEMBLY_H

#include "base/passes.h"
#include "layout/arrange/ropes.h"

/// A block of a grid on its way to a number: row, then column block.
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

/// What is needed while a topology is made.
struct mspringi_assembly {
    mspringi_topology made, *topology; ///< the latter is the former
    mspringi_memory *memory;
    mspringi_message *message;
    const mspring_builder *builder;
    uint32_t workers, lanes;
    uint8_t *kinds;
    mspringi_graph graph;
    mspringi_herds herds;
    mspringi_copies copies;
    mspringi_strands strands;
    mspringi_grids grids;
    mspringi_sheets sheets;
    mspringi_homes homes;
    mspringi_ropes ropes;
    mspringi_web_list web;
    mspringi_layers layers;
    mspringi_block_key *blocks; ///< of all grids, grid after grid in the order of their rows, each sorted
    size_t block_count, block_capacity;
    uint32_t grid, grid_members; ///< of grid_order, the one that is being listed, and its members so far
    size_t grid_begin;           ///< where its blocks begin
    uint32_t *first_block;       ///< [grids] in blocks
    uint32_t *end_block;         ///< [grids] in blocks
    uint32_t herd_row;           ///< number of the row of herds, if there are any
    uint32_t home_blocks;        ///< blocks of the web that have been given to rows
    size_t row_capacity, span_capacity;
    bool is_checked; ///< no two springs join the same particles
    bool has_herds;
    mspringi_cursor cursor;
    uint32_t loose;        ///< the next loose slot
    uint32_t web_place;    ///< of the web's last particle so far
    uint32_t homed_blocks; ///< blocks of the web's particles with a home
    uint32_t loner_blocks; ///< and of all that are in no herd
    uint8_t *busy;         ///< [blocks] bits of quarters that have to be swept
    mspringi_weaving weaving;
};

/// Say that there is no memory, and return that.
mspring_result mspringi_assembly_fail(mspringi_assembly *a);

/* Blocks, in this order; a range is of members of grids, in the order of grids. */
mspring_result mspringi_assembly_begin_blocks(mspringi_assembly *a);
mspring_result mspringi_assembly_number_blocks(mspringi_assembly *a, uint32_t first, uint32_t end);
mspring_result mspringi_assembly_number_the_rest(mspringi_assembly *a);

/// Where the web's particle i goes among its slots: those of each home and of each layer begin a block, and so do
/// those without, and herds.
uint32_t mspringi_assembly_web_place(const mspringi_assembly *a, uint32_t i, uint32_t place_before);
/// Whether a particle lies in the loose row. One that is absent has the first slot, which holds none, or a spare
/// one.
bool mspringi_assembly_is_loose(const mspringi_assembly *a, uint32_t particle);
/// The number of a grid's block among all lattice blocks; MSPRING_NONE if it is not stored.
uint32_t mspringi_assembly_find_block(const mspringi_assembly *a, uint32_t grid, uint32_t row,
                                      uint32_t column_block);

/* Slots and places, in this order; a range is of particles, then of springs. */
mspring_result mspringi_assembly_reserve_maps(mspringi_assembly *a);
void mspringi_assembly_assign_slots(mspringi_assembly *a, uint32_t first, uint32_t end);
void mspringi_assembly_assign_other_slots(mspringi_assembly *a);
mspring_result mspringi_assembly_begin_places(mspringi_assembly *a);
void mspringi_assembly_assign_places(mspringi_assembly *a, uint32_t first, uint32_t end);
mspring_result mspringi_assembly_note_ends(mspringi_assembly *a);

/* Rows and strips, in this order. */
mspring_result mspringi_assembly_begin_rows(mspringi_assembly *a);
mspring_result mspringi_assembly_append_lattice_rows(mspringi_assembly *a);
mspring_result mspringi_assembly_append_other_rows(mspringi_assembly *a);
void mspringi_assembly_mark_busy(mspringi_assembly *a);
void mspringi_assembly_trim_spans(mspringi_assembly *a);
mspring_result mspringi_assembly_tighten_spans(mspringi_assembly *a);
mspring_result mspringi_assembly_make_strips(mspringi_assembly *a);

/// The strip of each block that one has, a new array of [block_count]; NULL if there is no memory.
uint32_t *mspringi_assembly_list_strips_of_blocks(const mspringi_assembly *a);

#endif
