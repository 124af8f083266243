/// @file roofline_avx2.c
/// The roofline's loops for AVX2.
///
/// SPDX-License-Identifier: MIT
#include <immintrin.h>

#define TABLE bench_roofline_avx2
#define VECTOR __m256
#define LANES 8
#define LOAD(from) _mm256_load_ps(from)
#define STORE(to, value) _mm256_store_ps(to, value)
#define FILL(value) _mm256_set1_ps(value)
#define ADD(a, b) _mm256_add_ps(a, b)
#define MULTIPLY(a, b) _mm256_mul_ps(a, b)
#define DIVIDE(a, b) _mm256_div_ps(a, b)
#define SQUARE_ROOT(a) _mm256_sqrt_ps(a)

#include "roofline_loops.h"
