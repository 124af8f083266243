/// @file raster.c
/// Boxes, lines and rings, one pixel after the other.
///
/// A pixel takes as much of a shape's colour as the shape covers of it, judged by the distance of the pixel's
/// centre from the shape's edge.
///
/// SPDX-License-Identifier: MIT
#include "lab/raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool raster_make(lab_raster *made, int width, int height) {
    uint32_t *pixels = calloc((size_t)width * (size_t)height, sizeof *pixels);
    if (!pixels)
        return false;
    *made = (lab_raster){.width = width, .height = height, .pixels = pixels};
    return true;
}

void raster_free(lab_raster *unwanted) {
    free(unwanted->pixels);
    memset(unwanted, 0, sizeof *unwanted);
}

bool box_holds(lab_box box, int x, int y) {
    return x >= box.x && y >= box.y && x < box.x + box.width && y < box.y + box.height;
}

lab_box box_shrink(lab_box box, int by) {
    return (lab_box){box.x + by, box.y + by, box.width - 2 * by, box.height - 2 * by};
}

lab_colour colour_mix(lab_colour a, lab_colour b, int part) {
    // Red and blue in one multiplication, with 8 bits of room between them.
    const uint32_t outer = ((a & 0xff00ff) * (uint32_t)(256 - part) + (b & 0xff00ff) * (uint32_t)part) >> 8;
    const uint32_t green = ((a & 0x00ff00) * (uint32_t)(256 - part) + (b & 0x00ff00) * (uint32_t)part) >> 8;
    return (outer & 0xff00ff) | (green & 0x00ff00);
}

static lab_box intersection(lab_box a, lab_box b) {
    const int left = a.x > b.x ? a.x : b.x;
    const int top = a.y > b.y ? a.y : b.y;
    const int right = a.x + a.width < b.x + b.width ? a.x + a.width : b.x + b.width;
    const int bottom = a.y + a.height < b.y + b.height ? a.y + a.height : b.y + b.height;
    return (lab_box){left, top, right > left ? right - left : 0, bottom > top ? bottom - top : 0};
}

// The pixels that a shape within these bounds can touch. Written so that NaN and infinity give an empty or a full
// box instead of an undefined conversion.
static lab_box touched(lab_box clip, double left, double top, double right, double bottom) {
    const double least_x = clip.x, least_y = clip.y;
    const double most_x = clip.x + clip.width, most_y = clip.y + clip.height;
    if (!(left < most_x && right > least_x && top < most_y && bottom > least_y))
        return (lab_box){clip.x, clip.y, 0, 0};
    const int from_x = left > least_x ? (int)left : clip.x;
    const int from_y = top > least_y ? (int)top : clip.y;
    const int to_x = right < most_x ? (int)ceil(right) : clip.x + clip.width;
    const int to_y = bottom < most_y ? (int)ceil(bottom) : clip.y + clip.height;
    return intersection(clip, (lab_box){from_x, from_y, to_x - from_x, to_y - from_y});
}

static int cover(double coverage, int alpha) {
    return coverage <= 0 ? 0 : coverage >= 1 ? alpha : (int)(coverage * alpha + 0.5);
}

void raster_fill(lab_raster *target, lab_box clip, lab_box box, lab_colour colour, int alpha) {
    const lab_box part = intersection(clip, box);
    for (int y = part.y; y < part.y + part.height; y++) {
        uint32_t *row = target->pixels + (size_t)y * (size_t)target->width;
        for (int x = part.x; x < part.x + part.width; x++)
            row[x] = alpha == 256 ? colour : colour_mix(row[x], colour, alpha);
    }
}

void raster_frame(lab_raster *target, lab_box clip, lab_box box, lab_colour colour, int alpha) {
    raster_fill(target, clip, (lab_box){box.x, box.y, box.width, 1}, colour, alpha);
    raster_fill(target, clip, (lab_box){box.x, box.y + box.height - 1, box.width, 1}, colour, alpha);
    raster_fill(target, clip, (lab_box){box.x, box.y + 1, 1, box.height - 2}, colour, alpha);
    raster_fill(target, clip, (lab_box){box.x + box.width - 1, box.y + 1, 1, box.height - 2}, colour, alpha);
}

void raster_round(lab_raster *target, lab_box clip, lab_box box, double radius, lab_colour colour, int alpha) {
    // The corners pixel by pixel, the rest as boxes.
    const int corner = (int)ceil(radius);
    if (2 * corner > box.width || 2 * corner > box.height) {
        raster_fill(target, clip, box, colour, alpha);
        return;
    }
    raster_fill(target, clip, (lab_box){box.x + corner, box.y, box.width - 2 * corner, corner}, colour, alpha);
    raster_fill(target, clip, (lab_box){box.x, box.y + corner, box.width, box.height - 2 * corner}, colour, alpha);
    raster_fill(target, clip,
                (lab_box){box.x + corner, box.y + box.height - corner, box.width - 2 * corner, corner}, colour,
                alpha);
    for (int i = 0; i < 4 * corner * corner; i++) {
        const int column = i % (2 * corner), row = i / (2 * corner);
        const int x = column < corner ? box.x + column : box.x + box.width - 2 * corner + column;
        const int y = row < corner ? box.y + row : box.y + box.height - 2 * corner + row;
        if (!box_holds(clip, x, y))
            continue;
        const double dx = fabs(column + 0.5 - corner) - (corner - radius),
                     dy = fabs(row + 0.5 - corner) - (corner - radius);
        uint32_t *pixel = &target->pixels[(size_t)y * (size_t)target->width + (size_t)x];
        *pixel = colour_mix(*pixel, colour, cover(radius + 0.5 - sqrt(dx * dx + dy * dy), alpha));
    }
}

void raster_line(lab_raster *target, lab_box clip, double x, double y, double x2, double y2, double width,
                 lab_colour colour, int alpha) {
    const double half = 0.5 * width;
    const double dx = x2 - x, dy = y2 - y;
    const double length = sqrt(dx * dx + dy * dy);
    if (!(length < 1e6))
        return;
    const double along_x = length > 0 ? dx / length : 1, along_y = length > 0 ? dy / length : 0;
    const lab_box part = touched(clip, fmin(x, x2) - half - 1, fmin(y, y2) - half - 1, fmax(x, x2) + half + 1,
                                 fmax(y, y2) + half + 1);
    // A steep line touches few columns of each row.
    for (int row = part.y; row < part.y + part.height; row++) {
        lab_box span = {part.x, row, part.width, 1};
        if (fabs(along_y) > 1e-3) {
            const double middle = x + (row + 0.5 - y) * along_x / along_y;
            const double reach = (half + 1) / fabs(along_y) + 1;
            span = touched(span, middle - reach, row, middle + reach, row + 1);
        }
        uint32_t *pixels = target->pixels + (size_t)row * (size_t)target->width;
        for (int column = span.x; column < span.x + span.width; column++) {
            const double from_x = column + 0.5 - x, from_y = row + 0.5 - y;
            const double place = from_x * along_x + from_y * along_y;
            const double beyond = place < 0 ? -place : place > length ? place - length : 0;
            const double beside = fabs(from_y * along_x - from_x * along_y);
            const double distance = beyond > 0 ? sqrt(beyond * beyond + beside * beside) : beside;
            const int covered = cover(half + 0.5 - distance, alpha);
            if (covered > 0)
                pixels[column] = colour_mix(pixels[column], colour, covered);
        }
    }
}

void raster_ring(lab_raster *target, lab_box clip, double x, double y, double inner, double outer,
                 lab_colour colour, int alpha) {
    const lab_box part = touched(clip, x - outer - 1, y - outer - 1, x + outer + 1, y + outer + 1);
    for (int row = part.y; row < part.y + part.height; row++) {
        uint32_t *pixels = target->pixels + (size_t)row * (size_t)target->width;
        for (int column = part.x; column < part.x + part.width; column++) {
            const double dx = column + 0.5 - x, dy = row + 0.5 - y;
            const double distance = sqrt(dx * dx + dy * dy);
            const double within = outer + 0.5 - distance;
            const double without = inner > 0 ? distance - inner + 0.5 : 1;
            const int covered = cover(within < without ? within : without, alpha);
            if (covered > 0)
                pixels[column] = colour_mix(pixels[column], colour, covered);
        }
    }
}
