/// @file test_ladder.c
/// The attempts at a step: which follow one that fails, by each guard and budget, and what they may cost together.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <massspring/massspring.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

/* -------------------------------------------------------------------------------------------------- one step */

typedef enum failing {
    NOTHING,      ///< stable at the substeps that are set
    TOO_LONG,     ///< these are beyond the stability limit, which the guard sees before the first
    OUT_OF_BOUNDS ///< a hook throws a particle out of bounds, whatever is tried
} failing;

typedef struct rung {
    mspring_guard guard;
    failing what;
    uint32_t most_work;
    mspring_result result;
    uint32_t flags, substeps; ///< of the step; substeps that the next one begins with
    double work;              ///< in calm steps
} rung;

/// Of a lattice that takes 13 substeps at rest and 18 in any shape.
static const rung rungs[] = {
    {MSPRING_GUARD_GROWTH, NOTHING, 4, MSPRING_OK, 0, 20, 1},
    {MSPRING_GUARD_RETRY, NOTHING, 4, MSPRING_OK, 0, 20, 1},
    {MSPRING_GUARD_BOUNDS, NOTHING, 4, MSPRING_OK, 0, 20, 1},
    {MSPRING_GUARD_IMPLICIT, NOTHING, 4, MSPRING_OK, 0, 20, 1},
    {MSPRING_GUARD_CLAMP, NOTHING, 4, MSPRING_OK, 0, 20, 1},
    {MSPRING_GUARD_CLAMP_BOUNDS, NOTHING, 4, MSPRING_OK, 0, 20, 1},
    // Refused before anything is computed.
    {MSPRING_GUARD_GROWTH, TOO_LONG, 4, MSPRING_ERROR_UNSTABLE, 0, 2, 0},
    {MSPRING_GUARD_BOUNDS, TOO_LONG, 4, MSPRING_OK, 0, 2, 1},
    {MSPRING_GUARD_CLAMP_BOUNDS, TOO_LONG, 4, MSPRING_OK, 0, 2, 1},
    {MSPRING_GUARD_CLAMP, TOO_LONG, 4, MSPRING_OK, MSPRING_STEP_CLAMPED, 2, 3},
    {MSPRING_GUARD_CLAMP, TOO_LONG, 0, MSPRING_OK, MSPRING_STEP_CLAMPED, 2, 3},
    {MSPRING_GUARD_IMPLICIT, TOO_LONG, 4, MSPRING_OK, MSPRING_STEP_FALLBACK, 2, (1 + 6 / 8.0) / 2},
    {MSPRING_GUARD_RETRY, TOO_LONG, 4, MSPRING_OK, MSPRING_STEP_RETRIED, 16, 8},
    {MSPRING_GUARD_RETRY, TOO_LONG, 0, MSPRING_OK, MSPRING_STEP_RETRIED, 16, 8},
    // Substeps that end out of bounds are spent. By the fallback they end there, too.
    {MSPRING_GUARD_GROWTH, OUT_OF_BOUNDS, 4, MSPRING_ERROR_UNSTABLE, 0, 20, 1},
    {MSPRING_GUARD_BOUNDS, OUT_OF_BOUNDS, 4, MSPRING_ERROR_UNSTABLE, 0, 20, 1},
    {MSPRING_GUARD_CLAMP_BOUNDS, OUT_OF_BOUNDS, 4, MSPRING_OK, MSPRING_STEP_PUT_BACK, 20, 1},
    {MSPRING_GUARD_CLAMP, OUT_OF_BOUNDS, 4, MSPRING_ERROR_UNSTABLE, 0, 20, 4},
    {MSPRING_GUARD_IMPLICIT, OUT_OF_BOUNDS, 4, MSPRING_ERROR_UNSTABLE, 0, 20, 1 + (1 + 6 / 8.0) / 20},
    {MSPRING_GUARD_RETRY, OUT_OF_BOUNDS, 1, MSPRING_ERROR_UNSTABLE, 0, 40, 1},
    {MSPRING_GUARD_RETRY, OUT_OF_BOUNDS, 3, MSPRING_ERROR_UNSTABLE, 0, 80, 3},
    {MSPRING_GUARD_RETRY, OUT_OF_BOUNDS, 6, MSPRING_ERROR_UNSTABLE, 0, 80, 3},
    {MSPRING_GUARD_RETRY, OUT_OF_BOUNDS, 7, MSPRING_ERROR_UNSTABLE, 0, 100, 7},
    {MSPRING_GUARD_RETRY, OUT_OF_BOUNDS, 12, MSPRING_ERROR_UNSTABLE, 0, 20, 12}, // max_substeps ends it
    {MSPRING_GUARD_RETRY, OUT_OF_BOUNDS, 0, MSPRING_ERROR_UNSTABLE, 0, 20, 12},
};

static void throw_out(const mspring_hook_args *args, void *user) {
    (void)user;
    if (args->substep + 1 == args->substep_count) {
        args->vx[args->slot_of_particle[7]] = 1e9f;
    }
}

static mspring_step_info ladder_report(const mspring_network *network) {
    mspring_step_info info = {.struct_size = sizeof info};
    check_ok(mspring_network_get_step_info(network, &info));
    return info;
}

static mspring_network *lattice_with(mspring_guard guard, uint32_t substeps, uint32_t most_work,
                                     uint32_t max_substeps) {
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {3e5f, 3e5f}, .damping = {0, 0}};
    recipe made = {0};
    recipe_lattice(&made, 12, 5, 0, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(-9.8f, substeps);
    def.settings.guard = guard;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    mspring_settings solver = support_solver(network);
    solver.most_work = most_work;
    solver.max_substeps = max_substeps;
    check_ok(support_set_solver(network, &solver));
    return network;
}

static void attempts_follow_the_guard_and_the_budget(void **state) {
    (void)state;
    uint32_t wrong = 0;
    for (size_t i = 0; i < COUNT_OF(rungs); i++) {
        const rung *r = &rungs[i];
        mspring_network *network = lattice_with(r->guard, r->what == TOO_LONG ? 2 : 20, r->most_work, 100);
        if (r->what == OUT_OF_BOUNDS) {
            check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, throw_out, NULL, NULL));
        }
        const uint64_t before = support_hash(network);
        const mspring_result result = mspring_network_step(network, DT);
        const mspring_step_info info = ladder_report(network);
        const uint32_t next = support_solver(network).substeps;
        // Counts are sums of small numbers; the implicit solver's pass has 6 products and may be repeated.
        const double off = r->guard == MSPRING_GUARD_IMPLICIT && r->what != NOTHING ? 0.01 : 1e-12;
        const bool is_right = result == r->result && info.flags == r->flags && next == r->substeps &&
                              fabs(info.work - r->work) <= off &&
                              (result == MSPRING_OK || support_hash(network) == before);
        if (!is_right) {
            print_error("%u: guard %d, failing %d, most_work %u: result %d, flags %u, next %u, work %.6g\n",
                        (unsigned)i, (int)r->guard, (int)r->what, (unsigned)r->most_work, (int)result,
                        (unsigned)info.flags, (unsigned)next, info.work);
        }
        wrong += !is_right;
        mspring_network_destroy(network);
    }
    assert_int_equal(wrong, 0);
}

/// With nothing repeated, the work of each solver is 1.
static void calm_steps_are_the_unit(void **state) {
    (void)state;
    for (mspring_solver kind = MSPRING_SOLVER_EXPLICIT; kind <= MSPRING_SOLVER_DIRECT; kind++) {
        for (uint32_t substeps = 20; substeps <= 40; substeps += 20) {
            mspring_network *network = lattice_with(MSPRING_GUARD_CLAMP, substeps, 4, 100);
            mspring_settings solver = support_solver(network);
            solver.solver = kind;
            solver.residual = 0; // all iterations
            check_ok(support_set_solver(network, &solver));
            check_ok(mspring_network_step(network, DT));
            check_near(ladder_report(network).work, 1, 1e-12); // a quotient of two equal sums
            check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
            check_near(ladder_report(network).work, 0, 0);
            mspring_network_destroy(network);
        }
    }
}

/// The unit stays the same from the step that fails to those that begin with the fallback, and where stability asks
/// for more than max_substeps. (It was one substep in the first of these steps, and in those of the implicit
/// fallback.)
static void fallbacks_count_in_calm_steps(void **state) {
    (void)state;
    for (mspring_guard guard = MSPRING_GUARD_IMPLICIT; guard <= MSPRING_GUARD_CLAMP; guard++) {
        mspring_network *network = lattice_with(guard, MSPRING_SUBSTEPS_AUTO, 4, 9);
        for (int step = 0; step < 5; step++) {
            check_ok(mspring_network_step(network, DT));
            // An implicit substep, or three clamped ones, in explicit ones; the other one is repeated now and then.
            const double work = ladder_report(network).work;
            assert_true(guard == MSPRING_GUARD_CLAMP ? fabs(work - 1) <= 1e-12 : work >= 0.1 && work < 0.5);
        }
        mspring_network_destroy(network);
    }
}

/// Substeps that a step had no work left for are the first of the next one.
static void a_retry_goes_on_in_the_next_step(void **state) {
    (void)state;
    mspring_network *network = lattice_with(MSPRING_GUARD_RETRY, 1, 1, 1000);
    int refused = 0;
    while (mspring_network_step(network, DT) != MSPRING_OK) {
        check_contains(mspring_network_error(network), "most_work, 1");
        assert_true(++refused < 5);
    }
    assert_true(refused <= 1);
    assert_true(support_solver(network).substeps >= 16);
    mspring_network_destroy(network);
}

/// A number that the library chooses, or that follows from their length, is chosen anew in the next step, and nothing
/// else is said.
static void a_retry_begins_anew_where_substeps_are_chosen(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) {
        mspring_network *network = lattice_with(MSPRING_GUARD_RETRY, i == 0 ? MSPRING_SUBSTEPS_AUTO : 20, 4, 1000);
        mspring_settings solver = support_solver(network);
        solver.substep_length = i == 1 ? DT / 20 : 0;
        check_ok(support_set_solver(network, &solver));
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, throw_out, NULL, NULL));
        char before[256] = "";
        for (int step = 0; step < 2; step++) {
            check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
            const char *now = mspring_network_error(network);
            check_contains(now, "most_work, 4");
            assert_int_equal(strstr(now, "The next step begins with these") != NULL, i == 2);
            assert_true(step == 0 || (strcmp(before, now) == 0) == (i < 2));
            (void)snprintf(before, sizeof before, "%s", now);
        }
        mspring_network_destroy(network);
    }
}

static mspring_network *yielding_lattice(uint32_t workers) {
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {3e5f, 3e5f}, .damping = {0, 0}};
    recipe made = {0};
    recipe_lattice(&made, 12, 5, 0, 0, 1, &stuff, &seed);
    for (uint32_t i = 0; i < made.spring_count; i++) {
        made.springs[i].yield_strain = 0.01f;
    }
    mspring_network_def def = support_def(0, 20);
    def.settings.guard = MSPRING_GUARD_RETRY;
    def.worker_count = workers;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

/// With several workers, the first step of springs near yield is taken again by one of them. If that counted, a
/// retry would have less work left, and the step another outcome.
static void workers_do_not_change_the_work(void **state) {
    (void)state;
    mspring_step_info seen[2];
    uint64_t hashes[2];
    for (uint32_t workers = 1; workers <= 2; workers++) {
        mspring_network *network = yielding_lattice(workers);
        mspring_settings solver = support_solver(network);
        solver.most_work = 3;
        check_ok(support_set_solver(network, &solver));
        for (mspring_id p = 0; p < 60; p += 3) {
            const float vx = p % 2 ? 8.0f : -8.0f, vy = 0;
            check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
        }
        uint32_t hook;
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, throw_out, NULL, &hook));
        check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
        check_near(ladder_report(network).work, 3, 1e-12); // 1, and 2 with twice the substeps
        check_ok(mspring_network_remove_hook(network, hook));
        check_ok(mspring_network_step(network, DT));
        seen[workers - 1] = ladder_report(network);
        check_ok(mspring_network_get_state_hash(network, &hashes[workers - 1]));
        mspring_network_destroy(network);
    }
    assert_true(seen[0].work == seen[1].work && seen[0].flags == seen[1].flags);
    assert_true(hashes[0] == hashes[1]);
}

/* -------------------------------------------------------------------------------------------------- violent scenes
 */

typedef struct worst {
    double work;
    uint32_t refused, flagged;
} worst;

/// A body thrown onto a floor while it flies apart, with every guard, substeps that are set and that are chosen.
static worst play(mspring_guard guard, uint32_t substeps, uint32_t most_work, uint64_t seed) {
    mspring_network *network = lattice_with(guard, substeps, most_work, 64);
    const double plane[4] = {0, -2, 0.1, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    worst seen = {0};
    for (int step = 0; step < 120; step++) {
        for (mspring_id p = 0; step % 40 == 5 && p < 60; p += 3) {
            const float vx = (float)support_random_between(&seed, -900, 900),
                        vy = (float)support_random_between(&seed, -900, 900);
            check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
        }
        const mspring_result result = mspring_network_step(network, DT);
        const mspring_step_info info = ladder_report(network);
        seen.refused += result != MSPRING_OK;
        seen.flagged += info.flags != 0;
        seen.work = fmax(seen.work, info.work);
        assert_true(result == MSPRING_OK || result == MSPRING_ERROR_UNSTABLE);
    }
    mspring_network_destroy(network);
    return seen;
}

/// most_work calm steps and a fallback: 3 if it is clamped, 32 times most_work if it is implicit, and its last
/// pass.
static void the_worst_step_is_bounded(void **state) {
    (void)state;
    const uint32_t substeps[] = {1, 4, MSPRING_SUBSTEPS_AUTO, MSPRING_SUBSTEPS_EVEN}, budgets[] = {1, 4};
    for (mspring_guard guard = MSPRING_GUARD_GROWTH; guard <= MSPRING_GUARD_CLAMP_BOUNDS; guard++) {
        for (size_t i = 0; i < COUNT_OF(substeps) * COUNT_OF(budgets); i++) {
            const uint32_t count = substeps[i % COUNT_OF(substeps)], most = budgets[i / COUNT_OF(substeps)];
            const bool is_set = count < MSPRING_SUBSTEPS_EVEN;
            const worst seen = play(guard, count, most, 7 + i);
            print_message("guard %d, substeps %d, most_work %u: %.2f calm steps at most, %u refused, %u flagged\n",
                          (int)guard, is_set ? (int)count : 0, (unsigned)most, seen.work, (unsigned)seen.refused,
                          (unsigned)seen.flagged);
            // A retry has the substeps that are stable in any shape for a calm step, which are 18 here.
            const double calm = guard == MSPRING_GUARD_RETRY && is_set ? 18.0 / count : 1;
            const double implicit = (32 * most * (1 + 7 / 8.0) + 3 + 17) / (is_set ? count : 1);
            const double fallback = guard == MSPRING_GUARD_IMPLICIT ? implicit : 3;
            assert_true(seen.work <= most * calm + fallback);
            assert_true(guard < MSPRING_GUARD_IMPLICIT || seen.refused == 0);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------ groups */

/// However many groups go wrong in one step, the others are not held. NaN may spread to others, so these are tried,
/// too.
static void good_groups_are_not_held_for_others(void **state) {
    (void)state;
    enum { GROUPS = 40, OF_GROUP = 3 };
    for (int bad = 0; bad <= GROUPS; bad += 8) {
        mspring_builder *builder = support_builder();
        mspring_id first[GROUPS + 1];
        for (uint32_t g = 0; g < GROUPS; g++) {
            first[g] = OF_GROUP * g;
            for (uint32_t i = 0; i < OF_GROUP; i++) {
                (void)support_particle(builder, i, 3.0 * g, 1);
            }
            support_spring(builder, OF_GROUP * g, OF_GROUP * g + 1, 100, 0);
            support_spring(builder, OF_GROUP * g + 1, OF_GROUP * g + 2, 100, 0);
        }
        first[GROUPS] = GROUPS * OF_GROUP;
        mspring_network_def def = support_def(0, 4);
        def.settings.guard = MSPRING_GUARD_BOUNDS;
        mspring_network *network = support_network(builder, &def);
        check_ok(mspring_network_set_groups(network, first, GROUPS));
        for (int g = 0; g < bad; g++) {
            check_ok(mspring_network_apply_force(network, OF_GROUP * (mspring_id)(g * 7 % GROUPS), 3e38f, 0));
        }
        check_ok(mspring_network_step(network, DT));
        const mspring_step_info info = ladder_report(network);
        for (int g = 0; g < GROUPS; g++) {
            const uint32_t group = (uint32_t)(g * 7 % GROUPS);
            uint32_t flags = 0;
            check_ok(mspring_network_get_integers(network, MSPRING_GROUP_FLAGS, NULL, group, 1, &flags, 1));
            assert_int_equal((flags & MSPRING_GROUP_HELD) != 0, g < bad);
        }
        print_message("%d of %d groups go wrong: %.0f calm steps\n", bad, GROUPS, info.work);
        assert_true(info.work <= (bad == 0 ? 1 : 2 + 2.0 * GROUPS));
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(attempts_follow_the_guard_and_the_budget),
        cmocka_unit_test(calm_steps_are_the_unit),
        cmocka_unit_test(a_retry_goes_on_in_the_next_step),
        cmocka_unit_test(a_retry_begins_anew_where_substeps_are_chosen),
        cmocka_unit_test(the_worst_step_is_bounded),
        cmocka_unit_test(fallbacks_count_in_calm_steps),
        cmocka_unit_test(workers_do_not_change_the_work),
        cmocka_unit_test(good_groups_are_not_held_for_others),
    };
    return cmocka_run_group_tests_name("ladder", tests, NULL, NULL);
}
