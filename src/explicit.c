/// The explicit solver: symplectic Euler, row by row.
#include <string.h>

#include "decay.h"
#include "network.h"

// Pack what the web sees of its nodes.
static void pack_nodes(const mspring_network *network, const mspringi_sweep *sweep) {
    const mspringi_topology *t = &network->topology;
    network->kernels->pack(sweep, t->web_first, t->web_blocks, network->packed);
    float *packed = network->packed + (size_t)4 * t->web.own_count;
    for (uint32_t i = 0; i < t->web.attached_count && t->web.attached_slot[i] != MSPRING_NONE; ++i, packed += 4) {
        const uint32_t slot = t->web.attached_slot[i];
        packed[0] = sweep->x[slot];
        packed[1] = sweep->y[slot];
        packed[2] = sweep->vx[slot];
        packed[3] = sweep->vy[slot];
    }
}

// Put the web's pull at its attached nodes on top of base into the total field.
static void pull_attached(const mspring_network *network, const mspringi_sweep *sweep, mspringi_field base) {
    const mspringi_web *web = &network->topology.web;
    const mspringi_field total = network->forces.total;
    float *pull_x = network->attached, *pull_y = network->attached + web->attached_count;
    network->kernels->attached[network->parts > MSPRINGI_DAMPING](sweep, pull_x, pull_y);
    for (uint32_t i = 0; i < web->attached_count && web->attached_slot[i] != MSPRING_NONE; ++i) {
        const uint32_t slot = web->attached_slot[i];
        total.x[slot] = base.x ? base.x[slot] + pull_x[i] : pull_x[i];
        total.y[slot] = base.x ? base.y[slot] + pull_y[i] : pull_y[i];
    }
}

static void sweep_span(const mspringi_kernels *kernels, const mspringi_sweep *sweep, const mspringi_span *span,
                       mspringi_edge *edge, bool damped, bool forced) {
    switch (span->kind) {
    case MSPRINGI_ROW_LATTICE:
        kernels->lattice[damped][forced](sweep, span, edge);
        break;
    case MSPRINGI_ROW_CHAIN:
        kernels->chain[damped][forced](sweep, span, edge);
        break;
    case MSPRINGI_ROW_WEB:
        kernels->web[damped][forced](sweep, span, edge);
        break;
    case MSPRINGI_ROW_LOOSE:
        kernels->loose[forced](sweep, span, edge);
        break;
    }
}

void mspringi_explicit_substep(mspring_network *network, float h, mspringi_field base) {
    const mspringi_topology *t = &network->topology;
    const bool damped = network->parts > MSPRINGI_DAMPING, pulled = t->web.attached_count > 0;
    const mspringi_field field = pulled ? network->forces.total : base;
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
        .web = &t->web,
        .web_springs = network->web_springs,
        .packed = network->packed,
        .parts = network->parts,
        .h = h,
        .decay = mspringi_decay(network->global_damping, h),
        .gravity_h_x = network->gravity_x * h,
        .gravity_h_y = network->gravity_y * h,
    };
    if (t->web.group_count > 0)
        pack_nodes(network, &sweep);
    if (pulled)
        pull_attached(network, &sweep, base);

    mspringi_edge edge;
    for (uint32_t i = 0; i < t->span_count; ++i) {
        const mspringi_span *span = &t->spans[i];
        if (!span->continues)
            memset(&edge, 0, sizeof edge);
        sweep_span(network->kernels, &sweep, span, &edge, damped, base.x || span->pulled);
    }
}
