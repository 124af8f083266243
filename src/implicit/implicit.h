/// @file implicit.h
/// The implicit solver: one linear system a substep, whatever the stiffness.
///
///   predict    where the particles would be without forces               scheme.c
///   assemble   springs, linearised there, into A d = b                   assemble.c
///   solve      two-level preconditioned conjugate gradients              solve.c, tiles.c, coarse.c
///              or, for the direct solver, a factorisation                direct/direct.c
///   finish     positions and velocities from d                           scheme.c
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_IMPLICIT_H
#define MSPRINGI_IMPLICIT_H

#include "network/network.h"

#include "coarse.h"
#include "direct/direct.h"
#include "stability/energy.h"
#include "tiles.h"

/// Most iterations, and most substeps with one coarse matrix.
#define MSPRINGI_MOST_ITERATIONS 10000

/// What is the integrator's, apart from the state: kept from substep to substep, restored with the state.
typedef struct mspringi_history {
    mspringi_field low;    ///< what positions have beyond single precision, m
    mspringi_field first;  ///< acceleration, m/s^2; of BDF2: the last displacement beyond h v, m
    mspringi_field second; ///< of BDF2: the last change of velocity, m/s; else NULL
    float h;               ///< substep that it belongs to, s
    bool restarts;         ///< there is none: the next substep is one of implicit Euler
} mspringi_history;

typedef struct mspringi_implicit {
    mspring_integrator integrator;
    uint32_t iterations, coarse_period;
    uint32_t tile_size; ///< as asked for: 0 is by plan
    uint32_t age;       ///< substeps since the coarse matrix was factored; 0: it is to be
    double scale;       ///< power of two that brings masses near 1

    mspringi_history history, backup;
    size_t history_size; ///< floats in a history

    double *x, *y;           ///< [slots] predicted positions, in one block
    mspringi_field velocity; ///< after the substep, if d were 0
    mspringi_field residual, displacement, direction, product, scaled;
    mspringi_field arm;      ///< from the mass centre of its tile to each particle, m
    float *mass;             ///< [slots] scaled; 0 if pinned or empty
    float *diagonal;         ///< [slots] xx, then xy, then yy of A's blocks, then of their inverses
    float *factors;          ///< of lattices, chains and leftover springs, one behind the other
    float *leftover_factors; ///< where those of the leftover springs begin: [block][factor][lane]
    double *force_carry;
    float *carry;
    double *restricted; ///< the coarse right-hand side
    mspringi_system system;
    mspringi_iterate iterate;
    mspringi_edits seen; ///< the edits that it has followed

    mspringi_gain gain; ///< of the present step
    bool is_direct;
    mspringi_direct direct; ///< all there is of it unless is_direct: zero
    mspringi_tiles tiles;   ///< none, nor a coarse matrix, if it is
    mspringi_coarse coarse;
} mspringi_implicit;

/// Make an implicit solver for a network that is otherwise complete. On failure there is nothing to free.
mspring_result mspringi_implicit_create(mspring_network *network, const mspring_solver_def *def,
                                        mspringi_implicit **implicit);
/// Whether it can go on with this definition; then mspringi_implicit_adjust() is all there is to do.
bool mspringi_implicit_fits(const mspringi_implicit *implicit, const mspring_solver_def *def);
void mspringi_implicit_adjust(mspringi_implicit *implicit, const mspring_solver_def *def);
void mspringi_implicit_destroy(mspringi_implicit *implicit, mspringi_memory *memory);

/// Take count substeps of length h, all with the forces from outside that are in base (x NULL: none).
void mspringi_implicit_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count);

/// Cut tiles anew where springs broke or were restored, or pins changed. Allocates nothing.
void mspringi_implicit_follow(mspring_network *network);

/// Keep the history for a step that fails, and get it back.
void mspringi_implicit_keep(mspring_network *network);
void mspringi_implicit_restore(mspring_network *network);

/// Add to the plan what it says of the implicit solver. Nothing for NULL.
void mspringi_implicit_describe(const mspringi_implicit *implicit, mspring_plan *plan);

/* scheme.c */

/// Where an integrator puts the forces: A = M + c K + s C, with c = force_share h^2 and s = c velocity_share / h;
/// the velocity after the substep is that of d = 0 plus velocity_share d / h.
typedef struct mspringi_scheme {
    double force_share, velocity_share;
} mspringi_scheme;
mspringi_scheme mspringi_scheme_of(mspring_integrator integrator);

void mspringi_predict(mspring_network *network, float h);
void mspringi_finish(mspring_network *network, float h);

/* assemble.c */

/// Fill in the masses, with what global damping adds to them.
void mspringi_weigh(mspring_network *network, float h);
void mspringi_assemble(mspring_network *network, float h, mspringi_field base);
void mspringi_multiply(const mspring_network *network, mspringi_field from, mspringi_field to);

/* solve.c: from residual, factors and diagonal to displacement */

void mspringi_solve(mspring_network *network);

/// Particles without springs are in no tile and no factor: their rows of A are diagonal.
void mspringi_solve_loose(const mspring_network *network);

/// Numbers overflowed: see to it that the step is refused.
void mspringi_spoil(mspring_network *network);

#endif
