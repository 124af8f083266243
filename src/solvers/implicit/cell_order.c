/// Numbering cells so that the envelope of the coarse matrix is narrow.
#include "solvers/implicit/cells.h"

/// Which cells springs join: repeated as often as there are springs between them.
typedef struct cell_graph {
    uint32_t count;
    uint32_t *first;     ///< [count + 2]
    uint32_t *neighbour; ///< [2 * springs between cells]
} cell_graph;

static bool ends_of(const mspringi_cells *cells, const mspring_network *network, mspringi_place place, uint32_t *a,
                    uint32_t *b) {
    const mspringi_topology *t = &network->topology;
    if (!mspringi_place_is_woven(t, place))
        return false;
    mspringi_topology_ends(t, place, a, b);
    *a = cells->of_slot[*a];
    *b = cells->of_slot[*b];
    return *a != *b;
}

static bool make_graph(cell_graph *graph, const mspringi_cells *cells, const mspring_network *network,
                       mspringi_memory *memory) {
    const uint32_t springs = network->topology.spring_count;
    uint32_t a, b, total = 0;
    graph->count = cells->count;
    graph->first = mspringi_alloc(memory, (size_t)graph->count + 2, sizeof *graph->first);
    if (!graph->first)
        return false;
    for (mspring_id s = 0; s < springs; ++s) {
        if (!ends_of(cells, network, network->topology.place_of_spring[s], &a, &b))
            continue;
        graph->first[a + 2]++;
        graph->first[b + 2]++;
        total += 2;
    }
    graph->neighbour = mspringi_alloc(memory, total, sizeof *graph->neighbour);
    if (!graph->neighbour)
        return false;
    for (uint32_t i = 2; i < graph->count + 2; ++i)
        graph->first[i] += graph->first[i - 1];
    for (mspring_id s = 0; s < springs; ++s) {
        if (!ends_of(cells, network, network->topology.place_of_spring[s], &a, &b))
            continue;
        graph->neighbour[graph->first[a + 1]++] = b;
        graph->neighbour[graph->first[b + 1]++] = a;
    }
    return true;
}

// Breadth first from a cell, over those that are not marked with stamp; appends to order and returns its new end.
static uint32_t spread(const cell_graph *graph, uint32_t from, uint32_t *order, uint32_t begin, uint32_t *mark,
                       uint32_t stamp) {
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

bool mspringi_cells_order(mspringi_cells *cells, const mspring_network *network, mspringi_memory *memory) {
    const uint32_t slots = (uint32_t)mspringi_slot_count(network);
    cell_graph graph = {0};
    uint32_t *order = mspringi_alloc(memory, cells->count, sizeof *order);
    uint32_t *mark = mspringi_alloc(memory, cells->count, sizeof *mark);
    const bool ok = make_graph(&graph, cells, network, memory) && order && mark;
    uint32_t end = 0;
    for (uint32_t c = 0; ok && c < cells->count; ++c) {
        if (mark[c] != 0)
            continue;
        // Start from a cell at one end: the last that a first and a second pass find.
        uint32_t from = c;
        for (uint32_t stamp = 1; stamp <= 2; ++stamp)
            from = order[spread(&graph, from, order, end, mark, stamp) - 1];
        end = spread(&graph, from, order, end, mark, 3);
    }
    for (uint32_t i = 0; ok && i < cells->count; ++i)
        mark[order[i]] = i;
    for (uint32_t slot = 0; ok && slot < slots; ++slot)
        if (cells->of_slot[slot] != MSPRING_NONE)
            cells->of_slot[slot] = mark[cells->of_slot[slot]];
    mspringi_free(memory, graph.first);
    mspringi_free(memory, graph.neighbour);
    mspringi_free(memory, order);
    mspringi_free(memory, mark);
    return ok;
}
