/// @file test_floor.c
/// The floor: nothing gets through it, what lies on it lies still, friction and restitution as in closed forms.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

static const double g = 9.8;

/// How a network is stepped.
typedef struct way {
    mspring_solver solver;
    mspring_integrator integrator;
    uint32_t substeps;
} way;

static void set_way(mspring_network *network, const way *to) {
    mspring_solver_def def;
    check_ok(mspring_solver_def_init(&def, sizeof def));
    def.solver = to->solver;
    def.integrator = to->integrator;
    def.substeps = to->substeps;
    check_ok(mspring_network_set_solver(network, &def));
    check_ok(support_set_guard(network, support_guard_of(to->solver)));
}

static mspring_floor_def floor_def(void) {
    mspring_floor_def def;
    check_ok(mspring_floor_def_init(&def, sizeof def));
    return def;
}

/// The half-plane above y = 0.
static const double level[4] = {0, 0, 0, 1};

static mspring_floor_def level_floor(float friction, float restitution) {
    mspring_floor_def def = floor_def();
    def.planes = level;
    def.plane_count = 1;
    def.friction = friction;
    def.restitution = restitution;
    return def;
}

/* --------------------------------------------------------------------------------------------- nothing gets in */

enum { MOST_HEIGHTS = 64 };

/// A floor, and how far a point is above it by this test's own reckoning.
typedef struct ground {
    const char *name;
    mspring_floor_def def;
    double planes[4 * 4];
    float heights[MOST_HEIGHTS];
} ground;

static double height_of(const mspring_floor_def *def, double x) {
    const double place = (x - def->heights_x) / def->spacing;
    if (place <= 0)
        return def->heights_y + (double)def->heights[0];
    if (place >= def->height_count - 1)
        return def->heights_y + (double)def->heights[def->height_count - 1];
    const uint32_t i = (uint32_t)place;
    const double share = place - i;
    return def->heights_y + (1 - share) * (double)def->heights[i] + share * (double)def->heights[i + 1];
}

/// How much a field rises in a metre at x.
static double slope_of(const mspring_floor_def *def, double x) {
    const double place = (x - def->heights_x) / def->spacing;
    if (!(place > 0 && place < def->height_count - 1))
        return 0;
    const uint32_t i = (uint32_t)place;
    return ((double)def->heights[i + 1] - (double)def->heights[i]) / def->spacing;
}

/// Smallest of the distances from the planes and from the stretch of the field below: rounding that is along x is
/// sixteen times as much in height at a cliff.
static double above(const mspring_floor_def *def, double x, double y) {
    double least = INFINITY;
    for (uint32_t i = 0; i < def->plane_count; i++) {
        const double *plane = def->planes + 4 * i;
        const double length = sqrt(plane[2] * plane[2] + plane[3] * plane[3]);
        least = fmin(least, ((x - plane[0]) * plane[2] + (y - plane[1]) * plane[3]) / length);
    }
    if (def->height_count > 0)
        least = fmin(least, (y - height_of(def, x)) / hypot(1, slope_of(def, x)));
    return least;
}

/// Floors of all kinds around (x, y), all with room above.
static uint32_t make_grounds(ground *to, double x, double y) {
    uint64_t seed = 5;
    memset(to, 0, 6 * sizeof *to);
    const char *names[] = {"level", "tilted", "box", "wedge", "hills", "cliffs"};
    for (uint32_t i = 0; i < 6; i++) {
        to[i].name = names[i];
        to[i].def = floor_def();
        to[i].def.friction = 0.3f;
        to[i].def.restitution = 0.4f;
    }
    memcpy(to[0].planes, (double[]){x, y, 0, 1}, sizeof level);
    to[0].def.plane_count = 1;
    memcpy(to[1].planes, (double[]){x, y, -3, 4}, sizeof level);
    to[1].def.plane_count = 1;
    memcpy(to[2].planes, (double[]){x, y, 0, 2, x - 30, y, 5, 0, x + 30, y, -1, 0, x, y + 60, 0, -1},
           4 * sizeof level);
    to[2].def.plane_count = 4;
    memcpy(to[3].planes, (double[]){x, y, 9, 1, x, y, -9, 1}, 2 * sizeof level);
    to[3].def.plane_count = 2;
    for (uint32_t i = 0; i < MOST_HEIGHTS; i++) {
        to[4].heights[i] = (float)support_random_between(&seed, -3, 0);
        to[5].heights[i] = i / 8 % 2 ? -20.0f : 0.0f;
    }
    for (uint32_t i = 4; i < 6; i++) {
        to[i].def.height_count = MOST_HEIGHTS;
        to[i].def.heights_x = x - 40;
        to[i].def.heights_y = y;
        to[i].def.spacing = 1.25;
    }
    return 6;
}

enum { THROWN = 300 };

/// Loose particles, and pairs on springs, at most 20 m above (x, y) and at up to 100 m/s in x and y.
static mspring_network *thrown(double x, double y, const mspring_floor_def *def, uint32_t workers,
                               mspring_simd simd) {
    mspring_builder *builder = support_builder();
    uint64_t seed = 9;
    for (uint32_t i = 0; i < THROWN; i++) {
        mspring_particle_def particle;
        check_ok(mspring_particle_def_init(&particle, sizeof particle));
        do {
            particle.x = x + support_random_between(&seed, -15, 15);
            particle.y = y + support_random_between(&seed, 0, 20);
        } while (above(def, particle.x, particle.y) < 0.01);
        particle.vx = (float)support_random_between(&seed, -100, 100);
        particle.vy = (float)support_random_between(&seed, -100, 100);
        check_ok(mspring_builder_add_particle(builder, &particle, NULL));
        if (i > THROWN / 2)
            (void)support_spring(builder, i - 1, i, 100, 1);
    }
    mspring_network_def settings = support_def(-9.8f, 1);
    settings.worker_count = workers;
    settings.simd_level = simd;
    return support_network(builder, &settings);
}

/// Positions are floats relative to an origin that is within 100 m or so: half a last place of them is 4e-6 m, and
/// the library leaves distances of some of these alone.
static const double tolerance = 2e-4;

static double lowest(const mspring_network *network, const mspring_floor_def *def) {
    static double x[THROWN], y[THROWN];
    double least = INFINITY;
    check_ok(mspring_network_get_positions(network, 0, mspring_network_particle_count(network), x, y, 1));
    for (uint32_t i = 0; i < mspring_network_particle_count(network); i++)
        least = fmin(least, above(def, x[i], y[i]));
    return least;
}

static void nothing_gets_in(const way *how) {
    static ground grounds[6];
    const double places[2][2] = {{0, 0}, {10000.3, -7000.7}}, lengths[] = {1.0 / 64, 1.0 / 15};
    for (uint32_t p = 0; p < 2; p++) {
        const uint32_t count = make_grounds(grounds, places[p][0], places[p][1]);
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t l = ROUNDS_ARE_FEW ? i % 2 : 0; l < (ROUNDS_ARE_FEW ? i % 2 + 1 : 2); l++) {
                mspring_floor_def *def = &grounds[i].def;
                def->planes = grounds[i].planes;
                def->heights = grounds[i].heights;
                mspring_network *network = thrown(places[p][0], places[p][1], def, 1, MSPRING_SIMD_AUTO);
                set_way(network, how);
                check_ok(mspring_network_set_floor(network, def));
                for (uint32_t step = 0; step < ROUNDS(120); step++) {
                    check_ok(mspring_network_step(network, lengths[l]));
                    if (lowest(network, def) < -tolerance)
                        fail_msg("%s at (%g, %g), dt = %g s, step %u: a particle is %g m too low", grounds[i].name,
                                 places[p][0], places[p][1], lengths[l], step, -lowest(network, def));
                }
                mspring_network_destroy(network);
            }
    }
}

static void nothing_gets_in_explicitly(void **state) {
    (void)state;
    nothing_gets_in(&(way){MSPRING_SOLVER_EXPLICIT, 0, 1});
    nothing_gets_in(&(way){MSPRING_SOLVER_EXPLICIT, 0, 7});
}

static void nothing_gets_in_implicitly(void **state) {
    (void)state;
    nothing_gets_in(&(way){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_GA0, 1});
    nothing_gets_in(&(way){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1});
    nothing_gets_in(&(way){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 2});
    nothing_gets_in(&(way){MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_GA0, 1});
}

/// What begins inside the floor is put onto it.
static void what_is_inside_is_lifted(void **state) {
    (void)state;
    static ground grounds[6];
    const uint32_t count = make_grounds(grounds, 0, 0);
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
        assert_true(lowest(network, def) > -tolerance);
        mspring_network_destroy(network);
    }
}

/* -------------------------------------------------------------------------------------------- single particles */

static mspring_network *one_particle(double x, double y, float vx, float vy, double mass) {
    mspring_builder *builder = support_builder();
    mspring_particle_def particle;
    check_ok(mspring_particle_def_init(&particle, sizeof particle));
    particle.x = x;
    particle.y = y;
    particle.vx = vx;
    particle.vy = vy;
    particle.mass = (float)mass;
    check_ok(mspring_builder_add_particle(builder, &particle, NULL));
    mspring_network_def def = support_def(-9.8f, 1);
    return support_network(builder, &def);
}

/// A particle that slides is slowed by friction g, and then stays: v(t) = v - friction g t, over v^2 / (2 friction
/// g).
static void friction_slows(const way *how) {
    const double friction = 0.5, speed = 8, dt = 1.0 / 64;
    mspring_network *network = one_particle(0, 0, (float)speed, 0, 2);
    mspring_floor_def def = level_floor((float)friction, 0);
    set_way(network, how);
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
    check_ok(mspring_network_get_floor_impulses(network, 0, 1, &impulse_x, &impulse_y, 1));
    check_near(impulse_y, 2 * g * dt, 1e-5); // bears its weight
    check_near(impulse_x, 0, 1e-9);
    mspring_network_destroy(network);
}

static void friction_slows_explicitly(void **state) {
    (void)state;
    friction_slows(&(way){MSPRING_SOLVER_EXPLICIT, 0, 1});
    friction_slows(&(way){MSPRING_SOLVER_EXPLICIT, 0, 40});
}

/// On a slope of angle a, a particle stays if friction >= tan a, and else slides with g (sin a - friction cos a).
static void slopes_hold_by_friction(const way *how) {
    const double age = how->solver == MSPRING_SOLVER_EXPLICIT ? 0.5 / 64 / how->substeps : 0; // of velocities, s
    for (int32_t degrees = -40; degrees <= 40; degrees += 20)
        for (int over = 0; over < 2; over++) {
            const double angle = degrees * 3.14159265358979 / 180, slope = tan(angle);
            const double friction = fabs(slope) * (over ? 1.02 : 0.8);
            mspring_network *network = one_particle(5 * cos(angle), 5 * sin(angle), 0, 0, 3);
            const double plane[4] = {0, 0, -sin(angle), cos(angle)};
            mspring_floor_def def = level_floor((float)friction, 0);
            def.planes = plane;
            set_way(network, how);
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
    slopes_hold_by_friction(&(way){MSPRING_SOLVER_EXPLICIT, 0, 1});
    slopes_hold_by_friction(&(way){MSPRING_SOLVER_EXPLICIT, 0, 40});
}

/// Of a loose particle, which is no part of the linear system. (One of second order was pushed up the slope in
/// every substep by as much as it falls in one.)
static void slopes_hold_implicitly(void **state) {
    (void)state;
    for (mspring_integrator i = MSPRING_INTEGRATOR_GA0; i <= MSPRING_INTEGRATOR_EULER; i++) {
        slopes_hold_by_friction(&(way){MSPRING_SOLVER_IMPLICIT, i, 1});
        slopes_hold_by_friction(&(way){MSPRING_SOLVER_DIRECT, i, 3});
    }
}

/// The n-th bounce goes as high as e^2n of the first height.
static void bounces_lose_height(void **state) {
    (void)state;
    const double e = 0.7, height = 2, dt = 1.0 / 64;
    const uint32_t substeps = 100;
    mspring_network *network = one_particle(0, height, 0, 0, 1);
    mspring_floor_def def = level_floor(0, (float)e);
    set_way(network, &(way){MSPRING_SOLVER_EXPLICIT, 0, substeps});
    check_ok(mspring_network_set_floor(network, &def));
    double top[5] = {0};
    uint32_t bounces = 0;
    while (bounces < COUNT_OF(top)) {
        float impulse_x, impulse_y;
        check_ok(mspring_network_step(network, dt));
        check_ok(mspring_network_get_floor_impulses(network, 0, 1, &impulse_x, &impulse_y, 1));
        bounces += impulse_y > 0;
        if (bounces < COUNT_OF(top))
            top[bounces] = fmax(top[bounces], support_position(network, 0).y);
    }
    for (uint32_t i = 0; i < COUNT_OF(top); i++) {
        // Each bounce may be off by a substep's way at its speed; the top lies between steps, so up to g dt^2 / 8
        // are not seen.
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
    mspring_floor_def def = floor_def();
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
        check_near(above(&def, support_position(network, 0).x, support_position(network, 0).y), 0, tolerance);
        mspring_network_destroy(network);
    }
}

/// In a valley of a field of heights a particle ends at the bottom, in a straight one without friction with the
/// energy it had.
static void valleys_collect(void **state) {
    (void)state;
    const float heights[] = {6, 3, 0, 3, 6};
    mspring_floor_def def = floor_def();
    def.heights = heights;
    def.height_count = COUNT_OF(heights);
    def.heights_x = -8;
    def.spacing = 4;
    def.heights_y = -30;
    def.friction = 0.1f;
    mspring_network *network = one_particle(6, -20, 0, 0, 5);
    check_ok(mspring_network_set_floor(network, &def));
    set_way(network, &(way){MSPRING_SOLVER_EXPLICIT, 0, 40});
    support_steps(network, 64 * 60, 1.0 / 64);
    check_near(support_position(network, 0).x, 0, 1e-3);
    check_near(support_position(network, 0).y, -30, 1e-3);
    mspring_network_destroy(network);
}

/* ---------------------------------------------------------------------------------------------------- networks */

/// The 80x5 bar of the other tests, its lowest row at height y, none of it pinned. Its springs bear 40 substeps in
/// a step of 1 / 64 s.
static mspring_network *bar(double y, uint32_t workers, mspring_simd simd) {
    recipe made = {0};
    uint64_t seed = 1;
    const double mass = 73.3975, h = 1.0 / 64 / 40, k = 0.25 * mass / 2 / (h * h), c = 0.03 * mass / 2 / h;
    const recipe_stuff stuff = {.mass = {mass, mass}, .stiffness = {k, k}, .damping = {c, c}};
    recipe_lattice(&made, 80, 5, 0, y, 1, &stuff, &seed);
    mspring_network_def def = support_def(-9.8f, 40);
    def.worker_count = workers;
    def.simd_level = simd;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static double rms_speed(const mspring_network *network) {
    static float vx[400], vy[400];
    double sum = 0;
    check_ok(mspring_network_get_velocities(network, 0, 400, vx, vy, 1));
    for (uint32_t i = 0; i < 400; i++)
        sum += (double)vx[i] * vx[i] + (double)vy[i] * vy[i];
    return sqrt(sum / 400);
}

static double centre_x(const mspring_network *network) {
    static double x[400], y[400];
    double sum = 0;
    check_ok(mspring_network_get_positions(network, 0, 400, x, y, 1));
    for (uint32_t i = 0; i < 400; i++)
        sum += x[i];
    return sum / 400;
}

/// A bar that has fallen by half a metre comes to rest, and does not move on.
static void bars_lie_still(const way *how, uint32_t seconds) {
    mspring_network *network = bar(0.5, 1, MSPRING_SIMD_AUTO);
    mspring_floor_def def = level_floor(0.5f, 0.1f);
    set_way(network, how);
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(support_set_global_damping(network, 0.2f));
    support_steps(network, 64 * seconds, 1.0 / 64);
    const double before = centre_x(network);
    double most = 0;
    for (uint32_t step = 0; step < 64 * 5; step++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
        most = fmax(most, rms_speed(network));
    }
    // A free bar that rounding alone keeps moving has 0.006 m/s (see test_rest.c).
    if (most > 0.01)
        fail_msg("the bar moves at %g m/s", most);
    check_near(centre_x(network) - before, 0, 1e-3);
    // The floor bears the weight, but for how fast the bar still moves.
    static float impulse_x[400], impulse_y[400];
    double sum = 0;
    check_ok(mspring_network_get_floor_impulses(network, 0, 400, impulse_x, impulse_y, 1));
    for (uint32_t i = 0; i < 400; i++)
        sum += (double)impulse_y[i];
    const double weight = 400 * 73.3975 * g / 64;
    check_near(sum, weight, 0.01 * weight);
    mspring_network_destroy(network);
}

static void bars_lie_still_explicitly(void **state) {
    (void)state;
    bars_lie_still(&(way){MSPRING_SOLVER_EXPLICIT, 0, 40}, 30);
}

static const way implicit_ways[] = {
    {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_GA0, 1},
    {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1},
    {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 1},
    {MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_GA0, 1},
};

static void bars_lie_still_implicitly(void **state) {
    (void)state;
    for (uint32_t i = 0; i < COUNT_OF(implicit_ways); i++)
        bars_lie_still(&implicit_ways[i], 8); // which take the bounce out sooner
}

/// A bar that slides comes to a stop as a block does: v^2 / (2 friction g) further on.
static void bars_slide(const way *how) {
    const double friction = 0.4, speed = 6;
    static float vx[400], vy[400];
    mspring_network *network = bar(0, 1, MSPRING_SIMD_AUTO);
    mspring_floor_def def = level_floor((float)friction, 0);
    for (uint32_t i = 0; i < 400; i++)
        vx[i] = (float)speed;
    set_way(network, how);
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(mspring_network_set_velocities(network, 0, 400, vx, vy, 1));
    const double start = centre_x(network);
    support_steps(network, 64, 1.0 / 64);
    check_ok(mspring_network_get_velocities(network, 0, 400, vx, vy, 1));
    double mean = 0;
    for (uint32_t i = 0; i < 400; i++)
        mean += (double)vx[i] / 400;
    // It also bounces up and down in itself, so that what lies on the floor at the end of the second is not its
    // weight but within a few per cent of it.
    check_near(mean, speed - friction * g, 0.03 * speed);
    support_steps(network, 64 * 3, 1.0 / 64);
    const double way_to_stop = speed * speed / (2 * friction * g);
    check_near(centre_x(network) - start, way_to_stop, 0.03 * way_to_stop);
    mspring_network_destroy(network);
}

static void bars_slide_explicitly(void **state) {
    (void)state;
    bars_slide(&(way){MSPRING_SOLVER_EXPLICIT, 0, 40});
}

static void bars_slide_implicitly(void **state) {
    (void)state;
    for (uint32_t i = 0; i < COUNT_OF(implicit_ways); i++)
        bars_slide(&implicit_ways[i]);
}

static double energy(const mspring_network *network) {
    double kinetic, elastic, potential;
    check_ok(mspring_network_energy(network, &kinetic, &elastic, &potential));
    return kinetic + elastic + potential;
}

/// A bar that falls at an angle, turning, loses energy all the time and never gains any.
static void contact_gives_no_energy(const way *how, double restitution, double dt, double share) {
    static double x[400], y[400];
    static float vx[400], vy[400];
    mspring_network *network = bar(0, 1, MSPRING_SIMD_AUTO);
    mspring_floor_def def = level_floor(0.3f, (float)restitution);
    check_ok(mspring_network_get_positions(network, 0, 400, x, y, 1));
    for (uint32_t i = 0; i < 400; i++) {
        const double along = x[i], up = y[i];
        x[i] = 0.96 * along - 0.28 * up;
        y[i] = 3 + 0.28 * along + 0.96 * up;
        vx[i] = (float)(2 - 0.5 * (y[i] - 15));
        vy[i] = (float)(-10 + 0.5 * (x[i] - 40));
    }
    set_way(network, how);
    check_ok(mspring_network_set_positions(network, 0, 400, x, y, 1));
    check_ok(mspring_network_set_velocities(network, 0, 400, vx, vy, 1));
    check_ok(mspring_network_set_floor(network, &def));
    const double whole = energy(network);
    double least = whole;
    for (double time = 0; time < 10; time += dt) {
        check_ok(mspring_network_step(network, dt));
        const double now = energy(network);
        if (now > least + share * whole || now > (1 + share / 10) * whole)
            fail_msg("solver %d, integrator %d, time %g, restitution %g, dt %g: energy %g J after %g J at the "
                     "least, of %g J",
                     (int)how->solver, (int)how->integrator, time, restitution, dt, now, least, whole);
        least = fmin(least, now);
    }
    assert_true(least < 0.7 * whole);
    mspring_network_destroy(network);
}

static void explicit_contact_gives_no_energy(void **state) {
    (void)state;
    // What leapfrog itself lets energy swing by: about omega h / 2 of what oscillates, which is a part of
    // the whole.
    for (int i = 0; i <= 2; i++)
        contact_gives_no_energy(&(way){MSPRING_SOLVER_EXPLICIT, 0, 40}, 0.5 * i, 1.0 / 64, 0.02);
}

/// A bar that breaks into squares and single particles, and is compacted in the air and on the floor.
static void compaction_keeps_the_floor(void **state) {
    (void)state;
    static ground grounds[6];
    (void)make_grounds(grounds, 40, 0);
    mspring_floor_def *def = &grounds[4].def;
    def->planes = grounds[4].planes;
    def->heights = grounds[4].heights;
    mspring_network *network = bar(1, 1, MSPRING_SIMD_AUTO);
    check_ok(mspring_network_set_floor(network, def));
    for (uint32_t round = 0; round < 4; round++) {
        const uint32_t springs = mspring_network_spring_count(network);
        for (mspring_id s = round; s < springs; s += 3)
            check_ok(mspring_network_break_springs(network, &s, 1));
        check_ok(mspring_network_compact(network));
        for (uint32_t step = 0; step < 64; step++) {
            static double x[400], y[400];
            check_ok(mspring_network_step(network, 1.0 / 64));
            check_ok(mspring_network_get_positions(network, 0, 400, x, y, 1));
            for (uint32_t i = 0; i < 400; i++)
                assert_true(above(def, x[i], y[i]) > -tolerance);
        }
        if (round == 2)
            check_ok(mspring_network_expand(network));
    }
    mspring_network_destroy(network);
}

static void implicit_contact_gives_no_energy(void **state) {
    (void)state;
    for (uint32_t i = 0; i < COUNT_OF(implicit_ways); i += ROUNDS_ARE_FEW ? 3 : 1) {
        contact_gives_no_energy(&implicit_ways[i], 0, 1.0 / 64, 0.01);
        contact_gives_no_energy(&implicit_ways[i], 0.5, 1.0 / 64, 0.01);
    }
    // In steps as long as these, in which the bar turns by 2 degrees, methods of second order gain energy in the
    // air.
    contact_gives_no_energy(&(way){MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 1}, 0.5, 1.0 / 15, 0.05);
    contact_gives_no_energy(&(way){MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_EULER, 1}, 0.5, 1.0 / 15, 0.05);
}

/* --------------------------------------------------------------------------------------------------- same bits */

static void levels_and_workers_agree(void **state) {
    (void)state;
    static ground grounds[6];
    const uint32_t count = make_grounds(grounds, 0, 0);
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
            set_way(network, &(way){MSPRING_SOLVER_EXPLICIT, 0, 8});
            check_ok(mspring_network_set_floor(network, def));
            support_steps(network, 100, 1.0 / 64);
            first = run == 0 ? support_hash(network) : first;
            assert_true(support_hash(network) == first);
            mspring_network_destroy(network);
        }
    }
    for (uint32_t i = 0; i < COUNT_OF(implicit_ways); i++) {
        uint64_t first = 0;
        for (uint32_t run = 0; run < level_count + 2; run++) {
            const mspring_simd simd = run < level_count ? levels[run] : MSPRING_SIMD_AUTO;
            mspring_network *network = bar(0.5, run < level_count ? 1 : run - level_count + 2, simd);
            set_way(network, &implicit_ways[i]);
            check_ok(mspring_network_set_floor(network, &grounds[4].def));
            support_steps(network, 60, 1.0 / 64);
            first = run == 0 ? support_hash(network) : first;
            assert_true(support_hash(network) == first);
            mspring_network_destroy(network);
        }
    }
    uint64_t first = 0;
    for (uint32_t run = 0; run < level_count + 2; run++) {
        const mspring_simd simd = run < level_count ? levels[run] : MSPRING_SIMD_AUTO;
        mspring_network *network = bar(0.5, run < level_count ? 1 : run - level_count + 2, simd);
        check_ok(mspring_network_set_floor(network, &grounds[4].def));
        support_steps(network, 100, 1.0 / 64);
        first = run == 0 ? support_hash(network) : first;
        assert_true(support_hash(network) == first);
        mspring_network_destroy(network);
    }
}

/// A floor that is never reached changes no bit.
static void far_floors_change_nothing(void **state) {
    (void)state;
    mspring_network *with = bar(60, 1, MSPRING_SIMD_AUTO), *without = bar(60, 1, MSPRING_SIMD_AUTO);
    mspring_floor_def def = level_floor(1, 1);
    check_ok(mspring_network_set_floor(with, &def));
    support_steps(with, 100, 1.0 / 64);
    support_steps(without, 100, 1.0 / 64);
    assert_true(support_hash(with) == support_hash(without));
    // And one that is taken away is gone.
    check_ok(mspring_network_set_floor(with, NULL));
    support_steps(with, 300, 1.0 / 64);
    support_steps(without, 300, 1.0 / 64);
    assert_true(support_hash(with) == support_hash(without));
    mspring_network_destroy(with);
    mspring_network_destroy(without);
}

/* ------------------------------------------------------------------------------------------------ taking back */

/// A step that is refused leaves the impulses of the one before.
static void refused_steps_leave_impulses(void **state) {
    (void)state;
    const way ways[] = {{MSPRING_SOLVER_EXPLICIT, 0, 40}, {MSPRING_SOLVER_IMPLICIT, 0, 1}};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = bar(0.01, 1, MSPRING_SIMD_AUTO);
        mspring_floor_def def = level_floor(0.5f, 0);
        static float before[800], after[800];
        float sum = 0;
        set_way(network, &ways[i]);
        check_ok(mspring_network_set_floor(network, &def));
        support_steps(network, 100, 1.0 / 64);
        check_ok(mspring_network_get_floor_impulses(network, 0, 400, before, before + 400, 1));
        for (int p = 0; p < 400; p++) {
            sum += before[400 + p];
        }
        assert_true(sum > 0);
        check_ok(mspring_network_apply_force(network, 3, 0, 1e15f));
        check_error(mspring_network_step(network, 1.0 / 64), MSPRING_ERROR_UNSTABLE);
        check_ok(mspring_network_get_floor_impulses(network, 0, 400, after, after + 400, 1));
        assert_memory_equal(before, after, sizeof before);
        mspring_network_destroy(network);
    }
}

/// Whether the coarse matrix has contacts in it goes by the snapshot, and not by what came after it.
static void snapshots_do_not_see_later_contacts(void **state) {
    (void)state;
    mspring_network *network = bar(3, 1, MSPRING_SIMD_AUTO);
    mspring_solver_def solver;
    check_ok(mspring_solver_def_init(&solver, sizeof solver));
    solver.solver = MSPRING_SOLVER_IMPLICIT;
    solver.coarse_period = 8;
    check_ok(mspring_network_set_solver(network, &solver));
    mspring_floor_def def = level_floor(0.3f, 0);
    check_ok(mspring_network_set_floor(network, &def));
    support_steps(network, 5, 1.0 / 64);
    size_t size;
    check_ok(mspring_network_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
    void *snapshot = malloc(size);
    assert_non_null(snapshot);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, snapshot, size, NULL));
    support_steps(network, 3, 1.0 / 64);
    const uint64_t hash = support_hash(network);
    support_steps(network, 300, 1.0 / 64);
    check_ok(mspring_network_load(network, snapshot, size));
    support_steps(network, 3, 1.0 / 64);
    assert_true(support_hash(network) == hash);
    free(snapshot);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------------ errors */

static void refuse(mspring_network *network, mspring_floor_def def, mspring_result code, const char *part) {
    check_error(mspring_network_set_floor(network, &def), code);
    check_contains(mspring_network_error(network), part);
}

static void errors_name_the_culprit(void **state) {
    (void)state;
    mspring_network *network = one_particle(0, 1, 0, 0, 1);
    mspring_floor_def def = level_floor(0, 0);
    check_ok(mspring_network_set_floor(network, &def));
    refuse(network, floor_def(), MSPRING_ERROR_ARGUMENT, "neither");
    def.friction = -1;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "friction");
    def.friction = NAN;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "friction");
    def = level_floor(0, 1.5f);
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "restitution");
    def = level_floor(0, 0);
    def.struct_size = 3;
    refuse(network, def, MSPRING_ERROR_STRUCT, "mspring_floor_def");
    def = level_floor(0, 0);
    def.plane_count = MSPRING_MAX_PLANES + 1;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "planes");
    const double planes[8] = {0, 0, 0, 1, 0, 0, 0, 0};
    def.plane_count = 2;
    def.planes = planes;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "plane 1");
    def.planes = NULL;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "NULL");
    const double far_plane[4] = {0, 1e13, 0, 1};
    def.plane_count = 1;
    def.planes = far_plane;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "out of bounds");
    float heights[3] = {0, 1, NAN};
    def = floor_def();
    def.height_count = 1;
    def.heights = heights;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "1 heights");
    def.height_count = 3;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "height 2");
    heights[2] = 0;
    def.spacing = 0;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "apart");
    def.spacing = 1;
    def.heights = NULL;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "NULL");
    check_error(mspring_network_set_floor(NULL, &def), MSPRING_ERROR_ARGUMENT);
    float x, y;
    check_error(mspring_network_get_floor_impulses(network, 0, 2, &x, &y, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_get_floor_impulses(network, 0, 1, NULL, &y, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_floor_impulses(NULL, 0, 0, &x, &y, 1), MSPRING_ERROR_ARGUMENT);
    // The floor of before is still there.
    support_steps(network, 128, 1.0 / 64);
    assert_true(support_position(network, 0).y > -tolerance);
    mspring_network_destroy(network);
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
        cmocka_unit_test(bars_lie_still_explicitly),
        cmocka_unit_test(bars_lie_still_implicitly),
        cmocka_unit_test(bars_slide_explicitly),
        cmocka_unit_test(bars_slide_implicitly),
        cmocka_unit_test(explicit_contact_gives_no_energy),
        cmocka_unit_test(implicit_contact_gives_no_energy),
        cmocka_unit_test(compaction_keeps_the_floor),
        cmocka_unit_test(levels_and_workers_agree),
        cmocka_unit_test(far_floors_change_nothing),
        cmocka_unit_test(refused_steps_leave_impulses),
        cmocka_unit_test(snapshots_do_not_see_later_contacts),
        cmocka_unit_test(errors_name_the_culprit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
