/// Nested dissection (George 1973): a set of nodes is cut in two, the nodes along the cut come last in the order,
/// and each half is cut in turn.
///
/// The cut goes across the longer side of the box around the set. Where positions say little (they coincide, or
/// springs reach far), it goes through the middle of a breadth-first search instead.
#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "layout/analysis.h"
#include "solvers/sparse/symbolic.h"

/// Sets of at most this many nodes are not cut. The tree's supernodes are merged afterwards, so small is right.
#define SMALLEST_SET 3

/// Nodes of sets that are cut in one go, about.
#define NODES_AT_ONCE 16000

typedef mspringi_dissection dissection;
typedef mspringi_segment segment;

/// A cut: numbers of the two halves' regions, and how many nodes lie along it.
typedef struct cut {
    uint32_t left, right; ///< regions
    uint32_t left_count;  ///< nodes left of it, those along it included
    uint32_t along;       ///< how many lie along it,
    uint32_t along_side;  ///< and the region that they were in
} cut;

/* ---------------------------------------------------------------------------------------------- one cut's nodes */

static bool touches(const dissection *d, uint32_t node, uint32_t region) {
    const mspringi_adjacency *a = d->adjacency;
    for (uint32_t i = a->first[node]; i < a->first[node + 1]; ++i)
        if (d->region[a->neighbour[i]] == region)
            return true;
    return false;
}

static uint32_t count_touching(const dissection *d, const uint32_t *nodes, uint32_t count, uint32_t region) {
    uint32_t touching = 0;
    for (uint32_t i = 0; i < count; ++i)
        touching += touches(d, nodes[i], region);
    return touching;
}

// Put the first left_count of a set's nodes on the left side and the others on the right.
static cut make_cut(dissection *d, segment set, const uint32_t *nodes, uint32_t left_count) {
    cut made = {.left = d->region_count + 1, .right = d->region_count + 2, .left_count = left_count};
    const uint32_t count = set.end - set.first;
    d->region_count += 2;
    for (uint32_t i = 0; i < count; ++i)
        d->region[nodes[i]] = i < left_count ? made.left : made.right;
    const uint32_t on_left = count_touching(d, nodes, left_count, made.right);
    const uint32_t on_right = count_touching(d, nodes + left_count, count - left_count, made.left);
    made.along = on_left <= on_right ? on_left : on_right;
    made.along_side = on_left <= on_right ? made.left : made.right;
    return made;
}

/* ----------------------------------------------------------------------------------------------- where to cut */

// The place nearest to the middle at which the coordinate changes, in the middle third; 0 if there is none.
static uint32_t find_gap(const uint32_t *nodes, uint32_t count, const double *coordinate) {
    for (uint32_t step = 0; step <= count / 6; ++step) {
        const uint32_t middle = count / 2, places[] = {middle + step, middle - step};
        for (int i = 0; i < 2; ++i)
            if (places[i] > 0 && places[i] < count &&
                coordinate[nodes[places[i] - 1]] < coordinate[nodes[places[i]]])
                return places[i];
    }
    return 0;
}

// Nodes of the set in the order of a breadth-first search from a node far out, into scratch.
static void search(dissection *d, segment set) {
    const mspringi_adjacency *a = d->adjacency;
    const uint32_t count = set.end - set.first;
    uint32_t start = d->by_x[set.first];
    for (int pass = 0; pass < 2; ++pass) {
        const uint32_t here = pass == 0 ? set.region : d->region_count, reached = ++d->region_count;
        uint32_t end = 0, done = 0, next = set.first;
        d->scratch[end++] = start;
        d->region[start] = reached;
        while (end < count || done < end) {
            if (done == end) { // the set is not connected
                while (d->region[d->by_x[next]] == reached)
                    ++next;
                d->region[d->by_x[next]] = reached;
                d->scratch[end++] = d->by_x[next];
            }
            const uint32_t node = d->scratch[done++];
            for (uint32_t i = a->first[node]; i < a->first[node + 1]; ++i) {
                const uint32_t other = a->neighbour[i];
                if (d->region[other] != here)
                    continue;
                d->region[other] = reached;
                d->scratch[end++] = other;
            }
        }
        start = d->scratch[count - 1];
    }
}

// Cut a set. A cut without a node on one side: it cannot be cut.
static cut choose_cut(dissection *d, segment set, bool *by_y_along) {
    const uint32_t count = set.end - set.first;
    const uint32_t *by_x = d->by_x + set.first, *by_y = d->by_y + set.first;
    const uint32_t enough = 2 * (uint32_t)sqrt((double)count) + 2; // a compact set has a shorter cut than this
    *by_y_along = true;
    if (d->x) {
        const double width = d->x[by_x[count - 1]] - d->x[by_x[0]], height = d->y[by_y[count - 1]] - d->y[by_y[0]];
        const bool across_x = width >= height;
        const uint32_t *nodes = across_x ? by_x : by_y;
        const uint32_t gap = find_gap(nodes, count, across_x ? d->x : d->y);
        if (gap > 0) {
            const cut made = make_cut(d, set, nodes, gap);
            *by_y_along = across_x;
            if (made.along <= enough)
                return made;
            set.region = made.left;
            for (uint32_t i = 0; i < count; ++i)
                d->region[by_x[i]] = made.left;
            search(d, set);
            const cut other = make_cut(d, set, d->scratch, count / 2);
            if (other.along < made.along)
                return other;
            return make_cut(d, set, nodes, gap);
        }
    }
    search(d, set);
    return make_cut(d, set, d->scratch, count / 2);
}

/* ------------------------------------------------------------------------------------------------- set by set */

// Stable: those of the left region first, then the right, then the rest.
static void part(uint32_t *nodes, uint32_t count, const dissection *d, const cut *at, uint32_t *scratch) {
    uint32_t end = 0;
    const uint32_t regions[] = {at->left, at->right, 0};
    for (int side = 0; side < 3; ++side)
        for (uint32_t i = 0; i < count; ++i)
            if (d->region[nodes[i]] == regions[side])
                scratch[end++] = nodes[i];
    memcpy(nodes, scratch, count * sizeof *nodes);
}

// Have a set wait, if it holds any node.
static bool put_aside(dissection *d, mspringi_memory *memory, segment set) {
    void *waiting = d->waiting;
    if (set.first == set.end)
        return true;
    if (!mspringi_grow(memory, &waiting, &d->waiting_capacity, d->waiting_count + 1, sizeof *d->waiting))
        return false;
    d->waiting = waiting;
    MSPRINGI_ASSERT(set.first < set.end);
    d->waiting[d->waiting_count++] = set;
    return true;
}

// Cut a set; its halves wait, the left one on top. False: no memory.
static bool dissect(dissection *d, mspringi_memory *memory, segment set) {
    const uint32_t count = set.end - set.first;
    uint32_t *by_x = d->by_x + set.first, *by_y = d->by_y + set.first, *order = d->order + set.first;
    if (count <= SMALLEST_SET) {
        memcpy(order, by_x, count * sizeof *order);
        return true;
    }
    bool by_y_along;
    const cut at = choose_cut(d, set, &by_y_along);
    const uint32_t other_side = at.along_side == at.left ? at.right : at.left;
    // All of them are found before any is marked, or the second would not see the first.
    uint32_t along = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (d->region[by_x[i]] == at.along_side && touches(d, by_x[i], other_side))
            d->scratch[along++] = by_x[i];
    for (uint32_t i = 0; i < along; ++i)
        d->region[d->scratch[i]] = 0;
    part(by_x, count, d, &at, d->scratch);
    part(by_y, count, d, &at, d->scratch);
    const uint32_t left = at.left_count - (at.along_side == at.left ? along : 0);
    memcpy(order + count - along, (by_y_along ? by_y : by_x) + count - along, along * sizeof *order);
    return put_aside(d, memory, (segment){set.first + left, set.end - along, at.right}) &&
           put_aside(d, memory, (segment){set.first, set.first + left, at.left});
}

/* -------------------------------------------------------------------------------------------------- preparation */

// Sort the nodes of a component by a coordinate, in steps of 2^-32 of its extent, then by number.
static void sort_by(uint32_t *nodes, uint32_t count, const double *coordinate, uint64_t *keys, uint64_t *scratch) {
    double low = coordinate[nodes[0]], high = low;
    for (uint32_t i = 1; i < count; ++i) {
        low = fmin(low, coordinate[nodes[i]]);
        high = fmax(high, coordinate[nodes[i]]);
    }
    const double scale = high > low ? 4294967295.0 / (high - low) : 0.0;
    for (uint32_t i = 0; i < count; ++i)
        keys[i] = (uint64_t)((coordinate[nodes[i]] - low) * scale) << 32 | nodes[i];
    mspringi_sort_keys(keys, scratch, count);
    for (uint32_t i = 0; i < count; ++i)
        nodes[i] = (uint32_t)keys[i];
}

// Begin with the next component: sort its nodes by x, or by y and have it wait.
static bool begin_component(dissection *d, mspringi_memory *memory) {
    const uint32_t first = d->sweep->first[d->component], end = d->sweep->first[d->component + 1];
    if (d->x && !d->is_sorted) {
        sort_by(d->by_x + first, end - first, d->x, d->keys, d->keys + d->adjacency->size);
        d->is_sorted = true;
        return true;
    }
    if (d->x)
        sort_by(d->by_y + first, end - first, d->y, d->keys, d->keys + d->adjacency->size);
    d->is_sorted = false;
    const uint32_t region = ++d->region_count;
    for (uint32_t i = first; i < end; ++i)
        d->region[d->by_x[i]] = region;
    d->component++;
    return put_aside(d, memory, (segment){first, end, region});
}

static mspring_result no_memory(const mspringi_adjacency *adjacency, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to order %u nodes", (unsigned)adjacency->size);
}

mspring_result mspringi_dissection_run(dissection *d, mspringi_memory *memory, mspringi_message *message,
                                       bool *is_done) {
    bool ok = true;
    for (uint32_t nodes = 0; ok && nodes < NODES_AT_ONCE;) {
        *is_done = d->waiting_count == 0 && d->component == d->sweep->component_count;
        if (*is_done)
            return MSPRING_OK;
        if (d->waiting_count == 0) {
            nodes += d->sweep->first[d->component + 1] - d->sweep->first[d->component];
            ok = begin_component(d, memory);
            continue;
        }
        const segment set = d->waiting[--d->waiting_count];
        nodes += set.end - set.first;
        ok = dissect(d, memory, set);
    }
    return ok ? MSPRING_OK : no_memory(d->adjacency, message);
}

mspring_result mspringi_dissection_reserve(dissection *d, uint32_t *order, const mspringi_sweep_order *sweep,
                                           const mspringi_adjacency *adjacency,
                                           const mspringi_cholesky_graph *graph, mspringi_memory *memory,
                                           mspringi_message *message) {
    const size_t size = adjacency->size;
    const bool placed = graph->x && graph->y;
    *d = (dissection){.adjacency = adjacency, .sweep = sweep, .order = order};
    d->by_x = mspringi_alloc(memory, size, sizeof *d->by_x);
    d->by_y = mspringi_alloc(memory, size, sizeof *d->by_y);
    d->region = mspringi_alloc(memory, size, sizeof *d->region);
    d->scratch = mspringi_alloc(memory, size, sizeof *d->scratch);
    d->keys = mspringi_alloc(memory, placed ? 2 * size : 0, sizeof *d->keys);
    d->x = placed ? mspringi_alloc(memory, 2 * size, sizeof *d->x) : NULL;
    if (!d->by_x || !d->by_y || !d->region || !d->scratch || !d->keys || (placed && !d->x))
        return no_memory(adjacency, message);
    d->y = placed ? d->x + size : NULL;
    for (size_t i = 0; placed && i < size; ++i) {
        d->x[i] = graph->x[adjacency->node[i]];
        d->y[i] = graph->y[adjacency->node[i]];
    }
    memcpy(d->by_x, sweep->order, size * sizeof *d->by_x);
    memcpy(d->by_y, sweep->order, size * sizeof *d->by_y);
    return MSPRING_OK;
}

void mspringi_dissection_destroy(dissection *d, mspringi_memory *memory) {
    void *const blocks[] = {d->by_x, d->by_y, d->region, d->scratch, d->keys, d->x, d->waiting};
    for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; ++i)
        mspringi_free(memory, blocks[i]);
    *d = (dissection){0};
}
