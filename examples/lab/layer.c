/// @file layer.c
/// Sums of colours in whole numbers: four lanes of 16 bits, which one multiplication and one addition of 64 bits
/// serve.
///
/// A shape that covers a pixel whole adds FULL times its colour. A pixel that has been covered some times over
/// takes no more, so no lane runs over: (MOST + FULL) * 255 < 2^16.
///
/// SPDX-License-Identifier: MIT
#include "lab/raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FULL = 32, MOST = 224, COVERAGE_SHIFT = 48 };

layer_colour layer_colour_of(lab_colour colour) {
    return (uint64_t)(colour >> 16 & 255) | (uint64_t)(colour >> 8 & 255) << 16 | (uint64_t)(colour & 255) << 32 |
           (uint64_t)1 << COVERAGE_SHIFT;
}

bool layer_start(lab_layer *layer, lab_box box) {
    const size_t pixels = (size_t)box.width * (size_t)box.height;
    if (pixels > layer->capacity) {
        uint64_t *sums = realloc(layer->sums, pixels * sizeof *sums);
        if (!sums)
            return false;
        layer->sums = sums;
        layer->capacity = pixels;
    }
    layer->box = box;
    if (pixels > 0)
        memset(layer->sums, 0, pixels * sizeof *layer->sums);
    return true;
}

void layer_free(lab_layer *unwanted) {
    free(unwanted->sums);
    memset(unwanted, 0, sizeof *unwanted);
}

static inline void add(uint64_t *sum, uint32_t coverage, layer_colour colour) {
    if (*sum >> COVERAGE_SHIFT <= MOST)
        *sum += colour * coverage;
}

// How much of a pixel's 1/FULL parts an interval covers, both in such parts.
static int overlap(int pixel, int low, int high) {
    const int from = low > pixel * FULL ? low : pixel * FULL;
    const int to = high < (pixel + 1) * FULL ? high : (pixel + 1) * FULL;
    return to > from ? to - from : 0;
}

// A square that lies in the layer whole, in 1/FULL pixels: what it covers of the columns is the same in every row.
static void add_square(lab_layer *layer, uint32_t left, uint32_t top, uint32_t side, layer_colour colour) {
    const uint32_t right = left + side - 1, bottom = top + side - 1; // the last parts, not the ends
    const uint32_t first = left / FULL, last = right / FULL, last_row = bottom / FULL;
    const uint32_t first_part = first == last ? side : FULL - left % FULL, last_part = right % FULL + 1;
    for (uint32_t row = top / FULL; row <= last_row; row++) {
        const uint32_t from = row * FULL > top ? row * FULL : top;
        const uint32_t to = row == last_row ? bottom + 1 : (row + 1) * FULL;
        const uint32_t rows = to - from;
        uint64_t *sums = layer->sums + (size_t)row * (size_t)layer->box.width;
        add(&sums[first], rows * first_part / FULL, colour);
        for (uint32_t column = first + 1; column < last; column++)
            add(&sums[column], rows, colour);
        if (last > first)
            add(&sums[last], rows * last_part / FULL, colour);
    }
}

void layer_square(lab_layer *layer, float x, float y, float half, layer_colour colour) {
    const float width = (float)layer->box.width, height = (float)layer->box.height;
    x -= (float)layer->box.x;
    y -= (float)layer->box.y;
    if (!(x > -half && y > -half && x < width + half && y < height + half))
        return;
    const int side = (int)(2 * half * FULL + 0.5f);
    if (x >= half && y >= half && x + half < width - 1 && y + half < height - 1) {
        add_square(layer, (uint32_t)((x - half) * FULL), (uint32_t)((y - half) * FULL), (uint32_t)side, colour);
        return;
    }
    // Positive before the conversion, which cuts towards zero.
    const int offset = 1024;
    const int left = (int)((x - half + (float)offset) * FULL) - offset * FULL;
    const int top = (int)((y - half + (float)offset) * FULL) - offset * FULL;
    const int first_x = left > 0 ? left / FULL : 0, first_y = top > 0 ? top / FULL : 0;
    int last_x = (left + side - 1) / FULL, last_y = (top + side - 1) / FULL;
    last_x = last_x < layer->box.width ? last_x : layer->box.width - 1;
    last_y = last_y < layer->box.height ? last_y : layer->box.height - 1;
    for (int row = first_y; row <= last_y; row++) {
        const int rows = overlap(row, top, top + side);
        uint64_t *sums = layer->sums + (size_t)row * (size_t)layer->box.width;
        for (int column = first_x; column <= last_x; column++)
            add(&sums[column], (uint32_t)(rows * overlap(column, left, left + side)) / FULL, colour);
    }
}

// A line goes step by step along the axis that it is longer in, and across the other covers what its width takes.
void layer_line(lab_layer *layer, float x, float y, float x2, float y2, float width, layer_colour colour) {
    x -= (float)layer->box.x;
    x2 -= (float)layer->box.x;
    y -= (float)layer->box.y;
    y2 -= (float)layer->box.y;
    const bool steep = fabsf(y2 - y) > fabsf(x2 - x);
    float from = steep ? y : x, to = steep ? y2 : x2;
    float side = steep ? x : y, side_end = steep ? x2 : y2;
    if (from > to) {
        float swap = from;
        from = to;
        to = swap;
        swap = side;
        side = side_end;
        side_end = swap;
    }
    const int along_count = steep ? layer->box.height : layer->box.width;
    const int side_count = steep ? layer->box.width : layer->box.height;
    if (!(to - from < 1e6f) || to < 0 || from > (float)along_count)
        return;
    const float slope = to > from ? (side_end - side) / (to - from) : 0;
    const float half = 0.5f * width * sqrtf(1 + slope * slope);
    const int offset = 1024;
    int last = (int)to;
    last = last < along_count ? last : along_count - 1;
    for (int step = from > 0 ? (int)from : 0; step <= last; step++) {
        const float begin = from > (float)step ? from : (float)step;
        const float end = to < (float)(step + 1) ? to : (float)(step + 1);
        const float middle = side + slope * (0.5f * (begin + end) - from);
        if (!(middle > -half && middle < (float)side_count + half))
            continue;
        const int part = (int)((end - begin) * FULL + 0.5f);
        const int low = (int)((middle - half + (float)offset) * FULL) - offset * FULL;
        const int high = low + (int)(2 * half * FULL + 0.5f);
        int last_side = (high - 1) / FULL;
        last_side = last_side < side_count ? last_side : side_count - 1;
        for (int across = low > 0 ? low / FULL : 0; across <= last_side; across++) {
            const size_t index = steep ? (size_t)step * (size_t)layer->box.width + (size_t)across
                                       : (size_t)across * (size_t)layer->box.width + (size_t)step;
            add(&layer->sums[index], (uint32_t)(part * overlap(across, low, high)) / FULL, colour);
        }
    }
}

void layer_finish(const lab_layer *layer, lab_raster *target) {
    uint32_t reciprocals[MOST + FULL + 1];
    for (uint32_t i = 1; i <= MOST + FULL; i++)
        reciprocals[i] = (65536 + i - 1) / i;
    for (int y = 0; y < layer->box.height; y++) {
        const uint64_t *sums = layer->sums + (size_t)y * (size_t)layer->box.width;
        uint32_t *pixels =
            target->pixels + (size_t)(layer->box.y + y) * (size_t)target->width + (size_t)layer->box.x;
        for (int x = 0; x < layer->box.width; x++) {
            const uint32_t coverage = (uint32_t)(sums[x] >> COVERAGE_SHIFT);
            if (coverage == 0)
                continue;
            const uint32_t reciprocal = reciprocals[coverage];
            const uint32_t red = (uint32_t)(sums[x] & 65535) * reciprocal >> 16;
            const uint32_t green = (uint32_t)(sums[x] >> 16 & 65535) * reciprocal >> 16;
            const uint32_t blue = (uint32_t)(sums[x] >> 32 & 65535) * reciprocal >> 16;
            const lab_colour mean = red << 16 | green << 8 | blue;
            pixels[x] = coverage >= FULL ? mean : colour_mix(pixels[x], mean, (int)coverage * (256 / FULL));
        }
    }
}
