/// List of short functions that make a topology from a builder.
#include "layout/topology.h"

#include <string.h>

#include "layout/emit/layout_builder.h"
#include "layout/emit/spare.h"

mspring_result mspringi_layout_builder_fail(mspringi_layout_builder *a) {
    return mspringi_fail(a->message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles and %zu springs",
                         a->builder->particle_count, a->builder->spring_count);
}

/* ------------------------------------------------------------------------------------------ the irregular part */

// Attach nodes to their strips. They are in slot order, and those of each strip begin a slice.
static void attach_to_strips(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    for (uint32_t i = 0; i < t->irregular.attached_count; ++i) {
        if (t->irregular.attached_slot[i] == MSPRING_NONE)
            continue;
        const uint32_t number = a->sell.strip_of_block[t->irregular.attached_slot[i] / MSPRINGI_WIDTH];
        mspringi_strip *strip = &t->strips[number];
        // This strip is swept with the irregular part, one substep at a time.
        if (number >= t->wavefront_strips)
            t->tier_count = 0;
        if (strip->attached_count++ == 0)
            strip->first_attached = i;
    }
}

static mspring_result begin_irregular(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    a->sell = (mspringi_sell_builder){.sell = &t->irregular,
                                      .a = t->irregular_a,
                                      .b = t->irregular_b,
                                      .count = t->irregular_count,
                                      .first_slot = t->irregular_first * MSPRINGI_WIDTH,
                                      .own_count = t->irregular_blocks * MSPRINGI_WIDTH,
                                      .assigned_count = a->assigned_blocks * MSPRINGI_WIDTH,
                                      .has_parallel = t->parallel_count > 0,
                                      .block_count = t->block_count,
                                      .bundle_slices = a->bundles.slice_count,
                                      .bundle_springs = a->bundles.spring_count,
                                      .strip_of_block = mspringi_layout_builder_list_strips_of_blocks(a)};
    if (!a->sell.strip_of_block)
        return mspringi_layout_builder_fail(a);
    mspring_result result = mspringi_sell_begin(&a->sell, a->memory, a->message);
    if (result == MSPRING_OK)
        attach_to_strips(a);
    return result;
}

static mspring_result size_slices(mspringi_layout_builder *a) {
    return mspringi_sell_size_slices(&a->sell, a->memory, a->message);
}

static mspring_result fill_irregular(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_sell_fill(&a->sell, first, end);
    return MSPRING_OK;
}

static mspring_result link_bundles(mspringi_layout_builder *a) {
    mspringi_sell_link_bundles(&a->sell);
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------- the slots */

// List the runs of empty slots, padding included. runs NULL: only count them.
static uint32_t find_empty_slots(const mspringi_topology *t, mspringi_empty_run *runs) {
    uint32_t count = 0;
    bool in_run = false;
    for (uint32_t slot = 0; slot < t->block_count * MSPRINGI_WIDTH; ++slot) {
        const bool empty = t->particle_of_slot[slot] == MSPRING_NONE && !mspringi_slot_is_spare(t, slot);
        if (empty && !in_run && runs)
            runs[count] = (mspringi_empty_run){.first_slot = slot};
        count += empty && !in_run;
        if (empty && runs)
            runs[count - 1].slot_count++;
        in_run = empty;
    }
    return count;
}

static mspring_result assign_slots(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_layout_builder_assign_slots(a, first, end);
    return MSPRING_OK;
}

static mspring_result assign_other_slots(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    mspringi_layout_builder_assign_other_slots(a);
    t->empty_run_count = find_empty_slots(t, NULL);
    t->empty_runs = mspringi_alloc(a->memory, t->empty_run_count, sizeof *t->empty_runs);
    if (!t->empty_runs)
        return mspringi_layout_builder_fail(a);
    (void)find_empty_slots(t, t->empty_runs);
    return MSPRING_OK;
}

static mspring_result assign_spring_slots(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_layout_builder_assign_spring_slots(a, first, end);
    return MSPRING_OK;
}

static mspring_result trim_spans(mspringi_layout_builder *a) {
    mspringi_layout_builder_trim_spans(a);
    return mspringi_layout_builder_list_trimmed_spans(a);
}

/* ------------------------------------------------------------------------------- what there is to be laid out */

static mspring_result make_graph(mspringi_layout_builder *a) {
    const size_t particles = a->builder->particle_count;
    a->kinds = mspringi_alloc_unset(a->memory, particles, sizeof *a->kinds);
    if (!a->kinds)
        return mspringi_layout_builder_fail(a);
    memset(a->kinds, MSPRINGI_ROW_LOOSE, particles);
    const mspring_result result =
        mspringi_graph_create(&a->graph, a->builder, a->is_checked, a->memory, a->message);
    a->topology->parallel_count = a->graph.parallel_count;
    if (a->graph.parallel_count > 0)
        a->has_bundles = false;
    return result;
}

static mspring_result begin_equal_components(mspringi_layout_builder *a) {
    return !a->has_bundles
               ? MSPRING_OK
               : mspringi_equal_components_begin(&a->equal_components, &a->graph, a->memory, a->message);
}

static mspring_result explore_equal_components(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    if (a->equal_components.number)
        mspringi_equal_components_explore(&a->equal_components, &a->graph, a->kinds, first, end);
    return MSPRING_OK;
}

static mspring_result reserve_equal_components(mspringi_layout_builder *a) {
    return mspringi_equal_components_reserve(&a->equal_components, a->memory, a->message);
}

static mspring_result list_equal_components(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_equal_components_list(&a->equal_components, &a->graph, first, end);
    return MSPRING_OK;
}

static mspring_result find_chains(mspringi_layout_builder *a) {
    return mspringi_chains_find(&a->chains, &a->graph, a->kinds, a->memory, a->message);
}

static mspring_result begin_grids(mspringi_layout_builder *a) {
    return mspringi_grids_begin(&a->grids, &a->graph, a->kinds, a->memory, a->message);
}

static mspring_result flood_grids(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_grids_flood(&a->grids, first, end);
    return MSPRING_OK;
}

static mspring_result begin_evaluation(mspringi_layout_builder *a) {
    return mspringi_grids_begin_evaluation(&a->grids, a->memory, a->message);
}

static mspring_result count_grid_springs(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_grids_count_springs(&a->grids, first, end);
    return MSPRING_OK;
}

static mspring_result evaluate_grids(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_grids_evaluate(&a->grids, first, end);
    return MSPRING_OK;
}

static mspring_result end_search(mspringi_layout_builder *a) {
    mspringi_grids_end_search(&a->grids, a->memory);
    return MSPRING_OK;
}

static mspring_result count_for_grid_filter(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_grid_filter_count(&a->grid_filter, &a->graph, &a->grids, a->kinds, first, end);
    return MSPRING_OK;
}

static mspring_result reserve_grid_filter(mspringi_layout_builder *a) {
    return mspringi_grid_filter_reserve(&a->grid_filter, &a->graph, &a->grids, a->memory, a->message);
}

static mspring_result join_grid_components(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_grid_filter_join(&a->grid_filter, &a->graph, first, end);
    return MSPRING_OK;
}

static mspring_result count_component_springs(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_grid_filter_count_springs(&a->grid_filter, &a->graph, &a->grids, a->kinds, first, end);
    return MSPRING_OK;
}

static mspring_result apply_grid_filter(mspringi_layout_builder *a) {
    mspringi_grid_filter_apply(&a->grid_filter, &a->graph, &a->grids, a->kinds, a->memory);
    return mspringi_grids_measure(&a->grids, a->memory, a->message);
}

static mspring_result shelve_grids(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_grids_shelve(&a->grids, first, end);
    return MSPRING_OK;
}

static mspring_result begin_assignment(mspringi_layout_builder *a) {
    mspringi_grids_number(&a->grids, a->memory);
    return mspringi_strip_assignment_begin(&a->assignment, &a->graph, &a->grids, &a->chains, a->memory, a->message);
}

static mspring_result find_attached(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_strip_assignment_find_attached(&a->assignment, first, end);
    return MSPRING_OK;
}

static mspring_result reserve_assignment(mspringi_layout_builder *a) {
    return mspringi_strip_assignment_reserve(&a->assignment, a->workers, a->memory, a->message);
}

static mspring_result join_assignment_springs(mspringi_layout_builder *a, uint32_t first, uint32_t end) {
    mspringi_strip_assignment_join_springs(&a->assignment, first, end);
    return MSPRING_OK;
}

static mspring_result choose_assigned_grids(mspringi_layout_builder *a) {
    mspringi_strip_assignment_choose_grids(&a->assignment);
    return MSPRING_OK;
}

static mspring_result try_skews(mspringi_layout_builder *a) {
    a->cursor.again = !mspringi_strip_assignment_try_skews(&a->assignment);
    return MSPRING_OK;
}

static mspring_result assign_ropes(mspringi_layout_builder *a) {
    mspringi_strip_assignment_end(&a->assignment, a->memory);
    mspringi_irregular_list_count(&a->irregular, &a->graph, &a->assignment, a->kinds);
    mspring_result result = mspringi_ropes_assign_strips(&a->ropes, &a->graph, &a->grids, &a->chains,
                                                         &a->assignment, a->memory, a->message);
    if (result == MSPRING_OK)
        mspringi_chains_drop(&a->chains, &a->graph, &a->assignment, a->bundles.slice_count > 0, a->kinds,
                             &a->irregular);
    return result;
}

static mspring_result list_irregular(mspringi_layout_builder *a) {
    mspring_result result = mspringi_irregular_list_reserve(&a->irregular, &a->bundles, a->memory, a->message);
    if (result == MSPRING_OK)
        mspringi_irregular_list_fill(&a->irregular, &a->graph, &a->assignment, a->kinds);
    return result;
}

static mspring_result sort_irregular(mspringi_layout_builder *a) {
    mspringi_irregular_list_sort(&a->irregular, &a->graph, &a->assignment);
    mspringi_ropes_interleave(&a->ropes, &a->irregular);
    return MSPRING_OK;
}

static mspring_result find_tiers(mspringi_layout_builder *a) {
    return mspringi_tiers_find(&a->tiers, &a->irregular, &a->graph, a->memory, a->message);
}

static mspring_result order_irregular(mspringi_layout_builder *a) {
    mspringi_irregular_list_order_windows(&a->irregular, &a->tiers, &a->graph, a->memory);
    mspringi_irregular_list_append_bundles(&a->irregular, &a->bundles);
    return MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------------- the list */

static uint32_t particles_of(const mspringi_layout_builder *a) {
    return (uint32_t)a->builder->particle_count;
}

static uint32_t springs_of(const mspringi_layout_builder *a) {
    return (uint32_t)a->builder->spring_count;
}

static uint32_t flood_steps_of(const mspringi_layout_builder *a) {
    return 2 * particles_of(a);
}

static uint32_t candidates_of(const mspringi_layout_builder *a) {
    return mspringi_grids_candidate_count(&a->grids);
}

static uint32_t candidate_members_of(const mspringi_layout_builder *a) {
    return mspringi_grids_candidate_member_count(&a->grids);
}

static uint32_t narrow_grids_of(const mspringi_layout_builder *a) {
    return mspringi_grids_narrow_count(&a->grids);
}

static uint32_t members_of(const mspringi_layout_builder *a) {
    return a->grids.member_count;
}

static uint32_t irregular_springs_of(const mspringi_layout_builder *a) {
    return a->sell.count;
}

MSPRINGI_PASSES(layout, mspringi_layout_builder)
#define SEARCH                                                                                                     \
    MSPRINGI_EACH(flood_grids, flood_steps_of, 4000), MSPRINGI_ONCE(begin_evaluation),                             \
        MSPRINGI_EACH(count_grid_springs, candidate_members_of, 8000),                                             \
        MSPRINGI_EACH(evaluate_grids, candidates_of, 64), MSPRINGI_ONCE(end_search)

static const layout_pass layout_passes[] = {
    MSPRINGI_ONCE(make_graph),
    MSPRINGI_ONCE(begin_equal_components),
    MSPRINGI_EACH(explore_equal_components, particles_of, 16000),
    MSPRINGI_ONCE(reserve_equal_components),
    MSPRINGI_EACH(list_equal_components, particles_of, 8000),
    MSPRINGI_ONCE(mspringi_equal_components_choose),
    MSPRINGI_ONCE(mspringi_equal_components_fill),
    MSPRINGI_ONCE(find_chains),
    MSPRINGI_ONCE(begin_grids),
    SEARCH,
    SEARCH,
    SEARCH,
    MSPRINGI_EACH(count_for_grid_filter, springs_of, 32000),
    MSPRINGI_ONCE(reserve_grid_filter),
    MSPRINGI_EACH(join_grid_components, springs_of, 32000),
    MSPRINGI_EACH(count_component_springs, springs_of, 16000),
    MSPRINGI_ONCE(apply_grid_filter),
    MSPRINGI_ONCE(mspringi_equal_components_release),
    MSPRINGI_EACH(shelve_grids, narrow_grids_of, 64),
    MSPRINGI_ONCE(begin_assignment),
    MSPRINGI_EACH(find_attached, members_of, 8000),
    MSPRINGI_ONCE(reserve_assignment),
    MSPRINGI_EACH(join_assignment_springs, springs_of, 32000),
    MSPRINGI_ONCE(choose_assigned_grids),
    MSPRINGI_ONCE(try_skews),
    MSPRINGI_ONCE(assign_ropes),
    MSPRINGI_ONCE(list_irregular),
    MSPRINGI_ONCE(sort_irregular),
    MSPRINGI_ONCE(find_tiers),
    MSPRINGI_ONCE(order_irregular),
    MSPRINGI_ONCE(mspringi_layout_builder_begin_blocks),
    MSPRINGI_EACH(mspringi_layout_builder_number_blocks, members_of, 8000),
    MSPRINGI_ONCE(mspringi_layout_builder_number_other_blocks),
    MSPRINGI_ONCE(mspringi_layout_builder_reserve_maps),
    MSPRINGI_EACH(assign_slots, particles_of, 16000),
    MSPRINGI_ONCE(assign_other_slots),
    MSPRINGI_ONCE(mspringi_layout_builder_begin_spring_slots),
    MSPRINGI_EACH(assign_spring_slots, springs_of, 16000),
    MSPRINGI_ONCE(mspringi_layout_builder_save_ends),
    MSPRINGI_ONCE(mspringi_layout_builder_begin_rows),
    MSPRINGI_ONCE(mspringi_layout_builder_append_lattice_rows),
    MSPRINGI_ONCE(mspringi_layout_builder_append_other_rows),
    MSPRINGI_ONCE(trim_spans),
    MSPRINGI_ONCE(mspringi_layout_builder_make_strips),
    MSPRINGI_ONCE(begin_irregular),
    MSPRINGI_ONCE(size_slices),
    MSPRINGI_EACH(fill_irregular, irregular_springs_of, 16000),
    MSPRINGI_ONCE(link_bundles),
};

mspring_result mspringi_topology_begin(const mspring_builder *builder, const mspringi_reserve *reserve,
                                       bool is_checked, bool has_bundles, uint32_t workers, uint32_t lanes,
                                       mspringi_memory *memory, mspringi_message *message,
                                       mspringi_layout_builder **begun) {
    mspringi_layout_builder *a = mspringi_alloc(memory, 1, sizeof *a);
    if (!a)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles and %zu springs",
                             builder->particle_count, builder->spring_count);
    a->made = (mspringi_topology){.particle_count = (uint32_t)builder->particle_count,
                                  .spring_count = (uint32_t)builder->spring_count,
                                  .reserve = *reserve,
                                  .may_have_bundles = has_bundles};
    a->topology = &a->made;
    a->memory = memory;
    a->message = message;
    a->builder = builder;
    a->is_checked = is_checked;
    a->has_bundles = has_bundles;
    a->workers = workers;
    a->lanes = lanes;
    *begun = a;
    return MSPRING_OK;
}

mspring_result mspringi_topology_run(mspringi_layout_builder *a, bool *is_done) {
    const mspring_result result = layout_run(a, layout_passes, &a->cursor);
    *is_done = a->cursor.pass == MSPRINGI_PASS_COUNT(layout_passes);
    return result;
}

void mspringi_topology_abandon(mspringi_layout_builder *begun, mspringi_memory *memory) {
    if (!begun)
        return;
    mspringi_topology_destroy(&begun->made, memory);
    mspringi_free(memory, begun->kinds);
    mspringi_free(memory, begun->blocks);
    mspringi_free(memory, begun->end_block);
    mspringi_free(memory, begun->begin_of_row);
    mspringi_free(memory, begun->busy);
    mspringi_sell_builder_destroy(&begun->sell, memory);
    mspringi_graph_destroy(&begun->graph, memory);
    mspringi_free(memory, begun->bundles.particles);
    mspringi_free(memory, begun->bundles.is_first);
    mspringi_equal_components_destroy(&begun->equal_components, memory);
    mspringi_chains_destroy(&begun->chains, memory);
    mspringi_grids_destroy(&begun->grids, memory);
    mspringi_grid_filter_destroy(&begun->grid_filter, memory);
    mspringi_strip_assignment_destroy(&begun->assignment, memory);
    mspringi_ropes_destroy(&begun->ropes, memory);
    mspringi_irregular_list_destroy(&begun->irregular, memory);
    mspringi_tiers_destroy(&begun->tiers, memory);
    mspringi_free(memory, begun);
}

void mspringi_topology_finish(mspringi_layout_builder *begun, mspringi_memory *memory,
                              mspringi_topology *topology) {
    begun->made.lattice_count = begun->grids.found_count;
    begun->made.lattice_particles = begun->grids.member_count;
    begun->made.chain_count = begun->chains.chain_count;
    begun->made.chain_particles = begun->chains.count;
    begun->made.chain_springs = begun->chains.spring_count;
    begun->made.irregular_particles = begun->irregular.count;
    // NOLINTNEXTLINE(-Wanalyzer-null-dereference): it was begun
    *topology = begun->made;
    // NOLINTNEXTLINE(-Wanalyzer-null-dereference): as above
    begun->made = (mspringi_topology){0};
    mspringi_topology_abandon(begun, memory);
}

static mspring_result assign_spare(mspringi_topology *t, mspringi_memory *memory, mspringi_message *message) {
    mspring_result result = mspringi_spare_reserve(t, 0, memory, message);
    if (result != MSPRING_OK)
        return result;
    mspringi_spare_set_entries(t);
    return mspringi_spare_assign_slots(t, memory, message);
}

mspring_result mspringi_topology_create(mspringi_topology *topology, const mspring_builder *builder,
                                        const mspringi_reserve *reserve, bool has_bundles, uint32_t workers,
                                        uint32_t lanes, mspringi_memory *memory, mspringi_message *message) {
    mspringi_layout_builder *begun = NULL;
    mspring_result result =
        mspringi_topology_begin(builder, reserve, false, has_bundles, workers, lanes, memory, message, &begun);
    for (bool is_done = false; result == MSPRING_OK && !is_done;)
        result = mspringi_topology_run(begun, &is_done);
    if (result != MSPRING_OK) {
        mspringi_topology_abandon(begun, memory);
        return result;
    }
    mspringi_topology_finish(begun, memory, topology);
    result = assign_spare(topology, memory, message);
    if (result != MSPRING_OK)
        mspringi_topology_destroy(topology, memory);
    return result;
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_topology, member, MSPRINGI_ARRAY)
static const mspringi_array_entry arrays[] = {
    ARRAY(slot_of_particle),
    ARRAY(particle_of_slot),
    ARRAY(slot_of_spring),
    ARRAY(up_of_block),
    ARRAY(grid_of_row),
    ARRAY(empty_runs),
    ARRAY(irregular_a),
    ARRAY(irregular_b),
    ARRAY(initial_slots),
    ARRAY(initial_spring_slots),
    ARRAY(irregular.attached_slot),
    ARRAY(irregular.first_slice_column),
    ARRAY(irregular.end_column),
    ARRAY(irregular.neighbour),
    ARRAY(irregular.entry),
    ARRAY(irregular.is_interleaved),
    ARRAY(irregular.is_read),
    ARRAY(irregular.first_link),
    ARRAY(irregular.links),
    ARRAY(spans),
    ARRAY(trimmed_spans),
    ARRAY(first_trimmed),
    ARRAY(rows),
    ARRAY(strips),
    ARRAY(tier_blocks),
};
const mspringi_array_table mspringi_topology_arrays = MSPRINGI_ARRAY_TABLE(arrays);

void mspringi_topology_destroy(mspringi_topology *topology, mspringi_memory *memory) {
    mspringi_array_table_free(mspringi_topology_arrays, topology, memory);
    *topology = (mspringi_topology){0};
}
