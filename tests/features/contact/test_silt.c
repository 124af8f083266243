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
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
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
    def.settings.solver = way == CLAMPED ? MSPRING_SOLVER_EXPLICIT : (mspring_solver)way;
    def.settings.guard = way == CLAMPED ? MSPRING_GUARD_CLAMP : MSPRING_GUARD_GROWTH;
    mspring_network *network = support_network(builder, &def);
    const mspring_floor_def floor = silt_of(depth, rate);
    check_ok(mspring_network_set_floor(network, &floor));
    return network;
}

static void set_speeds(mspring_network *network, float vx, float vy) {
    const float x[3] = {vx, vx, vx}, y[3] = {vy, vy, vy};
    check_ok(mspring_network_set_velocities(network, NULL, 0, 3, x, y, 1));
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
            check_ok(mspring_network_get_columns(network, NULL, p, 1, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}}, 2));
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
        support_steps(network, 2000, 0.001);
        check_near(support_position(network, 2).y, depth - way_down, 0.02);
        check_near(support_position(network, 0).y, depth - way_down, 0.02);
        mspring_network_destroy(network);
    }
}

/// Depths of 4, 12, 12, 0 and 0 m, 16 m apart.
static const float uneven[5] = {4, 12, 12, 0, 0};

static double uneven_depth(double x) {
    const double place = fmax(0, fmin(x / 16, 4)), part = fmin(floor(place), 3);
    return (double)uneven[(int)part] + (place - part) * (double)(uneven[(int)part + 1] - uneven[(int)part]);
}

/// The pair and the loose particle of sinkers() at these places, above level ground under uneven silt. (The
/// spring of the pair does next to nothing, but for a clamped one.)
static mspring_network *above_uneven_silt(const double x[3], const double y[3], double rate, int way) {
    static const float ground[5] = {0};
    mspring_network *network = sinkers(1, 0, 0, 0, way);
    mspring_floor_def def = silt_of(0, rate);
    def.heights = ground;
    def.height_count = COUNT_OF(uneven);
    def.spacing = 16;
    def.silt_depths = uneven;
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(mspring_network_set_positions(network, NULL, 0, 3, x, y, 1));
    const float length = (float)hypot(x[1] - x[0], y[1] - y[0]), soft = way == CLAMPED ? 1e9f : 1e-6f, none = 0;
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, 1, &length, 1));
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, 1, &soft, 1));
    check_ok(mspring_network_set(network, MSPRING_DAMPING, NULL, 0, 1, &none, 1));
    return network;
}

/// Straight down, without gravity, where the silt is d deep: dv/dy = -rate (1 - y / d), so it gets
/// sqrt(2 d v / rate) deep. Where there is none it comes to the ground.
static void what_dives_stops_by_the_depth_below_it(void **state) {
    (void)state;
    const double rate = 80, speed = 6;
    for (int way = 0; way < WAYS; way++) {
        for (double at = -8; at < 80; at += ROUNDS_ARE_FEW || support_is_quick() ? 24 : 8) {
            // The ends of the clamped pair stay together, so both are over the same depth.
            const double other = way == CLAMPED ? at : at + 16, x[3] = {at, other, at}, y[3] = {13, 13.5, 13};
            mspring_network *network = above_uneven_silt(x, y, rate, way);
            set_speeds(network, 0, (float)-speed);
            support_steps(network, 3500, 0.001);
            for (mspring_id p = way == CLAMPED ? 2 : 0; p < 3; p++) {
                const double d = uneven_depth(x[p]), way_down = sqrt(2 * d * speed / rate);
                check_near(support_position(network, p).y, fmax(0, d - way_down), 0.02);
            }
            mspring_network_destroy(network);
        }
    }
}

/// Level, at a height y, through silt that gets deeper by s on each metre from d on:
/// dv/dx = -rate (1 - y / (d + s x)), so v = v0 - rate (x - y / s log((d + s x) / d)). The local rate counts.
static void what_crosses_a_slope_loses_speed_by_the_local_rate(void **state) {
    (void)state;
    const double rate = 2, speed = 40, height = 2, slope = 0.5;
    for (int way = 0; way < WAYS; way++) {
        const double x[3] = {0, 1, 0}, y[3] = {height, height, height};
        mspring_network *network = above_uneven_silt(x, y, rate, way);
        set_speeds(network, (float)speed, 0);
        for (double before = speed; support_position(network, 2).x < 15; before = speed) {
            support_steps(network, 1, 0.001);
            for (mspring_id p = way == CLAMPED ? 2 : 0; p < 3; p++) {
                const double at = support_position(network, p).x, from = x[p];
                const double share = log((4 + slope * at) / (4 + slope * from));
                const double v = before - rate * (at - from - height / slope * share);
                if (at < 16)
                    check_near((double)support_velocity(network, p).x, v, 2e-3 * speed);
            }
        }
        mspring_network_destroy(network);
    }
}

/// What slides along the ground is not braked where the silt has no depth.
static void there_is_none_where_its_depth_is_0(void **state) {
    (void)state;
    for (int way = 0; way < WAYS; way++) {
        const double x[3] = {50, 51, 50}, y[3] = {0, 0, 0};
        mspring_network *network = above_uneven_silt(x, y, 1e6, way);
        const float vx[3] = {3, 3, 3}, vy[3] = {-0.5f, -0.5f, -0.5f}; // into the ground
        check_ok(mspring_network_set_velocities(network, NULL, 0, 3, vx, vy, 1));
        support_steps(network, 100, 0.01);
        for (mspring_id p = 0; p < 3; p++) {
            check_near(support_position(network, p).x, x[p] + 3, 1e-4);
            check_near(support_position(network, p).y, 0, 1e-6);
        }
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
        check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
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
            def.settings.solver = solver;
            mspring_network *network = recipe_network(&made, &def);
            const mspring_floor_def floor = silt_of(6, rates[i]);
            check_ok(mspring_network_set_floor(network, &floor));
            double before = support_energy(network), px, py;
            check_ok(support_get_momentum(network, &px, &py, NULL));
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
                check_ok(mspring_network_get_columns(network, NULL, 0, made.particle_count, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2));
                gives_y = -mass * g * fallen;
                for (uint32_t p = 0; p < made.particle_count; p++) {
                    gives_x += (double)x[p];
                    gives_y += (double)y[p];
                }
                check_ok(support_get_momentum(network, &qx, &qy, NULL));
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

/// depths: [30] instead of one depth, or NULL.
static uint64_t fall_into(const mspring_network_def *network_def, double depth, const float *depths, double rate,
                          double y) {
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
    def.silt_depths = depths;
    def.friction = 0.4f;
    def.restitution = 0.3f;
    check_ok(mspring_network_set_floor(network, &def));
    support_steps(network, 60, 1.0 / 64);
    check_ok(mspring_network_get_state_hash(network, &hash));
    mspring_network_destroy(network);
    recipe_free(&made);
    return hash;
}

static uint64_t fall(const mspring_network_def *def, double depth, double rate, double y) {
    return fall_into(def, depth, NULL, rate, y);
}

static void bits_are_the_same_for_any_workers_and_levels(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_network_def def = support_def((float)-g, solver == MSPRING_SOLVER_EXPLICIT ? 20 : 2);
        def.settings.solver = solver;
        def.settings.global_damping = 0.2f;
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

static void bits_of_equal_depths_are_those_of_one_depth(void **state) {
    (void)state;
    float equal[30], all[30], none[30] = {0};
    uint64_t seed = 4;
    for (size_t i = 0; i < COUNT_OF(equal); i++) {
        equal[i] = 3;
        all[i] = support_random(&seed) % 4 ? (float)support_random_between(&seed, 0, 5) : 0;
    }
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        for (int clamps = 0; clamps < (solver == MSPRING_SOLVER_EXPLICIT ? 2 : 1); clamps++) {
            mspring_network_def def = support_def((float)-g, solver == MSPRING_SOLVER_EXPLICIT ? 20 : 2);
            def.settings.solver = solver;
            def.settings.guard = clamps ? MSPRING_GUARD_CLAMP : MSPRING_GUARD_GROWTH;
            const uint64_t one = fall(&def, 3, 10, 2), uneven_silt = fall_into(&def, 0, all, 10, 2);
            assert_true(fall_into(&def, 0, equal, 10, 2) == one && uneven_silt != one);
            assert_true(fall_into(&def, 0, none, 10, 2) == fall(&def, 0, 0, 2));
            for (int at = MSPRING_SIMD_SCALAR; at <= MSPRING_SIMD_AVX512; at++) {
                def.simd_level = (mspring_simd)at;
                def.worker_count = (uint32_t)(at % 3 + 1);
                assert_true(fall_into(&def, 0, all, 10, 2) == uneven_silt);
            }
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

static void depths_are_checked_copied_and_read(void **state) {
    (void)state;
    const struct {
        float depths[2], depth;
        const char *part; ///< of what is said; NULL if it is taken
    } ways[] = {
        {{0, 1e12f}, 0, NULL},
        {{1e-45f, 0}, 0, NULL},
        {{1, -1e-9f}, 0, "silt_depths[1]"},
        {{NAN, 1}, 0, "silt_depths[0]"},
        {{1, INFINITY}, 0, "silt_depths[1]"},
        {{1, 2}, 1, "silt_depth must be 0, and it is 1 m"},
        {{1, 2}, NAN, "silt_depth must be 0"},
    };
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = sinkers(5, g, 1, 1, MSPRING_SOLVER_EXPLICIT);
        mspring_floor_def def = silt_of((double)ways[i].depth, 3), had = {.struct_size = sizeof had};
        float depths[2] = {ways[i].depths[0], ways[i].depths[1]};
        def.silt_depths = depths;
        check_error(mspring_network_set_floor(network, &def), ways[i].part ? MSPRING_ERROR_ARGUMENT : MSPRING_OK);
        if (ways[i].part)
            check_contains(mspring_network_error(network), ways[i].part);
        depths[0] = depths[1] = 77;
        check_ok(mspring_network_get_floor(network, &had));
        assert_true(had.silt_depth == (ways[i].part ? 1.0f : 0.0f));
        assert_true((had.silt_depths == NULL) == (ways[i].part != NULL));
        if (had.silt_depths) {
            assert_memory_equal(had.silt_depths, ways[i].depths, sizeof depths);
            check_ok(mspring_network_set_floor(network, &had)); // as it is
            const float *const kept = had.silt_depths;
            check_ok(mspring_network_get_floor(network, &had));
            assert_ptr_equal(had.silt_depths, kept);
        }
        support_steps(network, 20, 0.05);
        for (mspring_id p = 0; p < 3; p++)
            assert_true(isfinite(support_position(network, p).y) && support_position(network, p).y >= -1e-6);
        mspring_network_destroy(network);
    }
}

/// One height has one depth; a floor without heights has none.
static void depths_are_as_many_as_heights(void **state) {
    (void)state;
    const float depth = 2;
    const double plane[4] = {0, 0, 0, 1};
    mspring_network *network = sinkers(1, 0, 0, 0, MSPRING_SOLVER_EXPLICIT);
    mspring_floor_def def = silt_of(0, 10), had = {.struct_size = sizeof had};
    def.heights = NULL;
    def.height_count = 1;
    def.silt_depths = &depth;
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(mspring_network_get_floor(network, &had));
    assert_true(had.height_count == 1 && had.silt_depths[0] == 2);
    set_speeds(network, 1, 0);
    support_steps(network, 1, 1e-3);
    check_near(support_velocity(network, 2).x, 1 / (1 + 1e-4 * 10 * 0.5) - 9 * 1e-4 * 10 * 0.5, 1e-4);
    def.planes = plane;
    def.plane_count = 1;
    def.height_count = 0;
    check_ok(mspring_network_set_floor(network, &def));
    check_ok(mspring_network_get_floor(network, &had));
    assert_null(had.silt_depths);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_sinks_has_its_terminal_speed),
        cmocka_unit_test(what_slides_stops_after_v_over_rate),
        cmocka_unit_test(what_dives_stops_at_its_depth),
        cmocka_unit_test(what_dives_stops_by_the_depth_below_it),
        cmocka_unit_test(what_crosses_a_slope_loses_speed_by_the_local_rate),
        cmocka_unit_test(there_is_none_where_its_depth_is_0),
        cmocka_unit_test(it_lies_on_the_heights),
        cmocka_unit_test(it_takes_energy_and_gives_none),
        cmocka_unit_test(nothing_tunnels),
        cmocka_unit_test(bits_are_the_same_for_any_workers_and_levels),
        cmocka_unit_test(bits_of_equal_depths_are_those_of_one_depth),
        cmocka_unit_test(numbers_have_their_ranges),
        cmocka_unit_test(depths_are_checked_copied_and_read),
        cmocka_unit_test(depths_are_as_many_as_heights),
        cmocka_unit_test(it_lies_on_heights_alone),
    };
    return cmocka_run_group_tests_name("silt", tests, NULL, NULL);
}
