/// @file tridiagonal.h
/// The matrix that a Lanczos iteration leads to.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TRIDIAGONAL_H
#define MSPRINGI_TRIDIAGONAL_H

/// Largest dimension of the space. The lattices and graphs of the tests take 20 to 120.
#define MSPRINGI_LANCZOS_MOST 300

typedef struct mspringi_tridiagonal {
    int size;
    double diagonal[MSPRINGI_LANCZOS_MOST];
    double beside[MSPRINGI_LANCZOS_MOST]; ///< beside[i] couples i and i + 1; that of the last is not looked at
} mspringi_tridiagonal;

/// The largest eigenvalue, from above, and its eigenvector, of length 1.
double mspringi_tridiagonal_top(const mspringi_tridiagonal *t, double *vector);

#endif
