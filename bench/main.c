/// @file main.c
/// massspring-bench: see README.md.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>

#include "modes.h"

int main(int count, char **arguments) {
    bench_options options;
    mspring_simd levels[4];
    scene_error error;
    if (!bench_options_read(count, arguments, &options, &error) ||
        bench_options_levels(&options, levels, &error) == 0) {
        bench_complain("command line", &error);
        return 2;
    }
    bool ok = true;
    switch (options.mode) {
    case BENCH_SCENES:
        ok = bench_run_scenes(&options);
        break;
    case BENCH_FEATURES:
        ok = bench_run_features(&options);
        break;
    case BENCH_CONTACT:
        ok = bench_run_contact(&options);
        break;
    case BENCH_WORKERS:
        ok = bench_run_workers(&options);
        break;
    case BENCH_SESSION:
        ok = bench_run_session(&options);
        break;
    case BENCH_GAME:
        ok = bench_run_game(&options);
        break;
    case BENCH_LINEAR:
        ok = bench_run_linear(&options);
        break;
    case BENCH_SOLVERS:
        ok = bench_run_solvers(&options);
        break;
    case BENCH_ERRORS:
        ok = bench_run_errors(&options);
        break;
    case BENCH_ROOFLINE:
        ok = bench_run_roofline(&options);
        break;
    case BENCH_MAP:
        ok = bench_run_map(&options);
        break;
    case BENCH_MAP_CASE:
        ok = bench_run_map_case(&options);
        break;
    case BENCH_FRAMES:
        ok = bench_run_frames(&options);
        break;
    case BENCH_ALARMS:
        ok = bench_run_alarms(&options);
        break;
    case BENCH_GUARD:
        ok = bench_run_guard(&options);
        break;
    case BENCH_CHECK:
        ok = bench_run_check(&options);
        break;
    case BENCH_SPARE:
        ok = bench_run_spare(&options);
        break;
    case BENCH_CORES:
        ok = bench_run_cores(&options);
        break;
    case BENCH_LOOPS:
        ok = bench_run_loops(&options);
        break;
    case BENCH_LIST:
        bench_catalogue_print();
        break;
    case BENCH_HELP:
        bench_options_help();
        break;
    }
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
