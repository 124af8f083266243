/// @file tiles.h
/// Tiles: small parts of a network, each moving as a rigid body in the coarse space of the two-level
/// preconditioner.
///
/// A tile is a connected component of live springs inside a cell, so that the two sides of a crack are never one
/// body. Pinned particles are in no tile. Where more springs break than there is room for tiles, cells in many
/// pieces are one tile each again: the preconditioner is worse then, the result the same but for the iterations.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TILES_H
#define MSPRINGI_TILES_H

#include "cells.h"

typedef struct mspringi_tiles {
    mspringi_cells cells;
    uint32_t count, capacity;
    uint32_t *first_part;      ///< [capacity + 1]
    mspringi_tile_part *parts; ///< tile after tile, at most one for each particle
    uint32_t *of_slot;         ///< [slots] MSPRING_NONE: none
    uint32_t *first_of_cell;   ///< [cells + 1] tiles follow the order of their cells
    uint32_t *parent;          ///< [slots] of a slot in the forest of components
    mspringi_joint *anchors;   ///< springs inside a cell to pinned particles
    uint32_t anchor_count, anchor_capacity;
    size_t value_capacity; ///< most numbers that the coarse matrix may have
    uint32_t *dirty;       ///< cells to be looked at again
    uint32_t dirty_count;
    uint8_t *is_dirty;  ///< [cells]
    float turn_inertia; ///< m^2; what is added to a tile's moment of inertia for each kg
    uint64_t print;     ///< hash of all this
} mspringi_tiles;

mspring_result mspringi_tiles_create(mspringi_tiles *tiles, const mspring_network *network, uint32_t size,
                                     mspringi_memory *memory, mspringi_message *message);
/// Have the bodies turn as hard as those of other tiles of the same network, in which rest lengths may have been
/// others.
void mspringi_tiles_take_inertia(mspringi_tiles *tiles, const mspringi_tiles *from, size_t slots);
void mspringi_tiles_destroy(mspringi_tiles *tiles, mspringi_memory *memory);

/// Numbers in the coarse matrix of these tiles.
size_t mspringi_tiles_coarse_values(const mspringi_tiles *tiles);

/// The lowest tile in the coarse matrix's envelope for a tile of a cell.
static inline uint32_t mspringi_tiles_envelope(const mspringi_tiles *tiles, uint32_t cell) {
    return tiles->first_of_cell[tiles->cells.lowest[cell]];
}

/// Whether springs or pins that tiles depend on were edited since seen.
bool mspringi_tiles_are_outdated(const mspringi_tiles *tiles, const mspring_network *network,
                                 const mspringi_edits *seen);

/// Follow the edits since seen. Allocates nothing.
void mspringi_tiles_follow(mspringi_tiles *tiles, const mspring_network *network, const mspringi_edits *seen);

#endif
