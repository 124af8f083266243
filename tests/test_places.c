/// @file test_places.c
/// Places of springs, kept as runs: what is read is what was given, in little memory where it lies in patterns.
///
/// SPDX-License-Identifier: MIT
#include "topology/places.h"

#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "support.h"

enum { MOST = 20000 };

/// Places to keep: lattice ones are below LATTICE.
#define LATTICE 1000000u

typedef struct given {
    mspringi_place places[MOST];
    uint32_t count;
} given;

static void add(given *to, mspringi_place place) {
    assert_true(to->count < MOST);
    to->places[to->count++] = place;
}

/// The springs of a row of cells, in the order in which builders add them, with the row below at slot below.
static void add_row(given *to, uint32_t slot, uint32_t below, uint32_t width) {
    for (uint32_t c = 0; c < width; c++) {
        if (c + 1 < width) {
            add(to, mspringi_lattice_place(slot + c, MSPRINGI_EAST));
        }
        if (c > 0) {
            add(to, mspringi_lattice_place(below + c - 1, MSPRINGI_NORTH_EAST));
        }
        add(to, mspringi_lattice_place(below + c, MSPRINGI_NORTH));
        if (c + 1 < width) {
            add(to, mspringi_lattice_place(below + c, MSPRINGI_SOUTH_EAST));
        }
    }
}

/// Keep what is given, read it back in every way, and return the bytes that it takes.
static size_t check_kept(const given *from) {
    watched_allocator watched = {0};
    mspring_allocator allocator = watched_interface(&watched);
    mspringi_memory memory;
    mspringi_message message;
    mspringi_places places;
    check_ok(mspringi_memory_init(&memory, &allocator, &message));
    assert_true(mspringi_places_create(&places, from->places, from->count, from->count, LATTICE, &memory));
    const size_t used = memory.used;
    for (uint32_t s = 0; s < from->count; s++) {
        assert_int_equal(mspringi_places_at(&places, s), from->places[s]);
    }
    static mspringi_place read[MOST + 1];
    for (uint32_t first = 0; first < from->count; first = first * 2 + 1) {
        for (uint32_t count = 0; count <= from->count - first; count = count * 3 + 1) {
            read[count] = 77;
            mspringi_places_read(&places, first, count, read);
            assert_memory_equal(read, from->places + first, count * sizeof *read);
            assert_int_equal(read[count], 77);
        }
    }
    mspringi_places_destroy(&places, &memory);
    check_watched_clean(&watched);
    return used;
}

/// Bytes of blocks that hold nothing: their headers.
static size_t bytes_of_none(void) {
    static given none;
    return check_kept(&none);
}

static void nothing_is_kept_as_nothing(void **state) {
    (void)state;
    assert_true(bytes_of_none() < 1000);
}

static void lattices_take_next_to_nothing(void **state) {
    (void)state;
    static given lattice;
    lattice.count = 0;
    for (uint32_t row = 0; row < 20; row++) {
        add_row(&lattice, 5000 - row * 96, 5000 - (row + 1) * 96, 90);
    }
    // Two runs and three single springs for each row, and a page's run for every 128 springs.
    assert_true(check_kept(&lattice) - bytes_of_none() <= 20 * (2 * 28 + 4 * 4) + lattice.count / 32 + 2 * 64);
}

static void every_period_and_step_is_a_run(void **state) {
    (void)state;
    static given pattern;
    for (uint32_t period = 1; period <= 4; period++) {
        for (uint32_t step = 0; step < 4; step++) {
            const uint32_t steps[] = {1, 48, (uint32_t)-1, (uint32_t)-48};
            pattern.count = 0;
            for (uint32_t i = 0; i < 400; i++) {
                const uint32_t member = i % period, slot = 50000 + member * 100 + i / period * steps[step];
                add(&pattern, mspringi_lattice_place(slot, member));
            }
            assert_true(check_kept(&pattern) - bytes_of_none() <= 3 * 64);
        }
    }
    // Chains and leftover springs, up and down.
    pattern.count = 0;
    for (uint32_t i = 0; i < 400; i++) {
        add(&pattern, LATTICE + i);
    }
    for (uint32_t i = 0; i < 400; i++) {
        add(&pattern, LATTICE + 2000 - i);
    }
    assert_true(check_kept(&pattern) - bytes_of_none() <= 4 * 64);
}

static void disorder_costs_little_more_than_an_array(void **state) {
    (void)state;
    static given any;
    uint64_t seed = 4;
    for (int share = 0; share <= 100; share += 20) { // percent of patches that are in order
        any.count = 0;
        while (any.count + 40 < MOST) {
            const uint32_t length = 1 + (uint32_t)(support_random(&seed) % 40);
            const uint32_t slot = (uint32_t)(support_random(&seed) % 15000);
            const bool in_order = (int)(support_random(&seed) % 100) < share;
            for (uint32_t i = 0; i < length; i++) {
                add(&any, in_order ? mspringi_lattice_place(slot + i / 4, i % 4)
                                   : (uint32_t)(support_random(&seed) % (2 * LATTICE)));
            }
        }
        const size_t array = any.count * sizeof *any.places;
        assert_true(check_kept(&any) <= bytes_of_none() + array + array / 128 + 256);
    }
}

/// A run must not take up what only looks like going on: a place beyond the lattices, another direction.
static void patterns_end_where_lattices_do(void **state) {
    (void)state;
    static given pattern;
    pattern.count = 0;
    for (uint32_t i = 0; i < 100; i++) {
        add(&pattern, mspringi_lattice_place(LATTICE / 4 - 64 + i, MSPRINGI_NORTH));
    }
    for (uint32_t i = 0; i < 100; i++) {
        add(&pattern, mspringi_lattice_place(i, i % 50 == 49 ? MSPRINGI_NORTH : MSPRINGI_EAST));
    }
    (void)check_kept(&pattern);
}

/// Springs that are not fixed can be set, and the others stay as they are.
static void some_can_be_set(void **state) {
    (void)state;
    enum { SPRINGS = 1000 };
    const uint32_t fixed[] = {0, 1, 128, 500, 999};
    for (size_t i = 0; i < COUNT_OF(fixed); i++) {
        mspringi_memory memory;
        mspringi_message message;
        mspringi_places places;
        mspringi_place expected[SPRINGS];
        for (uint32_t s = 0; s < SPRINGS; s++) {
            expected[s] = mspringi_lattice_place(s, MSPRINGI_EAST);
        }
        check_ok(mspringi_memory_init(&memory, NULL, &message));
        assert_true(mspringi_places_create(&places, expected, SPRINGS, fixed[i], LATTICE, &memory));
        for (uint32_t s = fixed[i]; s < SPRINGS; s += 7) {
            expected[s] = 3 * s;
            mspringi_places_set(&places, s, expected[s]);
        }
        for (uint32_t s = 0; s < SPRINGS; s++) {
            assert_int_equal(mspringi_places_at(&places, s), expected[s]);
        }
        mspringi_places_destroy(&places, &memory);
    }
}

static void failed_allocations_leave_nothing(void **state) {
    (void)state;
    const mspringi_place few[] = {3, 1, 4};
    for (size_t fail_at = 1; fail_at <= 3; fail_at++) {
        watched_allocator watched = {.fail_at = fail_at};
        mspring_allocator allocator = watched_interface(&watched);
        mspringi_memory memory;
        mspringi_message message;
        mspringi_places places;
        check_ok(mspringi_memory_init(&memory, &allocator, &message));
        assert_false(mspringi_places_create(&places, few, 3, 3, LATTICE, &memory));
        check_watched_clean(&watched);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_kept_as_nothing),
        cmocka_unit_test(lattices_take_next_to_nothing),
        cmocka_unit_test(every_period_and_step_is_a_run),
        cmocka_unit_test(disorder_costs_little_more_than_an_array),
        cmocka_unit_test(patterns_end_where_lattices_do),
        cmocka_unit_test(some_can_be_set),
        cmocka_unit_test(failed_allocations_leave_nothing),
    };
    return cmocka_run_group_tests_name("places", tests, NULL, NULL);
}
