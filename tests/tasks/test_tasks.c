/// @file test_tasks.c
/// Dividing work among threads: every body runs once, on a worker of its own, and those that wait for each other do
/// not wait for ever. With the library's threads and with those of several kinds of host.
///
/// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "allocator.h"
#include "hosts.h"
#include "support.h"
#include "tasks/tasks.h"

enum { MOST = 64 };
static const uint32_t worker_counts[] = {1, 2, 3, 8};

typedef struct made {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_tasks *tasks;
} made;

static made make(uint32_t worker_count, const mspring_tasks *fallback_steps) {
    made out;
    memset(&out, 0, sizeof out);
    check_ok(mspringi_memory_init(&out.memory, NULL, &out.message));
    check_ok(mspringi_tasks_create(worker_count, fallback_steps, &out.memory, &out.message, &out.tasks));
    return out;
}

static void unmake(made *of) {
    mspringi_tasks_destroy(of->tasks, &of->memory);
    assert_int_equal(of->memory.used, 0);
}

/// Try everything with the library's threads, and with each host's.
static void with_all(void (*check)(mspringi_tasks *tasks, uint32_t worker_count)) {
    for (size_t i = 0; i < COUNT_OF(worker_counts); i++) {
        made own = make(worker_counts[i], NULL);
        check(own.tasks, worker_counts[i]);
        unmake(&own);
        for (uint32_t h = 0; worker_counts[i] > 1 && h < HOST_COUNT; h++) {
            host hosts[HOST_COUNT];
            hosts_fill(hosts, worker_counts[i]);
            made fallback_steps = make(1, &hosts[h].tasks);
            check(fallback_steps.tasks, worker_counts[i]);
            unmake(&fallback_steps);
        }
    }
}

static void rest(long milliseconds) {
    nanosleep(&(struct timespec){.tv_nsec = milliseconds * 1000000}, NULL);
}

/* --------------------------------------------------------------------------------------- independent bodies */

typedef struct census {
    atomic_uint calls[MOST];
    atomic_bool busy[MOST];
    atomic_uint wrong; ///< workers out of range or used twice at once
    uint32_t worker_count;
    uint32_t plain[MOST]; ///< not atomic: the caller has to see it afterwards
    uint32_t seed;
} census;

static void count_body(void *argument, uint32_t index, uint32_t worker) {
    census *of = argument;
    if (worker >= of->worker_count || atomic_exchange(&of->busy[worker], true)) {
        atomic_fetch_add(&of->wrong, 1);
    }
    atomic_fetch_add(&of->calls[index], 1);
    of->plain[index] = of->seed + index;
    atomic_store(&of->busy[worker], false);
}

static void check_census(mspringi_tasks *tasks, uint32_t worker_count) {
    assert_int_equal(mspringi_tasks_workers(tasks), worker_count);
    for (uint32_t count = 0; count <= 20; count += count < 10 ? 1 : 5) {
        static census of;
        memset(&of, 0, sizeof of);
        of.worker_count = worker_count;
        for (uint32_t run = 1; run <= 3; run++) {
            of.seed = 1000 * run;
            mspringi_tasks_run(tasks, count, count_body, &of);
            for (uint32_t i = 0; i < MOST; i++) {
                assert_int_equal(atomic_load(&of.calls[i]), i < count ? run : 0);
                assert_int_equal(of.plain[i], i < count ? of.seed + i : 0);
            }
        }
        assert_int_equal(atomic_load(&of.wrong), 0);
    }
}

static void every_body_runs_once(void **state) {
    (void)state;
    with_all(check_census);
}

static void check_long_sequence(mspringi_tasks *tasks, uint32_t worker_count) {
    static census of;
    memset(&of, 0, sizeof of);
    of.worker_count = worker_count;
    uint64_t seed = worker_count;
    uint32_t expected = 0;
    const uint32_t runs = 2000;
    for (uint32_t run = 0; run < runs; run++) {
        const uint32_t count = 1 + (uint32_t)(support_random(&seed) % 12);
        mspringi_tasks_run(tasks, count, count_body, &of);
        expected += count;
        if (run % 500 == 499) {
            rest(3); // long enough for workers to go to sleep
        }
    }
    uint32_t calls = 0;
    for (uint32_t i = 0; i < MOST; i++) {
        calls += atomic_load(&of.calls[i]);
    }
    assert_int_equal(calls, expected);
    assert_int_equal(atomic_load(&of.wrong), 0);
}

static void runs_of_any_size_follow_each_other(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(worker_counts); i++) {
        made own = make(worker_counts[i], NULL);
        check_long_sequence(own.tasks, worker_counts[i]);
        unmake(&own);
    }
}

/* ------------------------------------------------------------------------------------------ bodies that wait */

enum { ROWS = 120, PASSES = 5 };

/// Several passes over rows, body b taking passes b, b + bodies ...: each is one row behind the one before, so that
/// the first body waits for the last one, too. Row r of pass p is made of rows r and r + 1 of the pass before.
typedef struct wavefront {
    mspringi_progress *progress;
    uint32_t bodies;
    uint32_t rows[ROWS + 1];
    bool slow; ///< one body sleeps now and then
} wavefront;

static uint32_t next_row(uint32_t row, uint32_t above) {
    return row * 1664525u + above * 22695477u + 1;
}

static void wavefront_body(void *argument, uint32_t index, uint32_t worker) {
    wavefront *of = argument;
    (void)worker;
    uint32_t done = 0;
    const uint32_t before = (index + of->bodies - 1) % of->bodies;
    for (uint32_t pass = index; pass < PASSES * of->bodies; pass += of->bodies) {
        for (uint32_t row = 0; row < ROWS; row++) {
            if (pass > 0) {
                // Rows that the body before has finished when it is done with this row and the next of its pass.
                const uint32_t pass_of_before = (pass - 1) / of->bodies;
                const uint32_t last = row + 1 < ROWS ? row + 2 : ROWS;
                mspringi_progress_wait(&of->progress[before], pass_of_before * ROWS + last);
            }
            of->rows[row] = next_row(of->rows[row], of->rows[row + 1]);
            mspringi_progress_advance(&of->progress[index], ++done);
        }
        if (of->slow && index == of->bodies / 2) {
            rest(1);
        }
    }
}

static void check_wavefront(mspringi_tasks *tasks, uint32_t worker_count) {
    const uint32_t bodies = mspringi_tasks_concurrency(tasks);
    assert_in_range(bodies, 1, worker_count);
    if (bodies == 1) {
        return; // nothing that may wait
    }
    for (int slow = 0; slow < 2; slow++) {
        wavefront of = {.progress = mspringi_tasks_progress(tasks), .bodies = bodies, .slow = slow};
        uint32_t expected[ROWS + 1];
        for (uint32_t row = 0; row <= ROWS; row++) {
            of.rows[row] = expected[row] = row * row;
        }
        for (uint32_t pass = 0; pass < PASSES * bodies; pass++) {
            for (uint32_t row = 0; row < ROWS; row++) {
                expected[row] = next_row(expected[row], expected[row + 1]);
            }
        }
        mspringi_tasks_run(tasks, bodies, wavefront_body, &of);
        assert_memory_equal(of.rows, expected, sizeof expected);
    }
}

static void bodies_may_wait_for_each_other(void **state) {
    (void)state;
    with_all(check_wavefront);
}

static void counters_go_on_after_the_largest_number(void **state) {
    (void)state;
    mspringi_progress *progress = aligned_alloc(MSPRINGI_CACHE_LINE, sizeof *progress);
    assert_non_null(progress);
    assert_true(mspringi_progress_init(progress));
    assert_int_equal(mspringi_progress_wait(progress, 0), 0);
    mspringi_progress_reset(progress, UINT32_MAX);
    assert_int_equal(mspringi_progress_wait(progress, UINT32_MAX - 5), UINT32_MAX);
    mspringi_progress_advance(progress, 3);
    assert_int_equal(mspringi_progress_wait(progress, UINT32_MAX), 3);
    mspringi_progress_destroy(progress);
    free(progress);
}

/* ------------------------------------------------------------------------------------------------ arithmetic */

static void denormal_body(void *argument, uint32_t index, uint32_t worker) {
    (void)worker;
    volatile float smallest = 1.17549435e-38f;
    smallest = smallest / 4;
    ((float *)argument)[index] = smallest * 4;
}

static void check_denormals(mspringi_tasks *tasks, uint32_t worker_count) {
    float found[MOST] = {0};
    mspringi_tasks_run(tasks, worker_count, denormal_body, found);
    for (uint32_t i = 0; i < worker_count; i++) {
        assert_true(found[i] == 1.17549435e-38f);
    }
}

static void all_threads_calculate_alike(void **state) {
    (void)state;
    with_all(check_denormals);
}

/* ---------------------------------------------------------------------------------------------- hard to make */

static void workers_survive_every_failure(void **state) {
    (void)state;
    mspring_result result = MSPRING_ERROR_MEMORY;
    size_t fail_at = 0;
    while (result != MSPRING_OK) {
        fail_at++;
        watched_allocator watched = {.fail_at = fail_at};
        const mspring_allocator allocator = watched_interface(&watched);
        mspringi_memory memory;
        mspringi_message message = {""};
        mspringi_tasks *const untouched = (mspringi_tasks *)(uintptr_t)16;
        mspringi_tasks *tasks = untouched;
        check_ok(mspringi_memory_init(&memory, &allocator, &message));
        result = mspringi_tasks_create(3, NULL, &memory, &message, &tasks);
        if (result == MSPRING_OK) {
            check_census(tasks, 3);
            mspringi_tasks_destroy(tasks, &memory);
        } else {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(message.text, "memory for 3 workers");
            assert_ptr_equal(tasks, untouched);
        }
        check_watched_clean(&watched);
    }
    assert_int_equal(fail_at, 5); // itself, counters, pool, its workers
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_body_runs_once),           cmocka_unit_test(runs_of_any_size_follow_each_other),
        cmocka_unit_test(bodies_may_wait_for_each_other), cmocka_unit_test(counters_go_on_after_the_largest_number),
        cmocka_unit_test(all_threads_calculate_alike),    cmocka_unit_test(workers_survive_every_failure),
    };
    return cmocka_run_group_tests_name("tasks", tests, NULL, NULL);
}
