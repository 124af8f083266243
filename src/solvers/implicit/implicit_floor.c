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

/// Solutions of a substep that may release contacts or let them slide. Later ones only add contacts or make them
/// stick.
#define FREE_PASSES 2

/// Change of a normal force, as a part of it, that friction is worth another solution for.
#define SAME_FORCE 0.02

/// Depth of a particle, as a share of the shortest spring, that divides a substep into intervals, and most
/// intervals. Springs that turn by more differ from their linearisation, so an impact adds energy.
#define DEEPEST_SHARE 0.2
#define MOST_PIECES 40u

static double distance_from(const mspringi_line *line, double x, double y) {
    return line->nx * x + line->ny * y + line->offset;
}

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

// Add a contact with a line if it may come about. Returns whether the particle hits it.
static bool consider(mspring_network *network, const mover *m, const mspringi_line *line, double fall) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_floor *floor = network->floor;
    const double x = n->x[m->slot], y = n->y[m->slot], slop = mspringi_floor_slop(x, y);
    const double before = distance_from(line, m->start_x, m->start_y);
    const double straight = distance_from(line, m->straight_x, m->straight_y);
    const double drop =
        fall * (line->nx * (double)network->settings.gravity_x + line->ny * (double)network->settings.gravity_y);
    const bool is_near = straight < 4.0 * slop + 2.0 * fabs(drop) + fabs(straight - before);
    if (!is_near || floor->contact_count == floor->contact_capacity)
        return false;
    const double slid = line->nx * (m->straight_y - m->start_y) - line->ny * (m->straight_x - m->start_x);
    floor->contacts[floor->contact_count++] =
        (mspringi_floor_contact){.slot = (uint32_t)m->slot,
                                 .is_active = straight + drop<slop, .slip = slid> slop ? 1.0
                                              : slid < -slop                           ? -1.0
                                                                                       : 0.0,
                                 .nx = line->nx,
                                 .ny = line->ny,
                                 .friction = line->friction,
                                 .gap = distance_from(line, x, y),
                                 .ahead = line->nx * (y - m->start_y) - line->ny * (x - m->start_x),
                                 .normal = (double)n->mass[m->slot] * fmax(-(straight + drop), 0.0)};
    return before > 2.0 * slop && straight < -2.0 * slop;
}

static bool consider_all(mspring_network *network, const mover *m, double fall) {
    const mspringi_floor *floor = network->floor;
    bool hits = false;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        hits |= consider(network, m, &floor->lines[i], fall);
    if (floor->heights.count > 0) {
        const int64_t part =
            mspringi_heights_first_hit(&floor->heights, m->start_x, m->start_y, m->straight_x, m->straight_y);
        const mspringi_line line = mspringi_heights_line(&floor->heights, part);
        hits |= consider(network, m, &line, fall);
    }
    return hits;
}

static bool is_clear(const mspringi_bounds *clear, const mover *m) {
    return m->straight_x > (double)clear->min_x && m->straight_x < (double)clear->max_x &&
           m->straight_y > (double)clear->min_y && m->straight_y < (double)clear->max_y;
}

// Slots of particles with springs, or with broken ones; the loose row's are dealt with after the substep.
static size_t count_slots(const mspring_network *network) {
    return (size_t)network->topology.loose_first * MSPRINGI_WIDTH;
}

// List the contacts that may come about. Returns whether any particle hits the floor.
static bool find_contacts(mspring_network *network, double h, double fall) {
    mspringi_floor *floor = network->floor;
    const float *inverse_mass = mspringi_active_inverse_mass(network);
    bool hits = false;
    floor->contact_count = 0;
    for (size_t i = 0; i < count_slots(network); ++i) {
        if (!(inverse_mass[i] > 0.0f))
            continue;
        const mover m = mover_of(network, i, h);
        if (!is_clear(&floor->clear, &m) && !mspringi_floor_is_isolated(network, i))
            hits |= consider_all(network, &m, fall);
    }
    return hits;
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
    const double pieces = 1.0 + deepest / (DEEPEST_SHARE * network->shortest);
    return pieces < (double)MOST_PIECES ? (uint32_t)pieces : MOST_PIECES;
}

/* --------------------------------------------------------------------------------------------------- the terms */

// Stiffness and target position of a contact in the matrix.
typedef struct term {
    double xx, xy, yy, to_x, to_y;
} term;

static term term_of(const mspringi_floor_contact *c) {
    const double across = c->is_active ? c->stiffness : 0.0;
    const double along = c->is_active && c->slip == 0.0 && c->friction > 0.0 ? c->stiffness : 0.0;
    const double tx = -c->ny, ty = c->nx;
    const double slide = c->is_active && c->slip != 0.0 ? -c->friction * c->slip * c->normal : 0.0;
    const double push = -across * c->gap, pull = slide - along * c->ahead;
    return (term){across * c->nx * c->nx + along * tx * tx, across * c->nx * c->ny + along * tx * ty,
                  across * c->ny * c->ny + along * ty * ty, push * c->nx + pull * tx, push * c->ny + pull * ty};
}

bool mspringi_floor_add_terms(mspring_network *network, float h, uint32_t pass) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_floor *floor = network->floor;
    const double fall = n->system.force_scale / n->scale; // c
    if (pass == 0 && find_contacts(network, (double)h, fall) && !n->uses_euler &&
        n->integrator != MSPRING_INTEGRATOR_EULER)
        return false;
    n->has_constraints_in_coarse |= floor->contact_count > 0;
    for (uint32_t i = 0; pass == 0 && i < floor->contact_count; ++i) {
        mspringi_floor_contact *c = &floor->contacts[i];
        const double own = (double)n->mass[c->slot] + (double)n->system.xx[c->slot] + (double)n->system.yy[c->slot];
        c->stiffness = (n->is_direct ? PENALTY_DIRECT : PENALTY_ITERATED) * own;
    }
    for (uint32_t i = 0; i < floor->contact_count; ++i) {
        const mspringi_floor_contact *c = &floor->contacts[i];
        const term add = term_of(c);
        n->system.xx[c->slot] += (float)add.xx;
        n->system.xy[c->slot] += (float)add.xy;
        n->system.yy[c->slot] += (float)add.yy;
        n->residual.x[c->slot] += (float)add.to_x;
        n->residual.y[c->slot] += (float)add.to_y;
    }
    return true;
}

bool mspringi_floor_hold(const mspring_network *network, uint32_t i, mspringi_slot_stiffness *hold) {
    const term add = term_of(&network->floor->contacts[i]);
    *hold = (mspringi_slot_stiffness){network->floor->contacts[i].slot, add.xx, add.xy, add.yy};
    return true;
}

/* -------------------------------------------------------------------------------------------------- the review */

// Look at what a contact came to. Returns whether that is other than what was assumed.
static bool review(mspringi_floor_contact *c, double dx, double dy, double slop, bool is_free) {
    const double gap = c->gap + c->nx * dx + c->ny * dy, ahead = c->ahead + c->nx * dy - c->ny * dx;
    const mspringi_floor_contact before = *c;
    if (before.is_active)
        c->normal = fmax(-c->stiffness * gap, 0.0);
    const double most = c->friction * c->normal, needed = c->stiffness * ahead;
    c->along = !before.is_active ? 0.0 : before.slip != 0.0 ? c->friction * before.slip * before.normal : needed;
    c->is_active = c->is_active ? gap <= 0.0 || !is_free : gap < -slop;
    if (c->friction == 0.0) {
        c->along = 0.0;
        return c->is_active != before.is_active;
    }
    if (is_free && before.is_active && before.slip == 0.0 && fabs(needed) > most)
        c->slip = ahead > 0.0 ? 1.0 : -1.0;
    else if (before.slip * ahead < 0.0)
        c->slip = 0.0;
    const bool other_force = is_free && c->slip != 0.0 && fabs(c->normal - before.normal) > SAME_FORCE * c->normal;
    return c->is_active != before.is_active || (c->is_active && (c->slip != before.slip || other_force));
}

void mspringi_floor_record_impulses(const mspring_network *network, float h) {
    mspringi_floor *floor = network->floor;
    const double per_force = (double)h / mspringi_implicit_of(network)->system.force_scale;
    for (uint32_t i = 0; i < floor->contact_count; ++i) {
        const mspringi_floor_contact *c = &floor->contacts[i];
        const double across = c->is_active ? c->normal : 0.0, along = c->is_active ? c->along : 0.0;
        floor->impulse.x[c->slot] += (float)(per_force * (across * c->nx + along * c->ny));
        floor->impulse.y[c->slot] += (float)(per_force * (across * c->ny - along * c->nx));
    }
}

bool mspringi_floor_update_active_set(mspring_network *network, float alpha, uint32_t pass) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_floor *floor = network->floor;
    const bool is_whole = n->is_direct; // displacement is all of it
    bool again = false;
    for (uint32_t i = 0; i < floor->contact_count; ++i) {
        mspringi_floor_contact *c = &floor->contacts[i];
        const double rest_x = is_whole ? 0.0 : (double)alpha * (double)n->direction.x[c->slot];
        const double rest_y = is_whole ? 0.0 : (double)alpha * (double)n->direction.y[c->slot];
        const double dx = (double)n->displacement.x[c->slot] + rest_x;
        const double dy = (double)n->displacement.y[c->slot] + rest_y;
        again |= review(c, dx, dy, mspringi_floor_slop(n->x[c->slot], n->y[c->slot]), pass < FREE_PASSES);
    }
    return again;
}
