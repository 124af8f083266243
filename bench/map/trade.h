/// @file trade.h
/// More substeps are never less accurate.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_TRADE_H
#define MAP_TRADE_H

#include "map/judge.h"

/// Run the case with 1, 2, 4 ... 1024 substeps, and compare with a run in double precision.
/// @param first  the case's network, before its first step
map_verdict map_run_trade(const map_case *what, mspring_network *first, char text[MAP_TEXT]);

#endif
