/// @file cores.c
/// What more workers would gain than this machine has cores: the shares that the library plans, and a simulation of
/// who waits for whom in each pass. Two workers are measured beside it.
///
/// The model has three numbers. The time of a unit of weight is that of a step of one worker. What a step takes
/// besides its substeps stays with one worker. A message takes 0.27 us to another core (README.md). Memory and
/// clocks are those of one core at work: so it is an upper bound.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "modes.h"
#include "solvers/explicit/explicit.h"
#include "solvers/explicit/partition.h"
#include "solvers/explicit/pass_task.h"

/// Time until a worker sees what another one said, s.
#define MESSAGE 0.27e-6

/// Time of a run of independent tasks by threads that spin, besides the tasks, s: to call them, and to hear of the
/// last.
#define RUN 1e-6

/// What a block of a border takes in a substep, in units of weight: HALO_WEIGHT of partition.c.
#define BORDER_WEIGHT 12.0

/// Most substeps of a pass, and more.
#define MOST_SUBSTEPS 64

static const char *const default_scenes[] = {"grid_96x96", "bar_544x68", "ship", "ship_ropes_40", NULL};

static const bench_column columns[] = {
    {"scene", "scene", -16},
    {"springs", "springs", 8},
    {"level", "level", -6},
    {"workers", "workers", 7},
    {"used", "used", 4},
    {"strips", "strips", 6},
    {"lag", "lag", 3},
    {"pass_substeps", "substeps a pass", 15},
    {"balance", "balance", 7},
    {"waits", "waits %", 7},
    {"gain_simulated", "gain, simulated", 15},
    {"gain_measured", "gain, measured", 14},
    {"tasks_used", "tasks, used", 11},
    {"tasks_substeps", "tasks, substeps", 15},
    {"tasks_gain", "tasks, gain", 11},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

/// A step under way: times in seconds.
typedef struct simulation {
    const mspringi_partition *partition;
    const uint64_t *weights; ///< of the strips below each
    double unit, halo;       ///< time of a unit of weight; of a border in a substep
    double now[MSPRING_MAX_WORKERS], work[MSPRING_MAX_WORKERS];
    double last[MSPRING_MAX_WORKERS];                 ///< when each ended the pass before
    double above[MOST_SUBSTEPS], said[MOST_SUBSTEPS]; ///< when a worker left its border behind, by substep
} simulation;

static double later(double a, double b) {
    return a > b ? a : b;
}

// A pass begins when the neighbours have ended the one before, as wait_for_last() in explicit.c has it.
static void begin_pass(simulation *s, uint32_t share, uint32_t pass) {
    const mspringi_partition *all = s->partition;
    if (pass > 0 && share > 0)
        s->now[share] = later(s->now[share], s->last[share - 1] + MESSAGE);
    if (pass > 0 && share + 1 < all->workers &&
        mspringi_partition_end_strip(all, share, pass, 0) >
            mspringi_partition_end_strip(all, share, pass - 1, all->group - 1))
        s->now[share] = later(s->now[share], s->last[share + 1] + MESSAGE);
}

static void take_strip(simulation *s, uint32_t share, uint32_t pass, uint32_t substep, uint32_t strip) {
    const mspringi_partition *all = s->partition;
    const uint32_t begin = mspringi_partition_first_strip(all, share, pass, substep);
    if (share + 1 < all->workers &&
        strip + 2 * all->skew >= mspringi_partition_end_strip(all, share, pass, substep))
        s->now[share] = later(s->now[share], s->above[substep] + MESSAGE);
    const double takes = s->unit * (double)(s->weights[strip + 1] - s->weights[strip]) +
                         (share > 0 && strip == begin ? s->halo : 0.0);
    s->now[share] += takes;
    s->work[share] += takes;
    if (strip + 1 == begin + all->skew)
        s->said[substep] = s->now[share];
}

// The loops of make_pass() in explicit.c.
static void make_pass(simulation *s, uint32_t share, uint32_t pass) {
    const mspringi_partition *all = s->partition;
    const uint32_t count = mspringi_partition_substeps(all, pass), skew = all->skew;
    const uint32_t end = mspringi_partition_end_strip(all, share, pass, count - 1) + (count - 1) * skew;
    begin_pass(s, share, pass);
    for (uint32_t front = mspringi_partition_first_strip(all, share, pass, 0); front < end; front++) {
        for (uint32_t i = 0; i < count && i * skew <= front; i++) {
            const uint32_t strip = front - i * skew;
            if (strip >= mspringi_partition_first_strip(all, share, pass, i) &&
                strip < mspringi_partition_end_strip(all, share, pass, i)) {
                take_strip(s, share, pass, i, strip);
            }
        }
    }
}

// The uppermost worker first: within a pass it waits for nobody.
static void simulate(simulation *s) {
    const mspringi_partition *all = s->partition;
    for (uint32_t pass = 0; pass * all->group < all->count; pass++) {
        for (uint32_t share = all->workers; share-- > 0;) {
            make_pass(s, share, pass);
            memcpy(s->above, s->said, sizeof s->above);
        }
        memcpy(s->last, s->now, sizeof s->last);
    }
}

// Time of a strip range in a substep.
static double time_of(const simulation *s, uint32_t begin, uint32_t end) {
    return s->unit * (double)(s->weights[end] - s->weights[begin]);
}

// The longest task of each run, one run after the other. What both ends of the strips leave is one task's.
static double simulate_tasks(const simulation *s) {
    const mspringi_partition *all = s->partition;
    double step = 0.0;
    for (uint32_t pass = 0; pass * all->group < all->count; pass++) {
        const uint32_t count = mspringi_partition_substeps(all, pass);
        double tile = 0.0, border = 0.0;
        for (uint32_t share = 0; share < all->workers; share++) {
            mspringi_pass_task upright = {.partition = all, .share = share, .pass = pass};
            mspringi_pass_task left = {.partition = all, .share = share, .pass = pass, .is_border = true};
            mspringi_pass_task top = {.partition = all, .share = all->workers, .pass = pass, .is_border = true};
            double first = 0.0, second = 0.0;
            mspringi_pass_task_begin(&upright);
            mspringi_pass_task_begin(&left);
            mspringi_pass_task_begin(&top);
            for (uint32_t i = 0; i < count; i++) {
                first += time_of(s, upright.begin[i], upright.end[i]) + s->halo;
                second += time_of(s, left.begin[i], left.end[i]) + s->halo;
                second += share == 0 ? time_of(s, top.begin[i], top.end[i]) : 0.0;
            }
            tile = later(tile, first);
            border = later(border, second);
        }
        step += tile + border + 2.0 * RUN;
    }
    return step;
}

/// What one worker takes.
typedef struct single {
    double step, fixed; ///< s of a step; of that besides its substeps
    double two;         ///< measured gain of two workers
} single;

static void MSPRING_CALL run_in_turn(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    (void)user;
    for (uint32_t i = 0; i < count; i++) {
        fn(argument, i, 0);
    }
}

// A network that thinks it has so many workers. It is never stepped.
static mspring_network *imagine(const bench_scene *subject, mspring_simd level, uint32_t workers,
                                uint32_t concurrent, uint32_t substeps) {
    mspring_network_def def;
    mspring_tasks tasks;
    mspring_network *network = NULL;
    if (mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def) != MSPRING_OK ||
        mspring_init(MSPRING_STRUCT_TASKS, &tasks, sizeof tasks) != MSPRING_OK) {
        return NULL;
    }
    tasks.worker_count = workers;
    tasks.concurrent_count = concurrent;
    tasks.run = run_in_turn;
    def.tasks = &tasks;
    def.simd_level = level;
    def.settings.substeps = substeps;
    return mspring_network_create(subject->made.builder, &def, &network) == MSPRING_OK ? network : NULL;
}

/// The same workers as independent tasks.
typedef struct tasks_row {
    uint32_t used, group;
    double gain;
} tasks_row;

static void print_row(const bench_options *options, const char *label, const mspring_network *network,
                      const simulation *s, uint32_t workers, const single *one, const tasks_row *tasks) {
    const mspringi_partition *all = s->partition;
    double most = 0.0, sum = 0.0, end = 0.0;
    for (uint32_t i = 0; i < all->workers; i++) {
        most = later(most, s->work[i]);
        end = later(end, s->now[i]);
        sum += s->work[i];
    }
    const double step = all->workers > 1 ? one->fixed + end : one->step;
    const bench_cell cells[COLUMN_COUNT] = {
        bench_cell_of("%s", label),
        bench_cell_of("%u", mspring_network_count(network, MSPRING_SPRINGS)),
        bench_cell_of("%s", mspring_simd_name(bench_level_of(network))),
        bench_cell_of("%u", workers),
        bench_cell_of("%u", all->workers),
        bench_cell_of("%u", all->strips),
        bench_cell_of("%u", all->skew),
        bench_cell_of("%u", all->group),
        bench_cell_of("%.2f", sum / (all->workers * most)),
        bench_cell_of("%.1f", 100.0 * (1.0 - sum / (all->workers * end))),
        bench_cell_of("%.2f", one->step / step),
        workers == 2 ? bench_cell_of("%.2f", one->two) : bench_cell_of("%s", ""),
        bench_cell_of("%u", tasks->used),
        bench_cell_of("%u", tasks->group),
        bench_cell_of("%.2f", tasks->gain),
    };
    bench_table_row(options->format, columns, COLUMN_COUNT, cells);
}

// The time of a unit of weight, and of a border.
static void scale(simulation *s, const mspring_network *network, const mspringi_partition *partition,
                  const single *one) {
    s->partition = partition;
    s->weights = network->halos.weights;
    s->unit = (one->step - one->fixed) / ((double)s->weights[partition->strips] * partition->count);
    s->halo = s->unit * BORDER_WEIGHT * network->topology.carry_blocks;
}

static bool tasks_of(const bench_scene *subject, mspring_simd level, uint32_t workers, uint32_t substeps,
                     const single *one, tasks_row *row) {
    mspring_network *network = imagine(subject, level, workers, 1, substeps);
    simulation *s = calloc(1, sizeof *s);
    const bool ok = network != NULL && s != NULL;
    if (ok) {
        const mspringi_partition partition = mspringi_partition_make(network, NULL, substeps, network->depth);
        *row = (tasks_row){.used = partition.workers, .group = partition.group, .gain = 1.0};
        if (partition.workers > 1) {
            scale(s, network, &partition, one);
            row->gain = one->step / (one->fixed + simulate_tasks(s));
        }
    }
    free(s);
    mspring_network_destroy(network);
    return ok;
}

static bool row_of(const bench_scene *subject, const bench_options *options, mspring_simd level, uint32_t workers,
                   uint32_t substeps, const single *one, uint32_t *used) {
    mspring_network *network = imagine(subject, level, workers, workers, substeps);
    if (!network) {
        return false;
    }
    const mspringi_partition partition = mspringi_partition_make(network, NULL, substeps, network->depth);
    simulation *s = calloc(1, sizeof *s);
    tasks_row tasks;
    const bool ok =
        s != NULL && partition.group <= MOST_SUBSTEPS && tasks_of(subject, level, workers, substeps, one, &tasks);
    *used = partition.workers;
    if (ok && partition.workers == 1) {
        s->partition = &partition;
        s->now[0] = s->work[0] = one->step;
    } else if (ok) {
        scale(s, network, &partition, one);
        simulate(s);
    }
    if (ok) {
        print_row(options, subject->label, network, s, workers, one, &tasks);
    }
    free(s);
    mspring_network_destroy(network);
    return ok;
}

// Steps of as many substeps and of a quarter as many tell what does not depend on them.
static bool measure_single(const bench_scene *subject, mspring_simd level, uint32_t substeps, uint32_t repeat,
                           single *out, scene_error *error) {
    mspring_builder *builder = subject->made.builder;
    bench_network one = {0}, few = {0}, two = {0};
    bench_turns fewer, shared;
    const uint32_t quarter = substeps > 4 ? substeps / 4 : 1;
    const double times = (double)substeps / quarter;
    bool ok = bench_network_create(builder, level, 1, substeps, &one, error) &&
              bench_network_create(builder, level, 1, quarter, &few, error) &&
              bench_network_create(builder, level, 2, substeps, &two, error);
    if (ok) {
        const bench_runner a = bench_network_runner(&one), b = bench_network_runner(&few),
                           c = bench_network_runner(&two);
        ok = bench_turns_measure(&a, &b, repeat, &fewer, error) &&
             bench_turns_measure(&a, &c, repeat, &shared, error);
    }
    if (ok) {
        out->step = fewer.first_min;
        out->fixed = times > 1.0 ? later(0.0, (times * fewer.second_min - fewer.first_min) / (times - 1.0)) : 0.0;
        out->two = shared.first_min / shared.second_min;
    }
    bench_network_free(&one);
    bench_network_free(&few);
    bench_network_free(&two);
    return ok;
}

static bool measure_level(const bench_scene *subject, const bench_options *options, mspring_simd level) {
    const uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    const uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    const uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(springs);
    scene_error error = {"out of memory"};
    single one = {0};
    bool ok = measure_single(subject, level, substeps, repeat, &one, &error);
    // Those after the first that are not all used are the same.
    for (uint32_t workers = 2, used = 2; ok && workers <= 64 && 2 * used >= workers; workers *= 2) {
        ok = row_of(subject, options, level, workers, substeps, &one, &used);
    }
    if (!ok) {
        bench_complain(subject->label, &error);
    }
    return ok;
}

bool bench_run_cores(const bench_options *options) {
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_level(options, default_scenes, measure_level);
}
