/// @file test_rests.c
/// Rest lengths that springs of a lattice share: read as given, and each its own once one of them is edited.
///
/// SPDX-License-Identifier: MIT
#include "allocator.h"
#include "recipe.h"
#include "support.h"

static const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1000, 1000}};

/// Two lattices of different spacing, one whose springs are all a little different, and a rope.
static recipe mixed_recipe(void) {
    uint64_t seed = 5;
    recipe made = {0};
    recipe_lattice(&made, 40, 20, 0, 0, 1, &stuff, &seed);
    recipe_lattice(&made, 30, 30, 100, 0, 0.3, &stuff, &seed);
    const uint32_t regular = made.spring_count;
    recipe_lattice(&made, 20, 20, 200, 0, 1, &stuff, &seed);
    recipe_rope(&made, 5, 700, 12, &stuff, &seed);
    recipe_disturb(&made, 0, 0, &seed); // gives all springs the distances of their ends
    for (uint32_t s = regular; s < made.spring_count; s++) {
        made.springs[s].rest_length *= (float)support_random_between(&seed, 0.99, 1.01);
    }
    return made;
}

static void check_rest_lengths(const mspring_network *network, const recipe *made) {
    for (mspring_id s = 0; s < made->spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        assert_true(info.rest_length == made->springs[s].rest_length);
    }
}

static void rest_lengths_are_those_given(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_network *network = recipe_network(&made, NULL);
    check_rest_lengths(network, &made);
    // One of a shared one changes, alone; then the last of all.
    const mspring_id edited[] = {100, made.spring_count - 1};
    for (size_t i = 0; i < COUNT_OF(edited); i++) {
        made.springs[edited[i]].rest_length = 0.5f;
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, edited[i], 1, &made.springs[edited[i]].rest_length, 1));
        check_rest_lengths(network, &made);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void shared_rest_lengths_take_no_memory(void **state) {
    (void)state;
    uint64_t seed = 5;
    size_t used[2];
    for (int regular = 0; regular < 2; regular++) {
        recipe made = {0};
        recipe_lattice(&made, 160, 100, 0, 0, 1, &stuff, &seed);
        recipe_disturb(&made, regular ? 0 : 0.01, 0, &seed);
        for (uint32_t s = 0; !regular && s < made.spring_count; s++) {
            made.springs[s].rest_length *= (float)support_random_between(&seed, 0.99, 1.01);
        }
        mspring_network *network = recipe_network(&made, NULL);
        used[regular] = support_memory_used(network);
        if (regular) {
            const float rest_length = 1.5f;
            check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 3, 1, &rest_length, 1));
            // Now each has its own.
            assert_true(support_memory_used(network) >= used[1] + (size_t)160 * 100 * 15);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
    assert_true(used[0] >= used[1] + (size_t)160 * 100 * 15); // 16 bytes per particle, less the table
}

static void an_edit_without_memory_changes_nothing(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    watched_allocator watched = {0};
    mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def(-9.8f, 3);
    def.allocator = &allocator;
    mspring_network *network = recipe_network(&made, &def);
    const float rest_length = 0.5f;
    watched.fail_at = watched.calls + 1;
    assert_int_equal(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 7, 1, &rest_length, 1),
                     MSPRING_ERROR_MEMORY);
    assert_string_not_equal(mspring_network_error(network), "");
    check_rest_lengths(network, &made);
    watched.fail_at = 0;
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 7, 1, &rest_length, 1));
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_lengths_are_those_given),
        cmocka_unit_test(shared_rest_lengths_take_no_memory),
        cmocka_unit_test(an_edit_without_memory_changes_nothing),
    };
    return cmocka_run_group_tests_name("rests", tests, NULL, NULL);
}
