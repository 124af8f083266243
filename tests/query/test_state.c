/// @file test_state.c
/// Reading and writing the state: views, ranges in id order, the local origin.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "snapshots.h"
#include "support.h"

/// A network with rows of every kind and empty slots between: a lattice with holes, a rope, loose particles.
static int make_network(void **state) {
    uint64_t seed = 11;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}, .pinned = 0.1, .holes = 0.3};
    recipe made = {0};
    recipe_lattice(&made, 20, 7, 0, 0, 1, &stuff, &seed);
    mspring_id end = recipe_particle(&made, 40, 20, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 0, end, 12, &stuff, &seed);
    for (int i = 0; i < 5; i++) {
        recipe_particle(&made, 50 + i, 3, 1, 0);
    }
    recipe_random_springs(&made, 10, &stuff, &seed);
    recipe_shuffle(&made, &seed, NULL);
    mspring_network_def def = support_def(-9.8f, 2);
    *state = recipe_network(&made, &def);
    recipe_free(&made);
    return 0;
}

static int free_network(void **state) {
    mspring_network_destroy(*state);
    return 0;
}

/* --------------------------------------------------------------------------------------------------- views */

static void slots_and_ids_are_inverse_maps(void **state) {
    mspring_network *network = *state;
    mspring_view view = {.struct_size = sizeof view};
    support_plan plan;
    check_ok(mspring_network_get_view(network, &view));
    check_ok(support_get_plan(network, &plan));
    assert_int_equal(view.particle_count, mspring_network_count(network, MSPRING_PARTICLES));
    assert_int_equal(view.slot_count, plan.slot_count);
    assert_int_equal(view.reserved, 0);
    for (mspring_id id = 0; id < view.particle_count; id++) {
        assert_true(view.slot_of_particle[id] < view.slot_count);
        assert_int_equal(view.particle_of_slot[view.slot_of_particle[id]], id);
    }
    uint32_t taken = 0;
    for (uint32_t slot = 0; slot < view.slot_count; slot++) {
        mspring_id id = view.particle_of_slot[slot];
        if (id == MSPRING_NONE) {
            assert_true(view.inverse_mass[slot] == 0);
        } else {
            assert_int_equal(view.slot_of_particle[id], slot);
            taken++;
        }
    }
    assert_int_equal(taken, view.particle_count);
    assert_true(taken < view.slot_count); // there are holes: the network of this test is meant to have some
}

static void views_show_the_state_and_follow_the_steps(void **state) {
    mspring_network *network = *state;
    mspring_view before = {.struct_size = sizeof before}, after = {.struct_size = sizeof after};
    check_ok(mspring_network_get_view(network, &before));
    support_steps(network, 30, 0.01);
    check_ok(mspring_network_get_view(network, &after));
    assert_ptr_equal(before.x, after.x);
    assert_ptr_equal(before.y, after.y);
    assert_ptr_equal(before.vx, after.vx);
    assert_ptr_equal(before.vy, after.vy);
    assert_ptr_equal(before.inverse_mass, after.inverse_mass);
    assert_ptr_equal(before.slot_of_particle, after.slot_of_particle);
    assert_ptr_equal(before.particle_of_slot, after.particle_of_slot);
    float mass;
    for (mspring_id id = 0; id < after.particle_count; id++) {
        uint32_t slot = after.slot_of_particle[id];
        support_point p = support_position(network, id), v = support_velocity(network, id);
        assert_true((float)(p.x - after.origin_x) == after.x[slot]);
        assert_true((float)(p.y - after.origin_y) == after.y[slot]);
        assert_true(v.x == (double)after.vx[slot] && v.y == (double)after.vy[slot]);
        check_ok(mspring_network_get(network, MSPRING_MASS, NULL, id, 1, &mass, 1));
        assert_true(after.inverse_mass[slot] == 0 || after.inverse_mass[slot] == 1.0f / mass);
        assert_true(mass >= 1 && mass <= 2); // the pinned ones have theirs, too
    }
}

/// Where a host keeps something by slot, it looks at two numbers to see whether that is still right.
static void views_count_layouts_and_origins(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < 4; i++) {
        support_particle(builder, i, 0, 1);
    }
    mspring_network_def def = support_def(0, 1);
    def.spare_particles = 2;
    mspring_network *network = support_network(builder, &def);
    mspring_view first = {.struct_size = sizeof first}, next = first;
    check_ok(mspring_network_get_view(network, &first));
    support_steps(network, 3, 0.01);
    check_ok(mspring_network_get_view(network, &next));
    assert_int_equal(next.layout_generation, first.layout_generation);
    assert_int_equal(next.origin_generation, first.origin_generation);

    mspring_particle_def added;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &added, sizeof added));
    check_ok(mspring_network_add_particles(network, &added, 1, &id));
    check_ok(mspring_network_get_view(network, &first));
    assert_int_not_equal(next.layout_generation, first.layout_generation);
    check_ok(mspring_network_remove_particles(network, &id, 0, 1));
    check_ok(mspring_network_get_view(network, &next));
    assert_int_not_equal(next.layout_generation, first.layout_generation);
    assert_int_equal(next.origin_generation, first.origin_generation);

    saved before = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    for (mspring_id p = 0; p < 4; p++) {
        support_kick(network, p, 1000);
    }
    support_steps(network, 10, 0.1);
    check_ok(mspring_network_get_view(network, &next));
    assert_true(next.origin_x > 100);
    assert_int_not_equal(next.origin_generation, first.origin_generation);
    check_ok(mspring_network_load(network, before.bytes, before.size));
    check_ok(mspring_network_get_view(network, &first));
    assert_true(first.origin_x < 100);
    assert_int_not_equal(next.origin_generation, first.origin_generation);
    free(before.bytes);
    mspring_network_destroy(network);
}

static void bad_views_are_refused(void **state) {
    mspring_network *network = *state;
    mspring_view view, before;
    memset(&view, 0x5a, sizeof view);
    view.struct_size = sizeof view + 2;
    before = view;
    check_error(mspring_network_get_view(network, &view), MSPRING_ERROR_STRUCT);
    assert_memory_equal(&view, &before, sizeof view);
    view.struct_size = 0;
    check_error(mspring_network_get_view(network, &view), MSPRING_ERROR_STRUCT);
    check_error(mspring_network_get_view(network, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_view(NULL, &view), MSPRING_ERROR_ARGUMENT);
}

/* -------------------------------------------------------------------------------------------------- ranges */

enum { MANY = 200 };

static void ranges_read_and_write_in_id_order(void **state) {
    mspring_network *network = *state;
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    double x[MANY], y[MANY], x2[MANY], y2[MANY];
    float fx[MANY], fy[MANY], vx[MANY], vy[MANY];
    assert_true(count <= MANY);
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
    check_ok(mspring_network_get_columns(network, NULL, 0, count,
                                         (const mspring_column[]){{MSPRING_X, 1, fx}, {MSPRING_Y, 1, fy}}, 2));
    for (uint32_t i = 0; i < count; i++) {
        support_point one = support_position(network, i);
        assert_true(one.x == x[i] && one.y == y[i] && fx[i] == (float)x[i] && fy[i] == (float)y[i]);
    }

    // A part: ids 5 to 14, values that a float has exactly.
    for (int i = 0; i < 10; i++) {
        x[5 + i] = 0.25 * i;
        y[5 + i] = 0.5 * (i - 20);
        vx[i] = (float)i;
        vy[i] = (float)-i;
    }
    check_ok(mspring_network_set_positions(network, NULL, 5, 10, x + 5, y + 5, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 5, 10, vx, vy, 1));
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x2, y2, 1));
    assert_memory_equal(x, x2, count * sizeof *x);
    assert_memory_equal(y, y2, count * sizeof *y);
    for (mspring_id id = 5; id < 15; id++) {
        assert_true(support_velocity(network, id).x == id - 5 &&
                    support_velocity(network, id).y == -(double)(id - 5));
    }
    assert_true(support_velocity(network, 15).x == 0);

    // Of nobody.
    check_ok(mspring_network_get_positions(network, NULL, count, 0, x2, y2, 1));
    check_ok(mspring_network_set_positions(network, NULL, count, 0, x2, y2, 1));
}

static void ranges_that_leave_the_network_are_refused(void **state) {
    mspring_network *network = *state;
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    const struct {
        mspring_id first;
        uint32_t count;
    } bad[] = {{count, 1}, {0, count + 1}, {count - 1, 2}, {count + 1, 0}, {UINT32_MAX, 2}, {2, UINT32_MAX - 1}};
    double x[2] = {7, 7}, y[2] = {7, 7};
    float fx[2] = {7, 7}, fy[2] = {7, 7};
    const uint64_t hash = support_hash(network);
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        mspring_id first = bad[i].first;
        uint32_t n = bad[i].count;
        check_error(mspring_network_get_positions(network, NULL, first, n, x, y, 1), MSPRING_ERROR_ID);
        check_error(mspring_network_get_columns(network, NULL, first, n,
                                                (const mspring_column[]){{MSPRING_X, 1, fx}, {MSPRING_Y, 1, fy}},
                                                2),
                    MSPRING_ERROR_ID);
        check_error(mspring_network_get_velocities(network, NULL, first, n, fx, fy, 1), MSPRING_ERROR_ID);
        check_error(mspring_network_get(network, MSPRING_MASS, NULL, first, n, fx, 1), MSPRING_ERROR_ID);
        check_error(mspring_network_set_positions(network, NULL, first, n, x, y, 1), MSPRING_ERROR_ID);
        check_error(mspring_network_set_velocities(network, NULL, first, n, fx, fy, 1), MSPRING_ERROR_ID);
        check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, first, n, fx, fy, 1),
                    MSPRING_ERROR_ID);
    }
    check_error(mspring_network_apply_force(network, count, 1, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_apply_force(network, MSPRING_NONE, 1, 1), MSPRING_ERROR_ID);
    assert_true(x[0] == 7 && y[0] == 7 && fx[0] == 7 && fy[0] == 7);
    assert_int_equal(support_hash(network), hash);
}

static void null_arrays_are_refused(void **state) {
    mspring_network *network = *state;
    double d[2] = {0, 0};
    float f[2] = {0, 0};
    const uint64_t hash = support_hash(network);
    check_error(mspring_network_get_positions(network, NULL, 0, 2, NULL, d, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_positions(network, NULL, 0, 2, d, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_columns(network, NULL, 0, 2,
                                            (const mspring_column[]){{MSPRING_X, 1, NULL}, {MSPRING_Y, 1, f}}, 2),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_velocities(network, NULL, 0, 2, f, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get(network, MSPRING_MASS, NULL, 0, 2, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_positions(network, NULL, 0, 2, NULL, d, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_velocities(network, NULL, 0, 2, NULL, f, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, 2, NULL, f, 1),
                MSPRING_ERROR_ARGUMENT);

    check_error(mspring_network_get_positions(NULL, NULL, 0, 1, d, d, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_columns(NULL, NULL, 0, 1,
                                            (const mspring_column[]){{MSPRING_X, 1, f}, {MSPRING_Y, 1, f}}, 2),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_velocities(NULL, NULL, 0, 1, f, f, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get(NULL, MSPRING_MASS, NULL, 0, 1, f, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_positions(NULL, NULL, 0, 1, d, d, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_velocities(NULL, NULL, 0, 1, f, f, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_forces(NULL, MSPRING_PUSH_STEP, NULL, 0, 1, f, f, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_apply_force(NULL, 0, 1, 1), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(support_hash(network), hash);
}

static void writes_are_all_or_nothing_and_name_the_particle(void **state) {
    mspring_network *network = *state;
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    const double bad[] = {NAN, INFINITY, -INFINITY, 1.001e12, -1.001e12};
    double x[MANY], y[MANY];
    float fx[MANY], fy[MANY];
    const uint64_t hash = support_hash(network);
    for (uint32_t i = 0; i < count; i++) {
        x[i] = y[i] = i;
        fx[i] = fy[i] = (float)i;
    }
    fx[97] = 1.001e15f; // too fast
    check_error(mspring_network_set_velocities(network, NULL, 0, count, fx, fy, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "97");
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        x[97] = bad[i];
        fx[97] = (float)bad[i];
        check_error(mspring_network_set_positions(network, NULL, 0, count, x, y, 1), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "97");
        check_error(mspring_network_set_positions(network, NULL, 0, count, y, x, 1), MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_set_positions(network, NULL, 0, 100, x, y, 1), MSPRING_ERROR_ARGUMENT);
        if (!isfinite(bad[i])) {
            check_error(mspring_network_set_velocities(network, NULL, 0, count, fx, fy, 1), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), "97");
            check_error(mspring_network_set_velocities(network, NULL, 0, count, fy, fx, 1), MSPRING_ERROR_ARGUMENT);
            check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, count, fx, fy, 1),
                        MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), "97");
            check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, count, fy, fx, 1),
                        MSPRING_ERROR_ARGUMENT);
            check_error(mspring_network_apply_force(network, 97, fx[97], 0), MSPRING_ERROR_ARGUMENT);
            check_error(mspring_network_apply_force(network, 97, 0, fx[97]), MSPRING_ERROR_ARGUMENT);
        }
        assert_int_equal(support_hash(network), hash);
    }
    // None of the refused forces is there: the network moves as an untouched one.
    void *other = NULL;
    make_network(&other);
    support_steps(network, 5, 0.01);
    support_steps(other, 5, 0.01);
    assert_int_equal(support_hash(network), support_hash(other));
    free_network(&other);
}

/* ------------------------------------------------------------------------------------------------- origin */

static void setting_all_positions_moves_the_origin(void **state) {
    mspring_network *network = *state;
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    double x[MANY], y[MANY];
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
    for (uint32_t i = 0; i < count; i++) {
        x[i] += 123456789.3;
        y[i] -= 987654321.7;
    }
    check_ok(mspring_network_set_positions(network, NULL, 0, count, x, y, 1));
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    for (uint32_t i = 0; i < count; i++) {
        support_point p = support_position(network, i);
        // Within half an ulp of local coordinates up to 64 m (2^-19 m); in world coordinates it would be 32 m.
        check_near(p.x, x[i], 2e-6);
        check_near(p.y, y[i], 2e-6);
    }

    // Points side by side are at the same places from the same origin, and all at one place if that is what is given.
    double points[MANY][2];
    for (uint32_t i = 0; i < count; i++) {
        points[i][0] = x[i];
        points[i][1] = y[i];
    }
    const uint64_t hash = support_hash(network);
    check_ok(mspring_network_set_positions(network, NULL, 0, count, &x[0], &x[0], 0));
    assert_true(support_position(network, count - 1).x == x[0] && support_position(network, 0).y == x[0]);
    check_ok(mspring_network_set_positions(network, NULL, 0, count, points[0], points[0] + 1, 2));
    assert_int_equal(support_hash(network), hash);

    // A part of them leaves the origin where it is, also when it goes far away.
    const double far_x[] = {x[3] + 1e6}, far_y[] = {y[3]};
    mspring_view again = {.struct_size = sizeof again};
    check_ok(mspring_network_set_positions(network, NULL, 3, 1, far_x, far_y, 1));
    check_ok(mspring_network_get_view(network, &again));
    assert_true(view.origin_x == again.origin_x && view.origin_y == again.origin_y);
    check_near(support_position(network, 3).x, far_x[0], 0.04); // half an ulp of 1e6 is 1/32
}

static void parts_may_not_go_too_far_from_the_origin(void **state) {
    mspring_network *network = *state;
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    double x[MANY], y[MANY];
    for (uint32_t i = 0; i < count; i++) {
        x[i] = -9e11 + i;
        y[i] = i;
    }
    check_ok(mspring_network_set_positions(network, NULL, 0, count, x, y, 1));
    const uint64_t hash = support_hash(network);
    const double opposite = 9e11, zero = 0; // within the world's bounds, but 1.8e12 m from the origin
    check_error(mspring_network_set_positions(network, NULL, 4, 1, &opposite, &zero, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "4");
    assert_int_equal(support_hash(network), hash);
}

/// What is at a limit is allowed, and what is beyond it by a last place is not: from the world's origin, and from the
/// local one, which is where all were set.
static void limits_themselves_are_allowed(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    support_particle(builder, 0, 0, 1);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    for (int i = 0; i < 16; i++) {
        const double sign = i & 1 ? 1 : -1, centre[2] = {i & 4 ? -0x1p38 * sign : 0, i & 8 ? 0x1p38 : 0};
        const int which = i / 2 % 2; // x or y
        const double largest = fabs(centre[which]) > 0 && centre[which] * sign < 0 ? 1e12 + centre[which] * sign : 1e12;
        double at[2] = {centre[0], centre[1]};
        check_ok(mspring_network_set_positions(network, NULL, 0, 2, &centre[0], &centre[1], 0));
        at[which] = sign * largest;
        check_ok(mspring_network_set_positions(network, NULL, 1, 1, &at[0], &at[1], 1));
        at[which] = sign * nextafter(largest, INFINITY);
        check_error(mspring_network_set_positions(network, NULL, 1, 1, &at[0], &at[1], 1), MSPRING_ERROR_ARGUMENT);
        at[which] = sign * 1e12;
        check_ok(mspring_network_set_positions(network, NULL, 0, 2, &at[0], &at[1], 0));
        at[which] = sign * nextafter(1e12, INFINITY);
        check_error(mspring_network_set_positions(network, NULL, 0, 2, &at[0], &at[1], 0), MSPRING_ERROR_ARGUMENT);
        float v[2] = {0, 0};
        v[which] = (float)(sign * MSPRING_MAX_SPEED);
        check_ok(mspring_network_set_velocities(network, NULL, 1, 1, &v[0], &v[1], 1));
        v[which] = nextafterf(v[which], (float)sign * INFINITY);
        check_error(mspring_network_set_velocities(network, NULL, 1, 1, &v[0], &v[1], 1), MSPRING_ERROR_ARGUMENT);
    }
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------ strides and impulses */

/// Points {x, y} side by side, fields of structs, and one value for all.
static void arrays_may_have_strides(void **state) {
    mspring_network *network = *state;
    const uint32_t count = 9;
    double x[9], y[9], points[9][3];
    float vx[9], vy[9], arrows[9][2], near_points[9][2];
    memset(points, 0, sizeof points);
    check_ok(mspring_network_get_positions(network, NULL, 2, count, x, y, 1));
    check_ok(mspring_network_get_positions(network, NULL, 2, count, &points[0][0], &points[0][2], 3));
    check_ok(mspring_network_get_columns(
        network, NULL, 2, count,
        (const mspring_column[]){{MSPRING_X, 2, &near_points[0][0]}, {MSPRING_Y, 2, &near_points[0][1]}}, 2));
    check_ok(mspring_network_get_velocities(network, NULL, 2, count, vx, vy, 1));
    check_ok(mspring_network_get_velocities(network, NULL, 2, count, &arrows[0][0], &arrows[0][1], 2));
    for (uint32_t i = 0; i < count; i++) {
        assert_true(points[i][0] == x[i] && points[i][1] == 0 && points[i][2] == y[i]);
        assert_true(near_points[i][0] == (float)x[i] && near_points[i][1] == (float)y[i]);
        assert_true(arrows[i][0] == vx[i] && arrows[i][1] == vy[i]);
        points[i][0] += 0.25;
        near_points[i][1] = 0.5f * (float)i;
        arrows[i][1] = (float)i;
    }
    check_ok(mspring_network_set_positions(network, NULL, 2, count, &points[0][0], &points[0][2], 3));
    check_ok(mspring_network_set_velocities(network, NULL, 2, count, &arrows[0][0], &arrows[0][1], 2));
    for (uint32_t i = 0; i < count; i++) {
        check_near(support_position(network, 2 + i).x, x[i] + 0.25, 1e-6);
        assert_true(support_velocity(network, 2 + i).y == i);
    }
    const mspring_id list[] = {5, 3};
    const double two[][2] = {{(double)near_points[0][0], (double)near_points[0][1]},
                             {(double)near_points[1][0], (double)near_points[1][1]}};
    check_ok(mspring_network_set_positions(network, list, 0, 2, &two[0][0], &two[0][1], 2));
    check_near(support_position(network, 3).y, 0.5, 1e-6);
    check_near(support_position(network, 5).x, x[0], 1e-6);
    const float still = 0, force = 2;
    check_ok(mspring_network_set_velocities(network, list, 0, 2, &still, &still, 0));
    assert_true(support_velocity(network, 5).y == 0 && support_velocity(network, 3).y == 0);
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, count, &force, &still, 0));

    // What is read into one element is a mistake.
    check_error(mspring_network_get_positions(network, NULL, 0, 2, x, y, 0), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_velocities(network, NULL, 0, 2, vx, vy, 0), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_columns(network, NULL, 0, 2,
                                            (const mspring_column[]){{MSPRING_X, 0, vx}, {MSPRING_Y, 0, vy}}, 2),
                MSPRING_ERROR_ARGUMENT);
}

/// Three particles: of 2 kg, of 4 kg that gives in by half, and a pinned one.
static mspring_network *three_particles(void) {
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 2);
    support_particle(builder, 1, 0, 4);
    support_particle(builder, 2, 0, 1);
    mspring_network_def def = support_def(0, 1);
    def.settings.sleep_speed = 0.1f;
    def.settings.sleep_time = 0;
    mspring_network *network = support_network(builder, &def);
    const float scales[] = {1, 0.5f, 0};
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, 3, scales, 1));
    return network;
}

static void impulses_change_velocities_at_once(void **state) {
    (void)state;
    mspring_network *network = three_particles();
    support_steps(network, 2, 0.01);
    assert_int_equal(support_is_asleep(network), 1);
    const float x[] = {1, 8, 3}, y[] = {-2, 0, 3};
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, NULL, 0, 3, x, y, 1));
    assert_true(support_velocity(network, 0).x == 0.5 && support_velocity(network, 0).y == -1);
    assert_true(support_velocity(network, 1).x == 1 && support_velocity(network, 1).y == 0);
    assert_true(support_velocity(network, 2).x == 0 && support_velocity(network, 2).y == 0);
    support_steps(network, 1, 0.5);
    assert_int_equal(support_is_asleep(network), 0);
    check_near(support_position(network, 0).x, 0.25, 1e-6);
    // They add up, within a list as well, and act once.
    const mspring_id list[] = {0, 1, 0};
    const float pairs[] = {1, 0, 4, 4, 1, 2};
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, list, 0, 3, pairs, pairs + 1, 2));
    assert_true(support_velocity(network, 0).x == 1.5 && support_velocity(network, 0).y == 0);
    assert_true(support_velocity(network, 1).x == 1.5 && support_velocity(network, 1).y == 0.5);
    mspring_network_destroy(network);
}

static void bad_impulses_change_nothing(void **state) {
    (void)state;
    mspring_network *network = three_particles();
    support_steps(network, 1, 0.01); // the length of the last substep is part of the state
    const uint64_t before = support_hash(network);
    const float bad[][3] = {{1, NAN, 1}, {1, 1, INFINITY}, {1, 8.1e15f, 1}, {2.1e15f, 1, 1}};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        check_error(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, NULL, 0, 3, bad[i], bad[i], 1),
                    MSPRING_ERROR_ARGUMENT);
        assert_int_equal(support_hash(network), before);
    }
    // Two that are right alone, and not together.
    const mspring_id list[] = {1, 0, 0};
    const float large[] = {1, 1.5e15f, 1.5e15f};
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, list, 0, 3, large, large, 1),
                MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "particle 0");
    assert_int_equal(support_hash(network), before);
    const float forces[] = {1, 3e38f, 3e38f};
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, list, 0, 3, forces, forces, 1),
                MSPRING_ERROR_ARGUMENT);
    support_steps(network, 1, 0.01);
    assert_int_equal(support_hash(network), before);
    const mspring_id nobody = 3;
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, NULL, 1, 3, large, large, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, &nobody, 0, 1, large, large, 1),
                MSPRING_ERROR_ID);
    mspring_network_destroy(network);
}

/// Ranges as lists; large forces after small ones and before them; what would overflow is refused, and changes
/// nothing.
static void forces_of_ranges_add_up(void **state) {
    (void)state;
    const mspring_id list[] = {0, 1, 2};
    const float small[] = {1e3f, -2e3f, 3e3f, 500, 1, -7e3f, 2e3f, 8e3f, -9e3f},
                large[] = {3e38f, 1, 3e38f, 2, -3e38f, 0, 1, 1, 1};
    for (uint32_t stride = 1; stride <= 3; stride++) {
        const uint32_t to_y = stride == 1 ? 3 : 1;
        mspring_network *networks[] = {three_particles(), three_particles()};
        for (int i = 0; i < 2; i++) {
            for (uint32_t value = 0; value < 6; value++) {
                float bad[9];
                memcpy(bad, small, sizeof bad);
                bad[value % 3 * stride + (value < 3 ? 0 : to_y)] = NAN;
                check_error(mspring_network_apply_forces(networks[i], MSPRING_PUSH_STEP, NULL, 0, 3, bad, bad + to_y,
                                                         stride),
                            MSPRING_ERROR_ARGUMENT);
            }
            for (int call = 0; call < 4; call++) {
                const float *const given = call == 2 ? large : small;
                check_ok(i == 0 ? mspring_network_apply_forces(networks[i], MSPRING_PUSH_STEP, NULL, 0, 3, given,
                                                               given + to_y, stride)
                                : mspring_network_apply_forces(networks[i], MSPRING_PUSH_STEP, list, 0, 3, given,
                                                               given + to_y, stride));
            }
            check_error(mspring_network_apply_forces(networks[i], MSPRING_PUSH_STEP, NULL, 0, 3, large,
                                                     large + to_y, stride),
                        MSPRING_ERROR_ARGUMENT);
            float back[9];
            for (int value = 0; value < 9; value++) {
                back[value] = -large[value];
            }
            check_ok(mspring_network_apply_forces(networks[i], MSPRING_PUSH_STEP, NULL, 0, 3, back, back + to_y,
                                                  stride));
            support_steps(networks[i], 1, 0.01);
            check_ok(mspring_network_apply_forces(networks[i], MSPRING_PUSH_STEP, NULL, 0, 3, small, small + to_y,
                                                  stride));
            support_steps(networks[i], 1, 0.01);
        }
        assert_int_equal(support_hash(networks[0]), support_hash(networks[1]));
        assert_true(fabs(support_velocity(networks[0], 0).y) + fabs(support_velocity(networks[0], 1).x) > 0.1);
        mspring_network_destroy(networks[0]);
        mspring_network_destroy(networks[1]);
    }
}

// Ranges leave out what was removed: it reads as 0, and what is written there is no value.
static void removed_particles_read_as_nothing(void **state) {
    mspring_network *network = *state;
    double x[3] = {77, 77, 77}, y[3] = {77, 77, 77};
    float vx[3] = {77, 77, 77}, vy[3] = {77, 77, 77};
    check_ok(mspring_network_remove_particles(network, NULL, 1, 1));
    check_ok(mspring_network_get_positions(network, NULL, 0, 3, x, y, 1));
    check_ok(mspring_network_get_velocities(network, NULL, 0, 3, vx, vy, 1));
    assert_true(x[1] == 0 && y[1] == 0 && vx[1] == 0 && vy[1] == 0);
    x[1] = (double)NAN;
    vy[1] = INFINITY;
    check_ok(mspring_network_set_positions(network, NULL, 0, 3, x, y, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 3, vx, vy, 1));
}

int main(void) {
#define STATE_TEST(test) cmocka_unit_test_setup_teardown(test, make_network, free_network)
    const struct CMUnitTest tests[] = {
        STATE_TEST(slots_and_ids_are_inverse_maps),
        STATE_TEST(views_show_the_state_and_follow_the_steps),
        cmocka_unit_test(views_count_layouts_and_origins),
        STATE_TEST(bad_views_are_refused),
        STATE_TEST(arrays_may_have_strides),
        cmocka_unit_test(limits_themselves_are_allowed),
        cmocka_unit_test(impulses_change_velocities_at_once),
        cmocka_unit_test(bad_impulses_change_nothing),
        cmocka_unit_test(forces_of_ranges_add_up),
        STATE_TEST(ranges_read_and_write_in_id_order),
        STATE_TEST(ranges_that_leave_the_network_are_refused),
        STATE_TEST(null_arrays_are_refused),
        STATE_TEST(writes_are_all_or_nothing_and_name_the_particle),
        STATE_TEST(setting_all_positions_moves_the_origin),
        STATE_TEST(parts_may_not_go_too_far_from_the_origin),
        STATE_TEST(removed_particles_read_as_nothing),
    };
    return cmocka_run_group_tests_name("state", tests, NULL, NULL);
}
