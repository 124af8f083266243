/// @file reference.h
/// The physics of massspring.h written down as plainly as possible, in double precision: an array of particles, an
/// array of springs, one formula. Shares no code with the library.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_REFERENCE_H
#define TEST_REFERENCE_H

#include "recipe.h"

typedef struct reference_particle {
    double x, y, vx, vy, force_x, force_y, mass;
    int pinned;
} reference_particle;

typedef struct reference_spring {
    mspring_id a, b;
    double stiffness, damping, rest_length;
    int relative;
} reference_spring;

typedef struct reference {
    reference_particle *particles;
    reference_spring *springs;
    uint32_t particle_count, spring_count;
    double gravity_x, gravity_y, global_damping;
} reference;

/// Take over a recipe's particles and springs.
reference reference_of(const recipe *made, double gravity_x, double gravity_y, double global_damping);
void reference_free(reference *net);

/// One substep of length h.
void reference_substep(reference *net, double h);

#endif
