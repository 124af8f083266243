#include "stability/pencil.h"

#include <math.h>
#include <string.h>

#include "base/decay.h"
#include "stability/stability.h"
#include "store/springs.h"

double mspringi_quotient_limit(const mspringi_quotient *q, float global_damping) {
    double h = 0.0;
    // Global damping raises the bound with h: iterate from below to the first h that meets it.
    for (int turn = 0; turn < 100; ++turn) {
        const double bound = mspringi_stability_bound(global_damping, (float)h), room = bound - q->relative;
        if (!(room >= 0.0))
            return 0.0;
        if (room == INFINITY)
            return INFINITY;
        // Positive root of h^2 stiffness + 2 h damping = room, without cancellation.
        const double divisor = q->damping + sqrt(q->damping * q->damping + q->stiffness * room);
        const double before = h;
        h = divisor > 0.0 ? room / divisor : INFINITY;
        if (!(global_damping > 0.0f) || !(h - before > 1e-9 * h) || !(h <= 1e30))
            break;
    }
    return h;
}

mspringi_linear_spring mspringi_linearise_spring(const mspring_network *network, mspring_id spring,
                                                 mspringi_spring_slot spring_slot) {
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
    const double dx = (double)s->x[values.tip] - (double)s->x[values.base];
    const double dy = (double)s->y[values.tip] - (double)s->y[values.base];
    const double length = sqrt(dx * dx + dy * dy);
    mspringi_linear_spring seen = {
        .a = t->particle_of_slot[values.base], .b = t->particle_of_slot[values.tip], .directed = length > 0.0};
    if (mspringi_spring_slot_is_live(network, spring_slot))
        seen.strength = mspringi_strength_of(network, spring, spring_slot);
    if (seen.directed) {
        seen.nx = dx / length;
        seen.ny = dy / length;
        seen.across = 1.0 - (double)values.rest_length / length;
    }
    return seen;
}

void mspringi_quotient_add(mspringi_quotient *quotient, const mspringi_linear_spring *s, double dx, double dy) {
    const double along = s->nx * dx + s->ny * dy, across = s->ny * dx - s->nx * dy;
    const double stretch = along * along + s->across * across * across, speed = along * along;
    quotient->stiffness += s->strength.stiffness * stretch;
    quotient->damping += s->strength.damping * speed;
    quotient->relative += s->strength.relative_stiffness * stretch + 2.0 * s->strength.relative_damping * speed;
}

// Linearise a spring conservatively: see mspringi_pencil_set().
static mspringi_linear_spring linearise_conservatively(const mspring_network *network, mspring_id spring,
                                                       mspringi_spring_slot spring_slot) {
    mspringi_linear_spring seen = mspringi_linearise_spring(network, spring, spring_slot);
    if (!seen.directed)
        seen.across = 1.0;
    else if (!(seen.across > 0.0))
        seen.across = 0.0;
    return seen;
}

void mspringi_pencil_set(mspringi_pencil *pencil, double h) {
    const mspring_network *network = pencil->network;
    pencil->square = h * h;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p)
        pencil->root[p] = sqrt((double)network->inverse_mass[network->topology.slot_of_particle[p]]);
    for (mspring_id i = 0; i < network->topology.spring_count; ++i) {
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[i];
        pencil->terms[i] = (struct mspringi_pencil_term){0};
        if (!mspringi_spring_exists(network, i))
            continue;
        const mspringi_linear_spring s = linearise_conservatively(network, i, spring_slot);
        const double stiffness = h * h * s.strength.stiffness + s.strength.relative_stiffness;
        const double damping = 2.0 * (h * s.strength.damping + s.strength.relative_damping);
        const double all = s.directed ? stiffness * s.across : stiffness + damping;
        const double along = s.directed ? stiffness * (1.0 - s.across) + damping : 0.0;
        pencil->terms[i].a = s.a;
        pencil->terms[i].b = s.b;
        pencil->terms[i].xx = all + along * s.nx * s.nx;
        pencil->terms[i].xy = along * s.nx * s.ny;
        pencil->terms[i].yy = all + along * s.ny * s.ny;
    }
}

void mspringi_pencil_apply(const void *context, const double *in, double *out) {
    const mspringi_pencil *pencil = context;
    const mspringi_topology *t = &pencil->network->topology;
    memset(out, 0, 2 * (size_t)t->particle_count * sizeof *out);
    for (mspring_id i = 0; i < t->spring_count; ++i) {
        const struct mspringi_pencil_term *term = &pencil->terms[i];
        const size_t a = 2 * (size_t)term->a, b = 2 * (size_t)term->b;
        const double root_a = pencil->root[term->a], root_b = pencil->root[term->b];
        const double dx = root_b * in[b] - root_a * in[a], dy = root_b * in[b + 1] - root_a * in[a + 1];
        const double fx = term->xx * dx + term->xy * dy, fy = term->xy * dx + term->yy * dy;
        out[a] -= root_a * fx;
        out[a + 1] -= root_a * fy;
        out[b] += root_b * fx;
        out[b + 1] += root_b * fy;
    }
    mspringi_areas_apply(pencil, in, out);
}

mspringi_quotient mspringi_pencil_quotient(const mspringi_pencil *pencil, const double *vector) {
    mspringi_quotient sum = {0.0, 0.0, 0.0};
    for (mspring_id i = 0; i < pencil->network->topology.spring_count; ++i) {
        const mspringi_spring_slot spring_slot = pencil->network->topology.slot_of_spring[i];
        if (!mspringi_spring_exists(pencil->network, i))
            continue;
        mspringi_linear_spring s = linearise_conservatively(pencil->network, i, spring_slot);
        const double *const at_a = vector + 2 * (size_t)s.a, *const at_b = vector + 2 * (size_t)s.b;
        const double dx = pencil->root[s.b] * at_b[0] - pencil->root[s.a] * at_a[0];
        const double dy = pencil->root[s.b] * at_b[1] - pencil->root[s.a] * at_a[1];
        if (!s.directed) { // a direction along the displacement is the worst
            const double length = sqrt(dx * dx + dy * dy);
            s.nx = length > 0.0 ? dx / length : 0.0;
            s.ny = length > 0.0 ? dy / length : 0.0;
        }
        mspringi_quotient_add(&sum, &s, dx, dy);
    }
    mspringi_areas_quotient(pencil, vector, &sum);
    return sum;
}
