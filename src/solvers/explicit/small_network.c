/// Small networks. What passes, shares and strips cost in each substep is up to half of what their springs do; here
/// a substep is a kernel's call or a few. Kernels, their spans and their order within a substep are those of
/// strip.c, and so are the bits.
#include "solvers/explicit/small_network.h"

#include "features/contact/floor.h"
#include "solvers/explicit/explicit.h"
#include "solvers/explicit/strip.h"
#include "store/precise.h"

/// Blocks of slots of a small network: its state and springs stay in the first-level cache, or nearly so. In larger
/// ones a strip's substep costs ten times what it is called by.
#define MOST_BLOCKS 64u

/// Rows of one kind, swept by one call.
typedef struct run {
    mspringi_row_fn sweep;
    const mspringi_span *spans;
    uint32_t span_count;
} run;

/// Most of these: a lattice is one, and its top row another.
#define MOST_RUNS 8u

// An irregular part of its own, or rows with nothing that hangs on them.
static bool has_plain_rows(const mspringi_topology *t) {
    if (t->row_count == 0 || t->rows[t->row_count - 1].kind == MSPRINGI_ROW_LOOSE)
        return false;
    return t->irregular.slice_count == 0 || (t->row_count == 1 && t->bundle_strip == MSPRING_NONE &&
                                             t->tier_count == 0 && t->irregular.attached_count == 0);
}

// A small irregular part is not shared either, but that depends on its substeps.
static bool is_of_one_worker(const mspring_network *network) {
    return !network->tasks || (network->topology.wavefront_strips > 0 && mspringi_explicit_workers(network) == 1);
}

static bool is_straight(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    if (t->block_count > MOST_BLOCKS || !has_plain_rows(t) || network->added_springs.count > 0 ||
        network->sleep.sleeping > 0 || !is_of_one_worker(network))
        return false;
    for (uint32_t s = 0; network->floor && s < t->strip_count; ++s)
        if (mspringi_floor_is_near(network, &t->strips[s]))
            return false;
    return true;
}

// Whether a row has spans of its own without registers that need not be swept.
static bool is_tight(const mspringi_topology *t, const mspringi_row *row) {
    return t->trimmed_spans && row->first_span < t->trimmed_count;
}

static uint32_t list_runs(const mspring_network *network, bool is_forced, run runs[MOST_RUNS]) {
    const mspringi_topology *t = &network->topology;
    const mspringi_row *row = t->rows, *const end = row + t->row_count;
    uint32_t count = 0;
    for (const mspringi_row *next; row < end; row = next, ++count) {
        for (next = row + 1; next < end && next->kind == row->kind && is_tight(t, next) == is_tight(t, row);)
            ++next;
        if (count == MOST_RUNS)
            return 0;
        const mspringi_span *spans = is_tight(t, row) ? t->trimmed_spans : t->spans;
        uint32_t first = row->first_span, last = next[-1].first_span + next[-1].span_count;
        if (is_tight(t, row)) {
            first = t->first_trimmed[first];
            last = t->first_trimmed[last];
        }
        runs[count] = (run){mspringi_row_kernel(network, row->kind, is_forced, false), spans + first, last - first};
    }
    return count;
}

// The irregular part's span without the quarters behind its last particle, which hold nothing.
static mspringi_span trimmed(const mspringi_topology *t, const mspringi_span *irregular) {
    mspringi_span span = *irregular;
    if (!t->irregular.is_interleaved)
        span.end_slot =
            span.first_slot + (t->irregular_particles + MSPRINGI_QUARTER - 1) / MSPRINGI_QUARTER * MSPRINGI_QUARTER;
    MSPRINGI_ASSERT(span.end_slot > span.first_slot && span.end_slot <= irregular->end_slot);
    return span;
}

// The irregular part looks at the state before and after a step; kernels of other rows do so themselves.
static void sweep_irregular(const mspring_network *network, mspringi_substep *substep, const run *irregular,
                            uint32_t count, mspringi_extrema *extrema) {
    const mspringi_span span = trimmed(&network->topology, irregular->spans);
    if (extrema)
        mspringi_span_save_state(network, &span);
    for (uint32_t i = 0; i < count; ++i) {
        mspringi_sweep_set_substep(network, &substep->sweep, i);
        mspringi_irregular_pack(network, substep, &span);
        irregular->sweep(&substep->sweep, &span, 1);
    }
    if (extrema)
        *extrema = mspringi_extrema_join(*extrema, mspringi_span_extrema(network, &span));
}

// Strips tell what they test. Only where none does so are rows swept by runs.
static bool tests(const mspring_network *network, const mspringi_substep *substep) {
    const mspringi_tested *p = &network->tested;
    uint32_t warmth = 0;
    for (uint32_t s = 0; substep->tests && p->maps && s < network->topology.strip_count; ++s)
        warmth |= p->warmth[s];
    return substep->looks || (warmth & MSPRINGI_WARM);
}

static void sweep_once(const mspring_network *network, const mspringi_substep *substep, const run *runs,
                       uint32_t run_count) {
    const mspringi_topology *t = &network->topology;
    const bool by_strips = tests(network, substep);
    for (uint32_t s = 0; by_strips && s < t->strip_count; ++s)
        mspringi_strip_sweep(network, substep, &t->strips[s], NULL);
    for (const run *r = runs; !by_strips && r < runs + run_count; ++r)
        r->sweep(&substep->sweep, r->spans, r->span_count);
}

static void sweep_rows(const mspring_network *network, mspringi_substep *substep, const run *runs,
                       uint32_t run_count, uint32_t count, mspringi_extrema *extrema) {
    const mspringi_topology *t = &network->topology;
    const size_t carry_slots = (size_t)t->carry_blocks * MSPRINGI_WIDTH;
    const uint32_t carries = mspringi_explicit_carry_rows(network);
    mspringi_extrema_buffer room = {{0.0f}};
    mspringi_extrema_lanes *const watch = mspringi_extrema_in_buffer(&room);
    if (extrema)
        mspringi_substep_save_state(network, substep);
    for (uint32_t i = 0, carry = 0; i < count; ++i, carry = carry + 1 < carries ? carry + 1 : 0) {
        substep->sweep.carry_x = network->carry + 2 * carry * carry_slots;
        substep->sweep.carry_y = substep->sweep.carry_x + carry_slots;
        mspringi_sweep_set_substep(network, &substep->sweep, i);
        if (substep->tests) // which substeps are looks
            mspringi_substep_reuse(network, substep, i, count, carry);
        if (extrema && i + 1 == count)
            mspringi_substep_track_extrema(network, substep, watch);
        sweep_once(network, substep, runs, run_count);
        substep->sweep.keep = NULL;
    }
    for (uint32_t s = 0; extrema && s < t->strip_count; ++s)
        (void)mspringi_strip_end(network, &t->strips[s]);
    if (extrema)
        *extrema = mspringi_extrema_join(*extrema, network->kernels->extrema_of(watch));
}

bool mspringi_small_network_step(const mspring_network *network, float h, mspringi_field base, uint32_t count,
                                 mspringi_extrema *extrema) {
    run runs[MOST_RUNS];
    const uint32_t run_count = is_straight(network) ? list_runs(network, base.x != NULL, runs) : 0;
    if (run_count == 0)
        return false;
    mspringi_substep substep = mspringi_substep_prepare(network, h, base, 0, count, 0);
    if (network->topology.irregular.slice_count > 0)
        sweep_irregular(network, &substep, runs, count, extrema);
    else
        sweep_rows(network, &substep, runs, run_count, count, extrema);
    return true;
}
