/// Stiffness of floor contacts in the linear system: a diagonal block for each particle.
#include "solvers/implicit/implicit_terms.h"

static bool next_hold(const mspring_network *network, uint32_t *at, mspringi_slot_stiffness *hold) {
    return network->floor && *at < network->floor->contact_count && mspringi_floor_hold(network, (*at)++, hold);
}

double mspringi_holds_multiply(const mspring_network *network, mspringi_field from, mspringi_field to) {
    mspringi_slot_stiffness hold;
    double sum = 0.0;
    for (uint32_t at = 0; next_hold(network, &at, &hold);) {
        const double x = (double)from.x[hold.slot], y = (double)from.y[hold.slot];
        const double to_x = hold.xx * x + hold.xy * y, to_y = hold.xy * x + hold.yy * y;
        to.x[hold.slot] += (float)to_x;
        to.y[hold.slot] += (float)to_y;
        sum += x * to_x + y * to_y;
    }
    return sum;
}

void mspringi_holds_stiffen(const mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_slot_stiffness hold;
    for (uint32_t at = 0; next_hold(network, &at, &hold);)
        if (n->tiles.of_slot[hold.slot] != MSPRING_NONE)
            mspringi_coarse_add(&n->coarse, n->tiles.of_slot[hold.slot], hold.xx, hold.xy, hold.yy,
                                (double)n->arm.x[hold.slot], (double)n->arm.y[hold.slot]);
}

void mspringi_holds_add_nodes(const mspring_network *network, double *xx, double *xy, double *yy) {
    mspringi_slot_stiffness hold;
    for (uint32_t at = 0; next_hold(network, &at, &hold);) {
        xx[hold.slot] += hold.xx;
        xy[hold.slot] += hold.xy;
        yy[hold.slot] += hold.yy;
    }
}
