/// @file options.h
/// What the user of `bending` asks for.
///
/// SPDX-License-Identifier: MIT
#ifndef BENDING_OPTIONS_H
#define BENDING_OPTIONS_H

#include "scenes/scene.h"

typedef struct bending_options {
    const char *input;     ///< image, ship or network file
    const char *materials; ///< CSV file; for ships JSON; NULL: the built-in table, or that beside the ship
    scene_options scene;
    double dt;
    mspring_solver solver;
    uint32_t substeps;   ///< 0: not given
    uint32_t iterations; ///< of the implicit solver; 0: as many as the library takes by itself
    uint64_t steps;      ///< most steps
    float gravity;       ///< m/s^2 downwards
    mspring_simd level;
    bool at_once; ///< find the equilibrium without stepping
    bool csv, csv_header;
    const char *picture, *svg, *animation; ///< files to write, or NULL
    const char *folder;                    ///< for all three of them, or NULL
} bending_options;

typedef enum options_outcome { OPTIONS_OK, OPTIONS_HELP, OPTIONS_WRONG } options_outcome;

/// Read the arguments. Prints help to stdout, mistakes to stderr.
options_outcome options_read(int count, char **arguments, bending_options *options);

#endif
