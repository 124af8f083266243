#include "stability/pencil.h"

#include <math.h>

#include "base/decay.h"
#include "stability/stability.h"
#include "stability/stability_elements.h"
#include "stability/stability_limit.h"
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
    const mspringi_state *s = &network->state;
    const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
    const double dx = (double)s->x[values.tip] - (double)s->x[values.base];
    const double dy = (double)s->y[values.tip] - (double)s->y[values.base];
    const double length = sqrt(dx * dx + dy * dy);
    mspringi_linear_spring seen = {.a = values.base, .b = values.tip, .directed = length > 0.0};
    if (mspringi_spring_slot_is_live(network, spring_slot))
        seen.strength = mspringi_strength_of(network, spring, spring_slot, values.base, values.tip,
                                             &(mspringi_last_masses){0.0, 0.0, 0.0});
    if (seen.directed) {
        seen.nx = dx / length;
        seen.ny = dy / length;
        seen.across = 1.0 - (double)values.rest_length / length;
    }
    return seen;
}

// Add a spring's part for a displacement (dx, dy) of b relative to a.
static void add_to_quotient(mspringi_quotient *quotient, const mspringi_linear_spring *s, double dx, double dy) {
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
    pencil->limit = mspringi_stability_limit_at(network, h);
    pencil->limit.inverse_mass = network->inverse_mass;
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
        pencil->terms[i].xx = (float)(all + along * s.nx * s.nx);
        pencil->terms[i].xy = (float)(along * s.nx * s.ny);
        pencil->terms[i].yy = (float)(all + along * s.ny * s.ny);
    }
}

void mspringi_pencil_add_image(void *context, mspringi_displacement in, mspringi_displacement out) {
    mspringi_pencil *pencil = context;
    const float *inverse_mass = pencil->network->inverse_mass;
    for (mspring_id i = 0; i < pencil->network->topology.spring_count; ++i) {
        const struct mspringi_pencil_term *s = &pencil->terms[i];
        const float dx = in.x[s->b] - in.x[s->a], dy = in.y[s->b] - in.y[s->a];
        const float fx = s->xx * dx + s->xy * dy, fy = s->xy * dx + s->yy * dy;
        out.x[s->a] -= inverse_mass[s->a] * fx;
        out.y[s->a] -= inverse_mass[s->a] * fy;
        out.x[s->b] += inverse_mass[s->b] * fx;
        out.y[s->b] += inverse_mass[s->b] * fy;
    }
    pencil->limit.in[0] = in.x;
    pencil->limit.in[1] = in.y;
    pencil->limit.out[0] = out.x;
    pencil->limit.out[1] = out.y;
    mspringi_stability_elements_image(pencil->network, &pencil->limit, pencil->square);
}

mspringi_quotient mspringi_pencil_quotient(const mspringi_pencil *pencil, mspringi_displacement vector) {
    mspringi_quotient sum = {0.0, 0.0, 0.0};
    for (mspring_id i = 0; i < pencil->network->topology.spring_count; ++i) {
        const mspringi_spring_slot spring_slot = pencil->network->topology.slot_of_spring[i];
        if (!mspringi_spring_exists(pencil->network, i))
            continue;
        mspringi_linear_spring s = linearise_conservatively(pencil->network, i, spring_slot);
        const double dx = (double)vector.x[s.b] - (double)vector.x[s.a];
        const double dy = (double)vector.y[s.b] - (double)vector.y[s.a];
        if (!s.directed) { // a direction along the displacement is the worst
            const double length = sqrt(dx * dx + dy * dy);
            s.nx = length > 0.0 ? dx / length : 0.0;
            s.ny = length > 0.0 ? dy / length : 0.0;
        }
        add_to_quotient(&sum, &s, dx, dy);
    }
    mspringi_stability_elements_quotient(pencil->network, vector, &sum);
    return sum;
}
