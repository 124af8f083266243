/// @file ship_images.c
/// A ship's layers as images: pixels are cells, and two pixels of one colour are the ends of a rope.
///
/// SPDX-License-Identifier: MIT
#include "loaders/ship.h"
#include "scenes/image.h"

#include <cjson/cJSON.h>

#include <stdlib.h>
#include <string.h>

/* ----------------------------------------------------------------------------------------------- the .shp file */

static bool take_name(const cJSON *root, const char *key, const structure_bytes *file,
                      char name[STRUCTURE_NAME_SIZE], bool is_needed, scene_error *error) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(root, key);
    name[0] = 0;
    if (!item && !is_needed)
        return true;
    if (!cJSON_IsString(item) || !item->valuestring[0])
        return scene_fail(error, "%.200s: it names no image as %s", file->name, key);
    const char *text = item->valuestring;
    if (strlen(text) >= STRUCTURE_NAME_SIZE)
        return scene_fail(error, "%.200s: the name of its %s is too long", file->name, key);
    if (text[0] == '/' || strchr(text, '\\') || strchr(text, ':') || strstr(text, ".."))
        return scene_fail(error, "%.150s: its %s is %.100s: only images in its own folder are read", file->name,
                          key, text);
    memcpy(name, text, strlen(text) + 1);
    return true;
}

bool structure_ship_images(const structure_bytes *file, char cells[STRUCTURE_NAME_SIZE],
                           char ropes[STRUCTURE_NAME_SIZE], scene_error *error) {
    const char *end = NULL;
    cJSON *root = cJSON_ParseWithLengthOpts(file->bytes, file->length, &end, 0);
    if (!root)
        return ship_fail_syntax(file, end, error);
    bool ok = cJSON_IsObject(root) || scene_fail(error, "%.200s: it holds no JSON object", file->name);
    ok = ok && take_name(root, "structure_image", file, cells, true, error) &&
         take_name(root, "ropes_image", file, ropes, false, error);
    cJSON_Delete(root);
    return ok;
}

/* -------------------------------------------------------------------------------------------------------- ropes */

bool ship_add_rope(ship_layers *made, uint32_t from, uint32_t to, uint32_t colour, scene_error *error) {
    void *ropes = made->ropes;
    if (!model_grow(&ropes, &made->rope_capacity, made->rope_count, sizeof *made->ropes, error))
        return false;
    made->ropes = ropes;
    made->ropes[made->rope_count++] = (ship_rope){from, to, colour};
    return true;
}

void ship_layers_free(ship_layers *unwanted) {
    free(unwanted->cells);
    free(unwanted->ropes);
    memset(unwanted, 0, sizeof *unwanted);
}

typedef struct rope_end {
    uint32_t colour, cell;
} rope_end;

static int compare_ends(const void *a, const void *b) {
    const rope_end *first = a, *second = b;
    if (first->colour != second->colour)
        return first->colour < second->colour ? -1 : 1;
    return first->cell < second->cell ? -1 : first->cell > second->cell;
}

static bool fail_ends(const rope_end *end, size_t count, const ship_layers *made, const char *name,
                      scene_error *error) {
    return scene_fail(
        error,
        "%.200s: %zu pixel%s of the rope colour #%06X, the first in column %u of row %u: a rope has two "
        "ends",
        name, count, count == 1 ? "" : "s", end->colour, end->cell % made->width, end->cell / made->width);
}

// Join the two ends of each colour, in the order of colours.
static bool join_ends(rope_end *ends, size_t count, bool is_layer, const char *name, ship_layers *made,
                      scene_error *error) {
    qsort(ends, count, sizeof *ends, compare_ends);
    for (size_t i = 0; i < count;) {
        size_t last = i;
        while (last < count && ends[last].colour == ends[i].colour)
            last++;
        if (last - i != 2)
            return fail_ends(&ends[i], last - i, made, name, error);
        if (!ship_add_rope(made, ends[i].cell, ends[i + 1].cell, is_layer ? SHIP_EMPTY : ends[i].colour, error))
            return false;
        i = last;
    }
    return true;
}

// The pixels that are ends: in a layer of ropes all that are not empty, among cells those of rope but for its plain
// colour.
static bool is_end(const ship_materials *materials, bool is_layer, uint32_t colour) {
    if (colour == SHIP_EMPTY || is_layer)
        return colour != SHIP_EMPTY;
    const ship_material *material = ship_material_of(materials, colour);
    return material && material->rope && colour != materials->rope.colour;
}

static bool find_ropes(const uint32_t *pixels, bool is_layer, const char *name, const ship_materials *materials,
                       ship_layers *made, scene_error *error) {
    rope_end *ends = NULL;
    size_t count = 0, capacity = 0;
    bool ok = true;
    for (uint32_t i = 0; ok && i < made->width * made->height; i++) {
        if (!is_end(materials, is_layer, pixels[i]))
            continue;
        void *grown = ends;
        ok = model_grow(&grown, &capacity, count, sizeof *ends, error);
        ends = grown;
        if (ok)
            ends[count++] = (rope_end){pixels[i], i};
    }
    ok = ok && (count == 0 || join_ends(ends, count, is_layer, name, made, error));
    free(ends);
    return ok;
}

/* ------------------------------------------------------------------------------------------------------- images */

// The colours of an image's pixels, which the caller frees; of one that is transparent SHIP_EMPTY.
static uint32_t *read_colours(const structure_bytes *file, uint32_t *width, uint32_t *height, scene_error *error) {
    pixel_image image = {0};
    if (!image_decode(file->bytes, file->length, file->name, &image, error))
        return NULL;
    const size_t count = (size_t)image.width * image.height;
    uint32_t *made = malloc(count * sizeof *made);
    for (size_t i = 0; made && i < count; i++) {
        const uint8_t *rgba = image.rgba + 4 * i;
        made[i] = rgba[3] == 0 ? SHIP_EMPTY : (uint32_t)rgba[0] << 16 | (uint32_t)rgba[1] << 8 | rgba[2];
    }
    *width = image.width;
    *height = image.height;
    image_free(&image);
    if (!made)
        scene_fail_memory(error, "cannot read the image");
    return made;
}

static bool read_ropes(const structure_bytes *ropes, const ship_materials *materials, ship_layers *made,
                       scene_error *error) {
    uint32_t width = 0, height = 0;
    uint32_t *pixels = read_colours(ropes, &width, &height, error);
    if (!pixels)
        return false;
    bool ok = (width == made->width && height == made->height) ||
              scene_fail(error, "%.200s: %u x %u pixels, but the structure has %u x %u", ropes->name, width, height,
                         made->width, made->height);
    ok = ok && find_ropes(pixels, true, ropes->name, materials, made, error);
    free(pixels);
    return ok;
}

bool ship_layers_from_images(const structure_bytes *cells, const structure_bytes *ropes,
                             const ship_materials *materials, ship_layers *made, scene_error *error) {
    made->scale = 1;
    made->cells = read_colours(cells, &made->width, &made->height, error);
    return made->cells && find_ropes(made->cells, false, cells->name, materials, made, error) &&
           (!ropes || read_ropes(ropes, materials, made, error));
}
