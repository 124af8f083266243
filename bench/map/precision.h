/// @file precision.h
/// Families in which a few numbers are known for long: speed and way of a fall, and energy where nothing damps.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_PRECISION_H
#define MAP_PRECISION_H

#include "map/judge.h"

map_verdict map_run_precision(const map_case *what, mspring_network *network, char text[MAP_TEXT]);

#endif
