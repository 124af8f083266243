/// @file free_kernel.h
/// Action of a floor on the particles of a block that have no springs, after a substep. As floor_kernel.h, but
/// along parabolas that change direction where they meet a surface.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FREE_KERNEL_H
#define MSPRINGI_FREE_KERNEL_H

#include "kernels/floor_kernel.h"

/// Particles as in mspringi_free_particle, and the surface that each meets next.
typedef struct free_block {
    double x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH], wx[MSPRINGI_WIDTH], wy[MSPRINGI_WIDTH];
    double ax[MSPRINGI_WIDTH], ay[MSPRINGI_WIDTH], left[MSPRINGI_WIDTH];
    double slop[MSPRINGI_WIDTH], flight_slop[MSPRINGI_WIDTH];
    double time[MSPRINGI_WIDTH], nx[MSPRINGI_WIDTH], ny[MSPRINGI_WIDTH], offset[MSPRINGI_WIDTH];
    double friction[MSPRINGI_WIDTH], restitution[MSPRINGI_WIDTH];
    double is_active[MSPRINGI_WIDTH], is_hit[MSPRINGI_WIDTH], is_deferred[MSPRINGI_WIDTH];
} free_block;

static inline mspringi_free_particle free_at(const free_block *b, size_t i) {
    return (mspringi_free_particle){b->x[i], b->y[i], b->wx[i], b->wy[i], b->ax[i], b->ay[i], b->left[i], NULL};
}

static void load_free(const mspringi_floor_args *g, size_t slot, free_block *restrict b) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot;
    const float *restrict vx = g->vx + slot, *restrict vy = g->vy + slot;
    const float *restrict from_vx = g->from_vx + slot, *restrict from_vy = g->from_vy + slot;
    const double h = g->h;
    const mspringi_damping damping = g->damping;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const mspringi_free_particle p =
            mspringi_free_particle_from((double)x[i], (double)y[i], (double)vx[i], (double)vy[i],
                                        (double)from_vx[i], (double)from_vy[i], damping, h);
        b->x[i] = p.x;
        b->y[i] = p.y;
        b->wx[i] = p.wx;
        b->wy[i] = p.wy;
        b->ax[i] = p.ax;
        b->ay[i] = p.ay;
        b->left[i] = p.left;
        b->slop[i] = 0x1p-21 * (fabs(p.x) + fabs(p.y)) + 1e-12;
        b->flight_slop[i] = mspringi_flight_slop(p.x, p.y);
        b->is_hit[i] = b->is_deferred[i] = 0.0;
    }
}

static inline void find_flight_ends(const free_block *restrict b, double *restrict x, double *restrict y) {
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        x[i] = b->x[i] + b->left[i] * (b->wx[i] + 0.5 * b->left[i] * b->ax[i]);
        y[i] = b->y[i] + b->left[i] * (b->wy[i] + 0.5 * b->left[i] * b->ay[i]);
    }
}

// True if an active particle would end below a straight surface. Defers those that start below it.
static inline bool is_surface_met(surfaces s, free_block *restrict b) {
    const double *restrict all_nx = s.nx, *restrict all_ny = s.ny, *restrict all_offset = s.offset;
    double any[MSPRINGI_WIDTH];
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double nx = all_nx[i * s.stride], ny = all_ny[i * s.stride], left = b->left[i];
        const double distance = nx * b->x[i] + ny * b->y[i] + all_offset[i * s.stride];
        const double speed = nx * b->wx[i] + ny * b->wy[i], pull = nx * b->ax[i] + ny * b->ay[i];
        const double end = distance + left * (speed + 0.5 * left * pull);
        any[i] = end < -b->flight_slop[i] ? b->is_active[i] : 0.0;
        b->is_deferred[i] += distance < -b->slop[i] ? 1.0 : 0.0;
    }
    return is_any(any, MSPRINGI_WIDTH);
}

// Find the particles that meet a straight surface earlier than those before.
static inline void meet_surface(surfaces s, free_block *restrict b) {
    const double *restrict all_nx = s.nx, *restrict all_ny = s.ny, *restrict all_offset = s.offset;
    const double *restrict friction = s.friction, *restrict restitution = s.restitution;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const size_t at = i * s.stride;
        const double nx = all_nx[at], ny = all_ny[at], offset = all_offset[at];
        const mspringi_free_particle p = free_at(b, i);
        const double time = mspringi_time_to_surface(nx, ny, offset, b->flight_slop[i], &p);
        const bool is_sooner = time < b->time[i];
        b->nx[i] = is_sooner ? nx : b->nx[i];
        b->ny[i] = is_sooner ? ny : b->ny[i];
        b->offset[i] = is_sooner ? offset : b->offset[i];
        b->friction[i] = is_sooner ? friction[at] : b->friction[i];
        b->restitution[i] = is_sooner ? restitution[at] : b->restitution[i];
        b->time[i] = is_sooner ? time : b->time[i];
    }
}

// Deflect each particle at its next surface. True if any bounces, and so may meet the same surface again.
static inline bool deflect(const mspringi_bounce_params *how, bool is_last, free_block *restrict b) {
    const mspringi_bounce_params by = *how;
    double any[MSPRINGI_WIDTH];
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const mspringi_free_particle before = free_at(b, i);
        mspringi_free_particle p = before;
        const bool meets = b->time[i] < INFINITY;
        const double time = meets ? b->time[i] : 0.0;
        const bool bounces = mspringi_bounce_free(b->nx[i], b->ny[i], b->offset[i], b->friction[i],
                                                  b->restitution[i], &by, time, is_last, &p);
        any[i] = (meets & bounces) ? 1.0 : 0.0;
        const bool has_slid = (before.ax == 0.0) & (before.ay == 0.0);
        b->is_deferred[i] += (meets & has_slid) ? b->is_hit[i] : 0.0;
        b->x[i] = meets ? p.x : before.x;
        b->y[i] = meets ? p.y : before.y;
        b->wx[i] = meets ? p.wx : before.wx;
        b->wy[i] = meets ? p.wy : before.wy;
        b->ax[i] = meets ? p.ax : before.ax;
        b->ay[i] = meets ? p.ay : before.ay;
        b->left[i] = meets ? p.left : before.left;
        b->is_hit[i] = meets ? 1.0 : b->is_hit[i];
    }
    return is_any(any, MSPRINGI_WIDTH);
}

// Advance each particle to its next surface and deflect it. True if any may meet one again. A particle that lies on
// the only surface does not.
static bool advance_to_surfaces(const mspringi_floor_args *g, const parts_below *parts,
                                const mspringi_bounce_params *how, bool is_last, free_block *b) {
    const bool is_only_one = g->line_count + (g->height_count > 0) == 1;
    bool any = false;
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        b->time[i] = INFINITY;
        b->nx[i] = b->ny[i] = b->offset[i] = b->friction[i] = b->restitution[i] = 0.0;
    }
    for (uint32_t i = 0; i < g->line_count; ++i) {
        if (!is_surface_met(surfaces_of_line(&g->lines[i]), b))
            continue;
        any = true;
        meet_surface(surfaces_of_line(&g->lines[i]), b);
    }
    if (g->height_count > 0 && is_surface_met(surfaces_of_parts(parts), b)) {
        any = true;
        meet_surface(surfaces_of_parts(parts), b);
    }
    if (any && g->own)
        mix_own(g, 0, MSPRINGI_WIDTH, b->friction, b->restitution);
    return any && (deflect(how, is_last, b) || !is_only_one);
}

static void defer_free(const mspringi_floor_args *g, const parts_below *parts, free_block *b) {
    double x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH];
    find_flight_ends(b, x, y);
    defer_moved(g, parts, b->x, MSPRINGI_WIDTH, b->is_deferred);
    defer_moved(g, parts, x, MSPRINGI_WIDTH, b->is_deferred);
}

static void begin_free(const mspringi_floor_args *g, free_block *b, parts_below *parts) {
    double x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH];
    find_flight_ends(b, x, y);
    find_parts(g, x, MSPRINGI_WIDTH, parts->number);
    find_lines(g, MSPRINGI_WIDTH, parts);
    defer_moved(g, parts, b->x, MSPRINGI_WIDTH, b->is_deferred);
}

static void find_flight_end(const free_block *restrict b, double skew, block_end *restrict end) {
    find_flight_ends(b, end->x, end->y);
    MSPRINGI_ROLLED
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double since = b->left[i] - skew;
        end->vx[i] = b->wx[i] + since * b->ax[i];
        end->vy[i] = b->wy[i] + since * b->ay[i];
    }
}

static uint32_t bounce_free(const mspringi_floor_args *g, size_t slot) {
    free_block b;
    parts_below parts;
    block_end end;
    const mspringi_bounce_params how = {.h = g->h, .skew = 0.5 * g->h};
    find_active(g, slot, MSPRINGI_WIDTH, b.is_active);
    load_free(g, slot, &b);
    if (g->height_count > 0)
        begin_free(g, &b, &parts);
    bool goes_on = true;
    for (int turn = 1; turn <= MSPRINGI_MAX_DEFLECTIONS && goes_on; ++turn) {
        goes_on = advance_to_surfaces(g, &parts, &how, turn == MSPRINGI_MAX_DEFLECTIONS, &b);
        if (g->height_count > 0)
            defer_free(g, &parts, &b);
    }
    find_flight_end(&b, how.skew, &end);
    if (g->line_count + (g->height_count > 0) > 1)
        defer_stuck(g, &parts, end.x, end.y, b.slop, MSPRINGI_WIDTH, b.is_deferred);
    const uint32_t left = find_moved(b.is_active, b.is_hit, b.is_deferred, MSPRINGI_WIDTH, end.is_moved);
    store_block(g, slot, MSPRINGI_WIDTH, &end);
    return left;
}

#endif
