/// @file draw.h
/// Parts of drawing a case.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_DRAW_H
#define MAP_DRAW_H

#include "map/case.h"

/// Whether something happens that happens once in so many cases.
bool map_one_in(uint64_t *seed, uint32_t count);

/// A body, its solver, no gravity, nothing pinned.
map_stuff map_draw_begin(map_case *drawn, uint64_t *seed);

/// Velocities of up to speed in each direction.
void map_draw_velocities(map_case *drawn, double speed, uint64_t *seed);

// Families of precision, in precision.c.
void map_draw_fall(map_case *drawn, uint64_t *seed);
void map_draw_order(map_case *drawn, uint64_t *seed);
void map_draw_uneven(map_case *drawn, uint64_t *seed);
void map_draw_burst(map_case *drawn, uint64_t *seed);
void map_draw_rest(map_case *drawn, uint64_t *seed);

#endif
