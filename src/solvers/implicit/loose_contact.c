/// Loose particles in contact. They are in no tile and in no factor, and their rows of the matrix are their mass
/// alone, unless they may touch others: then constraints couple them, and they are unknowns of the system.
///
/// As long as they were none, each constraint of one was solved as if it flew otherwise. So a light one between a
/// heavy body and the ground sank into both by all that impulses may leave. Fragments in a box came into each other
/// by 0.4 thicknesses, and up to three quarters of their steps ran out of work.
#include <math.h>

#include "features/contact/contacts.h"
#include "solvers/implicit/implicit_terms.h"

static mspringi_slots loose_slots(const mspring_network *network) {
    const mspringi_slots all = {0, mspringi_slot_count(network)};
    return mspringi_loose_slots(&network->topology, &all);
}

bool mspringi_loose_contact_has(const mspring_network *network, uint32_t slot) {
    return slot != MSPRING_NONE && slot >= network->topology.loose_first * MSPRINGI_WIDTH &&
           *mspringi_coupling_of(network, mspringi_implicit_of(network), slot) == MSPRINGI_COUPLED_BY_CONTACT;
}

// Vectors of the iteration are 0 where nothing is solved for.
static void release(const mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots loose = loose_slots(network);
    for (size_t i = loose.first; n->has_touched && i < loose.end; ++i) {
        if (!mspringi_loose_contact_has(network, (uint32_t)i))
            continue;
        *mspringi_coupling_of(network, n, i) = MSPRINGI_UNCOUPLED;
        if (!n->is_direct)
            n->direction.x[i] = n->direction.y[i] = n->product.x[i] = n->product.y[i] = 0.0f;
    }
    n->has_touched = false;
}

static void couple(const mspring_network *network, uint32_t slot) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    if (slot == MSPRING_NONE || slot < network->topology.loose_first * MSPRINGI_WIDTH ||
        *mspringi_coupling_of(network, n, slot) == MSPRINGI_COUPLED_BY_SPRINGS)
        return;
    *mspringi_coupling_of(network, n, slot) = MSPRINGI_COUPLED_BY_CONTACT;
    n->has_touched = true;
}

void mspringi_loose_contact_couple(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const bool any = mspringi_implicit_contact_is_near(network) && n->contact_mode != MSPRINGI_CONTACT_BY_IMPULSES;
    const uint32_t count = any ? network->contacts->constraint_count : 0;
    release(network);
    for (uint32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k)
            couple(network, network->contacts->implicit_constraints[i].slots[k]);
}

void mspringi_loose_contact_keep_forces(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots loose = loose_slots(network);
    float *to = n->forces_of_loose;
    for (size_t i = loose.first; n->has_touched && i < loose.end; ++i) {
        *to++ = n->residual.x[i];
        *to++ = n->residual.y[i];
    }
}

void mspringi_loose_contact_end_solution(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots loose = loose_slots(network);
    for (size_t i = loose.first; n->has_touched && i < loose.end; ++i)
        if (mspringi_loose_contact_has(network, (uint32_t)i))
            n->scaled.x[i] = n->scaled.y[i] = 0.0f;
}

void mspringi_loose_contact_land(const mspring_network *network) {
    const mspringi_contacts *contacts = network->contacts;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots loose = loose_slots(network);
    const float *from = n->forces_of_loose;
    if (!n->has_touched)
        return;
    for (size_t i = loose.first; i < loose.end; ++i, from += 2) {
        if (!mspringi_loose_contact_has(network, (uint32_t)i))
            continue;
        n->residual.x[i] = from[0];
        n->residual.y[i] = from[1];
        if (!n->is_direct)
            n->direction.x[i] = n->direction.y[i] = 0.0f;
    }
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        const mspringi_implicit_constraint *c = &contacts->implicit_constraints[i];
        if (c->listed == MSPRING_NONE)
            continue;
        const mspringi_constraint *push = &network->constraints.list[c->listed];
        const double across = push->force, along = mspringi_friction_of(&network->constraints, push);
        for (int k = 0; k < 3; ++k) {
            if (!mspringi_loose_contact_has(network, c->slots[k]))
                continue;
            n->residual.x[c->slots[k]] += (float)(c->across[k][0] * across + c->along[k][0] * along);
            n->residual.y[c->slots[k]] += (float)(c->across[k][1] * across + c->along[k][1] * along);
        }
    }
    for (const mspringi_constraint *c = NULL; (c = mspringi_next_floor_push(&network->constraints, c)) != NULL;) {
        const mspringi_jacobian_entry *e = &network->constraints.entries[c->first];
        const double across = fmax(c->force, 0.0), along = mspringi_friction_of(&network->constraints, c);
        if (!mspringi_constraint_is_active(c) || !mspringi_loose_contact_has(network, e->slot))
            continue;
        n->residual.x[e->slot] += (float)(across * e->x - along * e->y);
        n->residual.y[e->slot] += (float)(across * e->y + along * e->x);
    }
}
