/// @file pixels.c
/// Hard-edged drawing.
///
/// SPDX-License-Identifier: MIT
#include "data/pixels.h"

#include <math.h>
#include <stdlib.h>

static uint8_t *pixel_at(const canvas *source, int x, int y) {
    if (x < 0 || y < 0 || x >= (int)source->width || y >= (int)source->height)
        return NULL;
    return source->rgb + 3 * ((size_t)y * source->width + (size_t)x);
}

void pixels_set(canvas *target, int x, int y, draw_colour colour) {
    uint8_t *pixel = pixel_at(target, x, y);
    if (!pixel)
        return;
    pixel[0] = (uint8_t)(colour >> 16);
    pixel[1] = (uint8_t)(colour >> 8);
    pixel[2] = (uint8_t)colour;
}

draw_colour pixels_get(const canvas *source, int x, int y) {
    const uint8_t *pixel = pixel_at(source, x, y);
    return pixel ? (draw_colour)pixel[0] << 16 | (draw_colour)pixel[1] << 8 | pixel[2] : PIXELS_EMPTY;
}

void pixels_box(canvas *target, int x, int y, int width, int height, draw_colour colour) {
    for (int row = y; row < y + height; row++)
        for (int column = x; column < x + width; column++)
            pixels_set(target, column, row, colour);
}

// Counts the edges that a ray to the right crosses.
static bool is_inside(const pixel_point *corners, int count, double x, double y) {
    bool inside = false;
    for (int i = 0, j = count - 1; i < count; j = i++) {
        pixel_point a = corners[i];
        pixel_point b = corners[j];
        if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
            inside = !inside;
    }
    return inside;
}

void pixels_polygon(canvas *target, const pixel_point *corners, int count, draw_colour colour) {
    for (int y = 0; y < (int)target->height; y++)
        for (int x = 0; x < (int)target->width; x++)
            if (is_inside(corners, count, x + 0.5, y + 0.5))
                pixels_set(target, x, y, colour);
}

void pixels_disc(canvas *target, double x, double y, double radius, draw_colour colour) {
    for (int row = (int)floor(y - radius); row <= (int)ceil(y + radius); row++)
        for (int column = (int)floor(x - radius); column <= (int)ceil(x + radius); column++)
            if (hypot(column + 0.5 - x, row + 0.5 - y) <= radius)
                pixels_set(target, column, row, colour);
}

void pixels_rope(canvas *target, int x, int y, int x2, int y2, draw_colour colour) {
    int steps = abs(x2 - x) > abs(y2 - y) ? abs(x2 - x) : abs(y2 - y);
    for (int i = 0; i <= steps; i++) {
        double part = steps ? (double)i / steps : 0;
        int column = (int)lround(x + part * (x2 - x));
        int row = (int)lround(y + part * (y2 - y));
        if (pixels_get(target, column, row) == PIXELS_EMPTY)
            pixels_set(target, column, row, colour);
    }
}
