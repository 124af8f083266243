/// @file pair_set.c
/// Pairs of particles in a hash table with open addressing.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 1024 };

// Free places hold 0, the pair of particle 0 with itself, which no spring can be.
static uint64_t key_of(mspring_id a, mspring_id b) {
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

// The place where key is or would be; capacity is a power of two and never full.
static size_t place_of(const uint64_t *keys, size_t capacity, uint64_t key) {
    uint64_t state = key;
    size_t place = (size_t)random_next(&state) & (capacity - 1);
    while (keys[place] && keys[place] != key)
        place = (place + 1) & (capacity - 1);
    return place;
}

static bool grow(pair_set *set) {
    size_t capacity = set->capacity ? 2 * set->capacity : FIRST_CAPACITY;
    uint64_t *keys = calloc(capacity, sizeof *keys);
    uint64_t *notes = malloc(capacity * sizeof *notes);
    if (!keys || !notes) {
        free(keys);
        free(notes);
        return false;
    }
    for (size_t i = 0; i < set->capacity; i++) {
        if (!set->keys[i])
            continue;
        size_t place = place_of(keys, capacity, set->keys[i]);
        keys[place] = set->keys[i];
        notes[place] = set->notes[i];
    }
    free(set->keys);
    free(set->notes);
    set->keys = keys;
    set->notes = notes;
    set->capacity = capacity;
    return true;
}

pair_added pair_set_add(pair_set *set, mspring_id a, mspring_id b, uint64_t note, uint64_t *present) {
    if (2 * set->count >= set->capacity && !grow(set))
        return PAIR_NO_MEMORY;
    uint64_t key = key_of(a, b);
    size_t place = place_of(set->keys, set->capacity, key);
    if (set->keys[place]) {
        *present = set->notes[place];
        return PAIR_PRESENT;
    }
    set->keys[place] = key;
    set->notes[place] = note;
    set->count++;
    return PAIR_NEW;
}

void pair_set_free(pair_set *set) {
    free(set->keys);
    free(set->notes);
    memset(set, 0, sizeof *set);
}
