/// @file test_physics.c
/// The scheme against closed forms: what leapfrog, as massspring.h writes it down, must do exactly. Velocities belong
/// to half a substep ago; those that a network begins with, to the beginning, so that its first substep takes them
/// on by half of its length.
///
/// Tolerances are bounds of rounding: each operation rounds a float by at most half an ulp, 2^-24 of its size.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "recipe.h"
#include "support.h"

#define HALF_ULP 0x1p-24 ///< of a float of size 1
static const double pi = 3.14159265358979323846;

/* ---------------------------------------------------------------------------------------- one oscillator */

/// A particle on a spring of 1 m whose other end is pinned, stretched along a direction.
typedef struct oscillator {
    double mass, stiffness, damping, global_damping;
    double h;
    double stretch;                  ///< m, at the start
    double direction_x, direction_y; ///< of length 1
} oscillator;

/// One substep takes stretch x and speed v to
///     v' = decay (v - (k x + c v) h / m),   x' = x + v' h
/// which is a 2x2 matrix with trace T and determinant D. While T^2 < 4 D its powers turn by theta and shrink by
/// sqrt(D) each: x_n = D^(n/2) (x_0 cos(n theta) + s sin(n theta)). The first substep's kick, of h / 2, sets s: to 0
/// without any damping.
static void check_oscillator(oscillator o, uint32_t steps) {
    mspring_builder *builder = support_builder();
    mspring_spring_def spring;
    support_pinned(builder, 0, 0, 1);
    support_particle(builder, o.direction_x * (1 + o.stretch), o.direction_y * (1 + o.stretch), (float)o.mass);
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.a = 0;
    spring.b = 1;
    spring.stiffness = (float)o.stiffness;
    spring.damping = (float)o.damping;
    spring.rest_length = 1;
    check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    mspring_network_def def = support_def(0, 1);
    def.settings.global_damping = (float)o.global_damping;
    mspring_network *network = support_network(builder, &def);

    const double decay = exp(-o.global_damping * o.h);
    const double gain = o.global_damping > 0 ? (1 - decay) / o.global_damping : o.h;
    const double keep = decay - gain * o.damping / o.mass, kick = gain * o.stiffness / o.mass;
    const double trace = 1 - kick * o.h + keep, determinant = keep;
    const double theta = acos(trace / 2 / sqrt(determinant));
    // From x_1, reached from rest with the kick of half a substep.
    const double half_gain =
        o.global_damping > 0 ? (1 - exp(-o.global_damping * o.h / 2)) / o.global_damping : o.h / 2;
    const double x1 = o.stretch * (1 - half_gain * o.stiffness / o.mass * o.h);
    const double s = (x1 / sqrt(determinant) - o.stretch * cos(theta)) / sin(theta);

    // What a substep adds in error at most: the new position, 1 to 2 m, is rounded once in each coordinate, which
    // swings on with 1 / cos(theta / 2) of that; the length, five times, which enters the velocity by omega^2 h;
    // the velocity, up to omega / 4 m/s, four times. An error in velocity swings on with h / sin(theta) of it.
    const double omega_h = sqrt(o.stiffness / o.mass) * o.h;
    const double per_substep = HALF_ULP * (2 / cos(theta / 2) + (6 * omega_h * omega_h + omega_h) / sin(theta));

    uint32_t crossings = 0, counted = 0;
    double last = o.stretch;
    for (uint32_t n = 1; n <= steps; n++) {
        check_ok(mspring_network_step(network, o.h));
        support_point p = support_position(network, 1);
        double x = p.x * o.direction_x + p.y * o.direction_y - 1;
        double exact = pow(determinant, n / 2.0) * (o.stretch * cos(n * theta) + s * sin(n * theta));
        double bound = (n + 1) * per_substep;
        if (!(fabs(x - exact) <= bound)) {
            print_error("k %g c %g global %g h %g, substep %u\n", o.stiffness, o.damping, o.global_damping, o.h, n);
        }
        check_near(x, exact, bound);
        check_near(p.x * o.direction_y - p.y * o.direction_x, 0, bound); // stays on its line
        if (pow(determinant, n / 2.0) * fabs(o.stretch) > 10 * bound) {  // while there is a swing to see
            crossings += (x < 0) != (last < 0);
            counted = n;
        }
        last = x;
    }
    // As many half periods as the turning angle has it, but for one begun and one not ended.
    check_near(crossings, counted * theta / pi, 1.01);
    assert_true(crossings >= 3);
    mspring_network_destroy(network);
}

static void undamped_oscillator_has_the_schemes_period(void **state) {
    (void)state;
    // omega h from 0.01 (hardly any error of the scheme) to 1.9 (near the limit of stability at 2).
    const double omega_h[] = {0.01, 0.1, 0.5, 1.0, 1.5, 1.9};
    for (size_t i = 0; i < COUNT_OF(omega_h); i++) {
        oscillator o = {.mass = 2, .h = 1.0 / 64, .stretch = 0.25, .direction_x = 1};
        o.stiffness = (double)(float)(o.mass * omega_h[i] * omega_h[i] / (o.h * o.h));
        check_oscillator(o, 2000);
        // For no damping the formula is that of the article: cos(theta) = 1 - (omega h)^2 / 2.
        check_near(1 - o.stiffness / o.mass * o.h * o.h / 2, cos(2 * asin(omega_h[i] / 2)), 1e-6); // k is a float
    }
}

static void oscillator_works_in_every_direction(void **state) {
    (void)state;
    for (int i = 0; i < 16; i++) {
        oscillator o = {.mass = 3, .stiffness = 700, .h = 0.015625, .stretch = -0.2};
        o.direction_x = cos(2 * pi * i / 16);
        o.direction_y = sin(2 * pi * i / 16);
        check_oscillator(o, 300);
    }
}

static void dampers_make_the_amplitude_decay(void **state) {
    (void)state;
    const double damping[] = {0.01, 1, 10, 40};
    for (size_t i = 0; i < COUNT_OF(damping); i++) {
        oscillator o = {.mass = 2, .stiffness = 800, .h = 0.015625, .stretch = 0.25, .direction_x = 1};
        o.damping = (double)(float)damping[i];
        check_oscillator(o, 500);
        o.global_damping = 0.5;
        check_oscillator(o, 500);
    }
}

static void global_damping_makes_the_amplitude_decay(void **state) {
    (void)state;
    const double rates[] = {0.001, 0.125, 1, 20};
    for (size_t i = 0; i < COUNT_OF(rates); i++) {
        oscillator o = {.mass = 2, .stiffness = 800, .h = 0.015625, .stretch = 0.25, .direction_y = 1};
        o.global_damping = (double)(float)rates[i];
        check_oscillator(o, 500);
    }
}

/* ---------------------------------------------------------------------------------------------- free motion */

static void free_fall_is_exact(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_particle_def particle;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    particle.x = 3;
    particle.y = 1000;
    particle.vx = 2;
    particle.vy = 10;
    check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.gravity_x = 0.5f;
    mspring_network *network = support_network(builder, &def);
    const double h = 0.01 / 4, gx = 0.5, gy = (double)-9.8f;
    for (uint32_t step = 1; step <= 2000; step++) {
        check_ok(mspring_network_step(network, 0.01));
        double n = 4.0 * step;
        support_point p = support_position(network, 0), v = support_velocity(network, 0);
        // n roundings of a velocity v, each lasting for the rest of the time; n of a position of up to 128 m from
        // the local origin. Velocities are those of half a substep ago; positions are exact.
        double v_bound = (n + 2) * HALF_ULP * (fabs(gy) * n * h + 10),
               p_bound = v_bound * n * h + n * 128 * HALF_ULP;
        check_near(v.x, 2 + (n - 0.5) * h * gx, v_bound);
        check_near(v.y, 10 + (n - 0.5) * h * gy, v_bound);
        check_near(p.x, 3 + n * h * 2 + h * h * gx * n * n / 2, p_bound);
        check_near(p.y, 1000 + n * h * 10 + h * h * gy * n * n / 2, p_bound);
    }
    mspring_network_destroy(network);
}

static void global_damping_is_exact_whatever_the_step(void **state) {
    (void)state;
    const uint32_t substeps[] = {1, 2, 64, 1000};
    const float rates[] = {0.01f, 1, 30};
    for (size_t i = 0; i < COUNT_OF(substeps); i++) {
        for (size_t j = 0; j < COUNT_OF(rates); j++) {
            mspring_builder *builder = support_builder();
            mspring_particle_def particle;
            check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
            particle.vx = 3;
            particle.vy = -4;
            check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
            mspring_network_def def = support_def(0, substeps[i]);
            def.settings.global_damping = rates[j];
            mspring_network *network = support_network(builder, &def);
            support_steps(network, 1, 1);
            // The first substep damps for half of its length: until then velocities are those of the beginning.
            const double rate = (double)rates[j], h = 1.0 / substeps[i];
            const double left = exp(-rate * (1 - h / 2)), kept = exp(-rate * h), kept_first = exp(-rate * h / 2);
            // In each substep a rounding of the difference, and two of what is lost; and that of the substep's
            // length, by which all of them are wrong together.
            const double bound = left * HALF_ULP *
                                 (1 + 2 * (1 - kept_first) / kept_first +
                                  (substeps[i] - 1) * (1 + 2 * (1 - kept) / kept) + rate + 1);
            check_near(support_velocity(network, 0).x, 3 * left, 3 * bound);
            check_near(support_velocity(network, 0).y, -4 * left, 4 * bound);
            mspring_network_destroy(network);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- conservation */

/// A square with diagonals that spins and flies, without anything around it.
static mspring_network *spinning_square(double stiffness, double damping) {
    mspring_builder *builder = support_builder();
    const double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const float masses[] = {1, 2, 3, 4};
    for (int i = 0; i < 4; i++) {
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        particle.x = corners[i][0];
        particle.y = corners[i][1];
        particle.vx = (float)(0.5 - 3 * (corners[i][1] - 0.5));
        particle.vy = (float)(-0.25 + 3 * (corners[i][0] - 0.5));
        particle.mass = masses[i];
        check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    }
    for (mspring_id a = 0; a < 4; a++) {
        for (mspring_id b = 0; b < a; b++) {
            support_spring(builder, a, b, (float)stiffness, (float)damping);
        }
    }
    mspring_network_def def = support_def(0, 1);
    return support_network(builder, &def);
}

static void momentum_is_conserved(void **state) {
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        mspring_network *network = spinning_square(2000, damped ? 5 : 0);
        double px, py, angular, px_now, py_now, angular_now;
        check_ok(support_get_momentum(network, &px, &py, &angular));
        // By hand: masses 1 to 4 at the corners.
        check_near(px, 0.5 * 10 - 3 * (-0.5 * 3 + 0.5 * 7), 1e-6); // velocities are floats
        check_near(py, -0.25 * 10 + 3 * (-0.5 * 5 + 0.5 * 5), 1e-6);
        const uint32_t steps = 4000;
        support_steps(network, steps, 1.0 / 256);
        check_ok(support_get_momentum(network, &px_now, &py_now, &angular_now));
        // Forces come in equal pairs and pass through both ends, so only roundings are left. A substep rounds the
        // velocities (up to 4 m/s, 10 kg in all) three times; the square flies 10 m, which is their lever.
        const double bound = steps * 3 * 10 * 4 * HALF_ULP;
        check_near(px_now, px, bound);
        check_near(py_now, py, bound);
        check_near(angular_now, angular, 10 * bound);
        // Had one force of a pair been forgotten, the springs' impulses of over 100 N s would show.
        assert_true(bound < 0.1);
        mspring_network_destroy(network);
    }
}

static void energy_has_no_trend(void **state) {
    (void)state;
    // Leapfrog keeps a modified energy, so the true one swings by O(omega h) but goes nowhere.
    mspring_network *network = spinning_square(2000, 0);
    enum { WINDOWS = 10, STEPS = 6400 };
    double kinetic, elastic, mean[WINDOWS] = {0}, low = INFINITY, high = 0;
    for (int window = 0; window < WINDOWS; window++) {
        for (int step = 0; step < STEPS; step++) {
            check_ok(mspring_network_step(network, 1.0 / 256));
            check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
            mean[window] += (kinetic + elastic) / STEPS;
            low = fmin(low, kinetic + elastic);
            high = fmax(high, kinetic + elastic);
        }
    }
    // omega h is at most 0.45 here (omega^2 <= 4 k / m_lightest in the stiffest mode), so a swing of half the
    // energy would be wrong; and over 250 s the mean of 25 s stays within 0.2 %: rounding adds a random walk of
    // 64,000 steps of about 1e-7, 3e-5, and the windows do not hold whole numbers of periods.
    assert_true(high - low < 0.5 * mean[0]);
    for (int window = 1; window < WINDOWS; window++) {
        check_near(mean[window] / mean[0], 1, 0.002);
    }
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------- pinned */

static void pinned_particles_keep_their_velocity(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 1);
    support_pinned(builder, 2, 0, 1);
    support_particle(builder, 1, 1, 1);
    support_spring(builder, 0, 1, 1000, 10);
    support_spring(builder, 1, 2, 1000, 10);
    support_spring(builder, 2, 0, 1000, 10);
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.global_damping = 1;
    mspring_network *network = support_network(builder, &def);
    support_steps(network, 100, 1.0 / 64);
    for (mspring_id id = 0; id < 2; id++) {
        support_point p = support_position(network, id), v = support_velocity(network, id);
        assert_true(p.x == 2 * id && p.y == 0 && v.x == 0 && v.y == 0);
    }
    assert_true(support_position(network, 2).y < 1); // the third fell

    // 0.5 m/s in substeps of 1/256 s: exact in binary. Gravity, springs and global damping do not touch it.
    const float vx[] = {0.5f, 0}, vy[] = {0, -0.25f};
    check_ok(mspring_network_set_velocities(network, NULL, 0, 2, vx, vy, 1));
    support_steps(network, 128, 1.0 / 64);
    assert_true(support_position(network, 0).x == 1 && support_position(network, 0).y == 0);
    assert_true(support_position(network, 1).x == 2 && support_position(network, 1).y == -0.5);
    assert_true(support_velocity(network, 0).x == 0.5 && support_velocity(network, 1).y == -0.25);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------ coincidence */

static void particles_in_one_place_exert_no_force(void **state) {
    (void)state;
    // As a strand, as a leftover spring, and within a lattice: wherever a spring may be computed.
    for (int kind = 0; kind < 3; kind++) {
        uint64_t seed = 1;
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1000, 1000}, .damping = {5, 5}};
        recipe made = {0};
        mspring_id a, b;
        if (kind == 0) {
            a = recipe_particle(&made, 1, 1, 1, 0);
            b = recipe_particle(&made, 2, 1, 1, 0);
            recipe_spring(&made, a, b, 1000, 5, 0);
        } else {
            recipe_lattice(&made, 5, 5, 0, 0, 1, &stuff, &seed);
            a = kind == 1 ? 0 : 12;
            b = kind == 1 ? 24 : 13;
            if (kind == 1) {
                recipe_spring(&made, a, b, 1000, 5, 0);
            }
        }
        recipe_disturb(&made, 0, 0, &seed); // fixes the rest lengths
        mspring_network_def def = support_def(0, 1);
        mspring_network *network = recipe_network(&made, &def);
        support_point to = support_position(network, a);
        check_ok(mspring_network_set_positions(network, NULL, b, 1, &to.x, &to.y, 1));
        mspring_id spring = 0;
        support_spring_info info;
        do {
            check_ok(support_get_spring(network, spring++, &info));
        } while (info.a != a || info.b != b);
        assert_true(info.length == 0 && info.force == 0 && info.strain == -1);
        check_ok(mspring_network_step(network, 1.0 / 64));
        if (kind == 0) {
            assert_true(support_velocity(network, a).x == 0 && support_velocity(network, a).y == 0);
            assert_true(support_velocity(network, b).x == 0 && support_velocity(network, b).y == 0);
        }
        support_steps(network, 100, 1.0 / 64);
        for (mspring_id id = 0; id < made.particle_count; id++) {
            assert_true(isfinite(support_position(network, id).x) && isfinite(support_velocity(network, id).y));
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void what_is_damped_comes_to_rest(void **state) {
    (void)state;
    // exp(-100 t): below the smallest normal number after 0.9 s, and at 0 once it is below 1e-30 m/s. What drifts
    // without damping drifts on, however slowly.
    for (int damped = 0; damped < 2; damped++) {
        mspring_builder *builder = support_builder();
        for (int i = 0; i < 40; i++) {
            support_particle(builder, i, 0, 1);
        }
        mspring_network_def def = support_def(0, 4);
        def.settings.global_damping = damped ? 100 : 0;
        mspring_network *network = support_network(builder, &def);
        float vx[40], vy[40];
        for (int i = 0; i < 40; i++) {
            vx[i] = damped ? 1 : 1e-40f;
            vy[i] = damped ? -3 : -1e-44f;
        }
        check_ok(mspring_network_set_velocities(network, NULL, 0, 40, vx, vy, 1));
        for (int step = 0; step < 200; step++) {
            support_steps(network, 1, 0.01);
            for (mspring_id id = 0; id < 40; id++) {
                const support_point v = support_velocity(network, id);
                assert_true(!damped || v.x == 0 || fabs(v.x) >= 1e-30);
                assert_true(!damped || v.y == 0 || fabs(v.y) >= 1e-30);
                assert_true(damped || (v.x == (double)vx[id] && v.y == (double)vy[id]));
            }
        }
        assert_true(support_velocity(network, 39).x == 0 || !damped);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(undamped_oscillator_has_the_schemes_period),
        cmocka_unit_test(oscillator_works_in_every_direction),
        cmocka_unit_test(dampers_make_the_amplitude_decay),
        cmocka_unit_test(global_damping_makes_the_amplitude_decay),
        cmocka_unit_test(free_fall_is_exact),
        cmocka_unit_test(global_damping_is_exact_whatever_the_step),
        cmocka_unit_test(momentum_is_conserved),
        cmocka_unit_test(energy_has_no_trend),
        cmocka_unit_test(pinned_particles_keep_their_velocity),
        cmocka_unit_test(particles_in_one_place_exert_no_force),
        cmocka_unit_test(what_is_damped_comes_to_rest),
    };
    return cmocka_run_group_tests_name("physics", tests, NULL, NULL);
}
