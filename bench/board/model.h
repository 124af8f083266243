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

/// Positions and velocities.
typedef struct model_state {
    double *x, *y, *vx, *vy; ///< [particle_count], m and m/s
} model_state;

/// At rest, as the model is. false: out of memory, after a message.
bool model_state_begin(const model *m, model_state *made);
void model_state_end(model_state *unwanted);

/// Move by a time in double precision: velocity Verlet, of second order. false: out of memory, after a message.
bool model_move(const model *m, double time, uint64_t substeps, model_state *state);

/// Where it comes to rest. false: after a message.
bool model_settle(const model *m, double *x, double *y);

/// Energy of motion, springs and height, J, and h v F / 2: with h that of symplectic Euler it is the energy that
/// those substeps keep, but for terms of h^2 (Hairer, Lubich, Wanner, Geometric Numerical Integration, IX.3).
double model_energy(const model *m, const model_state *state, double h);

/// Root of the mean of squares of distances between two shapes.
double model_distance(const model *m, const double *x, const double *y, const double *to_x, const double *to_y);

/// A network of the library with the same particles and springs.
mspring_network *model_network(const model *m, const mspring_network_def *def);

#endif
