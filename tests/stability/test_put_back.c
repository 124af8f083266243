/// @file test_put_back.c
/// MSPRING_GUARD_CLAMP_BOUNDS leaves nothing behind that is no number: whatever explodes, all that a network
/// carries to its next step is finite, it takes its own snapshot, and repeats its steps after it.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "snapshots.h"
#include "step/finite.h"
#include "support.h"

enum { STEPS = 6 };

static mspring_network *make(const uint64_t number, mspring_solver solver, float gravity) {
    uint64_t seed = number;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {1e7, 1e8}, .damping = {0, number % 2 ? 10 : 0}};
    recipe made = {0};
    recipe_lattice(&made, 3 + (uint32_t)number % 9, 4, 0, 0, 1, &stuff, &seed);
    recipe_particle(&made, -4, 0, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, made.particle_count - 1, 0, 4, &stuff, &seed);
    recipe_particle(&made, 0, 12, 1, 0);
    recipe_disturb(&made, 0.1, 1, &seed);
    mspring_network_def def = support_def(gravity, 8);
    def.settings.guard = MSPRING_GUARD_CLAMP_BOUNDS;
    def.spare_particles = def.spare_springs = number % 3 ? 20 : 0;
    def.settings.sleep_speed = number % 5 == 0 ? 0.1f : 0;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    snapshots_use_solver(network, solver, MSPRING_INTEGRATOR_BDF2, 7);
    return network;
}

// Grips, a collider and springs that yield have sums of their own.
static void hold(mspring_network *network) {
    mspring_grip_def grip;
    mspring_contact_def contact;
    mspring_collider_def collider;
    const float yield = 0.01f;
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    grip.particle = 1, grip.x = 4, grip.y = 4, grip.stiffness = 1e6f;
    check_ok(mspring_network_add_grip(network, &grip, NULL));
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    check_ok(mspring_network_set_contact(network, &contact));
    check_ok(support_reserve_contact_events(network, 16));
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &collider, sizeof collider));
    collider.kind = MSPRING_COLLIDER_CIRCLE, collider.y = -2, collider.radius = 1;
    check_ok(mspring_network_add_collider(network, &collider, NULL));
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, 10, &yield, 0));
}

static void check_repeats(mspring_network *network) {
    const saved before = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    const mspring_result result = mspring_network_step(network, 1.0 / 64);
    assert_true(mspringi_is_finite(network));
    if (result == MSPRING_ERROR_LIMIT) { // contact took too long
        free(before.bytes);
        return;
    }
    check_ok(result);
    const saved after = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    snapshots_load(network, &before);
    check_ok(mspring_network_step(network, 1.0 / 64));
    const saved again = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    assert_int_equal(again.size, after.size);
    assert_memory_equal(again.bytes, after.bytes, after.size);
    free(before.bytes);
    free(after.bytes);
    free(again.bytes);
}

static void what_explodes_leaves_numbers(void **state) {
    (void)state;
    const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};
    const float gravities[] = {-9.8f, 3e38f};
    uint32_t put_back = 0;
    for (uint64_t seed = 0; seed < (uint64_t)SAMPLE(10); seed++) {
        for (size_t i = 0; i < COUNT_OF(solvers) * COUNT_OF(gravities); i++) {
            mspring_network *network = make(seed, solvers[i % COUNT_OF(solvers)], gravities[i / COUNT_OF(solvers)]);
            const float fast = 1e14f;
            if (seed % 2)
                hold(network);
            check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &fast, &fast, 1));
            for (int step = 0; step < STEPS; step++) {
                check_repeats(network);
                put_back += (support_step_info(network).flags & MSPRING_STEP_PUT_BACK) != 0;
            }
            mspring_network_destroy(network);
        }
    }
    assert_true(put_back > 50); // of 300 steps at least
}

// A network in which one value is absurd.
static mspring_network *make_absurd(uint64_t number, mspring_simd level) {
    uint64_t seed = 1 + number;
    const recipe_stuff stuff = {.mass = {1, 3}, .stiffness = {14, 50}, .damping = {0, number % 2 ? 3 : 0}, .holes = 0.2};
    recipe made = {0};
    recipe_lattice(&made, 5 + (uint32_t)number % 13, 3 + (uint32_t)number % 4, 30, 0, 1, &stuff, &seed);
    recipe_lattice(&made, 4, 4, 70, 0, 1, &stuff, &seed);
    recipe_particle(&made, -3, -30, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, made.particle_count - 1, 0, 9, &stuff, &seed);
    recipe_disturb(&made, 0.1, 0.1, &seed);
    mspring_spring_def *spring = &made.springs[support_random(&seed) % made.spring_count];
    mspring_particle_def *particle = &made.particles[support_random(&seed) % made.particle_count];
    switch (number % 5) {
    case 0:
        spring->damping = 1e12f;
        break;
    case 1:
        spring->stiffness = 1e30f;
        break;
    case 2:
        spring->rest_length = 1e12f;
        spring->stiffness = 1e25f;
        break;
    case 3:
        particle->mass = 1e-30f;
        break;
    default:
        particle->vx = 1e15f;
        spring->stiffness = 1e15f;
    }
    mspring_network_def def = support_def(number % 7 ? -9.8f : 1e30f, 4 + (uint32_t)number % 9);
    def.settings.guard = MSPRING_GUARD_CLAMP_BOUNDS;
    def.simd_level = level;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

// Infinity times 0 spreads from springs that are not there, of which wide vectors have more. So the steps in which
// numbers overflow are taken again by springs one after another, the same at all levels.
static void levels_put_back_the_same(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    uint32_t put_back = 0;
    for (uint64_t number = 0; number < 2 * (uint64_t)ROUNDS(30); number++) {
        uint64_t hashes[STEPS];
        for (uint32_t i = 0; i < level_count; i++) {
            mspring_network *network = make_absurd(number, levels[i]);
            for (int step = 0; step < STEPS; step++) {
                check_ok(mspring_network_step(network, 1.0 / 64));
                put_back += (support_step_info(network).flags & MSPRING_STEP_PUT_BACK) != 0;
                if (i == 0)
                    hashes[step] = support_hash(network);
                assert_true(support_hash(network) == hashes[step]);
            }
            mspring_network_destroy(network);
        }
    }
    assert_true(put_back > 20);
}

/// Soft springs and places of before: the network falls as ever.
static void a_calmed_network_moves_again(void **state) {
    (void)state;
    mspring_network *network = make(4, MSPRING_SOLVER_EXPLICIT, -9.8f);
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    const float soft = 10, rest = 0, fast = 1e14f;
    double x[100], y[100];
    assert_true(count < COUNT_OF(x));
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &fast, &fast, 1));
    support_steps(network, STEPS, 1.0 / 64);
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, mspring_network_count(network, MSPRING_SPRINGS), &soft, 0));
    check_ok(mspring_network_set_positions(network, NULL, 0, count, x, y, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, count, &rest, &rest, 0));
    support_steps(network, 16, 1.0 / 64);
    assert_true(support_position(network, 0).y < y[0] - 0.1);
    assert_true(support_position(network, count - 1).y < y[count - 1] - 0.25); // 0.33 m of free fall
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_explodes_leaves_numbers),
        cmocka_unit_test(levels_put_back_the_same),
        cmocka_unit_test(a_calmed_network_moves_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
