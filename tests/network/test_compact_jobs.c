/// @file test_compact_jobs.c
/// Another layout made beside the network: begun, run in any way, finished or not.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "allocator.h"
#include "look.h"
#include "snapshots.h"
#include "support.h"
#include "wrecks.h"

static void work_is_done_in_pieces(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1),
                    *at_once = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
    wrecks_make(network, &made, TORN);
    wrecks_make(at_once, &made, TORN);
    const uint32_t before = wrecks_swept(network);
    uint32_t left = 100, functions = 0;
    mspring_job *job;
    check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
    for (; left > 0; functions++) {
        const uint32_t left_before = left;
        check_ok(mspring_job_run(job, 1, &left));
        assert_true(left <= left_before);
    }
    assert_int_equal(wrecks_swept(network), before);
    assert_true(functions > 50);
    check_ok(mspring_job_finish(network, job));
    mspring_job_destroy(job);
    assert_true(wrecks_swept(network) < before);
    check_ok(mspring_network_compact(at_once));
    support_steps(network, 5, 1.0 / 64);
    support_steps(at_once, 5, 1.0 / 64);
    assert_int_equal(support_hash(network), support_hash(at_once));
    mspring_network_destroy(network);
    mspring_network_destroy(at_once);
    recipe_free(&made);
}

/// A wreck so large that copying its springs takes many pieces.
static recipe large_recipe(void) {
    uint64_t seed = 8;
    const recipe_stuff stuff = {.mass = {1, 2},
                                .stiffness = {0.1, 0.2},
                                .damping = {0, 0.05},
                                .spring_flags = MSPRING_SPRING_RELATIVE,
                                .holes = 0.05};
    const recipe_stuff absolute = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}};
    recipe made = {0};
    const mspring_id first = recipe_lattice(&made, 150, 50, 0, 0, 1, &stuff, &seed);
    recipe_rope(&made, first, first + 900, 30, &absolute, &seed);
    recipe_random_springs(&made, 100, &absolute, &seed);
    recipe_disturb(&made, 0.02, 0.2, &seed);
    return made;
}

/// Change some springs in one way or another, in both networks alike.
static void change_something(mspring_network *const both[2], uint64_t *seed, saved *kept) {
    const uint32_t springs = mspring_network_count(both[0], MSPRING_SPRINGS);
    const uint32_t what = (uint32_t)(support_random(seed) % 10);
    mspring_id list[20];
    float values[20];
    for (int i = 0; i < 20; i++) {
        list[i] = (mspring_id)(support_random(seed) % springs);
        values[i] = 0.05f + 0.001f * (float)(support_random(seed) % 100);
    }
    for (int i = 0; i < 2; i++) {
        mspring_network *n = both[i];
        switch (what) {
        case 0:
            check_ok(mspring_network_set(n, MSPRING_STIFFNESS, list, 0, 20, values, 1));
            break;
        case 1:
            check_ok(mspring_network_set(n, MSPRING_DAMPING, list, 0, 20, values, 1));
            break;
        case 2: // from the first on, rest lengths are not shared any more
            for (int j = 0; j < 20 && i == 0; j++) {
                values[j] += 0.9f;
            }
            check_ok(mspring_network_set(n, MSPRING_REST_LENGTH, list, 0, 20, values, 1));
            break;
        case 3: // likewise thresholds
            for (int j = 0; j < 20 && i == 0; j++) {
                values[j] += 5;
            }
            check_ok(mspring_network_set(n, MSPRING_BREAK_STRAIN, list, 0, 20, values, 1));
            break;
        case 4:
            check_ok(mspring_network_set(n, MSPRING_WARN_STRAIN, list, 0, 20, values, 1));
            break;
        case 5: // at once, so that none of them is one that was broken before
            check_ok(mspring_network_break_springs(n, list, 0, 20));
            check_ok(mspring_network_restore_springs(n, list + 10, 0, 1, 0.05));
            break;
        case 6:
            check_ok(mspring_network_break_springs(n, list, 0, 20));
            break;
        case 7: // another substep: all relative springs are derived anew
            support_steps(n, 1, 1.0 / (64 + values[0]));
            break;
        case 8:
            if (kept->bytes) {
                check_ok(mspring_network_load(n, kept->bytes, kept->size));
            }
            break;
        default:
            support_steps(n, 1, 1.0 / 64);
            break;
        }
    }
}

/// Whatever happens to springs while they are copied, piece by piece, they are what they would be without.
static void nothing_that_happens_meanwhile_is_lost(void **state) {
    (void)state;
    recipe made = large_recipe();
    for (uint64_t life = 0; life < 4; life++) {
        uint64_t seed = 40 + life;
        mspring_network *const both[2] = {wrecks_network(&made, MSPRING_SIMD_AUTO, 1),
                                          wrecks_network(&made, MSPRING_SIMD_AUTO, 1)};
        saved kept = {NULL, 0};
        for (int i = 0; i < 2; i++) {
            support_steps(both[i], 1, 1.0 / 64);
            wrecks_make(both[i], &made, life % 2 == 0 ? TORN : SHATTERED);
        }
        mspring_job *job = NULL;
        uint32_t pieces = 0;
        for (; pieces == 0 || (job && pieces < 400); pieces++) {
            if (pieces == 20 && life >= 2) {
                kept = snapshots_save(both[0], MSPRING_SNAPSHOT_ALL);
            }
            if (pieces < 200) { // and then in peace
                change_something(both, &seed, &kept);
            }
            support_compact(both[0], 1, &job);
        }
        assert_null(job);
        assert_true(pieces > 20);
        check_same_look(look_at(both[0]), look_at(both[1]), both[0]);
        free(kept.bytes);
        mspring_network_destroy(both[0]);
        mspring_network_destroy(both[1]);
    }
    recipe_free(&made);
}

/// What fails for want of memory fails in the same words again, until the job is destroyed; then another succeeds.
static void every_failure_of_a_job_can_be_repeated(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    bool failed = true;
    size_t fail_at = 1;
    for (; failed; fail_at++) {
        watched_allocator watched = {.fail_at = 0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        mspring_job *job = NULL;
        wrecks_set_up(network, 3);
        wrecks_make(network, &made, TORN);
        const uint64_t hash = support_hash(network);
        watched.fail_at = watched.calls + fail_at;
        mspring_result result = mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job);
        if (result == MSPRING_OK) {
            result = mspring_job_run(job, 0, NULL);
        }
        failed = result != MSPRING_OK;
        watched.fail_at = 0;
        if (failed) {
            check_error(result, MSPRING_ERROR_MEMORY);
        }
        if (failed && job) {
            check_error(mspring_job_run(job, 0, NULL), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_job_error(job), "memory");
            check_error(mspring_job_finish(network, job), MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
        } else if (!failed) {
            check_ok(mspring_job_finish(network, job));
        }
        mspring_job_destroy(job);
        assert_int_equal(support_hash(network), hash);
        check_ok(mspring_network_compact(network));
        support_steps(network, 1, 1.0 / 64);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    assert_true(fail_at > 30); // copies, topology, state, records, solver
    recipe_free(&made);
}

/// A job is begun, run by some functions, and the network and it are destroyed in this order or the other; or the
/// layout changes meanwhile.
static void a_job_may_stay_unfinished(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (uint32_t functions = 1; functions < 120; functions += 7) {
        watched_allocator watched = {.fail_at = 0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        mspring_job *job = NULL, *other = NULL;
        wrecks_make(network, &made, TORN);
        check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
        check_error(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &other), MSPRING_ERROR_BUSY);
        assert_null(other);
        check_error(mspring_job_finish(network, job), MSPRING_ERROR_BUSY);
        check_ok(mspring_job_run(job, functions, NULL));
        if (functions % 3 == 0) {
            check_ok(mspring_network_compact(network));
            check_ok(mspring_job_run(job, 0, NULL));
            check_error(mspring_job_finish(network, job), MSPRING_ERROR_OUTDATED);
        }
        if (functions % 2 == 0) {
            mspring_job_destroy(job);
            check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
        }
        mspring_network_destroy(network);
        check_ok(mspring_job_run(job, 0, NULL)); // it owns all that it reads
        mspring_job_destroy(job);
        check_watched_clean(&watched);
    }
    recipe_free(&made);
}

/// The frame that finishes a job frees nothing: the job keeps the old plan, and may outlive the network.
static void what_a_job_replaces_is_freed_with_it(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (uint32_t solver = 0; solver < 3; solver++) {
        watched_allocator watched = {.fail_at = 0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        mspring_job *job = NULL;
        wrecks_set_up(network, solver);
        wrecks_make(network, &made, TORN);
        check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
        check_ok(mspring_job_run(job, 0, NULL));
        const size_t blocks = watched.live, calls = watched.calls;
        check_ok(mspring_job_finish(network, job));
        assert_int_equal(watched.live - blocks, watched.calls - calls); // what it took, and nothing was freed
        support_steps(network, 1, 1.0 / 64);
        if (solver == 1) {
            mspring_network_destroy(network);
            network = NULL;
        }
        mspring_job_destroy(job);
        assert_true(watched.live < blocks);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    recipe_free(&made);
}

/// The bits depend on when a job is begun and finished, not on how it is run; if nothing breaks in between they are
/// those of a compaction at the finish.
static void bits_depend_on_begin_and_finish_alone(void **state) {
    (void)state;
    static const uint32_t functions[] = {0, 1, 17};
    recipe made = wrecks_recipe();
    for (int run = 0; run < WRECKS_RUNS; run++) {
        uint64_t at_once = 0;
        for (int way = -1; way < 3; way++) {
            mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
            mspring_job *job = NULL;
            wrecks_set_up(network, run);
            wrecks_make(network, &made, TORN);
            uint32_t left = 1;
            for (int aim = 0; aim < 2; aim++) {
                const mspring_layout layout = aim == 0 ? MSPRING_LAYOUT_COMPACT : MSPRING_LAYOUT_WHOLE;
                if (way >= 0) {
                    check_ok(mspring_job_begin(network, layout, &job));
                }
                for (int frame = 0; frame < 3; frame++) {
                    support_steps(network, 1, 1.0 / 64);
                    if (way >= 0) {
                        check_ok(mspring_job_run(job, functions[way], &left));
                    }
                }
                if (way < 0) {
                    check_ok(aim == 0 ? mspring_network_compact(network) : support_expand(network));
                } else {
                    check_ok(mspring_job_run(job, 0, &left));
                    check_ok(mspring_job_finish(network, job));
                    check_error(mspring_job_finish(network, job), MSPRING_ERROR_ARGUMENT);
                    check_error(mspring_job_run(job, 0, NULL), MSPRING_ERROR_ARGUMENT);
                    assert_int_equal(left, 0);
                    mspring_job_destroy(job);
                }
                support_steps(network, 3, 1.0 / 64);
            }
            at_once = way < 0 ? support_hash(network) : at_once;
            assert_int_equal(support_hash(network), at_once);
            mspring_network_destroy(network);
        }
    }
    recipe_free(&made);
}

/// What a job's layout leaves out and somebody restores, or what it does not know, makes it outdated.
static void jobs_become_outdated(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    for (int what = 0; what < 5; what++) {
        mspring_network_def def = support_def(-9.8f, 4);
        def.spare_springs = 2;
        mspring_network *network = recipe_network(&made, &def);
        mspring_job *job = NULL;
        mspring_id spring = 0, ids[1];
        wrecks_make(network, &made, TORN);
        while (!wrecks_breaks(&made, TORN, spring)) {
            spring++;
        }
        check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
        check_ok(mspring_job_run(job, 50, NULL));
        mspring_spring_def added;
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &added, sizeof added));
        added.a = made.particle_count - 1;
        added.b = 0;
        if (what == 0) {
            check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0));
        } else if (what == 1) {
            check_ok(mspring_network_add_springs(network, &added, 1, ids));
        } else if (what == 2) {
            check_ok(mspring_network_remove_springs(network, &spring, 0, 1));
        } else if (what == 3) {
            check_ok(mspring_network_reuse_ids(network));
        }
        support_steps(network, 1, 1.0 / 64);
        check_ok(mspring_job_run(job, 0, NULL));
        const uint64_t hash = support_hash(network);
        const uint32_t before = wrecks_swept(network);
        if (what < 4) {
            check_error(mspring_job_finish(network, job), MSPRING_ERROR_OUTDATED);
            assert_int_equal(wrecks_swept(network), before);
        } else {
            check_ok(mspring_job_finish(network, job));
        }
        assert_int_equal(support_hash(network), hash);
        mspring_job_destroy(job);
        check_ok(mspring_network_compact(network));
        support_steps(network, 1, 1.0 / 64);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/// A job that another network is given stays what it was.
static void jobs_belong_to_their_network(void **state) {
    (void)state;
    recipe made = wrecks_recipe();
    mspring_network *network = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
    mspring_network *other = wrecks_network(&made, MSPRING_SIMD_AUTO, 1);
    mspring_job *job = NULL;
    wrecks_make(network, &made, TORN);
    wrecks_make(other, &made, TORN);
    check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
    check_error(mspring_job_finish(other, job), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_job_run(job, 0, NULL));
    const uint32_t before = wrecks_swept(other);
    check_error(mspring_job_finish(other, job), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(other), "another network");
    check_error(mspring_job_finish(network, NULL), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(wrecks_swept(other), before);
    check_ok(mspring_job_finish(network, job));
    assert_true(wrecks_swept(network) < before);
    mspring_job_destroy(job);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(work_is_done_in_pieces),
        cmocka_unit_test(nothing_that_happens_meanwhile_is_lost),
        cmocka_unit_test(every_failure_of_a_job_can_be_repeated),
        cmocka_unit_test(a_job_may_stay_unfinished),
        cmocka_unit_test(what_a_job_replaces_is_freed_with_it),
        cmocka_unit_test(bits_depend_on_begin_and_finish_alone),
        cmocka_unit_test(jobs_become_outdated),
        cmocka_unit_test(jobs_belong_to_their_network),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
