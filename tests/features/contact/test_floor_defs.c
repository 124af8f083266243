/// @file test_floor_defs.c
/// What a floor may be made of, and what is known of it: all within the ranges is taken and acts, nothing beyond
/// them is, and it takes the memory of one floor.
///
/// SPDX-License-Identifier: MIT
#include <fenv.h>
#include <math.h>

#include "allocator.h"
#include "grounds.h"
#include "recipe.h"
#include "support.h"

/// The numbers of a floor of one plane and two heights.
typedef struct numbers {
    double x, y, across_x, across_y;
    double heights_x, heights_y, spacing, height[2];
    double friction, restitution;
} numbers;

static mspring_result lay(mspring_network *network, const numbers *n) {
    const double plane[] = {n->x, n->y, n->across_x, n->across_y};
    const float heights[] = {(float)n->height[0], (float)n->height[1]};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = plane;
    def.plane_count = 1;
    def.heights_x = n->heights_x;
    def.heights_y = n->heights_y;
    def.spacing = n->spacing;
    def.heights = heights;
    def.height_count = 2;
    def.friction = (float)n->friction;
    def.restitution = (float)n->restitution;
    return mspring_network_set_floor(network, &def);
}

static mspring_network *two_particles(void) {
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 5, 1);
    support_particle(builder, 1, 5, 2);
    const mspring_network_def def = support_def(-9.8f, 1);
    return support_network(builder, &def);
}

static void numbers_have_their_ranges(void **state) {
    (void)state;
    const numbers usual = {0, 0, 0, 1, -1, 0, 2, {0, 0}, 0.5, 0.5};
#define AT(field) offsetof(numbers, field)
    const struct {
        size_t at;
        double value;
        const char *part; ///< of what is said; NULL if it is taken
    } ways[] = {
        {AT(x), 1e12, NULL},
        {AT(x), -1e12, NULL},
        {AT(x), 1.1e12, "plane 0 goes through"},
        {AT(x), NAN, "plane 0 goes through"},
        {AT(y), -1e12, NULL},
        {AT(y), -1.1e12, "plane 0 goes through"},
        {AT(across_x), 0.9e100, NULL}, // less than its square overflows
        {AT(across_x), 1.1e100, "no direction"},
        {AT(across_x), NAN, "no direction"},
        {AT(across_y), 2e-100, NULL},
        {AT(across_y), 0.7e-100, "no direction"},
        {AT(heights_x), -1e12, NULL},
        {AT(heights_x), 1e12 - 2, NULL}, // the last one is 2 m further
        {AT(heights_x), 1e12 - 1, "out of bounds"},
        {AT(heights_x), -1.1e12, "out of bounds"},
        {AT(heights_x), NAN, "out of bounds"},
        {AT(heights_y), -1e12, NULL},
        {AT(heights_y), 1.1e12, "out of bounds"},
        {AT(spacing), 1e-9, NULL},
        {AT(spacing), 1e9, NULL},
        {AT(spacing), 0.9e-9, "apart"},
        {AT(spacing), 1.1e9, "apart"},
        {AT(spacing), NAN, "apart"},
        {AT(height[0]), -9e11, NULL},
        {AT(height[0]), -1.1e12, "height 0"},
        {AT(height[1]), 1.1e12, "height 1"},
        {AT(friction), 0, NULL},
        {AT(friction), 1e6, NULL},
        {AT(friction), 1.1e6, "friction"},
        {AT(restitution), 0, NULL},
        {AT(restitution), 1, NULL},
        {AT(restitution), 1.1, "restitution"},
        {AT(restitution), -0.1, "restitution"},
    };
#undef AT
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = two_particles();
        numbers now = usual;
        *(double *)((char *)&now + ways[i].at) = ways[i].value;
        check_error(lay(network, &now), ways[i].part ? MSPRING_ERROR_ARGUMENT : MSPRING_OK);
        if (ways[i].part) {
            check_contains(mspring_network_error(network), ways[i].part);
        }
        // There are floors that lift them by more than a network bears, but no other steps than those that are
        // whole.
        const mspring_result result = mspring_network_step(network, 1e-3);
        assert_true(result == MSPRING_OK || result == MSPRING_ERROR_UNSTABLE);
        assert_true(isfinite(support_position(network, 0).x) && isfinite(support_position(network, 1).y));
        mspring_network_destroy(network);
    }
}

static void so_many_heights_are_refused(void **state) {
    (void)state;
    mspring_network *network = two_particles();
    const float height = 0;
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.heights = &height; // of which nothing is read
    const uint32_t counts[] = {MSPRING_MAX_HEIGHTS + 1, UINT32_MAX};
    for (size_t i = 0; i < COUNT_OF(counts); i++) {
        def.height_count = counts[i];
        check_error(mspring_network_set_floor(network, &def), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "heights, it may have 0 to 67108864");
        check_contains(mspring_network_error(network), i ? "4294967295" : "67108865");
    }
    mspring_network_destroy(network);
}

/// One height is level ground, and no list is heights of 0: the same bits as of two that are given.
static void one_height_is_level_ground(void **state) {
    (void)state;
    const float zeros[] = {0, 0}, height = 0.5f;
    uint64_t hashes[3] = {0};
    for (uint32_t i = 0; i < 3; i++) {
        mspring_network *network = two_particles();
        mspring_floor_def def = mspring_floor_def_default(), found = mspring_floor_def_default();
        def.heights = i == 0 ? zeros : i == 1 ? &height : NULL;
        def.heights_y = i == 1 ? 4 : 4.5;
        def.height_count = i == 0 ? 2 : 1;
        def.restitution = 0.5f;
        check_ok(mspring_network_set_floor(network, &def));
        check_ok(mspring_network_get_floor(network, &found));
        assert_int_equal(found.height_count, def.height_count);
        assert_true(found.heights[0] == (i == 1 ? height : 0));
        check_ok(mspring_network_set_floor(network, &found));
        check_ok(mspring_network_set_floor(network, &def));
        support_steps(network, 100, 0.01);
        check_near(support_position(network, 0).y, 4.5, 0.02);
        hashes[i] = support_hash(network);
        mspring_network_destroy(network);
    }
    assert_true(hashes[1] == hashes[0] && hashes[2] == hashes[0]);
}

/// A box of as many sides as there may be, each given by another point and a vector of another length.
static void all_planes_hold(void **state) {
    (void)state;
    const double centre[] = {10, 20}, turn = 2 * 3.14159265358979 / MSPRING_MAX_PLANES;
    double planes[MSPRING_MAX_PLANES][4];
    for (uint32_t i = 0; i < MSPRING_MAX_PLANES; i++) {
        const double nx = cos(turn * i), ny = sin(turn * i), along = 0.3 * i;
        planes[i][0] = centre[0] - nx - along * ny;
        planes[i][1] = centre[1] - ny + along * nx;
        planes[i][2] = nx * (i + 1);
        planes[i][3] = ny * (i + 1);
    }
    mspring_floor_def box;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &box, sizeof box));
    box.planes = planes[0];
    box.plane_count = MSPRING_MAX_PLANES;
    box.restitution = 1;
    for (uint32_t way = 0; way < 2 * MSPRING_MAX_PLANES; way++) {
        mspring_builder *builder = support_builder();
        support_particle(builder, centre[0], centre[1], 1);
        const mspring_network_def def = support_def(0, 1);
        mspring_network *network = support_network(builder, &def);
        check_ok(mspring_network_set_floor(network, &box));
        const float vx = (float)(3 * cos(turn / 2 * way)), vy = (float)(3 * sin(turn / 2 * way));
        check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &vx, &vy, 1));
        double farthest = 0;
        for (int step = 0; step < 100; step++) {
            support_steps(network, 1, 0.02);
            const support_point at = support_position(network, 0);
            for (uint32_t i = 0; i < MSPRING_MAX_PLANES; i++) {
                const double inside = (at.x - planes[i][0]) * planes[i][2] + (at.y - planes[i][1]) * planes[i][3];
                assert_true(inside >= -1e-5 * (i + 1)); // of a float of some metres
            }
            farthest = fmax(farthest, hypot(at.x - centre[0], at.y - centre[1]));
            // It is thrown back by each as fast as it came, but for the rounding of some ten bounces.
            const support_point goes = support_velocity(network, 0);
            check_near(hypot(goes.x, goes.y), 3, 1e-5);
        }
        assert_true(farthest > 0.9); // sides are 1 m from the middle, and it goes 0.06 m in a step
        mspring_network_destroy(network);
    }
}

static void heights_are_above_heights_y(void **state) {
    (void)state;
    mspring_network *network = two_particles();
    const float heights[] = {0.5f, 0.5f, -0.25f, -0.25f};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.heights = heights;
    def.height_count = 4;
    def.heights_x = -0.9; // they are at -0.9, -0.3, 0.3 and 0.9
    def.heights_y = 3;
    def.spacing = 0.6;
    check_ok(mspring_network_set_floor(network, &def));
    // The first slides down the slope in the middle at last, unless it is held; the other one lies on level ground.
    const float held = 0;
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, 1, &held, 1));
    support_steps(network, 200, 0.01);
    check_near(support_position(network, 1).y, 2.75, 1e-5); // of floats of some metres
    assert_true(support_position(network, 1).x == 1);
    mspring_network_destroy(network);
}

static void impulses_are_asked_for_one_by_one(void **state) {
    (void)state;
    const numbers level = {0, 5, 0, 1, -1, -7, 2, {0, 0}, 0, 0};
    mspring_network *network = two_particles();
    float x[2] = {7, 7}, y[2] = {7, 7};
    check_ok(mspring_network_get_columns(
        network, NULL, 0, 2,
        (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2));
    assert_true(x[0] == 0 && x[1] == 0 && y[0] == 0 && y[1] == 0); // there is none
    check_ok(lay(network, &level));
    support_steps(network, 10, 0.01);
    check_ok(mspring_network_get_columns(
        network, NULL, 0, 2,
        (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2));
    // They lie on it: the floor gives what gravity does.
    check_near(y[0], 9.8 * 0.01, 1e-6);
    check_near(y[1], 2 * 9.8 * 0.01, 1e-6);
    float one_x = 7, one_y = 7;
    check_ok(mspring_network_get_columns(
        network, NULL, 1, 1,
        (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &one_x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &one_y}}, 2));
    assert_true(one_x == 0 && one_y == y[1]);
    check_ok(mspring_network_get_columns(
        network, NULL, 2, 0,
        (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, NULL}, {MSPRING_FLOOR_IMPULSE_Y, 1, NULL}}, 2));
    check_error(mspring_network_get_columns(network, NULL, 3, 0,
                                            (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, NULL},
                                                                     {MSPRING_FLOOR_IMPULSE_Y, 1, NULL}},
                                            2),
                MSPRING_ERROR_ID);
    check_error(mspring_network_get_columns(
                    network, NULL, 1, 2,
                    (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2),
                MSPRING_ERROR_ID);
    check_error(mspring_network_get_columns(
                    network, NULL, 1, 1,
                    (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, NULL}},
                    2),
                MSPRING_ERROR_ARGUMENT);
    // Without the floor there is nothing any more that it gave.
    check_ok(mspring_network_set_floor(network, NULL));
    check_ok(mspring_network_get_columns(
        network, NULL, 0, 2,
        (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2));
    assert_true(x[0] == 0 && x[1] == 0 && y[0] == 0 && y[1] == 0);
    mspring_network_destroy(network);
}

/// What the floor gives is what momentum changes by beyond gravity, along the surface as across it: of a particle
/// that falls into a valley, bounces and slides there.
static void impulses_are_the_change_of_momentum(void **state) {
    (void)state;
    const float heights[] = {4, 0, 3};
    const double dt = 0.01, g = 9.8, mass = 2;
    mspring_builder *builder = support_builder();
    support_particle(builder, -1, 4, (float)mass);
    const mspring_network_def network_def = support_def((float)-g, 5);
    mspring_network *network = support_network(builder, &network_def);
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.heights = heights;
    def.height_count = 3;
    def.heights_x = -4;
    def.spacing = 4;
    def.friction = 0.3f;
    def.restitution = 0.5f;
    check_ok(mspring_network_set_floor(network, &def));
    double given_x = 0, given_y = 0, along_x = 0;
    for (int step = 0; step < 300; step++) {
        const support_point before = support_velocity(network, 0);
        support_steps(network, 1, dt);
        const support_point after = support_velocity(network, 0);
        float x, y;
        check_ok(mspring_network_get_columns(
            network, NULL, 0, 1,
            (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}}, 2));
        // Velocities of up to 10 m/s, rounded in each of five substeps and once more in the impulse.
        check_near(x, mass * (after.x - before.x), 2e-5);
        const double fallen = step == 0 ? dt - dt / 10 : dt; // the first of five substeps begins in its middle
        check_near(y, mass * (after.y - before.y + g * fallen), 2e-5);
        given_x += fabs((double)x);
        given_y += (double)y;
        along_x = fmax(along_x, fabs(after.x));
    }
    // It came down from 3 m above the slope, at 7 m/s, was turned aside, and lies in the valley at last.
    assert_true(given_x > 5 && given_y > 14 && along_x > 1);
    check_near(support_position(network, 0).x, 0, 0.05);
    mspring_network_destroy(network);
}

/// What begins on the floor and is on its way up is neither held nor slowed, however rough the floor is.
static void who_leaves_is_let_go(void **state) {
    (void)state;
    const numbers rough = {0, 5, 0, 1, -1, -7, 2, {0, 0}, 10, 0};
    mspring_network *network = two_particles();
    check_ok(lay(network, &rough));
    const float vx = 0.3f, vy = 0.5f;
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &vx, &vy, 1));
    support_steps(network, 4, 1e-7); // in which it goes less than rounding would
    assert_true(support_velocity(network, 0).x == (double)vx);
    check_near(support_velocity(network, 0).y, 0.5, 5e-6);
    support_steps(network, 20, 1e-3);
    const double t = 0.02;
    assert_true(support_velocity(network, 0).x == (double)vx);
    check_near(support_velocity(network, 0).y, 0.5 - 9.8 * (t - 0.5e-3), 1e-5);      // of half a substep ago
    check_near(support_position(network, 0).y, 5 + 0.5 * t - 9.8 * t * t / 2, 1e-5); // floats of some metres
    float x, y;
    check_ok(mspring_network_get_columns(
        network, NULL, 0, 1,
        (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}}, 2));
    assert_true(x == 0 && y == 0);
    mspring_network_destroy(network);
}

/// A network has the memory of one floor, of none where it has none, and of the one before where another failed;
/// and the thread has its rounding mode.
static void floors_come_and_go_with_their_memory(void **state) {
    (void)state;
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {100, 100}};
    const numbers level = {0, -9, 0, 1, -1, -9, 2, {0, 0}, 0, 0};
    numbers other = level;
    recipe made = {0};
    recipe_lattice(&made, 20, 5, 0, 0, 1, &stuff, &seed);
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def(-9.8f, 4);
    def.allocator = &allocator;
    mspring_network *network = recipe_network(&made, &def);
    const size_t without = support_memory_used(network);
    check_ok(lay(network, &level));
    const size_t with = support_memory_used(network);
    assert_true(with > without);
    for (int round = 0; round < 3; round++) {
        other.y--; // the same floor would be left as it is
        check_ok(lay(network, &other));
        assert_true(support_memory_used(network) == with);
    }
    mspring_result result = MSPRING_ERROR_MEMORY;
    size_t fail_at = 0;
    while (result != MSPRING_OK) {
        watched.fail_at = watched.calls + ++fail_at;
        result = lay(network, &level);
        assert_true(result == MSPRING_OK || result == MSPRING_ERROR_MEMORY);
        assert_true(support_memory_used(network) == with);
    }
    assert_true(fail_at > 4);
    watched.fail_at = 0;
    check_ok(mspring_network_set_floor(network, NULL));
    assert_true(support_memory_used(network) == without);
    const int mode = fegetround();
    assert_int_equal(fesetround(FE_UPWARD), 0);
    const volatile float one = 1, little = 1e-10f;
    const volatile float before = one + little;
    result = lay(network, &level);
    const volatile float after = one + little;
    assert_int_equal(fesetround(mode), 0);
    check_ok(result);
    assert_true(before == after);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    recipe_free(&made);
}

/// A floor that is set again is let be if it is the same. Whatever of it is another one counts, the last of each array.
static void every_value_of_a_floor_counts(void **state) {
    (void)state;
    double planes[2][4] = {{0, -5, 0, 1}, {-9, 0, 1, 0}};
    float heights[3] = {0, 1, 0.5f}, depths[3] = {0.5f, 0.25f, 0.125f}, frictions[2] = {0.1f, 0.2f},
          restitutions[2] = {0.3f, 0.4f}, part_frictions[2] = {0.5f, 0.6f}, part_restitutions[2] = {0.7f, 0.8f};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = planes[0], def.plane_count = 2;
    def.heights = heights, def.height_count = 3;
    def.plane_frictions = frictions, def.plane_restitutions = restitutions;
    def.height_frictions = part_frictions, def.height_restitutions = part_restitutions;
    def.silt_depths = depths, def.silt_rate = 1;
    float *const floats[] = {&heights[2], &depths[2], &frictions[1], &restitutions[1], &part_frictions[1],
                             &part_restitutions[1], &def.friction, &def.restitution, &def.silt_rate};
    double *const doubles[] = {&planes[1][3], &planes[1][0], &def.heights_x, &def.heights_y, &def.spacing};
    mspring_network *network = two_particles();
    check_ok(mspring_network_set_floor(network, &def));
    for (size_t i = 0; i < COUNT_OF(floats) + COUNT_OF(doubles); i++) {
        if (i < COUNT_OF(floats))
            *floats[i] += 0.0625f;
        else
            *doubles[i - COUNT_OF(floats)] += 0.0625;
        check_ok(mspring_network_set_floor(network, &def));
        mspring_floor_def now = {.struct_size = sizeof now};
        check_ok(mspring_network_get_floor(network, &now));
        assert_true(now.friction == def.friction && now.restitution == def.restitution);
        assert_true(now.silt_rate == def.silt_rate);
        assert_true(now.heights_x == def.heights_x && now.heights_y == def.heights_y && now.spacing == def.spacing);
        assert_memory_equal(now.planes, planes, sizeof planes);
        assert_memory_equal(now.heights, heights, sizeof heights);
        assert_memory_equal(now.silt_depths, depths, sizeof depths);
        assert_memory_equal(now.plane_frictions, frictions, sizeof frictions);
        assert_memory_equal(now.plane_restitutions, restitutions, sizeof restitutions);
        assert_memory_equal(now.height_frictions, part_frictions, sizeof part_frictions);
        assert_memory_equal(now.height_restitutions, part_restitutions, sizeof part_restitutions);
    }
    mspring_network_destroy(network);
}

static void refuse(mspring_network *network, mspring_floor_def def, mspring_result code, const char *part) {
    check_error(mspring_network_set_floor(network, &def), code);
    check_contains(mspring_network_error(network), part);
}

static void errors_name_the_culprit(void **state) {
    (void)state;
    mspring_network *network = two_particles();
    mspring_floor_def def = grounds_level(0, 0);
    check_ok(mspring_network_set_floor(network, &def));
    refuse(network, grounds_def(), MSPRING_ERROR_ARGUMENT, "neither");
    def.friction = -1;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "friction");
    def.friction = NAN;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "friction");
    def = grounds_level(0, 1.5f);
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "restitution");
    def = grounds_level(0, 0);
    def.struct_size = 3;
    refuse(network, def, MSPRING_ERROR_STRUCT, "mspring_floor_def");
    def = grounds_level(0, 0);
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
    def = grounds_def();
    def.heights = heights;
    def.height_count = 3;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "height 2");
    heights[2] = 0;
    def.spacing = 0;
    refuse(network, def, MSPRING_ERROR_ARGUMENT, "apart");
    def.spacing = 1;
    check_error(mspring_network_set_floor(NULL, &def), MSPRING_ERROR_ARGUMENT);
    float x, y;
    check_error(mspring_network_get_columns(
                    network, NULL, 0, 3,
                    (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}},
                    2),
                MSPRING_ERROR_ID);
    check_error(mspring_network_get_columns(
                    network, NULL, 0, 1,
                    (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, NULL}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}},
                    2),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_columns(
                    NULL, NULL, 0, 0,
                    (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}},
                    2),
                MSPRING_ERROR_ARGUMENT);
    // The floor of before is still there.
    support_steps(network, 128, 1.0 / 64);
    assert_true(support_position(network, 0).y > -GROUNDS_TOLERANCE);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_have_their_ranges),
        cmocka_unit_test(so_many_heights_are_refused),
        cmocka_unit_test(one_height_is_level_ground),
        cmocka_unit_test(all_planes_hold),
        cmocka_unit_test(heights_are_above_heights_y),
        cmocka_unit_test(impulses_are_asked_for_one_by_one),
        cmocka_unit_test(impulses_are_the_change_of_momentum),
        cmocka_unit_test(who_leaves_is_let_go),
        cmocka_unit_test(floors_come_and_go_with_their_memory),
        cmocka_unit_test(errors_name_the_culprit),
        cmocka_unit_test(every_value_of_a_floor_counts),
    };
    return cmocka_run_group_tests_name("floor_defs", tests, NULL, NULL);
}
