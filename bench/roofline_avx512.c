/// @file roofline_avx512.c
/// The roofline's loops for AVX-512.
///
/// SPDX-License-Identifier: MIT
#include <immintrin.h>

#define TABLE bench_roofline_avx512
#define VECTOR __m512
#define LANES 16
#define LOAD(from) _mm512_load_ps(from)
#define STORE(to, value) _mm512_store_ps(to, value)
#define FILL(value) _mm512_set1_ps(value)
#define ADD(a, b) _mm512_add_ps(a, b)
#define MULTIPLY(a, b) _mm512_mul_ps(a, b)
#define DIVIDE(a, b) _mm512_div_ps(a, b)
#define SQUARE_ROOT(a) _mm512_sqrt_ps(a)

#include "roofline_loops.h"
