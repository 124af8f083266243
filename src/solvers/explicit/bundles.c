/// Sweeping equal components that stand in bundles.
#include "solvers/explicit/bundles.h"

#include <string.h>

#include "features/contact/floor.h"
#include "solvers/explicit/explicit.h"
#include "solvers/explicit/strip.h"
#include "store/precise.h"
#include "store/sleepers.h"

/// Substeps times springs from which more than one worker is worth it.
#define SMALLEST_SHARED_WORK 400000u

/// Data that the workers of a sweep share.
typedef struct job {
    const mspring_network *network;
    mspringi_field base;
    float h;
    uint32_t count, workers;
    mspringi_extrema *all_extrema;
} job;

static const mspringi_row *row_of_bundles(const mspringi_topology *topology) {
    return &topology->rows[topology->strips[topology->bundle_strip].first_row];
}

bool mspringi_bundles_are_apart(const mspring_network *network) {
    return network->topology.bundle_strip != MSPRING_NONE && network->added_springs.count == 0;
}

/* -------------------------------------------------------------------------------------------- bundles of a span */

// True if a slice is the first of a bundle: all of its columns lead down.
static bool begins_bundle(const mspringi_sell *irregular, uint32_t group) {
    const uint32_t *first_link = irregular->first_link + (group - irregular->first_bundle);
    return first_link[1] - first_link[0] ==
           irregular->first_slice_column[group + 1] - irregular->first_slice_column[group];
}

static uint32_t blocks_of(const mspringi_span *span) {
    return (span->end_slot - span->first_slot) / MSPRINGI_WIDTH;
}

// Some of a span's blocks.
static mspringi_span part_of(const mspringi_span *span, uint32_t first, uint32_t end) {
    mspringi_span part = *span;
    part.first_slot += first * MSPRINGI_WIDTH;
    part.end_slot = span->first_slot + end * MSPRINGI_WIDTH;
    part.first_record += first;
    return part;
}

// The next run of whole bundles of which something is swept, from a span's block *at on, which goes behind it. What
// else of these sleeps, beyond a pin, is swept with them, which does nothing to it.
static bool next_run(const mspring_network *network, const mspringi_span *span, uint32_t *at, mspringi_span *run) {
    const mspringi_sell *irregular = &network->topology.irregular;
    const uint32_t first_block = span->first_slot / MSPRINGI_WIDTH, end = blocks_of(span);
    uint32_t first = *at, behind = *at;
    for (bool is_swept = true; *at < end; *at = behind) {
        do
            ++behind;
        while (behind < end && !begins_bundle(irregular, span->first_record + behind));
        is_swept = mspringi_is_any_swept(network, first_block + *at, first_block + behind);
        if (!is_swept && first < *at)
            break;
        first = is_swept ? first : behind;
    }
    *run = part_of(span, first, *at);
    return first < *at;
}

/* -------------------------------------------------------------------------------------------------- the sweeps */

static void sweep_run(const job *bundles, const mspringi_sweep *sweep, const mspringi_span *run) {
    const mspring_network *network = bundles->network;
    const mspringi_strip *strip = &network->topology.strips[network->topology.bundle_strip];
    const mspringi_row_fn sweep_bundle = mspringi_bundle_kernel(network, bundles->base.x != NULL);
    mspringi_sweep substep = *sweep;
    for (uint32_t i = 0; i < bundles->count; ++i) {
        mspringi_floor_save_velocities(network, strip, run, 1);
        mspringi_sweep_set_substep(network, &substep, i);
        sweep_bundle(&substep, run, 1);
        mspringi_floor_apply(network, strip, run, 1, &substep);
    }
}

static void sweep_span(const job *bundles, const mspringi_sweep *sweep, const mspringi_span *span,
                       uint32_t worker) {
    const mspring_network *network = bundles->network;
    mspringi_span run;
    if (bundles->all_extrema)
        mspringi_span_save_state(network, span);
    for (uint32_t at = 0; next_run(network, span, &at, &run);)
        sweep_run(bundles, sweep, &run);
    if (bundles->all_extrema)
        bundles->all_extrema[worker] =
            mspringi_extrema_join(bundles->all_extrema[worker], mspringi_span_extrema(network, span));
}

static void sweep_share(void *argument, uint32_t index, uint32_t worker) {
    const job *bundles = argument;
    const mspring_network *network = bundles->network;
    const mspringi_topology *t = &network->topology;
    const mspringi_row *row = row_of_bundles(t);
    const mspringi_span *spans = t->spans + row->first_span;
    const uint32_t begin = (uint32_t)((uint64_t)row->span_count * index / bundles->workers),
                   end = (uint32_t)((uint64_t)row->span_count * (index + 1) / bundles->workers);
    // Each worker has a carry row of its own, which it leaves as it found it.
    const mspringi_substep substep = mspringi_substep_prepare(network, bundles->h, bundles->base, 0, 1,
                                                              index * mspringi_explicit_carry_rows(network));
    (void)worker;
    for (const mspringi_span *span = spans + begin; span < spans + end; ++span)
        sweep_span(bundles, &substep.sweep, span, index);
    memset(substep.sweep.carry_x, 0, (size_t)2 * t->carry_blocks * MSPRINGI_WIDTH * sizeof *substep.sweep.carry_x);
}

void mspringi_bundles_sweep(mspring_network *network, float h, mspringi_field base, uint32_t count,
                            mspringi_extrema *all_extrema) {
    const mspringi_topology *t = &network->topology;
    job bundles = {
        .network = network, .base = base, .h = h, .count = count, .workers = 1, .all_extrema = all_extrema};
    if (mspringi_sleep_state_of_strip(network, &t->strips[t->bundle_strip]) == MSPRINGI_ASLEEP)
        return;
    if ((uint64_t)t->bundle_springs * count >= SMALLEST_SHARED_WORK)
        bundles.workers = mspringi_tasks_partition_size(network->tasks);
    mspringi_tasks_run(bundles.workers > 1 ? network->tasks : NULL, bundles.workers, sweep_share, &bundles);
}
