/// @file bytes.h
/// Looking for a byte. (memchr() is not among what a host without C library has to give.)
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_BYTES_H
#define MSPRINGI_BYTES_H

#include <stdint.h>
#include <string.h>

/// The index of the first byte of that value from first to end - 1; end if there is none.
static inline uint32_t mspringi_find_byte(const uint8_t *bytes, uint8_t value, uint32_t first, uint32_t end) {
    const uint64_t ones = UINT64_C(0x0101010101010101);
    // Eight at a time: a byte that is 0 borrows from its high bit, which was not set.
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
