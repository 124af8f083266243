/// @file cholesky.h
/// Direct solution of A x = b for a sparse, symmetric, positive definite matrix A of 2 x 2 blocks, one row of
/// blocks for each node of a graph, one block off the diagonal for each of its edges.
///
/// The **plan** holds all that depends on the graph alone: in which order the nodes are eliminated, into which
/// dense fronts they are gathered, and where everything lies in memory. It is made once. A **factor**, in float or
/// in double, holds the numbers: L D L^T = A, L unit lower triangular, D diagonal (Cholesky's method without square
/// roots). It is computed anew for every A, without allocating anything.
///
/// Method: nested dissection (George 1973) or a sweep from end to end (Cuthill & McKee 1969), whichever is cheaper;
/// supernodes, merged where that pays (Ashcraft & Grimes 1989); multifrontal elimination (Duff & Reid 1983). What
/// is thin from end to end (ropes, bars of up to five rows) is eliminated as a band instead.
///
/// Same bits: every element of L has its products subtracted one by one, in the order of elimination, at each level
/// alike. Only elements that do not depend on each other share a vector.
///
///     mspringi_cholesky_symbolic plan = {0};
///     mspringi_cholesky_float factor = {0};
///     mspringi_cholesky_symbolic_create(&plan, &graph, memory, message);
///     mspringi_cholesky_float_create(&factor, &plan, level, memory, message);
///     for each step:
///         node = mspringi_cholesky_float_factor_solve(&factor, &matrix, x, y);   MSPRING_NONE: it went well
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CHOLESKY_H
#define MSPRINGI_CHOLESKY_H

#include "base/array_table.h"
#include "base/memory.h"
#include "base/message.h"

/// Which blocks of the matrix are not zero.
typedef struct mspringi_cholesky_graph {
    uint32_t node_count, edge_count;
    const uint32_t *edge_a, *edge_b; ///< [edge_count] nodes, two different ones; two edges may join the same nodes
    const bool *absent;              ///< [node_count] nodes without row and column, as pinned particles or slots
                                     ///< that hold none; edges to them are ignored. NULL: all nodes are there.
    const double *x, *y;             ///< [node_count] where the nodes are, as a hint for the order. NULL: unknown.
    double most_numbers;             ///< that the factor may take; 0: 2^31
} mspringi_cholesky_graph;

typedef struct mspringi_cholesky_analysis mspringi_cholesky_analysis;
typedef struct mspringi_front mspringi_front;
typedef struct mspringi_cholesky_entry mspringi_cholesky_entry;
typedef struct mspringi_front_run mspringi_front_run;

/// All that depends on the graph alone. Read-only once made, so that several factors may share it.
typedef struct mspringi_cholesky_symbolic {
    uint32_t node_count;    ///< of the graph
    uint32_t size;          ///< nodes that are there: blocks on the diagonal of A
    uint32_t *order;        ///< [size] node by place in the order of elimination
    uint32_t band_groups;   ///< of a banded factor: pairs of nodes; 0: there are fronts, and no such factor
    uint32_t band_reach;    ///< groups behind its own that a node reaches, 0 to 3
    uint32_t *band_entries; ///< [band_groups + 1] where the entries of each begin
    uint32_t front_count;
    mspringi_front *fronts;           ///< [front_count] children before their parents
    uint32_t *children;               ///< [front_count] fronts, by their parent
    uint32_t *border;                 ///< places, front after front
    mspringi_front_run *runs;         ///< where the border of a front lies in its parent
    mspringi_cholesky_entry *entries; ///< edges, front after front or group after group
    size_t panel_reals;               ///< numbers in the factor,
    size_t update_reals[2];           ///< in each of the two stacks of update matrices,
    size_t scaled_reals;              ///< in the scaled copy of a front's columns,
    size_t vector_reals;              ///< and in the largest front's part of a vector
    double multiply_adds;             ///< products that a factorisation subtracts, padding not counted
    double predicted_numbers;         ///< that the factor would take, where it was refused for them
} mspringi_cholesky_symbolic;

/// Find the plan. Positions only change the cost; they may coincide.
/// @return MSPRING_OK; MSPRING_ERROR_MEMORY; MSPRING_ERROR_LIMIT if the factor would take over most_numbers. Then
///         the plan is as it was, zero, but for predicted_numbers.
mspring_result mspringi_cholesky_symbolic_create(mspringi_cholesky_symbolic *plan,
                                                 const mspringi_cholesky_graph *graph, mspringi_memory *memory,
                                                 mspringi_message *message);
/// The same as a list of short functions: begin, then run until it is done, then end, on failure too. The graph
/// must stay until then. NULL may be ended.
mspring_result mspringi_cholesky_symbolic_begin(mspringi_cholesky_symbolic *plan,
                                                const mspringi_cholesky_graph *graph, mspringi_memory *memory,
                                                mspringi_message *message, mspringi_cholesky_analysis **begun);
mspring_result mspringi_cholesky_symbolic_run(mspringi_cholesky_analysis *begun, bool *is_done);
void mspringi_cholesky_symbolic_end(mspringi_cholesky_analysis *begun, mspringi_memory *memory);
extern const mspringi_array_table mspringi_cholesky_symbolic_columns;
void mspringi_cholesky_symbolic_destroy(mspringi_cholesky_symbolic *plan, mspringi_memory *memory);

typedef struct mspringi_cholesky_kernels mspringi_cholesky_kernels;

#define MSPRINGI_CHOLESKY_DECLARE(real)                                                                            \
    /** The values of A: symmetric blocks [xx xy; xy yy]. Blocks of absent nodes and of edges to them are not */   \
    /** read. */                                                                                                   \
    typedef struct mspringi_cholesky_matrix_##real {                                                               \
        const real *node_xx, *node_xy, *node_yy; /**< [node_count] on the diagonal */                              \
        const real *edge_xx, *edge_xy, *edge_yy; /**< [edge_count] at (a, b) and at (b, a) */                      \
    } mspringi_cholesky_matrix_##real;                                                                             \
                                                                                                                   \
    typedef struct mspringi_cholesky_##real {                                                                      \
        const mspringi_cholesky_symbolic *plan;                                                                    \
        const mspringi_cholesky_kernels *kernels;                                                                  \
        real *panels;     /**< L, front after front; the others lie behind it */                                   \
        real *reciprocal; /**< [2 size] of D */                                                                    \
        real *updates[2]; /**< stacks of update matrices of fronts at even and at odd depth */                     \
        real *scaled;     /**< L D of the present front */                                                         \
        real *vector;     /**< [2 size] in order of elimination */                                                 \
        real *part;       /**< the part of a vector that the present front sees */                                 \
        size_t rest;      /**< numbers behind panels and updates */                                                \
    } mspringi_cholesky_##real;                                                                                    \
                                                                                                                   \
    /** Reserve all memory; panels and updates are only touched by a factorisation, which sets them. The plan */   \
    /** must outlive the factor. On failure the factor is as it was: zero. */                                      \
    /** What lies behind panels and updates is cleared, in pieces if it was only reserved. */                      \
    mspring_result mspringi_cholesky_##real##_reserve(mspringi_cholesky_##real *factor,                            \
                                                      const mspringi_cholesky_symbolic *plan, mspring_simd level,  \
                                                      mspringi_memory *memory, mspringi_message *message);         \
    void mspringi_cholesky_##real##_clear(const mspringi_cholesky_##real *factor, size_t first, size_t count);     \
    mspring_result mspringi_cholesky_##real##_create(mspringi_cholesky_##real *factor,                             \
                                                     const mspringi_cholesky_symbolic *plan, mspring_simd level,   \
                                                     mspringi_memory *memory, mspringi_message *message);          \
    extern const mspringi_array_table mspringi_cholesky_##real##_columns;                                          \
    void mspringi_cholesky_##real##_destroy(mspringi_cholesky_##real *factor, mspringi_memory *memory);            \
                                                                                                                   \
    /** Factor A. Returns MSPRING_NONE, or the node whose pivot is not positive (or not a finite number): */       \
    /** then A is not positive definite in this precision, and there is no factor to solve with. */                \
    uint32_t mspringi_cholesky_##real##_factor(mspringi_cholesky_##real *factor,                                   \
                                               const mspringi_cholesky_matrix_##real *matrix);                     \
                                                                                                                   \
    /** Solve A (x, y) = b. x and y [node_count] hold b and receive the solution; those of absent nodes stay. */   \
    void mspringi_cholesky_##real##_solve(mspringi_cholesky_##real *factor, real *x, real *y);                     \
                                                                                                                   \
    /** Factor A and solve A (x, y) = b, for less than one after the other. Returns as factor(); if a pivot is */  \
    /** not positive, x and y keep b. The factor may be used again. */                                             \
    uint32_t mspringi_cholesky_##real##_factor_solve(                                                              \
        mspringi_cholesky_##real *factor, const mspringi_cholesky_matrix_##real *matrix, real *x, real *y);

MSPRINGI_CHOLESKY_DECLARE(float)
MSPRINGI_CHOLESKY_DECLARE(double)

#endif
