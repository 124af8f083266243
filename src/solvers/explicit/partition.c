/// Equal shares.
#include "solvers/explicit/partition.h"

#include "solvers/explicit/halo.h"
#include "store/sleepers.h"

/// Substeps of a step times springs from which more than one worker is worth it, and those of a pass: workers meet
/// in each.
#define SMALLEST_SHARED_WORK 400000u
#define SMALLEST_SHARED_PASS 40000u

/// Springs times substeps of a pass that each independent share should have, since a pass has two runs: a host
/// takes some microseconds for each.
#define SMALLEST_TILE 30000u

/// Strips that each of several workers should have: a bar of 640 x 10, whose rows go from one to the other and back
/// every third substep, was 1.3 times as fast with two as with one where both cores were there, and 0.65 times
/// where the host took turns. Fewer strips are enough if they have more springs than this each, as those of
/// lattices with ropes do.
#define FEWEST_STRIPS 8u
#define LIGHT_STRIP_SPRINGS 2048u

/// What it takes to sweep a lattice block, to sweep a slice column of the irregular part, and to keep a block of a
/// halo and sweep it.
#define BLOCK_WEIGHT 8u
#define SLICE_COLUMN_WEIGHT 3u
#define HALO_WEIGHT 12u

/* -------------------------------------------------------------------------------------------------- the weights */

static uint64_t slice_columns_between(const mspringi_topology *t, uint32_t first_group, uint32_t end_group) {
    return t->irregular.first_slice_column[end_group] - t->irregular.first_slice_column[first_group];
}

static uint64_t weight_of_strip(const mspring_network *network, const mspringi_strip *strip) {
    const mspringi_topology *t = &network->topology;
    const mspringi_row *first = &t->rows[strip->first_row], *last = first + strip->row_count - 1;
    const uint32_t begin = t->spans[first->first_span].first_slot / MSPRINGI_WIDTH;
    const uint32_t end = t->spans[last->first_span + last->span_count - 1].end_slot / MSPRINGI_WIDTH;
    if (mspringi_sleep_state_of_strip(network, strip) == MSPRINGI_ASLEEP)
        return 0;
    uint64_t weight = (uint64_t)BLOCK_WEIGHT * (end - begin + 1);
    if (strip->attached_count > 0) {
        const uint32_t group = (t->irregular.own_count + strip->first_attached) / MSPRINGI_WIDTH;
        const uint32_t groups = (strip->attached_count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
        weight += SLICE_COLUMN_WEIGHT * slice_columns_between(t, group, group + groups);
    }
    if (strip->assigned_span != MSPRING_NONE) {
        const mspringi_span *span = &t->spans[strip->assigned_span];
        const uint32_t blocks =
            (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH - span->first_slot / MSPRINGI_WIDTH;
        weight += SLICE_COLUMN_WEIGHT * slice_columns_between(t, span->first_record, span->first_record + blocks);
    }
    return weight;
}

static uint64_t weight_of_tier(const mspring_network *network, const mspringi_strip *irregular, uint32_t tier) {
    const mspringi_topology *t = &network->topology;
    const uint32_t first = t->spans[t->rows[irregular->first_row].first_span].first_record;
    return SLICE_COLUMN_WEIGHT *
           slice_columns_between(t, first + t->tier_blocks[tier], first + t->tier_blocks[tier + 1]);
}

// What the strips below each have together.
static void weigh(const mspring_network *network, const mspringi_strip *irregular, uint32_t strips) {
    uint64_t *weights = network->halos.weights;
    weights[0] = 0;
    for (uint32_t s = 0; s < strips; ++s)
        weights[s + 1] = weights[s] + (irregular ? weight_of_tier(network, irregular, s)
                                                 : weight_of_strip(network, &network->topology.strips[s]));
}

/* -------------------------------------------------------------------------------------------------- the borders */

// What lies below a border in a pass of so many substeps.
static uint64_t weight_below(const mspring_network *network, const mspringi_partition *partition, uint32_t border,
                             uint32_t substeps) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < substeps; ++i)
        sum += network->halos.weights[border + i * partition->skew];
    return sum;
}

// Of the borders first to last the highest one that has no more than that weight below it.
static uint32_t find_border(const mspring_network *network, const mspringi_partition *partition, uint64_t weight,
                            uint32_t substeps, uint32_t first, uint32_t last) {
    while (first < last) {
        const uint32_t middle = last - (last - first) / 2;
        if (weight_below(network, partition, middle, substeps) <= weight)
            first = middle;
        else
            last = middle - 1;
    }
    return first;
}

// Find the borders of a pass. below: of each, what has been below it in the passes before, and will be after this
// one. Whoever is below is rather ahead than behind, so that nobody waits for it when the next pass begins.
static void find_borders(const mspring_network *network, const mspringi_partition *partition, uint32_t pass,
                         uint64_t halo, uint64_t *below) {
    const uint32_t substeps = mspringi_partition_substeps(partition, pass),
                   least = mspringi_partition_min_strips(partition->skew);
    const uint64_t done = (uint64_t)pass * partition->group + substeps, workers = partition->workers;
    const uint64_t each = done * (network->halos.weights[partition->strips] + (workers - 1) * halo) / workers;
    uint32_t *borders = partition->borders + (size_t)pass * partition->workers;
    borders[0] = 0;
    for (uint32_t share = 1; share < workers; ++share) {
        const uint64_t wanted = share * each, others = (share - 1) * halo * done + below[share];
        const uint32_t last =
            partition->strips - (partition->workers - share) * least - (substeps - 1) * partition->skew;
        borders[share] = find_border(network, partition, wanted > others ? wanted - others : 0, substeps,
                                     borders[share - 1] + least, last);
        below[share] += weight_below(network, partition, borders[share], substeps);
    }
}

// Equal passes, no longer than shares are high: the uppermost one is lowest in the last substep of a pass.
static void plan_passes(mspringi_partition *partition, uint32_t depth) {
    const uint32_t least = mspringi_partition_min_strips(partition->skew);
    const uint32_t each = partition->strips / partition->workers;
    const uint32_t fits =
        partition->are_independent ? (each - 2) / (2 * partition->skew) : 1 + (each - least) / partition->skew;
    const uint32_t most = partition->workers == 1 || depth < fits ? depth : fits;
    const uint32_t passes = (partition->count + most - 1) / most;
    partition->group = (partition->count + passes - 1) / passes;
}

// Strips that a share should have at least: as many as its worker reads, and enough work.
static uint32_t fewest_strips(uint32_t strips, uint32_t skew, uint64_t springs) {
    const uint32_t least = mspringi_partition_min_strips(skew);
    const uint64_t work = (uint64_t)FEWEST_STRIPS * LIGHT_STRIP_SPRINGS;
    const uint64_t enough = springs > 0 ? (work * strips + springs - 1) / springs : FEWEST_STRIPS;
    const uint32_t fewest = enough < FEWEST_STRIPS ? (uint32_t)enough : FEWEST_STRIPS;
    return fewest > least ? fewest : least;
}

static uint64_t least_work_of_pass(const mspringi_partition *partition) {
    return partition->are_independent ? (uint64_t)SMALLEST_TILE * partition->workers : SMALLEST_SHARED_PASS;
}

mspringi_partition mspringi_partition_count(const mspring_network *network, const mspringi_strip *irregular,
                                            uint32_t count, uint32_t depth) {
    const mspringi_topology *t = &network->topology;
    mspringi_partition partition = {.strips = irregular ? t->tier_count : t->wavefront_strips,
                                    .skew = irregular ? 1 : t->skew,
                                    .count = count,
                                    .workers = mspringi_tasks_partition_size(network->tasks),
                                    .are_independent = mspringi_tasks_are_independent(network->tasks),
                                    .borders = network->halos.borders};
    // Both workers at a border compute the forces there: a rest length must not change in between.
    if ((!irregular && network->tested.yields && network->tested.maps) ||
        mspringi_tasks_are_in_turn(network->tasks))
        partition.workers = 1;
    const uint64_t springs = mspringi_swept_count(t);
    const uint32_t fewest =
        fewest_strips(partition.strips, partition.skew, irregular ? t->irregular_count : t->lattice_springs);
    const uint32_t most = partition.strips / (fewest + partition.are_independent);
    if (partition.workers > most)
        partition.workers = most > 1 ? most : 1;
    if (springs * network->substeps < SMALLEST_SHARED_WORK || network->added_springs.count > 0)
        partition.workers = 1;
    plan_passes(&partition, depth);
    while (partition.workers > 1 && springs * partition.group < least_work_of_pass(&partition)) {
        partition.workers = partition.are_independent ? partition.workers - 1 : 1;
        plan_passes(&partition, depth);
    }
    partition.are_independent = partition.are_independent && partition.workers > 1;
    return partition;
}

/* ---------------------------------------------------------------------------------------- independent shares */

// Find the borders of independent shares: each has its part of the weight, and strips left in the last substep of a
// pass beside what grows around its borders.
static void find_tiles(const mspring_network *network, const mspringi_partition *partition) {
    const uint64_t *weights = network->halos.weights;
    const uint32_t workers = partition->workers, least = 2 * partition->group * partition->skew + 2;
    uint32_t *borders = partition->borders;
    borders[0] = 0;
    borders[workers] = partition->strips;
    for (uint32_t share = 1; share < workers; ++share) {
        const uint64_t wanted = weights[partition->strips] * share / workers;
        const uint32_t last = partition->strips - (workers - share) * least;
        uint32_t border = borders[share - 1] + least;
        while (border < last && weights[border + 1] + weights[border] <= 2 * wanted)
            border++;
        borders[share] = border;
    }
}

mspringi_partition mspringi_partition_make(const mspring_network *network, const mspringi_strip *irregular,
                                           uint32_t count, uint32_t depth) {
    const mspringi_partition partition = mspringi_partition_count(network, irregular, count, depth);
    uint64_t below[MSPRING_MAX_WORKERS] = {0};
    if (partition.workers == 1)
        return partition;
    weigh(network, irregular, partition.strips);
    if (partition.are_independent) {
        find_tiles(network, &partition);
        return partition;
    }
    const uint64_t halo = irregular ? 0 : (uint64_t)HALO_WEIGHT * network->topology.carry_blocks;
    for (uint32_t pass = 0; pass < MSPRINGI_PLANNED_PASSES && pass * partition.group < count; ++pass)
        find_borders(network, &partition, pass, halo, below);
    return partition;
}
