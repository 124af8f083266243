/// @file test_into_builder.c
/// Networks put into a builder: whole, in part, several together.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

static recipe mixed_recipe(void) {
    uint64_t seed = 8;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {100, 200}, .damping = {0, 1}, .holes = 0.1, .pinned = 0.02};
    recipe made = {0};
    recipe_lattice(&made, 20, 9, 0, 0, 1, &stuff, &seed);
    recipe_rope(&made, 0, made.particle_count - 1, 12, &stuff, &seed);
    recipe_particle(&made, 40, 2, 1, MSPRING_PARTICLE_PINNED);
    recipe_disturb(&made, 0.01, 0.1, &seed);
    return made;
}

static mspring_network *mixed_network(void) {
    recipe made = mixed_recipe();
    mspring_network_def def = support_def(-9.8f, 4);
    def.spare_springs = def.spare_particles = 4;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static mspring_network *copy_of(const mspring_network *network) {
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_network(builder, network, NULL, 0, MSPRING_ALL, NULL, NULL));
    mspring_network_def def = support_def(-9.8f, support_solver(network).substeps);
    return support_network(builder, &def);
}

static void new_network_steps_with_the_same_bits(void **state) {
    (void)state;
    mspring_network *network = mixed_network(), *copy = copy_of(network);
    for (int i = 0; i < 50; i++) {
        assert_int_equal(support_hash(copy), support_hash(network));
        support_steps(network, 1, 0.01);
        support_steps(copy, 1, 0.01);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(copy);
}

static void moved_network_goes_on_but_for_rounding(void **state) {
    (void)state;
    mspring_network *network = mixed_network();
    support_steps(network, 100, 0.01);
    mspring_network *copy = copy_of(network);
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    assert_int_equal(mspring_network_count(copy, MSPRING_PARTICLES), count);
    for (int round = 0; round < 2; round++) {
        for (mspring_id i = 0; i < count; i++) {
            const support_point a = support_position(network, i), b = support_position(copy, i);
            // Positions of 20 m have a last place of 2e-6; springs turn that into 1e-4 m/s^2.
            check_near(a.x, b.x, round == 0 ? 1e-9 : 1e-3);
            check_near(a.y, b.y, round == 0 ? 1e-9 : 1e-3);
        }
        support_steps(network, 10, 0.01);
        support_steps(copy, 10, 0.01);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(copy);
}

/// What was edited is as it is now.
static void edits_are_taken_over(void **state) {
    (void)state;
    mspring_network *network = mixed_network();
    const mspring_id broken[2] = {3, 17}, gone = 30;
    const float mass = 7, stiffness = 55, rest = 1.25f, scale[2] = {0.5f, 0};
    mspring_particle_def particle;
    mspring_id added;
    check_ok(mspring_network_break_springs(network, broken, 0, 2));
    check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 5, 1, &mass, 1));
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 20, 1, &stiffness, 1));
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 21, 1, &rest, 1));
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 6, 2, scale, 1));
    check_ok(mspring_network_remove_particles(network, &gone, 0, 1));
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    particle.x = -30, particle.vx = 2, particle.flags = MSPRING_PARTICLE_PINNED;
    check_ok(mspring_network_add_particles(network, &particle, 1, &added));

    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES),
                   springs = mspring_network_count(network, MSPRING_SPRINGS);
    mspring_id *particle_ids = test_malloc(particles * sizeof *particle_ids);
    mspring_id *spring_ids = test_malloc(springs * sizeof *spring_ids);
    mspring_builder *builder = support_builder();
    const mspring_id lone = support_particle(builder, 100, 0, 1); // ids begin behind what is there
    check_ok(mspring_builder_add_network(builder, network, NULL, 0, MSPRING_ALL, particle_ids, spring_ids));
    mspring_network *copy = support_network(builder, NULL);
    mspring_id next = lone + 1;
    for (mspring_id i = 0; i < particles; i++) {
        if (i == gone) {
            assert_int_equal(particle_ids[i], MSPRING_NONE);
            continue;
        }
        assert_int_equal(particle_ids[i], next++);
        float had, has, had_scale, has_scale;
        check_ok(mspring_network_get(network, MSPRING_MASS, NULL, i, 1, &had, 1));
        check_ok(mspring_network_get(copy, MSPRING_MASS, NULL, particle_ids[i], 1, &has, 1));
        check_ok(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, i, 1, &had_scale, 1));
        check_ok(mspring_network_get(copy, MSPRING_INVERSE_MASS_SCALE, NULL, particle_ids[i], 1, &has_scale, 1));
        assert_true(has == had && has_scale == (had_scale > 0 ? 1 : 0));
        const support_point v = support_velocity(network, i), w = support_velocity(copy, particle_ids[i]);
        assert_true(v.x == w.x && v.y == w.y);
    }
    assert_int_equal(mspring_network_count(copy, MSPRING_PARTICLES), next);
    next = 0;
    for (mspring_id s = 0; s < springs; s++) {
        support_spring_info had, has;
        if (support_get_spring(network, s, &had) != MSPRING_OK || had.flags & MSPRING_SPRING_BROKEN) {
            assert_int_equal(spring_ids[s], MSPRING_NONE);
            continue;
        }
        assert_int_equal(spring_ids[s], next++);
        check_ok(support_get_spring(copy, spring_ids[s], &has));
        assert_int_equal(has.a, particle_ids[had.a]);
        assert_int_equal(has.b, particle_ids[had.b]);
        assert_true(has.rest_length == had.rest_length && has.nominal_stiffness == had.nominal_stiffness &&
                    has.nominal_damping == had.nominal_damping);
    }
    assert_int_equal(mspring_network_count(copy, MSPRING_SPRINGS), next);
    assert_int_equal(spring_ids[3], MSPRING_NONE);
    test_free(particle_ids);
    test_free(spring_ids);
    mspring_network_destroy(network);
    mspring_network_destroy(copy);
}

/// A layout of the live springs alone holds the same.
static void compact_network_gives_the_same(void **state) {
    (void)state;
    mspring_network *network = mixed_network();
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    for (mspring_id s = 0; s < springs; s += 2)
        check_ok(mspring_network_break_springs(network, &s, 0, 1));
    mspring_network *before = copy_of(network);
    check_ok(mspring_network_compact(network));
    mspring_network *after = copy_of(network);
    assert_int_equal(mspring_network_count(before, MSPRING_SPRINGS), springs / 2);
    assert_int_equal(mspring_network_count(after, MSPRING_SPRINGS), springs / 2);
    for (int i = 0; i < 10; i++) {
        assert_int_equal(support_hash(before), support_hash(after));
        support_steps(before, 1, 0.01);
        support_steps(after, 1, 0.01);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(before);
    mspring_network_destroy(after);
}

/// A chain of six, cut in the middle: its two halves by their components, and together again.
static void parts_are_split_and_merged(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 6; i++)
        support_particle(builder, i, 0, 1);
    for (mspring_id i = 0; i < 5; i++)
        support_spring(builder, i, i + 1, 10, 0);
    mspring_network *network = support_network(builder, NULL);
    const mspring_id middle = 2;
    check_ok(mspring_network_break_springs(network, &middle, 0, 1));

    builder = support_builder();
    mspring_id right[] = {5, 3, 4, 3}, left[] = {0, 1, 2}, particle_ids[6], spring_ids[5];
    check_ok(mspring_builder_add_network(builder, network, right, 0, COUNT_OF(right), particle_ids, spring_ids));
    const mspring_id none = MSPRING_NONE, of_right[] = {none, none, none, 0, 1, 2},
                     springs[] = {none, none, none, 0, 1};
    assert_memory_equal(particle_ids, of_right, sizeof of_right);
    assert_memory_equal(spring_ids, springs, sizeof springs);
    check_ok(mspring_builder_add_network(builder, network, left, 0, COUNT_OF(left), particle_ids, NULL));
    const mspring_id of_left[] = {3, 4, 5, none, none, none};
    assert_memory_equal(particle_ids, of_left, sizeof of_left);
    check_ok(mspring_builder_add_network(builder, network, left, 0, 0, particle_ids, spring_ids)); // nothing
    assert_int_equal(particle_ids[0], none);
    assert_int_equal(spring_ids[0], none);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 6);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 4);
    mspring_network *merged = support_network(builder, NULL);
    assert_true(support_position(merged, 5).x == 2);
    mspring_network_destroy(merged);
    mspring_network_destroy(network);
}

static void relative_springs_stay_relative(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = support_particle(builder, 0, 0, 1), def.b = support_particle(builder, 1, 0, 2);
    def.stiffness = 0.25f, def.damping = 0.5f, def.flags = MSPRING_SPRING_RELATIVE;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
    mspring_network *network = support_network(builder, NULL);
    support_steps(network, 1, 0.01);
    mspring_network *copy = copy_of(network);
    support_spring_info info;
    check_ok(support_get_spring(copy, 0, &info));
    assert_int_equal(info.flags, MSPRING_SPRING_RELATIVE);
    assert_true(info.nominal_stiffness == 0.25f && info.nominal_damping == 0.5f && info.stiffness == 0);
    mspring_network_destroy(network);
    mspring_network_destroy(copy);
}

static void bad_selection_is_refused(void **state) {
    (void)state;
    mspring_network *network = mixed_network();
    mspring_builder *builder = support_builder();
    mspring_id list[2] = {1, mspring_network_count(network, MSPRING_PARTICLES)};
    check_error(mspring_builder_add_network(builder, network, list, 0, 2, NULL, NULL), MSPRING_ERROR_ID);
    check_contains(support_builder_error(builder), "no particle");
    list[1] = 2;
    check_ok(mspring_network_remove_particles(network, &list[1], 0, 1));
    check_error(mspring_builder_add_network(builder, network, list, 0, 2, NULL, NULL), MSPRING_ERROR_ID);
    check_contains(support_builder_error(builder), "index 1 of the list: particle 2");
    check_error(mspring_builder_add_network(builder, network, list, 0, MSPRING_ALL, NULL, NULL),
                MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "MSPRING_ALL");
    check_error(mspring_builder_add_network(builder, network, NULL, 3, MSPRING_ALL - 1, NULL, NULL),
                MSPRING_ERROR_ID);
    check_contains(support_builder_error(builder), "from id 3 on");
    check_error(mspring_builder_add_network(builder, NULL, NULL, 0, MSPRING_ALL, NULL, NULL),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_builder_add_network(NULL, network, NULL, 0, MSPRING_ALL, NULL, NULL),
                MSPRING_ERROR_ARGUMENT);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 0);
    mspring_builder_destroy(builder);
    mspring_network_destroy(network);
}

// Steps may lead beyond what a builder takes.
static void what_has_left_the_world_is_refused(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    (void)support_particle(builder, MSPRING_MAX_COORDINATE - 2, 0, 1);
    (void)support_particle(builder, MSPRING_MAX_COORDINATE - 1, 0, 1);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    support_set_velocity(network, 1, 1e5f, 0);
    support_steps(network, 1, 1);
    builder = support_builder();
    check_error(mspring_builder_add_network(builder, network, NULL, 0, MSPRING_ALL, NULL, NULL),
                MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "particle 1");
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);
    check_ok(mspring_builder_add_network(builder, network, NULL, 0, 1, NULL, NULL));
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 1);
    mspring_builder_destroy(builder);
    mspring_network_destroy(network);
}

// Areas and angles go along, but for those that are open, or have a particle that does not; then they are copied.
static mspring_network *with_areas(mspring_id *gas, mspring_id *hinges) {
    recipe made = {0};
    uint64_t seed = 9;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {200, 200}};
    recipe_lattice(&made, 20, 9, 0, 0, 1, &stuff, &seed);
    const mspring_network_def def = support_def(-9.8f, 20);
    mspring_network *network = recipe_network(&made, &def);
    const mspring_id ring[] = {0, 19, 179, 160}, three[] = {3, 4, 5, 4, 5, 6};
    mspring_area_def area;
    mspring_angle_def angle;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
    area.stiffness = 90;
    check_ok(mspring_network_add_cell_areas(network, &area, NULL, NULL));
    area.kind = MSPRING_AREA_GAS;
    area.stiffness = 0;
    area.pressure = 5;
    check_ok(mspring_network_add_area(network, &area, ring, 4, gas));
    angle.stiffness = 4;
    angle.damping = 0.1f;
    check_ok(mspring_network_add_angles(network, &angle, three, 2, 3, hinges));
    recipe_free(&made);
    return network;
}

static void areas_go_along(void **state) {
    (void)state;
    mspring_id gas, hinges, broken = 0;
    const double bend = 0.25;
    mspring_network *network = with_areas(&gas, &hinges), *copy = copy_of(network);
    check_ok(support_set_rest_angles(network, hinges, 2, &bend, 0));
    check_ok(mspring_network_remove_elements(network, NULL, 0, 1)); // ids are other ones in the copy
    mspring_network_destroy(copy);
    copy = copy_of(network);
    mspring_angle_def angle = {.struct_size = sizeof angle};
    check_ok(support_get_angle(copy, hinges - 1, &angle));
    check_near(angle.rest_angle, bend, 0);
    for (int i = 0; i < 20; i++) {
        support_steps(network, 1, 1.0 / 64);
        support_steps(copy, 1, 1.0 / 64);
        assert_int_equal(support_hash(copy), support_hash(network));
    }
    mspring_network_destroy(copy);
    // The lower left quarter alone has neither the gas nor what is open.
    check_ok(mspring_network_break_springs(network, &broken, 0, 1));
    mspring_id some[50];
    for (mspring_id i = 0; i < 50; i++)
        some[i] = i / 10 * 20 + i % 10;
    mspring_builder *part = support_builder(), *copies = support_builder();
    const double x[] = {0, 30}, y[] = {0, 0};
    check_ok(mspring_builder_add_network(part, network, some, 0, 50, NULL, NULL));
    check_ok(mspring_builder_add_copies(copies, part, 2, x, y, 1, NULL, NULL));
    mspring_builder_destroy(part);
    const mspring_network_def def = support_def(-9.8f, 20);
    copy = support_network(copies, &def);
    support_area_info info;
    mspring_id areas = 0, angles = 0;
    for (mspring_id id = 0; id < 200; id++) {
        areas += support_get_area_info(copy, id, &info) == MSPRING_OK;
        angles += support_get_angle(copy, id, &angle) == MSPRING_OK;
    }
    assert_int_equal(areas, 2 * (4 * 9 - 1));
    assert_int_equal(angles, 2 * 2);
    support_steps(copy, 5, 1.0 / 64);
    for (mspring_id p = 0; p < 50; p++)
        check_near(support_position(copy, p + 50).y, support_position(copy, p).y, 1e-5);
    mspring_network_destroy(copy);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_go_along),
        cmocka_unit_test(new_network_steps_with_the_same_bits),
        cmocka_unit_test(moved_network_goes_on_but_for_rounding),
        cmocka_unit_test(edits_are_taken_over),
        cmocka_unit_test(compact_network_gives_the_same),
        cmocka_unit_test(parts_are_split_and_merged),
        cmocka_unit_test(relative_springs_stay_relative),
        cmocka_unit_test(bad_selection_is_refused),
        cmocka_unit_test(what_has_left_the_world_is_refused),
    };
    return cmocka_run_group_tests_name("into_builder", tests, NULL, NULL);
}
