/// @file scalar_lane.h
/// A vector of one lane, for loops without a scalar form.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SCALAR_LANE_H
#define MSPRINGI_SCALAR_LANE_H

#include <math.h>

#define LANES 1
typedef float vec;
typedef uint32_t mask; ///< of lanes

static inline vec zero(void) {
    return 0.0f;
}
static inline vec set(float value) {
    return value;
}
static inline vec load(const float *from) {
    return *from;
}
static inline vec load_unaligned(const float *from) {
    return *from;
}
static inline void store(float *to, vec a) {
    *to = a;
}
static inline vec add(vec a, vec b) {
    return a + b;
}
static inline vec sub(vec a, vec b) {
    return a - b;
}
static inline vec mul(vec a, vec b) {
    return a * b;
}
static inline vec square_root(vec a) {
    return sqrtf(a);
}
// 1 / square, or 0 without a direction.
static inline vec inverse_or_zero(vec square) {
    return square > MSPRINGI_NO_DIRECTION ? 1.0f / square : 0.0f;
}
// a where selector > 0, else b.
static inline vec choose_positive(vec selector, vec a, vec b) {
    return selector > 0.0f ? a : b;
}
static inline float largest_lane(vec a) {
    return a;
}
// Bit of each lane with a > b.
static inline uint32_t bits_greater(vec a, vec b) {
    return a > b;
}
// Mask of the lanes of a below least or above most.
static inline mask outside(vec a, vec least, vec most) {
    return (uint32_t)(least > a) | (uint32_t)(a > most);
}
static inline mask either(mask a, mask b) {
    return a | b;
}
// Not 0 if any lane is set.
static inline uint32_t any_lane(mask a) {
    return a;
}
// Shift by one lane: the last lane of before, then all lanes of a but its last.
static inline vec shift_in(vec before, vec a) {
    (void)a;
    return before;
}

#endif
