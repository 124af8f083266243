/// @file image_internal.h
/// The decoders behind image_decode().
///
/// SPDX-License-Identifier: MIT
#ifndef SCENES_IMAGE_INTERNAL_H
#define SCENES_IMAGE_INTERNAL_H

#include "scenes/image.h"

/// Refuse an image that is too large or has no pixel.
bool image_check_size(const char *name, uint64_t width, uint64_t height, scene_error *error);
bool image_decode_pnm(const uint8_t *bytes, size_t length, const char *name, pixel_image *out, scene_error *error);
bool image_decode_stb(const uint8_t *bytes, size_t length, const char *name, pixel_image *out, scene_error *error);

#endif
