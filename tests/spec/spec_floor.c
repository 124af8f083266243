/// @file spec_floor.c
/// Specification of the floor: half-planes and a field of heights in explicit substeps, in double precision, for
/// particles with springs.
///
/// The floor acts in each substep. The library leaves it out where all are too far to reach it at twice the largest
/// speed before a step, or at the largest one after it. So it may miss a particle that springs drive into the floor
/// and out again within a step, if it is slow before and after: as after a period of a vibration. No random network
/// has shown that.
///
/// SPDX-License-Identifier: MIT
#include "spec_floor.h"

#include <math.h>
#include <stddef.h>

// A particle that the floor may act on, before its move. w = v - half is its velocity in step with its position: an
// impulse changes w alone, and contact never makes |w| grow, but for slack.
//
// Slack: where the substep before was shorter, of length l, |w|^2 may grow by (1 - (l/h)^2) |half|^2, once in a
// substep. So a particle at rest, v' = 0, may stay at rest, whose w grows with half.
typedef struct bouncer {
    double x, y, vx, vy;
    double half_x, half_y;  ///< half of its change of velocity by forces in the substep
    double max_restitution; ///< less where it moves a large part of a spring's length in a substep
    double slack;           ///< 1 - (l/h)^2, or 0
    double spare;           ///< growth of |w|^2 that is left: 0 once a surface has acted
} bouncer;

// The square of w with what it may grow by.
static double square_of(const bouncer *b) {
    const double wx = b->vx - b->half_x, wy = b->vy - b->half_y;
    return (wx * wx + wy * wy) + b->spare;
}

// 1 - (l/h)^2 where the substep before was shorter: forces have acted for (l + h) / 2, which damping makes
// -log(keep) / (1 - keep) h / scale. 0 if it was not by more than rounding, or if damping takes more than 5 %.
static double slack_of(double keep, double scale) {
    const double u = 1.0 - keep;
    if (scale <= 1.0 || !(u < 0.05)) {
        return 0.0;
    }
    double series = 1.0 / 6;
    for (int divisor = 5; divisor >= 1; divisor--) {
        series = 1.0 / divisor + u * series;
    }
    const double share = 2.0 * series / scale - 1.0;
    return share < 1.0 - 1e-5 ? 1.0 - share * share : 0.0;
}

static bouncer bouncer_of(const spec_network *network, uint32_t p, double h, double keep, double scale) {
    const spec_motion *m = &network->motions[p], *from = &network->before[p];
    const double vx = (double)m->velocity.x, vy = (double)m->velocity.y, per_length = 4.0 * h / network->shortest;
    bouncer b = {.x = (double)m->place.x - h * vx,
                 .y = (double)m->place.y - h * vy,
                 .vx = vx,
                 .vy = vy,
                 .half_x = 0.5 * (scale * (vx - keep * (double)from->velocity.x)),
                 .half_y = 0.5 * (scale * (vy - keep * (double)from->velocity.y))};
    const double most = 1.0 - per_length * per_length * square_of(&b);
    b.max_restitution = most > 0.0 ? most : 0.0;
    b.slack = slack_of(keep, scale);
    b.spare = b.slack * (b.half_x * b.half_x + b.half_y * b.half_y);
    return b;
}

double spec_distance_from(const spec_plane *plane, double x, double y) {
    return plane->nx * x + plane->ny * y + plane->offset;
}

double spec_slop_at(double x, double y) {
    return 0x1p-21 * (fabs(x) + fabs(y)) + 1e-12;
}

/* ------------------------------------------------------------------------------------------------------ heights */

int64_t spec_part_below(const spec_heights *h, double x) {
    const double place = (x - h->local_x) / h->spacing;
    return !(place >= 0.0) ? -1 : place < (double)(h->count - 1) ? (int64_t)place : (int64_t)h->count - 1;
}

static double knot_x(const spec_heights *h, int64_t knot) {
    return h->local_x + (double)knot * h->spacing;
}

static double knot_y(const spec_heights *h, int64_t knot) {
    return h->local_y + (double)h->heights[knot];
}

spec_plane spec_plane_of(const spec_heights *h, int64_t part) {
    const int64_t last = (int64_t)h->count - 2, sloping = part < 0 ? 0 : part < last ? part : last;
    const double rise = (double)h->heights[sloping + 1] - (double)h->heights[sloping];
    const double length = sqrt(h->spacing * h->spacing + rise * rise);
    spec_plane plane = {.nx = -rise / length,
                        .ny = h->spacing / length,
                        .friction = h->frictions != NULL ? (double)h->frictions[sloping] : h->friction,
                        .restitution = h->restitutions != NULL ? (double)h->restitutions[sloping] : h->restitution};
    plane.offset = -(plane.nx * knot_x(h, sloping) + plane.ny * knot_y(h, sloping));
    if (part != sloping) {
        plane.nx = 0.0;
        plane.ny = 1.0;
        plane.offset = -knot_y(h, part < 0 ? 0 : last + 1);
    }
    return plane;
}

spec_plane spec_first_hit(const spec_heights *h, double from_x, double from_y, double x, double y) {
    const int64_t first = spec_part_below(h, from_x), last = spec_part_below(h, x), onward = first < last ? 1 : -1;
    const double along_x = x - from_x, along_y = y - from_y, slop = spec_slop_at(x, y);
    for (int64_t edge = first; edge != last; edge += onward) {
        const int64_t knot = onward > 0 ? edge + 1 : edge;
        const double share = (knot_x(h, knot) - from_x) / along_x;
        if (from_y + share * along_y < knot_y(h, knot) - slop) {
            return spec_plane_of(h, edge);
        }
    }
    return spec_plane_of(h, last);
}

static spec_plane plane_below(const spec_network *network, double x) {
    return spec_plane_of(&network->heights, spec_part_below(&network->heights, x));
}

double spec_distance_from_all(const spec_network *network, double x, double y) {
    double least = INFINITY;
    for (uint32_t i = 0; i < network->plane_count; i++) {
        least = fmin(least, spec_distance_from(&network->planes[i], x, y));
    }
    if (network->heights.count > 0) {
        const spec_plane below = plane_below(network, x);
        least = fmin(least, spec_distance_from(&below, x, y));
    }
    return least;
}

/* ------------------------------------------------------------------------------------------------------- bounce */

// Let a surface act on a particle that would end more than `allowed` below it. If it is fast enough to leave, it
// bounces from where it is; else it lands on the surface. Friction brakes it along the surface, by its coefficient
// times the change across, and in step not beyond the speed that it had along it, with slack.
static bool bounce(const spec_plane *plane, double h, double allowed, bouncer *b) {
    const double nx = plane->nx, ny = plane->ny;
    const double distance = nx * b->x + ny * b->y + plane->offset, normal_speed = nx * b->vx + ny * b->vy;
    if (!(distance + h * normal_speed < -allowed)) {
        return false;
    }
    const double depth = distance < 0.0 ? distance : 0.0;
    const double half = nx * b->half_x + ny * b->half_y, inward = half - normal_speed;
    const double e = plane->restitution < b->max_restitution ? plane->restitution : b->max_restitution;
    const double bounce_speed = e * inward + half, landing_speed = (depth - distance) / h;
    const bool bounces = inward > 0.0 && bounce_speed > landing_speed && e > SPEC_NO_RESTITUTION;
    const double wanted = bounces ? bounce_speed : landing_speed;
    const double normal_change = (wanted > normal_speed ? wanted : normal_speed) - normal_speed;
    const double speed = nx * b->vy - ny * b->vx, half_along = nx * b->half_y - ny * b->half_x;
    const double in_step = speed - half_along, square = in_step * in_step + b->slack * (half_along * half_along);
    const double most_friction = plane->friction * normal_change,
                 most = b->slack > 0.0 ? sqrt(square) : fabs(in_step);
    const double friction = speed > most_friction ? most_friction : speed < -most_friction ? -most_friction : speed;
    const double braked = in_step - friction;
    const double end = fabs(braked) > most * SPEC_GROWTH ? (braked > 0.0 ? most : -most) : braked, brake = in_step - end;
    b->vx = b->vx + (normal_change * nx + brake * ny);
    b->vy = b->vy + (normal_change * ny - brake * nx);
    b->x = b->x - depth * nx;
    b->y = b->y - depth * ny;
    b->spare = 0.0;
    return true;
}

/// Rounds of all planes for one particle. Corners need more than one.
#define ROUNDS_OF_PLANES 4

static void put_onto(const spec_plane *plane, double *x, double *y) {
    const double distance = spec_distance_from(plane, *x, *y);
    *x -= distance < 0.0 ? distance * plane->nx : 0.0;
    *y -= distance < 0.0 ? distance * plane->ny : 0.0;
}

// Put a point that is inside the floor onto its surfaces, in one more round than a bounce takes. In the last round
// the heights lift it straight up.
bool spec_put_outside(const spec_network *network, double *x, double *y) {
    const double slop = spec_slop_at(*x, *y);
    bool was_inside = false;
    for (int round = 0; round <= ROUNDS_OF_PLANES && spec_distance_from_all(network, *x, *y) < -slop; round++) {
        was_inside = true;
        for (uint32_t i = 0; i < network->plane_count; i++) {
            put_onto(&network->planes[i], x, y);
        }
        if (network->heights.count > 0) {
            const spec_plane below = plane_below(network, *x);
            if (round < ROUNDS_OF_PLANES) {
                put_onto(&below, x, y);
            } else {
                *y = fmax(*y, -(below.nx * *x + below.offset) / below.ny);
            }
        }
    }
    return was_inside;
}

// True if a particle ends outside, and passes through no part of the heights.
static bool ends_outside(const spec_network *network, double h, const bouncer *b) {
    const double x = b->x + h * b->vx, y = b->y + h * b->vy, slop = spec_slop_at(x, y);
    if (!(spec_distance_from_all(network, x, y) >= -slop)) {
        return false;
    }
    const spec_plane met =
        network->heights.count > 0 ? spec_first_hit(&network->heights, b->x, b->y, x, y) : (spec_plane){0};
    return network->heights.count == 0 || spec_distance_from(&met, x, y) >= -slop;
}

// Let all surfaces act once, of the heights the part that the particle meets on its way, or else the one below its
// end.
static bool bounce_at_all(const spec_network *network, double h, double allowed, bouncer *b) {
    bool acts = false;
    for (uint32_t i = 0; i < network->plane_count; i++) {
        acts |= bounce(&network->planes[i], h, allowed, b);
    }
    if (network->heights.count > 0) {
        const double x = b->x + h * b->vx, y = b->y + h * b->vy;
        const spec_plane met = spec_first_hit(&network->heights, b->x, b->y, x, y), below = plane_below(network, x);
        acts |= bounce(&met, h, allowed, b) || bounce(&below, h, allowed, b);
    }
    return acts;
}

// The rare cases: a particle that was below a plane, that has slack or became faster, or that is in a corner.
static bool bounce_with_care(const spec_network *network, double h, const spec_motion *from, bouncer *b) {
    const double slop = spec_slop_at(b->x, b->y), most = square_of(b);
    const bool ends_inside = spec_distance_from_all(network, b->x + h * b->vx, b->y + h * b->vy) < 0.0;
    const bool was_inside = ends_inside && spec_put_outside(network, &b->x, &b->y);
    bool acts = was_inside, goes_on = true;
    for (int round = 0; round < ROUNDS_OF_PLANES && goes_on; round++) {
        goes_on = bounce_at_all(network, h, round == 0 ? 0.0 : slop, b);
        acts |= goes_on;
    }
    const double square = square_of(b);
    if (acts && !was_inside && square > most * SPEC_GROWTH) {
        const double keep = sqrt(most / square);
        b->vx = b->half_x + keep * (b->vx - b->half_x);
        b->vy = b->half_y + keep * (b->vy - b->half_y);
    }
    if (!acts || ends_outside(network, h, b)) {
        return acts;
    }
    b->vx = -(double)from->velocity.x; // a corner that leads nowhere: back to where it came from, or no further
    b->vy = -(double)from->velocity.y;
    if (!ends_outside(network, h, b)) {
        b->vx = b->vy = 0.0;
    }
    return true;
}

// True if a particle, or its end, is not above or below this part.
static bool has_left(const spec_network *network, int64_t part, double h, const bouncer *b) {
    return spec_part_below(&network->heights, b->x) != part || spec_part_below(&network->heights, b->x + h * b->vx) != part;
}

// The common case: each plane acts once, then the part of the heights below the end. Others begin anew, with care.
spec_bounce spec_touch_floor(const spec_network *network, uint32_t p, double h, double keep, double scale) {
    const bool has_heights = network->heights.count > 0;
    const bouncer start = bouncer_of(network, p, h, keep, scale);
    const double slop = spec_slop_at(start.x, start.y);
    bouncer b = start;
    bool acts = false, needs_care = false;
    const int64_t part = has_heights ? spec_part_below(&network->heights, b.x + h * b.vx) : 0;
    const spec_plane below = has_heights ? spec_plane_of(&network->heights, part) : (spec_plane){0};
    needs_care |= has_heights && has_left(network, part, h, &b);
    for (uint32_t i = 0; i < network->plane_count; i++) {
        needs_care |= spec_distance_from(&network->planes[i], b.x, b.y) < -slop;
        acts |= bounce(&network->planes[i], h, 0.0, &b);
    }
    if (has_heights) {
        needs_care |= has_left(network, part, h, &b) || spec_distance_from(&below, b.x, b.y) < -slop;
        acts |= bounce(&below, h, 0.0, &b);
        needs_care |= has_left(network, part, h, &b);
    }
    needs_care |= acts && (start.slack > 0.0 || square_of(&b) >= square_of(&start) * SPEC_GROWTH);
    if (network->plane_count + has_heights > 1) {
        const double x = b.x + h * b.vx, y = b.y + h * b.vy;
        for (uint32_t i = 0; i < network->plane_count; i++) {
            needs_care |= spec_distance_from(&network->planes[i], x, y) < -0.25 * slop;
        }
        needs_care |= has_heights && spec_distance_from(&below, x, y) < -0.25 * slop;
    }
    if (needs_care) {
        b = start;
        acts = bounce_with_care(network, h, &network->before[p], &b);
    }
    return (spec_bounce){acts, b.x + h * b.vx, b.y + h * b.vy, b.vx, b.vy};
}

/* ---------------------------------------------------------------------------------------------- motion by grips */

// Let a surface stop a particle that a grip has moved. Friction brakes it, and takes its way along the surface back.
static bool stop(const spec_plane *plane, double h, double slop, spec_bounce *b) {
    const double distance = spec_distance_from(plane, b->x, b->y), across = plane->nx * b->vx + plane->ny * b->vy;
    if (!(distance < slop)) {
        return false;
    }
    if (across < 0.0) {
        const double along = plane->nx * b->vy - plane->ny * b->vx, most = plane->friction * -across;
        const double taken = along > most ? most : along < -most ? -most : along;
        b->vx += -across * plane->nx + taken * plane->ny;
        b->vy += -across * plane->ny - taken * plane->nx;
        b->x += h * taken * plane->ny;
        b->y -= h * taken * plane->nx;
    }
    if (distance < 0.0) {
        b->x -= distance * plane->nx;
        b->y -= distance * plane->ny;
    }
    return across < 0.0 || distance < 0.0;
}

void spec_stop_at_floor(const spec_network *network, double from_x, double from_y, double h, spec_bounce *b) {
    const double slop = spec_slop_at(b->x, b->y);
    bool goes_on = network->plane_count > 0 || network->heights.count > 0;
    if (!goes_on) {
        return;
    }
    for (int round = 0; round < ROUNDS_OF_PLANES && goes_on; round++) {
        goes_on = false;
        for (uint32_t i = 0; i < network->plane_count; i++) {
            goes_on |= stop(&network->planes[i], h, slop, b);
        }
        if (network->heights.count > 0) {
            const spec_plane met = spec_first_hit(&network->heights, from_x, from_y, b->x, b->y);
            goes_on |= stop(&met, h, slop, b);
        }
    }
    if (!(spec_distance_from_all(network, b->x, b->y) < -slop)) {
        return;
    }
    if (spec_distance_from_all(network, from_x, from_y) >= -8.0 * slop) { // a narrow corner: back
        b->x = from_x;
        b->y = from_y;
    } else {
        (void)spec_put_outside(network, &b->x, &b->y);
    }
    b->vx = b->vy = 0.0;
}
