/// @file hold.h
/// Colliders that bodies are pressed against, and grips.
///
/// All of them move at the case's drift, as pinned particles do. So in the frame that energies are computed in they
/// do no work.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_HOLD_H
#define MAP_HOLD_H

#include "map/judge.h"

/// Set the apex of a case's wedge right of its bodies, at most so far that none overlaps it at first.
void map_hold_place_wedge(map_case *drawn, double gap);

/// Add the colliders and grips of a case to its network.
/// @return false if a call fails
bool map_hold_begin(map_watch *watch);

/// Before a step: move them.
mspring_result map_hold_move(const map_watch *watch);

/// Add the energies of grips, as springs whose force is bounded, to what is elastic. All components are held then.
void map_hold_add_energy(map_watch *watch);

/// Judge whether a particle has passed the wedge.
map_verdict map_hold_judge(map_judge *judge);

#endif
