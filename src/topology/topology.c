/// A topology as a list of passes, from the builder to the web.
#include "topology.h"

#include <string.h>

#include "assembly.h"
#include "spare.h"

mspring_result mspringi_assembly_fail(mspringi_assembly *a) {
    return mspringi_fail(a->message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles and %zu springs",
                         a->builder->particle_count, a->builder->spring_count);
}

/* ---------------------------------------------------------------------------------------------------- the web */

static mspring_result begin_web(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    a->weaving = (mspringi_weaving){.web = &t->web,
                                    .a = t->leftover_a,
                                    .b = t->leftover_b,
                                    .count = t->leftover_count,
                                    .first_slot = t->web_first * MSPRINGI_WIDTH,
                                    .own_count = t->web_blocks * MSPRINGI_WIDTH,
                                    .homed_count = a->homed_blocks * MSPRINGI_WIDTH,
                                    .block_count = t->block_count,
                                    .herd_first = t->web_blocks - a->herds.group_count,
                                    .rung_above = a->herds.rung_above,
                                    .strip_of_block = mspringi_assembly_list_strips_of_blocks(a)};
    return a->weaving.strip_of_block ? mspringi_web_begin(&a->weaving, &a->pace, a->memory, a->message)
                                     : mspringi_assembly_fail(a);
}

// The attached nodes are in slot order, and each strip's begin a group.
static mspring_result attach_to_strips(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->web.attached_count, 4, &first, &end);
    for (uint32_t i = first; i < end; ++i) {
        if (t->web.attached_slot[i] == MSPRING_NONE)
            continue;
        const uint32_t number = a->weaving.strip_of_block[t->web.attached_slot[i] / MSPRINGI_WIDTH];
        mspringi_strip *strip = &t->strips[number];
        // Such a strip is swept with the web, one substep after the other.
        if (number >= t->wave_strips)
            t->layer_count = 0;
        if (strip->attached_count++ == 0)
            strip->first_attached = i;
    }
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------- the whole */

// List the slots without particle, the padding in front and behind among them: first count them, then fill.
static mspring_result go_through_empty_slots(mspringi_assembly *a, mspringi_empty_run *runs) {
    const mspringi_topology *t = a->topology;
    uint32_t first, end;
    mspringi_pace_take(&a->pace, t->block_count * MSPRINGI_WIDTH, 1, &first, &end);
    for (uint32_t slot = first; slot < end; ++slot) {
        const bool empty = t->particle_of_slot[slot] == MSPRING_NONE && !mspringi_slot_is_spare(t, slot);
        if (empty && !a->in_run && runs)
            runs[a->runs] = (mspringi_empty_run){.first_slot = slot};
        a->runs += empty && !a->in_run;
        if (empty && runs)
            runs[a->runs - 1].slot_count++;
        a->in_run = empty;
    }
    return MSPRING_OK;
}

static mspring_result count_empty_slots(mspringi_assembly *a) {
    return go_through_empty_slots(a, NULL);
}

static mspring_result reserve_empty_slots(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    t->empty_runs = mspringi_pace_alloc(&a->pace, a->memory, a->runs, sizeof *t->empty_runs);
    t->empty_run_count = a->runs;
    a->runs = 0;
    a->in_run = false;
    return t->empty_runs ? MSPRING_OK : mspringi_assembly_fail(a);
}

static mspring_result list_empty_slots(mspringi_assembly *a) {
    return go_through_empty_slots(a, a->topology->empty_runs);
}

/* The passes of others. */

static mspring_result begin_graph(mspringi_assembly *a) {
    const size_t particles = a->builder->particle_count;
    a->kinds = mspringi_pace_alloc(&a->pace, a->memory, particles, sizeof *a->kinds);
    if (!a->kinds)
        return mspringi_assembly_fail(a);
    memset(a->kinds, MSPRINGI_ROW_LOOSE, particles);
    return mspringi_graph_reserve(&a->graph, a->builder, a->is_checked, &a->pace, a->memory, a->message);
}

static mspring_result count_graph(mspringi_assembly *a) {
    mspringi_graph_count(&a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result sum_graph(mspringi_assembly *a) {
    mspringi_graph_sum(&a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result fill_graph(mspringi_assembly *a) {
    mspringi_graph_fill(&a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result check_graph(mspringi_assembly *a) {
    return mspringi_graph_check(&a->graph, &a->pace, a->memory, a->message);
}

static mspring_result begin_herds(mspringi_assembly *a) {
    return !a->has_herds ? MSPRING_OK : mspringi_herds_begin(&a->herds, &a->graph, &a->pace, a->memory, a->message);
}

static mspring_result explore_trees(mspringi_assembly *a) {
    if (a->has_herds)
        mspringi_herds_explore(&a->herds, &a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result reserve_herds(mspringi_assembly *a) {
    return mspringi_herds_reserve(&a->herds, &a->pace, a->memory, a->message);
}

static mspring_result compare_trees(mspringi_assembly *a) {
    mspringi_herds_compare(&a->herds, &a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result sort_trees(mspringi_assembly *a) {
    mspringi_herds_sort(&a->herds, &a->pace);
    return MSPRING_OK;
}

static mspring_result count_herds(mspringi_assembly *a) {
    return mspringi_herds_count(&a->herds, &a->pace, a->memory, a->message);
}

static mspring_result fill_herds(mspringi_assembly *a) {
    mspringi_herds_fill(&a->herds, a->kinds, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result count_strands(mspringi_assembly *a) {
    mspringi_strands_count(&a->strands, &a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result begin_strands(mspringi_assembly *a) {
    return mspringi_strands_reserve(&a->strands, &a->graph, &a->pace, a->memory, a->message);
}

static mspring_result find_strands(mspringi_assembly *a) {
    mspringi_strands_find(&a->strands, &a->graph, a->kinds, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result begin_grids(mspringi_assembly *a) {
    return mspringi_grids_reserve(&a->grids, &a->graph, a->kinds, &a->pace, a->memory, a->message);
}

static mspring_result find_grids(mspringi_assembly *a) {
    mspringi_grids_find(&a->grids, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result survey_sheets(mspringi_assembly *a) {
    mspringi_sheets_survey(&a->sheets, &a->graph, &a->grids, a->kinds, &a->pace);
    return MSPRING_OK;
}

static mspring_result begin_sheets(mspringi_assembly *a) {
    return mspringi_sheets_reserve(&a->sheets, &a->graph, &a->grids, &a->pace, a->memory, a->message);
}

static mspring_result join_sheets(mspringi_assembly *a) {
    mspringi_sheets_join(&a->sheets, &a->graph, &a->pace);
    return MSPRING_OK;
}

static mspring_result count_sheet_springs(mspringi_assembly *a) {
    mspringi_sheets_count_springs(&a->sheets, &a->graph, &a->grids, a->kinds, &a->pace);
    return MSPRING_OK;
}

static mspring_result count_sheet_particles(mspringi_assembly *a) {
    mspringi_sheets_count_particles(&a->sheets, &a->graph, &a->grids, a->kinds, &a->pace);
    return MSPRING_OK;
}

static mspring_result give_up_sheets(mspringi_assembly *a) {
    mspringi_sheets_give_up(&a->sheets, &a->grids, a->kinds, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result measure_grids(mspringi_assembly *a) {
    return mspringi_grids_measure(&a->grids, &a->pace, a->memory, a->message);
}

static mspring_result shelve_grids(mspringi_assembly *a) {
    mspringi_grids_shelve(&a->grids, &a->pace);
    return MSPRING_OK;
}

static mspring_result number_grids(mspringi_assembly *a) {
    mspringi_grids_number(&a->grids, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result begin_homes(mspringi_assembly *a) {
    return mspringi_homes_reserve(&a->homes, &a->graph, &a->grids, &a->strands, &a->pace, a->memory, a->message);
}

static mspring_result attach_homes(mspringi_assembly *a) {
    mspringi_homes_attach(&a->homes, &a->pace);
    return MSPRING_OK;
}

static mspring_result prepare_homes(mspringi_assembly *a) {
    return mspringi_homes_prepare(&a->homes, a->workers, &a->pace, a->memory, a->message);
}

static mspring_result find_homes(mspringi_assembly *a) {
    mspringi_homes_find(&a->homes, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result count_web(mspringi_assembly *a) {
    mspringi_web_list_count(&a->web, &a->graph, &a->homes, a->kinds, &a->pace);
    return MSPRING_OK;
}

static mspring_result begin_ropes(mspringi_assembly *a) {
    return mspringi_ropes_reserve(&a->ropes, &a->graph, &a->grids, &a->strands, &a->homes, &a->pace, a->memory,
                                  a->message);
}

static mspring_result settle_ropes(mspringi_assembly *a) {
    mspringi_ropes_settle(&a->ropes, &a->pace);
    return MSPRING_OK;
}

static mspring_result stand_ropes(mspringi_assembly *a) {
    mspringi_ropes_stand(&a->ropes, &a->web, &a->pace);
    return MSPRING_OK;
}

static mspring_result drop_strands(mspringi_assembly *a) {
    mspringi_strands_drop(&a->strands, &a->graph, &a->homes, a->herds.group_count > 0, a->kinds, &a->web, &a->pace);
    return MSPRING_OK;
}

static mspring_result begin_web_list(mspringi_assembly *a) {
    return mspringi_web_list_reserve(&a->web, &a->herds, &a->pace, a->memory, a->message);
}

static mspring_result list_web(mspringi_assembly *a) {
    mspringi_web_list_fill(&a->web, &a->graph, &a->homes, a->kinds, &a->pace);
    return MSPRING_OK;
}

static mspring_result set_web_keys(mspringi_assembly *a) {
    mspringi_web_list_set_keys(&a->web, &a->graph, &a->homes, &a->pace);
    return MSPRING_OK;
}

static mspring_result sort_web(mspringi_assembly *a) {
    mspringi_web_list_sort(&a->web, &a->pace);
    return MSPRING_OK;
}

static mspring_result order_web(mspringi_assembly *a) {
    mspringi_web_list_take_order(&a->web, &a->pace);
    return MSPRING_OK;
}

static mspring_result begin_layers(mspringi_assembly *a) {
    return mspringi_layers_reserve(&a->layers, &a->web, &a->graph, &a->pace, a->memory, a->message);
}

static mspring_result find_layers(mspringi_assembly *a) {
    mspringi_layers_find(&a->layers, &a->graph, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result order_web_windows(mspringi_assembly *a) {
    mspringi_web_list_order_windows(&a->web, &a->layers, &a->graph, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result append_herds(mspringi_assembly *a) {
    mspringi_web_list_append_herds(&a->web, &a->herds, &a->pace);
    return MSPRING_OK;
}

static mspring_result count_degrees(mspringi_assembly *a) {
    mspringi_web_count_degrees(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result count_upright(mspringi_assembly *a) {
    mspringi_web_count_upright(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result take_upright(mspringi_assembly *a) {
    mspringi_web_take_upright(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result list_attached(mspringi_assembly *a) {
    mspringi_web_list_attached(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result reserve_web(mspringi_assembly *a) {
    return mspringi_web_reserve(&a->weaving, &a->pace, a->memory, a->message);
}

static mspring_result number_nodes(mspringi_assembly *a) {
    mspringi_web_number_nodes(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result count_rungs(mspringi_assembly *a) {
    return mspringi_web_count_rungs(&a->weaving, &a->pace, a->message);
}

static mspring_result reserve_rungs(mspringi_assembly *a) {
    return mspringi_web_reserve_rungs(&a->weaving, &a->pace, a->memory, a->message);
}

static mspring_result lay_rungs(mspringi_assembly *a) {
    mspringi_web_lay_rungs(&a->weaving, &a->pace);
    return MSPRING_OK;
}

static mspring_result fill_web(mspringi_assembly *a) {
    mspringi_web_fill(&a->weaving, &a->pace, a->memory);
    return MSPRING_OK;
}

static mspring_result (*const layout_passes[])(mspringi_assembly *a) = {
    begin_graph,
    count_graph,
    sum_graph,
    fill_graph,
    check_graph,
    begin_herds,
    explore_trees,
    reserve_herds,
    compare_trees,
    sort_trees,
    count_herds,
    fill_herds,
    count_strands,
    begin_strands,
    find_strands,
    begin_grids,
    find_grids,
    survey_sheets,
    begin_sheets,
    join_sheets,
    count_sheet_springs,
    count_sheet_particles,
    give_up_sheets,
    measure_grids,
    shelve_grids,
    number_grids,
    begin_homes,
    attach_homes,
    prepare_homes,
    find_homes,
    count_web,
    begin_ropes,
    settle_ropes,
    drop_strands,
    begin_web_list,
    list_web,
    set_web_keys,
    sort_web,
    order_web,
    stand_ropes,
    begin_layers,
    find_layers,
    order_web_windows,
    append_herds,
    mspringi_assembly_begin_blocks,
    mspringi_assembly_number_blocks,
    mspringi_assembly_count_loose,
    mspringi_assembly_count_web_blocks,
    mspringi_assembly_number_the_rest,
    mspringi_assembly_reserve_maps,
    mspringi_assembly_assign_slots,
    mspringi_assembly_assign_chain_slots,
    mspringi_assembly_assign_web_slots,
    mspringi_assembly_assign_spare_slots,
    count_empty_slots,
    reserve_empty_slots,
    list_empty_slots,
    mspringi_assembly_begin_places,
    mspringi_assembly_assign_chain_places,
    mspringi_assembly_assign_places,
    mspringi_assembly_reserve_ends,
    mspringi_assembly_note_ends,
    mspringi_assembly_begin_rows,
    mspringi_assembly_append_lattice_rows,
    mspringi_assembly_append_other_rows,
    mspringi_assembly_mark_particles,
    mspringi_assembly_mark_springs,
    mspringi_assembly_trim_spans,
    mspringi_assembly_tighten_spans,
    mspringi_assembly_make_strips,
    begin_web,
    count_degrees,
    count_upright,
    take_upright,
    list_attached,
    reserve_web,
    list_attached,
    attach_to_strips,
    number_nodes,
    count_rungs,
    reserve_rungs,
    lay_rungs,
    fill_web,
};

#define LAYOUT_PASSES (sizeof layout_passes / sizeof layout_passes[0])

mspring_result mspringi_topology_begin(const mspring_builder *builder, const mspringi_reserve *reserve,
                                       bool is_checked, bool has_herds, uint32_t workers, uint32_t lanes,
                                       mspringi_memory *memory, mspringi_message *message,
                                       mspringi_assembly **begun) {
    mspringi_assembly *a = mspringi_alloc(memory, 1, sizeof *a);
    if (!a)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles and %zu springs",
                             builder->particle_count, builder->spring_count);
    a->made = (mspringi_topology){.particle_count = (uint32_t)builder->particle_count,
                                  .spring_count = (uint32_t)builder->spring_count,
                                  .reserve = *reserve};
    a->topology = &a->made;
    a->memory = memory;
    a->message = message;
    a->builder = builder;
    a->is_checked = is_checked;
    a->has_herds = has_herds;
    a->workers = workers;
    a->lanes = lanes;
    *begun = a;
    return MSPRING_OK;
}

// No pass may spend effort on what depends on the number of workers or of lanes, as strips do: when the work is
// done must not.
mspring_result mspringi_topology_go_on(mspringi_assembly *begun, uint32_t *effort, bool *is_done) {
    mspringi_pace *pace = &begun->pace;
    mspring_result result = MSPRING_OK;
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): begun was made, or this is not called
    pace->left = *effort;
    while (result == MSPRING_OK && pace->pass < LAYOUT_PASSES && pace->left > 0) {
        pace->is_halfway = false;
        result = layout_passes[pace->pass](begun);
        if (pace->is_halfway)
            continue;
        pace->pass++;
        pace->at = 0;
    }
    *effort = pace->left;
    *is_done = pace->pass == LAYOUT_PASSES;
    return result;
}

void mspringi_topology_abandon(mspringi_assembly *begun, mspringi_memory *memory) {
    if (!begun)
        return;
    mspringi_topology_destroy(&begun->made, memory);
    mspringi_free(memory, begun->kinds);
    mspringi_free(memory, begun->blocks);
    mspringi_free(memory, begun->first_block);
    mspringi_free(memory, begun->end_block);
    mspringi_free(memory, begun->scratch);
    mspringi_free(memory, begun->busy);
    mspringi_weaving_destroy(&begun->weaving, memory);
    mspringi_graph_destroy(&begun->graph, memory);
    mspringi_herds_destroy(&begun->herds, memory);
    mspringi_strands_destroy(&begun->strands, memory);
    mspringi_grids_destroy(&begun->grids, memory);
    mspringi_sheets_destroy(&begun->sheets, memory);
    mspringi_homes_destroy(&begun->homes, memory);
    mspringi_ropes_destroy(&begun->ropes, memory);
    mspringi_web_list_destroy(&begun->web, memory);
    mspringi_layers_destroy(&begun->layers, memory);
    mspringi_free(memory, begun);
}

void mspringi_topology_finish(mspringi_assembly *begun, mspringi_memory *memory, mspringi_topology *topology) {
    begun->made.lattice_count = begun->grids.found_count;
    begun->made.lattice_particles = begun->grids.member_count;
    begun->made.chain_count = begun->strands.strand_count;
    begun->made.chain_particles = begun->strands.count;
    begun->made.chain_springs = begun->strands.spring_count;
    begun->made.web_particles = begun->web.count;
    // NOLINTNEXTLINE(-Wanalyzer-null-dereference): it was begun
    *topology = begun->made;
    // NOLINTNEXTLINE(-Wanalyzer-null-dereference): as above
    begun->made = (mspringi_topology){0};
    mspringi_topology_abandon(begun, memory);
}

static mspring_result keep_spare(mspringi_topology *t, mspringi_memory *memory, mspringi_message *message) {
    mspring_result result = mspringi_spare_reserve(t, 0, memory, message);
    if (result != MSPRING_OK)
        return result;
    mspringi_pace pace = {0};
    do {
        pace.left = MSPRINGI_PACE_ALL;
        mspringi_spare_enter(t, &pace);
    } while (pace.is_halfway);
    return mspringi_spare_keep(t, memory, message);
}

mspring_result mspringi_topology_create(mspringi_topology *topology, const mspring_builder *builder,
                                        const mspringi_reserve *reserve, uint32_t workers, uint32_t lanes,
                                        mspringi_memory *memory, mspringi_message *message) {
    mspringi_assembly *begun = NULL;
    mspring_result result =
        mspringi_topology_begin(builder, reserve, false, false, workers, lanes, memory, message, &begun);
    for (bool is_done = false; result == MSPRING_OK && !is_done;) {
        uint32_t effort = MSPRINGI_PACE_ALL;
        result = mspringi_topology_go_on(begun, &effort, &is_done);
    }
    if (result != MSPRING_OK) {
        mspringi_topology_abandon(begun, memory);
        return result;
    }
    mspringi_topology_finish(begun, memory, topology);
    result = keep_spare(topology, memory, message);
    if (result != MSPRING_OK)
        mspringi_topology_destroy(topology, memory);
    return result;
}

#define ARRAY(member) MSPRINGI_COLUMN(mspringi_topology, member, MSPRINGI_ARRAY)
static const mspringi_column columns[] = {
    ARRAY(slot_of_particle),
    ARRAY(particle_of_slot),
    ARRAY(place_of_spring),
    ARRAY(up_of_block),
    ARRAY(grid_of_row),
    ARRAY(empty_runs),
    ARRAY(leftover_a),
    ARRAY(leftover_b),
    ARRAY(laid_slots),
    ARRAY(laid_places),
    ARRAY(web.attached_slot),
    ARRAY(web.first_rung),
    ARRAY(web.neighbour),
    ARRAY(web.entry),
    ARRAY(web.is_upright),
    ARRAY(web.is_read),
    ARRAY(spans),
    ARRAY(tight_spans),
    ARRAY(first_tight),
    ARRAY(rows),
    ARRAY(strips),
    ARRAY(layer_blocks),
};
const mspringi_columns mspringi_topology_columns = MSPRINGI_COLUMNS(columns);

void mspringi_topology_destroy(mspringi_topology *topology, mspringi_memory *memory) {
    mspringi_columns_free(mspringi_topology_columns, topology, memory);
    *topology = (mspringi_topology){0};
}
