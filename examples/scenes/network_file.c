/// @file network_file.c
/// Networks from plain text.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <stdlib.h>
#include <string.h>

enum { FIELDS = 5 };

typedef struct line_reader {
    const char *at, *end;
    const char *name;
    unsigned long line;
    text_span fields[FIELDS];
    size_t field_count; // counted on beyond FIELDS
    bool relative;      // stiffness and damping are fractions
} line_reader;

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

static void split(line_reader *reader, const char *stop) {
    const char *at = reader->at;
    reader->field_count = 0;
    for (;;) {
        while (at < stop && is_blank(*at))
            at++;
        if (at == stop || *at == '#')
            return;
        text_span field = {.start = at};
        while (at < stop && !is_blank(*at) && *at != '#')
            at++;
        field.length = (size_t)(at - field.start);
        if (reader->field_count < FIELDS)
            reader->fields[reader->field_count] = field;
        reader->field_count++;
    }
}

// The next line that is not empty. Returns false at the end.
static bool next_record(line_reader *reader) {
    while (reader->at < reader->end) {
        const char *newline = memchr(reader->at, '\n', (size_t)(reader->end - reader->at));
        const char *stop = newline ? newline : reader->end;
        split(reader, stop);
        reader->at = newline ? newline + 1 : reader->end;
        reader->line++;
        if (reader->field_count)
            return true;
    }
    return false;
}

static bool fail_field(const line_reader *reader, size_t field, const char *what, scene_error *error) {
    char quoted[48];
    return scene_fail(error, "%.200s:%lu: '%s' is no %s", reader->name, reader->line,
                      text_quote(reader->fields[field], quoted, sizeof quoted), what);
}

static bool read_value(const line_reader *reader, size_t field, double least, double most, const char *what,
                       double *value, scene_error *error) {
    double number = 0;
    if (!number_parse(reader->fields[field], &number) || !(number >= least && number <= most))
        return fail_field(reader, field, what, error);
    *value = number;
    return true;
}

static bool read_flag(const line_reader *reader, size_t field, const char *what, bool *value, scene_error *error) {
    uint64_t number = 0;
    if (!number_parse_count(reader->fields[field], &number) || number > 1)
        return fail_field(reader, field, what, error);
    *value = number == 1;
    return true;
}

static bool read_end(const line_reader *reader, size_t field, uint32_t particles, mspring_id *id,
                     scene_error *error) {
    uint64_t number = 0;
    if (!number_parse_count(reader->fields[field], &number))
        return fail_field(reader, field, "particle: give its number, counted from 0", error);
    if (number >= particles)
        return scene_fail(error, "%.200s:%lu: there is no particle %llu: they are numbered 0 to %u", reader->name,
                          reader->line, (unsigned long long)number, particles - 1);
    *id = (mspring_id)number;
    return true;
}

// The next record, which must have five fields.
static bool read_record(line_reader *reader, const char *what, uint32_t index, uint32_t count, const char *columns,
                        scene_error *error) {
    if (!next_record(reader))
        return scene_fail(error,
                          "%.200s:%lu: the file ends after %u of %u %s: it is cut off, or the counts in its "
                          "first line are wrong",
                          reader->name, reader->line, index, count, what);
    if (reader->field_count != FIELDS)
        return scene_fail(error, "%.200s:%lu: %zu numbers where %d belong (%s %u): %s", reader->name, reader->line,
                          reader->field_count, FIELDS, what, index, columns);
    return true;
}

static bool is_word(text_span field, const char *word) {
    return field.length == strlen(word) && memcmp(field.start, word, field.length) == 0;
}

static bool read_counts(line_reader *reader, uint32_t *particles, uint32_t *springs, scene_error *error) {
    uint64_t p = 0;
    uint64_t s = 0;
    if (!next_record(reader))
        return scene_fail(error,
                          "%.200s: nothing in it: the first line must be the numbers of particles and springs",
                          reader->name);
    reader->relative = reader->field_count == 3 && is_word(reader->fields[2], "relative");
    if (reader->field_count != (reader->relative ? 3 : 2) || !number_parse_count(reader->fields[0], &p) ||
        !number_parse_count(reader->fields[1], &s))
        return scene_fail(error,
                          "%.200s:%lu: the first line must be two whole numbers, of particles and of springs, and "
                          "'relative' behind them if stiffness and damping are fractions",
                          reader->name, reader->line);
    if (p == 0)
        return scene_fail(error, "%.200s:%lu: no particle: a network needs at least one", reader->name,
                          reader->line);
    if (p > MSPRING_MAX_PARTICLES || s > MSPRING_MAX_SPRINGS)
        return scene_fail(error, "%.200s:%lu: %llu particles and %llu springs: at most %u and %u are possible",
                          reader->name, reader->line, (unsigned long long)p, (unsigned long long)s,
                          MSPRING_MAX_PARTICLES, MSPRING_MAX_SPRINGS);
    *particles = (uint32_t)p;
    *springs = (uint32_t)s;
    return true;
}

static bool read_particle(line_reader *reader, mspring_particle_def *def, bool *probe, scene_error *error) {
    double mass = 0;
    bool pinned = false;
    if (!read_value(reader, 0, -MSPRING_MAX_COORDINATE, MSPRING_MAX_COORDINATE,
                    "x coordinate: give m, a number from -1e12 to 1e12", &def->x, error) ||
        !read_value(reader, 1, -MSPRING_MAX_COORDINATE, MSPRING_MAX_COORDINATE,
                    "y coordinate: give m, a number from -1e12 to 1e12", &def->y, error) ||
        !read_value(reader, 2, 1e-30, 1e30, "mass: give kg, a number from 1e-30 to 1e30", &mass, error) ||
        !read_flag(reader, 3, "pinned flag: give 0 or 1", &pinned, error) ||
        !read_flag(reader, 4, "probe flag: give 0 or 1", probe, error))
        return false;
    def->mass = (float)mass;
    def->flags = pinned ? MSPRING_PARTICLE_PINNED : 0;
    return true;
}

static bool read_particles(line_reader *reader, uint32_t count, scene *out, scene_error *error) {
    unsigned long probe_line = 0;
    for (uint32_t i = 0; i < count; i++) {
        mspring_particle_def def = mspring_particle_def_default();
        bool probe = false;
        if (!read_record(reader, "particles", i, count, "x y mass pinned probe", error) ||
            !read_particle(reader, &def, &probe, error))
            return false;
        if (probe && probe_line)
            return scene_fail(error, "%.200s:%lu: a second probe, the first is on line %lu: leave one",
                              reader->name, reader->line, probe_line);
        mspring_result result = mspring_builder_add_particles(out->builder, &def, 1, NULL);
        if (result != MSPRING_OK)
            return scene_fail_builder(error, "cannot add a particle of the file", out->builder, result);
        if (probe) {
            probe_line = reader->line;
            out->probe = i;
        }
    }
    return true;
}

static bool read_spring(line_reader *reader, uint32_t particles, const scene_options *options,
                        mspring_spring_def *def, scene_error *error) {
    double rest = 0;
    double stiffness = 0;
    double damping = 0;
    if (!read_end(reader, 0, particles, &def->a, error) || !read_end(reader, 1, particles, &def->b, error))
        return false;
    if (def->a == def->b)
        return scene_fail(error, "%.200s:%lu: a spring from particle %u to itself: give two different particles",
                          reader->name, reader->line, def->a);
    if (!read_value(reader, 2, 1e-30, 1e12, "rest length: give m, a number from 1e-30 to 1e12", &rest, error) ||
        !read_value(reader, 3, 0, 1e30, "stiffness: give N/m, a number from 0 to 1e30", &stiffness, error) ||
        !read_value(reader, 4, 0, 1e30, "damping: give N s/m, a number from 0 to 1e30", &damping, error))
        return false;
    def->rest_length = (float)rest;
    def->stiffness = options->stiffness >= 0 ? options->stiffness : (float)stiffness;
    const bool is_other = options->relative && !reader->relative; // N s/m are no fraction
    def->damping = options->damping >= 0 ? options->damping : is_other ? 0 : (float)damping;
    def->flags = options->relative || reader->relative ? MSPRING_SPRING_RELATIVE : 0;
    return true;
}

static bool read_springs(line_reader *reader, uint32_t count, uint32_t particles, const scene_options *options,
                         pair_set *joined, scene *out, scene_error *error) {
    for (uint32_t i = 0; i < count; i++) {
        mspring_spring_def def = mspring_spring_def_default();
        uint64_t first_line = 0;
        if (!read_record(reader, "springs", i, count, "a b rest stiffness damping", error) ||
            !read_spring(reader, particles, options, &def, error))
            return false;
        switch (pair_set_add(joined, def.a, def.b, reader->line, &first_line)) {
        case PAIR_NEW:
            break;
        case PAIR_PRESENT:
            return scene_fail(error,
                              "%.200s:%lu: particles %u and %u have a spring already, on line %llu: leave one",
                              reader->name, reader->line, def.a, def.b, (unsigned long long)first_line);
        case PAIR_NO_MEMORY:
            return scene_fail_memory(error, "cannot read the springs");
        }
        mspring_result result = mspring_builder_add_springs(out->builder, &def, 1, NULL);
        if (result != MSPRING_OK)
            return scene_fail_builder(error, "cannot add a spring of the file", out->builder, result);
    }
    return true;
}

static bool read_network(line_reader *reader, const scene_options *options, scene *out, scene_error *error) {
    uint32_t particles = 0;
    uint32_t springs = 0;
    if (!read_counts(reader, &particles, &springs, error))
        return false;
    if (options->relative && !reader->relative && options->stiffness < 0)
        return scene_fail(error,
                          "%.200s: relative springs need a stiffness: this file holds N/m, not fractions; give a "
                          "fraction such as 0.5",
                          reader->name);
    if (!read_particles(reader, particles, out, error))
        return false;
    pair_set joined = {0};
    bool ok = read_springs(reader, springs, particles, options, &joined, out, error);
    pair_set_free(&joined);
    if (ok && next_record(reader))
        return scene_fail(error,
                          "%.200s:%lu: more lines than the %u particles and %u springs that the first line "
                          "announces",
                          reader->name, reader->line, particles, springs);
    return ok;
}

bool scene_network_parse(const char *text, size_t length, const char *name, const scene_options *options,
                         scene *out, scene_error *error) {
    line_reader reader = {.at = text, .end = text + length, .name = name};
    if (!scene_options_check(options, true, error) || !scene_start(out, error))
        return false;
    scene_name_from_path(out, name);
    if (read_network(&reader, options, out, error))
        return true;
    scene_free(out);
    return false;
}

bool scene_network_file(const char *path, const scene_options *options, scene *out, scene_error *error) {
    char *text = NULL;
    size_t length = 0;
    if (!file_read(path, &text, &length, error))
        return false;
    const bool ok = !scene_file_is_other(path, text, length, error) &&
                    scene_network_parse(text, length, path, options, out, error);
    free(text);
    return ok;
}
