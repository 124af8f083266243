/// @file workers.c
/// What workers gain: one network that several of them step, in turn with the same network stepped by one, with
/// the same stepped by independent tasks of a host, and with as many networks apart, each stepped by a thread of
/// its own. The last is what the machine has to give at that moment: where others use its cores, workers can't be
/// faster than threads that share nothing.
///
/// SPDX-License-Identifier: MIT
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include <massspring/massspring.h>

#include "modes.h"
#include "tasks/pool.h"

static const char *const default_scenes[] = {"bar_80x5",      "grid_48x48",   "grid_64x64",
                                             "grid_96x96",    "bar_544x68",   "ship",
                                             "ship_ropes_40", "graph_100000", NULL};

static const bench_column columns[] = {
    {"scene", "scene", -16},
    {"springs", "springs", 8},
    {"substeps", "substeps", 8},
    {"level", "level", -6},
    {"workers", "workers", 7},
    {"us_per_step_one", "us/step, one", 12},
    {"gain_median", "gain, median", 12},
    {"gain_best", "gain, best", 10},
    {"gain_apart_median", "apart, median", 13},
    {"gain_apart_best", "apart, best", 11},
    {"gain_over_apart_median", "gain/apart", 10},
    {"gain_tasks_median", "tasks, median", 13},
    {"gain_tasks_best", "tasks, best", 11},
    {"tasks_over_gain_median", "tasks/gain", 10},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

/// One of the networks apart, and what became of it.
typedef struct lane {
    bench_network network;
    pthread_t thread;
    uint32_t steps;
    bool ok;
    scene_error error;
} lane;

typedef struct apart {
    lane *lanes;
    uint32_t count;
} apart;

static void *run_lane(void *argument) {
    lane *self = argument;
    self->ok = bench_network_runner(&self->network).run(&self->network, self->steps, &self->error);
    return NULL;
}

/// Every network takes so many steps: in all count times as many.
static bool run_apart(void *argument, uint32_t steps, scene_error *error) {
    apart *self = argument;
    uint32_t started = 1;
    for (uint32_t i = 0; i < self->count; i++) {
        self->lanes[i].steps = steps;
    }
    while (started < self->count &&
           pthread_create(&self->lanes[started].thread, NULL, run_lane, &self->lanes[started]) == 0) {
        started++;
    }
    run_lane(&self->lanes[0]);
    bool ok = started == self->count;
    if (!ok) {
        snprintf(error->text, sizeof error->text, "only %u of %u threads could be started", started, self->count);
    }
    for (uint32_t i = 0; i < started; i++) {
        if (i > 0) {
            pthread_join(self->lanes[i].thread, NULL);
        }
        if (!self->lanes[i].ok) {
            *error = self->lanes[i].error;
            ok = false;
        }
    }
    return ok;
}

static bool reset_apart(void *argument, scene_error *error) {
    apart *self = argument;
    bool ok = true;
    for (uint32_t i = 0; ok && i < self->count; i++) {
        ok = bench_network_runner(&self->lanes[i].network).reset(&self->lanes[i].network, error);
    }
    return ok;
}

static void free_apart(apart *self) {
    for (uint32_t i = 0; i < self->count; i++) {
        bench_network_free(&self->lanes[i].network);
    }
    free(self->lanes);
}

static bool create_apart(mspring_builder *builder, mspring_simd level, uint32_t substeps, uint32_t count,
                         apart *out, scene_error *error) {
    apart made = {.lanes = calloc(count, sizeof *made.lanes)};
    if (made.lanes == NULL) {
        snprintf(error->text, sizeof error->text, "out of memory for %u networks", count);
        return false;
    }
    for (; made.count < count; made.count++) {
        if (!bench_network_create(builder, level, 1, substeps, &made.lanes[made.count].network, error)) {
            free_apart(&made);
            return false;
        }
    }
    *out = made;
    return true;
}

/// A host that promises independent tasks only, with threads that look for work for a while before they sleep.
typedef struct host {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_pool *pool;
    mspring_tasks tasks;
} host;

static void MSPRING_CALL run_tasks(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    mspringi_pool_run(((host *)user)->pool, count, fn, argument);
}

static bool create_host(uint32_t workers, host *out, scene_error *error) {
    if (mspring_init(MSPRING_STRUCT_TASKS, &out->tasks, sizeof out->tasks) != MSPRING_OK ||
        mspringi_memory_init(&out->memory, NULL, &out->message) != MSPRING_OK ||
        mspringi_pool_create(workers, &out->memory, &out->message, &out->pool) != MSPRING_OK) {
        snprintf(error->text, sizeof error->text, "no threads for %u workers", workers);
        return false;
    }
    out->tasks.worker_count = workers;
    out->tasks.run = run_tasks;
    out->tasks.user = out;
    return true;
}

/// The four of them.
typedef struct contest {
    bench_network one, shared, independent;
    apart apart;
    host host;
    double one_median;
    double gain_median, gain_best, apart_median, apart_best, of_apart;
    double tasks_median, tasks_best, of_gain;
} contest;

/// Pair by pair: what is compared is measured in turn.
static bool measure(contest *c, uint32_t repeat, scene_error *error) {
    const bench_runner one = bench_network_runner(&c->one), shared = bench_network_runner(&c->shared);
    const bench_runner independent = bench_network_runner(&c->independent);
    const bench_runner lanes = {.self = &c->apart, .reset = reset_apart, .run = run_apart};
    const double count = c->apart.count;
    bench_turns gain, machine, share, tasks, loss;
    if (!bench_turns_measure(&one, &shared, repeat, &gain, error) ||
        !bench_turns_measure(&one, &lanes, repeat, &machine, error) ||
        !bench_turns_measure(&shared, &lanes, repeat, &share, error) ||
        !bench_turns_measure(&one, &independent, repeat, &tasks, error) ||
        !bench_turns_measure(&shared, &independent, repeat, &loss, error)) {
        return false;
    }
    c->one_median = gain.first_median;
    c->gain_median = 1.0 / gain.ratio_median;
    c->gain_best = gain.first_min / gain.second_min;
    c->apart_median = count / machine.ratio_median;
    c->apart_best = count * machine.first_min / machine.second_min;
    c->of_apart = share.ratio_median / count;
    c->tasks_median = 1.0 / tasks.ratio_median;
    c->tasks_best = tasks.first_min / tasks.second_min;
    c->of_gain = 1.0 / loss.ratio_median;
    return true;
}

static void print_row(const bench_options *options, const bench_scene *subject, const contest *c) {
    const bench_cell cells[COLUMN_COUNT] = {
        bench_cell_of("%s", subject->label),
        bench_cell_of("%u", c->one.spring_count),
        bench_cell_of("%u", c->one.substeps),
        bench_cell_of("%s", mspring_simd_name(bench_level_of(c->one.network))),
        bench_cell_of("%u", c->apart.count),
        bench_cell_of("%.3f", 1e6 * c->one_median),
        bench_cell_of("%.2f", c->gain_median),
        bench_cell_of("%.2f", c->gain_best),
        bench_cell_of("%.2f", c->apart_median),
        bench_cell_of("%.2f", c->apart_best),
        bench_cell_of("%.2f", c->of_apart),
        bench_cell_of("%.2f", c->tasks_median),
        bench_cell_of("%.2f", c->tasks_best),
        bench_cell_of("%.2f", c->of_gain),
    };
    bench_table_row(options->format, columns, COLUMN_COUNT, cells);
}

static bool measure_level(const bench_scene *subject, const bench_options *options, mspring_simd level) {
    const uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    const uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    const uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(springs);
    const uint32_t workers = options->workers > 1 ? options->workers : 2;
    mspring_builder *builder = subject->made.builder;
    contest c = {.one_median = 0};
    scene_error error;
    bool ok = bench_network_create(builder, level, 1, substeps, &c.one, &error) &&
              bench_network_create(builder, level, workers, substeps, &c.shared, &error) &&
              create_host(workers, &c.host, &error) &&
              bench_network_create_on(builder, level, &c.host.tasks, substeps, &c.independent, &error) &&
              create_apart(builder, level, substeps, workers, &c.apart, &error) && measure(&c, repeat, &error) &&
              bench_network_check(&c.one, &error) && bench_network_check(&c.shared, &error) &&
              bench_network_check(&c.independent, &error);
    if (ok) {
        print_row(options, subject, &c);
    } else {
        bench_complain(subject->label, &error);
    }
    free_apart(&c.apart);
    bench_network_free(&c.independent);
    mspringi_pool_destroy(c.host.pool, &c.host.memory);
    bench_network_free(&c.shared);
    bench_network_free(&c.one);
    return ok;
}

bool bench_run_workers(const bench_options *options) {
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_level(options, default_scenes, measure_level);
}
