/// @file array_table.h
/// Tables of a struct's arrays: freeing, copying and relocating them is a loop over the table.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ARRAY_TABLE_H
#define MSPRINGI_ARRAY_TABLE_H

#include "base/memory.h"

typedef enum mspringi_array_kind {
    MSPRINGI_ARRAY,  ///< block of memory of its own
    MSPRINGI_PLANES, ///< likewise, planes indexed by slot, which a new layout moves
    MSPRINGI_VIEW,   ///< pointer into another array
    MSPRINGI_GROUP   ///< no array: the following ones are reserved and freed together
} mspringi_array_kind;

typedef struct mspringi_array_entry {
    uint16_t offset; ///< of the pointer in the struct
    uint16_t size;   ///< of an element
    uint16_t kind;   ///< mspringi_array_kind
} mspringi_array_entry;

typedef struct mspringi_array_table {
    const mspringi_array_entry *list;
    size_t count;
} mspringi_array_table;

/// Entry of a struct's member.
#define MSPRINGI_ARRAY_ENTRY(type, member, kind)                                                                   \
    { offsetof(type, member), sizeof *((type *)0)->member, (kind) }

/// Table of an array of entries.
#define MSPRINGI_ARRAY_TABLE(rows)                                                                                 \
    { rows, sizeof(rows) / sizeof(rows)[0] }

/// Get or set the pointer of an entry. (All object pointers have the same representation on supported platforms.)
void *mspringi_array_entry_get(const mspringi_array_entry *entry, const void *owner);
void mspringi_array_entry_set(const mspringi_array_entry *entry, void *owner, void *array);

/// Free the arrays and set all pointers to NULL.
void mspringi_array_table_free(mspringi_array_table table, void *owner, mspringi_memory *memory);

/// Replace copied pointers by copies of their arrays. The table has no views. Return false if memory is out; some
/// pointers then still lead to the originals.
bool mspringi_array_table_duplicate(mspringi_array_table table, void *owner, mspringi_memory *memory);

/// Redirect copied pointers to the blocks that mspringi_memory_copy() has made.
void mspringi_array_table_relocate(mspringi_array_table table, void *owner, const mspringi_memory *from,
                                   const mspringi_memory *to);

#endif
