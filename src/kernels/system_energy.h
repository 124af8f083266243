/// @file system_energy.h
/// How energy changes in an implicit substep: see stability/energy.c. Plain C in blocks of MSPRINGI_WIDTH lanes, as
/// in system_assemble.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_ENERGY_H
#define MSPRINGI_SYSTEM_ENERGY_H

#include <math.h>

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

static inline float larger_of(float a, float b) {
    return b > a ? b : a;
}

// A coordinate of a block of slots.
static inline void move_coordinate(const mspringi_motion *m, size_t axis, size_t slot, lane_sums *sums) {
    const mspringi_motion_axis *const c = &m->axes[axis];
    const float alpha = m->alpha, rate = m->rate;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const size_t at = slot + i;
        const float d = c->solution[at] + alpha * c->direction[at], before = c->velocity[at], mass = m->mass[at];
        const float moved = c->start[at] + rate * d, after = mass > 0.0f ? moved : before;
        const double from = (double)c->position[at] + (double)c->low[at];
        const float step = (float)((c->predicted[at] + (double)d) - from);
        const double m_i = (double)mass, v = (double)before, change = (double)after - v;
        c->step[at] = step;
        sums->of[MSPRINGI_MOVE_KINETIC][i] += m_i * (v * v);
        sums->of[MSPRINGI_MOVE_GAIN][i] += m_i * (change * ((double)after + v));
        sums->of[MSPRINGI_MOVE_MOMENTUM + axis][i] += m_i * v;
        sums->of[MSPRINGI_MOVE_PUSH + axis][i] += m_i * change;
        sums->of[MSPRINGI_MOVE_WAY + axis][i] += m_i * (double)step;
        const double largest = sums->of[MSPRINGI_MOVE_LARGEST][i], size = (double)fabsf(d);
        sums->of[MSPRINGI_MOVE_LARGEST][i] = size > largest ? size : largest;
        const double driven = sums->of[MSPRINGI_MOVE_DRIVEN][i], way = mass > 0.0f ? 0.0 : (double)fabsf(step);
        sums->of[MSPRINGI_MOVE_DRIVEN][i] = way > driven ? way : driven;
    }
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
        move_coordinate(m, 0, slot, &sums);
        move_coordinate(m, 1, slot, &sums);
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

// With e = l - L0: what a spring gains is k (l1 - l0) (e0 + e1) / 2, and l1 - l0 is the difference of the squares
// over l0 + l1, which keeps its digits however small it is.
static inline void stretch_springs(const mspringi_motion *m, size_t base, size_t tip, const float *rest_lengths,
                                   const float *stiffnesses, lane_sums *sums, bool driven, bool damped) {
    const mspringi_motion_axis *const cx = &m->axes[0], *const cy = &m->axes[1];
    const float *const dampings = stiffnesses + MSPRINGI_WIDTH;
    float gain[MSPRINGI_WIDTH], energy[MSPRINGI_WIDTH], pull[MSPRINGI_WIDTH], error[MSPRINGI_WIDTH];
    float given[MSPRINGI_WIDTH];
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const size_t a = base + i, b = tip + i;
        const float x = (cx->position[b] - cx->position[a]) + (cx->low[b] - cx->low[a]);
        const float y = (cy->position[b] - cy->position[a]) + (cy->low[b] - cy->low[a]);
        const float dx = cx->step[b] - cx->step[a], dy = cy->step[b] - cy->step[a];
        const float square = x * x + y * y, added = (x + x + dx) * dx + (y + y + dy) * dy;
        const float later = (x + dx) * (x + dx) + (y + dy) * (y + dy);
        const float before = sqrtf(square), after = sqrtf(later), both = before + after;
        const float per_both = 1.0f / both, longer = both > 0.0f ? added * per_both : 0.0f;
        const float k = m->stiffness_scale * stiffnesses[i];
        const float start = before - rest_lengths[i], stretch = start + longer;
        gain[i] = k * longer * (start + 0.5f * longer);
        energy[i] = k * stretch * stretch;
        pull[i] = k * fabsf(stretch);
        error[i] = k * longer * before;
        given[i] = 0.0f;
        if (driven) {
            const float px = (m->mass[b] > 0.0f ? 0.0f : cx->step[b]) - (m->mass[a] > 0.0f ? 0.0f : cx->step[a]);
            const float py = (m->mass[b] > 0.0f ? 0.0f : cy->step[b]) - (m->mass[a] > 0.0f ? 0.0f : cy->step[a]);
            const float per_before = before > 0.0f ? 1.0f / before : 0.0f;
            const float per_after = after > 0.0f ? 1.0f / after : 0.0f;
            const float nx = x * per_before, ny = y * per_before;
            const float later_nx = (x + dx) * per_after, later_ny = (y + dy) * per_after;
            float pull_before = k * start, pull_after = k * stretch;
            if (damped) {
                const float c = m->stiffness_scale * dampings[i];
                pull_before +=
                    c * (nx * (cx->velocity[b] - cx->velocity[a]) + ny * (cy->velocity[b] - cy->velocity[a]));
                pull_after += c * (later_nx * (velocity_after(m, cx, b) - velocity_after(m, cx, a)) +
                                   later_ny * (velocity_after(m, cy, b) - velocity_after(m, cy, a)));
            }
            given[i] = larger_of(pull_before * (nx * px + ny * py), pull_after * (later_nx * px + later_ny * py));
        }
    }
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const double e = (double)error[i];
        sums->of[MSPRINGI_STRETCH_GAIN][i] += (double)gain[i];
        sums->of[MSPRINGI_STRETCH_ENERGY][i] += (double)energy[i];
        sums->of[MSPRINGI_STRETCH_PULL][i] += (double)pull[i];
        sums->of[MSPRINGI_STRETCH_ERROR][i] += e * e;
        sums->of[MSPRINGI_STRETCH_STIFFNESS][i] += (double)stiffnesses[i];
        if (driven)
            sums->of[MSPRINGI_STRETCH_GIVEN][i] += (double)given[i];
    }
}

static inline void stretch_rows(const mspringi_system *system, const mspringi_motion *m, const mspringi_span *spans,
                                uint32_t count, bool is_lattice, bool driven, bool damped, lane_sums *sums) {
    const size_t parts = system->parts - 1, part = parts * MSPRINGI_WIDTH;
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t first = span->first_slot / MSPRINGI_WIDTH;
        const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
        for (size_t block = first; block < end; ++block) {
            const size_t slot = block * MSPRINGI_WIDTH, index = span->first_record + (block - first);
            if (span->record_slots == MSPRINGI_WIDTH) {
                const float *record = system->chain_springs + index * (part + MSPRINGI_WIDTH);
                stretch_springs(m, slot, slot + 1, record, record + MSPRINGI_WIDTH, sums, driven, damped);
                continue;
            }
            const float *record = system->lattice_springs + index * MSPRINGI_DIRECTIONS * part;
            const float *rests = mspringi_system_rests(system, index);
            stretch_springs(m, slot, slot + 1, rests + MSPRINGI_EAST * MSPRINGI_WIDTH,
                            record + MSPRINGI_EAST * part, sums, driven, damped);
            if (!is_lattice)
                continue;
            const size_t up = (size_t)((int64_t)slot + span->up);
            stretch_springs(m, slot, up, rests + MSPRINGI_NORTH * MSPRINGI_WIDTH, record + MSPRINGI_NORTH * part,
                            sums, driven, damped);
            stretch_springs(m, slot, up + 1, rests + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                            record + MSPRINGI_NORTH_EAST * part, sums, driven, damped);
            stretch_springs(m, up, slot + 1, rests + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                            record + MSPRINGI_SOUTH_EAST * part, sums, driven, damped);
        }
    }
}

static void sum_stretches(const mspringi_system *system, const mspringi_motion *m, const mspringi_span *spans,
                          uint32_t count, bool is_lattice, bool driven, double *to) {
    lane_sums sums;
    clear_sums(&sums, MSPRINGI_STRETCH_SUMS);
    if (!driven)
        stretch_rows(system, m, spans, count, is_lattice, false, false, &sums);
    else if (system->parts > MSPRINGI_DAMPING)
        stretch_rows(system, m, spans, count, is_lattice, true, true, &sums);
    else
        stretch_rows(system, m, spans, count, is_lattice, true, false, &sums);
    put_sums(&sums, MSPRINGI_STRETCH_SUMS, to);
}

#endif
