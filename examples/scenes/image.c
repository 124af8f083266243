/// @file image.c
/// Which decoder an image needs.
///
/// SPDX-License-Identifier: MIT
#include "scenes/image_internal.h"
#include "scenes/internal.h"

#include <stdlib.h>
#include <string.h>

bool image_check_size(const char *name, uint64_t width, uint64_t height, scene_error *error) {
    if (width == 0 || height == 0)
        return scene_fail(error, "%.200s: the image has no pixel: it is %llu x %llu", name,
                          (unsigned long long)width, (unsigned long long)height);
    if (width > IMAGE_MAX_PIXELS || height > IMAGE_MAX_PIXELS || width * height > IMAGE_MAX_PIXELS)
        return scene_fail(error,
                          "%.200s: the image is too large: %llu x %llu pixels, at most %u are read; scale it down",
                          name, (unsigned long long)width, (unsigned long long)height, IMAGE_MAX_PIXELS);
    return true;
}

static bool starts_with(const uint8_t *bytes, size_t length, const char *magic, size_t magic_length) {
    return length >= magic_length && memcmp(bytes, magic, magic_length) == 0;
}

bool image_decode(const void *bytes, size_t length, const char *name, pixel_image *out, scene_error *error) {
    const uint8_t *start = bytes;
    if (length == 0)
        return scene_fail(error, "%.200s is empty: give an image", name);
    if (length >= 2 && start[0] == 'P' && start[1] >= '1' && start[1] <= '6')
        return image_decode_pnm(start, length, name, out, error);
    if (starts_with(start, length, "\x89PNG\r\n\x1a\n", 8) || starts_with(start, length, "BM", 2)) {
#ifdef SCENES_HAVE_STB_IMAGE
        return image_decode_stb(start, length, name, out, error);
#else
        return scene_fail(
            error,
            "%.200s: this program was built without stb_image.h and reads PNM images only: convert it to "
            "PPM, or install stb (libstb-dev) and build again",
            name);
#endif
    }
    return scene_fail(error, "%.200s: not an image of a known kind: it must be PNM (P1 to P6), PNG or BMP", name);
}

void image_free(pixel_image *unwanted) {
    free(unwanted->rgba);
    memset(unwanted, 0, sizeof *unwanted);
}
