/// Outline: live springs with a free side, and its update after edits.
///
/// A live spring is inside if a triangle of live springs lies on each side of it; all others are edges. That is
/// right for holes, concave corners, ropes and trusses alike. Sides are those of the shape that the network had
/// when contact was set, so an outline follows from that shape and from the live springs, whatever has happened
/// since. A break changes no more than the springs at its two ends.
#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "base/union_find.h"
#include "features/contact/contacts.h"
#include "store/id_pool.h"
#include "store/springs.h"

/// A triangle counts on neither side if its height is below this share of the spring's length.
#define THIN 1e-4

void mspringi_outline_ends(const mspring_network *network, mspring_id spring, mspring_id ends[2]) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, spring), &base, &tip);
    const mspring_id a = t->particle_of_slot[base], b = t->particle_of_slot[tip];
    ends[0] = a < b ? a : b; // the base depends on the layout
    ends[1] = a < b ? b : a;
}

// Return the next live spring at a particle, and set its other end; MSPRING_NONE at the end.
static mspring_id next_live(const mspring_network *network, mspringi_incident_springs *around, mspring_id p,
                            mspring_id *other) {
    mspring_id spring;
    while ((spring = mspringi_incident_springs_next(network, around)) != MSPRING_NONE) {
        if (!mspringi_spring_is_live(network, spring))
            continue;
        *other = mspringi_end_beyond(network, spring, p);
        return spring;
    }
    return MSPRING_NONE;
}

static uint32_t springs_laid_at(const mspring_network *network, mspring_id p) {
    return network->incidence.first[p + 1] - network->incidence.first[p];
}

/// Springs at the neighbours of a particle up to which all particles that two springs join to it are stamped.
#define FEW_BEYOND 256u

/// Stamps of particles, for the particle that they are compared with.
enum { ONE_SPRING = 1, TWO_SPRINGS = 2, FARTHER = 3, STAMPS = 3 };

static uint32_t stamp_for(mspring_id p, uint32_t kind) {
    return STAMPS * p + kind;
}

// Stamp the neighbours of a particle. Return the number of springs at these.
static uint64_t stamp_neighbours(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
    mspring_id next;
    uint64_t beyond = 0;
    contacts->stamp_of = p;
    while (next_live(network, &around, p, &next) != MSPRING_NONE) {
        contacts->stamp[next] = stamp_for(p, ONE_SPRING);
        beyond += springs_laid_at(network, next);
    }
    contacts->stamp[p] = stamp_for(p, ONE_SPRING);
    return beyond;
}

static void stamp(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    contacts->are_all_stamped = stamp_neighbours(network, contacts, p) <= FEW_BEYOND;
    if (!contacts->are_all_stamped)
        return;
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
    mspring_id next, after;
    while (next_live(network, &around, p, &next) != MSPRING_NONE) {
        mspringi_incident_springs beyond = mspringi_incident_springs_begin(network, next);
        while (next_live(network, &beyond, next, &after) != MSPRING_NONE)
            if (contacts->stamp[after] != stamp_for(p, ONE_SPRING))
                contacts->stamp[after] = stamp_for(p, TWO_SPRINGS);
    }
}

bool mspringi_outline_are_neighbours(const mspring_network *network, mspringi_contacts *contacts, mspring_id p,
                                     mspring_id q) {
    if (contacts->stamp_of != p)
        stamp(network, contacts, p);
    const uint32_t found = contacts->stamp[q];
    if (found == stamp_for(p, ONE_SPRING) || found == stamp_for(p, TWO_SPRINGS))
        return true;
    if (contacts->are_all_stamped || found == stamp_for(p, FARTHER))
        return false;
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, q);
    mspring_id other;
    contacts->stamp[q] = stamp_for(p, FARTHER);
    while (next_live(network, &around, q, &other) != MSPRING_NONE)
        if (contacts->stamp[other] == stamp_for(p, ONE_SPRING)) {
            contacts->stamp[q] = stamp_for(p, TWO_SPRINGS);
            return true;
        }
    return false;
}

/* ------------------------------------------------------------------------------------------------------- edges */

/// Live springs at a particle, and their other ends.
typedef struct star {
    mspring_id *ends, *springs;
    uint32_t count;
} star;

/// Edges that are being judged: all, or those at particles whose springs have changed. Lists lie in the edges of
/// the grid, and in the outline's `first` and `points`, all of which are filled afterwards.
typedef struct judging {
    const mspring_network *network;
    mspringi_contacts *contacts;
    uint32_t *first;                  ///< [particles + 1] of each one's star in lists; flags, unless all are judged
    mspring_id *ends[2], *springs[2]; ///< lists; unless all are judged, for two stars
    bool is_whole;
} judging;

enum { CHANGED = 1, BESIDE = 2 };

/// Of long lists, tries go on by this share of their length: neighbours of all directions then come early, whatever
/// the order of ids is. In a clique on a circle of n particles they take n^2 log n tries, one after the other n^3.
#define STRIDE 0.618
#define LONG_STAR 16u

/// If one spring in WHOLE_SHARE may have changed, judge all: judged alone, each lists the springs at an end, in a
/// clique n^3 in all. (A particle detached from a clique of 600: 1.8 s without, 0.05 s with it.)
#define WHOLE_SHARE 4u

static star list_star(const mspring_network *network, mspring_id p, mspring_id *ends, mspring_id *springs) {
    star found = {ends, springs, 0};
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
    mspring_id spring, other;
    while ((spring = next_live(network, &around, p, &other)) != MSPRING_NONE) {
        ends[found.count] = other;
        springs[found.count++] = spring;
    }
    return found;
}

static star star_of(const judging *j, mspring_id p, int list) {
    const uint32_t first = j->first[p];
    if (j->is_whole)
        return (star){j->ends[0] + first, j->springs[0] + first, j->first[p + 1] - first};
    const star listed = list_star(j->network, p, j->ends[list], j->springs[list]);
    j->contacts->outline.tries += listed.count;
    return listed;
}

// The next number from a step on that has no divisor in common with a count.
static uint32_t stride_through(uint32_t count) {
    if (count <= LONG_STAR)
        return 1;
    for (uint32_t stride = (uint32_t)(STRIDE * count);; ++stride) {
        uint32_t a = count, b = stride;
        while (b > 0) {
            const uint32_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1)
            return stride;
    }
}

// True if triangles lie on both sides of the spring from a to b. `stamped` is the end whose neighbours carry
// stamps, `others` the star of the other end.
static bool is_inside(const judging *j, mspring_id a, mspring_id b, mspring_id stamped, const star *others) {
    mspringi_outline *o = &j->contacts->outline;
    const double ex = o->shape_x[b] - o->shape_x[a], ey = o->shape_y[b] - o->shape_y[a];
    const double thin = THIN * (ex * ex + ey * ey);
    const uint32_t *stamps = j->contacts->stamp, stamp = stamp_for(stamped, ONE_SPRING);
    const uint32_t count = others->count, stride = stride_through(count);
    bool left = false, right = false;
    uint32_t tries = 0;
    for (uint32_t i = 0; tries < count && !(left && right); ++tries) {
        const mspring_id other = others->ends[i];
        i += i < count - stride ? stride : stride - count;
        if (other == b || stamps[other] != stamp)
            continue;
        const double side = ex * (o->shape_y[other] - o->shape_y[a]) - ey * (o->shape_x[other] - o->shape_x[a]);
        left |= side > thin;
        right |= side < -thin;
    }
    o->tries += tries;
    return left && right;
}

// True if another live spring that joins the same particles stands for both.
static bool lies_beside(const star *of, mspring_id end, mspring_id spring) {
    for (uint32_t i = 0; i < of->count; ++i)
        if (of->ends[i] == end && of->springs[i] < spring)
            return true;
    return false;
}

// Judge the springs at p whose other end has fewer springs, or as many and the lower id. After edits, only those
// with a changed end.
static void judge_at(const judging *j, mspring_id p) {
    mspringi_outline *o = &j->contacts->outline;
    const star own = star_of(j, p, 0);
    for (uint32_t i = 0; i < own.count; ++i)
        j->contacts->stamp[own.ends[i]] = stamp_for(p, ONE_SPRING);
    for (uint32_t i = 0; i < own.count; ++i) {
        const mspring_id spring = own.springs[i], other = own.ends[i];
        mspring_id ends[2];
        mspringi_outline_ends(j->network, spring, ends);
        const bool is_fewer = springs_laid_at(j->network, ends[0]) <= springs_laid_at(j->network, ends[1]);
        const mspring_id a = is_fewer ? ends[0] : ends[1], b = is_fewer ? ends[1] : ends[0];
        if (b != p || (!j->is_whole && !((j->first[p] | j->first[other]) & CHANGED)))
            continue;
        const star others = star_of(j, other, 1);
        const bool is_second = j->network->topology.parallel_count > 0 && lies_beside(&others, p, spring);
        o->is_edge[spring] = !is_second && !is_inside(j, a, b, p, &others);
    }
}

static judging begin_judging(const mspring_network *network, mspringi_contacts *contacts, bool is_whole) {
    const size_t edges = contacts->edge_capacity;
    mspring_id *lists = (void *)contacts->grid.edges;
    return (judging){.network = network,
                     .contacts = contacts,
                     .first = contacts->outline.first,
                     .ends = {lists, lists + 2 * edges},
                     .springs = {lists + (is_whole ? 2 * edges : edges), lists + 3 * edges},
                     .is_whole = is_whole};
}

static void judge_all(const mspring_network *network, mspringi_contacts *contacts) {
    const judging j = begin_judging(network, contacts, true);
    const uint32_t particles = network->topology.particle_count;
    mspringi_outline *o = &contacts->outline;
    uint32_t end = 0;
    for (mspring_id p = 0; p < particles; ++p) {
        j.first[p] = end;
        if (mspringi_particle_exists(network, p))
            end += list_star(network, p, j.ends[0] + end, j.springs[0] + end).count;
    }
    j.first[particles] = end;
    memset(o->is_edge, 0, network->topology.spring_count * sizeof *o->is_edge);
    for (mspring_id p = 0; p < particles && o->tries <= o->most_tries; ++p)
        judge_at(&j, p);
}

// Flag a particle with a reason, and list it if it had no flag. Return the new count.
static uint32_t take_up(const judging *j, mspring_id p, uint32_t why, uint32_t count) {
    if (j->first[p] == 0)
        j->contacts->outline.points[count++] = p;
    j->first[p] |= why;
    return count;
}

// Judge the springs that may have been in a triangle with one that broke, or was restored.
static void judge_changed(const mspring_network *network, mspringi_contacts *contacts) {
    const judging j = begin_judging(network, contacts, false);
    mspringi_outline *o = &contacts->outline;
    mspring_id ends[2];
    uint32_t count = 0;
    memset(o->first, 0, network->topology.particle_count * sizeof *o->first);
    for (uint64_t n = o->links; n < network->edits.links; ++n) {
        const mspring_id spring = mspringi_edits_link(&network->edits, n);
        o->is_edge[spring] = 0;
        mspringi_outline_ends(network, spring, ends);
        for (int i = 0; i < 2; ++i)
            count = take_up(&j, ends[i], CHANGED, count);
    }
    const uint32_t changed = count;
    uint64_t judged = 0;
    for (uint32_t i = 0; i < changed; ++i) {
        const star beside = star_of(&j, o->points[i], 0);
        judged += beside.count;
        for (uint32_t k = 0; k < beside.count; ++k)
            count = take_up(&j, beside.ends[k], BESIDE, count);
    }
    if (judged > network->topology.spring_count / WHOLE_SHARE) {
        judge_all(network, contacts);
        return;
    }
    for (uint32_t i = 0; i < count; ++i)
        judge_at(&j, o->points[i]);
}

/* ------------------------------------------------------------------------------------------------------- shape */

void mspringi_outline_clear_slot(const mspring_network *network, uint32_t slot) {
    const mspring_id p = network->topology.particle_of_slot[slot];
    if (p != MSPRING_NONE)
        network->contacts->outline.is_known[p] = 0;
}

void mspringi_outline_take_in(const mspring_network *network, mspringi_outline *o, mspring_id p) {
    const uint32_t slot = network->topology.slot_of_particle[p];
    o->shape_x[p] = mspringi_x_of(&network->state, slot) + (network->origin_x - o->origin_x);
    o->shape_y[p] = mspringi_y_of(&network->state, slot) + (network->origin_y - o->origin_y);
    o->is_known[p] = 1;
}

static void take_in_all(const mspring_network *network, mspringi_outline *o) {
    for (mspring_id p = 0; p < network->topology.particle_count; ++p)
        if (!o->is_known[p] && mspringi_particle_exists(network, p))
            mspringi_outline_take_in(network, o, p);
}

/* ------------------------------------------------------------------------------------------------------- lists */

static void list_edge(mspringi_outline *o, mspring_id a, mspring_id b) {
    o->a[o->edge_count] = a;
    o->b[o->edge_count++] = b;
    o->first[a]++;
    o->first[b] += a != b;
}

// A collider of one point has an edge of length 0.
static void list_sides(mspringi_contacts *contacts) {
    mspringi_outline *o = &contacts->outline;
    const uint32_t before = o->edge_count;
    for (uint32_t i = 0; i < contacts->colliders.count; ++i) {
        const mspringi_collider *c = &contacts->colliders.list[i];
        const mspring_id first = contacts->particles + c->first;
        for (uint32_t k = 0; k < c->sides; ++k)
            list_edge(o, first + k, first + (k + 1) % c->count);
        for (uint32_t k = 0; k < c->count; ++k)
            o->body[first + k] = first + k;
    }
    contacts->colliders.listed_points = contacts->colliders.point_count;
    contacts->colliders.listed_sides = o->edge_count - before;
}

static void list_edges(const mspring_network *network, mspringi_outline *o, uint32_t nodes) {
    const mspringi_topology *t = &network->topology;
    mspring_id ends[2], other;
    o->edge_count = 0;
    memset(o->first, 0, ((size_t)nodes + 1) * sizeof *o->first);
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        if (!o->is_edge[s])
            continue;
        mspringi_outline_ends(network, s, ends);
        list_edge(o, ends[0], ends[1]);
    }
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        if (o->first[p] > 0 || !mspringi_particle_exists(network, p))
            continue;
        mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
        if (next_live(network, &around, p, &other) == MSPRING_NONE)
            list_edge(o, p, p);
    }
}

static void list_points(mspringi_outline *o, uint32_t nodes) {
    uint32_t end = 0;
    o->point_count = 0;
    for (mspring_id p = 0; p < nodes; ++p) {
        if (o->first[p] > 0)
            o->points[o->point_count++] = p;
        o->first[p] = end += o->first[p];
    }
    o->first[nodes] = end;
    MSPRINGI_ASSERT(o->point_count <= nodes && end <= 2 * o->edge_count);
    for (uint32_t e = o->edge_count; e-- > 0;) {
        o->at[--o->first[o->a[e]]] = e;
        if (o->b[e] != o->a[e])
            o->at[--o->first[o->b[e]]] = e;
    }
}

static void find_bodies(const mspring_network *network, uint32_t *body) {
    const mspringi_topology *t = &network->topology;
    mspring_id ends[2];
    for (mspring_id p = 0; p < t->particle_count; ++p)
        body[p] = p;
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        if (!mspringi_spring_exists(network, s) || !mspringi_spring_is_live(network, s))
            continue;
        mspringi_outline_ends(network, s, ends);
        mspringi_union_find_join(body, ends[0], ends[1]);
    }
    for (mspring_id p = 0; p < t->particle_count; ++p)
        body[p] = mspringi_union_find_root(body, p);
}

// Update the edges after edits of springs.
static void update_edges(const mspring_network *network, mspringi_contacts *contacts) {
    mspringi_outline *o = &contacts->outline;
    const mspringi_edits *edits = &network->edits;
    const bool is_local = o->is_found && o->growth == edits->growth && mspringi_edits_have_link(edits, o->links);
    o->tries = 0;
    if (is_local) {
        judge_changed(network, contacts);
        return;
    }
    take_in_all(network, o);
    judge_all(network, contacts);
}

// Update the bodies, if anything needs them: contact without self-contact, or events.
static void update_bodies(const mspring_network *network, mspringi_contacts *contacts) {
    if (contacts->outline.are_bodies_found || (contacts->touches_itself && contacts->events.capacity == 0))
        return;
    find_bodies(network, contacts->outline.body);
    contacts->outline.are_bodies_found = true;
}

void mspringi_outline_update(const mspring_network *network, mspringi_contacts *contacts) {
    mspringi_outline *o = &contacts->outline;
    const mspringi_edits *edits = &network->edits;
    const uint32_t nodes = contacts->particles + contacts->colliders.point_count;
    if (o->is_found && o->links == edits->links && o->growth == edits->growth && !contacts->colliders.are_new) {
        update_bodies(network, contacts);
        return;
    }
    mspringi_contact_clear_stamps(contacts);
    update_edges(network, contacts);
    list_edges(network, o, nodes);
    list_sides(contacts);
    list_points(o, nodes);
    o->are_bodies_found = false;
    contacts->stamp_of = MSPRING_NONE;
    o->is_found = true;
    o->links = edits->links;
    o->growth = edits->growth;
    memset(contacts->excluded_edges, 0xff,
           MSPRINGI_EXCLUDED_EDGES * (size_t)contacts->particles * sizeof *contacts->excluded_edges);
    contacts->colliders.are_new = false;
    contacts->is_listed = contacts->is_fresh = false;
    update_bodies(network, contacts);
}
