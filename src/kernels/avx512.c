/// AVX-512 (F only): sixteen lanes.
#include "kernels/kernels.h"

#if defined(MSPRINGI_X86)

#include <immintrin.h>

#define LANES 16
// Behind code, so that massspring.c has it with the instructions of this file.
#include "kernels/inverse_avx512.h"

typedef __m512 vec;
typedef __mmask16 mask; ///< of lanes

static inline vec zero(void) {
    return _mm512_setzero_ps();
}
static inline vec set(float value) {
    return _mm512_set1_ps(value);
}
static inline vec load(const float *from) {
    return _mm512_load_ps(from);
}
static inline vec load_unaligned(const float *from) {
    return _mm512_loadu_ps(from);
}
static inline void store(float *to, vec a) {
    _mm512_store_ps(to, a);
}
static inline vec add(vec a, vec b) {
    return _mm512_add_ps(a, b);
}
static inline vec sub(vec a, vec b) {
    return _mm512_sub_ps(a, b);
}
static inline vec mul(vec a, vec b) {
    return _mm512_mul_ps(a, b);
}
static inline vec square_root(vec a) {
    return _mm512_sqrt_ps(a);
}
// The leading half of the digits, whose square is exact.
static inline vec leading(vec a) {
    return _mm512_castsi512_ps(
        _mm512_and_si512(_mm512_castps_si512(a), _mm512_set1_epi32((int)MSPRINGI_LEADING_BITS)));
}
// a, or 0 where it is tiny; NaN stays.
static inline vec flush_tiny(vec a) {
    return _mm512_maskz_mov_ps(_mm512_cmp_ps_mask(_mm512_castsi512_ps(_mm512_and_si512(
                                                      _mm512_castps_si512(a), _mm512_set1_epi32(0x7fffffff))),
                                                  _mm512_set1_ps(MSPRINGI_TINY_SPEED), _CMP_NLT_UQ),
                               a);
}
static inline vec maximum(vec a, vec b) {
    return _mm512_max_ps(a, b);
}
static inline vec minimum(vec a, vec b) {
    return _mm512_min_ps(a, b);
}
// a where selector > 0, else b.
static inline vec choose_positive(vec selector, vec a, vec b) {
    return _mm512_mask_blend_ps(_mm512_cmp_ps_mask(selector, _mm512_setzero_ps(), _CMP_GT_OQ), b, a);
}
// Bit of each lane with a > b.
static inline uint32_t bits_greater(vec a, vec b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ);
}
// Mask of the lanes of a below least or above most.
static inline mask outside(vec a, vec least, vec most) {
    return (mask)(_mm512_cmp_ps_mask(a, least, _CMP_LT_OQ) | _mm512_cmp_ps_mask(a, most, _CMP_GT_OQ));
}
static inline mask either(mask a, mask b) {
    return (mask)(a | b);
}
// Not 0 if any lane is set.
static inline uint32_t any_lane(mask a) {
    return a;
}
// Shift by one lane: the last lane of before, then all lanes of a but its last.
static inline vec shift_in(vec before, vec a) {
    return _mm512_castsi512_ps(_mm512_alignr_epi32(_mm512_castps_si512(a), _mm512_castps_si512(before), 15));
}

// Transpose the four 4 x 4 quarters.
static inline void transpose(vec *a, vec *b, vec *c, vec *d) {
    const vec ab_low = _mm512_unpacklo_ps(*a, *b), ab_high = _mm512_unpackhi_ps(*a, *b);
    const vec cd_low = _mm512_unpacklo_ps(*c, *d), cd_high = _mm512_unpackhi_ps(*c, *d);
    *a = _mm512_shuffle_ps(ab_low, cd_low, _MM_SHUFFLE(1, 0, 1, 0));
    *b = _mm512_shuffle_ps(ab_low, cd_low, _MM_SHUFFLE(3, 2, 3, 2));
    *c = _mm512_shuffle_ps(ab_high, cd_high, _MM_SHUFFLE(1, 0, 1, 0));
    *d = _mm512_shuffle_ps(ab_high, cd_high, _MM_SHUFFLE(3, 2, 3, 2));
}
static inline __m256 load_two(const float *gathered, uint32_t low, uint32_t high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(gathered + 4 * (size_t)low)),
                                _mm_load_ps(gathered + 4 * (size_t)high), 1);
}
// Load the nodes first, first + 4, first + 8 and first + 12 of a list. Two halves take 5 % less time than four
// quarters, since an insertion into 512 bits takes two cycles.
static inline vec load_four(const float *gathered, const uint32_t *nodes) {
    const __m256 low = load_two(gathered, nodes[0], nodes[4]), high = load_two(gathered, nodes[8], nodes[12]);
    return _mm512_castpd_ps(
        _mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(low)), _mm256_castps_pd(high), 1));
}
// Load four values of each of LANES nodes, from [node][4]. Inline: as a call it makes a random graph a third
// slower.
MSPRINGI_INLINE void load_gathered(const float *gathered, const uint32_t *nodes, vec *x, vec *y, vec *vx, vec *vy) {
    *x = load_four(gathered, nodes);
    *y = load_four(gathered, nodes + 1);
    *vx = load_four(gathered, nodes + 2);
    *vy = load_four(gathered, nodes + 3);
    transpose(x, y, vx, vy);
}
static inline void store_gathered(float *gathered, vec x, vec y, vec vx, vec vy) {
    transpose(&x, &y, &vx, &vy);
    const vec nodes[] = {x, y, vx, vy};
    for (int i = 0; i < 4; ++i) {
        _mm_store_ps(gathered + 4 * i, _mm512_castps512_ps128(nodes[i]));
        _mm_store_ps(gathered + 4 * i + 16, _mm512_extractf32x4_ps(nodes[i], 1));
        _mm_store_ps(gathered + 4 * i + 32, _mm512_extractf32x4_ps(nodes[i], 2));
        _mm_store_ps(gathered + 4 * i + 48, _mm512_extractf32x4_ps(nodes[i], 3));
    }
}

// Absolute values as integers: the order is that of floats, with NaN above all. Comparisons into a mask depend on
// each other: 3 cycles for each vector.
static inline __m512i absolute(vec a) {
    return _mm512_and_si512(_mm512_castps_si512(a), _mm512_set1_epi32(0x7fffffff));
}
static inline float largest_lane(vec a) {
    const int bits = _mm512_reduce_max_epi32(_mm512_castps_si512(a));
    return _mm_cvtss_f32(_mm_castsi128_ps(_mm_cvtsi32_si128(bits)));
}

// The larger of a and |b|.
static inline vec larger_size(vec a, vec b) {
    return _mm512_castsi512_ps(_mm512_max_epi32(_mm512_castps_si512(a), absolute(b)));
}

#define MSPRINGI_UNDIVIDED_INVERSE inverse_by_steps
#include "kernels/sweep.h"

// Eight lanes, for parts of tiles.
#define PART_LANES 8
typedef __m256 part_vec;

static inline part_vec part_set(float value) {
    return _mm256_set1_ps(value);
}
static inline part_vec part_load(const float *from) {
    return _mm256_load_ps(from);
}
static inline void part_store(float *to, part_vec a) {
    _mm256_store_ps(to, a);
}
static inline part_vec part_add(part_vec a, part_vec b) {
    return _mm256_add_ps(a, b);
}
static inline part_vec part_sub(part_vec a, part_vec b) {
    return _mm256_sub_ps(a, b);
}
static inline part_vec part_mul(part_vec a, part_vec b) {
    return _mm256_mul_ps(a, b);
}

#define MSPRINGI_TABLE mspringi_kernels_avx512
#define MSPRINGI_LEVEL MSPRING_SIMD_AVX512
#include "kernels/kernel_table.h"

#endif
