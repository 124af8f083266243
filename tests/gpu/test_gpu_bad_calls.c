/// @file test_gpu_bad_calls.c
/// Hostile calls, and networks that a batch can't have: the message names the culprit, and nothing changes.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "batches.h"

enum { BODIES = 3, PARTICLES = 3, SPRINGS = 3 };

static char message[1024];

static mspring_gpu_def plain_def(void) {
    mspring_gpu_def def = mspring_gpu_def_default();
    def.message = message;
    def.message_size = sizeof message;
    message[0] = '\0';
    return def;
}

/// What is odd about a network.
typedef enum oddity {
    NOTHING,
    OTHER_MASS,
    OTHER_STIFFNESS,
    OTHER_ENDS,
    LOOSE,
    BREAKS,
    YIELDS,
    PULLS_ONLY,
    IS_PRECISE,
} oddity;

// Triangles, each a group.
static mspring_network *triangles(oddity odd) {
    mspring_builder *builder = support_builder();
    const mspring_id firsts[] = {0, PARTICLES, 2 * PARTICLES, 3 * PARTICLES};
    for (mspring_id body = 0; body < BODIES; body++) {
        const mspring_id first = body * PARTICLES;
        for (int i = 0; i < PARTICLES; i++)
            (void)support_particle(builder, i, i % 2, odd == OTHER_MASS && body == 1 && i == 2 ? 2 : 1);
        for (mspring_id i = 0; i < SPRINGS; i++) {
            mspring_spring_def def;
            check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
            def.a = first + i;
            def.b = first + (i + 1) % PARTICLES;
            def.stiffness = odd == OTHER_STIFFNESS && body == 2 && i == 1 ? 90 : 100;
            def.break_strain = odd == BREAKS ? 0.5f : MSPRING_NEVER;
            def.yield_strain = odd == YIELDS ? 0.5f : MSPRING_NEVER;
            def.flags = odd == PULLS_ONLY ? MSPRING_SPRING_PULL_ONLY : 0;
            if (odd == OTHER_ENDS && body == 1 && i == 0) {
                def.a = first + 1;
                def.b = first;
            }
            if (odd != LOOSE || i == 0)
                check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
        }
    }
    mspring_network_def def = support_def(-9.8f, 8);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    def.flags = odd == IS_PRECISE ? MSPRING_NETWORK_PRECISE : 0;
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_set_groups(network, firsts, BODIES));
    return network;
}

static void check_not_taken(mspring_network *network, mspring_gpu_def def, mspring_result expected, const char *part) {
    mspring_gpu *gpu = NULL;
    const uint64_t hash = support_hash(network);
    check_error(mspring_gpu_create(network, &def, &gpu), expected);
    check_contains(message, part);
    assert_null(gpu);
    assert_true(hash == support_hash(network));
}

static void odd_networks(void **state) {
    (void)state;
    const struct {
        oddity odd;
        const char *part;
    } cases[] = {{OTHER_MASS, "particle 5 has another mass"},      {OTHER_STIFFNESS, "spring 7 has another stiffness"},
                 {OTHER_ENDS, "spring 3 has other ends"},          {LOOSE, "3 have none"},
                 {BREAKS, "no break strain, but spring 0"},        {YIELDS, "no yield strain, but spring 0"},
                 {PULLS_ONLY, "one-way, but spring 0"},            {IS_PRECISE, "MSPRING_NETWORK_PRECISE"}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        mspring_network *network = triangles(cases[i].odd);
        check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, cases[i].part);
        mspring_network_destroy(network);
    }
}

static void changed_networks(void **state) {
    (void)state;
    const mspring_id corners[] = {0, 1, 2}, spring = 4, particle = 4;
    const mspring_id firsts[] = {0, 3, 6, 9}, uneven[] = {0, 3, 9}, fewer[] = {0, 6};
    const float heights[] = {0, 0}, scale = 0.5f;
    mspring_network *network = triangles(NOTHING);
    mspring_area_def area;
    mspring_floor_def floor_def;
    mspring_contact_def contact;
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "broken, but spring 4 is");
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0));
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor_def, sizeof floor_def));
    floor_def.heights = heights;
    floor_def.height_count = 2;
    check_ok(mspring_network_set_floor(network, &floor_def));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "2 heights");
    check_ok(mspring_network_set_floor(network, NULL));
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    check_ok(mspring_network_set_contact(network, &contact));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "no contact");
    check_ok(mspring_network_set_contact(network, NULL));
    check_ok(mspring_network_apply_force(network, 5, 10, 0));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "differ after a step");
    mspring_network_destroy(network);
    network = triangles(NOTHING);
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, particle, 1, &scale, 1));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "particle 4 has another scale");
    mspring_network_destroy(network);
    network = triangles(NOTHING);
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    area.stiffness = 1;
    check_ok(mspring_network_add_area(network, &area, corners, 3, NULL));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "the network has 1");
    mspring_network_destroy(network);
    network = triangles(NOTHING);
    check_ok(mspring_network_set_groups(network, uneven, 2));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "2 groups don't share");
    check_ok(mspring_network_set_groups(network, fewer, 1));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "group 0 has fewer particles");
    check_ok(mspring_network_set_groups(network, firsts, BODIES));
    check_ok(mspring_network_step(network, 0.01));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "before its first step");
    check_ok(mspring_network_set_groups(network, NULL, 0));
    check_not_taken(network, plain_def(), MSPRING_ERROR_ARGUMENT, "no groups");
    mspring_network_destroy(network);
}

static void bad_definitions(void **state) {
    (void)state;
    mspring_network *network = triangles(NOTHING);
    const mspring_id twice[] = {1, 1}, none = SPRINGS, one = 1;
    mspring_gpu *gpu = NULL;
    mspring_gpu_def def = plain_def();
    check_error(mspring_gpu_def_init(NULL, sizeof def), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_def_init(&def, 4), MSPRING_ERROR_STRUCT);
    check_error(mspring_gpu_create(NULL, &def, &gpu), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_create(network, NULL, &gpu), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_create(network, &def, NULL), MSPRING_ERROR_ARGUMENT);
    def.struct_size = 3;
    check_error(mspring_gpu_create(network, &def, &gpu), MSPRING_ERROR_STRUCT);
    def = plain_def();
    def.changes = 0;
    check_not_taken(network, def, MSPRING_ERROR_ARGUMENT, "changes is 0");
    def = plain_def();
    def.body_count = 2;
    check_not_taken(network, def, MSPRING_ERROR_ARGUMENT, "body_count is 2");
    def.body_count = UINT32_MAX;
    check_not_taken(network, def, MSPRING_ERROR_LIMIT, "4294967295 bodies");
    def = plain_def();
    def.actuators = twice;
    def.actuator_count = 2;
    check_not_taken(network, def, MSPRING_ERROR_DUPLICATE, "1");
    def.actuators = NULL;
    check_not_taken(network, def, MSPRING_ERROR_ARGUMENT, "the list is NULL");
    def.actuators = &none;
    def.actuator_count = 1;
    check_not_taken(network, def, MSPRING_ERROR_ID, "no spring 3");
    def = plain_def();
    def.device = 1000;
    check_not_taken(network, def, MSPRING_ERROR_DEVICE, "no device 1000");
    def = plain_def();
    def.library = "/no/such/library.so";
    check_not_taken(network, def, MSPRING_ERROR_DEVICE, "/no/such/library.so");
    def = plain_def();
    def.actuators = &one;
    def.actuator_count = 1;
    def.message_size = 0;
    check_ok(mspring_gpu_create(network, &def, &gpu));
    assert_string_equal(mspring_gpu_error(gpu), "");
    mspring_gpu_destroy(gpu);
    mspring_network_destroy(network);
}

static void bad_calls(void **state) {
    (void)state;
    mspring_network *network = triangles(NOTHING);
    mspring_gpu *gpu = NULL;
    mspring_gpu_def def = plain_def();
    const mspring_id actuator = 1;
    const mspring_observation strain = {MSPRING_STRAIN, 0}, none = {(mspring_property)0x3f, 0},
                              second = {MSPRING_GROUP_Y, 1}, middle[] = {{MSPRING_GROUP_X, 0}, second};
    const float good = 1, bad = 200;
    double row[2] = {7, 7}, x, y;
    float vx, vy;
    uint32_t flags;
    uint64_t hash;
    def.actuators = &actuator;
    def.actuator_count = 1;
    check_ok(mspring_gpu_create(network, &def, &gpu));
    check_error(mspring_gpu_step(NULL, 1), MSPRING_ERROR_ARGUMENT);
    const double steps[] = {0, -1, NAN, INFINITY, 1e-60, 1e300};
    for (size_t i = 0; i < COUNT_OF(steps); i++) {
        check_error(mspring_gpu_step(gpu, steps[i]), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_gpu_error(gpu), "dt is");
    }
    check_error(mspring_gpu_set_signals(gpu, 0, BODIES + 1, &good, 0), MSPRING_ERROR_ID);
    check_error(mspring_gpu_set_signals(gpu, UINT32_MAX, UINT32_MAX, &good, 0), MSPRING_ERROR_ID);
    check_error(mspring_gpu_set_signals(gpu, 0, 1, NULL, 0), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_set_signals(gpu, 2, 1, &bad, 0), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_gpu_error(gpu), "actuator 2: the signal is 200");
    check_error(mspring_gpu_get_flags(gpu, 1, BODIES, &flags, 1), MSPRING_ERROR_ID);
    check_error(mspring_gpu_get_flags(gpu, 0, 1, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_get_flags(gpu, 0, 1, &flags, 0), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_gpu_get_flags(gpu, BODIES, 0, NULL, 1));
    check_error(mspring_gpu_observe(gpu, 0, 1, &strain, 1, row, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_gpu_error(gpu), "column 0: a device cannot observe property 0x113");
    check_error(mspring_gpu_observe(gpu, 0, 1, &none, 1, row, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_observe(gpu, 0, 1, middle, 2, row, 2), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_gpu_error(gpu), "column 1 is of the body itself: its index is 1");
    check_error(mspring_gpu_observe(gpu, 0, 1, middle, 2, row, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_gpu_error(gpu), "a row has 2 columns");
    check_error(mspring_gpu_observe(gpu, 0, 1, NULL, 1, row, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_observe(gpu, 0, 1, middle, 1, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_observe(gpu, UINT32_MAX, 1, middle, 1, row, 1), MSPRING_ERROR_ID);
    check_ok(mspring_gpu_observe(gpu, 0, BODIES, NULL, 0, row, 1));
    check_ok(mspring_gpu_observe(gpu, 0, 0, middle, 1, NULL, 1));
    assert_true(row[0] == 7 && row[1] == 7);
    check_error(mspring_gpu_get_positions(gpu, 8, 2, &x, &y, 1), MSPRING_ERROR_ID);
    check_error(mspring_gpu_get_positions(gpu, 8, 1, &x, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_get_velocities(gpu, 8, 1, NULL, &vy, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_get_velocities(gpu, 0, UINT32_MAX, &vx, &vy, 1), MSPRING_ERROR_ID);
    check_error(mspring_gpu_get_state_hash(gpu, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_gpu_reset(NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_gpu_get_state_hash(gpu, &hash));
    assert_true(hash == support_hash(network));
    assert_int_equal(mspring_gpu_body_count(NULL), 0);
    assert_string_equal(mspring_gpu_error(NULL), "");
    mspring_gpu_destroy(NULL);
    mspring_gpu_destroy(gpu);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(odd_networks), cmocka_unit_test(changed_networks),
                                       cmocka_unit_test(bad_definitions), cmocka_unit_test(bad_calls)};
    batch_need_device();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
