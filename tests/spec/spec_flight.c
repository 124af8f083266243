/// @file spec_flight.c
/// Specification of particles without springs where there is a floor: parabolas that change direction where they meet
/// a surface. In double precision.
///
/// A particle that its own speed and the forces on it could bring to the floor takes the substeps one by one, others
/// all of them together: see spec_may_meet_floor().
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "spec_floor.h"

/// Most deflections in a substep.
#define MOST_DEFLECTIONS 8

/// A particle on a parabola.
typedef struct flyer {
    double x, y;
    double wx, wy; ///< velocity at this place, not half a substep ago, m/s
    double ax, ay; ///< acceleration, m/s^2; 0 once it lies on a surface
    double left;   ///< rest of the substep, s
} flyer;

static spec_plane plane_below(const spec_network *network, double x) {
    return spec_plane_of(&network->heights, spec_part_below(&network->heights, x));
}

static void find_end(const flyer *f, double *x, double *y) {
    *x = f->x + f->left * (f->wx + 0.5 * f->left * f->ax);
    *y = f->y + f->left * (f->wy + 0.5 * f->left * f->ay);
}

// Time until a particle meets a surface that it would end below, s, or INFINITY.
static double time_to(const spec_plane *plane, double slop, const flyer *f) {
    const double distance = spec_distance_from(plane, f->x, f->y), above = fmax(distance, 0.0);
    const double speed = plane->nx * f->wx + plane->ny * f->wy, pull = plane->nx * f->ax + plane->ny * f->ay;
    const double root = sqrt(fmax(speed * speed - 2.0 * pull * above, 0.0));
    const double way = speed <= 0.0 ? 2.0 * above : speed + root, rate = speed <= 0.0 ? root - speed : -pull;
    const double time = rate > 0.0 ? fmax(way / rate, 0.0) : 0.0;
    return distance + f->left * (speed + 0.5 * f->left * pull) < -slop ? fmin(time, f->left) : INFINITY;
}

// The surface that a particle meets first, and when. One above it does not count.
static spec_plane find_first(const spec_network *network, double slop, const flyer *f, double *time) {
    spec_plane surfaces[10], first = {0};
    uint32_t count = 0;
    for (; count < network->plane_count; count++) {
        surfaces[count] = network->planes[count];
    }
    if (network->heights.count > 0) {
        double x, y;
        find_end(f, &x, &y);
        surfaces[count++] = spec_first_hit(&network->heights, f->x, f->y, x, y);
        surfaces[count++] = plane_below(network, x);
    }
    *time = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const double at = time_to(&surfaces[i], slop, f);
        if (spec_distance_from(&surfaces[i], f->x, f->y) >= -spec_slop_at(f->x, f->y) && at < *time) {
            *time = at;
            first = surfaces[i];
        }
    }
    return first;
}

// Deflect a particle where it meets a surface. It bounces, or lies on the surface for the rest of the substep if the
// bounce would be shorter than a substep, or in the last deflection. skew: half a substep, s.
static void deflect(const spec_plane *plane, double time, double skew, bool is_last, flyer *f) {
    const double nx = plane->nx, ny = plane->ny, wx = f->wx + time * f->ax, wy = f->wy + time * f->ay;
    const double x = f->x + time * (f->wx + 0.5 * time * f->ax), y = f->y + time * (f->wy + 0.5 * time * f->ay);
    const double normal = nx * wx + ny * wy, along = nx * wy - ny * wx, distance = spec_distance_from(plane, x, y);
    const double pull = nx * f->ax + ny * f->ay, pull_along = nx * f->ay - ny * f->ax;
    const double inward = normal < 0.0 ? -normal : 0.0, pressing = pull < 0.0 ? -pull : 0.0;
    const double bounce = plane->restitution * inward, left = f->left - time, rest = left - skew;
    const bool rests = is_last || bounce <= skew * pressing + 0x1p-22 * fabs(along);
    const double change = rests ? fmax(inward - rest * pull, 0.0) : bounce + inward;
    const double slide = rests ? along + rest * pull_along : along, most = plane->friction * change;
    const double braked = slide - (slide > most ? most : slide < -most ? -most : slide), out = rests ? 0.0 : bounce;
    *f = (flyer){x - distance * nx,
                 y - distance * ny,
                 out * nx - braked * ny,
                 out * ny + braked * nx,
                 rests ? 0.0 : f->ax,
                 rests ? 0.0 : f->ay,
                 is_last ? 0.0 : left};
}

// Push a particle out of the floor. Its speed pays for the lift.
static bool push_out(const spec_network *network, flyer *f) {
    const double x = f->x, y = f->y, square = f->wx * f->wx + f->wy * f->wy;
    if (!spec_put_outside(network, &f->x, &f->y)) {
        return false;
    }
    const double left = square + 2.0 * (f->ax * (f->x - x) + f->ay * (f->y - y));
    const double keep = !(left < square) ? 1.0 : left > 0.0 ? sqrt(left / square) : 0.0;
    f->wx *= keep;
    f->wy *= keep;
    return true;
}

// A particle that lay on a part of the heights, and goes to another, loses its velocity across: that of half a
// substep.
static bool leave_part(const spec_network *network, double skew, double slop, flyer *f) {
    double x, y;
    find_end(f, &x, &y);
    if (network->heights.count == 0 ||
        spec_part_below(&network->heights, x) == spec_part_below(&network->heights, f->x)) {
        return false;
    }
    const spec_plane part = plane_below(network, f->x);
    const double across = part.nx * f->wx + part.ny * f->wy, along = part.nx * f->wy - part.ny * f->wx;
    const double pull = part.nx * f->ax + part.ny * f->ay;
    const bool lay = spec_distance_from(&part, f->x, f->y) <= slop && across < 0.0 &&
                     -across <= -skew * pull + 0x1p-22 * fabs(along);
    f->wx -= lay ? across * part.nx : 0.0;
    f->wy -= lay ? across * part.ny : 0.0;
    return lay;
}

// Share of its velocity that a particle keeps that met a surface while it lay on another: it must not end with more
// energy than it began with.
static double kept_of(const flyer *start, const flyer *end, double since, double x, double y) {
    const double vx = end->wx + since * end->ax, vy = end->wy + since * end->ay, square = vx * vx + vy * vy;
    const double late = end->left - since, wx = vx + late * end->ax, wy = vy + late * end->ay;
    const double fallen = start->ax * (x - start->x) + start->ay * (y - start->y);
    const double most = start->wx * start->wx + start->wy * start->wy + 2.0 * fallen;
    const double gained = wx * wx + wy * wy - most * SPEC_GROWTH;
    return !(gained > 0.0) ? 1.0 : square > gained ? sqrt(1.0 - gained / square) : 0.0;
}

// Half a substep ago a particle that has slid off its surface was not pulled across its way.
static void leave_surface(const spec_network *network, double skew, const flyer *start, const flyer *end,
                          spec_bounce *to) {
    const double square = end->wx * end->wx + end->wy * end->wy;
    if (end->ax == 0.0 && end->ay == 0.0 && square > 0.0 &&
        spec_distance_from_all(network, to->x, to->y) > spec_slop_at(to->x, to->y)) {
        const double along = (start->ax * end->wx + start->ay * end->wy) / square;
        to->vx -= skew * (start->ax - along * end->wx);
        to->vy -= skew * (start->ay - along * end->wy);
    }
}

static flyer flyer_of(const spec_network *network, uint32_t p, double h, double keep, double scale) {
    const spec_motion *m = &network->motions[p], *from = &network->before[p];
    const double vx = (double)m->velocity.x, vy = (double)m->velocity.y;
    const double change_x = scale * (vx - keep * (double)from->velocity.x),
                 change_y = scale * (vy - keep * (double)from->velocity.y);
    return (flyer){(double)m->place.x - h * vx,
                   (double)m->place.y - h * vy,
                   vx - 0.5 * change_x,
                   vy - 0.5 * change_y,
                   change_x / h,
                   change_y / h,
                   h};
}

spec_bounce spec_fly(const spec_network *network, uint32_t particle, double h, double keep, double scale) {
    flyer f = flyer_of(network, particle, h, keep, scale);
    const double slop = 0x1p-31 * (fabs(f.x) + fabs(f.y)) + 1e-15, skew = 0.5 * h;
    spec_bounce to = {0};
    find_end(&f, &to.x, &to.y);
    to.acts = spec_distance_from_all(network, to.x, to.y) < 0.0 && push_out(network, &f);
    to.acts |= leave_part(network, skew, slop, &f);
    const flyer start = f;
    double time, restitution = 0.0; // of the last surface
    spec_plane met = find_first(network, slop, &f, &time);
    bool has_slid = false;
    for (int turn = 1; turn <= MOST_DEFLECTIONS && time < INFINITY; turn++) {
        to.acts = true;
        has_slid |= turn > 1 && f.ax == 0.0 && f.ay == 0.0;
        restitution = met.restitution;
        deflect(&met, time, skew, turn == MOST_DEFLECTIONS, &f);
        met = find_first(network, slop, &f, &time);
    }
    find_end(&f, &to.x, &to.y);
    const double since = f.left - skew, kept = has_slid ? kept_of(&start, &f, since, to.x, to.y) : 1.0;
    to.vx = kept * (f.wx + since * f.ax);
    to.vy = kept * (f.wy + since * f.ay);
    leave_surface(network, skew, &start, &f, &to);
    if (kept == 0.0 || !(spec_distance_from_all(network, to.x, to.y) >= -spec_slop_at(to.x, to.y))) {
        // A corner that leads nowhere: it stays, and its velocity turns back.
        const double e = restitution > SPEC_NO_RESTITUTION ? restitution : 0.0;
        to = (spec_bounce){to.acts, start.x, start.y, 0.0, 0.0};
        to.vx = e > 0.0 ? -e * start.wx - skew * start.ax : 0.0;
        to.vy = e > 0.0 ? -e * start.wy - skew * start.ay : 0.0;
    }
    return to;
}

// Twice the way by the present speed, gravity and the force from outside, the first kick included, and rounding.
bool spec_may_meet_floor(const spec_network *network, uint32_t particle, double seconds) {
    const spec_motion *m = &network->motions[particle];
    const spec_vector force = network->fields[particle];
    const float fastest = fmaxf(fabsf(m->velocity.x), fabsf(m->velocity.y));
    const float outside = fmaxf(fabsf(force.x), fabsf(force.y)) * network->inverse_masses[particle];
    const double x = (double)m->place.x, y = (double)m->place.y;
    const double push = fabs((double)network->gravity_x) + fabs((double)network->gravity_y) + (double)outside;
    const double way = 2.0 * seconds * ((double)fastest + push * (seconds + (double)network->lag));
    const double reach = way + (double)network->grid + spec_slop_at(x, y);
    bool may_meet = false;
    for (uint32_t i = 0; i < network->plane_count; i++) {
        may_meet |= !(spec_distance_from(&network->planes[i], x, y) >= reach);
    }
    if (network->heights.count > 0) {
        const spec_heights *h = &network->heights;
        const int64_t first = spec_part_below(h, x - reach), last = spec_part_below(h, x + reach) + 1;
        double highest = -INFINITY;
        for (int64_t knot = first < 0 ? 0 : first; knot <= last && knot < (int64_t)h->count; knot++) {
            highest = fmax(highest, (double)h->heights[knot]);
        }
        may_meet |= !(y - (h->local_y + highest) >= reach);
    }
    return may_meet && network->inverse_masses[particle] > 0.0f;
}
