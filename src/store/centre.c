#include "store/centre.h"

// Sums are relative to the first particle, so that the centre of a body far from the local origin loses no digits.
mspringi_selection_centre mspringi_selection_centre_of(const mspring_network *network, const mspringi_selection *at,
                                                       bool with_pinned) {
    const mspringi_state *s = &network->state;
    mspringi_selection_centre c = {0};
    double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (!mspringi_particle_exists(network, p) || (!with_pinned && !mspringi_is_free(network, p)))
            continue;
        if (c.count++ == 0) {
            c.x = mspringi_x_of(s, slot);
            c.y = mspringi_y_of(s, slot);
            c.vx = mspringi_vx_of(s, slot);
            c.vy = mspringi_vy_of(s, slot);
        }
        const double mass = (double)network->mass[p];
        c.mass += mass;
        x += mass * (mspringi_x_of(s, slot) - c.x);
        y += mass * (mspringi_y_of(s, slot) - c.y);
        vx += mass * (mspringi_vx_of(s, slot) - c.vx);
        vy += mass * (mspringi_vy_of(s, slot) - c.vy);
    }
    if (c.count > 0) {
        c.x += x / c.mass;
        c.y += y / c.mass;
        c.vx += vx / c.mass;
        c.vy += vy / c.mass;
    }
    return c;
}
