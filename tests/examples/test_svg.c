/// @file test_svg.c
/// massspring_svg.h: what a picture has of a network, and what becomes of files that cannot be written.
///
/// SPDX-License-Identifier: MIT
#include <locale.h>
#include <massspring_svg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

#define FILE_NAME "test_svg.svg"

// The file's text, for free().
static char *text_of(const char *name) {
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const size_t size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, size, file), size);
    text[size] = '\0';
    fclose(file);
    return text;
}

static size_t count_of(const char *text, const char *part) {
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, part)) != NULL; at += strlen(part))
        count++;
    return count;
}

// Every tag is closed, quotes are pairs, and nothing is no number.
static void check_is_xml(const char *text) {
    int depth = 0;
    bool is_quoted = false;
    for (const char *at = text; *at; at++) {
        is_quoted ^= *at == '\'';
        if (is_quoted || *at != '<')
            continue;
        const char *end = strchr(at, '>');
        assert_non_null(end);
        depth += at[1] == '/' ? -1 : end[-1] != '/';
        assert_true(depth >= 0);
    }
    assert_int_equal(depth, 0);
    assert_false(is_quoted);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
    assert_null(strchr(text, ','));
}

// Four particles in a row, the first pinned, the last without a spring.
static mspring_network *row(double step) {
    mspring_builder *builder;
    mspring_network *network;
    mspring_particle_def particle;
    mspring_spring_def spring;
    check_ok(mspring_builder_create(NULL, &builder));
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.stiffness = 100;
    for (mspring_id p = 0; p < 4; p++) {
        particle.x = step * p;
        particle.flags = p == 0 ? MSPRING_PARTICLE_PINNED : 0;
        check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    }
    for (spring.b = 1; spring.b < 3; spring.b++) {
        spring.a = spring.b - 1;
        check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    }
    check_ok(mspring_network_create(builder, NULL, &network));
    mspring_builder_destroy(builder);
    return network;
}

static char *picture_of(const mspring_network *network) {
    assert_int_equal(mspring_svg_write(network, FILE_NAME), MSPRING_OK);
    char *text = text_of(FILE_NAME);
    check_is_xml(text);
    assert_int_equal(remove(FILE_NAME), 0);
    return text;
}

// Lines of springs begin with M and have one L; the scale has no such line, a floor of one plane one.
static void it_has_live_springs_pins_and_loose_particles(void **state) {
    (void)state;
    mspring_network *network = row(1);
    char *text = picture_of(network);
    assert_int_equal(count_of(text, "L"), 2);
    assert_int_equal(count_of(text, "<circle"), 1);
    assert_int_equal(count_of(text, "fill='#222' d="), 1); // the pin
    free(text);

    const mspring_id last = 1;
    check_ok(mspring_network_break_springs(network, &last, 0, 1));
    text = picture_of(network);
    assert_int_equal(count_of(text, "L"), 1);
    assert_int_equal(count_of(text, "<circle"), 2);
    free(text);

    const mspring_id loose = 3;
    check_ok(mspring_network_remove_springs(network, &last, 0, 1));
    check_ok(mspring_network_remove_particles(network, &loose, 0, 1));
    text = picture_of(network);
    assert_int_equal(count_of(text, "L"), 1);
    assert_int_equal(count_of(text, "<circle"), 1);
    free(text);
    mspring_network_destroy(network);
}

static void it_has_the_floor(void **state) {
    (void)state;
    static const double planes[] = {0, -0.5, 0, 1, 1e9, 0, -1, 0}; // the second is out of sight
    static const float heights[] = {-1, 1e9f};
    mspring_network *network = row(1);
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = planes;
    floor.plane_count = 2;
    check_ok(mspring_network_set_floor(network, &floor));
    char *text = picture_of(network);
    assert_int_equal(count_of(text, "L"), 3);
    free(text);
    floor.plane_count = 0;
    floor.heights = heights;
    floor.height_count = 2;
    check_ok(mspring_network_set_floor(network, &floor));
    text = picture_of(network);
    assert_int_equal(count_of(text, "L"), 5); // through both heights, and to the right
    free(text);
    mspring_network_destroy(network);
}

// No numbers overflow, whatever the size.
static void all_sizes_are_drawn(void **state) {
    (void)state;
    static const double steps[] = {1e-6, 1e9};
    for (size_t i = 0; i < COUNT_OF(steps); i++) {
        mspring_network *network = row(steps[i]);
        char *text = picture_of(network);
        assert_int_equal(count_of(text, "L"), 2);
        free(text);
        const double origin[4] = {0};
        check_ok(mspring_network_set_positions(network, NULL, 0, 4, origin, origin, 1));
        free(picture_of(network));
        mspring_network_destroy(network);
    }
    mspring_builder *builder;
    mspring_network *empty;
    mspring_particle_def particle;
    check_ok(mspring_builder_create(NULL, &builder));
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    check_ok(mspring_network_create(builder, NULL, &empty));
    const mspring_id only = 0;
    check_ok(mspring_network_remove_particles(empty, &only, 0, 1));
    free(picture_of(empty));
    mspring_network_destroy(empty);
    mspring_builder_destroy(builder);
}

static void stretched_springs_are_red(void **state) {
    (void)state;
    mspring_network *network = row(1);
    const double x = 1.2, y = 0;
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &x, &y, 1));
    char *text = picture_of(network);
    assert_int_equal(count_of(text, "stroke='#c81e14'"), 1); // + 20 %
    assert_int_equal(count_of(text, "stroke='#143cbe'"), 1); // - 20 %
    assert_non_null(strstr(text, ">-20 %<"));
    assert_non_null(strstr(text, ">strain 20 %<"));
    assert_non_null(strstr(text, ">0.2 m<"));
    free(text);
    mspring_network_destroy(network);
}

static void what_cannot_be_written_is_an_error(void **state) {
    (void)state;
    mspring_network *network = row(1);
    assert_int_equal(mspring_svg_write(NULL, FILE_NAME), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(mspring_svg_write(network, NULL), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(mspring_svg_write(network, "no/such/folder/a.svg"), MSPRING_ERROR_ARGUMENT);
    FILE *full = fopen("/dev/full", "wb"); // where there is such a file, nothing can be written to it
    if (full) {
        fclose(full);
        assert_int_equal(mspring_svg_write(network, "/dev/full"), MSPRING_ERROR_ARGUMENT);
    }
    mspring_network_destroy(network);
}

static void commas_of_a_locale_do_not_count(void **state) {
    (void)state;
    mspring_network *network = row(0.123);
    char *expected = picture_of(network);
    if (!setlocale(LC_ALL, "de_DE.UTF-8"))
        print_message("no German locale here\n");
    char *text = picture_of(network);
    assert_string_equal(text, expected);
    assert_non_null(setlocale(LC_ALL, "C"));
    free(text);
    free(expected);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_has_live_springs_pins_and_loose_particles),
        cmocka_unit_test(it_has_the_floor),
        cmocka_unit_test(all_sizes_are_drawn),
        cmocka_unit_test(stretched_springs_are_red),
        cmocka_unit_test(what_cannot_be_written_is_an_error),
        cmocka_unit_test(commas_of_a_locale_do_not_count),
    };
    return cmocka_run_group_tests_name("svg", tests, NULL, NULL);
}
