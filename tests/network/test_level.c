/// @file test_level.c
/// Where the host leaves the level to the library, small networks run at AVX2 or SSE2 if these are no slower, and
/// no bit changes. Other networks run at the best level, and so do narrow ones if the host asks for it.
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
    const outcome seen = {support_simd_level(network), support_hash(network)};
    mspring_network_destroy(network);
    return seen;
}

static const recipe_stuff stuff = {.mass = {0.5, 2}, .stiffness = {500, 3000}};

// The best level of this machine, or a narrower one that suits.
static mspring_simd expected(mspring_simd suits) {
    const mspring_simd best = support_best_level();
    return (best == MSPRING_SIMD_AVX512 || best == MSPRING_SIMD_AVX2) && suits < best ? suits : best;
}

static void check_level_is(const recipe *made, mspring_simd suits) {
    const outcome chosen = run(made, MSPRING_SIMD_AUTO), best = run(made, support_best_level());
    assert_int_equal(chosen.level, expected(suits));
    assert_int_equal(best.level, support_best_level());
    assert_int_equal(chosen.hash, best.hash);
}

static void check_level(const recipe *made, bool is_narrow) {
    check_level_is(made, is_narrow ? MSPRING_SIMD_AVX2 : MSPRING_SIMD_AVX512);
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

/// Chains and small irregular parts, by the registers that they fill.
static void small_networks(void **state) {
    (void)state;
    static const struct {
        uint32_t width, height;
        mspring_simd suits;
    } cases[] = {{2, 1, MSPRING_SIMD_SSE2},    {4, 1, MSPRING_SIMD_SSE2},   {5, 1, MSPRING_SIMD_AVX2},
                 {8, 1, MSPRING_SIMD_AVX2},    {9, 1, MSPRING_SIMD_AVX512}, {16, 1, MSPRING_SIMD_AVX512},
                 {17, 1, MSPRING_SIMD_AVX2},   {24, 1, MSPRING_SIMD_AVX2},  {25, 1, MSPRING_SIMD_AVX512},
                 {40, 1, MSPRING_SIMD_AVX512}, {2, 2, MSPRING_SIMD_SSE2},   {3, 2, MSPRING_SIMD_AVX2},
                 {4, 2, MSPRING_SIMD_AVX2},    {3, 3, MSPRING_SIMD_AVX512}, {4, 4, MSPRING_SIMD_AVX512}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        recipe made = {0};
        uint64_t seed = 7;
        recipe_lattice(&made, cases[i].width, cases[i].height, 0, 0, 1, &stuff, &seed);
        recipe_disturb(&made, 0.05, 0.5, &seed);
        check_level_is(&made, cases[i].suits);
        recipe_free(&made);
    }
}

/// A bundle fills registers with equal components.
static void a_bundle_is_wide(void **state) {
    (void)state;
    recipe made = {0};
    uint64_t seed = 7;
    for (uint32_t i = 0; i < 16; i++) {
        recipe_lattice(&made, 3, 1, 10.0 * i, 0, 1, &stuff, &seed);
    }
    check_level(&made, false);
    recipe_free(&made);
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
        cmocka_unit_test(small_networks),
        cmocka_unit_test(a_bundle_is_wide),
        cmocka_unit_test(many_narrow_lattices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
