/// @file angles.h
/// Angle springs: three particles a, b, c, of which b is the middle.
///
/// With u the way from a to b, w that from b to c, the angle is that by which w is turned to the left of u; d is
/// the angle less the rest angle, k the stiffness:
///
///     energy   k (1 - cos d) = k z^2 / 2,  z = 2 sin(d / 2);  so z is what areas have as their size
///     torque   T = -k sin d = -k z sqrt(1 - z^2 / 4), less the damping times the rate of the angle
///     force    T g,  g = d angle / dx: u turned to the left / |u|^2 at a, w likewise at c, less both at b
///     tangent  k cos d g g', where that is not below 0; the other part, of the size of T, only where a bound
///     counts it
///
/// Cosine and sine of the angle are products of u and w, those of the rest angle are kept. So there is no function
/// of libm, and no jump at half a turn. An arm of length 0 has no direction: then there is no torque.
///
/// When it settles, with p and q the displacements of a and c relative to b, its stiffness is
///
///     (g_a . p + g_c . q)^2 = p' (A + S) p + q' (C + S) q - (p - q)' S (p - q),
///     A = g_a g_a',  C = g_c g_c',  S = (g_a g_c' + g_c g_a') / 2
///
/// so three blocks between pairs of its particles. They are symmetric: the antisymmetric part of g_a g_c' is left
/// out. It scales with the square of the angle's sine: strongly bent beams take more iterations.
///
/// An angle is kept among the areas, with three corners and no spring on its third side.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ANGLES_H
#define MSPRINGI_ANGLES_H

#include "features/areas/areas.h"

/// An angle, not yet in the list.
mspringi_area mspringi_angle_make(float stiffness, float damping, double rest_angle);
void mspringi_angle_set_rest(mspringi_area *angle, double rest_angle);

/// z by the ways along both arms.
double mspringi_angle_size_by(const mspringi_area *angle, const double u[2], const double w[2]);

double mspringi_angle_torque(const void *angle, double size);
double mspringi_angle_stiffness(const void *angle, double size);
double mspringi_angle_energy(const void *angle, double size);

/// The angle between three slots now, rad; 0 if there is none.
double mspringi_angle_between(const mspring_network *network, uint32_t a, uint32_t b, uint32_t c);

#endif
