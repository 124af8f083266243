/// @file lines.h
/// Text read line by line, in words.
///
/// SPDX-License-Identifier: MIT
#ifndef LOADERS_LINES_H
#define LOADERS_LINES_H

#include "scenes/internal.h"

enum { LINE_WORDS = 32 };

/// What separates words, and where comments begin.
typedef struct line_style {
    const char *separators; ///< characters beside control characters and spaces
    const char *comments;   ///< characters that begin a comment anywhere in a line
    bool slashes;           ///< so do two slashes at the beginning of a word
} line_style;

typedef struct line_reader {
    const char *at, *end;
    const char *name; ///< of the file, for messages
    const line_style *style;
    const char *start; ///< of the line
    unsigned long line;
    text_span words[LINE_WORDS]; ///< further words of a line are not kept
    size_t word_count;
} line_reader;

/// Go to the next line that has a word. Returns false at the end.
bool line_next(line_reader *reader);

/// Write a message that begins with file, line and column of a word; of one that is missing, the end of the last.
/// Always returns false.
bool line_fail(const line_reader *reader, size_t word, scene_error *error, const char *format, ...)
    SCENES_PRINTF(4, 5);

/// Read a word as a number from least to most. what says what it is, such as "x coordinate, m".
bool line_number(const line_reader *reader, size_t word, double least, double most, const char *what, double *value,
                 scene_error *error);

/// Refuse a line of fewer words; columns says which belong there.
bool line_has(const line_reader *reader, size_t least, const char *columns, scene_error *error);

/// Whether a word is this text, in any case.
bool word_is(text_span word, const char *text);

#endif
