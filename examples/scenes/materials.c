/// @file materials.c
/// What colours mean: the built-in table, and tables from CSV files.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_MATERIALS = 65535 };

static const char *const column_names[] = {
    "colour", "name", "mass", "stiffness", "damping", "break_strain", "pinned", "probe",
};
enum { COLOUR, NAME, MASS, STIFFNESS, DAMPING, BREAK_STRAIN, PINNED, PROBE, COLUMNS };

bool scene_materials_builtin(scene_materials *out, scene_error *error) {
    const float m = SCENE_IRON_MASS;
    const float k = SCENE_IRON_STIFFNESS;
    const scene_material table[] = {
        {.red = 0x0a,
         .green = 0x0a,
         .blue = 0x0a,
         .name = "pinned iron",
         .mass = m,
         .stiffness = k,
         .pinned = true},
        {.red = 0x21, .green = 0x6c, .blue = 0xcf, .name = "iron probe", .mass = m, .stiffness = k, .probe = true},
        {.red = 0x80, .green = 0x80, .blue = 0x90, .name = "iron", .mass = m, .stiffness = k},
    };
    scene_material *items = malloc(sizeof table);
    if (!items)
        return scene_fail_memory(error, "cannot make the built-in materials");
    memcpy(items, table, sizeof table);
    out->items = items;
    out->count = sizeof table / sizeof *table;
    return true;
}

// A CSV text on its way: one record a line, no quoting.
typedef struct csv_reader {
    const char *at, *end;
    const char *name;
    unsigned long line;
    text_span fields[COLUMNS];
} csv_reader;

static text_span trim(text_span span) {
    while (span.length && (*span.start == ' ' || *span.start == '\t')) {
        span.start++;
        span.length--;
    }
    while (span.length && strchr(" \t\r", span.start[span.length - 1]) && span.start[span.length - 1])
        span.length--;
    return span;
}

static text_span next_line(csv_reader *csv) {
    text_span line = {.start = csv->at};
    const char *newline = memchr(csv->at, '\n', (size_t)(csv->end - csv->at));
    const char *stop = newline ? newline : csv->end;
    line.length = (size_t)(stop - csv->at);
    csv->at = newline ? newline + 1 : csv->end;
    csv->line++;
    return trim(line);
}

// Cuts a line into its fields.
static bool split(csv_reader *csv, text_span line, scene_error *error) {
    size_t count = 0;
    const char *end = line.start + line.length;
    for (const char *at = line.start;;) {
        const char *comma = memchr(at, ',', (size_t)(end - at));
        text_span field = {at, (size_t)((comma ? comma : end) - at)};
        if (count < COLUMNS)
            csv->fields[count] = trim(field);
        count++;
        if (!comma)
            break;
        at = comma + 1;
    }
    if (count != COLUMNS)
        return scene_fail(error,
                          "%.200s:%lu: column %zu: the line has %zu columns, not the %d of the header: "
                          "colour,name,mass,stiffness,damping,break_strain,pinned,probe",
                          csv->name, csv->line, count < COLUMNS ? count + 1 : (size_t)COLUMNS + 1, count, COLUMNS);
    return true;
}

static bool fail_field(const csv_reader *csv, int column, const char *what, scene_error *error) {
    char quoted[48];
    return scene_fail(error, "%.200s:%lu: column %d (%s): '%s' %s", csv->name, csv->line, column + 1,
                      column_names[column], text_quote(csv->fields[column], quoted, sizeof quoted), what);
}

static int hex_digit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

static bool read_colour(const csv_reader *csv, scene_material *material, scene_error *error) {
    text_span field = csv->fields[COLOUR];
    uint8_t *channels[3] = {&material->red, &material->green, &material->blue};
    bool valid = field.length == 7 && field.start[0] == '#';
    for (size_t i = 0; valid && i < 3; i++) {
        int high = hex_digit(field.start[1 + 2 * i]);
        int low = hex_digit(field.start[2 + 2 * i]);
        valid = high >= 0 && low >= 0;
        if (valid)
            *channels[i] = (uint8_t)(16 * high + low);
    }
    if (!valid)
        return fail_field(csv, COLOUR, "is no colour: write it as #RRGGBB", error);
    if (material->red == 255 && material->green == 255 && material->blue == 255)
        return fail_field(csv, COLOUR, "is white, which always means nothing: choose another colour", error);
    return true;
}

static bool read_name(const csv_reader *csv, scene_material *material, scene_error *error) {
    text_span field = csv->fields[NAME];
    if (field.length == 0 || field.length >= sizeof material->name)
        return fail_field(csv, NAME, "is no name: give 1 to 31 characters", error);
    text_quote(field, material->name, sizeof material->name);
    return true;
}

static bool read_value(const csv_reader *csv, int column, double least, double most, const char *what, float *value,
                       scene_error *error) {
    double number = 0;
    if (!number_parse(csv->fields[column], &number) || !(number >= least && number <= most))
        return fail_field(csv, column, what, error);
    *value = (float)number;
    return true;
}

static bool read_flag(const csv_reader *csv, int column, bool *value, scene_error *error) {
    uint64_t number = 0;
    if (!number_parse_count(csv->fields[column], &number) || number > 1)
        return fail_field(csv, column, "is neither 0 nor 1", error);
    *value = number == 1;
    return true;
}

static bool read_material(const csv_reader *csv, scene_material *material, scene_error *error) {
    return read_colour(csv, material, error) && read_name(csv, material, error) &&
           read_value(csv, MASS, 1e-30, 1e30, "is no mass: give kg, a number from 1e-30 to 1e30", &material->mass,
                      error) &&
           read_value(csv, STIFFNESS, 0, 1e30, "is no stiffness: give N/m, a number from 0 to 1e30",
                      &material->stiffness, error) &&
           read_value(csv, DAMPING, 0, 1e30, "is no damping: give N s/m, a number from 0 to 1e30",
                      &material->damping, error) &&
           read_value(csv, BREAK_STRAIN, 0, 1e30,
                      "is no break strain: give a number such as 0.02, or 0 for a material that never breaks",
                      &material->break_strain, error) &&
           read_flag(csv, PINNED, &material->pinned, error) && read_flag(csv, PROBE, &material->probe, error);
}

static bool read_header(csv_reader *csv, scene_error *error) {
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    if (csv->end - csv->at >= 3 && memcmp(csv->at, byte_order_mark, 3) == 0)
        csv->at += 3;
    if (!split(csv, next_line(csv), error))
        return false;
    for (int i = 0; i < COLUMNS; i++)
        if (csv->fields[i].length != strlen(column_names[i]) ||
            memcmp(csv->fields[i].start, column_names[i], csv->fields[i].length) != 0)
            return fail_field(csv, i,
                              "is not this column's name: the header must be "
                              "colour,name,mass,stiffness,damping,break_strain,pinned,probe",
                              error);
    return true;
}

static uint32_t colour_key(const scene_material *material) {
    return (uint32_t)material->red << 16 | (uint32_t)material->green << 8 | material->blue;
}

// The line that gives a colour its material.
typedef struct colour_line {
    uint32_t key;
    unsigned long line;
} colour_line;

static int compare_colour_lines(const void *a, const void *b) {
    const colour_line *first = a;
    const colour_line *second = b;
    if (first->key != second->key)
        return first->key < second->key ? -1 : 1;
    return first->line < second->line ? -1 : first->line > second->line;
}

static bool refuse_twins(const char *name, colour_line *lines, size_t count, scene_error *error) {
    qsort(lines, count, sizeof *lines, compare_colour_lines);
    for (size_t i = 1; i < count; i++)
        if (lines[i].key == lines[i - 1].key)
            return scene_fail(error, "%.200s:%lu: column 1 (colour): #%06X has a material already, on line %lu",
                              name, lines[i].line, lines[i].key, lines[i - 1].line);
    return true;
}

static bool read_materials(csv_reader *csv, scene_materials *out, colour_line *lines, size_t most,
                           scene_error *error) {
    out->count = 0;
    while (csv->at < csv->end) {
        text_span line = next_line(csv);
        if (line.length == 0)
            continue;
        if (out->count == most)
            return scene_fail(error, "%.200s:%lu: more than %zu materials: use fewer", csv->name, csv->line, most);
        scene_material *material = &out->items[out->count];
        memset(material, 0, sizeof *material);
        if (!split(csv, line, error) || !read_material(csv, material, error))
            return false;
        lines[out->count].key = colour_key(material);
        lines[out->count].line = csv->line;
        out->count++;
    }
    if (out->count == 0)
        return scene_fail(error, "%.200s: no material after the header: add a line for each colour", csv->name);
    return refuse_twins(csv->name, lines, out->count, error);
}

bool scene_materials_parse(const char *text, size_t length, const char *name, scene_materials *out,
                           scene_error *error) {
    csv_reader csv = {.at = text, .end = text + length, .name = name};
    if (!read_header(&csv, error))
        return false;
    // A line takes more than 16 bytes: the text's length bounds the table.
    size_t most = length / 16 + 1 < MOST_MATERIALS ? length / 16 + 1 : MOST_MATERIALS;
    scene_materials table = {.items = malloc(most * sizeof *table.items)};
    colour_line *lines = malloc(most * sizeof *lines);
    bool ok = table.items && lines ? read_materials(&csv, &table, lines, most, error)
                                   : scene_fail_memory(error, "cannot read the materials");
    free(lines);
    if (ok)
        *out = table;
    else
        scene_materials_free(&table);
    return ok;
}

bool scene_materials_read(const char *path, scene_materials *out, scene_error *error) {
    char *text = NULL;
    size_t length = 0;
    if (!file_read(path, &text, &length, error))
        return false;
    bool ok = scene_materials_parse(text, length, path, out, error);
    free(text);
    return ok;
}

void scene_materials_free(scene_materials *materials) {
    if (!materials)
        return;
    free(materials->items);
    materials->items = NULL;
    materials->count = 0;
}
