/// @file loose_json.c
/// JSON as people write it.
///
/// SPDX-License-Identifier: MIT
#include "loaders/loose_json.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 64 };

typedef struct json_reader {
    const char *at, *end;
    json_document *made;
    scene_error *error;
} json_reader;

bool json_fail(const json_document *document, const char *at, scene_error *error, const char *format, ...) {
    unsigned long line = 1;
    const char *start = document->start;
    for (const char *c = start; c < at; c++) {
        if (*c == '\n') {
            line++;
            start = c + 1;
        }
    }
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return scene_fail(error, "%.200s:%lu:%zu: %s", document->name, line, (size_t)(at - start) + 1, text);
}

static bool begins(const json_reader *reader, const char *text) {
    size_t length = strlen(text);
    return (size_t)(reader->end - reader->at) >= length && memcmp(reader->at, text, length) == 0;
}

// Go to the next character that means something, or to the end.
static bool skip_blanks(json_reader *reader) {
    while (reader->at < reader->end) {
        if ((unsigned char)*reader->at <= ' ' || *reader->at == ',') {
            reader->at++;
        } else if (begins(reader, "//")) {
            const char *newline = memchr(reader->at, '\n', (size_t)(reader->end - reader->at));
            reader->at = newline ? newline : reader->end;
        } else if (begins(reader, "/*")) {
            const char *opened = reader->at;
            reader->at += 2;
            while (reader->at < reader->end && !begins(reader, "*/"))
                reader->at++;
            if (reader->at == reader->end)
                return json_fail(reader->made, opened, reader->error, "this comment has no end");
            reader->at += 2;
        } else {
            return true;
        }
    }
    return true;
}

static bool add_value(json_reader *reader, uint32_t *index) {
    json_document *made = reader->made;
    if (made->count == made->capacity) {
        size_t capacity = made->capacity ? 2 * made->capacity : 256;
        json_value *values = capacity <= UINT32_MAX ? realloc(made->values, capacity * sizeof *values) : NULL;
        if (!values)
            return scene_fail_memory(reader->error, "cannot read the file");
        made->values = values;
        made->capacity = capacity;
    }
    memset(&made->values[made->count], 0, sizeof *made->values);
    *index = (uint32_t)made->count++;
    return true;
}

static bool read_string(json_reader *reader, text_span *text) {
    const char *opened = reader->at++;
    text->start = reader->at;
    while (reader->at < reader->end && *reader->at != '"' && *reader->at != '\n')
        reader->at += *reader->at == '\\' && reader->end - reader->at > 1 ? 2 : 1;
    if (reader->at >= reader->end || *reader->at != '"')
        return json_fail(reader->made, opened, reader->error, "this string has no end");
    text->length = (size_t)(reader->at - text->start);
    reader->at++;
    return true;
}

static bool is_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '+' ||
           c == '-' || c == '.';
}

// A number, true, false or null.
static bool read_word(json_reader *reader, json_value *value) {
    text_span word = {.start = reader->at};
    while (reader->at < reader->end && is_word(*reader->at))
        reader->at++;
    word.length = (size_t)(reader->at - word.start);
    value->text = word;
    if (json_is(word, "true"))
        value->kind = JSON_TRUE;
    else if (json_is(word, "false"))
        value->kind = JSON_FALSE;
    else if (json_is(word, "null"))
        value->kind = JSON_NULL;
    else if (number_parse(word, &value->number))
        value->kind = JSON_NUMBER;
    else {
        char quoted[48];
        text_span shown = {word.start, word.length ? word.length : 1};
        return json_fail(reader->made, word.start, reader->error, "'%s' is no value",
                         text_quote(shown, quoted, sizeof quoted));
    }
    return true;
}

static bool read_value(json_reader *reader, unsigned depth, uint32_t *index);

static bool read_key(json_reader *reader, text_span *key) {
    if (*reader->at != '"')
        return json_fail(reader->made, reader->at, reader->error, "a name in quotes belongs here");
    if (!read_string(reader, key) || !skip_blanks(reader))
        return false;
    if (reader->at == reader->end || *reader->at != ':')
        return json_fail(reader->made, reader->at, reader->error, "a colon belongs here");
    reader->at++;
    return true;
}

static bool read_members(json_reader *reader, unsigned depth, uint32_t parent) {
    const bool object = *reader->at == '{';
    const char close = object ? '}' : ']';
    const char *opened = reader->at++;
    uint32_t last = 0;
    for (;;) {
        text_span key = {NULL, 0};
        uint32_t index = 0;
        if (!skip_blanks(reader))
            return false;
        if (reader->at == reader->end)
            return json_fail(reader->made, opened, reader->error, "this '%c' is never closed", *opened);
        if (*reader->at == close)
            break;
        if ((object && !read_key(reader, &key)) || !skip_blanks(reader) || !read_value(reader, depth + 1, &index))
            return false;
        json_value *values = reader->made->values;
        values[index].key = key;
        values[parent].children++;
        if (last)
            values[last].next = index;
        else
            values[parent].child = index;
        last = index;
    }
    reader->at++;
    return true;
}

static bool read_value(json_reader *reader, unsigned depth, uint32_t *index) {
    if (reader->at == reader->end)
        return json_fail(reader->made, reader->at, reader->error, "the file ends where a value belongs");
    if (depth > DEEPEST)
        return json_fail(reader->made, reader->at, reader->error, "more than %d brackets inside each other",
                         DEEPEST);
    if (!add_value(reader, index))
        return false;
    json_value value = {.text = {reader->at, 0}};
    bool ok = true;
    switch (*reader->at) {
    case '{':
    case '[':
        value.kind = *reader->at == '{' ? JSON_OBJECT : JSON_ARRAY;
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): add_value has made it
        reader->made->values[*index] = value;
        return read_members(reader, depth, *index);
    case '"':
        value.kind = JSON_STRING;
        ok = read_string(reader, &value.text);
        break;
    default:
        ok = read_word(reader, &value);
    }
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): add_value has made it
    reader->made->values[*index] = value;
    return ok;
}

bool json_parse(const char *text, size_t length, const char *name, json_document *made, scene_error *error) {
    json_document document = {.name = name, .start = text};
    json_reader reader = {.at = text, .end = text + length, .made = &document, .error = error};
    uint32_t outermost = 0;
    if (begins(&reader, "\xef\xbb\xbf"))
        reader.at += 3;
    bool ok = skip_blanks(&reader);
    if (ok && (reader.at == reader.end || *reader.at != '{'))
        ok = json_fail(&document, reader.at, error, "the file must begin with a '{'");
    ok = ok && read_value(&reader, 0, &outermost) && skip_blanks(&reader);
    if (ok && reader.at < reader.end)
        ok = json_fail(&document, reader.at, error, "there is something behind the last '}'");
    if (ok)
        *made = document;
    else
        json_free(&document);
    return ok;
}

void json_free(json_document *unwanted) {
    free(unwanted->values);
    memset(unwanted, 0, sizeof *unwanted);
}

const json_value *json_first(const json_document *document, const json_value *parent) {
    return parent->child ? &document->values[parent->child] : NULL;
}

const json_value *json_next(const json_document *document, const json_value *value) {
    return value->next ? &document->values[value->next] : NULL;
}

const json_value *json_member(const json_document *document, const json_value *object, const char *key) {
    const json_value *found = NULL;
    if (object->kind == JSON_OBJECT)
        for (const json_value *member = json_first(document, object); member; member = json_next(document, member))
            if (json_is(member->key, key))
                found = member;
    return found;
}

bool json_is(text_span text, const char *wanted) {
    return text.length == strlen(wanted) && memcmp(text.start, wanted, text.length) == 0;
}
