/// @file bytes.h
/// Search for a byte. (A host without a C library need not provide memchr().)
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BYTES_H
#define MSPRINGI_BYTES_H

#include <stdint.h>
#include <string.h>

/// Index of the first byte of this value from first to end - 1; end if there is none.
static inline uint32_t mspringi_find_byte(const uint8_t *bytes, uint8_t value, uint32_t first, uint32_t end) {
    const uint64_t ones = UINT64_C(0x0101010101010101);
    // Eight at a time: a zero byte borrows from its high bit, which was not set.
    for (; end - first >= 8; first += 8) {
        uint64_t word;
        memcpy(&word, bytes + first, sizeof word);
        word ^= ones * value;
        if ((word - ones) & ~word & ones << 7)
            break;
    }
    while (first < end && bytes[first] != value)
        ++first;
    return first;
}

#endif
