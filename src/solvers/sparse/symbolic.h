/// @file symbolic.h
/// What a plan consists of, and the steps by which it is found: adjacency, orders, elimination tree, fronts.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYMBOLIC_H
#define MSPRINGI_SYMBOLIC_H

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
    uint32_t *number;    ///< [node_count] of the graph, of those that are there
} mspringi_adjacency;

/// Find them, in this order; ranges are of edges.
mspring_result mspringi_adjacency_begin(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph,
                                        mspringi_memory *memory, mspringi_message *message);
void mspringi_adjacency_count(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph, uint32_t first,
                              uint32_t end);
void mspringi_adjacency_add_up(mspringi_adjacency *adjacency);
void mspringi_adjacency_list(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph, uint32_t first,
                             uint32_t end);
void mspringi_adjacency_destroy(mspringi_adjacency *adjacency, mspringi_memory *memory);

/// Connected components, one behind the other, each ordered from end to end: an elimination in this order sweeps
/// through it.
typedef struct mspringi_sweep_order {
    uint32_t *order; ///< [size]
    uint32_t *first; ///< [component_count + 1] where each begins in order
    uint32_t component_count;

    // While it is found: a breadth-first search that has reached order[begin] ... order[end - 1].
    uint32_t *stamp; ///< [size] of the search that reached a node
    uint32_t begin, end, done, level_end;
    uint32_t level_count, last_level; ///< where the last level begins
    uint32_t stamps, start;
    uint32_t searches, levels; ///< of the component, and the most levels of one of them
    bool is_searching;
} mspringi_sweep_order;

/// Find it: reserve, then run until it returns true.
mspring_result mspringi_sweep_order_reserve(mspringi_sweep_order *sweep, const mspringi_adjacency *adjacency,
                                            mspringi_memory *memory, mspringi_message *message);
bool mspringi_sweep_order_run(mspringi_sweep_order *sweep, const mspringi_adjacency *adjacency);
void mspringi_sweep_order_destroy(mspringi_sweep_order *sweep, mspringi_memory *memory);

/// The choice of an order for a banded factor.
typedef struct mspringi_band_choice {
    const mspringi_adjacency *adjacency;
    const mspringi_sweep_order *sweep;
    uint32_t *order, *sorted; ///< [size] the one so far, and another
    uint32_t *coordinate;     ///< [size] by number
    uint64_t *keys, *scratch; ///< [size]
    uint32_t component, stage, own, other;
    uint32_t reach; ///< of the components so far
    double width, height;
} mspringi_band_choice;

/// Make the plan of a banded factor, if there is an order in which no node reaches further than that has room for:
/// reserve, then choose until it returns true, then make. Else plan->band_groups stays 0.
mspring_result mspringi_band_reserve(mspringi_band_choice *choice, const mspringi_sweep_order *sweep,
                                     const mspringi_adjacency *adjacency, mspringi_memory *memory,
                                     mspringi_message *message);
bool mspringi_band_choose(mspringi_band_choice *choice, const mspringi_cholesky_graph *graph);
mspring_result mspringi_band_make(mspringi_band_choice *choice, mspringi_cholesky_symbolic *plan,
                                  const mspringi_cholesky_graph *graph, mspringi_memory *memory,
                                  mspringi_message *message);
void mspringi_band_destroy(mspringi_band_choice *choice, mspringi_memory *memory);

/// A set of nodes that is to be cut.
typedef struct mspringi_segment {
    uint32_t first, end, region;
} mspringi_segment;

/// A nested dissection. A set of nodes is a segment of by_x and the same segment of by_y, which hold the same
/// nodes; its order goes into the same segment of order.
typedef struct mspringi_dissection {
    const mspringi_adjacency *adjacency;
    const mspringi_sweep_order *sweep;
    double *x, *y;         ///< [size] by number, NULL: unknown
    uint32_t *order;       ///< [size]
    uint32_t *by_x, *by_y; ///< [size] sorted by coordinate
    uint32_t *region;      ///< [size] which set a node is in; 0: already in a cut
    uint32_t *scratch;     ///< [size]
    uint64_t *keys;        ///< [2 size]
    uint32_t region_count;
    uint32_t component;
    bool is_sorted; ///< the component, by x
    mspringi_segment *waiting;
    size_t waiting_count, waiting_capacity;
} mspringi_dissection;

/// Order the nodes of each component, which lie as in sweep, by nested dissection: reserve, then run until it is
/// done. order is [size].
mspring_result mspringi_dissection_reserve(mspringi_dissection *dissection, uint32_t *order,
                                           const mspringi_sweep_order *sweep, const mspringi_adjacency *adjacency,
                                           const mspringi_cholesky_graph *graph, mspringi_memory *memory,
                                           mspringi_message *message);
mspring_result mspringi_dissection_run(mspringi_dissection *dissection, mspringi_memory *memory,
                                       mspringi_message *message, bool *is_done);
void mspringi_dissection_destroy(mspringi_dissection *dissection, mspringi_memory *memory);

/// What an elimination will take.
typedef struct mspringi_elimination_cost {
    double blocks; ///< in the columns of L, without what merging adds
    double cycles; ///< estimate
} mspringi_elimination_cost;

/// The elimination tree of an order and its supernodes. Everything is by place in the order.
typedef struct mspringi_tree {
    uint32_t *coordinate; ///< [size] place of a node
    uint32_t
        *parent;     ///< [size] the first place later on to which the elimination couples this one, or MSPRING_NONE
    uint32_t *below; ///< [size] how many such places there are
    uint32_t *into;  ///< [size] the last pivot of the supernode that this place belongs to
    uint32_t *pivots;  ///< [size] of a supernode's last pivot: how many it has
    uint32_t *child;   ///< [size] of a supernode's last pivot: first child, as its last pivot,
    uint32_t *sibling; ///< [size] and the next one with the same parent
    uint32_t *mark;    ///< [size] scratch

    // While it is found.
    const uint32_t *order;
    uint32_t first, end, at, most_pivots;
    double most_blocks;
    bool fits; ///< there are no more than most_blocks
    mspringi_elimination_cost cost;
} mspringi_tree;

mspring_result mspringi_tree_create(mspringi_tree *tree, uint32_t size, mspringi_memory *memory,
                                    mspringi_message *message);
void mspringi_tree_destroy(mspringi_tree *tree, mspringi_memory *memory);

/// Fill the tree for the places first ... end - 1 of an order; these must hold whole components: begin, then run
/// until it returns true. left is how much is to be done in one go, about so many blocks of L, and what is left of
/// that. Where the tree does not fit it is not of use.
void mspringi_tree_begin(mspringi_tree *tree, const uint32_t *order, uint32_t first, uint32_t end,
                         double most_blocks);
bool mspringi_tree_run(mspringi_tree *tree, const mspringi_adjacency *adjacency, double *left);

/// The number of blocks in L for these places. scratch is [size]; the tree is not of use then.
double mspringi_tree_count(const mspringi_tree *tree, const mspringi_adjacency *adjacency, const uint32_t *order,
                           uint32_t first, uint32_t end, uint32_t *scratch);

/// What the making of fronts needs on the way.
typedef struct mspringi_fronts_builder {
    mspringi_cholesky_symbolic *plan;
    mspringi_tree *tree;
    const mspringi_adjacency *adjacency;
    const mspringi_cholesky_graph *graph;
    const uint32_t *tree_order;
    uint32_t *front_of; ///< [size] by place in the final order
    uint32_t *parent;   ///< [front_count] or MSPRING_NONE
    uint32_t *filled;   ///< [front_count] scratch
    uint32_t *place_of; ///< [node_count] of the graph; MSPRING_NONE if absent
    uint32_t run_count; ///< so far
} mspringi_fronts_builder;

/// Gather the tree's supernodes into the plan's fronts, in this order. Ranges are of places, of fronts twice, and
/// of edges twice.
mspring_result mspringi_fronts_reserve(mspringi_fronts_builder *making, mspringi_memory *memory,
                                       mspringi_message *message);
mspring_result mspringi_fronts_fill(mspringi_fronts_builder *making, mspringi_memory *memory,
                                    mspringi_message *message);
void mspringi_fronts_fill_borders(mspringi_fronts_builder *making, uint32_t first, uint32_t end);
void mspringi_fronts_count_runs(mspringi_fronts_builder *making, uint32_t first, uint32_t end);
mspring_result mspringi_fronts_reserve_runs(mspringi_fronts_builder *making, mspringi_memory *memory,
                                            mspringi_message *message);
void mspringi_fronts_fill_runs(mspringi_fronts_builder *making, uint32_t first, uint32_t end);
void mspringi_fronts_count_entries(mspringi_fronts_builder *making, uint32_t first, uint32_t end);
void mspringi_fronts_place_entries(mspringi_fronts_builder *making);
void mspringi_fronts_fill_entries(mspringi_fronts_builder *making, uint32_t first, uint32_t end);
void mspringi_fronts_lay_out(mspringi_fronts_builder *making);
void mspringi_fronts_destroy(mspringi_fronts_builder *making, mspringi_memory *memory);

#endif
