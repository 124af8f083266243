/// @file test_messages.c
/// Error texts: of the last call, never of one before.
///
/// SPDX-License-Identifier: MIT
#include <string.h>

#include "support.h"

static mspring_network *make(void) {
    mspring_builder *builder = support_builder();
    support_spring(builder, support_particle(builder, 0, 0, 1), support_particle(builder, 1, 0, 1), 10, 0);
    mspring_network_def def = support_def(-9.8f, 1);
    return support_network(builder, &def);
}

static void a_builder_that_goes_on_has_no_message(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_spring_def spring;
    mspring_rope_def rope;
    const uint16_t cell = 0;
    mspring_material material;
    mspring_lattice_def lattice;
    mspring_network *network = NULL;
    check_ok(mspring_spring_def_init(&spring, sizeof spring));
    check_ok(mspring_rope_def_init(&rope, sizeof rope));
    check_ok(mspring_material_init(&material, sizeof material));
    check_ok(mspring_lattice_def_init(&lattice, sizeof lattice));
    lattice.width = lattice.height = 1;
    lattice.cells = &cell;
    lattice.materials = &material;
    lattice.material_count = 1;
    for (int call = 0; call < 5; call++) {
        check_error(mspring_builder_add_particle(builder, NULL, NULL), MSPRING_ERROR_ARGUMENT);
        assert_true(strlen(mspring_builder_error(builder)) > 0);
        if (call == 0) {
            support_particle(builder, 5, 0, 1);
        } else if (call == 1) {
            check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
        } else if (call == 2) {
            support_spring(builder, 0, 1, 1, 0);
        } else if (call == 3) {
            rope.from = 0;
            rope.to = 1;
            rope.segment_count = 2;
            check_ok(mspring_builder_add_rope(builder, &rope, NULL, 0, NULL));
        } else {
            check_ok(mspring_network_create(builder, NULL, &network));
        }
        assert_string_equal(mspring_builder_error(builder), "");
    }
    assert_string_equal(mspring_network_error(network), "");
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
}

static void ids_that_are_not_set_are_told_so(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_spring_def spring;
    mspring_rope_def rope;
    check_ok(mspring_spring_def_init(&spring, sizeof spring));
    check_ok(mspring_rope_def_init(&rope, sizeof rope));
    check_error(mspring_builder_add_spring(builder, &spring, NULL), MSPRING_ERROR_ID);
    assert_string_equal(mspring_builder_error(builder), "spring 0: its particle a is not set (MSPRING_NONE)");
    spring.a = 0;
    check_error(mspring_builder_add_spring(builder, &spring, NULL), MSPRING_ERROR_ID);
    assert_string_equal(mspring_builder_error(builder), "spring 0: its particle b is not set (MSPRING_NONE)");
    check_error(mspring_builder_add_rope(builder, &rope, NULL, 0, NULL), MSPRING_ERROR_ID);
    assert_string_equal(mspring_builder_error(builder), "rope: its end from is not set (MSPRING_NONE)");
    mspring_builder_destroy(builder);

    builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network_def def = support_def(0, 1);
    def.spare_springs = 1;
    mspring_network *network = support_network(builder, &def);
    mspring_id id = MSPRING_NONE;
    check_error(mspring_network_add_springs(network, &spring, 1, &id), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "its particle b is not set (MSPRING_NONE)");
    check_error(mspring_network_break_springs(network, &id, 1), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "MSPRING_NONE is no spring");
    check_error(mspring_network_apply_force(network, MSPRING_NONE, 1, 1), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "MSPRING_NONE is no particle");
    mspring_network_destroy(network);
}

static void a_call_clears_what_was_said_before(void **state) {
    (void)state;
    mspring_network *network = make();
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "dt is -1");
    check_ok(mspring_network_step(network, 0.001));
    assert_string_equal(mspring_network_error(network), "");

    // Shared calls leave the text alone, whether they fail or not.
    double x, y;
    check_error(mspring_network_get_positions(network, 9, 1, &x, &y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network), "");
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_get_positions(network, 0, 1, &x, &y, 1));
    check_error(mspring_network_get_positions(network, 9, 1, &x, &y, 1), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "dt is -1");

    // So does a view to read; one to write takes it away.
    mspring_view view = {.struct_size = sizeof view};
    mspring_mutable_view writable = {.struct_size = sizeof writable};
    check_ok(mspring_network_view(network, &view));
    check_contains(mspring_network_error(network), "dt is -1");
    check_ok(mspring_network_view_mutable(network, &writable));
    assert_string_equal(mspring_network_error(network), "");
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_builder_that_goes_on_has_no_message),
        cmocka_unit_test(ids_that_are_not_set_are_told_so),
        cmocka_unit_test(a_call_clears_what_was_said_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
