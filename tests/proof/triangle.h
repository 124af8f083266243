/// @file triangle.h
/// Triangles with the energy of St. Venant and Kirchhoff, of test_proof.
///
/// With Green's strain E of the deformation from the rest shape, of area A, and Lame's constants l and m,
///     energy = A (l tr(E)^2 / 2 + m E:E) = the sum over three strains s_k of k_k s_k^2 / 2,
///     s = (Exx + Eyy, Exx - Eyy, 2 Exy),    k = A (l + m, m, m).
/// So one is three springs whose extensions are s_k: constraints with three closed entries each.
///
/// SPDX-License-Identifier: MIT
#ifndef PROOF_TRIANGLE_H
#define PROOF_TRIANGLE_H

#include "store/network.h"

enum { PROOF_TRIANGLES = 64, PROOF_STRAINS = 3 };

/// Strains of a triangle, their stiffness, N m, and their gradients by corner, 1/m.
typedef struct proof_strains {
    double size[PROOF_STRAINS], stiffness[PROOF_STRAINS], gradient[PROOF_STRAINS][3][2];
} proof_strains;

/// Add a triangle at rest as it lies, of three corners that springs join. All triangles are of one network.
void proof_add_triangle(mspring_network *network, const mspring_id corners[3], double lambda, double mu);
/// Remove all, before the network is destroyed.
void proof_remove_triangles(mspring_network *network);

/// Strains of a triangle with its corners at these positions, m; and the energy of all triangles now, J.
proof_strains proof_strains_at(uint32_t triangle, const double position[3][2]);
double proof_energy(const mspring_network *network);

#endif
