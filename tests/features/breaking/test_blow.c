/// @file test_blow.c
/// A blow that breaks springs breaks the same ones, whatever the solver and the substeps.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "recipe.h"
#include "support.h"

/// Hit a bar of 1 kg particles, k = 10,000 N/m, that hangs from its left end, and see what breaks within a second.
static uint32_t broken_by_a_blow(mspring_solver solver, uint32_t substeps, bool *is_broken,
                                 uint32_t *spring_count) {
    uint64_t seed = 9;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {10000, 10000}, .damping = {20, 20}};
    recipe made = {0};
    recipe_lattice(&made, 40, 10, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 0; row < 10; row++) {
        made.particles[40 * row].flags = MSPRING_PARTICLE_PINNED;
    }
    // The blow: 60 m/s upwards, for the particles within 3 m of one on the lower edge.
    for (mspring_id p = 0; p < made.particle_count; p++) {
        const double distance = hypot(made.particles[p].x - 22, made.particles[p].y);
        made.particles[p].vy = distance < 3 ? 60.0f : 0.0f;
    }
    mspring_network_def def = support_def(-9.8f, substeps);
    def.settings.solver = solver;
    mspring_network *network = recipe_network(&made, &def);
    float *limits = malloc(made.spring_count * sizeof *limits);
    assert_non_null(limits);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        limits[s] = 0.1f;
    }
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, made.spring_count, limits, 1));
    support_steps(network, 64, 1.0 / 64);
    uint32_t broken = 0;
    for (mspring_id s = 0; s < made.spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        is_broken[s] = info.flags & MSPRING_SPRING_BROKEN;
        broken += is_broken[s];
    }
    *spring_count = made.spring_count;
    mspring_network_destroy(network);
    free(limits);
    recipe_free(&made);
    return broken;
}

static void the_same_blow_breaks_the_same_springs_at_any_substeps(void **state) {
    (void)state;
    static bool at_40[2000], at_other[2000];
    uint32_t springs;
    const uint32_t broken = broken_by_a_blow(MSPRING_SOLVER_EXPLICIT, 40, at_40, &springs);
    assert_true(springs <= COUNT_OF(at_40) && broken > 40 && broken < springs / 2);
    // A blow that is over in some milliseconds: implicit substeps must follow it, too.
    const struct {
        mspring_solver solver;
        uint32_t substeps;
    } others[] = {{MSPRING_SOLVER_EXPLICIT, 20},
                  {MSPRING_SOLVER_EXPLICIT, 120},
                  {MSPRING_SOLVER_IMPLICIT, 20},
                  {MSPRING_SOLVER_DIRECT, 20}};
    for (size_t i = 0; i < COUNT_OF(others); i++) {
        const uint32_t other = broken_by_a_blow(others[i].solver, others[i].substeps, at_other, &springs);
        uint32_t different = 0;
        for (uint32_t s = 0; s < springs; s++) {
            different += at_40[s] != at_other[s];
        }
        // Measured: 75 and 71 instead of 73, 4 and 12 of them others, and implicit 68, 15 others; a crack that goes
        // one way or the other decides.
        assert_true(10 * abs((int)other - (int)broken) <= (int)broken);
        assert_true(4 * different <= broken);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_blow_breaks_the_same_springs_at_any_substeps),
    };
    return cmocka_run_group_tests_name("blow", tests, NULL, NULL);
}
