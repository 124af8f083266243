/// The rows on both sides of a border.
#include "solvers/explicit/halo.h"

#include <string.h>

#include "base/assert.h"
#include "solvers/explicit/partial_sweep.h"
#include "solvers/explicit/partition.h"
#include "store/precise.h"

/// Rows that a halo has: the row below as each of the workers sweeps it, and the velocities that the one below
/// watches changes by; then the rows above, substep by substep.
enum { BELOW_FOR_LOWER = 0, BELOW_FOR_UPPER = 1, BEFORE = 2, ABOVE = 3 };

/* -------------------------------------------------------------------------------------------------- its memory */

static uint32_t most_spans(const mspringi_topology *t) {
    uint32_t most = 0;
    for (uint32_t row = 0; row < t->wavefront_rows; ++row)
        most = t->rows[row].span_count > most ? t->rows[row].span_count : most;
    return most;
}

static mspringi_halos plan_halos(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const uint32_t partition = mspringi_tasks_partition_size(network->tasks);
    mspringi_halos halos = {.segment = ((size_t)t->carry_blocks + 1) * MSPRINGI_WIDTH};
    if (partition == 1)
        return halos;
    halos.substeps = network->depth;
    halos.workers = partition;
    halos.row_spans = most_spans(t);
    const uint32_t most = t->wavefront_strips / mspringi_partition_min_strips(t->skew);
    const uint32_t used = most < partition ? most : partition;
    // Independent shares have one at the lower end, too.
    halos.count = used < 2 ? 0 : mspringi_tasks_are_independent(network->tasks) ? used : used - 1;
    halos.strips = t->wavefront_strips > t->tier_count ? t->wavefront_strips : t->tier_count;
    return halos;
}

mspring_result mspringi_halos_reserve(mspring_network *network) {
    mspringi_halos *halos = &network->halos, planned = plan_halos(network);
    if (planned.workers <= halos->workers && planned.count <= halos->count)
        return MSPRING_OK;
    mspringi_memory *memory = &network->memory;
    planned.values =
        mspringi_alloc(memory, (size_t)planned.count * mspringi_state_arrays(network) * (ABOVE + planned.substeps),
                       planned.segment * sizeof *planned.values);
    planned.spans = mspringi_alloc(memory, (size_t)planned.count * 4 * planned.row_spans, sizeof *planned.spans);
    planned.borders =
        mspringi_alloc(memory, (size_t)planned.workers * MSPRINGI_PLANNED_PASSES, sizeof *planned.borders);
    planned.weights = mspringi_alloc(memory, (size_t)planned.strips + 1, sizeof *planned.weights);
    if (!planned.values || !planned.spans || !planned.borders || !planned.weights) {
        mspringi_halos_free(&planned, memory);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for what %u workers hand on",
                             (unsigned)planned.workers);
    }
    mspringi_halos_free(halos, memory);
    *halos = planned;
    return MSPRING_OK;
}

void mspringi_halos_free(const mspringi_halos *halos, mspringi_memory *memory) {
    mspringi_free(memory, halos->values);
    mspringi_free(memory, halos->spans);
    mspringi_free(memory, halos->borders);
    mspringi_free(memory, halos->weights);
}

/* -------------------------------------------------------------------------------------------------- its rows */

/// Slots of a row in whole blocks, those of its spans lying behind one another.
typedef struct slots {
    size_t first, count;
} slots;

static slots slots_of(const mspring_network *network, const mspringi_row *row) {
    const mspringi_span *first = &network->topology.spans[row->first_span], *last = first + row->span_count - 1;
    const size_t begin = first->first_slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    const size_t end = ((size_t)last->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    return (slots){begin, end - begin};
}

// A row of a halo as a state of its own, from slot 0 on; further rows lie behind it.
static mspringi_state state_of(const mspring_network *network, uint32_t border, uint32_t row) {
    const mspringi_halos *halos = &network->halos;
    const size_t stride = (ABOVE + halos->substeps) * halos->segment;
    float *x = halos->values + mspringi_state_arrays(network) * border * stride + row * halos->segment;
    mspringi_state state = {.x = x,
                            .y = x + stride,
                            .vx = x + 2 * stride,
                            .vy = x + 3 * stride,
                            .low_x = x + 4 * stride,
                            .low_y = x + 5 * stride};
    if (network->is_precise) {
        state.low_vx = x + 6 * stride;
        state.low_vy = x + 7 * stride;
    }
    return state;
}

static void copy_slots(const mspringi_state *from, size_t first, const mspringi_state *to, size_t to_first,
                       size_t count) {
    const size_t size = count * sizeof *to->x;
    memcpy(to->x + to_first, from->x + first, size);
    memcpy(to->y + to_first, from->y + first, size);
    memcpy(to->vx + to_first, from->vx + first, size);
    memcpy(to->vy + to_first, from->vy + first, size);
    memcpy(to->low_x + to_first, from->low_x + first, size);
    memcpy(to->low_y + to_first, from->low_y + first, size);
    if (!from->low_vx)
        return;
    memcpy(to->low_vx + to_first, from->low_vx + first, size);
    memcpy(to->low_vy + to_first, from->low_vy + first, size);
}

/// The row below, copied to one of the halo's rows, and the way from there to the row above.
typedef struct copied {
    slots below;
    mspringi_state state;
    int64_t shift;               ///< of what is above
    mspringi_span *spans, *runs; ///< [row_spans]
} copied;

static copied copy_below(const mspring_network *network, const mspringi_halo *halo, const mspringi_row *below,
                         uint32_t row) {
    const mspringi_halos *halos = &network->halos;
    const slots from = slots_of(network, below), above = slots_of(network, below + 1);
    MSPRINGI_ASSERT(row < ABOVE && halo->substep < halos->substeps && from.count <= halos->segment);
    mspringi_span *spans = halos->spans + ((size_t)2 * halo->border + row) * 2 * halos->row_spans;
    const copied copy = {
        .below = from,
        .state = state_of(network, halo->border, row),
        .shift = (int64_t)((ABOVE + halo->substep - row) * halos->segment + from.first) - (int64_t)above.first,
        .spans = spans,
        .runs = spans + halos->row_spans,
    };
    copy_slots(&network->state, from.first, &copy.state, 0, from.count);
    return copy;
}

static mspringi_span move_span(const copied *copy, const mspringi_span *span) {
    mspringi_span moved = *span;
    moved.first_slot -= (uint32_t)copy->below.first;
    moved.end_slot -= (uint32_t)copy->below.first;
    moved.carry += (int64_t)copy->below.first;
    moved.up += span->up != 0 ? copy->shift : 0;
    return moved;
}

static void sweep_moved(const copied *copy, mspringi_row_fn lattice, const mspringi_sweep *sweep,
                        const mspringi_span *spans, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i)
        copy->spans[i] = move_span(copy, &spans[i]);
    lattice(sweep, copy->spans, count);
}

// Sweep the copy as the row itself would be.
static void sweep_copy(const mspring_network *network, const mspringi_substep *substep, const copied *copy,
                       mspringi_sweep *sweep, const mspringi_row *below, bool is_partly) {
    const mspringi_span *spans = &network->topology.spans[below->first_span];
    const bool forced = substep->base.x != NULL;
    const mspringi_row_fn lattice = mspringi_row_kernel(network, MSPRINGI_ROW_LATTICE, forced, sweep->test != NULL);
    sweep->x = copy->state.x;
    sweep->y = copy->state.y;
    sweep->vx = copy->state.vx;
    sweep->vy = copy->state.vy;
    sweep->low_x = copy->state.low_x;
    sweep->low_y = copy->state.low_y;
    sweep->low_vx = copy->state.low_vx;
    sweep->low_vy = copy->state.low_vy;
    sweep->inverse_mass += copy->below.first;
    if (forced) {
        sweep->force_x += copy->below.first;
        sweep->force_y += copy->below.first;
    }
    sweep->keep = NULL;
    if (!is_partly) {
        sweep_moved(copy, lattice, sweep, spans, below->span_count);
        return;
    }
    mspringi_partial_cursor at = mspringi_partial_begin(spans, below->span_count);
    for (uint32_t count; (count = mspringi_partial_next(network, &at, copy->runs)) > 0;) {
        sweep_moved(copy, lattice, sweep, copy->runs, count);
        for (uint32_t i = 0; i < count; ++i)
            mspringi_partial_clear(network, &substep->sweep, &copy->runs[i]);
    }
}

void mspringi_halo_keep(const mspring_network *network, const mspringi_halo *halo, const mspringi_substep *substep,
                        const mspringi_strip *strip) {
    const mspringi_row *above = &network->topology.rows[strip->first_row], *below = above - 1;
    const mspringi_strip_sleep share = mspringi_sleep_state_of_strip(network, strip - 1);
    if (below->kind != MSPRINGI_ROW_LATTICE || share == MSPRINGI_ASLEEP)
        return;
    const mspringi_state kept = state_of(network, halo->border, ABOVE + halo->substep);
    const slots from = slots_of(network, above);
    copy_slots(&network->state, from.first, &kept, 0, from.count);
    const copied copy = copy_below(network, halo, below, BELOW_FOR_UPPER);
    mspringi_sweep sweep = substep->sweep;
    sweep.watch = NULL;
    sweep_copy(network, substep, &copy, &sweep, below, share == MSPRINGI_PARTLY_ASLEEP);
}

void mspringi_halo_sweep(const mspring_network *network, const mspringi_halo *halo, const mspringi_substep *substep,
                         const mspringi_strip *strip) {
    const mspringi_row *below = &network->topology.rows[strip->first_row + strip->row_count - 1];
    const copied copy = copy_below(network, halo, below, BELOW_FOR_LOWER);
    const mspringi_state *backup = &network->backup;
    mspringi_sweep sweep = substep->sweep;
    if (sweep.keep)
        copy_slots(&copy.state, 0, backup, copy.below.first, copy.below.count);
    if (sweep.before) {
        // Where vy lies as far behind vx as y behind x, as the sweep expects it.
        const mspringi_state before = state_of(network, halo->border, BEFORE);
        memcpy(before.x, backup->vx + copy.below.first, copy.below.count * sizeof *before.x);
        memcpy(before.y, backup->vy + copy.below.first, copy.below.count * sizeof *before.y);
        sweep.before = before.x;
    }
    sweep_copy(network, substep, &copy, &sweep, below,
               mspringi_sleep_state_of_strip(network, strip) == MSPRINGI_PARTLY_ASLEEP);
    copy_slots(&copy.state, 0, &network->state, copy.below.first, copy.below.count);
    // The worker above has what the row hands on.
    const size_t carried = (size_t)network->topology.carry_blocks * MSPRINGI_WIDTH;
    memset(sweep.carry_x, 0, carried * sizeof *sweep.carry_x);
    memset(sweep.carry_y, 0, carried * sizeof *sweep.carry_y);
}
