/// @file tiles.h
/// Tiles: aggregates of the coarse space. Each moves as a rigid body in the two-level preconditioner.
///
/// A tile is a connected component of live springs inside a cell, so both sides of a crack are separate. Pinned
/// particles lie in no tile. If breaks leave more tiles than there is room for, divided cells become one tile each.
/// Then iterations converge more slowly.
#ifndef MSPRINGI_TILES_H
#define MSPRINGI_TILES_H

#include "solvers/implicit/cells.h"
#include "solvers/implicit/paths.h"

typedef struct mspringi_tiles {
    const mspringi_paths *paths; ///< their particles have tiles of their own
    mspringi_cells cells;
    uint32_t count, capacity;
    uint32_t *first_part;              ///< [capacity + 1]
    mspringi_tile_part *parts;         ///< tile after tile, at most one for each particle
    mspringi_tile_part *parts_by_slot; ///< the same, sorted by slot
    uint32_t *first_by_slot;           ///< [slots / MSPRINGI_PART + 1] in parts_by_slot
    uint32_t *of_slot;                 ///< [slots] MSPRING_NONE: none
    uint32_t *first_of_cell;           ///< [cells + 1] tiles follow the order of their cells
    uint32_t *parent;                  ///< [slots] of a slot in the forest of components
    mspringi_cell_edge *pin_edges;     ///< springs of tiles to pinned particles
    uint32_t pin_edge_count, pin_edge_capacity;
    size_t value_capacity; ///< most numbers that the coarse matrix may have
    uint32_t *dirty;       ///< cells to be looked at again
    uint32_t dirty_count;
    uint8_t *is_dirty;    ///< [cells]
    float turn_inertia;   ///< m^2; what is added to a tile's moment of inertia for each kg
    uint64_t fingerprint; ///< hash of all this
} mspringi_tiles;

/// Tiles that are being made.
typedef struct mspringi_tile_builder {
    const mspring_network *network;
    mspringi_memory *memory;
    mspringi_message *message;
    mspringi_tiles *tiles;
    mspringi_cursor cursor;
    mspringi_cell_builder cutting;
    double length; ///< of so many springs at rest
    uint32_t counted;
    uint32_t most; ///< tiles that a cell may be cut into
} mspringi_tile_builder;

/// Make tiles in cells of that size: begin, then run until it is done, then end, on failure too.
void mspringi_tiles_begin(mspringi_tile_builder *tiling, mspringi_tiles *tiles, const mspring_network *network,
                          const mspringi_paths *paths, uint32_t size, double most_cost, mspringi_memory *memory,
                          mspringi_message *message);
mspring_result mspringi_tiles_run(mspringi_tile_builder *tiling, bool *is_done);
void mspringi_tiles_end(mspringi_tile_builder *tiling);
/// Set the added moment of inertia to that of other tiles of the same network, whose rest lengths may have
/// differed.
void mspringi_tiles_set_inertia(mspringi_tiles *tiles, float turn_inertia, size_t slots);
extern const mspringi_array_table mspringi_tiles_columns;
void mspringi_tiles_destroy(mspringi_tiles *tiles, mspringi_memory *memory);

/// Parts by slot.
typedef struct mspringi_part_range {
    const mspringi_tile_part *parts;
    size_t count;
} mspringi_part_range;

/// Those of slots first to end - 1, multiples of MSPRINGI_PART.
static inline mspringi_part_range mspringi_tiles_parts(const mspringi_tiles *tiles, size_t first, size_t end) {
    if (tiles->count == 0)
        return (mspringi_part_range){NULL, 0};
    const uint32_t begin = tiles->first_by_slot[first / MSPRINGI_PART];
    return (mspringi_part_range){tiles->parts_by_slot + begin, tiles->first_by_slot[end / MSPRINGI_PART] - begin};
}

/// Numbers in the coarse matrix of these tiles.
size_t mspringi_tiles_coarse_values(const mspringi_tiles *tiles);
/// The same, if every cell were one tile.
size_t mspringi_tiles_cell_values(const mspringi_tiles *tiles);

/// Tiles of the earlier cells in a cell's row of the coarse matrix's factor.
static inline uint32_t mspringi_tiles_before(const mspringi_tiles *tiles, uint32_t cell) {
    const mspringi_cells *cells = &tiles->cells;
    uint32_t count = 0;
    for (uint32_t i = cells->first_before[cell]; i < cells->first_before[cell + 1]; ++i)
        count += tiles->first_of_cell[cells->before[i] + 1] - tiles->first_of_cell[cells->before[i]];
    return count;
}

/// True if springs or pins that tiles depend on were edited since seen.
bool mspringi_tiles_are_outdated(const mspringi_tiles *tiles, const mspring_network *network,
                                 const mspringi_edits *seen);

/// Update after the edits since seen. Allocates nothing.
void mspringi_tiles_update(mspringi_tiles *tiles, const mspring_network *network, const mspringi_edits *seen);

#endif
