/// @file test_workers.c
/// Networks with workers: the same bits for any number of them and any host, and errors that say what is wrong.
///
/// SPDX-License-Identifier: MIT
#define _XOPEN_SOURCE 700

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <sys/resource.h>
#include <unistd.h>

#include "allocator.h"
#include "hosts.h"
#include "recipe.h"
#include "solvers/implicit/implicit.h"
#include "support.h"

static const uint32_t worker_counts[] = {1, 2, 3, 8};

/// Lattices with holes, ropes, a web, loose particles: rows of every kind, and enough of them to be divided.
static recipe mixed_recipe(void) {
    uint64_t seed = 21;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {200, 400}, .damping = {0, 1}, .pinned = 0.01, .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 150, 90, 0, 0, 1, &stuff, &seed);
    const mspring_id other = recipe_lattice(&made, 40, 30, 170, 0.5, 1, &stuff, &seed);
    recipe_rope(&made, 20, other + 7, 60, &stuff, &seed);
    recipe_random_springs(&made, 20, &stuff, &seed);
    for (int i = 0; i < 50; i++) {
        recipe_particle(&made, -5 - i, i, 1, 0);
    }
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

static uint64_t hash_of_steps(mspring_network *network) {
    uint64_t hash = support_hash(network);
    for (int step = 0; step < ROUNDS(4); step++) {
        check_ok(mspring_network_apply_force(network, 1000, 50, 100));
        support_steps(network, 1, 0.02);
        hash = hash * 31 + support_hash(network);
    }
    return hash;
}

static uint64_t run(const recipe *made, uint32_t worker_count, const mspring_tasks *tasks) {
    mspring_network_def def = support_def(-9.8f, 9);
    def.worker_count = worker_count;
    def.tasks = tasks;
    mspring_network *network = recipe_network(made, &def);
    const uint32_t expected = tasks != NULL ? tasks->worker_count : worker_count;
    assert_int_equal(support_worker_count(network), expected);
    const uint64_t hash = hash_of_steps(network);
    mspring_network_destroy(network);
    return hash;
}

static void any_number_of_workers_gives_the_same_bits(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    const uint64_t expected = run(&made, 1, NULL);
    for (size_t i = 0; i < COUNT_OF(worker_counts); i++) {
        assert_int_equal(run(&made, worker_counts[i], NULL), expected);
    }
    recipe_free(&made);
}

static void any_host_gives_the_same_bits(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    const uint64_t expected = run(&made, 1, NULL);
    for (size_t i = 0; i < COUNT_OF(worker_counts); i++) {
        host hosts[HOST_COUNT];
        hosts_fill(hosts, worker_counts[i]);
        for (int h = 0; h < HOST_COUNT; h++) {
            assert_int_equal(run(&made, 1, &hosts[h].tasks), expected);
            assert_true(worker_counts[i] > 1 || hosts[h].runs == 0);
        }
    }
    recipe_free(&made);
}

static mspringi_implicit *implicit_of(const mspring_network *network) {
    return network->solver.object;
}

/// Steps that are shared even where workers share a core, which else one worker takes alone.
static uint64_t hash_of_shared_steps(mspring_network *network) {
    uint64_t hash = support_hash(network);
    for (int step = 0; step < ROUNDS(3); step++) {
        check_ok(mspring_network_apply_force(network, 1000, 50, 100));
        implicit_of(network)->solo_substeps = 0;
        support_steps(network, 1, 0.02);
        hash = hash * 31 + support_hash(network);
    }
    return hash;
}

/// Steps of an implicit network, some of its springs broken on the way.
static uint64_t run_implicit(const recipe *made, const mspring_settings *solver, uint32_t worker_count,
                             const mspring_tasks *tasks) {
    mspring_network_def def = support_def(-9.8f, 1);
    def.worker_count = worker_count;
    def.tasks = tasks;
    mspring_network *network = recipe_network(made, &def);
    check_ok(support_set_solver(network, solver));
    uint64_t hash = hash_of_shared_steps(network);
    for (mspring_id spring = 100; spring < 2000; spring += 100) {
        check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    }
    hash = hash * 31 + hash_of_shared_steps(network);
    mspring_network_destroy(network);
    return hash;
}

static void any_number_of_workers_gives_the_same_implicit_bits(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = MSPRING_SOLVER_IMPLICIT;
    for (mspring_integrator i = MSPRING_INTEGRATOR_ALPHA; i < ROUNDS(MSPRING_INTEGRATOR_EULER + 1); i++) {
        solver.integrator = i;
        solver.coarse_period = 1 + (uint32_t)i;
        const uint64_t expected = run_implicit(&made, &solver, 1, NULL);
        for (size_t w = 0; w < COUNT_OF(worker_counts); w++) {
            assert_int_equal(run_implicit(&made, &solver, worker_counts[w], NULL), expected);
            host hosts[HOST_COUNT];
            hosts_fill(hosts, worker_counts[w]);
            assert_int_equal(run_implicit(&made, &solver, 1, &hosts[(size_t)i % HOST_COUNT].tasks), expected);
        }
    }
    // The direct solver shares what is around its factorisation.
    solver.solver = MSPRING_SOLVER_DIRECT;
    assert_int_equal(run_implicit(&made, &solver, 3, NULL), run_implicit(&made, &solver, 1, NULL));
    recipe_free(&made);
}

/// Whoever had to sleep often takes the next substeps alone, with the same bits.
static void workers_without_cores_are_left_alone(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.solver = MSPRING_SOLVER_IMPLICIT;
    mspring_network *alone = recipe_network(&made, &def);
    def.worker_count = 2;
    mspring_network *shared = recipe_network(&made, &def);
    for (int step = 0; step < 4; step++) {
        implicit_of(shared)->solo_substeps = step % 2 == 0 ? 0 : 3;
        support_steps(alone, 1, 0.02);
        support_steps(shared, 1, 0.02);
        assert_int_equal(support_hash(shared), support_hash(alone));
        assert_true(step % 2 == 0 || implicit_of(shared)->solo_substeps == 2);
    }
    mspring_network_destroy(shared);
    mspring_network_destroy(alone);
    recipe_free(&made);
}

/// A clone may have more workers than the network that it was made of.
static void a_clone_has_room_for_its_workers(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.solver = MSPRING_SOLVER_IMPLICIT;
    mspring_network *network = recipe_network(&made, &def), *clone = NULL;
    support_steps(network, 2, 0.02);
    mspring_clone_def more;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &more, sizeof more));
    more.worker_count = 3;
    check_ok(mspring_network_clone(network, &more, &clone));
    support_steps(network, 3, 0.02);
    support_steps(clone, 3, 0.02);
    assert_int_equal(support_hash(clone), support_hash(network));
    mspring_network_destroy(clone);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void networks_with_workers_live_side_by_side(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_network *networks[4];
    mspring_network_def def = support_def(-9.8f, 3);
    for (size_t i = 0; i < COUNT_OF(networks); i++) {
        def.worker_count = (uint32_t)i + 1;
        networks[i] = recipe_network(&made, &def);
    }
    for (int step = 0; step < 3; step++) {
        for (size_t i = 0; i < COUNT_OF(networks); i++) {
            support_steps(networks[i], 1, 0.02);
            assert_int_equal(support_hash(networks[i]), support_hash(networks[0]));
        }
    }
    for (size_t i = 0; i < COUNT_OF(networks); i++) {
        mspring_network_destroy(networks[i]);
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------- bad input */

static mspring_builder *small_builder(void) {
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    return builder;
}

static void refuse(mspring_builder *builder, const mspring_network_def *def, mspring_result code,
                   const char *part) {
    mspring_network *const untouched = (mspring_network *)(uintptr_t)16;
    mspring_network *network = untouched;
    check_error(mspring_network_create(builder, def, &network), code);
    check_contains(support_builder_error(builder), part);
    assert_ptr_equal(network, untouched);
}

static void bad_workers_are_refused(void **state) {
    (void)state;
    mspring_builder *builder = small_builder();
    mspring_network_def def = support_def(0, 1);
    def.worker_count = 0;
    refuse(builder, &def, MSPRING_ERROR_ARGUMENT, "worker_count is 0");
    def.worker_count = MSPRING_MAX_WORKERS + 1;
    refuse(builder, &def, MSPRING_ERROR_ARGUMENT, "worker_count is 257");

    host hosts[HOST_COUNT];
    hosts_fill(hosts, 4);
    mspring_tasks tasks = hosts[0].tasks;
    def.worker_count = 1;
    def.tasks = &tasks;
    tasks.run = NULL;
    refuse(builder, &def, MSPRING_ERROR_ARGUMENT, "run");
    tasks.run = hosts[0].tasks.run;
    tasks.concurrent_count = 0;
    refuse(builder, &def, MSPRING_ERROR_ARGUMENT, "concurrent_count is 0");
    tasks.concurrent_count = 5;
    refuse(builder, &def, MSPRING_ERROR_ARGUMENT, "concurrent_count is 5");
    tasks.concurrent_count = 1;
    tasks.worker_count = MSPRING_MAX_WORKERS + 1;
    refuse(builder, &def, MSPRING_ERROR_ARGUMENT, "worker_count is 257");
    tasks.worker_count = 4;
    tasks.struct_size = 3;
    refuse(builder, &def, MSPRING_ERROR_STRUCT, "mspring_tasks");
    assert_int_equal(support_worker_count(NULL), 0);
    mspring_builder_destroy(builder);
}

static void networks_with_workers_survive_every_failure(void **state) {
    (void)state;
    mspring_builder *builder = small_builder();
    mspring_network_def def = support_def(0, 1);
    def.worker_count = 3;
    mspring_result result = MSPRING_ERROR_MEMORY;
    for (size_t fail_at = 1; result != MSPRING_OK; fail_at++) {
        watched_allocator watched = {.fail_at = fail_at};
        const mspring_allocator allocator = watched_interface(&watched);
        def.allocator = &allocator;
        mspring_network *network = NULL;
        result = mspring_network_create(builder, &def, &network);
        if (result == MSPRING_OK) {
            support_steps(network, 1, 0.01);
            mspring_network_destroy(network);
        } else {
            check_error(result, MSPRING_ERROR_MEMORY);
        }
        check_watched_clean(&watched);
    }
    mspring_builder_destroy(builder);
}

#ifdef RLIMIT_AS
/// Address space in use, bytes, or 0 where that cannot be told.
static uint64_t address_space_in_use(void) {
    unsigned long pages = 0;
    FILE *sizes = fopen("/proc/self/statm", "r");
    if (sizes) {
        pages = fscanf(sizes, "%lu", &pages) == 1 ? pages : 0;
        (void)fclose(sizes);
    }
    return (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
}
#endif

/// With little address space left there is none for the stacks of so many threads.
static void threads_that_cannot_be_had_are_an_error(void **state) {
    (void)state;
#ifdef RLIMIT_AS
    const uint64_t limit = (uint64_t)200 << 20;
    if (address_space_in_use() > limit / 2) {
        skip(); // sanitizers and valgrind need more for themselves
    }
    mspring_builder *builder = small_builder();
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def(0, 1);
    def.worker_count = MSPRING_MAX_WORKERS;
    def.allocator = &allocator;
    struct rlimit before;
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    const struct rlimit little = {.rlim_cur = (rlim_t)limit, .rlim_max = before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_AS, &little), 0);
    mspring_network *const untouched = (mspring_network *)(uintptr_t)16;
    mspring_network *network = untouched;
    const mspring_result result = mspring_network_create(builder, &def, &network);
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    check_error(result, MSPRING_ERROR_THREAD);
    check_contains(support_builder_error(builder), "has no thread for worker");
    assert_ptr_equal(network, untouched);
    check_watched_clean(&watched);
    // With fewer it works.
    def.worker_count = 2;
    check_ok(mspring_network_create(builder, &def, &network));
    support_steps(network, 1, 0.01);
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    check_watched_clean(&watched);
#else
    skip();
#endif
}

/// A step turns tiny speeds to +0. The sign of another zero stays, even if its particle is swept together with one
/// that creeps, which depends on the workers.
static void no_zero_changes_its_sign(void **state) {
    (void)state;
    const uint32_t count = 3000;
    recipe made = {0};
    for (uint32_t i = 0; i < count; i++) { // enough springs for each worker to take a share of the particles
        recipe_particle(&made, i, i % 7, 1, i == 0 || i == count - 1 ? MSPRING_PARTICLE_PINNED : 0);
        for (uint32_t back = 1; back <= 3 && i >= back * back; back++) {
            recipe_spring(&made, i - back * back, i, 100, 1, 0);
        }
    }
    made.particles[0].vx = -0.0f;
    made.particles[count - 1].vx = 1e-35f;
    uint64_t expected = 0;
    for (uint32_t workers = 1; workers <= 2; workers++) {
        mspring_network_def def = support_def(-9.8f, 64);
        def.worker_count = workers;
        mspring_network *network = recipe_network(&made, &def);
        support_steps(network, 1, 0.1);
        assert_true(signbit(support_velocity(network, 0).x));
        const double crept = support_velocity(network, count - 1).x;
        assert_true(crept == 0 && !signbit(crept));
        expected = workers == 1 ? support_hash(network) : expected;
        assert_int_equal(support_hash(network), expected);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_workers_gives_the_same_bits),
        cmocka_unit_test(any_host_gives_the_same_bits),
        cmocka_unit_test(no_zero_changes_its_sign),
        cmocka_unit_test(any_number_of_workers_gives_the_same_implicit_bits),
        cmocka_unit_test(workers_without_cores_are_left_alone),
        cmocka_unit_test(a_clone_has_room_for_its_workers),
        cmocka_unit_test(networks_with_workers_live_side_by_side),
        cmocka_unit_test(bad_workers_are_refused),
        cmocka_unit_test(networks_with_workers_survive_every_failure),
        cmocka_unit_test(threads_that_cannot_be_had_are_an_error),
    };
    return cmocka_run_group_tests_name("workers", tests, NULL, NULL);
}
