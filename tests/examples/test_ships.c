/// @file test_ships.c
/// Ships of Floating Sandbox: cells, ropes, strengths; images and sections of one file; what is refused.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "loaders/structure.h"
#include "support.h"

static structure_options options;

static const char materials[] =
    "{\"materials\": [\n"
    " {\"name\": \"Plate\", \"color_key\": [\"#102030\", \"#405060\"], \"strength\": 0.05,\n"
    "  \"mass\": {\"nominal_mass\": 7900, \"density\": 0.05}},\n"
    " {\"name\": \"Soft\", \"color_key\": \"#FF0000\", \"strength\": 0.1, \"stiffness\": 0.5,\n"
    "  \"mass\": {\"nominal_mass\": 600, \"density\": 1}},\n"
    " {\"name\": \"Rope\", \"color_key\": \"#000000\", \"strength\": 0.2, \"stiffness\": 1.84,\n"
    "  \"unique_type\": \"Rope\", \"mass\": {\"nominal_mass\": 100, \"density\": 0.1}}\n"
    "]}\n";

static structure_bytes text_of(const char *text, const char *name) {
    return (structure_bytes){text, strlen(text), name};
}

static bool parse(const char *image, const char *ropes, const char *json, structure *made, scene_error *error) {
    const structure_bytes ship = text_of(image, "ship"), table = text_of(json, "json"),
                          layer = text_of(ropes ? ropes : "", "ropes");
    return structure_parse_ship(&ship, ropes ? &layer : NULL, &table, &options, made, error);
}

static structure ship_of(const char *image, const char *ropes) {
    structure made;
    scene_error error = {""};
    if (!parse(image, ropes, materials, &made, &error))
        fail_msg("refused: %s", error.text);
    return made;
}

static void check_refused(const char *image, const char *ropes, const char *json, const char *message) {
    structure made;
    scene_error error = {""};
    if (parse(image, ropes, json, &made, &error))
        fail_msg("taken, not refused with \"%s\"", message);
    check_contains(error.text, message);
}

static int start(void **state) {
    (void)state;
    options = structure_options_default();
    return 0;
}

#ifdef LOADERS_HAVE_CJSON
static const bool has_cjson = true;
#else
static const bool has_cjson = false;
#endif

static void without_cjson_a_ship_names_what_is_missing(void **state) {
    (void)state;
    check_refused("P3 1 1 255 16 32 48\n", NULL, materials, "built without cJSON");
}

static uint32_t spring_between(const structure *in, mspring_id a, mspring_id b) {
    for (uint32_t i = 0; i < in->spring_count; i++)
        if ((in->springs[i].a == a && in->springs[i].b == b) || (in->springs[i].a == b && in->springs[i].b == a))
            return i;
    fail_msg("no spring between %u and %u", a, b);
    return 0;
}

/* ------------------------------------------------------------------------------------------------------ images */

static const char plain[] = "P3 3 2 255  16 32 48  255 255 255  255 0 0   64 80 96  16 32 48  255 0 0\n";

static void colours_are_looked_up_in_the_games_materials(void **state) {
    (void)state;
    structure ship = ship_of(plain, NULL);
    // Cells: plate, nothing, soft; plate, plate, soft.
    assert_int_equal(ship.particle_count, 5);
    assert_int_equal(ship.spring_count, 6);
    assert_int_equal(ship.substeps, 40);
    check_near(ship.particles[0].mass, 395, 1e-3);
    check_near(ship.particles[0].y, 1, 0);
    const mspring_spring_def *between = &ship.springs[spring_between(&ship, 3, 4)];
    check_near(ship.springs[spring_between(&ship, 2, 3)].stiffness, 0.5, 1e-7);
    check_near(between->stiffness, 0.5 * 0.75, 1e-7);
    check_near(between->damping, 0.03, 1e-7);
    assert_int_equal(between->flags, MSPRING_SPRING_RELATIVE);
    structure_free(&ship);
}

/// Strengths are means, times 0.379 with 40 substeps and 9.2096 e^-0.1142 + 0.2832 with one; rounding of floats.
static void strengths_follow_the_substeps(void **state) {
    (void)state;
    structure ship = ship_of(plain, NULL);
    check_near(ship.break_strain[spring_between(&ship, 2, 3)], 0.05 * 0.378784, 1e-7);
    check_near(ship.break_strain[spring_between(&ship, 3, 4)], 0.075 * 0.378784, 1e-7);
    structure_free(&ship);
    options.substeps = 1;
    ship = ship_of(plain, NULL);
    assert_int_equal(ship.substeps, 1);
    check_near(ship.break_strain[spring_between(&ship, 2, 3)], 0.05 * 8.498896, 1e-6);
    structure_free(&ship);
    options.substeps = 0;
    check_refused(plain, NULL, materials, "substeps are 0: give 1 to");
}

static void unknown_colours_are_left_out_and_told(void **state) {
    (void)state;
    structure ship = ship_of("P3 2 2 255 16 32 48 1 2 3 9 8 7 1 2 3\n", NULL);
    assert_int_equal(ship.particle_count, 1);
    assert_int_equal(tally_of(&ship.report.ignored, "cells of #010203, a colour of no material"), 2);
    assert_int_equal(tally_of(&ship.report.ignored, "cells of #090807, a colour of no material"), 1);
    structure_free(&ship);
}

static void broken_materials_are_refused(void **state) {
    (void)state;
    check_refused("P3 1 1 255 99 8 7\n", NULL, materials,
                  "ship: no pixel has a colour of json. It has #630807 (1 pixel, first in column 0 of row 0)");
    check_refused("P3 1 1 255 255 255 255\n", NULL, materials, "every pixel is white or transparent");
    check_refused(plain, NULL, "{\"materials\": [\n {,} ]}", "json:2:"); // the column is cJSON's
    check_refused(plain, NULL,
                  "{\"materials\": [{\"name\":\"X\",\"color_key\":\"red\",\"strength\":1,"
                  "\"mass\":{\"nominal_mass\":1,\"density\":1}}]}",
                  "json: material 0, X: its color_key");
    check_refused(plain, NULL, "{}", "no list of materials");
}

/* ------------------------------------------------------------------------------------------------------- ropes */

/// Two plates 4 m apart; their neighbours in the middle row are two pixels of one rope colour, or of another image.
static void pixels_of_one_colour_are_the_ends_of_a_rope(void **state) {
    (void)state;
    structure ship = ship_of("P3 5 1 255  0 1 2  255 255 255  255 255 255  255 255 255  0 1 2\n", NULL);
    assert_int_equal(ship.particle_count, 2 + 3);
    assert_int_equal(ship.spring_count, 4);
    assert_int_equal(tally_of(&ship.report.used, "ropes"), 1);
    for (uint32_t i = 0; i < 4; i++) {
        check_near(ship.springs[i].rest_length, 1, 1e-6);
        check_near(ship.springs[i].stiffness, 0.5 * 1.84, 1e-6);
        check_near(ship.break_strain[i], 0.2 * 0.378784, 1e-6);
    }
    structure_free(&ship);
    check_refused("P3 3 1 255  0 1 2  255 255 255  0 1 3\n", NULL, materials,
                  "ship: 1 pixel of the rope colour #000102, the first in column 0 of row 0: a rope has two ends");
    check_refused("P3 3 1 255  0 1 2  0 1 2  0 1 2\n", NULL, materials, "3 pixels of the rope colour #000102");
    // The rope's own colour makes cells.
    ship = ship_of("P3 3 1 255  0 0 0  0 0 0  0 0 0\n", NULL);
    assert_int_equal(ship.spring_count, 2);
    assert_int_equal(tally_of(&ship.report.used, "ropes"), 0);
    structure_free(&ship);
}

static void a_rope_passes_cells_without_touching_them(void **state) {
    (void)state;
    // Five plates in a row, a rope from the first to the last, which passes over the three others.
    structure ship = ship_of("P3 5 1 255  16 32 48  16 32 48  16 32 48  16 32 48  16 32 48\n",
                             "P3 5 1 255  1 2 3  255 255 255  255 255 255  255 255 255  1 2 3\n");
    assert_int_equal(ship.particle_count, 5 + 3);
    assert_int_equal(ship.spring_count, 4 + 4);
    assert_int_equal(ship.report.merged_nodes, 0);
    structure_free(&ship);
    // An end on nothing becomes a cell.
    ship = ship_of("P3 3 1 255  16 32 48  255 255 255  255 255 255\n", "P3 3 1 255  1 2 3  255 255 255  1 2 3\n");
    assert_int_equal(ship.particle_count, 3);
    check_near(ship.particles[1].mass, 10, 1e-6);
    structure_free(&ship);
    check_refused("P3 3 1 255  16 32 48  255 255 255  255 255 255\n", "P3 2 1 255  1 2 3  1 2 3\n", materials,
                  "ropes: 2 x 1 pixels, but the structure has 3 x 1");
}

static void a_ship_may_stand_on_its_lowest_row(void **state) {
    (void)state;
    options.dock = true;
    // Two columns: one stands, one hangs in the air.
    structure ship = ship_of("P3 3 3 255  16 32 48  255 255 255  16 32 48   16 32 48  255 255 255  255 255 255\n"
                             "16 32 48  255 255 255  255 255 255\n",
                             NULL);
    assert_int_equal(ship.particle_count, 3);
    assert_int_equal(ship.report.pinned_particles, 1);
    assert_int_equal(ship.particles[2].flags, MSPRING_PARTICLE_PINNED);
    assert_int_equal(tally_of(&ship.report.notes, "nodes left out, as they hang on nothing that stands"), 1);
    structure_free(&ship);
}

/* ---------------------------------------------------------------------------------------------------- sections */

typedef struct file {
    uint8_t bytes[2048];
    size_t size;
} file;

static void put(file *to, const void *bytes, size_t count) {
    assert_true(to->size + count <= sizeof to->bytes);
    memcpy(to->bytes + to->size, bytes, count);
    to->size += count;
}

static void put_number(file *to, uint32_t number) {
    const uint8_t bytes[4] = {(uint8_t)(number >> 24), (uint8_t)(number >> 16), (uint8_t)(number >> 8),
                              (uint8_t)number};
    put(to, bytes, 4);
}

/// Returns what end_section needs to put in the section's size.
static size_t begin_section(file *to, const char *tag) {
    put(to, tag, 4);
    put_number(to, 0);
    return to->size;
}

static void end_section(file *to, size_t begin) {
    file size = {.size = 0};
    put_number(&size, (uint32_t)(to->size - begin));
    memcpy(to->bytes + begin - 4, size.bytes, 4);
}

static void put_section(file *to, const char *tag, const void *bytes, size_t count) {
    const size_t begin = begin_section(to, tag);
    put(to, bytes, count);
    end_section(to, begin);
}

static void put_text(file *to, const char *tag, const char *text) {
    const size_t begin = begin_section(to, tag);
    put_number(to, (uint32_t)strlen(text));
    put(to, text, strlen(text));
    end_section(to, begin);
}

static void put_tail(file *to) {
    put_section(to, "\xff\xff\xff\xff", "", 0);
}

static file header(void) {
    file made = {.size = 0};
    put(&made, "FLOATING SANDBOX SHIP\x1a\0\0\0\1\0\0\0\0\0", 32);
    return made;
}

static void put_size(file *to, uint32_t width, uint32_t height) {
    const size_t begin = begin_section(to, "SSZ1");
    put_number(to, width);
    put_number(to, height);
    end_section(to, begin);
}

// The attributes of a file that the game wrote from its version 1.17.3 on.
static void put_attributes(file *to, uint32_t width, uint32_t height) {
    const size_t begin = begin_section(to, "ATT1");
    put_section(to, "FSV2", "\0\1\0\x13\0\0\0\2", 8);
    put_size(to, width, height);
    put_section(to, "HTX1", "", 1);
    put_section(to, "HEL1", "\1", 1);
    put_section(to, "WRT1", "\0\0\0\0\x65\1\2\3", 8);
    put_tail(to);
    assert_int_equal(to->size - begin, 74); // as in a real file
    end_section(to, begin);
}

static void put_metadata(file *to) {
    const size_t begin = begin_section(to, "MET1");
    put_text(to, "NAM1", "Skiff");
    put_text(to, "AUT1", "Some One Els");
    put_text(to, "YRB1", "1912");
    put_section(to, "CTG1", "\0\0\0\0\0\0\0\7", 8);
    put_section(to, "SCL1", "\x3f\x80\0\0\x3f\0\0\0", 8); // 1 cell, 0.5 m
    put_section(to, "PPP1", "\1\2\3\4\5\6\7\x8", 8);
    put_section(to, "HEP1", "", 1);
    put_section(to, "HHP1", "\1", 1);
    put_tail(to);
    assert_int_equal(to->size - begin, 115 + 16); // a real file without a password has 115
    end_section(to, begin);
}

/// Four plates and soft ones in two rows of three.
static const uint8_t plates[] = {2, 0x10, 0x20, 0x30, 0x81, 0, 0xff, 0, 0, 3, 0x40, 0x50, 0x60};

static void put_cells(file *to, const void *runs, size_t count) {
    const size_t begin = begin_section(to, "STR1");
    put_section(to, "BUF1", runs, count);
    put_tail(to);
    end_section(to, begin);
}

static void put_rope(file *to, uint32_t rope_x) {
    const size_t begin = begin_section(to, "RPS1"), list = begin_section(to, "BUF1");
    put_number(to, 1);
    put_number(to, 0);
    put_number(to, 0);
    put_number(to, rope_x);
    put_number(to, 1);
    put(to, "\0\0\0\1\2\3\xff", 7);
    end_section(to, list);
    put_tail(to);
    end_section(to, begin);
}

static void put_rest(file *to) {
    size_t begin = begin_section(to, "ELC1");
    put_section(to, "BUF1", "\5\xff\xff\xff\1\x10\x20\x30\7", 9);
    put_section(to, "PNL1", "\0\1\0\0\0\7\0\0\0", 9);
    put_tail(to);
    end_section(to, begin);
    begin = begin_section(to, "PHS1");
    put_section(to, "OFX1", "\0\0\0", 4);
    put_section(to, "OFY1", "\0\0\0", 4);
    put_section(to, "IPR1", "\x3f\x80\0", 4);
    put_tail(to);
    assert_int_equal(to->size - begin, 44); // as in a real file
    end_section(to, begin);
}

/// All sections of a real file. A rope goes from the bottom left to the top right.
static file sections(uint32_t width, uint32_t height, uint32_t rope_x) {
    file made = header();
    put_attributes(&made, width, height);
    put_metadata(&made);
    put_section(&made, "PVP1", "png", 3);
    put_cells(&made, plates, sizeof plates);
    put_rope(&made, rope_x);
    put_rest(&made);
    put_tail(&made);
    return made;
}

static bool parse_sections(const file *from, structure *made, scene_error *error) {
    uint8_t *copy = malloc(from->size ? from->size : 1); // so that sanitizers see reads behind it
    assert_non_null(copy);
    memcpy(copy, from->bytes, from->size);
    const structure_bytes ship = {copy, from->size, "boat.shp2"}, table = text_of(materials, "json");
    const bool ok = structure_parse_ship(&ship, NULL, &table, &options, made, error);
    free(copy);
    return ok;
}

static void sections_of_one_file_are_read(void **state) {
    (void)state;
    structure ship;
    scene_error error = {""};
    const file whole = sections(3, 2, 2);
    if (!parse_sections(&whole, &ship, &error))
        fail_msg("refused: %s", error.text);
    // The rope goes two steps to the right: one particle between its ends, half a metre apart as the cells.
    assert_int_equal(ship.particle_count, 6 + 1);
    assert_int_equal(ship.spring_count, 11 + 2);
    check_near(ship.particles[0].y, 0.5, 0);       // the top row comes first, of the second colour
    check_near(ship.particles[3].mass, 395, 1e-3); // plate, plate, soft below
    check_near(ship.particles[5].mass, 600, 1e-3);
    check_near(ship.particles[6].x, 0.5, 1e-12);
    check_near(ship.particles[6].y, 0.25, 1e-12);
    assert_int_equal(tally_of(&ship.report.ignored, "preview"), 1);
    assert_int_equal(tally_of(&ship.report.ignored, "electrics"), 1);
    structure_free(&ship);
}

static structure ship_of_sections(const file *given) {
    structure made;
    scene_error error = {""};
    if (!parse_sections(given, &made, &error))
        fail_msg("refused: %s", error.text);
    return made;
}

/// What older and newer versions of the game write otherwise, and what none of them writes yet.
static void sections_of_other_versions_are_skipped(void **state) {
    (void)state;
    file made = header();
    made.bytes[25] = 0; // an older format
    size_t begin = begin_section(&made, "NEW1");
    put_text(&made, "NEW2", "whatever");
    end_section(&made, begin);
    begin = begin_section(&made, "ATT1");
    put_section(&made, "FSV1", "\0\1\0\x10", 4); // until 1.17.2
    put_section(&made, "NEW3", "", 0);
    put_size(&made, 300, 1);
    put_section(&made, "HTX1", "", 1); // the list ends with its section
    end_section(&made, begin);
    // No metadata: cells are 1 m apart. Runs of 128, 171 and 1, and what is not cells beside them.
    static const uint8_t runs[] = {0x80, 1, 0x10, 0x20, 0x30, 0xab, 1, 0xff, 0, 0, 1, 0x40, 0x50, 0x60};
    begin = begin_section(&made, "STR1");
    put_section(&made, "NEW4", "\7", 1);
    put_section(&made, "BUF1", runs, sizeof runs);
    end_section(&made, begin);
    put_section(&made, "RPS1", "", 0);
    put_section(&made, "TXP1", "png", 3);
    put_tail(&made);
    structure ship = ship_of_sections(&made);
    assert_int_equal(ship.particle_count, 300);
    assert_int_equal(ship.spring_count, 299);
    check_near(ship.particles[127].mass, 395, 1e-3);
    check_near(ship.particles[128].mass, 600, 1e-3);
    check_near(ship.particles[298].mass, 600, 1e-3);
    check_near(ship.particles[299].mass, 395, 1e-3);
    check_near(ship.particles[299].x, 299, 0);
    assert_int_equal(tally_of(&ship.report.ignored, "unknown sections"), 1);
    structure_free(&ship);
}

static void check_sections(file given, const char *message) {
    structure ship;
    scene_error error = {""};
    if (parse_sections(&given, &ship, &error))
        fail_msg("taken, not refused with \"%s\"", message);
    check_contains(error.text, message);
}

static void broken_sections_are_refused(void **state) {
    (void)state;
    file newer = sections(3, 2, 2);
    newer.bytes[25] = 2;
    check_sections(newer, "boat.shp2: its format has version 2, but only 1 is known");
    check_sections(sections(0, 2, 2), "it has 0 x 2 cells");
    check_sections(sections(1u << 16, 1u << 16, 2), "it has 65536 x 65536 cells");
    check_sections(sections(4, 2, 2), "its structure has 6 of 8 cells");
    check_sections(sections(2, 2, 1), "its structure has more than the 2 x 2 cells of its size");
    check_sections(sections(3, 2, 3), "rope 0 has an end outside of the ship");
    file made = header();
    size_t begin = begin_section(&made, "ATT1");
    put_section(&made, "FSV2", "\0\1\0\x13\0\0\0\2", 8);
    put_tail(&made);
    end_section(&made, begin);
    check_sections(made, "boat.shp2: its attributes have no size (SSZ1)");
    made = header();
    put_cells(&made, plates, sizeof plates);
    put_attributes(&made, 3, 2);
    put_tail(&made);
    check_sections(made, "boat.shp2: its structure comes before its size");
    made = header();
    put_attributes(&made, 3, 2);
    put_tail(&made);
    check_sections(made, "boat.shp2: it has no structure");
    begin = begin_section(&made, "STR1"); // behind the tail, which is the end
    end_section(&made, begin);
    check_sections(made, "boat.shp2: it has no structure");
    made = header();
    put_attributes(&made, 3, 2);
    begin = begin_section(&made, "STR1");
    put_section(&made, "NEW1", plates, sizeof plates);
    end_section(&made, begin);
    put_tail(&made);
    check_sections(made, "boat.shp2: its structure has no cells");
}

/// Cut off after any byte, it is refused; with any bit turned, it is refused or still a structure.
static void damage_is_found(void **state) {
    (void)state;
    const file whole = sections(3, 2, 2);
    for (size_t size = 0; size < whole.size; size++) {
        structure ship;
        scene_error error = {""};
        file cut = whole;
        cut.size = size;
        assert_false(parse_sections(&cut, &ship, &error));
        assert_true(strlen(error.text) > 0);
    }
    for (size_t bit = 0; bit < 8 * whole.size; bit++) {
        structure ship;
        scene_error error = {""};
        file turned = whole;
        turned.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        if (parse_sections(&turned, &ship, &error)) {
            assert_true(ship.particle_count > 0);
            structure_free(&ship);
        } else {
            assert_true(strlen(error.text) > 0);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- files */

static void a_shp_file_names_images_of_its_own_folder(void **state) {
    (void)state;
    char cells[STRUCTURE_NAME_SIZE], ropes[STRUCTURE_NAME_SIZE];
    scene_error error = {""};
    structure_bytes names = text_of("{\"structure_image\": \"a b.png\", \"ship_name\": \"X\"}", "boat.shp");
    assert_true(structure_ship_images(&names, cells, ropes, &error));
    assert_string_equal(cells, "a b.png");
    assert_string_equal(ropes, "");
    static const char *const wrong[][2] = {
        {"{\"ropes_image\": \"a.png\"}", "it names no image as structure_image"},
        {"{\"structure_image\": \"/etc/a.png\"}", "only images in its own folder"},
        {"{\"structure_image\": \"../a.png\"}", "only images in its own folder"},
        {"{\"structure_image\": \"a.png\", \"ropes_image\": 7}", "it names no image as ropes_image"},
        {"[1]", "it holds no JSON object"},
        {"{\n oops", "boat.shp:2:"},
    };
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        names = text_of(wrong[i][0], "boat.shp");
        assert_false(structure_ship_images(&names, cells, ropes, &error));
        check_contains(error.text, wrong[i][1]);
    }
}

/// The sample is the same ship as images and as sections, and goes through a text network.
static void the_sample_boat_is_one_ship_in_both_formats(void **state) {
    (void)state;
    structure image, one_file;
    scene_error error = {""};
    if (!structure_load(SHIPS_DATA "/boat.shp2", &options, &one_file, &error))
        fail_msg("refused: %s", error.text);
    if (!structure_load(SHIPS_DATA "/boat.shp", &options, &image, &error)) {
        check_contains(error.text, "stb_image");
        structure_free(&one_file);
        skip();
    }
    assert_int_equal(image.particle_count, one_file.particle_count);
    assert_int_equal(image.spring_count, one_file.spring_count);
    check_near(image.report.mass, one_file.report.mass, 1e-6);
    assert_int_equal(tally_of(&image.report.used, "ropes"), 4);
    assert_int_equal(tally_of(&image.report.ignored, "cells of #12FF34, a colour of no material"), 1);
    assert_int_equal(tally_of(&one_file.report.ignored, "cells of #12FF34, a colour of no material"), 1);

    scene built, read;
    const char *path = "test_ships.msn";
    const scene_options from_file = scene_options_from_file();
    assert_true(structure_scene(&one_file, "boat.shp2", &built, &error));
    assert_true(structure_write(&one_file, path, &error));
    if (!scene_network_file(path, &from_file, &read, &error))
        fail_msg("refused: %s", error.text);
    assert_int_equal(remove(path), 0);
    mspring_network *first = NULL, *second = NULL;
    mspring_network_def def = support_def(-9.8f, 40);
    check_ok(mspring_network_create(built.builder, &def, &first));
    check_ok(mspring_network_create(read.builder, &def, &second));
    support_steps(first, 8, 1.0 / 64);
    support_steps(second, 8, 1.0 / 64);
    assert_true(support_hash(first) == support_hash(second));
    mspring_network_destroy(first);
    mspring_network_destroy(second);
    scene_free(&built);
    scene_free(&read);
    structure_free(&image);
    structure_free(&one_file);
}

static void materials_lie_beside_the_ship_or_are_given(void **state) {
    (void)state;
    structure made;
    scene_error error = {""};
    assert_int_equal(structure_format_of("a.SHP2"), STRUCTURE_SHIP);
    assert_true(structure_is_ship("a/b.shp"));
    assert_false(structure_is_ship("a/b.png"));
    options.materials = "not/there.json";
    assert_false(structure_load(SHIPS_DATA "/boat.shp2", &options, &made, &error));
    check_contains(error.text, "the game's materials explain its colours");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(colours_are_looked_up_in_the_games_materials, start),
        cmocka_unit_test_setup(strengths_follow_the_substeps, start),
        cmocka_unit_test_setup(unknown_colours_are_left_out_and_told, start),
        cmocka_unit_test_setup(broken_materials_are_refused, start),
        cmocka_unit_test_setup(pixels_of_one_colour_are_the_ends_of_a_rope, start),
        cmocka_unit_test_setup(a_rope_passes_cells_without_touching_them, start),
        cmocka_unit_test_setup(a_ship_may_stand_on_its_lowest_row, start),
        cmocka_unit_test_setup(sections_of_one_file_are_read, start),
        cmocka_unit_test_setup(sections_of_other_versions_are_skipped, start),
        cmocka_unit_test_setup(broken_sections_are_refused, start),
        cmocka_unit_test_setup(damage_is_found, start),
        cmocka_unit_test_setup(a_shp_file_names_images_of_its_own_folder, start),
        cmocka_unit_test_setup(the_sample_boat_is_one_ship_in_both_formats, start),
        cmocka_unit_test_setup(materials_lie_beside_the_ship_or_are_given, start),
    };
    const struct CMUnitTest without[] = {
        cmocka_unit_test_setup(without_cjson_a_ship_names_what_is_missing, start),
    };
    return has_cjson ? cmocka_run_group_tests(tests, NULL, NULL) : cmocka_run_group_tests(without, NULL, NULL);
}
