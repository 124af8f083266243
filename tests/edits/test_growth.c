/// @file test_growth.c
/// Particles and springs that are added and removed at run time: the network is then the one that consists of what
/// is left, to every function, solver and number of workers.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "growth.h"
#include "hosts.h"
#include "life.h"
#include "reference.h"
#include "support.h"

/* -------------------------------------------------------------------------------------------------- the physics */

// A step of the network is one of what it should consist of, in double precision. The tolerance is a few hundred
// last places of coordinates up to 60 m, which is what rounding may come to in so short a time.
static void check_step(life *it, double tolerance) {
    mspring_id ids[LIFE_PARTICLES];
    const double dt = 1.0 / 64;
    recipe left = life_recipe(it, ids);
    reference net = reference_of(&left, 0, (double)-9.8f, 0);
    net.lag = support_step_info(it->network).step_count > 0 ? dt / 4 : 0; // after steps of dt
    check_ok(mspring_network_step(it->network, dt));
    for (int i = 0; i < 4; i++) {
        reference_substep(&net, dt / 4);
    }
    for (uint32_t p = 0; p < net.particle_count; p++) {
        const support_point at = support_position(it->network, ids[p]), v = support_velocity(it->network, ids[p]);
        check_near(at.x, net.particles[p].x, tolerance);
        check_near(at.y, net.particles[p].y, tolerance);
        check_near(v.x, net.particles[p].vx, 100 * tolerance);
        check_near(v.y, net.particles[p].vy, 100 * tolerance);
    }
    reference_free(&net);
    recipe_free(&left);
}

static void moves_as_what_it_consists_of(void **state) {
    (void)state;
    recipe made = growth_recipe();
    for (uint64_t seed = 1; seed <= 3; seed++) {
        life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, seed);
        for (int i = 0; i < 200; i++) {
            life_do_something(it);
            if (i % 4 == 0) {
                life_check(it);
                check_step(it, 1e-4);
            }
        }
        growth_end(it);
    }
    recipe_free(&made);
}

static void moves_so_when_compacted(void **state) {
    (void)state;
    recipe made = growth_recipe();
    for (uint64_t seed = 11; seed <= 13; seed++) {
        life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, seed);
        mspring_job *job = NULL;
        for (int i = 0; i < 200; i++) {
            life_do_something(it);
            if (support_random(&it->seed) % 6 == 0) {
                support_compact(it->network, (uint32_t)(support_random(&it->seed) % 100), &job);
            } else if (support_random(&it->seed) % 40 == 0) {
                check_ok(mspring_network_expand(it->network));
            }
            if (i % 4 == 0) {
                life_check(it);
                check_step(it, 1e-4);
            }
        }
        growth_end(it);
        mspring_job_destroy(job);
    }
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------------------- the bits */

static void push(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->force_x[slot] += 0.1f * args->vy[slot];
    }
}

// Hashes of the states after each of some steps of a random life.
static void live(life *it, bool hooked, uint64_t *hashes, int count) {
    if (hooked) {
        mspring_hook_def hook;
        check_ok(mspring_hook_def_init(&hook, sizeof hook));
        hook.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
        hook.fn = push;
        hook.flags = MSPRING_HOOK_CONCURRENT;
        hook.range_slots = 32;
        check_ok(mspring_network_add_hook(it->network, &hook, NULL));
    }
    for (int i = 0; i < count; i++) {
        life_do_something(it);
        if (i % 16 == 15) {
            check_ok(mspring_network_compact(it->network));
        }
        check_ok(mspring_network_step(it->network, 1.0 / 64));
        hashes[i] = support_hash(it->network);
    }
    growth_end(it);
}

static void same_bits_everywhere(void **state) {
    (void)state;
    enum { STEPS = 60 };
    static const uint32_t workers[] = {1, 2, 3, 8};
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    recipe made = growth_recipe();
    for (int hooked = 0; hooked <= 1; hooked++) {
        uint64_t first[STEPS], hashes[STEPS];
        live(growth_begin(&made, levels[0], 1, 99), hooked, first, STEPS);
        for (uint32_t i = 1; i < level_count + COUNT_OF(workers); i++) {
            const bool by_level = i < level_count;
            live(growth_begin(&made, by_level ? levels[i] : MSPRING_SIMD_AUTO,
                              by_level ? 1 : workers[i - level_count], 99),
                 hooked, hashes, STEPS);
            assert_memory_equal(hashes, first, sizeof first);
        }
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------ other solvers */

// The implicit solver, with iterations enough to come to the last places, and the direct one, which is made anew
// after each edit, solve the same equations; they are linearised a little apart, which is most of the tolerance.
static void implicit_steps_are_those_of_the_direct_solver(void **state) {
    (void)state;
    recipe made = growth_recipe();
    life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 7);
    growth_use(it->network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 100);
    for (int i = 0; i < 60; i++) {
        for (int j = 0; j < 4; j++) {
            life_do_something(it);
        }
        if (i % 20 == 19) {
            check_ok(mspring_network_compact(it->network));
        }
        mspring_network *direct = NULL;
        check_ok(mspring_network_clone(it->network, NULL, &direct));
        growth_use(direct, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_EULER, 0);
        check_ok(mspring_network_step(it->network, 1.0 / 64));
        check_ok(mspring_network_step(direct, 1.0 / 64));
        for (mspring_id p = 0; p < it->particle_end; p++) {
            const support_point at = support_position(it->network, p), want = support_position(direct, p);
            check_near(at.x, want.x, 3e-3);
            check_near(at.y, want.y, 3e-3);
        }
        mspring_network_destroy(direct);
    }
    growth_end(it);
    recipe_free(&made);
}

static void same_bits_from_implicit_workers(void **state) {
    (void)state;
    enum { STEPS = 24 };
    recipe made = growth_recipe();
    uint64_t hashes[3][STEPS];
    for (uint32_t workers = 1; workers <= 3; workers++) {
        life *it = growth_begin(&made, workers == 1 ? MSPRING_SIMD_SCALAR : MSPRING_SIMD_AUTO, workers, 17);
        growth_use(it->network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_GA0, 0);
        for (int i = 0; i < STEPS; i++) {
            life_do_something(it);
            life_do_something(it);
            check_ok(mspring_network_step(it->network, 1.0 / 64));
            hashes[workers - 1][i] = support_hash(it->network);
        }
        growth_end(it);
    }
    assert_memory_equal(hashes[1], hashes[0], sizeof hashes[0]);
    assert_memory_equal(hashes[2], hashes[0], sizeof hashes[0]);
    recipe_free(&made);
}

static void the_direct_solver_refuses_springs_and_takes_the_rest(void **state) {
    (void)state;
    recipe made = growth_recipe();
    life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 3);
    growth_use(it->network, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_EULER, 0);
    mspring_particle_def particle;
    mspring_spring_def spring;
    mspring_id id = 77, other;
    check_ok(mspring_particle_def_init(&particle, sizeof particle));
    check_ok(mspring_spring_def_init(&spring, sizeof spring));
    particle.y = 30;
    check_ok(mspring_network_add_particles(it->network, &particle, 1, &other));
    spring.a = 5, spring.b = other;
    check_error(mspring_network_add_springs(it->network, &spring, 1, &id), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(it->network), "direct");
    assert_int_equal(id, 77);
    check_ok(mspring_network_step(it->network, 1.0 / 64));
    const mspring_id particles[] = {0, 5, other};
    check_ok(mspring_network_remove_particles(it->network, particles, 3));
    check_ok(mspring_network_step(it->network, 1.0 / 64));
    growth_end(it);
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------------------- the rules */

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
            growth_use(it->network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_GA0, 0);
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
            check_ok(mspring_network_break_springs(it->network, &first, 1));
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
        check_ok(mspring_particle_def_init(&defs[i], sizeof defs[i]));
        defs[i].x = i;
        defs[i].y = 40;
    }
    check_ok(mspring_network_add_particles(network, defs, SPARE_PARTICLES, ids));
    for (uint32_t i = 0; i < SPARE_PARTICLES; i++) {
        assert_int_equal(ids[i], made.particle_count + i);
    }
    const mspring_id gone[] = {ids[7], ids[3], 0};
    check_ok(mspring_network_remove_particles(network, gone, 3));
    check_error(mspring_network_add_particles(network, defs, 1, &id), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "no room for 1 particle: spare_particles");
    assert_int_equal(id, 12345);
    check_ok(mspring_network_recycle(network));
    check_error(mspring_network_add_particles(network, defs, 3, ids), MSPRING_ERROR_LIMIT);
    check_ok(mspring_network_add_particles(network, defs, 2, ids));
    assert_int_equal(ids[0], gone[1]); // the lowest first; the one that the network was created with never
    assert_int_equal(ids[1], gone[0]);
    assert_int_equal(mspring_network_particle_count(network), made.particle_count + SPARE_PARTICLES);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void check_refused(mspring_network *network, const mspring_spring_def *defs, uint32_t count,
                          mspring_result error, const char *why) {
    mspring_id ids[3] = {9, 9, 9};
    const uint64_t hash = support_hash(network);
    const uint32_t springs = mspring_network_spring_count(network);
    check_error(mspring_network_add_springs(network, defs, count, ids), error);
    check_contains(mspring_network_error(network), why);
    assert_true(ids[0] == 9 && ids[1] == 9);
    assert_int_equal(mspring_network_spring_count(network), springs);
    assert_int_equal(support_hash(network), hash);
}

static void wrong_springs_are_refused_and_change_nothing(void **state) {
    (void)state;
    recipe made = growth_recipe();
    mspring_network *network = growth_network(&made, MSPRING_SIMD_AUTO, 1);
    mspring_spring_def defs[3];
    mspring_id ids[3];
    for (int i = 0; i < 3; i++) {
        check_ok(mspring_spring_def_init(&defs[i], sizeof defs[i]));
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
    check_ok(mspring_network_remove_particles(network, &gone, 1));
    assert_false(mspring_network_has_spring(network, ids[2]));
    check_refused(network, &defs[2], 1, MSPRING_ERROR_ID, "no particle 60");
    mspring_network_destroy(network);

    mspring_network_def bare = support_def(0, 1);
    network = recipe_network(&made, &bare);
    check_refused(network, defs, 1, MSPRING_ERROR_LIMIT, "no room");
    check_ok(mspring_network_remove_particles(network, &gone, 1)); // that needs no reserve
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
    check_ok(mspring_network_remove_particles(network, gone, 2));
    check_ok(mspring_network_get_positions(network, 0, count, x, y, 1));
    for (uint32_t p = 0; p < count; p++) {
        mass[p] = p == 4 || p == 5 ? 0 : 2;
        x[p] += 100;
    }
    x[5] = NAN;
    check_ok(mspring_network_set(network, MSPRING_MASS, 0, count, mass, 1));
    check_ok(mspring_network_set_positions(network, 0, count, x, y, 1));
    check_near(support_position(network, 6).x, x[6], 1e-5);
    mass[6] = 0;
    check_error(mspring_network_set(network, MSPRING_MASS, 0, count, mass, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_at(network, MSPRING_MASS, gone, 2, mass, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_apply_force(network, 5, 1, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_detach_particles(network, gone, 1), MSPRING_ERROR_ID);
    double box[4];
    check_ok(mspring_network_bounds(network, &box[0], &box[1], &box[2], &box[3]));
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
    const uint32_t springs = mspring_network_spring_count(network);
    float *of[4];
    for (int i = 0; i < 4; i++) {
        of[i] = calloc(springs, sizeof *of[i]);
        assert_non_null(of[i]);
    }
    check_ok(mspring_network_get_extents(network, of[0], of[1], of[2], of[3]));
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
    check_ok(mspring_spring_def_init(&def, sizeof def));
    def.a = 0;
    def.b = made.particle_count - 1;
    def.stiffness = 10;
    check_ok(mspring_network_add_springs(network, &def, 1, &added));
    check_extents(network, NULL, 0);
    const mspring_id gone[] = {3, made.spring_count / 2, added}, broken = 5;
    check_ok(mspring_network_remove_springs(network, gone, 3));
    check_ok(mspring_network_break_springs(network, &broken, 1));
    check_extents(network, gone, 3);
    check_ok(mspring_network_compact(network));
    check_extents(network, gone, 3);
    check_ok(mspring_network_expand(network));
    check_ok(mspring_network_recycle(network));
    check_extents(network, gone, 3);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void components_events_and_strain_know_of_it(void **state) {
    (void)state;
    recipe made = {0};
    recipe_particle(&made, 0, 0, 1, 0);
    recipe_particle(&made, 1, 0, 1, 0);
    recipe_particle(&made, 9, 0, 1, 0);
    recipe_spring(&made, 0, 1, 10, 0, 0);
    mspring_network_def def = support_def(0, 1);
    def.spare_particles = def.spare_springs = 3;
    mspring_network *network = recipe_network(&made, &def);
    check_ok(mspring_network_reserve_events(network, 10));
    uint32_t count, changed, numbers[4];
    check_ok(mspring_network_update_components(network, &count, &changed));
    assert_int_equal(count, 2);

    mspring_particle_def particle;
    mspring_spring_def springs[2];
    mspring_id added, ids[2];
    check_ok(mspring_particle_def_init(&particle, sizeof particle));
    particle.x = 5;
    check_ok(mspring_network_add_particles(network, &particle, 1, &added));
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_spring_def_init(&springs[i], sizeof springs[i]));
        springs[i].a = added;
        springs[i].b = 1 + (mspring_id)i;
        springs[i].stiffness = 10;
    }
    check_ok(mspring_network_update_components(network, &count, &changed));
    assert_true(count == 3 && changed);
    check_ok(mspring_network_add_springs(network, springs, 2, ids));
    check_ok(mspring_network_update_components(network, &count, &changed));
    assert_true(count == 1 && changed);
    mspring_event events[10];
    uint32_t event_count;
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_int_equal(event_count, 2); // 2 and the added one are part of the first now
    assert_true(events[0].kind == MSPRING_EVENT_JOINED && events[0].id == 2 && events[0].other == 0);
    assert_true(events[1].kind == MSPRING_EVENT_JOINED && events[1].id == added && events[1].other == 0);

    const float strain = 0.5f, far = 30;
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, ids[1], 1, &strain, 1));
    const float y = 0;
    check_ok(mspring_network_set_positions_float(network, 2, 1, &far, &y, 1));
    check_ok(mspring_network_step(network, 1e-3));
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_true(event_count == 1 && events[0].kind == MSPRING_EVENT_BROKEN && events[0].id == ids[1]);
    float length[4], towards_x[4], towards_y[4];
    check_ok(mspring_network_get_extents(network, length, towards_x, towards_y, NULL));
    assert_true(towards_x[ids[0]] < -0.9f); // from the added one, its first end, to 1

    check_ok(mspring_network_remove_particles(network, &added, 1));
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_true(event_count == 1 && events[0].kind == MSPRING_EVENT_BROKEN && events[0].id == ids[0] &&
                events[0].other == added);
    check_ok(mspring_network_update_components(network, &count, &changed));
    assert_int_equal(count, 2);
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_true(event_count == 1 && events[0].kind == MSPRING_EVENT_SPLIT && events[0].id == 2);
    check_ok(mspring_network_get_component_numbers(network, 0, 4, numbers, 1));
    assert_true(numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 1 && numbers[3] == MSPRING_NONE);

    // What takes its place inherits nothing.
    check_ok(mspring_network_recycle(network));
    particle.x = 6;
    check_ok(mspring_network_add_particles(network, &particle, 1, &added));
    springs[1].rest_length = 1;
    check_ok(mspring_network_add_springs(network, springs, 2, ids));
    check_ok(mspring_network_step(network, 1e-3));
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_int_equal(event_count, 0);
    assert_true(mspring_network_has_spring(network, ids[1]));
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Two springs added between four pinned particles, 1 m each, the second one stretched and stressed.
static void what_takes_a_springs_place_inherits_no_threshold(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (int p = 0; p < 4; p++) {
        support_pinned(builder, p, 0, 1);
    }
    mspring_network_def def = support_def(0, 1);
    def.spare_springs = 2;
    mspring_network *network = support_network(builder, &def);
    mspring_event events[10];
    uint32_t count;
    check_ok(mspring_network_reserve_events(network, 10));
    mspring_spring_def springs[2];
    mspring_id ids[2];
    for (uint32_t i = 0; i < 2; i++) {
        check_ok(mspring_spring_def_init(&springs[i], sizeof springs[i]));
        springs[i].a = 2 * i;
        springs[i].b = 2 * i + 1;
        springs[i].stiffness = 10;
        springs[i].rest_length = 0.5f;
    }
    check_ok(mspring_network_add_springs(network, springs, 2, ids));
    const float stress[] = {0.5f, 0.5f}, limit[] = {2, 2}; // both are strained by 1
    check_ok(mspring_network_set(network, MSPRING_STRESS_STRAIN, ids[0], 2, stress, 1));
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, ids[0], 2, limit, 1));
    support_steps(network, 1, 0.01);
    check_ok(mspring_network_read_events(network, events, 10, &count, NULL));
    assert_int_equal(count, 2);
    const mspring_id first = ids[0], second = ids[1];
    check_ok(mspring_network_remove_springs(network, &first, 1));
    check_ok(mspring_network_recycle(network));
    springs[0].rest_length = 0.25f; // a strain of 3
    check_ok(mspring_network_add_springs(network, springs, 1, ids));
    assert_int_equal(ids[0], first);
    check_ok(mspring_network_read_events(network, events, 10, &count, NULL)); // of the removal
    support_steps(network, 1, 0.01);
    check_ok(mspring_network_read_events(network, events, 10, &count, NULL));
    assert_int_equal(count, 0);
    mspring_spring_info info = {.struct_size = sizeof info};
    check_ok(mspring_network_get_spring(network, first, &info));
    assert_int_equal(info.flags, 0);
    check_ok(mspring_network_get_spring(network, second, &info));
    assert_int_equal(info.flags, MSPRING_SPRING_STRESSED);
    mspring_network_destroy(network);
}

static void a_sleeping_network_wakes(void **state) {
    (void)state;
    recipe made = {0};
    recipe_particle(&made, 0, 0, 1, 0);
    recipe_particle(&made, 1, 0, 1, 0);
    recipe_spring(&made, 0, 1, 10, 1, 0);
    mspring_network_def def = support_def(0, 1);
    def.sleep_speed = 0.01f;
    def.sleep_time = 0.05f;
    def.spare_particles = def.spare_springs = 3;
    mspring_network *network = recipe_network(&made, &def);
    support_steps(network, 20, 0.01);
    assert_true(mspring_network_is_asleep(network));
    mspring_particle_def particle;
    mspring_id id;
    check_ok(mspring_particle_def_init(&particle, sizeof particle));
    particle.x = 4, particle.vy = 2;
    check_ok(mspring_network_add_particles(network, &particle, 1, &id));
    assert_false(mspring_network_is_asleep(network));
    support_steps(network, 10, 0.01);
    check_near(support_position(network, id).y, 0.2, 1e-5);
    check_ok(mspring_network_remove_particles(network, &id, 1));
    support_steps(network, 20, 0.01);
    assert_true(mspring_network_is_asleep(network));
    mspring_network_destroy(network);
    recipe_free(&made);
}

// Everything that takes a network apart finds a whole one.
static void settles_tunes_and_is_stable(void **state) {
    (void)state;
    recipe made = growth_recipe();
    life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 21);
    for (int round = 0; round < 4; round++) {
        for (int i = 0; i < 25; i++) {
            life_do_something(it);
        }
        mspring_id ids[LIFE_PARTICLES];
        recipe left = life_recipe(it, ids);
        mspring_network_def def = support_def(-9.8f, 4);
        mspring_network *plain = recipe_network(&left, &def);
        double now[2], any_shape[2];
        check_ok(mspring_network_stable_dt(it->network, &now[0], NULL));
        check_ok(mspring_network_stable_dt(plain, &now[1], NULL));
        check_near(now[0], now[1], 0.02 * now[1]);        // the search for it is that accurate
        for (mspring_id s = 0; s < it->spring_end; s++) { // broken springs count as whole in any shape
            if (it->has_spring[s] && it->springs[s].is_broken) {
                check_ok(mspring_network_remove_springs(it->network, &s, 1));
                it->has_spring[s] = false;
                it->gone_springs += s >= it->first_spare_spring;
            }
        }
        check_ok(mspring_network_stable_dt(it->network, NULL, &any_shape[0]));
        check_ok(mspring_network_stable_dt(plain, NULL, &any_shape[1]));
        check_near(any_shape[0], any_shape[1], 1e-6 * any_shape[1]);

        mspring_settle_def settle;
        mspring_network *settled = NULL;
        check_ok(mspring_settle_def_init(&settle, sizeof settle));
        settle.flags = MSPRING_SETTLE_LEAVE_FLOATING;
        check_ok(mspring_network_clone(it->network, NULL, &settled));
        check_ok(mspring_network_settle(settled, &settle, NULL));
        check_ok(mspring_network_settle(plain, &settle, NULL));
        for (uint32_t p = 0; p < left.particle_count; p++) {
            // Equilibria of soft springs under gravity: equations of condition 1e4, solved to 1e-9.
            check_near(support_position(settled, ids[p]).x, support_position(plain, p).x, 1e-3);
            check_near(support_position(settled, ids[p]).y, support_position(plain, p).y, 1e-3);
        }
        mspring_network_destroy(settled);
        mspring_network_destroy(plain);
        recipe_free(&left);
        life_check(it);
    }
    growth_end(it);
    recipe_free(&made);
}

// A floor holds added particles and what they hang on.
static void the_floor_is_under_all(void **state) {
    (void)state;
    static const double plane[4] = {0, -12, 0, 1};
    recipe made = growth_recipe();
    for (int solver = 0; solver <= 1; solver++) {
        life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 61);
        if (solver == 1) {
            growth_use(it->network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 0);
        }
        mspring_floor_def floor;
        check_ok(mspring_floor_def_init(&floor, sizeof floor));
        floor.planes = plane, floor.plane_count = 1, floor.friction = 0.5f;
        check_ok(mspring_network_set_floor(it->network, &floor));
        for (int i = 0; i < 150; i++) {
            if (i < 60) {
                life_do_something(it);
            }
            check_ok(mspring_network_step(it->network, 1.0 / 32));
        }
        double box[4];
        check_ok(mspring_network_bounds(it->network, &box[0], &box[1], &box[2], &box[3]));
        assert_true(box[1] >= -12 - 1e-4);
        growth_end(it);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moves_as_what_it_consists_of),
        cmocka_unit_test(moves_so_when_compacted),
        cmocka_unit_test(same_bits_everywhere),
        cmocka_unit_test(implicit_steps_are_those_of_the_direct_solver),
        cmocka_unit_test(same_bits_from_implicit_workers),
        cmocka_unit_test(the_direct_solver_refuses_springs_and_takes_the_rest),
        cmocka_unit_test(adding_allocates_nothing),
        cmocka_unit_test(ids_come_back_when_the_host_says_so),
        cmocka_unit_test(wrong_springs_are_refused_and_change_nothing),
        cmocka_unit_test(ranges_leave_out_what_is_gone),
        cmocka_unit_test(what_is_gone_has_no_length),
        cmocka_unit_test(components_events_and_strain_know_of_it),
        cmocka_unit_test(what_takes_a_springs_place_inherits_no_threshold),
        cmocka_unit_test(a_sleeping_network_wakes),
        cmocka_unit_test(settles_tunes_and_is_stable),
        cmocka_unit_test(the_floor_is_under_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
