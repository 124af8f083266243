/// Contact between rigid bodies, for intervals that have no work left for contact in the linear system.
///
/// Impulses on the particles that touch hardly slow a stiff body. The energy budget does not let it deform for
/// them, so it would fly on, through others. Here bodies near each other keep their shape: they move on as rigid
/// ones, after impulses that keep gaps from closing: projected Gauss-Seidel (Catto 2005), without friction or
/// restitution. Such impulses only take energy, after any number of sweeps. They act at once, so the centre of a
/// body goes twice the way that they do work on (energy_budget.c). Bodies with pins move as solved, and are not
/// pushed.
#include <math.h>

#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "solvers/implicit/implicit_terms.h"

/// Most sweeps over all constraints. (With 64, of 256 light bodies between a heavy one and a wall 7 were passed or
/// gained energy, with 512 three.)
#define MOST_RIGID_SWEEPS 256

typedef mspringi_component_budget rigid_body;

/// A point, or the closest point of an edge, which moves with its body.
typedef struct contact_side {
    rigid_body *of;          ///< NULL: not of a rigid body
    uint32_t nodes[2];       ///< of the edge, or twice the point
    double shares[2];        ///< of them
    double inverse_mass;     ///< along the normal, 1/kg
    double speed;            ///< along the normal, m/s
    double turn_per_impulse; ///< of the body, 1/(kg m)
} contact_side;

static rigid_body *body_of(const mspring_network *network, uint32_t node) {
    mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    if (node >= k->particle_count)
        return NULL;
    const uint32_t number = budget->of_slot[network->topology.slot_of_particle[k->particles[node]]];
    return number == MSPRINGI_NO_COMPONENT ? NULL : &budget->components[number];
}

static contact_side side_of(const mspring_network *network, const mspringi_contact_constraint *t, bool is_edge) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    contact_side s = {.of = body_of(network, is_edge ? t->a : t->p),
                      .nodes = {is_edge ? t->a : t->p, is_edge ? t->b : t->p},
                      .shares = {is_edge ? t->bary_a : 1.0, is_edge ? t->bary_b : 0.0}};
    const double *a = s.shares;
    if (!s.of || !s.of->is_rigid) {
        const mspringi_velocity *v[] = {&k->v[s.nodes[0]], &k->v[s.nodes[1]]};
        s.of = NULL;
        s.speed = t->nx * (a[0] * v[0]->x + a[1] * v[1]->x) + t->ny * (a[0] * v[0]->y + a[1] * v[1]->y);
        s.inverse_mass = a[0] * a[0] * k->inverse_mass[s.nodes[0]] + a[1] * a[1] * k->inverse_mass[s.nodes[1]];
        return s;
    }
    const mspringi_mass_centre c = mspringi_mass_centre_of(s.of);
    const double x = a[0] * k->x[s.nodes[0]] + a[1] * k->x[s.nodes[1]] - (s.of->origin[0] + s.of->x);
    const double y = a[0] * k->y[s.nodes[0]] + a[1] * k->y[s.nodes[1]] - (s.of->origin[1] + s.of->y);
    const double turn = s.of->rigid_turn + s.of->push_turn, arm = x * t->ny - y * t->nx;
    s.speed = t->nx * (s.of->rigid_vx + s.of->push_x) + t->ny * (s.of->rigid_vy + s.of->push_y) + arm * turn;
    s.turn_per_impulse = c.inertia > 0.0 ? arm / c.inertia : 0.0;
    s.inverse_mass = 1.0 / c.mass + arm * s.turn_per_impulse;
    return s;
}

static void push_side(const mspring_network *network, const mspringi_contact_constraint *t, const contact_side *s,
                      double impulse) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    if (s->of) {
        const double change = impulse / s->of->sums[MSPRINGI_MOMENT_MASS];
        s->of->push_x += change * t->nx;
        s->of->push_y += change * t->ny;
        s->of->push_turn += impulse * s->turn_per_impulse;
        return;
    }
    for (int i = 0; i < 2; ++i) {
        const double change = s->shares[i] * k->inverse_mass[s->nodes[i]] * impulse;
        k->v[s->nodes[i]].x += change * t->nx;
        k->v[s->nodes[i]].y += change * t->ny;
    }
}

// Keep a gap from closing, or an overlap from growing. Return true if that took an impulse.
static bool keep_apart(const mspring_network *network, mspringi_contact_constraint *t, double h, double unseen) {
    const contact_side point = side_of(network, t, false), edge = side_of(network, t, true);
    const double inverse_mass = point.inverse_mass + edge.inverse_mass;
    const double lacks = (t->gap < 0.0 ? 0.0 : -t->gap) - h * (point.speed - edge.speed);
    if ((!point.of && !edge.of) || point.of == edge.of || !(inverse_mass > 0.0))
        return false;
    const double change = fmax(lacks / (h * inverse_mass), -t->normal_impulse);
    t->normal_impulse += change;
    push_side(network, t, &point, change);
    push_side(network, t, &edge, -change);
    return fabs(change) * h * inverse_mass > unseen;
}

// Find the two surfaces of the floor that are nearest to a point. Return their number.
static uint32_t find_near_surfaces(const mspringi_floor *floor, double x, double y, mspringi_line nearest[2]) {
    const uint32_t all = floor->plane_count + (floor->heights.count > 0);
    double distances[2] = {INFINITY, INFINITY};
    for (uint32_t i = 0; i < all; ++i) {
        const mspringi_line line =
            i < floor->plane_count
                ? floor->lines[i]
                : mspringi_heights_line(&floor->heights, mspringi_heights_find_part(&floor->heights, x));
        const double distance = mspringi_distance_from_line(&line, x, y);
        const int to = distance < distances[0] ? 0 : 1;
        if (!(distance < distances[to]))
            continue;
        nearest[1] = to == 0 ? nearest[0] : line;
        distances[1] = to == 0 ? distances[0] : distance;
        nearest[to] = line;
        distances[to] = distance;
    }
    return all < 2 ? all : 2;
}

// Keep a body's particle out of a surface. *sum: its impulse so far, N s. Return true if that changed much.
static bool keep_out(const mspring_network *network, rigid_body *a, size_t slot, double x, double y,
                     const mspringi_line *line, float *sum, double h, double unseen) {
    const mspringi_floor *floor = network->floor;
    const double rx = x - a->origin[0] - a->x, ry = y - a->origin[1] - a->y, arm = rx * line->ny - ry * line->nx;
    const double gap = mspringi_distance_from_line(line, x, y), speed = line->nx * (a->rigid_vx + a->push_x) +
                                                                        line->ny * (a->rigid_vy + a->push_y) +
                                                                        arm * (a->rigid_turn + a->push_turn);
    const double lacks = (gap < 0.0 ? 0.0 : -gap) - h * speed;
    if (!(lacks > 0.0) && *sum == 0.0f)
        return false;
    const mspringi_mass_centre c = mspringi_mass_centre_of(a);
    const double turn = c.inertia > 0.0 ? arm / c.inertia : 0.0, inverse_mass = 1.0 / c.mass + arm * turn;
    const float to = (float)fmax((double)*sum + lacks / (h * inverse_mass), 0.0);
    const double change = (double)to - (double)*sum;
    *sum = to;
    a->push_x += change / c.mass * line->nx;
    a->push_y += change / c.mass * line->ny;
    a->push_turn += change * turn;
    floor->impulse.x[slot] += (float)(change * line->nx);
    floor->impulse.y[slot] += (float)(change * line->ny);
    return fabs(change) * h * inverse_mass > unseen;
}

static rigid_body *rigid_body_at(const mspring_network *network, size_t slot) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const uint32_t number = budget->of_slot[slot];
    return number != MSPRINGI_NO_COMPONENT && budget->components[number].is_rigid ? &budget->components[number]
                                                                                  : NULL;
}

// Keep all rigid bodies out of the floor. Impulses of the linear system count no more.
static bool keep_all_out(const mspring_network *network, const mspringi_motion *before, double h, double unseen,
                         bool is_first) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_floor *floor = network->floor;
    bool again = false;
    for (size_t slot = 0; slot < mspringi_used_slots(network); ++slot) {
        rigid_body *a = rigid_body_at(network, slot);
        if (!a || !(network->inverse_mass[slot] > 0.0f))
            continue;
        if (is_first) {
            floor->impulse.x[slot] = n->budget.impulse.x[slot];
            floor->impulse.y[slot] = n->budget.impulse.y[slot];
            n->scaled.x[slot] = n->scaled.y[slot] = 0.0f;
        }
        mspringi_line surfaces[2];
        const double x = (double)before->x[slot] + (double)before->low_x[slot];
        const double y = (double)before->y[slot] + (double)before->low_y[slot];
        const uint32_t count = find_near_surfaces(floor, x, y, surfaces);
        for (uint32_t i = 0; i < count; ++i)
            again |= keep_out(network, a, slot, x, y, &surfaces[i],
                              i == 0 ? &n->scaled.x[slot] : &n->scaled.y[slot], h, unseen);
    }
    return again;
}

// Begin with the motion that momentum and spin give a body near others.
static void make_rigid(const mspring_network *network, uint32_t node, double h) {
    rigid_body *a = body_of(network, node);
    if (!a || a->is_rigid || a->is_pinned || a->is_asleep || !(a->sums[MSPRINGI_MOMENT_MASS] > 0.0))
        return;
    const mspringi_mass_centre c = mspringi_mass_centre_of(a);
    a->is_rigid = true;
    a->rigid_elastic = a->elastic;
    a->rigid_vx = a->origin[2] + a->vx + h * (double)network->settings.gravity_x;
    a->rigid_vy = a->origin[3] + a->vy + h * (double)network->settings.gravity_y;
    a->rigid_turn = c.inertia > 0.0 ? a->spin / c.inertia : 0.0;
}

bool mspringi_rigid_contact_has(const mspring_network *network, const mspringi_contact_constraint *t) {
    const rigid_body *point = body_of(network, t->p), *edge = body_of(network, t->a);
    return (point && point->is_rigid) || (edge && edge->is_rigid);
}

void mspringi_rigid_contact_find_impulses(const mspring_network *network, const mspringi_motion *before, double h,
                                          double unseen) {
    const mspringi_contacts *contacts = network->contacts;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        make_rigid(network, contacts->constraints[i].p, h);
        make_rigid(network, contacts->constraints[i].a, h);
    }
    for (uint32_t sweep = 0, again = 1; sweep < MOST_RIGID_SWEEPS && again; ++sweep) {
        again = 0;
        for (uint32_t i = 0; i < contacts->constraint_count; ++i)
            again |= keep_apart(network, &contacts->constraints[i], h, unseen);
        if (network->floor)
            again |= keep_all_out(network, before, h, unseen, sweep == 0);
    }
}

// Shift bodies that have turned into the floor out of it, by what their deepest particle needs. The floor would
// move particles alone, and deform what is rigid.
static void lift_rigid(const mspring_network *network) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_used_slots(network);
    for (uint32_t i = 0; i < budget->count; ++i)
        budget->components[i].shift_x = budget->components[i].shift_y = 0.0;
    for (size_t slot = 0; slot < slots; ++slot) {
        rigid_body *a = rigid_body_at(network, slot);
        const double from_x = mspringi_x_of(s, slot), from_y = mspringi_y_of(s, slot);
        double x = from_x, y = from_y;
        if (!a || !mspringi_floor_put_outside(network->floor, &x, &y))
            continue;
        x -= from_x;
        y -= from_y;
        const bool is_deepest = x * x + y * y > a->shift_x * a->shift_x + a->shift_y * a->shift_y;
        a->shift_x = is_deepest ? x : a->shift_x;
        a->shift_y = is_deepest ? y : a->shift_y;
    }
    for (size_t slot = 0; slot < slots; ++slot) {
        const rigid_body *a = rigid_body_at(network, slot);
        if (!a || (a->shift_x == 0.0 && a->shift_y == 0.0))
            continue;
        mspringi_set_x(s, slot, mspringi_x_of(s, slot) + a->shift_x);
        mspringi_set_y(s, slot, mspringi_y_of(s, slot) + a->shift_y);
    }
}

void mspringi_rigid_contact_move(const mspring_network *network, const mspringi_motion *before, double h) {
    const mspringi_state *s = &network->state;
    for (size_t slot = 0; slot < mspringi_used_slots(network); ++slot) {
        const rigid_body *a = rigid_body_at(network, slot);
        if (!a)
            continue;
        const double x = (double)before->x[slot] + (double)before->low_x[slot];
        const double y = (double)before->y[slot] + (double)before->low_y[slot];
        const double rx = x - (a->origin[0] + a->x), ry = y - (a->origin[1] + a->y);
        // Turn by twice the angle that has this tangent: springs keep their lengths.
        const double t = 0.5 * h * (a->rigid_turn + a->push_turn), sine = 2.0 * t / (1.0 + t * t), less = t * sine;
        mspringi_set_x(s, slot, x + h * (a->rigid_vx + a->push_x) - less * rx - sine * ry);
        mspringi_set_y(s, slot, y + h * (a->rigid_vy + a->push_y) - less * ry + sine * rx);
        const double vx = a->rigid_vx - a->origin[2] - a->vx + a->push_x - a->push_turn * ry;
        const double vy = a->rigid_vy - a->origin[3] - a->vy + a->push_y + a->push_turn * rx;
        mspringi_set_velocity_in_full(s, slot, (double)before->vx[slot] + vx, (double)before->vy[slot] + vy);
    }
    for (int corner = 0; network->floor && corner < 2; ++corner)
        lift_rigid(network);
}
