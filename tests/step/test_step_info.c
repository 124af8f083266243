/// @file test_step_info.c
/// What a network tells of its last step, and of all so far.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "recipe.h"
#include "snapshots.h"
#include "support.h"

#define DT 0.01

/// Two particles, and a spring that is stable below 0.01 s.
static mspring_network *pair(mspring_guard guard, uint32_t substeps) {
    mspring_builder *builder = support_builder();
    support_particle(builder, 5, 5, 1); // loose
    const mspring_id a = support_particle(builder, 0, 0, 1), b = support_particle(builder, 1.1, 0, 2);
    support_spring(builder, a, b, 1e5f, 0);
    mspring_network_def def = support_def(0, substeps);
    def.settings.guard = guard;
    def.settings.max_substeps = 100;
    mspring_network *network = support_network(builder, &def);
    const float speed = 3, other = 4;
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &speed, &other, 1));
    return network;
}

static void it_counts(void **state) {
    (void)state;
    mspring_network *network = pair(MSPRING_GUARD_GROWTH, 10);
    mspring_step_info info = support_step_info(network);
    assert_int_equal(info.result, MSPRING_OK);
    assert_int_equal(info.particle, MSPRING_NONE);
    assert_int_equal(info.spring, MSPRING_NONE);
    assert_int_equal(info.step_count + info.fallback_count + info.flags + info.substeps, 0);
    check_near(info.time, 0, 0);
    check_near(support_largest_speed(network), 5, 1e-6);
    support_steps(network, 8, 0.125 / 16);
    info = support_step_info(network);
    assert_int_equal(info.step_count, 8);
    assert_int_equal(info.substeps, 10);
    check_near(info.time, 0.0625, 0); // a power of two
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
    info = support_step_info(network);
    assert_int_equal(info.result, MSPRING_ERROR_ARGUMENT);
    assert_int_equal(info.step_count, 8);
    mspring_network_destroy(network);
}

static void it_names_the_culprit(void **state) {
    (void)state;
    mspring_network *network = pair(MSPRING_GUARD_GROWTH, 1);
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    mspring_step_info info = support_step_info(network);
    assert_int_equal(info.result, MSPRING_ERROR_UNSTABLE);
    assert_int_equal(info.spring, 0);
    assert_int_equal(info.particle, 1); // the lighter end
    assert_string_equal(mspring_network_error(network),
                        "unstable: the substep of 0.01 s exceeds the stability limit (spring 0, particle 1). Use a "
                        "shorter dt, more substeps or lower stiffness.");
    check_ok(mspring_network_step(network, DT / 10));
    info = support_step_info(network);
    assert_int_equal(info.result, MSPRING_OK);
    assert_int_equal(info.spring, MSPRING_NONE);
    assert_int_equal(info.particle, MSPRING_NONE);

    check_ok(mspring_network_apply_force(network, 0, 1e12f, 0)); // throws it out of the bounds
    check_error(mspring_network_step(network, DT / 10), MSPRING_ERROR_UNSTABLE);
    info = support_step_info(network);
    assert_int_equal(info.particle, 0);
    assert_int_equal(info.spring, MSPRING_NONE);
    check_contains(mspring_network_error(network), "throw particle 0 to ");
    mspring_network_destroy(network);

    network = pair(MSPRING_GUARD_GROWTH, MSPRING_SUBSTEPS_AUTO);
    check_error(mspring_network_step(network, 10), MSPRING_ERROR_UNSTABLE);
    info = support_step_info(network);
    assert_int_equal(info.spring, 0);
    assert_int_equal(info.particle, MSPRING_NONE);
    mspring_network_destroy(network);

    network = pair(MSPRING_GUARD_GROWTH, 10);
    support_writing writing = {.array = 2, .particle = 2, .value = 1e30f};
    (void)support_write_in_step(network, &writing);
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    assert_int_equal(support_step_info(network).particle, 2);
    mspring_network_destroy(network);
}

static void it_tells_what_the_guard_did(void **state) {
    (void)state;
    const struct {
        mspring_guard guard;
        uint32_t flags, substeps;
        uint64_t fallback_count;
    } guards[] = {{MSPRING_GUARD_IMPLICIT, MSPRING_STEP_FALLBACK, 1, 1},
                  {MSPRING_GUARD_CLAMP, MSPRING_STEP_CLAMPED, 1, 1},
                  {MSPRING_GUARD_RETRY, MSPRING_STEP_RETRIED, 2, 0}};
    for (size_t i = 0; i < COUNT_OF(guards); i++) {
        mspring_network *network = pair(guards[i].guard, 1);
        check_ok(mspring_network_step(network, DT * 0.8));
        const mspring_step_info info = support_step_info(network);
        assert_int_equal(info.result, MSPRING_OK);
        assert_int_equal(info.flags, guards[i].flags);
        assert_int_equal(support_step_flags(network), guards[i].flags);
        assert_int_equal(info.substeps, guards[i].substeps);
        assert_int_equal(info.fallback_count, guards[i].fallback_count);
        assert_int_equal(info.spring, 0); // what it was for
        assert_string_equal(mspring_network_error(network), "");
        mspring_network_destroy(network);
    }
    mspring_network *network = pair(MSPRING_GUARD_CLAMP_BOUNDS, 1);
    check_ok(mspring_network_apply_force(network, 0, 1e12f, 0));
    check_ok(mspring_network_step(network, DT));
    assert_int_equal(support_step_info(network).flags, MSPRING_STEP_PUT_BACK);
    mspring_network_destroy(network);
}

static void it_tells_that_nothing_was_computed(void **state) {
    (void)state;
    mspring_network *network = pair(MSPRING_GUARD_GROWTH, 10);
    const float none = 0;
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &none, &none, 1));
    mspring_settings settings = support_settings(network);
    settings.sleep_speed = 1;
    settings.sleep_time = 0;
    check_ok(mspring_network_set_settings(network, &settings));
    support_fall_asleep(network, DT);
    const uint64_t count = support_step_info(network).step_count;
    assert_int_equal(support_step_info(network).flags, 0);
    check_ok(mspring_network_step(network, DT));
    const mspring_step_info info = support_step_info(network);
    assert_int_equal(info.flags, MSPRING_STEP_ASLEEP);
    assert_int_equal(support_step_flags(network), MSPRING_STEP_ASLEEP);
    assert_int_equal(support_step_flags(NULL), 0);
    assert_int_equal(info.step_count, count + 1);
    mspring_network_destroy(network);
}

static void snapshots_and_clones_go_on_counting(void **state) {
    (void)state;
    mspring_network *network = pair(MSPRING_GUARD_CLAMP, 1), *clone = NULL;
    support_steps(network, 20, DT * 0.8);
    const mspring_step_info then = support_step_info(network);
    assert_true(then.fallback_count > 0);
    const saved before = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    check_ok(mspring_network_clone(network, NULL, &clone));
    const mspring_step_info cloned = support_step_info(clone);
    assert_memory_equal(&cloned, &then, sizeof then);
    check_ok(mspring_network_apply_force(network, 0, 1e12f, 0));
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    support_steps(clone, 5, DT / 100);
    mspring_network *const both[] = {network, clone};
    for (size_t i = 0; i < 2; i++) {
        snapshots_load(both[i], &before);
        const mspring_step_info now = support_step_info(both[i]);
        assert_int_equal(now.result, MSPRING_OK);
        assert_int_equal(now.particle, MSPRING_NONE);
        assert_int_equal(now.flags, 0);
        assert_int_equal(now.step_count, then.step_count);
        assert_int_equal(now.fallback_count, then.fallback_count);
        assert_int_equal(now.substeps, then.substeps);
        check_near(now.time, then.time, 0);
        mspring_network_destroy(both[i]);
    }
    free(before.bytes);
}

static void forged_counts_are_refused(void **state) {
    (void)state;
    mspring_network *network = pair(MSPRING_GUARD_GROWTH, 10);
    support_steps(network, 3, DT);
    const saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const size_t at = (size_t)(snapshots_section_of(&good, "step", &size) - good.bytes);
    assert_int_equal(size, 72);
    const double times[] = {-1, 0, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(times); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_double(bad.bytes + at + 16, times[i]);
        snapshots_check_refused(network, &bad, "there were 3, 0 by the fallback");
        free(bad.bytes);
    }
    for (size_t i = 0; i < COUNT_OF(times); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_double(bad.bytes + at + 32, times[i]); // dt
        snapshots_check_refused(network, &bad, "the last step of");
        free(bad.bytes);
    }
    const float lags[] = {-1e-3f, -FLT_MIN, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(lags); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_float(bad.bytes + at + 28, lags[i]);
        snapshots_check_refused(network, &bad, "the last of");
        free(bad.bytes);
    }
    const struct {
        size_t at;
        uint32_t value;
    } words[] = {{0, 0}, {8, 4}, {12, 1}, {24, 0}, {24, MSPRING_MAX_SUBSTEPS + 1}, {40, 601}};
    for (size_t i = 0; i < COUNT_OF(words); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_word(bad.bytes + at + words[i].at, words[i].value);
        snapshots_check_refused(network, &bad, "by the fallback");
        free(bad.bytes);
    }
    free(good.bytes);
    mspring_network_destroy(network);
}

static mspring_step_info seen;
static void look(const mspring_hook_args *args, void *user) {
    (void)args;
    seen = support_step_info(user);
}

static void hooks_see_the_step_before(void **state) {
    (void)state;
    mspring_network *network = pair(MSPRING_GUARD_GROWTH, 10);
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_SUBSTEP, look, network, NULL));
    support_steps(network, 3, DT);
    assert_int_equal(seen.step_count, 2);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_counts),
        cmocka_unit_test(it_names_the_culprit),
        cmocka_unit_test(it_tells_what_the_guard_did),
        cmocka_unit_test(it_tells_that_nothing_was_computed),
        cmocka_unit_test(snapshots_and_clones_go_on_counting),
        cmocka_unit_test(forged_counts_are_refused),
        cmocka_unit_test(hooks_see_the_step_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
