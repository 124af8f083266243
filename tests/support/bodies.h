/// @file bodies.h
/// Small bodies that collide, and what is measured of them in double precision, by brute force.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_BODIES_H
#define TEST_BODIES_H

#include "support.h"

#define BODIES_MOST_PARTICLES 4096
#define BODIES_MOST_SPRINGS 16384

typedef struct bodies_spring {
    uint32_t a, b;
    double stiffness, rest_length;
    bool is_edge; ///< of the outline
} bodies_spring;

/// Lattices of any shape, at any angle; all springs are f of what is stable at substeps of h seconds.
typedef struct bodies {
    mspring_builder *builder;
    double h, gravity_y, damping;
    uint32_t body_count, count, spring_count;
    double mass[BODIES_MOST_PARTICLES], x[BODIES_MOST_PARTICLES], y[BODIES_MOST_PARTICLES];
    uint32_t body[BODIES_MOST_PARTICLES];
    int32_t column[BODIES_MOST_PARTICLES], row[BODIES_MOST_PARTICLES];
    bool is_outline[BODIES_MOST_PARTICLES];
    float vx[BODIES_MOST_PARTICLES], vy[BODIES_MOST_PARTICLES];
    bodies_spring springs[BODIES_MOST_SPRINGS];
} bodies;

/// A body to add: cells of width by height, of which mask (NULL: all) says which there are.
typedef struct bodies_lattice {
    uint32_t width, height;
    const uint8_t *mask;
    double x, y, angle, spacing;
    double mass; ///< of a particle, kg; 0: pinned
    double f;
} bodies_lattice;

bodies *bodies_begin(double h);

/// @return its first particle
uint32_t bodies_add(bodies *b, const bodies_lattice *lattice);

/// Two bodies of random shapes and of masses to 1:1000, 14 m apart, that fly at each other and turn.
/// @param speed set to that of the second, at most fastest
bodies *bodies_two(uint64_t trial, double fastest, double h, double *speed);

/// Make the network, with the velocities in vx and vy, and the outline of the bodies as they are. The builder is
/// destroyed.
mspring_network *bodies_network(bodies *b, const mspring_network_def *def);
void bodies_free(bodies *b);

/// Blocks that fall onto each other and onto a rope, from y on. Returns the first particle of the last one.
uint32_t bodies_heap(bodies *b, int blocks, double y);

/// Contact with these numbers and the defaults of the rest.
mspring_contact_def bodies_contact(double thickness, float friction, float restitution);
mspring_result bodies_touch(mspring_network *network, double thickness, float friction, float restitution);

typedef struct bodies_measure {
    double energy;                     ///< kinetic, elastic, of gravity, and h v.F / 2: what the scheme keeps
    double x, y, turn;                 ///< momenta
    double momentum_scale, turn_scale; ///< sums of their sizes
    double fastest, mean_speed;
} bodies_measure;

/// Read positions and velocities, and measure.
bodies_measure bodies_measured(bodies *b, const mspring_network *network);

/// Deepest overlap of two bodies, and how many of their edges cross; where they were measured last.
double bodies_deepest(const bodies *b, double thickness, uint32_t *crossings);

#endif
