/// @file test_collider_calls.c
/// What goes along with colliders: same bits at every level and with any workers, in clones, after loading and far
/// from the origin; sleep; groups; growth and compaction; steps that fail; and memory.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "allocator.h"
#include "bodies.h"

#define THICKNESS 0.5
#define DT (1.0 / 64)
#define SUBSTEPS 30

static mspring_collider_def shape(mspring_collider_kind kind, double x, double y) {
    mspring_collider_def def;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = kind;
    def.x = x;
    def.y = y;
    def.friction = 0.3f;
    def.restitution = 0.2f;
    return def;
}

static mspring_id add_box(mspring_network *network, double width, double height, double x, double y) {
    mspring_collider_def def = shape(MSPRING_COLLIDER_BOX, x, y);
    mspring_id id = MSPRING_NONE;
    def.width = width;
    def.height = height;
    check_ok(mspring_network_add_collider(network, &def, &id));
    return id;
}

static mspring_id add_circle(mspring_network *network, double radius, double x, double y) {
    mspring_collider_def def = shape(MSPRING_COLLIDER_CIRCLE, x, y);
    mspring_id id = MSPRING_NONE;
    def.radius = radius;
    check_ok(mspring_network_add_collider(network, &def, &id));
    return id;
}

static support_point impulse_of(const mspring_network *network, mspring_id id) {
    support_point impulse;
    double angular;
    check_ok(mspring_network_get_collider_impulse(network, id, &impulse.x, &impulse.y, &angular));
    assert_true(impulse.x != 0 || impulse.y != 0 || angular == 0);
    return impulse;
}

static mspring_contact_info info_of(const mspring_network *network) {
    mspring_contact_info info = {.struct_size = sizeof info};
    check_ok(mspring_network_get_contact_info(network, &info));
    return info;
}

/* -------------------------------------------------------------------------------------------------------- bits */

/// Bodies of each kind that fall into a trough, in which a paddle turns, and a circle goes to and fro. The world's
/// origin is elsewhere.
typedef struct trough {
    mspring_network *network;
    mspring_id ground, paddle, ball;
    double x;
    uint32_t step;
} trough;

static void add_colliders(trough *t) {
    static const double ground[10] = {-16, 14, -13, -3, 0, -5, 12, -4, 16, 14};
    mspring_collider_def def = shape(MSPRING_COLLIDER_CHAIN, t->x, 0);
    def.points = ground;
    def.point_count = 5;
    check_ok(mspring_network_add_collider(t->network, &def, &t->ground));
    t->paddle = add_box(t->network, 7, 0.8, t->x - 4, 0);
    t->ball = add_circle(t->network, 1.2, t->x + 6, 2);
}

static trough make_trough(double x, mspring_simd level, uint32_t workers) {
    trough t = {.x = x};
    bodies *b = bodies_begin(DT / SUBSTEPS);
    const bodies_lattice block = {
        .width = 6, .height = 3, .x = x - 5, .y = 7, .angle = 0.2, .spacing = 1, .mass = 20, .f = 0.3};
    bodies_lattice other = block, rope = block, ball = block;
    other.x = x + 5, other.angle = -0.3, other.width = 4, other.mass = 7;
    rope.y = 11, rope.width = 15, rope.height = 1, rope.x = x;
    ball.x = x + 1, ball.width = ball.height = 1;
    (void)bodies_add(b, &block);
    (void)bodies_add(b, &other);
    (void)bodies_add(b, &rope);
    (void)bodies_add(b, &ball);
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.simd_level = level;
    def.worker_count = workers;
    t.network = bodies_network(b, &def);
    check_ok(bodies_touch(t.network, THICKNESS, 0.4f, 0.3f));
    add_colliders(&t);
    bodies_free(b);
    return t;
}

static uint64_t run(trough *t, uint32_t steps) {
    uint64_t hash = 0;
    for (uint32_t i = 0; i < steps; i++) {
        const double at = DT * ++t->step;
        check_ok(mspring_network_move_collider(t->network, t->paddle, t->x - 4, 0, 3 * at));
        check_ok(mspring_network_move_collider(t->network, t->ball, t->x + 6 + 4 * sin(5 * at), 2, -at));
        support_steps(t->network, 1, DT);
        hash = (hash << 7 | hash >> 57) ^ support_hash(t->network);
        for (mspring_id id = t->ground; id <= t->ball; id++) {
            double impulse[3];
            check_ok(mspring_network_get_collider_impulse(t->network, id, &impulse[0], &impulse[1], &impulse[2]));
            for (int k = 0; k < 3; k++) {
                uint64_t word;
                memcpy(&word, &impulse[k], sizeof word);
                hash = (hash << 5 | hash >> 59) ^ word;
            }
        }
    }
    return hash;
}

static void bits_are_those_of_the_scalar_kernels(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    uint64_t first = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t workers = 1; workers <= 3; workers += 2) {
            trough t = make_trough(1000, levels[i], workers);
            uint32_t touching = 0;
            uint64_t hash = 0;
            for (int step = 0; step < 200; step++) {
                hash = (hash << 7 | hash >> 57) ^ run(&t, 1);
                touching += info_of(t.network).touching;
            }
            first = i == 0 && workers == 1 ? hash : first;
            assert_true(hash == first);
            assert_true(touching > 60);
            mspring_network_destroy(t.network);
        }
}

/// A clone has the colliders, with what they wait for. What is loaded goes on, once they have been placed.
static void copies_go_on_with_the_same_bits(void **state) {
    (void)state;
    for (uint32_t saved_at = 1; saved_at < 120; saved_at += 17) {
        trough t = make_trough(0, MSPRING_SIMD_AUTO, 1), loaded = make_trough(0, MSPRING_SIMD_AUTO, 1), clone;
        (void)run(&loaded, 9);
        (void)run(&t, saved_at);
        support_bring(t.network, loaded.network, MSPRING_SNAPSHOT_ALL);
        const support_point forgotten = impulse_of(loaded.network, t.ground);
        assert_true(forgotten.x == 0 && forgotten.y == 0);
        for (mspring_id id = t.ground; id <= t.ball; id++) {
            mspring_collider_def is = {.struct_size = sizeof is};
            check_ok(mspring_network_get_collider(t.network, id, &is));
            check_ok(mspring_network_place_collider(loaded.network, id, is.x, is.y, is.angle));
        }
        loaded.step = t.step;
        clone = t;
        check_ok(mspring_network_clone(t.network, NULL, &clone.network));
        const uint64_t hash = run(&t, 30);
        assert_true(run(&loaded, 30) == hash);
        assert_true(run(&clone, 30) == hash);
        mspring_network_destroy(t.network);
        mspring_network_destroy(loaded.network);
        mspring_network_destroy(clone.network);
    }
}

/// The same scene, wherever it is, and whatever the ids of its colliders are. Doubles of 65,536 m round by 7e-12 m
/// twice, so first words of coordinates may differ by a last place, which springs see: 2.6e-7 m until something
/// touches. The first touch rounds by a last place of 4 m, 5e-7 m; until the next one the body turns on with that,
/// for a quarter of a second.
static void place_and_ids_do_not_matter(void **state) {
    (void)state;
    trough t = make_trough(0, MSPRING_SIMD_AUTO, 1), away = make_trough(65536, MSPRING_SIMD_AUTO, 1);
    for (mspring_id id = away.ground; id <= away.ball; id++)
        check_ok(mspring_network_remove_collider(away.network, id));
    add_colliders(&away);
    assert_int_equal(away.ground, 3);
    uint32_t touching = 0;
    for (uint32_t i = 0; i < 52; i++) {
        (void)run(&t, 1);
        (void)run(&away, 1);
        touching += info_of(t.network).touching;
        for (mspring_id p = 0; p < mspring_network_count(t.network, MSPRING_PARTICLES); p++) {
            const support_point here = support_position(t.network, p), there = support_position(away.network, p);
            check_near(there.x - 65536, here.x, touching == 0 ? 1e-6 : 1e-5);
        }
    }
    assert_true(touching > 0);
    mspring_network_destroy(t.network);
    mspring_network_destroy(away.network);
}

/// The local origin follows a bullet that a collider throws 4 km far, past posts that stand on its way.
static void colliders_follow_the_origin(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 4, .height = 2, .spacing = 1, .mass = 2, .f = 0.3});
    const mspring_network_def def = support_def(0, SUBSTEPS);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    const mspring_id bat = add_box(network, 2, 4, -6, 0), far_wall = add_box(network, 2, 40, 4000, 0);
    double met = 0;
    for (int step = 1; step <= 1000; step++) {
        check_ok(mspring_network_move_collider(network, bat, -6 + fmin(300 * DT * step, 60), 0, 0));
        support_steps(network, 1, DT);
        met += impulse_of(network, far_wall).x;
        const bodies_measure m = bodies_measured(b, network);
        assert_true(m.fastest < 1000 && b->x[7] < 3999 - THICKNESS + 0.01);
    }
    assert_true(b->x[0] > 60 && met > 16 * 100);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// What colliders are too far away for moves as without them.
static void what_touches_nothing_moves_as_without(void **state) {
    (void)state;
    mspring_network *networks[2];
    for (int i = 0; i < 2; i++) {
        bodies *b = bodies_begin(DT / SUBSTEPS);
        (void)bodies_add(b, &(bodies_lattice){.width = 20, .height = 6, .spacing = 1, .mass = 2, .f = 0.3});
        b->vx[3] = 2;
        const mspring_network_def def = support_def(0, SUBSTEPS);
        networks[i] = bodies_network(b, &def);
        bodies_free(b);
    }
    check_ok(bodies_touch(networks[0], THICKNESS, 0, 0));
    const mspring_id id = add_box(networks[0], 4, 4, 200, 0);
    for (int step = 0; step < 60; step++) {
        check_ok(mspring_network_move_collider(networks[0], id, 200 - 0.3 * step, 0, 0.1 * step));
        support_steps(networks[0], 1, DT);
        support_steps(networks[1], 1, DT);
        assert_true(support_hash(networks[0]) == support_hash(networks[1]));
        assert_int_equal(info_of(networks[0]).touching, 0);
        const support_point impulse = impulse_of(networks[0], id);
        assert_true(impulse.x == 0 && impulse.y == 0);
    }
    mspring_network_destroy(networks[0]);
    mspring_network_destroy(networks[1]);
}

/* ------------------------------------------------------------------------------------------------------- sleep */

static void bodies_sleep_on_what_rests_and_wake_when_it_comes(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    b->damping = 0.3;
    for (int i = 0; i < 2; i++)
        (void)bodies_add(
            b, &(bodies_lattice){
                   .width = 4, .height = 3, .x = 40 * i, .y = 1 + THICKNESS, .spacing = 1, .mass = 10, .f = 0.5});
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.settings.sleep_speed = 0.05f;
    def.settings.sleep_time = 0.2f;
    def.settings.global_damping = 1;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    const mspring_id table = add_box(network, 30, 1, 0, -0.5), other = add_box(network, 30, 1, 40, -0.5),
                     comer = add_circle(network, 1, -30, 1.5);
    support_fall_asleep(network, DT);
    assert_true(support_is_asleep(network));
    // Far away one may move about.
    check_ok(mspring_network_move_collider(network, comer, -29.9, 1.5, 0));
    support_steps(network, 1, DT);
    assert_true(support_is_asleep(network));
    // What lies still gives nothing, and what moves under a body wakes it alone, and keeps it awake.
    assert_true(impulse_of(network, table).y == 0);
    for (int step = 1; step <= 100; step++) {
        check_ok(mspring_network_move_collider(network, table, 1e-6 * step, -0.5, 0));
        support_steps(network, 1, DT);
        assert_false(support_sleeps(network, 0));
        assert_true(support_sleeps(network, 12));
    }
    assert_true(impulse_of(network, table).y < 0);
    assert_true(impulse_of(network, other).y == 0);
    support_fall_asleep(network, DT);
    // A circle that comes pushes the sleeper along.
    for (int step = 1; step <= 352; step++) {
        check_ok(mspring_network_move_collider(network, comer, -29.9 + 5 * DT * step, 1.5, 0));
        support_steps(network, 1, DT);
    }
    assert_false(support_sleeps(network, 0));
    assert_true(support_position(network, 0).x > -1);
    assert_true(support_sleeps(network, 12));
    // What a body lies on is taken away.
    check_ok(mspring_network_place_collider(network, comer, -30, 50, 0));
    support_steps(network, 100, DT);
    support_fall_asleep(network, DT);
    check_ok(mspring_network_remove_collider(network, other));
    support_steps(network, 20, DT);
    assert_true(support_velocity(network, 12).y < -2);
    mspring_network_destroy(network);
    bodies_free(b);
}

/* ------------------------------------------------------------------------------------------------------ groups */

/// Two blocks that touch colliders only: they fall through each other, and stay on the ground.
static void particles_may_touch_colliders_alone(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    for (int i = 0; i < 2; i++)
        (void)bodies_add(
            b, &(bodies_lattice){.width = 4, .height = 3, .y = 2 + 5 * i, .spacing = 1, .mass = 10, .f = 0.3});
    const mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    check_ok(support_set_layers(network, 0, b->count, 1, 2));
    mspring_collider_def ground = shape(MSPRING_COLLIDER_BOX, 0, -0.5);
    ground.width = 20;
    ground.layers = 2;
    ground.masks = 1;
    check_ok(mspring_network_add_collider(network, &ground, NULL));
    ground.layers = 4; // that no particle looks at
    ground.y = 2;
    check_ok(mspring_network_add_collider(network, &ground, NULL));
    support_steps(network, 400, DT);
    (void)bodies_measured(b, network);
    check_near(b->y[12], b->y[0], 0.05);
    assert_true(b->y[0] > 0.4);
    mspring_network_destroy(network);
    bodies_free(b);
}

/* ------------------------------------------------------------------------------------------------------ growth */

static void what_is_added_and_left_out_goes_on(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 9, .height = 3, .y = 2, .spacing = 1, .mass = 4, .f = 0.1});
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.spare_particles = 4;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    (void)add_box(network, 30, 1, 0, -0.5);
    mspring_particle_def added;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &added, sizeof added));
    for (int round = 0; round < 3; round++) {
        mspring_id id = MSPRING_NONE, spring = (mspring_id)round;
        added.x = 9 + 0.3 * round;
        added.y = 3;
        check_ok(mspring_network_add_particles(network, &added, 1, &id));
        check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        check_ok(round == 1 ? mspring_network_compact(network) : MSPRING_OK);
        (void)add_circle(network, 0.3, 9 + 0.3 * round, 1.2);
        support_steps(network, 100, DT);
        assert_true(support_position(network, id).y > THICKNESS - 0.01);
        check_ok(mspring_network_remove_particles(network, &id, 0, 1));
        support_steps(network, 1, DT);
        check_ok(mspring_network_reuse_ids(network));
    }
    for (mspring_id p = 0; p < 27; p++)
        assert_true(support_position(network, p).y > THICKNESS - 0.01);
    mspring_network_destroy(network);
    bodies_free(b);
}

/* ------------------------------------------------------------------------------------------- steps that fail */

static void failed_step_moves_no_collider(void **state) {
    (void)state;
    trough t = make_trough(0, MSPRING_SIMD_AUTO, 1), same = make_trough(0, MSPRING_SIMD_AUTO, 1);
    support_point had = {0, 0};
    while (had.y == 0) {
        (void)run(&t, 1);
        (void)run(&same, 1);
        had = impulse_of(t.network, t.ground);
        assert_true(t.step < 300);
    }
    mspring_collider_def is = {.struct_size = sizeof is};
    check_ok(mspring_network_move_collider(t.network, t.paddle, -4, 0.1, 9));
    check_ok(mspring_network_move_collider(same.network, t.paddle, -4, 0.1, 9));
    const uint64_t before = support_hash(t.network);
    // A force that no float holds.
    check_ok(mspring_network_apply_force(t.network, 3, 3e38f, 3e38f));
    assert_true(mspring_network_step(t.network, DT) != MSPRING_OK);
    assert_true(support_hash(t.network) == before);
    check_ok(mspring_network_get_collider(t.network, t.paddle, &is));
    assert_true(is.y == 0);
    const support_point has = impulse_of(t.network, t.ground);
    assert_true(has.x == had.x && has.y == had.y);
    check_ok(mspring_network_apply_force(t.network, 3, -3e38f, -3e38f));
    support_steps(t.network, 1, DT);
    support_steps(same.network, 1, DT);
    check_ok(mspring_network_get_collider(t.network, t.paddle, &is));
    assert_true(is.y == 0.1 && is.angle == 9);
    assert_true(support_hash(t.network) == support_hash(same.network));
    mspring_network_destroy(t.network);
    mspring_network_destroy(same.network);
}

/// Circles that come out of nowhere, and fly further in a step than anything: the step is taken, or fails and says
/// why.
static void wild_moves_break_nothing(void **state) {
    (void)state;
    uint64_t seed = 3;
    trough t = make_trough(0, MSPRING_SIMD_AUTO, 1);
    uint32_t taken = 0;
    for (int i = 0; i < 200; i++) {
        const double size = pow(10, support_random_between(&seed, -3, i % 10 == 0 ? 12 : 3));
        for (mspring_id id = t.ground; id <= t.ball; id++)
            check_ok(mspring_network_move_collider(t.network, id, support_random_between(&seed, -size, size),
                                                   support_random_between(&seed, -size, size),
                                                   support_random_between(&seed, -size, size) * 1e-6));
        const uint64_t before = support_hash(t.network);
        const mspring_result result = mspring_network_step(t.network, i % 20 == 0 ? 1e-30 : DT);
        taken += result == MSPRING_OK;
        if (result != MSPRING_OK) {
            assert_true(result == MSPRING_ERROR_UNSTABLE || result == MSPRING_ERROR_LIMIT);
            assert_true(support_hash(t.network) == before);
            for (mspring_id id = t.ground; id <= t.ball; id++)
                check_ok(mspring_network_place_collider(t.network, id, 0, 0, 0));
        }
    }
    assert_true(taken > 100);
    mspring_network_destroy(t.network);
}

/* ---------------------------------------------------------------------------------------------------- reading,
 * memory */

/// What is read is what was given, and where it has come to.
static void colliders_are_read_as_given(void **state) {
    (void)state;
    trough t = make_trough(7, MSPRING_SIMD_AUTO, 1);
    mspring_collider_def is = {.struct_size = sizeof is};
    const mspring_contact_info info = info_of(t.network);
    check_ok(mspring_network_get_collider(t.network, t.ground, &is));
    assert_true(is.kind == MSPRING_COLLIDER_CHAIN && is.point_count == 5 && is.points[9] == 14 && is.x == 7);
    (void)run(&t, 10);
    assert_int_equal(info_of(t.network).edges, info.edges);
    assert_int_equal(info_of(t.network).points, info.points);
    check_ok(mspring_network_get_collider(t.network, t.paddle, &is));
    assert_true(is.kind == MSPRING_COLLIDER_BOX && is.width == 7 && !is.points && is.layers == 1);
    check_near(is.angle, 3 * 10 * DT, 1e-15);
    check_ok(mspring_network_remove_collider(t.network, t.ground));
    check_ok(mspring_network_get_collider(t.network, t.ball, &is));
    assert_true(is.kind == MSPRING_COLLIDER_CIRCLE && is.radius == 1.2 && is.friction == 0.3f);
    mspring_network_destroy(t.network);
}

static void memory_is_given_back(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_clone_def clone_def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &clone_def, sizeof clone_def));
    clone_def.allocator = &allocator;
    trough from = make_trough(0, MSPRING_SIMD_AUTO, 1), t = from;
    check_ok(mspring_network_clone(from.network, &clone_def, &t.network));
    uint32_t failures = 0;
    mspring_collider_def def = shape(MSPRING_COLLIDER_CIRCLE, 0, 30);
    def.radius = 0.1;
    for (int added = 0; added < 60; added++) {
        mspring_result result = MSPRING_ERROR_MEMORY;
        for (size_t fail_at = 1; result != MSPRING_OK; fail_at++) {
            const size_t used = support_memory_used(t.network);
            mspring_id id = 12345;
            watched.fail_at = watched.calls + fail_at;
            result = mspring_network_add_collider(t.network, &def, &id);
            failures += result == MSPRING_ERROR_MEMORY;
            if (result != MSPRING_OK)
                check_contains(mspring_network_error(t.network), "no memory for collider");
            assert_int_equal(id, result == MSPRING_OK ? 3 + (uint32_t)added : 12345);
            assert_true(result == MSPRING_OK || support_memory_used(t.network) < used + 60000);
            watched.fail_at = 0;
            if (result != MSPRING_OK && added % 20 == 0)
                (void)run(&t, 1);
        }
    }
    assert_true(failures > 50);
    const size_t with = support_memory_used(t.network);
    for (mspring_id id = 3; id < 63; id++)
        check_ok(mspring_network_remove_collider(t.network, id));
    assert_int_equal(support_memory_used(t.network), with);
    from.step = t.step;
    (void)run(&t, 50);
    mspring_network_destroy(t.network);
    check_watched_clean(&watched);
    mspring_network_destroy(from.network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_are_those_of_the_scalar_kernels),
        cmocka_unit_test(copies_go_on_with_the_same_bits),
        cmocka_unit_test(place_and_ids_do_not_matter),
        cmocka_unit_test(colliders_follow_the_origin),
        cmocka_unit_test(what_touches_nothing_moves_as_without),
        cmocka_unit_test(bodies_sleep_on_what_rests_and_wake_when_it_comes),
        cmocka_unit_test(particles_may_touch_colliders_alone),
        cmocka_unit_test(what_is_added_and_left_out_goes_on),
        cmocka_unit_test(failed_step_moves_no_collider),
        cmocka_unit_test(wild_moves_break_nothing),
        cmocka_unit_test(colliders_are_read_as_given),
        cmocka_unit_test(memory_is_given_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
