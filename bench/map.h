/// @file map.h
/// What is found on the map of stability.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_MAP_H
#define BENCH_MAP_H

#include "draw/figure.h"
#include "scenes/extremes.h"

typedef struct map {
    uint32_t outcomes[EXTREME_SHAPES][EXTREME_WAYS][EXTREME_STIFFNESSES][EXTREME_STEPS][EXTREME_OUTCOMES];
    double border[EXTREME_NETWORKS]; ///< measured over predicted; 0: there is no such network
} map;

/// Draw what became of the cases, by stiffness and dt.
bool map_draw_outcomes(const map *drawn, const char *path, draw_error *error);
/// Draw the measured border over the predicted one, by stiffness and all else.
bool map_draw_borders(const map *drawn, const char *path, draw_error *error);

#endif
