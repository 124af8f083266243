/// Operations on all arrays of a struct.
#include "base/array_table.h"

#include "base/assert.h"

#include <string.h>

void *mspringi_column_get(const mspringi_array_entry *column, const void *owner) {
    void *array;
    memcpy(&array, (const char *)owner + column->offset, sizeof array);
    return array;
}

void mspringi_column_set(const mspringi_array_entry *column, void *owner, void *array) {
    memcpy((char *)owner + column->offset, &array, sizeof array);
}

void mspringi_array_table_free(mspringi_array_table columns, void *owner, mspringi_memory *memory) {
    for (size_t i = 0; i < columns.count; ++i) {
        const mspringi_array_entry *c = &columns.list[i];
        if (c->kind == MSPRINGI_ARRAY || c->kind == MSPRINGI_PLANES)
            mspringi_free(memory, mspringi_column_get(c, owner));
        if (c->kind != MSPRINGI_GROUP)
            mspringi_column_set(c, owner, NULL);
    }
}

bool mspringi_array_table_duplicate(mspringi_array_table columns, void *owner, mspringi_memory *memory) {
    for (size_t i = 0; i < columns.count; ++i) {
        const mspringi_array_entry *c = &columns.list[i];
        if (c->kind == MSPRINGI_GROUP || !mspringi_column_get(c, owner))
            continue;
        void *copy = mspringi_memory_duplicate(memory, mspringi_column_get(c, owner));
        if (!copy)
            return false;
        MSPRINGI_ASSERT(c->kind != MSPRINGI_VIEW);
        mspringi_column_set(c, owner, copy);
    }
    return true;
}

void mspringi_array_table_relocate(mspringi_array_table columns, void *owner, const mspringi_memory *from,
                                   const mspringi_memory *to) {
    for (size_t i = 0; i < columns.count; ++i) {
        const mspringi_array_entry *c = &columns.list[i];
        if (c->kind != MSPRINGI_GROUP)
            mspringi_column_set(c, owner, mspringi_memory_moved(from, to, mspringi_column_get(c, owner)));
    }
}
