/// @file test_energy.c
/// Energy that implicit substeps would make out of nothing: they are taken in pieces, or go back; and what is
/// pulled, pushed, dropped and swung is never taken for it.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    def.settings.guard = guard;
    return recipe_solved(made, &def, solver, integrator);
}

/// A network on its way, from total on.
typedef struct course {
    double total, motion; ///< at the start; most kinetic and elastic energy so far
    double rounding;      ///< of energies: springs whose ends are rounded
} course;

static course begin_course(const mspring_network *network, double rounding) {
    return (course){
        .total = support_energy(network), .motion = support_energy_of_motion(network), .rounding = rounding};
}

/// There is never more than at the start, but for rounding: that of positions, and that of sums.
static void check_course(course *c, const mspring_network *network, const char *what, int step) {
    const double total = support_energy(network);
    c->motion = fmax(c->motion, support_energy_of_motion(network));
    const double most = c->total + 1e-6 * c->motion + c->rounding;
    if (!(total <= most)) {
        print_error("%s, step %d: from %g J to %g J, with a motion of %g J\n", what, step, c->total, total,
                    c->motion);
    }
    assert_true(total <= most);
}

/// In 1/8 s it falls by 15 cm, which would stretch the spring at the pin by 1 %: 50 million joule at 1e12 N/m.
static void a_stiff_rope_is_taken_in_pieces(void **state) {
    (void)state;
    for (size_t s = 0; s < COUNT_OF(solvers); s++) {
        for (mspring_integrator n = MSPRING_INTEGRATOR_ALPHA; n <= MSPRING_INTEGRATOR_EULER; n++) {
            recipe made = rope(1e12, 0);
            mspring_network *network = start(&made, solvers[s], n, MSPRING_GUARD_GROWTH);
            // At 20 m a unit in the last place is 2e-6 m.
            course c = begin_course(network, 20 * 0.5 * 1e12 * 2e-6 * 2e-6);
            for (int step = 0; step < 4; step++) {
                support_steps(network, 1, 0.125);
                check_course(&c, network, "a stiff rope", step);
            }
            assert_true(support_position(network, 1).y < -0.1); // it falls, though with a delay
            mspring_network_destroy(network);
            recipe_free(&made);
        }
    }
}

/// In two seconds not even pieces follow it; still it gains nothing, and no step fails.
static void a_stiff_rope_is_never_refused(void **state) {
    (void)state;
    for (size_t s = 0; s < COUNT_OF(solvers); s++) {
        for (mspring_integrator n = MSPRING_INTEGRATOR_ALPHA; n <= MSPRING_INTEGRATOR_EULER; n++) {
            recipe made = rope(1e12, 0);
            mspring_network *network = start(&made, solvers[s], n, MSPRING_GUARD_GROWTH);
            course c = begin_course(network, 20 * 0.5 * 1e12 * 2e-6 * 2e-6);
            for (int round = 0; round < 4; round++) {
                support_steps(network, 1, 2);
                check_course(&c, network, "a stiff rope, 2 s", round);
                support_steps(network, 10, 1e-4);
                support_steps(network, 1, 0.02);
                check_course(&c, network, "a stiff rope, 0.02 s", round);
            }
            mspring_network_destroy(network);
            recipe_free(&made);
        }
    }
}

static void bounds_alone_let_it_pass(void **state) {
    (void)state;
    recipe made = rope(1e12, 0);
    mspring_network *network = start(&made, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_EULER, MSPRING_GUARD_BOUNDS);
    support_steps(network, 1, 0.125);
    assert_true(support_energy_of_motion(network) > 1e6);
    mspring_network_destroy(network);
    recipe_free(&made);
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
    check_ok(
        mspring_network_set_velocities(network, NULL, end, 1, t->pin_speed > 0 ? &t->pin_speed : &none, &t->throw, 1));
    for (int step = 0; step < 128; step++) {
        const mspring_id middle = 10;
        if (t->cut && step == 64) {
            check_ok(mspring_network_break_springs(network, &middle, 0, 1));
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
            for (mspring_integrator n = MSPRING_INTEGRATOR_ALPHA; n <= MSPRING_INTEGRATOR_EULER; n++) {
                check_treatment(&treatments[i], solvers[s], n);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------- slack ropes */

/// A small lattice, tied to itself and to weights by slack ropes, and all of it thrown about.
static recipe tangle(uint64_t *seed, double *rounding) {
    recipe made = {0};
    const double stiffness = pow(10, support_random_between(seed, 4, 9));
    const double slack = support_random_between(seed, 1, 1.5), spin = support_random_between(seed, -20, 20);
    const double ratio = support_random(seed) % 3 == 0 ? 42000 : 30;
    const bool pinned = support_random(seed) % 2 == 0, damped = support_random(seed) % 3 == 0;
    const double damping = damped ? sqrt(stiffness) : 0;
    const recipe_stuff hull = {
        .mass = {10, 10}, .stiffness = {stiffness, stiffness}, .damping = {damping, damping}};
    const recipe_stuff hemp = {
        .mass = {0.5, 8}, .stiffness = {0.1 * stiffness, stiffness}, .damping = {damping, damping}};
    recipe_lattice(&made, 6, 4, 0, 0, 1, &hull, seed);
    for (int i = 0; i < 6; i++) {
        const mspring_id from = (mspring_id)(support_random(seed) % 24);
        mspring_id to = (from + 5 + (mspring_id)i) % 24;
        if (i % 2 == 0) {
            const double x = support_random_between(seed, -8, 14), y = support_random_between(seed, -8, 12);
            to = recipe_particle(&made, x, y, 10 * ratio, 0);
        }
        recipe_rope(&made, from, to, 3 + (uint32_t)(support_random(seed) % 10), &hemp, seed);
    }
    recipe_disturb(&made, 0, 0, seed); // rest lengths are those of now
    for (uint32_t i = 0; i < made.particle_count; i++) {
        mspring_particle_def *p = &made.particles[i];
        p->vx = (float)(-spin * p->y + support_random_between(seed, -10, 10) * (i >= 24));
        p->vy = (float)(spin * p->x);
        p->flags = pinned && i == 0 ? MSPRING_PARTICLE_PINNED : 0;
        if (p->flags) {
            p->vx = p->vy = 0;
        }
    }
    for (uint32_t i = 0; i < made.spring_count; i++) {
        made.springs[i].rest_length *= (float)(made.springs[i].a >= 24 || made.springs[i].b >= 24 ? slack : 1);
    }
    // Ends at up to 30 m, rounded to 2e-6 m, in each spring; on motion that has died away.
    *rounding = made.spring_count * 0.5 * stiffness * 4e-6 * 4e-6;
    return made;
}

static void slack_ropes_gain_nothing(void **state) {
    (void)state;
    uint32_t taken = 0, refused = 0;
    for (uint64_t number = 1; number <= 24; number++) {
        for (size_t s = 0; s < COUNT_OF(solvers); s++) {
            uint64_t seed = 100 * number;
            double rounding;
            recipe made = tangle(&seed, &rounding);
            const mspring_integrator integrator = (mspring_integrator)(number % 3);
            mspring_network *network = start(&made, solvers[s], integrator, MSPRING_GUARD_GROWTH);
            char what[64];
            (void)snprintf(what, sizeof what, "tangle %d, solver %d", (int)number, (int)solvers[s]);
            course c = begin_course(network, rounding);
            for (int step = 0; step < 100; step++) {
                if (mspring_network_step(network, number % 5 == 0 ? 1.0 / 15 : 1.0 / 64) != MSPRING_OK) {
                    refused++;
                    break;
                }
                taken++;
                check_course(&c, network, what, step);
            }
            mspring_network_destroy(network);
            recipe_free(&made);
        }
    }
    print_message("%u steps taken, %u refused\n", taken, refused);
    assert_true(taken > 3000);
}

/// In a copy and after a rollback the energy goes on being counted where it was.
static void the_count_goes_along(void **state) {
    (void)state;
    for (size_t s = 0; s < COUNT_OF(solvers); s++) {
        for (uint64_t number = 3; number <= 6; number++) {
            uint64_t seed = 100 * number;
            double rounding;
            recipe made = tangle(&seed, &rounding);
            mspring_network *network = start(&made, solvers[s], MSPRING_INTEGRATOR_ALPHA, MSPRING_GUARD_GROWTH);
            support_steps(network, 30, 1.0 / 64);
            mspring_network *copy = NULL;
            size_t size;
            check_ok(mspring_network_clone(network, NULL, &copy));
            check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
            void *snapshot = malloc(size);
            assert_non_null(snapshot);
            check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, snapshot, size, NULL));
            support_steps(network, 40, 1.0 / 64);
            support_steps(copy, 40, 1.0 / 64);
            const uint64_t hash = support_hash(network);
            assert_int_equal(support_hash(copy), hash);
            support_steps(copy, 7, 1.0 / 64);
            check_ok(mspring_network_load(copy, snapshot, size));
            support_steps(copy, 40, 1.0 / 64);
            assert_int_equal(support_hash(copy), hash);
            free(snapshot);
            mspring_network_destroy(copy);
            mspring_network_destroy(network);
            recipe_free(&made);
        }
    }
}

/// What is refused though no spring is left that could be to blame.
static void broken_springs_are_not_named(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        for (uint32_t columns = 1; columns <= 4; columns += 3) { // without springs, and with some that are broken
            uint64_t seed = 1;
            const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1000, 1000}};
            recipe made = {0};
            recipe_lattice(&made, columns, columns, 0, 0, 1, &stuff, &seed);
            mspring_network_def def = support_def(-9.8f, 1);
            def.settings.solver = solvers[i];
            mspring_network *network = recipe_network(&made, &def);
            for (mspring_id s = 0; s < made.spring_count; s++) {
                check_ok(mspring_network_break_springs(network, &s, 0, 1));
            }
            const uint64_t hash = support_hash(network);
            assert_int_equal(mspring_network_step(network, 1e30), MSPRING_ERROR_UNSTABLE);
            assert_null(strstr(mspring_network_error(network), "is spring"));
            assert_int_equal(support_hash(network), hash);
            support_steps(network, 1, 1.0 / 64);
            mspring_network_destroy(network);
            recipe_free(&made);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stiff_rope_is_taken_in_pieces), cmocka_unit_test(a_stiff_rope_is_never_refused),
        cmocka_unit_test(bounds_alone_let_it_pass),        cmocka_unit_test(work_is_no_gain),
        cmocka_unit_test(slack_ropes_gain_nothing),        cmocka_unit_test(the_count_goes_along),
        cmocka_unit_test(broken_springs_are_not_named),
    };
    return cmocka_run_group_tests_name("energy", tests, NULL, NULL);
}
