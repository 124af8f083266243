/// @file draws.h
/// Source of a host's decisions: a seed, or the bytes of a fuzzer. A copy remembers the position, so that the same
/// decisions can be drawn again.
///
/// SPDX-License-Identifier: MIT
#ifndef HOSTS_DRAWS_H
#define HOSTS_DRAWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct draws {
    uint64_t seed;
    const uint8_t *bytes; ///< NULL: by the seed
    size_t size, at;      ///< zeros follow the last byte
} draws;

/// Return a number below bound, which is above 0 and at most 65536.
uint32_t draw(draws *from, uint32_t bound);
double draw_between(draws *from, double low, double high);
bool draw_chance(draws *from, uint32_t percent);

/// True if there are decisions left to take.
bool draws_go_on(const draws *from);

/// Draws for the details of a decision: numbers from the seed alone, which take no bytes of the fuzzer.
draws draws_apart(draws *from);

#endif
