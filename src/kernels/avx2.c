/// AVX2: eight lanes.
#include "kernels/kernels.h"

#if defined(MSPRINGI_X86)

#include <immintrin.h>

#define LANES 8
typedef __m256 vec;
typedef __m256 mask; ///< of lanes

static inline vec zero(void) {
    return _mm256_setzero_ps();
}
static inline vec set(float value) {
    return _mm256_set1_ps(value);
}
static inline vec load(const float *from) {
    return _mm256_load_ps(from);
}
static inline vec load_unaligned(const float *from) {
    return _mm256_loadu_ps(from);
}
static inline void store(float *to, vec a) {
    _mm256_store_ps(to, a);
}
static inline vec add(vec a, vec b) {
    return _mm256_add_ps(a, b);
}
static inline vec sub(vec a, vec b) {
    return _mm256_sub_ps(a, b);
}
static inline vec mul(vec a, vec b) {
    return _mm256_mul_ps(a, b);
}
static inline vec square_root(vec a) {
    return _mm256_sqrt_ps(a);
}
// The leading half of the digits, whose square is exact.
static inline vec leading(vec a) {
    return _mm256_and_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32((int)MSPRINGI_LEADING_BITS)));
}
// a, or 0 where it is tiny; NaN stays.
static inline vec flush_tiny(vec a) {
    return _mm256_and_ps(a, _mm256_cmp_ps(_mm256_and_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(0x7fffffff))),
                                          _mm256_set1_ps(MSPRINGI_TINY_SPEED), _CMP_NLT_UQ));
}
static inline vec maximum(vec a, vec b) {
    return _mm256_max_ps(a, b);
}
static inline vec minimum(vec a, vec b) {
    return _mm256_min_ps(a, b);
}
// 1 / square, or 0 without a direction.
static inline vec inverse_or_zero(vec square) {
    return _mm256_and_ps(_mm256_div_ps(_mm256_set1_ps(1.0f), square),
                         _mm256_cmp_ps(square, _mm256_set1_ps(MSPRINGI_NO_DIRECTION), _CMP_GT_OQ));
}
// a where selector > 0, else b.
static inline vec choose_positive(vec selector, vec a, vec b) {
    return _mm256_blendv_ps(b, a, _mm256_cmp_ps(selector, _mm256_setzero_ps(), _CMP_GT_OQ));
}
// Bit of each lane with a > b.
static inline uint32_t bits_greater(vec a, vec b) {
    return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_GT_OQ));
}
// Mask of the lanes of a below least or above most.
static inline mask outside(vec a, vec least, vec most) {
    return _mm256_or_ps(_mm256_cmp_ps(a, least, _CMP_LT_OQ), _mm256_cmp_ps(a, most, _CMP_GT_OQ));
}
static inline mask either(mask a, mask b) {
    return _mm256_or_ps(a, b);
}
// Not 0 if any lane is set.
static inline uint32_t any_lane(mask a) {
    return (uint32_t)_mm256_movemask_ps(a);
}
// Shift by one lane: the last lane of before, then all lanes of a but its last.
static inline vec shift_in(vec before, vec a) {
    const __m256i halo =
        _mm256_castps_si256(_mm256_permute2f128_ps(a, before, 0x03)); // upper of before, lower of a
    return _mm256_castsi256_ps(_mm256_alignr_epi8(_mm256_castps_si256(a), halo, 12));
}

// Transpose the two 4 x 4 halves.
static inline void transpose(vec *a, vec *b, vec *c, vec *d) {
    const vec ab_low = _mm256_unpacklo_ps(*a, *b), ab_high = _mm256_unpackhi_ps(*a, *b);
    const vec cd_low = _mm256_unpacklo_ps(*c, *d), cd_high = _mm256_unpackhi_ps(*c, *d);
    *a = _mm256_shuffle_ps(ab_low, cd_low, _MM_SHUFFLE(1, 0, 1, 0));
    *b = _mm256_shuffle_ps(ab_low, cd_low, _MM_SHUFFLE(3, 2, 3, 2));
    *c = _mm256_shuffle_ps(ab_high, cd_high, _MM_SHUFFLE(1, 0, 1, 0));
    *d = _mm256_shuffle_ps(ab_high, cd_high, _MM_SHUFFLE(3, 2, 3, 2));
}
static inline vec load_two(const float *gathered, uint32_t low, uint32_t high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(gathered + 4 * (size_t)low)),
                                _mm_load_ps(gathered + 4 * (size_t)high), 1);
}
// Load four values of each of LANES nodes, from [node][4].
static inline void load_gathered(const float *gathered, const uint32_t *nodes, vec *x, vec *y, vec *vx, vec *vy) {
    *x = load_two(gathered, nodes[0], nodes[4]);
    *y = load_two(gathered, nodes[1], nodes[5]);
    *vx = load_two(gathered, nodes[2], nodes[6]);
    *vy = load_two(gathered, nodes[3], nodes[7]);
    transpose(x, y, vx, vy);
}
static inline void store_gathered(float *gathered, vec x, vec y, vec vx, vec vy) {
    transpose(&x, &y, &vx, &vy);
    const vec nodes[] = {x, y, vx, vy};
    for (int i = 0; i < 4; ++i) {
        _mm_store_ps(gathered + 4 * i, _mm256_castps256_ps128(nodes[i]));
        _mm_store_ps(gathered + 4 * i + 16, _mm256_extractf128_ps(nodes[i], 1));
    }
}

// Absolute values as integers: the order is that of floats, with NaN above all.
static inline __m256i absolute(vec a) {
    return _mm256_and_si256(_mm256_castps_si256(a), _mm256_set1_epi32(0x7fffffff));
}
static inline float largest_lane(vec a) {
    const __m256i bits = _mm256_castps_si256(a);
    __m128i half = _mm_max_epi32(_mm256_castsi256_si128(bits), _mm256_extracti128_si256(bits, 1));
    half = _mm_max_epi32(half, _mm_shuffle_epi32(half, _MM_SHUFFLE(1, 0, 3, 2)));
    half = _mm_max_epi32(half, _mm_shuffle_epi32(half, _MM_SHUFFLE(2, 3, 0, 1)));
    return _mm_cvtss_f32(_mm_castsi128_ps(half));
}

// The larger of a and |b|.
static inline vec larger_size(vec a, vec b) {
    return _mm256_castsi256_ps(_mm256_max_epi32(_mm256_castps_si256(a), absolute(b)));
}

#include "kernels/sweep.h"

#define MSPRINGI_TABLE mspringi_kernels_avx2
#define MSPRINGI_LEVEL MSPRING_SIMD_AVX2
#include "kernels/kernel_table.h"

#endif
