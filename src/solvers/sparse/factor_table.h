/// @file factor_table.h
/// Both precisions of one instruction set, and the table of them. Included by one file per level, which defines
/// MSPRINGI_VECTOR_BYTES (0: no vectors), MSPRINGI_TILE_VECTORS, MSPRINGI_TABLE and MSPRINGI_LEVEL.
///
/// SPDX-License-Identifier: MIT

#include <float.h>
#include <string.h>

#include "base/target.h"
#include "solvers/sparse/factor_kernels.h"
#include "solvers/sparse/symbolic.h"

#if defined(__clang__)
#define MSPRINGI_UNROLL _Pragma("unroll")
#elif defined(__GNUC__)
#define MSPRINGI_UNROLL _Pragma("GCC unroll 16")
#else
#define MSPRINGI_UNROLL
#endif

// Vectors of a compiler that has them as types; of others, one number.
#if defined(__GNUC__) && MSPRINGI_VECTOR_BYTES > 0
#define VECTORS_OF(type) __attribute__((vector_size(MSPRINGI_VECTOR_BYTES), may_alias)) type
#define VECTORS_ANYWHERE_OF(type)                                                                                  \
    __attribute__((vector_size(MSPRINGI_VECTOR_BYTES), may_alias, aligned(sizeof(type)))) type
#else
#define VECTORS_OF(type) type
#define VECTORS_ANYWHERE_OF(type) type
#endif
// As wide as four numbers at most: the rows of a group of a banded factor.
#if defined(__GNUC__) && MSPRINGI_VECTOR_BYTES > 16
typedef __attribute__((vector_size(16), may_alias)) float band_vector_float;
typedef __attribute__((vector_size(32), may_alias)) double band_vector_double;
#else
typedef VECTORS_OF(float) band_vector_float;
typedef VECTORS_OF(double) band_vector_double;
#endif
typedef VECTORS_OF(float) vector_float;
typedef VECTORS_OF(double) vector_double;
typedef VECTORS_OF(uint32_t) mask_float;
typedef VECTORS_OF(uint64_t) mask_double;
typedef VECTORS_ANYWHERE_OF(float) vector_anywhere_float;
typedef VECTORS_ANYWHERE_OF(double) vector_anywhere_double;
typedef VECTORS_ANYWHERE_OF(uint32_t) mask_anywhere_float;
typedef VECTORS_ANYWHERE_OF(uint64_t) mask_anywhere_double;

// Read from n before the middle on: ones in n lanes.
#define FOUR(value) value, value, value, value
#define SIXTEEN(value) FOUR(value), FOUR(value), FOUR(value), FOUR(value)
static const uint32_t masks_float[2 * MSPRINGI_PAD] = {SIXTEEN(UINT32_MAX)};
static const uint64_t masks_double[2 * MSPRINGI_PAD] = {SIXTEEN(UINT64_MAX)};

#define NAME(name) name##_float
#define REAL float
#define VECTOR vector_float
#define BAND_VECTOR band_vector_float
#define VECTOR_ANYWHERE vector_anywhere_float
#define MASK mask_float
#define MASK_ANYWHERE mask_anywhere_float
#define SMALLEST FLT_MIN
#define LARGEST FLT_MAX
#define FACTOR mspringi_cholesky_float
#define MATRIX mspringi_cholesky_matrix_float
#include "solvers/sparse/numeric.h"
#undef NAME
#undef REAL
#undef VECTOR
#undef BAND_VECTOR
#undef VECTOR_ANYWHERE
#undef MASK
#undef MASK_ANYWHERE
#undef SMALLEST
#undef LARGEST
#undef FACTOR
#undef MATRIX

#define NAME(name) name##_double
#define REAL double
#define VECTOR vector_double
#define BAND_VECTOR band_vector_double
#define VECTOR_ANYWHERE vector_anywhere_double
#define MASK mask_double
#define MASK_ANYWHERE mask_anywhere_double
#define SMALLEST DBL_MIN
#define LARGEST DBL_MAX
#define FACTOR mspringi_cholesky_double
#define MATRIX mspringi_cholesky_matrix_double
#include "solvers/sparse/numeric.h"

const mspringi_cholesky_kernels MSPRINGI_TABLE = {
    .level = MSPRINGI_LEVEL,
    .factor_float = factor_float,
    .solve_float = solve_float,
    .factor_solve_float = factor_solve_float,
    .factor_double = factor_double,
    .solve_double = solve_double,
    .factor_solve_double = factor_solve_double,
};
