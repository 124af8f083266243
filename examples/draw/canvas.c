/// @file canvas.c
/// Lines, discs and rectangles on pixels.
///
/// A pixel takes as much of a shape's colour as the shape covers of it, judged by the distance of the pixel's
/// centre from the shape's edge.
///
/// SPDX-License-Identifier: MIT
#include "draw/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool canvas_make(canvas *made, uint32_t width, uint32_t height, draw_colour colour) {
    size_t pixels = (size_t)width * height;
    uint8_t *rgb = malloc(pixels * 3);
    if (!rgb)
        return false;
    for (size_t i = 0; i < pixels; i++) {
        rgb[3 * i] = (uint8_t)(colour >> 16);
        rgb[3 * i + 1] = (uint8_t)(colour >> 8);
        rgb[3 * i + 2] = (uint8_t)colour;
    }
    made->width = width;
    made->height = height;
    made->rgb = rgb;
    return true;
}

void canvas_free(canvas *unwanted) {
    free(unwanted->rgb);
    memset(unwanted, 0, sizeof *unwanted);
}

static void blend(canvas *target, int x, int y, double coverage, draw_colour colour) {
    uint8_t *pixel = target->rgb + 3 * ((size_t)y * target->width + (size_t)x);
    int weight = (int)(coverage * 256 + 0.5);
    for (int i = 0; i < 3; i++) {
        int wanted = (int)(colour >> (16 - 8 * i)) & 255;
        // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): canvas_make has filled it
        pixel[i] = (uint8_t)(pixel[i] + (wanted - pixel[i]) * weight / 256);
    }
}

// Whole numbers from low to high, cut to 0 ... count - 1. Written so that NaN and infinity give an empty or a
// full range instead of an undefined conversion.
static int first_pixel(double low) {
    return low > 0 ? (low < 1e9 ? (int)low : 1000000000) : 0;
}

static int last_pixel(double high, uint32_t count) {
    double most = (double)count - 1;
    return high >= 0 ? (int)(high < most ? high : most) : -1;
}

// Coverage of a pixel whose centre lies at this distance from the middle of a shape of this half width.
static double cover(double distance, double half_width) {
    double coverage = half_width + 0.5 - distance;
    return coverage < 0 ? 0 : coverage > 1 ? 1 : coverage;
}

void canvas_line(canvas *target, double x, double y, double x2, double y2, double width, draw_colour colour) {
    // A line thinner than a pixel is drawn one pixel wide and fainter.
    double strength = width < 1 ? width : 1;
    double half = width < 1 ? 0.5 : width / 2;
    double reach = half + 1;
    double dx = x2 - x;
    double dy = y2 - y;
    double length = sqrt(dx * dx + dy * dy);
    double ux = length > 0 ? dx / length : 1;
    double uy = length > 0 ? dy / length : 0;
    int bottom = last_pixel(fmax(y, y2) + reach, target->height);
    for (int row = first_pixel(fmin(y, y2) - reach); row <= bottom; row++) {
        // The part of the row within reach of the endless line, cut to the box around the piece.
        double py = row + 0.5 - y;
        double low = fmin(x, x2) - reach;
        double high = fmax(x, x2) + reach;
        if (fabs(uy) > 1e-6) {
            double middle = x + py * ux / uy;
            double spread = reach / fabs(uy);
            low = fmax(low, middle - spread);
            high = fmin(high, middle + spread);
        }
        int right = last_pixel(high, target->width);
        for (int column = first_pixel(low); column <= right; column++) {
            double px = column + 0.5 - x;
            double along = px * ux + py * uy;
            double nearest = along < 0 ? 0 : along > length ? length : along;
            double ex = px - nearest * ux;
            double ey = py - nearest * uy;
            double coverage = cover(sqrt(ex * ex + ey * ey), half) * strength;
            if (coverage > 0)
                blend(target, column, row, coverage, colour);
        }
    }
}

void canvas_disc(canvas *target, double x, double y, double radius, draw_colour colour) {
    int bottom = last_pixel(y + radius + 1, target->height);
    int right = last_pixel(x + radius + 1, target->width);
    for (int row = first_pixel(y - radius - 1); row <= bottom; row++) {
        for (int column = first_pixel(x - radius - 1); column <= right; column++) {
            double px = column + 0.5 - x;
            double py = row + 0.5 - y;
            double coverage = cover(sqrt(px * px + py * py), radius);
            if (coverage > 0)
                blend(target, column, row, coverage, colour);
        }
    }
}

// How much of pixel index lies between low and high.
static double overlap(int index, double low, double high) {
    double start = fmax(low, index);
    double end = fmin(high, index + 1);
    return end > start ? end - start : 0;
}

void canvas_rectangle(canvas *target, double x, double y, double width, double height, draw_colour colour) {
    int bottom = last_pixel(y + height, target->height);
    int right = last_pixel(x + width, target->width);
    for (int row = first_pixel(y); row <= bottom; row++)
        for (int column = first_pixel(x); column <= right; column++)
            blend(target, column, row, overlap(row, y, y + height) * overlap(column, x, x + width), colour);
}

static void draw_text(canvas *target, const figure_item *item, const char *text) {
    double width = stroke_font_width(item->size, text);
    double shift = item->align == FIGURE_RIGHT ? width : item->align == FIGURE_CENTRE ? width / 2 : 0;
    stroke_font_draw(target, item->x - shift, item->y, item->size, item->colour, text);
}

bool canvas_from_figure(canvas *made, const figure *source, draw_error *error) {
    if (source->out_of_memory || !canvas_make(made, source->width, source->height, source->background))
        return draw_fail(error, "out of memory for a picture of %u x %u pixels", source->width, source->height);
    for (size_t i = 0; i < source->item_count; i++) {
        const figure_item *item = &source->items[i];
        switch (item->kind) {
        case FIGURE_LINE:
            canvas_line(made, item->x, item->y, item->x2, item->y2, item->size, item->colour);
            break;
        case FIGURE_DISC:
            canvas_disc(made, item->x, item->y, item->size, item->colour);
            break;
        case FIGURE_RECTANGLE:
            canvas_rectangle(made, item->x, item->y, item->x2, item->y2, item->colour);
            break;
        case FIGURE_TEXT:
            draw_text(made, item, source->characters + item->text);
            break;
        }
    }
    return true;
}
