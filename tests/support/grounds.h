/// @file grounds.h
/// Floors of all kinds, how far a point is above them by the tests' own reckoning, and ways to step on them.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_GROUNDS_H
#define TEST_GROUNDS_H

#include "support.h"

enum { GROUNDS_HEIGHTS = 64 };

/// Positions are floats relative to an origin that is within 100 m or so: half a last place of them is 4e-6 m, and
/// the library leaves distances of some of these alone.
#define GROUNDS_TOLERANCE 2e-4

/// How a network is stepped.
typedef struct grounds_way {
    mspring_solver solver;
    mspring_integrator integrator;
    uint32_t substeps;
} grounds_way;

void grounds_step_by(mspring_network *network, const grounds_way *way);

/// A floor of nothing yet, and the half-plane above y = 0.
mspring_floor_def grounds_def(void);
mspring_floor_def grounds_level(float friction, float restitution);

typedef struct ground {
    const char *name;
    mspring_floor_def def;
    double planes[4 * 4];
    float heights[GROUNDS_HEIGHTS];
} ground;

/// Floors of all kinds around (x, y), all with room above: six of them.
uint32_t grounds_make(ground *to, double x, double y);

/// Smallest of the distances from the planes and from the stretch of the field below: rounding that is along x is
/// sixteen times as much in height at a cliff.
double grounds_above(const mspring_floor_def *def, double x, double y);

#endif
