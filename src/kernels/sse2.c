/// SSE2: four lanes. Part of every x86-64 CPU; i386 builds require it.
#include "kernels/kernels.h"

#if defined(MSPRINGI_X86)

#include <emmintrin.h>

#define LANES 4
typedef __m128 vec;
typedef __m128 mask; ///< of lanes

static inline vec zero(void) {
    return _mm_setzero_ps();
}
static inline vec set(float value) {
    return _mm_set1_ps(value);
}
static inline vec load(const float *from) {
    return _mm_load_ps(from);
}
static inline vec load_unaligned(const float *from) {
    return _mm_loadu_ps(from);
}
static inline void store(float *to, vec a) {
    _mm_store_ps(to, a);
}
static inline vec add(vec a, vec b) {
    return _mm_add_ps(a, b);
}
static inline vec sub(vec a, vec b) {
    return _mm_sub_ps(a, b);
}
static inline vec mul(vec a, vec b) {
    return _mm_mul_ps(a, b);
}
static inline vec square_root(vec a) {
    return _mm_sqrt_ps(a);
}
// The leading half of the digits, whose square is exact.
static inline vec leading(vec a) {
    return _mm_and_ps(a, _mm_castsi128_ps(_mm_set1_epi32((int)MSPRINGI_LEADING_BITS)));
}
// a, or 0 where it is tiny; NaN stays.
static inline vec flush_tiny(vec a) {
    return _mm_and_ps(a, _mm_cmpnlt_ps(_mm_and_ps(a, _mm_castsi128_ps(_mm_set1_epi32(0x7fffffff))),
                                       _mm_set1_ps(MSPRINGI_TINY_SPEED)));
}
static inline vec maximum(vec a, vec b) {
    return _mm_max_ps(a, b);
}
static inline vec minimum(vec a, vec b) {
    return _mm_min_ps(a, b);
}
// 1 / square, or 0 without a direction.
static inline vec inverse_or_zero(vec square) {
    return _mm_and_ps(_mm_div_ps(_mm_set1_ps(1.0f), square),
                      _mm_cmpgt_ps(square, _mm_set1_ps(MSPRINGI_NO_DIRECTION)));
}
// a where selector > 0, else b.
static inline vec choose_positive(vec selector, vec a, vec b) {
    const mask is_positive = _mm_cmpgt_ps(selector, _mm_setzero_ps());
    return _mm_or_ps(_mm_and_ps(is_positive, a), _mm_andnot_ps(is_positive, b));
}
// Bit of each lane with a > b.
static inline uint32_t bits_greater(vec a, vec b) {
    return (uint32_t)_mm_movemask_ps(_mm_cmpgt_ps(a, b));
}
// Mask of the lanes of a below least or above most.
static inline mask outside(vec a, vec least, vec most) {
    return _mm_or_ps(_mm_cmplt_ps(a, least), _mm_cmpgt_ps(a, most));
}
static inline mask either(mask a, mask b) {
    return _mm_or_ps(a, b);
}
// Not 0 if any lane is set.
static inline uint32_t any_lane(mask a) {
    return (uint32_t)_mm_movemask_ps(a);
}
// Shift by one lane: the last lane of before, then all lanes of a but its last.
static inline vec shift_in(vec before, vec a) {
    const vec halo = _mm_shuffle_ps(before, a, _MM_SHUFFLE(0, 0, 3, 3));
    return _mm_shuffle_ps(halo, a, _MM_SHUFFLE(2, 1, 2, 0));
}

// Load four values of each of LANES nodes, from [node][4].
static inline void load_gathered(const float *gathered, const uint32_t *nodes, vec *x, vec *y, vec *vx, vec *vy) {
    *x = _mm_load_ps(gathered + 4 * (size_t)nodes[0]);
    *y = _mm_load_ps(gathered + 4 * (size_t)nodes[1]);
    *vx = _mm_load_ps(gathered + 4 * (size_t)nodes[2]);
    *vy = _mm_load_ps(gathered + 4 * (size_t)nodes[3]);
    _MM_TRANSPOSE4_PS(*x, *y, *vx, *vy);
}
static inline void store_gathered(float *gathered, vec x, vec y, vec vx, vec vy) {
    _MM_TRANSPOSE4_PS(x, y, vx, vy);
    _mm_store_ps(gathered, x);
    _mm_store_ps(gathered + 4, y);
    _mm_store_ps(gathered + 8, vx);
    _mm_store_ps(gathered + 12, vy);
}

// Absolute values as integers: the order is that of floats, with NaN above all.
static inline __m128i absolute(vec a) {
    return _mm_and_si128(_mm_castps_si128(a), _mm_set1_epi32(0x7fffffff));
}
static inline __m128i larger(__m128i a, __m128i b) {
    const __m128i first = _mm_cmpgt_epi32(a, b);
    return _mm_or_si128(_mm_and_si128(first, a), _mm_andnot_si128(first, b));
}
static inline float largest_lane(vec a) {
    __m128i bits = _mm_castps_si128(a);
    bits = larger(bits, _mm_shuffle_epi32(bits, _MM_SHUFFLE(1, 0, 3, 2)));
    bits = larger(bits, _mm_shuffle_epi32(bits, _MM_SHUFFLE(2, 3, 0, 1)));
    return _mm_cvtss_f32(_mm_castsi128_ps(bits));
}

// The larger of a and |b|.
static inline vec larger_size(vec a, vec b) {
    return _mm_castsi128_ps(larger(_mm_castps_si128(a), absolute(b)));
}

#include "kernels/sweep.h"

#define MSPRINGI_TABLE mspringi_kernels_sse2
#define MSPRINGI_LEVEL MSPRING_SIMD_SSE2
#include "kernels/kernel_table.h"

#endif
