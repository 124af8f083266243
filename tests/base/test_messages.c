/// @file test_messages.c
/// Error texts: of the last call that failed, never of one before a call that succeeded.
///
/// SPDX-License-Identifier: MIT
#include <string.h>

#include <massspring/massspring.h>

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
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &rope, sizeof rope));
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    rope.material = &material;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
    lattice.width = lattice.height = 1;
    lattice.cells = &cell;
    lattice.materials = &material;
    lattice.material_count = 1;
    for (int call = 0; call < 5; call++) {
        check_error(mspring_builder_add_particles(builder, NULL, 1, NULL), MSPRING_ERROR_ARGUMENT);
        assert_true(strlen(support_builder_error(builder)) > 0);
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
            check_ok(mspring_builder_add_rope(builder, &rope, NULL, NULL));
        } else {
            check_ok(mspring_network_create(builder, NULL, &network));
        }
        assert_string_equal(mspring_builder_error(builder), "");
    }
    assert_string_equal(mspring_network_error(network), "");
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
}

/// A builder that a call has failed on, after one that added a particle.
static mspring_builder *failed_builder(void) {
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_spring_def spring = mspring_spring_def_default();
    spring.a = 0, spring.b = 4711;
    check_error(mspring_builder_add_springs(builder, &spring, 1, NULL), MSPRING_ERROR_ID);
    return builder;
}

static void check_first_failure(const mspring_builder *builder) {
    check_contains(mspring_builder_error(builder), "4711");
}

/// Bytes of an archive of one network.
typedef struct archive_bytes {
    uint8_t bytes[8192];
    size_t size;
} archive_bytes;

static mspring_result MSPRING_CALL keep_bytes(const void *bytes, size_t size, void *user) {
    archive_bytes *archive = user;
    assert_true(size <= sizeof archive->bytes - archive->size);
    memcpy(archive->bytes + archive->size, bytes, size);
    archive->size += size;
    return MSPRING_OK;
}

/// Later calls on the builder do what they always do, but tell the first failure, and so does create.
static void the_first_failure_of_a_builder_is_kept(void **state) {
    (void)state;
    mspring_builder *builder = failed_builder();
    mspring_network *network = NULL;
    mspring_id first = MSPRING_NONE;
    const mspring_particle_def good = mspring_particle_def_default();
    check_ok(mspring_builder_add_particles(builder, &good, 1, &first));
    assert_int_equal(first, 1);
    check_first_failure(builder);
    // A later failure has a result of its own, but the first one stays.
    check_error(mspring_builder_add_particles(builder, NULL, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_first_failure(builder);
    check_error(mspring_builder_add_copies(builder, NULL, 1, NULL, NULL, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_first_failure(builder);
    for (int i = 0; i < 2; i++) { // create doesn't forget it
        check_error(mspring_network_create(builder, NULL, &network), MSPRING_ERROR_ID);
        assert_null(network);
        check_first_failure(builder);
    }
    mspring_builder_forget_error(builder);
    assert_string_equal(mspring_builder_error(builder), "");
    check_ok(mspring_network_create(builder, NULL, &network));
    assert_int_equal(mspring_network_count(network, MSPRING_PARTICLES), 2);
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    mspring_builder_forget_error(NULL);
    assert_string_equal(mspring_builder_error(NULL), "");
}

/// What create refuses describes nothing: the builder can be used with another definition.
static void create_leaves_no_failure_of_its_own(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = NULL;
    def.worker_count = 0;
    check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_builder_error(builder), "worker_count");
    def.worker_count = 1;
    check_ok(mspring_network_create(builder, &def, &network));
    assert_string_equal(mspring_builder_error(builder), "");
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
}

/// Copies of a builder that failed would lack something: the failure goes on to the builder that asks for them.
static void copies_take_the_failure_of_their_builder(void **state) {
    (void)state;
    mspring_builder *from = failed_builder(), *builder = support_builder();
    mspring_network *network = NULL;
    mspring_id first = 77;
    support_particle(builder, 5, 0, 1);
    check_error(mspring_builder_add_copies(builder, from, 3, NULL, NULL, 1, &first, NULL), MSPRING_ERROR_ID);
    check_first_failure(builder);
    check_first_failure(from);
    assert_int_equal(first, 77);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 1);
    check_error(mspring_network_create(builder, NULL, &network), MSPRING_ERROR_ID);
    mspring_builder_forget_error(from);
    mspring_builder_forget_error(builder);
    check_ok(mspring_builder_add_copies(builder, from, 3, NULL, NULL, 1, &first, NULL));
    assert_int_equal(first, 1);
    check_ok(mspring_network_create(builder, NULL, &network));
    assert_int_equal(mspring_network_count(network, MSPRING_PARTICLES), 4);
    mspring_network_destroy(network);
    mspring_builder_destroy(from);
    mspring_builder_destroy(builder);
}

/// A bad archive is a failure, too, and a good one doesn't hide an earlier failure.
static void reading_keeps_the_first_failure(void **state) {
    (void)state;
    mspring_network *network = make(), *read = NULL;
    mspring_builder *builder = support_builder();
    archive_bytes archive = {.size = 0};
    const mspring_spring_def unset = mspring_spring_def_default();
    check_ok(mspring_network_write(network, keep_bytes, &archive));
    check_error(mspring_builder_add_springs(builder, &unset, 1, NULL), MSPRING_ERROR_ID);
    check_ok(mspring_builder_read(builder, archive.bytes, archive.size, NULL));
    check_contains(mspring_builder_error(builder), "particle a is not set");
    check_error(mspring_network_create(builder, NULL, &read), MSPRING_ERROR_ID);
    mspring_builder_forget_error(builder);
    check_ok(mspring_network_create(builder, NULL, &read));
    assert_true(support_hash(read) == support_hash(network));
    mspring_network_destroy(read);
    mspring_builder_destroy(builder);

    builder = support_builder();
    check_error(mspring_builder_read(builder, archive.bytes, archive.size / 2, NULL), MSPRING_ERROR_SNAPSHOT);
    support_particle(builder, 0, 0, 1);
    read = NULL;
    check_error(mspring_network_create(builder, NULL, &read), MSPRING_ERROR_SNAPSHOT);
    assert_true(strlen(mspring_builder_error(builder)) > 0);
    mspring_builder_forget_error(builder);
    check_ok(mspring_network_create(builder, NULL, &read));
    mspring_network_destroy(read);
    mspring_builder_destroy(builder);
    mspring_network_destroy(network);
}

static void ids_that_are_not_set_are_told_so(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_spring_def spring;
    mspring_rope_def rope;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &rope, sizeof rope));
    check_error(mspring_builder_add_springs(builder, &spring, 1, NULL), MSPRING_ERROR_ID);
    assert_string_equal(support_builder_error(builder), "spring 0: its particle a is not set (MSPRING_NONE)");
    spring.a = 0;
    check_error(mspring_builder_add_springs(builder, &spring, 1, NULL), MSPRING_ERROR_ID);
    assert_string_equal(support_builder_error(builder), "spring 0: its particle b is not set (MSPRING_NONE)");
    check_error(mspring_builder_add_rope(builder, &rope, NULL, NULL), MSPRING_ERROR_ID);
    assert_string_equal(support_builder_error(builder), "rope: its end from is not set (MSPRING_NONE)");
    mspring_builder_destroy(builder);

    builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network_def def = support_def(0, 1);
    def.spare_springs = 1;
    mspring_network *network = support_network(builder, &def);
    mspring_id id = MSPRING_NONE;
    check_error(mspring_network_add_springs(network, &spring, 1, &id), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "its particle b is not set (MSPRING_NONE)");
    check_error(mspring_network_break_springs(network, &id, 0, 1), MSPRING_ERROR_ID);
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
    support_spring_info spring;
    mspring_collider_def collider = {.struct_size = sizeof collider};
    mspring_grip_def grip, had = {.struct_size = sizeof had};
    mspring_area_def area;
    mspring_hook_def hook;
    mspring_contact_def contact;
    float value = 1;
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
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
    CHECK_UNSET(support_get_spring(network, none, &spring), "no spring MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_remove_hook(network, none), "no hook MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_get_collider(network, none, &collider), "no collider MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_remove_elements(network, &none, 0, 1), "no element MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_remove_elements(network, NULL, none, 1), "from id MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_add_area(network, &area, corners, 3, NULL), "particle MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_set_actuators(network, &none, 1, 1), "no spring MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_mark_groups(network, &none, 0, 1), "no group MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_set(network, MSPRING_MASS, NULL, none, 1, &value, 1),
                "from id MSPRING_NONE (not set)");
    CHECK_UNSET(mspring_network_get(network, MSPRING_STIFFNESS, &none, 0, 1, &value, 1), "MSPRING_NONE (not set)");
    check_error(mspring_builder_add_network(builder, network, &none, 0, 1, NULL, NULL), MSPRING_ERROR_ID);
    check_contains(support_builder_error(builder),
                   "index 0 of the list: there is no particle MSPRING_NONE (not set)");
    mspring_builder_destroy(builder);
    mspring_network_destroy(network);
}

/// Ranges and lists: the message has what the call was given.
static void wrong_selections_are_named(void **state) {
    (void)state;
    mspring_network *network = make();
    const mspring_id list[] = {9, 1, 5};
    double x[3], y[3];
    const float mass = 2, masses[2] = {3, 4};
    check_error(mspring_network_get_positions(network, list, 1, 2, x, y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network),
                        "index 2 of the list: there is no particle 5: ids are below 2");
    check_ok(mspring_network_wake(network));
    check_error(mspring_network_get_positions(network, NULL, 1, UINT32_MAX - 1, x, y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network), "4294967294 particles from id 1 on: ids are below 2");
    check_ok(mspring_network_wake(network));
    check_error(mspring_network_get_positions(network, NULL, 0, MSPRING_ALL, x, y, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "MSPRING_ALL, but arrays depend on it");
    check_error(mspring_network_set(network, MSPRING_MASS, NULL, 0, MSPRING_ALL, masses, 1),
                MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "MSPRING_ALL, but arrays depend on it");
    check_error(mspring_network_set(network, MSPRING_MASS, list, 1, MSPRING_ALL, &mass, 0), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "MSPRING_ALL, but there is a list of ids");
    check_error(mspring_network_set(network, MSPRING_MASS, NULL, 3, MSPRING_ALL, &mass, 0), MSPRING_ERROR_ID);
    check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 1, MSPRING_ALL, &mass, 0));
    float read[2];
    check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, 2, read, 1));
    assert_true(read[0] == 1 && read[1] == 2);
    check_error(mspring_network_get(network, MSPRING_MASS, NULL, 0, 2, read, 0), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "the stride is 0");
    check_ok(mspring_network_break_springs(network, NULL, 1, MSPRING_ALL)); // none
    check_ok(mspring_network_break_springs(network, NULL, 0, MSPRING_ALL));
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
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, &(mspring_id){7}, 0, 1, &(float){1},
                                             &(float){1}, 1),
                MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network),
                        "index 0 of the list: there is no particle 7: ids are below 2");
    for (int i = 0; i < 2; i++)
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particles[i], sizeof particles[i]));
    check_error(mspring_network_add_particles(network, particles, 2, ids), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "spare_particles (mspring_network_def) is 0");
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    grip.particle = 0;
    for (uint32_t i = 0; i < MSPRING_MAX_GRIPS; i++)
        check_ok(mspring_network_add_grip(network, &grip, NULL));
    check_error(mspring_network_add_grip(network, &grip, NULL), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "16 grips, as many as it may have (MSPRING_MAX_GRIPS)");
    mspring_network_destroy(network);

    mspring_builder *builder = support_builder();
    particles[1].reserved = 7;
    check_error(mspring_builder_add_particles(builder, particles, 2, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "particle 1: mspring_particle_def.reserved is 7");
    mspring_network_def def = support_def(0, 1);
    def.spare_springs = MSPRING_MAX_SPRINGS + 1;
    (void)support_particle(builder, 0, 0, 1);
    check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_LIMIT);
    check_contains(support_builder_error(builder), "spare_springs is 268435457");
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
    check_ok(mspring_network_get_positions(network, NULL, 0, 1, &x, &y, 1));
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    check_contains(mspring_network_error(network), "dt is -1");
    check_ok(mspring_network_wake(network));
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
    check_error(mspring_network_get_positions(network, NULL, 9, 1, &x, &y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network), "1 particle from id 9 on: ids are below 2");
    check_error(mspring_network_get_positions(network, list, 0, 2, &x, &y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network), "1 particle from id 9 on: ids are below 2");
    check_ok(mspring_network_wake(network));
    assert_string_equal(mspring_network_error(network), "");
    check_error(mspring_network_get_positions(network, list, 0, 2, &x, &y, 1), MSPRING_ERROR_ID);
    assert_string_equal(mspring_network_error(network),
                        "index 1 of the list: there is no particle 5: ids are below 2");
    check_ok(mspring_network_clone(network, NULL, &clone));
    assert_string_equal(mspring_network_error(clone), "");
    mspring_network_destroy(clone);
    mspring_clone_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def));
    def.copy_hooks = 64;
    check_ok(mspring_network_wake(network));
    check_error(mspring_network_clone(network, &def, &clone), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "copy_hooks is 64");
    mspring_network_destroy(network);
}

static void MSPRING_CALL ask_for_removed(const mspring_hook_args *args, void *user) {
    double x, y;
    const mspring_id removed = 7;
    (void)user;
    check_error(mspring_network_get_positions(args->network, &removed, 0, 1, &x, &y, 1), MSPRING_ERROR_ID);
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
    check_ok(mspring_network_remove_particles(network, &(mspring_id){7}, 0, 1));
    mspring_hook_def hook;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
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
        cmocka_unit_test(the_first_failure_of_a_builder_is_kept),
        cmocka_unit_test(create_leaves_no_failure_of_its_own),
        cmocka_unit_test(copies_take_the_failure_of_their_builder),
        cmocka_unit_test(reading_keeps_the_first_failure),
        cmocka_unit_test(ids_that_are_not_set_are_told_so),
        cmocka_unit_test(no_unset_id_is_told_as_a_number),
        cmocka_unit_test(wrong_selections_are_named),
        cmocka_unit_test(a_call_names_what_it_was_given),
        cmocka_unit_test(a_call_clears_what_was_said_before),
        cmocka_unit_test(shared_calls_leave_messages),
        cmocka_unit_test(hooks_leave_messages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
