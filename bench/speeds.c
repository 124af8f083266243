/// @file speeds.c
/// Reading the bench's CSV strictly: columns are found by their names.
///
/// SPDX-License-Identifier: MIT
#include "speeds.h"

#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

#include "loaders/lines.h"

static const line_style csv = {.separators = ",", .comments = ""};

static const char *const names[] = {
    "scene", "springs", "solver", "level", "threads", "ns_per_spring_substep_median", "baseline_ratio_median",
};
enum { SCENE, SPRINGS, SOLVER, LEVEL, THREADS, NS, RATIO, NAMES };

/// Where each column is, and how many there are.
typedef struct header {
    size_t places[NAMES];
    size_t count;
} header;

static bool read_header(const line_reader *reader, header *out, scene_error *error) {
    out->count = reader->word_count;
    for (size_t n = 0; n < NAMES; n++) {
        size_t place = 0;
        while (place < out->count && !word_is(reader->words[place], names[n])) {
            place++;
        }
        if (place == out->count) {
            return line_fail(reader, 0, error,
                             "no column %s: this line must be the header of massspring-bench --csv", names[n]);
        }
        out->places[n] = place;
    }
    return true;
}

static bool read_level(const line_reader *reader, size_t place, mspring_simd *out, scene_error *error) {
    for (mspring_simd level = MSPRING_SIMD_SCALAR; level <= MSPRING_SIMD_WASM; level++) {
        if (word_is(reader->words[place], mspring_simd_name(level))) {
            *out = level;
            return true;
        }
    }
    char quoted[48];
    return line_fail(reader, place, error, "'%s' is no level",
                     text_quote(reader->words[place], quoted, sizeof quoted));
}

static bool read_row(const line_reader *reader, const header *head, speed *out, scene_error *error) {
    const size_t *at = head->places;
    if (reader->word_count != head->count) {
        return line_fail(reader, reader->word_count, error, "the line has %zu columns, not the %zu of the header",
                         reader->word_count, head->count);
    }
    char quoted[48];
    // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.ArraySubscript): a header without it was refused
    if (!word_is(reader->words[at[SOLVER]], "explicit")) {
        return line_fail(reader, at[SOLVER], error, "'%s': only steps of the explicit solver are drawn",
                         text_quote(reader->words[at[SOLVER]], quoted, sizeof quoted));
    }
    double workers = 0;
    double ratio = 0;
    text_quote(reader->words[at[SCENE]], out->scene, sizeof out->scene);
    out->line = reader->line;
    if (!line_number(reader, at[SPRINGS], 1, 1e10, "number of springs", &out->springs, error) ||
        !read_level(reader, at[LEVEL], &out->level, error) ||
        !line_number(reader, at[THREADS], 1, MSPRING_MAX_WORKERS, "number of workers", &workers, error) ||
        !line_number(reader, at[NS], 1e-6, 1e9, "time in nanoseconds", &out->ns, error) ||
        !line_number(reader, at[RATIO], 1e-6, 1e9, "ratio of times", &ratio, error)) {
        return false;
    }
    out->workers = (uint32_t)workers;
    if (out->workers != workers) {
        return line_fail(reader, at[THREADS], error, "a number of workers is whole");
    }
    out->naive_ns = out->ns * ratio;
    return true;
}

/// Refuse to have two times for the same.
static bool refuse_twin(const line_reader *reader, const speeds *all, const speed *added, scene_error *error) {
    for (size_t i = 0; i < all->count; i++) {
        const speed *row = &all->rows[i];
        if (row->level == added->level && row->workers == added->workers && strcmp(row->scene, added->scene) == 0) {
            return line_fail(reader, 0, error, "%s, level %s, threads %u, is on line %lu already", added->scene,
                             mspring_simd_name(added->level), added->workers, row->line);
        }
    }
    return true;
}

static bool read_rows(line_reader *reader, speeds *out, scene_error *error) {
    header head;
    out->count = 0;
    if (!line_next(reader)) {
        return scene_fail(error, "%.200s: nothing in it: write it with massspring-bench --csv", reader->name);
    }
    if (!read_header(reader, &head, error)) {
        return false;
    }
    while (line_next(reader)) {
        if (word_is(reader->words[0], names[SCENE])) {
            if (!read_header(reader, &head, error)) {
                return false;
            }
            continue;
        }
        if (out->count == SPEEDS_MOST) {
            return line_fail(reader, 0, error, "more than %d lines", SPEEDS_MOST);
        }
        speed *row = &out->rows[out->count];
        if (!read_row(reader, &head, row, error) || !refuse_twin(reader, out, row, error)) {
            return false;
        }
        out->count++;
    }
    return out->count > 0 ||
           scene_fail(error, "%.200s: no line after the header: was a scene measured?", reader->name);
}

bool speeds_read(const char *path, speeds *out, scene_error *error) {
    char *text = NULL;
    size_t size = 0;
    if (!file_read(path, &text, &size, error)) {
        return false;
    }
    line_reader reader = {.at = text, .end = text + size, .name = path, .style = &csv};
    bool ok = read_rows(&reader, out, error);
    free(text);
    return ok;
}
