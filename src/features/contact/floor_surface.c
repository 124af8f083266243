/// Surface of the floor: distances, straight parts of the heights, first hit of a moving particle.
#include "features/contact/floor.h"

#include <math.h>

/// Most blocks of heights checked for one particle in a substep. Only a way that grazes a long slope could take
/// more.
#define MOST_CHECKS 4096

/// Knot number of a way that meets no knot.
#define NO_KNOT ((int64_t)-1)

/* ---------------------------------------------------------------------------------------------------- distances */

void mspringi_floor_set_origin(mspringi_floor *floor, double origin_x, double origin_y) {
    for (uint32_t i = 0; i < floor->plane_count; ++i) {
        const mspringi_half_plane *plane = &floor->planes[i];
        floor->lines[i] = (mspringi_line){
            .nx = plane->nx,
            .ny = plane->ny,
            .offset = plane->nx * (origin_x - plane->x) + plane->ny * (origin_y - plane->y),
            .friction = floor->plane_frictions ? (double)floor->plane_frictions[i] : floor->friction,
            .restitution = floor->plane_restitutions ? (double)floor->plane_restitutions[i] : floor->restitution};
    }
    floor->heights.local_x = floor->heights.x - origin_x;
    floor->heights.local_y = floor->heights.y - origin_y;
}

double mspringi_floor_slop(double x, double y) {
    return 0x1p-21 * (fabs(x) + fabs(y)) + 1e-12;
}

/* ----------------------------------------------------------------------------------------------------- heights */

int64_t mspringi_heights_find_part(const mspringi_heights *h, double x) {
    const double place = (x - h->local_x) / h->spacing;
    if (!(place >= 0.0))
        return -1;
    return place < (double)(h->count - 1) ? (int64_t)place : (int64_t)h->count - 1;
}

static double knot_x(const mspringi_heights *h, int64_t i) {
    return h->local_x + (double)i * h->spacing;
}

static double knot_y(const mspringi_heights *h, int64_t i) {
    return h->local_y + (double)h->heights[i];
}

mspringi_line mspringi_heights_line(const mspringi_heights *h, int64_t part) {
    const int64_t last = (int64_t)h->count - 2, sloping = part < 0 ? 0 : part < last ? part : last;
    mspringi_line line = {.ny = 1.0,
                          .friction = h->frictions ? (double)h->frictions[sloping] : h->friction,
                          .restitution = h->restitutions ? (double)h->restitutions[sloping] : h->restitution};
    if (part != sloping) {
        line.offset = -knot_y(h, part < 0 ? 0 : last + 1);
        return line;
    }
    line.nx = h->normals[2 * part];
    line.ny = h->normals[2 * part + 1];
    line.offset = -(line.nx * knot_x(h, part) + line.ny * knot_y(h, part));
    return line;
}

/// Straight way of a particle above the heights.
typedef struct passage {
    const mspringi_heights *heights;
    double start_x, start_y, along_x, along_y;
    double slop;
} passage;

static bool is_below(const passage *w, int64_t knot, double y) {
    const double share = (knot_x(w->heights, knot) - w->start_x) / w->along_x;
    return w->start_y + share * w->along_y < y - w->slop;
}

// True if the way may come below one of 2^level knots. False if it is above the highest of them at both ends: then
// it is above each, since is_below is monotonic in the knots, after rounding, too.
static bool may_meet(const passage *w, int64_t first, uint32_t level) {
    const mspringi_heights *h = w->heights;
    const double highest = h->local_y + (double)h->highest[level][first >> level];
    const int64_t last = first + ((int64_t)1 << level) - 1;
    return is_below(w, first, highest) || is_below(w, last, highest);
}

// Find the first knot below which the way passes between two edges; edge i is left of knot i. NO_KNOT: none. Blocks
// of knots double in size while the way is above them: an explosion above 60,000 heights checks 30 blocks a
// particle, not thousands of knots.
static int64_t knot_met(const passage *w, int64_t edge, int64_t stop) {
    const int64_t onward = edge < stop ? 1 : -1;
    uint32_t level = 0;
    for (uint32_t checks = 0; edge != stop && checks < MOST_CHECKS; ++checks) {
        const int64_t size = (int64_t)1 << level, first = onward > 0 ? edge : edge - size;
        const bool fits = size <= onward * (stop - edge);
        if (fits && !may_meet(w, first, level)) {
            edge += onward * size;
            level += edge % (2 * size) == 0;
        } else if (fits && level == 0) {
            return first;
        } else {
            --level;
        }
    }
    return NO_KNOT;
}

int64_t mspringi_heights_first_hit(const mspringi_heights *h, double start_x, double start_y, double x, double y) {
    const int64_t first = mspringi_heights_find_part(h, start_x), last = mspringi_heights_find_part(h, x);
    if (first == last)
        return last;
    const passage w = {h, start_x, start_y, x - start_x, y - start_y, mspringi_floor_slop(x, y)};
    const int64_t knot = knot_met(&w, first + 1, last + 1);
    if (knot == NO_KNOT)
        return last;
    return first < last ? knot - 1 : knot;
}

// Highest of the knots first to end - 1.
static float highest_among(const mspringi_heights *h, uint32_t first, uint32_t end) {
    float highest = h->heights[first];
    for (uint32_t level = 0; first < end; ++level, first /= 2, end /= 2) {
        const float *values = h->highest[level];
        if (first % 2 == 1 && values[first++] > highest)
            highest = values[first - 1];
        if (end % 2 == 1 && first < end && values[--end] > highest)
            highest = values[end];
    }
    return highest;
}

double mspringi_heights_highest(const mspringi_heights *h, double low, double high) {
    const int64_t first = mspringi_heights_find_part(h, low), last = mspringi_heights_find_part(h, high);
    const uint32_t begin = first < 0 ? 0 : (uint32_t)first;
    const uint32_t end = last + 1 < (int64_t)h->count ? (uint32_t)(last + 2) : h->count;
    return h->local_y + (double)highest_among(h, begin, end);
}

double mspringi_floor_distance(const mspringi_floor *floor, double x, double y) {
    double least = INFINITY;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        least = fmin(least, mspringi_distance_from_line(&floor->lines[i], x, y));
    if (floor->heights.count > 0) {
        const mspringi_heights *h = &floor->heights;
        const mspringi_line line = mspringi_heights_line(h, mspringi_heights_find_part(h, x));
        least = fmin(least, mspringi_distance_from_line(&line, x, y));
    }
    return least;
}
