/// @file test_passes.c
/// Substeps that are swept in one pass, by any number of workers, give the bits of substeps taken one by one,
/// whatever hangs on the lattices; and ropes do not keep a lattice from being swept so.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

#define SUBSTEPS 24

static const recipe_stuff stuff = {
    .mass = {0.5, 2}, .stiffness = {500, 3000}, .damping = {0, 10}, .pinned = 0.03, .holes = 0.1};
static const recipe_stuff solid = {.mass = {1, 1}, .stiffness = {1000, 1000}};

static support_plan plan_of(const recipe *made) {
    mspring_network *network = recipe_network(made, NULL);
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    mspring_network_destroy(network);
    return plan;
}

static void do_nothing(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

/// How two steps are to be taken.
typedef struct manner {
    bool one_by_one; ///< with a hook after every substep no two of them can share a pass
    bool forced;
    uint32_t workers;
} manner;

static uint64_t hash_after_steps(const recipe *made, manner how) {
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.worker_count = how.workers;
    def.settings.global_damping = 0.25f;
    def.settings.max_speed = 1e15f;
    mspring_network *network = recipe_network(made, &def);
    if (how.one_by_one) {
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, do_nothing, NULL, NULL));
    }
    for (mspring_id p = 0; how.forced && p < made->particle_count; p += 3) {
        check_ok(mspring_network_apply_force(network, p, 30, -20));
    }
    support_steps(network, 2, 1.0 / 64);
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

/// Lattices of any shape with ropes between any of their particles, strands that hang, knots, and odd springs.
static void add_everything(recipe *made, uint32_t variant, uint64_t *seed) {
    const uint32_t columns = 4 + (uint32_t)(support_random(seed) % 150);
    const uint32_t rows = 4 + (uint32_t)(support_random(seed) % 150);
    recipe_lattice(made, columns, rows, 0, 0, 1, &stuff, seed);
    if (variant % 3 == 1) {
        recipe_lattice(made, rows, columns, 300, 0, 0.5, &stuff, seed);
    }
    const uint32_t lattice_particles = made->particle_count;
    for (uint32_t i = 0; i < variant % 8; i++) {
        const mspring_id a = (mspring_id)(support_random(seed) % lattice_particles);
        const mspring_id b = (mspring_id)(support_random(seed) % lattice_particles);
        if (a != b) {
            recipe_rope(made, a, b, 2 + (uint32_t)(support_random(seed) % 12), &stuff, seed);
        }
    }
    if (variant % 2 == 0) {
        const mspring_id weight = recipe_particle(made, -5, -5, 3, 0);
        recipe_rope(made, (mspring_id)(support_random(seed) % lattice_particles), weight, 40, &stuff, seed);
    }
    if (variant % 6 == 5) { // more rope than lattice
        const mspring_id weight = recipe_particle(made, 400, -400, 3, 0);
        recipe_rope(made, 0, weight, 25000, &stuff, seed);
    }
    if (variant % 5 == 0) {
        recipe_random_springs(made, 30, &stuff, seed);
    }
    recipe_disturb(made, 0.1, 3, seed);
    recipe_shuffle(made, seed, NULL);
}

static void passes_give_the_bits_of_single_substeps(void **state) {
    (void)state;
    uint32_t deep = 0, lagging = 0, divided = 0;
    const uint32_t stride = 24 / ROUNDS(24);
    for (uint32_t variant = 0; variant < 24; variant += stride) {
        uint64_t seed = 7000 + variant;
        recipe made = {0};
        add_everything(&made, variant, &seed);
        const support_plan plan = plan_of(&made);
        deep += plan.pass_rows > 0 && plan.pass_substeps > 1;
        lagging += plan.pass_rows > 0 && plan.pass_lag > 1;
        divided += plan.pass_rows < plan.lattice_rows;
        const bool forced = variant % 4 == 3;
        const uint64_t expected =
            hash_after_steps(&made, (manner){.one_by_one = true, .forced = forced, .workers = 1});
        for (uint32_t workers = 1; workers <= 3; workers++) {
            assert_int_equal(hash_after_steps(&made, (manner){.forced = forced, .workers = workers}), expected);
        }
        recipe_free(&made);
    }
    // Or the networks do not show what they should.
    assert_true(stride > 1 || (deep >= 12 && lagging >= 2 && divided >= 1));
}

static void ropes_do_not_prevent_passes(void **state) {
    (void)state;
    uint64_t seed = 1;
    recipe made = {0};
    recipe_lattice(&made, 100, 100, 0, 0, 1, &solid, &seed);
    recipe_rope(&made, 0, 9999, 20, &solid, &seed); // from corner to corner
    const support_plan plan = plan_of(&made);
    assert_int_equal(plan.pass_rows, 100);
    assert_int_equal(plan.irregular_particles, 19);
    assert_true(plan.pass_substeps > 1);
    recipe_free(&made);
}

static void what_cannot_share_a_pass_does_not_prevent_those_of_others(void **state) {
    (void)state;
    uint64_t seed = 1;
    recipe made = {0};
    recipe_lattice(&made, 100, 100, 0, 0, 1, &solid, &seed);
    const mspring_id second = recipe_lattice(&made, 120, 1000, 200, 0, 1, &solid, &seed);
    recipe_spring(&made, second, second + 119999, 1000, 0, 0); // from its first row to its last
    const support_plan plan = plan_of(&made);
    assert_int_equal(plan.lattice_rows, 220);
    assert_int_equal(plan.pass_rows, 100);
    assert_int_equal(hash_after_steps(&made, (manner){.workers = 1}),
                     hash_after_steps(&made, (manner){.one_by_one = true, .workers = 1}));
    recipe_free(&made);
}

/// Networks large enough to be shared, with as many workers as find a strip and with more.
static void any_number_of_workers_gives_the_same_bits(void **state) {
    (void)state;
    for (uint32_t variant = ROUNDS_ARE_FEW ? 1 : 0; variant < (ROUNDS_ARE_FEW ? 2 : 3); variant++) {
        uint64_t seed = 50 + variant;
        recipe made = {0};
        if (variant < 2) {
            recipe_lattice(&made, 120, 110, 0, 0, 1, &stuff, &seed);
            for (uint32_t i = 0; i < 8 * variant; i++) {
                recipe_rope(&made, i, 3000 + 800 * i, 20, &stuff, &seed);
            }
        }
        if (variant > 0) { // a web of its own
            const mspring_id first = made.particle_count;
            for (uint32_t i = 0; i < 6000; i++) {
                const mspring_id new_one = recipe_particle(&made, support_random_between(&seed, 500, 600),
                                                           support_random_between(&seed, 0, 60), 1, 0);
                for (uint32_t back = 1; back <= 3 && new_one >= first + back * back; back++) {
                    recipe_spring(&made, new_one, new_one - back * back, 1000, 3, 0);
                }
            }
        }
        recipe_disturb(&made, 0.1, 3, &seed);
        const uint64_t expected = hash_after_steps(&made, (manner){.workers = 1});
        const uint32_t workers[] = {2, 3, 8, 50};
        for (size_t i = 0; i < COUNT_OF(workers); i++) {
            assert_int_equal(hash_after_steps(&made, (manner){.workers = workers[i]}), expected);
        }
        recipe_free(&made);
    }
}

/// A lattice, ropes, or an irregular network, of 2 to some 300 particles.
static recipe small_recipe(uint32_t variant, uint64_t *seed) {
    const recipe_stuff plain = {.mass = {0.5, 2}, .stiffness = {500, 3000}, .damping = {0, variant % 2 ? 10 : 0}};
    const uint32_t columns = 1 + (uint32_t)(support_random(seed) % 40),
                   rows = 1 + (uint32_t)(support_random(seed) % 8);
    recipe made = {0};
    if (variant % 3 == 0) {
        recipe_lattice(&made, columns + 1, rows, 0, 0, 1, &plain, seed);
    }
    if (variant % 9 == 0) {
        recipe_lattice(&made, rows + 1, rows + 1, 0, 20, 1, &plain, seed);
    }
    if (variant % 3 == 1 || variant % 9 == 3) {
        const mspring_id first = recipe_particle(&made, 0, 0, 1, MSPRING_PARTICLE_PINNED);
        const mspring_id last = recipe_particle(&made, 30, 1, 2, 0);
        recipe_rope(&made, first, last, columns, &plain, seed);
    }
    if (variant % 3 == 2) {
        for (uint32_t i = 0; i < columns + 6; i++) {
            recipe_particle(&made, support_random_between(seed, 0, 9), support_random_between(seed, 0, 9), 1, 0);
            if (i > 0) {
                recipe_spring(&made, i, i / 2, 900, 5, 0);
            }
            if (i > 8) {
                recipe_spring(&made, i, i - 4, 900, 5, 0);
            }
        }
    }
    recipe_disturb(&made, 0.1, 3, seed);
    return made;
}

/// A network that has nothing but a few rows is swept by fewer calls than one with a loose particle as well.
static void small_networks_have_the_bits_of_others(void **state) {
    (void)state;
    for (uint32_t variant = 0; variant < 90; variant++) {
        uint64_t seed = 400 + variant;
        recipe made = small_recipe(variant, &seed);
        mspring_network_def def = support_def(-9.8f, SUBSTEPS);
        mspring_network *alone = recipe_network(&made, &def);
        // Where another one is, so that the local origin is the same.
        const mspring_id loose = recipe_particle(&made, made.particles->x, made.particles->y, 1, 0);
        mspring_network *other = recipe_network(&made, &def);
        for (uint32_t step = 0; step < 3; step++) {
            if (variant % 4 == 3) {
                check_ok(mspring_network_apply_force(alone, 1, 30, -20));
                check_ok(mspring_network_apply_force(other, 1, 30, -20));
            }
            support_steps(alone, 1, 1.0 / 64);
            support_steps(other, 1, 1.0 / 64);
        }
        for (mspring_id p = 0; p < loose; p++) {
            const support_point at = support_position(alone, p), there = support_position(other, p);
            const support_point speed = support_velocity(alone, p), its_speed = support_velocity(other, p);
            assert_true(at.x == there.x && at.y == there.y && speed.x == its_speed.x && speed.y == its_speed.y);
        }
        mspring_network_destroy(alone);
        mspring_network_destroy(other);
        recipe_free(&made);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_give_the_bits_of_single_substeps),
        cmocka_unit_test(ropes_do_not_prevent_passes),
        cmocka_unit_test(small_networks_have_the_bits_of_others),
        cmocka_unit_test(any_number_of_workers_gives_the_same_bits),
        cmocka_unit_test(what_cannot_share_a_pass_does_not_prevent_those_of_others),
    };
    return cmocka_run_group_tests_name("passes", tests, NULL, NULL);
}
