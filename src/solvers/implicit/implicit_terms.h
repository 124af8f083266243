/// @file implicit_terms.h
/// Further terms of an implicit substep's linear system: floor, grips, contact, areas, angle springs.
///
///   implicit_floor.c    floor
///   implicit_contact.c  contact between bodies
///   implicit_areas.c    areas
///   features/grips/implicit_grips.c, features/angles/implicit_angles.c
///   features/one_way/implicit_one_way.c  energy of one-way springs
///
/// A contact is a stiff spring in the system while it pushes: an active-set method. Functions of features
/// do nothing where these are not used.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_IMPLICIT_TERMS_H
#define MSPRINGI_IMPLICIT_TERMS_H

#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "solvers/constraints/constraint_services.h"
#include "solvers/implicit/energy_budget.h"
#include "solvers/implicit/implicit.h"

/// Most intervals of a substep, and the whole number of them in a count of at least 1: the most if that is NaN.
#define MSPRINGI_MOST_INTERVALS 40u
static inline uint32_t mspringi_intervals_of(double count) {
    return count < (double)MSPRINGI_MOST_INTERVALS ? (uint32_t)count : MSPRINGI_MOST_INTERVALS;
}

/// Intervals that an implicit substep of h should have for the floor, which there must be. Call
/// mspringi_floor_save_positions() first.
uint32_t mspringi_floor_count_intervals(const mspring_network *network, float h);

/// List the floor's constraints as predicted. Return false if particles hit the floor and the substep should be one
/// of implicit Euler.
bool mspringi_floor_list_constraints(mspring_network *network, float h);

/// Add the contact forces of a substep of h to the impulses of the floor, which there must be.
void mspringi_floor_record_impulses(const mspring_network *network, float h);

// Of a feature with constraints (features.def), in this order: true if it has any; list them, as predicted; accept
// the forces of the last solution; record the impulses of an accepted interval of h; add them to the components'
// sums after a substep; see the energies of components without pins in the frame in which all that holds them
// rests.
#define SYSTEM(name)                                                                                               \
    bool mspringi_##name##_act(const mspring_network *network);                                                    \
    void mspringi_##name##_list_constraints(mspring_network *network, float h);                                    \
    void mspringi_##name##_store_forces(mspring_network *network);                                                 \
    void mspringi_##name##_count_impulses(mspring_network *network, float h);                                      \
    void mspringi_##name##_add_impulses(const mspringi_budget_sums *all);                                          \
    void mspringi_##name##_find_frames(const mspring_network *network);
#include "store/features.def"

/// Add the constraints of elements to an assembled system, those of others in the pass-th solution of a substep of
/// h. The first calls in a substep list them.
void mspringi_elements_list_and_assemble(mspring_network *network);
bool mspringi_constraints_add_terms(mspring_network *network, float h, uint32_t pass);

/// True if bodies may touch in this substep.
static inline bool mspringi_implicit_contact_is_near(const mspring_network *network) {
    return network->contacts && network->contacts->quiet_substeps == 0;
}
/// True if the particle of a slot may touch others in these substeps: then the floor acts on it as on one with
/// springs, together with them, and not on its flight as a whole.
bool mspringi_implicit_contact_has(const mspring_network *network, size_t slot);
/// Raise the limit on comparisons by those that a substep of this network may take.
void mspringi_implicit_contact_allow_work(const mspring_network *network);
/// Make the constraints of an interval of h. Return true if one is active.
bool mspringi_implicit_contact_begin(mspring_network *network, float h);
/// Return the intervals that a substep of h should have.
uint32_t mspringi_implicit_contact_count_intervals(mspring_network *network, float h);
/// loose_contact.c: make unknowns of loose particles that may touch others in this interval, and of no others any
/// more.
void mspringi_loose_contact_couple(const mspring_network *network);
/// True if a slot (or MSPRING_NONE) has such a particle.
bool mspringi_loose_contact_has(const mspring_network *network, uint32_t slot);
/// Keep what acts on them, before contact does.
void mspringi_loose_contact_keep_forces(const mspring_network *network);
/// After each solution: leave nothing where the next prediction has how tiles turn, which these are not in.
void mspringi_loose_contact_end_solution(const mspring_network *network);
/// After the last solution: they land by that and the forces of contact, which keeps momentum whatever is left
/// over.
void mspringi_loose_contact_land(const mspring_network *network);
/// List their constraints as predicted.
void mspringi_implicit_contact_list_constraints(mspring_network *network, float h);
/// Accept the last solution: store impulses, and apply them to particles without springs.
void mspringi_implicit_contact_store_impulses(mspring_network *network, float h);
/// Push deep overlaps apart after a substep.
void mspringi_implicit_contact_fix_overlaps(mspring_network *network, mspringi_field base, float h);
/// How much deeper a constraint may get in a substep, m.
double mspringi_implicit_contact_growth(const mspring_network *network, const mspringi_contact_constraint *t);
/// True if contact only pushed and added no energy.
bool mspringi_implicit_contact_kept_energy(const mspring_network *network, float h);
/// True if the overlap of a pair grew too much: no constraint held it, or the normal turned.
bool mspringi_implicit_contact_missed_pairs(const mspring_network *network, float h);
/// Record the impulses of an accepted interval of h.
void mspringi_implicit_contact_count_impulses(mspring_network *network, float h);
/// Add contact impulses to the components' sums after a substep.
void mspringi_implicit_contact_add_impulses(const mspringi_budget_sums *all);

/* rigid_contact.c: instead of contact in the system, after an interval of h */

/// Find the motion of bodies near others, and the impulses that keep these apart by more than unseen.
void mspringi_rigid_contact_find_impulses(mspring_network *network, const mspringi_motion *before,
                                          mspringi_field base, double h, double unseen);
/// True if a side of the constraint is of such a body.
bool mspringi_rigid_contact_has(const mspring_network *network, const mspringi_contact_constraint *t);
/// Move them from where they were before.
void mspringi_rigid_contact_move(const mspring_network *network, const mspringi_motion *before, double h);

#endif
