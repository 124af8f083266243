/// @file lanczos.h
/// Largest eigenvalue of M^-1 S, with M the masses and S a symmetric matrix over the displacements of all
/// particles.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LANCZOS_H
#define MSPRINGI_LANCZOS_H

#include <stddef.h>

/// Displacement, x and y by slot. Both arrays are in one piece, x first.
typedef struct mspringi_displacement {
    float *x, *y;
} mspringi_displacement;

typedef struct mspringi_lanczos {
    size_t slots;
    const float *inverse_mass; ///< [slots] 0 if pinned
    /// out += M^-1 S in
    void (*add_image)(void *context, mspringi_displacement in, mspringi_displacement out);
    void *context;
    mspringi_displacement here; ///< start; pinned slots have 0
    mspringi_displacement next;
    mspringi_displacement vector; ///< becomes the eigenvector of length 1, unless NULL
    double bound;                 ///< end where the eigenvalue is known to be above or below it; infinite: none
    int least, most;              ///< iterations until it may have converged, and in all
    int period;                   ///< iterations between two looks at the eigenvalue
} mspringi_lanczos;

/// Approximation of the largest eigenvalue, from below. Some eigenvalue, as a rule the largest, lies within
/// residual of value.
typedef struct mspringi_ritz {
    double value, residual;
} mspringi_ritz;

/// Add noise, different for each particle, so that the start contains every mode. Kinetic energy at amount 1: about
/// a sixth for each direction of a particle.
void mspringi_lanczos_add_noise(const mspringi_lanczos *problem, float amount);

/// Iterate until the residual is at most 2e-3 of the value, or the bound decides.
mspringi_ritz mspringi_lanczos_largest(const mspringi_lanczos *problem);

#endif
