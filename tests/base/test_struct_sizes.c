/// @file test_struct_sizes.c
/// Three versions of one struct, in programs and in libraries: each program runs with each library.
///
/// SPDX-License-Identifier: MIT
#include <string.h>

#include "base/structs.h"
#include "support.h"

typedef struct v1 {
    uint32_t struct_size, a;
    float b;
    uint32_t reserved;
} v1;
typedef struct v2 { // c took the reserved word, d came at the end
    uint32_t struct_size, a;
    float b;
    uint32_t c;
    double d;
} v2;
typedef struct v3 {
    uint32_t struct_size, a;
    float b;
    uint32_t c;
    double d;
    float e, f;
} v3;

// The defaults of c and d are what was before there were any: not 0.
static const v1 default_1 = {.a = 7, .b = 1.5f};
static const v2 default_2 = {.a = 7, .b = 1.5f, .d = 2};
static const v3 default_3 = {.a = 7, .b = 1.5f, .d = 2, .e = 3, .f = 4};

static const mspringi_struct libraries[] = {
    {"some", sizeof(v1), sizeof(v1), 0, &default_1},
    {"some", sizeof(v1), sizeof(v2), 0, &default_2},
    {"some", sizeof(v1), sizeof(v3), 0, &default_3},
};
static const uint32_t programs[] = {sizeof(v1), sizeof(v2), sizeof(v3)};

/// Room for any of them, with bytes behind it that stay.
#define ROOM (sizeof(v3) + 8)

static void check_behind(const unsigned char *bytes, size_t size) {
    for (size_t i = size; i < ROOM; i++) {
        assert_int_equal(bytes[i], 0xaa);
    }
}

static void every_program_runs_with_every_library(void **state) {
    (void)state;
    for (size_t l = 0; l < 3; l++) {
        for (size_t p = 0; p < 3; p++) {
            const mspringi_struct *library = &libraries[l];
            const uint32_t size = programs[p], shared = size < library->known ? size : library->known;
            _Alignas(8) unsigned char given[ROOM], taken[ROOM], out[ROOM], expected[ROOM];
            memset(given, 0xaa, ROOM);
            memset(taken, 0xaa, ROOM);
            memset(out, 0xaa, ROOM);
            memset(given, 0, size); // as mspring_init() does it
            memcpy(given, &size, sizeof size);
            mspringi_put_struct(library, given, library->defaults);
            check_behind(given, size);
            assert_memory_equal(given, &size, sizeof size);
            assert_memory_equal(given + 4, (const char *)library->defaults + 4, shared - 4);
            // Fields that the program sets, and defaults for fields that it does not know.
            ((v1 *)(void *)given)->a = 9;
            memcpy(expected, library->defaults, library->known);
            memcpy(expected, &library->known, sizeof library->known);
            ((v1 *)(void *)expected)->a = 9;
            check_ok(mspringi_take_struct(NULL, library, given, taken));
            assert_memory_equal(taken, expected, library->known);
            check_behind(taken, library->known);
            // Back into a struct of the program.
            memcpy(out, &size, sizeof size);
            check_ok(mspringi_check_output(NULL, library, out));
            mspringi_put_struct(library, out, taken);
            assert_memory_equal(out, given, size);
            check_behind(out, size);
            // A field that the library does not know, and that is used.
            mspringi_message message;
            for (uint32_t i = library->known; i < size; i++) {
                given[i] = 64;
                check_error(mspringi_take_struct(&message, library, given, taken), MSPRING_ERROR_STRUCT);
                check_contains(message.text, "some has");
                given[i] = 0;
            }
        }
    }
}

static void null_gives_defaults(void **state) {
    (void)state;
    v2 taken;
    memset(&taken, 0xaa, sizeof taken);
    check_ok(mspringi_take_struct(NULL, &libraries[1], NULL, &taken));
    assert_true(taken.struct_size == sizeof taken && taken.a == 7 && taken.b == 1.5f && taken.c == 0 &&
                taken.d == 2);
}

static void sizes_that_are_none_are_refused(void **state) {
    (void)state;
    for (size_t l = 0; l < 3; l++) {
        for (uint32_t size = 0; size < 5000; size++) {
            static uint32_t given[5000 / sizeof(uint32_t) + 1];
            v3 taken;
            mspringi_message message;
            const bool is_good = size >= sizeof(v1) && size % 4 == 0 && size <= 4000;
            const mspring_result expected = is_good ? MSPRING_OK : MSPRING_ERROR_STRUCT;
            given[0] = size;
            check_error(mspringi_take_struct(&message, &libraries[l], given, &taken), expected);
            check_error(mspringi_check_output(&message, &libraries[l], given), expected);
            if (!is_good) {
                check_contains(message.text, "some.struct_size is");
                check_contains(message.text, "from 16 to 4000");
            }
            memset(given, 0, sizeof given);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ nested ones */

/// A struct that ends with another, which has grown: both have.
typedef struct inner {
    uint32_t struct_size, e;
} inner;
typedef struct outer {
    uint32_t struct_size, a;
    inner last;
    uint32_t grown; ///< of the inner one
} outer;

static const outer default_outer = {.a = 7, .last = {.e = 8}, .grown = 9};
static const mspringi_struct outers[] = {
    {"outer", offsetof(outer, grown), offsetof(outer, grown), offsetof(outer, last), &default_outer},
    {"outer", offsetof(outer, grown), sizeof(outer), offsetof(outer, last), &default_outer},
};

static void nested_structs_grow_with_the_outer_one(void **state) {
    (void)state;
    for (size_t l = 0; l < COUNT_OF(outers); l++) {
        for (size_t p = 0; p < COUNT_OF(outers); p++) {
            const uint32_t size = outers[p].known, known = outers[l].known;
            outer given = {.struct_size = size, .a = 1, .last = {size - (uint32_t)offsetof(outer, last), 2}}, taken,
                  out;
            memset(&taken, 0xaa, sizeof taken);
            memset(&out, 0xaa, sizeof out);
            check_ok(mspringi_take_struct(NULL, &outers[l], &given, &taken));
            assert_int_equal(taken.struct_size, known);
            assert_int_equal(taken.last.struct_size, known - offsetof(outer, last));
            assert_int_equal(taken.last.e, 2);
            if (known == sizeof taken)
                assert_int_equal(taken.grown, size == sizeof given ? 0 : 9); // what a program lacks is the default
            out.struct_size = size;
            mspringi_put_struct(&outers[l], &out, &taken);
            assert_int_equal(out.struct_size, size);
            assert_int_equal(out.last.struct_size, size - offsetof(outer, last));
            // One that does not fill its place.
            mspringi_message message;
            const uint32_t wrong[] = {0, 4, given.last.struct_size - 4, given.last.struct_size + 4, size};
            for (size_t i = 0; i < COUNT_OF(wrong); i++) {
                given.last.struct_size = wrong[i];
                check_error(mspringi_take_struct(&message, &outers[l], &given, &taken), MSPRING_ERROR_STRUCT);
                check_contains(message.text, "outer.settings.struct_size is ");
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_program_runs_with_every_library),
        cmocka_unit_test(null_gives_defaults),
        cmocka_unit_test(nested_structs_grow_with_the_outer_one),
        cmocka_unit_test(sizes_that_are_none_are_refused),
    };
    return cmocka_run_group_tests_name("struct_sizes", tests, NULL, NULL);
}
