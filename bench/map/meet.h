/// @file meet.h
/// Two bodies that meet: that none gets into the other.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_MEET_H
#define MAP_MEET_H

#include "map/judge.h"

/// Put a second body behind the first into a case. Its lower left corner is at a distance to the right of the
/// first.
void map_add_body(map_case *drawn, const map_body *second, double gap);

/// Judge whether springs of the two bodies cross, and how deep they overlap.
map_verdict map_meet_judge(map_judge *judge);

#endif
