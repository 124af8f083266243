/// Elimination trees (Liu 1990) and supernodes.
#include "solvers/sparse/symbolic.h"

/// Cycles of a front, of one of its columns (a pivot waits for the one before), of a product and subtraction of 16
/// floats, and of adding a column of a child's update: what a factorisation and solution was measured to take with
/// AVX-512, and near enough elsewhere, where all but the second grow alike.
#define FRONT_CYCLES 160.0
#define COLUMN_CYCLES 32.0
#define PRODUCT_CYCLES 0.75
#define UPDATE_CYCLES 8.0

mspring_result mspringi_tree_create(mspringi_tree *tree, uint32_t size, mspringi_memory *memory,
                                    mspringi_message *message) {
    uint32_t **const arrays[] = {&tree->coordinate, &tree->parent, &tree->below,   &tree->into,
                                 &tree->pivots,     &tree->child,  &tree->sibling, &tree->mark};
    bool ok = true;
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; ++i) {
        *arrays[i] = mspringi_alloc(memory, size, sizeof(uint32_t));
        ok = ok && *arrays[i];
    }
    return ok ? MSPRING_OK
              : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the elimination tree of %u nodes",
                              (unsigned)size);
}

void mspringi_tree_destroy(mspringi_tree *tree, mspringi_memory *memory) {
    uint32_t *const arrays[] = {tree->coordinate, tree->parent, tree->below,   tree->into,
                                tree->pivots,     tree->child,  tree->sibling, tree->mark};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; ++i)
        mspringi_free(memory, arrays[i]);
}

/* ------------------------------------------------------------------------------------------------ columns of L */

// A node's row of L is a subtree: from each earlier neighbour up until the node, or a place seen before, is
// reached. The top of such a path that has no parent yet gets the node as its own. Returns the blocks of the row.
static double find_row(mspringi_tree *tree, const mspringi_adjacency *adjacency, uint32_t place) {
    const uint32_t node = tree->order[place];
    uint32_t blocks = 1;
    tree->parent[place] = MSPRING_NONE;
    tree->below[place] = 0;
    tree->mark[place] = place;
    for (uint32_t i = adjacency->first[node]; i < adjacency->first[node + 1]; ++i) {
        uint32_t column = tree->coordinate[adjacency->neighbour[i]];
        while (column < place && tree->mark[column] != place) {
            tree->mark[column] = place;
            tree->below[column]++;
            ++blocks;
            if (tree->parent[column] == MSPRING_NONE)
                tree->parent[column] = place;
            column = tree->parent[column];
        }
    }
    return (double)blocks;
}

/* -------------------------------------------------------------------------------------------------- supernodes */

// Consecutive columns that are alike but for the pivots among them.
static void find_supernodes(mspringi_tree *tree, uint32_t first, uint32_t end) {
    for (uint32_t place = first; place < end; ++place) {
        tree->into[place] = place;
        tree->pivots[place] = 1;
        tree->child[place] = MSPRING_NONE;
    }
    for (uint32_t place = first; place + 1 < end; ++place) {
        if (tree->parent[place] == place + 1 && tree->below[place] == tree->below[place + 1] + 1) {
            tree->into[place] = place + 1;
            tree->pivots[place + 1] += tree->pivots[place];
            tree->pivots[place] = 0;
        }
    }
}

static uint32_t last_pivot(const mspringi_tree *tree, uint32_t place) {
    while (tree->into[place] != place)
        place = tree->into[place];
    return place;
}

static void link_children(mspringi_tree *tree, uint32_t first, uint32_t end) {
    for (uint32_t place = end; place-- > first;) {
        if (tree->into[place] != place || tree->parent[place] == MSPRING_NONE)
            continue;
        const uint32_t parent = last_pivot(tree, tree->parent[place]);
        tree->sibling[place] = tree->child[parent];
        tree->child[parent] = place;
    }
}

static double front_cycles(double pivot_nodes, double border_nodes) {
    const double columns = 2.0 * pivot_nodes, border = 2.0 * border_nodes;
    const double pivot_vectors = (double)mspringi_pad((size_t)columns) / MSPRINGI_PAD;
    const double border_vectors = (double)mspringi_pad((size_t)border + 1) / MSPRINGI_PAD;
    const double products = columns * columns * (pivot_vectors / 3.0 + border_vectors / 2.0 + 0.5) +
                            columns * border * (border_vectors + 1.0) / 2.0;
    return FRONT_CYCLES + COLUMN_CYCLES * columns + PRODUCT_CYCLES * products + UPDATE_CYCLES * border;
}

static double supernode_cycles(const mspringi_tree *tree, uint32_t last) {
    return front_cycles(tree->pivots[last], tree->below[last]);
}

// Let a supernode take its child's pivots, if the larger front costs less than the two.
static bool merge(mspringi_tree *tree, uint32_t parent, uint32_t child, uint32_t most_pivots) {
    const uint32_t pivots = tree->pivots[parent] + tree->pivots[child];
    if (pivots > most_pivots ||
        front_cycles(pivots, tree->below[parent]) > supernode_cycles(tree, parent) + supernode_cycles(tree, child))
        return false;
    tree->pivots[parent] = pivots;
    tree->pivots[child] = 0;
    tree->into[child] = parent;
    return true;
}

// One pass over all supernodes, children first.
static void merge_pass(mspringi_tree *tree, uint32_t first, uint32_t end, uint32_t most_pivots) {
    for (uint32_t parent = first; parent < end; ++parent) {
        if (tree->into[parent] != parent)
            continue;
        for (uint32_t *link = &tree->child[parent]; *link != MSPRING_NONE;) {
            const uint32_t child = *link;
            if (!merge(tree, parent, child, most_pivots)) {
                link = &tree->sibling[child];
                continue;
            }
            // The child's children take its place in the list.
            uint32_t *tail = &tree->child[child];
            while (*tail != MSPRING_NONE)
                tail = &tree->sibling[*tail];
            *tail = tree->sibling[child];
            *link = tree->child[child];
        }
    }
}

void mspringi_tree_begin(mspringi_tree *tree, const uint32_t *order, uint32_t first, uint32_t end,
                         double most_blocks) {
    tree->order = order;
    tree->first = tree->at = first;
    tree->end = end;
    tree->most_blocks = most_blocks;
    tree->most_pivots = 1;
    tree->fits = true;
    tree->cost = (mspringi_elimination_cost){0};
    for (uint32_t place = first; place < end; ++place)
        tree->coordinate[order[place]] = place;
}

// Small supernodes are merged first, so that a long chain of them ends up in equal parts and not as one.
bool mspringi_tree_run(mspringi_tree *tree, const mspringi_adjacency *adjacency, double *left) {
    const uint32_t first = tree->first, end = tree->end;
    for (; tree->at<end && * left> 0.0; ++tree->at) {
        const double blocks = find_row(tree, adjacency, tree->at);
        tree->cost.blocks += blocks;
        *left -= blocks;
        tree->fits = tree->cost.blocks <= tree->most_blocks;
        if (!tree->fits)
            return true;
    }
    if (tree->at < end || *left <= 0.0)
        return false;
    *left -= (double)(end - first);
    if (tree->most_pivots == 1) {
        find_supernodes(tree, first, end);
        link_children(tree, first, end);
    } else {
        merge_pass(tree, first, end, tree->most_pivots);
    }
    tree->most_pivots *= 2;
    if (tree->most_pivots <= 1024)
        return false;
    for (uint32_t place = first; place < end; ++place)
        if (tree->into[place] == place)
            tree->cost.cycles += supernode_cycles(tree, place);
    return true;
}
