/// Contact between rigid bodies, for intervals that have no work left for contact in the linear system.
///
/// Impulses on the particles that touch hardly slow a stiff body. The energy budget does not let it deform for
/// them, so it would fly on, through others. Here bodies near each other keep their shape: they move on as rigid
/// ones, after impulses that keep gaps from closing, with friction and without restitution: projected Gauss-Seidel
/// (Catto 2005). Such impulses only take energy, after any number of sweeps. They act at once, so the centre of a
/// body goes twice the way that they do work on (energy_budget.c). Bodies with pins move as solved, and are not
/// pushed.
///
/// Positions do not change in the sweeps. So arms and masses are computed before them, once.
#include <math.h>
#include <string.h>

#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "solvers/implicit/implicit_terms.h"

/// Most sweeps over all constraints. (With 64, of 256 light bodies between a heavy one and a wall 7 were passed or
/// gained energy, with 512 three.)
#define MOST_RIGID_SWEEPS 256

typedef mspringi_component_budget rigid_body;
typedef mspringi_implicit_constraint hold;

/// An interval, and the change of a distance that matters, m.
typedef struct rigid_interval {
    mspring_network *network;
    const mspringi_motion *before;
    double h, unseen;
} rigid_interval;

static rigid_body *body_of(const mspring_network *network, uint32_t node) {
    mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    if (node >= k->particle_count)
        return NULL;
    const uint32_t number = budget->of_slot[network->topology.slot_of_particle[k->particles[node]]];
    return number == MSPRINGI_NO_COMPONENT ? NULL : &budget->components[number];
}

static rigid_body *rigid_body_of(const mspring_network *network, uint32_t node) {
    rigid_body *a = body_of(network, node);
    return a && a->is_rigid ? a : NULL;
}

// Let a body keep its shape, with the motion that its momentum and spin give it.
static void make_rigid(const mspring_network *network, uint32_t node, double h) {
    rigid_body *a = body_of(network, node);
    if (!a || a->is_rigid || a->is_pinned || a->is_asleep || !(a->sums[MSPRINGI_MOMENT_MASS] > 0.0))
        return;
    const mspringi_mass_centre c = mspringi_mass_centre_of(a);
    a->is_rigid = true;
    a->rigid_elastic = a->elastic;
    a->inverse_mass = 1.0 / c.mass;
    a->inverse_inertia = c.inertia > 0.0 ? 1.0 / c.inertia : 0.0;
    a->rigid_vx = a->origin[2] + a->vx + h * (double)network->settings.gravity_x;
    a->rigid_vy = a->origin[3] + a->vy + h * (double)network->settings.gravity_y;
    a->rigid_turn = a->spin * a->inverse_inertia;
}

// Let forces of the host, and of systems as grips, act on rigid bodies before impulses, so that these meet them.
static void add_forces(const rigid_interval *o, mspringi_field base) {
    mspring_network *network = o->network;
    mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_budget_sums all = {
        .network = network, .motion = *o->before, .before = *o->before, .base = base, .h = (float)o->h};
    mspringi_budget_add_forces(&all);
#define SYSTEM(name) mspringi_##name##_add_impulses(&all);
#include "store/features.def"
    for (rigid_body *a = budget->components; a < budget->components + budget->count; ++a) {
        const double fx = a->sums[MSPRINGI_EFFECT_X], fy = a->sums[MSPRINGI_EFFECT_Y];
        if (!a->is_rigid)
            continue;
        a->rigid_vx += o->h * fx * a->inverse_mass;
        a->rigid_vy += o->h * fy * a->inverse_mass;
        a->rigid_turn += o->h * (a->sums[MSPRINGI_EFFECT_TORQUE] - (a->x * fy - a->y * fx)) * a->inverse_inertia;
    }
}

/* ------------------------------------------------------------------------------------------ between two bodies */

// Nodes of a constraint, and the first of each side: the point, then the ends of the edge.
static uint32_t node_of_side(const mspringi_contact_constraint *t, int i) {
    return i == 0 ? t->p : i == 1 ? t->a : t->b;
}
static const int first_of_side[] = {0, 1, 3};

// Share of a constraint's impulse that a node takes, x and y.
static const double *share_of(const hold *c, bool is_along, int i) {
    return is_along ? c->along[i] : c->across[i];
}

/// Direction of an impulse on the point, or on the edge.
typedef struct direction {
    double x, y;
} direction;

static direction direction_of(const mspringi_contact_constraint *t, bool is_along, int side) {
    const double sign = side == 0 ? 1.0 : -1.0;
    return (direction){sign * (is_along ? -t->ny : t->nx), sign * (is_along ? t->nx : t->ny)};
}

static rigid_body *side_body(const mspring_network *network, const hold *c, int side) {
    return c->bodies[side] == MSPRINGI_NO_COMPONENT
               ? NULL
               : &mspringi_implicit_of(network)->budget.components[c->bodies[side]];
}

// Compute the arms of a unit impulse on both sides, their relative speed without impulses, and the mass.
static void begin_row(const mspring_network *network, const mspringi_contact_constraint *t, hold *c,
                      bool is_along) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    mspringi_rigid_direction *row = &c->rigid[is_along];
    double give = 0.0;
    memset(row, 0, sizeof *row);
    for (int side = 0; side < 2; ++side) {
        const rigid_body *a = side_body(network, c, side);
        double own = 0.0;
        for (int i = first_of_side[side]; i < first_of_side[side + 1]; ++i) {
            const uint32_t node = node_of_side(t, i);
            const double *share = share_of(c, is_along, i);
            own += (share[0] * share[0] + share[1] * share[1]) * k->inverse_mass[node];
            if (!a)
                continue;
            const double x = k->x[node] - (a->origin[0] + a->x), y = k->y[node] - (a->origin[1] + a->y);
            row->arms[side] += x * share[1] - y * share[0];
        }
        if (a) {
            const direction to = direction_of(t, is_along, side);
            own = a->inverse_mass + row->arms[side] * row->arms[side] * a->inverse_inertia;
            row->speed += to.x * a->rigid_vx + to.y * a->rigid_vy + row->arms[side] * a->rigid_turn;
        }
        give += own;
    }
    row->mass = give > 0.0 && c->bodies[0] != c->bodies[1] ? 1.0 / give : 0.0;
}

static void begin_pair(const mspring_network *network, const mspringi_contact_constraint *t, hold *c) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    for (int side = 0; side < 2; ++side) {
        const rigid_body *a = rigid_body_of(network, side == 0 ? t->p : t->a);
        c->bodies[side] = a ? (uint32_t)(a - budget->components) : MSPRINGI_NO_COMPONENT;
    }
    begin_row(network, t, c, false);
    begin_row(network, t, c, true);
}

// Relative speed of both sides in one direction, m/s. A side that is no rigid body moves by its nodes.
static double speed_of_row(const mspring_network *network, const mspringi_contact_constraint *t, const hold *c,
                           bool is_along) {
    const mspringi_velocity *v = network->contacts->nodes.v;
    const mspringi_rigid_direction *row = &c->rigid[is_along];
    double speed = row->speed;
    for (int side = 0; side < 2; ++side) {
        const rigid_body *a = side_body(network, c, side);
        const direction to = direction_of(t, is_along, side);
        if (a)
            speed += to.x * a->push_x + to.y * a->push_y + row->arms[side] * a->push_turn;
        for (int i = first_of_side[side]; !a && i < first_of_side[side + 1]; ++i) {
            const double *share = share_of(c, is_along, i);
            speed += share[0] * v[node_of_side(t, i)].x + share[1] * v[node_of_side(t, i)].y;
        }
    }
    return speed;
}

static void push_row(const mspring_network *network, const mspringi_contact_constraint *t, const hold *c,
                     bool is_along, double impulse) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    const mspringi_rigid_direction *row = &c->rigid[is_along];
    for (int side = 0; side < 2; ++side) {
        rigid_body *a = side_body(network, c, side);
        if (a) {
            const direction to = direction_of(t, is_along, side);
            a->push_x += impulse * a->inverse_mass * to.x;
            a->push_y += impulse * a->inverse_mass * to.y;
            a->push_turn += impulse * a->inverse_inertia * row->arms[side];
        }
        for (int i = first_of_side[side]; !a && i < first_of_side[side + 1]; ++i) {
            const uint32_t node = node_of_side(t, i);
            const double *share = share_of(c, is_along, i);
            k->v[node].x += impulse * k->inverse_mass[node] * share[0];
            k->v[node].y += impulse * k->inverse_mass[node] * share[1];
        }
    }
}

// Keep a gap from closing, or an overlap from growing, and sides from sliding. Return true if that took impulses.
static bool keep_apart(const rigid_interval *o, mspringi_contact_constraint *t, const hold *c) {
    const double mass = c->rigid[0].mass, mass_along = c->rigid[1].mass;
    if (!(mass > 0.0))
        return false;
    const double lacks = (t->gap < 0.0 ? 0.0 : -t->gap) / o->h - speed_of_row(o->network, t, c, false);
    const double change = fmax(lacks * mass, -t->normal_impulse);
    t->normal_impulse += change;
    if (change != 0.0)
        push_row(o->network, t, c, false, change);
    double slip = 0.0;
    if (t->friction > 0.0f && t->tangent_mass > 0.0 && (t->normal_impulse > 0.0 || t->tangent_impulse != 0.0)) {
        const double slide = speed_of_row(o->network, t, c, true) + t->surface_speed;
        const double most = (double)t->friction * t->normal_impulse;
        const double to = fmax(-most, fmin(t->tangent_impulse - slide * mass_along, most));
        slip = to - t->tangent_impulse;
        t->tangent_impulse = to;
        push_row(o->network, t, c, true, slip);
    }
    return fabs(change) * o->h > o->unseen * mass || fabs(slip) * o->h > o->unseen * mass_along;
}

bool mspringi_rigid_contact_has(const mspring_network *network, const mspringi_contact_constraint *t) {
    return rigid_body_of(network, t->p) || rigid_body_of(network, t->a);
}

/* ----------------------------------------------------------------------------------------------- at the floor */

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

static rigid_body *rigid_body_at(const mspring_network *network, size_t slot) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const uint32_t number = budget->of_slot[slot];
    return number != MSPRINGI_NO_COMPONENT && budget->components[number].is_rigid ? &budget->components[number]
                                                                                  : NULL;
}

// Change the velocity of a body's particle in the direction (x, y) by the impulse that gives it a speed, so far as
// the sum of such impulses stays in bounds. Return the change of the speed, m/s.
static double push_at(rigid_body *a, double rx, double ry, double x, double y, double speed, double least,
                      double most, float *sum, double *impulse) {
    const double arm = rx * y - ry * x, give = a->inverse_mass + arm * arm * a->inverse_inertia;
    const double now =
        x * (a->rigid_vx + a->push_x) + y * (a->rigid_vy + a->push_y) + arm * (a->rigid_turn + a->push_turn);
    const float to = (float)fmax(least, fmin((double)*sum + (speed - now) / give, most));
    *impulse = (double)to - (double)*sum;
    *sum = to;
    a->push_x += *impulse * a->inverse_mass * x;
    a->push_y += *impulse * a->inverse_mass * y;
    a->push_turn += *impulse * a->inverse_inertia * arm;
    return *impulse * give;
}

// Keep a body's particle out of a surface. *sum, *along: its impulses so far, N s. Return true if these changed
// much.
static bool keep_out(const rigid_interval *o, rigid_body *a, size_t slot, double x, double y,
                     const mspringi_line *line, float *sum, float *along) {
    const mspringi_field *to = &o->network->floor->impulse;
    const double rx = x - a->origin[0] - a->x, ry = y - a->origin[1] - a->y;
    const double gap = mspringi_distance_from_line(line, x, y), least = gap < 0.0 ? 0.0 : -gap / o->h;
    double across_impulse, along_impulse;
    const double change = push_at(a, rx, ry, line->nx, line->ny, least, 0.0, INFINITY, sum, &across_impulse);
    const double most = mspringi_friction_on(line, mspringi_own_of(o->network, slot)) * (double)*sum;
    const double slip = push_at(a, rx, ry, -line->ny, line->nx, 0.0, -most, most, along, &along_impulse);
    to->x[slot] += (float)(across_impulse * line->nx - along_impulse * line->ny);
    to->y[slot] += (float)(across_impulse * line->ny + along_impulse * line->nx);
    return (fabs(change) + fabs(slip)) * o->h > o->unseen;
}

// Find how far each body is from the floor at least, and the radius around its mass centre. Impulses of the linear
// system count no more.
static void begin_floor(const rigid_interval *o) {
    const mspring_network *network = o->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_floor *floor = network->floor;
    for (uint32_t i = 0; i < n->budget.count; ++i) {
        n->budget.components[i].floor_gap = INFINITY;
        n->budget.components[i].radius = 0.0;
    }
    for (size_t slot = 0; slot < mspringi_used_slots(network); ++slot) {
        rigid_body *a = rigid_body_at(network, slot);
        if (!a || !(network->inverse_mass[slot] > 0.0f))
            continue;
        mspringi_line surfaces[2];
        const double x = (double)o->before->x[slot] + (double)o->before->low_x[slot];
        const double y = (double)o->before->y[slot] + (double)o->before->low_y[slot];
        const double rx = x - a->origin[0] - a->x, ry = y - a->origin[1] - a->y;
        if (find_near_surfaces(floor, x, y, surfaces) > 0)
            a->floor_gap = fmin(a->floor_gap, mspringi_distance_from_line(&surfaces[0], x, y));
        a->radius = fmax(a->radius, sqrt(rx * rx + ry * ry));
        floor->impulse.x[slot] = n->budget.impulse.x[slot];
        floor->impulse.y[slot] = n->budget.impulse.y[slot];
        n->scaled.x[slot] = n->scaled.y[slot] = n->product.x[slot] = n->product.y[slot] = 0.0f;
    }
}

// True if a body's fastest particle would come to the floor.
static bool may_reach_floor(const rigid_body *a, double h) {
    const double vx = a->rigid_vx + a->push_x, vy = a->rigid_vy + a->push_y;
    return a->floor_gap <= h * (sqrt(vx * vx + vy * vy) + a->radius * fabs(a->rigid_turn + a->push_turn));
}

// Keep all rigid bodies out of the floor.
static bool keep_all_out(const rigid_interval *o) {
    const mspring_network *network = o->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    bool again = false;
    for (size_t slot = 0; slot < mspringi_used_slots(network); ++slot) {
        rigid_body *a = rigid_body_at(network, slot);
        const bool is_pushed = n->scaled.x[slot] != 0.0f || n->scaled.y[slot] != 0.0f;
        if (!a || !(network->inverse_mass[slot] > 0.0f) || !(is_pushed || may_reach_floor(a, o->h)))
            continue;
        mspringi_line surfaces[2];
        const double x = (double)o->before->x[slot] + (double)o->before->low_x[slot];
        const double y = (double)o->before->y[slot] + (double)o->before->low_y[slot];
        const uint32_t count = find_near_surfaces(network->floor, x, y, surfaces);
        for (uint32_t i = 0; i < count; ++i)
            again |= keep_out(o, a, slot, x, y, &surfaces[i], i == 0 ? &n->scaled.x[slot] : &n->scaled.y[slot],
                              i == 0 ? &n->product.x[slot] : &n->product.y[slot]);
    }
    return again;
}

/* ------------------------------------------------------------------------------------------------- the interval */

void mspringi_rigid_contact_find_impulses(mspring_network *network, const mspringi_motion *before,
                                          mspringi_field base, double h, double unseen) {
    const rigid_interval o = {network, before, h, unseen};
    const mspringi_contacts *contacts = network->contacts;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        make_rigid(network, contacts->constraints[i].p, h);
        make_rigid(network, contacts->constraints[i].a, h);
    }
    add_forces(&o, base);
    for (uint32_t i = 0; i < contacts->constraint_count; ++i)
        begin_pair(network, &contacts->constraints[i], &contacts->implicit_constraints[i]);
    if (network->floor)
        begin_floor(&o);
    for (uint32_t sweep = 0, again = 1; sweep < MOST_RIGID_SWEEPS && again; ++sweep) {
        again = 0;
        for (uint32_t i = 0; i < contacts->constraint_count; ++i)
            again |= keep_apart(&o, &contacts->constraints[i], &contacts->implicit_constraints[i]);
        if (network->floor)
            again |= keep_all_out(&o);
    }
    // The direct solver has no tiles that would turn what is predicted.
    if (network->floor)
        memset(mspringi_implicit_of(network)->scaled.x, 0, 2 * mspringi_slot_count(network) * sizeof(float));
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
        const double vx = a->rigid_vx + a->push_x - (a->rigid_turn + a->push_turn) * ry;
        const double vy = a->rigid_vy + a->push_y + (a->rigid_turn + a->push_turn) * rx;
        mspringi_set_velocity_in_full(s, slot, vx, vy);
    }
    for (int corner = 0; network->floor && corner < 2; ++corner)
        lift_rigid(network);
}
