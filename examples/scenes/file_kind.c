/// @file file_kind.c
/// Image or text network?
///
/// SPDX-License-Identifier: MIT
#include "scenes/scene.h"

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
