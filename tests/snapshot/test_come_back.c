/// @file test_come_back.c
/// A network that has been changed since, and loads a snapshot of before, goes on as one that was never changed.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <stdlib.h>

#include "recipe.h"
#include "snapshots.h"
#include "support.h"

/// What has been done to it.
typedef enum change {
    MASSES,
    PINS,
    FORCES,
    ANGLES,
    FEWER_ANGLES,
    AREAS,
    LENGTHS,
    FRACTIONS,
    THRESHOLDS,
    CHANGES
} change;

static void add_angles(mspring_network *network, uint32_t count) {
    mspring_angle_def angle;
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
    angle.stiffness = 5;
    check_ok(mspring_network_add_angles(network, &angle, (const mspring_id[]){0, 1, 2, 5, 6, 7, 10, 11, 12}, count, 3,
                                        NULL));
}

static mspring_network *make(void) {
    uint64_t seed = 8;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {0.1, 0.2}, .damping = {0, 0.05}, .spring_flags = MSPRING_SPRING_RELATIVE};
    recipe made = {0};
    recipe_lattice(&made, 20, 5, 0, 0, 1, &stuff, &seed);
    const mspring_id end = recipe_particle(&made, -8, 0, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 0, end, 9, &(recipe_stuff){.mass = {1, 1}, .stiffness = {50, 50}}, &seed);
    recipe_disturb(&made, 0.02, 0.1, &seed);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    add_angles(network, 2);
    support_steps(network, 2, 1.0 / 64);
    return network;
}

static void set(mspring_network *network, mspring_property property, float value) {
    check_ok(mspring_network_set(network, property, NULL, 3, 60, &value, 0));
}

static void apply(mspring_network *network, change what) {
    const mspring_id ids[] = {0, 1};
    mspring_area_def area;
    switch (what) {
    case MASSES:
        set(network, MSPRING_MASS, 7);
        break;
    case PINS:
        set(network, MSPRING_INVERSE_MASS_SCALE, 0);
        break;
    case FORCES:
        for (mspring_id p = 0; p < 50; p++)
            check_ok(mspring_network_apply_force(network, p, 300, -200));
        break;
    case ANGLES:
        add_angles(network, 3);
        break;
    case FEWER_ANGLES:
        check_ok(mspring_network_remove_elements(network, ids, 0, 1));
        break;
    case AREAS:
        check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
        area.stiffness = 30;
        check_ok(mspring_network_add_cell_areas(network, &area, NULL, NULL));
        break;
    case LENGTHS:
        set(network, MSPRING_REST_LENGTH, 1.5f);
        break;
    case FRACTIONS:
        set(network, MSPRING_STIFFNESS, 0.05f);
        break;
    default:
        set(network, MSPRING_BREAK_STRAIN, 1e-3f);
    }
}

static void whatever_was_changed(void **state) {
    (void)state;
    mspring_network *plain = make();
    const saved before = snapshots_save(plain, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_apply_force(plain, 4, 1, 2));
    support_steps(plain, 5, 1.0 / 64);
    for (change what = MASSES; what < CHANGES; what++) {
        for (int steps = 0; steps < 2; steps++) {
            mspring_network *network = make();
            apply(network, what);
            (void)!mspring_network_step(network, steps / 64.0);
            if (steps > 0)
                apply(network, FORCES);
            snapshots_load(network, &before);
            check_ok(mspring_network_apply_force(network, 4, 1, 2)); // what is left of others would act with it
            support_steps(network, 5, 1.0 / 64);
            assert_true(support_hash(network) == support_hash(plain));
            mspring_network_destroy(network);
        }
    }
    mspring_network_destroy(plain);
    free(before.bytes);
}

/// A network without dampers has no room for damping, however little.
static void damping_does_not_come_from_outside(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (int p = 0; p < 3; p++)
        (void)support_particle(builder, p, 0, 1);
    (void)support_spring(builder, 0, 1, 100, 0);
    (void)support_spring(builder, 1, 2, 100, 0);
    const mspring_network_def def = support_def(0, 4);
    mspring_network *network = support_network(builder, &def);
    saved forged = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    uint8_t *values = snapshots_section_of(&forged, "valu", &size);
    snapshots_put_float(values + size / 2 + sizeof(float), 0.125f);
    snapshots_check_refused(network, &forged, "spring 1 has stiffness 100, damping 0.125");
    free(forged.bytes);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whatever_was_changed),
        cmocka_unit_test(damping_does_not_come_from_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
