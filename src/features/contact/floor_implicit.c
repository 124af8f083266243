/// Floor after an implicit substep: projection of particles with springs onto the surface.
///
/// Within the substep, constraints of the linear system keep particles out (solvers/implicit/implicit_floor.c).
/// They give way a little, and some particles have none, so this corrects the state afterwards.
///
/// Contact is a condition on the velocity at the end of a substep (Moreau, 1988; Stewart and Trinkle, 1996). A
/// particle at the surface does not move into it. Friction changes its tangential speed by at most the coefficient
/// times the change of its normal speed:
///
///     v_n' = max(v_n, 0);   |v_t - v_t'| <= friction (v_n' - v_n)
///
/// with v_t' = 0 if that bound allows it. The particle is then put onto the surface, and back along it by the
/// change of the tangential speed. There is no restitution: springs throw a structure back.
#include "features/contact/floor.h"

#include <math.h>
#include <string.h>

#include "store/sleepers.h"

// Apply one straight surface to a particle. Return true if it acted.
static bool collide_line(const mspringi_line *line, mspringi_moved_particle *b, double h, double slop) {
    const double distance = line->nx * b->x + line->ny * b->y + line->offset;
    if (!(distance < slop))
        return false;
    const double across = line->nx * b->vx + line->ny * b->vy;
    const bool approaches = across < 0.0;
    if (approaches) {
        const double along = line->nx * b->vy - line->ny * b->vx;
        const double taken = mspringi_clamp_friction(along, mspringi_friction_on(line, b->own) * -across);
        b->vx += -across * line->nx + taken * line->ny;
        b->vy += -across * line->ny - taken * line->nx;
        b->x += h * taken * line->ny;
        b->y -= h * taken * line->nx;
    }
    if (distance < 0.0) {
        b->x -= distance * line->nx;
        b->y -= distance * line->ny;
    }
    return approaches || distance < 0.0;
}

static bool collide_lines(const mspringi_floor *floor, mspringi_moved_particle *b, double h, double slop) {
    const mspringi_heights *heights = &floor->heights;
    bool any = false;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        any |= collide_line(&floor->lines[i], b, h, slop);
    if (heights->count > 0) {
        const int64_t part = mspringi_heights_first_hit(heights, b->start_x, b->start_y, b->x, b->y);
        const mspringi_line line = mspringi_heights_line(heights, part);
        any |= collide_line(&line, b, h, slop);
    }
    return any;
}

void mspringi_floor_collide(const mspringi_floor *floor, mspringi_moved_particle *b, double h) {
    const double slop = mspringi_floor_slop(b->x, b->y);
    for (int round = 0; round < MSPRINGI_FLOOR_ROUNDS && collide_lines(floor, b, h, slop);)
        ++round;
    if (!(mspringi_floor_distance(floor, b->x, b->y) < -slop))
        return;
    // A narrow corner: the particle stays where it came from, if that was outside.
    if (mspringi_floor_distance(floor, b->start_x, b->start_y) >= -8.0 * slop) {
        b->x = b->start_x;
        b->y = b->start_y;
    } else {
        (void)mspringi_floor_put_outside(floor, &b->x, &b->y);
    }
    b->vx = b->vy = 0.0;
}

/* -------------------------------------------------------------------------------------------------------- slots */

static void collide_slot(const mspring_network *network, size_t slot, double h) {
    const mspringi_state *s = &network->state;
    mspringi_floor *floor = network->floor;
    const double vx = (double)s->vx[slot], vy = (double)s->vy[slot];
    mspringi_moved_particle b = {
        (double)floor->start.x[slot],  (double)floor->start.y[slot], (double)s->x[slot], (double)s->y[slot], vx, vy,
        mspringi_own_of(network, slot)};
    mspringi_floor_collide(floor, &b, h);
    if (b.vx == vx && b.vy == vy && b.x == (double)s->x[slot] && b.y == (double)s->y[slot])
        return;
    const float after_x = (float)b.vx, after_y = (float)b.vy, mass = 1.0f / network->inverse_mass[slot];
    floor->impulse.x[slot] += mass * (after_x - s->vx[slot]);
    floor->impulse.y[slot] += mass * (after_y - s->vy[slot]);
    mspringi_set_x(s, slot, b.x);
    mspringi_set_y(s, slot, b.y);
    s->vx[slot] = after_x;
    s->vy[slot] = after_y;
}

/// Action of the floor on a particle after a substep of h seconds.
typedef void (*act_fn)(const mspring_network *network, size_t slot, double h);

static void act_on_block(const mspring_network *network, size_t first, const mspringi_bounds *clear, double h,
                         act_fn act) {
    const mspringi_state *s = &network->state;
    for (size_t slot = first; slot < first + MSPRINGI_WIDTH; ++slot) {
        const bool is_clear = s->x[slot] >= clear->min_x && s->x[slot] <= clear->max_x &&
                              s->y[slot] >= clear->min_y && s->y[slot] <= clear->max_y;
        if (!is_clear && mspringi_active_inverse_mass(network)[slot] > 0.0f &&
            !mspringi_floor_is_isolated(network, slot))
            act(network, slot, h);
    }
}

// Return true if any particle was checked.
static bool act_on_spans(const mspring_network *network, const mspringi_bounds *clear, const mspringi_span *spans,
                         uint32_t span_count, double h, act_fn act) {
    const mspringi_state *s = &network->state;
    const mspringi_beyond_fn beyond = network->kernels->beyond;
    bool any = false;
    for (const mspringi_span *span = spans; span < spans + span_count; ++span) {
        const size_t first = span->first_slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        for (size_t block = first; (block = beyond(s->x, s->y, block, end, clear)) < end; block += MSPRINGI_WIDTH) {
            any = true;
            act_on_block(network, block, clear, h, act);
        }
    }
    return any;
}

static void act_on_strip(const mspring_network *network, uint32_t number, double h, act_fn act) {
    const mspringi_topology *t = &network->topology;
    const mspringi_strip *strip = &t->strips[number];
    const mspringi_bounds *clear = &network->floor->clearances[number].clear;
    const mspringi_row *first = &t->rows[strip->first_row], *last = first + strip->row_count - 1;
    bool any = act_on_spans(network, clear, &t->spans[first->first_span],
                            last->first_span + last->span_count - first->first_span, h, act);
    if (strip->assigned_span != MSPRING_NONE)
        any |= act_on_spans(network, clear, &t->spans[strip->assigned_span], 1, h, act);
    network->floor->has_impulse |= any;
}

static bool is_asleep(const mspring_network *network, uint32_t number) {
    return mspringi_sleep_state_of_strip(network, &network->topology.strips[number]) == MSPRINGI_ASLEEP;
}

void mspringi_floor_save_positions(mspring_network *network, float h) {
    mspringi_floor *floor = network->floor;
    const size_t size = mspringi_used_slots(network) * sizeof *floor->start.x;
    memcpy(floor->start.x, network->state.x, size);
    memcpy(floor->start.y, network->state.y, size);
    // A clear box of the network: in y the intersection of the strips' clear boxes, over the whole range of these
    // in x.
    mspringi_floor_update_clearances(network, (double)h);
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

static void act_on_all(const mspring_network *network, double h, act_fn act) {
    for (uint32_t i = 0; i < network->topology.strip_count; ++i)
        if (!is_asleep(network, i))
            act_on_strip(network, i, h, act);
}

void mspringi_floor_apply_all(mspring_network *network, float h) {
    mspringi_floor_update_clearances(network, (double)h);
    act_on_all(network, (double)h, collide_slot);
}

void mspringi_floor_end_interval(const mspring_network *network, float h) {
    if (mspringi_has_silt(&network->floor->heights))
        act_on_all(network, (double)h, mspringi_silt_brake);
}
