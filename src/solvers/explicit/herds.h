/// @file herds.h
/// Herds in the explicit solver: each takes all substeps while it is in the first-level cache.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EXPLICIT_HERDS_H
#define MSPRINGI_EXPLICIT_HERDS_H

#include "stability/guard.h"
#include "store/network.h"

/// Whether there are any, and they are swept on their own: not, but as any other part of the web, with the same
/// bits, where added springs may pull at them.
bool mspringi_herds_are_apart(const mspring_network *network);

/// Take some substeps of h.
/// @param sights  [workers] joined with what is seen after them, if they are a whole step; else NULL
void mspringi_herds_sweep(mspring_network *network, float h, mspringi_field base, uint32_t count,
                          mspringi_extrema *all_extrema);

#endif
