/// @file test_loose_floor.c
/// Loose particles over a floor: the bits are those of one substep after the other near it, those of a closed form
/// far from it, and the same at every level and for any number of workers.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "recipe.h"
#include "support.h"

enum { SUBSTEPS = 40, LOOSE = 200, HEIGHTS = 48, CLOSE = 37 };

static const double planes[2 * 4] = {-6, 0, 1, 0.1, 0, 30, 0, -1};

/// A rough field of heights between a wall and a lid.
static void lay_floor(mspring_network *network) {
    static float heights[HEIGHTS];
    uint64_t seed = 11;
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    for (uint32_t i = 0; i < HEIGHTS; i++) {
        heights[i] = (float)support_random_between(&seed, -0.4, 0.4);
    }
    def.planes = planes;
    def.plane_count = 2;
    def.heights = heights;
    def.height_count = HEIGHTS;
    def.heights_x = -7;
    def.spacing = 0.4;
    def.friction = 0.4f;
    def.restitution = 0.3f;
    check_ok(mspring_network_set_floor(network, &def));
}

/// The first so many are near the ground, the others far above it.
static mspring_builder *scatter(uint32_t count, uint32_t near_count) {
    uint64_t seed = 5;
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < count; i++) {
        mspring_particle_def def;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
        def.x = support_random_between(&seed, -5, 8);
        def.y = support_random_between(&seed, 0.2, 0.8) + (i < near_count ? 0.0 : 14.0);
        def.vx = (float)support_random_between(&seed, -2, 2);
        def.vy = (float)support_random_between(&seed, -2, 2);
        def.mass = (float)support_random_between(&seed, 0.5, 2);
        check_ok(mspring_builder_add_particles(builder, &def, 1, NULL));
    }
    return builder;
}

static mspring_network_def loose_def(void) {
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.settings.global_damping = 0.1f;
    return def;
}

static uint64_t hash_of(const mspring_network *network) {
    uint64_t hash = 0;
    check_ok(mspring_network_get_state_hash(network, &hash));
    return hash;
}

static void do_nothing(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

static void check_same(const mspring_network *a, const mspring_network *b, mspring_id first, mspring_id end) {
    for (mspring_id p = first; p < end; p++) {
        const support_point at = support_position(a, p), other = support_position(b, p);
        const support_point goes = support_velocity(a, p), other_goes = support_velocity(b, p);
        check_near(at.x, other.x, 0);
        check_near(at.y, other.y, 0);
        check_near(goes.x, other_goes.x, 0);
        check_near(goes.y, other_goes.y, 0);
    }
}

/// Between any two substeps of one network there is a hook, which has each taken on its own, of all particles. In steps
/// this long all of them are near.
static void near_ones_go_substep_by_substep(void **state) {
    (void)state;
    const mspring_network_def def = loose_def();
    mspring_network *network = support_network(scatter(LOOSE, LOOSE), &def);
    mspring_network *hooked = support_network(scatter(LOOSE, LOOSE), &def);
    lay_floor(network);
    lay_floor(hooked);
    check_ok(support_add_hook(hooked, MSPRING_PHASE_AFTER_SUBSTEP, do_nothing, NULL, NULL));
    double lowest = 1;
    for (int step = 0; step < 20; step++) {
        support_steps(network, 1, 0.25);
        support_steps(hooked, 1, 0.25);
        assert_true(hash_of(network) == hash_of(hooked));
        for (mspring_id p = 0; p < LOOSE; p++) {
            lowest = fmin(lowest, support_position(network, p).y);
        }
    }
    assert_true(lowest < 0); // in one of the hollows
    mspring_network_destroy(network);
    mspring_network_destroy(hooked);
}

/// Those near the ground do not change how the others fall, some of them beside these in memory, as if there were no
/// ground.
static void near_ones_leave_far_ones_alone(void **state) {
    (void)state;
    const mspring_network_def def = loose_def();
    mspring_network *network = support_network(scatter(LOOSE, CLOSE), &def);
    mspring_network *free_of_it = support_network(scatter(LOOSE, CLOSE), &def);
    lay_floor(network);
    for (int step = 0; step < 20; step++) {
        support_steps(network, 1, 1.0 / 64);
        support_steps(free_of_it, 1, 1.0 / 64);
        check_same(network, free_of_it, CLOSE, LOOSE);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(free_of_it);
}

/// Beside a web that is large enough for several workers, among whom the loose particles are divided, too.
static void bits_are_the_same_for_any_workers_and_levels(void **state) {
    (void)state;
    enum { WEB = 1500, FANS = 8, SOME = 1000 };
    uint64_t expected = 0;
    for (int level = MSPRING_SIMD_AUTO; level <= MSPRING_SIMD_AVX512; level++) {
        for (uint32_t workers = 1; workers <= 3; workers++) {
            mspring_builder *builder = scatter(SOME, SOME / 2);
            uint64_t seed = 17;
            for (uint32_t i = 0; i < WEB; i++) {
                support_particle(builder, support_random_between(&seed, 0, 5), support_random_between(&seed, 1, 5),
                                 1);
            }
            for (uint32_t i = 0; i < WEB * FANS; i++) {
                const mspring_id from = i / FANS, to = (from + 1 + i % FANS * 7) % WEB;
                support_spring(builder, SOME + from, SOME + to, 1, 0);
            }
            mspring_network_def def = loose_def();
            def.worker_count = workers;
            def.simd_level = (mspring_simd)level;
            mspring_network *network = support_network(builder, &def);
            lay_floor(network);
            support_steps(network, 6, 1.0 / 64);
            expected = expected ? expected : hash_of(network);
            assert_true(hash_of(network) == expected);
            mspring_network_destroy(network);
        }
    }
}

/// Forces of the host throw light particles and heavy ones at the ground, where one of them lies already.
static void what_forces_throw_stays_above(void **state) {
    (void)state;
    static const float masses[] = {0.01f, 1, 30};
    for (size_t i = 0; i < COUNT_OF(masses); i++) {
        enum { COUNT = 40 };
        const double plane[4] = {0, 0, 0, 1};
        const float none = 0, push = -1000 * masses[i];
        mspring_builder *builder = support_builder();
        for (uint32_t p = 0; p < COUNT; p++)
            support_particle(builder, p, p == 7 ? 0.001 : 1, masses[i]);
        const mspring_network_def def = support_def(0, 4);
        mspring_network *network = support_network(builder, &def);
        mspring_floor_def floor;
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
        floor.planes = plane;
        floor.plane_count = 1;
        check_ok(mspring_network_set_floor(network, &floor));
        check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, COUNT, &none, &push, 0));
        support_steps(network, 1, 1.0 / 16); // 2 m
        for (uint32_t p = 0; p < COUNT; p++)
            check_near(support_position(network, p).y, 0, 1e-4);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_ones_go_substep_by_substep),
        cmocka_unit_test(near_ones_leave_far_ones_alone),
        cmocka_unit_test(what_forces_throw_stays_above),
        cmocka_unit_test(bits_are_the_same_for_any_workers_and_levels),
    };
    return cmocka_run_group_tests_name("loose_floor", tests, NULL, NULL);
}
