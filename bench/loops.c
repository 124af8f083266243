/// @file loops.c
/// The library beside other ways to write the loop of a step (loops.h): where a ratio to the naive step says
/// little.
///
/// SPDX-License-Identifier: MIT
#include "loops.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "modes.h"

#include <massspring/massspring.h>

static const bench_loop *const loops[] = {
    &bench_rectangle,
#ifdef BENCH_X86
    &bench_squares,
#endif
};
enum { LOOPS = sizeof loops / sizeof *loops };

static const bench_column columns[] = {
    {"scene", "scene", -16},
    {"springs", "springs", 9},
    {"loop", "loop", -10},
    {"ns_per_spring_substep_median", "ns/spring", 9},
    {"apart_after_a_step", "apart after a step, m", 21},
    {"level", "ours at", -7},
    {"ours_ns_per_spring_substep_median", "ns/spring", 9},
    {"ratio_median", "loop/ours", 9},
};
#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

static double side_of(const naive_network *network) {
    double side = INFINITY;
    for (uint32_t i = 0; i < network->spring_count; i++)
        side = fmin(side, (double)network->springs[i].rest_length);
    return side;
}

// Put particles to the places of a grid whose side is the shortest spring. What lies between places, such as the
// middle of a rope, has none.
static bool find_grid(const naive_network *network, bench_grid *out) {
    const double side = side_of(network);
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
    for (uint32_t i = 0; i < network->particle_count; i++) {
        low_x = fmin(low_x, (double)network->particles[i].x);
        low_y = fmin(low_y, (double)network->particles[i].y);
        high_x = fmax(high_x, (double)network->particles[i].x);
        high_y = fmax(high_y, (double)network->particles[i].y);
    }
    const double most = 1e8, width = (high_x - low_x) / side + 1.5, height = (high_y - low_y) / side + 1.5;
    if (!(width * height < most))
        return false;
    *out = (bench_grid){.columns = (uint32_t)width, .rows = (uint32_t)height};
    out->place = malloc((size_t)out->columns * out->rows * sizeof *out->place);
    for (size_t i = 0; out->place && i < (size_t)out->columns * out->rows; i++)
        out->place[i] = BENCH_NOBODY;
    for (uint32_t i = 0; out->place && i < network->particle_count; i++) {
        const double x = ((double)network->particles[i].x - low_x) / side,
                     y = ((double)network->particles[i].y - low_y) / side;
        if (fabs(x - round(x)) < 0.01 && fabs(y - round(y)) < 0.01)
            out->place[(size_t)round(y) * out->columns + (size_t)round(x)] = i;
    }
    return out->place != NULL;
}

/// A loop, and the naive network that it starts from.
typedef struct running {
    const bench_loop *loop;
    void *state;
    bench_baseline *from;
} running;

static bool reset(void *self, scene_error *error) {
    const running *r = self;
    (void)error;
    r->loop->reset(r->state, &r->from->network);
    return true;
}

static bool run(void *self, uint32_t steps, scene_error *error) {
    const running *r = self;
    (void)error;
    for (uint32_t i = 0; i < steps; i++)
        r->loop->step(r->state, &r->from->network, BENCH_DT, r->from->substeps);
    return true;
}

// The largest distance of a particle from where the naive step has it after one step.
static double apart(const running *r) {
    scene_error error;
    const bench_runner naive = bench_baseline_runner(r->from);
    double most = NAN;
    if (naive.reset(r->from, &error) && reset((void *)r, &error) && run((void *)r, 1, &error) &&
        naive.run(r->from, 1, &error)) {
        most = 0;
        for (uint32_t i = 0; i < r->from->network.particle_count; i++) {
            float x, y;
            r->loop->get(r->state, i, &x, &y);
            most = fmax(most, hypot((double)x - (double)r->from->network.particles[i].x,
                                    (double)y - (double)r->from->network.particles[i].y));
        }
    }
    naive.reset(r->from, &error);
    return most;
}

static bool measure_loop(const bench_scene *subject, const bench_options *options, bench_network *ours,
                         bench_baseline *baseline, const bench_grid *grid, const bench_loop *loop,
                         scene_error *error) {
    running r = {loop, malloc(loop->size), baseline};
    if (!r.state || !loop->begin(r.state, &baseline->network, grid)) {
        free(r.state);
        return true; // not one of those that it is for
    }
    const bench_runner first = bench_network_runner(ours), second = {&r, reset, run};
    const uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(ours->spring_count);
    const double substeps = (double)ours->spring_count * ours->substeps, distance = apart(&r);
    bench_turns turns;
    const bool good = bench_turns_measure(&first, &second, repeat, &turns, error);
    if (good) {
        const bench_cell cells[COLUMN_COUNT] = {
            bench_cell_of("%s", subject->label),
            bench_cell_of("%u", ours->spring_count),
            bench_cell_of("%s", loop->name),
            bench_cell_of("%.3f", 1e9 * turns.second_median / substeps),
            bench_cell_of("%.1e", distance),
            bench_cell_of("%s", mspring_simd_name(bench_level_of(ours->network))),
            bench_cell_of("%.3f", 1e9 * turns.first_median / substeps),
            bench_cell_of("%.2f", turns.ratio_median),
        };
        bench_table_row(options->format, columns, COLUMN_COUNT, cells);
    }
    loop->end(r.state);
    free(r.state);
    return good;
}

static bool measure(const bench_scene *subject, const bench_options *options, mspring_simd level) {
    bench_network ours;
    bench_baseline baseline;
    bench_grid grid = {0};
    scene_error error = {"no grid is found in it"};
    const uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    const uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    if (!bench_network_create(subject->made.builder, level, 1, substeps, &ours, &error)) {
        bench_complain(subject->label, &error);
        return false;
    }
    bool good = bench_baseline_create(&ours, &baseline, &error);
    if (good) {
        good = bench_baseline_runner(&baseline).reset(&baseline, &error) && find_grid(&baseline.network, &grid);
        for (int i = 0; good && i < LOOPS; i++)
            good = measure_loop(subject, options, &ours, &baseline, &grid, loops[i], &error);
        free(grid.place);
        bench_baseline_free(&baseline);
    }
    if (!good)
        bench_complain(subject->label, &error);
    bench_network_free(&ours);
    return good;
}

bool bench_run_loops(const bench_options *options) {
    static const char *const scenes[] = {"bar_80x5", "grid_96x96", "bar_544x68", "ship", NULL};
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_level(options, scenes, measure);
}
