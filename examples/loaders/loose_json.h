/// @file loose_json.h
/// JSON as people write it: comments, commas that are missing or too many.
///
/// SPDX-License-Identifier: MIT
#ifndef LOADERS_LOOSE_JSON_H
#define LOADERS_LOOSE_JSON_H

#include "scenes/internal.h"

typedef enum json_kind {
    JSON_NULL,
    JSON_FALSE,
    JSON_TRUE,
    JSON_NUMBER,
    JSON_STRING,
    JSON_ARRAY,
    JSON_OBJECT
} json_kind;

/// A value. Texts point into the text that was read; escapes in strings are left as they are.
typedef struct json_value {
    json_kind kind;
    text_span text;    ///< of a string without its quotes, of others as written
    text_span key;     ///< in an object
    double number;     ///< of a number
    uint32_t next;     ///< the next in the same array or object, 0: none
    uint32_t child;    ///< the first in it, 0: none
    uint32_t children; ///< how many are in it
} json_value;

/// All values of a text; the first is the outermost.
typedef struct json_document {
    const char *name, *start; ///< of the text
    json_value *values;
    size_t count, capacity;
} json_document;

/// Read an object. Commas count as blanks.
bool json_parse(const char *text, size_t length, const char *name, json_document *made, scene_error *error);
void json_free(json_document *unwanted);

const json_value *json_first(const json_document *document, const json_value *parent);
const json_value *json_next(const json_document *document, const json_value *value);
/// The last member of an object that has this key, or NULL.
const json_value *json_member(const json_document *document, const json_value *object, const char *key);
bool json_is(text_span text, const char *wanted);

/// Write a message that begins with name, line and column of a place in the text. Always returns false.
bool json_fail(const json_document *document, const char *at, scene_error *error, const char *format, ...)
    SCENES_PRINTF(4, 5);

#endif
