/// Inner particles against colliders. Where a soft body is pressed flat against a wall, an inner particle would
/// pass between two points of the outline, and then the wall. So inner particles that may reach a collider keep the
/// thickness from it, too.
///
/// They are found from spring to spring, at the start of each step: behind outline points that may touch a
/// collider, as long as these particles are near it themselves (go_inward()); and throughout the part of a body
/// that is strained as triangles are that turn inside out, since inner particles may have left its outline
/// (find_strained()). Where points move far in a step, particles behind the outline are sought at each scan. In
/// 5,000 landings of lattices at 5 to 40 m/s, inner particles passed in 1,267 without this, in 3 to 9 of 1,000 with
/// either half of it.
///
/// Particles that are found are watched until the step ends. Their pairs follow from positions and velocities of
/// the scan, lie at the end of the list of pairs, and are candidates all.
#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "features/contact/contacts.h"
#include "store/id_pool.h"
#include "store/springs.h"

/// A particle behind the outline is watched if it is nearer to a collider than this, beside the reach of a
/// candidate, in thicknesses.
#define BESIDE 1.0

/// Longest way of a point in a step up to which particles behind the outline are sought once a step, in
/// thicknesses.
#define SHORT_WAY 0.5

/// Squares of a strained spring's length over that in the shape. A triangle that turns inside out has at some time
/// a spring that is strained by 0.17 or more.
#define SHORT_SQUARE (0.9 * 0.9)
#define LONG_SQUARE (1.1 * 1.1)

// Way of a node until the next scan, m.
static double way_of(const mspringi_contacts *contacts, double speed) {
    return mspringi_bound_at(&contacts->candidate_margin, speed);
}

static double speed_of_edge(const mspringi_contacts *contacts, uint32_t edge) {
    return contacts->is_uniform ? contacts->max_speed
                                : mspringi_max_of_ends(contacts, contacts->assumed_speed, edge);
}

// Distance of a particle from a collider's side beyond the reach of a candidate, m; negative: it is one.
static double beyond_reach(const mspringi_contacts *contacts, mspring_id p, uint32_t edge, double *distance) {
    const mspring_id a = contacts->outline.a[edge], b = contacts->outline.b[edge];
    const mspringi_closest_point at = mspringi_closest_point_on_edge(
        contacts->x[p], contacts->y[p], contacts->x[a], contacts->y[a], contacts->x[b], contacts->y[b]);
    *distance = sqrt(at.x * at.x + at.y * at.y) - mspringi_collider_of(contacts, a)->radius;
    return *distance - contacts->thickness - way_of(contacts, contacts->assumed_speed[p]) -
           way_of(contacts, speed_of_edge(contacts, edge));
}

// Find position and speed of an inner particle.
static void load(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    const mspringi_state *s = &network->state;
    const uint32_t slot = network->topology.slot_of_particle[p];
    const double ux = (double)s->vx[slot] - contacts->mean_vx, uy = (double)s->vy[slot] - contacts->mean_vy,
                 speed = sqrt(ux * ux + uy * uy);
    contacts->x[p] = mspringi_x_of(s, slot);
    contacts->y[p] = mspringi_y_of(s, slot);
    contacts->assumed_speed[p] = speed <= contacts->min_speed ? contacts->min_speed : speed;
}

// A pair in the order in which they are found: from the end of the list.
static mspringi_pair *pair_at(const mspringi_contacts *contacts, uint32_t i) {
    return &contacts->list[contacts->capacity - 1 - i];
}

// No pair of the particle can touch within the quiet substeps.
static void shorten_quiet(mspringi_contacts *contacts, mspring_id p, uint32_t edge, double distance) {
    const double way = 2.0 * contacts->travel.at_rest +
                       contacts->travel.per_speed * (contacts->assumed_speed[p] + speed_of_edge(contacts, edge)),
                 gap = distance - contacts->thickness;
    if (!(gap >= (double)contacts->quiet_at_scan * way))
        contacts->quiet_at_scan = gap >= 2.0 * way ? (uint32_t)(gap / way) : 0;
}

// Add the pairs of a watched particle with colliders.
static void add_pairs(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    contacts->margin[p] = way_of(contacts, contacts->assumed_speed[p]);
    const uint32_t found = mspringi_edge_grid_search(network, contacts, p);
    contacts->work += found;
    for (uint32_t k = 0; k < found; ++k) {
        const uint32_t edge = contacts->grid.found[k];
        const mspring_id a = contacts->outline.a[edge];
        double distance;
        if (!mspringi_is_collider_point(contacts, a) || beyond_reach(contacts, p, edge, &distance) > 0.0 ||
            !mspringi_may_touch(network, p, a))
            continue;
        if (contacts->count + contacts->inner.pair_count == contacts->capacity) {
            mspringi_contact_reject(contacts, MSPRINGI_CONTACT_LACKS_PAIRS);
            return;
        }
        *pair_at(contacts, contacts->inner.pair_count++) = (mspringi_pair){.point = p, .edge = edge};
        shorten_quiet(contacts, p, edge, distance);
    }
}

// Begin a visit to all particles, none of which is marked.
static void begin_visit(mspringi_contacts *contacts) {
    if (++contacts->inner.visit > 0)
        return;
    memset(contacts->inner.visited, 0,
           contacts->particles * sizeof *contacts->inner.visited); // marks of 2^32 visits ago
    contacts->inner.visit = 1;
}

static bool is_visited(const mspringi_contacts *contacts, mspring_id p) {
    return contacts->inner.visited[p] == contacts->inner.visit;
}

static void watch(mspringi_contacts *contacts, mspring_id p) {
    contacts->inner.visited[p] = contacts->inner.visit;
    MSPRINGI_ASSERT(contacts->inner.watched_count < contacts->particles);
    contacts->inner.watched[contacts->inner.watched_count++] = p;
}

// Return the next inner particle at a spring of p that is not marked, and load it; MSPRING_NONE at the end.
static mspring_id next_inner(const mspring_network *network, mspringi_contacts *contacts,
                             mspringi_incident_springs *around, mspring_id p) {
    const mspringi_outline *o = &contacts->outline;
    mspring_id spring;
    while ((spring = mspringi_incident_springs_next(network, around)) != MSPRING_NONE) {
        const mspring_id q = mspringi_end_beyond(network, spring, p);
        if (o->first[q] != o->first[q + 1] || is_visited(contacts, q) || !mspringi_spring_is_live(network, spring))
            continue;
        load(network, contacts, q);
        return q;
    }
    return MSPRING_NONE;
}

/* ------------------------------------------------------------------------------------------- behind the outline */

// Watch the inner particles next to one that is near a collider's side.
static void go_inward(const mspring_network *network, mspringi_contacts *contacts, mspring_id p, uint32_t edge) {
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
    mspring_id q;
    mspringi_contact_count_visits(contacts, around.end - around.next);
    while ((q = next_inner(network, contacts, &around, p)) != MSPRING_NONE) {
        double distance;
        if (beyond_reach(contacts, q, edge, &distance) > BESIDE * contacts->thickness)
            continue;
        watch(contacts, q);
        add_pairs(network, contacts, q);
    }
}

// Begin at a candidate.
static void begin_at(const mspring_network *network, mspringi_contacts *contacts, const mspringi_pair *pair) {
    const mspringi_outline *o = &contacts->outline;
    const mspring_id p = pair->point, ends[2] = {o->a[pair->edge], o->b[pair->edge]};
    if (mspringi_is_collider_point(contacts, ends[0]))
        go_inward(network, contacts, p, pair->edge);
    for (uint32_t j = o->first[p]; mspringi_is_collider_point(contacts, p) && j < o->first[p + 1]; ++j)
        for (int i = 0; i < 2; ++i)
            go_inward(network, contacts, ends[i], o->at[j]);
}

static void find_behind(const mspring_network *network, mspringi_contacts *contacts) {
    for (uint32_t i = 0; i < contacts->candidate_count && !mspringi_contact_is_rejected(contacts); ++i)
        begin_at(network, contacts, &contacts->list[contacts->candidates[i].pair]);
    for (uint32_t i = 0; i < contacts->inner.pair_count && !mspringi_contact_is_rejected(contacts); ++i)
        go_inward(network, contacts, pair_at(contacts, i)->point, pair_at(contacts, i)->edge);
}

/* ---------------------------------------------------------------------------------------------- strained bodies */

static bool is_strained(const mspringi_contacts *contacts, mspring_id a, mspring_id b) {
    const mspringi_outline *o = &contacts->outline;
    const double x = contacts->x[b] - contacts->x[a], y = contacts->y[b] - contacts->y[a],
                 u = o->shape_x[b] - o->shape_x[a], v = o->shape_y[b] - o->shape_y[a];
    const double now = x * x + y * y, was = u * u + v * v;
    return now < SHORT_SQUARE * was || now > LONG_SQUARE * was;
}

// Watch the inner particles at strained springs of a particle.
static void follow_strained(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
    mspring_id q;
    mspringi_contact_count_visits(contacts, around.end - around.next);
    while ((q = next_inner(network, contacts, &around, p)) != MSPRING_NONE)
        if (is_strained(contacts, p, q))
            watch(contacts, q);
}

// True if a particle may touch a collider before the step ends.
static bool may_reach_collider(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    contacts->margin[p] = MSPRINGI_DRIFT_FRACTION * contacts->thickness +
                          MSPRINGI_SPEED_MARGIN * contacts->dt * (contacts->assumed_speed[p] + contacts->max_speed);
    const uint32_t found = mspringi_edge_grid_search(network, contacts, p);
    contacts->work += found;
    for (uint32_t k = 0; k < found; ++k)
        if (mspringi_is_collider_point(contacts, contacts->outline.a[contacts->grid.found[k]]))
            return true;
    return false;
}

// Watch inner particles in strained parts of bodies, beginning at strained edges of the outline.
static void find_strained(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    const uint32_t edges = o->edge_count - contacts->colliders.listed_sides;
    uint32_t count = 0;
    begin_visit(contacts);
    contacts->inner.watched_count = 0;
    for (uint32_t e = 0; e < edges; ++e) {
        if (!is_strained(contacts, o->a[e], o->b[e]))
            continue;
        follow_strained(network, contacts, o->a[e]);
        follow_strained(network, contacts, o->b[e]);
    }
    for (uint32_t i = 0; i < contacts->inner.watched_count; ++i)
        follow_strained(network, contacts, contacts->inner.watched[i]);
    for (uint32_t i = 0; i < contacts->inner.watched_count; ++i) {
        contacts->inner.watched[count] = contacts->inner.watched[i];
        count += may_reach_collider(network, contacts, contacts->inner.watched[i]);
    }
    contacts->inner.watched_count = count;
}

/* -------------------------------------------------------------------------------------------------------- pairs */

static bool is_before(const mspringi_pair *one, const mspringi_pair *other) {
    return one->point != other->point ? one->point < other->point : one->edge < other->edge;
}

// Sort the pairs by point and edge (Shell sort): the order of springs at a particle depends on its past.
static void sort_pairs(const mspringi_contacts *contacts) {
    mspringi_pair *pairs = contacts->list + (contacts->capacity - contacts->inner.pair_count);
    uint32_t gap = 1;
    while (gap < contacts->inner.pair_count / 3)
        gap = 3 * gap + 1;
    for (; gap > 0; gap /= 3)
        for (uint32_t i = gap; i < contacts->inner.pair_count; ++i) {
            const mspringi_pair moved = pairs[i];
            uint32_t at = i;
            for (; at >= gap && is_before(&moved, &pairs[at - gap]); at -= gap)
                pairs[at] = pairs[at - gap];
            pairs[at] = moved;
        }
}

// Add the pairs of particles that are watched.
static void add_watched(const mspring_network *network, mspringi_contacts *contacts) {
    begin_visit(contacts);
    for (uint32_t i = 0; i < contacts->inner.watched_count && !mspringi_contact_is_rejected(contacts); ++i) {
        const mspring_id p = contacts->inner.watched[i];
        contacts->inner.visited[p] = contacts->inner.visit;
        load(network, contacts, p);
        add_pairs(network, contacts, p);
    }
    // Pairs that are no candidates may touch after the next scan.
    if (contacts->inner.watched_count > 0 && (double)contacts->quiet_at_scan > contacts->candidate_substeps)
        contacts->quiet_at_scan = (uint32_t)contacts->candidate_substeps;
}

void mspringi_inner_points_add(const mspring_network *network, mspringi_contacts *contacts) {
    contacts->inner.pair_count = 0;
    if (contacts->colliders.count == 0)
        return;
    const bool begins = contacts->substeps_done == 0 || contacts->substeps_done >= contacts->colliders.substeps,
               is_fast =
                   !(MSPRINGI_SPEED_MARGIN * contacts->dt * contacts->max_speed <= SHORT_WAY * contacts->thickness);
    if (begins)
        find_strained(network, contacts);
    add_watched(network, contacts); // marks what find_behind() must not find again
    if (begins || is_fast)
        find_behind(network, contacts);
    sort_pairs(contacts);
    for (uint32_t i = 0; i < contacts->inner.pair_count && !mspringi_contact_is_rejected(contacts); ++i)
        contacts->candidates[contacts->candidate_count++].pair =
            contacts->capacity - contacts->inner.pair_count + i;
}
