/// @file tally.c
/// Names, and how often each was met.
///
/// SPDX-License-Identifier: MIT
#include "loaders/tally.h"

#include <string.h>

static tally_entry *entry_of(tally *counted, const char *name) {
    for (uint32_t i = 0; i < counted->entry_count; i++)
        if (strcmp(counted->entries[i].name, name) == 0)
            return &counted->entries[i];
    if (counted->entry_count == TALLY_NAMES)
        return &counted->entries[TALLY_NAMES - 1];
    tally_entry *entry = &counted->entries[counted->entry_count++];
    const char *kept = counted->entry_count == TALLY_NAMES ? "others" : name;
    memcpy(entry->name, kept, strlen(kept) + 1);
    entry->count = 0;
    return entry;
}

void tally_add(tally *counted, text_span name, uint32_t count) {
    char text[TALLY_NAME_SIZE];
    entry_of(counted, text_quote(name, text, sizeof text))->count += count;
}

void tally_add_text(tally *counted, const char *name, uint32_t count) {
    text_span span = {name, strlen(name)};
    tally_add(counted, span, count);
}

uint32_t tally_of(const tally *counted, const char *name) {
    for (uint32_t i = 0; i < counted->entry_count; i++)
        if (strcmp(counted->entries[i].name, name) == 0)
            return counted->entries[i].count;
    return 0;
}
