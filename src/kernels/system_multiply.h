/// @file system_multiply.h
/// Product with the matrix of an implicit substep, in vectors of LANES slots: the innermost loop of the implicit
/// solver. As in sweep.h, the row that owns a spring computes it once, and carries it to the right and to the row
/// above.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_MULTIPLY_H
#define MSPRINGI_SYSTEM_MULTIPLY_H

#if defined(_MSC_VER)
#define MSPRINGI_PRODUCT static __forceinline
#else
#define MSPRINGI_PRODUCT static inline __attribute__((always_inline))
#endif

/// Displacement, or product, of LANES particles.
typedef struct displacement {
    vec x, y;
} displacement;

MSPRINGI_PRODUCT displacement spring_product(displacement base, displacement tip, const float *factors) {
    const vec pull_x = load(factors + MSPRINGI_PULL_X * MSPRINGI_WIDTH);
    const vec pull_y = load(factors + MSPRINGI_PULL_Y * MSPRINGI_WIDTH);
    const vec geometric = load(factors + MSPRINGI_GEOMETRIC * MSPRINGI_WIDTH);
    const vec dx = sub(tip.x, base.x), dy = sub(tip.y, base.y);
    const vec along = add(mul(pull_x, dx), mul(pull_y, dy));
    const displacement result = {add(mul(geometric, dx), mul(pull_x, along)),
                                 add(mul(geometric, dy), mul(pull_y, along))};
    return result;
}

/// Sums by lane of a block.
typedef struct product_sums {
    _Alignas(64) float lanes[MSPRINGI_WIDTH];
} product_sums;

// Add from . to of LANES slots.
MSPRINGI_PRODUCT void add_product(product_sums *sums, size_t slot, displacement from, displacement to) {
    float *const lanes = sums->lanes + slot % MSPRINGI_WIDTH;
    store(lanes, add(load(lanes), add(mul(from.x, to.x), mul(from.y, to.y))));
}

MSPRINGI_PRODUCT float multiply_lattice_rows(const mspringi_system *system, const mspringi_span *spans,
                                             uint32_t count, const float *from_x, const float *from_y, float *to_x,
                                             float *to_y, bool only_carry) {
    const float *const mass = system->mass;
    float *const carry_x = system->carry_xx, *const carry_y = system->carry_xy;
    const size_t factor = (size_t)MSPRINGI_FACTORS * MSPRINGI_WIDTH;
    displacement before_right = {zero(), zero()}, before_diagonal = {zero(), zero()};
    product_sums sums = {{0.0f}};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t first = span->first_slot / LANES * LANES;
        const size_t end = (size_t)(span->end_slot + LANES - 1) / LANES * LANES;
        for (size_t slot = first; slot < end; slot += LANES) {
            const size_t up = (size_t)((int64_t)slot + span->up), carry = (size_t)((int64_t)slot + span->carry);
            const size_t block = slot / MSPRINGI_WIDTH - span->first_slot / MSPRINGI_WIDTH + span->first_record;
            const float *factors =
                system->lattice_factors + block * MSPRINGI_DIRECTIONS * factor + slot % MSPRINGI_WIDTH;
            const displacement here = {load(from_x + slot), load(from_y + slot)};
            const displacement next = {load_unaligned(from_x + slot + 1), load_unaligned(from_y + slot + 1)};
            const displacement above = {load(from_x + up), load(from_y + up)};
            const displacement above_next = {load_unaligned(from_x + up + 1), load_unaligned(from_y + up + 1)};
            const displacement north = spring_product(here, above, factors + MSPRINGI_NORTH * factor);
            const displacement north_east =
                spring_product(here, above_next, factors + MSPRINGI_NORTH_EAST * factor);
            const displacement south_east = spring_product(above, next, factors + MSPRINGI_SOUTH_EAST * factor);
            if (!only_carry) {
                const displacement east = spring_product(here, next, factors + MSPRINGI_EAST * factor);
                const displacement right = {add(east.x, south_east.x), add(east.y, south_east.y)};
                const vec force_x = sub(add(load(carry_x + carry), add(add(east.x, north.x), north_east.x)),
                                        shift_in(before_right.x, right.x));
                const vec force_y = sub(add(load(carry_y + carry), add(add(east.y, north.y), north_east.y)),
                                        shift_in(before_right.y, right.y));
                const displacement to = {sub(mul(load(mass + slot), here.x), force_x),
                                         sub(mul(load(mass + slot), here.y), force_y)};
                // to_x and to_y are NULL only for carry rows.
                // cppcheck-suppress nullPointerArithmetic
                store(to_x + slot, to.x);
                // cppcheck-suppress nullPointerArithmetic
                store(to_y + slot, to.y);
                add_product(&sums, slot, here, to);
                before_right = right;
            }
            store(carry_x + carry, sub(sub(south_east.x, north.x), shift_in(before_diagonal.x, north_east.x)));
            store(carry_y + carry, sub(sub(south_east.y, north.y), shift_in(before_diagonal.y, north_east.y)));
            before_diagonal = north_east;
        }
    }
    return sum_block_lanes(sums.lanes);
}

static float multiply_lattice(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                              const float *from_x, const float *from_y, float *to_x, float *to_y) {
    return multiply_lattice_rows(system, spans, count, from_x, from_y, to_x, to_y, false);
}

static void multiply_carry(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                           const float *from_x, const float *from_y) {
    (void)multiply_lattice_rows(system, spans, count, from_x, from_y, NULL, NULL, true);
}

// Rows of east springs only.
static float multiply_chain(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                            const float *from_x, const float *from_y, float *to_x, float *to_y) {
    const float *const mass = system->mass;
    float *const carry_x = system->carry_xx, *const carry_y = system->carry_xy;
    displacement before = {zero(), zero()};
    product_sums sums = {{0.0f}};
    for (const mspringi_span *span = spans; span < spans + count; ++span) {
        const size_t stride = (size_t)MSPRINGI_FACTORS * span->record_slots;
        const float *records =
            span->record_slots == MSPRINGI_WIDTH ? system->chain_factors : system->lattice_factors;
        const size_t first = span->first_slot / LANES * LANES;
        const size_t end = (size_t)(span->end_slot + LANES - 1) / LANES * LANES;
        for (size_t slot = first; slot < end; slot += LANES) {
            const size_t carry = (size_t)((int64_t)slot + span->carry);
            const size_t block = slot / MSPRINGI_WIDTH - span->first_slot / MSPRINGI_WIDTH + span->first_record;
            const displacement here = {load(from_x + slot), load(from_y + slot)};
            const displacement next = {load_unaligned(from_x + slot + 1), load_unaligned(from_y + slot + 1)};
            const displacement east = spring_product(here, next, records + block * stride + slot % MSPRINGI_WIDTH);
            const vec force_x = sub(add(load(carry_x + carry), east.x), shift_in(before.x, east.x));
            const vec force_y = sub(add(load(carry_y + carry), east.y), shift_in(before.y, east.y));
            store(carry_x + carry, zero());
            store(carry_y + carry, zero());
            before = east;
            const displacement to = {sub(mul(load(mass + slot), here.x), force_x),
                                     sub(mul(load(mass + slot), here.y), force_y)};
            store(to_x + slot, to.x);
            store(to_y + slot, to.y);
            add_product(&sums, slot, here, to);
        }
    }
    return sum_block_lanes(sums.lanes);
}

#endif
