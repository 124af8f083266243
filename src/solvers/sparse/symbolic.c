/// Finding a plan: a band, or for each connected component the cheaper of two orders, then the fronts.
#include "solvers/sparse/symbolic.h"

#include <string.h>

#include "base/passes.h"

/// Most numbers in a factor, and in what is added up on the way: beyond that a direct solution is the wrong method.
#define MOST_NUMBERS 0x1p31

/// In a block.
#define BLOCK_NUMBERS 4.0

/// Blocks of factors that are looked at in one go, about.
#define BLOCKS_AT_ONCE 60000.0

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

static mspring_result refuse(const mspringi_cholesky_symbolic *plan, uint32_t size, double most,
                             mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_LIMIT,
                         "the factor of a matrix of %u nodes would have %.3g numbers, more than %.3g",
                         (unsigned)size, plan->predicted_numbers, most);
}

/// What is done with a component: its cost in two orders is found, then the tree of the cheaper.
typedef enum choice { BY_DISSECTION, BY_SWEEP, BY_DISSECTION_AGAIN } choice;

/// A plan that is being made.
struct mspringi_cholesky_analysis {
    mspringi_cholesky_symbolic *plan;
    const mspringi_cholesky_graph *graph;
    mspringi_memory *memory;
    mspringi_message *message;
    mspringi_cursor cursor;
    mspringi_adjacency adjacency;
    mspringi_sweep_order sweep;
    mspringi_band_choice band;
    mspringi_dissection dissection;
    mspringi_tree tree;
    mspringi_fronts_builder fronts;
    uint32_t *order;
    double most; ///< numbers
    uint32_t component;
    choice trying;
    bool is_trying, can_dissect;
    mspringi_elimination_cost by_dissection;
    double blocks; ///< of the components so far
};
typedef mspringi_cholesky_analysis planning;

static mspring_result begin_adjacency(planning *p) {
    return mspringi_adjacency_begin(&p->adjacency, p->graph, p->memory, p->message);
}

static mspring_result count_neighbours(planning *p, uint32_t first, uint32_t end) {
    mspringi_adjacency_count(&p->adjacency, p->graph, first, end);
    return MSPRING_OK;
}

static mspring_result reserve(planning *p) {
    mspringi_adjacency_add_up(&p->adjacency);
    mspring_result result = mspringi_sweep_order_reserve(&p->sweep, &p->adjacency, p->memory, p->message);
    if (result == MSPRING_OK)
        result = mspringi_tree_create(&p->tree, p->adjacency.size, p->memory, p->message);
    p->order = mspringi_alloc(p->memory, p->adjacency.size, sizeof *p->order);
    if (result == MSPRING_OK && !p->order)
        result = mspringi_fail(p->message, MSPRING_ERROR_MEMORY, "no memory to order %u nodes",
                               (unsigned)p->adjacency.size);
    return result;
}

static mspring_result list_neighbours(planning *p, uint32_t first, uint32_t end) {
    mspringi_adjacency_list(&p->adjacency, p->graph, first, end);
    return MSPRING_OK;
}

static mspring_result find_sweep(planning *p) {
    p->cursor.again = !mspringi_sweep_order_run(&p->sweep, &p->adjacency);
    return MSPRING_OK;
}

static mspring_result begin_band(planning *p) {
    return mspringi_band_reserve(&p->band, &p->sweep, &p->adjacency, p->memory, p->message);
}

static mspring_result choose_band(planning *p) {
    p->cursor.again = !mspringi_band_choose(&p->band, p->graph);
    return MSPRING_OK;
}

// Where a band will do, there is nothing left to do.
static mspring_result make_band(planning *p) {
    return mspringi_band_make(&p->band, p->plan, p->graph, p->memory, p->message);
}

static mspring_result begin_dissection(planning *p) {
    return mspringi_dissection_reserve(&p->dissection, p->order, &p->sweep, &p->adjacency, p->graph, p->memory,
                                       p->message);
}

static mspring_result dissect(planning *p) {
    bool is_done = false;
    const mspring_result result = mspringi_dissection_run(&p->dissection, p->memory, p->message, &is_done);
    p->cursor.again = !is_done;
    return result;
}

static mspring_result predict_and_refuse(planning *p) {
    uint32_t *scratch = mspringi_alloc(p->memory, p->adjacency.size, sizeof *scratch);
    if (!scratch)
        return mspringi_fail(p->message, MSPRING_ERROR_MEMORY, "no memory to count the factor of %u nodes",
                             (unsigned)p->adjacency.size);
    p->plan->predicted_numbers = predict(p->order, &p->sweep, &p->tree, &p->adjacency, scratch);
    mspringi_free(p->memory, scratch);
    return refuse(p->plan, p->adjacency.size, p->most, p->message);
}

// Begin with the tree of the present component in the order that is tried.
static void try_order(planning *p, choice trying) {
    const uint32_t first = p->sweep.first[p->component], end = p->sweep.first[p->component + 1];
    const double limit = p->most / BLOCK_NUMBERS;
    // A sweep that is cheaper has fewer blocks, so it need not be followed further than that.
    const double most = trying == BY_SWEEP && p->can_dissect ? p->by_dissection.blocks : limit;
    p->trying = trying;
    p->is_trying = true;
    mspringi_tree_begin(&p->tree, trying == BY_SWEEP ? p->sweep.order : p->order, first, end, most);
}

static void end_component(planning *p, double blocks) {
    p->blocks += blocks;
    p->component++;
    p->is_trying = false;
}

// The tree has been found. Returns false if there is no factor that is small enough.
static bool judge(planning *p) {
    const uint32_t first = p->sweep.first[p->component], end = p->sweep.first[p->component + 1];
    if (p->trying == BY_DISSECTION) {
        p->can_dissect = p->tree.fits;
        p->by_dissection = p->tree.cost;
        try_order(p, BY_SWEEP);
        return true;
    }
    if (p->trying == BY_SWEEP) {
        if (!p->can_dissect && !p->tree.fits)
            return false;
        if (!p->tree.fits || (p->can_dissect && p->tree.cost.cycles > p->by_dissection.cycles)) {
            try_order(p, BY_DISSECTION_AGAIN);
            return true;
        }
        memcpy(p->order + first, p->sweep.order + first, (end - first) * sizeof *p->order);
    }
    end_component(p, p->tree.cost.blocks);
    return true;
}

// The cheaper order of each component, into the order; the tree is that of the last one looked at.
static mspring_result choose(planning *p) {
    bool fits = true;
    p->most = p->graph->most_numbers > 0.0 ? p->graph->most_numbers : MOST_NUMBERS;
    for (double left = BLOCKS_AT_ONCE; fits && left > 0.0;) {
        if (!p->is_trying && p->component == p->sweep.component_count)
            return p->blocks <= p->most / BLOCK_NUMBERS ? MSPRING_OK : predict_and_refuse(p);
        if (!p->is_trying)
            try_order(p, BY_DISSECTION);
        if (mspringi_tree_run(&p->tree, &p->adjacency, &left))
            fits = judge(p);
    }
    p->cursor.again = true;
    return fits ? MSPRING_OK : predict_and_refuse(p);
}

static mspring_result begin_fronts(planning *p) {
    p->fronts = (mspringi_fronts_builder){
        .plan = p->plan, .tree = &p->tree, .adjacency = &p->adjacency, .graph = p->graph, .tree_order = p->order};
    return mspringi_fronts_reserve(&p->fronts, p->memory, p->message);
}

static mspring_result fill_fronts(planning *p) {
    return mspringi_fronts_fill(&p->fronts, p->memory, p->message);
}

static mspring_result fill_borders(planning *p, uint32_t first, uint32_t end) {
    mspringi_fronts_fill_borders(&p->fronts, first, end);
    return MSPRING_OK;
}

static mspring_result count_runs(planning *p, uint32_t first, uint32_t end) {
    mspringi_fronts_count_runs(&p->fronts, first, end);
    return MSPRING_OK;
}

static mspring_result reserve_runs(planning *p) {
    return mspringi_fronts_reserve_runs(&p->fronts, p->memory, p->message);
}

static mspring_result fill_runs(planning *p, uint32_t first, uint32_t end) {
    mspringi_fronts_fill_runs(&p->fronts, first, end);
    return MSPRING_OK;
}

static mspring_result count_entries(planning *p, uint32_t first, uint32_t end) {
    mspringi_fronts_count_entries(&p->fronts, first, end);
    return MSPRING_OK;
}

static mspring_result place_entries(planning *p) {
    mspringi_fronts_place_entries(&p->fronts);
    return MSPRING_OK;
}

static mspring_result fill_entries(planning *p, uint32_t first, uint32_t end) {
    mspringi_fronts_fill_entries(&p->fronts, first, end);
    return MSPRING_OK;
}

static mspring_result lay_out(planning *p) {
    mspringi_cholesky_symbolic *plan = p->plan;
    mspringi_fronts_lay_out(&p->fronts);
    // With what is added up on the way.
    plan->predicted_numbers = (double)plan->panel_reals + (double)plan->update_reals[0] +
                              (double)plan->update_reals[1] + (double)plan->scaled_reals;
    if (plan->predicted_numbers > p->most)
        return refuse(plan, p->adjacency.size, p->most, p->message);
    plan->predicted_numbers = 0.0;
    return MSPRING_OK;
}

static uint32_t edges_of(const planning *p) {
    return p->graph->edge_count;
}

static uint32_t nodes_of(const planning *p) {
    return p->adjacency.size;
}

static uint32_t fronts_of(const planning *p) {
    return p->plan->front_count;
}

MSPRINGI_PASSES(plan, planning)
static const plan_pass plan_passes[] = {
    MSPRINGI_ONCE(begin_adjacency),
    MSPRINGI_EACH(count_neighbours, edges_of, 32000),
    MSPRINGI_ONCE(reserve),
    MSPRINGI_EACH(list_neighbours, edges_of, 32000),
    MSPRINGI_ONCE(find_sweep),
    MSPRINGI_ONCE(begin_band),
    MSPRINGI_ONCE(choose_band),
    MSPRINGI_ONCE(make_band),
    MSPRINGI_ONCE(begin_dissection),
    MSPRINGI_ONCE(dissect),
    MSPRINGI_ONCE(choose),
    MSPRINGI_ONCE(begin_fronts),
    MSPRINGI_ONCE(fill_fronts),
    MSPRINGI_EACH(fill_borders, nodes_of, 4000),
    MSPRINGI_EACH(count_runs, fronts_of, 1000),
    MSPRINGI_ONCE(reserve_runs),
    MSPRINGI_EACH(fill_runs, fronts_of, 1000),
    MSPRINGI_EACH(count_entries, edges_of, 32000),
    MSPRINGI_ONCE(place_entries),
    MSPRINGI_EACH(fill_entries, edges_of, 8000),
    MSPRINGI_ONCE(lay_out),
};

mspring_result mspringi_cholesky_symbolic_begin(mspringi_cholesky_symbolic *plan,
                                                const mspringi_cholesky_graph *graph, mspringi_memory *memory,
                                                mspringi_message *message, planning **begun) {
    planning *p = mspringi_alloc(memory, 1, sizeof *p);
    if (!p)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to order %u nodes",
                             (unsigned)graph->node_count);
    *plan = (mspringi_cholesky_symbolic){.node_count = graph->node_count};
    *p = (planning){.plan = plan, .graph = graph, .memory = memory, .message = message};
    *begun = p;
    return MSPRING_OK;
}

mspring_result mspringi_cholesky_symbolic_run(planning *p, bool *is_done) {
    const mspring_result result = plan_run(p, plan_passes, &p->cursor);
    const double predicted = p->plan->predicted_numbers;
    *is_done = p->cursor.pass == MSPRINGI_PASS_COUNT(plan_passes) || p->plan->band_groups > 0;
    if (result != MSPRING_OK)
        mspringi_cholesky_symbolic_destroy(p->plan, p->memory);
    p->plan->predicted_numbers = predicted;
    return result;
}

void mspringi_cholesky_symbolic_end(planning *p, mspringi_memory *memory) {
    if (!p)
        return;
    mspringi_fronts_destroy(&p->fronts, memory);
    mspringi_free(memory, p->order);
    mspringi_tree_destroy(&p->tree, memory);
    mspringi_dissection_destroy(&p->dissection, memory);
    mspringi_band_destroy(&p->band, memory);
    mspringi_sweep_order_destroy(&p->sweep, memory);
    mspringi_adjacency_destroy(&p->adjacency, memory);
    mspringi_free(memory, p);
}

mspring_result mspringi_cholesky_symbolic_create(mspringi_cholesky_symbolic *plan,
                                                 const mspringi_cholesky_graph *graph, mspringi_memory *memory,
                                                 mspringi_message *message) {
    planning *p = NULL;
    mspring_result result = mspringi_cholesky_symbolic_begin(plan, graph, memory, message, &p);
    for (bool is_done = false; result == MSPRING_OK && !is_done;)
        result = mspringi_cholesky_symbolic_run(p, &is_done);
    mspringi_cholesky_symbolic_end(p, memory);
    return result;
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_symbolic, member, MSPRINGI_ARRAY)
static const mspringi_array_entry columns[] = {
    ARRAY(order), ARRAY(band_entries), ARRAY(fronts), ARRAY(children), ARRAY(border), ARRAY(runs), ARRAY(entries),
};
const mspringi_array_table mspringi_cholesky_symbolic_columns = MSPRINGI_ARRAY_TABLE(columns);

void mspringi_cholesky_symbolic_destroy(mspringi_cholesky_symbolic *plan, mspringi_memory *memory) {
    mspringi_array_table_free(mspringi_cholesky_symbolic_columns, plan, memory);
    *plan = (mspringi_cholesky_symbolic){0};
}
