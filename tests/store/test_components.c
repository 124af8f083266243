/// @file test_components.c
/// Components: the same as a plain union-find over the springs finds, whatever is broken and restored in which
/// order; and the events tell what became of each.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

enum { CAPACITY = 4096 };

/// A network with springs in rows of every kind, holes, and loose particles.
static recipe mixed_recipe(uint64_t seed) {
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {500, 1000}, .pinned = 0.02, .holes = 0.3};
    recipe made = {0};
    const uint32_t width = 5 + (uint32_t)(support_random(&seed) % 60),
                   height = 2 + (uint32_t)(support_random(&seed) % 9);
    recipe_lattice(&made, width, height, 0, 0, 1, &stuff, &seed);
    recipe_lattice(&made, 18, 4, 100, 0, 1, &stuff, &seed);
    const mspring_id end = recipe_particle(&made, 60, 40, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 2, end, 30, &stuff, &seed);
    recipe_random_springs(&made, 8, &stuff, &seed);
    for (int i = 0; i < 20; i++) {
        recipe_particle(&made, i * 3, -20, 1, 0);
    }
    recipe_disturb(&made, 0.05, 1, &seed);
    recipe_shuffle(&made, &seed, NULL);
    return made;
}

static mspring_network *network_of(const recipe *made) {
    mspring_network_def def = support_def(-9.8f, 2);
    mspring_network *network = recipe_network(made, &def);
    check_ok(mspring_network_reserve_events(network, CAPACITY));
    return network;
}

/// The plain way: each particle's head is the lowest particle that it hangs together with.
static void find_heads(const recipe *made, const bool *broken, mspring_id *head) {
    for (mspring_id p = 0; p < made->particle_count; p++) {
        head[p] = p;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (mspring_id s = 0; s < made->spring_count; s++) {
            const mspring_id a = made->springs[s].a, b = made->springs[s].b;
            if (!broken[s] && head[a] != head[b]) {
                const mspring_id lower = head[a] < head[b] ? head[a] : head[b];
                head[a] = head[b] = lower;
                changed = true;
            }
        }
    }
}

/// The network's components are these.
static void check_components(const mspring_network *network, const recipe *made, const mspring_id *head,
                             uint32_t count) {
    uint32_t *number = malloc(made->particle_count * sizeof *number);
    mspring_body *components = calloc(count, sizeof *components);
    assert_true(number && components);
    for (uint32_t i = 0; i < count; i++) {
        components[i].struct_size = sizeof *components;
    }
    check_ok(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0, made->particle_count, number, 1));
    check_ok(mspring_network_get_components(network, 0, count, components));
    uint32_t heads = 0, particles = 0;
    for (mspring_id p = 0; p < made->particle_count; p++) {
        assert_int_equal(components[number[p]].head, head[p]);
        if (head[p] == p) {
            assert_int_equal(number[p], heads++); // numbered in the order of the heads
        }
    }
    assert_int_equal(heads, count);
    for (uint32_t i = 0; i < count; i++) {
        particles += components[i].particle_count;
    }
    assert_int_equal(particles, made->particle_count);
    free(number);
    free(components);
}

/// What the events should be: heads that are new, and heads that are gone.
static void check_events(mspring_network *network, const recipe *made, const mspring_id *before,
                         const mspring_id *after) {
    static mspring_event events[CAPACITY];
    uint32_t count;
    uint64_t lost;
    check_ok(mspring_network_read_events(network, events, CAPACITY, &count, &lost));
    assert_int_equal(lost, 0);
    uint32_t next = 0;
    for (mspring_id p = 0; p < made->particle_count; p++) {
        const bool was = before[p] == p, is = after[p] == p;
        if (was == is) {
            continue;
        }
        while (next < count && events[next].kind != MSPRING_EVENT_SPLIT &&
               events[next].kind != MSPRING_EVENT_JOINED) {
            next++;
        }
        assert_true(next < count);
        assert_int_equal(events[next].kind, is ? MSPRING_EVENT_SPLIT : MSPRING_EVENT_JOINED);
        assert_int_equal(events[next].id, p);
        assert_int_equal(events[next].other, is ? before[p] : after[p]);
        next++;
    }
    for (; next < count; next++) {
        assert_true(events[next].kind == MSPRING_EVENT_BROKEN || events[next].kind == MSPRING_EVENT_RESTORED);
    }
}

static void components_are_those_of_a_plain_search(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        uint64_t random = seed * 977;
        recipe made = mixed_recipe(seed);
        mspring_network *network = network_of(&made);
        bool *broken = calloc(made.spring_count, sizeof *broken);
        mspring_id *head = malloc(made.particle_count * sizeof *head),
                   *before = malloc(made.particle_count * sizeof *head);
        assert_true(broken && head && before);
        find_heads(&made, broken, before);
        uint32_t count, changed, unchanged_updates = 0;
        check_ok(mspring_network_update_components(network, &count, &changed));
        assert_int_equal(changed, 1);
        check_components(network, &made, before, count);
        check_events(network, &made, before, before);
        for (int round = 0; round < 30; round++) {
            // A few, or many, are broken or restored, sometimes the same more than once.
            const uint32_t some =
                round % 3 == 0 ? 1 : (uint32_t)(support_random(&random) % (round % 3 == 1 ? 12 : 300));
            for (uint32_t i = 0; i < some; i++) {
                const mspring_id s = (mspring_id)(support_random(&random) % made.spring_count);
                broken[s] = support_random(&random) % 3 != 0;
                check_ok(broken[s] ? mspring_network_break_springs(network, &s, 0, 1)
                                   : mspring_network_restore_springs(network, &s, 0, 1, 0));
            }
            find_heads(&made, broken, head);
            bool same = true;
            for (mspring_id p = 0; p < made.particle_count; p++) {
                same = same && head[p] == before[p];
            }
            check_ok(mspring_network_update_components(network, &count, &changed));
            // Numbers may change though the heads do not; never the other way round.
            assert_true(same ? changed == 0 : changed == 1);
            unchanged_updates += same;
            check_components(network, &made, head, count);
            check_events(network, &made, before, head);
            check_ok(mspring_network_update_components(network, NULL, &changed));
            assert_int_equal(changed, 0);
            mspring_id *const other = head;
            head = before;
            before = other;
        }
        assert_true(unchanged_updates > 0 && unchanged_updates < 30);
        free(broken);
        free(head);
        free(before);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void a_bar_cut_in_two_is_two_and_joined_again_one(void **state) {
    (void)state;
    // 20 x 5, masses of 1 and 3 kg to the left and right of the cut, which move apart.
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {500, 500}};
    recipe made = {0};
    recipe_lattice(&made, 20, 5, 10000, -3000, 1, &stuff, &seed);
    for (mspring_id p = 0; p < made.particle_count; p++) {
        const bool right = p % 20 >= 8;
        made.particles[p].mass = right ? 3 : 1;
        made.particles[p].vx = right ? 2 : -1;
        made.particles[p].vy = right ? 0.5f : 0;
    }
    mspring_network *network = network_of(&made);
    mspring_id cut[100];
    uint32_t cut_count = 0;
    for (mspring_id s = 0; s < made.spring_count; s++) {
        const uint32_t a = made.springs[s].a % 20, b = made.springs[s].b % 20;
        if ((a == 7 && b == 8) || (a == 8 && b == 7)) {
            cut[cut_count++] = s;
        }
    }
    assert_int_equal(cut_count, 5 + 2 * 4);
    uint32_t count;
    mspring_body parts[2] = {{.struct_size = sizeof parts[0]}, {.struct_size = sizeof parts[0]}};
    check_ok(mspring_network_update_components(network, &count, NULL));
    assert_int_equal(count, 1);
    check_ok(mspring_network_get_components(network, 0, 1, parts));
    assert_true(parts[0].mass == 40 + 180 && parts[0].particle_count == 100 && parts[0].reserved == 0);
    check_ok(mspring_network_break_springs(network, cut, 0, cut_count));
    check_ok(mspring_network_update_components(network, &count, NULL));
    assert_int_equal(count, 2);
    check_ok(mspring_network_get_components(network, 0, 2, parts));
    assert_true(parts[0].head == 0 && parts[1].head == 8);
    assert_true(parts[0].mass == 40 && parts[1].mass == 180);
    check_near(parts[0].x, 10003.5, 1e-9);
    check_near(parts[1].x, 10013.5, 1e-9);
    check_near(parts[0].y, -2998, 1e-9);
    assert_true(parts[0].px == -40 && parts[1].px == 360 && parts[0].py == 0 && parts[1].py == 90);
    check_ok(mspring_network_get_components(network, 1, 1, parts)); // the second alone
    assert_true(parts[0].head == 8 && parts[0].mass == 180);
    // One of the first's 40 particles goes 10 m up and 20 m to the left, held and with the velocity that it had.
    const double x = 10000 - 20, y = -3000 + 10;
    const float held = 0;
    check_ok(mspring_network_set_positions(network, NULL, 0, 1, &x, &y, 1));
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, 1, &held, 1));
    check_ok(mspring_network_get_components(network, 0, 1, parts)); // the first alone
    assert_true(parts[0].head == 0 && parts[0].mass == 40 && parts[1].mass == 180);
    check_near(parts[0].x, 10003.5 - 20.0 / 40, 1e-9);
    check_near(parts[0].y, -2998 + 10.0 / 40, 1e-9);
    assert_true(parts[0].px == -39 && parts[0].py == 0);
    mspring_event events[50];
    uint32_t event_count;
    check_ok(mspring_network_read_events(network, events, 50, &event_count, NULL));
    assert_int_equal(event_count, cut_count + 1);
    assert_int_equal(events[cut_count].kind, MSPRING_EVENT_SPLIT);
    assert_int_equal(events[cut_count].id, 8);
    assert_int_equal(events[cut_count].other, 0);

    check_ok(mspring_network_restore_springs(network, cut + 6, 0, 1, 1));
    check_ok(mspring_network_update_components(network, &count, NULL));
    assert_int_equal(count, 1);
    check_ok(mspring_network_read_events(network, events, 50, &event_count, NULL));
    assert_int_equal(event_count, 2);
    assert_int_equal(events[1].kind, MSPRING_EVENT_JOINED);
    assert_int_equal(events[1].id, 8);
    assert_int_equal(events[1].other, 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void more_changes_than_the_log_holds_are_no_harm(void **state) {
    (void)state;
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {500, 500}};
    recipe made = {0};
    recipe_lattice(&made, 60, 30, 0, 0, 1, &stuff, &seed); // over 4096 springs
    mspring_network *network = network_of(&made);
    uint32_t count;
    check_ok(mspring_network_update_components(network, &count, NULL));
    for (mspring_id s = 0; s < made.spring_count; s++) {
        check_ok(mspring_network_break_springs(network, &s, 0, 1));
    }
    check_ok(mspring_network_update_components(network, &count, NULL));
    assert_int_equal(count, made.particle_count);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void bad_requests_are_refused(void **state) {
    (void)state;
    recipe made = mixed_recipe(3);
    mspring_network *network = network_of(&made);
    uint32_t number = 77, count;
    mspring_body part = {.struct_size = sizeof part};
    check_error(mspring_network_update_components(NULL, &count, NULL), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0, 1, &number, 1));
    assert_int_equal(number, MSPRING_NONE); // no update yet
    number = 77;
    check_error(mspring_network_get_components(network, 0, 1, &part), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_update_components(network, &count, NULL));
    check_error(mspring_network_get_integers(NULL, MSPRING_COMPONENT, NULL, 0, 1, &number, 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0, 1, NULL, 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, made.particle_count, 1, &number, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 1, MSPRING_ALL - 1, &number, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 1, MSPRING_ALL, &number, 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_components(network, 0, MSPRING_ALL - 1, &part), MSPRING_ERROR_ID);
    check_error(mspring_network_get_components(NULL, 0, 1, &part), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_components(network, 0, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_components(network, count, 1, &part), MSPRING_ERROR_ID);
    check_error(mspring_network_get_components(network, MSPRING_NONE, 1, &part), MSPRING_ERROR_ID);
    part.struct_size--;
    check_error(mspring_network_get_components(network, 0, 1, &part), MSPRING_ERROR_STRUCT);
    assert_true(number == 77 && part.mass == 0);
    check_ok(mspring_network_get_components(network, count, 0, NULL));
    check_ok(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, made.particle_count, 0, NULL, 1));
    check_error(
        mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, made.particle_count + 1, 0, &number, 1),
        MSPRING_ERROR_ID);
    check_ok(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0, 1, &number, 1));
    assert_int_equal(number, 0); // that of the lowest particle
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void the_first_update_survives_every_failure(void **state) {
    (void)state;
    recipe made = mixed_recipe(4);
    size_t fail_at = 1;
    uint32_t expected = 0;
    for (bool failed = true; failed; fail_at++) {
        watched_allocator watched = {0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        watched.fail_at = watched.calls + fail_at;
        const size_t used = support_memory_used(network);
        uint32_t count = 77;
        mspring_result result = mspring_network_update_components(network, &count, NULL);
        failed = result != MSPRING_OK;
        if (failed) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_int_equal(count, 77);
            assert_true(support_memory_used(network) == used);
            check_ok(mspring_network_update_components(network, &count, NULL));
        }
        expected = fail_at == 1 ? count : expected;
        assert_int_equal(count, expected);
        const size_t calls = watched.calls;
        check_ok(mspring_network_update_components(network, &count, NULL));
        assert_int_equal(watched.calls, calls);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    assert_true(fail_at > 8);
    recipe_free(&made);
}

// None is as good a number as another.
static void where_all_particles_are_removed_there_is_no_component(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id only = support_particle(builder, 0, 0, 1);
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    uint32_t count = 7, changed = 7, number = 7;
    check_ok(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0, 1, &number, 1));
    assert_int_equal(number, MSPRING_NONE);
    number = 7;
    check_ok(mspring_network_remove_particles(network, &only, 0, 1));
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_update_components(network, &count, &changed));
        assert_int_equal(count, 0);
        assert_int_equal(changed, i == 0);
        check_ok(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0, 1, &number, 1));
        assert_int_equal(number, MSPRING_NONE);
        check_ok(mspring_network_get_components(network, 0, 0, NULL));
    }
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(components_are_those_of_a_plain_search),
        cmocka_unit_test(a_bar_cut_in_two_is_two_and_joined_again_one),
        cmocka_unit_test(more_changes_than_the_log_holds_are_no_harm),
        cmocka_unit_test(bad_requests_are_refused),
        cmocka_unit_test(the_first_update_survives_every_failure),
        cmocka_unit_test(where_all_particles_are_removed_there_is_no_component),
    };
    return cmocka_run_group_tests_name("components", tests, NULL, NULL);
}
