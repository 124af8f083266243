/// Sorting of 64-bit keys.
#include "analysis.h"

#include <string.h>

#define DIGIT_VALUES (1 << MSPRINGI_DIGIT_BITS)

void mspringi_sorting_begin(mspringi_sorting *sorting, uint64_t *keys, uint64_t *scratch, uint32_t count) {
    sorting->keys = sorting->from = keys;
    sorting->to = scratch;
    sorting->count = count;
    sorting->at = 0;
    sorting->differing = 0;
    sorting->shift = 0;
    sorting->stage = MSPRINGI_SORTING_LOOKS;
}

// The digits from a shift on: find the next one that is not the same everywhere, or that there is none.
static void turn_to(mspringi_sorting *s, uint32_t shift) {
    while (shift < 64 && (s->differing >> shift & (DIGIT_VALUES - 1)) == 0)
        shift += MSPRINGI_DIGIT_BITS;
    s->shift = shift;
    s->stage = shift < 64           ? MSPRINGI_SORTING_COUNTS
               : s->from != s->keys ? MSPRINGI_SORTING_COPIES
                                    : MSPRINGI_SORTED;
    memset(s->place, 0, sizeof s->place);
}

static void finish_stage(mspringi_sorting *s) {
    uint64_t *const from = s->from;
    s->at = 0;
    switch (s->stage) {
    case MSPRINGI_SORTING_LOOKS:
        turn_to(s, 0);
        break;
    case MSPRINGI_SORTING_COUNTS:
        for (int value = 0; value < DIGIT_VALUES; ++value)
            s->place[value + 1] += s->place[value];
        s->stage = MSPRINGI_SORTING_MOVES;
        break;
    case MSPRINGI_SORTING_MOVES:
        s->from = s->to;
        s->to = from;
        turn_to(s, s->shift + MSPRINGI_DIGIT_BITS);
        break;
    default:
        s->stage = MSPRINGI_SORTED;
        break;
    }
}

static void go_through(mspringi_sorting *s, uint32_t end) {
    const uint64_t *from = s->from;
    const uint32_t shift = s->shift, first = s->at;
    uint64_t differing = 0;
    switch (s->stage) {
    case MSPRINGI_SORTING_LOOKS:
        for (uint32_t i = first; i < end; ++i)
            differing |= from[i] ^ from[0];
        s->differing |= differing;
        break;
    case MSPRINGI_SORTING_COUNTS:
        for (uint32_t i = first; i < end; ++i)
            s->place[(from[i] >> shift & (DIGIT_VALUES - 1)) + 1]++;
        break;
    case MSPRINGI_SORTING_MOVES:
        for (uint32_t i = first; i < end; ++i)
            s->to[s->place[from[i] >> shift & (DIGIT_VALUES - 1)]++] = from[i];
        break;
    default:
        memcpy(s->keys + first, from + first, (end - first) * sizeof *from);
        break;
    }
    s->at = end;
}

bool mspringi_sorting_go_on(mspringi_sorting *sorting, mspringi_pace *pace) {
    while (sorting->stage != MSPRINGI_SORTED && pace->left > 0) {
        const uint32_t left = sorting->count - sorting->at, now = left < pace->left ? left : pace->left;
        go_through(sorting, sorting->at + now);
        mspringi_pace_spend(pace, now);
        if (sorting->at == sorting->count)
            finish_stage(sorting);
    }
    return sorting->stage == MSPRINGI_SORTED;
}

void mspringi_sort_keys(uint64_t *keys, uint64_t *scratch, size_t count) {
    mspringi_sorting sorting;
    mspringi_pace pace;
    mspringi_sorting_begin(&sorting, keys, scratch, (uint32_t)count);
    do
        pace.left = MSPRINGI_PACE_ALL;
    while (!mspringi_sorting_go_on(&sorting, &pace));
}
