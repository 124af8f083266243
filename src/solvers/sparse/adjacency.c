/// Neighbours of the nodes that are there.
#include "solvers/sparse/symbolic.h"

static bool is_absent(const mspringi_cholesky_graph *graph, uint32_t node) {
    return graph->absent && graph->absent[node];
}

static bool is_there(const mspringi_cholesky_graph *graph, uint32_t edge) {
    return !is_absent(graph, graph->edge_a[edge]) && !is_absent(graph, graph->edge_b[edge]);
}

// Counting sort: first[i + 2] counts, then becomes the place to write the next neighbour of i at, so that in the
// end first[i + 1] is where those of i end.
mspring_result mspringi_adjacency_begin(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph,
                                        mspringi_memory *memory, mspringi_message *message) {
    const size_t nodes = graph->node_count;
    *adjacency = (mspringi_adjacency){
        .node = mspringi_alloc(memory, nodes, sizeof *adjacency->node),
        .first = mspringi_alloc(memory, nodes + 2, sizeof *adjacency->first),
        .neighbour = mspringi_alloc(memory, 2 * (size_t)graph->edge_count, sizeof *adjacency->neighbour),
        .number = mspringi_alloc(memory, nodes, sizeof *adjacency->number),
    };
    if (!adjacency->node || !adjacency->first || !adjacency->neighbour || !adjacency->number)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the graph of %u edges",
                             (unsigned)graph->edge_count);
    for (uint32_t node = 0; node < graph->node_count; ++node) {
        if (is_absent(graph, node))
            continue;
        adjacency->number[node] = adjacency->size;
        adjacency->node[adjacency->size++] = node;
    }
    return MSPRING_OK;
}

void mspringi_adjacency_count(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph, uint32_t first,
                              uint32_t end) {
    for (uint32_t edge = first; edge < end; ++edge) {
        if (!is_there(graph, edge))
            continue;
        adjacency->first[adjacency->number[graph->edge_a[edge]] + 2]++;
        adjacency->first[adjacency->number[graph->edge_b[edge]] + 2]++;
    }
}

void mspringi_adjacency_add_up(mspringi_adjacency *adjacency) {
    for (size_t i = 2; i < (size_t)adjacency->size + 2; ++i)
        adjacency->first[i] += adjacency->first[i - 1];
}

void mspringi_adjacency_list(mspringi_adjacency *adjacency, const mspringi_cholesky_graph *graph, uint32_t first,
                             uint32_t end) {
    for (uint32_t edge = first; edge < end; ++edge) {
        if (!is_there(graph, edge))
            continue;
        const uint32_t a = adjacency->number[graph->edge_a[edge]], b = adjacency->number[graph->edge_b[edge]];
        adjacency->neighbour[adjacency->first[a + 1]++] = b;
        adjacency->neighbour[adjacency->first[b + 1]++] = a;
    }
}

void mspringi_adjacency_destroy(mspringi_adjacency *adjacency, mspringi_memory *memory) {
    mspringi_free(memory, adjacency->node);
    mspringi_free(memory, adjacency->first);
    mspringi_free(memory, adjacency->neighbour);
    mspringi_free(memory, adjacency->number);
}
