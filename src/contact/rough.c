/// Friction and restitution of particles of their own.
#include <math.h>

#include "contact/pairs.h"
#include "store/changed.h"

#define MOST_FRICTION 1e6f

/* --------------------------------------------------------------------------------------------------------- rule */

// A node's own values, or what stands for them.
static mspringi_rough of_node(const mspringi_pairs *pairs, mspring_id node, mspringi_rough other) {
    if (mspringi_is_of_collider(pairs, node))
        return other;
    const mspringi_rough own = pairs->rough[node];
    return (mspringi_rough){own.friction < 0.0f ? other.friction : own.friction,
                            own.restitution < 0.0f ? other.restitution : own.restitution};
}

// The root of a square is exact, so values that are the contact's own change no bits.
mspringi_rough mspringi_rough_between(const mspringi_pairs *pairs, const mspringi_pair *pair,
                                      const mspringi_collider *collider) {
    const mspringi_rough other = collider ? (mspringi_rough){collider->def.friction, collider->def.restitution}
                                          : (mspringi_rough){pairs->def.friction, pairs->def.restitution};
    const mspringi_rough p = of_node(pairs, pair->point, other),
                         a = of_node(pairs, pairs->outline.a[pair->edge], other),
                         b = of_node(pairs, pairs->outline.b[pair->edge], other);
    const double friction = 0.5 * ((double)a.friction + (double)b.friction),
                 restitution = 0.5 * ((double)a.restitution + (double)b.restitution);
    return (mspringi_rough){(float)sqrt((double)p.friction * friction),
                            (float)fmax((double)p.restitution, restitution)};
}

/* ------------------------------------------------------------------------------------------------------ setting */

static mspring_result check(mspring_network *network, const char *name, float value, float most) {
    if (value == -1.0f || (value >= 0.0f && value <= most))
        return MSPRING_OK;
    return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                         "the particles' %s is %g, it must be 0 to %g, or -1 for the contact's", name,
                         (double)value, (double)most);
}

static mspring_result reserve(mspring_network *network) {
    mspringi_pairs *pairs = network->pairs;
    if (pairs->rough)
        return MSPRING_OK;
    pairs->rough = mspringi_alloc(&network->memory, pairs->particles, sizeof *pairs->rough);
    if (!pairs->rough)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for friction and restitution of %u particles", (unsigned)pairs->particles);
    for (uint32_t p = 0; p < pairs->particles; ++p)
        pairs->rough[p] = (mspringi_rough){-1.0f, -1.0f};
    return MSPRING_OK;
}

mspring_result mspring_network_set_contact_surface(mspring_network *network, mspring_id first, uint32_t count,
                                                   float friction, float restitution) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK && !network->pairs)
        result =
            mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                          "surfaces are of contact, and there is none: call mspring_network_set_contact() first");
    if (result == MSPRING_OK)
        result = mspringi_check_range(network, "particle", first, count, network->topology.particle_count);
    if (result == MSPRING_OK)
        result = check(network, "friction", friction, MOST_FRICTION);
    if (result == MSPRING_OK)
        result = check(network, "restitution", restitution, 1.0f);
    if (result == MSPRING_OK)
        result = reserve(network);
    if (result != MSPRING_OK)
        return result;
    for (mspring_id p = first; p < first + count; ++p)
        network->pairs->rough[p] = (mspringi_rough){friction, restitution};
    mspringi_changed(network, MSPRINGI_CHANGED_CONTACT, 0);
    return MSPRING_OK;
}
