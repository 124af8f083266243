/// @file number.h
/// Numbers in text, read strictly.
///
/// SPDX-License-Identifier: MIT
#ifndef SCENES_NUMBER_H
#define SCENES_NUMBER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// A piece of text that is not terminated by a 0.
typedef struct text_span {
    const char *start;
    size_t length;
} text_span;

/// Read a decimal number such as -1.5e3: no hexadecimal, no inf, no nan, nothing before or after it, and small
/// enough for a double. Returns false otherwise.
bool number_parse(text_span text, double *value);
/// Read a whole number without sign.
bool number_parse_count(text_span text, uint64_t *value);
/// Copy text into a message: cut to size - 1 characters, what cannot be printed as '?'. Returns buffer.
const char *text_quote(text_span text, char *buffer, size_t size);

#endif
