/// Division of rows into panels.
#include "solvers/implicit/panels.h"

/// Slots that make a panel: few enough for workers to have equal shares of a network that is worth sharing, and
/// enough for a call to cost nothing beside them.
#define PANEL_SLOTS 1000

static bool is_swept(const mspringi_row *row) {
    return row->kind == MSPRINGI_ROW_LATTICE || row->kind == MSPRINGI_ROW_CHAIN;
}

static uint32_t count_slots(const mspringi_topology *t, const mspringi_row *row) {
    uint32_t slots = 0;
    for (uint32_t s = row->first_span; s < row->first_span + row->span_count; ++s)
        slots += t->spans[s].end_slot - t->spans[s].first_slot;
    return slots;
}

// Put together the rows of a panel that begins with row r. Returns the row after its last.
static uint32_t make_panel(const mspringi_topology *t, uint32_t r, mspringi_panel *panel) {
    const mspringi_row *row = &t->rows[r];
    const bool handed_on = r > 0 && t->rows[r - 1].kind == MSPRINGI_ROW_LATTICE;
    *panel = (mspringi_panel){
        .first_span = row->first_span,
        .below_first = handed_on ? t->rows[r - 1].first_span : 0,
        .below_count = handed_on ? t->rows[r - 1].span_count : 0,
        .is_lattice = row->kind == MSPRINGI_ROW_LATTICE,
    };
    uint32_t slots = 0;
    for (; r < t->row_count && t->rows[r].kind == row->kind && slots < PANEL_SLOTS; ++r) {
        slots += count_slots(t, &t->rows[r]);
        panel->span_count += t->rows[r].span_count;
    }
    return r;
}

mspring_result mspringi_panels_create(mspringi_panels *panels, const mspringi_topology *t, mspringi_memory *memory,
                                      mspringi_message *message) {
    *panels = (mspringi_panels){0};
    panels->list = mspringi_alloc(memory, t->row_count, sizeof *panels->list);
    panels->sums = mspringi_alloc(memory, t->row_count, sizeof *panels->sums);
    if (!panels->list || !panels->sums) {
        mspringi_panels_destroy(panels, memory);
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to share %u rows", (unsigned)t->row_count);
    }
    for (uint32_t r = 0; r < t->row_count;) {
        if (is_swept(&t->rows[r]))
            r = make_panel(t, r, &panels->list[panels->count++]);
        else
            ++r;
    }
    return MSPRING_OK;
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_panels, member, MSPRINGI_ARRAY)
static const mspringi_array_entry columns[] = {
    ARRAY(list),
    ARRAY(sums),
};
const mspringi_array_table mspringi_panels_columns = MSPRINGI_ARRAY_TABLE(columns);

void mspringi_panels_destroy(mspringi_panels *panels, mspringi_memory *memory) {
    mspringi_array_table_free(mspringi_panels_columns, panels, memory);
    *panels = (mspringi_panels){0};
}
