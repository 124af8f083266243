/// What the surface does to a particle after a substep.
///
/// A particle that touches the surface (after Moreau, 1988, and Stewart and Trinkle, 1996: contact as a condition
/// on the velocity at the end of a substep) does not move into it, and what friction takes from its velocity along
/// the surface is at most friction times what the surface has given it across:
///
///     v_n' = max(v_n, 0), or -restitution v_n if it comes from afar;   |v_t - v_t'| <= friction (v_n' - v_n)
///
/// with v_t' = 0 where that is enough. The position follows: the particle lies on the surface, less far along it by
/// what friction has taken. So a substep into the surface takes energy, and one along it under sticking friction
/// does not move the particle at all.
#include "floor.h"

#include <math.h>
#include <string.h>

#include "sleep/sleep.h"

/// Times that all surfaces are gone through for one particle: corners need more than one.
#define ROUNDS 4

// How far friction moves a body back along a surface, of what it has gone to the left of the way that the surface
// faces: the most or, if it is to stop where it began, no more than that.
static double way_back(const mspringi_line *line, const mspringi_body *b, double most) {
    if (!b->is_stopped_at_start)
        return most;
    const double gone = line->nx * (b->y - b->start_y) - line->ny * (b->x - b->start_x);
    return most > 0.0 ? fmin(most, fmax(gone, 0.0)) : fmax(most, fmin(gone, 0.0));
}

// Let one straight surface act on a body. Returns whether it did anything.
static bool touch(const mspringi_floor *floor, const mspringi_line *line, mspringi_body *b, double h, double slop) {
    const double distance = line->nx * b->x + line->ny * b->y + line->offset;
    if (!(distance < slop))
        return false;
    const double across = line->nx * b->vx + line->ny * b->vy;
    const bool approaches = across < 0.0;
    if (approaches) {
        const double before = line->nx * b->start_x + line->ny * b->start_y + line->offset;
        const double given = (before > 2.0 * slop ? -b->restitution * across : 0.0) - across;
        const double along = line->nx * b->vy - line->ny * b->vx, most = floor->friction * given;
        const double taken = along > most ? most : along < -most ? -most : along;
        b->vx += given * line->nx + taken * line->ny;
        b->vy += given * line->ny - taken * line->nx;
        const double back = way_back(line, b, h * taken);
        b->x += back * line->ny;
        b->y -= back * line->nx;
    }
    if (distance < 0.0) {
        b->x -= distance * line->nx;
        b->y -= distance * line->ny;
    }
    return approaches || distance < 0.0;
}

static int64_t touch_heights(const mspringi_floor *floor, mspringi_body *b, double h, double slop, bool *any) {
    const mspringi_heights *heights = &floor->heights;
    const int64_t part = mspringi_heights_part_met(heights, b->start_x, b->start_y, b->x, b->y);
    const mspringi_line line = mspringi_heights_line(heights, part);
    *any |= touch(floor, &line, b, h, slop);
    return part;
}

static bool touch_all(const mspringi_floor *floor, mspringi_body *b, double h, double slop) {
    bool any = false;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        any |= touch(floor, &floor->lines[i], b, h, slop);
    if (floor->heights.count > 0)
        (void)touch_heights(floor, b, h, slop, &any);
    return any;
}

// The same where there is only one surface to look at. Returns whether that was all.
static bool touch_one(const mspringi_floor *floor, mspringi_body *b, double h, double slop) {
    bool any = false;
    if (floor->plane_count == 0)
        return touch_heights(floor, b, h, slop, &any) == mspringi_heights_part_below(&floor->heights, b->x);
    if (floor->plane_count > 1 || floor->heights.count > 0)
        return false;
    (void)touch(floor, &floor->lines[0], b, h, slop);
    return true;
}

// Put a body that was inside the surface before the substep onto it.
static void lift(const mspringi_floor *floor, mspringi_body *b) {
    for (uint32_t i = 0; i < floor->plane_count; ++i) {
        const mspringi_line *line = &floor->lines[i];
        const double distance = line->nx * b->x + line->ny * b->y + line->offset;
        b->x -= distance < 0.0 ? distance * line->nx : 0.0;
        b->y -= distance < 0.0 ? distance * line->ny : 0.0;
    }
    if (floor->heights.count > 0) {
        const mspringi_heights *heights = &floor->heights;
        const mspringi_line line = mspringi_heights_line(heights, mspringi_heights_part_below(heights, b->x));
        b->y = fmax(b->y, -(line.nx * b->x + line.offset) / line.ny);
    }
}

void mspringi_floor_collide(const mspringi_floor *floor, mspringi_body *b, double h) {
    const double slop = mspringi_floor_slop(b->x, b->y);
    if (touch_one(floor, b, h, slop))
        return;
    for (int round = 0; round < ROUNDS && touch_all(floor, b, h, slop);)
        ++round;
    if (!(mspringi_floor_distance(floor, b->x, b->y) < -slop))
        return;
    // A narrow corner: the particle stays where it came from, if that was outside.
    if (mspringi_floor_distance(floor, b->start_x, b->start_y) >= -8.0 * slop) {
        b->x = b->start_x;
        b->y = b->start_y;
    } else {
        lift(floor, b);
    }
    b->vx = b->vy = 0.0;
}

/* -------------------------------------------------------------------------------------------------------- slots */

// start: where the slots were before the substep; NULL: where they come from at the velocity they have.
static void collide_slot(const mspring_network *network, const mspringi_field *start, size_t slot, double h) {
    const mspringi_state *s = &network->state;
    mspringi_floor *floor = network->floor;
    const double vx = (double)s->vx[slot], vy = (double)s->vy[slot];
    mspringi_body b = {.x = (double)s->x[slot], .y = (double)s->y[slot], .vx = vx, .vy = vy};
    // After implicit substeps it is the springs that throw a structure back, and not the speed of a particle of it.
    const bool is_loose = slot >= (size_t)network->topology.loose_first * MSPRINGI_WIDTH;
    b.restitution = !start || is_loose ? floor->restitution : 0.0;
    b.is_stopped_at_start = start && is_loose;
    b.start_x = start ? (double)start->x[slot] : b.x - h * vx;
    b.start_y = start ? (double)start->y[slot] : b.y - h * vy;
    mspringi_floor_collide(floor, &b, h);
    if (b.vx == vx && b.vy == vy && b.x == (double)s->x[slot] && b.y == (double)s->y[slot])
        return;
    const float after_x = (float)b.vx, after_y = (float)b.vy, mass = 1.0f / network->inverse_mass[slot];
    floor->impulse.x[slot] += mass * (after_x - s->vx[slot]);
    floor->impulse.y[slot] += mass * (after_y - s->vy[slot]);
    s->x[slot] = (float)b.x;
    s->y[slot] = (float)b.y;
    s->vx[slot] = after_x;
    s->vy[slot] = after_y;
}

static void collide_block(const mspring_network *network, const mspringi_field *start, size_t first,
                          const mspringi_bounds *clear, double h) {
    const mspringi_state *s = &network->state;
    for (size_t slot = first; slot < first + MSPRINGI_WIDTH; ++slot) {
        const bool is_clear = s->x[slot] >= clear->min_x && s->x[slot] <= clear->max_x &&
                              s->y[slot] >= clear->min_y && s->y[slot] <= clear->max_y;
        if (!is_clear && mspringi_free_mass(network)[slot] > 0.0f)
            collide_slot(network, start, slot, h);
    }
}

mspringi_ground mspringi_floor_ground(const mspring_network *network, const mspringi_bounds *clear, float h) {
    const mspringi_floor *floor = network->floor;
    return (mspringi_ground){
        .lines = floor->lines,
        .line_count = floor->plane_count,
        .height_count = floor->heights.count,
        .heights = floor->heights.heights,
        .normals = floor->heights.normals,
        .left = floor->heights.local_x,
        .bottom = floor->heights.local_y,
        .spacing = floor->heights.spacing,
        .friction = floor->friction,
        .restitution = floor->restitution,
        .h = (double)h,
        .clear = *clear,
        .x = network->state.x,
        .y = network->state.y,
        .vx = network->state.vx,
        .vy = network->state.vy,
        .impulse_x = floor->impulse.x,
        .impulse_y = floor->impulse.y,
        .inverse_mass = network->inverse_mass,
        .free_mass = mspringi_free_mass(network),
    };
}

void mspringi_floor_touch_block(const mspring_network *network, const mspringi_ground *ground, size_t first) {
    uint32_t left = network->kernels->touch(ground, first);
    for (size_t slot = first; left != 0; ++slot, left >>= 1)
        if (left & 1)
            collide_slot(network, NULL, slot, ground->h);
}

// Returns whether any particle was looked at.
static bool touch_spans(const mspring_network *network, const mspringi_field *start, const mspringi_bounds *clear,
                        const mspringi_span *spans, uint32_t span_count, float h) {
    const mspringi_state *s = &network->state;
    const mspringi_ground ground = mspringi_floor_ground(network, clear, h);
    bool any = false;
    for (const mspringi_span *span = spans; span < spans + span_count; ++span) {
        const size_t first = span->first_slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        if (!network->kernels->leaves(s->x + first, s->y + first, end - first, clear))
            continue;
        any = true;
        for (size_t block = first; block < end; block += MSPRINGI_WIDTH)
            if (!network->kernels->leaves(s->x + block, s->y + block, MSPRINGI_WIDTH, clear))
                continue;
            else if (start)
                collide_block(network, start, block, clear, (double)h);
            else
                mspringi_floor_touch_block(network, &ground, block);
    }
    return any;
}

bool mspringi_floor_is_near(const mspring_network *network, const mspringi_strip *strip) {
    return network->floor && !network->floor->clearances[strip - network->topology.strips].is_far;
}

void mspringi_floor_touch(const mspring_network *network, const mspringi_strip *strip, const mspringi_span *spans,
                          uint32_t span_count, float h) {
    if (!mspringi_floor_is_near(network, strip))
        return;
    const mspringi_clearance *clearance = &network->floor->clearances[strip - network->topology.strips];
    (void)touch_spans(network, NULL, &clearance->clear, spans, span_count, h);
}

static void touch_strip(const mspring_network *network, const mspringi_field *start, uint32_t number, float h) {
    const mspringi_topology *t = &network->topology;
    const mspringi_strip *strip = &t->strips[number];
    const mspringi_bounds *clear = &network->floor->clearances[number].clear;
    const mspringi_row *first = &t->rows[strip->first_row], *last = first + strip->row_count - 1;
    bool any = touch_spans(network, start, clear, &t->spans[first->first_span],
                           last->first_span + last->span_count - first->first_span, h);
    if (strip->home_span != MSPRING_NONE)
        any |= touch_spans(network, start, clear, &t->spans[strip->home_span], 1, h);
    network->floor->has_impulse |= any;
}

static bool is_asleep(const mspring_network *network, uint32_t number) {
    return mspringi_share_of_strip(network, &network->topology.strips[number]) == MSPRINGI_ASLEEP;
}

void mspringi_floor_touch_far(const mspring_network *network, float h) {
    for (uint32_t i = 0; i < network->topology.strip_count; ++i)
        if (network->floor->clearances[i].is_far && !is_asleep(network, i))
            touch_strip(network, NULL, i, h);
}

void mspringi_floor_keep(mspring_network *network, float h) {
    mspringi_floor *floor = network->floor;
    const size_t size = mspringi_slot_count(network) * sizeof *floor->start.x;
    memcpy(floor->start.x, network->state.x, size);
    memcpy(floor->start.y, network->state.y, size);
    // What is clear around all strips is clear around the network.
    mspringi_floor_survey(network, (double)h);
    floor->clear = (mspringi_bounds){INFINITY, -INFINITY, -INFINITY, INFINITY};
    for (uint32_t i = 0; i < network->topology.strip_count; ++i) {
        if (is_asleep(network, i))
            continue;
        const mspringi_bounds *other = &floor->clearances[i].clear;
        floor->clear.min_x = fminf(floor->clear.min_x, other->min_x);
        floor->clear.max_x = fmaxf(floor->clear.max_x, other->max_x);
        floor->clear.min_y = fmaxf(floor->clear.min_y, other->min_y);
        floor->clear.max_y = fminf(floor->clear.max_y, other->max_y);
    }
}

void mspringi_floor_touch_all(mspring_network *network, float h) {
    mspringi_floor_survey(network, (double)h);
    for (uint32_t i = 0; i < network->topology.strip_count; ++i)
        if (!is_asleep(network, i))
            touch_strip(network, &network->floor->start, i, h);
}
