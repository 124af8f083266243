/// @file test_fork.c
/// Networks with workers in a child that fork() has made: the child goes on as the parent does, bit for bit, frees
/// what it has, and says so if it gets no threads. The program is linked so that starting a thread can be made
/// fail.
///
/// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L

#include <stdbool.h>
#include <string.h>

#include <sys/wait.h>
#include <unistd.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"
#include "tasks/thread.h"

static const uint32_t worker_counts[] = {2, 3};
static const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT};

/// Threads that may still be started.
static uint32_t threads_left = UINT32_MAX;

bool __real_mspringi_thread_create(mspringi_thread *thread, mspringi_thread_start *start);
bool __wrap_mspringi_thread_create(mspringi_thread *thread, mspringi_thread_start *start);
bool __wrap_mspringi_thread_create(mspringi_thread *thread, mspringi_thread_start *start) {
    if (threads_left == 0) {
        return false;
    }
    threads_left--;
    return __real_mspringi_thread_create(thread, start);
}

/// Large enough that all workers have something to do.
static mspring_network *make(uint32_t worker_count, mspring_solver solver, const mspring_allocator *allocator) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {200, 400}, .damping = {0, 1}, .pinned = 0.01};
    recipe made = {0};
    recipe_lattice(&made, 200, 100, 0, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(-9.8f, 8);
    def.worker_count = worker_count;
    def.allocator = allocator;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    mspring_settings solver_def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver_def, sizeof solver_def));
    solver_def.solver = solver;
    solver_def.substeps = solver == MSPRING_SOLVER_EXPLICIT ? 8 : 2;
    check_ok(support_set_solver(network, &solver_def));
    return network;
}

/// Three steps, and the hash at their end; 0 if one fails.
static uint64_t go_on(mspring_network *network) {
    for (int i = 0; i < 3; i++) {
        if (mspring_network_step(network, 0.02) != MSPRING_OK) {
            return 0;
        }
    }
    return support_hash(network);
}

/// What a child says about a network: its hash, or 1 if it does what it should. 0 or nothing: it fails, or hangs.
static uint64_t ask_child(uint64_t (*what)(mspring_network *network), mspring_network *network) {
    int ends[2];
    uint64_t answer = 0;
    int status = 0;
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(60);
        answer = what(network);
        const bool told = write(ends[1], &answer, sizeof answer) == (ssize_t)sizeof answer;
        _exit(told ? 0 : 1);
    }
    close(ends[1]);
    const bool told = read(ends[0], &answer, sizeof answer) == (ssize_t)sizeof answer;
    close(ends[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_true(told);
    return answer;
}

static uint64_t step_and_destroy(mspring_network *network) {
    const uint64_t hash = go_on(network);
    mspring_network_destroy(network);
    return hash;
}

static void a_child_goes_on_with_the_same_bits(void **state) {
    (void)state;
    for (size_t s = 0; s < COUNT_OF(solvers); s++) {
        for (size_t w = 0; w < COUNT_OF(worker_counts); w++) {
            mspring_network *network = make(worker_counts[w], solvers[s], NULL);
            assert_true(go_on(network) != 0);
            const uint64_t in_child = ask_child(step_and_destroy, network);
            assert_int_equal(go_on(network), in_child);
            mspring_network_destroy(network);
        }
    }
}

static uint64_t ask_grandchild(mspring_network *network) {
    const uint64_t before = ask_child(go_on, network);
    const uint64_t after = step_and_destroy(network);
    return before == after ? after : 0;
}

static void a_child_of_a_child_goes_on_too(void **state) {
    (void)state;
    mspring_network *network = make(3, MSPRING_SOLVER_EXPLICIT, NULL);
    assert_true(go_on(network) != 0);
    const uint64_t expected = ask_child(ask_grandchild, network);
    assert_int_equal(go_on(network), expected);
    mspring_network_destroy(network);
}

static watched_allocator watched;

static uint64_t destroy_at_once(mspring_network *network) {
    mspring_network_destroy(network);
    return watched.live == 0;
}

static uint64_t destroy_a_clone(mspring_network *network) {
    mspring_network *clone = NULL;
    mspring_clone_def def;
    if (mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def) != MSPRING_OK) {
        return 0;
    }
    def.worker_count = 2;
    if (mspring_network_clone(network, &def, &clone) != MSPRING_OK) {
        return 0;
    }
    const bool same = go_on(clone) == go_on(network);
    mspring_network_destroy(clone);
    mspring_network_destroy(network);
    return same && watched.live == 0;
}

static void a_child_frees_what_it_has(void **state) {
    (void)state;
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_network *network = make(3, MSPRING_SOLVER_EXPLICIT, &allocator);
    support_steps(network, 1, 0.02);
    assert_int_equal(ask_child(destroy_at_once, network), 1);
    assert_int_equal(ask_child(destroy_a_clone, network), 1);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
}

static uint64_t get_no_threads(mspring_network *network) {
    const uint64_t before = support_hash(network);
    bool right = true;
    for (threads_left = 0; threads_left < 2; threads_left++) {
        const uint32_t left = threads_left;
        right = right && mspring_network_step(network, 0.02) == MSPRING_ERROR_THREAD;
        right = right && strstr(mspring_network_error(network), "has no thread for worker");
        right = right && support_hash(network) == before;
        threads_left = left;
    }
    mspring_network *clone = NULL; // which a network that lacks its threads can still give
    right = right && mspring_network_clone(network, NULL, &clone) == MSPRING_OK;
    threads_left = UINT32_MAX;
    const uint64_t hash = go_on(network);
    right = right && go_on(clone) == hash;
    mspring_network_destroy(clone);
    mspring_network_destroy(network);
    return right ? hash : 0;
}

static void a_child_without_threads_says_so_and_tries_again(void **state) {
    (void)state;
    mspring_network *network = make(3, MSPRING_SOLVER_EXPLICIT, NULL);
    support_steps(network, 1, 0.02);
    const uint64_t in_child = ask_child(get_no_threads, network);
    assert_int_equal(go_on(network), in_child);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_child_goes_on_with_the_same_bits),
        cmocka_unit_test(a_child_of_a_child_goes_on_too),
        cmocka_unit_test(a_child_frees_what_it_has),
        cmocka_unit_test(a_child_without_threads_says_so_and_tries_again),
    };
    return cmocka_run_group_tests_name("fork", tests, NULL, NULL);
}
