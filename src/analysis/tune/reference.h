/// @file reference.h
/// A network in double precision, stepped finely: what the settings that are tried are compared with.
///
/// The scheme is the symplectic one of second order in the form kick, drift, kick (Verlet 1967), with substeps of a
/// third of what is stable in any shape; on a lattice a quarter of what is stable at rest. Explicit settings are of
/// first order with longer substeps, so what they lack shows in full. Dampers, and global damping, are taken at
/// velocities that are extrapolated to the end of the substep, which keeps the order.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_REFERENCE_H
#define MSPRINGI_REFERENCE_H

#include "store/network.h"

typedef struct mspringi_reference_spring {
    uint32_t a, b;
    float stiffness, damping, rest_length;
} mspringi_reference_spring;

/// Arrays by particle lie in one block of memory, which x begins.
typedef struct mspringi_reference {
    uint32_t particle_count, spring_count;
    double *x, *y, *vx, *vy; ///< relative to the network's origin
    double *ax, *ay;         ///< accelerations
    double *inverse_mass;
    double *held_x, *held_y;            ///< acceleration by forces from outside
    double *ahead_x, *ahead_y;          ///< velocities at the end of a substep, as far as can be seen
    mspringi_reference_spring *springs; ///< those that exert something
    const mspringi_areas *areas;        ///< of the network, which outlives the reference
    double gravity_x, gravity_y, global_damping;
    bool has_accelerations; ///< those of x, y, vx and vy are known
} mspringi_reference;

/// Take over the network as it is now, with the stiffness that its springs have now. On failure there is nothing to
/// free. The network's memory is used.
mspring_result mspringi_reference_create(mspringi_reference *reference, mspring_network *network);
void mspringi_reference_destroy(mspringi_reference *reference, mspring_network *network);

/// How long a substep may be, s; may be infinite.
double mspringi_reference_substep(const mspringi_reference *reference);

/// Take count substeps of length h.
void mspringi_reference_run(mspringi_reference *reference, double h, uint32_t count);

/// Put the particles where a network of the same topology has them, shifted by this much, with its velocities.
void mspringi_reference_place(mspringi_reference *reference, const mspring_network *network, double shift_x,
                              double shift_y);

/// Let go of the forces from outside.
void mspringi_reference_release(mspringi_reference *reference);

/// Sum of kinetic and elastic energy, and the potential in gravity, J. Pinned particles have none.
typedef struct mspringi_reference_energy {
    double internal, potential;
} mspringi_reference_energy;
mspringi_reference_energy mspringi_reference_measure(const mspringi_reference *reference);

/// What areas and angles add (reference_areas.c): to accelerations, with these velocities; to the sums in rows of
/// M^-1 K and of the dampers, in the shape that they were added in; to the elastic energy.
void mspringi_reference_push_areas(const mspringi_reference *reference, const double *vx, const double *vy);
void mspringi_reference_weigh_areas(const mspringi_reference *reference, double *stiffness, double *damping);
double mspringi_reference_area_energy(const mspringi_reference *reference);

#endif
