/// @file file_kind.c
/// Image, text network, or neither?
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <stdio.h>
#include <string.h>

static bool has_ending(const char *path, const char *const *endings) {
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && endings[i]; i++)
        if (strcmp(dot, endings[i]) == 0)
            return true;
    return false;
}

bool scene_file_is_image(const char *path) {
    static const char *const images[] = {".png", ".PNG", ".bmp", ".BMP", ".pbm", ".pgm", ".ppm", ".pnm", NULL};
    static const char *const networks[] = {".msn", ".txt", NULL};
    if (has_ending(path, images))
        return true;
    if (has_ending(path, networks))
        return false;
    char start[4] = {0};
    FILE *stream = fopen(path, "rb");
    size_t length = stream ? fread(start, 1, sizeof start, stream) : 0;
    if (stream)
        fclose(stream);
    return length == sizeof start && (memcmp(start, "\x89PNG", 4) == 0 || memcmp(start, "BM", 2) == 0 ||
                                      (start[0] == 'P' && start[1] >= '1' && start[1] <= '6'));
}

// What other files are, by the endings of their names, and what to do with them.
typedef struct other_kind {
    const char *endings[8];
    const char *what, *advice;
} other_kind;

static const other_kind other_kinds[] = {
    {{".truck", ".trailer", ".load", ".boat", ".airplane", ".machine"},
     "a structure of Rigs of Rods",
     "let load --write FILE.msn make a text network of it"},
    {{".jbeam"}, "a structure of BeamNG", "let load --write FILE.msn make a text network of it"},
    {{".obj", ".OBJ"}, "a Wavefront model", "let load --write FILE.msn make a text network of it"},
    {{".shp", ".shp2"}, "a ship of Floating Sandbox", "let load --write FILE.msn make a text network of it"},
    {{".jpg", ".jpeg", ".JPG", ".gif", ".webp", ".svg"},
     "a picture whose colours are not kept, or no pixels",
     "save it as PNG, BMP or PNM"},
    {{".zip", ".gz", ".7z"}, "an archive", "unpack it"},
};

bool scene_file_is_other(const char *path, const char *data, size_t size, scene_error *error) {
    for (size_t i = 0; i < sizeof other_kinds / sizeof *other_kinds; i++)
        if (has_ending(path, other_kinds[i].endings))
            return !scene_fail(error, "%.200s is %s: %s", path, other_kinds[i].what, other_kinds[i].advice);
    if (size > 0 && memchr(data, 0, size))
        return !scene_fail(error,
                           "%.200s is neither an image (PNG, BMP, PNM) nor a text network: it has bytes that no "
                           "text has",
                           path);
    return false;
}
