/// @file boat.c
/// A sailing boat of wood: hull, keel, deck, cabin, mast and four ropes. One cell has a colour of no material, as
/// files of real ships do. examples/loaders/SHIPS.md describes the files.
///
/// SPDX-License-Identifier: MIT
#include "data/boat.h"
#include "data/pixels.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { PLANK = 0x8a5a2b, FRAME = 0x5c3a1e, IRON = 0x404050, SPAR = 0xc89a5a, ROPE = 0x000000, UNKNOWN = 0x12ff34 };
enum { DECK = 30, KEEL = 40, MAST = 32, TOP = 3, LEFT = 3, RIGHT = 56 };

typedef struct boat_rope {
    int x, y, x2, y2;
    draw_colour colour; // in the image of ropes
} boat_rope;

static const boat_rope ropes[] = {
    {MAST, TOP, LEFT + 1, DECK, 0xff0000},
    {MAST, TOP, RIGHT - 1, DECK, 0x0000ff},
    {MAST + 1, TOP + 10, LEFT + 8, DECK, 0x00a000},
    {MAST + 1, TOP + 14, RIGHT - 6, DECK, 0xa000a0},
};
enum { ROPES = sizeof ropes / sizeof *ropes };

void boat_draw(canvas *target) {
    const pixel_point hull[] = {{LEFT, DECK}, {RIGHT + 1, DECK}, {RIGHT - 8, KEEL}, {LEFT + 8, KEEL}};
    pixels_polygon(target, hull, 4, PLANK);
    pixels_box(target, LEFT + 6, DECK + 3, RIGHT - LEFT - 12, 4, PIXELS_EMPTY);
    for (int x = LEFT + 14; x < RIGHT - 12; x += 8)
        pixels_box(target, x, DECK + 3, 2, 4, FRAME);
    pixels_box(target, LEFT + 12, KEEL, RIGHT - LEFT - 24, 2, IRON);
    pixels_box(target, LEFT + 10, DECK - 5, 14, 5, FRAME);
    pixels_box(target, LEFT + 13, DECK - 4, 3, 2, PIXELS_EMPTY);
    pixels_box(target, LEFT + 18, DECK - 4, 3, 2, PIXELS_EMPTY);
    pixels_box(target, MAST, TOP, 2, DECK + 2 - TOP, SPAR);
    pixels_set(target, RIGHT + 2, 1, UNKNOWN);
}

// Two ropes begin at the top of the mast, so the second end of one lies a cell lower.
void boat_draw_ropes(canvas *target) {
    for (int i = 0; i < ROPES; i++) {
        pixels_set(target, ropes[i].x, ropes[i].y + (i == 1), ropes[i].colour);
        pixels_set(target, ropes[i].x2, ropes[i].y2, ropes[i].colour);
    }
}

/* --------------------------------------------------------------------------------------------- sections of a file
 */

static void put_number(FILE *to, uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8)
        fputc((int)(number >> shift & 0xff), to);
}

static void put_section(FILE *to, const char *tag, uint32_t size) {
    if (tag)
        fwrite(tag, 1, 4, to);
    else
        put_number(to, 0xffffffff);
    put_number(to, size);
}

// A run of one colour, of at most 127 cells. Returns the bytes that it takes; to may be NULL.
static uint32_t put_run(FILE *to, uint32_t count, draw_colour colour) {
    enum { BYTES = 4 };
    const uint8_t run[BYTES] = {(uint8_t)count, (uint8_t)(colour >> 16), (uint8_t)(colour >> 8), (uint8_t)colour};
    if (to)
        fwrite(run, 1, BYTES, to);
    return BYTES;
}

// All cells, the bottom row first.
static uint32_t put_cells(FILE *to, const canvas *cells) {
    uint32_t size = 0, count = 0;
    draw_colour last = PIXELS_EMPTY;
    for (int y = BOAT_HEIGHT - 1; y >= 0; y--) {
        for (int x = 0; x < BOAT_WIDTH; x++) {
            const draw_colour colour = pixels_get(cells, x, y);
            if (count > 0 && (colour != last || count == 127)) {
                size += put_run(to, count, last);
                count = 0;
            }
            last = colour;
            count++;
        }
    }
    return size + put_run(to, count, last);
}

static void put_attributes(FILE *to) {
    enum { HEAD = 8, SIZE = 8 };
    put_section(to, "ATT1", HEAD + SIZE + HEAD);
    put_section(to, "SSZ1", SIZE);
    put_number(to, BOAT_WIDTH);
    put_number(to, BOAT_HEIGHT);
    put_section(to, NULL, 0);
}

static void put_ropes(FILE *to) {
    enum { HEAD = 8, ROPE_SIZE = 23 };
    put_section(to, "RPS1", HEAD + 4 + ROPES * ROPE_SIZE + HEAD);
    put_section(to, "BUF1", 4 + ROPES * ROPE_SIZE);
    put_number(to, ROPES);
    for (int i = 0; i < ROPES; i++) {
        put_number(to, (uint32_t)ropes[i].x);
        put_number(to, (uint32_t)(BOAT_HEIGHT - 1 - ropes[i].y - (i == 1)));
        put_number(to, (uint32_t)ropes[i].x2);
        put_number(to, (uint32_t)(BOAT_HEIGHT - 1 - ropes[i].y2));
        for (int byte = 0; byte < 3; byte++)
            fputc((ROPE >> (16 - 8 * byte)) & 0xff, to);
        put_number(to, (uint32_t)ropes[i].colour << 8 | 0xff);
    }
    put_section(to, NULL, 0);
}

static bool end_file(FILE *stream, const char *path, draw_error *error) {
    const bool ok = stream && !ferror(stream);
    if (stream && fclose(stream) == 0 && ok)
        return true;
    snprintf(error->text, sizeof error->text, "cannot write %.200s: %s", path, strerror(errno));
    return false;
}

bool boat_write_sections(const canvas *cells, const char *path, draw_error *error) {
    enum { HEADER = 32, HEAD = 8 };
    char header[HEADER] = "FLOATING SANDBOX SHIP\x1a";
    FILE *stream = fopen(path, "wb");
    header[25] = 1; // version
    if (stream) {
        const uint32_t size = put_cells(NULL, cells);
        fwrite(header, 1, HEADER, stream);
        put_attributes(stream);
        put_section(stream, "STR1", HEAD + size + HEAD);
        put_section(stream, "BUF1", size);
        put_cells(stream, cells);
        put_section(stream, NULL, 0);
        put_ropes(stream);
        put_section(stream, NULL, 0);
    }
    return end_file(stream, path, error);
}

/* ------------------------------------------------------------------------------------------------------- texts */

static const char shp[] = "{\n"
                          "    \"structure_image\": \"boat_structure.png\",\n"
                          "    \"ropes_image\": \"boat_ropes.png\",\n"
                          "    \"ship_name\": \"A boat\"\n"
                          "}\n";

static const struct {
    const char *name;
    draw_colour colour;
    double mass, density, stiffness, strength;
    bool is_rope;
} materials[] = {
    {"Plank", PLANK, 700, 0.1, 1, 0.08, false},     {"Frame", FRAME, 750, 0.2, 1, 0.1, false},
    {"Iron keel", IRON, 7900, 0.3, 1, 0.05, false}, {"Spar", SPAR, 500, 0.1, 1, 0.12, false},
    {"Rope", ROPE, 500, 0.02, 1.84, 0.3, true},
};

static bool write_materials(const char *path, draw_error *error) {
    FILE *stream = fopen(path, "w");
    const size_t count = sizeof materials / sizeof *materials;
    if (stream)
        fputs("{\"materials\": [\n", stream);
    for (size_t i = 0; stream && i < count; i++)
        fprintf(stream,
                "    {\"name\": \"%s\", \"color_key\": \"#%06X\", \"stiffness\": %g, \"strength\": %g,%s\n"
                "     \"mass\": {\"nominal_mass\": %g, \"density\": %g}}%s\n",
                materials[i].name, (unsigned)materials[i].colour, materials[i].stiffness, materials[i].strength,
                materials[i].is_rope ? " \"unique_type\": \"Rope\"," : "", materials[i].mass, materials[i].density,
                i + 1 < count ? "," : "");
    if (stream)
        fputs("]}\n", stream);
    return end_file(stream, path, error);
}

bool boat_write_texts(const char *folder, draw_error *error) {
    char path[1024];
    snprintf(path, sizeof path, "%s/boat.shp", folder);
    FILE *stream = fopen(path, "w");
    if (stream)
        fputs(shp, stream);
    if (!end_file(stream, path, error))
        return false;
    snprintf(path, sizeof path, "%s/structural_materials.json", folder);
    return write_materials(path, error);
}
