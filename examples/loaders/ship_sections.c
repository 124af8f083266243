/// @file ship_sections.c
/// A ship's layers as sections of one file, .shp2. All numbers have their highest byte first.
///
/// SPDX-License-Identifier: MIT
#include "loaders/ship.h"
#include "scenes/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TITLE_SIZE = 24, HEADER_SIZE = 32, KNOWN_VERSION = 1, ROPE_SIZE = 23 };
static const char title[TITLE_SIZE] = "FLOATING SANDBOX SHIP\x1a";
static const uint32_t tail = 0xffffffff;

typedef struct reader {
    const uint8_t *at;
    size_t left;
    const char *name; // of the file
} reader;

static bool fail_cut_off(const reader *from, const char *where, scene_error *error) {
    return scene_fail(error, "%.200s: it is damaged or cut off: its %s ends too early", from->name, where);
}

static bool take(reader *from, void *bytes, size_t count) {
    if (from->left < count)
        return false;
    memcpy(bytes, from->at, count);
    from->at += count;
    from->left -= count;
    return true;
}

static bool take_number(reader *from, uint32_t *number) {
    uint8_t bytes[4];
    if (!take(from, bytes, sizeof bytes))
        return false;
    *number = (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
    return true;
}

static bool take_float(reader *from, float *number) {
    uint32_t bits = 0;
    if (!take_number(from, &bits))
        return false;
    memcpy(number, &bits, sizeof *number);
    return true;
}

static bool take_colour(reader *from, uint32_t *colour) {
    uint8_t rgb[3];
    if (!take(from, rgb, sizeof rgb))
        return false;
    *colour = (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
    return true;
}

static uint32_t tag_of(const char *letters) {
    return (uint32_t)letters[0] << 24 | (uint32_t)letters[1] << 16 | (uint32_t)letters[2] << 8 |
           (uint32_t)letters[3];
}

// Some writers turn the letters round.
static bool is_tag(uint32_t tag, const char *letters) {
    const char turned[] = {letters[3], letters[2], letters[1], letters[0]};
    return tag == tag_of(letters) || tag == tag_of(turned);
}

// The next section, as a reader of its own. Returns false if there is not all of it. A list in a section ends with
// a tail, or with the section.
static bool take_section(reader *from, uint32_t *tag, reader *section) {
    uint32_t size = 0;
    if (!take_number(from, tag) || !take_number(from, &size) || from->left < size)
        return false;
    *section = (reader){from->at, size, from->name};
    from->at += size;
    from->left -= size;
    return true;
}

/* ---------------------------------------------------------------------------------------------- size and scale */

static bool read_size(reader *from, ship_layers *made, scene_error *error) {
    if (made->cells)
        return scene_fail(error, "%.200s: it gives its size after its structure, or twice", from->name);
    if (!take_number(from, &made->width) || !take_number(from, &made->height))
        return fail_cut_off(from, "size", error);
    if (made->width == 0 || made->height == 0 || (uint64_t)made->width * made->height > IMAGE_MAX_PIXELS)
        return scene_fail(error, "%.200s: it has %u x %u cells: there must be 1 to %u in all", from->name,
                          made->width, made->height, IMAGE_MAX_PIXELS);
    return true;
}

static bool read_attributes(reader *from, ship_layers *made, scene_error *error) {
    reader entry;
    uint32_t tag = 0;
    while (tag != tail && from->left > 0) {
        if (!take_section(from, &tag, &entry))
            return fail_cut_off(from, "section of attributes", error);
        if (is_tag(tag, "SSZ1") && !read_size(&entry, made, error))
            return false;
    }
    return made->width > 0 || scene_fail(error, "%.200s: its attributes have no size (SSZ1)", from->name);
}

static bool read_metadata(reader *from, ship_layers *made, scene_error *error) {
    reader entry;
    uint32_t tag = 0;
    while (tag != tail && from->left > 0) {
        float cells = 0, metres = 0;
        if (!take_section(from, &tag, &entry))
            return fail_cut_off(from, "section about the ship", error);
        if (!is_tag(tag, "SCL1"))
            continue;
        if (!take_float(&entry, &cells) || !take_float(&entry, &metres))
            return fail_cut_off(from, "scale", error);
        made->scale = (double)metres / (double)cells;
        if (!(made->scale >= 1e-3 && made->scale <= 1e3))
            return scene_fail(error, "%.200s: its cells are %g m apart: 0.001 to 1000 m are possible", from->name,
                              made->scale);
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------- layers */

// How often a colour follows: seven bits, or fifteen in two bytes, the lower ones first.
static bool take_run(reader *from, uint32_t *count) {
    uint8_t low = 0, high = 0;
    if (!take(from, &low, 1) || (low > 0x7f && !take(from, &high, 1)))
        return false;
    *count = (low & 0x7fu) | (uint32_t)high << 7;
    return true;
}

// Rows come from the bottom up.
static bool read_runs(reader *from, ship_layers *made, scene_error *error) {
    const uint32_t total = made->width * made->height;
    uint32_t filled = 0;
    while (from->left > 0) {
        uint32_t count = 0, colour = 0;
        if (!take_run(from, &count) || !take_colour(from, &colour))
            return fail_cut_off(from, "structure", error);
        if (count > total - filled)
            return scene_fail(error, "%.200s: its structure has more than the %u x %u cells of its size",
                              from->name, made->width, made->height);
        for (; count > 0; count--, filled++)
            made->cells[(made->height - 1 - filled / made->width) * made->width + filled % made->width] = colour;
    }
    return filled == total ||
           scene_fail(error, "%.200s: its structure has %u of %u cells", from->name, filled, total);
}

static bool read_structure(reader *from, ship_layers *made, scene_error *error) {
    reader entry;
    uint32_t tag = 0;
    if (made->width == 0)
        return scene_fail(error, "%.200s: its structure comes before its size", from->name);
    if (made->cells)
        return scene_fail(error, "%.200s: it has two structures", from->name);
    made->cells = malloc((size_t)made->width * made->height * sizeof *made->cells);
    if (!made->cells)
        return scene_fail_memory(error, "cannot read the ship");
    bool is_filled = false;
    while (tag != tail && from->left > 0) {
        if (!take_section(from, &tag, &entry))
            return fail_cut_off(from, "structure", error);
        if (!is_tag(tag, "BUF1"))
            continue;
        if (!read_runs(&entry, made, error))
            return false;
        is_filled = true;
    }
    return is_filled || scene_fail(error, "%.200s: its structure has no cells", from->name);
}

static bool take_cell(reader *from, const ship_layers *made, uint32_t *cell) {
    uint32_t x = 0, y = 0;
    if (!take_number(from, &x) || !take_number(from, &y) || x >= made->width || y >= made->height)
        return false;
    *cell = (made->height - 1 - y) * made->width + x;
    return true;
}

static bool read_rope_list(reader *from, ship_layers *made, scene_error *error) {
    uint32_t count = 0;
    if (!take_number(from, &count) || count > from->left / ROPE_SIZE)
        return fail_cut_off(from, "list of ropes", error);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t ends[2], colour = 0;
        uint8_t shown[4]; // the colour in which it is drawn
        if (!take_cell(from, made, &ends[0]) || !take_cell(from, made, &ends[1]))
            return scene_fail(error, "%.200s: rope %u has an end outside of the ship", from->name, i);
        if (!take_colour(from, &colour) || !take(from, shown, sizeof shown))
            return fail_cut_off(from, "list of ropes", error);
        if (!ship_add_rope(made, ends[0], ends[1], colour, error))
            return false;
    }
    return true;
}

static bool read_ropes(reader *from, ship_layers *made, scene_error *error) {
    reader entry;
    uint32_t tag = 0;
    if (made->width == 0)
        return scene_fail(error, "%.200s: its ropes come before its size", from->name);
    while (tag != tail && from->left > 0) {
        if (!take_section(from, &tag, &entry))
            return fail_cut_off(from, "section of ropes", error);
        if (is_tag(tag, "BUF1") && !read_rope_list(&entry, made, error))
            return false;
    }
    return true;
}

/* --------------------------------------------------------------------------------------------------- the file */

bool ship_is_sections(const structure_bytes *file) {
    return file->length >= TITLE_SIZE && memcmp(file->bytes, title, TITLE_SIZE) == 0;
}

static bool read_section(uint32_t tag, reader *section, ship_layers *made, scene_error *error) {
    static const struct {
        const char *tag;
        bool (*read)(reader *from, ship_layers *made, scene_error *error);
        const char *left_out;
    } known[] = {
        {"ATT1", read_attributes, NULL},    {"MET1", read_metadata, NULL},      {"STR1", read_structure, NULL},
        {"RPS1", read_ropes, NULL},         {"ELC1", NULL, "electrics"},        {"TXP1", NULL, "texture"},
        {"PHS1", NULL, "offset, pressure"}, {"ATX1", NULL, "texture settings"}, {"PVP1", NULL, "preview"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (!is_tag(tag, known[i].tag))
            continue;
        if (known[i].read)
            return known[i].read(section, made, error);
        tally_add_text(&made->ignored, known[i].left_out, 1);
        return true;
    }
    tally_add_text(&made->ignored, "unknown sections", 1);
    return true;
}

bool ship_layers_from_sections(const structure_bytes *file, ship_layers *made, scene_error *error) {
    reader whole = {file->bytes, file->length, file->name}, section;
    uint8_t header[HEADER_SIZE];
    uint32_t tag = 0;
    made->scale = 1;
    if (!take(&whole, header, sizeof header))
        return fail_cut_off(&whole, "header", error);
    const unsigned version = (unsigned)header[TITLE_SIZE] << 8 | header[TITLE_SIZE + 1];
    if (version > KNOWN_VERSION)
        return scene_fail(error, "%.200s: its format has version %u, but only %d is known", file->name, version,
                          KNOWN_VERSION);
    while (tag != tail) {
        if (!take_section(&whole, &tag, &section))
            return fail_cut_off(&whole, "list of sections", error);
        if (tag != tail && !read_section(tag, &section, made, error))
            return false;
    }
    return made->cells || scene_fail(error, "%.200s: it has no structure", file->name);
}
