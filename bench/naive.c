/// @file naive.c
/// The naive step. Its formula is that of massspring.h; single precision, exact square root and division.
///
/// SPDX-License-Identifier: MIT
#include "naive.h"

#include <math.h>

static void add_spring_forces(naive_particle *restrict particles, const naive_spring *restrict springs,
                              uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const naive_spring *spring = &springs[i];
        naive_particle *a = &particles[spring->a];
        naive_particle *b = &particles[spring->b];

        float dx = b->x - a->x;
        float dy = b->y - a->y;
        float length = sqrtf(dx * dx + dy * dy);
        float inverse_length = length > 0.0f ? 1.0f / length : 0.0f;
        float ux = dx * inverse_length;
        float uy = dy * inverse_length;

        float stretch_speed = (b->vx - a->vx) * ux + (b->vy - a->vy) * uy;
        float force = (length - spring->rest_length) * spring->stiffness + stretch_speed * spring->damping;

        a->force_x += force * ux;
        a->force_y += force * uy;
        b->force_x -= force * ux;
        b->force_y -= force * uy;
    }
}

static void move_particles(naive_particle *restrict particles, uint32_t count, float gravity_x, float gravity_y,
                           float loss, float kick, float h) {
    for (uint32_t i = 0; i < count; i++) {
        naive_particle *p = &particles[i];
        if (p->inverse_mass > 0.0f) {
            p->vx += p->force_x * p->inverse_mass * kick - loss * p->vx;
            p->vy += p->force_y * p->inverse_mass * kick - loss * p->vy;
        }
        p->x += p->vx * h;
        p->y += p->vy * h;
        p->force_x = p->mass * gravity_x;
        p->force_y = p->mass * gravity_y;
    }
}

void naive_step(naive_network *network, double dt, uint32_t substeps) {
    float h = (float)(dt / substeps);
    for (uint32_t i = 0; i < network->particle_count; i++) {
        network->particles[i].force_x = network->particles[i].mass * network->gravity_x;
        network->particles[i].force_y = network->particles[i].mass * network->gravity_y;
    }
    for (uint32_t substep = 0; substep < substeps; substep++) {
        float time = 0.5f * (network->lag + h);
        float loss = -expm1f(-network->global_damping * time);
        float kick = network->global_damping > 0.0f ? loss / network->global_damping : time;
        network->lag = h;
        add_spring_forces(network->particles, network->springs, network->spring_count);
        move_particles(network->particles, network->particle_count, network->gravity_x, network->gravity_y, loss,
                       kick, h);
    }
}
