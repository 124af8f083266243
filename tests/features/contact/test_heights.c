/// @file test_heights.c
/// Where a way meets a field of heights: what a walk from knot to knot finds, on short ways and on ones across
/// thousands of knots.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "features/contact/floor.h"
#include "support.h"

enum { MOST_KNOTS = 3000, WAYS = 4000 };

static float heights[MOST_KNOTS];
static uint64_t seed = 1;

static double between(double low, double high) {
    return support_random_between(&seed, low, high);
}

/// Rough ground, gentle slopes, terraces, or a plain with a few peaks.
static float height_of(uint32_t kind, uint32_t i) {
    switch (kind) {
    case 0:
        return (float)between(-1, 1);
    case 1:
        return 0.01f * (float)i;
    case 2:
        return (float)(i / 16 % 4);
    default:
        return i % 401 == 7 ? 3.0f : 0.0f;
    }
}

static mspring_network *make_ground(uint32_t kind, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        heights[i] = height_of(kind, i);
    }
    mspring_builder *builder = support_builder();
    (void)support_particle(builder, 0, 10, 1);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.heights = heights;
    floor.height_count = count;
    floor.heights_x = -3.7;
    floor.spacing = 0.3;
    check_ok(mspring_network_set_floor(network, &floor));
    mspringi_floor_set_origin(network->floor, network->origin_x, network->origin_y);
    return network;
}

static bool passes_below(const mspringi_heights *h, int64_t knot, const double from[2], const double to[2]) {
    const double share = (h->local_x + (double)knot * h->spacing - from[0]) / (to[0] - from[0]);
    const double height = h->local_y + (double)h->heights[knot];
    return from[1] + share * (to[1] - from[1]) < height - mspringi_floor_slop(to[0], to[1]);
}

/// One knot after the other.
static int64_t walk(const mspringi_heights *h, const double from[2], const double to[2]) {
    const int64_t last = mspringi_heights_find_part(h, to[0]);
    int64_t part = mspringi_heights_find_part(h, from[0]);
    const int64_t onward = part < last ? 1 : -1;
    while (part != last && !passes_below(h, onward > 0 ? part + 1 : part, from, to)) {
        part += onward;
    }
    return part;
}

/// Short hops, long flights, ways that begin or end beyond the field, steep and level ones, and upright ones.
static void take_way(const mspringi_heights *h, double from[2], double to[2]) {
    const double width = h->spacing * h->count;
    const double reach = support_random(&seed) % 2 ? 4 * h->spacing : 1.5 * width;
    const double rise = pow(10, between(-3, 1.5));
    from[0] = h->local_x + between(-0.2, 1.2) * width;
    to[0] = support_random(&seed) % 32 ? from[0] + between(-reach, reach) : from[0];
    from[1] = h->local_y + between(-1, 5);
    to[1] = from[1] + between(-rise, rise);
}

static void a_way_meets_what_a_walk_from_knot_to_knot_meets(void **state) {
    (void)state;
    const uint32_t counts[] = {2, 3, 17, 64, 1000, MOST_KNOTS};
    uint32_t met = 0;
    for (uint32_t kind = 0; kind < 4; kind++) {
        for (size_t c = 0; c < COUNT_OF(counts); c++) {
            mspring_network *network = make_ground(kind, counts[c]);
            const mspringi_heights *h = &network->floor->heights;
            for (uint32_t i = 0; i < WAYS; i++) {
                double from[2], to[2];
                take_way(h, from, to);
                const int64_t part = mspringi_heights_first_hit(h, from[0], from[1], to[0], to[1]);
                assert_int_equal(part, walk(h, from, to));
                met += part != mspringi_heights_find_part(h, to[0]);
            }
            mspring_network_destroy(network);
        }
    }
    assert_in_range(met, 10000, 80000); // of 96,000 ways: both answers are common
}

/// The knots of the parts below a way, and none beside the field: all are below 0.
static void the_highest_knot_below_a_way_is_found(void **state) {
    (void)state;
    const uint32_t counts[] = {2, 3, 17, 64, 1000};
    for (size_t c = 0; c < COUNT_OF(counts); c++) {
        const uint32_t count = counts[c];
        mspring_network *network = make_ground(0, count);
        for (uint32_t i = 0; i < count; i++)
            heights[i] -= 10;
        mspring_floor_def floor = {.struct_size = sizeof floor};
        check_ok(mspring_network_get_floor(network, &floor));
        floor.heights = heights;
        check_ok(mspring_network_set_floor(network, &floor));
        mspringi_floor_set_origin(network->floor, network->origin_x, network->origin_y);
        const mspringi_heights *h = &network->floor->heights;
        for (uint32_t i = 0; i < 4000; i++) {
            const double a = between(-2, count + 1), b = i % 2 ? a - between(0, 3) : between(-2, count + 1);
            const double low = h->local_x + h->spacing * fmin(a, b), high = h->local_x + h->spacing * fmax(a, b);
            const int64_t first = mspringi_heights_find_part(h, low), last = mspringi_heights_find_part(h, high) + 1;
            float highest = -INFINITY;
            for (int64_t knot = first < 0 ? 0 : first; knot < (int64_t)count && knot <= last; knot++)
                highest = fmaxf(highest, heights[knot]);
            check_near(mspringi_heights_highest(h, low, high), h->local_y + (double)highest, 0);
        }
        mspring_network_destroy(network);
    }
}

/// A block of particles of this mass over flat ground with a needle in it, at x = 30.
static mspring_network *block_before_a_needle(float mass) {
    enum { KNOTS = 200 };
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < 20 * 4; i++)
        (void)support_particle(builder, i % 20, 5 + i / 20, mass);
    for (uint32_t i = 0; i < 20 * 4; i++) {
        if (i % 20 < 19)
            (void)support_spring(builder, i, i + 1, 1000 * mass, 10 * mass);
        if (i + 20 < 20 * 4)
            (void)support_spring(builder, i, i + 20, 1000 * mass, 10 * mass);
        if (i % 20 < 19 && i + 20 < 20 * 4) {
            (void)support_spring(builder, i, i + 21, 1000 * mass, 10 * mass);
            (void)support_spring(builder, i + 1, i + 20, 1000 * mass, 10 * mass);
        }
    }
    const mspring_network_def def = support_def(0, 4);
    mspring_network *network = support_network(builder, &def);
    for (uint32_t i = 0; i < KNOTS; i++)
        heights[i] = i == 120 ? 1000.0f : 0;
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.heights = heights;
    floor.height_count = KNOTS;
    floor.heights_x = -6;
    floor.spacing = 0.3;
    check_ok(mspring_network_set_floor(network, &floor));
    return network;
}

/// However fast the block is, nothing of it gets past the needle.
static void nothing_flies_through_a_needle(void **state) {
    (void)state;
    for (float speed = 20; speed < 500; speed *= 1.5f) {
        mspring_network *network = block_before_a_needle(1);
        const float still = 0;
        check_ok(mspring_network_set_velocities(network, NULL, 0, 80, &speed, &still, 0));
        for (int step = 0; step < 40; step++) {
            support_steps(network, 1, 1.0 / 64);
            for (mspring_id p = 0; p < 80; p++)
                assert_true(support_position(network, p).x < 30.31);
        }
        mspring_network_destroy(network);
    }
}

/// Nor does a force press light particles through the ground, within one step.
static void no_force_presses_through_the_ground(void **state) {
    (void)state;
    for (float mass = 1e-4f; mass < 1e4f; mass *= 10) {
        mspring_network *network = block_before_a_needle(mass);
        const float still = 0, down = -4e5f * mass; // 100 m in a step
        for (int step = 0; step < 3; step++) {
            for (mspring_id p = 0; p < 80; p += 3)
                check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, &p, 0, 1, &still, &down, 1));
            support_steps(network, 1, 1.0 / 64);
            for (mspring_id p = 0; p < 80; p++)
                assert_true(support_position(network, p).y > -1e-3);
        }
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_flies_through_a_needle),
        cmocka_unit_test(no_force_presses_through_the_ground),
        cmocka_unit_test(a_way_meets_what_a_walk_from_knot_to_knot_meets),
        cmocka_unit_test(the_highest_knot_below_a_way_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
