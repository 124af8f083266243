/// @file test_masses.c
/// New masses, by range, by stride and by list: an impulse moves each particle by its new mass, however heavy it is.
/// Pins stay pinned.
///
/// SPDX-License-Identifier: MIT
#include "support.h"

#define COUNT 5

enum { BY_RANGE, BY_STRIDE, BY_LIST, WAYS };

static const float masses[COUNT] = {0.125f, 1, 8, 64, 512};

static mspring_network *make_particles(uint32_t pinned) {
    mspring_builder *builder = support_builder();
    for (uint32_t p = 0; p < COUNT; p++) {
        mspring_particle_def def;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
        def.x = p;
        def.mass = 16;
        def.flags = p == pinned ? MSPRING_PARTICLE_PINNED : 0;
        check_ok(mspring_builder_add_particles(builder, &def, 1, NULL));
    }
    const mspring_network_def def = support_def(0, 1);
    return support_network(builder, &def);
}

static void set_masses(mspring_network *network, int way) {
    const mspring_id backwards[COUNT] = {4, 3, 2, 1, 0};
    float listed[COUNT], wide[2 * COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        listed[i] = masses[backwards[i]];
        wide[2 * i] = masses[i];
        wide[2 * i + 1] = -1;
    }
    if (way == BY_LIST) {
        check_ok(mspring_network_set(network, MSPRING_MASS, backwards, 0, COUNT, listed, 1));
    } else {
        check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 0, COUNT, way == BY_STRIDE ? wide : masses, way == BY_STRIDE ? 2 : 1));
    }
}

static void impulses_move_particles_by_their_new_masses(void **state) {
    (void)state;
    for (int way = 0; way < WAYS; way++) {
        for (uint32_t pinned = 0; pinned <= COUNT; pinned++) {
            mspring_network *network = make_particles(pinned);
            set_masses(network, way);
            for (mspring_id p = 0; p < COUNT; p++) {
                const float x = 1, y = 2;
                check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, &p, 0, 1, &x, &y, 1));
                const support_point v = support_velocity(network, p);
                assert_true(v.x == (p == pinned ? 0 : 1 / (double)masses[p])); // powers of two: exact
                assert_true(v.y == (p == pinned ? 0 : 2 / (double)masses[p]));
            }
            mspring_network_destroy(network);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(impulses_move_particles_by_their_new_masses)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
