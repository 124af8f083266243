/// Orders from end to end: breadth-first from a node at the far end of each component (Cuthill & McKee 1969),
/// reversed (George 1971).
#include "solvers/sparse/plan.h"

/// Searches for a node further out, each from the far end of the one before.
#define SEARCHES 4

/// A breadth-first search: the nodes reached so far are order[first] ... order[end - 1].
typedef struct search {
    const mspringi_adjacency *adjacency;
    uint32_t *order;
    uint32_t *stamp; ///< [size] of the search that reached a node
    uint32_t first, end;
    uint32_t level_count, last_level; ///< where the last level begins
} search;

static void run(search *s, uint32_t start, uint32_t stamp) {
    const mspringi_adjacency *adjacency = s->adjacency;
    s->end = s->first;
    s->order[s->end++] = start;
    s->stamp[start] = stamp;
    s->level_count = 0;
    for (uint32_t level = s->first; level < s->end;) {
        const uint32_t level_end = s->end;
        s->last_level = level;
        s->level_count++;
        for (; level < level_end; ++level) {
            const uint32_t node = s->order[level];
            for (uint32_t i = adjacency->first[node]; i < adjacency->first[node + 1]; ++i) {
                const uint32_t other = adjacency->neighbour[i];
                if (s->stamp[other] == stamp)
                    continue;
                s->stamp[other] = stamp;
                s->order[s->end++] = other;
            }
        }
    }
}

// The node of the last level with fewest neighbours: a corner rather than the middle of a side.
static uint32_t far_end(const search *s) {
    const uint32_t *first = s->adjacency->first;
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

static void find_all(mspringi_sweep_order *sweep, search *s) {
    uint32_t stamp = 0;
    for (uint32_t start = 0; start < s->adjacency->size; ++start) {
        if (s->stamp[start] != 0)
            continue;
        sweep->first[sweep->component_count++] = s->first;
        uint32_t levels = 0, from = start;
        run(s, from, ++stamp);
        for (int i = 0; i < SEARCHES && s->level_count > levels; ++i) {
            levels = s->level_count;
            from = far_end(s);
            run(s, from, ++stamp);
        }
        reverse(s->order + s->first, s->end - s->first);
        s->first = s->end;
    }
    sweep->first[sweep->component_count] = s->first;
}

mspring_result mspringi_sweep_order_find(mspringi_sweep_order *sweep, const mspringi_adjacency *adjacency,
                                         mspringi_memory *memory, mspringi_message *message) {
    const size_t size = adjacency->size;
    *sweep = (mspringi_sweep_order){
        .order = mspringi_alloc(memory, size, sizeof *sweep->order),
        .first = mspringi_alloc(memory, size + 1, sizeof *sweep->first),
    };
    search s = {.adjacency = adjacency, .order = sweep->order};
    s.stamp = mspringi_alloc(memory, size, sizeof *s.stamp);
    const bool ok = sweep->order && sweep->first && s.stamp;
    if (ok)
        find_all(sweep, &s);
    mspringi_free(memory, s.stamp);
    return ok ? MSPRING_OK
              : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to order %u nodes",
                              (unsigned)adjacency->size);
}

void mspringi_sweep_order_destroy(mspringi_sweep_order *sweep, mspringi_memory *memory) {
    mspringi_free(memory, sweep->order);
    mspringi_free(memory, sweep->first);
}
