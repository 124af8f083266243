/// @file draws.h
/// Where a host takes its decisions from: a seed, or the bytes of a fuzzer. To copy it is to remember the place, so
/// that the same decisions can be taken again.
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

/// What follows from a decision once taken, at no further byte: numbers of the seed alone.
draws draws_apart(draws *from);

#endif
