/// @file test_growth.c
/// Particles and springs that are added and removed at run time: the network is then the one that consists of what
/// is left, to every function, solver and number of workers.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "growth.h"
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
                if (job) { // a network has one at a time
                    mspring_job *other = NULL;
                    check_error(mspring_job_begin(it->network, MSPRING_LAYOUT_WHOLE, &other), MSPRING_ERROR_BUSY);
                }
                mspring_job_destroy(job);
                job = NULL;
                check_ok(support_expand(it->network));
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
        check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
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
        growth_use(it->network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA, 0);
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
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    particle.y = 30;
    check_ok(mspring_network_add_particles(it->network, &particle, 1, &other));
    spring.a = 5, spring.b = other;
    check_error(mspring_network_add_springs(it->network, &spring, 1, &id), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(it->network), "direct");
    assert_int_equal(id, 77);
    check_ok(mspring_network_step(it->network, 1.0 / 64));
    const mspring_id particles[] = {0, 5, other};
    check_ok(mspring_network_remove_particles(it->network, particles, 0, 3));
    check_ok(mspring_network_step(it->network, 1.0 / 64));
    growth_end(it);
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------------------- the rest */

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
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    particle.x = 5;
    check_ok(mspring_network_add_particles(network, &particle, 1, &added));
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &springs[i], sizeof springs[i]));
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

    const float strain = 0.5f;
    const double far = 30, y = 0;
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, ids[1], 1, &strain, 1));
    check_ok(mspring_network_set_positions(network, NULL, 2, 1, &far, &y, 1));
    check_ok(mspring_network_step(network, 1e-3));
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_true(event_count == 1 && events[0].kind == MSPRING_EVENT_BROKEN && events[0].id == ids[1]);
    float length[4], towards_x[4], towards_y[4];
    check_ok(support_get_extents(network, length, towards_x, towards_y, NULL));
    assert_true(towards_x[ids[0]] < -0.9f); // from the added one, its first end, to 1

    check_ok(mspring_network_remove_particles(network, &added, 0, 1));
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_true(event_count == 1 && events[0].kind == MSPRING_EVENT_BROKEN && events[0].id == ids[0] &&
                events[0].other == added);
    check_ok(mspring_network_update_components(network, &count, &changed));
    assert_int_equal(count, 2);
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_true(event_count == 1 && events[0].kind == MSPRING_EVENT_SPLIT && events[0].id == 2);
    check_ok(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0, 4, numbers, 1));
    assert_true(numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 1 && numbers[3] == MSPRING_NONE);

    // What takes its place inherits nothing.
    check_ok(mspring_network_reuse_ids(network));
    particle.x = 6;
    check_ok(mspring_network_add_particles(network, &particle, 1, &added));
    springs[1].rest_length = 1;
    check_ok(mspring_network_add_springs(network, springs, 2, ids));
    check_ok(mspring_network_step(network, 1e-3));
    check_ok(mspring_network_read_events(network, events, 10, &event_count, NULL));
    assert_int_equal(event_count, 0);
    assert_true(support_has_spring(network, ids[1]));
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
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &springs[i], sizeof springs[i]));
        springs[i].a = 2 * i;
        springs[i].b = 2 * i + 1;
        springs[i].stiffness = 10;
        springs[i].rest_length = 0.5f;
    }
    check_ok(mspring_network_add_springs(network, springs, 2, ids));
    const float stress[] = {0.5f, 0.5f}, limit[] = {2, 2}; // both are strained by 1
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, ids[0], 2, stress, 1));
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, ids[0], 2, limit, 1));
    support_steps(network, 1, 0.01);
    check_ok(mspring_network_read_events(network, events, 10, &count, NULL));
    assert_int_equal(count, 2);
    const mspring_id first = ids[0], second = ids[1];
    check_ok(mspring_network_remove_springs(network, &first, 0, 1));
    check_ok(mspring_network_reuse_ids(network));
    springs[0].rest_length = 0.25f; // a strain of 3
    check_ok(mspring_network_add_springs(network, springs, 1, ids));
    assert_int_equal(ids[0], first);
    check_ok(mspring_network_read_events(network, events, 10, &count, NULL)); // of the removal
    support_steps(network, 1, 0.01);
    check_ok(mspring_network_read_events(network, events, 10, &count, NULL));
    assert_int_equal(count, 0);
    support_spring_info info;
    check_ok(support_get_spring(network, first, &info));
    assert_int_equal(info.flags, 0);
    check_ok(support_get_spring(network, second, &info));
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
    def.settings.sleep_speed = 0.01f;
    def.settings.sleep_time = 0.05f;
    def.spare_particles = def.spare_springs = 3;
    mspring_network *network = recipe_network(&made, &def);
    support_steps(network, 20, 0.01);
    assert_true(support_is_asleep(network));
    mspring_particle_def particle;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    particle.x = 4, particle.vy = 2;
    check_ok(mspring_network_add_particles(network, &particle, 1, &id));
    assert_false(support_is_asleep(network));
    support_steps(network, 10, 0.01);
    check_near(support_position(network, id).y, 0.2, 1e-5);
    check_ok(mspring_network_remove_particles(network, &id, 0, 1));
    support_steps(network, 20, 0.01);
    assert_true(support_is_asleep(network));
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
        check_ok(mspring_network_get_stable_dt(it->network, &now[0], NULL));
        check_ok(mspring_network_get_stable_dt(plain, &now[1], NULL));
        check_near(now[0], now[1], 0.02 * now[1]);        // the search for it is that accurate
        for (mspring_id s = 0; s < it->spring_end; s++) { // broken springs count as whole in any shape
            if (it->has_spring[s] && it->springs[s].is_broken) {
                check_ok(mspring_network_remove_springs(it->network, &s, 0, 1));
                it->has_spring[s] = false;
                it->gone_springs += s >= it->first_spare_spring;
            }
        }
        check_ok(mspring_network_get_stable_dt(it->network, NULL, &any_shape[0]));
        check_ok(mspring_network_get_stable_dt(plain, NULL, &any_shape[1]));
        check_near(any_shape[0], any_shape[1], 1e-6 * any_shape[1]);

        mspring_settle_def settle;
        mspring_network *settled = NULL;
        check_ok(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &settle, sizeof settle));
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
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
        floor.planes = plane, floor.plane_count = 1, floor.friction = 0.5f;
        check_ok(mspring_network_set_floor(it->network, &floor));
        for (int i = 0; i < 150; i++) {
            if (i < 60) {
                life_do_something(it);
            }
            check_ok(mspring_network_step(it->network, 1.0 / 32));
        }
        double box[4];
        check_ok(support_get_bounds(it->network, &box[0], &box[1], &box[2], &box[3]));
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
        cmocka_unit_test(components_events_and_strain_know_of_it),
        cmocka_unit_test(what_takes_a_springs_place_inherits_no_threshold),
        cmocka_unit_test(a_sleeping_network_wakes),
        cmocka_unit_test(settles_tunes_and_is_stable),
        cmocka_unit_test(the_floor_is_under_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
