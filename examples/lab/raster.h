/// @file raster.h
/// Pixels in memory, and what is drawn on them, fast enough for every spring of a ship sixty times a second.
///
/// A raster takes opaque and blended shapes. A layer gathers many small ones that lie side by side: each adds its
/// colour times the part of a pixel that it covers, and only the sum is blended, so that neighbours that share a
/// pixel leave no seam, whatever the order they come in.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_RASTER_H
#define LAB_RASTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// A colour as 0xRRGGBB.
typedef uint32_t lab_colour;

/// A box of pixels.
typedef struct lab_box {
    int x, y, width, height;
} lab_box;

typedef struct lab_raster {
    int width, height;
    uint32_t *pixels; ///< [height][width], 0x00RRGGBB, the top row first
} lab_raster;

bool raster_make(lab_raster *made, int width, int height);
void raster_free(lab_raster *unwanted);

bool box_holds(lab_box box, int x, int y);
/// The box without so many pixels on each side.
lab_box box_shrink(lab_box box, int by);

/// Mixed colour: a where part is 0, b where it is 256.
lab_colour colour_mix(lab_colour a, lab_colour b, int part);

/// All that follows is cut to clip, which must lie on the raster; alpha is 0 to 256.
void raster_fill(lab_raster *target, lab_box clip, lab_box box, lab_colour colour, int alpha);
/// A frame of one pixel just inside box.
void raster_frame(lab_raster *target, lab_box clip, lab_box box, lab_colour colour, int alpha);
/// A filled box whose corners are rounded.
void raster_round(lab_raster *target, lab_box clip, lab_box box, double radius, lab_colour colour, int alpha);
/// A line with soft edges.
void raster_line(lab_raster *target, lab_box clip, double x, double y, double x2, double y2, double width,
                 lab_colour colour, int alpha);
/// A ring, or a disc if inner is 0, with soft edges.
void raster_ring(lab_raster *target, lab_box clip, double x, double y, double inner, double outer,
                 lab_colour colour, int alpha);

/// A layer over a box of a raster.
typedef struct lab_layer {
    lab_box box;
    uint64_t *sums; ///< [height][width], four lanes of 16 bits: red, green, blue and coverage
    size_t capacity;
} lab_layer;

/// A colour as a layer takes it.
typedef uint64_t layer_colour;
layer_colour layer_colour_of(lab_colour colour);

/// Start a new, empty layer; its memory is kept from one to the next. Returns false when out of memory.
bool layer_start(lab_layer *layer, lab_box box);
void layer_free(lab_layer *unwanted);
/// A square with its centre at x, y, sides of 2 half.
void layer_square(lab_layer *layer, float x, float y, float half, layer_colour colour);
void layer_line(lab_layer *layer, float x, float y, float x2, float y2, float width, layer_colour colour);
/// Blend it over the raster.
void layer_finish(const lab_layer *layer, lab_raster *target);

#endif
