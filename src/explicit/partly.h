/// @file partly.h
/// Sweeping rows of which a part sleeps.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PARTLY_H
#define MSPRINGI_PARTLY_H

#include "sleep/sleep.h"
#include "strip.h"

/// Sweep the blocks of spans, all of one kind of row, that are marked as swept.
void mspringi_partly_sweep(const mspring_network *network, const mspringi_substep *substep, mspringi_row_fn sweep,
                           const mspringi_span *spans, uint32_t span_count);

/// Clear what a run of lattice blocks has handed to blocks above that are left out.
void mspringi_partly_clear(const mspring_network *network, const mspringi_sweep *sweep, const mspringi_span *run);

#endif
