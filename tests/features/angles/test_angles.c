/// @file test_angles.c
/// Angle springs: beams sag as Euler and Bernoulli say, oscillators have the periods of closed forms, books close,
/// rest angles may be driven, and clones, snapshots, other layouts, levels and solvers agree.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "same.h"

#define PI 3.14159265358979

static mspring_angle_def stiff(float stiffness, float damping) {
    mspring_angle_def def;
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &def, sizeof def));
    def.stiffness = stiffness;
    def.damping = damping;
    return def;
}

static support_angle_info info_of(const mspring_network *network, mspring_id angle) {
    support_angle_info info;
    check_ok(support_get_angle_info(network, angle, &info));
    return info;
}

// Particles of mass along x, `spacing` apart, the first `clamped` of them pinned, joined by springs.
static void add_line(mspring_builder *builder, uint32_t count, uint32_t clamped, double spacing, float mass,
                     float stiffness) {
    const mspring_id first = mspring_builder_count(builder, MSPRING_PARTICLES);
    for (uint32_t i = 0; i < count; i++)
        (void)(i < clamped ? support_pinned(builder, i * spacing, 0, mass)
                           : support_particle(builder, i * spacing, 0, mass));
    for (uint32_t i = 0; i + 1 < count; i++)
        (void)support_spring(builder, first + i, first + i + 1, stiffness, 0);
}

static mspring_network *line(uint32_t count, uint32_t clamped, double spacing, float stiffness,
                             mspring_network_def def) {
    mspring_builder *builder = support_builder();
    add_line(builder, count, clamped, spacing, 1, stiffness);
    return support_network(builder, &def);
}

// An angle at each particle but the ends.
static void stiffen(mspring_network *network, uint32_t count, float stiffness) {
    const mspring_angle_def def = stiff(stiffness, 0);
    for (mspring_id i = 0; i + 2 < count; i++) {
        const mspring_id three[] = {i, i + 1, i + 2};
        mspring_id id;
        check_ok(mspring_network_add_angles(network, &def, three, 1, 3, &id));
        assert_int_equal(id, i);
    }
}

/* -------------------------------------------------------------------------------------------------------- beam */

// A cantilever of length 1 with EI = 10 and a load at its tip sags by P / (3 EI); with links of 1 / n, and twice
// the stiffness at the root, by 1 + 1 / (2 n^2) times that. The load is small: the rest is geometry, (sag /
// length)^2.
static void a_beam_sags_as_beams_do(void **state) {
    (void)state;
    for (uint32_t n = 5; n <= 20; n *= 2) {
        mspring_network_def def = support_def(0, 1);
        def.flags = MSPRING_NETWORK_PRECISE;
        mspring_network *network = line(n + 2, 2, 1.0 / n, 1e5f, def);
        double stable;
        stiffen(network, n + 2, 10.0f * (float)n);
        mspring_angle_def root = stiff(20.0f * (float)n, 0);
        check_ok(support_set_angle(network, 0, &root));
        check_ok(mspring_network_get_stable_dt(network, &stable, NULL));
        // The lowest frequency of a beam of mass n: 3.516 sqrt(EI / n); damped near critically.
        const double omega = 3.516 * sqrt(10.0 / n);
        check_ok(support_set_global_damping(network, (float)(2 * omega)));
        for (double time = 0; time < 40 / omega; time += 0.9 * stable) {
            check_ok(mspring_network_apply_force(network, n + 1, 0, 0.3f));
            support_steps(network, 1, 0.9 * stable);
        }
        const double sag = support_position(network, n + 1).y, expected = 0.01 * (1 + 0.5 / (n * n));
        printf("beam of %u links: sag %.6f m, %.4f of a beam's\n", n, sag, sag / 0.01);
        check_near(sag / expected, 1, 1e-3);
        mspring_network_destroy(network);
    }
}

/* ------------------------------------------------------------------------------------------------------ periods */

// When y of a particle rises through 0, interpolated, the first and the second time.
static double period_of(mspring_network *network, mspring_id particle, double dt) {
    double before = support_position(network, particle).y, times[2] = {0, 0};
    int seen = 0;
    for (int step = 0; seen < 2 && step < 1000000; step++) {
        support_steps(network, 1, dt);
        const double y = support_position(network, particle).y;
        if (before < 0 && y >= 0)
            times[seen++] = dt * (step + 1 - y / (y - before));
        before = y;
    }
    return times[1] - times[0];
}

// Three free particles: omega^2 = k (1 + 1 + 4) / (m d^2), as the gradients are 1 / d, 1 / d and 2 / d. One on an
// arm at two that are pinned: a pendulum, of omega^2 = k / (m d^2), with a period that is 1.18034 times as long
// where it swings by a quarter turn to each side. The arms are so stiff that they give by 1e-3 at most.
static void oscillators_have_their_periods(void **state) {
    (void)state;
    for (int is_pendulum = 0; is_pendulum < 2; is_pendulum++) {
        mspring_network_def def = support_def(0, 50);
        mspring_network *network = line(3, is_pendulum ? 2 : 0, 0.5, is_pendulum ? 4e5f : 1e4f, def);
        stiffen(network, 3, 20);
        const float still = 0, up = is_pendulum ? (float)(0.5 * sqrt(2 * 20 / 0.25)) : 0.01f;
        // All of the energy that a quarter turn stores is k.
        check_ok(mspring_network_set_velocities(network, NULL, is_pendulum ? 2 : 1, 1, &still, &up, 1));
        const double omega = sqrt((is_pendulum ? 1 : 6) * 20 / 0.25);
        if (!is_pendulum) { // no drift
            const float back = -0.005f;
            check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &still, &back, 1));
            check_ok(mspring_network_set_velocities(network, NULL, 2, 1, &still, &back, 1));
        }
        const double expected = 2 * PI / omega * (is_pendulum ? 1.18034 : 1);
        const double period = period_of(network, is_pendulum ? 2 : 1, expected / 200);
        printf("%s: period %.5f s, expected %.5f\n", is_pendulum ? "pendulum" : "three", period, expected);
        check_near(period / expected, 1, 2e-3);
        mspring_network_destroy(network);
    }
}

/* -------------------------------------------------------------------------------------------------------- books */

// Without damping energy stays, and both momenta to rounding; the drift of symplectic Euler is below 1 % at this
// substep. With damping energy falls, and momenta stay.
static void energy_and_momenta_stay(void **state) {
    (void)state;
    for (int is_damped = 0; is_damped < 2; is_damped++) {
        mspring_network_def def = support_def(0, 400);
        mspring_network *network = line(12, 0, 0.25, 2000, def);
        stiffen(network, 12, 15);
        mspring_angle_def damped = stiff(15, 0.5f);
        for (mspring_id i = 0; is_damped && i < 10; i++)
            check_ok(support_set_angle(network, i, &damped));
        for (mspring_id i = 0; i < 12; i += 3)
            support_kick(network, i, i % 2 ? 0.8f : -1.1f);
        double x, y, angular, end_x, end_y, end_angular;
        check_ok(support_get_momentum(network, &x, &y, &angular));
        const double energy = support_energy(network);
        support_steps(network, 128, 1.0 / 64);
        check_ok(support_get_momentum(network, &end_x, &end_y, &end_angular));
        if (is_damped)
            assert_true(support_energy(network) < 0.95 * energy);
        else
            check_near(support_energy(network), energy, 0.01 * energy);
        check_near(end_x, x, 1e-4); // 50,000 substeps of forces of some 100 N, in single precision
        check_near(end_y, y, 1e-4);
        check_near(end_angular, angular, 3e-4);
        mspring_network_destroy(network);
    }
}

// Work of the torque along a turn of the second arm is what the energy loses, all around the circle.
static void torque_is_the_slope_of_energy(void **state) {
    (void)state;
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = line(3, 0, 1, 10, def);
    mspring_angle_def bent = stiff(3, 0);
    const mspring_id three[] = {0, 1, 2};
    bent.rest_angle = 2.5;
    check_ok(mspring_network_add_angles(network, &bent, three, 1, 3, NULL));
    for (int i = -30; i <= 30; i++) {
        const double turn = i * 0.1, d = turn - 2.5;
        const double x = 1 + cos(turn), y = sin(turn);
        check_ok(mspring_network_set_positions(network, NULL, 2, 1, &x, &y, 1));
        const support_angle_info info = info_of(network, 0);
        check_near(info.angle, turn, 1e-6);
        check_near(info.torque, -3 * sin(d), 1e-5);
        check_near(info.energy, 3 * (1 - cos(d)), 1e-5);
    }
    // It turns the short way to where it rests.
    check_ok(support_set_global_damping(network, 3));
    support_steps(network, 4000, 0.01);
    check_near(info_of(network, 0).angle, 2.5, 1e-4);
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------------- driven */

// A chain that is told to curl closes to a ring: the angles of its 12 particles are 2 pi / 12 each.
static void rest_angles_are_driven(void **state) {
    (void)state;
    mspring_network_def def = support_def(0, 50);
    def.settings.global_damping = 2;
    def.settings.sleep_speed = 0.001f;
    mspring_network *network = line(12, 0, 0.5, 2000, def), *other = line(12, 0, 0.5, 2000, def);
    stiffen(network, 12, 30);
    stiffen(other, 12, 30);
    support_fall_asleep(network, 1.0 / 64);
    const double curl = 2 * PI / 12;
    const float bad = NAN, bent = 0.1f;
    check_ok(support_set_rest_angles(network, 0, 10, &curl, 0));
    assert_false(support_is_asleep(network));
    support_steps(network, 1000, 1.0 / 64);
    for (mspring_id i = 0; i < 10; i++)
        check_near(info_of(network, i).angle, curl, 1e-3);
    const support_point p = support_position(network, 0), q = support_position(network, 11);
    check_near(hypot(q.x - p.x, q.y - p.y), 0.5, 5e-3);
    // It is no edit: a frame holds it.
    support_bring(network, other, MSPRING_SNAPSHOT_FRAME);
    mspring_angle_def now = {.struct_size = sizeof now};
    check_ok(support_get_angle(other, 3, &now));
    check_near((double)now.rest_angle, (double)(float)curl, 0);
    check_near((double)now.stiffness, 30, 0);
    support_steps(network, 5, 1.0 / 64);
    support_steps(other, 5, 1.0 / 64);
    assert_true(support_hash(network) == support_hash(other));
    check_error(support_set_rest_angles(network, 9, 2, &curl, 0), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "10");
    const mspring_property rest = MSPRING_REST_ANGLE;
    check_error(mspring_network_set(network, rest, NULL, 0, 1, &bad, 0), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "element 0");
    check_error(mspring_network_set(network, rest, NULL, 0, 1, NULL, 0), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, rest, NULL, 5, UINT32_MAX - 1, &bent, 0), MSPRING_ERROR_ID);
    check_ok(mspring_network_set(network, rest, NULL, 10, 0, NULL, 0));
    check_ok(mspring_network_set(network, rest, NULL, 5, MSPRING_ALL, &bent, 0));
    check_ok(support_get_angle(network, 9, &now));
    check_near((double)now.rest_angle, (double)bent, 0);
    check_ok(support_get_angle(network, 4, &now));
    check_near((double)now.rest_angle, (double)(float)curl, 0);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

/* --------------------------------------------------------------------------------------------------- stability */

// omega^2 = 16 k / (m d^2) in a long straight beam; damping shortens it. Just below the border it is stable, just
// above the guard finds it.
static void stable_dt_counts_angles(void **state) {
    (void)state;
    for (int is_damped = 0; is_damped < 2; is_damped++) {
        mspring_network_def def = support_def(0, 1);
        mspring_network *network = line(60, 0, 0.5, 10, def);
        mspring_angle_def angle = stiff(50, is_damped ? 2 : 0);
        double now, any_shape;
        stiffen(network, 60, 50);
        for (mspring_id i = 0; i < 58; i++)
            check_ok(support_set_angle(network, i, &angle));
        check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
        // h^2 k + 2 h c = 4 m d^2 / 16
        const double c = is_damped ? 2 : 0, expected = (sqrt(c * c + 50 * 0.0625) - c) / 50;
        check_near(now / expected, 1.005, 0.01);
        assert_true(any_shape <= now && any_shape > 0.6 * now);
        support_kick(network, 30, 0.01f);
        support_steps(network, 2000, 0.98 * now);
        mspring_result result = MSPRING_OK;
        for (int step = 0; step < 400 && result == MSPRING_OK; step++)
            result = mspring_network_step(network, 1.06 * now);
        assert_int_equal(result, MSPRING_ERROR_UNSTABLE);
        mspring_network_destroy(network);
    }
}

// A curled chain comes to the same rest with all solvers; see test_angle_solvers.c.
static void other_solvers_have_angles(void **state) {
    (void)state;
    static const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT,
                                             MSPRING_SOLVER_DIRECT};
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network_def def = support_def(0, 20);
        def.settings.solver = solvers[i];
        def.settings.global_damping = 1.5f;
        mspring_network *network = line(8, 2, 0.5, 2000, def);
        stiffen(network, 8, 20);
        const double curl = 0.4;
        check_ok(support_set_rest_angles(network, 0, 6, &curl, 0));
        support_steps(network, 2000, 1.0 / 64);
        for (mspring_id a = 0; a < 6; a++)
            check_near(info_of(network, a).angle, curl, 1e-3);
        mspring_network_destroy(network);
    }
}

/* ----------------------------------------------------------------------------------------- springs and particles
 */

static void a_break_opens_an_angle(void **state) {
    (void)state;
    const mspring_network_def def = support_def(0, 20);
    mspring_network *network = line(5, 0, 1, 100, def);
    const mspring_id broken = 1, far[] = {0, 2, 4}, removed = 4;
    const mspring_angle_def across = stiff(5, 0);
    stiffen(network, 5, 10);
    mspring_id loose;
    check_ok(mspring_network_add_angles(network, &across, far, 1, 3, &loose)); // without springs: it never opens
    check_ok(mspring_network_break_springs(network, &broken, 0, 1));
    for (mspring_id angle = 0; angle < 3; angle++)
        assert_int_equal(info_of(network, angle).is_open, angle < 2);
    assert_int_equal(info_of(network, loose).is_open, 0);
    support_steps(network, 1, 1.0 / 64);
    check_ok(mspring_network_restore_springs(network, &broken, 0, 1, 0));
    assert_int_equal(info_of(network, 0).is_open, 0);
    check_ok(mspring_network_remove_particles(network, &removed, 0, 1));
    support_angle_info info;
    check_error(support_get_angle_info(network, loose, &info), MSPRING_ERROR_ID);
    check_error(support_get_angle_info(network, 2, &info), MSPRING_ERROR_ID);
    const mspring_id again[] = {0, 1};
    check_ok(mspring_network_remove_elements(network, NULL, 1, 1));
    check_ok(mspring_network_remove_elements(network, NULL, 1, 1)); // a range leaves it out
    check_error(mspring_network_remove_elements(network, again, 0, 2), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "element 1");
    check_ok(support_get_angle_info(network, 0, &info));
    support_steps(network, 10, 1.0 / 64);
    mspring_network_destroy(network);
}

static void bad_angles_are_refused(void **state) {
    (void)state;
    const mspring_network_def def = support_def(0, 20);
    mspring_builder *builder = support_builder();
    add_line(builder, 4, 0, 1, 1, 100);
    (void)support_particle(builder, 0, 0, 1); // where the first one is
    mspring_network *network = support_network(builder, &def);
    const mspring_angle_def good = stiff(1, 0);
    mspring_angle_def bad[] = {good, good, good, good, good};
    const mspring_id fine[] = {0, 1, 2}, twice[] = {0, 1, 0}, gone[] = {0, 1, 9}, same[] = {4, 0, 1};
    const mspring_id second_bad[] = {0, 1, 2, 1, 2, 77};
    bad[0].stiffness = -1;
    bad[1].stiffness = NAN;
    bad[2].damping = INFINITY;
    bad[3].rest_angle = NAN;
    bad[4].rest_angle = 2e6;
    const uint64_t hash = support_hash(network);
    check_error(mspring_network_add_angles(network, &good, twice, 1, 3, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_add_angles(network, &good, same, 1, 3, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_add_angles(network, &good, gone, 1, 3, NULL), MSPRING_ERROR_ID);
    check_error(mspring_network_add_angles(network, &good, NULL, 1, 3, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_add_angles(network, NULL, fine, 1, 3, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_add_angles(network, &good, second_bad, 2, 3, NULL), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "77");
    mspring_angle_def none = {.struct_size = sizeof none};
    check_error(support_get_angle(network, 0, &none), MSPRING_ERROR_ID); // all or none
    mspring_id id;
    check_ok(mspring_network_add_angles(network, &good, fine, 1, 3, &id));
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        check_error(mspring_network_add_angles(network, &bad[i], fine, 1, 3, NULL), MSPRING_ERROR_ARGUMENT);
        check_error(support_set_angle(network, id, &bad[i]), MSPRING_ERROR_ARGUMENT);
    }
    check_error(support_set_angle(network, id + 1, &good), MSPRING_ERROR_ID);
    assert_true(support_hash(network) == hash);
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------- the same bits */

// A rope and a lattice with angles, an area among them; rest angles are driven, springs break.
static mspring_network *mixture(mspring_network_def def) {
    mspring_builder *builder = support_builder();
    add_line(builder, 200, 1, 0.5, 1, 3000);
    for (uint32_t i = 0; i < 20 * 30; i++)
        (void)support_particle(builder, i % 20, 5 + i / 20, 1);
    for (uint32_t i = 0; i < 20 * 30; i++) {
        if (i % 20 < 19)
            (void)support_spring(builder, 200 + i, 201 + i, 500, 0.5f);
        if (i < 20 * 29)
            (void)support_spring(builder, 200 + i, 220 + i, 500, 0.5f);
    }
    mspring_network *network = support_network(builder, &def);
    const mspring_angle_def hinge = stiff(20, 0.1f);
    const mspring_id ring[] = {205, 210, 310, 305}, corners[] = {200, 221, 242, 221, 242, 263};
    mspring_area_def area;
    stiffen(network, 200, 10);
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    area.stiffness = 20;
    check_ok(mspring_network_add_area(network, &area, ring, 4, NULL));
    check_ok(mspring_network_add_angles(network, &hinge, corners, 2, 3, NULL));
    for (mspring_id p = 1; p < 800; p += 7)
        support_kick(network, p, p % 2 ? 1 : -1);
    return network;
}

static void go_on(mspring_network *network) {
    for (mspring_id step = 0; step < 6; step++) {
        const double bend = 0.1 * step;
        const mspring_id broken = 31 * step + 5;
        check_ok(support_set_rest_angles(network, 20, 60, &bend, 0));
        check_ok(mspring_network_break_springs(network, &broken, 0, 1));
        support_steps(network, 3, 1.0 / 64);
    }
}

static const same_scene scene = {mixture, go_on};

static void all_levels_have_the_same_bits(void **state) {
    (void)state;
    same_at_all_levels(&scene, support_def(-9.8f, 20));
}

static void clones_snapshots_and_layouts_go_on(void **state) {
    (void)state;
    mspring_network *network = same_in_copies(&scene, support_def(-9.8f, 20), 1e-3);
    // A snapshot that is cut is refused.
    size_t size;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, bytes, size, NULL));
    for (size_t cut = 0; cut < size; cut += 1 + size / 97)
        check_error(mspring_network_load(network, bytes, cut), MSPRING_ERROR_SNAPSHOT);
    free(bytes);
    mspring_network_destroy(network);
}

// All that was added can be read back: ids, corners, sizes and angles; what is open has no pressure.
static void all_is_read_back(void **state) {
    (void)state;
    const mspring_network_def def = support_def(0, 20);
    mspring_network *network = mixture(def);
    const mspring_id clockwise[] = {200, 300, 305, 205}, broken = 1;
    mspring_area_def area;
    mspring_id ids[300], id, corners[4] = {0, 0, 0, 0};
    double sizes[300], pressures[300];
    uint32_t count;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    area.pressure = 3;
    check_ok(mspring_network_add_area(network, &area, clockwise, 4, &id));
    check_ok(support_get_areas(network, ids, sizes, pressures, 300, &count));
    assert_int_equal(count, 2);
    assert_int_equal(ids[1], id);
    check_near(sizes[0], 25, 1e-5);
    check_near(sizes[1], 25, 1e-5);
    check_near(pressures[1], 3, 1e-5);
    check_ok(mspring_network_get_element_particles(network, id, corners, 3, &count));
    assert_int_equal(count, 4);
    assert_int_equal(corners[0], 205); // turned over, and no more than there is room for
    assert_int_equal(corners[3], 0);
    check_ok(mspring_network_get_element_particles(network, 0, corners, 4, &count)); // the first angle of the line
    assert_int_equal(count, 3);
    assert_true(corners[0] == 0 && corners[1] == 1 && corners[2] == 2);
    check_ok(mspring_network_break_springs(network, &broken, 0, 1));
    check_ok(support_get_angles(network, ids, sizes, pressures, 300, &count));
    assert_int_equal(count, 200);
    for (uint32_t i = 0; i < count; i++) {
        const support_angle_info info = info_of(network, ids[i]);
        assert_true(info.angle == sizes[i] && info.torque == pressures[i]);
    }
    check_ok(support_get_angles(network, NULL, NULL, NULL, 0, &count));
    assert_int_equal(count, 200);
    // A frame fits a network with the same areas, and says so.
    mspring_network *other = mixture(def);
    size_t size;
    check_ok(mspring_network_get_snapshot_size(other, MSPRING_SNAPSHOT_FRAME, &size));
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    check_ok(mspring_network_save(other, MSPRING_SNAPSHOT_FRAME, bytes, size, NULL));
    check_error(mspring_network_load(network, bytes, size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "areas and angles");
    free(bytes);
    mspring_network_destroy(other);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------- short arms */

// A rope of 6 particles that only pulls, 5 % slack, with an angle at each: props are springs that only push below
// half of an arm.
static mspring_network *slack_rope(mspring_network_def def, bool has_props) {
    mspring_builder *builder = support_builder();
    mspring_spring_def spring;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.stiffness = 1000;
    for (uint32_t i = 0; i < 6; i++)
        (void)support_particle(builder, i, 0, 1);
    for (uint32_t i = 0; i < (has_props ? 10u : 5u); i++) {
        spring.a = i % 5;
        spring.b = i % 5 + 1;
        spring.rest_length = i < 5 ? 1.05f : 0.5f;
        spring.flags = i < 5 ? MSPRING_SPRING_PULL_ONLY : MSPRING_SPRING_PUSH_ONLY;
        check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    }
    mspring_network *network = support_network(builder, &def);
    stiffen(network, 6, 100);
    return network;
}

// The largest energy in 3 s of a rope whose particles are thrown at 5 m/s at most, over that at the start.
static double thrown(mspring_network_def def, bool has_props, uint64_t seed) {
    mspring_network *network = slack_rope(def, has_props);
    double any, kinetic, elastic, begin, most = 0;
    for (uint32_t i = 0; i < 6; i++) {
        const float vx = (float)support_random_between(&seed, -5, 5),
                    vy = (float)support_random_between(&seed, -5, 5);
        check_ok(mspring_network_set_velocities(network, NULL, i, 1, &vx, &vy, 1));
    }
    check_ok(mspring_network_get_stable_dt(network, NULL, &any));
    const double dt = def.settings.solver == MSPRING_SOLVER_EXPLICIT ? 0.15 * any : 0.03;
    check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
    begin = kinetic + elastic;
    for (double time = 0; time < 3; time += dt) {
        support_steps(network, 1, dt);
        check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
        most = fmax(most, (kinetic + elastic) / begin);
    }
    mspring_network_destroy(network);
    return most;
}

// The force of an angle grows as an arm shrinks, which nothing stops where springs only pull: without props
// energies grow without bound. With them arms stay: 10 % is the swing of the explicit solver's energy at such
// speeds.
static void props_keep_arms_long(void **state) {
    (void)state;
    for (int solver = 0; solver < 3; solver++) {
        mspring_network_def def = support_def(0, 1);
        double most[2] = {0, 0};
        def.settings.solver = (mspring_solver)solver;
        def.settings.guard = MSPRING_GUARD_BOUNDS;
        for (uint64_t seed = 1; seed <= 40; seed++)
            for (int has_props = 0; has_props < 2; has_props++)
                most[has_props] = fmax(most[has_props], thrown(def, has_props, seed));
        printf("solver %d: energy of thrown slack ropes up to %.4g times, %.4g with props\n", solver, most[0],
               most[1]);
        assert_true(most[1] < 1.1);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_beam_sags_as_beams_do),
        cmocka_unit_test(oscillators_have_their_periods),
        cmocka_unit_test(energy_and_momenta_stay),
        cmocka_unit_test(torque_is_the_slope_of_energy),
        cmocka_unit_test(rest_angles_are_driven),
        cmocka_unit_test(stable_dt_counts_angles),
        cmocka_unit_test(other_solvers_have_angles),
        cmocka_unit_test(a_break_opens_an_angle),
        cmocka_unit_test(bad_angles_are_refused),
        cmocka_unit_test(all_levels_have_the_same_bits),
        cmocka_unit_test(clones_snapshots_and_layouts_go_on),
        cmocka_unit_test(all_is_read_back),
        cmocka_unit_test(props_keep_arms_long),
    };
    return cmocka_run_group_tests_name("angles", tests, NULL, NULL);
}
