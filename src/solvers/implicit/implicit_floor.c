/// Floor in the linear system of an implicit substep: an active-set method.
///
/// A normal spring holds a particle that would come below the surface. A tangential one holds it within the
/// friction cone. Both are far stiffer than the network at the particle, so the network gives way. Solving again
/// finds the active set: contacts that pull are released, new ones are added, and tangential forces beyond the cone
/// slide. (Hintermueller, Ito and Kunisch, 2003.) mspringi_floor_apply_all() takes back what these springs give way
/// after the substep.
///
/// A substep with an impact, and the next one, are of implicit Euler. Methods of second order would take the impact
/// for a lasting acceleration, and throw the network back at up to half its speed.
#include "solvers/implicit/implicit_terms.h"

#include <math.h>

/// The stiffness of what holds a particle, in that of the network at it and its own inertia. What the force on the
/// particle is shows in how far that gives way, which must be more than what iterations leave undecided.
#define PENALTY_DIRECT 1e3
#define PENALTY_ITERATED 30.0

/// Depth of a particle, as a share of the shortest spring, that divides a substep into intervals. Springs that turn
/// by more differ from their linearisation, so an impact adds energy.
#define DEEPEST_SHARE 0.2

/* ------------------------------------------------------------------------------------------------ what is near */

/// A particle on its way.
typedef struct mover {
    size_t slot;
    double start_x, start_y;       ///< before the substep
    double straight_x, straight_y; ///< h v on. The prediction has turned on from there with its tile, so it may be
                                   ///< clear of the floor where the particle is not, and the other way round.
} mover;

static mover mover_of(const mspring_network *network, size_t slot, double h) {
    const mspringi_state *s = &network->state;
    const double x = (double)s->x[slot], y = (double)s->y[slot];
    return (mover){slot, x, y, x + h * (double)s->vx[slot], y + h * (double)s->vy[slot]};
}

/// A surface that a particle may touch.
typedef struct near_surface {
    const mspringi_line *line;
    double straight; ///< distance where the particle comes straight on, m
    double drop;     ///< what gravity adds to that, m
} near_surface;

// Check a surface, and insert it if it is among the nearest that the particle may touch. Return true if the
// particle hits it.
static bool check_surface(const mspring_network *network, const mover *m, const mspringi_line *line, double fall,
                          near_surface nearest[MSPRINGI_MAX_FLOOR_CONTACTS], uint32_t *count) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const double slop = mspringi_floor_slop(n->x[m->slot], n->y[m->slot]);
    const double before = mspringi_distance_from_line(line, m->start_x, m->start_y);
    const double straight = mspringi_distance_from_line(line, m->straight_x, m->straight_y);
    const double drop =
        fall * (line->nx * (double)network->settings.gravity_x + line->ny * (double)network->settings.gravity_y);
    const near_surface found = {line, straight, drop};
    if (!(straight < 4.0 * slop + 2.0 * fabs(drop) + fabs(straight - before)))
        return false;
    if (*count < MSPRINGI_MAX_FLOOR_CONTACTS) {
        nearest[(*count)++] = found;
    } else {
        uint32_t farthest = 0;
        for (uint32_t i = 1; i < *count; ++i)
            farthest = nearest[i].straight > nearest[farthest].straight ? i : farthest;
        if (straight < nearest[farthest].straight)
            nearest[farthest] = found;
    }
    return before > 2.0 * slop && straight < -2.0 * slop;
}

static mspringi_constraint *add_constraint(mspring_network *network, uint32_t slot, double x, double y,
                                           double way) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const double own = (double)n->mass[slot] + (double)n->system.xx[slot] + (double)n->system.yy[slot];
    mspringi_constraint *c = mspringi_constraint_add(&network->constraints, MSPRINGI_FLOOR_CONSTRAINT, 0, 1);
    mspringi_constraint_add_entry(&network->constraints, slot, x, y);
    c->stiffness = (n->is_direct ? PENALTY_DIRECT : PENALTY_ITERATED) * own;
    c->effort = -c->stiffness * way;
    return c;
}

// Add a push and its friction.
static void add_contact(mspring_network *network, const mover *m, const near_surface *surface) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_line *line = surface->line;
    const uint32_t slot = (uint32_t)m->slot;
    const double x = n->x[slot], y = n->y[slot], slop = mspringi_floor_slop(x, y), nx = line->nx, ny = line->ny;
    const double depth = -(surface->straight + surface->drop);
    const double slid = nx * (m->straight_y - m->start_y) - ny * (m->straight_x - m->start_x);
    mspringi_constraint *push = add_constraint(network, slot, nx, ny, mspringi_distance_from_line(line, x, y));
    push->bounded = MSPRINGI_BOUND_PUSH;
    push->activity = depth > -slop ? MSPRINGI_STIFF : MSPRINGI_IDLE;
    push->bound = push->stiffness * slop;
    const double coefficient = mspringi_friction_on(line, mspringi_own_of(network, slot));
    if (coefficient == 0.0)
        return;
    mspringi_constraint *friction =
        add_constraint(network, slot, -ny, nx, nx * (y - m->start_y) - ny * (x - m->start_x));
    friction->bounded = MSPRINGI_BOUND_FRICTION;
    friction->activity = fabs(slid) > slop ? MSPRINGI_AT_BOUND : MSPRINGI_STIFF;
    friction->bound = coefficient;
    const double force = coefficient * (double)n->mass[slot] * fmax(depth, 0.0);
    friction->bound_force = slid < 0.0 ? force : -force;
}

// List the contacts of a particle: with a second surface if one is left of *seconds. Return true if it hits one.
static bool list_contacts(mspring_network *network, const mover *m, double fall, size_t *seconds) {
    const mspringi_floor *floor = network->floor;
    near_surface nearest[MSPRINGI_MAX_FLOOR_CONTACTS];
    mspringi_line part_line;
    uint32_t count = 0;
    bool hits = false;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        hits |= check_surface(network, m, &floor->lines[i], fall, nearest, &count);
    if (floor->heights.count > 0) {
        const int64_t part =
            mspringi_heights_first_hit(&floor->heights, m->start_x, m->start_y, m->straight_x, m->straight_y);
        part_line = mspringi_heights_line(&floor->heights, part);
        hits |= check_surface(network, m, &part_line, fall, nearest, &count);
    }
    const uint32_t first = count > 1 && *seconds == 0 && nearest[1].straight < nearest[0].straight;
    const uint32_t end = count > 1 && *seconds == 0 ? first + 1 : count;
    *seconds -= end - first > 1;
    for (uint32_t i = first; i < end; ++i)
        add_contact(network, m, &nearest[i]);
    return hits;
}

static bool is_clear(const mspringi_bounds *clear, const mover *m) {
    return m->straight_x > (double)clear->min_x && m->straight_x < (double)clear->max_x &&
           m->straight_y > (double)clear->min_y && m->straight_y < (double)clear->max_y;
}

// Slots of particles with springs, or with broken ones; the loose row's are dealt with after the substep, but for
// those of list_loose().
static size_t count_slots(const mspring_network *network) {
    return (size_t)network->topology.loose_first * MSPRINGI_WIDTH;
}

// Loose particles that touch others and lie on the floor. What falls on it bounces after the substep.
static void list_loose(mspring_network *network, double h, double fall, size_t *seconds) {
    const size_t end = mspringi_implicit_of(network)->has_touched ? mspringi_used_slots(network) : 0;
    for (size_t i = count_slots(network); i < end; ++i) {
        const mover m = mover_of(network, i, h);
        if (mspringi_loose_contact_has(network, (uint32_t)i) &&
            mspringi_floor_distance(network->floor, m.start_x, m.start_y) <=
                2.0 * mspringi_floor_slop(m.start_x, m.start_y))
            (void)list_contacts(network, &m, fall, seconds);
    }
}

bool mspringi_floor_list_constraints(mspring_network *network, float h) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_floor *floor = network->floor;
    const float *inverse_mass = mspringi_active_inverse_mass(network);
    const double fall = n->system.force_scale / n->scale; // c
    size_t seconds = mspringi_floor_max_second_contacts(network->topology.reserve.particle_end);
    bool hits = false;
    for (size_t i = 0; i < count_slots(network); ++i) {
        if (!(inverse_mass[i] > 0.0f))
            continue;
        const mover m = mover_of(network, i, (double)h);
        if (!is_clear(&floor->clear, &m) && !mspringi_floor_is_isolated(network, i))
            hits |= list_contacts(network, &m, fall, &seconds);
    }
    list_loose(network, (double)h, fall, &seconds);
    return !hits || n->uses_euler || n->integrator == MSPRING_INTEGRATOR_EULER;
}

uint32_t mspringi_floor_count_intervals(const mspring_network *network, float h) {
    const mspringi_floor *floor = network->floor;
    const float *inverse_mass = mspringi_active_inverse_mass(network);
    double deepest = 0.0;
    for (size_t i = 0; i < count_slots(network); ++i) {
        if (!(inverse_mass[i] > 0.0f))
            continue;
        const mover m = mover_of(network, i, (double)h);
        if (is_clear(&floor->clear, &m) || mspringi_floor_is_isolated(network, i))
            continue;
        const double before = fmin(mspringi_floor_distance(floor, m.start_x, m.start_y), 0.0);
        deepest = fmax(deepest, before - mspringi_floor_distance(floor, m.straight_x, m.straight_y));
    }
    return mspringi_intervals_of(1.0 + deepest / (DEEPEST_SHARE * network->shortest));
}

/* ------------------------------------------------------------------------------------------------ the impulses */

void mspringi_floor_record_impulses(const mspring_network *network, float h) {
    mspringi_floor *floor = network->floor;
    const double per_force = (double)h / mspringi_implicit_of(network)->system.force_scale;
    for (const mspringi_constraint *c = NULL; (c = mspringi_next_floor_push(&network->constraints, c)) != NULL;) {
        if (!mspringi_constraint_is_active(c))
            continue;
        const mspringi_jacobian_entry *e = &network->constraints.entries[c->first];
        const double across = fmax(c->force, 0.0), along = mspringi_friction_of(&network->constraints, c);
        floor->impulse.x[e->slot] += (float)(per_force * (across * e->x - along * e->y));
        floor->impulse.y[e->slot] += (float)(per_force * (across * e->y + along * e->x));
    }
}
