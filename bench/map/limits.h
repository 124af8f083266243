/// @file limits.h
/// What is known not to hold: by name, so that nothing is passed over in silence.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_LIMITS_H
#define MAP_LIMITS_H

#include "map/judge.h"

/// The limit that a fault of a case falls under.
/// @return its name, as in STABILITY.md; NULL if there is none
const char *map_known_limit(const map_case *what, map_verdict fault);

#endif
