/// @file inverse_lanes.h
/// The inverse of kernels/inverse_avx512.h and its steps on arrays, compiled for AVX-512 apart from the program,
/// which looks for it first.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_INVERSE_LANES_H
#define TEST_INVERSE_LANES_H

#include <stddef.h>

enum { INVERSE_LANES = 16 };

/// Inverses of the squares at i to i + 15, for each multiple i of stride below count. Return the first i at which a
/// lane is not the inverse given, bit by bit, or count.
size_t inverse_lanes_wrong(const float *squares, const float *inverses, size_t count, size_t stride);

/// The first step from these seeds; count is a multiple of 16.
void inverse_lanes_first(const float *squares, const float *seeds, float *firsts, size_t count);

/// The last step from these results of the first, compared likewise.
size_t inverse_lanes_last_wrong(const float *squares, const float *firsts, const float *inverses, size_t count);

#endif
