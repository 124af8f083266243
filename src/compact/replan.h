/// @file replan.h
/// A topology of the springs that are left.
///
/// The plan that a network is created with sweeps all springs, broken ones too. A replan lays out the live ones
/// alone: lattices where squares are left, strands, a web of what is between, and loose particles. Springs that are
/// broken are parked: they keep a place and a record, so that everything that can be asked or set of a broken
/// spring goes on as it did, but nothing sweeps them.
///
/// Grids are looked for where the first topology has found some, by row and column: where the particles are by then
/// says nothing.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_REPLAN_H
#define MSPRINGI_REPLAN_H

#include "network/network.h"

/// Pieces of the work: listing what is live, those of the topology, and parking the rest.
#define MSPRINGI_REPLAN_PIECES (MSPRINGI_TOPOLOGY_PIECES + 2)

typedef struct mspringi_replan mspringi_replan;

/// Begin one, for the springs that are live by then; go on so many times unless it fails, then take the topology.
/// All that it allocates is the network's plan_memory: to abandon it is to free that.
mspring_result mspringi_replan_begin(mspring_network *network, mspringi_replan **begun);
mspring_result mspringi_replan_go_on(mspringi_replan *replan, mspring_network *network);
uint32_t mspringi_replan_pieces_left(const mspringi_replan *replan);
/// Whether the topology sweeps every spring that is live now. It may sweep some that have broken since.
bool mspringi_replan_is_valid(const mspringi_replan *replan, const mspring_network *network);
void mspringi_replan_take(mspringi_replan *replan, mspring_network *network, mspringi_topology *topology);

#endif
