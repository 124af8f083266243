/// @file gpu_template.h
/// Template of a batch, read from a network by public calls.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GPU_TEMPLATE_H
#define MSPRINGI_GPU_TEMPLATE_H

#include <stdbool.h>

#include "gpu_opencl.h"

#define MSPRINGI_GPU_NONE 0xffffu

/// Springs in rows around a particle, at most. The kernel numbers them by side.
#define MSPRINGI_GPU_SIDES 8

/// Flags of particles: in a top row, from which no spring leads north; in a lattice or chain; with irregular
/// springs.
enum { MSPRINGI_GPU_ON_TOP = 1, MSPRINGI_GPU_IN_ROWS = 2, MSPRINGI_GPU_HAS_OTHERS = 4 };

/// A particle, laid out as in batch.cl.
typedef struct mspringi_gpu_particle {
    float inverse_mass;
    uint32_t flags;
} mspringi_gpu_particle;

typedef struct mspringi_gpu_spring {
    uint32_t a, b; ///< particles of the body
    float stiffness, damping, rest_length;
    bool is_relative; ///< if so, stiffness and damping are fractions
} mspringi_gpu_spring;

/// A network of equal bodies: the first body, and the state of each.
typedef struct mspringi_gpu_template {
    uint32_t body_count, particle_count, spring_count, substeps;
    bool is_damped, has_relative;
    float gravity_x, gravity_y, global_damping, max_speed;
    double origin_x, origin_y;
    double shortest; ///< shortest rest length above 0, m; INFINITY: none
    uint32_t plane_count;
    double planes[MSPRING_MAX_PLANES][5]; ///< normal, offset from the local origin, friction, restitution
    float *masses;                        ///< [particle_count]
    mspringi_gpu_particle *particles;     ///< [particle_count]
    mspringi_gpu_spring *springs;         ///< [spring_count]
    uint32_t row_slots, slot_count;       ///< springs around a particle: in rows, MSPRINGI_GPU_SIDES or 0; all
    uint16_t *slots;                      ///< [slot_count][particle_count] spring or MSPRINGI_GPU_NONE
    float *states;                        ///< [body_count][6][particle_count] x, y, low words of these, vx, vy
} mspringi_gpu_template;

/// Read a network. On error the template is empty.
mspring_result mspringi_gpu_read_network(const mspring_network *network, mspringi_gpu_template *to,
                                         mspringi_gpu_message *message);

/// Read only the state, of the network or a clone of it.
mspring_result mspringi_gpu_read_states(const mspring_network *network, mspringi_gpu_template *to,
                                        mspringi_gpu_message *message);

void mspringi_gpu_template_free(mspringi_gpu_template *t);

/// Compute the state hash of a network: first the head, then each body, as hash_of() in tests/spec.
uint64_t mspringi_gpu_hash_head(double origin_x, double origin_y, float lag);
uint64_t mspringi_gpu_hash_body(uint64_t hash, const float *state, uint32_t particle_count);

/// Return a low word, or 0 if it is too large to be the rest of the value.
float mspringi_gpu_low_of(float value, float low);

#endif
