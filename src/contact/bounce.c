/// What the surface does to one particle in a substep, in all cases.
#include "floor.h"

#include <math.h>

/// Times that all surfaces are gone through for one particle: corners need more than one.
#define ROUNDS 4

static double distance_from(const mspringi_line *line, double x, double y) {
    return line->nx * x + line->ny * y + line->offset;
}

static void put_onto(const mspringi_line *line, double *x, double *y) {
    const double distance = distance_from(line, *x, *y);
    *x -= distance < 0.0 ? distance * line->nx : 0.0;
    *y -= distance < 0.0 ? distance * line->ny : 0.0;
}

static mspringi_line line_below(const mspringi_heights *heights, double x) {
    return mspringi_heights_line(heights, mspringi_heights_part_below(heights, x));
}

// Deep in a narrow corner, where surfaces push to and fro: up to where all of them end.
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
        if (round == ROUNDS) {
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

// Whether a way leads to where particles may be, through no surface.
static bool is_free_way(const mspringi_floor *floor, double from_x, double from_y, double x, double y) {
    const double slop = mspringi_floor_slop(x, y);
    if (!(mspringi_floor_distance(floor, x, y) >= -slop))
        return false;
    if (floor->heights.count == 0)
        return true;
    const int64_t part = mspringi_heights_part_met(&floor->heights, from_x, from_y, x, y);
    const mspringi_line line = mspringi_heights_line(&floor->heights, part);
    return distance_from(&line, x, y) >= -slop;
}

/* ------------------------------------------------------------------------------------------------- with springs */

static double turn_at(const mspringi_floor *floor, const mspringi_line *line, double h, double allowed,
                      mspringi_going *p) {
    return mspringi_turn_going(line->nx, line->ny, line->offset, floor->friction, h, allowed, p);
}

// The part of the heights that it meets on its way, or else the one that it would end below.
static double turn_at_heights(const mspringi_floor *floor, double h, double allowed, mspringi_going *p) {
    const double x = p->x + h * p->vx, y = p->y + h * p->vy;
    const int64_t part = mspringi_heights_part_met(&floor->heights, p->x, p->y, x, y);
    const mspringi_line met = mspringi_heights_line(&floor->heights, part), below = line_below(&floor->heights, x);
    const double acts = turn_at(floor, &met, h, allowed, p);
    return acts > 0.0 ? acts : turn_at(floor, &below, h, allowed, p);
}

// Go through all surfaces once. Returns whether any did anything.
static bool turn(const mspringi_floor *floor, double h, double allowed, mspringi_going *p) {
    double any = 0.0;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        any += turn_at(floor, &floor->lines[i], h, allowed, p);
    if (floor->heights.count > 0)
        any += turn_at_heights(floor, h, allowed, p);
    return any > 0.0;
}

bool mspringi_floor_bounce(const mspringi_floor *floor, double h, double from_vx, double from_vy,
                           mspringi_going *p) {
    const double slop = mspringi_floor_slop(p->x, p->y), most = mspringi_going_square(p) * MSPRINGI_NO_LARGER;
    const bool ends_inside = mspringi_floor_distance(floor, p->x + h * p->vx, p->y + h * p->vy) < 0.0;
    bool acts = ends_inside && mspringi_floor_put_outside(floor, &p->x, &p->y);
    const bool was_inside = acts;
    for (int round = 0; round < ROUNDS && turn(floor, h, round == 0 ? 0.0 : slop, p); ++round)
        acts = true;
    if (!acts || ((was_inside || mspringi_going_square(p) <= most) &&
                  is_free_way(floor, p->x, p->y, p->x + h * p->vx, p->y + h * p->vy)))
        return acts;
    // A corner that leads nowhere: back to where it came from, which takes and gives no energy, or no further.
    p->vx = -from_vx;
    p->vy = -from_vy;
    if (!is_free_way(floor, p->x, p->y, p->x + h * p->vx, p->y + h * p->vy))
        p->vx = p->vy = 0.0;
    return true;
}

/* ---------------------------------------------------------------------------------------------- without springs */

/// Where a particle meets a surface.
typedef struct meeting {
    mspringi_line line;
    double time;
} meeting;

static void meet(const mspringi_line *line, double slop, const mspringi_flyer *p, meeting *first) {
    const double time = mspringi_time_to(line->nx, line->ny, line->offset, slop, p);
    if (time < first->time)
        *first = (meeting){*line, time};
}

static void find_end(const mspringi_flyer *p, double *x, double *y) {
    *x = p->x + p->left * (p->wx + 0.5 * p->left * p->ax);
    *y = p->y + p->left * (p->wy + 0.5 * p->left * p->ay);
}

static meeting find_meeting(const mspringi_floor *floor, double slop, const mspringi_flyer *p) {
    meeting first = {{0.0, 0.0, 0.0}, INFINITY};
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        meet(&floor->lines[i], slop, p, &first);
    if (floor->heights.count == 0)
        return first;
    double x, y;
    find_end(p, &x, &y);
    const int64_t part = mspringi_heights_part_met(&floor->heights, p->x, p->y, x, y);
    const mspringi_line met = mspringi_heights_line(&floor->heights, part), below = line_below(&floor->heights, x);
    meet(&met, slop, p, &first);
    meet(&below, slop, p, &first);
    return first;
}

bool mspringi_floor_fly(const mspringi_floor *floor, const mspringi_turning *how, mspringi_flyer *p, double *vx,
                        double *vy) {
    const double slop = mspringi_flight_slop(p->x, p->y);
    double x, y;
    find_end(p, &x, &y);
    bool acts = mspringi_floor_distance(floor, x, y) < 0.0 && mspringi_floor_put_outside(floor, &p->x, &p->y);
    const double start_x = p->x, start_y = p->y;
    for (int turns = 1; turns <= MSPRINGI_MOST_TURNS; ++turns) {
        const meeting first = find_meeting(floor, slop, p);
        if (!(first.time < INFINITY))
            break;
        acts = true;
        mspringi_turn_flyer(first.line.nx, first.line.ny, first.line.offset, how, first.time,
                            turns == MSPRINGI_MOST_TURNS, p);
    }
    find_end(p, &x, &y);
    const double since = p->left - how->lag;
    *vx = p->wx + since * p->ax;
    *vy = p->wy + since * p->ay;
    p->x = x;
    p->y = y;
    if (acts && !(mspringi_floor_distance(floor, x, y) >= -mspringi_floor_slop(x, y))) {
        p->x = start_x;
        p->y = start_y;
        *vx = *vy = 0.0;
    }
    return acts;
}
