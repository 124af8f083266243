/// @file added.h
/// Networks that springs and loose particles are added to while they run.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_ADDED_H
#define BENCH_ADDED_H

#include "network.h"

/// Make a network with room for so many particles and springs more.
bool bench_added_create(mspring_builder *builder, mspring_simd level, uint32_t workers, uint32_t substeps,
                        uint32_t spare_particles, uint32_t spare_springs, bench_network *out, scene_error *error);

/// Add so many loose particles, side by side and at rest at this height, m.
/// @param seconds  receives how long that took
bool bench_added_loose(bench_network *network, uint32_t count, double height, double *seconds, scene_error *error);

/// List so many springs, all over the network, that are not there yet: each from a particle to the one two metres
/// beside it, as a repair ties together what lies next to a hole.
/// @param springs  [count], to be given to mspring_network_add_springs()
bool bench_added_list(const bench_network *network, uint32_t count, mspring_spring_def *springs,
                      scene_error *error);

#endif
