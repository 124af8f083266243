/// Friction and restitution of single particles.
#include <math.h>

#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "store/changed.h"

/* --------------------------------------------------------------------------------------------------------- rule */

// A node's own values, or `other` for those it does not have.
static mspringi_contact_material of_node(const mspringi_contacts *contacts, mspring_id node,
                                         mspringi_contact_material other) {
    if (mspringi_is_collider_point(contacts, node))
        return other;
    const mspringi_contact_material own = contacts->materials[node];
    return (mspringi_contact_material){own.friction < 0.0f ? other.friction : own.friction,
                                       own.restitution < 0.0f ? other.restitution : own.restitution};
}

// The root of a square is exact, so equal values give the same bits as without values of particles.
mspringi_contact_material mspringi_contact_material_mix(const mspringi_contacts *contacts,
                                                        const mspringi_pair *pair,
                                                        const mspringi_collider *collider) {
    const mspringi_contact_material other =
        collider ? (mspringi_contact_material){collider->def.friction, collider->def.restitution}
                 : (mspringi_contact_material){contacts->def.friction, contacts->def.restitution};
    const mspringi_contact_material p = of_node(contacts, pair->point, other),
                                    a = of_node(contacts, contacts->outline.a[pair->edge], other),
                                    b = of_node(contacts, contacts->outline.b[pair->edge], other);
    const double friction = 0.5 * ((double)a.friction + (double)b.friction),
                 restitution = 0.5 * ((double)a.restitution + (double)b.restitution);
    return (mspringi_contact_material){(float)sqrt((double)p.friction * friction),
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
    mspringi_contacts *contacts = network->contacts;
    if (contacts->materials)
        return MSPRING_OK;
    contacts->materials = mspringi_alloc(&network->memory, contacts->particles, sizeof *contacts->materials);
    if (!contacts->materials)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for friction and restitution of %u particles",
                             (unsigned)contacts->particles);
    for (uint32_t p = 0; p < contacts->particles; ++p)
        contacts->materials[p] = (mspringi_contact_material){-1.0f, -1.0f};
    return MSPRING_OK;
}

mspring_result mspring_network_set_contact_surface(mspring_network *network, mspring_id first, uint32_t count,
                                                   float friction, float restitution) {
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK && !network->contacts)
        result =
            mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                          "surfaces are of contact, and there is none: call mspring_network_set_contact() first");
    if (result == MSPRING_OK)
        result = mspringi_check_range(network, "particle", first, count, network->topology.particle_count);
    if (result == MSPRING_OK)
        result = check(network, "friction", friction, (float)MSPRINGI_MOST_FRICTION);
    if (result == MSPRING_OK)
        result = check(network, "restitution", restitution, 1.0f);
    if (result == MSPRING_OK)
        result = reserve(network);
    if (result != MSPRING_OK)
        return result;
    for (mspring_id p = first; p < first + count; ++p)
        network->contacts->materials[p] = (mspringi_contact_material){friction, restitution};
    mspringi_notify_change(network, MSPRINGI_CHANGED_CONTACT, 0);
    return MSPRING_OK;
}
