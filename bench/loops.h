/// @file loops.h
/// Other ways to write the loop of a step than the naive one, for networks on grids. Each is compiled on its own.
///
///   rectangle   structures of arrays, a loop for each direction that the compiler makes vectors of; only for full
///               rectangles of equal springs
///   squares     four springs between four particles at a time, in SSE registers, with approximate reciprocal
///   roots,
///               as a game's hand-written kernel has it; what lies in no square one by one
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_LOOPS_H
#define BENCH_LOOPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "naive.h"

/// Where particles lie on a grid, row by row.
typedef struct bench_grid {
    uint32_t columns, rows;
    uint32_t *place; ///< [columns * rows] particle; BENCH_NOBODY: none
} bench_grid;

#define BENCH_NOBODY UINT32_MAX

typedef struct bench_loop {
    const char *name;
    size_t size; ///< of its state, in bytes
    /// Fill from a naive network. false: out of memory, or it is not one of those that the loop is for.
    bool (*begin)(void *self, const naive_network *from, const bench_grid *grid);
    void (*reset)(void *self, const naive_network *from);
    void (*step)(void *self, const naive_network *from, double dt, uint32_t substeps);
    void (*get)(const void *self, uint32_t particle, float *x, float *y);
    void (*end)(void *self);
} bench_loop;

extern const bench_loop bench_rectangle;
#ifdef BENCH_X86
extern const bench_loop bench_squares;
#endif

#endif
