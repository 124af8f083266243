/// @file palette.c
/// Colours chosen by cutting the colour cube: the box with the widest spread of colours is cut in two, at its
/// mean, until there are enough boxes.
///
/// SPDX-License-Identifier: MIT
#include "draw/palette.h"

#include <stdlib.h>
#include <string.h>

enum { BITS = 5, SIDE = 1 << BITS, BINS = SIDE * SIDE * SIDE, CHANNELS = 3 };

// The pixels whose colours agree in the highest bits.
typedef struct colour_bin {
    uint64_t count;
    uint64_t sums[CHANNELS];
} colour_bin;

// Bins from low to high, both included, along each channel.
typedef struct colour_box {
    int low[CHANNELS], high[CHANNELS];
    double spread; // of the channel that varies most: pixels times squared distance from the mean
    int channel;   // that one
    int cut;       // the last bin of its lower half
} colour_box;

static int channel_of(draw_colour colour, int channel) {
    return (int)(colour >> (16 - 8 * channel) & 255);
}

static size_t bin_of(draw_colour colour) {
    size_t bin = 0;
    for (int i = 0; i < CHANNELS; i++)
        bin = bin << BITS | (size_t)(channel_of(colour, i) >> (8 - BITS));
    return bin;
}

static draw_colour pixel_colour(const canvas *source, size_t index) {
    const uint8_t *pixel = source->rgb + 3 * index;
    return (draw_colour)pixel[0] << 16 | (draw_colour)pixel[1] << 8 | pixel[2];
}

// Where a colour is in the sorted list, or would be.
static size_t sorted_place(const palette *colours, draw_colour colour) {
    size_t low = 0;
    size_t high = colours->count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (colours->colours[middle] < colour)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// Lists the colours of a picture. Returns false if they get too many.
static bool list_colours(palette *made, const canvas *picture, size_t most) {
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
        draw_colour colour = pixel_colour(picture, i);
        size_t place = sorted_place(made, colour);
        if (place < made->count && made->colours[place] == colour)
            continue;
        if (made->count == most)
            return false;
        memmove(made->colours + place + 1, made->colours + place, (made->count - place) * sizeof *made->colours);
        made->colours[place] = colour;
        made->count++;
    }
    return true;
}

static void count_colours(colour_bin *bins, const canvas *picture) {
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
        draw_colour colour = pixel_colour(picture, i);
        colour_bin *bin = &bins[bin_of(colour)];
        bin->count++;
        for (int channel = 0; channel < CHANNELS; channel++)
            bin->sums[channel] += (uint64_t)channel_of(colour, channel);
    }
}

// The bins of a box, one after the other. Starts with all of at 0; returns NULL at the end.
static const colour_bin *next_bin(const colour_bin *bins, const colour_box *box, int at[CHANNELS], bool *started) {
    if (!*started) {
        memcpy(at, box->low, sizeof box->low);
        *started = true;
    } else {
        int channel = CHANNELS - 1;
        while (channel >= 0 && at[channel] == box->high[channel]) {
            at[channel] = box->low[channel];
            channel--;
        }
        if (channel < 0)
            return NULL;
        at[channel]++;
    }
    return &bins[((size_t)at[0] << BITS | (size_t)at[1]) << BITS | (size_t)at[2]];
}

// Finds the channel along which the box's pixels spread most, and where to cut it.
static void measure_box(const colour_bin *bins, colour_box *box) {
    double count = 0;
    double sums[CHANNELS] = {0};
    double squares[CHANNELS] = {0};
    int at[CHANNELS];
    bool started = false;
    for (const colour_bin *bin; (bin = next_bin(bins, box, at, &started));) {
        // Rare colours count for more than their share: they are what a picture is about.
        double weight = bin->count < 64 ? (double)bin->count : 64 + (double)(bin->count - 64) / 64;
        count += weight;
        for (int i = 0; i < CHANNELS; i++) {
            sums[i] += weight * at[i];
            squares[i] += weight * at[i] * at[i];
        }
    }
    box->spread = 0;
    for (int i = 0; i < CHANNELS && count > 0; i++) {
        double mean = sums[i] / count;
        double spread = squares[i] - count * mean * mean;
        if (box->low[i] == box->high[i] || spread <= box->spread)
            continue;
        box->spread = spread;
        box->channel = i;
        box->cut = (int)mean < box->high[i] ? (int)mean : box->high[i] - 1;
    }
}

static draw_colour mean_colour(const colour_bin *bins, const colour_box *box) {
    uint64_t count = 0;
    uint64_t sums[CHANNELS] = {0};
    int at[CHANNELS];
    bool started = false;
    for (const colour_bin *bin; (bin = next_bin(bins, box, at, &started));) {
        count += bin->count;
        for (int i = 0; i < CHANNELS; i++)
            sums[i] += bin->sums[i];
    }
    draw_colour mean = 0;
    for (int i = 0; i < CHANNELS; i++)
        mean = mean << 8 | (draw_colour)(count ? (sums[i] + count / 2) / count : 0);
    return mean;
}

static size_t cut_boxes(const colour_bin *bins, colour_box *boxes, size_t most) {
    size_t count = 1;
    boxes[0] = (colour_box){.high = {SIDE - 1, SIDE - 1, SIDE - 1}};
    measure_box(bins, &boxes[0]);
    while (count < most) {
        size_t widest = 0;
        for (size_t i = 1; i < count; i++)
            if (boxes[i].spread > boxes[widest].spread)
                widest = i;
        colour_box *lower = &boxes[widest];
        if (lower->spread <= 0)
            break;
        colour_box *upper = &boxes[count++];
        *upper = *lower;
        upper->low[lower->channel] = lower->cut + 1;
        lower->high[lower->channel] = lower->cut;
        measure_box(bins, lower);
        measure_box(bins, upper);
    }
    return count;
}

// Every bin lies in one box, also those without a pixel.
static void fill_nearest(palette *made, const colour_bin *bins, const colour_box *boxes) {
    for (size_t i = 0; i < made->count; i++) {
        int at[CHANNELS] = {0};
        bool started = false;
        for (const colour_bin *bin; (bin = next_bin(bins, &boxes[i], at, &started));)
            made->nearest[bin - bins] = (uint8_t)i;
    }
}

static bool cut_colours(palette *made, const canvas *pictures, size_t count, size_t most) {
    colour_bin *bins = calloc(BINS, sizeof *bins);
    colour_box *boxes = malloc(most * sizeof *boxes);
    made->nearest = malloc(BINS);
    bool ok = bins && boxes && made->nearest;
    if (ok) {
        for (size_t i = 0; i < count; i++)
            count_colours(bins, &pictures[i]);
        made->count = cut_boxes(bins, boxes, most);
        for (size_t i = 0; i < made->count; i++)
            made->colours[i] = mean_colour(bins, &boxes[i]);
        fill_nearest(made, bins, boxes);
    }
    free(bins);
    free(boxes);
    return ok;
}

bool palette_make(palette *made, const canvas *pictures, size_t count, size_t most) {
    memset(made, 0, sizeof *made);
    made->exact = true;
    for (size_t i = 0; made->exact && i < count; i++)
        made->exact = list_colours(made, &pictures[i], most);
    if (made->exact || cut_colours(made, pictures, count, most))
        return true;
    palette_free(made);
    return false;
}

void palette_free(palette *unwanted) {
    free(unwanted->nearest);
    memset(unwanted, 0, sizeof *unwanted);
}

uint8_t palette_place(const palette *colours, draw_colour colour) {
    if (!colours->exact)
        return colours->nearest[bin_of(colour)];
    size_t place = sorted_place(colours, colour);
    return (uint8_t)(place < colours->count ? place : colours->count - 1);
}
