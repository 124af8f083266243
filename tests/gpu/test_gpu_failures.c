/// @file test_gpu_failures.c
/// Each call of OpenCL fails once, and each ends all: an error that names the device and the call, nothing left behind,
/// and the batch in the state of before. Devices that are not exact are refused.
///
/// SPDX-License-Identifier: MIT
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "batches.h"

static void (*let_fail)(unsigned, int);
static unsigned (*calls)(void);
static int (*live)(void);
static void (*report)(cl_device_info, cl_ulong);

static void find(void *library, const char *name, void *function) {
    void *const found = dlsym(library, name);
    assert_non_null(found);
    memcpy(function, &found, sizeof found);
}

static mspring_result create(const batch *b, mspring_gpu **gpu, char *message, uint32_t size) {
    mspring_gpu_def def = mspring_gpu_def_default();
    def.library = FAILING_OPENCL;
    def.actuators = b->actuators;
    def.actuator_count = b->actuator_count;
    def.changes = b->changes;
    def.message = message;
    def.message_size = size;
    return mspring_gpu_create(b->network, &def, gpu);
}

static batch small_batch(void) {
    batch b = batch_draw(3 * 7919, BATCH_CHAIN, true, true);
    assert_true(b.actuator_count > 0);
    return b;
}

static void creating(void **state) {
    (void)state;
    batch b = small_batch();
    mspring_gpu *gpu = NULL;
    char message[1024];
    let_fail(0, 0);
    check_ok(create(&b, &gpu, message, sizeof message));
    const unsigned all = calls();
    mspring_gpu_destroy(gpu);
    assert_int_equal(live(), 0);
    assert_true(all > 50);
    for (int ends_all = 0; ends_all < 2; ends_all++)
        for (unsigned i = 1; i <= all; i += support_is_quick() ? 7 : 1) {
            gpu = NULL;
            memset(message, 0, sizeof message);
            let_fail(i, ends_all);
            const mspring_result result = create(&b, &gpu, message, sizeof message);
            let_fail(0, 0);
            if (result == MSPRING_OK) { // the first of two questions that don't matter
                assert_true(!ends_all && i < 12);
                mspring_gpu_destroy(gpu);
            } else {
                assert_true(result == MSPRING_ERROR_DEVICE || result == MSPRING_ERROR_MEMORY);
                assert_true(strlen(message) > 10);
                assert_null(gpu);
            }
            assert_int_equal(live(), 0);
        }
    batch_destroy(&b);
}

typedef mspring_result (*action)(mspring_gpu *gpu, const batch *b);

static mspring_result step(mspring_gpu *gpu, const batch *b) {
    return mspring_gpu_step(gpu, b->dt);
}

static mspring_result reset(mspring_gpu *gpu, const batch *b) {
    (void)b;
    return mspring_gpu_reset(gpu, NULL);
}

static mspring_result observe(mspring_gpu *gpu, const batch *b) {
    double row[2];
    const mspring_observation columns[] = {{MSPRING_GROUP_X, 0}, {MSPRING_RELATIVE_X, b->particle_count - 1}};
    return mspring_gpu_observe(gpu, 0, 1, columns, 2, row, 2);
}

static mspring_result read_all(mspring_gpu *gpu, const batch *b) {
    uint64_t hash;
    double x, y;
    float vx, vy;
    uint32_t flags;
    (void)b;
    mspring_result result = mspring_gpu_get_state_hash(gpu, &hash);
    result = result == MSPRING_OK ? mspring_gpu_get_positions(gpu, 0, 1, &x, &y, 1) : result;
    result = result == MSPRING_OK ? mspring_gpu_get_velocities(gpu, 0, 1, &vx, &vy, 1) : result;
    return result == MSPRING_OK ? mspring_gpu_get_flags(gpu, 0, 1, &flags, 1) : result;
}

// Let each call of an action fail. The state is that of before each time.
static void check_action(mspring_gpu *gpu, const batch *b, action act, const float *signals) {
    uint64_t before, after;
    mspring_result result = MSPRING_ERROR_DEVICE;
    check_ok(mspring_gpu_get_state_hash(gpu, &before));
    for (unsigned i = 1; result != MSPRING_OK; i++) {
        check_ok(mspring_gpu_set_signals(gpu, 0, b->actuator_count, signals, 1));
        let_fail(i, 1);
        result = act(gpu, b);
        const unsigned made = calls();
        let_fail(0, 0);
        assert_true((result == MSPRING_OK) == (made < i));
        if (result == MSPRING_OK)
            break;
        assert_true(result == MSPRING_ERROR_DEVICE || result == MSPRING_ERROR_MEMORY);
        check_contains(mspring_gpu_error(gpu), "failed with");
        check_ok(mspring_gpu_get_state_hash(gpu, &after));
        assert_true(before == after);
        assert_true(i < 100);
    }
}

static void acting(void **state) {
    (void)state;
    batch b = small_batch();
    mspring_gpu *gpu = NULL;
    char message[1024];
    float signals[BATCH_ACTUATORS];
    for (uint32_t i = 0; i < b.actuator_count; i++)
        signals[i] = 1 + 0.01f * (float)i;
    let_fail(0, 0);
    check_ok(create(&b, &gpu, message, sizeof message));
    for (int i = 0; i < 5; i++) {
        check_ok(mspring_network_set(b.network, MSPRING_SIGNAL, NULL, 0, b.actuator_count, signals, 1));
        check_action(gpu, &b, step, signals);
        check_ok(mspring_network_step(b.network, b.dt));
        batch_check_equal(&b, gpu);
        check_action(gpu, &b, observe, signals);
        check_action(gpu, &b, read_all, signals);
        batch_check_equal(&b, gpu);
    }
    check_action(gpu, &b, reset, signals);
    check_ok(mspring_network_reset_groups(b.network, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
    batch_check_equal(&b, gpu);
    mspring_gpu_destroy(gpu);
    assert_int_equal(live(), 0);
    batch_destroy(&b);
}

static void check_refused(const batch *b, cl_device_info what, cl_ulong value, const char *why) {
    mspring_gpu *gpu = NULL;
    char message[1024] = "", text[4096];
    report(what, value);
    check_error(create(b, &gpu, message, sizeof message), MSPRING_ERROR_DEVICE);
    check_contains(message, why);
    check_ok(mspring_gpu_describe_devices(FAILING_OPENCL, text, sizeof text));
    check_contains(text, why);
    report(0, 0);
}

static void inexact_devices(void **state) {
    (void)state;
    batch b = small_batch();
    const cl_ulong good = CL_FP_DENORM | CL_FP_INF_NAN | CL_FP_ROUND_TO_NEAREST | CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    check_refused(&b, CL_DEVICE_SINGLE_FP_CONFIG, good & ~(cl_ulong)CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT,
                  "division and root are not correctly rounded");
    check_refused(&b, CL_DEVICE_SINGLE_FP_CONFIG, good & ~(cl_ulong)CL_FP_DENORM, "flushes subnormal numbers");
    check_refused(&b, CL_DEVICE_DOUBLE_FP_CONFIG, 0, "no double precision");
    check_refused(&b, CL_DEVICE_AVAILABLE, 0, "isn't available");
    check_refused(&b, CL_DEVICE_COMPILER_AVAILABLE, 0, "no compiler");
    batch_destroy(&b);
}

static void little_local_memory(void **state) {
    (void)state;
    batch b = small_batch();
    mspring_gpu *gpu = NULL;
    char message[1024] = "";
    report(CL_DEVICE_LOCAL_MEM_SIZE, 100);
    check_error(create(&b, &gpu, message, sizeof message), MSPRING_ERROR_LIMIT);
    check_contains(message, "local memory");
    report(0, 0);
    assert_int_equal(live(), 0);
    batch_destroy(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(creating), cmocka_unit_test(acting),
                                       cmocka_unit_test(inexact_devices), cmocka_unit_test(little_local_memory)};
    batch_need_device();
    void *const library = dlopen(FAILING_OPENCL, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        print_error("%s\n", dlerror());
        return 1;
    }
    find(library, "failing_opencl_fail", &let_fail);
    find(library, "failing_opencl_calls", &calls);
    find(library, "failing_opencl_live", &live);
    find(library, "failing_opencl_report", &report);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
