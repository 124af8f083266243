/// @file png.h
/// PNG files, still and moving.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_PNG_H
#define DRAW_PNG_H

#include "draw/palette.h"

#include <stdio.h>

/// Write a canvas as a PNG file of at most 256 colours.
bool png_write(const canvas *source, const char *path, draw_error *error);

/// A moving PNG (APNG) on its way to a file. Programs that cannot play it show its first frame.
typedef struct png_animation {
    FILE *stream;
    const char *path;
    const palette *colours;
    uint32_t width, height;
    uint32_t frame_count, frames_done, sequence;
    uint32_t milliseconds; ///< that a frame is shown
    uint8_t *shown;        ///< the frame before, as places in the palette
} png_animation;

/// Begin an animation of frame_count canvases of one size, repeated for ever, in the colours of a palette that
/// outlives it.
bool png_animation_begin(png_animation *made, const char *path, const palette *colours, uint32_t frame_count,
                         uint32_t milliseconds, draw_error *error);
/// Add the next frame.
bool png_animation_add(png_animation *target, const canvas *frame, draw_error *error);
/// End it; to be called once after a successful begin, whatever else failed. The last frame is shown longer.
bool png_animation_end(png_animation *target, draw_error *error);

#endif
