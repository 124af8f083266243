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
    uint32_t flags; ///< MSPRING_PARTICLE_ and MSPRINGI_PARTICLE_ABSENT
} mspringi_particle;

/// Of a particle that has been removed from the network whose topology is made anew: it gets no slot.
#define MSPRINGI_PARTICLE_ABSENT (1u << 31)

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

/// Whether a component of a velocity is in range. Faster ones overflow where a rate of strain is computed: for the
/// springs that are not there as well, which differ from one instruction set to the next.
static inline bool mspringi_is_speed(float value) {
    return value >= -(float)MSPRING_MAX_SPEED && value <= (float)MSPRING_MAX_SPEED;
}

/// Refuse definitions that are wrong whatever they are added to. index is for the message.
mspring_result mspringi_check_particle_def(mspringi_message *message, size_t index,
                                           const mspring_particle_def *def);
mspring_result mspringi_check_spring_def(mspringi_message *message, size_t index, const mspring_spring_def *def);
/// The same for what is in the definition of a spring, after its particles have been looked at.
mspring_result mspringi_check_spring_values(mspringi_message *message, size_t index, const mspring_spring_def *def);
/// The rest length of a spring whose ends are (dx, dy) apart.
mspring_result mspringi_find_rest_length(mspringi_message *message, size_t index, const mspring_spring_def *def,
                                         double dx, double dy, float *rest_length);

#endif
