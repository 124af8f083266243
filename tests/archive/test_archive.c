/// @file test_archive.c
/// Archives: a network that was written and read goes on as the one that was not, and is written as the same bytes.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "archives.h"
#include "golden.h"
#include "growth.h"

/* ------------------------------------------------------------------------------------------------ all of them */

static void every_scene_goes_on(void **state) {
    (void)state;
    for (uint32_t i = 0; i < golden_scene_count; i++) {
        const golden_scene *scene = &golden_scenes[i];
        if (scene->make == NULL || (scene->takes_long && ROUNDS_ARE_FEW))
            continue;
        mspring_network_def def = support_def(-9.8f, scene->substeps);
        mspring_network *network = scene->make(&def);
        const uint32_t half = scene->steps / 2 < 60 ? scene->steps / 2 : 60;
        for (uint32_t step = 0; step < half; step++) {
            if (scene->before_step != NULL)
                scene->before_step(network, step);
            support_steps(network, 1, scene->dt);
        }
        mspring_network *other = archives_check_same(network, 1 + i % 3);
        for (uint32_t step = half; step < scene->steps && step < half + 20; step++) {
            if (scene->before_step != NULL) {
                scene->before_step(network, step);
                scene->before_step(other, step);
            }
            support_steps(network, 1, scene->dt);
            support_steps(other, 1, scene->dt);
            if (support_hash(network) != support_hash(other))
                fail_msg("%s differs in step %u", scene->name, step);
        }
        mspring_network_destroy(other);
        mspring_network_destroy(network);
    }
}

static void a_bit_of_everything_goes_on(void **state) {
    (void)state;
    for (int kind = 0; kind < ARCHIVES_KINDS; kind++) {
        mspring_network *network = archives_make(kind);
        for (int again = 0; again < 3; again++) {
            mspring_network *other = archives_check_same(network, 1 + (uint32_t)again);
            archives_check_goes_on(network, other, 10);
            mspring_network_destroy(other);
        }
        mspring_network_destroy(network);
    }
}

// Additions, removals, recycled ids, breaks: ids stay, and so do the bits of networks that are not compact. Compact
// ones have the layout of a compaction now, so their bits may differ, but no byte of the archive does.
static void a_life_goes_on(void **state) {
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        recipe made = growth_recipe();
        life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 131 + (uint64_t)kind);
        if (kind & 1)
            growth_use(it->network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 0);
        for (int round = 0; round < ROUNDS(15); round++) {
            for (int i = 0; i < 9; i++)
                life_do_something(it);
            if (kind >= 2 && round % 3 == 1)
                check_ok(mspring_network_compact(it->network));
            support_steps(it->network, 1, 1.0 / 64);
            life other = *it;
            other.network = archives_check_same(it->network, 1);
            life_check(&other);
            assert_int_equal(support_hash(it->network), support_hash(other.network));
            for (int i = 0; i < 5; i++) {
                life_do_something(it);
                life_do_something(&other);
                support_steps(it->network, 1, 1.0 / 64);
                support_steps(other.network, 1, 1.0 / 64);
                if (kind < 2)
                    assert_int_equal(support_hash(it->network), support_hash(other.network));
            }
            mspring_network_destroy(other.network);
        }
        growth_end(it);
        recipe_free(&made);
    }
}

static void a_compact_network_goes_on(void **state) {
    (void)state;
    for (int solver = 0; solver < 3; solver++) {
        uint64_t seed = 5;
        recipe made = recipe_mixed(8);
        mspring_network_def def = support_def(-9.8f, 4);
        mspring_network *network = recipe_network(&made, &def);
        const mspring_solver kinds[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
        growth_use(network, kinds[solver], MSPRING_INTEGRATOR_EULER, 0);
        support_steps(network, 3, 1.0 / 64);
        for (int i = 0; i < 40; i++) {
            const mspring_id spring =
                (mspring_id)(support_random(&seed) % mspring_network_count(network, MSPRING_SPRINGS));
            check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        }
        check_ok(mspring_network_compact(network));
        support_steps(network, 3, 1.0 / 64);
        mspring_network *other = archives_check_same(network, 2);
        archives_check_goes_on(network, other, 10);
        mspring_network_destroy(other);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void a_compact_network_has_the_layout_of_its_solver_then(void **state) {
    (void)state;
    recipe made = recipe_mixed(8);
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.solver = MSPRING_SOLVER_IMPLICIT;
    mspring_network *network = recipe_network(&made, &def);
    for (mspring_id spring = 0; spring < 40; spring++)
        check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_compact(network));
    growth_use(network, MSPRING_SOLVER_EXPLICIT, MSPRING_INTEGRATOR_ALPHA, 0);
    support_steps(network, 3, 1.0 / 64);
    mspring_network *other = archives_check_same(network, 1);
    archives_check_goes_on(network, other, 10);
    mspring_network_destroy(other);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* --------------------------------------------------------------------------------------------- one by one */

static void floor_and_colliders_are_as_given(void **state) {
    (void)state;
    mspring_network *network = archives_make(9), *other = archives_check_same(network, 1);
    mspring_floor_def floors[2] = {{.struct_size = sizeof floors[0]}, {.struct_size = sizeof floors[0]}};
    mspring_collider_def colliders[2] = {{.struct_size = sizeof colliders[0]},
                                         {.struct_size = sizeof colliders[0]}};
    mspring_contact_def contacts[2] = {{.struct_size = sizeof contacts[0]}, {.struct_size = sizeof contacts[0]}};
    mspring_network *const both[2] = {network, other};
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_get_floor(both[i], &floors[i]));
        check_ok(mspring_network_get_collider(both[i], 0, &colliders[i]));
        check_ok(mspring_network_get_contact(both[i], &contacts[i]));
    }
    contacts[0].max_capacity = contacts[1].max_capacity = 0; // by the outline of the last step
    assert_memory_equal(&contacts[0], &contacts[1], sizeof contacts[0]);
    assert_memory_equal(floors[0].planes, floors[1].planes, 8 * sizeof(double));
    assert_memory_equal(floors[0].heights, floors[1].heights, 4 * sizeof(float));
    assert_memory_equal(floors[0].plane_frictions, floors[1].plane_frictions, 2 * sizeof(float));
    assert_memory_equal(floors[0].height_restitutions, floors[1].height_restitutions, 3 * sizeof(float));
    assert_null(floors[1].plane_restitutions);
    assert_true(floors[1].silt_depth == 0.5f && floors[1].silt_rate == 1 && floors[1].spacing == 5);
    assert_memory_equal(colliders[0].points, colliders[1].points, 6 * sizeof(double));
    assert_int_equal(colliders[1].flags, MSPRING_COLLIDER_CLOSED);
    // ids go on: 0 to 2 are there, 3 was removed
    mspring_collider_def circle;
    mspring_id id = 0;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &circle, sizeof circle));
    circle.kind = MSPRING_COLLIDER_CIRCLE, circle.radius = 1, circle.x = 50;
    check_error(mspring_network_get_collider(other, 3, &circle), MSPRING_ERROR_ID);
    check_ok(mspring_network_add_collider(other, &circle, &id));
    assert_int_equal(id, 4);
    mspring_network_destroy(other);
    mspring_network_destroy(network);
}

/// Silt by sample comes behind all that older files have, and only if there is some.
static void floors_have_their_silt(void **state) {
    (void)state;
    static const float depths[4] = {0.5f, 0, 3, 1.25f};
    mspring_network *network = archives_make(9);
    mspring_floor_def def = {.struct_size = sizeof def};
    size_t sizes[2];
    for (int i = 0; i < 2; i++) {
        mspring_network *other = archives_check_same(network, 1);
        const archived archive = archives_write(network);
        (void)archives_chunk(&archive, "floo", &sizes[i]);
        free(archive.bytes);
        check_ok(mspring_network_get_floor(other, &def));
        assert_true(def.silt_depth == (i == 0 ? 0.5f : 0) && (def.silt_depths != NULL) == i);
        if (def.silt_depths)
            assert_memory_equal(def.silt_depths, depths, sizeof depths);
        mspring_network_destroy(other);
        check_ok(mspring_network_get_floor(network, &def));
        def.silt_depth = 0, def.silt_depths = depths;
        check_ok(mspring_network_set_floor(network, &def));
    }
    assert_int_equal(sizes[1] - sizes[0], sizeof(uint32_t) + sizeof depths);
    mspring_network_destroy(network);
}

/// What reading an archive allocates is freed with the builder and the network.
static void reading_keeps_no_memory(void **state) {
    (void)state;
    for (int kind = 0; kind < ARCHIVES_KINDS; kind++) {
        mspring_network *network = archives_make(kind), *read = NULL;
        const archived archive = archives_write(network);
        watched_allocator watched = {0};
        const mspring_allocator allocator = watched_interface(&watched);
        mspring_builder *builder = NULL;
        mspring_network_def def = {.struct_size = sizeof def};
        check_ok(mspring_builder_create(&allocator, &builder));
        check_ok(mspring_builder_read(builder, archive.bytes, archive.size, NULL));
        check_ok(mspring_builder_get_network_def(builder, &def));
        def.allocator = &allocator;
        check_ok(mspring_network_create(builder, &def, &read));
        mspring_builder_destroy(builder);
        mspring_network_destroy(read);
        mspring_network_destroy(network);
        free(archive.bytes);
        check_watched_clean(&watched);
    }
}

static void groups_go_back_to_their_marks(void **state) {
    (void)state;
    for (int to = 0; to < 2; to++) {
        mspring_network *network = archives_make(11), *other = archives_check_same(network, 1);
        assert_int_equal(mspring_network_count(other, MSPRING_GROUPS), 1);
        assert_int_equal(mspring_network_count(other, MSPRING_ACTUATORS), 2);
        const float signals[2] = {1.5f, 0.75f};
        for (int i = 0; i < 2; i++) {
            mspring_network *one = i == 0 ? network : other;
            check_ok(mspring_network_reset_groups(one, to == 0 ? MSPRING_RESET_START : MSPRING_RESET_MARK, NULL, 0,
                                                  MSPRING_ALL));
            check_ok(mspring_network_set(one, MSPRING_SIGNAL, NULL, 0, 2, signals, 1));
        }
        archives_check_goes_on(network, other, 10);
        mspring_network_destroy(other);
        mspring_network_destroy(network);
    }
}

static void sleepers_sleep_on(void **state) {
    (void)state;
    recipe made = recipe_bar(12, 3, 1e5);
    mspring_network_def def = support_def(0, 4);
    def.settings.sleep_speed = 0.1f, def.settings.sleep_time = 0.1f;
    mspring_network *network = recipe_network(&made, &def);
    support_fall_asleep(network, 1.0 / 64);
    mspring_network *other = archives_check_same(network, 1);
    assert_true(support_sleeps(other, 5));
    archives_check_goes_on(network, other, 3);
    assert_true(support_sleeps(other, 5));
    mspring_network_destroy(other);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void particles_without_springs_fall_on(void **state) {
    (void)state;
    for (uint32_t count = 1; count < 40; count += 19) {
        mspring_builder *builder = support_builder();
        for (uint32_t i = 0; i < count; i++)
            support_particle(builder, i, 0.5 * i, 1);
        mspring_network *network = support_network(builder, NULL);
        support_steps(network, 3, 1.0 / 64);
        mspring_network *other = archives_check_same(network, 1);
        archives_check_goes_on(network, other, 3);
        mspring_network_destroy(other);
        mspring_network_destroy(network);
    }
}

static void events_have_room(void **state) {
    (void)state;
    mspring_network *network = archives_make(0), *other = archives_check_same(network, 1);
    mspring_event events[20];
    uint32_t count = 9;
    const mspring_id spring = 6;
    check_ok(mspring_network_read_events(other, events, 20, &count, NULL));
    assert_int_equal(count, 0);
    check_ok(mspring_network_break_springs(other, &spring, 0, 1));
    check_ok(mspring_network_read_events(other, events, 20, &count, NULL));
    assert_int_equal(count, 1);
    mspring_network_destroy(other);
    mspring_network_destroy(network);
}


// A shared message of a network that could not be written, by what its host's function said.
static mspring_result MSPRING_CALL refuse(const void *bytes, size_t size, void *user) {
    (void)bytes;
    *(size_t *)user += size;
    return *(size_t *)user > 100 ? MSPRING_ERROR_LIMIT : MSPRING_OK;
}

static void the_hosts_function_may_refuse(void **state) {
    (void)state;
    mspring_network *network = archives_make(0);
    size_t seen = 0;
    check_error(mspring_network_write(network, refuse, &seen), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "the host's function returned -4");
    check_error(mspring_network_write(network, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_write(NULL, refuse, NULL), MSPRING_ERROR_ARGUMENT);
    mspring_network_destroy(network);
}

/* -------------------------------------------------------------------------------------------- the definition */

static void a_definition_may_change_the_rest(void **state) {
    (void)state;
    mspring_network *network = archives_make(2), *other = NULL;
    const archived archive = archives_write(network);
    mspring_builder *builder = support_builder();
    mspring_network_def def = {.struct_size = sizeof def};
    check_ok(mspring_builder_read(builder, archive.bytes, archive.size, NULL));
    check_ok(mspring_builder_get_network_def(builder, &def));
    assert_int_equal(def.settings.solver, MSPRING_SOLVER_IMPLICIT);
    assert_int_equal(def.settings.coarse_period, 8);
    assert_true(def.settings.gravity_y == -9.8f);
    def.settings.gravity_y = -1;
    def.settings.solver = MSPRING_SOLVER_EXPLICIT;
    def.worker_count = 2;
    def.simd_level = MSPRING_SIMD_SCALAR;
    check_ok(mspring_network_create(builder, &def, &other));
    assert_true(support_settings(other).gravity_y == -1);
    assert_int_equal(support_solver(other).solver, MSPRING_SOLVER_EXPLICIT);
    assert_int_equal(support_hash(other), support_hash(network));
    mspring_network_destroy(other);
    def.spare_springs++;
    check_error(mspring_network_create(builder, &def, &other), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "mspring_builder_get_network_def()");
    support_particle(builder, 0, 0, 1);
    check_error(mspring_network_create(builder, NULL, &other), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "others were added");
    check_error(mspring_builder_read(builder, archive.bytes, archive.size, NULL), MSPRING_ERROR_ARGUMENT);
    mspring_builder_destroy(builder);
    free(archive.bytes);
    mspring_network_destroy(network);
}

// It has the tiles that suited the springs there were. Others may suit those that are left.
// What archives do not hold must not show in later ones.
static void later_edits_meet_the_same(void **state) {
    (void)state;
    const mspring_observation columns[2] = {{MSPRING_END_A, 3}, {MSPRING_ACTUATOR_SPRING, 1}};
    const mspring_id removed = 9;
    const float limit = 0.25f;
    mspring_network *networks[2] = {archives_make(11), NULL};
    double rows[2][2];
    check_ok(mspring_network_remove_springs(networks[0], &removed, 0, 1)); // that of an actuator
    check_ok(support_set_guard(networks[0], MSPRING_GUARD_BOUNDS));
    networks[1] = archives_check_same(networks[0], 1);
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_observe_groups(networks[i], NULL, 0, 1, columns, 2, rows[i], 2));
        check_ok(mspring_network_set_groups(networks[i], NULL, 0));
        check_ok(mspring_network_set(networks[i], MSPRING_PLASTIC_LIMIT, NULL, 0, MSPRING_ALL, &limit, 0));
        check_ok(mspring_network_set_actuators(networks[i], NULL, 0, 1));
        check_ok(support_set_guard(networks[i], MSPRING_GUARD_IMPLICIT));
    }
    assert_memory_equal(rows[0], rows[1], sizeof rows[0]);
    archives_check_goes_on(networks[0], networks[1], 5);
    mspring_network_destroy(networks[1]);
    mspring_network_destroy(networks[0]);
}

// It is made anew when the guard is chosen again: one of before would fit the shape of then.
static void a_fallback_is_of_its_guard(void **state) {
    (void)state;
    mspring_network *network = archives_make(1); // with this guard
    check_ok(support_set_guard(network, MSPRING_GUARD_CLAMP));
    mspring_network *other = archives_check_same(network, 1);
    check_ok(support_set_guard(network, MSPRING_GUARD_IMPLICIT));
    check_ok(support_set_guard(other, MSPRING_GUARD_IMPLICIT));
    archives_check_goes_on(network, other, 3);
    mspring_network_destroy(other);
    mspring_network_destroy(network);
}

static void a_fallback_keeps_its_tiles(void **state) {
    (void)state;
    for (uint64_t start = 0; start < 40; start++) {
        const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 100}};
        uint64_t seed = start;
        recipe made = {0};
        for (int i = 0; i < 10; i++)
            recipe_particle(&made, i % 5, 3 * (i % 3) + i, 1, 0);
        recipe_random_springs(&made, 7, &stuff, &seed);
        mspring_network_def def = support_def(-9.8f, 4);
        def.settings.guard = MSPRING_GUARD_IMPLICIT;
        def.settings.solver = start % 2 == 0 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_EXPLICIT;
        mspring_network *network = recipe_network(&made, &def);
        for (mspring_id spring = 0; spring < 4 && spring < made.spring_count; spring++)
            check_ok(mspring_network_remove_springs(network, &spring, 0, 1));
        mspring_network *other = archives_check_same(network, 1);
        if (start % 2 == 1)
            archives_check_goes_on(network, other, 3);
        mspring_network_destroy(other);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/* --------------------------------------------------------------------------------------------------- read-back */

// Definitions read back from a builder make the same network: its archive has the same bytes.
static void a_builder_gives_back_what_it_has(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    for (uint32_t s = 0; s < made.spring_count; s++) {
        made.springs[s].break_strain = s % 3 == 0 ? 0.5f : MSPRING_NEVER;
        made.springs[s].yield_strain = s % 4 == 0 ? 0.25f : MSPRING_NEVER;
        made.springs[s].rest_length = s % 5 == 0 ? 0 : made.springs[s].rest_length;
    }
    mspring_builder *builder = recipe_builder(&made, NULL), *again = support_builder();
    const uint32_t particles = made.particle_count, springs = made.spring_count;
    mspring_particle_def *p = calloc(particles, sizeof *p);
    mspring_spring_def *s = calloc(springs, sizeof *s);
    for (uint32_t i = 0; i < particles; i++)
        p[i].struct_size = sizeof *p;
    for (uint32_t i = 0; i < springs; i++)
        s[i].struct_size = sizeof *s;
    check_ok(mspring_builder_get_particles(builder, NULL, 0, particles, p));
    check_ok(mspring_builder_get_springs(builder, NULL, 0, springs, s));
    check_ok(mspring_builder_add_particles(again, p, particles, NULL));
    check_ok(mspring_builder_add_springs(again, s, springs, NULL));
    mspring_network *networks[2] = {NULL, NULL};
    check_ok(mspring_network_create(builder, NULL, &networks[0]));
    check_ok(mspring_network_create(again, NULL, &networks[1]));
    const archived a = archives_write(networks[0]), b = archives_write(networks[1]);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.bytes, b.bytes, a.size);
    // lists, and what is wrong with a call
    const mspring_id ids[2] = {springs - 1, 0};
    mspring_spring_def two[2] = {{.struct_size = sizeof two[0]}, {.struct_size = sizeof two[0]}};
    check_ok(mspring_builder_get_springs(builder, ids, 0, 2, two));
    assert_memory_equal(&two[0], &s[springs - 1], sizeof two[0]);
    assert_memory_equal(&two[1], &s[0], sizeof two[0]);
    check_error(mspring_builder_get_springs(builder, NULL, springs, 1, two), MSPRING_ERROR_ID);
    check_contains(support_builder_error(builder), "1 from id");
    const mspring_id far_one = particles;
    check_error(mspring_builder_get_particles(builder, &far_one, 0, 1, p), MSPRING_ERROR_ID);
    check_error(mspring_builder_get_particles(builder, NULL, 0, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_builder_get_particles(NULL, NULL, 0, 1, p), MSPRING_ERROR_ARGUMENT);
    two[0].struct_size = 3; // that of the first counts
    check_error(mspring_builder_get_springs(builder, ids, 0, 2, two), MSPRING_ERROR_STRUCT);
    free(a.bytes);
    free(b.bytes);
    free(p);
    free(s);
    for (int i = 0; i < 2; i++)
        mspring_network_destroy(networks[i]);
    mspring_builder_destroy(again);
    mspring_builder_destroy(builder);
    recipe_free(&made);
}

// Flow stretches the longest rest length that may be given beyond it.
static void the_longest_springs_go_on(void **state) {
    (void)state;
    const float longest = 4e12f, strain = 0.9f;
    mspring_network *network = archives_make(0);
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, MSPRING_ALL, &longest, 0));
    check_ok(mspring_network_set(network, MSPRING_PLASTIC_STRAIN, NULL, 0, MSPRING_ALL, &strain, 0));
    mspring_network_destroy(archives_check_same(network, 1));
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_goes_on),
        cmocka_unit_test(a_bit_of_everything_goes_on),
        cmocka_unit_test(a_life_goes_on),
        cmocka_unit_test(a_compact_network_goes_on),
        cmocka_unit_test(a_compact_network_has_the_layout_of_its_solver_then),
        cmocka_unit_test(floor_and_colliders_are_as_given),
        cmocka_unit_test(floors_have_their_silt),
        cmocka_unit_test(reading_keeps_no_memory),
        cmocka_unit_test(groups_go_back_to_their_marks),
        cmocka_unit_test(sleepers_sleep_on),
        cmocka_unit_test(particles_without_springs_fall_on),
        cmocka_unit_test(events_have_room),
        cmocka_unit_test(the_hosts_function_may_refuse),
        cmocka_unit_test(a_definition_may_change_the_rest),
        cmocka_unit_test(later_edits_meet_the_same),
        cmocka_unit_test(a_fallback_is_of_its_guard),
        cmocka_unit_test(a_fallback_keeps_its_tiles),
        cmocka_unit_test(a_builder_gives_back_what_it_has),
        cmocka_unit_test(the_longest_springs_go_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
