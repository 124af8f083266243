/// The definition of a sweep: plain C, one slot at a time. What the other kernels compute, they compute in this
/// order.
#include "kernels.h"

#include <math.h>

typedef struct vector {
    float x, y;
} vector;

/// Position and velocity of a particle.
typedef struct motion {
    float x, y, vx, vy;
} motion;

static inline motion at(const mspringi_sweep *s, size_t slot) {
    return (motion){s->x[slot], s->y[slot], s->vx[slot], s->vy[slot]};
}

// The force of one spring on its base, towards its tip; the force on the tip is the opposite. record is the slot's
// first value in a spring record.
static inline vector spring_force(motion base, motion tip, const float *record, bool damped) {
    const float dx = tip.x - base.x, dy = tip.y - base.y;
    const float length = sqrtf(dx * dx + dy * dy);
    const float inverse = length > 0.0f ? 1.0f / length : 0.0f; // a spring of length 0 has no direction
    float force =
        (length - record[MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH]) * record[MSPRINGI_STIFFNESS * MSPRINGI_WIDTH];
    if (damped) {
        const float dvx = tip.vx - base.vx, dvy = tip.vy - base.vy;
        const float rate = (dvx * dx + dvy * dy) * inverse; // of lengthening, m/s
        force = force + rate * record[MSPRINGI_DAMPING * MSPRINGI_WIDTH];
    }
    force = force * inverse;
    return (vector){force * dx, force * dy};
}

// Symplectic Euler. A pinned particle keeps its velocity.
static inline void move(const mspringi_sweep *s, size_t slot, vector force, bool forced) {
    if (forced) {
        force.x = force.x + s->force_x[slot];
        force.y = force.y + s->force_y[slot];
    }
    const float inverse_mass = s->inverse_mass[slot];
    if (inverse_mass > 0.0f) {
        const float inverse_mass_h = inverse_mass * s->h;
        s->vx[slot] = (s->vx[slot] + (force.x * inverse_mass_h + s->gravity_h_x)) * s->decay;
        s->vy[slot] = (s->vy[slot] + (force.y * inverse_mass_h + s->gravity_h_y)) * s->decay;
    }
    s->x[slot] = s->x[slot] + s->vx[slot] * s->h;
    s->y[slot] = s->y[slot] + s->vy[slot] * s->h;
}

/// Forces that a slot's springs exert on the slot to the right and on the slot above that.
typedef struct handed_on {
    vector right, diagonal;
} handed_on;

// A slot's value in the first part of its record.
static inline const float *record_of(const float *records, const mspringi_span *span, size_t slot, uint32_t parts) {
    const size_t block = slot / MSPRINGI_WIDTH - span->first_slot / MSPRINGI_WIDTH;
    return records + (span->first_record + block) * span->record_slots * parts + slot % MSPRINGI_WIDTH;
}

static inline void lattice(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count, bool damped,
                           bool forced) {
    const size_t part = (size_t)s->parts * MSPRINGI_WIDTH; // values of one direction
    handed_on before = {{0.0f, 0.0f}, {0.0f, 0.0f}};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        for (size_t slot = span->first_slot; slot < span->end_slot; ++slot) {
            const size_t up = (size_t)((int64_t)slot + span->up), carry = (size_t)((int64_t)slot + span->carry);
            const float *record = record_of(s->lattice_springs, span, slot, s->parts);
            const motion here = at(s, slot), next = at(s, slot + 1), above = at(s, up), above_next = at(s, up + 1);
            const vector east = spring_force(here, next, record + MSPRINGI_EAST * part, damped);
            const vector north = spring_force(here, above, record + MSPRINGI_NORTH * part, damped);
            const vector north_east = spring_force(here, above_next, record + MSPRINGI_NORTH_EAST * part, damped);
            const vector south_east = spring_force(above, next, record + MSPRINGI_SOUTH_EAST * part, damped);

            const vector force = {(s->carry_x[carry] + ((east.x + north.x) + north_east.x)) - before.right.x,
                                  (s->carry_y[carry] + ((east.y + north.y) + north_east.y)) - before.right.y};
            s->carry_x[carry] = (south_east.x - north.x) - before.diagonal.x;
            s->carry_y[carry] = (south_east.y - north.y) - before.diagonal.y;
            before.right = (vector){east.x + south_east.x, east.y + south_east.y};
            before.diagonal = north_east;
            move(s, slot, force, forced);
        }
    }
}

// East springs only.
static inline void chain(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count, bool damped,
                         bool forced) {
    vector left = {0.0f, 0.0f};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const float *records = span->record_slots == MSPRINGI_WIDTH ? s->chain_springs : s->lattice_springs;
        for (size_t slot = span->first_slot; slot < span->end_slot; ++slot) {
            const size_t carry = (size_t)((int64_t)slot + span->carry);
            const float *record = record_of(records, span, slot, s->parts);
            const vector east = spring_force(at(s, slot), at(s, slot + 1), record, damped);
            const vector force = {(s->carry_x[carry] + east.x) - left.x, (s->carry_y[carry] + east.y) - left.y};
            s->carry_x[carry] = 0.0f;
            s->carry_y[carry] = 0.0f;
            left = east;
            move(s, slot, force, forced);
        }
    }
}

static inline motion node_at(const mspringi_sweep *s, size_t node) {
    const float *packed = s->packed + 4 * node;
    return (motion){packed[0], packed[1], packed[2], packed[3]};
}

// The force of the web on one of its nodes: the sum over the rungs of its group, in their order.
static inline vector web_force(const mspringi_sweep *s, size_t node, bool damped) {
    const mspringi_web *web = s->web;
    const size_t lane = node % MSPRINGI_WIDTH;
    const motion here = node_at(s, node);
    vector sum = {0.0f, 0.0f};
    for (size_t rung = web->first_rung[node / MSPRINGI_WIDTH]; rung < web->first_rung[node / MSPRINGI_WIDTH + 1];
         ++rung) {
        const motion there = node_at(s, web->neighbour[rung * MSPRINGI_WIDTH + lane]);
        const vector force =
            spring_force(here, there, s->web_springs + rung * s->parts * MSPRINGI_WIDTH + lane, damped);
        sum.x = sum.x + force.x;
        sum.y = sum.y + force.y;
    }
    return sum;
}

static inline void web(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count, bool damped,
                       bool forced) {
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t first_node = (size_t)span->first_record * MSPRINGI_WIDTH;
        for (size_t slot = span->first_slot; slot < span->end_slot; ++slot)
            move(s, slot, web_force(s, first_node + (slot - span->first_slot), damped), forced);
    }
}

static inline void attached(const mspringi_sweep *s, uint32_t first, uint32_t count, float *x, float *y,
                            bool damped) {
    for (size_t i = first; i < (size_t)first + count; ++i) {
        const vector force = web_force(s, s->web->own_count + i, damped);
        x[i] = force.x;
        y[i] = force.y;
    }
}

static void pack(const mspringi_sweep *s, size_t first_block, size_t block_count, float *packed) {
    const size_t first = first_block * MSPRINGI_WIDTH;
    for (size_t slot = first; slot < first + block_count * MSPRINGI_WIDTH; ++slot, packed += 4) {
        packed[0] = s->x[slot];
        packed[1] = s->y[slot];
        packed[2] = s->vx[slot];
        packed[3] = s->vy[slot];
    }
}

static inline void loose(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count, bool forced) {
    for (const mspringi_span *span = spans; span < spans + count; ++span)
        for (size_t slot = span->first_slot; slot < span->end_slot; ++slot)
            move(s, slot, (vector){0.0f, 0.0f}, forced);
}

static bool bounded(const float *values, size_t count, float limit) {
    bool all = true;
    for (size_t i = 0; i < count; ++i)
        all = all & (fabsf(values[i]) <= limit);
    return all;
}

#include "scalar_lane.h"

#define MSPRINGI_TABLE mspringi_kernels_scalar
#define MSPRINGI_LEVEL MSPRING_SIMD_SCALAR
#include "table.h"
