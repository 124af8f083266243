/// @file system_double.h
/// Matrix blocks in double precision for a direct solution: see solvers/direct/direct.c. Plain C in blocks of
/// MSPRINGI_WIDTH lanes, as in system_assemble.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_DOUBLE_H
#define MSPRINGI_SYSTEM_DOUBLE_H

#include "kernels/system.h"

// Lanes without a spring are 0. No sum is -0, so adding 0 changes nothing.
static inline void add_lanes(double *restrict to, const double *restrict values, uint32_t lanes) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        to[i] += lanes >> i & 1 ? values[i] : 0.0;
}

static void add_edges(const mspringi_edge_block *block, const float *restrict factors,
                      const mspringi_blocks_double *edges, const mspringi_blocks_double *nodes) {
    double xx[MSPRINGI_WIDTH], xy[MSPRINGI_WIDTH], yy[MSPRINGI_WIDTH];
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double pull_x = (double)factors[MSPRINGI_PULL_X * MSPRINGI_WIDTH + i];
        const double pull_y = (double)factors[MSPRINGI_PULL_Y * MSPRINGI_WIDTH + i];
        const double geometric = (double)factors[MSPRINGI_GEOMETRIC * MSPRINGI_WIDTH + i];
        xx[i] = geometric + pull_x * pull_x;
        xy[i] = pull_x * pull_y;
        yy[i] = geometric + pull_y * pull_y;
    }
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        edges->xx[i] = -xx[i];
        edges->xy[i] = -xy[i];
        edges->yy[i] = -yy[i];
    }
    // A node with two springs here adds that of the lower spring slot first, as one by one.
    const uint32_t first = block->base < block->tip ? block->tip : block->base;
    const uint32_t second = block->base < block->tip ? block->base : block->tip;
    add_lanes(nodes->xx + first, xx, block->lanes);
    add_lanes(nodes->xy + first, xy, block->lanes);
    add_lanes(nodes->yy + first, yy, block->lanes);
    add_lanes(nodes->xx + second, xx, block->lanes);
    add_lanes(nodes->xy + second, xy, block->lanes);
    add_lanes(nodes->yy + second, yy, block->lanes);
}

#endif
