/// @file names.h
/// Nodes by their names.
///
/// SPDX-License-Identifier: MIT
#ifndef LOADERS_NAMES_H
#define LOADERS_NAMES_H

#include "scenes/internal.h"

/// Names point into the text that they were read from.
typedef struct name_entry {
    text_span name;
    uint32_t node;
    unsigned long line; ///< where it was given
} name_entry;

typedef struct name_table {
    name_entry *entries; ///< open addressing; a free place has a NULL name
    size_t capacity, count;
} name_table;

/// The entry of a name, or NULL.
const name_entry *name_find(const name_table *table, text_span name);
/// Add a name that is not there yet.
bool name_add(name_table *table, text_span name, uint32_t node, unsigned long line, scene_error *error);
void name_free(name_table *table);

#endif
