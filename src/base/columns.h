/// @file columns.h
/// The arrays that a struct holds, as a table: freeing them, and finding them in a copy, is a loop over it.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_COLUMNS_H
#define MSPRINGI_COLUMNS_H

#include "base/memory.h"

typedef enum mspringi_column_kind {
    MSPRINGI_ARRAY,  ///< a block of memory of its own
    MSPRINGI_PLANES, ///< likewise, of whole planes by slot, which a relayout moves
    MSPRINGI_VIEW,   ///< points into another array
    MSPRINGI_GROUP   ///< no array: those that follow are reserved and freed together
} mspringi_column_kind;

typedef struct mspringi_column {
    uint16_t offset; ///< of the pointer in the struct
    uint16_t size;   ///< of an element
    uint16_t kind;   ///< mspringi_column_kind
} mspringi_column;

typedef struct mspringi_columns {
    const mspringi_column *list;
    size_t count;
} mspringi_columns;

/// A row for a member of a type of struct.
#define MSPRINGI_COLUMN(type, member, kind)                                                                        \
    { offsetof(type, member), sizeof *((type *)0)->member, (kind) }

/// The table of an array of rows.
#define MSPRINGI_COLUMNS(rows)                                                                                     \
    { rows, sizeof(rows) / sizeof(rows)[0] }

/// The pointer itself. (All pointers to objects are represented alike where the library runs.)
void *mspringi_column_get(const mspringi_column *column, const void *owner);
void mspringi_column_set(const mspringi_column *column, void *owner, void *array);

/// Free the arrays, and have all pointers be NULL.
void mspringi_columns_free(mspringi_columns columns, void *owner, mspringi_memory *memory);

/// Have pointers that were copied lead to copies of their own. False: no memory, and some still lead to the
/// originals. There may be no views.
bool mspringi_columns_duplicate(mspringi_columns columns, void *owner, mspringi_memory *memory);

/// Have pointers that were copied lead to where mspringi_memory_copy() has copied to what they point to.
void mspringi_columns_relocate(mspringi_columns columns, void *owner, const mspringi_memory *from,
                               const mspringi_memory *to);

#endif
