/// @file map.c
/// The map of stability: every network of scenes/extremes.h with every solver and dt, and where its explicit border
/// is.
///
/// SPDX-License-Identifier: MIT
#include "map.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "map_cases.h"
#include "modes.h"

/// Cases that must not be, each of which is told.
static uint32_t wrong_of(const uint32_t *outcomes) {
    return outcomes[EXTREME_NOT_FINITE] + outcomes[EXTREME_DIVERGED] + outcomes[EXTREME_FAILED];
}

/* ---------------------------------------------------------------------------------------------------- running */

static void complain(const extreme_network *network, uint32_t way, uint32_t dt, const char *text) {
    fprintf(stderr, "%s, %s, %g N/m, %g s, ratio %u, damper %u, spacing %u, place %u: %s\n",
            extreme_shape_name(network->shape), extreme_way_of(way).name, extreme_stiffness(network->stiffness),
            extreme_dt(dt), network->ratio, network->damper, network->spacing, network->place, text);
}

static void run_all(map *all) {
    for (uint32_t number = 0; number < EXTREME_NETWORKS; number++) {
        const extreme_network network = extreme_network_of(number);
        for (uint32_t way = 0; way < EXTREME_WAYS; way++) {
            for (uint32_t dt = 0; dt < EXTREME_STEPS; dt++) {
                char text[512] = "";
                const extreme_outcome outcome =
                    extreme_run(&network, extreme_way_of(way), extreme_dt(dt), text, sizeof text);
                all->outcomes[network.shape][way][network.stiffness][dt][outcome]++;
                if (outcome > EXTREME_REFUSED)
                    complain(&network, way, dt, text);
            }
        }
        all->border[number] = extreme_border(&network);
    }
}

/* --------------------------------------------------------------------------------------------------- printing */

static const bench_column outcome_columns[] = {
    {"shape", "shape", -12},          {"solver", "solver", -8},    {"cases", "cases", 8},
    {"stable", "stable", 8},          {"guarded", "guarded", 8},   {"refused", "refused", 8},
    {"not_finite", "not finite", 10}, {"diverged", "diverged", 8}, {"failed", "failed", 6},
};
static const bench_column border_columns[] = {
    {"shape", "shape", -12},        {"networks", "networks", 8}, {"border_least", "least", 8},
    {"border_median", "median", 8}, {"border_most", "most", 8},  {"outside", "outside", 8},
};
enum {
    OUTCOME_COLUMNS = sizeof outcome_columns / sizeof *outcome_columns,
    BORDER_COLUMNS = sizeof border_columns / sizeof *border_columns
};

static void print_outcomes(bench_format format, const char *shape, const char *solver, const uint32_t *sum) {
    uint32_t cases = 0;
    for (int i = 0; i < EXTREME_OUTCOMES; i++)
        cases += sum[i];
    bench_cell cells[OUTCOME_COLUMNS] = {bench_cell_of("%s", shape), bench_cell_of("%s", solver),
                                         bench_cell_of("%u", cases)};
    for (int i = 0; i < EXTREME_OUTCOMES; i++)
        cells[OUTCOME_COLUMNS - EXTREME_OUTCOMES + i] = bench_cell_of("%u", sum[i]);
    bench_table_row(format, outcome_columns, OUTCOME_COLUMNS, cells);
}

static void add(uint32_t *sum, const uint32_t *more) {
    for (int i = 0; i < EXTREME_OUTCOMES; i++)
        sum[i] += more[i];
}

/// @return how many cases are what they must not be
static uint32_t print_all_outcomes(bench_format format, const map *all) {
    uint32_t whole[EXTREME_OUTCOMES] = {0};
    bench_table_head(format, outcome_columns, OUTCOME_COLUMNS);
    for (int shape = 0; shape < EXTREME_SHAPES; shape++) {
        for (uint32_t way = 0; way < EXTREME_WAYS; way++) {
            uint32_t sum[EXTREME_OUTCOMES] = {0};
            for (int k = 0; k < EXTREME_STIFFNESSES; k++)
                for (int dt = 0; dt < EXTREME_STEPS; dt++)
                    add(sum, all->outcomes[shape][way][k][dt]);
            print_outcomes(format, extreme_shape_name((extreme_shape)shape), extreme_way_of(way).name, sum);
            add(whole, sum);
        }
    }
    print_outcomes(format, "all", "", whole);
    return wrong_of(whole);
}

static int compare(const void *a, const void *b) {
    const double first = *(const double *)a, second = *(const double *)b;
    return first < second ? -1 : first > second;
}

/// @return how many borders are further off than they must be
static uint32_t print_borders(bench_format format, const map *all) {
    uint32_t outside_all = 0;
    bench_table_head(format, border_columns, BORDER_COLUMNS);
    for (int shape = 0; shape < EXTREME_SHAPES; shape++) {
        double found[EXTREME_NETWORKS];
        uint32_t count = 0, outside = 0;
        for (uint32_t number = 0; number < EXTREME_NETWORKS; number++)
            if ((int)extreme_network_of(number).shape == shape && all->border[number] > 0)
                found[count++] = all->border[number];
        if (count == 0)
            continue;
        qsort(found, count, sizeof *found, compare);
        for (uint32_t i = 0; i < count; i++)
            outside += fabs(found[i] - 1) > extreme_border_within((extreme_shape)shape);
        const bench_cell cells[BORDER_COLUMNS] = {
            bench_cell_of("%s", extreme_shape_name((extreme_shape)shape)),
            bench_cell_of("%u", count),
            bench_cell_of("%.4f", found[0]),
            bench_cell_of("%.4f", found[count / 2]),
            bench_cell_of("%.4f", found[count - 1]),
            bench_cell_of("%u", outside),
        };
        bench_table_row(format, border_columns, BORDER_COLUMNS, cells);
        outside_all += outside;
    }
    return outside_all;
}

static bool draw(const map *all, const char *folder) {
    char outcomes[1024], borders[1024];
    draw_error error = {""};
    snprintf(outcomes, sizeof outcomes, "%s/stability_outcomes.svg", folder);
    snprintf(borders, sizeof borders, "%s/stability_borders.svg", folder);
    const bool drawn = map_draw_outcomes(all, outcomes, &error) && map_draw_borders(all, borders, &error);
    if (!drawn)
        fprintf(stderr, "massspring-bench: %s\n", error.text);
    return drawn;
}

/// Networks at the extremes: what becomes of them, and their borders.
static bool map_extremes(const bench_options *options) {
    map *all = calloc(1, sizeof *all);
    if (all == NULL) {
        fprintf(stderr, "massspring-bench: no memory for the map\n");
        return false;
    }
    run_all(all);
    bench_table_note(options->format, "What became of the cases: not finite, diverged and failed must be 0");
    bool ok = print_all_outcomes(options->format, all) == 0;
    bench_table_note(options->format, "Measured border over the predicted one");
    ok = print_borders(options->format, all) == 0 && ok;
    if (options->out != NULL)
        ok = draw(all, options->out) && ok;
    free(all);
    return ok;
}

bool bench_run_map(const bench_options *options) {
    // The extremes are not divided: the first of several runs has them.
    const bool extremes = options->family == NULL && options->shard == 1;
    const bool ok = !extremes || map_extremes(options);
    return map_run_families(options) && ok;
}
