/// @file test_drift.c
/// What rounding may do to motion that nothing damps: gravity at any number of substeps, the energy of stiff
/// bodies, and speeds ahead of a front.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "recipe.h"
#include "support.h"

/// Ten seconds of free fall of two masses on a spring. Leapfrog has v = -g t exactly, for half a substep ago.
static double fall_error(uint32_t flags, uint32_t substeps) {
    const double seconds = 10, dt = 1.0 / 60;
    recipe made = {0};
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {100, 100}};
    uint64_t seed = 1;
    recipe_lattice(&made, 2, 1, 0, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(-9.8f, substeps);
    def.flags = flags;
    mspring_network *network = recipe_network(&made, &def);
    support_steps(network, (uint32_t)(seconds / dt + 0.5), dt);
    const double time = seconds - 0.5 * dt / substeps;
    const double error = support_velocity(network, 0).y / (-(double)9.8f * time) - 1;
    mspring_network_destroy(network);
    recipe_free(&made);
    return fabs(error);
}

static void precise_gravity_is_not_rounded_away(void **state) {
    (void)state;
    for (uint32_t substeps = 1; substeps <= 8192; substeps *= 8) {
        const double error = fall_error(MSPRING_NETWORK_PRECISE, substeps);
        print_message("%u substeps a second: off by %.1e\n", (unsigned)(60 * substeps), error);
        assert_true(error < 1e-6); // of the length of a substep, 6e-8, and of the last position
    }
}

/// Kinetic and elastic energy of a free bar after a minute, as a multiple of that at first.
static double growth(double stiffness, double off, float speed) {
    const recipe_stuff stuff = {.mass = {10, 10}, .stiffness = {stiffness, stiffness}};
    recipe made = {0};
    uint64_t seed = 3;
    recipe_lattice(&made, 20, 4, off, 0, 1, &stuff, &seed);
    for (uint32_t p = 0; p < made.particle_count; p++) {
        made.particles[p].vx = (float)support_random_between(&seed, -1e-3, 1e-3) + speed;
        made.particles[p].vy = (float)support_random_between(&seed, -1e-3, 1e-3);
    }
    if (off > 0)
        recipe_particle(&made, -off, 0, 1, MSPRING_PARTICLE_PINNED); // keeps the local origin away
    mspring_network_def def = support_def(0, MSPRING_SUBSTEPS_AUTO);
    def.flags = MSPRING_NETWORK_PRECISE;
    mspring_network *network = recipe_network(&made, &def);
    double kinetic, elastic, px, py, before = 0;
    const double mass = 10.0 * 80;
    for (int end = 0; end < 2; end++) {
        check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
        check_ok(support_get_momentum(network, &px, &py, NULL));
        const double inner = kinetic + elastic - 0.5 * (px * px + py * py) / mass;
        if (end == 0) {
            before = inner;
            support_steps(network, 64 * 60, 1.0 / 64);
        } else {
            before = inner / before;
        }
    }
    mspring_network_destroy(network);
    recipe_free(&made);
    return before;
}

/// With a single word for lengths and velocities, the last ones grew by 1e4 to 1e5 within a minute.
static void precise_bodies_do_not_heat(void **state) {
    (void)state;
    const struct {
        double stiffness, off;
        float speed;
    } cases[] = {{1e5, 0, 0}, {1e7, 0, 0}, {1e9, 0, 0}, {1e9, 300, 0}, {1e7, 0, 10}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const double times = growth(cases[i].stiffness, cases[i].off, cases[i].speed);
        print_message("%g N/m, %g m off, at %g m/s: energy times %.3f in a minute\n", cases[i].stiffness,
                      cases[i].off, (double)cases[i].speed, times);
        assert_true(times > 0.5 && times < 2);
    }
}

/// Dampers pass on a small part of a motion at once. Speeds ahead of the front must not become subnormal, which
/// slows arithmetic down.
static void no_speed_is_subnormal(void **state) {
    (void)state;
    const recipe_stuff stuff = {.mass = {100, 100}, .stiffness = {1e8, 1e8}, .damping = {4e3, 4e3}};
    for (uint32_t flags = 0; flags <= MSPRING_NETWORK_PRECISE; flags += MSPRING_NETWORK_PRECISE)
        for (uint32_t substeps = 39; substeps <= 40; substeps++) {
            recipe made = {0};
            uint64_t seed = 1;
            recipe_lattice(&made, 200, 20, 0, 0, 1, &stuff, &seed);
            made.particles[0].vx = 10;
            mspring_network_def def = support_def(0, substeps);
            def.flags = flags;
            def.settings.guard = MSPRING_GUARD_BOUNDS;
            mspring_network *network = recipe_network(&made, &def);
            uint32_t moving = 0;
            for (int step = 0; step < 4; step++) {
                check_ok(mspring_network_step(network, 1.0 / 64));
                for (uint32_t p = 0; p < made.particle_count; p++) {
                    const support_point v = support_velocity(network, p);
                    moving += v.x != 0;
                    assert_true(v.x == 0 || fabs(v.x) >= (double)FLT_MIN);
                    assert_true(v.y == 0 || fabs(v.y) >= (double)FLT_MIN);
                }
            }
            assert_true(moving > 100);
            mspring_network_destroy(network);
            recipe_free(&made);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(precise_gravity_is_not_rounded_away),
        cmocka_unit_test(precise_bodies_do_not_heat),
        cmocka_unit_test(no_speed_is_subnormal),
    };
    return cmocka_run_group_tests_name("drift", tests, NULL, NULL);
}
