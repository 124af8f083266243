/// Energy budget of bodies in contact, all together.
///
/// The budget of a component counts the work of other bodies, so one body's gain should be another's loss. But
/// contact forces are only as accurate as the solution. In stiff networks they show in how little springs give way,
/// which rounding may hide. (Two lattices of 4.5e11 N/m had 46 times their energy after contact: momenta followed
/// an impulse of 464 N s instead of 20.) So the sums of all bodies in contact are checked, too. A substep that
/// gains energy is repeated in halves, and in the end without contact in the system. (As long as particles without
/// springs were left out, a rope that one of them hit gained 2.1 %.)
///
/// Colliders and pins at rest do no work. Moving ones do the work of their constraints. Pushing an overlap apart is
/// work, too, but no more than free bodies take: m dv^2 + I dw^2 of both, most of it the lighter one's. What is
/// pressed together would take it without end: a light body between a heavy one and a wall is squeezed more, and
/// throws the heavy one back. (While each body might gain m v^2 in a substep, v the speed of a push, 113 of 9,000
/// cases of the map's walls gained energy.) A substep that gains more is taken again, and holds overlaps as they
/// are.
#include <math.h>

#include "features/contact/contacts.h"
#include "solvers/implicit/energy_budget.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

/// Energy that bodies that touch may have more than before: in a substep, of which an interval has its share, as a
/// part of what they had; and as a part of what they fall by. (With 1e-4 such gains added up to 0.4 % in some
/// thousand substeps.)
#define DRIVEN_SHARE 1e-5
#define DRIVEN_FALL 1.0

/// How far the velocities of points of a collider that does not turn may differ, as a share: rounding of its
/// places.
#define SAME_SPEED 1e-6

// Kinetic energy that a component is left with.
static double left_with(const mspringi_component_budget *a, const mspringi_mass_centre *c) {
    const double turns = c->inertia > 0.0 ? c->spin / c->inertia : 0.0, to = a->keep * turns + a->turn;
    const double x = a->keep * (a->origin[2] + c->vx) + a->add_x, y = a->keep * (a->origin[3] + c->vy) + a->add_y;
    return 0.5 * c->mass * (x * x + y * y) + a->keep * a->keep * (c->kinetic - 0.5 * c->spin * turns) +
           0.5 * c->inertia * to * to;
}

// The same of particles without springs, which are in no component: as they fly if there is no floor.
static void add_loose(const mspring_network *network, double h, mspringi_field base, double *gain, double *most,
                      double momentum[2]) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    const mspringi_state *s = &network->state;
    const double gx = (double)network->settings.gravity_x, gy = (double)network->settings.gravity_y;
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        if (!mspringi_budget_is_isolated(budget, slot) || !(k->inverse_mass[i] > 0.0))
            continue;
        const double mass = 1.0 / k->inverse_mass[i], vx = (double)s->vx[slot], vy = (double)s->vy[slot];
        const double had = 0.5 * mass * (k->v_start[i].x * k->v_start[i].x + k->v_start[i].y * k->v_start[i].y);
        const double x = mspringi_x_of(s, slot) - k->x[i], y = mspringi_y_of(s, slot) - k->y[i];
        const double fx = mass * gx + (base.x ? (double)base.x[slot] : 0.0);
        const double fy = mass * gy + (base.y ? (double)base.y[slot] : 0.0);
        *gain += 0.5 * mass * (vx * vx + vy * vy) - had - (fx * x + fy * y);
        momentum[0] += mass * (vx - k->v_start[i].x - h * gx);
        momentum[1] += mass * (vy - k->v_start[i].y - h * gy);
        *most += DRIVEN_SHARE * had + DRIVEN_FALL * mass * (h * h * (gx * gx + gy * gy));
    }
}

double mspringi_gravity_energy_in_contact(const mspring_network *network, const mspringi_component_budget *a,
                                          double mass) {
    const double gx = (double)network->settings.gravity_x, gy = (double)network->settings.gravity_y;
    const double h = a->is_touched ? (double)network->contacts->h : 0.0;
    return 0.5 * mass * (gx * gx + gy * gy) * (h * h);
}

// The speed of a row along some shares: of nodes that have a weight, by how far they came, and of those that have
// none, which are colliders and pins.
static void speeds_of(const mspring_network *network, const mspringi_contact_constraint *t, double (*shares)[2],
                      double h, double *own, double *others) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    const mspringi_state *s = &network->state;
    const uint32_t nodes[] = {t->p, t->a, t->b};
    *own = *others = 0.0;
    for (int i = 0; i < 3; ++i) {
        const uint32_t node = nodes[i];
        if (!(k->inverse_mass[node] > 0.0)) {
            *others += shares[i][0] * k->v_start[node].x + shares[i][1] * k->v_start[node].y;
            continue;
        }
        const uint32_t slot = network->topology.slot_of_particle[k->particles[node]];
        *own += shares[i][0] * (mspringi_x_of(s, slot) - k->x[node]) / h +
                shares[i][1] * (mspringi_y_of(s, slot) - k->y[node]) / h;
    }
}

// Component of a node, or NULL, and its mass or that of the loose particle, kg.
static mspringi_component_budget *pushed_at(const mspring_network *network, uint32_t node, double *mass) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    *mass = k->inverse_mass[node] > 0.0 ? 1.0 / k->inverse_mass[node] : INFINITY;
    if (*mass == INFINITY)
        return NULL;
    const uint32_t number = budget->of_slot[network->topology.slot_of_particle[k->particles[node]]];
    if (number == MSPRINGI_NO_COMPONENT)
        return NULL;
    *mass = budget->components[number].sums[MSPRINGI_MOMENT_MASS];
    return &budget->components[number];
}

// Work that a push may take. A particle without springs stores nothing.
static double work_of_push(const mspring_network *network, const mspringi_contact_constraint *t) {
    const uint32_t nodes[] = {t->p, t->a, t->b};
    const double work = t->normal_impulse * t->target_speed;
    mspringi_component_budget *lighter = NULL;
    double least = INFINITY, mass;
    if (t->is_bounce || !(t->normal_impulse > 0.0) || !(t->target_speed > 0.0))
        return 0.0;
    for (int i = 0; i < 3; ++i) {
        mspringi_component_budget *a = pushed_at(network, nodes[i], &mass);
        lighter = mass < least ? a : lighter;
        least = fmin(mass, least);
    }
    const double room = lighter ? lighter->push_room : least * (t->target_speed * t->target_speed);
    const double taken = fmin(work, room);
    if (lighter)
        lighter->push_room -= taken;
    return taken;
}

// Work of all that pushes and has no weight, from the momentum that it gave: of colliders, pins and sleepers, if
// they move alike and have no belts, else INFINITY. (With colliders alone, a plate came through a body that lay on
// pins.)
static double work_of_weightless(const mspringi_contacts *contacts, const double momentum[2]) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    const mspringi_velocity *first = NULL;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        const uint32_t nodes[] = {t->p, t->a, t->b};
        if (t->normal_impulse == 0.0 && t->tangent_impulse == 0.0)
            continue;
        for (int j = 0; j < 3; ++j) {
            const mspringi_velocity *v = &k->v_start[nodes[j]];
            if (k->inverse_mass[nodes[j]] > 0.0)
                continue;
            first = first ? first : v;
            const double off = fabs(v->x - first->x) + fabs(v->y - first->y);
            if (t->surface_speed != 0.0 || off > SAME_SPEED * (fabs(first->x) + fabs(first->y)))
                return INFINITY;
        }
    }
    return first ? first->x * momentum[0] + first->y * momentum[1] : 0.0;
}

// Work of what has no weight, by its motion, and of pushing overlaps apart. Where all that acts from outside moves
// alike, it is no more than the momentum of bodies tells, whatever impulses rounding makes of it.
static double work_of_constraints(const mspring_network *network, double h, const double momentum[2]) {
    const mspringi_contacts *contacts = network->contacts;
    double sum = 0.0, pushes = 0.0, own, others;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        mspringi_implicit_constraint *c = &contacts->implicit_constraints[i];
        speeds_of(network, t, c->along, h, &own, &others);
        sum -= t->tangent_impulse * (others + t->surface_speed);
        speeds_of(network, t, c->across, h, &own, &others);
        sum -= (t->normal_impulse + c->mended) * others;
        pushes += work_of_push(network, t);
    }
    return pushes + (momentum ? fmin(sum, work_of_weightless(contacts, momentum)) : sum);
}

// True if all bodies in contact gained energy beyond the work from outside. In stiff networks rounding of contact
// forces makes such energy, see the top of this file.
bool mspringi_implicit_contact_gained_energy(const mspring_network *network, double h, mspringi_field base) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const double gx = (double)network->settings.gravity_x, gy = (double)network->settings.gravity_y;
    double gain = 0.0, most = 0.0, momentum[2] = {0.0, 0.0};
    bool is_free = !base.x && network->settings.global_damping == 0.0f;
    bool any = false;
    for (mspringi_component_budget *a = budget->components; a < budget->components + budget->count; ++a) {
        if (!a->is_touched || a->is_asleep)
            continue;
        if (a->is_driven || a->frame_x != 0.0 || a->frame_y != 0.0)
            return false;
        any = true;
        const mspringi_mass_centre c = mspringi_mass_centre_of(a);
        const double vx = a->origin[2] + a->vx, vy = a->origin[3] + a->vy, fall = h * h * (gx * gx + gy * gy);
        const double had = 0.5 * c.mass * (vx * vx + vy * vy) + a->internal;
        const double work = a->sums[MSPRINGI_EFFECT_WORK] - a->pushed +
                            c.mass * (gx * (c.x - a->x + a->shift_x) + gy * (c.y - a->y + a->shift_y));
        gain += left_with(a, &c) + a->elastic - had - work;
        const double dvx = c.vx - a->vx, dvy = c.vy - a->vy, turn = c.spin - a->spin;
        const bool is_held = a->is_pinned || a->is_held || a->sums[MSPRINGI_EFFECT_TOUCH] > 0.0;
        is_free &= !is_held;
        momentum[0] += c.mass * (dvx - h * gx);
        momentum[1] += c.mass * (dvy - h * gy);
        a->push_room = 2.0 * (c.mass * (dvx * dvx + dvy * dvy) + (c.inertia > 0.0 ? turn * turn / c.inertia : 0.0));
        most += DRIVEN_SHARE * had * (h / (double)network->contacts->h) + DRIVEN_FALL * c.mass * fall +
                mspringi_energy_rounding(a, a->internal);
    }
    if (!any)
        return false;
    add_loose(network, h, base, &gain, &most, momentum);
    if (mspringi_implicit_of(network)->contact_mode == MSPRINGI_CONTACT_BY_IMPULSES)
        most = 0.0; // nothing is repeated for it
    return gain > most && gain - work_of_constraints(network, h, is_free ? momentum : NULL) > most;
}

// Where nothing is repeated, vibration pays for a gain: impulses between rigid bodies leave it as it was.
bool mspringi_implicit_contact_end_vibration(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    if (n->contact_mode != MSPRINGI_CONTACT_BY_IMPULSES)
        return false;
    for (mspringi_component_budget *a = n->budget.components; a < n->budget.components + n->budget.count; ++a) {
        if (!a->is_touched || !a->is_free)
            continue;
        const mspringi_mass_centre c = mspringi_mass_centre_of(a);
        a->turn += c.inertia > 0.0 ? a->keep * c.spin / c.inertia : 0.0;
        a->add_x += a->keep * (a->origin[2] + c.vx);
        a->add_y += a->keep * (a->origin[3] + c.vy);
        a->keep = 0.0;
    }
    return true;
}
