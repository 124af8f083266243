/// @file test_shares.c
/// Lattices that workers divide among each other: what lies at the borders has the same bits as anywhere.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "network/network.h"
#include "recipe.h"
#include "support.h"

static const uint32_t worker_counts[] = {2, 3, 5, 8};

/// How a lattice is stepped.
typedef struct way {
    const char *name;
    uint32_t substeps, period; ///< of a hook after substeps; 0: none
    bool undamped, held, ropes, wide;
} way;

static const way ways[] = {
    {.name = "plain", .substeps = 40},
    {.name = "without dampers", .substeps = 23, .undamped = true},
    {.name = "under a force", .substeps = 17, .held = true},
    {.name = "with ropes", .substeps = 20, .ropes = true},
    {.name = "hook after every substep", .substeps = 10, .period = 1},
    {.name = "hook after every third", .substeps = 11, .period = 3, .ropes = true, .held = true},
    {.name = "few long rows", .substeps = 12, .wide = true},
};

static recipe lattice(const way *w) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 2},
                                .stiffness = {200, 400},
                                .damping = {0, w->undamped ? 0 : 1},
                                .pinned = 0.01,
                                .holes = 0.15};
    recipe made = {0};
    const uint32_t width = w->wide ? 1500 : 90;
    recipe_lattice(&made, width, w->wide ? 16 : 200, 0, 0, 1, &stuff, &seed);
    // Ropes between neighbouring rows: some strips away, so that passes stay deep.
    for (mspring_id p = 40; w->ropes && p < 15000; p += 1111)
        recipe_rope(&made, p, p + 3 * width, 9, &stuff, &seed);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

static void hook(const mspring_hook_args *args, void *user) {
    (void)args, (void)user;
}

static uint64_t run(const recipe *made, const way *w, uint32_t worker_count) {
    mspring_network_def def = support_def(-9.8f, w->substeps);
    def.worker_count = worker_count;
    mspring_network *network = recipe_network(made, &def);
    assert_int_equal(network->seams.count > 0, worker_count > 1);
    if (w->period > 0) {
        mspring_hook_def hooked;
        check_ok(mspring_hook_def_init(&hooked, sizeof hooked));
        hooked.phase = MSPRING_PHASE_AFTER_SUBSTEP;
        hooked.fn = hook;
        hooked.period = w->period;
        check_ok(mspring_network_add_hook(network, &hooked, NULL));
    }
    uint64_t hash = 0;
    for (int step = 0; step < 3; step++) {
        for (mspring_id p = 0; w->held && p < 6000; p += 7)
            check_ok(mspring_network_apply_force(network, p, 5, 10));
        support_steps(network, 1, 0.01);
        hash = hash * 31 + support_hash(network);
    }
    mspring_network_destroy(network);
    return hash;
}

static void any_division_gives_the_same_bits(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        recipe made = lattice(&ways[i]);
        const uint64_t expected = run(&made, &ways[i], 1);
        for (size_t w = 0; w < COUNT_OF(worker_counts); w++)
            if (run(&made, &ways[i], worker_counts[w]) != expected)
                fail_msg("%s: other bits with %u workers", ways[i].name, (unsigned)worker_counts[w]);
        recipe_free(&made);
    }
}

/// Four squares in the same rows, of which two fall asleep.
static uint64_t run_sleepers(uint32_t worker_count) {
    uint64_t seed = 6, hash = 0;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {200, 200}, .damping = {1, 1}};
    recipe made = {0};
    for (int i = 0; i < 4; i++)
        recipe_lattice(&made, 60, 60, 100 * i, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(0, 10);
    def.worker_count = worker_count;
    def.sleep_speed = 1e-3f;
    def.sleep_time = 0.02f;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    assert_int_equal(network->seams.count > 0, worker_count > 1);
    support_kick(network, 30 * 60 + 30, 3);
    support_kick(network, 2 * 3600 + 59 * 60 + 7, 3);
    for (int step = 0; step < 8; step++) {
        support_steps(network, 1, 0.01);
        hash = hash * 31 + support_hash(network);
    }
    assert_true(support_sleeps(network, 3600) && !support_sleeps(network, 0));
    mspring_network_destroy(network);
    return hash;
}

static void what_sleeps_beside_gives_the_same_bits(void **state) {
    (void)state;
    const uint64_t expected = run_sleepers(1);
    for (size_t w = 0; w < COUNT_OF(worker_counts); w++)
        assert_int_equal(run_sleepers(worker_counts[w]), expected);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_division_gives_the_same_bits),
        cmocka_unit_test(what_sleeps_beside_gives_the_same_bits),
    };
    return cmocka_run_group_tests_name("shares", tests, NULL, NULL);
}
