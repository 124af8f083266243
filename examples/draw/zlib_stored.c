/// @file zlib_stored.c
/// The zlib format (RFC 1950) without compression, for where stb_image_write was not found: files are larger, and
/// every program can read them.
///
/// SPDX-License-Identifier: MIT
#include "draw/internal.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_STORED = 65535, BLOCK_HEADER = 5, STREAM_HEADER = 2, CHECKSUM = 4 };

static uint32_t adler32_of(const uint8_t *bytes, size_t length) {
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < length; i++) {
        a = (a + bytes[i]) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

uint8_t *zlib_pack(const uint8_t *bytes, size_t length, size_t *packed) {
    const size_t blocks = length / MOST_STORED + 1;
    uint8_t *result = malloc(STREAM_HEADER + blocks * BLOCK_HEADER + length + CHECKSUM);
    if (!result)
        return NULL;
    uint8_t *out = result;
    *out++ = 0x78; // deflate, window of 32 KiB
    *out++ = 0x01; // and the check bits of that
    for (size_t block = 0; block < blocks; block++) {
        const size_t first = block * MOST_STORED, left = length - first;
        const uint16_t size = (uint16_t)(left < MOST_STORED ? left : MOST_STORED);
        *out++ = block + 1 == blocks;
        *out++ = (uint8_t)size;
        *out++ = (uint8_t)(size >> 8);
        *out++ = (uint8_t)~size;
        *out++ = (uint8_t)(~size >> 8);
        memcpy(out, bytes + first, size);
        out += size;
    }
    const uint32_t sum = adler32_of(bytes, length);
    for (int shift = 24; shift >= 0; shift -= 8)
        *out++ = (uint8_t)(sum >> shift);
    *packed = (size_t)(out - result);
    return result;
}
