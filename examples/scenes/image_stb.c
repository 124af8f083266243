/// @file image_stb.c
/// PNG and BMP, decoded by stb_image.
///
/// SPDX-License-Identifier: MIT
#include "scenes/image_internal.h"
#include "scenes/internal.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

// The largest image takes 8 bytes a pixel while it is decoded. A compressed stream that unpacks to more than
// its header says would otherwise take memory without end.
static const size_t largest_block = (size_t)IMAGE_MAX_PIXELS * 8 + ((size_t)1 << 20);

static void *bounded_realloc(void *memory, size_t size) {
    return size <= largest_block ? realloc(memory, size) : NULL;
}

static void *bounded_malloc(size_t size) {
    return bounded_realloc(NULL, size);
}

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS (1 << 26)
#define STBI_MALLOC(size) bounded_malloc(size)
#define STBI_REALLOC(memory, size) bounded_realloc(memory, size)
#define STBI_FREE(memory) free(memory)
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function" // what the header declares for formats left out
#endif
#include <stb_image.h>

static bool fail_decode(const char *name, scene_error *error) {
    const char *reason = stbi_failure_reason();
    return scene_fail(error,
                      "%.200s: cannot decode the image (%s): it is damaged, cut off, or of a kind not supported",
                      name, reason ? reason : "no reason given");
}

static uint32_t load_u32(const uint8_t *bytes) {
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

// A PNG file starts with its size. stb_image refuses large ones, too, but without saying that this is why.
static bool check_png_size(const uint8_t *bytes, size_t length, const char *name, scene_error *error) {
    enum { WIDTH = 16, HEIGHT = 20, HEADER_END = 24 };
    if (bytes[0] != 0x89 || length < HEADER_END || memcmp(bytes + WIDTH - 4, "IHDR", 4) != 0)
        return true;
    return image_check_size(name, load_u32(bytes + WIDTH), load_u32(bytes + HEIGHT), error);
}

bool image_decode_stb(const uint8_t *bytes, size_t length, const char *name, pixel_image *out, scene_error *error) {
    int width = 0;
    int height = 0;
    int channels = 0;
    if (length > INT_MAX)
        return scene_fail(error, "%.200s: the file is too large: %zu bytes", name, length);
    if (!check_png_size(bytes, length, name, error))
        return false;
    if (!stbi_info_from_memory(bytes, (int)length, &width, &height, &channels))
        return fail_decode(name, error);
    if (width < 0 || height < 0)
        return scene_fail(error, "%.200s: the image's size is negative", name);
    if (!image_check_size(name, (uint64_t)width, (uint64_t)height, error))
        return false;
    stbi_uc *pixels = stbi_load_from_memory(bytes, (int)length, &width, &height, &channels, 4);
    if (!pixels)
        return fail_decode(name, error);
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    out->rgba = pixels;
    return true;
}
