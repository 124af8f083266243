/// @file tunes.h
/// What tests of mspring_network_tune() have in common: a clock that they turn, and a bar.
///
/// SPDX-License-Identifier: MIT
#ifndef TUNES_H
#define TUNES_H

#include <massspring/massspring.h>
#include <stdbool.h>

#include "recipe.h"

/// Rows of a table.
enum { TUNES_MOST = 32 };

/// A clock that goes on by a tick whenever it is read, and what a watcher has seen.
typedef struct tunes_watch {
    double now, tick;
    double done;          ///< the last part that was told
    uint32_t told, limit; ///< how often; when to stop, 0: never
    bool went_back;
} tunes_watch;

typedef struct tunes_table {
    mspring_tune_row rows[TUNES_MOST];
    uint32_t count;
} tunes_table;

/// A mspring_tune_def.progress that notes what it is told, and stops at the limit.
uint32_t tunes_tell(double done, void *user);

/// Defaults with this clock and a budget that is not used up.
mspring_tune_def tunes_def(tunes_watch *w);
mspring_settings tunes_setting(mspring_solver solver, uint32_t substeps, uint32_t iterations);

/// A table without rows, to be written to.
void tunes_clear(tunes_table *out);

/// Tune, which succeeds.
tunes_table tunes_run(mspring_network *network, const mspring_tune_def *def);

bool tunes_has(const mspring_tune_row *row, uint32_t flags);

/// A bar that is pinned at its left end. Stiffness in N/m or, if relative, a fraction.
recipe tunes_bar_recipe(uint32_t width, uint32_t height, double stiffness, double damping, uint32_t flags);
/// A network of 14 x 3 particles of it.
mspring_network *tunes_bar(double stiffness, double damping, uint32_t flags, const mspring_network_def *def);

/// Stable with 8 explicit substeps of 1/64 s: omega_max = sqrt(8 k / m), 2 / omega_max = 1/362 s.
#define TUNES_STIFFNESS 4.6e6

#endif
