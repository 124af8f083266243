/// Neighbours of the nodes that are there.
#include "solvers/sparse/plan.h"

static bool is_absent(const mspringi_cholesky_graph *graph, uint32_t node) {
    return graph->absent && graph->absent[node];
}

static bool is_there(const mspringi_cholesky_graph *graph, uint32_t edge) {
    return !is_absent(graph, graph->edge_a[edge]) && !is_absent(graph, graph->edge_b[edge]);
}

// Counting sort: first[i + 2] counts, then becomes the place to write the next neighbour of i at, so that in the
// end first[i + 1] is where those of i end.
static void fill(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph, uint32_t *number) {
    uint32_t *first = adjacency->first;
    adjacency->size = 0;
    for (uint32_t node = 0; node < graph->node_count; ++node) {
        if (is_absent(graph, node))
            continue;
        number[node] = adjacency->size;
        adjacency->node[adjacency->size++] = node;
    }
    for (uint32_t edge = 0; edge < graph->edge_count; ++edge) {
        if (!is_there(graph, edge))
            continue;
        first[number[graph->edge_a[edge]] + 2]++;
        first[number[graph->edge_b[edge]] + 2]++;
    }
    for (size_t i = 2; i < (size_t)adjacency->size + 2; ++i)
        first[i] += first[i - 1];
    for (uint32_t edge = 0; edge < graph->edge_count; ++edge) {
        if (!is_there(graph, edge))
            continue;
        const uint32_t a = number[graph->edge_a[edge]], b = number[graph->edge_b[edge]];
        adjacency->neighbour[first[a + 1]++] = b;
        adjacency->neighbour[first[b + 1]++] = a;
    }
}

mspring_result mspringi_adjacency_create(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph,
                                         mspringi_memory *memory, mspringi_message *message) {
    const size_t nodes = graph->node_count;
    *adjacency = (mspringi_adjacency){
        .node = mspringi_alloc(memory, nodes, sizeof *adjacency->node),
        .first = mspringi_alloc(memory, nodes + 2, sizeof *adjacency->first),
        .neighbour = mspringi_alloc(memory, 2 * (size_t)graph->edge_count, sizeof *adjacency->neighbour),
    };
    uint32_t *number = mspringi_alloc(memory, nodes, sizeof *number);
    const bool ok = adjacency->node && adjacency->first && adjacency->neighbour && number;
    if (ok)
        fill(adjacency, graph, number);
    mspringi_free(memory, number);
    return ok ? MSPRING_OK
              : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the graph of %u edges",
                              (unsigned)graph->edge_count);
}

void mspringi_adjacency_destroy(mspringi_adjacency *adjacency, mspringi_memory *memory) {
    mspringi_free(memory, adjacency->node);
    mspringi_free(memory, adjacency->first);
    mspringi_free(memory, adjacency->neighbour);
}
