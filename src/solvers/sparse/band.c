/// Orders for a banded factor: what is thin is eliminated from end to end, two nodes at a time.
#include <math.h>
#include <string.h>

#include "layout/analysis.h"
#include "solvers/sparse/plan.h"

/// Groups behind its own that a column of MSPRINGI_PAD rows can reach.
#define MOST_REACH (MSPRINGI_PAD / MSPRINGI_BAND_COLUMNS - 1)

/// What the choice of an order needs on the way.
typedef struct choosing {
    const mspringi_adjacency *adjacency;
    uint32_t *sorted;         ///< [size] another order
    uint32_t *place;          ///< [size] by number
    uint64_t *keys, *scratch; ///< [size]
} choosing;

// Groups that the nodes first ... end - 1 of an order reach behind their own.
static uint32_t reach_of(const choosing *c, const uint32_t *order, uint32_t first, uint32_t end) {
    uint32_t reach = 0;
    for (uint32_t place = first; place < end; ++place)
        c->place[order[place]] = place;
    for (uint32_t place = first; place < end; ++place) {
        const uint32_t node = order[place];
        for (uint32_t i = c->adjacency->first[node]; i < c->adjacency->first[node + 1]; ++i) {
            const uint32_t other = c->place[c->adjacency->neighbour[i]];
            if (other > place && other / 2 - place / 2 > reach)
                reach = other / 2 - place / 2;
        }
    }
    return reach;
}

// Sort by a coordinate, in steps of 2^-32 of its extent; what is equal stays in order. Returns the extent.
static double sort_by(const choosing *c, uint32_t *nodes, uint32_t count, const double *coordinate) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < count; ++i) {
        const double at = coordinate[c->adjacency->node[nodes[i]]];
        low = fmin(low, at);
        high = fmax(high, at);
    }
    const double scale = high > low ? 4294967295.0 / (high - low) : 0.0;
    for (uint32_t i = 0; i < count; ++i)
        c->keys[i] = (uint64_t)((coordinate[c->adjacency->node[nodes[i]]] - low) * scale) << 32 | i;
    mspringi_sort_keys(c->keys, c->scratch, count);
    for (uint32_t i = 0; i < count; ++i)
        c->place[i] = nodes[(uint32_t)c->keys[i]];
    memcpy(nodes, c->place, count * sizeof *nodes);
    return high - low;
}

static uint32_t degree_of(const choosing *c, uint32_t node) {
    return c->adjacency->first[node + 1] - c->adjacency->first[node];
}

// Search breadth-first from the first nodes of a component, those of fewest neighbours first (Cuthill & McKee
// 1969). Returns where the last level begins.
static uint32_t search_from(const choosing *c, uint32_t *nodes, uint32_t started, const uint32_t *order,
                            uint32_t count) {
    uint32_t last_level = 0, end = started;
    for (uint32_t i = 0; i < count; ++i)
        c->place[order[i]] = MSPRING_NONE;
    for (uint32_t i = 0; i < started; ++i)
        c->place[nodes[i]] = i;
    for (uint32_t place = 0, level_end = started; place < end; ++place) {
        const uint32_t node = nodes[place], own = end;
        if (place == level_end) {
            last_level = level_end;
            level_end = end;
        }
        for (uint32_t i = c->adjacency->first[node]; i < c->adjacency->first[node + 1]; ++i) {
            const uint32_t other = c->adjacency->neighbour[i];
            if (c->place[other] != MSPRING_NONE)
                continue;
            uint32_t at = end++;
            c->place[other] = at;
            for (; at > own && degree_of(c, nodes[at - 1]) > degree_of(c, other); --at)
                nodes[at] = nodes[at - 1];
            nodes[at] = other;
        }
    }
    return last_level;
}

// Order a component breadth-first from all nodes that are farthest from where its order ends: a bar's whole end,
// where that order began at a corner. Then each level lies straight across the bar, however it is bent.
static void sort_by_levels(const choosing *c, uint32_t *nodes, const uint32_t *order, uint32_t count) {
    nodes[0] = order[count - 1];
    const uint32_t farthest = search_from(c, nodes, 1, order, count);
    memmove(nodes, nodes + farthest, (count - farthest) * sizeof *nodes);
    (void)search_from(c, nodes, count - farthest, order, count);
}

// Let a component be ordered along its longer side, or by levels, if it reaches less far so than in order.
static uint32_t choose(const choosing *c, uint32_t *order, uint32_t first, uint32_t end,
                       const mspringi_cholesky_graph *graph) {
    const uint32_t count = end - first;
    const uint32_t reach = reach_of(c, order, first, end);
    if (reach <= 1 || !graph->x || !graph->y)
        return reach;
    memcpy(c->sorted + first, order + first, count * sizeof *order);
    const double width = sort_by(c, c->sorted + first, count, graph->x);
    const double height = sort_by(c, c->sorted + first, count, graph->y);
    if (width >= height)
        (void)sort_by(c, c->sorted + first, count, graph->x);
    uint32_t other = reach_of(c, c->sorted, first, end);
    // Where a node has many neighbours, no order would do.
    if (other > MOST_REACH && reach > MOST_REACH && reach <= 2 * MOST_REACH) {
        sort_by_levels(c, c->sorted + first, order + first, count);
        other = reach_of(c, c->sorted, first, end);
    }
    if (other >= reach)
        return reach;
    memcpy(order + first, c->sorted + first, count * sizeof *order);
    return other;
}

static uint32_t choose_all(const choosing *c, uint32_t *order, const mspringi_sweep_order *sweep,
                           const mspringi_cholesky_graph *graph) {
    uint32_t reach = 0;
    for (uint32_t component = 0; component < sweep->component_count && reach <= MOST_REACH; ++component) {
        const uint32_t own = choose(c, order, sweep->first[component], sweep->first[component + 1], graph);
        reach = own > reach ? own : reach;
    }
    return reach;
}

// The edges by the group of their first node, and where each begins.
static void fill_entries(mspringi_cholesky_plan *plan, const mspringi_cholesky_graph *graph,
                         const uint32_t *place_of) {
    uint32_t *const next = plan->band_entries + 1; // one ahead: where the next of a group goes
    for (int pass = 0; pass < 2; ++pass) {
        for (uint32_t edge = 0; edge < graph->edge_count; ++edge) {
            const uint32_t a = place_of[graph->edge_a[edge]], b = place_of[graph->edge_b[edge]];
            if (a == MSPRING_NONE || b == MSPRING_NONE)
                continue;
            const uint32_t column = 2 * (a < b ? a : b), row = 2 * (a < b ? b : a);
            const uint32_t own = column / MSPRINGI_BAND_COLUMNS * MSPRINGI_BAND_COLUMNS;
            uint32_t *const at = &next[column / MSPRINGI_BAND_COLUMNS];
            if (pass == 1)
                plan->entries[*at] = (mspringi_cholesky_entry){edge, column * MSPRINGI_PAD + row - own};
            ++*at;
        }
        for (uint32_t group = 0, end = 0; group < plan->band_groups && pass == 0; ++group) {
            const uint32_t count = next[group];
            next[group] = end;
            end += count;
        }
    }
}

// Products of a column with those that it reaches.
static double count_products(const mspringi_cholesky_plan *plan) {
    const double rows = (double)MSPRINGI_BAND_COLUMNS * (plan->band_reach + 1);
    double products = 0.0;
    for (double below = rows - 1.0; below > rows - 1.0 - (double)MSPRINGI_BAND_COLUMNS; below -= 1.0)
        products += 0.5 * below * (below + 1.0);
    return products * (double)plan->band_groups;
}

static bool fill(mspringi_cholesky_plan *plan, const mspringi_cholesky_graph *graph,
                 const mspringi_adjacency *adjacency, const uint32_t *order, uint32_t reach,
                 mspringi_memory *memory) {
    plan->size = adjacency->size;
    plan->band_groups = (plan->size + 1) / 2;
    plan->band_reach = reach;
    plan->order = mspringi_alloc(memory, plan->size, sizeof *plan->order);
    plan->entries = mspringi_alloc(memory, graph->edge_count, sizeof *plan->entries);
    plan->band_entries = mspringi_alloc(memory, (size_t)plan->band_groups + 1, sizeof *plan->band_entries);
    uint32_t *place_of = mspringi_alloc(memory, graph->node_count, sizeof *place_of);
    const bool ok = plan->order && plan->entries && plan->band_entries && place_of;
    if (ok) {
        for (uint32_t node = 0; node < graph->node_count; ++node)
            place_of[node] = MSPRING_NONE;
        for (uint32_t place = 0; place < plan->size; ++place) {
            plan->order[place] = adjacency->node[order[place]];
            place_of[plan->order[place]] = place;
        }
        fill_entries(plan, graph, place_of);
        plan->panel_reals = (size_t)plan->band_groups * MSPRINGI_BAND_COLUMNS * MSPRINGI_PAD;
        plan->multiply_adds = count_products(plan);
    }
    mspringi_free(memory, place_of);
    return ok;
}

mspring_result mspringi_band_create(mspringi_cholesky_plan *plan, const mspringi_sweep_order *sweep,
                                    const mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph,
                                    mspringi_memory *memory, mspringi_message *message) {
    const size_t size = adjacency->size;
    uint32_t *order = mspringi_alloc(memory, 3 * size, sizeof *order);
    uint64_t *keys = mspringi_alloc(memory, 2 * size, sizeof *keys);
    bool ok = order && keys;
    if (ok && size > 0) {
        const choosing c = {.adjacency = adjacency,
                            .sorted = order + size,
                            .place = order + 2 * size,
                            .keys = keys,
                            .scratch = keys + size};
        memcpy(order, sweep->order, size * sizeof *order);
        const uint32_t reach = choose_all(&c, order, sweep, graph);
        if (reach <= MOST_REACH)
            ok = fill(plan, graph, adjacency, order, reach, memory);
    }
    mspringi_free(memory, order);
    mspringi_free(memory, keys);
    return ok ? MSPRING_OK
              : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the plan of a matrix of %u nodes",
                              (unsigned)size);
}
