/// @file implicit_terms.h
/// The floor, grips and contact between bodies in the linear system of an implicit substep. Those of the floor that
/// take a const network do nothing without a floor, and those of grips nothing without grips.
///
///   implicit_floor.c      the floor
///   implicit_grips.c       grips
///   holds.c      what both of them add
///   implicit_contact.c     contact between bodies
///   implicit_areas.c      areas
///   implicit_angles.c     angle springs
///   implicit_one_way.c      springs that only pull or only push
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_IMPLICIT_TERMS_H
#define MSPRINGI_IMPLICIT_TERMS_H

#include "contact/contacts.h"
#include "contact/floor.h"
#include "solvers/implicit/energy_budget.h"
#include "solvers/implicit/implicit.h"

/// What holds a particle: a block on the diagonal of the matrix.
typedef struct mspringi_slot_stiffness {
    uint32_t slot;
    double xx, xy, yy;
} mspringi_slot_stiffness;
/// That of the floor's or the grips' number i; false: it does not hold, or is not in the system.
bool mspringi_floor_hold(const mspring_network *network, uint32_t i, mspringi_slot_stiffness *hold);
bool mspringi_grip_hold(const mspring_network *network, uint32_t i, mspringi_slot_stiffness *hold);

/// Add all of them to a product, to the coarse matrix, to the blocks on the diagonal in double precision.
/// @return mspringi_holds_multiply(): what they add to from . to
double mspringi_holds_multiply(const mspring_network *network, mspringi_field from, mspringi_field to);
void mspringi_holds_stiffen(const mspring_network *network);
void mspringi_holds_add_nodes(const mspring_network *network, double *xx, double *xy, double *yy);

/// How many substeps an implicit one of h is better divided into, after mspringi_floor_save_positions().
uint32_t mspringi_floor_count_intervals(const mspring_network *network, float h);

/// Add what holds particles to the matrix and the right-hand side of a substep of h that has been assembled for the
/// pass-th time. Returns false if particles hit the floor and the substep should be one of implicit Euler.
bool mspringi_floor_add_terms(mspring_network *network, float h, uint32_t pass);

/// Look at the solution, displacement + alpha direction. Returns whether other particles are to be held than were.
bool mspringi_floor_update_active_set(mspring_network *network, float alpha, uint32_t pass);

/// Count what held particles in a substep of h among the impulses.
void mspringi_floor_record_impulses(const mspring_network *network, float h);

/// The same of grips that hold particles with springs: add them to the system, to a product, to the coarse matrix
/// and to the blocks on the diagonal. Look whether any was to exert more than it can.
void mspringi_grips_add_terms(mspring_network *network, float h, uint32_t pass);
bool mspringi_grips_update_active_set(mspring_network *network, float alpha);
/// Once a substep of h, or a piece of one, has been taken for good: count what grips gave in it.
void mspringi_grips_count_impulses(mspring_network *network, float h);
/// Add what they have given to components to the sums after a substep.
void mspringi_grips_add_impulses(const mspringi_budget_sums *all);

/// Add areas that springs are all around to the system, once the springs are assembled; and their energies to those
/// of components.
void mspringi_areas_add_terms(const mspring_network *network);
void mspringi_areas_add_energy(const mspring_network *network);

/// The same of angles that have springs along both arms, to a product and to the coarse matrix, too. Their energies
/// are those of areas.
void mspringi_angles_add_terms(const mspring_network *network);
/// The next that is, from one on; NULL: there is none.
mspringi_hinge *mspringi_next_hinge(const mspring_network *network, size_t *at);
double mspringi_angles_multiply(const mspring_network *network, mspringi_field from, mspringi_field to);
void mspringi_angles_add_to_coarse(const mspring_network *network);

/// Let components have the energy of springs that only pull or only push as they are, not as they were expected.
void mspringi_one_way_correct_energy(const mspringi_budget_sums *all);

/// Of contact between bodies: whether any may touch in this substep.
static inline bool mspringi_implicit_contact_is_near(const mspring_network *network) {
    return network->contacts && network->contacts->quiet_substeps == 0;
}
/// Before a substep of h, or a piece of one: make its rows. Returns whether any holds. How
/// many pieces it is better divided into.
bool mspringi_implicit_contact_begin(mspring_network *network, float h);
uint32_t mspringi_implicit_contact_count_intervals(mspring_network *network, float h);
/// Add them to the system and to a product; whether any holds; look at the solution.
void mspringi_implicit_contact_add_terms(mspring_network *network, float h);
double mspringi_implicit_contact_multiply(const mspring_network *network, mspringi_field from, mspringi_field to);
bool mspringi_implicit_contact_is_active(const mspring_network *network);
bool mspringi_implicit_contact_update_active_set(mspring_network *network, float alpha, uint32_t pass);
/// The last solution is it: keep impulses, and give particles without springs theirs.
void mspringi_implicit_contact_store_impulses(mspring_network *network, float h);
/// After a substep: push apart what is too deep still.
void mspringi_implicit_contact_fix_overlaps(const mspring_network *network, float h);
/// Whether contact only pushed, and gave no energy.
bool mspringi_implicit_contact_kept_energy(const mspring_network *network, float h);
/// Whether springs have thrown something together that had no row.
bool mspringi_implicit_contact_missed_pairs(const mspring_network *network, float h);
/// Once it has been taken for good: count what was given; and what particles got that fly past the floor since.
void mspringi_implicit_contact_count_impulses(mspring_network *network, float h);
void mspringi_implicit_contact_push_free_particles(const mspring_network *network);
/// Add what components were given to the sums after a substep.
void mspringi_implicit_contact_add_impulses(const mspringi_budget_sums *all);

/// Whether friction holds a row; what a field comes to along it; a force along it, added to a field.
bool mspringi_implicit_constraint_sticks(const mspringi_implicit_constraint *hold);
double mspringi_implicit_contact_gather(const mspring_network *network, mspringi_implicit_constraint *hold,
                                        double (*shares)[2], mspringi_field field);
void mspringi_implicit_contact_scatter(const mspring_network *network, mspringi_implicit_constraint *hold,
                                       double (*shares)[2], double force, mspringi_field to);

#endif
