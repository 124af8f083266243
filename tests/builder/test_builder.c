/// @file test_builder.c
/// What a builder makes of good input: dense ids in the order of adding, lattices and ropes as documented.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "support.h"

static void ids_are_dense_and_in_order(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 0);
    assert_string_equal(support_builder_error(builder), "");
    for (mspring_id i = 0; i < 100; i++) {
        assert_int_equal(support_particle(builder, i, 0, 1), i);
    }
    for (mspring_id i = 0; i < 99; i++) {
        assert_int_equal(support_spring(builder, i + 1, i, 1, 0), i);
    }
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 100);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 99);
    mspring_builder_destroy(builder);
}

static void bulk_adds_return_the_first_id(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_particle_def particles[40];
    mspring_spring_def springs[39];
    mspring_id first = MSPRING_NONE;
    for (size_t i = 0; i < COUNT_OF(particles); i++) {
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particles[i], sizeof particles[i]));
        particles[i].x = (double)i;
        particles[i].mass = 1.0f + (float)i;
    }
    support_particle(builder, -5, 0, 1);
    check_ok(mspring_builder_add_particles(builder, particles, COUNT_OF(particles), &first));
    assert_int_equal(first, 1);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 41);
    for (size_t i = 0; i < COUNT_OF(springs); i++) {
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &springs[i], sizeof springs[i]));
        springs[i].a = (mspring_id)i + 1;
        springs[i].b = (mspring_id)i + 2;
        springs[i].stiffness = (float)i;
    }
    support_spring(builder, 0, 1, 7, 0);
    check_ok(mspring_builder_add_springs(builder, springs, COUNT_OF(springs), &first));
    assert_int_equal(first, 1);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 40);
    check_ok(mspring_builder_add_particles(builder, particles, 1, NULL));
    springs[0].b = 41; // lies where 1 lies
    springs[0].rest_length = 1;
    check_ok(mspring_builder_add_springs(builder, springs, 1, NULL));

    mspring_network *network = support_network(builder, NULL);
    float masses[42];
    check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, 42, masses, 1));
    for (size_t i = 0; i < COUNT_OF(particles); i++) {
        assert_true(masses[1 + i] == particles[i].mass);
        assert_true(support_position(network, 1 + (mspring_id)i).x == particles[i].x);
    }
    support_spring_info info;
    check_ok(support_get_spring(network, 5, &info));
    assert_int_equal(info.a, 5);
    assert_int_equal(info.b, 6);
    assert_true(info.stiffness == 4);
    mspring_network_destroy(network);
}

static void null_handles_count_nothing(void **state) {
    (void)state;
    assert_int_equal(mspring_builder_count(NULL, MSPRING_PARTICLES), 0);
    assert_int_equal(mspring_builder_count(NULL, MSPRING_SPRINGS), 0);
    assert_string_equal(support_builder_error(NULL), "");
    mspring_builder_destroy(NULL);
}

/* ---------------------------------------------------------------------------------------------- lattices */

#define E MSPRING_CELL_EMPTY

/// The lattice of the tests below: two materials, holes, and a diagonal that only its corner joins.
///     row 0 (top)   0 1 . 0
///     row 1         1 . 0 1
///     row 2         . 0 0 .
static const uint16_t cells[3][4] = {{0, 1, E, 0}, {1, E, 0, 1}, {E, 0, 0, E}};
static const mspring_id ids[3][4] = {
    {0, 1, MSPRING_NONE, 2}, {3, MSPRING_NONE, 4, 5}, {MSPRING_NONE, 6, 7, MSPRING_NONE}};

/// Its springs by the documented rule: for each particle those to the right, lower left, below, lower right.
static const mspring_id ends[][2] = {
    {0, 1}, {0, 3},         // 0: right, below (no lower left column, lower right is a hole)
    {1, 3}, {1, 4},         // 1: lower left, lower right
    {2, 4}, {2, 5},         // 2: lower left, below
    {3, 6},                 // 3: lower right
    {4, 5}, {4, 6}, {4, 7}, // 4: right, lower left, below
    {5, 7},                 // 5: lower left
    {6, 7},                 // 6: right
};

static void fill_materials(mspring_material materials[2]) {
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &materials[i], sizeof materials[i]));
    }
    materials[0].mass = 2;
    materials[0].stiffness = 100;
    materials[0].damping = 8;
    materials[1].mass = 3;
    materials[1].stiffness = 300;
    materials[1].damping = 2;
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
}

static mspring_lattice_def lattice_of(const mspring_material *materials) {
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    def.width = 4;
    def.height = 3;
    def.material_count = 2;
    def.materials = materials;
    def.cells = &cells[0][0];
    def.x = 10;
    def.y = -3;
    def.spacing = 0.5;
    return def;
}

static void lattice_ids_and_springs_follow_the_cells(void **state) {
    (void)state;
    mspring_material materials[2];
    fill_materials(materials);
    mspring_lattice_def def = lattice_of(materials);
    mspring_builder *builder = support_builder();
    mspring_id given[3][4];
    check_ok(mspring_builder_add_lattice(builder, &def, &given[0][0]));
    assert_memory_equal(given, ids, sizeof ids);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 8);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), COUNT_OF(ends));

    mspring_network *network = support_network(builder, NULL);
    mspring_view view = {.struct_size = sizeof view};
    float masses[8];
    check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, 8, masses, 1));
    check_ok(mspring_network_get_view(network, &view));
    const uint16_t *material_of = &cells[0][0];
    for (size_t row = 0; row < 3; row++) {
        for (size_t column = 0; column < 4; column++) {
            mspring_id id = ids[row][column];
            if (id == MSPRING_NONE) {
                continue;
            }
            const mspring_material *material = &materials[material_of[row * 4 + column]];
            support_point p = support_position(network, id);
            assert_true(p.x == 10 + 0.5 * (double)column && p.y == -3 + 0.5 * (double)(2 - row));
            assert_true(masses[id] == material->mass);
            assert_int_equal(view.inverse_mass[view.slot_of_particle[id]] == 0, material->particle_flags != 0);
        }
    }
    for (mspring_id spring = 0; spring < COUNT_OF(ends); spring++) {
        support_spring_info info;
        check_ok(support_get_spring(network, spring, &info));
        assert_int_equal(info.a, ends[spring][0]);
        assert_int_equal(info.b, ends[spring][1]);
        support_point a = support_position(network, info.a), b = support_position(network, info.b);
        assert_true(info.rest_length == (float)(a.x != b.x && a.y != b.y ? 0.5 * sqrt(2.0) : 0.5));
        bool heavy_a = masses[info.a] == 3, heavy_b = masses[info.b] == 3;
        assert_true(info.stiffness == (heavy_a && heavy_b ? 300 : heavy_a || heavy_b ? 200 : 100));
        assert_true(info.damping == (heavy_a && heavy_b ? 2 : heavy_a || heavy_b ? 5 : 8));
    }
    mspring_network_destroy(network);
}

static void lattice_after_other_particles(void **state) {
    (void)state;
    mspring_material materials[2];
    fill_materials(materials);
    mspring_lattice_def def = lattice_of(materials);
    mspring_builder *builder = support_builder();
    support_spring(builder, support_particle(builder, 0, 0, 1), support_particle(builder, 1, 0, 1), 1, 0);
    mspring_id given[3][4];
    check_ok(mspring_builder_add_lattice(builder, &def, &given[0][0]));
    for (size_t cell = 0; cell < 12; cell++) {
        mspring_id expected = (&ids[0][0])[cell];
        assert_int_equal((&given[0][0])[cell], expected == MSPRING_NONE ? MSPRING_NONE : expected + 2);
    }
    mspring_network *network = support_network(builder, NULL);
    for (mspring_id spring = 0; spring < COUNT_OF(ends); spring++) {
        support_spring_info info;
        check_ok(support_get_spring(network, spring + 1, &info));
        assert_int_equal(info.a, ends[spring][0] + 2);
        assert_int_equal(info.b, ends[spring][1] + 2);
    }
    mspring_network_destroy(network);
}

static void lattice_of_one_cell_and_of_none(void **state) {
    (void)state;
    mspring_material materials[2];
    fill_materials(materials);
    mspring_lattice_def def = lattice_of(materials);
    const uint16_t one[] = {1}, none[] = {E, E, E};
    mspring_builder *builder = support_builder();
    mspring_id given[3] = {9, 9, 9};
    def.width = def.height = 1;
    def.cells = one;
    check_ok(mspring_builder_add_lattice(builder, &def, given));
    assert_int_equal(given[0], 0);
    assert_int_equal(given[1], 9);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 1);
    def.width = 3;
    def.cells = none;
    check_ok(mspring_builder_add_lattice(builder, &def, given));
    assert_int_equal(given[0], MSPRING_NONE);
    assert_int_equal(given[2], MSPRING_NONE);
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 1);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 0);
    mspring_builder_destroy(builder);
}

/// Without cells all are of the first material.
static void lattice_without_cells_is_full(void **state) {
    (void)state;
    static const uint16_t zeros[12] = {0};
    mspring_material materials[2];
    fill_materials(materials);
    mspring_lattice_def def = lattice_of(materials);
    mspring_builder *full = support_builder(), *given = support_builder();
    mspring_id numbers[12] = {0};
    def.cells = NULL;
    check_ok(mspring_builder_add_lattice(full, &def, numbers));
    assert_int_equal(numbers[11], 11);
    def.cells = zeros;
    check_ok(mspring_builder_add_lattice(given, &def, NULL));
    assert_int_equal(mspring_builder_count(full, MSPRING_SPRINGS), mspring_builder_count(given, MSPRING_SPRINGS));
    mspring_network *a = support_network(full, NULL), *b = support_network(given, NULL);
    support_steps(a, 20, 0.01);
    support_steps(b, 20, 0.01);
    assert_int_equal(support_hash(a), support_hash(b));
    mspring_network_destroy(a);
    mspring_network_destroy(b);
}

/* ------------------------------------------------------------------------------------------------- ropes */

static void rope_runs_evenly_from_end_to_end(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_id from = support_pinned(builder, 1, 1, 5), to = support_particle(builder, 4, 5, 5);
    mspring_material def_material = mspring_material_default();
    mspring_rope_def def;
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &def, sizeof def));
    def.material = &def_material;
    def.from = from;
    def.to = to;
    def.segment_count = 5;
    def_material.mass = 0.25f;
    def_material.stiffness = 70;
    def_material.damping = 3;
    def.length_ratio = 1.5f;
    mspring_id first_spring = MSPRING_NONE, chain[7] = {9, 9, 9, 9, 9, 9, 9};
    check_ok(mspring_builder_add_rope(builder, &def, chain, &first_spring));
    const mspring_id filled[] = {from, 2, 3, 4, 5, to, 9};
    assert_memory_equal(chain, filled, sizeof chain);
    assert_int_equal(first_spring, 0);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 6);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 5);

    // A rope of one segment is a spring and no particle. Outputs may be NULL.
    def.segment_count = 1;
    def.to = 2;
    def.from = 5;
    def.length_ratio = 1;
    check_ok(mspring_builder_add_rope(builder, &def, chain, &first_spring));
    assert_int_equal(chain[0], 5);
    assert_int_equal(chain[1], 2);
    assert_int_equal(chain[2], 3); // of the rope before
    assert_int_equal(first_spring, 5);
    def.from = 3;
    def.to = 5;
    check_ok(mspring_builder_add_rope(builder, &def, NULL, NULL));
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 6);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 7);

    mspring_network *network = support_network(builder, NULL);
    float masses[6];
    check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, 6, masses, 1));
    const mspring_id along[] = {from, 2, 3, 4, 5, to};
    for (size_t i = 0; i < 6; i++) {
        support_point p = support_position(network, along[i]);
        // The state is float, relative to an origin among coordinates up to 5: half an ulp of 4 is 2.4e-7.
        check_near(p.x, 1 + 0.6 * (double)i, 2.4e-7);
        check_near(p.y, 1 + 0.8 * (double)i, 2.4e-7);
        assert_true(masses[along[i]] == (i == 0 || i == 5 ? 5.0f : 0.25f));
    }
    for (mspring_id spring = 0; spring < 5; spring++) {
        support_spring_info info;
        check_ok(support_get_spring(network, spring, &info));
        assert_int_equal(info.a, along[spring]);
        assert_int_equal(info.b, along[spring + 1]);
        assert_true(info.stiffness == 70 && info.damping == 3 && info.rest_length == 1.5f);
        // 1 m long at a rest length of 1.5 m.
        check_near(info.strain, -1.0 / 3.0, 1e-6); // a few ulp of the length
    }
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------- rest length */

static void rest_length_is_the_distance_or_as_given(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    // A distance of 5 m at coordinates where a float's ulp is 0.06 m: it is taken in double.
    support_particle(builder, 1e6, 1e6, 1);
    support_particle(builder, 1e6 + 3, 1e6 + 4, 1);
    support_particle(builder, 1e6 + 3, 1e6, 1);
    support_spring(builder, 1, 0, 1, 0);
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = 2;
    def.b = 0;
    def.rest_length = 0.125f;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
    mspring_network *network = support_network(builder, NULL);
    support_spring_info info;
    check_ok(support_get_spring(network, 0, &info));
    assert_true(info.rest_length == 5);
    check_near(info.strain, 0, 1e-6); // a few ulp of the length
    check_ok(support_get_spring(network, 1, &info));
    assert_true(info.rest_length == 0.125f);
    mspring_network_destroy(network);
}

static void one_builder_makes_many_equal_networks(void **state) {
    (void)state;
    mspring_material materials[2];
    fill_materials(materials);
    mspring_lattice_def lattice = lattice_of(materials);
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
    mspring_network *first = NULL, *second = NULL, *third = NULL;
    mspring_network_def def = support_def(-9.8f, 4);
    check_ok(mspring_network_create(builder, &def, &first));
    check_ok(mspring_network_create(builder, &def, &second));
    // What is added afterwards is not in them.
    support_particle(builder, 100, 100, 1);
    assert_int_equal(mspring_network_count(first, MSPRING_PARTICLES), 8);
    check_ok(mspring_network_create(builder, &def, &third));
    mspring_builder_destroy(builder);
    assert_int_equal(mspring_network_count(third, MSPRING_PARTICLES), 9);
    support_steps(first, 20, 0.01);
    assert_int_not_equal(support_hash(first), support_hash(second));
    support_steps(second, 20, 0.01);
    assert_int_equal(support_hash(first), support_hash(second));
    mspring_network_destroy(first);
    mspring_network_destroy(second);
    mspring_network_destroy(third);
}

static void lattice_is_the_same_as_its_parts_added_one_by_one(void **state) {
    (void)state;
    mspring_material materials[2];
    fill_materials(materials);
    mspring_lattice_def lattice = lattice_of(materials);
    mspring_builder *whole = support_builder(), *parts = support_builder();
    check_ok(mspring_builder_add_lattice(whole, &lattice, NULL));
    for (size_t row = 0; row < 3; row++) {
        for (size_t column = 0; column < 4; column++) {
            if (ids[row][column] != MSPRING_NONE) {
                double x = 10 + 0.5 * (double)column, y = -3 + 0.5 * (double)(2 - row);
                if (cells[row][column] == 1) {
                    support_pinned(parts, x, y, 3);
                } else {
                    support_particle(parts, x, y, 2);
                }
            }
        }
    }
    for (size_t i = 0; i < COUNT_OF(ends); i++) {
        const uint16_t pinned[] = {0, 1, 0, 1, 0, 1, 0, 0}; // by id, from the picture of the cells above
        int heavy = pinned[ends[i][0]] + pinned[ends[i][1]];
        support_spring(parts, ends[i][0], ends[i][1], 100.0f + 100.0f * (float)heavy, 8.0f - 3.0f * (float)heavy);
    }
    mspring_network_def def = support_def(-9.8f, 3);
    mspring_network *a = support_network(whole, &def), *b = support_network(parts, &def);
    support_steps(a, 50, 0.01);
    support_steps(b, 50, 0.01);
    assert_int_equal(support_hash(a), support_hash(b));
    mspring_network_destroy(a);
    mspring_network_destroy(b);
}

/* --------------------------------------------------------------------------------------------- reading back */

/// By a range and by a list, whose begin is a place in it.
static void definitions_are_read_back(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 4; i++)
        support_particle(builder, i, 2 * i, 1 + (float)i);
    support_spring(builder, 0, 1, 10, 1);
    support_spring(builder, 2, 3, 20, 2);
    mspring_particle_def particles[2] = {mspring_particle_def_default(), mspring_particle_def_default()};
    mspring_spring_def springs[2] = {mspring_spring_def_default(), mspring_spring_def_default()};
    const mspring_id list[] = {77, 3, 1};
    check_ok(mspring_builder_get_particles(builder, list, 1, 2, particles));
    assert_true(particles[0].x == 3 && particles[0].y == 6 && particles[0].mass == 4);
    assert_true(particles[1].x == 1 && particles[1].mass == 2);
    check_ok(mspring_builder_get_springs(builder, NULL, 0, 2, springs));
    assert_true(springs[0].a == 0 && springs[0].stiffness == 10 && springs[1].b == 3 && springs[1].damping == 2);
    check_ok(mspring_builder_get_particles(builder, NULL, 4, 0, NULL));
    // Reading is no description: what is wrong with it is not kept.
    check_error(mspring_builder_get_particles(builder, list, 0, 2, particles), MSPRING_ERROR_ID);
    check_contains(mspring_builder_error(builder), "index 0 of the list: ids are below 4, not 77");
    check_error(mspring_builder_get_springs(builder, list, 2, MSPRING_ALL, springs), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_builder_get_springs(builder, NULL, 0, MSPRING_ALL, springs), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_builder_get_springs(builder, NULL, 1, UINT32_MAX - 1, springs), MSPRING_ERROR_ID);
    mspring_network *network = support_network(builder, NULL);
    assert_int_equal(mspring_network_count(network, MSPRING_PARTICLES), 4);
    mspring_network_destroy(network);
}

static void definition_of_a_builder_without_archive_is_the_default(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_network_def expected = mspring_network_def_default();
    mspring_network_def def = {.struct_size = sizeof def};
    check_ok(mspring_builder_get_network_def(builder, &def));
    assert_memory_equal(&def, &expected, sizeof def);
    assert_int_equal(def.settings.struct_size, sizeof def.settings);
    mspring_builder_destroy(builder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ids_are_dense_and_in_order),
        cmocka_unit_test(bulk_adds_return_the_first_id),
        cmocka_unit_test(null_handles_count_nothing),
        cmocka_unit_test(lattice_ids_and_springs_follow_the_cells),
        cmocka_unit_test(lattice_after_other_particles),
        cmocka_unit_test(lattice_of_one_cell_and_of_none),
        cmocka_unit_test(lattice_without_cells_is_full),
        cmocka_unit_test(rope_runs_evenly_from_end_to_end),
        cmocka_unit_test(rest_length_is_the_distance_or_as_given),
        cmocka_unit_test(one_builder_makes_many_equal_networks),
        cmocka_unit_test(lattice_is_the_same_as_its_parts_added_one_by_one),
        cmocka_unit_test(definitions_are_read_back),
        cmocka_unit_test(definition_of_a_builder_without_archive_is_the_default),
    };
    return cmocka_run_group_tests_name("builder", tests, NULL, NULL);
}
