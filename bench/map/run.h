/// @file run.h
/// Running a case.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_RUN_H
#define MAP_RUN_H

#include <stdio.h>

#include "map/judge.h"

/// Run a case and judge it.
/// @param text  receives what is wrong, if anything is
map_verdict map_run_case(const map_case *what, char text[MAP_TEXT]);

/// Print what energies a case has after each step.
void map_print_course(const map_case *what, FILE *out);

/// Make the network of a case, and set what is given by calls.
/// @return NULL if that fails; text says why
mspring_network *map_make_network(const map_case *what, char text[MAP_TEXT]);

/// Set the length of steps and the number of substeps from what is stable.
/// @return false if a call fails, or the network has no explicit substep
bool map_choose_step(map_case *what, mspring_network *network);

#endif
