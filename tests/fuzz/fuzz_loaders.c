/// @file fuzz_loaders.c
/// The loaders of other programs' structures: they refuse with a message, or give a structure that can be made into
/// a network.
///
/// SPDX-License-Identifier: MIT
#include "fuzz.h"

#include <math.h>
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
    mspring_result result = mspring_network_step(network, 1e-4);
    FUZZ_CHECK(result == MSPRING_OK || result == MSPRING_ERROR_UNSTABLE);
    mspring_network_destroy(network);
    scene_free(&built);
    structure_free(made);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const structure_format formats[] = {STRUCTURE_RIGS_OF_RODS, STRUCTURE_JBEAM, STRUCTURE_OBJ,
                                               STRUCTURE_SHIP};
    static const char image[] = "P3 3 2 255 16 32 48 255 255 255 255 0 0 64 80 96 16 32 48 255 0 0\n";
    if (size == 0)
        return 0;
    const structure_options options = structure_options_default();
    const structure_format format = formats[data[0] % 4];
    const char *text = (const char *)data + 1;
    scene_error error = {""};
    structure made;
    const bool ok =
        format == STRUCTURE_SHIP
            ? structure_parse_ship(image, sizeof image - 1, "fuzz", text, size - 1, "json", &made, &error)
            : structure_parse(format, text, size - 1, "fuzz", &options, &made, &error);
    if (ok)
        check_structure(&made);
    else
        FUZZ_CHECK(strlen(error.text) > 0 && memchr(error.text, 0, sizeof error.text));
    return 0;
}
