/// @file map.h
/// What is found on the map of stability.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_MAP_H
#define BENCH_MAP_H

#include "draw/figure.h"
#include "scenes/extremes.h"

enum { MAP_SOLVERS = 3 };

typedef struct map {
    uint32_t outcomes[EXTREME_SHAPES][MAP_SOLVERS][EXTREME_STIFFNESSES][EXTREME_STEPS][EXTREME_OUTCOMES];
    double border[EXTREME_NETWORKS]; ///< measured over predicted; 0: there is no such network
} map;

const char *map_solver_name(uint32_t solver);

/// Draw what became of the cases, by stiffness and dt.
bool map_draw_outcomes(const map *drawn, const char *path, draw_error *error);
/// Draw the measured border over the predicted one, by stiffness and all else.
bool map_draw_borders(const map *drawn, const char *path, draw_error *error);

#endif
