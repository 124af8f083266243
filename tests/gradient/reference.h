/// @file reference.h
/// The explicit scheme in double precision, written from massspring.h alone, and derivatives of a loss by
/// differences.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_GRADIENT_REFERENCE_H
#define TEST_GRADIENT_REFERENCE_H

#include <stdint.h>

/// Kinds of values that the loss depends on, in their order in the list of all.
enum { BY_STIFFNESS, BY_DAMPING, BY_LENGTH, BY_X, BY_Y, BY_VX, BY_VY, BY_SIGNALS, BY_FORCES, KINDS };

/// A run of steps.
typedef struct reference {
    uint32_t particles, springs, steps, actuators, changes, forced, planes;
    uint32_t most_substeps;   ///< of a step: states of each have room for so many
    uint32_t *substeps;       ///< [steps]
    double *h, *lag;          ///< [steps] s; of the substep before the first of a step
    double rate, gravity_x, gravity_y;
    double planes_of[4][3]; ///< normal of length 1, its product with a point on the plane
    double *inverse_mass;   ///< [particles]
    uint32_t *a, *b;        ///< [springs]
    uint32_t *actuator;     ///< [actuators] springs
    double *nominal;        ///< [actuators] m
    uint32_t *forced_of;    ///< [forced] particles
    double *weights;        ///< [2][particles][4] of the loss: halfway and at the end
    double *roundings;        ///< [steps][most_substeps][4][particles] added to x, y, vx, vy after each substep
    uint32_t first[KINDS + 1];
    double *values; ///< [first[KINDS]]
} reference;

/// Make one whose values are 0. All arrays are freed by reference_free().
reference reference_make(const reference *sizes);
void reference_free(reference *r);

/// Make the reference go where a network went: what its rounding added in each substep becomes a constant.
/// @param states  [steps][most_substeps + 1][4][particles] x, y, vx, vy before each step and after its substeps
void reference_follow(reference *r, const double *states);

/// Step, and return the loss: sum of w z + w z^2 / 2 over coordinates and velocities z, halfway and at the end.
double reference_loss(const reference *r);

/// Derivative by a value: a difference of fourth order, over steps of `step`.
double reference_difference(reference *r, uint32_t value, double step);

#endif
