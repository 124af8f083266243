/// @file map_cases.h
/// Running the cases of the map.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_MAP_CASES_H
#define BENCH_MAP_CASES_H

#include "options.h"

/// Run all families, or the one that the options name, and print what became of them.
/// @return false if a case is at fault
bool map_run_families(const bench_options *options);

#endif
