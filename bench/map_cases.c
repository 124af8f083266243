/// @file map_cases.c
/// The cases of the map (map/case.h), run and counted: --map, and --map-case for one of them.
///
/// SPDX-License-Identifier: MIT
#include "map_cases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "map/run.h"
#include "modes.h"
#include "table.h"

enum { SOLVERS = 3, VERDICT_COLUMNS = 3 + MAP_VERDICTS };

static const char *const solver_names[SOLVERS] = {"explicit", "implicit", "direct"};

static void print_head(bench_format format) {
    bench_column columns[VERDICT_COLUMNS] = {
        {"family", "family", -8}, {"solver", "solver", -8}, {"cases", "cases", 6}};
    for (int i = 0; i < MAP_VERDICTS; i++) {
        const char *name = map_verdict_name((map_verdict)i);
        columns[3 + i] = (bench_column){name, name, (int)strlen(name)};
    }
    bench_table_head(format, columns, VERDICT_COLUMNS);
}

static void print_row(bench_format format, const char *family, const char *solver, const uint32_t *counts) {
    bench_column columns[VERDICT_COLUMNS] = {{"", "", -8}, {"", "", -8}, {"", "", 6}};
    bench_cell cells[VERDICT_COLUMNS] = {bench_cell_of("%s", family), bench_cell_of("%s", solver)};
    uint32_t cases = 0;
    for (int i = 0; i < MAP_VERDICTS; i++) {
        columns[3 + i] = (bench_column){"", "", (int)strlen(map_verdict_name((map_verdict)i))};
        cells[3 + i] = bench_cell_of("%u", counts[i]);
        cases += counts[i];
    }
    cells[2] = bench_cell_of("%u", cases);
    bench_table_row(format, columns, VERDICT_COLUMNS, cells);
}

/// Run one case; a fault is told in a line that says how to run it again.
static map_verdict run_case(map_family family, uint32_t index, mspring_solver *solver) {
    map_case drawn;
    char text[MAP_TEXT];
    map_draw_case(&drawn, family, index);
    *solver = drawn.network.settings.solver;
    const map_verdict verdict = map_run_case(&drawn, text);
    if (verdict >= MAP_NOT_FINITE) {
        char what[512];
        map_describe_case(&drawn, what, sizeof what);
        fprintf(stderr, "--map-case %s:%u  %s: %s (%s)\n", map_family_name(family), index,
                map_verdict_name(verdict), text, what);
    }
    return verdict;
}

/// @return how many cases are at fault
static uint32_t run_family(const bench_options *options, map_family family, uint32_t whole[MAP_VERDICTS]) {
    uint32_t counts[SOLVERS][MAP_VERDICTS] = {{0}}, faults = 0;
    for (uint32_t index = 0; index < map_family_size(family); index++) {
        // Cases of all solvers in each shard.
        if (index / 8 % options->shards != options->shard - 1)
            continue;
        mspring_solver solver;
        const map_verdict verdict = run_case(family, index, &solver);
        counts[solver][verdict]++;
        whole[verdict]++;
        faults += verdict >= MAP_NOT_FINITE;
    }
    for (int solver = 0; solver < SOLVERS; solver++) {
        uint32_t cases = 0;
        for (int i = 0; i < MAP_VERDICTS; i++)
            cases += counts[solver][i];
        if (cases > 0)
            print_row(options->format, map_family_name(family), solver_names[solver], counts[solver]);
    }
    return faults;
}

bool map_run_families(const bench_options *options) {
    uint32_t whole[MAP_VERDICTS] = {0}, faults = 0;
    bench_table_note(options->format, "Energy, momentum, contact and precision: those after 'rested' must be 0");
    print_head(options->format);
    for (int family = 0; family < MAP_FAMILIES; family++)
        if (options->family == NULL || strcmp(options->family, map_family_name((map_family)family)) == 0)
            faults += run_family(options, (map_family)family, whole);
    print_row(options->format, "all", "", whole);
    return faults == 0;
}

static bool find_case(const char *name, map_family *family, uint32_t *index) {
    for (int i = 0; i < MAP_FAMILIES; i++) {
        const char *known = map_family_name((map_family)i);
        const size_t length = strlen(known);
        if (strncmp(name, known, length) == 0 && name[length] == ':' && name[length + 1] >= '0' &&
            name[length + 1] <= '9') {
            char *end = NULL;
            const unsigned long read = strtoul(name + length + 1, &end, 10);
            *family = (map_family)i;
            *index = (uint32_t)read;
            return *end == '\0' && read < map_family_size(*family);
        }
    }
    return false;
}

bool bench_run_map_case(const bench_options *options) {
    map_family family = MAP_BLAST;
    uint32_t index = 0;
    map_case drawn;
    char text[MAP_TEXT], what[512];
    if (!find_case(options->map_case, &family, &index)) {
        fprintf(stderr,
                "massspring-bench: '%.80s' is no case: family:number, with one of these families and a number "
                "below its size:\n",
                options->map_case);
        for (int i = 0; i < MAP_FAMILIES; i++)
            fprintf(stderr, "  %s %u\n", map_family_name((map_family)i), map_family_size((map_family)i));
        return false;
    }
    map_draw_case(&drawn, family, index);
    map_describe_case(&drawn, what, sizeof what);
    puts(what);
    map_print_course(&drawn, stdout);
    const map_verdict verdict = map_run_case(&drawn, text);
    printf("%s%s%s\n", map_verdict_name(verdict), text[0] != '\0' ? ": " : "", text);
    return verdict < MAP_NOT_FINITE;
}
