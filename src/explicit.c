/// The explicit solver: symplectic Euler, row by row.
#include <math.h>
#include <string.h>

#include "decay.h"
#include "network.h"

void mspringi_leftovers_pull(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    const mspringi_field total = network->forces.total;
    for (uint32_t i = 0; i < t->leftover_count; ++i) {
        const uint32_t a = t->leftover_a[i], b = t->leftover_b[i];
        const mspringi_leftover spring = network->leftovers[i];
        const float dx = s->x[b] - s->x[a], dy = s->y[b] - s->y[a];
        const float length = sqrtf(dx * dx + dy * dy);
        const float inverse = length > 0.0f ? 1.0f / length : 0.0f;
        const float dvx = s->vx[b] - s->vx[a], dvy = s->vy[b] - s->vy[a];
        const float rate = (dvx * dx + dvy * dy) * inverse;
        const float force = ((length - spring.rest_length) * spring.stiffness + rate * spring.damping) * inverse;
        total.x[a] += force * dx;
        total.y[a] += force * dy;
        total.x[b] -= force * dx;
        total.y[b] -= force * dy;
    }
}

void mspringi_explicit_substep(mspring_network *network, float h, mspringi_field field) {
    const mspringi_topology *t = &network->topology;
    const mspringi_kernels *kernels = network->kernels;
    const bool damped = network->parts > MSPRINGI_DAMPING, forced = field.x != NULL;
    const mspringi_sweep sweep = {
        .x = network->state.x,
        .y = network->state.y,
        .vx = network->state.vx,
        .vy = network->state.vy,
        .inverse_mass = network->inverse_mass,
        .force_x = field.x,
        .force_y = field.y,
        .carry_x = network->carry,
        .carry_y = network->carry + (size_t)t->carry_blocks * MSPRINGI_WIDTH,
        .lattice_springs = network->lattice_springs,
        .chain_springs = network->chain_springs,
        .parts = network->parts,
        .h = h,
        .decay = mspringi_decay(network->global_damping, h),
        .gravity_h_x = network->gravity_x * h,
        .gravity_h_y = network->gravity_y * h,
    };
    mspringi_edge edge;
    for (uint32_t i = 0; i < t->span_count; ++i) {
        const mspringi_span *span = &t->spans[i];
        if (!span->continues)
            memset(&edge, 0, sizeof edge);
        switch (span->kind) {
        case MSPRINGI_ROW_LATTICE:
            kernels->lattice[damped][forced](&sweep, span, &edge);
            break;
        case MSPRINGI_ROW_CHAIN:
            kernels->chain[damped][forced](&sweep, span, &edge);
            break;
        case MSPRINGI_ROW_LOOSE:
            kernels->loose[forced](&sweep, span, &edge);
            break;
        }
    }
}
