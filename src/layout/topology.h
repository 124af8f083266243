/// @file topology.h
/// Topology: the kind of row that each particle lies in, and its slot.
///
/// A slot is an index into the state arrays. MSPRINGI_WIDTH consecutive slots form a block: as many columns of one
/// row. There are four kinds of row:
///
///   lattice    one row of a grid; each block has a record of four springs per slot, see mspringi_direction
///   chain      chains packed end to end; a record of one spring per slot, to the next slot
///   irregular  particles with other springs; records by slice column, see layout/emit/sell.h. Bundles
///              (layout/recognise/equal_components.c) have a row of their own, with independent spans
///   loose      particles without springs; no records
///
/// Springs in no lattice row and no chain row belong to the irregular part. Irregular particles connected to a
/// lattice have an assigned strip of lattice rows. They are swept with it, so that one pass can take several
/// substeps. A large irregular part without assigned strips is divided into tiers for the same purpose, with the
/// chains connected to it.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TOPOLOGY_H
#define MSPRINGI_TOPOLOGY_H

#include "base/array_table.h"
#include "base/assert.h"
#include "builder/builder.h"
#include "layout/emit/sell.h"

/// Springs of the lattice slot in column c of row r. East, north and north-east start at the slot. South-east
/// starts one row up, at (c, r + 1), so that every spring reaches at most one column to the right and every load is
/// contiguous.
typedef enum mspringi_direction {
    MSPRINGI_EAST = 0,       ///< (c, r)     to (c + 1, r)
    MSPRINGI_NORTH = 1,      ///< (c, r)     to (c, r + 1)
    MSPRINGI_NORTH_EAST = 2, ///< (c, r)     to (c + 1, r + 1)
    MSPRINGI_SOUTH_EAST = 3, ///< (c, r + 1) to (c + 1, r)
    MSPRINGI_DIRECTIONS = 4
} mspringi_direction;

/// Index of a spring in the records. Below lattice_spring_slots: (block * MSPRINGI_DIRECTIONS + direction) *
/// MSPRINGI_WIDTH + lane. Below row_spring_slots: lattice_spring_slots + block * MSPRINGI_WIDTH + lane. From
/// there on: row_spring_slots + index of an irregular spring; spare springs (layout/emit/spare.h) and then
/// inactive ones follow. Blocks count from the first of their kind.
typedef uint32_t mspringi_spring_slot;

typedef enum mspringi_row_kind {
    MSPRINGI_ROW_LATTICE,   ///< all four springs
    MSPRINGI_ROW_CHAIN,     ///< east springs only
    MSPRINGI_ROW_IRREGULAR, ///< springs of the irregular part
    MSPRINGI_ROW_LOOSE      ///< none
} mspringi_row_kind;

/// Consecutive slots of a row: whole blocks, trimmed by empty quarters at either end.
typedef struct mspringi_span {
    uint32_t first_slot, end_slot; ///< multiples of MSPRINGI_QUARTER
    uint32_t first_record;         ///< record of first_slot's block (lattice, chain), or its slice (irregular part)
    uint32_t record_slots;         ///< springs in a record: MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH or MSPRINGI_WIDTH
    int64_t up;                    ///< offset from a slot to the one above; 0 if there is none (lattice)
    int64_t carry;                 ///< offset from a slot to its slot in the carry row (lattice, chain)
} mspringi_span;

/// Spans swept in one kernel call.
typedef struct mspringi_row {
    mspringi_row_kind kind; ///< MSPRINGI_ROW_CHAIN also for a grid's row without a row above
    uint32_t first_span, span_count;
} mspringi_row;

/// Consecutive rows, swept together with their irregular nodes.
typedef struct mspringi_strip {
    uint32_t first_row, row_count;
    uint32_t first_attached, attached_count; ///< irregular nodes in its lattice and chain rows
    uint32_t assigned_span;                  ///< span of the irregular particles swept with it, or MSPRING_NONE
} mspringi_strip;

typedef struct mspringi_empty_run {
    uint32_t first_slot, slot_count;
} mspringi_empty_run;

/// Range of ids: those of the builder, then spare ones.
typedef struct mspringi_reserve {
    uint32_t first_particle, first_spring; ///< first spare ids
    uint32_t particle_end, spring_end;     ///< ends of the spare ids
} mspringi_reserve;

typedef struct mspringi_topology {
    uint32_t particle_count, spring_count; ///< ids assigned so far
    mspringi_reserve reserve;
    /// Blocks, with padding in front, behind, and after the chains: lane + 1 of any block can be read.
    uint32_t block_count;
    uint32_t lattice_first, lattice_blocks; ///< first block and number of blocks, by kind
    uint32_t chain_first, chain_blocks;
    uint32_t irregular_first, irregular_blocks;
    uint32_t loose_first, loose_blocks;
    uint32_t spare_first, spare_blocks; ///< a slot for each spare particle

    uint32_t *slot_of_particle;           ///< [reserve.particle_end]
    uint32_t *particle_of_slot;           ///< [block_count * MSPRINGI_WIDTH], MSPRING_NONE for empty slots
    mspringi_spring_slot *slot_of_spring; ///< [reserve.spring_end]
    uint32_t *up_of_block;                ///< [lattice_blocks] block above; itself if there is none

    uint32_t *grid_of_row; ///< [lattice_rows] grid of each lattice row

    mspringi_empty_run *empty_runs; ///< slots without a particle, spare ones excluded
    uint32_t empty_run_count;

    mspringi_spring_slot lattice_spring_slots;      ///< spring slots of lattices, which come first
    mspringi_spring_slot row_spring_slots;          ///< of lattices and, behind these, chains
    uint32_t irregular_count;                       ///< irregular springs, and the spare ids in use
    uint32_t laid_out_count;                        ///< irregular springs
    uint32_t irregular_capacity;                    ///< laid_out_count, and a spring slot for each spare spring
    uint32_t inactive_count;                        ///< broken springs outside the layout, see network/survivors.c
    uint32_t *irregular_a, *irregular_b;            ///< [irregular_capacity + inactive_count] slots
    uint32_t *initial_slots, *initial_spring_slots; ///< of the spare ids, at creation
    uint32_t initial_particles;                     ///< spare particles in the layout: the first ones
    mspringi_sell irregular;

    mspringi_span *spans;
    uint32_t span_count;
    mspringi_span *trimmed_spans; ///< lattice spans without idle registers; NULL if a register is a block
    uint32_t *first_trimmed;      ///< [trimmed_count + 1] first trimmed span of each span
    uint32_t trimmed_count;       ///< lattice spans
    mspringi_row *rows;           ///< lattice rows first
    uint32_t row_count;
    mspringi_strip *strips; ///< all rows, in order
    uint32_t strip_count;
    uint32_t wavefront_rows;   ///< first lattice rows, swept for several substeps in one pass
    uint32_t wavefront_strips; ///< strips of these rows
    uint32_t skew;             ///< strips by which a substep of such a pass trails the one before
    uint32_t carry_blocks;     ///< blocks of the carry row
    /// Strip of the bundles, or MSPRING_NONE.
    uint32_t bundle_strip;
    uint32_t bundle_springs; ///< springs in bundles
    bool may_have_bundles;   ///< it was laid out for a solver that sweeps bundles

    uint32_t parallel_count; ///< springs parallel to another one
    /// Tiers of the irregular row, each with springs to its neighbours only; 0 if it has none.
    uint32_t tier_count;
    uint32_t *tier_blocks; ///< [tier_count + 1] first block of each, from the row's first block

    // For the plan.
    uint32_t lattice_count, lattice_particles, lattice_springs, lattice_rows;
    uint32_t chain_count, chain_particles, chain_springs;
    uint32_t irregular_particles, loose_particles;
} mspringi_topology;

/// Words of MSPRINGI_WIDTH bits, with one bit for each spring slot.
static inline size_t mspringi_spring_slot_words(const mspringi_topology *topology) {
    return ((size_t)topology->row_spring_slots + topology->irregular_capacity + topology->inactive_count +
            MSPRINGI_WIDTH - 1) /
           MSPRINGI_WIDTH;
}

/// Slot of a spring.
static inline mspringi_spring_slot mspringi_slot_of_spring(const mspringi_topology *topology, mspring_id spring) {
    MSPRINGI_ASSERT(spring < topology->reserve.spring_end);
    return topology->slot_of_spring[spring];
}

/// End of the spring slots that are swept: of rows, irregular springs and spare ids in use.
static inline mspringi_spring_slot mspringi_swept_end(const mspringi_topology *topology) {
    return topology->row_spring_slots + topology->irregular_count;
}

/// Find the first word of spring slots of a row's block, and their number: one for each direction. False: the block
/// lies in no row with springs.
static inline bool mspringi_words_of_block(const mspringi_topology *topology, size_t block, size_t *word,
                                           size_t *words) {
    const size_t in_lattice = block - topology->lattice_first, in_chain = block - topology->chain_first;
    const bool is_lattice = in_lattice < topology->lattice_blocks;
    *word =
        is_lattice ? in_lattice * MSPRINGI_DIRECTIONS : topology->lattice_spring_slots / MSPRINGI_WIDTH + in_chain;
    *words = is_lattice ? MSPRINGI_DIRECTIONS : 1;
    return is_lattice || in_chain < topology->chain_blocks;
}

/// True if the spring in this slot is inactive.
static inline bool mspringi_spring_slot_is_inactive(const mspringi_topology *topology,
                                                    mspringi_spring_slot spring_slot) {
    return spring_slot - topology->row_spring_slots >= topology->irregular_capacity &&
           spring_slot >= topology->row_spring_slots;
}

/// True if the spring in this slot is part of the layout: neither spare nor inactive.
static inline bool mspringi_spring_slot_is_laid_out(const mspringi_topology *topology,
                                                    mspringi_spring_slot spring_slot) {
    return spring_slot < topology->row_spring_slots + topology->laid_out_count;
}

/// Springs in the layout or in spare slots.
static inline uint32_t mspringi_swept_count(const mspringi_topology *topology) {
    return topology->spring_count - topology->inactive_count;
}

/// Lay out the builder's particles and springs, with room for spare ids. The layout suits `workers` threads and
/// vector registers of `lanes` lanes (at least MSPRINGI_QUARTER). Slots do not depend on lanes.
mspring_result mspringi_topology_create(mspringi_topology *topology, const mspring_builder *builder,
                                        const mspringi_reserve *reserve, bool has_bundles, uint32_t workers,
                                        uint32_t lanes, mspringi_memory *memory, mspringi_message *message);
/// Lay out in short functions: begin, run until *is_done or an error, then finish; or abandon at any time (NULL is
/// allowed). Builder, memory and message must outlive the layout. is_checked: no two springs are parallel. A
/// finished topology has spring slots for the builder's springs only, in an array with room for all ids.
typedef struct mspringi_layout_builder mspringi_layout_builder;
mspring_result mspringi_topology_begin(const mspring_builder *builder, const mspringi_reserve *reserve,
                                       bool is_checked, bool has_bundles, uint32_t workers, uint32_t lanes,
                                       mspringi_memory *memory, mspringi_message *message,
                                       mspringi_layout_builder **begun);
/// Run the next function: at most 3 ms for 200,000 springs. Their number depends neither on workers nor on lanes.
mspring_result mspringi_topology_run(mspringi_layout_builder *begun, bool *is_done);
void mspringi_topology_finish(mspringi_layout_builder *begun, mspringi_memory *memory, mspringi_topology *topology);
void mspringi_topology_abandon(mspringi_layout_builder *begun, mspringi_memory *memory);

/// Arrays of a topology.
extern const mspringi_array_table mspringi_topology_arrays;
void mspringi_topology_destroy(mspringi_topology *topology, mspringi_memory *memory);

/// Find both slots of a lattice spring, in its direction.
static inline void mspringi_lattice_ends(const mspringi_topology *topology, mspringi_spring_slot spring_slot,
                                         uint32_t *base, uint32_t *tip) {
    const uint32_t block = spring_slot / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH),
                   lane = spring_slot % MSPRINGI_WIDTH;
    const uint32_t direction = spring_slot / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS;
    const uint32_t here = (topology->lattice_first + block) * MSPRINGI_WIDTH + lane;
    const uint32_t up = topology->up_of_block[block] * MSPRINGI_WIDTH + lane;
    *base = direction == MSPRINGI_SOUTH_EAST ? up : here;
    *tip = (((direction == MSPRINGI_NORTH) | (direction == MSPRINGI_NORTH_EAST)) ? up : here) +
           (direction != MSPRINGI_NORTH);
}

/// Set both slots of a spring outside lattices and chains.
static inline void mspringi_topology_set_ends(const mspringi_topology *topology, mspringi_spring_slot spring_slot,
                                              uint32_t base, uint32_t tip) {
    MSPRINGI_ASSERT(spring_slot >= topology->row_spring_slots);
    topology->irregular_a[spring_slot - topology->row_spring_slots] = base;
    topology->irregular_b[spring_slot - topology->row_spring_slots] = tip;
}

/// Find both slots of a spring, in its direction if it has one.
void mspringi_topology_ends(const mspringi_topology *topology, mspringi_spring_slot spring_slot, uint32_t *base,
                            uint32_t *tip);

#endif
