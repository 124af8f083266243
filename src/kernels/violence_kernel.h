/// @file violence_kernel.h
/// Search for springs whose ends have very different velocities, in vectors of LANES springs.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_VIOLENCE_KERNEL_H
#define MSPRINGI_VIOLENCE_KERNEL_H

#include "kernels/strain_kernel.h"

MSPRINGI_STRETCH uint32_t differ_by(vec base_x, vec base_y, vec tip_x, vec tip_y, vec square) {
    const vec vx = sub(tip_x, base_x), vy = sub(tip_y, base_y);
    return bits_greater(add(mul(vx, vx), mul(vy, vy)), square);
}

static uint32_t lattice_violence(const mspringi_violence_sweep *sweep, uint32_t first, uint32_t end) {
    const mspringi_violence_sweep copy = *sweep, *const s = &copy;
    const vec square = set(s->square);
    for (uint32_t block = first; block < end; ++block) {
        uint32_t over[MSPRINGI_DIRECTIONS] = {0, 0, 0, 0};
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; lane += LANES) {
            const size_t here = ((size_t)s->lattice_first + block) * MSPRINGI_WIDTH + lane;
            const size_t up = (size_t)s->up_of_block[block] * MSPRINGI_WIDTH + lane;
            const vec x = load(s->vx + here), y = load(s->vy + here);
            const vec next_x = load_unaligned(s->vx + here + 1), next_y = load_unaligned(s->vy + here + 1);
            const vec up_x = load(s->vx + up), up_y = load(s->vy + up);
            const vec up_next_x = load_unaligned(s->vx + up + 1), up_next_y = load_unaligned(s->vy + up + 1);
            over[MSPRINGI_EAST] |= differ_by(x, y, next_x, next_y, square) << lane;
            over[MSPRINGI_NORTH] |= differ_by(x, y, up_x, up_y, square) << lane;
            over[MSPRINGI_NORTH_EAST] |= differ_by(x, y, up_next_x, up_next_y, square) << lane;
            over[MSPRINGI_SOUTH_EAST] |= differ_by(up_x, up_y, next_x, next_y, square) << lane;
        }
        const uint16_t *live = s->live + (size_t)block * MSPRINGI_DIRECTIONS;
        for (size_t direction = 0; direction < MSPRINGI_DIRECTIONS; ++direction)
            if (over[direction] & live[direction])
                return block;
    }
    return end;
}

#endif
