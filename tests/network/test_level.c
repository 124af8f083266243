/// @file test_level.c
/// Where the host leaves the level to the library, narrow lattices run at AVX2 where AVX-512 is there, and no bit
/// changes. Other networks run at the best level, and so do narrow ones if the host asks for it.
///
/// SPDX-License-Identifier: MIT
#include "recipe.h"
#include "support.h"

typedef struct outcome {
    mspring_simd level;
    uint64_t hash;
} outcome;

static outcome run(const recipe *made, mspring_simd setting) {
    mspring_network_def def = support_def(-9.8f, 8);
    def.simd_level = setting;
    mspring_network *network = recipe_network(made, &def);
    support_steps(network, 20, 1.0 / 64);
    const outcome seen = {mspring_network_simd_level(network), support_hash(network)};
    mspring_network_destroy(network);
    return seen;
}

static const recipe_stuff stuff = {.mass = {0.5, 2}, .stiffness = {500, 3000}};

static mspring_simd expected(bool is_narrow) {
    const mspring_simd best = mspring_simd_supported();
    return is_narrow && best == MSPRING_SIMD_AVX512 ? MSPRING_SIMD_AVX2 : best;
}

static void check_level(const recipe *made, bool is_narrow) {
    const outcome chosen = run(made, MSPRING_SIMD_AUTO), best = run(made, mspring_simd_supported());
    assert_int_equal(chosen.level, expected(is_narrow));
    assert_int_equal(best.level, mspring_simd_supported());
    assert_int_equal(chosen.hash, best.hash);
}

static void narrow_lattices(void **state) {
    (void)state;
    static const struct {
        uint32_t width, height;
        bool is_narrow;
    } cases[] = {{5, 5, true},    {6, 6, true},    {8, 8, true},    {5, 40, false},  {9, 9, false},
                 {12, 12, false}, {16, 16, false}, {17, 17, false}, {24, 24, false}, {40, 40, false}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        recipe made = {0};
        uint64_t seed = 7;
        recipe_lattice(&made, cases[i].width, cases[i].height, 0, 0, 1, &stuff, &seed);
        recipe_disturb(&made, 0.05, 0.5, &seed);
        check_level(&made, cases[i].is_narrow);
        recipe_free(&made);
    }
}

/// Side by side they share rows, which fill the widest registers.
static void many_narrow_lattices(void **state) {
    (void)state;
    recipe made = {0};
    uint64_t seed = 7;
    for (uint32_t i = 0; i < 32; i++) {
        recipe_lattice(&made, 6, 6, 10.0 * i, 0, 1, &stuff, &seed);
    }
    recipe_disturb(&made, 0.05, 0.5, &seed);
    check_level(&made, false);
    recipe_free(&made);
}

int main(void) {
    support_set_variable("MSPRING_SIMD", NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(narrow_lattices),
        cmocka_unit_test(many_narrow_lattices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
