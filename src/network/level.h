/// @file level.h
/// The instruction set that suits a layout.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LEVEL_H
#define MSPRINGI_LEVEL_H

#include "layout/topology.h"

/// The level to run at, where the host leaves that to the library: the widest, or one with narrower registers if
/// rows fill no more of these.
mspring_simd mspringi_level_for(const mspringi_topology *topology, mspring_simd widest);

#endif
