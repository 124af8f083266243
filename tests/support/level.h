/// @file level.h
/// The SIMD level that a program tests: its first argument.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_LEVEL_H
#define TEST_LEVEL_H

#include <massspring/massspring.h>

/// What ctest takes for "skipped".
#define LEVEL_SKIPPED 77

/// The level of that name. Ends the program with LEVEL_SKIPPED and a message if this machine lacks it, and with 2
/// if there is no such level. Also removes MSPRING_SIMD from the environment, so that the level is what is asked
/// for.
mspring_simd level_from_arguments(int argc, char **argv);

/// The level that others are compared with: the scalar one or, in a build without it, the lowest.
mspring_simd level_lowest(void);

/// The kernels of a network are those of the level: a test that asked for AVX2 and got SSE2 would test nothing.
void level_check(const mspring_network *network, mspring_simd level);

#endif
