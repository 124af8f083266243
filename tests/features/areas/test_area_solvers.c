/// @file test_area_solvers.c
/// Areas in the linear systems of the implicit and the direct solver: the same rest, the same motion, and stable.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "areas.h"

static const mspring_solver linear_solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};

static double radius_of(const mspring_network *network, mspring_id particle) {
    const support_point p = support_position(network, particle);
    return hypot(p.x, p.y);
}

// A balloon comes to rest where that of the explicit solver does, whatever the substep.
static void other_solvers_have_areas(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(linear_solvers); i++) {
        mspring_network_def def = support_def(0, 1);
        def.settings.global_damping = 4;
        mspring_network *explicit_one = balloon(100, false, def, NULL);
        def.settings.solver = linear_solvers[i];
        mspring_network *other = balloon(100, false, def, NULL), *slow = balloon(100, false, def, NULL);
        support_steps(explicit_one, 4000, 0.004);
        support_steps(other, 1000, 0.016);
        support_steps(slow, 1000, 1);
        for (uint32_t p = 0; p < SKIN; p++) {
            check_near(radius_of(other, p), radius_of(explicit_one, p), 1e-5);
            check_near(radius_of(slow, p), radius_of(explicit_one, p), 1e-5);
        }
        mspring_network_destroy(explicit_one);
        mspring_network_destroy(other);
        mspring_network_destroy(slow);
    }
}

// With the substep the way of a kicked block comes near to that of the explicit solver; of order 2.
static void other_solvers_follow_motion(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(linear_solvers); i++) {
        double errors[2] = {0, 0};
        mspring_network_def def = support_def(0, 400);
        mspring_network *networks[3];
        for (int n = 0; n < 3; n++) {
            def.settings.substeps = n == 0 ? 400 : 8u << n;
            def.settings.solver = n == 0 ? MSPRING_SOLVER_EXPLICIT : linear_solvers[i];
            def.settings.iterations = 200;
            networks[n] = sheet_network(&jelly, &def);
            (void)add_cells(networks[n], 200);
            support_kick(networks[n], 0, 3);
            support_kick(networks[n], 99, -2);
            support_steps(networks[n], 6, 1.0 / 64);
        }
        for (mspring_id p = 0; p < 100; p++)
            for (int n = 1; n < 3; n++)
                errors[n - 1] = fmax(errors[n - 1],
                                     fabs(support_position(networks[n], p).x - support_position(networks[0], p).x));
        printf("solver %d: %g m off with 16 substeps, %g with 32\n", (int)linear_solvers[i], errors[0], errors[1]);
        assert_true(errors[1] < 1e-3 && errors[1] < 0.5 * errors[0]);
        for (int n = 0; n < 3; n++)
            mspring_network_destroy(networks[n]);
    }
}

// However stiff, a block that spins and swells gets no energy from nowhere, and keeps its momenta.
static void stiff_areas_are_stable_in_any_substep(void **state) {
    (void)state;
    for (int i = 0; i < 6; i++) {
        sheet s = jelly;
        s.stiffness = 1e6f;
        mspring_network_def def = support_def(0, 1);
        def.settings.solver = linear_solvers[i % 2];
        def.settings.integrator = (mspring_integrator)(i / 2);
        mspring_network *network = sheet_network(&s, &def);
        (void)add_cells(network, i % 3 == 0 ? 3e6f : 7e5f);
        for (uint32_t p = 0; p < 100; p++) {
            const float vx = -(float)(p / 10) + 4.5f, vy = (float)(p % 10) - 4.5f;
            check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
        }
        support_kick(network, 0, 5);
        double least = support_energy(network), x, y, spin, end_x, end_y, end_spin;
        check_ok(support_get_momentum(network, &x, &y, &spin));
        for (int step = 0; step < 200; step++) {
            support_steps(network, 1, 1.0 / 64);
            const double energy = support_energy(network);
            assert_true(energy <= least * (1 + 1e-5));
            least = energy;
        }
        check_ok(support_get_momentum(network, &end_x, &end_y, &end_spin));
        check_near(end_x, x, 1e-4); // of 10 kg at some 5 m/s
        check_near(end_spin, spin, 1e-4 * fabs(spin));
        assert_int_equal(inverted(network, &s), 0);
        mspring_network_destroy(network);
    }
}

// Areas without springs all around are forces from the start of a substep, up to a limit that the error tells.
static void others_are_forces(void **state) {
    (void)state;
    static const mspring_id corners[] = {0, 9, 99, 90};
    mspring_network_def def = support_def(0, 1);
    def.settings.solver = MSPRING_SOLVER_DIRECT;
    mspring_network *network = sheet_network(&jelly, &def);
    const mspring_area_def area = elastic(1000);
    check_ok(mspring_network_add_area(network, &area, corners, 4, NULL));
    support_steps(network, 10, 0.004);
    check_error(mspring_network_step(network, 0.1), MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "areas");
    mspring_network_destroy(network);
}

// The equilibrium is where motion ends: of a balloon, and of a jelly that stands on its lowest row.
static void settling_finds_where_motion_ends(void **state) {
    (void)state;
    for (int is_jelly = 0; is_jelly < 2; is_jelly++) {
        mspring_network_def def = support_def(is_jelly ? -9.8f : 0, 4);
        const float none = 0;
        mspring_network *networks[2];
        mspring_settle_def settle_def;
        mspring_settle_result result = {.struct_size = sizeof result};
        def.settings.solver = MSPRING_SOLVER_DIRECT;
        def.settings.global_damping = 3;
        for (int n = 0; n < 2; n++) {
            networks[n] = is_jelly ? sheet_network(&jelly, &def) : balloon(100, n, def, NULL);
            if (!is_jelly)
                continue;
            check_ok(mspring_network_set(networks[n], MSPRING_INVERSE_MASS_SCALE, NULL, 0, 10, &none, 0));
            (void)add_cells(networks[n], 150);
        }
        check_ok(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &settle_def, sizeof settle_def));
        check_ok(mspring_network_settle(networks[0], &settle_def, &result));
        printf("settled in %u iterations, %g N of %g left\n", (unsigned)result.iterations, result.residual,
               result.largest_force);
        support_steps(networks[1], 3000, 1.0 / 64);
        check_near(info_of(networks[0], 0).area, info_of(networks[1], 0).area, is_jelly ? 1e-6 : 1e-4);
        for (mspring_id p = 0; is_jelly && p < 100; p++) // a balloon may drift on its way
            check_near(radius_of(networks[0], p), radius_of(networks[1], p), 2e-5);
        for (int n = 0; n < 2; n++)
            mspring_network_destroy(networks[n]);
    }
}

// A floppy ring: its springs leave its shape to the area, which the matrix does not have in bending.
static void floppy_rings_settle(void **state) {
    (void)state;
    enum { CORNERS = 32 };
    for (int i = 0; i < 6; i++) {
        const mspring_network_def def = support_def(i % 2 ? -9.8f : 0, 1);
        mspring_settle_result result = {.struct_size = sizeof result};
        mspring_builder *builder = support_builder();
        mspring_area_def area = elastic(50);
        mspring_id corners[CORNERS];
        for (int c = 0; c < CORNERS; c++) {
            const double x = cos(2 * acos(-1) * c / CORNERS), y = sin(2 * acos(-1) * c / CORNERS);
            corners[c] = c % (CORNERS / 2) > 0 ? support_particle(builder, x, y, 1) : support_pinned(builder, x, y, 1);
        }
        for (int c = 0; c < CORNERS; c++)
            (void)support_spring(builder, corners[c], corners[(c + 1) % CORNERS], 100, 0);
        mspring_network *network = support_network(builder, &def);
        area.fill = i < 2 ? 0.7f : i < 4 ? 1 : 1.3f;
        check_ok(mspring_network_add_area(network, &area, corners, CORNERS, NULL));
        check_ok(mspring_network_settle(network, NULL, &result));
        printf("fill %g: settled in %u iterations\n", (double)area.fill, (unsigned)result.iterations);
        assert_in_range(result.iterations, 1, 150);
        mspring_network_destroy(network);
    }
}

/* ------------------------------------------------------------------------------------------------------ sleep */

enum { RUNGS = 5 };

// A ladder of springs that lie apart, with areas between them, the upper ones first.
static mspring_network *ladder(mspring_solver solver) {
    mspring_builder *builder = support_builder();
    for (int i = 0; i < RUNGS; i++) {
        const mspring_id a = support_particle(builder, 0, i, 1), b = support_particle(builder, 1, i, 1);
        (void)support_spring(builder, a, b, 1000, 1);
    }
    mspring_network_def def = support_def(0, 16);
    def.settings.sleep_speed = 0.02f;
    def.settings.sleep_time = 0.25f;
    def.settings.solver = solver;
    mspring_network *network = support_network(builder, &def);
    for (mspring_id i = RUNGS - 1; i-- > 0;) {
        const mspring_id corners[4] = {2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2};
        const mspring_area_def area = elastic(100);
        mspring_id id;
        check_ok(mspring_network_add_area(network, &area, corners, 4, &id));
    }
    return network;
}

// A disturbed island wakes those that areas join it to, and these others, in the same step.
static void areas_wake_their_other_corners(void **state) {
    (void)state;
    const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT};
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *asleep = ladder(solvers[i]), *awake;
        support_fall_asleep(asleep, 1.0 / 64);
        check_ok(mspring_network_clone(asleep, NULL, &awake));
        check_ok(mspring_network_wake(awake));
        support_kick(asleep, 0, 1);
        support_kick(awake, 0, 1);
        support_steps(asleep, 1, 1.0 / 64);
        support_steps(awake, 1, 1.0 / 64);
        for (mspring_id p = 0; p < 2 * RUNGS; p++)
            assert_false(support_sleeps(asleep, p));
        assert_true(support_hash(asleep) == support_hash(awake));
        mspring_network_destroy(asleep);
        mspring_network_destroy(awake);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_solvers_have_areas),
        cmocka_unit_test(other_solvers_follow_motion),
        cmocka_unit_test(stiff_areas_are_stable_in_any_substep),
        cmocka_unit_test(others_are_forces),
        cmocka_unit_test(settling_finds_where_motion_ends),
        cmocka_unit_test(floppy_rings_settle),
        cmocka_unit_test(areas_wake_their_other_corners),
    };
    return cmocka_run_group_tests_name("area_solvers", tests, NULL, NULL);
}
