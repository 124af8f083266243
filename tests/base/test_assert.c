/// @file test_assert.c
/// A condition that does not hold calls the handler that the build names, with its text and place; and a block that
/// is freed by another memory is found. This test looks inside.
///
/// SPDX-License-Identifier: MIT
#define MSPRINGI_ASSERTS 1
#define MSPRINGI_ASSERT_HANDLER note_failure
#include "base/memory.c" // NOLINT(bugprone-suspicious-include): with the handler of this file

#include "support.h"

static struct {
    const char *condition, *file;
    int line;
    jmp_buf back;
} failure;

void note_failure(const char *condition, const char *file, int line) {
    failure.condition = condition;
    failure.file = file;
    failure.line = line;
    longjmp(failure.back, 1);
}

static void the_handler_is_told_what_failed_and_where(void **state) {
    (void)state;
    volatile int evaluated = 0, line = 0;
    MSPRINGI_ASSERT(++evaluated == 1);
    assert_int_equal(evaluated, 1);
    if (setjmp(failure.back) == 0) {
        line = __LINE__ + 1;
        MSPRINGI_ASSERT(evaluated == 2);
        fail();
    }
    assert_string_equal(failure.condition, "evaluated == 2");
    assert_non_null(strstr(failure.file, "test_assert.c"));
    assert_int_equal(failure.line, line);
}

static int is_caught(mspringi_memory *memory, void *contents) {
    void (*const volatile free_block)(mspringi_memory *, void *) = mspringi_free;
    if (setjmp(failure.back) != 0)
        return 1;
    free_block(memory, contents);
    return 0;
}

static void a_block_is_freed_by_its_own_memory_only(void **state) {
    (void)state;
    mspringi_message message;
    mspringi_memory memory, other;
    assert_int_equal(mspringi_memory_init(&memory, NULL, &message), MSPRING_OK);
    other = memory;
    void *const first = mspringi_alloc(&memory, 1, 1), *const second = mspringi_alloc(&memory, 1, 1);
    assert_true(is_caught(&other, first));
    assert_true(is_caught(&other, second));
    assert_false(is_caught(&memory, first));
    assert_false(is_caught(&memory, second));
    assert_int_equal(memory.used, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_handler_is_told_what_failed_and_where),
        cmocka_unit_test(a_block_is_freed_by_its_own_memory_only),
    };
    return cmocka_run_group_tests_name("assert", tests, NULL, NULL);
}
