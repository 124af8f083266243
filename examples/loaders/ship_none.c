/// @file ship_none.c
/// Ships of Floating Sandbox, where cJSON was not found at build time.
///
/// SPDX-License-Identifier: MIT
#include "loaders/structure.h"
#include "scenes/internal.h"

bool structure_parse_ship(const void *image, size_t image_length, const char *name, const char *materials,
                          size_t materials_length, const char *materials_name, structure *out, scene_error *error) {
    (void)image;
    (void)image_length;
    (void)materials;
    (void)materials_length;
    (void)out;
    return scene_fail(error,
                      "%.150s: built without cJSON, so %.150s cannot be read: install libcjson-dev and configure "
                      "the build anew",
                      name, materials_name);
}
