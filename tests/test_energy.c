/// @file test_energy.c
/// Energy that implicit substeps would make out of nothing: refused, with the state of before; and what is pulled,
/// pushed, dropped and swung is never taken for it.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

static const mspring_solver solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};

/// A straight rope of 20 springs of 1 m and 1 kg a particle, pinned at its left end and perhaps at its right.
static recipe rope(double stiffness, uint32_t end_flags) {
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {stiffness, stiffness}};
    recipe made = {0};
    recipe_particle(&made, 0, 0, 1, MSPRING_PARTICLE_PINNED);
    const mspring_id end = recipe_particle(&made, 20, 0, 1, end_flags);
    recipe_rope(&made, 0, end, 20, &stuff, &seed);
    return made;
}

static mspring_network *start(const recipe *made, mspring_solver solver, mspring_integrator integrator,
                              mspring_guard guard) {
    mspring_network_def def = support_def(-9.8f, 1);
    def.guard = guard;
    mspring_network *network = recipe_network(made, &def);
    mspring_solver_def settings;
    check_ok(mspring_solver_def_init(&settings, sizeof settings));
    settings.solver = solver;
    settings.integrator = integrator;
    check_ok(mspring_network_set_solver(network, &settings));
    return network;
}

static double energy_of(const mspring_network *network) {
    double kinetic, elastic;
    check_ok(mspring_network_energy(network, &kinetic, &elastic, NULL));
    return kinetic + elastic;
}

/// In 1/8 s it falls by 15 cm, which stretches the spring at the pin by 1 %: 50 million joule at 1e12 N/m.
static void a_stiff_rope_is_refused(void **state) {
    (void)state;
    for (size_t s = 0; s < COUNT_OF(solvers); s++) {
        recipe made = rope(1e12, 0);
        mspring_network *network = start(&made, solvers[s], MSPRING_INTEGRATOR_EULER, MSPRING_GUARD_GROWTH);
        const uint64_t before = support_hash(network);
        for (int again = 0; again < 2; again++) {
            check_error(mspring_network_step(network, 0.125), MSPRING_ERROR_UNSTABLE);
            check_contains(mspring_network_error(network), "spring 0 between particles 0 and 2");
            assert_int_equal(support_hash(network), before);
        }
        // A step that it can take is none the worse for that.
        mspring_network *twin = start(&made, solvers[s], MSPRING_INTEGRATOR_EULER, MSPRING_GUARD_GROWTH);
        support_steps(network, 20, 1e-4);
        support_steps(twin, 20, 1e-4);
        assert_int_equal(support_hash(network), support_hash(twin));
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
        recipe_free(&made);
    }
}

static void bounds_alone_let_it_pass(void **state) {
    (void)state;
    recipe made = rope(1e12, 0);
    mspring_network *network = start(&made, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_EULER, MSPRING_GUARD_BOUNDS);
    support_steps(network, 1, 0.125);
    assert_true(energy_of(network) > 1e6);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void more_substeps_are_tried(void **state) {
    (void)state;
    for (size_t s = 0; s < COUNT_OF(solvers); s++) {
        recipe made = rope(1e9, 0);
        mspring_network *network = start(&made, solvers[s], MSPRING_INTEGRATOR_GA0, MSPRING_GUARD_RETRY);
        support_steps(network, 8, 0.125);
        assert_in_range(mspring_network_substeps(network), 2, 1000);
        // It has swung through a quarter of a circle or so: m g times its height, and not much more.
        assert_true(energy_of(network) < 2 * 20 * 9.8 * 20);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/* ------------------------------------------------------------------------------------------- what is no gain */

typedef struct treatment {
    const char *name;
    double stiffness;
    float pin_speed; ///< m/s, of the pinned right end to the right
    float throw;     ///< m/s, of all particles upwards
    float push;      ///< N, on the last particle, in each step
    bool heavy;      ///< the free right end weighs a ton
    bool cut;        ///< in the middle, after a second
} treatment;

static const treatment treatments[] = {
    {.name = "falls", .stiffness = 1e6},
    {.name = "is pulled by a pin", .stiffness = 1e6, .pin_speed = 3},
    {.name = "is torn by a pin", .stiffness = 1e9, .pin_speed = 30},
    {.name = "is thrown", .stiffness = 1e6, .throw = 40},
    {.name = "is pushed", .stiffness = 1e6, .push = 1e5f},
    {.name = "is pushed, slack", .stiffness = 1e3, .push = -1e4f},
    {.name = "bears a ton", .stiffness = 1e7, .heavy = true},
    {.name = "snaps", .stiffness = 1e7, .heavy = true, .cut = true},
};

static void check_treatment(const treatment *t, mspring_solver solver, mspring_integrator integrator) {
    recipe made = rope(t->stiffness, t->pin_speed > 0 ? MSPRING_PARTICLE_PINNED : 0);
    const mspring_id end = 1;
    made.particles[end].mass = t->heavy ? 1000 : 1;
    for (uint32_t i = 1; i < made.particle_count; i++) {
        made.particles[i].vy = t->throw;
    }
    mspring_network *network = start(&made, solver, integrator, MSPRING_GUARD_GROWTH);
    const float none = 0;
    check_ok(mspring_network_set_velocities(network, end, 1, t->pin_speed > 0 ? &t->pin_speed : &none, &t->throw));
    for (int step = 0; step < 128; step++) {
        const mspring_id middle = 10;
        if (t->cut && step == 64) {
            check_ok(mspring_network_break_springs(network, &middle, 1));
        }
        if (t->push != 0) {
            check_ok(mspring_network_apply_force(network, end, t->push, 0));
        }
        const mspring_result result = mspring_network_step(network, 1.0 / 64);
        if (result != MSPRING_OK) {
            print_error("a rope that %s, solver %d, integrator %d, step %d: %s\n", t->name, (int)solver,
                        (int)integrator, step, mspring_network_error(network));
        }
        check_ok(result);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void work_is_no_gain(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(treatments); i++) {
        for (size_t s = 0; s < COUNT_OF(solvers); s++) {
            for (mspring_integrator n = MSPRING_INTEGRATOR_GA0; n <= MSPRING_INTEGRATOR_EULER; n++) {
                check_treatment(&treatments[i], solvers[s], n);
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stiff_rope_is_refused),
        cmocka_unit_test(bounds_alone_let_it_pass),
        cmocka_unit_test(more_substeps_are_tried),
        cmocka_unit_test(work_is_no_gain),
    };
    return cmocka_run_group_tests_name("energy", tests, NULL, NULL);
}
