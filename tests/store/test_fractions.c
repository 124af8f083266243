/// @file test_fractions.c
/// Fractions of relative springs, which are kept once where many springs have the same.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

/// A lattice whose springs have so many different fractions, every ninth spring being absolute.
static recipe mixed_recipe(uint32_t kinds) {
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {100, 200}, .damping = {1, 2}};
    uint64_t seed = 6;
    recipe made = {0};
    recipe_lattice(&made, 40, 20, 0, 0, 1, &stuff, &seed);
    for (uint32_t s = 0; s < made.spring_count; s++) {
        if (s % 9 == 0) {
            continue;
        }
        made.springs[s].flags = MSPRING_SPRING_RELATIVE;
        made.springs[s].stiffness = 0.1f + 0.3f * (float)(s % kinds) / (float)kinds;
        made.springs[s].damping = 0.05f;
    }
    return made;
}

static void check_fractions(const mspring_network *network, const recipe *made) {
    for (uint32_t s = 0; s < made->spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        const bool relative = s % 9 != 0;
        assert_int_equal((info.flags & MSPRING_SPRING_RELATIVE) != 0, relative);
        assert_true(info.nominal_stiffness == made->springs[s].stiffness);
        assert_true(info.nominal_damping == made->springs[s].damping);
    }
}

/// Up to 256 kinds are told apart by a byte; one of them is that of springs that are not relative.
static void fractions_are_those_given(void **state) {
    (void)state;
    const uint32_t kinds[] = {1, 7, 254, 255, 256, 257, 1000};
    for (size_t i = 0; i < COUNT_OF(kinds); i++) {
        recipe made = mixed_recipe(kinds[i]);
        mspring_network *network = recipe_network(&made, NULL);
        const size_t used = support_memory_used(network);
        check_fractions(network, &made);
        // An edit that changes nothing, and one that does.
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 100, 1, &made.springs[100].stiffness, 1));
        assert_int_equal(support_memory_used(network), used);
        made.springs[100].stiffness = 0.77f;
        made.springs[made.spring_count - 1].damping = 0.02f;
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 100, 1, &made.springs[100].stiffness, 1));
        check_ok(mspring_network_set(network, MSPRING_DAMPING, NULL, made.spring_count - 1, 1, &made.springs[made.spring_count - 1].damping, 1));
        check_fractions(network, &made);
        assert_int_equal(support_memory_used(network) > used, kinds[i] <= 255);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void edits_of_absolute_springs_share_on(void **state) {
    (void)state;
    recipe made = mixed_recipe(3);
    mspring_network *network = recipe_network(&made, NULL);
    const size_t used = support_memory_used(network);
    made.springs[90].stiffness = 55;
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 90, 1, &made.springs[90].stiffness, 1));
    check_fractions(network, &made);
    assert_int_equal(support_memory_used(network), used);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// What another network was saved with comes from its snapshot, too.
static void snapshots_bring_fractions(void **state) {
    (void)state;
    recipe made = mixed_recipe(3);
    mspring_network *edited = recipe_network(&made, NULL), *network = recipe_network(&made, NULL);
    made.springs[100].stiffness = 0.77f;
    check_ok(mspring_network_set(edited, MSPRING_STIFFNESS, NULL, 100, 1, &made.springs[100].stiffness, 1));
    support_bring(edited, network, MSPRING_SNAPSHOT_ALL);
    check_fractions(network, &made);
    assert_int_equal(support_hash(network), support_hash(edited));
    for (int i = 0; i < 3; i++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
        check_ok(mspring_network_step(edited, 1.0 / 64));
    }
    assert_int_equal(support_hash(network), support_hash(edited));
    mspring_network_destroy(network);
    mspring_network_destroy(edited);
    recipe_free(&made);
}

static void an_edit_without_memory_changes_nothing(void **state) {
    (void)state;
    recipe made = mixed_recipe(3);
    watched_allocator watched = {0};
    mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def(-9.8f, 3);
    def.allocator = &allocator;
    mspring_network *network = recipe_network(&made, &def);
    const float fraction = 0.3f;
    watched.fail_at = watched.calls + 1;
    assert_int_equal(mspring_network_set(network, MSPRING_DAMPING, NULL, 7, 1, &fraction, 1), MSPRING_ERROR_MEMORY);
    check_contains(mspring_network_error(network), "memory");
    check_fractions(network, &made);
    watched.fail_at = 0;
    check_ok(mspring_network_set(network, MSPRING_DAMPING, NULL, 7, 1, &fraction, 1));
    made.springs[7].damping = fraction;
    check_fractions(network, &made);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    recipe_free(&made);
}

/// Stiffness and damping of an absolute spring are those set, by a list, too, though others of its lattice are
/// relative.
static void absolute_springs_take_their_own(void **state) {
    (void)state;
    recipe made = mixed_recipe(3);
    mspring_network *network = recipe_network(&made, NULL);
    for (mspring_id s = 0; s < made.spring_count; s += 3) {
        made.springs[s].stiffness = s % 9 == 0 ? 150 + (float)s : 0.2f;
        made.springs[s].damping = s % 9 == 0 ? 3 : 0.04f;
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, &s, 0, 1, &made.springs[s].stiffness, 1));
        check_ok(mspring_network_set(network, MSPRING_DAMPING, &s, 0, 1, &made.springs[s].damping, 1));
    }
    check_fractions(network, &made);
    mspring_network *made_so = recipe_network(&made, NULL);
    support_steps(network, 2, 0.01);
    support_steps(made_so, 2, 0.01);
    assert_true(support_hash(network) == support_hash(made_so));
    mspring_network_destroy(network);
    mspring_network_destroy(made_so);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fractions_are_those_given),
        cmocka_unit_test(absolute_springs_take_their_own),
        cmocka_unit_test(edits_of_absolute_springs_share_on),
        cmocka_unit_test(snapshots_bring_fractions),
        cmocka_unit_test(an_edit_without_memory_changes_nothing),
    };
    return cmocka_run_group_tests_name("fractions", tests, NULL, NULL);
}
