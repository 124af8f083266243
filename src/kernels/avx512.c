/// AVX-512 (F only): sixteen lanes.
#include "kernels.h"

#include <immintrin.h>

#define LANES 16
typedef __m512 vec;

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
// 1 / length, or 0 where length is 0.
static inline vec inverse_or_zero(vec length) {
    return _mm512_maskz_div_ps(_mm512_cmp_ps_mask(length, _mm512_setzero_ps(), _CMP_GT_OQ), _mm512_set1_ps(1.0f),
                               length);
}
// a where selector > 0, b elsewhere.
static inline vec choose_positive(vec selector, vec a, vec b) {
    return _mm512_mask_blend_ps(_mm512_cmp_ps_mask(selector, _mm512_setzero_ps(), _CMP_GT_OQ), b, a);
}
// The last lane of before, then all lanes of a but its last.
static inline vec shift_in(vec before, vec a) {
    return _mm512_castsi512_ps(_mm512_alignr_epi32(_mm512_castps_si512(a), _mm512_castps_si512(before), 15));
}

static bool bounded(const float *values, size_t count, float limit) {
    const __m512 limits = _mm512_set1_ps(limit);
    __mmask16 all = 0xffff;
    for (size_t i = 0; i < count; i += LANES)
        all &= _mm512_cmp_ps_mask(_mm512_abs_ps(_mm512_load_ps(values + i)), limits, _CMP_LE_OQ);
    return all == 0xffff;
}

#include "sweep.h"

#define MSPRINGI_TABLE mspringi_kernels_avx512
#define MSPRINGI_LEVEL MSPRING_SIMD_AVX512
#include "table.h"
