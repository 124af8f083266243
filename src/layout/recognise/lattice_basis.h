/// @file lattice_basis.h
/// Lattice basis of a grid's particle: vectors to the next column and to the next row. The first particle's basis
/// follows from its springs. Each other particle inherits a basis, turned and stretched half way to the positions
/// of its neighbours. So grids may lie at any angle, bend, and have oblong or slanted cells.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LATTICE_BASIS_H
#define MSPRINGI_LATTICE_BASIS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct mspringi_grid_step {
    float x, y;
} mspringi_grid_step;

typedef struct mspringi_lattice_basis {
    mspringi_grid_step column, row; ///< not parallel
} mspringi_lattice_basis;

float mspringi_square_length(mspringi_grid_step step);

/// Axis-aligned square basis.
mspringi_lattice_basis mspringi_lattice_basis_aligned(float spacing);

/// Basis of two vectors that span one. The column vector leads right rather than up, the row vector up.
mspringi_lattice_basis mspringi_lattice_basis_of(mspringi_grid_step a, mspringi_grid_step b);

/// True if two vectors can form a basis: 53 to 127 degrees apart. The sides of squares and of triangles can, a
/// square's side and its diagonal cannot.
bool mspringi_lattice_basis_is_spanned(mspringi_grid_step column, mspringi_grid_step row);

/// Round a vector to columns and rows, -1 to 1; false if it is too far off.
bool mspringi_lattice_basis_round(mspringi_lattice_basis basis, mspringi_grid_step vector, int32_t *columns,
                                  int32_t *rows);

/// Vectors to neighbours in known cells, and their bases.
typedef struct mspringi_basis_fit {
    mspringi_lattice_basis bases, vectors; ///< sums: of bases; of vectors times columns, times rows
    float columns, rows, both_counts;      ///< sums of squares and products of columns and rows
    uint32_t count;
} mspringi_basis_fit;

void mspringi_basis_fit_add(mspringi_basis_fit *fit, mspringi_lattice_basis basis, mspringi_grid_step vector,
                            int32_t columns, int32_t rows);

/// Best fit: close to the mean of the neighbours' bases, and to their positions.
mspringi_lattice_basis mspringi_basis_fit_result(const mspringi_basis_fit *fit);

#endif
