/// A topology as a list of plain functions, from the builder to the web.
#include "layout/topology.h"

#include <string.h>

#include "layout/emit/assembly.h"
#include "layout/emit/spare.h"

mspring_result mspringi_assembly_fail(mspringi_assembly *a) {
    return mspringi_fail(a->message, MSPRING_ERROR_MEMORY, "no memory to lay out %zu particles and %zu springs",
                         a->builder->particle_count, a->builder->spring_count);
}

/* ---------------------------------------------------------------------------------------------------- the web */

// The attached nodes are in slot order, and each strip's begin a group.
static void attach_to_strips(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    for (uint32_t i = 0; i < t->web.attached_count; ++i) {
        if (t->web.attached_slot[i] == MSPRING_NONE)
            continue;
        const uint32_t number = a->weaving.strip_of_block[t->web.attached_slot[i] / MSPRINGI_WIDTH];
        mspringi_strip *strip = &t->strips[number];
        // Such a strip is swept with the web, one substep after the other.
        if (number >= t->wavefront_strips)
            t->layer_count = 0;
        if (strip->attached_count++ == 0)
            strip->first_attached = i;
    }
}

static mspring_result begin_web(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    a->weaving = (mspringi_weaving){.web = &t->web,
                                    .a = t->leftover_a,
                                    .b = t->leftover_b,
                                    .count = t->leftover_count,
                                    .first_slot = t->web_first * MSPRINGI_WIDTH,
                                    .own_count = t->web_blocks * MSPRINGI_WIDTH,
                                    .homed_count = a->homed_blocks * MSPRINGI_WIDTH,
                                    .has_seconds = t->second_count > 0,
                                    .block_count = t->block_count,
                                    .herd_groups = a->herds.group_count,
                                    .herd_springs = a->herds.spring_count,
                                    .strip_of_block = mspringi_assembly_list_strips_of_blocks(a)};
    if (!a->weaving.strip_of_block)
        return mspringi_assembly_fail(a);
    mspring_result result = mspringi_web_begin(&a->weaving, a->memory, a->message);
    if (result == MSPRING_OK)
        attach_to_strips(a);
    return result;
}

static mspring_result lay_rungs(mspringi_assembly *a) {
    return mspringi_web_lay_rungs(&a->weaving, a->memory, a->message);
}

static mspring_result fill_web(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_web_fill(&a->weaving, first, end);
    return MSPRING_OK;
}

static mspring_result link_herds(mspringi_assembly *a) {
    mspringi_web_link(&a->weaving);
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------- the slots */

// List the slots without particle, the padding in front and behind among them; runs NULL: count them only.
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

static mspring_result assign_slots(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_assembly_assign_slots(a, first, end);
    return MSPRING_OK;
}

static mspring_result assign_other_slots(mspringi_assembly *a) {
    mspringi_topology *t = a->topology;
    mspringi_assembly_assign_other_slots(a);
    t->empty_run_count = find_empty_slots(t, NULL);
    t->empty_runs = mspringi_alloc(a->memory, t->empty_run_count, sizeof *t->empty_runs);
    if (!t->empty_runs)
        return mspringi_assembly_fail(a);
    (void)find_empty_slots(t, t->empty_runs);
    return MSPRING_OK;
}

static mspring_result assign_places(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_assembly_assign_places(a, first, end);
    return MSPRING_OK;
}

static mspring_result trim_spans(mspringi_assembly *a) {
    mspringi_assembly_mark_busy(a);
    mspringi_assembly_trim_spans(a);
    return mspringi_assembly_tighten_spans(a);
}

/* ------------------------------------------------------------------------------- what there is to be laid out */

static mspring_result make_graph(mspringi_assembly *a) {
    const size_t particles = a->builder->particle_count;
    a->kinds = mspringi_alloc(a->memory, particles, sizeof *a->kinds);
    if (!a->kinds)
        return mspringi_assembly_fail(a);
    memset(a->kinds, MSPRINGI_ROW_LOOSE, particles);
    const mspring_result result =
        mspringi_graph_create(&a->graph, a->builder, a->is_checked, a->memory, a->message);
    a->topology->second_count = a->graph.second_count;
    if (a->graph.second_count > 0)
        a->has_herds = false;
    return result;
}

static mspring_result begin_copies(mspringi_assembly *a) {
    return !a->has_herds ? MSPRING_OK : mspringi_copies_begin(&a->copies, &a->graph, a->memory, a->message);
}

static mspring_result explore_copies(mspringi_assembly *a, uint32_t first, uint32_t end) {
    if (a->copies.number)
        mspringi_copies_explore(&a->copies, &a->graph, a->kinds, first, end);
    return MSPRING_OK;
}

static mspring_result reserve_copies(mspringi_assembly *a) {
    return mspringi_copies_reserve(&a->copies, a->memory, a->message);
}

static mspring_result list_copies(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_copies_list(&a->copies, &a->graph, first, end);
    return MSPRING_OK;
}

static mspring_result find_strands(mspringi_assembly *a) {
    return mspringi_strands_find(&a->strands, &a->graph, a->kinds, a->memory, a->message);
}

static mspring_result begin_grids(mspringi_assembly *a) {
    return mspringi_grids_begin(&a->grids, &a->graph, a->kinds, a->memory, a->message);
}

static mspring_result flood_grids(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_grids_flood(&a->grids, first, end);
    return MSPRING_OK;
}

static mspring_result begin_judging(mspringi_assembly *a) {
    return mspringi_grids_begin_judging(&a->grids, a->memory, a->message);
}

static mspring_result count_grid_springs(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_grids_count_springs(&a->grids, first, end);
    return MSPRING_OK;
}

static mspring_result judge_grids(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_grids_judge(&a->grids, first, end);
    return MSPRING_OK;
}

static mspring_result end_search(mspringi_assembly *a) {
    mspringi_grids_end_search(&a->grids, a->memory);
    return MSPRING_OK;
}

static mspring_result survey_sheets(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_sheets_survey(&a->sheets, &a->graph, &a->grids, a->kinds, first, end);
    return MSPRING_OK;
}

static mspring_result begin_sheets(mspringi_assembly *a) {
    return mspringi_sheets_reserve(&a->sheets, &a->graph, &a->grids, a->memory, a->message);
}

static mspring_result join_sheets(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_sheets_join(&a->sheets, &a->graph, first, end);
    return MSPRING_OK;
}

static mspring_result count_sheet_springs(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_sheets_count_springs(&a->sheets, &a->graph, &a->grids, a->kinds, first, end);
    return MSPRING_OK;
}

static mspring_result give_up_sheets(mspringi_assembly *a) {
    mspringi_sheets_give_up(&a->sheets, &a->graph, &a->grids, a->kinds, a->memory);
    return mspringi_grids_measure(&a->grids, a->memory, a->message);
}

static mspring_result shelve_grids(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_grids_shelve(&a->grids, first, end);
    return MSPRING_OK;
}

static mspring_result begin_homes(mspringi_assembly *a) {
    mspringi_grids_number(&a->grids, a->memory);
    return mspringi_homes_begin(&a->homes, &a->graph, &a->grids, &a->strands, a->memory, a->message);
}

static mspring_result attach_homes(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_homes_attach(&a->homes, first, end);
    return MSPRING_OK;
}

static mspring_result prepare_homes(mspringi_assembly *a) {
    return mspringi_homes_prepare(&a->homes, a->workers, a->memory, a->message);
}

static mspring_result join_homes(mspringi_assembly *a, uint32_t first, uint32_t end) {
    mspringi_homes_join_springs(&a->homes, first, end);
    return MSPRING_OK;
}

static mspring_result judge_homes(mspringi_assembly *a) {
    mspringi_homes_judge(&a->homes);
    return MSPRING_OK;
}

static mspring_result try_skews(mspringi_assembly *a) {
    a->cursor.again = !mspringi_homes_try_skews(&a->homes);
    return MSPRING_OK;
}

static mspring_result settle_ropes(mspringi_assembly *a) {
    mspringi_homes_end(&a->homes, a->memory);
    mspringi_web_list_count(&a->web, &a->graph, &a->homes, a->kinds);
    mspring_result result =
        mspringi_ropes_settle(&a->ropes, &a->graph, &a->grids, &a->strands, &a->homes, a->memory, a->message);
    if (result == MSPRING_OK)
        mspringi_strands_drop(&a->strands, &a->graph, &a->homes, a->herds.group_count > 0, a->kinds, &a->web);
    return result;
}

static mspring_result list_web(mspringi_assembly *a) {
    mspring_result result = mspringi_web_list_reserve(&a->web, &a->herds, a->memory, a->message);
    if (result == MSPRING_OK)
        mspringi_web_list_fill(&a->web, &a->graph, &a->homes, a->kinds);
    return result;
}

static mspring_result sort_web(mspringi_assembly *a) {
    mspringi_web_list_sort(&a->web, &a->graph, &a->homes);
    mspringi_ropes_stand(&a->ropes, &a->web);
    return MSPRING_OK;
}

static mspring_result find_layers(mspringi_assembly *a) {
    return mspringi_layers_find(&a->layers, &a->web, &a->graph, a->memory, a->message);
}

static mspring_result order_web(mspringi_assembly *a) {
    mspringi_web_list_order_windows(&a->web, &a->layers, &a->graph, a->memory);
    mspringi_web_list_append_herds(&a->web, &a->herds);
    return MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------------- the list */

static uint32_t particles_of(const mspringi_assembly *a) {
    return (uint32_t)a->builder->particle_count;
}

static uint32_t springs_of(const mspringi_assembly *a) {
    return (uint32_t)a->builder->spring_count;
}

static uint32_t flood_steps_of(const mspringi_assembly *a) {
    return 2 * particles_of(a);
}

static uint32_t candidates_of(const mspringi_assembly *a) {
    return mspringi_grids_candidates(&a->grids);
}

static uint32_t candidate_members_of(const mspringi_assembly *a) {
    return mspringi_grids_candidate_members(&a->grids);
}

static uint32_t narrow_grids_of(const mspringi_assembly *a) {
    return mspringi_grids_narrow(&a->grids);
}

static uint32_t members_of(const mspringi_assembly *a) {
    return a->grids.member_count;
}

static uint32_t web_springs_of(const mspringi_assembly *a) {
    return a->weaving.count;
}

MSPRINGI_PASSES(layout, mspringi_assembly)
#define SEARCH                                                                                                     \
    MSPRINGI_EACH(flood_grids, flood_steps_of, 4000), MSPRINGI_ONCE(begin_judging),                                \
        MSPRINGI_EACH(count_grid_springs, candidate_members_of, 8000),                                             \
        MSPRINGI_EACH(judge_grids, candidates_of, 64), MSPRINGI_ONCE(end_search)

static const layout_pass layout_passes[] = {
    MSPRINGI_ONCE(make_graph),
    MSPRINGI_ONCE(begin_copies),
    MSPRINGI_EACH(explore_copies, particles_of, 16000),
    MSPRINGI_ONCE(reserve_copies),
    MSPRINGI_EACH(list_copies, particles_of, 8000),
    MSPRINGI_ONCE(mspringi_copies_choose),
    MSPRINGI_ONCE(mspringi_copies_fill),
    MSPRINGI_ONCE(find_strands),
    MSPRINGI_ONCE(begin_grids),
    SEARCH,
    SEARCH,
    SEARCH,
    MSPRINGI_EACH(survey_sheets, springs_of, 32000),
    MSPRINGI_ONCE(begin_sheets),
    MSPRINGI_EACH(join_sheets, springs_of, 32000),
    MSPRINGI_EACH(count_sheet_springs, springs_of, 16000),
    MSPRINGI_ONCE(give_up_sheets),
    MSPRINGI_ONCE(mspringi_copies_release),
    MSPRINGI_EACH(shelve_grids, narrow_grids_of, 64),
    MSPRINGI_ONCE(begin_homes),
    MSPRINGI_EACH(attach_homes, members_of, 8000),
    MSPRINGI_ONCE(prepare_homes),
    MSPRINGI_EACH(join_homes, springs_of, 32000),
    MSPRINGI_ONCE(judge_homes),
    MSPRINGI_ONCE(try_skews),
    MSPRINGI_ONCE(settle_ropes),
    MSPRINGI_ONCE(list_web),
    MSPRINGI_ONCE(sort_web),
    MSPRINGI_ONCE(find_layers),
    MSPRINGI_ONCE(order_web),
    MSPRINGI_ONCE(mspringi_assembly_begin_blocks),
    MSPRINGI_EACH(mspringi_assembly_number_blocks, members_of, 8000),
    MSPRINGI_ONCE(mspringi_assembly_number_the_rest),
    MSPRINGI_ONCE(mspringi_assembly_reserve_maps),
    MSPRINGI_EACH(assign_slots, particles_of, 16000),
    MSPRINGI_ONCE(assign_other_slots),
    MSPRINGI_ONCE(mspringi_assembly_begin_places),
    MSPRINGI_EACH(assign_places, springs_of, 16000),
    MSPRINGI_ONCE(mspringi_assembly_note_ends),
    MSPRINGI_ONCE(mspringi_assembly_begin_rows),
    MSPRINGI_ONCE(mspringi_assembly_append_lattice_rows),
    MSPRINGI_ONCE(mspringi_assembly_append_other_rows),
    MSPRINGI_ONCE(trim_spans),
    MSPRINGI_ONCE(mspringi_assembly_make_strips),
    MSPRINGI_ONCE(begin_web),
    MSPRINGI_ONCE(lay_rungs),
    MSPRINGI_EACH(fill_web, web_springs_of, 16000),
    MSPRINGI_ONCE(link_herds),
};

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

mspring_result mspringi_topology_run(mspringi_assembly *a, bool *is_done) {
    const mspring_result result = layout_run(a, layout_passes, &a->cursor);
    *is_done = a->cursor.pass == MSPRINGI_PASS_COUNT(layout_passes);
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
    mspringi_free(memory, begun->busy);
    mspringi_weaving_destroy(&begun->weaving, memory);
    mspringi_graph_destroy(&begun->graph, memory);
    mspringi_free(memory, begun->herds.particles);
    mspringi_free(memory, begun->herds.is_first);
    mspringi_copies_destroy(&begun->copies, memory);
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
    begun->made.irregular_particles = begun->web.count;
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
    mspringi_spare_enter(t);
    return mspringi_spare_keep(t, memory, message);
}

mspring_result mspringi_topology_create(mspringi_topology *topology, const mspring_builder *builder,
                                        const mspringi_reserve *reserve, bool has_herds, uint32_t workers,
                                        uint32_t lanes, mspringi_memory *memory, mspringi_message *message) {
    mspringi_assembly *begun = NULL;
    mspring_result result =
        mspringi_topology_begin(builder, reserve, false, has_herds, workers, lanes, memory, message, &begun);
    for (bool is_done = false; result == MSPRING_OK && !is_done;)
        result = mspringi_topology_run(begun, &is_done);
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
    ARRAY(web.first_link),
    ARRAY(web.links),
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
