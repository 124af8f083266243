/// @file scenes.c
/// Scenes against the naive step: the bench's main table.
///
/// SPDX-License-Identifier: MIT
#include "modes.h"

#include <massspring/massspring.h>

static const bench_column columns[] = {
    {"scene", "scene", -22},
    {"particles", "particles", 9},
    {"springs", "springs", 9},
    {"solver", NULL, 0},
    {"substeps", "substeps", 8},
    {"level", "level", -6},
    {"threads", NULL, 0},
    {"us_per_step_min", "us/step min", 11},
    {"us_per_step_median", "us/step median", 14},
    {"ns_per_spring_substep_median", "ns/spring", 9},
    {NULL, "naive ns", 8},
    {"baseline_ratio_median", "ratio", 6},
    {"bytes_per_particle", "B/particle", 10},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

static bool visit(const bench_scene *subject, const bench_options *options, void *user) {
    (void)user;
    mspring_simd levels[4];
    scene_error error;
    int count = bench_options_levels(options, levels, &error);
    for (int i = 0; i < count; i++) {
        bench_measurement result;
        if (!bench_measure(subject, options, levels[i], &result, &error)) {
            bench_complain(subject->label, &error);
            return false;
        }
        double springs = (double)result.springs * result.substeps;
        const bench_cell cells[COLUMN_COUNT] = {
            bench_cell_of("%s", subject->label),
            bench_cell_of("%u", result.particles),
            bench_cell_of("%u", result.springs),
            bench_cell_of("explicit"),
            bench_cell_of("%u", result.substeps),
            bench_cell_of("%s", mspring_simd_name(result.level)),
            bench_cell_of("%u", options->workers),
            bench_cell_of("%.3f", 1e6 * result.turns.first_min),
            bench_cell_of("%.3f", 1e6 * result.turns.first_median),
            bench_cell_of("%.4f", result.ns),
            bench_cell_of("%.4f", 1e9 * result.turns.second_median / springs),
            bench_cell_of("%.2f", result.turns.ratio_median),
            bench_cell_of("%.1f", result.bytes_per_particle),
        };
        bench_table_row(options->format, columns, COLUMN_COUNT, cells);
    }
    return true;
}

bool bench_run_scenes(const bench_options *options) {
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_scene(options, bench_catalogue_quick(), visit, NULL);
}
