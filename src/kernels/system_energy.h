/// @file system_energy.h
/// Momenta and energies before and after an implicit substep: see solvers/implicit/budget.h. Plain C in blocks of
/// MSPRINGI_WIDTH lanes, as in system_assemble.h. All in double precision: beside the stiffness of iron, lengths
/// that are rounded to floats would make more energy than a body at rest has.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_ENERGY_H
#define MSPRINGI_SYSTEM_ENERGY_H

#include <math.h>

#include "base/cpu.h"
#include "kernels/system_iterate.h"

static inline double sum_wide_lanes(double *lanes) {
    for (size_t half = MSPRINGI_WIDTH / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i)
            lanes[i] = lanes[i] + lanes[i + half];
    return lanes[0];
}

/* ------------------------------------------------------------------------------------------------------ moments */

// The parameters are what compilers know to be apart from each other.
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

static void sum_moments(const mspringi_motion *m, size_t first, size_t end, const double *origin, double *to) {
    double sums[MSPRINGI_MOMENTS][MSPRINGI_WIDTH] = {{0.0}};
    for (size_t slot = first; slot < end; slot += MSPRINGI_WIDTH)
        add_moments_of_block(m->x + slot, m->y + slot, m->low_x + slot, m->low_y + slot, m->vx + slot, m->vy + slot,
                             m->inverse_mass + slot, origin, sums[MSPRINGI_MOMENT_MASS], sums[MSPRINGI_MOMENT_X],
                             sums[MSPRINGI_MOMENT_Y], sums[MSPRINGI_MOMENT_PX], sums[MSPRINGI_MOMENT_PY],
                             sums[MSPRINGI_MOMENT_INERTIA], sums[MSPRINGI_MOMENT_SPIN],
                             sums[MSPRINGI_MOMENT_KINETIC]);
    for (size_t i = 0; i < MSPRINGI_MOMENTS; ++i)
        to[i] = sum_wide_lanes(sums[i]);
}

/* --------------------------------------------------------------------------------------------- elastic energy */

static MSPRINGI_NOINLINE void
add_elastic_lanes(const float *restrict ax, const float *restrict ay, const float *restrict bx,
                  const float *restrict by, const float *restrict ax_low, const float *restrict ay_low,
                  const float *restrict bx_low, const float *restrict by_low, const float *restrict rest_lengths,
                  const float *restrict stiffnesses, double *restrict energy, double *restrict length) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double x = ((double)bx[i] - (double)ax[i]) + ((double)bx_low[i] - (double)ax_low[i]);
        const double y = ((double)by[i] - (double)ay[i]) + ((double)by_low[i] - (double)ay_low[i]);
        const double square = x * x + y * y, extension = sqrt(square) - (double)rest_lengths[i];
        const double k = (double)stiffnesses[i];
        energy[i] += k * (extension * extension);
        length[i] += k * square;
    }
}

// The springs of a row's block.
MSPRINGI_INLINE void put_elastic(const mspringi_motion *m, size_t slot, size_t up, size_t directions,
                                 const float *rest_lengths, const float *stiffnesses, size_t stride,
                                 mspringi_elastic *to) {
    const size_t bases[MSPRINGI_DIRECTIONS] = {
        [MSPRINGI_EAST] = slot, [MSPRINGI_NORTH] = slot, [MSPRINGI_NORTH_EAST] = slot, [MSPRINGI_SOUTH_EAST] = up};
    const size_t tips[MSPRINGI_DIRECTIONS] = {[MSPRINGI_EAST] = slot + 1,
                                              [MSPRINGI_NORTH] = up,
                                              [MSPRINGI_NORTH_EAST] = up + 1,
                                              [MSPRINGI_SOUTH_EAST] = slot + 1};
    double energy[MSPRINGI_WIDTH] = {0.0}, length[MSPRINGI_WIDTH] = {0.0};
    for (size_t i = 0; i < directions; ++i)
        add_elastic_lanes(m->x + bases[i], m->y + bases[i], m->x + tips[i], m->y + tips[i], m->low_x + bases[i],
                          m->low_y + bases[i], m->low_x + tips[i], m->low_y + tips[i],
                          rest_lengths + i * MSPRINGI_WIDTH, stiffnesses + i * stride, energy, length);
    to->energy = 0.5 * sum_wide_lanes(energy);
    to->length = sum_wide_lanes(length);
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
