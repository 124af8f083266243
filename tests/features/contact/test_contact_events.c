/// @file test_contact_events.c
/// Contacts that begin and end: once each, however bodies slide, rest, sleep, are loaded or rolled back.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "bodies.h"
#include "snapshots.h"

#include <massspring/massspring.h>

#define THICKNESS 0.5
#define DT (1.0 / 64)
#define SUBSTEPS 30
#define ROOM 512

static mspring_contact_event events[ROOM];

/// Read all events there are, into events. Returns how many.
static uint32_t read_events(mspring_network *network) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < ROOM; i++)
        events[i].struct_size = sizeof events[i];
    check_ok(mspring_network_read_contact_events(network, events, ROOM, &count, NULL));
    return count;
}

/// Begun less ended of those in events.
static int balance(uint32_t count) {
    int sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += events[i].kind == MSPRING_CONTACT_BEGAN ? 1 : -1;
    return sum;
}

/// A rope, of so many kg a particle or pinned, with a ball above it.
static mspring_network *ball_above_rope(bodies *b, double mass, float gravity, float restitution, uint32_t *ball) {
    (void)bodies_add(b, &(bodies_lattice){.width = 9, .height = 1, .spacing = 1, .mass = mass, .f = 0.1});
    *ball = bodies_add(
        b, &(bodies_lattice){.width = 1, .height = 1, .x = 0.3, .y = THICKNESS + 1, .spacing = 1, .mass = 2});
    mspring_network_def def = support_def(gravity, SUBSTEPS);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.2f, restitution));
    check_ok(support_reserve_contact_events(network, 64));
    return network;
}

static void ball_begins_and_ends(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    uint32_t ball;
    mspring_network *network = ball_above_rope(b, 0, 0, 1, &ball);
    b->vy[ball] = -4;
    check_ok(mspring_network_set_velocities(network, NULL, ball, 1, &b->vx[ball], &b->vy[ball], 1));
    support_steps(network, 64, DT);
    assert_int_equal(read_events(network), 2);
    assert_int_equal(events[0].kind, MSPRING_CONTACT_BEGAN);
    assert_int_equal(events[1].kind, MSPRING_CONTACT_ENDED);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(events[i].point, ball);
        assert_int_equal(events[i].a, 4);
        assert_int_equal(events[i].b, 5);
        assert_int_equal(events[i].collider, MSPRING_NONE);
        check_near(events[i].x, 0.3, 1e-6);
        check_near(events[i].y, 0, 1e-6);
        check_near(events[i].normal_x, 0, 1e-6);
        check_near(events[i].normal_y, 1, 1e-6);
    }
    check_near(events[0].impulse, 2 * 8, 1e-4); // from -4 to 4 m/s, 2 kg
    assert_true(events[1].impulse == 0 && events[0].friction == 0);
    assert_int_equal(read_events(network), 0);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// What comes to rest begins once, however long it lies and slides.
static void what_rests_or_slides_begins_once(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 40, .height = 1, .spacing = 1, .f = 0.1});
    const uint32_t first = bodies_add(
        b, &(bodies_lattice){
               .width = 4, .height = 3, .x = -15, .y = 1 + THICKNESS, .spacing = 1, .mass = 2, .f = 0.3});
    for (uint32_t p = first; p < b->count; p++)
        b->vx[p] = 6;
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.settings.global_damping = 0.3f;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.1f, 0));
    check_ok(support_reserve_contact_events(network, ROOM));
    support_steps(network, 64 * 10, DT);
    uint32_t began[64] = {0}, ended[64] = {0};
    const uint32_t count = read_events(network);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(events[i].point < 64);
        (events[i].kind == MSPRING_CONTACT_BEGAN ? began : ended)[events[i].point]++;
    }
    assert_true(support_position(network, first).x > -10);
    for (uint32_t p = first; p < first + 4; p++) {
        assert_int_equal(began[p], 1);
        assert_int_equal(ended[p], 0);
    }
    mspring_network_destroy(network);
    bodies_free(b);
}

/// Sleep ends nothing, and what is woken begins nothing.
static void sleepers_stay_in_contact(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 12, .height = 1, .spacing = 1, .f = 0.1});
    for (int i = 0; i < 3; i++)
        (void)bodies_add(
            b, &(bodies_lattice){
                   .width = 6, .height = 2, .y = 0.5 + THICKNESS + 1.5 * i, .spacing = 1, .mass = 5, .f = 0.3});
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.settings.global_damping = 2;
    def.settings.sleep_speed = 0.1f;
    def.settings.sleep_time = 0.5f;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.3f, 0));
    check_ok(support_reserve_contact_events(network, ROOM));
    support_fall_asleep(network, DT);
    const uint32_t first = read_events(network);
    assert_int_equal(balance(first), (int)first);
    assert_true(first >= 12);
    support_steps(network, 64, DT);
    assert_int_equal(read_events(network), 0);
    check_ok(mspring_network_wake(network));
    support_steps(network, 32, DT);
    assert_int_equal(read_events(network), 0);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// A ball and a box of the host: the ball touches its side, and later a corner of it touches the rope.
static void colliders_have_events(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    uint32_t ball;
    mspring_network *network = ball_above_rope(b, 100, 0, 0, &ball);
    mspring_collider_def def;
    mspring_id other, box;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = MSPRING_COLLIDER_BOX;
    def.width = def.height = 1;
    def.x = 50;
    check_ok(mspring_network_add_collider(network, &def, &other));
    def.x = 0.3, def.y = 5;
    check_ok(mspring_network_add_collider(network, &def, &box));
    check_ok(mspring_network_remove_collider(network, other));
    for (int step = 1; step <= 16; step++) {
        check_ok(mspring_network_move_collider(network, box, 0.3, 5 - 0.18 * step, 0));
        support_steps(network, 1, DT);
    }
    assert_true(read_events(network) >= 1);
    assert_int_equal(events[0].kind, MSPRING_CONTACT_BEGAN);
    assert_int_equal(events[0].point, ball);
    assert_int_equal(events[0].a, MSPRING_NONE);
    assert_int_equal(events[0].b, MSPRING_NONE);
    assert_int_equal(events[0].collider, box);
    check_near(events[0].normal_y, -1, 1e-6);
    check_ok(mspring_network_place_collider(network, box, 2.5, 3, 0));
    (void)read_events(network);
    for (int step = 1; step <= 16; step++) {
        check_ok(mspring_network_move_collider(network, box, 2.5, 3 - 0.13 * step, 0.3));
        support_steps(network, 1, DT);
    }
    const uint32_t count = read_events(network);
    bool is_found = false;
    for (uint32_t i = 0; i < count; i++)
        is_found |= events[i].point == MSPRING_NONE && events[i].collider == box && events[i].a < 9 &&
                    events[i].kind == MSPRING_CONTACT_BEGAN && events[i].normal_y > 0.5;
    assert_true(is_found);
    check_ok(mspring_network_remove_collider(network, box));
    support_steps(network, 1, DT);
    const uint32_t last = read_events(network);
    assert_true(last >= 1);
    for (uint32_t i = 0; i < last; i++)
        assert_true(events[i].kind == MSPRING_CONTACT_ENDED);
    mspring_network_destroy(network);
    bodies_free(b);
}

/* ---------------------------------------------------------------------------------------------- going back */

/// Blocks that fall on each other and break.
static mspring_network *heap(mspring_simd level, uint32_t workers, uint32_t capacity) {
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_heap(b, 8, 2);
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.simd_level = level;
    def.worker_count = workers;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.4f, 0.2f));
    check_ok(support_reserve_contact_events(network, capacity));
    bodies_free(b);
    return network;
}

/// Step so often, and return a hash of all events; *count has how many.
static uint64_t hash_of_events(mspring_network *network, uint32_t steps, uint32_t *count) {
    uint64_t hash = 14695981039346656037u;
    *count = 0;
    for (uint32_t step = 0; step < steps; step++) {
        support_steps(network, 1, DT);
        const uint32_t read = read_events(network);
        *count += read;
        for (size_t i = 0; i < read * sizeof *events; i++)
            hash = (hash ^ ((const uint8_t *)events)[i]) * 1099511628211u;
    }
    return hash;
}

static void events_are_the_same_everywhere(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    uint64_t first = 0;
    for (uint32_t i = 0; i < level_count; i++)
        for (uint32_t workers = 1; workers <= 3; workers += 2) {
            uint32_t count;
            mspring_network *network = heap(levels[i], workers, 256);
            const uint64_t hash = hash_of_events(network, 120, &count);
            first = i == 0 && workers == 1 ? hash : first;
            assert_true(hash == first);
            assert_true(count > 30);
            mspring_network_destroy(network);
        }
}

/// Events change no bits of the motion.
static void events_are_watched_for_nothing(void **state) {
    (void)state;
    mspring_network *with = heap(MSPRING_SIMD_AUTO, 1, 16), *without = heap(MSPRING_SIMD_AUTO, 1, 0);
    for (int step = 0; step < 120; step++) {
        support_steps(with, 1, DT);
        support_steps(without, 1, DT);
        assert_true(support_hash(with) == support_hash(without));
    }
    assert_int_equal(read_events(without), 0);
    mspring_network_destroy(with);
    mspring_network_destroy(without);
}

/// A clone goes on with the same events. What is loaded begins nothing anew.
static void loads_and_clones_go_on(void **state) {
    (void)state;
    for (uint32_t saved_at = 20; saved_at < 110; saved_at += 15) {
        mspring_network *network = heap(MSPRING_SIMD_AUTO, 1, 256), *clone;
        uint32_t count, of_clone;
        (void)hash_of_events(network, saved_at, &count);
        check_ok(mspring_network_clone(network, NULL, &clone));
        saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
        const uint64_t hash = hash_of_events(network, 40, &count);
        assert_true(hash_of_events(clone, 40, &of_clone) == hash);
        assert_int_equal(count, of_clone);
        check_ok(mspring_network_load(network, frame.bytes, frame.size));
        assert_int_equal(read_events(network), 0);
        uint32_t loaded;
        (void)hash_of_events(network, 40, &loaded);
        // Pairs between 1 and 1.05 of the thickness apart may begin anew: 5 of 50 at most were seen.
        assert_true(loaded <= count + 8 && count <= loaded + 8);
        free(frame.bytes);
        mspring_network_destroy(network);
        mspring_network_destroy(clone);
    }
}

static void rest_that_is_loaded_begins_nothing(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    uint32_t ball;
    mspring_network *network = ball_above_rope(b, 0, -9.8f, 0, &ball);
    support_steps(network, 100, DT);
    assert_int_equal(read_events(network), 1);
    saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    check_ok(mspring_network_load(network, frame.bytes, frame.size));
    support_steps(network, 50, DT);
    assert_int_equal(read_events(network), 0);
    const float up = 5;
    check_ok(mspring_network_set_velocities(network, NULL, ball, 1, &up, &up, 0));
    support_steps(network, 10, DT);
    assert_int_equal(read_events(network), 1);
    assert_int_equal(events[0].kind, MSPRING_CONTACT_ENDED);
    free(frame.bytes);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// Steps that fail leave no events.
static void steps_that_fail_have_none(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    uint32_t ball;
    mspring_network *network = ball_above_rope(b, 0, 0, 0, &ball);
    b->vy[ball] = -4;
    check_ok(mspring_network_set_velocities(network, NULL, ball, 1, &b->vx[ball], &b->vy[ball], 1));
    for (int step = 0; step < 40; step++) {
        (void)read_events(network);
        saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
        check_ok(mspring_network_apply_force(network, ball, 0, -1e30f));
        assert_true(mspring_network_step(network, DT) != MSPRING_OK);
        assert_int_equal(read_events(network), 0);
        check_ok(mspring_network_load(network, frame.bytes, frame.size));
        free(frame.bytes);
        support_steps(network, 1, DT);
    }
    mspring_network_destroy(network);
    bodies_free(b);
}

/* ------------------------------------------------------------------------------------------- limits, errors */

/// The first contacts are followed, the others counted, the same each time.
static void what_has_no_room_is_counted(void **state) {
    (void)state;
    uint64_t lost[2] = {0, 0};
    uint64_t hash[2];
    for (int run = 0; run < 2; run++) {
        mspring_network *network = heap(MSPRING_SIMD_AUTO, 1, 4);
        uint32_t count;
        hash[run] = hash_of_events(network, 120, &count);
        assert_true(count >= 4);
        check_ok(mspring_network_read_contact_events(network, NULL, 0, &count, &lost[run]));
        assert_true(lost[run] > 4);
        mspring_network_destroy(network);
    }
    assert_true(lost[0] == lost[1] && hash[0] == hash[1]);
    mspring_network *network = heap(MSPRING_SIMD_AUTO, 1, 64);
    uint32_t count;
    uint64_t none = 7;
    (void)hash_of_events(network, 60, &count);
    check_ok(mspring_network_read_contact_events(network, NULL, 0, &count, &none));
    assert_true(none == 0 && count == 0);
    support_steps(network, 60, DT); // unread, and read in parts
    events[0].struct_size = sizeof events[0];
    do {
        check_ok(mspring_network_read_contact_events(network, events, 1, &count, &none));
        assert_true(count == 0 || events[0].kind <= MSPRING_CONTACT_ENDED);
    } while (count > 0);
    mspring_network_destroy(network);
}

static void bad_calls_are_rejected(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    uint32_t ball, count = 77;
    mspring_network *network = ball_above_rope(b, 0, 0, 0, &ball);
    check_error(support_reserve_contact_events(NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_read_contact_events(NULL, NULL, 0, &count, NULL), MSPRING_ERROR_ARGUMENT);
    const uint32_t too_many[] = {0x1000001, UINT32_MAX};
    for (size_t i = 0; i < COUNT_OF(too_many); i++) {
        check_error(support_reserve_contact_events(network, too_many[i]), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), i ? "event_capacity is 4294967295" : "16777217");
    }
    check_error(mspring_network_read_contact_events(network, NULL, 1, &count, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_read_contact_events(network, events, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    events[0].struct_size = 4;
    check_error(mspring_network_read_contact_events(network, events, 1, &count, NULL), MSPRING_ERROR_STRUCT);
    assert_int_equal(count, 77);
    check_ok(mspring_network_set_contact(network, NULL));
    check_error(mspring_network_read_contact_events(network, NULL, 0, &count, NULL), MSPRING_ERROR_ARGUMENT);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// A capacity is read back. Another one drops what waits, and another friction does not.
static void capacities_are_of_contact(void **state) {
    (void)state;
    mspring_network *network = heap(MSPRING_SIMD_AUTO, 1, 64), *plain = heap(MSPRING_SIMD_AUTO, 1, 0);
    mspring_contact_def def = mspring_contact_def_default();
    check_ok(mspring_network_get_contact(plain, &def));
    assert_int_equal(def.event_capacity, 0);
    check_ok(mspring_network_get_contact(network, &def));
    assert_int_equal(def.event_capacity, 64);
    support_steps(network, 60, DT);
    check_ok(mspring_network_set_contact(network, &def));
    assert_true(read_events(network) > 0);
    support_steps(network, 20, DT);
    mspring_network *clone;
    check_ok(mspring_network_clone(network, NULL, &clone));
    def.friction += 0.1f;
    check_ok(mspring_network_set_contact(network, &def));
    const uint32_t waiting = read_events(clone);
    assert_true(waiting > 0);
    assert_int_equal(read_events(network), waiting);
    support_steps(network, 20, DT);
    def.event_capacity = 65;
    check_ok(mspring_network_set_contact(network, &def));
    assert_int_equal(read_events(network), 0);
    mspring_network_destroy(network);
    mspring_network_destroy(plain);
    mspring_network_destroy(clone);
}

static void memory_is_given_back(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_clone_def clone_def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &clone_def, sizeof clone_def));
    clone_def.allocator = &allocator;
    mspring_network *from = heap(MSPRING_SIMD_AUTO, 1, 0), *network;
    check_ok(mspring_network_clone(from, &clone_def, &network));
    const size_t before = support_memory_used(network);
    for (size_t fail_at = 1; fail_at <= 2; fail_at++) {
        watched.fail_at = watched.calls + fail_at;
        check_error(support_reserve_contact_events(network, 100), MSPRING_ERROR_MEMORY);
        assert_int_equal(support_memory_used(network), before);
    }
    watched.fail_at = 0;
    check_ok(support_reserve_contact_events(network, 100));
    const size_t with = support_memory_used(network);
    check_ok(support_reserve_contact_events(network, 200));
    check_ok(support_reserve_contact_events(network, 100));
    assert_int_equal(support_memory_used(network), with);
    mspring_collider_def def;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = MSPRING_COLLIDER_BOX;
    def.x = 100;
    check_ok(mspring_network_add_collider(network, &def, NULL));
    support_steps(network, 60, DT);
    assert_true(read_events(network) > 0);
    const size_t calls = watched.calls;
    support_steps(network, 60, DT);
    assert_int_equal(watched.calls, calls);
    assert_true(with > before + 100 * sizeof *events);
    check_ok(support_reserve_contact_events(network, 0));
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    mspring_network_destroy(from);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ball_begins_and_ends),           cmocka_unit_test(what_rests_or_slides_begins_once),
        cmocka_unit_test(sleepers_stay_in_contact),       cmocka_unit_test(colliders_have_events),
        cmocka_unit_test(events_are_the_same_everywhere), cmocka_unit_test(events_are_watched_for_nothing),
        cmocka_unit_test(loads_and_clones_go_on),         cmocka_unit_test(rest_that_is_loaded_begins_nothing),
        cmocka_unit_test(steps_that_fail_have_none),      cmocka_unit_test(what_has_no_room_is_counted),
        cmocka_unit_test(bad_calls_are_rejected),         cmocka_unit_test(capacities_are_of_contact),
        cmocka_unit_test(memory_is_given_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
