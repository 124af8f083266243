/// @file solvers.c
/// What steps of the implicit and the direct solver cost: implicit ones of any scene, with workers; those of bars,
/// in substeps of the explicit solver, each measured in turn with it, and what that is worth for bars that bend
/// alike; and what 50 breaks cost the step that follows.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

#include "machine.h"
#include "modes.h"

/// A bar of 8-neighbour lattice with its first column pinned, and how far it bends under its weight.
typedef struct solvers_bar {
    const char *name;
    uint32_t columns, rows;
    double stiffness; ///< N/m
    double bending;   ///< m, in static equilibrium
} solvers_bar;

static const solvers_bar bars[] = {{"bar_80x5", 80, 5, 1e9, 1.42216},     {"bar_80x5", 80, 5, 1e10, 0.1422},
                                   {"bar_80x5", 80, 5, 1e12, 0.00142195}, {"bar_544x68", 544, 68, 1e9, 13.779},
                                   {"bar_544x68", 544, 68, 1e10, 1.3769}, {"bar_1800x5", 1800, 5, 1e9, 1775.7},
                                   {"bar_1800x5", 1800, 5, 1e13, 37.68}};

#define BAR_COUNT (sizeof bars / sizeof *bars)

/// kg of each particle.
#define BAR_MASS 73.3975

static const struct {
    const char *name;
    mspring_solver solver;
} solvers[] = {{"implicit", MSPRING_SOLVER_IMPLICIT}, {"direct", MSPRING_SOLVER_DIRECT}};

static const bench_column step_columns[] = {
    {"scene", "scene", -12},
    {"stiffness", "N/m", 6},
    {"bending", "bends by, m", 12},
    {"solver", "solver", -8},
    {"level", "level", -6},
    {"us_step_min", "us min", 10},
    {"us_step_median", "us median", 10},
    {"substeps", "substeps", 9},
    {"explicit_substeps", "explicit needs", 14},
    {"times_cheaper", "times cheaper", 13},
};
static const bench_column break_columns[] = {
    {"scene", "scene", -12},    {"level", "level", -6},
    {"us_step", "us step", 10}, {"us_after_breaks", "after 50 breaks", 15},
    {"us_more", "us more", 8},
};

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

/// Explicit substeps that a bar of this stiffness takes in a step, at half of what is stable: stiffness = 1/2 mu /
/// h^2, mu = m / 2.
static double explicit_substeps(double stiffness) {
    return ceil(BENCH_DT * sqrt(4 * stiffness / BAR_MASS));
}

static bool make_bar(const solvers_bar *bar, double stiffness, mspring_builder **builder, scene_error *error) {
    mspring_material iron[2];
    mspring_lattice_def def;
    uint16_t *cells = calloc((size_t)bar->columns * bar->rows, sizeof *cells);
    mspring_result result = mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def);
    for (int i = 0; i < 2 && result == MSPRING_OK; i++) {
        result = mspring_init(MSPRING_STRUCT_MATERIAL, &iron[i], sizeof iron[i]);
        iron[i].mass = (float)BAR_MASS;
        iron[i].stiffness = (float)stiffness;
    }
    iron[1].particle_flags = MSPRING_PARTICLE_PINNED;
    for (uint32_t row = 0; cells != NULL && row < bar->rows; row++) {
        cells[(size_t)row * bar->columns] = 1;
    }
    def.width = bar->columns;
    def.height = bar->rows;
    def.cells = cells;
    def.materials = iron;
    def.material_count = 2;
    *builder = NULL;
    if (result == MSPRING_OK) {
        result = mspring_builder_create(NULL, builder);
    }
    if (result == MSPRING_OK) {
        result = cells != NULL ? mspring_builder_add_lattice(*builder, &def, NULL) : MSPRING_ERROR_MEMORY;
    }
    free(cells);
    if (result == MSPRING_OK) {
        return true;
    }
    bench_library_error(error, "making a bar", result, mspring_builder_error(*builder));
    mspring_builder_destroy(*builder);
    return false;
}

static bool make_network(const solvers_bar *bar, double stiffness, mspring_simd level, uint32_t substeps,
                         mspring_solver solver, bench_network *out, scene_error *error) {
    mspring_builder *builder;
    if (!make_bar(bar, stiffness, &builder, error)) {
        return false;
    }
    const bool made = bench_network_create(builder, level, 1, substeps, out, error);
    mspring_builder_destroy(builder);
    if (!made) {
        return false;
    }
    mspring_settings settings = mspring_settings_default();
    mspring_result result = mspring_network_get_settings(out->network, &settings);
    settings.solver = solver;
    settings.substeps = substeps;
    if (result == MSPRING_OK) {
        result = mspring_network_set_settings(out->network, &settings);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "choosing the solver", result, mspring_network_error(out->network));
        bench_network_free(out);
        return false;
    }
    // From rest, as bars begin to bend: after kicks at random, at 1e10 N/m, the first steps take more iterations.
    memset(out->start_vx, 0, out->particle_count * sizeof *out->start_vx);
    memset(out->start_vy, 0, out->particle_count * sizeof *out->start_vy);
    return true;
}

static bool print_step(const solvers_bar *bar, const bench_options *options, size_t solver,
                       bench_network *explicit_one, mspring_simd level, scene_error *error) {
    bench_network network;
    bench_turns turns;
    if (!make_network(bar, bar->stiffness, level, 1, solvers[solver].solver, &network, error)) {
        return false;
    }
    const uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(network.spring_count);
    const bench_runner first = bench_network_runner(explicit_one), second = bench_network_runner(&network);
    const bool ok = bench_turns_measure(&first, &second, repeat, &turns, error);
    if (ok) {
        const double cost = turns.ratio_median * explicit_one->substeps;
        const bench_cell cells[] = {
            bench_cell_of("%s", bar->name),
            bench_cell_of("%.0e", bar->stiffness),
            bench_cell_of("%.5g", bar->bending),
            bench_cell_of("%s", solvers[solver].name),
            bench_cell_of("%s", mspring_simd_name(bench_level_of(network.network))),
            bench_cell_of("%.2f", 1e6 * turns.second_min),
            bench_cell_of("%.2f", 1e6 * turns.second_median),
            bench_cell_of("%.1f", cost),
            bench_cell_of("%.0f", explicit_substeps(bar->stiffness)),
            bench_cell_of("%.1f", explicit_substeps(bar->stiffness) / cost),
        };
        bench_table_row(options->format, step_columns, COUNT(step_columns), cells);
    }
    bench_network_free(&network);
    return ok;
}

static bool print_steps(const solvers_bar *bar, const bench_options *options, mspring_simd level,
                        scene_error *error) {
    // At any stiffness its substeps cost the same: at one of which 40 are stable.
    const uint32_t substeps = options->substeps > 0 ? options->substeps : 40;
    bench_network explicit_one;
    const double h = BENCH_DT / substeps, stable = 0.25 * BAR_MASS / (h * h);
    if (!make_network(bar, stable, level, substeps, MSPRING_SOLVER_EXPLICIT, &explicit_one, error)) {
        return false;
    }
    bool ok = true;
    for (size_t solver = 0; solver < COUNT(solvers) && ok; solver++) {
        ok = print_step(bar, options, solver, &explicit_one, level, error);
    }
    bench_network_free(&explicit_one);
    return ok;
}

/* ------------------------------------------------------------------------------------------------------- breaks */

static bool timed_step(bench_network *network, double *seconds, scene_error *error) {
    const bench_runner runner = bench_network_runner(network);
    const double start = bench_seconds();
    const bool ok = runner.run(network, 1, error);
    *seconds = bench_seconds() - start;
    return ok;
}

// A step as any, a step after 50 springs all over the bar broke, and one after they were restored, again and again.
static bool time_breaks(bench_network *network, uint32_t repeat, double *plain, double *after, scene_error *error) {
    enum { BREAKS = 50 };
    uint64_t seed = 7;
    double ignored;
    for (uint32_t i = 0; i < repeat; i++) {
        mspring_id springs[BREAKS];
        for (int n = 0; n < BREAKS; n++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            springs[n] = (mspring_id)((seed >> 33) % network->spring_count);
        }
        if (!timed_step(network, &plain[i], error) ||
            mspring_network_break_springs(network->network, springs, 0, BREAKS) != MSPRING_OK ||
            !timed_step(network, &after[i], error) ||
            mspring_network_restore_springs(network->network, springs, 0, BREAKS, 0) != MSPRING_OK ||
            !timed_step(network, &ignored, error)) {
            return false;
        }
    }
    return true;
}

static bool print_breaks(const solvers_bar *bar, const bench_options *options, mspring_simd level,
                         scene_error *error) {
    const uint32_t repeat = options->repeat > 0 ? 4 * options->repeat : 100;
    bench_network network;
    if (!make_network(bar, bar->stiffness, level, 1, MSPRING_SOLVER_IMPLICIT, &network, error)) {
        return false;
    }
    double *plain = bench_allocate(repeat, sizeof *plain, error);
    double *after = bench_allocate(repeat, sizeof *after, error);
    const bool ok = plain != NULL && after != NULL && time_breaks(&network, repeat, plain, after, error);
    if (ok) {
        const double usual = bench_median(plain, repeat), then = bench_median(after, repeat);
        const bench_cell cells[] = {
            bench_cell_of("%s", bar->name),
            bench_cell_of("%s", mspring_simd_name(bench_level_of(network.network))),
            bench_cell_of("%.1f", 1e6 * usual),
            bench_cell_of("%.1f", 1e6 * then),
            bench_cell_of("%.1f", 1e6 * (then - usual)),
        };
        bench_table_row(options->format, break_columns, COUNT(break_columns), cells);
    }
    free(plain);
    free(after);
    bench_network_free(&network);
    return ok;
}

/* --------------------------------------------------------------------------------------------------- the tables */

typedef bool (*print_fn)(const solvers_bar *bar, const bench_options *options, mspring_simd level,
                         scene_error *error);

// Whether the command line asks for this bar: by its name, or by none.
static bool is_wanted(const solvers_bar *bar, const bench_options *options) {
    bool wanted = options->scene_count == 0 && options->network == NULL;
    for (int i = 0; i < options->scene_count; i++) {
        wanted = wanted || strcmp(options->scenes[i], bar->name) == 0;
    }
    return wanted;
}

static bool print_table(const bench_options *options, print_fn print, bool one_each) {
    mspring_simd levels[4];
    scene_error error;
    const int count = bench_options_levels(options, levels, &error);
    bool ok = true;
    for (size_t i = 0; i < BAR_COUNT; i++) {
        if (!is_wanted(&bars[i], options) || (one_each && i > 0 && bars[i].columns == bars[i - 1].columns)) {
            continue;
        }
        for (int level = 0; level < count; level++) {
            if (!print(&bars[i], options, levels[level], &error)) {
                bench_complain(bars[i].name, &error);
                ok = false;
            }
        }
    }
    return ok;
}

bool bench_run_solvers(const bench_options *options) {
    bench_table_preamble(options->format);
    bool ok = bench_print_implicit(options), any = false;
    for (size_t i = 0; i < BAR_COUNT; i++) {
        any = any || is_wanted(&bars[i], options);
    }
    if (!any) {
        return ok;
    }
    putchar('\n');
    bench_table_head(options->format, step_columns, COUNT(step_columns));
    ok = print_table(options, print_steps, false) && ok;
    putchar('\n');
    bench_table_head(options->format, break_columns, COUNT(break_columns));
    return print_table(options, print_breaks, true) && ok;
}
