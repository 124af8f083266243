/// @file figure.c
/// The list of what is drawn.
///
/// SPDX-License-Identifier: MIT
#include "draw/internal.h"
#include "draw/png.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

bool draw_fail(draw_error *error, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return false;
}

FILE *draw_open(const char *path, draw_error *error) {
    FILE *stream = fopen(path, "wb");
    if (!stream)
        draw_fail(error, "cannot write %.200s: %s", path, strerror(errno));
    return stream;
}

bool draw_close(FILE *stream, const char *path, draw_error *error) {
    bool failed = ferror(stream) != 0;
    failed = fclose(stream) != 0 || failed;
    return !failed || draw_fail(error, "cannot write %.200s: is the disk full?", path);
}

void figure_start(figure *made, uint32_t width, uint32_t height, draw_colour background) {
    memset(made, 0, sizeof *made);
    made->width = width;
    made->height = height;
    made->background = background;
}

void figure_free(figure *unwanted) {
    free(unwanted->items);
    free(unwanted->characters);
    memset(unwanted, 0, sizeof *unwanted);
}

static void add(figure *target, figure_item item) {
    if (target->item_count == target->item_capacity) {
        size_t capacity = target->item_capacity ? 2 * target->item_capacity : 256;
        figure_item *items = realloc(target->items, capacity * sizeof *items);
        if (!items) {
            target->out_of_memory = true;
            return;
        }
        target->items = items;
        target->item_capacity = capacity;
    }
    target->items[target->item_count++] = item;
}

void figure_line(figure *target, double x, double y, double x2, double y2, double width, draw_colour colour) {
    add(target, (figure_item){.kind = FIGURE_LINE,
                              .colour = colour,
                              .x = (float)x,
                              .y = (float)y,
                              .x2 = (float)x2,
                              .y2 = (float)y2,
                              .size = (float)width});
}

void figure_disc(figure *target, double x, double y, double radius, draw_colour colour) {
    add(target,
        (figure_item){.kind = FIGURE_DISC, .colour = colour, .x = (float)x, .y = (float)y, .size = (float)radius});
}

void figure_rectangle(figure *target, double x, double y, double width, double height, draw_colour colour) {
    add(target, (figure_item){.kind = FIGURE_RECTANGLE,
                              .colour = colour,
                              .x = (float)x,
                              .y = (float)y,
                              .x2 = (float)width,
                              .y2 = (float)height});
}

// Appends the characters with their 0. Returns their place.
static uint32_t keep_text(figure *target, const char *text) {
    size_t size = strlen(text) + 1;
    if (target->character_count + size > target->character_capacity) {
        size_t capacity = 2 * target->character_capacity + size + 256;
        char *characters = realloc(target->characters, capacity);
        if (!characters)
            return UINT32_MAX;
        target->characters = characters;
        target->character_capacity = capacity;
    }
    size_t place = target->character_count;
    memcpy(target->characters + place, text, size);
    target->character_count += size;
    return (uint32_t)place;
}

void figure_text(figure *target, double x, double y, double size, figure_align align, draw_colour colour,
                 const char *text) {
    uint32_t place = keep_text(target, text);
    if (place == UINT32_MAX) {
        target->out_of_memory = true;
        return;
    }
    add(target, (figure_item){.kind = FIGURE_TEXT,
                              .colour = colour,
                              .x = (float)x,
                              .y = (float)y,
                              .size = (float)size,
                              .text = place,
                              .align = align});
}

bool figure_write_png(const figure *source, const char *path, draw_error *error) {
    canvas picture = {0};
    if (!canvas_from_figure(&picture, source, error))
        return false;
    bool ok = png_write(&picture, path, error);
    canvas_free(&picture);
    return ok;
}
