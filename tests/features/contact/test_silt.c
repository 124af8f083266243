/// @file test_silt.c
/// Silt above the heights: closed forms of sinking and stopping with every solver, energy and momentum, floors that
/// are still met, bits, and what is refused.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

static const double g = 9.8;
static const float level[2] = {0, 0};

/// Level ground under so much silt.
static mspring_floor_def silt_of(double depth, double rate) {
    mspring_floor_def def;
    check_ok(mspring_floor_def_init(&def, sizeof def));
    def.heights = level;
    def.height_count = 2;
    def.silt_depth = (float)depth;
    def.silt_rate = (float)rate;
    return def;
}

/// How a network is stepped: with each solver and, last, with clamped steps.
enum { CLAMPED = MSPRING_SOLVER_DIRECT + 1, WAYS };

/// Particles 0 and 1, a pair with a spring, and 2, a loose one.
static mspring_network *sinkers(double y, double gravity, double depth, double rate, int way) {
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0, y, 2), b = support_particle(builder, 1, y, 2);
    support_spring(builder, a, b, way == CLAMPED ? 1e9f : 20.0f, 5);
    support_particle(builder, 20, y, 0.5f);
    mspring_network_def def = support_def((float)-gravity, 10);
    def.solver = way == CLAMPED ? MSPRING_SOLVER_EXPLICIT : (mspring_solver)way;
    def.guard = way == CLAMPED ? MSPRING_GUARD_CLAMP : MSPRING_GUARD_GROWTH;
    mspring_network *network = support_network(builder, &def);
    const mspring_floor_def floor = silt_of(depth, rate);
    check_ok(mspring_network_set_floor(network, &floor));
    return network;
}

static void set_speeds(mspring_network *network, float vx, float vy) {
    const float x[3] = {vx, vx, vx}, y[3] = {vy, vy, vy};
    check_ok(mspring_network_set_velocities(network, 0, 3, x, y, 1));
}

/// In the middle of very deep silt, where share is a half: g / (rate / 2), and half a substep's fall; structures of
/// clamped steps are braked after they have moved.
static void what_sinks_has_its_terminal_speed(void **state) {
    (void)state;
    const double dt = 0.01, h = dt / 10, rate = 20, speed = g / (0.5 * rate) + 0.5 * g * h;
    for (int way = 0; way < WAYS; way++) {
        mspring_network *network = sinkers(1e5, g, 2e5, rate, way);
        support_steps(network, 200, dt);
        const support_point from[2] = {support_position(network, 0), support_position(network, 2)};
        support_steps(network, 200, dt);
        const double more = way == CLAMPED ? 0.5 * g * h : 0;
        check_near((from[0].y - support_position(network, 0).y) / (200 * dt), speed + more, 2e-4);
        check_near((from[1].y - support_position(network, 2).y) / (200 * dt), speed, 2e-4);
        // What bears it is the silt.
        for (mspring_id p = 0; p < 3; p++) {
            float x, y;
            check_ok(mspring_network_get_floor_impulses(network, p, 1, &x, &y, 1));
            check_near(y, (p == 2 ? 0.5 : 2) * g * dt, 1e-4);
            check_near(x, 0, 1e-5);
        }
        mspring_network_destroy(network);
    }
}

/// Along level silt a particle comes to rest after v / rate, whatever the substep is. (Structures of implicit and
/// clamped steps are braked after they have moved: by a substep further.)
static void what_slides_stops_after_v_over_rate(void **state) {
    (void)state;
    const double rate = 5, speed = 3;
    for (int way = 0; way < WAYS; way++) {
        for (double dt = 0.004; dt < 2; dt *= 6) {
            mspring_network *network = sinkers(1e4, 0, 2e4, 2 * rate, way);
            set_speeds(network, (float)speed, 0);
            support_steps(network, (uint32_t)(8 / dt) + 20, dt);
            const double further = way == MSPRING_SOLVER_EXPLICIT ? 0 : speed * dt / (way == CLAMPED ? 1 : 10);
            check_near(support_position(network, 2).x, 20 + speed / rate, 1e-4);
            check_near(support_position(network, 0).x, speed / rate + (way == CLAMPED ? 0 : further),
                       (way == CLAMPED ? further : 0) + 1e-3);
            mspring_network_destroy(network);
        }
    }
}

/// From above, without gravity: dv/dy = -rate (1 - y / depth), so it gets sqrt(2 depth v / rate) deep.
static void what_dives_stops_at_its_depth(void **state) {
    (void)state;
    const double depth = 16, rate = 40, speed = 12, way_down = sqrt(2 * depth * speed / rate);
    for (int way = 0; way < WAYS; way++) {
        mspring_network *network = sinkers(depth + 1, 0, depth, rate, way);
        set_speeds(network, 0, (float)-speed);
        support_steps(network, 4000, 0.001);
        check_near(support_position(network, 2).y, depth - way_down, 0.02);
        check_near(support_position(network, 0).y, depth - way_down, 0.02);
        mspring_network_destroy(network);
    }
}

/// The layer follows the ground: at the same height above two slopes it brakes alike, above the silt not at all.
static void it_lies_on_the_heights(void **state) {
    (void)state;
    const float heights[4] = {0, 20, 5, 5};
    mspring_builder *builder = support_builder();
    const double x[] = {5, 15, 25, 40, -9, 5}, ground[] = {10, 12.5, 5, 5, 0, 10}, above[] = {4, 4, 4, 4, 4, 8.5};
    for (size_t i = 0; i < COUNT_OF(x); i++) {
        support_particle(builder, x[i], ground[i] + above[i], 1);
    }
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    mspring_floor_def floor = silt_of(8, 10);
    floor.heights = heights;
    floor.height_count = 4;
    floor.spacing = 10;
    check_ok(mspring_network_set_floor(network, &floor));
    for (mspring_id p = 0; p < COUNT_OF(x); p++) {
        const float vx = 0, vy = 0.25f;
        check_ok(mspring_network_set_velocities(network, p, 1, &vx, &vy, 1));
    }
    const double h = 1e-3, moved = 0.25 * h;
    support_steps(network, 1, h);
    for (mspring_id p = 0; p < COUNT_OF(x); p++) {
        const double share = p == 5 ? 0 : 1 - (above[p] + moved) / 8;
        check_near(support_velocity(network, p).y, 0.25 / (1 + h * 10 * share), 1e-7);
    }
    mspring_network_destroy(network);
}

/// A lattice that falls into silt at any rate, and lies on the ground at last: its energy never grows, and momentum
/// is what gravity and the floor gave.
static void it_takes_energy_and_gives_none(void **state) {
    (void)state;
    const double rates[] = {0.5, 30, 1e6}, dt = 0.01;
    uint64_t seed = 9;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        for (size_t i = 0; i < COUNT_OF(rates); i++) {
            const recipe_stuff stuff = {.mass = {0.5, 2}, .stiffness = {1000, 1500}};
            recipe made = {0};
            recipe_lattice(&made, 8, 4, -4, 7, 1, &stuff, &seed);
            recipe_disturb(&made, 0.05, 2, &seed);
            mspring_network_def def = support_def((float)-g, solver == MSPRING_SOLVER_EXPLICIT ? 40 : 4);
            def.solver = solver;
            mspring_network *network = recipe_network(&made, &def);
            const mspring_floor_def floor = silt_of(6, rates[i]);
            check_ok(mspring_network_set_floor(network, &floor));
            double before = support_energy(network), px, py;
            check_ok(mspring_network_momentum(network, &px, &py, NULL));
            double mass = 0;
            for (uint32_t p = 0; p < made.particle_count; p++) {
                mass += (double)made.particles[p].mass;
            }
            const double first = before;
            for (int step = 0; step < 400; step++) {
                support_steps(network, 1, dt);
                const double now = support_energy(network);
                // The plain energy swings by a part of the elastic one in explicit substeps.
                assert_true(now <= before + 2e-3 * first);
                before = now < before ? now : before;
                float x[64], y[64];
                double gives_x = 0, gives_y, qx, qy;
                const double fallen =
                    step == 0 && solver == MSPRING_SOLVER_EXPLICIT ? dt - dt / 80 : dt; // half of h
                check_ok(mspring_network_get_floor_impulses(network, 0, made.particle_count, x, y, 1));
                gives_y = -mass * g * fallen;
                for (uint32_t p = 0; p < made.particle_count; p++) {
                    gives_x += (double)x[p];
                    gives_y += (double)y[p];
                }
                check_ok(mspring_network_momentum(network, &qx, &qy, NULL));
                check_near(qx - px, gives_x, 2e-3);
                check_near(qy - py, gives_y, 2e-3);
                px = qx, py = qy;
            }
            assert_true(before < 0.95 * first);
            mspring_network_destroy(network);
            recipe_free(&made);
        }
    }
}

/// Whatever comes down fast is braked, but held by the ground alone.
static void nothing_tunnels(void **state) {
    (void)state;
    for (int way = 0; way < WAYS; way++) {
        for (float speed = 10; speed < 2e5f; speed *= 10) {
            mspring_network *network = sinkers(50, g, 10, 20, way);
            set_speeds(network, speed, -speed);
            for (int step = 0; step < 50; step++) {
                support_steps(network, 1, 0.01);
                for (mspring_id p = 0; p < 3; p++) {
                    const support_point at = support_position(network, p);
                    assert_true(at.y >= -1e-6 * (fabs(at.x) + 50));
                }
            }
            mspring_network_destroy(network);
        }
    }
}

/* ---------------------------------------------------------------------------------------------------------- bits
 */

static uint64_t fall(const mspring_network_def *network_def, double depth, double rate, double y) {
    uint64_t seed = 21, hash = 0;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {4000, 5000}, .damping = {1, 2}};
    float heights[30];
    recipe made = {0};
    recipe_lattice(&made, 40, 8, -5, y, 0.5, &stuff, &seed);
    for (uint32_t i = 0; i < 40; i++) {
        recipe_particle(&made, -6.5 + 0.5 * i, y - 0.7, 1, 0);
    }
    for (uint32_t i = 0; i < COUNT_OF(heights); i++) {
        heights[i] = (float)support_random_between(&seed, -0.5, 0.5);
    }
    mspring_network *network = recipe_network(&made, network_def);
    mspring_floor_def def = silt_of(depth, rate);
    def.heights = heights;
    def.height_count = COUNT_OF(heights);
    def.heights_x = -9;
    def.friction = 0.4f;
    def.restitution = 0.3f;
    check_ok(mspring_network_set_floor(network, &def));
    support_steps(network, 60, 1.0 / 64);
    check_ok(mspring_network_state_hash(network, &hash));
    mspring_network_destroy(network);
    recipe_free(&made);
    return hash;
}

static void bits_are_the_same_for_any_workers_and_levels(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_network_def def = support_def((float)-g, solver == MSPRING_SOLVER_EXPLICIT ? 20 : 2);
        def.solver = solver;
        def.global_damping = 0.2f;
        const uint64_t without = fall(&def, 0, 0, 2), with = fall(&def, 3, 10, 2), above = fall(&def, 0, 0, 40);
        assert_true(with != without);
        // None of it, or none within reach.
        assert_true(fall(&def, 0, 10, 2) == without && fall(&def, 3, 0, 2) == without);
        assert_true(fall(&def, 3, 10, 40) == above);
        for (int at = MSPRING_SIMD_SCALAR; at <= MSPRING_SIMD_AVX512; at++) {
            def.simd_level = (mspring_simd)at;
            def.worker_count = (uint32_t)(at % 3 + 1);
            assert_true(fall(&def, 3, 10, 2) == with);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- definitions
 */

static void numbers_have_their_ranges(void **state) {
    (void)state;
    const struct {
        double depth, rate;
        const char *part; ///< of what is said; NULL if it is taken
    } ways[] = {
        {1e12, 1e6, NULL},      {1e-30, 1, NULL},           {0, 1, NULL},
        {1, 0, NULL},           {-1e-9, 1, "silt_depth"},   {1.01e12, 1, "silt_depth"},
        {NAN, 1, "silt_depth"}, {1, -1e-9, "silt_rate"},    {1, 1.01e6, "silt_rate"},
        {1, NAN, "silt_rate"},  {1, INFINITY, "silt_rate"},
    };
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = sinkers(5, g, 1, 1, MSPRING_SOLVER_EXPLICIT);
        const mspring_floor_def def = silt_of(ways[i].depth, ways[i].rate);
        mspring_floor_def had = {.struct_size = sizeof had};
        check_error(mspring_network_set_floor(network, &def), ways[i].part ? MSPRING_ERROR_ARGUMENT : MSPRING_OK);
        if (ways[i].part) {
            check_contains(mspring_network_error(network), ways[i].part);
        }
        check_ok(mspring_network_get_floor(network, &had));
        assert_true(had.silt_depth == (ways[i].part ? 1.0f : def.silt_depth));
        assert_true(had.silt_rate == (ways[i].part ? 1.0f : def.silt_rate));
        support_steps(network, 20, 0.05);
        for (mspring_id p = 0; p < 3; p++) {
            assert_true(isfinite(support_position(network, p).y) && support_position(network, p).y >= -1e-6);
        }
        mspring_network_destroy(network);
    }
}

static void it_lies_on_heights_alone(void **state) {
    (void)state;
    mspring_network *network = sinkers(5, g, 0, 0, MSPRING_SOLVER_EXPLICIT);
    const double plane[4] = {0, 0, 0, 1};
    mspring_floor_def def = silt_of(2, 1);
    def.height_count = 0;
    def.planes = plane;
    def.plane_count = 1;
    check_error(mspring_network_set_floor(network, &def), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "no heights");
    def.silt_depth = 0;
    check_ok(mspring_network_set_floor(network, &def));
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_sinks_has_its_terminal_speed),
        cmocka_unit_test(what_slides_stops_after_v_over_rate),
        cmocka_unit_test(what_dives_stops_at_its_depth),
        cmocka_unit_test(it_lies_on_the_heights),
        cmocka_unit_test(it_takes_energy_and_gives_none),
        cmocka_unit_test(nothing_tunnels),
        cmocka_unit_test(bits_are_the_same_for_any_workers_and_levels),
        cmocka_unit_test(numbers_have_their_ranges),
        cmocka_unit_test(it_lies_on_heights_alone),
    };
    return cmocka_run_group_tests_name("silt", tests, NULL, NULL);
}
