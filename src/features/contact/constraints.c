/// Contact constraints: one for each outline point that touches, or may touch, an edge in an interval.
///
/// A constraint keeps the gap at the end of the interval, gap + h v, from becoming negative. An overlap is pushed
/// out at a bounded speed. A pair gets a constraint if its present velocities can close the gap, or if the solver
/// has made it fast enough to.
///
/// Restitution acts on the normal speed before the substep's forces. An impulse J changes the energy by J times the
/// mean of the speeds before the forces and after contact. So any later speed would add energy.
///
/// The order of constraints follows from ids and from the pairs alone. Results do not depend on when the list was
/// made.
///
/// mspringi_contact_make_constraints goes through the candidates: filter_candidates() drops most,
/// queue_constraint() makes the others pending, order_pending() orders those, make_constraint() makes their
/// constraints.
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "base/cpu.h"
#include "features/contact/relaxation.h"
#include "store/network.h"

/// Share of an overlap that is pushed out in a substep, within the host's limit on speed. Intervals of an implicit
/// substep push at the same speed. (With this share in each of 32 intervals, a stiff body in a pinch had 1.9 times
/// its energy in a step.)
#define PUSHOUT_FRACTION 0.2

/// Slowest bounce, m/s.
#define RESTITUTION_THRESHOLD 0.2

/// Longest move of a fast node in an interval, in thicknesses.
#define MAX_MOVE 1.25

/// Half of the extra reach of an implicit substep, as a share of the thickness.
#define EXTRA_APPROACH 0.1

/// Candidates in a batch of the filter, and its margin beyond the reach, as a share of the thickness.
#define FILTER_BATCH 256u
#define FILTER_MARGIN 0.05

/// Candidates and pending constraints that are worth a worker: 25 us.
#define LEAST_CANDIDATES 1024u
#define LEAST_PENDING 256u

/// Edges at each end of a pair's edge for which the pair remembers the answer of is_excluded(), a bit each.
#define REMEMBERED 8

/* ------------------------------------------------------------------------------------------------------- nodes */

// Load a collider point. Contact does not move it.
static void load_collider_point(const mspringi_contacts *contacts, uint32_t i) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    const uint32_t point = k->particles[i] - contacts->particles;
    k->x[i] = contacts->colliders.x[point];
    k->y[i] = contacts->colliders.y[point];
    k->v[i].x = k->v_start[i].x = contacts->colliders.vx[point];
    k->v[i].y = k->v_start[i].y = contacts->colliders.vy[point];
    k->inverse_mass[i] = 0.0;
}

void mspringi_contact_load_nodes(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    const mspringi_state *s = &network->state;
    const float *active_inverse_mass = mspringi_active_inverse_mass(network);
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        k->x[i] = mspringi_x_of(s, slot);
        k->y[i] = mspringi_y_of(s, slot);
        k->v_start[i].x = (double)s->vx[slot];
        k->v_start[i].y = (double)s->vy[slot];
        k->inverse_mass[i] = (double)active_inverse_mass[slot];
    }
    for (uint32_t i = k->particle_count; i < k->count; ++i)
        load_collider_point(contacts, i);
}

void mspringi_contact_begin_substep(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    mspringi_contact_load_nodes(network, contacts);
    for (uint32_t i = 0; i < k->particle_count; ++i)
        k->shift_x[i] = k->shift_y[i] = 0.0;
    contacts->passed = 0.0;
}

/* -------------------------------------------------------------------------------------------------- constraints */

// True if the point never touches the edge with this number at an end of the pair's edge, because its other end
// `other` is a neighbour of the point. The pair remembers the answer.
static bool is_excluded(const mspring_network *network, mspringi_contacts *contacts, mspringi_pair *pair,
                        uint32_t end, uint32_t number, mspring_id other) {
    const uint32_t bit = number < REMEMBERED ? 1u << (end * REMEMBERED + number) : 0;
    if (!contacts->touches_itself || mspringi_is_collider_point(contacts, pair->point) ||
        mspringi_is_collider_point(contacts, other))
        return false;
    if (pair->tested_bits & bit)
        return pair->excluded_bits & bit;
    const bool is_neighbour = mspringi_outline_are_neighbours(network, contacts, pair->point, other);
    pair->tested_bits |= (uint16_t)bit;
    pair->excluded_bits |= (uint16_t)(is_neighbour ? bit : 0);
    return is_neighbour;
}

// True if another edge at the same corner takes the contact: a nearer one, else the one with the lower number.
static bool belongs_to_other_edge(const mspring_network *network, mspringi_contacts *contacts, mspringi_pair *pair,
                                  uint32_t end) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_contact_nodes *k = &contacts->nodes;
    const mspring_id corner = end == 0 ? o->a[pair->edge] : o->b[pair->edge];
    const uint32_t at = k->number[corner], p = k->number[pair->point];
    const double dx = k->x[p] - k->x[at], dy = k->y[p] - k->y[at];
    bool is_found = false;
    uint32_t j = o->first[corner];
    for (; j < o->first[corner + 1] && !is_found; ++j) {
        const uint32_t edge = o->at[j];
        if (edge == pair->edge)
            continue;
        const mspring_id other = o->a[edge] == corner ? o->b[edge] : o->a[edge];
        const uint32_t beyond = k->number[other];
        const bool is_nearer = dx * (k->x[beyond] - k->x[at]) + dy * (k->y[beyond] - k->y[at]) > 0.0;
        is_found = (is_nearer || edge < pair->edge) && other != pair->point &&
                   !is_excluded(network, contacts, pair, end, j - o->first[corner], other);
    }
    mspringi_contact_count_visits(contacts, j - o->first[corner]);
    return is_found;
}

// Add friction. It acts on the surface, not on the edge's centre line; the couple conserves angular momentum.
static void add_friction(const mspringi_contacts *contacts, mspringi_contact_constraint *t) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    const double ex = k->x[t->b] - k->x[t->a], ey = k->y[t->b] - k->y[t->a], square = ex * ex + ey * ey;
    if (square == 0.0 && t->collider == MSPRING_NONE)
        return;
    if (square > 0.0) {
        const double arm = t->collider == MSPRING_NONE
                               ? t->distance
                               : t->distance - mspringi_collider_friction_offset(contacts, t);
        const double turn = arm / square;
        t->couple_x = turn * ex;
        t->couple_y = turn * ey;
    }
    const double inverse_mass_a = k->inverse_mass[t->a], inverse_mass_b = k->inverse_mass[t->b];
    const double ax = t->bary_a * t->ny - t->couple_y, ay = t->bary_a * t->nx - t->couple_x;
    const double bx = t->bary_b * t->ny + t->couple_y, by = t->bary_b * t->nx + t->couple_x;
    t->couple_response =
        (inverse_mass_a * t->bary_a - inverse_mass_b * t->bary_b) * (t->couple_y * t->nx - t->couple_x * t->ny);
    t->tangent_mass =
        1.0 / (k->inverse_mass[t->p] + inverse_mass_a * (ax * ax + ay * ay) + inverse_mass_b * (bx * bx + by * by));
    if (t->collider != MSPRING_NONE)
        t->surface_speed = mspringi_collider_surface_speed(contacts, t);
}

// Normal speed from gravity in an implicit interval, m/s. A bounce that ignored it would rise above its start.
static double gravity_normal_speed(const mspringi_contacts *contacts, const mspringi_contact_constraint *t) {
    const double *inverse_mass = contacts->nodes.inverse_mass;
    const double share = (inverse_mass[t->p] > 0.0 ? 1.0 : 0.0) - (inverse_mass[t->a] > 0.0 ? t->bary_a : 0.0) -
                         (inverse_mass[t->b] > 0.0 ? t->bary_b : 0.0);
    return share * (t->nx * contacts->fall_x + t->ny * contacts->fall_y);
}

// Set the target speed: restitution or push-out, whichever is larger.
static void set_target_speed(mspringi_contacts *contacts, mspringi_contact_constraint *t, double restitution,
                             double h) {
    t->target_speed = -t->gap / h;
    t->clear_speed = t->target_speed;
    t->is_bounce = false;
    if (t->gap <= 0.0) {
        t->clear_speed = DBL_MAX;
        t->target_speed *= PUSHOUT_FRACTION * contacts->share;
        t->target_speed = t->target_speed < contacts->push ? t->target_speed : contacts->push;
        if (t->target_speed > contacts->kept_push)
            mspringi_relaxation_limit_push(contacts, t);
    }
    const double before = mspringi_normal_speed(t, contacts->nodes.v_start);
    if (!(before < -RESTITUTION_THRESHOLD))
        return;
    const double back = -restitution * before, fall = gravity_normal_speed(contacts, t);
    const double bounce = fall < 0.0 ? (back + fall > 0.0 ? back + fall : 0.0) : back;
    t->is_bounce = bounce > t->target_speed && bounce > 0.0;
    t->target_speed = bounce > t->target_speed ? bounce : t->target_speed;
}

static double square_of_speed(const mspringi_contact_nodes *k, uint32_t p, uint32_t q) {
    const double x = k->v[p].x - k->v[q].x, y = k->v[p].y - k->v[q].y;
    return x * x + y * y;
}

// Collider of the pair's point or edge, or NULL.
static const mspringi_collider *collider_of_pair(const mspringi_contacts *contacts, const mspringi_pair *pair) {
    const mspring_id a = contacts->outline.a[pair->edge];
    return mspringi_is_collider_point(contacts, pair->point) ? mspringi_collider_of(contacts, pair->point)
           : mspringi_is_collider_point(contacts, a)         ? mspringi_collider_of(contacts, a)
                                                             : NULL;
}

// Inverse mass of the point and the closest point of the edge, which is `share` of the way from a to b, 1/kg.
static double inverse_mass_of(const mspringi_contact_nodes *k, const mspringi_candidate *c, double share) {
    const double of_a = 1.0 - share;
    return k->inverse_mass[c->p] + of_a * of_a * k->inverse_mass[c->a] + share * share * k->inverse_mass[c->b];
}

// Largest squared speed of the point relative to an end of the edge.
static double max_square_speed(const mspringi_contact_nodes *k, uint32_t p, uint32_t a, uint32_t b) {
    const double of_a = square_of_speed(k, p, a), of_b = square_of_speed(k, p, b);
    return of_a > of_b ? of_a : of_b;
}

static mspringi_contact_material material_of(const mspringi_contacts *contacts, const mspringi_pair *pair,
                                             const mspringi_collider *collider) {
    if (contacts->materials)
        return mspringi_contact_material_mix(contacts, pair, collider);
    return collider ? (mspringi_contact_material){collider->def.friction, collider->def.restitution}
                    : (mspringi_contact_material){contacts->def.friction, contacts->def.restitution};
}

// Make the constraint of a pending one in an interval of h seconds.
static void make_constraint(mspringi_contacts *contacts, const mspringi_pending_constraint *pending,
                            mspringi_contact_constraint *t, double h) {
    const mspringi_candidate *c = &contacts->candidates[pending->candidate];
    const mspringi_pair *pair = &contacts->list[c->pair];
    MSPRINGI_ASSERT(pending->candidate < contacts->candidate_count && pending->inverse_mass > 0.0);
    const mspringi_collider *collider = contacts->colliders.count > 0 ? collider_of_pair(contacts, pair) : NULL;
    const mspringi_contact_material material = material_of(contacts, pair, collider);
    t->p = c->p;
    t->a = c->a;
    t->b = c->b;
    t->candidate = pending->candidate;
    t->collider = collider ? (uint32_t)(collider - contacts->colliders.list) : MSPRING_NONE;
    t->distance = sqrt(pending->at.x * pending->at.x + pending->at.y * pending->at.y);
    t->gap = t->distance - (collider ? contacts->thickness + collider->radius : contacts->thickness);
    const double per_distance = 1.0 / t->distance;
    t->nx = pending->at.x * per_distance;
    t->ny = pending->at.y * per_distance;
    t->bary_a = 1.0 - pending->at.fraction;
    t->bary_b = pending->at.fraction;
    t->normal_mass = 1.0 / pending->inverse_mass;
    t->friction = material.friction;
    t->couple_x = t->couple_y = t->couple_response = t->tangent_mass = t->surface_speed = t->normal_impulse =
        t->tangent_impulse = 0.0;
    set_target_speed(contacts, t, (double)material.restitution, h);
    if (material.friction > 0.0f)
        add_friction(contacts, t);
}

static void make_range(const mspring_network *network, mspringi_contacts *contacts, mspringi_contact_range *range,
                       const void *argument) {
    const double *h = argument;
    (void)network;
    for (uint32_t i = range->first; i < range->end; ++i)
        make_constraint(contacts, &contacts->pending[i], &contacts->constraints[contacts->pending[i].place], *h);
}

/// Colours of pending constraints. The last one holds the rest, which may share particles.
#define COLOURS 32u

// Give pending constraints their places, by colours that they get greedily. Those of one colour share no movable
// particle, so that a processor can overlap them.
static void order_run(mspringi_contacts *contacts, uint32_t first, uint32_t end) {
    if (end - first == 1) {
        contacts->pending[first].place = contacts->constraint_count + first;
        return;
    }
    const double *inverse_mass = contacts->nodes.inverse_mass;
    uint32_t *used = contacts->colours, ends[COLOURS] = {0}, most = 0;
    for (uint32_t i = first; i < end; ++i) {
        const mspringi_candidate *c = &contacts->candidates[contacts->pending[i].candidate];
        used[c->p] = used[c->a] = used[c->b] = 0;
    }
    for (uint32_t i = first; i < end; ++i) {
        const mspringi_candidate *c = &contacts->candidates[contacts->pending[i].candidate];
        uint32_t number = 0;
        for (uint32_t all = used[c->p] | used[c->a] | used[c->b]; all & 1u && number + 1 < COLOURS; all >>= 1)
            ++number;
        used[c->p] |= inverse_mass[c->p] > 0.0 ? 1u << number : 0;
        used[c->a] |= inverse_mass[c->a] > 0.0 ? 1u << number : 0;
        used[c->b] |= inverse_mass[c->b] > 0.0 ? 1u << number : 0;
        contacts->pending[i].place = number;
        ++ends[number];
        most = number > most ? number : most;
    }
    for (uint32_t number = 1; number <= most; ++number)
        ends[number] += ends[number - 1];
    for (uint32_t i = end; i-- > first;)
        contacts->pending[i].place = contacts->constraint_count + first + --ends[contacts->pending[i].place];
}

static mspring_id point_of(const mspringi_contacts *contacts, uint32_t pending) {
    return contacts->list[contacts->candidates[contacts->pending[pending].candidate].pair].point;
}

// True if the points of a pending constraint and the one before it are next to each other on an outline. Only such
// runs are reordered: with all reordered, impulses spread so slowly that heaps of fragments crept for a minute
// instead of 20 s.
static bool is_beside_last(mspringi_contacts *contacts, uint32_t pending) {
    const mspringi_outline *o = &contacts->outline;
    const mspring_id last = point_of(contacts, pending - 1), point = point_of(contacts, pending);
    bool is_next = point == last;
    uint32_t j = o->first[last];
    for (; j < o->first[last + 1] && !is_next; ++j)
        is_next = o->a[o->at[j]] == point || o->b[o->at[j]] == point;
    mspringi_contact_count_visits(contacts, j - o->first[last]);
    return is_next;
}

// Give all pending constraints their places: run by run, by colour and then by id.
static void order_pending(mspringi_contacts *contacts) {
    uint32_t first = 0;
    for (uint32_t i = 1; i <= contacts->pending_count; ++i)
        if (i == contacts->pending_count || i - first == contacts->max_pending || !is_beside_last(contacts, i)) {
            order_run(contacts, first, i);
            first = i;
        }
}

/// A candidate that may touch within an interval, or nearly.
typedef struct close_candidate {
    uint32_t number;
    double square, speed, reach; ///< squared distance, m^2; speed of the ends, m/s; distance of constraints, m
    mspringi_closest_point at;
} close_candidate;

// Collect those of some candidates that may touch within h, or nearly, at their own speed or at `given`.
// Branch-free, since a processor cannot predict which of them may. (A heap of fragments: 0.96 of the step.)
static uint32_t find_close(const mspringi_contacts *contacts, const uint32_t *numbers, uint32_t count, double h,
                           double given, close_candidate *close) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    const double near_miss = MSPRINGI_NEAR_MISS_FRACTION * contacts->thickness;
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const mspringi_candidate *c = &contacts->candidates[numbers[i]];
        const mspringi_collider *collider =
            contacts->colliders.count > 0 ? collider_of_pair(contacts, &contacts->list[c->pair]) : NULL;
        const mspringi_closest_point at =
            mspringi_closest_point_on_edge(k->x[c->p], k->y[c->p], k->x[c->a], k->y[c->a], k->x[c->b], k->y[c->b]);
        const double square = at.x * at.x + at.y * at.y, speed = sqrt(max_square_speed(k, c->p, c->a, c->b)),
                     reach = contacts->thickness + (collider ? collider->radius : 0.0) +
                             2.0 * h * (speed > given ? speed : given),
                     miss = reach + near_miss;
        close[found] = (close_candidate){numbers[i], square, speed, reach, at};
        found += (square < miss * miss) & (square != 0.0);
    }
    return found;
}

// Queue the constraint of a close candidate, unless it is only near.
static void queue_constraint(const mspring_network *network, mspringi_contacts *contacts,
                             const close_candidate *close) {
    const mspringi_candidate *c = &contacts->candidates[close->number];
    const mspringi_closest_point at = close->at;
    if (!(close->square < close->reach * close->reach)) {
        contacts->near_misses[contacts->near_miss_count++] = close->number;
        return;
    }
    if (c->a != c->b && (at.fraction <= 0.0 || at.fraction >= 1.0) &&
        belongs_to_other_edge(network, contacts, &contacts->list[c->pair], at.fraction <= 0.0 ? 0 : 1))
        return;
    if (contacts->constraint_count + contacts->pending_count == contacts->constraint_capacity) {
        mspringi_contact_reject(contacts, MSPRINGI_CONTACT_LACKS_CONSTRAINTS);
        return;
    }
    const double inverse_mass = inverse_mass_of(&contacts->nodes, c, at.fraction);
    if (!(inverse_mass > 0.0))
        return;
    contacts->pending[contacts->pending_count++] =
        (mspringi_pending_constraint){.at = at, .inverse_mass = inverse_mass, .candidate = close->number};
    contacts->fastest = close->speed > contacts->fastest ? close->speed : contacts->fastest;
}

// Queue the constraints of a batch of candidates, in their order.
static void queue_batch(const mspring_network *network, mspringi_contacts *contacts, const uint32_t *numbers,
                        uint32_t count, double h, double given) {
    close_candidate close[FILTER_BATCH];
    const uint32_t found = find_close(contacts, numbers, count, h, given, close);
    for (uint32_t i = 0; i < found && !mspringi_contact_is_rejected(contacts); ++i)
        queue_constraint(network, contacts, &close[i]);
}

// True if two particles are too far apart for a constraint. No root: a way w is at most (L + w^2 / L) / 2 for any
// length L.
MSPRINGI_ALWAYS_INLINE bool are_far(const mspringi_contact_nodes *k, const mspringi_candidate *c, double still,
                                    double per_square) {
    const double dx = k->x[c->p] - k->x[c->a], dy = k->y[c->p] - k->y[c->a];
    const double most = still + per_square * square_of_speed(k, c->p, c->a);
    return (c->a == c->b) & (c->p < k->particle_count) & (c->a < k->particle_count) &
           (dx * dx + dy * dy > most * most);
}

static uint32_t filter_end(uint32_t first, uint32_t end) {
    return end - first < FILTER_BATCH ? end : first + FILTER_BATCH;
}

// Collect the candidates of a batch that may need a constraint. Branch-free, since most need none.
static uint32_t filter_candidates(const mspringi_contacts *contacts, uint32_t first, uint32_t end, double h,
                                  double given, uint32_t *kept) {
    const double length = 2.0 * FILTER_MARGIN * contacts->thickness, per_square = 2.0 * h * h / length;
    const double still =
        (1.0 + MSPRINGI_NEAR_MISS_FRACTION + FILTER_MARGIN) * contacts->thickness + 2.0 * h * given;
    uint32_t count = 0;
    for (uint32_t i = first; i < end; ++i) {
        kept[count] = i;
        count += !are_far(&contacts->nodes, &contacts->candidates[i], still, per_square);
    }
    return count;
}

static bool is_any_fast(const mspringi_contacts *contacts, uint32_t p, uint32_t a, uint32_t b) {
    const uint8_t *is_fast = contacts->nodes.is_fast;
    return is_fast[p] | is_fast[a] | is_fast[b];
}

// Collect the candidates of a batch that have a fast node and no constraint yet.
static uint32_t filter_fast(const mspringi_contacts *contacts, uint32_t first, uint32_t end, uint32_t *kept) {
    uint32_t count = 0;
    for (uint32_t i = first; i < end; ++i) {
        const mspringi_candidate *c = &contacts->candidates[i];
        kept[count] = i;
        count += is_any_fast(contacts, c->p, c->a, c->b) & !contacts->is_seen[i];
    }
    return count;
}

/// Which candidates to queue: of all, or only fast ones without a constraint.
typedef struct queueing {
    double h, given;
    bool only_fast;
} queueing;

// Room of a range for pending constraints.
static uint32_t room_of(const mspringi_contacts *contacts, const mspringi_contact_range *range) {
    return (contacts->constraint_capacity - contacts->constraint_count - contacts->pending_count) / range->of;
}

static void queue_range(const mspring_network *network, mspringi_contacts *contacts, mspringi_contact_range *range,
                        const void *argument) {
    const queueing *q = argument;
    if (range->of > 1) {
        const uint32_t room = room_of(contacts, range);
        contacts->pending += contacts->pending_count + range->number * room;
        contacts->near_misses += contacts->near_miss_count + range->first;
        contacts->constraint_capacity = room;
        contacts->constraint_count = contacts->pending_count = contacts->near_miss_count = 0;
    }
    for (uint32_t first = range->first, end; first < range->end && !mspringi_contact_is_rejected(contacts);
         first = end) {
        uint32_t kept[FILTER_BATCH];
        end = filter_end(first, range->end);
        const uint32_t count = q->only_fast ? filter_fast(contacts, first, end, kept)
                                            : filter_candidates(contacts, first, end, q->h, q->given, kept);
        queue_batch(network, contacts, kept, count, q->h, q->given);
    }
    range->found = contacts->pending_count;
    range->missed = contacts->near_miss_count;
}

// Queue constraints of candidates, in their order.
static void queue_constraints(const mspring_network *network, mspringi_contacts *contacts, const queueing *q) {
    mspringi_contact_range ranges[MSPRINGI_CONTACT_RANGES];
    mspringi_pending_constraint *pending = contacts->pending + contacts->pending_count;
    uint32_t *near_misses = contacts->near_misses + contacts->near_miss_count;
    const bool has_room = contacts->near_miss_count + contacts->candidate_count <= contacts->capacity;
    const uint32_t count = mspringi_contact_divide(network, contacts, contacts->candidate_count,
                                                   has_room ? LEAST_CANDIDATES : UINT32_MAX,
                                                   contacts->constraint_capacity, queue_range, q, ranges);
    const uint32_t room = room_of(contacts, &ranges[0]);
    for (uint32_t i = 0; i < count && count > 1; ++i) {
        const mspringi_contact_range *range = &ranges[i];
        memmove(contacts->pending + contacts->pending_count, pending + i * room, range->found * sizeof *pending);
        memmove(contacts->near_misses + contacts->near_miss_count, near_misses + range->first,
                range->missed * sizeof *near_misses);
        contacts->pending_count += range->found;
        contacts->near_miss_count += range->missed;
    }
}

// Make the pending constraints. If the step will be rejected, drop them all.
static void make_pending(const mspring_network *network, mspringi_contacts *contacts, double h) {
    mspringi_contact_range ranges[MSPRINGI_CONTACT_RANGES];
    order_pending(contacts);
    if (mspringi_contact_is_rejected(contacts)) {
        contacts->candidate_count = contacts->constraint_count = contacts->near_miss_count = 0;
        return;
    }
    (void)mspringi_contact_divide(network, contacts, contacts->pending_count, LEAST_PENDING, UINT32_MAX, make_range,
                                  &h, ranges);
    contacts->constraint_count += contacts->pending_count;
    MSPRINGI_ASSERT(contacts->constraint_count <= contacts->constraint_capacity);
}

double mspringi_contact_make_constraints(const mspring_network *network, mspringi_contacts *contacts, double h,
                                         double given, uint32_t pending) {
    contacts->fastest = 0.0;
    contacts->max_pending = pending;
    contacts->has_push = false;
    contacts->constraint_count = contacts->pending_count = contacts->near_miss_count = 0;
    queue_constraints(network, contacts, &(queueing){h, given, false});
    make_pending(network, contacts, h);
    return contacts->fastest;
}

double mspringi_contact_prepare_implicit(const mspring_network *network, mspringi_contacts *contacts, double h) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    contacts->share = h / (double)contacts->h;
    contacts->kept_push = DBL_MAX;
    contacts->fall_x = h * (double)network->settings.gravity_x;
    contacts->fall_y = h * (double)network->settings.gravity_y;
    memcpy(k->v, k->v_start, k->particle_count * sizeof *k->v);
    // The first pass finds the largest speed, the second takes all pairs that may touch at it, or a little faster.
    const double fastest = mspringi_contact_make_constraints(network, contacts, h, 0.0, 1);
    (void)mspringi_contact_make_constraints(network, contacts, h,
                                            fastest + EXTRA_APPROACH * contacts->thickness / h, 1);
    return fastest;
}

/* ------------------------------------------------------------------------------------- added after the sweeps */

bool mspringi_contact_add_constraints(const mspring_network *network, mspringi_contacts *contacts, double h,
                                      bool has_fast, double kept) {
    const uint32_t before = contacts->constraint_count, near_miss_count = contacts->near_miss_count;
    memset(contacts->is_seen, 0, contacts->candidate_count);
    for (uint32_t i = 0; i < before; ++i)
        contacts->is_seen[contacts->constraints[i].candidate] = 1;
    contacts->near_miss_count = contacts->pending_count = 0;
    for (uint32_t first = 0, end; first < near_miss_count; first = end) {
        uint32_t batch[FILTER_BATCH];
        end = filter_end(first, near_miss_count);
        memcpy(batch, contacts->near_misses + first, (end - first) * sizeof *batch);
        for (uint32_t i = 0; i < end - first; ++i)
            contacts->is_seen[batch[i]] = 1;
        queue_batch(network, contacts, batch, end - first, h, 0.0);
    }
    if (has_fast)
        queue_constraints(network, contacts, &(queueing){h, 0.0, true});
    make_pending(network, contacts, h);
    for (uint32_t i = before; i < contacts->constraint_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        if (t->gap + h * mspringi_normal_speed(t, contacts->nodes.v) < (t->collider == MSPRING_NONE ? -kept : 0.0))
            return true;
    }
    return false;
}

bool mspringi_contact_moves_are_short(const mspringi_contacts *contacts, double h) {
    const double most = MAX_MOVE * contacts->thickness / h;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        if (is_any_fast(contacts, t->p, t->a, t->b) &&
            max_square_speed(&contacts->nodes, t->p, t->a, t->b) > most * most)
            return false;
    }
    return true;
}
