/// @file strain.h
/// The strain pass: finding the few springs that are stretched so far that something may happen, for vectors of
/// LANES springs.
///
/// A spring's stretch |L - rest_length| is compared with strain * rest_length, so there is no division; what comes
/// out is a bit for each lane, and hardly ever are there any. What they mean is found one by one, by whoever
/// called.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STRAIN_H
#define MSPRINGI_STRAIN_H

#if defined(_MSC_VER)
#define MSPRINGI_STRETCH static __forceinline
#else
#define MSPRINGI_STRETCH static inline __attribute__((always_inline))
#endif

// Bits of LANES springs, dead ones among them, that are stretched by more than their least.
MSPRINGI_STRETCH uint32_t over_least(vec base_x, vec base_y, vec tip_x, vec tip_y, const float *rest_lengths,
                                     const float *least) {
    const vec dx = sub(tip_x, base_x), dy = sub(tip_y, base_y), rest_length = load(rest_lengths);
    const vec length = square_root(add(mul(dx, dx), mul(dy, dy))), limit = mul(load(least), rest_length);
    // |L - rest_length| > limit if one of these is: they are each other's negative.
    return bits_greater(sub(length, rest_length), limit) | bits_greater(sub(rest_length, length), limit);
}

MSPRINGI_STRETCH uint32_t append_hit(const mspringi_strain_sweep *s, size_t word, uint32_t over,
                                     mspringi_strain_hit *hits, uint32_t count) {
    const uint32_t bits = (over & s->live[word]) | s->stressed[word];
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
        for (size_t direction = 0; direction < MSPRINGI_DIRECTIONS; ++direction)
            count = append_hit(s, word + direction, over[direction], hits, count);
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
        count = append_hit(s, word, over, hits, count);
    }
    return count;
}

#endif
