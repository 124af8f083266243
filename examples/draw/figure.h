/// @file figure.h
/// A drawing kept as a list of lines, discs, rectangles and texts, which can be written as PNG and as SVG.
///
/// Coordinates are pixels from the top left corner, y down. Adding cannot fail visibly: when memory runs out,
/// the figure notes it and writing it says so.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_FIGURE_H
#define DRAW_FIGURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// A colour as 0xRRGGBB.
typedef uint32_t draw_colour;

typedef struct draw_error {
    char text[512];
} draw_error;

typedef enum figure_kind { FIGURE_LINE, FIGURE_DISC, FIGURE_RECTANGLE, FIGURE_TEXT } figure_kind;

/// Where a text lies relative to its point.
typedef enum figure_align { FIGURE_LEFT, FIGURE_CENTRE, FIGURE_RIGHT } figure_align;

typedef struct figure_item {
    figure_kind kind;
    draw_colour colour;
    float x, y;    ///< start, centre, top left corner, or baseline point
    float x2, y2;  ///< a line's end; a rectangle's width and height
    float size;    ///< a line's width, a disc's radius, a text's height in pixels
    uint32_t text; ///< a text's place in figure.characters
    figure_align align;
} figure_item;

typedef struct figure {
    uint32_t width, height;
    draw_colour background;
    figure_item *items;
    size_t item_count, item_capacity;
    char *characters;
    size_t character_count, character_capacity;
    bool out_of_memory;
} figure;

/// Start an empty figure. figure_free() it.
void figure_start(figure *made, uint32_t width, uint32_t height, draw_colour background);
void figure_free(figure *unwanted);

void figure_line(figure *target, double x, double y, double x2, double y2, double width, draw_colour colour);
void figure_disc(figure *target, double x, double y, double radius, draw_colour colour);
void figure_rectangle(figure *target, double x, double y, double width, double height, draw_colour colour);
void figure_text(figure *target, double x, double y, double size, figure_align align, draw_colour colour,
                 const char *text);

/// Write the figure as a PNG file.
bool figure_write_png(const figure *source, const char *path, draw_error *error);
/// Write the figure as an SVG file.
bool figure_write_svg(const figure *source, const char *path, draw_error *error);

#endif
