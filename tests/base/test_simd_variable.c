/// @file test_simd_variable.c
/// The environment variable MSPRING_SIMD and the setting simd_level: each lowers the level, neither raises it.
///
/// SPDX-License-Identifier: MIT
#include "support.h"

static mspring_simd level_with(const char *variable, mspring_simd setting) {
    support_set_variable("MSPRING_SIMD", variable);
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network_def def = support_def(0, 1);
    def.simd_level = setting;
    mspring_network *network = support_network(builder, &def);
    mspring_simd level = support_simd_level(network);
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    assert_int_equal(plan.simd_level, level);
    check_ok(mspring_network_step(network, 0.01)); // the machine does have it
    mspring_network_destroy(network);
    return level;
}

/// Lower a level to a limit. A limit that the machine lacks is ignored; scalar is the lowest level of the build.
static mspring_simd lower(mspring_simd level, mspring_simd limit) {
    const bool is_scalar = limit == MSPRING_SIMD_SCALAR;
    while (is_scalar && !mspring_simd_available(limit)) {
        limit++;
    }
    return mspring_simd_available(limit) && limit != MSPRING_SIMD_AUTO && limit < level ? limit : level;
}

static void each_lowers_and_neither_raises(void **state) {
    (void)state;
    const mspring_simd best = support_best_level();
    for (mspring_simd setting = MSPRING_SIMD_AUTO; setting <= MSPRING_SIMD_WASM; setting++) {
        mspring_simd alone = lower(best, setting);
        assert_int_equal(level_with(NULL, setting), alone);
        for (mspring_simd variable = MSPRING_SIMD_SCALAR; variable <= MSPRING_SIMD_WASM; variable++) {
            assert_int_equal(level_with(mspring_simd_name(variable), setting), lower(alone, variable));
        }
    }
}

static void other_values_change_nothing(void **state) {
    (void)state;
    const char *const values[] = {"", "auto", "AVX2 ", "scalarx", "sse", "4", "neon64"};
    for (size_t i = 0; i < COUNT_OF(values); i++) {
        assert_int_equal(level_with(values[i], MSPRING_SIMD_AUTO), support_best_level());
    }
}

static void the_variable_is_read_when_a_network_is_made(void **state) {
    (void)state;
    support_set_variable("MSPRING_SIMD", NULL);
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network *network = support_network(builder, NULL);
    support_set_variable("MSPRING_SIMD", "scalar");
    check_ok(mspring_network_step(network, 0.01));
    assert_int_equal(support_simd_level(network), support_best_level());
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_lowers_and_neither_raises),
        cmocka_unit_test(other_values_change_nothing),
        cmocka_unit_test(the_variable_is_read_when_a_network_is_made),
    };
    return cmocka_run_group_tests_name("simd_variable", tests, NULL, NULL);
}
