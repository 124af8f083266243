/// @file test_canonical.c
/// The same state saves the same bytes: after a load, in a network that has lived otherwise before it, and after
/// calls that only ask or are refused.
///
/// SPDX-License-Identifier: MIT
#include <fenv.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "snapshots.h"
#include "support.h"

static mspring_network *make(mspring_solver solver, uint64_t seed) {
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}};
    recipe made = {0};
    recipe_lattice(&made, 5, 3, 0, 0, 1, &stuff, &seed);
    recipe_lattice(&made, 4, 2, 0, 9, 1, &stuff, &seed);
    recipe_particle(&made, 20, 0, 1, 0);
    mspring_network_def def = support_def(-9.8f, 4);
    def.spare_particles = def.spare_springs = 4;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    if (solver != MSPRING_SOLVER_EXPLICIT)
        snapshots_use_solver(network, solver, MSPRING_INTEGRATOR_BDF2, 7);
    return network;
}

static void check_same(const mspring_network *network, const saved *expected) {
    const saved now = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    assert_int_equal(now.size, expected->size);
    assert_memory_equal(now.bytes, expected->bytes, now.size);
    free(now.bytes);
}

// One of many edits. Some are refused, as what they name is gone.
static void edit(mspring_network *network, bool may_compact, uint64_t *seed) {
    const mspring_id p = (mspring_id)(support_random(seed) % mspring_network_count(network, MSPRING_PARTICLES));
    const mspring_id s = (mspring_id)(support_random(seed) % mspring_network_count(network, MSPRING_SPRINGS));
    const float value = (float)support_random_between(seed, -1, 1), mass = 2 + value, strain = 0.5f;
    const double x = support_random_between(seed, -5, 5);
    mspring_particle_def particle;
    mspring_spring_def spring;
    mspring_id id;
    mspring_result result = MSPRING_OK;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    particle.x = x;
    spring.a = p, spring.b = s % mspring_network_count(network, MSPRING_PARTICLES), spring.stiffness = 20;
    switch (support_random(seed) % 14) {
    case 0:
        result = mspring_network_break_springs(network, &s, 0, 1);
        break;
    case 1:
        result = mspring_network_restore_springs(network, &s, 0, 1, value > 0 ? 0.1 : 0.0);
        break;
    case 2:
        result = mspring_network_set_velocities(network, NULL, p, 1, &value, &value, 1);
        break;
    case 3:
        result = mspring_network_set_positions(network, NULL, p, 1, &x, &x, 1);
        break;
    case 4:
        result = mspring_network_add_particles(network, &particle, 1, &id);
        break;
    case 5:
        result = mspring_network_add_springs(network, &spring, 1, &id);
        break;
    case 6:
        result = mspring_network_remove_particles(network, &p, 0, 1);
        break;
    case 7:
        result = mspring_network_remove_springs(network, &s, 0, 1);
        break;
    case 8:
        result = mspring_network_reuse_ids(network);
        break;
    case 9:
        result = mspring_network_set_velocities(network, &p, 0, 1, &value, &value, 0);
        break;
    case 10:
        result = mspring_network_set(network, MSPRING_MASS, NULL, p, 1, &mass, 1);
        break;
    case 11:
        result = mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, s, 1, &strain, 1);
        break;
    case 12:
        result = may_compact ? mspring_network_compact(network) : MSPRING_OK;
        break;
    default:
        result = mspring_network_wake(network);
    }
    (void)result;
}

static void a_load_brings_the_same_bytes(void **state) {
    (void)state;
    const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT};
    for (uint64_t seed = 0; seed < (uint64_t)ROUNDS(60); seed++) {
        mspring_network *one = make(solvers[seed % 2], 7), *other = make(solvers[seed % 2], 7);
        uint64_t edits = seed;
        for (int round = 0; round < 40; round++) {
            uint64_t same = edits;
            edit(one, seed % 2 == 0, &edits);
            edit(other, seed % 2 == 0, &same);
            if (round % 3 == 0) {
                const mspring_result result = mspring_network_step(one, 0.01);
                assert_int_equal(mspring_network_step(other, 0.01), result);
            }
            const saved now = snapshots_save(one, MSPRING_SNAPSHOT_ALL);
            check_same(other, &now);
            snapshots_load(other, &now);
            check_same(other, &now);
            free(now.bytes);
        }
        // Back from another life.
        const saved now = snapshots_save(one, MSPRING_SNAPSHOT_ALL);
        mspring_network *whole = make(solvers[seed % 2], 7);
        const mspring_result fits = mspring_network_load(whole, now.bytes, now.size); // not if one is compact
        if (fits == MSPRING_OK)
            check_same(whole, &now);
        for (int i = 0; fits == MSPRING_OK && i < 5; i++) {
            const mspring_id s = (mspring_id)i + 1;
            if (support_has_spring(one, s))
                check_ok(mspring_network_break_springs(one, &s, 0, 1));
            (void)!mspring_network_step(one, 0.01);
        }
        if (fits == MSPRING_OK) {
            snapshots_load(one, &now);
            check_same(one, &now);
        }
        free(now.bytes);
        mspring_network_destroy(one);
        mspring_network_destroy(other);
        mspring_network_destroy(whole);
    }
}

/// Questions, answered or refused, leave the guard's knowledge as it was.
static void questions_change_nothing(void **state) {
    (void)state;
    mspring_network *network = make(MSPRING_SOLVER_EXPLICIT, 7);
    for (int round = 0; round < 3; round++) {
        const float stiff = 1e6f;
        uint32_t substeps;
        double now, any_shape;
        const saved before = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        check_error(mspring_network_suggest_substeps(network, 1e9, 1e-9, &substeps), MSPRING_ERROR_UNSTABLE);
        check_same(network, &before);
        check_ok(mspring_network_suggest_substeps(network, 0.01, 0.5, &substeps));
        check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
        check_same(network, &before);
        free(before.bytes);
        support_steps(network, 1, 1e-4);
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, (mspring_id)round, 1, &stiff, 1));
    }
    mspring_network_destroy(network);
}

// Two lattices, one asleep on the other, and a third of its own.
static mspring_network *make_sleepers(mspring_solver solver) {
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {400, 400}, .damping = {8, 8}};
    recipe made = {0};
    uint64_t seed = 3;
    recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    recipe_lattice(&made, 4, 3, 0, 3.1, 1, &stuff, &seed);
    recipe_lattice(&made, 3, 2, 20, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(-9.8f, 8);
    def.settings.sleep_speed = 0.05f;
    def.settings.sleep_time = 0.1f;
    def.settings.global_damping = 2;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    mspring_floor_def floor;
    mspring_contact_def contact;
    const double plane[4] = {0, -0.5, 0, 1};
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    floor.planes = plane;
    floor.plane_count = 1;
    floor.friction = contact.friction = 0.5f;
    contact.thickness = 0.1;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(mspring_network_set_contact(network, &contact));
    if (solver != MSPRING_SOLVER_EXPLICIT)
        snapshots_use_solver(network, solver, MSPRING_INTEGRATOR_EULER, 7);
    for (int step = 0; step < 3000 && !support_is_asleep(network); step++)
        support_steps(network, 1, 0.01);
    assert_true(support_is_asleep(network));
    return network;
}

// Disturb one particle of sleepers without a step.
static void disturb(mspring_network *network, uint32_t way, mspring_id p) {
    const double x = 3, y = 12;
    const float speed = 2, mass = 3, scale = 0.5f;
    switch (way) {
    case 0:
        check_ok(mspring_network_set_positions(network, NULL, p, 1, &x, &y, 1));
        break;
    case 1:
        check_ok(mspring_network_set_velocities(network, NULL, p, 1, &speed, &speed, 1));
        break;
    case 2:
        check_ok(mspring_network_set(network, MSPRING_MASS, NULL, p, 1, &mass, 1));
        break;
    case 3:
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, p, 1, &scale, 1));
        break;
    case 4:
        check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, NULL, p, 1, &speed, &speed, 1));
        break;
    default:
        support_shift(network, p, 1, 0);
    }
}

/// Sleepers that the host disturbs wake in the next step. Snapshots before it are those after a load, and both go
/// on alike, with the pile of the disturbed island.
static void disturbed_sleepers_save_the_same_bytes(void **state) {
    (void)state;
    const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT};
    const mspring_id particles[] = {1, 14, 26};
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *asleep = make_sleepers(solvers[i]);
        const saved start = snapshots_save(asleep, MSPRING_SNAPSHOT_ALL);
        for (uint32_t way = 0; way < 6 * COUNT_OF(particles); way++) {
            mspring_network *one = NULL, *other = NULL;
            check_ok(mspring_network_clone(asleep, NULL, &one));
            check_ok(mspring_network_clone(asleep, NULL, &other));
            check_same(one, &start);
            disturb(one, way % 6, particles[way / 6]);
            for (int step = 0; step < 20; step++) {
                const saved now = snapshots_save(one, MSPRING_SNAPSHOT_ALL);
                snapshots_load(other, &now);
                check_same(other, &now);
                free(now.bytes);
                const mspring_result result = mspring_network_step(one, 0.01);
                assert_int_equal(mspring_network_step(other, 0.01), result);
            }
            mspring_network_destroy(one);
            mspring_network_destroy(other);
        }
        free(start.bytes);
        mspring_network_destroy(asleep);
    }
}

// Tiles are cut alike whether those that the next step wakes still sleep, or were loaded awake.
static void sleepers_do_not_count_in_tiles(void **state) {
    (void)state;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {20, 30}};
    const float push = 1;
    mspring_network *networks[2];
    for (int i = 0; i < 2; i++) {
        uint64_t seed = 5;
        recipe made = {0};
        for (uint32_t p = 0; p < 400; p++)
            recipe_particle(&made, support_random_between(&seed, -9, 9), support_random_between(&seed, -9, 9), 1,
                            0);
        recipe_random_springs(&made, 600, &stuff, &seed);
        mspring_network_def def = support_def(0, 4);
        def.settings.sleep_speed = 100;
        def.settings.sleep_time = 0.05f;
        networks[i] = recipe_network(&made, &def);
        recipe_free(&made);
    }
    support_fall_asleep(networks[0], 1.0 / 64);
    check_ok(mspring_network_set_velocities(networks[0], NULL, 0, 400, &push, &push, 0)); // the next step wakes them
    saved now = snapshots_save(networks[0], MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_load(networks[1], now.bytes, now.size));
    free(now.bytes);
    for (int i = 0; i < 2; i++)
        snapshots_use_solver(networks[i], MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 1);
    now = snapshots_save(networks[0], MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_load(networks[1], now.bytes, now.size));
    check_same(networks[1], &now);
    free(now.bytes);
    support_steps(networks[0], 4, 1.0 / 64);
    support_steps(networks[1], 4, 1.0 / 64);
    assert_true(support_hash(networks[0]) == support_hash(networks[1]));
    for (int i = 0; i < 2; i++)
        mspring_network_destroy(networks[i]);
}

// Hosts set the rest lengths of actuators, too: to all that springs may have. Signals keep within that.
static void lengths_of_actuators_are_those_of_springs(void **state) {
    (void)state;
    static const float lengths[] = {1e-40f, 1e-20f, 4e12f}, most = 100;
    const mspring_id spring = 0;
    mspring_network *network = make(MSPRING_SOLVER_EXPLICIT, 3);
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        float length = 4e10f;
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, 1, &length, 1));
        check_ok(mspring_network_set_actuators(network, &spring, 1, 1));
        check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 1, &most, 1));
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, 1, &lengths[i], 1));
        const saved now = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        check_ok(mspring_network_load(network, now.bytes, now.size));
        check_same(network, &now);
        free(now.bytes);
    }
    check_error(mspring_network_set_actuators(network, &spring, 1, 1),
                MSPRING_ERROR_ARGUMENT); // 4e14 m by a signal
    check_contains(mspring_network_error(network), "it must be 1e-12 to 4e10");
    mspring_network_destroy(network);
}

/// A scale of -0 pins as one of 0 does.
static void a_scale_has_no_sign(void **state) {
    (void)state;
    mspring_network *one = make(MSPRING_SOLVER_EXPLICIT, 7), *other = make(MSPRING_SOLVER_EXPLICIT, 7);
    const float none = 0.0f, negative = -0.0f;
    check_ok(mspring_network_set(one, MSPRING_INVERSE_MASS_SCALE, NULL, 3, 1, &negative, 1));
    check_ok(mspring_network_set(other, MSPRING_INVERSE_MASS_SCALE, NULL, 3, 1, &none, 1));
    const saved now = snapshots_save(one, MSPRING_SNAPSHOT_ALL);
    check_same(other, &now);
    snapshots_load(other, &now);
    check_same(other, &now);
    free(now.bytes);
    mspring_network_destroy(one);
    mspring_network_destroy(other);
}

/// A step that is refused after springs have yielded in it.
static void a_refused_flow_leaves_no_trace(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id centre = support_particle(builder, 0, 0, 1);
    const double corners[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int i = 0; i < 4; i++)
        support_spring(builder, centre, support_particle(builder, corners[i][0], corners[i][1], 1), 100, 1);
    const mspring_id far = support_particle(builder, 9e11, 0, 1); // half a step takes it past 1e12 m
    mspring_network_def def = support_def(0, 8);
    def.settings.guard = MSPRING_GUARD_GROWTH;
    mspring_network *network = support_network(builder, &def);
    const float yield = 0.05f, fast = 200, faster = 9e11f;
    uint64_t hash, hash_before;
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, 4, &yield, 0));
    check_ok(mspring_network_set_velocities(network, NULL, 1, 1, &fast, &fast, 1));
    check_ok(mspring_network_set_velocities(network, NULL, far, 1, &faster, &fast, 1));
    check_ok(mspring_network_get_state_hash(network, &hash_before));
    const saved before = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    assert_int_not_equal(mspring_network_step(network, 0.2), MSPRING_OK);
    check_same(network, &before);
    check_ok(mspring_network_get_state_hash(network, &hash));
    assert_true(hash == hash_before);
    const float slow = 0;
    check_ok(mspring_network_set_velocities(network, NULL, far, 1, &slow, &slow, 1));
    support_steps(network, 1, 0.02);
    float strain = 0;
    check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, 0, 1, &strain, 1));
    assert_true(strain != 0.0f); // it yields
    free(before.bytes);
    mspring_network_destroy(network);
}

#if defined(FE_UPWARD) && !defined(__wasm__)
/// Whoever steps may round as they like.
static void the_callers_rounding_does_not_count(void **state) {
    (void)state;
    const int modes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    saved first = {NULL, 0};
    for (size_t i = 0; i < COUNT_OF(modes); i++) {
        mspring_network *network = make(MSPRING_SOLVER_EXPLICIT, 7);
        mspring_area_def area;
        mspring_angle_def angle;
        const mspring_id corners[4] = {0, 2, 12, 10}, arms[3] = {0, 6, 2};
        check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
        check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
        area.stiffness = angle.stiffness = 1;
        fesetround(modes[i]);
        mspring_result worst = mspring_network_add_area(network, &area, corners, 4, NULL);
        worst = worst ? worst : mspring_network_add_cell_areas(network, &area, NULL, NULL);
        worst = worst ? worst : mspring_network_add_angles(network, &angle, arms, 1, 3, NULL);
        worst = worst ? worst : mspring_network_remove_elements(network, NULL, 1, 1);
        for (int step = 0; step < 30; step++)
            worst = worst ? worst : mspring_network_step(network, 1.0 / 60);
        fesetround(FE_TONEAREST);
        check_ok(worst);
        if (i == 0)
            first = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        check_same(network, &first);
        mspring_network_destroy(network);
    }
    free(first.bytes);
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_load_brings_the_same_bytes),
        cmocka_unit_test(questions_change_nothing),
        cmocka_unit_test(disturbed_sleepers_save_the_same_bytes),
        cmocka_unit_test(a_scale_has_no_sign),
        cmocka_unit_test(sleepers_do_not_count_in_tiles),
        cmocka_unit_test(lengths_of_actuators_are_those_of_springs),
        cmocka_unit_test(a_refused_flow_leaves_no_trace),
#if defined(FE_UPWARD) && !defined(__wasm__)
        cmocka_unit_test(the_callers_rounding_does_not_count),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
