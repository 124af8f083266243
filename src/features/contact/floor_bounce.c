/// Bounce of one particle on the floor, in a leapfrog substep or in free flight.
#include "features/contact/floor.h"

#include <math.h>

static void put_onto(const mspringi_line *line, double *x, double *y) {
    const double distance = mspringi_distance_from_line(line, *x, *y);
    *x -= distance < 0.0 ? distance * line->nx : 0.0;
    *y -= distance < 0.0 ? distance * line->ny : 0.0;
}

static mspringi_line line_below(const mspringi_heights *heights, double x) {
    return mspringi_heights_line(heights, mspringi_heights_find_part(heights, x));
}

// Lift a point out of a narrow corner in which surfaces push it to and fro.
static void lift(const mspringi_floor *floor, double *x, double *y) {
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        put_onto(&floor->lines[i], x, y);
    if (floor->heights.count > 0) {
        const mspringi_line line = line_below(&floor->heights, *x);
        *y = fmax(*y, -(line.nx * *x + line.offset) / line.ny);
    }
}

bool mspringi_floor_put_outside(const mspringi_floor *floor, double *x, double *y) {
    const double slop = mspringi_floor_slop(*x, *y);
    bool was_inside = false;
    for (int round = 0; mspringi_floor_distance(floor, *x, *y) < -slop; ++round) {
        was_inside = true;
        if (round == MSPRINGI_FLOOR_ROUNDS) {
            lift(floor, x, y);
            break;
        }
        for (uint32_t i = 0; i < floor->plane_count; ++i)
            put_onto(&floor->lines[i], x, y);
        if (floor->heights.count > 0) {
            const mspringi_line line = line_below(&floor->heights, *x);
            put_onto(&line, x, y);
        }
    }
    return was_inside;
}

// True if a way ends outside, through no part of the heights.
static bool is_free_way(const mspringi_floor *floor, double from_x, double from_y, double x, double y) {
    const double slop = mspringi_floor_slop(x, y);
    if (!(mspringi_floor_distance(floor, x, y) >= -slop))
        return false;
    if (floor->heights.count == 0)
        return true;
    const int64_t part = mspringi_heights_first_hit(&floor->heights, from_x, from_y, x, y);
    const mspringi_line line = mspringi_heights_line(&floor->heights, part);
    return mspringi_distance_from_line(&line, x, y) >= -slop;
}

/* ------------------------------------------------------------------------------------------------- with springs */

static double bounce_at(const mspringi_line *line, double h, double allowed, mspringi_bouncing_particle *p) {
    return mspringi_bounce(line->nx, line->ny, line->offset, mspringi_friction_on(line, p->own),
                           mspringi_restitution_on(line, p->own), h, allowed, p);
}

// Apply the part of the heights that the particle meets on its way, or else the one below its end.
static double bounce_at_heights(const mspringi_floor *floor, double h, double allowed,
                                mspringi_bouncing_particle *p) {
    const double x = p->x + h * p->vx, y = p->y + h * p->vy;
    const int64_t part = mspringi_heights_first_hit(&floor->heights, p->x, p->y, x, y);
    const mspringi_line met = mspringi_heights_line(&floor->heights, part), below = line_below(&floor->heights, x);
    const double acts = bounce_at(&met, h, allowed, p);
    return acts > 0.0 ? acts : bounce_at(&below, h, allowed, p);
}

// Apply all surfaces once. Return true if one acted.
static bool bounce_at_surfaces(const mspringi_floor *floor, double h, double allowed,
                               mspringi_bouncing_particle *p) {
    double any = 0.0;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        any += bounce_at(&floor->lines[i], h, allowed, p);
    if (floor->heights.count > 0)
        any += bounce_at_heights(floor, h, allowed, p);
    return any > 0.0;
}

// Limit the speed to that before the bounce. A particle that rounding lifted and that lands again gets faster by
// rounding. (When such particles were turned back instead, whole bodies that slid down a slope stopped.)
static void slow_down(double most, mspringi_bouncing_particle *p) {
    const double square = mspringi_bouncing_particle_square(p);
    if (!(square > most * MSPRINGI_GROWTH_MARGIN))
        return;
    const double keep = sqrt(most / square);
    p->vx = p->half_x + keep * (p->vx - p->half_x);
    p->vy = p->half_y + keep * (p->vy - p->half_y);
}

bool mspringi_floor_bounce(const mspringi_floor *floor, double h, double from_vx, double from_vy,
                           mspringi_bouncing_particle *p) {
    const double slop = mspringi_floor_slop(p->x, p->y), most = mspringi_bouncing_particle_square(p);
    const bool ends_inside = mspringi_floor_distance(floor, p->x + h * p->vx, p->y + h * p->vy) < 0.0;
    const bool was_inside = ends_inside && mspringi_floor_put_outside(floor, &p->x, &p->y);
    bool acts = was_inside;
    for (int round = 0; round < MSPRINGI_FLOOR_ROUNDS && bounce_at_surfaces(floor, h, round == 0 ? 0.0 : slop, p);
         ++round)
        acts = true;
    if (acts && !was_inside)
        slow_down(most, p);
    if (!acts || is_free_way(floor, p->x, p->y, p->x + h * p->vx, p->y + h * p->vy))
        return acts;
    // A corner without a free way: turn the particle back, which changes no energy, or else stop it.
    p->vx = -from_vx;
    p->vy = -from_vy;
    if (!is_free_way(floor, p->x, p->y, p->x + h * p->vx, p->y + h * p->vy))
        p->vx = p->vy = 0.0;
    return true;
}

/* ---------------------------------------------------------------------------------------------- without springs */

/// Surface that a free particle meets, and when.
typedef struct hit {
    mspringi_line line;
    double time;
} hit;

// Replace *first if the particle meets this line earlier. A line above the particle does not count: that part of
// the heights ends before it.
static void find_hit(const mspringi_line *line, double slop, const mspringi_free_particle *p, hit *first) {
    if (mspringi_distance_from_line(line, p->x, p->y) < -mspringi_floor_slop(p->x, p->y))
        return;
    const double time = mspringi_time_to_surface(line->nx, line->ny, line->offset, slop, p);
    if (time < first->time)
        *first = (hit){*line, time};
}

static void find_end(const mspringi_free_particle *p, double *x, double *y) {
    *x = p->x + p->left * (p->wx + 0.5 * p->left * p->ax);
    *y = p->y + p->left * (p->wy + 0.5 * p->left * p->ay);
}

static hit find_first_hit(const mspringi_floor *floor, double slop, const mspringi_free_particle *p) {
    hit first = {.time = INFINITY};
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        find_hit(&floor->lines[i], slop, p, &first);
    if (floor->heights.count == 0)
        return first;
    double x, y;
    find_end(p, &x, &y);
    const int64_t part = mspringi_heights_first_hit(&floor->heights, p->x, p->y, x, y);
    const mspringi_line met = mspringi_heights_line(&floor->heights, part), below = line_below(&floor->heights, x);
    find_hit(&met, slop, p, &first);
    find_hit(&below, slop, p, &first);
    return first;
}

// Push a free particle out of the surface, and take the energy of the lift from its speed. Return true if it was
// inside.
static bool push_out_free_particle(const mspringi_floor *floor, mspringi_free_particle *p) {
    const double x = p->x, y = p->y, square = p->wx * p->wx + p->wy * p->wy;
    if (!mspringi_floor_put_outside(floor, &p->x, &p->y))
        return false;
    const double left = square + 2.0 * (p->ax * (p->x - x) + p->ay * (p->y - y));
    const double keep = !(left < square) ? 1.0 : left > 0.0 ? sqrt(left / square) : 0.0;
    p->wx *= keep;
    p->wy *= keep;
    return true;
}

// Share of its end velocity that a sliding particle may keep. It has the velocity of the end of the substep at
// once, and may meet another surface with it. (Kernels leave such particles to this file: free_kernel.h.) 0: even
// at rest it would end with more energy than it began with.
static double kept_of(const mspringi_free_particle *start, const mspringi_free_particle *end, double since,
                      double x, double y) {
    const double vx = end->wx + since * end->ax, vy = end->wy + since * end->ay, square = vx * vx + vy * vy;
    const double late = end->left - since, wx = vx + late * end->ax, wy = vy + late * end->ay;
    const double fallen = start->ax * (x - start->x) + start->ay * (y - start->y);
    const double most = start->wx * start->wx + start->wy * start->wy + 2.0 * fallen;
    const double gained = wx * wx + wy * wy - most * MSPRINGI_GROWTH_MARGIN;
    return !(gained > 0.0) ? 1.0 : square > gained ? sqrt(1.0 - gained / square) : 0.0;
}

// Remove the normal velocity of a particle that lay on a part of the heights: that of half a substep, w = h a / 2.
// Else the next part would throw it back. (3 % of a particle's energy in each, at restitution 1 and 0.25 s.)
static bool leave_part(const mspringi_floor *floor, const mspringi_bounce_params *how, double slop,
                       mspringi_free_particle *p) {
    if (floor->heights.count == 0 || !(how->skew > 0.0))
        return false;
    double x, y;
    find_end(p, &x, &y);
    const int64_t part = mspringi_heights_find_part(&floor->heights, p->x);
    if (mspringi_heights_find_part(&floor->heights, x) == part)
        return false;
    const mspringi_line line = mspringi_heights_line(&floor->heights, part);
    const double across = line.nx * p->wx + line.ny * p->wy, along = line.nx * p->wy - line.ny * p->wx;
    const double pull = line.nx * p->ax + line.ny * p->ay;
    const bool lay = mspringi_distance_from_line(&line, p->x, p->y) <= slop && across < 0.0 &&
                     -across <= -how->skew * pull + MSPRINGI_TANGENT_ROUNDING * fabs(along);
    p->wx -= lay ? across * line.nx : 0.0;
    p->wy -= lay ? across * line.ny : 0.0;
    return lay;
}

// Correct the velocity of a particle that slid off its surface: half a substep ago, also across its way.
static void leave_surface(const mspringi_floor *floor, const mspringi_bounce_params *how,
                          const mspringi_free_particle *start, const mspringi_free_particle *end, double *vx,
                          double *vy) {
    const double square = end->wx * end->wx + end->wy * end->wy;
    if (end->ax != 0.0 || end->ay != 0.0 || !(square > 0.0) ||
        !(mspringi_floor_distance(floor, end->x, end->y) > mspringi_floor_slop(end->x, end->y)))
        return;
    const double along = (start->ax * end->wx + start->ay * end->wy) / square;
    *vx -= how->skew * (start->ax - along * end->wx);
    *vy -= how->skew * (start->ay - along * end->wy);
}

bool mspringi_floor_move_free_particle(const mspringi_floor *floor, const mspringi_bounce_params *how,
                                       mspringi_free_particle *p, double *vx, double *vy) {
    const double slop = mspringi_flight_slop(p->x, p->y);
    double x, y;
    find_end(p, &x, &y);
    bool acts = mspringi_floor_distance(floor, x, y) < 0.0 && push_out_free_particle(floor, p);
    acts |= leave_part(floor, how, slop, p);
    const mspringi_free_particle start = *p;
    double restitution = 0.0; // of the last surface that it met
    bool has_slid = false;
    for (int turns = 1; turns <= MSPRINGI_MAX_DEFLECTIONS; ++turns) {
        const hit first = find_first_hit(floor, slop, p);
        if (!(first.time < INFINITY))
            break;
        acts = true;
        has_slid |= turns > 1 && p->ax == 0.0 && p->ay == 0.0;
        restitution = mspringi_restitution_on(&first.line, p->own);
        mspringi_bounce_free(first.line.nx, first.line.ny, first.line.offset,
                             mspringi_friction_on(&first.line, p->own), restitution, how, first.time,
                             turns == MSPRINGI_MAX_DEFLECTIONS, p);
    }
    find_end(p, &x, &y);
    const double since = p->left - how->skew, keep = has_slid ? kept_of(&start, p, since, x, y) : 1.0;
    *vx = keep * (p->wx + since * p->ax);
    *vy = keep * (p->wy + since * p->ay);
    p->x = x;
    p->y = y;
    if (acts && how->skew > 0.0)
        leave_surface(floor, how, &start, p, vx, vy);
    if (acts && (keep == 0.0 || !(mspringi_floor_distance(floor, x, y) >= -mspringi_floor_slop(x, y)))) {
        // A corner without a free way: keep the position, and turn the velocity back by the restitution.
        const double e = restitution > MSPRINGI_MIN_RESTITUTION ? restitution : 0.0;
        p->x = start.x;
        p->y = start.y;
        *vx = e > 0.0 ? -e * start.wx - how->skew * start.ax : 0.0;
        *vy = e > 0.0 ? -e * start.wy - how->skew * start.ay : 0.0;
    }
    return acts;
}
