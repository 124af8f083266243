/// @file names.c
/// Nodes by their names, in a hash table.
///
/// SPDX-License-Identifier: MIT
#include "loaders/names.h"

#include <stdlib.h>
#include <string.h>

// 007 is 7: files count on numbers being compared as numbers.
static text_span plain(text_span name) {
    for (size_t i = 0; i < name.length; i++)
        if (name.start[i] < '0' || name.start[i] > '9')
            return name;
    while (name.length > 1 && *name.start == '0') {
        name.start++;
        name.length--;
    }
    return name;
}

// Where the name is or would be; the table is never full. (FNV-1a, then mixed: a file may be made to collide, and
// costs its reader time then, nothing else.)
static size_t place_of(const name_entry *entries, size_t capacity, text_span name) {
    uint64_t state = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < name.length; i++)
        state = (state ^ (unsigned char)name.start[i]) * UINT64_C(0x100000001b3);
    size_t place = (size_t)random_next(&state) & (capacity - 1);
    while (entries[place].name.start && (entries[place].name.length != name.length ||
                                         memcmp(entries[place].name.start, name.start, name.length) != 0))
        place = (place + 1) & (capacity - 1);
    return place;
}

const name_entry *name_find(const name_table *table, text_span name) {
    if (table->count == 0)
        return NULL;
    const name_entry *entry = &table->entries[place_of(table->entries, table->capacity, plain(name))];
    return entry->name.start ? entry : NULL;
}

static bool grow(name_table *table) {
    size_t capacity = table->capacity ? 2 * table->capacity : 256;
    name_entry *entries = calloc(capacity, sizeof *entries);
    if (!entries)
        return false;
    for (size_t i = 0; i < table->capacity; i++)
        if (table->entries[i].name.start)
            entries[place_of(entries, capacity, table->entries[i].name)] = table->entries[i];
    free(table->entries);
    table->entries = entries;
    table->capacity = capacity;
    return true;
}

bool name_add(name_table *table, text_span name, uint32_t node, unsigned long line, scene_error *error) {
    if (2 * table->count >= table->capacity && !grow(table))
        return scene_fail_memory(error, "cannot read the nodes");
    text_span kept = plain(name);
    name_entry entry = {kept, node, line};
    table->entries[place_of(table->entries, table->capacity, kept)] = entry;
    table->count++;
    return true;
}

void name_free(name_table *table) {
    free(table->entries);
    memset(table, 0, sizeof *table);
}
