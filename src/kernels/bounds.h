/// @file bounds.h
/// Search for slots outside a box, in the vectors of sweep.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BOUNDS_H
#define MSPRINGI_BOUNDS_H

static size_t beyond(const float *x, const float *y, size_t first, size_t end, const mspringi_bounds *bounds) {
    const vec min_x = set(bounds->min_x), max_x = set(bounds->max_x);
    const vec min_y = set(bounds->min_y), max_y = set(bounds->max_y);
    for (size_t block = first; block < end; block += MSPRINGI_WIDTH) {
        uint32_t any = 0;
        for (size_t i = block; i < block + MSPRINGI_WIDTH; i += LANES) {
            any |= any_lane(either(outside(load(x + i), min_x, max_x), outside(load(y + i), min_y, max_y)));
        }
        if (any)
            return block;
    }
    return end;
}

#endif
