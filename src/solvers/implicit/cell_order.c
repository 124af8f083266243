/// Order of cells for a narrow envelope of the coarse matrix (Cuthill and McKee 1969).
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
        g->first[a + 2]++;
        g->first[b + 2]++;
    }
}

bool mspringi_cells_add_up(mspringi_cell_builder *g) {
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
        g->neighbour[g->first[a + 1]++] = b;
        g->neighbour[g->first[b + 1]++] = a;
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

bool mspringi_cells_order(mspringi_cell_builder *g) {
    mspringi_cells *cells = g->cells;
    const uint32_t slots = (uint32_t)mspringi_slot_count(g->network);
    uint32_t *order = mspringi_alloc(g->memory, cells->count, sizeof *order);
    uint32_t *mark = mspringi_alloc(g->memory, cells->count, sizeof *mark);
    const bool ok = order && mark;
    uint32_t end = 0;
    for (uint32_t c = 0; ok && c < cells->count; ++c) {
        if (mark[c] != 0)
            continue;
        // Start from a cell at one end: the last that a first and a second pass find.
        uint32_t from = c;
        for (uint32_t stamp = 1; stamp <= 2; ++stamp)
            from = order[spread(g, from, order, end, mark, stamp) - 1];
        end = spread(g, from, order, end, mark, 3);
    }
    for (uint32_t i = 0; ok && i < cells->count; ++i)
        mark[order[i]] = i;
    for (uint32_t slot = 0; ok && slot < slots; ++slot)
        if (cells->of_slot[slot] != MSPRING_NONE)
            cells->of_slot[slot] = mark[cells->of_slot[slot]];
    mspringi_free(g->memory, order);
    mspringi_free(g->memory, mark);
    return ok;
}
