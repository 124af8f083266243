/// @file lanczos.h
/// The largest eigenvalue of a symmetric operator.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LANCZOS_H
#define MSPRINGI_LANCZOS_H

#include <stddef.h>

/// out = S in, both of the same length; S is symmetric.
typedef void (*mspringi_operator)(const void *context, const double *in, double *out);

typedef struct mspringi_lanczos {
    mspringi_operator apply;
    const void *context;
    size_t size;
    double *vector;  ///< [size] where to start from; becomes the eigenvector, of length 1
    double *work[3]; ///< [size] each
} mspringi_lanczos;

/// An eigenvalue of S lies within residual of value, as a rule the largest: value itself is never above that.
typedef struct mspringi_ritz {
    double value, residual;
} mspringi_ritz;

/// Iterate until the residual is at most tolerance * value.
mspringi_ritz mspringi_lanczos_largest(const mspringi_lanczos *problem, double tolerance);

/// A number from -1 to 1 for each n, as if at random.
double mspringi_noise(size_t n);

#endif
