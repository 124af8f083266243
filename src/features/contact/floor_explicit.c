/// Floor in explicit substeps, and particles without springs beside any solver.
#include "features/contact/floor.h"

#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "base/decay.h"
#include "store/sleepers.h"

bool mspringi_floor_is_near(const mspring_network *network, const mspringi_strip *strip) {
    return network->floor && !network->floor->clearances[strip - network->topology.strips].is_far;
}

/// Whole blocks of slots, the end of them excluded.
typedef struct slot_range {
    size_t first, end;
} slot_range;

// Spans of rows that follow each other lie behind one another.
static slot_range slots_of(const mspringi_span *spans, uint32_t span_count) {
    const size_t width = MSPRINGI_WIDTH, end = spans[span_count - 1].end_slot;
    return (slot_range){spans->first_slot / width * width, (end + width - 1) / width * width};
}

void mspringi_floor_save_velocities(const mspring_network *network, const mspringi_strip *strip,
                                    const mspringi_span *spans, uint32_t span_count) {
    if (!mspringi_floor_is_near(network, strip))
        return;
    const mspringi_state *s = &network->state, *before = &network->floor->before;
    const slot_range slots = slots_of(spans, span_count);
    const size_t size = (slots.end - slots.first) * sizeof *s->vx;
    memcpy(before->vx + slots.first, s->vx + slots.first, size);
    memcpy(before->vy + slots.first, s->vy + slots.first, size);
}

/* ----------------------------------------------------------------------------------------------- one particle */

// Store a particle's new state, and add the change to the floor's impulses.
static void store_slot(const mspring_network *network, size_t slot, double x, double y, double vx, double vy) {
    const mspringi_state *s = &network->state;
    const mspringi_floor *floor = network->floor;
    const float after_x = (float)vx, after_y = (float)vy, mass = 1.0f / network->inverse_mass[slot];
    floor->impulse.x[slot] += mass * (after_x - s->vx[slot]);
    floor->impulse.y[slot] += mass * (after_y - s->vy[slot]);
    mspringi_set_x(s, slot, x);
    mspringi_set_y(s, slot, y);
    mspringi_set_velocity(s, slot, after_x, after_y);
}

static void bounce_slot(const mspring_network *network, const mspringi_floor_args *g, size_t slot) {
    const double from_vx = (double)g->from_vx[slot], from_vy = (double)g->from_vy[slot];
    mspringi_bouncing_particle p =
        mspringi_bouncing_particle_from((double)g->x[slot], (double)g->y[slot], (double)g->vx[slot],
                                        (double)g->vy[slot], from_vx, from_vy, g->damping, g->h, g->per_length);
    p.own = mspringi_own_of(network, slot);
    if (mspringi_floor_bounce(network->floor, g->h, from_vx, from_vy, &p))
        store_slot(network, slot, p.x + g->h * p.vx, p.y + g->h * p.vy, p.vx, p.vy);
}

static void fly_slot(const mspring_network *network, const mspringi_floor_args *g, size_t slot) {
    const mspringi_bounce_params how = {.h = g->h, .skew = 0.5 * g->h};
    mspringi_free_particle p = mspringi_free_particle_from(
        (double)g->x[slot], (double)g->y[slot], (double)g->vx[slot], (double)g->vy[slot], (double)g->from_vx[slot],
        (double)g->from_vy[slot], g->damping, g->h);
    p.own = mspringi_own_of(network, slot);
    double vx, vy;
    if (mspringi_floor_move_free_particle(network->floor, &how, &p, &vx, &vy))
        store_slot(network, slot, p.x, p.y, vx, vy);
}

// Damping of velocities that lose the share `loss` while forces act for `time`, before they move for h.
static mspringi_damping damping_of(const mspring_network *network, float h, float time, float loss) {
    return (mspringi_damping){.keep = 1.0 - (double)loss,
                              .scale = (double)h / (double)mspringi_gain(network->settings.global_damping, time)};
}

// Arguments of the floor kernel.
static mspringi_floor_args args_of(const mspring_network *network, const mspringi_bounds *clear,
                                   const mspringi_sweep *substep, bool is_loose) {
    const mspringi_floor *floor = network->floor;
    const float h = substep->h;
    return (mspringi_floor_args){
        .lines = floor->lines,
        .line_count = floor->plane_count,
        .height_count = floor->heights.count,
        .heights = floor->heights.heights,
        .normals = floor->heights.normals,
        .left = floor->heights.local_x,
        .bottom = floor->heights.local_y,
        .spacing = floor->heights.spacing,
        .frictions = floor->heights.frictions,
        .restitutions = floor->heights.restitutions,
        .friction = floor->friction,
        .restitution = floor->restitution,
        .h = (double)h,
        .per_length = 4.0 * (double)h / network->shortest,
        .clear = *clear,
        .x = network->state.x,
        .y = network->state.y,
        .vx = network->state.vx,
        .vy = network->state.vy,
        .from_vx = floor->before.vx,
        .from_vy = floor->before.vy,
        .low_x = network->state.low_x,
        .low_y = network->state.low_y,
        .low_vx = network->state.low_vx,
        .low_vy = network->state.low_vy,
        .grid = network->state.grid,
        .before_vx = floor->before.vx,
        .before_vy = floor->before.vy,
        .silt_depth = floor->heights.silt_depth,
        .silt_rate = floor->heights.silt_rate,
        .silt_depths = floor->heights.silt_depths,
        .damping = damping_of(network, h, substep->time, is_loose ? substep->damping_loss : substep->loss),
        .impulse_x = floor->impulse.x,
        .impulse_y = floor->impulse.y,
        .inverse_mass = network->inverse_mass,
        .active_inverse_mass = mspringi_active_inverse_mass(network),
        .own = NULL, // all members are given, so nothing is cleared first
    };
}

// Apply the floor to a block whose particles may have friction and restitution of their own.
static MSPRINGI_NOINLINE uint32_t act_with_own(const mspring_network *network, const mspringi_floor_args *args,
                                               mspringi_floor_fn act, size_t block) {
    if (!mspringi_contact_own(network, block)) // then no particle has any
        return act(args, block);
    mspringi_contact_material own[MSPRINGI_WIDTH];
    mspringi_floor_args with = *args;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        own[i] = *mspringi_contact_own(network, block + i);
    with.own = own;
    return act(&with, block);
}

// Apply the floor to a block. bare: box without surface, but perhaps with silt. may_pass: a particle may have come
// from below the surface.
static void touch_block(const mspring_network *network, const mspringi_floor_args *args,
                        const mspringi_bounds *bare, bool may_pass, bool is_loose, size_t block) {
    const mspringi_floor_fn act = is_loose ? network->kernels->bounce_free : network->kernels->bounce;
    if (mspringi_has_silt(&network->floor->heights)) {
        network->kernels->brake(args, block);
        if (!may_pass && network->kernels->beyond(args->x, args->y, block, block + MSPRINGI_WIDTH, bare) != block)
            return;
    }
    uint32_t left = network->contacts ? act_with_own(network, args, act, block) : act(args, block);
    for (size_t slot = block; left != 0; ++slot, left >>= 1)
        if ((left & 1) && is_loose)
            fly_slot(network, args, slot);
        else if (left & 1)
            bounce_slot(network, args, slot);
}

static const mspringi_bounds *clear_of(const mspring_network *network, const mspringi_strip *strip) {
    return &network->floor->clearances[strip - network->topology.strips].clear;
}

// Mark of a block: 1 if a particle was not clear after the last substep, and so may pass a ridge in the next. Of
// strips near heights.
static uint8_t *mark_of(const mspring_network *network, size_t slot) {
    uint8_t *marks = (uint8_t *)(network->floor->clearances + network->topology.strip_count);
    return marks + slot / MSPRINGI_WIDTH;
}

// The first marked block before `next`, or `next`.
static size_t next_marked(const mspring_network *network, size_t block, size_t next) {
    for (const uint8_t *mark = mark_of(network, block); block < next && !*mark; ++mark)
        block += MSPRINGI_WIDTH;
    return block < next ? block : next;
}

// Apply the floor to blocks that are not clear, or were not before the substep: a particle may have passed a ridge
// on its way to a clear place. next: the first block that is not clear.
static void touch_marked(const mspring_network *network, const mspringi_floor_args *args,
                         const mspringi_bounds *bare, bool is_loose, slot_range slots, size_t next) {
    const mspringi_beyond_fn beyond = network->kernels->beyond;
    const float *x = args->x, *y = args->y;
    for (size_t block; (block = next_marked(network, slots.first, next)) < slots.end; slots.first = block) {
        const bool is_beyond = block == next;
        uint8_t *mark = mark_of(network, block);
        touch_block(network, args, bare, *mark, is_loose, block);
        *mark = is_beyond || beyond(x, y, block, block + MSPRINGI_WIDTH, &args->clear) == block;
        block += MSPRINGI_WIDTH;
        next = is_beyond ? beyond(x, y, block, slots.end, &args->clear) : next;
    }
}

// Apply the floor to the blocks of a strip that are not clear.
static void touch_slots(const mspring_network *network, const mspringi_strip *strip, bool is_loose,
                        slot_range slots, const mspringi_sweep *substep) {
    const mspringi_bounds *clear = clear_of(network, strip);
    const mspringi_beyond_fn beyond = network->kernels->beyond;
    const mspringi_floor *floor = network->floor;
    const float *x = network->state.x, *y = network->state.y;
    size_t block = beyond(x, y, slots.first, slots.end, clear);
    const bool has_heights = floor->heights.count > 0;
    if (block == slots.end && (!has_heights || next_marked(network, slots.first, block) == slots.end))
        return;
    const mspringi_floor_args args = args_of(network, clear, substep, is_loose);
    const mspringi_bounds bare = {clear->min_x, clear->max_x,
                                  floor->clearances[strip - network->topology.strips].bare, clear->max_y};
    if (has_heights) {
        touch_marked(network, &args, &bare, is_loose, slots, block);
        return;
    }
    for (; block < slots.end; block = beyond(x, y, block + MSPRINGI_WIDTH, slots.end, clear))
        touch_block(network, &args, &bare, false, is_loose, block);
}

void mspringi_floor_apply(const mspring_network *network, const mspringi_strip *strip, const mspringi_span *spans,
                          uint32_t span_count, const mspringi_sweep *substep) {
    if (mspringi_floor_is_near(network, strip))
        touch_slots(network, strip, false, slots_of(spans, span_count), substep);
}

void mspringi_floor_apply_loose(const mspring_network *network, const mspringi_strip *strip,
                                const mspringi_span *span, const mspringi_sweep *substep) {
    if (mspringi_floor_is_near(network, strip))
        touch_slots(network, strip, true, slots_of(span, 1), substep);
}

/* ---------------------------------------------------------------------------------------------------- clearance */

// Slots of a strip's rows.
static slot_range row_slots_of(const mspring_network *network, const mspringi_strip *strip) {
    const mspringi_topology *t = &network->topology;
    const mspringi_row *first = &t->rows[strip->first_row], *last = first + strip->row_count - 1;
    return slots_of(&t->spans[first->first_span], last->first_span + last->span_count - first->first_span);
}

// True if slots are clear, and so slow that they were throughout the substeps, if they were never faster.
static bool is_clear(const mspring_network *network, const mspringi_strip *strip, slot_range slots) {
    const mspringi_state *s = &network->state;
    const mspringi_largest_fn largest = network->kernels->largest;
    const size_t count = slots.end - slots.first;
    const double way = 0.5 * network->floor->reach, seconds = network->floor->seconds;
    return network->kernels->beyond(s->x, s->y, slots.first, slots.end, clear_of(network, strip)) == slots.end &&
           seconds * (double)largest(s->vx + slots.first, NULL, count).value <= way &&
           seconds * (double)largest(s->vy + slots.first, NULL, count).value <= way;
}

static bool is_strip_clear(const mspring_network *network, const mspringi_strip *strip) {
    const mspringi_topology *t = &network->topology;
    return is_clear(network, strip, row_slots_of(network, strip)) &&
           (strip->assigned_span == MSPRING_NONE ||
            is_clear(network, strip, slots_of(&t->spans[strip->assigned_span], 1)));
}

static void mark_slots(const mspring_network *network, const mspringi_strip *strip, slot_range slots) {
    const mspringi_state *s = &network->state;
    for (size_t block = slots.first, next; block < slots.end; block = next + MSPRINGI_WIDTH) {
        uint8_t *mark = mark_of(network, block);
        next = network->kernels->beyond(s->x, s->y, block, slots.end, clear_of(network, strip));
        memset(mark, 0, (next - block) / MSPRINGI_WIDTH);
        if (next < slots.end)
            *mark_of(network, next) = 1;
    }
}

void mspringi_floor_mark_blocks(const mspring_network *network, const mspringi_strip *strip) {
    mark_slots(network, strip, row_slots_of(network, strip));
    if (strip->assigned_span != MSPRING_NONE)
        mark_slots(network, strip, slots_of(&network->topology.spans[strip->assigned_span], 1));
}

void mspringi_floor_check_clear(const mspring_network *network) {
    mspringi_floor *floor = network->floor;
    for (uint32_t i = 0; i < network->topology.strip_count && !floor->is_missed; ++i)
        floor->is_missed =
            floor->clearances[i].is_far &&
            mspringi_sleep_state_of_strip(network, &network->topology.strips[i]) != MSPRINGI_ASLEEP &&
            !is_strip_clear(network, &network->topology.strips[i]);
}

/* ---------------------------------------------------------------------------------------------- other solvers */

static slot_range loose_slots(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const size_t first = (size_t)t->loose_first * MSPRINGI_WIDTH;
    return (slot_range){first, t->spare_blocks > 0 ? mspringi_used_slots(network)
                                                   : first + (size_t)t->loose_blocks * MSPRINGI_WIDTH};
}

bool mspringi_floor_is_isolated(const mspring_network *network, size_t slot) {
    const mspringi_solver *solver = network->running;
    return solver->ops->is_isolated(network, solver->object, slot);
}

// Slots among which all isolated particles lie.
static slot_range isolated_slots(const mspring_network *network) {
    const mspringi_solver *solver = network->running;
    slot_range slots = loose_slots(network);
    if (solver->ops->has_isolated && solver->ops->has_isolated(solver->object))
        slots.first = 0;
    return slots;
}

void mspringi_floor_save_isolated(const mspring_network *network) {
    const slot_range slots = isolated_slots(network);
    const mspringi_state *s = &network->state, *before = &network->floor->before;
    const size_t size = (slots.end - slots.first) * sizeof *s->x;
    memcpy(before->x + slots.first, s->x + slots.first, size);
    memcpy(before->y + slots.first, s->y + slots.first, size);
    memcpy(before->low_x + slots.first, s->low_x + slots.first, size);
    memcpy(before->low_y + slots.first, s->low_y + slots.first, size);
    memcpy(before->vx + slots.first, s->vx + slots.first, size);
    memcpy(before->vy + slots.first, s->vy + slots.first, size);
}

/// A substep of particles without springs.
typedef struct gliding {
    mspringi_bounce_params how;
    double before, after;     ///< what global damping leaves of velocities before and after the parabola
    mspringi_damping damping; ///< within it
} gliding;

// Velocities of leapfrog skew by half a substep and are damped within it. After implicit substeps damping
// acts before and after a parabola (Strang, 1968), so that it takes energy whatever bounces there are: as a part of
// the acceleration, found before a bounce, it gave some after it.
static gliding glide(const mspring_network *network, float h) {
    const float rate = network->settings.global_damping;
    const bool skews = network->running->ops->is_staggered;
    const double half = skews ? 1.0 : (double)mspringi_decay(rate, 0.5f * h);
    return (gliding){.how = {.h = (double)h, .skew = skews ? 0.5 * (double)h : 0.0},
                     .before = half,
                     .after = half,
                     .damping =
                         skews ? damping_of(network, h, h, mspringi_loss(rate, h)) : (mspringi_damping){1.0, 1.0}};
}

// A substep with an acceleration of (ax, ay).
static void fly_free(const mspring_network *network, size_t slot, const gliding *g, double ax, double ay) {
    const mspringi_state *s = &network->state;
    const double h = g->how.h, vx = g->before * (double)s->vx[slot], vy = g->before * (double)s->vy[slot];
    const double change_x = h * ax, change_y = h * ay;
    double to_vx = g->damping.keep * vx + change_x / g->damping.scale;
    double to_vy = g->damping.keep * vy + change_y / g->damping.scale;
    mspringi_free_particle p = {.ax = ax, .ay = ay, .left = h, .own = mspringi_own_of(network, slot)};
    p.x = (double)s->x[slot] + (double)s->low_x[slot];
    p.y = (double)s->y[slot] + (double)s->low_y[slot];
    p.wx = g->how.skew > 0.0 ? to_vx - 0.5 * change_x : vx;
    p.wy = g->how.skew > 0.0 ? to_vy - 0.5 * change_y : vy;
    mspringi_set_velocity(s, slot, (float)(g->after * to_vx), (float)(g->after * to_vy));
    const double taken = mspringi_silt_damping(&network->floor->heights, p.x, p.y, h);
    p.wx -= taken * p.wx;
    p.wy -= taken * p.wy;
    if (mspringi_floor_move_free_particle(network->floor, &g->how, &p, &to_vx, &to_vy) || taken > 0.0) {
        store_slot(network, slot, p.x, p.y, g->after * to_vx, g->after * to_vy);
        return;
    }
    mspringi_set_x(s, slot, p.x);
    mspringi_set_y(s, slot, p.y);
}

void mspringi_floor_step_isolated(mspring_network *network, float h, mspringi_field base, uint32_t count) {
    const mspringi_state *s = &network->state, *before = &network->floor->before;
    const slot_range slots = isolated_slots(network);
    const float *inverse_mass = mspringi_active_inverse_mass(network);
    const gliding how = glide(network, h);
    for (size_t slot = slots.first; slot < slots.end; ++slot) {
        if (!(inverse_mass[slot] > 0.0f) || !mspringi_floor_is_isolated(network, slot))
            continue;
        const double per_mass = (double)inverse_mass[slot];
        const double ax = (double)network->settings.gravity_x + (base.x ? (double)base.x[slot] * per_mass : 0.0);
        const double ay = (double)network->settings.gravity_y + (base.x ? (double)base.y[slot] * per_mass : 0.0);
        s->x[slot] = before->x[slot];
        s->y[slot] = before->y[slot];
        s->low_x[slot] = before->low_x[slot];
        s->low_y[slot] = before->low_y[slot];
        s->vx[slot] = before->vx[slot];
        s->vy[slot] = before->vy[slot];
        for (uint32_t i = 0; i < count; ++i)
            fly_free(network, slot, &how, ax, ay);
    }
    network->floor->has_impulse = true;
}
