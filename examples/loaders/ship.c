/// @file ship.c
/// Ships of Floating Sandbox: from layers of colours to cells, springs and ropes.
///
/// The game makes springs as stiff as its substep allows: 0.5 times the mean stiffness of both ends, and 0.03 of
/// damping, as fractions (MSPRING_SPRING_RELATIVE). They break at the mean strength of both ends, times a factor
/// that falls with the number of substeps.
///
/// SPDX-License-Identifier: MIT
#include "loaders/ship.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double stiffness_fraction = 0.5;
static const double damping_fraction = 0.03;

// What a ship is made from, and how far that is.
typedef struct shipyard {
    const ship_layers *layers;
    const ship_materials *materials;
    const ship_material **cells;   // [height * width], NULL: empty
    uint32_t *nodes;               // [height * width], of cells that are not empty
    const ship_material **made_of; // [nodes]
    size_t made_of_capacity;
    double strength_factor;
    bool stands; // on its lowest row
    model *made;
    scene_error *error;
} shipyard;

/* ------------------------------------------------------------------------------------------------------ cells */

typedef struct unknown_colour {
    uint32_t colour;
    size_t pixels, first;
} unknown_colour;

// Note a pixel of a colour that no material has; the most that are told apart are as many as a byte counts.
enum { MOST_UNKNOWN = 256 };
static void note_unknown(unknown_colour *unknown, size_t *count, uint32_t colour, size_t pixel) {
    for (size_t i = 0; i < *count; i++) {
        if (unknown[i].colour == colour) {
            unknown[i].pixels++;
            return;
        }
    }
    if (*count == MOST_UNKNOWN)
        return;
    unknown[*count].colour = colour;
    unknown[*count].pixels = 1;
    unknown[(*count)++].first = pixel;
}

// No cell is of a material: say which colours there are.
static bool fail_colours(const shipyard *yard, const unknown_colour *unknown, size_t count, const char *name,
                         const char *file) {
    enum { SHOWN = 4 };
    char list[300] = "";
    size_t length = 0;
    const uint32_t width = yard->layers->width;
    if (count == 0)
        return scene_fail(yard->error, "%.200s: every pixel is white or transparent", name);
    for (size_t i = 0; i < count && i < SHOWN; i++)
        length += (size_t)snprintf(list + length, sizeof list - length,
                                   "%s#%06X (%zu pixel%s, first in column %zu of row %zu)", i ? ", " : "",
                                   unknown[i].colour, unknown[i].pixels, unknown[i].pixels == 1 ? "" : "s",
                                   unknown[i].first % width, unknown[i].first / width);
    return scene_fail(yard->error, "%.80s: no pixel has a colour of %.80s. It has %s%s", name, file, list,
                      count > SHOWN ? ", ..." : "");
}

static void tell_unknown(const shipyard *yard, const unknown_colour *unknown, size_t count) {
    for (size_t i = 0; i < count; i++) {
        char text[TALLY_NAME_SIZE];
        snprintf(text, sizeof text, "cells of #%06X, a colour of no material", unknown[i].colour);
        tally_add_text(&yard->made->ignored, text, (uint32_t)unknown[i].pixels);
    }
}

static bool add_node(shipyard *yard, const ship_material *material, double x, double y, uint32_t *node) {
    model_node added = {.mass = material->mass};
    added.at[0] = x * yard->layers->scale;
    added.at[1] = y * yard->layers->scale;
    *node = (uint32_t)yard->made->node_count;
    // NOLINTNEXTLINE(bugprone-sizeof-expression): they are pointers
    const size_t size = sizeof *yard->made_of;
    void *made_of = (void *)yard->made_of;
    if (!model_grow(&made_of, &yard->made_of_capacity, yard->made->node_count, size, yard->error))
        return false;
    yard->made_of = made_of;
    yard->made_of[*node] = material;
    return model_add_node(yard->made, &added, yard->error);
}

// A rope may end where there is no cell: that end is a cell of rope.
static bool find_cells(shipyard *yard, const char *name, const char *file) {
    const ship_layers *layers = yard->layers;
    unknown_colour unknown[MOST_UNKNOWN];
    size_t unknown_count = 0, found = 0;
    for (size_t i = 0; i < (size_t)layers->width * layers->height; i++) {
        const uint32_t colour = layers->cells[i];
        if (colour == SHIP_EMPTY)
            continue;
        yard->cells[i] = ship_material_of(yard->materials, colour);
        found += yard->cells[i] != NULL;
        if (!yard->cells[i])
            note_unknown(unknown, &unknown_count, colour, i);
    }
    if (found == 0)
        return fail_colours(yard, unknown, unknown_count, name, file);
    tell_unknown(yard, unknown, unknown_count);
    tally_add_text(&yard->made->used, "cells", (uint32_t)found);
    return true;
}

static bool add_nodes(shipyard *yard) {
    const ship_layers *layers = yard->layers;
    for (size_t i = 0; i < (size_t)layers->width * layers->height; i++) {
        const double x = (double)(i % layers->width), y = (double)(layers->height - 1 - i / layers->width);
        if (yard->cells[i] && !add_node(yard, yard->cells[i], x, y, &yard->nodes[i]))
            return false;
    }
    return true;
}

/* ----------------------------------------------------------------------------------------------------- springs */

static bool add_beam(shipyard *yard, uint32_t a, uint32_t b) {
    const ship_material *first = yard->made_of[a], *second = yard->made_of[b];
    const model_beam beam = {.a = a,
                             .b = b,
                             .stiffness = stiffness_fraction * (first->stiffness + second->stiffness) / 2,
                             .damping = damping_fraction,
                             .break_strain = yard->strength_factor * (first->strength + second->strength) / 2,
                             .rest = 1};
    return model_add_beam(yard->made, &beam, yard->error);
}

static bool add_beams(shipyard *yard) {
    static const int steps[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    const ship_layers *layers = yard->layers;
    for (uint32_t row = 0; row < layers->height; row++) {
        for (uint32_t column = 0; column < layers->width; column++) {
            const size_t from = (size_t)row * layers->width + column;
            for (int i = 0; yard->cells[from] && i < 4; i++) {
                int64_t x = (int64_t)column + steps[i][0];
                int64_t y = (int64_t)row + steps[i][1];
                if (x < 0 || x >= layers->width || y >= layers->height)
                    continue;
                const size_t to = (size_t)y * layers->width + (size_t)x;
                if (yard->cells[to] && !add_beam(yard, yard->nodes[from], yard->nodes[to]))
                    return false;
            }
        }
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------- ropes */

static const ship_material *material_of_rope(const shipyard *yard, const ship_rope *rope) {
    const ship_materials *materials = yard->materials;
    const ship_material *named = rope->colour == SHIP_EMPTY ? NULL : ship_material_of(materials, rope->colour);
    return named ? named : materials->has_rope ? &materials->rope : NULL;
}

// Where ropes end there is a cell.
static void add_ends(shipyard *yard) {
    for (size_t i = 0; i < yard->layers->rope_count; i++) {
        const ship_rope *rope = &yard->layers->ropes[i];
        const ship_material *material = material_of_rope(yard, rope);
        const uint32_t ends[] = {rope->from, rope->to};
        for (int end = 0; material && end < 2; end++)
            if (!yard->cells[ends[end]])
                yard->cells[ends[end]] = material;
    }
}

// One point for each step of a cell along the longer of x and y.
static bool lay_rope(shipyard *yard, const ship_rope *rope, const ship_material *material) {
    const uint32_t width = yard->layers->width, height = yard->layers->height;
    const double x = rope->from % width, y = height - 1 - rope->from / width;
    const double dx = (double)(rope->to % width) - x, dy = (double)(height - 1 - rope->to / width) - y;
    const uint32_t steps = (uint32_t)fmax(fabs(dx), fabs(dy));
    uint32_t last = yard->nodes[rope->from];
    if (steps <= 1) // they are neighbours
        return true;
    for (uint32_t i = 1; i < steps; i++) {
        const double part = (double)i / steps;
        uint32_t node = 0;
        if (!add_node(yard, material, x + part * dx, y + part * dy, &node) || !add_beam(yard, last, node))
            return false;
        last = node;
    }
    tally_add_text(&yard->made->used, "ropes", 1);
    return add_beam(yard, last, yard->nodes[rope->to]);
}

static bool lay_ropes(shipyard *yard) {
    for (size_t i = 0; i < yard->layers->rope_count; i++) {
        const ship_rope *rope = &yard->layers->ropes[i];
        const ship_material *material = material_of_rope(yard, rope);
        if (!material)
            tally_add_text(&yard->made->ignored, "ropes, as no material is rope", 1);
        else if (!lay_rope(yard, rope, material))
            return false;
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------------- dock */

static uint32_t root_of(uint32_t *parents, uint32_t node) {
    while (parents[node] != node)
        node = parents[node] = parents[parents[node]];
    return node;
}

// Leave out what does not stand on a pinned node: it would fall for ever.
static void drop_loose(model *made, uint32_t *parents, uint32_t *number) {
    for (uint32_t i = 0; i < made->node_count; i++)
        parents[i] = i;
    for (size_t i = 0; i < made->beam_count; i++)
        parents[root_of(parents, made->beams[i].a)] = root_of(parents, made->beams[i].b);
    for (uint32_t i = 0; i < made->node_count; i++)
        number[i] = 0;
    for (uint32_t i = 0; i < made->node_count; i++)
        if (made->nodes[i].pinned)
            number[root_of(parents, i)] = 1;
    for (uint32_t i = 0; i < made->node_count; i++)
        parents[i] = root_of(parents, i);
    for (uint32_t i = 0; i < made->node_count; i++)
        parents[i] = number[parents[i]];
    uint32_t kept = 0;
    for (uint32_t i = 0; i < made->node_count; i++) {
        number[i] = parents[i] ? kept : MSPRING_NONE;
        if (parents[i])
            made->nodes[kept++] = made->nodes[i];
    }
    if (kept < made->node_count)
        tally_add_text(&made->notes, "nodes left out, as they hang on nothing that stands",
                       (uint32_t)made->node_count - kept);
    made->node_count = kept;
    size_t beams = 0;
    for (size_t i = 0; i < made->beam_count; i++) {
        model_beam beam = made->beams[i];
        beam.a = number[beam.a];
        beam.b = number[beam.b];
        if (beam.a != MSPRING_NONE)
            made->beams[beams++] = beam;
    }
    made->beam_count = beams;
}

static bool stand(const shipyard *yard) {
    model *made = yard->made;
    double lowest = INFINITY;
    for (size_t i = 0; i < made->node_count; i++)
        lowest = fmin(lowest, made->nodes[i].at[1]);
    for (size_t i = 0; i < made->node_count; i++)
        made->nodes[i].pinned = made->nodes[i].at[1] == lowest;
    uint32_t *parents = malloc(made->node_count * sizeof *parents);
    uint32_t *number = malloc(made->node_count * sizeof *number);
    const bool ok = parents && number;
    if (ok)
        drop_loose(made, parents, number);
    else
        scene_fail_memory(yard->error, "cannot make the ship stand");
    free(parents);
    free(number);
    return ok;
}

/* ------------------------------------------------------------------------------------------------------- whole */

static bool build(shipyard *yard, const char *name, const char *file) {
    const size_t pixels = (size_t)yard->layers->width * yard->layers->height;
    // NOLINTNEXTLINE(bugprone-sizeof-expression): they are pointers
    yard->cells = calloc(pixels, sizeof *yard->cells);
    yard->nodes = malloc(pixels * sizeof *yard->nodes);
    bool ok = (yard->cells && yard->nodes) || scene_fail_memory(yard->error, "cannot read the ship");
    ok = ok && find_cells(yard, name, file);
    if (ok)
        add_ends(yard);
    ok = ok && add_nodes(yard) && add_beams(yard) && lay_ropes(yard) && (!yard->stands || stand(yard));
    free((void *)yard->cells);
    free(yard->nodes);
    free((void *)yard->made_of);
    return ok;
}

// The game's, fitted so that ships are as fragile with any number of substeps.
static double strength_factor(uint32_t substeps) {
    return 0.2832 + 9.2096 * exp(-0.1142 * (double)substeps);
}

bool structure_parse_ship(const structure_bytes *ship, const structure_bytes *ropes,
                          const structure_bytes *materials, const structure_options *options, structure *out,
                          scene_error *error) {
    const double merge_distance = 0.001;
    ship_materials table = {0};
    ship_layers layers = {0};
    model read = {.side = STRUCTURE_PLANE_XY, .relative = true, .keeps_apart = true, .substeps = options->substeps};
    if (options->substeps < 1 || options->substeps > MSPRING_MAX_SUBSTEPS)
        return scene_fail(error, "the ship's substeps are %u: give 1 to %u", options->substeps,
                          MSPRING_MAX_SUBSTEPS);
    bool ok = ship_materials_read(materials, &table, error) &&
              (ship_is_sections(ship) ? ship_layers_from_sections(ship, &layers, error)
                                      : ship_layers_from_images(ship, ropes, &table, &layers, error));
    shipyard yard = {.layers = &layers,
                     .materials = &table,
                     .strength_factor = strength_factor(options->substeps),
                     .stands = options->dock,
                     .made = &read,
                     .error = error};
    read.ignored = layers.ignored;
    ok = ok && build(&yard, ship->name, materials->name) &&
         model_project(&read, STRUCTURE_PLANE_XY, merge_distance, out, error);
    ship_layers_free(&layers);
    free(table.items);
    model_free(&read);
    return ok;
}
