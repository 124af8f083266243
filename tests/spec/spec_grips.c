/// @file spec_grips.c
/// Specification of grips: after each substep, and after the floor, they change velocity and place of their particle
/// by their forces at the end of the substep. In double precision.
///
/// SPDX-License-Identifier: MIT
#include "spec.h"

#include <math.h>

typedef struct pull {
    double x, y;
} pull;

/// The grips of one particle, in the order in which they were added, and the particle without them. Each pulls by a
/// part of its stiffness and damping, so that its force stays within its bound.
typedef struct gripped {
    const spec_grip *grips[SPEC_GRIPS];
    double to_x[SPEC_GRIPS], to_y[SPEC_GRIPS]; ///< from the particle to the target, which goes evenly in the step
    double to_vx[SPEC_GRIPS], to_vy[SPEC_GRIPS];
    double parts[SPEC_GRIPS];
    pull forces[SPEC_GRIPS];
    uint32_t count;
    double x, y, vx, vy, inverse_mass, h;
} gripped;

static pull pull_at_start(const gripped *g, uint32_t i) {
    const double k = (double)g->grips[i]->stiffness, c = (double)g->grips[i]->damping;
    return (pull){k * g->to_x[i] + c * g->to_vx[i], k * g->to_y[i] + c * g->to_vy[i]};
}

// Find the forces at the end of the substep: with w = h (c + h k) / m of each grip,
//     F_i = (F_i' + F_i' (sum of the other w) - w_i (sum of the other F')) / (1 + sum of all w)
// where F' are the forces without any motion by grips. Return the sum of the F'/(1 + sum of all w).
static pull find_forces(gripped *g) {
    double weights[SPEC_GRIPS], all = 0.0;
    pull starts[SPEC_GRIPS], sum = {0.0, 0.0};
    for (uint32_t i = 0; i < g->count; i++) {
        const double k = (double)g->grips[i]->stiffness, c = (double)g->grips[i]->damping;
        const pull start = pull_at_start(g, i);
        starts[i] = (pull){g->parts[i] * start.x, g->parts[i] * start.y};
        weights[i] = g->h * (c + g->h * k) * g->inverse_mass * g->parts[i];
        sum = (pull){sum.x + starts[i].x, sum.y + starts[i].y};
        all += weights[i];
    }
    const double share = 1.0 / (1.0 + all);
    for (uint32_t i = 0; i < g->count; i++) {
        pull others = {0.0, 0.0};
        double weight = 0.0;
        for (uint32_t k = 0; k < g->count; k++) {
            others.x += k != i ? starts[k].x : 0.0;
            others.y += k != i ? starts[k].y : 0.0;
            weight += k != i ? weights[k] : 0.0;
        }
        g->forces[i] = (pull){share * (starts[i].x + (weight * starts[i].x - weights[i] * others.x)),
                              share * (starts[i].y + (weight * starts[i].y - weights[i] * others.y))};
    }
    return (pull){share * sum.x, share * sum.y};
}

// The part of a grip that keeps it within its bound, if all of it would give this force.
static double part_of(const spec_grip *grip, pull force) {
    const double size = sqrt(force.x * force.x + force.y * force.y), most = (double)grip->max_force;
    return fmax(size > most ? most / size : 1.0, 1e-30);
}

// Several grips: begin with the parts of a particle that does not move, and renew them by the forces that they gave
// until none changes by more than 1e-7 of itself, at most 64 times. What is still over its bound makes all forces
// smaller alike.
static pull find_bounded_forces(gripped *g) {
    bool goes_on = true;
    for (uint32_t i = 0; i < g->count; i++) {
        g->parts[i] = part_of(g->grips[i], pull_at_start(g, i));
    }
    pull sum = find_forces(g);
    for (int pass = 0; pass < 64 && goes_on; pass++) {
        goes_on = false;
        for (uint32_t i = 0; i < g->count; i++) {
            const double had = g->parts[i];
            g->parts[i] = part_of(g->grips[i], (pull){g->forces[i].x / had, g->forces[i].y / had});
            goes_on |= fabs(g->parts[i] - had) > 1e-7 * had;
        }
        sum = goes_on ? find_forces(g) : sum;
    }
    double least = 1.0;
    for (uint32_t i = 0; i < g->count; i++) {
        least = fmin(least, part_of(g->grips[i], g->forces[i]));
    }
    return (pull){least * sum.x, least * sum.y};
}

// A single grip: F = (k (t - p) + c (u - v)) / (1 + (h c + h^2 k) / m), made smaller to its bound.
static pull find_force(gripped *g) {
    g->parts[0] = 1.0;
    (void)find_forces(g);
    const pull force = g->forces[0];
    const double size = sqrt(force.x * force.x + force.y * force.y), most = (double)g->grips[0]->max_force;
    return size > most ? (pull){force.x * (most / size), force.y * (most / size)} : force;
}

static void collect(const spec_network *network, uint32_t particle, uint32_t substep, uint32_t count, gripped *g) {
    const double part = 1.0 / (double)count, share = (double)substep * part + part, seconds = g->h / part;
    g->count = 0;
    g->x = spec_x_of(network, particle);
    g->y = spec_y_of(network, particle);
    g->vx = (double)network->motions[particle].velocity.x;
    g->vy = (double)network->motions[particle].velocity.y;
    g->inverse_mass = (double)network->inverse_masses[particle];
    for (uint32_t k = 0; k < network->grip_count; k++) {
        const spec_grip *grip = &network->grips[k];
        const uint32_t i = g->count;
        const double way_x = grip->x - grip->from_x, way_y = grip->y - grip->from_y;
        if (grip->particle != particle) {
            continue;
        }
        g->grips[i] = grip;
        g->to_x[i] = (grip->from_x + share * way_x) - network->origin_x - g->x;
        g->to_y[i] = (grip->from_y + share * way_y) - network->origin_y - g->y;
        g->to_vx[i] = way_x / seconds - g->vx;
        g->to_vy[i] = way_y / seconds - g->vy;
        g->count++;
    }
}

void spec_pull_grips(const spec_network *network, uint32_t substep, uint32_t count, float h) {
    for (uint32_t p = 0; p < network->particle_count; p++) {
        gripped g = {.h = (double)h};
        collect(network, p, substep, count, &g);
        if (g.count == 0 || !(g.inverse_mass > 0.0)) {
            continue;
        }
        const pull force = g.count == 1 ? find_force(&g) : find_bounded_forces(&g);
        const double change_x = g.h * g.inverse_mass * force.x, change_y = g.h * g.inverse_mass * force.y;
        spec_bounce to = {true, g.x + g.h * change_x, g.y + g.h * change_y, g.vx + change_x, g.vy + change_y};
        spec_stop_at_floor(network, g.x, g.y, g.h, &to);
        network->motions[p].velocity = (spec_vector){(float)to.vx, (float)to.vy};
        spec_put(network, p, to.x, to.y);
    }
}
