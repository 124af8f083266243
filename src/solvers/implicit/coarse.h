/// @file coarse.h
/// The coarse matrix of the two-level preconditioner: three unknowns to a tile, factored by Cholesky's method, in
/// double precision, since a long thin bar of tiles has a condition number of 10^8. It has an entry wherever the
/// factor may have one (cells.h).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_COARSE_H
#define MSPRINGI_COARSE_H

#include "solvers/implicit/tiles.h"

/// Rigid motions of a tile: displacement in x and y, and rotation.
#define MSPRINGI_RIGID 3

typedef struct mspringi_coarse {
    uint32_t count;    ///< tiles
    size_t *first;     ///< [tiles + 1] where a tile's row begins in entries
    uint32_t *entries; ///< tiles for which a row has blocks, ascending; the last one is the row's own
    uint32_t *place;   ///< [tiles] 1 + a tile's place in the row that is being factored; between rows 0
    double *values;    ///< the lower triangle, then its factor: of each row its three, one after the other
    double *kept;      ///< the values of another time
    size_t value_count;
    double *far_turns; ///< [entries] stiffness of each block's springs against a rotation of its earlier tile
    double (*restricted)[MSPRINGI_RIGID]; ///< [tiles] the right-hand side
} mspringi_coarse;

/// Multiply-adds that factoring takes with these tiles, about.
double mspringi_coarse_cost(const mspringi_tiles *tiles);

/// Make a matrix for these tiles, and for what they may become.
mspring_result mspringi_coarse_create(mspringi_coarse *coarse, const mspringi_tiles *tiles, mspringi_memory *memory,
                                      mspringi_message *message);
extern const mspringi_array_table mspringi_coarse_columns;
void mspringi_coarse_destroy(mspringi_coarse *coarse, mspringi_memory *memory);

/// Adapt the entries to the present tiles.
void mspringi_coarse_shape(mspringi_coarse *coarse, const mspringi_tiles *tiles);

/// Parts of Z^T A Z. Springs inside a tile are left out: only their tension resists a turn of the tile.
typedef struct mspringi_coarse_parts {
    const mspringi_system_kernels *kernels;
    const mspringi_iterate *iterate;
    const float *factors, *mass;
} mspringi_coarse_parts;

/// Compute the rows of the tiles of cells first to end - 1, without the shares of later tiles' springs.
void mspringi_coarse_assemble(mspringi_coarse *coarse, const mspringi_tiles *tiles,
                              const mspringi_coarse_parts *parts, uint32_t first, uint32_t end);

/// Add those shares, and springs to pinned particles, once all rows are computed.
void mspringi_coarse_complete(mspringi_coarse *coarse, const mspringi_tiles *tiles,
                              const mspringi_coarse_parts *parts);

/// Vector over the rigid motions of a few tiles, at most so many.
#define MSPRINGI_COARSE_PULLS 8u
typedef struct mspringi_coarse_rank_one {
    uint32_t count, tiles[MSPRINGI_COARSE_PULLS];
    double rows[MSPRINGI_COARSE_PULLS][MSPRINGI_RIGID];
} mspringi_coarse_rank_one;

/// Add its product with itself, a matrix of rank one. If there is no entry for two tiles, an upper bound is
/// added.
void mspringi_coarse_add_rank_one(mspringi_coarse *coarse, const mspringi_coarse_rank_one *pulls);

/// Factor in place. Never fails: a pivot spoilt by rounding is replaced.
void mspringi_coarse_factor(mspringi_coarse *coarse);

/// Save the factor, and restore it. The tiles must be the same.
void mspringi_coarse_keep(const mspringi_coarse *coarse);
void mspringi_coarse_restore(const mspringi_coarse *coarse);

/// Solve for restricted. Returns restricted . unknowns.
double mspringi_coarse_solve(const mspringi_coarse *coarse, double (*unknowns)[MSPRINGI_RIGID]);

#endif
