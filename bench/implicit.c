/// @file implicit.c
/// What a step of the implicit solver costs: in substeps of the explicit one, measured in turn on the same network
/// with one worker each; and, with --threads, how much faster several workers are than one.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for mspring_network_describe()
#include <massspring/massspring.h>
#include <stdio.h>

#include "common/described.h"
#include "modes.h"

static const char *const default_scenes[] = {"bar_80x5", "bar_544x68", "ship", "bar_1800x5", NULL};

static const bench_column columns[] = {
    {"scene", "scene", -16},
    {"springs", "springs", 8},
    {"level", "level", -6},
    {"iterations", "iterations", 10},
    {"tiles", "tiles", 6},
    {"us_per_step_min", "us/step min", 12},
    {"us_per_step_median", "us/step median", 14},
    {"substeps_min", "substeps min", 12},
    {"substeps_median", "substeps", 9},
    {"workers", "workers", 7},
    {"speedup_min", "speedup min", 11},
    {"speedup_median", "speedup", 8},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

/// A network with an implicit solver.
static bool create(const bench_scene *subject, mspring_simd level, uint32_t workers, bench_network *out,
                   scene_error *error) {
    if (!bench_network_create(subject->made.builder, level, workers, 1, out, error)) {
        return false;
    }
    mspring_settings settings = mspring_settings_default();
    mspring_result result = mspring_network_get_settings(out->network, &settings);
    settings.solver = MSPRING_SOLVER_IMPLICIT;
    settings.substeps = MSPRING_SUBSTEPS_AUTO;
    settings.residual = 0; // as many iterations in each step
    if (result == MSPRING_OK) {
        result = mspring_network_set_settings(out->network, &settings);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "setting the solver", result, mspring_network_error(out->network));
        bench_network_free(out);
    }
    return result == MSPRING_OK;
}

static bool measure(const bench_scene *subject, const bench_options *options, bench_network *by_substeps,
                    bench_network *alone, bench_network *shared, scene_error *error) {
    const uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(alone->spring_count);
    const bench_runner substeps = bench_network_runner(by_substeps), one = bench_network_runner(alone),
                       several = bench_network_runner(shared);
    bench_turns cost, gain;
    if (!bench_turns_measure(&substeps, &one, repeat, &cost, error) ||
        !bench_turns_measure(&several, &one, repeat, &gain, error) || !bench_network_check(shared, error)) {
        return false;
    }
    char plan[DESCRIBED_SIZE];
    mspring_network_info info = mspring_network_info_default();
    mspring_result result = mspring_network_describe(alone->network, plan, sizeof plan, NULL);
    if (result == MSPRING_OK) {
        result = mspring_network_get_info(shared->network, &info);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "asking for the plan", result, "");
        return false;
    }
    const bench_cell cells[COLUMN_COUNT] = {
        bench_cell_of("%s", subject->label),
        bench_cell_of("%u", alone->spring_count),
        bench_cell_of("%s", mspring_simd_name(bench_level_of(alone->network))),
        bench_cell_of("%.0f", described_number(plan, "iterations")),
        bench_cell_of("%.0f", described_number(plan, "tile_count")),
        bench_cell_of("%.1f", 1e6 * cost.second_min),
        bench_cell_of("%.1f", 1e6 * cost.second_median),
        bench_cell_of("%.1f", cost.second_min / cost.first_min * by_substeps->substeps),
        bench_cell_of("%.1f", cost.ratio_median * by_substeps->substeps),
        bench_cell_of("%u", info.worker_count),
        bench_cell_of("%.2f", gain.second_min / gain.first_min),
        bench_cell_of("%.2f", gain.ratio_median),
    };
    bench_table_row(options->format, columns, COLUMN_COUNT, cells);
    return true;
}

static bool measure_level(const bench_scene *subject, const bench_options *options, mspring_simd level) {
    const uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    const uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    bench_network networks[3] = {{0}};
    scene_error error;
    const bool ok = bench_network_create(subject->made.builder, level, 1, substeps, &networks[0], &error) &&
                    create(subject, level, 1, &networks[1], &error) &&
                    create(subject, level, options->workers, &networks[2], &error) &&
                    measure(subject, options, &networks[0], &networks[1], &networks[2], &error);
    if (!ok) {
        bench_complain(subject->label, &error);
    }
    for (int i = 0; i < 3; i++) {
        bench_network_free(&networks[i]);
    }
    return ok;
}

bool bench_print_implicit(const bench_options *options) {
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_level(options, default_scenes, measure_level);
}
