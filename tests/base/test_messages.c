/// @file test_messages.c
/// Error texts: of the last call that failed, never of one before a call that succeeded.
///
/// SPDX-License-Identifier: MIT
#include <string.h>

#include <massspring/massspring_batch.h>
#include <massspring/massspring_contact.h>
#include <massspring/massspring_laws.h>

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
    check_contains(mspring_network_error(network), "there is no spring MSPRING_NONE (not set)");
    check_error(mspring_network_apply_force(network, MSPRING_NONE, 1, 1), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "there is no particle MSPRING_NONE (not set)");
    mspring_network_destroy(network);
}

/// Whatever has an id: one that was never set is no number.
static void no_unset_id_is_told_as_a_number(void **state) {
    (void)state;
    const mspring_id none = MSPRING_NONE, corners[3] = {0, MSPRING_NONE, 1};
    mspring_network *network = make();
    mspring_builder *builder = support_builder();
    mspring_spring_info spring = {.struct_size = sizeof spring};
    mspring_collider_def collider = {.struct_size = sizeof collider};
    mspring_grip_def grip, had = {.struct_size = sizeof had};
    mspring_area_def area;
    mspring_hook_def hook;
    mspring_contact_def contact;
    float value = 1;
    check_ok(mspring_grip_def_init(&grip, sizeof grip));
    check_ok(mspring_area_def_init(&area, sizeof area));
    check_ok(mspring_hook_def_init(&hook, sizeof hook));
    check_ok(mspring_contact_def_init(&contact, sizeof contact));
    contact.thickness = 0.1;
    check_ok(mspring_network_set_contact(network, &contact));
#define CHECK_UNSET(call, text)                                                                                    \
    do {                                                                                                           \
        check_ok(mspring_network_wake(network));                                                                   \
        check_error((call), MSPRING_ERROR_ID);                                                                     \
        check_contains(mspring_network_error(network), text);                                                      \
    } while (0)
    CHECK_UNSET(mspring_network_add_grip(network, &grip, NULL), "the grip's particle is not set (MSPRING_NONE)");
    CHECK_UNSET(mspring_network_remove_grip(network, none), "no grip MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_get_grip(network, none, &had), "no grip MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_get_spring(network, none, &spring), "no spring MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_remove_hook(network, none), "no hook MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_get_collider(network, none, &collider), "no collider MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_remove_area(network, none), "no area MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_add_area(network, &area, corners, 3, NULL), "particle MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_set_actuators(network, &none, 1, 1), "no spring MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_mark_groups(network, &none, 1), "no group MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_set(network, MSPRING_MASS, none, 1, &value, 1), "from id MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_get_at(network, MSPRING_STIFFNESS, &none, 1, &value, 1), "MSPRING_NONE (not set)");
    check_error(mspring_builder_add_network(builder, network, &none, 1, NULL, NULL), MSPRING_ERROR_ID);
    check_contains(mspring_builder_error(builder), "index 0 of the list: the network has no particle MSPRING_NONE");
    mspring_builder_destroy(builder);
    mspring_network_destroy(network);
}

/// One particle is in no list, and all that is full says what to do.
static void a_call_names_what_it_was_given(void **state) {
    (void)state;
    mspring_network *network = make();
    mspring_particle_def particles[2];
    mspring_grip_def grip;
    mspring_id ids[2];
    check_error(mspring_network_apply_force(network, 7, 1, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network), "there is no particle 7: ids are below 2");
    check_error(mspring_network_apply_forces_at(network, &(mspring_id){7}, 1, &(float){1}, &(float){1}, 1),
                MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network),
                        "index 0 of the list: there is no particle 7: ids are below 2");
    for (int i = 0; i < 2; i++)
        check_ok(mspring_particle_def_init(&particles[i], sizeof particles[i]));
    check_error(mspring_network_add_particles(network, particles, 2, ids), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "spare_particles (mspring_network_def) is 0");
    check_ok(mspring_grip_def_init(&grip, sizeof grip));
    grip.particle = 0;
    for (uint32_t i = 0; i < MSPRING_MAX_GRIPS; i++)
        check_ok(mspring_network_add_grip(network, &grip, NULL));
    check_error(mspring_network_add_grip(network, &grip, NULL), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "16 grips, as many as it may have (MSPRING_MAX_GRIPS)");
    mspring_network_destroy(network);

    mspring_builder *builder = support_builder();
    particles[1].reserved = 7;
    check_error(mspring_builder_add_particles(builder, particles, 2, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_builder_error(builder), "particle 1: mspring_particle_def.reserved is 7");
    mspring_network_def def = support_def(0, 1);
    def.spare_springs = MSPRING_MAX_SPRINGS + 1;
    (void)support_particle(builder, 0, 0, 1);
    check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_LIMIT);
    check_contains(mspring_builder_error(builder), "spare_springs is 268435457");
    mspring_builder_destroy(builder);
}

static void a_call_clears_what_was_said_before(void **state) {
    (void)state;
    mspring_network *network = make();
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "dt is -1");
    check_ok(mspring_network_step(network, 0.001));
    assert_string_equal(mspring_network_error(network), "");

    // A shared call that succeeds leaves the text alone; one to write takes it away.
    double x, y;
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_get_positions(network, 0, 1, &x, &y, 1));
    mspring_view view = {.struct_size = sizeof view};
    mspring_mutable_view writable = {.struct_size = sizeof writable};
    check_ok(mspring_network_view(network, &view));
    check_contains(mspring_network_error(network), "dt is -1");
    check_ok(mspring_network_view_mutable(network, &writable));
    assert_string_equal(mspring_network_error(network), "");
    mspring_network_destroy(network);
}

/// The first since the last exclusive call says what was wrong, whichever threads others come from.
static void shared_calls_leave_messages(void **state) {
    (void)state;
    mspring_network *network = make(), *clone = NULL;
    double x, y;
    const mspring_id list[] = {1, 5};
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_positions(network, 9, 1, &x, &y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network), "1 particle from id 9 on: ids are below 2");
    check_error(mspring_network_get_positions_at(network, list, 2, &x, &y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network), "1 particle from id 9 on: ids are below 2");
    check_ok(mspring_network_wake(network));
    assert_string_equal(mspring_network_error(network), "");
    check_error(mspring_network_get_positions_at(network, list, 2, &x, &y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network),
                        "index 1 of the list: there is no particle 5: ids are below 2");
    check_ok(mspring_network_clone(network, NULL, &clone));
    assert_string_equal(mspring_network_error(clone), "");
    mspring_network_destroy(clone);
    mspring_clone_def def;
    check_ok(mspring_clone_def_init(&def, sizeof def));
    def.flags = 64;
    check_ok(mspring_network_wake(network));
    check_error(mspring_network_clone(network, &def, &clone), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "clone flags 0x40");
    mspring_network_destroy(network);
}

static void MSPRING_CALL ask_for_removed(const mspring_hook_args *args, void *user) {
    double x, y;
    const mspring_id removed = 7;
    (void)user;
    check_error(mspring_network_get_positions_at(args->network, &removed, 1, &x, &y, 1), MSPRING_ERROR_ID);
}

/// Hooks on several threads may ask for too much at once. Why a step failed comes first.
static void hooks_leave_messages(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 100; i++)
        support_particle(builder, i, 0, 1);
    mspring_network_def def = support_def(-9.8f, 1);
    def.worker_count = 3;
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_remove_particles(network, &(mspring_id){7}, 1));
    mspring_hook_def hook;
    check_ok(mspring_hook_def_init(&hook, sizeof hook));
    hook.fn = ask_for_removed;
    hook.flags = MSPRING_HOOK_CONCURRENT;
    hook.range_slots = 16;
    check_ok(mspring_network_add_hook(network, &hook, NULL));
    check_ok(mspring_network_step(network, 0.001));
    check_contains(mspring_network_error(network), "particle 7 has been removed");
    check_ok(support_set_guard(network, MSPRING_GUARD_BOUNDS));
    check_ok(support_set_gravity(network, 0, 3e38f));
    check_error(mspring_network_step(network, 10), MSPRING_ERROR_UNSTABLE);
    assert_null(strstr(mspring_network_error(network), "removed"));
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_builder_that_goes_on_has_no_message),
        cmocka_unit_test(ids_that_are_not_set_are_told_so),
        cmocka_unit_test(no_unset_id_is_told_as_a_number),
        cmocka_unit_test(a_call_names_what_it_was_given),
        cmocka_unit_test(a_call_clears_what_was_said_before),
        cmocka_unit_test(shared_calls_leave_messages),
        cmocka_unit_test(hooks_leave_messages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
