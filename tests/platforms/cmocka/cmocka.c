/// @file cmocka.c
///
/// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "cmocka.h"

static jmp_buf test_end;
enum { FAILED = 1, SKIPPED = 2 }; // what comes back through it

void print_message(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stdout, format, arguments);
    va_end(arguments);
    fflush(stdout);
}

void print_error(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
}

_Noreturn void _fail(const char *file, int line) {
    print_error("%s:%d: error: failure\n", file, line);
    longjmp(test_end, FAILED);
}

_Noreturn void _skip(const char *file, int line) {
    print_error("%s:%d: skipped\n", file, line);
    longjmp(test_end, SKIPPED);
}

void cmocka_true(int holds, const char *text, const char *file, int line) {
    if (!holds) {
        print_error("not so: %s\n", text);
        _fail(file, line);
    }
}

void cmocka_equal(uintmax_t a, uintmax_t b, int wanted, const char *text, const char *file, int line) {
    if ((a == b) != wanted) {
        print_error("not so: %s (%#" PRIxMAX ", %#" PRIxMAX ")\n", text, a, b);
        _fail(file, line);
    }
}

void cmocka_in_range(uintmax_t value, uintmax_t low, uintmax_t high, const char *text, const char *file, int line) {
    if (value < low || value > high) {
        print_error("%s is %" PRIuMAX ", not %" PRIuMAX " to %" PRIuMAX "\n", text, value, low, high);
        _fail(file, line);
    }
}

void cmocka_string(const char *a, const char *b, int wanted, const char *text, const char *file, int line) {
    if ((strcmp(a, b) == 0) != wanted) {
        print_error("not so: %s (\"%s\", \"%s\")\n", text, a, b);
        _fail(file, line);
    }
}

void cmocka_memory(const void *a, const void *b, size_t size, int wanted, const char *text, const char *file,
                   int line) {
    const unsigned char *left = a, *right = b;
    size_t first = 0;
    while (first < size && left[first] == right[first]) {
        first++;
    }
    if ((first == size) != wanted) {
        print_error("not so: %s, %zu bytes (the first difference is at byte %zu)\n", text, size, first);
        _fail(file, line);
    }
}

/// One test between its setup and its teardown. Whether it held.
static int run_test(const struct CMUnitTest *test) {
    void *state = NULL;
    if (test->setup != NULL && test->setup(&state) != 0) {
        return 0;
    }
    volatile int passed = 0;
    switch (setjmp(test_end)) {
    case 0:
        test->test(&state);
        passed = 1;
        break;
    case SKIPPED:
        passed = 1;
        break;
    default:
        break;
    }
    if (test->teardown != NULL) {
        if (setjmp(test_end) != 0 || test->teardown(&state) != 0) {
            passed = 0;
        }
    }
    return passed;
}

int cmocka_run(const char *name, const struct CMUnitTest *tests, size_t count, CMFixtureFunction group_setup,
               CMFixtureFunction group_teardown) {
    void *state = NULL;
    int failed = 0;
    print_message("[==========] %s: Running %zu test(s).\n", name, count);
    if (group_setup != NULL && group_setup(&state) != 0) {
        return (int)count;
    }
    for (size_t i = 0; i < count; i++) {
        print_message("[ RUN      ] %s\n", tests[i].name);
        int passed = run_test(&tests[i]);
        print_message("[ %s ] %s\n", passed ? "      OK" : " FAILED ", tests[i].name);
        failed += !passed;
    }
    if (group_teardown != NULL) {
        group_teardown(&state);
    }
    print_message("[==========] %zu test(s) run, %d failed.\n", count, failed);
    return failed;
}
