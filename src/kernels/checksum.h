/// @file checksum.h
/// Checksum of snapshots, computed while they are copied or read. All instruction sets share this source: compilers
/// vectorise it, and sums of integers do not depend on the order.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_KERNELS_CHECKSUM_H
#define MSPRINGI_KERNELS_CHECKSUM_H

#include <string.h>

#if defined(_MSC_VER)
#define MSPRINGI_SUMMED static __forceinline
#else
#define MSPRINGI_SUMMED static inline __attribute__((always_inline))
#endif

static inline uint64_t little_endian(uint64_t word) {
    if (!MSPRINGI_BIG_ENDIAN_HOST)
        return word;
    uint64_t turned = 0;
    for (int byte = 0; byte < 8; ++byte)
        turned |= (word >> 8 * byte & 0xff) << (56 - 8 * byte);
    return turned;
}

// Fletcher's sums (1982) of 64-bit words modulo 2^64: the first detects changed words, the second exchanged ones.
// Several of them side by side.
MSPRINGI_SUMMED void sum_words(uint8_t *to, const uint8_t *from, size_t units, mspringi_checksum *checksum,
                               bool copies) {
    mspringi_checksum c = *checksum;
    for (size_t i = 0; i < units; ++i, from += MSPRINGI_CHECKSUM_UNIT) {
        uint64_t words[MSPRINGI_CHECKSUM_LANES];
        memcpy(words, from, sizeof words);
        if (copies) {
            memcpy(to, words, sizeof words);
            to += MSPRINGI_CHECKSUM_UNIT;
        }
        for (int lane = 0; lane < MSPRINGI_CHECKSUM_LANES; ++lane) {
            c.sums[lane] += little_endian(words[lane]);
            c.sums_of_sums[lane] += c.sums[lane];
        }
    }
    *checksum = c;
}

// AVX-512, data beyond the second-level cache: 10 % more time than a copy alone. To copy first and then sum up,
// with SSE2 and a part of the first-level cache at a time, takes twice as long.
static void take_checksum(uint8_t *to, const uint8_t *from, size_t units, mspringi_checksum *sums) {
    if (to)
        sum_words(to, from, units, sums, true);
    else
        sum_words(NULL, from, units, sums, false);
}

#endif
