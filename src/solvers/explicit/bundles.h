/// @file bundles.h
/// Bundles in the explicit solver: each takes all substeps while it is in the first-level cache.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BUNDLES_H
#define MSPRINGI_BUNDLES_H

#include "stability/guard.h"
#include "store/network.h"

/// Whether there are any, and they are swept on their own: not, but as any other part of the irregular part, with
/// the same bits, where added springs may pull at them.
bool mspringi_bundles_are_apart(const mspring_network *network);

/// Take some substeps of h.
/// @param all_extrema  [workers] joined with what is seen after them, if they are a whole step; else NULL
void mspringi_bundles_sweep(mspring_network *network, float h, mspringi_field base, uint32_t count,
                            mspringi_extrema *all_extrema);

#endif
