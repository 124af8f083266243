/// @file test_area_calls.c
/// Areas that are none: calls and snapshots are refused, and change nothing.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "support.h"

static mspring_area_def elastic(float stiffness) {
    mspring_area_def def;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def));
    def.stiffness = stiffness;
    return def;
}

// 4 x 4 particles.
static mspring_network *lattice(void) {
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < 16; i++)
        (void)support_particle(builder, i % 4, i / 4, 1);
    for (uint32_t i = 0; i < 16; i++) {
        if (i % 4 < 3)
            (void)support_spring(builder, i, i + 1, 100, 0);
        if (i < 12)
            (void)support_spring(builder, i, i + 4, 100, 0);
    }
    const mspring_network_def def = support_def(0, 12);
    return support_network(builder, &def);
}

static void bad_areas_are_refused(void **state) {
    (void)state;
    mspring_network *network = lattice();
    const mspring_id corners[] = {0, 1, 5, 4}, line[] = {0, 1, 2}, twice[] = {0, 1, 5, 1}, gone[] = {0, 1, 100};
    const mspring_area_def good = elastic(100);
    mspring_area_def bad[] = {good, good, good, good, good, good, good, good, good};
    bad[0].stiffness = -1;
    bad[1].stiffness = NAN;
    bad[2].pressure = INFINITY;
    bad[3].fill = 0;
    bad[4].rest_area = -1;
    bad[5].rest_area = NAN;
    bad[6].kind = bad[7].kind = MSPRING_AREA_GAS;
    bad[6].stiffness = 0;
    bad[6].pressure = -1;
    bad[8].kind = (mspring_area_kind)7;
    const uint64_t hash = support_hash(network);
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        check_error(mspring_network_add_area(network, &bad[i], corners, 4, NULL), MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_add_cell_areas(network, &bad[i], NULL, NULL), MSPRING_ERROR_ARGUMENT);
    }
    check_error(mspring_network_add_area(network, &good, line, 3, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_add_area(network, &good, twice, 4, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_add_area(network, &good, gone, 3, NULL), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "100");
    check_error(mspring_network_add_area(network, &good, corners, 2, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_add_area(network, &good, NULL, 4, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_add_area(network, NULL, corners, 4, NULL), MSPRING_ERROR_ARGUMENT);
    assert_true(support_hash(network) == hash);
    mspring_id area;
    check_ok(mspring_network_add_area(network, &good, corners, 4, &area));
    for (size_t i = 0; i < 6; i++) // the others are of another kind
        check_error(support_set_area(network, area, &bad[i]), MSPRING_ERROR_ARGUMENT);
    check_error(support_set_area(network, area + 1, &good), MSPRING_ERROR_ID);
    const mspring_id across[] = {0, 3, 15, 12}; // without springs along its sides
    check_ok(mspring_network_add_area(network, &good, across, 4, NULL));
    check_error(mspring_network_settle(network, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "area 1 ");
    mspring_network_destroy(network);
}

static mspring_result set_one(mspring_network *network, mspring_property property, mspring_id element, float value) {
    return mspring_network_set(network, property, NULL, element, 1, &value, 1);
}

// Numbers of an area, one by one: refused ones change nothing, and what an area lacks reads as 0.
static void numbers_are_properties(void **state) {
    (void)state;
    mspring_network *network = lattice();
    const mspring_id corners[] = {0, 1, 5, 4}, first[] = {0, 1, 2}, both[] = {1, 0};
    mspring_area_def gas = elastic(0);
    gas.kind = MSPRING_AREA_GAS;
    gas.pressure = 40;
    const mspring_angle_def angle = mspring_angle_def_default();
    check_ok(mspring_network_add_area(network, &gas, corners, 4, NULL));
    check_ok(mspring_network_add_angles(network, &angle, first, 1, 3, NULL));
    assert_int_equal(mspring_network_count(network, MSPRING_ELEMENTS), 2);
    check_error(set_one(network, MSPRING_ELEMENT_STIFFNESS, 0, 1), MSPRING_ERROR_ARGUMENT);
    check_error(set_one(network, MSPRING_PRESSURE, 0, -1), MSPRING_ERROR_ARGUMENT);
    check_error(set_one(network, MSPRING_REST_ANGLE, 0, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "element 0");
    check_contains(mspring_network_error(network), "rest angle");
    check_error(set_one(network, MSPRING_FILL, 1, 2), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "element 1");
    check_error(set_one(network, MSPRING_AREA, 0, 1), MSPRING_ERROR_ARGUMENT); // can only be read
    const float pressures[] = {7, -7}, fills[] = {2, 3};
    check_error(mspring_network_set(network, MSPRING_PRESSURE, both, 0, 2, pressures, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_FILL, NULL, 0, 2, fills, 1), MSPRING_ERROR_ARGUMENT);
    float pressure[2], fill[2];
    const mspring_column columns[] = {{MSPRING_PRESSURE, 1, pressure}, {MSPRING_FILL, 1, fill}};
    check_ok(mspring_network_get_columns(network, NULL, 0, 2, columns, 2));
    assert_true(pressure[0] == 40 && fill[0] == 1 && pressure[1] == 0 && fill[1] == 0);
    check_ok(set_one(network, MSPRING_PRESSURE, 0, 30));
    check_ok(mspring_network_remove_elements(network, NULL, 1, 1));
    uint32_t flags[2];
    check_ok(mspring_network_get_integers(network, MSPRING_ELEMENT_FLAGS, NULL, 0, 2, flags, 1));
    assert_int_equal(flags[0], MSPRING_ELEMENT_AREA);
    assert_int_equal(flags[1], MSPRING_ELEMENT_REMOVED);
    check_ok(mspring_network_set(network, MSPRING_FILL, NULL, 0, 2, fills, 1));
    check_ok(mspring_network_get_columns(network, NULL, 0, 2, columns, 2));
    assert_true(pressure[0] == 30 && fill[0] == 2 && pressure[1] == 0 && fill[1] == 0);
    mspring_network_destroy(network);
}

// A number that is set as it was read changes nothing: it wakes none, and frames fit.
static void what_was_read_may_be_set(void **state) {
    (void)state;
    static const mspring_property numbers[] = {MSPRING_ELEMENT_STIFFNESS, MSPRING_PRESSURE, MSPRING_FILL,
                                               MSPRING_REST_AREA};
    const mspring_id corners[] = {0, 2, 9}; // its area is no float
    const mspring_area_def def = elastic(100);
    mspring_network *network = lattice();
    support_shift(network, 2, 0.1, 0.03);
    check_ok(mspring_network_add_area(network, &def, corners, 3, NULL));
    size_t size;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &size));
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, bytes, size, NULL));
    for (size_t i = 0; i < COUNT_OF(numbers); i++) {
        float value;
        check_ok(mspring_network_get(network, numbers[i], NULL, 0, 1, &value, 1));
        check_ok(set_one(network, numbers[i], 0, value));
    }
    check_ok(mspring_network_load(network, bytes, size));
    free(bytes);
    mspring_network_destroy(network);
}

// Of corners on a line, rounding leaves areas of either sign, which are none.
static void flat_areas_are_refused(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < 4; i++)
        (void)support_particle(builder, 0.1 * (i + 1), 0.3 * (i + 1), 1);
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t j = i + 1; j < 4; j++)
            (void)support_spring(builder, i, j, 100, 0);
    const mspring_network_def network_def = support_def(0, 12);
    mspring_network *network = support_network(builder, &network_def);
    mspring_area_def def = elastic(100);
    const uint64_t hash = support_hash(network);
    for (uint32_t i = 0; i < 4; i++) {
        const mspring_id corners[] = {i, (i + 1) % 4, (i + 2) % 4};
        def.rest_area = 0;
        check_error(mspring_network_add_area(network, &def, corners, 3, NULL), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "1e-6 of the squared perimeter");
        def.rest_area = 0.01f; // which side is positive is not known, either
        check_error(mspring_network_add_area(network, &def, corners, 3, NULL), MSPRING_ERROR_ARGUMENT);
    }
    assert_true(support_hash(network) == hash);
    mspring_network_destroy(network);
}

// A = height / 2 of a triangle with a side of 1 and a perimeter of 2: the limit is a height of 8e-6. Its side lies
// on an axis, so rounding leaves its height.
static void least_areas_are_by_the_perimeter(void **state) {
    (void)state;
    static const mspring_id corners[] = {0, 1, 2};
    mspring_area_def def = elastic(100);
    mspring_id area;
    for (int i = 0; i < 2; i++) {
        mspring_builder *builder = support_builder();
        const double height = i == 0 ? 7.9e-6 : 8.1e-6;
        (void)support_particle(builder, 0, 0, 1);
        (void)support_particle(builder, 1, 0, 1);
        (void)support_particle(builder, 0.5, height, 1);
        const mspring_network_def network_def = support_def(0, 12);
        mspring_network *network = support_network(builder, &network_def);
        def.rest_area = 0;
        if (i == 0) {
            check_error(mspring_network_add_area(network, &def, corners, 3, NULL), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), "the area of particles 0, 1, 2");
            check_contains(mspring_network_error(network), "4e-06 to 1e24");
        } else {
            check_ok(mspring_network_add_area(network, &def, corners, 3, &area));
            def.rest_area = 3.9e-6f;
            check_error(support_set_area(network, area, &def), MSPRING_ERROR_ARGUMENT);
            check_error(mspring_network_add_area(network, &def, corners, 3, NULL), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), "the rest area of particles 0, 1, 2");
            def.rest_area = 4.1e-6f;
            check_ok(support_set_area(network, area, &def));
        }
        mspring_network_destroy(network);
    }
}

// A cell of height 1e-7: order and sign of its corners are right, but it is none.
static void flat_cells_are_refused(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < 4; i++)
        (void)support_particle(builder, i % 2, i < 2 ? 0 : 1e-7, 1);
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t j = i + 1; j < 4; j++)
            (void)support_spring(builder, i, j, 100, 0);
    const mspring_network_def network_def = support_def(0, 12);
    mspring_network *network = support_network(builder, &network_def);
    const mspring_area_def def = elastic(100);
    const uint64_t hash = support_hash(network);
    check_error(mspring_network_add_cell_areas(network, &def, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "squared perimeter");
    assert_true(support_hash(network) == hash);
    mspring_network_destroy(network);
}

// A snapshot that is cut, or has a byte changed, is refused or loaded, and nothing else happens.
static void damaged_snapshots_are_refused(void **state) {
    (void)state;
    static const mspring_id corners[] = {0, 1, 4};
    mspring_area_def def = elastic(0);
    mspring_id area;
    mspring_network *network = lattice();
    def.kind = MSPRING_AREA_GAS;
    def.pressure = 40;
    check_ok(mspring_network_add_area(network, &def, corners, 3, &area));
    size_t size;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, bytes, size, NULL));
    const uint64_t hash = support_hash(network);
    for (size_t cut = 0; cut < size; cut += 1 + size / 97)
        check_error(mspring_network_load(network, bytes, cut), MSPRING_ERROR_SNAPSHOT);
    assert_true(support_hash(network) == hash);
    check_ok(mspring_network_load(network, bytes, size));
    support_area_info info;
    check_ok(support_get_area_info(network, area, &info));
    check_near(info.pressure, 40, 1e-4);
    free(bytes);
    mspring_network_destroy(network);
}

// All joined to all, on a circle or in a row.
static mspring_network *clique(uint32_t count, bool is_round) {
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < count; i++) {
        const double angle = 2 * 3.14159265358979 * i / count;
        (void)support_particle(builder, is_round ? cos(angle) : i, is_round ? sin(angle) : 0, 1);
        for (uint32_t j = 0; j < i; j++)
            (void)support_spring(builder, i, j, 100, 0);
    }
    const mspring_network_def def = support_def(0, 12);
    return support_network(builder, &def);
}

// A clique of 10 has 210 cells, of 27 it has 17550, which is more than springs and more than there may be. In a row
// no two springs cross: 60 have no cell, and of 300 it takes too long to find out.
static void cells_above_each_other_are_counted(void **state) {
    (void)state;
    static const struct {
        uint32_t count, cells;
        bool is_round;
        const char *why;
    } cases[] = {{10, 210, true, NULL},
                 {27, 0, true, "over 16384 cells"},
                 {100, 0, true, "over 16384 cells"},
                 {60, 0, false, NULL},
                 {300, 0, false, "takes too long"}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        mspring_network *network = clique(cases[i].count, cases[i].is_round);
        const mspring_area_def def = elastic(1);
        const uint64_t hash = support_hash(network);
        mspring_id first = 77;
        uint32_t count = 77;
        if (cases[i].why) {
            check_error(mspring_network_add_cell_areas(network, &def, &first, &count), MSPRING_ERROR_LIMIT);
            check_contains(mspring_network_error(network), cases[i].why);
            check_contains(mspring_network_error(network), "mspring_network_add_area");
            assert_true(first == 77 && count == 77 && support_hash(network) == hash);
        } else {
            check_ok(mspring_network_add_cell_areas(network, &def, &first, &count));
            assert_int_equal(count, cases[i].cells);
        }
        check_ok(mspring_network_step(network, 0.001));
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_properties),
        cmocka_unit_test(what_was_read_may_be_set),
        cmocka_unit_test(bad_areas_are_refused),
        cmocka_unit_test(flat_areas_are_refused),
        cmocka_unit_test(least_areas_are_by_the_perimeter),
        cmocka_unit_test(flat_cells_are_refused),
        cmocka_unit_test(cells_above_each_other_are_counted),
        cmocka_unit_test(damaged_snapshots_are_refused),
    };
    return cmocka_run_group_tests_name("area_calls", tests, NULL, NULL);
}
