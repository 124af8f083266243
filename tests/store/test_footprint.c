/// @file test_footprint.c
/// How much memory a network takes, by particle.
///
/// SPDX-License-Identifier: MIT
#include "recipe.h"
#include "support.h"

/// What a particle of a full lattice may take all told: state and its backup (24 bytes each), four springs and
/// their places, maps.
#define MOST 142.0

static const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {100, 200}, .damping = {1, 2}};
static const recipe_stuff relative = {
    .mass = {1, 2}, .stiffness = {0.2, 0.2}, .damping = {0.05, 0.05}, .spring_flags = MSPRING_SPRING_RELATIVE};

static double bytes_per_particle(const recipe *made) {
    mspring_network *network = recipe_network(made, NULL);
    const double bytes = (double)mspring_network_memory_used(network) / made->particle_count;
    mspring_network_destroy(network);
    return bytes;
}

static void check_full_lattices(const recipe_stuff *of, const char *what) {
    const uint32_t sizes[][2] = {{128, 128}, {544, 68}, {68, 544}, {1000, 100}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        uint64_t seed = 5;
        recipe made = {0};
        recipe_lattice(&made, sizes[i][0], sizes[i][1], 0, 0, 1, of, &seed);
        const double bytes = bytes_per_particle(&made);
        print_message("%u x %u, %s springs: %.1f bytes per particle\n", (unsigned)sizes[i][0],
                      (unsigned)sizes[i][1], what, bytes);
        assert_true(bytes <= MOST);
        recipe_free(&made);
    }
}

static void full_lattices_are_small(void **state) {
    (void)state;
    check_full_lattices(&stuff, "absolute");
}

static void relative_springs_take_little_more(void **state) {
    (void)state;
    check_full_lattices(&relative, "relative");
}

/// Ids in any order take no more.
static void order_is_not_needed(void **state) {
    (void)state;
    uint64_t seed = 5;
    recipe made = {0};
    recipe_lattice(&made, 128, 128, 0, 0, 1, &stuff, &seed);
    recipe_shuffle(&made, &seed, NULL);
    const double bytes = bytes_per_particle(&made);
    print_message("shuffled: %.1f bytes per particle\n", bytes);
    assert_true(bytes <= MOST);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_lattices_are_small),
        cmocka_unit_test(relative_springs_take_little_more),
        cmocka_unit_test(order_is_not_needed),
    };
    return cmocka_run_group_tests_name("footprint", tests, NULL, NULL);
}
