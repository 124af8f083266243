/// @file bounce.h
/// Loose particles bounce as a ball does in closed form.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_BOUNCE_H
#define MAP_BOUNCE_H

#include "map/judge.h"

void map_bounce_begin(map_judge *judge);
map_verdict map_bounce_judge(map_judge *judge);

#endif
