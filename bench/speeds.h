/// @file speeds.h
/// The bench's main table, read back from its CSV.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_SPEEDS_H
#define BENCH_SPEEDS_H

#include <massspring/massspring.h>

#include "scenes/scene.h"

enum { SPEEDS_MOST = 2048 };

/// A line of the table.
typedef struct speed {
    char scene[64];
    unsigned long line; ///< of the file
    double springs;
    mspring_simd level;
    uint32_t workers;
    double ns;       ///< of the library, per spring and substep
    double naive_ns; ///< of the naive step
} speed;

typedef struct speeds {
    speed rows[SPEEDS_MOST];
    size_t count;
} speeds;

/// Read a file that massspring-bench --csv has written, or several in one, each with its header. An error says
/// file, line and column.
bool speeds_read(const char *path, speeds *out, scene_error *error);

#endif
