/// @file draws.c
///
/// SPDX-License-Identifier: MIT
#include "draws.h"

#include "support.h"

static uint32_t next_byte(draws *from) {
    return from->at < from->size ? from->bytes[from->at++] : 0;
}

uint32_t draw(draws *from, uint32_t bound) {
    if (!from->bytes)
        return (uint32_t)(support_random(&from->seed) >> 32) % bound;
    const uint32_t low = next_byte(from);
    return (bound > 256 ? low | next_byte(from) << 8 : low) % bound;
}

double draw_between(draws *from, double low, double high) {
    return from->bytes ? low + (high - low) * draw(from, 256) / 256
                       : support_random_between(&from->seed, low, high);
}

bool draw_chance(draws *from, uint32_t percent) {
    return draw(from, 100) < percent;
}

bool draws_go_on(const draws *from) {
    return !from->bytes || from->at < from->size;
}

draws draws_apart(draws *from) {
    if (from->bytes)
        return (draws){.seed = 1 + draw(from, 65536)};
    return (draws){.seed = support_random(&from->seed)};
}
