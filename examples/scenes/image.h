/// @file image.h
/// Images from memory.
///
/// SPDX-License-Identifier: MIT
#ifndef SCENES_IMAGE_H
#define SCENES_IMAGE_H

#include "scenes/scene.h"

/// Most pixels of an image.
#define IMAGE_MAX_PIXELS ((uint32_t)1 << 26)

typedef struct pixel_image {
    uint32_t width, height;
    uint8_t *rgba; ///< [height][width][4], the top row first
} pixel_image;

/// Decode an image: PNM (P1 to P6) always; PNG and BMP where stb_image.h was found at build time. More than
/// IMAGE_MAX_PIXELS are refused before memory is taken for them. name stands for the path in messages.
bool image_decode(const void *bytes, size_t length, const char *name, pixel_image *out, scene_error *error);
void image_free(pixel_image *unwanted);

#endif
