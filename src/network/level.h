/// @file level.h
/// Instruction set that suits a layout.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LEVEL_H
#define MSPRINGI_LEVEL_H

#include "layout/topology.h"

/// Level for a layout, if the host leaves the choice to the library: the widest, or a narrower one if rows fill as
/// few registers of it.
mspring_simd mspringi_choose_level(const mspringi_topology *topology, mspring_simd widest);

#endif
