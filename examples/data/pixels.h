/// @file pixels.h
/// Drawing whose pixels have one of the given colours exactly, as images that become networks need it.
///
/// SPDX-License-Identifier: MIT
#ifndef DATA_PIXELS_H
#define DATA_PIXELS_H

#include "draw/canvas.h"

/// Nothing.
enum { PIXELS_EMPTY = 0xffffff };

typedef struct pixel_point {
    double x, y;
} pixel_point;

/// Set one pixel; outside the canvas nothing happens.
void pixels_set(canvas *target, int x, int y, draw_colour colour);
draw_colour pixels_get(const canvas *source, int x, int y);
/// Fill columns x ... x + width - 1 of rows y ... y + height - 1.
void pixels_box(canvas *target, int x, int y, int width, int height, draw_colour colour);
/// Fill the pixels whose centres lie in a polygon.
void pixels_polygon(canvas *target, const pixel_point *corners, int count, draw_colour colour);
void pixels_disc(canvas *target, double x, double y, double radius, draw_colour colour);
/// A line one pixel wide, drawn on empty pixels only.
void pixels_rope(canvas *target, int x, int y, int x2, int y2, draw_colour colour);

#endif
