/// @file test_article.c
/// The bar of "Adventures with 2D Mass-Spring Networks, Part I": 80 x 5 particles, pinned at the left end, hanging
/// far out of shape under its own weight. Stretched springs stiffen it across, so its border is not that of the bar
/// at rest.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

enum { COLUMNS = 80, ROWS = 5, PROBE = COLUMNS * ROWS - 1 };
static const double mass = 73.3975;

/// What is left of a velocity after a step, in the article's program. It brakes first and then adds F / m dt, while
/// this library adds F / m times the integral of the braking: the same motion with all forces multiplied by scale().
static const double retention = 0.96968;

static double scale(void) {
    return -log(retention) / (1 - retention);
}

static mspring_network *bar(double stiffness, double damping, double dt) {
    uint64_t seed = 8;
    const double k = stiffness * scale(), c = damping * scale();
    const recipe_stuff stuff = {.mass = {mass, mass}, .stiffness = {k, k}, .damping = {c, c}};
    recipe made = {0};
    recipe_lattice(&made, COLUMNS, ROWS, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 0; row < ROWS; row++) {
        made.particles[row * COLUMNS].flags = MSPRING_PARTICLE_PINNED;
    }
    mspring_network_def def = support_def((float)(-9.8 * scale()), 1);
    def.settings.global_damping = (float)(-log(retention) / dt);
    def.settings.guard = MSPRING_GUARD_BOUNDS; // to see what it does
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

/// Kinetic energy after a minute, or infinity if the bar explodes before.
static double energy_after_a_minute(mspring_network *network, double dt) {
    const uint32_t steps = (uint32_t)(60 / dt);
    for (uint32_t step = 0; step < steps; step++) {
        mspring_result result = mspring_network_step(network, dt);
        if (result == MSPRING_ERROR_UNSTABLE) {
            return INFINITY;
        }
        check_ok(result);
    }
    double kinetic = NAN;
    check_ok(support_get_energy(network, &kinetic, NULL, NULL));
    return kinetic;
}

/// Above these an independent program, in double precision, found motion that does not die away.
static const struct {
    double dt, damping, stiffness;
} borders[] = {{1.0 / 64, 55.05, 125110}, {1.0 / 64, 0, 132730}, {0.006198, 55.05, 938550}, {0.006198, 0, 956200}};

static void the_hanging_bar_has_the_known_borders(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(borders); i++) {
        const double dt = borders[i].dt;
        // 2 % below it comes to rest, and the stable dt of the shape in which it hangs is just above the step; that
        // of the bar at rest is far above it.
        mspring_network *network = bar(0.98 * borders[i].stiffness, borders[i].damping, dt);
        double at_rest = 0, hanging = 0;
        check_ok(mspring_network_get_stable_dt(network, &at_rest, NULL));
        const double calm = energy_after_a_minute(network, dt);
        check_ok(mspring_network_get_stable_dt(network, &hanging, NULL));
        mspring_network_destroy(network);
        // 2 % above, the bar trembles for ever or explodes.
        network = bar(1.02 * borders[i].stiffness, borders[i].damping, dt);
        const double trembling = energy_after_a_minute(network, dt);
        mspring_network_destroy(network);
        print_message(
            "dt %.6f s, k_d %5.2f: border at rest %.6f s, hanging at 0.98 k %.6f s; kinetic energy after a "
            "minute %.3g J, at 1.02 k %.3g J\n",
            dt, borders[i].damping, at_rest, hanging, calm, trembling);
        assert_true(trembling > 20 * calm);
        // k is 2 % below its border, so dt is 1 %, and the eigenvalue is within 0.3 %.
        check_near(dt / hanging, 0.993, 0.005);
        assert_true(at_rest > 1.01 * hanging);
    }
}

static void beyond_the_known_ends_it_explodes(void **state) {
    (void)state;
    // The same program's bar stayed finite for a minute up to these; here it explodes from them on.
    const struct { double damping, stiffness; } ends[] = {{55.05, 128300}, {0, 133740}};
    for (size_t i = 0; i < COUNT_OF(ends); i++) {
        mspring_network *network = bar(0.98 * ends[i].stiffness, ends[i].damping, 1.0 / 64);
        assert_true(energy_after_a_minute(network, 1.0 / 64) < INFINITY);
        mspring_network_destroy(network);
        network = bar(1.02 * ends[i].stiffness, ends[i].damping, 1.0 / 64);
        assert_true(energy_after_a_minute(network, 1.0 / 64) == INFINITY);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hanging_bar_has_the_known_borders),
        cmocka_unit_test(beyond_the_known_ends_it_explodes),
    };
    return cmocka_run_group_tests_name("article", tests, NULL, NULL);
}
