/// @file equilibrium.h
/// A network as a problem of statics, in double precision: energy, forces and stiffness as functions of how far the
/// particles have been moved, and the search for where they rest.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EQUILIBRIUM_H
#define MSPRINGI_EQUILIBRIUM_H

#include "analysis/settle/settle.h"
#include "solvers/sparse/cholesky.h"
#include "store/network.h"

/// Two numbers for each particle.
typedef struct mspringi_vectors {
    double *x, *y;
} mspringi_vectors;

/// The springs that exert a force.
typedef struct mspringi_statics_springs {
    uint32_t count, edge_count;      ///< springs; and with the pairs of angles behind them
    uint32_t *a, *b;                 ///< [edge_count] particles
    double *stiffness, *rest_length; ///< [count]
    double *side;                    ///< [count] 1: it only pulls; -1: it only pushes; 0: it does both
    double *x, *y;        ///< [count] from a to b at the start. Kept apart from the displacements, these and
                          ///< their small differences are exact to more digits than positions would be.
    double *xx, *xy, *yy; ///< [edge_count] blocks of the stiffness matrix
} mspringi_statics_springs;

/// The areas that have a pressure, and the angles that have a torque (settle_areas.c, settle_angles.c).
typedef struct mspringi_statics_areas {
    const mspringi_areas *of; ///< NULL: there are none
    uint32_t *sides;          ///< [corners] the spring of each side; of an angle the edges a b, b c, c a
} mspringi_statics_areas;

typedef struct mspringi_statics {
    uint32_t particle_count;
    bool *fixed;              ///< [particle_count] pinned, or left alone
    mspringi_vectors start;   ///< [particle_count] positions relative to the network's origin, m
    mspringi_vectors moved;   ///< [particle_count] displacements, m
    mspringi_vectors outside; ///< [particle_count] weight and forces given, N
    mspringi_vectors force;   ///< [particle_count] all forces, N
    mspringi_vectors step;    ///< [particle_count] where to, m, and
    mspringi_vectors bend;    ///< [particle_count] how that way bends, m
    mspringi_vectors spare;   ///< [particle_count] scratch
    double *xx, *xy, *yy;     ///< [particle_count] blocks of the stiffness matrix, and
    double *scale;            ///< [particle_count] what is stiff at a particle, N/m
    double *block;            ///< the memory of all these numbers by particle
    double *spring_block;     ///< and by spring
    uint32_t *end_block;
    mspringi_watcher watcher; ///< asked before each iteration
    mspringi_statics_springs springs;
    mspringi_statics_areas areas;
    mspringi_cholesky_symbolic plan;
    mspringi_cholesky_double factor;
} mspringi_statics;

/// Reserve memory for particles, springs and pairs of angles.
bool mspringi_statics_create(mspringi_statics *statics, uint32_t particle_count, uint32_t edge_count,
                             mspringi_memory *memory);
void mspringi_statics_destroy(mspringi_statics *statics, mspringi_memory *memory);

/// Have the network's areas, once springs are filled in. They stay the network's.
mspring_result mspringi_statics_add_areas(mspringi_statics *statics, mspring_network *network);
/// What they add: to forces, returning the largest; to a change of energy and the sum of such; to the stiffness.
double mspringi_statics_area_forces(mspringi_statics *statics);
double mspringi_statics_area_change(const mspringi_statics *statics, double t, double *size);
void mspringi_statics_area_stiffness(mspringi_statics *statics, bool clamped);

/// Have an angle: its pairs are edges from now on.
void mspringi_statics_add_angle(mspringi_statics *statics, const mspringi_areas *all, const mspringi_area *angle);
/// What it adds, as above.
double mspringi_statics_angle_forces(mspringi_statics *statics, const mspringi_area *angle);
double mspringi_statics_angle_change(const mspringi_statics *statics, const mspringi_area *angle, double t,
                                     double *size);
void mspringi_statics_angle_stiffness(mspringi_statics *statics, const mspringi_area *angle, bool clamped);

/// Analyse the stiffness matrix, once particles and springs are filled in.
mspring_result mspringi_statics_prepare(mspringi_statics *statics, mspring_simd level, mspringi_memory *memory,
                                        mspringi_message *message);

/// What is left of the forces.
typedef struct mspringi_residual {
    double force;     ///< N, the largest in x or y on a particle that is free
    double scale;     ///< N, the largest force that a spring or something outside exerts
    mspring_id where; ///< the particle with the largest force
} mspringi_residual;

/// Compute the forces where the particles are now.
mspringi_residual mspringi_statics_forces(mspringi_statics *statics);

/// The stiffness matrix where the particles are now, with shift times its scale added on the diagonal, factored.
/// clamped: without what compressed springs take from the stiffness across them, which leaves no negative
/// eigenvalue. False: it is not positive definite.
bool mspringi_statics_factor(mspringi_statics *statics, bool clamped, double shift);

/// With the factor: the step that would remove all forces if they were linear, and how the way there bends because
/// they are not (second order: Transtrum & Sethna 2012): particles go to moved + t step + t^2 bend.
void mspringi_statics_find_way(mspringi_statics *statics);

/// By how much the energy changes from moved to moved + t step + t^2 bend, J. error: what rounding may be worth.
double mspringi_statics_energy_change(const mspringi_statics *statics, double t, double *error);

/// Forces times step: the decrease of energy for a small t is t times this.
double mspringi_statics_slope(const mspringi_statics *statics);

/// How a search ended.
typedef struct mspringi_rest {
    uint32_t iterations;
    mspringi_residual residual;
    bool found;
    bool is_stable;
} mspringi_rest;

/// Search for the equilibrium: Newton's method with the way above, as far along it as the energy falls.
/// size: extent of the network, m. tolerance: part of the scale of forces that may be left.
mspringi_rest mspringi_statics_rest(mspringi_statics *statics, uint32_t most_iterations, double tolerance,
                                    double size);

#endif
