/// The order of cells in which they lie from end to end, and their neighbours. What a path joins, once it is
/// condensed, are neighbours, too.
#include "solvers/implicit/cells.h"

// The cells that a spring joins, if it joins two.
static bool ends_of(const mspringi_cell_builder *g, mspring_id spring, uint32_t *a, uint32_t *b) {
    const mspringi_topology *t = &g->network->topology;
    const mspringi_spring_slot spring_slot = t->slot_of_spring[spring];
    if (!mspringi_spring_slot_is_laid_out(t, spring_slot))
        return false;
    mspringi_topology_ends(t, spring_slot, a, b);
    *a = g->cells->of_slot[*a];
    *b = g->cells->of_slot[*b];
    return *a != *b;
}

// The cells that a path joins, if it joins two.
static bool ends_of_path(const mspringi_cell_builder *g, const mspringi_path *path, uint32_t *a, uint32_t *b) {
    if (path->ends[0] == MSPRING_NONE || path->ends[1] == MSPRING_NONE)
        return false;
    *a = g->cells->of_slot[path->ends[0]];
    *b = g->cells->of_slot[path->ends[1]];
    return *a != *b && *a != MSPRING_NONE && *b != MSPRING_NONE;
}

static void count_pair(mspringi_cell_builder *g, uint32_t a, uint32_t b) {
    g->first[a + 2]++;
    g->first[b + 2]++;
}

static void list_pair(mspringi_cell_builder *g, uint32_t a, uint32_t b) {
    g->neighbour[g->first[a + 1]++] = b;
    g->neighbour[g->first[b + 1]++] = a;
}

// Neighbours are repeated as often as there are springs to them.
bool mspringi_cells_begin_order(mspringi_cell_builder *g) {
    g->first = mspringi_alloc(g->memory, (size_t)g->cells->count + 2, sizeof *g->first);
    return g->first != NULL;
}

void mspringi_cells_count_neighbours(mspringi_cell_builder *g, uint32_t first, uint32_t end) {
    for (mspring_id s = first; s < end; ++s) {
        uint32_t a, b;
        if (!ends_of(g, s, &a, &b))
            continue;
        count_pair(g, a, b);
    }
}

bool mspringi_cells_add_up(mspringi_cell_builder *g) {
    uint32_t a, b;
    for (uint32_t i = 0; i < g->paths->count; ++i)
        if (ends_of_path(g, &g->paths->list[i], &a, &b))
            count_pair(g, a, b);
    for (uint32_t i = 2; i < g->cells->count + 2; ++i)
        g->first[i] += g->first[i - 1];
    g->neighbour = mspringi_alloc(g->memory, g->first[g->cells->count + 1], sizeof *g->neighbour);
    return g->neighbour != NULL;
}

void mspringi_cells_list_neighbours(mspringi_cell_builder *g, uint32_t first, uint32_t end) {
    for (mspring_id s = first; s < end; ++s) {
        uint32_t a, b;
        if (!ends_of(g, s, &a, &b))
            continue;
        list_pair(g, a, b);
    }
}

// Breadth first from a cell, over those that are not marked with stamp; appends to order and returns its new end.
static uint32_t spread(const mspringi_cell_builder *graph, uint32_t from, uint32_t *order, uint32_t begin,
                       uint32_t *mark, uint32_t stamp) {
    uint32_t end = begin;
    order[end++] = from;
    mark[from] = stamp;
    for (uint32_t i = begin; i < end; ++i) {
        for (uint32_t n = graph->first[order[i]]; n < graph->first[order[i] + 1]; ++n) {
            const uint32_t next = graph->neighbour[n];
            if (mark[next] == stamp)
                continue;
            mark[next] = stamp;
            order[end++] = next;
        }
    }
    return end;
}

// Cuthill and McKee (1969), reversed (George 1971), so that thin parts that hang on others come before those.
bool mspringi_cells_sweep(mspringi_cell_builder *g) {
    const uint32_t cells = g->cells->count;
    uint32_t *order = mspringi_alloc(g->memory, cells, sizeof *order);
    uint32_t a, b, end = 0;
    g->by_sweep.order = mspringi_alloc(g->memory, cells, sizeof *order);
    g->mark = mspringi_alloc(g->memory, cells, sizeof *g->mark);
    for (uint32_t i = 0; i < g->paths->count; ++i)
        if (ends_of_path(g, &g->paths->list[i], &a, &b))
            list_pair(g, a, b);
    const bool ok = order && g->by_sweep.order && g->mark;
    for (uint32_t c = 0; ok && c < cells; ++c) {
        if (g->mark[c] != 0)
            continue;
        // Start from a cell at one end: the last that a first and a second pass find.
        uint32_t from = c;
        for (uint32_t stamp = 1; stamp <= 2; ++stamp)
            from = order[spread(g, from, order, end, g->mark, stamp) - 1];
        end = spread(g, from, order, end, g->mark, 3);
    }
    for (uint32_t i = 0; ok && i < cells; ++i)
        g->by_sweep.order[i] = order[cells - 1 - i];
    g->stamp = 3;
    mspringi_free(g->memory, order);
    return ok;
}
