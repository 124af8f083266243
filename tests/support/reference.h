/// @file reference.h
/// The physics of massspring.h written down as plainly as possible, in double precision: an array of particles, an
/// array of springs, one formula. Shares no code with the library.
///
/// Leapfrog: velocities belong to half a substep before positions, but those at the start to the start itself. The
/// first substep so takes them on by half of its length only.
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
    double lag; ///< the last substep, s, half of which velocities are older than positions; 0: they are not
} reference;

/// Take over a recipe's particles and springs; velocities have no lag. Set that of a network that has stepped, or of
/// one with groups, for which it is always a substep.
reference reference_of(const recipe *made, double gravity_x, double gravity_y, double global_damping);
void reference_free(reference *net);

/// One substep of length h.
void reference_substep(reference *net, double h);

#endif
