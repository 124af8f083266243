/// How many blocks L has, without looking at each: Gilbert, Ng & Peyton (1994). Takes little longer than to look at
/// the edges, where the factor is far too large to be written down.
#include "solvers/sparse/symbolic.h"

/// The arrays of a tree that is not of use, under other names. By place in the order, but node's place.
typedef struct counting {
    uint32_t *parent, *ancestor;
    uint32_t *first;            ///< the first descendant, by number in postorder
    uint32_t *latest;           ///< the largest first of a row's leaves so far, or MSPRING_NONE
    uint32_t *last_leaf;        ///< of a row
    uint32_t *postorder;        ///< places
    uint32_t *child;            ///< first child; then the column's count less those of its children
    uint32_t *sibling;          ///< next child of the same parent
    const uint32_t *coordinate; ///< by node
} counting;

// Parents, by paths that are shortened as they are followed.
static void find_parents(const counting *c, const mspringi_adjacency *adjacency, const uint32_t *order,
                         uint32_t first, uint32_t end) {
    for (uint32_t place = first; place < end; ++place) {
        const uint32_t node = order[place];
        c->parent[place] = c->ancestor[place] = MSPRING_NONE;
        for (uint32_t i = adjacency->first[node]; i < adjacency->first[node + 1]; ++i) {
            uint32_t at = c->coordinate[adjacency->neighbour[i]];
            while (at < place) {
                const uint32_t next = c->ancestor[at];
                c->ancestor[at] = place;
                if (next == MSPRING_NONE)
                    c->parent[at] = place;
                at = next;
            }
        }
    }
}

static void find_postorder(const counting *c, uint32_t first, uint32_t end) {
    for (uint32_t place = first; place < end; ++place)
        c->child[place] = MSPRING_NONE;
    for (uint32_t place = end; place-- > first;) {
        if (c->parent[place] == MSPRING_NONE)
            continue;
        c->sibling[place] = c->child[c->parent[place]];
        c->child[c->parent[place]] = place;
    }
    uint32_t count = first;
    for (uint32_t root = first; root < end; ++root) {
        if (c->parent[root] != MSPRING_NONE)
            continue;
        for (uint32_t at = root;;) {
            while (c->child[at] != MSPRING_NONE) {
                const uint32_t child = c->child[at];
                c->child[at] = c->sibling[child]; // the one to go down to next
                at = child;
            }
            c->postorder[count++] = at;
            if (at == root)
                break;
            at = c->parent[at];
        }
    }
}

// Where the paths up from two leaves of a row meet, the later one being the last that was looked at.
static uint32_t meeting_of(const counting *c, uint32_t leaf) {
    uint32_t top = leaf;
    while (c->ancestor[top] != top)
        top = c->ancestor[top];
    while (leaf != top) {
        const uint32_t next = c->ancestor[leaf];
        c->ancestor[leaf] = top;
        leaf = next;
    }
    return top;
}

// A row's pattern is a subtree. Each of its leaves adds a path, less what that has in common with the leaf before.
static void add_leaf(const counting *c, uint32_t row, uint32_t column) {
    if (c->latest[row] != MSPRING_NONE && c->first[column] <= c->latest[row])
        return;
    c->latest[row] = c->first[column];
    c->child[column]++;
    if (c->last_leaf[row] != MSPRING_NONE)
        c->child[meeting_of(c, c->last_leaf[row])]--;
    c->last_leaf[row] = column;
}

double mspringi_tree_count(const mspringi_tree *tree, const mspringi_adjacency *adjacency, const uint32_t *order,
                           uint32_t first, uint32_t end, uint32_t *scratch) {
    const counting c = {tree->parent, tree->mark,  tree->below,   tree->into,      tree->pivots,
                        scratch,      tree->child, tree->sibling, tree->coordinate};
    for (uint32_t place = first; place < end; ++place)
        tree->coordinate[order[place]] = place;
    find_parents(&c, adjacency, order, first, end);
    find_postorder(&c, first, end);
    for (uint32_t place = first; place < end; ++place) {
        c.first[place] = c.latest[place] = c.last_leaf[place] = MSPRING_NONE;
        c.ancestor[place] = place;
    }
    for (uint32_t k = first; k < end; ++k) {
        uint32_t at = c.postorder[k];
        c.child[at] = c.first[at] == MSPRING_NONE; // a leaf of the tree
        for (; at != MSPRING_NONE && c.first[at] == MSPRING_NONE; at = c.parent[at])
            c.first[at] = k;
    }
    for (uint32_t k = first; k < end; ++k) {
        const uint32_t column = c.postorder[k], node = order[column];
        if (c.parent[column] != MSPRING_NONE)
            c.child[c.parent[column]]--;
        for (uint32_t i = adjacency->first[node]; i < adjacency->first[node + 1]; ++i)
            if (tree->coordinate[adjacency->neighbour[i]] > column)
                add_leaf(&c, tree->coordinate[adjacency->neighbour[i]], column);
        if (c.parent[column] != MSPRING_NONE)
            c.ancestor[column] = c.parent[column];
    }
    double sum = 0.0;
    for (uint32_t place = first; place < end; ++place) {
        sum += (double)c.child[place];
        if (c.parent[place] != MSPRING_NONE)
            c.child[c.parent[place]] += c.child[place];
    }
    return sum;
}
