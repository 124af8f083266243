/// @file reference.h
/// Reference trajectory for the tried settings: a network in double precision, in fine substeps.
///
/// The integrator is velocity Verlet (Verlet 1967), of second order and symplectic. Its substep is a third of the
/// longest that is stable in any shape; for a lattice, a quarter of the limit at rest. Explicit settings are of
/// second order, too: tuning takes three substeps or more for each of theirs, so all but a ninth of their error
/// shows. Dampers and global damping use velocities extrapolated to the end of the substep, which keeps the order.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_REFERENCE_H
#define MSPRINGI_REFERENCE_H

#include "store/element_laws.h"

typedef struct mspringi_reference_spring {
    uint32_t a, b;
    float stiffness, damping, rest_length;
} mspringi_reference_spring;

/// All arrays by particle are one block of memory, which begins at x.
typedef struct mspringi_reference {
    uint32_t particle_count, spring_count;
    double *x, *y, *vx, *vy; ///< relative to the network's origin
    double *ax, *ay;         ///< m/s^2
    double *inverse_mass;
    double *held_x, *held_y;                 ///< accelerations from external forces, m/s^2
    double *extrapolated_x, *extrapolated_y; ///< velocities extrapolated to the end of a substep, m/s
    mspringi_reference_spring *springs;      ///< those with stiffness or damping
    const mspring_network *network;          ///< of which the elements are; it outlives the reference
    double gravity_x, gravity_y, global_damping;
    bool has_accelerations; ///< ax and ay are up to date
} mspringi_reference;

/// Copy the network in its present state, with the present stiffness of its springs. Allocates from the network's
/// memory. On failure there is nothing to free.
mspring_result mspringi_reference_create(mspringi_reference *reference, mspring_network *network);
void mspringi_reference_destroy(mspringi_reference *reference, mspring_network *network);

/// Length of a substep, s; may be infinite.
double mspringi_reference_substep(const mspringi_reference *reference);

/// Take count substeps of length h.
void mspringi_reference_run(mspringi_reference *reference, double h, uint32_t count);

/// Let the present accelerations act on velocities for a time, s.
void mspringi_reference_kick(mspringi_reference *reference, double time);

/// Copy positions, shifted, and velocities from a network of the same topology.
void mspringi_reference_set_motion(mspringi_reference *reference, const mspring_network *network, double shift_x,
                                   double shift_y);

/// Remove the external forces.
void mspringi_reference_clear_forces(mspringi_reference *reference);

/// Kinetic plus elastic energy, and potential energy in gravity, J. Pinned particles have none.
typedef struct mspringi_reference_energy {
    double internal, potential;
} mspringi_reference_energy;
mspringi_reference_energy mspringi_reference_measure(const mspringi_reference *reference);

#endif
