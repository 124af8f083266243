/// Orders for a banded factor: what is thin is eliminated from end to end, two nodes at a time.
#include <math.h>
#include <string.h>

#include "layout/analysis.h"
#include "solvers/sparse/symbolic.h"

/// Groups behind its own that a column of MSPRINGI_PAD rows can reach.
#define MOST_REACH (MSPRINGI_PAD / MSPRINGI_BAND_COLUMNS - 1)

/// Nodes that are looked at in one go, about.
#define NODES_AT_ONCE 10000

typedef mspringi_band_choice choosing;

static mspring_result no_memory(const choosing *c, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the plan of a matrix of %u nodes",
                         (unsigned)c->adjacency->size);
}

// Groups that the nodes first ... end - 1 of an order reach behind their own, or more than twice as many as can be.
static uint32_t reach_of(const choosing *c, const uint32_t *order, uint32_t first, uint32_t end) {
    uint32_t reach = 0;
    for (uint32_t place = first; place < end; ++place)
        c->coordinate[order[place]] = place;
    for (uint32_t place = first; place < end && reach <= 2 * MOST_REACH; ++place) {
        const uint32_t node = order[place];
        for (uint32_t i = c->adjacency->first[node]; i < c->adjacency->first[node + 1]; ++i) {
            const uint32_t other = c->coordinate[c->adjacency->neighbour[i]];
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
        c->coordinate[i] = nodes[(uint32_t)c->keys[i]];
    memcpy(nodes, c->coordinate, count * sizeof *nodes);
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
        c->coordinate[order[i]] = MSPRING_NONE;
    for (uint32_t i = 0; i < started; ++i)
        c->coordinate[nodes[i]] = i;
    for (uint32_t place = 0, level_end = started; place < end; ++place) {
        const uint32_t node = nodes[place], own = end;
        if (place == level_end) {
            last_level = level_end;
            level_end = end;
        }
        for (uint32_t i = c->adjacency->first[node]; i < c->adjacency->first[node + 1]; ++i) {
            const uint32_t other = c->adjacency->neighbour[i];
            if (c->coordinate[other] != MSPRING_NONE)
                continue;
            uint32_t at = end++;
            c->coordinate[other] = at;
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

// Keep the other order, if it reaches less far.
static void end_component(choosing *c) {
    const uint32_t first = c->sweep->first[c->component], end = c->sweep->first[c->component + 1];
    if (c->other < c->own) {
        memcpy(c->order + first, c->sorted + first, (end - first) * sizeof *c->order);
        c->own = c->other;
    }
    c->reach = c->own > c->reach ? c->own : c->reach;
    c->component++;
    c->stage = 0;
}

// Let a component be ordered along its longer side, or by levels, if it reaches less far so than in order. One
// stage of that.
static void choose(choosing *c, const mspringi_cholesky_graph *graph) {
    const uint32_t first = c->sweep->first[c->component], end = c->sweep->first[c->component + 1];
    uint32_t *const sorted = c->sorted + first;
    switch (c->stage++) {
    case 0:
        c->own = c->other = reach_of(c, c->order, first, end);
        if (c->own <= 1 || !graph->x || !graph->y)
            end_component(c);
        return;
    case 1:
        memcpy(sorted, c->order + first, (end - first) * sizeof *c->order);
        c->width = sort_by(c, sorted, end - first, graph->x);
        return;
    case 2:
        c->height = sort_by(c, sorted, end - first, graph->y);
        return;
    case 3:
        if (c->width >= c->height)
            (void)sort_by(c, sorted, end - first, graph->x);
        c->other = reach_of(c, c->sorted, first, end);
        return;
    default:
        // Where a node has many neighbours, no order would do.
        if (c->other > MOST_REACH && c->own > MOST_REACH && c->own <= 2 * MOST_REACH) {
            sort_by_levels(c, sorted, c->order + first, end - first);
            c->other = reach_of(c, c->sorted, first, end);
        }
        end_component(c);
    }
}

// The edges by the group of their first node, and where each begins.
static void fill_entries(mspringi_cholesky_symbolic *plan, const mspringi_cholesky_graph *graph,
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
static double count_products(const mspringi_cholesky_symbolic *plan) {
    const double rows = (double)MSPRINGI_BAND_COLUMNS * (plan->band_reach + 1);
    double products = 0.0;
    for (double below = rows - 1.0; below > rows - 1.0 - (double)MSPRINGI_BAND_COLUMNS; below -= 1.0)
        products += 0.5 * below * (below + 1.0);
    return products * (double)plan->band_groups;
}

static bool fill(mspringi_cholesky_symbolic *plan, const mspringi_cholesky_graph *graph,
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

mspring_result mspringi_band_reserve(choosing *c, const mspringi_sweep_order *sweep,
                                     const mspringi_adjacency *adjacency, mspringi_memory *memory,
                                     mspringi_message *message) {
    const size_t size = adjacency->size;
    *c = (choosing){.adjacency = adjacency, .sweep = sweep};
    c->order = mspringi_alloc(memory, 3 * size, sizeof *c->order);
    c->keys = mspringi_alloc(memory, 2 * size, sizeof *c->keys);
    if (!c->order || !c->keys)
        return no_memory(c, message);
    c->sorted = c->order + size;
    c->coordinate = c->order + 2 * size;
    c->scratch = c->keys + size;
    memcpy(c->order, sweep->order, size * sizeof *c->order);
    return MSPRING_OK;
}

bool mspringi_band_choose(choosing *c, const mspringi_cholesky_graph *graph) {
    for (uint32_t nodes = 0; nodes < NODES_AT_ONCE;) {
        if (c->component == c->sweep->component_count || c->reach > MOST_REACH)
            return true;
        nodes += c->sweep->first[c->component + 1] - c->sweep->first[c->component];
        choose(c, graph);
    }
    return false;
}

mspring_result mspringi_band_make(choosing *c, mspringi_cholesky_symbolic *plan,
                                  const mspringi_cholesky_graph *graph, mspringi_memory *memory,
                                  mspringi_message *message) {
    const bool ok = c->adjacency->size == 0 || c->reach > MOST_REACH ||
                    fill(plan, graph, c->adjacency, c->order, c->reach, memory);
    return ok ? MSPRING_OK : no_memory(c, message);
}

void mspringi_band_destroy(choosing *c, mspringi_memory *memory) {
    mspringi_free(memory, c->order);
    mspringi_free(memory, c->keys);
    *c = (choosing){0};
}
