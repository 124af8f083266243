/// @file frame.h
/// In which directions, and how far away, a particle's neighbours in a grid lie: the steps to the next column and
/// to the next row. The frame of a grid's first particle follows from its springs; from there each particle has the
/// one that it was reached with, turned and stretched half way to where it was found to lie. So grids may lie at
/// any angle, have oblong or slanted cells, and bend.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FRAME_H
#define MSPRINGI_FRAME_H

#include <stdbool.h>
#include <stdint.h>

typedef struct mspringi_step {
    float x, y;
} mspringi_step;

typedef struct mspringi_frame {
    mspringi_step column, row; ///< no multiples of each other
} mspringi_frame;

float mspringi_step_square(mspringi_step step);

/// Upright and square.
mspringi_frame mspringi_frame_upright(float spacing);

/// Of two steps that span one. The column leads to the right rather than up, the row up.
mspringi_frame mspringi_frame_from(mspringi_step a, mspringi_step b);

/// Whether two steps can be those of a frame: 53 to 127 degrees from each other, which takes in the sides of
/// squares and of triangles, and leaves out a square's side and its diagonal.
bool mspringi_frame_is_spanned(mspringi_step column, mspringi_step row);

/// Columns and rows to somewhere; false if that is none of the nearest eight, or too far off it.
bool mspringi_frame_round(mspringi_frame frame, mspringi_step way, int32_t *columns, int32_t *rows);

/// Ways to neighbours whose cells are known, and the frames of these.
typedef struct mspringi_frame_fit {
    mspringi_frame frames, ways; ///< sums: of frames, of ways times columns and times rows
    float columns, rows, both;   ///< sums of squares and products of columns and rows
    uint32_t count;
} mspringi_frame_fit;

void mspringi_frame_fit_add(mspringi_frame_fit *fit, mspringi_frame frame, mspringi_step way, int32_t columns,
                            int32_t rows);

/// The frame that fits best: near the mean of the neighbours', and with them where they are.
mspringi_frame mspringi_frame_fitted(const mspringi_frame_fit *fit);

#endif
