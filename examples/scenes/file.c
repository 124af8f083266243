/// @file file.c
/// Whole files into memory.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 1 << 16 };
static const size_t largest_file = (size_t)1 << 30;

// Reads to the end instead of asking for the size first: pipes have none.
static bool read_stream(FILE *stream, const char *path, char **data, size_t *size, scene_error *error) {
    size_t capacity = FIRST_CAPACITY;
    size_t used = 0;
    char *bytes = malloc(capacity);
    while (bytes) {
        used += fread(bytes + used, 1, capacity - used, stream);
        if (ferror(stream)) {
            scene_fail(error, "cannot read %.200s: %s", path, strerror(errno));
            free(bytes);
            return false;
        }
        if (used < capacity) {
            *data = bytes;
            *size = used;
            return true;
        }
        if (capacity >= largest_file) {
            scene_fail(error, "%.200s is larger than %zu MiB, the most that is read: take a smaller file", path,
                       largest_file >> 20);
            free(bytes);
            return false;
        }
        capacity *= 2;
        char *larger = realloc(bytes, capacity);
        if (!larger)
            free(bytes);
        bytes = larger;
    }
    return scene_fail(error, "cannot read %.200s: out of memory", path);
}

bool file_read(const char *path, char **data, size_t *size, scene_error *error) {
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return scene_fail(error, "cannot open %.200s: %s", path, strerror(errno));
    bool ok = read_stream(stream, path, data, size, error);
    fclose(stream);
    return ok;
}
