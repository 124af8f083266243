/// @file lanczos.h
/// Largest eigenvalue of a symmetric operator.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LANCZOS_H
#define MSPRINGI_LANCZOS_H

#include <stddef.h>

/// out = S in, of equal length; S is symmetric.
typedef void (*mspringi_operator)(const void *context, const double *in, double *out);

typedef struct mspringi_lanczos {
    mspringi_operator apply;
    const void *context;
    size_t size;
    double *vector;  ///< [size] start; becomes the eigenvector, of length 1
    double *work[3]; ///< [size] each
} mspringi_lanczos;

/// Approximation of the largest eigenvalue, from below. Some eigenvalue of S, as a rule the largest, lies within
/// residual of value.
typedef struct mspringi_ritz {
    double value, residual;
} mspringi_ritz;

/// Iterate until the residual is at most tolerance * value.
mspringi_ritz mspringi_lanczos_largest(const mspringi_lanczos *problem, double tolerance);

/// Pseudo-random number from -1 to 1 for each n.
double mspringi_noise(size_t n);

#endif
