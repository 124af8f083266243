/// @file cmocka.h
/// The part of cmocka's interface that the tests use, for targets that the distribution has no cmocka for. Where
/// there is cmocka, the tests use that.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_PLATFORMS_CMOCKA_H
#define TEST_PLATFORMS_CMOCKA_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#if defined(__MINGW32__) && !defined(__clang__)
#define CMOCKA_PRINTF __attribute__((format(gnu_printf, 1, 2)))
#else
#define CMOCKA_PRINTF __attribute__((format(printf, 1, 2)))
#endif

typedef void (*CMUnitTestFunction)(void **state);
typedef int (*CMFixtureFunction)(void **state);

struct CMUnitTest {
    const char *name;
    CMUnitTestFunction test;
    CMFixtureFunction setup, teardown;
};

#define cmocka_unit_test_setup_teardown(test, setup, teardown)                                                     \
    { #test, test, setup, teardown }
#define cmocka_unit_test(test) cmocka_unit_test_setup_teardown(test, NULL, NULL)
#define cmocka_unit_test_setup(test, setup) cmocka_unit_test_setup_teardown(test, setup, NULL)

/// Run all tests and print what came of them; returns the number that failed.
#define cmocka_run_group_tests_name(name, tests, group_setup, group_teardown)                                      \
    cmocka_run(name, tests, sizeof(tests) / sizeof((tests)[0]), group_setup, group_teardown)
#define cmocka_run_group_tests(tests, group_setup, group_teardown)                                                 \
    cmocka_run_group_tests_name(#tests, tests, group_setup, group_teardown)
int cmocka_run(const char *name, const struct CMUnitTest *tests, size_t count, CMFixtureFunction group_setup,
               CMFixtureFunction group_teardown);

void print_message(const char *format, ...) CMOCKA_PRINTF;
void print_error(const char *format, ...) CMOCKA_PRINTF;

#define test_malloc(size) malloc(size)
#define test_calloc(count, size) calloc(count, size)
#define test_free(memory) free(memory)

/// End the running test as failed.
_Noreturn void _fail(const char *file, int line);
#define fail() _fail(__FILE__, __LINE__)
#define fail_msg(...)                                                                                              \
    do {                                                                                                           \
        print_error(__VA_ARGS__);                                                                                  \
        _fail(__FILE__, __LINE__);                                                                                 \
    } while (0)

/// End the running test as one that this machine has no need of.
_Noreturn void _skip(const char *file, int line);
#define skip() _skip(__FILE__, __LINE__)

/// A value as cmocka passes it: by its bits, whatever its type.
#define CMOCKA_VALUE(value) ((uintmax_t)(value))
#define CMOCKA_POINTER(value) ((uintmax_t)(uintptr_t)(value))

void cmocka_true(int holds, const char *text, const char *file, int line);
void cmocka_equal(uintmax_t a, uintmax_t b, int wanted, const char *text, const char *file, int line);
void cmocka_in_range(uintmax_t value, uintmax_t low, uintmax_t high, const char *text, const char *file, int line);
void cmocka_string(const char *a, const char *b, int wanted, const char *text, const char *file, int line);
void cmocka_memory(const void *a, const void *b, size_t size, int wanted, const char *text, const char *file,
                   int line);

#define assert_true(value) cmocka_true((value) != 0, #value, __FILE__, __LINE__)
#define assert_false(value) cmocka_true((value) == 0, "not " #value, __FILE__, __LINE__)
#define assert_null(value) cmocka_true((value) == NULL, #value " is NULL", __FILE__, __LINE__)
#define assert_non_null(value) cmocka_true((value) != NULL, #value " is not NULL", __FILE__, __LINE__)
#define assert_int_equal(a, b) cmocka_equal(CMOCKA_VALUE(a), CMOCKA_VALUE(b), 1, #a " == " #b, __FILE__, __LINE__)
#define assert_int_not_equal(a, b)                                                                                 \
    cmocka_equal(CMOCKA_VALUE(a), CMOCKA_VALUE(b), 0, #a " != " #b, __FILE__, __LINE__)
#define assert_ptr_equal(a, b)                                                                                     \
    cmocka_equal(CMOCKA_POINTER(a), CMOCKA_POINTER(b), 1, #a " == " #b, __FILE__, __LINE__)
#define assert_ptr_not_equal(a, b)                                                                                 \
    cmocka_equal(CMOCKA_POINTER(a), CMOCKA_POINTER(b), 0, #a " != " #b, __FILE__, __LINE__)
#define assert_in_range(value, low, high)                                                                          \
    cmocka_in_range(CMOCKA_VALUE(value), CMOCKA_VALUE(low), CMOCKA_VALUE(high), #value, __FILE__, __LINE__)
#define assert_string_equal(a, b) cmocka_string(a, b, 1, #a " == " #b, __FILE__, __LINE__)
#define assert_string_not_equal(a, b) cmocka_string(a, b, 0, #a " != " #b, __FILE__, __LINE__)
#define assert_memory_equal(a, b, size) cmocka_memory(a, b, size, 1, #a " == " #b, __FILE__, __LINE__)
#define assert_memory_not_equal(a, b, size) cmocka_memory(a, b, size, 0, #a " != " #b, __FILE__, __LINE__)

#endif
