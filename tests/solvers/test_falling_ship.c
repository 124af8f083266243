/// @file test_falling_ship.c
/// A ship with holes, masts and rigging, held at its bow only, falls: the implicit and the direct solver refuse no
/// step, and there is never more energy than at the start but for the rounding that MSPRING_GUARD_GROWTH grants.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "recipe.h"
#include "support.h"

enum { COLUMNS = 64, ROWS = 28, MASTS = 3, MAST_HEIGHT = 22, STEPS = 4 * 64 };

/// N/m, of iron: 1000 kg hang on a spring by 0.02 mm.
#define STIFFNESS 4.4e8

static void join(recipe *made, mspring_id a, mspring_id b) {
    recipe_spring(made, a, b, STIFFNESS, 0, 0);
}

/// The hull's cells without holes at its rim, so that what is tied there has something to hold on to.
static recipe ship(void) {
    uint64_t seed = 17;
    const recipe_stuff whole = {.mass = {800, 800}, .stiffness = {STIFFNESS, STIFFNESS}};
    const recipe_stuff hemp = {.mass = {5, 20}, .stiffness = {STIFFNESS, STIFFNESS}};
    recipe_stuff hull = whole;
    hull.holes = 0.06;
    recipe made = {0};
    recipe_lattice(&made, COLUMNS, ROWS, 0, 0, 1, &hull, &seed);
    const mspring_id deck = recipe_lattice(&made, COLUMNS, 2, 0, ROWS, 1, &whole, &seed);
    for (mspring_id below = 0; below < deck; below++) {
        const mspring_particle_def *p = &made.particles[below];
        for (int column = (int)p->x - 1; p->y > ROWS - 1.5 && column <= (int)p->x + 1; column++) {
            if (column >= 0 && column < COLUMNS) {
                join(&made, below, deck + (mspring_id)column);
            }
        }
        if (p->x < 0.5) {
            made.particles[below].flags = MSPRING_PARTICLE_PINNED;
        }
    }
    mspring_id last = deck + COLUMNS + 2;
    for (uint32_t i = 0; i < MASTS; i++) {
        const uint32_t column = 12 + 18 * i;
        const mspring_id foot = deck + COLUMNS + column;
        const mspring_id mast = recipe_lattice(&made, 2, MAST_HEIGHT, column, ROWS + 2, 1, &whole, &seed);
        const mspring_id top = mast + 2 * MAST_HEIGHT - 2;
        join(&made, foot, mast);
        join(&made, foot, mast + 1);
        join(&made, foot + 1, mast);
        join(&made, foot + 1, mast + 1);
        recipe_rope(&made, last, top, 20, &hemp, &seed);
        recipe_rope(&made, top + 1, foot + 7, 24, &hemp, &seed);
        recipe_rope(&made, top, foot - 8, 24, &hemp, &seed);
        last = top + 1;
    }
    recipe_disturb(&made, 0, 0, &seed); // rest lengths are those of now
    return made;
}

/// What lengths are off by in the last place of positions up to 128 m, J.
static double rounding_of(const recipe *made) {
    const double u = 128.0 / (1 << 24);
    double sum = 0;
    for (uint32_t i = 0; i < made->spring_count; i++) {
        sum += (double)made->springs[i].stiffness * u * u / 12;
    }
    return sum;
}

static mspring_network *start(const recipe *made, mspring_solver solver, mspring_integrator integrator,
                              mspring_guard guard) {
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.guard = guard;
    return recipe_solved(made, &def, solver, integrator);
}

static void fall(mspring_solver solver, mspring_integrator integrator) {
    recipe made = ship();
    mspring_network *network = start(&made, solver, integrator, MSPRING_GUARD_GROWTH);
    const double first = support_energy(network), rounding = rounding_of(&made);
    double motion = support_energy_of_motion(network), most = -INFINITY;
    for (int step = 0; step < STEPS; step++) {
        if (mspring_network_step(network, 1.0 / 64) != MSPRING_OK) {
            fail_msg("step %d: %s", step, mspring_network_error(network));
        }
        const double more = support_energy(network) - first;
        motion = fmax(motion, support_energy_of_motion(network));
        most = fmax(most, more / motion);
        if (!(more <= 1e-6 * motion + rounding)) {
            fail_msg("step %d: %g J more than at the start, with a motion of %g J", step, more, motion);
        }
    }
    print_message("%u springs, motion up to %g J, rounding %g J, at most %+.2g of the motion more\n",
                  made.spring_count, motion, rounding, most);
    assert_true(motion > 1e6); // it did fall
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void implicit_ga0(void **state) {
    (void)state;
    fall(MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA);
}

static void implicit_bdf2(void **state) {
    (void)state;
    fall(MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2);
}

static void implicit_euler(void **state) {
    (void)state;
    fall(MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER);
}

static void direct(void **state) {
    (void)state;
    fall(MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA);
}

/// This ship is one that needs the guard, so that the others say something.
static void bounds_alone_would_not_do(void **state) {
    (void)state;
    const mspring_solver solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
    recipe made = ship();
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = start(&made, solvers[i], MSPRING_INTEGRATOR_ALPHA, MSPRING_GUARD_BOUNDS);
        const double first = support_energy(network);
        double most = 0;
        for (int step = 0; step < STEPS && mspring_network_step(network, 1.0 / 64) == MSPRING_OK; step++) {
            most = fmax(most, support_energy(network) - first);
        }
        assert_true(most > 1e6);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(implicit_ga0),
        cmocka_unit_test(implicit_bdf2),
        cmocka_unit_test(implicit_euler),
        cmocka_unit_test(direct),
        cmocka_unit_test(bounds_alone_would_not_do),
    };
    return cmocka_run_group_tests_name("falling_ship", tests, NULL, NULL);
}
