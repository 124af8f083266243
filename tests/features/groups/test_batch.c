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
    const mspring_id first = mspring_builder_count(b, MSPRING_PARTICLES);
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
            firsts[++groups] = mspring_builder_count(builder, MSPRING_PARTICLES);
        }
    mspring_network_def def = support_def(-9.8f, 20);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    def.settings.max_speed = 1000;
    def.simd_level = level;
    mspring_network *network = support_network(builder, &def);
    mspring_floor_def floor;
    const double plane[4] = {0, 0, 0, 1}; // a point, and the normal
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
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
    check_ok(mspring_network_get_integers(network, MSPRING_GROUP_FLAGS, NULL, group, 1, &flags, 1));
    return flags;
}

typedef struct state {
    double x[MOST], y[MOST];
    float vx[MOST], vy[MOST];
} state_of;

static void read_group(const mspring_network *network, uint32_t group, state_of *s) {
    const uint32_t first = group * SIDE * SIDE, count = SIDE * SIDE;
    check_ok(mspring_network_get_positions(network, NULL, first, count, s->x, s->y, 1));
    check_ok(mspring_network_get_velocities(network, NULL, first, count, s->vx, s->vy, 1));
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
    check_ok(mspring_network_get_view(all, &view));
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
    check_ok(mspring_network_reset_groups(network, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
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
    check_ok(mspring_network_set_velocities(network, NULL, kicked, 1, &fast, &fast, 1));
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
    check_ok(mspring_network_set_velocities(network, kicked, 0, 2, fast, fast, 1));
    const uint64_t hash = support_hash(network);
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    assert_true(support_hash(network) == hash);
    assert_int_equal(flags_of(network, 0), 0);
    check_ok(mspring_network_set_velocities(network, NULL, kicked[1], 1, &(float){0}, &(float){0}, 1));
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
    check_ok(mspring_network_mark_groups(network, &two[1], 0, 1));
    check_ok(mspring_network_break_springs(network, broken, 0, 3));
    support_steps(network, 30, DT);
    check_ok(mspring_network_reset_groups(network, MSPRING_RESET_START, &two[0], 0, 1));
    check_ok(mspring_network_reset_groups(network, MSPRING_RESET_MARK, &two[1], 0, 1));
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
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    mspring_network *network = support_network(builder, &def);
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
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
        check_ok(mspring_network_reset_groups(network, MSPRING_RESET_START, &(uint32_t){1}, 0, 1));
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
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_mark_groups(network, NULL, 0, MSPRING_ALL));
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, spring, 110, &yield, 0));
    support_steps(network, 60, DT);
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 1.0));
    check_ok(mspring_network_reset_groups(network, MSPRING_RESET_MARK, &group, 0, 1));
    check_ok(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, spring, 1, &flags, 1));
    assert_true(flags & MSPRING_SPRING_BROKEN);
    for (mspring_id s = spring; s < spring + 110; s++) {
        check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, s, 1, &strain, 1));
        check_near((double)strain, 0, 0);
    }
    check_ok(mspring_network_reset_groups(network, MSPRING_RESET_START, &group, 0, 1));
    check_ok(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, spring, 1, &flags, 1));
    assert_false(flags & MSPRING_SPRING_BROKEN);
    mspring_network_destroy(network);
}

// The origin does not follow, unless the host moves all.
static void origin_stays(void **state) {
    mspring_network *network = equal_robots();
    mspring_view view = {.struct_size = sizeof view};
    static double x[MOST], y[MOST];
    (void)state;
    check_ok(mspring_network_get_view(network, &view));
    const double origin = view.origin_x;
    check_ok(mspring_network_get_positions(network, NULL, 0, MOST, x, y, 1));
    for (int i = 0; i < MOST; i++)
        x[i] += 1000;
    check_ok(mspring_network_set_positions(network, (const mspring_id[]){0}, 0, 1, x, y, 1));
    check_ok(mspring_network_step(network, DT));
    check_ok(mspring_network_get_view(network, &view));
    check_near(view.origin_x, origin, 0);
    check_ok(mspring_network_set_positions(network, NULL, 0, MOST, x, y, 1));
    check_ok(mspring_network_reset_groups(network, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
    for (mspring_id p = 0; p < 36; p++)
        check_near(support_position(network, p).x, x[p] - 1000, 1e-12);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------------- observing */

static void observes(void **state) {
    enum { COLUMNS = 8 };
    static const mspring_observation columns[COLUMNS] = {
        {MSPRING_GROUP_X, 0},     {MSPRING_GROUP_VY, 0},     {MSPRING_GROUP_MIN_Y, 0}, {MSPRING_GROUP_MAX_Y, 0},
        {MSPRING_GROUP_FLAGS, 0}, {MSPRING_RELATIVE_X, 35}, {MSPRING_VY, 0},          {MSPRING_LENGTH, 3}};
    mspring_network *network = equal_robots();
    double rows[3][COLUMNS];
    (void)state;
    support_steps(network, 50, DT);
    check_ok(mspring_network_observe_groups(network, NULL, 5, 3, columns, COLUMNS, rows[0], COLUMNS));
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
        check_near(rows[g][0], x, 1e-12 * fabs(x) + 1e-13); // rounding of 36 sums
        check_near(rows[g][1], vy, 1e-12);
        check_near(rows[g][2], least, 0);
        check_near(rows[g][3], most, 0);
        check_near(rows[g][4], 0, 0);
        check_near(rows[g][5], s.x[35] - rows[g][0], 1e-12);
        check_near(rows[g][6], (double)s.vy[0], 0);
        support_spring_info spring;
        check_ok(support_get_spring(network, (5 + g) * (mspring_network_count(network, MSPRING_SPRINGS) / ROBOTS) + 3, &spring));
        check_near(rows[g][7], (double)spring.length, 0);
    }
    const mspring_observation lacking = {MSPRING_VY, 36}, none = {(mspring_property)0x3ff, 0};
    check_error(mspring_network_observe_groups(network, NULL, 5, 3, columns, COLUMNS, rows[0], COLUMNS - 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_observe_groups(network, NULL, 15, 2, columns, COLUMNS, rows[0], COLUMNS), MSPRING_ERROR_ID);
    check_error(mspring_network_observe_groups(network, NULL, 5, 3, &none, 1, rows[0], 1), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_observe_groups(network, NULL, 5, 1, &lacking, 1, rows[0], 1)); // bodies may differ
    check_near(rows[0][0], 0, 0);
    mspring_network_destroy(network);
}

// Columns of springs, elements and actuators count within the group, in the order of ids, whatever the order in which
// they were made; integers come as numbers; what was removed reads as 0.
static void observes_all_kinds(void **state) {
    enum { COLUMNS = 9, STRIDE = 10 };
    static const mspring_observation columns[COLUMNS] = {
        {MSPRING_SIGNAL, 0},    {MSPRING_SIGNAL, 1},        {MSPRING_ACTUATOR_SPRING, 0},
        {MSPRING_AREA, 0},      {MSPRING_ANGLE, 1},         {MSPRING_ELEMENT_FLAGS, 1},
        {MSPRING_END_A, 0},     {MSPRING_SPRING_FLAGS, 7},  {MSPRING_PARTICLE_FLAGS, 0}};
    (void)state;
    mspring_network *network = equal_robots();
    const mspring_id actuated[] = {5 * 110 + 2, 2 * 110 + 4, 5 * 110 + 1}, broken = 5 * 110 + 7, groups[] = {9, 5, 2, 0};
    const float signals[] = {0.9f, 1.1f, 1.2f};
    const mspring_area_def area = {.struct_size = sizeof area, .stiffness = 10, .fill = 1};
    const mspring_angle_def angle = mspring_angle_def_default();
    check_ok(mspring_network_set_groups(network, NULL, 0)); // nothing is added while there are groups
    for (uint32_t group = 5; group == 5 || group == 2; group -= 3) {
        const mspring_id p = 36 * group, corners[] = {p, p + 1, p + 7, p + 6}, bend[] = {p, p + 1, p + 8};
        check_ok(mspring_network_add_area(network, &area, corners, 4, NULL));
        check_ok(mspring_network_add_angles(network, &angle, bend, 1, 3, NULL));
    }
    uint32_t firsts[ROBOTS + 1];
    for (uint32_t i = 0; i <= ROBOTS; i++)
        firsts[i] = 36 * i;
    check_ok(mspring_network_set_groups(network, firsts, ROBOTS));
    check_ok(mspring_network_set_actuators(network, actuated, 3, 1));
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 3, signals, 1));
    check_ok(mspring_network_break_springs(network, &broken, 0, 1));
    double rows[2][STRIDE];
    rows[0][COLUMNS] = rows[1][COLUMNS] = 77;
    check_ok(mspring_network_observe_groups(network, groups, 1, 2, columns, COLUMNS, rows[0], STRIDE));
    const double expected[2][STRIDE] = {
        {signals[0], signals[2], actuated[0], 1, atan2(1, 1), MSPRING_ELEMENT_ANGLE, 180, MSPRING_SPRING_BROKEN, 0, 77},
        {signals[1], 0, actuated[1], 1, atan2(1, 1), MSPRING_ELEMENT_ANGLE, 72, 0, 0, 77}};
    for (int row = 0; row < 2; row++)
        for (int c = 0; c < STRIDE; c++)
            check_near(rows[row][c], expected[row][c], c < 2 || c == 3 || c == 4 ? 1e-6 : 0); // floats
    check_ok(mspring_network_remove_elements(network, NULL, 1, 1)); // the angle of group 5
    check_ok(mspring_network_observe_groups(network, groups, 1, 1, columns, COLUMNS, rows[0], STRIDE));
    check_near(rows[0][4], 0, 0);
    check_ok(mspring_network_observe_groups(network, groups, 3, 1, columns, COLUMNS, rows[0], STRIDE)); // has none
    check_near(rows[0][0] + rows[0][3] + rows[0][5], 0, 0);
    mspring_network_destroy(network);
}

static void removed_springs_keep_their_index(void **state) {
    enum { COLUMNS = 5 };
    static const mspring_observation columns[COLUMNS] = {{MSPRING_ACTUATOR_SPRING, 0},
                                                         {MSPRING_ACTUATOR_SPRING, 1},
                                                         {MSPRING_ACTUATOR_SPRING, 2},
                                                         {MSPRING_END_A, 2},
                                                         {MSPRING_END_A, 4}};
    static const mspring_id actuated[] = {7, 112, 113, 117, 2}, removed[] = {112, 113};
    double before[COLUMNS], after[COLUMNS];
    (void)state;
    mspring_network *network = equal_robots();
    check_ok(mspring_network_set_actuators(network, actuated, 5, 1));
    check_ok(mspring_network_observe_groups(network, NULL, 1, 1, columns, COLUMNS, before, COLUMNS));
    check_ok(mspring_network_remove_springs(network, removed, 0, 2));
    check_ok(mspring_network_observe_groups(network, NULL, 1, 1, columns, COLUMNS, after, COLUMNS));
    before[3] = 0;
    assert_memory_equal(before, after, sizeof after);
    mspring_network_destroy(network);
}

static void bad_observations_are_refused(void **state) {
    (void)state;
    mspring_network *network = equal_robots();
    const mspring_observation good[] = {{MSPRING_X, 0}, {MSPRING_GROUP_X, 0}}, none[] = {{MSPRING_X, 0}, {(mspring_property)0x3ff, 0}},
                              indexed[] = {{MSPRING_X, 0}, {MSPRING_GROUP_X, 1}};
    const mspring_id list[] = {0, 3, ROBOTS, 1};
    double rows[8] = {0};
    check_ok(mspring_network_observe_groups(network, list, 0, 2, good, 2, rows, 2));
    check_error(mspring_network_observe_groups(network, list, 0, 3, good, 2, rows, 2), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "index 2");
    check_contains(mspring_network_error(network), "group 16");
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT); // another message may come now
    check_error(mspring_network_observe_groups(network, list, 0, 2, none, 2, rows, 2), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_step(network, DT));
    check_error(mspring_network_observe_groups(network, list, 0, 2, none, 2, rows, 2), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "column 1");
    check_ok(mspring_network_step(network, DT));
    check_error(mspring_network_observe_groups(network, list, 0, 2, indexed, 2, rows, 2), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "column 1");
    check_error(mspring_network_observe_groups(network, NULL, 0, MSPRING_ALL, good, 2, rows, 2), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_observe_groups(network, NULL, 0, 1, NULL, 2, rows, 2), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_observe_groups(network, NULL, 0, 1, good, 2, NULL, 2), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_observe_groups(NULL, NULL, 0, 1, good, 2, rows, 2), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_observe_groups(network, NULL, 0, 0, good, 2, NULL, 2));
    check_error(mspring_network_mark_groups(network, list, 0, 3), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "index 2");
    check_error(mspring_network_reset_groups(network, MSPRING_RESET_MARK, list, 2, 2), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "group 16");
    check_error(mspring_network_mark_groups(network, list, 0, MSPRING_ALL), MSPRING_ERROR_ARGUMENT);
    float x;
    check_error(mspring_network_get(network, MSPRING_GROUP_FLAGS, NULL, 0, 1, &x, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_GROUP_X, NULL, 0, 1, &(float){1}, 1), MSPRING_ERROR_ARGUMENT);
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
    check_ok(mspring_network_set_velocities(network, NULL, 70, 1, &fast, &fast, 1));
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 2, signals, 1));
    support_steps(network, 3, DT);
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 1, 1, signals, 1)); // pending
    check_ok(mspring_network_clone(network, NULL, &clone));
    support_bring(network, other, MSPRING_SNAPSHOT_FRAME);
    assert_int_equal(flags_of(other, 1), MSPRING_GROUP_HELD);
    support_steps(network, 20, DT);
    support_steps(other, 20, DT);
    support_steps(clone, 20, DT);
    assert_true(support_hash(network) == support_hash(other) && support_hash(network) == support_hash(clone));
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_reset_groups(other, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
    check_ok(mspring_network_reset_groups(network, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
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
        check_ok(mspring_network_break_springs(both[i], broken, 0, 3));
        check_ok(mspring_network_set_velocities(both[i], NULL, 70, 1, &fast, &fast, 1));
        support_steps(both[i], 3, DT);
        if (i == 0)
            check_ok(mspring_network_compact(both[i]));
        check_ok(mspring_network_set(both[i], MSPRING_SIGNAL, NULL, 0, 2, &signal, 0));
        support_steps(both[i], 20, DT);
    }
    assert_true(support_hash(network) == support_hash(other));
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_reset_groups(both[i], MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
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
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def));
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
    mspring_settings solver = support_solver(network);
    (void)state;
    check_error(mspring_network_set_groups(network, wrong, 3), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_groups(network, far, 2), MSPRING_ERROR_ID);
    check_error(mspring_network_set_groups(network, cut, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "spring 11");
    check_error(mspring_network_set_groups(network, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_groups(network, wrong, MOST + 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "577 groups are more than 576 particles");
    check_error(mspring_network_reset_groups(network, MSPRING_RESET_START, &(uint32_t){ROBOTS}, 0, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_reset_groups(network, (mspring_reset)2, NULL, 0, MSPRING_ALL), MSPRING_ERROR_ARGUMENT);
    settings.sleep_speed = 0.1f;
    check_error(mspring_network_set_settings(network, &settings), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "sleep_speed 0");
    settings.sleep_speed = 0;
    settings.guard = MSPRING_GUARD_GROWTH;
    check_error(mspring_network_set_settings(network, &settings), MSPRING_ERROR_ARGUMENT);
    solver.substeps = MSPRING_SUBSTEPS_AUTO;
    check_error(support_set_solver(network, &solver), MSPRING_ERROR_ARGUMENT);
    solver.substeps = 20, solver.solver = MSPRING_SOLVER_IMPLICIT;
    check_error(support_set_solver(network, &solver), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(mspring_network_count(network, MSPRING_GROUPS), ROBOTS);
    check_ok(mspring_network_set_groups(network, NULL, 0));
    assert_int_equal(mspring_network_count(network, MSPRING_GROUPS), 0);
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
        cmocka_unit_test(observes_all_kinds),
        cmocka_unit_test(removed_springs_keep_their_index),
        cmocka_unit_test(bad_observations_are_refused),
        cmocka_unit_test(snapshots_and_clones_follow),
        cmocka_unit_test(layouts_follow),
        cmocka_unit_test(areas_stay_within),
        cmocka_unit_test(asks_for_a_network),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
