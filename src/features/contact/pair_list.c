/// Verlet list of pairs: points near edges. From it follow the candidates, and the substeps in which nothing can
/// touch.
///
/// All motion is relative to the mean of the outline. The candidates, and the number of quiet substeps, follow from
/// positions and velocities alone, not from when the list was made, nor from how far it reaches.
///
/// mspringi_pair_list_scan calls mspringi_pair_list_refresh. That measures the points (measure_points()), makes a
/// new list if the old one may lack pairs (make_list()), and collects the candidates (collect_candidates()).
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "features/contact/contacts.h"

/// Required reach beyond the thickness: a share of it, plus the way of these steps; together at most another
/// thickness.
#define LEAST_SHARE 0.15
#define STEPS_AHEAD 4.0

/// Ways of a substep in the reach at least. Constraints reach as far as two points can approach in two substeps.
#define SUBSTEPS_AHEAD 8.0

/// Substeps between two collections of candidates. Fewer if bodies are so fast that pairs within a share of the
/// thickness and more would be candidates.
#define CANDIDATE_SUBSTEPS 8.0
#define MIN_CANDIDATE_SUBSTEPS 4.0
#define CANDIDATE_FRACTION 0.5

/// Reach of a new list, as a multiple of the required reach beyond the thickness. A list with few candidates, one
/// in SPARSE of the outline's points, reaches farther and lasts longer.
#define REACH 2.0
#define SPARSE_REACH 6.0
#define SPARSE 4u

/// Comparisons of points with edges that find no pair, which a step may add for each list and point. (The bodies of
/// tests/features/contact take 20.)
#define WORK_OF_POINT 32

/* ----------------------------------------------------------------------------------------------------- distance */

// Distance of a point from an edge, or from a collider's surface, m.
static double distance_of(const mspringi_contacts *contacts, mspring_id p, uint32_t edge) {
    const mspring_id a = contacts->outline.a[edge], b = contacts->outline.b[edge];
    const mspringi_closest_point at = mspringi_closest_point_on_edge(
        contacts->x[p], contacts->y[p], contacts->x[a], contacts->y[a], contacts->x[b], contacts->y[b]);
    const double distance = sqrt(at.x * at.x + at.y * at.y);
    return contacts->colliders.count > 0 ? distance - mspringi_radius_of(contacts, p, edge) : distance;
}

/* --------------------------------------------------------------------------------------------------- the motion */

// Sums over all points: velocity, and the way since the list was made.
typedef struct mean_motion {
    double vx, vy, wx, wy;
} mean_motion;

// Find positions and velocities of collider points, and add these to the sums.
static void measure_colliders(const mspring_network *network, mspringi_contacts *contacts, mean_motion *sum) {
    const mspringi_colliders *c = &contacts->colliders;
    if (c->count == 0)
        return;
    mspringi_colliders_move_points(network, contacts, contacts->substeps_done);
    for (uint32_t i = 0; i < c->point_count; ++i) {
        const mspring_id p = contacts->particles + i;
        double vx, vy;
        mspringi_collider_velocity(&c->list[c->owner[i]], contacts->dt, &vx, &vy);
        contacts->x[p] = c->x[i];
        contacts->y[p] = c->y[i];
        sum->vx += vx;
        sum->vy += vy;
        sum->wx += contacts->x[p] - contacts->seen_x[p];
        sum->wy += contacts->y[p] - contacts->seen_y[p];
    }
}

// Larger of two values; NaN if the found one is. One velocity that is NaN makes the mean NaN, and so all.
static double max_or_nan(double known, double found) {
    return found <= known ? known : found;
}

// Raise the largest squares of motion relative to the mean by those of collider points.
static void compare_colliders(const mspringi_contacts *contacts, const mean_motion *mean, double *speed,
                              double *moved) {
    const mspringi_colliders *c = &contacts->colliders;
    for (uint32_t i = 0; i < c->point_count; ++i) {
        const mspring_id p = contacts->particles + i;
        const mspringi_collider *owner = &c->list[c->owner[i]];
        const double u = c->shape[2 * i], v = c->shape[2 * i + 1];
        const double turning = fabs(mspringi_collider_spin(owner, contacts->dt)) * sqrt(u * u + v * v);
        double vx, vy;
        mspringi_collider_velocity(owner, contacts->dt, &vx, &vy);
        vx -= mean->vx, vy -= mean->vy;
        const double most = sqrt(vx * vx + vy * vy) + turning;
        const double dx = contacts->x[p] - contacts->seen_x[p] - mean->wx,
                     dy = contacts->y[p] - contacts->seen_y[p] - mean->wy;
        const double way = dx * dx + dy * dy;
        *speed = max_or_nan(*speed, most * most);
        *moved = max_or_nan(*moved, way);
    }
}

// Find the points' positions, largest speed and largest displacement since the list was made, both relative to the
// mean.
static void measure_points(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_state *s = &network->state;
    const uint32_t *slot_of = network->topology.slot_of_particle;
    const uint32_t own = o->point_count - contacts->colliders.point_count;
    const mspringi_contact_nodes *k =
        &contacts->nodes; // in use within substeps only: here for the motion of points
    mean_motion mean = {0.0, 0.0, 0.0, 0.0};
    double speed = 0.0, moved = 0.0;
    for (uint32_t i = 0; i < own; ++i) {
        const mspring_id p = o->points[i];
        const uint32_t slot = slot_of[p];
        const double x = mspringi_x_of(s, slot), y = mspringi_y_of(s, slot);
        contacts->x[p] = x;
        contacts->y[p] = y;
        mean.vx += k->v[i].x = (double)s->vx[slot];
        mean.vy += k->v[i].y = (double)s->vy[slot];
        mean.wx += k->x[i] = x - contacts->seen_x[p];
        mean.wy += k->y[i] = y - contacts->seen_y[p];
    }
    measure_colliders(network, contacts, &mean);
    const double part = o->point_count > 0 ? 1.0 / (double)o->point_count : 0.0;
    mean.vx *= part, mean.vy *= part, mean.wx *= part, mean.wy *= part;
    for (uint32_t i = 0; i < own; ++i) {
        const double ux = k->v[i].x - mean.vx, uy = k->v[i].y - mean.vy;
        const double dx = k->x[i] - mean.wx, dy = k->y[i] - mean.wy;
        const double u = ux * ux + uy * uy, d = dx * dx + dy * dy;
        speed = max_or_nan(speed, u);
        moved = max_or_nan(moved, d);
    }
    compare_colliders(contacts, &mean, &speed, &moved);
    contacts->mean_vx = mean.vx;
    contacts->mean_vy = mean.vy;
    contacts->speed = sqrt(speed);
    if (contacts->is_second_try && contacts->extra_speed > contacts->speed)
        contacts->speed = contacts->extra_speed;
    contacts->moved = sqrt(moved);
}

/* -------------------------------------------------------------------------------------------------------- list */

// Particles of different groups never touch. Collider points are in no group, so all may touch them.
static bool are_in_one_group(const mspring_network *network, mspring_id p, mspring_id q) {
    const uint32_t *group = network->groups.of_particle, particles = network->topology.particle_count;
    return !group || p >= particles || q >= particles || group[p] == group[q];
}

static bool may_touch(const mspring_network *network, mspring_id p, mspring_id q) {
    const mspringi_contacts *contacts = network->contacts;
    return contacts->groups[p] & contacts->masks[q] && contacts->groups[q] & contacts->masks[p] &&
           are_in_one_group(network, p, q);
}

static bool is_excluded(const mspring_network *network, mspringi_contacts *contacts, mspring_id p, uint32_t edge) {
    const mspring_id a = contacts->outline.a[edge], b = contacts->outline.b[edge];
    if (mspringi_is_collider_point(contacts, a) || mspringi_is_collider_point(contacts, p))
        return mspringi_is_collider_point(contacts, a) && mspringi_is_collider_point(contacts, p);
    if (!contacts->touches_itself)
        return contacts->outline.body[a] == contacts->outline.body[p];
    uint32_t *known = contacts->excluded_edges + (size_t)MSPRINGI_EXCLUDED_EDGES * p;
    for (uint32_t k = 0; k < MSPRINGI_EXCLUDED_EDGES; ++k)
        if (known[k] == edge)
            return true;
    if (!mspringi_outline_are_neighbours(network, contacts, p, a) &&
        !mspringi_outline_are_neighbours(network, contacts, p, b))
        return false;
    memmove(known + 1, known, (MSPRINGI_EXCLUDED_EDGES - 1) * sizeof *known);
    known[0] = edge;
    return true;
}

// True if a point and an edge are within reach, and may touch: then they are a pair.
static bool are_near(const mspring_network *network, mspringi_contacts *contacts, mspring_id p, uint32_t edge) {
    const mspringi_outline *o = &contacts->outline;
    const mspring_id a = o->a[edge], b = o->b[edge];
    return p != a && p != b && distance_of(contacts, p, edge) < contacts->reach && may_touch(network, p, a) &&
           may_touch(network, p, b) && !is_excluded(network, contacts, p, edge);
}

// Move a number down a heap to where none below it is larger.
static void sift(uint32_t *heap, uint32_t at, uint32_t count) {
    const uint32_t moved = heap[at];
    for (uint32_t below; (below = 2 * at + 1) < count; at = below) {
        below += below + 1 < count && heap[below + 1] > heap[below];
        if (heap[below] <= moved)
            break;
        heap[at] = heap[below];
    }
    heap[at] = moved;
}

// Most moves per number of an insertion sort. Edges found are nearly in order as a rule; else a heap sorts them.
#define FEW_MOVES 8u

static void sort(uint32_t *numbers, uint32_t count) {
    uint32_t sorted = 1;
    for (int64_t moves = FEW_MOVES * (int64_t)count; sorted < count && moves >= 0; ++sorted) {
        const uint32_t moved = numbers[sorted];
        uint32_t at = sorted;
        for (; at > 0 && numbers[at - 1] > moved; --at)
            numbers[at] = numbers[at - 1];
        numbers[at] = moved;
        moves -= sorted - at;
    }
    if (sorted >= count)
        return;
    for (uint32_t i = count / 2; i-- > 0;)
        sift(numbers, i, count);
    for (uint32_t end = count; end-- > 1;) {
        const uint32_t largest = numbers[0];
        numbers[0] = numbers[end];
        numbers[end] = largest;
        sift(numbers, 0, end);
    }
}

// Add the pairs of a point, by rising edges. False: there is no room for them, or they take too long to find.
static bool list_pairs_of_point(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    mspringi_edge_grid *cells = &contacts->cells;
    const uint32_t found = mspringi_edge_grid_search(network, contacts, p),
                   room = contacts->capacity - contacts->count;
    uint32_t close_count = 0;
    for (uint32_t k = 0; k < found && close_count <= room; ++k) {
        cells->found[close_count] = cells->found[k];
        close_count += are_near(network, contacts, p, cells->found[k]);
    }
    contacts->work += found - close_count;
    const bool has_room = close_count <= room, is_done = contacts->work <= contacts->most_work;
    close_count = has_room ? close_count : room;
    sort(cells->found, close_count);
    for (uint32_t k = 0; k < close_count; ++k)
        contacts->list[contacts->count++] = (mspringi_pair){.point = p, .edge = cells->found[k]};
    return has_room && is_done;
}

// Give a node a dense number, unless it has one.
static void activate(mspringi_contact_nodes *active, mspring_id p) {
    if (active->number[p] != MSPRING_NONE)
        return;
    active->number[p] = active->count;
    active->particles[active->count++] = p;
}

// Activate a corner and its neighbours on the outline, if it has an id below `end`.
static void activate_neighbours(mspringi_contacts *contacts, mspring_id corner, mspring_id end) {
    const mspringi_outline *o = &contacts->outline;
    if (corner >= end)
        return;
    mspringi_contact_count_visits(contacts, o->first[corner + 1] - o->first[corner]);
    for (uint32_t j = o->first[corner]; j < o->first[corner + 1]; ++j) {
        activate(&contacts->nodes, o->a[o->at[j]]);
        activate(&contacts->nodes, o->b[o->at[j]]);
    }
}

// Activate the nodes of candidates with ids below `end`, and the neighbours of edge ends, which
// belongs_to_other_edge() compares.
static void activate_below(mspringi_contacts *contacts, mspring_id end) {
    mspringi_contact_nodes *active = &contacts->nodes;
    const mspringi_outline *o = &contacts->outline;
    mspring_id last[2] = {MSPRING_NONE, MSPRING_NONE}; // corners; consecutive candidates share a hub
    for (uint32_t i = 0; i < contacts->candidate_count && !contacts->is_out_of_room; ++i) {
        const mspringi_pair *pair = &contacts->list[contacts->candidates[i].pair];
        const mspring_id ends[] = {o->a[pair->edge], o->b[pair->edge]};
        if (pair->point < end)
            activate(active, pair->point);
        if (ends[0] == ends[1] && ends[0] < end)
            activate(active, ends[0]);
        for (int k = 0; k < 2 && ends[0] != ends[1]; ++k)
            if (ends[k] != last[k])
                activate_neighbours(contacts, last[k] = ends[k], end);
    }
}

// Number all nodes of candidates densely, particles first, and store the numbers in the candidates.
static void activate_all(mspringi_contacts *contacts) {
    mspringi_contact_nodes *active = &contacts->nodes;
    for (uint32_t i = 0; i < active->count; ++i)
        active->number[active->particles[i]] = MSPRING_NONE;
    active->count = 0;
    activate_below(contacts, contacts->particles);
    active->particle_count = active->count;
    if (contacts->colliders.count > 0)
        activate_below(contacts, MSPRING_NONE);
    if (contacts->is_out_of_room)
        contacts->candidate_count = 0;
    for (uint32_t i = 0; i < contacts->candidate_count; ++i) {
        mspringi_candidate *c = &contacts->candidates[i];
        const mspringi_pair *pair = &contacts->list[c->pair];
        c->p = active->number[pair->point];
        c->a = active->number[contacts->outline.a[pair->edge]];
        c->b = active->number[contacts->outline.b[pair->edge]];
    }
}

// Distance up to which the list must be complete, m.
static double required_reach(const mspringi_contacts *contacts) {
    const double thickness = contacts->thickness, substeps = SUBSTEPS_AHEAD * (double)contacts->h * contacts->speed;
    const double ahead = LEAST_SHARE * thickness + STEPS_AHEAD * contacts->dt * contacts->speed;
    const double usual = ahead < thickness || contacts->has_sleepers ? ahead : thickness;
    return thickness + (usual > substeps ? usual : substeps);
}

// Distance up to which the list is still complete, m.
static double guaranteed_reach(const mspringi_contacts *contacts) {
    return contacts->reach - 2.0 * contacts->moved;
}

// List all pairs nearer than `reach`. False: there is no room for them, or they take too long to find.
static bool make_list(const mspring_network *network, mspringi_contacts *contacts, double reach) {
    const mspringi_outline *o = &contacts->outline;
    contacts->count = 0;
    contacts->stamp_of = MSPRING_NONE;
    contacts->reach = reach;
    contacts->moved = 0.0;
    contacts->most_work += WORK_OF_POINT * (uint64_t)o->point_count;
    if (o->edge_count > 0) {
        mspringi_edge_grid_fill(network, contacts, reach);
        for (uint32_t i = 0; i < o->point_count; ++i) {
            const mspring_id p = o->points[i];
            contacts->seen_x[p] = contacts->x[p];
            contacts->seen_y[p] = contacts->y[p];
            if (!list_pairs_of_point(network, contacts, p))
                return false;
        }
    }
    return true;
}

// Longest way of a point in a substep, m.
static double travel_per_substep(const mspringi_contacts *contacts) {
    const double h = (double)contacts->h;
    return MSPRINGI_SPEED_MARGIN * h * contacts->speed +
           MSPRINGI_DRIFT_FRACTION * contacts->thickness * h / contacts->dt;
}

// Substeps for which candidates are collected.
static double candidate_substeps(const mspringi_contacts *contacts) {
    const double substeps = CANDIDATE_FRACTION * contacts->thickness / (2.0 * travel_per_substep(contacts));
    return substeps > CANDIDATE_SUBSTEPS       ? CANDIDATE_SUBSTEPS
           : substeps > MIN_CANDIDATE_SUBSTEPS ? floor(substeps)
                                               : MIN_CANDIDATE_SUBSTEPS;
}

// Substeps until a pair may be missing from the candidates.
static uint32_t valid_substeps(const mspringi_contacts *contacts) {
    const double half = 0.5 * (required_reach(contacts) - contacts->thickness);
    const double valid = half / (2.0 * travel_per_substep(contacts));
    return valid >= 1.0 ? valid < 1e6 ? (uint32_t)valid : 1000000 : 1;
}

// True if both sides of a pair are particles without springs. Find the square of their distance.
MSPRINGI_ALWAYS_INLINE bool are_loose(const mspringi_contacts *contacts, const mspringi_pair *pair,
                                      double *square) {
    const mspring_id p = pair->point, a = contacts->outline.a[pair->edge];
    const double dx = contacts->x[p] - contacts->x[a], dy = contacts->y[p] - contacts->y[a];
    *square = dx * dx + dy * dy;
    return a == contacts->outline.b[pair->edge] && !mspringi_is_collider_point(contacts, p) &&
           !mspringi_is_collider_point(contacts, a);
}

// Collect the candidates, and find the nearest pair. Pairs of particles without springs may be many, so they take
// neither roots nor branches.
static void collect_candidates(mspringi_contacts *contacts) {
    const double wanted = contacts->thickness + 2.0 * candidate_substeps(contacts) * travel_per_substep(contacts) +
                          4.0 * MSPRINGI_SPEED_MARGIN * (double)contacts->h * contacts->speed;
    const double complete = required_reach(contacts), most = wanted < complete ? wanted : complete;
    double least = contacts->reach * contacts->reach, square;
    uint32_t count = 0;
    contacts->nearest = contacts->reach;
    for (uint32_t i = 0; i < contacts->count; ++i) {
        contacts->candidates[count].pair = i;
        if (are_loose(contacts, &contacts->list[i], &square)) {
            least = square >= least ? least : square;
            count += !(square > most * most);
            continue;
        }
        const double distance = distance_of(contacts, contacts->list[i].point, contacts->list[i].edge);
        contacts->nearest = distance >= contacts->nearest ? contacts->nearest : distance;
        count += !(distance > most);
    }
    contacts->candidate_count = count;
    least = sqrt(least);
    contacts->nearest = least >= contacts->nearest ? contacts->nearest : least;
    activate_all(contacts);
}

bool mspringi_pair_list_refresh(const mspring_network *network, mspringi_contacts *contacts) {
    measure_points(network, contacts);
    if (!contacts->is_out_of_room &&
        (!contacts->is_listed || !(guaranteed_reach(contacts) >= required_reach(contacts)))) {
        const bool is_sparse =
            contacts->is_listed && SPARSE * (uint64_t)contacts->candidate_count < contacts->outline.point_count;
        const double most = required_reach(contacts),
                     more = contacts->thickness + (is_sparse ? SPARSE_REACH : REACH) * (most - contacts->thickness);
        contacts->is_listed = make_list(network, contacts, more) || make_list(network, contacts, most);
        contacts->is_pair_list_full = !contacts->is_listed;
    }
    if (contacts->is_pair_list_full || contacts->is_out_of_room) {
        // The step will be rejected. Its other substeps have no candidates: these were of another list.
        contacts->candidate_count = 0;
        activate_all(contacts);
        return false;
    }
    collect_candidates(contacts);
    const uint32_t valid = valid_substeps(contacts);
    const uint32_t planned = (uint32_t)candidate_substeps(contacts);
    contacts->valid = valid < planned ? valid : planned;
    return true;
}

/* -------------------------------------------------------------------------------------------------------- scan */

static uint32_t count_quiet(mspringi_contacts *contacts) {
    const double way = 2.0 * travel_per_substep(contacts);
    const double most = required_reach(contacts), nearest = contacts->nearest < most ? contacts->nearest : most;
    const double quiet = (nearest - contacts->thickness) / way;
    contacts->room = nearest - contacts->thickness;
    return quiet >= 2.0 ? quiet < 1e6 ? (uint32_t)quiet : 1000000 : 0;
}

bool mspringi_pair_list_scan(const mspring_network *network, mspringi_contacts *contacts) {
    const bool is_same = contacts->is_fresh && contacts->scan_h == contacts->h &&
                         contacts->scan_dt == contacts->dt && contacts->state == network->edits.state &&
                         contacts->sleep_changes == network->edits.sleep_changes && !network->is_open;
    if (!is_same) {
        if (!mspringi_pair_list_refresh(network, contacts))
            return false;
        contacts->is_fresh = true;
        contacts->scan_h = contacts->h;
        contacts->scan_dt = contacts->dt;
        contacts->state = network->edits.state;
        contacts->sleep_changes = network->edits.sleep_changes;
    }
    contacts->quiet_substeps = contacts->is_second_try ? 0 : count_quiet(contacts);
    return true;
}

void mspringi_near_list(const mspring_network *network, mspringi_contacts *contacts, double reach) {
    mspringi_outline_update(network, contacts);
    measure_points(network, contacts);
    if (!make_list(network, contacts, reach))
        contacts->count = 0;
    contacts->candidate_count = 0;
    activate_all(contacts);
    contacts->is_listed = contacts->is_fresh = false;
}
