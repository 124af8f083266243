/// Radix sort of 64-bit keys.
#include "layout/analysis.h"

#include <string.h>

#define DIGIT_BITS 8
#define DIGIT_VALUES (1 << DIGIT_BITS)

static void move_by_digit(const uint64_t *from, uint64_t *to, size_t count, uint32_t shift) {
    size_t place[DIGIT_VALUES + 1] = {0};
    for (size_t i = 0; i < count; ++i)
        place[(from[i] >> shift & (DIGIT_VALUES - 1)) + 1]++;
    for (int value = 0; value < DIGIT_VALUES; ++value)
        place[value + 1] += place[value];
    for (size_t i = 0; i < count; ++i)
        to[place[from[i] >> shift & (DIGIT_VALUES - 1)]++] = from[i];
}

void mspringi_sort_keys(uint64_t *keys, uint64_t *scratch, size_t count) {
    uint64_t differing = 0, *from = keys, *to = scratch;
    for (size_t i = 0; i < count; ++i)
        differing |= keys[i] ^ keys[0];
    for (uint32_t shift = 0; shift < 64; shift += DIGIT_BITS) {
        if ((differing >> shift & (DIGIT_VALUES - 1)) == 0)
            continue; // all keys have this digit in common
        move_by_digit(from, to, count, shift);
        uint64_t *const sorted = to;
        to = from;
        from = sorted;
    }
    if (from != keys)
        memcpy(keys, from, count * sizeof *keys);
}
