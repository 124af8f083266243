/// @file gpu_template.h
/// What a batch takes from a network, by public calls.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GPU_TEMPLATE_H
#define MSPRINGI_GPU_TEMPLATE_H

#include <stdbool.h>

#include "gpu_opencl.h"

#define MSPRINGI_GPU_NONE 0xffffu

/// Springs in rows around a particle, in the order in which the kernel takes them.
#define MSPRINGI_GPU_SIDES 8

/// Flags of particles: it is in a lattice or chain; in a row with none north of it; it has springs in no row.
enum { MSPRINGI_GPU_ON_TOP = 1, MSPRINGI_GPU_IN_ROWS = 2, MSPRINGI_GPU_HAS_OTHERS = 4 };

/// A particle as the kernel has it.
typedef struct mspringi_gpu_particle {
    float inverse_mass;
    uint32_t flags;
} mspringi_gpu_particle;

typedef struct mspringi_gpu_spring {
    uint32_t a, b; ///< particles of the body
    float stiffness, damping, rest_length;
    bool is_relative; ///< then stiffness and damping are fractions
} mspringi_gpu_spring;

/// A network of equal bodies: the first body, and the state of each.
typedef struct mspringi_gpu_template {
    uint32_t body_count, particle_count, spring_count, substeps;
    bool is_damped, has_relative;
    float gravity_x, gravity_y, global_damping, max_speed;
    double origin_x, origin_y;
    double shortest; ///< rest length that isn't 0, m
    uint32_t plane_count;
    double planes[MSPRING_MAX_PLANES][5]; ///< normal, offset from the local origin, friction, restitution
    float *masses;                        ///< [particle_count]
    mspringi_gpu_particle *particles;     ///< [particle_count]
    mspringi_gpu_spring *springs;         ///< [spring_count]
    uint32_t row_slots, slot_count;       ///< of springs around a particle: in rows, MSPRINGI_GPU_SIDES or 0; all
    uint16_t *slots;                      ///< [slot_count][particle_count] spring or MSPRINGI_GPU_NONE
    float *states;                        ///< [body_count][6][particle_count] x, y, low words of these, vx, vy
} mspringi_gpu_template;

/// Read a network. On error nothing is left.
mspring_result mspringi_gpu_read_network(const mspring_network *network, mspringi_gpu_template *to,
                                         mspringi_gpu_message *message);

/// Read the state of a network alone: of a clone of it.
mspring_result mspringi_gpu_read_states(const mspring_network *network, mspringi_gpu_template *to,
                                        mspringi_gpu_message *message);

void mspringi_gpu_template_free(mspringi_gpu_template *t);

/// The state hash of a network: its head, then each body, as tests/spec (hash_of) has it.
uint64_t mspringi_gpu_hash_head(double origin_x, double origin_y, float lag);
uint64_t mspringi_gpu_hash_body(uint64_t hash, const float *state, uint32_t particle_count);

/// A low word, or 0 if it can't be the rest of a value.
float mspringi_gpu_low_of(float value, float low);

#endif
