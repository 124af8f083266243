/// @file bounds.h
/// Whether slots are all within a box, in the vectors of sweep.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BOUNDS_H
#define MSPRINGI_BOUNDS_H

static bool leaves(const float *x, const float *y, size_t count, const mspringi_bounds *bounds) {
    const vec min_x = set(bounds->min_x), max_x = set(bounds->max_x);
    const vec min_y = set(bounds->min_y), max_y = set(bounds->max_y);
    uint32_t outside = 0;
    for (size_t i = 0; i < count; i += LANES) {
        const vec here_x = load(x + i), here_y = load(y + i);
        outside |= bits_greater(min_x, here_x) | bits_greater(here_x, max_x);
        outside |= bits_greater(min_y, here_y) | bits_greater(here_y, max_y);
    }
    return outside != 0;
}

#endif
