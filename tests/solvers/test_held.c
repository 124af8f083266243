/// @file test_held.c
/// Implicit and direct solver, with what holds a body: pins that move do no work in their own frame, and the
/// floor's impulses are what a body's momentum lacks, however stiff it is.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

static const double g = 9.8, lengths[] = {1.0 / 240, 1.0 / 64, 0.1, 0.25}, stiffnesses[] = {1e4, 1e7, 1e10};

enum { COLUMNS = 6, ROWS = 3, MASS = 8 };

static recipe lattice(double height, double stiffness) {
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {MASS, MASS}, .stiffness = {stiffness, stiffness}};
    recipe made = {0};
    recipe_lattice(&made, COLUMNS, ROWS, 0, height, 1, &stuff, &seed);
    return made;
}

static mspring_network *network_of(const recipe *made, mspring_solver which, mspring_integrator integrator) {
    mspring_network_def def = support_def((float)-g, 1);
    def.settings.guard = support_guard_of(which);
    return recipe_solved(made, &def, which, integrator);
}

/// Energy in a frame that moves at (ux, uy) and has gone so far up, J.
static double energy_in(const recipe *made, const mspring_network *network, double ux, double uy, double up) {
    double sum = 0;
    for (mspring_id i = 0; i < made->particle_count; i++) {
        const support_point at = support_position(network, i), v = support_velocity(network, i);
        const double vx = v.x - ux, vy = v.y - uy;
        sum += (made->particles[i].flags != 0 ? 0 : MASS) * (0.5 * (vx * vx + vy * vy) + g * (at.y - up));
    }
    for (mspring_id i = 0; i < made->spring_count; i++) {
        const mspring_spring_def *s = &made->springs[i];
        const support_point a = support_position(network, s->a), b = support_position(network, s->b);
        const mspring_particle_def *from = &made->particles[s->a], *to = &made->particles[s->b];
        const double rest = (double)(float)hypot(to->x - from->x, to->y - from->y);
        const double longer = hypot(b.x - a.x, b.y - a.y) - rest;
        sum += 0.5 * (double)s->stiffness * longer * longer;
    }
    return sum;
}

/// Not even by as little as a sum with any other coordinate would hide: the pin is in the middle, at the origin.
static void a_pin_at_the_origin_stays(void **state) {
    (void)state;
    const mspring_solver solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
    for (uint32_t i = 0; i < COUNT_OF(solvers) * COUNT_OF(stiffnesses); i++) {
        uint64_t seed = 1;
        const double stiffness = stiffnesses[i / COUNT_OF(solvers)];
        const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {stiffness, stiffness}};
        recipe made = {0};
        recipe_lattice(&made, 3, 3, -1, -1, 1, &stuff, &seed);
        made.particles[4].flags = MSPRING_PARTICLE_PINNED;
        mspring_network *network = network_of(&made, solvers[i % COUNT_OF(solvers)], MSPRING_INTEGRATOR_EULER);
        for (int step = 0; step < 5; step++) {
            support_steps(network, 1, 1.0 / 64);
            const support_point at = support_position(network, 4), v = support_velocity(network, 4);
            assert_true(at.x == 0 && at.y == 0 && v.x == 0 && v.y == 0);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Pins set off at once with a lattice that is at rest: it has the energy of its own speed in their frame, no more.
static void moving_pins_give_nothing(void **state) {
    (void)state;
    const double ux = 3, uy = 1;
    for (uint32_t i = 0; i < 2 * 3 * COUNT_OF(lengths) * COUNT_OF(stiffnesses); i++) {
        const double dt = lengths[i / 6 % COUNT_OF(lengths)], stiffness = stiffnesses[i / 6 / COUNT_OF(lengths)];
        recipe made = lattice(0, stiffness);
        for (mspring_id p = 0; p < made.particle_count; p += COLUMNS) {
            made.particles[p].flags = MSPRING_PARTICLE_PINNED;
            made.particles[p].vx = (float)ux;
            made.particles[p].vy = (float)uy;
        }
        mspring_network *network = network_of(&made, i % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT,
                                              (mspring_integrator)(i / 2 % 3));
        const double first = energy_in(&made, network, ux, uy, 0);
        for (int step = 1; step <= 40; step++) {
            support_steps(network, 1, dt);
            const double now = energy_in(&made, network, ux, uy, uy * dt * step);
            // 1e-6 of what could move for each of up to 32 pieces of a substep, and the rounding of lengths.
            if (!(now <= first + 1e-3 * first + 1e-12 * stiffness)) {
                fail_msg("way %u, %g N/m, %g s: step %d has %g J, at first %g", i % 6, stiffness, dt, step, now,
                         first);
            }
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Momentum of a body that falls onto a floor: what gravity and the floor's impulses come to.
static void fall_on(const double *plane, float friction) {
    for (uint32_t i = 0; i < 2 * 3 * COUNT_OF(lengths) * COUNT_OF(stiffnesses); i++) {
        const double dt = lengths[i / 6 % COUNT_OF(lengths)], stiffness = stiffnesses[i / 6 / COUNT_OF(lengths)];
        recipe made = lattice(1, stiffness);
        mspring_network *network = network_of(&made, i % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT,
                                              (mspring_integrator)(i / 2 % 3));
        mspring_floor_def def;
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
        def.planes = plane;
        def.plane_count = 1;
        def.friction = friction;
        check_ok(mspring_network_set_floor(network, &def));
        double px = 0, py = 0;
        for (int step = 1; step <= 40; step++) {
            float fx[COLUMNS * ROWS], fy[COLUMNS * ROWS];
            double to_x = 0, to_y = 0, scale = MASS * COLUMNS * ROWS * g * dt;
            support_steps(network, 1, dt);
            check_ok(mspring_network_get_columns(network, NULL, 0, COLUMNS * ROWS, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, fx}, {MSPRING_FLOOR_IMPULSE_Y, 1, fy}}, 2));
            py -= MASS * COLUMNS * ROWS * g * dt;
            for (mspring_id p = 0; p < made.particle_count; p++) {
                const support_point v = support_velocity(network, p), at = support_position(network, p);
                const double above = plane[2] * (at.x - plane[0]) + plane[3] * (at.y - plane[1]);
                assert_true(above >= -1e-4); // some last places of a float
                to_x += MASS * v.x;
                to_y += MASS * v.y;
                px += (double)fx[p];
                py += (double)fy[p];
                scale += MASS * hypot(v.x, v.y) + fabs((double)fy[p]);
            }
            if (!(fabs(to_x - px) <= 2e-3 * scale && fabs(to_y - py) <= 2e-3 * scale)) {
                fail_msg("way %u, %g N/m, %g s: step %d has (%g, %g) kg m/s, not (%g, %g)", i % 6, stiffness, dt,
                         step, to_x, to_y, px, py);
            }
            px = to_x;
            py = to_y;
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void the_floor_gives_what_momentum_lacks(void **state) {
    (void)state;
    fall_on((const double[]){0, 0, 0.1, 1}, 0.3f);
    fall_on((const double[]){0, 0, 0, 1}, 0);
}

/// A pin stays where it is and at rest to the bit, at the origin, too, whatever pulls and pushes.
static void pins_do_not_move(void **state) {
    (void)state;
    for (uint32_t i = 0; i < 6; i++) {
        recipe made = lattice(0, 1e7);
        const mspring_id pins[] = {0, 7, made.particle_count - 1};
        for (size_t p = 0; p < COUNT_OF(pins); p++)
            made.particles[pins[p]].flags = MSPRING_PARTICLE_PINNED;
        mspring_network *network = network_of(&made, i % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT,
                                              (mspring_integrator)(i / 2));
        for (int step = 0; step < 10; step++) {
            for (mspring_id p = 0; p < made.particle_count; p++)
                check_ok(mspring_network_apply_force(network, p, 1e6f, -3e6f));
            support_steps(network, 1, 0.01);
        }
        for (size_t p = 0; p < COUNT_OF(pins); p++) {
            const support_point at = support_position(network, pins[p]), v = support_velocity(network, pins[p]);
            assert_true(at.x == made.particles[pins[p]].x && at.y == made.particles[pins[p]].y);
            assert_true(v.x == 0 && v.y == 0);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pin_at_the_origin_stays),
        cmocka_unit_test(moving_pins_give_nothing),
        cmocka_unit_test(the_floor_gives_what_momentum_lacks),
        cmocka_unit_test(pins_do_not_move),
    };
    return cmocka_run_group_tests_name("held", tests, NULL, NULL);
}
