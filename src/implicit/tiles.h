/// @file tiles.h
/// Tiles: small parts of a network, each moving as a rigid body in the coarse space of the two-level
/// preconditioner.
///
/// A tile is a connected component of live springs inside a cell: some rows by some columns of a grid, a piece of
/// a chain, or a neighbourhood in the web. So the two sides of a crack are never one body. Pinned particles and
/// loose ones are in no tile.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TILES_H
#define MSPRINGI_TILES_H

#include "network/network.h"

/// A spring between two tiles, or between a tile and a pinned particle.
typedef struct mspringi_joint {
    uint32_t tile, other;      ///< tile > other, or other MSPRING_NONE
    uint32_t slot, other_slot; ///< its ends in them
    uint32_t factors;          ///< where in the factors
} mspringi_joint;

typedef struct mspringi_tiles {
    uint32_t count;
    uint32_t *first_part;      ///< [count + 1]
    mspringi_tile_part *parts; ///< tile after tile
    uint32_t *tile_of_slot;    ///< [slots] MSPRING_NONE: none
    mspringi_joint *joints;    ///< sorted by tile
    uint32_t joint_count;
    uint32_t size;      ///< rows and columns of a cell in wide grids
    float turn_inertia; ///< m^2; what is added to a tile's moment of inertia for each kg
    uint64_t print;     ///< hash of all this
} mspringi_tiles;

/// Cut a network into tiles with cells of size x size particles. Numbered so that neighbours have near numbers.
mspring_result mspringi_tiles_create(mspringi_tiles *tiles, const mspring_network *network, uint32_t size,
                                     mspringi_memory *memory, mspringi_message *message);
void mspringi_tiles_destroy(mspringi_tiles *tiles, mspringi_memory *memory);

/// Where the factors of a spring begin: lattice, chain and leftover records one behind the other.
uint32_t mspringi_factors_of_place(mspringi_place place);

/// Whether a spring can pull.
bool mspringi_is_live(const mspring_network *network, mspring_id spring);

#endif
