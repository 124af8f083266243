/// Which springs and particles are the outline.
///
/// A live spring is inside if a triangle of live springs lies on each side of it; all others are edges. That is
/// right for holes, concave corners, ropes and trusses alike. Sides are those of the shape that the network had
/// when contact was set, so an outline follows from that shape and from the live springs, whatever has happened
/// since. A break changes no more than the springs at its two ends.
#include <math.h>
#include <string.h>

#include "base/union_find.h"
#include "contact/contacts.h"
#include "store/id_pool.h"
#include "store/springs.h"

/// A triangle is on neither side if it is thinner than this share of the spring.
#define THIN 1e-4

void mspringi_outline_ends(const mspring_network *network, mspring_id spring, mspring_id ends[2]) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, spring), &base, &tip);
    ends[0] = t->particle_of_slot[base];
    ends[1] = t->particle_of_slot[tip];
}

// The next live spring at a particle, and its other end.
static mspring_id next_live(const mspring_network *network, mspringi_incident_springs *around, mspring_id p,
                            mspring_id *other) {
    mspring_id spring, ends[2];
    while ((spring = mspringi_incident_springs_next(network, around)) != MSPRING_NONE) {
        if (!mspringi_spring_is_live(network, spring))
            continue;
        mspringi_outline_ends(network, spring, ends);
        *other = ends[0] == p ? ends[1] : ends[0];
        return spring;
    }
    return MSPRING_NONE;
}

static uint32_t springs_laid_at(const mspring_network *network, mspring_id p) {
    return network->incidence.first[p + 1] - network->incidence.first[p];
}

static bool is_linked(const mspring_network *network, mspring_id p, mspring_id q) {
    const bool is_fewer = springs_laid_at(network, p) <= springs_laid_at(network, q);
    const mspring_id from = is_fewer ? p : q, to = is_fewer ? q : p;
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, from);
    mspring_id other;
    while (next_live(network, &around, from, &other) != MSPRING_NONE)
        if (other == to)
            return true;
    return false;
}

bool mspringi_outline_are_neighbours(const mspring_network *network, mspring_id p, mspring_id q) {
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
    mspring_id other;
    if (p == q)
        return true;
    while (next_live(network, &around, p, &other) != MSPRING_NONE)
        if (other == q || is_linked(network, other, q))
            return true;
    return false;
}

void mspringi_outline_mark_neighbours(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
    mspring_id next, after;
    const uint32_t stamp = p + 1;
    contacts->stamp[p] = stamp;
    while (next_live(network, &around, p, &next) != MSPRING_NONE) {
        mspringi_incident_springs beyond = mspringi_incident_springs_begin(network, next);
        contacts->stamp[next] = stamp;
        while (next_live(network, &beyond, next, &after) != MSPRING_NONE)
            contacts->stamp[after] = stamp;
    }
}

/* ------------------------------------------------------------------------------------------------------- edges */

// Whether triangles lie on both sides of a live spring.
static bool is_inside(const mspring_network *network, const mspringi_outline *o, mspring_id spring) {
    mspring_id ends[2], other;
    mspringi_outline_ends(network, spring, ends);
    const bool is_fewer = springs_laid_at(network, ends[0]) <= springs_laid_at(network, ends[1]);
    const mspring_id a = is_fewer ? ends[0] : ends[1], b = is_fewer ? ends[1] : ends[0];
    const double ex = o->shape_x[b] - o->shape_x[a], ey = o->shape_y[b] - o->shape_y[a];
    const double thin = THIN * (ex * ex + ey * ey);
    bool left = false, right = false;
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, a);
    while (!(left && right) && next_live(network, &around, a, &other) != MSPRING_NONE) {
        if (other == b || !is_linked(network, other, b))
            continue;
        const double side = ex * (o->shape_y[other] - o->shape_y[a]) - ey * (o->shape_x[other] - o->shape_x[a]);
        left |= side > thin;
        right |= side < -thin;
    }
    return left && right;
}

// Whether another live spring that joins the same particles stands for both.
static bool lies_beside(const mspring_network *network, mspring_id spring) {
    mspring_id ends[2], beside, other;
    if (network->topology.parallel_count == 0)
        return false;
    mspringi_outline_ends(network, spring, ends);
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, ends[0]);
    while ((beside = next_live(network, &around, ends[0], &other)) != MSPRING_NONE)
        if (other == ends[1] && beside < spring)
            return true;
    return false;
}

static void judge(const mspring_network *network, mspringi_outline *o, mspring_id spring) {
    o->is_edge[spring] = mspringi_spring_exists(network, spring) && mspringi_spring_is_live(network, spring) &&
                         !lies_beside(network, spring) && !is_inside(network, o, spring);
}

static void judge_all(const mspring_network *network, mspringi_outline *o) {
    for (mspring_id s = 0; s < network->topology.spring_count; ++s)
        judge(network, o, s);
}

// Those that may have been in a triangle with a spring that broke, or was restored.
static void judge_around(const mspring_network *network, mspringi_outline *o, mspring_id spring) {
    mspring_id ends[2], other;
    mspringi_outline_ends(network, spring, ends);
    judge(network, o, spring);
    for (int i = 0; i < 2; ++i) {
        mspringi_incident_springs around = mspringi_incident_springs_begin(network, ends[i]);
        mspring_id beside;
        while ((beside = next_live(network, &around, ends[i], &other)) != MSPRING_NONE)
            judge(network, o, beside);
    }
}

/* ------------------------------------------------------------------------------------------------------- shape */

void mspringi_outline_clear_slot(const mspring_network *network, uint32_t slot) {
    const mspring_id p = network->topology.particle_of_slot[slot];
    if (p != MSPRING_NONE)
        network->contacts->outline.is_known[p] = 0;
}

// What has been added takes part in the shape as it is now.
static void know_all(const mspring_network *network, mspringi_outline *o) {
    const mspringi_topology *t = &network->topology;
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        if (o->is_known[p] || !mspringi_particle_exists(network, p))
            continue;
        const uint32_t slot = t->slot_of_particle[p];
        o->shape_x[p] = mspringi_x_of(&network->state, slot) + (network->origin_x - o->origin_x);
        o->shape_y[p] = mspringi_y_of(&network->state, slot) + (network->origin_y - o->origin_y);
        o->is_known[p] = 1;
    }
}

/* ------------------------------------------------------------------------------------------------------- lists */

static void list_side(mspringi_outline *o, mspring_id a, mspring_id b) {
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
            list_side(o, first + k, first + (k + 1) % c->count);
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
        o->a[o->edge_count] = ends[0];
        o->b[o->edge_count++] = ends[1];
        o->first[ends[0]]++;
        o->first[ends[1]]++;
    }
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        if (o->first[p] > 0 || !mspringi_particle_exists(network, p))
            continue;
        mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
        if (next_live(network, &around, p, &other) != MSPRING_NONE)
            continue;
        o->a[o->edge_count] = o->b[o->edge_count] = p;
        o->first[p] = 1;
        ++o->edge_count;
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

// What edits have changed of the springs that are edges.
static void judge_anew(const mspring_network *network, mspringi_outline *o) {
    const mspringi_edits *edits = &network->edits;
    const bool is_local = o->is_found && o->growth == edits->growth && mspringi_edits_have_link(edits, o->links);
    if (!is_local) {
        know_all(network, o);
        judge_all(network, o);
        return;
    }
    for (uint64_t n = o->links; n < edits->links; ++n)
        judge_around(network, o, mspringi_edits_link(edits, n));
}

// Who asks which body a particle is of: contact that leaves bodies alone with themselves, and events.
static void follow_bodies(const mspring_network *network, mspringi_contacts *contacts) {
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
        follow_bodies(network, contacts);
        return;
    }
    judge_anew(network, o);
    list_edges(network, o, nodes);
    list_sides(contacts);
    list_points(o, nodes);
    o->are_bodies_found = false;
    memset(contacts->stamp, 0, contacts->particles * sizeof *contacts->stamp);
    o->is_found = true;
    o->links = edits->links;
    o->growth = edits->growth;
    memset(contacts->excluded_edges, 0xff,
           MSPRINGI_EXCLUDED_EDGES * (size_t)contacts->particles * sizeof *contacts->excluded_edges);
    contacts->colliders.are_new = false;
    contacts->is_listed = contacts->is_fresh = false;
    follow_bodies(network, contacts);
}
