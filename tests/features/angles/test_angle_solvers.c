/// @file test_angle_solvers.c
/// Angle springs in the linear systems of implicit and direct substeps: beams sag and swing as Euler and Bernoulli
/// say, however stiff they are and however long a substep is; no energy comes from nowhere, and momenta stay.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "same.h"

static const mspring_solver linear_solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};

static mspring_network_def def_of(int i, uint32_t substeps) {
    mspring_network_def def = support_def(0, substeps);
    def.settings.solver = linear_solvers[i % 2];
    def.settings.guard = support_guard_of(def.settings.solver);
    def.settings.integrator = (mspring_integrator)(i / 2 % 3);
    return def;
}

// Lines of particles of 1 / links kg, 1 / links m apart, with springs and angles of a beam of so much EI. In each
// the first particles are pinned, so many; where two are, that is a clamped end.
typedef struct beam {
    uint32_t lines, links, pinned;
    double ei;
    float axial;
} beam;

static uint32_t particles_of(const beam *b) {
    return b->links + (b->pinned ? 2 : 1);
}

// The ends have half of a link's mass each.
static float mass_of(const beam *b, uint32_t i) {
    return (i == 0 || i + 1 == particles_of(b) ? 0.5f : 1.0f) / (float)b->links;
}

static mspring_network *beam_network(const beam *b, const mspring_network_def *def) {
    mspring_builder *builder = support_builder();
    const uint32_t count = particles_of(b);
    const double d = 1.0 / b->links;
    for (uint32_t line = 0; line < b->lines; line++)
        for (uint32_t i = 0; i < count; i++) {
            const mspring_id id = i < b->pinned ? support_pinned(builder, i * d, 2 * line, 1)
                                                : support_particle(builder, i * d, 2 * line, mass_of(b, i));
            if (i > 0)
                (void)support_spring(builder, id - 1, id, b->axial, 0);
        }
    mspring_network *network = support_network(builder, def);
    mspring_angle_def angle;
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
    for (uint32_t line = 0; line < b->lines; line++)
        for (uint32_t i = 0; i + 2 < count; i++) {
            const mspring_id three[] = {line * count + i, line * count + i + 1, line * count + i + 2};
            angle.stiffness = (float)((b->pinned && i == 0 ? 2 : 1) * b->ei / d);
            check_ok(mspring_network_add_angles(network, &angle, three, 1, 3, NULL));
        }
    return network;
}

static double tip_of(const mspring_network *network, const beam *b) {
    return support_position(network, particles_of(b) - 1).y;
}

/* ------------------------------------------------------------------------------------------------------- beams */

// As in test_angles.c, a load P at the tip lowers it by P / (3 EI), and links add 1 / (2 n^2) of that. A hundredth
// of the length is so little that geometry counts for 1e-4 of it.
static void beams_sag_in_any_substep(void **state) {
    (void)state;
    static const double stiffnesses[] = {10, 1e4, 1e6};
    for (int i = 0; i < 18; i += 1 + (i > 5))
        for (uint32_t substeps = 1; substeps <= 8; substeps *= 8) {
            const beam b = {1, i % 4 < 2 ? 40 : 10, 2, stiffnesses[i / 6], i / 6 == 0 ? 1e5f : 1e9f};
            mspring_network_def def = def_of(i, substeps);
            def.settings.global_damping = 8;
            def.flags = MSPRING_NETWORK_PRECISE;
            mspring_network *network = beam_network(&b, &def);
            for (int step = 0; step < 150; step++) {
                check_ok(mspring_network_apply_force(network, particles_of(&b) - 1, 0, (float)(0.03 * b.ei)));
                support_steps(network, 1, 1.0 / 60);
            }
            const double expected = 0.01 * (1 + 0.5 / (b.links * b.links));
            check_near(tip_of(network, &b) / expected, 1, 1e-3);
            mspring_network_destroy(network);
        }
}

// A cantilever of mass 1 swings with 3.5160 sqrt(EI). Its links put it off by 1 / n^2, integrators by (omega h)^2 /
// 12 and less.
static void beams_swing_as_they_should(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        const beam b = {1, 40, 2, 10, 1e5f};
        const mspring_network_def def = def_of(i, 16);
        const double expected = 6.283185307 / (3.5160 * sqrt(10)), dt = expected / 20;
        mspring_network *network = beam_network(&b, &def);
        double before = 0, crossings[2] = {0, 0};
        int seen = 0;
        for (int step = 0; step < 40; step++) { // bend it
            check_ok(mspring_network_apply_force(network, particles_of(&b) - 1, 0, 0.3f));
            check_ok(support_set_global_damping(network, 20));
            support_steps(network, 1, dt);
        }
        check_ok(support_set_global_damping(network, 0));
        for (int step = 0; step < 100 && seen < 2; step++) {
            before = tip_of(network, &b);
            support_steps(network, 1, dt);
            const double y = tip_of(network, &b);
            if (before < 0 && y >= 0)
                crossings[seen++] = step - y / (y - before);
        }
        const double period = dt * (crossings[1] - crossings[0]);
        printf("%s, integrator %d: period %.4f of a beam's\n", i % 2 ? "direct" : "implicit", i / 2,
               period / expected);
        check_near(period / expected, 1, 0.01);
        mspring_network_destroy(network);
    }
}

/* ------------------------------------------------------------------------------------------------------- books */

// A free beam that spins and quivers, and one that is told to curl to a ring. Energy falls but for rounding, and
// momenta stay.
static void energy_falls_and_momenta_stay(void **state) {
    (void)state;
    for (int i = 0; i < 12; i++) {
        const beam b = {1, 40, 0, i % 4 < 2 ? 100 : 1e6, i % 4 < 2 ? 1e6f : 1e9f};
        const mspring_network_def def = def_of(i, i % 3 == 0 ? 1 : 4);
        mspring_network *network = beam_network(&b, &def);
        const bool curls = i >= 6;
        const double curl = 6.283185307 / 40;
        for (uint32_t p = 0; p < 41; p++) {
            const float vx = 0, vy = (float)(5 * (p / 40.0 - 0.5)) + (p % 5 == 0 ? 0.4f : -0.1f);
            check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
        }
        if (curls)
            check_ok(support_set_rest_angles(network, 0, 39, &curl, 0));
        double least = support_energy(network), x, y, spin, end_x, end_y, end_spin;
        check_ok(support_get_momentum(network, &x, &y, &spin));
        for (int step = 0; step < 100; step++) {
            support_steps(network, 1, 1.0 / 60);
            const double energy = support_energy(network);
            assert_true(energy <= least * (1 + 1e-5));
            least = energy;
        }
        check_ok(support_get_momentum(network, &end_x, &end_y, &end_spin));
        check_near(end_x, x, 1e-5); // of 1 kg at some 1 m/s
        check_near(end_y, y, 1e-5);
        check_near(end_spin, spin, 2e-4 * fabs(spin));
        if (curls) {
            const support_point p = support_position(network, 0), q = support_position(network, 40);
            check_near(hypot(q.x - p.x, q.y - p.y), 0, 0.1);
        }
        mspring_network_destroy(network);
    }
}

// Both solvers find the same, where iterations are many.
static void solvers_agree(void **state) {
    (void)state;
    const beam b = {1, 30, 2, 1e3, 1e7f};
    mspring_network *networks[2];
    for (int i = 0; i < 2; i++) {
        mspring_network_def def = def_of(i, 4);
        def.settings.iterations = i == 0 ? 200 : 0;
        networks[i] = beam_network(&b, &def);
        support_set_residual(networks[i], 0);
        mspring_angle_def damped = {.struct_size = sizeof damped};
        check_ok(support_get_angle(networks[i], 5, &damped));
        damped.damping = 20;
        check_ok(support_set_angle(networks[i], 5, &damped));
        support_kick(networks[i], 31, 4);
        support_kick(networks[i], 12, -3);
    }
    for (int step = 0; step < 60; step++) {
        support_steps(networks[0], 1, 1.0 / 60);
        support_steps(networks[1], 1, 1.0 / 60);
        check_near(tip_of(networks[0], &b), tip_of(networks[1], &b), 2e-5);
    }
    mspring_network_destroy(networks[0]);
    mspring_network_destroy(networks[1]);
}

// Angles without springs along their arms are forces from the start of a substep, up to a limit that the error
// tells.
static void others_are_forces(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        const beam b = {1, 10, 2, 10, 1e5f};
        mspring_network_def def = def_of(i, 1);
        def.settings.guard = MSPRING_GUARD_GROWTH;
        static const mspring_id far[] = {2, 6, 11};
        mspring_network *network = beam_network(&b, &def);
        mspring_angle_def angle;
        check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
        angle.stiffness = 10;
        check_ok(mspring_network_add_angles(network, &angle, far, 1, 3, NULL));
        support_steps(network, 10, 0.001);
        check_error(mspring_network_step(network, 1), MSPRING_ERROR_UNSTABLE);
        check_contains(mspring_network_error(network), "angles");
        check_ok(mspring_network_remove_elements(network, NULL, 10, 1));
        support_steps(network, 1, 1);
        mspring_network_destroy(network);
    }
}

/* ---------------------------------------------------------------------------------------------- the same bits */

// Lines in several panels for the implicit solver. Soft, so that no substep is divided: 8 times as fast.
static mspring_network *lines(mspring_network_def def) {
    const bool is_direct = def.settings.solver == MSPRING_SOLVER_DIRECT;
    const beam b = {is_direct ? 4 : 60, 40, is_direct ? 0 : 2, 10, 1e5f};
    mspring_network *network = beam_network(&b, &def);
    for (mspring_id p = 3; p < b.lines * particles_of(&b); p += 7)
        support_kick(network, p, p % 2 ? 1 : -1);
    return network;
}

// Some break, one falls asleep, angles are changed: all levels and workers, a clone, a snapshot and another layout
// go on alike.
static void go_on(mspring_network *network) {
    for (mspring_id step = 0; step < 6; step++) {
        const double bend = 0.02 * step;
        const mspring_id broken = 11 * step + 5;
        check_ok(support_set_rest_angles(network, 20, 60, &bend, 0));
        check_ok(mspring_network_break_springs(network, &broken, 0, 1));
        if (step == 4)
            check_ok(mspring_network_restore_springs(network, &broken, 0, 1, 0));
        support_steps(network, 2, 1.0 / 64);
    }
}

static const same_scene scene = {lines, go_on};

static void all_levels_have_the_same_bits(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++)
        same_at_all_levels(&scene, def_of(i, 2));
}

// Heights of metres; iterations of another layout are others.
static void clones_snapshots_and_layouts_go_on(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++)
        mspring_network_destroy(same_in_copies(&scene, def_of(i, 2), 5e-3));
}

// What sleeps stays where it is, beside what does not.
static void sleepers_stay(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        const beam b = {2, 20, 2, 1e3, 1e7f};
        mspring_network_def def = def_of(i, 2);
        def.settings.sleep_speed = 0.001f;
        mspring_network *network = beam_network(&b, &def);
        for (int step = 0; step < 200; step++) {
            support_kick(network, 40, 0.5f); // of the second line
            support_steps(network, 1, 1.0 / 64);
        }
        assert_false(support_is_asleep(network));
        check_near(support_position(network, 21).y, 0, 0);
        const double bend = 0.05;
        check_ok(support_set_rest_angles(network, 0, 20, &bend, 0));
        support_steps(network, 200, 1.0 / 64);
        assert_true(support_position(network, 21).y > 0.1);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beams_sag_in_any_substep),
        cmocka_unit_test(beams_swing_as_they_should),
        cmocka_unit_test(energy_falls_and_momenta_stay),
        cmocka_unit_test(solvers_agree),
        cmocka_unit_test(others_are_forces),
        cmocka_unit_test(all_levels_have_the_same_bits),
        cmocka_unit_test(clones_snapshots_and_layouts_go_on),
        cmocka_unit_test(sleepers_stay),
    };
    return cmocka_run_group_tests_name("angle_solvers", tests, NULL, NULL);
}
