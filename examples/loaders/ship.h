/// @file ship.h
/// Ships of Floating Sandbox, between their files and the model. SHIPS.md describes the files.
///
///   ship_materials.c   the game's materials, JSON
///   ship_images.c      layers as images, and the .shp file that names them
///   ship_sections.c    layers as sections of one .shp2 file
///   ship.c             from layers to a model
///
/// SPDX-License-Identifier: MIT
#ifndef LOADERS_SHIP_H
#define LOADERS_SHIP_H

#include "loaders/model.h"

/// Nothing is in a cell of this colour.
#define SHIP_EMPTY 0xffffffu

typedef struct ship_material {
    uint32_t colour;
    double mass, stiffness, strength; ///< kg; of 1; strain, 0: never
    bool rope;
} ship_material;

typedef struct ship_materials {
    ship_material *items; ///< sorted by colour
    size_t count, capacity;
    ship_material rope; ///< that of ropes, if has_rope, in its first colour
    bool has_rope;
} ship_materials;

/// A rope between two cells.
typedef struct ship_rope {
    uint32_t from, to; ///< row * width + column
    uint32_t colour;   ///< of its material; SHIP_EMPTY: ship_materials.rope
} ship_rope;

typedef struct ship_layers {
    uint32_t width, height;
    uint32_t *cells; ///< [height][width] colours, the top row first
    ship_rope *ropes;
    size_t rope_count, rope_capacity;
    double scale; ///< m from one cell to the next
    tally ignored;
} ship_layers;

/// The caller frees made->items, whatever is returned.
bool ship_materials_read(const structure_bytes *file, ship_materials *made, scene_error *error);
/// The material of a colour; NULL if there is none. Colours near that of rope are rope.
const ship_material *ship_material_of(const ship_materials *materials, uint32_t colour);
/// Say where a file is no JSON. What is no place in it is its beginning.
bool ship_fail_syntax(const structure_bytes *file, const char *at, scene_error *error);

/// Read layers. The caller frees them, whatever is returned. ropes may be NULL.
bool ship_layers_from_images(const structure_bytes *cells, const structure_bytes *ropes,
                             const ship_materials *materials, ship_layers *made, scene_error *error);
bool ship_is_sections(const structure_bytes *file);
bool ship_layers_from_sections(const structure_bytes *file, ship_layers *made, scene_error *error);
bool ship_add_rope(ship_layers *made, uint32_t from, uint32_t to, uint32_t colour, scene_error *error);
void ship_layers_free(ship_layers *unwanted);

#endif
