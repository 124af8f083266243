/// @file test_yield_law.c
/// One spring that yields, by the numbers of its law; what it may be given, and what is refused.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "kernels/yield_law.h"
#include "support.h"

// A pinned particle, and another at x on a spring of length 1 that lies at rest.
static mspring_network *one_spring(const mspring_spring_def *def, uint32_t events) {
    mspring_builder *builder = support_builder();
    (void)support_pinned(builder, 0, 0, 1);
    (void)support_pinned(builder, 1, 0, 1);
    check_ok(mspring_builder_add_springs(builder, def, 1, NULL));
    const mspring_network_def network_def = support_def(0, 4);
    mspring_network *network = support_network(builder, &network_def);
    check_ok(mspring_network_reserve_events(network, events));
    return network;
}

static mspring_spring_def ductile(void) {
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = 0;
    def.b = 1;
    def.stiffness = 100;
    def.yield_strain = 0.1f;
    def.hardening = 0.25f;
    def.plastic_limit = 0.3f;
    return def;
}

static float property_of(const mspring_network *network, mspring_property property) {
    float value = NAN;
    check_ok(mspring_network_get(network, property, NULL, 0, 1, &value, 1));
    return value;
}

static void pull_to(mspring_network *network, double x) {
    const double y = 0;
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &x, &y, 1));
    support_steps(network, 1, 0.01);
}

static mspring_energy report_of(const mspring_network *network) {
    mspring_energy report = {.struct_size = sizeof report};
    check_ok(mspring_network_get_energy(network, &report));
    return report;
}

static void one_spring_follows_the_law(void **state) {
    (void)state;
    const mspring_spring_def def = ductile();
    mspring_network *network = one_spring(&def, 8);
    mspring_event event;
    uint32_t count;
    double elastic;
    pull_to(network, 1.09);
    check_near((double)property_of(network, MSPRING_PLASTIC_STRAIN), 0, 0);
    pull_to(network, 1.2); // t = 0.2, over = 0.1, dp = 0.1 / 1.25
    check_near((double)property_of(network, MSPRING_PLASTIC_STRAIN), 0.08, 1e-6);
    check_near((double)property_of(network, MSPRING_REST_LENGTH), 1, 0); // as given
    check_near((double)property_of(network, MSPRING_ACTIVE_REST_LENGTH), 1.08, 1e-6);
    check_near((double)property_of(network, MSPRING_STRAIN), 0.12 / 1.08, 1e-6);
    check_ok(mspring_network_read_events(network, &event, 1, &count, NULL));
    assert_int_equal(count, 1);
    assert_int_equal(event.kind, MSPRING_EVENT_YIELDED);
    check_near((double)event.strain, 0.08, 1e-6);
    // k (y dp + (1 + H) dp^2 / 2), and what is left: k (0.12^2 + H 0.08^2) / 2; both are k 0.2^2 / 2.
    check_near(report_of(network).dissipated, 100 * (0.1 * 0.08 + 1.25 * 0.08 * 0.08 / 2), 1e-5);
    check_ok(support_get_energy(network, NULL, &elastic, NULL));
    check_near(elastic + report_of(network).dissipated, 100 * 0.2 * 0.2 / 2, 1e-5);
    pull_to(network, 3); // the limit
    check_near((double)property_of(network, MSPRING_PLASTIC_STRAIN), 0.3, 1e-6);
    // Kinematic: at p = 0.3 it yields back below r0 (1 + p + H p - y) = 1.275.
    pull_to(network, 1.28);
    check_near((double)property_of(network, MSPRING_PLASTIC_STRAIN), 0.3, 1e-6);
    pull_to(network, 1.15); // over = 0.125, dp = 0.1
    check_near((double)property_of(network, MSPRING_PLASTIC_STRAIN), 0.2, 1e-6);
    assert_int_equal(report_of(network).yield_count, 3);
    mspring_network_destroy(network);
}

static void it_breaks_by_its_total_strain(void **state) {
    (void)state;
    mspring_spring_def def = ductile();
    uint32_t flags = 0;
    def.break_strain = 0.5f;
    def.plastic_limit = 0.9f;
    def.hardening = 0;
    mspring_network *network = one_spring(&def, 0);
    for (double x = 1.02; x < 1.495; x += 0.02)
        pull_to(network, x);
    check_ok(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, 1, &flags, 1));
    assert_false(flags & MSPRING_SPRING_BROKEN);
    assert_true(property_of(network, MSPRING_STRAIN) < 0.11f);
    pull_to(network, 1.51);
    check_ok(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, 1, &flags, 1));
    assert_true(flags & MSPRING_SPRING_BROKEN);
    mspring_network_destroy(network);
}

static void it_is_straightened_and_scaled(void **state) {
    (void)state;
    const mspring_spring_def def = ductile();
    mspring_network *network = one_spring(&def, 0);
    const float none = 0, twice = 2, dent = -0.25f;
    pull_to(network, 1.2);
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, 1, &twice, 1)); // a winch: the bend stays
    check_near((double)property_of(network, MSPRING_PLASTIC_STRAIN), 0.08, 1e-6);
    check_near((double)property_of(network, MSPRING_ACTIVE_REST_LENGTH), 2.16, 1e-6);
    check_ok(mspring_network_set(network, MSPRING_PLASTIC_STRAIN, NULL, 0, 1, &none, 1));
    check_near((double)property_of(network, MSPRING_REST_LENGTH), 2, 1e-6);
    assert_int_equal(report_of(network).bent_springs, 0);
    check_ok(mspring_network_set(network, MSPRING_PLASTIC_STRAIN, NULL, 0, 1, &dent, 1));
    check_near((double)property_of(network, MSPRING_ACTIVE_REST_LENGTH), 1.5, 1e-6);
    // A copy in a builder has the same.
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_network(builder, network, NULL, 0, MSPRING_ALL, NULL, NULL));
    const mspring_network_def network_def = support_def(0, 4);
    mspring_network *copy = support_network(builder, &network_def);
    for (int p = MSPRING_YIELD_STRAIN; p <= MSPRING_PLASTIC_STRAIN; p++)
        check_near((double)property_of(copy, (mspring_property)p),
                   (double)property_of(network, (mspring_property)p), 0);
    mspring_network_destroy(copy);
    mspring_network_destroy(network);
}

static void bad_values_are_refused(void **state) {
    (void)state;
    static const struct {
        mspring_property property;
        float value;
    } bad[] = {{MSPRING_YIELD_STRAIN, 0},    {MSPRING_YIELD_STRAIN, NAN},     {MSPRING_HARDENING, -1},
               {MSPRING_HARDENING, 10.5f},   {MSPRING_HARDENING, INFINITY},   {MSPRING_PLASTIC_LIMIT, 0.95f},
               {MSPRING_PLASTIC_LIMIT, NAN}, {MSPRING_PLASTIC_STRAIN, 0.95f}, {MSPRING_PLASTIC_STRAIN, -1},
               {MSPRING_PLASTIC_STRAIN, NAN}};
    mspring_spring_def def = ductile();
    mspring_network *network = one_spring(&def, 0);
    for (size_t i = 0; i < COUNT_OF(bad); i++)
        check_error(mspring_network_set(network, bad[i].property, NULL, 0, 1, &bad[i].value, 1),
                    MSPRING_ERROR_ARGUMENT);
    mspring_builder *builder = support_builder();
    (void)support_particle(builder, 0, 0, 1);
    (void)support_particle(builder, 1, 0, 1);
    def.hardening = -1;
    check_error(mspring_builder_add_springs(builder, &def, 1, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "hardening");
    mspring_builder_destroy(builder);
    mspring_energy report = {.struct_size = 4};
    check_error(mspring_network_get_energy(network, &report), MSPRING_ERROR_STRUCT);
    check_error(mspring_network_get_energy(NULL, &report), MSPRING_ERROR_ARGUMENT);
    mspring_network_destroy(network);
}

/// Heat belongs to the length that a spring had before the substep that bent it.
static void the_length_before_a_substep_is_known(void **state) {
    (void)state;
    uint64_t seed = 5;
    for (int i = 0; i < 100; i++) {
        const double x = support_random_between(&seed, -2, 2), y = support_random_between(&seed, -2, 2);
        const double way_x = support_random_between(&seed, -1, 1), way_y = support_random_between(&seed, -1, 1);
        const float start =
            mspringi_yield_start((float)(x * x + y * y), (float)x, (float)y, (float)way_x, (float)way_y);
        check_near((double)start, hypot(x - way_x, y - way_y), 1e-3);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_spring_follows_the_law),
        cmocka_unit_test(the_length_before_a_substep_is_known),
        cmocka_unit_test(it_breaks_by_its_total_strain),
        cmocka_unit_test(it_is_straightened_and_scaled),
        cmocka_unit_test(bad_values_are_refused),
    };
    return cmocka_run_group_tests_name("yield_law", tests, NULL, NULL);
}
