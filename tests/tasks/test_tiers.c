/// @file test_tiers.c
/// A large web is swept in tiers: several substeps in one pass give the bits of substeps taken one by one, for any
/// number of workers, whatever else is in the network.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "hosts.h"
#include "recipe.h"
#include "store/network.h"
#include "support.h"

/// A few more than a web needs to get tiers.
#define PARTICLES 60100

#define SUBSTEPS 6

/// So many allocations before the last, at most, the places where tiers begin are listed.
#define LAST_ALLOCATIONS 20

/// What there is in a network.
typedef enum content {
    ONE_PIECE,
    MANY_PIECES,       ///< of 700 particles
    WITH_CABLES,       ///< and ropes from one end to the other, and one particle that has a hundred springs; beside
                       ///< a lattice with a rope, a strand and loose particles
    ON_A_RAFT,         ///< a lattice that is much smaller
    IN_RIGGING,        ///< of more particles than its own
    ON_A_TIED_LATTICE, ///< of which rows cannot be swept for several substeps
} content;

/// Particles in a long heap, each with springs to three before it, in any order.
static recipe heap_of(content of) {
    uint64_t seed = 70 + of;
    recipe made = {0};
    for (uint32_t i = 0; i < PARTICLES; i++) {
        recipe_particle(&made, 0.02 * i + support_random_between(&seed, 0, 1), support_random_between(&seed, 0, 3),
                        support_random_between(&seed, 1, 2), i % 5000 == 17 ? MSPRING_PARTICLE_PINNED : 0);
        const uint32_t piece = of == MANY_PIECES ? i % 700 : i;
        for (uint32_t back = 1; back <= 3 && piece >= back * back; back++) {
            recipe_spring(&made, i - back * back, i, support_random_between(&seed, 200, 2000), 2, 0);
        }
    }
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {500, 900}};
    if (of == WITH_CABLES) {
        const mspring_id lattice = recipe_lattice(&made, 40, 60, 0, 10, 1, &stuff, &seed);
        recipe_rope(&made, lattice + 3, lattice + 2000, 30, &stuff, &seed);
        const mspring_id end = recipe_particle(&made, -20, 0, 1, 0), other = recipe_particle(&made, -80, 0, 1, 0);
        recipe_rope(&made, end, other, 50, &stuff, &seed);
        for (int i = 0; i < 40; i++) {
            recipe_particle(&made, -5 - i, -9, 1, 0);
        }
        recipe_rope(&made, 5, PARTICLES - 9, 3, &stuff, &seed);
        recipe_rope(&made, 70, PARTICLES - 4000, 30, &stuff, &seed);
        recipe_rope(&made, PARTICLES - 2000, recipe_particle(&made, 900, -9, 1, 0), 9, &stuff, &seed);
        for (uint32_t i = 0; i < 100; i++) {
            recipe_spring(&made, 30000, i * 40, 50, 0, 0);
        }
    } else if (of == ON_A_RAFT) {
        const mspring_id raft = recipe_lattice(&made, 60, 40, 600, -50, 1, &stuff, &seed);
        for (uint32_t i = 0; i < 60; i++) {
            recipe_spring(&made, raft + i, 30000 + i, 500, 0, 0);
        }
        recipe_lattice(&made, 60, 40, 600, -200, 1, &stuff, &seed);
    } else if (of == IN_RIGGING) {
        for (uint32_t i = 0; i < 61; i++) {
            recipe_rope(&made, 100 * i, 55000 + i, 1000, &stuff, &seed);
        }
    } else if (of == ON_A_TIED_LATTICE) {
        const mspring_id lattice = recipe_lattice(&made, 120, 1000, 2000, 0, 1, &stuff, &seed);
        recipe_spring(&made, lattice, lattice + 119999, 500, 0, 0); // from its first row to its last
        recipe_spring(&made, PARTICLES - 1, lattice, 500, 0, 0);
    }
    if (of != MANY_PIECES) {
        recipe_disturb(&made, 0.02, 3, &seed);
    }
    recipe_shuffle(&made, &seed, NULL);
    return made;
}

static void do_nothing(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

/// With a hook after every substep no two of them can share a pass.
static void take_one_by_one(mspring_network *network) {
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, do_nothing, NULL, NULL));
}

/// How steps are to be taken.
typedef struct manner {
    bool one_by_one, forced, on_floor, has_tiers;
    bool independent; ///< workers are bodies of a host that wait for nobody, the last one first
    uint32_t workers;
} manner;

/// Springs join particles of one tier or of two that follow each other, and each has its particles.
static void check_tiers(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const uint32_t first_block = t->irregular_first + t->irregular_blocks - t->tier_blocks[t->tier_count];
    uint32_t *tier_of_block = calloc(t->block_count, sizeof *tier_of_block);
    assert_non_null(tier_of_block);
    for (uint32_t tier = 0; tier < t->tier_count; tier++) {
        assert_true(t->tier_blocks[tier] < t->tier_blocks[tier + 1]);
        for (uint32_t i = t->tier_blocks[tier]; i < t->tier_blocks[tier + 1]; i++) {
            tier_of_block[first_block + i] = tier + 1;
        }
    }
    for (uint32_t i = 0; i < t->irregular_count; i++) {
        const int64_t a = tier_of_block[t->irregular_a[i] / MSPRINGI_WIDTH];
        const int64_t b = tier_of_block[t->irregular_b[i] / MSPRINGI_WIDTH];
        assert_true((a == 0) == (b == 0) && a - b <= 1 && b - a <= 1);
    }
    free(tier_of_block);
}

static uint64_t hash_after_steps(const recipe *made, content of, manner how) {
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.worker_count = how.workers;
    def.settings.global_damping = 0.25f;
    host hosts[HOST_COUNT];
    hosts_fill(hosts, how.workers);
    if (how.independent)
        def.tasks = &hosts[1].tasks;
    mspring_network *network = recipe_network(made, &def);
    // Ropes that hang on tiers, or on a lattice, are no strands.
    assert_int_equal(network->topology.chain_count, of == WITH_CABLES ? 1 : of == IN_RIGGING ? 61 : 0);
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    assert_int_equal(plan.irregular_layers > 0, how.has_tiers || of <= ON_A_RAFT);
    // The raft is part of the web, another lattice is not.
    assert_int_equal(network->topology.lattice_count, of == WITH_CABLES || of >= ON_A_RAFT ? of != IN_RIGGING : 0);
    if (how.one_by_one) {
        take_one_by_one(network);
    } else if (how.has_tiers) {
        assert_true(network->topology.tier_count >= 20);
        check_tiers(network);
    } else {
        assert_int_equal(network->topology.tier_count, 0);
    }
    const double planes[2][4] = {{0, 0.5, 0.01, 1}, {700, 0, -1, 0.2}};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.plane_count = 2;
    floor.planes = planes[0];
    floor.friction = 0.3f;
    check_ok(mspring_network_set_floor(network, how.on_floor ? &floor : NULL));
    for (mspring_id p = 0; how.forced && p < made->particle_count; p += 3) {
        check_ok(mspring_network_apply_force(network, p, 30, -20));
    }
    support_steps(network, 2, 1.0 / 64);
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

#ifdef __SANITIZE_THREAD__
enum { LOOKS_FOR_RACES = 1 };
#else
enum { LOOKS_FOR_RACES = 0 };
#endif

/// What has one thread would take most of the time that looking for data races takes.
static void skip_where_races_are_looked_for(void) {
    if (LOOKS_FOR_RACES)
        skip();
}

static void tiers_give_the_bits_of_single_substeps(void **state) {
    (void)state;
    static const content contents[] = {ONE_PIECE, WITH_CABLES, ON_A_RAFT, IN_RIGGING, ON_A_TIED_LATTICE};
    for (size_t i = 0; i < COUNT_OF(contents); i++) {
        const content of = contents[i];
        const uint32_t most_workers = of == IN_RIGGING ? 1 : 3, step = of <= WITH_CABLES ? 1 : 2;
        if (LOOKS_FOR_RACES && most_workers == 1) {
            continue;
        }
        recipe made = heap_of(of);
        manner how = {.one_by_one = true, .forced = of == ONE_PIECE, .on_floor = of == WITH_CABLES, .workers = 1};
        const uint64_t expected = LOOKS_FOR_RACES ? 0 : hash_after_steps(&made, of, how);
        how.one_by_one = false;
        how.has_tiers = of <= ON_A_RAFT;
        for (how.workers = LOOKS_FOR_RACES ? 3 : 1; how.workers <= most_workers; how.workers += step) {
            const uint64_t hash = hash_after_steps(&made, of, how);
            assert_true(LOOKS_FOR_RACES || hash == expected);
        }
        if (how.has_tiers && !LOOKS_FOR_RACES) {
            how.workers = 3;
            how.independent = true;
            assert_true(hash_after_steps(&made, of, how) == expected);
        }
        recipe_free(&made);
    }
}

/// Particles with about as many springs share a group, so few places of rungs are empty. Here they have 2 to 8 in
/// any order: grouped as they come, the largest of 16 would leave three places of ten empty.
static void rungs_of_tiers_are_filled(void **state) {
    (void)state;
    skip_where_races_are_looked_for();
    uint64_t seed = 7;
    recipe made = {0};
    for (uint32_t i = 0; i < PARTICLES; i++) {
        recipe_particle(&made, 0.02 * i, support_random_between(&seed, 0, 3), 1, 0);
        for (uint32_t back = 1; back <= 27 && back <= i; back *= 3) {
            if (back == 1 || support_random_between(&seed, 0, 1) < 0.5) {
                recipe_spring(&made, i, i - back, 100, 0, 0);
            }
        }
    }
    mspring_network *network = recipe_network(&made, NULL);
    const mspringi_topology *t = &network->topology;
    assert_true(t->tier_count > 20);
    const double places = (double)t->irregular.first_slice_column[t->irregular.slice_count] * MSPRINGI_WIDTH;
    const double filled = 2.0 * t->laid_out_count / places;
    print_message("%.3f of the places of rungs are filled\n", filled);
    assert_true(filled > 0.96);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void small_webs_have_no_tiers(void **state) {
    (void)state;
    skip_where_races_are_looked_for();
    recipe made = {0};
    recipe_particle(&made, 0, 0, 1, 0);
    for (uint32_t i = 1; i < 5000; i++) {
        recipe_particle(&made, i % 70, i / 70.0, 1, 0);
        recipe_spring(&made, i, i - 1, 100, 0, 0);
        if (i > 2) {
            recipe_spring(&made, i, i / 2, 100, 0, 0);
        }
    }
    mspring_network *network = recipe_network(&made, NULL);
    assert_int_equal(network->topology.tier_count, 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Every second piece moves, the others sleep, and a step that is refused wakes none of them.
static void pieces_sleep_in_tiers(void **state) {
    (void)state;
    skip_where_races_are_looked_for();
    recipe made = heap_of(MANY_PIECES);
    uint64_t hashes[2][2];
    for (int one_by_one = 0; one_by_one < 2; one_by_one++) {
        mspring_network_def def = support_def(0, SUBSTEPS);
        def.settings.sleep_speed = 0.001f;
        def.settings.sleep_time = 0.05f;
        mspring_network *network = recipe_network(&made, &def);
        if (one_by_one) {
            take_one_by_one(network);
        }
        mspring_id moving = 0;
        for (mspring_id p = 0; p < 40; p++) {
            moving = p * 997;
            check_ok(
                mspring_network_set_velocities(network, &moving, 0, 1, &(float){1}, &(float){(float)(p % 3)}, 1));
        }
        support_steps(network, 8, 1.0 / 64);
        assert_true(network->sleep.sleeping > 0 && network->sleep.sleeping < network->sleep.count);
        const uint64_t before = hashes[one_by_one][0] = support_hash(network);
        check_ok(mspring_network_apply_force(network, moving, 1e9f, 0));
        check_error(mspring_network_step(network, 1.0 / 64), MSPRING_ERROR_UNSTABLE);
        assert_int_equal(support_hash(network), before);
        assert_true(network->sleep.sleeping > 0);
        check_ok(mspring_network_apply_force(network, moving, -1e9f, 0));
        support_steps(network, 2, 1.0 / 64);
        hashes[one_by_one][1] = support_hash(network);
        mspring_network_destroy(network);
    }
    assert_int_equal(hashes[0][0], hashes[1][0]);
    assert_int_equal(hashes[0][1], hashes[1][1]);
    recipe_free(&made);
}

/// Allocations that laying out takes fail once, each up to those of tiers, lattices that are given up among them;
/// and the last ones, among them where each tier begins.
static void failing_memory_is_said_and_freed(void **state) {
    (void)state;
    skip_where_races_are_looked_for();
    recipe made = heap_of(ON_A_RAFT);
    mspring_builder *builder = recipe_builder(&made, NULL);
    const mspringi_reserve reserve = {made.particle_count, made.spring_count, made.particle_count,
                                      made.spring_count};
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    size_t count = 0;
    bool of_tiers = false;
    for (size_t n = 0; n <= count; n++) {
        mspringi_memory memory;
        mspringi_message message = {""};
        mspringi_topology topology = {0};
        check_ok(mspringi_memory_init(&memory, &allocator, &message));
        watched.calls = 0;
        watched.fail_at = n;
        const mspring_result result =
            mspringi_topology_create(&topology, builder, &reserve, false, 1, MSPRINGI_WIDTH, &memory, &message);
        if (n == 0) {
            check_ok(result);
            assert_true(topology.tier_count > 0);
            count = watched.calls;
        } else {
            check_error(result, MSPRING_ERROR_MEMORY);
            assert_non_null(strstr(message.text, "no memory"));
            if (of_tiers && !strstr(message.text, "layers") && n + LAST_ALLOCATIONS < count) {
                n = count - LAST_ALLOCATIONS;
            }
            of_tiers = strstr(message.text, "layers") != NULL;
        }
        mspringi_topology_destroy(&topology, &memory);
        assert_int_equal(watched.live, 0);
    }
    check_watched_clean(&watched);
    mspring_builder_destroy(builder);
    recipe_free(&made);
}

/// A clone, and what a compaction leaves, have tiers of their own.
static void clones_and_compact_ones_have_tiers(void **state) {
    (void)state;
    skip_where_races_are_looked_for();
    recipe made = heap_of(ONE_PIECE);
    const mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    mspring_network *network = recipe_network(&made, &def), *clone = NULL;
    for (mspring_id s = 0; s < made.spring_count; s += 997) {
        check_ok(mspring_network_break_springs(network, &s, 0, 1));
    }
    for (int compact = 0; compact < 2; compact++) {
        if (compact) {
            check_ok(mspring_network_compact(network));
        }
        check_ok(mspring_network_clone(network, NULL, &clone));
        assert_true(clone->topology.tier_count > 0);
        check_tiers(clone);
        take_one_by_one(clone);
        support_steps(network, 2, 1.0 / 64);
        support_steps(clone, 2, 1.0 / 64);
        assert_int_equal(support_hash(clone), support_hash(network));
        mspring_network_destroy(clone);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiers_give_the_bits_of_single_substeps),
        cmocka_unit_test(rungs_of_tiers_are_filled),
        cmocka_unit_test(small_webs_have_no_tiers),
        cmocka_unit_test(pieces_sleep_in_tiers),
        cmocka_unit_test(failing_memory_is_said_and_freed),
        cmocka_unit_test(clones_and_compact_ones_have_tiers),
    };
    return cmocka_run_group_tests_name("tiers", tests, NULL, NULL);
}
