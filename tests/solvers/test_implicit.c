/// @file test_implicit.c
/// The implicit and the direct solver against closed forms and against themselves with shorter steps.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "recipe.h"
#include "support.h"

static const mspring_integrator integrators[] = {MSPRING_INTEGRATOR_ALPHA, MSPRING_INTEGRATOR_BDF2,
                                                 MSPRING_INTEGRATOR_EULER};

/// Which of the two.
static mspring_solver tested = MSPRING_SOLVER_IMPLICIT;

static void use_implicit(mspring_network *network, mspring_integrator integrator, uint32_t iterations) {
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = tested;
    solver.integrator = integrator;
    solver.iterations = iterations;
    solver.residual = iterations > 0 ? 0 : solver.residual; // exactly these
    check_ok(support_set_solver(network, &solver));
}

static void use_explicit(mspring_network *network, uint32_t substeps) {
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.substeps = substeps;
    check_ok(support_set_solver(network, &solver));
}

/* -------------------------------------------------------------------------------------------------- the order */

/// Order of an error that goes from coarse to fine as the step is halved.
static double order_of(double coarse, double fine) {
    return log2(fabs(coarse) / fabs(fine));
}

static double least_order(mspring_integrator integrator) {
    // Implicit Euler comes near to 1 from below: its next error term has the other sign.
    return integrator == MSPRING_INTEGRATOR_EULER ? 0.85 : 1.8;
}

/// A particle on a spring along x, pulled out by 0.25 m, after a second in this many steps: how far it is off. With
/// `uneven` every second step is three times as long as the others.
static double oscillator_error(mspring_integrator integrator, double stiffness, double damping, double rate,
                               uint32_t steps, bool uneven) {
    const double mass = 2, out = 0.25;
    mspring_builder *builder = support_builder();
    mspring_id wall = support_pinned(builder, -1, 0, 1), ball = support_particle(builder, 0, 0, (float)mass);
    support_spring(builder, wall, ball, (float)stiffness, (float)damping);
    mspring_network_def def = support_def(0, 1);
    def.settings.global_damping = (float)rate;
    mspring_network *network = support_network(builder, &def);
    const double x = out, y = 0;
    check_ok(mspring_network_set_positions(network, NULL, ball, 1, &x, &y, 1));
    use_implicit(network, integrator, 0);
    for (uint32_t step = 0; step < steps; step++)
        support_steps(network, 1, (uneven ? 0.5 + step % 2 : 1.0) / steps);
    // x'' + 2 a x' + w0^2 x = 0 from rest at 0.25 m.
    const double a = damping / (2 * mass) + rate / 2, w = sqrt(stiffness / mass - a * a);
    const double expected = out * exp(-a) * (cos(w) + a / w * sin(w));
    const double expected_v = -out * exp(-a) * (a * a + w * w) / w * sin(w);
    // Together, as at some time the one or the other passes through 0.
    const double error =
        hypot(support_position(network, ball).x - expected, (support_velocity(network, ball).x - expected_v) / w);
    mspring_network_destroy(network);
    return error;
}

static const struct {
    double stiffness, damping, rate;
} cases[] = {{32, 0, 0}, {32, 3, 0}, {32, 0, 1.5}, {32, 2, 1}};

static void an_oscillator_keeps_its_order(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        for (size_t c = 0; c < COUNT_OF(cases); c++) {
            // About 100 and 200 steps a period: errors of 1e-3 and less of the amplitude, 100 times rounding.
            const double coarse =
                oscillator_error(integrators[i], cases[c].stiffness, cases[c].damping, cases[c].rate, 128, false);
            const double fine =
                oscillator_error(integrators[i], cases[c].stiffness, cases[c].damping, cases[c].rate, 256, false);
            const double order = order_of(coarse, fine);
            if (!(order >= least_order(integrators[i])))
                print_error("integrator %d, case %d: order %g (%g, %g)\n", (int)integrators[i], (int)c, order,
                            coarse, fine);
            assert_true(order >= least_order(integrators[i]));
        }
    }
}

/// Uneven steps leave an integrator of second order the first, but far less off than implicit Euler.
static void uneven_steps_are_accounted_for(void **state) {
    (void)state;
    for (size_t c = 0; c < COUNT_OF(cases); c++) {
        const double euler = oscillator_error(MSPRING_INTEGRATOR_EULER, cases[c].stiffness, cases[c].damping,
                                              cases[c].rate, 256, true);
        for (mspring_integrator i = MSPRING_INTEGRATOR_ALPHA; i < MSPRING_INTEGRATOR_EULER; i++)
            assert_true(oscillator_error(i, cases[c].stiffness, cases[c].damping, cases[c].rate, 256, true) <
                        0.2 * euler);
    }
}

/// A small truss that swings under gravity, with all that a network has: its state after a second.
static recipe swinging_truss(double damping) {
    uint64_t seed = 4;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {900, 1500}, .damping = {damping, damping}};
    recipe made = {0};
    recipe_lattice(&made, 6, 3, 0, 0, 1, &stuff, &seed);
    made.particles[0].flags = MSPRING_PARTICLE_PINNED;
    mspring_id weight = recipe_particle(&made, 9, 0, 3, 0);
    recipe_rope(&made, 5, weight, 4, &stuff, &seed);
    return made;
}

static void swing(mspring_integrator integrator, double damping, double rate, uint32_t steps, double *x) {
    recipe made = swinging_truss(damping);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.global_damping = (float)rate;
    mspring_network *network = recipe_network(&made, &def);
    use_implicit(network, integrator, 40);
    const float fx = 4, fy = 7;
    for (uint32_t step = 0; step < steps; step++) {
        check_ok(mspring_network_apply_force(network, 3, fx, fy));
        support_steps(network, 1, 0.5 / steps);
    }
    for (mspring_id id = 0; id < made.particle_count; id++) {
        support_point p = support_position(network, id);
        x[2 * id] = p.x;
        x[2 * id + 1] = p.y;
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void a_swinging_truss_keeps_its_order(void **state) {
    (void)state;
    enum { COUNT = 2 * 22, RUNS = 3 };
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        for (int damped = 0; damped < 2; damped++) {
            double x[RUNS][COUNT], coarse = 0, fine = 0;
            for (int run = 0; run < RUNS; run++)
                swing(integrators[i], damped ? 6 : 0, damped ? 0.5 : 0, 256u << run, x[run]);
            for (int n = 0; n < COUNT; n++) {
                coarse += (x[1][n] - x[0][n]) * (x[1][n] - x[0][n]);
                fine += (x[2][n] - x[1][n]) * (x[2][n] - x[1][n]);
            }
            const double order = order_of(sqrt(coarse), sqrt(fine));
            if (!(order >= least_order(integrators[i])))
                print_error("integrator %d, damped %d: order %g (%g, %g)\n", (int)integrators[i], damped, order,
                            sqrt(coarse), sqrt(fine));
            assert_true(order >= least_order(integrators[i]));
        }
    }
}

/* ------------------------------------------------------------------------------------------ simple motions */

static void free_flight_is_exact(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        mspring_builder *builder = support_builder();
        mspring_id ball = support_particle(builder, 0, 0, 5), pin = support_pinned(builder, 3, 0, 1);
        mspring_network_def def = support_def(-8, 1);
        mspring_network *network = support_network(builder, &def);
        use_implicit(network, integrators[i], 0);
        const float vx[] = {2, -1}, vy[] = {4, 0.5f};
        check_ok(mspring_network_set_velocities(network, NULL, 0, 2, vx, vy, 1));
        support_steps(network, 64, 1.0 / 64);
        // v is linear in time, and every method gets that. Position: the Euler step at the start, or all of them,
        // add g h^2 / 2 each.
        const double late = integrators[i] == MSPRING_INTEGRATOR_EULER ? 64 : 1;
        check_near(support_velocity(network, ball).y, 4 - 8, 1e-5);
        check_near(support_position(network, ball).x, 2, 1e-5);
        check_near(support_position(network, ball).y, 4 - 4 - late * 4 / 4096, 2e-5 + 1e-3 * (late < 2));
        check_near(support_position(network, pin).x, 2, 1e-5);
        check_near(support_position(network, pin).y, 0.5, 1e-5);
        mspring_network_destroy(network);
    }
}

static void global_damping_slows_free_flight(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        mspring_builder *builder = support_builder();
        mspring_id ball = support_particle(builder, 0, 0, 5);
        mspring_network_def def = support_def(0, 1);
        def.settings.global_damping = 3;
        mspring_network *network = support_network(builder, &def);
        use_implicit(network, integrators[i], 0);
        const float vx = 2, vy = 0;
        check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &vx, &vy, 1));
        support_steps(network, 256, 1.0 / 256);
        // The error in the rate is b h / 2 for implicit Euler and (b h)^2 / 3 for BDF2: 0.6 % or 0.005 % of 3/s.
        const double tolerance = integrators[i] == MSPRING_INTEGRATOR_EULER ? 0.02 : 0.0006;
        check_near(support_velocity(network, ball).x, 2 * exp(-3), 2 * exp(-3) * tolerance);
        mspring_network_destroy(network);
    }
}

/* ---------------------------------------------------------------------------------------------- one with all */

static double largest_move(const mspring_network *network, const support_point *from) {
    double largest = 0;
    for (mspring_id id = 0; id < mspring_network_count(network, MSPRING_PARTICLES); id++) {
        support_point p = support_position(network, id);
        largest = fmax(largest, hypot(p.x - from[id].x, p.y - from[id].y));
    }
    return largest;
}

static void solvers_change_without_a_kick(void **state) {
    (void)state;
    // At rest under gravity: nobody moves when the solver changes.
    recipe made = swinging_truss(20);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.global_damping = 2;
    mspring_network *network = recipe_network(&made, &def);
    use_implicit(network, MSPRING_INTEGRATOR_EULER, 40);
    support_steps(network, 6000, 1.0 / 64);
    support_point rest[64];
    for (mspring_id id = 0; id < made.particle_count; id++)
        rest[id] = support_position(network, id);
    check_ok(support_set_global_damping(network, 0));
    for (int round = 0; round < 20; round++) {
        use_explicit(network, 16);
        support_steps(network, 5, 1.0 / 64);
        use_implicit(network, integrators[round % 2], 40);
        support_steps(network, 5, round % 3 == 0 ? 1.0 / 64 : 1.0 / 100);
    }
    // What single precision leaves of forces at rest is 1e-6 of the springs' tension (100 N): 1e-4 N on a kg.
    assert_true(largest_move(network, rest) < 1e-4);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// In uniform motion through the origin's following and through changes of dt, springs at rest stay at rest.
static void a_flying_lattice_stays_what_it_is(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        uint64_t seed = 4;
        const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {1e7, 1e7}};
        recipe made = {0};
        recipe_lattice(&made, 9, 7, 0, 0, 1, &stuff, &seed);
        for (uint32_t p = 0; p < made.particle_count; p++) {
            made.particles[p].vx = 300;
            made.particles[p].vy = -200;
        }
        mspring_network_def def = support_def(0, 2);
        mspring_network *network = recipe_network(&made, &def);
        use_implicit(network, integrators[i], 0);
        for (uint32_t step = 0; step < 300; step++)
            support_steps(network, 1, step % 2 == 0 ? 1.0 / 64 : 1.0 / 128);
        float strain;
        check_ok(support_get_max_strain(network, &strain, NULL));
        // Positions of up to 64 m from the origin are rounded to 4e-6 m, springs are 1 m long.
        assert_true(strain < 3e-5f);
        check_near(support_position(network, 0).x, 300 * 150 * 3.0 / 128, 0.01);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void particles_without_springs_leave_the_others_alone(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        uint64_t seed = 3;
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e6, 1e6}};
        recipe made = {0};
        for (int j = 0; j < 30; j++) {
            const double x = support_random_between(&seed, 0, 6), y = support_random_between(&seed, 0, 6);
            recipe_particle(&made, x, y, 1, 0);
        }
        recipe_random_springs(&made, 80, &stuff, &seed);
        recipe_disturb(&made, 1e-3, 0, &seed);
        mspring_network_def def = support_def(-9.8f, 1);
        mspring_network *alone = recipe_network(&made, &def);
        const uint32_t count = made.particle_count;
        const mspring_id loose = recipe_particle(&made, 3, 3, 5, 0);
        made.particles[loose].vx = 2;
        mspring_network *together = recipe_network(&made, &def);
        use_implicit(alone, integrators[i], 0);
        use_implicit(together, integrators[i], 0);
        support_steps(alone, 20, 0.01);
        support_steps(together, 20, 0.01);
        for (mspring_id id = 0; id < count; id++) {
            const support_point a = support_position(alone, id), b = support_position(together, id);
            check_near(a.x, b.x, 0);
            check_near(a.y, b.y, 0);
        }
        // All integrators are exact to h in free fall.
        const support_point at = support_position(together, loose);
        check_near(at.x, 3 + 2 * 0.2, 1e-5);
        check_near(at.y, 3 - 9.8 * 0.2 * 0.2 / 2, 9.8 * 0.2 * 0.01);
        mspring_network_destroy(alone);
        mspring_network_destroy(together);
        recipe_free(&made);
    }
}

static void drag_first(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->particle_of_slot[slot] == 0) {
            args->x[slot] = (float)(5 - args->origin_x);
            args->y[slot] = (float)(1 - args->origin_y);
            args->vx[slot] = args->vy[slot] = 0;
        }
    }
}

static void push_second(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++)
        if (args->particle_of_slot[slot] == 1)
            args->force_y[slot] += 80;
}

/// Hooks hold one end of a spring and push at the other: it settles where the force balances it.
static void hooks_hold_and_push(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        for (mspring_phase phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_BEFORE_SUBSTEP; phase++) {
            mspring_builder *builder = support_builder();
            mspring_id a = support_particle(builder, 5, 1, 1e6f), b = support_particle(builder, 5, 3, 1);
            support_spring(builder, a, b, 400, 30);
            mspring_network_def def = support_def(0, 3);
            mspring_network *network = support_network(builder, &def);
            use_implicit(network, integrators[i], 0);
            check_ok(support_add_hook(network, phase, push_second, NULL, NULL));
            check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, drag_first, NULL, NULL));
            support_steps(network, 400, 1.0 / 64);
            // 80 N / 400 N/m. The held end, of 1000 t, is let go for a substep, in which 80 N do not move it.
            check_near(support_position(network, b).y, 3.2, 1e-5);
            mspring_network_destroy(network);
        }
    }
}

static void a_failed_step_leaves_the_history_alone(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        recipe made = swinging_truss(3);
        mspring_network_def def = support_def(-9.8f, 1);
        def.settings.max_speed = 50;
        mspring_network *network = recipe_network(&made, &def), *twin = recipe_network(&made, &def);
        use_implicit(network, integrators[i], 0);
        use_implicit(twin, integrators[i], 0);
        support_steps(network, 20, 1.0 / 64);
        support_steps(twin, 20, 1.0 / 64);
        for (int way = 0; way < 3; way++) {
            const float huge[] = {1e8f, 3e38f, 1e20f};
            check_ok(mspring_network_apply_force(network, 4, huge[way], huge[way]));
            check_error(mspring_network_step(network, 1.0 / 64), MSPRING_ERROR_UNSTABLE);
            assert_int_equal(support_hash(network), support_hash(twin));
            check_ok(mspring_network_apply_force(network, 4, -huge[way], -huge[way])); // the force is still there
            support_steps(network, 10, 1.0 / 64);
            support_steps(twin, 10, 1.0 / 64);
            assert_int_equal(support_hash(network), support_hash(twin));
        }
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
        recipe_free(&made);
    }
}

static void setting_all_positions_begins_a_new_motion(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        recipe made = swinging_truss(3);
        mspring_network *network = recipe_network(&made, NULL), *fresh = recipe_network(&made, NULL);
        use_implicit(network, integrators[i], 0);
        use_implicit(fresh, integrators[i], 0);
        support_steps(network, 33, 1.0 / 64);
        double x[64], y[64];
        float v[64] = {0};
        for (mspring_id id = 0; id < made.particle_count; id++) {
            x[id] = made.particles[id].x;
            y[id] = made.particles[id].y;
        }
        check_ok(mspring_network_set_positions(network, NULL, 0, made.particle_count, x, y, 1));
        check_ok(mspring_network_set_velocities(network, NULL, 0, made.particle_count, v, v, 1));
        support_steps(network, 10, 1.0 / 64);
        support_steps(fresh, 10, 1.0 / 64);
        assert_int_equal(support_hash(network), support_hash(fresh));
        mspring_network_destroy(network);
        mspring_network_destroy(fresh);
        recipe_free(&made);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_oscillator_keeps_its_order),
        cmocka_unit_test(uneven_steps_are_accounted_for),
        cmocka_unit_test(a_swinging_truss_keeps_its_order),
        cmocka_unit_test(free_flight_is_exact),
        cmocka_unit_test(global_damping_slows_free_flight),
        cmocka_unit_test(solvers_change_without_a_kick),
        cmocka_unit_test(a_flying_lattice_stays_what_it_is),
        cmocka_unit_test(particles_without_springs_leave_the_others_alone),
        cmocka_unit_test(hooks_hold_and_push),
        cmocka_unit_test(a_failed_step_leaves_the_history_alone),
        cmocka_unit_test(setting_all_positions_begins_a_new_motion),
    };
    const int failed = cmocka_run_group_tests_name("implicit", tests, NULL, NULL);
    tested = MSPRING_SOLVER_DIRECT;
    return failed + cmocka_run_group_tests_name("direct", tests, NULL, NULL);
}
