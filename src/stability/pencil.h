/// @file pencil.h
/// Stability of a network at a substep, as an eigenvalue problem.
///
/// Around a shape, with displacement x, mass M, tangent stiffness K and damper matrix C, a substep is
///     v' = g v - w h M^-1 (K x + C v);   x' = x + h v';   g = exp(-b h),   w = (1 - g) / (b h),   b =
///     global_damping
/// A solution that grows by z in each substep obeys
///     Q(z) x = 0,   Q(z) = (z - 1)(z - g) + w (z - 1) D + w z A,
///     A = h^2 M^-1/2 K M^-1/2,   D = h M^-1/2 C M^-1/2   (both symmetric and positive semidefinite).
/// No |z| exceeds 1, so the substep is stable, if and only if the largest eigenvalue of A + 2 D is at most
///     2 (1 + g) / w (see mspringi_stability_bound()):
///   - If it is, take a = x* A x and d = x* D x of a solution of length 1. Then
///     z^2 - (1 + g - w d - w a) z + g - w d = 0. This real quadratic has both roots in the unit disc, since
///     a + 2 d <= 2 (1 + g) / w (Jury's conditions).
///   - If it is not, Q(-1) = 2 (1 + g) - 2 w D - w A has a negative eigenvalue. Q(z) has none if z is far below -1,
///     so Q(z) is singular for some z in between. That solution changes its sign and grows in each substep.
/// For one undamped mode this is omega h <= 2, for one mode of damping ratio zeta
///     omega h <= 2 (sqrt(1 + zeta^2) - zeta).
/// The k and c of relative springs depend on h, such that their part of A and D is the same at any h.
///
/// Vectors are displacements q = M^-1/2 x, of which the image is M^-1/2 (A + 2 D) M^1/2 q (lanczos.h).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PENCIL_H
#define MSPRINGI_PENCIL_H

#include "stability/lanczos.h"
#include "stability/stability.h"
#include "store/network.h"

/// x* (A + 2 D) x of a vector, as a function of h: h^2 stiffness + 2 h damping + relative.
typedef struct mspringi_quotient {
    double stiffness, damping, relative;
} mspringi_quotient;

/// Smallest h above 0 at which the quotient exceeds the bound: 0 if it always does, infinite if it never does.
double mspringi_quotient_limit(const mspringi_quotient *quotient, float global_damping);

/// A live spring in the stability matrices.
typedef struct mspringi_linear_spring {
    uint32_t a, b; ///< slots
    bool directed; ///< its length is not 0
    double nx, ny; ///< direction
    double across; ///< tangent stiffness across the spring, relative to that along it; negative if the spring is
                   ///< compressed
    mspringi_strength strength;
} mspringi_linear_spring;
mspringi_linear_spring mspringi_linearise_spring(const mspring_network *network, mspring_id spring,
                                                 mspringi_spring_slot spring_slot);

/// The matrices at some h.
typedef struct mspringi_pencil {
    const mspring_network *network;
    double square;                  ///< of the substep, s^2
    mspringi_stability_limit limit; ///< for areas
    struct mspringi_pencil_term {
        uint32_t a, b; ///< slots
        float xx, xy, yy;
    } * terms; ///< [springs] for A + 2 D
} mspringi_pencil;

/// Linearise in the present shape. A compressed spring counts as one at rest length: its outward push across makes
/// no substep unstable. Springs of length 0 count in all directions, as the next substep may turn them any way.
void mspringi_pencil_set(mspringi_pencil *pencil, double h);
/// Add the image of a displacement, for mspringi_lanczos.
void mspringi_pencil_add_image(void *pencil, mspringi_displacement in, mspringi_displacement out);
mspringi_quotient mspringi_pencil_quotient(const mspringi_pencil *pencil, mspringi_displacement vector);

#endif
