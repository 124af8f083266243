/// @file array_table.h
/// The arrays that a struct holds, as a table: freeing them, and finding them in a copy, is a loop over it.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ARRAY_TABLE_H
#define MSPRINGI_ARRAY_TABLE_H

#include "base/memory.h"

typedef enum mspringi_column_kind {
    MSPRINGI_ARRAY,  ///< a block of memory of its own
    MSPRINGI_PLANES, ///< likewise, of whole planes by slot, which a relayout moves
    MSPRINGI_VIEW,   ///< points into another array
    MSPRINGI_GROUP   ///< no array: those that follow are reserved and freed together
} mspringi_column_kind;

typedef struct mspringi_array_entry {
    uint16_t offset; ///< of the pointer in the struct
    uint16_t size;   ///< of an element
    uint16_t kind;   ///< mspringi_column_kind
} mspringi_array_entry;

typedef struct mspringi_array_table {
    const mspringi_array_entry *list;
    size_t count;
} mspringi_array_table;

/// A row for a member of a type of struct.
#define MSPRINGI_ARRAY_ENTRY(type, member, kind)                                                                   \
    { offsetof(type, member), sizeof *((type *)0)->member, (kind) }

/// The table of an array of rows.
#define MSPRINGI_ARRAY_TABLE(rows)                                                                                 \
    { rows, sizeof(rows) / sizeof(rows)[0] }

/// The pointer itself. (All pointers to objects are represented alike where the library runs.)
void *mspringi_column_get(const mspringi_array_entry *column, const void *owner);
void mspringi_column_set(const mspringi_array_entry *column, void *owner, void *array);

/// Free the arrays, and have all pointers be NULL.
void mspringi_array_table_free(mspringi_array_table columns, void *owner, mspringi_memory *memory);

/// Have pointers that were copied lead to copies of their own. False: no memory, and some still lead to the
/// originals. There may be no views.
bool mspringi_array_table_duplicate(mspringi_array_table columns, void *owner, mspringi_memory *memory);

/// Have pointers that were copied lead to where mspringi_memory_copy() has copied to what they point to.
void mspringi_array_table_relocate(mspringi_array_table columns, void *owner, const mspringi_memory *from,
                                   const mspringi_memory *to);

#endif
