/// @file yield_sweep.h
/// Test of a sweep for springs near their yield limit, and return of flowing ones to the yield surface. yield_law.h
/// has the same for one spring. Included by sweep.h.
///
/// The springs of LANES slots cost eight comparisons with bounds. A function that is not inlined tests further if
/// one is out of bounds.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_YIELD_SWEEP_H
#define MSPRINGI_YIELD_SWEEP_H

// Bits of LANES springs outside their bounds on the squared length.
MSPRINGI_INLINE uint32_t bits_outside(vec square, const float *low, const float *high) {
    return bits_greater(square, load(high)) | bits_greater(load(low), square);
}

// mspringi_yield_bounds_of() for springs with a changed rest length.
static inline void update_bounds(const mspringi_yield_test *t, size_t spring_slot, vec moved, vec to) {
    const vec nominal = load(t->nominal + spring_slot), hardening = load(t->hardening + spring_slot),
              one = set(1.0f);
    const vec limit = load(t->plastic_limit + spring_slot), zeros = zero(), none = set(-1.0f), all = set(INFINITY);
    const vec most = mul(nominal, add(one, limit)), least = mul(nominal, sub(one, limit));
    const vec centre = sub(mul(add(one, hardening), to), mul(hardening, nominal));
    const vec half = mul(load(t->yield_strain + spring_slot), nominal), warm = mul(set(MSPRINGI_WARM_SHARE), half);
    const vec halves[2] = {warm, half}, back = sub(zeros, moved);
    float *const lows[2] = {t->low + spring_slot, t->flow_low + spring_slot}, *const highs[2] = {
                                                                                  t->high + spring_slot,
                                                                                  t->flow_high + spring_slot};
    for (int i = 0; i < 2; ++i) {
        const vec low = sub(centre, halves[i]), high = add(centre, halves[i]);
        const vec new_low = choose_positive(sub(to, least), choose_positive(low, mul(low, low), none), none);
        const vec new_high = choose_positive(sub(most, to), choose_positive(high, mul(high, high), zeros), all);
        const vec old_low = load(lows[i]), old_high = load(highs[i]);
        store(lows[i], choose_positive(moved, new_low, choose_positive(back, new_low, old_low)));
        store(highs[i], choose_positive(moved, new_high, choose_positive(back, new_high, old_high)));
    }
}

// mspringi_yield_start() for LANES springs.
static inline vec start_of(const mspringi_sweep *s, size_t base, size_t tip, vec square) {
    const vec dx = sub(load_unaligned(s->x + base), load_unaligned(s->x + tip));
    const vec dy = sub(load_unaligned(s->y + base), load_unaligned(s->y + tip));
    const vec dvx = sub(load_unaligned(s->vx + base), load_unaligned(s->vx + tip));
    const vec dvy = sub(load_unaligned(s->vy + base), load_unaligned(s->vy + tip));
    const vec h = set(s->h), way_x = mul(h, dvx), way_y = mul(h, dvy);
    const vec back = add(mul(way_x, sub(add(dx, dx), way_x)), mul(way_y, sub(add(dy, dy), way_y)));
    const vec before = sub(square, back);
    return square_root(choose_positive(before, before, zero()));
}

// mspringi_yield_rest() and mspringi_yield_heat() for LANES springs. A broken one has no stiffness.
static inline void flow(const mspringi_sweep *s, size_t spring_slot, size_t base, size_t tip, vec square,
                        float *rests, const float *stiffnesses) {
    const mspringi_yield_test *t = s->test;
    const vec nominal = load(t->nominal + spring_slot), yield = load(t->yield_strain + spring_slot);
    const vec hardening = load(t->hardening + spring_slot), limit = load(t->plastic_limit + spring_slot);
    const vec gain = load(t->gain + spring_slot), one = set(1.0f), stiffness = load(stiffnesses),
              rest = load(rests);
    const vec length = square_root(square), slope = mul(gain, length), whole = add(one, hardening);
    const vec most = mul(nominal, add(one, limit)), least = mul(nominal, sub(one, limit));
    vec up = add(slope, mul(mul(sub(hardening, yield), nominal), gain));
    vec down = add(slope, mul(mul(add(hardening, yield), nominal), gain));
    up = choose_positive(sub(up, most), most, up);
    down = choose_positive(sub(least, down), least, down);
    vec to = choose_positive(sub(square, load(t->flow_high + spring_slot)),
                             choose_positive(sub(up, rest), up, rest), rest);
    to = choose_positive(sub(load(t->flow_low + spring_slot), square), choose_positive(sub(rest, down), down, rest),
                         to);
    to = choose_positive(stiffness, to, rest);
    const uint32_t warm = mspringi_yield_warm(t, spring_slot / MSPRINGI_WIDTH) >> spring_slot % MSPRINGI_WIDTH;
    float is_warm[LANES];
    for (uint32_t i = 0; i < LANES; ++i)
        is_warm[i] = warm >> i & 1 ? 1.0f : 0.0f;
    to = choose_positive(load_unaligned(is_warm), to, rest);
    const vec moved = sub(to, rest), zeros = zero();
    const uint32_t bits = bits_greater(moved, zeros) | bits_greater(zeros, moved),
                   lane = spring_slot % MSPRINGI_WIDTH;
    if (!bits)
        return;
    mspringi_yield_save(t, spring_slot / MSPRINGI_WIDTH, bits << lane, rests - lane);
    const vec half = set(0.5f), mean = mul(half, add(start_of(s, base, tip, square), length));
    const vec excess = sub(add(mean, mul(hardening, nominal)), mul(whole, rest));
    const vec heat = mul(stiffness, mul(moved, sub(excess, mul(mul(half, whole), moved))));
    const vec sum = load(t->heat + spring_slot), more = add(sum, heat), back = sub(zeros, moved);
    store(t->heat + spring_slot, choose_positive(moved, more, choose_positive(back, more, sum)));
    store(rests, to);
    update_bounds(t, spring_slot, moved, to);
}

// Handle LANES springs from slot on, of which some are warm or flow: rare. It changes rest lengths, not positions.
static MSPRINGI_NOINLINE void yield_springs(const mspringi_sweep *s, size_t spring_slot, uint32_t directions,
                                            size_t slot, size_t up, const vec *squares, float *rests,
                                            const float *stiffnesses, size_t part) {
    const mspringi_yield_test *t = s->test;
    const size_t bases[] = {slot, slot, slot, slot + 1}, tips[] = {slot + 1, up, up + 1, up};
    for (uint32_t d = 0; d < directions; ++d, spring_slot += MSPRINGI_WIDTH) {
        if (t->looks) {
            const uint32_t warm = bits_outside(squares[d], t->low + spring_slot, t->high + spring_slot);
            mspringi_yield_mark_warm(t, spring_slot / MSPRINGI_WIDTH, warm << spring_slot % MSPRINGI_WIDTH);
        }
        if (t->maps && bits_outside(squares[d], t->flow_low + spring_slot, t->flow_high + spring_slot))
            flow(s, spring_slot, bases[d], tips[d], squares[d], rests + d * MSPRINGI_WIDTH, stiffnesses + d * part);
    }
}

// True if any spring of LANES slots of a lattice is outside its bounds. low and high point to those of the first
// slot.
MSPRINGI_INLINE uint32_t any_in_lattice(const float *low, const float *high, vec east, vec north, vec north_east,
                                        vec south_east) {
    const size_t width = MSPRINGI_WIDTH;
    const mask level =
        either(outside(east, load(low), load(high)),
               outside(north, load(low + MSPRINGI_NORTH * width), load(high + MSPRINGI_NORTH * width)));
    const mask across = either(
        outside(north_east, load(low + MSPRINGI_NORTH_EAST * width), load(high + MSPRINGI_NORTH_EAST * width)),
        outside(south_east, load(low + MSPRINGI_SOUTH_EAST * width), load(high + MSPRINGI_SOUTH_EAST * width)));
    return any_lane(either(level, across));
}

#endif
