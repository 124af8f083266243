/// @file fuzz_loaders.c
/// The loaders of other programs' structures: they refuse with a message, or give a structure that can be made into
/// a network.
///
/// SPDX-License-Identifier: MIT
#include "check.h"

#include <stdio.h>
#include <string.h>

#include "loaders/structure.h"

static void check_structure(structure *made) {
    const structure_report *report = &made->report;
    FUZZ_CHECK(made->particle_count > 0 && made->particle_count + report->merged_nodes == report->nodes);
    FUZZ_CHECK(made->spring_count + report->merged_springs + report->dropped_beams == report->beams);
    scene built;
    scene_error error = {""};
    mspring_network *network = NULL;
    // Whatever the file: positions, masses and springs are what a builder takes, and no spring is there twice.
    FUZZ_CHECK(structure_scene(made, "fuzz", &built, &error));
    FUZZ_CHECK(mspring_network_create(built.builder, NULL, &network) == MSPRING_OK);
    mspring_result result = fuzz_step(network, 1e-4);
    FUZZ_CHECK(result == MSPRING_OK || result == MSPRING_ERROR_UNSTABLE);
    mspring_network_destroy(network);
    scene_free(&built);
    structure_free(made);
}

static const char materials[] =
    "[{\"color_key\":\"#102030\",\"strength\":1,\"mass\":{\"nominal_mass\":1,\"density\":1}},"
    "{\"color_key\":\"#000000\",\"strength\":1,\"unique_type\":\"Rope\",\"mass\":{\"nominal_mass\":1,\"density\":1}"
    "}]";

// A ship whose materials, or whose sections, are the input; or the file that names its images.
static bool parse_ship(char kind, const char *text, size_t size, structure *made, scene_error *error) {
    static const char image[] = "P3 3 2 255 16 32 48 255 255 255 255 0 0 64 80 96 16 32 48 255 0 0\n";
    static const char ropes[] = "P3 3 2 255 255 255 255 1 2 3 255 255 255 255 255 255 255 255 255 1 2 3\n";
    const structure_bytes given = {text, size, "fuzz"}, cells = {image, sizeof image - 1, "image"},
                          ends = {ropes, sizeof ropes - 1, "ropes"},
                          known = {materials, sizeof materials - 1, "json"};
    const structure_options options = structure_options_default();
    char names[2][STRUCTURE_NAME_SIZE];
    if (kind == '3')
        return structure_parse_ship(&cells, &ends, &given, &options, made, error);
    if (kind == '4')
        return structure_parse_ship(&given, NULL, &known, &options, made, error);
    if (structure_ship_images(&given, names[0], names[1], error))
        FUZZ_CHECK(strlen(names[0]) < STRUCTURE_NAME_SIZE && strlen(names[1]) < STRUCTURE_NAME_SIZE);
    else
        FUZZ_CHECK(strlen(error->text) > 0);
    snprintf(error->text, sizeof error->text, "no ship");
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const structure_format formats[] = {STRUCTURE_RIGS_OF_RODS, STRUCTURE_JBEAM, STRUCTURE_OBJ};
    if (size == 0)
        return 0;
    const structure_options options = structure_options_default();
    const unsigned kind = data[0] % 6;
    const char *text = (const char *)data + 1;
    scene_error error = {""};
    structure made;
    const bool ok = kind < 3 ? structure_parse(formats[kind], text, size - 1, "fuzz", &options, &made, &error)
                             : parse_ship((char)('0' + kind), text, size - 1, &made, &error);
    if (ok)
        check_structure(&made);
    else
        FUZZ_CHECK(strlen(error.text) > 0 && memchr(error.text, 0, sizeof error.text));
    return 0;
}
