/// @file direct.h
/// The direct solver: the linear system of an implicit substep, factored anew in each (see
/// solvers/sparse/cholesky.h).
///
/// Its nodes are the slots, its edges the places of springs, so that what follows from the layout alone, the order
/// of elimination, need never be found again: a broken spring is an edge of zeros, a pinned particle a node of
/// enormous mass.
///
/// The factor is in single precision as long as that tells masses from the rounding of the stiffness beside them,
/// else in double precision.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_DIRECT_H
#define MSPRINGI_DIRECT_H

#include "base/passes.h"
#include "solvers/sparse/cholesky.h"
#include "store/network.h"

/// As mspringi_blocks_double.
typedef struct mspringi_blocks_float {
    float *xx, *xy, *yy;
} mspringi_blocks_float;

typedef struct mspringi_direct {
    uint32_t place_count;             ///< edges
    uint64_t fingerprint;             ///< of the springs that there were; the order of elimination follows from it
    uint32_t *end_a, *end_b;          ///< [place_count] slots; of places without spring both the slot count
    mspringi_edge_block *edge_blocks; ///< [place_count / MSPRINGI_WIDTH, rounded up]; tip = base: springs have to
                                      ///< be taken one by one
    mspringi_cholesky_symbolic plan;
    mspringi_cholesky_float single;
    mspringi_cholesky_double twice;
    mspringi_blocks_float edges;        ///< [place_count]
    mspringi_blocks_double edges_twice; ///< [place_count, rounded up to whole blocks]
    mspringi_blocks_double nodes_twice; ///< [slots + 1 + MSPRINGI_WIDTH]
    double *solution, *answer;          ///< [slots + 1] x, then y; and [2] responses to constraints
} mspringi_direct;

/// Solve with the present factor, in place. [slots + 1]
typedef void (*mspringi_solve_fn)(const mspring_network *network, double *x, double *y);

/// One that is being made.
typedef struct mspringi_direct_builder {
    mspring_network *network;
    mspringi_direct *direct;
    mspringi_cursor cursor;
    mspringi_cholesky_graph graph;
    double *x; ///< [2 * nodes] x, then y
    bool *absent, *is_placed;
    mspringi_cholesky_analysis *planning;
} mspringi_direct_builder;

#if !defined(MSPRINGI_WITHOUT_DIRECT)
/// Analyse the network's springs and reserve memory for their factor: begin, then make until it is done, then end,
/// on failure too.
/// @return MSPRING_OK; MSPRING_ERROR_MEMORY; MSPRING_ERROR_LIMIT if the factor would be too large.
void mspringi_direct_begin(mspringi_direct_builder *making, mspringi_direct *direct, mspring_network *network);
mspring_result mspringi_direct_make(mspringi_direct_builder *making, bool *is_done);
void mspringi_direct_end(mspringi_direct_builder *making);
void mspringi_direct_destroy(mspringi_direct *direct, mspringi_memory *memory);
void mspringi_direct_relocate(mspringi_direct *direct, const mspringi_memory *from, const mspringi_memory *to);

/// Solve the system that mspringi_assemble() has left in the network's implicit solver.
void mspringi_direct_solve(mspring_network *network);
/// Add to a solution the response to constraints whose forces are unknowns
/// (solvers/constraints/direct_constraints.c).
void mspringi_direct_solve_constraints(mspring_network *network, mspringi_solve_fn solve, double *x, double *y);
#else // no table of solvers leads here
static inline void mspringi_direct_begin(mspringi_direct_builder *making, mspringi_direct *direct,
                                         mspring_network *network) {
    *making = (mspringi_direct_builder){.network = network, .direct = direct};
}
static inline mspring_result mspringi_direct_make(mspringi_direct_builder *making, bool *is_done) {
    *is_done = true;
    return mspringi_solver_check_name(MSPRING_SOLVER_DIRECT, &making->network->message);
}
static inline void mspringi_direct_end(mspringi_direct_builder *making) {
    (void)making;
}
static inline void mspringi_direct_destroy(mspringi_direct *direct, mspringi_memory *memory) {
    (void)direct;
    (void)memory;
}
static inline void mspringi_direct_relocate(mspringi_direct *direct, const mspringi_memory *from,
                                            const mspringi_memory *to) {
    (void)direct;
    (void)from;
    (void)to;
}
static inline void mspringi_direct_solve(mspring_network *network) {
    (void)network;
}
#endif

#endif
