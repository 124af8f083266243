/// @file image_scene.c
/// A network from an image: pixels become cells of a lattice, colours their materials.
///
/// SPDX-License-Identifier: MIT
#include "scenes/image.h"
#include "scenes/internal.h"

#include <stdlib.h>
#include <string.h>

// A colour and the material that it stands for, in an array sorted by colour.
typedef struct colour_entry {
    uint32_t key;
    uint16_t material;
} colour_entry;

typedef struct colour_table {
    colour_entry *entries;
    size_t count;
} colour_table;

static const uint32_t white = 0xffffff;

static int compare_entries(const void *a, const void *b) {
    const colour_entry *first = a;
    const colour_entry *second = b;
    return first->key < second->key ? -1 : first->key > second->key;
}

static bool colour_table_make(colour_table *made, const scene_materials *materials, scene_error *error) {
    made->entries = malloc(materials->count * sizeof *made->entries);
    if (!made->entries)
        return scene_fail_memory(error, "cannot read the image");
    made->count = materials->count;
    for (size_t i = 0; i < materials->count; i++) {
        const scene_material *material = &materials->items[i];
        made->entries[i].key = (uint32_t)material->red << 16 | (uint32_t)material->green << 8 | material->blue;
        made->entries[i].material = (uint16_t)i;
    }
    qsort(made->entries, made->count, sizeof *made->entries, compare_entries);
    return true;
}

static uint32_t colour_of(const pixel_image *image, size_t pixel) {
    const uint8_t *rgba = image->rgba + 4 * pixel;
    return rgba[3] == 0 ? white : (uint32_t)rgba[0] << 16 | (uint32_t)rgba[1] << 8 | rgba[2];
}

static bool fail_colour(const pixel_image *image, size_t first, const char *name, scene_error *error) {
    uint32_t colour = colour_of(image, first);
    size_t count = 0;
    for (size_t i = first; i < (size_t)image->width * image->height; i++)
        count += colour_of(image, i) == colour;
    return scene_fail(
        error,
        "%.200s: colour #%06X has no material: %zu pixel%s, the first in column %zu of row %zu (counted "
        "from 0 at the top left). Repaint, or add the colour to the materials",
        name, colour, count, count == 1 ? "" : "s", first % image->width, first / image->width);
}

// Turns pixels into cells. Finds the probe's pixel, if there is one.
static bool read_cells(const pixel_image *image, const colour_table *colours, const scene_materials *materials,
                       const char *name, uint16_t *cells, size_t *probe, scene_error *error) {
    size_t pixels = (size_t)image->width * image->height;
    size_t particles = 0;
    colour_entry last = {.key = white, .material = MSPRING_CELL_EMPTY};
    *probe = SIZE_MAX;
    for (size_t i = 0; i < pixels; i++) {
        colour_entry wanted = {.key = colour_of(image, i)};
        if (wanted.key == white) {
            cells[i] = MSPRING_CELL_EMPTY;
            continue;
        }
        if (wanted.key != last.key) {
            const colour_entry *found =
                bsearch(&wanted, colours->entries, colours->count, sizeof wanted, compare_entries);
            if (!found)
                return fail_colour(image, i, name, error);
            last = *found;
        }
        cells[i] = last.material;
        particles++;
        if (!materials->items[last.material].probe)
            continue;
        if (*probe != SIZE_MAX)
            return scene_fail(
                error,
                "%.200s: more than one probe: column %zu of row %zu and column %zu of row %zu (counted from "
                "0 at the top left). Leave one",
                name, *probe % image->width, *probe / image->width, i % image->width, i / image->width);
        *probe = i;
    }
    if (particles == 0)
        return scene_fail(error, "%.200s: no particle: every pixel is white or transparent", name);
    return true;
}

// Whether the materials hold fractions, where they are to be taken for such.
static bool check_fractions(const scene_materials *materials, const scene_options *options, scene_error *error) {
    for (size_t i = 0; options->relative && options->stiffness < 0 && i < materials->count; i++) {
        const scene_material *given = &materials->items[i];
        if (given->stiffness > 1 || given->damping > 1)
            return scene_fail(error,
                              "material '%s' has stiffness %g and damping %g, which are no fractions: relative "
                              "springs need 0 to 1, in the table or for all",
                              given->name, given->stiffness, given->damping);
    }
    return true;
}

static mspring_material *make_materials(const scene_materials *materials, const scene_options *options) {
    mspring_material *made = malloc(materials->count * sizeof *made);
    if (!made)
        return NULL;
    for (size_t i = 0; i < materials->count; i++) {
        const scene_material *given = &materials->items[i];
        made[i] = mspring_material_default();
        made[i].mass = given->mass;
        made[i].stiffness = options->stiffness >= 0 ? options->stiffness : given->stiffness;
        made[i].damping = options->damping >= 0                          ? options->damping
                          : options->relative && options->stiffness >= 0 ? 0
                                                                         : given->damping;
        made[i].particle_flags = given->pinned ? MSPRING_PARTICLE_PINNED : 0;
        made[i].spring_flags = options->relative ? MSPRING_SPRING_RELATIVE : 0;
    }
    return made;
}

static float weaker(float a, float b) {
    if (a == 0 || b == 0)
        return a + b;
    return a < b ? a : b;
}

// Fills break strains in the order in which a lattice numbers its springs: cell by cell, each with its right,
// lower left, lower and lower right neighbour.
static void fill_break_strains(const pixel_image *image, const uint16_t *cells, const scene_materials *materials,
                               float *strains) {
    static const int steps[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    size_t spring = 0;
    for (uint32_t row = 0; row < image->height; row++) {
        for (uint32_t column = 0; column < image->width; column++) {
            // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): every one was filled in
            uint16_t cell = cells[(size_t)row * image->width + column];
            for (int i = 0; cell != MSPRING_CELL_EMPTY && i < 4; i++) {
                int64_t x = (int64_t)column + steps[i][0];
                int64_t y = (int64_t)row + steps[i][1];
                if (x < 0 || x >= image->width || y >= image->height)
                    continue;
                uint16_t neighbour = cells[(size_t)y * image->width + (size_t)x];
                if (neighbour != MSPRING_CELL_EMPTY)
                    strains[spring++] =
                        weaker(materials->items[cell].break_strain, materials->items[neighbour].break_strain);
            }
        }
    }
}

static bool add_break_strains(const pixel_image *image, const uint16_t *cells, const scene_materials *materials,
                              scene *out, scene_error *error) {
    bool any = false;
    for (size_t i = 0; i < materials->count; i++)
        any = any || materials->items[i].break_strain > 0;
    uint32_t springs = mspring_builder_count(out->builder, MSPRING_SPRINGS);
    if (!any || springs == 0)
        return true;
    out->break_strain = malloc(springs * sizeof *out->break_strain);
    if (!out->break_strain)
        return scene_fail_memory(error, "cannot make the network");
    fill_break_strains(image, cells, materials, out->break_strain);
    return true;
}

static bool add_lattice(const pixel_image *image, const uint16_t *cells, const scene_materials *materials,
                        const scene_options *options, const char *name, scene *out, scene_error *error) {
    mspring_material *made = make_materials(materials, options);
    if (!made)
        return scene_fail_memory(error, "cannot make the network");
    mspring_lattice_def lattice = mspring_lattice_def_default();
    lattice.width = image->width;
    lattice.height = image->height;
    lattice.spacing = options->spacing;
    lattice.cells = cells;
    lattice.materials = made;
    lattice.material_count = (uint32_t)materials->count;
    mspring_result result = mspring_builder_add_lattice(out->builder, &lattice, NULL);
    free(made);
    if (result != MSPRING_OK) {
        char what[256];
        text_span path = {name, strlen(name)};
        return scene_fail_builder(error, text_quote(path, what, sizeof what), out->builder, result);
    }
    return true;
}

// Particle ids follow the cells that are not empty.
static mspring_id id_of_cell(const uint16_t *cells, size_t cell) {
    mspring_id id = 0;
    for (size_t i = 0; i < cell; i++)
        id += cells[i] != MSPRING_CELL_EMPTY;
    return id;
}

static bool build_scene(const pixel_image *image, const scene_materials *materials, const scene_options *options,
                        const char *name, uint16_t *cells, scene *out, scene_error *error) {
    colour_table colours = {0};
    size_t probe = SIZE_MAX;
    bool ok = colour_table_make(&colours, materials, error) &&
              read_cells(image, &colours, materials, name, cells, &probe, error);
    free(colours.entries);
    if (!ok || !scene_start(out, error))
        return false;
    scene_name_from_path(out, name);
    if (add_lattice(image, cells, materials, options, name, out, error) &&
        add_break_strains(image, cells, materials, out, error)) {
        if (probe != SIZE_MAX)
            out->probe = id_of_cell(cells, probe);
        return true;
    }
    scene_free(out);
    return false;
}

bool scene_image_parse(const void *bytes, size_t length, const char *name, const scene_materials *materials,
                       const scene_options *options, scene *out, scene_error *error) {
    pixel_image image = {0};
    if (!scene_options_check(options, true, error) || !check_fractions(materials, options, error) ||
        !image_decode(bytes, length, name, &image, error))
        return false;
    uint16_t *cells = malloc((size_t)image.width * image.height * sizeof *cells);
    bool ok = cells ? build_scene(&image, materials, options, name, cells, out, error)
                    : scene_fail_memory(error, "cannot read the image");
    free(cells);
    image_free(&image);
    return ok;
}

bool scene_image(const char *path, const scene_materials *materials, const scene_options *options, scene *out,
                 scene_error *error) {
    char *bytes = NULL;
    size_t length = 0;
    if (!file_read(path, &bytes, &length, error))
        return false;
    bool ok = scene_image_parse(bytes, length, path, materials, options, out, error);
    free(bytes);
    return ok;
}
