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

/// The greater part of that in advance, while the network goes on: passes in their order. What they allocate is the
/// network's plan_memory, which has been handed over to its memory when mspringi_move() takes what they have made.
/// Springs that have been copied are followed: what happens to one after that is copied again.
/// @param ids, woven_places  [live_count] of the springs that the topology sweeps
/// @param places             [springs] in the topology
typedef struct mspringi_mover mspringi_mover;
mspring_result mspringi_mover_begin(mspring_network *network, const mspringi_topology *topology);
mspring_result mspringi_mover_reserve(mspring_network *network);
void mspringi_mover_note_rests(const mspring_network *network, const mspring_id *ids,
                               const mspringi_place *woven_places, uint32_t first, uint32_t end);
mspring_result mspringi_mover_reserve_rests(mspring_network *network);
mspring_result mspringi_mover_reserve_strain(mspring_network *network);
void mspringi_mover_copy(const mspring_network *network, const mspringi_place *places, uint32_t first,
                         uint32_t end);
/// The spring in this place has changed.
void mspringi_mover_follow(const mspring_network *network, mspringi_place place);
/// What cannot be followed has changed: all this begins anew.
void mspringi_mover_drop(mspring_network *network);

#endif
