/// @file topology.h
/// From particles and springs to rows: which particles lie on grids, which on chains, and in which slot.
///
/// A slot is an index into the state arrays. Slots come in blocks of MSPRINGI_WIDTH, a block being that many
/// columns of one row. There are four kinds of row:
///
///   lattice  one row of a grid; each block has a record of four springs per slot (see mspringi_direction)
///   chain    chains packed end to end; a record of one spring per slot, to the next slot
///   irregular particles with other springs; records by slice column, see layout/emit/sell.h. Bundles
///   (layout/recognise/
///            equal_components.c) have a row of their own, whose spans have nothing to do with each other
///   loose    particles without a spring; no record
///
/// A spring that lies in no lattice or chain row is left over: the irregular part has it. Irregular particles that
/// hang on a lattice have an assigned strip: the strip of lattice rows that they are swept with, so that several
/// substeps can be taken in one pass over the strips. A large irregular part without an assigned strip has layers
/// for the same purpose, and so have the chains that hang on it: they are part of it.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TOPOLOGY_H
#define MSPRINGI_TOPOLOGY_H

#include "base/array_table.h"
#include "base/assert.h"
#include "builder/builder.h"
#include "layout/emit/sell.h"

/// The springs of a lattice slot in column c of row r. East, north and north-east start at the slot; south-east
/// starts one row up, at (c, r + 1), so that all of them reach one column to the right at most and every load is
/// contiguous.
typedef enum mspringi_direction {
    MSPRINGI_EAST = 0,       ///< (c, r)     to (c + 1, r)
    MSPRINGI_NORTH = 1,      ///< (c, r)     to (c, r + 1)
    MSPRINGI_NORTH_EAST = 2, ///< (c, r)     to (c + 1, r + 1)
    MSPRINGI_SOUTH_EAST = 3, ///< (c, r + 1) to (c + 1, r)
    MSPRINGI_DIRECTIONS = 4
} mspringi_direction;

/// Where a spring lies: below lattice_spring_slots a lattice record, (block * MSPRINGI_DIRECTIONS + direction) *
/// MSPRINGI_WIDTH + lane; below chain_spring_slots a chain record, lattice_spring_slots + block * MSPRINGI_WIDTH +
/// lane; above that, chain_spring_slots + number among the irregular springs, behind which are those with spare ids
/// (see layout/emit/spare.h) and the inactive ones. Block counts from the first of its kind.
typedef uint32_t mspringi_spring_slot;

/// Lanes of the narrowest vector register.
#define MSPRINGI_QUARTER 4

typedef enum mspringi_row_kind {
    MSPRINGI_ROW_LATTICE,   ///< all four springs
    MSPRINGI_ROW_CHAIN,     ///< east springs only
    MSPRINGI_ROW_IRREGULAR, ///< springs of the irregular part
    MSPRINGI_ROW_LOOSE      ///< none
} mspringi_row_kind;

/// Consecutive slots of a row: whole blocks, less quarters at their ends that hold no particle and no spring.
typedef struct mspringi_span {
    uint32_t first_slot, end_slot; ///< multiples of MSPRINGI_QUARTER
    uint32_t first_record; ///< record of the block of first_slot (lattice, chain), or its group (irregular part)
    uint32_t record_slots; ///< springs in a record: MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH or MSPRINGI_WIDTH
    int64_t up;            ///< from a slot to the one above it; 0 if nothing is (lattice)
    int64_t carry;         ///< from a slot to its place in the carry row (lattice, chain)
} mspringi_span;

/// Spans that are swept in one go.
typedef struct mspringi_row {
    mspringi_row_kind kind; ///< of a grid's row with nothing above any of it MSPRINGI_ROW_CHAIN
    uint32_t first_span, span_count;
} mspringi_row;

/// Rows that follow each other, with what the irregular part has to do with them.
typedef struct mspringi_strip {
    uint32_t first_row, row_count;
    uint32_t first_attached,
        attached_count;     ///< nodes of the irregular part among the slots of its lattice and chain rows
    uint32_t assigned_span; ///< span of the irregular part's particles that are swept with it, or MSPRING_NONE
} mspringi_strip;

typedef struct mspringi_empty_run {
    uint32_t first_slot, slot_count;
} mspringi_empty_run;

/// Ids that there can be: those that a network is created with, and behind them spare ones for what is added later.
typedef struct mspringi_reserve {
    uint32_t first_particle, first_spring; ///< first spare ones
    uint32_t particle_end, spring_end;     ///< behind the last
} mspringi_reserve;

typedef struct mspringi_topology {
    uint32_t particle_count, spring_count; ///< ids so far
    mspringi_reserve reserve;
    uint32_t
        block_count; ///< with padding in front, behind, and between rows and what follows: lane + 1 can be read
    uint32_t lattice_first, lattice_blocks; ///< blocks: first, number
    uint32_t chain_first, chain_blocks;
    uint32_t irregular_first, irregular_blocks;
    uint32_t loose_first, loose_blocks;
    uint32_t spare_first, spare_blocks; ///< behind the loose ones: a slot for each spare particle

    uint32_t *slot_of_particle;           ///< [reserve.particle_end]
    uint32_t *particle_of_slot;           ///< [block_count * MSPRINGI_WIDTH], MSPRING_NONE where there is none
    mspringi_spring_slot *slot_of_spring; ///< [reserve.spring_end]
    uint32_t *up_of_block; ///< [lattice_blocks] block above each lattice block; itself if there is none

    uint32_t *grid_of_row; ///< [lattice_rows] number of the grid of each of the first rows

    mspringi_empty_run *empty_runs; ///< slots that hold no particle, and are for none
    uint32_t empty_run_count;

    mspringi_spring_slot lattice_spring_slots, chain_spring_slots;
    uint32_t irregular_count;    ///< springs of the irregular part, and as many more as spare ids have been used
    uint32_t laid_out_count;     ///< springs of the irregular part
    uint32_t irregular_capacity; ///< laid_out_count, and a place for each spare spring
    uint32_t inactive_count;     ///< springs that are broken and that nothing sweeps, see network/survivors.c
    uint32_t *irregular_a, *irregular_b;            ///< [irregular_capacity + inactive_count] slots
    uint32_t *initial_slots, *initial_spring_slots; ///< of the spare ids, when the topology was made
    uint32_t initial_particles;                     ///< of these laid out with the others: the first ones
    mspringi_sell irregular;

    mspringi_span *spans;
    uint32_t span_count;
    mspringi_span *trimmed_spans; ///< the lattices' spans without registers that need not be swept; NULL if a
                                  ///< register is a block
    uint32_t *first_trimmed;      ///< [trimmed_count + 1] where those of each span begin
    uint32_t trimmed_count;       ///< spans that they are of: the lattices'
    mspringi_row *rows;           ///< lattice rows first
    uint32_t row_count;
    mspringi_strip *strips; ///< all rows, in order
    uint32_t strip_count;
    uint32_t wavefront_rows;   ///< lattice rows, the first ones, that can be swept for several substeps in one pass
    uint32_t wavefront_strips; ///< the strips that they are in
    uint32_t skew;             ///< strips by which each substep of such a pass must stay behind the one before
    uint32_t carry_blocks;     ///< blocks of the carry row
    uint32_t
        bundle_strip; ///< strip of the irregular part's equal components that stand in bundles, or MSPRING_NONE
    uint32_t bundle_springs; ///< springs of these

    uint32_t parallel_count; ///< springs that lie beside another
    uint32_t
        layer_count; ///< of the irregular row, if it is swept in layers, each with springs to the next ones only
    uint32_t *layer_blocks; ///< [layer_count + 1] where each begins, counted from the row's first block

    // For the plan.
    uint32_t lattice_count, lattice_particles, lattice_springs, lattice_rows;
    uint32_t chain_count, chain_particles, chain_springs;
    uint32_t irregular_particles, loose_particles;
} mspringi_topology;

/// Words of MSPRINGI_WIDTH bits that hold a bit for each place.
static inline size_t mspringi_spring_slot_words(const mspringi_topology *topology) {
    return ((size_t)topology->chain_spring_slots + topology->irregular_capacity + topology->inactive_count +
            MSPRINGI_WIDTH - 1) /
           MSPRINGI_WIDTH;
}

/// Where a spring lies.
static inline mspringi_spring_slot mspringi_slot_of_spring(const mspringi_topology *topology, mspring_id spring) {
    MSPRINGI_ASSERT(spring < topology->reserve.spring_end);
    return topology->slot_of_spring[spring];
}

/// Whether the spring in this place is inactive.
static inline bool mspringi_spring_slot_is_inactive(const mspringi_topology *topology,
                                                    mspringi_spring_slot spring_slot) {
    return spring_slot - topology->chain_spring_slots >= topology->irregular_capacity &&
           spring_slot >= topology->chain_spring_slots;
}

/// Whether the spring in this place has been laid out with the others: it is neither inactive nor in a spare place.
static inline bool mspringi_spring_slot_is_laid_out(const mspringi_topology *topology,
                                                    mspringi_spring_slot spring_slot) {
    return spring_slot < topology->chain_spring_slots + topology->laid_out_count;
}

/// Springs that are swept.
static inline uint32_t mspringi_swept_count(const mspringi_topology *topology) {
    return topology->spring_count - topology->inactive_count;
}

/// Lay out what the builder holds, for steps that so many workers share and make with registers of so many lanes
/// (MSPRINGI_QUARTER or more), with room for spare ids. Lanes make no difference to where anything lies.
mspring_result mspringi_topology_create(mspringi_topology *topology, const mspring_builder *builder,
                                        const mspringi_reserve *reserve, bool has_bundles, uint32_t workers,
                                        uint32_t lanes, mspringi_memory *memory, mspringi_message *message);
/// The same as a list of plain functions: begin, run one after the other until it is done unless one fails, then
/// finish; or abandon at any time, which allows NULL. The builder and what memory and message point to must stay;
/// is_checked: no two of its springs join the same particles. What is finished has places for the builder's springs
/// only, in an array with room for all ids.
typedef struct mspringi_layout_builder mspringi_layout_builder;
mspring_result mspringi_topology_begin(const mspring_builder *builder, const mspringi_reserve *reserve,
                                       bool is_checked, bool has_bundles, uint32_t workers, uint32_t lanes,
                                       mspringi_memory *memory, mspringi_message *message,
                                       mspringi_layout_builder **begun);
/// Run the next function, which takes a millisecond at most for 200,000 springs. How many there are depends neither
/// on workers nor on lanes.
mspring_result mspringi_topology_run(mspringi_layout_builder *begun, bool *is_done);
void mspringi_topology_finish(mspringi_layout_builder *begun, mspringi_memory *memory, mspringi_topology *topology);
void mspringi_topology_abandon(mspringi_layout_builder *begun, mspringi_memory *memory);

/// Its arrays.
extern const mspringi_array_table mspringi_topology_columns;
void mspringi_topology_destroy(mspringi_topology *topology, mspringi_memory *memory);

/// The two slots that the spring in a place of a lattice joins, in the sense of its direction.
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

/// The two slots that a spring joins; where the place has a direction, base and tip in its sense.
void mspringi_topology_ends(const mspringi_topology *topology, mspringi_spring_slot spring_slot, uint32_t *base,
                            uint32_t *tip);

#endif
