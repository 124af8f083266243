/// @file ship_none.c
/// Ships of Floating Sandbox, where cJSON was not found at build time.
///
/// SPDX-License-Identifier: MIT
#include "loaders/structure.h"
#include "scenes/internal.h"

static bool fail(const structure_bytes *file, scene_error *error) {
    return scene_fail(error,
                      "built without cJSON, so %.150s cannot be read: install libcjson-dev and configure the build "
                      "anew",
                      file->name);
}

bool structure_ship_images(const structure_bytes *file, char cells[STRUCTURE_NAME_SIZE],
                           char ropes[STRUCTURE_NAME_SIZE], scene_error *error) {
    cells[0] = ropes[0] = 0;
    return fail(file, error);
}

bool structure_parse_ship(const structure_bytes *ship, const structure_bytes *ropes,
                          const structure_bytes *materials, const structure_options *options, structure *out,
                          scene_error *error) {
    (void)ship;
    (void)ropes;
    (void)options;
    (void)out;
    return fail(materials, error);
}
