/// @file test_stable_dt.c
/// The longest stable substep: against closed forms, and against what really grows and what does not.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

static double stable_now(mspring_network *network) {
    double now = -1, any_shape = -1;
    check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
    assert_true(any_shape <= now);
    return now;
}

/* -------------------------------------------------------------------------------------------- closed forms */

/// One particle on a spring to a pinned one.
static mspring_network *oscillator(double mass, double stiffness, double damping, float global_damping) {
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 1);
    support_particle(builder, 1, 0, (float)mass);
    support_spring(builder, 0, 1, (float)stiffness, (float)damping);
    mspring_network_def def = support_def(0, 1);
    def.settings.global_damping = global_damping;
    return support_network(builder, &def);
}

static void one_mode_has_the_textbook_border(void **state) {
    (void)state;
    const double mass[] = {1, 73.3975, 1e-30, 1e30}, stiffness[] = {1, 3e4, 1e30}, ratio[] = {0, 0.1, 1, 30, 1e6};
    for (size_t i = 0; i < COUNT_OF(mass); i++) {
        for (size_t j = 0; j < COUNT_OF(stiffness); j++) {
            for (size_t k = 0; k < COUNT_OF(ratio); k++) {
                const double damping = 2 * ratio[k] * sqrt(stiffness[j]) * sqrt(mass[i]);
                if (damping > 1e30) {
                    continue;
                }
                mspring_network *network = oscillator(mass[i], stiffness[j], damping, 0);
                const double omega = sqrt(stiffness[j]) / sqrt(mass[i]), zeta = ratio[k];
                const double border = 2 / (sqrt(1 + zeta * zeta) + zeta) / omega; // without cancellation
                // The parameters are floats, and the iteration stops where it is this good.
                check_near(stable_now(network) / border, 1, 1e-3);
                mspring_network_destroy(network);
            }
        }
    }
}

static void global_damping_widens_the_border(void **state) {
    (void)state;
    // With x = rate h, h^2 k / m = 2 (1 + exp(-x)) x / (1 - exp(-x)) = 2 x / tanh(x / 2).
    mspring_network *network = oscillator(1, 1e4, 0, 40);
    const double h = stable_now(network);
    check_near(h * h * 1e4, 2 * 40 * h / tanh(20 * h), 0.01);
    assert_true(h > 1.02 * 2 / 100.0);
    mspring_network_destroy(network);
    // Weakly braked, and so soft that its substeps are long enough for that.
    network = oscillator(1, 0.01, 0, 0.2f);
    const double slow = stable_now(network);
    check_near(slow * slow * 0.01, 2 * 0.2 * slow / tanh(0.1 * slow), 0.01);
    mspring_network_destroy(network);
    // Braked so hard that it creeps with k / (m rate): h k / (m rate) = 2.
    network = oscillator(1, 1, 0, 100);
    check_near(stable_now(network), 200, 0.01);
    mspring_network_destroy(network);
}

/// A spring between pinned particles counts for nothing, even if these are in one place and it has no direction.
static void pinned_springs_leave_the_border_alone(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    (void)support_pinned(builder, 0, 0, 1);
    (void)support_pinned(builder, 0, 0, 1);
    (void)support_particle(builder, 1, 0, 1);
    (void)support_join(builder, 0, 1, 1e6f, 1, 0);
    (void)support_pinned(builder, 1, 1, 1);
    (void)support_spring(builder, 1, 2, 100, 0);
    (void)support_spring(builder, 2, 3, 100, 0); // across, so that another shape would bear less
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    check_near(stable_now(network), 0.2, 1e-3);
    mspring_network_destroy(network);
}

static void nothing_that_swings_has_no_border(void **state) {
    (void)state;
    mspring_network_def def = support_def(-9.8f, 1);
    for (int which = 0; which < 3; which++) {
        mspring_builder *builder = support_builder();
        support_pinned(builder, 0, 0, 1);
        support_pinned(builder, 1, 0, 1);
        support_particle(builder, 5, 5, 1);
        if (which > 0) {
            support_spring(builder, 0, 1, 1e20f, 1e20f);
        }
        if (which > 1) {
            support_spring(builder, 0, 2, 0, 0);
        }
        mspring_network *network = support_network(builder, &def);
        double now = 0, any_shape = 0;
        uint32_t substeps = 0;
        check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
        check_ok(mspring_network_suggest_substeps(network, 0.25, 0.5, &substeps));
        assert_true(now == INFINITY && any_shape == INFINITY);
        assert_int_equal(substeps, 1);
        mspring_network_destroy(network);
    }
}

static void relative_springs_are_stable_at_every_substep_or_at_none(void **state) {
    (void)state;
    for (int share = 0; share < 2; share++) {
        uint64_t seed = 4;
        const double stiffness = share == 0 ? 0.97 : 1.03;
        const recipe_stuff stuff = {
            .mass = {3, 3}, .stiffness = {stiffness, stiffness}, .spring_flags = MSPRING_SPRING_RELATIVE};
        recipe made = {0};
        recipe_lattice(&made, 40, 30, 0, 0, 1, &stuff, &seed);
        mspring_network_def def = support_def(0, 1);
        mspring_network *network = recipe_network(&made, &def);
        double now = -1, any_shape = -1;
        check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
        assert_true(now == (share == 0 ? INFINITY : 0.0));
        assert_true(any_shape == 0); // in some shape a lattice bears no more than two thirds
        uint32_t substeps = 77;
        mspring_result result = mspring_network_suggest_substeps(network, 0.25, 1, &substeps);
        assert_int_equal(result, share == 0 ? MSPRING_OK : MSPRING_ERROR_UNSTABLE);
        assert_int_equal(substeps, share == 0 ? 1 : 77);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/* ------------------------------------------------------------------------------------------ what really grows */

enum { SUBSTEPS = 3000 };

/// Whether a network that is a little out of its shape goes mad in substeps of h.
static bool grows(const recipe *made, double h, uint32_t substeps, float global_damping) {
    mspring_network_def def = support_def(0, 1);
    def.settings.global_damping = global_damping;
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    mspring_network *network = recipe_network(made, &def);
    bool grew = false;
    double first = 0;
    for (uint32_t i = 0; i < substeps && !grew; i++) {
        mspring_result result = mspring_network_step(network, h);
        double kinetic = 0, elastic = 0;
        check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
        // Near the border a mode's energy swings by a factor of a hundred; springs that go mad alone, in a corner,
        // make it a few thousand times what it was.
        if (i == 0) {
            first = kinetic + elastic;
        }
        grew = result != MSPRING_OK || kinetic + elastic > 1e3 * first;
    }
    mspring_network_destroy(network);
    return grew;
}

typedef struct border_case {
    const char *name;
    double mass[2], stiffness[2], damping[2];
    double pinned, holes;
    uint32_t width, height;      ///< of a lattice; 0: none
    uint32_t particles, springs; ///< of a random graph
    uint32_t rope;               ///< segments
    float global_damping;
    double within;
} border_case;

static recipe border_recipe(const border_case *c) {
    uint64_t seed = 77;
    const recipe_stuff stuff = {.mass = {c->mass[0], c->mass[1]},
                                .stiffness = {c->stiffness[0], c->stiffness[1]},
                                .damping = {c->damping[0], c->damping[1]},
                                .pinned = c->pinned,
                                .holes = c->holes};
    recipe made = {0};
    if (c->width > 0) {
        recipe_lattice(&made, c->width, c->height, 0, 0, 1, &stuff, &seed);
    }
    const uint32_t first = made.particle_count;
    for (uint32_t i = 0; i < c->particles; i++) {
        recipe_particle(&made, support_random_between(&seed, 0, 30), support_random_between(&seed, -40, -10),
                        exp(support_random_between(&seed, log(c->mass[0]), log(c->mass[1]))), 0);
    }
    recipe_random_springs(&made, c->springs, &stuff, &seed);
    if (c->rope > 0) {
        mspring_id end = recipe_particle(&made, 3, 50, 2, MSPRING_PARTICLE_PINNED);
        mspring_id start = first > 0 ? 0 : recipe_particle(&made, 0, 70, 2, 0);
        recipe_rope(&made, start, end, c->rope, &stuff, &seed);
    }
    recipe_disturb(&made, 1e-4, 1e-3, &seed);
    return made;
}

static void borders_are_where_growth_starts(void **state) {
    (void)state;
    const border_case cases[] = {
        {"lattice", {2, 2}, {5e4, 5e4}, {0, 0}, .width = 24, .height = 24, .within = 0.01},
        {"long bar", {2, 2}, {5e4, 5e4}, {0, 0}, .width = 100, .height = 5, .within = 0.01},
        {"damped lattice", {2, 2}, {5e4, 5e4}, {60, 60}, .width = 24, .height = 24, .within = 0.01},
        {"lattice damped far over critical",
         {2, 2},
         {5e4, 5e4},
         {1e4, 1e4},
         .width = 24,
         .height = 9,
         .within = 0.01},
        {"dampers alone", {2, 2}, {0, 0}, {50, 50}, .width = 24, .height = 9, .within = 0.01},
        {"braked", {2, 2}, {5e4, 5e4}, {30, 30}, .width = 24, .height = 9, .global_damping = 20, .within = 0.01},
        {"wreck",
         {1, 9},
         {1e3, 5e4},
         {0, 100},
         .width = 40,
         .height = 20,
         .holes = 0.3,
         .pinned = 0.05,
         .within = 0.01},
        {"rope", {1, 1}, {1e4, 1e4}, {0, 0}, .rope = 300, .within = 0.01},
        {"graph", {1, 1e4}, {1e3, 1e4}, {0, 0}, .particles = 300, .springs = 900, .within = 0.03},
        {"damped graph", {1e-2, 1e4}, {1e3, 1e4}, {0, 50}, .particles = 300, .springs = 900, .within = 0.03},
        {"all of it",
         {1, 3},
         {1e3, 1e4},
         {0, 50},
         .width = 20,
         .height = 20,
         .holes = 0.2,
         .particles = 50,
         .springs = 150,
         .rope = 50,
         .within = 0.03},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const border_case *c = &cases[i];
        recipe made = border_recipe(c);
        mspring_network_def def = support_def(0, 1);
        def.settings.global_damping = c->global_damping;
        mspring_network *network = recipe_network(&made, &def);
        double now = 0, any_shape = 0;
        check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
        mspring_network_destroy(network);
        print_message("%-34s now %.6g s, in any shape %.3f of it\n", c->name, now, any_shape / now);
        assert_true(any_shape > 0.4 * now);
        assert_false(grows(&made, now * (1 - c->within), SUBSTEPS, c->global_damping));
        assert_true(grows(&made, now * (1 + c->within), SUBSTEPS, c->global_damping));
        recipe_free(&made);
    }
}

/* ------------------------------------------------------------------------------------- substeps by themselves */

static void substeps_are_as_few_as_the_limit_allows(void **state) {
    (void)state;
    mspring_network *network = oscillator(1, 1e6, 0, 0); // 2 ms
    const struct {
        double dt, safety;
        uint32_t substeps;
    } cases[] = {{0.0019, 1, 1},  {0.0021, 1, 2},     {0.0019, 0.5, 2},
                 {0.1001, 1, 51}, {0.1001, 0.1, 501}, {1e-9, 1e-3, 1}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        uint32_t substeps = 0;
        check_ok(mspring_network_suggest_substeps(network, cases[i].dt, cases[i].safety, &substeps));
        assert_int_equal(substeps, cases[i].substeps);
    }
    const double bad[] = {0, -1, NAN, INFINITY};
    uint32_t untouched = 4711;
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        check_error(mspring_network_suggest_substeps(network, bad[i], 1, &untouched), MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_suggest_substeps(network, 1, bad[i], &untouched), MSPRING_ERROR_ARGUMENT);
    }
    check_error(mspring_network_suggest_substeps(network, 1, 1.5, &untouched), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_suggest_substeps(network, 1, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_suggest_substeps(network, 1e10, 1, &untouched), MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "1000000");
    check_error(mspring_network_suggest_substeps(NULL, 1, 1, &untouched), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_stable_dt(NULL, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(untouched, 4711);
    check_ok(mspring_network_get_stable_dt(network, NULL, NULL));
    mspring_network_destroy(network);
}

static recipe ship_like(void) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {
        .mass = {1, 4}, .stiffness = {1e4, 4e5}, .damping = {0, 30}, .pinned = 0.01, .holes = 0.2};
    recipe made = {0};
    recipe_lattice(&made, 40, 25, 0, 0, 1, &stuff, &seed);
    mspring_id end = recipe_particle(&made, 80, 60, 2, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 0, end, 80, &stuff, &seed);
    recipe_random_springs(&made, 10, &stuff, &seed);
    recipe_disturb(&made, 0.01, 1, &seed);
    return made;
}

static void automatic_substeps_are_told_and_give_the_same_bits(void **state) {
    (void)state;
    recipe made = ship_like();
    mspring_network_def def = support_def(-9.8f, MSPRING_SUBSTEPS_AUTO);
    mspring_network *network = recipe_network(&made, &def);
    assert_int_equal(support_substeps(network), 0);
    const double dt[] = {1.0 / 64, 1.0 / 30, 1e-6};
    for (size_t i = 0; i < COUNT_OF(dt); i++) {
        mspring_network *twin = recipe_network(&made, &def);
        mspring_settings solver;
        check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
        double any_shape = 0;
        check_ok(mspring_network_get_stable_dt(twin, NULL, &any_shape));
        solver.substeps = (uint32_t)ceil(dt[i] / any_shape);
        check_ok(support_set_solver(twin, &solver));
        support_steps(twin, 20, dt[i]);
        mspring_network_destroy(network);
        network = recipe_network(&made, &def);
        support_steps(network, 20, dt[i]);
        assert_int_equal(support_substeps(network), solver.substeps);
        assert_int_equal(support_hash(network), support_hash(twin));
        mspring_network_destroy(twin);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void automatic_substeps_are_bounded(void **state) {
    (void)state;
    recipe made = ship_like();
    mspring_network_def def = support_def(-9.8f, MSPRING_SUBSTEPS_AUTO);
    def.settings.max_substeps = 10;
    mspring_network *network = recipe_network(&made, &def);
    const uint64_t before = support_hash(network);
    check_error(mspring_network_step(network, 1.0 / 30), MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "max_substeps");
    check_contains(mspring_network_error(network), "spring ");
    assert_int_equal(support_hash(network), before);
    support_steps(network, 1, 1e-4);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void whatever_happens_to_its_shape(void **state) {
    (void)state;
    // Crushed into a square of a tenth of its size, every spring tangled: what it has is elastic energy, and that
    // is all it may ever have.
    recipe made = ship_like();
    mspring_network_def def = support_def(0, MSPRING_SUBSTEPS_AUTO);
    mspring_network *network = recipe_network(&made, &def);
    uint64_t seed = 9;
    const uint32_t count = made.particle_count;
    double *x = test_malloc(count * sizeof *x), *y = test_malloc(count * sizeof *y);
    for (uint32_t i = 0; i < count; i++) {
        x[i] = support_random_between(&seed, 0, 3);
        y[i] = support_random_between(&seed, 0, 3);
    }
    check_ok(mspring_network_set_positions(network, NULL, 0, count, x, y, 1));
    double kinetic = 0, elastic = 0, first = 0;
    check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
    first = kinetic + elastic;
    for (int step = 0; step < 300; step++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
        check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
        // First order: at this substep the energy of a mode at the border swings by some tens of percent.
        assert_true(kinetic + elastic < 1.5 * first);
    }
    test_free(x);
    test_free(y);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_mode_has_the_textbook_border),
        cmocka_unit_test(global_damping_widens_the_border),
        cmocka_unit_test(pinned_springs_leave_the_border_alone),
        cmocka_unit_test(nothing_that_swings_has_no_border),
        cmocka_unit_test(relative_springs_are_stable_at_every_substep_or_at_none),
        cmocka_unit_test(borders_are_where_growth_starts),
        cmocka_unit_test(substeps_are_as_few_as_the_limit_allows),
        cmocka_unit_test(automatic_substeps_are_told_and_give_the_same_bits),
        cmocka_unit_test(automatic_substeps_are_bounded),
        cmocka_unit_test(whatever_happens_to_its_shape),
    };
    return cmocka_run_group_tests_name("stable_dt", tests, NULL, NULL);
}
