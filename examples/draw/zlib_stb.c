/// @file zlib_stb.c
/// Compression in the zlib format by stb_image_write.
///
/// SPDX-License-Identifier: MIT
#include "draw/internal.h"

#include <limits.h>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function" // writers of whole files, which are not used here
#endif
#include <stb_image_write.h>

// How far it looks for repetitions; more is slower and hardly smaller.
#define QUALITY 32

uint8_t *zlib_pack(const uint8_t *bytes, size_t length, size_t *packed) {
    int packed_length = 0;
    if (length > INT_MAX / 2)
        return NULL;
    // It does not write to the bytes, though it takes them as if it would.
    uint8_t *result = stbi_zlib_compress((unsigned char *)bytes, (int)length, &packed_length, QUALITY);
    *packed = result ? (size_t)packed_length : 0;
    return result;
}
