/// Speeds of outline points relative to their mean, and the margins that follow: how far a point must be from
/// another for them not to be a pair.
///
/// Each point has a speed and a margin of its own, so a fast fragment adds its own pairs, and no others. Where all
/// are about equally fast, or too slow to matter, all count as the fastest: then pairs take no values of points.
#include <math.h>

#include "base/cpu.h"
#include "features/contact/contacts.h"

/// Required margin of a point: a share of the thickness, plus the way of these steps; together at most MOST_SHARE
/// of it, but always the way until the next scan.
#define LEAST_SHARE 0.15
#define STEPS_AHEAD 2.0
#define MOST_SHARE 0.5

/// Substeps between two collections of candidates. Fewer if bodies are so fast that pairs within a share of the
/// thickness and more would be candidates.
#define CANDIDATE_SUBSTEPS 8.0
#define MIN_CANDIDATE_SUBSTEPS 4.0
#define CANDIDATE_FRACTION 0.5

/// Constraints reach as far as two points approach in two substeps.
#define SUBSTEPS_BEYOND 2.0

/// Speeds that count in the mean, in units of the mean of all.
#define OUTLIER 4.0

/// All points count as the fastest if that raises the margin of candidates by no more than this factor.
#define UNIFORM_RATIO 2.0

/// Means over points: velocity, and the way since the list was made.
typedef struct mean_motion {
    double vx, vy, wx, wy;
} mean_motion;

// Larger of two values; NaN if the found one is. One velocity that is NaN makes the mean NaN, and so all.
static double max_or_nan(double known, double found) {
    return found <= known ? known : found;
}

// Find positions, velocities, and displacements since the list was made. The arrays of nodes are in use within
// substeps only: here for the motion of points, in their order. shift_x is what turning adds to the speed.
static void load_points(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_state *s = &network->state;
    const uint32_t *slot_of = network->topology.slot_of_particle;
    const uint32_t own = o->point_count - contacts->colliders.point_count;
    const mspringi_contact_nodes *k = &contacts->nodes;
    for (uint32_t i = 0; i < own; ++i) {
        const mspring_id p = o->points[i];
        const uint32_t slot = slot_of[p];
        const double x = mspringi_x_of(s, slot), y = mspringi_y_of(s, slot);
        contacts->x[p] = x;
        contacts->y[p] = y;
        k->v[i].x = (double)s->vx[slot];
        k->v[i].y = (double)s->vy[slot];
        k->x[i] = x - contacts->seen_x[p];
        k->y[i] = y - contacts->seen_y[p];
        k->shift_x[i] = 0.0;
    }
}

static void load_colliders(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_colliders *c = &contacts->colliders;
    const uint32_t own = contacts->outline.point_count - c->point_count;
    const mspringi_contact_nodes *k = &contacts->nodes;
    if (c->count == 0)
        return;
    mspringi_colliders_move_points(network, contacts, contacts->substeps_done);
    for (uint32_t i = 0; i < c->point_count; ++i) {
        const mspring_id p = contacts->particles + i;
        const mspringi_collider *owner = &c->list[c->owner[i]];
        const double u = c->shape[2 * i], v = c->shape[2 * i + 1];
        mspringi_collider_velocity(owner, contacts->dt, &k->v[own + i].x, &k->v[own + i].y);
        contacts->x[p] = c->x[i];
        contacts->y[p] = c->y[i];
        k->x[own + i] = contacts->x[p] - contacts->seen_x[p];
        k->y[own + i] = contacts->y[p] - contacts->seen_y[p];
        k->shift_x[own + i] = fabs(mspringi_collider_spin(owner, contacts->dt)) * sqrt(u * u + v * v);
    }
}

// Means over the points whose speeds are not above `most`.
static mean_motion find_mean(const mspringi_contacts *contacts, double most) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_contact_nodes *k = &contacts->nodes;
    mean_motion sum = {0.0, 0.0, 0.0, 0.0};
    uint32_t count = 0;
    for (uint32_t i = 0; i < o->point_count; ++i) {
        if (contacts->speed[o->points[i]] > most)
            continue;
        sum.vx += k->v[i].x;
        sum.vy += k->v[i].y;
        sum.wx += k->x[i];
        sum.wy += k->y[i];
        ++count;
    }
    const double part = count > 0 ? 1.0 / (double)count : 0.0;
    return (mean_motion){part * sum.vx, part * sum.vy, part * sum.wx, part * sum.wy};
}

// Find speeds and displacements relative to a mean, and the mean of the speeds that are not above `most`.
static void compare_points(mspringi_contacts *contacts, const mean_motion *mean, double most) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_contact_nodes *k = &contacts->nodes;
    double sum = 0.0, max = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < o->point_count; ++i) {
        const mspring_id p = o->points[i];
        const double ux = k->v[i].x - mean->vx, uy = k->v[i].y - mean->vy;
        const double dx = k->x[i] - mean->wx, dy = k->y[i] - mean->wy;
        const double speed = sqrt(ux * ux + uy * uy) + k->shift_x[i];
        contacts->speed[p] = speed;
        contacts->square_moved[p] = dx * dx + dy * dy;
        max = max_or_nan(max, speed);
        sum += speed > most ? 0.0 : speed;
        count += !(speed > most);
    }
    contacts->mean_vx = mean->vx;
    contacts->mean_vy = mean->vy;
    contacts->inner.way_x = mean->wx;
    contacts->inner.way_y = mean->wy;
    contacts->max_speed = max;
    contacts->mean_speed = count > 0 ? sum / (double)count : 0.0;
}

// Fragments may be so fast that a few of them move the means: these leave them out.
void mspringi_points_measure(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    load_points(network, contacts);
    load_colliders(network, contacts);
    mean_motion mean = find_mean(contacts, INFINITY);
    compare_points(contacts, &mean, INFINITY);
    const double most = OUTLIER * contacts->mean_speed;
    if (contacts->max_speed > most) {
        mean = find_mean(contacts, most);
        compare_points(contacts, &mean, most);
    }
    for (uint32_t i = 0; i < o->point_count && contacts->is_second_try; ++i) {
        const mspring_id p = o->points[i];
        if (contacts->extra_speed[p] > contacts->speed[p])
            contacts->speed[p] = contacts->extra_speed[p];
        contacts->max_speed = max_or_nan(contacts->max_speed, contacts->speed[p]);
    }
}

// Choose the substeps until the next scan, no more than a step has, and how far a point may come until then.
static void choose_scan(mspringi_contacts *contacts, double usual_speed, bool scans_each) {
    const double h = (double)contacts->h, thickness = contacts->thickness;
    const mspringi_speed_bound travel = {.at_rest = MSPRINGI_DRIFT_FRACTION * thickness * h / contacts->dt,
                                         .per_speed = MSPRINGI_SPEED_MARGIN * h};
    const double substeps = CANDIDATE_FRACTION * thickness / (2.0 * mspringi_bound_at(&travel, usual_speed)),
                 of_step = contacts->dt / h;
    const double wanted = substeps > CANDIDATE_SUBSTEPS       ? CANDIDATE_SUBSTEPS
                          : substeps > MIN_CANDIDATE_SUBSTEPS ? floor(substeps)
                                                              : MIN_CANDIDATE_SUBSTEPS;
    const double chosen = scans_each          ? 1.0
                          : wanted <= of_step ? wanted
                          : of_step > 1.0     ? -floor(0.5 - of_step) // the nearest whole number
                                              : 1.0;
    contacts->travel = travel;
    contacts->candidate_substeps = chosen;
    contacts->candidate_margin.at_rest = chosen * travel.at_rest + MSPRINGI_NEAR_MISS_FRACTION * thickness;
    contacts->candidate_margin.per_speed = (chosen + SUBSTEPS_BEYOND) * travel.per_speed;
}

void mspringi_points_choose_margins(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_outline *o = &contacts->outline;
    const mspringi_solver *running = network->running ? network->running : &network->solver;
    // An implicit substep may bring any two bodies nearer at the largest speed. In an explicit one, no point counts
    // as slower than the mean: a wave may throw points at rest.
    const bool is_implicit = running->ops->has_implicit_contact;
    choose_scan(contacts, 2.0 * contacts->mean_speed, is_implicit || contacts->is_second_try);
    contacts->is_uniform =
        is_implicit || mspringi_bound_at(&contacts->candidate_margin, contacts->max_speed) <=
                           UNIFORM_RATIO * mspringi_bound_at(&contacts->candidate_margin, contacts->mean_speed);
    contacts->min_speed = contacts->is_uniform ? contacts->max_speed : contacts->mean_speed;
    for (uint32_t i = 0; i < o->point_count; ++i) {
        const mspring_id p = o->points[i];
        contacts->speed[p] = max_or_nan(contacts->speed[p], contacts->min_speed);
    }
}

double mspringi_point_margin(const mspringi_contacts *contacts, double speed) {
    const double thickness = contacts->thickness,
                 until_scan = mspringi_bound_at(&contacts->candidate_margin, speed);
    const double ahead = LEAST_SHARE * thickness + STEPS_AHEAD * contacts->dt * speed;
    const double usual = ahead < MOST_SHARE * thickness || contacts->has_sleepers ? ahead : MOST_SHARE * thickness;
    return usual > until_scan ? usual : until_scan;
}
