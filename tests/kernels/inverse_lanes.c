/// @file inverse_lanes.c
/// See inverse_lanes.h.
///
/// SPDX-License-Identifier: MIT
#include "inverse_lanes.h"

#include "kernels/inverse_avx512.h"

static bool is_equal(__m512 a, const float *b) {
    return _mm512_cmpneq_epi32_mask(_mm512_castps_si512(a), _mm512_castps_si512(_mm512_loadu_ps(b))) == 0;
}

size_t inverse_lanes_wrong(const float *squares, const float *inverses, size_t count, size_t stride) {
    size_t i = 0;
    while (i < count && is_equal(inverse_by_steps(_mm512_loadu_ps(squares + i)), inverses + i)) {
        i += stride;
    }
    return i;
}

void inverse_lanes_first(const float *squares, const float *seeds, float *firsts, size_t count) {
    for (size_t i = 0; i < count; i += INVERSE_LANES) {
        _mm512_storeu_ps(firsts + i, first_newton_step(_mm512_loadu_ps(squares + i), _mm512_loadu_ps(seeds + i)));
    }
}

size_t inverse_lanes_last_wrong(const float *squares, const float *firsts, const float *inverses, size_t count) {
    size_t i = 0;
    while (i < count &&
           is_equal(last_newton_step(_mm512_loadu_ps(squares + i), _mm512_loadu_ps(firsts + i)), inverses + i)) {
        i += INVERSE_LANES;
    }
    return i;
}
