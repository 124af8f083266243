/// @file coarse.h
/// The coarse matrix of the two-level preconditioner: three unknowns to a tile, factored by Cholesky's method
/// within its envelope (skyline), in double precision, since a long thin bar of tiles has a condition number of
/// 10^8.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_COARSE_H
#define MSPRINGI_COARSE_H

#include "tiles.h"

/// Displacement in x and y, and turn.
#define MSPRINGI_RIGID 3

typedef struct mspringi_coarse {
    uint32_t count;  ///< tiles
    uint32_t *first; ///< [tiles] the lowest tile in each tile's part of the envelope
    size_t *row;     ///< [tiles] where its three rows begin in values, each 3 * (tile - first + 1) long
    double *values;  ///< the lower triangle, then its factor with reciprocals on the diagonal
    size_t value_count;
    double *unknowns; ///< [tiles][3]
} mspringi_coarse;

/// Multiply-adds that factoring takes with these tiles.
double mspringi_coarse_cost(const mspringi_tiles *tiles);

/// Make a matrix for these tiles, and for what they may become.
mspring_result mspringi_coarse_create(mspringi_coarse *coarse, const mspringi_tiles *tiles, mspringi_memory *memory,
                                      mspringi_message *message);
void mspringi_coarse_destroy(mspringi_coarse *coarse, mspringi_memory *memory);

/// Take over the tiles that there are now.
void mspringi_coarse_shape(mspringi_coarse *coarse, const mspringi_tiles *tiles);

/// Compute Z^T A Z. Springs inside a tile are left out: they resist a turn of it with their tension only.
void mspringi_coarse_assemble(mspringi_coarse *coarse, const mspringi_tiles *tiles, const float *factors,
                              const float *mass, mspringi_field arm);

/// Factor in place. Never fails: a pivot that rounding has made too small is replaced.
void mspringi_coarse_factor(mspringi_coarse *coarse);

/// Solve for the right-hand side in unknowns, in place.
void mspringi_coarse_solve(mspringi_coarse *coarse);

#endif
