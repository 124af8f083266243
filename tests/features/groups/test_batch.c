/// @file test_batch.c
/// Groups of particles: one that goes wrong is held, and the others have the bits that they have without it; groups
/// are put back, observed and driven singly; snapshots, clones and layouts follow.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

#define DT (1.0 / 64)
enum { SIDE = 6, ROBOTS = 16, MOST = ROBOTS * SIDE * SIDE };

typedef enum shape { LATTICE, CHAIN, WEB, SHAPES } shape;

static void add_spring(mspring_builder *b, mspring_id first, uint32_t i, uint32_t j, float stiffness) {
    (void)support_spring(b, first + i, first + j, stiffness, 5);
}

// A robot of SIDE * SIDE particles of 1 kg at x, above the floor.
static void add_robot(mspring_builder *b, shape of, double x, float stiffness) {
    const mspring_id first = mspring_builder_particle_count(b);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double shift = of == WEB ? 0.13 * (double)(i * 7 % 5) : 0.0;
        (void)support_particle(
            b, x + i % SIDE + shift,
            1 + (of == CHAIN ? 0.3 : 1.0) * (i / SIDE) + 0.5 * shift + (of == CHAIN ? 0.1 * (i % 2) : 0.0), 1);
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const bool right = i % SIDE + 1 < SIDE, above = i / SIDE + 1 < SIDE;
        if (right)
            add_spring(b, first, i, i + 1, stiffness);
        if (of == CHAIN)
            continue;
        if (above)
            add_spring(b, first, i, i + SIDE, stiffness);
        if (above && right)
            add_spring(b, first, i, i + SIDE + 1, stiffness);
        if (above && right && of == LATTICE)
            add_spring(b, first, i + 1, i + SIDE, stiffness);
        if (of == WEB && i % 3 == 0 && i + 13 < SIDE * SIDE)
            add_spring(b, first, i, i + 13, stiffness);
    }
}

// Robots beside each other, but for those of which stiffness is 0. Chains are several bodies each.
static mspring_network *robots(shape of, const float *stiffness, uint32_t count, mspring_simd level) {
    mspring_builder *builder = support_builder();
    uint32_t firsts[ROBOTS + 1] = {0}, groups = 0;
    for (uint32_t i = 0; i < count; i++)
        if (stiffness[i] > 0) {
            add_robot(builder, of, 8.0 * i, stiffness[i]);
            firsts[++groups] = mspring_builder_particle_count(builder);
        }
    mspring_network_def def = support_def(-9.8f, 20);
    def.guard = MSPRING_GUARD_BOUNDS;
    def.max_speed = 1000;
    def.simd_level = level;
    mspring_network *network = support_network(builder, &def);
    mspring_floor_def floor;
    const double plane[4] = {0, 0, 0, 1}; // a point, and the normal
    check_ok(mspring_floor_def_init(&floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(mspring_network_set_groups(network, firsts, groups));
    return network;
}

static mspring_network *equal_robots(void) {
    float stiffness[ROBOTS];
    for (int i = 0; i < ROBOTS; i++)
        stiffness[i] = 2000;
    return robots(LATTICE, stiffness, ROBOTS, MSPRING_SIMD_AUTO);
}

static uint32_t flags_of(const mspring_network *network, uint32_t group) {
    uint32_t flags = 0xffffffffu;
    check_ok(mspring_network_get_group_flags(network, group, 1, &flags, 1));
    return flags;
}

typedef struct state {
    double x[MOST], y[MOST];
    float vx[MOST], vy[MOST];
} state_of;

static void read_group(const mspring_network *network, uint32_t group, state_of *s) {
    const uint32_t first = group * SIDE * SIDE, count = SIDE * SIDE;
    check_ok(mspring_network_get_positions(network, first, count, s->x, s->y, 1));
    check_ok(mspring_network_get_velocities(network, first, count, s->vx, s->vy, 1));
}

static void check_same_group(const mspring_network *a, uint32_t group_a, const mspring_network *b,
                             uint32_t group_b) {
    static state_of in_a, in_b;
    read_group(a, group_a, &in_a);
    read_group(b, group_b, &in_b);
    assert_memory_equal(&in_a, &in_b, sizeof in_a);
}

/* --------------------------------------------------------------------------------------------------- isolation */

// The last robot keeps the box, and so the origin, where it is.
static void is_isolated(shape of, mspring_simd level, float wrong) {
    float with[ROBOTS], without[ROBOTS];
    for (int i = 0; i < ROBOTS; i++)
        with[i] = without[i] = 2000.0f + 100.0f * (float)i;
    with[7] = wrong;
    without[7] = 0;
    mspring_network *all = robots(of, with, ROBOTS, level), *rest = robots(of, without, ROBOTS, level);
    mspring_view view = {.struct_size = sizeof view};
    for (int step = 0; step < 100; step++) {
        check_ok(mspring_network_step(all, DT));
        check_ok(mspring_network_step(rest, DT));
    }
    assert_int_equal(flags_of(all, 7), MSPRING_GROUP_HELD);
    for (uint32_t i = 0; i < ROBOTS; i++)
        if (i != 7) {
            assert_int_equal(flags_of(all, i), 0);
            check_same_group(all, i, rest, i < 7 ? i : i - 1);
        }
    check_ok(mspring_network_view(all, &view));
    for (uint32_t slot = 0; slot < view.slot_count; slot++)
        assert_true(isfinite(view.x[slot] + view.y[slot] + view.vx[slot] + view.vy[slot]));
    mspring_network_destroy(all);
    mspring_network_destroy(rest);
}

static void others_have_the_same_bits(void **state) {
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    (void)state;
    for (uint32_t i = 0; i < count; i++)
        for (int of = 0; of < SHAPES; of++) {
            is_isolated((shape)of, levels[i], 1e10f);
            is_isolated((shape)of, levels[i], 1e30f); // no number after a substep: may come to lanes beside it
        }
}

// All, or one after the other: each step is taken.
static void all_may_go_wrong(void **state) {
    float stiffness[ROBOTS];
    (void)state;
    for (int i = 0; i < ROBOTS; i++)
        stiffness[i] = i % 3 == 0 ? 1e30f : 1e10f;
    mspring_network *network = robots(LATTICE, stiffness, ROBOTS, MSPRING_SIMD_AUTO);
    support_steps(network, 200, DT);
    for (uint32_t i = 0; i < ROBOTS; i++)
        assert_int_equal(flags_of(network, i), MSPRING_GROUP_HELD);
    const uint64_t hash = support_hash(network);
    support_steps(network, 5, DT);
    assert_true(support_hash(network) == hash);
    check_ok(mspring_network_reset_groups(network, NULL, 0, MSPRING_RESET_START));
    assert_int_equal(flags_of(network, 3), 0);
    mspring_network_destroy(network);
}

// Fast by a kick, and held where it was: at rest, with the position of before the step.
static void held_where_it_was(void **state) {
    mspring_network *network = equal_robots();
    const mspring_id kicked = 3 * SIDE * SIDE + 5;
    const float fast = 1e6f;
    (void)state;
    support_steps(network, 20, DT);
    const support_point before = support_position(network, kicked);
    check_ok(mspring_network_set_velocities(network, kicked, 1, &fast, &fast, 1));
    check_ok(mspring_network_step(network, DT));
    assert_int_equal(flags_of(network, 3), MSPRING_GROUP_HELD);
    const mspring_step_info info = support_step_info(network);
    assert_int_equal(info.particle, MSPRING_NONE);
    assert_int_equal(info.result, MSPRING_OK);
    support_steps(network, 10, DT);
    const support_point now = support_position(network, kicked), velocity = support_velocity(network, kicked);
    check_near(now.x, before.x, 0);
    check_near(now.y, before.y, 0);
    check_near(velocity.x, 0, 0);
    mspring_network_destroy(network);
}

// A particle in no group is nobody's: the step fails, and nothing is held.
static void particles_in_no_group_fail_the_step(void **state) {
    mspring_network *network = equal_robots();
    const uint32_t firsts[] = {0, 2 * SIDE * SIDE};
    const float fast[2] = {1e6f, 1e6f};
    const mspring_id kicked[2] = {5, 3 * SIDE * SIDE};
    (void)state;
    check_ok(mspring_network_set_groups(network, firsts, 1));
    check_ok(mspring_network_set_velocities_at(network, kicked, 2, fast, fast, 1));
    const uint64_t hash = support_hash(network);
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    assert_true(support_hash(network) == hash);
    assert_int_equal(flags_of(network, 0), 0);
    check_ok(mspring_network_set_velocities(network, kicked[1], 1, &(float){0}, &(float){0}, 1));
    check_ok(mspring_network_step(network, DT));
    assert_int_equal(flags_of(network, 0), MSPRING_GROUP_HELD);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------------ resets */

static void resets_repeat_the_bits(void **state) {
    mspring_network *network = equal_robots(), *again = equal_robots();
    const uint32_t two[] = {4, 9};
    const mspring_id broken[] = {4 * 110 + 3, 4 * 110 + 40, 9 * 110 + 7};
    (void)state;
    support_steps(network, 30, DT);
    check_ok(mspring_network_mark_groups(network, &two[1], 1));
    check_ok(mspring_network_break_springs(network, broken, 3));
    support_steps(network, 30, DT);
    check_ok(mspring_network_reset_groups(network, &two[0], 1, MSPRING_RESET_START));
    check_ok(mspring_network_reset_groups(network, &two[1], 1, MSPRING_RESET_MARK));
    check_same_group(network, 4, again, 4);
    support_steps(again, 30, DT);
    check_same_group(network, 9, again, 9);
    support_steps(network, 30, DT);
    check_same_group(network, 4, again, 4);
    support_steps(again, 30, DT);
    check_same_group(network, 9, again, 9);
    check_same_group(network, 0, network, 0);
    mspring_network_destroy(network);
    mspring_network_destroy(again);
}

// Particles without springs fall onto a slope and slide. The second time, others are there already.
static void loose_particles_repeat_the_bits(void **state) {
    enum { STEPS = 150 };
    const double slope[] = {0, 0, -0.3, 1};
    static support_point places[2][STEPS];
    (void)state;
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 3; i++)
        (void)support_particle(builder, 10 * i, 3 * i + 12, 1);
    mspring_network_def def = support_def(-9.8f, 8);
    def.guard = MSPRING_GUARD_BOUNDS;
    mspring_network *network = support_network(builder, &def);
    mspring_floor_def floor;
    check_ok(mspring_floor_def_init(&floor, sizeof floor));
    floor.planes = slope;
    floor.plane_count = 1;
    floor.friction = 0.1f;
    check_ok(mspring_network_set_floor(network, &floor));
    const mspring_id firsts[] = {0, 1, 2, 3};
    check_ok(mspring_network_set_groups(network, firsts, 3));
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < STEPS; i++) {
            check_ok(mspring_network_step(network, DT));
            places[round][i] = support_position(network, 1);
        }
        check_ok(mspring_network_reset_groups(network, &(uint32_t){1}, 1, MSPRING_RESET_START));
    }
    assert_memory_equal(places[0], places[1], sizeof places[0]);
    mspring_network_destroy(network);
}

// Steel that has bent, and a spring whose mark has it broken.
static void resets_take_back_all(void **state) {
    mspring_network *network = equal_robots();
    const float yield = 0.001f;
    const mspring_id spring = 2 * 110;
    const uint32_t group = 2;
    float strain = 1;
    uint32_t flags = 0;
    (void)state;
    check_ok(mspring_network_break_springs(network, &spring, 1));
    check_ok(mspring_network_mark_groups(network, NULL, 0));
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, spring, 110, &yield, 0));
    support_steps(network, 60, DT);
    check_ok(mspring_network_restore_springs(network, &spring, 1, 1.0));
    check_ok(mspring_network_reset_groups(network, &group, 1, MSPRING_RESET_MARK));
    check_ok(mspring_network_get_spring_flags(network, spring, 1, &flags, 1));
    assert_true(flags & MSPRING_SPRING_BROKEN);
    for (mspring_id s = spring; s < spring + 110; s++) {
        check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, s, 1, &strain, 1));
        check_near((double)strain, 0, 0);
    }
    check_ok(mspring_network_reset_groups(network, &group, 1, MSPRING_RESET_START));
    check_ok(mspring_network_get_spring_flags(network, spring, 1, &flags, 1));
    assert_false(flags & MSPRING_SPRING_BROKEN);
    mspring_network_destroy(network);
}

// The origin does not follow, unless the host moves all.
static void origin_stays(void **state) {
    mspring_network *network = equal_robots();
    mspring_view view = {.struct_size = sizeof view};
    static double x[MOST], y[MOST];
    (void)state;
    check_ok(mspring_network_view(network, &view));
    const double origin = view.origin_x;
    check_ok(mspring_network_get_positions(network, 0, MOST, x, y, 1));
    for (int i = 0; i < MOST; i++)
        x[i] += 1000;
    check_ok(mspring_network_set_positions_at(network, (const mspring_id[]){0}, 1, x, y, 1));
    check_ok(mspring_network_step(network, DT));
    check_ok(mspring_network_view(network, &view));
    check_near(view.origin_x, origin, 0);
    check_ok(mspring_network_set_positions(network, 0, MOST, x, y, 1));
    check_ok(mspring_network_reset_groups(network, NULL, 0, MSPRING_RESET_START));
    for (mspring_id p = 0; p < 36; p++)
        check_near(support_position(network, p).x, x[p] - 1000, 1e-12);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------------- observing */

static void observes(void **state) {
    mspring_network *network = equal_robots();
    const uint32_t chosen[] = {35, 0};
    double rows[3][20];
    (void)state;
    support_steps(network, 50, DT);
    check_ok(mspring_network_observe_groups(network, 5, 3, chosen, 2, rows[0], 20));
    for (uint32_t g = 0; g < 3; g++) {
        static state_of s;
        double x = 0, vy = 0, least = 1e9, most = -1e9;
        read_group(network, 5 + g, &s);
        for (int i = 0; i < SIDE * SIDE; i++) {
            x += s.x[i] / (SIDE * SIDE);
            vy += (double)s.vy[i] / (SIDE * SIDE);
            least = fmin(least, s.y[i]);
            most = fmax(most, s.y[i]);
        }
        check_near(rows[g][MSPRING_OBSERVE_X], x, 1e-12 * fabs(x) + 1e-13); // rounding of 36 sums
        check_near(rows[g][MSPRING_OBSERVE_VY], vy, 1e-12);
        check_near(rows[g][MSPRING_OBSERVE_MIN_Y], least, 0);
        check_near(rows[g][MSPRING_OBSERVE_MAX_Y], most, 0);
        check_near(rows[g][MSPRING_OBSERVE_HELD], 0, 0);
        check_near(rows[g][MSPRING_OBSERVE_PARTICLES], s.x[35] - rows[g][MSPRING_OBSERVE_X], 1e-12);
        check_near(rows[g][MSPRING_OBSERVE_PARTICLES + 7], (double)s.vy[0], 0);
    }
    check_error(mspring_network_observe_groups(network, 5, 3, chosen, 2, rows[0], 16), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_observe_groups(network, 15, 2, chosen, 2, rows[0], 20), MSPRING_ERROR_ID);
    check_error(mspring_network_observe_groups(network, 5, 3, &(uint32_t){36}, 1, rows[0], 20), MSPRING_ERROR_ID);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------------- snapshots */

static void snapshots_and_clones_follow(void **state) {
    mspring_network *network = equal_robots(), *other = equal_robots(), *clone = NULL;
    const float fast = 5000, signals[2] = {1.1f, 0.9f};
    const mspring_id actuated[] = {3 * 110 + 1, 3 * 110 + 2};
    (void)state;
    check_ok(mspring_network_set_actuators(network, actuated, 2, 3));
    check_ok(mspring_network_set_actuators(other, actuated, 2, 3));
    support_steps(network, 10, DT);
    check_ok(mspring_network_set_velocities(network, 70, 1, &fast, &fast, 1));
    check_ok(mspring_network_set_signals(network, 0, 2, signals, 1));
    support_steps(network, 3, DT);
    check_ok(mspring_network_set_signals(network, 1, 1, signals, 1)); // pending
    check_ok(mspring_network_clone(network, NULL, &clone));
    support_bring(network, other, MSPRING_SNAPSHOT_FRAME);
    assert_int_equal(flags_of(other, 1), MSPRING_GROUP_HELD);
    support_steps(network, 20, DT);
    support_steps(other, 20, DT);
    support_steps(clone, 20, DT);
    assert_true(support_hash(network) == support_hash(other) && support_hash(network) == support_hash(clone));
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_reset_groups(other, NULL, 0, MSPRING_RESET_START));
    check_ok(mspring_network_reset_groups(network, NULL, 0, MSPRING_RESET_START));
    support_steps(network, 20, DT);
    support_steps(other, 20, DT);
    assert_true(support_hash(network) == support_hash(other));
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    mspring_network_destroy(clone);
}

// Another layout changes all slots and no bit.
static void layouts_follow(void **state) {
    mspring_network *network = equal_robots(), *other = equal_robots();
    const float fast = 5000, signal = 1.2f;
    const mspring_id broken[] = {5, 6, 700}, actuated[] = {900, 4};
    mspring_network *both[] = {network, other};
    (void)state;
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_set_actuators(both[i], actuated, 2, 1));
        check_ok(mspring_network_break_springs(both[i], broken, 3));
        check_ok(mspring_network_set_velocities(both[i], 70, 1, &fast, &fast, 1));
        support_steps(both[i], 3, DT);
        if (i == 0)
            check_ok(mspring_network_compact(both[i]));
        check_ok(mspring_network_set_signals(both[i], 0, 2, &signal, 0));
        support_steps(both[i], 20, DT);
    }
    assert_true(support_hash(network) == support_hash(other));
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_reset_groups(both[i], NULL, 0, MSPRING_RESET_START));
        support_steps(both[i], 20, DT);
    }
    assert_true(support_hash(network) == support_hash(other));
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

/* ---------------------------------------------------------------------------------------------------- refusals */

static void areas_stay_within(void **state) {
    mspring_network *network = equal_robots();
    const mspring_id across[] = {0, 1, 50}, within[] = {0, 1, 6};
    const uint32_t firsts[] = {0, 36, 72};
    mspring_area_def def;
    (void)state;
    check_ok(mspring_area_def_init(&def, sizeof def));
    def.stiffness = 10;
    check_error(mspring_network_add_area(network, &def, across, 3, NULL), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_add_area(network, &def, within, 3, NULL));
    check_ok(mspring_network_set_groups(network, NULL, 0));
    check_ok(mspring_network_add_area(network, &def, across, 3, NULL));
    check_error(mspring_network_set_groups(network, firsts, 2), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "area 1");
    mspring_network_destroy(network);
}

static void asks_for_a_network(void **state) {
    mspring_network *network = equal_robots();
    const uint32_t wrong[] = {0, 36, 36, 72}, far[] = {0, 36, MOST + 1}, cut[] = {0, 40};
    mspring_settings settings = support_settings(network);
    mspring_solver_def solver = support_solver(network);
    (void)state;
    check_error(mspring_network_set_groups(network, wrong, 3), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_groups(network, far, 2), MSPRING_ERROR_ID);
    check_error(mspring_network_set_groups(network, cut, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "spring 11");
    check_error(mspring_network_set_groups(network, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_reset_groups(network, &(uint32_t){ROBOTS}, 1, MSPRING_RESET_START),
                MSPRING_ERROR_ID);
    check_error(mspring_network_reset_groups(network, NULL, 0, (mspring_reset)2), MSPRING_ERROR_ARGUMENT);
    settings.guard = MSPRING_GUARD_GROWTH;
    check_error(mspring_network_set_settings(network, &settings), MSPRING_ERROR_ARGUMENT);
    solver.substeps = MSPRING_SUBSTEPS_AUTO;
    check_error(mspring_network_set_solver(network, &solver), MSPRING_ERROR_ARGUMENT);
    solver.substeps = 20, solver.solver = MSPRING_SOLVER_IMPLICIT;
    check_error(mspring_network_set_solver(network, &solver), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(mspring_network_group_count(network), ROBOTS);
    check_ok(mspring_network_set_groups(network, NULL, 0));
    assert_int_equal(mspring_network_group_count(network), 0);
    check_ok(mspring_network_set_settings(network, &settings));
    check_error(mspring_network_set_groups(network, far, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "MSPRING_GUARD_BOUNDS");
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(others_have_the_same_bits),
        cmocka_unit_test(all_may_go_wrong),
        cmocka_unit_test(held_where_it_was),
        cmocka_unit_test(particles_in_no_group_fail_the_step),
        cmocka_unit_test(resets_repeat_the_bits),
        cmocka_unit_test(loose_particles_repeat_the_bits),
        cmocka_unit_test(resets_take_back_all),
        cmocka_unit_test(origin_stays),
        cmocka_unit_test(observes),
        cmocka_unit_test(snapshots_and_clones_follow),
        cmocka_unit_test(layouts_follow),
        cmocka_unit_test(areas_stay_within),
        cmocka_unit_test(asks_for_a_network),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
