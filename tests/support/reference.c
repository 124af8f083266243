/// @file reference.c
///
/// SPDX-License-Identifier: MIT
#include "reference.h"

#include <math.h>
#include <stdlib.h>

#include "support.h"

reference reference_of(const recipe *made, double gravity_x, double gravity_y, double global_damping) {
    reference net = {
        .particles = calloc(made->particle_count, sizeof *net.particles),
        .springs = calloc(made->spring_count + 1, sizeof *net.springs),
        .particle_count = made->particle_count,
        .spring_count = made->spring_count,
        .gravity_x = gravity_x,
        .gravity_y = gravity_y,
        .global_damping = global_damping,
    };
    assert_true(net.particles != NULL && net.springs != NULL);
    for (uint32_t i = 0; i < net.particle_count; i++) {
        const mspring_particle_def *def = &made->particles[i];
        net.particles[i] = (reference_particle){
            .x = def->x,
            .y = def->y,
            .vx = (double)def->vx,
            .vy = (double)def->vy,
            .mass = (double)def->mass,
            .pinned = (def->flags & MSPRING_PARTICLE_PINNED) != 0,
        };
    }
    for (uint32_t i = 0; i < net.spring_count; i++) {
        const mspring_spring_def *def = &made->springs[i];
        const reference_particle *a = &net.particles[def->a], *b = &net.particles[def->b];
        net.springs[i] = (reference_spring){
            .a = def->a,
            .b = def->b,
            .stiffness = (double)def->stiffness,
            .damping = (double)def->damping,
            .rest_length = def->rest_length == MSPRING_REST_LENGTH_DISTANCE ? hypot(b->x - a->x, b->y - a->y)
                                                                            : (double)def->rest_length,
            .relative = (def->flags & MSPRING_SPRING_RELATIVE) != 0,
        };
    }
    return net;
}

void reference_free(reference *net) {
    free(net->particles);
    free(net->springs);
    *net = (reference){0};
}

void reference_substep(reference *net, double h) {
    for (uint32_t i = 0; i < net->particle_count; i++) {
        net->particles[i].force_x = 0;
        net->particles[i].force_y = 0;
    }
    for (uint32_t i = 0; i < net->spring_count; i++) {
        const reference_spring *spring = &net->springs[i];
        reference_particle *a = &net->particles[spring->a], *b = &net->particles[spring->b];
        double stiffness = spring->stiffness, damping = spring->damping;
        if (spring->relative) {
            double mu = a->mass * b->mass / (a->mass + b->mass);
            stiffness *= mu / (h * h);
            damping *= mu / h;
        }
        double dx = b->x - a->x, dy = b->y - a->y, length = hypot(dx, dy);
        if (length == 0) {
            continue;
        }
        double ux = dx / length, uy = dy / length;
        double approach = (b->vx - a->vx) * ux + (b->vy - a->vy) * uy;
        double f = (length - spring->rest_length) * stiffness + approach * damping;
        a->force_x += f * ux;
        a->force_y += f * uy;
        b->force_x -= f * ux;
        b->force_y -= f * uy;
    }
    double time = (net->lag + h) / 2, loss = -expm1(-net->global_damping * time);
    double kick = net->global_damping > 0 ? loss / net->global_damping : time;
    net->lag = h;
    for (uint32_t i = 0; i < net->particle_count; i++) {
        reference_particle *p = &net->particles[i];
        if (!p->pinned) {
            p->vx += (p->force_x / p->mass + net->gravity_x) * kick - loss * p->vx;
            p->vy += (p->force_y / p->mass + net->gravity_y) * kick - loss * p->vy;
        }
        p->x += p->vx * h;
        p->y += p->vy * h;
    }
}
