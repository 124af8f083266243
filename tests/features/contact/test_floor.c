/// @file test_floor.c
/// The floor: nothing gets through it, what lies on it lies still, friction and restitution as in closed forms.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "grounds.h"
#include "support.h"

static const double g = 9.8;

/* --------------------------------------------------------------------------------------------- nothing gets in */

enum { THROWN = 300 };

/// Loose particles, and pairs on springs, at most 20 m above (x, y) and at up to 100 m/s in x and y.
static mspring_network *thrown(double x, double y, const mspring_floor_def *def, uint32_t workers,
                               mspring_simd simd) {
    mspring_builder *builder = support_builder();
    uint64_t seed = 9;
    for (uint32_t i = 0; i < THROWN; i++) {
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        do {
            particle.x = x + support_random_between(&seed, -15, 15);
            particle.y = y + support_random_between(&seed, 0, 20);
        } while (grounds_above(def, particle.x, particle.y) < 0.01);
        particle.vx = (float)support_random_between(&seed, -100, 100);
        particle.vy = (float)support_random_between(&seed, -100, 100);
        check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
        if (i > THROWN / 2)
            (void)support_spring(builder, i - 1, i, 100, 1);
    }
    mspring_network_def settings = support_def(-9.8f, 1);
    settings.worker_count = workers;
    settings.simd_level = simd;
    return support_network(builder, &settings);
}

static double lowest(const mspring_network *network, const mspring_floor_def *def) {
    static double x[THROWN], y[THROWN];
    double least = INFINITY;
    check_ok(mspring_network_get_positions(network, NULL, 0, mspring_network_count(network, MSPRING_PARTICLES), x,
                                           y, 1));
    for (uint32_t i = 0; i < mspring_network_count(network, MSPRING_PARTICLES); i++)
        least = fmin(least, grounds_above(def, x[i], y[i]));
    return least;
}

static void nothing_gets_in(const grounds_way *how) {
    static ground grounds[6];
    const double places[2][2] = {{0, 0}, {10000.3, -7000.7}}, lengths[] = {1.0 / 64, 1.0 / 15};
    for (uint32_t p = 0; p < 2; p++) {
        const uint32_t count = grounds_make(grounds, places[p][0], places[p][1]);
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t l = ROUNDS_ARE_FEW ? i % 2 : 0; l < (ROUNDS_ARE_FEW ? i % 2 + 1 : 2); l++) {
                mspring_floor_def *def = &grounds[i].def;
                def->planes = grounds[i].planes;
                def->heights = grounds[i].heights;
                mspring_network *network = thrown(places[p][0], places[p][1], def, 1, MSPRING_SIMD_AUTO);
                grounds_step_by(network, how);
                check_ok(mspring_network_set_floor(network, def));
                for (uint32_t step = 0; step < ROUNDS(120); step++) {
                    check_ok(mspring_network_step(network, lengths[l]));
                    if (lowest(network, def) < -GROUNDS_TOLERANCE)
                        fail_msg("%s at (%g, %g), dt = %g s, step %u: a particle is %g m too low", grounds[i].name,
                                 places[p][0], places[p][1], lengths[l], step, -lowest(network, def));
                }
                mspring_network_destroy(network);
            }
    }
}

static void nothing_gets_in_explicitly(void **state) {
    (void)state;
    nothing_gets_in(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 1});
    nothing_gets_in(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 7});
}

static void nothing_gets_in_implicitly(void **state) {
    (void)state;
    nothing_gets_in(&(grounds_way){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA, 1});
    nothing_gets_in(&(grounds_way){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1});
    nothing_gets_in(&(grounds_way){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 2});
    nothing_gets_in(&(grounds_way){MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA, 1});
}

/// What begins inside the floor is put onto it.
static void what_is_inside_is_lifted(void **state) {
    (void)state;
    static ground grounds[6];
    const uint32_t count = grounds_make(grounds, 0, 0);
    for (uint32_t i = 0; i < count; i++) {
        mspring_floor_def *def = &grounds[i].def;
        def->planes = grounds[i].planes;
        def->heights = grounds[i].heights;
        if (def->plane_count == 2)
            continue; // below a wedge there is no nearest point of both
        mspring_builder *builder = support_builder();
        (void)support_particle(builder, 3, -25, 1);
        mspring_network_def settings = support_def(-9.8f, 4);
        mspring_network *network = support_network(builder, &settings);
        check_ok(mspring_network_set_floor(network, def));
        check_ok(mspring_network_step(network, 1.0 / 64));
        assert_true(lowest(network, def) > -GROUNDS_TOLERANCE);
        mspring_network_destroy(network);
    }
}

/* -------------------------------------------------------------------------------------------- single particles */

static mspring_network *one_particle(double x, double y, float vx, float vy, double mass) {
    mspring_builder *builder = support_builder();
    mspring_particle_def particle;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    particle.x = x;
    particle.y = y;
    particle.vx = vx;
    particle.vy = vy;
    particle.mass = (float)mass;
    check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    mspring_network_def def = support_def(-9.8f, 1);
    return support_network(builder, &def);
}

/// A particle that slides is slowed by friction g, and then stays: v(t) = v - friction g t, over v^2 / (2 friction
/// g).
static void friction_slows(const grounds_way *how) {
    const double friction = 0.5, speed = 8, dt = 1.0 / 64;
    mspring_network *network = one_particle(0, 0, (float)speed, 0, 2);
    mspring_floor_def def = grounds_level((float)friction, 0);
    grounds_step_by(network, how);
    check_ok(mspring_network_set_floor(network, &def));
    support_steps(network, 64, dt);
    // Explicit velocities are half a substep old. Single precision adds 64 or so changes of velocity, each right to
    // 6e-8 of 8 m/s.
    const double h = dt / how->substeps, age = how->solver == MSPRING_SOLVER_EXPLICIT ? h / 2 : 0;
    check_near(support_velocity(network, 0).x, speed - friction * g * (1.0 - age), 1e-4);
    support_steps(network, 64, dt);
    assert_true(support_velocity(network, 0).x == 0);
    // It stops within a substep.
    check_near(support_position(network, 0).x, speed * speed / (2 * friction * g), 0.5 * speed * h + 1e-3);
    assert_true(fabs(support_position(network, 0).y) < 1e-6);
    float impulse_x, impulse_y;
    check_ok(mspring_network_get_columns(network, NULL, 0, 1,
                                         (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &impulse_x},
                                                                  {MSPRING_FLOOR_IMPULSE_Y, 1, &impulse_y}},
                                         2));
    check_near(impulse_y, 2 * g * dt, 1e-5); // bears its weight
    check_near(impulse_x, 0, 1e-9);
    mspring_network_destroy(network);
}

static void friction_slows_explicitly(void **state) {
    (void)state;
    friction_slows(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 1});
    friction_slows(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 40});
}

/// On a slope of angle a, a particle stays if friction >= tan a, and else slides with g (sin a - friction cos a).
static void slopes_hold_by_friction(const grounds_way *how) {
    const double age = how->solver == MSPRING_SOLVER_EXPLICIT ? 0.5 / 64 / how->substeps : 0; // of velocities, s
    for (int32_t degrees = -40; degrees <= 40; degrees += 20)
        for (int over = 0; over < 2; over++) {
            const double angle = degrees * 3.14159265358979 / 180, slope = tan(angle);
            const double friction = fabs(slope) * (over ? 1.02 : 0.8);
            mspring_network *network = one_particle(5 * cos(angle), 5 * sin(angle), 0, 0, 3);
            const double plane[4] = {0, 0, -sin(angle), cos(angle)};
            mspring_floor_def def = grounds_level((float)friction, 0);
            def.planes = plane;
            grounds_step_by(network, how);
            check_ok(mspring_network_set_floor(network, &def));
            support_steps(network, 128, 1.0 / 64);
            const support_point v = support_velocity(network, 0), p = support_position(network, 0);
            const double speed = v.x * cos(angle) + v.y * sin(angle),
                         slid = p.x * cos(angle) + p.y * sin(angle) - 5;
            const double expected =
                over ? 0 : -(degrees > 0 ? 1 : -1) * (2 - age) * g * (fabs(sin(angle)) - friction * cos(angle));
            // Rounding alone: a tenth of a millimetre in two seconds, where there is a slope at all.
            check_near(speed, degrees == 0 ? 0 : expected, 1e-3 + 1e-4 * fabs(expected));
            if (over || degrees == 0)
                check_near(slid, 0, 1e-4);
            mspring_network_destroy(network);
        }
}

static void slopes_hold_explicitly(void **state) {
    (void)state;
    slopes_hold_by_friction(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 1});
    slopes_hold_by_friction(&(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 40});
}

/// Of a loose particle, which is no part of the linear system. (One of second order was pushed up the slope in
/// every substep by as much as it falls in one.)
static void slopes_hold_implicitly(void **state) {
    (void)state;
    for (mspring_integrator i = MSPRING_INTEGRATOR_ALPHA; i <= MSPRING_INTEGRATOR_EULER; i++) {
        slopes_hold_by_friction(&(grounds_way){MSPRING_SOLVER_IMPLICIT, i, 1});
        slopes_hold_by_friction(&(grounds_way){MSPRING_SOLVER_DIRECT, i, 3});
    }
}

/// The n-th bounce goes as high as e^2n of the first height.
static void bounces_lose_height(void **state) {
    (void)state;
    const double e = 0.7, height = 2, dt = 1.0 / 64;
    const uint32_t substeps = 100;
    mspring_network *network = one_particle(0, height, 0, 0, 1);
    mspring_floor_def def = grounds_level(0, (float)e);
    grounds_step_by(network, &(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, substeps});
    check_ok(mspring_network_set_floor(network, &def));
    double top[5] = {0};
    uint32_t bounces = 0;
    while (bounces < COUNT_OF(top)) {
        float impulse_x, impulse_y;
        check_ok(mspring_network_step(network, dt));
        check_ok(mspring_network_get_columns(network, NULL, 0, 1,
                                             (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &impulse_x},
                                                                      {MSPRING_FLOOR_IMPULSE_Y, 1, &impulse_y}},
                                             2));
        bounces += impulse_y > 0;
        if (bounces < COUNT_OF(top))
            top[bounces] = fmax(top[bounces], support_position(network, 0).y);
    }
    for (uint32_t i = 0; i < COUNT_OF(top); i++) {
        // Each bounce may be off by a substep's grounds_way at its speed; the top lies between steps, so up to g
        // dt^2 / 8 are not seen.
        const double substep_way = sqrt(2 * g * height) * dt / substeps;
        check_near(top[i], height * pow(e, 2 * i), (i + 1) * substep_way + g * dt * dt / 8);
    }
    support_steps(network, 640, dt);
    // At rest but for what it falls in a substep.
    assert_true(fabs(support_velocity(network, 0).y) < g * dt / substeps &&
                fabs(support_position(network, 0).y) < 1e-5);
    mspring_network_destroy(network);
}

/// The part of a field of heights under a particle may rise on either side of it.
static void slopes_bear_what_falls_on_them(void **state) {
    (void)state;
    const float heights[] = {0, 10, 0};
    mspring_floor_def def = grounds_def();
    def.heights = heights;
    def.height_count = COUNT_OF(heights);
    def.heights_x = -10;
    def.spacing = 10;
    def.friction = 2; // more than the slopes' 1: it stays where it meets them
    for (double x = -4; x <= 4; x += 8) {
        mspring_network *network = one_particle(x, 8, 0, 0, 5);
        check_ok(mspring_network_set_floor(network, &def));
        support_steps(network, 128, 1.0 / 64);
        check_near(support_position(network, 0).y, 6, 0.1); // it falls 2 m at up to 6.3 m/s: 0.1 m in a step
        check_near(grounds_above(&def, support_position(network, 0).x, support_position(network, 0).y), 0,
                   GROUNDS_TOLERANCE);
        mspring_network_destroy(network);
    }
}

/// In a valley of a field of heights a particle ends at the bottom, in a straight one without friction with the
/// energy it had.
static void valleys_collect(void **state) {
    (void)state;
    const float heights[] = {6, 3, 0, 3, 6};
    mspring_floor_def def = grounds_def();
    def.heights = heights;
    def.height_count = COUNT_OF(heights);
    def.heights_x = -8;
    def.spacing = 4;
    def.heights_y = -30;
    def.friction = 0.1f;
    mspring_network *network = one_particle(6, -20, 0, 0, 5);
    check_ok(mspring_network_set_floor(network, &def));
    grounds_step_by(network, &(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 40});
    support_steps(network, 64 * 60, 1.0 / 64);
    check_near(support_position(network, 0).x, 0, 1e-3);
    check_near(support_position(network, 0).y, -30, 1e-3);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------------- same bits */

static void levels_and_workers_agree(void **state) {
    (void)state;
    static ground grounds[6];
    const uint32_t count = grounds_make(grounds, 0, 0);
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    for (uint32_t i = 0; i < count; i++) {
        mspring_floor_def *def = &grounds[i].def;
        def->planes = grounds[i].planes;
        def->heights = grounds[i].heights;
        uint64_t first = 0;
        for (uint32_t run = 0; run < level_count + 2; run++) {
            const mspring_simd simd = run < level_count ? levels[run] : MSPRING_SIMD_AUTO;
            mspring_network *network = thrown(0, 0, def, run < level_count ? 1 : run - level_count + 2, simd);
            grounds_step_by(network, &(grounds_way){MSPRING_SOLVER_EXPLICIT, 0, 8});
            check_ok(mspring_network_set_floor(network, def));
            support_steps(network, 100, 1.0 / 64);
            first = run == 0 ? support_hash(network) : first;
            assert_true(support_hash(network) == first);
            mspring_network_destroy(network);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_gets_in_explicitly),
        cmocka_unit_test(nothing_gets_in_implicitly),
        cmocka_unit_test(what_is_inside_is_lifted),
        cmocka_unit_test(friction_slows_explicitly),
        cmocka_unit_test(slopes_hold_explicitly),
        cmocka_unit_test(slopes_hold_implicitly),
        cmocka_unit_test(bounces_lose_height),
        cmocka_unit_test(slopes_bear_what_falls_on_them),
        cmocka_unit_test(valleys_collect),
        cmocka_unit_test(levels_and_workers_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
