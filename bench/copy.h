/// @file copy.h
/// A builder made of a network.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_COPY_H
#define BENCH_COPY_H

#include "network.h"

/// Make a builder with a network's particles, where they start, and its springs with the stiffness (N/m) and
/// damping (N s/m) that they had in its last step.
bool bench_copy_absolute(const bench_network *from, mspring_builder **out, scene_error *error);

#endif
