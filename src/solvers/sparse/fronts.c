/// From supernodes to fronts: their order, borders, places in memory, and the way of each number into them.
#include "solvers/sparse/symbolic.h"

typedef mspringi_fronts_builder making;

/* --------------------------------------------------------------------------------------------- order of fronts */

// Number the supernodes so that each follows its descendants, which lie in one piece: tree->mark[last pivot].
static uint32_t number_fronts(mspringi_tree *tree, uint32_t size) {
    uint32_t count = 0;
    uint32_t *up = tree->coordinate; // not needed any more: the way back
    for (uint32_t root = 0; root < size; ++root) {
        if (tree->into[root] != root || tree->parent[root] != MSPRING_NONE)
            continue;
        uint32_t at = root;
        up[root] = MSPRING_NONE;
        bool down = true;
        while (at != MSPRING_NONE) {
            if (down && tree->child[at] != MSPRING_NONE) {
                up[tree->child[at]] = at;
                at = tree->child[at];
                continue;
            }
            tree->mark[at] = count++;
            const uint32_t parent = up[at], sibling = parent != MSPRING_NONE ? tree->sibling[at] : MSPRING_NONE;
            down = sibling != MSPRING_NONE;
            if (down)
                up[sibling] = parent;
            at = down ? sibling : parent;
        }
    }
    return count;
}

// From the last pivots of supernodes that have been merged to that of the whole.
static void resolve(mspringi_tree *tree, uint32_t size) {
    for (uint32_t place = size; place-- > 0;)
        tree->into[place] = tree->into[tree->into[place]];
}

static void fill_fronts(making *m) {
    mspringi_cholesky_symbolic *plan = m->plan;
    const mspringi_tree *tree = m->tree;
    for (uint32_t last = 0; last < plan->size; ++last) {
        if (tree->into[last] != last)
            continue;
        mspringi_front *front = &plan->fronts[tree->mark[last]];
        front->pivot_count = tree->pivots[last];
        front->border_count = tree->below[last];
        m->parent[tree->mark[last]] =
            tree->parent[last] == MSPRING_NONE ? MSPRING_NONE : tree->mark[tree->into[tree->parent[last]]];
    }
    uint32_t pivot = 0, border = 0;
    for (uint32_t f = 0; f < plan->front_count; ++f) {
        mspringi_front *front = &plan->fronts[f];
        front->first_pivot = pivot;
        front->first_border = border;
        m->filled[f] = pivot;
        pivot += front->pivot_count;
        border += front->border_count;
    }
    // Within a front the pivots keep the order that they had.
    for (uint32_t place = 0; place < plan->size; ++place) {
        const uint32_t f = tree->mark[tree->into[place]], to = m->filled[f]++;
        plan->order[to] = m->adjacency->node[m->tree_order[place]];
        m->front_of[to] = f;
    }
    for (uint32_t node = 0; node < m->graph->node_count; ++node)
        m->place_of[node] = MSPRING_NONE;
    for (uint32_t place = 0; place < plan->size; ++place)
        m->place_of[plan->order[place]] = place;
}

static void fill_children(making *m) {
    mspringi_cholesky_symbolic *plan = m->plan;
    for (uint32_t f = 0; f < plan->front_count; ++f)
        if (m->parent[f] != MSPRING_NONE)
            plan->fronts[m->parent[f]].child_count++;
    uint32_t first = 0;
    for (uint32_t f = 0; f < plan->front_count; ++f) {
        plan->fronts[f].first_child = m->filled[f] = first;
        first += plan->fronts[f].child_count;
    }
    for (uint32_t f = 0; f < plan->front_count; ++f)
        if (m->parent[f] != MSPRING_NONE)
            plan->children[m->filled[m->parent[f]]++] = f;
}

/* ---------------------------------------------------------------------------------------------------- borders */

// The rows of L, from the first place to the last, so that every border comes out sorted: from each earlier
// neighbour's front up through the parents.
void mspringi_fronts_fill_borders(making *m, uint32_t first, uint32_t end) {
    mspringi_cholesky_symbolic *plan = m->plan;
    const mspringi_adjacency *adjacency = m->adjacency;
    uint32_t *mark = m->tree->mark;
    for (uint32_t f = 0; first == 0 && f < plan->front_count; ++f) {
        m->filled[f] = plan->fronts[f].first_border;
        mark[f] = MSPRING_NONE;
    }
    for (uint32_t place = first; place < end; ++place) {
        const uint32_t own = m->front_of[place], node = adjacency->number[plan->order[place]];
        for (uint32_t i = adjacency->first[node]; i < adjacency->first[node + 1]; ++i) {
            const uint32_t other = m->place_of[adjacency->node[adjacency->neighbour[i]]];
            for (uint32_t f = m->front_of[other]; other < place && f != own && mark[f] != place; f = m->parent[f]) {
                mark[f] = place;
                plan->border[m->filled[f]++] = place;
            }
        }
    }
}

// Find a place in a front: among its pivots or, from a place in the border that is not beyond it, in its border.
static uint32_t find_in(const mspringi_cholesky_symbolic *plan, const mspringi_front *front, uint32_t place,
                        uint32_t from) {
    if (place < front->first_pivot + front->pivot_count)
        return place - front->first_pivot;
    while (plan->border[front->first_border + from] != place)
        ++from;
    return from;
}

// The runs of one front's border in its parent, into runs if there are any. Returns how many.
static uint32_t find_runs(const mspringi_cholesky_symbolic *plan, const mspringi_front *front,
                          const mspringi_front *parent, mspringi_front_run *runs) {
    const uint32_t pivot_end = parent->first_pivot + parent->pivot_count;
    uint32_t count = 0, beyond = 0;
    mspringi_front_run run = {0};
    for (uint32_t i = 0; i < front->border_count; ++i) {
        const uint32_t place = plan->border[front->first_border + i];
        const bool is_pivot = place < pivot_end;
        const uint32_t to = find_in(plan, parent, place, beyond);
        if (!is_pivot)
            beyond = to;
        if (run.count > 0 && run.is_pivot == is_pivot && run.to + run.count == to) {
            run.count++;
        } else {
            if (run.count > 0 && runs)
                runs[count - 1] = run;
            run = (mspringi_front_run){.first = i, .count = 1, .to = to, .is_pivot = is_pivot};
            ++count;
        }
    }
    if (run.count > 0 && runs)
        runs[count - 1] = run;
    return count;
}

void mspringi_fronts_count_runs(making *m, uint32_t first, uint32_t end) {
    for (uint32_t f = first; f < end; ++f) {
        mspringi_front *front = &m->plan->fronts[f];
        front->first_run = m->run_count;
        if (m->parent[f] != MSPRING_NONE)
            front->run_count = find_runs(m->plan, front, &m->plan->fronts[m->parent[f]], NULL);
        m->run_count += front->run_count;
    }
}

void mspringi_fronts_fill_runs(making *m, uint32_t first, uint32_t end) {
    for (uint32_t f = first; f < end; ++f) {
        const mspringi_front *front = &m->plan->fronts[f];
        if (m->parent[f] != MSPRING_NONE)
            find_runs(m->plan, front, &m->plan->fronts[m->parent[f]], m->plan->runs + front->first_run);
    }
}

/* ---------------------------------------------------------------------------------------------------- entries */

typedef struct edge_places {
    uint32_t front;       ///< MSPRING_NONE: an end is absent
    uint32_t column, row; ///< places
} edge_places;

static edge_places find_edge(const making *m, uint32_t edge) {
    const uint32_t a = m->place_of[m->graph->edge_a[edge]], b = m->place_of[m->graph->edge_b[edge]];
    if (a == MSPRING_NONE || b == MSPRING_NONE)
        return (edge_places){.front = MSPRING_NONE};
    const uint32_t column = a < b ? a : b;
    return (edge_places){m->front_of[column], column, a < b ? b : a};
}

// Two bins a front: edges among its pivots, and edges to its border. Where the next of an edge's bin goes, or how
// many there are.
static uint32_t *bin_of(const making *m, const edge_places *places) {
    mspringi_front *front = &m->plan->fronts[places->front];
    return m->front_of[places->row] == places->front ? &front->border_entry : &front->end_entry;
}

void mspringi_fronts_count_entries(making *m, uint32_t first, uint32_t end) {
    for (uint32_t edge = first; edge < end; ++edge) {
        const edge_places places = find_edge(m, edge);
        if (places.front != MSPRING_NONE)
            ++*bin_of(m, &places);
    }
}

// The counts become the places of the first.
void mspringi_fronts_place_entries(making *m) {
    for (uint32_t f = 0, end = 0; f < m->plan->front_count; ++f) {
        mspringi_front *front = &m->plan->fronts[f];
        const uint32_t among = front->border_entry, across = front->end_entry;
        front->first_entry = front->border_entry = end;
        front->end_entry = end + among;
        end += among + across;
    }
}

void mspringi_fronts_fill_entries(making *m, uint32_t first, uint32_t end) {
    mspringi_cholesky_symbolic *plan = m->plan;
    for (uint32_t edge = first; edge < end; ++edge) {
        const edge_places places = find_edge(m, edge);
        if (places.front == MSPRING_NONE)
            continue;
        const mspringi_front *front = &plan->fronts[places.front];
        uint32_t *next = bin_of(m, &places);
        const size_t column = 2 * (size_t)(places.column - front->first_pivot);
        const size_t rows = next == &front->border_entry ? mspringi_pivot_rows(front) : mspringi_border_rows(front);
        const size_t row = 2 * (size_t)find_in(plan, front, places.row, 0);
        plan->entries[(*next)++] = (mspringi_cholesky_entry){edge, (uint32_t)(column * rows + row)};
    }
}

/* ----------------------------------------------------------------------------------------------------- memory */

static size_t larger(size_t a, size_t b) {
    return a > b ? a : b;
}

// Update matrices lie on two stacks, by the parity of their front's depth: while a front adds up its children's,
// its own is at the top of the other stack.
void mspringi_fronts_lay_out(making *m) {
    mspringi_cholesky_symbolic *plan = m->plan;
    size_t top[2] = {0, 0};
    for (uint32_t f = plan->front_count; f-- > 0;)
        plan->fronts[f].stack = m->parent[f] == MSPRING_NONE ? 0 : 1 - plan->fronts[m->parent[f]].stack;
    for (uint32_t f = 0; f < plan->front_count; ++f) {
        mspringi_front *front = &plan->fronts[f];
        const size_t columns = 2 * (size_t)front->pivot_count, border = 2 * (size_t)front->border_count;
        const size_t pivot_rows = mspringi_pivot_rows(front), border_rows = mspringi_border_rows(front);
        front->panel = plan->panel_reals;
        plan->panel_reals += columns * (pivot_rows + border_rows);
        if (front->child_count > 0)
            top[1 - front->stack] = plan->fronts[plan->children[front->first_child]].update;
        front->update = top[front->stack];
        top[front->stack] += border * border_rows;
        plan->update_reals[front->stack] = larger(plan->update_reals[front->stack], top[front->stack]);
        plan->scaled_reals = larger(plan->scaled_reals, columns * (pivot_rows + border_rows));
        plan->vector_reals = larger(plan->vector_reals, border_rows);
        for (double rest = (double)columns + (double)border, p = 0.0; p < (double)columns; p += 1.0, rest -= 1.0)
            plan->multiply_adds += 0.5 * (rest - 1.0) * rest;
    }
}

/* ------------------------------------------------------------------------------------------------------ making */

static mspring_result no_memory(const making *m, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the plan of a matrix of %u nodes",
                         (unsigned)m->plan->size);
}

mspring_result mspringi_fronts_reserve(making *m, mspringi_memory *memory, mspringi_message *message) {
    mspringi_cholesky_symbolic *plan = m->plan;
    const size_t nodes = m->graph->node_count, size = plan->size = m->adjacency->size;
    resolve(m->tree, plan->size);
    plan->front_count = number_fronts(m->tree, plan->size);
    plan->order = mspringi_alloc(memory, size, sizeof *plan->order);
    plan->fronts = mspringi_alloc(memory, plan->front_count, sizeof *plan->fronts);
    plan->children = mspringi_alloc(memory, plan->front_count, sizeof *plan->children);
    plan->entries = mspringi_alloc(memory, m->graph->edge_count, sizeof *plan->entries);
    m->front_of = mspringi_alloc(memory, size, sizeof *m->front_of);
    m->parent = mspringi_alloc(memory, plan->front_count, sizeof *m->parent);
    m->filled = mspringi_alloc(memory, plan->front_count, sizeof *m->filled);
    m->place_of = mspringi_alloc(memory, nodes, sizeof *m->place_of);
    return plan->order && plan->fronts && plan->children && plan->entries && m->front_of && m->parent &&
                   m->filled && m->place_of
               ? MSPRING_OK
               : no_memory(m, message);
}

mspring_result mspringi_fronts_fill(making *m, mspringi_memory *memory, mspringi_message *message) {
    mspringi_cholesky_symbolic *plan = m->plan;
    fill_fronts(m);
    fill_children(m);
    const mspringi_front *last = plan->front_count > 0 ? &plan->fronts[plan->front_count - 1] : NULL;
    plan->border =
        mspringi_alloc(memory, last ? (size_t)last->first_border + last->border_count : 0, sizeof *plan->border);
    return plan->border ? MSPRING_OK : no_memory(m, message);
}

mspring_result mspringi_fronts_reserve_runs(making *m, mspringi_memory *memory, mspringi_message *message) {
    m->plan->runs = mspringi_alloc(memory, m->run_count, sizeof *m->plan->runs);
    return m->plan->runs ? MSPRING_OK : no_memory(m, message);
}

void mspringi_fronts_destroy(making *m, mspringi_memory *memory) {
    mspringi_free(memory, m->front_of);
    mspringi_free(memory, m->parent);
    mspringi_free(memory, m->filled);
    mspringi_free(memory, m->place_of);
}
