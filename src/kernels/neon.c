/// NEON: four lanes. Part of every 64-bit ARM CPU.
#include "kernels/kernels.h"

#if defined(MSPRINGI_AARCH64)

#include <arm_neon.h>

#define LANES 4
typedef float32x4_t vec;
typedef uint32x4_t mask; ///< of lanes

static inline vec zero(void) {
    return vdupq_n_f32(0.0f);
}
static inline vec set(float value) {
    return vdupq_n_f32(value);
}
static inline vec load(const float *from) {
    return vld1q_f32(from);
}
static inline vec load_unaligned(const float *from) {
    return vld1q_f32(from);
}
static inline void store(float *to, vec a) {
    vst1q_f32(to, a);
}
static inline vec add(vec a, vec b) {
    return vaddq_f32(a, b);
}
static inline vec sub(vec a, vec b) {
    return vsubq_f32(a, b);
}
static inline vec mul(vec a, vec b) {
    return vmulq_f32(a, b);
}
static inline vec square_root(vec a) {
    return vsqrtq_f32(a);
}
// The leading half of the digits, whose square is exact.
static inline vec leading(vec a) {
    return vreinterpretq_f32_u32(vandq_u32(vreinterpretq_u32_f32(a), vdupq_n_u32(MSPRINGI_LEADING_BITS)));
}
// a, or 0 where it is tiny; NaN stays.
static inline vec flush_tiny(vec a) {
    return vreinterpretq_f32_u32(
        vbicq_u32(vreinterpretq_u32_f32(a), vcltq_f32(vabsq_f32(a), vdupq_n_f32(MSPRINGI_TINY_SPEED))));
}
static inline vec maximum(vec a, vec b) {
    return vmaxq_f32(a, b);
}
static inline vec minimum(vec a, vec b) {
    return vminq_f32(a, b);
}
// 1 / square, or 0 without a direction.
static inline vec inverse_or_zero(vec square) {
    const uint32x4_t inverse = vreinterpretq_u32_f32(vdivq_f32(vdupq_n_f32(1.0f), square));
    return vreinterpretq_f32_u32(vandq_u32(inverse, vcgtq_f32(square, vdupq_n_f32(MSPRINGI_NO_DIRECTION))));
}
// a where selector > 0, else b.
static inline vec choose_positive(vec selector, vec a, vec b) {
    return vbslq_f32(vcgtzq_f32(selector), a, b);
}
// Bit of each lane with a > b.
static inline uint32_t bits_greater(vec a, vec b) {
    static const uint32_t bits[LANES] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(vcgtq_f32(a, b), vld1q_u32(bits)));
}
// Mask of the lanes of a below least or above most.
static inline mask outside(vec a, vec least, vec most) {
    return vorrq_u32(vcgtq_f32(least, a), vcgtq_f32(a, most));
}
static inline mask either(mask a, mask b) {
    return vorrq_u32(a, b);
}
// Not 0 if any lane is set.
static inline uint32_t any_lane(mask a) {
    return vmaxvq_u32(a);
}
// Shift by one lane: the last lane of before, then all lanes of a but its last.
static inline vec shift_in(vec before, vec a) {
    return vextq_f32(before, a, 3);
}

static inline vec first_halves(vec a, vec b) {
    return vcombine_f32(vget_low_f32(a), vget_low_f32(b));
}
static inline vec second_halves(vec a, vec b) {
    return vcombine_f32(vget_high_f32(a), vget_high_f32(b));
}
// Load four values of each of LANES nodes, from [node][4].
static inline void load_gathered(const float *gathered, const uint32_t *nodes, vec *x, vec *y, vec *vx, vec *vy) {
    const vec a = vld1q_f32(gathered + 4 * (size_t)nodes[0]), b = vld1q_f32(gathered + 4 * (size_t)nodes[1]);
    const vec c = vld1q_f32(gathered + 4 * (size_t)nodes[2]), d = vld1q_f32(gathered + 4 * (size_t)nodes[3]);
    const vec ab_even = vtrn1q_f32(a, b), ab_odd = vtrn2q_f32(a, b);
    const vec cd_even = vtrn1q_f32(c, d), cd_odd = vtrn2q_f32(c, d);
    *x = first_halves(ab_even, cd_even);
    *y = first_halves(ab_odd, cd_odd);
    *vx = second_halves(ab_even, cd_even);
    *vy = second_halves(ab_odd, cd_odd);
}
static inline void store_gathered(float *gathered, vec x, vec y, vec vx, vec vy) {
    const float32x4x4_t nodes = {{x, y, vx, vy}};
    vst4q_f32(gathered, nodes);
}

// The larger of a and |b|; the maximum of NaN and a number is NaN here.
static inline vec larger_size(vec a, vec b) {
    return vmaxq_f32(a, vabsq_f32(b));
}

static inline float largest_lane(vec a) {
    return vmaxvq_f32(a);
}

#include "kernels/sweep.h"

#define MSPRINGI_TABLE mspringi_kernels_neon
#define MSPRINGI_LEVEL MSPRING_SIMD_NEON
#include "kernels/kernel_table.h"

#endif
