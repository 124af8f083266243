/// @file obj.c
/// Vertices and lines of Wavefront OBJ files.
///
/// SPDX-License-Identifier: MIT
#include "loaders/lines.h"
#include "loaders/model.h"

#include <string.h>

static const line_style style = {.separators = "", .comments = "#"};

static bool read_vertex(const line_reader *reader, const structure_options *options, model *made,
                        scene_error *error) {
    model_node node = {.mass = options->mass};
    for (size_t i = 0; i < 3; i++)
        if (!line_number(reader, 1 + i, -MODEL_MAX_COORDINATE, MODEL_MAX_COORDINATE, "coordinate", &node.at[i],
                         error))
            return false;
    return model_add_node(made, &node, error);
}

// A vertex of a line: counted from 1, or back from the last one with a minus; after a slash, what lies on it.
static bool read_end(const line_reader *reader, size_t word, const model *made, uint32_t *node,
                     scene_error *error) {
    text_span text = reader->words[word];
    const char *slash = memchr(text.start, '/', text.length);
    if (slash)
        text.length = (size_t)(slash - text.start);
    bool back = text.length > 0 && *text.start == '-';
    if (back) {
        text.start++;
        text.length--;
    }
    uint64_t number = 0;
    if (!number_parse_count(text, &number) || number == 0 || number > made->node_count) {
        char quoted[48];
        return line_fail(reader, word, error, "there is no vertex '%s': %zu were given so far, counted from 1",
                         text_quote(reader->words[word], quoted, sizeof quoted), made->node_count);
    }
    *node = (uint32_t)(back ? made->node_count - number : number - 1);
    return true;
}

// A line is a polyline.
static bool read_line(const line_reader *reader, const structure_options *options, model *made,
                      scene_error *error) {
    if (!line_has(reader, 3, "l and two vertices or more", error))
        return false;
    if (reader->word_count == LINE_WORDS)
        return line_fail(reader, LINE_WORDS - 1, error, "a polyline of more than %d vertices: cut it into several",
                         LINE_WORDS - 2);
    model_beam beam = {.stiffness = options->stiffness, .damping = options->damping, .rest = 1};
    for (size_t i = 1; i < reader->word_count; i++) {
        beam.a = beam.b;
        if (!read_end(reader, i, made, &beam.b, error) || (i > 1 && !model_add_beam(made, &beam, error)))
            return false;
    }
    return true;
}

bool model_read_obj(const char *text, size_t length, const char *name, const structure_options *options,
                    model *made, scene_error *error) {
    line_reader reader = {.at = text, .end = text + length, .name = name, .style = &style};
    made->side = STRUCTURE_PLANE_XY;
    while (line_next(&reader)) {
        bool ok = true;
        if (word_is(reader.words[0], "v")) {
            ok = read_vertex(&reader, options, made, error);
            tally_add_text(&made->used, "v", 1);
        } else if (word_is(reader.words[0], "l")) {
            ok = read_line(&reader, options, made, error);
            tally_add_text(&made->used, "l", 1);
        } else {
            tally_add(&made->ignored, reader.words[0], 1);
        }
        if (!ok)
            return false;
    }
    return true;
}
