/// @file test_decay.c
/// Factors of velocities: the library's own exponential, which global damping needs (C libraries differ in the last
/// bit of theirs), and the dither of explicit steps.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "base/decay.h"
#include "base/dither.h"
#include "support.h"

static void it_is_the_exponential(void **state) {
    (void)state;
    uint64_t seed = 77;
    for (int i = 0; i < 200000; i++) {
        // Rates and substeps over all magnitudes that a network may have.
        float rate = (float)pow(10, support_random_between(&seed, -6, 6));
        float h = (float)pow(10, support_random_between(&seed, -7, 1));
        double exact = exp(-(double)rate * (double)h);
        float got = mspringi_decay(rate, h);
        // The nearest float, or the next one where double rounding decides: one ulp, and that of the denormal ones.
        check_near((double)got, exact, exact * 0x1p-23 + 0x1p-149);
        assert_true(got >= 0 && got <= 1);
    }
}

static void it_is_exact_at_the_ends(void **state) {
    (void)state;
    assert_true(mspringi_decay(0, 0.01f) == 1);
    assert_true(mspringi_decay(1e6f, 1) == 0);
    assert_true(mspringi_decay(1e6f, 3e38f) == 0);
    assert_true(mspringi_decay(1e-6f, 1e-30f) == 1);
}

/// The dither of four substeps adds up to 0, and so do its sums, by which positions would move. Half of all fours
/// lie in either half of the interval, within three.
static void dither_cancels(void **state) {
    (void)state;
    double sum = 0, way = 0;
    int large = 0, small = 0;
    for (uint32_t i = 0; i < 4000; i++) {
        const float d = mspringi_dither(i);
        assert_true(fabsf(d) <= 0x1p-19f && d != 0);
        sum += (double)d;
        way += sum;
        large += fabsf(d) > 0x1p-20f;
        small += fabsf(d) <= 0x1p-20f;
        assert_true(i % 4 < 3 || (sum == 0 && way == 0));
        assert_true(abs(large - small) <= 12);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_exponential),
        cmocka_unit_test(it_is_exact_at_the_ends),
        cmocka_unit_test(dither_cancels),
    };
    return cmocka_run_group_tests_name("decay", tests, NULL, NULL);
}
