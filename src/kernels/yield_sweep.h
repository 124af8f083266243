/// @file yield_sweep.h
/// What a tested sweep does beside its forces: find the springs that are near to what they yield at, and give those
/// that flow another rest length. yield_law.h has the same for one spring. It is part of sweep.h.
///
/// The springs of LANES slots cost eight comparisons with bounds. Only if one is out of its bounds, a function that
/// is not inlined looks closer.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_YIELD_SWEEP_H
#define MSPRINGI_YIELD_SWEEP_H

// Bits of LANES springs that are outside of two squares of lengths.
MSPRINGI_INLINE uint32_t bits_outside(vec square, const float *low, const float *high) {
    return bits_greater(square, load(high)) | bits_greater(load(low), square);
}

// mspringi_yield_bounds_of() of the springs whose rest length has moved.
static inline void renew_bounds(const mspringi_yield_test *t, size_t place, vec moved, vec to) {
    const vec nominal = load(t->nominal + place), hardening = load(t->hardening + place), one = set(1.0f);
    const vec limit = load(t->plastic_limit + place), zeros = zero(), none = set(-1.0f), all = set(INFINITY);
    const vec most = mul(nominal, add(one, limit)), least = mul(nominal, sub(one, limit));
    const vec centre = sub(mul(add(one, hardening), to), mul(hardening, nominal));
    const vec half = mul(load(t->yield_strain + place), nominal), warm = mul(set(MSPRINGI_WARM_SHARE), half);
    const vec halves[2] = {warm, half}, back = sub(zeros, moved);
    float *const lows[2] = {t->low + place, t->flow_low + place}, *const highs[2] = {t->high + place,
                                                                                     t->flow_high + place};
    for (int i = 0; i < 2; ++i) {
        const vec low = sub(centre, halves[i]), high = add(centre, halves[i]);
        const vec new_low = choose_positive(sub(to, least), choose_positive(low, mul(low, low), none), none);
        const vec new_high = choose_positive(sub(most, to), choose_positive(high, mul(high, high), zeros), all);
        const vec old_low = load(lows[i]), old_high = load(highs[i]);
        store(lows[i], choose_positive(moved, new_low, choose_positive(back, new_low, old_low)));
        store(highs[i], choose_positive(moved, new_high, choose_positive(back, new_high, old_high)));
    }
}

// mspringi_yield_rest() and mspringi_yield_heat() of LANES springs. What is broken has no stiffness.
static inline void flow(const mspringi_yield_test *t, size_t place, vec square, float *rests,
                        const float *stiffnesses) {
    const vec nominal = load(t->nominal + place), yield = load(t->yield_strain + place);
    const vec hardening = load(t->hardening + place), limit = load(t->plastic_limit + place);
    const vec gain = load(t->gain + place), one = set(1.0f), stiffness = load(stiffnesses), rest = load(rests);
    const vec length = square_root(square), slope = mul(gain, length), whole = add(one, hardening);
    const vec most = mul(nominal, add(one, limit)), least = mul(nominal, sub(one, limit));
    vec up = add(slope, mul(mul(sub(hardening, yield), nominal), gain));
    vec down = add(slope, mul(mul(add(hardening, yield), nominal), gain));
    up = choose_positive(sub(up, most), most, up);
    down = choose_positive(sub(least, down), least, down);
    vec to =
        choose_positive(sub(square, load(t->flow_high + place)), choose_positive(sub(up, rest), up, rest), rest);
    to = choose_positive(sub(load(t->flow_low + place), square), choose_positive(sub(rest, down), down, rest), to);
    to = choose_positive(stiffness, to, rest);
    const vec moved = sub(to, rest), zeros = zero();
    const uint32_t bits = bits_greater(moved, zeros) | bits_greater(zeros, moved), lane = place % MSPRINGI_WIDTH;
    if (!bits)
        return;
    mspringi_yield_keep(t, place / MSPRINGI_WIDTH, bits << lane, rests - lane);
    const vec excess = sub(add(length, mul(hardening, nominal)), mul(whole, rest));
    const vec heat = mul(stiffness, mul(moved, sub(excess, mul(mul(set(0.5f), whole), moved))));
    const vec sum = load(t->heat + place), more = add(sum, heat), back = sub(zeros, moved);
    store(t->heat + place, choose_positive(moved, more, choose_positive(back, more, sum)));
    store(rests, to);
    renew_bounds(t, place, moved, to);
}

// Rarely called: of these springs some are warm, or flow. Rest lengths are another then, positions are not.
static MSPRINGI_NOINLINE void let_yield(const mspringi_yield_test *t, size_t place, uint32_t directions,
                                        const vec *squares, float *rests, const float *stiffnesses, size_t part) {
    for (uint32_t d = 0; d < directions; ++d, place += MSPRINGI_WIDTH) {
        const uint32_t warm = bits_outside(squares[d], t->low + place, t->high + place);
        mspringi_yield_note(t, place / MSPRINGI_WIDTH, warm << place % MSPRINGI_WIDTH);
        if (t->maps && bits_outside(squares[d], t->flow_low + place, t->flow_high + place))
            flow(t, place, squares[d], rests + d * MSPRINGI_WIDTH, stiffnesses + d * part);
    }
}

// Look whether any of the springs of LANES slots of a lattice has to be looked at closer: squares of lengths are
// put into memory only if so.
MSPRINGI_INLINE void test_lattice(const mspringi_yield_test *t, size_t place, vec east, vec north, vec north_east,
                                  vec south_east, const float *stiffnesses, size_t part) {
    const float *low = t->test_low + place, *high = t->test_high + place;
    uint32_t out = bits_outside(east, low, high);
    out |= bits_outside(north, low + MSPRINGI_NORTH * MSPRINGI_WIDTH, high + MSPRINGI_NORTH * MSPRINGI_WIDTH);
    out |= bits_outside(north_east, low + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                        high + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH);
    out |= bits_outside(south_east, low + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                        high + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH);
    if (out) {
        const vec squares[] = {east, north, north_east, south_east};
        let_yield(t, place, MSPRINGI_DIRECTIONS, squares, t->lattice_rests + place, stiffnesses, part);
    }
}

#endif
