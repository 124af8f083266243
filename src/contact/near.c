/// Which points are near which edges, and for how many substeps none of them can touch.
///
/// All motion is that beside the mean of the outline: what flies along together is at rest. How many substeps are
/// quiet follows from positions and velocities alone, not from when the list was made.
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "contact/pairs.h"

/// What a look answers for goes beyond the thickness by this share of it, and by the way of so many steps; as a
/// rule not beyond another thickness.
#define LEAST_SHARE 0.15
#define STEPS_AHEAD 4.0

/// So many times the way of a substep, for rows are made as far as two points can come towards each other in two.
#define SUBSTEPS_AHEAD 8.0

/// Pairs that may touch within so many substeps are looked at in each of them, and found anew after that. Where
/// bodies are so fast that these would be all within a share of the thickness and more, it is fewer substeps.
#define HOT_SUBSTEPS 8.0
#define LEAST_HOT_SUBSTEPS 4.0
#define HOT_SHARE 0.5

/// A list goes so many times as far beyond the thickness as is needed. Where few may touch soon, one in SPARSE of
/// the outline's points, it goes further, and is made less often.
#define REACH 2.0
#define SPARSE_REACH 6.0
#define SPARSE 4u

/* ----------------------------------------------------------------------------------------------------- distance */

// Of the point from the edge, or from the surface of a collider.
static double distance_of(const mspringi_pairs *pairs, mspring_id p, uint32_t edge) {
    const mspring_id a = pairs->outline.a[edge], b = pairs->outline.b[edge];
    const mspringi_nearest at =
        mspringi_nearest_on(pairs->x[p], pairs->y[p], pairs->x[a], pairs->y[a], pairs->x[b], pairs->y[b]);
    const double distance = sqrt(at.x * at.x + at.y * at.y);
    return pairs->colliders.count > 0 ? distance - mspringi_radius_of(pairs, p, edge) : distance;
}

/* --------------------------------------------------------------------------------------------------- the motion */

// Sums over all points: velocity, and the way since the list was made.
typedef struct mean_motion {
    double vx, vy, wx, wy;
} mean_motion;

// Where colliders are, and how fast.
static void look_at_colliders(const mspring_network *network, mspringi_pairs *pairs, mean_motion *sum) {
    const mspringi_colliders *c = &pairs->colliders;
    if (c->count == 0)
        return;
    mspringi_colliders_place(network, pairs, pairs->taken);
    for (uint32_t i = 0; i < c->point_count; ++i) {
        const mspring_id p = pairs->particles + i;
        double vx, vy;
        mspringi_collider_velocity(&c->list[c->owner[i]], pairs->dt, &vx, &vy);
        pairs->x[p] = c->x[i];
        pairs->y[p] = c->y[i];
        sum->vx += vx;
        sum->vy += vy;
        sum->wx += pairs->x[p] - pairs->seen_x[p];
        sum->wy += pairs->y[p] - pairs->seen_y[p];
    }
}

// A velocity that is no number makes the mean none, and so all that are compared.
static double larger(double known, double found) {
    return found <= known ? known : found;
}

// The same of their motion beside the mean: squares of the largest.
static void compare_colliders(const mspringi_pairs *pairs, const mean_motion *mean, double *speed, double *moved) {
    const mspringi_colliders *c = &pairs->colliders;
    for (uint32_t i = 0; i < c->point_count; ++i) {
        const mspring_id p = pairs->particles + i;
        const mspringi_collider *owner = &c->list[c->owner[i]];
        const double u = c->shape[2 * i], v = c->shape[2 * i + 1];
        const double turning = fabs(mspringi_collider_spin(owner, pairs->dt)) * sqrt(u * u + v * v);
        double vx, vy;
        mspringi_collider_velocity(owner, pairs->dt, &vx, &vy);
        vx -= mean->vx, vy -= mean->vy;
        const double most = sqrt(vx * vx + vy * vy) + turning;
        const double dx = pairs->x[p] - pairs->seen_x[p] - mean->wx, dy = pairs->y[p] - pairs->seen_y[p] - mean->wy;
        const double way = dx * dx + dy * dy;
        *speed = larger(*speed, most * most);
        *moved = larger(*moved, way);
    }
}

// Where the points are, how fast beside their mean, and how far they have come since the list was made.
static void look_at_points(const mspring_network *network, mspringi_pairs *pairs) {
    const mspringi_outline *o = &pairs->outline;
    const mspringi_state *s = &network->state;
    const uint32_t *slot_of = network->topology.slot_of_particle;
    const uint32_t own = o->point_count - pairs->colliders.point_count;
    const mspringi_active *k = &pairs->active; // in use within substeps only: here for the motion of points
    mean_motion mean = {0.0, 0.0, 0.0, 0.0};
    double speed = 0.0, moved = 0.0;
    for (uint32_t i = 0; i < own; ++i) {
        const mspring_id p = o->points[i];
        const uint32_t slot = slot_of[p];
        const double x = mspringi_x_of(s, slot), y = mspringi_y_of(s, slot);
        pairs->x[p] = x;
        pairs->y[p] = y;
        mean.vx += k->v[i].x = (double)s->vx[slot];
        mean.vy += k->v[i].y = (double)s->vy[slot];
        mean.wx += k->x[i] = x - pairs->seen_x[p];
        mean.wy += k->y[i] = y - pairs->seen_y[p];
    }
    look_at_colliders(network, pairs, &mean);
    const double part = o->point_count > 0 ? 1.0 / (double)o->point_count : 0.0;
    mean.vx *= part, mean.vy *= part, mean.wx *= part, mean.wy *= part;
    for (uint32_t i = 0; i < own; ++i) {
        const double ux = k->v[i].x - mean.vx, uy = k->v[i].y - mean.vy;
        const double dx = k->x[i] - mean.wx, dy = k->y[i] - mean.wy;
        const double u = ux * ux + uy * uy, d = dx * dx + dy * dy;
        speed = larger(speed, u);
        moved = larger(moved, d);
    }
    compare_colliders(pairs, &mean, &speed, &moved);
    pairs->mean_vx = mean.vx;
    pairs->mean_vy = mean.vy;
    pairs->speed = sqrt(speed);
    if (pairs->is_strict && pairs->thrown > pairs->speed)
        pairs->speed = pairs->thrown;
    pairs->moved = sqrt(moved);
}

/* -------------------------------------------------------------------------------------------------------- list */

// Points of colliders are in no group of particles: what is may touch them.
static bool are_in_one_group(const mspring_network *network, mspring_id p, mspring_id q) {
    const uint32_t *group = network->groups.of_particle, particles = network->topology.particle_count;
    return !group || p >= particles || q >= particles || group[p] == group[q];
}

static bool may_touch(const mspring_network *network, mspring_id p, mspring_id q) {
    const mspringi_pairs *pairs = network->pairs;
    return pairs->groups[p] & pairs->masks[q] && pairs->groups[q] & pairs->masks[p] &&
           are_in_one_group(network, p, q);
}

static bool is_apart(const mspring_network *network, mspringi_pairs *pairs, mspring_id p, uint32_t edge) {
    const mspring_id a = pairs->outline.a[edge], b = pairs->outline.b[edge];
    if (mspringi_is_of_collider(pairs, a) || mspringi_is_of_collider(pairs, p))
        return mspringi_is_of_collider(pairs, a) && mspringi_is_of_collider(pairs, p);
    if (!pairs->touches_itself)
        return pairs->outline.body[a] == pairs->outline.body[p];
    uint32_t *known = pairs->apart + (size_t)MSPRINGI_KNOWN_APART * p;
    for (uint32_t k = 0; k < MSPRINGI_KNOWN_APART; ++k)
        if (known[k] == edge)
            return true;
    if (pairs->stamp_of != p)
        mspringi_outline_stamp(network, pairs, p);
    pairs->stamp_of = p;
    if (pairs->stamp[a] != p + 1 && pairs->stamp[b] != p + 1)
        return false;
    memmove(known + 1, known, (MSPRINGI_KNOWN_APART - 1) * sizeof *known);
    known[0] = edge;
    return true;
}

// False: there is no room.
static bool try_pair(const mspring_network *network, mspringi_pairs *pairs, uint32_t first, mspring_id p,
                     uint32_t edge) {
    const mspringi_outline *o = &pairs->outline;
    const mspring_id a = o->a[edge], b = o->b[edge];
    if (p == a || p == b || !(distance_of(pairs, p, edge) < pairs->reach) || !may_touch(network, p, a) ||
        !may_touch(network, p, b) || is_apart(network, pairs, p, edge))
        return true;
    if (pairs->count == pairs->capacity)
        return false;
    uint32_t at = pairs->count++;
    for (; at > first && pairs->list[at - 1].edge > edge; --at)
        pairs->list[at] = pairs->list[at - 1];
    pairs->list[at] = (mspringi_pair){.point = p, .edge = edge};
    return true;
}

static bool list_point(const mspring_network *network, mspringi_pairs *pairs, mspring_id p) {
    const mspringi_edge_cells *cells = &pairs->cells;
    const uint32_t first = pairs->count, found = mspringi_cells_search(network, pairs, p);
    for (uint32_t k = 0; k < found; ++k)
        if (!try_pair(network, pairs, first, p, cells->found[k]))
            return false;
    for (uint32_t k = 0; k < cells->long_count; ++k)
        if (!mspringi_is_counted_otherwise(&pairs->outline, p, cells->long_edges[k]) &&
            !try_pair(network, pairs, first, p, cells->long_edges[k]))
            return false;
    return true;
}

static void activate(mspringi_active *active, mspring_id p) {
    if (active->number[p] != MSPRING_NONE)
        return;
    active->number[p] = active->count;
    active->particles[active->count++] = p;
}

// Nodes below an id, of hot pairs, and their neighbours on the outline: a corner looks at the edges beside it.
static void activate_below(mspringi_pairs *pairs, mspring_id end) {
    mspringi_active *active = &pairs->active;
    const mspringi_outline *o = &pairs->outline;
    for (uint32_t i = 0; i < pairs->hot_count; ++i) {
        const mspringi_pair *pair = &pairs->list[pairs->hot[i].pair];
        const mspring_id ends[] = {o->a[pair->edge], o->b[pair->edge]};
        if (pair->point < end)
            activate(active, pair->point);
        if (ends[0] == ends[1] && ends[0] < end)
            activate(active, ends[0]);
        for (int k = 0; k < 2 && ends[0] != ends[1]; ++k)
            for (uint32_t j = o->first[ends[k]]; j < o->first[ends[k] + 1] && ends[k] < end; ++j) {
                activate(active, o->a[o->at[j]]);
                activate(active, o->b[o->at[j]]);
            }
    }
}

// Edges join particles, or points of one collider.
static void activate_all(mspringi_pairs *pairs) {
    mspringi_active *active = &pairs->active;
    for (uint32_t i = 0; i < active->count; ++i)
        active->number[active->particles[i]] = MSPRING_NONE;
    active->count = 0;
    activate_below(pairs, pairs->particles);
    active->own = active->count;
    if (pairs->colliders.count > 0)
        activate_below(pairs, MSPRING_NONE);
    for (uint32_t i = 0; i < pairs->hot_count; ++i) {
        mspringi_candidate *c = &pairs->hot[i];
        const mspringi_pair *pair = &pairs->list[c->pair];
        c->p = active->number[pair->point];
        c->a = active->number[pairs->outline.a[pair->edge]];
        c->b = active->number[pairs->outline.b[pair->edge]];
    }
}

// How far a look must answer for.
static double needed(const mspringi_pairs *pairs) {
    const double thickness = pairs->thickness, substeps = SUBSTEPS_AHEAD * (double)pairs->h * pairs->speed;
    const double ahead = LEAST_SHARE * thickness + STEPS_AHEAD * pairs->dt * pairs->speed;
    const double usual = ahead < thickness || pairs->has_sleepers ? ahead : thickness;
    return thickness + (usual > substeps ? usual : substeps);
}

// All pairs nearer than this are in the list, however far their points have come since.
static double answered(const mspringi_pairs *pairs) {
    return pairs->reach - 2.0 * pairs->moved;
}

// List all pairs this near.
static bool make_list(const mspring_network *network, mspringi_pairs *pairs, double reach) {
    const mspringi_outline *o = &pairs->outline;
    pairs->count = 0;
    pairs->stamp_of = MSPRING_NONE;
    pairs->reach = reach;
    pairs->moved = 0.0;
    if (o->edge_count > 0) {
        mspringi_cells_fill(network, pairs, reach);
        for (uint32_t i = 0; i < o->point_count; ++i) {
            const mspring_id p = o->points[i];
            pairs->seen_x[p] = pairs->x[p];
            pairs->seen_y[p] = pairs->y[p];
            if (!list_point(network, pairs, p))
                return false;
        }
    }
    return true;
}

// How far a point may come in a substep.
static double way_of_substep(const mspringi_pairs *pairs) {
    const double h = (double)pairs->h;
    return MSPRINGI_FASTER * h * pairs->speed + MSPRINGI_DRIFT * pairs->thickness * h / pairs->dt;
}

static double hot_substeps(const mspringi_pairs *pairs) {
    const double substeps = HOT_SHARE * pairs->thickness / (2.0 * way_of_substep(pairs));
    return substeps > HOT_SUBSTEPS         ? HOT_SUBSTEPS
           : substeps > LEAST_HOT_SUBSTEPS ? floor(substeps)
                                           : LEAST_HOT_SUBSTEPS;
}

// For how many substeps the list answers for all that can touch.
static uint32_t count_valid(const mspringi_pairs *pairs) {
    const double way = way_of_substep(pairs);
    const double least = pairs->thickness + 0.5 * (needed(pairs) - pairs->thickness);
    const double valid = (answered(pairs) - least) / (2.0 * way);
    return valid >= 1.0 ? valid < 1e6 ? (uint32_t)valid : 1000000 : 1;
}

// Whether a pair is one of two particles without springs, and the square of their distance.
MSPRINGI_ALWAYS_INLINE bool are_loose(const mspringi_pairs *pairs, const mspringi_pair *pair, double *square) {
    const mspring_id p = pair->point, a = pairs->outline.a[pair->edge];
    const double dx = pairs->x[p] - pairs->x[a], dy = pairs->y[p] - pairs->y[a];
    *square = dx * dx + dy * dy;
    return a == pairs->outline.b[pair->edge] && !mspringi_is_of_collider(pairs, p) &&
           !mspringi_is_of_collider(pairs, a);
}

// Find the pairs that are hot, and the nearest one. Of two particles without springs there may be many, so neither
// roots nor branches are spent on them.
static void look_at_pairs(mspringi_pairs *pairs) {
    const double most = pairs->thickness + 2.0 * hot_substeps(pairs) * way_of_substep(pairs) +
                        4.0 * MSPRINGI_FASTER * (double)pairs->h * pairs->speed;
    double least = pairs->reach * pairs->reach, square;
    uint32_t hot = 0;
    pairs->nearest = pairs->reach;
    for (uint32_t i = 0; i < pairs->count; ++i) {
        pairs->hot[hot].pair = i;
        if (are_loose(pairs, &pairs->list[i], &square)) {
            least = square >= least ? least : square;
            hot += !(square > most * most);
            continue;
        }
        const double distance = distance_of(pairs, pairs->list[i].point, pairs->list[i].edge);
        pairs->nearest = distance >= pairs->nearest ? pairs->nearest : distance;
        hot += !(distance > most);
    }
    pairs->hot_count = hot;
    least = sqrt(least);
    pairs->nearest = least >= pairs->nearest ? pairs->nearest : least;
    activate_all(pairs);
}

bool mspringi_near_renew(const mspring_network *network, mspringi_pairs *pairs) {
    look_at_points(network, pairs);
    if (!pairs->is_listed || !(answered(pairs) >= needed(pairs))) {
        const bool is_sparse = pairs->is_listed && SPARSE * (uint64_t)pairs->hot_count < pairs->outline.point_count;
        const double most = needed(pairs),
                     more = pairs->thickness + (is_sparse ? SPARSE_REACH : REACH) * (most - pairs->thickness);
        pairs->is_listed = make_list(network, pairs, more) || make_list(network, pairs, most);
        pairs->is_full = !pairs->is_listed;
    }
    if (pairs->is_full) {
        // The step will be rejected. Its other substeps have no candidates: these were of another list.
        pairs->hot_count = 0;
        activate_all(pairs);
        return false;
    }
    look_at_pairs(pairs);
    const uint32_t valid = count_valid(pairs);
    const uint32_t hot = (uint32_t)hot_substeps(pairs);
    pairs->valid = valid < hot ? valid : hot;
    return true;
}

/* -------------------------------------------------------------------------------------------------------- look */

static uint32_t count_quiet(mspringi_pairs *pairs) {
    const double way = 2.0 * way_of_substep(pairs);
    const double most = needed(pairs), nearest = pairs->nearest < most ? pairs->nearest : most;
    const double quiet = (nearest - pairs->thickness) / way;
    pairs->room = nearest - pairs->thickness;
    return quiet >= 2.0 ? quiet < 1e6 ? (uint32_t)quiet : 1000000 : 0;
}

bool mspringi_near_look(const mspring_network *network, mspringi_pairs *pairs) {
    const bool is_same = pairs->is_fresh && pairs->looked_h == pairs->h && pairs->looked_dt == pairs->dt &&
                         pairs->state == network->edits.state && pairs->naps == network->edits.naps &&
                         !network->is_open;
    if (!is_same) {
        if (!mspringi_near_renew(network, pairs))
            return false;
        pairs->is_fresh = true;
        pairs->looked_h = pairs->h;
        pairs->looked_dt = pairs->dt;
        pairs->state = network->edits.state;
        pairs->naps = network->edits.naps;
    }
    pairs->quiet = pairs->is_strict ? 0 : count_quiet(pairs);
    return true;
}
