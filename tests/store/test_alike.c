/// @file test_alike.c
/// Lattice blocks whose springs are alike are read from one record: what is edited afterwards is not.
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring.h>

#include "recipe.h"
#include "store/network.h"
#include "support.h"

enum { WIDTH = 70, HEIGHT = 40 };

static const recipe_stuff absolute = {.mass = {1, 1}, .stiffness = {900, 900}, .damping = {2, 2}};
static const recipe_stuff relative = {
    .mass = {1, 1}, .stiffness = {0.2, 0.2}, .damping = {0.05, 0.05}, .spring_flags = MSPRING_SPRING_RELATIVE};

/// Springs first, first + step, ... are broken, or get these values.
typedef struct edits {
    mspring_id first, step;
    bool breaks;
    float stiffness, damping;
} edits;

static void edit(mspring_network *network, const edits *which) {
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    for (mspring_id s = which->first; s < count; s += which->step) {
        if (which->breaks) {
            check_ok(mspring_network_break_springs(network, &s, 0, 1));
        } else {
            check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, s, 1, &which->stiffness, 1));
            check_ok(mspring_network_set(network, MSPRING_DAMPING, NULL, s, 1, &which->damping, 1));
        }
    }
}

/// Blocks that read a record which is not their own; whose it is knows how many do.
static uint32_t blocks_that_share(const mspring_network *network, const mspringi_shared_records *alike) {
    uint32_t shared = 0, readers = 0;
    for (uint32_t b = 0; b < network->topology.lattice_blocks; b++) {
        shared += alike->of_block[b] != b;
        readers += alike->readers[b];
        assert_int_equal(alike->of_block[alike->of_block[b]], alike->of_block[b]);
        assert_true(alike->readers[b] == 0 || alike->of_block[b] == b);
    }
    assert_int_equal(readers, shared);
    return shared;
}

static uint32_t shared_blocks(const mspring_network *network) {
    return blocks_that_share(network, &network->shared_records);
}

/// The state after some steps of a network that is edited before or after its first step, which does not count.
static uint64_t run(const recipe *made, const edits *which, bool afterwards) {
    mspring_network_def def = support_def(-9.8f, 8);
    mspring_network *network = recipe_network(made, &def);
    static double x[WIDTH * HEIGHT], y[WIDTH * HEIGHT];
    static float vx[WIDTH * HEIGHT], vy[WIDTH * HEIGHT];
    check_ok(mspring_network_get_positions(network, NULL, 0, made->particle_count, x, y, 1));
    check_ok(mspring_network_get_velocities(network, NULL, 0, made->particle_count, vx, vy, 1));
    if (!afterwards) {
        edit(network, which);
    }
    check_ok(mspring_network_step(network, 1.0 / 64));
    if (afterwards) {
        // Most blocks have full rows and equal springs: all but those of the last columns and of the top.
        const uint32_t shared = shared_blocks(network);
        assert_true(shared >= network->topology.lattice_blocks / 2 || made->particle_count < WIDTH * HEIGHT);
        edit(network, which);
        // A single spring's block leaves the others, even if it is theirs that they read.
        assert_true(shared_blocks(network) + 1 >= shared || which->first + which->step < made->spring_count);
    }
    check_ok(mspring_network_set_positions(network, NULL, 0, made->particle_count, x, y, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, made->particle_count, vx, vy, 1));
    for (int i = 0; i < 4; i++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
    }
    uint64_t hash = 0;
    check_ok(mspring_network_get_state_hash(network, &hash));
    mspring_network_destroy(network);
    return hash;
}

static void edits_count_at_once(void **state) {
    (void)state;
    const edits all[] = {{.first = 1000, .step = 100000}, {.first = 1000, .step = 100000, .breaks = true},
                         {.first = 0, .step = 100000},    {.first = 200, .step = 100000, .breaks = true},
                         {.first = 7, .step = 97},        {.first = 7, .step = 97, .breaks = true},
                         {.first = 0, .step = 2},         {.first = 0, .step = 1}};
    const recipe_stuff *const stuffs[] = {&absolute, &relative};
    for (size_t i = 0; i < COUNT_OF(stuffs); i++) {
        uint64_t seed = 11;
        recipe made = {0};
        recipe_lattice(&made, WIDTH, HEIGHT, 0, 0, 1, stuffs[i], &seed);
        recipe_disturb(&made, 0, 0.5, &seed);
        const edits none = {.first = made.spring_count, .step = 1};
        const uint64_t unedited = run(&made, &none, true);
        for (size_t e = 0; e < COUNT_OF(all); e++) {
            edits some = all[e];
            some.stiffness = (float)(0.5 * stuffs[i]->stiffness[0]);
            some.damping = (float)(2 * stuffs[i]->damping[0]);
            const uint64_t hash = run(&made, &some, true);
            assert_true(hash != unedited);
            assert_true(hash == run(&made, &some, false));
        }
        recipe_free(&made);
    }
}

/// Whose record has one reader alone is edited by itself, too.
static void edits_of_few_blocks_count_at_once(void **state) {
    (void)state;
    const recipe_stuff *const stuffs[] = {&absolute, &relative};
    for (uint32_t i = 0; i < 6; i++) {
        uint64_t seed = 11;
        recipe made = {0};
        recipe_lattice(&made, 17 + 8 * (i / 2), 4, 0, 0, 1, stuffs[i % 2], &seed);
        recipe_disturb(&made, 0, 0.5, &seed);
        for (mspring_id spring = 0; spring < made.spring_count; spring += 11) {
            const edits one = {.first = spring,
                               .step = 100000,
                               .stiffness = (float)(0.5 * stuffs[i % 2]->stiffness[0]),
                               .damping = (float)(2 * stuffs[i % 2]->damping[0])};
            assert_true(run(&made, &one, true) == run(&made, &one, false));
        }
        recipe_free(&made);
    }
}

/// What is set back is shared again, whoever reads its record meanwhile.
static void blocks_join_again(void **state) {
    (void)state;
    const recipe_stuff *const stuffs[] = {&absolute, &relative};
    for (size_t i = 0; i < COUNT_OF(stuffs); i++) {
        uint64_t seed = 11;
        recipe made = {0};
        recipe_lattice(&made, WIDTH, HEIGHT, 0, 0, 1, stuffs[i], &seed);
        mspring_network_def def = support_def(-9.8f, 8);
        mspring_network *network = recipe_network(&made, &def);
        check_ok(mspring_network_step(network, 1.0 / 64));
        const uint32_t shared = shared_blocks(network);
        edits back = {.first = 0,
                      .step = 301,
                      .stiffness = (float)stuffs[i]->stiffness[0],
                      .damping = (float)stuffs[i]->damping[0]};
        edits some = back;
        some.stiffness *= 0.5f;
        for (int round = 0; round < 3; round++) {
            edit(network, &some);
            check_ok(mspring_network_step(network, 1.0 / 64));
            assert_true(shared_blocks(network) < shared - 30);
            edit(network, &back);
            check_ok(mspring_network_step(network, 1.0 / 64));
            // The one that others read may have changed places with one of them, which a block still goes by.
            assert_true(shared_blocks(network) + 1 >= shared);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void a_copy_shares_too(void **state) {
    (void)state;
    uint64_t seed = 11, hashes[2];
    recipe made = {0};
    recipe_lattice(&made, WIDTH, HEIGHT, 0, 0, 1, &absolute, &seed);
    recipe_disturb(&made, 0, 0.5, &seed);
    mspring_network_def def = support_def(-9.8f, 8);
    mspring_network *networks[2] = {recipe_network(&made, &def), NULL};
    check_ok(mspring_network_step(networks[0], 1.0 / 64));
    check_ok(mspring_network_clone(networks[0], NULL, &networks[1]));
    assert_int_equal(shared_blocks(networks[0]), shared_blocks(networks[1]));
    const edits some = {.first = 5, .step = 301, .stiffness = 400, .damping = 3};
    edit(networks[1], &some); // of the copy alone
    edit(networks[0], &some);
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_step(networks[i], 1.0 / 64));
        check_ok(mspring_network_get_state_hash(networks[i], &hashes[i]));
        mspring_network_destroy(networks[i]);
    }
    assert_true(hashes[0] == hashes[1]);
    recipe_free(&made);
}

/// The same of what springs yield at. What a block reads is what it has.
static uint32_t yielding_blocks_that_share(const mspring_network *network) {
    enum { PLACES = MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH };
    const mspringi_tested *p = &network->tested;
    const float *const arrays[] = {network->rest_lengths.lengths, p->low, p->high, p->flow_low, p->flow_high};
    for (size_t b = 0; b < network->topology.lattice_blocks; b++) {
        for (size_t i = 0; i < COUNT_OF(arrays); i++) {
            assert_memory_equal(arrays[i] + b * PLACES, arrays[i] + p->shared_records.of_block[b] * (size_t)PLACES,
                                PLACES * sizeof(float));
        }
    }
    return blocks_that_share(network, &p->shared_records);
}

/// Strike a particle so hard that its springs flow. Returns how many were bent.
static uint32_t strike(mspring_network *network, mspring_id particle) {
    const float vx = 40, vy = 30;
    mspring_energy report = {.struct_size = sizeof report};
    check_ok(mspring_network_set_velocities(network, NULL, particle, 1, &vx, &vy, 1));
    check_ok(mspring_network_step(network, 1.0 / 64));
    check_ok(mspring_network_get_energy(network, &report));
    return report.bent_springs;
}

/// Springs that yield share their rest lengths until they flow, and again when they are straightened.
static void what_flows_has_a_record_of_its_own(void **state) {
    (void)state;
    uint64_t seed = 11;
    recipe made = {0};
    recipe_lattice(&made, WIDTH, HEIGHT, 0, 0, 1, &absolute, &seed);
    mspring_network_def def = support_def(0, 8);
    mspring_network *network = recipe_network(&made, &def), *clone = NULL;
    const float yield_strain = 0.02f, straight = 0;
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, made.spring_count, &yield_strain, 0));
    check_ok(mspring_network_step(network, 1.0 / 64));
    const uint32_t shared = yielding_blocks_that_share(network);
    assert_true(shared >= network->topology.lattice_blocks / 2);
    uint32_t left = shared;
    for (mspring_id particle = 0; particle < made.particle_count;
         particle += 411) { // the first has what others read
        assert_true(strike(network, particle) > 0);
        assert_true(yielding_blocks_that_share(network) <= left);
        left = yielding_blocks_that_share(network);
    }
    assert_true(left > 0 && left < shared);
    check_ok(mspring_network_clone(network, NULL, &clone));
    assert_int_equal(yielding_blocks_that_share(clone), left);
    assert_true(strike(clone, WIDTH) > 0 && yielding_blocks_that_share(clone) <= left);
    mspring_network_destroy(clone);
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, made.spring_count, &(float){10}, 0));
    check_ok(mspring_network_set(network, MSPRING_PLASTIC_STRAIN, NULL, 0, made.spring_count, &straight, 0));
    check_ok(mspring_network_step(network, 1.0 / 64));
    assert_int_equal(yielding_blocks_that_share(network), shared);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_count_at_once),
        cmocka_unit_test(edits_of_few_blocks_count_at_once),
        cmocka_unit_test(a_copy_shares_too),
        cmocka_unit_test(blocks_join_again),
        cmocka_unit_test(what_flows_has_a_record_of_its_own),
    };
    return cmocka_run_group_tests_name("alike", tests, NULL, NULL);
}
