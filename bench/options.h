/// @file options.h
/// The command line.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_OPTIONS_H
#define BENCH_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "catalogue.h"
#include "table.h"

typedef enum bench_mode {
    BENCH_SCENES,
    BENCH_FEATURES,
    BENCH_CONTACT,
    BENCH_WORKERS,
    BENCH_SESSION,
    BENCH_GAME,
    BENCH_LINEAR,
    BENCH_SOLVERS,
    BENCH_ERRORS,
    BENCH_ROOFLINE,
    BENCH_MAP,
    BENCH_MAP_CASE,
    BENCH_FRAMES,
    BENCH_ALARMS,
    BENCH_GUARD,
    BENCH_CHECK,
    BENCH_SPARE,
    BENCH_LOOPS,
    BENCH_CORES,
    BENCH_LIST,
    BENCH_HELP
} bench_mode;

#define BENCH_MAX_SCENES 64

typedef struct bench_options {
    bench_mode mode;
    bench_format format;
    const char *scenes[BENCH_MAX_SCENES + 1]; ///< ended by NULL
    int scene_count;
    const char *network; ///< file, or NULL
    const char *out;     ///< folder for the pictures of the map, or NULL
    const char *family; ///< of the map's cases, or NULL: all, and the networks at the extremes; or a row of --spare
    const char *map_case;   ///< one case, as family:number
    uint32_t shard, shards; ///< of the map's cases: 1 of 1
    bench_scene_settings settings;
    bool all_levels;
    mspring_simd level; ///< MSPRING_SIMD_AUTO: the best
    bool sorted;        ///< the naive network, by places
    uint32_t workers;
    uint32_t substeps, repeat; ///< 0: by the scene's size
} bench_options;

/// Read the command line. On failure the message says which argument is wrong and what it should be.
bool bench_options_read(int count, char **arguments, bench_options *out, scene_error *error);

void bench_options_help(void);

/// The levels to measure, lowest first: those asked for that this machine has.
/// @return how many; 0 with a message if the one asked for is not there
int bench_options_levels(const bench_options *options, mspring_simd levels[4], scene_error *error);

#endif
