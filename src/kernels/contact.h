/// @file contact.h
/// What a floor does to the particles of a block after a substep, all at once: the operations of collide.c, in its
/// order, for what most particles do in most substeps. Plain C in blocks of MSPRINGI_WIDTH lanes, as in
/// system_assemble.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONTACT_H
#define MSPRINGI_CONTACT_H

#include "kernels.h"

#include <math.h>

/// Times that several surfaces are gone through, as in collide.c.
#define MSPRINGI_CONTACT_ROUNDS 4

/// Bodies as in collide.c, and 1 or 0 for what is true of them or not.
typedef struct touching {
    double x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH], vx[MSPRINGI_WIDTH], vy[MSPRINGI_WIDTH];
    double start_x[MSPRINGI_WIDTH], start_y[MSPRINGI_WIDTH], slop[MSPRINGI_WIDTH];
    double is_held[MSPRINGI_WIDTH]; ///< surfaces act on it
    double is_hit[MSPRINGI_WIDTH];  ///< one has, in this round
    double is_left[MSPRINGI_WIDTH]; ///< to others
} touching;

/// The straight part of a field of heights below each body.
typedef struct parts_below {
    double number[MSPRINGI_WIDTH];
    double nx[MSPRINGI_WIDTH], ny[MSPRINGI_WIDTH], offset[MSPRINGI_WIDTH];
} parts_below;

// Where a body comes from at the velocity that it has.
static void load_touching(const mspringi_ground *g, size_t slot, touching *restrict b) {
    const float *restrict x = g->x + slot, *restrict y = g->y + slot;
    const float *restrict vx = g->vx + slot, *restrict vy = g->vy + slot, *restrict free_mass = g->free_mass + slot;
    const mspringi_bounds clear = g->clear;
    const double h = g->h;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        b->x[i] = (double)x[i];
        b->y[i] = (double)y[i];
        b->vx[i] = (double)vx[i];
        b->vy[i] = (double)vy[i];
        b->start_x[i] = b->x[i] - h * b->vx[i];
        b->start_y[i] = b->y[i] - h * b->vy[i];
        b->slop[i] = 0x1p-21 * (fabs(b->x[i]) + fabs(b->y[i])) + 1e-12;
        b->is_left[i] = 0.0;
    }
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const bool is_clear =
            (x[i] >= clear.min_x) & (x[i] <= clear.max_x) & (y[i] >= clear.min_y) & (y[i] <= clear.max_y);
        b->is_held[i] = ((free_mass[i] > 0.0f) & !is_clear) ? 1.0 : 0.0;
    }
}

// Let a straight surface act on each body: the same one on all, or one on each, stride apart.
static inline void touch_line(const mspringi_ground *g, const double *restrict all_nx,
                              const double *restrict all_ny, const double *restrict all_offset, size_t stride,
                              touching *restrict b) {
    const double h = g->h, friction = g->friction, restitution = g->restitution;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double nx = all_nx[i * stride], ny = all_ny[i * stride], offset = all_offset[i * stride];
        const double x = b->x[i], y = b->y[i], vx = b->vx[i], vy = b->vy[i], slop = b->slop[i];
        const double was_hit = b->is_hit[i];
        const double distance = nx * x + ny * y + offset;
        const double across = nx * vx + ny * vy;
        const double before = nx * b->start_x[i] + ny * b->start_y[i] + offset;
        const double thrown = -restitution * across;
        const double given = (before > 2.0 * slop ? thrown : 0.0) - across;
        const double along = nx * vy - ny * vx, most = friction * given;
        const double least = -most, not_less = along < least ? least : along;
        const double taken = along > most ? most : not_less;
        const double back = h * taken;
        const double slid_x = x + back * ny, slid_y = y - back * nx;
        const double braked_x = vx + (given * nx + taken * ny), braked_y = vy + (given * ny - taken * nx);
        const double up_x = distance * nx, up_y = distance * ny;
        const bool touches = (b->is_held[i] > 0.0) & (distance < slop);
        const bool approaches = touches & (across < 0.0), is_sunk = touches & (distance < 0.0);
        const double at_x = approaches ? slid_x : x, at_y = approaches ? slid_y : y;
        const double lifted_x = at_x - up_x, lifted_y = at_y - up_y;
        b->vx[i] = approaches ? braked_x : vx;
        b->vy[i] = approaches ? braked_y : vy;
        b->x[i] = is_sunk ? lifted_x : at_x;
        b->y[i] = is_sunk ? lifted_y : at_y;
        b->is_hit[i] = (approaches | is_sunk) ? 1.0 : was_hit;
    }
}

// Whether a straight surface would act on any body. (Of several, most are far from most blocks: 16,384 particles on
// a plane between two others, 40 substeps: 11 instead of 17 ms at AVX2, 17 instead of 41 at SSE2.)
static bool is_touched(const mspringi_line *line, const touching *b) {
    uint32_t any = 0;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double distance = line->nx * b->x[i] + line->ny * b->y[i] + line->offset;
        any |= (uint32_t)((b->is_held[i] > 0.0) & (distance < b->slop[i]));
    }
    return any != 0;
}

// The numbers of the parts that are below so many x.
static inline void find_parts(const mspringi_ground *g, const double *restrict x, double *restrict numbers) {
    const double left = g->left, spacing = g->spacing, last = (double)(g->height_count - 1);
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        numbers[i] = (x[i] - left) / spacing;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        numbers[i] = numbers[i] >= 0.0 ? numbers[i] : -1.0;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        numbers[i] = numbers[i] < last ? numbers[i] : last;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        numbers[i] = (double)(int32_t)numbers[i];
}

static void find_lines(const mspringi_ground *g, parts_below *parts) {
    const int32_t last = (int32_t)g->height_count - 1;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const int32_t part = (int32_t)parts->number[i], knot = part < 0 ? 0 : part;
        const double x = g->left + (double)knot * g->spacing, y = g->bottom + (double)g->heights[knot];
        const bool is_level = part < 0 || part >= last;
        parts->nx[i] = is_level ? 0.0 : g->normals[2 * (size_t)knot];
        parts->ny[i] = is_level ? 1.0 : g->normals[2 * (size_t)knot + 1];
        parts->offset[i] = is_level ? -y : -(parts->nx[i] * x + parts->ny[i] * y);
    }
}

// Leave the touching that are not above or below the same part any more.
static void leave_moved(const mspringi_ground *g, const parts_below *parts, const double *restrict x,
                        touching *restrict b) {
    double numbers[MSPRINGI_WIDTH];
    find_parts(g, x, numbers);
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        b->is_left[i] += numbers[i] != parts->number[i] ? 1.0 : 0.0;
}

// Go through all surfaces once. Returns whether any has done anything.
static bool touch_round(const mspringi_ground *g, const parts_below *parts, touching *b) {
    double any = 0.0;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        b->is_hit[i] = 0.0;
    for (uint32_t i = 0; i < g->line_count; ++i)
        if (g->line_count == 1 || is_touched(&g->lines[i], b))
            touch_line(g, &g->lines[i].nx, &g->lines[i].ny, &g->lines[i].offset, 0, b);
    if (g->height_count > 0) {
        if (g->line_count > 0)
            leave_moved(g, parts, b->x, b);
        touch_line(g, parts->nx, parts->ny, parts->offset, 1, b);
        leave_moved(g, parts, b->x, b);
    }
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        b->is_held[i] = b->is_hit[i];
        any += b->is_hit[i];
    }
    return any > 0.0;
}

// Leave the touching that are still beyond a straight surface.
static void leave_beyond(const double *restrict all_nx, const double *restrict all_ny,
                         const double *restrict all_offset, size_t stride, touching *restrict b) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double distance =
            all_nx[i * stride] * b->x[i] + all_ny[i * stride] * b->y[i] + all_offset[i * stride];
        b->is_left[i] += distance < -b->slop[i] ? 1.0 : 0.0;
    }
}

static void leave_stuck(const mspringi_ground *g, const parts_below *parts, touching *b) {
    for (uint32_t i = 0; i < g->line_count; ++i)
        leave_beyond(&g->lines[i].nx, &g->lines[i].ny, &g->lines[i].offset, 0, b);
    if (g->height_count > 0)
        leave_beyond(parts->nx, parts->ny, parts->offset, 1, b);
}

static inline void choose(const float *restrict moved, const float *restrict from, float *restrict to) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        to[i] = moved[i] > 0.0f ? from[i] : to[i];
}

static void store_touching(const mspringi_ground *g, size_t slot, const touching *restrict b) {
    float *restrict x = g->x + slot, *restrict y = g->y + slot;
    float *restrict vx = g->vx + slot, *restrict vy = g->vy + slot;
    float *restrict impulse_x = g->impulse_x + slot, *restrict impulse_y = g->impulse_y + slot;
    const float *restrict inverse_mass = g->inverse_mass + slot;
    float moved[MSPRINGI_WIDTH], to_x[MSPRINGI_WIDTH], to_y[MSPRINGI_WIDTH];
    float to_vx[MSPRINGI_WIDTH], to_vy[MSPRINGI_WIDTH], has_x[MSPRINGI_WIDTH], has_y[MSPRINGI_WIDTH];
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const bool is_moved = ((b->vx[i] != (double)vx[i]) | (b->vy[i] != (double)vy[i]) |
                               (b->x[i] != (double)x[i]) | (b->y[i] != (double)y[i])) &
                              (b->is_left[i] == 0.0);
        moved[i] = is_moved ? 1.0f : 0.0f;
    }
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float mass = 1.0f / inverse_mass[i];
        to_x[i] = (float)b->x[i];
        to_y[i] = (float)b->y[i];
        to_vx[i] = (float)b->vx[i];
        to_vy[i] = (float)b->vy[i];
        has_x[i] = impulse_x[i] + mass * (to_vx[i] - vx[i]);
        has_y[i] = impulse_y[i] + mass * (to_vy[i] - vy[i]);
    }
    choose(moved, has_x, impulse_x);
    choose(moved, has_y, impulse_y);
    choose(moved, to_x, x);
    choose(moved, to_y, y);
    choose(moved, to_vx, vx);
    choose(moved, to_vy, vy);
}

static uint32_t touch(const mspringi_ground *g, size_t slot) {
    touching b;
    parts_below parts;
    const bool is_one = g->line_count + (g->height_count > 0) == 1;
    uint32_t left = 0;
    load_touching(g, slot, &b);
    double held[MSPRINGI_WIDTH];
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        held[i] = b.is_held[i];
    if (g->height_count > 0) {
        find_parts(g, b.x, parts.number);
        find_lines(g, &parts);
        leave_moved(g, &parts, b.start_x, &b);
    }
    for (int round = 0; round < MSPRINGI_CONTACT_ROUNDS && touch_round(g, &parts, &b) && !is_one;)
        ++round;
    if (!is_one)
        leave_stuck(g, &parts, &b);
    store_touching(g, slot, &b);
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        left |= ((b.is_left[i] > 0.0) & (held[i] > 0.0)) ? 1u << i : 0u;
    return left;
}

#endif
