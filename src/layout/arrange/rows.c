/// Rows of spans, and strips of rows.
#include "layout/emit/layout_builder.h"
#include "layout/emit/spare.h"

/// Blocks in a span of chains.
#define MAX_CHAIN_SPAN 64

// Append a row without spans.
static bool append_row(mspringi_layout_builder *a, mspringi_row_kind kind) {
    mspringi_topology *t = a->topology;
    void *rows = t->rows;
    const bool grown = mspringi_grow(a->memory, &rows, &a->row_capacity, (size_t)t->row_count + 1, sizeof *t->rows);
    t->rows = rows;
    if (grown)
        t->rows[t->row_count++] = (mspringi_row){.kind = kind, .first_span = t->span_count};
    return grown;
}

static bool store_span(mspringi_layout_builder *a, const mspringi_span *span) {
    mspringi_topology *t = a->topology;
    void *spans = t->spans;
    const bool grown = mspringi_grow(a->memory, &spans, &a->span_capacity, (size_t)t->span_count + 1, sizeof *span);
    t->spans = spans;
    if (grown)
        t->spans[t->span_count++] = *span;
    return grown;
}

// Append a span to the last row, or extend the row's last span if they are contiguous.
static bool append_span(mspringi_layout_builder *a, const mspringi_span *span) {
    mspringi_topology *t = a->topology;
    mspringi_row *row = &t->rows[t->row_count - 1];
    if (row->span_count > 0) {
        mspringi_span *last = &t->spans[t->span_count - 1];
        if (last->end_slot == span->first_slot && last->up == span->up && last->carry == span->carry) {
            last->end_slot = span->end_slot;
            return true;
        }
    }
    row->span_count++;
    return store_span(a, span);
}

// A span of whole blocks.
static mspringi_span span_of_blocks(uint32_t first_block, uint32_t block_count, uint32_t first_record,
                                    uint32_t record_slots) {
    return (mspringi_span){.first_slot = first_block * MSPRINGI_WIDTH,
                           .end_slot = (first_block + block_count) * MSPRINGI_WIDTH,
                           .first_record = first_record,
                           .record_slots = record_slots};
}

// Offset from the slots of one block to those of another.
static int64_t offset_between(uint32_t from_block, uint32_t to_block) {
    return ((int64_t)to_block - (int64_t)from_block) * MSPRINGI_WIDTH;
}

// End of the span of bundles that begins with this slice. Bundles are never split.
static uint32_t end_of_bundles(const mspringi_layout_builder *a, uint32_t first) {
    uint32_t end = first + 1;
    while (end < a->bundles.slice_count && (end - first < MSPRINGI_BUNDLE_SPAN || !a->bundles.is_first[end]))
        ++end;
    return end;
}

static uint32_t widest_row(const mspringi_layout_builder *a) {
    uint32_t widest = a->topology->chain_blocks < MAX_CHAIN_SPAN ? a->topology->chain_blocks : MAX_CHAIN_SPAN;
    for (uint32_t first = 0, end, slice_columns = 0; first < a->bundles.slice_count;
         first = end, slice_columns = 0) {
        end = end_of_bundles(a, first);
        for (uint32_t slice = first; slice < end; ++slice)
            slice_columns += mspringi_degree_of(&a->graph, a->bundles.particles[slice * MSPRINGI_WIDTH]);
        widest = slice_columns > widest ? slice_columns : widest;
    }
    for (size_t i = 0; i < a->block_count; ++i)
        widest = mspringi_column_block_of_key(a->blocks[i]) + 1 > widest
                     ? mspringi_column_block_of_key(a->blocks[i]) + 1
                     : widest;
    return widest;
}

// Append a grid's block to its row. The first block of a row starts it.
static bool append_lattice_block(mspringi_layout_builder *a, uint32_t i, uint32_t grid, uint32_t number) {
    mspringi_topology *t = a->topology;
    const uint32_t row = mspringi_row_of_key(a->blocks[i]),
                   column_block = mspringi_column_block_of_key(a->blocks[i]);
    const bool starts_row = a->begin_of_row[a->assignment.first_row[grid] + row] == i;
    const uint32_t up = mspringi_layout_builder_find_block(a, grid, row + 1, column_block);
    const uint32_t block = t->lattice_first + i, up_block = up == MSPRING_NONE ? block : t->lattice_first + up;
    mspringi_span span = span_of_blocks(block, 1, i, MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH);
    span.up = offset_between(block, up_block);
    span.carry = offset_between(block, column_block);
    t->up_of_block[i] = up_block;
    if (starts_row) {
        if (!append_row(a, MSPRINGI_ROW_CHAIN))
            return false;
        t->grid_of_row[t->lattice_rows++] = number;
    }
    if (up != MSPRING_NONE)
        t->rows[t->row_count - 1].kind = MSPRINGI_ROW_LATTICE;
    return append_span(a, &span);
}

mspring_result mspringi_layout_builder_append_lattice_rows(mspringi_layout_builder *a) {
    for (uint32_t i = 0, grid = 0; i < a->topology->lattice_blocks; ++i) {
        while (i >= a->end_block[a->assignment.grid_order[grid]])
            grid++;
        if (!append_lattice_block(a, i, a->assignment.grid_order[grid], grid))
            return mspringi_layout_builder_fail(a);
    }
    return MSPRING_OK;
}

// Append the chain row. Its spans are no longer than the carry row, which is empty for them.
static bool append_chain_row(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    bool ok = t->chain_blocks == 0 || append_row(a, MSPRINGI_ROW_CHAIN);
    for (uint32_t i = 0; ok && i < t->chain_blocks; i += MAX_CHAIN_SPAN) {
        const uint32_t left = t->chain_blocks - i, block = t->chain_first + i;
        mspringi_span span =
            span_of_blocks(block, left < MAX_CHAIN_SPAN ? left : MAX_CHAIN_SPAN, i, MSPRINGI_WIDTH);
        span.carry = offset_between(block, 0);
        if (left <= MAX_CHAIN_SPAN) // slots behind the last particle are empty
            span.end_slot = t->chain_first * MSPRINGI_WIDTH +
                            (a->chains.count + MSPRINGI_QUARTER - 1) / MSPRINGI_QUARTER * MSPRINGI_QUARTER;
        ok = append_span(a, &span);
    }
    return ok;
}

// Append a row of one span.
static bool append_simple_row(mspringi_layout_builder *a, mspringi_row_kind kind, uint32_t first_block,
                              uint32_t block_count, uint32_t first_record) {
    const mspringi_span span = span_of_blocks(first_block, block_count, first_record, MSPRINGI_WIDTH);
    return append_row(a, kind) && append_span(a, &span);
}

// Append the bundles, several to a span.
static bool append_bundle_row(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    const uint32_t slices = a->bundles.slice_count;
    if (slices == 0)
        return true;
    a->bundle_row = t->row_count;
    bool ok = append_row(a, MSPRINGI_ROW_IRREGULAR);
    t->bundle_springs = a->bundles.spring_count * MSPRINGI_WIDTH;
    for (uint32_t first = 0, end; ok && first < slices; first = end) {
        end = end_of_bundles(a, first);
        const mspringi_span span = span_of_blocks(t->irregular_first + a->unbundled_blocks + first, end - first,
                                                  a->unbundled_blocks + first, MSPRINGI_WIDTH);
        t->rows[a->bundle_row].span_count++;
        ok = store_span(a, &span);
    }
    return ok;
}

// Append the span of a strip's assigned particles; the last of them is in last_slot.
static bool append_assigned_span(mspringi_layout_builder *a, uint32_t strip, uint32_t last_slot) {
    mspringi_topology *t = a->topology;
    const uint32_t first_block = t->irregular_first + a->placed_blocks, end_block = last_slot / MSPRINGI_WIDTH + 1;
    mspringi_span span = span_of_blocks(first_block, end_block - first_block, a->placed_blocks, MSPRINGI_WIDTH);
    span.end_slot = (last_slot / MSPRINGI_QUARTER + 1) * MSPRINGI_QUARTER;
    a->placed_blocks += end_block - first_block;
    t->strips[strip].assigned_span = t->span_count;
    return store_span(a, &span);
}

static bool append_assigned_spans(mspringi_layout_builder *a) {
    const mspringi_topology *t = a->topology;
    const uint32_t *particles = a->irregular.particles, *assigned_strip = a->assignment.assigned_strip;
    for (uint32_t i = 0; i < a->irregular.assigned_count; ++i) {
        const bool is_last =
            i + 1 == a->irregular.count || assigned_strip[particles[i + 1]] != assigned_strip[particles[i]];
        if (is_last && !append_assigned_span(a, assigned_strip[particles[i]], t->slot_of_particle[particles[i]]))
            return false;
    }
    return true;
}

// List the tiers. The last particle of each gives the begin of the next.
static bool list_tiers(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    if (a->tiers.count == 0)
        return true;
    const uint32_t *particles = a->irregular.particles + a->irregular.assigned_count;
    t->tier_blocks = mspringi_alloc(a->memory, (size_t)a->tiers.count + 1, sizeof *t->tier_blocks);
    if (!t->tier_blocks)
        return false;
    t->tier_blocks[0] = 0;
    for (uint32_t i = 0; i < a->tiers.count; ++i)
        t->tier_blocks[i + 1] = t->slot_of_particle[particles[a->tiers.end[i] - 1]] / MSPRINGI_WIDTH + 1 -
                                t->irregular_first - a->assigned_blocks;
    t->tier_count = a->tiers.count;
    return true;
}

// Divide rows into strips: those of the wavefront by assigned strips, every other row on its own.
mspring_result mspringi_layout_builder_make_strips(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    const uint32_t rows = a->assignment.strip_rows;
    t->skew = a->assignment.skew;
    t->wavefront_rows = a->assignment.row_count;
    t->wavefront_strips = (t->wavefront_rows + rows - 1) / rows;
    t->strip_count = t->wavefront_strips + (t->row_count - t->wavefront_rows);
    t->bundle_strip =
        a->bundles.slice_count > 0 ? t->wavefront_strips + (a->bundle_row - t->wavefront_rows) : MSPRING_NONE;
    t->strips = mspringi_alloc(a->memory, t->strip_count, sizeof *t->strips);
    if (!t->strips)
        return mspringi_layout_builder_fail(a);
    for (uint32_t s = 0, row = 0; s < t->strip_count; ++s) {
        const uint32_t left = t->wavefront_rows - row, count = s >= t->wavefront_strips ? 1
                                                               : left < rows            ? left
                                                                                        : rows;
        t->strips[s] = (mspringi_strip){.first_row = row, .row_count = count, .assigned_span = MSPRING_NONE};
        row += count;
    }
    return append_assigned_spans(a) && list_tiers(a) ? MSPRING_OK : mspringi_layout_builder_fail(a);
}

uint32_t *mspringi_layout_builder_list_strips_of_blocks(const mspringi_layout_builder *a) {
    const mspringi_topology *t = a->topology;
    uint32_t *strip_of_block = mspringi_alloc(a->memory, t->block_count, sizeof *strip_of_block);
    for (uint32_t s = 0; strip_of_block && s < t->strip_count; ++s) {
        const mspringi_row *first = &t->rows[t->strips[s].first_row], *last = first + t->strips[s].row_count - 1;
        for (uint32_t i = first->first_span; i < last->first_span + last->span_count; ++i)
            for (uint32_t slot = t->spans[i].first_slot; slot < t->spans[i].end_slot; slot += MSPRINGI_QUARTER)
                strip_of_block[slot / MSPRINGI_WIDTH] = s;
        if (t->strips[s].assigned_span == MSPRING_NONE)
            continue;
        const mspringi_span *assigned = &t->spans[t->strips[s].assigned_span];
        for (uint32_t slot = assigned->first_slot; slot < assigned->end_slot; slot += MSPRINGI_WIDTH)
            strip_of_block[slot / MSPRINGI_WIDTH] = s;
    }
    return strip_of_block;
}

static bool is_busy(const uint8_t *busy, uint32_t slot) {
    return busy[slot / MSPRINGI_WIDTH] >> slot % MSPRINGI_WIDTH / MSPRINGI_QUARTER & 1;
}

void mspringi_layout_builder_trim_spans(mspringi_layout_builder *a) {
    const mspringi_topology *t = a->topology;
    const uint32_t lattice_end = t->chain_first * MSPRINGI_WIDTH;
    for (uint32_t s = 0; s < t->span_count && t->spans[s].first_slot < lattice_end; ++s) {
        mspringi_span *span = &t->spans[s];
        // Only within the first and last block. One quarter of an idle block stays: the block exists for the slot
        // to its right.
        while (span->first_slot % MSPRINGI_WIDTH < MSPRINGI_WIDTH - MSPRINGI_QUARTER &&
               !is_busy(a->busy, span->first_slot))
            span->first_slot += MSPRINGI_QUARTER;
        while (span->end_slot - MSPRINGI_QUARTER > span->first_slot &&
               (span->end_slot - 1) % MSPRINGI_WIDTH >= MSPRINGI_QUARTER && !is_busy(a->busy, span->end_slot - 1))
            span->end_slot -= MSPRINGI_QUARTER;
    }
}

// True if a register at this slot has a quarter that must be swept.
static bool is_any_busy(const mspringi_layout_builder *a, uint32_t slot) {
    for (uint32_t end = slot + a->lanes; slot < end; slot += MSPRINGI_QUARTER)
        if (is_busy(a->busy, slot))
            return true;
    return false;
}

// Cut a span into runs of registers that must be swept. Return their number; cut NULL: only count them.
static uint32_t cut_span(const mspringi_layout_builder *a, const mspringi_span *span, mspringi_span *cut) {
    uint32_t count = 0;
    bool in_run = false;
    for (uint32_t slot = span->first_slot / a->lanes * a->lanes; slot < span->end_slot; slot += a->lanes) {
        const bool is_swept = is_any_busy(a, slot);
        if (is_swept && cut) {
            const uint32_t first = slot > span->first_slot ? slot : span->first_slot;
            const uint32_t end = slot + a->lanes < span->end_slot ? slot + a->lanes : span->end_slot;
            if (!in_run) {
                cut[count] = *span;
                cut[count].first_slot = first;
                cut[count].first_record += first / MSPRINGI_WIDTH - span->first_slot / MSPRINGI_WIDTH;
            }
            cut[in_run ? count - 1 : count].end_slot = end;
        }
        count += is_swept && !in_run;
        in_run = is_swept;
    }
    return count;
}

// Omit idle registers within spans, too, between both sides of a hole. They need lists of their own: all other code
// expects spans without common blocks. (Idle registers of our ship: 848 of 13,105 with four lanes, 110 of 6,926
// with eight, one of 3,683 with sixteen; the cost of a span is negligible.)
mspring_result mspringi_layout_builder_list_trimmed_spans(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    const uint32_t lattice_end = t->chain_first * MSPRINGI_WIDTH;
    uint32_t spans = 0, count = 0;
    for (; spans < t->span_count && t->spans[spans].first_slot < lattice_end; ++spans)
        count += cut_span(a, &t->spans[spans], NULL);
    if (a->lanes < MSPRINGI_WIDTH && count > spans) {
        t->trimmed_count = spans;
        t->trimmed_spans = mspringi_alloc(a->memory, count, sizeof *t->trimmed_spans);
        t->first_trimmed = mspringi_alloc(a->memory, (size_t)spans + 1, sizeof *t->first_trimmed);
        if (!t->trimmed_spans || !t->first_trimmed)
            return mspringi_layout_builder_fail(a);
        for (uint32_t s = 0; s < spans; ++s)
            t->first_trimmed[s + 1] =
                t->first_trimmed[s] + cut_span(a, &t->spans[s], &t->trimmed_spans[t->first_trimmed[s]]);
    }
    mspringi_free(a->memory, a->busy);
    a->busy = NULL;
    return MSPRING_OK;
}

mspring_result mspringi_layout_builder_begin_rows(mspringi_layout_builder *a) {
    mspringi_topology *t = a->topology;
    t->carry_blocks = widest_row(a);
    t->up_of_block = mspringi_alloc(a->memory, t->lattice_blocks, sizeof *t->up_of_block);
    t->grid_of_row = mspringi_alloc(a->memory, t->lattice_blocks,
                                    sizeof *t->grid_of_row); // no more rows than blocks
    return t->up_of_block && t->grid_of_row ? MSPRING_OK : mspringi_layout_builder_fail(a);
}

mspring_result mspringi_layout_builder_append_other_rows(mspringi_layout_builder *a) {
    const mspringi_topology *t = a->topology;
    const uint32_t irregular_blocks = t->irregular_blocks - a->bundles.slice_count - a->assigned_blocks;
    const bool has_loose_row = t->loose_blocks + t->spare_blocks > 0;
    if (!append_chain_row(a) ||
        (irregular_blocks > 0 &&
         !append_simple_row(a, MSPRINGI_ROW_IRREGULAR, t->irregular_first + a->assigned_blocks, irregular_blocks,
                            a->assigned_blocks)) ||
        !append_bundle_row(a) ||
        (has_loose_row && !append_simple_row(a, MSPRINGI_ROW_LOOSE, t->loose_first, t->loose_blocks, 0)))
        return mspringi_layout_builder_fail(a);
    return MSPRING_OK;
}
