/// Sorting of 64-bit keys.
#include "analysis.h"

#include <string.h>

#define DIGIT_BITS 8
#define DIGITS (64 / DIGIT_BITS)
#define DIGIT_VALUES (1 << DIGIT_BITS)

void mspringi_sort_keys(uint64_t *keys, uint64_t *scratch, size_t count) {
    uint64_t *from = keys, *to = scratch;
    for (int digit = 0; digit < DIGITS; ++digit) {
        const int shift = digit * DIGIT_BITS;
        size_t place[DIGIT_VALUES + 1] = {0};
        for (size_t i = 0; i < count; ++i)
            place[(from[i] >> shift & (DIGIT_VALUES - 1)) + 1]++;
        if (count == 0 || place[(from[0] >> shift & (DIGIT_VALUES - 1)) + 1] == count)
            continue; // the same digit everywhere
        for (int value = 0; value < DIGIT_VALUES; ++value)
            place[value + 1] += place[value];
        for (size_t i = 0; i < count; ++i)
            to[place[from[i] >> shift & (DIGIT_VALUES - 1)]++] = from[i];
        uint64_t *swapped = from;
        from = to;
        to = swapped;
    }
    if (from != keys)
        memcpy(keys, from, count * sizeof *keys);
}
