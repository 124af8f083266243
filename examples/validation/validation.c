/// @file validation.c
/// Physics against closed forms: a table, and a picture of how errors fall as networks become finer.
///
///     validation [--out FOLDER]
///
/// Ends with 1 if the finest network of a problem misses its answer by more than the tolerance in the list below.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/output.h"
#include "draw/scatter.h"
#include "validation/cases.h"

// Tolerances are about twice what is left at the finest size.
static const physics_case cases[] = {
    {"spring and mass, period", "s", "substeps a period", {8, 16, 32, 64}, oscillator_period, 1e-3},
    {"pendulum let go at 90 degrees, period",
     "s",
     "steps a second",
     {1024, 2048, 4096, 8192},
     pendulum_period,
     5e-5},
    {"wave in a row of springs, period", "s", "springs", {10, 20, 40, 80}, wave_period, 1.5e-4},
    {"elastic cable, sag", "m", "links", {10, 20, 40, 80}, catenary_sag, 1.5e-4},
    {"cantilever, sag", "m", "cells in height", {2, 4, 8, 16}, cantilever_sag, 3e-3},
    {"cantilever, first period", "s", "cells in height", {2, 4, 8, 16}, cantilever_first_period, 2e-3},
    {"cantilever, second period", "s", "cells in height", {2, 4, 8, 16}, cantilever_second_period, 3e-3},
    {"column, gravity that buckles it", "m/s^2", "cells in height", {2, 4, 8, 16}, column_buckling_load, 1.5e-3},
    {"impact of equal bars, restitution", "", "columns", {20, 40, 80, 160}, impact_of_equal_bars, 0.03},
    {"the same, one twice as long", "", "columns", {20, 40, 80, 160}, impact_of_unequal_bars, 0.01},
    {"cantilever, sag of a continuum", "m", "cells in height", {2, 4, 8, 16}, cantilever_sag_of_continuum, 0.25},
};
enum { CASES = sizeof cases / sizeof *cases };

static const draw_colour colours[] = {0x2f7fd6, 0xe07b10, 0x1b3a8f, 0xc0392b, 0x2e9e5b, 0x8b5fbf};
enum { COLOURS = sizeof colours / sizeof *colours };
static const scatter_mark marks[] = {SCATTER_DISC, SCATTER_SQUARE, SCATTER_DIAMOND};

// Fill the points of one problem, print its lines, and return whether its finest network is near enough.
static bool run(const physics_case *problem, scatter_point points[CASE_SIZES]) {
    double error = 0;
    for (int i = 0; i < CASE_SIZES; i++) {
        const outcome found = problem->run(problem->sizes[i]);
        error = found.computed / found.exact - 1;
        printf("%-38s %5u %-17s  %12.6g %12.6g %-5s  %+9.4f %%\n", i == 0 ? problem->name : "",
               (unsigned)problem->sizes[i], problem->size_name, found.computed, found.exact, problem->unit,
               100 * error);
        points[i] = (scatter_point){.x = problem->sizes[i] / problem->sizes[0], .y = fabs(error)};
    }
    if (fabs(error) <= problem->tolerance)
        return true;
    fprintf(stderr, "%s: %g %% off, more than %g %%\n", problem->name, 100 * error, 100 * problem->tolerance);
    return false;
}

static bool draw(scatter_point points[CASES][CASE_SIZES], const char *folder) {
    scatter_series series[CASES];
    figure drawn;
    figure_start(&drawn, 800, 640, 0xffffff);
    for (size_t i = 0; i < CASES; i++)
        series[i] = (scatter_series){.points = points[i],
                                     .count = CASE_SIZES,
                                     .mark = marks[i / COLOURS],
                                     .colour = colours[i % COLOURS],
                                     .name = cases[i].name,
                                     .joined = true};
    scatter_draw(&drawn,
                 &(scatter){.title = "Errors against closed forms",
                            .x_label = "times as fine as the coarsest network",
                            .y_label = "error",
                            .series = series,
                            .series_count = CASES,
                            .percent = true},
                 0, 0, 800, 640);
    const bool good = output_figure(&drawn, folder, "validation");
    figure_free(&drawn);
    return good;
}

int main(int count, char **arguments) {
    static scatter_point points[CASES][CASE_SIZES];
    int exit_code = EXIT_SUCCESS;
    const char *folder =
        output_folder_from_arguments(count, arguments, "Physics against closed forms.", &exit_code);
    if (!folder)
        return exit_code;
    printf("%-38s %-24s %12s %12s\n", "problem", "size", "computed", "exact");
    size_t good = 0;
    for (size_t i = 0; i < CASES; i++)
        good += run(&cases[i], points[i]);
    printf("%u of %u within their tolerances\n", (unsigned)good, (unsigned)CASES);
    return draw(points, folder) && good == CASES ? EXIT_SUCCESS : EXIT_FAILURE;
}
