/// @file fuzz_scenes.c
/// The readers of text networks, images and material tables: they refuse with a message, or give a scene that can
/// be made into a network.
///
/// SPDX-License-Identifier: MIT
#include "check.h"

#include <string.h>

#include "scenes/scene.h"

static void check_scene(scene *made) {
    mspring_network *network = NULL;
    // Refused with a message too: particles and springs may be wrong together where none is alone.
    mspring_result result = mspring_network_create(made->builder, NULL, &network);
    FUZZ_CHECK(result == MSPRING_OK || strlen(mspring_builder_error(made->builder)) > 0);
    if (result == MSPRING_OK) {
        const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
        FUZZ_CHECK(made->probe == MSPRING_NONE || made->probe < count);
        result = fuzz_step(network, 1e-4);
        FUZZ_CHECK(result == MSPRING_OK || result == MSPRING_ERROR_UNSTABLE);
        mspring_network_destroy(network);
    }
    scene_free(made);
}

static void check_refused(const scene_error *error) {
    FUZZ_CHECK(strlen(error->text) > 0);
    FUZZ_CHECK(memchr(error->text, 0, sizeof error->text) != NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0)
        return 0;
    const scene_options options = scene_options_from_file();
    scene_error error = {""};
    scene made;
    const char *text = (const char *)data + 1;
    size--;
    switch (data[0] % 3) {
    case 0:
        if (scene_network_parse(text, size, "fuzz", &options, &made, &error))
            check_scene(&made);
        else
            check_refused(&error);
        break;
    case 1: {
        scene_materials materials;
        if (!scene_materials_builtin(&materials, &error))
            return 0;
        if (scene_image_parse(text, size, "fuzz", &materials, &options, &made, &error))
            check_scene(&made);
        else
            check_refused(&error);
        scene_materials_free(&materials);
        break;
    }
    default: {
        scene_materials materials;
        if (scene_materials_parse(text, size, "fuzz", &materials, &error))
            scene_materials_free(&materials);
        else
            check_refused(&error);
    }
    }
    return 0;
}
