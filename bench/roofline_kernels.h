/// @file roofline_kernels.h
/// Loops that run into one limit of the machine each. One table for each instruction set, all made by
/// roofline_loops.h.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_ROOFLINE_KERNELS_H
#define BENCH_ROOFLINE_KERNELS_H

#include <stddef.h>
#include <stdint.h>

/// Vector operations in a round of add_mul: six independent chains of each, more than latency times throughput.
#define ROOFLINE_OPERATIONS 12
/// Square roots, and divisions, in a round of sqrt_div.
#define ROOFLINE_PAIRS 8

/// What the sweep of a lattice moves for a particle and its four springs: read-only floats (the springs' stiffness,
/// stiffness times rest length and damping; mass and constant force), and floats that are read and written back
/// (position and velocity). That is 19 bytes read and 4 written for a spring.
#define ROOFLINE_PARAMETERS 15
#define ROOFLINE_STATE 4

typedef struct roofline_kernels {
    uint32_t lanes;
    void (*add_mul)(uint64_t rounds, float *sink);
    void (*sqrt_div)(uint64_t rounds, float *sink);
    /// One sweep over count particles, a multiple of 16, with their parameters and state in blocks of lanes.
    void (*sweep)(const float *parameters, float *state, size_t count);
} roofline_kernels;

extern const roofline_kernels bench_roofline_scalar;
#ifdef BENCH_X86
extern const roofline_kernels bench_roofline_sse2, bench_roofline_avx2, bench_roofline_avx512;
#elif defined(BENCH_AARCH64)
extern const roofline_kernels bench_roofline_neon;
#endif

#endif
