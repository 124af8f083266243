/// @file table.h
/// Both precisions of one instruction set, and the table of them. Included by one file per level, which defines
/// MSPRINGI_VECTOR_BYTES (0: no vectors), MSPRINGI_TILE_VECTORS, MSPRINGI_TABLE and MSPRINGI_LEVEL.
///
/// SPDX-License-Identifier: MIT

#include <float.h>
#include <string.h>

#include "kernels.h"
#include "plan.h"

#if defined(_MSC_VER) && !defined(__clang__)
#define MSPRINGI_INLINE static __forceinline
#else
#define MSPRINGI_INLINE static inline __attribute__((always_inline))
#endif

#if defined(__clang__)
#define MSPRINGI_UNROLL _Pragma("unroll")
#elif defined(__GNUC__)
#define MSPRINGI_UNROLL _Pragma("GCC unroll 16")
#else
#define MSPRINGI_UNROLL
#endif

// Vectors of a compiler that has them as types; of others, one number.
#if defined(__GNUC__) && MSPRINGI_VECTOR_BYTES > 0
typedef float vector_float __attribute__((vector_size(MSPRINGI_VECTOR_BYTES), may_alias));
typedef double vector_double __attribute__((vector_size(MSPRINGI_VECTOR_BYTES), may_alias));
#else
typedef float vector_float;
typedef double vector_double;
#endif

#define NAME(name) name##_float
#define REAL float
#define VECTOR vector_float
#define SMALLEST FLT_MIN
#define LARGEST FLT_MAX
#define FACTOR mspringi_cholesky_float
#define MATRIX mspringi_cholesky_matrix_float
#include "numeric.h"
#undef NAME
#undef REAL
#undef VECTOR
#undef SMALLEST
#undef LARGEST
#undef FACTOR
#undef MATRIX

#define NAME(name) name##_double
#define REAL double
#define VECTOR vector_double
#define SMALLEST DBL_MIN
#define LARGEST DBL_MAX
#define FACTOR mspringi_cholesky_double
#define MATRIX mspringi_cholesky_matrix_double
#include "numeric.h"

const mspringi_cholesky_kernels MSPRINGI_TABLE = {
    .level = MSPRINGI_LEVEL,
    .factor_float = factor_float,
    .solve_float = solve_float,
    .factor_double = factor_double,
    .solve_double = solve_double,
};
