/// @file test_grips.c
/// What grips do: a damped oscillator about the target, a bounded force, momentum as reported, no energy from
/// nowhere.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

static const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
static const mspring_integrator integrators[] = {MSPRING_INTEGRATOR_ALPHA, MSPRING_INTEGRATOR_BDF2,
                                                 MSPRING_INTEGRATOR_EULER};

static mspring_grip_def grip_of(mspring_id particle, double x, double y, double stiffness, double damping) {
    mspring_grip_def def;
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &def, sizeof def));
    def.particle = particle;
    def.x = x;
    def.y = y;
    def.stiffness = (float)stiffness;
    def.damping = (float)damping;
    return def;
}

static void hold(mspring_network *network, mspring_id particle, double x, double y, double stiffness,
                 double damping) {
    const mspring_grip_def def = grip_of(particle, x, y, stiffness, damping);
    check_ok(mspring_network_add_grip(network, &def, NULL));
}

static support_point impulse_of(const mspring_network *network) {
    support_point impulse;
    check_ok(mspring_network_get_grip_impulse(network, 0, &impulse.x, &impulse.y));
    return impulse;
}

static void use_solver(mspring_network *network, mspring_solver solver, mspring_integrator integrator,
                       uint32_t substeps) {
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    def.solver = solver;
    def.integrator = solver == MSPRING_SOLVER_EXPLICIT ? MSPRING_INTEGRATOR_ALPHA : integrator;
    def.substeps = substeps;
    check_ok(support_set_solver(network, &def));
}

/* ------------------------------------------------------------------------------------------------- closed forms */

// How far a particle of 2 kg is from where a grip of 50 N/m and 4 N s/m has it after a second: 5 rad/s, 1/s.
static double oscillator_error(mspring_solver solver, bool has_spring, uint32_t substeps) {
    mspring_builder *builder = support_builder();
    const mspring_id p = support_particle(builder, 0, 0, 2);
    if (has_spring) // slack enough to do nothing but to be there
        (void)support_spring(builder, p, support_particle(builder, 3, 0, 1e-6f), 1e-6f, 0);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    use_solver(network, solver, MSPRING_INTEGRATOR_ALPHA, substeps);
    hold(network, p, 0.4, 0.3, 50, 4);
    support_steps(network, 64, DT);
    const double w = sqrt(25.0 - 1.0), left = exp(-1.0) * (cos(w) + sin(w) / w);
    const support_point is = support_position(network, p);
    mspring_network_destroy(network);
    return hypot(is.x - 0.4 * (1 - left), is.y - 0.3 * (1 - left));
}

/// Implicit Euler in the grip: the error is of first order.
static void particle_is_a_damped_oscillator(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        for (int has_spring = 0; has_spring < 2; has_spring++) {
            const double coarse = oscillator_error(solvers[i], has_spring, 1),
                         fine = oscillator_error(solvers[i], has_spring, 8);
            assert_true(coarse < 0.03);
            assert_true(fine < 0.17 * coarse || fine < 1e-4);
        }
    }
}

static mspring_network *bar(mspring_solver solver, uint32_t substeps, double stiffness, float gravity_y) {
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {stiffness, stiffness}, .damping = {0, 0}};
    uint64_t seed = 1;
    recipe made = {0};
    recipe_lattice(&made, 12, 3, 0, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(gravity_y, 1);
    def.settings.guard = MSPRING_GUARD_GROWTH;
    def.settings.global_damping = gravity_y != 0 ? 3.0f : 0.0f;
    mspring_network *network = recipe_network(&made, &def);
    use_solver(network, solver, MSPRING_INTEGRATOR_ALPHA, substeps);
    recipe_free(&made);
    return network;
}

static double mass_of(const mspring_network *network) {
    double sum = 0;
    for (mspring_id p = 0; p < mspring_network_count(network, MSPRING_PARTICLES); p++) {
        float mass;
        check_ok(mspring_network_get(network, MSPRING_MASS, NULL, p, 1, &mass, 1));
        sum += (double)mass;
    }
    return sum;
}

/// A light particle of a stiff body carries all of it: it is M g / k below the target, not its own share of that.
static void body_hangs_as_deep_as_its_weight_says(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        for (double k = 1e3; k < 1e9; k *= 100) {
            mspring_network *network = bar(solvers[i], solvers[i] == MSPRING_SOLVER_EXPLICIT ? 30 : 1, 1e5, -9.8f);
            const double mass = mass_of(network);
            const support_point at = support_position(network, 5);
            hold(network, 5, at.x, at.y, k, 2 * sqrt(k * mass));
            support_steps(network, 1500, DT);
            const support_point is = support_position(network, 5);
            const double deep = mass * 9.8 / k;
            check_near(is.x, at.x, 0.02 * deep + 2e-4);
            check_near(is.y, at.y - deep, 0.02 * deep + 2e-4);
            check_near(impulse_of(network).y, mass * 9.8 * DT, 0.02 * mass * 9.8 * DT);
            mspring_network_destroy(network);
        }
    }
}

/// A force that is less than what the grip would need is that force: v = F t / m.
static void force_is_bounded(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = bar(solvers[i], solvers[i] == MSPRING_SOLVER_EXPLICIT ? 30 : 2, 1e5, 0);
        const double mass = mass_of(network);
        mspring_grip_def def = grip_of(5, 3000, 4000, 1e7, 1e4);
        def.max_force = 100;
        check_ok(mspring_network_add_grip(network, &def, NULL));
        for (int step = 0; step < 50; step++) {
            support_steps(network, 1, DT);
            const support_point impulse = impulse_of(network);
            const double size = hypot(impulse.x, impulse.y);
            assert_true(size <= 100 * DT * (1 + 1e-6)); // a substep is a float
            check_near(size, 100 * DT, 1e-3 * 100 * DT);
            check_near(impulse.y / impulse.x, 4.0 / 3.0, 0.02);
        }
        double px, py, turn;
        check_ok(support_get_momentum(network, &px, &py, &turn));
        check_near(hypot(px, py), 50 * 100 * DT, 0.02 * 50 * 100 * DT);
        assert_true(mass > 30);
        mspring_network_destroy(network);
    }
}

/// What a grip says it gave is what the body has got.
static void momentum_is_the_impulse(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = bar(solvers[i], solvers[i] == MSPRING_SOLVER_EXPLICIT ? 30 : 2, 1e5, 0);
        if (solvers[i] != MSPRING_SOLVER_EXPLICIT)
            use_solver(network, solvers[i], MSPRING_INTEGRATOR_EULER, 2);
        support_point sum = {0, 0};
        hold(network, 5, 2, 3, 2000, 500);
        for (int step = 0; step < 100; step++) {
            check_ok(mspring_network_move_grip(network, 0, 2 + 0.02 * step, 3 - 0.01 * step));
            support_steps(network, 1, DT);
            sum.x += impulse_of(network).x;
            sum.y += impulse_of(network).y;
            double px, py, turn;
            check_ok(support_get_momentum(network, &px, &py, &turn));
            // Of some 300 N s: what iterations leave undone.
            const double tolerance = solvers[i] == MSPRING_SOLVER_IMPLICIT ? 1 : 1e-3;
            check_near(px, sum.x, tolerance);
            check_near(py, sum.y, tolerance);
        }
        mspring_network_destroy(network);
    }
}

/// A stiff grip takes its particle along with a target that moves evenly, with neither lag nor tremble.
static void particle_goes_with_the_target(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = bar(solvers[i], solvers[i] == MSPRING_SOLVER_EXPLICIT ? 30 : 4, 1e5, 0);
        const support_point at = support_position(network, 5);
        hold(network, 5, at.x, at.y, 1e8, 1e5);
        for (int step = 1; step <= 60; step++) {
            check_ok(mspring_network_move_grip(network, 0, at.x + 0.01 * step, at.y + 0.02 * step));
            support_steps(network, 1, DT);
            if (step < 20)
                continue;
            const support_point is = support_position(network, 5);
            check_near(is.x, at.x + 0.01 * step, 2e-3);
            check_near(is.y, at.y + 0.02 * step, 2e-3);
        }
        mspring_network_destroy(network);
    }
}

/* -------------------------------------------------------------------------------------------------------- energy
 */

static double energy_with_grip(const mspring_network *network, const mspring_grip_def *grip) {
    const support_point at = support_position(network, grip->particle);
    const double away = hypot(at.x - grip->x, at.y - grip->y), k = (double)grip->stiffness,
                 most = (double)grip->max_force;
    const double held = k * away <= most ? 0.5 * k * away * away : most * (away - 0.5 * most / k);
    return support_energy(network) + held;
}

typedef struct trial {
    mspring_network *network;
    mspring_grip_def grip;
    double dt;
    uint32_t substeps;
} trial;

// A lattice of 1e3 to 1e9 N/m, a grip of 1 to 1e10 N/m, steps of 1/240 to 1/4 s.
static trial make_trial(uint64_t seed) {
    trial made;
    const double mass = pow(10, support_random_between(&seed, -1, 2));
    const double stiffness = pow(10, support_random_between(&seed, 3, 9));
    const recipe_stuff stuff = {.mass = {mass, mass},
                                .stiffness = {stiffness, stiffness},
                                .pinned = support_random(&seed) % 4 == 0 ? 0.05 : 0};
    const uint32_t width = 2 + (uint32_t)(support_random(&seed) % 20),
                   height = 1 + (uint32_t)(support_random(&seed) % 8);
    recipe lattice = {0};
    recipe_lattice(&lattice, width, height, 0, 0, 1, &stuff, &seed);
    const mspring_network_def def = support_def(support_random(&seed) % 2 ? -9.8f : 0.0f, 1);
    made.network = recipe_network(&lattice, &def);
    made.dt = pow(10, support_random_between(&seed, log10(1.0 / 240), log10(0.25)));
    made.substeps = 1 + (uint32_t)(support_random(&seed) % 3);
    const mspring_id p = (mspring_id)(support_random(&seed) % lattice.particle_count);
    const double k = pow(10, support_random_between(&seed, 0, 10)), all = mass * lattice.particle_count;
    const support_point at = support_position(made.network, p);
    made.grip = grip_of(p, at.x + support_random_between(&seed, -2, 2), at.y + support_random_between(&seed, -2, 2),
                        k, support_random(&seed) % 2 ? 2 * sqrt(k * all) : 0);
    if (support_random(&seed) % 2)
        made.grip.max_force = (float)(k * pow(10, support_random_between(&seed, -2, 0.5)));
    check_ok(mspring_network_add_grip(made.network, &made.grip, NULL));
    recipe_free(&lattice);
    return made;
}

/// The grip is as a spring to a place: with its energy there is never more than there was.
static void resting_target_gives_no_energy(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= ROUNDS(60); seed++) {
        for (size_t i = 1; i < COUNT_OF(solvers); i++) {
            trial t = make_trial(seed);
            use_solver(t.network, solvers[i], integrators[seed % COUNT_OF(integrators)], t.substeps);
            const double before = energy_with_grip(t.network, &t.grip),
                         in_play = before - support_energy(t.network);
            for (int step = 0; step < 60; step++) {
                check_ok(mspring_network_step(t.network, t.dt));
                const support_point impulse = impulse_of(t.network);
                assert_true(hypot(impulse.x, impulse.y) <= (double)t.grip.max_force * t.dt * (1 + 1e-6));
                const double now = energy_with_grip(t.network, &t.grip);
                assert_true(now <= before + 1e-4 * (in_play + fabs(before)));
            }
            mspring_network_destroy(t.network);
        }
    }
}

/// No grip makes a step fail that would not without, however stiff it is: with clamped steps, too.
static void explicit_steps_bear_any_grip(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= ROUNDS(40); seed++) {
        trial t = make_trial(seed);
        check_ok(support_set_guard(t.network, MSPRING_GUARD_CLAMP));
        use_solver(t.network, MSPRING_SOLVER_EXPLICIT, 0, 10);
        support_steps(t.network, 60, t.dt);
        mspring_network_destroy(t.network);
    }
}

/// A chain at 0.9 of its border, where a spring of that stiffness would be far beyond it.
static void explicit_border_stays_where_it_is(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_id last = support_particle(builder, 0, 0, 1);
    for (int i = 1; i < 20; i++) {
        const mspring_id next = support_particle(builder, i, 0, 1);
        (void)support_spring(builder, last, next, 1000, 0);
        last = next;
    }
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    double now;
    check_ok(mspring_network_get_stable_dt(network, &now, NULL));
    const support_point at = support_position(network, last);
    hold(network, last, at.x + 0.05, at.y, 1e9, 0);
    support_steps(network, 2000, 0.9 * now);
    // At most what the pull has given: 0.05 m / h of 1 kg.
    const double speed = 0.05 / (0.9 * now);
    assert_true(support_energy_of_motion(network) < 4 * 0.5 * speed * speed);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------------------- others
 */

/// Into the ground: the particle stays on it, and the ground bears the force.
static void floor_stops_what_a_grip_pulls(void **state) {
    (void)state;
    const double plane[] = {0, -1, 0, 1};
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        for (int is_alone = 0; is_alone < 2; is_alone++) {
            mspring_builder *builder = support_builder();
            const mspring_id p = support_particle(builder, 0, 0, 1);
            if (!is_alone)
                (void)support_spring(builder, p, support_particle(builder, 0, 1, 1), 1000, 10);
            const mspring_network_def def = support_def(0, 1);
            mspring_network *network = support_network(builder, &def);
            use_solver(network, solvers[i], MSPRING_INTEGRATOR_ALPHA, 8);
            mspring_floor_def floor;
            check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
            floor.planes = plane;
            floor.plane_count = 1;
            check_ok(mspring_network_set_floor(network, &floor));
            mspring_grip_def grip = grip_of(p, 0, -5, 1e4, 20);
            grip.max_force = 50;
            check_ok(mspring_network_add_grip(network, &grip, NULL));
            for (int step = 0; step < 300; step++) {
                support_steps(network, 1, DT);
                assert_true(support_position(network, p).y > -1.0 - 1e-3);
            }
            float x, y;
            check_near(support_position(network, p).y, -1, 0.02);
            check_ok(mspring_network_get_columns(network, NULL, p, 1, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}}, 2));
            check_near((double)y, 50 * DT, 0.1 * 50 * DT);
            mspring_network_destroy(network);
        }
    }
}

/// Eight fingers on one sheet, which all hold.
static void many_grips_hold_at_once(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = bar(solvers[i], solvers[i] == MSPRING_SOLVER_EXPLICIT ? 30 : 2, 1e4, -9.8f);
        for (uint32_t number = 0; number < 8; number++) {
            const support_point at = support_position(network, 4 * number);
            mspring_grip_def grip = grip_of(4 * number, at.x, at.y, 1e5, 1e3);
            check_ok(mspring_network_add_grip(network, &grip, NULL));
        }
        support_steps(network, 300, DT);
        for (uint32_t number = 0; number < 8; number++) {
            mspring_grip_def grip = {.struct_size = sizeof grip};
            check_ok(mspring_network_get_grip(network, number, &grip));
            const support_point is = support_position(network, grip.particle);
            check_near(is.x, grip.x, 0.01);
            check_near(is.y, grip.y, 0.01);
        }
        mspring_network_destroy(network);
    }
}

// Grips of all stiffnesses on one particle, at rest at first: kinetic energy and that of their springs never rise.
static void several_grips_on_one_particle_give_no_energy(void **state) {
    (void)state;
    uint64_t seed = 41;
    for (uint32_t round = 0; round < 600; round++) {
        mspring_builder *builder = support_builder();
        const mspring_id p = support_particle(builder, 0, 0, 1);
        const mspring_network_def def = support_def(0, 1 + round % 4);
        mspring_network *network = support_network(builder, &def);
        use_solver(network, solvers[round % 3], integrators[round / 3 % 3], 1 + round % 4);
        double x[4], y[4], stiffness[4], start = 0;
        const uint32_t count = 2 + round % 3;
        for (uint32_t i = 0; i < count; i++) {
            x[i] = support_random_between(&seed, -1, 1);
            y[i] = support_random_between(&seed, -1, 1);
            stiffness[i] = (double)(float)pow(10, support_random_between(&seed, -2, 12));
            const double damping = i % 2 ? 0 : pow(10, support_random_between(&seed, -2, 12));
            hold(network, p, x[i], y[i], stiffness[i], damping);
            start += 0.5 * stiffness[i] * (x[i] * x[i] + y[i] * y[i]);
        }
        for (uint32_t step = 0; step < 60; step++) {
            double at_x, at_y, energy;
            support_steps(network, 1, support_random_between(&seed, 1e-3, 0.2));
            check_ok(mspring_network_get_positions(network, NULL, p, 1, &at_x, &at_y, 1));
            check_ok(support_get_energy(network, &energy, NULL, NULL));
            for (uint32_t i = 0; i < count; i++)
                energy += 0.5 * stiffness[i] * ((x[i] - at_x) * (x[i] - at_x) + (y[i] - at_y) * (y[i] - at_y));
            // Positions are floats: 6e-8 of the way, with the force on it.
            assert_true(energy <= start * (1 + 1e-6));
        }
        // What they report is the change of its momentum.
        float vx, vy, was_x, was_y;
        check_ok(mspring_network_get_velocities(network, NULL, p, 1, &was_x, &was_y, 1));
        support_steps(network, 1, DT);
        check_ok(mspring_network_get_velocities(network, NULL, p, 1, &vx, &vy, 1));
        double off_x = (double)was_x - (double)vx, off_y = (double)was_y - (double)vy, scale = 0;
        for (uint32_t i = 0; i < count; i++) {
            double px, py;
            check_ok(mspring_network_get_grip_impulse(network, i, &px, &py));
            off_x += px, off_y += py;
            scale += hypot(px, py);
        }
        assert_true(hypot(off_x, off_y) <= 1e-6 * (scale + hypot((double)was_x, (double)was_y)));
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(particle_is_a_damped_oscillator),
        cmocka_unit_test(body_hangs_as_deep_as_its_weight_says),
        cmocka_unit_test(force_is_bounded),
        cmocka_unit_test(momentum_is_the_impulse),
        cmocka_unit_test(particle_goes_with_the_target),
        cmocka_unit_test(resting_target_gives_no_energy),
        cmocka_unit_test(explicit_steps_bear_any_grip),
        cmocka_unit_test(explicit_border_stays_where_it_is),
        cmocka_unit_test(floor_stops_what_a_grip_pulls),
        cmocka_unit_test(many_grips_hold_at_once),
        cmocka_unit_test(several_grips_on_one_particle_give_no_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
