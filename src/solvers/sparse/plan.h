/// @file plan.h
/// What a plan consists of, and the steps by which it is found: adjacency, orders, elimination tree, fronts.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LINEAR_PLAN_H
#define MSPRINGI_LINEAR_PLAN_H

#include "solvers/sparse/cholesky.h"

/// Rows are padded to this many numbers: 64 bytes of floats.
#define MSPRINGI_PAD 16

/// Columns of a group of a banded factor: those of two nodes.
#define MSPRINGI_BAND_COLUMNS 4

/// A dense part of the elimination: the columns of its pivots, with a row for each pivot and each node of its
/// border. They are two column-major arrays behind one another in the factor: pivot rows, then border rows.
struct mspringi_front {
    uint32_t first_pivot, pivot_count;   ///< places in the order of elimination
    uint32_t first_border, border_count; ///< nodes later in the order to which the pivots are coupled: plan->border
    uint32_t first_child, child_count;   ///< plan->children
    uint32_t first_run, run_count;       ///< where the border lies in the parent: plan->runs
    uint32_t first_entry;                ///< plan->entries: edges between pivots,
    uint32_t border_entry;               ///< edges from pivots to the border,
    uint32_t end_entry;                  ///< and the end of both
    uint32_t stack;                      ///< which stack has the update matrix
    size_t panel;                        ///< where the columns begin
    size_t update;                       ///< where the update matrix begins
};

/// Consecutive nodes of a front's border that are consecutive in the parent, too.
struct mspringi_front_run {
    uint32_t first, count;
    uint32_t to;       ///< place among the parent's pivots or in its border,
    uint32_t is_pivot; ///< 1 or 0
};

/// An edge, and where its block begins in the pivot rows or border rows of its front, or in a banded factor.
struct mspringi_cholesky_entry {
    uint32_t edge, to;
};

static inline size_t mspringi_pad(size_t count) {
    return (count + MSPRINGI_PAD - 1) / MSPRINGI_PAD * MSPRINGI_PAD;
}

/// From a column to the next in pivot rows and in border rows.
static inline size_t mspringi_pivot_rows(const mspringi_front *front) {
    return mspringi_pad(2 * (size_t)front->pivot_count);
}
static inline size_t mspringi_border_rows(const mspringi_front *front) {
    return mspringi_pad(2 * (size_t)front->border_count + 1); // the last row is that of the right side
}

/// The nodes that are there, numbered 0 ... size - 1, and their neighbours.
typedef struct mspringi_adjacency {
    uint32_t size;
    uint32_t *node;      ///< [size] number in the graph
    uint32_t *first;     ///< [size + 1]
    uint32_t *neighbour; ///< those of i are neighbour[first[i]] ... neighbour[first[i + 1] - 1]
} mspringi_adjacency;

mspring_result mspringi_adjacency_create(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph,
                                         mspringi_memory *memory, mspringi_message *message);
void mspringi_adjacency_destroy(mspringi_adjacency *adjacency, mspringi_memory *memory);

/// Connected components, one behind the other, each ordered from end to end: an elimination in this order sweeps
/// through it.
typedef struct mspringi_sweep_order {
    uint32_t *order; ///< [size]
    uint32_t *first; ///< [component_count + 1] where each begins in order
    uint32_t component_count;
} mspringi_sweep_order;

mspring_result mspringi_sweep_order_find(mspringi_sweep_order *sweep, const mspringi_adjacency *adjacency,
                                         mspringi_memory *memory, mspringi_message *message);
void mspringi_sweep_order_destroy(mspringi_sweep_order *sweep, mspringi_memory *memory);

/// Make the plan of a banded factor, if there is an order in which no node reaches further than that has room for.
/// Else plan->band_groups stays 0.
mspring_result mspringi_band_create(mspringi_cholesky_plan *plan, const mspringi_sweep_order *sweep,
                                    const mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph,
                                    mspringi_memory *memory, mspringi_message *message);

/// Order the nodes of each component, which lie as in sweep, by nested dissection. order is [size].
mspring_result mspringi_dissect(uint32_t *order, const mspringi_sweep_order *sweep,
                                const mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph,
                                mspringi_memory *memory, mspringi_message *message);

/// The elimination tree of an order and its supernodes. Everything is by place in the order.
typedef struct mspringi_tree {
    uint32_t *place; ///< [size] place of a node
    uint32_t
        *parent;     ///< [size] the first place later on to which the elimination couples this one, or MSPRING_NONE
    uint32_t *below; ///< [size] how many such places there are
    uint32_t *into;  ///< [size] the last pivot of the supernode that this place belongs to
    uint32_t *pivots;  ///< [size] of a supernode's last pivot: how many it has
    uint32_t *child;   ///< [size] of a supernode's last pivot: first child, as its last pivot,
    uint32_t *sibling; ///< [size] and the next one with the same parent
    uint32_t *mark;    ///< [size] scratch
} mspringi_tree;

mspring_result mspringi_tree_create(mspringi_tree *tree, uint32_t size, mspringi_memory *memory,
                                    mspringi_message *message);
void mspringi_tree_destroy(mspringi_tree *tree, mspringi_memory *memory);

/// What an elimination will take.
typedef struct mspringi_elimination_cost {
    double blocks; ///< in the columns of L, without what merging adds
    double cycles; ///< estimate
} mspringi_elimination_cost;

/// Fill the tree for the places first ... end - 1 of an order; these must hold whole components. False: there would
/// be more than most_blocks blocks in L, and the tree is not of use.
bool mspringi_tree_find(mspringi_tree *tree, const mspringi_adjacency *adjacency, const uint32_t *order,
                        uint32_t first, uint32_t end, double most_blocks, mspringi_elimination_cost *cost);

/// The number of blocks in L for these places. scratch is [size]; the tree is not of use then.
double mspringi_tree_count(const mspringi_tree *tree, const mspringi_adjacency *adjacency, const uint32_t *order,
                           uint32_t first, uint32_t end, uint32_t *scratch);

/// Gather the tree's supernodes into the plan's fronts.
mspring_result mspringi_fronts_create(mspringi_cholesky_plan *plan, mspringi_tree *tree,
                                      const mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph,
                                      const uint32_t *order, mspringi_memory *memory, mspringi_message *message);

#endif
