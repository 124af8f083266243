/// Where the surface is.
#include "contact/floor.h"

#include <math.h>

#include "sleep/sleep.h"

/// Most looks at a field of heights on the way of one particle in one substep; a way that grazes a long slope is
/// one that could take more.
#define MOST_LOOKS 4096

/// What a way meets that meets nothing.
#define NO_KNOT ((int64_t)-1)

/* ---------------------------------------------------------------------------------------------------- distances */

void mspringi_floor_follow(mspringi_floor *floor, double origin_x, double origin_y) {
    for (uint32_t i = 0; i < floor->plane_count; ++i) {
        const mspringi_half_plane *plane = &floor->planes[i];
        floor->lines[i] = (mspringi_line){plane->nx, plane->ny,
                                          plane->nx * (origin_x - plane->x) + plane->ny * (origin_y - plane->y)};
    }
    floor->heights.local_x = floor->heights.x - origin_x;
    floor->heights.local_y = floor->heights.y - origin_y;
}

double mspringi_floor_slop(double x, double y) {
    return 0x1p-21 * (fabs(x) + fabs(y)) + 1e-12;
}

static double distance_from(const mspringi_line *line, double x, double y) {
    return line->nx * x + line->ny * y + line->offset;
}

/* ----------------------------------------------------------------------------------------------------- heights */

int64_t mspringi_heights_part_below(const mspringi_heights *h, double x) {
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
    if (part < 0)
        return (mspringi_line){0.0, 1.0, -knot_y(h, 0)};
    if (part >= (int64_t)h->count - 1)
        return (mspringi_line){0.0, 1.0, -knot_y(h, (int64_t)h->count - 1)};
    const double nx = h->normals[2 * part], ny = h->normals[2 * part + 1];
    return (mspringi_line){nx, ny, -(nx * knot_x(h, part) + ny * knot_y(h, part))};
}

/// The way of a particle, straight from its start.
typedef struct passage {
    const mspringi_heights *heights;
    double start_x, start_y, along_x, along_y;
    double slop;
} passage;

static bool is_below(const passage *w, int64_t knot, double y) {
    const double share = (knot_x(w->heights, knot) - w->start_x) / w->along_x;
    return w->start_y + share * w->along_y < y - w->slop;
}

// Whether the way comes below any of 2^level knots may be; where it is above the highest of them at both ends, it
// is above each: each operation of is_below keeps the order of the knots, rounded, too.
static bool may_meet(const passage *w, int64_t first, uint32_t level) {
    const mspringi_heights *h = w->heights;
    const double highest = h->local_y + (double)h->highest[level][first >> level];
    const int64_t last = first + ((int64_t)1 << level) - 1;
    return is_below(w, first, highest) || is_below(w, last, highest);
}

// The first knot that the way comes below, on the way from one edge between knots to another; edge i is left of
// knot i. NO_KNOT: none. Looks at blocks of knots that double while the way is above them: an explosion above
// 60,000 heights looks at 30 blocks a particle, not at thousands of knots.
static int64_t knot_met(const passage *w, int64_t edge, int64_t stop) {
    const int64_t onward = edge < stop ? 1 : -1;
    uint32_t level = 0;
    for (uint32_t looks = 0; edge != stop && looks < MOST_LOOKS; ++looks) {
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

int64_t mspringi_heights_part_met(const mspringi_heights *h, double start_x, double start_y, double x, double y) {
    const int64_t first = mspringi_heights_part_below(h, start_x), last = mspringi_heights_part_below(h, x);
    if (first == last)
        return last;
    const passage w = {h, start_x, start_y, x - start_x, y - start_y, mspringi_floor_slop(x, y)};
    const int64_t knot = knot_met(&w, first + 1, last + 1);
    if (knot == NO_KNOT)
        return last;
    return first < last ? knot - 1 : knot;
}

// The highest of the knots first ... end - 1.
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

static double highest_between(const mspringi_heights *h, double low, double high) {
    const int64_t first = mspringi_heights_part_below(h, low), last = mspringi_heights_part_below(h, high);
    const uint32_t begin = first < 0 ? 0 : (uint32_t)first;
    const uint32_t end = last + 1 < (int64_t)h->count ? (uint32_t)(last + 2) : h->count;
    return h->local_y + (double)highest_among(h, begin, end);
}

double mspringi_floor_distance(const mspringi_floor *floor, double x, double y) {
    double least = INFINITY;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        least = fmin(least, distance_from(&floor->lines[i], x, y));
    if (floor->heights.count > 0) {
        const mspringi_heights *h = &floor->heights;
        const mspringi_line line = mspringi_heights_line(h, mspringi_heights_part_below(h, x));
        least = fmin(least, distance_from(&line, x, y));
    }
    return least;
}

/* ------------------------------------------------------------------------------------------------------ survey */

/// A box in double precision.
typedef struct box {
    double min_x, max_x, min_y, max_y;
} box;

// Widen what a span of slots covers; a pass over memory, so written for vectors.
static void cover(const mspring_network *network, size_t first, size_t end, box *all, float *fastest) {
    const mspringi_state *s = &network->state;
    float min_x[MSPRINGI_WIDTH], max_x[MSPRINGI_WIDTH], min_y[MSPRINGI_WIDTH], max_y[MSPRINGI_WIDTH];
    float fast[MSPRINGI_WIDTH];
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        min_x[lane] = max_x[lane] = s->x[first + lane];
        min_y[lane] = max_y[lane] = s->y[first + lane];
        fast[lane] = 0.0f;
    }
    for (size_t slot = first; slot < end; slot += MSPRINGI_WIDTH)
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const float x = s->x[slot + lane], y = s->y[slot + lane];
            const float vx = fabsf(s->vx[slot + lane]), vy = fabsf(s->vy[slot + lane]);
            min_x[lane] = x < min_x[lane] ? x : min_x[lane];
            max_x[lane] = x > max_x[lane] ? x : max_x[lane];
            min_y[lane] = y < min_y[lane] ? y : min_y[lane];
            max_y[lane] = y > max_y[lane] ? y : max_y[lane];
            fast[lane] = vx > fast[lane] ? vx : fast[lane];
            fast[lane] = vy > fast[lane] ? vy : fast[lane];
        }
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        all->min_x = (double)min_x[lane] < all->min_x ? (double)min_x[lane] : all->min_x;
        all->max_x = (double)max_x[lane] > all->max_x ? (double)max_x[lane] : all->max_x;
        all->min_y = (double)min_y[lane] < all->min_y ? (double)min_y[lane] : all->min_y;
        all->max_y = (double)max_y[lane] > all->max_y ? (double)max_y[lane] : all->max_y;
        *fastest = fast[lane] > *fastest ? fast[lane] : *fastest;
    }
}

static void cover_span(const mspring_network *network, const mspringi_span *span, box *all, float *fastest) {
    const size_t first = span->first_slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    if (first < end)
        cover(network, first, end, all, fastest);
}

static box cover_strip(const mspring_network *network, const mspringi_strip *strip, float *fastest) {
    const mspringi_topology *t = &network->topology;
    const mspringi_row *first = &t->rows[strip->first_row], *last = first + strip->row_count - 1;
    box all = {INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (uint32_t i = first->first_span; i < last->first_span + last->span_count; ++i)
        cover_span(network, &t->spans[i], &all, fastest);
    if (strip->home_span != MSPRING_NONE)
        cover_span(network, &t->spans[strip->home_span], &all, fastest);
    return all;
}

// Take the part of a box where a line is not, as far as that is a box.
static void keep_clear_of(const mspringi_line *line, box *clear) {
    if (line->ny == 0.0) {
        const double x = -line->offset / line->nx;
        if (line->nx > 0.0)
            clear->min_x = fmax(clear->min_x, x);
        else
            clear->max_x = fmin(clear->max_x, x);
        return;
    }
    const double left = -(line->nx * clear->min_x + line->offset) / line->ny;
    const double right = -(line->nx * clear->max_x + line->offset) / line->ny;
    if (line->ny > 0.0)
        clear->min_y = fmax(clear->min_y, fmax(left, right));
    else
        clear->max_y = fmin(clear->max_y, fmin(left, right));
}

// In single precision; far beyond all coordinates it does not matter where.
static float bound(double value) {
    return (float)fmax(-1e30, fmin(value, 1e30));
}

// The box around a strip, and reach metres on, less what the surface is in, less what rounding may do.
static mspringi_clearance look_around(const mspringi_floor *floor, const box *strip, double reach) {
    box clear = {strip->min_x - reach, strip->max_x + reach, -INFINITY, INFINITY};
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        keep_clear_of(&floor->lines[i], &clear);
    if (floor->heights.count > 0)
        clear.min_y = fmax(clear.min_y, highest_between(&floor->heights, clear.min_x, clear.max_x));
    const double size = fabs(clear.min_x) + fabs(clear.max_x) + fmax(fabs(strip->min_y), fabs(strip->max_y));
    const double margin = 4.0 * mspringi_floor_slop(size, reach);
    clear = (box){clear.min_x + margin, clear.max_x - margin, clear.min_y + margin, clear.max_y - margin};
    const bool is_far = clear.min_x < strip->min_x - 0.5 * reach && clear.max_x > strip->max_x + 0.5 * reach &&
                        clear.min_y < strip->min_y - 0.5 * reach && clear.max_y > strip->max_y + 0.5 * reach;
    return (mspringi_clearance){{bound(clear.min_x), bound(clear.max_x), bound(clear.min_y), bound(clear.max_y)},
                                is_far};
}

// What forces from outside accelerate any particle by at most, along x or y, m/s^2.
static double hardest_push(const mspring_network *network) {
    const mspringi_field *force = &network->sleep.in_force;
    const float *inverse_mass = mspringi_free_mass(network);
    const size_t slots = (size_t)network->topology.block_count * MSPRINGI_WIDTH;
    float hardest[MSPRINGI_WIDTH] = {0.0f}, all = 0.0f;
    for (size_t slot = 0; force->x && slot < slots; slot += MSPRINGI_WIDTH)
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const float x = fabsf(force->x[slot + lane]), y = fabsf(force->y[slot + lane]);
            const float push = (x > y ? x : y) * inverse_mass[slot + lane];
            hardest[lane] = push > hardest[lane] ? push : hardest[lane];
        }
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
        all = hardest[lane] > all ? hardest[lane] : all;
    return (double)all;
}

void mspringi_floor_survey(mspring_network *network, double seconds) {
    const mspringi_topology *t = &network->topology;
    mspringi_floor *floor = network->floor;
    float fastest = 0.0f;
    mspringi_floor_follow(floor, network->origin_x, network->origin_y);
    for (uint32_t i = 0; i < t->strip_count; ++i) {
        if (mspringi_share_of_strip(network, &t->strips[i]) == MSPRINGI_ASLEEP)
            continue;
        const box all = cover_strip(network, &t->strips[i], &fastest);
        floor->clearances[i].clear =
            (mspringi_bounds){(float)all.min_x, (float)all.max_x, (float)all.min_y, (float)all.max_y};
    }
    // Half of the reach is twice as far as the fastest particle gets by its speed, gravity and forces from outside.
    const double push = fabs((double)network->settings.gravity_x) + fabs((double)network->settings.gravity_y) +
                        hardest_push(network);
    const double reach = 4.0 * seconds * ((double)fastest + push * seconds) + 1e-6;
    floor->reach = reach;
    for (uint32_t i = 0; i < t->strip_count; ++i) {
        if (mspringi_share_of_strip(network, &t->strips[i]) == MSPRINGI_ASLEEP)
            continue;
        const mspringi_bounds *b = &floor->clearances[i].clear;
        const box strip = {(double)b->min_x, (double)b->max_x, (double)b->min_y, (double)b->max_y};
        floor->clearances[i] = look_around(floor, &strip, reach);
        floor->has_impulse |= !floor->clearances[i].is_far;
    }
}

bool mspringi_floor_is_near_block(const mspring_network *network, const mspringi_strip *strip, uint32_t block) {
    const mspringi_floor *floor = network->floor;
    const mspringi_state *s = &network->state;
    const size_t first = (size_t)block * MSPRINGI_WIDTH;
    const mspringi_bounds *all = &floor->clearances[strip - network->topology.strips].clear;
    const double way = 0.5 * floor->reach;
    // Where the whole strip is clear, if that is enough.
    const mspringi_bounds within = {bound((double)all->min_x + way), bound((double)all->max_x - way),
                                    bound((double)all->min_y + way), bound((double)all->max_y - way)};
    if (!network->kernels->leaves(s->x + first, s->y + first, MSPRINGI_WIDTH, &within))
        return false;
    box around = {INFINITY, -INFINITY, INFINITY, -INFINITY};
    float fastest = 0.0f;
    cover(network, first, first + MSPRINGI_WIDTH, &around, &fastest);
    return !look_around(floor, &around, floor->reach).is_far;
}
