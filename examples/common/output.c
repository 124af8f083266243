/// @file output.c
/// Output folders.
///
/// SPDX-License-Identifier: MIT
#if !defined(_WIN32) && !defined(_POSIX_C_SOURCE)
#define _POSIX_C_SOURCE 200809L
#endif
#include "common/output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <direct.h>
#else
#include <sys/stat.h>
#endif

static int make_folder(const char *folder) {
#ifdef _WIN32
    return _mkdir(folder);
#else
    return mkdir(folder, 0777);
#endif
}

bool output_make_folder(const char *folder) {
    if (make_folder(folder) == 0 || errno == EEXIST)
        return true;
    fprintf(stderr, "cannot make the folder %s: %s\n", folder, strerror(errno));
    return false;
}

bool output_path(char path[OUTPUT_PATH_SIZE], const char *folder, const char *name, const char *ending) {
    int length = snprintf(path, OUTPUT_PATH_SIZE, "%s/%s%s", folder, name, ending);
    if (length >= 0 && length < OUTPUT_PATH_SIZE)
        return true;
    fprintf(stderr, "the path of %s%s is too long: choose a shorter folder\n", name, ending);
    return false;
}

bool output_figure(const figure *drawn, const char *folder, const char *name) {
    char path[OUTPUT_PATH_SIZE];
    draw_error error = {""};
    bool ok = output_path(path, folder, name, ".png");
    if (ok && (ok = figure_write_png(drawn, path, &error)))
        printf("written %s\n", path);
    if (ok && (ok = output_path(path, folder, name, ".svg")) && (ok = figure_write_svg(drawn, path, &error)))
        printf("written %s\n", path);
    if (!ok && error.text[0])
        fprintf(stderr, "%s\n", error.text);
    return ok;
}

const char *output_folder_from_arguments(int count, char **arguments, const char *about, int *exit_code) {
    const char *folder = "out";
    if (count == 2 && strcmp(arguments[1], "--help") == 0) {
        printf("%s\n\nusage: %s [--out FOLDER]\n", about, arguments[0]);
        *exit_code = EXIT_SUCCESS;
        return NULL;
    }
    if (count == 3 && strcmp(arguments[1], "--out") == 0) {
        folder = arguments[2];
    } else if (count != 1) {
        fprintf(stderr, "usage: %s [--out FOLDER]\n", arguments[0]);
        *exit_code = 2;
        return NULL;
    }
    if (output_make_folder(folder))
        return folder;
    *exit_code = EXIT_FAILURE;
    return NULL;
}
