/// WebAssembly SIMD: four lanes. A build-time choice: a module cannot test for it at run time.
#include "kernels/kernels.h"

#if defined(MSPRINGI_WASM)

#include <wasm_simd128.h>

#define LANES 4
typedef v128_t vec;
typedef v128_t mask; ///< of lanes

static inline vec zero(void) {
    return wasm_f32x4_splat(0.0f);
}
static inline vec set(float value) {
    return wasm_f32x4_splat(value);
}
static inline vec load(const float *from) {
    return wasm_v128_load(from);
}
static inline vec load_unaligned(const float *from) {
    return wasm_v128_load(from);
}
static inline void store(float *to, vec a) {
    wasm_v128_store(to, a);
}
static inline vec add(vec a, vec b) {
    return wasm_f32x4_add(a, b);
}
static inline vec sub(vec a, vec b) {
    return wasm_f32x4_sub(a, b);
}
static inline vec mul(vec a, vec b) {
    return wasm_f32x4_mul(a, b);
}
static inline vec square_root(vec a) {
    return wasm_f32x4_sqrt(a);
}
// The leading half of the digits, whose square is exact.
static inline vec leading(vec a) {
    return wasm_v128_and(a, wasm_i32x4_splat((int)MSPRINGI_LEADING_BITS));
}
// a, or 0 where it is tiny; NaN stays.
static inline vec flush_tiny(vec a) {
    return wasm_v128_andnot(a, wasm_f32x4_lt(wasm_f32x4_abs(a), wasm_f32x4_splat(MSPRINGI_TINY_SPEED)));
}
static inline vec maximum(vec a, vec b) {
    return wasm_f32x4_pmax(b, a);
}
static inline vec minimum(vec a, vec b) {
    return wasm_f32x4_pmin(b, a);
}
// 1 / square, or 0 without a direction.
static inline vec inverse_or_zero(vec square) {
    return wasm_v128_and(wasm_f32x4_div(wasm_f32x4_splat(1.0f), square),
                         wasm_f32x4_gt(square, wasm_f32x4_splat(MSPRINGI_NO_DIRECTION)));
}
// a where selector > 0, else b.
static inline vec choose_positive(vec selector, vec a, vec b) {
    return wasm_v128_bitselect(a, b, wasm_f32x4_gt(selector, wasm_f32x4_splat(0.0f)));
}
// Bit of each lane with a > b.
static inline uint32_t bits_greater(vec a, vec b) {
    return (uint32_t)wasm_i32x4_bitmask(wasm_f32x4_gt(a, b));
}
// Mask of the lanes of a below least or above most.
static inline mask outside(vec a, vec least, vec most) {
    return wasm_v128_or(wasm_f32x4_gt(least, a), wasm_f32x4_gt(a, most));
}
static inline mask either(mask a, mask b) {
    return wasm_v128_or(a, b);
}
// Not 0 if any lane is set.
static inline uint32_t any_lane(mask a) {
    return wasm_v128_any_true(a);
}
// Shift by one lane: the last lane of before, then all lanes of a but its last.
static inline vec shift_in(vec before, vec a) {
    return wasm_i32x4_shuffle(before, a, 3, 4, 5, 6);
}

static inline void transpose(vec *a, vec *b, vec *c, vec *d) {
    const vec ab_low = wasm_i32x4_shuffle(*a, *b, 0, 4, 1, 5), ab_high = wasm_i32x4_shuffle(*a, *b, 2, 6, 3, 7);
    const vec cd_low = wasm_i32x4_shuffle(*c, *d, 0, 4, 1, 5), cd_high = wasm_i32x4_shuffle(*c, *d, 2, 6, 3, 7);
    *a = wasm_i32x4_shuffle(ab_low, cd_low, 0, 1, 4, 5);
    *b = wasm_i32x4_shuffle(ab_low, cd_low, 2, 3, 6, 7);
    *c = wasm_i32x4_shuffle(ab_high, cd_high, 0, 1, 4, 5);
    *d = wasm_i32x4_shuffle(ab_high, cd_high, 2, 3, 6, 7);
}
// Load four values of each of LANES nodes, from [node][4].
static inline void load_gathered(const float *gathered, const uint32_t *nodes, vec *x, vec *y, vec *vx, vec *vy) {
    *x = wasm_v128_load(gathered + 4 * (size_t)nodes[0]);
    *y = wasm_v128_load(gathered + 4 * (size_t)nodes[1]);
    *vx = wasm_v128_load(gathered + 4 * (size_t)nodes[2]);
    *vy = wasm_v128_load(gathered + 4 * (size_t)nodes[3]);
    transpose(x, y, vx, vy);
}
static inline void store_gathered(float *gathered, vec x, vec y, vec vx, vec vy) {
    transpose(&x, &y, &vx, &vy);
    wasm_v128_store(gathered, x);
    wasm_v128_store(gathered + 4, y);
    wasm_v128_store(gathered + 8, vx);
    wasm_v128_store(gathered + 12, vy);
}

// Compared as integers, NaN is above infinity. As floats the result would depend on the host's processor.
static inline float largest_lane(vec a) {
    a = wasm_i32x4_max(a, wasm_i32x4_shuffle(a, a, 2, 3, 0, 1));
    a = wasm_i32x4_max(a, wasm_i32x4_shuffle(a, a, 1, 0, 3, 2));
    return wasm_f32x4_extract_lane(a, 0);
}

// The larger of a and |b|.
static inline vec larger_size(vec a, vec b) {
    return wasm_i32x4_max(a, wasm_f32x4_abs(b));
}

#include "kernels/sweep.h"

#define MSPRINGI_TABLE mspringi_kernels_wasm
#define MSPRINGI_LEVEL MSPRING_SIMD_WASM
#include "kernels/kernel_table.h"

#endif
