/// @file floor_kernel.h
/// Action of a floor on the particles of a block after a substep, in parallel: the operations of floor_bounce.c in
/// their order, for the common cases. Plain C in blocks of MSPRINGI_WIDTH lanes, as in system_assemble.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FLOOR_KERNEL_H
#define MSPRINGI_FLOOR_KERNEL_H

#include "kernels/bounce_kernel.h"

#include <string.h>

#if defined(_MSC_VER)
#define MSPRINGI_FLOOR_INLINE static __forceinline
#else
#define MSPRINGI_FLOOR_INLINE static inline __attribute__((always_inline))
#endif

/// Lanes of a half block. Particles with springs are handled by half blocks, since a block often touches a floor
/// with few of them. With whole blocks, a lattice of 6 x 6 on a floor took 1.50 instead of 1.38 times the step of a
/// free one.
#define MSPRINGI_HALF (MSPRINGI_WIDTH / 2)

/// Particles as in mspringi_bouncing_particle, and flags of 1 or 0.
typedef struct bounce_block {
    double x[MSPRINGI_HALF], y[MSPRINGI_HALF], vx[MSPRINGI_HALF], vy[MSPRINGI_HALF];
    double half_x[MSPRINGI_HALF], half_y[MSPRINGI_HALF], max_restitution[MSPRINGI_HALF];
    double square[MSPRINGI_HALF], slop[MSPRINGI_HALF];
    double is_hit[MSPRINGI_HALF];      ///< a surface has acted on it
    double is_deferred[MSPRINGI_HALF]; ///< deferred to mspringi_floor_bounce()
} bounce_block;

/// Straight part of a field of heights below each particle.
typedef struct parts_below {
    double number[MSPRINGI_WIDTH];
    double nx[MSPRINGI_WIDTH], ny[MSPRINGI_WIDTH], offset[MSPRINGI_WIDTH];
    double friction[MSPRINGI_WIDTH], restitution[MSPRINGI_WIDTH];
} parts_below;

/// Straight surfaces: one for all particles (stride 0), or one for each (stride 1).
typedef struct surfaces {
    const double *nx, *ny, *offset, *friction, *restitution;
    size_t stride;
} surfaces;

MSPRINGI_FLOOR_INLINE surfaces surfaces_of_line(const mspringi_line *line) {
    return (surfaces){&line->nx, &line->ny, &line->offset, &line->friction, &line->restitution, 0};
}

MSPRINGI_FLOOR_INLINE surfaces surfaces_of_parts(const parts_below *parts) {
    return (surfaces){parts->nx, parts->ny, parts->offset, parts->friction, parts->restitution, 1};
}

static inline mspringi_bouncing_particle bouncing_at(const bounce_block *b, size_t i) {
    return (mspringi_bouncing_particle){.x = b->x[i],
                                        .y = b->y[i],
                                        .vx = b->vx[i],
                                        .vy = b->vy[i],
                                        .half_x = b->half_x[i],
                                        .half_y = b->half_y[i],
                                        .max_restitution = b->max_restitution[i]};
}

// True if any flag is 1. Compares bits, since a sum would be a chain of dependent additions.
MSPRINGI_FLOOR_INLINE bool is_any(const double *flags, size_t lanes) {
    uint64_t bits[MSPRINGI_WIDTH], all = 0;
    memcpy(bits, flags, lanes * sizeof *bits);
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        all |= bits[i];
    return all != 0;
}

// Flag the particles that are not clear where they start.
MSPRINGI_FLOOR_INLINE void flag_starts(const mspringi_floor_args *g, size_t slot, size_t lanes,
                                       double *restrict is_active) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot;
    const float *restrict vx = g->vx + slot, *restrict vy = g->vy + slot,
                          *restrict active_inverse_mass = g->active_inverse_mass + slot;
    const mspringi_bounds clear = g->clear;
    const float h = (float)g->h;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i) {
        const float from_x = x[i] - h * vx[i], from_y = y[i] - h * vy[i];
        const bool is_clear =
            (from_x >= clear.min_x) & (from_x <= clear.max_x) & (from_y >= clear.min_y) & (from_y <= clear.max_y);
        is_active[i] = ((active_inverse_mass[i] > 0.0f) & !is_clear) ? 1.0 : is_active[i];
    }
}

// Flag the particles that a floor may act on: those that are not clear where they end. Heights may be in the way to
// a place that is clear, so with them also those that are not clear where they start.
MSPRINGI_FLOOR_INLINE void find_active(const mspringi_floor_args *g, size_t slot, size_t lanes,
                                       double *restrict is_active) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot,
                          *restrict active_inverse_mass = g->active_inverse_mass + slot;
    const mspringi_bounds clear = g->clear;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i) {
        const bool is_clear =
            (x[i] >= clear.min_x) & (x[i] <= clear.max_x) & (y[i] >= clear.min_y) & (y[i] <= clear.max_y);
        is_active[i] = ((active_inverse_mass[i] > 0.0f) & !is_clear) ? 1.0 : 0.0;
    }
    if (g->height_count > 0)
        flag_starts(g, slot, lanes, is_active);
}

static void load_bounce_block(const mspringi_floor_args *g, size_t slot, bounce_block *restrict b) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot;
    const float *restrict vx = g->vx + slot, *restrict vy = g->vy + slot;
    const float *restrict from_vx = g->from_vx + slot, *restrict from_vy = g->from_vy + slot;
    const double h = g->h, per_length = g->per_length;
    const mspringi_damping damping = g->damping;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_HALF; ++i) {
        const mspringi_bouncing_particle p =
            mspringi_taut_particle_from((double)x[i], (double)y[i], (double)vx[i], (double)vy[i],
                                        (double)from_vx[i], (double)from_vy[i], damping, h, per_length);
        b->x[i] = p.x;
        b->y[i] = p.y;
        b->vx[i] = p.vx;
        b->vy[i] = p.vy;
        b->half_x[i] = p.half_x;
        b->half_y[i] = p.half_y;
        b->max_restitution[i] = p.max_restitution;
        b->square[i] = mspringi_bouncing_particle_square(&p);
        b->slop[i] = 0x1p-21 * (fabs(p.x) + fabs(p.y)) + 1e-12;
        b->is_hit[i] = b->is_deferred[i] = 0.0;
    }
}

// Let a straight surface act on each particle.
MSPRINGI_FLOOR_INLINE void bounce_off(const mspringi_floor_args *g, surfaces s, bounce_block *restrict b) {
    const double *restrict nx = s.nx, *restrict ny = s.ny, *restrict offset = s.offset;
    const double *restrict friction = s.friction, *restrict restitution = s.restitution;
    const double h = g->h;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_HALF; ++i) {
        mspringi_bouncing_particle p = bouncing_at(b, i);
        const double was_hit = b->is_hit[i];
        const size_t at = i * s.stride;
        const double is_hit =
            mspringi_bounce(nx[at], ny[at], offset[at], friction[at], restitution[at], h, 0.0, &p);
        b->x[i] = p.x;
        b->y[i] = p.y;
        b->vx[i] = p.vx;
        b->vy[i] = p.vy;
        b->is_hit[i] = was_hit + is_hit;
    }
}

// Mix the values of the surfaces of some lanes with what their particles have of their own.
MSPRINGI_FLOOR_INLINE void mix_own(const mspringi_floor_args *g, size_t slot, size_t lanes,
                                   double *restrict friction, double *restrict restitution) {
    const mspringi_contact_material *restrict own = g->own + slot % MSPRINGI_WIDTH;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i) {
        friction[i] = mspringi_mixed_friction(friction[i], &own[i]);
        restitution[i] = mspringi_mixed_restitution(restitution[i], &own[i]);
    }
}

// Let a straight surface act on each particle, some of which have values of their own.
MSPRINGI_FLOOR_INLINE void bounce_off_own(const mspringi_floor_args *g, size_t slot, const mspringi_line *line,
                                          bounce_block *restrict b) {
    parts_below mixed;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_HALF; ++i) {
        mixed.nx[i] = line->nx;
        mixed.ny[i] = line->ny;
        mixed.offset[i] = line->offset;
        mixed.friction[i] = line->friction;
        mixed.restitution[i] = line->restitution;
    }
    mix_own(g, slot, MSPRINGI_HALF, mixed.friction, mixed.restitution);
    bounce_off(g, surfaces_of_parts(&mixed), b);
}

// True if a straight surface would act on any particle. Defers those that were below it. Most of several surfaces
// are far from most blocks.
MSPRINGI_FLOOR_INLINE bool is_surface_reached(const mspringi_floor_args *g, surfaces s,
                                              const double *restrict is_active, bounce_block *restrict b) {
    const double *restrict all_nx = s.nx, *restrict all_ny = s.ny, *restrict all_offset = s.offset;
    const double h = g->h;
    double any[MSPRINGI_HALF];
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_HALF; ++i) {
        const double nx = all_nx[i * s.stride], ny = all_ny[i * s.stride];
        const double distance = nx * b->x[i] + ny * b->y[i] + all_offset[i * s.stride];
        const double across = nx * b->vx[i] + ny * b->vy[i];
        any[i] = distance + h * across < 0.0 ? is_active[i] : 0.0;
        b->is_deferred[i] += distance < -b->slop[i] ? 1.0 : 0.0;
    }
    return is_any(any, MSPRINGI_HALF);
}

/* ------------------------------------------------------------------------------------------------------ heights */

// Find the numbers of the parts below each x.
MSPRINGI_FLOOR_INLINE void find_parts(const mspringi_floor_args *g, const double *restrict x, size_t lanes,
                                      double *restrict numbers) {
    const double left = g->left, spacing = g->spacing, last = (double)(g->height_count - 1);
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        numbers[i] = (x[i] - left) / spacing;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        numbers[i] = numbers[i] >= 0.0 ? numbers[i] : -1.0;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        numbers[i] = numbers[i] < last ? numbers[i] : last;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        numbers[i] = (double)(int32_t)numbers[i];
}

// Friction or restitution of the parts. The level ends take the values of the outermost parts.
MSPRINGI_FLOOR_INLINE void find_values(const mspringi_floor_args *g, const float *values, double uniform,
                                       const double *restrict number, size_t lanes, double *restrict to) {
    const int32_t last = (int32_t)g->height_count - 2;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        to[i] = uniform;
    if (!values)
        return;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i) {
        const int32_t part = (int32_t)number[i], not_less = part < 0 ? 0 : part;
        to[i] = (double)values[not_less < last ? not_less : last];
    }
}

MSPRINGI_FLOOR_INLINE void find_lines(const mspringi_floor_args *g, size_t lanes, parts_below *parts) {
    const int32_t last = (int32_t)g->height_count - 1;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i) {
        const int32_t part = (int32_t)parts->number[i], knot = part < 0 ? 0 : part;
        const double x = g->left + (double)knot * g->spacing, y = g->bottom + (double)g->heights[knot];
        const bool is_level = part < 0 || part >= last;
        parts->nx[i] = is_level ? 0.0 : g->normals[2 * (size_t)knot];
        parts->ny[i] = is_level ? 1.0 : g->normals[2 * (size_t)knot + 1];
        parts->offset[i] = is_level ? -y : -(parts->nx[i] * x + parts->ny[i] * y);
    }
    find_values(g, g->frictions, g->friction, parts->number, lanes, parts->friction);
    find_values(g, g->restitutions, g->restitution, parts->number, lanes, parts->restitution);
}

// Defer particles that are no longer above or below the same part.
MSPRINGI_FLOOR_INLINE void defer_moved(const mspringi_floor_args *g, const parts_below *parts,
                                       const double *restrict x, size_t lanes, double *restrict is_deferred) {
    double numbers[MSPRINGI_WIDTH];
    find_parts(g, x, lanes, numbers);
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        is_deferred[i] += numbers[i] != parts->number[i] ? 1.0 : 0.0;
}

static inline void find_ends(const mspringi_floor_args *g, const bounce_block *restrict b, double *restrict x) {
    const double h = g->h;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_HALF; ++i)
        x[i] = b->x[i] + h * b->vx[i];
}

static void begin_heights(const mspringi_floor_args *g, bounce_block *b, parts_below *parts) {
    double ends[MSPRINGI_HALF];
    find_ends(g, b, ends);
    find_parts(g, ends, MSPRINGI_HALF, parts->number);
    find_lines(g, MSPRINGI_HALF, parts);
    defer_moved(g, parts, b->x, MSPRINGI_HALF, b->is_deferred);
}

static void bounce_heights(const mspringi_floor_args *g, const parts_below *parts, const double *is_active,
                           bounce_block *b) {
    double ends[MSPRINGI_HALF];
    if (g->line_count > 0) {
        find_ends(g, b, ends);
        defer_moved(g, parts, ends, MSPRINGI_HALF, b->is_deferred);
        defer_moved(g, parts, b->x, MSPRINGI_HALF, b->is_deferred);
    }
    const surfaces below = surfaces_of_parts(parts);
    if (is_surface_reached(g, below, is_active, b))
        bounce_off(g, below, b);
    find_ends(g, b, ends);
    defer_moved(g, parts, ends, MSPRINGI_HALF, b->is_deferred);
    defer_moved(g, parts, b->x, MSPRINGI_HALF, b->is_deferred);
}

/* ------------------------------------------------------------------------------------------------------ blocks */

// Defer particles that end below a straight surface.
MSPRINGI_FLOOR_INLINE void defer_below(surfaces s, const double *restrict x, const double *restrict y,
                                       const double *restrict slop, size_t lanes, double *restrict is_deferred) {
    const double *restrict nx = s.nx, *restrict ny = s.ny, *restrict offset = s.offset;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i) {
        const double distance = nx[i * s.stride] * x[i] + ny[i * s.stride] * y[i] + offset[i * s.stride];
        is_deferred[i] += distance < -0.25 * slop[i] ? 1.0 : 0.0;
    }
}

MSPRINGI_FLOOR_INLINE void defer_stuck(const mspringi_floor_args *g, const parts_below *parts, const double *x,
                                       const double *y, const double *slop, size_t lanes, double *is_deferred) {
    for (uint32_t i = 0; i < g->line_count; ++i)
        defer_below(surfaces_of_line(&g->lines[i]), x, y, slop, lanes, is_deferred);
    if (g->height_count > 0)
        defer_below(surfaces_of_parts(parts), x, y, slop, lanes, is_deferred);
}

// Defer particles that became faster; with slack all that a surface has acted on.
static void defer_faster(const mspringi_floor_args *g, bounce_block *restrict b) {
    const double margin = mspringi_slack_of(g->damping) > 0.0 ? -1.0 : MSPRINGI_GROWTH_MARGIN;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_HALF; ++i) {
        const mspringi_bouncing_particle p = bouncing_at(b, i);
        b->is_deferred[i] += mspringi_bouncing_particle_square(&p) >= b->square[i] * margin ? b->is_hit[i] : 0.0;
    }
}

MSPRINGI_FLOOR_INLINE void choose(const float *restrict moved, const float *restrict from, size_t lanes,
                                  float *restrict to) {
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        to[i] = moved[i] > 0.0f ? from[i] : to[i];
}

static void put_on_grid(float grid, size_t lanes, float *restrict to) {
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        to[i] = mspringi_round_to_grid(grid, to[i]);
}

MSPRINGI_FLOOR_INLINE void clear_moved(const float *restrict moved, size_t lanes, float *restrict to) {
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        to[i] = moved[i] > 0.0f ? 0.0f : to[i];
}

/// State of a block's particles after the floor.
typedef struct block_end {
    double x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH], vx[MSPRINGI_WIDTH], vy[MSPRINGI_WIDTH];
    float is_moved[MSPRINGI_WIDTH];
} block_end;

MSPRINGI_FLOOR_INLINE void store_block(const mspringi_floor_args *g, size_t slot, size_t lanes,
                                       const block_end *restrict b) {
    float *restrict x = g->x + slot, *restrict y = g->y + slot;
    float *restrict vx = g->vx + slot, *restrict vy = g->vy + slot;
    float *restrict impulse_x = g->impulse_x + slot, *restrict impulse_y = g->impulse_y + slot;
    const float *restrict inverse_mass = g->inverse_mass + slot;
    const float grid = g->grid;
    float to_x[MSPRINGI_WIDTH], to_y[MSPRINGI_WIDTH], to_vx[MSPRINGI_WIDTH], to_vy[MSPRINGI_WIDTH];
    float has_x[MSPRINGI_WIDTH], has_y[MSPRINGI_WIDTH], low_x[MSPRINGI_WIDTH], low_y[MSPRINGI_WIDTH];
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i) {
        to_x[i] = (float)b->x[i];
        to_y[i] = (float)b->y[i];
    }
    if (grid > 0.0f) {
        put_on_grid(grid, lanes, to_x);
        put_on_grid(grid, lanes, to_y);
    }
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i) {
        const float mass = 1.0f / inverse_mass[i];
        low_x[i] = mspringi_low_of(to_x[i], (float)(b->x[i] - (double)to_x[i]), grid);
        low_y[i] = mspringi_low_of(to_y[i], (float)(b->y[i] - (double)to_y[i]), grid);
        to_vx[i] = (float)b->vx[i];
        to_vy[i] = (float)b->vy[i];
        has_x[i] = impulse_x[i] + mass * (to_vx[i] - vx[i]);
        has_y[i] = impulse_y[i] + mass * (to_vy[i] - vy[i]);
    }
    choose(b->is_moved, has_x, lanes, impulse_x);
    choose(b->is_moved, has_y, lanes, impulse_y);
    choose(b->is_moved, low_x, lanes, g->low_x + slot);
    choose(b->is_moved, low_y, lanes, g->low_y + slot);
    choose(b->is_moved, to_x, lanes, x);
    choose(b->is_moved, to_y, lanes, y);
    choose(b->is_moved, to_vx, lanes, vx);
    choose(b->is_moved, to_vy, lanes, vy);
    if (!g->low_vx)
        return;
    clear_moved(b->is_moved, lanes, g->low_vx + slot);
    clear_moved(b->is_moved, lanes, g->low_vy + slot);
}

// Flag the active particles that a surface has acted on and that are complete. Returns the active deferred ones, as
// bits.
MSPRINGI_FLOOR_INLINE uint32_t find_moved(const double *restrict is_active, const double *restrict is_hit,
                                          const double *restrict is_deferred, size_t lanes,
                                          float *restrict is_moved) {
    uint32_t left = 0;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        is_moved[i] = ((is_active[i] > 0.0) & (is_hit[i] > 0.0) & (is_deferred[i] == 0.0)) ? 1.0f : 0.0f;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < lanes; ++i)
        left |= ((is_deferred[i] > 0.0) & (is_active[i] > 0.0)) ? 1u << i : 0u;
    return left;
}

static void find_end(const mspringi_floor_args *g, const bounce_block *restrict b, block_end *restrict end) {
    const double h = g->h;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_HALF; ++i) {
        end->x[i] = b->x[i] + h * b->vx[i];
        end->y[i] = b->y[i] + h * b->vy[i];
        end->vx[i] = b->vx[i];
        end->vy[i] = b->vy[i];
    }
}

static uint32_t bounce_half(const mspringi_floor_args *g, size_t slot, const double *is_active) {
    bounce_block b;
    parts_below parts;
    block_end end;
    load_bounce_block(g, slot, &b);
    if (g->height_count > 0) {
        begin_heights(g, &b, &parts);
        if (g->own)
            mix_own(g, slot, MSPRINGI_HALF, parts.friction, parts.restitution);
    }
    for (uint32_t i = 0; i < g->line_count; ++i) {
        if (!is_surface_reached(g, surfaces_of_line(&g->lines[i]), is_active, &b))
            continue;
        if (!g->own)
            bounce_off(g, surfaces_of_line(&g->lines[i]), &b);
        else
            bounce_off_own(g, slot, &g->lines[i], &b);
    }
    if (g->height_count > 0)
        bounce_heights(g, &parts, is_active, &b);
    defer_faster(g, &b);
    find_end(g, &b, &end);
    if (g->line_count + (g->height_count > 0) > 1)
        defer_stuck(g, &parts, end.x, end.y, b.slop, MSPRINGI_HALF, b.is_deferred);
    const uint32_t left = find_moved(is_active, b.is_hit, b.is_deferred, MSPRINGI_HALF, end.is_moved);
    store_block(g, slot, MSPRINGI_HALF, &end);
    return left;
}

static uint32_t bounce(const mspringi_floor_args *g, size_t slot) {
    uint32_t left = 0;
    for (uint32_t first = 0; first < MSPRINGI_WIDTH; first += MSPRINGI_HALF) {
        double is_active[MSPRINGI_HALF];
        find_active(g, slot + first, MSPRINGI_HALF, is_active);
        if (is_any(is_active, MSPRINGI_HALF))
            left |= bounce_half(g, slot + first, is_active) << first;
    }
    return left;
}

#endif
