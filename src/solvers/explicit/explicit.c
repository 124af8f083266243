/// The explicit solver: leapfrog, in passes over strips of rows.
#include "solvers/explicit/explicit.h"

#include <string.h>

#include "features/contact/floor.h"
#include "solvers/explicit/bundles.h"
#include "solvers/explicit/flush.h"
#include "solvers/explicit/halo.h"
#include "solvers/explicit/loose.h"
#include "solvers/explicit/partition.h"
#include "solvers/explicit/pass_task.h"
#include "solvers/explicit/small_network.h"
#include "solvers/explicit/strip.h"
#include "store/record_sharing.h"
#include "store/sleepers.h"
#include "tasks/team.h"

/// Cache for the strips of a pass: the second level, or the third where the second holds FEW_SUBSTEPS at most. Of
/// half or twice the first, and four times the second, steps are as long (bench/ATTEMPTS.md, Caches).
#define NEAR_CACHE_BYTES ((size_t)1 << 20)
#define FAR_CACHE_BYTES ((size_t)4 << 20)
#define FEW_SUBSTEPS 4u

/// Springs of the irregular part times substeps from which more than one worker is worth it.
#define SMALLEST_SHARED_IRREGULAR 400000u

/// Data that the workers of a sweep share.
typedef struct job {
    const mspring_network *network;
    mspringi_field base;
    float h;
    uint32_t count;                  ///< substeps
    uint32_t workers;                ///< bodies that run at the same time
    mspringi_progress *progress;     ///< [workers]; NULL for one
    mspringi_partition partition;    ///< (wavefront)
    const mspringi_strip *irregular; ///< the irregular row's tiers, as a wavefront of their own; or NULL
    mspringi_extrema *all_extrema;   ///< [workers] if the substeps are a whole step; else NULL
    bool bundles_are_apart;          ///< and not to be swept here
} job;

/* ---------------------------------------------------------------------------------------------- the wavefront */

// Substeps of a pass over strips of so many bytes together, at least one: those whose strips fit the cache. A pass
// keeps `skew` strips for each, and `more`.
static uint32_t fit_depth(uint64_t bytes, uint32_t strips, uint32_t skew, uint32_t more) {
    const uint64_t caches[] = {NEAR_CACHE_BYTES, FAR_CACHE_BYTES};
    uint64_t depth = 0;
    for (size_t i = 0; i < 2 && depth <= FEW_SUBSTEPS; ++i) {
        const uint64_t fit = caches[i] * strips / (bytes + 1);
        depth = fit > more ? (fit - more) / skew : 0;
    }
    return depth < 1 ? 1 : depth < MSPRINGI_DEEPEST_PASS ? (uint32_t)depth : MSPRINGI_DEEPEST_PASS;
}

uint32_t mspringi_explicit_depth(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    if (t->wavefront_rows == 0)
        return 1;
    const uint64_t floats_per_slot = mspringi_state_arrays(network) + 1 +
                                     MSPRINGI_DIRECTIONS * (network->parts - 1); // state, inverse mass, springs
    const uint64_t bytes_of_lattices =
        (uint64_t)t->lattice_blocks * MSPRINGI_WIDTH * floats_per_slot * sizeof(float);
    return fit_depth(bytes_of_lattices * t->wavefront_rows / t->lattice_rows, t->wavefront_strips, t->skew, 1);
}

uint32_t mspringi_explicit_workers(const mspring_network *network) {
    const uint32_t count = network->substeps > 0 ? network->substeps : 1;
    return network->topology.wavefront_strips > 0
               ? mspringi_partition_count(network, NULL, count, network->depth).workers
               : 1;
}

// One more than are under way, so that the processor can begin the next substep of a small network before the last
// row of this one is done.
uint32_t mspringi_explicit_carry_rows(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const uint32_t enough = t->wavefront_strips == 0 ? 1 : (t->wavefront_strips - 1) / t->skew + 2;
    return network->depth < enough ? network->depth : enough;
}

// The first substep of a whole step saves the state, the last one tracks extrema.
static void mark_ends(const job *wavefront, mspringi_substep *substep, uint32_t number,
                      mspringi_extrema_lanes *watch) {
    if (wavefront->all_extrema && number == 0)
        mspringi_substep_save_state(wavefront->network, substep);
    if (wavefront->all_extrema && number + 1 == wavefront->count)
        mspringi_substep_track_extrema(wavefront->network, substep, watch);
}

static void add_extrema(const job *wavefront, uint32_t worker, mspringi_extrema extrema) {
    wavefront->all_extrema[worker] = mspringi_extrema_join(wavefront->all_extrema[worker], extrema);
}

// Take one substep of a strip.
static void sweep_strip(const job *wavefront, const mspringi_substep *substep, uint32_t worker,
                        const mspringi_strip *strip, const mspringi_halo *halo) {
    if (mspringi_sleep_state_of_strip(wavefront->network, strip) == MSPRINGI_ASLEEP)
        return;
    mspringi_strip_sweep(wavefront->network, substep, strip, halo);
    if (substep->sweep.watch)
        add_extrema(wavefront, worker, mspringi_strip_end(wavefront->network, strip));
}

// A tier of the irregular row, as a span of its own.
static mspringi_span tier_span(const job *wavefront, uint32_t tier) {
    const mspringi_topology *t = &wavefront->network->topology;
    const uint32_t begin = t->tier_blocks[tier], end = t->tier_blocks[tier + 1];
    mspringi_span span = t->spans[t->rows[wavefront->irregular->first_row].first_span];
    span.first_slot += begin * MSPRINGI_WIDTH;
    span.end_slot = span.first_slot + (end - begin) * MSPRINGI_WIDTH;
    span.first_record += begin;
    return span;
}

// Take one substep of a tier of the irregular row.
static void sweep_tier(const job *wavefront, const mspringi_substep *substep, uint32_t tier) {
    const mspring_network *network = wavefront->network;
    const mspringi_span span = tier_span(wavefront, tier);
    mspringi_floor_save_velocities(network, wavefront->irregular, &span, 1);
    mspringi_irregular_sweep(network, substep, &span);
    mspringi_floor_apply(network, wavefront->irregular, &span, 1, &substep->sweep);
    if (substep->next_gathered)
        mspringi_irregular_pack_next(network, substep, &span);
    if (substep->sweep.watch)
        mspringi_flush_to_zero(network, span.first_slot, span.end_slot);
}

// Take a substep of the pass for a strip of the pass task.
static void take_strip(const job *wavefront, mspringi_pass_task *task, uint32_t number,
                       const mspringi_substep *substep, uint32_t strip) {
    const mspring_network *network = wavefront->network;
    const bool is_first = strip == task->begin[number], is_last = strip + 1 == task->end[number];
    if (task->progress)
        mspringi_pass_task_wait_above(task, number, strip);
    if (wavefront->irregular) {
        sweep_tier(wavefront, substep, strip);
    } else {
        const mspringi_strip *here = &network->topology.strips[strip];
        const mspringi_halo below = {is_first ? mspringi_pass_task_halo_below(task, number) : MSPRING_NONE, number};
        const mspringi_halo above = {is_last ? mspringi_pass_task_halo_above(task, number) : MSPRING_NONE, number};
        if (below.border != MSPRING_NONE)
            mspringi_halo_keep(network, &below, substep, here);
        sweep_strip(wavefront, substep, task->body, here, above.border != MSPRING_NONE ? &above : NULL);
    }
    if (task->share > 0 && strip + 1 == task->begin[number] + task->partition->skew)
        mspringi_pass_task_publish(task, number + 1);
}

// Make one pass: several substeps over all strips of a share, each skew strips behind the one before, so that a
// strip is in the cache for all of them. A strip's substep needs the one before of the strip itself, of the row
// above, and of the other ends of irregular springs: all are done by then, and none is further.
static void make_pass(const job *wavefront, mspringi_pass_task *task) {
    const mspring_network *network = wavefront->network;
    const uint32_t count = mspringi_partition_substeps(task->partition, task->pass), skew = task->partition->skew;
    const uint32_t carries = mspringi_explicit_carry_rows(network);
    const uint32_t first_carry = mspringi_pass_task_carry_owner(task) * carries;
    const mspringi_substep any =
        mspringi_substep_prepare(network, wavefront->h, wavefront->base, 0, wavefront->count, 0);
    mspringi_substep substeps[MSPRINGI_DEEPEST_PASS];
    mspringi_extrema_buffer room = {{0.0f}};
    mspringi_extrema_lanes *const watch = mspringi_extrema_in_buffer(&room);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t number = task->pass * task->partition->group + i;
        substeps[i] = any;
        mspringi_substep_reuse(network, &substeps[i], number, wavefront->count,
                               wavefront->irregular ? 0 : first_carry + i % carries);
        mark_ends(wavefront, &substeps[i], number, watch);
    }
    mspringi_pass_task_begin(task);
    const uint32_t end = task->end[count - 1] + (count - 1) * skew;
    for (uint32_t front = task->begin[0]; front < end; ++front)
        for (uint32_t i = 0; i < count && i * skew <= front; ++i) {
            const uint32_t strip = front - i * skew;
            if (strip >= task->begin[i] && strip < task->end[i])
                take_strip(wavefront, task, i, &substeps[i], strip);
        }
    if (wavefront->all_extrema)
        add_extrema(wavefront, task->body, network->kernels->extrema_of(watch));
}

// Make all passes over a share. What is computed, and in which order, is the same for any number of workers. The
// first bodies are those above, which wait for nobody within a pass.
static void take_share(void *argument, uint32_t index, uint32_t worker) {
    const job *wavefront = argument;
    const mspringi_partition *partition = &wavefront->partition;
    mspringi_pass_task task = {.partition = partition,
                               .progress = wavefront->progress,
                               .share = partition->workers - 1 - index,
                               .body = partition->workers - 1 - index};
    (void)worker;
    for (; task.pass * partition->group < partition->count; task.pass++, task.passed += partition->group + 1) {
        mspringi_pass_task_wait_previous(&task);
        make_pass(wavefront, &task);
        mspringi_pass_task_publish(&task, partition->group + 1);
    }
}

/// A pass in two runs of bodies that wait for nobody.
typedef struct tiles {
    const job *wavefront;
    uint32_t pass;
} tiles;

static void take_tile(void *argument, uint32_t index, uint32_t worker) {
    const tiles *of = argument;
    mspringi_pass_task task = {
        .partition = &of->wavefront->partition, .share = index, .body = index, .pass = of->pass};
    (void)worker;
    make_pass(of->wavefront, &task);
}

static void take_border(void *argument, uint32_t index, uint32_t worker) {
    const tiles *of = argument;
    mspringi_pass_task task = {.partition = &of->wavefront->partition,
                               .share = index > 0 ? index : of->wavefront->partition.workers,
                               .body = index,
                               .pass = of->pass,
                               .is_border = true};
    (void)worker;
    make_pass(of->wavefront, &task);
    if (index > 0)
        return;
    task.share = 0;
    make_pass(of->wavefront, &task);
}

static void run_wavefront(job *wavefront) {
    const mspring_network *network = wavefront->network;
    const mspringi_partition *partition = &wavefront->partition;
    mspringi_tasks *tasks = partition->workers > 1 ? network->tasks : NULL;
    if (!partition->are_independent) {
        wavefront->progress = mspringi_tasks_progress(tasks);
        mspringi_tasks_run(tasks, partition->workers, take_share, wavefront);
        return;
    }
    for (tiles of = {.wavefront = wavefront}; of.pass * partition->group < partition->count; ++of.pass) {
        mspringi_tasks_run(tasks, partition->workers, take_tile, &of);
        mspringi_tasks_run(tasks, partition->workers, take_border, &of);
    }
}

// Pack what the first substep sees of the irregular part's nodes.
static void pack_wavefront(const mspring_network *network, float h, mspringi_field base, uint32_t count) {
    const mspringi_topology *t = &network->topology;
    const mspringi_substep first = mspringi_substep_prepare(network, h, base, 0, count, 0);
    for (uint32_t s = 0; s < t->wavefront_strips; ++s)
        if (mspringi_sleep_state_of_strip(network, &t->strips[s]) != MSPRINGI_ASLEEP)
            mspringi_strip_pack(network, &first, &t->strips[s]);
}

static void sweep_wavefront(mspring_network *network, float h, mspringi_field base, uint32_t count,
                            mspringi_extrema *all_extrema) {
    const mspringi_topology *t = &network->topology;
    if (t->wavefront_strips == 0)
        return;
    job wavefront = {.network = network,
                     .base = base,
                     .h = h,
                     .count = count,
                     .partition = mspringi_partition_make(network, NULL, count, network->depth),
                     .all_extrema = all_extrema};
    if (t->irregular.slice_count > 0)
        pack_wavefront(network, h, base, count);
    run_wavefront(&wavefront);
}

/* --------------------------------------------------------------------------- an irregular part's own wavefront */

static const mspringi_strip *find_irregular_strip(const mspringi_topology *t) {
    for (uint32_t s = t->wavefront_strips; s < t->strip_count; ++s)
        if (t->rows[t->strips[s].first_row].kind == MSPRINGI_ROW_IRREGULAR)
            return &t->strips[s];
    return NULL;
}

// A pass keeps two more tiers than substeps in the cache.
static uint32_t irregular_depth(const mspring_network *network, const mspringi_strip *irregular) {
    const mspringi_topology *t = &network->topology;
    const uint32_t first = t->spans[t->rows[irregular->first_row].first_span].first_record;
    const uint32_t groups = t->tier_blocks[t->tier_count];
    const uint64_t slice_columns =
        t->irregular.first_slice_column[first + groups] - t->irregular.first_slice_column[first];
    const uint64_t parts = network->parts + 1; // and the neighbour
    const uint64_t floats = slice_columns * parts + (uint64_t)groups * (mspringi_state_arrays(network) + 1 +
                                                                        2 * 4); // state, inverse mass, packed twice
    return fit_depth(floats * MSPRINGI_WIDTH * sizeof(float), t->tier_count, 1, 2);
}

// Sweep the irregular row in tiers for several substeps, if the wavefront has work for all workers. (Zen 4, shared
// third-level cache, 100,000 particles of about 8 neighbours, 40 substeps: 28 ms; without 60 to 75.)
static bool sweep_tiers(const mspring_network *network, float h, mspringi_field base, uint32_t count,
                        mspringi_extrema *all_extrema) {
    const mspringi_topology *t = &network->topology;
    const mspringi_strip *irregular = find_irregular_strip(t);
    if (!irregular || t->tier_count == 0 || count == 1 || network->added_springs.count > 0)
        return false;
    job wavefront = {.network = network,
                     .base = base,
                     .h = h,
                     .count = count,
                     .irregular = irregular,
                     .all_extrema = all_extrema};
    const uint32_t depth = irregular_depth(network, irregular);
    wavefront.partition = mspringi_partition_make(network, irregular, count, depth);
    if (depth == 1 || wavefront.partition.workers < mspringi_tasks_concurrency(network->tasks))
        return false;
    if (mspringi_sleep_state_of_strip(network, irregular) == MSPRINGI_ASLEEP)
        return true;
    const mspringi_substep first = mspringi_substep_prepare(network, h, base, 0, count, 0);
    mspringi_irregular_pack(network, &first, &t->spans[t->rows[irregular->first_row].first_span]);
    run_wavefront(&wavefront);
    return true;
}

/* -------------------------------------------------------------------------------------------- the other strips */

// The blocks of a irregular row that a worker takes.
static mspringi_span share_of(const mspringi_span *all, uint32_t worker, uint32_t workers) {
    const uint32_t first_block = all->first_slot / MSPRINGI_WIDTH;
    const uint64_t blocks = all->end_slot / MSPRINGI_WIDTH - first_block;
    const uint32_t begin = (uint32_t)(blocks * worker / workers), end = (uint32_t)(blocks * (worker + 1) / workers);
    mspringi_span share = *all;
    share.first_slot = (first_block + begin) * MSPRINGI_WIDTH;
    share.end_slot = (first_block + end) * MSPRINGI_WIDTH;
    share.first_record = all->first_record + begin;
    return share;
}

// What belongs before the first and after the last substep of a share of the irregular part or of the loose
// particles, if the substeps are a whole step.
static void begin_share(const job *rest, const mspringi_span *share) {
    if (rest->all_extrema)
        mspringi_span_save_state(rest->network, share);
}

static void end_share(const job *rest, const mspringi_span *share, uint32_t worker) {
    if (rest->all_extrema)
        add_extrema(rest, worker, mspringi_span_extrema(rest->network, share));
}

// Take all substeps of a share of the loose particles: nothing else moves them but a floor that is near.
static void sweep_loose(const job *rest, const mspringi_strip *strip, uint32_t index) {
    const mspring_network *network = rest->network;
    const mspringi_topology *t = &network->topology;
    if (mspringi_sleep_state_of_strip(network, strip) == MSPRINGI_ASLEEP)
        return;
    const mspringi_substep substep = mspringi_substep_prepare(network, rest->h, rest->base, 0, 1, 0);
    const mspringi_loose all = mspringi_loose_prepare(network, &substep.sweep, strip, rest->count);
    const mspringi_span share = share_of(&t->spans[t->rows[strip->first_row].first_span], index, rest->workers);
    mspringi_span run[2];
    begin_share(rest, &share);
    if (network->sleep.sleeping == 0)
        mspringi_loose_sweep(&all, &share);
    else
        for (uint32_t at = share.first_slot; mspringi_next_swept(network, &share, &at, run);)
            mspringi_loose_sweep(&all, run);
    end_share(rest, &share, index);
}

// The blocks of the loose row that added springs pull at take one substep, the others all of them at the first.
static void sweep_grafted_loose(const job *rest, const mspringi_substep *substep, const mspringi_strip *strip,
                                uint32_t number, uint32_t count) {
    const mspring_network *network = rest->network;
    const mspringi_topology *t = &network->topology;
    const mspringi_span *row = &t->spans[t->rows[strip->first_row].first_span];
    const uint32_t end = row->end_slot / MSPRINGI_WIDTH;
    const mspringi_loose all = mspringi_loose_prepare(network, &substep->sweep, strip, number == 0 ? count : 0);
    const mspringi_loose one = mspringi_loose_prepare(network, &substep->sweep, strip, 1);
    bool pulled = false;
    for (uint32_t block = row->first_slot / MSPRINGI_WIDTH, next; block < end; block = next, pulled = !pulled) {
        next = mspringi_added_springs_find_block(&network->added_springs, block, end, !pulled);
        mspringi_span span = *row;
        span.first_slot = block * MSPRINGI_WIDTH;
        span.end_slot = next * MSPRINGI_WIDTH;
        if (next == block || (!pulled && number > 0))
            continue;
        if (!pulled) {
            mspringi_loose_sweep(&all, &span);
            continue;
        }
        mspringi_floor_save_velocities(network, strip, &span, 1);
        network->kernels->loose[rest->base.x != NULL](&substep->sweep, &span, &one.all);
        mspringi_added_springs_pull(network, &substep->sweep, span.first_slot, span.end_slot);
        mspringi_floor_apply(network, strip, &span, 1, &substep->sweep);
    }
}

// What of a strip a worker takes, if it is one of the irregular part that is not swept apart.
static bool share_of_irregular(const job *rest, uint32_t strip, uint32_t index, mspringi_span *share) {
    const mspringi_topology *t = &rest->network->topology;
    const mspringi_row *row = &t->rows[t->strips[strip].first_row];
    const bool is_swept = strip == t->bundle_strip ? rest->bundles_are_apart : rest->irregular != NULL;
    if (row->kind != MSPRINGI_ROW_IRREGULAR || is_swept)
        return false;
    mspringi_span all = t->spans[row->first_span];
    all.end_slot = t->spans[row->first_span + row->span_count - 1].end_slot;
    *share = share_of(&all, index, rest->workers);
    return share->end_slot > share->first_slot;
}

static void sweep_irregular_share(const job *rest, const mspringi_substep *substep, const mspringi_strip *strip,
                                  const mspringi_span *share, uint32_t number, uint32_t index) {
    const mspring_network *network = rest->network;
    if (number == 0)
        begin_share(rest, share);
    mspringi_floor_save_velocities(network, strip, share, 1);
    mspringi_irregular_sweep(network, substep, share);
    if (network->added_springs.count > 0)
        mspringi_added_springs_pull(network, &substep->sweep, share->first_slot, share->end_slot);
    mspringi_floor_apply(network, strip, share, 1, &substep->sweep);
    if (number + 1 == rest->count)
        end_share(rest, share, index);
}

// Take one substep after the other: all workers pack and sweep the irregular part, the first one everything else.
// Substeps have the packed nodes in two places in turn, so one meeting in each keeps the next from changing what
// this one reads.
static void sweep_share(void *argument, uint32_t index, uint32_t worker) {
    const job *rest = argument;
    const mspring_network *network = rest->network;
    const mspringi_topology *t = &network->topology;
    mspringi_extrema_buffer room = {{0.0f}};
    mspringi_extrema_lanes *const watch = mspringi_extrema_in_buffer(&room);
    mspringi_team_member member = {.index = index, .count = rest->workers, .progress = rest->progress};
    const mspringi_substep any = mspringi_substep_prepare(network, rest->h, rest->base, 0, rest->count, 0);
    (void)worker;
    for (uint32_t i = 0; i < rest->count; ++i) {
        mspringi_substep substep = any;
        mspringi_substep_reuse(network, &substep, i, rest->count, 0);
        substep.next_gathered = NULL;
        mspringi_span share;
        for (uint32_t s = t->wavefront_strips; s < t->strip_count; ++s) {
            const mspringi_row *row = &t->rows[t->strips[s].first_row];
            if (row->kind == MSPRINGI_ROW_LOOSE) {
                if (i == 0 && network->added_springs.count == 0)
                    sweep_loose(rest, &t->strips[s], index);
            } else if (row->kind == MSPRINGI_ROW_IRREGULAR) {
                if (share_of_irregular(rest, s, index, &share))
                    mspringi_irregular_pack(network, &substep, &share);
            } else if (index == 0) {
                mspringi_strip_pack(network, &substep, &t->strips[s]);
            }
        }
        mspringi_team_barrier(&member);
        for (uint32_t s = t->wavefront_strips; s < t->strip_count; ++s)
            if (share_of_irregular(rest, s, index, &share))
                sweep_irregular_share(rest, &substep, &t->strips[s], &share, i, index);
        mark_ends(rest, &substep, i, watch);
        for (uint32_t s = t->wavefront_strips; index == 0 && s < t->strip_count; ++s)
            if (t->rows[t->strips[s].first_row].kind < MSPRINGI_ROW_IRREGULAR)
                sweep_strip(rest, &substep, index, &t->strips[s], NULL);
    }
    if (rest->all_extrema)
        add_extrema(rest, index, rest->network->kernels->extrema_of(watch));
}

static void sweep_rest(mspring_network *network, float h, mspringi_field base, uint32_t count,
                       mspringi_extrema *all_extrema) {
    const mspringi_topology *t = &network->topology;
    if (t->wavefront_strips == t->strip_count)
        return;
    job rest = {.network = network, .base = base, .h = h, .count = count, .workers = 1, .all_extrema = all_extrema};
    if (sweep_tiers(network, h, base, count, all_extrema))
        rest.irregular = find_irregular_strip(t);
    rest.bundles_are_apart = mspringi_bundles_are_apart(network);
    if (t->wavefront_strips + (rest.irregular != NULL) + rest.bundles_are_apart == t->strip_count)
        return;
    const uint32_t springs = t->irregular_count - (rest.bundles_are_apart ? t->bundle_springs : 0);
    if ((uint64_t)springs * count >= SMALLEST_SHARED_IRREGULAR && network->added_springs.count == 0)
        rest.workers = mspringi_tasks_concurrency(network->tasks);
    rest.progress = rest.workers > 1 ? mspringi_tasks_progress(network->tasks) : NULL;
    mspringi_tasks_run(rest.progress ? network->tasks : NULL, rest.workers, sweep_share, &rest);
}

// Take one substep after the other, since added springs may join anything.
static void sweep_grafted(mspring_network *network, float h, mspringi_field base, uint32_t count) {
    const mspringi_topology *t = &network->topology;
    const bool has_loose = t->row_count > 0 && t->rows[t->row_count - 1].kind == MSPRINGI_ROW_LOOSE;
    const job loose = {.network = network, .base = base, .h = h};
    const uint32_t first = network->tested.substep, begin = network->first_substep;
    for (uint32_t i = 0; i < count; ++i) {
        network->tested.substep = first + i;
        network->first_substep = begin + i;
        const mspringi_substep substep = mspringi_substep_prepare(network, h, base, 0, 1, 0);
        mspringi_added_springs_begin(network, &substep.sweep);
        sweep_wavefront(network, h, base, 1, NULL);
        sweep_rest(network, h, base, 1, NULL);
        if (has_loose)
            sweep_grafted_loose(&loose, &substep, &t->strips[t->strip_count - 1], i, count);
        network->lag = network->full_lag = h;
    }
}

// The wavefront's strips know nothing of the others, nor they of the wavefront's, unless springs were added.
static void sweep_all(mspring_network *network, float h, mspringi_field base, uint32_t count,
                      mspringi_extrema *all_extrema) {
    mspringi_shared_records_find(network);
    if (network->added_springs.count > 0) {
        sweep_grafted(network, h, base, count);
    } else if (!mspringi_small_network_step(network, h, base, count, all_extrema)) {
        sweep_wavefront(network, h, base, count, all_extrema);
        sweep_rest(network, h, base, count, all_extrema);
        if (mspringi_bundles_are_apart(network))
            mspringi_bundles_sweep(network, h, base, count, all_extrema);
    }
    mspringi_tasks_judge(network->tasks);
}

mspringi_extrema mspringi_explicit_run_step(mspring_network *network, float h, mspringi_field base,
                                            uint32_t count) {
    mspringi_extrema all_extrema[MSPRING_MAX_WORKERS];
    const uint32_t workers = mspringi_tasks_partition_size(network->tasks);
    memset(all_extrema, 0, workers * sizeof *all_extrema);
    sweep_all(network, h, base, count, all_extrema);
    for (uint32_t worker = 1; worker < workers; ++worker)
        all_extrema[0] = mspringi_extrema_join(all_extrema[0], all_extrema[worker]);
    return all_extrema[0];
}

void mspringi_explicit_run_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count) {
    if (network->floor)
        mspringi_floor_update_clearances(network, (double)h * (double)count);
    sweep_all(network, h, base, count, NULL);
    if (network->floor)
        mspringi_floor_check_clear(network);
}

void mspringi_explicit_reset(mspring_network *network) {
    // A carry row is zero again after every substep, as there is no row above the last, unless numbers overflowed.
    memset(network->carry, 0,
           (size_t)2 * network->carry_rows * network->topology.carry_blocks * MSPRINGI_WIDTH *
               sizeof *network->carry);
}
