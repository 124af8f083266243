/// @file strain.h
/// The strain pass of scalar.c, written for vectors of LANES springs; included after sweep.h.
///
/// A spring's stretch |L - rest_length| is compared with strain * rest_length, so there is no division; what
/// happens comes out as bits, one for each lane, and hardly ever are there any.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STRAIN_H
#define MSPRINGI_STRAIN_H

/// Bits of the springs of one word that are over a threshold, or under one.
typedef struct strain_bits {
    uint32_t over_break, over_stress, under_relax;
} strain_bits;

// Compare LANES springs from one slot to another, place being that of the first of them.
MSPRINGI_INLINE void compare(const mspringi_strain_sweep *s, vec base_x, vec base_y, vec tip_x, vec tip_y,
                             const float *rest_lengths, size_t place, strain_bits *bits) {
    const vec dx = sub(tip_x, base_x), dy = sub(tip_y, base_y), rest_length = load(rest_lengths);
    const vec length = square_root(add(mul(dx, dx), mul(dy, dy)));
    // |L - rest_length| > limit if one of these is: they are each other's negative.
    const vec longer = sub(length, rest_length), shorter = sub(rest_length, length);
    const size_t lane = place % MSPRINGI_WIDTH;
    const vec break_at = mul(load(s->break_strain + place), rest_length);
    bits->over_break |= (bits_greater(longer, break_at) | bits_greater(shorter, break_at)) << lane;
    if (!s->stress_strain)
        return;
    const vec stress_at = mul(load(s->stress_strain + place), rest_length),
              relax_at = mul(stress_at, set(s->relax));
    bits->over_stress |= (bits_greater(longer, stress_at) | bits_greater(shorter, stress_at)) << lane;
    bits->under_relax |= (bits_greater(relax_at, longer) & bits_greater(relax_at, shorter)) << lane;
}

// Append what the bits of a word mean, if they mean anything.
MSPRINGI_INLINE uint32_t append_hit(const mspringi_strain_sweep *s, size_t word, strain_bits bits,
                                    mspringi_strain_hit *hits, uint32_t count) {
    const uint32_t live = s->live[word], stressed = s->stressed[word];
    const uint32_t broken = bits.over_break & live, whole = live & ~broken;
    const uint32_t newly = bits.over_stress & whole & ~stressed, relaxed = bits.under_relax & whole & stressed;
    if (broken | newly | relaxed)
        hits[count++] = (mspringi_strain_hit){(uint32_t)word, (uint16_t)broken, (uint16_t)newly, (uint16_t)relaxed};
    return count;
}

static uint32_t lattice_strain(const mspringi_strain_sweep *sweep, uint32_t first, uint32_t end,
                               mspringi_strain_hit *hits) {
    const mspringi_strain_sweep copy = *sweep, *const s = &copy;
    const size_t part = (size_t)s->parts * MSPRINGI_WIDTH; // values of one direction
    uint32_t count = 0;
    for (size_t block = first; block < end; ++block) {
        const size_t word = block * MSPRINGI_DIRECTIONS, place = word * MSPRINGI_WIDTH;
        strain_bits bits[MSPRINGI_DIRECTIONS] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
            const size_t here = (s->lattice_first + block) * MSPRINGI_WIDTH + lane;
            const size_t up = (size_t)s->up_of_block[block] * MSPRINGI_WIDTH + lane;
            const float *rest_lengths = s->lattice_springs + block * MSPRINGI_DIRECTIONS * part + lane;
            const vec x = load(s->x + here), y = load(s->y + here);
            const vec next_x = load_unaligned(s->x + here + 1), next_y = load_unaligned(s->y + here + 1);
            const vec up_x = load(s->x + up), up_y = load(s->y + up);
            const vec up_next_x = load_unaligned(s->x + up + 1), up_next_y = load_unaligned(s->y + up + 1);
            compare(s, x, y, next_x, next_y, rest_lengths, place + lane, &bits[MSPRINGI_EAST]);
            compare(s, x, y, up_x, up_y, rest_lengths + MSPRINGI_NORTH * part,
                    place + MSPRINGI_NORTH * MSPRINGI_WIDTH + lane, &bits[MSPRINGI_NORTH]);
            compare(s, x, y, up_next_x, up_next_y, rest_lengths + MSPRINGI_NORTH_EAST * part,
                    place + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH + lane, &bits[MSPRINGI_NORTH_EAST]);
            compare(s, up_x, up_y, next_x, next_y, rest_lengths + MSPRINGI_SOUTH_EAST * part,
                    place + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH + lane, &bits[MSPRINGI_SOUTH_EAST]);
        }
        for (size_t direction = 0; direction < MSPRINGI_DIRECTIONS; ++direction)
            count = append_hit(s, word + direction, bits[direction], hits, count);
    }
    return count;
}

static uint32_t chain_strain(const mspringi_strain_sweep *sweep, uint32_t first, uint32_t end,
                             mspringi_strain_hit *hits) {
    const mspringi_strain_sweep copy = *sweep, *const s = &copy;
    uint32_t count = 0;
    for (size_t block = first; block < end; ++block) {
        const size_t word = s->chain_word + block;
        strain_bits bits = {0, 0, 0};
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
            const size_t here = (s->chain_first + block) * MSPRINGI_WIDTH + lane;
            compare(s, load(s->x + here), load(s->y + here), load_unaligned(s->x + here + 1),
                    load_unaligned(s->y + here + 1), s->chain_springs + block * s->parts * MSPRINGI_WIDTH + lane,
                    word * MSPRINGI_WIDTH + lane, &bits);
        }
        count = append_hit(s, word, bits, hits, count);
    }
    return count;
}

#endif
