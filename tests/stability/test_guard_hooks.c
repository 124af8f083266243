/// @file test_guard_hooks.c
/// Hooks that write to the state in the middle of a step what no state may be: the step is refused, whatever
/// follows in it, and everything is as before.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)
enum { SUBSTEPS = 3 };

/// What a hook writes, in which of the substeps from the next on.
typedef struct writing {
    int array; ///< x, y, vx, vy; or force_x, force_y
    float value;
    mspring_id particle;
    uint32_t substep;
    uint32_t calls;
} writing;

static void write(const mspring_hook_args *args, void *user) {
    writing *what = user;
    float *const state[] = {args->x, args->y, args->vx, args->vy}, *const forces[] = {args->force_x, args->force_y};
    float *const array = args->force_x ? forces[what->array % 2] : state[what->array];
    if (what->calls++ != what->substep) {
        return;
    }
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->particle_of_slot[slot] == what->particle) {
            array[slot] = what->value;
        }
    }
}

static mspring_network *make(const recipe *made, mspring_solver solver, uint32_t substeps, mspring_guard guard) {
    mspring_network_def def = support_def(-9.8f, substeps);
    def.settings.solver = solver;
    def.settings.guard = guard;
    mspring_network *network = recipe_network(made, &def);
    support_steps(network, 3, DT); // so that the guard knows what was
    return network;
}

typedef struct way {
    const char *name;
    mspring_solver solver;
    mspring_guard guard;
} way;

static const way ways[] = {{"growth", MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_GROWTH},
                           {"bounds", MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_BOUNDS},
                           {"retry", MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_RETRY},
                           {"fallback", MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_IMPLICIT},
                           {"clamp", MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_CLAMP},
                           {"put back", MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_CLAMP_BOUNDS},
                           {"put back, implicit", MSPRING_SOLVER_IMPLICIT, MSPRING_GUARD_CLAMP_BOUNDS},
                           {"put back, direct", MSPRING_SOLVER_DIRECT, MSPRING_GUARD_CLAMP_BOUNDS},
                           {"implicit", MSPRING_SOLVER_IMPLICIT, MSPRING_GUARD_GROWTH},
                           {"direct", MSPRING_SOLVER_DIRECT, MSPRING_GUARD_GROWTH}};

/// A policy that tries again calls hooks again, which then write nothing; one puts back what they wrote.
static bool takes_it(const way *how) {
    return how->guard == MSPRING_GUARD_RETRY || how->guard == MSPRING_GUARD_IMPLICIT ||
           how->guard == MSPRING_GUARD_CLAMP || how->guard == MSPRING_GUARD_CLAMP_BOUNDS;
}

static void check_write(const recipe *made, const way *how, mspring_phase phase, writing what, uint32_t substeps) {
    mspring_network *network = make(made, how->solver, substeps, how->guard);
    mspring_network *twin = make(made, how->solver, substeps, how->guard);
    writing nothing = {.substep = UINT32_MAX};
    check_ok(support_add_hook(network, phase, write, &what, NULL));
    check_ok(support_add_hook(twin, phase, write, &nothing, NULL));
    const uint64_t before = support_hash(network);
    const mspring_result result = mspring_network_step(network, DT);
    if (result != (takes_it(how) ? MSPRING_OK : MSPRING_ERROR_UNSTABLE)) {
        print_error("%s, phase %d, %g into array %d after substep %u of %u: %d\n", how->name, (int)phase,
                    (double)what.value, what.array, (unsigned)what.substep, (unsigned)substeps, (int)result);
        fail();
    }
    for (mspring_id p = 0; p < made->particle_count; p++) {
        const support_point is = support_position(network, p), moves = support_velocity(network, p);
        assert_true(isfinite(is.x) && isfinite(is.y) && fabs(moves.x) < 1e9 && fabs(moves.y) < 1e9);
    }
    if (result == MSPRING_ERROR_UNSTABLE) {
        assert_int_equal(support_hash(network), before);
        assert_true(mspring_network_error(network)[0] != 0);
        // It goes on as if that had never been tried.
        for (int step = 0; step < 5; step++) {
            support_steps(network, 1, DT);
            support_steps(twin, 1, DT);
            assert_int_equal(support_hash(network), support_hash(twin));
        }
    }
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

/// Everywhere: at a free particle of a lattice, of a rope and of none, and at a pinned one.
static void what_hooks_write_is_seen(void **state) {
    (void)state;
    const float values[] = {NAN, INFINITY, -INFINITY, 1e30f, -2e12f};
    recipe made = recipe_mixed(3);
    const mspring_id particles[] = {3, made.particle_count / 2, made.particle_count - 1};
    uint32_t cases = 0;
    for (size_t w = 0; w < COUNT_OF(ways); w++) {
        for (size_t i = 0; i < 4 * COUNT_OF(values); i++) {
            const writing what = {.array = (int)(i % 4),
                                  .value = values[i / 4],
                                  .particle = particles[(i + w) % COUNT_OF(particles)],
                                  .substep = (uint32_t)(i + w) % SUBSTEPS};
            if (fabsf(what.value) < 1e15f && what.array > 1) {
                continue; // a speed that may be
            }
            check_write(&made, &ways[w], MSPRING_PHASE_AFTER_SUBSTEP, what, SUBSTEPS);
            writing at_once = what;
            at_once.substep = 0;
            check_write(&made, &ways[w], MSPRING_PHASE_AFTER_SUBSTEP, at_once, 1);
            cases += 2;
        }
    }
    print_message("%u cases\n", cases);
    recipe_free(&made);
}

/// The same with forces on a particle that is free.
static void what_forces_do_is_seen(void **state) {
    (void)state;
    const float values[] = {NAN, INFINITY, -INFINITY, 3e38f};
    recipe made = recipe_mixed(3);
    mspring_id one = 0;
    while (made.particles[one].flags & MSPRING_PARTICLE_PINNED) {
        one++;
    }
    for (size_t w = 0; w < COUNT_OF(ways); w++) {
        for (size_t i = 0; i < 2 * COUNT_OF(values); i++) {
            writing what = {.array = (int)(i % 2), .value = values[i / 2], .particle = one};
            check_write(&made, &ways[w], MSPRING_PHASE_BEFORE_STEP, what, SUBSTEPS);
            what.substep = (uint32_t)i % SUBSTEPS;
            check_write(&made, &ways[w], MSPRING_PHASE_BEFORE_SUBSTEP, what, SUBSTEPS);
        }
    }
    recipe_free(&made);
}

/// Workers share the look at a large network, and see what is written to either coordinate in any of their parts.
static void workers_see_what_hooks_write(void **state) {
    (void)state;
    recipe made = recipe_bar(700, 50, 1);
    mspring_network_def def = support_def(0, 1);
    def.worker_count = 3;
    mspring_network *network = recipe_network(&made, &def);
    for (int i = 0; i < 12; i++) {
        writing what = {.array = i % 4,
                        .value = i % 4 < 2 ? 2e12f : 1e30f,
                        .particle = made.particle_count / 3 * (uint32_t)(i / 4) + 600};
        uint32_t hook;
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, write, &what, &hook));
        check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
        check_ok(mspring_network_remove_hook(network, hook));
        support_steps(network, 1, DT);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void look_on(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

/// Steps until the growth of one corner is refused.
static uint32_t steps_until_refused(const recipe *made, uint32_t workers, double share) {
    mspring_network_def def = support_def(0, 1);
    def.worker_count = workers;
    mspring_network *network = recipe_network(made, &def);
    const float vx = 1e-3f, vy = 2e-3f;
    double border;
    uint32_t steps = 0;
    check_ok(mspring_network_set_velocities(network, NULL, made->particle_count * 3 / 5, 1, &vx, &vy, 1));
    check_ok(mspring_network_get_stable_dt(network, &border, NULL));
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, look_on, NULL, NULL));
    while (steps < 300 && mspring_network_step(network, share * border) == MSPRING_OK)
        steps++;
    mspring_network_destroy(network);
    return steps;
}

/// Growth is seen in the same step, however many look for it.
static void workers_see_growth_at_once(void **state) {
    (void)state;
    recipe made = recipe_bar(700, 50, 1);
    const uint32_t alone = steps_until_refused(&made, 1, 1.05);
    print_message("refused in step %u\n", (unsigned)alone);
    assert_true(alone > 5 && alone < 300);
    assert_int_equal(steps_until_refused(&made, 3, 1.05), alone);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_hooks_write_is_seen),
        cmocka_unit_test(what_forces_do_is_seen),
        cmocka_unit_test(workers_see_what_hooks_write),
        cmocka_unit_test(workers_see_growth_at_once),
    };
    return cmocka_run_group_tests_name("guard_hooks", tests, NULL, NULL);
}
