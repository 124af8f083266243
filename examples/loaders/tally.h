/// @file tally.h
/// Names, and how often each was met.
///
/// SPDX-License-Identifier: MIT
#ifndef LOADERS_TALLY_H
#define LOADERS_TALLY_H

#include "scenes/number.h"

enum { TALLY_NAMES = 96, TALLY_NAME_SIZE = 64 };

typedef struct tally_entry {
    char name[TALLY_NAME_SIZE];
    uint32_t count;
} tally_entry;

/// In the order of first meetings. When all places but one are taken, the last counts "others".
typedef struct tally {
    tally_entry entries[TALLY_NAMES];
    uint32_t entry_count;
} tally;

/// Count an occurrence of name, cut to what fits.
void tally_add(tally *counted, text_span name, uint32_t count);
void tally_add_text(tally *counted, const char *name, uint32_t count);
/// How often it was met.
uint32_t tally_of(const tally *counted, const char *name);

#endif
