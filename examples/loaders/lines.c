/// @file lines.c
/// Text read line by line, in words.
///
/// SPDX-License-Identifier: MIT
#include "loaders/lines.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool is_in(const char *set, char c) {
    return c != 0 && strchr(set, c) != NULL;
}

static bool separates(const line_reader *reader, char c) {
    return (unsigned char)c <= ' ' || is_in(reader->style->separators, c);
}

static bool begins_comment(const line_reader *reader, const char *at, const char *stop, bool at_word) {
    return is_in(reader->style->comments, *at) ||
           (reader->style->slashes && at_word && at[0] == '/' && stop - at > 1 && at[1] == '/');
}

static void split(line_reader *reader, const char *stop) {
    const char *at = reader->at;
    reader->start = at;
    reader->word_count = 0;
    for (;;) {
        while (at < stop && separates(reader, *at))
            at++;
        if (at == stop || begins_comment(reader, at, stop, true))
            return;
        text_span word = {.start = at};
        while (at < stop && !separates(reader, *at) && !begins_comment(reader, at, stop, false))
            at++;
        word.length = (size_t)(at - word.start);
        if (reader->word_count < LINE_WORDS)
            reader->words[reader->word_count++] = word;
    }
}

bool line_next(line_reader *reader) {
    while (reader->at < reader->end) {
        const char *newline = memchr(reader->at, '\n', (size_t)(reader->end - reader->at));
        split(reader, newline ? newline : reader->end);
        reader->at = newline ? newline + 1 : reader->end;
        reader->line++;
        if (reader->word_count)
            return true;
    }
    return false;
}

bool line_fail(const line_reader *reader, size_t word, scene_error *error, const char *format, ...) {
    size_t column = 1;
    if (word < reader->word_count)
        column = (size_t)(reader->words[word].start - reader->start) + 1;
    else if (reader->word_count)
        column = (size_t)(reader->words[reader->word_count - 1].start - reader->start) +
                 reader->words[reader->word_count - 1].length + 1;
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return scene_fail(error, "%.200s:%lu:%zu: %s", reader->name, reader->line, column, text);
}

bool line_number(const line_reader *reader, size_t word, double least, double most, const char *what, double *value,
                 scene_error *error) {
    double number = 0;
    char quoted[48];
    if (word >= reader->word_count)
        return line_fail(reader, word, error, "the line ends before its %s", what);
    if (!number_parse(reader->words[word], &number) || !(number >= least && number <= most))
        return line_fail(reader, word, error, "'%s' is no %s: give a number from %g to %g",
                         text_quote(reader->words[word], quoted, sizeof quoted), what, least, most);
    *value = number;
    return true;
}

bool line_has(const line_reader *reader, size_t least, const char *columns, scene_error *error) {
    if (reader->word_count >= least)
        return true;
    return line_fail(reader, reader->word_count, error, "the line ends after %zu of %zu: %s", reader->word_count,
                     least, columns);
}

bool word_is(text_span word, const char *text) {
    for (size_t i = 0; i < word.length; i++)
        if (!text[i] || tolower((unsigned char)word.start[i]) != text[i])
            return false;
    return text[word.length] == 0;
}
