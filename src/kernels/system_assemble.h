/// @file system_assemble.h
/// Assembly of the linear system of an implicit substep. Plain C in blocks of MSPRINGI_WIDTH lanes, which compilers
/// vectorise for each instruction set: operations and order are the same in all of them.
///
/// Positions and forces are in double precision. The force of a stiff spring depends on differences of position
/// below single precision: at 10^12 N/m a bar of 1 m springs carries its weight with strains of 10^-6, ten times
/// the resolution of a length.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_ASSEMBLE_H
#define MSPRINGI_SYSTEM_ASSEMBLE_H

#include <math.h>
#include <string.h>

#include "kernels/spring_law.h"
#include "kernels/system_iterate.h"

/// MSPRINGI_WIDTH springs of one direction, from inverse length to force and factors. Each is a long chain of
/// dependent operations, so each stage is computed for all directions before the next. A block of 544x68 with
/// AVX-512: 148 ns, one spring after the other 186 ns.
typedef struct spring_lanes {
    float inverse[MSPRINGI_WIDTH];                                    ///< approximate inverse length, 1/m
    float extension[MSPRINGI_WIDTH];                                  ///< m
    float x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH];                       ///< direction
    double force_x[MSPRINGI_WIDTH], force_y[MSPRINGI_WIDTH];          ///< on the base
    float xx[MSPRINGI_WIDTH], xy[MSPRINGI_WIDTH], yy[MSPRINGI_WIDTH]; ///< block of the matrix
} spring_lanes;

/// Slots whose springs are computed before the sums. The sums read what is carried to the next slot one lane
/// further on than it was written. Immediately after the write, this would stall until the store reaches the cache.
#define MSPRINGI_STRIP (4 * MSPRINGI_WIDTH)

/// Contributions of a strip's springs to one quantity: for each slot, to itself, to the slot above, to the one on
/// the right, and to the one above that. The latter two begin at the slot before the strip, at WIDTH - 1.
typedef struct strip_of_doubles {
    double own[MSPRINGI_STRIP], up[MSPRINGI_STRIP];
    double right[MSPRINGI_WIDTH + MSPRINGI_STRIP], diagonal[MSPRINGI_WIDTH + MSPRINGI_STRIP];
} strip_of_doubles;
typedef struct strip_of_floats {
    float own[MSPRINGI_STRIP], up[MSPRINGI_STRIP];
    float right[MSPRINGI_WIDTH + MSPRINGI_STRIP], diagonal[MSPRINGI_WIDTH + MSPRINGI_STRIP];
} strip_of_floats;
typedef struct spring_strip {
    strip_of_doubles x, y; ///< forces
    strip_of_floats xx, xy, yy;
} spring_strip;

/// Smallest squared length, m^2. A spring of length 0 has no direction, but a finite inverse.
#define NO_SQUARE 1e-36f

// As mspringi_geometric_fraction().
static inline float geometric_fraction(float relative) {
    const float compressed = -1.5f * relative - 0.5f;
    const float share = relative > compressed ? relative : compressed;
    const float positive = share > 0.0f ? share : 0.0f;
    return positive < 1.0f ? positive : 1.0f;
}

/// Parameters of the linearisation.
typedef struct linearised {
    const double *x, *y;
    const float *vx, *vy;
    float scale, damping_rate;
} linearised;

// The springs from the slots at base to those at tip.
MSPRINGI_INLINE void find_inverses(const linearised *s, size_t base, size_t tip, spring_lanes *restrict to) {
    const double *const x = s->x, *const y = s->y;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double dx = x[tip + i] - x[base + i], dy = y[tip + i] - y[base + i];
        to->inverse[i] = 1.0f / sqrtf((float)(dx * dx + dy * dy) + NO_SQUARE);
    }
}

// One step of Newton's method for the inverse, and another for the length.
MSPRINGI_INLINE void find_forces(const linearised *s, size_t base, size_t tip, const float *rest_lengths,
                                 const float *stiffnesses, spring_lanes *restrict to, bool damped) {
    const double *const x = s->x, *const y = s->y;
    const float *const vx = s->vx, *const vy = s->vy, *const dampings = stiffnesses + MSPRINGI_WIDTH;
    const float scale = s->scale;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double dx = x[tip + i] - x[base + i], dy = y[tip + i] - y[base + i], square = dx * dx + dy * dy;
        const float inverse_near = to->inverse[i], nx = (float)dx * inverse_near, ny = (float)dy * inverse_near;
        const double guess = (double)inverse_near, half = 0.5 * guess;
        const double inverse = guess + guess * (0.5 - half * (square * guess)), length_near = square * inverse;
        const double length = length_near + (square - length_near * length_near) * half;
        const double extension = length - (double)rest_lengths[i];
        double force = MSPRINGI_LAW_FORCE(MSPRINGI_TIMES, (double)(scale * stiffnesses[i]), extension);
        if (damped) {
            const float dvx = vx[tip + i] - vx[base + i], dvy = vy[tip + i] - vy[base + i];
            const float rate = dvx * nx + dvy * ny;
            force = force + (double)MSPRINGI_LAW_DAMPING_FORCE(MSPRINGI_TIMES, scale * dampings[i], rate);
        }
        const double pull = force * inverse;
        to->extension[i] = (float)extension;
        to->x[i] = nx;
        to->y[i] = ny;
        to->force_x[i] = pull * dx;
        to->force_y[i] = pull * dy;
    }
}

MSPRINGI_INLINE void find_factors(const linearised *s, const float *stiffnesses, float *restrict factors,
                                  spring_lanes *restrict to, bool damped) {
    const float *const dampings = stiffnesses + MSPRINGI_WIDTH;
    const float scale = s->scale, damping_rate = s->damping_rate;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float stiffness = MSPRINGI_LAW_ALONG(scale * stiffnesses[i]);
        const float geometric = stiffness * geometric_fraction(to->extension[i] * to->inverse[i]);
        float along = stiffness - geometric;
        if (damped)
            along = along + MSPRINGI_LAW_DAMPING_ALONG(scale * dampings[i]) * damping_rate;
        const float root = sqrtf(along), pull_x = root * to->x[i], pull_y = root * to->y[i];
        factors[MSPRINGI_PULL_X * MSPRINGI_WIDTH + i] = pull_x;
        factors[MSPRINGI_PULL_Y * MSPRINGI_WIDTH + i] = pull_y;
        factors[MSPRINGI_GEOMETRIC * MSPRINGI_WIDTH + i] = geometric;
        to->xx[i] = geometric + pull_x * pull_x;
        to->xy[i] = pull_x * pull_y;
        to->yy[i] = geometric + pull_y * pull_y;
    }
}

// Write to a strip's slots from `at` on, in the order of sweep.h. Forces change sign at the tip, blocks do not.
#define MSPRINGI_PUT(part, value, sign)                                                                            \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {                                                                  \
        to->part.up[at + i] = south_east->value[i] sign north->value[i];                                           \
        to->part.diagonal[MSPRINGI_WIDTH + at + i] = north_east->value[i];                                         \
    }                                                                                                              \
    for (size_t i = 0; !only_carry && i < MSPRINGI_WIDTH; ++i) {                                                   \
        to->part.own[at + i] = (east->value[i] + north->value[i]) + north_east->value[i];                          \
        to->part.right[MSPRINGI_WIDTH + at + i] = east->value[i] + south_east->value[i];                           \
    }

MSPRINGI_INLINE void put_block(const spring_lanes *lanes, size_t at, spring_strip *restrict to, bool only_carry) {
    const spring_lanes *const east = &lanes[MSPRINGI_EAST], *const north = &lanes[MSPRINGI_NORTH];
    const spring_lanes *const north_east = &lanes[MSPRINGI_NORTH_EAST], *const south_east =
                                                                            &lanes[MSPRINGI_SOUTH_EAST];
    MSPRINGI_PUT(x, force_x, -)
    MSPRINGI_PUT(y, force_y, -)
    MSPRINGI_PUT(xx, xx, +)
    MSPRINGI_PUT(xy, xy, +)
    MSPRINGI_PUT(yy, yy, +)
}

#undef MSPRINGI_PUT

// Assemble the lattice springs of the slots from `slot` on, below those from `up` on, into a strip's slots from
// `at` on.
MSPRINGI_INLINE void assemble_block(const linearised *s, size_t slot, size_t up, const float *rests,
                                    const float *springs, float *restrict factors, size_t at,
                                    spring_strip *restrict to, bool damped, bool only_carry) {
    const size_t part = (size_t)(damped ? 2 : 1) * MSPRINGI_WIDTH,
                 factor = (size_t)MSPRINGI_FACTORS * MSPRINGI_WIDTH;
    const size_t bases[] = {
        [MSPRINGI_EAST] = slot, [MSPRINGI_NORTH] = slot, [MSPRINGI_NORTH_EAST] = slot, [MSPRINGI_SOUTH_EAST] = up};
    const size_t tips[] = {[MSPRINGI_EAST] = slot + 1,
                           [MSPRINGI_NORTH] = up,
                           [MSPRINGI_NORTH_EAST] = up + 1,
                           [MSPRINGI_SOUTH_EAST] = slot + 1};
    float unused[MSPRINGI_FACTORS *
                 MSPRINGI_WIDTH]; // carry-only rows belong to another worker, which writes their factors
    spring_lanes lanes[MSPRINGI_DIRECTIONS];
    const size_t first = only_carry ? MSPRINGI_NORTH : MSPRINGI_EAST;
    for (size_t i = first; i < MSPRINGI_DIRECTIONS; ++i)
        find_inverses(s, bases[i], tips[i], &lanes[i]);
    for (size_t i = first; i < MSPRINGI_DIRECTIONS; ++i)
        find_forces(s, bases[i], tips[i], rests + i * MSPRINGI_WIDTH, springs + i * part, &lanes[i], damped);
    for (size_t i = first; i < MSPRINGI_DIRECTIONS; ++i)
        find_factors(s, springs + i * part, only_carry ? unused : factors + i * factor, &lanes[i], damped);
    put_block(lanes, at, to, only_carry);
}

// Assemble the springs of a chain, or of a row of east springs only.
MSPRINGI_INLINE void assemble_east(const linearised *s, size_t slot, const float *rests, const float *springs,
                                   float *restrict factors, size_t at, spring_strip *restrict to, bool damped) {
    spring_lanes east;
    find_inverses(s, slot, slot + 1, &east);
    find_forces(s, slot, slot + 1, rests, springs, &east, damped);
    find_factors(s, springs, factors, &east, damped);
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        to->x.own[at + i] = to->x.right[MSPRINGI_WIDTH + at + i] = east.force_x[i];
        to->y.own[at + i] = to->y.right[MSPRINGI_WIDTH + at + i] = east.force_y[i];
        to->xx.own[at + i] = to->xx.right[MSPRINGI_WIDTH + at + i] = east.xx[i];
        to->xy.own[at + i] = to->xy.right[MSPRINGI_WIDTH + at + i] = east.xy[i];
        to->yy.own[at + i] = to->yy.right[MSPRINGI_WIDTH + at + i] = east.yy[i];
    }
}

// Sum one quantity over the slots of a strip: from the carry row, from the slot itself, and from the left.
static inline void sum_forces(const strip_of_doubles *of, size_t count, const double *restrict carry,
                              float *restrict to) {
    for (size_t i = 0; i < count; ++i)
        to[i] = (float)((carry[i] + of->own[i]) - of->right[MSPRINGI_WIDTH - 1 + i]);
}
static inline void sum_blocks(const strip_of_floats *of, size_t count, const float *restrict carry,
                              float *restrict to) {
    for (size_t i = 0; i < count; ++i)
        to[i] = (carry[i] + of->own[i]) + of->right[MSPRINGI_WIDTH - 1 + i];
}

// Leave a strip's part of the carry row.
static inline void carry_forces(const strip_of_doubles *of, size_t count, double *restrict carry) {
    for (size_t i = 0; i < count; ++i)
        // NOLINTNEXTLINE(gcc-analyzer-use-of-uninitialized-value): all blocks of the strip are put before
        carry[i] = of->up[i] - of->diagonal[MSPRINGI_WIDTH - 1 + i];
}
static inline void carry_blocks(const strip_of_floats *of, size_t count, float *restrict carry) {
    for (size_t i = 0; i < count; ++i)
        carry[i] = of->up[i] + of->diagonal[MSPRINGI_WIDTH - 1 + i];
}

static inline void sum_strip(const mspringi_system *s, const spring_strip *strip, size_t slot, size_t carry,
                             size_t count) {
    sum_forces(&strip->x, count, s->force_carry_x + carry, s->force_x + slot);
    sum_forces(&strip->y, count, s->force_carry_y + carry, s->force_y + slot);
    sum_blocks(&strip->xx, count, s->carry_xx + carry, s->xx + slot);
    sum_blocks(&strip->xy, count, s->carry_xy + carry, s->xy + slot);
    sum_blocks(&strip->yy, count, s->carry_yy + carry, s->yy + slot);
}

static inline void carry_strip(const mspringi_system *s, const spring_strip *strip, size_t carry, size_t count) {
    carry_forces(&strip->x, count, s->force_carry_x + carry);
    carry_forces(&strip->y, count, s->force_carry_y + carry);
    carry_blocks(&strip->xx, count, s->carry_xx + carry);
    carry_blocks(&strip->xy, count, s->carry_xy + carry);
    carry_blocks(&strip->yy, count, s->carry_yy + carry);
}

// Carry the contribution of the last of `count` slots to the next strip.
static inline void continue_strip(spring_strip *strip, size_t count) {
    const size_t before = MSPRINGI_WIDTH - 1, last = before + count;
    strip->x.right[before] = strip->x.right[last];
    strip->y.right[before] = strip->y.right[last];
    strip->xx.right[before] = strip->xx.right[last];
    strip->xy.right[before] = strip->xy.right[last];
    strip->yy.right[before] = strip->yy.right[last];
    strip->x.diagonal[before] = strip->x.diagonal[last];
    strip->y.diagonal[before] = strip->y.diagonal[last];
    strip->xx.diagonal[before] = strip->xx.diagonal[last];
    strip->xy.diagonal[before] = strip->xy.diagonal[last];
    strip->yy.diagonal[before] = strip->yy.diagonal[last];
}

// Start without a contribution from the left.
static inline void begin_strips(spring_strip *strip) {
    const size_t before = MSPRINGI_WIDTH - 1;
    strip->x.right[before] = strip->x.diagonal[before] = 0.0;
    strip->y.right[before] = strip->y.diagonal[before] = 0.0;
    strip->xx.right[before] = strip->xx.diagonal[before] = 0.0f;
    strip->xy.right[before] = strip->xy.diagonal[before] = 0.0f;
    strip->yy.right[before] = strip->yy.diagonal[before] = 0.0f;
}

MSPRINGI_INLINE void assemble_lattice_rows(const mspringi_system *system, const mspringi_span *spans,
                                           uint32_t count, bool damped, bool only_carry) {
    const mspringi_system copy = *system, *const s = &copy;
    const size_t springs = (size_t)(damped ? 2 : 1) * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
    const size_t factors = (size_t)MSPRINGI_FACTORS * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
    const linearised linear = {s->x, s->y, s->vx, s->vy, (float)s->force_scale, (float)s->damping_rate};
    spring_strip strip;
    begin_strips(&strip);
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t first = span->first_slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        for (size_t slot = first, slots; slot < end; slot += slots) {
            const size_t carry = (size_t)((int64_t)slot + span->carry);
            slots = end - slot < MSPRINGI_STRIP ? end - slot : MSPRINGI_STRIP;
            for (size_t at = 0; at < slots; at += MSPRINGI_WIDTH) {
                const size_t index = span->first_record + (slot + at - first) / MSPRINGI_WIDTH;
                assemble_block(&linear, slot + at, (size_t)((int64_t)(slot + at) + span->up),
                               mspringi_system_rests(s, index), s->lattice_springs + index * springs,
                               s->lattice_factors + index * factors, at, &strip, damped, only_carry);
            }
            if (!only_carry)
                sum_strip(s, &strip, slot, carry, slots);
            carry_strip(s, &strip, carry, slots);
            continue_strip(&strip, slots);
        }
    }
}

MSPRINGI_INLINE void assemble_lattice(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                      bool damped) {
    assemble_lattice_rows(system, spans, count, damped, false);
}

MSPRINGI_INLINE void assemble_carry(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                    bool damped) {
    assemble_lattice_rows(system, spans, count, damped, true);
}

// Rows of east springs only.
MSPRINGI_INLINE void assemble_chain(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                    bool damped) {
    const mspringi_system copy = *system, *const s = &copy;
    const linearised linear = {s->x, s->y, s->vx, s->vy, (float)s->force_scale, (float)s->damping_rate};
    spring_strip strip;
    begin_strips(&strip);
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const bool is_chain = span->record_slots == MSPRINGI_WIDTH;
        // chain records begin with the rest lengths
        const size_t parts = damped ? 2 : 1, stride = (parts + is_chain) * span->record_slots;
        const size_t factor_stride = (size_t)MSPRINGI_FACTORS * span->record_slots;
        const float *records = is_chain ? s->chain_springs : s->lattice_springs;
        float *factors = is_chain ? s->chain_factors : s->lattice_factors;
        const size_t first = span->first_slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        for (size_t slot = first, slots; slot < end; slot += slots) {
            const size_t carry = (size_t)((int64_t)slot + span->carry);
            slots = end - slot < MSPRINGI_STRIP ? end - slot : MSPRINGI_STRIP;
            for (size_t at = 0; at < slots; at += MSPRINGI_WIDTH) {
                const size_t index = span->first_record + (slot + at - first) / MSPRINGI_WIDTH;
                const float *record = records + index * stride;
                const float *rests = is_chain ? record : mspringi_system_rests(s, index);
                assemble_east(&linear, slot + at, rests, record + is_chain * MSPRINGI_WIDTH,
                              factors + index * factor_stride, at, &strip, damped);
            }
            sum_strip(s, &strip, slot, carry, slots);
            memset(s->force_carry_x + carry, 0, slots * sizeof *s->force_carry_x);
            memset(s->force_carry_y + carry, 0, slots * sizeof *s->force_carry_y);
            memset(s->carry_xx + carry, 0, slots * sizeof *s->carry_xx);
            memset(s->carry_xy + carry, 0, slots * sizeof *s->carry_xy);
            memset(s->carry_yy + carry, 0, slots * sizeof *s->carry_yy);
            continue_strip(&strip, slots);
        }
    }
}

static void assemble_lattice_plain(const mspringi_system *system, const mspringi_span *spans, uint32_t count) {
    assemble_lattice(system, spans, count, false);
}

static void assemble_lattice_damped(const mspringi_system *system, const mspringi_span *spans, uint32_t count) {
    assemble_lattice(system, spans, count, true);
}

static void assemble_chain_plain(const mspringi_system *system, const mspringi_span *spans, uint32_t count) {
    assemble_chain(system, spans, count, false);
}

static void assemble_chain_damped(const mspringi_system *system, const mspringi_span *spans, uint32_t count) {
    assemble_chain(system, spans, count, true);
}

static void assemble_carry_plain(const mspringi_system *system, const mspringi_span *spans, uint32_t count) {
    assemble_carry(system, spans, count, false);
}

static void assemble_carry_damped(const mspringi_system *system, const mspringi_span *spans, uint32_t count) {
    assemble_carry(system, spans, count, true);
}

#endif
