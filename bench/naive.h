/// @file naive.h
/// The baseline: a mass-spring step as one writes it first. Arrays of structures, one pass over the springs that
/// adds each one's force to both its particles, one pass over the particles that moves them. Every speed of the
/// bench is a ratio to it. It is compiled on its own, for the machine at hand; see README.md.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_NAIVE_H
#define BENCH_NAIVE_H

#include <stdint.h>

/// 32 bytes, so that none of them lies across two cache lines.
typedef struct naive_particle {
    float x, y, vx, vy;
    float force_x, force_y;
    float mass;
    float inverse_mass; ///< 0: pinned
} naive_particle;

typedef struct naive_spring {
    uint32_t a, b;
    float stiffness, damping, rest_length;
} naive_spring;

typedef struct naive_network {
    naive_particle *particles;
    naive_spring *springs;
    uint32_t particle_count, spring_count;
    float gravity_x, gravity_y;
    float global_damping; ///< 1/s
    float lag;            ///< twice the time by which velocities are older than positions: the last substep, s
} naive_network;

/// Evolve by dt, in substeps of equal length.
void naive_step(naive_network *network, double dt, uint32_t substeps);

#endif
