/// @file hash.h
/// 64-bit hash of words: FNV-1a (Fowler, Noll, Vo 1991) on 64-bit words instead of bytes. The upper half is folded
/// in, so every bit of a word reaches every bit of the hash.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_HASH_H
#define MSPRINGI_HASH_H

#include <stdint.h>
#include <string.h>

/// Hash of an empty sequence.
#define MSPRINGI_HASH_START UINT64_C(0xcbf29ce484222325)

static inline uint64_t mspringi_hash(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * UINT64_C(0x100000001b3);
    return hash ^ hash >> 32;
}

static inline uint64_t mspringi_hash_floats(uint64_t hash, float a, float b) {
    uint32_t low, high;
    memcpy(&low, &a, sizeof low);
    memcpy(&high, &b, sizeof high);
    return mspringi_hash(hash, (uint64_t)high << 32 | low);
}

static inline uint64_t mspringi_hash_double(uint64_t hash, double value) {
    uint64_t word;
    memcpy(&word, &value, sizeof word);
    return mspringi_hash(hash, word);
}

/// Pseudo-random bits for each n; the upper ones are the best (SplitMix64 but its last line, Steele et al. 2014).
static inline uint64_t mspringi_mix(uint64_t n) {
    uint64_t bits = n * UINT64_C(0x9e3779b97f4a7c15);
    bits = (bits ^ bits >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    return (bits ^ bits >> 27) * UINT64_C(0x94d049bb133111eb);
}

#endif
