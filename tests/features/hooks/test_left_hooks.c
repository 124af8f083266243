/// @file test_left_hooks.c
/// A hook must return. If one is left by longjmp() all the same, the network can be destroyed, and calls that would
/// change it are refused.
///
/// SPDX-License-Identifier: MIT
#include <setjmp.h>

#include "recipe.h"
#include "support.h"

static jmp_buf out;

static void leave(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
    longjmp(out, 1); // NOLINT(cert-err52-c)
}

static void step_and_leave(mspring_network *network) {
    if (setjmp(out) == 0) {
        (void)!mspring_network_step(network, 0.01);
        fail();
    }
}

static void leave_and_destroy(mspring_phase phase, uint32_t workers) {
    const mspring_id first = 0;
    const float value = 1;
    recipe made = recipe_mixed(3);
    mspring_network_def def = support_def(-9.8f, 2);
    def.worker_count = workers;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    check_ok(support_add_hook(network, phase, leave, NULL, NULL));
    step_and_leave(network);
    for (int i = 0; i < 2; i++) {
        check_error(mspring_network_step(network, 0.01), MSPRING_ERROR_BUSY);
        check_error(mspring_network_break_springs(network, &first, 0, 1), MSPRING_ERROR_BUSY);
        check_error(mspring_network_set_velocities(network, NULL, 0, 1, &value, &value, 1), MSPRING_ERROR_BUSY);
        check_error(mspring_network_load(network, &value, sizeof value), MSPRING_ERROR_BUSY);
        check_error(mspring_network_compact(network), MSPRING_ERROR_BUSY);
        check_contains(mspring_network_error(network), "hook");
    }
    mspring_network_destroy(network);
}

static void a_network_is_destroyed_after_it(void **state) {
    (void)state;
    for (mspring_phase phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP; phase++)
        for (uint32_t workers = 1; workers <= 3; workers++)
            leave_and_destroy(phase, workers);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_network_is_destroyed_after_it)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
