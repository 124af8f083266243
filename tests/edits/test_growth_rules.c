/// @file test_growth_rules.c
/// The rules of adding and removing at run time: memory, ids, what is refused, and ranges in which some are gone.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "growth.h"
#include "support.h"

// No memory is asked for but at the first removal, which has to keep what a broken spring was.
static void adding_allocates_nothing(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    recipe made = growth_recipe();
    mspring_network_def def = support_def(-9.8f, 4);
    def.allocator = &allocator;
    def.spare_particles = SPARE_PARTICLES;
    def.spare_springs = SPARE_SPRINGS;
    life *it = malloc(sizeof *it);
    assert_non_null(it);
    life_begin(it, &made, recipe_network(&made, &def), SPARE_PARTICLES, SPARE_SPRINGS, 4);
    for (int solver = 0; solver <= 1; solver++) {
        if (solver == 1) {
            growth_use(it->network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA, 0);
        }
        size_t calls = watched.calls;
        for (int i = 0; i < 10; i++) {
            life_add(it, 2, 3);
            check_ok(mspring_network_step(it->network, 1.0 / 64));
        }
        assert_int_equal(watched.calls, calls);
        if (solver == 0) {
            life_remove(it);
            life_remove(it);
            const mspring_id first = 3;
            check_ok(mspring_network_break_springs(it->network, &first, 0, 1));
            it->springs[first].is_broken = true;
            check_ok(mspring_network_step(it->network, 1.0 / 64));
            calls = watched.calls;
        }
        for (int i = 0; i < 40; i++) {
            life_do_something(it);
            check_ok(mspring_network_step(it->network, 1.0 / 64));
        }
        assert_int_equal(watched.calls, calls);
    }
    life_check(it);
    growth_end(it);
    check_watched_clean(&watched);
    recipe_free(&made);
}

static void ids_come_back_when_the_host_says_so(void **state) {
    (void)state;
    recipe made = growth_recipe();
    mspring_network *network = growth_network(&made, MSPRING_SIMD_AUTO, 1);
    mspring_particle_def defs[SPARE_PARTICLES];
    mspring_id ids[SPARE_PARTICLES], id = 12345;
    for (uint32_t i = 0; i < SPARE_PARTICLES; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &defs[i], sizeof defs[i]));
        defs[i].x = i;
        defs[i].y = 40;
    }
    check_ok(mspring_network_add_particles(network, defs, SPARE_PARTICLES, ids));
    for (uint32_t i = 0; i < SPARE_PARTICLES; i++) {
        assert_int_equal(ids[i], made.particle_count + i);
    }
    const mspring_id gone[] = {ids[7], ids[3], 0};
    check_ok(mspring_network_remove_particles(network, gone, 0, 3));
    check_error(mspring_network_add_particles(network, defs, 1, &id), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "no room for 1 particle: spare_particles");
    assert_int_equal(id, 12345);
    check_ok(mspring_network_reuse_ids(network));
    check_error(mspring_network_add_particles(network, defs, 3, ids), MSPRING_ERROR_LIMIT);
    check_ok(mspring_network_add_particles(network, defs, 2, ids));
    assert_int_equal(ids[0], gone[1]); // the lowest first; the one that the network was created with never
    assert_int_equal(ids[1], gone[0]);
    assert_int_equal(mspring_network_count(network, MSPRING_PARTICLES), made.particle_count + SPARE_PARTICLES);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void check_refused(mspring_network *network, const mspring_spring_def *defs, uint32_t count,
                          mspring_result error, const char *why) {
    mspring_id ids[3] = {9, 9, 9};
    const uint64_t hash = support_hash(network);
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    check_error(mspring_network_add_springs(network, defs, count, ids), error);
    check_contains(mspring_network_error(network), why);
    if (count == 1) // there is but one that it could be
        assert_null(strstr(mspring_network_error(network), "definition"));
    assert_true(ids[0] == 9 && ids[1] == 9);
    assert_int_equal(mspring_network_count(network, MSPRING_SPRINGS), springs);
    assert_int_equal(support_hash(network), hash);
}

static void wrong_springs_are_refused_and_change_nothing(void **state) {
    (void)state;
    recipe made = growth_recipe();
    mspring_network *network = growth_network(&made, MSPRING_SIMD_AUTO, 1);
    mspring_spring_def defs[3];
    mspring_id ids[3];
    for (int i = 0; i < 3; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &defs[i], sizeof defs[i]));
        defs[i].a = 0;
        defs[i].b = 50 + (mspring_id)i;
        defs[i].stiffness = 10;
    }
    defs[2].b = made.particle_count;
    check_refused(network, defs, 3, MSPRING_ERROR_ID, "definition 2");
    defs[2].b = 50;
    check_refused(network, defs, 3, MSPRING_ERROR_DUPLICATE, "joined by spring");
    defs[2].a = 50, defs[2].b = 0;
    check_refused(network, defs, 3, MSPRING_ERROR_DUPLICATE, "joined by spring");
    defs[2].a = made.springs[4].a, defs[2].b = made.springs[4].b;
    check_refused(network, defs, 3, MSPRING_ERROR_DUPLICATE, "joined by spring 4");
    defs[2].a = 0, defs[2].b = 60, defs[2].flags = MSPRING_SPRING_RELATIVE;
    check_refused(network, defs, 3, MSPRING_ERROR_ARGUMENT, "MSPRING_NETWORK_RESERVE_RELATIVE");
    defs[2].flags = 0, defs[2].stiffness = NAN;
    check_refused(network, defs, 3, MSPRING_ERROR_ARGUMENT, "stiffness");
    defs[2].stiffness = 1, defs[2].rest_length = -2;
    check_refused(network, defs, 3, MSPRING_ERROR_ARGUMENT, "rest length");
    defs[2].rest_length = 1;
    check_ok(mspring_network_add_springs(network, defs, 3, ids));
    assert_true(ids[0] == made.spring_count && ids[2] == made.spring_count + 2);
    const mspring_id gone = 60;
    check_ok(mspring_network_remove_particles(network, &gone, 0, 1));
    assert_false(support_has_spring(network, ids[2]));
    check_refused(network, &defs[2], 1, MSPRING_ERROR_ID, "no particle 60");
    mspring_network_destroy(network);

    mspring_network_def bare = support_def(0, 1);
    network = recipe_network(&made, &bare);
    check_refused(network, defs, 1, MSPRING_ERROR_LIMIT, "no room");
    check_ok(mspring_network_remove_particles(network, &gone, 0, 1)); // that needs no reserve
    check_ok(mspring_network_step(network, 0.01));
    mspring_network_destroy(network);
    recipe_free(&made);
}

// Ranges leave removed ids out, whatever values there are for them.
static void ranges_leave_out_what_is_gone(void **state) {
    (void)state;
    recipe made = growth_recipe();
    mspring_network *network = growth_network(&made, MSPRING_SIMD_AUTO, 1);
    const mspring_id gone[] = {4, 5};
    const uint32_t count = made.particle_count;
    float *mass = calloc(count, sizeof *mass);
    double *x = calloc(count, sizeof *x), *y = calloc(count, sizeof *y);
    assert_true(mass && x && y);
    check_ok(mspring_network_remove_particles(network, gone, 0, 2));
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
    for (uint32_t p = 0; p < count; p++) {
        mass[p] = p == 4 || p == 5 ? 0 : 2;
        x[p] += 100;
    }
    x[5] = NAN;
    check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 0, count, mass, 1));
    check_ok(mspring_network_set_positions(network, NULL, 0, count, x, y, 1));
    check_near(support_position(network, 6).x, x[6], 1e-5);
    mass[6] = 0;
    check_error(mspring_network_set(network, MSPRING_MASS, NULL, 0, count, mass, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_MASS, gone, 0, 2, mass, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_apply_force(network, 5, 1, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_detach_particles(network, gone, 0, 1), MSPRING_ERROR_ID);
    double box[4];
    check_ok(support_get_bounds(network, &box[0], &box[1], &box[2], &box[3]));
    assert_true(box[0] > 80); // nothing was left behind
    support_steps(network, 3, 0.01);
    free(mass);
    free(x);
    free(y);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// All of no spring that was removed is 0, wherever it lies; a broken one still has a length.
static void check_extents(mspring_network *network, const mspring_id *gone, uint32_t count) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    float *of[4];
    for (int i = 0; i < 4; i++) {
        of[i] = calloc(springs, sizeof *of[i]);
        assert_non_null(of[i]);
    }
    check_ok(support_get_extents(network, of[0], of[1], of[2], of[3]));
    for (mspring_id s = 0; s < springs; s++) {
        bool is_gone = false;
        for (uint32_t i = 0; i < count; i++)
            is_gone |= s == gone[i];
        assert_true(is_gone ? of[0][s] == 0 && of[1][s] == 0 && of[2][s] == 0 && of[3][s] == 0 : of[0][s] > 0);
    }
    for (int i = 0; i < 4; i++)
        free(of[i]);
}

static void what_is_gone_has_no_length(void **state) {
    (void)state;
    recipe made = growth_recipe();
    mspring_network *network = growth_network(&made, MSPRING_SIMD_AUTO, 1);
    mspring_spring_def def;
    mspring_id added;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = 0;
    def.b = made.particle_count - 1;
    def.stiffness = 10;
    check_ok(mspring_network_add_springs(network, &def, 1, &added));
    check_extents(network, NULL, 0);
    const mspring_id gone[] = {3, made.spring_count / 2, added}, broken = 5;
    check_ok(mspring_network_remove_springs(network, gone, 0, 3));
    check_ok(mspring_network_break_springs(network, &broken, 0, 1));
    check_extents(network, gone, 3);
    check_ok(mspring_network_compact(network));
    check_extents(network, gone, 3);
    check_ok(support_expand(network));
    check_ok(mspring_network_reuse_ids(network));
    check_extents(network, gone, 3);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(adding_allocates_nothing),
        cmocka_unit_test(ids_come_back_when_the_host_says_so),
        cmocka_unit_test(wrong_springs_are_refused_and_change_nothing),
        cmocka_unit_test(ranges_leave_out_what_is_gone),
        cmocka_unit_test(what_is_gone_has_no_length),
    };
    return cmocka_run_group_tests_name("growth_rules", tests, NULL, NULL);
}
