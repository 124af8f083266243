/// @file extrema.h
/// Maxima of absolute values and of motion, in the vectors of sweep.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EXTREMA_H
#define MSPRINGI_EXTREMA_H

static mspringi_largest largest(const float *now, const float *before, size_t count) {
    vec value = zero(), change = zero();
    for (size_t i = 0; !before && i < count; i += LANES)
        value = larger_size(value, load(now + i));
    for (size_t i = 0; before && i < count; i += LANES) {
        const vec v = load(now + i);
        value = larger_size(value, v);
        change = larger_size(change, sub(v, load(before + i)));
    }
    return (mspringi_largest){largest_lane(value), largest_lane(change)};
}

static inline float largest_watched(const float *lanes) {
    vec value = load(lanes);
    for (size_t i = LANES; i < MSPRINGI_WIDTH; i += LANES)
        value = larger_size(value, load(lanes + i));
    return largest_lane(value);
}

static mspringi_extrema extrema_of(const mspringi_extrema_lanes *watch) {
    return (mspringi_extrema){largest_watched(watch->coordinate), largest_watched(watch->speed),
                              largest_watched(watch->change)};
}

#endif
