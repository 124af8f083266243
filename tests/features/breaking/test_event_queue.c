/// @file test_event_queue.c
/// The queue of events: its order, its length, and what it loses.
///
/// SPDX-License-Identifier: MIT
#include "allocator.h"
#include "recipe.h"
#include "support.h"

/// A lattice.
static recipe block_recipe(void) {
    uint64_t seed = 31;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {500, 1000}, .damping = {0, 2}};
    recipe made = {0};
    recipe_lattice(&made, 37, 9, 0, 0, 1, &stuff, &seed);
    return made;
}

static void a_full_queue_counts_what_it_loses(void **state) {
    (void)state;
    recipe made = block_recipe();
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = recipe_network(&made, &def);
    check_ok(mspring_network_reserve_events(network, 10));
    mspring_event events[20];
    uint32_t count = 77;
    uint64_t lost = 77;
    check_ok(mspring_network_read_events(network, NULL, 0, &count, &lost));
    assert_true(count == 0 && lost == 0);
    // Written and read in portions that do not divide its size, so that it goes around.
    mspring_id next_in = 0, next_out = 0;
    for (int round = 0; round < 20; round++) {
        for (int i = 0; i < 7; i++) {
            const mspring_id id = next_in++;
            check_ok(mspring_network_break_springs(network, &id, 0, 1));
        }
        check_ok(mspring_network_read_events(network, events, 3, &count, &lost));
        assert_int_equal(count, 3);
        for (uint32_t e = 0; e < count; e++) {
            assert_int_equal(events[e].id, next_out++);
            assert_int_equal(events[e].kind, MSPRING_EVENT_BROKEN);
            assert_true(events[e].strain == 0 && events[e].other == MSPRING_NONE);
        }
        check_ok(mspring_network_read_events(network, events, 20, &count, &lost));
        assert_int_equal(count, 4);
        for (uint32_t e = 0; e < count; e++) {
            assert_int_equal(events[e].id, next_out++);
        }
        assert_int_equal(lost, 0);
    }
    // The oldest stay, the newest are lost.
    mspring_id ids[25];
    for (uint32_t i = 0; i < 25; i++) {
        ids[i] = next_in + i;
    }
    check_ok(mspring_network_break_springs(network, ids, 0, 25));
    check_ok(mspring_network_read_events(network, events, 20, &count, &lost));
    assert_true(count == 10 && lost == 15 && events[0].id == ids[0] && events[9].id == ids[9]);
    // No queue, no events, and none lost.
    check_ok(mspring_network_reserve_events(network, 0));
    check_ok(mspring_network_restore_springs(network, ids, 0, 25, 0));
    check_ok(mspring_network_read_events(network, events, 20, &count, &lost));
    assert_true(count == 0 && lost == 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void a_queue_may_be_as_short_or_as_long_as_is_said(void **state) {
    (void)state;
    recipe made = block_recipe();
    watched_allocator watched = {0};
    mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def(-9.8f, 4);
    def.allocator = &allocator;
    mspring_network *network = recipe_network(&made, &def);
    const mspring_id ids[] = {7, 8, 9};
    mspring_event events[2];
    uint32_t count;
    uint64_t lost;
    // One of one holds the first that happens, again and again.
    check_ok(mspring_network_reserve_events(network, 1));
    for (uint32_t round = 0; round < 3; round++) {
        check_ok(mspring_network_break_springs(network, ids, 0, 3));
        check_ok(mspring_network_read_events(network, events, 2, &count, &lost));
        assert_true(count == 1 && events[0].id == 7 && lost == 3 * round + 2);
        check_ok(mspring_network_restore_springs(network, ids + 1, 0, 2, 0));
        check_ok(mspring_network_read_events(network, events, 2, &count, &lost));
        assert_true(count == 1 && events[0].id == 8 && events[0].kind == MSPRING_EVENT_RESTORED);
        check_ok(mspring_network_restore_springs(network, ids, 0, 1, 0));
        check_ok(mspring_network_read_events(network, events, 2, &count, NULL));
        assert_int_equal(count, 1);
    }
    // None takes no memory.
    const size_t with_one = support_memory_used(network), calls = watched.calls;
    check_ok(mspring_network_reserve_events(network, 0));
    assert_int_equal(watched.calls, calls);
    assert_true(support_memory_used(network) < with_one);
    // The longest that may be asked for is not refused by its length: it is memory that lacks.
    watched.fail_at = watched.calls + 1;
    check_error(mspring_network_reserve_events(network, MSPRING_MAX_SPRINGS), MSPRING_ERROR_MEMORY);
    watched.fail_at = watched.calls + 1;
    check_error(mspring_network_reserve_events(network, 1), MSPRING_ERROR_MEMORY);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    recipe_free(&made);
}

static void detachment_is_told_spring_by_spring(void **state) {
    (void)state;
    recipe made = block_recipe();
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = recipe_network(&made, &def);
    const mspring_id particle = 100;
    check_ok(mspring_network_reserve_events(network, 20));
    uint32_t expected = 0;
    for (mspring_id s = 0; s < made.spring_count; s++) {
        expected += made.springs[s].a == particle || made.springs[s].b == particle;
    }
    check_ok(mspring_network_detach_particles(network, &particle, 0, 1));
    check_ok(mspring_network_detach_particles(network, &particle, 0, 1)); // it has no spring left to break
    mspring_event events[20];
    uint32_t count;
    check_ok(mspring_network_read_events(network, events, 20, &count, NULL));
    assert_true(expected >= 6);
    assert_int_equal(count, expected + 2);
    for (uint32_t e = 0; e < expected; e++) {
        assert_int_equal(events[e].kind, MSPRING_EVENT_BROKEN);
        assert_int_equal(events[e].other, particle);
        assert_true(e == 0 || events[e].id > events[e - 1].id);
    }
    for (uint32_t e = expected; e < count; e++) {
        assert_int_equal(events[e].kind, MSPRING_EVENT_DETACHED);
        assert_int_equal(events[e].id, particle);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_queue_counts_what_it_loses),
        cmocka_unit_test(a_queue_may_be_as_short_or_as_long_as_is_said),
        cmocka_unit_test(detachment_is_told_spring_by_spring),
    };
    return cmocka_run_group_tests_name("event_queue", tests, NULL, NULL);
}
