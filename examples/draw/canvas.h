/// @file canvas.h
/// A picture of pixels, drawn on with soft edges.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_CANVAS_H
#define DRAW_CANVAS_H

#include "draw/figure.h"

typedef struct canvas {
    uint32_t width, height;
    uint8_t *rgb; ///< [height][width][3]
} canvas;

/// Make a canvas of one colour. Returns false when out of memory.
bool canvas_make(canvas *made, uint32_t width, uint32_t height, draw_colour colour);
void canvas_free(canvas *unwanted);

void canvas_line(canvas *target, double x, double y, double x2, double y2, double width, draw_colour colour);
void canvas_disc(canvas *target, double x, double y, double radius, draw_colour colour);
void canvas_rectangle(canvas *target, double x, double y, double width, double height, draw_colour colour);

/// Draw a figure onto a new canvas of its size.
bool canvas_from_figure(canvas *made, const figure *source, draw_error *error);

#endif
