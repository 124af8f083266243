/// @file strain_kernel.h
/// The strain pass: finds the few springs with a strain that matters, in vectors of LANES springs.
///
/// It compares the stretch |L - rest_length| with strain * rest_length, without a division. The result is one bit
/// for each lane, rarely set. The caller handles these springs one by one. Stressed springs stay stressed for long,
/// so they are tested further here.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STRAIN_KERNEL_H
#define MSPRINGI_STRAIN_KERNEL_H

#include "base/cpu.h"

#if defined(_MSC_VER)
#define MSPRINGI_STRETCH static __forceinline
#else
#define MSPRINGI_STRETCH static inline __attribute__((always_inline))
#endif

// Bits of LANES springs, broken ones included, with a stretch above a limit: |stretch| is the larger of it and its
// negative.
MSPRINGI_STRETCH uint32_t over_limit(vec stretch, vec negative, vec limit) {
    return bits_greater(stretch, limit) | bits_greater(negative, limit);
}

MSPRINGI_STRETCH uint32_t under_limit(vec stretch, vec negative, vec limit) {
    return bits_greater(limit, stretch) & bits_greater(limit, negative);
}

MSPRINGI_STRETCH vec length_between(vec base_x, vec base_y, vec tip_x, vec tip_y) {
    const vec dx = sub(tip_x, base_x), dy = sub(tip_y, base_y);
    return square_root(add(mul(dx, dx), mul(dy, dy)));
}

// Bits of LANES springs, broken ones included, that are stretched by more than their least strain.
MSPRINGI_STRETCH uint32_t over_least(vec base_x, vec base_y, vec tip_x, vec tip_y, const float *rest_lengths,
                                     const float *least) {
    const vec length = length_between(base_x, base_y, tip_x, tip_y), rest_length = load(rest_lengths);
    return over_limit(sub(length, rest_length), sub(rest_length, length), mul(load(least), rest_length));
}

// Bits of the stressed springs that break or relax, of a word of springs from the slots at base to those at tip.
static MSPRINGI_NOINLINE uint32_t test_stressed(const mspringi_strain_sweep *s, size_t word, size_t base,
                                                size_t tip, const float *rest_lengths) {
    uint32_t bits = 0;
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
        const size_t spring_slot = word * MSPRINGI_WIDTH + lane;
        const vec length = length_between(load_unaligned(s->x + base + lane), load_unaligned(s->y + base + lane),
                                          load_unaligned(s->x + tip + lane), load_unaligned(s->y + tip + lane));
        const vec rest_length = load(rest_lengths + lane);
        const vec stretch = sub(length, rest_length), negative = sub(rest_length, length);
        const vec stress = mul(load(s->stress + spring_slot), rest_length);
        const uint32_t breaks =
            over_limit(stretch, negative, mul(load(s->break_strain + spring_slot), rest_length));
        uint32_t relaxes = under_limit(stretch, negative, mul(stress, set(s->relax_fraction)));
        if (s->relax) {
            const vec relax = load(s->relax + spring_slot);
            const uint32_t has_fraction = bits_greater(zero(), relax);
            relaxes = (relaxes & has_fraction) | (under_limit(stretch, negative, mul(relax, rest_length)) &
                                                  under_limit(stretch, negative, stress) & ~has_fraction);
        }
        bits |= (breaks | relaxes) << lane;
    }
    return bits;
}

/// Distance in blocks at which thresholds of stressed springs are prefetched.
#define STRAIN_AHEAD 4

MSPRINGI_STRETCH void fetch_thresholds(const mspringi_strain_sweep *s, size_t word) {
    if (s->stressed[word] && s->stress) {
        MSPRINGI_PREFETCH(s->break_strain + word * MSPRINGI_WIDTH);
        MSPRINGI_PREFETCH(s->stress + word * MSPRINGI_WIDTH);
    }
}

MSPRINGI_STRETCH uint32_t append_hit(const mspringi_strain_sweep *s, size_t word, uint32_t over, size_t base,
                                     size_t tip, const float *rest_lengths, mspringi_strain_hit *hits,
                                     uint32_t count) {
    const uint32_t stressed = s->stressed[word];
    uint32_t bits = over & s->live[word];
    if (stressed)
        bits = (bits & ~stressed) |
               (s->stress ? stressed & test_stressed(s, word, base, tip, rest_lengths) : stressed);
    if (bits)
        hits[count++] = (mspringi_strain_hit){(uint32_t)word, bits};
    return count;
}

static uint32_t lattice_strain(const mspringi_strain_sweep *sweep, uint32_t first, uint32_t end,
                               mspringi_strain_hit *hits) {
    const mspringi_strain_sweep copy = *sweep, *const s = &copy;
    uint32_t count = 0;
    for (size_t block = first; block < end; ++block) {
        const size_t word = block * MSPRINGI_DIRECTIONS;
        uint32_t over[MSPRINGI_DIRECTIONS] = {0, 0, 0, 0};
        for (size_t direction = 0; block + STRAIN_AHEAD < end && direction < MSPRINGI_DIRECTIONS; ++direction)
            fetch_thresholds(s, word + STRAIN_AHEAD * MSPRINGI_DIRECTIONS + direction);
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
            const size_t here = (s->lattice_first + block) * MSPRINGI_WIDTH + lane;
            const size_t up = (size_t)s->up_of_block[block] * MSPRINGI_WIDTH + lane;
            const float *rest_lengths =
                s->rest_lengths + (size_t)s->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH + lane;
            const float *least = s->least + word * MSPRINGI_WIDTH + lane;
            const vec x = load(s->x + here), y = load(s->y + here);
            const vec next_x = load_unaligned(s->x + here + 1), next_y = load_unaligned(s->y + here + 1);
            const vec up_x = load(s->x + up), up_y = load(s->y + up);
            const vec up_next_x = load_unaligned(s->x + up + 1), up_next_y = load_unaligned(s->y + up + 1);
            over[MSPRINGI_EAST] |= over_least(x, y, next_x, next_y, rest_lengths, least) << lane;
            over[MSPRINGI_NORTH] |= over_least(x, y, up_x, up_y, rest_lengths + MSPRINGI_NORTH * MSPRINGI_WIDTH,
                                               least + MSPRINGI_NORTH * MSPRINGI_WIDTH)
                                    << lane;
            over[MSPRINGI_NORTH_EAST] |=
                over_least(x, y, up_next_x, up_next_y, rest_lengths + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                           least + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH)
                << lane;
            over[MSPRINGI_SOUTH_EAST] |=
                over_least(up_x, up_y, next_x, next_y, rest_lengths + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                           least + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH)
                << lane;
        }
        const size_t here = (s->lattice_first + block) * MSPRINGI_WIDTH;
        const size_t up = (size_t)s->up_of_block[block] * MSPRINGI_WIDTH;
        const size_t bases[] = {here, here, here, up}, tips[] = {here + 1, up, up + 1, here + 1};
        const float *rest_lengths =
            s->rest_lengths + (size_t)s->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
        for (size_t direction = 0; direction < MSPRINGI_DIRECTIONS; ++direction)
            count = append_hit(s, word + direction, over[direction], bases[direction], tips[direction],
                               rest_lengths + direction * MSPRINGI_WIDTH, hits, count);
    }
    return count;
}

static uint32_t chain_strain(const mspringi_strain_sweep *sweep, uint32_t first, uint32_t end,
                             mspringi_strain_hit *hits) {
    const mspringi_strain_sweep copy = *sweep, *const s = &copy;
    uint32_t count = 0;
    for (size_t block = first; block < end; ++block) {
        const size_t word = s->chain_word + block;
        uint32_t over = 0;
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
            const size_t here = (s->chain_first + block) * MSPRINGI_WIDTH + lane;
            over |= over_least(load(s->x + here), load(s->y + here), load_unaligned(s->x + here + 1),
                               load_unaligned(s->y + here + 1),
                               s->chain_springs + block * s->parts * MSPRINGI_WIDTH + lane,
                               s->least + word * MSPRINGI_WIDTH + lane)
                    << lane;
        }
        const size_t first_slot = (s->chain_first + block) * MSPRINGI_WIDTH;
        count = append_hit(s, word, over, first_slot, first_slot + 1,
                           s->chain_springs + block * s->parts * MSPRINGI_WIDTH, hits, count);
    }
    return count;
}

#endif
