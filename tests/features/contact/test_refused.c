/// @file test_refused.c
/// A step that is refused changes nothing of what follows, where bodies touch and particles have been added.
///
/// SPDX-License-Identifier: MIT
#include "support.h"

#define DT (1.0 / 64)

static mspring_network *block(void) {
    static const uint16_t cells[64] = {0};
    mspring_builder *builder = support_builder();
    mspring_material material;
    mspring_lattice_def lattice;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    material.stiffness = 1000;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
    lattice.width = lattice.height = 8;
    lattice.cells = cells;
    lattice.materials = &material;
    lattice.material_count = 1;
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
    mspring_network_def def = support_def(0, 8);
    def.spare_particles = 4;
    def.spare_springs = 8;
    def.settings.max_speed = 50;
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    check_ok(mspring_network_set_contact(network, &contact));
    return network;
}

static mspring_id add(mspring_network *network, double x, double y, float vy) {
    mspring_particle_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
    def.x = x;
    def.y = y;
    def.vy = vy;
    check_ok(mspring_network_add_particles(network, &def, 1, &id));
    return id;
}

static void join(mspring_network *network, mspring_id a, mspring_id b) {
    mspring_spring_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = a;
    def.b = b;
    def.stiffness = 100;
    def.rest_length = 1;
    check_ok(mspring_network_add_springs(network, &def, 1, &id));
}

static uint64_t hash(const mspring_network *network) {
    uint64_t value;
    check_ok(mspring_network_get_state_hash(network, &value));
    return value;
}

/// A particle is added far away, joined to the block and moved to it; then another one falls onto it.
static uint64_t future(bool is_refused_first) {
    mspring_network *network = block();
    const mspring_id added = add(network, 20, 20, 0);
    const double x = 0.5, y = 6.5;
    join(network, added, 0);
    join(network, added, 1);
    check_ok(mspring_network_apply_force(network, 5, 1e6f, 0));
    if (is_refused_first)
        check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    check_ok(mspring_network_apply_force(network, 5, -1e6f, 0));
    check_ok(mspring_network_set_positions(network, NULL, added, 1, &x, &y, 1));
    add(network, 0.5, 8.5, -3);
    support_steps(network, 40, DT);
    const uint64_t value = hash(network);
    mspring_network_destroy(network);
    return value;
}

static void a_refused_step_changes_no_outline(void **state) {
    (void)state;
    assert_true(future(true) == future(false));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_refused_step_changes_no_outline)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
