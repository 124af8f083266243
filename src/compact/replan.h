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

typedef struct mspringi_replan mspringi_replan;

/// Begin one; go on until it is done or fails, then take the topology. All that it allocates is the network's
/// plan_memory: to abandon it is to free that.
mspring_result mspringi_replan_begin(mspring_network *network, mspringi_replan **begun);
mspring_result mspringi_replan_go_on(mspringi_replan *replan, mspring_network *network);
/// Stages that are left.
uint32_t mspringi_replan_left(const mspringi_replan *replan);
bool mspringi_replan_is_done(const mspringi_replan *replan);
/// Whether it is done because the network's plan sweeps what is live, and nothing else: there is nothing to take.
bool mspringi_replan_is_needless(const mspringi_replan *replan);
/// Whether no spring has been broken or restored since it began.
bool mspringi_replan_is_current(const mspringi_replan *replan, const mspring_network *network);
/// Whether particles or springs have been added or removed since it began: then it cannot go on.
bool mspringi_replan_is_outdated(const mspringi_replan *replan, const mspring_network *network);
/// Whether the topology sweeps every spring that is live now. It may sweep some that have broken since.
bool mspringi_replan_is_valid(const mspringi_replan *replan, const mspring_network *network);
/// @param print  receives what becomes the network's topology_print
void mspringi_replan_take(mspringi_replan *replan, mspring_network *network, mspringi_topology *topology,
                          uint64_t *print);

#endif
