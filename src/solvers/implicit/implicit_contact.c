/// Contact between bodies in the linear system of an implicit substep: an active-set method.
///
/// features/contact/constraints.c makes the constraints, with normals and weights of the start of the substep.
/// Where the gap would close, a normal spring keeps it open. A tangential spring acts within the friction cone.
/// These springs join two bodies. So they enter products with the matrix, or the solution of its factor, and the
/// diagonal blocks. Solving again finds the active set: constraints that pull are released. The springs are about
/// as stiff as the network at the constraint, so that few iterations find them; both give way about equally.
/// Impulses after the substep correct larger overlaps.
///
/// A loose particle is an unknown while it may touch others (loose_contact.c).
///
/// Substeps with active constraints, and the next one each, are of implicit Euler: see implicit_floor.c.
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "features/contact/contacts.h"
#include "solvers/implicit/implicit_terms.h"

/// Stiffness of a constraint, in units of the network's stiffness and inertia there. (With 4 heaps of 30 took 1.2
/// times the work. With 1 two heaps of 100 took 0.8 times the work, and ran out of it in 3 % of their steps instead
/// of 17 %, but of 40 light bodies between a heavy one and a wall that comes one was pressed half a thickness into
/// it, and overlaps of the direct solver reached 0.1 thicknesses.)
#define PENALTY 2.0
/// The same at a loose particle, in units of its mass. (With 128 a ball came back with 0.489 of its speed at
/// restitution 0.5. With 4 fragments in a box came into light ones by 0.4 thicknesses. With as much as at the
/// stiffest of them the direct solver had no solution after 64 iterations.)
#define PENALTY_OF_LOOSE 256.0

/// Rounding of a depth, as a share of the thickness.
#define UNSEEN_SHARE 1e-6

/// Overlap that may not grow, as a share of the thickness: of bodies, and with a collider. What is less deep may
/// grow in a substep by a share of the rest. (Colliders had no such room. So what a stack gave way there at rest
/// was mended, its springs gained by that, and each substep was taken in 16 parts: 81 calm steps a step, now 12.
/// With 0.01 for colliders it took as much.)
#define DEEPEST_SHARE 0.2
#define DEEPEST_IN_COLLIDER 0.002
#define GROWTH_SHARE 0.1

/// Work of contact, and pull, that may be rounding, as shares of the largest work and push.
#define GIVEN_SHARE 1e-3

/// Growth of a pair's overlap, as a share of the thickness, that makes a substep repeat in halves.
#define MISSED_SHARE 0.1

/// Most sweeps over all constraints against deep overlaps. (With 32 a ball sank through a bar of a hundredth of its
/// mass on the ground within 3 s. Heaps take 3 % longer with 256.)
#define MOST_MENDING_SWEEPS 256

/// Comparisons of points with edges that a substep is allowed, as its intervals find constraints anew, and for each
/// particle.
#define WORK_OF_SUBSTEP 2621440u
#define WORK_OF_PARTICLE 3000u

typedef mspringi_implicit_constraint implicit_constraint;

// NULL unless bodies may touch in this substep.
static mspringi_contacts *contacts_near(const mspring_network *network) {
    return network->contacts && network->contacts->quiet_substeps == 0 ? network->contacts : NULL;
}

bool mspringi_implicit_contact_has(const mspring_network *network, size_t slot) {
    const mspringi_contacts *contacts = contacts_near(network);
    const mspring_id p = network->topology.particle_of_slot[slot];
    return contacts && p != MSPRING_NONE && contacts->nodes.number[p] != MSPRING_NONE;
}

// Number of constraints of the present substep; 0 without contact.
static uint32_t count_of(const mspring_network *network) {
    const mspringi_contacts *contacts = contacts_near(network);
    return contacts ? contacts->constraint_count : 0;
}

static uint32_t node_of(const mspringi_contact_constraint *t, int i) {
    return i == 0 ? t->p : i == 1 ? t->a : t->b;
}

static uint32_t slot_of(const mspring_network *network, uint32_t node) {
    return network->topology.slot_of_particle[network->contacts->nodes.particles[node]];
}

/* -------------------------------------------------------------------------------------------------- Jacobians */

static void split_forces(const mspring_network *network, const mspringi_contact_constraint *t,
                         implicit_constraint *to) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    const double shares[] = {1.0, -t->bary_a, -t->bary_b};
    const double along[3][2] = {{-t->ny, t->nx},
                                {t->bary_a * t->ny - t->couple_y, t->couple_x - t->bary_a * t->nx},
                                {t->bary_b * t->ny + t->couple_y, -t->couple_x - t->bary_b * t->nx}};
    for (int i = 0; i < 3; ++i) {
        const uint32_t node = node_of(t, i);
        to->slots[i] = k->inverse_mass[node] > 0.0 ? slot_of(network, node) : MSPRING_NONE;
        to->across[i][0] = shares[i] * t->nx;
        to->across[i][1] = shares[i] * t->ny;
        to->along[i][0] = along[i][0];
        to->along[i][1] = along[i][1];
    }
}

static double product(double (*shares)[2], double (*vectors)[2]) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
        sum += shares[i][0] * vectors[i][0] + shares[i][1] * vectors[i][1];
    return sum;
}

// Begin with a constraint. It is active if its gap would close at the end of the substep without springs and
// contact.
static void begin_constraint(const mspring_network *network, mspringi_contact_constraint *t, double h,
                             implicit_constraint *to) {
    const mspringi_contacts *contacts = network->contacts;
    const mspringi_contact_nodes *k = &contacts->nodes;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    double way[3][2];
    const bool is_slick = t->tangent_mass == 0.0 || n->contact_mode != MSPRINGI_CONTACT_WITH_FRICTION;
    *to = (implicit_constraint){.listed = MSPRING_NONE, .friction = is_slick ? 0.0 : (double)t->friction};
    if (n->holds_overlaps && t->gap < 0.0 && !t->is_bounce)
        t->target_speed = 0.0;
    split_forces(network, t, to);
    for (int i = 0; i < 3; ++i) {
        const uint32_t node = node_of(t, i);
        const double fall = to->slots[i] == MSPRING_NONE ? 0.0 : h * h;
        way[i][0] = h * k->v_start[node].x + fall * (double)network->settings.gravity_x;
        way[i][1] = h * k->v_start[node].y + fall * (double)network->settings.gravity_y;
    }
    to->spare = t->gap > 0.0 ? t->gap + h * t->target_speed : 0.0;
    to->is_active = product(to->across, way) - h * t->target_speed + to->spare < 0.0;
}

void mspringi_implicit_contact_allow_work(const mspring_network *network) {
    mspringi_contacts *contacts = contacts_near(network);
    if (contacts && !mspringi_contact_is_rejected(contacts))
        contacts->most_work += WORK_OF_SUBSTEP + WORK_OF_PARTICLE * (uint64_t)network->topology.particle_count;
}

bool mspringi_implicit_contact_begin(mspring_network *network, float h) {
    mspringi_contacts *contacts = contacts_near(network);
    bool any = false;
    if (!contacts) {
        mspringi_loose_contact_couple(network);
        return false;
    }
    mspringi_contact_load_nodes(network, contacts);
    for (uint32_t i = contacts->nodes.particle_count; i < contacts->nodes.count; ++i) {
        contacts->nodes.x[i] += contacts->passed * contacts->nodes.v[i].x;
        contacts->nodes.y[i] += contacts->passed * contacts->nodes.v[i].y;
    }
    (void)mspringi_contact_prepare_implicit(network, contacts, (double)h);
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        begin_constraint(network, &contacts->constraints[i], (double)h, &contacts->implicit_constraints[i]);
        contacts->implicit_constraints[i].is_active &=
            mspringi_implicit_of(network)->contact_mode != MSPRINGI_CONTACT_BY_IMPULSES;
        any |= contacts->implicit_constraints[i].is_active;
    }
    mspringi_loose_contact_couple(network);
    return any;
}

// In an interval nodes move by no more than the thickness.
uint32_t mspringi_implicit_contact_count_intervals(mspring_network *network, float h) {
    mspringi_contacts *contacts = contacts_near(network);
    if (!contacts)
        return 1;
    mspringi_contact_load_nodes(network, contacts);
    const double fastest = mspringi_contact_prepare_implicit(network, contacts, (double)h);
    return mspringi_intervals_of(1.0 + (double)h * fastest / contacts->thickness);
}

/* -------------------------------------------------------------------------------------------- the constraints */

// How far a node comes without its springs.
static void predict(const mspring_network *network, implicit_constraint *c, const mspringi_contact_constraint *t,
                    int i, double h, double way[2]) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    const uint32_t node = node_of(t, i), slot = c->slots[i];
    if (slot == MSPRING_NONE) {
        way[0] = h * k->v_start[node].x;
        way[1] = h * k->v_start[node].y;
        return;
    }
    way[0] = n->x[slot] - k->x[node];
    way[1] = n->y[slot] - k->y[node];
}

// Stiffness of a constraint: in series with the network's at each end, or a loose particle's inertia there.
static double stiffness_of(const mspring_network *network, implicit_constraint *c, double (*shares)[2]) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    double give = 0.0;
    for (int i = 0; i < 3; ++i) {
        const uint32_t slot = c->slots[i];
        if (slot == MSPRING_NONE)
            continue;
        const double square = shares[i][0] * shares[i][0] + shares[i][1] * shares[i][1];
        const double own = (double)n->mass[slot] + (double)n->system.xx[slot] + (double)n->system.yy[slot];
        give += square / ((mspringi_loose_contact_has(network, slot) ? PENALTY_OF_LOOSE : PENALTY) * own);
    }
    return give > 0.0 ? 1.0 / give : 0.0;
}

static mspringi_constraint *add_constraint(mspring_network *network, uint32_t number, implicit_constraint *c,
                                           double (*shares)[2], double way) {
    mspringi_constraints *all = &network->constraints;
    mspringi_constraint *added = mspringi_constraint_add(all, MSPRINGI_CONTACT_CONSTRAINT, number, 3);
    for (int i = 0; i < 3; ++i)
        if (c->slots[i] != MSPRING_NONE)
            mspringi_constraint_add_entry(all, c->slots[i], shares[i][0], shares[i][1]);
    added->stiffness = stiffness_of(network, c, shares);
    added->effort = -added->stiffness * way;
    return added;
}

// Add a push and its friction.
static void list_constraint(mspring_network *network, uint32_t number, double h) {
    const mspringi_contacts *contacts = network->contacts;
    const mspringi_contact_constraint *t = &contacts->constraints[number];
    implicit_constraint *c = &contacts->implicit_constraints[number];
    double way[3][2];
    for (int i = 0; i < 3; ++i)
        predict(network, c, t, i, h, way[i]);
    mspringi_constraint *push =
        add_constraint(network, number, c, c->across, product(c->across, way) - h * t->target_speed);
    c->listed = (uint32_t)(push - network->constraints.list);
    push->bounded = MSPRINGI_BOUND_PUSH;
    push->activity = c->is_active ? MSPRINGI_STIFF : MSPRINGI_IDLE;
    push->bound = push->stiffness * (c->spare + UNSEEN_SHARE * contacts->thickness);
    if (c->friction == 0.0)
        return;
    const double drag = t->collider == MSPRING_NONE ? 0.0 : h * mspringi_collider_surface_speed(contacts, t);
    mspringi_constraint *friction = add_constraint(network, number, c, c->along, product(c->along, way) + drag);
    friction->bounded = MSPRINGI_BOUND_FRICTION;
    friction->bound = c->friction;
}

void mspringi_implicit_contact_list_constraints(mspring_network *network, float h) {
    mspringi_loose_contact_keep_forces(network);
    const bool by_impulses = mspringi_implicit_of(network)->contact_mode == MSPRINGI_CONTACT_BY_IMPULSES;
    const uint32_t count = by_impulses ? 0 : count_of(network);
    for (uint32_t i = 0; i < count; ++i)
        list_constraint(network, i, (double)h);
}

// Impulse per force of the system.
static double per_force_in(const mspring_network *network, double h) {
    return h / mspringi_implicit_of(network)->system.force_scale;
}

void mspringi_implicit_contact_store_impulses(mspring_network *network, float h) {
    mspringi_contacts *contacts = network->contacts;
    const uint32_t count = count_of(network);
    const double per_force = per_force_in(network, (double)h);
    for (uint32_t i = 0; i < count; ++i) {
        implicit_constraint *c = &contacts->implicit_constraints[i];
        mspringi_contact_constraint *t = &contacts->constraints[i];
        const mspringi_constraint *push = c->listed == MSPRING_NONE ? NULL : &network->constraints.list[c->listed];
        const double across = push ? push->force : 0.0;
        const double along = push ? mspringi_friction_of(&network->constraints, push) : 0.0;
        t->normal_impulse = across * per_force;
        t->tangent_impulse = along * per_force;
    }
    mspringi_loose_contact_land(network);
}

/* ---------------------------------------------------------------------------------------------------- mending */

// If contact acts by impulses alone, growth in many intervals would add up.
double mspringi_implicit_contact_growth(const mspring_network *network, const mspringi_contact_constraint *t) {
    const double share = t->collider == MSPRING_NONE ? DEEPEST_SHARE : DEEPEST_IN_COLLIDER;
    const double rest = share * network->contacts->thickness + (t->gap < 0.0 ? t->gap : 0.0);
    const bool is_rigid = mspringi_implicit_of(network)->contact_mode == MSPRINGI_CONTACT_BY_IMPULSES;
    return is_rigid || rest < 0.0 ? 0.0 : GROWTH_SHARE * rest;
}

// True if a collider or pin of a constraint moves.
static bool is_driven(const mspring_network *network, const mspringi_contact_constraint *t) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    for (int i = 0; i < 3; ++i) {
        const uint32_t node = node_of(t, i);
        if (!(k->inverse_mass[node] > 0.0) && (k->v_start[node].x != 0.0 || k->v_start[node].y != 0.0))
            return true;
    }
    return false;
}

// Push a constraint apart by what its overlap has grown too much. Return true if it has. Impulses move particles as
// if they had no springs, but press springs by that. What moves and has no weight does work against them: as if the
// constraint's own spring had pushed as much more. (Without that a plate that pressed a stiff block onto pins
// seemed to do a tenth less work than it did: substeps were refused until no work was left, and the plate got 0.3
// thicknesses into the block.)
static bool mend(const mspring_network *network, mspringi_contact_constraint *t, double h) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    const double speed = mspringi_normal_speed(t, k->v);
    const double least = (t->gap < 0.0 ? t->gap : 0.0) - mspringi_implicit_contact_growth(network, t);
    const double lacks = least - (t->gap + h * speed);
    if (!(lacks > UNSEEN_SHARE * network->contacts->thickness))
        return false;
    const double impulse = t->normal_mass * lacks / h, x = impulse * t->nx, y = impulse * t->ny;
    implicit_constraint *c = &network->contacts->implicit_constraints[t - network->contacts->constraints];
    t->normal_impulse += impulse;
    if (c->listed != MSPRING_NONE && is_driven(network, t))
        c->mended += network->constraints.list[c->listed].stiffness * lacks * per_force_in(network, h);
    k->v[t->p].x += k->inverse_mass[t->p] * x;
    k->v[t->p].y += k->inverse_mass[t->p] * y;
    k->v[t->a].x -= t->bary_a * k->inverse_mass[t->a] * x;
    k->v[t->a].y -= t->bary_a * k->inverse_mass[t->a] * y;
    k->v[t->b].x -= t->bary_b * k->inverse_mass[t->b] * x;
    k->v[t->b].y -= t->bary_b * k->inverse_mass[t->b] * y;
    return true;
}

void mspringi_implicit_contact_fix_overlaps(mspring_network *network, mspringi_field base, float step) {
    mspringi_contacts *contacts = contacts_near(network);
    const mspringi_state *s = &network->state;
    const double h = (double)step;
    bool any = false;
    if (!contacts || contacts->constraint_count == 0)
        return;
    const bool is_rigid = mspringi_implicit_of(network)->contact_mode == MSPRINGI_CONTACT_BY_IMPULSES;
    const mspringi_contact_nodes *k = &contacts->nodes;
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        const uint32_t slot = slot_of(network, i);
        k->v[i].x = (mspringi_x_of(s, slot) - k->x[i]) / h;
        k->v[i].y = (mspringi_y_of(s, slot) - k->y[i]) / h;
    }
    const mspringi_motion before = mspringi_budget_motion_before(network);
    if (is_rigid)
        mspringi_rigid_contact_find_impulses(network, &before, base, h, UNSEEN_SHARE * contacts->thickness);
    contacts->support_count = 0;
    if (!is_rigid) // else bodies as a whole are kept out of the floor
        mspringi_floor_support_find(network, contacts);
    mspringi_floor_support_begin_implicit(contacts, h);
    for (uint32_t sweep = 0, again = 1; sweep < MOST_MENDING_SWEEPS && again; ++sweep) {
        again = 0;
        mspringi_floor_support_sweep(contacts);
        for (uint32_t i = 0; i < contacts->constraint_count; ++i)
            again |= !(is_rigid && mspringi_rigid_contact_has(network, &contacts->constraints[i])) &&
                     mend(network, &contacts->constraints[i], h);
        any |= again;
    }
    if (any)
        mspringi_floor_support_end(network, contacts);
    // Colliders last: nothing passes them, whatever else lies deeper for it.
    for (uint32_t sweep = 0, again = any; sweep < MOST_MENDING_SWEEPS && again; ++sweep) {
        again = 0;
        for (uint32_t i = 0; i < contacts->constraint_count; ++i)
            again |= contacts->constraints[i].collider != MSPRING_NONE &&
                     !(is_rigid && mspringi_rigid_contact_has(network, &contacts->constraints[i])) &&
                     mend(network, &contacts->constraints[i], h);
    }
    for (uint32_t i = 0; i < k->particle_count && (any || is_rigid); ++i) {
        const uint32_t slot = slot_of(network, i);
        const double vx = k->v[i].x - (mspringi_x_of(s, slot) - k->x[i]) / h;
        const double vy = k->v[i].y - (mspringi_y_of(s, slot) - k->y[i]) / h;
        if (vx == 0.0 && vy == 0.0)
            continue;
        mspringi_set_velocity_in_full(s, slot, mspringi_vx_of(s, slot) + vx, mspringi_vy_of(s, slot) + vy);
        mspringi_move_by(s, slot, (float)(h * vx), (float)(h * vy));
    }
    if (is_rigid)
        mspringi_rigid_contact_move(network, &before, h);
}

/* ---------------------------------------------------------------------------------------------------- the check */

// Normal speed of a constraint at the start of the substep.
static double speed_before(const mspringi_contacts *contacts, const mspringi_contact_constraint *t) {
    return mspringi_normal_speed(t, contacts->nodes.v_start);
}

// Speed of a constraint along some shares, from the displacement in the substep.
static double speed_of(const mspring_network *network, const mspringi_contact_constraint *t, implicit_constraint *c,
                       double (*shares)[2], double h) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    const mspringi_state *s = &network->state;
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        const uint32_t node = node_of(t, i), slot = c->slots[i];
        const bool is_known = slot == MSPRING_NONE;
        const double x = is_known ? k->v_start[node].x : (mspringi_x_of(s, slot) - k->x[node]) / h;
        const double y = is_known ? k->v_start[node].y : (mspringi_y_of(s, slot) - k->y[node]) / h;
        sum += shares[i][0] * x + shares[i][1] * y;
    }
    return sum;
}

// Push-out of an overlap may add energy up to the target speed.
bool mspringi_implicit_contact_kept_energy(const mspring_network *network, float h) {
    const mspringi_contacts *contacts = network->contacts;
    const uint32_t count = count_of(network);
    double given = 0.0, taken = 0.0, most = 0.0, least = 0.0;
    for (uint32_t i = 0; i < count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        implicit_constraint *c = &contacts->implicit_constraints[i];
        if (t->normal_impulse == 0.0 && t->tangent_impulse == 0.0)
            continue;
        const double before = speed_before(contacts, t);
        const double after = speed_of(network, t, c, c->across, (double)h);
        const double allowed = t->target_speed > 0.0 ? t->target_speed : 0.0;
        const double drag = t->collider == MSPRING_NONE ? 0.0 : mspringi_collider_surface_speed(contacts, t);
        const double slide = c->friction > 0.0 ? speed_of(network, t, c, c->along, (double)h) + drag : 0.0;
        given += t->normal_impulse * (after - allowed) + t->tangent_impulse * slide;
        taken += fabs(t->normal_impulse) * (fabs(before) + fabs(after));
        most = t->normal_impulse > most ? t->normal_impulse : most;
        least = t->normal_impulse < least ? t->normal_impulse : least;
    }
    return given <= GIVEN_SHARE * taken && -least <= GIVEN_SHARE * most;
}

/* -------------------------------------------------------------------------------------- pairs that got too deep */

// Find the position of a node at the end of a substep.
static void end_of_node(const mspring_network *network, uint32_t node, double h, double *x, double *y) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    *x = k->x[node] + h * k->v[node].x;
    *y = k->y[node] + h * k->v[node].y;
    if (node < k->particle_count) {
        *x = mspringi_x_of(&network->state, slot_of(network, node));
        *y = mspringi_y_of(&network->state, slot_of(network, node));
    }
}

static double product_of(const mspringi_closest_point *a, const mspringi_closest_point *b) {
    return a->x * b->x + a->y * b->y;
}

static double square_of(const mspringi_closest_point *at) {
    return product_of(at, at);
}

/// Positions of a pair's nodes.
typedef struct pair_positions {
    double px, py, ax, ay, bx, by;
} pair_positions;

static mspringi_closest_point closest_at(const pair_positions *at) {
    return mspringi_closest_point_on_edge(at->px, at->py, at->ax, at->ay, at->bx, at->by);
}

// Longest way of a node in a substep.
static double longest_way(const mspring_network *network, double h) {
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    double most = 0.0, x, y;
    for (uint32_t i = 0; i < k->count; ++i) {
        end_of_node(network, i, h, &x, &y);
        const double dx = x - k->x[i], dy = y - k->y[i], square = dx * dx + dy * dy;
        most = square > most ? square : most;
    }
    return sqrt(most);
}

/// Bisections of a way, after which a millionth of it is left.
#define MOST_BISECTIONS 20

// Closest point at the time at which a point passes an edge, if it is beyond at the end.
static mspringi_closest_point closest_on_way(const pair_positions *from, const mspringi_closest_point *start,
                                             const pair_positions *to, const mspringi_closest_point *end) {
    mspringi_closest_point beyond = *end;
    double before = 0.0, after = 1.0;
    for (int i = 0; i < MOST_BISECTIONS && product_of(start, end) < 0.0; ++i) {
        const double s = 0.5 * (before + after), r = 1.0 - s;
        const pair_positions at = {r * from->px + s * to->px, r * from->py + s * to->py, r * from->ax + s * to->ax,
                                   r * from->ay + s * to->ay, r * from->bx + s * to->bx, r * from->by + s * to->by};
        const mspringi_closest_point closest = closest_at(&at);
        const bool is_before = product_of(start, &closest) > 0.0;
        before = is_before ? s : before;
        after = is_before ? after : s;
        beyond = is_before ? beyond : closest;
    }
    return beyond;
}

// True if a pair got too deep, or too much deeper, in a substep, at its end or on the way. Nodes go `way` at
// most.
static bool is_thrown(const mspring_network *network, const mspringi_candidate *c, double h, double way) {
    const mspringi_contacts *contacts = network->contacts;
    const mspringi_contact_nodes *k = &contacts->nodes;
    const mspringi_pair *pair = &contacts->list[c->pair];
    const double radius = mspringi_radius_of(contacts, pair->point, pair->edge);
    const double touches = radius + contacts->thickness, growth = MISSED_SHARE * contacts->thickness;
    const double reach = touches + 2.0 * way;
    const pair_positions from = {k->x[c->p], k->y[c->p], k->x[c->a], k->y[c->a], k->x[c->b], k->y[c->b]};
    const mspringi_closest_point start = closest_at(&from);
    if (!(square_of(&start) < reach * reach))
        return false;
    pair_positions to;
    end_of_node(network, c->p, h, &to.px, &to.py);
    end_of_node(network, c->a, h, &to.ax, &to.ay);
    end_of_node(network, c->b, h, &to.bx, &to.by);
    const mspringi_closest_point end = closest_at(&to), deepest = closest_on_way(&from, &start, &to, &end);
    return sqrt(square_of(&deepest)) < fmin(sqrt(square_of(&start)), touches) - growth;
}

bool mspringi_implicit_contact_missed_pairs(const mspring_network *network, float h) {
    const mspringi_contacts *contacts = contacts_near(network);
    const double way = contacts ? longest_way(network, (double)h) : 0.0;
    for (uint32_t i = 0; contacts && i < contacts->candidate_count; ++i)
        if (is_thrown(network, &contacts->candidates[i], (double)h, way))
            return true;
    return false;
}

/* --------------------------------------------------------------------------------------------- once it is taken */

void mspringi_implicit_contact_count_impulses(mspring_network *network, float h) {
    mspringi_contacts *contacts = contacts_near(network);
    if (!contacts)
        return;
    contacts->passed += (double)h;
    mspringi_contact_count_impulses(network, contacts);
}

/* ----------------------------------------------------------------------------------------------------- the work */

// Moments of a component's forces are told from half the way of its mass centre. Those of contact act at the
// beginning of the way, where bodies that touch have the same lever arms.
static void account(const mspringi_budget_sums *all, const mspringi_contact_constraint *t, implicit_constraint *c,
                    int i) {
    const mspring_network *network = all->network;
    const mspringi_contact_nodes *k = &network->contacts->nodes;
    mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const uint32_t slot = c->slots[i], node = node_of(t, i);
    if (slot == MSPRING_NONE || budget->of_slot[slot] == MSPRINGI_NO_COMPONENT)
        return;
    mspringi_component_budget *a = &budget->components[budget->of_slot[slot]];
    const double fx = (c->across[i][0] * t->normal_impulse + c->along[i][0] * t->tangent_impulse) / (double)all->h;
    const double fy = (c->across[i][1] * t->normal_impulse + c->along[i][1] * t->tangent_impulse) / (double)all->h;
    const double mass = a->sums[MSPRINGI_MOMENT_MASS];
    double x = (double)all->motion.x[slot] + (double)all->motion.low_x[slot] - k->x[node];
    double y = (double)all->motion.y[slot] + (double)all->motion.low_y[slot] - k->y[node];
    if (a->is_rigid) { // its velocity changes at once: the work is that of the mean
        const double turn = a->rigid_turn + 0.5 * a->push_turn, h = (double)all->h;
        x = h * (a->rigid_vx + 0.5 * a->push_x - turn * (k->y[node] - a->origin[1] - a->y));
        y = h * (a->rigid_vy + 0.5 * a->push_y + turn * (k->x[node] - a->origin[0] - a->x));
    }
    const double rx = k->x[node] - a->origin[0] + 0.5 * (a->sums[MSPRINGI_MOMENT_X] / mass - a->x);
    const double ry = k->y[node] - a->origin[1] + 0.5 * (a->sums[MSPRINGI_MOMENT_Y] / mass - a->y);
    a->sums[MSPRINGI_EFFECT_X] += fx;
    a->sums[MSPRINGI_EFFECT_Y] += fy;
    a->sums[MSPRINGI_EFFECT_TORQUE] += rx * fy - ry * fx;
    const double mended = c->mended / (double)all->h * (c->across[i][0] * x + c->across[i][1] * y);
    a->sums[MSPRINGI_EFFECT_WORK] += fx * x + fy * y + mended;
    a->pushed += fx * x + fy * y + mended;
    a->is_touched = true;
}

void mspringi_implicit_contact_add_impulses(const mspringi_budget_sums *all) {
    const mspringi_contacts *contacts = all->network->contacts;
    const uint32_t count = count_of(all->network);
    mspringi_budget *budget = &mspringi_implicit_of(all->network)->budget;
    for (uint32_t i = 0; i < budget->count; ++i)
        budget->components[i].pushed = 0.0;
    for (uint32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3 && (contacts->constraints[i].normal_impulse != 0.0 ||
                                  contacts->constraints[i].tangent_impulse != 0.0);
             ++k)
            account(all, &contacts->constraints[i], &contacts->implicit_constraints[i], k);
}
