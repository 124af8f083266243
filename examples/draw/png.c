/// @file png.c
/// PNG and APNG (the PNG specification, third edition).
///
/// SPDX-License-Identifier: MIT
#include "draw/png.h"
#include "draw/internal.h"

#include <stdlib.h>
#include <string.h>

enum { COLOUR_TYPE_PALETTE = 3 };

// The last frame of an animation is shown this many times as long.
enum { LAST_FRAME_HOLD = 20 };

// A part of a picture.
typedef struct region {
    uint32_t x, y, width, height;
} region;

static uint32_t crc32_of(uint32_t crc, const uint8_t *bytes, size_t length) {
    for (size_t i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return crc;
}

static void store_u32(uint8_t *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (24 - 8 * i));
}

// Writes a chunk whose data comes in two parts; either may be empty.
static void write_chunk(FILE *stream, const char *type, const uint8_t *head, size_t head_length,
                        const uint8_t *body, size_t body_length) {
    uint8_t start[8];
    uint8_t end[4];
    store_u32(start, (uint32_t)(head_length + body_length));
    memcpy(start + 4, type, 4);
    uint32_t crc = crc32_of(UINT32_MAX, start + 4, 4);
    crc = crc32_of(crc, head, head_length);
    crc = crc32_of(crc, body, body_length);
    store_u32(end, ~crc);
    fwrite(start, 1, sizeof start, stream);
    if (head_length)
        fwrite(head, 1, head_length, stream);
    if (body_length)
        fwrite(body, 1, body_length, stream);
    fwrite(end, 1, sizeof end, stream);
}

static void write_header(FILE *stream, uint32_t width, uint32_t height) {
    uint8_t header[13] = {0};
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, stream);
    store_u32(header, width);
    store_u32(header + 4, height);
    header[8] = 8; // bits a pixel
    header[9] = COLOUR_TYPE_PALETTE;
    write_chunk(stream, "IHDR", header, sizeof header, NULL, 0);
}

static void write_palette(FILE *stream, const palette *colours) {
    uint8_t bytes[3 * PALETTE_MOST];
    for (size_t i = 0; i < colours->count; i++)
        for (int channel = 0; channel < 3; channel++)
            bytes[3 * i + (size_t)channel] = (uint8_t)(colours->colours[i] >> (16 - 8 * channel));
    write_chunk(stream, "PLTE", bytes, 3 * colours->count, NULL, 0);
}

static uint8_t *map_pixels(const canvas *source, const palette *colours) {
    size_t pixels = (size_t)source->width * source->height;
    uint8_t *places = malloc(pixels);
    if (!places)
        return NULL;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *rgb = source->rgb + 3 * i;
        places[i] = palette_place(colours, (draw_colour)rgb[0] << 16 | (draw_colour)rgb[1] << 8 | rgb[2]);
    }
    return places;
}

// Compresses a part of a picture, row by row, each led by the number of its filter: 0, none, because places in a
// palette do not add up to anything. NULL when out of memory.
static uint8_t *compress_part(const uint8_t *places, uint32_t width, region part, size_t *compressed) {
    size_t stride = (size_t)part.width + 1;
    uint8_t *rows = malloc(stride * part.height);
    if (!rows)
        return NULL;
    for (uint32_t row = 0; row < part.height; row++) {
        rows[row * stride] = 0;
        memcpy(rows + row * stride + 1, places + (size_t)(part.y + row) * width + part.x, part.width);
    }
    uint8_t *bytes = zlib_pack(rows, stride * part.height, compressed);
    free(rows);
    return bytes;
}

static bool write_still(FILE *stream, const canvas *source, const palette *colours) {
    size_t length = 0;
    uint8_t *places = map_pixels(source, colours);
    region all = {0, 0, source->width, source->height};
    uint8_t *bytes = places ? compress_part(places, source->width, all, &length) : NULL;
    free(places);
    if (!bytes)
        return false;
    write_header(stream, source->width, source->height);
    write_palette(stream, colours);
    write_chunk(stream, "IDAT", bytes, length, NULL, 0);
    write_chunk(stream, "IEND", NULL, 0, NULL, 0);
    free(bytes);
    return true;
}

bool png_write(const canvas *source, const char *path, draw_error *error) {
    palette colours;
    if (!palette_make(&colours, source, 1, PALETTE_MOST))
        return draw_fail(error, "cannot write %.200s: out of memory", path);
    FILE *stream = draw_open(path, error);
    bool ok = stream != NULL;
    if (ok) {
        bool written = write_still(stream, source, &colours);
        ok = draw_close(stream, path, error) && written;
        if (!written)
            draw_fail(error, "cannot write %.200s: out of memory", path);
    }
    palette_free(&colours);
    return ok;
}

bool png_animation_begin(png_animation *made, const char *path, const palette *colours, uint32_t frame_count,
                         uint32_t milliseconds, draw_error *error) {
    memset(made, 0, sizeof *made);
    made->path = path;
    made->colours = colours;
    made->frame_count = frame_count;
    made->milliseconds = milliseconds;
    made->stream = draw_open(path, error);
    return made->stream != NULL;
}

// The smallest region that holds every pixel that changed; one pixel if none did.
static region changed_region(const png_animation *animation, const uint8_t *now) {
    uint32_t left = animation->width, right = 0, top = animation->height, bottom = 0;
    for (uint32_t row = 0; row < animation->height; row++) {
        for (uint32_t column = 0; column < animation->width; column++) {
            size_t index = (size_t)row * animation->width + column;
            // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): both are of as many pixels
            if (animation->shown[index] == now[index])
                continue;
            left = column < left ? column : left;
            right = column > right ? column : right;
            top = row < top ? row : top;
            bottom = row;
        }
    }
    if (left > right)
        return (region){0, 0, 1, 1};
    return (region){left, top, right - left + 1, bottom - top + 1};
}

static void write_frame_control(png_animation *target, region part) {
    uint8_t control[26] = {0};
    uint32_t hold = target->frames_done + 1 == target->frame_count ? LAST_FRAME_HOLD : 1;
    store_u32(control, target->sequence++);
    store_u32(control + 4, part.width);
    store_u32(control + 8, part.height);
    store_u32(control + 12, part.x);
    store_u32(control + 16, part.y);
    control[20] = (uint8_t)(target->milliseconds * hold >> 8);
    control[21] = (uint8_t)(target->milliseconds * hold);
    control[22] = 1000 >> 8; // the delay is in thousandths
    control[23] = 1000 & 255;
    write_chunk(target->stream, "fcTL", control, sizeof control, NULL, 0);
}

static void write_first_frame(png_animation *target, region part, const uint8_t *bytes, size_t length) {
    uint8_t control[8] = {0}; // number of frames, and of repetitions: 0, for ever
    write_header(target->stream, target->width, target->height);
    store_u32(control, target->frame_count);
    write_chunk(target->stream, "acTL", control, sizeof control, NULL, 0);
    write_palette(target->stream, target->colours);
    write_frame_control(target, part);
    write_chunk(target->stream, "IDAT", bytes, length, NULL, 0);
}

static void write_next_frame(png_animation *target, region part, const uint8_t *bytes, size_t length) {
    uint8_t sequence[4];
    write_frame_control(target, part);
    store_u32(sequence, target->sequence++);
    write_chunk(target->stream, "fdAT", sequence, sizeof sequence, bytes, length);
}

bool png_animation_add(png_animation *target, const canvas *frame, draw_error *error) {
    bool first = target->frames_done == 0;
    if (first) {
        target->width = frame->width;
        target->height = frame->height;
    }
    uint8_t *places = map_pixels(frame, target->colours);
    region part = {0, 0, frame->width, frame->height};
    if (places && !first)
        part = changed_region(target, places);
    size_t length = 0;
    uint8_t *bytes = places ? compress_part(places, frame->width, part, &length) : NULL;
    if (!bytes) {
        free(places);
        return draw_fail(error, "cannot write %.200s: out of memory", target->path);
    }
    if (first)
        write_first_frame(target, part, bytes, length);
    else
        write_next_frame(target, part, bytes, length);
    free(bytes);
    free(target->shown);
    target->shown = places;
    target->frames_done++;
    return true;
}

bool png_animation_end(png_animation *target, draw_error *error) {
    write_chunk(target->stream, "IEND", NULL, 0, NULL, 0);
    free(target->shown);
    target->shown = NULL;
    return draw_close(target->stream, target->path, error);
}
