/// Colliders in the way of the energy budget.
///
/// Impulses leave nothing too deep in a collider after the substep (implicit_contact.c). Then the budget shifts
/// components, or moves them back. A component that this would press into a collider stays at the end of its
/// substep. Otherwise a body between a heavy one and a wall passes the wall, a share of the thickness in each
/// substep.
#include "solvers/implicit/implicit_terms.h"

/// Largest depth that is ignored, as a share of the thickness: twice the rounding that impulses leave.
#define UNSEEN_SHARE 2e-6

/// Constraint between a collider and a component.
typedef struct wall {
    uint32_t slot;   ///< of a particle of the component
    double nx, ny;   ///< normal from the collider to the component
    double deepened; ///< increase of the depth in the substep beyond what it may, m
} wall;

static uint32_t slot_of(const mspring_network *network, uint32_t node) {
    return network->topology.slot_of_particle[network->contacts->nodes.particles[node]];
}

// Add a share of a node's displacement in a substep of h.
static void add_way(const mspring_network *network, uint32_t node, double share, double h, double way[2]) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    const mspringi_state *s = &network->state;
    if (node >= k->particle_count) {
        way[0] += share * h * k->v[node].x;
        way[1] += share * h * k->v[node].y;
        return;
    }
    way[0] += share * (mspringi_x_of(s, slot_of(network, node)) - k->x[node]);
    way[1] += share * (mspringi_y_of(s, slot_of(network, node)) - k->y[node]);
}

static wall wall_of(const mspring_network *network, const mspringi_contact_constraint *t, double h) {
    const bool is_of_point = t->p < network->contacts->nodes.particle_count;
    const double sign = is_of_point ? 1.0 : -1.0;
    const double least = (t->gap < 0.0 ? t->gap : 0.0) - mspringi_implicit_contact_growth(network, t);
    double way[2] = {0.0, 0.0};
    add_way(network, t->p, 1.0, h, way);
    add_way(network, t->a, -t->bary_a, h, way);
    add_way(network, t->b, -t->bary_b, h, way);
    return (wall){.slot = slot_of(network, is_of_point ? t->p : t->a),
                  .nx = sign * t->nx,
                  .ny = sign * t->ny,
                  .deepened = least - (t->gap + way[0] * t->nx + way[1] * t->ny)};
}

// Let a component stay at the end of its substep: its velocities pay for what its springs have too much. If that is
// not enough, it goes back from there towards its start, which no collider at rest is in the way of. Returns true
// if this changes its position.
static bool stop_at(mspringi_component_budget *a, bool is_moving) {
    if (a->is_stopped && (!is_moving || a->share == 1.0))
        return false;
    a->is_stopped = true;
    a->stop_slot = MSPRING_NONE;
    a->share = 1.0;
    return true;
}

void mspringi_walls_stop_shifted(const mspring_network *network, double h) {
    const mspringi_contacts *contacts = network->contacts;
    mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    for (uint32_t i = 0; mspringi_implicit_contact_is_near(network) && i < contacts->constraint_count; ++i) {
        if (contacts->constraints[i].collider == MSPRING_NONE)
            continue;
        const wall w = wall_of(network, &contacts->constraints[i], h);
        if (budget->of_slot[w.slot] == MSPRINGI_NO_COMPONENT)
            continue;
        mspringi_component_budget *a = &budget->components[budget->of_slot[w.slot]];
        const double deepened = w.deepened - (w.nx * a->shift_x + w.ny * a->shift_y);
        if ((a->shift_x == 0.0 && a->shift_y == 0.0) || !(deepened > UNSEEN_SHARE * contacts->thickness))
            continue;
        a->is_stopped = true;
        a->stop_slot = MSPRING_NONE;
    }
}

bool mspringi_walls_stop_back(const mspring_network *network, double h) {
    const mspringi_contacts *contacts = network->contacts;
    mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    bool any = false;
    for (uint32_t i = 0; mspringi_implicit_contact_is_near(network) && i < contacts->constraint_count; ++i) {
        const uint32_t number = contacts->constraints[i].collider;
        if (number == MSPRING_NONE)
            continue;
        const wall w = wall_of(network, &contacts->constraints[i], h);
        if (budget->of_slot[w.slot] == MSPRINGI_NO_COMPONENT)
            continue;
        mspringi_component_budget *a = &budget->components[budget->of_slot[w.slot]];
        if (a->exceeds && w.deepened > UNSEEN_SHARE * contacts->thickness)
            any |= stop_at(a, contacts->colliders.list[number].is_moving);
    }
    return any;
}
