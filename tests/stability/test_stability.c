/// @file test_stability.c
/// The explicit limit of a full lattice, and relative stiffness, which is measured in it.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

/// A full lattice of 24 x 24 equal particles and springs, a little disturbed, nothing pinned, no gravity.
static recipe full_lattice(double mass, double stiffness, double damping, uint32_t flags) {
    uint64_t seed = 8;
    const recipe_stuff stuff = {.mass = {mass, mass},
                                .stiffness = {stiffness, stiffness},
                                .damping = {damping, damping},
                                .spring_flags = flags};
    recipe made = {0};
    recipe_lattice(&made, 24, 24, 0, 0, 1, &stuff, &seed);
    // So little that the lattice stays linear, so much that it is far above rounding.
    recipe_disturb(&made, 1e-4, 0, &seed);
    return made;
}

/// Fastest particle after this many substeps, or infinity if the network explodes.
static double speed_after(mspring_network *network, uint32_t steps, double dt) {
    for (uint32_t step = 0; step < steps; step++) {
        mspring_result result = mspring_network_step(network, dt);
        if (result == MSPRING_ERROR_UNSTABLE) {
            return INFINITY;
        }
        check_ok(result);
    }
    double fastest = 0;
    for (mspring_id id = 0; id < mspring_network_count(network, MSPRING_PARTICLES); id++) {
        support_point v = support_velocity(network, id);
        fastest = fmax(fastest, hypot(v.x, v.y));
    }
    return fastest;
}

enum { STEPS = 2000 };
static const double dt = 1.0 / 64;
static const double mass = 73.3975;

/// The springs' own speed for a disturbance of 1e-4 m at the limit: half the square root of 8 k / m, in m/s.
static const double calm = 1e-4 * 2 * 64;

static void full_lattice_is_stable_up_to_the_limit(void **state) {
    (void)state;
    // omega_max^2 = 8 k / m in an endless lattice: k < m / (2 dt^2). In one of 24 x 24 the fastest mode is slower
    // by about (pi / 24)^2 / 4, half a percent, so a few percent on both sides decide.
    const double limit = mass / (2 * dt * dt);
    const struct {
        double share;
        bool stable;
    } cases[] = {{0.5, true}, {0.97, true}, {1.03, false}, {1.2, false}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        recipe made = full_lattice(mass, cases[i].share * limit, 0, 0);
        mspring_network_def def = support_def(0, 1);
        mspring_network *network = recipe_network(&made, &def);
        double speed = speed_after(network, STEPS, dt);
        if (cases[i].stable) {
            // Near the limit a mode swings 1 / sqrt(1 - share) times as far as it was pushed: 6 at 0.97; and a
            // particle's fastest is a sum over modes.
            assert_true(speed < 20 * calm);
        } else {
            // At 1.03 the fastest mode grows by at least 1 + sqrt(0.02) in a substep.
            assert_true(speed > 1e3 * calm);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void the_articles_bar_explodes_and_is_cured(void **state) {
    (void)state;
    // The article's numbers, for a bar of 80 x 5 that hangs from its left end. The limit of a lattice at rest is
    // 150,318 N/m at 1/64 s and 955,300 at 0.006198 s; as the bar falls and whips, its springs are stretched, which
    // stiffens them sideways, and 139,000 is too much already.
    const struct {
        float stiffness;
        double dt;
        bool stable;
    } cases[] = {{36700, 1.0 / 64, true}, {139000, 1.0 / 64, false}, {229376, 0.006198, true}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        uint64_t seed = 8;
        const double k = (double)cases[i].stiffness;
        const recipe_stuff stuff = {.mass = {mass, mass}, .stiffness = {k, k}, .damping = {55.05, 55.05}};
        recipe made = {0};
        recipe_lattice(&made, 80, 5, 0, 0, 1, &stuff, &seed);
        for (uint32_t row = 0; row < 5; row++) {
            made.particles[row * 80].flags = MSPRING_PARTICLE_PINNED;
        }
        mspring_network_def def = support_def(-9.8f, 1);
        mspring_network *network = recipe_network(&made, &def);
        double speed = speed_after(network, (uint32_t)(60 / cases[i].dt), cases[i].dt);
        // Falling by its own length of 80 m gives it 40 m/s, and the tip of a whip some times that.
        assert_true(cases[i].stable ? speed < 200 : speed > 1e4);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void relative_stiffness_is_a_share_of_the_limit(void **state) {
    (void)state;
    const double shares[] = {0.5, 0.97, 1.03};
    for (size_t i = 0; i < COUNT_OF(shares); i++) {
        // Whatever the masses, the step and the substeps.
        recipe made = full_lattice(0.37, shares[i], 0, MSPRING_SPRING_RELATIVE);
        mspring_network_def def = support_def(0, 7);
        mspring_network *network = recipe_network(&made, &def);
        double h = 0.0371 / 7, speed = speed_after(network, STEPS / 7, 0.0371);
        double calm_here = 1e-4 * 2 / h;
        assert_true(shares[i] < 1 ? speed < 20 * calm_here : speed > 1e3 * calm_here);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/* ------------------------------------------------------------------------------------------------- relative */

static recipe relative_recipe(uint32_t flags, double h) {
    uint64_t seed = 31;
    const recipe_stuff stuff = {.mass = {1, 5}, .pinned = 0.03, .holes = 0.15};
    recipe made = {0};
    recipe_lattice(&made, 21, 9, 0, 0, 1, &stuff, &seed);
    mspring_id end = recipe_particle(&made, 30, 15, 2, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 0, end, 11, &stuff, &seed);
    recipe_random_springs(&made, 6, &stuff, &seed);
    for (uint32_t i = 0; i < made.spring_count; i++) {
        mspring_spring_def *spring = &made.springs[i];
        double stiffness = support_random_between(&seed, 0.05, 0.4);
        double damping = support_random_between(&seed, 0, 0.05);
        if (flags == 0) {
            double ma = (double)made.particles[spring->a].mass, mb = (double)made.particles[spring->b].mass;
            double mu = ma * mb / (ma + mb);
            stiffness = (double)(float)stiffness * mu / (h * h);
            damping = (double)(float)damping * mu / h;
        }
        spring->flags = flags;
        spring->stiffness = (float)stiffness;
        spring->damping = (float)damping;
    }
    recipe_disturb(&made, 0.02, 0.5, &seed);
    return made;
}

static void relative_springs_equal_the_formula(void **state) {
    (void)state;
    // Half-way through the substep changes: so does the stiffness.
    const double h[] = {1.0 / 256, 1.0 / 512};
    recipe relative = relative_recipe(MSPRING_SPRING_RELATIVE, 0);
    mspring_network_def def = support_def(-9.8f, 2);
    mspring_network *network = recipe_network(&relative, &def);
    support_spring_info info;
    double elastic;
    check_ok(support_get_spring(network, 3, &info));
    check_ok(support_get_energy(network, NULL, &elastic, NULL));
    assert_true(info.flags == MSPRING_SPRING_RELATIVE && info.stiffness == 0 && info.damping == 0);
    assert_true(elastic == 0); // no substep yet, no stiffness

    for (int i = 0; i < 2; i++) {
        recipe absolute = relative_recipe(0, h[i]);
        mspring_network *twin = recipe_network(&absolute, &def);
        double x[400], y[400];
        float vx[400], vy[400];
        const uint32_t count = relative.particle_count;
        assert_true(count <= COUNT_OF(x));
        support_steps(network, i, 2 * h[i]); // velocities are then half a substep old in both, or in none
        support_steps(twin, i, 2 * h[i]);
        check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
        check_ok(mspring_network_get_velocities(network, NULL, 0, count, vx, vy, 1));
        check_ok(mspring_network_set_positions(twin, NULL, 0, count, x, y, 1));
        check_ok(mspring_network_set_velocities(twin, NULL, 0, count, vx, vy, 1));
        support_steps(network, 50, 2 * h[i]);
        support_steps(twin, 50, 2 * h[i]);
        for (uint32_t spring = 0; spring < relative.spring_count; spring++) {
            support_spring_info expected;
            check_ok(support_get_spring(network, spring, &info));
            check_ok(support_get_spring(twin, spring, &expected));
            assert_int_equal(info.flags, MSPRING_SPRING_RELATIVE);
            assert_int_equal(expected.flags, 0);
            // The same formula, rounded to float once: half an ulp each way.
            check_near((double)info.stiffness, (double)expected.stiffness, 1.2e-7 * (double)expected.stiffness);
            check_near((double)info.damping, (double)expected.damping, 1.2e-7 * (double)expected.damping);
        }
        for (uint32_t id = 0; id < count; id++) {
            support_point a = support_position(network, id), b = support_position(twin, id);
            // Stiffnesses off by an ulp move no particle by more than a few ulp of 16 m in 100 substeps.
            check_near(a.x, b.x, 1e-4);
            check_near(a.y, b.y, 1e-4);
        }
        mspring_network_destroy(twin);
        recipe_free(&absolute);
    }
    mspring_network_destroy(network);
    recipe_free(&relative);
}

static void relative_and_absolute_springs_live_together(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 1);
    support_particle(builder, 1, 0, 3);
    support_particle(builder, 2, 0, 6);
    mspring_spring_def spring;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.a = 1;
    spring.b = 2;
    spring.stiffness = 0.25f;
    spring.damping = 0.125f;
    spring.flags = MSPRING_SPRING_RELATIVE;
    check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    support_spring(builder, 0, 1, 77, 3);
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    assert_int_equal(plan.has_relative, 1);
    assert_int_equal(plan.has_damping, 1);
    check_ok(mspring_network_step(network, 0.125));
    support_spring_info info;
    check_ok(support_get_spring(network, 0, &info));
    assert_true(info.stiffness == 0.25f * 2 * 64 && info.damping == 0.125f * 2 * 8); // mu = 2 kg
    check_ok(support_get_spring(network, 1, &info));
    assert_true(info.stiffness == 77 && info.damping == 3 && info.flags == 0);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_lattice_is_stable_up_to_the_limit),
        cmocka_unit_test(the_articles_bar_explodes_and_is_cured),
        cmocka_unit_test(relative_stiffness_is_a_share_of_the_limit),
        cmocka_unit_test(relative_springs_equal_the_formula),
        cmocka_unit_test(relative_and_absolute_springs_live_together),
    };
    return cmocka_run_group_tests_name("stability", tests, NULL, NULL);
}
