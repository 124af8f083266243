/// @file test_copies.c
/// Copies of a builder's content: ids, places, and what is refused.
///
/// SPDX-License-Identifier: MIT
#include "support.h"

/// Offsets lie a stride apart; without offsets all copies are in one place.
static void copies_go_where_their_offsets_say(void **state) {
    (void)state;
    mspring_builder *one = support_builder(), *builder = support_builder();
    support_particle(one, 1, 0, 1);
    support_particle(one, 2, 0, 1);
    support_spring(one, 0, 1, 10, 0);
    const double offsets[] = {10, 0, 20, 5, 30, 9};
    mspring_id particle = 77, spring = 77;
    check_ok(mspring_builder_add_copies(builder, one, 3, offsets, offsets + 1, 2, &particle, &spring));
    assert_true(particle == 0 && spring == 0);
    check_ok(mspring_builder_add_copies(builder, one, 2, NULL, NULL, 1, &particle, &spring));
    assert_true(particle == 6 && spring == 3);
    check_error(mspring_builder_add_copies(builder, one, 2, offsets, NULL, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_builder_add_copies(builder, builder, 2, NULL, NULL, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "one of the arrays");
    const double far[] = {0, 1e12};
    check_error(mspring_builder_add_copies(builder, one, 2, far, far, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "copy 1");
    mspring_particle_def read = mspring_particle_def_default();
    check_ok(mspring_builder_get_particles(builder, NULL, 3, 1, &read));
    assert_true(read.x == 22 && read.y == 5);
    mspring_spring_def joined = mspring_spring_def_default();
    check_ok(mspring_builder_get_springs(builder, NULL, 2, 1, &joined));
    assert_true(joined.a == 4 && joined.b == 5 && joined.rest_length == 1);
    mspring_builder_destroy(one);
    mspring_builder_destroy(builder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_go_where_their_offsets_say),
    };
    return cmocka_run_group_tests_name("copies", tests, NULL, NULL);
}
