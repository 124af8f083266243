/// @file tridiagonal.h
/// Tridiagonal matrix of a Lanczos iteration.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TRIDIAGONAL_H
#define MSPRINGI_TRIDIAGONAL_H

/// Largest dimension of the Krylov space. The lattices and graphs of the tests take 20 to 120.
#define MSPRINGI_LANCZOS_MAX 300

typedef struct mspringi_tridiagonal {
    int size;
    double diagonal[MSPRINGI_LANCZOS_MAX];
    double off_diagonal[MSPRINGI_LANCZOS_MAX]; ///< element i couples i and i + 1; the last is not read
} mspringi_tridiagonal;

/// Largest eigenvalue, from above, and its eigenvector, of length 1.
double mspringi_tridiagonal_top(const mspringi_tridiagonal *t, double *vector);

#endif
