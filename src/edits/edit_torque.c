/// Torques: forces around the centre of mass of the free particles, added to the forces for the next step.
#include <math.h>

#include "base/cpu.h"
#include "store/centre.h"

static double inertia_of(const mspring_network *network, const mspringi_selection *at,
                         const mspringi_selection_centre *c) {
    double sum = 0.0;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double dx = mspringi_x_of(&network->state, slot) - c->x;
        const double dy = mspringi_y_of(&network->state, slot) - c->y;
        if (mspringi_particle_exists(network, p) && mspringi_is_free(network, p))
            sum += (double)network->mass[p] * (dx * dx + dy * dy);
    }
    return sum;
}

// Add the forces. The sums are computed in the backup, which is unused between steps, and copied if all are finite.
static mspring_result add_turn(mspring_network *network, const mspringi_selection *at,
                               const mspringi_selection_centre *c, double per_inertia) {
    const mspringi_field held = network->forces.held, made = {network->backup.vx, network->backup.vy};
    const uint32_t *slots = network->topology.slot_of_particle;
    for (uint32_t i = 0; i < at->count; ++i) {
        const uint32_t slot = slots[mspringi_selected(at, i)];
        made.x[slot] = held.x[slot];
        made.y[slot] = held.y[slot];
    }
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        const uint32_t slot = slots[p];
        if (!mspringi_particle_exists(network, p) || !mspringi_is_free(network, p))
            continue;
        const double scale = per_inertia * (double)network->mass[p];
        const double x = scale * (c->y - mspringi_y_of(&network->state, slot));
        const double y = scale * (mspringi_x_of(&network->state, slot) - c->x);
        made.x[slot] = (float)((double)made.x[slot] + x);
        made.y[slot] = (float)((double)made.y[slot] + y);
        if (!isfinite(made.x[slot]) || !isfinite(made.y[slot]))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "particle %u: the torque's force (%g, %g) N is not finite with what acts already",
                                 (unsigned)p, x, y);
    }
    for (uint32_t i = 0; i < at->count; ++i) {
        const uint32_t slot = slots[mspringi_selected(at, i)];
        held.x[slot] = made.x[slot];
        held.y[slot] = made.y[slot];
    }
    network->forces.held_any = true;
    network->forces.held_calls = MSPRINGI_MODEST_CALLS;
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE mspring_result apply(mspring_network *network, const mspringi_selection *at,
                                              double torque) {
    const mspringi_selection_centre c = mspringi_selection_centre_of(network, at, false);
    const double inertia = inertia_of(network, at, &c);
    if (!(inertia > 0.0))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "%u particles, %u of them free, are all in one place: a torque has no hold",
                             (unsigned)at->count, (unsigned)c.count);
    return add_turn(network, at, &c, torque / inertia);
}

mspring_result mspring_network_apply_torque(mspring_network *network, const mspring_id *ids, mspring_id first,
                                            uint32_t count, float torque) {
    mspringi_selection at;
    mspring_result result = mspringi_select(network, MSPRING_PARTICLES, ids, first, count, &at);
    if (result == MSPRING_OK && !isfinite(torque))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the torque is %g N m", (double)torque);
    if (result == MSPRING_OK)
        result = mspringi_field_reserve(network, &network->forces.held);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = apply(network, &at, (double)torque);
    mspringi_fp_leave(before);
    return result;
}
