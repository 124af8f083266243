/// @file test_defaults.c
/// Networks with the defaults step, whatever their springs are like: no frame is dropped, and none takes long.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "support.h"

#define DT (1.0 / 64)
#define WIDTH 20
#define HEIGHT 5

typedef struct matter {
    const char *name;
    uint32_t flags;
    float stiffness, damping;
    bool is_clamped;   ///< some steps are
    uint32_t substeps; ///< of a step; 0: more than one
} matter;

static const matter matters[] = {
    {"soft", 0, 10, 0, false, 1},
    {"iron", 0, 6.76e5f, 0, false, 0},
    {"as stiff as numbers go", 0, 1e14f, 0, true, 333},
    {"overdamped", 0, 100, 1e9f, true, 333},
    {"relative", MSPRING_SPRING_RELATIVE, 0.4f, 0.01f, false, 1},
    {"relative, too stiff for any shape", MSPRING_SPRING_RELATIVE, 0.7f, 0, false, 1},
    {"relative, too stiff", MSPRING_SPRING_RELATIVE, 3, 0, true, 1},
};

/// A bar that hangs at its left end, 1 kg a particle.
static mspring_builder *bar_of(const matter *is) {
    static const uint16_t cells[HEIGHT][WIDTH] = {{1}, {1}, {1}, {1}, {1}};
    mspring_material materials[2];
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &materials[i], sizeof materials[i]));
        materials[i].stiffness = is->stiffness;
        materials[i].damping = is->damping;
        materials[i].spring_flags = is->flags;
    }
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    def.width = WIDTH;
    def.height = HEIGHT;
    def.material_count = 2;
    def.cells = cells[0];
    def.materials = materials;
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    return builder;
}

static void no_frame_is_dropped(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(matters); i++) {
        const matter *is = &matters[i];
        mspring_network *network = support_network(bar_of(is), NULL);
        uint32_t most = 0;
        for (int step = 0; step < 200; step++) {
            check_ok(mspring_network_step(network, DT));
            const mspring_step_info info = support_step_info(network);
            most = info.substeps > most ? info.substeps : most;
            assert_true(support_largest_speed(network) < 200);
        }
        const uint64_t clamped = support_fallback_count(network);
        print_message("%s: up to %u substeps, %u of 200 steps clamped\n", is->name, (unsigned)most,
                      (unsigned)clamped);
        assert_true(is->substeps > 0 ? most == is->substeps : most > 1);
        assert_true(is->is_clamped ? clamped > 0 : clamped == 0);
        mspring_network_destroy(network);
    }
}

/// With the number that was chosen, it is as if it had been set.
static void relative_springs_have_the_bits_of_the_number_chosen(void **state) {
    (void)state;
    for (int is_mixed = 0; is_mixed < 2; is_mixed++) {
        uint64_t hash[2];
        uint32_t substeps = MSPRING_SUBSTEPS_AUTO;
        for (int twin = 0; twin < 2; twin++) {
            mspring_builder *builder = bar_of(&matters[5]);
            if (is_mixed) {
                const mspring_id a = support_particle(builder, 100, 0, 1), b = support_particle(builder, 101, 0, 1);
                support_spring(builder, a, b, 1e4f, 0);
                support_spring(builder, 7, a, 1e4f, 0);
            }
            mspring_network_def def = support_def(-9.8f, substeps);
            mspring_network *network = support_network(builder, &def);
            support_steps(network, 20, DT);
            substeps = support_substeps(network);
            hash[twin] = support_hash(network);
            mspring_network_destroy(network);
        }
        // With half of the room for them, h^2 k / m is at most 2 / 3.
        assert_true(is_mixed ? substeps >= 2 && substeps <= 5 : substeps == 1);
        assert_true(hash[0] == hash[1]);
    }
}

/// The search is not made again in each step, and what was edited is seen.
static void edits_change_the_number(void **state) {
    (void)state;
    mspring_builder *builder = bar_of(&matters[5]);
    const mspring_id a = support_particle(builder, 100, 0, 1);
    const mspring_id spring = support_spring(builder, 7, a, 1e5f, 0);
    mspring_network *network = support_network(builder, NULL);
    support_steps(network, 3, DT);
    const uint32_t before = support_substeps(network);
    const float stiffer = 1e7f;
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, spring, 1, &stiffer, 0));
    support_steps(network, 3, DT);
    const uint32_t after = support_substeps(network);
    assert_true(after >= 9 * before && after <= 11 * before);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_frame_is_dropped),
        cmocka_unit_test(relative_springs_have_the_bits_of_the_number_chosen),
        cmocka_unit_test(edits_change_the_number),
    };
    return cmocka_run_group_tests_name("defaults", tests, NULL, NULL);
}
