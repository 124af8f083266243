/// @file described.c
/// Lines of a description: a name, a space, a number.
///
/// SPDX-License-Identifier: MIT
#include "common/described.h"

#include <stdlib.h>
#include <string.h>

double described_number(const char *text, const char *name) {
    const size_t length = strlen(name);
    while (text && (strncmp(text, name, length) != 0 || text[length] != ' ')) {
        text = strchr(text, '\n');
        text = text ? text + 1 : NULL;
    }
    return text ? strtod(text + length, NULL) : 0;
}
