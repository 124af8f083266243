/// @file test_contact_limits.c
/// Contact where springs join all to all, or where all lie in one place: the work is counted, and what takes too
/// much of it is refused and changes nothing.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "allocator.h"
#include "support.h"

#include "features/contact/contacts.h"

/// Whether springs join two particles.
typedef bool (*joins)(uint32_t a, uint32_t b);

static bool joins_all(uint32_t a, uint32_t b) {
    return a != b;
}

static bool joins_sides(uint32_t a, uint32_t b) {
    return a % 2 != b % 2;
}

static bool joins_hub(uint32_t a, uint32_t b) {
    return a == 0 || b == 0;
}

// On a circle, or on a line.
static mspring_network *graph(uint32_t count, joins is_joined, bool is_round) {
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < count; i++) {
        const double angle = 2 * 3.14159265358979 * i / count;
        (void)support_particle(builder, is_round ? 10 * cos(angle) : 0.25 * i, is_round ? 10 * sin(angle) : 0, 1);
    }
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = 0; j < i; j++)
            if (is_joined(i, j))
                (void)support_spring(builder, i, j, 10, 0);
    const mspring_network_def def = support_def(0, 4);
    return support_network(builder, &def);
}

static mspring_result touch(mspring_network *network, double thickness) {
    mspring_contact_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def));
    def.thickness = thickness;
    return mspring_network_set_contact(network, &def);
}

static uint32_t edges_of(const mspring_network *network) {
    mspring_contact_info info = {.struct_size = sizeof info};
    check_ok(mspring_network_get_contact_info(network, &info));
    return info.edges;
}

// The fourth power of 200 is 1.6e9. Tries that go around in turn find both sides of a spring over k particles
// within about count / k tries: count^2 log count / 2 in all, 106,000; of those on the hull, one after the other,
// count each.
static void cliques_take_few_tries(void **state) {
    (void)state;
    mspring_network *network = graph(200, joins_all, true);
    check_ok(touch(network, 0.05));
    assert_int_equal(edges_of(network), 200);
    assert_true(network->contacts->outline.tries < 4 * 106000);
    mspring_network_destroy(network);
}

// No triangle has both sides, so each spring takes as many tries as an end has springs.
static void graphs_without_triangles_are_counted(void **state) {
    (void)state;
    mspring_network *network = graph(200, joins_sides, true);
    check_ok(touch(network, 0.05));
    assert_int_equal(edges_of(network), 10000);
    assert_int_equal(network->contacts->outline.tries, 100 * 10000);
    mspring_network_destroy(network);
    network = graph(600, joins_sides, true); // 27 million tries, 20 million are allowed
    const uint64_t hash = support_hash(network);
    check_error(touch(network, 0.05), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "particle 0 has 300 springs");
    assert_true(support_hash(network) == hash && !network->contacts);
    check_ok(mspring_network_step(network, 0.001));
    mspring_network_destroy(network);
}

// Each point of a star is joined by two springs to all others: that is asked without going through all springs.
static void stars_are_looked_at(void **state) {
    (void)state;
    mspring_network *network = graph(1500, joins_hub, true);
    check_ok(touch(network, 0.005));
    check_ok(mspring_network_step(network, 0.001));
    assert_int_equal(network->contacts->count, 0);
    mspring_network_destroy(network);
}

// The other end of a break is looked at once, however many springs of a hub break at a time: the outline is that of
// a network which contact comes to now.
static void breaks_leave_the_outline_right(void **state) {
    (void)state;
    for (uint32_t kind = 0; kind < 3; kind++) {
        const joins is_joined = kind == 0 ? joins_all : kind == 1 ? joins_sides : joins_hub;
        mspring_network *network = graph(40, is_joined, true), *fresh = graph(40, is_joined, true);
        const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
        check_ok(touch(network, 0.05));
        for (uint32_t round = 0; round < 4; round++) {
            uint64_t seed = 100 * kind + round;
            for (uint32_t i = 0; i < (round % 2 ? count / 5 : 1); i++) { // all springs are judged, or those nearby
                const mspring_id spring = (mspring_id)(support_random(&seed) % count);
                const bool breaks = support_random(&seed) % 4 > 0;
                for (uint32_t k = 0; k < 2; k++) {
                    mspring_network *one = k ? fresh : network;
                    check_ok(breaks ? mspring_network_break_springs(one, &spring, 0, 1)
                                    : mspring_network_restore_springs(one, &spring, 0, 1, 0));
                }
            }
            check_ok(touch(fresh, 0.05));
            mspringi_outline_update(network, network->contacts);
            assert_memory_equal(network->contacts->outline.is_edge, fresh->contacts->outline.is_edge, count);
            check_ok(mspring_network_set_contact(fresh, NULL));
        }
        mspring_network_destroy(network);
        mspring_network_destroy(fresh);
    }
}

// All springs of a clique may have changed where one of its particles has left it: each is judged once, from lists
// that are made once.
static void cliques_are_judged_as_a_whole(void **state) {
    (void)state;
    const mspring_id first = 0;
    mspring_network *network = graph(120, joins_all, true);
    check_ok(touch(network, 0.005));
    check_ok(mspring_network_detach_particles(network, &first, 0, 1));
    mspringi_outline_update(network, network->contacts);
    assert_true(network->contacts->outline.tries < 20 * 120 * 120); // log2(120) is 7; n^3 / 2 is 864,000
    mspring_network_destroy(network);
}

// All springs are near all points, and joined to them: there is no pair to run out of room for.
static void comparisons_are_counted(void **state) {
    (void)state;
    mspring_network *network = graph(300, joins_all, false);
    check_ok(touch(network, 0.2));
    const uint64_t hash = support_hash(network);
    check_error(mspring_network_step(network, 0.001), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "comparisons of outline points and edges");
    // One list more is begun than is allowed, of at most all springs around one point.
    assert_true(network->contacts->work <= network->contacts->most_work + 2 * 44850);
    assert_true(support_hash(network) == hash);
    check_ok(mspring_network_set_contact(network, NULL));
    check_ok(mspring_network_step(network, 0.001));
    mspring_network_destroy(network);
}

// The two hubs have the same points, and their springs take turns: each pair looks at all edges of a hub once more.
static mspring_network *two_hubs(uint32_t tips, uint32_t pebbles) {
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < 2 + tips; i++) {
        const double angle = 2 * 3.14159265358979 * i / tips;
        (void)support_particle(builder, i < 2 ? 0.04 * i : 10 * cos(angle), i < 2 ? 0 : 10 * sin(angle), 1);
    }
    for (uint32_t i = 2; i < 2 + tips; i++)
        for (uint32_t hub = 0; hub < 2; hub++)
            (void)support_spring(builder, hub, i, 10, 0);
    for (uint32_t i = 0; i < pebbles; i++)
        (void)support_particle(builder, 0.02, 0.001 * (i + 1), 1);
    const mspring_network_def def = support_def(0, 4);
    return support_network(builder, &def);
}

// What is refused names the hub, takes no more work than it may, and leaves the network as it was.
static void check_refusal(mspring_network *network, mspring_id hub) {
    char text[40];
    const uint64_t hash = support_hash(network);
    check_error(mspring_network_step(network, 0.001), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "comparisons of outline points and edges");
    snprintf(text, sizeof text, "at particle %u)", (unsigned)hub);
    check_contains(mspring_network_error(network), text);
    assert_int_equal(support_step_info(network).particle, hub);
    assert_true(network->contacts->work <= network->contacts->most_work + 30000); // the comparisons of one point
    assert_true(support_hash(network) == hash);
    check_error(mspring_network_step(network, 0.001), MSPRING_ERROR_LIMIT);
    assert_true(network->contacts->work <= network->contacts->most_work + 30000); // nothing is left of the first
    check_ok(mspring_network_set_contact(network, NULL));
    check_ok(mspring_network_step(network, 0.001));
    mspring_network_destroy(network);
}

static void hubs_are_counted(void **state) {
    (void)state;
    mspring_network *network = two_hubs(1000, 20); // 40,000 pairs at 1,000 edges each
    check_ok(touch(network, 0.05));
    check_refusal(network, 0);
    network = graph(4000, joins_hub, false); // on a line: all springs pass by all points
    check_ok(touch(network, 0.05));
    check_refusal(network, 0);
}

// Rods that lie across each other: active sets and intervals took thousands of solutions, and steps were refused. The
// work of a step bounds them (test_iteration_limit), so nothing is.
static void heaps_of_rods_are_not_refused(void **state) {
    (void)state;
    for (uint32_t solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_builder *builder = support_builder();
        uint64_t seed = 1;
        for (mspring_id i = 0; i < 90; i++) {
            const double x = support_random_between(&seed, 0, 3), y = support_random_between(&seed, 0, 3),
                         angle = support_random_between(&seed, 0, 6.28);
            (void)support_particle(builder, x, y, 1);
            (void)support_particle(builder, x + cos(angle), y + sin(angle), 1);
            (void)support_spring(builder, 2 * i, 2 * i + 1, 1e6, 1);
        }
        mspring_network_def def = support_def(-9.8f, 1);
        def.settings.solver = (mspring_solver)solver;
        def.settings.guard = support_guard_of(def.settings.solver);
        mspring_network *network = support_network(builder, &def);
        check_ok(touch(network, 0.2));
        check_ok(mspring_network_step(network, 1.0 / 60));
        mspring_network_destroy(network);
    }
}

// Spokes that touch nothing, or a pebble at the rim: hubs cost their springs once, and nothing is refused.
static void hubs_at_rest_are_no_burden(void **state) {
    (void)state;
    static const uint32_t counts[] = {66, 100, 180, 301};
    for (uint32_t solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        for (uint32_t i = 0; i < COUNT_OF(counts); i++) {
            mspring_network *network = i % 2 ? graph(counts[i], joins_hub, true) : two_hubs(counts[i], i / 2);
            mspring_settings def;
            check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
            def.solver = (mspring_solver)solver;
            check_ok(support_set_solver(network, &def));
            check_ok(touch(network, 0.02));
            for (uint32_t step = 0; step < 20; step++) {
                check_ok(mspring_network_step(network, 1.0 / 60));
                assert_true(network->contacts->work < network->contacts->most_work * 3 / 4);
            }
            mspring_network_destroy(network);
        }
}

// Rods that have one end in the same place: all pairs have room, their constraints have not. From then on nothing
// is compared or pushed. (In a star of 2,000 springs the rest of a step of the direct solver took 17 s.)
static void refused_steps_end_their_work(void **state) {
    (void)state;
    for (uint32_t solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_builder *builder = support_builder();
        uint64_t seed = 5;
        for (uint32_t i = 0; i < 60; i++) {
            const double angle = support_random_between(&seed, 0, 6.28), x = support_random_between(&seed, 0, 0.1);
            (void)support_particle(builder, x, 0, 1);
            (void)support_particle(builder, x + cos(angle), sin(angle), 1);
            (void)support_spring(builder, 2 * i, 2 * i + 1, 100, 0);
        }
        mspring_network_def def = support_def(0, 4);
        def.settings.solver = (mspring_solver)solver;
        def.settings.guard = support_guard_of(def.settings.solver);
        mspring_network *network = support_network(builder, &def);
        mspring_contact_def contact;
        check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
        contact.capacity = contact.max_capacity = 8000;
        check_ok(mspring_network_set_contact(network, &contact));
        const uint64_t hash = support_hash(network);
        check_error(mspring_network_step(network, 0.001), MSPRING_ERROR_LIMIT);
        check_contains(mspring_network_error(network), "may touch each other");
        assert_int_equal(network->contacts->constraint_count, 0);
        assert_true(support_hash(network) == hash);
        mspring_network_destroy(network);
    }
}

// Crosses that all lie in one place, in an order of ids that cells do not have.
static void crowds_end_at_the_first_pair_too_many(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    uint64_t seed = 5;
    for (uint32_t i = 0; i < 2000; i++) {
        const double angle = support_random_between(&seed, 0, 6.28), x = support_random_between(&seed, 0, 0.1);
        (void)support_particle(builder, x, 0, 1);
        (void)support_particle(builder, x + cos(angle), sin(angle), 1);
        (void)support_spring(builder, 2 * i, 2 * i + 1, 100, 0);
    }
    const mspring_network_def def = support_def(0, 4);
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.2;
    contact.capacity = contact.max_capacity = 300000;
    check_ok(mspring_network_set_contact(network, &contact));
    const uint64_t hash = support_hash(network);
    check_error(mspring_network_step(network, 0.001), MSPRING_ERROR_LIMIT);
    check_contains(mspring_network_error(network), "larger max_capacity");
    // Two lists, one of them with a larger reach. At least every third edge that a point is compared with is a
    // pair.
    assert_true(network->contacts->work < 2 * 4 * (uint64_t)network->contacts->capacity);
    assert_true(support_hash(network) == hash);
    for (uint32_t i = 1; i < network->contacts->count; i++) {
        const mspringi_pair *pair = &network->contacts->list[i];
        assert_true(pair[-1].point < pair->point || (pair[-1].point == pair->point && pair[-1].edge < pair->edge));
    }
    mspring_network_destroy(network);
}

/// A step that lacks room for pairs and cannot have it fails for that reason, and succeeds when there is memory.
static void room_for_pairs_may_fail(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < 20; i++)
        (void)support_particle(builder, 0.01 * (i % 10), 0.01 * (i / 10), 1);
    mspring_network_def def = support_def(0, 4);
    def.allocator = &allocator;
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.2;
    contact.capacity = 100;
    check_ok(mspring_network_set_contact(network, &contact));
    const uint64_t hash = support_hash(network);
    watched.fail_at = watched.calls + 1;
    check_error(mspring_network_step(network, 0.001), MSPRING_ERROR_MEMORY);
    check_contains(mspring_network_error(network), "no memory for 200 pairs");
    assert_true(support_hash(network) == hash);
    watched.fail_at = 0;
    check_ok(mspring_network_step(network, 0.001));
    mspring_network_destroy(network);
    check_watched_clean(&watched);
}

/// 24 columns of 100 particles collapse between two walls. Overlaps that no sweeps could resolve were taken in 64
/// intervals each, which was too much work for a step.
static void tall_pits_are_not_refused(void **state) {
    (void)state;
    enum { COLUMNS = 24 };
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < COLUMNS * 100; i++)
        (void)support_particle(builder, -0.3 * COLUMNS + 0.6 * (i % COLUMNS) + 0.01 * (i % 7),
                               0.3 + 0.6 * (i / COLUMNS), 800);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = support_network(builder, &def);
    const double planes[3][4] = {{0, 0, 0, 1}, {-9, 0, 1, 0}, {9, 0, -1, 0}};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = planes[0];
    floor.plane_count = 3;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(touch(network, 0.5));
    for (int step = 0; step < 200; step++) {
        mspring_contact_info info = {.struct_size = sizeof info};
        support_steps(network, 1, 1.0 / 64);
        check_ok(mspring_network_get_contact_info(network, &info));
        assert_true(info.deepest <= 0.15 * 0.5);
    }
    mspring_network_destroy(network);
}

/// Two walls close on a heap of 600 particles of 1:30 in mass, from 20 to 12 m. Where sweeps left them too deep, up to
/// 64 intervals were tried, each with as many sweeps, and such heaps ended with LIMIT (26 of 30, of 600 to 1,500
/// particles). A step takes up to 0.6e6 comparisons; the bound is three times that.
static void walls_close_on_heaps(void **state) {
    (void)state;
    for (uint64_t heap = 1; heap <= 4; heap++) {
        mspring_builder *builder = support_builder();
        uint64_t seed = heap, most = 0;
        for (uint32_t i = 0; i < 600; i++)
            (void)support_particle(builder, -9 + 0.6 * (i % 30) + support_random_between(&seed, 0, 0.2),
                                   0.3 + 0.6 * (i / 30), (float)exp(support_random_between(&seed, 0, log(30))));
        const mspring_network_def def = support_def(-9.8f, 8);
        mspring_network *network = support_network(builder, &def);
        mspring_id walls[3];
        check_ok(touch(network, 0.5));
        for (int i = 0; i < 3; i++) {
            mspring_collider_def wall;
            check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &wall, sizeof wall));
            wall.kind = MSPRING_COLLIDER_BOX;
            wall.width = i < 2 ? 2 : 60;
            wall.height = i < 2 ? 60 : 2;
            wall.x = i < 2 ? 22 * i - 11 : 0;
            wall.y = i < 2 ? 28 : -1.3;
            wall.friction = 0.5f;
            check_ok(mspring_network_add_collider(network, &wall, &walls[i]));
        }
        for (int step = 0; step < 256; step++) {
            const double way = fmin(fmax(step - 128, 0) * 3 / 64.0, 4);
            check_ok(mspring_network_move_collider(network, walls[0], -11 + way, 28, 0));
            check_ok(mspring_network_move_collider(network, walls[1], 11 - way, 28, 0));
            support_steps(network, 1, 1.0 / 64);
            most = network->contacts->work > most ? network->contacts->work : most;
        }
        if (getenv("CONTACT_REPORT"))
            printf("heap %u: %.3g comparisons\n", (unsigned)heap, (double)most);
        assert_true(most < 2000000);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cliques_take_few_tries),
        cmocka_unit_test(graphs_without_triangles_are_counted),
        cmocka_unit_test(stars_are_looked_at),
        cmocka_unit_test(breaks_leave_the_outline_right),
        cmocka_unit_test(cliques_are_judged_as_a_whole),
        cmocka_unit_test(comparisons_are_counted),
        cmocka_unit_test(room_for_pairs_may_fail),
        cmocka_unit_test(crowds_end_at_the_first_pair_too_many),
        cmocka_unit_test(refused_steps_end_their_work),
        cmocka_unit_test(hubs_are_counted),
        cmocka_unit_test(heaps_of_rods_are_not_refused),
        cmocka_unit_test(hubs_at_rest_are_no_burden),
        cmocka_unit_test(tall_pits_are_not_refused),
        cmocka_unit_test(walls_close_on_heaps),
    };
    return cmocka_run_group_tests_name("contact_limits", tests, NULL, NULL);
}
