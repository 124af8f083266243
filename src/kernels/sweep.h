/// @file sweep.h
/// The sweeps of scalar.c in vectors of LANES slots. Each instruction set's file defines the type vec, LANES and
/// the operations used below, as static functions, and includes this file.
///
/// A sweep takes one row at a time: the forces of four springs per slot, then the motion. It stores one row of
/// forces, the carry row, for the row above. Neighbours are loaded at slot and slot + 1, so there are no gathers.
/// Forces on slot + 1 are carried by a shift across registers.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SWEEP_H
#define MSPRINGI_SWEEP_H

#include "base/cpu.h"
#include "kernels/spring_law.h"

/// inverse_or_zero(), without the divider where a level has such a thing.
#ifndef MSPRINGI_UNDIVIDED_INVERSE
#define MSPRINGI_UNDIVIDED_INVERSE inverse_or_zero
#endif

typedef struct vector {
    vec x, y;
} vector;

/// Position and velocity of LANES particles; a variant loads only the members that it reads.
typedef struct motion {
    vec x, y, vx, vy, low_x, low_y;
} motion;

MSPRINGI_INLINE motion load_motion(const mspringi_sweep *s, size_t slot, mspringi_variant of) {
    motion m = {load(s->x + slot), load(s->y + slot), zero(), zero(), zero(), zero()};
    if (of & MSPRINGI_DAMPED) {
        m.vx = load(s->vx + slot);
        m.vy = load(s->vy + slot);
    }
    if (of & MSPRINGI_PRECISE) {
        m.low_x = load(s->low_x + slot);
        m.low_y = load(s->low_y + slot);
    }
    return m;
}

// Load from a slot that is no multiple of LANES.
MSPRINGI_INLINE motion load_motion_unaligned(const mspringi_sweep *s, size_t slot, mspringi_variant of) {
    motion m = {load_unaligned(s->x + slot), load_unaligned(s->y + slot), zero(), zero(), zero(), zero()};
    if (of & MSPRINGI_DAMPED) {
        m.vx = load_unaligned(s->vx + slot);
        m.vy = load_unaligned(s->vy + slot);
    }
    if (of & MSPRINGI_PRECISE) {
        m.low_x = load_unaligned(s->low_x + slot);
        m.low_y = load_unaligned(s->low_y + slot);
    }
    return m;
}

/// Extent of LANES springs, from tip to base. This order makes a tip that is used once an operand in memory: 3 %
/// less time with AVX2 and AVX-512; gcc's SSE2 copies a base first, which takes 3 % more.
typedef struct extent {
    vec dx, dy, square;
    vec major, minor,
        low; ///< of precise kernels: squares of the leading halves of dx and dy, and the rest of square
} extent;

MSPRINGI_INLINE extent spring_extent(motion base, motion tip, mspringi_variant of) {
    extent e;
    e.dx = sub(base.x, tip.x);
    e.dy = sub(base.y, tip.y);
    if (!(of & MSPRINGI_PRECISE)) {
        e.square = add(mul(e.dx, e.dx), mul(e.dy, e.dy));
        return e;
    }
    const vec high_x = e.dx, high_y = e.dy, low_x = sub(base.low_x, tip.low_x), low_y = sub(base.low_y, tip.low_y);
    e.dx = add(high_x, low_x);
    e.dy = add(high_y, low_y);
    const vec lead_x = leading(e.dx), lead_y = leading(e.dy);
    const vec rest_x = add(sub(high_x, lead_x), low_x), rest_y = add(sub(high_y, lead_y), low_y);
    const vec square_x = mul(lead_x, lead_x), square_y = mul(lead_y, lead_y);
    e.low = add(mul(rest_x, add(lead_x, e.dx)), mul(rest_y, add(lead_y, e.dy)));
    e.major = maximum(square_x, square_y);
    e.minor = minimum(square_x, square_y);
    e.square = add(add(square_x, square_y), e.low);
    return e;
}

// The length L times the extension. In precise kernels
//     L (L - rest_length) + (d^2 - L^2) / 2,
// where the second term makes up for the rounding of the root: squares of leading halves and the difference of the
// two largest are exact, and the other terms are small.
MSPRINGI_INLINE vec stretch(vec length, vec rest_length, vec major, vec minor, vec low, mspringi_variant of) {
    const vec first = mul(length, sub(length, rest_length));
    if (!(of & MSPRINGI_PRECISE))
        return first;
    const vec lead = leading(length), rest = sub(length, lead);
    const vec error = add(add(sub(major, mul(lead, lead)), minor), sub(low, mul(rest, add(lead, length))));
    return add(first, mul(set(0.5f), error));
}

// Forces of springs on their tips, from the inverses of their squared lengths; those on the bases are opposite.
// record points to the stiffness, followed by the damping. Root and division are independent, the last spring
// enters the sum last, and motion without forces comes first. With SSE2, AVX2 and AVX-512 that takes 0.90, 0.90 and
// 0.92 of the time of a damped lattice, and 0.93, 0.98 and 0.97 without dampers.
MSPRINGI_INLINE vector spring_force(extent e, vec inverse, motion base, motion tip, const float *rest_lengths,
                                    const float *record, mspringi_variant of) {
    const vec length = square_root(e.square);
    vec force = of & MSPRINGI_PRECISE
                    ? MSPRINGI_LAW_FORCE(mul, load(record),
                                         stretch(length, load(rest_lengths), e.major, e.minor, e.low, of))
                    : MSPRINGI_LAW_FORCE(mul, mul(length, load(record)), sub(length, load(rest_lengths)));
    if (of & MSPRINGI_DAMPED) {
        const vec dvx = sub(base.vx, tip.vx), dvy = sub(base.vy, tip.vy);
        const vec rate = add(mul(dvx, e.dx), mul(dvy, e.dy));
        force = add(force, MSPRINGI_LAW_DAMPING_FORCE(mul, load(record + MSPRINGI_WIDTH), rate));
    }
    force = mul(force, inverse);
    const vector result = {mul(force, e.dx), mul(force, e.dy)};
    return result;
}

// Add the forces of cell areas, along pairs of particles that diagonals connect: see features/areas/areas.h.
MSPRINGI_INLINE void add_area_force(const float *cells, extent to_north_east, extent to_south_east,
                                    vector *north_east, vector *south_east) {
    const vec cross = sub(mul(to_north_east.dx, to_south_east.dy), mul(to_north_east.dy, to_south_east.dx));
    const vec force = sub(load(cells), mul(load(cells + MSPRINGI_WIDTH), cross));
    north_east->x = sub(north_east->x, mul(force, to_south_east.dy));
    north_east->y = add(north_east->y, mul(force, to_south_east.dx));
    south_east->x = add(south_east->x, mul(force, to_north_east.dy));
    south_east->y = sub(south_east->y, mul(force, to_north_east.dx));
}

#include "kernels/yield_sweep.h"

// Save the state before the first substep of a whole step, and take maxima after the last. Half of that hides
// behind the divisions; a pass of its own does not. 96 x 96 with AVX-512, one substep: 2.2 instead of 3.7 us beside
// 12.4 for the rest; 1.4 without coordinates. Changes of velocity instead of speeds: 0.2 us more; both: 1.9 us
// more; changes in a pass of their own: 1.5 to 2.
MSPRINGI_INLINE void save_motion(const mspringi_sweep *s, size_t slot, vec x, vec y, vec vx, vec vy) {
    const size_t slots = (size_t)(s->y - s->x);
    float *to = s->keep + slot;
    store(to, x);
    store(to + slots, y);
    store(to + 2 * slots, vx);
    store(to + 3 * slots, vy);
    store(to + 4 * slots, load(s->low_x + slot));
    store(to + 5 * slots, load(s->low_y + slot));
    if (s->low_vx) {
        store(to + 6 * slots, load(s->low_vx + slot));
        store(to + 7 * slots, load(s->low_vy + slot));
    }
}

// found: velocities before the substep. In the first of the step nothing is loaded again.
MSPRINGI_INLINE void watch_motion(const mspringi_sweep *s, size_t slot, motion made, vector found) {
    mspringi_extrema_lanes *seen = s->watch;
    if (s->watches_coordinate)
        store(seen->coordinate, larger_size(larger_size(load(seen->coordinate), made.x), made.y));
    if (s->watches_speed)
        store(seen->speed, larger_size(larger_size(load(seen->speed), made.vx), made.vy));
    if (s->before) {
        if (!s->keep) {
            found.x = load(s->before + slot);
            found.y = load(s->before + (s->y - s->x) + slot);
        }
        const vec dvx = sub(made.vx, found.x), dvy = sub(made.vy, found.y);
        store(seen->change, larger_size(larger_size(load(seen->change), dvx), dvy));
    }
}

// Move by Kahan's compensated sum: the low word keeps the rounding error for the next move.
MSPRINGI_INLINE vector add_displacement(const mspringi_sweep *s, size_t slot, motion here, vec way_x, vec way_y,
                                        mspringi_variant of) {
    way_x = add(way_x, of & MSPRINGI_PRECISE ? here.low_x : load(s->low_x + slot));
    way_y = add(way_y, of & MSPRINGI_PRECISE ? here.low_y : load(s->low_y + slot));
    vector to = {add(here.x, way_x), add(here.y, way_y)};
    if (of & MSPRINGI_PRECISE) { // differences of coordinates on a grid are exact, next to 0 too
        to.x = sub(add(to.x, set(s->grid)), set(s->grid));
        to.y = sub(add(to.y, set(s->grid)), set(s->grid));
    }
    store(s->low_x + slot, sub(way_x, sub(to.x, here.x)));
    store(s->low_y + slot, sub(way_y, sub(to.y, here.y)));
    store(s->x + slot, to.x);
    store(s->y + slot, to.y);
    return to;
}

// Kick of velocities: v' = v + (F kick / m + (g kick - loss v)), where the inner sum is never -0, so the sign of a
// zero force does not matter. A pinned particle keeps its velocity.
MSPRINGI_INLINE vec kicked(const mspringi_sweep *s, vec v, vec push, vec gravity, vec inverse_mass,
                           mspringi_variant of) {
    const vec to = add(v, add(push, sub(gravity, mul(set(s->loss), v))));
    return choose_positive(inverse_mass, mspringi_flushes(s, of) ? flush_tiny(to) : to, v);
}

// The same in two words: low becomes the low word of the result.
MSPRINGI_INLINE vec kicked_precisely(vec v, vec *low, vec push, vec gravity, float loss, bool flushes,
                                     vec inverse_mass) {
    const vec change = sub(add(push, add(*low, gravity)), mul(set(loss), v)), sum = add(v, change);
    const vec to = choose_positive(inverse_mass, flushes ? flush_tiny(sum) : sum, v);
    const vec rest = choose_positive(inverse_mass, sub(change, sub(to, v)), zero());
    *low = flushes ? flush_tiny(rest) : rest;
    return to;
}

// Leapfrog: the velocities first, then the positions.
MSPRINGI_INLINE void move(const mspringi_sweep *s, size_t slot, motion here, vector force, mspringi_variant of) {
    if (of & MSPRINGI_FORCED || (of & MSPRINGI_FORCED_OR_NOT && s->force_x)) {
        force.x = add(force.x, load(s->force_x + slot));
        force.y = add(force.y, load(s->force_y + slot));
    }
    const vec h = set(s->h), gravity_x = set(s->gravity_h_x), gravity_y = set(s->gravity_h_y);
    const vec inverse_mass = load(s->inverse_mass + slot);
    const vec change = mul(inverse_mass, set(s->kick));
    // Without dampers, velocities are not loaded yet.
    vec vx = of & MSPRINGI_DAMPED ? here.vx : load(s->vx + slot),
        vy = of & MSPRINGI_DAMPED ? here.vy : load(s->vy + slot);
    const vector found = {vx, vy};
    if (s->keep)
        save_motion(s, slot, here.x, here.y, vx, vy);
    if (of & MSPRINGI_PRECISE) {
        vec low_vx = load(s->low_vx + slot), low_vy = load(s->low_vy + slot);
        vx = kicked_precisely(vx, &low_vx, mul(force.x, change), gravity_x, s->loss, s->flushes, inverse_mass);
        vy = kicked_precisely(vy, &low_vy, mul(force.y, change), gravity_y, s->loss, s->flushes, inverse_mass);
        store(s->low_vx + slot, low_vx);
        store(s->low_vy + slot, low_vy);
    } else {
        vx = kicked(s, vx, mul(force.x, change), gravity_x, inverse_mass, of);
        vy = kicked(s, vy, mul(force.y, change), gravity_y, inverse_mass, of);
    }
    store(s->vx + slot, vx);
    store(s->vy + slot, vy);
    const vector to = add_displacement(s, slot, here, mul(vx, h), mul(vy, h), of);
    if (s->watch)
        watch_motion(s, slot, (motion){.x = to.x, .y = to.y, .vx = vx, .vy = vy}, found);
}

/// Forces that LANES slots' springs carry to the slots on the right and to those above them. Of the previous slots,
/// only the last lane is used.
typedef struct carried_forces {
    vector right, diagonal;
} carried_forces;

// The inverse for three of a turn's four springs; the divider is busy with roots and the fourth. Without dampers
// that takes 0.91 to 0.98 of a lattice's time (Emerald Rapids, AVX-512). With dampers steps would take 0.96
// to 1.03, in precise kernels 1.00, and in irregular parts 1.01 to 1.08 (Redwood Cove): other units are full there.
MSPRINGI_INLINE vec lattice_inverse(vec square, mspringi_variant of) {
    return of & (MSPRINGI_DAMPED | MSPRINGI_PRECISE) ? inverse_or_zero(square) : MSPRINGI_UNDIVIDED_INVERSE(square);
}

// First slot of a span and its end, in units of LANES.
MSPRINGI_INLINE size_t first_of(const mspringi_span *span) {
    return span->first_slot / LANES * LANES;
}

MSPRINGI_INLINE size_t end_of(const mspringi_span *span) {
    return (size_t)(span->end_slot + LANES - 1) / LANES * LANES;
}

// The limit of this loop is the processor's reorder window: some 130 dependent operations, fewer than an iteration
// has. So there are three measures:
//   - loops are nested, so that constants of spans and blocks stay in registers;
//   - roots and divisions of three directions precede all forces, and the fourth's come between forces;
//   - if a block is several vectors, its particles move after all forces of the block, and wait for no spring.
// An iteration is four springs of LANES slots. Time on Zen 4 with SSE2, AVX2 and AVX-512, relative to this: all
// roots and divisions first 1.07, 1.03, 1.01; one direction after another 1.07, 1.07, 1.05; each vector moved
// immediately 1.13, 1.12 with SSE2 and AVX2; moved later 1.05 with AVX-512.
MSPRINGI_INLINE void lattice(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count,
                             mspringi_variant of) {
    const mspringi_sweep copy = *sweep, *const s = &copy; // a local copy, which no store can alias
    const size_t part = (size_t)(of & MSPRINGI_DAMPED ? 2 : 1) * MSPRINGI_WIDTH; // values of one direction
    carried_forces before = {{zero(), zero()}, {zero(), zero()}};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t end_slot = end_of(span);
        size_t block = span->first_record;
        for (size_t slot = first_of(span); slot < end_slot; ++block) {
            const size_t first = slot, block_end = (slot / MSPRINGI_WIDTH + 1) * MSPRINGI_WIDTH;
            const size_t end = block_end < end_slot ? block_end : end_slot;
            const float *springs = s->lattice_springs +
                                   (size_t)s->springs_of_block[block] * MSPRINGI_DIRECTIONS * part +
                                   slot % MSPRINGI_WIDTH;
            const float *rests = s->rest_lengths +
                                 (size_t)s->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH +
                                 slot % MSPRINGI_WIDTH;
            const float *low = of & MSPRINGI_TESTED ? s->test->test_low + (rests - s->rest_lengths) : NULL;
            const float *high = of & MSPRINGI_TESTED ? s->test->test_high + (rests - s->rest_lengths) : NULL;
            vector forces[MSPRINGI_WIDTH / LANES];
            do {
                const size_t up = (size_t)((int64_t)slot + span->up);
                const size_t carry = (size_t)((int64_t)slot + span->carry);
                const motion here = load_motion(s, slot, of);
                const motion next = load_motion_unaligned(s, slot + 1, of);
                const motion above = load_motion(s, up, of);
                const motion above_next = load_motion_unaligned(s, up + 1, of);
                const extent to_east = spring_extent(here, next, of);
                const extent to_south_east = spring_extent(next, above, of); // tip first: the opposite direction
                const extent to_north = spring_extent(here, above, of);
                const vec per_east = inverse_or_zero(to_east.square);
                const vec per_south_east = lattice_inverse(to_south_east.square, of);
                const vec per_north = lattice_inverse(to_north.square, of);
                const extent to_north_east = spring_extent(here, above_next, of);
                if (of & MSPRINGI_TESTED && any_in_lattice(low, high, to_east.square, to_north.square,
                                                           to_north_east.square, to_south_east.square)) {
                    const vec squares[] = {to_east.square, to_north.square, to_north_east.square,
                                           to_south_east.square};
                    const size_t spring_slot = block * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH + slot % MSPRINGI_WIDTH;
                    yield_springs(sweep, spring_slot, MSPRINGI_DIRECTIONS, slot, up, squares,
                                  s->test->lattice_rests + spring_slot, springs, part);
                    rests = s->rest_lengths +
                            (size_t)s->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH +
                            slot % MSPRINGI_WIDTH;
                }
                const vector east =
                    spring_force(to_east, per_east, here, next, rests + MSPRINGI_EAST * MSPRINGI_WIDTH,
                                 springs + MSPRINGI_EAST * part, of);
                vector south_east = spring_force(to_south_east, per_south_east, next, above,
                                                 rests + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                                                 springs + MSPRINGI_SOUTH_EAST * part, of);
                const vec per_north_east = lattice_inverse(to_north_east.square, of);
                const vector north =
                    spring_force(to_north, per_north, here, above, rests + MSPRINGI_NORTH * MSPRINGI_WIDTH,
                                 springs + MSPRINGI_NORTH * part, of);
                vector north_east = spring_force(to_north_east, per_north_east, here, above_next,
                                                 rests + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                                                 springs + MSPRINGI_NORTH_EAST * part, of);
                if (of & MSPRINGI_CELLS)
                    add_area_force(s->cells + 2 * block * MSPRINGI_WIDTH + slot % MSPRINGI_WIDTH, to_north_east,
                                   to_south_east, &north_east, &south_east);

                const vector right = {sub(east.x, south_east.x), sub(east.y, south_east.y)};
                const vector known = {add(load(s->carry_x + carry), shift_in(before.right.x, right.x)),
                                      add(load(s->carry_y + carry), shift_in(before.right.y, right.y))};
                const vector force = {sub(sub(known.x, add(east.x, north.x)), north_east.x),
                                      sub(sub(known.y, add(east.y, north.y)), north_east.y)};
                store(s->carry_x + carry,
                      add(add(south_east.x, north.x), shift_in(before.diagonal.x, north_east.x)));
                store(s->carry_y + carry,
                      add(add(south_east.y, north.y), shift_in(before.diagonal.y, north_east.y)));
                before.right = right;
                before.diagonal = north_east;
                if (LANES == MSPRINGI_WIDTH)
                    move(s, slot, here, force, of);
                else
                    forces[(slot - first) / LANES] = force;
                slot += LANES;
                springs += LANES;
                rests += LANES;
                if (of & MSPRINGI_TESTED) {
                    low += LANES;
                    high += LANES;
                }
            } while (LANES < MSPRINGI_WIDTH && slot < end);
            for (size_t moved = first; LANES < MSPRINGI_WIDTH && moved < slot; moved += LANES)
                move(s, moved, load_motion(s, moved, of), forces[(moved - first) / LANES], of);
        }
    }
}

// Precise kernels outside lattices are kept small. They share one copy of move() and of irregular_force(), and
// compute springs of bundles one by one: 8 kB less in three levels.
static MSPRINGI_NOINLINE void move_precise(const mspringi_sweep *s, size_t slot, const motion *here,
                                           const vector *force, mspringi_variant of) {
    move(s, slot, *here, *force, of | MSPRINGI_PRECISE);
}

MSPRINGI_INLINE void move_apart(const mspringi_sweep *s, size_t slot, motion here, vector force,
                                mspringi_variant of) {
    if (of & MSPRINGI_PRECISE)
        move_precise(s, slot, &here, &force, of);
    else
        move(s, slot, here, force, of);
}

MSPRINGI_INLINE void chain(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count,
                           mspringi_variant of) {
    const mspringi_sweep copy = *sweep, *const s = &copy;
    vector before = {zero(), zero()};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const bool is_chain = span->record_slots == MSPRINGI_WIDTH;
        const size_t first_block = span->first_slot / MSPRINGI_WIDTH, end = end_of(span);
        for (size_t slot = first_of(span); slot < end; slot += LANES) {
            const size_t carry = (size_t)((int64_t)slot + span->carry), lane = slot % MSPRINGI_WIDTH;
            const size_t block = slot / MSPRINGI_WIDTH - first_block + span->first_record;
            const float *chain_record =
                s->chain_springs + block * (of & MSPRINGI_DAMPED ? 3 : 2) * MSPRINGI_WIDTH + lane;
            const float *rests =
                is_chain ? chain_record + MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH
                         : s->rest_lengths +
                               (size_t)s->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH + lane;
            const float *record = is_chain ? chain_record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH
                                           : s->lattice_springs +
                                                 (size_t)s->springs_of_block[block] * MSPRINGI_DIRECTIONS *
                                                     (of & MSPRINGI_DAMPED ? 2 : 1) * MSPRINGI_WIDTH +
                                                 lane;
            const motion here = load_motion(s, slot, of), next = load_motion_unaligned(s, slot + 1, of);
            const extent to_east = spring_extent(here, next, of);
            if (of & MSPRINGI_TESTED) {
                const mspringi_yield_test *t = s->test;
                const size_t spring_slot = is_chain ? t->first_chain_slot + block * MSPRINGI_WIDTH + lane
                                                    : block * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH + lane;
                float *own =
                    is_chain ? t->chain_springs + (rests - s->chain_springs) : t->lattice_rests + spring_slot;
                const vec square = to_east.square;
                if (bits_outside(square, t->test_low + spring_slot, t->test_high + spring_slot)) {
                    yield_springs(sweep, spring_slot, 1, slot, slot, &square, own, record, 0);
                    rests = own;
                }
            }
            const vector east =
                spring_force(to_east, inverse_or_zero(to_east.square), here, next, rests, record, of);
            const vector force = {add(sub(load(s->carry_x + carry), east.x), shift_in(before.x, east.x)),
                                  add(sub(load(s->carry_y + carry), east.y), shift_in(before.y, east.y))};
            store(s->carry_x + carry, zero());
            store(s->carry_y + carry, zero());
            before = east;
            move_apart(s, slot, here, force, of);
        }
    }
}

/// Geometry of LANES springs of the irregular part, for the forces on their tips.
typedef struct gap {
    vec dx, dy;            ///< from the tips to the bases
    vec square;            ///< squared length
    vec change;            ///< rate of change of the length, times the length
    vec major, minor, low; ///< as in an extent
} gap;

// Load LANES nodes of the irregular part.
MSPRINGI_INLINE motion load_nodes(const mspringi_sweep *s, const uint32_t *nodes, mspringi_variant of) {
    motion m;
    if (!(of & MSPRINGI_PRECISE)) {
        load_gathered(s->gathered, nodes, &m.x, &m.y, &m.vx, &m.vy);
        m.low_x = m.low_y = zero();
        return m;
    }
    vec low_x, low_y; // loaded twice, unused
    load_gathered(s->gathered, nodes, &m.x, &m.y, &m.low_x, &m.low_y);
    m.vx = m.vy = zero();
    if (of & MSPRINGI_DAMPED)
        load_gathered(s->gathered + mspringi_gathered_half(s->irregular), nodes, &m.vx, &m.vy, &low_x, &low_y);
    return m;
}

MSPRINGI_INLINE gap gap_to(const mspringi_sweep *s, motion tip, const uint32_t *bases, mspringi_variant of) {
    const motion base = load_nodes(s, bases, of);
    const extent from_tip = spring_extent(base, tip, of);
    gap to = {from_tip.dx, from_tip.dy, from_tip.square, zero(), zero(), zero(), zero()};
    if (of & MSPRINGI_PRECISE) {
        to.major = from_tip.major;
        to.minor = from_tip.minor;
        to.low = from_tip.low;
    }
    if (of & MSPRINGI_DAMPED)
        to.change = add(mul(sub(base.vx, tip.vx), to.dx), mul(sub(base.vy, tip.vy), to.dy));
    return to;
}

MSPRINGI_INLINE vector add_pull(vector sum, gap to, const float *record, mspringi_variant of) {
    const vec length = square_root(to.square);
    const vec rest_length = load(record + MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH);
    const vec stiffness = load(record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH);
    vec force =
        of & MSPRINGI_PRECISE
            ? MSPRINGI_LAW_FORCE(mul, stiffness, stretch(length, rest_length, to.major, to.minor, to.low, of))
            : MSPRINGI_LAW_FORCE(mul, mul(length, stiffness), sub(length, rest_length));
    if (of & MSPRINGI_DAMPED)
        force = add(force,
                    MSPRINGI_LAW_DAMPING_FORCE(mul, load(record + MSPRINGI_DAMPING * MSPRINGI_WIDTH), to.change));
    force = mul(force, inverse_or_zero(to.square));
    sum.x = add(sum.x, mul(force, to.dx));
    sum.y = add(sum.y, mul(force, to.dy));
    return sum;
}

// Force of the irregular part on LANES of its nodes, from the slice columns of their slice, starting at number
// slice_columns. The neighbours of a slice column are loaded before the forces of the previous one, so that both
// are in the reorder window: 7 to 11 % less time with SSE2, AVX2 and AVX-512.
MSPRINGI_INLINE vector irregular_force(const mspringi_sweep *s, motion here, size_t slice, size_t lane,
                                       uint32_t slice_columns, mspringi_variant of) {
    const size_t stride = (size_t)(of & MSPRINGI_DAMPED ? 3 : 2) * MSPRINGI_WIDTH;
    const uint32_t first = s->irregular->first_slice_column[slice] + slice_columns,
                   end = mspringi_sell_end_column(s->irregular, slice, lane, LANES);
    const uint32_t *neighbour = s->irregular->neighbour + (size_t)first * MSPRINGI_WIDTH + lane;
    const float *record = s->irregular_springs + first * stride + lane;
    vector sum = {zero(), zero()};
    if (first >= end)
        return sum;
    gap next = gap_to(s, here, neighbour, of);
    for (uint32_t slice_column = first + 1; slice_column < end; ++slice_column) {
        const gap now = next;
        neighbour += MSPRINGI_WIDTH;
        next = gap_to(s, here, neighbour, of);
        sum = add_pull(sum, now, record, of);
        record += stride;
    }
    return add_pull(sum, next, record, of);
}

// One copy for all precise kernels of a level; inlined it would take 3 kB in each. A test for dampers at every
// slice column costs an irregular part 5 % more instructions.
static MSPRINGI_NOINLINE vector irregular_force_precise(const mspringi_sweep *s, const motion *here, size_t slice,
                                                        size_t lane, uint32_t slice_columns, mspringi_variant of) {
    return of & MSPRINGI_DAMPED
               ? irregular_force(s, *here, slice, lane, slice_columns, MSPRINGI_PRECISE | MSPRINGI_DAMPED)
               : irregular_force(s, *here, slice, lane, slice_columns, MSPRINGI_PRECISE);
}

MSPRINGI_INLINE vector find_irregular_force(const mspringi_sweep *s, motion here, size_t slice, size_t lane,
                                            uint32_t slice_columns, mspringi_variant of) {
    return of & MSPRINGI_PRECISE ? irregular_force_precise(s, &here, slice, lane, slice_columns, of)
                                 : irregular_force(s, here, slice, lane, slice_columns, of);
}

// Forces of a slice's upright slice column on LANES of its nodes; those on the next slice's are opposite.
MSPRINGI_INLINE vector upright_force(const mspringi_sweep *s, size_t slot, motion here, size_t slice, size_t lane,
                                     mspringi_variant of) {
    const float *record =
        s->irregular_springs +
        (size_t)s->irregular->first_slice_column[slice] * (of & MSPRINGI_DAMPED ? 3 : 2) * MSPRINGI_WIDTH + lane;
    const motion above = load_motion(s, slot + MSPRINGI_WIDTH, of);
    const extent to = spring_extent(above, here, of);
    return spring_force(to, inverse_or_zero(to.square), above, here, record + MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH,
                        record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH, of);
}

// Sweep an irregular part with interleaved ropes, by columns of LANES nodes.
MSPRINGI_INLINE void interleaved_part(const mspringi_sweep *sweep, const mspringi_span *span, mspringi_variant of) {
    const mspringi_sweep copy = *sweep, *const s = &copy;
    const uint8_t *is_upright = s->irregular->is_interleaved;
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
        vector carried = {zero(), zero()};
        size_t slice = span->first_record;
        for (size_t slot = span->first_slot + lane; slot < end_of(span); slot += MSPRINGI_WIDTH, ++slice) {
            const motion here = load_motion(s, slot, of);
            vector force = find_irregular_force(s, here, slice, lane, is_upright[slice], of);
            force.x = add(force.x, carried.x);
            force.y = add(force.y, carried.y);
            carried.x = carried.y = zero();
            if (is_upright[slice]) {
                const vector up = upright_force(s, slot, here, slice, lane, of);
                force.x = add(force.x, up.x);
                force.y = add(force.y, up.y);
                carried.x = sub(zero(), up.x);
                carried.y = sub(zero(), up.y);
            }
            move_apart(s, slot, here, force, of);
        }
    }
}

MSPRINGI_INLINE void irregular(const mspringi_sweep *s, const mspringi_span *spans, uint32_t count,
                               mspringi_variant of) {
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        if (s->irregular->is_interleaved) {
            interleaved_part(s, span, of);
            continue;
        }
        for (size_t slot = span->first_slot; slot < end_of(span); slot += LANES) {
            const size_t node = (size_t)span->first_record * MSPRINGI_WIDTH + (slot - span->first_slot);
            const motion here = load_motion(s, slot, of);
            const vector force = find_irregular_force(s, here, node / MSPRINGI_WIDTH, node % MSPRINGI_WIDTH, 0, of);
            move_apart(s, slot, here, force, of);
        }
    }
}

#include "kernels/bundle_sweep.h"

MSPRINGI_INLINE void attached(const mspringi_sweep *s, uint32_t first_attached, uint32_t count, float *x, float *y,
                              mspringi_variant of) {
    const size_t first = s->irregular->own_count;
    for (size_t i = first_attached; i < (size_t)first_attached + count; i += LANES) {
        uint32_t nodes[LANES];
        for (size_t lane = 0; lane < LANES; ++lane)
            nodes[lane] = (uint32_t)(first + i + lane);
        const motion here = load_nodes(s, nodes, of);
        const vector force = find_irregular_force(s, here, (first + i) / MSPRINGI_WIDTH, i % MSPRINGI_WIDTH, 0, of);
        store(x + i, force.x);
        store(y + i, force.y);
    }
}

static void pack(const mspringi_sweep *s, size_t first_block, size_t block_count, float *gathered) {
    const mspringi_variant all = MSPRINGI_DAMPED;
    const size_t first = first_block * MSPRINGI_WIDTH;
    for (size_t slot = first; slot < first + block_count * MSPRINGI_WIDTH; slot += LANES) {
        const motion m = load_motion(s, slot, all);
        store_gathered(gathered, m.x, m.y, m.vx, m.vy);
        gathered += 4 * LANES;
    }
}

#include "kernels/loose_sweep.h"

#endif
