/// @file script.c
/// Lines of scripts, read strictly.
///
/// SPDX-License-Identifier: MIT
#include "lab/script.h"
#include "lab/model.h"
#include "scenes/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LINES = 1 << 17 };

static const double most_seconds = 86400;

static bool fail_at(const lab_script *script, uint32_t line, size_t column, const char *what, scene_error *error) {
    return scene_fail(error, "%.150s:%u:%zu: %s", script->name, line, column, what);
}

static bool is_space(char c) {
    return c == ' ' || c == '\t';
}

static bool add_line(lab_script *script, size_t *capacity, const script_line *line, scene_error *error) {
    if (script->count == *capacity) {
        const size_t larger = *capacity ? 2 * *capacity : 64;
        script_line *lines = larger <= MOST_LINES ? realloc(script->lines, larger * sizeof *lines) : NULL;
        if (!lines)
            return scene_fail(error, "%.150s:%u:1: too long a script", script->name, line->line);
        script->lines = lines;
        *capacity = larger;
    }
    script->lines[script->count++] = *line;
    return true;
}

// Reads a line that is neither empty nor a comment.
static bool read_line(const lab_script *script, uint32_t number, const char *line, size_t length, size_t start,
                      script_line *out, scene_error *error) {
    size_t end = start;
    while (end < length && !is_space(line[end]))
        end++;
    double seconds;
    char quoted[40], message[320];
    const text_span word = {line + start, end - start};
    if (!number_parse(word, &seconds) || seconds < 0 || seconds > most_seconds) {
        snprintf(message, sizeof message, "expected a time from 0 to %g s, not \"%s\"", most_seconds,
                 text_quote(word, quoted, sizeof quoted));
        return fail_at(script, number, start + 1, message, error);
    }
    out->frame = (uint64_t)floor(seconds * FRAMES_PER_SECOND + 0.5);
    out->line = number;
    if (script->count > 0 && out->frame < script->lines[script->count - 1].frame)
        return fail_at(script, number, start + 1, "the time is before that of the line above", error);
    action_error wrong = {0, ""};
    if (!action_read(line + end, length - end, end + 1, &out->action, &wrong))
        return fail_at(script, number, wrong.column, wrong.text, error);
    return true;
}

bool script_parse(const char *text, size_t length, const char *name, lab_script *out, scene_error *error) {
    lab_script made = {.lines = NULL};
    size_t capacity = 0, at = 0;
    bool ok = true;
    snprintf(made.name, sizeof made.name, "%s", name);
    for (uint32_t number = 1; ok && at < length; number++) {
        const char *line = text + at;
        const char *newline = memchr(line, '\n', length - at);
        size_t size = newline ? (size_t)(newline - line) : length - at;
        at += size + 1;
        size -= size > 0 && line[size - 1] == '\r';
        size_t start = 0;
        while (start < size && is_space(line[start]))
            start++;
        if (start == size || line[start] == '#')
            continue;
        script_line read = {.line = number};
        ok = read_line(&made, number, line, size, start, &read, error) && add_line(&made, &capacity, &read, error);
    }
    if (!ok) {
        script_free(&made);
        return false;
    }
    *out = made;
    return true;
}

bool script_read(const char *path, lab_script *out, scene_error *error) {
    char *bytes = NULL;
    size_t length = 0;
    if (!file_read(path, &bytes, &length, error))
        return false;
    const bool ok = script_parse(bytes, length, path, out, error);
    free(bytes);
    return ok;
}

void script_free(lab_script *unwanted) {
    free(unwanted->lines);
    memset(unwanted, 0, sizeof *unwanted);
}

bool script_record(FILE *stream, uint64_t frame, const lab_action *action) {
    char line[ACTION_LINE];
    return fprintf(stream, "%.6f %s\n", (double)frame / FRAMES_PER_SECOND, action_write(action, line)) > 0;
}
