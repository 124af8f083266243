/// @file system_assemble.h
/// Assembly of the linear system of an implicit substep. Plain C in blocks of MSPRINGI_WIDTH lanes, which compilers
/// turn into vectors of whatever each instruction set's file is compiled for: the operations and their order are
/// the same in all of them.
///
/// In double precision as far as positions go. A stiff spring's force hangs on differences of position that single
/// precision does not resolve: at 10^12 N/m a bar of 1 m springs bears its weight with strains of 10^-6, ten times
/// what it can tell in a length.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_ASSEMBLE_H
#define MSPRINGI_SYSTEM_ASSEMBLE_H

#include <math.h>

/// What MSPRINGI_WIDTH springs exert on their bases, and their blocks of the matrix.
typedef struct assembled {
    double force_x[MSPRINGI_WIDTH], force_y[MSPRINGI_WIDTH];
    float xx[MSPRINGI_WIDTH], xy[MSPRINGI_WIDTH], yy[MSPRINGI_WIDTH];
} assembled;

/// What is handed on from slot to slot: [0] comes from the block before.
typedef struct handed_force {
    double x[MSPRINGI_WIDTH + 1], y[MSPRINGI_WIDTH + 1];
} handed_force;
typedef struct handed_block {
    float xx[MSPRINGI_WIDTH + 1], xy[MSPRINGI_WIDTH + 1], yy[MSPRINGI_WIDTH + 1];
} handed_block;
typedef struct handed {
    handed_force force;
    handed_block block;
} handed;

// Force, factors and block of the springs from the slots base ... to the slots tip ...; their dampings are behind
// their stiffnesses.
static inline void assemble_springs(const mspringi_system *s, size_t base, size_t tip, const float *rest_lengths,
                                    const float *stiffnesses, float *restrict factors, assembled *restrict to,
                                    bool damped) {
    const double *const x = s->x, *const y = s->y;
    const float *const dampings = stiffnesses + MSPRINGI_WIDTH;
    const double scale = s->force_scale, damping_rate = s->damping_rate;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double dx = x[tip + i] - x[base + i], dy = y[tip + i] - y[base + i];
        const double length = sqrt(dx * dx + dy * dy);
        const double reciprocal = 1.0 / length, inverse = length > 0.0 ? reciprocal : 0.0;
        const double nx = dx * inverse, ny = dy * inverse;
        const double extension = length - (double)rest_lengths[i];
        const double stiffness = scale * (double)stiffnesses[i];
        const double relative = extension * inverse, tensed = mspringi_swing_share(relative);
        double force = stiffness * extension, along = stiffness - stiffness * tensed;
        if (damped) {
            const double dvx = (double)s->vx[tip + i] - (double)s->vx[base + i];
            const double dvy = (double)s->vy[tip + i] - (double)s->vy[base + i];
            const double damping = scale * (double)dampings[i];
            force = force + damping * (dvx * nx + dvy * ny);
            along = along + damping * damping_rate;
        }
        const float root = sqrtf((float)along), swing = (float)(stiffness * tensed);
        const float pull_x = root * (float)nx, pull_y = root * (float)ny;
        factors[MSPRINGI_PULL_X * MSPRINGI_WIDTH + i] = pull_x;
        factors[MSPRINGI_PULL_Y * MSPRINGI_WIDTH + i] = pull_y;
        factors[MSPRINGI_SWING * MSPRINGI_WIDTH + i] = swing;
        to->force_x[i] = force * nx;
        to->force_y[i] = force * ny;
        to->xx[i] = swing + pull_x * pull_x;
        to->xy[i] = pull_x * pull_y;
        to->yy[i] = swing + pull_y * pull_y;
    }
}

// Sums of one quantity over a block's springs in the order of sweep.h: into here, carry and the two that are handed
// on. forces change sign at the tip, blocks do not.
#define MSPRINGI_SUM_FORCES(part)                                                                                  \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {                                                                  \
        right->force.part[i + 1] = east->force_##part[i] + south_east->force_##part[i];                            \
        diagonal->force.part[i + 1] = north_east->force_##part[i];                                                 \
    }                                                                                                              \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {                                                                  \
        const double sum = (east->force_##part[i] + north->force_##part[i]) + north_east->force_##part[i];         \
        s->force_##part[slot + i] = (float)((s->force_carry_##part[carry + i] + sum) - right->force.part[i]);      \
        s->force_carry_##part[carry + i] =                                                                         \
            (south_east->force_##part[i] - north->force_##part[i]) - diagonal->force.part[i];                      \
    }                                                                                                              \
    right->force.part[0] = right->force.part[MSPRINGI_WIDTH];                                                      \
    diagonal->force.part[0] = diagonal->force.part[MSPRINGI_WIDTH];

#define MSPRINGI_SUM_BLOCKS(part)                                                                                  \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {                                                                  \
        right->block.part[i + 1] = east->part[i] + south_east->part[i];                                            \
        diagonal->block.part[i + 1] = north_east->part[i];                                                         \
    }                                                                                                              \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {                                                                  \
        const float sum = (east->part[i] + north->part[i]) + north_east->part[i];                                  \
        s->part[slot + i] = (s->carry_##part[carry + i] + sum) + right->block.part[i];                             \
        s->carry_##part[carry + i] = (south_east->part[i] + north->part[i]) + diagonal->block.part[i];             \
    }                                                                                                              \
    right->block.part[0] = right->block.part[MSPRINGI_WIDTH];                                                      \
    diagonal->block.part[0] = diagonal->block.part[MSPRINGI_WIDTH];

static inline void sum_block(const mspringi_system *s, size_t slot, size_t carry, const assembled *east,
                             const assembled *north, const assembled *north_east, const assembled *south_east,
                             handed *restrict right, handed *restrict diagonal) {
    MSPRINGI_SUM_FORCES(x)
    MSPRINGI_SUM_FORCES(y)
    MSPRINGI_SUM_BLOCKS(xx)
    MSPRINGI_SUM_BLOCKS(xy)
    MSPRINGI_SUM_BLOCKS(yy)
}

#undef MSPRINGI_SUM_FORCES
#undef MSPRINGI_SUM_BLOCKS

static inline void assemble_lattice(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                    bool damped) {
    const mspringi_system copy = *system, *const s = &copy;
    const size_t part = (size_t)(damped ? 2 : 1) * MSPRINGI_WIDTH;
    const size_t factor = (size_t)MSPRINGI_FACTORS * MSPRINGI_WIDTH;
    assembled east, north, north_east, south_east;
    handed right = {{{0.0}, {0.0}}, {{0.0f}, {0.0f}, {0.0f}}}, diagonal = right;
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t first = span->first_slot / MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
        for (size_t block = first; block < end; ++block) {
            const size_t slot = block * MSPRINGI_WIDTH, index = span->first_record + (block - first);
            const size_t up = (size_t)((int64_t)slot + span->up), carry = (size_t)((int64_t)slot + span->carry);
            const float *record = s->lattice_springs + index * MSPRINGI_DIRECTIONS * part;
            const float *rests = mspringi_system_rests(s, index);
            float *factors = s->lattice_factors + index * MSPRINGI_DIRECTIONS * factor;
            assemble_springs(s, slot, slot + 1, rests + MSPRINGI_EAST * MSPRINGI_WIDTH,
                             record + MSPRINGI_EAST * part, factors + MSPRINGI_EAST * factor, &east, damped);
            assemble_springs(s, slot, up, rests + MSPRINGI_NORTH * MSPRINGI_WIDTH, record + MSPRINGI_NORTH * part,
                             factors + MSPRINGI_NORTH * factor, &north, damped);
            assemble_springs(s, slot, up + 1, rests + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                             record + MSPRINGI_NORTH_EAST * part, factors + MSPRINGI_NORTH_EAST * factor,
                             &north_east, damped);
            assemble_springs(s, up, slot + 1, rests + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                             record + MSPRINGI_SOUTH_EAST * part, factors + MSPRINGI_SOUTH_EAST * factor,
                             &south_east, damped);
            sum_block(s, slot, carry, &east, &north, &north_east, &south_east, &right, &diagonal);
        }
    }
}

// Forces and blocks that a block's springs hand on to the row above, in the order of sum_block().
#define MSPRINGI_HAND_ON_FORCES(part)                                                                              \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)                                                                    \
        diagonal->force.part[i + 1] = north_east->force_##part[i];                                                 \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)                                                                    \
        s->force_carry_##part[carry + i] =                                                                         \
            (south_east->force_##part[i] - north->force_##part[i]) - diagonal->force.part[i];                      \
    diagonal->force.part[0] = diagonal->force.part[MSPRINGI_WIDTH];

#define MSPRINGI_HAND_ON_BLOCKS(part)                                                                              \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)                                                                    \
        diagonal->block.part[i + 1] = north_east->part[i];                                                         \
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)                                                                    \
        s->carry_##part[carry + i] = (south_east->part[i] + north->part[i]) + diagonal->block.part[i];             \
    diagonal->block.part[0] = diagonal->block.part[MSPRINGI_WIDTH];

static inline void hand_on_block(const mspringi_system *s, size_t carry, const assembled *north,
                                 const assembled *north_east, const assembled *south_east,
                                 handed *restrict diagonal) {
    MSPRINGI_HAND_ON_FORCES(x)
    MSPRINGI_HAND_ON_FORCES(y)
    MSPRINGI_HAND_ON_BLOCKS(xx)
    MSPRINGI_HAND_ON_BLOCKS(xy)
    MSPRINGI_HAND_ON_BLOCKS(yy)
}

#undef MSPRINGI_HAND_ON_FORCES
#undef MSPRINGI_HAND_ON_BLOCKS

static inline void hand_on_forces(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                  bool damped) {
    const mspringi_system copy = *system, *const s = &copy;
    const size_t part = (size_t)(damped ? 2 : 1) * MSPRINGI_WIDTH;
    float factors[MSPRINGI_FACTORS * MSPRINGI_WIDTH]; // whoever has these rows keeps theirs
    assembled north, north_east, south_east;
    handed diagonal = {{{0.0}, {0.0}}, {{0.0f}, {0.0f}, {0.0f}}};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t first = span->first_slot / MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
        for (size_t block = first; block < end; ++block) {
            const size_t slot = block * MSPRINGI_WIDTH, index = span->first_record + (block - first);
            const size_t up = (size_t)((int64_t)slot + span->up), carry = (size_t)((int64_t)slot + span->carry);
            const float *record = s->lattice_springs + index * MSPRINGI_DIRECTIONS * part;
            const float *rests = mspringi_system_rests(s, index);
            assemble_springs(s, slot, up, rests + MSPRINGI_NORTH * MSPRINGI_WIDTH, record + MSPRINGI_NORTH * part,
                             factors, &north, damped);
            assemble_springs(s, slot, up + 1, rests + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                             record + MSPRINGI_NORTH_EAST * part, factors, &north_east, damped);
            assemble_springs(s, up, slot + 1, rests + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                             record + MSPRINGI_SOUTH_EAST * part, factors, &south_east, damped);
            hand_on_block(s, carry, &north, &north_east, &south_east, &diagonal);
        }
    }
}

// East springs only.
static inline void assemble_chain(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                  bool damped) {
    const mspringi_system copy = *system, *const s = &copy;
    assembled east;
    const assembled none = {{0.0}, {0.0}, {0.0f}, {0.0f}, {0.0f}};
    handed right = {{{0.0}, {0.0}}, {{0.0f}, {0.0f}, {0.0f}}}, diagonal = right;
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const bool is_chain = span->record_slots == MSPRINGI_WIDTH;
        // A chain's records have the rest lengths in front.
        const size_t parts = damped ? 2 : 1, stride = (parts + is_chain) * span->record_slots;
        const size_t factor_stride = (size_t)MSPRINGI_FACTORS * span->record_slots;
        const float *record = (is_chain ? s->chain_springs : s->lattice_springs) + span->first_record * stride;
        float *factors = (is_chain ? s->chain_factors : s->lattice_factors) + span->first_record * factor_stride;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
        for (size_t block = span->first_slot / MSPRINGI_WIDTH; block < end; ++block) {
            const size_t slot = block * MSPRINGI_WIDTH, carry = (size_t)((int64_t)slot + span->carry);
            const float *rests =
                is_chain
                    ? record
                    : mspringi_system_rests(s, span->first_record + (block - span->first_slot / MSPRINGI_WIDTH));
            assemble_springs(s, slot, slot + 1, rests, record + is_chain * MSPRINGI_WIDTH, factors, &east, damped);
            sum_block(s, slot, carry, &east, &none, &none, &none, &right, &diagonal);
            record += stride;
            factors += factor_stride;
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

static void hand_on_forces_plain(const mspringi_system *system, const mspringi_span *spans, uint32_t count) {
    hand_on_forces(system, spans, count, false);
}

static void hand_on_forces_damped(const mspringi_system *system, const mspringi_span *spans, uint32_t count) {
    hand_on_forces(system, spans, count, true);
}

#endif
