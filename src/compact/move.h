/// @file move.h
/// Moving a network to another layout of the same particles and springs.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_MOVE_H
#define MSPRINGI_MOVE_H

#include "network/network.h"

/// Move everything that lies by slot or by place to this topology, which sweeps at least the springs that are live;
/// what lies by id stays. The network's own topology is left to the caller. An implicit solver whose tiles are by
/// plan gets tiles of this size, and the fallback of its own, or 0: by plan. On error nothing has changed.
mspring_result mspringi_move(mspring_network *network, const mspringi_topology *topology, uint32_t tile_size,
                             uint32_t fallback_size);

#endif
