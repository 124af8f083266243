/// @file wreck.h
/// Networks of which springs have broken, in one way or another: nine of ten, or a quarter.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_WRECK_H
#define BENCH_WRECK_H

#include "network.h"

typedef enum bench_wreck {
    BENCH_WRECK_PIECES,    ///< squares of ten by ten are left here and there
    BENCH_WRECK_BLASTS,    ///< blasts have left what was between them
    BENCH_WRECK_SHATTERED, ///< one spring of ten is left, anywhere
    BENCH_WRECK_QUARTER,   ///< blasts have broken a quarter of the springs
    BENCH_WRECKS
} bench_wreck;

/// Break springs of a network at its start.
bool bench_wreck_make(const bench_network *network, bench_wreck kind, scene_error *error);
const char *bench_wreck_name(bench_wreck kind);

/// Cut a network at its start from top to bottom into so many parts of as many particles each.
/// @param first  receives a particle of the first part, the leftmost of all
bool bench_wreck_slice(const bench_network *network, uint32_t parts, mspring_id *first, scene_error *error);

#endif
