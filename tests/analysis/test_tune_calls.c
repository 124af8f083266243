/// @file test_tune_calls.c
/// What tuning leaves as it was: the network, whatever fails, and everything after a call that is refused.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"
#include "tunes.h"

static void count_call(const mspring_hook_args *args, void *user) {
    (void)args;
    ++*(uint32_t *)user;
}

static void nothing_happens_to_the_network(void **state) {
    (void)state;
    uint32_t calls = 0;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 100, 0, NULL),
                    *untouched = tunes_bar(TUNES_STIFFNESS, 100, 0, NULL);
    mspring_network *const both[] = {network, untouched};
    const mspring_id first = 20;
    float strains[512];
    for (uint32_t i = 0; i < COUNT_OF(strains); i++) {
        strains[i] = 1e-5f; // which gravity is enough for
    }
    for (uint32_t i = 0; i < 2; i++) {
        check_ok(support_add_hook(both[i], MSPRING_PHASE_AFTER_SUBSTEP, count_call, &calls, NULL));
        check_ok(mspring_network_reserve_events(both[i], 100));
        check_ok(mspring_network_break_springs(both[i], &first, 0, 1));
        check_ok(mspring_network_restore_springs(both[i], &first, 0, 1, 0.1));
        check_ok(mspring_network_set(both[i], MSPRING_BREAK_STRAIN, NULL, 0,
                                     mspring_network_count(both[i], MSPRING_SPRINGS), strains, 1));
        check_ok(mspring_network_apply_force(both[i], 17, 1000, 500));
    }
    const size_t used = support_memory_used(network);
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    const tunes_table out = tunes_run(network, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        // Had springs broken, it would have fallen.
        assert_true(out.rows[i].trajectory_share < 0.5 && out.rows[i].rest_share < 0.01);
    }
    assert_int_equal(calls, 0);
    assert_int_equal(support_memory_used(network), used);
    assert_string_equal(mspring_network_error(network), "");
    mspring_settings solver = tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0);
    for (uint32_t i = 0; i < 2; i++) {
        check_ok(support_set_solver(both[i], &solver));
        support_steps(both[i], 5, 1.0 / 64);
    }
    assert_int_equal(support_hash(network), support_hash(untouched));
    mspring_network_destroy(network);
    mspring_network_destroy(untouched);
}

static void networks_that_may_sleep_stay_awake(void **state) {
    (void)state;
    mspring_network_def how = support_def(-9.8f, 12);
    how.settings.sleep_speed = 1e6f; // it sleeps whatever it does
    how.settings.sleep_time = 0;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, &how),
                    *awake = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    support_steps(network, 1, 1e-6);
    assert_true(support_is_asleep(network));
    tunes_watch w = {.tick = 1e-3};
    mspring_tune_def def = tunes_def(&w);
    const tunes_table out = tunes_run(network, &def), expected = tunes_run(awake, &def);
    for (uint32_t i = 0; i < out.count; i++) {
        // A millionth of a second has passed; positions are rounded to a millionth of what they move by.
        check_near(out.rows[i].trajectory_share, expected.rows[i].trajectory_share,
                   0.01 * expected.rows[i].trajectory_share + 1e-6);
    }
    assert_true(support_is_asleep(network));
    mspring_network_destroy(network);
    mspring_network_destroy(awake);
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 9, 0),
                                           tunes_setting(MSPRING_SOLVER_IMPLICIT, 1, 2)};
    size_t failures = 0;
    for (size_t fail_at = 1;; fail_at++) {
        watched_allocator watched = {.fail_at = 0};
        const mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def how = support_def(-9.8f, 1);
        how.allocator = &allocator;
        recipe made = tunes_bar_recipe(5, 2, TUNES_STIFFNESS, 100, 0);
        mspring_network *network = recipe_network(&made, &how);
        recipe_free(&made);
        const size_t live = watched.live;
        const uint64_t hash = support_hash(network);
        tunes_watch w = {.tick = 1e-3};
        mspring_tune_def def = tunes_def(&w);
        def.settings = settings;
        def.setting_count = COUNT_OF(settings);
        def.duration = 4 * def.dt;
        mspring_tune_scene scene;
        check_ok(mspring_init(MSPRING_STRUCT_TUNE_SCENE, &scene, sizeof scene));
        scene.start_count = 4;
        scene.duration = 2 * def.dt;
        def.scene = &scene;
        tunes_table out, untouched;
        tunes_clear(&out);
        tunes_clear(&untouched);
        watched.fail_at = watched.calls + fail_at;
        const mspring_result result = mspring_network_tune(network, &def, out.rows, TUNES_MOST, &out.count);
        assert_int_equal(watched.live, live);
        assert_int_equal(support_hash(network), hash);
        if (result != MSPRING_OK) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_memory_equal(&out, &untouched, sizeof out);
            failures++;
        }
        mspring_network_destroy(network);
        check_watched_clean(&watched);
        if (result == MSPRING_OK) {
            break;
        }
    }
    assert_true(failures > 100);
}

static mspring_result in_hook_result;

static void tune_in_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    tunes_table out;
    tunes_clear(&out);
    in_hook_result = mspring_network_tune(user, NULL, out.rows, TUNES_MOST, &out.count);
}

static void bad_calls_are_refused(void **state) {
    (void)state;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    tunes_watch w = {.tick = 1e-3};
    tunes_table out;
    uint32_t count = 77;
    tunes_clear(&out);
    const mspring_tune_def good = tunes_def(&w);
    check_error(mspring_init(MSPRING_STRUCT_TUNE_DEF, NULL, sizeof good), MSPRING_ERROR_ARGUMENT);
    mspring_tune_def def;
    check_error(mspring_init(MSPRING_STRUCT_TUNE_DEF, &def, sizeof def + 2), MSPRING_ERROR_STRUCT);
    check_error(mspring_network_tune(NULL, &good, out.rows, TUNES_MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_tune(network, &good, NULL, TUNES_MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_tune(network, &good, out.rows, TUNES_MOST, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_tune(network, &good, out.rows, 2, &count), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "room for 2 rows");
    out.rows[0].struct_size = 8; // that of the first counts
    check_error(mspring_network_tune(network, &good, out.rows, TUNES_MOST, &count), MSPRING_ERROR_STRUCT);
    tunes_clear(&out);

    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 1, 0),
                                           tunes_setting(MSPRING_SOLVER_EXPLICIT, 0, 0)};
    for (int bad = 0; bad < 18; bad++) {
        def = good;
        switch (bad) {
        case 0:
            def.dt = 0;
            break;
        case 1:
            def.dt = NAN;
            break;
        case 2:
            def.duration = -1;
            break;
        case 3:
            def.duration = 1e9;
            break;
        case 4:
            def.budget = 0;
            break;
        case 5:
            def.budget = NAN;
            break;
        case 6:
            def.max_error = 0;
            break;
        case 7:
            def.max_cost = NAN;
            break;
        case 8:
            def.measure = 4;
            break;
        case 9:
            def.measure = -1;
            break;
        case 10:
            def.settings = settings;
            break;
        case 11:
            def.setting_count = 3;
            break;
        case 12:
            def.settings = settings;
            def.setting_count = 1001;
            break;
        case 13:
            def.dt = 1e-300; // no float
            def.duration = 1e-299;
            break;
        case 14:
            def.flags = 2;
            break;
        case 15:
            def.max_drift = -0.1;
            break;
        case 16:
            def.duration = NAN;
            break;
        default:
            def.settings = settings;
            def.setting_count = 2;
        }
        check_error(mspring_network_tune(network, &def, out.rows, TUNES_MOST, &count), MSPRING_ERROR_ARGUMENT);
        assert_true(strlen(mspring_network_error(network)) > 10);
    }
    check_contains(mspring_network_error(network), "setting 1: substeps");
    def = good;
    def.struct_size -= 8;
    check_error(mspring_network_tune(network, &def, out.rows, TUNES_MOST, &count), MSPRING_ERROR_STRUCT);
    assert_int_equal(count, 77);

    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, tune_in_hook, network, NULL));
    const mspring_settings solver = tunes_setting(MSPRING_SOLVER_EXPLICIT, 12, 0);
    check_ok(support_set_solver(network, &solver));
    support_steps(network, 1, 1.0 / 64);
    check_error(in_hook_result, MSPRING_ERROR_BUSY);
    mspring_network_destroy(network);
}

static mspring_result refuse(mspring_network *run, uint32_t start, void *user) {
    (void)run;
    (void)user;
    return start == 2 ? MSPRING_ERROR_ID : MSPRING_OK;
}

static void bad_scenes_are_refused(void **state) {
    (void)state;
    mspring_network *network = tunes_bar(TUNES_STIFFNESS, 0, 0, NULL);
    const uint64_t hash = support_hash(network);
    const size_t used = support_memory_used(network);
    tunes_watch w = {.tick = 1e-3};
    tunes_table out;
    uint32_t count = 77;
    tunes_clear(&out);
    mspring_tune_def def = tunes_def(&w);
    mspring_tune_scene good, scene;
    check_error(mspring_init(MSPRING_STRUCT_TUNE_SCENE, NULL, sizeof good), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_init(MSPRING_STRUCT_TUNE_SCENE, &good, sizeof good - 8), MSPRING_ERROR_STRUCT);
    check_ok(mspring_init(MSPRING_STRUCT_TUNE_SCENE, &good, sizeof good));
    def.measure = MSPRING_TUNE_BY_SCENE;
    check_error(mspring_network_tune(network, &def, out.rows, TUNES_MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "scene");
    def.scene = &scene;
    for (int bad = 0; bad < 14; bad++) {
        scene = good;
        switch (bad) {
        case 0:
            scene.flags = 8;
            break;
        case 1:
            scene.start_count = 3;
            break;
        case 2:
            scene.start_count = 65;
            break;
        case 3:
            scene.duration = 0;
            break;
        case 4:
            scene.duration = NAN;
            break;
        case 5:
            scene.duration = 1e9;
            break;
        case 6:
            scene.kick = 0;
            break;
        case 7:
            scene.kick = INFINITY;
            break;
        case 8:
            scene.max_distance = 0;
            break;
        case 9:
            scene.max_distance = NAN;
            break;
        case 10:
            scene.tolerance = -1;
            break;
        case 11:
            scene.tolerance = NAN;
            break;
        case 12:
            scene.kick = NAN;
            break;
        default:
            scene.reserved = 1;
        }
        check_error(mspring_network_tune(network, &def, out.rows, TUNES_MOST, &count), MSPRING_ERROR_ARGUMENT);
        assert_true(strlen(mspring_network_error(network)) > 10);
    }
    scene = good;
    scene.struct_size--;
    check_error(mspring_network_tune(network, &def, out.rows, TUNES_MOST, &count), MSPRING_ERROR_STRUCT);
    scene = good;
    scene.prepare = refuse;
    scene.duration = 2 * def.dt;
    check_error(mspring_network_tune(network, &def, out.rows, TUNES_MOST, &count), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "prepare returned");
    assert_int_equal(count, 77);
    assert_int_equal(support_hash(network), hash);
    assert_int_equal(support_memory_used(network), used);
    mspring_network_destroy(network);

    network = tunes_bar(0.5, 0, MSPRING_SPRING_RELATIVE, NULL);
    scene.prepare = NULL;
    check_error(mspring_network_tune(network, &def, out.rows, TUNES_MOST, &count), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "relative springs");
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_happens_to_the_network), cmocka_unit_test(networks_that_may_sleep_stay_awake),
        cmocka_unit_test(every_allocation_may_fail),      cmocka_unit_test(bad_calls_are_refused),
        cmocka_unit_test(bad_scenes_are_refused),
    };
    return cmocka_run_group_tests_name("tune_calls", tests, NULL, NULL);
}
