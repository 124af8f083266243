/// @file jbeam.c
/// Vehicles of BeamNG: tables in loose JSON, in which objects between the rows change what the following rows mean.
///
/// SPDX-License-Identifier: MIT
#include "loaders/loose_json.h"
#include "loaders/model.h"
#include "loaders/names.h"

#include <stdio.h>
#include <string.h>

// Strength from which on a beam never breaks, N: files write FLT_MAX.
static const double unbreakable = 1e30;

typedef struct jbeam_file {
    json_document document;
    const json_value *variables; // the part's table, or NULL
    model *made;
    name_table names;
    scene_error *error;
} jbeam_file;

// What holds for the rows that follow: BeamNG's defaults at first (kg, N/m, N s/m, N).
typedef struct jbeam_state {
    double weight, spring, damping, deform, strength, precompression;
    bool fixed, optional;
    text_span type;
} jbeam_state;

static const jbeam_state defaults = {
    .weight = 25,
    .spring = 4300000,
    .damping = 580,
    .deform = 220000,
    .strength = 1e38,
    .precompression = 1,
};

static bool fail(const jbeam_file *file, const json_value *at, const char *what) {
    char quoted[48];
    return json_fail(&file->document, at->text.start, file->error, "'%s' %s",
                     text_quote(at->text, quoted, sizeof quoted), what);
}

/* ---------------------------------------------------------------------------------------------------- numbers */

static uint32_t column_of(const jbeam_file *file, const json_value *header, const char *name) {
    uint32_t column = 0;
    for (const json_value *cell = json_first(&file->document, header); cell;
         cell = json_next(&file->document, cell), column++)
        if (json_is(cell->text, name))
            return column;
    return UINT32_MAX;
}

static const json_value *cell_of(const jbeam_file *file, const json_value *row, uint32_t column) {
    const json_value *cell = json_first(&file->document, row);
    for (uint32_t i = 0; cell && i < column; i++)
        cell = json_next(&file->document, cell);
    return cell;
}

// The default of a variable such as $spring, or NULL.
static const json_value *variable_of(const jbeam_file *file, text_span name) {
    const json_value *header = file->variables ? json_first(&file->document, file->variables) : NULL;
    if (!header || header->kind != JSON_ARRAY)
        return NULL;
    uint32_t names = column_of(file, header, "name");
    uint32_t values = column_of(file, header, "default");
    if (names == UINT32_MAX || values == UINT32_MAX)
        return NULL;
    for (const json_value *row = json_next(&file->document, header); row; row = json_next(&file->document, row)) {
        const json_value *cell = row->kind == JSON_ARRAY ? cell_of(file, row, names) : NULL;
        if (cell && cell->text.length == name.length && memcmp(cell->text.start, name.start, name.length) == 0)
            return cell_of(file, row, values);
    }
    return NULL;
}

static bool read_number(const jbeam_file *file, const json_value *from, double least, double most, double *value) {
    double number = from->number;
    bool ok = from->kind == JSON_NUMBER;
    if (from->kind == JSON_STRING && from->text.length > 1 && *from->text.start == '$') {
        if (from->text.start[1] == '=')
            return fail(file, from, "is a formula, which is not computed here");
        const json_value *variable = variable_of(file, from->text);
        if (!variable)
            return fail(file, from, "is no variable of this part");
        ok = variable->kind == JSON_NUMBER;
        number = variable->number;
    } else if (from->kind == JSON_STRING) {
        ok = json_is(from->text, "FLT_MAX") || number_parse(from->text, &number);
        if (ok && json_is(from->text, "FLT_MAX"))
            number = most;
    }
    if (!ok || !(number >= least))
        return fail(file, from, "is no number that can stand here");
    *value = number < most ? number : most;
    return true;
}

/* --------------------------------------------------------------------------------------------- options of rows */

static bool read_setting(const jbeam_file *file, const json_value *from, jbeam_state *state) {
    if (json_is(from->key, "nodeWeight"))
        return read_number(file, from, MODEL_MIN_MASS, MODEL_MAX_VALUE, &state->weight);
    if (json_is(from->key, "beamSpring"))
        return read_number(file, from, 0, MODEL_MAX_VALUE, &state->spring);
    if (json_is(from->key, "beamDamp"))
        return read_number(file, from, 0, MODEL_MAX_VALUE, &state->damping);
    if (json_is(from->key, "beamDeform"))
        return read_number(file, from, 0, 1e38, &state->deform);
    if (json_is(from->key, "beamStrength"))
        return read_number(file, from, 0, 1e38, &state->strength);
    if (json_is(from->key, "beamPrecompression"))
        return read_number(file, from, 1e-3, 1e3, &state->precompression);
    if (json_is(from->key, "fixed"))
        state->fixed = from->kind == JSON_TRUE;
    else if (json_is(from->key, "optional"))
        state->optional = from->kind == JSON_TRUE;
    else if (json_is(from->key, "beamType"))
        state->type = from->text;
    return true;
}

static bool read_settings(const jbeam_file *file, const json_value *object, jbeam_state *state) {
    for (const json_value *member = json_first(&file->document, object); member;
         member = json_next(&file->document, member))
        if (!read_setting(file, member, state))
            return false;
    return true;
}

// What holds for one row: what stands before it, and in an object at its end.
static bool read_row_settings(const jbeam_file *file, const json_value *row, jbeam_state *state) {
    for (const json_value *cell = json_first(&file->document, row); cell; cell = json_next(&file->document, cell))
        if (cell->kind == JSON_OBJECT && !read_settings(file, cell, state))
            return false;
    return true;
}

/* -------------------------------------------------------------------------------------------------------- rows */

static bool read_node(jbeam_file *file, const json_value *row, const uint32_t columns[], const jbeam_state *state) {
    model_node node = {.mass = state->weight, .pinned = state->fixed};
    const json_value *name = cell_of(file, row, columns[0]);
    if (!name || (name->kind != JSON_STRING && name->kind != JSON_NUMBER))
        return fail(file, name ? name : row, "begins a node without a name");
    const name_entry *twin = name_find(&file->names, name->text);
    if (twin)
        return fail(file, name, "is the name of an earlier node");
    for (int i = 0; i < 3; i++) {
        const json_value *cell = cell_of(file, row, columns[1 + i]);
        if (!cell)
            return fail(file, name, "has not got three coordinates");
        if (!read_number(file, cell, -MODEL_MAX_COORDINATE, MODEL_MAX_COORDINATE, &node.at[i]))
            return false;
    }
    return name_add(&file->names, name->text, (uint32_t)file->made->node_count, 0, file->error) &&
           model_add_node(file->made, &node, file->error);
}

static bool read_beam(jbeam_file *file, const json_value *row, const uint32_t columns[], const jbeam_state *state) {
    const name_entry *ends[2];
    for (int i = 0; i < 2; i++) {
        const json_value *cell = cell_of(file, row, columns[i]);
        if (!cell || (cell->kind != JSON_STRING && cell->kind != JSON_NUMBER))
            return fail(file, cell ? cell : row, "begins a beam without two nodes");
        ends[i] = name_find(&file->names, cell->text);
        if (!ends[i] && state->optional) {
            tally_add_text(&file->made->notes, "optional beams to nodes that are not there", 1);
            return true;
        }
        if (!ends[i])
            return fail(file, cell, "is no node of this part");
    }
    model_beam beam = {.a = ends[0]->node,
                       .b = ends[1]->node,
                       .stiffness = state->spring,
                       .damping = state->damping,
                       .rest = state->precompression};
    if (state->strength < unbreakable)
        beam.break_strain = model_strain_at(file->made, &beam, state->strength);
    if (state->deform < unbreakable)
        beam.yield_strain = model_strain_at(file->made, &beam, state->deform);
    if (json_is(state->type, "|SUPPORT")) {
        beam.side = MSPRING_SPRING_PUSH_ONLY;
    } else if (state->type.length && !json_is(state->type, "|NORMAL")) {
        char type[24];
        char note[64];
        snprintf(note, sizeof note, "taken as plain springs: %s", text_quote(state->type, type, sizeof type));
        tally_add_text(&file->made->notes, note, 1);
    }
    return model_add_beam(file->made, &beam, file->error);
}

typedef bool (*row_reader)(jbeam_file *file, const json_value *row, const uint32_t columns[],
                           const jbeam_state *state);

static bool read_table(jbeam_file *file, const json_value *table, const char *const names[], size_t name_count,
                       row_reader read) {
    uint32_t columns[4];
    jbeam_state state = defaults;
    const json_value *header = json_first(&file->document, table);
    if (table->kind != JSON_ARRAY || (header && header->kind != JSON_ARRAY))
        return fail(file, table, "begins no table: its first row must hold the names of its columns");
    for (size_t i = 0; header && i < name_count; i++) {
        columns[i] = column_of(file, header, names[i]);
        if (columns[i] == UINT32_MAX)
            return json_fail(&file->document, header->text.start, file->error, "the table has no column '%s'",
                             names[i]);
    }
    for (const json_value *row = header ? json_next(&file->document, header) : NULL; row;
         row = json_next(&file->document, row)) {
        if (row->kind == JSON_OBJECT) {
            if (!read_settings(file, row, &state))
                return false;
            continue;
        }
        jbeam_state of_row = state;
        if (row->kind != JSON_ARRAY)
            return fail(file, row, "is no row: rows are arrays, and what changes them objects");
        if (!read_row_settings(file, row, &of_row) || !read(file, row, columns, &of_row))
            return false;
        tally_add(&file->made->used, table->key, 1);
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------- parts */

static bool read_part(jbeam_file *file, const json_value *part) {
    static const char *const node_columns[] = {"id", "posX", "posY", "posZ"};
    static const char *const beam_columns[] = {"id1:", "id2:"};
    const json_document *document = &file->document;
    file->variables = json_member(document, part, "variables");
    // Nodes first, wherever they stand.
    for (const json_value *member = json_first(document, part); member; member = json_next(document, member))
        if (json_is(member->key, "nodes") && !read_table(file, member, node_columns, 4, read_node))
            return false;
    for (const json_value *member = json_first(document, part); member; member = json_next(document, member)) {
        if (json_is(member->key, "beams") || json_is(member->key, "hydros")) {
            if (!read_table(file, member, beam_columns, 2, read_beam))
                return false;
        } else if (!json_is(member->key, "nodes")) {
            const bool table = member->kind == JSON_ARRAY && member->children > 0;
            tally_add(&file->made->ignored, member->key, table ? member->children - 1 : 1);
        }
    }
    return true;
}

static bool read_parts(jbeam_file *file, const char *wanted) {
    const json_document *document = &file->document;
    const json_value *chosen = NULL;
    for (const json_value *part = json_first(document, document->values); part; part = json_next(document, part))
        if (!chosen && (wanted ? json_is(part->key, wanted) : json_member(document, part, "nodes") != NULL))
            chosen = part;
    if (!chosen)
        return wanted ? json_fail(document, document->start, file->error, "there is no part '%.64s'", wanted)
                      : json_fail(document, document->start, file->error, "no part of it has nodes");
    for (const json_value *part = json_first(document, document->values); part; part = json_next(document, part))
        if (part != chosen)
            tally_add_text(&file->made->ignored, "other parts", 1);
    return read_part(file, chosen);
}

bool model_read_jbeam(const char *text, size_t length, const char *name, const structure_options *options,
                      model *made, scene_error *error) {
    jbeam_file file = {.made = made, .error = error};
    made->side = STRUCTURE_PLANE_YZ;
    if (!json_parse(text, length, name, &file.document, error))
        return false;
    bool ok = read_parts(&file, options->part);
    name_free(&file.names);
    json_free(&file.document);
    return ok;
}
