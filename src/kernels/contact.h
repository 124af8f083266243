/// @file contact.h
/// What a floor does to the particles of a block after a substep, all at once: the operations of bounce.c, in its
/// order, for what most particles do in most substeps. Plain C in blocks of MSPRINGI_WIDTH lanes, as in
/// system_assemble.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONTACT_H
#define MSPRINGI_CONTACT_H

#include "kernels/bounce.h"

#include <string.h>

/// Particles as mspringi_going has them, and 1 or 0 for what is true of them or not.
typedef struct touching {
    double x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH], vx[MSPRINGI_WIDTH], vy[MSPRINGI_WIDTH];
    double half_x[MSPRINGI_WIDTH], half_y[MSPRINGI_WIDTH], most_restitution[MSPRINGI_WIDTH];
    double square[MSPRINGI_WIDTH], slop[MSPRINGI_WIDTH];
    double is_hit[MSPRINGI_WIDTH];  ///< a surface has acted on it
    double is_left[MSPRINGI_WIDTH]; ///< to others
} touching;

/// The straight part of a field of heights below each body.
typedef struct parts_below {
    double number[MSPRINGI_WIDTH];
    double nx[MSPRINGI_WIDTH], ny[MSPRINGI_WIDTH], offset[MSPRINGI_WIDTH];
    double friction[MSPRINGI_WIDTH], restitution[MSPRINGI_WIDTH];
} parts_below;

/// Straight surfaces: the same one for each particle, or one for each, stride apart.
typedef struct surfaces {
    const double *nx, *ny, *offset, *friction, *restitution;
    size_t stride;
} surfaces;

MSPRINGI_BOUNCE_INLINE surfaces surfaces_of_line(const mspringi_line *line) {
    return (surfaces){&line->nx, &line->ny, &line->offset, &line->friction, &line->restitution, 0};
}

MSPRINGI_BOUNCE_INLINE surfaces surfaces_of_parts(const parts_below *parts) {
    return (surfaces){parts->nx, parts->ny, parts->offset, parts->friction, parts->restitution, 1};
}

static inline mspringi_going going_at(const touching *b, size_t i) {
    return (mspringi_going){.x = b->x[i],
                            .y = b->y[i],
                            .vx = b->vx[i],
                            .vy = b->vy[i],
                            .half_x = b->half_x[i],
                            .half_y = b->half_y[i],
                            .most_restitution = b->most_restitution[i]};
}

// Whether any flag is 1: by their bits, since adding them up would take one after the other.
static inline bool is_any(const double *flags) {
    uint64_t bits[MSPRINGI_WIDTH], all = 0;
    memcpy(bits, flags, sizeof bits);
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        all |= bits[i];
    return all != 0;
}

// Which particles a floor may act on.
static void find_held(const mspringi_ground *g, size_t slot, double *restrict is_held) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot, *restrict free_mass = g->free_mass + slot;
    const mspringi_bounds clear = g->clear;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const bool is_clear =
            (x[i] >= clear.min_x) & (x[i] <= clear.max_x) & (y[i] >= clear.min_y) & (y[i] <= clear.max_y);
        is_held[i] = ((free_mass[i] > 0.0f) & !is_clear) ? 1.0 : 0.0;
    }
}

static void load_touching(const mspringi_ground *g, size_t slot, touching *restrict b) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot;
    const float *restrict vx = g->vx + slot, *restrict vy = g->vy + slot;
    const float *restrict from_vx = g->from_vx + slot, *restrict from_vy = g->from_vy + slot;
    const double h = g->h, undamped = g->undamped, per_length = g->per_length;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const mspringi_going p =
            mspringi_going_from((double)x[i], (double)y[i], (double)vx[i], (double)vy[i], (double)from_vx[i],
                                (double)from_vy[i], undamped, h, per_length);
        b->x[i] = p.x;
        b->y[i] = p.y;
        b->vx[i] = p.vx;
        b->vy[i] = p.vy;
        b->half_x[i] = p.half_x;
        b->half_y[i] = p.half_y;
        b->most_restitution[i] = p.most_restitution;
        b->square[i] = mspringi_going_square(&p);
        b->slop[i] = 0x1p-21 * (fabs(p.x) + fabs(p.y)) + 1e-12;
        b->is_hit[i] = b->is_left[i] = 0.0;
    }
}

// Let a straight surface act on each particle.
MSPRINGI_BOUNCE_INLINE void touch_line(const mspringi_ground *g, surfaces s, touching *restrict b) {
    const double *restrict nx = s.nx, *restrict ny = s.ny, *restrict offset = s.offset;
    const double *restrict friction = s.friction, *restrict restitution = s.restitution;
    const double h = g->h;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        mspringi_going p = going_at(b, i);
        const double was_hit = b->is_hit[i];
        const size_t at = i * s.stride;
        const double is_hit =
            mspringi_turn_going(nx[at], ny[at], offset[at], friction[at], restitution[at], h, 0.0, &p);
        b->x[i] = p.x;
        b->y[i] = p.y;
        b->vx[i] = p.vx;
        b->vy[i] = p.vy;
        b->is_hit[i] = was_hit + is_hit;
    }
}

// Whether a straight surface would act on any particle; those that were beyond it are left. (Of several surfaces,
// most are far from most blocks.)
MSPRINGI_BOUNCE_INLINE bool look_at_line(const mspringi_ground *g, surfaces s, const double *restrict is_held,
                                         touching *restrict b) {
    const double *restrict all_nx = s.nx, *restrict all_ny = s.ny, *restrict all_offset = s.offset;
    const double h = g->h;
    double any[MSPRINGI_WIDTH];
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double nx = all_nx[i * s.stride], ny = all_ny[i * s.stride];
        const double distance = nx * b->x[i] + ny * b->y[i] + all_offset[i * s.stride];
        const double across = nx * b->vx[i] + ny * b->vy[i];
        any[i] = distance + h * across < 0.0 ? is_held[i] : 0.0;
        b->is_left[i] += distance < -b->slop[i] ? 1.0 : 0.0;
    }
    return is_any(any);
}

/* ------------------------------------------------------------------------------------------------------ heights */

// The numbers of the parts that are below so many x.
static inline void find_parts(const mspringi_ground *g, const double *restrict x, double *restrict numbers) {
    const double left = g->left, spacing = g->spacing, last = (double)(g->height_count - 1);
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        numbers[i] = (x[i] - left) / spacing;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        numbers[i] = numbers[i] >= 0.0 ? numbers[i] : -1.0;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        numbers[i] = numbers[i] < last ? numbers[i] : last;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        numbers[i] = (double)(int32_t)numbers[i];
}

// Friction or restitution of the parts: the level ones go on as the outermost others.
static void find_values(const mspringi_ground *g, const float *values, double uniform,
                        const double *restrict number, double *restrict to) {
    const int32_t last = (int32_t)g->height_count - 2;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        to[i] = uniform;
    if (!values)
        return;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const int32_t part = (int32_t)number[i], not_less = part < 0 ? 0 : part;
        to[i] = (double)values[not_less < last ? not_less : last];
    }
}

static void find_lines(const mspringi_ground *g, parts_below *parts) {
    const int32_t last = (int32_t)g->height_count - 1;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const int32_t part = (int32_t)parts->number[i], knot = part < 0 ? 0 : part;
        const double x = g->left + (double)knot * g->spacing, y = g->bottom + (double)g->heights[knot];
        const bool is_level = part < 0 || part >= last;
        parts->nx[i] = is_level ? 0.0 : g->normals[2 * (size_t)knot];
        parts->ny[i] = is_level ? 1.0 : g->normals[2 * (size_t)knot + 1];
        parts->offset[i] = is_level ? -y : -(parts->nx[i] * x + parts->ny[i] * y);
    }
    find_values(g, g->frictions, g->friction, parts->number, parts->friction);
    find_values(g, g->restitutions, g->restitution, parts->number, parts->restitution);
}

// Leave those that are not above or below the same part any more.
static void leave_moved(const mspringi_ground *g, const parts_below *parts, const double *restrict x,
                        double *restrict is_left) {
    double numbers[MSPRINGI_WIDTH];
    find_parts(g, x, numbers);
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        is_left[i] += numbers[i] != parts->number[i] ? 1.0 : 0.0;
}

static inline void find_ends(const mspringi_ground *g, const touching *restrict b, double *restrict x) {
    const double h = g->h;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        x[i] = b->x[i] + h * b->vx[i];
}

static void begin_heights(const mspringi_ground *g, touching *b, parts_below *parts) {
    double ends[MSPRINGI_WIDTH];
    find_ends(g, b, ends);
    find_parts(g, ends, parts->number);
    find_lines(g, parts);
    leave_moved(g, parts, b->x, b->is_left);
}

static void touch_heights(const mspringi_ground *g, const parts_below *parts, const double *is_held, touching *b) {
    double ends[MSPRINGI_WIDTH];
    if (g->line_count > 0) {
        find_ends(g, b, ends);
        leave_moved(g, parts, ends, b->is_left);
        leave_moved(g, parts, b->x, b->is_left);
    }
    const surfaces below = surfaces_of_parts(parts);
    if (look_at_line(g, below, is_held, b))
        touch_line(g, below, b);
    find_ends(g, b, ends);
    leave_moved(g, parts, ends, b->is_left);
    leave_moved(g, parts, b->x, b->is_left);
}

/* ------------------------------------------------------------------------------------------------------ blocks */

// Leave those that come beyond a straight surface.
MSPRINGI_BOUNCE_INLINE void leave_beyond(surfaces s, const double *restrict x, const double *restrict y,
                                         const double *restrict slop, double *restrict is_left) {
    const double *restrict nx = s.nx, *restrict ny = s.ny, *restrict offset = s.offset;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double distance = nx[i * s.stride] * x[i] + ny[i * s.stride] * y[i] + offset[i * s.stride];
        is_left[i] += distance < -0.25 * slop[i] ? 1.0 : 0.0;
    }
}

static void leave_stuck(const mspringi_ground *g, const parts_below *parts, const double *x, const double *y,
                        const double *slop, double *is_left) {
    for (uint32_t i = 0; i < g->line_count; ++i)
        leave_beyond(surfaces_of_line(&g->lines[i]), x, y, slop, is_left);
    if (g->height_count > 0)
        leave_beyond(surfaces_of_parts(parts), x, y, slop, is_left);
}

// Leave those that are faster than before.
static void leave_faster(touching *restrict b) {
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const mspringi_going p = going_at(b, i);
        b->is_left[i] += mspringi_going_square(&p) > b->square[i] * MSPRINGI_NO_LARGER ? b->is_hit[i] : 0.0;
    }
}

static inline void choose(const float *restrict moved, const float *restrict from, float *restrict to) {
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        to[i] = moved[i] > 0.0f ? from[i] : to[i];
}

/// Where particles of a block come to.
typedef struct block_end {
    double x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH], vx[MSPRINGI_WIDTH], vy[MSPRINGI_WIDTH];
    float is_moved[MSPRINGI_WIDTH];
} block_end;

static void store_block(const mspringi_ground *g, size_t slot, const block_end *restrict b) {
    float *restrict x = g->x + slot, *restrict y = g->y + slot;
    float *restrict vx = g->vx + slot, *restrict vy = g->vy + slot;
    float *restrict impulse_x = g->impulse_x + slot, *restrict impulse_y = g->impulse_y + slot;
    const float *restrict inverse_mass = g->inverse_mass + slot;
    float to_x[MSPRINGI_WIDTH], to_y[MSPRINGI_WIDTH], to_vx[MSPRINGI_WIDTH], to_vy[MSPRINGI_WIDTH];
    float has_x[MSPRINGI_WIDTH], has_y[MSPRINGI_WIDTH];
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float mass = 1.0f / inverse_mass[i];
        to_x[i] = (float)b->x[i];
        to_y[i] = (float)b->y[i];
        to_vx[i] = (float)b->vx[i];
        to_vy[i] = (float)b->vy[i];
        has_x[i] = impulse_x[i] + mass * (to_vx[i] - vx[i]);
        has_y[i] = impulse_y[i] + mass * (to_vy[i] - vy[i]);
    }
    choose(b->is_moved, has_x, impulse_x);
    choose(b->is_moved, has_y, impulse_y);
    choose(b->is_moved, to_x, x);
    choose(b->is_moved, to_y, y);
    choose(b->is_moved, to_vx, vx);
    choose(b->is_moved, to_vy, vy);
}

// Which have come to their end, of those that are held and that a surface has acted on; the others that are held
// and left, as bits.
static uint32_t find_moved(const double *restrict is_held, const double *restrict is_hit,
                           const double *restrict is_left, float *restrict is_moved) {
    uint32_t left = 0;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        is_moved[i] = ((is_held[i] > 0.0) & (is_hit[i] > 0.0) & (is_left[i] == 0.0)) ? 1.0f : 0.0f;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        left |= ((is_left[i] > 0.0) & (is_held[i] > 0.0)) ? 1u << i : 0u;
    return left;
}

static void find_end(const mspringi_ground *g, const touching *restrict b, block_end *restrict end) {
    const double h = g->h;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        end->x[i] = b->x[i] + h * b->vx[i];
        end->y[i] = b->y[i] + h * b->vy[i];
        end->vx[i] = b->vx[i];
        end->vy[i] = b->vy[i];
    }
}

static uint32_t touch(const mspringi_ground *g, size_t slot) {
    touching b;
    parts_below parts;
    block_end end;
    double is_held[MSPRINGI_WIDTH];
    find_held(g, slot, is_held);
    load_touching(g, slot, &b);
    if (g->height_count > 0)
        begin_heights(g, &b, &parts);
    for (uint32_t i = 0; i < g->line_count; ++i)
        if (look_at_line(g, surfaces_of_line(&g->lines[i]), is_held, &b))
            touch_line(g, surfaces_of_line(&g->lines[i]), &b);
    if (g->height_count > 0)
        touch_heights(g, &parts, is_held, &b);
    leave_faster(&b);
    find_end(g, &b, &end);
    if (g->line_count + (g->height_count > 0) > 1)
        leave_stuck(g, &parts, end.x, end.y, b.slop, b.is_left);
    const uint32_t left = find_moved(is_held, b.is_hit, b.is_left, end.is_moved);
    store_block(g, slot, &end);
    return left;
}

#endif
