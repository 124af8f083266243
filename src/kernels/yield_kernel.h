/// @file yield_kernel.h
/// Search for springs that may yield, in vectors of LANES springs: squared lengths against two bounds, without root
/// or division. The caller handles hits one by one.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_YIELD_KERNEL_H
#define MSPRINGI_YIELD_KERNEL_H

#include "kernels/strain_kernel.h"

// Bits of LANES springs, broken ones included, that are outside their bounds.
MSPRINGI_STRETCH uint32_t out_of_bounds(vec base_x, vec base_y, vec tip_x, vec tip_y, const float *low,
                                        const float *high) {
    const vec dx = sub(tip_x, base_x), dy = sub(tip_y, base_y);
    const vec square = add(mul(dx, dx), mul(dy, dy));
    return bits_greater(square, load(high)) | bits_greater(load(low), square);
}

MSPRINGI_STRETCH uint32_t append_warm(const mspringi_yield_sweep *s, size_t word, uint32_t out,
                                      mspringi_strain_hit *hits, uint32_t count) {
    const uint32_t bits = out & s->live[word];
    if (bits)
        hits[count++] = (mspringi_strain_hit){(uint32_t)word, bits};
    return count;
}

static uint32_t lattice_yield(const mspringi_yield_sweep *sweep, uint32_t first, uint32_t end,
                              mspringi_strain_hit *hits) {
    const mspringi_yield_sweep copy = *sweep, *const s = &copy;
    uint32_t count = 0;
    for (size_t block = first; block < end; ++block) {
        const size_t word = block * MSPRINGI_DIRECTIONS;
        uint32_t east = 0, north = 0, north_east = 0, south_east = 0;
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
            const size_t here = (s->lattice_first + block) * MSPRINGI_WIDTH + lane;
            const size_t up = (size_t)s->up_of_block[block] * MSPRINGI_WIDTH + lane;
            const float *low = s->low + word * MSPRINGI_WIDTH + lane,
                        *high = s->high + word * MSPRINGI_WIDTH + lane;
            const vec x = load(s->x + here), y = load(s->y + here);
            const vec next_x = load_unaligned(s->x + here + 1), next_y = load_unaligned(s->y + here + 1);
            const vec up_x = load(s->x + up), up_y = load(s->y + up);
            const vec up_next_x = load_unaligned(s->x + up + 1), up_next_y = load_unaligned(s->y + up + 1);
            east |= out_of_bounds(x, y, next_x, next_y, low + MSPRINGI_EAST * MSPRINGI_WIDTH,
                                  high + MSPRINGI_EAST * MSPRINGI_WIDTH)
                    << lane;
            north |= out_of_bounds(x, y, up_x, up_y, low + MSPRINGI_NORTH * MSPRINGI_WIDTH,
                                   high + MSPRINGI_NORTH * MSPRINGI_WIDTH)
                     << lane;
            north_east |= out_of_bounds(x, y, up_next_x, up_next_y, low + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH,
                                        high + MSPRINGI_NORTH_EAST * MSPRINGI_WIDTH)
                          << lane;
            south_east |= out_of_bounds(up_x, up_y, next_x, next_y, low + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH,
                                        high + MSPRINGI_SOUTH_EAST * MSPRINGI_WIDTH)
                          << lane;
        }
        if ((east | north | north_east | south_east) == 0)
            continue;
        count = append_warm(s, word + MSPRINGI_EAST, east, hits, count);
        count = append_warm(s, word + MSPRINGI_NORTH, north, hits, count);
        count = append_warm(s, word + MSPRINGI_NORTH_EAST, north_east, hits, count);
        count = append_warm(s, word + MSPRINGI_SOUTH_EAST, south_east, hits, count);
    }
    return count;
}

static uint32_t chain_yield(const mspringi_yield_sweep *sweep, uint32_t first, uint32_t end,
                            mspringi_strain_hit *hits) {
    const mspringi_yield_sweep copy = *sweep, *const s = &copy;
    uint32_t count = 0;
    for (size_t block = first; block < end; ++block) {
        const size_t word = s->chain_word + block;
        uint32_t out = 0;
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
            const size_t here = (s->chain_first + block) * MSPRINGI_WIDTH + lane;
            const size_t spring_slot = word * MSPRINGI_WIDTH + lane;
            out |= out_of_bounds(load(s->x + here), load(s->y + here), load_unaligned(s->x + here + 1),
                                 load_unaligned(s->y + here + 1), s->low + spring_slot, s->high + spring_slot)
                   << lane;
        }
        count = append_warm(s, word, out, hits, count);
    }
    return count;
}

#endif
