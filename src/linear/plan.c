/// Finding a plan: a band, or for each connected component the cheaper of two orders, then the fronts.
#include "plan.h"

#include <string.h>

/// Most numbers in a factor, as blocks of four: beyond that a direct solution is the wrong method.
#define MOST_BLOCKS ((double)((uint32_t)1 << 29))

// The cheaper order of each component, into dissected; the tree is that of the last one looked at.
static bool choose_orders(uint32_t *dissected, const mspringi_sweep_order *sweep, mspringi_tree *tree,
                          const mspringi_adjacency *adjacency) {
    double blocks = 0.0;
    for (uint32_t component = 0; component < sweep->component_count; ++component) {
        const uint32_t first = sweep->first[component], end = sweep->first[component + 1];
        mspringi_elimination_cost by_dissection, by_sweep;
        const bool can_dissect =
            mspringi_tree_find(tree, adjacency, dissected, first, end, MOST_BLOCKS, &by_dissection);
        // A sweep that is cheaper has fewer blocks, so it need not be followed further than that.
        const double most_blocks = can_dissect ? by_dissection.blocks : MOST_BLOCKS;
        const bool can_sweep =
            mspringi_tree_find(tree, adjacency, sweep->order, first, end, most_blocks, &by_sweep);
        if (!can_dissect && !can_sweep)
            return false;
        const bool sweeps = can_sweep && (!can_dissect || by_sweep.cycles <= by_dissection.cycles);
        blocks += sweeps ? by_sweep.blocks : by_dissection.blocks;
        if (sweeps)
            memcpy(dissected + first, sweep->order + first, (end - first) * sizeof *dissected);
        else
            (void)mspringi_tree_find(tree, adjacency, dissected, first, end, MOST_BLOCKS, &by_dissection);
    }
    return blocks <= MOST_BLOCKS;
}

static mspring_result find(mspringi_cholesky_plan *plan, const mspringi_cholesky_graph *graph,
                           const mspringi_adjacency *adjacency, const mspringi_sweep_order *sweep,
                           mspringi_tree *tree, uint32_t *order, mspringi_memory *memory,
                           mspringi_message *message) {
    mspring_result result = mspringi_band_create(plan, sweep, adjacency, graph, memory, message);
    if (result != MSPRING_OK || plan->band_groups > 0)
        return result;
    result = mspringi_dissect(order, sweep, adjacency, graph, memory, message);
    if (result != MSPRING_OK)
        return result;
    if (!choose_orders(order, sweep, tree, adjacency))
        return mspringi_fail(message, MSPRING_ERROR_LIMIT,
                             "the factor of a matrix of %u nodes and %u edges would have over 2^31 numbers",
                             (unsigned)adjacency->size, (unsigned)graph->edge_count);
    return mspringi_fronts_create(plan, tree, adjacency, graph, order, memory, message);
}

mspring_result mspringi_cholesky_plan_create(mspringi_cholesky_plan *plan, const mspringi_cholesky_graph *graph,
                                             mspringi_memory *memory, mspringi_message *message) {
    mspringi_adjacency adjacency = {0};
    mspringi_sweep_order sweep = {0};
    mspringi_tree tree = {0};
    uint32_t *order = NULL;
    *plan = (mspringi_cholesky_plan){.node_count = graph->node_count};
    mspring_result result = mspringi_adjacency_create(&adjacency, graph, memory, message);
    if (result == MSPRING_OK)
        result = mspringi_sweep_order_find(&sweep, &adjacency, memory, message);
    if (result == MSPRING_OK)
        result = mspringi_tree_create(&tree, adjacency.size, memory, message);
    if (result == MSPRING_OK) {
        order = mspringi_alloc(memory, adjacency.size, sizeof *order);
        result = order ? find(plan, graph, &adjacency, &sweep, &tree, order, memory, message)
                       : mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to order %u nodes",
                                       (unsigned)adjacency.size);
    }
    mspringi_free(memory, order);
    mspringi_tree_destroy(&tree, memory);
    mspringi_sweep_order_destroy(&sweep, memory);
    mspringi_adjacency_destroy(&adjacency, memory);
    if (result != MSPRING_OK)
        mspringi_cholesky_plan_destroy(plan, memory);
    return result;
}

void mspringi_cholesky_plan_destroy(mspringi_cholesky_plan *plan, mspringi_memory *memory) {
    mspringi_free(memory, plan->order);
    mspringi_free(memory, plan->band_entries);
    mspringi_free(memory, plan->fronts);
    mspringi_free(memory, plan->children);
    mspringi_free(memory, plan->border);
    mspringi_free(memory, plan->runs);
    mspringi_free(memory, plan->entries);
    *plan = (mspringi_cholesky_plan){0};
}
