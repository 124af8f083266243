/// @file number.c
/// Numbers in text, read strictly.
///
/// strtod follows the locale of the process; the programs here never call setlocale(), so it is the "C" locale.
///
/// SPDX-License-Identifier: MIT
#include "scenes/number.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST_NUMBER = 63 };

bool number_parse(text_span text, double *value) {
    char copy[LONGEST_NUMBER + 1];
    if (text.length == 0 || text.length > LONGEST_NUMBER)
        return false;
    for (size_t i = 0; i < text.length; i++) {
        char c = text.start[i];
        if (c == 0 || !strchr("+-.0123456789eE", c))
            return false;
        copy[i] = c;
    }
    copy[text.length] = 0;
    char *end = NULL;
    double number = strtod(copy, &end);
    if (end != copy + text.length || !(fabs(number) <= DBL_MAX))
        return false;
    *value = number;
    return true;
}

bool number_parse_count(text_span text, uint64_t *value) {
    uint64_t number = 0;
    if (text.length == 0)
        return false;
    for (size_t i = 0; i < text.length; i++) {
        char c = text.start[i];
        if (c < '0' || c > '9')
            return false;
        unsigned digit = (unsigned)(c - '0');
        if (number > (UINT64_MAX - digit) / 10)
            return false;
        number = number * 10 + digit;
    }
    *value = number;
    return true;
}

const char *text_quote(text_span text, char *buffer, size_t size) {
    size_t length = text.length < size ? text.length : size - 1;
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)text.start[i];
        buffer[i] = c < ' ' || c >= 127 ? '?' : (char)c;
    }
    buffer[length] = 0;
    return buffer;
}
