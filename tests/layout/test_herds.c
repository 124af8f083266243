/// @file test_herds.c
/// Herds of equal components: which components stand in them, and the same bits whatever sweeps them.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "allocator.h"
#include "layout/analysis.h"
#include "recipe.h"
#include "reference.h"
#include "store/network.h"
#include "support.h"

enum { LANES = MSPRINGI_WIDTH };

/// The node that each node hangs on, of small trees. They stand in no herd: their springs come in any order.
enum { LARGEST_TREE = 8 };
typedef struct shape {
    uint32_t size, above[LARGEST_TREE];
} shape;

static const shape shapes[] = {
    {2, {0, 0}},
    {3, {0, 0, 1}},
    {3, {0, 0, 0}}, // the same, from its middle
    {4, {0, 0, 1, 2}},
    {4, {0, 0, 0, 0}},
    {6, {0, 0, 1, 1, 0, 4}},
    {8, {0, 0, 1, 2, 3, 4, 5, 6}},
    {8, {0, 0, 0, 0, 0, 0, 0, 0}},
    {8, {0, 0, 1, 2, 1, 2, 3, 0}},
};

static mspring_id add_tree(recipe *made, const shape *which, double x, double y, bool ring, uint64_t *seed) {
    mspring_id first = 0;
    for (uint32_t node = 0; node < which->size; node++) {
        const double dx = support_random_between(seed, -1, 1), dy = support_random_between(seed, -1, 1);
        const double mass = support_random_between(seed, 1, 2);
        const bool is_pinned = support_random(seed) % 32 == 0;
        const mspring_id id =
            recipe_particle(made, x + 3 * node + dx, y + dy, mass, is_pinned ? MSPRING_PARTICLE_PINNED : 0);
        first = node == 0 ? id : first;
        if (node > 0) {
            const double stiffness = support_random_between(seed, 200, 400);
            recipe_spring(made, first + which->above[node], id, stiffness, support_random_between(seed, 0, 1), 0);
        }
    }
    if (ring) {
        recipe_spring(made, first, first + which->size - 1, 300, 0, 0);
    }
    return first;
}

/// Components that are no trees, each by the same calls: pairs of particles that springs join.
enum { RING = 7, WHEEL = 12, COPY_KINDS = 2 };
static const uint32_t copy_sizes[COPY_KINDS] = {RING, WHEEL};

static void copy_spring(recipe *made, mspring_id a, mspring_id b, uint64_t *seed) {
    recipe_spring(made, a, b, support_random_between(seed, 200, 400), support_random_between(seed, 0, 1), 0);
}

/// A ring with chords that are given last; each spring and particle of its own.
static void add_copy(recipe *made, uint32_t kind, double x, double y, uint64_t *seed) {
    const uint32_t size = copy_sizes[kind];
    mspring_id first = MSPRING_NONE;
    for (uint32_t i = 0; i < size; i++) {
        const double angle = 6.28 * i / size, far = kind == 1 && i % 2 ? 3 : 1.5 + 0.1 * (double)i;
        const mspring_id id = recipe_particle(made, x + far * cos(angle) + support_random_between(seed, -0.2, 0.2),
                                              y + far * sin(angle), support_random_between(seed, 1, 2),
                                              support_random(seed) % 32 == 0 ? MSPRING_PARTICLE_PINNED : 0);
        first = i == 0 ? id : first;
    }
    for (uint32_t i = 0; i < size; i++) {
        copy_spring(made, first + i, first + (i + 1) % size, seed);
    }
    for (uint32_t i = 0; i < size; i++) {
        copy_spring(made, first + (i + 2 + 3 * kind) % size, first + i, seed);
    }
}

static void add_copies(recipe *made, uint32_t of_each, double x, uint64_t *seed) {
    for (uint32_t i = 0; i < of_each; i++) {
        for (uint32_t kind = 0; kind < COPY_KINDS; kind++) {
            add_copy(made, kind, x + 10.0 * kind, 10.0 * i, seed);
        }
    }
}

/// Many trees of each shape, components that are none, and what stands in no herd: rings, a path of nine, a
/// lattice, loose particles.
static recipe make_trees(uint32_t of_each, uint64_t seed) {
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {200, 400}, .damping = {0, 1}};
    recipe made = {0};
    for (uint32_t i = 0; i < of_each; i++) {
        for (size_t k = 0; k < COUNT_OF(shapes); k++) {
            add_tree(&made, &shapes[k], 40.0 * (double)k, 10.0 * i, false, &seed);
        }
    }
    for (uint32_t i = 0; i < 20; i++) {
        add_tree(&made, &shapes[1], -20, 10.0 * i, true, &seed);
        recipe_particle(&made, -30, 10.0 * i, 1, 0);
        const mspring_id from = recipe_particle(&made, -60, 10.0 * i, 1, 0);
        recipe_rope(&made, from, recipe_particle(&made, -52, 10.0 * i, 1, 0), 8, &stuff, &seed);
    }
    recipe_lattice(&made, 20, 10, 0, -20, 1, &stuff, &seed);
    recipe_disturb(&made, 0.1, 0.5, &seed);
    recipe_shuffle(&made, &seed, NULL);
    add_copies(&made, of_each, 400, &seed);
    return made;
}

/// A network of a recipe, one more spring broken and left out, so that what is left is laid out anew.
static mspring_network *compact_network(const recipe *made, const mspring_network_def *def) {
    mspring_builder *builder = recipe_builder(made, NULL);
    const mspring_id a = support_particle(builder, -100, 0, 1), b = support_particle(builder, -100, 1, 1);
    const mspring_id spring = support_spring(builder, a, b, 1, 0);
    mspring_network *network = support_network(builder, def);
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_compact(network));
    return network;
}

/* ---------------------------------------------------------------------------------------------- which stand so */

static uint32_t groups_of(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    if (t->bundle_strip == MSPRING_NONE) {
        return 0;
    }
    const mspringi_row *row = &t->rows[t->strips[t->bundle_strip].first_row];
    const mspringi_span *first = &t->spans[row->first_span], *last = first + row->span_count - 1;
    return (last->end_slot - first->first_slot) / LANES;
}

static void copies_stand_in_whole_herds(void **state) {
    (void)state;
    recipe made = make_trees(37, 1);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = compact_network(&made, &def);
    uint32_t expected = 0; // of 37 copies 32 fill lanes
    for (uint32_t kind = 0; kind < COPY_KINDS; kind++) {
        expected += 2 * copy_sizes[kind];
    }
    assert_int_equal(groups_of(network), expected);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void rungs_of_a_group_lead_to_one_group(void **state) {
    (void)state;
    recipe made = make_trees(37, 2);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = compact_network(&made, &def);
    const mspringi_sell *web = &network->topology.irregular;
    const uint32_t end = web->own_count / LANES;
    uint32_t springs = 0;
    for (uint32_t group = end - groups_of(network); group < end; group++) {
        for (uint32_t rung = web->first_slice_column[group]; rung < web->first_slice_column[group + 1]; rung++) {
            const uint32_t *neighbour = web->neighbour + rung * LANES, other = neighbour[0] / LANES;
            for (uint32_t lane = 0; lane < LANES; lane++) {
                assert_int_equal(neighbour[lane], other * LANES + lane);
            }
            assert_true(other != group && other + WHEEL > group);
            springs += other > group ? LANES : 0;
        }
    }
    assert_true(springs > 0);
    assert_int_equal(springs, network->topology.bundle_springs);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Robots of SIDE x SIDE particles with as many springs across two cells.
enum { SIDE = 5 };
static recipe make_robots(uint32_t count, uint32_t braces) {
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {200, 400}, .damping = {0, 1}};
    uint64_t seed = 8;
    recipe made = {0};
    for (uint32_t i = 0; i < count; i++) {
        const mspring_id first = recipe_lattice(&made, SIDE, SIDE, 20.0 * i, 0, 1, &stuff, &seed);
        for (uint32_t k = 0; k < braces; k++) {
            copy_spring(&made, first + SIDE * k, first + SIDE * (k + 1) + 2, &seed);
        }
    }
    return made;
}

static void check_robots(uint32_t count, uint32_t braces, uint32_t groups, uint32_t in_lattices) {
    recipe made = make_robots(count, braces);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = support_network(recipe_builder(&made, NULL), &def);
    assert_int_equal(groups_of(network), groups);
    assert_int_equal(network->topology.lattice_particles, in_lattices);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// When a network is made; all of a shape, if some are in herds. A lattice stays one if little hangs on it.
static void copies_stand_in_herds_at_once(void **state) {
    (void)state;
    recipe made = {0};
    uint64_t seed = 9;
    add_copies(&made, 37, 0, &seed);
    mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = support_network(recipe_builder(&made, NULL), &def);
    assert_int_equal(groups_of(network), 2 * (RING + WHEEL));
    mspring_network_destroy(network);
    def.settings.solver = MSPRING_SOLVER_IMPLICIT;
    network = support_network(recipe_builder(&made, NULL), &def);
    assert_int_equal(groups_of(network), 0);
    mspring_network_destroy(network);
    recipe_free(&made);
    check_robots(65, 4, 4 * SIDE * SIDE, 0);
    check_robots(71, 4, 4 * SIDE * SIDE, 0); // the rest, too, where there are no others
    check_robots(63, 4, 0, 63 * SIDE * SIDE);
    check_robots(80, 1, 0, 80 * SIDE * SIDE);
}

/// A thousandth of what they move, and ten times what single precision errs.
static void copies_move_as_each_alone(void **state) {
    (void)state;
    const mspring_network_def def = support_def(-9.8f, 4);
    recipe all = {0};
    uint64_t seed = 10;
    add_copies(&all, 16, 0, &seed);
    mspring_network *together = support_network(recipe_builder(&all, NULL), &def);
    assert_int_equal(groups_of(together), RING + WHEEL);
    support_steps(together, 25, 4.0 / 256);
    seed = 10;
    for (uint32_t i = 0, first = 0; i < 32; i++) {
        recipe one = {0};
        add_copy(&one, i % 2, 10.0 * (i % 2), 10.0 * (i / 2), &seed);
        mspring_network *alone = support_network(recipe_builder(&one, NULL), &def);
        support_steps(alone, 25, 4.0 / 256);
        for (mspring_id id = 0; id < one.particle_count; id++) {
            const support_point p = support_position(together, first + id), q = support_position(alone, id);
            check_near(p.x, q.x, 5e-4);
            check_near(p.y, q.y, 5e-4);
        }
        first += one.particle_count;
        mspring_network_destroy(alone);
        recipe_free(&one);
    }
    mspring_network_destroy(together);
    recipe_free(&all);
}

/// Each allocation of a compaction fails in turn.
static void without_memory_they_stand_as_before(void **state) {
    (void)state;
    recipe made = make_trees(24, 7);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_result result = MSPRING_ERROR_MEMORY;
    for (size_t fail = 1; result != MSPRING_OK; fail++) {
        watched_allocator watched = {0};
        const mspring_allocator allocator = watched_interface(&watched);
        const mspring_id spring = 0;
        mspring_network *network = support_network(recipe_builder(&made, &allocator), &def);
        check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        const uint64_t before = support_hash(network);
        watched.fail_at = watched.calls + fail;
        result = mspring_network_compact(network);
        assert_true(result == MSPRING_OK || result == MSPRING_ERROR_MEMORY);
        assert_true(groups_of(network) > 0 || result == MSPRING_ERROR_MEMORY);
        assert_int_equal(support_hash(network), before);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    recipe_free(&made);
}

/// 15 of each do not fill the lanes of one herd.
static void few_copies_stand_in_none(void **state) {
    (void)state;
    recipe made = make_trees(15, 3);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = compact_network(&made, &def);
    assert_int_equal(groups_of(network), 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------------- their steps */

/// Half a millimetre: a thousandth of what they move, and ten times what single precision errs at such coordinates.
static void they_move_as_the_reference(void **state) {
    (void)state;
    recipe made = make_trees(40, 4);
    reference exact = reference_of(&made, 0, -9.8, 0.3);
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.global_damping = 0.3f;
    mspring_network *network = compact_network(&made, &def);
    assert_true(groups_of(network) > 0);
    for (int substep = 0; substep < 100; substep++) {
        reference_substep(&exact, 1.0 / 256);
    }
    support_steps(network, 25, 4.0 / 256);
    for (mspring_id id = 0; id < made.particle_count; id++) {
        const support_point p = support_position(network, id);
        check_near(p.x, exact.particles[id].x, 5e-4);
        check_near(p.y, exact.particles[id].y, 5e-4);
    }
    mspring_network_destroy(network);
    reference_free(&exact);
    recipe_free(&made);
}

typedef struct way {
    mspring_simd level;
    uint32_t workers;
    bool in_irregular; ///< the herds are swept as any web
    bool has_floor, has_forces, has_dampers;
} way;

static void add_floor(mspring_network *network) {
    const double plane[4] = {0, 50, 0, 1};
    mspring_floor_def ground;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &ground, sizeof ground));
    ground.planes = plane;
    ground.plane_count = 1;
    ground.friction = 0.5f;
    check_ok(mspring_network_set_floor(network, &ground));
}

static uint64_t hash_of(recipe *made, way with) {
    mspring_network_def def = support_def(-9.8f, ROUNDS(130));
    def.simd_level = with.level;
    def.worker_count = with.workers;
    for (uint32_t s = 0; !with.has_dampers && s < made->spring_count; s++) {
        made->springs[s].damping = 0;
    }
    mspring_network *network = compact_network(made, &def);
    assert_true(groups_of(network) > 0);
    if (with.in_irregular) {
        network->topology.bundle_strip = MSPRING_NONE;
    }
    if (with.has_floor) {
        add_floor(network);
    }
    uint64_t hash = 0;
    for (int step = 0; step < 4; step++) {
        if (with.has_forces) {
            check_ok(mspring_network_apply_force(network, 100, 30, 20));
        }
        support_steps(network, 1, 1.0 / 64);
        hash = hash * 31 + support_hash(network);
    }
    mspring_network_destroy(network);
    return hash;
}

static void any_way_gives_the_same_bits(void **state) {
    (void)state;
    for (uint32_t scene = 0; scene < 8; scene += 5 / ROUNDS(5)) {
        recipe made = make_trees(100, 5);
        way with = {.level = MSPRING_SIMD_SCALAR,
                    .has_floor = scene & 1,
                    .has_forces = scene >> 1 & 1,
                    .has_dampers = scene >> 2 & 1};
        with.workers = 1;
        with.in_irregular = true;
        const uint64_t expected = hash_of(&made, with);
        with.in_irregular = false;
        mspring_simd levels[MSPRING_SIMD_AVX512];
        const uint32_t count = support_levels(levels);
        for (uint32_t i = 0; i < count; i++) {
            with.level = levels[i];
            for (with.workers = 1; with.workers <= 3; with.workers += 2) {
                assert_int_equal(hash_of(&made, with), expected);
            }
        }
        recipe_free(&made);
    }
}

/// What falls asleep takes those that stand beside it out of the herd's own sweep.
static void what_is_awake_moves_the_same_beside_sleepers(void **state) {
    (void)state;
    uint64_t seed = 6;
    recipe made = {0};
    for (uint32_t i = 0; i < 600; i++) {
        const mspring_id first = add_tree(&made, &shapes[5], 0, 10.0 * i, false, &seed);
        for (uint32_t node = 0; node < shapes[5].size; node++) {
            made.particles[first + node].vx = i % 2 == 0 ? 1.0f : 0.0f;
        }
    }
    mspring_network_def def = support_def(0, 4);
    mspring_network *restless = compact_network(&made, &def);
    def.settings.sleep_speed = 0.01f;
    def.settings.sleep_time = 0.1f;
    mspring_network *network = compact_network(&made, &def);
    assert_true(groups_of(network) > 0);
    support_steps(restless, 40, 1.0 / 64);
    support_steps(network, 40, 1.0 / 64);
    uint32_t asleep = 0;
    uint8_t *sleeps = malloc(made.particle_count);
    assert_non_null(sleeps);
    check_ok(support_get_sleepers(network, 0, made.particle_count, sleeps, 1));
    for (mspring_id id = 0; id < made.particle_count; id++) {
        const support_point p = support_position(network, id), q = support_position(restless, id);
        assert_true(sleeps[id] || (p.x == q.x && p.y == q.y));
        asleep += sleeps[id] != 0;
    }
    free(sleeps);
    assert_true(asleep > made.particle_count / 4 && asleep < made.particle_count);
    mspring_network_destroy(network);
    mspring_network_destroy(restless);
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------------- their lives */

#ifndef MOST_LIVES
#define MOST_LIVES ROUNDS(6u)
#endif

enum { LIFE_STEPS = 24, LIFE_EDITS = 5 };

/// Forces and blows that depend on nothing but where a particle is.
static void blow(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->phase == MSPRING_PHASE_BEFORE_SUBSTEP) {
            args->force_x[slot] += args->y[slot];
        } else if (args->x[slot] > 100.0f) {
            args->vx[slot] -= 0.25f;
        }
    }
}

/// What a host may do between two steps.
static void edit(mspring_network *network, uint32_t spring_count, uint64_t *seed) {
    const uint64_t dice = support_random(seed), which = support_random(seed);
    const mspring_id p = (mspring_id)(which % 600), s = (mspring_id)(which % spring_count);
    const float some = (float)support_random_between(seed, 0.5, 2), none = 0.0f;
    mspring_spring_def def;
    mspring_id id;
    uint32_t hook;
    switch (dice % 16) {
    case 0:
    case 1:
    case 2:
        check_ok(mspring_network_break_springs(network, &s, 0, 1));
        break;
    case 3: // one that broke before the network was compacted brings all back
        check_ok(mspring_network_restore_springs(network, &s, 0, 1, 0));
        break;
    case 4:
    case 5:
    case 6:
        support_kick(network, p, some);
        break;
    case 7:
        check_ok(mspring_network_set(network, MSPRING_MASS, &p, 0, 1, &some, 1));
        break;
    case 8:
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, &p, 0, 1, &none, 1));
        break;
    case 9:
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, &s, 0, 1, &(float){100.0f * some}, 1));
        break;
    case 10:
        check_ok(mspring_network_apply_force(network, p, 30.0f * some, 20));
        break;
    case 11:
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
        def.a = p;
        def.b = p + 11;
        def.stiffness = 50.0f * some;
        if (mspring_network_add_springs(network, &def, 1, &id) == MSPRING_OK && dice >> 32 & 1) {
            check_ok(mspring_network_remove_springs(network, &id, 0, 1));
        }
        break;
    case 12:
        check_ok(support_add_hook(network,
                                  dice >> 32 & 1 ? MSPRING_PHASE_BEFORE_SUBSTEP : MSPRING_PHASE_AFTER_SUBSTEP, blow,
                                  NULL, &hook));
        if (dice >> 33 & 3) {
            support_steps(network, 1, 1.0 / 64);
            check_ok(mspring_network_remove_hook(network, hook));
        }
        break;
    case 13:
        support_bring(network, network, MSPRING_SNAPSHOT_ALL);
        break;
    default:
        check_ok(mspring_network_compact(network));
        break;
    }
}

static void live_as(recipe *made, way with, uint64_t seed, uint64_t *hashes) {
    const uint64_t kind = support_random(&seed);
    mspring_network_def def = support_def(kind & 1 ? 0 : -9.8f, 4);
    def.simd_level = with.level;
    def.worker_count = with.workers;
    def.spare_springs = 64;
    if (kind >> 1 & 1) {
        def.settings.sleep_speed = 0.3f;
        def.settings.sleep_time = 0.05f;
    }
    mspring_network *network = compact_network(made, &def);
    assert_true(groups_of(network) > 0);
    if (kind >> 2 & 1) {
        add_floor(network);
    }
    const float brittle = 0.5f;
    for (mspring_id s = 0; s < made->spring_count; s += 7) {
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, &s, 0, 1, &brittle, 1));
    }
    for (int step = 0; step < LIFE_STEPS; step++) {
        for (uint64_t i = support_random(&seed) % LIFE_EDITS; i > 0; i--) {
            edit(network, made->spring_count, &seed);
        }
        if (with.in_irregular) {
            network->topology.bundle_strip = MSPRING_NONE;
        }
        support_steps(network, 1, 1.0 / 64);
        hashes[step] = support_hash(network);
    }
    mspring_network_destroy(network);
}

static void any_way_lives_the_same(void **state) {
    (void)state;
    for (uint64_t life = 0; life < MOST_LIVES; life++) {
        recipe made = make_trees(24 + 8 * (uint32_t)(life % 3), life);
        uint64_t expected[LIFE_STEPS], hashes[LIFE_STEPS];
        const way scalar_web = {.level = MSPRING_SIMD_SCALAR, .workers = 1, .in_irregular = true};
        live_as(&made, scalar_web, life, expected);
        mspring_simd levels[MSPRING_SIMD_AVX512];
        const uint32_t count = support_levels(levels);
        for (uint32_t i = 0; i < count; i++) {
            static const uint32_t workers[] = {1, 3, 2, 8};
            const way herds = {.level = levels[i], .workers = workers[(i + life) % COUNT_OF(workers)]};
            live_as(&made, herds, life, hashes);
            assert_memory_equal(hashes, expected, sizeof hashes);
        }
        recipe_free(&made);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_stand_in_whole_herds),
        cmocka_unit_test(rungs_of_a_group_lead_to_one_group),
        cmocka_unit_test(few_copies_stand_in_none),
        cmocka_unit_test(copies_stand_in_herds_at_once),
        cmocka_unit_test(copies_move_as_each_alone),
        cmocka_unit_test(without_memory_they_stand_as_before),
        cmocka_unit_test(they_move_as_the_reference),
        cmocka_unit_test(any_way_gives_the_same_bits),
        cmocka_unit_test(what_is_awake_moves_the_same_beside_sleepers),
        cmocka_unit_test(any_way_lives_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
