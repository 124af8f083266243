/// @file ship.c
/// Ships of Floating Sandbox: an image, and the game's own materials as JSON.
///
/// The game makes springs as stiff as its substep allows: 0.5 times the material's stiffness, and 0.03 of damping,
/// as fractions (MSPRING_SPRING_RELATIVE). A material's strength is the strain at which it breaks.
///
/// SPDX-License-Identifier: MIT
#include "loaders/model.h"
#include "scenes/image.h"

#include <cjson/cJSON.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double stiffness_fraction = 0.5;
static const double damping_fraction = 0.03;
static const uint32_t white = 0xffffff;

typedef struct ship_material {
    uint32_t colour;
    double mass, stiffness, strength;
    bool rope;
} ship_material;

typedef struct ship_materials {
    ship_material *items; // sorted by colour
    size_t count, capacity;
} ship_materials;

/* ---------------------------------------------------------------------------------------------------- materials */

static bool fail_material(const char *file, int index, const cJSON *material, const char *what,
                          scene_error *error) {
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(material, "name");
    return scene_fail(error, "%.200s: material %d%s%.64s: %s", file, index, cJSON_IsString(name) ? ", " : "",
                      cJSON_IsString(name) ? name->valuestring : "", what);
}

static bool number_of(const cJSON *object, const char *key, double *value) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!cJSON_IsNumber(item) || !isfinite(item->valuedouble))
        return false;
    *value = item->valuedouble;
    return true;
}

static bool parse_colour(const cJSON *item, uint32_t *colour) {
    if (!cJSON_IsString(item) || strlen(item->valuestring) != 7 || item->valuestring[0] != '#')
        return false;
    *colour = 0;
    for (const char *c = item->valuestring + 1; *c; c++) {
        const char *digits = "0123456789abcdef";
        const char lower = *c >= 'A' && *c <= 'F' ? (char)(*c - 'A' + 'a') : *c;
        const char *digit = strchr(digits, lower);
        if (!digit)
            return false;
        *colour = *colour * 16 + (uint32_t)(digit - digits);
    }
    return true;
}

static bool add_colour(ship_materials *made, ship_material material, const cJSON *colour, const char *file,
                       int index, const cJSON *of, scene_error *error) {
    if (!parse_colour(colour, &material.colour))
        return fail_material(file, index, of, "its color_key is no colour such as \"#404050\", nor a list of them",
                             error);
    void *items = made->items;
    if (!model_grow(&items, &made->capacity, made->count, sizeof material, error))
        return false;
    made->items = items;
    made->items[made->count++] = material;
    return true;
}

static bool read_material(ship_materials *made, const cJSON *from, const char *file, int index,
                          scene_error *error) {
    ship_material material = {.stiffness = 1};
    double nominal = 0;
    double density = 0;
    const cJSON *mass = cJSON_GetObjectItemCaseSensitive(from, "mass");
    const cJSON *colours = cJSON_GetObjectItemCaseSensitive(from, "color_key");
    const cJSON *unique = cJSON_GetObjectItemCaseSensitive(from, "unique_type");
    if (!cJSON_IsObject(from))
        return scene_fail(error, "%.200s: material %d is no object", file, index);
    if (!number_of(mass, "nominal_mass", &nominal) || !number_of(mass, "density", &density))
        return fail_material(file, index, from, "its mass has not got numbers nominal_mass and density", error);
    material.mass = nominal * density;
    if (!(material.mass >= MODEL_MIN_MASS && material.mass <= MODEL_MAX_VALUE))
        return fail_material(file, index, from, "nominal_mass times density is not from 1e-9 to 1e18 kg", error);
    if (cJSON_HasObjectItem(from, "stiffness") && !number_of(from, "stiffness", &material.stiffness))
        return fail_material(file, index, from, "its stiffness is no number", error);
    if (!(material.stiffness >= 0 && material.stiffness <= MODEL_MAX_VALUE))
        return fail_material(file, index, from, "its stiffness is not from 0 to 1e18", error);
    if (!number_of(from, "strength", &material.strength) || !(material.strength >= 0))
        return fail_material(file, index, from, "its strength is no number from 0 on", error);
    if (material.strength > MODEL_MAX_VALUE)
        material.strength = 0;
    material.rope = cJSON_IsString(unique) && strcmp(unique->valuestring, "Rope") == 0;
    if (!cJSON_IsArray(colours))
        return add_colour(made, material, colours, file, index, from, error);
    const cJSON *colour = NULL;
    cJSON_ArrayForEach(colour, colours) {
        if (!add_colour(made, material, colour, file, index, from, error))
            return false;
    }
    return true;
}

static int compare_colours(const void *a, const void *b) {
    const ship_material *first = a;
    const ship_material *second = b;
    return first->colour < second->colour ? -1 : first->colour > second->colour;
}

static bool read_material_list(ship_materials *made, const cJSON *root, const char *file, scene_error *error) {
    const cJSON *list = cJSON_IsArray(root) ? root : cJSON_GetObjectItemCaseSensitive(root, "materials");
    if (!cJSON_IsArray(list))
        return scene_fail(error, "%.200s: there is no list of materials in it", file);
    int index = 0;
    const cJSON *material = NULL;
    cJSON_ArrayForEach(material, list) {
        if (!read_material(made, material, file, index++, error))
            return false;
    }
    if (made->count == 0)
        return scene_fail(error, "%.200s: its list of materials is empty", file);
    qsort(made->items, made->count, sizeof *made->items, compare_colours);
    for (size_t i = 1; i < made->count; i++)
        if (made->items[i].colour == made->items[i - 1].colour)
            return scene_fail(error, "%.200s: two materials have the colour #%06X", file, made->items[i].colour);
    return true;
}

static bool fail_syntax(const char *text, const char *at, const char *file, scene_error *error) {
    unsigned long line = 1;
    const char *start = text;
    for (const char *c = text; c < at; c++) {
        if (*c == '\n') {
            line++;
            start = c + 1;
        }
    }
    return scene_fail(error, "%.200s:%lu:%zu: this is no JSON", file, line, (size_t)(at - start) + 1);
}

static bool read_materials(const char *text, size_t length, const char *file, ship_materials *made,
                           scene_error *error) {
    const char *end = NULL;
    cJSON *root = cJSON_ParseWithLengthOpts(text, length, &end, 0);
    if (!root)
        return fail_syntax(text, end && end >= text && end <= text + length ? end : text, file, error);
    bool ok = read_material_list(made, root, file, error);
    cJSON_Delete(root);
    return ok;
}

/* ------------------------------------------------------------------------------------------------------ pixels */

typedef struct unknown_colour {
    uint32_t colour;
    size_t pixels, first;
} unknown_colour;

// Colours without a material, each with its pixels and where the first is: the first few of them.
static bool fail_colours(const pixel_image *image, const unknown_colour *unknown, size_t count, const char *name,
                         const char *file, scene_error *error) {
    enum { SHOWN = 4 };
    char list[300] = "";
    size_t length = 0;
    for (size_t i = 0; i < count && i < SHOWN; i++)
        length += (size_t)snprintf(list + length, sizeof list - length,
                                   "%s#%06X (%zu pixel%s, first in column %zu of row %zu)", i ? ", " : "",
                                   unknown[i].colour, unknown[i].pixels, unknown[i].pixels == 1 ? "" : "s",
                                   unknown[i].first % image->width, unknown[i].first / image->width);
    return scene_fail(error, "%.80s: %zu colour%s not in %.80s: %s%s", name, count, count == 1 ? " is" : "s are",
                      file, list, count > SHOWN ? ", ..." : "");
}

static uint32_t colour_of(const pixel_image *image, size_t pixel) {
    const uint8_t *rgba = image->rgba + 4 * pixel;
    return rgba[3] == 0 ? white : (uint32_t)rgba[0] << 16 | (uint32_t)rgba[1] << 8 | rgba[2];
}

static const ship_material *material_of(const ship_materials *materials, uint32_t colour) {
    ship_material wanted = {.colour = colour};
    // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): a file has a material, or was refused
    return bsearch(&wanted, materials->items, materials->count, sizeof wanted, compare_colours);
}

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

static bool add_nodes(const pixel_image *image, const ship_materials *materials, const char *name, const char *file,
                      const ship_material **cells, uint32_t *nodes, model *made, scene_error *error) {
    unknown_colour unknown[MOST_UNKNOWN];
    size_t unknown_count = 0;
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        uint32_t colour = colour_of(image, i);
        cells[i] = colour == white ? NULL : material_of(materials, colour);
        if (colour == white)
            continue;
        if (!cells[i]) {
            note_unknown(unknown, &unknown_count, colour, i);
            continue;
        }
        if (cells[i]->rope)
            tally_add_text(&made->notes, "pixels of rope, taken as cells like others", 1);
        model_node node = {.mass = cells[i]->mass};
        node.at[0] = (double)(i % image->width);
        node.at[1] = (double)(image->height - 1 - i / image->width);
        nodes[i] = (uint32_t)made->node_count;
        if (!model_add_node(made, &node, error))
            return false;
    }
    if (unknown_count)
        return fail_colours(image, unknown, unknown_count, name, file, error);
    if (made->node_count == 0)
        return scene_fail(error, "%.200s: every pixel is white or transparent", name);
    tally_add_text(&made->used, "pixels", (uint32_t)made->node_count);
    return true;
}

static bool add_beams(const pixel_image *image, const ship_material *const *cells, const uint32_t *nodes,
                      model *made, scene_error *error) {
    static const int steps[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    for (uint32_t row = 0; row < image->height; row++) {
        for (uint32_t column = 0; column < image->width; column++) {
            const size_t from = (size_t)row * image->width + column;
            for (int i = 0; cells[from] && i < 4; i++) {
                int64_t x = (int64_t)column + steps[i][0];
                int64_t y = (int64_t)row + steps[i][1];
                if (x < 0 || x >= image->width || y >= image->height)
                    continue;
                const size_t to = (size_t)y * image->width + (size_t)x;
                if (!cells[to])
                    continue;
                model_beam beam = {.a = nodes[from],
                                   .b = nodes[to],
                                   .stiffness =
                                       stiffness_fraction * (cells[from]->stiffness + cells[to]->stiffness) / 2,
                                   .damping = damping_fraction,
                                   .break_strain = fmin(cells[from]->strength, cells[to]->strength),
                                   .rest = 1};
                if (!model_add_beam(made, &beam, error))
                    return false;
            }
        }
    }
    return true;
}

static bool add_pixels(const pixel_image *image, const ship_materials *materials, const char *name,
                       const char *file, model *made, scene_error *error) {
    const size_t pixels = (size_t)image->width * image->height;
    // NOLINTNEXTLINE(bugprone-sizeof-expression): they are pointers
    const ship_material **cells = calloc(pixels, sizeof *cells);
    uint32_t *nodes = malloc(pixels * sizeof *nodes);
    made->side = STRUCTURE_PLANE_XY;
    made->relative = true;
    bool ok = cells && nodes ? add_nodes(image, materials, name, file, cells, nodes, made, error) &&
                                   add_beams(image, cells, nodes, made, error)
                             : scene_fail_memory(error, "cannot read the image");
    free(cells);
    free(nodes);
    return ok;
}

bool structure_parse_ship(const void *image, size_t image_length, const char *name, const char *materials,
                          size_t materials_length, const char *materials_name, structure *out, scene_error *error) {
    const double merge_distance = 0.001; // pixels are 1 m apart: none is merged
    ship_materials table = {0};
    pixel_image pixels = {0};
    model read = {0};
    bool ok = read_materials(materials, materials_length, materials_name, &table, error) &&
              image_decode(image, image_length, name, &pixels, error);
    ok = ok && add_pixels(&pixels, &table, name, materials_name, &read, error) &&
         model_project(&read, STRUCTURE_PLANE_XY, merge_distance, out, error);
    image_free(&pixels);
    free(table.items);
    model_free(&read);
    return ok;
}
