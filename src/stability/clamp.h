/// @file clamp.h
/// Substeps at any stiffness, in which springs do less than they would.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CLAMP_H
#define MSPRINGI_CLAMP_H

#include "network/network.h"

/// Take count substeps of length h with strain rates clamped (MSPRING_GUARD_CLAMP), all with the forces from
/// outside that are in base (x NULL: none).
void mspringi_clamp_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count);

#endif
