/// @file limit_kernel.h
/// Contribution of every spring to the stability limit (see stability/pencil.h): to a bound of it, and to the image
/// of a displacement, in the vectors of sweep.h.
///
/// A pass is a sweep without a carry row: contributions to the row above are added there immediately.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LIMIT_KERNEL_H
#define MSPRINGI_LIMIT_KERNEL_H

/// LANES ends of springs: position and operand.
typedef struct spring_end {
    vec x, y, in_x, in_y;
} spring_end;

/// Contribution of LANES springs: three sums at both ends for the bound; for an image, a force on the tips, with
/// the opposite on the bases.
typedef struct limit_terms {
    vec sums[3];
} limit_terms;

MSPRINGI_INLINE spring_end load_spring_end(const mspringi_stability_limit *b, size_t slot, bool is_image) {
    spring_end end = {load_unaligned(b->x + slot), load_unaligned(b->y + slot), load_unaligned(b->in[0] + slot),
                      zero()};
    if (is_image)
        end.in_y = load_unaligned(b->in[1] + slot);
    return end;
}

// See stability/certificate.c. A compressed spring counts as one at rest length.
MSPRINGI_INLINE limit_terms bound_terms(spring_end base, spring_end tip, vec nx, vec ny, vec along, vec across,
                                        vec inverse) {
    const vec both = add(base.in_x, tip.in_x), half = mul(set(0.5f), both);
    const vec stretched = choose_positive(across, across, zero()), turned = mul(half, sub(along, stretched));
    const vec all = choose_positive(inverse, mul(half, add(along, stretched)), zero());
    const vec off_axis = mul(add(turned, turned), mul(nx, ny));
    return (limit_terms){{all, mul(turned, sub(mul(nx, nx), mul(ny, ny))), off_axis}};
}

// Force against a displacement.
MSPRINGI_INLINE limit_terms image_terms(spring_end base, spring_end tip, vec nx, vec ny, vec along, vec across) {
    const vec dx = sub(tip.in_x, base.in_x), dy = sub(tip.in_y, base.in_y);
    const vec pull = mul(along, add(mul(nx, dx), mul(ny, dy)));
    const vec shear = mul(across, sub(mul(ny, dx), mul(nx, dy)));
    return (limit_terms){{add(mul(pull, nx), mul(shear, ny)), sub(mul(pull, ny), mul(shear, nx)), zero()}};
}

// record points to the springs' stiffness, followed by their damping.
MSPRINGI_INLINE limit_terms terms_of_springs(const mspringi_stability_limit *b, spring_end base, spring_end tip,
                                             const float *rests, const float *record, bool damped, bool is_image) {
    const vec dx = sub(tip.x, base.x), dy = sub(tip.y, base.y);
    const vec square = add(mul(dx, dx), mul(dy, dy));
    const vec inverse = mul(square_root(square), inverse_or_zero(square)); // inverse length
    const vec nx = mul(dx, inverse), ny = mul(dy, inverse), stiffness = mul(set(b->stiffness), load(record));
    const vec across = mul(stiffness, sub(set(1.0f), mul(load(rests), inverse)));
    vec along = stiffness;
    if (damped)
        along = add(along, mul(set(b->damping), load(record + MSPRINGI_WIDTH)));
    return is_image ? image_terms(base, tip, nx, ny, along, across)
                    : bound_terms(base, tip, nx, ny, along, across, inverse);
}

// Add contributions at the bases and at the tips of springs; for an image, times inverse masses.
MSPRINGI_INLINE void add_terms(const mspringi_stability_limit *b, size_t sum, size_t slot, vec bases, vec tips,
                               bool is_image) {
    const vec term = is_image ? mul(load(b->inverse_mass + slot), sub(tips, bases)) : add(bases, tips);
    store(b->out[sum] + slot, add(load(b->out[sum] + slot), term));
}

// Add the springs of LANES slots of a lattice. before: contributions of the previous slots to the right, and to the
// right above.
MSPRINGI_INLINE void add_slots(const mspringi_stability_limit *b, size_t slot, size_t up, const float *rests,
                               const float *records, limit_terms before[2], bool damped, bool is_image) {
    const size_t part = (size_t)(damped ? 2 : 1) * MSPRINGI_WIDTH;
    const spring_end here = load_spring_end(b, slot, is_image), next = load_spring_end(b, slot + 1, is_image);
    const spring_end above = load_spring_end(b, up, is_image), above_next = load_spring_end(b, up + 1, is_image);
    const limit_terms east = terms_of_springs(b, here, next, rests + MSPRINGI_EAST * MSPRINGI_WIDTH,
                                              records + MSPRINGI_EAST * part, damped, is_image);
    const limit_terms north = terms_of_springs(b, here, above, rests + MSPRINGI_NORTH * MSPRINGI_WIDTH,
                                               records + MSPRINGI_NORTH * part, damped, is_image);
    const limit_terms north_east =
        terms_of_springs(b, here, above_next, rests + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                         records + MSPRINGI_NORTH_EAST * part, damped, is_image);
    const limit_terms south_east = terms_of_springs(b, above, next, rests + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                                                    records + MSPRINGI_SOUTH_EAST * part, damped, is_image);
    for (size_t sum = 0; sum < (is_image ? 2 : 3); ++sum) {
        const vec right = add(east.sums[sum], south_east.sums[sum]);
        add_terms(b, sum, slot, add(add(east.sums[sum], north.sums[sum]), north_east.sums[sum]),
                  shift_in(before[0].sums[sum], right), is_image);
        add_terms(b, sum, up, south_east.sums[sum],
                  add(north.sums[sum], shift_in(before[1].sums[sum], north_east.sums[sum])), is_image);
        before[0].sums[sum] = right;
        before[1].sums[sum] = north_east.sums[sum];
    }
}

MSPRINGI_INLINE void limit_lattice(const mspringi_stability_limit *limit, bool damped, bool is_image) {
    const mspringi_stability_limit copy = *limit, *const b = &copy; // a local copy, which no store can alias
    limit_terms before[2] = {{{zero(), zero(), zero()}}, {{zero(), zero(), zero()}}};
    for (size_t block = 0; block < b->lattice_blocks; ++block) {
        const size_t here = (b->lattice_first + block) * MSPRINGI_WIDTH;
        const size_t up = (size_t)b->up_of_block[block] * MSPRINGI_WIDTH;
        const float *rests =
            b->rest_lengths + (size_t)b->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
        const float *records = b->lattice_springs + (size_t)b->springs_of_block[block] * MSPRINGI_DIRECTIONS *
                                                        (damped ? 2 : 1) * MSPRINGI_WIDTH;
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES)
            add_slots(b, here + lane, up + lane, rests + lane, records + lane, before, damped, is_image);
    }
}

MSPRINGI_INLINE void limit_chain(const mspringi_stability_limit *limit, bool damped, bool is_image) {
    const mspringi_stability_limit copy = *limit, *const b = &copy;
    const size_t parts = damped ? 3 : 2;
    limit_terms before = {{zero(), zero(), zero()}};
    for (size_t i = 0; i < (size_t)b->chain_blocks * MSPRINGI_WIDTH; i += LANES) {
        const size_t slot = b->chain_first * MSPRINGI_WIDTH + i;
        const float *record = b->chain_springs + i / MSPRINGI_WIDTH * parts * MSPRINGI_WIDTH + i % MSPRINGI_WIDTH;
        const limit_terms east =
            terms_of_springs(b, load_spring_end(b, slot, is_image), load_spring_end(b, slot + 1, is_image),
                             record + MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH,
                             record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH, damped, is_image);
        for (size_t sum = 0; sum < (is_image ? 2 : 3); ++sum)
            add_terms(b, sum, slot, east.sums[sum], shift_in(before.sums[sum], east.sums[sum]), is_image);
        before = east;
    }
}

static void bound_lattice(const mspringi_stability_limit *limit) {
    if (limit->is_damped)
        limit_lattice(limit, true, false);
    else
        limit_lattice(limit, false, false);
}

static void bound_chain(const mspringi_stability_limit *limit) {
    limit_chain(limit, limit->is_damped, false);
}

static void image_lattice(const mspringi_stability_limit *limit) {
    if (limit->is_damped)
        limit_lattice(limit, true, true);
    else
        limit_lattice(limit, false, true);
}

static void image_chain(const mspringi_stability_limit *limit) {
    limit_chain(limit, limit->is_damped, true);
}

#endif
