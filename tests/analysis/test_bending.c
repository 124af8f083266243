/// @file test_bending.c
/// Static bending of bars that hang from one end, against the equilibrium that Newton's method finds in double
/// precision for the same springs (bars of 8-neighbour lattice, 73.3975 kg a particle, spacing 1 m, gravity 9.8):
///
///     stiffness, N/m    6.7643e7    2.706e8
///     80 x 5            20.0586     5.2448   m
///     544 x 68          188.464     50.798   m
///
/// and, for the implicit and the direct solver, up to a million times as stiff and 1800 long.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

typedef struct bar {
    uint32_t columns, rows;
    double stiffness;
    double bending; ///< m, the oracle's
    mspring_solver solver;
    uint32_t substeps;         ///< of 1/64 s: half of the explicit limit; 0: one
    uint32_t steps_per_second; ///< 0: 64
} bar;

static const double gravity = 9.8;

/// How far the top right particle ends below its place, m.
static double settled_bending(const bar *b) {
    uint64_t seed = 1;
    const recipe_stuff iron = {.mass = {73.3975, 73.3975}, .stiffness = {b->stiffness, b->stiffness}};
    recipe made = {0};
    recipe_lattice(&made, b->columns, b->rows, 0, 0, 1, &iron, &seed);
    for (uint32_t row = 0; row < b->rows; row++) {
        made.particles[row * b->columns].flags = MSPRING_PARTICLE_PINNED;
    }
    const mspring_id probe = b->columns * b->rows - 1;

    // The slowest mode of a cantilever turns with 3.516 sqrt(EI / (m' L^4)), and its end bends by m' g L^4 / (8 EI)
    // under its own weight: omega = 1.24 sqrt(g / bending). Damped critically at twice that, this mode and all
    // faster ones die out as exp(-omega t) or (1 + omega t) exp(-omega t).
    const double omega = 1.24 * sqrt(gravity / b->bending);
    mspring_network_def def = support_def((float)-gravity, b->substeps > 0 ? b->substeps : 1);
    def.settings.solver = b->solver;
    def.settings.global_damping = (float)(2 * omega);
    mspring_network *network = recipe_network(&made, &def);

    // At omega t = 13 there are 3e-5 of the bending left to go.
    const double rate = b->steps_per_second > 0 ? b->steps_per_second : 64;
    const uint32_t steps = (uint32_t)fmax(13 / omega * rate, 100);
    support_steps(network, steps, 1 / rate);
    double bending = made.particles[probe].y - support_position(network, probe).y;

    // It has indeed settled: another twentieth of the time changes nothing that the tolerance below would see.
    support_steps(network, steps / 20, 1 / rate);
    double later = made.particles[probe].y - support_position(network, probe).y;
    check_near(later, bending, 1e-4 * bending);
    mspring_network_destroy(network);
    recipe_free(&made);
    return later;
}

static void check_bending(const bar *b) {
    // The springs of the library are floats: rest lengths and stiffness off by 6e-8, lengths by a few ulp of the
    // coordinates (1.5e-5 m at 256 m, at random over many springs). 0.1 % is ten times what that is worth, and the
    // smallest mistake in the model, such as a row more or a column less pinned, costs over 1 %.
    check_near(settled_bending(b), b->bending, 1e-3 * b->bending);
}

static void bar_80x5_bends_as_in_equilibrium(void **state) {
    (void)state;
    check_bending(&(bar){.columns = 80, .rows = 5, .stiffness = 6.7643e7, .bending = 20.0586, .substeps = 30});
}

static void bar_80x5_four_times_as_stiff(void **state) {
    (void)state;
    check_bending(&(bar){.columns = 80, .rows = 5, .stiffness = 2.706e8, .bending = 5.2448, .substeps = 60});
}

static void bar_544x68_bends_as_in_equilibrium(void **state) {
    (void)state;
    check_bending(&(bar){.columns = 544, .rows = 68, .stiffness = 6.7643e7, .bending = 188.464, .substeps = 30});
}

/* ------------------------------------------------------------------------------- implicit and direct solver */

/// Rows of the oracle's table. The stiffest of the 80 x 5 bends by a millimetre and a half, which positions resolve
/// to 0.02 %; the softest of the 1800 x 5 hang down nearly straight.
typedef struct oracle {
    uint32_t columns, rows;
    double stiffness, bending;
} oracle;

static const oracle bars_80x5[] = {{80, 5, 6.7643e7, 20.0586},
                                   {80, 5, 2.706e8, 5.2448},
                                   {80, 5, 1e9, 1.42216},
                                   {80, 5, 1e10, 0.142200},
                                   {80, 5, 1e12, 0.00142195}};
static const oracle bars_544x68[] = {
    {544, 68, 6.7643e7, 188.464}, {544, 68, 2.706e8, 50.798}, {544, 68, 1e9, 13.779}, {544, 68, 1e10, 1.3769}};
static const oracle bars_1800x5[] = {{1800, 5, 6.7643e7, 1806.7}, {1800, 5, 1e9, 1775.7},  {1800, 5, 1e10, 1715.7},
                                     {1800, 5, 1e12, 364.5},      {1800, 5, 1e13, 37.680}, {1800, 5, 1e14, 3.769}};

/// Check rows to a part of the bending.
static void check_rows(const oracle *rows, size_t count, mspring_solver solver, uint32_t steps_per_second,
                       double tolerance) {
    for (size_t i = 0; i < count; i++) {
        const bar b = {.columns = rows[i].columns,
                       .rows = rows[i].rows,
                       .stiffness = rows[i].stiffness,
                       .bending = rows[i].bending,
                       .solver = solver,
                       .steps_per_second = steps_per_second};
        const double bending = settled_bending(&b);
        print_message("%u x %u, %g N/m, solver %d: %g m, %+.4f %%\n", (unsigned)b.columns, (unsigned)b.rows,
                      b.stiffness, (int)solver, bending, 100 * (bending / b.bending - 1));
        check_near(bending, b.bending, tolerance * b.bending);
    }
}

static void implicit_bars_80x5_bend_as_in_equilibrium(void **state) {
    (void)state;
    check_rows(bars_80x5, COUNT_OF(bars_80x5), MSPRING_SOLVER_IMPLICIT, 64, 0.005);
}

static void direct_bars_80x5_bend_as_in_equilibrium(void **state) {
    (void)state;
    check_rows(bars_80x5, COUNT_OF(bars_80x5), MSPRING_SOLVER_DIRECT, 64, 0.0005);
}

static void implicit_bars_544x68_bend_as_in_equilibrium(void **state) {
    (void)state;
    check_rows(bars_544x68, COUNT_OF(bars_544x68), MSPRING_SOLVER_IMPLICIT, 32, 0.005);
}

static void direct_bars_544x68_bend_as_in_equilibrium(void **state) {
    (void)state;
    check_rows(bars_544x68, COUNT_OF(bars_544x68), MSPRING_SOLVER_DIRECT, 4, 0.0005);
}

static void implicit_bars_1800x5_bend_as_in_equilibrium(void **state) {
    (void)state;
    check_rows(bars_1800x5, COUNT_OF(bars_1800x5), MSPRING_SOLVER_IMPLICIT, 64, 0.005);
}

static void direct_bars_1800x5_bend_as_in_equilibrium(void **state) {
    (void)state;
    check_rows(bars_1800x5, COUNT_OF(bars_1800x5), MSPRING_SOLVER_DIRECT, 4, 0.0005);
}

int main(int argc, char **argv) {
    // Large bars take seconds at the best level and a minute without any: tests of their own.
    const struct CMUnitTest small[] = {
        cmocka_unit_test(bar_80x5_bends_as_in_equilibrium),
        cmocka_unit_test(bar_80x5_four_times_as_stiff),
        cmocka_unit_test(implicit_bars_80x5_bend_as_in_equilibrium),
        cmocka_unit_test(direct_bars_80x5_bend_as_in_equilibrium),
    };
    const struct CMUnitTest large[] = {
        cmocka_unit_test(bar_544x68_bends_as_in_equilibrium),
        cmocka_unit_test(implicit_bars_544x68_bend_as_in_equilibrium),
        cmocka_unit_test(implicit_bars_1800x5_bend_as_in_equilibrium),
    };
    const struct CMUnitTest large_direct[] = {
        cmocka_unit_test(direct_bars_544x68_bend_as_in_equilibrium),
        cmocka_unit_test(direct_bars_1800x5_bend_as_in_equilibrium),
    };
    if (argc > 1 && strcmp(argv[1], "large") == 0) {
        return cmocka_run_group_tests_name("bending_large", large, NULL, NULL);
    }
    if (argc > 1 && strcmp(argv[1], "large_direct") == 0) {
        return cmocka_run_group_tests_name("bending_large_direct", large_direct, NULL, NULL);
    }
    return cmocka_run_group_tests_name("bending", small, NULL, NULL);
}
