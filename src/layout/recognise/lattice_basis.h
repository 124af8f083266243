/// @file lattice_basis.h
/// In which directions, and how far away, a particle's neighbours in a grid lie: the steps to the next column and
/// to the next row. The frame of a grid's first particle follows from its springs; from there each particle has the
/// one that it was reached with, turned and stretched half way to where it was found to lie. So grids may lie at
/// any angle, have oblong or slanted cells, and bend.
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
    mspringi_grid_step column, row; ///< no multiples of each other
} mspringi_lattice_basis;

float mspringi_step_square(mspringi_grid_step step);

/// Upright and square.
mspringi_lattice_basis mspringi_lattice_basis_upright(float spacing);

/// Of two steps that span one. The column leads to the right rather than up, the row up.
mspringi_lattice_basis mspringi_lattice_basis_from(mspringi_grid_step a, mspringi_grid_step b);

/// Whether two steps can be those of a frame: 53 to 127 degrees from each other, which takes in the sides of
/// squares and of triangles, and leaves out a square's side and its diagonal.
bool mspringi_lattice_basis_is_spanned(mspringi_grid_step column, mspringi_grid_step row);

/// Columns and rows to somewhere; false if that is none of the nearest eight, or too far off it.
bool mspringi_lattice_basis_round(mspringi_lattice_basis frame, mspringi_grid_step way, int32_t *columns,
                                  int32_t *rows);

/// Ways to neighbours whose cells are known, and the frames of these.
typedef struct mspringi_basis_fit {
    mspringi_lattice_basis frames, ways; ///< sums: of frames, of ways times columns and times rows
    float columns, rows, both_counts;    ///< sums of squares and products of columns and rows
    uint32_t count;
} mspringi_basis_fit;

void mspringi_basis_fit_add(mspringi_basis_fit *fit, mspringi_lattice_basis frame, mspringi_grid_step way,
                            int32_t columns, int32_t rows);

/// The frame that fits best: near the mean of the neighbours', and with them where they are.
mspringi_lattice_basis mspringi_basis_fit_result(const mspringi_basis_fit *fit);

#endif
