/// @file spec_floor.h
/// Surfaces of the floor, for spec_floor.c and spec_flight.c.
///
/// SPDX-License-Identifier: MIT
#ifndef SPEC_FLOOR_H
#define SPEC_FLOOR_H

#include "spec.h"

/// Distance from a plane, < 0 below it, and from the nearest surface.
double spec_distance_from(const spec_plane *plane, double x, double y);
double spec_distance_from_all(const spec_network *network, double x, double y);

/// Distance below which a particle touches a plane, m: rounding of its coordinates.
double spec_slop_at(double x, double y);

/// Number of the part of the heights below x: that of its left end. The level ones are -1 and count - 1.
int64_t spec_part_below(const spec_heights *h, double x);

/// A part as a half-plane. The level ones have the friction and restitution of the outermost parts.
spec_plane spec_plane_of(const spec_heights *h, int64_t part);

/// The part that a way meets: that before the first knot which it passes below, or else the part below its end.
spec_plane spec_first_hit(const spec_heights *h, double from_x, double from_y, double x, double y);

/// Put a point that is inside the floor onto its surfaces. Returns true if it was.
bool spec_put_outside(const spec_network *network, double *x, double *y);

/// Restitution that counts as none.
#define SPEC_NO_RESTITUTION 0.1

/// Margin for rounding where a speed must not grow.
#define SPEC_GROWTH (1.0 + 1e-9)

#endif
