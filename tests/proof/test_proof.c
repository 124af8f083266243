/// @file test_proof.c
/// An element that the library does not have, a triangle with the energy of St. Venant and Kirchhoff, can be added
/// without changing it: triangle.c and triangle.h, and four lines of two tables, which stand in store/ before
/// the library's own. All solvers have it, and the stability limit, settling and energies. A wind takes
/// step/house/wind.c and two lines.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "house/wind.h"
#include "support.h"
#include "triangle.h"

enum { WIDTH = 5, HEIGHT = 3, PARTICLES = WIDTH * HEIGHT };

static const double DT = 1.0 / 64.0;

/// A strip of 16 triangles of 1 m and 2 kg a corner. Springs along their sides are so weak that triangles alone
/// hold it.
static mspring_network *strip(mspring_solver solver, mspring_simd level, uint32_t substeps, uint32_t workers,
                              float damping) {
    mspring_builder *builder = support_builder();
    for (int i = 0; i < PARTICLES; i++) {
        (void)support_particle(builder, i % WIDTH, i / WIDTH, 2);
    }
    for (mspring_id i = 0; i < PARTICLES; i++) {
        if (i % WIDTH + 1 < WIDTH) {
            (void)support_spring(builder, i, i + 1, 1, 0);
        }
        if (i + WIDTH < PARTICLES) {
            (void)support_spring(builder, i, i + WIDTH, 1, 0);
        }
        if (i % WIDTH + 1 < WIDTH && i + WIDTH < PARTICLES) {
            (void)support_spring(builder, i, i + WIDTH + 1, 1, 0);
        }
    }
    mspring_network_def def = support_def(0, substeps);
    def.settings.solver = solver;
    def.simd_level = level;
    def.worker_count = workers;
    def.settings.global_damping = damping;
    def.settings.iterations = 200; // of conjugate gradients: exact, but for rounding
    mspring_network *network = support_network(builder, &def);
    for (mspring_id i = 0; i < PARTICLES; i++) {
        if (i % WIDTH + 1 < WIDTH && i + WIDTH < PARTICLES) {
            proof_add_triangle(network, (const mspring_id[]){i, i + 1, i + WIDTH + 1}, 2000, 1000);
            proof_add_triangle(network, (const mspring_id[]){i, i + WIDTH + 1, i + WIDTH}, 2000, 1000);
        }
    }
    return network;
}

static void destroy(mspring_network *network) {
    proof_remove_triangles(network);
    mspring_network_destroy(network);
}

/// Stretch it by a tenth along x, and let it fly and turn.
static void stretch(mspring_network *network) {
    for (mspring_id i = 0; i < PARTICLES; i++) {
        const support_point p = support_position(network, i);
        const double x = 1.1 * p.x;
        const float vx = 3 - 0.5f * (float)p.y, vy = 1 + 0.5f * (float)p.x;
        check_ok(mspring_network_set_positions(network, NULL, i, 1, &x, &p.y, 1));
        check_ok(mspring_network_set_velocities(network, NULL, i, 1, &vx, &vy, 1));
    }
}

static double energy_of(const mspring_network *network) {
    double kinetic, elastic;
    check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
    return kinetic + elastic;
}

static void forces_are_gradients_of_the_energy(void **state) {
    (void)state;
    mspring_network *network = strip(MSPRING_SOLVER_EXPLICIT, MSPRING_SIMD_AUTO, 1, 1, 0);
    double at[3][2] = {{0.1, -0.2}, {1.3, 0.1}, {0.9, 1.2}};
    const proof_strains here = proof_strains_at(0, (const double(*)[2])at);
    for (int corner = 0; corner < 3; corner++) {
        for (int x = 0; x < 2; x++) {
            const double before = at[corner][x], step = 1e-6;
            at[corner][x] = before + step;
            const proof_strains above = proof_strains_at(0, (const double(*)[2])at);
            at[corner][x] = before - step;
            const proof_strains below = proof_strains_at(0, (const double(*)[2])at);
            at[corner][x] = before;
            for (int k = 0; k < PROOF_STRAINS; k++) {
                // Strains are quadratic, so differences are exact but for rounding: 1e-16 of 1 over 1e-6.
                check_near(here.gradient[k][corner][x], (above.size[k] - below.size[k]) / (2 * step), 1e-9);
            }
        }
    }
    // Uniform strain e along x: e^2 (l + 2 m) / 2 for each m^2, with Green's strain e.
    const double x = 4, green = 0.5 * (1.1 * 1.1 - 1);
    stretch(network);
    check_near(proof_energy(network), x * 2 * green * green * (2000 + 2 * 1000) / 2, 1e-3); // positions are floats
    destroy(network);
}

static void motion_is_that_of_short_substeps(void **state) {
    (void)state;
    support_point exact[PARTICLES];
    for (int solver = -1; solver <= (int)MSPRING_SOLVER_DIRECT; solver++) {
        const uint32_t substeps = solver < 0 ? 512 : 64;
        mspring_network *network =
            strip(solver < 0 ? MSPRING_SOLVER_EXPLICIT : (mspring_solver)solver, MSPRING_SIMD_AUTO, substeps, 1, 0);
        double px, py, angular, now_x, now_y, now_angular, worst = 0;
        stretch(network);
        check_ok(support_get_momentum(network, &px, &py, &angular));
        const double before = energy_of(network);
        support_steps(network, 24, DT); // two and a half oscillations along the strip
        check_ok(support_get_momentum(network, &now_x, &now_y, &now_angular));
        // Each substep rounds 15 velocities of 3 m/s and 2 kg to floats: 1e-6 N s at random, 1,536 times.
        check_near(now_x, px, 2e-4);
        check_near(now_y, py, 2e-4);
        check_near(now_angular, angular, 1e-5 * angular); // the same with arms of 5 m, of 100 N m s
        for (mspring_id i = 0; i < PARTICLES; i++) {
            const support_point p = support_position(network, i);
            exact[i] = solver < 0 ? p : exact[i];
            worst = fmax(worst, hypot(p.x - exact[i].x, p.y - exact[i].y));
        }
        print_message("solver %2d: off by %.2g m, energy %.5f of before\n", solver, worst,
                      energy_of(network) / before);
        // It stretches by 0.4 m. Second order in substeps of a two hundredth of the fastest period: some 1e-4 of
        // that, and of the energy.
        assert_true(worst < 5e-4);
        check_near(energy_of(network) / before, 1, 1e-3);
        destroy(network);
    }
}

/// A substep of any length is stable in a linear system, and loses energy only.
static void long_substeps_are_stable(void **state) {
    (void)state;
    for (int solver = (int)MSPRING_SOLVER_IMPLICIT; solver <= (int)MSPRING_SOLVER_DIRECT; solver++) {
        mspring_network *network = strip((mspring_solver)solver, MSPRING_SIMD_AUTO, 1, 1, 0);
        double px, py, now_x, now_y;
        stretch(network);
        check_ok(support_get_momentum(network, &px, &py, NULL));
        const double before = energy_of(network);
        for (int step = 0; step < 200; step++) {
            support_steps(network, 1, 1.0 / 8);
            assert_true(energy_of(network) < before * (1 + 1e-3));
        }
        check_ok(support_get_momentum(network, &now_x, &now_y, NULL));
        check_near(now_x, px, 2e-4);
        check_near(now_y, py, 2e-4);
        destroy(network);
    }
}

static void wind_and_triangles_go_together(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    for (int solver = 0; solver <= (int)MSPRING_SOLVER_DIRECT; solver++) {
        uint64_t first = 0;
        for (uint32_t i = 0; i < 2 * level_count; i++) {
            mspring_network *network = strip((mspring_solver)solver, levels[i / 2], 8, 1 + i % 2, 0.5f);
            double px, now_x;
            check_ok(mspringi_field_reserve(network, &network->forces.base));
            stretch(network);
            check_ok(support_get_momentum(network, &px, NULL, NULL));
            house_wind_force = 3;
            support_steps(network, 16, DT);
            house_wind_force = 0;
            check_ok(support_get_momentum(network, &now_x, NULL, NULL));
            // p' = F - b p over a quarter of a second; velocities of explicit steps are half a substep old.
            const double decay = exp(-0.5 * 0.25), all = 3.0 * PARTICLES;
            check_near(now_x, px * decay + all * (1 - decay) / 0.5, all * DT / 8);
            first = i == 0 ? support_hash(network) : first;
            assert_true(support_hash(network) == first); // at each level, with one and two workers
            destroy(network);
        }
    }
}

/// The stability limit has them: just below it motion stays small, just above it grows.
static void their_border_is_found(void **state) {
    (void)state;
    for (int above = 0; above < 2; above++) {
        mspring_network *network = strip(MSPRING_SOLVER_EXPLICIT, MSPRING_SIMD_AUTO, 1, 1, 0);
        double now, any_shape, worst = 0;
        check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
        print_message("stable up to %.5f s, in any shape to %.5f\n", now, any_shape);
        assert_true(any_shape <= now && any_shape > 0.5 * now);
        support_kick(network, PARTICLES / 2, 1e-4f);
        mspring_result result = MSPRING_OK;
        for (int step = 0; step < 2000 && result == MSPRING_OK; step++) {
            result = mspring_network_step(network, (above ? 1.02 : 0.98) * now);
            worst = fmax(worst, fabs(support_position(network, 0).x));
        }
        assert_true(above ? result == MSPRING_ERROR_UNSTABLE || worst > 1 : result == MSPRING_OK && worst < 1e-3);
        destroy(network);
    }
}

/// It settles hanging from two corners, where explicit steps leave it.
static void it_settles(void **state) {
    (void)state;
    mspring_network *network = strip(MSPRING_SOLVER_EXPLICIT, MSPRING_SIMD_AUTO, 64, 1, 0);
    mspring_settle_result settled = {.struct_size = sizeof settled};
    const mspring_id corners[] = {PARTICLES - WIDTH, PARTICLES - 1};
    const float pinned = 0;
    mspring_settings settings;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &settings, sizeof settings));
    check_ok(mspring_network_get_settings(network, &settings));
    settings.gravity_y = -9.8f;
    check_ok(mspring_network_set_settings(network, &settings));
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, corners[i], 1, &pinned, 1));
    }
    check_ok(mspring_network_settle(network, NULL, &settled));
    print_message("%u iterations, moved by %.3f m\n", settled.iterations, settled.displacement);
    assert_true(settled.is_stable && settled.iterations < 40 && settled.displacement > 0.01);
    const support_point before = support_position(network, WIDTH / 2);
    support_steps(network, 64, DT);
    const support_point after = support_position(network, WIDTH / 2);
    check_near(after.x, before.x, 1e-5);
    check_near(after.y, before.y, 1e-5);
    destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_are_gradients_of_the_energy),
        cmocka_unit_test(motion_is_that_of_short_substeps),
        cmocka_unit_test(long_substeps_are_stable),
        cmocka_unit_test(wind_and_triangles_go_together),
        cmocka_unit_test(their_border_is_found),
        cmocka_unit_test(it_settles),
    };
    return cmocka_run_group_tests_name("proof", tests, NULL, NULL);
}
