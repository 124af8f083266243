/// Operations on all arrays of a struct.
#include "base/array_table.h"

#include "base/assert.h"

#include <string.h>

void *mspringi_array_entry_get(const mspringi_array_entry *entry, const void *owner) {
    void *array;
    memcpy(&array, (const char *)owner + entry->offset, sizeof array);
    return array;
}

void mspringi_array_entry_set(const mspringi_array_entry *entry, void *owner, void *array) {
    memcpy((char *)owner + entry->offset, &array, sizeof array);
}

void mspringi_array_table_free(mspringi_array_table table, void *owner, mspringi_memory *memory) {
    for (size_t i = 0; i < table.count; ++i) {
        const mspringi_array_entry *entry = &table.list[i];
        if (entry->kind == MSPRINGI_ARRAY || entry->kind == MSPRINGI_PLANES)
            mspringi_free(memory, mspringi_array_entry_get(entry, owner));
        if (entry->kind != MSPRINGI_GROUP)
            mspringi_array_entry_set(entry, owner, NULL);
    }
}

bool mspringi_array_table_duplicate(mspringi_array_table table, void *owner, mspringi_memory *memory) {
    for (size_t i = 0; i < table.count; ++i) {
        const mspringi_array_entry *entry = &table.list[i];
        if (entry->kind == MSPRINGI_GROUP || !mspringi_array_entry_get(entry, owner))
            continue;
        void *copy = mspringi_memory_duplicate(memory, mspringi_array_entry_get(entry, owner));
        if (!copy)
            return false;
        MSPRINGI_ASSERT(entry->kind != MSPRINGI_VIEW);
        mspringi_array_entry_set(entry, owner, copy);
    }
    return true;
}

void mspringi_array_table_relocate(mspringi_array_table table, void *owner, const mspringi_memory *from,
                                   const mspringi_memory *to) {
    for (size_t i = 0; i < table.count; ++i) {
        const mspringi_array_entry *entry = &table.list[i];
        if (entry->kind != MSPRINGI_GROUP)
            mspringi_array_entry_set(entry, owner,
                                     mspringi_memory_relocate(from, to, mspringi_array_entry_get(entry, owner)));
    }
}
