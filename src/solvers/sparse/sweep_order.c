/// Orders from end to end: breadth-first from a node at the far end of each component (Cuthill & McKee 1969),
/// reversed (George 1971).
#include "solvers/sparse/symbolic.h"

/// Searches for a node further out, each from the far end of the one before.
#define SEARCHES 4

/// Nodes that are looked at in one go.
#define NODES_AT_ONCE 10000

typedef mspringi_sweep_order search;

static void begin_search(search *s, uint32_t start) {
    s->end = s->done = s->level_end = s->begin;
    s->order[s->end++] = start;
    s->stamp[start] = ++s->stamps;
    s->level_count = 0;
}

// Returns whether the search has come to its end.
static bool go_on(search *s, const mspringi_adjacency *adjacency, uint32_t *left) {
    for (; s->done<s->end && * left> 0; --*left) {
        if (s->done == s->level_end) {
            s->last_level = s->done;
            s->level_end = s->end;
            s->level_count++;
        }
        const uint32_t node = s->order[s->done++];
        for (uint32_t i = adjacency->first[node]; i < adjacency->first[node + 1]; ++i) {
            const uint32_t other = adjacency->neighbour[i];
            if (s->stamp[other] == s->stamps)
                continue;
            s->stamp[other] = s->stamps;
            s->order[s->end++] = other;
        }
    }
    return s->done == s->end;
}

// The node of the last level with fewest neighbours: a corner rather than the middle of a side.
static uint32_t far_end(const search *s, const mspringi_adjacency *adjacency) {
    const uint32_t *first = adjacency->first;
    uint32_t best = s->order[s->last_level];
    for (uint32_t i = s->last_level + 1; i < s->end; ++i) {
        const uint32_t node = s->order[i];
        if (first[node + 1] - first[node] < first[best + 1] - first[best])
            best = node;
    }
    return best;
}

static void reverse(uint32_t *values, uint32_t count) {
    for (uint32_t i = 0; i < count / 2; ++i) {
        const uint32_t swapped = values[i];
        values[i] = values[count - 1 - i];
        values[count - 1 - i] = swapped;
    }
}

// Begin with the next component. False: there is none.
static bool begin_component(search *s, uint32_t size) {
    while (s->start < size && s->stamp[s->start] != 0)
        ++s->start;
    s->first[s->component_count] = s->begin;
    if (s->start == size)
        return false;
    s->component_count++;
    s->levels = s->searches = 0;
    s->is_searching = true;
    begin_search(s, s->start);
    return true;
}

bool mspringi_sweep_order_run(mspringi_sweep_order *s, const mspringi_adjacency *adjacency) {
    for (uint32_t left = NODES_AT_ONCE; left > 0;) {
        if (!s->is_searching && !begin_component(s, adjacency->size))
            return true;
        if (!go_on(s, adjacency, &left))
            return false;
        if (s->searches < SEARCHES && s->level_count > s->levels) {
            s->levels = s->level_count;
            s->searches++;
            begin_search(s, far_end(s, adjacency));
            continue;
        }
        reverse(s->order + s->begin, s->end - s->begin);
        s->begin = s->end;
        s->is_searching = false;
    }
    return false;
}

mspring_result mspringi_sweep_order_reserve(mspringi_sweep_order *sweep, const mspringi_adjacency *adjacency,
                                            mspringi_memory *memory, mspringi_message *message) {
    const size_t size = adjacency->size;
    *sweep = (mspringi_sweep_order){
        .order = mspringi_alloc(memory, size, sizeof *sweep->order),
        .first = mspringi_alloc(memory, size + 1, sizeof *sweep->first),
        .stamp = mspringi_alloc(memory, size, sizeof *sweep->stamp),
    };
    return sweep->order && sweep->first && sweep->stamp
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to order %u nodes",
                               (unsigned)adjacency->size);
}

void mspringi_sweep_order_destroy(mspringi_sweep_order *sweep, mspringi_memory *memory) {
    mspringi_free(memory, sweep->order);
    mspringi_free(memory, sweep->first);
    mspringi_free(memory, sweep->stamp);
}
