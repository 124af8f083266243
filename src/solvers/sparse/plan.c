/// Finding a plan: a band, or for each connected component the cheaper of two orders, then the fronts.
#include "solvers/sparse/plan.h"

#include <string.h>

/// Most numbers in a factor, and in what is added up on the way: beyond that a direct solution is the wrong method.
#define MOST_NUMBERS 0x1p31

/// In a block.
#define BLOCK_NUMBERS 4.0

// The cheaper order of each component, into dissected; the tree is that of the last one looked at.
static bool choose_orders(uint32_t *dissected, const mspringi_sweep_order *sweep, mspringi_tree *tree,
                          const mspringi_adjacency *adjacency, double limit) {
    double blocks = 0.0;
    for (uint32_t component = 0; component < sweep->component_count; ++component) {
        const uint32_t first = sweep->first[component], end = sweep->first[component + 1];
        mspringi_elimination_cost by_dissection, by_sweep;
        const bool can_dissect = mspringi_tree_find(tree, adjacency, dissected, first, end, limit, &by_dissection);
        // A sweep that is cheaper has fewer blocks, so it need not be followed further than that.
        const double most_blocks = can_dissect ? by_dissection.blocks : limit;
        const bool can_sweep =
            mspringi_tree_find(tree, adjacency, sweep->order, first, end, most_blocks, &by_sweep);
        if (!can_dissect && !can_sweep)
            return false;
        const bool sweeps = can_sweep && (!can_dissect || by_sweep.cycles <= by_dissection.cycles);
        blocks += sweeps ? by_sweep.blocks : by_dissection.blocks;
        if (sweeps)
            memcpy(dissected + first, sweep->order + first, (end - first) * sizeof *dissected);
        else
            (void)mspringi_tree_find(tree, adjacency, dissected, first, end, limit, &by_dissection);
    }
    return blocks <= limit;
}

// What the factor would have. The order of dissection is that of the first components no more, where a sweep was
// cheaper.
static double predict(const uint32_t *dissected, const mspringi_sweep_order *sweep, const mspringi_tree *tree,
                      const mspringi_adjacency *adjacency, uint32_t *scratch) {
    double blocks = 0.0;
    for (uint32_t component = 0; component < sweep->component_count; ++component) {
        const uint32_t first = sweep->first[component], end = sweep->first[component + 1];
        const double by_dissection = mspringi_tree_count(tree, adjacency, dissected, first, end, scratch);
        const double by_sweep = mspringi_tree_count(tree, adjacency, sweep->order, first, end, scratch);
        blocks += by_sweep < by_dissection ? by_sweep : by_dissection;
    }
    return BLOCK_NUMBERS * blocks;
}

static mspring_result refuse(const mspringi_cholesky_plan *plan, uint32_t size, double most,
                             mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_LIMIT,
                         "the factor of a matrix of %u nodes would have %.3g numbers, more than %.3g",
                         (unsigned)size, plan->predicted_numbers, most);
}

static mspring_result predict_and_refuse(mspringi_cholesky_plan *plan, const uint32_t *order,
                                         const mspringi_sweep_order *sweep, const mspringi_tree *tree,
                                         const mspringi_adjacency *adjacency, double most, mspringi_memory *memory,
                                         mspringi_message *message) {
    uint32_t *scratch = mspringi_alloc(memory, adjacency->size, sizeof *scratch);
    if (!scratch)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to count the factor of %u nodes",
                             (unsigned)adjacency->size);
    plan->predicted_numbers = predict(order, sweep, tree, adjacency, scratch);
    mspringi_free(memory, scratch);
    return refuse(plan, adjacency->size, most, message);
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
    const double most = graph->most_numbers > 0.0 ? graph->most_numbers : MOST_NUMBERS;
    if (!choose_orders(order, sweep, tree, adjacency, most / BLOCK_NUMBERS))
        return predict_and_refuse(plan, order, sweep, tree, adjacency, most, memory, message);
    result = mspringi_fronts_create(plan, tree, adjacency, graph, order, memory, message);
    // With what is added up on the way.
    const double numbers = (double)plan->panel_reals + (double)plan->update_reals[0] +
                           (double)plan->update_reals[1] + (double)plan->scaled_reals;
    if (result != MSPRING_OK || numbers <= most)
        return result;
    plan->predicted_numbers = numbers;
    return refuse(plan, adjacency->size, most, message);
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
    const double predicted = plan->predicted_numbers;
    if (result != MSPRING_OK)
        mspringi_cholesky_plan_destroy(plan, memory);
    plan->predicted_numbers = predicted;
    return result;
}

#define ARRAY(member) MSPRINGI_COLUMN(mspringi_cholesky_plan, member, MSPRINGI_ARRAY)
static const mspringi_column columns[] = {
    ARRAY(order), ARRAY(band_entries), ARRAY(fronts), ARRAY(children), ARRAY(border), ARRAY(runs), ARRAY(entries),
};
const mspringi_columns mspringi_cholesky_plan_columns = MSPRINGI_COLUMNS(columns);

void mspringi_cholesky_plan_destroy(mspringi_cholesky_plan *plan, mspringi_memory *memory) {
    mspringi_columns_free(mspringi_cholesky_plan_columns, plan, memory);
    *plan = (mspringi_cholesky_plan){0};
}
