/// Violence of a motion: the rate at which the ends of springs move against each other.
///
/// Squares of differences of velocities are compared with the largest so far for a spring of the shortest length,
/// so few springs need more than that.
#include <math.h>

#include "stability/stability.h"
#include "store/springs.h"

// No two velocities differ by more than 2 sqrt(2) times the largest component.
#define LARGEST_DIFFERENCE 2.8285

double mspringi_violence_bound(const mspring_network *network) {
    const bool is_known = network->guard.state == network->edits.state && !network->is_open &&
                          isfinite(network->shortest_set) && !network->tested.is_bent;
    return is_known ? LARGEST_DIFFERENCE * (double)network->guard.speed / (double)network->shortest_set : INFINITY;
}

static float square_of_rate(const mspring_network *network, mspringi_spring_slot slot) {
    const mspringi_state *s = &network->state;
    const mspringi_spring_values spring = mspringi_spring_slot_get(network, slot);
    const float vx = s->vx[spring.tip] - s->vx[spring.base], vy = s->vy[spring.tip] - s->vy[spring.base];
    const float length = spring.rest_length;
    return length > MSPRINGI_WELD ? (vx * vx + vy * vy) / (length * length) : 0.0f; // a weld is linear
}

// Raise the largest square of a rate to those of the spring slots first ... end - 1.
static float raise_square(const mspring_network *network, mspringi_spring_slot first, mspringi_spring_slot end,
                          float shortest, float most) {
    const mspringi_state *s = &network->state;
    for (mspringi_spring_slot slot = first; slot < end; ++slot) {
        uint32_t base, tip;
        if (!mspringi_spring_slot_is_live(network, slot))
            continue;
        mspringi_topology_ends(&network->topology, slot, &base, &tip);
        const float vx = s->vx[tip] - s->vx[base], vy = s->vy[tip] - s->vy[base];
        if (!(vx * vx + vy * vy > most * (shortest * shortest)))
            continue;
        const float square = square_of_rate(network, slot);
        most = square > most ? square : most;
    }
    return most;
}

double mspringi_violence(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_spring_slot of_block = MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
    const float shortest =
        isfinite(network->shortest_set) && !network->tested.is_bent ? network->shortest_set : 0.0f;
    mspringi_violence_sweep sweep = {.vx = network->state.vx,
                                     .vy = network->state.vy,
                                     .up_of_block = t->up_of_block,
                                     .lattice_first = t->lattice_first,
                                     .live = network->live};
    float most = 0.0f;
    for (uint32_t block = 0; block < t->lattice_blocks; ++block) {
        sweep.square = most * (shortest * shortest);
        block = network->kernels->lattice_violence(&sweep, block, t->lattice_blocks);
        if (block < t->lattice_blocks)
            most = raise_square(network, block * of_block, (block + 1) * of_block, shortest, most);
    }
    most = raise_square(network, t->lattice_spring_slots,
                        (mspringi_spring_slot)(mspringi_spring_slot_words(t) * MSPRINGI_WIDTH), shortest, most);
    return sqrt((double)most);
}
