/// @file test_format.c
/// The library's own formats give what printf gives, digit by digit. This test looks inside.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/format.h"
#include "support.h"

MSPRINGI_PRINTF(2, 3)
static void ours(char text[256], const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    mspringi_format(text, 256, format, arguments);
    va_end(arguments);
}

/// Both of them write the same.
#define check_same(format, ...)                                                                                    \
    do {                                                                                                           \
        char here[256], there[256];                                                                                \
        ours(here, format, __VA_ARGS__);                                                                           \
        snprintf(there, sizeof there, format, __VA_ARGS__);                                                        \
        assert_string_equal(here, there);                                                                          \
    } while (0)

/// With the precisions that messages use, and with all digits that a double has.
static void check_number(double value) {
    check_same("%g", value);
    check_same("%.1g", value);
    check_same("%.2g", value);
    check_same("%.3g", value);
    check_same("%.17g", value);
    check_same("%g", -value);
}

static void numbers_of_every_size_have_the_digits_of_printf(void **state) {
    (void)state;
    uint64_t seed = 19;
    for (int i = 0; i < SAMPLE(10000); ++i) {
        const uint64_t bits = support_random(&seed);
        double value;
        memcpy(&value, &bits, sizeof value);
        if (!isnan(value))
            check_number(value);
        check_number(support_random_between(&seed, 0, 1000));
        check_number((float)support_random_between(&seed, 0, 1e-3));
    }
    for (int exponent = -1074; exponent < 1024; ++exponent) {
        check_number(ldexp(1, exponent));
        check_number(nextafter(ldexp(1, exponent), 0));
        check_number(nextafter(ldexp(1, exponent), INFINITY));
        char text[32];
        double value = 0;
        snprintf(text, sizeof text, "1e%d", exponent * 3 / 10);
        assert_int_equal(sscanf(text, "%lf", &value), 1);
        check_number(value);
        check_number(nextafter(value, 0));
    }
}

// Ties go to the even digit; a row of nines becomes one digit more.
static void halves_and_nines_are_rounded_as_printf_does(void **state) {
    (void)state;
    for (int i = 0; i < 20000; ++i)
        check_number(i / 64.0);
    const double values[] = {0,       0.5,     1.5,     2.5,     9.5,         99.5,         999.5,   999999.5,
                             9999995, 0.95,    0.99,    0.999,   0.9999995,   0.00099995,   0.0001,  0.00001,
                             1e5,     1e6,     999999,  1000000, 123456,      1234567,      1e-5,    9.9999e-5,
                             DBL_MAX, DBL_MIN, FLT_MAX, FLT_MIN, DBL_EPSILON, DBL_TRUE_MIN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(values); ++i)
        check_number(values[i]);
}

static void integers_and_text_are_those_of_printf(void **state) {
    (void)state;
    const int ints[] = {0, 1, -1, 9, 10, -10, 12345, INT_MAX, INT_MIN};
    for (size_t i = 0; i < COUNT_OF(ints); ++i) {
        const unsigned bits = (unsigned)ints[i];
        check_same("%d %u %x %#x", ints[i], bits, bits, bits);
        check_same("a%zub%zxc%#zx", (size_t)bits, (size_t)bits * 3, (size_t)0);
        check_same("%llu %llx", ~(unsigned long long)bits, (unsigned long long)bits << 31);
    }
    check_same("%s%s, %% and %s", "", "text", "100 %");
    check_same("spring %u: %s is %g, it must be <= %.3g (%zu)", 7u, "stiffness", 0.1, 1e9, (size_t)3);
}

// printf's sign of a NaN differs among hosts.
static void a_nan_has_no_sign(void **state) {
    (void)state;
    char text[256];
    ours(text, "%g %g", (double)NAN, -(double)NAN);
    assert_string_equal(text, "nan nan");
}

MSPRINGI_PRINTF(3, 4)
static void ours_cut(char *text, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    mspringi_format(text, size, format, arguments);
    va_end(arguments);
}

static void text_is_cut_to_fit(void **state) {
    (void)state;
    const char *whole = "-12 of 0.25 and \"text\"";
    for (size_t size = 1; size < 40; ++size) {
        char text[48];
        memset(text, '~', sizeof text);
        ours_cut(text, size, "%d of %g and \"%s\"", -12, 0.25, "text");
        const size_t length = size - 1 < strlen(whole) ? size - 1 : strlen(whole);
        assert_int_equal(strlen(text), length);
        assert_memory_equal(text, whole, length);
        for (size_t i = length + 1; i < sizeof text; ++i)
            assert_int_equal(text[i], '~');
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_every_size_have_the_digits_of_printf),
        cmocka_unit_test(halves_and_nines_are_rounded_as_printf_does),
        cmocka_unit_test(integers_and_text_are_those_of_printf),
        cmocka_unit_test(a_nan_has_no_sign),
        cmocka_unit_test(text_is_cut_to_fit),
    };
    return cmocka_run_group_tests_name("format", tests, NULL, NULL);
}
