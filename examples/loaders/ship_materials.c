/// @file ship_materials.c
/// The materials of Floating Sandbox, from its own JSON.
///
/// SPDX-License-Identifier: MIT
#include "loaders/ship.h"

#include <cjson/cJSON.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

// The first colour of the rope is that of plain cells of it, and of ropes that no colour tells.
static bool note_rope(ship_materials *made, size_t first) {
    if (first < made->count && made->items[first].rope && !made->has_rope) {
        made->has_rope = true;
        made->rope = made->items[first];
    }
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
    const size_t first = made->count;
    if (!cJSON_IsArray(colours))
        return add_colour(made, material, colours, file, index, from, error) && note_rope(made, first);
    const cJSON *colour = NULL;
    cJSON_ArrayForEach(colour, colours) {
        if (!add_colour(made, material, colour, file, index, from, error))
            return false;
    }
    return note_rope(made, first);
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

bool ship_fail_syntax(const structure_bytes *file, const char *at, scene_error *error) {
    const char *text = file->bytes, *start = text;
    unsigned long line = 1;
    if (!at || at < text || at > text + file->length)
        at = text;
    for (const char *c = text; c < at; c++) {
        if (*c == '\n') {
            line++;
            start = c + 1;
        }
    }
    return scene_fail(error, "%.200s:%lu:%zu: this is no JSON", file->name, line, (size_t)(at - start) + 1);
}

bool ship_materials_read(const structure_bytes *file, ship_materials *made, scene_error *error) {
    const char *text = file->bytes, *end = NULL;
    cJSON *root = cJSON_ParseWithLengthOpts(text, file->length, &end, 0);
    if (!root)
        return ship_fail_syntax(file, end, error);
    bool ok = read_material_list(made, root, file->name, error);
    cJSON_Delete(root);
    return ok;
}

const ship_material *ship_material_of(const ship_materials *materials, uint32_t colour) {
    const ship_material wanted = {.colour = colour};
    // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): a file has a material, or was refused
    const ship_material *found =
        bsearch(&wanted, materials->items, materials->count, sizeof wanted, compare_colours);
    if (found || !materials->has_rope)
        return found;
    const uint32_t family = 0xfff000; // red, and the upper half of green
    return (colour & family) == (materials->rope.colour & family) ? &materials->rope : NULL;
}
