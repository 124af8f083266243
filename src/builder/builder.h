/// @file builder.h
/// What a builder holds, for the code that turns it into a network.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BUILDER_H
#define MSPRINGI_BUILDER_H

#include "base/memory.h"

typedef struct mspringi_particle {
    double x, y;
    float vx, vy;
    float mass;
    uint32_t flags;
} mspringi_particle;

typedef struct mspringi_spring {
    mspring_id a, b;
    float stiffness, damping, rest_length;
    uint32_t flags;
} mspringi_spring;

struct mspring_builder {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_particle *particles;
    mspringi_spring *springs;
    size_t particle_count, particle_capacity;
    size_t spring_count, spring_capacity;
};

#endif
