/// @file limit_kernel.h
/// Contribution of every spring to the stability limit (see stability/pencil.h): to a bound of it, and to the image
/// of a displacement; to clamped steps (see solvers/clamped/clamp.c): its impulse. In the vectors of sweep.h.
///
/// A pass is a sweep without a carry row: contributions to the row above are added there immediately.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_LIMIT_KERNEL_H
#define MSPRINGI_LIMIT_KERNEL_H

typedef enum limit_pass { BOUND_PASS, IMAGE_PASS, CLAMP_PASS } limit_pass;

/// LANES ends of springs: position and operands.
typedef struct spring_end {
    vec x, y, in_x, in_y, ratio;
} spring_end;

/// Contribution of LANES springs: sums at both ends for the bound, three, and for the weights, one; for an image
/// and for clamped springs, a force on the tips, with the opposite on the bases.
typedef struct limit_terms {
    vec sums[3];
} limit_terms;

MSPRINGI_INLINE spring_end load_spring_end(const mspringi_stability_limit *b, size_t slot, limit_pass pass) {
    spring_end end = {load_unaligned(b->x + slot), load_unaligned(b->y + slot), load_unaligned(b->in[0] + slot),
                      zero(), zero()};
    if (pass != BOUND_PASS)
        end.in_y = load_unaligned(b->in[1] + slot);
    if (pass == CLAMP_PASS)
        end.ratio = load_unaligned(b->in[2] + slot);
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

// Impulse on the tips of springs. Those that need it are clamped: see solvers/clamped/clamp.c. Springs that do not
// exist give 0, whatever their ends are.
MSPRINGI_INLINE limit_terms clamp_terms(const mspringi_stability_limit *b, spring_end base, spring_end tip,
                                        vec rest, vec stiffness, vec damping) {
    const vec h = set(b->h), one = set(1.0f), ratio = add(base.ratio, tip.ratio);
    const vec dvx = sub(base.in_x, tip.in_x), dvy = sub(base.in_y, tip.in_y);
    const vec here_x = sub(base.x, tip.x), here_y = sub(base.y, tip.y), way_x = mul(h, dvx), way_y = mul(h, dvy);
    const vec square_way = add(mul(way_x, way_x), mul(way_y, way_y));
    const vec square_here = add(mul(here_x, here_x), mul(here_y, here_y));
    const vec is_stiff = sub(ratio, set(MSPRINGI_CLAMP_RATIO));
    const vec is_violent = sub(square_way, mul(square_here, set(MSPRINGI_CLAMP_WAY)));
    const vec ahead = choose_positive(is_stiff, one, choose_positive(is_violent, one, zero()));
    const vec softening = choose_positive(is_stiff, mul(ratio, set(1.0f / MSPRINGI_CLAMP_RATIO)), one);
    const vec share = inverse_or_zero(choose_positive(is_violent, add(one, ratio), softening));
    const vec back =
        choose_positive(is_violent, zero(), choose_positive(is_stiff, set(1.0f - MSPRINGI_CLAMP_AHEAD), zero()));
    const vec dx = add(here_x, mul(ahead, way_x)), dy = add(here_y, mul(ahead, way_y));
    const vec square = add(mul(dx, dx), mul(dy, dy)), inverse = inverse_or_zero(square);
    const vec length = square_root(square), push = mul(mul(h, stiffness), share);
    const vec pull = mul(push, mul(length, sub(length, rest)));
    const vec brake = sub(mul(mul(h, damping), share), mul(mul(back, h), push));
    const vec drag = mul(brake, add(mul(dvx, dx), mul(dvy, dy)));
    const vec exists = mul(inverse, choose_positive(share, add(stiffness, damping), zero()));
    const vec impulse = mul(add(pull, drag), inverse);
    return (limit_terms){{choose_positive(exists, mul(impulse, dx), zero()),
                          choose_positive(exists, mul(impulse, dy), zero()), zero()}};
}

// record points to the springs' stiffness, followed by their damping.
MSPRINGI_INLINE limit_terms terms_of_springs(const mspringi_stability_limit *b, spring_end base, spring_end tip,
                                             const float *rests, const float *record, limit_pass pass) {
    const vec damping = b->is_damped ? load(record + MSPRINGI_WIDTH) : zero();
    if (pass == CLAMP_PASS)
        return clamp_terms(b, base, tip, load(rests), load(record), damping);
    const vec dx = sub(tip.x, base.x), dy = sub(tip.y, base.y);
    const vec square = add(mul(dx, dx), mul(dy, dy));
    const vec inverse = mul(square_root(square), inverse_or_zero(square)); // inverse length
    const vec nx = mul(dx, inverse), ny = mul(dy, inverse), stiffness = mul(set(b->stiffness), load(record));
    const vec strain = sub(set(1.0f), mul(load(rests), inverse)), deepest = set(MSPRINGI_DEEPEST_SOFTENING);
    const vec across = mul(stiffness, choose_positive(sub(strain, deepest), strain, deepest));
    const vec along = add(stiffness, mul(set(b->damping), damping));
    return pass == IMAGE_PASS ? image_terms(base, tip, nx, ny, along, across)
                              : bound_terms(base, tip, nx, ny, along, across, inverse);
}

// Add contributions at the bases and at the tips of springs; forces times inverse masses.
MSPRINGI_INLINE void add_terms(const mspringi_stability_limit *b, size_t sum, size_t slot, vec bases, vec tips,
                               limit_pass pass) {
    const vec term = pass != BOUND_PASS ? mul(load(b->inverse_mass + slot), sub(tips, bases)) : add(bases, tips);
    store(b->out[sum] + slot, add(load(b->out[sum] + slot), term));
}

// Add the springs of LANES slots of a lattice. before: contributions of the previous slots to the right, and to the
// right above.
MSPRINGI_INLINE void add_slots(const mspringi_stability_limit *b, size_t slot, size_t up, const float *rests,
                               const float *records, limit_terms before[2], limit_pass pass) {
    const size_t part = (size_t)(b->is_damped ? 2 : 1) * MSPRINGI_WIDTH;
    const spring_end here = load_spring_end(b, slot, pass), next = load_spring_end(b, slot + 1, pass);
    const spring_end above = load_spring_end(b, up, pass), above_next = load_spring_end(b, up + 1, pass);
    const limit_terms east = terms_of_springs(b, here, next, rests + MSPRINGI_EAST * MSPRINGI_WIDTH,
                                              records + MSPRINGI_EAST * part, pass);
    const limit_terms north = terms_of_springs(b, here, above, rests + MSPRINGI_NORTH * MSPRINGI_WIDTH,
                                               records + MSPRINGI_NORTH * part, pass);
    const limit_terms north_east =
        terms_of_springs(b, here, above_next, rests + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                         records + MSPRINGI_NORTH_EAST * part, pass);
    const limit_terms south_east = terms_of_springs(b, above, next, rests + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                                                    records + MSPRINGI_SOUTH_EAST * part, pass);
    for (size_t sum = 0; sum < (pass == BOUND_PASS ? 3 : 2); ++sum) {
        const vec right = add(east.sums[sum], south_east.sums[sum]);
        add_terms(b, sum, slot, add(add(east.sums[sum], north.sums[sum]), north_east.sums[sum]),
                  shift_in(before[0].sums[sum], right), pass);
        add_terms(b, sum, up, south_east.sums[sum],
                  add(north.sums[sum], shift_in(before[1].sums[sum], north_east.sums[sum])), pass);
        before[0].sums[sum] = right;
        before[1].sums[sum] = north_east.sums[sum];
    }
}

MSPRINGI_INLINE void limit_lattice(const mspringi_stability_limit *limit, limit_pass pass) {
    const mspringi_stability_limit copy = *limit, *const b = &copy; // local copies, which no store can alias
    const uint32_t *const up_of_block = b->topology->up_of_block;
    const size_t first = b->topology->lattice_first, blocks = b->topology->lattice_blocks;
    limit_terms before[2] = {{{zero(), zero(), zero()}}, {{zero(), zero(), zero()}}};
    for (size_t block = 0; block < blocks; ++block) {
        const size_t here = (first + block) * MSPRINGI_WIDTH;
        const size_t up = (size_t)up_of_block[block] * MSPRINGI_WIDTH;
        const float *rests =
            b->rest_lengths + (size_t)b->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
        const float *records = b->lattice_springs + (size_t)b->springs_of_block[block] * MSPRINGI_DIRECTIONS *
                                                        (b->is_damped ? 2 : 1) * MSPRINGI_WIDTH;
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES)
            add_slots(b, here + lane, up + lane, rests + lane, records + lane, before, pass);
    }
}

MSPRINGI_INLINE void limit_chain(const mspringi_stability_limit *limit, limit_pass pass) {
    const mspringi_stability_limit copy = *limit, *const b = &copy;
    const size_t first = b->topology->chain_first, blocks = b->topology->chain_blocks;
    const size_t parts = b->is_damped ? 3 : 2;
    limit_terms before = {{zero(), zero(), zero()}};
    for (size_t i = 0; i < blocks * MSPRINGI_WIDTH; i += LANES) {
        const size_t slot = first * MSPRINGI_WIDTH + i;
        const float *record = b->chain_springs + i / MSPRINGI_WIDTH * parts * MSPRINGI_WIDTH + i % MSPRINGI_WIDTH;
        const limit_terms east = terms_of_springs(
            b, load_spring_end(b, slot, pass), load_spring_end(b, slot + 1, pass),
            record + MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH, record + MSPRINGI_STIFFNESS * MSPRINGI_WIDTH, pass);
        for (size_t sum = 0; sum < (pass == BOUND_PASS ? 3 : 2); ++sum)
            add_terms(b, sum, slot, east.sums[sum], shift_in(before.sums[sum], east.sums[sum]), pass);
        before = east;
    }
}

#define LIMIT_PASS(name, pass)                                                                                     \
    static void name##_rows(const mspringi_stability_limit *limit) {                                               \
        limit_lattice(limit, pass);                                                                                \
        limit_chain(limit, pass);                                                                                  \
    }

LIMIT_PASS(bound, BOUND_PASS)
LIMIT_PASS(image, IMAGE_PASS)
LIMIT_PASS(clamp, CLAMP_PASS)
#undef LIMIT_PASS

#endif
