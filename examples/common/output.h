/// @file output.h
/// Where programs put their files.
///
/// SPDX-License-Identifier: MIT
#ifndef COMMON_OUTPUT_H
#define COMMON_OUTPUT_H

#include "draw/figure.h"

#include <stdbool.h>

enum { OUTPUT_PATH_SIZE = 1024 };

/// Make a folder, if it is not there already; the one it lies in must be. Prints to stderr what went wrong.
bool output_make_folder(const char *folder);

/// Put folder, name and ending together, such as "out/spring.png". Prints to stderr if the path is too long.
bool output_path(char path[OUTPUT_PATH_SIZE], const char *folder, const char *name, const char *ending);

/// Read the arguments of a program that has one option, --out FOLDER, and make the folder ("out" if none is
/// given). Returns the folder; after --help or a mistake NULL, with *exit_code set.
const char *output_folder_from_arguments(int count, char **arguments, const char *about, int *exit_code);

/// Write a figure as PNG and as SVG and print where. Prints to stderr what went wrong.
bool output_figure(const figure *drawn, const char *folder, const char *name);

#endif
