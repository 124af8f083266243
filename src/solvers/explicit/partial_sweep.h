/// @file partial_sweep.h
/// Sweeping rows of which a part sleeps.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PARTIAL_SWEEP_H
#define MSPRINGI_PARTIAL_SWEEP_H

#include "solvers/explicit/strip.h"
#include "store/sleepers.h"

/// How far a row has been gone through.
typedef struct mspringi_partial_cursor {
    const mspringi_span *span, *end;
    uint32_t slot;
} mspringi_partial_cursor;

mspringi_partial_cursor mspringi_partial_begin(const mspringi_span *spans, uint32_t span_count);

/// The next runs of blocks that are marked as swept, of a row that can be swept in part: those that lie side by
/// side, each of one span. Returns how many there are, no more than the row has spans; 0 behind the last.
uint32_t mspringi_partial_next(const mspring_network *network, mspringi_partial_cursor *at, mspringi_span *runs);

/// Sweep the blocks of a row of a lattice or chains that are marked as swept.
void mspringi_partial_sweep_row(const mspring_network *network, const mspringi_substep *substep,
                                mspringi_row_fn sweep, const mspringi_row *row);

/// Sweep the blocks of a span of the irregular part that are marked as swept.
void mspringi_partial_sweep_irregular(const mspring_network *network, const mspringi_substep *substep,
                                      mspringi_row_fn sweep, const mspringi_span *span);

/// Clear what a run of lattice blocks has handed to blocks above that are left out.
void mspringi_partial_clear(const mspring_network *network, const mspringi_sweep *sweep, const mspringi_span *run);

#endif
