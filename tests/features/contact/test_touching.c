/// @file test_touching.c
/// What goes along with contact: same bits wherever nothing touches, at every level and with any workers, after
/// loading, in clones; outlines that follow breaks, additions and compaction; groups; and what is refused.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "allocator.h"
#include "bodies.h"
#include "snapshots.h"

#define THICKNESS 0.5
#define DT (1.0 / 64)
#define SUBSTEPS 30

/// Two blocks, a rope and a loose particle that meet after some 20 steps, above the ground.
static bodies *crowd(double apart, double speed) {
    bodies *b = bodies_begin(DT / SUBSTEPS);
    const bodies_lattice block = {
        .width = 20, .height = 6, .x = -apart, .y = 0.3, .angle = 0.2, .spacing = 1, .mass = 20, .f = 0.3};
    bodies_lattice other = block, rope = block, ball = block, ground = block;
    other.x = apart, other.angle = -0.3, other.width = 9, other.mass = 7;
    rope.x = 0, rope.y = apart, rope.width = 15, rope.height = 1;
    ball.x = 0, ball.y = -apart, ball.width = ball.height = 1;
    ground.x = ground.angle = ground.mass = 0, ground.y = -apart - 2, ground.width = 60, ground.height = 1;
    const uint32_t first[] = {bodies_add(b, &block), bodies_add(b, &other), bodies_add(b, &rope),
                              bodies_add(b, &ball), bodies_add(b, &ground)};
    for (uint32_t p = 0; p < first[4]; p++) {
        b->vx[p] = (float)(p < first[1] ? speed : p < first[2] ? -speed : 0);
        b->vy[p] = (float)(p < first[2] ? 0 : p < first[3] ? -speed : speed);
    }
    return b;
}

static mspring_network *crowd_network_by(mspring_solver solver, double apart, double speed, mspring_simd level,
                                         uint32_t workers, float gravity) {
    bodies *b = crowd(apart, speed);
    mspring_network_def def = support_def(gravity, solver == MSPRING_SOLVER_EXPLICIT ? SUBSTEPS : 2);
    def.settings.solver = solver;
    def.settings.guard = support_guard_of(solver);
    def.simd_level = level;
    def.worker_count = workers;
    mspring_network *network = bodies_network(b, &def);
    bodies_free(b);
    return network;
}

static mspring_network *crowd_network(double apart, double speed, mspring_simd level, uint32_t workers,
                                      float gravity) {
    return crowd_network_by(MSPRING_SOLVER_EXPLICIT, apart, speed, level, workers, gravity);
}

static mspring_network *touching_crowd_by(mspring_solver solver, mspring_simd level, uint32_t workers) {
    mspring_network *network = crowd_network_by(solver, 14, 12, level, workers, -9.8f);
    check_ok(bodies_touch(network, THICKNESS, 0.4f, 0.3f));
    return network;
}

static mspring_network *touching_crowd(mspring_simd level, uint32_t workers) {
    return touching_crowd_by(MSPRING_SOLVER_EXPLICIT, level, workers);
}

static mspring_contact_info info_of(const mspring_network *network) {
    mspring_contact_info info = {.struct_size = sizeof info};
    check_ok(mspring_network_get_contact_info(network, &info));
    return info;
}

/* ---------------------------------------------------------------------------------------------------- bits */

static void what_touches_nothing_moves_as_without(void **state) {
    (void)state;
    mspring_network *with = crowd_network(100, 2, MSPRING_SIMD_AUTO, 1, 0),
                    *without = crowd_network(100, 2, MSPRING_SIMD_AUTO, 1, 0);
    check_ok(bodies_touch(with, THICKNESS, 0.5f, 0.5f));
    for (int step = 0; step < 60; step++) {
        support_steps(with, 1, DT);
        support_steps(without, 1, DT);
        assert_true(support_hash(with) == support_hash(without));
        assert_int_equal(info_of(with).touching, 0);
    }
    check_ok(mspring_network_set_contact(with, NULL));
    support_steps(with, 5, DT);
    support_steps(without, 5, DT);
    assert_true(support_hash(with) == support_hash(without));
    mspring_network_destroy(with);
    mspring_network_destroy(without);
}

static uint64_t run(mspring_network *network, uint32_t steps, uint32_t *touching) {
    uint64_t hash = 0;
    for (uint32_t step = 0; step < steps; step++) {
        support_steps(network, 1, DT);
        hash = (hash << 7 | hash >> 57) ^ support_hash(network);
        *touching += info_of(network).touching;
    }
    return hash;
}

static void compare_bits(mspring_solver solver) {
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    uint64_t first = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t workers = 1; workers <= 3; workers += 2) {
            uint32_t touching = 0;
            mspring_network *network = touching_crowd_by(solver, levels[i], workers);
            const uint64_t hash = run(network, 150, &touching);
            first = i == 0 && workers == 1 ? hash : first;
            assert_true(hash == first);
            assert_true(touching > 100);
            mspring_network_destroy(network);
        }
}

static void bits_are_those_of_the_scalar_kernels(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        compare_bits((mspring_solver)solver);
}

static void go_on_after_loading(mspring_solver solver) {
    for (uint32_t saved_at = 1; saved_at < 60; saved_at += 6) {
        uint32_t touching = 0;
        mspring_network *network = touching_crowd_by(solver, MSPRING_SIMD_AUTO, 1), *clone,
                        *loaded = touching_crowd_by(solver, MSPRING_SIMD_AUTO, 1);
        support_steps(loaded, 7, DT); // whatever it has in its lists
        support_steps(network, saved_at, DT);
        support_bring(network, loaded, MSPRING_SNAPSHOT_ALL);
        check_ok(mspring_network_clone(network, NULL, &clone));
        saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
        const uint64_t hash = run(network, 20, &touching);
        assert_true(run(loaded, 20, &touching) == hash);
        assert_true(run(clone, 20, &touching) == hash);
        check_ok(mspring_network_load(network, frame.bytes, frame.size));
        assert_true(run(network, 20, &touching) == hash);
        free(frame.bytes);
        mspring_network_destroy(network);
        mspring_network_destroy(loaded);
        mspring_network_destroy(clone);
    }
}

static void what_is_loaded_goes_on_with_the_same_bits(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        go_on_after_loading((mspring_solver)solver);
}

/* ------------------------------------------------------------------------------------------------- outline */

/// The outline is the one that is found when contact is set anew.
static void check_outline(mspring_network *network) {
    mspring_network *clone;
    mspring_contact_def def = {.struct_size = sizeof def};
    support_steps(network, 1, DT);
    check_ok(mspring_network_clone(network, NULL, &clone));
    check_ok(mspring_network_get_contact(network, &def));
    check_ok(mspring_network_set_contact(clone, NULL));
    check_ok(mspring_network_set_contact(clone, &def));
    const mspring_contact_info is = info_of(network), anew = info_of(clone);
    assert_int_equal(is.edges, anew.edges);
    assert_int_equal(is.points, anew.points);
    mspring_network_destroy(clone);
}

static void outline_is_the_border(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b,
                     &(bodies_lattice){.width = 20, .height = 6, .angle = 0.7, .spacing = 1, .mass = 1, .f = 0.1});
    (void)bodies_add(b, &(bodies_lattice){.width = 10, .height = 1, .y = 30, .spacing = 1, .mass = 1, .f = 0.1});
    (void)bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .y = 50, .spacing = 1, .mass = 1, .f = 0.1});
    const mspring_network_def def = support_def(0, SUBSTEPS);
    mspring_network *network = bodies_network(b, &def);
    assert_int_equal(info_of(network).edges, 0);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    assert_int_equal(info_of(network).edges, 2 * (19 + 5) + 9 + 1);
    assert_int_equal(info_of(network).points, 2 * (19 + 5) + 10 + 1);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void outline_follows_breaks(void **state) {
    (void)state;
    uint64_t seed = 3;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 20, .height = 12, .spacing = 1, .mass = 1, .f = 0.1});
    const mspring_network_def def = support_def(0, SUBSTEPS);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, 0.1, 0, 0));
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    const uint32_t whole = info_of(network).edges;
    for (int round = 0; round < 60; round++) {
        mspring_id ids[8];
        for (int i = 0; i < 8; i++)
            ids[i] = (mspring_id)(support_random(&seed) % springs);
        if (round % 3 == 2)
            check_ok(mspring_network_restore_springs(network, ids, 0, 8, 0));
        else
            check_ok(mspring_network_break_springs(network, ids, 0, 8));
        if (round == 20)
            check_ok(mspring_network_compact(network));
        check_outline(network);
    }
    check_ok(support_expand(network));
    for (mspring_id s = 0; s < springs; s++)
        check_ok(mspring_network_restore_springs(network, &s, 0, 1, 0));
    check_outline(network);
    assert_int_equal(info_of(network).edges, whole);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// The two halves of a bar that was cut fly apart, and come back against each other.
static void halves_of_a_cut_body_collide(void **state) {
    (void)state;
    for (uint32_t flags = 0; flags <= MSPRING_CONTACT_SELF; flags++) {
        bodies *b = bodies_begin(DT / SUBSTEPS);
        (void)bodies_add(b, &(bodies_lattice){.width = 16, .height = 4, .spacing = 1, .mass = 5, .f = 0.3});
        for (uint32_t p = 0; p < b->count; p++)
            b->vx[p] = b->column[p] < 8 ? -3.0f : 3.0f;
        const mspring_network_def def = support_def(0, SUBSTEPS);
        mspring_network *network = bodies_network(b, &def);
        mspring_contact_def contact = bodies_contact(THICKNESS, 0.2f, 0);
        contact.flags = flags;
        check_ok(mspring_network_set_contact(network, &contact));
        for (uint32_t s = 0; s < b->spring_count; s++)
            if ((b->column[b->springs[s].a] < 8) != (b->column[b->springs[s].b] < 8))
                check_ok(mspring_network_break_springs(network, &s, 0, 1));
        support_steps(network, 10, DT);
        for (uint32_t p = 0; p < b->count; p++)
            b->vx[p] = b->column[p] < 8 ? 5.0f : -5.0f;
        check_ok(mspring_network_set_velocities(network, NULL, 0, b->count, b->vx, b->vy, 1));
        uint32_t touching = 0;
        (void)run(network, 60, &touching);
        assert_true(touching > 0);
        const bodies_measure m = bodies_measured(b, network);
        assert_true(fabs(m.x) < 1e-3 && fabs(m.y) < 1e-3);
        for (uint32_t p = 0; p < b->count; p++)
            assert_true(b->column[p] < 8 ? b->x[p] < 0.3 : b->x[p] > -0.3);
        mspring_network_destroy(network);
        bodies_free(b);
    }
}

/// A rope that is thrown together does not get through itself.
static void rope_does_not_get_through_itself(void **state) {
    (void)state;
    const uint32_t count = 60;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = count, .height = 1, .spacing = 1, .mass = 1, .f = 0.2});
    for (uint32_t p = 0; p < count; p++) {
        const double u = (p + 0.5) / count - 0.5;
        b->vy[p] = (float)(40 * fabs(u));
        b->vx[p] = (float)(-30 * u);
    }
    mspring_network_def def = support_def(0, SUBSTEPS);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.2f, 0));
    const bodies_measure before = bodies_measured(b, network);
    uint32_t touching = 0;
    for (int step = 0; step < 400; step++) {
        (void)run(network, 1, &touching);
        const bodies_measure now = bodies_measured(b, network);
        assert_true(now.energy < before.energy * 1.002);
        for (uint32_t s = 0; s < b->spring_count; s++) // each a body of its own
            b->body[b->springs[s].a] = s;
        b->body[count - 1] = count;
        for (uint32_t i = 0; i + 4 < b->spring_count; i++)
            for (uint32_t j = i + 4; j < b->spring_count; j++) {
                const bodies_spring *s = &b->springs[i], *t = &b->springs[j];
                const double ex = b->x[s->b] - b->x[s->a], ey = b->y[s->b] - b->y[s->a];
                const double fx = b->x[t->b] - b->x[t->a], fy = b->y[t->b] - b->y[t->a];
                const double gx = b->x[t->a] - b->x[s->a], gy = b->y[t->a] - b->y[s->a];
                const double det = ex * fy - ey * fx, along = gx * fy - gy * fx, across = gx * ey - gy * ex;
                const bool cross =
                    det != 0 && along / det > 0 && along / det < 1 && across / det > 0 && across / det < 1;
                assert_false(cross);
            }
    }
    assert_true(touching > 50);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void what_is_added_touches(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 9, .height = 3, .spacing = 1, .f = 0.1});
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.spare_particles = 4;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    support_steps(network, 1, DT);
    mspring_particle_def added;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &added, sizeof added));
    for (int round = 0; round < 3; round++) {
        mspring_id id = MSPRING_NONE;
        added.x = 0.3 * round;
        added.y = 3;
        check_ok(mspring_network_add_particles(network, &added, 1, &id));
        support_steps(network, 100, DT);
        check_near(support_position(network, id).y, 1 + THICKNESS, 1e-3);
        check_ok(mspring_network_remove_particles(network, &id, 0, 1));
        support_steps(network, 1, DT);
        check_ok(mspring_network_reuse_ids(network));
    }
    mspring_network_destroy(network);
    bodies_free(b);
}

/// Three balls fall on a row of springs. One particle of it is on a layer that the balls do not touch, or touches none
/// that they are on: the two springs at it let balls through, the third does not.
static void springs_touch_what_both_ends_may(void **state) {
    (void)state;
    const uint32_t first = 1, second = 2;
    for (int how = 0; how < 3; how++) {
        bodies *b = bodies_begin(DT / SUBSTEPS);
        const mspring_id row = bodies_add(b, &(bodies_lattice){.width = 4, .height = 1, .spacing = 1, .f = 0.1});
        mspring_id balls[3];
        for (int i = 0; i < 3; i++)
            balls[i] = bodies_add(
                b, &(bodies_lattice){.width = 1, .height = 1, .x = i - 1, .y = 1, .spacing = 1, .mass = 1, .f = 0.1});
        const mspring_network_def def = support_def(-9.8f, SUBSTEPS);
        mspring_network *network = bodies_network(b, &def);
        check_ok(bodies_touch(network, 0.3, 0, 0));
        if (how == 1) {
            check_ok(mspring_network_set_integers(network, MSPRING_LAYERS, NULL, row + 1, 1, &second, 1));
            check_ok(mspring_network_set_integers(network, MSPRING_MASKS, NULL, balls[0], 3, &first, 0));
        } else if (how == 2) {
            check_ok(mspring_network_set_integers(network, MSPRING_MASKS, NULL, row + 1, 1, &second, 1));
        }
        support_steps(network, 100, DT);
        for (int i = 0; i < 3; i++) {
            const double y = support_position(network, balls[i]).y;
            assert_true(how > 0 && i < 2 ? y < -5 : fabs(y - 0.3) < 1e-3);
        }
        mspring_network_destroy(network);
        bodies_free(b);
    }
}

/* -------------------------------------------------------------------------------------------------- forces */

/// A force that nothing could know of when the step began throws a ball at a rope: the step is repeated.
static void blast_throws_nothing_through(void **state) {
    (void)state;
    for (int step = 0; step < 20; step++) {
        bodies *b = bodies_begin(DT / SUBSTEPS);
        (void)bodies_add(b, &(bodies_lattice){.width = 9, .height = 1, .spacing = 1, .mass = 0, .f = 0.1});
        const uint32_t ball = bodies_add(
            b, &(bodies_lattice){.width = 1, .height = 1, .y = -0.8 - 0.05 * step, .spacing = 1, .mass = 2});
        const mspring_network_def def = support_def(0, SUBSTEPS);
        mspring_network *network = bodies_network(b, &def);
        check_ok(bodies_touch(network, THICKNESS, 0, 0));
        check_ok(mspring_network_apply_force(network, ball, 0, 2 * 200 / (float)DT));
        support_steps(network, 10, DT);
        assert_true(support_position(network, ball).y < -0.4);
        mspring_network_destroy(network);
        bodies_free(b);
    }
}

/// Bodies that are too stiff for their substeps, so that all steps are clamped.
static void clamped_steps_have_contact(void **state) {
    (void)state;
    bodies *b = crowd(14, 12);
    mspring_network_def def = support_def(-9.8f, SUBSTEPS / 5);
    def.settings.guard = MSPRING_GUARD_CLAMP;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.3f, 0));
    uint32_t touching = 0, crossings = 0;
    for (int step = 0; step < 150; step++) {
        (void)run(network, 1, &touching);
        (void)bodies_measured(b, network);
        assert_true(bodies_deepest(b, THICKNESS, &crossings) < 0.5 * THICKNESS);
        assert_int_equal(crossings, 0);
    }
    assert_true(touching > 100);
    assert_true(support_fallback_count(network) > 50);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void groups_part(void **state) {
    (void)state;
    for (uint32_t mask = 0; mask < 4; mask++) {
        bodies *b = bodies_begin(DT / SUBSTEPS);
        (void)bodies_add(b, &(bodies_lattice){.width = 9, .height = 1, .spacing = 1, .f = 0.1});
        const uint32_t ball =
            bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .y = 2, .spacing = 1, .mass = 2});
        const mspring_network_def def = support_def(-9.8f, SUBSTEPS);
        mspring_network *network = bodies_network(b, &def);
        check_error(support_set_layers(network, 0, 1, 1, 1), MSPRING_ERROR_ARGUMENT);
        check_ok(bodies_touch(network, THICKNESS, 0, 0));
        check_error(support_set_layers(network, 5, b->count, 1, 1), MSPRING_ERROR_ID);
        check_ok(support_set_layers(network, ball, 1, 2, mask));
        support_steps(network, 80, DT);
        assert_true((support_position(network, ball).y > 0) == (mask & 1));
        mspring_network_destroy(network);
        bodies_free(b);
    }
}

/* ---------------------------------------------------------------------------------------------- refusals */

static void bad_definitions_are_refused(void **state) {
    (void)state;
    mspring_network *network = touching_crowd(MSPRING_SIMD_AUTO, 1);
    const struct {
        double thickness;
        float friction, restitution, push_speed;
        uint32_t sweeps, capacity, flags, max_capacity;
        const char *part;
    } bad[] = {
        {NAN, 0, 0, 3, 4, 0, 1, 0, "thickness"},
        {-1, 0, 0, 3, 4, 0, 1, 0, "thickness"},
        {INFINITY, 0, 0, 3, 4, 0, 1, 0, "thickness"},
        {0.91, 0, 0, 3, 4, 0, 1, 0, "shortest spring"},
        {2e6, 0, 0, 3, 4, 0, 0, 0, "thickness"},
        {0.5, NAN, 0, 3, 4, 0, 1, 0, "friction"},
        {0.5, -1, 0, 3, 4, 0, 1, 0, "friction"},
        {0.5, 0, 1.1f, 3, 4, 0, 1, 0, "restitution"},
        {0.5, 0, NAN, 3, 4, 0, 1, 0, "restitution"},
        {0.5, 0, 0, -2, 4, 0, 1, 0, "push_speed"},
        {0.5, 0, 0, 3, 0, 0, 1, 0, "sweeps"},
        {0.5, 0, 0, 3, 65, 0, 1, 0, "sweeps"},
        {0.5, 0, 0, 3, 4, UINT32_MAX, 1, 0, "capacity"},
        {0.5, 0, 0, 3, 4, 8, 1, 7, "max_capacity, 7"},
        {0.5, 0, 0, 3, 4, 0, 1, UINT32_MAX, "max_capacity"},
        {0.5, 0, 0, 3, 4, 0, 2, 0, "flags"},
    };
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        mspring_contact_def def = bodies_contact(bad[i].thickness, bad[i].friction, bad[i].restitution);
        def.push_speed = bad[i].push_speed;
        def.sweeps = bad[i].sweeps;
        def.capacity = bad[i].capacity;
        def.flags = bad[i].flags;
        def.max_capacity = bad[i].max_capacity;
        check_error(mspring_network_set_contact(network, &def), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), bad[i].part);
    }
    mspring_contact_def def = {.struct_size = sizeof def};
    check_ok(mspring_network_get_contact(network, &def));
    assert_true(def.thickness == THICKNESS && def.friction == 0.4f && def.capacity > 0);
    mspring_network_destroy(network);
    mspring_builder *builder = support_builder();
    (void)support_particle(builder, 0, 0, 1);
    const mspring_network_def loose = support_def(0, 1);
    network = support_network(builder, &loose);
    check_error(bodies_touch(network, 0, 0, 0), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "no spring");
    check_ok(bodies_touch(network, 0.3, 0, 0));
    mspring_network_destroy(network);
}

/// Solvers and guards change while bodies touch, and contact comes and goes with each of them.
static void all_solvers_take_contact(void **state) {
    (void)state;
    mspring_network *network = touching_crowd(MSPRING_SIMD_AUTO, 1);
    const mspring_solver solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT, MSPRING_SOLVER_EXPLICIT};
    for (size_t i = 0; i < 3; i++) {
        mspring_settings def;
        check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
        def.solver = solvers[i];
        def.substeps = solvers[i] == MSPRING_SOLVER_EXPLICIT ? SUBSTEPS : 2;
        check_ok(support_set_solver(network, &def));
        support_steps(network, 2, 1.0 / 64);
        check_ok(support_set_guard(network, i == 1 ? MSPRING_GUARD_BOUNDS : MSPRING_GUARD_IMPLICIT));
        support_steps(network, 2, 1.0 / 64);
        check_ok(mspring_network_set_contact(network, NULL));
        support_steps(network, 1, 1.0 / 64);
        check_ok(bodies_touch(network, THICKNESS, 0.3f, 0));
        support_steps(network, 2, 1.0 / 64);
    }
    mspring_network_destroy(network);
}

static void too_many_pairs_are_told(void **state) {
    (void)state;
    mspring_network *network = touching_crowd(MSPRING_SIMD_AUTO, 1), *same = touching_crowd(MSPRING_SIMD_AUTO, 1);
    mspring_contact_def def = bodies_contact(THICKNESS, 0.4f, 0.3f);
    def.capacity = def.max_capacity = 20;
    check_ok(mspring_network_set_contact(network, &def));
    mspring_result result = MSPRING_OK;
    uint32_t steps = 0;
    for (; result == MSPRING_OK && steps < 80; steps++) {
        const uint64_t before = support_hash(network);
        result = mspring_network_step(network, DT);
        if (result != MSPRING_OK) {
            assert_true(support_hash(network) == before);
            break;
        }
    }
    assert_int_equal(result, MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "capacity");
    def.capacity = def.max_capacity = 0;
    check_ok(mspring_network_set_contact(network, &def));
    support_steps(network, 80 - steps, DT);
    support_steps(same, 80, DT);
    assert_true(support_hash(network) == support_hash(same));
    mspring_network_destroy(network);
    mspring_network_destroy(same);
}

/// Soft blocks that fall 30 m onto each other, with as few substeps as they need: what is fast has long lists.
static void falling_blocks_have_room_by_default(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / 2);
    (void)bodies_add(b, &(bodies_lattice){.width = 60, .height = 1, .y = -1, .spacing = 1, .f = 0.1});
    for (uint32_t i = 0; i < 24; i++)
        (void)bodies_add(b, &(bodies_lattice){.width = 7,
                                              .height = 7,
                                              .x = -18.0 + 7.5 * (i % 6),
                                              .y = 27.0 + 8 * (i / 6),
                                              .angle = 0.3 * i,
                                              .spacing = 1,
                                              .mass = 10,
                                              .f = 0.3});
    const mspring_network_def def = support_def(-9.8f, MSPRING_SUBSTEPS_AUTO);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.2f, 0));
    uint32_t touching = 0;
    for (int step = 0; step < 300; step++) {
        check_ok(mspring_network_step(network, DT));
        touching = info_of(network).touching > touching ? info_of(network).touching : touching;
    }
    assert_true(touching > 50);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// Rows of implicit systems have room only once a solver asks for it.
static void explicit_contact_takes_less_memory(void **state) {
    (void)state;
    mspring_network *network = crowd_network(14, 12, MSPRING_SIMD_AUTO, 1, 0);
    const size_t before = support_memory_used(network);
    check_ok(bodies_touch(network, THICKNESS, 0.2f, 0));
    const size_t by_contact = support_memory_used(network) - before;
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    def.solver = MSPRING_SOLVER_IMPLICIT;
    check_ok(support_set_solver(network, &def));
    const size_t with_solver = support_memory_used(network);
    check_ok(mspring_network_set_contact(network, NULL));
    const size_t solver_alone = support_memory_used(network);
    // A row is 240 bytes beside 144, and 33 for each of the eight pairs that it stands for.
    assert_true(with_solver - solver_alone > by_contact + by_contact / 5);
    check_ok(bodies_touch(network, THICKNESS, 0.2f, 0));
    assert_int_equal(support_memory_used(network), with_solver);
    mspring_network_destroy(network);
}

static void memory_is_given_back(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_clone_def clone_def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &clone_def, sizeof clone_def));
    clone_def.allocator = &allocator;
    mspring_network *from = crowd_network(16, 10, MSPRING_SIMD_AUTO, 1, 0), *network;
    check_ok(mspring_network_clone(from, &clone_def, &network));
    uint32_t failures = 0;
    mspring_result result = MSPRING_ERROR_MEMORY;
    for (size_t fail_at = 1; result != MSPRING_OK && fail_at < 100; fail_at++) {
        const uint64_t before = support_hash(network);
        watched.fail_at = watched.calls + fail_at;
        result = bodies_touch(network, THICKNESS, 0, 0);
        failures += result == MSPRING_ERROR_MEMORY;
        assert_true(support_hash(network) == before);
    }
    watched.fail_at = 0;
    check_ok(result);
    assert_true(failures > 5);
    support_steps(network, 60, DT);
    const size_t with = support_memory_used(network);
    check_ok(bodies_touch(network, THICKNESS, 0.1f, 0));
    assert_int_equal(support_memory_used(network), with);
    check_ok(mspring_network_set_contact(network, NULL));
    assert_true(support_memory_used(network) < with);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    mspring_network_destroy(from);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_touches_nothing_moves_as_without),
        cmocka_unit_test(bits_are_those_of_the_scalar_kernels),
        cmocka_unit_test(what_is_loaded_goes_on_with_the_same_bits),
        cmocka_unit_test(outline_is_the_border),
        cmocka_unit_test(outline_follows_breaks),
        cmocka_unit_test(halves_of_a_cut_body_collide),
        cmocka_unit_test(rope_does_not_get_through_itself),
        cmocka_unit_test(what_is_added_touches),
        cmocka_unit_test(springs_touch_what_both_ends_may),
        cmocka_unit_test(blast_throws_nothing_through),
        cmocka_unit_test(clamped_steps_have_contact),
        cmocka_unit_test(groups_part),
        cmocka_unit_test(bad_definitions_are_refused),
        cmocka_unit_test(all_solvers_take_contact),
        cmocka_unit_test(too_many_pairs_are_told),
        cmocka_unit_test(falling_blocks_have_room_by_default),
        cmocka_unit_test(explicit_contact_takes_less_memory),
        cmocka_unit_test(memory_is_given_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
