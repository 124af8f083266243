/// @file system_energy.h
/// Momenta and energies before and after an implicit substep: see solvers/implicit/energy_budget.h. Plain C in
/// blocks of MSPRINGI_WIDTH lanes, as in system_assemble.h. In double precision: at the stiffness of iron, lengths
/// rounded to single precision would create more energy than a body at rest has.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_ENERGY_H
#define MSPRINGI_SYSTEM_ENERGY_H

#include <math.h>

#include "base/cpu.h"
#include "kernels/system_iterate.h"

// Sum in pairs, as sum_block_lanes() does. A loop over halves took a tenth of the pass.
static inline double sum_wide_lanes(const double *lanes) {
    double sums[MSPRINGI_WIDTH / 4];
    for (size_t i = 0; i < MSPRINGI_WIDTH / 4; ++i)
        sums[i] = (lanes[i] + lanes[i + 8]) + (lanes[i + 4] + lanes[i + 12]);
    return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

/* ------------------------------------------------------------------------------------------------------ moments */

// Parameters, since compilers know that restrict parameters do not alias.
static MSPRINGI_NOINLINE void
add_moments_of_block(const float *restrict place_x, const float *restrict place_y, const float *restrict low_x,
                     const float *restrict low_y, const float *restrict velocity_x,
                     const float *restrict velocity_y, const float *restrict inverse_mass,
                     const double *restrict origin, double *restrict mass, double *restrict moment_x,
                     double *restrict moment_y, double *restrict momentum_x, double *restrict momentum_y,
                     double *restrict inertia, double *restrict spin, double *restrict kinetic) {
    const double at_x = origin[0], at_y = origin[1], at_vx = origin[2], at_vy = origin[3];
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float heavy = 1.0f / inverse_mass[i];
        const double m = (double)(inverse_mass[i] > 0.0f ? heavy : 0.0f);
        const double x = ((double)place_x[i] - at_x) + (double)low_x[i];
        const double y = ((double)place_y[i] - at_y) + (double)low_y[i];
        const double vx = (double)velocity_x[i] - at_vx, vy = (double)velocity_y[i] - at_vy;
        const double px = m * vx, py = m * vy, mx = m * x, my = m * y;
        mass[i] += m;
        moment_x[i] += mx;
        moment_y[i] += my;
        momentum_x[i] += px;
        momentum_y[i] += py;
        inertia[i] += mx * x + my * y;
        spin[i] += x * py - y * px;
        kinetic[i] += px * vx + py * vy;
    }
}

// Add to them what the low words of the velocities of precise networks amount to.
static MSPRINGI_NOINLINE void add_low_moments_of_block(const mspringi_motion *m, size_t slot, const double *origin,
                                                       double (*sums)[MSPRINGI_WIDTH]) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i, ++slot) {
        const double mass = m->inverse_mass[slot] > 0.0f ? (double)(1.0f / m->inverse_mass[slot]) : 0.0;
        const double x = ((double)m->x[slot] - origin[0]) + (double)m->low_x[slot];
        const double y = ((double)m->y[slot] - origin[1]) + (double)m->low_y[slot];
        const double low_vx = (double)m->low_vx[slot], low_vy = (double)m->low_vy[slot];
        const double vx = (double)m->vx[slot] - origin[2], vy = (double)m->vy[slot] - origin[3];
        sums[MSPRINGI_MOMENT_PX][i] += mass * low_vx;
        sums[MSPRINGI_MOMENT_PY][i] += mass * low_vy;
        sums[MSPRINGI_MOMENT_SPIN][i] += mass * (x * low_vy - y * low_vx);
        sums[MSPRINGI_MOMENT_KINETIC][i] += mass * (low_vx * (2.0 * vx + low_vx) + low_vy * (2.0 * vy + low_vy));
    }
}

static void sum_moments(const mspringi_motion *m, size_t first, size_t end, const double *origin, double *to) {
    double sums[MSPRINGI_MOMENTS][MSPRINGI_WIDTH] = {{0.0}};
    for (size_t slot = first; slot < end; slot += MSPRINGI_WIDTH)
        add_moments_of_block(m->x + slot, m->y + slot, m->low_x + slot, m->low_y + slot, m->vx + slot, m->vy + slot,
                             m->inverse_mass + slot, origin, sums[MSPRINGI_MOMENT_MASS], sums[MSPRINGI_MOMENT_X],
                             sums[MSPRINGI_MOMENT_Y], sums[MSPRINGI_MOMENT_PX], sums[MSPRINGI_MOMENT_PY],
                             sums[MSPRINGI_MOMENT_INERTIA], sums[MSPRINGI_MOMENT_SPIN],
                             sums[MSPRINGI_MOMENT_KINETIC]);
    for (size_t slot = first; m->low_vx && slot < end; slot += MSPRINGI_WIDTH)
        add_low_moments_of_block(m, slot, origin, sums);
    for (size_t i = 0; i < MSPRINGI_MOMENTS; ++i)
        to[i] = sum_wide_lanes(sums[i]);
}

/* --------------------------------------------------------------------------------------------- elastic energy */

/// Positions of a block's slots, m, rounded to double precision once for all of its springs.
typedef struct block_places {
    double x[MSPRINGI_WIDTH], y[MSPRINGI_WIDTH];
} block_places;

// Parameters, since compilers know that restrict parameters do not alias.
MSPRINGI_INLINE void round_places(const float *restrict x, const float *restrict y, const float *restrict low_x,
                                  const float *restrict low_y, block_places *restrict to) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        to->x[i] = (double)x[i] + (double)low_x[i];
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        to->y[i] = (double)y[i] + (double)low_y[i];
}

static MSPRINGI_NOINLINE void find_places(const mspringi_motion *m, size_t slot, block_places *to) {
    round_places(m->x + slot, m->y + slot, m->low_x + slot, m->low_y + slot, to);
}

/// Twice the energy of springs, and k l^2, by lane.
typedef struct elastic_lanes {
    double energy[MSPRINGI_WIDTH], length[MSPRINGI_WIDTH];
} elastic_lanes;

// Twice the energy of one spring.
MSPRINGI_INLINE double twice_energy(double x, double y, float rest_length, float stiffness, double *length) {
    const double square = x * x + y * y, extension = sqrt(square) - (double)rest_length, k = (double)stiffness;
    *length += k * square;
    return k * (extension * extension);
}

static MSPRINGI_NOINLINE void find_elastic_east(const block_places *restrict here,
                                                const block_places *restrict next,
                                                const float *restrict rest_lengths,
                                                const float *restrict stiffnesses, elastic_lanes *restrict to) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        double length = 0.0;
        to->energy[i] = twice_energy(next->x[i] - here->x[i], next->y[i] - here->y[i], rest_lengths[i],
                                     stiffnesses[i], &length);
        to->length[i] = length;
    }
}

// Directions in the order east, north, north-east, south-east.
static MSPRINGI_NOINLINE void find_elastic(const block_places *restrict here, const block_places *restrict next,
                                           const block_places *restrict above,
                                           const block_places *restrict above_next,
                                           const float *restrict rest_lengths, const float *restrict stiffnesses,
                                           size_t stride, elastic_lanes *restrict to) {
    const float *const rest_north = rest_lengths + MSPRINGI_NORTH * MSPRINGI_WIDTH;
    const float *const rest_north_east = rest_lengths + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH;
    const float *const rest_south_east = rest_lengths + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH;
    const float *const north = stiffnesses + MSPRINGI_NORTH * stride;
    const float *const north_east = stiffnesses + MSPRINGI_NORTH_EAST * stride;
    const float *const south_east = stiffnesses + MSPRINGI_SOUTH_EAST * stride;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double x = here->x[i], y = here->y[i], next_x = next->x[i], next_y = next->y[i];
        const double up_x = above->x[i], up_y = above->y[i];
        double energy, length = 0.0;
        energy = twice_energy(next_x - x, next_y - y, rest_lengths[i], stiffnesses[i], &length);
        energy += twice_energy(up_x - x, up_y - y, rest_north[i], north[i], &length);
        energy +=
            twice_energy(above_next->x[i] - x, above_next->y[i] - y, rest_north_east[i], north_east[i], &length);
        energy += twice_energy(next_x - up_x, next_y - up_y, rest_south_east[i], south_east[i], &length);
        to->energy[i] = energy;
        to->length[i] = length;
    }
}

// Sum over the springs of a row's block. A slot's right neighbour is loaded from the state again: one lane off from
// a recent write, the load would stall.
MSPRINGI_INLINE void put_elastic(const mspringi_motion *m, size_t slot, size_t up, size_t directions,
                                 const float *rest_lengths, const float *stiffnesses, size_t stride,
                                 mspringi_elastic *to) {
    block_places here, next, above, above_next;
    elastic_lanes lanes;
    find_places(m, slot, &here);
    find_places(m, slot + 1, &next);
    if (directions > 1) {
        find_places(m, up, &above);
        find_places(m, up + 1, &above_next);
        find_elastic(&here, &next, &above, &above_next, rest_lengths, stiffnesses, stride, &lanes);
    } else {
        find_elastic_east(&here, &next, rest_lengths, stiffnesses, &lanes);
    }
    to->energy = 0.5 * sum_wide_lanes(lanes.energy);
    to->length = sum_wide_lanes(lanes.length);
}

static void sum_elastic(const mspringi_system *system, const mspringi_motion *m, const mspringi_span *spans,
                        uint32_t count, bool is_lattice, mspringi_elastic *to) {
    const size_t part = (size_t)(system->parts - 1) * MSPRINGI_WIDTH;
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t first = span->first_slot / MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
        for (size_t block = first; block < end; ++block) {
            const size_t slot = block * MSPRINGI_WIDTH, index = span->first_record + (block - first);
            if (span->record_slots == MSPRINGI_WIDTH) {
                const float *record = system->chain_springs + index * (part + MSPRINGI_WIDTH);
                put_elastic(m, slot, slot, 1, record, record + MSPRINGI_WIDTH, part, &to[block]);
                continue;
            }
            const size_t up = is_lattice ? (size_t)((int64_t)slot + span->up) : slot;
            put_elastic(m, slot, up, is_lattice ? MSPRINGI_DIRECTIONS : 1, mspringi_system_rests(system, index),
                        system->lattice_springs + index * MSPRINGI_DIRECTIONS * part, part, &to[block]);
        }
    }
}

#endif
