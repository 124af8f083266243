/// @file inverse_avx512.h
/// The inverse at AVX-512, by the divider and without it: the same bits for every square.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_INVERSE_AVX512_H
#define MSPRINGI_INVERSE_AVX512_H

#include <immintrin.h>

#include "kernels/kernels.h"

/// Largest square whose inverse is no subnormal number.
#define MSPRINGI_NORMAL_INVERSE 0x1p126f

// 1 / square, or 0 without a direction.
static inline __m512 inverse_or_zero(__m512 square) {
    return _mm512_maskz_div_ps(_mm512_cmp_ps_mask(square, _mm512_set1_ps(MSPRINGI_NO_DIRECTION), _CMP_GT_OQ),
                               _mm512_set1_ps(1.0f), square);
}

// Steps of Newton's, x + x (1 - a x). Two steps, from an approximation of 14 bits that may be off by 2^-13, round
// to nearest all significands but one: the inverse of all ones lies just above the middle of two floats. The first
// step, rounded up, finds the upper one, where the last step stays. So it is right for each, whatever the CPU's
// table.
static inline __m512 first_newton_step(__m512 square, __m512 seed) {
    return _mm512_fmadd_round_ps(_mm512_fnmadd_ps(square, seed, _mm512_set1_ps(1.0f)), seed, seed,
                                 _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC);
}

// 0 if the first step led to what has no direction, or to NaN, as from 0. mspringi_fp_enter() has set the rounding.
static inline __m512 last_newton_step(__m512 square, __m512 first) {
    const __mmask16 has_direction =
        _mm512_cmp_ps_mask(first, _mm512_set1_ps(1.0f / MSPRINGI_NO_DIRECTION), _CMP_LT_OQ);
    return _mm512_maskz_fmadd_ps(has_direction, _mm512_fnmadd_ps(square, first, _mm512_set1_ps(1.0f)), first,
                                 first);
}

// inverse_or_zero() without the divider, which takes 10 cycles for 16 lanes (Redwood Cove), an approximation 2. The
// one place where kernels fuse operations: tests/kernels/test_inverse.c has all 2^23 significands. Steps from fewer
// bits, as subnormal inverses have, would be off for some.
static inline __m512 inverse_by_steps(__m512 square) {
    if (_mm512_cmp_ps_mask(square, _mm512_set1_ps(MSPRINGI_NORMAL_INVERSE), _CMP_GT_OQ))
        return inverse_or_zero(square);
    return last_newton_step(square, first_newton_step(square, _mm512_rcp14_ps(square)));
}

#endif
