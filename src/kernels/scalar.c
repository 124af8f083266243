/// Definition of a sweep: plain C, one slot at a time. The other kernels compute the same operations in the same
/// order.
#include "kernels/kernels.h"
#include "kernels/spring_law.h"

#if !defined(MSPRINGI_WITHOUT_SCALAR)

#include <math.h>
#include <string.h>

typedef struct vector {
    float x, y;
} vector;

/// Position and velocity of a particle.
typedef struct motion {
    float x, y, vx, vy, low_x, low_y;
} motion;

static inline motion motion_at(const mspringi_sweep *s, size_t slot) {
    return (motion){s->x[slot], s->y[slot], s->vx[slot], s->vy[slot], s->low_x[slot], s->low_y[slot]};
}

// The difference of two close positions is exact, but lacks their low words. Half a unit in the last place of a
// position of 900 m is 3e-5 m, the strain of 2 kN of iron.
static inline vector vector_between(motion base, motion tip, mspringi_variant of) {
    const vector way = {base.x - tip.x, base.y - tip.y};
    if (!(of & MSPRINGI_PRECISE))
        return way;
    return (vector){way.x + (base.low_x - tip.low_x), way.y + (base.low_y - tip.low_y)};
}

static inline float flush_tiny(float a) {
    return fabsf(a) < MSPRINGI_TINY_SPEED ? 0.0f : a;
}

static inline float leading(float a) {
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    bits &= MSPRINGI_LEADING_BITS;
    memcpy(&a, &bits, sizeof bits);
    return a;
}

/// From a spring's tip to its base.
typedef struct extent {
    float dx, dy, square;
    float major, minor, low; ///< see sweep.h
} extent;

static inline extent spring_extent(motion base, motion tip, mspringi_variant of) {
    const float high_x = base.x - tip.x, high_y = base.y - tip.y;
    if (!(of & MSPRINGI_PRECISE))
        return (extent){high_x, high_y, high_x * high_x + high_y * high_y, 0.0f, 0.0f, 0.0f};
    const float low_x = base.low_x - tip.low_x, low_y = base.low_y - tip.low_y;
    const float dx = high_x + low_x, dy = high_y + low_y, lead_x = leading(dx), lead_y = leading(dy);
    const float rest_x = (high_x - lead_x) + low_x, rest_y = (high_y - lead_y) + low_y;
    const float square_x = lead_x * lead_x, square_y = lead_y * lead_y;
    const float low = rest_x * (lead_x + dx) + rest_y * (lead_y + dy);
    return (extent){dx,
                    dy,
                    (square_x + square_y) + low,
                    square_x > square_y ? square_x : square_y,
                    square_x < square_y ? square_x : square_y,
                    low};
}

// The length times the extension; see sweep.h.
static inline float stretch(extent e, float length, float rest_length, mspringi_variant of) {
    const float first = length * (length - rest_length);
    if (!(of & MSPRINGI_PRECISE))
        return first;
    const float lead = leading(length), rest = length - lead;
    return first + 0.5f * (((e.major - lead * lead) + e.minor) + (e.low - rest * (lead + length)));
}

// Force of one spring on its tip; that on its base is the opposite. With d from the tip to the base
//     F = ((L - rest_length) (k L) + c (dv . d)) / L^2 * d
// so that root and division are independent. record points to the stiffness, followed by the damping.
static inline vector spring_force(motion base, motion tip, float rest_length, const float *record,
                                  mspringi_variant of) {
    const extent e = spring_extent(base, tip, of);
    const float dx = e.dx, dy = e.dy;
    const float square = e.square, length = sqrtf(square);
    const float inverse = square > MSPRINGI_NO_DIRECTION ? 1.0f / square : 0.0f;
    float force = of & MSPRINGI_PRECISE
                      ? MSPRINGI_LAW_FORCE(MSPRINGI_TIMES, record[0], stretch(e, length, rest_length, of))
                      : MSPRINGI_LAW_FORCE(MSPRINGI_TIMES, length * record[0], length - rest_length);
    if (of & MSPRINGI_DAMPED) {
        const float dvx = base.vx - tip.vx, dvy = base.vy - tip.vy;
        force = force + MSPRINGI_LAW_DAMPING_FORCE(MSPRINGI_TIMES, record[MSPRINGI_WIDTH], dvx * dx + dvy * dy);
    }
    force = force * inverse;
    return (vector){force * dx, force * dy};
}

static inline uint32_t absolute_bits(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits & 0x7fffffffu;
}

static inline float float_of(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// The larger of a and |b|. Absolute values are compared as integers: the order is that of floats, with NaN above
// all.
static inline float larger_size(float a, float b) {
    const uint32_t size = absolute_bits(b);
    return size > absolute_bits(a) ? float_of(size) : a;
}

static inline void save_motion(const mspringi_sweep *s, size_t slot) {
    const size_t slots = (size_t)(s->y - s->x);
    s->keep[slot] = s->x[slot];
    s->keep[slot + slots] = s->y[slot];
    s->keep[slot + 2 * slots] = s->vx[slot];
    s->keep[slot + 3 * slots] = s->vy[slot];
    s->keep[slot + 4 * slots] = s->low_x[slot];
    s->keep[slot + 5 * slots] = s->low_y[slot];
    if (s->low_vx) {
        s->keep[slot + 6 * slots] = s->low_vx[slot];
        s->keep[slot + 7 * slots] = s->low_vy[slot];
    }
}

static inline void watch_motion(const mspringi_sweep *s, size_t slot) {
    mspringi_extrema_lanes *seen = s->watch;
    if (s->watches_coordinate)
        seen->coordinate[0] = larger_size(larger_size(seen->coordinate[0], s->x[slot]), s->y[slot]);
    if (s->watches_speed)
        seen->speed[0] = larger_size(larger_size(seen->speed[0], s->vx[slot]), s->vy[slot]);
    if (s->before) {
        const float *before_y = s->before + (s->y - s->x);
        const float change = larger_size(seen->change[0], s->vx[slot] - s->before[slot]);
        seen->change[0] = larger_size(change, s->vy[slot] - before_y[slot]);
    }
}

// Move by Kahan's compensated sum: the low word keeps the rounding error for the next move.
static inline void add_displacement(const mspringi_sweep *s, size_t slot, float way_x, float way_y,
                                    mspringi_variant of) {
    way_x = way_x + s->low_x[slot];
    way_y = way_y + s->low_y[slot];
    float x = s->x[slot] + way_x, y = s->y[slot] + way_y;
    if (of & MSPRINGI_PRECISE) {
        x = (x + s->grid) - s->grid;
        y = (y + s->grid) - s->grid;
    }
    s->low_x[slot] = way_x - (x - s->x[slot]);
    s->low_y[slot] = way_y - (y - s->y[slot]);
    s->x[slot] = x;
    s->y[slot] = y;
}

// Kick of a velocity: v' = v + (F kick / m + (g kick - loss v)), where the inner sum is never -0, so the sign of a
// zero force does not matter. A pinned particle keeps its velocity.
static inline float kicked(const mspringi_sweep *s, float v, float push, float gravity, mspringi_variant of) {
    const float to = v + (push + (gravity - s->loss * v));
    return mspringi_flushes(s, of) ? flush_tiny(to) : to;
}

// The same in two words.
static inline void kick_precisely(float *v, float *low, float push, float gravity, float loss, bool flushes) {
    const float change = (push + (*low + gravity)) - loss * *v, sum = *v + change;
    const float to = flushes ? flush_tiny(sum) : sum, rest = change - (to - *v);
    *low = flushes ? flush_tiny(rest) : rest;
    *v = to;
}

// Leapfrog: the velocity first, then the position.
static inline void move(const mspringi_sweep *s, size_t slot, vector force, mspringi_variant of) {
    if (of & MSPRINGI_FORCED || (of & MSPRINGI_FORCED_OR_NOT && s->force_x)) {
        force.x = force.x + s->force_x[slot];
        force.y = force.y + s->force_y[slot];
    }
    if (s->keep)
        save_motion(s, slot);
    const float inverse_mass = s->inverse_mass[slot], change = inverse_mass * s->kick;
    if (of & MSPRINGI_PRECISE && inverse_mass > 0.0f) {
        kick_precisely(&s->vx[slot], &s->low_vx[slot], force.x * change, s->gravity_h_x, s->loss, s->flushes);
        kick_precisely(&s->vy[slot], &s->low_vy[slot], force.y * change, s->gravity_h_y, s->loss, s->flushes);
    } else if (of & MSPRINGI_PRECISE) {
        s->low_vx[slot] = s->low_vy[slot] = 0.0f;
    } else if (inverse_mass > 0.0f) {
        s->vx[slot] = kicked(s, s->vx[slot], force.x * change, s->gravity_h_x, of);
        s->vy[slot] = kicked(s, s->vy[slot], force.y * change, s->gravity_h_y, of);
    }
    add_displacement(s, slot, s->vx[slot] * s->h, s->vy[slot] * s->h, of);
    if (s->watch)
        watch_motion(s, slot);
}

/// Forces that a slot's springs carry to the slot on the right and to the slot above that.
typedef struct carried_forces {
    vector right, diagonal;
} carried_forces;

// Springs of a slot in lattice records.
typedef struct lattice_springs {
    const float *rest_lengths; ///< [direction][lane], from the slot's lane on
    const float *records;      ///< [direction][part after the rest length][lane]
} lattice_springs;

static inline size_t record_of(const mspringi_span *span, size_t slot) {
    return span->first_record + (slot / MSPRINGI_WIDTH - span->first_slot / MSPRINGI_WIDTH);
}

static inline size_t lattice_slot(const mspringi_span *span, size_t slot) {
    return record_of(span, slot) * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH + slot % MSPRINGI_WIDTH;
}

static inline lattice_springs springs_of(const mspringi_sweep *s, const mspringi_span *span, size_t slot) {
    const size_t block = record_of(span, slot);
    const size_t values = (size_t)MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH, lane = slot % MSPRINGI_WIDTH;
    return (lattice_springs){s->rest_lengths + s->rests_of_block[block] * values + lane,
                             s->lattice_springs + s->springs_of_block[block] * values * (s->parts - 1) + lane};
}

static inline mspringi_yield_values yield_values(const mspringi_yield_test *t, size_t spring_slot) {
    return (mspringi_yield_values){t->nominal[spring_slot], t->yield_strain[spring_slot], t->hardening[spring_slot],
                                   t->plastic_limit[spring_slot], t->gain[spring_slot]};
}

// Test a warm spring, and update it if it flows. A broken one has no stiffness.
static void yield_spring(const mspringi_yield_test *t, size_t spring_slot, float square, float start, float *rest,
                         float stiffness) {
    const mspringi_yield_bounds bounds = {t->low[spring_slot], t->high[spring_slot], t->flow_low[spring_slot],
                                          t->flow_high[spring_slot]};
    const uint32_t lane = spring_slot % MSPRINGI_WIDTH, bit = 1u << lane;
    const float length = sqrtf(square);
    if (square > bounds.high || bounds.low > square)
        mspringi_yield_mark_warm(t, spring_slot / MSPRINGI_WIDTH, bit);
    if (!t->maps || !(stiffness > 0.0f) || !(mspringi_yield_warm(t, spring_slot / MSPRINGI_WIDTH) & bit))
        return;
    const mspringi_yield_values values = yield_values(t, spring_slot);
    const float to = mspringi_yield_rest(values, bounds, square, length, *rest);
    if (!(to > *rest || *rest > to))
        return;
    mspringi_yield_save(t, spring_slot / MSPRINGI_WIDTH, bit, rest - lane);
    t->heat[spring_slot] = t->heat[spring_slot] + mspringi_yield_heat(values, stiffness, start, length, *rest, to);
    *rest = to;
    const mspringi_yield_bounds renewed = mspringi_yield_bounds_of(values, to);
    t->low[spring_slot] = renewed.low;
    t->high[spring_slot] = renewed.high;
    t->flow_low[spring_slot] = renewed.flow_low;
    t->flow_high[spring_slot] = renewed.flow_high;
}

// Test a spring before its rest length enters the force.
static inline void test_spring(const mspringi_sweep *s, size_t spring_slot, motion base, motion tip, float *rest,
                               float stiffness, mspringi_variant of) {
    const mspringi_yield_test *t = s->test;
    const float square = spring_extent(base, tip, of).square;
    if (!(square > t->test_high[spring_slot] || t->test_low[spring_slot] > square))
        return;
    const float way_x = s->h * (base.vx - tip.vx), way_y = s->h * (base.vy - tip.vy);
    yield_spring(t, spring_slot, square, mspringi_yield_start(square, base.x - tip.x, base.y - tip.y, way_x, way_y),
                 rest, stiffness);
}

static inline void test_in_lattice(const mspringi_sweep *s, const mspringi_span *span, size_t slot,
                                   mspringi_direction direction, motion base, motion tip, mspringi_variant of) {
    const size_t spring_slot = lattice_slot(span, slot) + (size_t)direction * MSPRINGI_WIDTH;
    const float *records = springs_of(s, span, slot).records;
    test_spring(s, spring_slot, base, tip, s->test->lattice_rests + spring_slot,
                records[direction * (s->parts - 1) * MSPRINGI_WIDTH], of);
}

static inline vector lattice_force(motion base, motion tip, lattice_springs springs, mspringi_direction direction,
                                   mspringi_variant of) {
    const size_t parts = of & MSPRINGI_DAMPED ? 2 : 1;
    return spring_force(base, tip, springs.rest_lengths[direction * MSPRINGI_WIDTH],
                        springs.records + direction * parts * MSPRINGI_WIDTH, of);
}

// Add the force of the slot's cell area to those of its diagonals: with D and D' the diagonals from tips to bases,
// f = f0 - f1 D x D' along the normals. See features/areas/areas.h.
static inline void add_area_force(const mspringi_sweep *s, const mspringi_span *span, size_t slot,
                                  vector to_north_east, vector to_south_east, vector *north_east,
                                  vector *south_east) {
    const size_t block = span->first_record + (slot / MSPRINGI_WIDTH - span->first_slot / MSPRINGI_WIDTH);
    const float *cells = s->cells + 2 * block * MSPRINGI_WIDTH + slot % MSPRINGI_WIDTH;
    const float cross = to_north_east.x * to_south_east.y - to_north_east.y * to_south_east.x;
    const float force = cells[0] - cells[MSPRINGI_WIDTH] * cross;
    north_east->x = north_east->x - force * to_south_east.y;
    north_east->y = north_east->y + force * to_south_east.x;
    south_east->x = south_east->x + force * to_north_east.y;
    south_east->y = south_east->y - force * to_north_east.x;
}

static inline void lattice(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count,
                           mspringi_variant of) {
    carried_forces before = {{0.0f, 0.0f}, {0.0f, 0.0f}};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        for (size_t slot = span->first_slot; slot < span->end_slot; ++slot) {
            const size_t up = (size_t)((int64_t)slot + span->up), carry = (size_t)((int64_t)slot + span->carry);
            const motion here = motion_at(s, slot), next = motion_at(s, slot + 1), above = motion_at(s, up),
                         above_next = motion_at(s, up + 1);
            if (of & MSPRINGI_TESTED) {
                test_in_lattice(s, span, slot, MSPRINGI_EAST, here, next, of);
                test_in_lattice(s, span, slot, MSPRINGI_NORTH, here, above, of);
                test_in_lattice(s, span, slot, MSPRINGI_NORTH_EAST, here, above_next, of);
                test_in_lattice(s, span, slot, MSPRINGI_SOUTH_EAST, next, above, of);
            }
            const lattice_springs springs = springs_of(s, span, slot); // after the tests, which may change it
            const vector east = lattice_force(here, next, springs, MSPRINGI_EAST, of);
            const vector north = lattice_force(here, above, springs, MSPRINGI_NORTH, of);
            vector north_east = lattice_force(here, above_next, springs, MSPRINGI_NORTH_EAST, of);
            vector south_east = lattice_force(next, above, springs, MSPRINGI_SOUTH_EAST, of);
            if (of & MSPRINGI_CELLS)
                add_area_force(s, span, slot, vector_between(here, above_next, of), vector_between(next, above, of),
                               &north_east, &south_east);

            const vector force = {((s->carry_x[carry] + before.right.x) - (east.x + north.x)) - north_east.x,
                                  ((s->carry_y[carry] + before.right.y) - (east.y + north.y)) - north_east.y};
            s->carry_x[carry] = (south_east.x + north.x) + before.diagonal.x;
            s->carry_y[carry] = (south_east.y + north.y) + before.diagonal.y;
            before.right = (vector){east.x - south_east.x, east.y - south_east.y};
            before.diagonal = north_east;
            move(s, slot, force, of);
        }
    }
}

// Force of the east spring of a slot in a chain, or in a lattice row with nothing above.
static inline vector chain_force(const mspringi_sweep *s, const mspringi_span *span, size_t slot,
                                 mspringi_variant of) {
    const motion here = motion_at(s, slot), next = motion_at(s, slot + 1);
    if (span->record_slots != MSPRINGI_WIDTH) {
        if (of & MSPRINGI_TESTED)
            test_in_lattice(s, span, slot, MSPRINGI_EAST, here, next, of);
        return lattice_force(here, next, springs_of(s, span, slot), MSPRINGI_EAST, of);
    }
    const size_t block = record_of(span, slot), lane = slot % MSPRINGI_WIDTH;
    const size_t at_record = block * s->parts * MSPRINGI_WIDTH + lane;
    const float *record = s->chain_springs + at_record;
    if (of & MSPRINGI_TESTED)
        test_spring(s, s->test->first_chain_slot + block * MSPRINGI_WIDTH + lane, here, next,
                    s->test->chain_springs + at_record, record[MSPRINGI_STIFFNESS * MSPRINGI_WIDTH], of);
    return spring_force(here, next, record[MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH],
                        record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH, of);
}

// Rows of east springs only.
MSPRINGI_INLINE void sweep_chain(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count,
                                 mspringi_variant of) {
    vector left = {0.0f, 0.0f};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        for (size_t slot = span->first_slot; slot < span->end_slot; ++slot) {
            const size_t carry = (size_t)((int64_t)slot + span->carry);
            const vector east = chain_force(s, span, slot, of);
            const vector force = {(s->carry_x[carry] - east.x) + left.x, (s->carry_y[carry] - east.y) + left.y};
            s->carry_x[carry] = 0.0f;
            s->carry_y[carry] = 0.0f;
            left = east;
            move(s, slot, force, of);
        }
    }
}

static inline motion node_at(const mspringi_sweep *s, size_t node, mspringi_variant of) {
    const float *gathered = s->gathered + 4 * node, *half = gathered;
    if (!(of & MSPRINGI_PRECISE))
        return (motion){gathered[0], gathered[1], gathered[2], gathered[3], 0.0f, 0.0f};
    if (of & MSPRINGI_DAMPED)
        half += mspringi_gathered_half(s->irregular);
    return (motion){gathered[0], gathered[1], half[0], half[1], gathered[2], gathered[3]};
}

// Force of the irregular part on one of its nodes: the sum over the slice columns of its slice, in order, from
// `slice_columns` on.
static inline vector irregular_force(const mspringi_sweep *s, size_t node, motion here, uint32_t slice_columns,
                                     mspringi_variant of) {
    const mspringi_sell *irregular = s->irregular;
    const size_t lane = node % MSPRINGI_WIDTH;
    const uint32_t end = mspringi_sell_end_column(irregular, node / MSPRINGI_WIDTH, lane, 1);
    vector sum = {0.0f, 0.0f};
    for (size_t slice_column = irregular->first_slice_column[node / MSPRINGI_WIDTH] + slice_columns;
         slice_column < end; ++slice_column) {
        const motion there = node_at(s, irregular->neighbour[slice_column * MSPRINGI_WIDTH + lane], of);
        const float *record = s->irregular_springs + slice_column * s->parts * MSPRINGI_WIDTH + lane;
        const vector force = spring_force(there, here, record[MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH],
                                          record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH, of);
        sum.x = sum.x + force.x;
        sum.y = sum.y + force.y;
    }
    return sum;
}

// Force of the first slice column of a node's slice, if it is upright: its springs lead to the same lane of the
// next slice.
static inline vector upright_force(const mspringi_sweep *s, size_t slot, size_t node, mspringi_variant of) {
    const float *record =
        s->irregular_springs +
        (size_t)s->irregular->first_slice_column[node / MSPRINGI_WIDTH] * s->parts * MSPRINGI_WIDTH +
        node % MSPRINGI_WIDTH;
    return spring_force(motion_at(s, slot + MSPRINGI_WIDTH), motion_at(s, slot),
                        record[MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH], record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH,
                        of);
}

MSPRINGI_INLINE void sweep_irregular(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count,
                                     mspringi_variant of) {
    const uint8_t *is_upright = s->irregular->is_interleaved;
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        vector carried[MSPRINGI_WIDTH] = {{0.0f, 0.0f}}; // from the slice before
        size_t node = (size_t)span->first_record * MSPRINGI_WIDTH;
        for (size_t slot = span->first_slot; slot < span->end_slot; ++slot, ++node) {
            const bool has_upright = is_upright && is_upright[node / MSPRINGI_WIDTH];
            vector *below = &carried[slot % MSPRINGI_WIDTH];
            vector force = irregular_force(s, node, motion_at(s, slot), has_upright, of);
            force = (vector){force.x + below->x, force.y + below->y};
            *below = (vector){0.0f, 0.0f};
            if (has_upright) {
                const vector up = upright_force(s, slot, node, of);
                force = (vector){force.x + up.x, force.y + up.y};
                *below = (vector){0.0f - up.x, 0.0f - up.y};
            }
            move(s, slot, force, of);
        }
    }
}

// Compute the force of a spring from a bundle's slice to one below, at both ends.
MSPRINGI_INLINE void pull_bundle(const mspringi_sweep *s, size_t slot, const mspringi_bundle_link *link,
                                 size_t first_slice_column, mspringi_variant of) {
    const float *record =
        s->irregular_springs + (size_t)link->slice_column * s->parts * MSPRINGI_WIDTH + slot % MSPRINGI_WIDTH;
    const vector pull = spring_force(motion_at(s, slot + link->below), motion_at(s, slot),
                                     record[MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH],
                                     record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH, of);
    s->carry_x[link->slice_column - first_slice_column] = pull.x;
    s->carry_y[link->slice_column - first_slice_column] = pull.y;
    s->carry_x[link->back - first_slice_column] = 0.0f - pull.x;
    s->carry_y[link->back - first_slice_column] = 0.0f - pull.y;
}

// The forces of irregular(), each computed once and summed in the same order. The carry row holds them by slice
// column.
MSPRINGI_INLINE void sweep_bundle(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count,
                                  mspringi_variant of) {
    const mspringi_sell *irregular = s->irregular;
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t slices = (span->end_slot - span->first_slot) / MSPRINGI_WIDTH;
        const size_t first_slice_column = irregular->first_slice_column[span->first_record];
        for (size_t i = 0; i < slices * MSPRINGI_WIDTH; ++i) { // lane after lane
            const size_t slice = span->first_record + i % slices;
            const size_t slot = span->first_slot + i % slices * MSPRINGI_WIDTH + i / slices;
            const uint32_t *first_link = irregular->first_link + (slice - irregular->first_bundle);
            for (uint32_t link = first_link[0]; link < first_link[1]; ++link)
                pull_bundle(s, slot, &irregular->links[link], first_slice_column, of);
            vector force = {0.0f, 0.0f};
            for (size_t slice_column = irregular->first_slice_column[slice];
                 slice_column < irregular->first_slice_column[slice + 1]; ++slice_column) {
                force.x = force.x + s->carry_x[slice_column - first_slice_column];
                force.y = force.y + s->carry_y[slice_column - first_slice_column];
            }
            move(s, slot, force, of);
        }
    }
}

// All variants of each of these share two copies, one of them precise. gcc would make a copy for each variant, 12
// kB for the three, and no longer inline others.
#if defined(__GNUC__) && !defined(__clang__)
#define SHARED static __attribute__((noinline, noclone))
#else
#define SHARED static
#endif
#define BUT_PRECISE(of) ((of) & ~(mspringi_variant)MSPRINGI_PRECISE)

SHARED void chain(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count, mspringi_variant of) {
    if (of & MSPRINGI_PRECISE)
        sweep_chain(s, spans, count, of | MSPRINGI_PRECISE);
    else
        sweep_chain(s, spans, count, BUT_PRECISE(of));
}

SHARED void irregular(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count, mspringi_variant of) {
    if (of & MSPRINGI_PRECISE)
        sweep_irregular(s, spans, count, of | MSPRINGI_PRECISE);
    else
        sweep_irregular(s, spans, count, BUT_PRECISE(of));
}

SHARED void bundle(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count, mspringi_variant of) {
    if (of & MSPRINGI_PRECISE)
        sweep_bundle(s, spans, count, of | MSPRINGI_PRECISE);
    else
        sweep_bundle(s, spans, count, BUT_PRECISE(of));
}

static inline void attached(const mspringi_sweep *s, uint32_t first, uint32_t count, float *x, float *y,
                            mspringi_variant of) {
    for (size_t i = first; i < (size_t)first + count; ++i) {
        const vector force =
            irregular_force(s, s->irregular->own_count + i, node_at(s, s->irregular->own_count + i, of), 0, of);
        x[i] = force.x;
        y[i] = force.y;
    }
}

static void pack(const mspringi_sweep *s, size_t first_block, size_t block_count, float *gathered) {
    const size_t first = first_block * MSPRINGI_WIDTH;
    for (size_t slot = first; slot < first + block_count * MSPRINGI_WIDTH; ++slot, gathered += 4) {
        gathered[0] = s->x[slot];
        gathered[1] = s->y[slot];
        gathered[2] = s->vx[slot];
        gathered[3] = s->vy[slot];
    }
}

// Several substeps at once: see mspringi_free_motion.
static inline void loose(const mspringi_sweep *s, const mspringi_span *span, const mspringi_free_motion *glide,
                         bool forced) {
    for (size_t slot = span->first_slot; slot < span->end_slot; ++slot) {
        const float inverse_mass = s->inverse_mass[slot], vx = s->vx[slot], vy = s->vy[slot];
        const bool is_free = inverse_mass > 0.0f;
        float push_x = 0.0f, push_y = 0.0f;
        float way_x = glide->gravity_way_x, way_y = glide->gravity_way_y;
        if (forced) {
            const float ax = s->force_x[slot] * inverse_mass, ay = s->force_y[slot] * inverse_mass;
            push_x = ax * glide->gain;
            push_y = ay * glide->gain;
            way_x = ax * glide->fall + way_x;
            way_y = ay * glide->fall + way_y;
        }
        add_displacement(s, slot, is_free ? vx * glide->reach + way_x : vx * glide->drift,
                         is_free ? vy * glide->reach + way_y : vy * glide->drift, s->low_vx ? MSPRINGI_PRECISE : 0);
        if (s->low_vx && is_free) {
            kick_precisely(&s->vx[slot], &s->low_vx[slot], push_x, glide->gravity_x, glide->loss, false);
            kick_precisely(&s->vy[slot], &s->low_vy[slot], push_y, glide->gravity_y, glide->loss, false);
        } else if (s->low_vx) {
            s->low_vx[slot] = s->low_vy[slot] = 0.0f;
        } else if (is_free) {
            s->vx[slot] = vx * glide->keep + (forced ? push_x + glide->gravity_x : glide->gravity_x);
            s->vy[slot] = vy * glide->keep + (forced ? push_y + glide->gravity_y : glide->gravity_y);
        }
    }
}

#include "kernels/scalar_lane.h"

#define MSPRINGI_TABLE mspringi_kernels_scalar
#define MSPRINGI_LEVEL MSPRING_SIMD_SCALAR
#include "kernels/kernel_table.h"

#endif
