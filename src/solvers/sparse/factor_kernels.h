/// @file factor_kernels.h
/// The numeric part of a factorisation, one table of it per instruction set. All give the same bits.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FACTOR_KERNELS_H
#define MSPRINGI_FACTOR_KERNELS_H

#include "base/target.h"
#include "solvers/sparse/cholesky.h"

struct mspringi_cholesky_kernels {
    mspring_simd level;
    uint32_t (*factor_float)(mspringi_cholesky_float *factor, const mspringi_cholesky_matrix_float *matrix);
    void (*solve_float)(mspringi_cholesky_float *factor, float *x, float *y);
    uint32_t (*factor_solve_float)(mspringi_cholesky_float *factor, const mspringi_cholesky_matrix_float *matrix,
                                   float *x, float *y);
    uint32_t (*factor_double)(mspringi_cholesky_double *factor, const mspringi_cholesky_matrix_double *matrix);
    void (*solve_double)(mspringi_cholesky_double *factor, double *x, double *y);
    uint32_t (*factor_solve_double)(mspringi_cholesky_double *factor, const mspringi_cholesky_matrix_double *matrix,
                                    double *x, double *y);
};

#define LEVEL(name, number) extern const mspringi_cholesky_kernels mspringi_cholesky_##name;
#include "base/levels.def"
#undef LEVEL

/// The table of a level that mspringi_cpu_choose() has given.
const mspringi_cholesky_kernels *mspringi_cholesky_kernels_of(mspring_simd level);

#endif
