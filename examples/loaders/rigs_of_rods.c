/// @file rigs_of_rods.c
/// Vehicles of Rigs of Rods: sections of lines, words separated by commas, colons, bars and blanks.
///
/// SPDX-License-Identifier: MIT
#include "loaders/rigs_of_rods.h"

#include <stdlib.h>
#include <string.h>

static const line_style style = {.separators = ",:|", .comments = ";", .slashes = true};

// What Rigs of Rods takes where a file says nothing: N/m, N s/m, N, kg.
static const double default_stiffness = 9e6;
static const double default_damping = 12000;
static const double default_deform = 4e5;
static const double default_strength = 1e6;
static const double default_minimum_mass = 50;
// What a shock breaks at, over the strength that beams have: Rigs of Rods multiplies by that.
static const double strength_of_shocks = 4;
static const double camera_mass = 20;
static const double camera_stiffness = 8000;
static const double camera_damping = 800;

// Sections whose lines are springs: the columns of stiffness, damping and tension, 0 where there are none.
typedef struct spring_section {
    const char *name;
    size_t least, stiffness, damping, tension;
    const char *columns;
    bool has_options; // letters in the third column
} spring_section;

static const spring_section spring_sections[] = {
    {"beams", 2, 0, 0, 0, "two nodes", true},
    {"hydros", 3, 0, 0, 0, "two nodes and a factor", false},
    {"animators", 3, 0, 0, 0, "two nodes and a ratio", false},
    {"commands", 6, 0, 0, 0, "two nodes, rate, shortest, longest, key", false},
    {"commands2", 7, 0, 0, 0, "two nodes, two rates, shortest, longest, key", false},
    {"ropes", 2, 0, 0, 0, "two nodes", false},
    {"shocks", 7, 2, 3, 6, "two nodes, spring, damping, two bounds, tension", false},
    {"shocks2", 13, 2, 3, 12, "two nodes, eight values, two bounds, tension", false},
    {"shocks3", 15, 2, 3, 14, "two nodes, ten values, two bounds, tension", false},
};
enum { SPRING_SECTIONS = sizeof spring_sections / sizeof *spring_sections };

// Lines that stand by themselves and may come anywhere, with their values behind them.
static const char *const directives[] = {
    "add_animation",
    "antilockbrakes",
    "author",
    "cruisecontrol",
    "detacher_group",
    "extcamera",
    "fileformatversion",
    "fileinfo",
    "flexbody_camera_mode",
    "forset",
    "guid",
    "prop_camera_mode",
    "sectionconfig",
    "speedlimiter",
    "submesh_groundmodel",
    "tractioncontrol",
};

typedef enum section_kind {
    SECTION_NONE,
    SECTION_IGNORED,
    SECTION_GLOBALS,
    SECTION_MINIMUM_MASS,
    SECTION_NODES,
    SECTION_FIXES,
    SECTION_CAMERA,
    SECTION_SPRINGS,
    SECTION_WHEELS
} section_kind;

typedef struct section {
    section_kind kind;
    char name[32];
    const spring_section *springs;
} section;

bool ror_node(const ror_file *file, size_t word, uint32_t *node, scene_error *error) {
    char quoted[48];
    if (word >= file->reader.word_count)
        return line_fail(&file->reader, word, error, "the line ends before the node that belongs here");
    const name_entry *found = name_find(&file->names, file->reader.words[word]);
    if (!found)
        return line_fail(&file->reader, word, error, "there is no node '%s' so far",
                         text_quote(file->reader.words[word], quoted, sizeof quoted));
    *node = found->node;
    return true;
}

// The section that a line begins, if it begins one that is read.
static bool find_section(text_span word, section *found) {
    static const struct {
        const char *name;
        section_kind kind;
    } others[] = {
        {"globals", SECTION_GLOBALS}, {"minimass", SECTION_MINIMUM_MASS}, {"nodes", SECTION_NODES},
        {"nodes2", SECTION_NODES},    {"fixes", SECTION_FIXES},           {"cinecam", SECTION_CAMERA},
    };
    for (size_t i = 0; i < SPRING_SECTIONS; i++) {
        if (word_is(word, spring_sections[i].name)) {
            found->kind = SECTION_SPRINGS;
            found->springs = &spring_sections[i];
            memcpy(found->name, spring_sections[i].name, strlen(spring_sections[i].name) + 1);
            return true;
        }
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (word_is(word, others[i].name)) {
            found->kind = others[i].kind;
            memcpy(found->name, others[i].name, strlen(others[i].name) + 1);
            return true;
        }
    }
    char name[sizeof found->name];
    text_quote(word, name, sizeof name);
    for (char *c = name; *c; c++)
        if (*c >= 'A' && *c <= 'Z')
            *c += 'a' - 'A';
    if (!ror_is_wheel_section(name))
        return false;
    found->kind = SECTION_WHEELS;
    memcpy(found->name, name, sizeof name);
    return true;
}

static bool is_directive(text_span word) {
    if (word.length > 4 && memcmp(word.start, "set_", 4) == 0)
        return true;
    for (size_t i = 0; i < sizeof directives / sizeof *directives; i++)
        if (word_is(word, directives[i]))
            return true;
    return false;
}

// A value of set_beam_defaults and the like: what is missing or negative keeps what it is.
static bool read_setting(const ror_file *file, size_t word, const char *what, double *value, scene_error *error) {
    double given = 0;
    if (word >= file->reader.word_count)
        return true;
    if (!line_number(&file->reader, word, -MODEL_MAX_VALUE, MODEL_MAX_VALUE, what, &given, error))
        return false;
    if (given >= 0)
        *value = given;
    return true;
}

static bool has_letter(text_span word, char letter) {
    return memchr(word.start, letter, word.length) != NULL;
}

static bool read_node_defaults(ror_file *file, scene_error *error) {
    ror_load load = {.weight = -1};
    if (!read_setting(file, 1, "load weight, kg", &load.weight, error))
        return false;
    load.loaded = file->reader.word_count > 5 && has_letter(file->reader.words[5], 'l');
    file->node_default = load;
    return true;
}

static bool read_directive(ror_file *file, scene_error *error) {
    const text_span word = file->reader.words[0];
    if (word_is(word, "set_beam_defaults")) {
        file->stiffness = default_stiffness;
        file->damping = default_damping;
        file->deform = default_deform;
        file->strength = default_strength;
        tally_add(&file->made->used, word, 1);
        return read_setting(file, 1, "spring, N/m", &file->stiffness, error) &&
               read_setting(file, 2, "damping, N s/m", &file->damping, error) &&
               read_setting(file, 3, "deform, N", &file->deform, error) &&
               read_setting(file, 4, "strength, N", &file->strength, error);
    }
    if (word_is(word, "set_beam_defaults_scale")) {
        file->stiffness_scale = file->damping_scale = file->deform_scale = file->strength_scale = 1;
        tally_add(&file->made->used, word, 1);
        return read_setting(file, 1, "factor", &file->stiffness_scale, error) &&
               read_setting(file, 2, "factor", &file->damping_scale, error) &&
               read_setting(file, 3, "factor", &file->deform_scale, error) &&
               read_setting(file, 4, "factor", &file->strength_scale, error);
    }
    if (word_is(word, "set_node_defaults")) {
        tally_add(&file->made->used, word, 1);
        return read_node_defaults(file, error);
    }
    if (word_is(word, "set_default_minimass")) {
        tally_add(&file->made->used, word, 1);
        return read_setting(file, 1, "least mass, kg", &file->minimum_mass, error);
    }
    tally_add(&file->made->ignored, word, 1);
    return true;
}

static bool read_node(ror_file *file, scene_error *error) {
    const line_reader *reader = &file->reader;
    model_node node = {.mass = 0};
    ror_load load = file->node_default;
    if (!line_has(reader, 4, "name x y z", error))
        return false;
    const name_entry *twin = name_find(&file->names, reader->words[0]);
    if (twin) {
        char quoted[48];
        return line_fail(reader, 0, error, "there is a node '%s' already, on line %lu",
                         text_quote(reader->words[0], quoted, sizeof quoted), twin->line);
    }
    for (size_t i = 0; i < 3; i++)
        if (!line_number(reader, 1 + i, -MODEL_MAX_COORDINATE, MODEL_MAX_COORDINATE, "coordinate", &node.at[i],
                         error))
            return false;
    if (reader->word_count > 4 && has_letter(reader->words[4], 'l')) {
        load.loaded = true;
        if (reader->word_count > 5 &&
            !line_number(reader, 5, 0, MODEL_MAX_VALUE, "load weight, kg", &load.weight, error))
            return false;
    }
    void *loads = file->loads;
    if (!model_grow(&loads, &file->load_capacity, file->made->node_count, sizeof load, error))
        return false;
    file->loads = loads;
    file->loads[file->made->node_count] = load;
    return name_add(&file->names, reader->words[0], (uint32_t)file->made->node_count, reader->line, error) &&
           model_add_node(file->made, &node, error);
}

static bool read_spring(ror_file *file, const spring_section *kind, scene_error *error) {
    const line_reader *reader = &file->reader;
    model_beam beam = {.rest = 1,
                       .stiffness = file->stiffness * file->stiffness_scale,
                       .damping = file->damping * file->damping_scale};
    if (!line_has(reader, kind->least, kind->columns, error) || !ror_node(file, 0, &beam.a, error) ||
        !ror_node(file, 1, &beam.b, error))
        return false;
    if (kind->stiffness && (!read_setting(file, kind->stiffness, "spring, N/m", &beam.stiffness, error) ||
                            !read_setting(file, kind->damping, "damping, N s/m", &beam.damping, error) ||
                            !line_number(reader, kind->tension, 1e-3, 1e3, "tension", &beam.rest, error)))
        return false;
    if (beam.stiffness > MODEL_MAX_VALUE || beam.damping > MODEL_MAX_VALUE)
        return line_fail(reader, 0, error, "its spring or damping is above %g", MODEL_MAX_VALUE);
    bool has_options = kind->has_options && reader->word_count > 2;
    if (strcmp(kind->name, "ropes") == 0 || (has_options && has_letter(reader->words[2], 'r')))
        beam.side = MSPRING_SPRING_PULL_ONLY;
    else if (has_options && has_letter(reader->words[2], 's'))
        beam.side = MSPRING_SPRING_PUSH_ONLY;
    const double strength = file->strength * file->strength_scale * (kind->stiffness ? strength_of_shocks : 1);
    beam.break_strain = model_strain_at(file->made, &beam, strength);
    if (kind->has_options) // beams bend, shocks and the like do not
        beam.yield_strain = model_strain_at(file->made, &beam, file->deform * file->deform_scale);
    return model_add_beam(file->made, &beam, error);
}

static bool read_camera(ror_file *file, scene_error *error) {
    const line_reader *reader = &file->reader;
    ror_camera camera = {.mass = camera_mass, .stiffness = camera_stiffness, .damping = camera_damping};
    for (size_t i = 0; i < 3; i++)
        if (!line_number(reader, i, -MODEL_MAX_COORDINATE, MODEL_MAX_COORDINATE, "coordinate", &camera.at[i],
                         error))
            return false;
    for (size_t i = 0; i < 8; i++)
        if (!ror_node(file, 3 + i, &camera.ends[i], error))
            return false;
    double mass = -1;
    if (!read_setting(file, 11, "spring, N/m", &camera.stiffness, error) ||
        !read_setting(file, 12, "damping, N s/m", &camera.damping, error) ||
        !read_setting(file, 13, "mass, kg", &mass, error))
        return false;
    if (mass >= MODEL_MIN_MASS)
        camera.mass = mass;
    void *cameras = file->cameras;
    if (!model_grow(&cameras, &file->camera_capacity, file->camera_count, sizeof camera, error))
        return false;
    file->cameras = cameras;
    file->cameras[file->camera_count++] = camera;
    return true;
}

static bool read_row(ror_file *file, const section *in, scene_error *error) {
    uint32_t node = 0;
    text_span name = {in->name, strlen(in->name)};
    if (in->kind == SECTION_NONE || in->kind == SECTION_IGNORED) {
        tally_add(&file->made->ignored, in->kind == SECTION_NONE ? file->reader.words[0] : name, 1);
        return true;
    }
    tally_add(&file->made->used, name, 1);
    switch (in->kind) {
    case SECTION_GLOBALS:
        return line_has(&file->reader, 2, "dry mass and cargo mass, kg", error) &&
               line_number(&file->reader, 0, 0, MODEL_MAX_VALUE, "dry mass, kg", &file->dry_mass, error) &&
               line_number(&file->reader, 1, 0, MODEL_MAX_VALUE, "cargo mass, kg", &file->cargo_mass, error);
    case SECTION_MINIMUM_MASS:
        return line_number(&file->reader, 0, MODEL_MIN_MASS, MODEL_MAX_VALUE, "least mass, kg", &file->minimum_mass,
                           error);
    case SECTION_NODES:
        return read_node(file, error);
    case SECTION_FIXES:
        if (!ror_node(file, 0, &node, error))
            return false;
        file->made->nodes[node].pinned = true;
        return true;
    case SECTION_CAMERA:
        return read_camera(file, error);
    case SECTION_SPRINGS:
        return read_spring(file, in->springs, error);
    default:
        return ror_read_wheel(file, in->name, error);
    }
}

static bool begins_with_letter(text_span word) {
    char c = *word.start;
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

// Skip to the line that ends a block, such as end_comment.
static bool skip_block(ror_file *file, const char *block, const char *end, scene_error *error) {
    unsigned long line = file->reader.line;
    while (line_next(&file->reader)) {
        if (word_is(file->reader.words[0], end))
            return true;
        tally_add_text(&file->made->ignored, block, 1);
    }
    return line_fail(&file->reader, 0, error, "the file ends before the %s of line %lu's %s", end, line, block);
}

// Of the variants of a vehicle the first is made: lines in sections of others are left out.
typedef struct variants {
    char chosen[64];
    bool open;
} variants;

static bool begin_variant(ror_file *file, variants *state, scene_error *error) {
    const line_reader *reader = &file->reader;
    for (size_t i = 2; i < reader->word_count; i++) {
        char name[sizeof state->chosen];
        text_quote(reader->words[i], name, sizeof name);
        if (!*state->chosen)
            memcpy(state->chosen, name, sizeof name);
        if (strcmp(name, state->chosen) == 0) {
            state->open = true;
            return true;
        }
    }
    return skip_block(file, "other variants", "end_section", error);
}

static bool read_lines(ror_file *file, scene_error *error) {
    section in = {.kind = SECTION_NONE};
    variants variant = {.open = false};
    // The first line is the vehicle's name, whatever it looks like.
    if (!line_next(&file->reader))
        return scene_fail(error, "%.200s: nothing in it", file->reader.name);
    while (line_next(&file->reader)) {
        const text_span word = file->reader.words[0];
        bool ok = true;
        // NOLINTNEXTLINE(bugprone-branch-clone): the order of the questions counts
        if (!begins_with_letter(word)) {
            ok = read_row(file, &in, error);
        } else if (word_is(word, "end")) {
            return true;
        } else if (word_is(word, "comment")) {
            ok = skip_block(file, "comment", "end_comment", error);
        } else if (word_is(word, "description")) {
            ok = skip_block(file, "description", "end_description", error);
        } else if (word_is(word, "section")) {
            ok = begin_variant(file, &variant, error);
        } else if (word_is(word, "end_section") && variant.open) {
            variant.open = false;
        } else if (find_section(word, &in)) {
            continue;
        } else if (is_directive(word)) {
            ok = read_directive(file, error);
        } else if (in.kind > SECTION_IGNORED && (file->reader.word_count > 1 || name_find(&file->names, word))) {
            ok = read_row(file, &in, error);
        } else if (file->reader.word_count == 1) {
            in.kind = SECTION_IGNORED;
            text_quote(word, in.name, sizeof in.name);
            tally_add(&file->made->ignored, word, 0);
        } else {
            ok = read_row(file, &in, error);
        }
        if (!ok)
            return false;
    }
    tally_add_text(&file->made->notes, "the file has no end: something may be missing", 1);
    return true;
}

bool model_read_rigs_of_rods(const char *text, size_t length, const char *name, const structure_options *options,
                             model *made, scene_error *error) {
    ror_file file = {
        .reader = {.at = text, .end = text + length, .name = name, .style = &style},
        .options = options,
        .made = made,
        .dry_mass = -1,
        .minimum_mass = default_minimum_mass,
        .stiffness = default_stiffness,
        .damping = default_damping,
        .deform = default_deform,
        .strength = default_strength,
        .stiffness_scale = 1,
        .damping_scale = 1,
        .deform_scale = 1,
        .strength_scale = 1,
        .node_default = {.weight = -1},
    };
    made->side = STRUCTURE_PLANE_XY;
    bool ok = read_lines(&file, error) && ror_finish(&file, error);
    name_free(&file.names);
    free(file.loads);
    free(file.wheels);
    free(file.cameras);
    return ok;
}
