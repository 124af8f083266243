/// @file system_energy.h
/// How energy changes in an implicit substep: see stability/energy.c. Plain C in blocks of MSPRINGI_WIDTH lanes, as
/// in system_assemble.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_ENERGY_H
#define MSPRINGI_SYSTEM_ENERGY_H

#include <math.h>

#include "base/cpu.h"
#include "system_iterate.h"

/// Sums by lane.
typedef struct lane_sums {
    double of[MSPRINGI_MOVE_SUMS][MSPRINGI_WIDTH]; ///< of springs there are fewer
} lane_sums;

static inline void clear_sums(lane_sums *sums, size_t count) {
    for (size_t i = 0; i < count; ++i)
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
            sums->of[i][lane] = 0.0;
}

static inline void put_sums(const lane_sums *sums, size_t count, double *to) {
    for (size_t i = 0; i < count; ++i) {
        double sum = 0.0;
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
            sum += sums->of[i][lane];
        to[i] = sum;
    }
}

// As in landing.
static inline float velocity_after(const mspringi_motion *m, const mspringi_motion_axis *axis, size_t slot) {
    const float d = axis->solution[slot] + m->alpha * axis->direction[slot];
    const float moved = axis->start[slot] + m->rate * d;
    return m->mass[slot] > 0.0f ? moved : axis->velocity[slot];
}

// A coordinate of a block of slots. The parameters are what compilers know to be apart from each other.
static MSPRINGI_NOINLINE void
move_coordinate(const float *restrict position, const float *restrict low, const float *restrict velocity,
                const double *restrict predicted, const float *restrict start, const float *restrict solution,
                const float *restrict direction, const float *restrict mass, float alpha, float rate,
                float *restrict step, double *restrict kinetic, double *restrict gain, double *restrict momentum,
                double *restrict push, double *restrict way, double *restrict largest, double *restrict driven) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float d = solution[i] + alpha * direction[i], before = velocity[i];
        const float after = start[i] + rate * d; // whatever that is where there is no mass
        const double from = (double)position[i] + (double)low[i];
        const float stepped = (float)((predicted[i] + (double)d) - from);
        const double m = (double)mass[i], v = (double)before, change = (double)after - v;
        const double size = (double)fabsf(d), pinned = (double)fabsf(stepped) * (double)(mass[i] == 0.0f);
        step[i] = stepped;
        kinetic[i] += m * (v * v);
        gain[i] += m * (change * ((double)after + v));
        momentum[i] += m * v;
        push[i] += m * change;
        way[i] += m * (double)stepped;
        largest[i] = size > largest[i] ? size : largest[i];
        driven[i] = pinned > driven[i] ? pinned : driven[i];
    }
}

static inline void move_block(const mspringi_motion *m, size_t axis, size_t slot, lane_sums *sums) {
    const mspringi_motion_axis *const c = &m->axes[axis];
    move_coordinate(c->position + slot, c->low + slot, c->velocity + slot, c->predicted + slot, c->start + slot,
                    c->solution + slot, c->direction + slot, m->mass + slot, m->alpha, m->rate, c->step + slot,
                    sums->of[MSPRINGI_MOVE_KINETIC], sums->of[MSPRINGI_MOVE_GAIN],
                    sums->of[MSPRINGI_MOVE_MOMENTUM + axis], sums->of[MSPRINGI_MOVE_PUSH + axis],
                    sums->of[MSPRINGI_MOVE_WAY + axis], sums->of[MSPRINGI_MOVE_LARGEST],
                    sums->of[MSPRINGI_MOVE_DRIVEN]);
    for (size_t i = 0; c->force && i < MSPRINGI_WIDTH; ++i) {
        const double force = m->mass[slot + i] > 0.0f ? (double)c->force[slot + i] : 0.0;
        sums->of[MSPRINGI_MOVE_WORK][i] += force * (double)c->step[slot + i];
        sums->of[MSPRINGI_MOVE_FORCE + axis][i] += force;
    }
}

static void sum_moves(const mspringi_motion *m, size_t first, size_t end, double *to) {
    lane_sums sums;
    clear_sums(&sums, MSPRINGI_MOVE_SUMS);
    for (size_t slot = first; slot < end; slot += MSPRINGI_WIDTH) {
        move_block(m, 0, slot, &sums);
        move_block(m, 1, slot, &sums);
        for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
            const double mass = (double)m->mass[slot + i];
            sums.of[MSPRINGI_MOVE_MASS][i] += mass;
            sums.of[MSPRINGI_MOVE_COUNT][i] += mass > 0.0 ? 1.0 : 0.0;
        }
    }
    put_sums(&sums, MSPRINGI_MOVE_SUMS, to);
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        to[MSPRINGI_MOVE_LARGEST] = lane == 0 || sums.of[MSPRINGI_MOVE_LARGEST][lane] > to[MSPRINGI_MOVE_LARGEST]
                                        ? sums.of[MSPRINGI_MOVE_LARGEST][lane]
                                        : to[MSPRINGI_MOVE_LARGEST];
    }
}

/// Lengths of MSPRINGI_WIDTH springs before the substep and after it, m, and the difference of their squares.
typedef struct stretched_lanes {
    float before[MSPRINGI_WIDTH], after[MSPRINGI_WIDTH], added[MSPRINGI_WIDTH];
} stretched_lanes;

MSPRINGI_PART_INLINE void measure_lanes(const mspringi_motion *m, size_t base, size_t tip,
                                        stretched_lanes *restrict to) {
    const mspringi_motion_axis *const cx = &m->axes[0], *const cy = &m->axes[1];
    const float *const ax = cx->position + base, *const ay = cy->position + base;
    const float *const bx = cx->position + tip, *const by = cy->position + tip;
    const float *const ax_low = cx->low + base, *const ay_low = cy->low + base;
    const float *const bx_low = cx->low + tip, *const by_low = cy->low + tip;
    const float *const ax_step = cx->step + base, *const ay_step = cy->step + base;
    const float *const bx_step = cx->step + tip, *const by_step = cy->step + tip;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float x = (bx[i] - ax[i]) + (bx_low[i] - ax_low[i]), y = (by[i] - ay[i]) + (by_low[i] - ay_low[i]);
        const float dx = bx_step[i] - ax_step[i], dy = by_step[i] - ay_step[i];
        const float later_x = x + dx, later_y = y + dy;
        to->before[i] = sqrtf(x * x + y * y);
        to->after[i] = sqrtf(later_x * later_x + later_y * later_y);
        to->added[i] = (x + later_x) * dx + (y + later_y) * dy;
    }
}

// With e = l - L0: what a spring gains is k (l1 - l0) (e0 + e1) / 2, and l1 - l0 is the difference of the squares
// over l0 + l1, which keeps its digits however small it is.
MSPRINGI_PART_INLINE void stretch_lanes(const stretched_lanes *restrict lengths, float scale,
                                        const float *restrict rest_lengths, const float *restrict stiffnesses,
                                        double *restrict gain, double *restrict energy, double *restrict pull,
                                        double *restrict error, double *restrict length,
                                        double *restrict stiffness) {
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float before = lengths->before[i], both = before + lengths->after[i];
        const float quotient = lengths->added[i] / both, longer = both > 0.0f ? quotient : 0.0f;
        const float k = scale * stiffnesses[i], start = before - rest_lengths[i], stretch = start + longer;
        const float at_end = k * stretch, off = k * longer * before;
        gain[i] += (double)(k * longer * (start + 0.5f * longer));
        energy[i] += (double)(at_end * stretch);
        pull[i] += (double)fabsf(at_end);
        error[i] += (double)off * (double)off;
        length[i] += (double)(k * before) * (double)before;
        stiffness[i] += (double)stiffnesses[i];
    }
}

// Springs of some directions, in the order of these. What can be measured of all of them is first: a length is a
// long chain of operations that wait for each other. (Looking at the energy of 544x68 took 370 us one spring after
// the other, and takes 310.)
static MSPRINGI_NOINLINE void stretch_directions(const mspringi_motion *m, const size_t *bases, const size_t *tips,
                                                 size_t directions, const float *rest_lengths,
                                                 const float *stiffnesses, size_t stride, lane_sums *sums) {
    stretched_lanes lengths[MSPRINGI_DIRECTIONS];
    for (size_t i = 0; i < directions; ++i)
        measure_lanes(m, bases[i], tips[i], &lengths[i]);
    for (size_t i = 0; i < directions; ++i)
        stretch_lanes(&lengths[i], m->stiffness_scale, rest_lengths + i * MSPRINGI_WIDTH, stiffnesses + i * stride,
                      sums->of[MSPRINGI_STRETCH_GAIN], sums->of[MSPRINGI_STRETCH_ENERGY],
                      sums->of[MSPRINGI_STRETCH_PULL], sums->of[MSPRINGI_STRETCH_ERROR],
                      sums->of[MSPRINGI_STRETCH_LENGTH], sums->of[MSPRINGI_STRETCH_STIFFNESS]);
}

// What pinned ends that move give: the force before the substep or after it, whatever is more, times
// their way.
static inline void give_springs(const mspringi_motion *m, size_t base, size_t tip, const float *rest_lengths,
                                const float *stiffnesses, lane_sums *sums, bool damped) {
    const mspringi_motion_axis *const cx = &m->axes[0], *const cy = &m->axes[1];
    const float *const dampings = stiffnesses + MSPRINGI_WIDTH;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const size_t a = base + i, b = tip + i;
        const float a_pinned = m->mass[a] > 0.0f ? 0.0f : 1.0f, b_pinned = m->mass[b] > 0.0f ? 0.0f : 1.0f;
        const float px = b_pinned * cx->step[b] - a_pinned * cx->step[a];
        const float py = b_pinned * cy->step[b] - a_pinned * cy->step[a];
        const float x = (cx->position[b] - cx->position[a]) + (cx->low[b] - cx->low[a]);
        const float y = (cy->position[b] - cy->position[a]) + (cy->low[b] - cy->low[a]);
        const float later_x = x + (cx->step[b] - cx->step[a]), later_y = y + (cy->step[b] - cy->step[a]);
        const float before = sqrtf(x * x + y * y), after = sqrtf(later_x * later_x + later_y * later_y);
        const float per_before = before > 0.0f ? 1.0f / before : 0.0f,
                    per_after = after > 0.0f ? 1.0f / after : 0.0f;
        const float nx = x * per_before, ny = y * per_before;
        const float later_nx = later_x * per_after, later_ny = later_y * per_after;
        const float k = m->stiffness_scale * stiffnesses[i], c = damped ? m->stiffness_scale * dampings[i] : 0.0f;
        const float rate = nx * (cx->velocity[b] - cx->velocity[a]) + ny * (cy->velocity[b] - cy->velocity[a]);
        const float later_rate = later_nx * (velocity_after(m, cx, b) - velocity_after(m, cx, a)) +
                                 later_ny * (velocity_after(m, cy, b) - velocity_after(m, cy, a));
        const float start = (k * (before - rest_lengths[i]) + c * rate) * (nx * px + ny * py);
        const float end = (k * (after - rest_lengths[i]) + c * later_rate) * (later_nx * px + later_ny * py);
        sums->of[MSPRINGI_STRETCH_GIVEN][i] += (double)(end > start ? end : start);
    }
}

// What the springs of a row's block come to. driven: with what pinned ends give.
static inline void stretch_block(const mspringi_motion *m, size_t slot, size_t up, size_t directions,
                                 const float *rest_lengths, const float *stiffnesses, size_t stride, bool driven,
                                 lane_sums *sums) {
    const size_t bases[MSPRINGI_DIRECTIONS] = {
        [MSPRINGI_EAST] = slot, [MSPRINGI_NORTH] = slot, [MSPRINGI_NORTH_EAST] = slot, [MSPRINGI_SOUTH_EAST] = up};
    const size_t tips[MSPRINGI_DIRECTIONS] = {[MSPRINGI_EAST] = slot + 1,
                                              [MSPRINGI_NORTH] = up,
                                              [MSPRINGI_NORTH_EAST] = up + 1,
                                              [MSPRINGI_SOUTH_EAST] = slot + 1};
    stretch_directions(m, bases, tips, directions, rest_lengths, stiffnesses, stride, sums);
    for (size_t i = 0; driven && i < directions; ++i)
        give_springs(m, bases[i], tips[i], rest_lengths + i * MSPRINGI_WIDTH, stiffnesses + i * stride, sums,
                     stride > MSPRINGI_WIDTH);
}

static inline void stretch_rows(const mspringi_system *system, const mspringi_motion *m, const mspringi_span *spans,
                                uint32_t count, bool is_lattice, bool driven, lane_sums *sums) {
    const size_t part = (size_t)(system->parts - 1) * MSPRINGI_WIDTH;
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t first = span->first_slot / MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
        for (size_t block = first; block < end; ++block) {
            const size_t slot = block * MSPRINGI_WIDTH, index = span->first_record + (block - first);
            if (span->record_slots == MSPRINGI_WIDTH) {
                const float *record = system->chain_springs + index * (part + MSPRINGI_WIDTH);
                stretch_block(m, slot, slot, 1, record, record + MSPRINGI_WIDTH, part, driven, sums);
                continue;
            }
            const size_t up = is_lattice ? (size_t)((int64_t)slot + span->up) : slot;
            stretch_block(m, slot, up, is_lattice ? MSPRINGI_DIRECTIONS : 1, mspringi_system_rests(system, index),
                          system->lattice_springs + index * MSPRINGI_DIRECTIONS * part, part, driven, sums);
        }
    }
}

static void sum_stretches(const mspringi_system *system, const mspringi_motion *m, const mspringi_span *spans,
                          uint32_t count, bool is_lattice, bool driven, double *to) {
    lane_sums sums;
    clear_sums(&sums, MSPRINGI_STRETCH_SUMS);
    stretch_rows(system, m, spans, count, is_lattice, driven, &sums);
    put_sums(&sums, MSPRINGI_STRETCH_SUMS, to);
}

#endif
