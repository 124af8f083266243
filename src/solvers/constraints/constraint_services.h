/// @file constraint_services.h
/// Services for the constraints of a linear system (store/constraint_list.h), each once for all kinds.
///
///   implicit_floor.c, implicit_contact.c,    list the constraints of a kind
///   and those of features
///   constraint_services.c                    assembly, product, coarse matrix, active set
///   direct_constraints.c                     forces as unknowns beside the direct solver's factor
///
/// In the order of a substep (solvers/implicit/implicit_substeps.c):
///
///   mspringi_constraints_begin               clear the list (store/constraint_list.h)
///   mspringi_elements_list_and_assemble      list elements once; add them to each assembled system
///   mspringi_constraints_add_terms           list the others once; add the active ones to each assembled system
///   mspringi_constraints_stiffen, _multiply  in conjugate gradients, or
///   mspringi_direct_solve_constraints        in the direct solver
///   mspringi_constraints_update_active_set   forces; solve again, from the second line on, if it changes
///
/// Listing and adding call mspringi_constraints_activate. Then owners store the forces:
/// mspringi_NAME_store_forces of features, mspringi_implicit_contact_store_impulses and
/// mspringi_floor_record_impulses. The functions that the list names are in constraint_list.h, implicit_terms.h and
/// direct.h, too.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONSTRAINT_SERVICES_H
#define MSPRINGI_CONSTRAINT_SERVICES_H

#include "kernels/system.h"
#include "store/network.h"

/// Range of slots.
typedef struct mspringi_slots {
    size_t first, end;
} mspringi_slots;

static inline bool mspringi_slots_have(mspringi_slots slots, size_t slot) {
    return slot - slots.first < slots.end - slots.first;
}

/// A worker's share of a product besides the panels. It computes the terms that have a slot of its own, and adds to
/// these slots only. A term of two workers is computed by both; each slot is summed in one order for any number of
/// them.
typedef struct mspringi_product {
    mspringi_field from, to;
    mspringi_slots own; ///< whole chunks
    double *sums;       ///< [chunks] from . to of the terms, each in the chunk of its first slot
} mspringi_product;

static inline bool mspringi_product_has(const mspringi_product *p, size_t slot) {
    return mspringi_slots_have(p->own, slot);
}
static inline void mspringi_product_add(const mspringi_product *p, size_t slot, float x, float y) {
    if (!mspringi_product_has(p, slot))
        return;
    p->to.x[slot] += x;
    p->to.y[slot] += y;
}
static inline void mspringi_product_count(const mspringi_product *p, size_t slot, double term) {
    if (mspringi_product_has(p, slot))
        p->sums[slot / MSPRINGI_CHUNK] += term;
}

/// Add constraints first to end - 1 to the right-hand side and the diagonal blocks: stiff ones, and the force alone
/// of those at their bound. is_factored: leave out those whose forces are unknowns of the direct solver.
void mspringi_constraints_assemble(const mspringi_constraints *all, uint32_t first, uint32_t end,
                                   const mspringi_system *to, bool is_factored);
/// List the stiff constraints for products. Call it before the products, after each change of the list or of the
/// active set.
void mspringi_constraints_activate(mspringi_constraints *all);
/// Multiply: to += J' stiffness J from, over stiff constraints.
void mspringi_constraints_multiply(const mspringi_constraints *all, const mspringi_product *product);
/// Add stiff constraints to the coarse matrix of the network's implicit solver.
void mspringi_constraints_stiffen(const mspring_network *network);
/// Add stiff constraints of one particle each to the diagonal blocks of a factored matrix, in double precision. Not
/// those of elements, which have more than one.
void mspringi_constraints_add_nodes(const mspringi_constraints *all, double *xx, double *xy, double *yy);

/// Find the forces at the solution u + alpha direction, and update the active set. `pass` counts the solutions of
/// the substep from 0. Return a bit for each kind whose active set changed.
uint32_t mspringi_constraints_update_active_set(mspringi_constraints *all, mspringi_field u,
                                                mspringi_field direction, float alpha, uint32_t pass);
/// True if any contact between bodies, or with a collider, is active.
bool mspringi_contact_constraint_is_active(const mspringi_constraints *all);

#endif
