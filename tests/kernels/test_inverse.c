/// @file test_inverse.c
/// The inverse without the divider is that of a division, bit by bit: for all significands, in every lane, from
/// every seed.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "inverse_lanes.h"
#include "kernels/kernels.h"
#include "level.h"
#include "support.h"

enum {
    SIGNIFICANDS = 1 << 23,
    BATCH = 1 << 12,
    BIASED_LEAST = 4, // exponent of MSPRINGI_NO_DIRECTION
    BIASED_ONE = 127, // of 1
    BIASED_MOST = 254 // of the largest numbers
};

static float float_of(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float inverse_of(float square) {
    return square > MSPRINGI_NO_DIRECTION ? 1.0f / square : 0.0f;
}

/// BATCH squares of one exponent, and those that follow in the lanes of the last.
typedef struct batch {
    float squares[BATCH + INVERSE_LANES], inverses[BATCH + INVERSE_LANES];
} batch;

static void fill(batch *b, uint32_t sign_and_exponent, uint32_t first) {
    for (uint32_t i = 0; i < BATCH + INVERSE_LANES; i++) {
        b->squares[i] = float_of(sign_and_exponent << 23 | ((first + i) & (SIGNIFICANDS - 1)));
        b->inverses[i] = inverse_of(b->squares[i]);
    }
}

static void check_all(const batch *b, size_t found) {
    if (found < BATCH) {
        fail_msg("wrong in the 16 lanes from the square 0x%08x", bits_of(b->squares[found]));
    }
}

static void it_is_the_quotient(void **state) {
    (void)state;
    // Subnormal numbers; around the border of a direction; around 1; the smallest normal inverses and the subnormal
    // ones; infinity and NaN. Negative: zero and NaN.
    static const uint32_t exponents[] = {0,
                                         BIASED_LEAST - 1,
                                         BIASED_LEAST,
                                         BIASED_LEAST + 1,
                                         BIASED_ONE - 1,
                                         BIASED_ONE,
                                         BIASED_ONE + 1,
                                         BIASED_MOST - 2,
                                         BIASED_MOST - 1,
                                         BIASED_MOST,
                                         BIASED_MOST + 1,
                                         256 + BIASED_MOST + 1};
    static batch b;
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        // Once each square in each lane.
        const size_t stride = exponents[e] == BIASED_ONE ? 1 : INVERSE_LANES;
        for (uint32_t first = 0; first < SIGNIFICANDS; first += BATCH) {
            fill(&b, exponents[e], first);
            check_all(&b, inverse_lanes_wrong(b.squares, b.inverses, BATCH, stride));
        }
    }
    memset(&b, 0, sizeof b);
    b.squares[0] = -0.0f;
    assert_int_equal(inverse_lanes_wrong(b.squares, b.inverses, 1, 1), 1);
}

static float round_up(double value) {
    const float nearest = (float)value;
    return (double)nearest < value ? float_of(bits_of(nearest) + 1) : nearest;
}

// From a seed (1 + d) / a the first step gives (1 - d^2) / a, rounded up: one or two floats, and from both the last
// step is right. Where the inverse is normal, powers of two only scale, so that one exponent stands for all.
static void no_seed_matters(void **state) {
    (void)state;
    static const uint32_t exponents[] = {BIASED_LEAST, BIASED_ONE, BIASED_MOST - 2};
    static const double offsets[] = {-0x1p-13, -0x1.3p-14, 0, 0x1.7p-14, 0x1p-13};
    enum { OFFSETS = sizeof offsets / sizeof *offsets };
    static batch b;
    static float least[BATCH], most[BATCH], seeds[OFFSETS][BATCH], firsts[BATCH];
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        for (uint32_t first = 0; first < SIGNIFICANDS; first += BATCH) {
            fill(&b, exponents[e], first);
            for (uint32_t i = 0; i < BATCH; i++) {
                const double inverse = 1.0 / (double)b.squares[i];
                // d^2, where 2 % is for the rounding of the seed, and the rounding of 1 - a x (2^-24 of 2^-13).
                least[i] = round_up(inverse * (1.0 - 1.02 * 0x1p-26 - 0x1p-36));
                most[i] = round_up(inverse * (1.0 + 0x1p-36));
                for (size_t o = 0; o < OFFSETS; o++) {
                    seeds[o][i] = (float)(inverse * (1.0 + offsets[o]));
                }
            }
            check_all(&b, inverse_lanes_last_wrong(b.squares, least, b.inverses, BATCH));
            check_all(&b, inverse_lanes_last_wrong(b.squares, most, b.inverses, BATCH));
            for (size_t o = 0; o < OFFSETS; o++) {
                inverse_lanes_first(b.squares, seeds[o], firsts, BATCH);
                for (uint32_t i = 0; i < BATCH; i++) {
                    if (!(firsts[i] >= least[i] && firsts[i] <= most[i])) {
                        check_all(&b, i);
                    }
                }
            }
        }
    }
}

int main(int argc, char **argv) {
    level_from_arguments(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_quotient),
        cmocka_unit_test(no_seed_matters),
    };
    return cmocka_run_group_tests_name("inverse", tests, NULL, NULL);
}
