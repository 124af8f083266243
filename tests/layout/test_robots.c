/// @file test_robots.c
/// Equal robots in herds that are driven by signals and touch themselves and the floor: the bits are those of a
/// network in which they stand in none, and robots do what one alone does.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "store/network.h"
#include "support.h"

#define DT (1.0 / 64)

/// A herd, and four that stand in none. A robot is a ring with chords and two arms that a muscle draws together.
enum { ROBOTS = 20, RING = 8, ARM = 5, SIZE = RING + 2 * ARM, ACTUATORS = 2 * ARM + 1, STEPS = 60 };

typedef struct robot {
    mspring_id springs[ACTUATORS]; ///< those that signals drive
} robot;

static robot add_robot(mspring_builder *b, double x) {
    const mspring_id first = mspring_builder_count(b, MSPRING_PARTICLES);
    robot made;
    for (uint32_t i = 0; i < RING; i++) {
        const double angle = 6.2831853 * i / RING;
        (void)support_particle(b, x + cos(angle), 1.5 + sin(angle), 1);
    }
    for (uint32_t i = 0; i < 2 * ARM; i++) {
        const double side = i < ARM ? -1 : 1;
        (void)support_particle(b, x + side * (0.25 + 0.01 * (i % ARM)), 2.6 + 0.5 * (i % ARM), 0.2f);
    }
    for (uint32_t i = 0; i < RING; i++) {
        (void)support_spring(b, first + i, first + (i + 1) % RING, 2000, 4);
        (void)support_spring(b, first + i, first + (i + 3) % RING, 1500, 4);
    }
    for (uint32_t arm = 0; arm < 2; arm++) {
        const mspring_id root = first + RING + arm * ARM;
        const mspring_id beneath = first + (arm == 0 ? 3 : 1), inner = first + 2; // of the ring
        for (uint32_t i = 0; i < ARM; i++) {
            (void)support_spring(b, i == 0 ? beneath : root + i - 1, root + i, 1500, 2);
            made.springs[arm * ARM + i] = support_spring(b,
                                                         i == 0   ? inner
                                                         : i == 1 ? beneath
                                                                  : root + i - 2,
                                                         root + i, 1000, 2);
        }
    }
    made.springs[2 * ARM] = support_spring(b, first + RING + 2, first + RING + ARM + 2, 3000, 2);
    return made;
}

typedef struct way {
    mspring_simd level;
    uint32_t workers, robots;
    bool in_irregular; ///< the herd is swept as any web
    bool has_contact;
    uint32_t changes; ///< of an actuator in a step
} way;

static mspring_network *network_of(way with) {
    mspring_builder *builder = support_builder();
    mspring_id springs[ROBOTS * ACTUATORS];
    uint32_t firsts[ROBOTS + 1] = {0};
    for (uint32_t i = 0; i < with.robots; i++) {
        const robot made = add_robot(builder, 8.0 * i);
        firsts[i + 1] = mspring_builder_count(builder, MSPRING_PARTICLES);
        for (uint32_t k = 0; k < ACTUATORS; k++) {
            springs[i * ACTUATORS + k] = made.springs[k];
        }
    }
    mspring_network_def def = support_def(-9.8f, 32);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    def.settings.max_speed = 1000;
    def.simd_level = with.level;
    def.worker_count = with.workers;
    mspring_network *network = support_network(builder, &def);
    assert_int_equal(network->topology.bundle_strip != MSPRING_NONE, with.robots == ROBOTS);
    if (with.in_irregular) {
        network->topology.bundle_strip = MSPRING_NONE;
    }
    mspring_floor_def floor;
    const double plane[4] = {0, 0, 0, 1};
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    floor.friction = 0.5f;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(mspring_network_set_groups(network, firsts, with.robots));
    check_ok(mspring_network_set_actuators(network, springs, with.robots * ACTUATORS, with.changes));
    if (with.has_contact) {
        mspring_contact_def contact;
        check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
        contact.thickness = 0.1;
        contact.friction = 0.3f;
        check_ok(mspring_network_set_contact(network, &contact));
    }
    return network;
}

/// The arms close, open and swing; each robot has signals of its own if they are to differ.
static void drive(mspring_network *network, uint32_t robots, uint32_t step, bool differ) {
    float signals[ROBOTS * ACTUATORS];
    for (uint32_t i = 0; i < robots * ACTUATORS; i++) {
        const uint32_t k = i % ACTUATORS, which = differ ? i / ACTUATORS : 0;
        const double phase = sin(0.12 * step + 0.1 * which + 0.05 * k);
        signals[i] = (float)(k < 2 * ARM ? 1 - 0.1 * phase : 0.55 - 0.45 * phase);
    }
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, robots * ACTUATORS, signals, 1));
}

/// Steps, and how many pairs touched in all.
static uint64_t hash_after_steps(way with, uint32_t *touching) {
    mspring_network *network = network_of(with);
    uint64_t hash = 0;
    *touching = 0;
    for (uint32_t step = 0; step < STEPS; step++) {
        mspring_contact_info info = {.struct_size = sizeof info};
        drive(network, with.robots, step, true);
        support_steps(network, 1, DT);
        check_ok(mspring_network_get_contact_info(network, &info));
        *touching += info.touching;
        hash = hash * 31 + support_hash(network);
    }
    mspring_network_destroy(network);
    return hash;
}

static void check_ways(bool has_contact, uint32_t changes) {
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    uint32_t touching;
    way with = {.level = MSPRING_SIMD_SCALAR,
                .workers = 1,
                .robots = ROBOTS,
                .in_irregular = true,
                .has_contact = has_contact,
                .changes = changes};
    const uint64_t expected = hash_after_steps(with, &touching);
    assert_int_equal(touching > 100, has_contact); // or the test does not show what it should
    with.in_irregular = false;
    for (uint32_t i = 0; i < count; i++) {
        with.level = levels[i];
        for (with.workers = 1; with.workers <= 3; with.workers += 2) {
            assert_int_equal(hash_after_steps(with, &touching), expected);
        }
    }
}

static void signals_act_in_herds(void **state) {
    (void)state;
    if (!ROUNDS_ARE_FEW)
        check_ways(false, 1);
    check_ways(false, 4);
}

static void robots_in_herds_touch_themselves(void **state) {
    (void)state;
    if (!ROUNDS_ARE_FEW)
        check_ways(true, 1);
    check_ways(true, 4);
}

/// With the same signals each robot of a batch moves as one alone. Local origins differ, so coordinates round
/// otherwise: by 1e-5 m at 150 m, and contact and friction make more of that, by a tenth of the thickness at most.
static void each_moves_as_one_alone(void **state) {
    (void)state;
    way with = {.workers = 1, .robots = ROBOTS, .has_contact = true, .changes = 1};
    mspring_network *batch = network_of(with);
    with.robots = 1;
    mspring_network *alone = network_of(with);
    uint32_t touching = 0;
    for (uint32_t step = 0; step < STEPS; step++) {
        mspring_contact_info info = {.struct_size = sizeof info};
        drive(batch, ROBOTS, step, false);
        drive(alone, 1, step, false);
        support_steps(batch, 1, DT);
        support_steps(alone, 1, DT);
        check_ok(mspring_network_get_contact_info(alone, &info));
        touching += info.touching;
        for (mspring_id p = 0; p < ROBOTS * SIZE; p++) {
            const support_point here = support_position(batch, p), there = support_position(alone, p % SIZE);
            check_near(here.x - 8.0 * (p / SIZE), there.x, 0.01);
            check_near(here.y, there.y, 0.01);
        }
    }
    assert_true(touching > 5);
    mspring_network_destroy(batch);
    mspring_network_destroy(alone);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signals_act_in_herds),
        cmocka_unit_test(robots_in_herds_touch_themselves),
        cmocka_unit_test(each_moves_as_one_alone),
    };
    return cmocka_run_group_tests_name("robots", tests, NULL, NULL);
}
