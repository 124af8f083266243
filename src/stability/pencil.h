/// @file pencil.h
/// Stability of a network at a substep, as an eigenvalue problem.
///
/// Around a shape, with displacement x, mass M, tangent stiffness K and damper matrix C, a substep is
///     v' = g (v - h M^-1 (K x + C v));   x' = x + h v';   g = exp(-global_damping h)
/// A solution that grows by z in each substep obeys
///     Q(z) x = 0,   Q(z) = (z - 1)(z - g) + g (z - 1) D + g z A,
///     A = h^2 M^-1/2 K M^-1/2,   D = h M^-1/2 C M^-1/2   (both symmetric, and no eigenvalue below 0).
/// Stable, that is no |z| above 1, just if the largest eigenvalue of A + 2 D is at most 2 (1 + 1/g):
///   - if it is, take a = x* A x and d = x* D x of a solution of length 1: z^2 - (1 + g - g d - g a) z + g (1 - d)
///   = 0,
///     a real quadratic with both roots in the unit disc, as a + 2 d <= 2 (1 + 1/g) (Jury's conditions);
///   - if it is not, Q(-1) = 2 (1 + g) - 2 g D - g A has a negative eigenvalue, while Q(z) has none for z far below
///     -1: for some z in between Q(z) is singular, and that solution turns round and grows in each substep.
/// For one undamped mode this is omega h <= 2, for one mode of damping ratio zeta
///     omega h <= 2 (sqrt(1 + zeta^2) - zeta).
/// Relative springs have h in k and c already, such that their share of A and D is the same at any h.
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

/// The smallest h above 0 at which the quotient is too large: 0 if it always is, infinite if it never is.
double mspringi_quotient_limit(const mspringi_quotient *quotient, float global_damping);

/// A live spring as the matrices see it.
typedef struct mspringi_linear_spring {
    uint32_t a, b; ///< particles
    bool directed; ///< its length is not 0
    double nx, ny; ///< direction
    double across; ///< tangent stiffness across its direction, as a part of that along it; below 0 if it is short
    mspringi_strength strength;
} mspringi_linear_spring;
mspringi_linear_spring mspringi_linearise_spring(const mspring_network *network, mspring_id spring,
                                                 mspringi_spring_slot spring_slot);

/// Add a spring's share for a displacement of b against a.
void mspringi_quotient_add(mspringi_quotient *quotient, const mspringi_linear_spring *seen, double dx, double dy);

/// The springs' share in the matrices.
typedef struct mspringi_pencil {
    const mspring_network *network;
    double square; ///< of the substep
    double *root;  ///< [particles] 1 / sqrt(mass), 0 if pinned
    struct mspringi_pencil_term {
        uint32_t a, b; ///< particles
        double xx, xy, yy;
    } * terms; ///< [springs] for A + 2 D at some h
} mspringi_pencil;

/// What areas add (stability/stability_areas.c) to the image of a vector, and to its quotient.
void mspringi_areas_apply(const mspringi_pencil *pencil, const double *in, double *out);
void mspringi_areas_quotient(const mspringi_pencil *pencil, const double *vector, mspringi_quotient *sum);

/// Take the shape of now. A spring that is shorter than its rest length counts as if it were as long: its pull
/// sideways is outwards and makes no substep unstable. Springs of length 0 count in all directions, as they may
/// take any with the next substep.
void mspringi_pencil_set(mspringi_pencil *pencil, double h);
/// A mspringi_operator over x and y of particle 0, x and y of particle 1, and so on.
void mspringi_pencil_apply(const void *pencil, const double *in, double *out);
mspringi_quotient mspringi_pencil_quotient(const mspringi_pencil *pencil, const double *vector);

#endif
