/// @file roofline_sse2.c
/// The roofline's loops for SSE2.
///
/// SPDX-License-Identifier: MIT
#include <emmintrin.h>

#define TABLE bench_roofline_sse2
#define VECTOR __m128
#define LANES 4
#define LOAD(from) _mm_load_ps(from)
#define STORE(to, value) _mm_store_ps(to, value)
#define FILL(value) _mm_set1_ps(value)
#define ADD(a, b) _mm_add_ps(a, b)
#define MULTIPLY(a, b) _mm_mul_ps(a, b)
#define DIVIDE(a, b) _mm_div_ps(a, b)
#define SQUARE_ROOT(a) _mm_sqrt_ps(a)

#include "roofline_loops.h"
