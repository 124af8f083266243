/// @file test_limits.c
/// Break, stress and relax strains in definitions: all that makes springs has them, and networks begin with them.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "allocator.h"
#include "support.h"

#define MOST 64
#define DEFAULT MSPRING_RELAX_STRAIN_DEFAULT

/// Give a definition these three.
#define LIMIT(def, breaks, stresses, relaxes)                                                                      \
    ((def).break_strain = (breaks), (def).warn_strain = (stresses), (def).relax_strain = (relaxes))

static void check_limits(const mspring_network *network, mspring_id spring, float breaks, float stresses,
                         float relaxes) {
    const float expected[] = {breaks, stresses, relaxes};
    for (int i = 0; i < 3; i++) {
        float read = 0;
        check_ok(mspring_network_get(network, MSPRING_BREAK_STRAIN + i, NULL, spring, 1, &read, 1));
        assert_true(read == expected[i]);
    }
}

/// A row of particles, 1 m apart.
static mspring_builder *row(mspring_id count) {
    mspring_builder *builder = support_builder();
    for (mspring_id i = 0; i < count; i++) {
        support_particle(builder, i, 0, 1);
    }
    return builder;
}

static mspring_spring_def spring_between(mspring_id a, mspring_id b) {
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = a;
    def.b = b;
    def.stiffness = 100;
    return def;
}

static void springs_have_those_of_their_definition(void **state) {
    (void)state;
    mspring_builder *builder = row(7);
    mspring_spring_def defs[4];
    support_spring(builder, 0, 1, 100, 0);
    for (mspring_id i = 0; i < 4; i++) {
        defs[i] = spring_between(i + 1, i + 2);
    }
    LIMIT(defs[1], 0.5f, 0.25f, 0.125f);
    LIMIT(defs[2], INFINITY, 0.375f, DEFAULT);
    check_ok(mspring_builder_add_springs(builder, defs, 4, NULL));
    support_spring(builder, 5, 6, 100, 0);
    mspring_network *network = support_network(builder, NULL);
    for (mspring_id s = 0; s < 6; s++) {
        if (s != 2 && s != 3) {
            check_limits(network, s, MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
        }
    }
    check_limits(network, 2, 0.5f, 0.25f, 0.125f);
    check_limits(network, 3, MSPRING_NEVER, 0.375f, DEFAULT);
    mspring_network_destroy(network);
}

static void ropes_meshes_and_discs_have_them_in_all_springs(void **state) {
    (void)state;
    mspring_builder *builder = row(2);
    const double x[] = {0, 1, 0}, y[] = {10, 10, 11};
    const uint32_t corners[] = {0, 1, 2};
    mspring_material rope_material = mspring_material_default();
    mspring_rope_def rope;
    mspring_material mesh_material = mspring_material_default();
    mspring_mesh_def mesh;
    mspring_material disc_material = mspring_material_default();
    mspring_disc_def disc;
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &rope, sizeof rope));
    rope.material = &rope_material;
    check_ok(mspring_init(MSPRING_STRUCT_MESH_DEF, &mesh, sizeof mesh));
    mesh.material = &mesh_material;
    mesh.area_density = 1;
    check_ok(mspring_init(MSPRING_STRUCT_DISC_DEF, &disc, sizeof disc));
    disc.material = &disc_material;
    disc.area_density = 1;
    support_spring(builder, 0, 1, 100, 0);
    rope.from = 0;
    rope.to = support_particle(builder, 0, -3, 1);
    rope.segment_count = 3;
    LIMIT(rope_material, 0.5f, 0.25f, 0.125f);
    mesh.vertex_count = 3;
    mesh.triangle_count = 1;
    mesh.x = x;
    mesh.y = y;
    mesh.triangles = corners;
    LIMIT(mesh_material, 1.5f, MSPRING_NEVER, DEFAULT);
    disc.x = 100;
    LIMIT(disc_material, MSPRING_NEVER, 2.25f, 0);
    check_ok(mspring_builder_add_rope(builder, &rope, NULL, NULL));
    check_ok(mspring_builder_add_mesh(builder, &mesh, NULL, NULL));
    check_ok(mspring_builder_add_disc(builder, &disc, NULL, NULL));
    mspring_network *network = support_network(builder, NULL);
    assert_int_equal(mspring_network_count(network, MSPRING_SPRINGS), 1 + 3 + 3 + 12);
    check_limits(network, 0, MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
    for (mspring_id s = 1; s < 19; s++) {
        if (s < 4) {
            check_limits(network, s, 0.5f, 0.25f, 0.125f);
        } else if (s < 7) {
            check_limits(network, s, 1.5f, MSPRING_NEVER, DEFAULT);
        } else {
            check_limits(network, s, MSPRING_NEVER, 2.25f, 0);
        }
    }
    mspring_network_destroy(network);
}

static void lattice_springs_have_those_of_the_weaker_material(void **state) {
    (void)state;
    mspring_material materials[3];
    for (int i = 0; i < 3; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &materials[i], sizeof materials[i]));
        materials[i].stiffness = 10;
    }
    LIMIT(materials[1], 0.5f, 0.25f, 0.125f);
    LIMIT(materials[2], 0.375f, 0.3f, DEFAULT);
    const uint16_t cells[] = {0, 0, 1, 1, 2, 2};
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    def.width = 6;
    def.height = 1;
    def.material_count = 3;
    def.cells = cells;
    def.materials = materials;
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    mspring_network *network = support_network(builder, NULL);
    check_limits(network, 0, MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
    check_limits(network, 1, 0.5f, 0.25f, 0.125f);
    check_limits(network, 2, 0.5f, 0.25f, 0.125f);
    check_limits(network, 3, 0.375f, 0.25f, 0.125f); // breaks as the one, relaxes as the other
    check_limits(network, 4, 0.375f, 0.3f, DEFAULT);
    mspring_network_destroy(network);
}

/// A lattice that falls apart, and which of its springs were stressed or broken first.
static uint64_t fall(mspring_network *network, mspring_event *events, uint32_t *count) {
    check_ok(mspring_network_reserve_events(network, MOST));
    support_kick(network, 0, 60);
    support_kick(network, 12, -60);
    support_steps(network, 40, 1.0 / 64);
    check_ok(mspring_network_read_events(network, events, MOST, count, NULL));
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

static mspring_network *small_lattice(float breaks, float stresses, float relaxes) {
    const uint16_t cells[5 * 4] = {0};
    mspring_material material;
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    material.stiffness = 100;
    LIMIT(material, breaks, stresses, relaxes);
    def.width = 5;
    def.height = 4;
    def.material_count = 1;
    def.cells = cells;
    def.materials = &material;
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    const mspring_network_def settings = support_def(-9.8f, 8);
    return support_network(builder, &settings);
}

static void springs_break_as_if_the_strains_had_been_set(void **state) {
    (void)state;
    const float breaks = 0.3f, stresses = 0.1f, relaxes = 0.05f;
    mspring_event given_events[MOST], set_events[MOST];
    uint32_t given_count = 0, set_count = 0;
    const uint64_t given = fall(small_lattice(breaks, stresses, relaxes), given_events, &given_count);
    mspring_network *network = small_lattice(MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, springs, &breaks, 0));
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, springs, &stresses, 0));
    check_ok(mspring_network_set(network, MSPRING_RELAX_STRAIN, NULL, 0, springs, &relaxes, 0));
    assert_true(given == fall(network, set_events, &set_count));
    assert_true(given_count > 10);
    assert_int_equal(given_count, set_count);
    for (uint32_t i = 0; i < given_count; i++) {
        assert_int_equal(given_events[i].kind, set_events[i].kind);
        assert_int_equal(given_events[i].id, set_events[i].id);
    }
}

static void added_springs_have_them(void **state) {
    (void)state;
    for (size_t fail_at = 0;; fail_at++) {
        watched_allocator watched = {0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_builder *builder = row(5);
        support_spring(builder, 0, 1, 100, 0);
        mspring_network_def settings = support_def(-9.8f, 8);
        settings.spare_springs = 4;
        settings.allocator = &allocator;
        mspring_network *network = support_network(builder, &settings);
        mspring_spring_def defs[] = {spring_between(1, 2), spring_between(2, 3), spring_between(3, 4)};
        mspring_id ids[] = {MSPRING_NONE, MSPRING_NONE, MSPRING_NONE};
        LIMIT(defs[1], 0.5f, 0.25f, 0.125f);
        const uint64_t hash = support_hash(network);
        watched.fail_at = fail_at > 0 ? watched.calls + fail_at : 0;
        const mspring_result result = mspring_network_add_springs(network, defs, 3, ids);
        if (result != MSPRING_OK) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_int_equal(mspring_network_count(network, MSPRING_SPRINGS), 1);
            assert_int_equal(ids[0], MSPRING_NONE);
            assert_true(support_hash(network) == hash);
            check_ok(mspring_network_add_springs(network, defs, 3, ids));
        }
        check_limits(network, ids[0], MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
        check_limits(network, ids[1], 0.5f, 0.25f, 0.125f);
        check_limits(network, ids[2], MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
        // Whoever has the id next begins anew.
        check_ok(mspring_network_remove_springs(network, &ids[1], 0, 1));
        check_ok(mspring_network_reuse_ids(network));
        LIMIT(defs[1], MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
        const mspring_id had = ids[1];
        check_ok(mspring_network_add_springs(network, &defs[1], 1, &ids[1]));
        assert_int_equal(ids[1], had);
        check_limits(network, ids[1], MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
        if (fail_at > 0 && result == MSPRING_OK) {
            assert_true(fail_at > 3);
            return;
        }
    }
}

static void networks_give_them_to_builders(void **state) {
    (void)state;
    mspring_network *network = small_lattice(0.5f, MSPRING_NEVER, DEFAULT);
    const float stresses = 0.25f, relaxes = 0.125f;
    const mspring_id broken = 2;
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 7, 1, &stresses, 0));
    check_ok(mspring_network_set(network, MSPRING_RELAX_STRAIN, NULL, 9, 1, &relaxes, 0));
    check_ok(mspring_network_break_springs(network, &broken, 0, 1));
    mspring_builder *builder = row(2);
    support_spring(builder, 0, 1, 100, 0);
    mspring_id ids[MOST];
    check_ok(mspring_builder_add_network(builder, network, NULL, 0, MSPRING_ALL, NULL, ids));
    mspring_network *copy = support_network(builder, NULL);
    check_limits(copy, 0, MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
    for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++) {
        if (s != broken) {
            check_limits(copy, ids[s], 0.5f, s == 7 ? stresses : MSPRING_NEVER, s == 9 ? relaxes : DEFAULT);
        }
    }
    mspring_network_destroy(network);
    mspring_network_destroy(copy);
}

static void wrong_ones_are_refused_and_leave_nothing(void **state) {
    (void)state;
    const float bad[][3] = {{0, 1, 1}, {NAN, 1, 1}, {1, -1, 1}, {1, 0, 1}, {1, 1, -0.5f}, {1, 1, NAN}};
    const char *names[] = {"break", "break", "warn", "warn", "relax", "relax"};
    mspring_builder *builder = row(4);
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        mspring_spring_def defs[] = {spring_between(0, 1), spring_between(1, 2)};
        mspring_material rope_material = mspring_material_default();
        mspring_rope_def rope;
        mspring_material disc_material = mspring_material_default();
        mspring_disc_def disc;
        check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &rope, sizeof rope));
        rope.material = &rope_material;
        check_ok(mspring_init(MSPRING_STRUCT_DISC_DEF, &disc, sizeof disc));
        disc.material = &disc_material;
        disc.area_density = 1;
        rope.from = 0;
        rope.to = 3;
        LIMIT(defs[0], 0.5f, 0.25f, 0.125f);
        LIMIT(defs[1], bad[i][0], bad[i][1], bad[i][2]);
        LIMIT(rope_material, bad[i][0], bad[i][1], bad[i][2]);
        LIMIT(disc_material, bad[i][0], bad[i][1], bad[i][2]);
        check_error(mspring_builder_add_springs(builder, defs, 2, NULL), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_builder_error(builder), "definition 1: spring 1: ");
        check_contains(support_builder_error(builder), names[i]);
        check_error(mspring_builder_add_rope(builder, &rope, NULL, NULL), MSPRING_ERROR_ARGUMENT);
        check_contains(support_builder_error(builder), names[i]);
        check_error(mspring_builder_add_disc(builder, &disc, NULL, NULL), MSPRING_ERROR_ARGUMENT);
        check_contains(support_builder_error(builder), names[i]);
    }
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 4);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 0);
    // What was rejected had some: the springs behind it have none.
    support_spring(builder, 0, 1, 100, 0);
    mspring_network *network = support_network(builder, NULL);
    check_limits(network, 0, MSPRING_NEVER, MSPRING_NEVER, DEFAULT);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_have_those_of_their_definition),
        cmocka_unit_test(ropes_meshes_and_discs_have_them_in_all_springs),
        cmocka_unit_test(lattice_springs_have_those_of_the_weaker_material),
        cmocka_unit_test(springs_break_as_if_the_strains_had_been_set),
        cmocka_unit_test(added_springs_have_them),
        cmocka_unit_test(networks_give_them_to_builders),
        cmocka_unit_test(wrong_ones_are_refused_and_leave_nothing),
    };
    return cmocka_run_group_tests_name("limits", tests, NULL, NULL);
}
