/// @file terms.h
/// The floor and grips in the linear system of an implicit substep. Those of the floor that take a const network do
/// nothing without a floor, and those of grips nothing without grips.
///
///   terms.c      the floor
///   held.c       grips
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TERMS_H
#define MSPRINGI_TERMS_H

#include "contact/floor.h"
#include "solvers/implicit/budget.h"
#include "solvers/implicit/implicit.h"

/// How many substeps an implicit one of h is better divided into, after mspringi_floor_keep().
uint32_t mspringi_floor_pieces(const mspring_network *network, float h);

/// Add what holds particles to the matrix and the right-hand side of a substep of h that has been assembled for the
/// pass-th time. Returns false if particles hit the floor and the substep should be one of implicit Euler.
bool mspringi_floor_add_terms(mspring_network *network, float h, uint32_t pass);

/// Add it to a product, to the coarse matrix, to the blocks on the diagonal in double precision.
/// @return mspringi_floor_multiply(): what it adds to from . to
double mspringi_floor_multiply(const mspring_network *network, mspringi_field from, mspringi_field to);
void mspringi_floor_stiffen(const mspring_network *network);
void mspringi_floor_add_nodes(const mspring_network *network, double *xx, double *xy, double *yy);

/// Look at the solution, displacement + alpha direction. Returns whether other particles are to be held than were.
bool mspringi_floor_review(mspring_network *network, float alpha, uint32_t pass);

/// Count what held particles in a substep of h among the impulses.
void mspringi_floor_bear(const mspring_network *network, float h);

/// The same of grips that hold particles with springs: add them to the system, to a product, to the coarse matrix
/// and to the blocks on the diagonal. Look whether any was to exert more than it can.
void mspringi_grips_add_terms(mspring_network *network, float h, uint32_t pass);
double mspringi_grips_multiply(const mspring_network *network, mspringi_field from, mspringi_field to);
void mspringi_grips_stiffen(const mspring_network *network);
void mspringi_grips_add_nodes(const mspring_network *network, double *xx, double *yy);
bool mspringi_grips_review(mspring_network *network, float alpha);
/// Once a substep of h, or a piece of one, has been taken for good: count what grips gave in it.
void mspringi_grips_pass(mspring_network *network, float h);
/// Add what they have given to components to the sums after a substep.
void mspringi_grips_account(const mspringi_measuring *all);

#endif
