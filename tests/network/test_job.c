/// @file test_job.c
/// A plan that another thread makes while the network goes on.
///
/// SPDX-License-Identifier: MIT
#include <pthread.h>

#include "recipe.h"
#include "support.h"

enum { SOLVERS = 3, FRAMES = 6 };

static void *run(void *job) {
    for (uint32_t left = 1; left > 0;) {
        check_ok(mspring_job_run(job, 3, &left));
    }
    return NULL;
}

static recipe hull(void) {
    uint64_t seed = 9;
    const recipe_stuff relative = {.mass = {1, 2},
                                   .stiffness = {0.1, 0.2},
                                   .damping = {0, 0.05},
                                   .spring_flags = MSPRING_SPRING_RELATIVE,
                                   .pinned = 0.02,
                                   .holes = 0.1};
    const recipe_stuff rope = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}};
    recipe made = {0};
    const mspring_id first = recipe_lattice(&made, 40, 25, 0, 0, 1, &relative, &seed);
    recipe_rope(&made, first, first + 500, 30, &rope, &seed);
    recipe_disturb(&made, 0.02, 0.2, &seed);
    return made;
}

static mspring_network *make(const recipe *made, int solver, uint32_t workers) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.worker_count = workers;
    def.spare_springs = 4;
    def.settings.guard = MSPRING_GUARD_IMPLICIT;
    mspring_network *network = recipe_network(made, &def);
    mspring_settings asked;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &asked, sizeof asked));
    asked.solver = (mspring_solver)solver;
    asked.substeps = solver == MSPRING_SOLVER_EXPLICIT ? 4 : 1;
    check_ok(support_set_solver(network, &asked));
    for (mspring_id s = 0; s < made->spring_count; s += 3) {
        check_ok(mspring_network_break_springs(network, &s, 0, 1));
    }
    return network;
}

/// What a host does while a job runs.
static void live(mspring_network *network, uint32_t frame) {
    const mspring_id list[] = {frame * 31 + 1, frame * 57 + 2};
    const float stiffness[] = {0.15f, 0.12f}, lengths[] = {1.05f, 0.95f};
    mspring_network *clone = NULL;
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, list, 0, 2, stiffness, 1));
    check_ok(mspring_network_break_springs(network, list, 0, 1));
    if (frame == 2) { // rest lengths are not shared any more
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, list + 1, 0, 1, lengths, 1));
    }
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, list, 0, 2, (const float[]){9, 8}, 1));
    support_steps(network, 1, 1.0 / 64);
    check_ok(mspring_network_clone(network, NULL, &clone));
    mspring_network_destroy(clone);
}

/// Compact and take everything in again, by another thread or by this one, and return the hash of the end.
static uint64_t play(const recipe *made, int solver, uint32_t workers, bool has_thread) {
    mspring_network *network = make(made, solver, workers);
    for (int layout = MSPRING_LAYOUT_COMPACT; layout <= MSPRING_LAYOUT_WHOLE; layout++) {
        mspring_job *job = NULL;
        pthread_t thread;
        check_ok(mspring_job_begin(network, (mspring_layout)layout, &job));
        if (has_thread) {
            assert_int_equal(pthread_create(&thread, NULL, run, job), 0);
        }
        for (uint32_t frame = 0; frame < FRAMES; frame++) {
            live(network, frame);
        }
        if (has_thread) {
            assert_int_equal(pthread_join(thread, NULL), 0);
        } else {
            run(job);
        }
        check_ok(mspring_job_finish(network, job));
        mspring_job_destroy(job);
        support_steps(network, 3, 1.0 / 64);
    }
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

static void another_thread_makes_no_difference(void **state) {
    (void)state;
    recipe made = hull();
    for (int solver = 0; solver < SOLVERS; solver++) {
        const uint64_t alone = play(&made, solver, 1, false);
        assert_int_equal(play(&made, solver, 1, true), alone);
        assert_int_equal(play(&made, solver, 3, true), alone);
    }
    recipe_free(&made);
}

/// The network may go while its job runs.
static void a_network_may_be_destroyed_meanwhile(void **state) {
    (void)state;
    recipe made = hull();
    for (int solver = 0; solver < SOLVERS; solver++) {
        mspring_network *network = make(&made, solver, 2);
        mspring_job *job = NULL;
        pthread_t thread;
        check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
        assert_int_equal(pthread_create(&thread, NULL, run, job), 0);
        mspring_network_destroy(network);
        assert_int_equal(pthread_join(thread, NULL), 0);
        mspring_job_destroy(job);
    }
    recipe_free(&made);
}

/// Particles and springs come and go while a job runs, which is outdated then.
static void growth_outdates_a_running_job(void **state) {
    (void)state;
    recipe made = hull();
    mspring_network *network = make(&made, MSPRING_SOLVER_EXPLICIT, 1);
    mspring_job *job = NULL;
    pthread_t thread;
    mspring_spring_def added;
    mspring_id id, broken = 3;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &added, sizeof added));
    added.a = 1;
    added.b = 900;
    check_ok(mspring_network_compact(network));
    for (int what = 0; what < 3; what++) {
        check_ok(mspring_job_begin(network, what == 1 ? MSPRING_LAYOUT_WHOLE : MSPRING_LAYOUT_COMPACT, &job));
        assert_int_equal(pthread_create(&thread, NULL, run, job), 0);
        if (what == 0) {
            check_ok(mspring_network_add_springs(network, &added, 1, &id));
        } else if (what == 1) {
            check_ok(mspring_network_remove_springs(network, &id, 0, 1));
        } else { // which takes all springs in
            check_ok(mspring_network_restore_springs(network, &broken, 0, 1, 0.5));
        }
        support_steps(network, 2, 1.0 / 64);
        assert_int_equal(pthread_join(thread, NULL), 0);
        check_error(mspring_job_finish(network, job), MSPRING_ERROR_OUTDATED);
        mspring_job_destroy(job);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(another_thread_makes_no_difference),
        cmocka_unit_test(a_network_may_be_destroyed_meanwhile),
        cmocka_unit_test(growth_outdates_a_running_job),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
