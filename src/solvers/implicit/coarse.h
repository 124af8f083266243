/// @file coarse.h
/// The coarse matrix of the two-level preconditioner: three unknowns to a tile, factored by Cholesky's method
/// within its envelope (skyline), in double precision, since a long thin bar of tiles has a condition number of
/// 10^8.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_COARSE_H
#define MSPRINGI_COARSE_H

#include "solvers/implicit/tiles.h"

/// Displacement in x and y, and turn.
#define MSPRINGI_RIGID 3

typedef struct mspringi_coarse {
    uint32_t count;  ///< tiles
    uint32_t *first; ///< [tiles] the lowest tile in each tile's part of the envelope
    size_t *row;     ///< [tiles] where its three rows begin in values, each 3 * (tile - first + 1) long
    double *values;  ///< the lower triangle, then its factor with reciprocals on the diagonal
    double *kept;    ///< the values of another time
    size_t value_count;
    double *far_turns; ///< [blocks] what each block's springs resist a turn of the earlier of its tiles with
    double (*restricted)[MSPRINGI_RIGID]; ///< [tiles] the right-hand side
} mspringi_coarse;

/// Multiply-adds that factoring takes with these tiles.
double mspringi_coarse_cost(const mspringi_tiles *tiles);

/// Make a matrix for these tiles, and for what they may become.
mspring_result mspringi_coarse_create(mspringi_coarse *coarse, const mspringi_tiles *tiles, mspringi_memory *memory,
                                      mspringi_message *message);
extern const mspringi_array_table mspringi_coarse_columns;
void mspringi_coarse_destroy(mspringi_coarse *coarse, mspringi_memory *memory);

/// Take over the tiles that there are now.
void mspringi_coarse_shape(mspringi_coarse *coarse, const mspringi_tiles *tiles);

/// What Z^T A Z is made of. Springs inside a tile are left out: they resist a turn of it with their tension only.
typedef struct mspringi_coarse_parts {
    const mspringi_system_kernels *kernels;
    const mspringi_iterate *iterate;
    const float *factors, *mass;
} mspringi_coarse_parts;

/// Compute the rows of the tiles of cells first to end - 1, but for what these get from later tiles' springs.
void mspringi_coarse_assemble(mspringi_coarse *coarse, const mspringi_tiles *tiles,
                              const mspringi_coarse_parts *parts, uint32_t first, uint32_t end);

/// Add that, and springs to pinned particles, when all rows are there.
void mspringi_coarse_complete(mspringi_coarse *coarse, const mspringi_tiles *tiles,
                              const mspringi_coarse_parts *parts);

/// Add what holds a particle at (x, y) from its tile's mass centre to the tile's block on the diagonal.
void mspringi_coarse_add(mspringi_coarse *coarse, uint32_t tile, double xx, double xy, double yy, double x,
                         double y);

/// What pulls at the rigid motions of a few tiles at once.
typedef struct mspringi_coarse_rank_one {
    uint32_t count, tiles[3];
    double rows[3][MSPRINGI_RIGID];
} mspringi_coarse_rank_one;

/// Add the product of that with itself. Where the envelope has no place for two of the tiles, what is added is
/// more.
void mspringi_coarse_add_rank_one(mspringi_coarse *coarse, const mspringi_coarse_rank_one *pulls);

/// Factor in place. Never fails: a pivot that rounding has made too small is replaced.
void mspringi_coarse_factor(mspringi_coarse *coarse);

/// Keep the factor, and take back what was kept. The tiles must be the same ones.
void mspringi_coarse_keep(const mspringi_coarse *coarse);
void mspringi_coarse_restore(const mspringi_coarse *coarse);

/// Solve for restricted. Returns restricted . unknowns.
double mspringi_coarse_solve(const mspringi_coarse *coarse, double (*unknowns)[MSPRINGI_RIGID]);

#endif
