/// @file constraint_services.h
/// Services for the constraints of a linear system (store/constraint_list.h), each once for all kinds.
///
///   implicit_floor.c, implicit_contact.c,    list the constraints of a kind
///   and those of features
///   constraint_services.c                    assembly, product, coarse matrix, active set
///   direct_constraints.c                     forces as unknowns beside the direct solver's factor
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONSTRAINT_SERVICES_H
#define MSPRINGI_CONSTRAINT_SERVICES_H

#include "kernels/system.h"
#include "store/network.h"

/// Add constraints first to end - 1 to the right-hand side and the diagonal blocks. is_factored: without those
/// whose forces are unknowns.
void mspringi_constraints_assemble(const mspringi_constraints *all, uint32_t first, uint32_t end,
                                   const mspringi_system *to, bool is_factored);
/// List those that are in the matrix: after each change of the list or of the active set.
void mspringi_constraints_activate(mspringi_constraints *all);
/// to += J' stiffness J from. Return from . J' stiffness J from.
double mspringi_constraints_multiply(const mspringi_constraints *all, mspringi_field from, mspringi_field to);
/// Add them to the coarse matrix of the network's implicit solver.
void mspringi_constraints_stiffen(const mspring_network *network);
/// Add those of one particle to diagonal blocks in double precision.
void mspringi_constraints_add_nodes(const mspringi_constraints *all, double *xx, double *xy, double *yy);

/// Find the forces of the pass-th solution of a substep, u + alpha direction, and update the active set. Return the
/// kinds, as bits, whose active set has changed.
uint32_t mspringi_constraints_update_active_set(mspringi_constraints *all, mspringi_field u,
                                                mspringi_field direction, float alpha, uint32_t pass);
/// True if a contact between bodies, or with a collider, is active.
bool mspringi_contact_constraint_is_active(const mspringi_constraints *all);

#endif
