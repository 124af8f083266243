/// Friction and restitution, layers and masks of single particles.
#include <math.h>

#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "store/changed.h"
#include "store/properties.h"

// Values of a particle without its own.
static const mspringi_contact_material none = {-1.0f, -1.0f};

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

const mspringi_contact_material *mspringi_contact_own(const mspring_network *network, size_t slot) {
    const mspring_id particle = network->topology.particle_of_slot[slot];
    const mspringi_contact_material *materials = network->contacts ? network->contacts->materials : NULL;
    return !materials ? NULL : particle == MSPRING_NONE ? &none : &materials[particle];
}

/* -------------------------------------------------------------------------------------------------- properties */

mspringi_contact_material mspringi_contact_material_of(const mspring_network *network, mspring_id particle) {
    const mspringi_contacts *contacts = network->contacts;
    return contacts && contacts->materials ? contacts->materials[particle] : none;
}

uint32_t mspringi_contact_layers_of(const mspring_network *network, mspring_id particle) {
    return network->contacts ? network->contacts->layers[particle] : 1;
}

uint32_t mspringi_contact_masks_of(const mspring_network *network, mspring_id particle) {
    return network->contacts ? network->contacts->masks[particle] : UINT32_MAX;
}

static mspring_result check_contact(mspring_network *network, mspring_property property) {
    return network->contacts ? MSPRING_OK
                             : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                             "the property %s is of contact, and there is none: call "
                                             "mspring_network_set_contact() first",
                                             mspringi_property_of(property)->name);
}

mspring_result mspringi_contact_reserve_materials(mspring_network *network) {
    mspringi_contacts *contacts = network->contacts;
    if (contacts->materials)
        return MSPRING_OK;
    contacts->materials = mspringi_alloc(&network->memory, contacts->particles, sizeof *contacts->materials);
    if (!contacts->materials)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for friction and restitution of %u particles",
                             (unsigned)contacts->particles);
    for (uint32_t p = 0; p < contacts->particles; ++p)
        contacts->materials[p] = none;
    return MSPRING_OK;
}

mspring_result mspringi_contact_set_material(mspring_network *network, const mspringi_selection *at,
                                             const mspringi_values *values) {
    const bool is_friction = values->property == MSPRING_FRICTION;
    bool any = false;
    mspring_result result = check_contact(network, values->property);
    for (uint32_t i = 0; result == MSPRING_OK && !any && i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        const mspringi_contact_material had = mspringi_contact_material_of(network, p);
        any = mspringi_particle_exists(network, p) &&
              (is_friction ? had.friction : had.restitution) != values->first[i * values->stride];
    }
    if (any)
        result = mspringi_contact_reserve_materials(network);
    if (result != MSPRING_OK || !any)
        return result;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        mspringi_contact_material *of = &network->contacts->materials[p];
        if (mspringi_particle_exists(network, p))
            *(is_friction ? &of->friction : &of->restitution) = values->first[i * values->stride];
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_CONTACT, 0);
    return MSPRING_OK;
}

mspring_result mspringi_contact_set_layers(mspring_network *network, mspring_property property,
                                           const mspringi_selection *at, const uint32_t *values, size_t stride) {
    bool any = false;
    const mspring_result result = check_contact(network, property);
    if (result != MSPRING_OK)
        return result;
    mspringi_contacts *contacts = network->contacts;
    uint32_t *of = property == MSPRING_LAYERS ? contacts->layers : contacts->masks;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        if (!mspringi_particle_exists(network, p) || of[p] == values[i * stride])
            continue;
        of[p] = values[i * stride];
        any = true;
    }
    if (any) {
        contacts->is_listed = contacts->is_fresh = false;
        mspringi_notify_change(network, MSPRINGI_CHANGED_CONTACT, 0);
    }
    return MSPRING_OK;
}

void mspringi_contact_take_in(mspring_network *network, mspring_id particle) {
    mspringi_contacts *contacts = network->contacts;
    if (!contacts)
        return;
    contacts->layers[particle] = 1;
    contacts->masks[particle] = UINT32_MAX;
    mspringi_contact_forget_impulses_of(network, particle);
    if (contacts->materials)
        contacts->materials[particle] = none;
    mspringi_outline_take_in(network, &contacts->outline, particle);
}
