/// @file test_house.c
/// A solver and a stage that the library does not have can be added without changing it: each is a file in house/
/// and lines in house/store/, which stand before the library's own table. solver.c and the files of a step are
/// compiled with these; all else is the library as it is.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "house/wind.h"
#include "store/network.h"
#include "support.h"

enum { EULER = MSPRING_SOLVER_DIRECT + 1 };

static const double DT = 1.0 / 64.0;

/// A mass on a spring of rest length 1, drawn out to 1.5.
static mspring_network *pendulum(mspring_solver solver) {
    mspring_builder *builder = support_builder();
    const mspring_id pin = support_pinned(builder, 0, 0, 1), mass = support_particle(builder, 1, 0, 2);
    (void)support_spring(builder, pin, mass, 8, 0.5f);
    mspring_network_def def = support_def(0, 4);
    def.settings.solver = solver;
    mspring_network *network = support_network(builder, &def);
    const double x = 1.5, y = 0;
    check_ok(mspring_network_set_positions(network, NULL, mass, 1, &x, &y, 1));
    return network;
}

static double x_of(const mspring_network *network, mspring_id particle) {
    double x, y;
    check_ok(mspring_network_get_positions(network, NULL, particle, 1, &x, &y, 1));
    return x;
}

static void solver_is_chosen_and_runs(void **state) {
    (void)state;
    mspring_network *network = pendulum((mspring_solver)EULER);
    double x = 1.5, v = 0;
    for (int step = 0; step < 100; step++) {
        support_steps(network, 1, DT);
        for (int substep = 0; substep < 4; substep++) {
            const double force = 8 * (1 - x) - 0.5 * v;
            x += DT / 4 * v;
            v += DT / 4 * force / 2;
        }
    }
    check_near(x_of(network, 1), x, 1e-5); // of velocities in single precision
    mspring_network_destroy(network);
}

static void solver_goes_along(void **state) {
    (void)state;
    mspring_network *network = pendulum((mspring_solver)EULER), *clone;
    support_steps(network, 10, DT);
    check_ok(mspring_network_clone(network, NULL, &clone));
    support_steps(network, 10, DT);
    support_steps(clone, 10, DT);
    assert_true(support_hash(clone) == support_hash(network));
    mspring_network_destroy(clone);
    const mspring_id spring = 0;
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_compact(network));
    const double before = x_of(network, 1);
    support_steps(network, 1, DT);
    const double moved = x_of(network, 1) - before;
    support_steps(network, 1, DT);
    check_near(x_of(network, 1), before + 2 * moved, 1e-6);
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0));
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    check_ok(support_set_solver(network, &def));
    support_steps(network, 1, DT);
    def.solver = (mspring_solver)(EULER + 1);
    check_error(support_set_solver(network, &def), MSPRING_ERROR_ARGUMENT);
    mspring_network_destroy(network);
}

/// A free particle that the wind blows away, whatever the solver.
static void check_wind(mspring_solver solver, uint32_t substeps) {
    mspring_builder *builder = support_builder();
    const mspring_id free = support_particle(builder, 0, 0, 2);
    (void)support_spring(builder, free, support_particle(builder, 1, 0, 2), 1, 0);
    mspring_network_def def = support_def(0, substeps);
    def.settings.solver = solver;
    mspring_network *network = support_network(builder, &def);
    check_ok(mspringi_field_reserve(network, &network->forces.base));
    float vx, vy;
    support_steps(network, 4, DT);
    check_ok(mspring_network_get_velocities(network, NULL, free, 1, &vx, &vy, 1));
    assert_true(vx == 0);
    house_wind_force = 3;
    support_steps(network, 8, DT);
    house_wind_force = 0;
    check_ok(mspring_network_get_velocities(network, NULL, free, 1, &vx, &vy, 1));
    check_near((double)vx, 3.0 / 2 * 8 * DT, 1e-6);
    mspring_network_destroy(network);
}

static void wind_blows(void **state) {
    (void)state;
    check_wind(MSPRING_SOLVER_EXPLICIT, 5);
    check_wind(MSPRING_SOLVER_IMPLICIT, 1);
    check_wind(MSPRING_SOLVER_DIRECT, 2);
    check_wind((mspring_solver)EULER, 3);
}

/// A stage that gives forces keeps a step from being idle: who sleeps feels it.
static void wind_wakes(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    (void)support_particle(builder, 0, 0, 1);
    mspring_network_def def = support_def(0, 1);
    def.settings.sleep_speed = 0.1f;
    def.settings.sleep_time = 0.1f;
    mspring_network *network = support_network(builder, &def);
    check_ok(mspringi_field_reserve(network, &network->forces.base));
    support_fall_asleep(network, DT);
    house_wind_force = 100;
    support_steps(network, 1, DT);
    house_wind_force = 0;
    assert_false(support_is_asleep(network));
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solver_is_chosen_and_runs),
        cmocka_unit_test(solver_goes_along),
        cmocka_unit_test(wind_blows),
        cmocka_unit_test(wind_wakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
