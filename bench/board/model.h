/// @file model.h
/// A network as plain arrays, which every method of the board starts from, and its motion in double precision.
///
/// SPDX-License-Identifier: MIT
#ifndef BOARD_MODEL_H
#define BOARD_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include <massspring/massspring.h>

typedef struct model {
    uint32_t particle_count, spring_count;
    double *x, *y;        ///< [particle_count], m
    double *inverse_mass; ///< [particle_count], 1/kg; 0: pinned
    uint32_t *a, *b;      ///< [spring_count]
    double *rest;         ///< [spring_count], m
    double *stiffness;    ///< [spring_count], N/m
    uint32_t probe;       ///< particle whose sag is measured
    double gravity;       ///< m/s^2, downwards
} model;

/// Read what the builder holds. false: out of memory, after a message.
bool model_read(model *made, mspring_builder *builder, uint32_t probe);
void model_free(model *unwanted);

/// The largest stable substep of symplectic Euler at rest, s.
double model_stable_substep(const model *m);

/// Move by a time in double precision: velocity Verlet, of second order. x and y are positions, at rest at first.
bool model_move(const model *m, double time, uint64_t substeps, double *x, double *y);

/// Sag of the probe at rest, m.
double model_settled_sag(const model *m);

/// Root of the mean of squares of distances between two shapes.
double model_distance(const model *m, const double *x, const double *y, const double *to_x, const double *to_y);

/// A network of the library with the same particles and springs.
mspring_network *model_network(const model *m, const mspring_network_def *def);

#endif
