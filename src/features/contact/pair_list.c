/// Verlet list of pairs: points near edges. From it follow the candidates, and the substeps in which nothing can
/// touch.
///
/// All motion is relative to the mean of the outline. The list has all pairs whose distance is below the thickness
/// and the margins of both sides, until a point has used up its margin. A point near a faster one counts as as
/// fast, since that may throw it. So the candidates, and the number of quiet substeps, follow from positions and
/// velocities alone, not from when the list was made, nor from how far it reaches.
///
/// mspringi_pair_list_scan calls mspringi_pair_list_refresh. That measures the points (point_speeds.c), makes a new
/// list if the old one may lack pairs (make_list()), and collects the candidates (collect_uniform() or
/// collect_by_speed()).
#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "base/cpu.h"
#include "features/contact/contacts.h"

/// Margins of a new list, as multiples of the required ones. A list with few candidates, one in SPARSE of the
/// outline's points, reaches farther and lasts longer.
#define REACH 2.0
#define SPARSE_REACH 6.0
#define SPARSE 4u

/// Comparisons of points with edges that find no pair, which a step may add for each list and point. (The bodies of
/// tests/features/contact take 20.)
#define WORK_OF_POINT 32

/// Points and pairs that are worth a worker: 50 and 20 us.
#define LEAST_POINTS 64u
#define LEAST_PAIRS 2048u

/* ----------------------------------------------------------------------------------------------------- distance */

// Distance of a point from an edge, or from a collider's surface, m.
MSPRINGI_ALWAYS_INLINE double distance_of(const mspringi_contacts *contacts, mspring_id p, uint32_t edge) {
    const mspring_id a = contacts->outline.a[edge], b = contacts->outline.b[edge];
    const mspringi_closest_point at = mspringi_closest_point_on_edge(
        contacts->x[p], contacts->y[p], contacts->x[a], contacts->y[a], contacts->x[b], contacts->y[b]);
    const double distance = sqrt(at.x * at.x + at.y * at.y);
    return contacts->colliders.count > 0 ? distance - mspringi_radius_of(contacts, p, edge) : distance;
}

/* -------------------------------------------------------------------------------------------------------- list */

// Particles of different groups never touch. Collider points are in no group, so all may touch them.
static bool are_in_one_group(const mspring_network *network, mspring_id p, mspring_id q) {
    const uint32_t *group = network->groups.of_particle, particles = network->topology.particle_count;
    return !group || p >= particles || q >= particles || group[p] == group[q];
}

bool mspringi_may_touch(const mspring_network *network, mspring_id p, mspring_id q) {
    const mspringi_contacts *contacts = network->contacts;
    return contacts->layers[p] & contacts->masks[q] && contacts->layers[q] & contacts->masks[p] &&
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

// True if a point and an edge within reach may touch: then they are a pair.
static bool are_pair(const mspring_network *network, mspringi_contacts *contacts, mspring_id p, uint32_t edge) {
    const mspringi_outline *o = &contacts->outline;
    const mspring_id a = o->a[edge], b = o->b[edge];
    return p != a && p != b && mspringi_may_touch(network, p, a) && mspringi_may_touch(network, p, b) &&
           !is_excluded(network, contacts, p, edge);
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

// Find the edges that a point forms pairs with, in grid.found, but at most room + 1. Return their number.
static uint32_t find_pairs_of_point(const mspring_network *network, mspringi_contacts *contacts, mspring_id p,
                                    uint32_t room) {
    mspringi_edge_grid *grid = &contacts->grid;
    const uint32_t found = mspringi_edge_grid_search(network, contacts, p);
    uint32_t count = 0;
    for (uint32_t k = 0; k < found && count <= room; ++k) {
        grid->found[count] = grid->found[k];
        count += are_pair(network, contacts, p, grid->found[k]);
    }
    contacts->work += found - count;
    MSPRINGI_ASSERT(found <= contacts->outline.edge_count);
    return count;
}

// Add the pairs of a point, by rising edges, if there is room for them and they do not take too long to find.
static mspringi_contact_rejection list_pairs_of_point(const mspring_network *network, mspringi_contacts *contacts,
                                                      mspring_id p) {
    mspringi_edge_grid *grid = &contacts->grid;
    const uint32_t room = contacts->capacity - contacts->count;
    uint32_t close_count = find_pairs_of_point(network, contacts, p, room);
    const bool has_room = close_count <= room;
    close_count = has_room ? close_count : room;
    MSPRINGI_ASSERT(close_count <= contacts->capacity - contacts->count);
    sort(grid->found, close_count);
    for (uint32_t k = 0; k < close_count; ++k)
        contacts->list[contacts->count++] = (mspringi_pair){.point = p, .edge = grid->found[k]};
    return !has_room                               ? MSPRINGI_CONTACT_LACKS_PAIRS
           : contacts->work <= contacts->most_work ? MSPRINGI_CONTACT_SOUND
                                                   : MSPRINGI_CONTACT_LACKS_WORK;
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
    for (uint32_t i = 0; i < contacts->candidate_count && !mspringi_contact_is_rejected(contacts); ++i) {
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
    if (mspringi_contact_is_rejected(contacts))
        contacts->candidate_count = 0;
    for (uint32_t i = 0; i < contacts->candidate_count; ++i) {
        mspringi_candidate *c = &contacts->candidates[i];
        const mspringi_pair *pair = &contacts->list[c->pair];
        c->p = active->number[pair->point];
        c->a = active->number[contacts->outline.a[pair->edge]];
        c->b = active->number[contacts->outline.b[pair->edge]];
        MSPRINGI_ASSERT(c->p < active->count && c->a < active->count && c->b < active->count);
    }
}

// Where a range lists its pairs until they are joined: the candidates are free meanwhile.
static mspringi_pair *piece_of(const mspringi_contacts *contacts, const mspringi_contact_range *range,
                               uint32_t *room) {
    const uint32_t pieces = (range->of + 1) / 2;
    mspringi_pair *spare = (void *)contacts->candidates;
    *room = contacts->capacity / pieces;
    return (range->number < pieces ? contacts->list : spare) + (size_t)(range->number % pieces) * *room;
}

static void list_pairs_of_range(const mspring_network *network, mspringi_contacts *contacts,
                                mspringi_contact_range *range, const void *argument) {
    (void)argument;
    contacts->list = piece_of(contacts, range, &contacts->capacity);
    contacts->count = 0;
    for (uint32_t i = range->first; i < range->end && !mspringi_contact_is_rejected(contacts); ++i) {
        const mspring_id p = contacts->outline.points[i];
        contacts->seen_x[p] = contacts->x[p];
        contacts->seen_y[p] = contacts->y[p];
        contacts->square_moved[p] = 0.0;
        mspringi_contact_reject(contacts, list_pairs_of_point(network, contacts, p));
    }
    range->found = contacts->count;
}

// List the pairs of all points, in their order.
static void list_pairs(const mspring_network *network, mspringi_contacts *contacts) {
    mspringi_contact_range ranges[MSPRINGI_CONTACT_RANGES];
    const uint32_t points = contacts->outline.point_count;
    const uint32_t count = mspringi_contact_divide(network, contacts, points, LEAST_POINTS, contacts->capacity,
                                                   list_pairs_of_range, NULL, ranges);
    for (uint32_t i = 0; i < count && count > 1; ++i) {
        uint32_t room;
        const mspringi_pair *piece = piece_of(contacts, &ranges[i], &room);
        memmove(contacts->list + contacts->count, piece, ranges[i].found * sizeof *piece);
        contacts->count += ranges[i].found;
    }
}

// List all pairs within the margins, if there is room for them and they do not take too long to find.
static mspringi_contact_rejection make_list(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_contact_rejection before = contacts->rejection;
    contacts->rejection = MSPRINGI_CONTACT_SOUND;
    contacts->count = 0;
    contacts->inner.way_x = contacts->inner.way_y = 0.0;
    contacts->stamp_of = MSPRING_NONE;
    contacts->most_work += WORK_OF_POINT * (uint64_t)o->point_count;
    if (o->edge_count > 0) {
        mspringi_edge_grid_fill(network, contacts);
        list_pairs(network, contacts);
    }
    const mspringi_contact_rejection why = contacts->rejection;
    contacts->rejection = before;
    return why;
}

// List all pairs within `ratio` times the margins that points of such speeds need.
static mspringi_contact_rejection make_list_for(const mspring_network *network, mspringi_contacts *contacts,
                                                const double *speed, double ratio) {
    const mspringi_outline *o = &contacts->outline;
    for (uint32_t i = 0; i < o->point_count; ++i)
        contacts->margin[o->points[i]] = ratio * mspringi_point_margin(contacts, speed[o->points[i]]);
    return make_list(network, contacts);
}

// True if the list has all pairs within the margins that points of such speeds need. One that was made while
// numbers overflowed lacks pairs, though nothing leaves an endless margin.
static bool is_complete(const mspringi_contacts *contacts, const double *speed) {
    const mspringi_outline *o = &contacts->outline;
    for (uint32_t i = 0; i < o->point_count; ++i) {
        const mspring_id p = o->points[i];
        const double spare = contacts->margin[p] - mspringi_point_margin(contacts, speed[p]);
        if (!(spare >= 0.0 && spare < INFINITY && contacts->square_moved[p] <= spare * spare))
            return false;
    }
    return true;
}

// Make a new list if this one may lack pairs: with larger margins than needed, if there is room.
static void complete_list(const mspring_network *network, mspringi_contacts *contacts, const double *speed) {
    if (mspringi_contact_is_rejected(contacts) || (contacts->is_listed && is_complete(contacts, speed)))
        return;
    const bool is_sparse =
        contacts->is_listed && SPARSE * (uint64_t)contacts->candidate_count < contacts->outline.point_count;
    mspringi_contact_rejection why = make_list_for(network, contacts, speed, is_sparse ? SPARSE_REACH : REACH);
    if (why != MSPRINGI_CONTACT_SOUND)
        why = make_list_for(network, contacts, speed, 1.0);
    contacts->is_listed = why == MSPRINGI_CONTACT_SOUND;
    mspringi_contact_reject(contacts, why);
}

/* --------------------------------------------------------------------------------------------------- candidates */

// True if both sides of a pair are particles without springs. Find the square of their distance.
MSPRINGI_ALWAYS_INLINE bool are_loose(const mspringi_contacts *contacts, const mspringi_pair *pair,
                                      double *square) {
    const mspring_id p = pair->point, a = contacts->outline.a[pair->edge];
    const double dx = contacts->x[p] - contacts->x[a], dy = contacts->y[p] - contacts->y[a];
    *square = dx * dx + dy * dy;
    return a == contacts->outline.b[pair->edge] && !mspringi_is_collider_point(contacts, p) &&
           !mspringi_is_collider_point(contacts, a);
}

// Whole number of quiet substeps; a single one is not worth it.
static uint32_t substeps_of(double quiet) {
    return quiet >= 2.0 ? quiet < 1e6 ? (uint32_t)quiet : 1000000 : 0;
}

// Collect the candidates, and find the nearest pair, if all points count as equally fast. Pairs of particles
// without springs may be many, so they take neither roots nor branches.
static void collect_uniform(mspringi_contacts *contacts) {
    const double most =
        contacts->thickness + 2.0 * mspringi_bound_at(&contacts->candidate_margin, contacts->max_speed);
    const double complete = contacts->thickness + 2.0 * mspringi_point_margin(contacts, contacts->max_speed);
    double least = complete * complete, nearest = complete, square;
    uint32_t count = 0;
    for (uint32_t i = 0; i < contacts->count; ++i) {
        contacts->candidates[count].pair = i;
        if (are_loose(contacts, &contacts->list[i], &square)) {
            least = square >= least ? least : square;
            count += !(square > most * most);
            continue;
        }
        const double distance = distance_of(contacts, contacts->list[i].point, contacts->list[i].edge);
        nearest = distance >= nearest ? nearest : distance;
        count += !(distance > most);
    }
    least = sqrt(least);
    contacts->candidate_count = count;
    contacts->nearest = least >= nearest ? nearest : least;
    contacts->least_gap = contacts->nearest - contacts->thickness;
    contacts->quiet_at_scan =
        substeps_of(contacts->least_gap / (2.0 * mspringi_bound_at(&contacts->travel, contacts->max_speed)));
    contacts->has_distances = false;
}

static void measure_range(const mspring_network *network, mspringi_contacts *contacts,
                          mspringi_contact_range *range, const void *argument) {
    (void)network, (void)argument;
    for (uint32_t i = range->first; i < range->end; ++i) {
        mspringi_pair *pair = &contacts->list[i];
        double square;
        pair->distance =
            (float)(are_loose(contacts, pair, &square) ? sqrt(square)
                                                       : distance_of(contacts, pair->point, pair->edge));
    }
}

static void measure_pairs(const mspring_network *network, mspringi_contacts *contacts) {
    mspringi_contact_range ranges[MSPRINGI_CONTACT_RANGES];
    (void)mspringi_contact_divide(network, contacts, contacts->count, LEAST_PAIRS, contacts->capacity,
                                  measure_range, NULL, ranges);
    contacts->has_distances = true;
}

// Have each point count as fast as the fastest that it may meet before the next scan, where that is much faster.
// Return true if this concerns any.
static bool pass_speeds_on(mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    const double *speed = contacts->speed, negligible = MSPRINGI_SPEED_MARGIN * contacts->min_speed;
    double *assumed = contacts->assumed_speed;
    bool any = false;
    for (uint32_t i = 0; i < o->point_count; ++i)
        assumed[o->points[i]] = speed[o->points[i]];
    for (uint32_t i = 0; i < contacts->count; ++i) {
        const mspringi_pair *pair = &contacts->list[i];
        const mspring_id p = pair->point, a = o->a[pair->edge], b = o->b[pair->edge];
        const double of_edge = speed[a] > speed[b] ? speed[a] : speed[b],
                     most = of_edge > speed[p] ? of_edge : speed[p];
        if (most <= negligible)
            continue;
        const double of_ends = speed[a] < speed[b] ? speed[a] : speed[b],
                     least = of_ends < speed[p] ? of_ends : speed[p];
        if (most <= MSPRINGI_SPEED_MARGIN * least ||
            !((double)pair->distance <= contacts->thickness + mspringi_point_margin(contacts, speed[p]) +
                                            mspringi_point_margin(contacts, of_edge)))
            continue;
        assumed[p] = assumed[p] > most ? assumed[p] : most;
        assumed[a] = assumed[a] > most ? assumed[a] : most;
        assumed[b] = assumed[b] > most ? assumed[b] : most;
        any = true;
    }
    return any;
}

// Collect the candidates by the speeds of their points, and find for how many substeps none can touch.
static void collect_by_speed(mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_speed_bound *margin = &contacts->candidate_margin, *travel = &contacts->travel;
    double quiet = 1e6, nearest = INFINITY;
    uint32_t count = 0;
    for (uint32_t i = 0; i < contacts->count; ++i) {
        const mspringi_pair *pair = &contacts->list[i];
        const double speeds = mspringi_speeds_of(contacts, contacts->assumed_speed, pair);
        const double distance = (double)pair->distance, gap = distance - contacts->thickness,
                     way = 2.0 * travel->at_rest + travel->per_speed * speeds;
        contacts->candidates[count].pair = i;
        count += !(gap > 2.0 * margin->at_rest + margin->per_speed * speeds);
        if (!(gap >= quiet * way))
            quiet = gap / way;
        nearest = distance >= nearest ? nearest : distance;
    }
    for (uint32_t i = 0; i < o->point_count && quiet >= 2.0; ++i) { // pairs outside the list
        const double speed = contacts->assumed_speed[o->points[i]], gap = mspringi_point_margin(contacts, speed),
                     way = mspringi_bound_at(travel, speed);
        quiet = gap >= quiet * way ? quiet : gap / way;
    }
    contacts->candidate_count = count;
    contacts->nearest = nearest;
    contacts->least_gap = nearest - contacts->thickness;
    contacts->quiet_at_scan = substeps_of(quiet);
}

// True if a pair without constraints could have touched in the last substeps at the speeds of now, by the distances
// and margins of the last scan: in quiet ones any, in others one that was no candidate.
static bool could_have_touched(const mspringi_contacts *contacts, uint32_t substeps, bool are_quiet) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_speed_bound *margin = &contacts->candidate_margin;
    const double seconds = (double)contacts->h * (double)substeps;
    if (!contacts->has_distances)
        return !(seconds * contacts->max_speed <=
                 (are_quiet ? 0.5 * contacts->least_gap : mspringi_bound_at(margin, contacts->min_speed)));
    for (uint32_t i = 0; i < contacts->count; ++i) {
        const mspringi_pair *pair = &contacts->list[i];
        const double gap = (double)pair->distance - contacts->thickness;
        if (!(seconds * mspringi_speeds_of(contacts, contacts->speed, pair) <= gap) &&
            (are_quiet ||
             gap > 2.0 * margin->at_rest +
                       margin->per_speed * mspringi_speeds_of(contacts, contacts->assumed_speed, pair)))
            return true;
    }
    for (uint32_t i = 0; i < o->point_count; ++i) { // pairs outside the list
        const mspring_id p = o->points[i];
        if (!(seconds * contacts->speed[p] <= mspringi_point_margin(contacts, contacts->assumed_speed[p])))
            return true;
    }
    return false;
}

// The step will be repeated: its scans are to assume what points reach by forces that they cannot know. Beyond
// max_speed the motion is at fault, not the scan.
static void assume_speeds(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    for (uint32_t i = 0; i < o->point_count && !contacts->is_second_try; ++i) {
        const mspring_id p = o->points[i];
        if (contacts->speed[p] > contacts->extra_speed[p] &&
            contacts->speed[p] <= (double)network->settings.max_speed)
            contacts->extra_speed[p] = contacts->speed[p];
    }
    contacts->is_missed = contacts->has_extra_speed = true;
}

static void measure(const mspring_network *network, mspringi_contacts *contacts, uint32_t quiet) {
    mspringi_points_measure(network, contacts);
    const uint32_t solved = contacts->solved_substeps;
    if (contacts->is_listed && ((quiet > 0 && could_have_touched(contacts, quiet, true)) ||
                                (solved > 0 && could_have_touched(contacts, solved, false))))
        assume_speeds(network, contacts);
    contacts->solved_substeps = 0;
}

void mspringi_pair_list_check_speeds(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    const uint32_t own = o->point_count - contacts->colliders.point_count;
    const double seconds = (double)contacts->h * (double)contacts->solved_substeps;
    for (uint32_t i = 0; i < own; ++i) {
        const mspring_id p = o->points[i];
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double x = (double)network->state.vx[slot] - contacts->mean_vx,
                     y = (double)network->state.vy[slot] - contacts->mean_vy,
                     assumed = contacts->is_uniform ? contacts->min_speed : contacts->assumed_speed[p],
                     most = mspringi_bound_at(&contacts->candidate_margin, assumed);
        if (!(seconds * seconds * (x * x + y * y) <= most * most)) {
            measure(network, contacts, 0);
            return;
        }
    }
}

bool mspringi_pair_list_refresh(const mspring_network *network, mspringi_contacts *contacts, uint32_t quiet) {
    measure(network, contacts, quiet);
    mspringi_points_choose_margins(network, contacts);
    complete_list(network, contacts, contacts->speed);
    if (contacts->is_listed && !contacts->is_uniform) {
        measure_pairs(network, contacts);
        if (pass_speeds_on(contacts) && !is_complete(contacts, contacts->assumed_speed)) {
            complete_list(network, contacts, contacts->assumed_speed);
            measure_pairs(network, contacts);
        }
    }
    if (!mspringi_contact_is_rejected(contacts)) {
        if (contacts->is_uniform)
            collect_uniform(contacts);
        else
            collect_by_speed(contacts);
        mspringi_inner_points_add(network, contacts);
    }
    const bool is_rejected = mspringi_contact_is_rejected(contacts);
    if (is_rejected) // The other substeps of the step have no candidates: these were of another list.
        contacts->candidate_count = 0;
    activate_all(contacts);
    if (is_rejected)
        return false;
    contacts->substeps_to_refresh = (uint32_t)contacts->candidate_substeps;
    return true;
}

/* -------------------------------------------------------------------------------------------------------- scan */

bool mspringi_pair_list_scan(const mspring_network *network, mspringi_contacts *contacts, uint32_t quiet) {
    const bool is_same = contacts->is_fresh && contacts->scan_h == contacts->h &&
                         contacts->scan_dt == contacts->dt && contacts->state == network->edits.state &&
                         contacts->sleep_changes == network->edits.sleep_changes && !network->is_open;
    if (!is_same) {
        if (!mspringi_pair_list_refresh(network, contacts, quiet))
            return false;
        contacts->is_fresh = true;
        contacts->scan_h = contacts->h;
        contacts->scan_dt = contacts->dt;
        contacts->state = network->edits.state;
        contacts->sleep_changes = network->edits.sleep_changes;
    }
    contacts->quiet_substeps = contacts->is_second_try ? 0 : contacts->quiet_at_scan;
    return true;
}

void mspringi_near_begin(const mspring_network *network, mspringi_contacts *contacts, double reach) {
    const mspringi_outline *o = &contacts->outline;
    mspringi_outline_update(network, contacts);
    mspringi_points_measure(network, contacts);
    for (uint32_t i = 0; i < o->point_count; ++i)
        contacts->margin[o->points[i]] = 0.5 * (reach - contacts->thickness);
    contacts->inner.way_x = contacts->inner.way_y = 0.0;
    contacts->stamp_of = MSPRING_NONE;
    contacts->work = 0;
    contacts->most_work = MSPRINGI_MOST_COMPARISONS + WORK_OF_POINT * (uint64_t)o->point_count;
    contacts->count = contacts->candidate_count = 0;
    activate_all(contacts);
    contacts->is_listed = contacts->is_fresh = false;
    if (o->edge_count > 0)
        mspringi_edge_grid_fill(network, contacts);
}

uint32_t mspringi_near_edges(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    const mspringi_contact_rejection before = contacts->rejection;
    if (contacts->outline.edge_count == 0 || contacts->work > contacts->most_work)
        return 0;
    const uint32_t count = find_pairs_of_point(network, contacts, p, contacts->outline.edge_count);
    contacts->rejection = before;
    return count;
}
