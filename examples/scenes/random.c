/// @file random.c
/// Random numbers that are the same on every machine.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

// splitmix64 (Steele, Lea, Flood 2014): a counter with an odd step, then a mixing function that lets every bit
// of it reach every bit of the result.
uint64_t random_next(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

// The high half of a 32 x 32 bit product: its bias, below bound / 2^32, does not matter to a scene.
uint32_t random_below(uint64_t *state, uint32_t bound) {
    return (uint32_t)(((random_next(state) >> 32) * bound) >> 32);
}

double random_unit(uint64_t *state) {
    return (double)(random_next(state) >> 11) * 0x1p-53;
}
